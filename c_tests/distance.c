/* Distances of points and cells from a ball, and the cells nearest to a point; points of a closed mesh, which tells its nearest
   points itself. */
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

/* A cube of triangles: where a point lies, how far away, and the nearest point and triangle. */
static void closed_mesh(const leafless_solid *ball) {
    static const double at[7][3] = {{0.25, 0.5, -2},  {0.75, 0.25, 3}, {0.5, -0.5, 0.25}, {0.5, 0.125, 0.25},
                                    {2, 0.75, 0.625}, {4, 5, 1},       {0.0, NAN, 0.0}};
    static const double nearest_points[6][3] = {{0.25, 0.5, 0}, {0.75, 0.25, 1}, {0.5, 0, 0.25},
                                                {0.5, 0, 0.25}, {1, 0.75, 0.625}, {1, 1, 1}};
    static const double truth[6] = {2, 2, 0.5, -0.125, 1, 5};
    /* Faces of two triangles each; all three that meet in a corner are as near. */
    static const uint32_t faces[5] = {0, 1, 2, 2, 5};
    const leafless_frame frame = {{-3, -3, -3}, 16, 6};
    leafless_membership where[7];
    leafless_point_distance near[7];
    leafless_mesh *mesh = check_cube();
    leafless_solid *cube;
    uint32_t to;
    int i, axis;
    OK(leafless_solid_from_mesh(mesh, LEAFLESS_FILL_NON_ZERO, &cube));
    OK(leafless_solid_contains_many(cube, &frame, &at[0][0], 7, NULL, where));
    for (i = 0; i < 7; i++) {
        CHECK(where[i] == (i == 6 ? LEAFLESS_MEMBERSHIP_UNDECIDED
                           : i == 3 ? LEAFLESS_MEMBERSHIP_INSIDE : LEAFLESS_MEMBERSHIP_OUTSIDE));
    }
    for (to = LEAFLESS_DISTANCE_TO_SOLID; to <= LEAFLESS_DISTANCE_TO_BOUNDARY; to++) {
        OK(leafless_solid_distances(cube, &frame, &at[0][0], 7, to, 1e-9, NULL, near));
        for (i = 0; i < 6; i++) {
            const double outside = truth[i] > 0 ? truth[i] : 0, inside = outside - truth[i];
            const double wanted = to == LEAFLESS_DISTANCE_TO_SOLID ? outside
                                  : to == LEAFLESS_DISTANCE_TO_COMPLEMENT ? inside : truth[i];
            const leafless_interval distance = near[i].distance_model;
            CHECK(distance.lower <= wanted && wanted <= distance.upper && distance.upper - distance.lower < 1e-9);
            CHECK(near[i].has_nearest && near[i].splits == 0 && near[i].measured == LEAFLESS_STOP_REASON_TOLERANCE);
            CHECK(near[i].surface < 12 && (i == 5 || near[i].surface / 2 == faces[i]));
            for (axis = 0; axis < 3; axis++) {
                CHECK(fabs(near[i].nearest_model[axis] - nearest_points[i][axis]) < 1e-12);
            }
        }
        CHECK(!near[6].has_nearest && near[6].surface == UINT32_MAX && near[6].nearest_model[0] == 0);
        /* A ball has no numbers of surfaces, and a point unless the distance is that of a point within. */
        OK(leafless_solid_distances(ball, &frame, &at[0][0], 1, to, 1e-3, NULL, near));
        CHECK(near[0].has_nearest == (near[0].distance_model.lower != 0) && near[0].surface == UINT32_MAX);
    }
    leafless_solid_free(cube);
    leafless_mesh_free(mesh);
}

int main(void) {
    leafless_octree *octree = check_ball(DEPTH, LEAFLESS_RULE_CERTIFIED);
    leafless_solid *solid = check_ball_solid();
    points(octree, solid);
    closed_mesh(solid);
    nearest(octree);
    field(octree);
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    return 0;
}
