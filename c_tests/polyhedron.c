/* Meshes from faces with holes, shells and voids: every type of array, the defaults, and all that can be wrong. */
#include "check.h"

/* A block [0, 4]^2 x [0, 2] with a hole [1, 3]^2 through it: at the bottom the corners of the block and of the hole,
   then the same at the top. */
static const double BLOCK[16][3] = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 1, 0}, {3, 1, 0}, {3, 3, 0}, {1, 3, 0},
                                    {0, 0, 2}, {4, 0, 2}, {4, 4, 2}, {0, 4, 2}, {1, 1, 2}, {3, 1, 2}, {3, 3, 2}, {1, 3, 2}};
/* Bottom, its hole, top, its hole, then the outer sides and the inner ones: 10 faces of 12 loops. */
static const uint32_t BLOCK_CORNERS[48] = {3, 2,  1,  0,  4, 5,  6,  7,  8, 9,  10, 11, 15, 14, 13, 12,
                                           0, 1,  9,  8,  1, 2,  10, 9,  2, 3,  11, 10, 3,  0,  8,  11,
                                           5, 4,  12, 13, 6, 5,  13, 14, 7, 6,  14, 15, 4,  7,  15, 12};
static const uint32_t BLOCK_LOOPS[13] = {0, 4, 8, 12, 16, 20, 24, 28, 32, 36, 40, 44, 48};
static const uint32_t BLOCK_FACES[11] = {0, 2, 4, 5, 6, 7, 8, 9, 10, 11, 12};
static const uint32_t BLOCK_SHELLS[2] = {0, 10};
static const uint32_t BLOCK_SOLIDS[2] = {0, 1};

static leafless_polyhedron_arrays nothing(void) {
    leafless_polyhedron_arrays arrays;
    OK(leafless_init(&arrays, sizeof arrays));
    return arrays;
}

static leafless_polyhedron_arrays block(void) {
    leafless_polyhedron_arrays arrays = nothing();
    arrays.vertices = BLOCK;
    arrays.vertex_count = 16;
    arrays.corners = BLOCK_CORNERS;
    arrays.corner_count = 48;
    arrays.loops = BLOCK_LOOPS;
    arrays.loop_count = 12;
    arrays.faces = BLOCK_FACES;
    arrays.face_count = 10;
    arrays.shells = BLOCK_SHELLS;
    arrays.shell_count = 1;
    arrays.solids = BLOCK_SOLIDS;
    arrays.solid_count = 1;
    return arrays;
}

static leafless_mesh *made(const leafless_polyhedron_arrays *arrays) {
    leafless_mesh *mesh = NULL;
    double deviation = -1.0;
    OK(leafless_mesh_from_polyhedron(arrays, &deviation, &mesh));
    CHECK(deviation >= 0.0 && deviation < 1e-9);
    OK(leafless_mesh_check_closed(mesh, LEAFLESS_FILL_NON_ZERO));
    return mesh;
}

static double volume(const leafless_polyhedron_arrays *arrays) {
    leafless_mesh *mesh = made(arrays);
    double found;
    OK(leafless_mesh_volume(mesh, &found));
    leafless_mesh_free(mesh);
    return found;
}

static bool near(double found, double expected) {
    return fabs(found - expected) < 1e-12 * fabs(expected);
}

static void refused(leafless_status status, const leafless_polyhedron_arrays *arrays, const char *part) {
    leafless_mesh *const untouched = (leafless_mesh *)(uintptr_t)0x5a5a5a58;
    leafless_mesh *mesh = untouched;
    double deviation = 77.0;
    char message[512];
    FAILS(status, leafless_mesh_from_polyhedron(arrays, &deviation, &mesh));
    CHECK(mesh == untouched && deviation == 77.0);
    (void)leafless_last_error(message, sizeof message);
    if (strstr(message, part) == NULL) {
        fprintf(stderr, "\"%s\" does not say \"%s\"\n", message, part);
        exit(1);
    }
}

/* Indices of a type, `offset` bytes beside an aligned address, in memory that ends with the last. */
static unsigned char *indices(const uint32_t *from, size_t count, uint32_t type, size_t offset) {
    const size_t size = type == LEAFLESS_INDEX_TYPE_U16 ? 2 : type == LEAFLESS_INDEX_TYPE_U64 ? 8 : 4;
    unsigned char *memory = (unsigned char *)malloc(offset + count * size);
    size_t i;
    CHECK(memory != NULL);
    for (i = 0; i < count; i++) {
        const uint64_t whole = from[i];
        const uint16_t quarter = (uint16_t)from[i];
        const void *value = type == LEAFLESS_INDEX_TYPE_U16   ? (const void *)&quarter
                            : type == LEAFLESS_INDEX_TYPE_U64 ? (const void *)&whole
                                                         : (const void *)&from[i];
        memcpy(memory + offset + i * size, value, size);
    }
    return memory;
}

