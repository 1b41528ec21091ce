/* Tri-dexel models from arrays, converted to meshes, octrees, solids, voxels and files. */
#include "check.h"

#include <stdint.h>

enum { DEPTH = 5, SIDE = 1 << DEPTH };

static const double RADIUS = 0.75;

static leafless_tridexel *made(leafless_solid *solid, uint32_t normals) {
    const leafless_frame frame = check_frame(DEPTH);
    leafless_tridexel_format format;
    leafless_tridexel *model = NULL;
    OK(leafless_init(&format, sizeof format));
    format.normals = normals;
    format.has_surfaces = format.has_materials = normals != 0;
    OK(leafless_tridexel_build(solid, &frame, LEAFLESS_RULE_SAMPLED, &format, NULL, &model));
    leafless_solid_free(solid);
    return model;
}

static leafless_tridexel *ball(uint32_t normals) {
    return made(check_ball_solid(), normals);
}

static bool same(const leafless_tridexel *a, const leafless_tridexel *b) {
    bool equal = false;
    OK(leafless_tridexel_equal(a, b, &equal));
    return equal;
}

/* The arrays of a mesh. */
static void copied(const leafless_mesh *mesh, double (**vertices)[3], uint64_t *vertex_count, uint32_t (**triangles)[3],
                   uint64_t *triangle_count) {
    OK(check_counts(mesh, vertex_count, triangle_count));
    *vertices = (double(*)[3])malloc((size_t)*vertex_count * sizeof **vertices);
    *triangles = (uint32_t(*)[3])malloc((size_t)*triangle_count * sizeof **triangles);
    CHECK(*vertices != NULL && *triangles != NULL);
    OK(leafless_mesh_copy(mesh, &(*vertices)[0][0], *vertex_count, &(*triangles)[0][0], *triangle_count));
}

/* Six times the volume below the triangles: sums of determinants. */
static double volume_of(const leafless_mesh *mesh) {
    double(*v)[3], sum = 0;
    uint32_t(*t)[3];
    uint64_t vertex_count, triangle_count, i;
    copied(mesh, &v, &vertex_count, &t, &triangle_count);
    for (i = 0; i < triangle_count; i++) {
        const double *a = v[t[i][0]], *b = v[t[i][1]], *c = v[t[i][2]];
        sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    free(v);
    free(t);
    return sum / 6;
}

static void surfaces(void) {
    const double min[3] = {-0.43, -0.51, -0.37}, max[3] = {0.47, 0.39, 0.58};
    leafless_tridexel *model = ball(0), *box;
    leafless_solid *solid = NULL;
    leafless_mesh *cubes = NULL, *dual = NULL, *sharp = NULL;
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    leafless_dexel_surface_report found = LEAFLESS_INIT(leafless_dexel_surface_report);
    double(*vertices)[3];
    uint32_t(*triangles)[3];
    uint64_t vertex_count, triangle_count, i;
    OK(leafless_tridexel_surface(model, LEAFLESS_DEXEL_SURFACE_METHOD_MARCHING_CUBES, NULL, &found, &cubes));
    OK(leafless_mesh_inspect(cubes, &report));
    CHECK(report.is_closed && report.is_manifold && report.bodies == 1);
    copied(cubes, &vertices, &vertex_count, &triangles, &triangle_count);
    CHECK(found.crossings >= vertex_count && found.without_rays == 0 && found.disagreeing == 0);
    for (i = 0; i < vertex_count; i++) {
        /* The rounding along a ray is half of 2^-30, at any slope. */
        const double *at = vertices[i];
        CHECK(fabs(sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]) - RADIUS) < 2e-9);
    }
    free(vertices);
    free(triangles);
    CHECK(fabs(volume_of(cubes) - 4.0 / 3 * 3.14159265358979 * RADIUS * RADIUS * RADIUS) < 0.01);
    OK(leafless_tridexel_surface(model, LEAFLESS_DEXEL_SURFACE_METHOD_DUAL_CONTOURING, NULL, NULL, &dual));
    OK(leafless_mesh_inspect(dual, &report));
    CHECK(report.is_closed && report.bodies == 1);
    leafless_tridexel_free(model);
    /* The faces of a box lie between the planes of cells; its edges and corners are sharp. */
    OK(leafless_solid_new_box(min, max, &solid));
    box = made(solid, LEAFLESS_DEXEL_NORMALS_32);
    OK(leafless_tridexel_surface(box, LEAFLESS_DEXEL_SURFACE_METHOD_DUAL_CONTOURING, NULL, &found, &sharp));
    CHECK(found.without_normals == 0 && found.means == 0);
    CHECK(fabs(volume_of(sharp) - 0.9 * 0.9 * 0.95) < 1e-7);
    leafless_mesh_free(sharp);
    sharp = NULL;
    OK(leafless_tridexel_surface(box, LEAFLESS_DEXEL_SURFACE_METHOD_MARCHING_CUBES, NULL, NULL, &sharp));
    CHECK(volume_of(sharp) < 0.9 * 0.9 * 0.95 - 1e-4);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_tridexel_surface(box, 2, NULL, NULL, &sharp));
    leafless_mesh_free(sharp);
    leafless_mesh_free(dual);
    leafless_mesh_free(cubes);
    leafless_tridexel_free(box);
}

