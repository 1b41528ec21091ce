// The C++ interface without exceptions: results are looked at.
#define LEAFLESS_NO_EXCEPTIONS
#include <leafless.hpp>

#include "check.h"

int main() {
    const leafless_frame frame = {{-1, -1, -1}, 2, 5};
    leafless::result<leafless::solid> refused = leafless::solid::new_ball({0, 0, 0}, -1);
    CHECK(!refused && refused.status() == LEAFLESS_E_ARGUMENT && !refused.value());
    CHECK(leafless::last_message().find("radius") == 0);
    leafless::result<leafless::solid> ball = leafless::solid::new_ball({0, 0, 0}, 0.5);
    CHECK(ball && ball.status() == LEAFLESS_OK);
    const leafless::octree octree =
        leafless::octree::build(ball.value(), frame, LEAFLESS_RULE_CERTIFIED).value();
    const leafless_statistics all = octree.statistics().value();
    CHECK(all.volume_model.lower < 0.5236 && 0.5235 < all.volume_model.upper);
    CHECK(octree.check());
    const std::vector<leafless_statistics> levels = octree.levels().value();
    CHECK(!levels.empty());
    leafless::cells full = leafless::cells::make(octree, LEAFLESS_TAGS_FULL, 0, 20).value();
    std::uint64_t count = 0;
    for (const leafless_cell &cell : leafless::each(full)) count += cell.tag == LEAFLESS_TAG_FULL;
    CHECK(count == all.full);
    const leafless::solid host = leafless::solid_of(
        [](const leafless::point &, const leafless::point &) { return LEAFLESS_TAG_EMPTY; },
        LEAFLESS_EXTERIOR_EMPTY).value();
    CHECK(leafless::octree::build(host, frame, LEAFLESS_RULE_CERTIFIED).value().statistics().value().full == 0);
    const auto cancelled = leafless::with_progress(
        LEAFLESS_INIT(leafless_options), [](double) { return false; }, [&](const leafless_options &options) {
            leafless_frame fine = frame;
            fine.depth = 9;
            return leafless::octree::build(ball.value(), fine, LEAFLESS_RULE_CERTIFIED, &options);
        });
    CHECK(cancelled.status() == LEAFLESS_E_CANCELLED);
    return 0;
}
