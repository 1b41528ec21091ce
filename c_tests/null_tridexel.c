/* As null.c, for tri-dexel models. */
#include "null.h"

static const leafless_frame frame = {{-1, -1, -1}, 2, 4};
static leafless_solid *solid;
static leafless_tridexel *model;
static leafless_tridexel_editor *editor;

static void models(void) {
    void *out = fresh(), *never = UNTOUCHED;
    leafless_tridexel **result = (leafless_tridexel **)&never, *other = NULL;
    leafless_tridexel_info *info = (leafless_tridexel_info *)out;
    leafless_dexel_statistics *statistics = (leafless_dexel_statistics *)out;
    leafless_tridexel_format format;
    leafless_options options;
    const uint32_t cell[4] = {8, 8, 8, 8};
    OK(leafless_init(&options, sizeof options));
    OK(leafless_init(&format, sizeof format));
#define MAKE(solid, frame, rule, format, result) leafless_tridexel_build(solid, frame, rule, format, &options, result)
    NULL_POINTER(leafless_tridexel_build, solid, MAKE(NULL, &frame, 1, &format, result));
    NULL_POINTER(leafless_tridexel_build, frame, MAKE(solid, NULL, 1, &format, result));
    NULL_POINTER(leafless_tridexel_build, tridexel, MAKE(solid, &frame, 1, &format, NULL));
    BAD_NUMBER(leafless_tridexel_build, rule, MAKE(solid, &frame, 0, &format, result));
    BAD_NUMBER(leafless_tridexel_build, rule, MAKE(solid, &frame, 4, &format, result));
    BAD_NUMBER(leafless_tridexel_build, rule, MAKE(solid, &frame, UINT32_MAX, &format, result));
    MISALIGNED(leafless_tridexel_build, format, MAKE(solid, &frame, 1, (leafless_tridexel_format *)WRONG(&format), result));
#define FORMAT(field, wrong)                                                                                     \
    format.field = wrong;                                                                                        \
    BAD_NUMBER(leafless_tridexel_build, format.field, MAKE(solid, &frame, 1, &format, result));                   \
    BAD_NUMBER(leafless_tridexel_with_format, format.field,                                                        \
               leafless_tridexel_with_format(model, &format, NULL, result));                                       \
    format.field = 0
    FORMAT(directions, 8);
    FORMAT(directions, UINT32_MAX);
    FORMAT(ends, 2);
    FORMAT(normals, 3);
    FORMAT(normals, UINT32_MAX);
    FORMAT(has_surfaces, 2);
    FORMAT(has_materials, UINT32_MAX);
#undef FORMAT
    format.struct_size = 3;
    BAD_NUMBER(leafless_tridexel_build, format, MAKE(solid, &frame, 1, &format, result));
#undef MAKE
    format.struct_size = sizeof format;
    MAY_BE_NULL(leafless_tridexel_build, format, leafless_tridexel_build(solid, &frame, 1, NULL, &options, &other));
    leafless_tridexel_free(other);
    MAY_BE_NULL(leafless_tridexel_build, options, leafless_tridexel_build(solid, &frame, 1, &format, NULL, &other));
    leafless_tridexel_free(other);

    NULL_POINTER(leafless_tridexel_ref, tridexel, leafless_tridexel_ref(NULL, result));
    NULL_POINTER(leafless_tridexel_ref, reference, leafless_tridexel_ref(model, NULL));
    NULL_POINTER(leafless_tridexel_describe, tridexel, leafless_tridexel_describe(NULL, info));
    NULL_POINTER(leafless_tridexel_describe, info, leafless_tridexel_describe(model, NULL));
    MISALIGNED(leafless_tridexel_describe, info, leafless_tridexel_describe(model, (leafless_tridexel_info *)WRONG(out)));
    NULL_POINTER(leafless_tridexel_check, tridexel, leafless_tridexel_check(NULL));
    NULL_POINTER(leafless_tridexel_equal, a, leafless_tridexel_equal(NULL, model, (bool *)out));
    NULL_POINTER(leafless_tridexel_equal, b, leafless_tridexel_equal(model, NULL, (bool *)out));
    NULL_POINTER(leafless_tridexel_equal, equal, leafless_tridexel_equal(model, model, NULL));
    NULL_POINTER(leafless_tridexel_statistics, tridexel, leafless_tridexel_statistics(NULL, 0, statistics));
    NULL_POINTER(leafless_tridexel_statistics, statistics, leafless_tridexel_statistics(model, 0, NULL));
    MISALIGNED(leafless_tridexel_statistics, statistics,
               leafless_tridexel_statistics(model, 0, (leafless_dexel_statistics *)WRONG(out)));
    BAD_NUMBER(leafless_tridexel_statistics, axis, leafless_tridexel_statistics(model, 3, statistics));
    BAD_NUMBER(leafless_tridexel_statistics, axis, leafless_tridexel_statistics(model, UINT32_MAX, statistics));
    NULL_POINTER(leafless_tridexel_contains_cell, tridexel, leafless_tridexel_contains_cell(NULL, cell, (bool *)out));
    NULL_POINTER(leafless_tridexel_contains_cell, cell, leafless_tridexel_contains_cell(model, NULL, (bool *)out));
    NULL_POINTER(leafless_tridexel_contains_cell, inside, leafless_tridexel_contains_cell(model, cell, NULL));
    MISALIGNED(leafless_tridexel_contains_cell, cell,
               leafless_tridexel_contains_cell(model, (const uint32_t *)WRONG(cell), (bool *)out));
    untouched();
    CHECK(never == UNTOUCHED);
}