static void octrees_and_solids(void) {
    const leafless_frame frame = check_frame(DEPTH), other = {{-1.5, -1.5, -1.5}, 3, DEPTH}, nowhere = {{5, 5, 5}, 1, 3};
    leafless_tridexel *model = ball(0), *named = NULL, *again = NULL, *empty = NULL;
    leafless_octree *tree = NULL, *expected = check_ball(DEPTH, LEAFLESS_RULE_SAMPLED), *anew = NULL;
    leafless_solid *solid = NULL, *source = NULL;
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
    const char *value = NULL;
    size_t length = 0;
    leafless_measures measures = LEAFLESS_INIT(leafless_measures);
    OK(leafless_tridexel_with_metadata(model, "name", 4, "ball", 4, &named));
    OK(leafless_octree_from_tridexel(named, NULL, &tree));
    CHECK(check_same(tree, expected));
    OK(leafless_octree_describe(tree, &info));
    CHECK(!info.proof.full && !info.proof.empty && info.is_binary);
    OK(leafless_octree_peek_metadata(tree, "name", 4, &value, &length));
    CHECK(length == 4 && memcmp(value, "ball", 4) == 0);
    /* Back again: a model of an octree's cells. */
    OK(leafless_solid_from_octree(tree, &source));
    OK(leafless_tridexel_build(source, &frame, LEAFLESS_RULE_SAMPLED, NULL, NULL, &again));
    leafless_octree_free(tree);
    tree = NULL;
    OK(leafless_octree_from_tridexel(again, NULL, &tree));
    CHECK(check_same(tree, expected));
    /* By the ends: decided cells agree with the centres. */
    {
        leafless_octree *ends = NULL;
        leafless_statistics centres, bounds;
        OK(leafless_octree_from_tridexel_ends(model, NULL, &ends));
        OK(leafless_octree_describe(ends, &info));
        CHECK(!info.proof.full && !info.proof.empty && !info.is_binary);
        OK(leafless_octree_statistics(tree, &centres));
        OK(leafless_octree_statistics(ends, &bounds));
        CHECK(bounds.volume_model.lower < centres.volume_model.lower);
        CHECK(centres.volume_model.upper < bounds.volume_model.upper);
        leafless_octree_free(ends);
    }
    /* Sampled again on a lattice that is twice as coarse, and rotated. */
    {
        const double turned[12] = {0.8, -0.6, 0, 0, 0.6, 0.8, 0, 0, 0, 0, 1, 0};
        leafless_frame coarse = frame;
        leafless_solid *cells = NULL, *moved = NULL;
        leafless_octree *again_sampled = NULL;
        coarse.depth = DEPTH - 1;
        OK(leafless_solid_from_octree(tree, &cells));
        OK(leafless_solid_transformed(cells, &frame, turned, &moved));
        CHECK(leafless_octree_build(moved, &coarse, LEAFLESS_RULE_SAMPLED, NULL, &again_sampled) ==
              LEAFLESS_E_NOT_SAMPLED);
        leafless_solid_free(moved);
        OK(leafless_solid_resampled(cells, &frame, turned, &moved));
        OK(leafless_octree_build(moved, &coarse, LEAFLESS_RULE_SAMPLED, NULL, &again_sampled));
        leafless_octree_free(again_sampled);
        leafless_solid_free(moved);
        leafless_solid_free(cells);
    }
    /* As a solid on another frame. */
    OK(leafless_solid_from_tridexel(model, false, NULL, &solid));
    OK(leafless_octree_build(solid, &other, LEAFLESS_RULE_CERTIFIED, NULL, &anew));
    OK(leafless_octree_describe(anew, &info));
    CHECK(!info.proof.full && !info.proof.empty);
    leafless_octree_free(anew);
    leafless_solid_free(solid);
    anew = NULL;
    solid = NULL;
    OK(leafless_solid_from_tridexel(model, true, NULL, &solid));
    OK(leafless_octree_build(solid, &other, LEAFLESS_RULE_CERTIFIED, NULL, &anew));
    OK(leafless_octree_describe(anew, &info));
    CHECK(info.proof.full && info.proof.empty);
    OK(leafless_solid_measure(solid, &other, 1e-2, 0, NULL, &measures));
    CHECK(measures.volume_model.lower < measures.volume_model.upper && measures.volume_model.lower > 1.6);
    CHECK(measures.volume_model.upper < 1.85);
    leafless_solid_free(solid);
    solid = NULL;
    OK(leafless_tridexel_build(source, &frame, LEAFLESS_RULE_INNER, NULL, NULL, &empty));
    leafless_tridexel_free(empty);
    empty = NULL;
    {
        leafless_solid *small = check_ball_solid();
        OK(leafless_tridexel_build(small, &nowhere, LEAFLESS_RULE_SAMPLED, NULL, NULL, &empty));
        FAILS(LEAFLESS_E_MESH, leafless_solid_from_tridexel(empty, true, NULL, &solid));
        CHECK(solid == NULL);
        leafless_solid_free(small);
        leafless_tridexel_free(empty);
    }
    leafless_octree_free(anew);
    leafless_octree_free(tree);
    leafless_octree_free(expected);
    leafless_solid_free(source);
    leafless_tridexel_free(again);
    leafless_tridexel_free(named);
    leafless_tridexel_free(model);
}

