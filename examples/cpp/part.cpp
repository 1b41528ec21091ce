// One part as a triangulation, as a function of the host and as an expression: volumes, cuts by sixty positions of a
// tool, a file that a second process maps, ten poses of a shaft, refinement on demand, and a picture.
//
// include/README.md describes how to build it; it writes part.lfl and part.png to the current folder.

#include <leafless.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

using leafless::octree;
using leafless::point;
using leafless::solid;

namespace {

const leafless_frame FRAME = {{-32, -32, -32}, 64, 8};
const point LOW = {-20, -12, -8}, HIGH = {20, 12, 8};

// The block as twelve triangles.
leafless::mesh triangulation() {
    std::array<point, 8> corners;
    for (std::size_t i = 0; i < 8; i++) {
        for (std::size_t axis = 0; axis < 3; axis++) corners[i][axis] = (i >> axis & 1) != 0 ? HIGH[axis] : LOW[axis];
    }
    const std::array<leafless::cell_index, 12> triangles = {{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                                             {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                                             {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}}};
    leafless_mesh_arrays arrays = LEAFLESS_INIT(leafless_mesh_arrays);
    arrays.vertices = corners.data();
    arrays.vertex_count = corners.size();
    arrays.indices = triangles.data();
    arrays.triangle_count = triangles.size();
    return leafless::mesh::make(arrays);
}

// The block as a function that classifies boxes.
leafless_tag classify(const point &min, const point &max) {
    bool is_inside = true;
    for (std::size_t axis = 0; axis < 3; axis++) {
        if (max[axis] <= LOW[axis] || min[axis] >= HIGH[axis]) return LEAFLESS_TAG_EMPTY;
        is_inside = is_inside && min[axis] >= LOW[axis] && max[axis] <= HIGH[axis];
    }
    return is_inside ? LEAFLESS_TAG_FULL : LEAFLESS_TAG_PARTIAL;
}

void print(const char *name, const leafless_interval &volume) {
    std::printf("%-24s %.3f to %.3f\n", name, volume.lower, volume.upper);
}

// A ball-nosed tool on a spiral over the upper face.
octree cut(const octree &stock) {
    std::vector<octree> tools;
    for (int i = 0; i < 60; i++) {
        const double angle = 0.4 * i, radius = 0.15 * i;
        const solid ball = solid::new_ball({radius * std::cos(angle), radius * std::sin(angle), 7.5}, 2);
        tools.push_back(octree::build(ball, FRAME, LEAFLESS_RULE_CERTIFIED));
    }
    const octree swept = octree::combine(LEAFLESS_OPERATION_UNION, leafless::refs(tools));
    return octree::combine(LEAFLESS_OPERATION_DIFFERENCE, leafless::refs(stock, swept));
}

void poses(const solid &part) {
    const solid shaft = solid::new_cylinder({0, 0, -4}, {0, 0, 4}, 2);
    std::vector<leafless::affine> placements;
    for (int i = 0; i < 10; i++) placements.push_back({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 16.0 - i});
    std::vector<leafless_interference> found(placements.size());
    leafless_options options = LEAFLESS_INIT(leafless_options);
    options.max_splits = 20000;
    part.interfere_many(shaft, FRAME, placements, FRAME, 0, &options, found);
    for (std::size_t i = 0; i < found.size(); i++) {
        const char *const verdicts[] = {"apart", "overlapping", "undecided"};
        std::printf("shaft at z = %4.1f         %s\n", placements[i][11], verdicts[found[i].verdict]);
    }
}

void picture(const octree &part) {
    const std::array<point, 2> seen = {LOW, HIGH};
    leafless_shot shot = LEAFLESS_INIT(leafless_shot);
    shot.width = 320, shot.height = 240;
    shot.camera = leafless::camera_fitted(seen, 30, 35, 30, 320.0 / 240.0);
    const leafless::layer surface = leafless::layer::from_octree(part);
    std::vector<std::uint8_t> colours(std::size_t{4} * shot.width * shot.height);
    leafless::picture_render(shot, leafless::refs(surface), nullptr, colours, leafless::span<float>());
    leafless::picture_write(colours, shot.width, shot.height, leafless_to_file("part.png"));
}

// The work of a second process: it maps the file.
void ask(const char *path) {
    const octree part = octree::read(leafless_from_file(path, LEAFLESS_ACCESS_MAP));
    print("mapped", part.statistics().volume_model);
    const std::array<point, 3> points = {{{0, 0, 0}, {0, 0, 7}, {30, 0, 0}}};
    std::array<leafless_membership, 3> found = {};
    part.contains_many(points, found);
    std::printf("of three points          %d inside\n", static_cast<int>(std::count(found.begin(), found.end(), LEAFLESS_MEMBERSHIP_INSIDE)));
}

int make(const std::string &self) {
    const solid expression = solid::new_box(LOW, HIGH);
    const solid host = leafless::solid_of(classify, LEAFLESS_EXTERIOR_EMPTY);
    const solid triangles = solid::from_mesh(triangulation(), LEAFLESS_FILL_NON_ZERO);
    print("as an expression", expression.measure(FRAME, 1e-3, 0).volume_model);
    print("as a function", host.measure(FRAME, 1e-3, 0).volume_model);
    print("as a triangulation", triangles.measure(FRAME, 1e-3, 0).volume_model);

    const octree part = cut(octree::build(triangles, FRAME, LEAFLESS_RULE_CERTIFIED));
    print("after sixty cuts", part.statistics().volume_model);
    part.write(leafless_to_file("part.lfl"));
    std::fflush(stdout);
    if (std::system(("\"" + self + "\" part.lfl").c_str()) != 0) return 1;
    poses(solid::from_octree(part));

    leafless::lazy lazy = leafless::lazy::make(expression, FRAME);
    leafless_zone seen = LEAFLESS_INIT(leafless_zone);
    seen.kind = LEAFLESS_ZONE_KIND_BOX;
    seen.min_model[0] = 19, seen.min_model[1] = -1, seen.min_model[2] = -1;
    seen.max_model[0] = 21, seen.max_model[1] = 1, seen.max_model[2] = 1;
    lazy.refine(&seen, 8);
    std::printf("refined where seen       %llu splits\n", static_cast<unsigned long long>(lazy.splits().size()));
    picture(part);
    return 0;
}

} // namespace

int main(int argc, char **argv) {
    try {
        if (argc > 1) return ask(argv[1]), 0;
        return make(argv[0]);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
