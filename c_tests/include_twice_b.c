/* The other half of include_twice_a.c. */
#include <leafless.h>

uint32_t elsewhere_version(void);
leafless_status elsewhere_describe(const leafless_octree *octree, leafless_octree_info *info);

uint32_t elsewhere_version(void) {
    return LEAFLESS_VERSION;
}

leafless_status elsewhere_describe(const leafless_octree *octree, leafless_octree_info *info) {
    return leafless_octree_describe(octree, info);
}
