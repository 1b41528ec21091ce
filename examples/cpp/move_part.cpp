// A part is dragged through a box, step by step, as with a mouse. After each step the program checks whether the
// placement is valid, which objects conflict with it, and how far the nearest part is. At last it places the remaining
// parts where there is room.
//
// include/README.md describes how to build it.

#include <leafless.hpp>

#include <array>
#include <cstdio>
#include <exception>
#include <string>

using leafless::affine;
using leafless::solid;

namespace {

std::string name_of(const leafless_neighbour &neighbour) {
    if (neighbour.beside == LEAFLESS_BESIDE_WALL) return "the wall";
    return (neighbour.beside == LEAFLESS_BESIDE_OBSTACLE ? "post " : "part ") + std::to_string(neighbour.number);
}

void print(double x, const leafless_standing &standing, const leafless_neighbour &conflict) {
    std::printf("x = %4.1f: %s", x,
                standing.verdict == LEAFLESS_GAP_VERDICT_YES  ? "may stand"
                : standing.verdict == LEAFLESS_GAP_VERDICT_NO ? "may not stand"
                                                              : "undecided");
    if (standing.conflict_count > 0) {
        std::printf(", %llu too near, first %s", static_cast<unsigned long long>(standing.conflict_count),
                    name_of(conflict).c_str());
    }
    if (standing.has_nearest) {
        const leafless_interval &gap = standing.nearest.gap_model;
        std::printf("; next is %s, %.4f to %.4f away", name_of(standing.nearest).c_str(), gap.lower, gap.upper);
    }
    std::printf("\n");
}

void drag() {
    // A ring, and a box with a post in it; clearances of 2 between parts and 1 to the walls.
    const solid ring = solid::new_torus({0, 0, 0}, {0, 0, 1}, 8, 2);
    leafless::bay bay = leafless::bay::make(solid::new_box({0, 0, 0}, {100, 40, 30}), 2, 1);
    bay.add_obstacle(solid::new_cylinder({80, 20, 0}, {80, 20, 30}, 3));
    leafless_item_options options = LEAFLESS_INIT(leafless_item_options);
    options.orientations = LEAFLESS_ORIENTATIONS_TURNS;
    const uint64_t item = bay.add_item(ring, 6, &options);
    leafless::layout layout = leafless::layout::make(bay);

    const auto at = [](double x) { return affine{1, 0, 0, x, 0, 1, 0, 20, 0, 0, 1, 4}; };
    layout.place(item, at(45));
    const uint64_t dragged = layout.place(item, at(11));
    double last = 11;
    for (int step = 0; step <= 10; step++) {
        const double x = 8 + 2.5 * step;
        layout.move_to(dragged, at(x));
        std::array<leafless_neighbour, 1> conflicts{};
        const leafless_standing standing = layout.check(dragged, nullptr, conflicts);
        print(x, standing, conflicts[0]);
        if (standing.verdict == LEAFLESS_GAP_VERDICT_YES) last = x;
    }
    // The part returns to its last placement that was proven valid. (If a distance is almost exactly the clearance,
    // nothing is proven.)
    layout.move_to(dragged, at(last));
    std::printf("let go at x = %.1f\n", last);

    const leafless_search_report report = layout.search();
    const leafless_layout_measures measures = layout.measure(1e-3);
    std::printf("%llu more found a place, %llu did not; %.1f to %.1f %% of the box are filled\n",
                static_cast<unsigned long long>(report.placed), static_cast<unsigned long long>(report.left),
                100 * measures.filled_part.lower, 100 * measures.filled_part.upper);
    std::size_t proven = 0;
    for (const leafless_placed_standing &standing : layout.check_all()) {
        if (standing.verdict == LEAFLESS_GAP_VERDICT_YES) proven++;
    }
    std::printf("%zu parts are proven to stand where they may\n", proven);
}

} // namespace

int main() {
    try {
        drag();
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
