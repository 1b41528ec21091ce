/* Volumes and surfaces from C++: owning pointers, many threads on one volume, progress, cancelling from outside. */
#include "check.h"

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

namespace {

template <typename T, void (*FREE)(T *)> struct deleter {
    void operator()(T *handle) const { FREE(handle); }
};
using volume_ptr = std::unique_ptr<leafless_volume, deleter<leafless_volume, leafless_volume_free>>;
using solid_ptr = std::unique_ptr<leafless_solid, deleter<leafless_solid, leafless_solid_free>>;
using octree_ptr = std::unique_ptr<leafless_octree, deleter<leafless_octree, leafless_octree_free>>;
using mesh_ptr = std::unique_ptr<leafless_mesh, deleter<leafless_mesh, leafless_mesh_free>>;
using control_ptr = std::unique_ptr<leafless_control, deleter<leafless_control, leafless_control_free>>;

constexpr int SIDE = 72;

/* Shells around the middle. */
std::vector<uint16_t> shells() {
    std::vector<uint16_t> samples;
    for (int z = 0; z < SIDE; z++) {
        for (int y = 0; y < SIDE; y++) {
            for (int x = 0; x < SIDE; x++) {
                const double r = std::sqrt(double((x - 36) * (x - 36) + (y - 36) * (y - 36) + (z - 36) * (z - 36)));
                samples.push_back(static_cast<uint16_t>(1000 + 900 * std::cos(r / 2)));
            }
        }
    }
    return samples;
}

volume_ptr view(const std::vector<uint16_t> &samples) {
    leafless_volume_layout layout;
    OK(leafless_init(&layout, sizeof layout));
    layout.sample_type = LEAFLESS_SAMPLE_TYPE_U16;
    for (uint32_t &extent : layout.extents) extent = SIDE;
    leafless_volume *volume = nullptr;
    OK(volume_in_place(&layout, samples.data(), 2 * samples.size(), &volume));
    return volume_ptr(volume);
}

octree_ptr voxels(const leafless_volume *volume, double threshold) {
    const leafless_interval band = {threshold, INFINITY};
    leafless_frame frame;
    leafless_solid *solid = nullptr;
    leafless_octree *octree = nullptr;
    OK(leafless_volume_frame(volume, &frame));
    OK(leafless_solid_from_volume(volume, &band, nullptr, &solid));
    const solid_ptr owner(solid);
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_SAMPLED, nullptr, &octree));
    return octree_ptr(octree);
}

mesh_ptr surface_of(const leafless_octree *octree, uint32_t threads) {
    leafless_options options;
    OK(leafless_init(&options, sizeof options));
    options.threads = threads;
    leafless_mesh *mesh = nullptr;
    OK(leafless_octree_surface(octree, nullptr, &options, &mesh));
    return mesh_ptr(mesh);
}

struct arrays {
    std::vector<double> vertices;
    std::vector<uint32_t> triangles;
    explicit arrays(const leafless_mesh *mesh) {
        uint64_t vertex_count, triangle_count;
        OK(check_counts(mesh, &vertex_count, &triangle_count));
        vertices.resize(3 * vertex_count);
        triangles.resize(3 * triangle_count);
        OK(leafless_mesh_copy(mesh, vertices.data(), vertex_count, triangles.data(), triangle_count));
    }
    bool operator==(const arrays &other) const {
        return vertices == other.vertices && triangles == other.triangles;
    }
};

/* Many threads on one fresh volume, each with bands of its own. */
void threads_on_one_volume(const std::vector<uint16_t> &samples) {
    std::vector<arrays> expected;
    for (int i = 0; i < 4; i++) {
        expected.emplace_back(surface_of(voxels(view(samples).get(), 600 + 200 * i).get(), 1).get());
        CHECK(expected.back().triangles.size() > 10000);
    }
    const volume_ptr volume = view(samples);
    std::vector<std::thread> threads;
    for (int t = 0; t < 8; t++) {
        threads.emplace_back([&, t] {
            for (int i = 0; i < 4; i++) {
                const int band = (i + t) % 4;
                const octree_ptr octree = voxels(volume.get(), 600 + 200 * band);
                CHECK(arrays(surface_of(octree.get(), 1 + t % 2).get()) == expected[band]);
                leafless_interval range;
                OK(leafless_volume_range(volume.get(), nullptr, &range));
                CHECK(range.lower >= 100 && range.upper <= 1900 && range.lower < range.upper);
            }
        });
    }
    for (std::thread &thread : threads) thread.join();
}

/* Progress ascends, and can end the work at any time. */
void progress(const std::vector<uint16_t> &samples) {
    struct heard {
        double last = 0;
        int calls = 0, most = -1;
    };
    const octree_ptr octree = voxels(view(samples).get(), 1000);
    const leafless_progress_fn hear = [](void *ctx, double fraction) -> int32_t {
        heard &all = *static_cast<heard *>(ctx);
        CHECK(fraction >= all.last && fraction <= 1);
        all.last = fraction;
        return all.calls++ == all.most;
    };
    leafless_options options;
    OK(leafless_init(&options, sizeof options));
    heard whole;
    options.threads = 1;
    options.progress = hear;
    options.progress_ctx = &whole;
    leafless_mesh *mesh = nullptr;
    OK(leafless_octree_surface(octree.get(), nullptr, &options, &mesh));
    const mesh_ptr owner(mesh);
    CHECK(whole.calls > 0 && whole.last > 0.99);
    for (int most = 0; most + 1 < whole.calls; most += 1 + whole.calls / 8) {
        heard some;
        some.most = most;
        options.progress_ctx = &some;
        leafless_mesh *none = nullptr;
        FAILS(LEAFLESS_E_CANCELLED, leafless_octree_surface(octree.get(), nullptr, &options, &none));
        CHECK(none == nullptr && some.calls >= most + 1);
    }
}

/* Another thread ends it; whether in time or not, the call returns, and a mesh is whole. */
void cancelling() {
    const leafless_frame frame = check_frame(9);
    const solid_ptr ball(check_ball_solid());
    leafless_control *control = nullptr;
    OK(leafless_control_new(&control));
    const control_ptr owner(control);
    leafless_options options;
    OK(leafless_init(&options, sizeof options));
    options.control = control;
    leafless_surface_options surface;
    OK(leafless_init(&surface, sizeof surface));
    surface.placement = LEAFLESS_VERTEX_PLACEMENT_CROSSING;
    std::atomic<bool> is_done{false};
    std::thread other([&] {
        double fraction = 0;
        while (!is_done && fraction < 0.1) {
            OK(leafless_control_state(control, nullptr, &fraction));
            std::this_thread::yield();
        }
        OK(leafless_control_cancel(control));
    });
    leafless_mesh *mesh = nullptr;
    const leafless_status status = leafless_solid_surface(ball.get(), &frame, &surface, &options, &mesh);
    is_done = true;
    other.join();
    CHECK(status == LEAFLESS_E_CANCELLED ? mesh == nullptr : status == LEAFLESS_OK);
    leafless_mesh_free(mesh);
}

} // namespace

int main() {
    const std::vector<uint16_t> samples = shells();
    threads_on_one_volume(samples);
    progress(samples);
    cancelling();
    return 0;
}
