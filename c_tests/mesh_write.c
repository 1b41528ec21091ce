/* Mesh files, written and read again: every format, as text and binary, in memory and on disk; refused calls. */
#include "check.h"

/* A tetrahedron whose coordinates are not short decimal numbers. */
static leafless_mesh *tetrahedron(double factor) {
    const double t = factor / 3;
    const double vertices[4][3] = {{t, 0, 0}, {0, t, -t}, {0, 0.1 * t, t}, {-t, 1e-5 * t, 0.7}};
    static const uint32_t triangles[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const leafless_mesh_arrays arrays = check_arrays(vertices, 4, triangles, 4);
    leafless_mesh *mesh = NULL;
    OK(leafless_mesh_new(&arrays, &mesh));
    return mesh;
}

/* The same arrays; of single precision, the same once they are rounded, but in another order. */
static void same(const leafless_mesh *a, const leafless_mesh *b, bool is_single) {
    double vertices[2][4][3], volumes[2];
    uint32_t triangles[2][4][3];
    uint64_t vertex_count, triangle_count;
    OK(check_counts(b, &vertex_count, &triangle_count));
    CHECK(vertex_count == 4 && triangle_count == 4);
    OK(leafless_mesh_copy(a, vertices[0][0], 4, triangles[0][0], 4));
    OK(leafless_mesh_copy(b, vertices[1][0], 4, triangles[1][0], 4));
    OK(leafless_mesh_volume(a, &volumes[0]));
    OK(leafless_mesh_volume(b, &volumes[1]));
    if (is_single) {
        int corner, axis;
        for (corner = 0; corner < 12; corner++) {
            for (axis = 0; axis < 3; axis++) {
                CHECK((float)vertices[0][triangles[0][corner / 3][corner % 3]][axis] ==
                      (float)vertices[1][triangles[1][corner / 3][corner % 3]][axis]);
            }
        }
        CHECK(fabs(volumes[0] - volumes[1]) < 1e-6 * fabs(volumes[0]));
    } else {
        CHECK(memcmp(vertices[0], vertices[1], sizeof vertices[0]) == 0);
        CHECK(memcmp(triangles[0], triangles[1], sizeof triangles[0]) == 0);
    }
}

static leafless_mesh_write_options defaults(void) {
    leafless_mesh_write_options options;
    OK(leafless_init(&options, sizeof options));
    return options;
}

static uint8_t *bytes_of(const leafless_mesh *mesh, const leafless_mesh_write_options *options, uint64_t *length) {
    uint64_t again;
    uint8_t *bytes;
    OK(mesh_to_bytes(mesh, options, NULL, 0, length));
    bytes = (uint8_t *)malloc((size_t)*length);
    CHECK(bytes != NULL);
    FAILS(LEAFLESS_E_BUFFER, mesh_to_bytes(mesh, options, bytes, *length - 1, &again));
    OK(mesh_to_bytes(mesh, options, bytes, *length, &again));
    CHECK(again == *length);
    return bytes;
}

static void formats(void) {
    static const struct {
        const char *path;
        uint32_t format;
        const char *start[2];
    } FORMATS[] = {
        {"written.stl", LEAFLESS_MESH_FORMAT_STL, {NULL, "solid"}},
        {"written.obj", LEAFLESS_MESH_FORMAT_OBJ, {NULL, NULL}},
        {"written.PLY", LEAFLESS_MESH_FORMAT_PLY, {"ply\nformat binary", "ply\nformat ascii"}},
        {"written.off", LEAFLESS_MESH_FORMAT_OFF, {"OFF", "OFF"}},
        {"written.3mf", LEAFLESS_MESH_FORMAT_3MF, {"PK", "PK"}},
    };
    leafless_mesh *mesh = tetrahedron(1);
    size_t i;
    uint32_t text;
    for (i = 0; i < COUNT(FORMATS); i++) {
        for (text = 0; text < 2; text++) {
            const char *const start = FORMATS[i].start[text];
            leafless_mesh_write_options options = defaults();
            leafless_mesh_file_info found = LEAFLESS_INIT(leafless_mesh_file_info);
            leafless_mesh *back = NULL;
            uint64_t length;
            uint8_t *bytes, *file;
            size_t file_length;
            /* The format by its number, or by the extension. */
            options.is_text = text;
            options.format = FORMATS[i].format;
            bytes = bytes_of(mesh, &options, &length);
            CHECK(start == NULL || memcmp(bytes, start, strlen(start)) == 0);
            options.format = LEAFLESS_MESH_FORMAT_ANY;
            OK(mesh_save(mesh, FORMATS[i].path, strlen(FORMATS[i].path), &options));
            file = check_read(FORMATS[i].path, &file_length);
            CHECK(file_length == length && memcmp(file, bytes, file_length) == 0);
            free(file);
            OK(mesh_open(FORMATS[i].path, strlen(FORMATS[i].path), NULL, &found, &back));
            CHECK(found.format == FORMATS[i].format);
            CHECK(found.unit == (found.format == LEAFLESS_MESH_FORMAT_3MF ? LEAFLESS_UNIT_MILLIMETRE
                                                                           : LEAFLESS_UNIT_UNKNOWN));
            same(mesh, back, found.format == LEAFLESS_MESH_FORMAT_STL);
            leafless_mesh_free(back);
            free(bytes);
        }
        OK(mesh_save(mesh, FORMATS[i].path, strlen(FORMATS[i].path), NULL));
    }
    leafless_mesh_free(mesh);
}

/* What a file says of its distance from the true boundary. */
static void deviations(void) {
    leafless_mesh_write_options options = defaults();
    leafless_mesh_file_info found = LEAFLESS_INIT(leafless_mesh_file_info);
    leafless_mesh_info info = LEAFLESS_INIT(leafless_mesh_info);
    leafless_mesh *mesh = tetrahedron(1), *back = NULL;
    uint64_t length;
    uint8_t *bytes;
    options.format = LEAFLESS_MESH_FORMAT_PLY;
    options.deviation_model = 0.25;
    bytes = bytes_of(mesh, &options, &length);
    OK(mesh_from_bytes(bytes, length, NULL, &found, &back));
    CHECK(found.deviation_model == 0.25);
    OK(leafless_mesh_describe(back, &info));
    CHECK(info.deviation_model == 0.0);
    leafless_mesh_free(back);
    free(bytes);
    options.deviation_model = -1;
    FAILS(LEAFLESS_E_ARGUMENT, mesh_to_bytes(mesh, &options, NULL, 0, &length));
    leafless_mesh_free(mesh);
}

static void units(void) {
    leafless_mesh_write_options options = defaults();
    leafless_mesh *mesh = tetrahedron(7), *back;
    leafless_mesh_file_info found = LEAFLESS_INIT(leafless_mesh_file_info);
    uint32_t unit;
    options.format = LEAFLESS_MESH_FORMAT_3MF;
    for (unit = LEAFLESS_UNIT_MICROMETRE; unit <= LEAFLESS_UNIT_FOOT; unit++) {
        uint64_t length;
        uint8_t *bytes;
        options.unit = unit;
        bytes = bytes_of(mesh, &options, &length);
        OK(mesh_from_bytes(bytes, length, NULL, &found, &back));
        CHECK(found.unit == unit);
        same(mesh, back, false);
        leafless_mesh_free(back);
        free(bytes);
    }
    leafless_mesh_free(mesh);
}

/* Normals at vertices, handed out and written. */
static void normals(void) {
    static const struct {
        uint32_t format, is_text;
        const char *has;
    } FORMATS[] = {{LEAFLESS_MESH_FORMAT_PLY, 0, "property float nx"},
                   {LEAFLESS_MESH_FORMAT_PLY, 1, "property float nx"},
                   {LEAFLESS_MESH_FORMAT_OBJ, 0, "\nvn "},
                   {LEAFLESS_MESH_FORMAT_OFF, 0, NULL}};
    leafless_mesh *cube = check_cube(), *mesh = tetrahedron(3);
    double found[8][3];
    uint64_t count;
    size_t i;
    int axis;
    OK(leafless_mesh_normals(cube, NULL, 0, &count));
    CHECK(count == 8);
    FAILS(LEAFLESS_E_BUFFER, leafless_mesh_normals(cube, found[0], 7, &count));
    OK(leafless_mesh_normals(cube, found[0], 8, &count));
    for (i = 0; i < 8; i++) {
        for (axis = 0; axis < 3; axis++) {
            CHECK(fabs(found[i][axis] - (CHECK_CUBE[i][axis] > 0 ? 1 : -1) * sqrt(1.0 / 3)) < 1e-14);
        }
    }
    for (i = 0; i < COUNT(FORMATS); i++) {
        leafless_mesh_write_options options = defaults();
        leafless_mesh *back = NULL;
        uint64_t lengths[2];
        uint8_t *bytes;
        options.format = FORMATS[i].format;
        options.is_text = FORMATS[i].is_text;
        OK(mesh_to_bytes(mesh, &options, NULL, 0, &lengths[0]));
        options.has_normals = 1;
        bytes = bytes_of(mesh, &options, &lengths[1]);
        CHECK((lengths[1] > lengths[0]) == (FORMATS[i].has != NULL));
        if (FORMATS[i].has != NULL) {
            const size_t length = strlen(FORMATS[i].has);
            size_t at = 0;
            while (at + length < lengths[1] && memcmp(bytes + at, FORMATS[i].has, length) != 0) at++;
            CHECK(at + length < lengths[1]);
        }
        OK(mesh_from_bytes(bytes, lengths[1], NULL, NULL, &back));
        same(mesh, back, false);
        leafless_mesh_free(back);
        free(bytes);
    }
    leafless_mesh_free(cube);
    leafless_mesh_free(mesh);
}

/* The losses of a file: none except in an STL, where a cube far away becomes a square. */
static void losses(void) {
    leafless_mesh *cube = check_cube(), *far = NULL;
    const double matrix[12] = {1, 0, 0, 1e9, 0, 1, 0, 0, 0, 0, 1, 0};
    uint32_t format;
    OK(leafless_mesh_transformed(cube, matrix, &far));
    for (format = LEAFLESS_MESH_FORMAT_STL; format <= LEAFLESS_MESH_FORMAT_3MF; format++) {
        leafless_mesh_write_options options = defaults();
        leafless_mesh *kept = NULL, *back = NULL;
        uint64_t counts[2][2], length;
        double volumes[2];
        uint8_t *bytes;
        options.format = format;
        OK(leafless_mesh_written_form(far, &options, &kept));
        bytes = bytes_of(far, &options, &length);
        OK(mesh_from_bytes(bytes, length, NULL, NULL, &back));
        OK(check_counts(kept, &counts[0][0], &counts[0][1]));
        OK(check_counts(back, &counts[1][0], &counts[1][1]));
        CHECK(memcmp(counts[0], counts[1], sizeof counts[0]) == 0);
        CHECK(counts[0][1] == (format == LEAFLESS_MESH_FORMAT_STL ? 4u : 12u));
        OK(leafless_mesh_volume(kept, &volumes[0]));
        OK(leafless_mesh_volume(back, &volumes[1]));
        CHECK(volumes[0] == volumes[1] && (volumes[0] == 0) == (format == LEAFLESS_MESH_FORMAT_STL));
        leafless_mesh_free(kept);
        leafless_mesh_free(back);
        free(bytes);
    }
    {
        leafless_mesh_write_options options = defaults();
        leafless_mesh *kept = NULL;
        FAILS(LEAFLESS_E_ARGUMENT, leafless_mesh_written_form(far, &options, &kept));
        CHECK(kept == NULL);
    }
    leafless_mesh_free(far);
    leafless_mesh_free(cube);
}

static void refusals(void) {
    leafless_mesh *mesh = tetrahedron(1), *huge = tetrahedron(1e40), *nothing = NULL;
    const leafless_mesh_arrays none = check_arrays(NULL, 0, NULL, 0);
    leafless_mesh_write_options options = defaults();
    uint8_t stl[84 + 50 * 4];
    uint64_t length = 0, size;
    FILE *file;
    options.format = LEAFLESS_MESH_FORMAT_STL;
    OK(mesh_to_bytes(mesh, &options, stl, sizeof stl, &length));
    CHECK(length == 84 + 50 * 4);
    FAILS(LEAFLESS_E_ARGUMENT, mesh_to_bytes(huge, &options, NULL, 0, &length));
    FAILS(LEAFLESS_E_ARGUMENT, mesh_save(huge, "refused.stl", 11, NULL));
    OK(leafless_mesh_new(&none, &nothing));
    FAILS(LEAFLESS_E_ARGUMENT, mesh_save(nothing, "refused.obj", 11, NULL));
    OK(mesh_save(nothing, "nothing.ply", 11, NULL));
    options.format = LEAFLESS_MESH_FORMAT_ANY;
    FAILS(LEAFLESS_E_ARGUMENT, mesh_to_bytes(mesh, &options, NULL, 0, &length));
    FAILS(LEAFLESS_E_ARGUMENT, mesh_save(mesh, "refused", 7, NULL));
    FAILS(LEAFLESS_E_ARGUMENT, mesh_save(mesh, "refused.lfl", 11, &options));
    FAILS(LEAFLESS_E_ARGUMENT, mesh_save(mesh, ".ply", 4, &options));
    options.format = 6;
    FAILS(LEAFLESS_E_ARGUMENT, mesh_save(mesh, "refused.ply", 11, &options));
    options = defaults();
    options.is_text = 2;
    FAILS(LEAFLESS_E_ARGUMENT, mesh_save(mesh, "refused.ply", 11, &options));
    options = defaults();
    options.unit = 7;
    FAILS(LEAFLESS_E_ARGUMENT, mesh_save(mesh, "refused.ply", 11, &options));
    options = defaults();
    options.has_normals = 2;
    FAILS(LEAFLESS_E_ARGUMENT, mesh_save(mesh, "refused.ply", 11, &options));
    for (size = 0; size < 4; size++) {
        options = defaults();
        options.struct_size = (uint32_t)size;
        FAILS(LEAFLESS_E_ARGUMENT, mesh_save(mesh, "refused.ply", 11, &options));
        FAILS(LEAFLESS_E_ARGUMENT, leafless_init(&options, (size_t)size));
    }
    FAILS(LEAFLESS_E_IO, mesh_save(mesh, "no/such/file.ply", 16, NULL));
    FAILS(LEAFLESS_E_UTF8, mesh_save(mesh, "a\0.ply", 6, NULL));
    file = fopen("refused.ply", "rb");
    CHECK(file == NULL);
    file = fopen("refused.obj", "rb");
    CHECK(file == NULL);
    /* A format that is given does not look at the extension. */
    options = defaults();
    options.format = LEAFLESS_MESH_FORMAT_OFF;
    OK(mesh_save(mesh, "written", 7, &options));
    /* The old file stays if the new one is refused. */
    OK(mesh_save(mesh, "kept.stl", 8, NULL));
    FAILS(LEAFLESS_E_ARGUMENT, mesh_save(huge, "kept.stl", 8, NULL));
    {
        size_t kept;
        uint8_t *bytes = check_read("kept.stl", &kept);
        CHECK(kept == sizeof stl && memcmp(bytes, stl, kept) == 0);
        free(bytes);
    }
    leafless_mesh_free(nothing);
    leafless_mesh_free(huge);
    leafless_mesh_free(mesh);
}

/* A tetrahedron with one corner cut off by less than single precision resolves. */
static void mended(void) {
    static const double CORNERS[5][3] = {{1, 1, 1}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}, {1 + 1e-9, 1, 1}};
    static const uint32_t TRIANGLES[6][3] = {{0, 2, 4}, {4, 2, 1}, {0, 4, 3}, {4, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    leafless_mesh_arrays arrays = LEAFLESS_INIT(leafless_mesh_arrays);
    leafless_single_precision told = LEAFLESS_INIT(leafless_single_precision);
    leafless_mesh_info info = LEAFLESS_INIT(leafless_mesh_info);
    leafless_mesh *mesh = NULL, *single = NULL, *kept = NULL;
    leafless_mesh_write_options options = defaults();
    arrays.vertices = CORNERS;
    arrays.vertex_count = 5;
    arrays.indices = TRIANGLES;
    arrays.triangle_count = 6;
    OK(leafless_mesh_new(&arrays, &mesh));
    OK(leafless_mesh_in_single_precision(mesh, 1e-3, NULL, &told, &single));
    CHECK(told.collapsed == 2 && told.flipped == 0 && told.moved == 0);
    CHECK(told.degenerate == 0 && told.intersecting_pairs == 0);
    CHECK(told.rounding_model > 0.9e-9 && told.deviation_model >= told.rounding_model && told.deviation_model < 2e-9);
    OK(leafless_mesh_describe(single, &info));
    CHECK(info.triangles == 4 && info.vertices == 4);
    OK(leafless_mesh_check_closed(single, LEAFLESS_FILL_NON_ZERO));
    /* An STL loses nothing of it. */
    options.format = LEAFLESS_MESH_FORMAT_STL;
    OK(leafless_mesh_written_form(single, &options, &kept));
    same(single, kept, true);
    leafless_mesh_free(kept);
    leafless_mesh_free(single);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_mesh_in_single_precision(mesh, -1, NULL, &told, &single));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_mesh_in_single_precision(mesh, (double)NAN, NULL, &told, &single));
    leafless_mesh_free(mesh);
}

int main(void) {
    formats();
    mended();
    deviations();
    units();
    normals();
    losses();
    refusals();
    return 0;
}
