/* Shared parts of the programs here: checks that report failures and their places, and a few octrees. C99 and C++11. */
#ifndef CHECK_H
#define CHECK_H

#include <leafless.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "files.h"

#ifdef LEAFLESS_TEST
/* What the library exports for tests alone. */
#ifdef __cplusplus
extern "C" {
#endif
leafless_status leafless_test_panic(void);
size_t leafless_test_layout(char *text, size_t capacity);
#ifdef __cplusplus
}
#endif
#endif

#define CHECK(condition) ((condition) ? (void)0 : check_failed(__FILE__, __LINE__, #condition))
#define OK(call) check_status(__FILE__, __LINE__, #call, (call), LEAFLESS_OK)
#define FAILS(status, call) check_status(__FILE__, __LINE__, #call, (call), (status))
#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static inline void check_failed(const char *file, int line, const char *what) {
    fprintf(stderr, "%s:%d: %s\n", file, line, what);
    exit(1);
}

static inline void check_status(const char *file, int line, const char *call, int32_t found, int32_t expected) {
    char message[512] = "";
    if (found == expected) {
        return;
    }
    (void)leafless_last_error(message, sizeof message);
    fprintf(stderr, "%s:%d: %s\n  is %s, should be %s; last error: %s\n", file, line, call,
            leafless_status_name(found), leafless_status_name(expected), message);
    exit(1);
}

static inline leafless_frame check_frame(uint32_t depth) {
    leafless_frame frame = {{-1.0, -1.0, -1.0}, 2.0, 0};
    frame.depth = depth;
    return frame;
}

/* The ball of radius 0.75 around the origin. */
static inline leafless_solid *check_ball_solid(void) {
    const double centre[3] = {0.0, 0.0, 0.0};
    leafless_solid *solid = NULL;
    OK(leafless_solid_new_ball(centre, 0.75, &solid));
    return solid;
}

static inline leafless_octree *check_ball(uint32_t depth, leafless_rule rule) {
    const leafless_frame frame = check_frame(depth);
    leafless_solid *solid = check_ball_solid();
    leafless_octree *octree = NULL;
    OK(leafless_octree_build(solid, &frame, rule, NULL, &octree));
    leafless_solid_free(solid);
    return octree;
}

static inline leafless_octree *check_box(uint32_t depth, double low, double high) {
    const leafless_frame frame = check_frame(depth);
    const double min[3] = {low, low, low}, max[3] = {high, high, high};
    leafless_solid *solid = NULL;
    leafless_octree *octree = NULL;
    OK(leafless_solid_new_box(min, max, &solid));
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &octree));
    leafless_solid_free(solid);
    return octree;
}

static inline bool check_same(const leafless_octree *a, const leafless_octree *b) {
    bool equal = false;
    OK(leafless_octree_equal(a, b, &equal));
    return equal;
}

/* What a set operation makes of two operands. */
static inline leafless_status check_octrees(leafless_operation operation, const leafless_octree *a, const leafless_octree *b,
                                            const leafless_options *options, leafless_octree **result) {
    const leafless_octree *const both[2] = {a, b};
    return leafless_octree_combine(operation, both, 2, options, result);
}

static inline leafless_status check_tridexels(leafless_operation operation, const leafless_tridexel *a, const leafless_tridexel *b,
                                              const leafless_options *options, leafless_tridexel **result) {
    const leafless_tridexel *const both[2] = {a, b};
    return leafless_tridexel_combine(operation, both, 2, options, result);
}

static inline leafless_status check_solids(leafless_operation operation, const leafless_solid *a, const leafless_solid *b,
                                           leafless_solid **result) {
    const leafless_solid *const both[2] = {a, b};
    return leafless_solid_combine(operation, both, 2, result);
}

