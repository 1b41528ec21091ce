/* A plate with twenty bores, cut one by one and at once: octrees that keep their surfaces, saved, mapped and measured.
 *
 *     drilled_plate
 *
 * include/README.md describes how to build it.
 */
#include <leafless.h>

#include <stdio.h>

enum { BORES = 20 };

/* Makes the extended octree of a solid: undecided cells keep the surfaces that cross them. The solid is released. */
static leafless_status extended(leafless_solid *solid, const leafless_frame *frame, leafless_octree **octree) {
    leafless_status s = leafless_octree_build_extended(solid, frame, NULL, NULL, octree);
    leafless_solid_free(solid);
    return s;
}

static leafless_status bore(int k, const leafless_frame *frame, leafless_octree **octree) {
    const double x = 8.0 + 16.0 * (k % 5), y = 7.5 + 15.0 * (k / 5);
    const double from[3] = {x, y, -1}, to[3] = {x, y, 11};
    leafless_solid *solid = NULL;
    leafless_status s = leafless_solid_new_cylinder(from, to, 2.5, &solid);
    return s ? s : extended(solid, frame, octree);
}

static leafless_status less(const leafless_octree *stock, const leafless_octree *tool, leafless_octree **rest) {
    const leafless_octree *const both[2] = {stock, tool};
    return leafless_octree_combine(LEAFLESS_OPERATION_DIFFERENCE, both, 2, NULL, rest);
}

int main(void) {
    const double low[3] = {0, 0, 0}, high[3] = {80, 60, 10}, pi = 3.14159265358979323846;
    const double truth = 80.0 * 60.0 * 10.0 - BORES * pi * 2.5 * 2.5 * 10.0;
    const leafless_sink file = leafless_to_file("drilled_plate.lfl");
    const leafless_source in_place = leafless_from_file("drilled_plate.lfl", LEAFLESS_ACCESS_MAP);
    leafless_frame frame;
    leafless_solid *block = NULL, *solid = NULL;
    leafless_octree *trees[1 + BORES] = {NULL}, *at_once = NULL, *part = NULL, *mapped = NULL, *nothing = NULL;
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info), empty = LEAFLESS_INIT(leafless_octree_info);
    leafless_cut_counts cuts = LEAFLESS_INIT(leafless_cut_counts);
    leafless_measures measures = LEAFLESS_INIT(leafless_measures);
    bool same = false;
    int k;

    /* The greatest depth costs little, because cells with at most three exact surfaces are not split. */
    leafless_status s = leafless_frame_around(low, high, 20, &frame);
    if (!s) s = leafless_solid_new_box(low, high, &block);
    if (!s) s = extended(block, &frame, &trees[0]);
    for (k = 0; !s && k < BORES; k++) {
        s = bore(k, &frame, &trees[1 + k]);
    }

    /* One by one, as an operator decides on them ... */
    for (k = 0; !s && k < BORES; k++) {
        leafless_octree *rest = NULL;
        s = less(part ? part : trees[0], trees[1 + k], &rest);
        leafless_octree_free(part);
        part = rest;
    }
    /* ... or all at once, which copies the plate once instead of twenty times. */
    if (!s) {
        const leafless_octree *const *const operands = (const leafless_octree *const *)trees;
        s = leafless_octree_combine(LEAFLESS_OPERATION_DIFFERENCE, operands, 1 + BORES, NULL, &at_once);
    }
    if (!s) s = leafless_octree_equal(part, at_once, &same);

    /* Equal surfaces are recognised: the part minus itself is empty. */
    if (!s) s = less(part, at_once, &nothing);
    if (!s) s = leafless_octree_describe(nothing, &empty);

    /* The file consists of the octree's arrays. The mapped octree is measured to a millionth. */
    if (!s) s = leafless_octree_write(part, &file);
    if (!s) s = leafless_octree_read(&in_place, &mapped);
    if (!s) s = leafless_octree_describe(mapped, &info);
    if (!s) s = leafless_octree_count_cuts(mapped, &cuts);
    if (!s) s = leafless_solid_from_octree(mapped, &solid);
    if (!s) s = leafless_solid_measure(solid, &frame, 1e-6, 0.0, NULL, &measures);
    if (s) {
        char message[512];
        leafless_last_error(message, sizeof message);
        fprintf(stderr, "%s\n", message);
    } else {
        printf("one by one and at once: %s\n", same ? "the same octree" : "the same solid");
        printf("the part less itself:   %s\n", empty.root == LEAFLESS_TAG_EMPTY ? "empty" : "not empty");
        printf("bytes:                  %lu\n", (unsigned long)info.bytes);
        printf("surfaces, cells:        %lu, %lu, of which %lu are given up\n", (unsigned long)cuts.surfaces,
               (unsigned long)cuts.cells, (unsigned long)cuts.given_up);
        printf("volume:                 %.4f to %.4f\n", measures.volume_model.lower, measures.volume_model.upper);
        printf("truth:                  %.4f\n", truth);
    }
    leafless_solid_free(solid);
    leafless_octree_free(nothing), leafless_octree_free(mapped);
    leafless_octree_free(at_once), leafless_octree_free(part);
    for (k = 0; k <= BORES; k++) {
        leafless_octree_free(trees[k]);
    }
    remove("drilled_plate.lfl");
    return s || !same || measures.volume_model.lower > truth || truth > measures.volume_model.upper;
}
