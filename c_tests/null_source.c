/* As null.c, for sources and sinks: every field of them, of every function that takes one. */
#include "null.h"

static leafless_octree *octree;
static leafless_tridexel *model;
static leafless_mesh *mesh;
static leafless_volume *volume;

/* The readers' results. A reader that refuses writes nothing there. */
static void *result;
static leafless_file_info probe;

static leafless_status reads_octree(const leafless_source *source) {
    return leafless_octree_read(source, (leafless_octree **)&result);
}

static leafless_status reads_tridexel(const leafless_source *source) {
    return leafless_tridexel_read(source, (leafless_tridexel **)&result);
}

static leafless_status reads_mesh(const leafless_source *source) {
    return leafless_mesh_read(source, NULL, NULL, (leafless_mesh **)&result);
}

static leafless_status reads_volume(const leafless_source *source) {
    return leafless_volume_read(source, NULL, (leafless_volume **)&result);
}

static leafless_status reads_scene(const leafless_source *source) {
    return leafless_scene_read(source, NULL, (leafless_scene **)&result);
}

static leafless_status reads_probe(const leafless_source *source) {
    return leafless_file_describe(source, &probe, NULL, 0);
}

static leafless_status reads_nothing(const leafless_source *source) {
    return leafless_file_verify(source);
}

static void free_octree(void *object) {
    leafless_octree_free((leafless_octree *)object);
}

static void free_tridexel(void *object) {
    leafless_tridexel_free((leafless_tridexel *)object);
}

static void free_mesh(void *object) {
    leafless_mesh_free((leafless_mesh *)object);
}

static void free_volume(void *object) {
    leafless_volume_free((leafless_volume *)object);
}

