// How long a program waits that drags one of three hundred parts, through the interface for C++.
//
//     cargo build --release -p leafless-capi
//     g++ -O2 -std=c++17 benches/move_part.cpp -Iinclude target/release/libleafless.a -lm -pthread -o /tmp/move_part
//     /tmp/move_part PARTS
//
// PARTS is a folder with featuretype.stl, angle_block.stl and plate_holes.stl, whose longest sides are 1.

#include <leafless.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

namespace {

using clock_type = std::chrono::steady_clock;

double milliseconds(clock_type::time_point start) {
    return std::chrono::duration<double, std::milli>(clock_type::now() - start).count();
}

leafless::solid part(const std::string &path) {
    leafless_mesh_options options = LEAFLESS_INIT(leafless_mesh_options);
    options.format = LEAFLESS_MESH_FORMAT_STL;
    const leafless_source file = leafless_from_file(path.c_str(), LEAFLESS_ACCESS_COPY);
    return leafless::solid::from_mesh(std::get<1>(leafless::mesh::read(file, options)).sewn(), LEAFLESS_FILL_NON_ZERO);
}

void report(const char *what, std::vector<double> &times) {
    std::sort(times.begin(), times.end());
    std::printf("%-28s %4zu checks, median %.3f ms, 99 %% %.3f ms, longest %.3f ms\n", what, times.size(), times[times.size() / 2],
                times[times.size() * 99 / 100], times.back());
}

void drag(const std::string &folder) {
    const double edge = 5.2, clearance = 0.02;
    leafless::bay bay = leafless::bay::make(leafless::solid::new_box({0, 0, 0}, {edge, edge, edge}), clearance, 0);
    bay.add_item(part(folder + "/featuretype.stl"), 150);
    bay.add_item(part(folder + "/angle_block.stl"), 100);
    bay.add_item(part(folder + "/plate_holes.stl"), 50);
    auto start = clock_type::now();
    leafless::layout layout = leafless::layout::make(bay);
    std::printf("ready in %.1f ms\n", milliseconds(start));
    start = clock_type::now();
    const leafless_search_report report_ = layout.search();
    std::printf("%llu placed, %llu left, in %.0f ms\n", (unsigned long long)report_.placed, (unsigned long long)report_.left,
                milliseconds(start));
    start = clock_type::now();
    const std::vector<leafless_placed_standing> standings = layout.check_all();
    std::printf("all %zu checked in %.1f ms\n", standings.size(), milliseconds(start));

    // Each part in its turn moves by small steps: a little more than the clearance, into its neighbours, and far out of the box.
    const std::vector<leafless_placement> placements = layout.placements();
    std::vector<double> free_times, contact_times;
    for (uint64_t number = 0; number < placements.size(); number++) {
        const leafless_placement &own = placements[number];
        for (const double by : {1.3 * clearance, 0.2, 3 * edge}) {
            for (int axis = 0; axis < 3; axis++) {
                leafless::affine matrix{};
                std::copy(std::begin(own.matrix), std::end(own.matrix), matrix.begin());
                matrix[4 * axis + 3] += by;
                layout.move_to(number, matrix);
                std::array<leafless_neighbour, 64> conflicts{};
                start = clock_type::now();
                const leafless_standing standing = layout.check(number, nullptr, conflicts);
                (standing.conflict_count > 0 ? contact_times : free_times).push_back(milliseconds(start));
            }
        }
        leafless::affine matrix{};
        std::copy(std::begin(own.matrix), std::end(own.matrix), matrix.begin());
        layout.move_to(number, matrix);
    }
    report("with nothing in the way", free_times);
    report("with something in the way", contact_times);
}

}  // namespace

int main(int count, char **arguments) {
    if (count != 2) return 2;
    try {
        drag(arguments[1]);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
