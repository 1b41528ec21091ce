// A drilled plate in a form for CAD programs: plane faces as polygons with holes, and the bore as a cylinder with its
// radius.
//
// include/README.md describes how to build it; it writes faces.obj to the current folder.

#include <leafless.hpp>

#include <cmath>
#include <cstdio>

namespace {

// The elements of part `part` of an array that `offsets` divides.
leafless::span<const uint32_t> offsets_of(const void *offsets, uint64_t part) {
    return leafless::span<const uint32_t>(static_cast<const uint32_t *>(offsets) + part, 2);
}

void print_polygon(const leafless_polyhedron_arrays &arrays, uint64_t face) {
    const auto *const vertices = static_cast<const double *>(arrays.vertices);
    const auto *const corners = static_cast<const uint32_t *>(arrays.corners);
    const auto loops = offsets_of(arrays.faces, face);
    for (uint64_t loop = loops[0]; loop < loops[1]; loop++) {
        const auto own = offsets_of(arrays.loops, loop);
        std::printf("  %s of %u corners", loop == loops[0] ? "polygon" : "hole", own[1] - own[0]);
        for (uint64_t corner = own[0]; corner < own[1] && corner < own[0] + 4; corner++) {
            const double *const at = vertices + std::size_t{3} * corners[corner];
            std::printf(" (%g, %g, %g)", at[0], at[1], at[2]);
        }
        std::printf("%s\n", own[1] - own[0] > 4 ? " ..." : "");
    }
}

} // namespace

int main() {
    using leafless::solid;
    const solid block = solid::new_box({0, 0, 0}, {80, 60, 10});
    const solid bore = solid::new_cylinder({40, 30, -1}, {40, 30, 11}, 5);
    const solid plate = solid::combine(LEAFLESS_OPERATION_DIFFERENCE, leafless::refs(block, bore));

    const leafless_frame frame = {{-10, -20, -45}, 100, 14};
    const leafless::boundary boundary = plate.boundary(frame, 0.08);
    const leafless_boundary_report report = boundary.describe();
    std::printf("%llu regions, within %.3f\n", static_cast<unsigned long long>(report.regions), report.deviation_model);

    const std::vector<leafless_boundary_surface> surfaces = boundary.surfaces();
    const leafless_polyhedron_arrays arrays = boundary.peek_faces();
    for (const leafless_boundary_region &region : boundary.regions()) {
        const leafless_boundary_surface &surface = surfaces[region.surface];
        const double *const along = surface.direction;
        if (surface.kind == LEAFLESS_SURFACE_KIND_PLANE) {
            std::printf("plane (%g, %g, %g) at %g\n", along[0], along[1], along[2], surface.offset_model);
            print_polygon(arrays, region.first_face);
        } else if (surface.kind == LEAFLESS_SURFACE_KIND_CYLINDER) {
            const double *const at = surface.point_model;
            std::printf("cylinder of radius %g around (%g, %g, %g), along (%g, %g, %g), %s: %u triangles\n",
                        surface.radius_model, at[0], at[1], at[2], std::fabs(along[0]), std::fabs(along[1]),
                        std::fabs(along[2]), region.is_turned ? "a bore" : "a pin", region.triangle_count);
        }
    }
    leafless_mesh_write_options options = LEAFLESS_INIT(leafless_mesh_write_options);
    options.deviation_model = report.deviation_model;
    leafless::mesh::write_polygons(arrays, options, leafless_to_file("faces.obj"));
    return 0;
}
