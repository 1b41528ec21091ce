/* Calls with a pointer that is NULL or misaligned, or with a number that is out of range. refused.rs generates these
 * calls from the header. This file has the checks of a call, and valid objects and structs for all other parameters. */
#include "check.h"

/* Variables for all structs with a struct_size that functions read, each with the name of its type. */
#include "refused_structs.h"

/* --- The checks of a call */

#define WRONG(...) ((void *)((uintptr_t)(__VA_ARGS__) + 1))

enum { ROOM = 65536, CHECKED = 1024, OUTPUTS = 16 };

/* The outputs of a call. Before a call the first bytes of each are 0x5a, behind a struct_size if it has one. */
static struct output {
    unsigned char *bytes;
    uint32_t struct_size;
    bool may_change;
} outputs[OUTPUTS];
static size_t output_count;
static int failures;

static void *at(size_t output) {
    return outputs[output].bytes;
}

static void *taken(size_t output) {
    void *object;
    memcpy(&object, at(output), sizeof object);
    return object;
}

/* Starts the calls of a function. */
static void begin(size_t count) {
    CHECK(count <= OUTPUTS);
    for (output_count = 0; output_count < count; output_count++) {
        struct output *output = &outputs[output_count];
        if (output->bytes == NULL) {
            output->bytes = (unsigned char *)malloc(ROOM);
            CHECK(output->bytes != NULL);
        }
        output->struct_size = 0;
        output->may_change = false;
    }
}

static void prepare(void) {
    size_t i;
    for (i = 0; i < output_count; i++) {
        memset(outputs[i].bytes, 0x5a, CHECKED);
        if (outputs[i].struct_size != 0) {
            memcpy(outputs[i].bytes, &outputs[i].struct_size, sizeof outputs[i].struct_size);
        }
    }
}

static bool is_written(const struct output *output) {
    const size_t start = output->struct_size != 0 ? sizeof output->struct_size : 0;
    size_t i = start;
    while (i < CHECKED && output->bytes[i] == 0x5a) {
        i++;
    }
    return i < CHECKED || memcmp(output->bytes, &output->struct_size, start) != 0;
}

/* The call failed with this status and a message with this word, and wrote nothing. */
static void refused(leafless_status expected, const char *function, const char *word, leafless_status found) {
    char message[512] = "";
    size_t i;
    (void)leafless_last_error(message, sizeof message);
    if (found != expected) {
        fprintf(stderr, "%s with a bad `%s`: %s instead of %s: %s\n", function, word, leafless_status_name(found),
                leafless_status_name(expected), found == LEAFLESS_OK ? "" : message);
        failures++;
        return;
    }
    if (leafless_last_status() != expected || strstr(message, word) == NULL) {
        fprintf(stderr, "%s with a bad `%s` says only \"%s\"\n", function, word, message);
        failures++;
    }
    for (i = 0; i < output_count; i++) {
        if (!outputs[i].may_change && is_written(&outputs[i])) {
            fprintf(stderr, "%s with a bad `%s` writes its result %d\n", function, word, (int)i);
            failures++;
        }
    }
}

static bool accepted(const char *function, const char *without, leafless_status found) {
    char message[512];
    if (found == LEAFLESS_OK) {
        return true;
    }
    (void)leafless_last_error(message, sizeof message);
    fprintf(stderr, "%s %s: %s: %s\n", function, without, leafless_status_name(found), message);
    failures++;
    return false;
}

/* --- Numbers and structs */

static const leafless_frame frame = {{-1, -1, -1}, 2, 4}, lattice = {{0, 0, 0}, 1, 4};
static const leafless_interval interval = {0.5, 1.5};
static const leafless_ray ray = {{-2, 0, 0}, {1, 0, 0}, INFINITY};
static const leafless_shard shard = {0, 1, LEAFLESS_SHARD_KIND_TOP};
static const leafless_cell cell = {{0, 0, 0}, 0, LEAFLESS_TAG_FULL};
static const leafless_carry_rule carry_rule = {"a", 1, 0};
static const leafless_legend_name legend_name = {"a", 1, {0, 0, 0, 0}, 0};
static leafless_tridexel_arrays tridexel_arrays;

