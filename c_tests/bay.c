/* Layouts: checks of placements, searches, and the sums over copies, against plain arithmetic. */
#include "check.h"

static leafless_solid *box(double x, double y, double z) {
    const double low[3] = {0, 0, 0}, high[3] = {x, y, z};
    leafless_solid *solid = NULL;
    OK(leafless_solid_new_box(low, high, &solid));
    return solid;
}

static leafless_solid *ball(double x, double radius) {
    const double centre[3] = {x, 15, 15};
    leafless_solid *solid = NULL;
    OK(leafless_solid_new_ball(centre, radius, &solid));
    return solid;
}

/* Along x, without a turn. */
static void along(double x, double *matrix) {
    static const double unit[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    memcpy(matrix, unit, sizeof unit);
    matrix[3] = x;
}

static bool holds(leafless_interval interval, double truth) {
    return interval.lower <= truth && truth <= interval.upper;
}

/* Two balls of radius 10, and an obstacle of radius 2, in a box of 80 x 30 x 30. */
static void balls(void) {
    leafless_solid *container = box(80, 30, 30), *item = ball(0, 10), *post = ball(70, 2);
    leafless_bay *bay = NULL;
    leafless_layout *layout = NULL;
    leafless_standing standing = LEAFLESS_INIT(leafless_standing);
    leafless_neighbour conflicts[4];
    leafless_placed_standing all[2];
    leafless_placement placements[2], one;
    double matrix[12];
    uint64_t number, first, second;
    OK(leafless_bay_new(container, 1, 0.5, &bay));
    OK(leafless_bay_add_obstacle(bay, post, &number));
    CHECK(number == 0);
    OK(leafless_bay_add_item(bay, item, 2, NULL, &number));
    CHECK(number == 0);
    OK(leafless_layout_new(bay, NULL, &layout));
    leafless_bay_free(bay);
    leafless_solid_free(post);
    leafless_solid_free(item);
    leafless_solid_free(container);

    along(11, matrix);
    OK(leafless_layout_place(layout, 0, matrix, &first));
    along(31.5, matrix);
    OK(leafless_layout_place(layout, 0, matrix, &second));
    CHECK(first == 0 && second == 1);
    /* One half apart, where they should be one apart. */
    OK(leafless_layout_check(layout, second, NULL, conflicts, 4, &standing));
    CHECK(standing.verdict == LEAFLESS_GAP_VERDICT_NO && standing.conflict_count == 1);
    CHECK(conflicts[0].beside == LEAFLESS_BESIDE_PLACED && conflicts[0].number == first);
    CHECK(conflicts[0].verdict == LEAFLESS_GAP_VERDICT_NO && holds(conflicts[0].gap_model, 0.5));
    CHECK(standing.has_nearest && standing.nearest.beside == LEAFLESS_BESIDE_PLACED && standing.nearest.number == first);
    CHECK(holds(standing.nearest.gap_model, 0.5) && standing.nearest.verdict == LEAFLESS_GAP_VERDICT_NO);
    CHECK(standing.nearest.gap_model.upper - standing.nearest.gap_model.lower < 1e-3);
    /* Their number is returned even if the buffer has no room for them. */
    standing.conflict_count = 0;
    OK(leafless_layout_check(layout, second, NULL, NULL, 0, &standing));
    CHECK(standing.conflict_count == 1);
    OK(leafless_layout_check_all(layout, NULL, all, 2, &number));
    CHECK(number == 2 && all[0].verdict == LEAFLESS_GAP_VERDICT_NO && all[1].verdict == LEAFLESS_GAP_VERDICT_NO);
    CHECK(all[0].conflict_count == 1 && all[1].conflict_count == 1);
    /* A gap of 1.5. */
    along(32.5, matrix);
    OK(leafless_layout_move_to(layout, second, matrix));
    OK(leafless_layout_check(layout, second, NULL, conflicts, 4, &standing));
    CHECK(standing.verdict == LEAFLESS_GAP_VERDICT_YES && standing.conflict_count == 0);
    CHECK(holds(standing.nearest.gap_model, 1.5) && standing.nearest.verdict == LEAFLESS_GAP_VERDICT_YES);
    OK(leafless_layout_check_all(layout, NULL, all, 2, &number));
    CHECK(all[0].verdict == LEAFLESS_GAP_VERDICT_YES && all[1].verdict == LEAFLESS_GAP_VERDICT_YES);
    /* Nearest to the obstacle: 70 - 2 - (54 + 10) = 4. */
    along(54, matrix);
    OK(leafless_layout_move_to(layout, second, matrix));
    OK(leafless_layout_check(layout, second, NULL, NULL, 0, &standing));
    CHECK(standing.nearest.beside == LEAFLESS_BESIDE_OBSTACLE && standing.nearest.number == 0);
    CHECK(holds(standing.nearest.gap_model, 4) && standing.verdict == LEAFLESS_GAP_VERDICT_YES);
    /* On the obstacle, and too near to the wall, which is 0.25 away. */
    along(69.75, matrix);
    OK(leafless_layout_move_to(layout, second, matrix));
    OK(leafless_layout_check(layout, second, NULL, conflicts, 4, &standing));
    CHECK(standing.verdict == LEAFLESS_GAP_VERDICT_NO && standing.conflict_count == 2);
    CHECK(conflicts[0].beside == LEAFLESS_BESIDE_WALL && conflicts[0].verdict == LEAFLESS_GAP_VERDICT_NO);
    CHECK(conflicts[1].beside == LEAFLESS_BESIDE_OBSTACLE && conflicts[1].verdict == LEAFLESS_GAP_VERDICT_NO);
    CHECK(holds(conflicts[1].gap_model, 0));
    /* Room for one of them: the other is left out. */
    memset(conflicts, 0x5a, sizeof conflicts);
    OK(leafless_layout_check(layout, second, NULL, conflicts, 1, &standing));
    CHECK(standing.conflict_count == 2 && conflicts[0].beside == LEAFLESS_BESIDE_WALL && conflicts[1].beside == 0x5a5a5a5a);

    OK(leafless_layout_placements(layout, NULL, 0, &number));
    CHECK(number == 2);
    OK(leafless_layout_placements(layout, placements, 2, &number));
    CHECK(placements[0].item == 0 && placements[0].matrix[3] == 11 && placements[1].matrix[3] == 69.75);
    OK(leafless_layout_placement_at(layout, second, &one));
    CHECK(memcmp(&one, &placements[1], sizeof one) == 0);
    OK(leafless_layout_remove(layout, first));
    OK(leafless_layout_placement_at(layout, 0, &one));
    CHECK(memcmp(&one, &placements[1], sizeof one) == 0);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_layout_placement_at(layout, 1, &one));
    leafless_layout_free(layout);
}

