/* Distances of points and cells from a ball, and the cells nearest to a point. */
#include "check.h"

#include <math.h>

#define DEPTH 5

static bool holds(leafless_interval interval, double value) {
    return interval.lower <= value + 1e-12 && value - 1e-12 <= interval.upper;
}

/* Refuses at once. */
static int32_t refuse(void *ctx, double fraction) {
    (void)ctx;
    (void)fraction;
    return 1;
}

static void points(const leafless_octree *octree, const leafless_solid *solid) {
    static const double at[4][3] = {{0.0, 0.0, 0.0}, {3.0, 0.0, 4.0}, {0.0, 0.5, 0.0}, {0.0, NAN, 0.0}};
    const double signed_truth[3] = {-0.75, 4.25, -0.25};
    const leafless_frame frame = check_frame(20);
    leafless_interval found[4];
    leafless_point_distance near[4];
    uint32_t to;
    int i;
    for (to = LEAFLESS_DISTANCE_TO_SOLID; to <= LEAFLESS_DISTANCE_TO_BOUNDARY; to++) {
        OK(leafless_octree_distances(octree, &at[0][0], 4, to, NULL, found));
        OK(leafless_solid_distances(solid, &frame, &at[0][0], 4, to, 1e-6, NULL, near));
        for (i = 0; i < 3; i++) {
            const double outside = signed_truth[i] > 0 ? signed_truth[i] : 0, inside = outside - signed_truth[i];
            const double truth = to == LEAFLESS_DISTANCE_TO_SOLID ? outside
                                 : to == LEAFLESS_DISTANCE_TO_COMPLEMENT ? inside : signed_truth[i];
            CHECK(holds(found[i], truth) && found[i].upper - found[i].lower < 0.25);
            CHECK(holds(near[i].distance_model, truth));
            /* The centre is as near to all of the boundary. */
            CHECK(i == 0 || near[i].measured == LEAFLESS_STOP_REASON_TOLERANCE);
            CHECK(i == 0 || near[i].distance_model.upper - near[i].distance_model.lower <= 1e-6);
        }
        CHECK(found[3].upper == INFINITY && near[3].distance_model.upper == INFINITY && near[3].splits == 0);
        CHECK(found[3].lower == (to == LEAFLESS_DISTANCE_TO_BOUNDARY ? -INFINITY : 0.0));
    }
    OK(leafless_octree_distances(octree, NULL, 0, 0, NULL, NULL));
    OK(leafless_solid_distances(solid, &frame, NULL, 0, 0, 0.0, NULL, NULL));
    CHECK(leafless_octree_distances(octree, &at[0][0], 1, 3, NULL, found) == LEAFLESS_E_ARGUMENT);
    CHECK(leafless_solid_distances(solid, &frame, &at[0][0], 1, 0, -1.0, NULL, near) == LEAFLESS_E_ARGUMENT);
}

static void nearest(const leafless_octree *octree) {
    static leafless_near_cell cells[40000];
    const double at[3] = {2.0, 0.0, 0.0};
    uint64_t count = 7, i;
    OK(leafless_octree_nearest_cells(octree, at, LEAFLESS_TAGS_FULL, cells, 1, &count));
    CHECK(count == 1 && cells[0].found.tag == LEAFLESS_TAG_FULL);
    CHECK(cells[0].distance_model.lower >= 1.25 && cells[0].distance_model.upper < 1.45);
    CHECK(fabs(cells[0].point_model[0] - (2.0 - cells[0].distance_model.lower)) < 0.1);
    OK(leafless_octree_nearest_cells(octree, at, LEAFLESS_TAGS_LEAVES, cells, COUNT(cells), &count));
    CHECK(count > 1000 && count < COUNT(cells));
    for (i = 1; i < count; i++) {
        CHECK(cells[i].distance_model.upper >= cells[i - 1].distance_model.lower);
    }
    OK(leafless_octree_nearest_cells(octree, at, LEAFLESS_TAGS_FULL, NULL, 0, &count));
    CHECK(count == 0);
    CHECK(leafless_octree_nearest_cells(octree, at, 0, cells, 1, &count) == LEAFLESS_E_ARGUMENT);
}

static void field(const leafless_octree *octree) {
    static float entries[32][32][32][2];
    static const uint32_t min[3] = {0, 0, 0}, max[3] = {32, 32, 32}, beyond[3] = {33, 1, 1};
    const uint64_t capacity = 2 * 32 * 32 * 32;
    leafless_options options;
    int x, y, z;
    OK(leafless_octree_distance_field(octree, min, max, NULL, &entries[0][0][0][0], capacity));
    for (z = 0; z < 32; z++) {
        for (y = 0; y < 32; y++) {
            for (x = 0; x < 32; x++) {
                const double p[3] = {(x + 0.5) / 16 - 1, (y + 0.5) / 16 - 1, (z + 0.5) / 16 - 1};
                const double truth = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) - 0.75;
                CHECK(entries[z][y][x][0] <= truth && truth <= entries[z][y][x][1]);
            }
        }
    }
    OK(leafless_octree_distance_field(octree, max, max, NULL, NULL, 0));
    CHECK(leafless_octree_distance_field(octree, min, beyond, NULL, &entries[0][0][0][0], 66) == LEAFLESS_E_ARGUMENT);
    CHECK(leafless_octree_distance_field(octree, min, max, NULL, &entries[0][0][0][0], 2) == LEAFLESS_E_ARGUMENT);
    CHECK(leafless_octree_distance_field(octree, min, max, NULL, &entries[0][0][0][0], 3) == LEAFLESS_E_ARGUMENT);
    OK(leafless_init(&options, sizeof options));
    options.progress = refuse;
    CHECK(leafless_octree_distance_field(octree, min, max, &options, &entries[0][0][0][0], capacity) ==
          LEAFLESS_E_CANCELLED);
}

int main(void) {
    leafless_octree *octree = check_ball(DEPTH, LEAFLESS_RULE_CERTIFIED);
    leafless_solid *solid = check_ball_solid();
    points(octree, solid);
    nearest(octree);
    field(octree);
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    return 0;
}
