// Mistakes of a careless host: counts that overflow, attributes with nonsensical answers that call back, an editor in many
// threads, layers that outlive their sources. Nothing crashes, and every returned status is documented.
#include "check.h"

#include <atomic>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <thread>
#include <vector>

namespace {

constexpr double NOT_A_NUMBER = std::numeric_limits<double>::quiet_NaN();
constexpr double INFINITE = std::numeric_limits<double>::infinity();

leafless_options with_threads(uint32_t threads) {
    leafless_options options;
    OK(leafless_init(&options, sizeof options));
    options.threads = threads;
    return options;
}

// --- Counts ------------------------------------------------------------------------------------------------------------

// Every function that takes a count refuses counts whose bytes do not fit into memory, also where the product wraps around
// to a small number.
void counts() {
    const leafless_frame frame = check_frame(3);
    leafless_octree *octree = check_ball(3, LEAFLESS_RULE_CERTIFIED);
    leafless_solid *solid = check_ball_solid();
    leafless_attribute *attribute = nullptr;
    const double one[4] = {1, 0, 0, 0};
    OK(leafless_attribute_new_constant(one, 1, &attribute));
    leafless_channel *channel = nullptr;
    OK(leafless_channel_fill(attribute, &frame, nullptr, nullptr, &channel));

    const double points[6] = {0, 0, 0, 1, 1, 1};
    double numbers[16] = {0};
    const uint64_t codes[2] = {0, 1};
    const uint8_t levels[2] = {3, 3}, colour[4] = {0, 0, 0, 255};
    const leafless_voxel_kind kinds[2] = {LEAFLESS_VOXEL_KIND_INSIDE, LEAFLESS_VOXEL_KIND_INSIDE};
    const leafless_cell cells[2] = {};
    const leafless_ray rays[2] = {};
    leafless_ray_hit hits[2];
    leafless_interval intervals[2];
    leafless_membership memberships[2];
    leafless_interference interferences[1];
    leafless_camera camera;
    leafless_layer *layer = nullptr;
    leafless_octree *result = nullptr;
    const leafless_octree *octrees[1] = {octree};
    const leafless_solid *solids[1] = {solid};
    uint64_t order[2], found;
    const uint32_t at[3] = {0, 0, 0};

    const std::function<leafless_status(uint64_t)> functions[] = {
        [&](uint64_t n) { return leafless_octree_contains_many(octree, points, n, memberships); },
        [&](uint64_t n) { return leafless_octree_cast_rays(octree, rays, n, LEAFLESS_OBSTACLE_FULL, hits); },
        [&](uint64_t n) { return leafless_octree_distances(octree, points, n, LEAFLESS_DISTANCE_TO_SOLID, nullptr, intervals); },
        [&](uint64_t n) { return leafless_channel_values(channel, points, n, numbers); },
        [&](uint64_t n) { return leafless_attribute_values(attribute, points, n, numbers); },
        [&](uint64_t n) {
            return leafless_octree_from_voxels(&frame, codes, levels, kinds, n, LEAFLESS_TAG_PARTIAL, nullptr, &result);
        },
        [&](uint64_t n) { return leafless_voxels_find(&frame, codes, levels, kinds, n, at, 3, &found); },
        [&](uint64_t n) {
            return leafless_voxels_order(&frame, codes, levels, kinds, n, points, false, nullptr, order, 2, &found);
        },
        [&](uint64_t n) { return leafless_camera_fitted(points, n, 0, 0, 0, 1, &camera); },
        [&](uint64_t n) { return leafless_layer_new_lines(points, n, 1, colour, &layer); },
        [&](uint64_t n) { return leafless_layer_new_cells(&frame, cells, n, 1, colour, &layer); },
        [&](uint64_t n) {
            return leafless_solid_interfere_many(solid, solid, &frame, numbers, n, &frame, 0, nullptr, interferences);
        },
        [&](uint64_t n) { return leafless_octree_combine(LEAFLESS_OPERATION_UNION, octrees, n, nullptr, &result); },
        [&](uint64_t n) {
            return leafless_solid_combine(LEAFLESS_OPERATION_UNION, solids, n, reinterpret_cast<leafless_solid **>(&result));
        },
        [&](uint64_t n) {
            leafless_voxel_arrays arrays;
            leafless_transfer transfer;
            OK(leafless_init(&arrays, sizeof arrays));
            OK(leafless_init(&transfer, sizeof transfer));
            arrays.lattice = frame;
            arrays.count = n;
            arrays.codes = codes;
            arrays.levels = levels;
            arrays.kinds = kinds;
            return leafless_layer_new_voxels(&arrays, &transfer, 0, &layer);
        },
    };
    // (Smaller arrays might exist; the library cannot know.)
    const uint64_t numbers_of_things[] = {UINT64_MAX,          UINT64_MAX / 8 + 2,  UINT64_MAX / 16 + 2,
                                          UINT64_C(1) << 63,   UINT64_C(1) << 61,   UINT64_C(1) << 60};
    for (const auto &function : functions) {
        for (const uint64_t n : numbers_of_things) {
            const leafless_status status = function(n);
            CHECK(status == LEAFLESS_E_ARGUMENT);
        }
    }
    CHECK(layer == nullptr && result == nullptr);
    leafless_channel_free(channel);
    leafless_attribute_free(attribute);
    leafless_solid_free(solid);
    leafless_octree_free(octree);
}

// --- Attributes that answer nonsense -----------------------------------------------------------------------------------

struct Nonsense {
    std::function<int32_t(const double *, double *)> value;
    std::function<int32_t(leafless_value_range *)> range;
    std::atomic<int> destroyed{0};
};

leafless_attribute *attribute_of(Nonsense &nonsense) {
    leafless_attribute_callbacks callbacks;
    OK(leafless_init(&callbacks, sizeof callbacks));
    callbacks.components = 1;
    callbacks.value = [](void *ctx, const double *point, double *value) -> int32_t {
        return static_cast<Nonsense *>(ctx)->value(point, value);
    };
    if (nonsense.range) {
        callbacks.range = [](void *ctx, const double *, const double *, leafless_value_range *range) -> int32_t {
            return static_cast<Nonsense *>(ctx)->range(range);
        };
    }
    callbacks.destroy = [](void *ctx) { static_cast<Nonsense *>(ctx)->destroyed++; };
    callbacks.ctx = &nonsense;
    leafless_attribute *attribute = nullptr;
    OK(leafless_attribute_new_callbacks(&callbacks, &attribute));
    return attribute;
}

bool is_expected(leafless_status status) {
    return status == LEAFLESS_OK || status == LEAFLESS_E_CALLBACK || status == LEAFLESS_E_ARGUMENT;
}

// Every function that queries an attribute queries this one.
void ask(const leafless_attribute *attribute, uint32_t threads) {
    const leafless_options options = with_threads(threads);
    const leafless_frame frame = check_frame(4);
    leafless_octree *octree = check_ball(4, LEAFLESS_RULE_SAMPLED);
    for (const leafless_criterion criterion :
         {LEAFLESS_CRITERION_NONE, LEAFLESS_CRITERION_VARIANCE, LEAFLESS_CRITERION_RANGE}) {
        leafless_channel_fill_options fill;
        OK(leafless_init(&fill, sizeof fill));
        fill.solid = octree;
        fill.criterion = criterion;
        if (criterion != LEAFLESS_CRITERION_NONE) {
            fill.coarse_model = 1;
            fill.fine_model = 0.125;
            fill.tolerance = 0.5;
        }
        leafless_channel *channel = nullptr;
        const leafless_status status = leafless_channel_fill(attribute, &frame, &fill, &options, &channel);
        CHECK(is_expected(status) && (channel != nullptr) == (status == LEAFLESS_OK));
        if (channel != nullptr) {
            leafless_channel_summary summary = LEAFLESS_INIT(leafless_channel_summary);
            OK(leafless_channel_check(channel));
            OK(leafless_channel_summarise(channel, octree, nullptr, nullptr, &options, &summary));
            leafless_channel_free(channel);
        }
        leafless_voxel_options voxels;
        OK(leafless_init(&voxels, sizeof voxels));
        voxels.attribute = attribute;
        voxels.criterion = criterion;
        voxels.coarse_model = 1;
        voxels.fine_model = 0.125;
        voxels.tolerance = 0.5;
        uint64_t count = 0;
        leafless_frame lattice;
        const leafless_status listed = leafless_octree_voxels(octree, &voxels, &options, &lattice, nullptr, nullptr, nullptr,
                                                              nullptr, nullptr, 0, &count);
        CHECK(is_expected(listed));
    }
    leafless_look look;
    leafless_transfer transfer;
    OK(leafless_init(&look, sizeof look));
    OK(leafless_init(&transfer, sizeof transfer));
    transfer.range_upper = 1;
    look.attribute = attribute;
    look.transfer = &transfer;
    leafless_layer *layer = nullptr;
    const leafless_status made = leafless_layer_from_octree(octree, &look, &layer);
    CHECK(is_expected(made));
    if (layer != nullptr) {
        leafless_shot shot;
        OK(leafless_init(&shot, sizeof shot));
        shot.width = shot.height = 24;
        const double corners[6] = {-1, -1, -1, 1, 1, 1};
        OK(leafless_camera_fitted(corners, 2, 30, 20, 0, 1, &shot.camera));
        std::vector<uint8_t> colours(4 * 24 * 24);
        CHECK(is_expected(leafless_picture_render(&shot, &layer, 1, &options, colours.data(), colours.size(), nullptr, 0)));
        leafless_layer_free(layer);
    }
    leafless_octree_free(octree);
}

void nonsense() {
    const double values[] = {NOT_A_NUMBER, INFINITE, -INFINITE, 1e308, -1e308, 5e-324, -0.0, 1.0};
    const double ends[][2] = {{1, 0},        {NOT_A_NUMBER, 1},     {0, NOT_A_NUMBER}, {-INFINITE, INFINITE},
                              {0.25, 0.25},  {INFINITE, -INFINITE}, {-1e308, 1e308},   {INFINITE, INFINITE}};
    for (const uint32_t threads : {1u, 2u}) {
        for (const double value : values) {
            Nonsense one{[=](const double *, double *to) { return *to = value, 0; }, nullptr};
            leafless_attribute *attribute = attribute_of(one);
            ask(attribute, threads);
            CHECK(one.destroyed == 0);
            leafless_attribute_free(attribute);
            CHECK(one.destroyed == 1);
        }
        for (const auto &end : ends) {
            for (const uint32_t kind : {0u, 1u, 2u, 3u, 77u, UINT32_MAX}) {
                Nonsense one{[](const double *at, double *to) { return *to = at[0], 0; },
                             [&](leafless_value_range *range) {
                                 range->kind = kind;
                                 range->values[0].lower = end[0];
                                 range->values[0].upper = end[1];
                                 return 0;
                             }};
                leafless_attribute *attribute = attribute_of(one);
                ask(attribute, threads);
                leafless_attribute_free(attribute);
                CHECK(one.destroyed == 1);
            }
        }
        // Another answer each time, and errors of any number.
        std::atomic<uint32_t> asked{0};
        Nonsense fickle{[&](const double *, double *to) {
                            const uint32_t n = asked++;
                            *to = n % 7 == 0 ? NOT_A_NUMBER : n;
                            return 0;
                        },
                        nullptr};
        leafless_attribute *attribute = attribute_of(fickle);
        ask(attribute, threads);
        leafless_attribute_free(attribute);
        for (const int32_t code : {1, -1, INT32_MAX, INT32_MIN}) {
            Nonsense failing{[=](const double *at, double *to) { return *to = 0, at[0] > 0 ? code : 0; }, nullptr};
            attribute = attribute_of(failing);
            ask(attribute, threads);
            leafless_attribute_free(attribute);
            CHECK(failing.destroyed == 1);
        }
    }
}

// --- Attributes that call back -----------------------------------------------------------------------------------------

// Each question is answered by the library itself: by queries, by pictures, by a channel that is filled within the call, and
// by the attribute itself, some calls deep.
void calls_from_within() {
    const leafless_frame frame = check_frame(2);
    leafless_octree *octree = check_ball(4, LEAFLESS_RULE_CERTIFIED);
    leafless_solid *solid = check_ball_solid();
    leafless_attribute *own = nullptr;
    thread_local int depth = 0;
    std::atomic<int> asked{0};
    Nonsense host{[&](const double *at, double *to) {
                      const int turn = asked++;
                      leafless_membership where;
                      OK(leafless_octree_contains(octree, at, &where));
                      *to = where;
                      if (depth < 3 && turn % 16 == 0) {
                          depth++;
                          double again[4];
                          OK(leafless_attribute_values(own, at, 1, again));
                          leafless_channel *channel = nullptr;
                          const leafless_frame coarse = check_frame(1);
                          const leafless_options options = with_threads(2);
                          OK(leafless_channel_fill(own, &coarse, nullptr, &options, &channel));
                          leafless_channel_free(channel);
                          leafless_octree *built = nullptr;
                          OK(leafless_octree_build(solid, &coarse, LEAFLESS_RULE_CERTIFIED, &options, &built));
                          leafless_octree_free(built);
                          depth--;
                      }
                      return 0;
                  },
                  nullptr};
    own = attribute_of(host);
    for (const uint32_t threads : {1u, 3u}) {
        const leafless_options options = with_threads(threads);
        leafless_channel *channel = nullptr;
        OK(leafless_channel_fill(own, &frame, nullptr, &options, &channel));
        const double middle[3] = {0.1, 0.1, 0.1};
        double value[4];
        OK(leafless_channel_values(channel, middle, 1, value));
        CHECK(value[0] == LEAFLESS_MEMBERSHIP_INSIDE);
        leafless_channel_free(channel);
        ask(own, threads);
    }
    leafless_attribute_free(own);
    CHECK(host.destroyed == 1);
    leafless_solid_free(solid);
    leafless_octree_free(octree);
}

// --- An editor in many threads -----------------------------------------------------------------------------------------

void editor_in_threads() {
    const leafless_frame frame = check_frame(5);
    const double min[3] = {-0.75, -0.75, -0.75}, max[3] = {0.75, 0.75, 0.75};
    leafless_solid *block = nullptr;
    OK(leafless_solid_new_box(min, max, &block));
    leafless_tridexel *model = nullptr;
    OK(leafless_tridexel_build(block, &frame, LEAFLESS_RULE_SAMPLED, nullptr, nullptr, &model));
    leafless_tridexel_editor *editor = nullptr;
    OK(leafless_tridexel_editor_new(model, &editor));
    std::atomic<int> done{0}, busy{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; t++) {
        threads.emplace_back([&, t] {
            const leafless_options options = with_threads(1);
            for (int i = 0; i < 60; i++) {
                const double centre[3] = {-0.7 + 0.023 * i, 0.2 * t - 0.3, 0.7};
                leafless_solid *ball = nullptr;
                OK(leafless_solid_new_ball(centre, 0.15, &ball));
                leafless_tridexel *frozen = nullptr;
                leafless_tridexel_info asked = LEAFLESS_INIT(leafless_tridexel_info);
                const leafless_status statuses[] = {
                    leafless_tridexel_editor_combine_solid(editor, LEAFLESS_OPERATION_DIFFERENCE, ball, &options, nullptr),
                    i % 8 == 0 ? leafless_tridexel_editor_freeze(editor, &options, &frozen) : LEAFLESS_OK,
                    leafless_tridexel_editor_describe(editor, &asked),
                };
                for (const leafless_status status : statuses) {
                    CHECK(status == LEAFLESS_OK || status == LEAFLESS_E_BUSY);
                    (status == LEAFLESS_OK ? done : busy)++;
                }
                if (frozen != nullptr) {
                    OK(leafless_tridexel_check(frozen));
                    leafless_tridexel_free(frozen);
                }
                leafless_solid_free(ball);
            }
        });
    }
    for (std::thread &thread : threads) thread.join();
    CHECK(done > 0 && done + busy == 4 * 60 * 3);
    // The editor continues, and its cuts stay: its model lies in the block.
    leafless_tridexel *left = nullptr, *beyond = nullptr;
    OK(leafless_tridexel_editor_freeze(editor, nullptr, &left));
    OK(leafless_tridexel_check(left));
    OK(check_tridexels(LEAFLESS_OPERATION_DIFFERENCE, left, model, nullptr, &beyond));
    for (uint32_t axis = 0; axis < 3; axis++) {
        leafless_dexel_statistics statistics = LEAFLESS_INIT(leafless_dexel_statistics);
        OK(leafless_tridexel_statistics(beyond, axis, &statistics));
        CHECK(statistics.intervals == 0);
        OK(leafless_tridexel_statistics(left, axis, &statistics));
        CHECK(statistics.intervals > 0);
    }
    leafless_tridexel_editor_free(editor);
    leafless_tridexel_free(beyond);
    leafless_tridexel_free(left);
    leafless_tridexel_free(model);
    leafless_solid_free(block);
}

// --- Layers that outlive their sources ---------------------------------------------------------------------------------

std::vector<uint8_t> picture(const std::vector<const leafless_layer *> &layers) {
    leafless_shot shot;
    OK(leafless_init(&shot, sizeof shot));
    shot.width = shot.height = 48;
    shot.samples = 4;
    const double corners[6] = {-1, -1, -1, 1, 1, 1};
    OK(leafless_camera_fitted(corners, 2, 30, 20, 0, 1, &shot.camera));
    std::vector<uint8_t> colours(4 * 48 * 48);
    OK(leafless_picture_render(&shot, layers.data(), layers.size(), nullptr, colours.data(), colours.size(), nullptr, 0));
    return colours;
}

void layers_outlive() {
    const leafless_frame frame = check_frame(4);
    leafless_octree *octree = check_ball(5, LEAFLESS_RULE_CERTIFIED);
    leafless_solid *solid = check_ball_solid();
    leafless_mesh *mesh = check_cube();
    const double one[4] = {0.5, 0, 0, 0}, plane[4] = {0, 0, 1, 0.1}, cut[4] = {1, 0, 0, 0.1};
    std::vector<double> line = {-1, -1, -1, 1, 1, 1};
    std::vector<leafless_cell> cells(1);
    std::vector<uint8_t> colour = {200, 10, 10, 255};
    leafless_attribute *attribute = nullptr;
    OK(leafless_attribute_new_constant(one, 1, &attribute));
    leafless_transfer transfer;
    OK(leafless_init(&transfer, sizeof transfer));
    transfer.range_upper = 1;
    leafless_look look;
    OK(leafless_init(&look, sizeof look));
    leafless_look coloured = look;
    coloured.attribute = attribute;
    coloured.transfer = &transfer;
    leafless_slice_look slice;
    OK(leafless_init(&slice, sizeof slice));

    std::vector<leafless_layer *> layers(7, nullptr);
    OK(leafless_layer_from_octree(octree, &coloured, &layers[0]));
    OK(leafless_layer_from_solid(solid, &frame, &look, &layers[1]));
    OK(leafless_layer_from_mesh(mesh, &look, &layers[2]));
    OK(leafless_layer_new_lines(line.data(), line.size() / 6, 1, colour.data(), &layers[3]));
    OK(leafless_layer_new_cells(&frame, cells.data(), cells.size(), 1, colour.data(), &layers[4]));
    OK(leafless_layer_from_octree_slice(octree, plane, &slice, &layers[5]));
    OK(leafless_layer_clipped(layers[0], cut, 1, nullptr, &layers[6]));
    std::vector<std::vector<uint8_t>> before;
    for (const leafless_layer *layer : layers) before.push_back(picture({layer}));

    // Everything that they were made of is gone, or is something else now.
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    leafless_mesh_free(mesh);
    leafless_attribute_free(attribute);
    std::memset(&transfer, 0xEE, sizeof transfer);
    std::memset(&look, 0xEE, sizeof look);
    std::memset(&coloured, 0xEE, sizeof coloured);
    std::memset(&slice, 0xEE, sizeof slice);
    line.assign(line.size(), NOT_A_NUMBER), line.clear(), line.shrink_to_fit();
    cells.clear(), cells.shrink_to_fit();
    colour.clear(), colour.shrink_to_fit();
    for (size_t i = 0; i < layers.size(); i++) CHECK(picture({layers[i]}) == before[i]);
    // A clipped layer outlives the layer that it clips.
    leafless_layer_free(layers[0]);
    CHECK(picture({layers[6]}) == before[6]);
    for (size_t i = 1; i < layers.size(); i++) leafless_layer_free(layers[i]);
}

} // namespace

int main() {
    counts();
    nonsense();
    calls_from_within();
    editor_in_threads();
    layers_outlive();
    return 0;
}
