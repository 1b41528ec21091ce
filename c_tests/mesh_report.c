/* Reports about defective meshes: counts and places. */
#include "check.h"

/* The cube [0, 1]^3 and at most 12 more triangles, for the tests to use. */
typedef struct surface {
    double vertices[24][3];
    uint32_t triangles[24][3];
    uint32_t vertex_count, triangle_count;
} surface;

static surface cube(void) {
    surface all;
    memcpy(all.vertices, CHECK_CUBE, sizeof CHECK_CUBE);
    memcpy(all.triangles, CHECK_CUBE_TRIANGLES, sizeof CHECK_CUBE_TRIANGLES);
    all.vertex_count = 8;
    all.triangle_count = 12;
    return all;
}

static void add_triangle(surface *all, uint32_t a, uint32_t b, uint32_t c) {
    uint32_t *triangle = all->triangles[all->triangle_count++];
    triangle[0] = a, triangle[1] = b, triangle[2] = c;
}

static uint32_t add_vertex(surface *all, double x, double y, double z) {
    double *vertex = all->vertices[all->vertex_count];
    vertex[0] = x, vertex[1] = y, vertex[2] = z;
    return all->vertex_count++;
}

static leafless_mesh *made(const surface *all) {
    const leafless_mesh_arrays arrays =
        check_arrays(all->vertices, all->vertex_count, all->triangles, all->triangle_count);
    leafless_mesh *mesh = NULL;
    OK(leafless_mesh_new(&arrays, &mesh));
    return mesh;
}

/* Returns the report, and the first of the defects. There must be `count` defects. */
static leafless_mesh_report told(const surface *all, uint64_t count, leafless_mesh_defect *first) {
    leafless_mesh *mesh = made(all);
    leafless_mesh_defect defects[8];
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    uint64_t found = 77, limit;
    OK(leafless_mesh_inspect(mesh, &report));
    CHECK(report.facets_read == all->triangle_count && report.triangles + report.degenerate == all->triangle_count);
    OK(leafless_mesh_defects(mesh, UINT64_MAX, NULL, 0, &found));
    CHECK(found == count && count <= COUNT(defects));
    memset(defects, 0xc3, sizeof defects);
    OK(leafless_mesh_defects(mesh, UINT64_MAX, defects, COUNT(defects), &found));
    CHECK(found == count);
    *first = defects[0];
    /* The worst ones alone are the first of all. */
    for (limit = 0; limit <= count; limit++) {
        leafless_mesh_defect some[8];
        memset(some, 0xc3, sizeof some);
        OK(leafless_mesh_defects(mesh, limit, some, limit, &found));
        CHECK(found == limit && memcmp(some, defects, (size_t)limit * sizeof *some) == 0);
    }
    if (count > 0) {
        FAILS(LEAFLESS_E_BUFFER, leafless_mesh_defects(mesh, count, defects, count - 1, &found));
    }
    leafless_mesh_free(mesh);
    return report;
}

static bool box(const leafless_mesh_defect *defect, double x, double y, double z, double to_x, double to_y, double to_z) {
    const double *min = defect->min_model, *max = defect->max_model;
    return min[0] == x && min[1] == y && min[2] == z && max[0] == to_x && max[1] == to_y && max[2] == to_z;
}

static bool holds(leafless_interval interval, double value, double width) {
    return interval.lower <= value && value <= interval.upper && interval.upper - interval.lower <= width;
}