static void all_types(void) {
    uint32_t vertex_type, index_type;
    size_t offset, gap, i, k;
    for (vertex_type = 0; vertex_type < 2; vertex_type++) {
        for (index_type = 0; index_type < 3; index_type++) {
            for (offset = 0; offset < 9; offset++) {
                for (gap = 0; gap < 9; gap += 4) {
                    const size_t size = vertex_type == LEAFLESS_VERTEX_TYPE_F32 ? 12 : 24;
                    leafless_polyhedron_arrays arrays = block();
                    leafless_mesh *mesh;
                    double copied[16][3];
                    unsigned char *memory[6];
                    memory[0] = (unsigned char *)malloc(offset + 15 * (size + gap) + size);
                    CHECK(memory[0] != NULL);
                    for (i = 0; i < 16; i++) {
                        for (k = 0; k < 3; k++) {
                            const float single = (float)BLOCK[i][k];
                            const void *value = vertex_type == LEAFLESS_VERTEX_TYPE_F32 ? (const void *)&single : &BLOCK[i][k];
                            memcpy(memory[0] + offset + i * (size + gap) + k * size / 3, value, size / 3);
                        }
                    }
                    memory[1] = indices(BLOCK_CORNERS, COUNT(BLOCK_CORNERS), index_type, offset);
                    memory[2] = indices(BLOCK_LOOPS, COUNT(BLOCK_LOOPS), index_type, offset);
                    memory[3] = indices(BLOCK_FACES, COUNT(BLOCK_FACES), index_type, offset);
                    memory[4] = indices(BLOCK_SHELLS, COUNT(BLOCK_SHELLS), index_type, offset);
                    memory[5] = indices(BLOCK_SOLIDS, COUNT(BLOCK_SOLIDS), index_type, offset);
                    arrays.vertex_type = vertex_type;
                    arrays.vertex_stride = gap == 0 ? 0 : size + gap;
                    arrays.vertices = memory[0] + offset;
                    arrays.corners = memory[1] + offset;
                    arrays.loops = memory[2] + offset;
                    arrays.faces = memory[3] + offset;
                    arrays.shells = memory[4] + offset;
                    arrays.solids = memory[5] + offset;
                    arrays.index_type = index_type;
                    mesh = made(&arrays);
                    for (i = 0; i < 6; i++) {
                        free(memory[i]);
                    }
                    OK(leafless_mesh_copy(mesh, &copied[0][0], 16, NULL, 0));
                    CHECK(memcmp(copied, BLOCK, sizeof BLOCK) == 0);
                    leafless_mesh_free(mesh);
                }
            }
        }
    }
}

static void block_with_a_hole(void) {
    const leafless_frame frame = {{-1.0, -1.0, -1.0}, 8.0, 6};
    const double in_hole[3] = {2, 2, 1}, in_wall[3] = {0.5, 2, 1};
    leafless_polyhedron_arrays arrays = block();
    leafless_mesh *mesh = made(&arrays);
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    leafless_solid *solid = NULL;
    leafless_octree *octree = NULL;
    leafless_statistics statistics;
    leafless_membership verdict = 77;
    double found;
    OK(leafless_mesh_volume(mesh, &found));
    CHECK(near(found, 24.0));
    OK(leafless_mesh_inspect(mesh, &report));
    /* Euler: of genus 1 are V - E + F = 0, so twice as many triangles as vertices. */
    CHECK(report.triangles == 32 && report.vertices == 16 && report.bodies == 1 && report.boundary_edges == 0);
    OK(leafless_solid_from_mesh(mesh, LEAFLESS_FILL_NON_ZERO, &solid));
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &octree));
    OK(leafless_octree_statistics(octree, &statistics));
    CHECK(statistics.volume_model.lower <= 24.0 && 24.0 <= statistics.volume_model.upper);
    OK(leafless_octree_contains(octree, in_hole, &verdict));
    CHECK(verdict == LEAFLESS_MEMBERSHIP_OUTSIDE);
    OK(leafless_octree_contains(octree, in_wall, &verdict));
    CHECK(verdict == LEAFLESS_MEMBERSHIP_INSIDE);
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    leafless_mesh_free(mesh);

    /* Defaults: one shell of all faces, one solid of all shells; a scale. */
    arrays.solids = NULL;
    arrays.solid_count = 0;
    CHECK(near(volume(&arrays), 24.0));
    arrays.shells = NULL;
    arrays.shell_count = 0;
    CHECK(near(volume(&arrays), 24.0));
    arrays.scale = 0.5;
    CHECK(near(volume(&arrays), 3.0));
    arrays.scale = 0.0;
    /* Each loop is a face. The faces of the holes close a second box, which is inside out. */
    arrays.faces = NULL;
    arrays.face_count = 0;
    CHECK(near(volume(&arrays), 24.0));
    mesh = made(&arrays);
    OK(leafless_mesh_inspect(mesh, &report));
    CHECK(report.triangles == 24 && report.bodies == 2);
    leafless_mesh_free(mesh);
}