/* Eight blocks of edge 9.5 in a cube of edge 21, and a ninth one for which there is no room. */
static void blocks(uint32_t count, leafless_objective objective, uint32_t threads, leafless_placement *found) {
    leafless_solid *container = box(21, 21, 21), *block = box(9.5, 9.5, 9.5);
    leafless_bay *bay = NULL;
    leafless_layout *layout = NULL;
    leafless_item_options item = LEAFLESS_INIT(leafless_item_options);
    leafless_search_options search = LEAFLESS_INIT(leafless_search_options);
    leafless_search_report report = LEAFLESS_INIT(leafless_search_report);
    leafless_layout_measures measures = LEAFLESS_INIT(leafless_layout_measures);
    leafless_options options = LEAFLESS_INIT(leafless_options);
    leafless_placed_standing standings[8];
    const double volume = 9.5 * 9.5 * 9.5;
    uint64_t number;
    size_t i, k;
    options.threads = threads;
    item.orientations = LEAFLESS_ORIENTATIONS_AS_GIVEN;
    item.density = 2;
    OK(leafless_bay_new(container, 0.5, 0.25, &bay));
    OK(leafless_bay_add_item(bay, block, count, &item, &number));
    OK(leafless_layout_new(bay, &options, &layout));
    OK(leafless_layout_measure(layout, 1e-6, &options, &measures));
    CHECK(measures.volume_model.upper == 0 && measures.mass.upper == 0 && !measures.has_centroid);
    search.objective = objective;
    search.seed = 3;
    search.rounds = 2;
    for (i = 0; i < 3 && objective == LEAFLESS_OBJECTIVE_BALANCE; i++) search.target_model[i] = 10.5;
    OK(leafless_layout_search(layout, &search, &options, &report));
    CHECK(report.placed == 8 && report.left == count - 8);
    CHECK(count == 8 || report.end == LEAFLESS_SEARCH_END_ROUNDS);
    OK(leafless_layout_check_all(layout, &options, standings, 8, &number));
    CHECK(number == 8);
    OK(leafless_layout_placements(layout, found, 8, &number));
    for (i = 0; i < 8; i++) {
        CHECK(standings[i].verdict == LEAFLESS_GAP_VERDICT_YES && standings[i].conflict_count == 0);
        for (k = 3; k < 12; k += 4) CHECK(found[i].matrix[k] >= 0.25 && found[i].matrix[k] + 9.5 <= 20.75);
        for (k = 0; k < i; k++) {
            /* Blocks as given are apart along an axis. */
            const double *const a = found[i].matrix, *const b = found[k].matrix;
            CHECK(fabs(a[3] - b[3]) >= 10 || fabs(a[7] - b[7]) >= 10 || fabs(a[11] - b[11]) >= 10);
        }
    }
    OK(leafless_layout_measure(layout, 1e-6, &options, &measures));
    CHECK(holds(measures.volume_model, 8 * volume) && holds(measures.mass, 16 * volume) && measures.has_centroid);
    CHECK(measures.volume_model.upper - measures.volume_model.lower < 0.1);
    CHECK(holds(measures.filled_part, 8 * volume / (21.0 * 21 * 21)));
    for (i = 0; i < 3; i++) {
        double middle = 0;
        for (k = 0; k < 8; k++) middle += (found[k].matrix[4 * i + 3] + 4.75) / 8;
        CHECK(measures.centroid_model[i].lower <= middle + 1e-9 && middle - 1e-9 <= measures.centroid_model[i].upper);
        CHECK(measures.inertia_origin_model[4 * i].lower > measures.inertia_centroid_model[4 * i].upper);
    }
    leafless_layout_free(layout);
    leafless_bay_free(bay);
    leafless_solid_free(block);
    leafless_solid_free(container);
}

