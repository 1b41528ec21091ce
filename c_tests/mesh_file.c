/* Mesh files of every format, from memory and from paths, with units and scales; files that cannot be read. */
#include "check.h"

/* A tetrahedron with edges of 3 along the axes, as a file of each format. */
typedef struct sample {
    const char *name;
    uint32_t format;
    /* What the file says of it. */
    uint32_t unit;
    const void *bytes;
    size_t length;
} sample;

static const char STL[] =
    "solid tetrahedron\n"
    "facet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 3 0\nvertex 3 0 0\nendloop\nendfacet\n"
    "facet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 3 0 0\nvertex 0 0 3\nendloop\nendfacet\n"
    "facet normal -1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 3\nvertex 0 3 0\nendloop\nendfacet\n"
    "facet normal 1 1 1\nouter loop\nvertex 3 0 0\nvertex 0 3 0\nvertex 0 0 3\nendloop\nendfacet\n"
    "endsolid tetrahedron\n";
static const char OBJ[] = "# a tetrahedron\no tetrahedron\nv 0 0 0\nv 3 0 0\nv 0 3 0\nv 0 0 3\nvn 0 0 1\n"
                          "f 1//1 3//1 2//1\nf 1 2 \\\n4\ng others\nf 1 4 3\nf -3 -2 -1\n";
static const char PLY[] = "ply\nformat ascii 1.0\ncomment a tetrahedron\nelement vertex 4\nproperty float x\n"
                          "property float y\nproperty float z\nproperty uchar red\nelement face 4\n"
                          "property list uchar int vertex_indices\nend_header\n"
                          "0 0 0 255\n3 0 0 255\n0 3 0 255\n0 0 3 255\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
static const char OFF[] = "OFF\n# a tetrahedron\n4 4 6\n0 0 0\n3 0 0\n0 3 0\n0 0 3\n3 0 2 1\n3 0 1 3\n3 0 3 2\n"
                          "3 1 2 3 255 0 0\n";

