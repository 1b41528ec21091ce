// Long operations can be watched and stopped: by the progress callback's result, and from other threads.
#include "check.h"

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace {

struct Watch {
    std::vector<double> fractions;
    std::thread::id thread;
    bool same_thread = true;
    std::size_t most = SIZE_MAX;
};

int32_t watch(void *ctx, double fraction) {
    Watch &watch = *static_cast<Watch *>(ctx);
    watch.same_thread = watch.same_thread && std::this_thread::get_id() == watch.thread;
    watch.fractions.push_back(fraction);
    return watch.fractions.size() >= watch.most ? -5 : 0;
}

leafless_options watched(Watch &watched_by) {
    leafless_options options;
    OK(leafless_init(&options, sizeof options));
    options.threads = 1;
    options.progress = watch;
    options.progress_ctx = &watched_by;
    watched_by.thread = std::this_thread::get_id();
    return options;
}

// With one thread, progress comes from the calling thread, never falls, and ends at 1.
void progress_is_monotone() {
    const leafless_frame frame = check_frame(7);
    leafless_solid *solid = check_ball_solid();
    leafless_octree *ball = nullptr, *box = check_box(7, -0.5, 0.875), *result = nullptr;
    for (int operation = 0; operation < 4; operation++) {
        Watch seen;
        const leafless_options options = watched(seen);
        switch (operation) {
            case 0: OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &ball)); break;
            case 1: OK(check_octrees(LEAFLESS_OPERATION_DIFFERENCE, box, ball, &options, &result)); break;
            case 2: OK(leafless_octree_resolve(ball, LEAFLESS_RULE_INNER, &options, &result)); break;
            default: OK(leafless_octree_complement(ball, &options, &result)); break;
        }
        CHECK(seen.same_thread);
        CHECK(!seen.fractions.empty());
        double last = 0.0;
        for (const double fraction : seen.fractions) {
            CHECK(fraction >= last && fraction <= 1.0);
            last = fraction;
        }
        if (last != 1.0) {
            fprintf(stderr, "operation %d ends at %.17g\n", operation, last);
            exit(1);
        }
        leafless_octree_free(result);
        result = nullptr;
    }
    leafless_octree_free(ball);
    leafless_octree_free(box);
    leafless_solid_free(solid);
}

// Whenever the callback says so, the operation ends with nothing but a status.
void callback_cancels() {
    const leafless_frame frame = check_frame(6);
    leafless_solid *solid = check_ball_solid();
    leafless_octree *ball = check_ball(6, LEAFLESS_RULE_CERTIFIED);
    Watch all;
    const leafless_options options = watched(all);
    leafless_octree *octree = nullptr;
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &octree));
    leafless_octree_free(octree);
    octree = nullptr;
    CHECK(all.fractions.size() > 2);
    int cancelled = 0;
    for (std::size_t most = 1; most < all.fractions.size(); most++) {
        Watch some;
        some.most = most;
        const leafless_options stopping = watched(some);
        const leafless_status status =
            leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &stopping, &octree);
        if (status == LEAFLESS_OK) {
            // Nothing was left to be stopped.
            CHECK(check_same(octree, ball));
            leafless_octree_free(octree);
            octree = nullptr;
        } else {
            CHECK(status == LEAFLESS_E_CANCELLED && octree == nullptr);
            cancelled++;
        }
        // Without a control of the host it concerns that call only.
    }
    CHECK(cancelled > 0);
    leafless_octree_free(ball);
    leafless_solid_free(solid);
}

struct Slow {
    std::atomic<bool> started{false};
    std::atomic<long> calls{0};
};

// A slow shape that is never decided: without a cancel, the work would take too long.
int32_t endless(void *ctx, const double *, const double *) {
    Slow &slow = *static_cast<Slow *>(ctx);
    slow.started = true;
    slow.calls++;
    std::this_thread::sleep_for(std::chrono::microseconds(20));
    return LEAFLESS_TAG_PARTIAL;
}

