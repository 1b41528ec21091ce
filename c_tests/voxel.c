/* Voxel records: of a ball, against its cells one by one. */
#include "check.h"

#define DEPTH 4
#define MOST 8192

static leafless_octree *octree;
static leafless_frame lattice;
static uint64_t codes[MOST], count;
static uint8_t levels[MOST], kinds[MOST];
static double corners[MOST][3], values[MOST][2];

/* x + 2 y and z. */
static int32_t values_at(void *ctx, const double *points, uint64_t number, double *to) {
    uint64_t i;
    ++*(uint64_t *)ctx;
    for (i = 0; i < number; i++, points += 3, to += 2) {
        to[0] = points[0] + 2 * points[1];
        to[1] = points[2];
    }
    return 0;
}

static int32_t range_in(void *ctx, const double *min, const double *max, leafless_value_range *range) {
    (void)ctx;
    range->kind = LEAFLESS_RANGE_KIND_WITHIN;
    range->values[0].lower = min[0] + 2 * min[1] - 1e-9;
    range->values[0].upper = max[0] + 2 * max[1] + 1e-9;
    range->values[1].lower = min[2];
    range->values[1].upper = max[2];
    return 0;
}

static int32_t fails(void *ctx, const double *points, uint64_t number, double *to) {
    (void)ctx, (void)points, (void)number, (void)to;
    return 42;
}

static void place_of(uint64_t i, uint32_t at[3]) {
    uint32_t axis, k;
    at[0] = at[1] = at[2] = 0;
    for (axis = 0; axis < 3; axis++) {
        for (k = 0; k < lattice.depth; k++) {
            at[axis] |= (uint32_t)(codes[i] >> (3 * k + axis) & 1) << k;
        }
    }
}

static void list(const leafless_voxel_options *options) {
    uint64_t again = 0;
    OK(leafless_octree_voxels(octree, options, NULL, &lattice, NULL, NULL, NULL, NULL, NULL, 0, &count));
    CHECK(count > 0 && count <= MOST);
    OK(leafless_octree_voxels(octree, options, NULL, &lattice, codes, levels, kinds, &corners[0][0], &values[0][0],
                              count, &again));
    CHECK(again == count);
    FAILS(LEAFLESS_E_BUFFER, leafless_octree_voxels(octree, options, NULL, &lattice, codes, NULL, NULL, NULL, NULL,
                                                    count - 1, &again));
}

/* Every finest cell is in a record that agrees with its tag. */
static void against_cells(void) {
    const uint32_t n = 1u << DEPTH, up = lattice.depth - DEPTH;
    uint32_t at[3], place[3], axis;
    uint64_t index, i;
    for (at[2] = 0; at[2] < n; at[2]++) {
        for (at[1] = 0; at[1] < n; at[1]++) {
            for (at[0] = 0; at[0] < n; at[0]++) {
                const uint32_t first[3] = {at[0] << up, at[1] << up, at[2] << up};
                leafless_tag tag;
                OK(leafless_octree_tag_at(octree, at, &tag));
                OK(leafless_voxels_find(&lattice, codes, levels, kinds, count, first, lattice.depth, &index));
                if (tag == LEAFLESS_TAG_EMPTY) {
                    CHECK(index == UINT64_MAX);
                } else {
                    const uint8_t kind = tag == LEAFLESS_TAG_FULL ? LEAFLESS_VOXEL_KIND_INSIDE : LEAFLESS_VOXEL_KIND_BOUNDARY;
                    CHECK(index < count && kinds[index] == kind);
                }
            }
        }
    }
    for (i = 0; i < count; i++) {
        CHECK(i == 0 || codes[i - 1] < codes[i] || (codes[i - 1] == codes[i] && levels[i - 1] < levels[i]));
        place_of(i, place);
        for (axis = 0; axis < 3; axis++) {
            CHECK(corners[i][axis] == -1 + place[axis] * 2.0 / (double)(1u << lattice.depth));
        }
    }
}