static void voxels(void) {
    leafless_tridexel *plain = ball(0), *model = NULL;
    uint64_t count = 0, again = 0, i, inside = 0, boundary = 0, expected_inside = 0, expected_boundary = 0;
    leafless_long_voxel *list;
    uint32_t x, y, z;
    uint8_t colours[8 * 4] = {0};
    colours[7 * 4] = 200;
    colours[7 * 4 + 3] = 255;
    OK(leafless_tridexel_with_material(plain, 7, NULL, &model));
    OK(leafless_tridexel_voxels(model, NULL, NULL, 0, NULL, 0, &count));
    list = (leafless_long_voxel *)malloc((size_t)count * sizeof *list);
    CHECK(list != NULL && count > 100);
    FAILS(LEAFLESS_E_BUFFER, leafless_tridexel_voxels(model, NULL, colours, 8, list, count - 1, &again));
    OK(leafless_tridexel_voxels(model, NULL, colours, 8, list, count, &again));
    CHECK(again == count);
    for (i = 0; i < count; i++) {
        CHECK(list[i].material == 7 && list[i].length > 0 && list[i].first[1] + list[i].length <= SIDE + 1);
        CHECK(memcmp(list[i].colour, colours + 7 * 4, 4) == 0);
        CHECK(list[i].kind == LEAFLESS_VOXEL_KIND_INSIDE || list[i].kind == LEAFLESS_VOXEL_KIND_BOUNDARY);
        *(list[i].kind == LEAFLESS_VOXEL_KIND_INSIDE ? &inside : &boundary) += list[i].length;
    }
    for (z = 0; z <= SIDE; z++) {
        for (y = 0; y <= SIDE; y++) {
            for (x = 0; x <= SIDE; x++) {
                int corners = 0, k;
                for (k = 0; k < 8; k++) {
                    /* The lower corner of voxel 0 lies outside of the universe. */
                    const uint32_t cell[3] = {x - 1 + (k & 1), y - 1 + (k >> 1 & 1), z - 1 + (k >> 2)};
                    bool is_inside;
                    OK(leafless_tridexel_contains_cell(model, cell, &is_inside));
                    corners += is_inside;
                }
                expected_inside += corners == 8;
                expected_boundary += corners > 0 && corners < 8;
            }
        }
    }
    CHECK(inside == expected_inside && boundary == expected_boundary);
    /* A material without a colour is grey. */
    OK(leafless_tridexel_voxels(model, NULL, colours, 7, list, count, &again));
    CHECK(list[0].colour[0] == 128 && list[0].colour[3] == 255);
    free(list);
    leafless_tridexel_free(model);
    leafless_tridexel_free(plain);
}

