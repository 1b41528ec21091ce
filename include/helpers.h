/// The file at a path, which ends with a NUL.
static inline leafless_source leafless_from_file(const char *path, leafless_access access) {
    leafless_source source = LEAFLESS_INIT(leafless_source);
    source.access = access;
    source.path = path;
    /* NULL is refused for what it is, and not taken for no bytes. */
    source.path_length = path ? strlen(path) : 1;
    return source;
}

/// The bytes of a whole file.
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

/// To the file at a path, which ends with a NUL.
static inline leafless_sink leafless_to_file(const char *path) {
    leafless_sink sink = LEAFLESS_INIT(leafless_sink);
    sink.path = path;
    sink.path_length = path ? strlen(path) : 1;
    return sink;
}

/// To a buffer; `bytes` is NULL and `capacity` 0 to ask for the length only.
static inline leafless_sink leafless_to_buffer(uint8_t *bytes, uint64_t capacity, uint64_t *length) {
    leafless_sink sink = LEAFLESS_INIT(leafless_sink);
    sink.bytes = bytes;
    sink.capacity = capacity;
    sink.length = length;
    return sink;
}

/// To a function, which is called with `ctx`.
static inline leafless_sink leafless_to_function(leafless_write_fn write, void *ctx) {
    leafless_sink sink = LEAFLESS_INIT(leafless_sink);
    sink.write = write;
    sink.write_ctx = ctx;
    return sink;
}
