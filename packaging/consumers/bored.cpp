// A ball with a bore, and its volume.
#include <leafless.hpp>

#include <cstdio>
#include <exception>

int main() {
    try {
        const leafless_frame frame = {{-1, -1, -1}, 2, 6};
        const auto ball = leafless::solid::new_ball({0, 0, 0}, 0.75);
        const auto bore = leafless::solid::new_cylinder({0, 0, -1}, {0, 0, 1}, 0.25);
        const auto bored = leafless::solid::combine(LEAFLESS_OPERATION_DIFFERENCE, leafless::refs(ball, bore));
        const auto octree = leafless::octree::build(bored, frame, LEAFLESS_RULE_CERTIFIED);
        const leafless_interval volume = octree.statistics().volume_model;
        std::printf("volume %.3f to %.3f\n", volume.lower, volume.upper);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
