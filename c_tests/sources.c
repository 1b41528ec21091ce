/* Sources and sinks of every function that takes one: files, bytes in memory and functions of the host, with every
 * access. refused.c has the sources and sinks that all functions refuse. */
#include "check.h"

static void *const UNTOUCHED = (void *)(uintptr_t)0x5a5a5a58;

static leafless_octree *octree;
static leafless_tridexel *model;
static leafless_mesh *mesh;
static leafless_volume *volume;

/* The readers' results. A reader that refuses writes nothing there. */
static void *result;
static leafless_file_info probe;

#define READS(kind, call)                                                   \
    static leafless_status reads_##kind(const leafless_source *source) {    \
        leafless_##kind **const made = (leafless_##kind **)&result;         \
        return call;                                                        \
    }                                                                       \
    static void free_##kind(void *object) {                                 \
        leafless_##kind##_free((leafless_##kind *)object);                  \
    }

READS(octree, leafless_octree_read(source, made))
READS(tridexel, leafless_tridexel_read(source, made))
READS(mesh, leafless_mesh_read(source, NULL, NULL, made))
READS(volume, leafless_volume_read(source, NULL, made))
READS(scene, leafless_scene_read(source, NULL, made))

static leafless_status reads_probe(const leafless_source *source) {
    return leafless_file_describe(source, &probe, NULL, 0);
}

static leafless_status reads_nothing(const leafless_source *source) {
    return leafless_file_verify(source);
}

/* `is_mapped`: the source can be used in place. `in_place`: bytes are never copied. `empty`: the result for no bytes. */
typedef struct reader {
    const char *name;
    leafless_status (*read)(const leafless_source *source);
    void (*give_back)(void *object);
    const char *path;
    leafless_status empty;
    bool is_mapped, in_place;
    uint8_t *bytes;
    uint64_t length;
} reader;

static reader READERS[] = {
    {"leafless_octree_read", reads_octree, free_octree, "source.lfl", LEAFLESS_E_FORMAT, true, false, NULL, 0},
    {"leafless_tridexel_read", reads_tridexel, free_tridexel, "rays.lfl", LEAFLESS_E_FORMAT, true, false, NULL, 0},
    {"leafless_mesh_read", reads_mesh, free_mesh, "source.ply", LEAFLESS_E_MESH_FILE, false, false, NULL, 0},
    {"leafless_volume_read", reads_volume, free_volume, "source.nrrd", LEAFLESS_E_VOLUME_FILE, false, false, NULL, 0},
    {"leafless_scene_read", reads_scene, free_scene, "source.csg", LEAFLESS_OK, false, false, NULL, 0},
    {"leafless_file_describe", reads_probe, NULL, "source.lfl", LEAFLESS_E_FORMAT, true, false, NULL, 0},
    {"leafless_file_verify", reads_nothing, NULL, "source.lfl", LEAFLESS_E_FORMAT, true, true, NULL, 0},
    {"leafless_file_verify", reads_nothing, NULL, "rays.lfl", LEAFLESS_E_FORMAT, true, true, NULL, 0},
};

static leafless_status writes_octree(const leafless_sink *sink) {
    return leafless_octree_write(octree, sink);
}

static leafless_status writes_tridexel(const leafless_sink *sink) {
    return leafless_tridexel_write(model, sink);
}

static leafless_status writes_mesh(const leafless_sink *sink) {
    leafless_mesh_write_options options = LEAFLESS_INIT(leafless_mesh_write_options);
    options.format = LEAFLESS_MESH_FORMAT_PLY;
    return leafless_mesh_write(mesh, &options, sink);
}

