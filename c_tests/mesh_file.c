/* Mesh files of every format, from memory and from paths, with units and scales; files that cannot be read. */
#include "check.h"

/* A tetrahedron with edges of 3 along the axes, as a file of each format. */
typedef struct sample {
    const char *name;
    uint32_t format;
    const char *text;
} sample;

static const sample SAMPLES[] = {
    {"sample.stl", LEAFLESS_MESH_FORMAT_STL,
     "solid tetrahedron\n"
     "facet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 3 0\nvertex 3 0 0\nendloop\nendfacet\n"
     "facet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 3 0 0\nvertex 0 0 3\nendloop\nendfacet\n"
     "facet normal -1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 3\nvertex 0 3 0\nendloop\nendfacet\n"
     "facet normal 1 1 1\nouter loop\nvertex 3 0 0\nvertex 0 3 0\nvertex 0 0 3\nendloop\nendfacet\n"
     "endsolid tetrahedron\n"},
};

static void is_tetrahedron(const leafless_mesh *mesh, double edge) {
    double min[3], max[3], volume;
    uint64_t vertices, triangles;
    int axis;
    OK(leafless_mesh_counts(mesh, &vertices, &triangles));
    CHECK(vertices == 4 && triangles == 4);
    OK(leafless_mesh_check_closed(mesh, LEAFLESS_FILL_NON_ZERO));
    OK(leafless_mesh_bounds(mesh, min, max));
    for (axis = 0; axis < 3; axis++) {
        CHECK(min[axis] == 0.0 && max[axis] == edge);
    }
    OK(leafless_mesh_volume(mesh, &volume));
    CHECK(fabs(volume / (edge * edge * edge / 6.0) - 1.0) < 1e-12);
}

static leafless_mesh_options defaults(void) {
    leafless_mesh_options options;
    OK(leafless_mesh_options_init(&options, sizeof options));
    CHECK(options.struct_size == sizeof options && options.format == LEAFLESS_MESH_FORMAT_ANY);
    CHECK(options.unit == LEAFLESS_UNIT_UNKNOWN && options.target == LEAFLESS_UNIT_UNKNOWN && options.scale == 0.0);
    return options;
}

static leafless_mesh_source nothing(void) {
    leafless_mesh_source source;
    memset(&source, 0x5a, sizeof source);
    return source;
}

/* Reads the sample and checks the result. */
static void reads(const sample *one, const leafless_mesh_options *options, uint32_t unit, double edge) {
    const uint64_t length = strlen(one->text);
    leafless_mesh_source source = nothing();
    leafless_mesh *mesh = NULL;
    OK(leafless_mesh_from_bytes((const uint8_t *)one->text, length, options, &source, &mesh));
    CHECK(source.format == one->format && source.unit == unit && source.skipped == 0);
    is_tetrahedron(mesh, edge);
    leafless_mesh_free(mesh);
    mesh = NULL;
    source = nothing();
    check_write(one->name, one->text, (size_t)length);
    OK(leafless_mesh_open(one->name, strlen(one->name), options, &source, &mesh));
    CHECK(source.format == one->format && source.unit == unit && source.skipped == 0);
    is_tetrahedron(mesh, edge);
    leafless_mesh_free(mesh);
}

static void refused(leafless_status status, const void *bytes, uint64_t length, const leafless_mesh_options *options,
                    const char *part) {
    const leafless_mesh_source untouched_source = nothing();
    leafless_mesh *const untouched = (leafless_mesh *)(uintptr_t)0x5a5a5a58;
    leafless_mesh *mesh = untouched;
    leafless_mesh_source source = nothing();
    char message[512];
    FAILS(status, leafless_mesh_from_bytes((const uint8_t *)bytes, length, options, &source, &mesh));
    CHECK(mesh == untouched && memcmp(&source, &untouched_source, sizeof source) == 0);
    (void)leafless_last_error(message, sizeof message);
    if (strstr(message, part) == NULL) {
        fprintf(stderr, "\"%s\" does not say \"%s\"\n", message, part);
        exit(1);
    }
}