/* Mass properties from the triangles, or why there are none. */
static void encloses(void) {
    surface all = cube();
    leafless_mesh *mesh = made(&all);
    leafless_mesh_moments moments = LEAFLESS_INIT(leafless_mesh_moments);
    int i, j;
    OK(leafless_mesh_measure(mesh, LEAFLESS_FILL_NON_ZERO, NULL, &moments));
    CHECK(moments.known == LEAFLESS_MOMENTS_VERDICT_KNOWN && moments.has_centroid && moments.triangles[1] == 0);
    CHECK(holds(moments.volume_model, 1.0, 1e-13));
    for (i = 0; i < 3; i++) {
        CHECK(holds(moments.centroid_model[i], 0.5, 1e-13));
        for (j = 0; j < 3; j++) {
            CHECK(holds(moments.inertia_origin_model[3 * i + j], i == j ? 2.0 / 3.0 : -0.25, 1e-13));
            CHECK(holds(moments.inertia_centroid_model[3 * i + j], i == j ? 1.0 / 6.0 : 0.0, 1e-13));
        }
    }
    leafless_mesh_free(mesh);

    all.triangle_count--;
    mesh = made(&all);
    OK(leafless_mesh_measure(mesh, LEAFLESS_FILL_NON_ZERO, NULL, &moments));
    CHECK(moments.known == LEAFLESS_MOMENTS_VERDICT_OPEN && !moments.has_centroid);
    CHECK(moments.volume_model.lower == 0.0 && moments.volume_model.upper == INFINITY);
    CHECK(moments.inertia_origin_model[4].lower == -INFINITY && moments.centroid_model[2].upper == INFINITY);
    leafless_mesh_free(mesh);
}

/* A cube and a tetrahedron through one of its faces. */
static void intersects(void) {
    surface all = cube();
    leafless_mesh *mesh = made(&all);
    leafless_intersecting_pair pairs[64], some[3];
    leafless_mesh_moments moments = LEAFLESS_INIT(leafless_mesh_moments);
    uint64_t found = 77, again = 77, i;
    bool is_complete = false;
    uint32_t a, b, c, d;
    OK(leafless_mesh_intersecting_pairs(mesh, NULL, NULL, 0, &found, &is_complete));
    CHECK(found == 0 && is_complete);
    leafless_mesh_free(mesh);

    a = add_vertex(&all, 0.3, 0.3, 0.5), b = add_vertex(&all, 0.4, 0.3, 1.5);
    c = add_vertex(&all, 0.3, 0.4, 1.5), d = add_vertex(&all, 0.2, 0.2, 1.5);
    add_triangle(&all, a, c, b), add_triangle(&all, a, d, c), add_triangle(&all, a, b, d), add_triangle(&all, b, c, d);
    mesh = made(&all);
    OK(leafless_mesh_intersecting_pairs(mesh, NULL, pairs, COUNT(pairs), &found, &is_complete));
    /* Three sides go through one or both triangles of the upper face. */
    CHECK(3 <= found && found <= 6 && is_complete);
    for (i = 0; i < found; i++) {
        CHECK(pairs[i].triangles[0] < 12 && 12 <= pairs[i].triangles[1] && pairs[i].triangles[1] < 15);
        CHECK(pairs[i].min_model[2] <= 1.0 && 1.0 <= pairs[i].max_model[2]);
        CHECK(pairs[i].min_model[0] >= 0.2 && pairs[i].max_model[0] <= 0.4);
    }
    memset(some, 0xc3, sizeof some);
    OK(leafless_mesh_intersecting_pairs(mesh, NULL, some, 2, &again, &is_complete));
    CHECK(again == found && is_complete && memcmp(some, pairs, 2 * sizeof *some) == 0);
    CHECK(((const unsigned char *)&some[2])[0] == 0xc3);
    OK(leafless_mesh_measure(mesh, LEAFLESS_FILL_NON_ZERO, NULL, &moments));
    CHECK(moments.known == LEAFLESS_MOMENTS_VERDICT_INTERSECTING);
    CHECK(moments.triangles[0] < 12 && 12 <= moments.triangles[1] && moments.triangles[1] < 16);
    leafless_mesh_free(mesh);
}