/* PLY, binary: a header with the order of bytes, 4 vertices of 3 floats, 4 faces. */
static size_t binary_ply(bool big, uint8_t *to) {
    static const char HEADER[] = "ply\nformat binary_%s_endian 1.0\nelement vertex 4\nproperty float x\n"
                                 "property float y\nproperty float z\nelement face 4\n"
                                 "property list uchar int vertex_indices\nend_header\n";
    static const uint8_t FACES[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    /* 3.0f is 0x40400000. */
    static const uint8_t THREE[4] = {0x40, 0x40, 0, 0};
    size_t length = (size_t)sprintf((char *)to, HEADER, big ? "big" : "little"), i, k, byte;
    for (i = 0; i < 4; i++) {
        for (k = 0; k < 3; k++) {
            for (byte = 0; byte < 4; byte++) {
                to[length++] = i == k + 1 ? THREE[big ? byte : 3 - byte] : 0;
            }
        }
    }
    for (i = 0; i < 4; i++) {
        to[length++] = 3;
        for (k = 0; k < 3; k++) {
            for (byte = 0; byte < 4; byte++) {
                to[length++] = byte == (big ? 3 : 0) ? FACES[i][k] : 0;
            }
        }
    }
    return length;
}

static void put(uint8_t *to, size_t *length, uint32_t value, size_t size) {
    while (size-- > 0) {
        to[(*length)++] = (uint8_t)value;
        value >>= 8;
    }
}

static uint32_t crc32_of(const char *text) {
    uint32_t crc = 0xffffffffu;
    int bit;
    for (; *text != '\0'; text++) {
        crc ^= (uint8_t)*text;
        for (bit = 0; bit < 8; bit++) {
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
        }
    }
    return ~crc;
}

/* 3MF: a ZIP of three parts, not compressed. The tetrahedron has edges of 1 and is scaled by the item's transform. */
static size_t threemf(uint8_t *to) {
    static const char *const PARTS[3][2] = {
        {"[Content_Types].xml",
         "<?xml version=\"1.0\"?><Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
         "<Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
         "<Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>"},
        {"_rels/.rels",
         "<?xml version=\"1.0\"?><Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
         "<Relationship Target=\"/3D/3dmodel.model\" Id=\"r\" "
         "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>"},
        {"3D/3dmodel.model",
         "<?xml version=\"1.0\"?><model unit=\"inch\" "
         "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources><object id=\"1\" type=\"model\">"
         "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>"
         "<vertex x=\"0\" y=\"1\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"1\"/></vertices><triangles>"
         "<triangle v1=\"0\" v2=\"2\" v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/>"
         "<triangle v1=\"0\" v2=\"3\" v3=\"2\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\"/></triangles></mesh></object>"
         "</resources><build><item objectid=\"1\" transform=\"3 0 0 0 3 0 0 0 3 0 0 0\"/></build></model>"}};
    size_t length = 0, offsets[3], start, i, pass;
    for (pass = 0; pass < 2; pass++) {
        start = length;
        for (i = 0; i < 3; i++) {
            const size_t name = strlen(PARTS[i][0]), size = strlen(PARTS[i][1]);
            if (pass == 0) {
                offsets[i] = length;
                put(to, &length, 0x04034b50, 4);
            } else {
                put(to, &length, 0x02014b50, 4);
                put(to, &length, 20, 2);
            }
            put(to, &length, 20, 2);
            put(to, &length, 0, 4); /* flags, stored */
            put(to, &length, 0x00210000, 4); /* 1980-01-01 */
            put(to, &length, crc32_of(PARTS[i][1]), 4);
            put(to, &length, (uint32_t)size, 4);
            put(to, &length, (uint32_t)size, 4);
            put(to, &length, (uint32_t)name, 2);
            put(to, &length, 0, 2);
            if (pass == 1) {
                put(to, &length, 0, 4); /* comment, disk */
                put(to, &length, 0, 2);
                put(to, &length, 0, 4);
                put(to, &length, (uint32_t)offsets[i], 4);
            }
            memcpy(to + length, PARTS[i][0], name);
            length += name;
            if (pass == 0) {
                memcpy(to + length, PARTS[i][1], size);
                length += size;
            }
        }
    }
    put(to, &length, 0x06054b50, 4);
    i = length - 4 - start;
    put(to, &length, 0, 4);
    put(to, &length, 3, 2);
    put(to, &length, 3, 2);
    put(to, &length, (uint32_t)i, 4);
    put(to, &length, (uint32_t)start, 4);
    put(to, &length, 0, 2);
    return length;
}

static uint8_t memory[3][4096];

static sample samples[] = {
    {"sample.stl", LEAFLESS_MESH_FORMAT_STL, LEAFLESS_UNIT_UNKNOWN, STL, sizeof STL - 1},
    {"sample.obj", LEAFLESS_MESH_FORMAT_OBJ, LEAFLESS_UNIT_UNKNOWN, OBJ, sizeof OBJ - 1},
    {"ascii.ply", LEAFLESS_MESH_FORMAT_PLY, LEAFLESS_UNIT_UNKNOWN, PLY, sizeof PLY - 1},
    {"sample.off", LEAFLESS_MESH_FORMAT_OFF, LEAFLESS_UNIT_UNKNOWN, OFF, sizeof OFF - 1},
    {"little.ply", LEAFLESS_MESH_FORMAT_PLY, LEAFLESS_UNIT_UNKNOWN, memory[0], 0},
    {"big.ply", LEAFLESS_MESH_FORMAT_PLY, LEAFLESS_UNIT_UNKNOWN, memory[1], 0},
    {"sample.3mf", LEAFLESS_MESH_FORMAT_3MF, LEAFLESS_UNIT_INCH, memory[2], 0},
};

static void is_tetrahedron(const leafless_mesh *mesh, double edge) {
    double min[3], max[3], volume;
    uint64_t vertices, triangles;
    int axis;
    OK(check_counts(mesh, &vertices, &triangles));
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
    OK(leafless_init(&options, sizeof options));
    CHECK(options.struct_size == sizeof options && options.format == LEAFLESS_MESH_FORMAT_ANY);
    CHECK(options.unit == LEAFLESS_UNIT_UNKNOWN && options.target == LEAFLESS_UNIT_UNKNOWN && options.scale == 0.0);
    return options;
}

static leafless_mesh_file_info nothing(void) {
    leafless_mesh_file_info found = LEAFLESS_INIT(leafless_mesh_file_info);
    memset(&found, 0x5a, sizeof found);
    found.struct_size = sizeof found;
    return found;
}

/* Reads the sample and checks the result. */
static void reads(const sample *one, const leafless_mesh_options *options, uint32_t unit, double edge) {
    leafless_mesh_file_info found = nothing();
    leafless_mesh *mesh = NULL;
    OK(mesh_from_bytes((const uint8_t *)one->bytes, one->length, options, &found, &mesh));
    CHECK(found.format == one->format && found.unit == unit && found.skipped == 0);
    is_tetrahedron(mesh, edge);
    leafless_mesh_free(mesh);
    mesh = NULL;
    found = nothing();
    check_write(one->name, one->bytes, one->length);
    OK(mesh_open(one->name, strlen(one->name), options, &found, &mesh));
    CHECK(found.format == one->format && found.unit == unit && found.skipped == 0);
    is_tetrahedron(mesh, edge);
    leafless_mesh_free(mesh);
}

static void refused(leafless_status status, const void *bytes, uint64_t length, const leafless_mesh_options *options,
                    const char *part) {
    const leafless_mesh_file_info untouched_found = nothing();
    leafless_mesh *const untouched = (leafless_mesh *)(uintptr_t)0x5a5a5a58;
    leafless_mesh *mesh = untouched;
    leafless_mesh_file_info found = nothing();
    char message[512];
    FAILS(status, mesh_from_bytes((const uint8_t *)bytes, length, options, &found, &mesh));
    CHECK(mesh == untouched && memcmp(&found, &untouched_found, sizeof found) == 0);
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
    leafless_mesh_options options = defaults();
    size_t i, j, own = COUNT(UNITS);
    reads(one, &options, one->unit, 3.0);
    for (i = 0; i < COUNT(UNITS); i++) {
        options = defaults();
        options.unit = UNITS[i].unit;
        reads(one, &options, UNITS[i].unit, 3.0);
        for (j = 0; j < COUNT(UNITS); j++) {
            options.target = UNITS[j].unit;
            reads(one, &options, UNITS[j].unit, 3.0 * UNITS[i].micrometres / UNITS[j].micrometres);
        }
        own = UNITS[i].unit == one->unit ? i : own;
    }
    for (i = 0; i < COUNT(UNITS); i++) {
        options = defaults();
        options.target = UNITS[i].unit;
        if (own < COUNT(UNITS)) {
            reads(one, &options, UNITS[i].unit, 3.0 * UNITS[own].micrometres / UNITS[i].micrometres);
        } else {
            /* Without a unit in the file there is no conversion. */
            refused(LEAFLESS_E_MESH_FILE, one->bytes, one->length, &options, "unit");
        }
    }
    options = defaults();
    options.scale = 0.5;
    reads(one, &options, one->unit, 1.5);
    options.unit = LEAFLESS_UNIT_INCH;
    options.target = LEAFLESS_UNIT_MILLIMETRE;
    options.scale = 10.0;
    reads(one, &options, LEAFLESS_UNIT_MILLIMETRE, 762.0);
}

static void formats(const sample *one) {
    leafless_mesh_options options = defaults();
    reads(one, NULL, one->unit, 3.0);
    options.format = one->format;
    reads(one, &options, one->unit, 3.0);
}

/* A corner of one facet lies a little beside that of the others. */
static void hair_cracks_are_closed(void) {
    static const char CRACKED[] =
        "solid tetrahedron\n"
        "facet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 3.0000001 0\nvertex 3 0 0\nendloop\nendfacet\n"
        "facet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 3 0 0\nvertex 0 0 3\nendloop\nendfacet\n"
        "facet normal -1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 3\nvertex 0 3 0\nendloop\nendfacet\n"
        "facet normal 1 1 1\nouter loop\nvertex 3 0 0\nvertex 0 3 0\nvertex 0 0 3\nendloop\nendfacet\n"
        "endsolid tetrahedron\n";
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    leafless_mesh *mesh = NULL;
    OK(mesh_from_bytes((const uint8_t *)CRACKED, sizeof CRACKED - 1, NULL, NULL, &mesh));
    OK(leafless_mesh_check_closed(mesh, LEAFLESS_FILL_NON_ZERO));
    OK(leafless_mesh_inspect(mesh, &report));
    CHECK(report.sewn == 1 && report.displacement_model > 0.0 && report.displacement_model < 1e-6);
    leafless_mesh_free(mesh);
}

/* No end of the file, and no byte of it replaced, does more than fail. */
static void damaged(const sample *one) {
    const size_t length = one->length;
    leafless_mesh_options options = defaults();
    size_t i, end;
    options.format = one->format;
    for (end = 0; end < length; end++) {
        /* On the heap, so that memory checkers notice reads beyond the end. */
        uint8_t *bytes = (uint8_t *)malloc(end + 1);
        leafless_mesh *mesh = NULL;
        CHECK(bytes != NULL);
        memcpy(bytes, one->bytes, end);
        (void)mesh_from_bytes(bytes, end, &options, NULL, &mesh);
        leafless_mesh_free(mesh);
        free(bytes);
    }
    for (i = 0; i < length; i++) {
        static const uint8_t OTHERS[] = {0, 1, ' ', '\n', '-', '.', '0', '9', 'e', '/', 0x7f, 0x80, 0xff};
        uint8_t *bytes = (uint8_t *)malloc(length);
        CHECK(bytes != NULL);
        memcpy(bytes, one->bytes, length);
        for (end = 0; end < COUNT(OTHERS); end++) {
            leafless_mesh *mesh = NULL;
            bytes[i] = OTHERS[end];
            (void)mesh_from_bytes(bytes, length, &options, NULL, &mesh);
            leafless_mesh_free(mesh);
            mesh = NULL;
            (void)mesh_from_bytes(bytes, length, NULL, NULL, &mesh);
            leafless_mesh_free(mesh);
        }
        free(bytes);
    }
}

/* What a file departs from its format in: its own text for each, and none for other meshes. */
static void warnings(void) {
    static const char STRANGE[] =
        "ply\nformat ascii 1.0\nby hand\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0 255\n3 0 0 255\n0 3 0 255\n0 0 3 255\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    static const char *const TEXTS[] = {"line 3 of the header has no keyword", "line 11 (like 3 more) has more values"};
    static const double OFFSET[3] = {1, 2, 3};
    leafless_mesh *mesh = NULL, *moved = NULL;
    const char *text = NULL;
    size_t length = 0;
    uint64_t count = 77, i;
    OK(mesh_from_bytes((const uint8_t *)STRANGE, sizeof STRANGE - 1, NULL, NULL, &mesh));
    is_tetrahedron(mesh, 3.0);
    OK(leafless_mesh_peek_warning_at(mesh, 99, &count, NULL, NULL));
    CHECK(count == COUNT(TEXTS));
    for (i = 0; i < count; i++) {
        uint64_t all = 0;
        OK(leafless_mesh_peek_warning_at(mesh, i, &all, &text, &length));
        CHECK(all == count && length > strlen(TEXTS[i]) && memcmp(text, TEXTS[i], strlen(TEXTS[i])) == 0);
    }
    FAILS(LEAFLESS_E_ARGUMENT, leafless_mesh_peek_warning_at(mesh, count, &count, &text, &length));
    FAILS(LEAFLESS_E_NULL, leafless_mesh_peek_warning_at(mesh, 0, &count, &text, NULL));
    FAILS(LEAFLESS_E_NULL, leafless_mesh_peek_warning_at(mesh, 0, NULL, NULL, NULL));
    OK(leafless_mesh_translated(mesh, OFFSET, &moved));
    OK(leafless_mesh_peek_warning_at(moved, 0, &count, NULL, NULL));
    CHECK(count == 0);
    leafless_mesh_free(moved);
    leafless_mesh_free(mesh);
    mesh = NULL;
    OK(mesh_from_bytes((const uint8_t *)PLY, sizeof PLY - 1, NULL, NULL, &mesh));
    count = 77;
    OK(leafless_mesh_peek_warning_at(mesh, 0, &count, NULL, NULL));
    CHECK(count == 0);
    leafless_mesh_free(mesh);
}

static void bad_options(void) {
    static const uint32_t not_known[] = {7, 8, 255, UINT32_MAX};
    static const double not_a_scale[] = {-1.0, NAN, INFINITY, -INFINITY, 0x1p-257, 0x1.8p256};
    const sample *one = &samples[0];
    leafless_mesh_options options;
    size_t i;
    for (i = 0; i < COUNT(not_known); i++) {
        options = defaults();
        options.format = not_known[i] - 1;
        refused(LEAFLESS_E_ARGUMENT, one->bytes, one->length, &options, "options.format");
        options = defaults();
        options.unit = not_known[i];
        refused(LEAFLESS_E_ARGUMENT, one->bytes, one->length, &options, "options.unit");
        options = defaults();
        options.target = not_known[i];
        refused(LEAFLESS_E_ARGUMENT, one->bytes, one->length, &options, "options.target");
    }
    for (i = 0; i < COUNT(not_a_scale); i++) {
        options = defaults();
        options.scale = not_a_scale[i];
        refused(LEAFLESS_E_ARGUMENT, one->bytes, one->length, &options, "scale");
    }
    options = defaults();
    options.struct_size = 3;
    refused(LEAFLESS_E_ARGUMENT, one->bytes, one->length, &options, "struct_size");
    /* A program older than `scale`: the bytes at its place are not read. */
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
    OK(mesh_from_bytes(bytes, length, NULL, NULL, &mesh));
    leafless_mesh_free(mesh);
    options.format = LEAFLESS_MESH_FORMAT_STL;
    refused(LEAFLESS_E_MESH_FILE, bytes, length - 1, &options, "3 facets");
    refused(LEAFLESS_E_MESH_FILE, "solid\nfacet normal 0 0 0\nouter hoop\n", 36, NULL, "line 3");
    /* A count of 4294967295 facets is refused. */
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
    FAILS(LEAFLESS_E_IO, mesh_open("no/such.stl", 11, NULL, NULL, &mesh));
    FAILS(LEAFLESS_E_IO, mesh_open(".", 1, NULL, NULL, &mesh));
    FAILS(LEAFLESS_E_UTF8, mesh_open("\xff.stl", 5, NULL, NULL, &mesh));
    FAILS(LEAFLESS_E_ARGUMENT, mesh_open("", 0, NULL, NULL, &mesh));
}

int main(void) {
    size_t i;
    samples[4].length = binary_ply(false, memory[0]);
    samples[5].length = binary_ply(true, memory[1]);
    samples[6].length = threemf(memory[2]);
    CHECK(samples[6].length < sizeof memory[2]);
    for (i = 0; i < COUNT(samples); i++) {
        formats(&samples[i]);
        units(&samples[i]);
        damaged(&samples[i]);
    }
    hair_cracks_are_closed();
    warnings();
    bad_options();
    bad_files();
    return 0;
}