static void intervals(void) {
    void *out = fresh();
    uint32_t *numbers = (uint32_t *)out;
    uint64_t *count = (uint64_t *)out, found, also;
    leafless_dexel *dexels = (leafless_dexel *)out;
    double *doubles = (double *)out;
    const uint32_t ray[3] = {8, 8, 8}, end[2] = {9, 9}, beyond[2] = {17, 9};
    NULL_POINTER(leafless_tridexel_window, tridexel, leafless_tridexel_window(NULL, 0, numbers, numbers + 2));
    NULL_POINTER(leafless_tridexel_window, first, leafless_tridexel_window(model, 0, NULL, numbers));
    NULL_POINTER(leafless_tridexel_window, end, leafless_tridexel_window(model, 0, numbers, NULL));
    BAD_NUMBER(leafless_tridexel_window, axis, leafless_tridexel_window(model, 3, numbers, numbers + 2));
    NULL_POINTER(leafless_tridexel_ray, tridexel, leafless_tridexel_ray(NULL, 0, ray, dexels, 1, count));
    NULL_POINTER(leafless_tridexel_ray, ray, leafless_tridexel_ray(model, 0, NULL, dexels, 1, count));
    NULL_POINTER(leafless_tridexel_ray, dexels, leafless_tridexel_ray(model, 0, ray, NULL, 1, count));
    NULL_POINTER(leafless_tridexel_ray, count, leafless_tridexel_ray(model, 0, ray, dexels, 1, NULL));
    BAD_NUMBER(leafless_tridexel_ray, axis, leafless_tridexel_ray(model, 3, ray, dexels, 1, count));
    BAD_NUMBER(leafless_tridexel_ray, dexels, leafless_tridexel_ray(model, 0, ray, dexels, UINT64_MAX, count));
    MISALIGNED(leafless_tridexel_ray, dexels,
               leafless_tridexel_ray(model, 0, ray, (leafless_dexel *)WRONG(out), 1, count));
    refused(LEAFLESS_E_BUFFER, "leafless_tridexel_ray", "dexels", leafless_tridexel_ray(model, 0, ray, dexels, 0, count));
#define READ(model, axis, first, end, offsets, offset_count, ends, normals, surfaces, materials, interval_count)      \
    leafless_tridexel_copy(model, axis, first, end, offsets, 2, offset_count, ends, normals, surfaces, materials, 1, \
                           interval_count)
    NULL_POINTER(leafless_tridexel_copy, tridexel, READ(NULL, 0, ray, end, count, count, NULL, NULL, NULL, NULL, count));
    NULL_POINTER(leafless_tridexel_copy, first, READ(model, 0, NULL, end, count, count, NULL, NULL, NULL, NULL, count));
    NULL_POINTER(leafless_tridexel_copy, end, READ(model, 0, ray, NULL, count, count, NULL, NULL, NULL, NULL, count));
    NULL_POINTER(leafless_tridexel_copy, offsets, READ(model, 0, ray, end, NULL, count, NULL, NULL, NULL, NULL, count));
    NULL_POINTER(leafless_tridexel_copy, offset_count,
                 READ(model, 0, ray, end, count, NULL, doubles, doubles, numbers, numbers, count));
    NULL_POINTER(leafless_tridexel_copy, interval_count,
                 READ(model, 0, ray, end, count, count, doubles, doubles, numbers, numbers, NULL));
    BAD_NUMBER(leafless_tridexel_copy, axis, READ(model, 3, ray, end, count, count, NULL, NULL, NULL, NULL, count));
    BAD_NUMBER(leafless_tridexel_copy, first, READ(model, 0, beyond, end, count, count, NULL, NULL, NULL, NULL, count));
    BAD_NUMBER(leafless_tridexel_copy, end, READ(model, 0, ray, beyond, count, count, NULL, NULL, NULL, NULL, count));
    MISALIGNED(leafless_tridexel_copy, ends_model,
               READ(model, 0, ray, end, count, count, (double *)WRONG(out), NULL, NULL, NULL, count));
    MISALIGNED(leafless_tridexel_copy, normals,
               READ(model, 0, ray, end, count, count, NULL, (double *)WRONG(out), NULL, NULL, count));
    MISALIGNED(leafless_tridexel_copy, surfaces,
               READ(model, 0, ray, end, count, count, NULL, NULL, (uint32_t *)WRONG(out), NULL, count));
    MISALIGNED(leafless_tridexel_copy, materials,
               READ(model, 0, ray, end, count, count, NULL, NULL, NULL, (uint32_t *)WRONG(out), count));
#undef READ
#define CELLS(model, axis, first, end, ends, count) leafless_tridexel_copy_cells(model, axis, first, end, ends, 1, count)
    NULL_POINTER(leafless_tridexel_copy_cells, tridexel, CELLS(NULL, 0, ray, end, doubles, count));
    NULL_POINTER(leafless_tridexel_copy_cells, first, CELLS(model, 0, NULL, end, doubles, count));
    NULL_POINTER(leafless_tridexel_copy_cells, end, CELLS(model, 0, ray, NULL, doubles, count));
    NULL_POINTER(leafless_tridexel_copy_cells, ends_cells, CELLS(model, 0, ray, end, NULL, count));
    NULL_POINTER(leafless_tridexel_copy_cells, interval_count, CELLS(model, 0, ray, end, doubles, NULL));
    BAD_NUMBER(leafless_tridexel_copy_cells, axis, CELLS(model, 3, ray, end, doubles, count));
    BAD_NUMBER(leafless_tridexel_copy_cells, end, CELLS(model, 0, ray, beyond, doubles, count));
    MISALIGNED(leafless_tridexel_copy_cells, ends_cells, CELLS(model, 0, ray, end, (double *)WRONG(out), count));
#undef CELLS
    BAD_NUMBER(leafless_tridexel_copy_cells, ends_cells,
               leafless_tridexel_copy_cells(model, 0, ray, end, doubles, UINT64_MAX, count));
    BAD_NUMBER(leafless_tridexel_copy, ends_model,
               leafless_tridexel_copy(model, 0, ray, end, NULL, 0, count, doubles, NULL, NULL, NULL, UINT64_MAX, count));
    untouched();
    MAY_BE_NULL(leafless_tridexel_copy, ends_model,
                leafless_tridexel_copy(model, 0, NULL, NULL, NULL, 0, &found, NULL, NULL, NULL, NULL, 0, &also));
    MAY_BE_NULL(leafless_tridexel_copy, normals,
                leafless_tridexel_copy(model, 1, ray, end, NULL, 0, &found, doubles, NULL, numbers + 8, numbers + 10, 1, &also));
    MAY_BE_NULL(leafless_tridexel_copy, surfaces,
                leafless_tridexel_copy(model, 1, ray, end, NULL, 0, &found, NULL, doubles, NULL, NULL, 1, &also));
    MAY_BE_NULL(leafless_tridexel_copy, materials,
                leafless_tridexel_copy(model, 1, ray, end, NULL, 0, &found, NULL, NULL, numbers, NULL, 1, &also));
    CHECK(found == 2 && also == 1);
}

