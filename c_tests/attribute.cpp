// A lambda as an attribute, called from many threads at once; eight threads on one channel; progress and cancelling.
#include "check.h"

#include <atomic>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

namespace {

struct Free {
    void operator()(leafless_attribute *attribute) const { leafless_attribute_free(attribute); }
    void operator()(leafless_channel *channel) const { leafless_channel_free(channel); }
    void operator()(leafless_octree *octree) const { leafless_octree_free(octree); }
    void operator()(leafless_control *control) const { leafless_control_free(control); }
};
using Attribute = std::unique_ptr<leafless_attribute, Free>;
using Channel = std::unique_ptr<leafless_channel, Free>;
using Octree = std::unique_ptr<leafless_octree, Free>;

using Function = std::function<double(const double *)>;

// The attribute owns the function.
Attribute attribute_of(Function function) {
    leafless_attribute_callbacks callbacks;
    OK(leafless_init(&callbacks, sizeof callbacks));
    callbacks.components = 1;
    callbacks.values = [](void *ctx, const double *points, uint64_t count, double *values) -> int32_t {
        const Function &function = *static_cast<Function *>(ctx);
        for (uint64_t i = 0; i < count; i++) values[i] = function(points + 3 * i);
        return 0;
    };
    callbacks.destroy = [](void *ctx) { delete static_cast<Function *>(ctx); };
    callbacks.ctx = new Function(std::move(function));
    leafless_attribute *attribute = nullptr;
    OK(leafless_attribute_new_callbacks(&callbacks, &attribute));
    return Attribute(attribute);
}

Channel filled(const Attribute &attribute, const leafless_frame &frame, uint32_t threads) {
    leafless_options options;
    OK(leafless_init(&options, sizeof options));
    options.threads = threads;
    leafless_channel *channel = nullptr;
    OK(leafless_channel_fill(attribute.get(), &frame, nullptr, &options, &channel));
    return Channel(channel);
}

double grain(const double *at) { return std::fmod(at[0] * 37 + at[1] * 91 + at[2] * 11 + 400, 17); }

void many_threads() {
    const leafless_frame frame = check_frame(6);
    std::atomic<int> asked{0};
    std::mutex mutex;
    std::set<std::thread::id> threads;
    const Attribute attribute = attribute_of([&](const double *at) {
        if (asked++ % 64 == 0) {
            std::lock_guard<std::mutex> lock(mutex);
            threads.insert(std::this_thread::get_id());
        }
        return grain(at);
    });
    const Channel several = filled(attribute, frame, 4);
    CHECK(asked == 64 * 64 * 64);
    CHECK(threads.size() >= 1 && threads.size() <= 5);
    // With one thread it is the calling one.
    threads.clear();
    asked = 0;
    const Channel one = filled(attribute, frame, 1);
    CHECK(threads.size() == 1 && *threads.begin() == std::this_thread::get_id());
    bool equal = false;
    OK(leafless_channel_equal(one.get(), several.get(), &equal));
    CHECK(equal);

    // If it is mapped unverified, the first query checks its links.
    static const char PATH[] = "attribute.lfl";
    leafless_octree *solid = nullptr, *with = nullptr, *mapped = nullptr;
    OK(leafless_octree_new_uniform(&frame, LEAFLESS_TAG_FULL, LEAFLESS_TAG_EMPTY, &solid));
    OK(leafless_octree_with_channel(solid, one.get(), &with));
    OK(octree_save(with, PATH, std::strlen(PATH)));
    OK(octree_map(PATH, std::strlen(PATH), &mapped));
    const Octree keep[3] = {Octree(solid), Octree(with), Octree(mapped)};
    std::vector<std::thread> readers;
    for (int t = 0; t < 8; t++) {
        readers.emplace_back([&keep, t] {
            leafless_channel *raw = nullptr;
            OK(leafless_octree_channel(keep[2].get(), "", 0, &raw));
            const Channel channel(raw);
            for (int i = 0; i < 2000; i++) {
                const int cell[3] = {(i * 31 + t) % 64, i % 64, t * 8};
                const double at[3] = {(cell[0] + 0.5) / 32 - 1, (cell[1] + 0.5) / 32 - 1, (cell[2] + 0.5) / 32 - 1};
                double value[4];
                OK(leafless_channel_value(channel.get(), at, value));
                CHECK(value[0] == static_cast<double>(static_cast<float>(grain(at))));
            }
        });
    }
    for (std::thread &reader : readers) reader.join();
}

// A function may use the library, and a channel as well.
void calls_within_calls() {
    const leafless_frame frame = check_frame(3);
    const Channel inner = filled(attribute_of(grain), frame, 1);
    const leafless_channel *channel = inner.get();
    const Attribute twice = attribute_of([channel](const double *at) {
        double value[4];
        OK(leafless_channel_value(channel, at, value));
        return 2 * value[0];
    });
    const Channel outer = filled(twice, frame, 0);
    const double at[3] = {0.3, -0.2, 0.7};
    double a[4], b[4];
    OK(leafless_channel_value(inner.get(), at, a));
    OK(leafless_channel_value(outer.get(), at, b));
    CHECK(b[0] == 2 * a[0]);
}

void progress_and_cancelling() {
    const leafless_frame frame = check_frame(6);
    const Attribute attribute = attribute_of(grain);
    std::atomic<int> reports{0};
    leafless_options options;
    OK(leafless_init(&options, sizeof options));
    options.progress_ctx = &reports;
    options.progress = [](void *ctx, double fraction) -> int32_t {
        CHECK(fraction >= 0 && fraction <= 1);
        ++*static_cast<std::atomic<int> *>(ctx);
        return 0;
    };
    leafless_channel *channel = nullptr;
    OK(leafless_channel_fill(attribute.get(), &frame, nullptr, &options, &channel));
    leafless_channel_free(channel);
    CHECK(reports > 0);
    // The attribute itself ends the work by way of a control.
    leafless_control *raw = nullptr;
    OK(leafless_control_new(&raw));
    const std::unique_ptr<leafless_control, Free> control(raw);
    const Attribute stops = attribute_of([raw](const double *at) {
        OK(leafless_control_cancel(raw));
        return grain(at);
    });
    options.progress = nullptr;
    options.control = raw;
    channel = nullptr;
    FAILS(LEAFLESS_E_CANCELLED, leafless_channel_fill(stops.get(), &frame, nullptr, &options, &channel));
    CHECK(channel == nullptr);
}

} // namespace

int main() {
    many_threads();
    calls_within_calls();
    progress_and_cancelling();
    return 0;
}
