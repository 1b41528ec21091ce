/* What every function makes of pointers that are NULL or misaligned, and of numbers out of range: a status, each
   parameter by itself, and nothing is written. The driver counts these against the header: each pointer parameter
   of each function stands here as NULL_POINTER(function, parameter) or MAY_BE_NULL(function, parameter). */
#include "null.h"

static int32_t classify(void *ctx, const double *min, const double *max) {
    (void)ctx;
    return min[0] >= 0.0 ? LEAFLESS_TAG_FULL : max[0] <= 0.0 ? LEAFLESS_TAG_EMPTY : LEAFLESS_TAG_PARTIAL;
}

static int32_t classify_many(void *ctx, const double *boxes, uint64_t count, int32_t *tags) {
    (void)ctx, (void)boxes, (void)count, (void)tags;
    return 0;
}

static int32_t distance_many(void *ctx, const double *points, uint64_t count, double *distances) {
    (void)ctx, (void)points, (void)count, (void)distances;
    return 0;
}

static int32_t value(void *ctx, const double *at, double *result) {
    (void)ctx;
    *result = at[0];
    return 0;
}

static int32_t range(void *ctx, const double *min, const double *max, leafless_interval *result) {
    (void)ctx;
    result->lower = min[0];
    result->upper = max[0];
    return 0;
}

static leafless_frame frame = {{-1, -1, -1}, 2, 4};
static leafless_octree *octree;
static leafless_mesh *mesh;
static leafless_scene *scene;
static leafless_solid *solid;
static leafless_control *control;
static leafless_cursor *cursor;
static leafless_point_cursor *point_cursor;
static leafless_point_table *point_table;
static leafless_options options;
static const double point[3] = {0, 0, 0}, above[3] = {1, 1, 1}, outline[6] = {0, 0, 1, 0, 0, 1};

/* Functions of the boundary of a ball. */
static void boundaries(void) {
    const double middle[3] = {frame.origin[0] + 0.5 * frame.edge, frame.origin[1] + 0.5 * frame.edge,
                              frame.origin[2] + 0.5 * frame.edge};
    void *out = fresh();
    void *never = UNTOUCHED;
    uint64_t number = 77;
    leafless_solid *round = NULL;
    leafless_boundary *boundary = NULL;
    leafless_boundary **reference = (leafless_boundary **)&never;
    leafless_mesh **made = (leafless_mesh **)&never;
    leafless_boundary_report *report = (leafless_boundary_report *)out;
    leafless_polyhedron_arrays *arrays = (leafless_polyhedron_arrays *)out;
    OK(leafless_solid_new_ball(middle, 0.25 * frame.edge, &round));
    OK(leafless_solid_boundary(round, &frame, frame.edge, NULL, &boundary));
    leafless_solid_free(round);
    NULL_POINTER(leafless_boundary_ref, boundary, leafless_boundary_ref(NULL, reference));
    NULL_POINTER(leafless_boundary_ref, reference, leafless_boundary_ref(boundary, NULL));
    MISALIGNED(leafless_boundary_ref, reference, leafless_boundary_ref(boundary, (leafless_boundary **)WRONG(out)));
    NULL_POINTER(leafless_boundary_describe, boundary, leafless_boundary_describe(NULL, report));
    NULL_POINTER(leafless_boundary_describe, report, leafless_boundary_describe(boundary, NULL));
    MISALIGNED(leafless_boundary_describe, report,
               leafless_boundary_describe(boundary, (leafless_boundary_report *)WRONG(out)));
    NULL_POINTER(leafless_boundary_mesh, boundary, leafless_boundary_mesh(NULL, made));
    NULL_POINTER(leafless_boundary_mesh, mesh, leafless_boundary_mesh(boundary, NULL));
    MISALIGNED(leafless_boundary_mesh, mesh, leafless_boundary_mesh(boundary, (leafless_mesh **)WRONG(out)));
    NULL_POINTER(leafless_boundary_surfaces, boundary, leafless_boundary_surfaces(NULL, NULL, 0, &number));
    NULL_POINTER(leafless_boundary_surfaces, surfaces, leafless_boundary_surfaces(boundary, NULL, 1, &number));
    NULL_POINTER(leafless_boundary_surfaces, count, leafless_boundary_surfaces(boundary, NULL, 0, NULL));
    MISALIGNED(leafless_boundary_surfaces, surfaces,
               leafless_boundary_surfaces(boundary, (leafless_boundary_surface *)WRONG(out), 1, &number));
    MISALIGNED(leafless_boundary_surfaces, count, leafless_boundary_surfaces(boundary, NULL, 0, (uint64_t *)WRONG(out)));
    NULL_POINTER(leafless_boundary_regions, boundary, leafless_boundary_regions(NULL, NULL, 0, &number));
    NULL_POINTER(leafless_boundary_regions, regions, leafless_boundary_regions(boundary, NULL, 1, &number));
    NULL_POINTER(leafless_boundary_regions, count, leafless_boundary_regions(boundary, NULL, 0, NULL));
    MISALIGNED(leafless_boundary_regions, regions,
               leafless_boundary_regions(boundary, (leafless_boundary_region *)WRONG(out), 1, &number));
    MISALIGNED(leafless_boundary_regions, count, leafless_boundary_regions(boundary, NULL, 0, (uint64_t *)WRONG(out)));
    NULL_POINTER(leafless_boundary_triangle_regions, boundary, leafless_boundary_triangle_regions(NULL, NULL, 0, &number));
    NULL_POINTER(leafless_boundary_triangle_regions, regions,
                 leafless_boundary_triangle_regions(boundary, NULL, 1, &number));
    NULL_POINTER(leafless_boundary_triangle_regions, count,
                 leafless_boundary_triangle_regions(boundary, NULL, 0, NULL));
    MISALIGNED(leafless_boundary_triangle_regions, regions,
               leafless_boundary_triangle_regions(boundary, (uint32_t *)WRONG(out), 1, &number));
    MISALIGNED(leafless_boundary_triangle_regions, count,
               leafless_boundary_triangle_regions(boundary, NULL, 0, (uint64_t *)WRONG(out)));
    NULL_POINTER(leafless_boundary_peek_faces, boundary, leafless_boundary_peek_faces(NULL, arrays));
    NULL_POINTER(leafless_boundary_peek_faces, arrays, leafless_boundary_peek_faces(boundary, NULL));
    MISALIGNED(leafless_boundary_peek_faces, arrays,
               leafless_boundary_peek_faces(boundary, (leafless_polyhedron_arrays *)WRONG(out)));
    untouched();
    CHECK(never == UNTOUCHED && number == 77);
    MAY_BE_NULL(leafless_boundary_surfaces, surfaces, leafless_boundary_surfaces(boundary, NULL, 0, &number));
    MAY_BE_NULL(leafless_boundary_regions, regions, leafless_boundary_regions(boundary, NULL, 0, &number));
    MAY_BE_NULL(leafless_boundary_triangle_regions, regions,
                leafless_boundary_triangle_regions(boundary, NULL, 0, &number));
    leafless_boundary_free(boundary);
    leafless_boundary_free(NULL);
    (void)fresh();
}