static const double point_model[3] = {0.1, 0.2, 0.3}, min_model[3] = {-0.5, -0.5, -0.5}, max_model[3] = {0.5, 0.5, 0.5};
static const double normal[3] = {0, 0, 1}, plane[4] = {0, 0, 1, 0}, box_model[6] = {-1, -1, -1, 1, 1, 1};
static const double points_model[6] = {0, 0, 0, 0.5, 0.5, 0.5}, polygon_model[6] = {0, 0, 1, 0, 0, 1};
static const double matrix[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
static const double mirror[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0};
static const double longer[12] = {1.001, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
static const double planes[24] = {1, 0, 0, 1, -1, 0, 0, 1, 0, 1, 0, 1, 0, -1, 0, 1, 0, 0, 1, 1, 0, 0, -1, 1};
static const double quadric[10] = {1, 1, 1, 0, 0, 0, 0, 0, 0, -1}, one[1] = {1}, values[12] = {0};
static const double ends[2] = {-0.5, 0.25};
static const double corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
static const uint32_t faces_of_corners[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3}, loops[5] = {0, 3, 6, 9, 12};
static const uint32_t min_cell[3] = {0, 0, 0}, max_cell[3] = {2, 2, 2}, first[2] = {0, 0}, end[2] = {16, 16};
static const uint32_t middle[2] = {8, 8}, exponents[3] = {2, 2, 2};
static const int32_t direction[3] = {0, 0, 1}, axes[3] = {1, 2, 3}, offset_cells[3] = {0, 0, 0};
static const uint64_t offsets[2] = {0, 1}, codes[2] = {0, 8}, octants[8] = {0, 1, 2, 3, 4, 5, 6, 7};
static const uint8_t levels[2] = {3, 3}, kinds[2] = {2, 1};
static const uint8_t samples[8] = {0, 1, 2, 3, 4, 5, 6, 7}, colours[4 * 16 * 16] = {0};
static const char nrrd[] = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: x\n";
static const char whole[] = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 1 1\nencoding: raw\n\n12";

/* A mesh file whose material has a name, and one that is read with a warning. */
static const char obj[] = "v 0 0 0\nv 3 0 0\nv 0 3 0\nv 0 0 3\nusemtl steel\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
static const char ply[] = "ply\nformat ascii 1.0\nby hand\nelement vertex 4\nproperty float x\nproperty float y\n"
                          "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
                          "0 0 0\n3 0 0\n0 3 0\n0 0 3\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

static int32_t classify(void *ctx, const double *min, const double *max) {
    (void)ctx;
    return min[0] >= 0.0 ? LEAFLESS_TAG_FULL : max[0] <= 0.0 ? LEAFLESS_TAG_EMPTY : LEAFLESS_TAG_PARTIAL;
}

static int32_t value_at(void *ctx, const double *where, double *result) {
    (void)ctx;
    *result = where[0];
    return 0;
}

static int32_t range_in(void *ctx, const double *min, const double *max, leafless_interval *result) {
    (void)ctx;
    result->lower = min[0];
    result->upper = max[0];
    return 0;
}

static int32_t take(void *ctx, const uint8_t *bytes, uint64_t count) {
    (void)ctx, (void)bytes, (void)count;
    return 0;
}

/* --- Objects: HANDLE(type, call that makes one), in the order in which they are made */

#define HANDLE(type, call)             \
    static leafless_##type *type;      \
    static void new_##type(void) {     \
        leafless_##type##_free(type);  \
        type = NULL;                   \
        OK(call);                      \
    }

static leafless_mesh *named, *warned;
static leafless_octree *extended, *uniform, *frozen, *shards[9];
static leafless_solid *halfspace;
static leafless_statistics joined_levels[64];
static uint64_t joined_count, sink_length = 77;
static uint8_t no_bytes[8];
static uint8_t *octree_bytes, *tridexel_bytes;
static leafless_source octree_source, tridexel_source, mesh_source, warned_source, scene_source;
static leafless_source nrrd_source, nrrd_whole;
static leafless_sink file_sink;
static leafless_surface_options outer_surface;
static leafless_volume_layout wide_layout;
static leafless_operation operation;

static leafless_status make_mesh(leafless_mesh **made) {
    leafless_mesh *bare = check_cube();
    leafless_attribute *attribute = NULL;
    leafless_status status;
    OK(leafless_attribute_new_constant(one, 1, &attribute));
    status = leafless_mesh_with_values(bare, attribute, "a", 1, 0, NULL, made);
    leafless_attribute_free(attribute);
    leafless_mesh_free(bare);
    return status;
}

/* With a channel and an entry of the metadata. */
static leafless_status make_octree(const leafless_channel *channel, leafless_octree **made) {
    leafless_octree *bare = check_ball(4, LEAFLESS_RULE_CERTIFIED), *bearing = NULL;
    leafless_status status;
    OK(leafless_octree_with_channel(bare, channel, &bearing));
    status = leafless_octree_with_metadata(bearing, "k", 1, "v", 1, made);
    leafless_octree_free(bare);
    leafless_octree_free(bearing);
    return status;
}

static leafless_status make_channel(const leafless_attribute *attribute, leafless_channel **made) {
    leafless_channel_fill_options fill = LEAFLESS_INIT(leafless_channel_fill_options);
    leafless_channel *bare = NULL;
    leafless_status status;
    fill.name = "a";
    fill.name_length = 1;
    OK(leafless_channel_fill(attribute, &frame, &fill, NULL, &bare));
    status = leafless_channel_with_metadata(bare, "k", 1, "v", 1, made);
    leafless_channel_free(bare);
    return status;
}

static leafless_status make_tridexel(const leafless_solid *solid, leafless_tridexel **made) {
    leafless_tridexel *bare = NULL;
    leafless_status status;
    OK(leafless_tridexel_build(solid, &frame, LEAFLESS_RULE_SAMPLED, NULL, NULL, &bare));
    status = leafless_tridexel_with_metadata(bare, "k", 1, "v", 1, made);
    leafless_tridexel_free(bare);
    return status;
}

static leafless_status make_bay(const leafless_solid *solid, leafless_bay **made) {
    static const double corner[3] = {-2, -2, -2}, other[3] = {2, 2, 2};
    leafless_solid *container = NULL;
    leafless_status status;
    uint64_t number;
    OK(leafless_solid_new_box(corner, other, &container));
    status = leafless_bay_new(container, 0.1, 0.1, made);
    leafless_solid_free(container);
    return status == LEAFLESS_OK ? leafless_bay_add_item(*made, solid, 2, NULL, &number) : status;
}

static leafless_status make_layout(const leafless_bay *bay, leafless_layout **made) {
    uint64_t number;
    const leafless_status status = leafless_layout_new(bay, NULL, made);
    return status == LEAFLESS_OK ? leafless_layout_place(*made, 0, matrix, &number) : status;
}

HANDLE(control, leafless_control_new(&control))
HANDLE(solid, leafless_solid_new_ball(values, 0.75, &solid))
HANDLE(attribute, leafless_attribute_new_constant(one, 1, &attribute))
HANDLE(channel, make_channel(attribute, &channel))
HANDLE(mesh, make_mesh(&mesh))
HANDLE(octree, make_octree(channel, &octree))
HANDLE(volume, leafless_volume_new(&volume_layout, &source, &volume))
HANDLE(scene, leafless_scene_read(&scene_source, NULL, &scene))
HANDLE(point_cursor, leafless_point_cursor_new(octree, &point_cursor))
HANDLE(point_table, leafless_point_table_new(octree, 2, &point_table, at(0)))
HANDLE(cursor, leafless_cursor_new(octree, &cursor))
HANDLE(cells, leafless_cells_new(octree, LEAFLESS_TAGS_LEAVES, 0, 20, NULL, NULL, &cells))
HANDLE(faces, leafless_faces_new(octree, LEAFLESS_TAGS_FULL, 0, 20, NULL, NULL, &faces))
HANDLE(columns, leafless_octree_columns(octree, 0, first, end, &columns))
HANDLE(bay, make_bay(solid, &bay))
HANDLE(layout, make_layout(bay, &layout))
HANDLE(lazy, leafless_lazy_new(solid, &frame, &lazy))
HANDLE(boundary, leafless_solid_boundary(solid, &frame, 2, NULL, &boundary))
HANDLE(tridexel, make_tridexel(solid, &tridexel))
HANDLE(tridexel_editor, leafless_tridexel_editor_new(tridexel, &tridexel_editor))
HANDLE(layer, leafless_layer_from_octree(octree, NULL, &layer))

/* Before the objects: what structs need beside their defaults. */
static void fill_structs(void) {
    static const double camera_points[6] = {0, 0, 0, 1, 1, 1};
    uint8_t cube[84 + 50 * 12];
    uint64_t length;
    leafless_mesh *made = check_cube();
    OK(mesh_to_stl(made, cube, sizeof cube, &length));
    check_write("cube.stl", cube, (size_t)length);
    leafless_mesh_free(made);
    source = leafless_from_bytes(samples, sizeof samples, LEAFLESS_ACCESS_COPY);
    check_write("cube.csg", "import(\"cube.stl\");", 19);
    scene_source = leafless_from_file("cube.csg", LEAFLESS_ACCESS_COPY);
    mesh_source = leafless_from_bytes(obj, sizeof obj - 1, LEAFLESS_ACCESS_COPY);
    warned_source = leafless_from_bytes(ply, sizeof ply - 1, LEAFLESS_ACCESS_COPY);
    nrrd_whole = leafless_from_bytes(whole, sizeof whole - 1, LEAFLESS_ACCESS_COPY);
    nrrd_source = leafless_from_bytes(nrrd, sizeof nrrd - 1, LEAFLESS_ACCESS_COPY);
    sink = leafless_to_function(take, NULL);
    file_sink = leafless_to_file("refused.off");
    mesh_arrays = check_arrays(CHECK_CUBE, 8, CHECK_CUBE_TRIANGLES, 12);
    polyhedron_arrays.vertices = corners;
    polyhedron_arrays.vertex_count = 4;
    polyhedron_arrays.corners = faces_of_corners;
    polyhedron_arrays.corner_count = 12;
    polyhedron_arrays.loops = loops;
    polyhedron_arrays.loop_count = 4;
    mesh_write_options.format = LEAFLESS_MESH_FORMAT_OFF;
    volume_layout.extents[0] = volume_layout.extents[1] = volume_layout.extents[2] = 2;
    solid_callbacks.classify = classify;
    solid_function.value = value_at;
    solid_function.range = range_in;
    attribute_callbacks.components = 1;
    attribute_callbacks.value = value_at;
    zone.kind = LEAFLESS_ZONE_KIND_POINT;
    voxel_arrays.lattice = lattice;
    voxel_arrays.count = 1;
    voxel_arrays.codes = codes;
    voxel_arrays.levels = levels;
    voxel_arrays.kinds = kinds;
    voxel_arrays.components = 1;
    voxel_arrays.values = values;
    transfer.range_upper = 1;
    outer_surface = surface_options;
    outer_surface.resolve = LEAFLESS_RESOLVE_OUTER;
    wide_layout = volume_layout;
    wide_layout.sample_type = LEAFLESS_SAMPLE_TYPE_U16;
    OK(leafless_camera_fitted(camera_points, 2, 0, 0, 0, 1, &shot.camera));
    shot.width = shot.height = 1;
    tridexel_arrays.first[0] = tridexel_arrays.first[1] = 3;
    tridexel_arrays.end[0] = tridexel_arrays.end[1] = 4;
    tridexel_arrays.offsets = offsets;
    tridexel_arrays.interval_count = 1;
    tridexel_arrays.ends_model = ends;
}

/* After the objects: values that are made of them. */
static void fill_values(void) {
    uint64_t length;
    size_t i;
    octree_bytes = check_bytes(octree, &length);
    octree_source = leafless_from_bytes(octree_bytes, length, LEAFLESS_ACCESS_COPY);
    OK(tridexel_to_bytes(tridexel, NULL, 0, &length));
    tridexel_bytes = (uint8_t *)malloc((size_t)length);
    OK(tridexel_to_bytes(tridexel, tridexel_bytes, length, &length));
    tridexel_source = leafless_from_bytes(tridexel_bytes, length, LEAFLESS_ACCESS_COPY);
    OK(leafless_mesh_read(&mesh_source, NULL, NULL, &named));
    OK(leafless_mesh_read(&warned_source, NULL, NULL, &warned));
    OK(leafless_octree_build_extended(solid, &frame, NULL, NULL, &extended));
    OK(leafless_octree_new_uniform(&frame, LEAFLESS_TAG_FULL, LEAFLESS_TAG_EMPTY, &uniform));
    OK(leafless_lazy_freeze(lazy, NULL, &frozen));
    OK(leafless_solid_new_halfspace(normal, 0, &halfspace));
    OK(leafless_mass_sum_unknown(&frame, 1, 0, &mass_sum));
    for (i = 0; i < 9; i++) {
        leafless_shard part = shard;
        uint64_t count;
        part.kind = i == 0 ? LEAFLESS_SHARD_KIND_TOP : LEAFLESS_SHARD_KIND_BELOW;
        part.code = i == 0 ? 0 : i - 1;
        OK(leafless_octree_shard(octree, &part, NULL, &shards[i]));
        if (i > 0) {
            OK(leafless_octree_levels(shards[i], joined_levels + joined_count, COUNT(joined_levels) - joined_count,
                                      &count));
            joined_count += count;
        }
    }
}

static void free_values(void) {
    size_t i;
    for (i = 0; i < COUNT(shards); i++) {
        leafless_octree_free(shards[i]);
    }
    leafless_octree_free(extended);
    leafless_octree_free(uniform);
    leafless_octree_free(frozen);
    leafless_solid_free(halfspace);
    leafless_mesh_free(named);
    leafless_mesh_free(warned);
    free(octree_bytes);
    free(tridexel_bytes);
    for (i = 0; i < OUTPUTS; i++) {
        free(outputs[i].bytes);
    }
}

/* The functions, and new_objects, free_objects, and init_structs. */
#include "refused_calls.h"

int main(void) {
    begin(OUTPUTS);
    init_structs();
    fill_structs();
    new_objects();
    fill_values();
    call_all();
    CHECK(fopen("a", "rb") == NULL && sink_length == 77);
    CHECK(leafless_last_error(NULL, 0) > 0 && leafless_last_error(NULL, 100) > 0);
    /* All of it is as good as ever. */
    OK(leafless_octree_check(octree));
    OK(leafless_tridexel_check(tridexel));
    OK(leafless_channel_check(channel));
    free_objects();
    free_values();
    CHECK(failures == 0);
    return 0;
}