static void operations(void) {
    void *out = fresh(), *never = UNTOUCHED;
    leafless_tridexel **result = (leafless_tridexel **)&never, *other = NULL;
    const leafless_tridexel *list[2];
    leafless_tridexel_format format;
    uint64_t number;
    uint32_t operation;
    OK(leafless_init(&format, sizeof format));
    list[0] = list[1] = model;
#define COMBINE(tridexels, count, options, result) leafless_tridexel_combine(operation, tridexels, count, options, result)
    for (operation = 0; operation < 4; operation++) {
        NULL_POINTER(leafless_tridexel_combine, tridexels, COMBINE(NULL, 2, NULL, result));
        BAD_NUMBER(leafless_tridexel_combine, count, COMBINE(list, 0, NULL, result));
        BAD_NUMBER(leafless_tridexel_combine, count, COMBINE(NULL, 0, NULL, result));
        BAD_NUMBER(leafless_tridexel_combine, tridexels, COMBINE(list, UINT64_MAX, NULL, result));
        NULL_POINTER(leafless_tridexel_combine, result, COMBINE(list, 2, NULL, NULL));
        MISALIGNED(leafless_tridexel_combine, result, COMBINE(list, 2, NULL, (leafless_tridexel **)WRONG(out)));
        MISALIGNED(leafless_tridexel_combine, options, COMBINE(list, 2, (leafless_options *)WRONG(out), result));
        MISALIGNED(leafless_tridexel_combine, tridexels,
                   COMBINE((const leafless_tridexel *const *)WRONG(list), 1, NULL, result));
        list[1] = NULL;
        NULL_POINTER(leafless_tridexel_combine, tridexels, COMBINE(list, 2, NULL, result));
        list[0] = NULL, list[1] = model;
        NULL_POINTER(leafless_tridexel_combine, tridexels, COMBINE(list, 2, NULL, result));
        list[0] = (const leafless_tridexel *)WRONG(model);
        MISALIGNED(leafless_tridexel_combine, tridexels, COMBINE(list, 2, NULL, result));
        list[0] = model;
        for (number = 1; number <= 2; number++) {
            MAY_BE_NULL(leafless_tridexel_combine, options, COMBINE(list, number, NULL, &other));
            leafless_tridexel_free(other);
        }
    }
    /* No operations. */
    BAD_NUMBER(leafless_tridexel_combine, operation, COMBINE(list, 2, NULL, result));
    operation = UINT32_MAX;
    BAD_NUMBER(leafless_tridexel_combine, operation, COMBINE(list, 2, NULL, result));
#undef COMBINE
    NULL_POINTER(leafless_tridexel_complement, tridexel, leafless_tridexel_complement(NULL, NULL, result));
    NULL_POINTER(leafless_tridexel_complement, result, leafless_tridexel_complement(model, NULL, NULL));
    MAY_BE_NULL(leafless_tridexel_complement, options, leafless_tridexel_complement(model, NULL, &other));
    leafless_tridexel_free(other);
    NULL_POINTER(leafless_tridexel_with_format, tridexel, leafless_tridexel_with_format(NULL, &format, NULL, result));
    NULL_POINTER(leafless_tridexel_with_format, result, leafless_tridexel_with_format(model, &format, NULL, NULL));
    MAY_BE_NULL(leafless_tridexel_with_format, format, leafless_tridexel_with_format(model, NULL, NULL, &other));
    leafless_tridexel_free(other);
    MAY_BE_NULL(leafless_tridexel_with_format, options, leafless_tridexel_with_format(model, &format, NULL, &other));
    leafless_tridexel_free(other);
    NULL_POINTER(leafless_tridexel_with_material, tridexel, leafless_tridexel_with_material(NULL, 1, NULL, result));
    NULL_POINTER(leafless_tridexel_with_material, result, leafless_tridexel_with_material(model, 1, NULL, NULL));
    MAY_BE_NULL(leafless_tridexel_with_material, options, leafless_tridexel_with_material(model, 1, NULL, &other));
    leafless_tridexel_free(other);
    untouched();
    CHECK(never == UNTOUCHED);
}

