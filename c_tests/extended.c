/* Octrees that keep surfaces: a bored block, built, saved, mapped, asked where it lies and as a solid, and read. */
#include "check.h"

#include <math.h>

#define PI 3.14159265358979323846

static leafless_solid *bored_block(void) {
    static const double low[3] = {-2, -2, -1}, high[3] = {2, 2, 1}, from[3] = {0.25, 0, -2}, to[3] = {0.25, 0, 2};
    leafless_solid *parts[2] = {NULL, NULL}, *bored = NULL;
    OK(leafless_solid_new_box(low, high, &parts[0]));
    OK(leafless_solid_new_cylinder(from, to, 0.75, &parts[1]));
    OK(check_solids(LEAFLESS_OPERATION_DIFFERENCE, parts[0], parts[1], &bored));
    leafless_solid_free(parts[0]);
    leafless_solid_free(parts[1]);
    return bored;
}

/* Whether points are inside, but at a millionth of the surface. */
static int truth(const double *p) {
    const double across = sqrt((p[0] - 0.25) * (p[0] - 0.25) + p[1] * p[1]) - 0.75;
    double inside = across;
    inside = fmin(inside, 2 - fabs(p[0]));
    inside = fmin(inside, 2 - fabs(p[1]));
    inside = fmin(inside, 1 - fabs(p[2]));
    return inside > 1e-6 ? 1 : inside < -1e-6 ? -1 : 0;
}

static void points(const leafless_octree *octree) {
    uint32_t state = 1;
    int i, axis, sharp = 0;
    for (i = 0; i < 20000; i++) {
        double p[3];
        leafless_membership found;
        for (axis = 0; axis < 3; axis++) {
            state = state * 1664525u + 1013904223u;
            p[axis] = (state / 4294967296.0 - 0.5) * 4.2;
        }
        OK(leafless_octree_contains(octree, p, &found));
        if (truth(p) > 0) {
            CHECK(found == LEAFLESS_MEMBERSHIP_INSIDE);
        } else if (truth(p) < 0) {
            CHECK(found == LEAFLESS_MEMBERSHIP_OUTSIDE);
        }
        sharp += truth(p) != 0;
    }
    CHECK(sharp > 19000);
}

static void cuts(const leafless_octree *octree) {
    leafless_cut_counts counts = LEAFLESS_INIT(leafless_cut_counts);
    leafless_stored_surface_info info = LEAFLESS_INIT(leafless_stored_surface_info);
    leafless_cell_function function;
    uint32_t surface, planes = 0, quadrics = 0, level, found = 0, index[3];
    double terms[70], placements[24];
    OK(leafless_octree_count_cuts(octree, &counts));
    CHECK(counts.surfaces == 7 && counts.cells > 0 && counts.given_up == 0 && counts.bytes > 0);
    for (surface = 0; surface < counts.surfaces; surface++) {
        OK(leafless_octree_surface_at(octree, surface, &info, terms, 70, placements, 24));
        CHECK(info.term_count > 0 && info.term_count <= 70 && !info.has_origin && info.placement_count <= 2);
        planes += info.kind == LEAFLESS_STORED_SURFACE_KIND_PLANE && info.number_count == 4;
        quadrics += info.kind == LEAFLESS_STORED_SURFACE_KIND_QUADRIC && info.number_count == 10;
    }
    CHECK(planes == 6 && quadrics == 1);
    /* A corner of the block: three planes, all on their positive or all on their negative side. */
    for (level = 0; level < 6; level++) {
        const leafless_frame frame = {{-2.5, -2.5, -2.5}, 5, 20};
        const double corner[3] = {1.999, 1.999, 0.999};
        int axis;
        for (axis = 0; axis < 3; axis++) {
            index[axis] = (uint32_t)((corner[axis] - frame.origin[axis]) / frame.edge * (1u << level));
        }
        OK(leafless_octree_cell_function(octree, level, index, &function));
        if (function.surface_count == 3) {
            int bits = 0, m;
            for (m = 0; m < 8; m++) bits += function.table >> m & 1;
            CHECK(bits == 1);
            found++;
        }
    }
    CHECK(found > 0);
}

int main(void) {
    const leafless_frame frame = {{-2.5, -2.5, -2.5}, 5, 20};
    const double volume = 4 * 4 * 2 - PI * 0.75 * 0.75 * 2, from[3] = {-2.4, 0.1, 0.2}, along[3] = {1, 0, 0};
    const leafless_sink to = leafless_to_file("extended.lfl");
    const leafless_source in = leafless_from_file("extended.lfl", LEAFLESS_ACCESS_MAP);
    leafless_solid *solid = bored_block(), *stored = NULL;
    leafless_octree *octree = NULL, *mapped = NULL, *plain = NULL;
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
    leafless_measures measures = LEAFLESS_INIT(leafless_measures);
    leafless_cut_counts counts = LEAFLESS_INIT(leafless_cut_counts);
    leafless_statistics statistics;
    leafless_ray ray;
    leafless_ray_hit hit;
    OK(leafless_octree_build_extended(solid, &frame, NULL, NULL, &octree));
    OK(leafless_octree_write(octree, &to));
    OK(leafless_octree_read(&in, &mapped));
    CHECK(check_same(octree, mapped));
    OK(leafless_octree_describe(mapped, &info));
    CHECK(info.bytes < 6000 && info.root == LEAFLESS_TAG_BRANCH);
    points(octree);
    points(mapped);
    cuts(mapped);

    memset(&ray, 0, sizeof ray);
    memcpy(ray.origin_model, from, sizeof from);
    memcpy(ray.direction_model, along, sizeof along);
    ray.t_last = INFINITY;
    OK(leafless_octree_cast_rays(mapped, &ray, 1, LEAFLESS_OBSTACLE_UPPER, &hit));
    CHECK(hit.t.lower <= 0.4 && hit.t.upper >= 0.4 && hit.t.upper - hit.t.lower < 1e-8);

    OK(leafless_solid_from_octree(mapped, &stored));
    OK(leafless_solid_measure(stored, &frame, 1e-6, 0.0, NULL, &measures));
    CHECK(measures.volume_model.lower <= volume && volume <= measures.volume_model.upper);
    CHECK(measures.volume_model.upper - measures.volume_model.lower < 1e-3);

    OK(leafless_octree_plain(mapped, 6, LEAFLESS_RULE_CERTIFIED, NULL, &plain));
    OK(leafless_octree_count_cuts(plain, &counts));
    CHECK(counts.cells == 0 && counts.surfaces == 0 && counts.given_up == 0);
    OK(leafless_octree_statistics(plain, &statistics));
    CHECK(statistics.volume_model.lower < volume && volume < statistics.volume_model.upper && statistics.nodes > 100);

    leafless_octree_free(plain);
    leafless_solid_free(stored);
    leafless_octree_free(mapped);
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    return 0;
}
