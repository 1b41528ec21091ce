/* Meshes from arrays as host programs have them: every type of vertices and indices at every stride, on any address,
   and all that can be wrong with them. */
#include "check.h"

/* Equal to the cube, down to the order of vertices and triangles. */
static void is_cube(const leafless_mesh_arrays *arrays) {
    leafless_mesh *mesh = NULL;
    double vertices[8][3];
    uint32_t triangles[12][3];
    uint64_t vertex_count, triangle_count;
    OK(leafless_mesh_new(arrays, &mesh));
    OK(check_counts(mesh, &vertex_count, &triangle_count));
    CHECK(vertex_count == 8 && triangle_count == 12);
    OK(leafless_mesh_copy(mesh, &vertices[0][0], 8, &triangles[0][0], 12));
    CHECK(memcmp(vertices, CHECK_CUBE, sizeof vertices) == 0);
    CHECK(memcmp(triangles, CHECK_CUBE_TRIANGLES, sizeof triangles) == 0);
    leafless_mesh_free(mesh);
}

static void refused(leafless_status status, const leafless_mesh_arrays *arrays, const char *part) {
    leafless_mesh *const untouched = (leafless_mesh *)(uintptr_t)0x5a5a5a58;
    leafless_mesh *mesh = untouched;
    char message[512];
    FAILS(status, leafless_mesh_new(arrays, &mesh));
    CHECK(mesh == untouched);
    (void)leafless_last_error(message, sizeof message);
    if (strstr(message, part) == NULL) {
        fprintf(stderr, "\"%s\" does not say \"%s\"\n", message, part);
        exit(1);
    }
}

static size_t vertex_size(uint32_t type) {
    return 3 * (type == LEAFLESS_VERTEX_TYPE_F32 ? sizeof(float) : sizeof(double));
}

static size_t triangle_size(uint32_t type) {
    return 3 * (type == LEAFLESS_INDEX_TYPE_U16   ? sizeof(uint16_t)
                : type == LEAFLESS_INDEX_TYPE_U64 ? sizeof(uint64_t)
                                             : sizeof(uint32_t));
}

static void put_coordinate(unsigned char *to, uint32_t type, int k, double x) {
    const float single = (float)x;
    if (type == LEAFLESS_VERTEX_TYPE_F32) {
        memcpy(to + (size_t)k * sizeof single, &single, sizeof single);
    } else {
        memcpy(to + (size_t)k * sizeof x, &x, sizeof x);
    }
}

static void put_index(unsigned char *to, uint32_t type, int k, uint64_t index) {
    const uint32_t half = (uint32_t)index;
    const uint16_t quarter = (uint16_t)index;
    if (type == LEAFLESS_INDEX_TYPE_U16) {
        memcpy(to + (size_t)k * sizeof quarter, &quarter, sizeof quarter);
    } else if (type == LEAFLESS_INDEX_TYPE_U64) {
        memcpy(to + (size_t)k * sizeof index, &index, sizeof index);
    } else {
        memcpy(to + (size_t)k * sizeof half, &half, sizeof half);
    }
}

/* `count` elements in memory that ends with the last of them, so that memory checkers see what is read beyond, and
   that begins `offset` bytes beside an aligned address. What lies between is all ones: no number, no index. */
static unsigned char *elements(size_t count, size_t size, size_t stride, size_t offset) {
    const size_t bytes = offset + (count - 1) * stride + size;
    unsigned char *memory = (unsigned char *)malloc(bytes);
    CHECK(memory != NULL);
    memset(memory, 0xff, bytes);
    return memory;
}

