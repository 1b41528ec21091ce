/* A plugin: a shared library that holds the static one, and exports one function of its own. */
#include <leafless.h>

double plugin_volume(double radius);

double plugin_volume(double radius) {
    const double centre[3] = {0, 0, 0};
    const leafless_frame frame = {{-1, -1, -1}, 2, 6};
    leafless_solid *ball = NULL;
    leafless_octree *octree = NULL;
    leafless_statistics all = {0};
    leafless_status s = leafless_solid_new_ball(centre, radius, &ball);
    if (!s) s = leafless_octree_build(ball, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &octree);
    if (!s) s = leafless_octree_statistics(octree, &all);
    leafless_octree_free(octree);
    leafless_solid_free(ball);
    return s ? -1 : (all.volume_model.lower + all.volume_model.upper) / 2;
}
