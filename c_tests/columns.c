/* Columns of cells and height maps: of a ball, against its cells one by one. */
#include "check.h"

#define DEPTH 5
#define N 32

static leafless_solid *solid;
static leafless_octree *octree;
static leafless_frame frame;

static leafless_tag tag_at(uint32_t axis, uint32_t u, uint32_t v, uint32_t along) {
    const uint32_t at[3][3] = {{along, u, v}, {u, along, v}, {u, v, along}};
    leafless_tag tag;
    OK(leafless_octree_tag_at(octree, at[axis], &tag));
    return tag;
}

static bool counts(leafless_tag tag, uint32_t on) {
    return tag == LEAFLESS_TAG_FULL || (on == LEAFLESS_OBSTACLE_UPPER && tag == LEAFLESS_TAG_PARTIAL);
}

/* Runs hold just the cells that count, and no two touch. */
static void runs(const leafless_columns *columns, uint32_t axis, const uint32_t first[2], const uint32_t end[2]) {
    static uint64_t offsets[N * N + 1];
    static leafless_run all[N * N * 4];
    const uint64_t number = (uint64_t)(end[0] - first[0]) * (end[1] - first[1]);
    uint64_t offset_count, run_count, index = 0, i;
    uint32_t u, v, on, along;
    for (on = 0; on < 2; on++, index = 0) {
        OK(leafless_columns_copy(columns, on, NULL, 0, &offset_count, NULL, 0, &run_count));
        CHECK(offset_count == number + 1 && run_count <= COUNT(all));
        OK(leafless_columns_copy(columns, on, offsets, offset_count, &offset_count, all, run_count, &run_count));
        CHECK(offsets[0] == 0 && offsets[number] == run_count);
        for (v = first[1]; v < end[1]; v++) {
            for (u = first[0]; u < end[0]; u++, index++) {
                bool solid_here[N] = {false};
                for (i = offsets[index]; i < offsets[index + 1]; i++) {
                    CHECK(all[i].length > 0 && all[i].start + all[i].length <= N);
                    CHECK(i == offsets[index] || all[i - 1].start + all[i - 1].length < all[i].start);
                    for (along = 0; along < all[i].length; along++) {
                        solid_here[all[i].start + along] = true;
                    }
                }
                for (along = 0; along < N; along++) {
                    CHECK(solid_here[along] == counts(tag_at(axis, u, v, along), on));
                }
            }
        }
    }
    if (run_count > 0) {
        run_count = 77;
        FAILS(LEAFLESS_E_BUFFER, leafless_columns_copy(columns, 0, offsets, number, &offset_count, NULL, 0, &run_count));
        FAILS(LEAFLESS_E_BUFFER, leafless_columns_copy(columns, 0, NULL, 0, &offset_count, all, 0, &run_count));
        CHECK(run_count == 77);
    }
}

/* Cells have an edge of 1/16, and the universe begins at -1. */
static void heights(const leafless_interval *map, uint32_t axis, uint32_t side, const uint32_t first[2],
                    const uint32_t end[2]) {
    const double nowhere = side == LEAFLESS_SIDE_ABOVE ? -INFINITY : INFINITY;
    uint32_t u, v, i;
    for (v = first[1]; v < end[1]; v++) {
        for (u = first[0]; u < end[0]; u++, map++) {
            double full = nowhere, upper = nowhere;
            for (i = 0; i < N; i++) {
                const uint32_t along = side == LEAFLESS_SIDE_ABOVE ? i : N - 1 - i;
                const leafless_tag tag = tag_at(axis, u, v, along);
                const double plane = (along + (side == LEAFLESS_SIDE_ABOVE ? 1.0 : 0.0)) / 16 - 1;
                full = counts(tag, LEAFLESS_OBSTACLE_FULL) ? plane : full;
                upper = counts(tag, LEAFLESS_OBSTACLE_UPPER) ? plane : upper;
            }
            CHECK((side == LEAFLESS_SIDE_ABOVE ? map->lower : map->upper) == full);
            CHECK((side == LEAFLESS_SIDE_ABOVE ? map->upper : map->lower) == upper);
        }
    }
}

static void rectangle(uint32_t axis, const uint32_t *first, const uint32_t *end) {
    static const uint32_t low[2] = {0, 0}, high[2] = {N, N};
    static leafless_interval map[N * N], again[N * N];
    const uint32_t *from = first == NULL ? low : first, *to = end == NULL ? high : end;
    leafless_columns *columns = NULL;
    uint64_t count;
    uint32_t side;
    OK(leafless_octree_columns(octree, axis, first, end, &columns));
    runs(columns, axis, from, to);
    leafless_columns_free(columns);
    OK(leafless_solid_columns(solid, &frame, axis, first, end, NULL, &columns));
    runs(columns, axis, from, to);
    leafless_columns_free(columns);
    for (side = 0; side < 2; side++) {
        OK(leafless_octree_heights(octree, axis, first, end, side, NULL, 0, &count));
        CHECK(count == (uint64_t)(to[0] - from[0]) * (to[1] - from[1]));
        OK(leafless_octree_heights(octree, axis, first, end, side, map, count, &count));
        heights(map, axis, side, from, to);
        OK(leafless_solid_heights(solid, &frame, axis, first, end, side, NULL, again, N * N, &count));
        CHECK(memcmp(map, again, count * sizeof map[0]) == 0);
        if (count > 0) {
            FAILS(LEAFLESS_E_BUFFER, leafless_octree_heights(octree, axis, first, end, side, map, count - 1, &count));
            FAILS(LEAFLESS_E_BUFFER,
                  leafless_solid_heights(solid, &frame, axis, first, end, side, NULL, map, count - 1, &count));
        }
    }
}

static void limits(void) {
    leafless_columns *columns = NULL;
    leafless_control *control = NULL;
    leafless_options options;
    OK(leafless_init(&options, sizeof options));
    options.max_bytes = 1000;
    FAILS(LEAFLESS_E_LIMIT, leafless_solid_columns(solid, &frame, 0, NULL, NULL, &options, &columns));
    OK(leafless_control_new(&control));
    OK(leafless_control_cancel(control));
    options.max_bytes = 0;
    options.control = control;
    FAILS(LEAFLESS_E_CANCELLED, leafless_solid_columns(solid, &frame, 0, NULL, NULL, &options, &columns));
    CHECK(columns == NULL);
    leafless_control_free(control);
}

int main(void) {
    static const uint32_t first[2] = {3, 11}, end[2] = {20, 30}, same[2] = {5, 5};
    uint32_t axis;
    frame = check_frame(DEPTH);
    solid = check_ball_solid();
    octree = check_ball(DEPTH, LEAFLESS_RULE_CERTIFIED);
    for (axis = 0; axis < 3; axis++) {
        rectangle(axis, NULL, NULL);
        rectangle(axis, first, end);
        rectangle(axis, same, same);
    }
    limits();
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    return 0;
}
