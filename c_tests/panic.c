/* A panic inside comes back as a status and leaves everything usable. */
#include "check.h"

int main(void) {
    leafless_octree *octree = check_ball(5, LEAFLESS_RULE_CERTIFIED);
    char message[512];
    int i;
    for (i = 0; i < 3; i++) {
        FAILS(LEAFLESS_E_PANIC, leafless_test_panic());
        CHECK(leafless_last_status() == LEAFLESS_E_PANIC);
        CHECK(leafless_last_error(message, sizeof message) == strlen(message));
        CHECK(strstr(message, "defect of the library") != NULL);
        CHECK(strstr(message, "as the test wanted") != NULL);
        OK(leafless_octree_check(octree));
    }
    leafless_octree_free(octree);
    return 0;
}