static void null_pointers(void) {
    void *out = fresh();
    void *never = UNTOUCHED;
    leafless_octree **result = (leafless_octree **)&never;
    leafless_mesh **mesh_result = (leafless_mesh **)&never;
    leafless_scene **scene_result = (leafless_scene **)&never;
    leafless_solid **solid_result = (leafless_solid **)&never;
    const leafless_octree *list[2];
    const leafless_solid *solids[2];
    uint32_t operation;
    const uint32_t exponents[3] = {2, 4, 3};
    const double triangle[6] = {0, 0, 1, 0, 0, 1};
    leafless_scene_mesh_info about_mesh = LEAFLESS_INIT(leafless_scene_mesh_info);
    leafless_solid_function function;
    leafless_solid_callbacks callbacks;
    const uint32_t cell[3] = {0, 0, 0};
    const leafless_mesh_arrays arrays = check_arrays(CHECK_CUBE, 8, CHECK_CUBE_TRIANGLES, 12);
    static const uint32_t faces[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, loops[] = {0, 3, 6, 9, 12};
    static const double corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    leafless_polyhedron_arrays polyhedron;
    uint8_t stl[84 + 50 * 12];
    const double matrix[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    uint64_t length = 0;
    uint8_t *bytes = check_bytes(octree, &length);
    leafless_measures measures = LEAFLESS_INIT(leafless_measures);
    leafless_mesh_moments moments = LEAFLESS_INIT(leafless_mesh_moments);
    leafless_intersecting_pair pair;
    bool is_complete;
    leafless_extent extent = LEAFLESS_INIT(leafless_extent);
    leafless_surface_area surface = LEAFLESS_INIT(leafless_surface_area);
    leafless_section_area section = LEAFLESS_INIT(leafless_section_area);
    double wanted[8][3];
    uint32_t indices[12][3];
    uint64_t number, other;
    const char *text;
    size_t text_length;
    bool flag;
    double real;

    memset(&callbacks, 0, sizeof callbacks);
    callbacks.struct_size = sizeof callbacks;
    callbacks.classify = classify;
    OK(leafless_init(&polyhedron, sizeof polyhedron));
    polyhedron.vertices = corners;
    polyhedron.vertex_count = 4;
    polyhedron.corners = faces;
    polyhedron.corner_count = 12;
    polyhedron.loops = loops;
    polyhedron.loop_count = 4;
    OK(mesh_to_stl(mesh, stl, sizeof stl, &number));
    check_write("null.stl", stl, sizeof stl);
    NULL_POINTER(leafless_init, value, leafless_init(NULL, sizeof(leafless_options)));
    MISALIGNED(leafless_init, value, leafless_init(WRONG(out), sizeof(leafless_options)));
    BAD_NUMBER(leafless_init, struct_size, leafless_init(out, 3));

    NULL_POINTER(leafless_control_new, control, leafless_control_new(NULL));
    NULL_POINTER(leafless_control_cancel, control, leafless_control_cancel(NULL));
    NULL_POINTER(leafless_control_reset, control, leafless_control_reset(NULL));
    NULL_POINTER(leafless_control_state, control, leafless_control_state(NULL, (bool *)out, (double *)out));
    MAY_BE_NULL(leafless_control_state, cancelled, leafless_control_state(control, NULL, &real));
    MAY_BE_NULL(leafless_control_state, fraction, leafless_control_state(control, &flag, NULL));

    NULL_POINTER(leafless_frame_check, frame, leafless_frame_check(NULL));
    NULL_POINTER(leafless_frame_around, min_model, leafless_frame_around(NULL, above, 4, (leafless_frame *)out));
    NULL_POINTER(leafless_frame_around, max_model, leafless_frame_around(point, NULL, 4, (leafless_frame *)out));
    NULL_POINTER(leafless_frame_around, frame, leafless_frame_around(point, above, 4, NULL));
    NULL_POINTER(leafless_frame_to_tolerance, min_model,
                 leafless_frame_to_tolerance(NULL, above, 0.5, 0, (leafless_frame *)out));
    NULL_POINTER(leafless_frame_to_tolerance, max_model,
                 leafless_frame_to_tolerance(point, NULL, 0.5, 0, (leafless_frame *)out));
    NULL_POINTER(leafless_frame_to_tolerance, frame, leafless_frame_to_tolerance(point, above, 0.5, 0, NULL));
    NULL_POINTER(leafless_frame_aligned, min_model, leafless_frame_aligned(NULL, above, 4, (leafless_frame *)out));
    NULL_POINTER(leafless_frame_aligned, max_model, leafless_frame_aligned(point, NULL, 4, (leafless_frame *)out));
    NULL_POINTER(leafless_frame_aligned, frame, leafless_frame_aligned(point, above, 4, NULL));
    NULL_POINTER(leafless_frame_fitted, min_model, leafless_frame_fitted(NULL, above, 4, (leafless_frame *)out));
    NULL_POINTER(leafless_frame_fitted, max_model, leafless_frame_fitted(point, NULL, 4, (leafless_frame *)out));
    NULL_POINTER(leafless_frame_fitted, frame, leafless_frame_fitted(point, above, 4, NULL));
    NULL_POINTER(leafless_frame_with_cells, min_model, leafless_frame_with_cells(NULL, above, 0.5, (leafless_frame *)out));
    NULL_POINTER(leafless_frame_with_cells, max_model, leafless_frame_with_cells(point, NULL, 0.5, (leafless_frame *)out));
    NULL_POINTER(leafless_frame_with_cells, frame, leafless_frame_with_cells(point, above, 0.5, NULL));
    NULL_POINTER(leafless_frame_cell_size, frame, leafless_frame_cell_size(NULL, (double *)out));
    NULL_POINTER(leafless_frame_cell_size, cell_size_model, leafless_frame_cell_size(&frame, NULL));
    NULL_POINTER(leafless_frame_cell_at, frame, leafless_frame_cell_at(NULL, point, (uint32_t *)out));
    NULL_POINTER(leafless_frame_cell_at, point_model, leafless_frame_cell_at(&frame, NULL, (uint32_t *)out));
    NULL_POINTER(leafless_frame_cell_at, cell, leafless_frame_cell_at(&frame, point, NULL));
    NULL_POINTER(leafless_frame_plane, frame, leafless_frame_plane(NULL, 0, 0, (leafless_interval *)out));
    NULL_POINTER(leafless_frame_plane, plane_model, leafless_frame_plane(&frame, 0, 0, NULL));

    NULL_POINTER(leafless_mesh_new, arrays, leafless_mesh_new(NULL, mesh_result));
    NULL_POINTER(leafless_mesh_new, mesh, leafless_mesh_new(&arrays, NULL));
    NULL_POINTER(leafless_mesh_from_polyhedron, arrays,
                 leafless_mesh_from_polyhedron(NULL, (double *)out, mesh_result));
    NULL_POINTER(leafless_mesh_from_polyhedron, mesh,
                 leafless_mesh_from_polyhedron(&polyhedron, (double *)out, NULL));
    NULL_POINTER(leafless_mesh_ref, mesh, leafless_mesh_ref(NULL, mesh_result));
    NULL_POINTER(leafless_mesh_ref, reference, leafless_mesh_ref(mesh, NULL));
    NULL_POINTER(leafless_mesh_describe, mesh, leafless_mesh_describe(NULL, (leafless_mesh_info *)out));
    NULL_POINTER(leafless_mesh_describe, info, leafless_mesh_describe(mesh, NULL));
    NULL_POINTER(leafless_mesh_copy, mesh, leafless_mesh_copy(NULL, (double *)out, 1, NULL, 0));
    NULL_POINTER(leafless_mesh_copy, vertices, leafless_mesh_copy(mesh, NULL, 8, NULL, 0));
    NULL_POINTER(leafless_mesh_copy, triangles, leafless_mesh_copy(mesh, NULL, 0, NULL, 12));
    MAY_BE_NULL(leafless_mesh_copy, vertices, leafless_mesh_copy(mesh, NULL, 0, &indices[0][0], 12));
    MAY_BE_NULL(leafless_mesh_copy, triangles, leafless_mesh_copy(mesh, &wanted[0][0], 8, NULL, 0));
    {
        static const double four[48] = {0};
        const char **name = (const char **)out;
        size_t *name_length = (size_t *)out + 1;
        uint32_t *components = (uint32_t *)((size_t *)out + 2);
        bool *per_corner = (bool *)((size_t *)out + 3);
        uint64_t *total = (uint64_t *)out + 5;
        void *untouched = UNTOUCHED;
        leafless_attribute **made = (leafless_attribute **)&untouched;
        NULL_POINTER(leafless_mesh_peek_attribute_at, mesh,
                     leafless_mesh_peek_attribute_at(NULL, 0, total, NULL, NULL, NULL, NULL));
        NULL_POINTER(leafless_mesh_peek_attribute_at, count,
                     leafless_mesh_peek_attribute_at(mesh, 0, NULL, NULL, NULL, NULL, NULL));
        NULL_POINTER(leafless_mesh_peek_attribute_at, name,
                     leafless_mesh_peek_attribute_at(mesh, 0, total, NULL, name_length, components, per_corner));
        NULL_POINTER(leafless_mesh_peek_attribute_at, name_length,
                     leafless_mesh_peek_attribute_at(mesh, 0, total, name, NULL, components, per_corner));
        NULL_POINTER(leafless_mesh_peek_attribute_at, components,
                     leafless_mesh_peek_attribute_at(mesh, 0, total, name, name_length, NULL, per_corner));
        NULL_POINTER(leafless_mesh_peek_attribute_at, per_corner,
                     leafless_mesh_peek_attribute_at(mesh, 0, total, name, name_length, components, NULL));
        NULL_POINTER(leafless_mesh_peek_attribute_name_at, mesh,
                     leafless_mesh_peek_attribute_name_at(NULL, 0, 0, total, NULL, NULL));
        NULL_POINTER(leafless_mesh_peek_attribute_name_at, count,
                     leafless_mesh_peek_attribute_name_at(mesh, 0, 0, NULL, NULL, NULL));
        NULL_POINTER(leafless_mesh_peek_attribute_name_at, name,
                     leafless_mesh_peek_attribute_name_at(mesh, 0, 0, total, NULL, name_length));
        NULL_POINTER(leafless_mesh_peek_attribute_name_at, name_length,
                     leafless_mesh_peek_attribute_name_at(mesh, 0, 0, total, name, NULL));
        NULL_POINTER(leafless_mesh_attribute_values, values, leafless_mesh_attribute_values(mesh, 0, NULL, 12, total));
        NULL_POINTER(leafless_mesh_attribute_values, count, leafless_mesh_attribute_values(mesh, 0, NULL, 0, NULL));
        MISALIGNED(leafless_mesh_attribute_values, values,
                   leafless_mesh_attribute_values(mesh, 0, (double *)WRONG(out), 12, total));
        NULL_POINTER(leafless_mesh_attribute_values, mesh, leafless_mesh_attribute_values(NULL, 0, NULL, 0, total));
        NULL_POINTER(leafless_mesh_bodies, mesh, leafless_mesh_bodies(NULL, NULL, 0, total));
        NULL_POINTER(leafless_mesh_bodies, count, leafless_mesh_bodies(mesh, NULL, 0, NULL));
        NULL_POINTER(leafless_mesh_bodies, bodies, leafless_mesh_bodies(mesh, NULL, 12, total));
        MISALIGNED(leafless_mesh_bodies, bodies, leafless_mesh_bodies(mesh, (uint32_t *)WRONG(out), 12, total));
        MAY_BE_NULL(leafless_mesh_bodies, bodies, leafless_mesh_bodies(mesh, NULL, 0, &number));
        {
            const double one = 1;
            leafless_attribute *constant = NULL;
            leafless_mesh *bearing = NULL;
            OK(leafless_attribute_new_constant(&one, 1, &constant));
            NULL_POINTER(leafless_mesh_with_values, mesh,
                         leafless_mesh_with_values(NULL, constant, "a", 1, 0, NULL, mesh_result));
            NULL_POINTER(leafless_mesh_with_values, attribute,
                         leafless_mesh_with_values(mesh, NULL, "a", 1, 0, NULL, mesh_result));
            NULL_POINTER(leafless_mesh_with_values, name,
                         leafless_mesh_with_values(mesh, constant, NULL, 1, 0, NULL, mesh_result));
            NULL_POINTER(leafless_mesh_with_values, bearing,
                         leafless_mesh_with_values(mesh, constant, "a", 1, 0, NULL, NULL));
            MISALIGNED(leafless_mesh_with_values, options,
                       leafless_mesh_with_values(mesh, constant, "a", 1, 0, (const leafless_options *)WRONG(&options),
                                                 mesh_result));
            MISALIGNED(leafless_mesh_with_values, bearing,
                       leafless_mesh_with_values(mesh, constant, "a", 1, 0, NULL, (leafless_mesh **)WRONG(out)));
            MAY_BE_NULL(leafless_mesh_with_values, options,
                        leafless_mesh_with_values(mesh, constant, "a", 1, 0, NULL, &bearing));
            leafless_mesh_free(bearing);
            leafless_attribute_free(constant);
        }
        NULL_POINTER(leafless_attribute_from_mesh, mesh, leafless_attribute_from_mesh(NULL, "a", 1, made));
        NULL_POINTER(leafless_attribute_from_mesh, name, leafless_attribute_from_mesh(mesh, NULL, 1, made));
        NULL_POINTER(leafless_attribute_from_mesh, attribute, leafless_attribute_from_mesh(mesh, "a", 1, NULL));
        NULL_POINTER(leafless_attribute_from_mesh_values, mesh,
                     leafless_attribute_from_mesh_values(NULL, four, 12, 1, false, made));
        NULL_POINTER(leafless_attribute_from_mesh_values, values,
                     leafless_attribute_from_mesh_values(mesh, NULL, 12, 1, false, made));
        NULL_POINTER(leafless_attribute_from_mesh_values, attribute,
                     leafless_attribute_from_mesh_values(mesh, four, 12, 1, false, NULL));
        MISALIGNED(leafless_attribute_from_mesh_values, values,
                   leafless_attribute_from_mesh_values(mesh, (const double *)WRONG(four), 11, 1, false, made));
    }
    NULL_POINTER(leafless_mesh_bounds, mesh, leafless_mesh_bounds(NULL, (double *)out, (double *)out + 3));
    NULL_POINTER(leafless_mesh_bounds, min_model, leafless_mesh_bounds(mesh, NULL, (double *)out));
    NULL_POINTER(leafless_mesh_bounds, max_model, leafless_mesh_bounds(mesh, (double *)out, NULL));
    NULL_POINTER(leafless_mesh_peek_warning_at, mesh,
                 leafless_mesh_peek_warning_at(NULL, 0, (uint64_t *)out, NULL, NULL));
    NULL_POINTER(leafless_mesh_peek_warning_at, count, leafless_mesh_peek_warning_at(mesh, 0, NULL, NULL, NULL));
    NULL_POINTER(leafless_mesh_peek_warning_at, warning,
                 leafless_mesh_peek_warning_at(mesh, 0, (uint64_t *)out, NULL, (size_t *)out + 1));
    NULL_POINTER(leafless_mesh_peek_warning_at, warning_length,
                 leafless_mesh_peek_warning_at(mesh, 0, (uint64_t *)out, (const char **)out + 1, NULL));
    NULL_POINTER(leafless_mesh_volume, mesh, leafless_mesh_volume(NULL, (double *)out));
    NULL_POINTER(leafless_mesh_volume, volume_model, leafless_mesh_volume(mesh, NULL));
    NULL_POINTER(leafless_mesh_inspect, mesh, leafless_mesh_inspect(NULL, (leafless_mesh_report *)out));
    NULL_POINTER(leafless_mesh_inspect, report, leafless_mesh_inspect(mesh, NULL));
    NULL_POINTER(leafless_mesh_defects, mesh, leafless_mesh_defects(NULL, 9, NULL, 0, (uint64_t *)out));
    NULL_POINTER(leafless_mesh_defects, defects, leafless_mesh_defects(mesh, 9, NULL, 9, (uint64_t *)out));
    MAY_BE_NULL(leafless_mesh_defects, defects, leafless_mesh_defects(mesh, 9, NULL, 0, &number));
    NULL_POINTER(leafless_mesh_defects, count,
                 leafless_mesh_defects(mesh, 9, (leafless_mesh_defect *)out, 2, NULL));
    NULL_POINTER(leafless_mesh_measure, mesh, leafless_mesh_measure(NULL, 0, NULL, (leafless_mesh_moments *)out));
    NULL_POINTER(leafless_mesh_measure, moments, leafless_mesh_measure(mesh, 0, NULL, NULL));
    NULL_POINTER(leafless_mesh_intersecting_pairs, mesh,
                 leafless_mesh_intersecting_pairs(NULL, NULL, NULL, 0, (uint64_t *)out, (bool *)out + 8));
    NULL_POINTER(leafless_mesh_intersecting_pairs, pairs,
                 leafless_mesh_intersecting_pairs(mesh, NULL, NULL, 9, (uint64_t *)out, (bool *)out + 8));
    NULL_POINTER(leafless_mesh_intersecting_pairs, count,
                 leafless_mesh_intersecting_pairs(mesh, NULL, NULL, 0, NULL, (bool *)out));
    NULL_POINTER(leafless_mesh_intersecting_pairs, is_complete,
                 leafless_mesh_intersecting_pairs(mesh, NULL, NULL, 0, (uint64_t *)out, NULL));
    NULL_POINTER(leafless_mesh_check_closed, mesh, leafless_mesh_check_closed(NULL, 0));
    NULL_POINTER(leafless_mesh_sewn, mesh, leafless_mesh_sewn(NULL, mesh_result));
    NULL_POINTER(leafless_mesh_sewn, sewn, leafless_mesh_sewn(mesh, NULL));
    NULL_POINTER(leafless_mesh_with_deviation, mesh, leafless_mesh_with_deviation(NULL, 0.5, mesh_result));
    NULL_POINTER(leafless_mesh_with_deviation, stated, leafless_mesh_with_deviation(mesh, 0.5, NULL));
    NULL_POINTER(leafless_mesh_transformed, mesh, leafless_mesh_transformed(NULL, matrix, mesh_result));
    NULL_POINTER(leafless_mesh_transformed, matrix, leafless_mesh_transformed(mesh, NULL, mesh_result));
    NULL_POINTER(leafless_mesh_transformed, moved, leafless_mesh_transformed(mesh, matrix, NULL));
    NULL_POINTER(leafless_mesh_translated, mesh, leafless_mesh_translated(NULL, point, mesh_result));
    NULL_POINTER(leafless_mesh_translated, offset_model, leafless_mesh_translated(mesh, NULL, mesh_result));
    NULL_POINTER(leafless_mesh_translated, moved, leafless_mesh_translated(mesh, point, NULL));

    NULL_POINTER(leafless_solid_new_ball, centre_model, leafless_solid_new_ball(NULL, 1, solid_result));
    NULL_POINTER(leafless_solid_new_ball, solid, leafless_solid_new_ball(point, 1, NULL));
    NULL_POINTER(leafless_solid_new_box, min_model, leafless_solid_new_box(NULL, above, solid_result));
    NULL_POINTER(leafless_solid_new_box, max_model, leafless_solid_new_box(point, NULL, solid_result));
    NULL_POINTER(leafless_solid_new_box, solid, leafless_solid_new_box(point, above, NULL));
    NULL_POINTER(leafless_solid_new_halfspace, normal, leafless_solid_new_halfspace(NULL, 1, solid_result));
    NULL_POINTER(leafless_solid_new_halfspace, solid, leafless_solid_new_halfspace(above, 1, NULL));
    NULL_POINTER(leafless_solid_new_quadric, coefficients, leafless_solid_new_quadric(NULL, solid_result));
    NULL_POINTER(leafless_solid_new_quadric, solid, leafless_solid_new_quadric(matrix, NULL));
    NULL_POINTER(leafless_solid_new_ellipsoid, centre_model,
                 leafless_solid_new_ellipsoid(NULL, above, NULL, solid_result));
    NULL_POINTER(leafless_solid_new_ellipsoid, radii_model,
                 leafless_solid_new_ellipsoid(point, NULL, NULL, solid_result));
    NULL_POINTER(leafless_solid_new_ellipsoid, solid, leafless_solid_new_ellipsoid(point, above, NULL, NULL));
    NULL_POINTER(leafless_solid_new_cylinder, from_model,
                 leafless_solid_new_cylinder(NULL, above, 1, solid_result));
    NULL_POINTER(leafless_solid_new_cylinder, to_model,
                 leafless_solid_new_cylinder(point, NULL, 1, solid_result));
    NULL_POINTER(leafless_solid_new_cylinder, solid, leafless_solid_new_cylinder(point, above, 1, NULL));
    NULL_POINTER(leafless_solid_new_frustum, from_model,
                 leafless_solid_new_frustum(NULL, above, 1, 0, solid_result));
    NULL_POINTER(leafless_solid_new_frustum, to_model,
                 leafless_solid_new_frustum(point, NULL, 1, 0, solid_result));
    NULL_POINTER(leafless_solid_new_frustum, solid, leafless_solid_new_frustum(point, above, 1, 0, NULL));
    NULL_POINTER(leafless_solid_new_power, coefficients,
                 leafless_solid_new_power(NULL, point, exponents, 1, solid_result));
    NULL_POINTER(leafless_solid_new_power, centre_model,
                 leafless_solid_new_power(above, NULL, exponents, 1, solid_result));
    NULL_POINTER(leafless_solid_new_power, exponents,
                 leafless_solid_new_power(above, point, NULL, 1, solid_result));
    NULL_POINTER(leafless_solid_new_power, solid, leafless_solid_new_power(above, point, exponents, 1, NULL));
    NULL_POINTER(leafless_solid_new_torus, centre_model, leafless_solid_new_torus(NULL, above, 2, 1, solid_result));
    NULL_POINTER(leafless_solid_new_torus, axis, leafless_solid_new_torus(point, NULL, 2, 1, solid_result));
    NULL_POINTER(leafless_solid_new_torus, solid, leafless_solid_new_torus(point, above, 2, 1, NULL));
    NULL_POINTER(leafless_solid_new_wedge, size_model, leafless_solid_new_wedge(NULL, 1, NULL, solid_result));
    NULL_POINTER(leafless_solid_new_wedge, solid, leafless_solid_new_wedge(above, 1, NULL, NULL));
    NULL_POINTER(leafless_solid_new_prism, polygon_model, leafless_solid_new_prism(NULL, 3, 0, 1, NULL, solid_result));
    NULL_POINTER(leafless_solid_new_prism, solid, leafless_solid_new_prism(triangle, 3, 0, 1, NULL, NULL));
    NULL_POINTER(leafless_solid_new_convex, planes, leafless_solid_new_convex(NULL, 3, solid_result));
    NULL_POINTER(leafless_solid_new_convex, solid, leafless_solid_new_convex(matrix, 3, NULL));
    NULL_POINTER(leafless_solid_new_function, function, leafless_solid_new_function(NULL, solid_result));
    memset(&function, 0, sizeof function);
    function.struct_size = sizeof function;
    refused(LEAFLESS_E_NULL, "leafless_solid_new_function", "function.value",
            leafless_solid_new_function(&function, solid_result));
    function.value = value;
    refused(LEAFLESS_E_NULL, "leafless_solid_new_function", "function.range",
            leafless_solid_new_function(&function, solid_result));
    function.range = range;
    NULL_POINTER(leafless_solid_new_function, solid, leafless_solid_new_function(&function, NULL));
    function.reserved = 1;
    refused(LEAFLESS_E_ARGUMENT, "leafless_solid_new_function", "function.reserved",
            leafless_solid_new_function(&function, solid_result));
    solids[0] = solids[1] = solid;
    for (operation = 0; operation < 4; operation++) {
        NULL_POINTER(leafless_solid_combine, solids, leafless_solid_combine(operation, NULL, 1, solid_result));
        NULL_POINTER(leafless_solid_combine, solids, leafless_solid_combine(operation, NULL, 2, solid_result));
        NULL_POINTER(leafless_solid_combine, result, leafless_solid_combine(operation, solids, 2, NULL));
        solids[1] = NULL;
        NULL_POINTER(leafless_solid_combine, solids, leafless_solid_combine(operation, solids, 2, solid_result));
        solids[0] = NULL, solids[1] = solid;
        NULL_POINTER(leafless_solid_combine, solids, leafless_solid_combine(operation, solids, 2, solid_result));
        solids[0] = solid;
        if (operation == LEAFLESS_OPERATION_DIFFERENCE) {
            BAD_NUMBER(leafless_solid_combine, count, leafless_solid_combine(operation, NULL, 0, solid_result));
        } else {
            NULL_POINTER(leafless_solid_combine, result, leafless_solid_combine(operation, NULL, 0, NULL));
        }
    }
    BAD_NUMBER(leafless_solid_combine, operation, leafless_solid_combine(4, solids, 2, solid_result));
    BAD_NUMBER(leafless_solid_combine, operation, leafless_solid_combine(UINT32_MAX, solids, 2, solid_result));
    NULL_POINTER(leafless_solid_complement, operand, leafless_solid_complement(NULL, solid_result));
    NULL_POINTER(leafless_solid_complement, solid, leafless_solid_complement(solid, NULL));
    NULL_POINTER(leafless_solid_adaptive, operand, leafless_solid_adaptive(NULL, 0.1, solid_result));
    NULL_POINTER(leafless_solid_adaptive, solid, leafless_solid_adaptive(solid, 0.1, NULL));
    NULL_POINTER(leafless_solid_placed, operand,
                 leafless_solid_placed(NULL, matrix, (leafless_motion *)out, solid_result));
    NULL_POINTER(leafless_solid_placed, matrix,
                 leafless_solid_placed(solid, NULL, (leafless_motion *)out, solid_result));
    NULL_POINTER(leafless_solid_placed, solid, leafless_solid_placed(solid, matrix, (leafless_motion *)out, NULL));
    NULL_POINTER(leafless_solid_describe, solid, leafless_solid_describe(NULL, (leafless_solid_info *)out));
    NULL_POINTER(leafless_solid_describe, info, leafless_solid_describe(solid, NULL));
    NULL_POINTER(leafless_solid_resampled, operand, leafless_solid_resampled(NULL, &frame, matrix, solid_result));
    NULL_POINTER(leafless_solid_resampled, own, leafless_solid_resampled(solid, NULL, matrix, solid_result));
    NULL_POINTER(leafless_solid_resampled, matrix, leafless_solid_resampled(solid, &frame, NULL, solid_result));
    NULL_POINTER(leafless_solid_resampled, solid, leafless_solid_resampled(solid, &frame, matrix, NULL));
    NULL_POINTER(leafless_solid_transformed, operand,
                 leafless_solid_transformed(NULL, &frame, matrix, solid_result));
    NULL_POINTER(leafless_solid_transformed, own, leafless_solid_transformed(solid, NULL, matrix, solid_result));
    NULL_POINTER(leafless_solid_transformed, matrix, leafless_solid_transformed(solid, &frame, NULL, solid_result));
    NULL_POINTER(leafless_solid_transformed, solid, leafless_solid_transformed(solid, &frame, matrix, NULL));
    NULL_POINTER(leafless_solid_interfere, a,
                 leafless_solid_interfere(NULL, solid, &frame, 0, NULL, (leafless_interference *)out));
    NULL_POINTER(leafless_solid_interfere, b,
                 leafless_solid_interfere(solid, NULL, &frame, 0, NULL, (leafless_interference *)out));
    NULL_POINTER(leafless_solid_interfere, frame,
                 leafless_solid_interfere(solid, solid, NULL, 0, NULL, (leafless_interference *)out));
    NULL_POINTER(leafless_solid_interfere, interference, leafless_solid_interfere(solid, solid, &frame, 0, NULL, NULL));
    NULL_POINTER(leafless_solid_interfere_many, a,
                 leafless_solid_interfere_many(NULL, solid, &frame, matrix, 1, &frame, 0, NULL, (leafless_interference *)out));
    NULL_POINTER(leafless_solid_interfere_many, b,
                 leafless_solid_interfere_many(solid, NULL, &frame, matrix, 1, &frame, 0, NULL, (leafless_interference *)out));
    NULL_POINTER(leafless_solid_interfere_many, own,
                 leafless_solid_interfere_many(solid, solid, NULL, matrix, 1, &frame, 0, NULL, (leafless_interference *)out));
    NULL_POINTER(leafless_solid_interfere_many, matrices,
                 leafless_solid_interfere_many(solid, solid, &frame, NULL, 1, &frame, 0, NULL, (leafless_interference *)out));
    NULL_POINTER(leafless_solid_interfere_many, frame,
                 leafless_solid_interfere_many(solid, solid, &frame, matrix, 1, NULL, 0, NULL, (leafless_interference *)out));
    NULL_POINTER(leafless_solid_interfere_many, interferences,
                 leafless_solid_interfere_many(solid, solid, &frame, matrix, 1, &frame, 0, NULL, NULL));
    NULL_POINTER(leafless_solid_clearance, a,
                 leafless_solid_clearance(NULL, solid, &frame, 0, NULL, (leafless_clearance *)out));
    NULL_POINTER(leafless_solid_clearance, b,
                 leafless_solid_clearance(solid, NULL, &frame, 0, NULL, (leafless_clearance *)out));
    NULL_POINTER(leafless_solid_clearance, frame,
                 leafless_solid_clearance(solid, solid, NULL, 0, NULL, (leafless_clearance *)out));
    NULL_POINTER(leafless_solid_gap_at_least, a,
                 leafless_solid_gap_at_least(NULL, solid, &frame, 1, NULL, (leafless_gap *)out));
    NULL_POINTER(leafless_solid_gap_at_least, b,
                 leafless_solid_gap_at_least(solid, NULL, &frame, 1, NULL, (leafless_gap *)out));
    NULL_POINTER(leafless_solid_gap_at_least, frame,
                 leafless_solid_gap_at_least(solid, solid, NULL, 1, NULL, (leafless_gap *)out));
    NULL_POINTER(leafless_solid_gap_at_least, gap, leafless_solid_gap_at_least(solid, solid, &frame, 1, NULL, NULL));
    NULL_POINTER(leafless_solid_clearance_many, a,
                 leafless_solid_clearance_many(NULL, solid, &frame, matrix, 1, &frame, 0, NULL, (leafless_placed_clearance *)out));
    NULL_POINTER(leafless_solid_gap_at_least_many, a,
                 leafless_solid_gap_at_least_many(NULL, solid, &frame, matrix, 1, &frame, 1, NULL, (leafless_placed_gap *)out));
    NULL_POINTER(leafless_solid_clearance_many, b,
                 leafless_solid_clearance_many(solid, NULL, &frame, matrix, 1, &frame, 0, NULL, (leafless_placed_clearance *)out));
    NULL_POINTER(leafless_solid_gap_at_least_many, b,
                 leafless_solid_gap_at_least_many(solid, NULL, &frame, matrix, 1, &frame, 1, NULL, (leafless_placed_gap *)out));
    NULL_POINTER(leafless_solid_clearance_many, own,
                 leafless_solid_clearance_many(solid, solid, NULL, matrix, 1, &frame, 0, NULL, (leafless_placed_clearance *)out));
    NULL_POINTER(leafless_solid_gap_at_least_many, own,
                 leafless_solid_gap_at_least_many(solid, solid, NULL, matrix, 1, &frame, 1, NULL, (leafless_placed_gap *)out));
    NULL_POINTER(leafless_solid_clearance_many, matrices,
                 leafless_solid_clearance_many(solid, solid, &frame, NULL, 1, &frame, 0, NULL, (leafless_placed_clearance *)out));
    NULL_POINTER(leafless_solid_gap_at_least_many, matrices,
                 leafless_solid_gap_at_least_many(solid, solid, &frame, NULL, 1, &frame, 1, NULL, (leafless_placed_gap *)out));
    NULL_POINTER(leafless_solid_clearance_many, frame,
                 leafless_solid_clearance_many(solid, solid, &frame, matrix, 1, NULL, 0, NULL, (leafless_placed_clearance *)out));
    NULL_POINTER(leafless_solid_gap_at_least_many, frame,
                 leafless_solid_gap_at_least_many(solid, solid, &frame, matrix, 1, NULL, 1, NULL, (leafless_placed_gap *)out));
    NULL_POINTER(leafless_solid_clearance_many, clearances,
                 leafless_solid_clearance_many(solid, solid, &frame, matrix, 1, &frame, 0, NULL, NULL));
    NULL_POINTER(leafless_solid_gap_at_least_many, gaps,
                 leafless_solid_gap_at_least_many(solid, solid, &frame, matrix, 1, &frame, 1, NULL, NULL));
    NULL_POINTER(leafless_solid_clearance, clearance, leafless_solid_clearance(solid, solid, &frame, 0, NULL, NULL));
    NULL_POINTER(leafless_solid_deviation, a,
                 leafless_solid_deviation(NULL, solid, &frame, 0, 0, NULL, (leafless_deviation *)out));
    NULL_POINTER(leafless_solid_deviation, b,
                 leafless_solid_deviation(solid, NULL, &frame, 0, 0, NULL, (leafless_deviation *)out));
    NULL_POINTER(leafless_solid_deviation, frame,
                 leafless_solid_deviation(solid, solid, NULL, 0, 0, NULL, (leafless_deviation *)out));
    NULL_POINTER(leafless_solid_deviation, deviation,
                 leafless_solid_deviation(solid, solid, &frame, 0, 0, NULL, NULL));
    NULL_POINTER(leafless_solid_with_touch, operand, leafless_solid_with_touch(NULL, 0, solid_result));
    NULL_POINTER(leafless_solid_with_touch, solid, leafless_solid_with_touch(solid, 0, NULL));
    BAD_NUMBER(leafless_solid_with_touch, touch, leafless_solid_with_touch(solid, 7, solid_result));
    OK(scene_from_text("mesh(\"null.stl\");", "", LEAFLESS_FACETS_AUTO, &scene));
    NULL_POINTER(leafless_scene_describe, scene, leafless_scene_describe(NULL, (leafless_scene_info *)out));
    NULL_POINTER(leafless_scene_describe, report, leafless_scene_describe(scene, NULL));
    NULL_POINTER(leafless_scene_describe_mesh_at, scene,
                 leafless_scene_describe_mesh_at(NULL, 0, (leafless_scene_mesh_info *)out, NULL));
    MISALIGNED(leafless_scene_describe_mesh_at, report,
               leafless_scene_describe_mesh_at(scene, 0, &about_mesh, (leafless_mesh_report *)WRONG(out)));
    NULL_POINTER(leafless_scene_describe_mesh_at, mesh, leafless_scene_describe_mesh_at(scene, 0, NULL, NULL));
    MAY_BE_NULL(leafless_scene_describe_mesh_at, report, leafless_scene_describe_mesh_at(scene, 0, &about_mesh, NULL));
    MAY_BE_NULL(leafless_scene_mesh_file_at, bytes, leafless_scene_mesh_file_at(scene, 0, NULL, 0, &number));
    NULL_POINTER(leafless_scene_mesh_file_at, length, leafless_scene_mesh_file_at(scene, 0, NULL, 0, NULL));
    NULL_POINTER(leafless_scene_mesh_file_at, scene, leafless_scene_mesh_file_at(NULL, 0, NULL, 0, (uint64_t *)out));
    NULL_POINTER(leafless_scene_bounds, scene, leafless_scene_bounds(NULL, (double *)out, (double *)out + 3));
    NULL_POINTER(leafless_scene_bounds, min_model, leafless_scene_bounds(scene, NULL, (double *)out));
    NULL_POINTER(leafless_scene_bounds, max_model, leafless_scene_bounds(scene, (double *)out, NULL));
    NULL_POINTER(leafless_scene_ref, scene, leafless_scene_ref(NULL, scene_result));
    NULL_POINTER(leafless_scene_ref, reference, leafless_scene_ref(scene, NULL));
    NULL_POINTER(leafless_solid_from_scene, scene, leafless_solid_from_scene(NULL, &frame, solid_result));
    NULL_POINTER(leafless_solid_from_scene, frame, leafless_solid_from_scene(scene, NULL, solid_result));
    NULL_POINTER(leafless_solid_from_scene, solid, leafless_solid_from_scene(scene, &frame, NULL));
    leafless_scene_free(scene);
    leafless_scene_free(NULL);
    NULL_POINTER(leafless_solid_from_mesh, mesh, leafless_solid_from_mesh(NULL, 0, solid_result));
    NULL_POINTER(leafless_solid_from_mesh, solid, leafless_solid_from_mesh(mesh, 0, NULL));
    NULL_POINTER(leafless_solid_new_callbacks, callbacks, leafless_solid_new_callbacks(NULL, solid_result));
    NULL_POINTER(leafless_solid_new_callbacks, solid, leafless_solid_new_callbacks(&callbacks, NULL));
    callbacks.classify = NULL;
    refused(LEAFLESS_E_NULL, "leafless_solid_new_callbacks", "callbacks.classify",
            leafless_solid_new_callbacks(&callbacks, solid_result));
    callbacks.classify_many = classify_many;
    refused(LEAFLESS_E_NULL, "leafless_solid_new_callbacks", "callbacks.classify",
            leafless_solid_new_callbacks(&callbacks, solid_result));
    callbacks.distance_many = distance_many;
    refused(LEAFLESS_E_NULL, "leafless_solid_new_callbacks", "callbacks.classify",
            leafless_solid_new_callbacks(&callbacks, solid_result));
    callbacks.classify_many = NULL;
    NULL_POINTER(leafless_solid_new_callbacks, solid, leafless_solid_new_callbacks(&callbacks, NULL));
    NULL_POINTER(leafless_solid_from_octree, octree, leafless_solid_from_octree(NULL, solid_result));
    NULL_POINTER(leafless_solid_from_octree, solid, leafless_solid_from_octree(octree, NULL));
    NULL_POINTER(leafless_solid_ref, solid, leafless_solid_ref(NULL, solid_result));
    NULL_POINTER(leafless_solid_ref, reference, leafless_solid_ref(solid, NULL));

    NULL_POINTER(leafless_octree_build, solid, leafless_octree_build(NULL, &frame, 0, NULL, result));
    NULL_POINTER(leafless_octree_build, frame, leafless_octree_build(solid, NULL, 0, NULL, result));
    NULL_POINTER(leafless_octree_build, octree, leafless_octree_build(solid, &frame, 0, NULL, NULL));
    NULL_POINTER(leafless_octree_new_uniform, frame, leafless_octree_new_uniform(NULL, 0, 0, result));
    NULL_POINTER(leafless_octree_new_uniform, octree, leafless_octree_new_uniform(&frame, 0, 0, NULL));
    NULL_POINTER(leafless_octree_resolve, octree, leafless_octree_resolve(NULL, 2, NULL, result));
    NULL_POINTER(leafless_octree_resolve, resolved, leafless_octree_resolve(octree, 2, NULL, NULL));
    NULL_POINTER(leafless_octree_compact, octree, leafless_octree_compact(NULL, result));
    NULL_POINTER(leafless_octree_compact, compacted, leafless_octree_compact(octree, NULL));
    NULL_POINTER(leafless_octree_ref, octree, leafless_octree_ref(NULL, result));
    NULL_POINTER(leafless_octree_ref, reference, leafless_octree_ref(octree, NULL));
    NULL_POINTER(leafless_octree_describe, octree, leafless_octree_describe(NULL, (leafless_octree_info *)out));
    NULL_POINTER(leafless_octree_describe, info, leafless_octree_describe(octree, NULL));
    NULL_POINTER(leafless_octree_with_proof, octree, leafless_octree_with_proof(NULL, 3, 0, result));
    NULL_POINTER(leafless_octree_with_proof, result, leafless_octree_with_proof(octree, 3, 0, NULL));
    NULL_POINTER(leafless_octree_statistics, octree, leafless_octree_statistics(NULL, (leafless_statistics *)out));
    NULL_POINTER(leafless_octree_statistics, statistics, leafless_octree_statistics(octree, NULL));
    NULL_POINTER(leafless_octree_levels, octree, leafless_octree_levels(NULL, NULL, 0, (uint64_t *)out));
    NULL_POINTER(leafless_octree_levels, levels, leafless_octree_levels(octree, NULL, 5, (uint64_t *)out));
    MAY_BE_NULL(leafless_octree_levels, levels, leafless_octree_levels(octree, NULL, 0, &number));
    NULL_POINTER(leafless_octree_levels, count, leafless_octree_levels(octree, NULL, 0, NULL));
    NULL_POINTER(leafless_octree_check, octree, leafless_octree_check(NULL));
    NULL_POINTER(leafless_octree_equal, a, leafless_octree_equal(NULL, octree, (bool *)out));
    NULL_POINTER(leafless_octree_equal, b, leafless_octree_equal(octree, NULL, (bool *)out));
    NULL_POINTER(leafless_octree_equal, equal, leafless_octree_equal(octree, octree, NULL));

    NULL_POINTER(leafless_octree_with_metadata, octree, leafless_octree_with_metadata(NULL, "a", 1, "b", 1, result));
    NULL_POINTER(leafless_octree_with_metadata, key, leafless_octree_with_metadata(octree, NULL, 1, "b", 1, result));
    NULL_POINTER(leafless_octree_with_metadata, value, leafless_octree_with_metadata(octree, "a", 1, NULL, 1, result));
    NULL_POINTER(leafless_octree_without_metadata, octree, leafless_octree_without_metadata(NULL, "a", 1, result));
    NULL_POINTER(leafless_octree_without_metadata, unnamed, leafless_octree_without_metadata(octree, "a", 1, NULL));
    NULL_POINTER(leafless_octree_with_metadata, named, leafless_octree_with_metadata(octree, "a", 1, "b", 1, NULL));
    NULL_POINTER(leafless_octree_peek_metadata, octree,
                 leafless_octree_peek_metadata(NULL, "a", 1, (const char **)out, (size_t *)out + 1));
    NULL_POINTER(leafless_octree_peek_metadata, key,
                 leafless_octree_peek_metadata(octree, NULL, 1, (const char **)out, (size_t *)out + 1));
    NULL_POINTER(leafless_octree_peek_metadata, value,
                 leafless_octree_peek_metadata(octree, "a", 1, NULL, (size_t *)out));
    NULL_POINTER(leafless_octree_peek_metadata, value_length,
                 leafless_octree_peek_metadata(octree, "a", 1, (const char **)out, NULL));
    NULL_POINTER(leafless_octree_peek_metadata_at, octree,
                 leafless_octree_peek_metadata_at(NULL, 0, (uint64_t *)out, NULL, NULL, NULL, NULL));
    NULL_POINTER(leafless_octree_peek_metadata_at, count,
                 leafless_octree_peek_metadata_at(octree, 0, NULL, NULL, NULL, NULL, NULL));
    NULL_POINTER(leafless_octree_peek_metadata_at, key,
                 leafless_octree_peek_metadata_at(octree, 0, (uint64_t *)out, NULL, (size_t *)out + 1,
                                                  (const char **)out + 2, (size_t *)out + 3));
    NULL_POINTER(leafless_octree_peek_metadata_at, key_length,
                 leafless_octree_peek_metadata_at(octree, 0, (uint64_t *)out, (const char **)out + 1, NULL,
                                                  (const char **)out + 2, (size_t *)out + 3));
    NULL_POINTER(leafless_octree_peek_metadata_at, value,
                 leafless_octree_peek_metadata_at(octree, 0, (uint64_t *)out, (const char **)out + 1,
                                                  (size_t *)out + 2, NULL, (size_t *)out + 3));
    NULL_POINTER(leafless_octree_peek_metadata_at, value_length,
                 leafless_octree_peek_metadata_at(octree, 0, (uint64_t *)out, (const char **)out + 1,
                                                  (size_t *)out + 2, (const char **)out + 3, NULL));

    NULL_POINTER(leafless_octree_complement, octree, leafless_octree_complement(NULL, NULL, result));
    NULL_POINTER(leafless_octree_complement, result, leafless_octree_complement(octree, NULL, NULL));
    list[0] = list[1] = octree;
    for (operation = 0; operation < 4; operation++) {
        NULL_POINTER(leafless_octree_combine, octrees, leafless_octree_combine(operation, NULL, 2, NULL, result));
        NULL_POINTER(leafless_octree_combine, result, leafless_octree_combine(operation, list, 2, NULL, NULL));
        BAD_NUMBER(leafless_octree_combine, count, leafless_octree_combine(operation, list, 0, NULL, result));
        BAD_NUMBER(leafless_octree_combine, count, leafless_octree_combine(operation, NULL, 0, NULL, result));
        list[1] = NULL;
        NULL_POINTER(leafless_octree_combine, octrees, leafless_octree_combine(operation, list, 2, NULL, result));
        list[0] = NULL, list[1] = octree;
        NULL_POINTER(leafless_octree_combine, octrees, leafless_octree_combine(operation, list, 2, NULL, result));
        list[0] = octree;
    }
    BAD_NUMBER(leafless_octree_combine, operation, leafless_octree_combine(4, list, 2, NULL, result));
    BAD_NUMBER(leafless_octree_combine, operation, leafless_octree_combine(UINT32_MAX, list, 2, NULL, result));

    NULL_POINTER(leafless_octree_contains, octree, leafless_octree_contains(NULL, point, (leafless_membership *)out));
    NULL_POINTER(leafless_octree_contains, point_model,
                 leafless_octree_contains(octree, NULL, (leafless_membership *)out));
    NULL_POINTER(leafless_octree_contains, membership, leafless_octree_contains(octree, point, NULL));
    NULL_POINTER(leafless_octree_contains_many, octree,
                 leafless_octree_contains_many(NULL, point, 1, (leafless_membership *)out));
    NULL_POINTER(leafless_octree_contains_many, octree, leafless_octree_contains_many(NULL, NULL, 0, NULL));
    NULL_POINTER(leafless_octree_contains_many, points_model,
                 leafless_octree_contains_many(octree, NULL, 1, (leafless_membership *)out));
    NULL_POINTER(leafless_octree_contains_many, memberships, leafless_octree_contains_many(octree, point, 1, NULL));
    NULL_POINTER(leafless_octree_tag_at, octree, leafless_octree_tag_at(NULL, cell, (leafless_tag *)out));
    NULL_POINTER(leafless_octree_tag_at, cell, leafless_octree_tag_at(octree, NULL, (leafless_tag *)out));
    NULL_POINTER(leafless_octree_tag_at, tag, leafless_octree_tag_at(octree, cell, NULL));
    NULL_POINTER(leafless_octree_classify_box, octree,
                 leafless_octree_classify_box(NULL, point, above, (leafless_region *)out));
    NULL_POINTER(leafless_octree_classify_box, min_model,
                 leafless_octree_classify_box(octree, NULL, above, (leafless_region *)out));
    NULL_POINTER(leafless_octree_classify_box, max_model,
                 leafless_octree_classify_box(octree, point, NULL, (leafless_region *)out));
    NULL_POINTER(leafless_octree_classify_box, region, leafless_octree_classify_box(octree, point, above, NULL));
    NULL_POINTER(leafless_solid_contains_many, solid,
                 leafless_solid_contains_many(NULL, &frame, point, 1, NULL, (leafless_membership *)out));
    NULL_POINTER(leafless_solid_contains_many, solid, leafless_solid_contains_many(NULL, &frame, NULL, 0, NULL, NULL));
    NULL_POINTER(leafless_solid_contains_many, frame,
                 leafless_solid_contains_many(solid, NULL, point, 1, NULL, (leafless_membership *)out));
    NULL_POINTER(leafless_solid_contains_many, frame, leafless_solid_contains_many(solid, NULL, NULL, 0, NULL, NULL));
    NULL_POINTER(leafless_solid_contains_many, points_model,
                 leafless_solid_contains_many(solid, &frame, NULL, 1, NULL, (leafless_membership *)out));
    NULL_POINTER(leafless_solid_contains_many, memberships,
                 leafless_solid_contains_many(solid, &frame, point, 1, NULL, NULL));
    NULL_POINTER(leafless_solid_classify_box, solid,
                 leafless_solid_classify_box(NULL, &frame, point, above, NULL, (leafless_region *)out));
    NULL_POINTER(leafless_solid_classify_box, frame,
                 leafless_solid_classify_box(solid, NULL, point, above, NULL, (leafless_region *)out));
    NULL_POINTER(leafless_solid_classify_box, min_model,
                 leafless_solid_classify_box(solid, &frame, NULL, above, NULL, (leafless_region *)out));
    NULL_POINTER(leafless_solid_classify_box, max_model,
                 leafless_solid_classify_box(solid, &frame, point, NULL, NULL, (leafless_region *)out));
    NULL_POINTER(leafless_solid_classify_box, region,
                 leafless_solid_classify_box(solid, &frame, point, above, NULL, NULL));
    NULL_POINTER(leafless_point_cursor_new, octree, leafless_point_cursor_new(NULL, (leafless_point_cursor **)out));
    NULL_POINTER(leafless_point_cursor_new, cursor, leafless_point_cursor_new(octree, NULL));
    NULL_POINTER(leafless_point_cursor_contains, cursor,
                 leafless_point_cursor_contains(NULL, point, (leafless_membership *)out));
    NULL_POINTER(leafless_point_cursor_contains, point_model,
                 leafless_point_cursor_contains(point_cursor, NULL, (leafless_membership *)out));
    NULL_POINTER(leafless_point_cursor_contains, membership, leafless_point_cursor_contains(point_cursor, point, NULL));
    NULL_POINTER(leafless_point_cursor_tag_at, cursor, leafless_point_cursor_tag_at(NULL, cell, (leafless_tag *)out));
    NULL_POINTER(leafless_point_cursor_tag_at, cell,
                 leafless_point_cursor_tag_at(point_cursor, NULL, (leafless_tag *)out));
    NULL_POINTER(leafless_point_cursor_tag_at, tag, leafless_point_cursor_tag_at(point_cursor, cell, NULL));
    NULL_POINTER(leafless_point_table_new, octree,
                 leafless_point_table_new(NULL, 4, (leafless_point_table **)&never, (uint8_t *)out));
    NULL_POINTER(leafless_point_table_new, table, leafless_point_table_new(octree, 4, NULL, (uint8_t *)out));
    NULL_POINTER(leafless_point_table_new, table_level,
                 leafless_point_table_new(octree, 4, (leafless_point_table **)&never, NULL));
    NULL_POINTER(leafless_point_table_contains, table,
                 leafless_point_table_contains(NULL, point, (leafless_membership *)out));
    NULL_POINTER(leafless_point_table_contains, point_model,
                 leafless_point_table_contains(point_table, NULL, (leafless_membership *)out));
    NULL_POINTER(leafless_point_table_contains, membership, leafless_point_table_contains(point_table, point, NULL));
    NULL_POINTER(leafless_point_table_contains_many, table,
                 leafless_point_table_contains_many(NULL, point, 1, (leafless_membership *)out));
    NULL_POINTER(leafless_point_table_contains_many, points_model,
                 leafless_point_table_contains_many(point_table, NULL, 1, (leafless_membership *)out));
    NULL_POINTER(leafless_point_table_contains_many, memberships,
                 leafless_point_table_contains_many(point_table, point, 1, NULL));
    NULL_POINTER(leafless_cursor_new, octree, leafless_cursor_new(NULL, (leafless_cursor **)out));
    NULL_POINTER(leafless_cursor_new, cursor, leafless_cursor_new(octree, NULL));
    NULL_POINTER(leafless_cursor_describe, cursor, leafless_cursor_describe(NULL, (leafless_cursor_info *)out));
    NULL_POINTER(leafless_cursor_describe, state, leafless_cursor_describe(cursor, NULL));
    NULL_POINTER(leafless_cursor_descend, cursor, leafless_cursor_descend(NULL, 0, (bool *)out));
    MAY_BE_NULL(leafless_cursor_descend, moved, leafless_cursor_descend(cursor, 0, NULL));
    NULL_POINTER(leafless_cursor_ascend, cursor, leafless_cursor_ascend(NULL, (bool *)out));
    MAY_BE_NULL(leafless_cursor_ascend, moved, leafless_cursor_ascend(cursor, NULL));

    /* Nothing was written. */
    untouched();
    CHECK(never == UNTOUCHED);

    /* Texts of no bytes may be NULL, and so may options and empty arrays. */
    MAY_BE_NULL(leafless_octree_without_metadata, key, leafless_octree_without_metadata(octree, NULL, 0, result));
    leafless_octree_free(*result);
    MAY_BE_NULL(leafless_octree_with_metadata, key, leafless_octree_with_metadata(octree, NULL, 0, NULL, 0, result));
    leafless_octree_free(*result);
    MAY_BE_NULL(leafless_octree_peek_metadata, key,
                leafless_octree_peek_metadata(octree, NULL, 0, &text, &text_length));
    {
        leafless_solid *moved = NULL;
        MAY_BE_NULL(leafless_solid_new_ellipsoid, matrix, leafless_solid_new_ellipsoid(point, above, NULL, &moved));
        leafless_solid_free(moved);
        MAY_BE_NULL(leafless_solid_new_wedge, matrix, leafless_solid_new_wedge(above, 1, NULL, &moved));
        leafless_solid_free(moved);
        MAY_BE_NULL(leafless_solid_new_prism, matrix, leafless_solid_new_prism(outline, 3, 0, 1, NULL, &moved));
        leafless_solid_free(moved);
    }
    {
        leafless_interference found;
        leafless_clearance near = LEAFLESS_INIT(leafless_clearance);
        leafless_deviation apart = LEAFLESS_INIT(leafless_deviation);
        leafless_gap gap = LEAFLESS_INIT(leafless_gap);
        leafless_placed_clearance placed;
        leafless_placed_gap placed_gap;
        MAY_BE_NULL(leafless_solid_interfere, options,
                    leafless_solid_interfere(solid, solid, &frame, 0, NULL, &found));
        MAY_BE_NULL(leafless_solid_interfere_many, options,
                    leafless_solid_interfere_many(solid, solid, &frame, matrix, 1, &frame, 0, NULL, &found));
        MAY_BE_NULL(leafless_solid_interfere_many, matrices,
                    leafless_solid_interfere_many(solid, solid, &frame, NULL, 0, &frame, 0, NULL, &found));
        MAY_BE_NULL(leafless_solid_interfere_many, interferences,
                    leafless_solid_interfere_many(solid, solid, &frame, NULL, 0, &frame, 0, NULL, NULL));
        MAY_BE_NULL(leafless_solid_clearance, options,
                    leafless_solid_clearance(solid, solid, &frame, 1, NULL, &near));
        MAY_BE_NULL(leafless_solid_deviation, options,
                    leafless_solid_deviation(solid, solid, &frame, 1, 1, NULL, &apart));
        MAY_BE_NULL(leafless_solid_gap_at_least, options,
                    leafless_solid_gap_at_least(solid, solid, &frame, 1, NULL, &gap));
        MAY_BE_NULL(leafless_solid_clearance_many, options,
                    leafless_solid_clearance_many(solid, solid, &frame, matrix, 1, &frame, 1, NULL, &placed));
        MAY_BE_NULL(leafless_solid_gap_at_least_many, options,
                    leafless_solid_gap_at_least_many(solid, solid, &frame, matrix, 1, &frame, 1, NULL, &placed_gap));
        MAY_BE_NULL(leafless_solid_clearance_many, matrices,
                    leafless_solid_clearance_many(solid, solid, &frame, NULL, 0, &frame, 0, NULL, &placed));
        MAY_BE_NULL(leafless_solid_gap_at_least_many, matrices,
                    leafless_solid_gap_at_least_many(solid, solid, &frame, NULL, 0, &frame, 1, NULL, &placed_gap));
        MAY_BE_NULL(leafless_solid_clearance_many, clearances,
                    leafless_solid_clearance_many(solid, solid, &frame, NULL, 0, &frame, 0, NULL, NULL));
        MAY_BE_NULL(leafless_solid_gap_at_least_many, gaps,
                    leafless_solid_gap_at_least_many(solid, solid, &frame, NULL, 0, &frame, 1, NULL, NULL));
    }
    {
        leafless_membership membership;
        leafless_region region;
        leafless_motion motion = 77;
        MAY_BE_NULL(leafless_solid_contains_many, options,
                    leafless_solid_contains_many(solid, &frame, point, 1, NULL, &membership));
        CHECK(membership == LEAFLESS_MEMBERSHIP_INSIDE);
        MAY_BE_NULL(leafless_solid_contains_many, points_model,
                    leafless_solid_contains_many(solid, &frame, NULL, 0, &options, &membership));
        MAY_BE_NULL(leafless_solid_contains_many, memberships,
                    leafless_solid_contains_many(solid, &frame, NULL, 0, &options, NULL));
        MAY_BE_NULL(leafless_solid_classify_box, options,
                    leafless_solid_classify_box(solid, &frame, point, above, NULL, &region));
        CHECK(region == LEAFLESS_REGION_CROSSING);
        MAY_BE_NULL(leafless_solid_placed, motion, leafless_solid_placed(solid, matrix, NULL, solid_result));
        leafless_solid_free(*solid_result);
        OK(leafless_solid_placed(solid, matrix, &motion, solid_result));
        CHECK(motion == LEAFLESS_MOTION_EXACT);
        leafless_solid_free(*solid_result);
    }
    NULL_POINTER(leafless_solid_measure, solid,
                 leafless_solid_measure(NULL, &frame, 0, 0.0, NULL, (leafless_measures *)out));
    NULL_POINTER(leafless_solid_measure, frame,
                 leafless_solid_measure(solid, NULL, 0, 0.0, NULL, (leafless_measures *)out));
    NULL_POINTER(leafless_solid_measure, measures, leafless_solid_measure(solid, &frame, 0, 0.0, NULL, NULL));
    MAY_BE_NULL(leafless_solid_measure, options, leafless_solid_measure(solid, &frame, 0, 0.0, NULL, &measures));
    NULL_POINTER(leafless_solid_surface_area, solid,
                 leafless_solid_surface_area(NULL, &frame, 0, 0.0, NULL, (leafless_surface_area *)out));
    NULL_POINTER(leafless_solid_surface_area, frame,
                 leafless_solid_surface_area(solid, NULL, 0, 0.0, NULL, (leafless_surface_area *)out));
    NULL_POINTER(leafless_solid_surface_area, surface, leafless_solid_surface_area(solid, &frame, 0, 0.0, NULL, NULL));
    MAY_BE_NULL(leafless_solid_surface_area, options,
                leafless_solid_surface_area(solid, &frame, 0, 0.0, NULL, &surface));
    NULL_POINTER(leafless_solid_section_area, solid,
                 leafless_solid_section_area(NULL, &frame, point, above, 0, 0.0, NULL, (leafless_section_area *)out));
    NULL_POINTER(leafless_solid_section_area, frame,
                 leafless_solid_section_area(solid, NULL, point, above, 0, 0.0, NULL, (leafless_section_area *)out));
    NULL_POINTER(leafless_solid_section_area, point_model,
                 leafless_solid_section_area(solid, &frame, NULL, above, 0, 0.0, NULL, (leafless_section_area *)out));
    NULL_POINTER(leafless_solid_section_area, normal,
                 leafless_solid_section_area(solid, &frame, point, NULL, 0, 0.0, NULL, (leafless_section_area *)out));
    NULL_POINTER(leafless_solid_section_area, section,
                 leafless_solid_section_area(solid, &frame, point, above, 0, 0.0, NULL, NULL));
    MAY_BE_NULL(leafless_solid_section_area, options,
                leafless_solid_section_area(solid, &frame, point, above, 0, 0.0, NULL, &section));
    NULL_POINTER(leafless_solid_bounding_box, solid,
                 leafless_solid_bounding_box(NULL, &frame, 0, NULL, (leafless_extent *)out));
    NULL_POINTER(leafless_solid_bounding_box, frame,
                 leafless_solid_bounding_box(solid, NULL, 0, NULL, (leafless_extent *)out));
    NULL_POINTER(leafless_solid_bounding_box, extent, leafless_solid_bounding_box(solid, &frame, 0, NULL, NULL));
    MAY_BE_NULL(leafless_solid_bounding_box, options, leafless_solid_bounding_box(solid, &frame, 0, NULL, &extent));
    MAY_BE_NULL(leafless_octree_build, options, leafless_octree_build(solid, &frame, 0, NULL, result));
    leafless_octree_free(*result);
    MAY_BE_NULL(leafless_octree_resolve, options, leafless_octree_resolve(octree, 2, NULL, result));
    leafless_octree_free(*result);
    MAY_BE_NULL(leafless_octree_complement, options, leafless_octree_complement(octree, NULL, result));
    leafless_octree_free(*result);
    for (operation = 0; operation < 4; operation++) {
        for (number = 1; number <= 2; number++) {
            MAY_BE_NULL(leafless_octree_combine, options, leafless_octree_combine(operation, list, number, NULL, result));
            leafless_octree_free(*result);
        }
    }
    MAY_BE_NULL(leafless_mesh_from_polyhedron, deviation_model,
                leafless_mesh_from_polyhedron(&polyhedron, NULL, mesh_result));
    leafless_mesh_free(*mesh_result);
    MAY_BE_NULL(leafless_mesh_measure, options, leafless_mesh_measure(mesh, 0, NULL, &moments));
    MAY_BE_NULL(leafless_mesh_intersecting_pairs, options,
                leafless_mesh_intersecting_pairs(mesh, NULL, &pair, 1, &number, &is_complete));
    MAY_BE_NULL(leafless_mesh_intersecting_pairs, pairs,
                leafless_mesh_intersecting_pairs(mesh, &options, NULL, 0, &number, &is_complete));

    /* Nothing happens. */
    leafless_control_free(NULL);
    leafless_mesh_free(NULL);
    leafless_solid_free(NULL);
    leafless_octree_free(NULL);
    leafless_cursor_free(NULL);
    leafless_point_cursor_free(NULL);
    leafless_point_table_free(NULL);
    CHECK(leafless_last_error(NULL, 0) > 0);
    CHECK(leafless_last_error(NULL, 100) > 0);
    (void)other;
    free(bytes);
}

/* One byte beside the right address, for every type that has an alignment. */
static void misaligned(void) {
    void *out = fresh();
    void *never = UNTOUCHED;
    leafless_octree **result = (leafless_octree **)&never;
    leafless_mesh **mesh_result = (leafless_mesh **)&never;
    leafless_solid **solid_result = (leafless_solid **)&never;
    const double *numbers = (const double *)WRONG(CHECK_CUBE);
    const uint32_t *cell = (const uint32_t *)WRONG(CHECK_CUBE);
    const leafless_mesh_arrays arrays = check_arrays(CHECK_CUBE, 8, CHECK_CUBE_TRIANGLES, 12);
    const leafless_frame *bad_frame = (const leafless_frame *)WRONG(&frame);
    const leafless_octree *bad_octree = (const leafless_octree *)WRONG(octree), *list[2];
    const leafless_solid *solids[2];
    uint32_t operation;
    const double matrix[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    leafless_options bad_control;

    MISALIGNED(leafless_control_new, control, leafless_control_new((leafless_control **)WRONG(out)));
    MISALIGNED(leafless_control_cancel, control, leafless_control_cancel((leafless_control *)WRONG(control)));
    MISALIGNED(leafless_control_state, fraction, leafless_control_state(control, (bool *)out, (double *)WRONG(out)));
    MISALIGNED(leafless_frame_check, frame, leafless_frame_check(bad_frame));
    MISALIGNED(leafless_frame_around, min_model, leafless_frame_around(numbers, above, 4, (leafless_frame *)out));
    MISALIGNED(leafless_frame_around, max_model, leafless_frame_around(point, numbers, 4, (leafless_frame *)out));
    MISALIGNED(leafless_frame_around, frame, leafless_frame_around(point, above, 4, (leafless_frame *)WRONG(out)));
    MISALIGNED(leafless_frame_to_tolerance, min_model,
               leafless_frame_to_tolerance(numbers, above, 0.5, 0, (leafless_frame *)out));
    MISALIGNED(leafless_frame_to_tolerance, max_model,
               leafless_frame_to_tolerance(point, numbers, 0.5, 0, (leafless_frame *)out));
    MISALIGNED(leafless_frame_to_tolerance, frame,
               leafless_frame_to_tolerance(point, above, 0.5, 0, (leafless_frame *)WRONG(out)));
    MISALIGNED(leafless_frame_aligned, min_model, leafless_frame_aligned(numbers, above, 4, (leafless_frame *)out));
    MISALIGNED(leafless_frame_aligned, max_model, leafless_frame_aligned(point, numbers, 4, (leafless_frame *)out));
    MISALIGNED(leafless_frame_aligned, frame, leafless_frame_aligned(point, above, 4, (leafless_frame *)WRONG(out)));
    MISALIGNED(leafless_frame_fitted, min_model, leafless_frame_fitted(numbers, above, 4, (leafless_frame *)out));
    MISALIGNED(leafless_frame_fitted, max_model, leafless_frame_fitted(point, numbers, 4, (leafless_frame *)out));
    MISALIGNED(leafless_frame_fitted, frame, leafless_frame_fitted(point, above, 4, (leafless_frame *)WRONG(out)));
    MISALIGNED(leafless_frame_with_cells, min_model, leafless_frame_with_cells(numbers, above, 0.5, (leafless_frame *)out));
    MISALIGNED(leafless_frame_with_cells, max_model, leafless_frame_with_cells(point, numbers, 0.5, (leafless_frame *)out));
    MISALIGNED(leafless_frame_with_cells, frame, leafless_frame_with_cells(point, above, 0.5, (leafless_frame *)WRONG(out)));
    MISALIGNED(leafless_frame_cell_size, cell_size_model, leafless_frame_cell_size(&frame, (double *)WRONG(out)));
    MISALIGNED(leafless_frame_cell_at, cell, leafless_frame_cell_at(&frame, point, (uint32_t *)WRONG(out)));
    MISALIGNED(leafless_frame_plane, plane_model, leafless_frame_plane(&frame, 0, 0, (leafless_interval *)WRONG(out)));
    MISALIGNED(leafless_mesh_from_polyhedron, arrays,
               leafless_mesh_from_polyhedron((const leafless_polyhedron_arrays *)WRONG(out), NULL, mesh_result));
    MISALIGNED(leafless_mesh_new, arrays,
               leafless_mesh_new((const leafless_mesh_arrays *)WRONG(&arrays), mesh_result));
    MISALIGNED(leafless_mesh_new, mesh, leafless_mesh_new(&arrays, (leafless_mesh **)WRONG(out)));
    MISALIGNED(leafless_mesh_describe, info, leafless_mesh_describe(mesh, (leafless_mesh_info *)WRONG(out)));
    MISALIGNED(leafless_mesh_copy, vertices, leafless_mesh_copy(mesh, (double *)WRONG(out), 8, NULL, 0));
    MISALIGNED(leafless_mesh_copy, triangles, leafless_mesh_copy(mesh, NULL, 0, (uint32_t *)WRONG(out), 12));
    MISALIGNED(leafless_mesh_bounds, max_model, leafless_mesh_bounds(mesh, (double *)out, (double *)WRONG(out)));
    MISALIGNED(leafless_mesh_inspect, report, leafless_mesh_inspect(mesh, (leafless_mesh_report *)WRONG(out)));
    MISALIGNED(leafless_mesh_defects, defects,
               leafless_mesh_defects(mesh, 9, (leafless_mesh_defect *)WRONG(out), 2, (uint64_t *)out));
    MISALIGNED(leafless_mesh_defects, count, leafless_mesh_defects(mesh, 9, NULL, 0, (uint64_t *)WRONG(out)));
    MISALIGNED(leafless_mesh_measure, moments,
               leafless_mesh_measure(mesh, 0, NULL, (leafless_mesh_moments *)WRONG(out)));
    MISALIGNED(leafless_mesh_measure, options,
               leafless_mesh_measure(mesh, 0, (leafless_options *)WRONG(&options), (leafless_mesh_moments *)out));
    MISALIGNED(leafless_mesh_intersecting_pairs, pairs,
               leafless_mesh_intersecting_pairs(mesh, NULL, (leafless_intersecting_pair *)WRONG(out), 2,
                                                (uint64_t *)out, (bool *)out));
    MISALIGNED(leafless_mesh_intersecting_pairs, count,
               leafless_mesh_intersecting_pairs(mesh, NULL, NULL, 0, (uint64_t *)WRONG(out), (bool *)out));
    MISALIGNED(leafless_mesh_transformed, matrix, leafless_mesh_transformed(mesh, numbers, mesh_result));
    MISALIGNED(leafless_mesh_translated, mesh,
               leafless_mesh_translated((leafless_mesh *)WRONG(mesh), point, mesh_result));
    MISALIGNED(leafless_solid_new_ball, centre_model, leafless_solid_new_ball(numbers, 1, solid_result));
    MISALIGNED(leafless_solid_new_torus, centre_model, leafless_solid_new_torus(numbers, point, 2, 1, solid_result));
    MISALIGNED(leafless_solid_new_torus, axis, leafless_solid_new_torus(point, numbers, 2, 1, solid_result));
    MISALIGNED(leafless_solid_new_ellipsoid, matrix,
               leafless_solid_new_ellipsoid(point, above, numbers, solid_result));
    MISALIGNED(leafless_solid_new_wedge, matrix, leafless_solid_new_wedge(above, 1, numbers, solid_result));
    MISALIGNED(leafless_solid_new_prism, matrix, leafless_solid_new_prism(outline, 3, 0, 1, numbers, solid_result));
    MISALIGNED(leafless_solid_new_cylinder, from_model,
               leafless_solid_new_cylinder(numbers, point, 1, solid_result));
    MISALIGNED(leafless_solid_new_cylinder, to_model,
               leafless_solid_new_cylinder(point, numbers, 1, solid_result));
    MISALIGNED(leafless_solid_new_frustum, from_model,
               leafless_solid_new_frustum(numbers, point, 1, 0, solid_result));
    MISALIGNED(leafless_solid_new_frustum, to_model,
               leafless_solid_new_frustum(point, numbers, 1, 0, solid_result));
    MISALIGNED(leafless_solid_new_ball, solid, leafless_solid_new_ball(point, 1, (leafless_solid **)WRONG(out)));
    MISALIGNED(leafless_solid_interfere_many, matrices,
               leafless_solid_interfere_many(solid, solid, &frame, (const double *)WRONG(point), 1, &frame, 0, NULL,
                                             (leafless_interference *)out));
    MISALIGNED(leafless_solid_interfere_many, interferences,
               leafless_solid_interfere_many(solid, solid, &frame, room, 0, &frame, 0, NULL,
                                             (leafless_interference *)WRONG(out)));
    MISALIGNED(leafless_solid_interfere_many, own,
               leafless_solid_interfere_many(solid, solid, (leafless_frame *)WRONG(&frame), room, 0, &frame, 0, NULL,
                                             (leafless_interference *)out));
    MISALIGNED(leafless_solid_interfere, interference,
               leafless_solid_interfere(solid, solid, &frame, 0, NULL, (leafless_interference *)WRONG(out)));
    MISALIGNED(leafless_solid_gap_at_least, gap,
               leafless_solid_gap_at_least(solid, solid, &frame, 1, NULL, (leafless_gap *)WRONG(out)));
    MISALIGNED(leafless_solid_clearance_many, matrices,
               leafless_solid_clearance_many(solid, solid, &frame, (const double *)WRONG(point), 1, &frame, 0, NULL,
                                             (leafless_placed_clearance *)out));
    MISALIGNED(leafless_solid_gap_at_least_many, matrices,
               leafless_solid_gap_at_least_many(solid, solid, &frame, (const double *)WRONG(point), 1, &frame, 1, NULL,
                                                (leafless_placed_gap *)out));
    MISALIGNED(leafless_solid_clearance_many, clearances,
               leafless_solid_clearance_many(solid, solid, &frame, room, 0, &frame, 0, NULL,
                                             (leafless_placed_clearance *)WRONG(out)));
    MISALIGNED(leafless_solid_gap_at_least_many, gaps,
               leafless_solid_gap_at_least_many(solid, solid, &frame, room, 0, &frame, 1, NULL,
                                                (leafless_placed_gap *)WRONG(out)));
    MISALIGNED(leafless_solid_clearance_many, own,
               leafless_solid_clearance_many(solid, solid, (leafless_frame *)WRONG(&frame), room, 0, &frame, 0, NULL,
                                             (leafless_placed_clearance *)out));
    MISALIGNED(leafless_solid_gap_at_least_many, own,
               leafless_solid_gap_at_least_many(solid, solid, (leafless_frame *)WRONG(&frame), room, 0, &frame, 1, NULL,
                                                (leafless_placed_gap *)out));
    MISALIGNED(leafless_solid_clearance, clearance,
               leafless_solid_clearance(solid, solid, &frame, 0, NULL, (leafless_clearance *)WRONG(out)));
    MISALIGNED(leafless_solid_deviation, deviation,
               leafless_solid_deviation(solid, solid, &frame, 0, 0, NULL, (leafless_deviation *)WRONG(out)));
    MISALIGNED(leafless_solid_measure, solid,
               leafless_solid_measure((leafless_solid *)WRONG(solid), &frame, 0, 0.0, NULL, (leafless_measures *)out));
    MISALIGNED(leafless_solid_measure, measures,
               leafless_solid_measure(solid, &frame, 0, 0.0, NULL, (leafless_measures *)WRONG(out)));
    MISALIGNED(leafless_solid_surface_area, surface,
               leafless_solid_surface_area(solid, &frame, 0, 0.0, NULL, (leafless_surface_area *)WRONG(out)));
    MISALIGNED(leafless_solid_section_area, point_model,
               leafless_solid_section_area(solid, &frame, (double *)WRONG(out), above, 0, 0.0, NULL,
                                           (leafless_section_area *)out));
    MISALIGNED(leafless_solid_section_area, section,
               leafless_solid_section_area(solid, &frame, point, above, 0, 0.0, NULL,
                                           (leafless_section_area *)WRONG(out)));
    MISALIGNED(leafless_solid_bounding_box, extent,
               leafless_solid_bounding_box(solid, &frame, 0, NULL, (leafless_extent *)WRONG(out)));
    MISALIGNED(leafless_octree_build, solid,
               leafless_octree_build((leafless_solid *)WRONG(solid), &frame, 0, NULL, result));
    MISALIGNED(leafless_octree_build, options,
               leafless_octree_build(solid, &frame, 0, (leafless_options *)WRONG(&options), result));
    MISALIGNED(leafless_octree_build, octree,
               leafless_octree_build(solid, &frame, 0, NULL, (leafless_octree **)WRONG(out)));
    bad_control = options;
    bad_control.control = (leafless_control *)WRONG(control);
    refused(LEAFLESS_E_ARGUMENT, "leafless_octree_build", "options.control",
            leafless_octree_build(solid, &frame, 0, &bad_control, result));
    MISALIGNED(leafless_octree_describe, octree, leafless_octree_describe(bad_octree, (leafless_octree_info *)out));
    MISALIGNED(leafless_octree_describe, info, leafless_octree_describe(octree, (leafless_octree_info *)WRONG(out)));
    MISALIGNED(leafless_octree_with_proof, octree, leafless_octree_with_proof(bad_octree, 3, 0, result));
    MISALIGNED(leafless_octree_with_proof, result,
               leafless_octree_with_proof(octree, 3, 0, (leafless_octree **)WRONG(out)));
    MISALIGNED(leafless_octree_levels, levels,
               leafless_octree_levels(octree, (leafless_statistics *)WRONG(out), 5, (uint64_t *)out));
    for (operation = 0; operation < 4; operation++) {
        list[0] = octree, list[1] = bad_octree;
        MISALIGNED(leafless_octree_combine, octrees, leafless_octree_combine(operation, list, 2, NULL, result));
        list[0] = bad_octree;
        MISALIGNED(leafless_octree_combine, octrees, leafless_octree_combine(operation, list, 1, NULL, result));
        MISALIGNED(leafless_octree_combine, octrees,
                   leafless_octree_combine(operation, (const leafless_octree *const *)WRONG(list), 1, NULL, result));
        list[0] = octree;
        MISALIGNED(leafless_octree_combine, result,
                   leafless_octree_combine(operation, list, 1, NULL, (leafless_octree **)WRONG(out)));
        solids[0] = solid, solids[1] = (const leafless_solid *)WRONG(solid);
        MISALIGNED(leafless_solid_combine, solids, leafless_solid_combine(operation, solids, 2, solid_result));
        MISALIGNED(leafless_solid_combine, solids,
                   leafless_solid_combine(operation, (const leafless_solid *const *)WRONG(solids), 1, solid_result));
        MISALIGNED(leafless_solid_combine, result,
                   leafless_solid_combine(operation, solids, 1, (leafless_solid **)WRONG(out)));
    }
    MISALIGNED(leafless_octree_contains, point_model,
               leafless_octree_contains(octree, numbers, (leafless_membership *)out));
    MISALIGNED(leafless_octree_contains_many, points_model,
               leafless_octree_contains_many(octree, numbers, 1, (leafless_membership *)out));
    MISALIGNED(leafless_octree_tag_at, cell, leafless_octree_tag_at(octree, cell, (leafless_tag *)out));
    MISALIGNED(leafless_octree_classify_box, max_model,
               leafless_octree_classify_box(octree, point, numbers, (leafless_region *)out));
    MISALIGNED(leafless_solid_contains_many, solid,
               leafless_solid_contains_many((leafless_solid *)WRONG(solid), &frame, point, 1, NULL,
                                       (leafless_membership *)out));
    MISALIGNED(leafless_solid_contains_many, frame,
               leafless_solid_contains_many(solid, bad_frame, point, 1, NULL, (leafless_membership *)out));
    MISALIGNED(leafless_solid_contains_many, points_model,
               leafless_solid_contains_many(solid, &frame, numbers, 1, NULL, (leafless_membership *)out));
    MISALIGNED(leafless_solid_classify_box, frame,
               leafless_solid_classify_box(solid, bad_frame, point, above, NULL, (leafless_region *)out));
    MISALIGNED(leafless_solid_classify_box, min_model,
               leafless_solid_classify_box(solid, &frame, numbers, above, NULL, (leafless_region *)out));
    MISALIGNED(leafless_solid_classify_box, max_model,
               leafless_solid_classify_box(solid, &frame, point, numbers, NULL, (leafless_region *)out));
    MISALIGNED(leafless_solid_classify_box, options,
               leafless_solid_classify_box(solid, &frame, point, above, (leafless_options *)WRONG(&options),
                                           (leafless_region *)out));
    MISALIGNED(leafless_solid_describe, info, leafless_solid_describe(solid, (leafless_solid_info *)WRONG(out)));
    MISALIGNED(leafless_solid_placed, matrix,
               leafless_solid_placed(solid, numbers, (leafless_motion *)out, solid_result));
    MISALIGNED(leafless_solid_placed, motion,
               leafless_solid_placed(solid, matrix, (leafless_motion *)WRONG(out), solid_result));
    MISALIGNED(leafless_solid_placed, solid,
               leafless_solid_placed(solid, matrix, (leafless_motion *)out, (leafless_solid **)WRONG(out)));
    MISALIGNED(leafless_cursor_describe, cursor,
               leafless_cursor_describe((leafless_cursor *)WRONG(cursor), (leafless_cursor_info *)out));
    MISALIGNED(leafless_cursor_describe, state, leafless_cursor_describe(cursor, (leafless_cursor_info *)WRONG(out)));

    untouched();
    CHECK(never == UNTOUCHED);
}

/* Every number that is not in its range, in every place of every function that takes numbers. */
static void numbers(void) {
    static const double not_finite[] = {NAN, -NAN, INFINITY, -INFINITY};
    static const double not_in_range[] = {NAN, INFINITY, -INFINITY, 1e300, -1e300, 0x1.8p256, 1e-300, -1e-300, 4e-324};
    static const uint32_t not_a_depth[] = {0, 21, 22, 255, 256, 257, 65536 + 4, UINT32_MAX};
    static const leafless_tag not_a_tag[] = {1, 4, 128, 255};
    static const uint32_t not_a_rule[] = {4, 255, 256, UINT32_MAX};
    void *out = fresh();
    void *never = UNTOUCHED;
    leafless_octree **result = (leafless_octree **)&never;
    leafless_mesh **mesh_result = (leafless_mesh **)&never;
    leafless_solid **solid_result = (leafless_solid **)&never;
    leafless_frame bad;
    leafless_solid_callbacks callbacks;
    size_t i, axis;

    for (i = 0; i < COUNT(not_a_depth); i++) {
        bad = frame;
        bad.depth = not_a_depth[i];
        BAD_NUMBER(leafless_frame_check, depth, leafless_frame_check(&bad));
        BAD_NUMBER(leafless_frame_around, depth, leafless_frame_around(point, above, bad.depth, (leafless_frame *)out));
        BAD_NUMBER(leafless_frame_aligned, depth, leafless_frame_aligned(point, above, bad.depth, (leafless_frame *)out));
        BAD_NUMBER(leafless_frame_fitted, depth, leafless_frame_fitted(point, above, bad.depth, (leafless_frame *)out));
        BAD_NUMBER(leafless_octree_build, depth, leafless_octree_build(solid, &bad, 0, NULL, result));
        BAD_NUMBER(leafless_solid_measure, depth,
                   leafless_solid_measure(solid, &bad, 0, 0.0, NULL, (leafless_measures *)out));
        BAD_NUMBER(leafless_solid_surface_area, depth,
                   leafless_solid_surface_area(solid, &bad, 0, 0.0, NULL, (leafless_surface_area *)out));
        BAD_NUMBER(leafless_solid_section_area, depth,
                   leafless_solid_section_area(solid, &bad, point, above, 0, 0.0, NULL, (leafless_section_area *)out));
        BAD_NUMBER(leafless_solid_bounding_box, depth,
                   leafless_solid_bounding_box(solid, &bad, 0, NULL, (leafless_extent *)out));
        BAD_NUMBER(leafless_solid_contains_many, depth,
                   leafless_solid_contains_many(solid, &bad, point, 1, NULL, (leafless_membership *)out));
        BAD_NUMBER(leafless_solid_contains_many, depth, leafless_solid_contains_many(solid, &bad, NULL, 0, NULL, NULL));
        BAD_NUMBER(leafless_solid_classify_box, depth,
                   leafless_solid_classify_box(solid, &bad, point, above, NULL, (leafless_region *)out));
    }
    for (i = 0; i < COUNT(not_in_range); i++) {
        bad = frame;
        bad.edge = not_in_range[i];
        BAD_NUMBER(leafless_frame_check, edge, leafless_frame_check(&bad));
        BAD_NUMBER(leafless_octree_new_uniform, edge, leafless_octree_new_uniform(&bad, 0, 0, result));
        BAD_NUMBER(leafless_frame_cell_size, edge, leafless_frame_cell_size(&bad, (double *)out));
        BAD_NUMBER(leafless_frame_cell_at, edge, leafless_frame_cell_at(&bad, point, (uint32_t *)out));
        BAD_NUMBER(leafless_frame_plane, edge, leafless_frame_plane(&bad, 0, 0, (leafless_interval *)out));
        BAD_NUMBER(leafless_solid_contains_many, edge,
                   leafless_solid_contains_many(solid, &bad, point, 1, NULL, (leafless_membership *)out));
        BAD_NUMBER(leafless_solid_classify_box, edge,
                   leafless_solid_classify_box(solid, &bad, point, above, NULL, (leafless_region *)out));
        BAD_NUMBER(leafless_solid_new_ball, radius, leafless_solid_new_ball(point, not_in_range[i], solid_result));
        BAD_NUMBER(leafless_solid_new_halfspace, offset,
                   leafless_solid_new_halfspace(above, not_in_range[i], solid_result));
        for (axis = 0; axis < 3; axis++) {
            double numbers[3] = {-0.5, -0.5, -0.5}, normal[3] = {1, 1, 1}, high[3] = {0.5, 0.5, 0.5};
            bad = frame;
            bad.origin[axis] = not_in_range[i];
            numbers[axis] = not_in_range[i];
            normal[axis] = not_in_range[i];
            BAD_NUMBER(leafless_frame_check, origin, leafless_frame_check(&bad));
            BAD_NUMBER(leafless_solid_new_ball, centre, leafless_solid_new_ball(numbers, 1, solid_result));
            BAD_NUMBER(leafless_solid_new_halfspace, normal, leafless_solid_new_halfspace(normal, 1, solid_result));
            refused(LEAFLESS_E_ARGUMENT, "leafless_solid_new_box", "",
                    leafless_solid_new_box(numbers, above, solid_result));
            high[axis] = not_in_range[i];
            refused(LEAFLESS_E_ARGUMENT, "leafless_solid_new_box", "",
                    leafless_solid_new_box(point, high, solid_result));
        }
    }
    for (i = 0; i < COUNT(not_finite); i++) {
        for (axis = 0; axis < 12; axis++) {
            double matrix[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
            matrix[axis] = not_finite[i];
            BAD_NUMBER(leafless_mesh_transformed, matrix, leafless_mesh_transformed(mesh, matrix, mesh_result));
            refused(LEAFLESS_E_ARGUMENT, "leafless_solid_placed", "entry",
                    leafless_solid_placed(solid, matrix, (leafless_motion *)out, solid_result));
        }
        for (axis = 0; axis < 3; axis++) {
            double vector[3] = {0, 0, 0};
            vector[axis] = not_finite[i];
            BAD_NUMBER(leafless_mesh_translated, offset_model, leafless_mesh_translated(mesh, vector, mesh_result));
            refused(LEAFLESS_E_ARGUMENT, "leafless_frame_around", "",
                    leafless_frame_around(vector, above, 4, (leafless_frame *)out));
            BAD_NUMBER(leafless_frame_cell_at, point_model, leafless_frame_cell_at(&frame, vector, (uint32_t *)out));
        }
    }
    {
        const double huge[3] = {0, 0x1.8p256, 0}, to_huge[12] = {0x1p300, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
        const double outside[3] = {0, 0, nextafter(1.0, 2.0)}, near[3] = {1, 1, 1}, nan[3] = {0, NAN, 0};
        refused(LEAFLESS_E_MESH, "leafless_mesh_transformed", "vertex",
                leafless_mesh_transformed(mesh, to_huge, mesh_result));
        refused(LEAFLESS_E_MESH, "leafless_mesh_translated", "vertex",
                leafless_mesh_translated(mesh, huge, mesh_result));
        refused(LEAFLESS_E_MESH, "leafless_frame_around", "extent",
                leafless_frame_around(near, near, 4, (leafless_frame *)out));
        refused(LEAFLESS_E_ARGUMENT, "leafless_frame_around", "",
                leafless_frame_around(above, point, 4, (leafless_frame *)out));
        BAD_NUMBER(leafless_frame_cell_at, point_model, leafless_frame_cell_at(&frame, outside, (uint32_t *)out));
        BAD_NUMBER(leafless_octree_classify_box, min,
                   leafless_octree_classify_box(octree, above, point, (leafless_region *)out));
        refused(LEAFLESS_E_ARGUMENT, "leafless_octree_classify_box", "",
                leafless_octree_classify_box(octree, nan, above, (leafless_region *)out));
        refused(LEAFLESS_E_ARGUMENT, "leafless_octree_classify_box", "",
                leafless_octree_classify_box(octree, point, nan, (leafless_region *)out));
        BAD_NUMBER(leafless_solid_classify_box, min,
                   leafless_solid_classify_box(solid, &frame, above, point, NULL, (leafless_region *)out));
        refused(LEAFLESS_E_ARGUMENT, "leafless_solid_classify_box", "number",
                leafless_solid_classify_box(solid, &frame, nan, above, NULL, (leafless_region *)out));
        refused(LEAFLESS_E_ARGUMENT, "leafless_solid_classify_box", "number",
                leafless_solid_classify_box(solid, &frame, point, nan, NULL, (leafless_region *)out));
        refused(LEAFLESS_E_ARGUMENT, "leafless_solid_new_box", "", leafless_solid_new_box(above, above, solid_result));
        refused(LEAFLESS_E_ARGUMENT, "leafless_solid_new_halfspace", "normal",
                leafless_solid_new_halfspace(point, 1, solid_result));
    }
    for (i = 0; i < COUNT(not_a_tag); i++) {
        BAD_NUMBER(leafless_octree_new_uniform, tag, leafless_octree_new_uniform(&frame, not_a_tag[i], 0, result));
        BAD_NUMBER(leafless_octree_new_uniform, exterior, leafless_octree_new_uniform(&frame, 0, not_a_tag[i], result));
    }
    for (i = 0; i < COUNT(not_a_rule); i++) {
        BAD_NUMBER(leafless_octree_build, rule, leafless_octree_build(solid, &frame, not_a_rule[i], NULL, result));
        BAD_NUMBER(leafless_octree_resolve, rule, leafless_octree_resolve(octree, not_a_rule[i], NULL, result));
        BAD_NUMBER(leafless_octree_with_proof, proven, leafless_octree_with_proof(octree, not_a_rule[i], 0, result));
        BAD_NUMBER(leafless_octree_with_proof, displacement,
                   leafless_octree_with_proof(octree, 3, not_finite[i], result));
        BAD_NUMBER(leafless_mesh_check_closed, fill, leafless_mesh_check_closed(mesh, not_a_rule[i] - 1));
        BAD_NUMBER(leafless_mesh_measure, fill,
                   leafless_mesh_measure(mesh, not_a_rule[i] - 1, NULL, (leafless_mesh_moments *)out));
        BAD_NUMBER(leafless_solid_from_mesh, fill, leafless_solid_from_mesh(mesh, not_a_rule[i] - 1, solid_result));
        memset(&callbacks, 0, sizeof callbacks);
        callbacks.struct_size = sizeof callbacks;
        callbacks.classify = classify;
        callbacks.exterior = not_a_rule[i] - 1;
        BAD_NUMBER(leafless_solid_new_callbacks, exterior, leafless_solid_new_callbacks(&callbacks, solid_result));
    }
    BAD_NUMBER(leafless_octree_with_proof, displacement, leafless_octree_with_proof(octree, 3, -0.5, result));
    BAD_NUMBER(leafless_solid_interfere, tolerance,
               leafless_solid_interfere(solid, solid, &frame, -1, NULL, (leafless_interference *)out));
    BAD_NUMBER(leafless_solid_gap_at_least, least,
               leafless_solid_gap_at_least(solid, solid, &frame, 0, NULL, (leafless_gap *)out));
    BAD_NUMBER(leafless_solid_clearance, tolerance,
               leafless_solid_clearance(solid, solid, &frame, -1, NULL, (leafless_clearance *)out));
    BAD_NUMBER(leafless_solid_deviation, tolerance,
               leafless_solid_deviation(solid, solid, &frame, -1, 0, NULL, (leafless_deviation *)out));
    BAD_NUMBER(leafless_frame_plane, axis, leafless_frame_plane(&frame, 3, 0, (leafless_interval *)out));
    BAD_NUMBER(leafless_frame_plane, axis, leafless_frame_plane(&frame, UINT32_MAX, 0, (leafless_interval *)out));
    BAD_NUMBER(leafless_frame_plane, index, leafless_frame_plane(&frame, 0, 17, (leafless_interval *)out));
    BAD_NUMBER(leafless_frame_plane, index, leafless_frame_plane(&frame, 2, UINT32_MAX, (leafless_interval *)out));
    BAD_NUMBER(leafless_cursor_descend, octant, leafless_cursor_descend(cursor, 8, (bool *)out));
    BAD_NUMBER(leafless_cursor_descend, octant, leafless_cursor_descend(cursor, 256, (bool *)out));
    BAD_NUMBER(leafless_cursor_descend, octant, leafless_cursor_descend(cursor, UINT32_MAX, (bool *)out));
    refused(LEAFLESS_E_ARGUMENT, "leafless_octree_peek_metadata_at", "index",
            leafless_octree_peek_metadata_at(octree, 0, (uint64_t *)out, (const char **)out + 1, (size_t *)out + 2,
                                             (const char **)out + 3, (size_t *)out + 4));
    refused(LEAFLESS_E_ARGUMENT, "leafless_octree_peek_metadata_at", "index",
            leafless_octree_peek_metadata_at(octree, UINT64_MAX, (uint64_t *)out, (const char **)out + 1,
                                             (size_t *)out + 2, (const char **)out + 3, (size_t *)out + 4));

    untouched();
    CHECK(never == UNTOUCHED);
}

/* All of an octree that is split on demand. */
static void lazy_octrees(void) {
    void *out = fresh(), *never = UNTOUCHED;
    leafless_octree **result = (leafless_octree **)&never;
    leafless_lazy **made = (leafless_lazy **)&never, *lazy = NULL;
    leafless_tag *tags = (leafless_tag *)out, tag;
    bool *flag = (bool *)out, done;
    uint64_t *count = (uint64_t *)out, number;
    /* Buffers for the values read beside them. */
    const uint32_t universe[4] = {0, 0, 0, 0};
    const double room[4] = {0, 0, 0, 0}, *numbers = (const double *)WRONG(room);
    const uint32_t *cell = (const uint32_t *)WRONG(universe);
    leafless_lazy_info *info = (leafless_lazy_info *)out;
    leafless_zone zone = check_zone_point(point);
    leafless_membership *membership = (leafless_membership *)out;
    leafless_octree *frozen = NULL;

    OK(leafless_lazy_new(solid, &frame, &lazy));
    NULL_POINTER(leafless_lazy_new, solid, leafless_lazy_new(NULL, &frame, made));
    NULL_POINTER(leafless_lazy_new, frame, leafless_lazy_new(solid, NULL, made));
    NULL_POINTER(leafless_lazy_new, lazy, leafless_lazy_new(solid, &frame, NULL));
    NULL_POINTER(leafless_lazy_resume, octree, leafless_lazy_resume(NULL, solid, &frame, NULL, made));
    NULL_POINTER(leafless_lazy_resume, solid, leafless_lazy_resume(octree, NULL, &frame, NULL, made));
    NULL_POINTER(leafless_lazy_resume, frame, leafless_lazy_resume(octree, solid, NULL, NULL, made));
    NULL_POINTER(leafless_lazy_resume, lazy, leafless_lazy_resume(octree, solid, &frame, NULL, NULL));
    NULL_POINTER(leafless_lazy_split, lazy, leafless_lazy_split(NULL, universe, 0, tags));
    NULL_POINTER(leafless_lazy_split, cell, leafless_lazy_split(lazy, NULL, 0, tags));
    NULL_POINTER(leafless_lazy_split, tags, leafless_lazy_split(lazy, universe, 0, NULL));
    NULL_POINTER(leafless_lazy_refine, lazy, leafless_lazy_refine(NULL, &zone, 1, NULL, flag));
    NULL_POINTER(leafless_lazy_tag_at, lazy, leafless_lazy_tag_at(NULL, universe, 0, tags, flag));
    NULL_POINTER(leafless_lazy_tag_at, cell, leafless_lazy_tag_at(lazy, NULL, 0, tags, flag));
    NULL_POINTER(leafless_lazy_tag_at, tag, leafless_lazy_tag_at(lazy, universe, 0, NULL, flag));
    NULL_POINTER(leafless_lazy_contains, lazy, leafless_lazy_contains(NULL, point, membership));
    NULL_POINTER(leafless_lazy_contains, point_model, leafless_lazy_contains(lazy, NULL, membership));
    NULL_POINTER(leafless_lazy_contains, membership, leafless_lazy_contains(lazy, point, NULL));
    NULL_POINTER(leafless_lazy_describe, lazy, leafless_lazy_describe(NULL, info));
    NULL_POINTER(leafless_lazy_describe, info, leafless_lazy_describe(lazy, NULL));
    NULL_POINTER(leafless_lazy_levels, lazy, leafless_lazy_levels(NULL, NULL, 0, count));
    NULL_POINTER(leafless_lazy_levels, levels, leafless_lazy_levels(lazy, NULL, 5, count));
    NULL_POINTER(leafless_lazy_levels, count, leafless_lazy_levels(lazy, NULL, 0, NULL));
    NULL_POINTER(leafless_lazy_splits, lazy, leafless_lazy_splits(NULL, NULL, 0, count));
    NULL_POINTER(leafless_lazy_splits, splits, leafless_lazy_splits(lazy, NULL, 4, count));
    NULL_POINTER(leafless_lazy_splits, count, leafless_lazy_splits(lazy, NULL, 0, NULL));
    NULL_POINTER(leafless_lazy_freeze, lazy, leafless_lazy_freeze(NULL, NULL, result));
    NULL_POINTER(leafless_lazy_freeze, octree, leafless_lazy_freeze(lazy, NULL, NULL));

    MISALIGNED(leafless_lazy_new, lazy, leafless_lazy_new(solid, &frame, (leafless_lazy **)WRONG(out)));
    MISALIGNED(leafless_lazy_split, lazy, leafless_lazy_split((leafless_lazy *)WRONG(lazy), universe, 0, tags));
    MISALIGNED(leafless_lazy_split, cell, leafless_lazy_split(lazy, cell, 0, tags));
    MISALIGNED(leafless_lazy_refine, options,
               leafless_lazy_refine(lazy, &zone, 1, (const leafless_options *)WRONG(&options), flag));
    MISALIGNED(leafless_lazy_refine, zone, leafless_lazy_refine(lazy, (const leafless_zone *)WRONG(&zone), 1, NULL, flag));
    MISALIGNED(leafless_lazy_tag_at, cell, leafless_lazy_tag_at(lazy, cell, 0, tags, flag));
    MISALIGNED(leafless_lazy_contains, point_model, leafless_lazy_contains(lazy, numbers, membership));
    MISALIGNED(leafless_lazy_describe, info, leafless_lazy_describe(lazy, (leafless_lazy_info *)WRONG(out)));
    MISALIGNED(leafless_lazy_levels, levels, leafless_lazy_levels(lazy, (leafless_statistics *)WRONG(out), 5, count));
    MISALIGNED(leafless_lazy_splits, splits, leafless_lazy_splits(lazy, (uint64_t *)WRONG(out), 4, count));
    MISALIGNED(leafless_lazy_freeze, octree, leafless_lazy_freeze(lazy, NULL, (leafless_octree **)WRONG(out)));

    BAD_NUMBER(leafless_lazy_split, cell, leafless_lazy_split(lazy, universe, 4, tags));
    BAD_NUMBER(leafless_lazy_split, cell, leafless_lazy_split(lazy, universe, UINT32_MAX, tags));
    BAD_NUMBER(leafless_lazy_refine, level, leafless_lazy_refine(lazy, &zone, 5, NULL, flag));
    zone.kind = 4;
    BAD_NUMBER(leafless_lazy_refine, zone.kind, leafless_lazy_refine(lazy, &zone, 1, NULL, flag));
    zone.kind = UINT32_MAX;
    BAD_NUMBER(leafless_lazy_refine, zone.kind, leafless_lazy_refine(lazy, &zone, 1, NULL, flag));
    zone = check_zone_box(above, point);
    BAD_NUMBER(leafless_lazy_refine, max, leafless_lazy_refine(lazy, &zone, 1, NULL, flag));
    zone = check_zone_ray(above, point, 0, 1);
    BAD_NUMBER(leafless_lazy_refine, direction, leafless_lazy_refine(lazy, &zone, 1, NULL, flag));
    zone = check_zone_ray(point, above, 1, NAN);
    BAD_NUMBER(leafless_lazy_refine, to, leafless_lazy_refine(lazy, &zone, 1, NULL, flag));
    zone.struct_size = 3;
    BAD_NUMBER(leafless_lazy_refine, zone, leafless_lazy_refine(lazy, &zone, 1, NULL, flag));
    zone = check_zone_point(point);
    untouched();
    CHECK(never == UNTOUCHED);

    MAY_BE_NULL(leafless_lazy_refine, zone, leafless_lazy_refine(lazy, NULL, 1, &options, &done));
    MAY_BE_NULL(leafless_lazy_refine, options, leafless_lazy_refine(lazy, &zone, 1, NULL, &done));
    MAY_BE_NULL(leafless_lazy_refine, done, leafless_lazy_refine(lazy, &zone, 1, &options, NULL));
    MAY_BE_NULL(leafless_lazy_tag_at, can_split, leafless_lazy_tag_at(lazy, universe, 0, &tag, NULL));
    MAY_BE_NULL(leafless_lazy_levels, levels, leafless_lazy_levels(lazy, NULL, 0, &number));
    MAY_BE_NULL(leafless_lazy_splits, splits, leafless_lazy_splits(lazy, NULL, 0, &number));
    MAY_BE_NULL(leafless_lazy_freeze, options, leafless_lazy_freeze(lazy, NULL, &frozen));
    leafless_lazy_free(lazy);
    lazy = NULL;
    MAY_BE_NULL(leafless_lazy_resume, options, leafless_lazy_resume(frozen, solid, &frame, NULL, &lazy));
    leafless_lazy_free(lazy);
    leafless_octree_free(frozen);
    leafless_lazy_free(NULL);
}

/* All of volumes, surfaces, bitmaps and written meshes. */
static void volumes_and_surfaces(void) {
    void *out = fresh(), *never = UNTOUCHED;
    leafless_volume **made = (leafless_volume **)&never, *volume = NULL;
    leafless_solid **solid_result = (leafless_solid **)&never;
    leafless_mesh **mesh_result = (leafless_mesh **)&never;
    leafless_volume_info *info = (leafless_volume_info *)out;
    leafless_interval *interval = (leafless_interval *)out;
    uint64_t *count = (uint64_t *)out, number;
    uint32_t samples[8] = {0};
    const uint32_t low[4] = {0, 0, 0, 0}, high[4] = {2, 2, 2, 0};
    const uint32_t *cell = (const uint32_t *)WRONG(low);
    const leafless_interval band[2] = {{1, 2}, {0, 0}};
    static const char HEADER[] = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 1 1\nencoding: raw\ndata file: x\n";
    const uint8_t *header = (const uint8_t *)HEADER;
    const uint64_t length = sizeof HEADER - 1;
    leafless_volume_layout layout;
    leafless_mesh_write_options write;
    leafless_surface_options surface;
    leafless_interval range;
    double real;

    OK(leafless_init(&layout, sizeof layout));
    OK(leafless_init(&write, sizeof write));
    OK(leafless_init(&surface, sizeof surface));
    write.format = LEAFLESS_MESH_FORMAT_PLY;
    layout.extents[0] = layout.extents[1] = layout.extents[2] = 2;
    NULL_POINTER(leafless_volume_new, layout, volume_of_array(NULL, samples, 8, made));
    NULL_POINTER(leafless_volume_new, source, leafless_volume_new(&layout, NULL, made));
    NULL_POINTER(leafless_volume_new, source.bytes, volume_of_array(&layout, NULL, 8, made));
    NULL_POINTER(leafless_volume_new, source.bytes, volume_in_place(&layout, NULL, 8, made));
    NULL_POINTER(leafless_volume_new, volume, volume_of_array(&layout, samples, 8, NULL));
    NULL_POINTER(leafless_volume_new, source.path, volume_open_raw(NULL, 1, &layout, made));
    BAD_NUMBER(leafless_volume_new, source.length, volume_of_array(&layout, NULL, 0, made));
    BAD_NUMBER(leafless_volume_new, source.length, volume_in_place(&layout, NULL, 0, made));
    OK(volume_of_array(&layout, samples, 8, &volume));
    NULL_POINTER(leafless_volume_ref, volume, leafless_volume_ref(NULL, made));
    NULL_POINTER(leafless_volume_ref, reference, leafless_volume_ref(volume, NULL));
    NULL_POINTER(leafless_volume_describe, volume, leafless_volume_describe(NULL, info));
    NULL_POINTER(leafless_volume_describe, info, leafless_volume_describe(volume, NULL));
    NULL_POINTER(leafless_volume_peek_samples, volume,
                 leafless_volume_peek_samples(NULL, (const void **)out, count + 1));
    NULL_POINTER(leafless_volume_peek_samples, samples, leafless_volume_peek_samples(volume, NULL, count));
    NULL_POINTER(leafless_volume_peek_samples, length,
                 leafless_volume_peek_samples(volume, (const void **)out, NULL));
    NULL_POINTER(leafless_volume_frame, volume, leafless_volume_frame(NULL, (leafless_frame *)out));
    NULL_POINTER(leafless_volume_frame, frame, leafless_volume_frame(volume, NULL));
    NULL_POINTER(leafless_volume_bounds, volume, leafless_volume_bounds(NULL, (double *)out, (double *)out + 3));
    NULL_POINTER(leafless_volume_bounds, min_model, leafless_volume_bounds(volume, NULL, (double *)out));
    NULL_POINTER(leafless_volume_bounds, max_model, leafless_volume_bounds(volume, (double *)out, NULL));
    NULL_POINTER(leafless_volume_range, volume, leafless_volume_range(NULL, NULL, interval));
    NULL_POINTER(leafless_volume_range, range, leafless_volume_range(volume, NULL, NULL));
    NULL_POINTER(leafless_solid_from_volume, volume, leafless_solid_from_volume(NULL, band, NULL, solid_result));
    NULL_POINTER(leafless_solid_from_volume, solid, leafless_solid_from_volume(volume, band, NULL, NULL));
    NULL_POINTER(leafless_volume_data_file, bytes, leafless_volume_data_file(NULL, 9, NULL, 0, count));
    NULL_POINTER(leafless_volume_data_file, name, leafless_volume_data_file(header, length, NULL, 9, count));
    NULL_POINTER(leafless_volume_data_file, name_length,
                 leafless_volume_data_file(header, length, (char *)out, 9, NULL));
    NULL_POINTER(leafless_octree_bitmap, octree,
                 leafless_octree_bitmap(NULL, 4, low, high, NULL, NULL, NULL, 0, count));
    NULL_POINTER(leafless_octree_bitmap, min_cell,
                 leafless_octree_bitmap(octree, 4, NULL, high, NULL, NULL, NULL, 0, count));
    NULL_POINTER(leafless_octree_bitmap, max_cell,
                 leafless_octree_bitmap(octree, 4, low, NULL, NULL, NULL, NULL, 0, count));
    NULL_POINTER(leafless_octree_bitmap, inner,
                 leafless_octree_bitmap(octree, 4, low, high, NULL, NULL, count + 4, 4, count));
    NULL_POINTER(leafless_octree_bitmap, count,
                 leafless_octree_bitmap(octree, 4, low, high, NULL, count, NULL, 4, NULL));
    NULL_POINTER(leafless_octree_surface, octree, leafless_octree_surface(NULL, &surface, NULL, mesh_result));
    NULL_POINTER(leafless_octree_surface, mesh, leafless_octree_surface(octree, &surface, NULL, NULL));
    NULL_POINTER(leafless_volume_surface, volume, leafless_volume_surface(NULL, band, NULL, mesh_result));
    NULL_POINTER(leafless_volume_surface, mesh, leafless_volume_surface(volume, band, NULL, NULL));
    NULL_POINTER(leafless_solid_surface, solid, leafless_solid_surface(NULL, &frame, &surface, NULL, mesh_result));
    NULL_POINTER(leafless_solid_surface, frame, leafless_solid_surface(solid, NULL, &surface, NULL, mesh_result));
    NULL_POINTER(leafless_solid_surface, mesh, leafless_solid_surface(solid, &frame, &surface, NULL, NULL));
    NULL_POINTER(leafless_solid_boundary, solid,
                 leafless_solid_boundary(NULL, &frame, 1, NULL, (leafless_boundary **)mesh_result));
    NULL_POINTER(leafless_solid_boundary, frame,
                 leafless_solid_boundary(solid, NULL, 1, NULL, (leafless_boundary **)mesh_result));
    NULL_POINTER(leafless_solid_boundary, boundary, leafless_solid_boundary(solid, &frame, 1, NULL, NULL));
    NULL_POINTER(leafless_solid_contour, solid, leafless_solid_contour(NULL, &frame, 1, NULL, NULL, mesh_result));
    NULL_POINTER(leafless_solid_contour, frame, leafless_solid_contour(solid, NULL, 1, NULL, NULL, mesh_result));
    NULL_POINTER(leafless_solid_contour, mesh, leafless_solid_contour(solid, &frame, 1, NULL, NULL, NULL));
    NULL_POINTER(leafless_mesh_normals, mesh, leafless_mesh_normals(NULL, NULL, 0, count));
    NULL_POINTER(leafless_mesh_normals, normals, leafless_mesh_normals(mesh, NULL, 8, count));
    NULL_POINTER(leafless_mesh_normals, count, leafless_mesh_normals(mesh, NULL, 0, NULL));
    MISALIGNED(leafless_mesh_normals, normals, leafless_mesh_normals(mesh, (double *)WRONG(out), 8, count));
    NULL_POINTER(leafless_mesh_area, mesh, leafless_mesh_area(NULL, (double *)out));
    NULL_POINTER(leafless_mesh_area, area_model, leafless_mesh_area(mesh, NULL));
    NULL_POINTER(leafless_mesh_in_single_precision, mesh,
                 leafless_mesh_in_single_precision(NULL, 0, NULL, NULL, mesh_result));
    NULL_POINTER(leafless_mesh_in_single_precision, single,
                 leafless_mesh_in_single_precision(mesh, 0, NULL, NULL, NULL));
    MISALIGNED(leafless_mesh_in_single_precision, options,
               leafless_mesh_in_single_precision(mesh, 0, (const leafless_options *)WRONG(&options), NULL, mesh_result));
    MISALIGNED(leafless_mesh_in_single_precision, report,
               leafless_mesh_in_single_precision(mesh, 0, NULL, (leafless_single_precision *)WRONG(out), mesh_result));
    MISALIGNED(leafless_mesh_in_single_precision, single,
               leafless_mesh_in_single_precision(mesh, 0, NULL, NULL, (leafless_mesh **)WRONG(out)));
    NULL_POINTER(leafless_mesh_simplify, mesh, leafless_mesh_simplify(NULL, 1, NULL, NULL, mesh_result));
    NULL_POINTER(leafless_mesh_simplify, simple, leafless_mesh_simplify(mesh, 1, NULL, NULL, NULL));
    MISALIGNED(leafless_mesh_simplify, options,
               leafless_mesh_simplify(mesh, 1, (const leafless_options *)WRONG(&options), NULL, mesh_result));
    MISALIGNED(leafless_mesh_simplify, report,
               leafless_mesh_simplify(mesh, 1, NULL, (leafless_simplified *)WRONG(out), mesh_result));
    MISALIGNED(leafless_mesh_simplify, simple,
               leafless_mesh_simplify(mesh, 1, NULL, NULL, (leafless_mesh **)WRONG(out)));
    NULL_POINTER(leafless_mesh_written_form, mesh, leafless_mesh_written_form(NULL, &write, mesh_result));
    NULL_POINTER(leafless_mesh_written_form, options, leafless_mesh_written_form(mesh, NULL, mesh_result));
    NULL_POINTER(leafless_mesh_written_form, kept, leafless_mesh_written_form(mesh, &write, NULL));

    MISALIGNED(leafless_volume_new, layout,
               volume_of_array((leafless_volume_layout *)WRONG(&layout), samples, 8, made));
    MISALIGNED(leafless_volume_new, volume, volume_of_array(&layout, samples, 8, (leafless_volume **)WRONG(out)));
    layout.sample_type = LEAFLESS_SAMPLE_TYPE_U16;
    MISALIGNED(leafless_volume_new, source.bytes, volume_in_place(&layout, WRONG(samples), 16, made));
    MISALIGNED(leafless_volume_describe, volume, leafless_volume_describe((leafless_volume *)WRONG(volume), info));
    MISALIGNED(leafless_volume_describe, info,
               leafless_volume_describe(volume, (leafless_volume_info *)WRONG(out)));
    MISALIGNED(leafless_volume_peek_samples, samples,
               leafless_volume_peek_samples(volume, (const void **)WRONG(out), count));
    MISALIGNED(leafless_volume_frame, frame, leafless_volume_frame(volume, (leafless_frame *)WRONG(out)));
    MISALIGNED(leafless_volume_bounds, max_model,
               leafless_volume_bounds(volume, (double *)out, (double *)WRONG(out)));
    MISALIGNED(leafless_volume_range, range, leafless_volume_range(volume, NULL, (leafless_interval *)WRONG(out)));
    MISALIGNED(leafless_volume_surface, options,
               leafless_volume_surface(volume, band, (leafless_options *)WRONG(&options), mesh_result));
    MISALIGNED(leafless_volume_surface, band,
               leafless_volume_surface(volume, (leafless_interval *)WRONG(band), NULL, mesh_result));
    MISALIGNED(leafless_solid_from_volume, band,
               leafless_solid_from_volume(volume, (leafless_interval *)WRONG(band), NULL, solid_result));
    MISALIGNED(leafless_solid_from_volume, options,
               leafless_solid_from_volume(volume, band, (leafless_options *)WRONG(&options), solid_result));
    MISALIGNED(leafless_solid_from_volume, solid,
               leafless_solid_from_volume(volume, band, NULL, (leafless_solid **)WRONG(out)));
    MISALIGNED(leafless_octree_bitmap, min_cell,
               leafless_octree_bitmap(octree, 4, cell, high, NULL, NULL, NULL, 0, count));
    MISALIGNED(leafless_octree_bitmap, max_cell,
               leafless_octree_bitmap(octree, 4, low, cell, NULL, NULL, NULL, 0, count));
    MISALIGNED(leafless_octree_bitmap, inner,
               leafless_octree_bitmap(octree, 4, low, high, NULL, (uint64_t *)WRONG(out), NULL, 4, count));
    MISALIGNED(leafless_octree_bitmap, outer,
               leafless_octree_bitmap(octree, 4, low, high, NULL, count + 8, (uint64_t *)WRONG(out), 4, count));
    MISALIGNED(leafless_octree_bitmap, count,
               leafless_octree_bitmap(octree, 4, low, high, NULL, NULL, NULL, 0, (uint64_t *)WRONG(out)));
    MISALIGNED(leafless_octree_surface, surface,
               leafless_octree_surface(octree, (leafless_surface_options *)WRONG(&surface), NULL, mesh_result));
    MISALIGNED(leafless_octree_surface, options,
               leafless_octree_surface(octree, NULL, (leafless_options *)WRONG(&options), mesh_result));
    MISALIGNED(leafless_octree_surface, mesh,
               leafless_octree_surface(octree, NULL, NULL, (leafless_mesh **)WRONG(out)));
    MISALIGNED(leafless_solid_surface, frame,
               leafless_solid_surface(solid, (leafless_frame *)WRONG(&frame), NULL, NULL, mesh_result));
    MISALIGNED(leafless_solid_surface, mesh,
               leafless_solid_surface(solid, &frame, NULL, NULL, (leafless_mesh **)WRONG(out)));
    MISALIGNED(leafless_solid_boundary, frame,
               leafless_solid_boundary(solid, (leafless_frame *)WRONG(&frame), 1, NULL,
                                       (leafless_boundary **)mesh_result));
    MISALIGNED(leafless_solid_boundary, options,
               leafless_solid_boundary(solid, &frame, 1, (const leafless_options *)WRONG(&options),
                                       (leafless_boundary **)mesh_result));
    MISALIGNED(leafless_solid_boundary, boundary,
               leafless_solid_boundary(solid, &frame, 1, NULL, (leafless_boundary **)WRONG(out)));
    boundaries();
    MISALIGNED(leafless_solid_contour, frame,
               leafless_solid_contour(solid, (leafless_frame *)WRONG(&frame), 1, NULL, NULL, mesh_result));
    MISALIGNED(leafless_solid_contour, report,
               leafless_solid_contour(solid, &frame, 1, NULL, (leafless_contour_report *)WRONG(out), mesh_result));
    MISALIGNED(leafless_solid_contour, mesh,
               leafless_solid_contour(solid, &frame, 1, NULL, NULL, (leafless_mesh **)WRONG(out)));
    surface.resolve = LEAFLESS_RESOLVE_SOURCE;
    NULL_POINTER(leafless_octree_surface, surface.source, leafless_octree_surface(octree, &surface, NULL, mesh_result));
    surface.source = (leafless_solid *)WRONG(solid);
    MISALIGNED(leafless_octree_surface, surface.source, leafless_octree_surface(octree, &surface, NULL, mesh_result));
    surface.resolve = LEAFLESS_RESOLVE_OUTER;
    surface.source = NULL;
    MISALIGNED(leafless_mesh_area, area_model, leafless_mesh_area(mesh, (double *)WRONG(out)));
    MISALIGNED(leafless_mesh_written_form, options,
               leafless_mesh_written_form(mesh, (leafless_mesh_write_options *)WRONG(&write), mesh_result));

    layout.sample_type = LEAFLESS_SAMPLE_TYPE_U8;
    BAD_NUMBER(leafless_octree_bitmap, level,
               leafless_octree_bitmap(octree, 5, low, high, NULL, NULL, NULL, 0, count));
    BAD_NUMBER(leafless_octree_bitmap, level,
               leafless_octree_bitmap(octree, UINT32_MAX, low, high, NULL, NULL, NULL, 0, count));
    CHECK(volume_open_raw("a\xff", 2, &layout, made) == LEAFLESS_E_UTF8);
    refused(LEAFLESS_E_VOLUME_FILE, "leafless_volume_data_file", "", leafless_volume_data_file(NULL, 0, NULL, 0, count));
    untouched();
    CHECK(never == UNTOUCHED);

    MAY_BE_NULL(leafless_volume_range, options, leafless_volume_range(volume, NULL, &range));
    MAY_BE_NULL(leafless_solid_from_volume, band, leafless_solid_from_volume(volume, NULL, &options, solid_result));
    leafless_solid_free(*solid_result);
    MAY_BE_NULL(leafless_solid_from_volume, options, leafless_solid_from_volume(volume, band, NULL, solid_result));
    leafless_solid_free(*solid_result);
    MAY_BE_NULL(leafless_volume_data_file, name, leafless_volume_data_file(header, length, NULL, 0, &number));
    {
        uint64_t inner[4], outer[4];
        MAY_BE_NULL(leafless_octree_bitmap, inner,
                    leafless_octree_bitmap(octree, 4, low, high, &options, NULL, NULL, 0, &number));
        CHECK(number == 4);
        MAY_BE_NULL(leafless_octree_bitmap, outer,
                    leafless_octree_bitmap(octree, 4, low, high, &options, inner, NULL, 4, &number));
        MAY_BE_NULL(leafless_octree_bitmap, options,
                    leafless_octree_bitmap(octree, 4, low, high, NULL, inner, outer, 4, &number));
    }
    MAY_BE_NULL(leafless_volume_surface, band, leafless_volume_surface(volume, NULL, &options, mesh_result));
    leafless_mesh_free(*mesh_result);
    MAY_BE_NULL(leafless_volume_surface, options, leafless_volume_surface(volume, band, NULL, mesh_result));
    leafless_mesh_free(*mesh_result);
    MAY_BE_NULL(leafless_octree_surface, options, leafless_octree_surface(octree, &surface, NULL, mesh_result));
    leafless_mesh_free(*mesh_result);
    {
        leafless_octree *full = NULL;
        OK(leafless_octree_new_uniform(&frame, LEAFLESS_TAG_FULL, LEAFLESS_TAG_EMPTY, &full));
        MAY_BE_NULL(leafless_octree_surface, surface, leafless_octree_surface(full, NULL, &options, mesh_result));
        leafless_mesh_free(*mesh_result);
        leafless_octree_free(full);
    }
    MAY_BE_NULL(leafless_solid_surface, surface, leafless_solid_surface(solid, &frame, NULL, &options, mesh_result));
    leafless_mesh_free(*mesh_result);
    surface.resolve = 0;
    MAY_BE_NULL(leafless_solid_surface, options, leafless_solid_surface(solid, &frame, &surface, NULL, mesh_result));
    leafless_mesh_free(*mesh_result);
    {
        const double middle[3] = {frame.origin[0] + 0.5 * frame.edge, frame.origin[1] + 0.5 * frame.edge,
                                  frame.origin[2] + 0.5 * frame.edge};
        leafless_solid *round = NULL;
        OK(leafless_solid_new_ball(middle, 0.25 * frame.edge, &round));
        {
            leafless_boundary *boundary = NULL;
            MAY_BE_NULL(leafless_solid_boundary, options,
                        leafless_solid_boundary(round, &frame, frame.edge, NULL, &boundary));
            leafless_boundary_free(boundary);
        }
        MAY_BE_NULL(leafless_solid_contour, options,
                    leafless_solid_contour(round, &frame, frame.edge, NULL, NULL, mesh_result));
        leafless_mesh_free(*mesh_result);
        MAY_BE_NULL(leafless_solid_contour, report,
                    leafless_solid_contour(round, &frame, frame.edge, &options, NULL, mesh_result));
        leafless_mesh_free(*mesh_result);
        leafless_solid_free(round);
    }
    {
        leafless_single_precision told = LEAFLESS_INIT(leafless_single_precision);
        MAY_BE_NULL(leafless_mesh_in_single_precision, options,
                    leafless_mesh_in_single_precision(mesh, 0, NULL, &told, mesh_result));
        leafless_mesh_free(*mesh_result);
        MAY_BE_NULL(leafless_mesh_in_single_precision, report,
                    leafless_mesh_in_single_precision(mesh, 0, &options, NULL, mesh_result));
        leafless_mesh_free(*mesh_result);
        MAY_BE_NULL(leafless_mesh_simplify, options, leafless_mesh_simplify(mesh, 1, NULL, NULL, mesh_result));
        leafless_mesh_free(*mesh_result);
        MAY_BE_NULL(leafless_mesh_simplify, report, leafless_mesh_simplify(mesh, 1, &options, NULL, mesh_result));
        leafless_mesh_free(*mesh_result);
    }
    MAY_BE_NULL(leafless_mesh_normals, normals, leafless_mesh_normals(mesh, NULL, 0, &number));
    CHECK(number == 8);
    OK(leafless_mesh_area(mesh, &real));
    leafless_volume_free(volume);
    leafless_volume_free(NULL);
}

static void cells_and_faces(void) {
    void *out = fresh();
    void *never = UNTOUCHED;
    leafless_cells *cells = NULL, **cells_result = (leafless_cells **)&never;
    leafless_faces *faces = NULL, **faces_result = (leafless_faces **)&never;
    const uint32_t cell[4] = {0, 0, 0, 0}, end[3] = {16, 16, 16};
    const uint32_t *wrong = (const uint32_t *)WRONG(cell);
    const int32_t up[4] = {0, 0, 1, 0}, still[3] = {0, 0, 0}, far[3] = {0, 0, 256};
    leafless_cell *some = (leafless_cell *)out, one;
    leafless_boundary_face *squares = (leafless_boundary_face *)out;
    double *low = (double *)out;
    uint64_t number;
    bool flag;

    /* Corners are NULL both, or none of them. */
    MAY_BE_NULL(leafless_cells_new, min_cell, leafless_cells_new(octree, 13, 0, 20, NULL, NULL, &cells));
    leafless_cells_free(cells);
    MAY_BE_NULL(leafless_cells_new, max_cell, leafless_cells_new(octree, 13, 0, 20, NULL, NULL, &cells));
    leafless_cells_free(cells);
    MAY_BE_NULL(leafless_faces_new, min_cell, leafless_faces_new(octree, 8, 0, 20, NULL, NULL, &faces));
    leafless_faces_free(faces);
    MAY_BE_NULL(leafless_faces_new, max_cell, leafless_faces_new(octree, 8, 0, 20, NULL, NULL, &faces));
    leafless_faces_free(faces);
    OK(leafless_cells_new(octree, LEAFLESS_TAGS_LEAVES, 0, 20, cell, end, &cells));
    OK(leafless_faces_new(octree, LEAFLESS_TAGS_FULL, 0, 20, cell, end, &faces));
    NULL_POINTER(leafless_frame_cell_bounds, frame, leafless_frame_cell_bounds(NULL, cell, 0, low, low));
    NULL_POINTER(leafless_frame_cell_bounds, cell, leafless_frame_cell_bounds(&frame, NULL, 0, low, low));
    NULL_POINTER(leafless_frame_cell_bounds, min_model, leafless_frame_cell_bounds(&frame, cell, 0, NULL, low));
    NULL_POINTER(leafless_frame_cell_bounds, max_model, leafless_frame_cell_bounds(&frame, cell, 0, low, NULL));
    NULL_POINTER(leafless_cursor_seek, cursor, leafless_cursor_seek(NULL, cell, 0, (bool *)out));
    NULL_POINTER(leafless_cursor_seek, cell, leafless_cursor_seek(cursor, NULL, 0, (bool *)out));
    NULL_POINTER(leafless_cursor_neighbour, cursor, leafless_cursor_neighbour(NULL, up, some, NULL));
    NULL_POINTER(leafless_cursor_neighbour, direction, leafless_cursor_neighbour(cursor, NULL, some, NULL));
    NULL_POINTER(leafless_cursor_neighbour, neighbour, leafless_cursor_neighbour(cursor, up, NULL, (bool *)out));
    NULL_POINTER(leafless_cursor_neighbours, cursor, leafless_cursor_neighbours(NULL, up, NULL, 0, (uint64_t *)out));
    NULL_POINTER(leafless_cursor_neighbours, direction,
                 leafless_cursor_neighbours(cursor, NULL, NULL, 0, (uint64_t *)out));
    NULL_POINTER(leafless_cursor_neighbours, cells, leafless_cursor_neighbours(cursor, up, NULL, 1, (uint64_t *)out));
    NULL_POINTER(leafless_cursor_neighbours, count, leafless_cursor_neighbours(cursor, up, NULL, 0, NULL));
    NULL_POINTER(leafless_cells_new, octree, leafless_cells_new(NULL, 13, 0, 20, NULL, NULL, cells_result));
    NULL_POINTER(leafless_cells_new, min_cell, leafless_cells_new(octree, 13, 0, 20, NULL, end, cells_result));
    NULL_POINTER(leafless_cells_new, max_cell, leafless_cells_new(octree, 13, 0, 20, cell, NULL, cells_result));
    NULL_POINTER(leafless_cells_new, cells, leafless_cells_new(octree, 13, 0, 20, NULL, NULL, NULL));
    NULL_POINTER(leafless_cells_seek, cells, leafless_cells_seek(NULL, cell, 0));
    NULL_POINTER(leafless_cells_seek, cell, leafless_cells_seek(cells, NULL, 0));
    NULL_POINTER(leafless_cells_next, cells, leafless_cells_next(NULL, some, 1, (uint64_t *)out));
    NULL_POINTER(leafless_cells_next, buffer, leafless_cells_next(cells, NULL, 1, (uint64_t *)out));
    NULL_POINTER(leafless_cells_next, count, leafless_cells_next(cells, some, 1, NULL));
    NULL_POINTER(leafless_faces_new, octree, leafless_faces_new(NULL, 8, 0, 20, NULL, NULL, faces_result));
    NULL_POINTER(leafless_faces_new, min_cell, leafless_faces_new(octree, 8, 0, 20, NULL, end, faces_result));
    NULL_POINTER(leafless_faces_new, max_cell, leafless_faces_new(octree, 8, 0, 20, cell, NULL, faces_result));
    NULL_POINTER(leafless_faces_new, faces, leafless_faces_new(octree, 8, 0, 20, NULL, NULL, NULL));
    NULL_POINTER(leafless_faces_seek, faces, leafless_faces_seek(NULL, cell, 0));
    NULL_POINTER(leafless_faces_seek, cell, leafless_faces_seek(faces, NULL, 0));
    NULL_POINTER(leafless_faces_next, faces, leafless_faces_next(NULL, squares, 1, (uint64_t *)out));
    NULL_POINTER(leafless_faces_next, buffer, leafless_faces_next(faces, NULL, 1, (uint64_t *)out));
    NULL_POINTER(leafless_faces_next, count, leafless_faces_next(faces, squares, 1, NULL));

    MISALIGNED(leafless_frame_cell_bounds, cell, leafless_frame_cell_bounds(&frame, wrong, 0, low, low));
    MISALIGNED(leafless_frame_cell_bounds, min_model, leafless_frame_cell_bounds(&frame, cell, 0, (double *)WRONG(out), low));
    MISALIGNED(leafless_frame_cell_bounds, max_model, leafless_frame_cell_bounds(&frame, cell, 0, low, (double *)WRONG(out)));
    MISALIGNED(leafless_cursor_seek, cursor, leafless_cursor_seek((leafless_cursor *)WRONG(cursor), cell, 0, NULL));
    MISALIGNED(leafless_cursor_seek, cell, leafless_cursor_seek(cursor, wrong, 0, NULL));
    MISALIGNED(leafless_cursor_neighbour, direction,
               leafless_cursor_neighbour(cursor, (const int32_t *)WRONG(up), some, NULL));
    MISALIGNED(leafless_cursor_neighbour, neighbour,
               leafless_cursor_neighbour(cursor, up, (leafless_cell *)WRONG(out), NULL));
    MISALIGNED(leafless_cursor_neighbours, cells,
               leafless_cursor_neighbours(cursor, up, (leafless_cell *)WRONG(out), 1, (uint64_t *)out));
    MISALIGNED(leafless_cursor_neighbours, count,
               leafless_cursor_neighbours(cursor, up, NULL, 0, (uint64_t *)WRONG(out)));
    MISALIGNED(leafless_cells_new, min_cell, leafless_cells_new(octree, 13, 0, 20, wrong, end, cells_result));
    MISALIGNED(leafless_cells_new, max_cell, leafless_cells_new(octree, 13, 0, 20, cell, wrong, cells_result));
    MISALIGNED(leafless_cells_new, cells, leafless_cells_new(octree, 13, 0, 20, NULL, NULL, (leafless_cells **)WRONG(out)));
    MISALIGNED(leafless_cells_seek, cells, leafless_cells_seek((leafless_cells *)WRONG(cells), cell, 0));
    MISALIGNED(leafless_cells_next, buffer, leafless_cells_next(cells, (leafless_cell *)WRONG(out), 1, (uint64_t *)out));
    MISALIGNED(leafless_cells_next, count, leafless_cells_next(cells, some, 1, (uint64_t *)WRONG(out)));
    MISALIGNED(leafless_faces_new, min_cell, leafless_faces_new(octree, 8, 0, 20, wrong, end, faces_result));
    MISALIGNED(leafless_faces_new, faces, leafless_faces_new(octree, 8, 0, 20, NULL, NULL, (leafless_faces **)WRONG(out)));
    MISALIGNED(leafless_faces_seek, cell, leafless_faces_seek(faces, wrong, 0));
    MISALIGNED(leafless_faces_next, faces,
               leafless_faces_next((leafless_faces *)WRONG(faces), squares, 1, (uint64_t *)out));
    MISALIGNED(leafless_faces_next, buffer,
               leafless_faces_next(faces, (leafless_boundary_face *)WRONG(out), 1, (uint64_t *)out));
    MISALIGNED(leafless_faces_next, count, leafless_faces_next(faces, squares, 1, (uint64_t *)WRONG(out)));

    BAD_NUMBER(leafless_frame_cell_bounds, cell, leafless_frame_cell_bounds(&frame, cell, 5, low, low));
    BAD_NUMBER(leafless_frame_cell_bounds, cell, leafless_frame_cell_bounds(&frame, end, 4, low, low));
    BAD_NUMBER(leafless_cursor_seek, cell, leafless_cursor_seek(cursor, cell, UINT32_MAX, NULL));
    BAD_NUMBER(leafless_cursor_neighbour, direction, leafless_cursor_neighbour(cursor, still, some, NULL));
    BAD_NUMBER(leafless_cursor_neighbour, direction, leafless_cursor_neighbour(cursor, far, some, NULL));
    BAD_NUMBER(leafless_cursor_neighbours, direction,
               leafless_cursor_neighbours(cursor, still, NULL, 0, (uint64_t *)out));
    BAD_NUMBER(leafless_cells_new, tags, leafless_cells_new(octree, 0, 0, 20, NULL, NULL, cells_result));
    BAD_NUMBER(leafless_faces_new, tags, leafless_faces_new(octree, 16, 0, 20, NULL, NULL, faces_result));
    BAD_NUMBER(leafless_cells_seek, cell, leafless_cells_seek(cells, end, 4));
    BAD_NUMBER(leafless_faces_seek, cell, leafless_faces_seek(faces, cell, 5));
    BAD_NUMBER(leafless_cells_next, buffer, leafless_cells_next(cells, some, UINT64_MAX, (uint64_t *)out));
    untouched();
    CHECK(never == UNTOUCHED);

    MAY_BE_NULL(leafless_cursor_seek, reached, leafless_cursor_seek(cursor, cell, 1, NULL));
    MAY_BE_NULL(leafless_cursor_neighbour, exists, leafless_cursor_neighbour(cursor, up, &one, NULL));
    MAY_BE_NULL(leafless_cursor_neighbours, cells, leafless_cursor_neighbours(cursor, up, NULL, 0, &number));
    MAY_BE_NULL(leafless_cells_next, buffer, leafless_cells_next(cells, NULL, 0, &number));
    MAY_BE_NULL(leafless_faces_next, buffer, leafless_faces_next(faces, NULL, 0, &number));
    OK(leafless_cursor_seek(cursor, cell, 0, &flag));
    CHECK(flag && number == 0);
    leafless_cells_free(cells);
    leafless_faces_free(faces);
    leafless_cells_free(NULL);
    leafless_faces_free(NULL);
}

static void rays(void) {
    void *out = fresh();
    const leafless_ray good = {{-2, 0, 0}, {1, 0, 0}, INFINITY};
    const leafless_ray *wrong = (const leafless_ray *)WRONG(&good);
    leafless_ray bad = good;
    leafless_ray_hit *hits = (leafless_ray_hit *)out, hit;
    leafless_interval *spans = (leafless_interval *)out;
    uint64_t *count = (uint64_t *)out, inner, outer;
    leafless_sight sight;
    const double far[4] = {0, 0, 3, 0}, huge[3] = {0, 0, 1e300};

    NULL_POINTER(leafless_octree_cast_rays, octree, leafless_octree_cast_rays(NULL, &good, 1, 0, hits));
    NULL_POINTER(leafless_octree_cast_rays, rays, leafless_octree_cast_rays(octree, NULL, 1, 0, hits));
    NULL_POINTER(leafless_octree_cast_rays, hits, leafless_octree_cast_rays(octree, &good, 1, 0, NULL));
    NULL_POINTER(leafless_solid_cast_rays, solid, leafless_solid_cast_rays(NULL, &frame, &good, 1, 0, NULL, hits));
    NULL_POINTER(leafless_solid_cast_rays, frame, leafless_solid_cast_rays(solid, NULL, &good, 1, 0, NULL, hits));
    NULL_POINTER(leafless_solid_cast_rays, rays, leafless_solid_cast_rays(solid, &frame, NULL, 1, 0, NULL, hits));
    NULL_POINTER(leafless_solid_cast_rays, hits, leafless_solid_cast_rays(solid, &frame, &good, 1, 0, NULL, NULL));
    NULL_POINTER(leafless_octree_ray_spans, octree,
                 leafless_octree_ray_spans(NULL, &good, NULL, 0, count, NULL, 0, count));
    NULL_POINTER(leafless_octree_ray_spans, ray,
                 leafless_octree_ray_spans(octree, NULL, NULL, 0, count, NULL, 0, count));
    NULL_POINTER(leafless_octree_ray_spans, inner,
                 leafless_octree_ray_spans(octree, &good, NULL, 1, count, NULL, 0, count));
    NULL_POINTER(leafless_octree_ray_spans, inner_count,
                 leafless_octree_ray_spans(octree, &good, NULL, 0, NULL, NULL, 0, count));
    NULL_POINTER(leafless_octree_ray_spans, outer,
                 leafless_octree_ray_spans(octree, &good, NULL, 0, count, NULL, 1, count));
    NULL_POINTER(leafless_octree_ray_spans, outer_count,
                 leafless_octree_ray_spans(octree, &good, NULL, 0, count, NULL, 0, NULL));
    NULL_POINTER(leafless_solid_ray_spans, solid,
                 leafless_solid_ray_spans(NULL, &frame, &good, NULL, NULL, 0, count, NULL, 0, count));
    NULL_POINTER(leafless_solid_ray_spans, frame,
                 leafless_solid_ray_spans(solid, NULL, &good, NULL, NULL, 0, count, NULL, 0, count));
    NULL_POINTER(leafless_solid_ray_spans, ray,
                 leafless_solid_ray_spans(solid, &frame, NULL, NULL, NULL, 0, count, NULL, 0, count));
    NULL_POINTER(leafless_solid_ray_spans, inner,
                 leafless_solid_ray_spans(solid, &frame, &good, NULL, NULL, 1, count, NULL, 0, count));
    NULL_POINTER(leafless_solid_ray_spans, inner_count,
                 leafless_solid_ray_spans(solid, &frame, &good, NULL, NULL, 0, NULL, NULL, 0, count));
    NULL_POINTER(leafless_solid_ray_spans, outer,
                 leafless_solid_ray_spans(solid, &frame, &good, NULL, NULL, 0, count, NULL, 1, count));
    NULL_POINTER(leafless_solid_ray_spans, outer_count,
                 leafless_solid_ray_spans(solid, &frame, &good, NULL, NULL, 0, count, NULL, 0, NULL));
    NULL_POINTER(leafless_solid_line_of_sight, solid,
                 leafless_solid_line_of_sight(NULL, &frame, point, far, NULL, (leafless_sight *)out));
    NULL_POINTER(leafless_solid_line_of_sight, frame,
                 leafless_solid_line_of_sight(solid, NULL, point, far, NULL, (leafless_sight *)out));
    NULL_POINTER(leafless_solid_line_of_sight, from_model,
                 leafless_solid_line_of_sight(solid, &frame, NULL, far, NULL, (leafless_sight *)out));
    NULL_POINTER(leafless_solid_line_of_sight, to_model,
                 leafless_solid_line_of_sight(solid, &frame, point, NULL, NULL, (leafless_sight *)out));
    NULL_POINTER(leafless_solid_line_of_sight, sight,
                 leafless_solid_line_of_sight(solid, &frame, point, far, NULL, NULL));

    MISALIGNED(leafless_octree_cast_rays, rays, leafless_octree_cast_rays(octree, wrong, 1, 0, hits));
    MISALIGNED(leafless_octree_cast_rays, hits,
               leafless_octree_cast_rays(octree, &good, 1, 0, (leafless_ray_hit *)WRONG(out)));
    MISALIGNED(leafless_solid_cast_rays, rays, leafless_solid_cast_rays(solid, &frame, wrong, 1, 0, NULL, hits));
    MISALIGNED(leafless_solid_cast_rays, hits,
               leafless_solid_cast_rays(solid, &frame, &good, 1, 0, NULL, (leafless_ray_hit *)WRONG(out)));
    MISALIGNED(leafless_octree_ray_spans, ray,
               leafless_octree_ray_spans(octree, wrong, NULL, 0, count, NULL, 0, count));
    MISALIGNED(leafless_octree_ray_spans, inner,
               leafless_octree_ray_spans(octree, &good, (leafless_interval *)WRONG(out), 1, count, NULL, 0, count));
    MISALIGNED(leafless_octree_ray_spans, outer_count,
               leafless_octree_ray_spans(octree, &good, NULL, 0, count, NULL, 0, (uint64_t *)WRONG(out)));
    MISALIGNED(leafless_solid_ray_spans, ray,
               leafless_solid_ray_spans(solid, &frame, wrong, NULL, NULL, 0, count, NULL, 0, count));
    MISALIGNED(leafless_solid_ray_spans, outer,
               leafless_solid_ray_spans(solid, &frame, &good, NULL, NULL, 0, count, (leafless_interval *)WRONG(out), 1,
                                        count));
    MISALIGNED(leafless_solid_line_of_sight, from_model,
               leafless_solid_line_of_sight(solid, &frame, (const double *)WRONG(far), far, NULL, (leafless_sight *)out));
    MISALIGNED(leafless_solid_line_of_sight, to_model,
               leafless_solid_line_of_sight(solid, &frame, point, (const double *)WRONG(far), NULL, (leafless_sight *)out));

    BAD_NUMBER(leafless_octree_cast_rays, on, leafless_octree_cast_rays(octree, &good, 1, 2, hits));
    BAD_NUMBER(leafless_solid_cast_rays, on, leafless_solid_cast_rays(solid, &frame, &good, 1, 2, NULL, hits));
    BAD_NUMBER(leafless_octree_cast_rays, rays, leafless_octree_cast_rays(octree, &good, UINT64_MAX, 0, hits));
    BAD_NUMBER(leafless_solid_line_of_sight, to,
               leafless_solid_line_of_sight(solid, &frame, point, huge, NULL, (leafless_sight *)out));
    BAD_NUMBER(leafless_solid_line_of_sight, direction,
               leafless_solid_line_of_sight(solid, &frame, point, point, NULL, (leafless_sight *)out));
    bad.direction_model[0] = 0;
    BAD_NUMBER(leafless_octree_cast_rays, rays, leafless_octree_cast_rays(octree, &bad, 1, 0, hits));
    BAD_NUMBER(leafless_solid_cast_rays, rays, leafless_solid_cast_rays(solid, &frame, &bad, 1, 0, NULL, hits));
    BAD_NUMBER(leafless_octree_ray_spans, direction,
               leafless_octree_ray_spans(octree, &bad, NULL, 0, count, NULL, 0, count));
    bad = good;
    bad.t_last = 0;
    BAD_NUMBER(leafless_octree_cast_rays, last, leafless_octree_cast_rays(octree, &bad, 1, 0, hits));
    bad.t_last = (double)NAN;
    BAD_NUMBER(leafless_solid_ray_spans, last,
               leafless_solid_ray_spans(solid, &frame, &bad, NULL, spans, 1, count, NULL, 0, count));
    bad = good;
    bad.origin_model[1] = INFINITY;
    BAD_NUMBER(leafless_solid_cast_rays, origin, leafless_solid_cast_rays(solid, &frame, &bad, 1, 0, NULL, hits));
    untouched();

    MAY_BE_NULL(leafless_octree_cast_rays, rays, leafless_octree_cast_rays(octree, NULL, 0, 0, NULL));
    MAY_BE_NULL(leafless_octree_cast_rays, hits, leafless_octree_cast_rays(octree, NULL, 0, 0, NULL));
    MAY_BE_NULL(leafless_solid_cast_rays, rays, leafless_solid_cast_rays(solid, &frame, NULL, 0, 0, NULL, NULL));
    MAY_BE_NULL(leafless_solid_cast_rays, hits, leafless_solid_cast_rays(solid, &frame, NULL, 0, 0, NULL, NULL));
    MAY_BE_NULL(leafless_solid_cast_rays, options, leafless_solid_cast_rays(solid, &frame, &good, 1, 0, NULL, &hit));
    MAY_BE_NULL(leafless_octree_ray_spans, inner,
                leafless_octree_ray_spans(octree, &good, NULL, 0, &inner, NULL, 0, &outer));
    MAY_BE_NULL(leafless_octree_ray_spans, outer,
                leafless_octree_ray_spans(octree, &good, NULL, 0, &inner, NULL, 0, &outer));
    MAY_BE_NULL(leafless_solid_ray_spans, inner,
                leafless_solid_ray_spans(solid, &frame, &good, NULL, NULL, 0, &inner, NULL, 0, &outer));
    MAY_BE_NULL(leafless_solid_ray_spans, outer,
                leafless_solid_ray_spans(solid, &frame, &good, NULL, NULL, 0, &inner, NULL, 0, &outer));
    MAY_BE_NULL(leafless_solid_ray_spans, options,
                leafless_solid_ray_spans(solid, &frame, &good, NULL, NULL, 0, &inner, NULL, 0, &outer));
    MAY_BE_NULL(leafless_solid_line_of_sight, options,
                leafless_solid_line_of_sight(solid, &frame, point, far, NULL, &sight));
    CHECK(hit.is_hit && inner == 1 && outer == 1 && sight == LEAFLESS_SIGHT_BLOCKED);
}

static void voxels(void) {
    void *out = fresh();
    void *never = UNTOUCHED;
    const uint64_t codes[2] = {0, 8};
    const uint8_t levels[2] = {3, 3}, kinds[2] = {2, 1};
    const int32_t turn[3] = {1, 2, 3}, nowhere[3] = {1, 1, 2};
    const uint32_t cell[3] = {0, 0, 0};
    const double direction[3] = {1, 0, 0}, zero[3] = {0, 0, 0};
    const leafless_frame small = {{0, 0, 0}, 1, 4};
    leafless_octree **result = (leafless_octree **)&never, *made = NULL;
    leafless_frame lattice;
    leafless_mesh *cube = NULL;
    const leafless_mesh_arrays arrays = check_arrays(CHECK_CUBE, 8, CHECK_CUBE_TRIANGLES, 12);
    uint64_t *count = (uint64_t *)out, number, other;

    OK(leafless_mesh_new(&arrays, &cube));
    NULL_POINTER(leafless_octree_voxels, octree,
                 leafless_octree_voxels(NULL, NULL, NULL, (leafless_frame *)out, NULL, NULL, NULL, NULL, NULL, 0, count));
    NULL_POINTER(leafless_octree_voxels, lattice,
                 leafless_octree_voxels(octree, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, 0, count));
    NULL_POINTER(leafless_octree_voxels, count,
                 leafless_octree_voxels(octree, NULL, NULL, (leafless_frame *)out, NULL, NULL, NULL, NULL, NULL, 0, NULL));
    MISALIGNED(leafless_octree_voxels, codes,
               leafless_octree_voxels(octree, NULL, NULL, (leafless_frame *)out, (uint64_t *)WRONG(out), NULL, NULL, NULL,
                                      NULL, 1, count));
    NULL_POINTER(leafless_voxels_find, lattice, leafless_voxels_find(NULL, codes, levels, kinds, 2, cell, 0, count));
    NULL_POINTER(leafless_voxels_find, codes, leafless_voxels_find(&small, NULL, levels, kinds, 2, cell, 0, count));
    NULL_POINTER(leafless_voxels_find, levels, leafless_voxels_find(&small, codes, NULL, kinds, 2, cell, 0, count));
    NULL_POINTER(leafless_voxels_find, kinds, leafless_voxels_find(&small, codes, levels, NULL, 2, cell, 0, count));
    NULL_POINTER(leafless_voxels_find, cell, leafless_voxels_find(&small, codes, levels, kinds, 2, NULL, 0, count));
    NULL_POINTER(leafless_voxels_find, index, leafless_voxels_find(&small, codes, levels, kinds, 2, cell, 0, NULL));
    NULL_POINTER(leafless_voxels_order, lattice,
                 leafless_voxels_order(NULL, codes, levels, kinds, 2, direction, false, NULL, NULL, 0, count));
    NULL_POINTER(leafless_voxels_order, codes,
                 leafless_voxels_order(&small, NULL, levels, kinds, 2, direction, false, NULL, NULL, 0, count));
    NULL_POINTER(leafless_voxels_order, levels,
                 leafless_voxels_order(&small, codes, NULL, kinds, 2, direction, false, NULL, NULL, 0, count));
    NULL_POINTER(leafless_voxels_order, kinds,
                 leafless_voxels_order(&small, codes, levels, NULL, 2, direction, false, NULL, NULL, 0, count));
    NULL_POINTER(leafless_voxels_order, from,
                 leafless_voxels_order(&small, codes, levels, kinds, 2, NULL, false, NULL, NULL, 0, count));
    NULL_POINTER(leafless_voxels_order, order,
                 leafless_voxels_order(&small, codes, levels, kinds, 2, direction, false, NULL, NULL, 2, count));
    NULL_POINTER(leafless_voxels_order, order_count,
                 leafless_voxels_order(&small, codes, levels, kinds, 2, direction, false, NULL, NULL, 0, NULL));
    NULL_POINTER(leafless_voxels_moved, lattice,
                 leafless_voxels_moved(NULL, codes, levels, kinds, 2, turn, turn, NULL, NULL, NULL, NULL, NULL, 0, count));
    NULL_POINTER(leafless_voxels_moved, codes,
                 leafless_voxels_moved(&small, NULL, levels, kinds, 2, turn, turn, NULL, NULL, NULL, NULL, NULL, 0, count));
    NULL_POINTER(leafless_voxels_moved, levels,
                 leafless_voxels_moved(&small, codes, NULL, kinds, 2, turn, turn, NULL, NULL, NULL, NULL, NULL, 0, count));
    NULL_POINTER(leafless_voxels_moved, kinds,
                 leafless_voxels_moved(&small, codes, levels, NULL, 2, turn, turn, NULL, NULL, NULL, NULL, NULL, 0, count));
    NULL_POINTER(leafless_voxels_moved, axes,
                 leafless_voxels_moved(&small, codes, levels, kinds, 2, NULL, turn, NULL, NULL, NULL, NULL, NULL, 0, count));
    NULL_POINTER(leafless_voxels_moved, offset_cells,
                 leafless_voxels_moved(&small, codes, levels, kinds, 2, turn, NULL, NULL, NULL, NULL, NULL, NULL, 0, count));
    NULL_POINTER(leafless_voxels_moved, moved_count,
                 leafless_voxels_moved(&small, codes, levels, kinds, 2, turn, turn, NULL, NULL, NULL, NULL, NULL, 0, NULL));
    MISALIGNED(leafless_voxels_moved, axes,
               leafless_voxels_moved(&small, codes, levels, kinds, 2, (const int32_t *)WRONG(out), turn, NULL, NULL, NULL, NULL,
                                     NULL, 0, count));
    MISALIGNED(leafless_voxels_moved, offset_cells,
               leafless_voxels_moved(&small, codes, levels, kinds, 2, turn, (const int32_t *)WRONG(out), NULL, NULL, NULL, NULL,
                                     NULL, 0, count));
    MISALIGNED(leafless_voxels_moved, moved_codes,
               leafless_voxels_moved(&small, codes, levels, kinds, 2, turn, turn, NULL, (uint64_t *)WRONG(out), NULL, NULL,
                                     NULL, 4, count));
    MISALIGNED(leafless_voxels_moved, sources,
               leafless_voxels_moved(&small, codes, levels, kinds, 2, turn, turn, NULL, NULL, NULL, NULL,
                                     (uint64_t *)WRONG(out), 4, count));
    BAD_NUMBER(leafless_voxels_moved, axes,
               leafless_voxels_moved(&small, codes, levels, kinds, 2, nowhere, turn, NULL, NULL, NULL, NULL, NULL, 0, count));
    BAD_NUMBER(leafless_voxels_order, direction,
               leafless_voxels_order(&small, codes, levels, kinds, 2, zero, false, NULL, NULL, 0, count));
    NULL_POINTER(leafless_voxels_triangles, lattice,
                 leafless_voxels_triangles(NULL, codes, levels, kinds, 2, cube, NULL, NULL, 0, count, NULL, 0, count));
    NULL_POINTER(leafless_voxels_triangles, codes,
                 leafless_voxels_triangles(&small, NULL, levels, kinds, 2, cube, NULL, NULL, 0, count, NULL, 0, count));
    NULL_POINTER(leafless_voxels_triangles, levels,
                 leafless_voxels_triangles(&small, codes, NULL, kinds, 2, cube, NULL, NULL, 0, count, NULL, 0, count));
    NULL_POINTER(leafless_voxels_triangles, kinds,
                 leafless_voxels_triangles(&small, codes, levels, NULL, 2, cube, NULL, NULL, 0, count, NULL, 0, count));
    NULL_POINTER(leafless_voxels_triangles, mesh,
                 leafless_voxels_triangles(&small, codes, levels, kinds, 2, NULL, NULL, NULL, 0, count, NULL, 0, count));
    NULL_POINTER(leafless_voxels_triangles, offsets,
                 leafless_voxels_triangles(&small, codes, levels, kinds, 2, cube, NULL, NULL, 3, count, NULL, 0, count));
    NULL_POINTER(leafless_voxels_triangles, offset_count,
                 leafless_voxels_triangles(&small, codes, levels, kinds, 2, cube, NULL, NULL, 0, NULL, NULL, 0, count));
    NULL_POINTER(leafless_voxels_triangles, triangles,
                 leafless_voxels_triangles(&small, codes, levels, kinds, 2, cube, NULL, NULL, 0, count, NULL, 9, count));
    NULL_POINTER(leafless_voxels_triangles, triangle_count,
                 leafless_voxels_triangles(&small, codes, levels, kinds, 2, cube, NULL, NULL, 0, count, NULL, 0, NULL));
    NULL_POINTER(leafless_octree_from_voxels, lattice,
                 leafless_octree_from_voxels(NULL, codes, levels, kinds, 2, LEAFLESS_TAG_FULL, NULL, result));
    NULL_POINTER(leafless_octree_from_voxels, codes,
                 leafless_octree_from_voxels(&small, NULL, levels, kinds, 2, LEAFLESS_TAG_FULL, NULL, result));
    NULL_POINTER(leafless_octree_from_voxels, levels,
                 leafless_octree_from_voxels(&small, codes, NULL, kinds, 2, LEAFLESS_TAG_FULL, NULL, result));
    NULL_POINTER(leafless_octree_from_voxels, kinds,
                 leafless_octree_from_voxels(&small, codes, levels, NULL, 2, LEAFLESS_TAG_FULL, NULL, result));
    NULL_POINTER(leafless_octree_from_voxels, octree,
                 leafless_octree_from_voxels(&small, codes, levels, kinds, 2, LEAFLESS_TAG_FULL, NULL, NULL));
    BAD_NUMBER(leafless_octree_from_voxels, boundary,
               leafless_octree_from_voxels(&small, codes, levels, kinds, 2, LEAFLESS_TAG_BRANCH, NULL, result));
    untouched();
    CHECK(never == UNTOUCHED);
#define COUNTED leafless_octree_voxels(octree, NULL, NULL, &lattice, NULL, NULL, NULL, NULL, NULL, 0, &number)
    MAY_BE_NULL(leafless_octree_voxels, voxel_options, COUNTED);
    MAY_BE_NULL(leafless_octree_voxels, options, COUNTED);
    MAY_BE_NULL(leafless_octree_voxels, codes, COUNTED);
    MAY_BE_NULL(leafless_octree_voxels, levels, COUNTED);
    MAY_BE_NULL(leafless_octree_voxels, kinds, COUNTED);
    MAY_BE_NULL(leafless_octree_voxels, corners_model, COUNTED);
    MAY_BE_NULL(leafless_octree_voxels, values, COUNTED);
#define MOVED leafless_voxels_moved(&small, codes, levels, kinds, 2, turn, turn, NULL, NULL, NULL, NULL, NULL, 0, &number)
    MAY_BE_NULL(leafless_voxels_moved, options, MOVED);
    MAY_BE_NULL(leafless_voxels_moved, moved_codes, MOVED);
    MAY_BE_NULL(leafless_voxels_moved, moved_levels, MOVED);
    MAY_BE_NULL(leafless_voxels_moved, moved_kinds, MOVED);
    MAY_BE_NULL(leafless_voxels_moved, sources, MOVED);
#undef MOVED
    MAY_BE_NULL(leafless_voxels_order, options,
                leafless_voxels_order(&small, codes, levels, kinds, 2, direction, false, NULL, NULL, 0, &number));
    MAY_BE_NULL(leafless_voxels_order, order,
                leafless_voxels_order(&small, codes, levels, kinds, 2, direction, false, NULL, NULL, 0, &number));
    MAY_BE_NULL(leafless_voxels_triangles, options,
                leafless_voxels_triangles(&small, codes, levels, kinds, 2, cube, NULL, NULL, 0, &number, NULL, 0, &other));
    MAY_BE_NULL(leafless_voxels_triangles, offsets,
                leafless_voxels_triangles(&small, codes, levels, kinds, 2, cube, NULL, NULL, 0, &number, NULL, 0, &other));
    MAY_BE_NULL(leafless_voxels_triangles, triangles,
                leafless_voxels_triangles(&small, codes, levels, kinds, 2, cube, NULL, NULL, 0, &number, NULL, 0, &other));
    MAY_BE_NULL(leafless_octree_from_voxels, options,
                leafless_octree_from_voxels(&small, codes, levels, kinds, 2, LEAFLESS_TAG_FULL, NULL, &made));
    leafless_octree_free(made);
    leafless_mesh_free(cube);
}

static void columns(void) {
    void *out = fresh();
    void *never = UNTOUCHED;
    leafless_columns *columns = NULL, **result = (leafless_columns **)&never;
    const uint32_t first[3] = {0, 0, 0}, end[3] = {16, 16, 0}, far[2] = {16, 17};
    const uint32_t *wrong = (const uint32_t *)WRONG(end);
    uint64_t *count = (uint64_t *)out, *offsets = (uint64_t *)out, number, other;
    leafless_run *runs = (leafless_run *)out;
    leafless_interval *map = (leafless_interval *)out;

    OK(leafless_octree_columns(octree, 0, first, end, &columns));
    NULL_POINTER(leafless_octree_columns, octree, leafless_octree_columns(NULL, 0, first, end, result));
    NULL_POINTER(leafless_octree_columns, first, leafless_octree_columns(octree, 0, NULL, end, result));
    NULL_POINTER(leafless_octree_columns, end, leafless_octree_columns(octree, 0, first, NULL, result));
    NULL_POINTER(leafless_octree_columns, columns, leafless_octree_columns(octree, 0, first, end, NULL));
    NULL_POINTER(leafless_solid_columns, solid, leafless_solid_columns(NULL, &frame, 0, first, end, NULL, result));
    NULL_POINTER(leafless_solid_columns, frame, leafless_solid_columns(solid, NULL, 0, first, end, NULL, result));
    NULL_POINTER(leafless_solid_columns, first, leafless_solid_columns(solid, &frame, 0, NULL, end, NULL, result));
    NULL_POINTER(leafless_solid_columns, end, leafless_solid_columns(solid, &frame, 0, first, NULL, NULL, result));
    NULL_POINTER(leafless_solid_columns, columns, leafless_solid_columns(solid, &frame, 0, first, end, NULL, NULL));
    NULL_POINTER(leafless_columns_copy, columns, leafless_columns_copy(NULL, 0, NULL, 0, count, NULL, 0, count));
    NULL_POINTER(leafless_columns_copy, offsets, leafless_columns_copy(columns, 0, NULL, 1, count, NULL, 0, count));
    NULL_POINTER(leafless_columns_copy, offset_count,
                 leafless_columns_copy(columns, 0, NULL, 0, NULL, NULL, 0, count));
    NULL_POINTER(leafless_columns_copy, runs, leafless_columns_copy(columns, 0, NULL, 0, count, NULL, 1, count));
    NULL_POINTER(leafless_columns_copy, run_count, leafless_columns_copy(columns, 0, NULL, 0, count, NULL, 0, NULL));
    NULL_POINTER(leafless_octree_heights, octree, leafless_octree_heights(NULL, 0, first, end, 0, map, 16, count));
    NULL_POINTER(leafless_octree_heights, first, leafless_octree_heights(octree, 0, NULL, end, 0, map, 16, count));
    NULL_POINTER(leafless_octree_heights, end, leafless_octree_heights(octree, 0, first, NULL, 0, map, 16, count));
    NULL_POINTER(leafless_octree_heights, heights_model,
                 leafless_octree_heights(octree, 0, first, end, 0, NULL, 256, count));
    NULL_POINTER(leafless_octree_heights, count, leafless_octree_heights(octree, 0, first, end, 0, NULL, 0, NULL));
    NULL_POINTER(leafless_solid_heights, solid,
                 leafless_solid_heights(NULL, &frame, 0, first, end, 0, NULL, map, 16, count));
    NULL_POINTER(leafless_solid_heights, frame,
                 leafless_solid_heights(solid, NULL, 0, first, end, 0, NULL, map, 16, count));
    NULL_POINTER(leafless_solid_heights, first,
                 leafless_solid_heights(solid, &frame, 0, NULL, end, 0, NULL, map, 16, count));
    NULL_POINTER(leafless_solid_heights, end,
                 leafless_solid_heights(solid, &frame, 0, first, NULL, 0, NULL, map, 16, count));
    NULL_POINTER(leafless_solid_heights, heights_model,
                 leafless_solid_heights(solid, &frame, 0, first, end, 0, NULL, NULL, 256, count));
    NULL_POINTER(leafless_solid_heights, count,
                 leafless_solid_heights(solid, &frame, 0, first, end, 0, NULL, NULL, 0, NULL));

    MISALIGNED(leafless_octree_columns, first, leafless_octree_columns(octree, 0, wrong, end, result));
    MISALIGNED(leafless_octree_columns, end, leafless_octree_columns(octree, 0, first, wrong, result));
    MISALIGNED(leafless_octree_columns, columns,
               leafless_octree_columns(octree, 0, first, end, (leafless_columns **)WRONG(out)));
    MISALIGNED(leafless_solid_columns, end, leafless_solid_columns(solid, &frame, 0, first, wrong, NULL, result));
    MISALIGNED(leafless_columns_copy, columns,
               leafless_columns_copy((leafless_columns *)WRONG(columns), 0, NULL, 0, count, NULL, 0, count));
    MISALIGNED(leafless_columns_copy, offsets,
               leafless_columns_copy(columns, 0, (uint64_t *)WRONG(out), 1, count, NULL, 0, count));
    MISALIGNED(leafless_columns_copy, runs,
               leafless_columns_copy(columns, 0, NULL, 0, count, (leafless_run *)WRONG(out), 1, count));
    MISALIGNED(leafless_octree_heights, heights_model,
               leafless_octree_heights(octree, 0, first, end, 0, (leafless_interval *)WRONG(out), 256, count));
    MISALIGNED(leafless_solid_heights, count,
               leafless_solid_heights(solid, &frame, 0, first, end, 0, NULL, NULL, 0, (uint64_t *)WRONG(out)));

    BAD_NUMBER(leafless_octree_columns, axis, leafless_octree_columns(octree, 3, first, end, result));
    BAD_NUMBER(leafless_octree_columns, axis, leafless_octree_columns(octree, UINT32_MAX, NULL, NULL, result));
    BAD_NUMBER(leafless_octree_columns, columns, leafless_octree_columns(octree, 0, first, far, result));
    BAD_NUMBER(leafless_octree_columns, end, leafless_octree_columns(octree, 0, end, first, result));
    BAD_NUMBER(leafless_solid_columns, columns, leafless_solid_columns(solid, &frame, 1, first, far, NULL, result));
    BAD_NUMBER(leafless_columns_copy, on, leafless_columns_copy(columns, 2, NULL, 0, count, NULL, 0, count));
    BAD_NUMBER(leafless_columns_copy, runs, leafless_columns_copy(columns, 0, NULL, 0, count, runs, UINT64_MAX, count));
    BAD_NUMBER(leafless_columns_copy, offsets,
               leafless_columns_copy(columns, 0, offsets, UINT64_MAX, count, NULL, 0, count));
    BAD_NUMBER(leafless_octree_heights, side, leafless_octree_heights(octree, 0, first, end, 2, map, 256, count));
    BAD_NUMBER(leafless_solid_heights, side,
               leafless_solid_heights(solid, &frame, 0, first, end, 2, NULL, map, 256, count));
    BAD_NUMBER(leafless_solid_heights, columns,
               leafless_solid_heights(solid, &frame, 0, first, far, 0, NULL, map, 272, count));
    untouched();
    CHECK(never == UNTOUCHED);

    MAY_BE_NULL(leafless_columns_copy, offsets, leafless_columns_copy(columns, 0, NULL, 0, &number, NULL, 0, &other));
    MAY_BE_NULL(leafless_columns_copy, runs, leafless_columns_copy(columns, 0, NULL, 0, &number, NULL, 0, &other));
    CHECK(number == 257 && other > 0);
    MAY_BE_NULL(leafless_octree_heights, heights_model,
                leafless_octree_heights(octree, 0, NULL, NULL, 1, NULL, 0, &number));
    MAY_BE_NULL(leafless_octree_heights, first, leafless_octree_heights(octree, 0, NULL, NULL, 1, NULL, 0, &number));
    MAY_BE_NULL(leafless_octree_heights, end, leafless_octree_heights(octree, 0, NULL, NULL, 1, NULL, 0, &number));
    MAY_BE_NULL(leafless_solid_heights, heights_model,
                leafless_solid_heights(solid, &frame, 0, NULL, NULL, 1, NULL, NULL, 0, &number));
    MAY_BE_NULL(leafless_solid_heights, options,
                leafless_solid_heights(solid, &frame, 0, NULL, NULL, 1, NULL, NULL, 0, &number));
    CHECK(number == 256);
    leafless_columns_free(columns);
    columns = NULL;
    MAY_BE_NULL(leafless_solid_columns, options,
                leafless_solid_columns(solid, &frame, 0, first, end, NULL, &columns));
    leafless_columns_free(columns);
    leafless_columns_free(NULL);
}

static void regions(void) {
    void *out = fresh();
    const double padded[4] = {0, 0, 0, 0};
    const double *wrong = (const double *)WRONG(padded);
    const uint32_t cell[4] = {0, 0, 0, 0}, end[3] = {1, 1, 1}, beyond[3] = {17, 1, 1};
    const uint32_t *wrong_cell = (const uint32_t *)WRONG(cell);
    leafless_interval *volume = (leafless_interval *)out;
    leafless_region *relation = (leafless_region *)out;
    leafless_region itself;
    leafless_cells_in *counts = (leafless_cells_in *)out, some;
    leafless_interval range;
    uint64_t *least = (uint64_t *)out;

    NULL_POINTER(leafless_octree_cells_in_box, octree, leafless_octree_cells_in_box(NULL, cell, end, least, least));
    NULL_POINTER(leafless_octree_cells_in_box, min_cell, leafless_octree_cells_in_box(octree, NULL, end, least, least));
    NULL_POINTER(leafless_octree_cells_in_box, max_cell, leafless_octree_cells_in_box(octree, cell, NULL, least, least));
    NULL_POINTER(leafless_octree_cells_in_box, least, leafless_octree_cells_in_box(octree, cell, end, NULL, least));
    NULL_POINTER(leafless_octree_cells_in_box, most, leafless_octree_cells_in_box(octree, cell, end, least, NULL));
    NULL_POINTER(leafless_octree_volume_in_box, octree, leafless_octree_volume_in_box(NULL, point, above, volume));
    NULL_POINTER(leafless_octree_volume_in_box, min_model, leafless_octree_volume_in_box(octree, NULL, above, volume));
    NULL_POINTER(leafless_octree_volume_in_box, max_model, leafless_octree_volume_in_box(octree, point, NULL, volume));
    NULL_POINTER(leafless_octree_volume_in_box, volume_model, leafless_octree_volume_in_box(octree, point, above, NULL));
    NULL_POINTER(leafless_solid_classify_in, solid, leafless_solid_classify_in(NULL, solid, &frame, NULL, relation));
    NULL_POINTER(leafless_solid_classify_in, region, leafless_solid_classify_in(solid, NULL, &frame, NULL, relation));
    NULL_POINTER(leafless_solid_classify_in, frame, leafless_solid_classify_in(solid, solid, NULL, NULL, relation));
    NULL_POINTER(leafless_solid_classify_in, relation, leafless_solid_classify_in(solid, solid, &frame, NULL, NULL));
    NULL_POINTER(leafless_octree_cells_in, octree, leafless_octree_cells_in(NULL, solid, NULL, counts));
    NULL_POINTER(leafless_octree_cells_in, region, leafless_octree_cells_in(octree, NULL, NULL, counts));
    NULL_POINTER(leafless_octree_cells_in, cells, leafless_octree_cells_in(octree, solid, NULL, NULL));
    NULL_POINTER(leafless_octree_volume_in, octree, leafless_octree_volume_in(NULL, solid, NULL, volume));
    NULL_POINTER(leafless_octree_volume_in, region, leafless_octree_volume_in(octree, NULL, NULL, volume));
    NULL_POINTER(leafless_octree_volume_in, volume_model, leafless_octree_volume_in(octree, solid, NULL, NULL));
    NULL_POINTER(leafless_solid_cells_in, solid, leafless_solid_cells_in(NULL, solid, &frame, NULL, counts));
    NULL_POINTER(leafless_solid_cells_in, region, leafless_solid_cells_in(solid, NULL, &frame, NULL, counts));
    NULL_POINTER(leafless_solid_cells_in, frame, leafless_solid_cells_in(solid, solid, NULL, NULL, counts));
    NULL_POINTER(leafless_solid_cells_in, cells, leafless_solid_cells_in(solid, solid, &frame, NULL, NULL));
    NULL_POINTER(leafless_solid_volume_in, solid, leafless_solid_volume_in(NULL, solid, &frame, NULL, volume));
    NULL_POINTER(leafless_solid_volume_in, region, leafless_solid_volume_in(solid, NULL, &frame, NULL, volume));
    NULL_POINTER(leafless_solid_volume_in, frame, leafless_solid_volume_in(solid, solid, NULL, NULL, volume));
    NULL_POINTER(leafless_solid_volume_in, volume_model, leafless_solid_volume_in(solid, solid, &frame, NULL, NULL));

    MISALIGNED(leafless_octree_cells_in, cells,
               leafless_octree_cells_in(octree, solid, NULL, (leafless_cells_in *)WRONG(out)));
    MISALIGNED(leafless_octree_volume_in, volume_model,
               leafless_octree_volume_in(octree, solid, NULL, (leafless_interval *)WRONG(out)));
    MISALIGNED(leafless_solid_cells_in, cells,
               leafless_solid_cells_in(solid, solid, &frame, NULL, (leafless_cells_in *)WRONG(out)));
    MISALIGNED(leafless_solid_volume_in, volume_model,
               leafless_solid_volume_in(solid, solid, &frame, NULL, (leafless_interval *)WRONG(out)));
    MISALIGNED(leafless_octree_cells_in_box, min_cell,
               leafless_octree_cells_in_box(octree, wrong_cell, end, least, least));
    MISALIGNED(leafless_octree_cells_in_box, max_cell,
               leafless_octree_cells_in_box(octree, cell, wrong_cell, least, least));
    MISALIGNED(leafless_octree_cells_in_box, least,
               leafless_octree_cells_in_box(octree, cell, end, (uint64_t *)WRONG(out), least));
    MISALIGNED(leafless_octree_cells_in_box, most,
               leafless_octree_cells_in_box(octree, cell, end, least, (uint64_t *)WRONG(out)));
    MISALIGNED(leafless_octree_volume_in_box, min_model, leafless_octree_volume_in_box(octree, wrong, above, volume));
    MISALIGNED(leafless_octree_volume_in_box, max_model, leafless_octree_volume_in_box(octree, point, wrong, volume));
    MISALIGNED(leafless_octree_volume_in_box, volume_model,
               leafless_octree_volume_in_box(octree, point, above, (leafless_interval *)WRONG(out)));

    BAD_NUMBER(leafless_octree_cells_in_box, max, leafless_octree_cells_in_box(octree, cell, beyond, least, least));
    BAD_NUMBER(leafless_octree_volume_in_box, max, leafless_octree_volume_in_box(octree, above, point, volume));
    untouched();

    MAY_BE_NULL(leafless_solid_classify_in, options,
                leafless_solid_classify_in(solid, solid, &frame, NULL, &itself));
    CHECK(itself != LEAFLESS_REGION_OUTSIDE);
    MAY_BE_NULL(leafless_octree_cells_in, options, leafless_octree_cells_in(octree, solid, NULL, &some));
    MAY_BE_NULL(leafless_octree_volume_in, options, leafless_octree_volume_in(octree, solid, NULL, &range));
    MAY_BE_NULL(leafless_solid_cells_in, options, leafless_solid_cells_in(solid, solid, &frame, NULL, &some));
    CHECK(some.full_least > 0 && some.full_least <= some.upper_most);
    MAY_BE_NULL(leafless_solid_volume_in, options, leafless_solid_volume_in(solid, solid, &frame, NULL, &range));
    CHECK(range.lower > 0 && range.lower <= range.upper);
}

static void distances(void) {
    void *out = fresh();
    const double padded[4] = {0, 0, 0, 0};
    const double *wrong = (const double *)WRONG(padded);
    const uint32_t cell[4] = {0, 0, 0, 0}, end[3] = {1, 1, 1}, beyond[3] = {17, 1, 1};
    const uint32_t *wrong_cell = (const uint32_t *)WRONG(cell);
    leafless_interval *intervals = (leafless_interval *)out;
    leafless_point_distance *found = (leafless_point_distance *)out;
    leafless_near_cell *cells = (leafless_near_cell *)out;
    float *field = (float *)out, pair[2];
    leafless_interval one;
    leafless_point_distance far;
    uint64_t number;

    NULL_POINTER(leafless_octree_distances, octree, leafless_octree_distances(NULL, point, 1, 0, NULL, intervals));
    NULL_POINTER(leafless_octree_distances, points_model, leafless_octree_distances(octree, NULL, 1, 0, NULL, intervals));
    NULL_POINTER(leafless_octree_distances, distances_model, leafless_octree_distances(octree, point, 1, 0, NULL, NULL));
    NULL_POINTER(leafless_solid_distances, solid, leafless_solid_distances(NULL, &frame, point, 1, 0, 0.0, NULL, found));
    NULL_POINTER(leafless_solid_distances, frame, leafless_solid_distances(solid, NULL, point, 1, 0, 0.0, NULL, found));
    NULL_POINTER(leafless_solid_distances, points_model,
                 leafless_solid_distances(solid, &frame, NULL, 1, 0, 0.0, NULL, found));
    NULL_POINTER(leafless_solid_distances, distances, leafless_solid_distances(solid, &frame, point, 1, 0, 0.0, NULL, NULL));
    NULL_POINTER(leafless_octree_nearest_cells, octree,
                 leafless_octree_nearest_cells(NULL, point, 8, cells, 1, (uint64_t *)out));
    NULL_POINTER(leafless_octree_nearest_cells, point_model,
                 leafless_octree_nearest_cells(octree, NULL, 8, cells, 1, (uint64_t *)out));
    NULL_POINTER(leafless_octree_nearest_cells, cells,
                 leafless_octree_nearest_cells(octree, point, 8, NULL, 1, (uint64_t *)out));
    NULL_POINTER(leafless_octree_nearest_cells, count, leafless_octree_nearest_cells(octree, point, 8, cells, 1, NULL));
    NULL_POINTER(leafless_octree_distance_field, octree, leafless_octree_distance_field(NULL, cell, end, NULL, field, 2));
    NULL_POINTER(leafless_octree_distance_field, min_cell,
                 leafless_octree_distance_field(octree, NULL, end, NULL, field, 2));
    NULL_POINTER(leafless_octree_distance_field, max_cell,
                 leafless_octree_distance_field(octree, cell, NULL, NULL, field, 2));
    NULL_POINTER(leafless_octree_distance_field, field, leafless_octree_distance_field(octree, cell, end, NULL, NULL, 2));

    MISALIGNED(leafless_octree_distances, points_model, leafless_octree_distances(octree, wrong, 1, 0, NULL, intervals));
    MISALIGNED(leafless_octree_distances, distances_model,
               leafless_octree_distances(octree, point, 1, 0, NULL, (leafless_interval *)WRONG(out)));
    MISALIGNED(leafless_solid_distances, points_model,
               leafless_solid_distances(solid, &frame, wrong, 1, 0, 0.0, NULL, found));
    MISALIGNED(leafless_solid_distances, distances,
               leafless_solid_distances(solid, &frame, point, 1, 0, 0.0, NULL, (leafless_point_distance *)WRONG(out)));
    MISALIGNED(leafless_octree_nearest_cells, point_model,
               leafless_octree_nearest_cells(octree, wrong, 8, cells, 1, (uint64_t *)out));
    MISALIGNED(leafless_octree_nearest_cells, cells,
               leafless_octree_nearest_cells(octree, point, 8, (leafless_near_cell *)WRONG(out), 1, (uint64_t *)out));
    MISALIGNED(leafless_octree_nearest_cells, count,
               leafless_octree_nearest_cells(octree, point, 8, cells, 1, (uint64_t *)WRONG(out)));
    MISALIGNED(leafless_octree_distance_field, min_cell,
               leafless_octree_distance_field(octree, wrong_cell, end, NULL, field, 2));
    MISALIGNED(leafless_octree_distance_field, max_cell,
               leafless_octree_distance_field(octree, cell, wrong_cell, NULL, field, 2));
    MISALIGNED(leafless_octree_distance_field, field,
               leafless_octree_distance_field(octree, cell, end, NULL, (float *)WRONG(out), 2));

    BAD_NUMBER(leafless_octree_distances, to, leafless_octree_distances(octree, point, 1, 3, NULL, intervals));
    BAD_NUMBER(leafless_solid_distances, to, leafless_solid_distances(solid, &frame, point, 1, 3, 0.0, NULL, found));
    BAD_NUMBER(leafless_solid_distances, tolerance,
               leafless_solid_distances(solid, &frame, point, 1, 0, -1.0, NULL, found));
    BAD_NUMBER(leafless_octree_nearest_cells, tags,
               leafless_octree_nearest_cells(octree, point, 0, cells, 1, (uint64_t *)out));
    BAD_NUMBER(leafless_octree_distance_field, max, leafless_octree_distance_field(octree, cell, beyond, NULL, NULL, 0));
    BAD_NUMBER(leafless_octree_distance_field, capacity,
               leafless_octree_distance_field(octree, cell, end, NULL, field, 3));
    untouched();

    MAY_BE_NULL(leafless_octree_distances, options, leafless_octree_distances(octree, point, 1, 0, NULL, &one));
    MAY_BE_NULL(leafless_solid_distances, options,
                leafless_solid_distances(solid, &frame, point, 1, 0, 1.0, NULL, &far));
    MAY_BE_NULL(leafless_octree_distance_field, options,
                leafless_octree_distance_field(octree, cell, end, NULL, pair, 2));
    CHECK(one.lower == 0.0 && far.distance_model.lower == 0.0 && pair[0] <= pair[1]);
    MAY_BE_NULL(leafless_octree_distances, points_model, leafless_octree_distances(octree, NULL, 0, 0, NULL, NULL));
    MAY_BE_NULL(leafless_solid_distances, points_model,
                leafless_solid_distances(solid, &frame, NULL, 0, 0, 0.0, NULL, NULL));
    MAY_BE_NULL(leafless_octree_nearest_cells, cells, leafless_octree_nearest_cells(octree, point, 8, NULL, 0, &number));
    MAY_BE_NULL(leafless_octree_distance_field, field, leafless_octree_distance_field(octree, cell, cell, NULL, NULL, 0));
}

static int32_t number_at(void *ctx, const double *at, double *number) {
    (void)ctx;
    *number = at[0];
    return 0;
}

/* A channel of three numbers. */
static void summaries(const leafless_channel *channel) {
    void *out = fresh(), *never = UNTOUCHED;
    leafless_attribute **made = (leafless_attribute **)&never, *attribute = NULL;
    leafless_octree **result = (leafless_octree **)&never, *region = NULL;
    leafless_channel_summary *summary = (leafless_channel_summary *)out;
    leafless_channel_summary found = LEAFLESS_INIT(leafless_channel_summary);
    leafless_material *materials = (leafless_material *)out, all[4];
    leafless_volume_layout layout;
    leafless_volume *volume = NULL;
    const uint8_t samples[8] = {0};
    const double low[3] = {0, 0, 0}, high[3] = {9, 9, 9}, bad[3] = {0, NAN, 0};
    uint64_t *count = (uint64_t *)out, number;

    OK(leafless_init(&layout, sizeof layout));
    layout.extents[0] = layout.extents[1] = layout.extents[2] = 2;
    OK(volume_of_array(&layout, samples, sizeof samples, &volume));
    NULL_POINTER(leafless_channel_summarise, channel, leafless_channel_summarise(NULL, octree, point, above, NULL, summary));
    NULL_POINTER(leafless_channel_summarise, min_model,
                 leafless_channel_summarise(channel, octree, NULL, above, NULL, summary));
    NULL_POINTER(leafless_channel_summarise, max_model,
                 leafless_channel_summarise(channel, octree, point, NULL, NULL, summary));
    NULL_POINTER(leafless_channel_summarise, summary, leafless_channel_summarise(channel, octree, point, above, NULL, NULL));
    BAD_NUMBER(leafless_channel_summarise, min, leafless_channel_summarise(channel, octree, above, point, NULL, summary));
    NULL_POINTER(leafless_channel_region, channel, leafless_channel_region(NULL, low, high, NULL, result));
    NULL_POINTER(leafless_channel_region, low, leafless_channel_region(channel, NULL, high, NULL, result));
    NULL_POINTER(leafless_channel_region, high, leafless_channel_region(channel, low, NULL, NULL, result));
    NULL_POINTER(leafless_channel_region, octree, leafless_channel_region(channel, low, high, NULL, NULL));
    BAD_NUMBER(leafless_channel_region, band, leafless_channel_region(channel, bad, high, NULL, result));
    NULL_POINTER(leafless_solid_materials, solid,
                 leafless_solid_materials(NULL, channel, &frame, 1, 0, NULL, materials, 1, count));
    NULL_POINTER(leafless_solid_materials, channel,
                 leafless_solid_materials(solid, NULL, &frame, 1, 0, NULL, materials, 1, count));
    NULL_POINTER(leafless_solid_materials, frame,
                 leafless_solid_materials(solid, channel, NULL, 1, 0, NULL, materials, 1, count));
    NULL_POINTER(leafless_solid_materials, measured,
                 leafless_solid_materials(solid, channel, &frame, 1, 0, NULL, NULL, 1, count));
    NULL_POINTER(leafless_solid_materials, count,
                 leafless_solid_materials(solid, channel, &frame, 1, 0, NULL, materials, 0, NULL));
    BAD_NUMBER(leafless_solid_materials, tolerance,
               leafless_solid_materials(solid, channel, &frame, -1, 0, NULL, NULL, 0, count));
    NULL_POINTER(leafless_attribute_from_volume, volume, leafless_attribute_from_volume(NULL, 0, NULL, made));
    NULL_POINTER(leafless_attribute_from_volume, attribute, leafless_attribute_from_volume(volume, 0, NULL, NULL));
    BAD_NUMBER(leafless_attribute_from_volume, interpolation, leafless_attribute_from_volume(volume, 2, NULL, made));
    MISALIGNED(leafless_channel_summarise, summary,
               leafless_channel_summarise(channel, octree, NULL, NULL, NULL, (leafless_channel_summary *)WRONG(out)));
    MISALIGNED(leafless_channel_region, low,
               leafless_channel_region(channel, (const double *)WRONG(low), high, NULL, result));
    untouched();
    CHECK(never == UNTOUCHED);

    MAY_BE_NULL(leafless_channel_summarise, solid, leafless_channel_summarise(channel, NULL, low, high, NULL, &found));
    MAY_BE_NULL(leafless_channel_summarise, options, leafless_channel_summarise(channel, NULL, NULL, NULL, NULL, &found));
    MAY_BE_NULL(leafless_channel_region, options, leafless_channel_region(channel, low, high, NULL, &region));
    MAY_BE_NULL(leafless_solid_materials, options,
                leafless_solid_materials(solid, channel, &frame, 1, 0, NULL, all, 4, &number));
    CHECK(number == 1);
    MAY_BE_NULL(leafless_attribute_from_volume, options, leafless_attribute_from_volume(volume, 0, NULL, &attribute));
    leafless_attribute_free(attribute);
    leafless_octree_free(region);
    leafless_volume_free(volume);
}

static void attributes_and_channels(void) {
    void *out = fresh(), *never = UNTOUCHED;
    leafless_attribute **made = (leafless_attribute **)&never, *attribute = NULL;
    leafless_channel **channel_result = (leafless_channel **)&never, *channel = NULL, *other = NULL;
    leafless_octree **result = (leafless_octree **)&never, *bearing = NULL, *bare = NULL;
    const leafless_octree *operands[2];
    const double matrix[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, flat[12] = {0};
    const double one[4] = {1, 2, 3, 4}, bad[2] = {1, NAN};
    const uint32_t cell[4] = {0, 0, 0, 0};
    const char **text = (const char **)out;
    size_t *text_length = (size_t *)out + 1;
    double *values = (double *)out;
    uint64_t *count = (uint64_t *)out;
    leafless_value_range *range = (leafless_value_range *)out;
    leafless_channel_info *info = (leafless_channel_info *)out;
    leafless_attribute_callbacks callbacks;
    leafless_channel_fill_options fill;
    leafless_carry_rule rules[2] = {{"a", 1, 0}, {"b", 1, 0}};

    OK(leafless_init(&callbacks, sizeof callbacks));
    OK(leafless_init(&fill, sizeof fill));
    callbacks.components = 1;
    NULL_POINTER(leafless_attribute_new_callbacks, callbacks, leafless_attribute_new_callbacks(NULL, made));
    refused(LEAFLESS_E_NULL, "leafless_attribute_new_callbacks", "callbacks.value",
            leafless_attribute_new_callbacks(&callbacks, made));
    callbacks.value = number_at;
    NULL_POINTER(leafless_attribute_new_callbacks, attribute, leafless_attribute_new_callbacks(&callbacks, NULL));
    callbacks.components = 0;
    BAD_NUMBER(leafless_attribute_new_callbacks, callbacks.components, leafless_attribute_new_callbacks(&callbacks, made));
    callbacks.components = 5;
    BAD_NUMBER(leafless_attribute_new_callbacks, callbacks.components, leafless_attribute_new_callbacks(&callbacks, made));
    NULL_POINTER(leafless_attribute_new_constant, value, leafless_attribute_new_constant(NULL, 1, made));
    NULL_POINTER(leafless_attribute_new_constant, attribute, leafless_attribute_new_constant(one, 1, NULL));
    BAD_NUMBER(leafless_attribute_new_constant, components, leafless_attribute_new_constant(one, 0, made));
    BAD_NUMBER(leafless_attribute_new_constant, components, leafless_attribute_new_constant(one, 5, made));
    BAD_NUMBER(leafless_attribute_new_constant, value, leafless_attribute_new_constant(bad, 2, made));
    OK(leafless_attribute_new_constant(one, 3, &attribute));
    NULL_POINTER(leafless_attribute_placed, operand, leafless_attribute_placed(NULL, matrix, made));
    NULL_POINTER(leafless_attribute_placed, matrix, leafless_attribute_placed(attribute, NULL, made));
    NULL_POINTER(leafless_attribute_placed, attribute, leafless_attribute_placed(attribute, matrix, NULL));
    BAD_NUMBER(leafless_attribute_placed, singular, leafless_attribute_placed(attribute, flat, made));
    NULL_POINTER(leafless_attribute_describe, attribute,
                 leafless_attribute_describe(NULL, (leafless_attribute_info *)out));
    NULL_POINTER(leafless_attribute_describe, info, leafless_attribute_describe(attribute, NULL));
    NULL_POINTER(leafless_attribute_values, attribute, leafless_attribute_values(NULL, point, 1, values));
    NULL_POINTER(leafless_attribute_values, points_model, leafless_attribute_values(attribute, NULL, 1, values));
    NULL_POINTER(leafless_attribute_values, values, leafless_attribute_values(attribute, point, 1, NULL));
    MAY_BE_NULL(leafless_attribute_values, values, leafless_attribute_values(attribute, NULL, 0, NULL));
    NULL_POINTER(leafless_attribute_range, attribute, leafless_attribute_range(NULL, point, above, range));
    NULL_POINTER(leafless_attribute_range, min_model, leafless_attribute_range(attribute, NULL, above, range));
    NULL_POINTER(leafless_attribute_range, max_model, leafless_attribute_range(attribute, point, NULL, range));
    NULL_POINTER(leafless_attribute_range, range, leafless_attribute_range(attribute, point, above, NULL));
    BAD_NUMBER(leafless_attribute_range, max_model, leafless_attribute_range(attribute, above, point, range));
    NULL_POINTER(leafless_attribute_ref, attribute, leafless_attribute_ref(NULL, made));
    NULL_POINTER(leafless_attribute_ref, reference, leafless_attribute_ref(attribute, NULL));

    NULL_POINTER(leafless_channel_fill, attribute, leafless_channel_fill(NULL, &frame, &fill, NULL, channel_result));
    NULL_POINTER(leafless_channel_fill, frame, leafless_channel_fill(attribute, NULL, &fill, NULL, channel_result));
    NULL_POINTER(leafless_channel_fill, channel, leafless_channel_fill(attribute, &frame, &fill, NULL, NULL));
    fill.name_length = 1;
    NULL_POINTER(leafless_channel_fill, fill.name, leafless_channel_fill(attribute, &frame, &fill, NULL, channel_result));
    fill.name_length = 0;
#define FILL(field, wrong)                                                                                           \
    fill.field = wrong;                                                                                              \
    BAD_NUMBER(leafless_channel_fill, field, leafless_channel_fill(attribute, &frame, &fill, NULL, channel_result)); \
    fill.field = 0
    FILL(scalar, 4);
    FILL(components, 2);
    FILL(components, 5);
    FILL(depth, 21);
    FILL(depth, UINT32_MAX);
    FILL(reserved, 1);
    FILL(criterion, 3);
    fill.tolerance = 1;
    BAD_NUMBER(leafless_channel_fill, criterion, leafless_channel_fill(attribute, &frame, &fill, NULL, channel_result));
    fill.tolerance = 0;
    fill.criterion = LEAFLESS_CRITERION_RANGE;
    FILL(tolerance, -1);
    FILL(tolerance, NAN);
    fill.coarse_model = 0.5;
    BAD_NUMBER(leafless_channel_fill, fine, (fill.fine_model = 1, leafless_channel_fill(attribute, &frame, &fill, NULL,
                                                                                       channel_result)));
    OK(leafless_init(&fill, sizeof fill));
#undef FILL
    MAY_BE_NULL(leafless_channel_fill, fill, leafless_channel_fill(attribute, &frame, NULL, NULL, &other));
    leafless_channel_free(other);
    other = NULL;
    MAY_BE_NULL(leafless_channel_fill, options, leafless_channel_fill(attribute, &frame, &fill, NULL, &channel));
    NULL_POINTER(leafless_channel_ref, channel, leafless_channel_ref(NULL, channel_result));
    NULL_POINTER(leafless_channel_ref, reference, leafless_channel_ref(channel, NULL));
    NULL_POINTER(leafless_channel_describe, channel, leafless_channel_describe(NULL, info));
    NULL_POINTER(leafless_channel_describe, info, leafless_channel_describe(channel, NULL));
    NULL_POINTER(leafless_channel_check, channel, leafless_channel_check(NULL));
    NULL_POINTER(leafless_channel_equal, a, leafless_channel_equal(NULL, channel, (bool *)out));
    NULL_POINTER(leafless_channel_equal, b, leafless_channel_equal(channel, NULL, (bool *)out));
    NULL_POINTER(leafless_channel_equal, equal, leafless_channel_equal(channel, channel, NULL));
    NULL_POINTER(leafless_attribute_from_channel, channel, leafless_attribute_from_channel(NULL, made));
    NULL_POINTER(leafless_attribute_from_channel, attribute, leafless_attribute_from_channel(channel, NULL));
    NULL_POINTER(leafless_channel_with_metadata, channel,
                 leafless_channel_with_metadata(NULL, "k", 1, "v", 1, channel_result));
    NULL_POINTER(leafless_channel_with_metadata, key,
                 leafless_channel_with_metadata(channel, NULL, 1, "v", 1, channel_result));
    NULL_POINTER(leafless_channel_with_metadata, value,
                 leafless_channel_with_metadata(channel, "k", 1, NULL, 1, channel_result));
    NULL_POINTER(leafless_channel_with_metadata, named, leafless_channel_with_metadata(channel, "k", 1, "v", 1, NULL));
    NULL_POINTER(leafless_channel_without_metadata, channel,
                 leafless_channel_without_metadata(NULL, "k", 1, channel_result));
    MAY_BE_NULL(leafless_channel_without_metadata, key, leafless_channel_without_metadata(channel, NULL, 0, &other));
    leafless_channel_free(other);
    NULL_POINTER(leafless_channel_without_metadata, unnamed, leafless_channel_without_metadata(channel, "k", 1, NULL));
    NULL_POINTER(leafless_channel_peek_metadata, channel,
                 leafless_channel_peek_metadata(NULL, "k", 1, text, text_length));
    NULL_POINTER(leafless_channel_peek_metadata, key,
                 leafless_channel_peek_metadata(channel, NULL, 1, text, text_length));
    NULL_POINTER(leafless_channel_peek_metadata, value,
                 leafless_channel_peek_metadata(channel, "k", 1, NULL, text_length));
    NULL_POINTER(leafless_channel_peek_metadata, value_length,
                 leafless_channel_peek_metadata(channel, "k", 1, text, NULL));
    NULL_POINTER(leafless_channel_peek_metadata_at, channel,
                 leafless_channel_peek_metadata_at(NULL, 0, count, NULL, NULL, NULL, NULL));
    NULL_POINTER(leafless_channel_peek_metadata_at, count,
                 leafless_channel_peek_metadata_at(channel, 0, NULL, NULL, NULL, NULL, NULL));
    NULL_POINTER(leafless_channel_peek_metadata_at, key,
                 leafless_channel_peek_metadata_at(channel, 0, count, NULL, text_length, text, text_length));
    NULL_POINTER(leafless_channel_peek_metadata_at, key_length,
                 leafless_channel_peek_metadata_at(channel, 0, count, text, NULL, text, text_length));
    NULL_POINTER(leafless_channel_peek_metadata_at, value,
                 leafless_channel_peek_metadata_at(channel, 0, count, text, text_length, NULL, text_length));
    NULL_POINTER(leafless_channel_peek_metadata_at, value_length,
                 leafless_channel_peek_metadata_at(channel, 0, count, text, text_length, text, NULL));
    BAD_NUMBER(leafless_channel_peek_metadata_at, index,
               leafless_channel_peek_metadata_at(channel, 0, count, text, text_length, text, text_length));
    NULL_POINTER(leafless_channel_values, channel, leafless_channel_values(NULL, point, 1, values));
    NULL_POINTER(leafless_channel_values, points_model, leafless_channel_values(channel, NULL, 1, values));
    NULL_POINTER(leafless_channel_values, values, leafless_channel_values(channel, point, 1, NULL));
    MAY_BE_NULL(leafless_channel_values, values, leafless_channel_values(channel, NULL, 0, NULL));
    NULL_POINTER(leafless_channel_value, channel, leafless_channel_value(NULL, point, values));
    NULL_POINTER(leafless_channel_value, point_model, leafless_channel_value(channel, NULL, values));
    NULL_POINTER(leafless_channel_value, value, leafless_channel_value(channel, point, NULL));
    NULL_POINTER(leafless_channel_value_at, channel, leafless_channel_value_at(NULL, cell, values));
    NULL_POINTER(leafless_channel_value_at, cell, leafless_channel_value_at(channel, NULL, values));
    NULL_POINTER(leafless_channel_value_at, value, leafless_channel_value_at(channel, cell, NULL));
    NULL_POINTER(leafless_channel_with_value_in, channel,
                 leafless_channel_with_value_in(NULL, octree, one, NULL, channel_result));
    NULL_POINTER(leafless_channel_with_value_in, region,
                 leafless_channel_with_value_in(channel, NULL, one, NULL, channel_result));
    NULL_POINTER(leafless_channel_with_value_in, changed,
                 leafless_channel_with_value_in(channel, octree, one, NULL, NULL));
    other = NULL;
    MAY_BE_NULL(leafless_channel_with_value_in, value,
                leafless_channel_with_value_in(channel, octree, NULL, NULL, &other));
    leafless_channel_free(other);
    other = NULL;
    MAY_BE_NULL(leafless_channel_with_value_in, options,
                leafless_channel_with_value_in(channel, octree, one, NULL, &other));
    leafless_channel_free(other);

    NULL_POINTER(leafless_octree_with_channel, octree, leafless_octree_with_channel(NULL, channel, result));
    NULL_POINTER(leafless_octree_with_channel, channel, leafless_octree_with_channel(octree, NULL, result));
    NULL_POINTER(leafless_octree_with_channel, result, leafless_octree_with_channel(octree, channel, NULL));
    OK(leafless_octree_with_channel(octree, channel, &bearing));
    NULL_POINTER(leafless_octree_without_channel, octree, leafless_octree_without_channel(NULL, "a", 1, result));
    NULL_POINTER(leafless_octree_without_channel, result, leafless_octree_without_channel(bearing, "a", 1, NULL));
    MAY_BE_NULL(leafless_octree_without_channel, name, leafless_octree_without_channel(bearing, NULL, 0, &bare));
    CHECK(check_channels(bare) == 0);
    NULL_POINTER(leafless_octree_channel_at, octree, leafless_octree_channel_at(NULL, 0, channel_result));
    NULL_POINTER(leafless_octree_channel_at, channel, leafless_octree_channel_at(bearing, 0, NULL));
    BAD_NUMBER(leafless_octree_channel_at, index, leafless_octree_channel_at(bearing, 1, channel_result));
    BAD_NUMBER(leafless_octree_channel_at, index, leafless_octree_channel_at(bearing, UINT64_MAX, channel_result));
    NULL_POINTER(leafless_octree_channel, octree, leafless_octree_channel(NULL, "a", 1, channel_result));
    NULL_POINTER(leafless_octree_channel, name, leafless_octree_channel(bearing, NULL, 1, channel_result));
    NULL_POINTER(leafless_octree_channel, channel, leafless_octree_channel(bearing, "a", 1, NULL));
    operands[0] = operands[1] = bearing;
    NULL_POINTER(leafless_octree_carry_channels, octree,
                 leafless_octree_carry_channels(NULL, operands, 2, 0, rules, 2, NULL, result));
    NULL_POINTER(leafless_octree_carry_channels, operands,
                 leafless_octree_carry_channels(octree, NULL, 2, 0, rules, 2, NULL, result));
    NULL_POINTER(leafless_octree_carry_channels, rules,
                 leafless_octree_carry_channels(octree, operands, 2, 0, NULL, 2, NULL, result));
    NULL_POINTER(leafless_octree_carry_channels, result,
                 leafless_octree_carry_channels(octree, operands, 2, 0, rules, 2, NULL, NULL));
    operands[1] = NULL;
    NULL_POINTER(leafless_octree_carry_channels, operands,
                 leafless_octree_carry_channels(octree, operands, 2, 0, rules, 2, NULL, result));
    BAD_NUMBER(leafless_octree_carry_channels, carry,
               leafless_octree_carry_channels(octree, operands, 1, 4, rules, 2, NULL, result));
    rules[1].carry = 4;
    BAD_NUMBER(leafless_octree_carry_channels, rules.carry,
               leafless_octree_carry_channels(octree, operands, 1, 0, rules, 2, NULL, result));
    rules[0].name = NULL;
    NULL_POINTER(leafless_octree_carry_channels, rules.name,
                 leafless_octree_carry_channels(octree, operands, 1, 0, rules, 2, NULL, result));

    MISALIGNED(leafless_attribute_new_constant, value,
               leafless_attribute_new_constant((const double *)WRONG(one), 1, made));
    MISALIGNED(leafless_attribute_values, values, leafless_attribute_values(attribute, point, 1, (double *)WRONG(out)));
    MISALIGNED(leafless_attribute_values, points_model,
               leafless_attribute_values(attribute, (const double *)WRONG(one), 1, values));
    MISALIGNED(leafless_attribute_range, range,
               leafless_attribute_range(attribute, point, above, (leafless_value_range *)WRONG(out)));
    MISALIGNED(leafless_channel_fill, fill,
               leafless_channel_fill(attribute, &frame, (leafless_channel_fill_options *)WRONG(&fill), NULL, channel_result));
    MISALIGNED(leafless_attribute_describe, info,
               leafless_attribute_describe(attribute, (leafless_attribute_info *)WRONG(out)));
    MISALIGNED(leafless_channel_describe, info, leafless_channel_describe(channel, (leafless_channel_info *)WRONG(out)));
    MISALIGNED(leafless_channel_values, values, leafless_channel_values(channel, point, 1, (double *)WRONG(out)));
    MISALIGNED(leafless_channel_value, value, leafless_channel_value(channel, point, (double *)WRONG(out)));
    MISALIGNED(leafless_channel_value_at, cell,
               leafless_channel_value_at(channel, (const uint32_t *)WRONG(cell), values));
    MISALIGNED(leafless_channel_with_value_in, value,
               leafless_channel_with_value_in(channel, octree, (const double *)WRONG(one), NULL, channel_result));
    MISALIGNED(leafless_octree_carry_channels, rules,
               leafless_octree_carry_channels(octree, operands, 1, 0, (leafless_carry_rule *)WRONG(rules), 1, NULL, result));
    untouched();
    CHECK(never == UNTOUCHED);

    leafless_octree_free(bare);
    bare = NULL;
    MAY_BE_NULL(leafless_octree_carry_channels, rules,
                leafless_octree_carry_channels(octree, NULL, 0, 0, NULL, 0, NULL, &bare));
    leafless_octree_free(bare);
    bare = NULL;
    MAY_BE_NULL(leafless_octree_carry_channels, options,
                leafless_octree_carry_channels(octree, operands, 1, 0, NULL, 0, NULL, &bare));
    CHECK(check_channels(bare) == 1);
    leafless_octree_free(bare);
    leafless_octree_free(bearing);
    summaries(channel);
    leafless_channel_free(channel);
    leafless_channel_free(NULL);
    leafless_attribute_free(attribute);
    leafless_attribute_free(NULL);
}

/* Surfaces of cells: all pointers, all numbers. */
static void extended_octrees(void) {
    static const uint32_t not_a_depth[] = {0, 21, 255, 256, 257, UINT32_MAX}, not_a_rule[] = {4, 255, 256, UINT32_MAX};
    static const double not_a_tolerance[] = {NAN, INFINITY, -INFINITY, -1, 1e300};
    const uint32_t cell[3] = {0, 0, 0}, outside[3] = {8, 0, 0}, *bad_cell = (const uint32_t *)WRONG(CHECK_CUBE);
    void *out = fresh();
    void *never = UNTOUCHED;
    leafless_octree **result = (leafless_octree **)&never, *extended = NULL;
    leafless_stored_surface_info stored = LEAFLESS_INIT(leafless_stored_surface_info);
    leafless_cut_options cuts = LEAFLESS_INIT(leafless_cut_options);
    leafless_cell_function function;
    double terms[1];
    size_t i;
    OK(leafless_octree_build_extended(solid, &frame, NULL, NULL, &extended));
    NULL_POINTER(leafless_octree_build_extended, solid,
                 leafless_octree_build_extended(NULL, &frame, NULL, NULL, result));
    NULL_POINTER(leafless_octree_build_extended, frame,
                 leafless_octree_build_extended(solid, NULL, NULL, NULL, result));
    NULL_POINTER(leafless_octree_build_extended, octree,
                 leafless_octree_build_extended(solid, &frame, NULL, NULL, NULL));
    NULL_POINTER(leafless_octree_plain, octree, leafless_octree_plain(NULL, 3, 0, NULL, result));
    NULL_POINTER(leafless_octree_plain, plain, leafless_octree_plain(octree, 3, 0, NULL, NULL));
    NULL_POINTER(leafless_octree_count_cuts, octree,
                 leafless_octree_count_cuts(NULL, (leafless_cut_counts *)out));
    NULL_POINTER(leafless_octree_count_cuts, counts, leafless_octree_count_cuts(octree, NULL));
    NULL_POINTER(leafless_octree_surface_at, octree,
                 leafless_octree_surface_at(NULL, 0, &stored, NULL, 0, NULL, 0));
    NULL_POINTER(leafless_octree_surface_at, info, leafless_octree_surface_at(extended, 0, NULL, NULL, 0, NULL, 0));
    NULL_POINTER(leafless_octree_surface_at, terms,
                 leafless_octree_surface_at(extended, 0, &stored, NULL, 9, NULL, 0));
    NULL_POINTER(leafless_octree_surface_at, placements,
                 leafless_octree_surface_at(extended, 0, &stored, NULL, 0, NULL, 9));
    MAY_BE_NULL(leafless_octree_surface_at, terms,
                leafless_octree_surface_at(extended, 0, &stored, NULL, 0, NULL, 0));
    MAY_BE_NULL(leafless_octree_surface_at, placements,
                leafless_octree_surface_at(extended, 0, &stored, NULL, 0, NULL, 0));
    NULL_POINTER(leafless_octree_cell_function, octree,
                 leafless_octree_cell_function(NULL, 0, cell, (leafless_cell_function *)out));
    NULL_POINTER(leafless_octree_cell_function, cell,
                 leafless_octree_cell_function(octree, 0, NULL, (leafless_cell_function *)out));
    NULL_POINTER(leafless_octree_cell_function, function, leafless_octree_cell_function(octree, 0, cell, NULL));
    untouched();
    CHECK(never == UNTOUCHED);
    MAY_BE_NULL(leafless_octree_build_extended, cuts,
                leafless_octree_build_extended(solid, &frame, NULL, NULL, result));
    leafless_octree_free(*result);
    MAY_BE_NULL(leafless_octree_build_extended, options,
                leafless_octree_build_extended(solid, &frame, NULL, NULL, result));
    leafless_octree_free(*result);
    MAY_BE_NULL(leafless_octree_plain, options, leafless_octree_plain(octree, 3, 0, NULL, result));
    leafless_octree_free(*result);

    never = UNTOUCHED;
    out = fresh();
    MISALIGNED(leafless_octree_build_extended, solid,
               leafless_octree_build_extended((leafless_solid *)WRONG(solid), &frame, NULL, NULL, result));
    MISALIGNED(leafless_octree_build_extended, frame,
               leafless_octree_build_extended(solid, (leafless_frame *)WRONG(&frame), NULL, NULL, result));
    MISALIGNED(leafless_octree_build_extended, cuts,
               leafless_octree_build_extended(solid, &frame, (leafless_cut_options *)WRONG(&cuts), NULL, result));
    MISALIGNED(leafless_octree_build_extended, options,
               leafless_octree_build_extended(solid, &frame, NULL, (leafless_options *)WRONG(&options), result));
    MISALIGNED(leafless_octree_build_extended, octree,
               leafless_octree_build_extended(solid, &frame, NULL, NULL, (leafless_octree **)WRONG(out)));
    MISALIGNED(leafless_octree_plain, octree,
               leafless_octree_plain((leafless_octree *)WRONG(octree), 3, 0, NULL, result));
    MISALIGNED(leafless_octree_plain, options,
               leafless_octree_plain(octree, 3, 0, (leafless_options *)WRONG(&options), result));
    MISALIGNED(leafless_octree_plain, plain,
               leafless_octree_plain(octree, 3, 0, NULL, (leafless_octree **)WRONG(out)));
    MISALIGNED(leafless_octree_count_cuts, octree,
               leafless_octree_count_cuts((leafless_octree *)WRONG(octree), (leafless_cut_counts *)out));
    MISALIGNED(leafless_octree_count_cuts, counts,
               leafless_octree_count_cuts(octree, (leafless_cut_counts *)WRONG(out)));
    MISALIGNED(leafless_octree_surface_at, octree,
               leafless_octree_surface_at((leafless_octree *)WRONG(extended), 0, &stored, NULL, 0, NULL, 0));
    MISALIGNED(leafless_octree_surface_at, info,
               leafless_octree_surface_at(extended, 0, (leafless_stored_surface_info *)WRONG(out), NULL, 0, NULL, 0));
    MISALIGNED(leafless_octree_surface_at, terms,
               leafless_octree_surface_at(extended, 0, &stored, (double *)WRONG(out), 9, NULL, 0));
    MISALIGNED(leafless_octree_surface_at, placements,
               leafless_octree_surface_at(extended, 0, &stored, NULL, 0, (double *)WRONG(out), 9));
    MISALIGNED(leafless_octree_cell_function, octree,
               leafless_octree_cell_function((leafless_octree *)WRONG(octree), 0, cell, (leafless_cell_function *)out));
    MISALIGNED(leafless_octree_cell_function, cell,
               leafless_octree_cell_function(octree, 0, bad_cell, (leafless_cell_function *)out));
    MISALIGNED(leafless_octree_cell_function, function,
               leafless_octree_cell_function(octree, 0, cell, (leafless_cell_function *)WRONG(out)));

    for (i = 0; i < COUNT(not_a_depth); i++) {
        leafless_frame bad = frame;
        bad.depth = not_a_depth[i];
        BAD_NUMBER(leafless_octree_build_extended, depth,
                   leafless_octree_build_extended(solid, &bad, NULL, NULL, result));
        BAD_NUMBER(leafless_octree_plain, depth, leafless_octree_plain(octree, bad.depth, 0, NULL, result));
    }
    for (i = 0; i < COUNT(not_a_rule); i++) {
        BAD_NUMBER(leafless_octree_plain, rule, leafless_octree_plain(octree, 3, not_a_rule[i], NULL, result));
    }
    for (i = 0; i < COUNT(not_a_tolerance); i++) {
        cuts.tolerance_model = not_a_tolerance[i];
        BAD_NUMBER(leafless_octree_build_extended, tolerance,
                   leafless_octree_build_extended(solid, &frame, &cuts, NULL, result));
        if (!(not_a_tolerance[i] > 0)) {
            BAD_NUMBER(leafless_frame_to_tolerance, tolerance,
                       leafless_frame_to_tolerance(point, above, not_a_tolerance[i], 0, (leafless_frame *)out));
        }
    }
    BAD_NUMBER(leafless_octree_surface_at, surface, leafless_octree_surface_at(octree, 0, &stored, NULL, 0, NULL, 0));
    BAD_NUMBER(leafless_octree_surface_at, surface,
               leafless_octree_surface_at(extended, UINT32_MAX, &stored, NULL, 0, NULL, 0));
    FAILS(LEAFLESS_E_BUFFER, leafless_octree_surface_at(extended, 0, &stored, terms, 1, NULL, 0));
    untouched();
    CHECK(never == UNTOUCHED);
    /* Cells that are none have no function. */
    OK(leafless_octree_cell_function(extended, 3, outside, &function));
    CHECK(function.surface_count == 0 && function.table == 0);
    OK(leafless_octree_cell_function(extended, UINT32_MAX, cell, &function));
    CHECK(function.surface_count == 0);
    leafless_octree_free(extended);
}

/* Octrees in parts: all pointers, all numbers. The frame has 4 levels. */
static void shards(void) {
    static const uint32_t not_a_level[] = {5, 20, 21, 255, 256, 257, UINT32_MAX}, not_a_kind[] = {2, 255, 256, UINT32_MAX};
    static const uint64_t not_a_code[] = {8, 64, UINT64_C(1) << 32, UINT64_C(1) << 63, UINT64_MAX};
    static const double not_a_tolerance[] = {NAN, -INFINITY, -1};
    static const uint64_t codes[2] = {0, 1}, same[2] = {1, 1}, *const bad_codes = (const uint64_t *)WRONG(CHECK_CUBE);
    const leafless_shard top = {0, 1, LEAFLESS_SHARD_KIND_TOP};
    leafless_shard bad = top;
    void *out = fresh();
    void *never = UNTOUCHED;
    leafless_octree **result = (leafless_octree **)&never;
    leafless_solid **solid_result = (leafless_solid **)&never;
    leafless_octree *const bad_octree = (leafless_octree *)WRONG(octree);
    leafless_solid *const bad_solid = (leafless_solid *)WRONG(solid);
    leafless_frame *const bad_frame = (leafless_frame *)WRONG(&frame);
    leafless_options *const bad_options = (leafless_options *)WRONG(&options);
    const leafless_shard *const bad_shard = (const leafless_shard *)WRONG(&top);
    leafless_cut_options cuts = LEAFLESS_INIT(leafless_cut_options);
    leafless_mass_sum sum = LEAFLESS_INIT(leafless_mass_sum), shorter, *const bad_sum = (leafless_mass_sum *)WRONG(out);
    leafless_measures measures = LEAFLESS_INIT(leafless_measures);
    leafless_statistics levels[10];
    const leafless_octree *list[2];
    uint64_t number = 77;
    size_t i;
    memset(levels, 0, sizeof levels);
    list[0] = list[1] = octree;
    OK(leafless_mass_sum_unknown(&frame, 0, 0, &sum));

    NULL_POINTER(leafless_octree_build_shard, solid, leafless_octree_build_shard(NULL, &frame, 0, &top, NULL, result));
    NULL_POINTER(leafless_octree_build_shard, frame, leafless_octree_build_shard(solid, NULL, 0, &top, NULL, result));
    NULL_POINTER(leafless_octree_build_shard, shard, leafless_octree_build_shard(solid, &frame, 0, NULL, NULL, result));
    NULL_POINTER(leafless_octree_build_shard, octree, leafless_octree_build_shard(solid, &frame, 0, &top, NULL, NULL));
    NULL_POINTER(leafless_octree_build_extended_shard, solid,
                 leafless_octree_build_extended_shard(NULL, &frame, NULL, &top, NULL, result));
    NULL_POINTER(leafless_octree_build_extended_shard, frame,
                 leafless_octree_build_extended_shard(solid, NULL, NULL, &top, NULL, result));
    NULL_POINTER(leafless_octree_build_extended_shard, shard,
                 leafless_octree_build_extended_shard(solid, &frame, NULL, NULL, NULL, result));
    NULL_POINTER(leafless_octree_build_extended_shard, octree,
                 leafless_octree_build_extended_shard(solid, &frame, NULL, &top, NULL, NULL));
    NULL_POINTER(leafless_octree_shard, octree, leafless_octree_shard(NULL, &top, NULL, result));
    NULL_POINTER(leafless_octree_shard, shard, leafless_octree_shard(octree, NULL, NULL, result));
    NULL_POINTER(leafless_octree_shard, result, leafless_octree_shard(octree, &top, NULL, NULL));
    NULL_POINTER(leafless_octree_join, octrees, leafless_octree_join(NULL, 2, NULL, result));
    NULL_POINTER(leafless_octree_join, result, leafless_octree_join(list, 2, NULL, NULL));
    BAD_NUMBER(leafless_octree_join, count, leafless_octree_join(list, 0, NULL, result));
    BAD_NUMBER(leafless_octree_join, count, leafless_octree_join(NULL, 0, NULL, result));
    NULL_POINTER(leafless_octree_open_cells, octree, leafless_octree_open_cells(NULL, 1, NULL, 0, &number));
    NULL_POINTER(leafless_octree_open_cells, codes, leafless_octree_open_cells(octree, 1, NULL, 1, &number));
    NULL_POINTER(leafless_octree_open_cells, count, leafless_octree_open_cells(octree, 1, NULL, 0, NULL));
    NULL_POINTER(leafless_octree_statistics_with, octree,
                 leafless_octree_statistics_with(NULL, 1, NULL, 0, NULL, 0, NULL, 0, &number));
    NULL_POINTER(leafless_octree_statistics_with, codes,
                 leafless_octree_statistics_with(octree, 1, NULL, 2, levels, 10, NULL, 0, &number));
    NULL_POINTER(leafless_octree_statistics_with, levels,
                 leafless_octree_statistics_with(octree, 1, codes, 2, NULL, 10, NULL, 0, &number));
    NULL_POINTER(leafless_octree_statistics_with, joined,
                 leafless_octree_statistics_with(octree, 1, NULL, 0, NULL, 0, NULL, 5, &number));
    NULL_POINTER(leafless_octree_statistics_with, count,
                 leafless_octree_statistics_with(octree, 1, NULL, 0, NULL, 0, NULL, 0, NULL));
    NULL_POINTER(leafless_solid_from_shards, top, leafless_solid_from_shards(NULL, 1, codes, list, 2, solid_result));
    NULL_POINTER(leafless_solid_from_shards, codes, leafless_solid_from_shards(octree, 1, NULL, list, 2, solid_result));
    NULL_POINTER(leafless_solid_from_shards, octrees, leafless_solid_from_shards(octree, 1, codes, NULL, 2, solid_result));
    NULL_POINTER(leafless_solid_from_shards, solid, leafless_solid_from_shards(octree, 1, codes, list, 2, NULL));
    list[1] = NULL;
    NULL_POINTER(leafless_octree_join, octrees, leafless_octree_join(list, 2, NULL, result));
    NULL_POINTER(leafless_solid_from_shards, octrees, leafless_solid_from_shards(octree, 1, codes, list, 2, solid_result));
    list[1] = octree;
    NULL_POINTER(leafless_solid_measure_cell, solid,
                 leafless_solid_measure_cell(NULL, &frame, 1, 0, 0.1, 0, NULL, (leafless_mass_sum *)out));
    NULL_POINTER(leafless_solid_measure_cell, frame,
                 leafless_solid_measure_cell(solid, NULL, 1, 0, 0.1, 0, NULL, (leafless_mass_sum *)out));
    NULL_POINTER(leafless_solid_measure_cell, sum, leafless_solid_measure_cell(solid, &frame, 1, 0, 0.1, 0, NULL, NULL));
    NULL_POINTER(leafless_mass_sum_unknown, frame, leafless_mass_sum_unknown(NULL, 1, 0, (leafless_mass_sum *)out));
    NULL_POINTER(leafless_mass_sum_unknown, sum, leafless_mass_sum_unknown(&frame, 1, 0, NULL));
    NULL_POINTER(leafless_mass_sum_add, a, leafless_mass_sum_add(NULL, &sum, (leafless_mass_sum *)out));
    NULL_POINTER(leafless_mass_sum_add, b, leafless_mass_sum_add(&sum, NULL, (leafless_mass_sum *)out));
    NULL_POINTER(leafless_mass_sum_add, sum, leafless_mass_sum_add(&sum, &sum, NULL));
    NULL_POINTER(leafless_mass_sum_subtract, a, leafless_mass_sum_subtract(NULL, &sum, (leafless_mass_sum *)out));
    NULL_POINTER(leafless_mass_sum_subtract, b, leafless_mass_sum_subtract(&sum, NULL, (leafless_mass_sum *)out));
    NULL_POINTER(leafless_mass_sum_subtract, sum, leafless_mass_sum_subtract(&sum, &sum, NULL));
    NULL_POINTER(leafless_mass_sum_measures, sum, leafless_mass_sum_measures(NULL, (leafless_measures *)out));
    NULL_POINTER(leafless_mass_sum_measures, measures, leafless_mass_sum_measures(&sum, NULL));
    untouched();
    CHECK(never == UNTOUCHED && number == 77);

    MISALIGNED(leafless_octree_build_shard, solid,
               leafless_octree_build_shard(bad_solid, &frame, 0, &top, NULL, result));
    MISALIGNED(leafless_octree_build_shard, frame,
               leafless_octree_build_shard(solid, bad_frame, 0, &top, NULL, result));
    MISALIGNED(leafless_octree_build_shard, shard,
               leafless_octree_build_shard(solid, &frame, 0, bad_shard, NULL, result));
    MISALIGNED(leafless_octree_build_shard, options,
               leafless_octree_build_shard(solid, &frame, 0, &top, bad_options, result));
    MISALIGNED(leafless_octree_build_shard, octree,
               leafless_octree_build_shard(solid, &frame, 0, &top, NULL, (leafless_octree **)WRONG(out)));
    MISALIGNED(leafless_octree_build_extended_shard, solid,
               leafless_octree_build_extended_shard(bad_solid, &frame, NULL, &top, NULL, result));
    MISALIGNED(leafless_octree_build_extended_shard, frame,
               leafless_octree_build_extended_shard(solid, bad_frame, NULL, &top, NULL, result));
    MISALIGNED(leafless_octree_build_extended_shard, cuts,
               leafless_octree_build_extended_shard(solid, &frame, (leafless_cut_options *)WRONG(&cuts), &top, NULL, result));
    MISALIGNED(leafless_octree_build_extended_shard, shard,
               leafless_octree_build_extended_shard(solid, &frame, NULL, bad_shard, NULL, result));
    MISALIGNED(leafless_octree_build_extended_shard, options,
               leafless_octree_build_extended_shard(solid, &frame, NULL, &top, bad_options, result));
    MISALIGNED(leafless_octree_build_extended_shard, octree,
               leafless_octree_build_extended_shard(solid, &frame, NULL, &top, NULL, (leafless_octree **)WRONG(out)));
    MISALIGNED(leafless_octree_shard, octree, leafless_octree_shard(bad_octree, &top, NULL, result));
    MISALIGNED(leafless_octree_shard, shard, leafless_octree_shard(octree, bad_shard, NULL, result));
    MISALIGNED(leafless_octree_shard, options, leafless_octree_shard(octree, &top, bad_options, result));
    MISALIGNED(leafless_octree_shard, result, leafless_octree_shard(octree, &top, NULL, (leafless_octree **)WRONG(out)));
    MISALIGNED(leafless_octree_join, octrees,
               leafless_octree_join((const leafless_octree *const *)WRONG(list), 2, NULL, result));
    MISALIGNED(leafless_octree_join, options, leafless_octree_join(list, 2, bad_options, result));
    MISALIGNED(leafless_octree_join, result, leafless_octree_join(list, 2, NULL, (leafless_octree **)WRONG(out)));
    MISALIGNED(leafless_octree_open_cells, octree, leafless_octree_open_cells(bad_octree, 1, NULL, 0, &number));
    MISALIGNED(leafless_octree_open_cells, codes,
               leafless_octree_open_cells(octree, 1, (uint64_t *)WRONG(out), 1, &number));
    MISALIGNED(leafless_octree_open_cells, count,
               leafless_octree_open_cells(octree, 1, NULL, 0, (uint64_t *)WRONG(out)));
    MISALIGNED(leafless_octree_statistics_with, octree,
               leafless_octree_statistics_with(bad_octree, 1, NULL, 0, NULL, 0, NULL, 0, &number));
    MISALIGNED(leafless_octree_statistics_with, codes,
               leafless_octree_statistics_with(octree, 1, bad_codes, 2, levels, 10, NULL, 0, &number));
    MISALIGNED(leafless_octree_statistics_with, levels,
               leafless_octree_statistics_with(octree, 1, codes, 2, (const leafless_statistics *)WRONG(levels), 10, NULL, 0,
                                               &number));
    MISALIGNED(leafless_octree_statistics_with, joined,
               leafless_octree_statistics_with(octree, 1, NULL, 0, NULL, 0, (leafless_statistics *)WRONG(levels), 5,
                                               &number));
    MISALIGNED(leafless_octree_statistics_with, count,
               leafless_octree_statistics_with(octree, 1, NULL, 0, NULL, 0, NULL, 0, (uint64_t *)WRONG(out)));
    MISALIGNED(leafless_solid_from_shards, top,
               leafless_solid_from_shards(bad_octree, 1, codes, list, 2, solid_result));
    MISALIGNED(leafless_solid_from_shards, codes,
               leafless_solid_from_shards(octree, 1, bad_codes, list, 2, solid_result));
    MISALIGNED(leafless_solid_from_shards, octrees,
               leafless_solid_from_shards(octree, 1, codes, (const leafless_octree *const *)WRONG(list), 2, solid_result));
    MISALIGNED(leafless_solid_from_shards, solid,
               leafless_solid_from_shards(octree, 1, codes, list, 2, (leafless_solid **)WRONG(out)));
    list[1] = bad_octree;
    MISALIGNED(leafless_octree_join, octrees, leafless_octree_join(list, 2, NULL, result));
    MISALIGNED(leafless_solid_from_shards, octrees,
               leafless_solid_from_shards(octree, 1, codes, list, 2, solid_result));
    list[1] = octree;
    MISALIGNED(leafless_solid_measure_cell, solid,
               leafless_solid_measure_cell(bad_solid, &frame, 1, 0, 0.1, 0, NULL, (leafless_mass_sum *)out));
    MISALIGNED(leafless_solid_measure_cell, frame,
               leafless_solid_measure_cell(solid, bad_frame, 1, 0, 0.1, 0, NULL, (leafless_mass_sum *)out));
    MISALIGNED(leafless_solid_measure_cell, options,
               leafless_solid_measure_cell(solid, &frame, 1, 0, 0.1, 0, bad_options, (leafless_mass_sum *)out));
    MISALIGNED(leafless_solid_measure_cell, sum,
               leafless_solid_measure_cell(solid, &frame, 1, 0, 0.1, 0, NULL, bad_sum));
    MISALIGNED(leafless_mass_sum_unknown, frame,
               leafless_mass_sum_unknown(bad_frame, 1, 0, (leafless_mass_sum *)out));
    MISALIGNED(leafless_mass_sum_unknown, sum, leafless_mass_sum_unknown(&frame, 1, 0, bad_sum));
    MISALIGNED(leafless_mass_sum_add, a, leafless_mass_sum_add(bad_sum, &sum, (leafless_mass_sum *)out));
    MISALIGNED(leafless_mass_sum_add, b, leafless_mass_sum_add(&sum, bad_sum, (leafless_mass_sum *)out));
    MISALIGNED(leafless_mass_sum_add, sum, leafless_mass_sum_add(&sum, &sum, bad_sum));
    MISALIGNED(leafless_mass_sum_subtract, a, leafless_mass_sum_subtract(bad_sum, &sum, (leafless_mass_sum *)out));
    MISALIGNED(leafless_mass_sum_subtract, b, leafless_mass_sum_subtract(&sum, bad_sum, (leafless_mass_sum *)out));
    MISALIGNED(leafless_mass_sum_subtract, sum, leafless_mass_sum_subtract(&sum, &sum, bad_sum));
    MISALIGNED(leafless_mass_sum_measures, sum, leafless_mass_sum_measures(bad_sum, (leafless_measures *)out));
    MISALIGNED(leafless_mass_sum_measures, measures,
               leafless_mass_sum_measures(&sum, (leafless_measures *)WRONG(out)));

    for (i = 0; i < COUNT(not_a_kind); i++) {
        bad.kind = not_a_kind[i];
        BAD_NUMBER(leafless_octree_build_shard, shard.kind,
                   leafless_octree_build_shard(solid, &frame, 0, &bad, NULL, result));
        BAD_NUMBER(leafless_octree_build_extended_shard, shard.kind,
                   leafless_octree_build_extended_shard(solid, &frame, NULL, &bad, NULL, result));
        BAD_NUMBER(leafless_octree_shard, shard.kind, leafless_octree_shard(octree, &bad, NULL, result));
    }
    for (i = 0; i < 2 * COUNT(not_a_level); i++) {
        const uint32_t level = not_a_level[i / 2];
        bad = top;
        bad.kind = i % 2 == 0 ? LEAFLESS_SHARD_KIND_TOP : LEAFLESS_SHARD_KIND_BELOW;
        bad.level = level;
        BAD_NUMBER(leafless_octree_build_shard, shard.level,
                   leafless_octree_build_shard(solid, &frame, 0, &bad, NULL, result));
        BAD_NUMBER(leafless_octree_build_extended_shard, shard.level,
                   leafless_octree_build_extended_shard(solid, &frame, NULL, &bad, NULL, result));
        BAD_NUMBER(leafless_octree_shard, shard.level, leafless_octree_shard(octree, &bad, NULL, result));
        BAD_NUMBER(leafless_octree_open_cells, level, leafless_octree_open_cells(octree, level, NULL, 0, &number));
        BAD_NUMBER(leafless_octree_statistics_with, level,
                   leafless_octree_statistics_with(octree, level, NULL, 0, NULL, 0, NULL, 0, &number));
        BAD_NUMBER(leafless_solid_from_shards, level,
                   leafless_solid_from_shards(octree, level, NULL, NULL, 0, solid_result));
        BAD_NUMBER(leafless_solid_measure_cell, level,
                   leafless_solid_measure_cell(solid, &frame, level, 0, 0.1, 0, NULL, (leafless_mass_sum *)out));
        BAD_NUMBER(leafless_mass_sum_unknown, level,
                   leafless_mass_sum_unknown(&frame, level, 0, (leafless_mass_sum *)out));
    }
    BAD_NUMBER(leafless_octree_statistics_with, level,
               leafless_octree_statistics_with(octree, 4, NULL, 0, NULL, 0, NULL, 0, &number));
    for (i = 0; i < COUNT(not_a_code); i++) {
        uint64_t two[2] = {0, 0};
        two[1] = not_a_code[i];
        bad = top;
        bad.code = not_a_code[i];
        BAD_NUMBER(leafless_octree_build_shard, shard.code,
                   leafless_octree_build_shard(solid, &frame, 0, &bad, NULL, result));
        bad.kind = LEAFLESS_SHARD_KIND_BELOW;
        BAD_NUMBER(leafless_octree_build_shard, shard.code,
                   leafless_octree_build_shard(solid, &frame, 0, &bad, NULL, result));
        BAD_NUMBER(leafless_octree_build_extended_shard, shard.code,
                   leafless_octree_build_extended_shard(solid, &frame, NULL, &bad, NULL, result));
        BAD_NUMBER(leafless_octree_shard, shard.code, leafless_octree_shard(octree, &bad, NULL, result));
        BAD_NUMBER(leafless_octree_statistics_with, codes,
                   leafless_octree_statistics_with(octree, 1, two, 2, levels, 10, NULL, 0, &number));
        BAD_NUMBER(leafless_solid_from_shards, codes,
                   leafless_solid_from_shards(octree, 1, two, list, 2, solid_result));
        BAD_NUMBER(leafless_solid_measure_cell, code,
                   leafless_solid_measure_cell(solid, &frame, 1, two[1], 0.1, 0, NULL, (leafless_mass_sum *)out));
        BAD_NUMBER(leafless_mass_sum_unknown, code,
                   leafless_mass_sum_unknown(&frame, 1, two[1], (leafless_mass_sum *)out));
    }
    BAD_NUMBER(leafless_octree_build_shard, rule, leafless_octree_build_shard(solid, &frame, 4, &top, NULL, result));
    cuts.tolerance_model = -1;
    BAD_NUMBER(leafless_octree_build_extended_shard, tolerance,
               leafless_octree_build_extended_shard(solid, &frame, &cuts, &top, NULL, result));
    BAD_NUMBER(leafless_solid_from_shards, codes, leafless_solid_from_shards(octree, 1, same, list, 2, solid_result));
    BAD_NUMBER(leafless_solid_from_shards, codes,
               leafless_solid_from_shards(octree, 1, codes, list, UINT64_MAX, solid_result));
    BAD_NUMBER(leafless_octree_join, octrees, leafless_octree_join(list, UINT64_MAX, NULL, result));
    for (i = 0; i < 20; i++) {
        if (i != 10) {
            BAD_NUMBER(leafless_octree_statistics_with, level_count,
                       leafless_octree_statistics_with(octree, 1, codes, 2, levels, i, NULL, 0, &number));
        }
    }
    for (i = 0; i < COUNT(not_a_tolerance); i++) {
        BAD_NUMBER(leafless_solid_measure_cell, tolerance,
                   leafless_solid_measure_cell(solid, &frame, 1, 0, not_a_tolerance[i], 0, NULL, (leafless_mass_sum *)out));
        BAD_NUMBER(leafless_solid_measure_cell, tolerance,
                   leafless_solid_measure_cell(solid, &frame, 1, 0, 0, not_a_tolerance[i], NULL, (leafless_mass_sum *)out));
    }
    /* A sum that was cut off is none. */
    shorter = sum;
    shorter.struct_size -= 4;
    BAD_NUMBER(leafless_mass_sum_add, a, leafless_mass_sum_add(&shorter, &sum, (leafless_mass_sum *)out));
    BAD_NUMBER(leafless_mass_sum_measures, sum, leafless_mass_sum_measures(&shorter, (leafless_measures *)out));
    untouched();
    CHECK(never == UNTOUCHED && number == 77);

    MAY_BE_NULL(leafless_octree_build_shard, options,
                leafless_octree_build_shard(solid, &frame, 0, &top, NULL, result));
    leafless_octree_free(*result);
    MAY_BE_NULL(leafless_octree_build_extended_shard, cuts,
                leafless_octree_build_extended_shard(solid, &frame, NULL, &top, NULL, result));
    leafless_octree_free(*result);
    MAY_BE_NULL(leafless_octree_build_extended_shard, options,
                leafless_octree_build_extended_shard(solid, &frame, NULL, &top, NULL, result));
    leafless_octree_free(*result);
    MAY_BE_NULL(leafless_octree_shard, options, leafless_octree_shard(octree, &top, NULL, result));
    leafless_octree_free(*result);
    MAY_BE_NULL(leafless_octree_join, options, leafless_octree_join(list, 2, NULL, result));
    leafless_octree_free(*result);
    MAY_BE_NULL(leafless_octree_open_cells, codes, leafless_octree_open_cells(octree, 1, NULL, 0, &number));
    MAY_BE_NULL(leafless_octree_statistics_with, codes,
                leafless_octree_statistics_with(octree, 1, NULL, 0, levels, 0, NULL, 0, &number));
    MAY_BE_NULL(leafless_octree_statistics_with, levels,
                leafless_octree_statistics_with(octree, 1, codes, 0, NULL, 0, NULL, 0, &number));
    MAY_BE_NULL(leafless_octree_statistics_with, joined,
                leafless_octree_statistics_with(octree, 1, NULL, 0, NULL, 0, NULL, 0, &number));
    CHECK(number == 5);
    MAY_BE_NULL(leafless_solid_from_shards, codes,
                leafless_solid_from_shards(octree, 1, NULL, list, 0, solid_result));
    leafless_solid_free(*solid_result);
    MAY_BE_NULL(leafless_solid_from_shards, octrees,
                leafless_solid_from_shards(octree, 1, codes, NULL, 0, solid_result));
    leafless_solid_free(*solid_result);
    MAY_BE_NULL(leafless_solid_measure_cell, options,
                leafless_solid_measure_cell(solid, &frame, 1, 0, 0.1, 0, NULL, &sum));
    OK(leafless_mass_sum_measures(&sum, &measures));
    (void)fresh();
}

int main(void) {
    octree = check_ball(4, LEAFLESS_RULE_CERTIFIED);
    mesh = check_cube();
    solid = check_ball_solid();
    OK(leafless_control_new(&control));
    OK(leafless_cursor_new(octree, &cursor));
    OK(leafless_point_cursor_new(octree, &point_cursor));
    OK(leafless_point_table_new(octree, 4, &point_table, (uint8_t *)fresh()));
    OK(leafless_init(&options, sizeof options));
    null_pointers();
    misaligned();
    numbers();
    extended_octrees();
    shards();
    lazy_octrees();
    cells_and_faces();
    volumes_and_surfaces();
    attributes_and_channels();
    rays();
    voxels();
    columns();
    regions();
    distances();
    /* All of it is as good as ever. */
    OK(leafless_octree_check(octree));
    leafless_point_cursor_free(point_cursor);
    leafless_point_table_free(point_table);
    leafless_cursor_free(cursor);
    leafless_control_free(control);
    leafless_solid_free(solid);
    leafless_mesh_free(mesh);
    leafless_octree_free(octree);
    return 0;
}