/* A cancelled search is no failure. */
static void cancelled(void) {
    leafless_solid *container = box(60, 60, 60), *item = ball(0, 5);
    leafless_bay *bay = NULL;
    leafless_layout *layout = NULL;
    leafless_control *control = NULL;
    leafless_options options = LEAFLESS_INIT(leafless_options);
    leafless_search_report report = LEAFLESS_INIT(leafless_search_report);
    leafless_standing standing = LEAFLESS_INIT(leafless_standing);
    double matrix[12];
    uint64_t number;
    OK(leafless_bay_new(container, 0, 0, &bay));
    OK(leafless_bay_add_item(bay, item, 40, NULL, &number));
    OK(leafless_layout_new(bay, NULL, &layout));
    along(30, matrix);
    OK(leafless_layout_place(layout, 0, matrix, &number));
    OK(leafless_control_new(&control));
    OK(leafless_control_cancel(control));
    options.control = control;
    OK(leafless_layout_search(layout, NULL, &options, &report));
    CHECK(report.end == LEAFLESS_SEARCH_END_CANCELLED && report.placed + report.left == 39);
    OK(leafless_layout_placements(layout, NULL, 0, &number));
    CHECK(number == 1 + report.placed);
    FAILS(LEAFLESS_E_CANCELLED, leafless_layout_check(layout, 0, &options, NULL, 0, &standing));
    leafless_control_free(control);
    leafless_layout_free(layout);
    leafless_bay_free(bay);
    leafless_solid_free(item);
    leafless_solid_free(container);
}

static leafless_layout *in_use;
static leafless_status told;

/* The half-space above z = 14.5. Its function uses the layout that calls it. */
static int32_t above(void *ctx, const double *min, const double *max) {
    leafless_placement one;
    (void)ctx;
    if (in_use != NULL) {
        CHECK(leafless_layout_placement_at(in_use, 0, &one) == LEAFLESS_OK);
        told = leafless_layout_remove(in_use, 0);
    }
    return min[2] >= 14.5 ? LEAFLESS_TAG_FULL : max[2] <= 14.5 ? LEAFLESS_TAG_EMPTY : LEAFLESS_TAG_PARTIAL;
}