static void all_types_and_strides(void) {
    static const size_t GAPS[] = {0, 1, 3, 4, 8, 12, 20, 1000};
    uint32_t vertex_type, index_type;
    size_t i, j, offset;
    int t, k;
    for (vertex_type = 0; vertex_type < 2; vertex_type++) {
        for (index_type = 0; index_type < 3; index_type++) {
            for (i = 0; i < COUNT(GAPS); i++) {
                for (j = 0; j < COUNT(GAPS); j++) {
                    for (offset = 0; offset < 9; offset += 1 + 2 * (i + j > 2)) {
                        const size_t vertex_stride = vertex_size(vertex_type) + GAPS[i];
                        const size_t triangle_stride = triangle_size(index_type) + GAPS[j];
                        unsigned char *vertices = elements(8, vertex_size(vertex_type), vertex_stride, offset);
                        unsigned char *indices = elements(12, triangle_size(index_type), triangle_stride, 8 - offset);
                        leafless_mesh_arrays arrays = check_arrays(vertices + offset, 8, indices + 8 - offset, 12);
                        arrays.vertex_type = vertex_type;
                        arrays.index_type = index_type;
                        for (t = 0; t < 8; t++) {
                            for (k = 0; k < 3; k++) {
                                put_coordinate(vertices + offset + (size_t)t * vertex_stride, vertex_type, k,
                                               CHECK_CUBE[t][k]);
                            }
                        }
                        for (t = 0; t < 12; t++) {
                            for (k = 0; k < 3; k++) {
                                put_index(indices + 8 - offset + (size_t)t * triangle_stride, index_type, k,
                                          CHECK_CUBE_TRIANGLES[t][k]);
                            }
                        }
                        if (GAPS[i] == 0 && GAPS[j] == 0) {
                            is_cube(&arrays);
                        }
                        arrays.vertex_stride = vertex_stride;
                        arrays.triangle_stride = triangle_stride;
                        is_cube(&arrays);
                        free(vertices);
                        free(indices);
                    }
                }
            }
        }
    }
}

/* The formats that renderers know: position, normal and texture coordinates in one record; triangles with a colour. */
static void interleaved(void) {
    struct {
        float position[3], normal[3], texture[2];
    } vertices[8];
    struct {
        uint64_t corners[3];
        uint32_t colour;
    } triangles[12];
    leafless_mesh_arrays arrays;
    int i, k;
    memset(vertices, 0xff, sizeof vertices);
    memset(triangles, 0xff, sizeof triangles);
    for (k = 0; k < 3; k++) {
        for (i = 0; i < 8; i++) {
            vertices[i].position[k] = (float)CHECK_CUBE[i][k];
        }
        for (i = 0; i < 12; i++) {
            triangles[i].corners[k] = CHECK_CUBE_TRIANGLES[i][k];
        }
    }
    arrays = check_arrays(&vertices[0].position, 8, &triangles[0].corners, 12);
    arrays.vertex_type = LEAFLESS_VERTEX_TYPE_F32;
    arrays.vertex_stride = sizeof vertices[0];
    arrays.index_type = LEAFLESS_INDEX_TYPE_U64;
    arrays.triangle_stride = sizeof triangles[0];
    is_cube(&arrays);
}

/* A float is the double that it is, also where it is none that a decimal fraction names. */
static void floats_are_not_changed(void) {
    const float values[3][3] = {{0.1f, 1e-30f, -3.4e38f}, {1.0f / 3.0f, -0.0f, 16777217.0f}, {1e-40f, 5.0f, 6.0f}};
    const uint32_t triangle[3] = {0, 1, 2};
    leafless_mesh_arrays arrays = check_arrays(values, 3, triangle, 1);
    leafless_mesh *mesh = NULL;
    double vertices[3][3];
    int i, k;
    arrays.vertex_type = LEAFLESS_VERTEX_TYPE_F32;
    OK(leafless_mesh_new(&arrays, &mesh));
    OK(leafless_mesh_copy(mesh, &vertices[0][0], 3, NULL, 0));
    for (i = 0; i < 3; i++) {
        for (k = 0; k < 3; k++) {
            CHECK(vertices[i][k] == (double)values[i][k]);
        }
    }
    leafless_mesh_free(mesh);
}

