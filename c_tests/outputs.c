/* Structs that the library fills: structs of programs compiled with an older or a newer header, and uninitialised ones.
   Every function that fills one is tried. */
#include "check.h"

static leafless_frame frame;
static leafless_mesh *mesh;
static leafless_volume *volume;
static leafless_scene *scene;
static leafless_octree *octree, *extended;
static leafless_cursor *cursor;
static leafless_solid *solid, *other;
static leafless_lazy *lazy;
static leafless_channel *channel;
static leafless_attribute *attribute;
static leafless_tridexel *tridexel;
static leafless_tridexel_editor *editor;
static leafless_boundary *boundary;
static leafless_layout *layout;
static leafless_mass_sum unknown;
static uint8_t *file;
static uint64_t file_length;
static const double zero[3] = {0, 0, 0}, up[3] = {0, 0, 1};

/* The calls of a host. `out` is the struct that the call fills. */
#define OUTPUTS                                                                                                        \
    FILLS(leafless_mesh_info, leafless_mesh_describe(mesh, out))                                                       \
    FILLS(leafless_mesh_report, leafless_mesh_inspect(mesh, out))                                                      \
    FILLS(leafless_mesh_moments, leafless_mesh_measure(mesh, LEAFLESS_FILL_NON_ZERO, NULL, out))                       \
    FILLS(leafless_mesh_file_info, leafless_mesh_read(&off, NULL, out, &made))                                    \
    FILLS(leafless_volume_info, leafless_volume_describe(volume, out))                                                 \
    FILLS(leafless_scene_info, leafless_scene_describe(scene, out))                                                    \
    FILLS(leafless_scene_mesh_info, leafless_scene_describe_mesh_at(scene, 0, out, NULL))                              \
    FILLS(leafless_mesh_report, leafless_scene_describe_mesh_at(scene, 0, &of_scene, out))                             \
    FILLS(leafless_octree_info, leafless_octree_describe(octree, out))                                                 \
    FILLS(leafless_cut_counts, leafless_octree_count_cuts(extended, out))                                              \
    FILLS(leafless_stored_surface_info, leafless_octree_surface_at(extended, 0, out, NULL, 0, NULL, 0))                \
    FILLS(leafless_cursor_info, leafless_cursor_describe(cursor, out))                                                 \
    FILLS(leafless_measures, leafless_solid_measure(solid, &frame, 0.1, 0, NULL, out))                                 \
    FILLS(leafless_mass_sum, leafless_solid_measure_cell(solid, &frame, 1, 3, 0.1, 0, NULL, out))                      \
    FILLS(leafless_mass_sum, leafless_mass_sum_unknown(&frame, 1, 3, out))                                             \
    FILLS(leafless_mass_sum, leafless_mass_sum_add(&unknown, &unknown, out))                                           \
    FILLS(leafless_mass_sum, leafless_mass_sum_subtract(&unknown, &unknown, out))                                      \
    FILLS(leafless_measures, leafless_mass_sum_measures(&unknown, out))                                                \
    FILLS(leafless_surface_area, leafless_solid_surface_area(solid, &frame, 0.1, 0, NULL, out))                        \
    FILLS(leafless_section_area, leafless_solid_section_area(solid, &frame, zero, up, 0.1, 0, NULL, out))              \
    FILLS(leafless_boundary_report, leafless_boundary_describe(boundary, out))                                         \
    FILLS(leafless_single_precision, leafless_mesh_in_single_precision(mesh, 0.1, NULL, out, &made))                   \
    FILLS(leafless_simplified, leafless_mesh_simplify(mesh, 0.1, NULL, out, &made))                                    \
    FILLS(leafless_polyhedron_arrays, leafless_boundary_peek_faces(boundary, out))                                     \
    FILLS(leafless_contour_report, leafless_solid_contour(solid, &frame, frame.edge, NULL, out, &made))                \
    FILLS(leafless_extent, leafless_solid_bounding_box(solid, &frame, 0.1, NULL, out))                                 \
    FILLS(leafless_clearance, leafless_solid_clearance(solid, other, &frame, 0.1, NULL, out))                          \
    FILLS(leafless_deviation, leafless_solid_deviation(solid, other, &frame, 0.1, 1, NULL, out))                       \
    FILLS(leafless_gap, leafless_solid_gap_at_least(solid, other, &frame, 0.1, NULL, out))                             \
    FILLS(leafless_standing, leafless_layout_check(layout, 0, NULL, NULL, 0, out))                                     \
    FILLS(leafless_search_report, leafless_layout_search(layout, NULL, NULL, out))                                     \
    FILLS(leafless_layout_measures, leafless_layout_measure(layout, 0.1, NULL, out))                                   \
    FILLS(leafless_lazy_info, leafless_lazy_describe(lazy, out))                                                       \
    FILLS(leafless_solid_info, leafless_solid_describe(solid, out))                                                    \
    FILLS(leafless_attribute_info, leafless_attribute_describe(attribute, out))                                        \
    FILLS(leafless_channel_info, leafless_channel_describe(channel, out))                                              \
    FILLS(leafless_channel_summary, leafless_channel_summarise(channel, octree, NULL, NULL, NULL, out))                \
    FILLS(leafless_tridexel_info, leafless_tridexel_describe(tridexel, out))                                           \
    FILLS(leafless_tridexel_info, leafless_tridexel_editor_describe(editor, out))                                      \
    FILLS(leafless_dexel_statistics, leafless_tridexel_statistics(tridexel, 0, out))                                   \
    FILLS(leafless_dexel_change, leafless_tridexel_editor_combine(editor, LEAFLESS_OPERATION_UNION, tridexel, NULL, out)) \
    FILLS(leafless_dexel_change, leafless_tridexel_editor_combine_solid(editor, LEAFLESS_OPERATION_UNION, solid, NULL, out)) \
    FILLS(leafless_dexel_surface_report, leafless_tridexel_surface(tridexel, 0, NULL, out, &made))                \
    FILLS(leafless_file_info, leafless_file_describe(&stored, out, NULL, 0))