/* A boundary that lies somewhere within a deviation of the cube. */
static void deviation(void) {
    const double points[9] = {0.5, 0.5, 0.5, -0.1, 0.5, 0.5, -0.3, 0.5, 0.5}, wrong[3] = {-0.5, NAN, INFINITY};
    const leafless_frame frame = check_frame(20);
    leafless_mesh_info info = LEAFLESS_INIT(leafless_mesh_info);
    leafless_mesh_moments moments = LEAFLESS_INIT(leafless_mesh_moments);
    leafless_mesh *cube = check_cube(), *stated = NULL, *open = check_some_of_cube(11);
    leafless_solid *solid = NULL;
    leafless_membership answers[3];
    size_t i;

    OK(leafless_mesh_with_deviation(cube, 0.125, &stated));
    OK(leafless_mesh_describe(stated, &info));
    CHECK(info.deviation_model == 0.125 && info.displacement_model == 0.125);
    OK(leafless_mesh_describe(cube, &info));
    CHECK(info.deviation_model == 0.0 && info.displacement_model == 0.0);
    OK(leafless_mesh_measure(stated, LEAFLESS_FILL_NON_ZERO, NULL, &moments));
    CHECK(moments.volume_model.lower < 0.75 * 0.75 * 0.75 && 1.25 * 1.25 * 1.25 < moments.volume_model.upper);
    OK(leafless_solid_from_mesh(stated, LEAFLESS_FILL_NON_ZERO, &solid));
    OK(leafless_solid_contains_many(solid, &frame, points, 3, NULL, answers));
    CHECK(answers[0] == LEAFLESS_MEMBERSHIP_INSIDE && answers[1] == LEAFLESS_MEMBERSHIP_UNDECIDED);
    CHECK(answers[2] == LEAFLESS_MEMBERSHIP_OUTSIDE);
    leafless_solid_free(solid);
    leafless_mesh_free(stated);

    OK(leafless_mesh_with_deviation(open, 0.125, &stated));
    solid = NULL;
    FAILS(LEAFLESS_E_MESH, leafless_solid_from_mesh(stated, LEAFLESS_FILL_NON_ZERO, &solid));
    leafless_mesh_free(stated);
    leafless_mesh_free(open);
    for (i = 0; i < COUNT(wrong); i++) FAILS(LEAFLESS_E_ARGUMENT, leafless_mesh_with_deviation(cube, wrong[i], &stated));
    leafless_mesh_free(cube);
}