/* Cubes as quadrilaterals: `count` of them, the k-th around 0 with this edge, inside out where it is negative. */
static void cubes(const double *edges, const double *places, uint32_t count, double (*vertices)[3], uint32_t *corners,
                  uint32_t *loops) {
    static const uint32_t FACES[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    uint32_t cube, i, k;
    loops[0] = 0;
    for (cube = 0; cube < count; cube++) {
        for (i = 0; i < 8; i++) {
            for (k = 0; k < 3; k++) {
                vertices[8 * cube + i][k] = (CHECK_CUBE[i][k] - 0.5) * fabs(edges[cube]) + (k == 0 ? places[cube] : 0.0);
            }
        }
        for (i = 0; i < 6; i++) {
            for (k = 0; k < 4; k++) {
                corners[24 * cube + 4 * i + k] = 8 * cube + FACES[i][edges[cube] < 0.0 ? 3 - k : k];
            }
            loops[6 * cube + i + 1] = 24 * cube + 4 * (i + 1);
        }
    }
}

static void shells_and_solids(void) {
    /* A cube with two voids beside each other, and one more cube apart from it. */
    static const double EDGES[4] = {4.0, -1.0, -1.5, 2.0}, PLACES[4] = {0.0, -1.2, 0.9, 9.0};
    static const double NONE[1] = {0.0}, INWARD[1] = {-1.0}, OUTWARD[2] = {2.0, 1.0}, APART[2] = {0.0, 5.0};
    static const double VOID_APART[2] = {2.0, -1.0};
    static const uint32_t SHELLS[5] = {0, 6, 12, 18, 24}, SOLIDS[3] = {0, 3, 4}, EACH[5] = {0, 1, 2, 3, 4};
    double vertices[32][3];
    uint32_t corners[96], loops[25];
    leafless_polyhedron_arrays arrays = nothing();
    leafless_mesh *mesh;
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    cubes(EDGES, PLACES, 4, vertices, corners, loops);
    arrays.vertices = vertices;
    arrays.vertex_count = 32;
    arrays.corners = corners;
    arrays.corner_count = 96;
    arrays.loops = loops;
    arrays.loop_count = 24;
    arrays.shells = SHELLS;
    arrays.shell_count = 4;
    arrays.solids = SOLIDS;
    arrays.solid_count = 2;
    CHECK(near(volume(&arrays), 64.0 - 1.0 - 3.375 + 8.0));
    mesh = made(&arrays);
    OK(leafless_mesh_inspect(mesh, &report));
    CHECK(report.bodies == 4 && report.triangles == 48);
    leafless_mesh_free(mesh);
    /* The first solid alone; by default it is one. */
    arrays.vertex_count = 24;
    arrays.corner_count = 72;
    arrays.loop_count = 18;
    arrays.shell_count = 3;
    arrays.solid_count = 1;
    CHECK(near(volume(&arrays), 64.0 - 1.0 - 3.375));
    arrays.solids = NULL;
    arrays.solid_count = 0;
    CHECK(near(volume(&arrays), 64.0 - 1.0 - 3.375));
    /* Voids as solids of their own are inside out. */
    arrays.solids = EACH;
    arrays.solid_count = 3;
    refused(LEAFLESS_E_MESH, &arrays, "shell 1");
    /* One cube inside out. */
    arrays.solids = NULL;
    arrays.solid_count = 0;
    arrays.vertex_count = 8;
    arrays.corner_count = 24;
    arrays.loop_count = 6;
    arrays.shell_count = 1;
    cubes(INWARD, NONE, 1, vertices, corners, loops);
    refused(LEAFLESS_E_MESH, &arrays, "shell 0");
    /* A void that is none, and one that lies elsewhere. */
    arrays.vertex_count = 16;
    arrays.corner_count = 48;
    arrays.loop_count = 12;
    arrays.shell_count = 2;
    cubes(OUTWARD, APART, 2, vertices, corners, loops);
    refused(LEAFLESS_E_MESH, &arrays, "shell 1");
    cubes(VOID_APART, APART, 2, vertices, corners, loops);
    refused(LEAFLESS_E_MESH, &arrays, "shell 1");
}

static void bad_arrays(void) {
    double vertices[16][3];
    uint32_t corners[48], loops[13], faces[11], shells[2] = {0, 9}, solids[2] = {0, 2};
    uint64_t wide[48];
    leafless_polyhedron_arrays arrays;
    size_t i;

#define AGAIN                                                                                                    \
    arrays = block(), memcpy(vertices, BLOCK, sizeof BLOCK), memcpy(corners, BLOCK_CORNERS, sizeof corners),       \
    memcpy(loops, BLOCK_LOOPS, sizeof loops), memcpy(faces, BLOCK_FACES, sizeof faces), arrays.vertices = vertices, \
    arrays.corners = corners, arrays.loops = loops, arrays.faces = faces

    /* Numbers: of vertices and corners. */
    AGAIN;
    vertices[6][1] = NAN;
    refused(LEAFLESS_E_MESH, &arrays, "vertex 6 ");
    AGAIN;
    vertices[15][2] = 0x1.8p256;
    refused(LEAFLESS_E_MESH, &arrays, "vertex 15 ");
    AGAIN;
    corners[33] = 16;
    refused(LEAFLESS_E_MESH, &arrays, "corner 33 refers to vertex 16,");
    for (i = 0; i < 48; i++) {
        wide[i] = BLOCK_CORNERS[i];
    }
    /* Where the offsets are of the same type as the corners. */
    {
        uint64_t wide_loops[13], wide_faces[11];
        static const uint64_t WIDE_SHELLS[2] = {0, 10}, WIDE_SOLIDS[2] = {0, 1};
        for (i = 0; i < 13; i++) {
            wide_loops[i] = BLOCK_LOOPS[i];
        }
        for (i = 0; i < 11; i++) {
            wide_faces[i] = BLOCK_FACES[i];
        }
        arrays = block();
        arrays.index_type = LEAFLESS_INDEX_TYPE_U64;
        arrays.corners = wide;
        arrays.loops = wide_loops;
        arrays.faces = wide_faces;
        arrays.shells = WIDE_SHELLS;
        arrays.solids = WIDE_SOLIDS;
        CHECK(near(volume(&arrays), 24.0));
        wide[7] += (uint64_t)1 << 32;
        refused(LEAFLESS_E_MESH, &arrays, "corner 7 refers to vertex 4294967303,");
        wide[7] -= (uint64_t)1 << 32;
        wide_loops[12] += (uint64_t)1 << 32;
        refused(LEAFLESS_E_MESH, &arrays, "offsets of the loops are wrong at index 12");
        wide_loops[12] -= (uint64_t)1 << 32;
        wide_faces[3] += (uint64_t)1 << 32;
        refused(LEAFLESS_E_MESH, &arrays, "offsets of the faces are wrong at index 3");
    }

    /* Offsets that do not begin with 0, do not rise, or end elsewhere. */
    for (i = 0; i < 13; i++) {
        AGAIN;
        loops[i] = i == 0 ? 1 : i == 12 ? 47 : loops[i - 1];
        refused(LEAFLESS_E_MESH, &arrays, "offsets of the loops");
        AGAIN;
        loops[i] = UINT32_MAX;
        refused(LEAFLESS_E_MESH, &arrays, "offsets of the loops");
    }
    AGAIN;
    faces[10] = 13;
    refused(LEAFLESS_E_MESH, &arrays, "offsets of the faces");
    AGAIN;
    arrays.shells = shells;
    refused(LEAFLESS_E_MESH, &arrays, "offsets of the shells");
    AGAIN;
    arrays.solids = solids;
    refused(LEAFLESS_E_MESH, &arrays, "offsets of the solids");
    AGAIN;
    arrays.loops = NULL;
    arrays.loop_count = 0;
    refused(LEAFLESS_E_MESH, &arrays, "offsets of the loops");

    /* The described solid: a missing face, an inverted face, a bent face, a hole outside its face. */
    AGAIN;
    arrays.corner_count = 44;
    arrays.loop_count = 11;
    arrays.face_count = 9;
    arrays.shells = shells;
    refused(LEAFLESS_E_MESH, &arrays, "shell 0 is open: the edge of face");
    AGAIN;
    corners[44] = 12, corners[45] = 15, corners[46] = 7, corners[47] = 4;
    refused(LEAFLESS_E_MESH, &arrays, "face 9");
    AGAIN;
    vertices[10][2] = 2.5;
    refused(LEAFLESS_E_MESH, &arrays, "face 1 is not plane");
    arrays.tolerance_model = 0.6;
    {
        leafless_mesh *mesh = NULL;
        double deviation = 0.0;
        OK(leafless_mesh_from_polyhedron(&arrays, &deviation, &mesh));
        CHECK(deviation > 0.1 && deviation <= 0.6);
        OK(leafless_mesh_check_closed(mesh, LEAFLESS_FILL_NON_ZERO));
        leafless_mesh_free(mesh);
    }
    AGAIN;
    for (i = 0; i < 16; i++) {
        vertices[i][0] += i / 4 % 2 == 1 ? 10.0 : 0.0;
    }
    refused(LEAFLESS_E_MESH, &arrays, "the loops of face 0");
    AGAIN;
    corners[1] = corners[0];
    refused(LEAFLESS_E_MESH, &arrays, "face 0 has an edge of zero length");
    AGAIN;
    loops[1] = 2;
    refused(LEAFLESS_E_MESH, &arrays, "loop 0 has 2 corners");
    refused(LEAFLESS_E_MESH, (arrays = nothing(), &arrays), "no triangle");
}

static void bad_fields(void) {
    static const double BAD[] = {-1.0, NAN, INFINITY, -INFINITY, 0x1p-257, 0x1.8p256};
    leafless_polyhedron_arrays arrays;
    size_t i;
    arrays = block();
    arrays.vertex_type = 2;
    refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.vertex_type");
    arrays = block();
    arrays.index_type = 3;
    refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.index_type");
    arrays = block();
    arrays.vertex_stride = 23;
    refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.vertex_stride");
    arrays.vertex_stride = UINT64_MAX;
    refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.vertices");
    for (i = 0; i < COUNT(BAD); i++) {
        arrays = block();
        arrays.scale = BAD[i];
        refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.scale");
        if (!(BAD[i] > 0.0)) {
            arrays = block();
            arrays.tolerance_model = BAD[i];
            refused(LEAFLESS_E_ARGUMENT, &arrays, "arrays.tolerance_model");
        }
    }
    /* Counts beyond memory, and beyond 32 bits: nothing is read. */
#define TOO_MANY(count)                                                                                          \
    arrays = block(), arrays.count = UINT64_MAX, CHECK(leafless_mesh_from_polyhedron(&arrays, NULL, &mesh) != LEAFLESS_OK), \
    arrays.count = UINT64_MAX / 4, CHECK(leafless_mesh_from_polyhedron(&arrays, NULL, &mesh) == LEAFLESS_E_ARGUMENT || \
                                         leafless_last_status() == LEAFLESS_E_MESH),                             \
    arrays.count = (uint64_t)1 << 32, refused(LEAFLESS_E_MESH, &arrays, "2^32 - 1")
    {
        leafless_mesh *mesh = NULL;
        TOO_MANY(vertex_count);
        TOO_MANY(corner_count);
        TOO_MANY(loop_count);
        TOO_MANY(face_count);
        TOO_MANY(shell_count);
        TOO_MANY(solid_count);
        CHECK(mesh == NULL);
    }
    /* Pointers: absent only where there is nothing, or by default. */
#define ABSENT(field) arrays = block(), arrays.field = NULL, refused(LEAFLESS_E_NULL, &arrays, "arrays." #field)
    ABSENT(vertices);
    ABSENT(corners);
    ABSENT(loops);
    ABSENT(faces);
    ABSENT(shells);
    ABSENT(solids);
    memset(&arrays, 0, sizeof arrays);
    refused(LEAFLESS_E_ARGUMENT, &arrays, "struct_size");
    /* A program older than the tolerance: the bytes at its place are not read. */
    arrays = block();
    arrays.struct_size = offsetof(leafless_polyhedron_arrays, tolerance_model);
    arrays.tolerance_model = -1.0;
    CHECK(near(volume(&arrays), 24.0));
}

int main(void) {
    all_types();
    block_with_a_hole();
    shells_and_solids();
    bad_arrays();
    bad_fields();
    return 0;
}
