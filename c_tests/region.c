/* How much of a ball lies in boxes, and how balls lie to it. */
#include "check.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

/* The octree has 64 cells along its edge of 2, the frame 128. Balls: inside, across the boundary, and outside. */
static void contents(const leafless_octree *octree, const leafless_solid *solid, const leafless_solid *ball,
                     const leafless_frame *frame, int i) {
    const double truth = 4.0 / 3.0 * PI / 64.0;
    leafless_cells_in cells, of_solid;
    leafless_interval volume, of_both;
    leafless_options options;
    OK(leafless_octree_cells_in(octree, ball, NULL, &cells));
    OK(leafless_octree_volume_in(octree, ball, NULL, &volume));
    OK(leafless_solid_cells_in(solid, ball, frame, NULL, &of_solid));
    OK(leafless_solid_volume_in(solid, ball, frame, NULL, &of_both));
    CHECK(cells.full_least <= cells.full_most && cells.upper_least <= cells.upper_most);
    CHECK(cells.full_least <= cells.upper_least && cells.full_most <= cells.upper_most);
    CHECK(volume.lower <= of_both.upper && of_both.lower <= volume.upper);
    if (i == 0) {
        CHECK(volume.lower <= truth && truth <= volume.upper && volume.upper - volume.lower < 0.03 * truth);
        CHECK(of_both.lower <= truth && truth <= of_both.upper);
        CHECK(of_solid.full_least > 6 * cells.full_least && of_solid.full_most < 8 * cells.full_most);
    } else if (i == 1) {
        CHECK(volume.lower > truth && volume.upper < 8.0 * truth && of_both.upper < volume.upper);
        CHECK(cells.full_most < cells.upper_most);
    } else {
        CHECK(volume.lower == 0 && cells.full_least == 0 && of_solid.full_least == 0);
    }
    OK(leafless_init(&options, sizeof options));
    options.max_splits = 1;
    OK(leafless_octree_cells_in(octree, ball, &options, &of_solid));
    CHECK(of_solid.full_least <= cells.full_least && cells.upper_most <= of_solid.upper_most);
}

int main(void) {
    leafless_octree *octree = check_ball(6, LEAFLESS_RULE_CERTIFIED);
    leafless_solid *solid = check_ball_solid();
    const leafless_frame frame = check_frame(7);
    const double low[3] = {-1.0, -1.0, -1.0}, middle[3] = {0.0, 0.0, 0.0}, high[3] = {INFINITY, INFINITY, INFINITY};
    const double eighth = PI / 6.0 * 0.75 * 0.75 * 0.75;
    const uint32_t first[3] = {0, 0, 0}, half[3] = {32, 32, 32}, end[3] = {64, 64, 64}, beyond[3] = {65, 1, 1};
    const struct {
        double x, radius;
        leafless_region expected;
    } balls[3] = {{0.25, 0.25, LEAFLESS_REGION_INSIDE},
                  {0.5, 0.5, LEAFLESS_REGION_CROSSING},
                  {1.5, 0.5, LEAFLESS_REGION_OUTSIDE}};
    leafless_interval volume;
    leafless_statistics statistics;
    uint64_t least, most, least_all, most_all;
    int i;
    OK(leafless_octree_volume_in_box(octree, middle, high, &volume));
    CHECK(volume.lower <= eighth && eighth <= volume.upper && volume.upper < 1.5 * volume.lower);
    OK(leafless_octree_volume_in_box(octree, middle, middle, &volume));
    CHECK(volume.lower == 0 && volume.upper == 0);
    CHECK(leafless_octree_volume_in_box(octree, middle, low, &volume) == LEAFLESS_E_ARGUMENT);
    OK(leafless_octree_cells_in_box(octree, first, end, &least_all, &most_all));
    OK(leafless_octree_statistics(octree, &statistics));
    CHECK(least_all == statistics.lower_cells && most_all == statistics.upper_cells);
    OK(leafless_octree_cells_in_box(octree, first, half, &least, &most));
    CHECK(8 * least == least_all && 8 * most == most_all && least < most);
    CHECK(leafless_octree_cells_in_box(octree, first, beyond, &least, &most) == LEAFLESS_E_ARGUMENT);
    for (i = 0; i < 3; i++) {
        const double centre[3] = {balls[i].x, 0.0, 0.0};
        leafless_solid *ball = NULL;
        leafless_region relation;
        OK(leafless_solid_new_ball(centre, balls[i].radius, &ball));
        OK(leafless_solid_classify_in(solid, ball, &frame, NULL, &relation));
        CHECK(relation == balls[i].expected);
        contents(octree, solid, ball, &frame, i);
        leafless_solid_free(ball);
    }
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    return 0;
}