static void facts(void) {
    void *out = fresh(), *never = UNTOUCHED;
    leafless_tridexel **result = (leafless_tridexel **)&never, *other = NULL;
    const char **text = (const char **)out;
    size_t *length = (size_t *)out;
    uint64_t *count = (uint64_t *)out;
    NULL_POINTER(leafless_tridexel_with_metadata, tridexel, leafless_tridexel_with_metadata(NULL, "k", 1, "v", 1, result));
    NULL_POINTER(leafless_tridexel_with_metadata, key, leafless_tridexel_with_metadata(model, NULL, 1, "v", 1, result));
    NULL_POINTER(leafless_tridexel_with_metadata, value, leafless_tridexel_with_metadata(model, "k", 1, NULL, 1, result));
    NULL_POINTER(leafless_tridexel_with_metadata, named, leafless_tridexel_with_metadata(model, "k", 1, "v", 1, NULL));
    NULL_POINTER(leafless_tridexel_without_metadata, tridexel, leafless_tridexel_without_metadata(NULL, "k", 1, result));
    NULL_POINTER(leafless_tridexel_without_metadata, unnamed, leafless_tridexel_without_metadata(model, "k", 1, NULL));
    MAY_BE_NULL(leafless_tridexel_without_metadata, key, leafless_tridexel_without_metadata(model, NULL, 0, &other));
    leafless_tridexel_free(other);
    NULL_POINTER(leafless_tridexel_peek_metadata, tridexel, leafless_tridexel_peek_metadata(NULL, "k", 1, text, length));
    NULL_POINTER(leafless_tridexel_peek_metadata, key, leafless_tridexel_peek_metadata(model, NULL, 1, text, length));
    NULL_POINTER(leafless_tridexel_peek_metadata, value, leafless_tridexel_peek_metadata(model, "k", 1, NULL, length));
    NULL_POINTER(leafless_tridexel_peek_metadata, value_length, leafless_tridexel_peek_metadata(model, "k", 1, text, NULL));
#define PEEK(model, count, key, key_length, value, value_length) \
    leafless_tridexel_peek_metadata_at(model, 0, count, key, key_length, value, value_length)
    NULL_POINTER(leafless_tridexel_peek_metadata_at, tridexel, PEEK(NULL, count, NULL, NULL, NULL, NULL));
    NULL_POINTER(leafless_tridexel_peek_metadata_at, count, PEEK(model, NULL, NULL, NULL, NULL, NULL));
    NULL_POINTER(leafless_tridexel_peek_metadata_at, key, PEEK(model, count, NULL, length, text, length));
    NULL_POINTER(leafless_tridexel_peek_metadata_at, key_length, PEEK(model, count, text, NULL, text, length));
    NULL_POINTER(leafless_tridexel_peek_metadata_at, value, PEEK(model, count, text, length, NULL, length));
    NULL_POINTER(leafless_tridexel_peek_metadata_at, value_length, PEEK(model, count, text, length, text, NULL));
    BAD_NUMBER(leafless_tridexel_peek_metadata_at, index, PEEK(model, count, text, length, text, length));
#undef PEEK
    untouched();
    CHECK(never == UNTOUCHED);
}