static void free_scene(void *object) {
    leafless_scene_free((leafless_scene *)object);
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

/* The call is refused, with these words in the message, and nothing comes of it. */
static void refuses(leafless_status status, const reader *one, const char *words, const leafless_source *source) {
    const leafless_file_info before = probe;
    result = UNTOUCHED;
    refused(status, one->name, words, one->read(source));
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

    refuses(LEAFLESS_E_NULL, one, "source", NULL);
    refuses(LEAFLESS_E_ARGUMENT, one, "source: is misaligned", (const leafless_source *)WRONG(&file));

    /* Both, in every way. */
    bad = file;
    bad.bytes = one->bytes;
    bad.length = one->length;
    refuses(LEAFLESS_E_ARGUMENT, one, "source: has both", &bad);
    bad.bytes = NULL;
    refuses(LEAFLESS_E_ARGUMENT, one, "source: has both", &bad);
    bad = file;
    bad.bytes = one->bytes;
    refuses(LEAFLESS_E_ARGUMENT, one, "source: has both", &bad);
    bad = bytes;
    bad.path_length = 1;
    refuses(LEAFLESS_E_ARGUMENT, one, "source: has both", &bad);

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
        bad.access = 3;
        refuses(LEAFLESS_E_ARGUMENT, one, "source.access: is no leafless_access", &bad);
        bad.access = UINT32_MAX;
        refuses(LEAFLESS_E_ARGUMENT, one, "source.access: is no leafless_access", &bad);
    }

    /* Paths: none, with a NUL, no UTF-8, of nothing, of no file. */
    bad = leafless_from_file(NULL, LEAFLESS_ACCESS_COPY);
    refuses(LEAFLESS_E_NULL, one, "source.path", &bad);
    bad = leafless_from_file("", LEAFLESS_ACCESS_COPY);
    refuses(LEAFLESS_E_ARGUMENT, one, "source.path: is empty", &bad);
    bad = source_path("a\0b", 3, LEAFLESS_ACCESS_COPY);
    refuses(LEAFLESS_E_UTF8, one, "source.path: holds a NUL", &bad);
    bad = source_path("a\xff", 2, LEAFLESS_ACCESS_COPY);
    refuses(LEAFLESS_E_UTF8, one, "source.path: is not UTF-8", &bad);
    for (i = 0; i < COUNT(NAMES); i++) {
        for (access = 0; access <= (one->is_mapped ? 2u : 0u); access++) {
            /* A folder can be opened, and read or mapped it cannot be. */
            const bool is_copied = access == LEAFLESS_ACCESS_COPY || one->read == reads_probe;
            bad = leafless_from_file(NAMES[i], access);
            refuses(i == 0 || is_copied ? LEAFLESS_E_IO : LEAFLESS_E_ARGUMENT, one, NAMES[i], &bad);
        }
    }

    /* Bytes. */
    bad = leafless_from_bytes(NULL, 9, LEAFLESS_ACCESS_COPY);
    refuses(LEAFLESS_E_NULL, one, "source.bytes", &bad);
    bad = leafless_from_bytes(one->bytes, UINT64_MAX, LEAFLESS_ACCESS_COPY);
    refuses(LEAFLESS_E_ARGUMENT, one, "source.bytes", &bad);
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

    /* Structs of other versions, and uninitialised ones. */
    bad = file;
    for (i = 0; i < 4; i++) {
        static const uint32_t SIZES[] = {0, 3, 4, 5000};
        bad.struct_size = SIZES[i];
        refuses(LEAFLESS_E_ARGUMENT, one, "source: has no sensible struct_size", &bad);
    }
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

static void sinks(const char *name, leafless_status (*write)(const leafless_sink *sink)) {
    uint8_t room_for_bytes[8];
    uint64_t length = 77;
    uint64_t large[sizeof(leafless_sink) / 8 + 1];
    const leafless_sink file = leafless_to_file("null.sink");
    const leafless_sink function = leafless_to_function(take, NULL);
    const leafless_sink buffer = leafless_to_buffer(NULL, 0, &length);
    leafless_sink bad;
    int given;
    size_t i;
    CHECK(sizeof(leafless_sink) % 8 == 0);

    refused(LEAFLESS_E_NULL, name, "sink", write(NULL));
    refused(LEAFLESS_E_ARGUMENT, name, "sink: is misaligned", write((const leafless_sink *)WRONG(&file)));

    /* None, two, and three of the three. */
    for (given = 0; given < 8; given++) {
        if (given != 1 && given != 2 && given != 4) {
            bad = LEAFLESS_INIT(leafless_sink);
            bad.path = (given & 1) != 0 ? file.path : NULL;
            bad.path_length = (given & 1) != 0 ? file.path_length : 0;
            bad.write = (given & 2) != 0 ? take : NULL;
            bad.length = (given & 4) != 0 ? &length : NULL;
            refused(LEAFLESS_E_ARGUMENT, name, "sink: must have just one", write(&bad));
        }
    }
    bad = file;
    bad.capacity = 8;
    refused(LEAFLESS_E_ARGUMENT, name, "sink: must have just one", write(&bad));
    bad = file;
    bad.bytes = room_for_bytes;
    refused(LEAFLESS_E_ARGUMENT, name, "sink: must have just one", write(&bad));
    bad = function;
    bad.path_length = 1;
    refused(LEAFLESS_E_ARGUMENT, name, "sink: must have just one", write(&bad));
    bad = file;
    bad.write_ctx = &length;
    refused(LEAFLESS_E_ARGUMENT, name, "sink: must have just one", write(&bad));
    bad = leafless_to_function(NULL, &length);
    refused(LEAFLESS_E_NULL, name, "sink.write", write(&bad));
    bad = leafless_to_function(NULL, NULL);
    refused(LEAFLESS_E_ARGUMENT, name, "sink: must have just one", write(&bad));
    bad = file;
    bad.reserved = 1;
    refused(LEAFLESS_E_ARGUMENT, name, "sink.reserved", write(&bad));

    /* Paths. */
    bad = leafless_to_file(NULL);
    refused(LEAFLESS_E_NULL, name, "sink.path", write(&bad));
    bad = leafless_to_file("");
    refused(LEAFLESS_E_ARGUMENT, name, "sink.path: is empty", write(&bad));
    bad = sink_path("a\0b", 3);
    refused(LEAFLESS_E_UTF8, name, "sink.path: holds a NUL", write(&bad));
    bad = sink_path("a\xff", 2);
    refused(LEAFLESS_E_UTF8, name, "sink.path: is not UTF-8", write(&bad));
    bad = leafless_to_file("no/such/file");
    refused(LEAFLESS_E_IO, name, "no/such/file", write(&bad));

    /* Buffers. */
    bad = leafless_to_buffer(room_for_bytes, sizeof room_for_bytes, NULL);
    refused(LEAFLESS_E_NULL, name, "sink.length", write(&bad));
    bad = leafless_to_buffer(NULL, sizeof room_for_bytes, NULL);
    refused(LEAFLESS_E_NULL, name, "sink.bytes", write(&bad));
    bad = leafless_to_buffer(NULL, sizeof room_for_bytes, &length);
    refused(LEAFLESS_E_NULL, name, "sink.bytes", write(&bad));
    bad = leafless_to_buffer(room_for_bytes, UINT64_MAX, &length);
    refused(LEAFLESS_E_ARGUMENT, name, "sink.bytes", write(&bad));
    bad = leafless_to_buffer(NULL, 0, (uint64_t *)WRONG(&length));
    refused(LEAFLESS_E_ARGUMENT, name, "sink.length: is misaligned", write(&bad));
    bad = leafless_to_buffer(room_for_bytes, sizeof room_for_bytes, &length);
    refused(LEAFLESS_E_BUFFER, name, "sink.bytes", write(&bad));
    CHECK(length == 77);

    /* Structs of other versions, and uninitialised ones. */
    bad = file;
    for (i = 0; i < 4; i++) {
        static const uint32_t SIZES[] = {0, 3, 4, 5000};
        bad.struct_size = SIZES[i];
        refused(LEAFLESS_E_ARGUMENT, name, "sink: has no sensible struct_size", write(&bad));
    }
    memset(large, 0, sizeof large);
    memcpy(large, &file, sizeof file);
    ((leafless_sink *)large)->struct_size = sizeof large;
    large[COUNT(large) - 1] = 1;
    refused(LEAFLESS_E_ARGUMENT, name, "sink: has fields", write((const leafless_sink *)large));
    CHECK(fopen("null.sink", "rb") == NULL && fopen("a", "rb") == NULL);
    large[COUNT(large) - 1] = 0;
    OK(write((const leafless_sink *)large));
    CHECK(remove("null.sink") == 0);
    bad = file;
    bad.struct_size = offsetof(leafless_sink, write);
    OK(write(&bad));
    CHECK(remove("null.sink") == 0);
    /* A function without a context, and the length alone. */
    OK(write(&function));
    OK(write(&buffer));
    CHECK(length > 0 && length != 77);
}

/* Each parameter of each function by itself. */
static void parameters(void) {
    void *out = fresh();
    void *never = UNTOUCHED;
    leafless_octree **octree_result = (leafless_octree **)&never;
    leafless_tridexel **tridexel_result = (leafless_tridexel **)&never;
    leafless_mesh **mesh_result = (leafless_mesh **)&never;
    leafless_volume **volume_result = (leafless_volume **)&never;
    leafless_scene **scene_result = (leafless_scene **)&never;
    const leafless_source solid = leafless_from_bytes(READERS[0].bytes, READERS[0].length, LEAFLESS_ACCESS_COPY);
    const leafless_source rays = leafless_from_bytes(READERS[1].bytes, READERS[1].length, LEAFLESS_ACCESS_COPY);
    const leafless_source ply = leafless_from_file("source.ply", LEAFLESS_ACCESS_COPY);
    const leafless_source nrrd = leafless_from_file("source.nrrd", LEAFLESS_ACCESS_COPY);
    const leafless_source csg = leafless_from_file("source.csg", LEAFLESS_ACCESS_COPY);
    uint64_t length = 0;
    const leafless_sink sink = leafless_to_buffer(NULL, 0, &length);
    const leafless_sink path = leafless_to_file("null.off");
    leafless_mesh_options read = LEAFLESS_INIT(leafless_mesh_options);
    leafless_mesh_write_options write = LEAFLESS_INIT(leafless_mesh_write_options);
    leafless_scene_options options = LEAFLESS_INIT(leafless_scene_options);
    leafless_mesh_file_info found = LEAFLESS_INIT(leafless_mesh_file_info);
    const leafless_polyhedron_arrays arrays = tetrahedron();
    write.format = LEAFLESS_MESH_FORMAT_OFF;

    NULL_POINTER(leafless_octree_read, source, leafless_octree_read(NULL, octree_result));
    NULL_POINTER(leafless_octree_read, octree, leafless_octree_read(&solid, NULL));
    MISALIGNED(leafless_octree_read, octree, leafless_octree_read(&solid, (leafless_octree **)WRONG(out)));
    NULL_POINTER(leafless_octree_write, octree, leafless_octree_write(NULL, &sink));
    NULL_POINTER(leafless_octree_write, sink, leafless_octree_write(octree, NULL));
    MISALIGNED(leafless_octree_write, octree, leafless_octree_write((const leafless_octree *)WRONG(octree), &sink));
    NULL_POINTER(leafless_tridexel_read, source, leafless_tridexel_read(NULL, tridexel_result));
    NULL_POINTER(leafless_tridexel_read, tridexel, leafless_tridexel_read(&rays, NULL));
    MISALIGNED(leafless_tridexel_read, tridexel, leafless_tridexel_read(&rays, (leafless_tridexel **)WRONG(out)));
    NULL_POINTER(leafless_tridexel_write, tridexel, leafless_tridexel_write(NULL, &sink));
    NULL_POINTER(leafless_tridexel_write, sink, leafless_tridexel_write(model, NULL));
    MISALIGNED(leafless_tridexel_write, tridexel,
               leafless_tridexel_write((const leafless_tridexel *)WRONG(model), &sink));
    /* Each reader recognises its own files. */
    refused(LEAFLESS_E_ARGUMENT, "leafless_octree_read", "", leafless_octree_read(&rays, octree_result));
    refused(LEAFLESS_E_ARGUMENT, "leafless_tridexel_read", "", leafless_tridexel_read(&solid, tridexel_result));

    NULL_POINTER(leafless_mesh_read, source, leafless_mesh_read(NULL, &read, (leafless_mesh_file_info *)out, mesh_result));
    NULL_POINTER(leafless_mesh_read, mesh, leafless_mesh_read(&ply, &read, (leafless_mesh_file_info *)out, NULL));
    MISALIGNED(leafless_mesh_read, options,
               leafless_mesh_read(&ply, (const leafless_mesh_options *)WRONG(&read), NULL, mesh_result));
    MISALIGNED(leafless_mesh_read, found, leafless_mesh_read(&ply, NULL, (leafless_mesh_file_info *)WRONG(out), mesh_result));
    MISALIGNED(leafless_mesh_read, mesh, leafless_mesh_read(&ply, NULL, NULL, (leafless_mesh **)WRONG(out)));
    NULL_POINTER(leafless_mesh_write, mesh, leafless_mesh_write(NULL, &write, &sink));
    NULL_POINTER(leafless_mesh_write, sink, leafless_mesh_write(mesh, &write, NULL));
    MISALIGNED(leafless_mesh_write, mesh, leafless_mesh_write((const leafless_mesh *)WRONG(mesh), &write, &sink));
    MISALIGNED(leafless_mesh_write, options,
               leafless_mesh_write(mesh, (const leafless_mesh_write_options *)WRONG(&write), &sink));
    NULL_POINTER(leafless_mesh_write_polygons, arrays, leafless_mesh_write_polygons(NULL, &write, &sink));
    NULL_POINTER(leafless_mesh_write_polygons, sink, leafless_mesh_write_polygons(&arrays, &write, NULL));
    MISALIGNED(leafless_mesh_write_polygons, arrays,
               leafless_mesh_write_polygons((const leafless_polyhedron_arrays *)WRONG(&arrays), &write, &sink));
    MISALIGNED(leafless_mesh_write_polygons, options,
               leafless_mesh_write_polygons(&arrays, (const leafless_mesh_write_options *)WRONG(&write), &sink));
    /* Without a path the format must be given. */
    refused(LEAFLESS_E_ARGUMENT, "leafless_mesh_write_polygons", "options.format",
            leafless_mesh_write_polygons(&arrays, NULL, &sink));
    refused(LEAFLESS_E_ARGUMENT, "leafless_mesh_write", "options.format", leafless_mesh_write(mesh, NULL, &sink));

    NULL_POINTER(leafless_volume_read, source, leafless_volume_read(NULL, NULL, volume_result));
    NULL_POINTER(leafless_volume_read, volume, leafless_volume_read(&nrrd, NULL, NULL));
    MISALIGNED(leafless_volume_read, data,
               leafless_volume_read(&nrrd, (const leafless_source *)WRONG(&nrrd), volume_result));
    MISALIGNED(leafless_volume_read, volume, leafless_volume_read(&nrrd, NULL, (leafless_volume **)WRONG(out)));
    NULL_POINTER(leafless_volume_write, volume, leafless_volume_write(NULL, 0, &sink));
    NULL_POINTER(leafless_volume_write, sink, leafless_volume_write(volume, 0, NULL));
    MISALIGNED(leafless_volume_write, volume, leafless_volume_write((const leafless_volume *)WRONG(volume), 0, &sink));
    BAD_NUMBER(leafless_volume_write, format, leafless_volume_write(volume, 4, &sink));
    BAD_NUMBER(leafless_volume_write, format, leafless_volume_write(volume, UINT32_MAX, &sink));

    NULL_POINTER(leafless_scene_read, source, leafless_scene_read(NULL, &options, scene_result));
    NULL_POINTER(leafless_scene_read, scene, leafless_scene_read(&csg, &options, NULL));
    MISALIGNED(leafless_scene_read, options,
               leafless_scene_read(&csg, (const leafless_scene_options *)WRONG(&options), scene_result));
    MISALIGNED(leafless_scene_read, scene, leafless_scene_read(&csg, &options, (leafless_scene **)WRONG(out)));
    options.facets = 3;
    BAD_NUMBER(leafless_scene_read, options.facets, leafless_scene_read(&csg, &options, scene_result));
    options.facets = 0;
    options.folder_length = 1;
    NULL_POINTER(leafless_scene_read, options.folder, leafless_scene_read(&csg, &options, scene_result));
    options.folder = "";
    options.folder_length = 0;
    BAD_NUMBER(leafless_scene_read, options.folder, leafless_scene_read(&csg, &options, scene_result));

    NULL_POINTER(leafless_file_describe, source, leafless_file_describe(NULL, (leafless_file_info *)out, NULL, 0));
    NULL_POINTER(leafless_file_describe, probe, leafless_file_describe(&solid, NULL, NULL, 0));
    NULL_POINTER(leafless_file_describe, sections, leafless_file_describe(&solid, (leafless_file_info *)out, NULL, 4));
    MISALIGNED(leafless_file_describe, probe, leafless_file_describe(&solid, (leafless_file_info *)WRONG(out), NULL, 0));
    MISALIGNED(leafless_file_describe, sections,
               leafless_file_describe(&solid, (leafless_file_info *)out, (leafless_file_section *)WRONG(out), 4));
    NULL_POINTER(leafless_file_verify, source, leafless_file_verify(NULL));
    untouched();
    CHECK(never == UNTOUCHED && length == 0);

    /* What may be absent. */
    MAY_BE_NULL(leafless_mesh_read, options, leafless_mesh_read(&ply, NULL, &found, mesh_result));
    leafless_mesh_free(*mesh_result);
    MAY_BE_NULL(leafless_mesh_read, found, leafless_mesh_read(&ply, &read, NULL, mesh_result));
    leafless_mesh_free(*mesh_result);
    MAY_BE_NULL(leafless_mesh_write, options, leafless_mesh_write(mesh, NULL, &path));
    MAY_BE_NULL(leafless_mesh_write_polygons, options, leafless_mesh_write_polygons(&arrays, NULL, &path));
    MAY_BE_NULL(leafless_volume_read, data, leafless_volume_read(&nrrd, NULL, volume_result));
    leafless_volume_free(*volume_result);
    MAY_BE_NULL(leafless_scene_read, options, leafless_scene_read(&csg, NULL, scene_result));
    leafless_scene_free(*scene_result);
    MAY_BE_NULL(leafless_file_describe, sections, leafless_file_describe(&solid, &probe, NULL, 0));
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
        bad = leafless_from_bytes(NULL, 8, LEAFLESS_ACCESS_COPY);
        refused(LEAFLESS_E_NULL, "leafless_volume_read", "data.bytes", leafless_volume_read(&headers[header], &bad, &read));
        bad = leafless_from_file(NULL, LEAFLESS_ACCESS_COPY);
        refused(LEAFLESS_E_NULL, "leafless_volume_read", "data.path", leafless_volume_read(&headers[header], &bad, &read));
        bad = leafless_from_file("no/such/file", LEAFLESS_ACCESS_COPY);
        refused(LEAFLESS_E_IO, "leafless_volume_read", "no/such/file",
                leafless_volume_read(&headers[header], &bad, &read));
        bad = samples[0];
        bad.access = LEAFLESS_ACCESS_MAP;
        refused(LEAFLESS_E_ARGUMENT, "leafless_volume_read", "data.access",
                leafless_volume_read(&headers[header], &bad, &read));
        bad = samples[0];
        bad.path = "x";
        refused(LEAFLESS_E_ARGUMENT, "leafless_volume_read", "data: has both",
                leafless_volume_read(&headers[header], &bad, &read));
        bad = samples[0];
        bad.struct_size = 3;
        refused(LEAFLESS_E_ARGUMENT, "leafless_volume_read", "data: has no sensible",
                leafless_volume_read(&headers[header], &bad, &read));
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
        refused(LEAFLESS_E_ARGUMENT, "leafless_volume_new", "source.access", leafless_volume_new(&layout, &file, &viewed));
        OK(leafless_volume_new(&layout, &bytes, &viewed));
        OK(leafless_volume_peek_samples(viewed, &samples, &count));
        CHECK(samples == (const void *)SAMPLES && count == sizeof SAMPLES);
        leafless_volume_free(viewed);
    }
    memset(&probe, 0x5a, sizeof probe);
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
        sinks(WRITERS[i].name, WRITERS[i].write);
    }
    parameters();
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