static void no_indices(void) {
    double corners[12][3][3];
    float single[12][3][3];
    leafless_mesh_arrays arrays;
    leafless_mesh *mesh = NULL;
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    double volume;
    int t, corner, k;
    for (t = 0; t < 12; t++) {
        for (corner = 0; corner < 3; corner++) {
            for (k = 0; k < 3; k++) {
                corners[t][corner][k] = CHECK_CUBE[CHECK_CUBE_TRIANGLES[t][corner]][k];
                single[t][corner][k] = (float)corners[t][corner][k];
            }
        }
    }
    arrays = check_arrays(corners, 36, NULL, 12);
    OK(leafless_mesh_new(&arrays, &mesh));
    OK(leafless_mesh_check_closed(mesh, LEAFLESS_FILL_NON_ZERO));
    OK(leafless_mesh_volume(mesh, &volume));
    OK(leafless_mesh_inspect(mesh, &report));
    CHECK(volume == 1.0 && report.triangles == 12 && report.vertices == 8 && report.welded == 28);
    leafless_mesh_free(mesh);

    arrays.vertices = single;
    arrays.vertex_type = LEAFLESS_VERTEX_TYPE_F32;
    arrays.vertex_stride = sizeof single[0][0];
    OK(leafless_mesh_new(&arrays, &mesh));
    OK(leafless_mesh_volume(mesh, &volume));
    CHECK(volume == 1.0);
    leafless_mesh_free(mesh);

    /* Three vertices for each triangle, no more and no less, unless there is no triangle. */
    arrays.vertex_count = 35;
    refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.indices");
    arrays.vertex_count = 37;
    refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.indices");
    arrays.vertex_count = 36;
    arrays.triangle_count = UINT64_MAX / 3 + 13;
    refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.indices");
    arrays.triangle_count = 0;
    OK(leafless_mesh_new(&arrays, &mesh));
    OK(leafless_mesh_inspect(mesh, &report));
    CHECK(report.triangles == 0 && report.vertices == 8);
    leafless_mesh_free(mesh);

    /* The vertex that is wrong is named as it stands in the array. */
    arrays.triangle_count = 12;
    single[11][1][2] = NAN;
    refused(LEAFLESS_E_MESH, &arrays, "vertex 34 ");
}

static void scales(void) {
    static const double GOOD[] = {1.0, 25.4, 0.001, 0x1p-256, 0x1p256};
    static const double BAD[] = {-1.0, NAN, INFINITY, -INFINITY, -0x1p-1000, 0x1p-257, 0x1.8p256};
    static const double LONG[2][3] = {{0, 0, 0}, {0x1p200, 0, 0}};
    leafless_mesh_arrays arrays = check_arrays(CHECK_CUBE, 8, CHECK_CUBE_TRIANGLES, 12);
    size_t i;
    is_cube(&arrays);
    for (i = 0; i < COUNT(GOOD); i++) {
        leafless_mesh *mesh = NULL;
        double min[3], max[3];
        arrays.scale = GOOD[i];
        OK(leafless_mesh_new(&arrays, &mesh));
        OK(leafless_mesh_bounds(mesh, min, max));
        CHECK(min[0] == 0.0 && max[0] == GOOD[i] && max[1] == GOOD[i] && max[2] == GOOD[i]);
        leafless_mesh_free(mesh);
    }
    for (i = 0; i < COUNT(BAD); i++) {
        arrays.scale = BAD[i];
        refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.scale");
    }
    arrays = check_arrays(LONG, 2, NULL, 0);
    arrays.scale = 0x1p57;
    refused(LEAFLESS_E_MESH, &arrays, "vertex 1 ");
}