static void uses(void) {
    void *out = fresh(), *never = UNTOUCHED;
    leafless_dexel_surface_report *report = (leafless_dexel_surface_report *)out;
    leafless_mesh **mesh = (leafless_mesh **)&never, *made = NULL;
    leafless_octree **octree = (leafless_octree **)&never, *tree = NULL;
    leafless_solid **result = (leafless_solid **)&never, *again = NULL;
    leafless_long_voxel *voxels = (leafless_long_voxel *)out;
    uint64_t *count = (uint64_t *)out, number = 0;
    NULL_POINTER(leafless_tridexel_surface, tridexel, leafless_tridexel_surface(NULL, 0, NULL, report, mesh));
    NULL_POINTER(leafless_tridexel_surface, mesh, leafless_tridexel_surface(model, 0, NULL, report, NULL));
    BAD_NUMBER(leafless_tridexel_surface, method, leafless_tridexel_surface(model, 2, NULL, report, mesh));
    BAD_NUMBER(leafless_tridexel_surface, method, leafless_tridexel_surface(model, UINT32_MAX, NULL, report, mesh));
    MISALIGNED(leafless_tridexel_surface, report,
               leafless_tridexel_surface(model, 0, NULL, (leafless_dexel_surface_report *)WRONG(out), mesh));
    MAY_BE_NULL(leafless_tridexel_surface, report, leafless_tridexel_surface(model, 0, NULL, NULL, &made));
    leafless_mesh_free(made);
    MAY_BE_NULL(leafless_tridexel_surface, options, leafless_tridexel_surface(model, 1, NULL, NULL, &made));
    leafless_mesh_free(made);
    NULL_POINTER(leafless_octree_from_tridexel, tridexel, leafless_octree_from_tridexel(NULL, NULL, octree));
    NULL_POINTER(leafless_octree_from_tridexel, octree, leafless_octree_from_tridexel(model, NULL, NULL));
    MAY_BE_NULL(leafless_octree_from_tridexel, options, leafless_octree_from_tridexel(model, NULL, &tree));
    leafless_octree_free(tree);
    NULL_POINTER(leafless_octree_from_tridexel_ends, tridexel, leafless_octree_from_tridexel_ends(NULL, NULL, octree));
    NULL_POINTER(leafless_octree_from_tridexel_ends, octree, leafless_octree_from_tridexel_ends(model, NULL, NULL));
    MAY_BE_NULL(leafless_octree_from_tridexel_ends, options, leafless_octree_from_tridexel_ends(model, NULL, &tree));
    leafless_octree_free(tree);
    NULL_POINTER(leafless_solid_from_tridexel, tridexel, leafless_solid_from_tridexel(NULL, false, NULL, result));
    NULL_POINTER(leafless_solid_from_tridexel, solid, leafless_solid_from_tridexel(model, false, NULL, NULL));
    MAY_BE_NULL(leafless_solid_from_tridexel, options, leafless_solid_from_tridexel(model, true, NULL, &again));
    leafless_solid_free(again);
    NULL_POINTER(leafless_tridexel_voxels, tridexel, leafless_tridexel_voxels(NULL, NULL, NULL, 0, voxels, 1, count));
    NULL_POINTER(leafless_tridexel_voxels, voxels, leafless_tridexel_voxels(model, NULL, NULL, 0, NULL, 1, count));
    NULL_POINTER(leafless_tridexel_voxels, count, leafless_tridexel_voxels(model, NULL, NULL, 0, voxels, 1, NULL));
    BAD_NUMBER(leafless_tridexel_voxels, voxels, leafless_tridexel_voxels(model, NULL, NULL, 0, voxels, UINT64_MAX, count));
    NULL_POINTER(leafless_tridexel_voxels, colours, leafless_tridexel_voxels(model, NULL, NULL, 1, voxels, 1, count));
    BAD_NUMBER(leafless_tridexel_voxels, colours,
               leafless_tridexel_voxels(model, NULL, (const uint8_t *)out, UINT64_MAX, voxels, 1, count));
    MAY_BE_NULL(leafless_tridexel_voxels, options, leafless_tridexel_voxels(model, NULL, NULL, 0, NULL, 0, &number));
    untouched();
    CHECK(never == UNTOUCHED && number > 0);
}