void another_thread_cancels(uint32_t threads) {
    const leafless_frame frame = check_frame(12);
    Slow slow;
    leafless_solid_callbacks callbacks = {};
    callbacks.struct_size = sizeof callbacks;
    callbacks.classify = endless;
    callbacks.ctx = &slow;
    leafless_solid *solid = nullptr;
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    leafless_control *control = nullptr;
    OK(leafless_control_new(&control));
    leafless_options options;
    OK(leafless_init(&options, sizeof options));
    options.threads = threads;
    options.control = control;

    leafless_status status = LEAFLESS_OK;
    leafless_octree *octree = nullptr;
    std::thread worker([&] {
        status = leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &octree);
    });
    while (!slow.started) {
        std::this_thread::yield();
    }
    bool cancelled = true;
    double fraction = -1.0;
    OK(leafless_control_state(control, &cancelled, &fraction));
    CHECK(!cancelled && fraction >= 0.0 && fraction < 1.0);
    OK(leafless_control_cancel(control));
    worker.join();
    CHECK(status == LEAFLESS_E_CANCELLED && octree == nullptr);
    // Nothing goes on behind the back.
    const long calls = slow.calls;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    CHECK(slow.calls == calls);

    // It stays so, for everything that runs with this control, until it is reset.
    leafless_octree *ball = check_ball(5, LEAFLESS_RULE_CERTIFIED), *result = nullptr;
    OK(leafless_control_state(control, &cancelled, nullptr));
    CHECK(cancelled);
    FAILS(LEAFLESS_E_CANCELLED, leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &octree));
    FAILS(LEAFLESS_E_CANCELLED, check_octrees(LEAFLESS_OPERATION_UNION, ball, ball, &options, &result));
    FAILS(LEAFLESS_E_CANCELLED, leafless_octree_complement(ball, &options, &result));
    FAILS(LEAFLESS_E_CANCELLED, leafless_octree_resolve(ball, LEAFLESS_RULE_INNER, &options, &result));
    const leafless_octree *both[] = {ball, ball};
    FAILS(LEAFLESS_E_CANCELLED, leafless_octree_combine(LEAFLESS_OPERATION_UNION, both, 2, &options, &result));
    CHECK(result == nullptr);
    OK(leafless_control_reset(control));
    OK(check_octrees(LEAFLESS_OPERATION_UNION, ball, ball, &options, &result));
    CHECK(check_same(ball, result));
    OK(leafless_control_state(control, &cancelled, &fraction));
    CHECK(!cancelled && fraction == 1.0);

    leafless_octree_free(result);
    leafless_octree_free(ball);
    leafless_control_free(control);
    leafless_solid_free(solid);
}

// What the callback returns is kept in the host's control.
void callback_cancels_the_control() {
    const leafless_frame frame = check_frame(6);
    leafless_solid *solid = check_ball_solid();
    leafless_control *control = nullptr;
    OK(leafless_control_new(&control));
    Watch first;
    first.most = 1;
    leafless_options options = watched(first);
    options.control = control;
    leafless_octree *octree = nullptr;
    FAILS(LEAFLESS_E_CANCELLED, leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &octree));
    bool cancelled = false;
    OK(leafless_control_state(control, &cancelled, nullptr));
    CHECK(cancelled);
    leafless_control_free(control);
    leafless_solid_free(solid);
}

thread_local int depth = 0;

struct Inner {
    leafless_solid *ball;
    std::atomic<long> calls{0};
    std::atomic<bool> entered_again{false};
};

// A classifier that builds an octree of its own for each query of a large box.
int32_t builds(void *ctx, const double *min, const double *max) {
    Inner &inner = *static_cast<Inner *>(ctx);
    inner.calls++;
    if (depth != 0) inner.entered_again = true;
    depth++;
    if (max[0] - min[0] > 0.2) {
        const leafless_frame frame = check_frame(7);
        leafless_octree *octree = nullptr;
        OK(leafless_octree_build(inner.ball, &frame, LEAFLESS_RULE_CERTIFIED, nullptr, &octree));
        leafless_octree_free(octree);
    }
    depth--;
    return max[0] <= 0.3 ? LEAFLESS_TAG_EMPTY : min[0] >= 0.3 ? LEAFLESS_TAG_FULL : LEAFLESS_TAG_PARTIAL;
}

// While the library runs a function of the host, it does not call that again in the same thread.
void functions_are_not_entered_again() {
    const leafless_frame frame = check_frame(7);
    Inner inner;
    inner.ball = check_ball_solid();
    leafless_solid_callbacks callbacks;
    OK(leafless_init(&callbacks, sizeof callbacks));
    callbacks.classify = builds;
    callbacks.ctx = &inner;
    leafless_solid *solid = nullptr;
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    leafless_options options;
    OK(leafless_init(&options, sizeof options));
    options.threads = 4;
    leafless_octree *octree = nullptr;
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &octree));
    CHECK(inner.calls > 100);
    CHECK(!inner.entered_again);
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    leafless_solid_free(inner.ball);
}

}  // namespace

int main() {
    functions_are_not_entered_again();
    progress_is_monotone();
    callback_cancels();
    another_thread_cancels(1);
    another_thread_cancels(4);
    callback_cancels_the_control();
    return 0;
}
