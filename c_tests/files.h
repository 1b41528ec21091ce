/* Ways in and out of files, each in one call: paths by their lengths, so that they need not end with a NUL, and bytes. */
#ifndef FILES_H
#define FILES_H

#include <leafless.h>

static inline leafless_source source_path(const char *path, size_t path_length, leafless_access access) {
    leafless_source source = LEAFLESS_INIT(leafless_source);
    source.access = access;
    source.path = path;
    source.path_length = path_length;
    return source;
}

static inline leafless_sink sink_path(const char *path, size_t path_length) {
    leafless_sink sink = LEAFLESS_INIT(leafless_sink);
    sink.path = path;
    sink.path_length = path_length;
    return sink;
}

/* What can be used where it lies: octrees and tri-dexel models. */
#define WAYS_IN_AND_OUT(kind)                                                                                          \
    static inline leafless_status kind##_open(const char *path, size_t path_length, leafless_##kind **result) {        \
        const leafless_source source = source_path(path, path_length, LEAFLESS_ACCESS_COPY);                           \
        return leafless_##kind##_read(&source, result);                                                                \
    }                                                                                                                  \
    static inline leafless_status kind##_map(const char *path, size_t path_length, leafless_##kind **result) {         \
        const leafless_source source = source_path(path, path_length, LEAFLESS_ACCESS_MAP);                            \
        return leafless_##kind##_read(&source, result);                                                                \
    }                                                                                                                  \
    static inline leafless_status kind##_map_verified(const char *path, size_t path_length, leafless_##kind **result) { \
        const leafless_source source = source_path(path, path_length, LEAFLESS_ACCESS_MAP_VERIFIED);                   \
        return leafless_##kind##_read(&source, result);                                                                \
    }                                                                                                                  \
    static inline leafless_status kind##_from_bytes(const uint8_t *bytes, uint64_t length, leafless_##kind **result) { \
        const leafless_source source = leafless_from_bytes(bytes, length, LEAFLESS_ACCESS_COPY);                       \
        return leafless_##kind##_read(&source, result);                                                                \
    }                                                                                                                  \
    static inline leafless_status kind##_view_bytes(const uint8_t *bytes, uint64_t length, leafless_##kind **result) { \
        const leafless_source source = leafless_from_bytes(bytes, length, LEAFLESS_ACCESS_MAP);                        \
        return leafless_##kind##_read(&source, result);                                                                \
    }                                                                                                                  \
    static inline leafless_status kind##_view_verified(const uint8_t *bytes, uint64_t length,                          \
                                                       leafless_##kind **result) {                                     \
        const leafless_source source = leafless_from_bytes(bytes, length, LEAFLESS_ACCESS_MAP_VERIFIED);               \
        return leafless_##kind##_read(&source, result);                                                                \
    }                                                                                                                  \
    static inline leafless_status kind##_save(const leafless_##kind *object, const char *path, size_t path_length) {   \
        const leafless_sink sink = sink_path(path, path_length);                                                       \
        return leafless_##kind##_write(object, &sink);                                                                 \
    }                                                                                                                  \
    static inline leafless_status kind##_to_bytes(const leafless_##kind *object, uint8_t *bytes, uint64_t capacity,    \
                                                  uint64_t *length) {                                                  \
        const leafless_sink sink = leafless_to_buffer(bytes, capacity, length);                                        \
        return leafless_##kind##_write(object, &sink);                                                                 \
    }                                                                                                                  \
    static inline leafless_status kind##_write_to(const leafless_##kind *object, leafless_write_fn write, void *ctx) { \
        const leafless_sink sink = leafless_to_function(write, ctx);                                                   \
        return leafless_##kind##_write(object, &sink);                                                                 \
    }

WAYS_IN_AND_OUT(octree)
WAYS_IN_AND_OUT(tridexel)

static inline leafless_status mesh_open(const char *path, size_t path_length, const leafless_mesh_options *options,
                                        leafless_mesh_file_info *found, leafless_mesh **mesh) {
    const leafless_source source = source_path(path, path_length, LEAFLESS_ACCESS_COPY);
    return leafless_mesh_read(&source, options, found, mesh);
}

static inline leafless_status mesh_from_bytes(const uint8_t *bytes, uint64_t length, const leafless_mesh_options *options,
                                              leafless_mesh_file_info *found, leafless_mesh **mesh) {
    const leafless_source source = leafless_from_bytes(bytes, length, LEAFLESS_ACCESS_COPY);
    return leafless_mesh_read(&source, options, found, mesh);
}

static inline leafless_status mesh_save(const leafless_mesh *mesh, const char *path, size_t path_length,
                                        const leafless_mesh_write_options *options) {
    const leafless_sink sink = sink_path(path, path_length);
    return leafless_mesh_write(mesh, options, &sink);
}

static inline leafless_status mesh_to_bytes(const leafless_mesh *mesh, const leafless_mesh_write_options *options,
                                            uint8_t *bytes, uint64_t capacity, uint64_t *length) {
    const leafless_sink sink = leafless_to_buffer(bytes, capacity, length);
    return leafless_mesh_write(mesh, options, &sink);
}