/* Makes the call number `which`, or returns the size of the struct that it fills. */
static leafless_status call(int which, void *place, const char **name, size_t *size) {
    static const char text[] = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    const leafless_source off = leafless_from_bytes(text, sizeof text - 1, LEAFLESS_ACCESS_COPY);
    const leafless_source stored = leafless_from_bytes(file, file_length, LEAFLESS_ACCESS_MAP);
    leafless_scene_mesh_info of_scene = LEAFLESS_INIT(leafless_scene_mesh_info);
    leafless_mesh *made = NULL;
    leafless_status status = LEAFLESS_E_ARGUMENT;
    int at = 0;
    (void)off;
    (void)stored;
#define FILLS(type, function)                \
    if (which == at++) {                     \
        type *const out = (type *)place;     \
        *name = #function;                   \
        *size = sizeof(type);                \
        if (out != NULL) status = (function); \
    }
    OUTPUTS
#undef FILLS
    if (which >= at) *name = NULL;
    leafless_mesh_free(made);
    return status;
}

/* Sets all bytes behind the size. */
static void prepare(unsigned char *bytes, uint32_t size, int pattern) {
    memset(bytes, pattern, 8192);
    memcpy(bytes, &size, sizeof size);
}

/* Whether nothing but bytes [4, end) was written. */
static bool ends(const unsigned char *bytes, size_t end, uint32_t size, int pattern) {
    size_t i;
    for (i = end < 4 ? 4 : end; i < 8192; i++) {
        if (bytes[i] != pattern) return false;
    }
    return memcmp(bytes, &size, sizeof size) == 0;
}

static void fills(int which) {
    static const uint32_t nonsense[] = {0, 1, 2, 3, 5, 4097, 4104, 1u << 20, UINT32_MAX};
    static union {
        unsigned char bytes[8192];
        double aligned;
    } full, part;
    const char *name;
    size_t known, size, i;
    (void)call(which, NULL, &name, &known);
    prepare(full.bytes, (uint32_t)known, 0x11);
    OK(call(which, full.bytes, &name, &known));
    CHECK(ends(full.bytes, known, (uint32_t)known, 0x11));
    /* Something was written. (Behind the size may be a gap.) */
    for (i = 8; i < known && full.bytes[i] == 0x11; i++) {
    }
    CHECK(i < known);
    /* Older programs, and newer ones; all structs but one are aligned like doubles. */
    for (size = 8; size <= 4096; size += size < known + 64 ? 8 : 1016) {
        prepare(part.bytes, (uint32_t)size, 0x5a);
        OK(call(which, part.bytes, &name, &known));
        if (!ends(part.bytes, size < known ? size : known, (uint32_t)size, 0x5a)) {
            fprintf(stderr, "%s with a struct of %lu bytes of %lu\n", name, (unsigned long)size, (unsigned long)known);
            exit(1);
        }
    }
    for (i = 0; i < COUNT(nonsense); i++) {
        prepare(part.bytes, nonsense[i], 0x5a);
        FAILS(LEAFLESS_E_ARGUMENT, call(which, part.bytes, &name, &known));
        CHECK(ends(part.bytes, 0, nonsense[i], 0x5a));
    }
}