/* A tetrahedron. */
static leafless_polyhedron_arrays tetrahedron(void) {
    static const double CORNERS[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const uint32_t FACES[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3}, LOOPS[5] = {0, 3, 6, 9, 12};
    leafless_polyhedron_arrays arrays = LEAFLESS_INIT(leafless_polyhedron_arrays);
    arrays.vertices = CORNERS;
    arrays.vertex_count = 4;
    arrays.corners = FACES;
    arrays.corner_count = 12;
    arrays.loops = LOOPS;
    arrays.loop_count = 4;
    return arrays;
}

static leafless_status writes_polygons(const leafless_sink *sink) {
    const leafless_polyhedron_arrays arrays = tetrahedron();
    leafless_mesh_write_options options = LEAFLESS_INIT(leafless_mesh_write_options);
    options.format = LEAFLESS_MESH_FORMAT_OBJ;
    return leafless_mesh_write_polygons(&arrays, &options, sink);
}

static leafless_status writes_volume(const leafless_sink *sink) {
    return leafless_volume_write(volume, LEAFLESS_VOLUME_FORMAT_NRRD, sink);
}

static leafless_status writes_picture(const leafless_sink *sink) {
    static const uint8_t COLOURS[4 * 8 * 8] = {0};
    return leafless_picture_write(COLOURS, 8, 8, sink);
}

/* What is read again comes first, in the order of READERS. */
static const struct {
    const char *name;
    leafless_status (*write)(const leafless_sink *sink);
} WRITERS[] = {
    {"leafless_octree_write", writes_octree},
    {"leafless_tridexel_write", writes_tridexel},
    {"leafless_mesh_write", writes_mesh},
    {"leafless_volume_write", writes_volume},
    {"leafless_picture_write", writes_picture},
    {"leafless_mesh_write_polygons", writes_polygons},
};

/* What a function was given, one piece after the other. */
typedef struct pieces {
    uint8_t *bytes;
    uint64_t length, capacity, calls, fails_at, largest;
} pieces;

static int32_t take(void *ctx, const uint8_t *bytes, uint64_t count) {
    pieces *to = (pieces *)ctx;
    if (to == NULL) {
        return 0;
    }
    if (to->calls++ == to->fails_at || count > to->capacity - to->length) {
        return -77;
    }
    memcpy(to->bytes + to->length, bytes, (size_t)count);
    to->length += count;
    to->largest = count > to->largest ? count : to->largest;
    return 0;
}

/* A file by each of the three ways, whose bytes are the same. */
static uint8_t *written(leafless_status (*write)(const leafless_sink *sink), const char *path, uint64_t *length) {
    leafless_sink sink = leafless_to_buffer(NULL, 0, length);
    uint8_t *bytes, *file;
    uint64_t again = 0, call;
    size_t file_length;
    pieces to = {NULL, 0, 0, 0, UINT64_MAX, 0};
    char message[512];
    OK(write(&sink));
    CHECK(*length > 0);
    bytes = (uint8_t *)malloc((size_t)*length);
    to.bytes = (uint8_t *)malloc((size_t)*length);
    to.capacity = *length;
    CHECK(bytes != NULL && to.bytes != NULL);
    sink = leafless_to_buffer(bytes, *length - 1, &again);
    FAILS(LEAFLESS_E_BUFFER, write(&sink));
    CHECK(again == 0);
    sink = leafless_to_buffer(bytes, *length, &again);
    OK(write(&sink));
    CHECK(again == *length);
    sink = leafless_to_function(take, &to);
    OK(write(&sink));
    CHECK(to.length == *length && memcmp(to.bytes, bytes, (size_t)to.length) == 0);
    for (call = to.calls; call-- > 0;) {
        to.length = to.calls = 0;
        to.fails_at = call;
        FAILS(LEAFLESS_E_CALLBACK, write(&sink));
        CHECK(to.calls == call + 1);
        (void)leafless_last_error(message, sizeof message);
        CHECK(strstr(message, "-77") != NULL);
    }
    sink = leafless_to_file(path);
    OK(write(&sink));
    file = check_read(path, &file_length);
    CHECK(file_length == *length && memcmp(file, bytes, file_length) == 0);
    free(file);
    free(to.bytes);
    return bytes;
}

/* The call fails, with these words in the message, and nothing comes of it. */
static void refuses(leafless_status status, const reader *one, const char *words, const leafless_source *source) {
    leafless_file_info before;
    char message[512];
    memset(&probe, 0x5a, sizeof probe);
    probe.struct_size = sizeof probe;
    memcpy(&before, &probe, sizeof probe);
    result = UNTOUCHED;
    FAILS(status, one->read(source));
    (void)leafless_last_error(message, sizeof message);
    if (strstr(message, words) == NULL) {
        fprintf(stderr, "%s says \"%s\" and not \"%s\"\n", one->name, message, words);
        exit(1);
    }
    CHECK(result == UNTOUCHED && memcmp(&probe, &before, sizeof probe) == 0);
}

static void takes(const reader *one, const leafless_source *source) {
    result = NULL;
    OK(one->read(source));
    CHECK((result != NULL) == (one->give_back != NULL));
    if (one->give_back != NULL) {
        one->give_back(result);
    }
}

static void sources(const reader *one) {
    static const char *const NAMES[] = {"no/such/file", "./."};
    const leafless_source none = LEAFLESS_INIT(leafless_source);
    const leafless_source file = leafless_from_file(one->path, LEAFLESS_ACCESS_COPY);
    const leafless_source bytes = leafless_from_bytes(one->bytes, one->length, LEAFLESS_ACCESS_COPY);
    leafless_source bad;
    uint8_t *beside = (uint8_t *)malloc((size_t)one->length + 1);
    uint32_t access;
    uint64_t large[sizeof(leafless_source) / 8 + 1];
    size_t i;
    CHECK(beside != NULL && sizeof(leafless_source) % 8 == 0);
    memcpy(beside + 1, one->bytes, (size_t)one->length);

    /* No bytes at all: the reader returns its result for them. */
    bad = leafless_from_bytes(one->bytes, 0, LEAFLESS_ACCESS_COPY);
    if (one->empty == LEAFLESS_OK) {
        takes(one, &none);
        takes(one, &bad);
    } else {
        refuses(one->empty, one, "", &none);
        refuses(one->empty, one, "", &bad);
        for (access = LEAFLESS_ACCESS_MAP; one->is_mapped && access <= LEAFLESS_ACCESS_MAP_VERIFIED; access++) {
            bad = leafless_from_bytes(NULL, 0, access);
            refuses(one->empty, one, "", &bad);
        }
    }

    /* Access. */
    for (i = 0; i < 2; i++) {
        bad = i == 0 ? file : bytes;
        for (access = 0; access <= LEAFLESS_ACCESS_MAP_VERIFIED; access++) {
            bad.access = access;
            if (one->is_mapped || access == LEAFLESS_ACCESS_COPY) {
                takes(one, &bad);
            } else {
                refuses(LEAFLESS_E_ARGUMENT, one, "source.access: must be LEAFLESS_ACCESS_COPY", &bad);
            }
        }
    }

    /* No file, and a folder. */
    for (i = 0; i < COUNT(NAMES); i++) {
        for (access = 0; access <= (one->is_mapped ? 2u : 0u); access++) {
            /* A folder can be opened, and read or mapped it cannot be. */
            const bool is_copied = access == LEAFLESS_ACCESS_COPY || one->read == reads_probe;
            bad = leafless_from_file(NAMES[i], access);
            refuses(i == 0 || is_copied ? LEAFLESS_E_IO : LEAFLESS_E_ARGUMENT, one, NAMES[i], &bad);
        }
    }

    /* Copies may be made from any address; bytes used in place must be aligned. */
    for (access = 0; access <= (one->is_mapped ? 2u : 0u); access++) {
        const bool in_place = one->in_place || access != LEAFLESS_ACCESS_COPY;
        bad = leafless_from_bytes(beside + 1, one->length, access);
        if (in_place && one->read != reads_probe) {
            refuses(LEAFLESS_E_ARGUMENT, one, "", &bad);
        } else {
            takes(one, &bad);
        }
    }

    /* Structs of other versions. */
    bad = file;
    bad.struct_size = offsetof(leafless_source, bytes);
    takes(one, &bad);
    memset(large, 0, sizeof large);
    memcpy(large, &file, sizeof file);
    ((leafless_source *)large)->struct_size = sizeof large;
    takes(one, (const leafless_source *)large);
    large[COUNT(large) - 1] = 1;
    refuses(LEAFLESS_E_ARGUMENT, one, "source: has fields", (const leafless_source *)large);
    free(beside);
}

static void sinks(leafless_status (*write)(const leafless_sink *sink)) {
    uint64_t length = 77;
    uint64_t large[sizeof(leafless_sink) / 8 + 1];
    const leafless_sink file = leafless_to_file("large.sink");
    const leafless_sink function = leafless_to_function(take, NULL);
    const leafless_sink buffer = leafless_to_buffer(NULL, 0, &length);
    leafless_sink older = leafless_to_file("older.sink");
    CHECK(sizeof(leafless_sink) % 8 == 0);

    /* Structs of other versions. */
    memset(large, 0, sizeof large);
    memcpy(large, &file, sizeof file);
    ((leafless_sink *)large)->struct_size = sizeof large;
    large[COUNT(large) - 1] = 1;
    FAILS(LEAFLESS_E_ARGUMENT, write((const leafless_sink *)large));
    CHECK(fopen("large.sink", "rb") == NULL);
    large[COUNT(large) - 1] = 0;
    OK(write((const leafless_sink *)large));
    CHECK(remove("large.sink") == 0);
    older.struct_size = offsetof(leafless_sink, write);
    OK(write(&older));
    CHECK(remove("older.sink") == 0);
    /* A function without a context, and the length alone. */
    OK(write(&function));
    OK(write(&buffer));
    CHECK(length > 0 && length != 77);
}

/* Octrees and tri-dexel models are read from their own files only. */
static void kinds(void) {
    const leafless_source solid = leafless_from_bytes(READERS[0].bytes, READERS[0].length, LEAFLESS_ACCESS_COPY);
    const leafless_source rays = leafless_from_bytes(READERS[1].bytes, READERS[1].length, LEAFLESS_ACCESS_COPY);
    refuses(LEAFLESS_E_ARGUMENT, &READERS[0], "", &rays);
    refuses(LEAFLESS_E_ARGUMENT, &READERS[1], "", &solid);
}

/* The second source of a volume: the file of the samples, wherever it and the header are. */
static void data_of_volumes(void) {
    static const char HEADER[] = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: x.raw\n";
    const leafless_source headers[2] = {leafless_from_bytes(HEADER, sizeof HEADER - 1, LEAFLESS_ACCESS_COPY),
                                        leafless_from_file("apart.nhdr", LEAFLESS_ACCESS_COPY)};
    const leafless_source samples[2] = {leafless_from_bytes("abcdefgh", 8, LEAFLESS_ACCESS_COPY),
                                        leafless_from_file("apart.raw", LEAFLESS_ACCESS_COPY)};
    leafless_volume *read = NULL;
    leafless_source bad;
    int header, data;
    check_write("apart.nhdr", HEADER, sizeof HEADER - 1);
    check_write("apart.raw", "abcdefgh", 8);
    for (header = 0; header < 2; header++) {
        for (data = 0; data < 2; data++) {
            const void *found = NULL;
            uint64_t length = 0;
            OK(leafless_volume_read(&headers[header], &samples[data], &read));
            OK(leafless_volume_peek_samples(read, &found, &length));
            CHECK(length == 8 && memcmp(found, "abcdefgh", 8) == 0);
            leafless_volume_free(read);
            read = NULL;
        }
        bad = leafless_from_bytes("abcdefg", 7, LEAFLESS_ACCESS_COPY);
        FAILS(LEAFLESS_E_VOLUME_FILE, leafless_volume_read(&headers[header], &bad, &read));
        bad = leafless_from_bytes(NULL, 0, LEAFLESS_ACCESS_COPY);
        FAILS(LEAFLESS_E_VOLUME_FILE, leafless_volume_read(&headers[header], &bad, &read));
        /* Bytes are looked for nowhere, and beside the header there are none. */
        FAILS(header == 0 ? LEAFLESS_E_VOLUME_FILE : LEAFLESS_E_IO,
              leafless_volume_read(&headers[header], NULL, &read));
        CHECK(read == NULL);
    }
}

/* A file that is in memory as a whole is handed out in pieces too. */
static void large_files(void) {
    enum { SIDE = 150 };
    leafless_volume_layout layout = LEAFLESS_INIT(leafless_volume_layout);
    uint8_t *samples = (uint8_t *)malloc(SIDE * SIDE * SIDE);
    pieces to = {NULL, 0, SIDE * SIDE * SIDE, 0, UINT64_MAX, 0};
    const leafless_sink sink = leafless_to_function(take, &to);
    leafless_volume *large = NULL;
    uint32_t i;
    to.bytes = (uint8_t *)malloc(SIDE * SIDE * SIDE);
    CHECK(samples != NULL && to.bytes != NULL);
    for (i = 0; i < SIDE * SIDE * SIDE; i++) {
        samples[i] = (uint8_t)(i * 2654435761u >> 24);
    }
    layout.sample_type = LEAFLESS_SAMPLE_TYPE_U8;
    layout.extents[0] = layout.extents[1] = layout.extents[2] = SIDE;
    OK(volume_of_array(&layout, samples, SIDE * SIDE * SIDE, &large));
    OK(leafless_volume_write(large, LEAFLESS_VOLUME_FORMAT_RAW, &sink));
    CHECK(to.length == to.capacity && memcmp(to.bytes, samples, (size_t)to.length) == 0);
    CHECK(to.calls == 4 && to.largest == 1 << 20);
    leafless_volume_free(large);
    free(samples);
    free(to.bytes);
}

int main(void) {
    const leafless_frame frame = check_frame(4);
    static const uint8_t SAMPLES[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    leafless_volume_layout layout = LEAFLESS_INIT(leafless_volume_layout);
    leafless_solid *solid = check_ball_solid();
    uint64_t picture_length = 0;
    size_t i, length;
    octree = check_ball(4, LEAFLESS_RULE_CERTIFIED);
    mesh = check_cube();
    OK(leafless_tridexel_build(solid, &frame, LEAFLESS_RULE_SAMPLED, NULL, NULL, &model));
    layout.sample_type = LEAFLESS_SAMPLE_TYPE_U8;
    layout.extents[0] = layout.extents[1] = layout.extents[2] = 2;
    OK(volume_of_array(&layout, SAMPLES, sizeof SAMPLES, &volume));
    for (i = 1; i < 3; i++) {
        /* Bytes of a file can only be copied; bytes in memory can be used in place. */
        const leafless_source file = leafless_from_file("source.raw", (leafless_access)i);
        const leafless_source bytes = leafless_from_bytes(SAMPLES, sizeof SAMPLES, (leafless_access)i);
        leafless_volume *viewed = NULL;
        const void *samples = NULL;
        uint64_t count = 0;
        FAILS(LEAFLESS_E_ARGUMENT, leafless_volume_new(&layout, &file, &viewed));
        OK(leafless_volume_new(&layout, &bytes, &viewed));
        OK(leafless_volume_peek_samples(viewed, &samples, &count));
        CHECK(samples == (const void *)SAMPLES && count == sizeof SAMPLES);
        leafless_volume_free(viewed);
    }
    probe.struct_size = sizeof probe;

    for (i = 0; i + 2 < COUNT(WRITERS); i++) {
        READERS[i].bytes = written(WRITERS[i].write, READERS[i].path, &READERS[i].length);
    }
    free(written(writes_picture, "source.png", &picture_length));
    check_write("source.csg", "cube(2);", 8);
    for (; i < COUNT(READERS); i++) {
        READERS[i].bytes = check_read(READERS[i].path, &length);
        READERS[i].length = length;
    }
    for (i = 0; i < COUNT(READERS); i++) {
        sources(&READERS[i]);
    }
    for (i = 0; i < COUNT(WRITERS); i++) {
        sinks(WRITERS[i].write);
    }
    kinds();
    data_of_volumes();
    large_files();

    for (i = 0; i < COUNT(READERS); i++) {
        free(READERS[i].bytes);
    }
    leafless_volume_free(volume);
    leafless_mesh_free(mesh);
    leafless_tridexel_free(model);
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    return 0;
}
