/* Meshes with fewer triangles: a ball by marching cubes, a plane face in many pieces, an empty mesh; refused calls. */
#include "check.h"

static leafless_mesh_info counts_of(const leafless_mesh *mesh) {
    leafless_mesh_info info = LEAFLESS_INIT(leafless_mesh_info);
    OK(leafless_mesh_describe(mesh, &info));
    return info;
}

/* A ball has far fewer triangles, each of its vertices is one of before, and the volume changes by less than its surface times the
   deviation. */
static void ball(void) {
    leafless_octree *octree = check_ball(6, LEAFLESS_RULE_SAMPLED);
    leafless_surface_options surface = LEAFLESS_INIT(leafless_surface_options);
    leafless_simplified told = LEAFLESS_INIT(leafless_simplified);
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    leafless_options options = LEAFLESS_INIT(leafless_options);
    leafless_mesh *mesh = NULL, *simple = NULL, *other = NULL;
    double before, after, area;
    leafless_control *control = NULL;
    surface.method = LEAFLESS_SURFACE_METHOD_SURFACE_NETS;
    OK(leafless_octree_surface(octree, &surface, NULL, &mesh));
    OK(leafless_mesh_simplify(mesh, 0.01, NULL, &told, &simple));
    CHECK(told.deviation_model > 0 && told.deviation_model <= 0.01 && told.intersecting_pairs == 0);
    CHECK(told.removed + counts_of(simple).triangles == counts_of(mesh).triangles);
    CHECK(4 * counts_of(simple).triangles < counts_of(mesh).triangles);
    OK(leafless_mesh_inspect(simple, &report));
    CHECK(report.is_manifold && report.bodies == 1 && report.euler_characteristic == 2 && report.degenerate == 0);
    OK(leafless_mesh_volume(mesh, &before));
    OK(leafless_mesh_volume(simple, &after));
    OK(leafless_mesh_area(mesh, &area));
    CHECK(fabs(after - before) < 1.1 * area * told.deviation_model);

    /* The same for any number of threads, and without a report. */
    for (options.threads = 1; options.threads < 4; options.threads++) {
        OK(leafless_mesh_simplify(mesh, 0.01, &options, NULL, &other));
        OK(leafless_mesh_volume(other, &before));
        CHECK(before == after && counts_of(other).triangles == counts_of(simple).triangles);
        leafless_mesh_free(other);
    }

    other = NULL;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_mesh_simplify(mesh, 0, NULL, &told, &other));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_mesh_simplify(mesh, -1, NULL, &told, &other));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_mesh_simplify(mesh, (double)NAN, NULL, &told, &other));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_mesh_simplify(mesh, (double)INFINITY, NULL, &told, &other));
    OK(leafless_control_new(&control));
    leafless_control_cancel(control);
    OK(leafless_init(&options, sizeof options));
    options.control = control;
    FAILS(LEAFLESS_E_CANCELLED, leafless_mesh_simplify(mesh, 0.01, &options, &told, &other));
    CHECK(other == NULL);
    leafless_control_free(control);
    leafless_mesh_free(simple);
    leafless_mesh_free(mesh);
    leafless_octree_free(octree);
}

/* A square pyramid with a vertex in the middle of its base, which is removed. A mesh without triangles stays empty. */
static void pyramid(void) {
    static const double CORNERS[6][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 0}, {1, 1, 3}};
    static const uint32_t TRIANGLES[8][3] = {{1, 0, 4}, {2, 1, 4}, {3, 2, 4}, {0, 3, 4},
                                             {0, 1, 5}, {1, 2, 5}, {2, 3, 5}, {3, 0, 5}};
    leafless_mesh_arrays arrays = LEAFLESS_INIT(leafless_mesh_arrays);
    leafless_simplified told = LEAFLESS_INIT(leafless_simplified);
    leafless_mesh *mesh = NULL, *simple = NULL, *stated = NULL, *empty = NULL;
    double volume;
    arrays.vertices = CORNERS;
    arrays.vertex_count = 6;
    arrays.indices = TRIANGLES;
    arrays.triangle_count = 8;
    OK(leafless_mesh_new(&arrays, &mesh));
    OK(leafless_mesh_simplify(mesh, 1e-9, NULL, &told, &simple));
    CHECK(told.removed == 2 && told.deviation_model <= 1e-9);
    CHECK(counts_of(simple).triangles == 6 && counts_of(simple).vertices == 5);
    OK(leafless_mesh_volume(simple, &volume));
    CHECK(fabs(volume - 4) < 1e-12);
    leafless_mesh_free(simple);

    /* What the mesh itself may be off is added. */
    OK(leafless_mesh_with_deviation(mesh, 0.25, &stated));
    OK(leafless_mesh_simplify(stated, 1e-9, NULL, &told, &simple));
    CHECK(counts_of(simple).deviation_model >= 0.25 && counts_of(simple).deviation_model <= 0.25 + 2e-9);
    leafless_mesh_free(simple);
    leafless_mesh_free(stated);
    leafless_mesh_free(mesh);

    arrays.vertex_count = arrays.triangle_count = 0;
    OK(leafless_mesh_new(&arrays, &empty));
    OK(leafless_mesh_simplify(empty, 1, NULL, &told, &simple));
    CHECK(counts_of(simple).triangles == 0 && told.removed == 0 && told.deviation_model == 0);
    leafless_mesh_free(simple);
    leafless_mesh_free(empty);
}

int main(void) {
    ball();
    pyramid();
    return 0;
}
