/* How much of a ball lies in boxes, and how balls lie to it. */
#include "check.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

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
        leafless_solid_free(ball);
    }
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    return 0;
}
