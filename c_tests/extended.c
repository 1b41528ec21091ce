/* Octrees that keep surfaces: a bored block, built, saved, mapped, queried in place and as a solid, and read; a plate that is
 * bored twenty times by set operations. */
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

static leafless_octree *kept(leafless_solid *solid, const leafless_frame *frame) {
    leafless_octree *octree = NULL;
    OK(leafless_octree_build_extended(solid, frame, NULL, NULL, &octree));
    leafless_solid_free(solid);
    return octree;
}

static leafless_octree *combined(leafless_operation operation, const leafless_octree *a, const leafless_octree *b) {
    const leafless_octree *both[2];
    leafless_octree *result = NULL;
    both[0] = a, both[1] = b;
    OK(leafless_octree_combine(operation, both, 2, NULL, &result));
    OK(leafless_octree_check(result));
    return result;
}

static leafless_tag root(const leafless_octree *octree) {
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
    OK(leafless_octree_describe(octree, &info));
    return info.root;
}

/* Set operations keep surfaces: twenty bores one by one and at once. */
static void set_operations(void) {
    enum { BORES = 20 };
    const double low[3] = {0, 0, 0}, high[3] = {80, 60, 10}, truth = 48000 - BORES * PI * 2.5 * 2.5 * 10;
    const leafless_sink to = leafless_to_file("plate.lfl");
    const leafless_source in = leafless_from_file("plate.lfl", LEAFLESS_ACCESS_MAP);
    const leafless_octree *operands[1 + BORES];
    leafless_options options = LEAFLESS_INIT(leafless_options);
    leafless_octree *trees[1 + BORES], *part, *next, *at_once = NULL, *mapped = NULL, *plain = NULL, *other = NULL;
    leafless_measures measures = LEAFLESS_INIT(leafless_measures);
    leafless_cut_counts counts = LEAFLESS_INIT(leafless_cut_counts);
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
    leafless_solid *solid = NULL;
    leafless_membership where;
    leafless_frame frame, coarse;
    double point[3] = {0, 7.5, 5};
    int k;
    OK(leafless_frame_around(low, high, 20, &frame));
    OK(leafless_solid_new_box(low, high, &solid));
    trees[0] = kept(solid, &frame);
    for (k = 0; k < BORES; k++) {
        double from[3] = {0, 0, -1}, end[3] = {0, 0, 11};
        from[0] = end[0] = 8 + 16 * (k % 5);
        from[1] = end[1] = 7.5 + 15 * (k / 5);
        OK(leafless_solid_new_cylinder(from, end, 2.5, &solid));
        trees[1 + k] = kept(solid, &frame);
    }
    part = combined(LEAFLESS_OPERATION_UNION, trees[0], trees[0]);
    CHECK(check_same(part, trees[0]));
    for (k = 0; k < BORES; k++) {
        next = combined(LEAFLESS_OPERATION_DIFFERENCE, part, trees[1 + k]);
        leafless_octree_free(part);
        part = next;
    }
    for (k = 0; k <= BORES; k++) operands[k] = trees[k];
    OK(leafless_octree_combine(LEAFLESS_OPERATION_DIFFERENCE, operands, 1 + BORES, NULL, &at_once));
    CHECK(check_same(part, at_once));

    /* Saved, mapped, measured. */
    OK(leafless_octree_write(part, &to));
    OK(leafless_octree_read(&in, &mapped));
    CHECK(check_same(part, mapped));
    OK(leafless_octree_describe(mapped, &info));
    OK(leafless_octree_count_cuts(mapped, &counts));
    CHECK(info.bytes < 6000 && counts.surfaces == 6 + BORES && counts.given_up == 0);
    OK(leafless_solid_from_octree(mapped, &solid));
    OK(leafless_solid_measure(solid, &frame, 1e-6, 0.0, NULL, &measures));
    CHECK(measures.volume_model.lower <= truth && truth <= measures.volume_model.upper);
    CHECK(measures.volume_model.upper - measures.volume_model.lower < 1.01e-6 * truth);
    leafless_solid_free(solid);
    point[0] = 8 + 2.5 + 1e-9;
    OK(leafless_octree_contains(mapped, point, &where));
    CHECK(where == LEAFLESS_MEMBERSHIP_INSIDE);
    point[0] = 8 + 2.5 - 1e-9;
    OK(leafless_octree_contains(mapped, point, &where));
    CHECK(where == LEAFLESS_MEMBERSHIP_OUTSIDE);

    /* Surfaces that are one are one. */
    next = combined(LEAFLESS_OPERATION_DIFFERENCE, mapped, at_once);
    CHECK(root(next) == LEAFLESS_TAG_EMPTY);
    leafless_octree_free(next);
    next = combined(LEAFLESS_OPERATION_XOR, part, mapped);
    CHECK(root(next) == LEAFLESS_TAG_EMPTY);
    leafless_octree_free(next);
    next = combined(LEAFLESS_OPERATION_INTERSECTION, part, trees[1]);
    CHECK(root(next) == LEAFLESS_TAG_EMPTY);
    leafless_octree_free(next);
    OK(leafless_octree_complement(mapped, NULL, &next));
    OK(leafless_octree_complement(next, NULL, &other));
    CHECK(check_same(other, part) && !check_same(next, part));
    leafless_octree_free(other);
    leafless_octree_free(next);

    /* What is filled again is as it was. */
    operands[0] = part;
    OK(leafless_octree_combine(LEAFLESS_OPERATION_UNION, operands, 1 + BORES, NULL, &next));
    other = combined(LEAFLESS_OPERATION_INTERSECTION, next, trees[0]);
    CHECK(check_same(other, trees[0]));
    leafless_octree_free(other);
    leafless_octree_free(next);

    /* Without surfaces an octree takes part as a certified one. */
    OK(leafless_octree_plain(trees[1], 6, LEAFLESS_RULE_CERTIFIED, NULL, &plain));
    other = NULL;
    operands[0] = part, operands[1] = plain;
    FAILS(LEAFLESS_E_FRAME, leafless_octree_combine(LEAFLESS_OPERATION_UNION, operands, 2, NULL, &other));
    leafless_octree_free(plain);
    coarse = frame, coarse.depth = 6;
    plain = NULL, next = NULL;
    OK(leafless_solid_from_octree(part, &solid));
    OK(leafless_octree_build_extended(solid, &coarse, NULL, NULL, &next));
    leafless_solid_free(solid);
    OK(leafless_solid_from_octree(trees[1], &solid));
    OK(leafless_octree_build(solid, &coarse, LEAFLESS_RULE_CERTIFIED, NULL, &plain));
    leafless_solid_free(solid);
    other = combined(LEAFLESS_OPERATION_UNION, next, plain);
    OK(leafless_octree_count_cuts(other, &counts));
    CHECK(counts.cells > 0 && counts.given_up > 0);
    point[0] = 8;
    OK(leafless_octree_contains(other, point, &where));
    CHECK(where == LEAFLESS_MEMBERSHIP_INSIDE);
    point[0] = 8 + 2.5;
    OK(leafless_octree_contains(other, point, &where));
    CHECK(where == LEAFLESS_MEMBERSHIP_UNDECIDED);
    leafless_octree_free(other);
    leafless_octree_free(next);
    leafless_octree_free(plain);

    /* What is refused. */
    other = NULL;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_resolve(mapped, LEAFLESS_RULE_INNER, NULL, &other));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_resolve(mapped, LEAFLESS_RULE_CERTIFIED, NULL, &other));
    operands[0] = mapped, operands[1] = trees[1];
    options.max_bytes = 64;
    FAILS(LEAFLESS_E_LIMIT, leafless_octree_combine(LEAFLESS_OPERATION_DIFFERENCE, operands, 2, &options, &other));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_combine(LEAFLESS_OPERATION_DIFFERENCE, operands, 0, NULL, &other));
    CHECK(other == NULL);

    leafless_octree_free(mapped);
    leafless_octree_free(at_once);
    leafless_octree_free(part);
    for (k = 0; k <= BORES; k++) leafless_octree_free(trees[k]);
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
    set_operations();
    return 0;
}
