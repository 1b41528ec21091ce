/* The header stands alone, before any other, and may be included twice. Its functions in C please those who look closely. */
#pragma GCC diagnostic error "-Wconversion"
#pragma GCC diagnostic error "-Wshadow"
#pragma GCC diagnostic error "-Wcast-qual"
#pragma GCC diagnostic error "-Wmissing-prototypes"
#include <leafless.h>
#include <leafless.h>

/* Enumerators are constant expressions, and types are usable by name alone. */
static const leafless_status ALLOWED[] = {LEAFLESS_OK, LEAFLESS_E_CANCELLED};
static leafless_tag tag = LEAFLESS_TAG_BRANCH;

int main(void) {
    leafless_options options = LEAFLESS_INIT(leafless_options);
    leafless_frame frame = {{0.0, 0.0, 0.0}, 1.0, 4};
    leafless_octree *octree = NULL;
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
    uint64_t length = 0;
    const leafless_sink sink = leafless_to_buffer(NULL, 0, &length);
    const leafless_source file = leafless_from_file("no/such/file", LEAFLESS_ACCESS_MAP);
    const leafless_source bytes = leafless_from_bytes(&frame, 1, LEAFLESS_ACCESS_COPY);
    if (options.struct_size != sizeof options || options.max_nodes != 0) {
        return 4;
    }
    if (leafless_octree_new_uniform(&frame, LEAFLESS_TAG_FULL, LEAFLESS_TAG_EMPTY, &octree) != ALLOWED[0]) {
        return 1;
    }
    if (leafless_octree_describe(octree, &info) != LEAFLESS_OK) {
        return 2;
    }
    tag = info.root;
    if (leafless_octree_write(octree, &sink) != LEAFLESS_OK || length == 0) {
        return 5;
    }
    leafless_octree_free(octree);
    if (leafless_octree_read(&file, &octree) != LEAFLESS_E_IO || leafless_octree_read(&bytes, &octree) != LEAFLESS_E_FORMAT) {
        return 6;
    }
    return tag == LEAFLESS_TAG_FULL && info.frame.depth == 4 && LEAFLESS_COMPATIBLE() ? 0 : 3;
}
