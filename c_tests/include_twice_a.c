/* Two files that both include the header make one program: see include_twice_b.c. */
#include "check.h"

uint32_t elsewhere_version(void);
leafless_status elsewhere_describe(const leafless_octree *octree, leafless_octree_info *info);

int main(void) {
    leafless_octree *octree = check_ball(4, LEAFLESS_RULE_CERTIFIED);
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
    CHECK(elsewhere_version() == LEAFLESS_VERSION);
    OK(elsewhere_describe(octree, &info));
    CHECK(info.frame.depth == 4);
    leafless_octree_free(octree);
    return 0;
}
