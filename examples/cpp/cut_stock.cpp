// A ball-nosed tool cuts a groove into a block of stock. The program prints the certified volume of the rest, step by
// step.
//
// include/README.md describes how to build it:
//
//     g++ -std=c++17 examples/cpp/cut_stock.cpp -Iinclude target/release/libleafless.a -lgcc_s ... -o cut_stock

#include <leafless.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

using leafless::octree;
using leafless::point;

namespace {

constexpr double RADIUS = 0.3;

// The tool's tip at one position. Close decisions are left undecided, so that rounding cannot make them wrong.
leafless::solid tool_at(const point &centre) {
    const auto classify = [centre](const point &min, const point &max) {
        double near = 0.0, far = 0.0;
        for (std::size_t axis = 0; axis < 3; axis++) {
            const double beside = std::max({min[axis] - centre[axis], 0.0, centre[axis] - max[axis]});
            const double across = std::max(std::abs(min[axis] - centre[axis]), std::abs(max[axis] - centre[axis]));
            near += beside * beside;
            far += across * across;
        }
        const double square = RADIUS * RADIUS, margin = 1e-12;
        return near > square + margin  ? LEAFLESS_TAG_EMPTY
               : far < square - margin ? LEAFLESS_TAG_FULL
                                       : LEAFLESS_TAG_PARTIAL;
    };
    return leafless::solid_of(classify, LEAFLESS_EXTERIOR_EMPTY);
}

void cut() {
    const leafless_frame frame = {{-1.0, -1.0, -1.0}, 2.0, 7};
    const leafless::solid block = leafless::solid::new_box({-0.75, -0.5, -0.5}, {0.75, 0.5, 0.25});
    octree stock = octree::build(block, frame, LEAFLESS_RULE_CERTIFIED);
    std::printf("step      centre of the tool       volume left\n");
    for (int step = 0; step <= 8; step++) {
        const point centre = {-0.8 + 0.2 * step, 0.2 * std::sin(0.8 * step), 0.25};
        const octree tool = octree::build(tool_at(centre), frame, LEAFLESS_RULE_CERTIFIED);
        stock = octree::combine(LEAFLESS_OPERATION_DIFFERENCE, leafless::refs(stock, tool));
        const leafless_interval left = stock.statistics().volume_model;
        std::printf("%4d  (%6.3f, %6.3f, %6.3f)  %.6f to %.6f\n", step, centre[0], centre[1], centre[2], left.lower,
                    left.upper);
    }
    stock.check();
}

} // namespace

int main() {
    try {
        cut();
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