/* Everything of a model into arrays, and from there into another model. */
static void arrays(void) {
    const leafless_frame frame = check_frame(DEPTH);
    leafless_tridexel *plain = ball(LEAFLESS_DEXEL_NORMALS_32), *model = NULL, *back = NULL;
    leafless_tridexel_format format;
    leafless_tridexel_arrays rays[3];
    static uint64_t offsets[3][SIDE * SIDE + 1];
    static double ends[3][SIDE * SIDE][2], normals[3][SIDE * SIDE][6];
    static uint32_t surfaces_of[3][SIDE * SIDE][2], materials[3][SIDE * SIDE];
    uint32_t axis;
    OK(leafless_init(&format, sizeof format));
    OK(leafless_tridexel_with_material(plain, 3, NULL, &model));
    format.normals = LEAFLESS_DEXEL_NORMALS_32;
    format.has_surfaces = format.has_materials = 1;
    for (axis = 0; axis < 3; axis++) {
        leafless_tridexel_arrays *const to = &rays[axis];
        uint64_t offset_count;
        memset(to, 0, sizeof *to);
        to->axis = axis;
        to->offsets = offsets[axis];
        to->ends_model = &ends[axis][0][0];
        to->normals = &normals[axis][0][0];
        to->surfaces = &surfaces_of[axis][0][0];
        to->materials = materials[axis];
        OK(leafless_tridexel_window(model, axis, to->first, to->end));
        OK(leafless_tridexel_copy(model, axis, NULL, NULL, offsets[axis], SIDE * SIDE + 1, &offset_count,
                                  &ends[axis][0][0], &normals[axis][0][0], &surfaces_of[axis][0][0], materials[axis],
                                  SIDE * SIDE, &to->interval_count));
    }
    OK(leafless_tridexel_new(&frame, &format, rays, 3, NULL, &back));
    OK(leafless_tridexel_check(back));
    CHECK(same(model, back));
    leafless_tridexel_free(back);
    back = NULL;
    {
        /* One axis, ends alone. */
        leafless_tridexel_arrays one = rays[1];
        leafless_dexel_statistics a = LEAFLESS_INIT(leafless_dexel_statistics);
        leafless_dexel_statistics b = LEAFLESS_INIT(leafless_dexel_statistics);
        leafless_tridexel_info info = LEAFLESS_INIT(leafless_tridexel_info);
        one.normals = NULL;
        one.surfaces = one.materials = NULL;
        OK(leafless_tridexel_new(&frame, NULL, &one, 1, NULL, &back));
        OK(leafless_tridexel_describe(back, &info));
        CHECK(info.directions == LEAFLESS_AXES_Y && info.bytes_per_interval == 8);
        OK(leafless_tridexel_statistics(back, 1, &a));
        OK(leafless_tridexel_statistics(model, 1, &b));
        CHECK(a.volume_model == b.volume_model && a.rays == b.rays && a.min_model[2] == b.min_model[2]);
        leafless_tridexel_free(back);
        back = NULL;
        /* What is wrong with arrays. */
        FAILS(LEAFLESS_E_ARGUMENT, leafless_tridexel_new(&frame, NULL, rays, 0, NULL, &back));
        FAILS(LEAFLESS_E_ARGUMENT, leafless_tridexel_new(&frame, NULL, rays, 4, NULL, &back));
        one = rays[0];
        rays[0] = rays[2];
        FAILS(LEAFLESS_E_ARGUMENT, leafless_tridexel_new(&frame, NULL, rays, 3, NULL, &back));
        rays[0] = one;
        format.directions = LEAFLESS_AXES_X;
        FAILS(LEAFLESS_E_ARGUMENT, leafless_tridexel_new(&frame, &format, rays, 3, NULL, &back));
#define WRONG(change)                                                                      \
    one = rays[0];                                                                         \
    change;                                                                                \
    FAILS(LEAFLESS_E_ARGUMENT, leafless_tridexel_new(&frame, NULL, &one, 1, NULL, &back))
        WRONG(one.axis = 3);
        WRONG(one.reserved = 1);
        WRONG(one.first[0] = one.end[0] + 1);
        WRONG(one.end[1] = SIDE + 1);
        WRONG(one.interval_count--);
        WRONG(one.offsets++);
        offsets[0][1] = UINT64_MAX;
        WRONG((void)0);
        offsets[0][1] = 0;
        ends[0][20][1] = ends[0][20][0];
        WRONG((void)0);
        ends[0][20][1] = NAN;
        WRONG((void)0);
#undef WRONG
        CHECK(back == NULL);
    }
    leafless_tridexel_free(model);
    leafless_tridexel_free(plain);
}

/* The context of a file's writer. */
typedef struct {
    uint8_t *to;
    uint64_t length;
    int fails;
} sink;

static int32_t take(void *ctx, const uint8_t *bytes, uint64_t count) {
    sink *const own = (sink *)ctx;
    if (own->fails) {
        return -4714;
    }
    memcpy(own->to + own->length, bytes, (size_t)count);
    own->length += count;
    return 0;
}

