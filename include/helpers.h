/// Makes a source of the file at a NUL-terminated path.
static inline leafless_source leafless_from_file(const char *path, leafless_access access) {
    leafless_source source = LEAFLESS_INIT(leafless_source);
    source.access = access;
    source.path = path;
    /* With the length 1, a NULL path is refused as such, and not read as an empty path. */
    source.path_length = path ? strlen(path) : 1;
    return source;
}

/// Makes a source of the bytes of a whole file.
static inline leafless_source leafless_from_bytes(const void *bytes, uint64_t length,
                                                  leafless_access access) {
    leafless_source source = LEAFLESS_INIT(leafless_source);
    source.access = access;
#ifdef __cplusplus
    source.bytes = static_cast<const uint8_t *>(bytes);
#else
    source.bytes = (const uint8_t *)bytes;
#endif
    source.length = length;
    return source;
}

/// Makes a sink that writes to the file at a NUL-terminated path.
static inline leafless_sink leafless_to_file(const char *path) {
    leafless_sink sink = LEAFLESS_INIT(leafless_sink);
    sink.path = path;
    sink.path_length = path ? strlen(path) : 1;
    return sink;
}

/// Makes a sink that writes to a buffer; `bytes` is NULL and `capacity` 0 to get only the length.
static inline leafless_sink leafless_to_buffer(uint8_t *bytes, uint64_t capacity, uint64_t *length) {
    leafless_sink sink = LEAFLESS_INIT(leafless_sink);
    sink.bytes = bytes;
    sink.capacity = capacity;
    sink.length = length;
    return sink;
}

/// Makes a sink that passes the bytes to a function, which is called with `ctx`.
static inline leafless_sink leafless_to_function(leafless_write_fn write, void *ctx) {
    leafless_sink sink = LEAFLESS_INIT(leafless_sink);
    sink.write = write;
    sink.write_ctx = ctx;
    return sink;
}
