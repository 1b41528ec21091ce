// The C++ interface as a program uses it: owners, batches, lambdas, exceptions from there and back, walks.
#include <leafless.hpp>

#include "check.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <string>
#include <thread>

namespace {

const leafless_frame FRAME = {{-1, -1, -1}, 2, 6};

struct host_failure {
    int number;
};

// The distances of the nearest and the farthest point of a box from the origin, squared.
std::array<double, 2> reach(const leafless::point &min, const leafless::point &max) {
    std::array<double, 2> found = {0, 0};
    for (std::size_t axis = 0; axis < 3; axis++) {
        const double nearest = std::max({min[axis], -max[axis], 0.0});
        const double farthest = std::max(std::fabs(min[axis]), std::fabs(max[axis]));
        found[0] += nearest * nearest;
        found[1] += farthest * farthest;
    }
    return found;
}

leafless_tag classify(const leafless::point &min, const leafless::point &max) {
    const auto [nearest, farthest] = reach(min, max);
    return farthest < 0.25 - 1e-12  ? LEAFLESS_TAG_FULL
           : nearest > 0.25 + 1e-12 ? LEAFLESS_TAG_EMPTY
                                    : LEAFLESS_TAG_PARTIAL;
}

// A ball of radius 1/2 with every function that a host may provide.
struct ball {
    std::shared_ptr<std::atomic<int>> calls = std::make_shared<std::atomic<int>>(0);