static void units(const sample *one) {
    static const struct {
        uint32_t unit;
        double micrometres;
    } UNITS[] = {{LEAFLESS_UNIT_MICROMETRE, 1},      {LEAFLESS_UNIT_MILLIMETRE, 1000}, {LEAFLESS_UNIT_CENTIMETRE, 10000},
                 {LEAFLESS_UNIT_METRE, 1000000},     {LEAFLESS_UNIT_INCH, 25400},      {LEAFLESS_UNIT_FOOT, 304800}};
    const uint64_t length = strlen(one->text);
    leafless_mesh_options options = defaults();
    size_t i, j;
    reads(one, &options, LEAFLESS_UNIT_UNKNOWN, 3.0);
    for (i = 0; i < COUNT(UNITS); i++) {
        options = defaults();
        options.unit = UNITS[i].unit;
        reads(one, &options, UNITS[i].unit, 3.0);
        for (j = 0; j < COUNT(UNITS); j++) {
            options.target = UNITS[j].unit;
            reads(one, &options, UNITS[j].unit, 3.0 * UNITS[i].micrometres / UNITS[j].micrometres);
        }
        /* What the file does not say nobody can convert. */
        options = defaults();
        options.target = UNITS[i].unit;
        refused(LEAFLESS_E_MESH_FILE, one->text, length, &options, "unit");
    }
    options = defaults();
    options.scale = 0.5;
    reads(one, &options, LEAFLESS_UNIT_UNKNOWN, 1.5);
    options.unit = LEAFLESS_UNIT_INCH;
    options.target = LEAFLESS_UNIT_MILLIMETRE;
    options.scale = 10.0;
    reads(one, &options, LEAFLESS_UNIT_MILLIMETRE, 762.0);
}

static void formats(const sample *one) {
    leafless_mesh_options options = defaults();
    reads(one, NULL, LEAFLESS_UNIT_UNKNOWN, 3.0);
    options.format = one->format;
    reads(one, &options, LEAFLESS_UNIT_UNKNOWN, 3.0);
}

/* No end of the file, and no byte of it replaced, does more than fail. */
static void damaged(const sample *one) {
    const size_t length = strlen(one->text);
    leafless_mesh_options options = defaults();
    size_t i, end;
    options.format = one->format;
    for (end = 0; end < length; end++) {
        /* On the heap, so that memory checkers see what is read beyond the end. */
        uint8_t *bytes = (uint8_t *)malloc(end + 1);
        leafless_mesh *mesh = NULL;
        CHECK(bytes != NULL);
        memcpy(bytes, one->text, end);
        (void)leafless_mesh_from_bytes(bytes, end, &options, NULL, &mesh);
        leafless_mesh_free(mesh);
        free(bytes);
    }
    for (i = 0; i < length; i++) {
        static const uint8_t OTHERS[] = {0, 1, ' ', '\n', '-', '.', '0', '9', 'e', '/', 0x7f, 0x80, 0xff};
        uint8_t *bytes = (uint8_t *)malloc(length);
        CHECK(bytes != NULL);
        memcpy(bytes, one->text, length);
        for (end = 0; end < COUNT(OTHERS); end++) {
            leafless_mesh *mesh = NULL;
            bytes[i] = OTHERS[end];
            (void)leafless_mesh_from_bytes(bytes, length, &options, NULL, &mesh);
            leafless_mesh_free(mesh);
            mesh = NULL;
            (void)leafless_mesh_from_bytes(bytes, length, NULL, NULL, &mesh);
            leafless_mesh_free(mesh);
        }
        free(bytes);
    }
}