static inline leafless_status mesh_to_stl(const leafless_mesh *mesh, uint8_t *bytes, uint64_t capacity,
                                          uint64_t *length) {
    leafless_mesh_write_options options = LEAFLESS_INIT(leafless_mesh_write_options);
    options.format = LEAFLESS_MESH_FORMAT_STL;
    return mesh_to_bytes(mesh, &options, bytes, capacity, length);
}

static inline leafless_status volume_open(const char *path, size_t path_length, leafless_volume **volume) {
    const leafless_source source = source_path(path, path_length, LEAFLESS_ACCESS_COPY);
    return leafless_volume_read(&source, NULL, volume);
}

/* `data`, if it is not NULL, is the file of the samples. */
static inline leafless_status volume_from_bytes(const uint8_t *bytes, uint64_t length, const uint8_t *data,
                                                uint64_t data_length, leafless_volume **volume) {
    const leafless_source source = leafless_from_bytes(bytes, length, LEAFLESS_ACCESS_COPY);
    const leafless_source samples = leafless_from_bytes(data, data_length, LEAFLESS_ACCESS_COPY);
    return leafless_volume_read(&source, data == NULL ? NULL : &samples, volume);
}

static inline leafless_status volume_save(const leafless_volume *volume, leafless_volume_format format, const char *path,
                                          size_t path_length) {
    const leafless_sink sink = sink_path(path, path_length);
    return leafless_volume_write(volume, format, &sink);
}

static inline leafless_status volume_to_bytes(const leafless_volume *volume, leafless_volume_format format, uint8_t *bytes,
                                              uint64_t capacity, uint64_t *length) {
    const leafless_sink sink = leafless_to_buffer(bytes, capacity, length);
    return leafless_volume_write(volume, format, &sink);
}

static inline leafless_status scene_open(const char *path, size_t path_length, const leafless_scene_options *options,
                                         leafless_scene **scene) {
    const leafless_source source = source_path(path, path_length, LEAFLESS_ACCESS_COPY);
    return leafless_scene_read(&source, options, scene);
}

/* A text that ends with a NUL; the folder, too, or NULL. */
static inline leafless_status scene_from_text(const char *text, const char *folder, leafless_facets facets,
                                              leafless_scene **scene) {
    const leafless_source source = leafless_from_bytes(text, strlen(text), LEAFLESS_ACCESS_COPY);
    leafless_scene_options options = LEAFLESS_INIT(leafless_scene_options);
    options.facets = facets;
    options.folder = folder;
    options.folder_length = folder == NULL ? 0 : strlen(folder);
    return leafless_scene_read(&source, &options, scene);
}

static inline leafless_status probe_path(const char *path, size_t path_length, leafless_file_info *probe,
                                         leafless_file_section *sections, uint64_t capacity) {
    const leafless_source source = source_path(path, path_length, LEAFLESS_ACCESS_COPY);
    return leafless_file_describe(&source, probe, sections, capacity);
}

static inline leafless_status probe_bytes(const uint8_t *bytes, uint64_t length, leafless_file_info *probe,
                                          leafless_file_section *sections, uint64_t capacity) {
    const leafless_source source = leafless_from_bytes(bytes, length, LEAFLESS_ACCESS_COPY);
    return leafless_file_describe(&source, probe, sections, capacity);
}

static inline leafless_status verify_path(const char *path, size_t path_length, leafless_access access) {
    const leafless_source source = source_path(path, path_length, access);
    return leafless_file_verify(&source);
}

static inline leafless_status verify_bytes(const uint8_t *bytes, uint64_t length) {
    const leafless_source source = leafless_from_bytes(bytes, length, LEAFLESS_ACCESS_COPY);
    return leafless_file_verify(&source);
}

/* Pictures, and arrays of samples. */
static inline leafless_status picture_save(const uint8_t *colours, uint32_t width, uint32_t height, const char *path,
                                           size_t path_length) {
    const leafless_sink sink = sink_path(path, path_length);
    return leafless_picture_write(colours, width, height, &sink);
}

static inline leafless_status picture_to_bytes(const uint8_t *colours, uint32_t width, uint32_t height, uint8_t *bytes,
                                               uint64_t capacity, uint64_t *length) {
    const leafless_sink sink = leafless_to_buffer(bytes, capacity, length);
    return leafless_picture_write(colours, width, height, &sink);
}

static inline leafless_status volume_of_array(const leafless_volume_layout *layout, const void *samples, uint64_t length,
                                              leafless_volume **volume) {
    const leafless_source source = leafless_from_bytes(samples, length, LEAFLESS_ACCESS_COPY);
    return leafless_volume_new(layout, &source, volume);
}

static inline leafless_status volume_in_place(const leafless_volume_layout *layout, const void *samples, uint64_t length,
                                              leafless_volume **volume) {
    const leafless_source source = leafless_from_bytes(samples, length, LEAFLESS_ACCESS_MAP);
    return leafless_volume_new(layout, &source, volume);
}

static inline leafless_status volume_open_raw(const char *path, size_t path_length, const leafless_volume_layout *layout,
                                              leafless_volume **volume) {
    const leafless_source source = source_path(path, path_length, LEAFLESS_ACCESS_COPY);
    return leafless_volume_new(layout, &source, volume);
}

#endif