/* The cube [0, 1]³: corners in octant order, two triangles a face, seen from outside counter-clockwise. */
static const double CHECK_CUBE[8][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                        {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
static const uint32_t CHECK_CUBE_TRIANGLES[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                                     {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                                     {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};

/* Vertices of double and indices of uint32_t, without gaps. */
static inline leafless_mesh_arrays check_arrays(const void *vertices, uint64_t vertex_count, const void *indices,
                                                uint64_t triangle_count) {
    leafless_mesh_arrays arrays;
    OK(leafless_init(&arrays, sizeof arrays));
    arrays.vertices = vertices;
    arrays.vertex_count = vertex_count;
    arrays.indices = indices;
    arrays.triangle_count = triangle_count;
    return arrays;
}

/* How many vertices and triangles a mesh has. */
static inline leafless_status check_counts(const leafless_mesh *mesh, uint64_t *vertices, uint64_t *triangles) {
    leafless_mesh_info info = LEAFLESS_INIT(leafless_mesh_info);
    const leafless_status status = leafless_mesh_describe(mesh, &info);
    *vertices = info.vertices;
    *triangles = info.triangles;
    return status;
}

/* A mesh of the cube's first triangles. */
static inline leafless_mesh *check_some_of_cube(uint64_t triangle_count) {
    const leafless_mesh_arrays arrays = check_arrays(CHECK_CUBE, 8, CHECK_CUBE_TRIANGLES, triangle_count);
    leafless_mesh *mesh = NULL;
    OK(leafless_mesh_new(&arrays, &mesh));
    return mesh;
}

static inline leafless_mesh *check_cube(void) {
    return check_some_of_cube(12);
}

/* A whole file in memory, on an address that is good for anything. */
static inline uint8_t *check_bytes(const leafless_octree *octree, uint64_t *length) {
    uint8_t *bytes;
    OK(octree_to_bytes(octree, NULL, 0, length));
    bytes = (uint8_t *)malloc((size_t)*length);
    CHECK(bytes != NULL);
    OK(octree_to_bytes(octree, bytes, *length, length));
    return bytes;
}

static inline void check_write(const char *path, const void *bytes, size_t length) {
    FILE *file = fopen(path, "wb");
    CHECK(file != NULL);
    CHECK(fwrite(bytes, 1, length, file) == length);
    CHECK(fclose(file) == 0);
}

static inline uint8_t *check_read(const char *path, size_t *length) {
    FILE *file = fopen(path, "rb");
    uint8_t *bytes;
    long end;
    CHECK(file != NULL);
    CHECK(fseek(file, 0, SEEK_END) == 0);
    end = ftell(file);
    CHECK(end >= 0 && fseek(file, 0, SEEK_SET) == 0);
    *length = (size_t)end;
    bytes = (uint8_t *)malloc(*length + 1);
    CHECK(bytes != NULL && fread(bytes, 1, *length, file) == *length);
    CHECK(fclose(file) == 0);
    return bytes;
}

/* The zone of a point, of a box, and of a ray. */
static inline leafless_zone check_zone_point(const double *point) {
    leafless_zone zone = LEAFLESS_INIT(leafless_zone);
    zone.kind = LEAFLESS_ZONE_KIND_POINT;
    memcpy(zone.point_model, point, sizeof zone.point_model);
    return zone;
}

static inline leafless_zone check_zone_box(const double *min, const double *max) {
    leafless_zone zone = LEAFLESS_INIT(leafless_zone);
    zone.kind = LEAFLESS_ZONE_KIND_BOX;
    memcpy(zone.min_model, min, sizeof zone.min_model);
    memcpy(zone.max_model, max, sizeof zone.max_model);
    return zone;
}

static inline leafless_zone check_zone_ray(const double *origin, const double *direction, double from, double to) {
    leafless_zone zone = check_zone_point(origin);
    zone.kind = LEAFLESS_ZONE_KIND_RAY;
    memcpy(zone.direction_model, direction, sizeof zone.direction_model);
    zone.from = from;
    zone.to = to;
    return zone;
}

static inline leafless_status check_refine(leafless_lazy *lazy, leafless_zone zone, uint32_t level, bool *done) {
    return leafless_lazy_refine(lazy, &zone, level, NULL, done);
}

static inline uint64_t check_channels(const leafless_octree *octree) {
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
    OK(leafless_octree_describe(octree, &info));
    return info.channels;
}

#endif