static void bad_options(void) {
    static const uint32_t not_known[] = {7, 8, 255, UINT32_MAX};
    static const double not_a_scale[] = {-1.0, NAN, INFINITY, -INFINITY, 0x1p-257, 0x1.8p256};
    const sample *one = &SAMPLES[0];
    const uint64_t length = strlen(one->text);
    leafless_mesh_options options;
    size_t i;
    for (i = 0; i < COUNT(not_known); i++) {
        options = defaults();
        options.format = not_known[i] - 1;
        refused(LEAFLESS_E_ARGUMENT, one->text, length, &options, "options.format");
        options = defaults();
        options.unit = not_known[i];
        refused(LEAFLESS_E_ARGUMENT, one->text, length, &options, "options.unit");
        options = defaults();
        options.target = not_known[i];
        refused(LEAFLESS_E_ARGUMENT, one->text, length, &options, "options.target");
    }
    for (i = 0; i < COUNT(not_a_scale); i++) {
        options = defaults();
        options.scale = not_a_scale[i];
        refused(LEAFLESS_E_ARGUMENT, one->text, length, &options, "scale");
    }
    options = defaults();
    options.struct_size = 3;
    refused(LEAFLESS_E_ARGUMENT, one->text, length, &options, "struct_size");
    /* A program from before `scale`: what lies there is not read. */
    options = defaults();
    options.struct_size = offsetof(leafless_mesh_options, scale);
    options.scale = NAN;
    reads(one, &options, LEAFLESS_UNIT_UNKNOWN, 3.0);
}

/* A binary STL of `facets` facets, all of one triangle. */
static uint8_t *binary_stl(uint32_t facets, size_t *length) {
    uint8_t *bytes;
    uint32_t i;
    *length = 84 + 50 * (size_t)facets;
    bytes = (uint8_t *)calloc(*length, 1);
    CHECK(bytes != NULL);
    for (i = 0; i < 4; i++) {
        bytes[80 + i] = (uint8_t)(facets >> 8 * i);
    }
    for (i = 0; i < facets; i++) {
        /* 1.0f in two corners, little-endian. */
        uint8_t *facet = bytes + 84 + 50 * (size_t)i;
        facet[12 + 12 + 2] = 0x80, facet[12 + 12 + 3] = 0x3f;
        facet[12 + 24 + 4 + 2] = 0x80, facet[12 + 24 + 4 + 3] = 0x3f;
    }
    return bytes;
}

static void bad_files(void) {
    leafless_mesh_options options = defaults();
    leafless_mesh *mesh = NULL;
    size_t length;
    uint8_t *bytes = binary_stl(3, &length);
    refused(LEAFLESS_E_MESH_FILE, NULL, 0, NULL, "empty");
    refused(LEAFLESS_E_MESH_FILE, "who knows what this is\n", 23, NULL, "format");
    OK(leafless_mesh_from_bytes(bytes, length, NULL, NULL, &mesh));
    leafless_mesh_free(mesh);
    options.format = LEAFLESS_MESH_FORMAT_STL;
    refused(LEAFLESS_E_MESH_FILE, bytes, length - 1, &options, "3 facets");
    refused(LEAFLESS_E_MESH_FILE, "solid\nfacet normal 0 0 0\nouter hoop\n", 36, NULL, "line 3");
    /* A count of 4294967295 facets is believed by nobody. */
    memset(bytes + 80, 0xff, 4);
    refused(LEAFLESS_E_MESH_FILE, bytes, length, &options, "4294967295 facets");
    free(bytes);
    /* A NaN, and a number that a scale makes too large. */
    bytes = binary_stl(2, &length);
    memset(bytes + 84 + 50 + 12, 0xff, 4);
    refused(LEAFLESS_E_MESH_FILE, bytes, length, NULL, "facet 1");
    free(bytes);
    bytes = binary_stl(1, &length);
    options = defaults();
    options.unit = LEAFLESS_UNIT_METRE;
    options.target = LEAFLESS_UNIT_MICROMETRE;
    options.scale = 0x1p250;
    refused(LEAFLESS_E_MESH, bytes, length, &options, "vertex");
    free(bytes);
    FAILS(LEAFLESS_E_IO, leafless_mesh_open("no/such.stl", 11, NULL, NULL, &mesh));
    FAILS(LEAFLESS_E_IO, leafless_mesh_open(".", 1, NULL, NULL, &mesh));
    FAILS(LEAFLESS_E_UTF8, leafless_mesh_open("\xff.stl", 5, NULL, NULL, &mesh));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_mesh_open("", 0, NULL, NULL, &mesh));
}

int main(void) {
    size_t i;
    for (i = 0; i < COUNT(SAMPLES); i++) {
        formats(&SAMPLES[i]);
        units(&SAMPLES[i]);
        damaged(&SAMPLES[i]);
    }
    bad_options();
    bad_files();
    return 0;
}