static void bad_values(void) {
    static const double NUMBERS[] = {NAN, INFINITY, -INFINITY, 0x1.8p256};
    double vertices[8][3];
    float single[8][3];
    uint16_t u16[12][3];
    uint32_t u32[12][3];
    uint64_t u64[12][3];
    leafless_mesh_arrays arrays;
    size_t i;
    int t, k;
    for (i = 0; i < COUNT(NUMBERS); i++) {
        for (k = 0; k < 3; k++) {
            memcpy(vertices, CHECK_CUBE, sizeof vertices);
            vertices[5][k] = NUMBERS[i];
            arrays = check_arrays(vertices, 8, CHECK_CUBE_TRIANGLES, 12);
            refused(LEAFLESS_E_MESH, &arrays, "vertex 5 ");
            memset(single, 0, sizeof single);
            single[7][k] = (float)NUMBERS[i];
            arrays = check_arrays(single, 8, CHECK_CUBE_TRIANGLES, 12);
            arrays.vertex_type = LEAFLESS_VERTEX_TYPE_F32;
            refused(LEAFLESS_E_MESH, &arrays, "vertex 7 ");
        }
    }
    for (k = 0; k < 3; k++) {
        for (t = 0; t < 36; t++) {
            u16[t / 3][t % 3] = (uint16_t)CHECK_CUBE_TRIANGLES[t / 3][t % 3];
            u32[t / 3][t % 3] = CHECK_CUBE_TRIANGLES[t / 3][t % 3];
            u64[t / 3][t % 3] = CHECK_CUBE_TRIANGLES[t / 3][t % 3];
        }
        u16[7][k] = 8;
        arrays = check_arrays(CHECK_CUBE, 8, u16, 12);
        arrays.index_type = LEAFLESS_INDEX_TYPE_U16;
        refused(LEAFLESS_E_MESH, &arrays, "triangle 7 refers to vertex 8,");
        u16[7][k] = 0xffff;
        refused(LEAFLESS_E_MESH, &arrays, "triangle 7 refers to vertex 65535,");
        u32[11][k] = 8;
        arrays = check_arrays(CHECK_CUBE, 8, u32, 12);
        refused(LEAFLESS_E_MESH, &arrays, "triangle 11 refers to vertex 8,");
        u32[11][k] = UINT32_MAX;
        refused(LEAFLESS_E_MESH, &arrays, "triangle 11 refers to vertex 4294967295,");
        arrays = check_arrays(CHECK_CUBE, 8, u64, 12);
        arrays.index_type = LEAFLESS_INDEX_TYPE_U64;
        u64[2][k] = 8;
        refused(LEAFLESS_E_MESH, &arrays, "triangle 2 refers to vertex 8,");
        /* Not cut to 32 bits, where it would be vertex 1. */
        u64[2][k] = ((uint64_t)1 << 32) + 1;
        refused(LEAFLESS_E_MESH, &arrays, "triangle 2 refers to vertex 4294967297,");
        u64[2][k] = UINT64_MAX;
        refused(LEAFLESS_E_MESH, &arrays, "triangle 2 refers to vertex 18446744073709551615,");
    }
    /* Indices, but no vertex. */
    arrays = check_arrays(NULL, 0, CHECK_CUBE_TRIANGLES, 12);
    refused(LEAFLESS_E_MESH, &arrays, "triangle 0 refers to vertex");
}

static void bad_fields(void) {
    const uint32_t not_a_type[] = {3, 4, 255, UINT32_MAX};
    const leafless_mesh_arrays good = check_arrays(CHECK_CUBE, 8, CHECK_CUBE_TRIANGLES, 12);
    leafless_mesh_arrays arrays;
    uint64_t stride;
    size_t i;
    is_cube(&good);
    for (i = 0; i < COUNT(not_a_type); i++) {
        arrays = good;
        arrays.vertex_type = not_a_type[i];
        refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.vertex_type");
        arrays = good;
        arrays.index_type = not_a_type[i];
        refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.index_type");
    }
    arrays = good;
    arrays.vertex_type = 2;
    refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.vertex_type");

    /* Strides: shorter than an element, or so long that the array would be longer than memory. */
    for (stride = 1; stride < 24; stride++) {
        arrays = good;
        arrays.vertex_stride = stride;
        refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.vertex_stride");
        if (stride < 12) {
            arrays = good;
            arrays.triangle_stride = stride;
            refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.triangle_stride");
            arrays.triangle_stride = 0;
            arrays.vertex_type = LEAFLESS_VERTEX_TYPE_F32;
            arrays.vertex_stride = stride;
            refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.vertex_stride");
        }
        arrays = good;
        arrays.index_type = LEAFLESS_INDEX_TYPE_U64;
        arrays.triangle_stride = stride;
        refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.triangle_stride");
    }
    arrays = good;
    arrays.vertex_stride = UINT64_MAX;
    refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.vertices");
    arrays.vertex_stride = ((uint64_t)1 << 63) / 7;
    refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.vertices");
    /* 2^64 / 8: a product that wraps around is the right one. */
    arrays.vertex_stride = ((uint64_t)1 << 61) + 24;
    refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.vertices");
    arrays = good;
    arrays.triangle_stride = UINT64_MAX;
    refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.indices");
    arrays.triangle_stride = ((uint64_t)1 << 62) + 12;
    refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.indices");
    /* For one element the stride does not matter. */
    {
        const double point[3] = {1, 2, 3};
        leafless_mesh *mesh = NULL;
        arrays = check_arrays(point, 1, CHECK_CUBE_TRIANGLES, 0);
        arrays.vertex_stride = UINT64_MAX;
        OK(leafless_mesh_new(&arrays, &mesh));
        leafless_mesh_free(mesh);
        arrays = check_arrays(CHECK_CUBE, 8, CHECK_CUBE_TRIANGLES, 1);
        arrays.triangle_stride = UINT64_MAX;
        OK(leafless_mesh_new(&arrays, &mesh));
        leafless_mesh_free(mesh);
    }

    /* Counts beyond memory, and beyond 32 bits: nothing is read. */
    arrays = good;
    arrays.vertex_count = UINT64_MAX;
    refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.vertices");
    arrays.vertex_count = UINT64_MAX / 24 + 2;
    refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.vertices");
    arrays.vertex_count = (uint64_t)1 << 32;
    refused(LEAFLESS_E_MESH, &arrays, "more than 2^32 - 1");
    arrays = good;
    arrays.triangle_count = UINT64_MAX;
    refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.indices");
    arrays.triangle_count = UINT64_MAX / 12 + 2;
    refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.indices");
    arrays.triangle_count = (uint64_t)1 << 32;
    refused(LEAFLESS_E_MESH, &arrays, "more than 2^32 - 1");

    /* Pointers. */
    arrays = good;
    arrays.vertices = NULL;
    refused(LEAFLESS_E_NULL, &arrays, "arrays.vertices");
    arrays = good;
    arrays.indices = NULL;
    refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.indices");
    arrays = check_arrays(NULL, 36, NULL, 12);
    refused(LEAFLESS_E_NULL, &arrays, "arrays.vertices");
    arrays = check_arrays(NULL, 0, NULL, 0);
    {
        leafless_mesh *mesh = NULL;
        OK(leafless_mesh_new(&arrays, &mesh));
        leafless_mesh_free(mesh);
        arrays = check_arrays(CHECK_CUBE, 0, CHECK_CUBE_TRIANGLES, 0);
        OK(leafless_mesh_new(&arrays, &mesh));
        leafless_mesh_free(mesh);
    }

    /* Uninitialised options, and options unknown to this library. */
    memset(&arrays, 0, sizeof arrays);
    refused(LEAFLESS_E_ARGUMENT, &arrays, "struct_size");
    memset(&arrays, 0x33, sizeof arrays);
    refused(LEAFLESS_E_ARGUMENT, &arrays, "struct_size");
    {
        struct {
            leafless_mesh_arrays known;
            uint64_t unknown;
        } newer;
        newer.known = good;
        newer.known.struct_size = sizeof newer;
        newer.unknown = 1;
        refused(LEAFLESS_E_ARGUMENT, &newer.known, "does not know");
        newer.unknown = 0;
        is_cube(&newer.known);
    }
    /* A program older than `scale`: the bytes at its place are not read. */
    arrays = good;
    arrays.struct_size = offsetof(leafless_mesh_arrays, scale);
    arrays.scale = NAN;
    is_cube(&arrays);
}