int main(void) {
    deviation();
    leafless_mesh_defect defect;
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    surface all = cube();

    /* Nothing is wrong. */
    report = told(&all, 0, &defect);
    CHECK(report.bodies == 1 && report.open_bodies == 0 && report.inside_out_bodies == 0 && report.boundary_loops == 0);
    CHECK(report.boundary_edges == 0 && report.misoriented_edges == 0 && report.non_manifold_edges == 0);
    CHECK(report.duplicate == 0 && report.opposite == 0 && report.flat == 0 && report.degenerate == 0);

    /* A hole: the last triangle is (1, 7, 5) on the side x = 1, with a diagonal and two edges. */
    all.triangle_count = 11;
    report = told(&all, 1, &defect);
    CHECK(report.boundary_edges == 3 && report.boundary_loops == 1 && report.bodies == 1 && report.open_bodies == 1);
    CHECK(defect.kind == LEAFLESS_DEFECT_HOLE && defect.count == 3 && box(&defect, 1, 0, 0, 1, 1, 1));
    CHECK(fabs(defect.length_model - (2.0 + sqrt(2.0))) < 1e-12);

    /* The whole side, and the opposite one: two holes. */
    all.triangle_count = 8;
    report = told(&all, 2, &defect);
    CHECK(report.boundary_edges == 8 && report.boundary_loops == 2 && report.bodies == 1 && report.open_bodies == 1);
    CHECK(defect.kind == LEAFLESS_DEFECT_HOLE && defect.count == 4 && defect.length_model == 4.0);
    CHECK(box(&defect, 0, 0, 0, 0, 1, 1));

    /* An inverted triangle. */
    all = cube();
    all.triangles[0][0] = 2, all.triangles[0][1] = 0;
    report = told(&all, 1, &defect);
    CHECK(report.misoriented_edges == 3 && report.boundary_edges == 0 && report.open_bodies == 1);
    CHECK(defect.kind == LEAFLESS_DEFECT_MISORIENTED && defect.count == 3 && box(&defect, 0, 0, 0, 1, 1, 0));

    /* All triangles inverted. */
    all = cube();
    {
        uint32_t i;
        for (i = 0; i < 12; i++) {
            const uint32_t first = all.triangles[i][0];
            all.triangles[i][0] = all.triangles[i][1];
            all.triangles[i][1] = first;
        }
    }
    report = told(&all, 0, &defect);
    CHECK(report.bodies == 1 && report.open_bodies == 0 && report.inside_out_bodies == 1);

    /* A triangle twice: on its edges three meet. */
    all = cube();
    add_triangle(&all, 2, 3, 0);
    report = told(&all, 3, &defect);
    CHECK(report.duplicate == 1 && report.opposite == 0 && report.boundary_edges == 3 && report.non_manifold_edges == 3);
    CHECK(defect.kind == LEAFLESS_DEFECT_HOLE);
    /* A third time, inverted: one triangle is redundant, and one is cancelled. */
    add_triangle(&all, 3, 2, 0);
    report = told(&all, 2, &defect);
    CHECK(report.duplicate == 1 && report.opposite == 1 && report.boundary_edges == 0 && report.misoriented_edges == 0);
    CHECK(defect.kind == LEAFLESS_DEFECT_DUPLICATE && defect.count == 2 && defect.length_model == 0.0);
    CHECK(box(&defect, 0, 0, 0, 1, 1, 0));

    /* A sheet far from it, and a triangle without area in its edge; one with two corners at one place is none. */
    all = cube();
    {
        const uint32_t a = add_vertex(&all, 5, 5, 5), b = add_vertex(&all, 9, 5, 5), c = add_vertex(&all, 5, 8, 5);
        const uint32_t middle = add_vertex(&all, 7, 5, 5), again = add_vertex(&all, 5, 5, 5);
        add_triangle(&all, a, b, c);
        add_triangle(&all, a, middle, b);
        add_triangle(&all, a, again, c);
    }
    report = told(&all, 2, &defect);
    CHECK(report.flat == 1 && report.degenerate == 1 && report.welded == 1 && report.bodies == 2);
    CHECK(report.open_bodies == 1 && report.boundary_edges == 4 && report.boundary_loops == 1);
    CHECK(defect.kind == LEAFLESS_DEFECT_HOLE && defect.count == 4 && box(&defect, 5, 5, 5, 9, 8, 5));
    CHECK(defect.length_model == 12.0);

    /* A second cube that overlaps the first, one inside of it, and that one as a cavity. */
    {
        static const double PLACES[2][2] = {{0.5, 1.0}, {0.25, 0.5}};
        uint32_t kind, i, axis;
        for (kind = 0; kind < 3; kind++) {
            const double *place = PLACES[kind > 0];
            all = cube();
            for (i = 0; i < 8; i++) {
                for (axis = 0; axis < 3; axis++) {
                    all.vertices[8 + i][axis] = place[0] + place[1] * CHECK_CUBE[i][axis];
                }
            }
            for (i = 0; i < 12; i++) {
                const uint32_t *of = CHECK_CUBE_TRIANGLES[i];
                all.triangles[12 + i][0] = 8 + of[0];
                all.triangles[12 + i][1] = 8 + of[kind == 2 ? 2 : 1];
                all.triangles[12 + i][2] = 8 + of[kind == 2 ? 1 : 2];
            }
            all.vertex_count = 16, all.triangle_count = 24;
            report = told(&all, 0, &defect);
            CHECK(report.bodies == 2 && report.undecided_bodies == 0);
            CHECK(report.overlapping_bodies == (kind == 2 ? 0 : 2));
            CHECK(report.polygons == 0 && report.bent_polygons == 0 && report.polygon_deviation_model == 0.0);
        }
    }

    encloses();
    intersects();

    /* A square with a corner lifted. */
    {
        static const char OFF[] = "OFF 4 1 0\n0 0 0\n2 0 0\n2 2 0.25\n0 2 0\n4 0 1 2 3\n";
        leafless_mesh *mesh = NULL;
        OK(mesh_from_bytes((const uint8_t *)OFF, sizeof OFF - 1, NULL, NULL, &mesh));
        OK(leafless_mesh_inspect(mesh, &report));
        CHECK(report.polygons == 1 && report.bent_polygons == 1);
        CHECK(fabs(report.polygon_deviation_model - 0.0625) < 0.001);
        leafless_mesh_free(mesh);
    }

    /* Nothing at all. */
    all.triangle_count = 0;
    report = told(&all, 0, &defect);
    CHECK(report.bodies == 0 && report.triangles == 0);
    return 0;
}