static void attributes(void) {
    leafless_attribute_callbacks callbacks;
    leafless_attribute *attribute, *failing;
    leafless_voxel_options options;
    uint64_t calls = 0, i, few;
    OK(leafless_init(&callbacks, sizeof callbacks));
    callbacks.components = 2;
    callbacks.values = values_at;
    callbacks.range = range_in;
    callbacks.ctx = &calls;
    OK(leafless_attribute_new_callbacks(&callbacks, &attribute));
    callbacks.values = fails;
    OK(leafless_attribute_new_callbacks(&callbacks, &failing));
    OK(leafless_init(&options, sizeof options));
    options.coarse_model = 0.5;
    options.fine_model = 1.0 / 32;
    options.tolerance = 0.4;
    options.criterion = LEAFLESS_CRITERION_VARIANCE;
    options.attribute = attribute;
    options.lists = LEAFLESS_VOXEL_LISTS_REFINED;
    list(&options);
    few = count;
    CHECK(calls > 0 && lattice.depth == 6);
    against_cells();
    for (i = 0; i < count; i++) {
        const double half = 1.0 / (double)(1u << levels[i]);
        const double *corner = corners[i];
        CHECK(values[i][0] == corner[0] + half + 2 * (corner[1] + half) && values[i][1] == corner[2] + half);
    }
    options.criterion = LEAFLESS_CRITERION_RANGE;
    list(&options);
    CHECK(count > few);
    against_cells();
    options.attribute = failing;
    FAILS(LEAFLESS_E_CALLBACK,
          leafless_octree_voxels(octree, &options, NULL, &lattice, NULL, NULL, NULL, NULL, NULL, 0, &count));
    options.attribute = attribute;
    options.criterion = LEAFLESS_CRITERION_NONE;
    FAILS(LEAFLESS_E_ARGUMENT,
          leafless_octree_voxels(octree, &options, NULL, &lattice, NULL, NULL, NULL, NULL, NULL, 0, &count));
    options.fine_model = options.tolerance = 0;
    list(&options);
    options.criterion = 7;
    FAILS(LEAFLESS_E_ARGUMENT,
          leafless_octree_voxels(octree, &options, NULL, &lattice, NULL, NULL, NULL, NULL, NULL, 0, &count));
    leafless_attribute_free(attribute);
    leafless_attribute_free(failing);
}

/* Along the direction no voxel lies wholly before the one that comes before it in the order, on all axes. */
static void orders(void) {
    static uint64_t order[MOST];
    const double direction[3] = {1, 0, -1}, eye[3] = {0.1, 0.2, 5}, zero[3] = {0, 0, 0};
    uint64_t number = 0, i, j;
    OK(leafless_voxels_order(&lattice, codes, levels, kinds, count, direction, false, NULL, NULL, 0, &number));
    CHECK(number == count);
    OK(leafless_voxels_order(&lattice, codes, levels, kinds, count, direction, false, NULL, order, number, &number));
    for (i = 0; i < number; i++) {
        for (j = i + 1; j < number; j++) {
            const double *a = corners[order[i]], *b = corners[order[j]];
            const double a_edge = 2.0 / (1u << levels[order[i]]), b_edge = 2.0 / (1u << levels[order[j]]);
            const bool beside_y = b[1] + b_edge <= a[1] || a[1] + a_edge <= b[1];
            CHECK(beside_y || !(b[0] + b_edge <= a[0] && b[2] >= a[2] + a_edge));
        }
    }
    OK(leafless_voxels_order(&lattice, codes, levels, kinds, count, eye, true, NULL, order, number, &number));
    CHECK(corners[order[0]][2] > corners[order[number - 1]][2]);
    FAILS(LEAFLESS_E_BUFFER, leafless_voxels_order(&lattice, codes, levels, kinds, count, eye, true, NULL, order,
                                                   number - 1, &number));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_voxels_order(&lattice, codes, levels, kinds, count, zero, false, NULL, order,
                                                     number, &number));
    levels[0] = 99;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_voxels_order(&lattice, codes, levels, kinds, count, eye, true, NULL, order,
                                                     number, &number));
}