    leafless_tag classify(const leafless::point &min, const leafless::point &max) const {
        calls->fetch_or(1);
        return ::classify(min, max);
    }
    bool contains(const leafless::point &at) const {
        calls->fetch_or(2);
        return reach(at, at)[0] < 0.25;
    }
    void classify_many(leafless::span<const leafless::box> boxes, leafless::span<std::int32_t> tags) const {
        calls->fetch_or(4);
        for (std::size_t i = 0; i < boxes.size(); i++) {
            const leafless::box &b = boxes[i];
            tags[i] = ::classify({b[0], b[1], b[2]}, {b[3], b[4], b[5]});
        }
    }
    void contains_many(leafless::span<const leafless::point> points, leafless::span<std::int32_t> inside) const {
        calls->fetch_or(8);
        for (std::size_t i = 0; i < points.size(); i++) inside[i] = reach(points[i], points[i])[0] < 0.25 ? 1 : 0;
    }
    void distance_many(leafless::span<const leafless::point> points, leafless::span<double> distances) const {
        calls->fetch_or(16);
        for (std::size_t i = 0; i < points.size(); i++) {
            const double distance = std::sqrt(reach(points[i], points[i])[0]) - 0.5;
            distances[i] = distance * (1 - 1e-9);
        }
    }
    void gradient(const leafless::point &min, const leafless::point &max, const leafless::point &middle,
                  leafless_gradient &found) const {
        calls->fetch_or(32);
        const double value = reach(middle, middle)[0] - 0.25;
        found.value = {value - 1e-12, value + 1e-12};
        for (std::size_t axis = 0; axis < 3; axis++) {
            found.gradient[axis] = {2 * min[axis] - 1e-12, 2 * max[axis] + 1e-12};
        }
    }
    void tangent(const leafless::point &, const leafless::point &, const leafless::point &,
                 leafless_tangent &) const {
        calls->fetch_or(64);
    }
};

constexpr double VOLUME = 4.0 / 3.0 * 3.14159265358979323846 / 8.0;

void owners() {
    leafless::octree none;
    CHECK(!none && none.get() == nullptr);
    leafless::solid made = leafless::solid::new_ball({0, 0, 0}, 0.5);
    CHECK(bool(made));
    leafless::solid moved = std::move(made);
    CHECK(moved && !made);
    leafless::solid shared = moved.share();
    moved.reset();
    CHECK(!moved && shared);
    leafless_solid *handle = shared.release();
    leafless::solid again(handle);
    CHECK(!shared && again.get() == handle);
    again = leafless::solid::new_box({-1, -1, -1}, {0, 0, 0});
    std::vector<leafless::solid> several;
    several.push_back(std::move(again));
    several.push_back(leafless::solid::new_ball({0, 0, 0}, 0.5));
    const leafless::solid both = leafless::solid::combine(LEAFLESS_OPERATION_UNION, leafless::refs(several));
    const leafless::octree built = leafless::octree::build(both, FRAME, LEAFLESS_RULE_CERTIFIED);
    const leafless_interval volume = built.statistics().volume_model;
    CHECK(volume.lower <= 1 + VOLUME * 7 / 8 && 1 + VOLUME * 7 / 8 <= volume.upper);
}

void questions() {
    const leafless::solid whole = leafless::solid::new_ball({0, 0, 0}, 0.5);
    const leafless::octree octree = leafless::octree::build(whole, FRAME, LEAFLESS_RULE_CERTIFIED);
    const std::vector<leafless::point> points = {{0, 0, 0}, {0.9, 0, 0}, {0.5, 0, 0}};
    std::array<leafless_membership, 3> found;
    octree.contains_many(points, found);
    CHECK(found[0] == LEAFLESS_MEMBERSHIP_INSIDE && found[1] == LEAFLESS_MEMBERSHIP_OUTSIDE);
    CHECK(octree.contains({0, 0, 0}) == LEAFLESS_MEMBERSHIP_INSIDE);
    // No room for all answers.
    try {
        octree.contains_many(points, leafless::span<leafless_membership>(found.data(), 2));
        CHECK(false);
    } catch (const std::invalid_argument &) {
    }
    const leafless_measures measures = whole.measure(FRAME, 1e-3, 0);
    CHECK(measures.volume_model.lower <= VOLUME && VOLUME <= measures.volume_model.upper);
    // Buffers filled in two calls, several results, and optional arguments.
    const std::vector<leafless_statistics> levels = octree.levels();
    CHECK(levels.size() == 7 || !levels.empty());
    const auto [inner, outer] = octree.bitmap(6, {0, 0, 0}, {64, 64, 64});
    CHECK(inner.size() == 64 * 64 && outer.size() == inner.size());
    const leafless_ray ray = {{-0.9, 0, 0}, {1, 0, 0}, 10};
    const auto [sure, possible] = octree.ray_spans(ray);
    CHECK(sure.size() == 1 && possible.size() == 1 && possible[0].lower <= sure[0].lower);
    const std::vector<leafless_interval> heights = octree.heights(2, nullptr, nullptr, LEAFLESS_SIDE_ABOVE);
    CHECK(heights.size() == 64 * 64);
    const leafless::mesh mesh = octree.resolve(LEAFLESS_RULE_OUTER).surface();
    const leafless_mesh_info info = mesh.describe();
    const std::uint64_t vertices = info.vertices, triangles = info.triangles;
    CHECK(info.bytes >= 24 * vertices + 12 * triangles && info.attributes == 0);
    CHECK(vertices > 0 && mesh.normals().size() == vertices);
    std::vector<leafless::point> places(static_cast<std::size_t>(vertices));
    std::vector<leafless::cell_index> corners(static_cast<std::size_t>(triangles));
    mesh.copy(places, corners);
    CHECK(corners.back()[2] < vertices);
    // Texts.
    const leafless::octree named = octree.with_metadata("name", "ball");
    CHECK(named.peek_metadata("name") == "ball" && named.peek_metadata("other").data() == nullptr);
    const auto [count, key, value] = named.peek_metadata_at(0);
    CHECK(count == 1 && key == "name" && value == "ball");
}

void failures() {
    try {
        static_cast<void>(leafless::solid::new_ball({0, 0, 0}, -1));
        CHECK(false);
    } catch (const leafless::error &failure) {
        CHECK(failure.status() == LEAFLESS_E_ARGUMENT && std::string(failure.what()).find("radius") == 0);
    }
    // An exception in a lambda comes out unchanged, whichever thread threw it.
    for (const std::uint32_t threads : {1u, 4u}) {
        leafless_options options = LEAFLESS_INIT(leafless_options);
        options.threads = threads;
        const auto thrown = [](const leafless::point &min, const leafless::point &max) -> leafless_tag {
            if (max[0] - min[0] < 0.1) throw host_failure{42};
            return LEAFLESS_TAG_PARTIAL;
        };
        const leafless::solid bad = leafless::solid_of(thrown, LEAFLESS_EXTERIOR_EMPTY);
        try {
            static_cast<void>(leafless::octree::build(bad, FRAME, LEAFLESS_RULE_CERTIFIED, &options));
            CHECK(false);
        } catch (const host_failure &failure) {
            CHECK(failure.number == 42);
        }
    }
    // Several at once keep theirs apart.
    std::vector<std::thread> threads;
    for (int number = 0; number < 4; number++) {
        threads.emplace_back([number] {
            for (int i = 0; i < 50; i++) {
                const auto thrown = [=](const leafless::point &, const leafless::point &) -> leafless_tag {
                    throw host_failure{1000 * number + i};
                };
                const leafless::solid bad = leafless::solid_of(thrown, LEAFLESS_EXTERIOR_EMPTY);
                try {
                    static_cast<void>(leafless::octree::build(bad, FRAME, LEAFLESS_RULE_CERTIFIED));
                    CHECK(false);
                } catch (const host_failure &failure) {
                    CHECK(failure.number == 1000 * number + i);
                }
            }
        });
    }
    for (std::thread &thread : threads) thread.join();
    // A lambda that answers nonsense.
    const leafless::solid mad = leafless::solid_of(
        [](const leafless::point &, const leafless::point &) { return static_cast<leafless_tag>(77); },
        LEAFLESS_EXTERIOR_EMPTY);
    try {
        static_cast<void>(leafless::octree::build(mad, FRAME, LEAFLESS_RULE_CERTIFIED));
        CHECK(false);
    } catch (const leafless::error &failure) {
        CHECK(failure.status() == LEAFLESS_E_CALLBACK && leafless_last_code() == 77);
    }
}

void hosts() {
    const leafless::octree expected = leafless::octree::build(
        leafless::solid_of(classify, LEAFLESS_EXTERIOR_EMPTY), FRAME, LEAFLESS_RULE_CERTIFIED);
    const leafless_interval volume = expected.statistics().volume_model;
    CHECK(volume.lower <= VOLUME && VOLUME <= volume.upper);
    // The context is given back with the last reference.
    const ball shape;
    CHECK(shape.calls.use_count() == 1);
    {
        const leafless::solid solid = leafless::solid_of(shape, LEAFLESS_EXTERIOR_EMPTY);
        CHECK(shape.calls.use_count() == 2);
        const leafless::octree octree = leafless::octree::build(solid, FRAME, LEAFLESS_RULE_CERTIFIED);
        CHECK(octree.equal(expected));
        static_cast<void>(leafless::octree::build(solid, FRAME, LEAFLESS_RULE_SAMPLED));
        const leafless_measures measures = solid.measure(FRAME, 1e-3, 0);
        CHECK(measures.volume_model.lower <= VOLUME && VOLUME <= measures.volume_model.upper);
        CHECK((*shape.calls & (4 | 8 | 16 | 32)) == (4 | 8 | 16 | 32));
    }
    CHECK(shape.calls.use_count() == 1);
    // What the library refuses is not kept either.
    try {
        static_cast<void>(leafless::solid_of(shape, static_cast<leafless_exterior>(9)));
        CHECK(false);
    } catch (const leafless::error &failure) {
        CHECK(failure.status() == LEAFLESS_E_ARGUMENT);
    }
    CHECK(shape.calls.use_count() == 1);

    struct plane {
        double value(const leafless::point &at) const { return -at[0]; }
        leafless_interval range(const leafless::point &min, const leafless::point &max) const {
            return {-max[0], -min[0]};
        }
    };
    const leafless::solid half = leafless::half_space_of(plane());
    const leafless_interval content =
        leafless::octree::build(half, FRAME, LEAFLESS_RULE_CERTIFIED).statistics().volume_model;
    CHECK(content.lower == 4 && content.upper == 4);

    const leafless::attribute height = leafless::attribute_of(
        [](const leafless::point &at, leafless::span<double> value) { value[0] = at[2]; }, 1);
    const std::array<leafless::point, 2> points = {{{0, 0, 0.25}, {0, 0, -0.5}}};
    std::array<double, 2> values = {0, 0};
    height.values(points, values);
    try {
        height.values(points, leafless::span<double>(values.data(), 1));
        CHECK(false);
    } catch (const std::invalid_argument &) {
    }
    CHECK(values[0] == 0.25 && values[1] == -0.5 && height.describe().components == 1);
    struct colour {
        void values(leafless::span<const leafless::point> at, leafless::span<double> found) const {
            CHECK(found.size() == 3 * at.size());
            for (std::size_t i = 0; i < at.size(); i++) {
                for (std::size_t axis = 0; axis < 3; axis++) found[3 * i + axis] = at[i][axis];
            }
        }
        void range(const leafless::point &min, const leafless::point &max, leafless_value_range &range) const {
            range.kind = LEAFLESS_RANGE_KIND_WITHIN;
            for (std::size_t axis = 0; axis < 3; axis++) range.values[axis] = {min[axis], max[axis]};
        }
    };
    std::array<double, 6> colours = {};
    leafless::attribute_of(colour(), 3).values(points, colours);
    try {
        leafless::attribute_of(colour(), 3).values(points, leafless::span<double>(colours.data(), 5));
        CHECK(false);
    } catch (const std::invalid_argument &) {
    }
    // A picture that is too small for its size.
    std::vector<std::uint8_t> small(4 * 8 * 8 - 1);
    try {
        leafless::picture_write(small, 8, 8, leafless_to_file("wrapper.png"));
        CHECK(false);
    } catch (const std::invalid_argument &) {
    }
    CHECK(colours[2] == 0.25 && colours[5] == -0.5);
    const leafless::attribute failing = leafless::attribute_of(
        [](const leafless::point &, leafless::span<double>) { throw host_failure{7}; }, 1);
    try {
        failing.values(points, values);
        CHECK(false);
    } catch (const host_failure &failure) {
        CHECK(failure.number == 7);
    }
}

void progress() {
    const leafless::solid whole = leafless::solid::new_ball({0, 0, 0}, 0.5);
    leafless_frame frame = FRAME;
    frame.depth = 8;
    double done = 0;
    const auto build = [&](const leafless_options &options) {
        return leafless::octree::build(whole, frame, LEAFLESS_RULE_CERTIFIED, &options);
    };
    const leafless_options options = LEAFLESS_INIT(leafless_options);
    const leafless::octree octree = leafless::with_progress(
        options, [&](double fraction) { return (done = std::max(done, fraction)) >= 0; }, build);
    CHECK(octree && done == 1);
    try {
        static_cast<void>(leafless::with_progress(options, [](double) { return false; }, build));
        CHECK(false);
    } catch (const leafless::error &failure) {
        CHECK(failure.status() == LEAFLESS_E_CANCELLED);
    }
    try {
        static_cast<void>(
            leafless::with_progress(options, [](double) -> bool { throw host_failure{3}; }, build));
        CHECK(false);
    } catch (const host_failure &failure) {
        CHECK(failure.number == 3);
    }
    const leafless::control control = leafless::control::make();
    control.cancel();
    leafless_options cancelled = options;
    cancelled.control = control.get();
    try {
        static_cast<void>(build(cancelled));
        CHECK(false);
    } catch (const leafless::error &failure) {
        CHECK(failure.status() == LEAFLESS_E_CANCELLED);
    }
}

void files() {
    const leafless::octree octree = leafless::octree::build(leafless::solid::new_ball({0, 0, 0}, 0.5), FRAME,
                                                            LEAFLESS_RULE_CERTIFIED);
    std::vector<std::uint8_t> bytes;
    auto take = [&](leafless::span<const std::uint8_t> piece) { bytes.insert(bytes.end(), piece.begin(), piece.end()); };
    octree.write(leafless::sink_to(take));
    const auto copied = leafless_from_bytes(bytes.data(), bytes.size(), LEAFLESS_ACCESS_COPY);
    CHECK(leafless::octree::read(copied).equal(octree));
    octree.write(leafless_to_file("wrapper.lfl"));
    const leafless::octree mapped =
        leafless::octree::read(leafless_from_file("wrapper.lfl", LEAFLESS_ACCESS_MAP_VERIFIED));
    CHECK(mapped.equal(octree));
    auto refuse = [](leafless::span<const std::uint8_t>) { throw host_failure{11}; };
    try {
        octree.write(leafless::sink_to(refuse));
        CHECK(false);
    } catch (const host_failure &failure) {
        CHECK(failure.number == 11);
    }
    try {
        static_cast<void>(leafless::octree::read(leafless_from_file("no/such.lfl", LEAFLESS_ACCESS_MAP)));
        CHECK(false);
    } catch (const leafless::error &failure) {
        CHECK(failure.status() == LEAFLESS_E_IO && std::string(failure.what()).find("no/such.lfl") == 0);
    }
}

void walks() {
    const leafless::solid whole = leafless::solid::new_ball({0, 0, 0}, 0.5);
    const leafless::octree octree = leafless::octree::build(whole, FRAME, LEAFLESS_RULE_CERTIFIED);
    leafless::cells full = leafless::cells::make(octree, LEAFLESS_TAGS_FULL, 0, 20);
    std::uint64_t count = 0;
    for (const leafless_cell &cell : leafless::each(full)) count += cell.tag == LEAFLESS_TAG_FULL;
    CHECK(count == octree.statistics().full && count > 0);
    // A walk that has ended finds nothing more, and begins anew where it is sent.
    for (const leafless_cell &cell : leafless::each(full)) CHECK(cell.level > 20);
    full.seek({0, 0, 0}, 0);
    std::uint64_t again = 0;
    for (auto it = leafless::each(full).begin(); it != leafless::each(full).end(); ++it) again += it->level > 0;
    CHECK(again == count);
    const leafless::octree outer = octree.resolve(LEAFLESS_RULE_OUTER);
    leafless::faces boundary = leafless::faces::make(outer, LEAFLESS_TAGS_FULL, 0, 20);
    double area = 0;
    for (const leafless_boundary_face &face : leafless::each(boundary)) {
        const double edge = 2.0 / static_cast<double>(1u << std::max(face.inner.level, face.outer.level));
        area += edge * edge;
    }
    // Axis-aligned faces have at least the area of the ball's shadows.
    CHECK(area > 6 * 3.14159265 / 4);
}

} // namespace

int main() {
    owners();
    questions();
    failures();
    hosts();
    progress();
    files();
    walks();
    return 0;
}
