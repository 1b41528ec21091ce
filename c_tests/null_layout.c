/* As null.c, for layouts. */
#include "null.h"

static leafless_solid *solid, *endless;
static leafless_bay *bay;
static leafless_layout *layout;
static leafless_options options;
static const double unit[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

static void bays(void) {
    void *out = fresh(), *never = UNTOUCHED;
    leafless_bay **result = (leafless_bay **)&never;
    leafless_item_options item = LEAFLESS_INIT(leafless_item_options);
    const double wrong[] = {-1, -INFINITY, NAN, INFINITY, 1e20};
    const double mirror[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0}, longer[12] = {1.001, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    uint64_t number = 77, *count = (uint64_t *)out;
    size_t i;
    NULL_POINTER(leafless_bay_new, container, leafless_bay_new(NULL, 0, 0, result));
    NULL_POINTER(leafless_bay_new, bay, leafless_bay_new(solid, 0, 0, NULL));
    MISALIGNED(leafless_bay_new, bay, leafless_bay_new(solid, 0, 0, (leafless_bay **)WRONG(out)));
    BAD_NUMBER(leafless_bay_new, bounds, leafless_bay_new(endless, 0, 0, result));
    for (i = 0; i < COUNT(wrong); i++) {
        BAD_NUMBER(leafless_bay_new, clearance_model, leafless_bay_new(solid, wrong[i], 0, result));
        BAD_NUMBER(leafless_bay_new, wall_clearance_model, leafless_bay_new(solid, 0, wrong[i], result));
    }
    NULL_POINTER(leafless_bay_add_obstacle, bay, leafless_bay_add_obstacle(NULL, solid, count));
    NULL_POINTER(leafless_bay_add_obstacle, solid, leafless_bay_add_obstacle(bay, NULL, count));
    NULL_POINTER(leafless_bay_add_obstacle, number, leafless_bay_add_obstacle(bay, solid, NULL));
    MISALIGNED(leafless_bay_add_obstacle, number, leafless_bay_add_obstacle(bay, solid, (uint64_t *)WRONG(out)));
    BAD_NUMBER(leafless_bay_add_obstacle, bounds, leafless_bay_add_obstacle(bay, endless, count));
    NULL_POINTER(leafless_bay_add_item, bay, leafless_bay_add_item(NULL, solid, 1, NULL, count));
    NULL_POINTER(leafless_bay_add_item, solid, leafless_bay_add_item(bay, NULL, 1, NULL, count));
    NULL_POINTER(leafless_bay_add_item, number, leafless_bay_add_item(bay, solid, 1, NULL, NULL));
    MISALIGNED(leafless_bay_add_item, number, leafless_bay_add_item(bay, solid, 1, NULL, (uint64_t *)WRONG(out)));
    MISALIGNED(leafless_bay_add_item, item,
               leafless_bay_add_item(bay, solid, 1, (leafless_item_options *)WRONG(&item), count));
    BAD_NUMBER(leafless_bay_add_item, bounds, leafless_bay_add_item(bay, endless, 1, NULL, count));
#define ITEM(field, value)                                                                            \
    item.field = value;                                                                               \
    BAD_NUMBER(leafless_bay_add_item, field, leafless_bay_add_item(bay, solid, 1, &item, count));     \
    item.field = 0
    ITEM(orientations, 4);
    ITEM(orientations, UINT32_MAX);
    ITEM(density, -1);
    ITEM(density, NAN);
    ITEM(density, INFINITY);
    ITEM(matrix_count, 1);
    ITEM(free_count, 1);
    item.orientations = LEAFLESS_ORIENTATIONS_FREE;
    BAD_NUMBER(leafless_bay_add_item, orientations, leafless_bay_add_item(bay, solid, 1, &item, count));
    item.free_count = 4097;
    BAD_NUMBER(leafless_bay_add_item, orientations, leafless_bay_add_item(bay, solid, 1, &item, count));
    item.orientations = LEAFLESS_ORIENTATIONS_TURNS;
    item.free_count = 0;
    ITEM(reserved, 1);
    item.matrices = unit;
    BAD_NUMBER(leafless_bay_add_item, matrices, leafless_bay_add_item(bay, solid, 1, &item, count));
    item.orientations = LEAFLESS_ORIENTATIONS_LIST;
    BAD_NUMBER(leafless_bay_add_item, orientations, leafless_bay_add_item(bay, solid, 1, &item, count));
    item.matrix_count = 1;
    item.matrices = mirror;
    BAD_NUMBER(leafless_bay_add_item, placement, leafless_bay_add_item(bay, solid, 1, &item, count));
    item.matrices = longer;
    BAD_NUMBER(leafless_bay_add_item, placement, leafless_bay_add_item(bay, solid, 1, &item, count));
    item.matrices = (const double *)WRONG(unit);
    BAD_NUMBER(leafless_bay_add_item, matrices, leafless_bay_add_item(bay, solid, 1, &item, count));
    item.matrices = NULL;
    refused(LEAFLESS_E_NULL, "leafless_bay_add_item", "matrices", leafless_bay_add_item(bay, solid, 1, &item, count));
    item.matrices = unit;
    item.matrix_count = UINT64_MAX;
    BAD_NUMBER(leafless_bay_add_item, matrices, leafless_bay_add_item(bay, solid, 1, &item, count));
    item.struct_size = 3;
    BAD_NUMBER(leafless_bay_add_item, item, leafless_bay_add_item(bay, solid, 1, &item, count));
#undef ITEM
    untouched();
    CHECK(never == UNTOUCHED);
    /* None of these was added. */
    MAY_BE_NULL(leafless_bay_add_item, item, leafless_bay_add_item(bay, solid, 2, NULL, &number));
    CHECK(number == 0);
    leafless_bay_free(NULL);
}

static void layouts(void) {
    void *out = fresh(), *never = UNTOUCHED;
    leafless_layout **result = (leafless_layout **)&never, *other = NULL;
    leafless_placement *placement = (leafless_placement *)out;
    leafless_neighbour *neighbours = (leafless_neighbour *)out;
    leafless_placed_standing *standings = (leafless_placed_standing *)out;
    leafless_standing *standing = (leafless_standing *)out, found = LEAFLESS_INIT(leafless_standing);
    const double singular[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0}, mirror[12] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    uint64_t *count = (uint64_t *)out, number = 77;
    NULL_POINTER(leafless_layout_new, bay, leafless_layout_new(NULL, &options, result));
    NULL_POINTER(leafless_layout_new, layout, leafless_layout_new(bay, &options, NULL));
    MISALIGNED(leafless_layout_new, options, leafless_layout_new(bay, (leafless_options *)WRONG(&options), result));
    MISALIGNED(leafless_layout_new, layout, leafless_layout_new(bay, &options, (leafless_layout **)WRONG(out)));

    NULL_POINTER(leafless_layout_place, layout, leafless_layout_place(NULL, 0, unit, count));
    NULL_POINTER(leafless_layout_place, matrix, leafless_layout_place(layout, 0, NULL, count));
    NULL_POINTER(leafless_layout_place, number, leafless_layout_place(layout, 0, unit, NULL));
    MISALIGNED(leafless_layout_place, matrix, leafless_layout_place(layout, 0, (const double *)WRONG(out), count));
    MISALIGNED(leafless_layout_place, number, leafless_layout_place(layout, 0, unit, (uint64_t *)WRONG(out)));
    BAD_NUMBER(leafless_layout_place, item, leafless_layout_place(layout, 1, unit, count));
    BAD_NUMBER(leafless_layout_place, item, leafless_layout_place(layout, UINT64_MAX, unit, count));
    BAD_NUMBER(leafless_layout_place, placement, leafless_layout_place(layout, 0, singular, count));
    BAD_NUMBER(leafless_layout_place, placement, leafless_layout_place(layout, 0, mirror, count));
    untouched();
    OK(leafless_layout_place(layout, 0, unit, &number));
    CHECK(number == 0);

    NULL_POINTER(leafless_layout_move_to, layout, leafless_layout_move_to(NULL, 0, unit));
    NULL_POINTER(leafless_layout_move_to, matrix, leafless_layout_move_to(layout, 0, NULL));
    MISALIGNED(leafless_layout_move_to, matrix, leafless_layout_move_to(layout, 0, (const double *)WRONG(out)));
    BAD_NUMBER(leafless_layout_move_to, number, leafless_layout_move_to(layout, 1, unit));
    BAD_NUMBER(leafless_layout_move_to, number, leafless_layout_move_to(layout, UINT64_MAX, unit));
    BAD_NUMBER(leafless_layout_move_to, placement, leafless_layout_move_to(layout, 0, mirror));
    NULL_POINTER(leafless_layout_remove, layout, leafless_layout_remove(NULL, 0));
    BAD_NUMBER(leafless_layout_remove, number, leafless_layout_remove(layout, 1));
    BAD_NUMBER(leafless_layout_remove, number, leafless_layout_remove(layout, UINT64_MAX));

    NULL_POINTER(leafless_layout_placements, layout, leafless_layout_placements(NULL, placement, 1, count));
    NULL_POINTER(leafless_layout_placements, placements, leafless_layout_placements(layout, NULL, 1, count));
    NULL_POINTER(leafless_layout_placements, count, leafless_layout_placements(layout, placement, 1, NULL));
    MISALIGNED(leafless_layout_placements, placements,
               leafless_layout_placements(layout, (leafless_placement *)WRONG(out), 1, count));
    MISALIGNED(leafless_layout_placements, count, leafless_layout_placements(layout, NULL, 0, (uint64_t *)WRONG(out)));
    refused(LEAFLESS_E_BUFFER, "leafless_layout_placements", "placements",
            leafless_layout_placements(layout, placement, 0, count));
    NULL_POINTER(leafless_layout_placement_at, layout, leafless_layout_placement_at(NULL, 0, placement));
    NULL_POINTER(leafless_layout_placement_at, placement, leafless_layout_placement_at(layout, 0, NULL));
    MISALIGNED(leafless_layout_placement_at, placement,
               leafless_layout_placement_at(layout, 0, (leafless_placement *)WRONG(out)));
    BAD_NUMBER(leafless_layout_placement_at, number, leafless_layout_placement_at(layout, 1, placement));
    BAD_NUMBER(leafless_layout_placement_at, number, leafless_layout_placement_at(layout, UINT64_MAX, placement));

    NULL_POINTER(leafless_layout_check, layout, leafless_layout_check(NULL, 0, &options, neighbours, 1, standing));
    NULL_POINTER(leafless_layout_check, conflicts, leafless_layout_check(layout, 0, &options, NULL, 1, standing));
    NULL_POINTER(leafless_layout_check, standing, leafless_layout_check(layout, 0, &options, neighbours, 1, NULL));
    MISALIGNED(leafless_layout_check, options,
               leafless_layout_check(layout, 0, (leafless_options *)WRONG(&options), NULL, 0, standing));
    MISALIGNED(leafless_layout_check, conflicts,
               leafless_layout_check(layout, 0, &options, (leafless_neighbour *)WRONG(out), 1, standing));
    MISALIGNED(leafless_layout_check, standing,
               leafless_layout_check(layout, 0, &options, NULL, 0, (leafless_standing *)WRONG(out)));
    BAD_NUMBER(leafless_layout_check, conflicts, leafless_layout_check(layout, 0, &options, neighbours, UINT64_MAX, standing));
    BAD_NUMBER(leafless_layout_check, number, leafless_layout_check(layout, 1, &options, NULL, 0, standing));
    BAD_NUMBER(leafless_layout_check, number, leafless_layout_check(layout, UINT64_MAX, &options, NULL, 0, standing));
    NULL_POINTER(leafless_layout_check_all, layout, leafless_layout_check_all(NULL, &options, standings, 1, count));
    NULL_POINTER(leafless_layout_check_all, standings, leafless_layout_check_all(layout, &options, NULL, 1, count));
    NULL_POINTER(leafless_layout_check_all, count, leafless_layout_check_all(layout, &options, standings, 1, NULL));
    MISALIGNED(leafless_layout_check_all, options,
               leafless_layout_check_all(layout, (leafless_options *)WRONG(&options), standings, 1, count));
    MISALIGNED(leafless_layout_check_all, standings,
               leafless_layout_check_all(layout, &options, (leafless_placed_standing *)WRONG(out), 1, count));
    MISALIGNED(leafless_layout_check_all, count,
               leafless_layout_check_all(layout, &options, NULL, 0, (uint64_t *)WRONG(out)));
    refused(LEAFLESS_E_BUFFER, "leafless_layout_check_all", "standings",
            leafless_layout_check_all(layout, &options, standings, 0, count));
    untouched();
    CHECK(never == UNTOUCHED);

    MAY_BE_NULL(leafless_layout_new, options, leafless_layout_new(bay, NULL, &other));
    leafless_layout_free(other);
    MAY_BE_NULL(leafless_layout_placements, placements, leafless_layout_placements(layout, NULL, 0, &number));
    CHECK(number == 1);
    MAY_BE_NULL(leafless_layout_check, options, leafless_layout_check(layout, 0, NULL, NULL, 0, &found));
    MAY_BE_NULL(leafless_layout_check, conflicts, leafless_layout_check(layout, 0, &options, NULL, 0, &found));
    MAY_BE_NULL(leafless_layout_check_all, standings, leafless_layout_check_all(layout, &options, NULL, 0, &number));
    {
        leafless_placed_standing one;
        MAY_BE_NULL(leafless_layout_check_all, options, leafless_layout_check_all(layout, NULL, &one, 1, &number));
        CHECK(number == 1);
    }
    leafless_layout_free(NULL);
}

static void searches(void) {
    void *out = fresh();
    leafless_search_report *report = (leafless_search_report *)out, told = LEAFLESS_INIT(leafless_search_report);
    leafless_layout_measures *measures = (leafless_layout_measures *)out;
    leafless_layout_measures known = LEAFLESS_INIT(leafless_layout_measures);
    leafless_search_options search = LEAFLESS_INIT(leafless_search_options);
    const double wrong[] = {-1, -INFINITY, NAN};
    size_t i;
    NULL_POINTER(leafless_layout_search, layout, leafless_layout_search(NULL, &search, &options, report));
    NULL_POINTER(leafless_layout_search, report, leafless_layout_search(layout, &search, &options, NULL));
    MISALIGNED(leafless_layout_search, search,
               leafless_layout_search(layout, (leafless_search_options *)WRONG(&search), &options, report));
    MISALIGNED(leafless_layout_search, options,
               leafless_layout_search(layout, &search, (leafless_options *)WRONG(&options), report));
    MISALIGNED(leafless_layout_search, report,
               leafless_layout_search(layout, &search, &options, (leafless_search_report *)WRONG(out)));
#define SEARCH(field, value)                                                                             \
    search.field = value;                                                                                \
    BAD_NUMBER(leafless_layout_search, field, leafless_layout_search(layout, &search, &options, report)); \
    search.field = 0
    SEARCH(objective, 4);
    SEARCH(objective, UINT32_MAX);
    SEARCH(cells, 3);
    SEARCH(cells, 513);
    SEARCH(cells, UINT32_MAX);
    SEARCH(free_along, 7);
    SEARCH(free_along, UINT32_MAX);
    SEARCH(reserved, 1);
    search.target_model[1] = 1;
    BAD_NUMBER(leafless_layout_search, target_model, leafless_layout_search(layout, &search, &options, report));
    search.objective = LEAFLESS_OBJECTIVE_BALANCE;
    search.target_model[1] = NAN;
    BAD_NUMBER(leafless_layout_search, target_model, leafless_layout_search(layout, &search, &options, report));
    search.struct_size = 3;
    BAD_NUMBER(leafless_layout_search, search, leafless_layout_search(layout, &search, &options, report));
#undef SEARCH
    NULL_POINTER(leafless_layout_measure, layout, leafless_layout_measure(NULL, 0.1, &options, measures));
    NULL_POINTER(leafless_layout_measure, measures, leafless_layout_measure(layout, 0.1, &options, NULL));
    MISALIGNED(leafless_layout_measure, options,
               leafless_layout_measure(layout, 0.1, (leafless_options *)WRONG(&options), measures));
    MISALIGNED(leafless_layout_measure, measures,
               leafless_layout_measure(layout, 0.1, &options, (leafless_layout_measures *)WRONG(out)));
    for (i = 0; i < COUNT(wrong); i++) {
        BAD_NUMBER(leafless_layout_measure, tolerance, leafless_layout_measure(layout, wrong[i], &options, measures));
    }
    untouched();
    MAY_BE_NULL(leafless_layout_search, search, leafless_layout_search(layout, NULL, &options, &told));
    MAY_BE_NULL(leafless_layout_search, options, leafless_layout_search(layout, NULL, NULL, &told));
    MAY_BE_NULL(leafless_layout_measure, options, leafless_layout_measure(layout, 0.1, NULL, &known));
}

int main(void) {
    const double low[3] = {-2, -2, -2}, high[3] = {2, 2, 2}, normal[3] = {0, 0, 1};
    leafless_solid *container = NULL;
    solid = check_ball_solid();
    OK(leafless_init(&options, sizeof options));
    OK(leafless_solid_new_box(low, high, &container));
    OK(leafless_solid_new_halfspace(normal, 0, &endless));
    OK(leafless_bay_new(container, 0.1, 0.1, &bay));
    bays();
    OK(leafless_layout_new(bay, &options, &layout));
    layouts();
    searches();
    leafless_layout_free(layout);
    leafless_bay_free(bay);
    leafless_solid_free(endless);
    leafless_solid_free(container);
    leafless_solid_free(solid);
    return 0;
}