static void arrays(void) {
    void *out = fresh(), *never = UNTOUCHED;
    static const uint64_t offsets[2] = {0, 1};
    static const double ends[2] = {-0.5, 0.25};
    leafless_tridexel **result = (leafless_tridexel **)&never, *other = NULL;
    leafless_tridexel_format format;
    leafless_tridexel_arrays rays, good;
    OK(leafless_init(&format, sizeof format));
    memset(&rays, 0, sizeof rays);
    rays.first[0] = rays.first[1] = 3;
    rays.end[0] = rays.end[1] = 4;
    rays.offsets = offsets;
    rays.interval_count = 1;
    rays.ends_model = ends;
    good = rays;
    NULL_POINTER(leafless_tridexel_new, frame, leafless_tridexel_new(NULL, &format, &rays, 1, NULL, result));
    NULL_POINTER(leafless_tridexel_new, rays, leafless_tridexel_new(&frame, &format, NULL, 1, NULL, result));
    NULL_POINTER(leafless_tridexel_new, tridexel, leafless_tridexel_new(&frame, &format, &rays, 1, NULL, NULL));
    MISALIGNED(leafless_tridexel_new, rays,
               leafless_tridexel_new(&frame, &format, (leafless_tridexel_arrays *)WRONG(out), 1, NULL, result));
    BAD_NUMBER(leafless_tridexel_new, count, leafless_tridexel_new(&frame, &format, &rays, 0, NULL, result));
    BAD_NUMBER(leafless_tridexel_new, count, leafless_tridexel_new(&frame, &format, &rays, UINT64_MAX, NULL, result));
    rays.offsets = NULL;
    NULL_POINTER(leafless_tridexel_new, rays.offsets, leafless_tridexel_new(&frame, &format, &rays, 1, NULL, result));
    rays = good;
    rays.ends_model = NULL;
    NULL_POINTER(leafless_tridexel_new, rays.ends_model, leafless_tridexel_new(&frame, &format, &rays, 1, NULL, result));
    rays.ends_model = (const double *)WRONG(out);
    MISALIGNED(leafless_tridexel_new, rays.ends_model, leafless_tridexel_new(&frame, &format, &rays, 1, NULL, result));
    rays.ends_model = NULL;
    rays.ends_cells = (const double *)WRONG(out);
    MISALIGNED(leafless_tridexel_new, rays.ends_cells, leafless_tridexel_new(&frame, &format, &rays, 1, NULL, result));
    rays.ends_cells = ends;
    BAD_NUMBER(leafless_tridexel_new, rays.ends_cells, leafless_tridexel_new(&frame, &format, &rays, 1, NULL, result));
    rays = good;
    rays.normals = (const double *)WRONG(out);
    MISALIGNED(leafless_tridexel_new, rays.normals, leafless_tridexel_new(&frame, &format, &rays, 1, NULL, result));
    rays = good;
    rays.surfaces = (const uint32_t *)WRONG(out);
    MISALIGNED(leafless_tridexel_new, rays.surfaces, leafless_tridexel_new(&frame, &format, &rays, 1, NULL, result));
    rays = good;
    rays.materials = (const uint32_t *)WRONG(out);
    MISALIGNED(leafless_tridexel_new, rays.materials, leafless_tridexel_new(&frame, &format, &rays, 1, NULL, result));
    rays = good;
    rays.interval_count = UINT64_MAX;
    BAD_NUMBER(leafless_tridexel_new, rays.ends_model, leafless_tridexel_new(&frame, &format, &rays, 1, NULL, result));
    rays = good;
    rays.axis = 3;
    BAD_NUMBER(leafless_tridexel_new, rays.axis, leafless_tridexel_new(&frame, &format, &rays, 1, NULL, result));
    rays = good;
    rays.reserved = 1;
    BAD_NUMBER(leafless_tridexel_new, rays.reserved, leafless_tridexel_new(&frame, &format, &rays, 1, NULL, result));
    rays = good;
    rays.end[0] = 17;
    BAD_NUMBER(leafless_tridexel_new, rays.end, leafless_tridexel_new(&frame, &format, &rays, 1, NULL, result));
    rays.end[0] = 2;
    BAD_NUMBER(leafless_tridexel_new, rays.first, leafless_tridexel_new(&frame, &format, &rays, 1, NULL, result));
    rays = good;
    format.directions = LEAFLESS_AXES_Y;
    BAD_NUMBER(leafless_tridexel_new, format.directions, leafless_tridexel_new(&frame, &format, &rays, 1, NULL, result));
    format.directions = 0;
    untouched();
    CHECK(never == UNTOUCHED);
    MAY_BE_NULL(leafless_tridexel_new, format, leafless_tridexel_new(&frame, NULL, &rays, 1, NULL, &other));
    leafless_tridexel_free(other);
    MAY_BE_NULL(leafless_tridexel_new, options, leafless_tridexel_new(&frame, &format, &rays, 1, NULL, &other));
    leafless_tridexel_free(other);
}