/* The arrays are the host's again as soon as the call has returned. */
static void nothing_is_kept(void) {
    unsigned char *vertices = (unsigned char *)malloc(sizeof CHECK_CUBE);
    unsigned char *indices = (unsigned char *)malloc(sizeof CHECK_CUBE_TRIANGLES);
    leafless_mesh_arrays arrays = check_arrays(vertices, 8, indices, 12);
    leafless_mesh *mesh = NULL;
    double volume;
    CHECK(vertices != NULL && indices != NULL);
    memcpy(vertices, CHECK_CUBE, sizeof CHECK_CUBE);
    memcpy(indices, CHECK_CUBE_TRIANGLES, sizeof CHECK_CUBE_TRIANGLES);
    OK(leafless_mesh_new(&arrays, &mesh));
    CHECK(memcmp(vertices, CHECK_CUBE, sizeof CHECK_CUBE) == 0);
    CHECK(memcmp(indices, CHECK_CUBE_TRIANGLES, sizeof CHECK_CUBE_TRIANGLES) == 0);
    memset(vertices, 0xff, sizeof CHECK_CUBE);
    memset(indices, 0xff, sizeof CHECK_CUBE_TRIANGLES);
    free(vertices);
    free(indices);
    memset(&arrays, 0xff, sizeof arrays);
    OK(leafless_mesh_volume(mesh, &volume));
    CHECK(volume == 1.0);
    OK(leafless_mesh_check_closed(mesh, LEAFLESS_FILL_NON_ZERO));
    leafless_mesh_free(mesh);
}

int main(void) {
    all_types_and_strides();
    interleaved();
    floats_are_not_changed();
    no_indices();
    scales();
    bad_values();
    bad_fields();
    nothing_is_kept();
    return 0;
}
