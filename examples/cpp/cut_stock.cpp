// A ball-nosed tool cuts a groove into a block of stock: what is left, step by step, as a certified volume.
//
// include/README.md tells how to build it:
//
//     g++ -std=c++17 examples/cpp/cut_stock.cpp -Iinclude target/release/libleafless.a -lgcc_s ... -o cut_stock

#include <leafless.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

namespace {

// --- As much of a C++ interface as this program needs ---

struct Free {
    void operator()(leafless_octree *octree) const { leafless_octree_free(octree); }
    void operator()(leafless_solid *solid) const { leafless_solid_free(solid); }
};
using Octree = std::unique_ptr<leafless_octree, Free>;
using Solid = std::unique_ptr<leafless_solid, Free>;
using Point = std::array<double, 3>;

void check(leafless_status status) {
    if (status != LEAFLESS_OK) {
        std::string message(leafless_last_error(nullptr, 0) + 1, '\0');
        leafless_last_error(message.data(), message.size());
        message.pop_back();
        throw std::runtime_error(std::string(leafless_status_name(status)) + ": " + message);
    }
}

// Classifies a box between two corners. Called from several threads at once.
using Classifier = std::function<leafless_tag(const Point &min, const Point &max)>;

// A shape of the host's own, which lives until the library has no more use for it.
Solid solid_of(Classifier classifier) {
    auto context = std::make_unique<Classifier>(std::move(classifier));
    leafless_callbacks callbacks = {};
    callbacks.struct_size = sizeof callbacks;
    callbacks.exterior = LEAFLESS_EXTERIOR_EMPTY;
    callbacks.ctx = context.get();
    callbacks.classify = [](void *ctx, const double *min, const double *max) -> int32_t {
        try {
            return (*static_cast<Classifier *>(ctx))({min[0], min[1], min[2]}, {max[0], max[1], max[2]});
        } catch (...) {
            return -1;  // Exceptions must not cross the library.
        }
    };
    callbacks.destroy = [](void *ctx) { delete static_cast<Classifier *>(ctx); };
    leafless_solid *solid = nullptr;
    check(leafless_solid_new_callbacks(&callbacks, &solid));
    context.release();  // From here on `destroy` sees to it.
    return Solid(solid);
}

Octree build(const Solid &solid, const leafless_frame &frame, const leafless_options &options) {
    leafless_octree *octree = nullptr;
    check(leafless_octree_build(solid.get(), &frame, LEAFLESS_RULE_CERTIFIED, &options, &octree));
    return Octree(octree);
}

// --- The program ---

constexpr double RADIUS = 0.3;

// The distances from a point to the nearest and to the farthest point of a box, squared.
std::pair<double, double> distances(const Point &point, const Point &min, const Point &max) {
    double near = 0.0, far = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        const double beside = std::max({min[axis] - point[axis], 0.0, point[axis] - max[axis]});
        const double across = std::max(std::abs(min[axis] - point[axis]), std::abs(max[axis] - point[axis]));
        near += beside * beside;
        far += across * across;
    }
    return {near, far};
}

// The tool's tip at one place. What is close to a call is left undecided, so that rounding cannot make it wrong.
Solid tool_at(const Point &centre) {
    return solid_of([centre](const Point &min, const Point &max) {
        const auto [near, far] = distances(centre, min, max);
        const double square = RADIUS * RADIUS, margin = 1e-12;
        return near > square + margin  ? LEAFLESS_TAG_EMPTY
               : far < square - margin ? LEAFLESS_TAG_FULL
                                       : LEAFLESS_TAG_PARTIAL;
    });
}

void cut() {
    const leafless_frame frame = {{-1.0, -1.0, -1.0}, 2.0, 7};
    const double low[3] = {-0.75, -0.5, -0.5}, high[3] = {0.75, 0.5, 0.25};
    double done = 0.0;
    leafless_options options = LEAFLESS_INIT(leafless_options);
    options.threads = 1;
    options.progress_ctx = &done;
    options.progress = [](void *ctx, double fraction) -> int32_t {
        *static_cast<double *>(ctx) = fraction;
        return 0;  // Anything else would cancel.
    };

    leafless_solid *box = nullptr;
    check(leafless_solid_new_box(low, high, &box));
    Octree stock = build(Solid(box), frame, options);

    std::printf("step      centre of the tool       volume left             progress\n");
    for (int step = 0; step <= 8; step++) {
        const Point centre = {-0.8 + 0.2 * step, 0.2 * std::sin(0.8 * step), 0.25};
        const Octree tool = build(tool_at(centre), frame, options);
        leafless_octree *left = nullptr;
        const leafless_octree *const operands[] = {stock.get(), tool.get()};
        check(leafless_octree_combine(LEAFLESS_OPERATION_DIFFERENCE, operands, 2, &options, &left));
        stock.reset(left);
        leafless_statistics statistics;
        check(leafless_octree_statistics(stock.get(), &statistics));
        std::printf("%4d  (%6.3f, %6.3f, %6.3f)  %.6f to %.6f  %6.0f %%\n", step, centre[0], centre[1], centre[2],
                    statistics.volume_model.lower, statistics.volume_model.upper, 100.0 * done);
    }
    check(leafless_octree_check(stock.get()));
}

}  // namespace

int main() {
    try {
        cut();
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