static void editors(void) {
    void *out = fresh(), *never = UNTOUCHED;
    leafless_dexel_change *change = (leafless_dexel_change *)out;
    leafless_tridexel *other = NULL;
    NULL_POINTER(leafless_tridexel_editor_new, tridexel, leafless_tridexel_editor_new(NULL, (leafless_tridexel_editor **)&never));
    NULL_POINTER(leafless_tridexel_editor_new, editor, leafless_tridexel_editor_new(model, NULL));
    NULL_POINTER(leafless_tridexel_editor_describe, editor,
                 leafless_tridexel_editor_describe(NULL, (leafless_tridexel_info *)out));
    NULL_POINTER(leafless_tridexel_editor_describe, info, leafless_tridexel_editor_describe(editor, NULL));
    MISALIGNED(leafless_tridexel_editor_describe, info,
               leafless_tridexel_editor_describe(editor, (leafless_tridexel_info *)WRONG(out)));
#define COMBINE(editor, operation, model, change) leafless_tridexel_editor_combine(editor, operation, model, NULL, change)
    NULL_POINTER(leafless_tridexel_editor_combine, editor, COMBINE(NULL, 0, model, change));
    NULL_POINTER(leafless_tridexel_editor_combine, tridexel, COMBINE(editor, 0, NULL, change));
    BAD_NUMBER(leafless_tridexel_editor_combine, operation, COMBINE(editor, 4, model, change));
    BAD_NUMBER(leafless_tridexel_editor_combine, operation, COMBINE(editor, UINT32_MAX, model, change));
    MISALIGNED(leafless_tridexel_editor_combine, change, COMBINE(editor, 0, model, (leafless_dexel_change *)WRONG(out)));
#undef COMBINE
#define COMBINE(editor, operation, solid, change)                                                                        \
    leafless_tridexel_editor_combine_solid(editor, operation, solid, NULL, change)
    NULL_POINTER(leafless_tridexel_editor_combine_solid, editor, COMBINE(NULL, 0, solid, change));
    NULL_POINTER(leafless_tridexel_editor_combine_solid, solid, COMBINE(editor, 0, NULL, change));
    BAD_NUMBER(leafless_tridexel_editor_combine_solid, operation, COMBINE(editor, 4, solid, change));
    BAD_NUMBER(leafless_tridexel_editor_combine_solid, operation, COMBINE(editor, UINT32_MAX, solid, change));
    MISALIGNED(leafless_tridexel_editor_combine_solid, change,
               COMBINE(editor, 0, solid, (leafless_dexel_change *)WRONG(out)));
#undef COMBINE
    MAY_BE_NULL(leafless_tridexel_editor_combine, options, leafless_tridexel_editor_combine(editor, 0, model, NULL, NULL));
    MAY_BE_NULL(leafless_tridexel_editor_combine, change, leafless_tridexel_editor_combine(editor, 0, model, NULL, NULL));
    MAY_BE_NULL(leafless_tridexel_editor_combine_solid, options,
                leafless_tridexel_editor_combine_solid(editor, 1, solid, NULL, NULL));
    MAY_BE_NULL(leafless_tridexel_editor_combine_solid, change,
                leafless_tridexel_editor_combine_solid(editor, 1, solid, NULL, NULL));
    NULL_POINTER(leafless_tridexel_editor_freeze, editor,
                 leafless_tridexel_editor_freeze(NULL, NULL, (leafless_tridexel **)&never));
    NULL_POINTER(leafless_tridexel_editor_freeze, tridexel, leafless_tridexel_editor_freeze(editor, NULL, NULL));
    MAY_BE_NULL(leafless_tridexel_editor_freeze, options, leafless_tridexel_editor_freeze(editor, NULL, &other));
    leafless_tridexel_free(other);
    untouched();
    CHECK(never == UNTOUCHED);
}

int main(void) {
    solid = check_ball_solid();
    OK(leafless_tridexel_build(solid, &frame, LEAFLESS_RULE_SAMPLED, NULL, NULL, &model));
    OK(leafless_tridexel_editor_new(model, &editor));
    models();
    intervals();
    operations();
    facts();
    uses();
    arrays();
    editors();
    /* All of it is as good as ever. */
    OK(leafless_tridexel_check(model));
    leafless_tridexel_editor_free(NULL);
    leafless_tridexel_editor_free(editor);
    leafless_tridexel_free(NULL);
    leafless_tridexel_free(model);
    leafless_solid_free(solid);
    return 0;
}
