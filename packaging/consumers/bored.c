/* A ball with a bore, and its volume. */
#include <leafless.h>

#include <stdio.h>

int main(void) {
    const double centre[3] = {0, 0, 0}, low[3] = {0, 0, -1}, high[3] = {0, 0, 1};
    const leafless_frame frame = {{-1, -1, -1}, 2, 6};
    leafless_solid *parts[2] = {NULL, NULL}, *bored = NULL;
    leafless_octree *octree = NULL;
    leafless_statistics all;
    leafless_status s = LEAFLESS_COMPATIBLE() ? LEAFLESS_OK : LEAFLESS_E_ARGUMENT;
    if (!s) s = leafless_solid_new_ball(centre, 0.75, &parts[0]);
    if (!s) s = leafless_solid_new_cylinder(low, high, 0.25, &parts[1]);
    if (!s) {
        const leafless_solid *operands[2];
        operands[0] = parts[0];
        operands[1] = parts[1];
        s = leafless_solid_combine(LEAFLESS_OPERATION_DIFFERENCE, operands, 2, &bored);
    }
    if (!s) s = leafless_octree_build(bored, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &octree);
    if (!s) s = leafless_octree_statistics(octree, &all);
    if (!s) printf("volume %.3f to %.3f\n", all.volume_model.lower, all.volume_model.upper);
    leafless_octree_free(octree);
    leafless_solid_free(bored);
    leafless_solid_free(parts[1]);
    leafless_solid_free(parts[0]);
    return s != LEAFLESS_OK;
}