/* Each finest cell of the octree that moved records make is the cell of the octree that it comes from. */
static void moves(void) {
    static uint64_t moved_codes[MOST], sources[MOST];
    static uint8_t moved_levels[MOST], moved_kinds[MOST];
    static const int32_t axes[][3] = {{1, 2, 3}, {2, 3, 1}, {-1, 3, 2}, {-3, -2, -1}, {1, -2, 3}};
    static const int32_t offsets[][3] = {{0, 0, 0}, {1, 0, 0}, {-3, 5, 8}, {16, 0, 0}, {8, -8, 0}};
    static const int32_t wrong[][3] = {{1, 2, 2}, {0, 1, 2}, {1, 2, 4}, {INT32_MIN, 1, 2}};
    uint64_t number = 0, again = 0, i, j, k;
    for (i = 0; i < COUNT(axes); i++) {
        for (j = 0; j < COUNT(offsets); j++) {
            leafless_octree *moved = NULL;
            OK(leafless_voxels_moved(&lattice, codes, levels, kinds, count, axes[i], offsets[j], NULL, NULL, NULL, NULL,
                                     NULL, 0, &number));
            CHECK(number <= MOST && (number == 0) == (j == 3));
            OK(leafless_voxels_moved(&lattice, codes, levels, kinds, count, axes[i], offsets[j], NULL, moved_codes,
                                     moved_levels, moved_kinds, sources, number, &again));
            CHECK(again == number && (j > 0 || number == count));
            for (k = 0; k < number; k++) {
                CHECK(sources[k] < count && moved_kinds[k] == kinds[sources[k]]);
                CHECK(moved_levels[k] >= levels[sources[k]]);
            }
            OK(leafless_octree_from_voxels(&lattice, moved_codes, moved_levels, moved_kinds, number,
                                           LEAFLESS_TAG_PARTIAL, NULL, &moved));
            for (k = 0; k < 4096; k++) {
                const uint32_t at[3] = {(uint32_t)k & 15, (uint32_t)k >> 4 & 15, (uint32_t)k >> 8};
                uint32_t from[3];
                leafless_tag first = LEAFLESS_TAG_EMPTY, second;
                int axis;
                bool inside = true;
                for (axis = 0; axis < 3; axis++) {
                    const int32_t old = axes[i][axis], back = (int32_t)at[axis] - offsets[j][axis];
                    inside = inside && back >= 0 && back < 16;
                    from[(old < 0 ? -old : old) - 1] = (uint32_t)(old < 0 ? 15 - back : back);
                }
                if (inside) OK(leafless_octree_tag_at(octree, from, &first));
                OK(leafless_octree_tag_at(moved, at, &second));
                CHECK(first == second);
            }
            leafless_octree_free(moved);
        }
    }
    OK(leafless_voxels_moved(&lattice, codes, levels, kinds, count, axes[1], offsets[1], NULL, NULL, NULL, NULL, sources,
                             MOST, &number));
    FAILS(LEAFLESS_E_BUFFER, leafless_voxels_moved(&lattice, codes, levels, kinds, count, axes[1], offsets[1], NULL, NULL,
                                                   moved_levels, NULL, NULL, number - 1, &again));
    for (i = 0; i < COUNT(wrong); i++) {
        FAILS(LEAFLESS_E_ARGUMENT, leafless_voxels_moved(&lattice, codes, levels, kinds, count, wrong[i], offsets[1],
                                                         NULL, NULL, NULL, NULL, NULL, 0, &again));
    }
}

/* A voxel that is cut out of the cube's faces meets triangles just if it touches a face. */
static void triangles(void) {
    static uint64_t offsets[65], offset_count, triangle_count;
    static uint32_t indices[4096];
    const leafless_frame frame = {{-0.5, -0.5, -0.5}, 2.0, 2};
    const leafless_mesh_arrays arrays = check_arrays(CHECK_CUBE, 8, CHECK_CUBE_TRIANGLES, 12);
    leafless_mesh *mesh = NULL;
    uint64_t i;
    OK(leafless_mesh_new(&arrays, &mesh));
    for (i = 0; i < 64; i++) {
        codes[i] = i;
        levels[i] = 2;
        kinds[i] = LEAFLESS_VOXEL_KIND_BOUNDARY;
    }
    OK(leafless_voxels_triangles(&frame, codes, levels, kinds, 64, mesh, NULL, NULL, 0, &offset_count, NULL, 0,
                                 &triangle_count));
    CHECK(offset_count == 65 && triangle_count <= COUNT(indices));
    OK(leafless_voxels_triangles(&frame, codes, levels, kinds, 64, mesh, NULL, offsets, 65, &offset_count, indices,
                                 triangle_count, &triangle_count));
    CHECK(offsets[0] == 0 && offsets[64] == triangle_count);
    for (i = 0; i < 64; i++) {
        /* The cube's faces lie in planes between the first two cells of an axis, and the last two: all cells touch. */
        uint64_t k;
        CHECK(offsets[i] < offsets[i + 1]);
        for (k = offsets[i]; k < offsets[i + 1]; k++) {
            CHECK(indices[k] < 12 && (k == offsets[i] || indices[k - 1] < indices[k]));
        }
    }
    FAILS(LEAFLESS_E_BUFFER, leafless_voxels_triangles(&frame, codes, levels, kinds, 64, mesh, NULL, offsets, 64,
                                                       &offset_count, NULL, 0, &triangle_count));
    leafless_mesh_free(mesh);
}

int main(void) {
    leafless_octree *again = NULL;
    uint64_t pieces = 0;
    octree = check_ball(DEPTH, LEAFLESS_RULE_CERTIFIED);
    list(NULL);
    CHECK(lattice.depth == DEPTH && lattice.edge == 2);
    against_cells();
    OK(leafless_octree_from_voxels(&lattice, codes, levels, kinds, count, LEAFLESS_TAG_PARTIAL, NULL, &again));
    for (pieces = 0; pieces < 4096; pieces++) {
        const uint32_t at[3] = {(uint32_t)pieces & 15, (uint32_t)pieces >> 4 & 15, (uint32_t)pieces >> 8};
        leafless_tag first, second;
        OK(leafless_octree_tag_at(octree, at, &first));
        OK(leafless_octree_tag_at(again, at, &second));
        CHECK(first == second);
    }
    leafless_octree_free(again);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_from_voxels(&lattice, codes, levels, kinds, count, LEAFLESS_TAG_BRANCH,
                                                           NULL, &again));
    moves();
    orders();
    attributes();
    triangles();
    leafless_octree_free(octree);
    return 0;
}