static void files(void) {
    leafless_tridexel *plain = ball(LEAFLESS_DEXEL_NORMALS_16), *model = NULL, *back = NULL;
    leafless_octree *octree = check_ball(DEPTH, LEAFLESS_RULE_CERTIFIED), *none = NULL;
    uint64_t length = 0, again = 0, k;
    uint8_t *bytes, *copy;
    sink to = {NULL, 0, 0};
    leafless_file_info probe = LEAFLESS_INIT(leafless_file_info);
    leafless_file_section sections[64];
    int way;
    const char *value;
    size_t value_length;
    OK(leafless_tridexel_with_metadata(plain, "name", 4, "round", 5, &model));
    OK(tridexel_to_bytes(model, NULL, 0, &length));
    bytes = (uint8_t *)malloc((size_t)length);
    copy = (uint8_t *)malloc((size_t)length);
    CHECK(bytes != NULL && copy != NULL);
    FAILS(LEAFLESS_E_BUFFER, tridexel_to_bytes(model, bytes, length - 1, &again));
    OK(tridexel_to_bytes(model, bytes, length, &again));
    CHECK(again == length);
    to.to = copy;
    OK(tridexel_write_to(model, take, &to));
    CHECK(to.length == length && memcmp(bytes, copy, (size_t)length) == 0);
    to.fails = 1;
    FAILS(LEAFLESS_E_CALLBACK, tridexel_write_to(model, take, &to));
    OK(tridexel_save(model, "ball.lfl", 8));
    OK(verify_bytes(bytes, length));
    OK(probe_bytes(bytes, length, &probe, sections, COUNT(sections)));
    CHECK(probe.frame.depth == DEPTH && probe.file_length == length && probe.elements == 0);
    CHECK(probe.tridexel.directions == LEAFLESS_AXES_ALL && probe.tridexel.normals == LEAFLESS_DEXEL_NORMALS_16);
    CHECK(probe.tridexel.ends == LEAFLESS_DEXEL_ENDS_FIXED && probe.tridexel.has_materials == 1);
    for (way = 0; way < 5; way++) {
        leafless_dexel_statistics statistics = LEAFLESS_INIT(leafless_dexel_statistics);
        switch (way) {
        case 0:
            OK(tridexel_open("ball.lfl", 8, &back));
            break;
        case 1:
            OK(tridexel_map("ball.lfl", 8, &back));
            break;
        case 2:
            OK(tridexel_map_verified("ball.lfl", 8, &back));
            break;
        case 3:
            OK(tridexel_from_bytes(bytes, length, &back));
            break;
        default:
            OK(tridexel_view_bytes(bytes, length, &back));
        }
        OK(leafless_tridexel_check(back));
        CHECK(same(back, model));
        OK(leafless_tridexel_peek_metadata(back, "name", 4, &value, &value_length));
        CHECK(value_length == 5 && memcmp(value, "round", 5) == 0);
        for (k = 0; k < 3; k++) {
            OK(leafless_tridexel_statistics(back, (uint32_t)k, &statistics));
            CHECK(statistics.intervals == probe.tridexel.intervals[k] && statistics.rays <= probe.tridexel.rays[k]);
        }
        leafless_tridexel_free(back);
        back = NULL;
    }
    /* The file of one kind is none of the other. */
    FAILS(LEAFLESS_E_ARGUMENT, octree_open("ball.lfl", 8, &none));
    OK(octree_save(octree, "tree.lfl", 8));
    FAILS(LEAFLESS_E_ARGUMENT, tridexel_open("tree.lfl", 8, &back));
    FAILS(LEAFLESS_E_ARGUMENT, tridexel_map("tree.lfl", 8, &back));
    OK(probe_path("tree.lfl", 8, &probe, NULL, 0));
    CHECK(probe.tridexel.directions == 0 && probe.elements > 0);
    FAILS(LEAFLESS_E_IO, tridexel_open("no/such/file", 12, &back));
    /* Cut off anywhere, and with any byte changed, it is no file. */
    for (k = 0; k < length; k += 97) {
        FAILS(LEAFLESS_E_FORMAT, tridexel_from_bytes(bytes, k, &back));
    }
    for (k = 0; k < length; k += 89) {
        leafless_status status;
        bytes[k] ^= 1;
        status = tridexel_from_bytes(bytes, length, &back);
        CHECK(status == LEAFLESS_E_FORMAT || status == LEAFLESS_E_VERSION || status == LEAFLESS_E_DAMAGED);
        bytes[k] ^= 1;
    }
    CHECK(back == NULL && none == NULL);
    free(copy);
    free(bytes);
    leafless_octree_free(octree);
    leafless_tridexel_free(model);
    leafless_tridexel_free(plain);
}

int main(void) {
    surfaces();
    octrees_and_solids();
    voxels();
    arrays();
    files();
    return 0;
}