/* A function of the host cannot change the layout that calls it. */
static void busy(void) {
    static const double bounds[6] = {40, 0, 14.5, 60, 30, 30};
    leafless_solid *container = box(60, 30, 30), *item = ball(0, 10), *shape = NULL;
    leafless_solid_callbacks callbacks = LEAFLESS_INIT(leafless_solid_callbacks);
    leafless_bay *bay = NULL;
    leafless_layout *layout = NULL;
    leafless_standing standing = LEAFLESS_INIT(leafless_standing);
    double matrix[12];
    uint64_t number;
    callbacks.classify = above;
    memcpy(callbacks.bounds, bounds, sizeof bounds);
    OK(leafless_solid_new_callbacks(&callbacks, &shape));
    OK(leafless_bay_new(container, 1, 0, &bay));
    OK(leafless_bay_add_obstacle(bay, shape, &number));
    OK(leafless_bay_add_item(bay, item, 1, NULL, &number));
    OK(leafless_layout_new(bay, NULL, &layout));
    along(45, matrix);
    OK(leafless_layout_place(layout, 0, matrix, &number));
    in_use = layout;
    OK(leafless_layout_check(layout, 0, NULL, NULL, 0, &standing));
    in_use = NULL;
    CHECK(told == LEAFLESS_E_BUSY && standing.verdict == LEAFLESS_GAP_VERDICT_NO);
    OK(leafless_layout_placements(layout, NULL, 0, &number));
    CHECK(number == 1);
    leafless_layout_free(layout);
    leafless_bay_free(bay);
    leafless_solid_free(shape);
    leafless_solid_free(item);
    leafless_solid_free(container);
}

/* Turns of a list, and directions in which everything comes out. */
static void turns(void) {
    static const double list[24] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0};
    leafless_solid *container = box(11, 21, 6), *plank = box(20, 10, 5);
    leafless_bay *bay = NULL;
    leafless_item_options item = LEAFLESS_INIT(leafless_item_options);
    leafless_search_options search = LEAFLESS_INIT(leafless_search_options);
    leafless_search_report report = LEAFLESS_INIT(leafless_search_report);
    leafless_placement placement;
    uint64_t number, i;
    for (i = 1; i <= 2; i++) {
        leafless_layout *layout = NULL;
        /* With the second turn it goes in. */
        item.orientations = LEAFLESS_ORIENTATIONS_LIST;
        item.matrices = list;
        item.matrix_count = i;
        search.free_along = LEAFLESS_FREE_ALONG_Z_UP;
        OK(leafless_bay_new(container, 0, 0, &bay));
        OK(leafless_bay_add_item(bay, plank, 1, &item, &number));
        OK(leafless_layout_new(bay, NULL, &layout));
        OK(leafless_layout_search(layout, &search, NULL, &report));
        CHECK(report.placed == i - 1 && report.left == 2 - i);
        if (i == 2) {
            OK(leafless_layout_placement_at(layout, 0, &placement));
            CHECK(placement.matrix[1] == -1 && placement.matrix[4] == 1 && placement.matrix[3] >= 10);
        }
        leafless_layout_free(layout);
        leafless_bay_free(bay);
    }
    leafless_solid_free(plank);
    leafless_solid_free(container);
}

int main(void) {
    leafless_placement one[8], two[8];
    balls();
    blocks(8, LEAFLESS_OBJECTIVE_COUNT, 1, one);
    blocks(8, LEAFLESS_OBJECTIVE_COUNT, 2, two);
    CHECK(memcmp(one, two, sizeof one) == 0);
    blocks(9, LEAFLESS_OBJECTIVE_HEIGHT, 0, one);
    blocks(8, LEAFLESS_OBJECTIVE_DENSITY, 0, one);
    blocks(8, LEAFLESS_OBJECTIVE_BALANCE, 0, one);
    cancelled();
    busy();
    turns();
    return 0;
}
