/* The header stands alone, before any other, and may be included twice. */
#include <leafless.h>
#include <leafless.h>

/* Enumerators are constant expressions, and types are usable by name alone. */
static const leafless_status ALLOWED[] = {LEAFLESS_OK, LEAFLESS_E_CANCELLED};
static leafless_tag tag = LEAFLESS_TAG_BRANCH;

int main(void) {
    leafless_options options = LEAFLESS_INIT(leafless_options);
    leafless_frame frame = {{0.0, 0.0, 0.0}, 1.0, 4};
    leafless_octree *octree = NULL;
    leafless_octree_info info;
    if (options.struct_size != sizeof options || options.max_nodes != 0) {
        return 4;
    }
    if (leafless_octree_uniform(&frame, LEAFLESS_TAG_FULL, LEAFLESS_TAG_EMPTY, &octree) != ALLOWED[0]) {
        return 1;
    }
    if (leafless_octree_describe(octree, &info) != LEAFLESS_OK) {
        return 2;
    }
    tag = info.root;
    leafless_octree_free(octree);
    return tag == LEAFLESS_TAG_FULL && info.frame.depth == 4 && LEAFLESS_COMPATIBLE() ? 0 : 3;
}