/* The fields that an older program has are the same. */
static void values(void) {
    leafless_octree_info all = LEAFLESS_INIT(leafless_octree_info), few = LEAFLESS_INIT(leafless_octree_info);
    leafless_measures most = LEAFLESS_INIT(leafless_measures), least = LEAFLESS_INIT(leafless_measures);
    OK(leafless_octree_describe(octree, &all));
    few.struct_size = offsetof(leafless_octree_info, bytes);
    OK(leafless_octree_describe(octree, &few));
    CHECK(few.elements == all.elements && few.bricks == all.bricks && few.frame.depth == 4 && all.elements > 0);
    CHECK(all.bytes > 0 && few.bytes == 0 && few.root == 0 && all.root == LEAFLESS_TAG_BRANCH);
    OK(leafless_solid_measure(solid, &frame, 0.1, 0, NULL, &most));
    least.struct_size = offsetof(leafless_measures, centroid_model);
    OK(leafless_solid_measure(solid, &frame, 0.1, 0, NULL, &least));
    CHECK(least.volume_model.lower == most.volume_model.lower && most.volume_model.lower > 1);
    CHECK(least.centroid_model[0].lower == 0 && least.centroid_model[0].upper == 0 && most.has_centroid);
}

int main(void) {
    static const char text[] = "polyhedron(points = [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], faces = [[0,1,2],[0,3,1],[0,2,3],[1,3,2]]);";
    static const uint8_t samples[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    const leafless_source of_text = leafless_from_bytes(text, sizeof text - 1, LEAFLESS_ACCESS_COPY);
    const leafless_source of_samples = leafless_from_bytes(samples, 8, LEAFLESS_ACCESS_COPY);
    const double far_centre[3] = {0.9, 0.9, 0.9}, one = 1;
    leafless_volume_layout samples_layout = LEAFLESS_INIT(leafless_volume_layout);
    const double low[3] = {-2, -2, -2}, high[3] = {2, 2, 2}, unit[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    leafless_solid *container = NULL;
    leafless_bay *bay = NULL;
    uint64_t number;
    const char *name;
    size_t size;
    int which;
    frame = check_frame(4);
    mesh = check_cube();
    solid = check_ball_solid();
    OK(leafless_solid_new_ball(far_centre, 0.0625, &other));
    octree = check_ball(4, LEAFLESS_RULE_CERTIFIED);
    OK(leafless_octree_build_extended(solid, &frame, NULL, NULL, &extended));
    file = check_bytes(octree, &file_length);
    samples_layout.extents[0] = samples_layout.extents[1] = samples_layout.extents[2] = 2;
    samples_layout.spacing_model[0] = samples_layout.spacing_model[1] = samples_layout.spacing_model[2] = 1;
    OK(leafless_volume_new(&samples_layout, &of_samples, &volume));
    OK(leafless_scene_read(&of_text, NULL, &scene));
    OK(leafless_cursor_new(octree, &cursor));
    OK(leafless_lazy_new(solid, &frame, &lazy));
    OK(leafless_attribute_new_constant(&one, 1, &attribute));
    OK(leafless_channel_fill(attribute, &frame, NULL, NULL, &channel));
    OK(leafless_tridexel_build(solid, &frame, LEAFLESS_RULE_SAMPLED, NULL, NULL, &tridexel));
    OK(leafless_tridexel_editor_new(tridexel, &editor));
    OK(leafless_solid_boundary(solid, &frame, frame.edge, NULL, &boundary));
    OK(leafless_solid_new_box(low, high, &container));
    OK(leafless_bay_new(container, 0, 0, &bay));
    OK(leafless_bay_add_item(bay, solid, 1, NULL, &number));
    OK(leafless_layout_new(bay, NULL, &layout));
    OK(leafless_layout_place(layout, 0, unit, &number));
    unknown = LEAFLESS_INIT(leafless_mass_sum);
    OK(leafless_mass_sum_unknown(&frame, 1, 5, &unknown));
    leafless_bay_free(bay);
    leafless_solid_free(container);
    for (which = 0;; which++) {
        (void)call(which, NULL, &name, &size);
        if (name == NULL) break;
        fills(which);
    }
    CHECK(which >= 20);
    values();
    leafless_octree_free(extended);
    leafless_tridexel_editor_free(editor);
    leafless_boundary_free(boundary);
    leafless_layout_free(layout);
    leafless_tridexel_free(tridexel);
    leafless_channel_free(channel);
    leafless_attribute_free(attribute);
    leafless_lazy_free(lazy);
    leafless_cursor_free(cursor);
    leafless_scene_free(scene);
    leafless_volume_free(volume);
    free(file);
    leafless_octree_free(octree);
    leafless_solid_free(other);
    leafless_solid_free(solid);
    leafless_mesh_free(mesh);
    return 0;
}
