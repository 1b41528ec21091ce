// Layouts of meshes, stored octrees and a lambda, from many threads; budgets; a direction in which everything comes out.
#include "check.h"

#include <leafless.hpp>

#include <atomic>
#include <cstring>
#include <thread>
#include <vector>

namespace {

using leafless::affine;
using leafless::solid;

constexpr int THREADS = 8;

affine at(double x, double y, double z) { return affine{1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z}; }

// A pyramid of height 4 on a square of side 6, as a mesh.
solid pyramid() {
    const double vertices[15] = {0, 0, 0, 6, 0, 0, 6, 6, 0, 0, 6, 0, 3, 3, 4};
    const uint32_t triangles[18] = {0, 2, 1, 0, 3, 2, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
    leafless_mesh_arrays arrays = LEAFLESS_INIT(leafless_mesh_arrays);
    arrays.vertices = vertices;
    arrays.vertex_count = 5;
    arrays.indices = triangles;
    arrays.triangle_count = 6;
    return solid::from_mesh(leafless::mesh::make(arrays), LEAFLESS_FILL_NON_ZERO);
}

// A block of 4 x 4 x 4 as an octree whose cells have a side of 1.
solid stored_block() {
    const solid block = solid::new_box({0, 0, 0}, {4, 4, 4});
    const leafless_frame frame = {{0, 0, 0}, 8, 3};
    return solid::from_octree(leafless::octree::build(block, frame, LEAFLESS_RULE_CERTIFIED));
}

struct kinds {
    leafless::layout layout;
    uint64_t mesh, stored;
};

kinds mixed(uint32_t count) {
    leafless::bay bay = leafless::bay::make(solid::new_cylinder({15, 15, 0}, {15, 15, 12}, 14), 0.5, 0.25);
    bay.add_obstacle(solid::new_ball({15, 15, 6}, 3));
    const uint64_t mesh = bay.add_item(pyramid(), count);
    const uint64_t stored = bay.add_item(stored_block(), count);
    return {leafless::layout::make(bay), mesh, stored};
}

// Threads that read one layout get the same answers to all queries; a thread that changes it meanwhile is refused.
void many_threads() {
    kinds all = mixed(6);
    leafless_search_options search = LEAFLESS_INIT(leafless_search_options);
    search.cells = 32;
    search.rounds = 1;
    const leafless_search_report report = all.layout.search(&search);
    CHECK(report.placed >= 8 && report.placed + report.left == 12);
    const std::vector<leafless_placement> placements = all.layout.placements();
    const std::vector<leafless_placed_standing> standings = all.layout.check_all();
    uint64_t meshes = 0;
    for (const leafless_placement &placement : placements) meshes += placement.item == all.mesh;
    CHECK(meshes >= 3 && placements.size() - meshes >= 3);
    for (const leafless_placed_standing &standing : standings) CHECK(standing.verdict == LEAFLESS_GAP_VERDICT_YES);
    const leafless_layout_measures measures = all.layout.measure(1e-3);
    // Pyramids have a volume of 48, blocks one of 64.
    const double volume = 48.0 * double(meshes) + 64.0 * double(placements.size() - meshes);
    CHECK(measures.volume_model.lower <= volume && volume <= measures.volume_model.upper);

    std::vector<leafless_standing> expected;
    for (uint64_t k = 0; k < placements.size(); k++) expected.push_back(all.layout.check(k, nullptr, {}));
    std::atomic<int> ready{0};
    std::vector<std::thread> threads;
    for (int number = 0; number < THREADS; number++) {
        threads.emplace_back([&, number] {
            ready++;
            while (ready < THREADS) std::this_thread::yield();
            for (uint64_t k = 0; k < placements.size(); k++) {
                const uint64_t own = (k + uint64_t(number)) % placements.size();
                const leafless_standing found = all.layout.check(own, nullptr, {});
                CHECK(found.verdict == expected[own].verdict && found.splits == expected[own].splits);
                CHECK(std::memcmp(&found.nearest, &expected[own].nearest, sizeof found.nearest) == 0);
                // (Another one may be reading.)
                const double *const matrix = placements[own].matrix;
                const leafless_status moved = leafless_layout_move_to(all.layout.get(), own, matrix);
                CHECK(moved == LEAFLESS_OK || moved == LEAFLESS_E_BUSY);
            }
        });
    }
    for (std::thread &thread : threads) thread.join();
    CHECK(std::memcmp(all.layout.placements().data(), placements.data(), placements.size() * sizeof placements[0]) == 0);
}

// Budgets end a search, and the placements so far are proven.
void budgets() {
    uint64_t last = 0;
    for (const uint64_t most : {1, 5, 1000}) {
        kinds all = mixed(4);
        leafless_search_options search = LEAFLESS_INIT(leafless_search_options);
        search.cells = 32;
        search.rounds = 1;
        search.max_tests = most;
        const leafless_search_report report = all.layout.search(&search);
        CHECK(report.tests <= most && report.placed <= report.tests && report.placed >= last);
        CHECK((report.end == LEAFLESS_SEARCH_END_BUDGET) == (report.tests == most));
        for (const leafless_placed_standing &standing : all.layout.check_all()) {
            CHECK(standing.verdict == LEAFLESS_GAP_VERDICT_YES);
        }
        last = report.placed;
    }
    CHECK(last >= 6);
    kinds all = mixed(4);
    leafless_options options = LEAFLESS_INIT(leafless_options);
    options.max_splits = 1;
    CHECK(all.layout.search(nullptr, &options).end == LEAFLESS_SEARCH_END_BUDGET);
}

// Hooks that interlock when they are laid closely: upward, one after another comes out without meeting those below.
void comes_out() {
    const solid foot = solid::new_box({0, 0, 0}, {5, 2, 1}), stem = solid::new_box({0, 0, 0}, {1, 2, 5});
    const solid arm = solid::new_box({0, 0, 4}, {5, 2, 5});
    const leafless_solid *const parts[] = {foot.get(), stem.get(), arm.get()};
    const solid hook = solid::combine(LEAFLESS_OPERATION_UNION, parts);
    leafless::bay bay = leafless::bay::make(solid::new_box({0, 0, 0}, {16, 4.5, 11}), 0.1, 0);
    bay.add_item(hook, 12);
    leafless_search_options search = LEAFLESS_INIT(leafless_search_options);
    search.cells = 80;
    search.rounds = 2;
    search.objective = LEAFLESS_OBJECTIVE_DENSITY;
    search.free_along = LEAFLESS_FREE_ALONG_Z_UP;
    leafless::layout layout = leafless::layout::make(bay);
    layout.search(&search);
    CHECK(layout.placements().size() >= 6);
    // The last one first: as it goes up, nothing that is still there is in its way.
    for (uint64_t number = layout.placements().size(); number-- > 0;) {
        const leafless_placement placement = layout.placement_at(number);
        for (int step = 0; step <= 24; step++) {
            affine matrix;
            std::memcpy(matrix.data(), placement.matrix, sizeof placement.matrix);
            matrix[11] += 0.5 * step;
            layout.move_to(number, matrix);
            leafless_neighbour conflicts[16];
            const leafless_standing standing = layout.check(number, nullptr, conflicts);
            for (uint64_t k = 0; k < standing.conflict_count; k++) CHECK(conflicts[k].beside == LEAFLESS_BESIDE_WALL);
        }
        layout.remove(number);
    }
}

// More copies are in conflict than are returned.
void crowd() {
    leafless::bay bay = leafless::bay::make(solid::new_box({0, 0, 0}, {4, 4, 4}), 0, 0);
    const uint64_t item = bay.add_item(solid::new_box({0, 0, 0}, {1, 1, 1}), 1);
    leafless::layout layout = leafless::layout::make(bay);
    for (int k = 0; k < 300; k++) layout.place(item, at(1.5, 1.5, 1.5));
    std::vector<leafless_neighbour> conflicts(400);
    std::memset(conflicts.data(), 0x5a, conflicts.size() * sizeof conflicts[0]);
    CHECK(layout.check(0, nullptr, conflicts).conflict_count == 299);
    CHECK(conflicts[255].number == 256 && conflicts[256].beside == 0x5a5a5a5a);
}

}  // namespace

int main() {
    many_threads();
    budgets();
    comes_out();
    crowd();
    return 0;
}
