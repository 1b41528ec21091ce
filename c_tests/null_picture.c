/* As null.c, of pictures: every pointer NULL and misaligned, every number out of range. */
#include "null.h"

static leafless_solid *solid;
static leafless_octree *octree;
static leafless_mesh *mesh;
static leafless_layer *layer;
static leafless_frame frame;

/* What is made, and given back. */
static leafless_layer *made;

static void drop(void) {
    leafless_layer_free(made);
    made = NULL;
}

static void cameras(void) {
    void *out = fresh();
    const double points[6] = {0, 0, 0, 1, 1, 1}, bad[3] = {NAN, 0, 0};
    leafless_camera *camera = (leafless_camera *)out;
    NULL_POINTER(leafless_camera_fitted, points_model, leafless_camera_fitted(NULL, 2, 0, 0, 0, 1, camera));
    MISALIGNED(leafless_camera_fitted, points_model, leafless_camera_fitted((const double *)WRONG(points), 1, 0, 0, 0, 1, camera));
    NULL_POINTER(leafless_camera_fitted, camera, leafless_camera_fitted(points, 2, 0, 0, 0, 1, NULL));
    MISALIGNED(leafless_camera_fitted, camera, leafless_camera_fitted(points, 2, 0, 0, 0, 1, (leafless_camera *)WRONG(out)));
    BAD_NUMBER(leafless_camera_fitted, points, leafless_camera_fitted(bad, 1, 0, 0, 0, 1, camera));
    BAD_NUMBER(leafless_camera_fitted, points, leafless_camera_fitted(points, 0, 0, 0, 0, 1, camera));
    BAD_NUMBER(leafless_camera_fitted, points_model, leafless_camera_fitted(points, UINT64_MAX, 0, 0, 0, 1, camera));
    BAD_NUMBER(leafless_camera_fitted, from, leafless_camera_fitted(points, 2, INFINITY, 0, 0, 1, camera));
    BAD_NUMBER(leafless_camera_fitted, lens, leafless_camera_fitted(points, 2, 0, 0, -1, 1, camera));
    BAD_NUMBER(leafless_camera_fitted, aspect, leafless_camera_fitted(points, 2, 0, 0, 0, 0, camera));
    untouched();
}

static void structs(void) {
    untouched();
}

static void layers(void) {
    void *never = UNTOUCHED;
    leafless_layer **result = (leafless_layer **)&never;
    const double plane[4] = {0, 0, 1, 0}, flat[4] = {0, 0, 0, 1}, wrong_box[6] = {0, 0, 0, -1, 1, 1}, ends[6] = {0};
    const uint8_t colour[4] = {1, 2, 3, 4};
    leafless_cell cells[2];
    leafless_look look;
    leafless_slice_look slice_look;
    uint64_t bytes = 77;
    leafless_frame deep = frame;
    memset(cells, 0, sizeof cells);
    cells[1].level = UINT32_MAX;
    deep.depth = 21;
    NULL_POINTER(leafless_layer_clipped, layer, leafless_layer_clipped(NULL, plane, 1, NULL, result));
    NULL_POINTER(leafless_layer_clipped, planes, leafless_layer_clipped(layer, NULL, 1, NULL, result));
    MAY_BE_NULL(leafless_layer_clipped, box_model, leafless_layer_clipped(layer, plane, 1, NULL, &made));
    drop();
    NULL_POINTER(leafless_layer_clipped, clipped, leafless_layer_clipped(layer, plane, 1, NULL, NULL));
    BAD_NUMBER(leafless_layer_clipped, plane, leafless_layer_clipped(layer, flat, 1, NULL, result));
    BAD_NUMBER(leafless_layer_clipped, box_model, leafless_layer_clipped(layer, plane, 1, wrong_box, result));
    MISALIGNED(leafless_layer_clipped, box_model,
               leafless_layer_clipped(layer, plane, 1, (const double *)WRONG(wrong_box), result));
    NULL_POINTER(leafless_layer_bytes, layer, leafless_layer_bytes(NULL, &bytes));
    NULL_POINTER(leafless_layer_bytes, bytes, leafless_layer_bytes(layer, NULL));
    MISALIGNED(leafless_layer_bytes, bytes, leafless_layer_bytes(layer, (uint64_t *)WRONG(&bytes)));
    CHECK(bytes == 77);
    NULL_POINTER(leafless_layer_ref, layer, leafless_layer_ref(NULL, result));
    NULL_POINTER(leafless_layer_ref, reference, leafless_layer_ref(layer, NULL));
    leafless_layer_free(NULL);

    NULL_POINTER(leafless_layer_from_octree, octree, leafless_layer_from_octree(NULL, NULL, result));
    MAY_BE_NULL(leafless_layer_from_octree, look, leafless_layer_from_octree(octree, NULL, &made));
    drop();
    NULL_POINTER(leafless_layer_from_octree, layer, leafless_layer_from_octree(octree, NULL, NULL));
    NULL_POINTER(leafless_layer_from_solid, solid, leafless_layer_from_solid(NULL, &frame, NULL, result));
    NULL_POINTER(leafless_layer_from_solid, frame, leafless_layer_from_solid(solid, NULL, NULL, result));
    MAY_BE_NULL(leafless_layer_from_solid, look, leafless_layer_from_solid(solid, &frame, NULL, &made));
    drop();
    NULL_POINTER(leafless_layer_from_solid, layer, leafless_layer_from_solid(solid, &frame, NULL, NULL));
    BAD_NUMBER(leafless_layer_from_solid, depth, leafless_layer_from_solid(solid, &deep, NULL, result));
    NULL_POINTER(leafless_layer_from_mesh, mesh, leafless_layer_from_mesh(NULL, NULL, result));
    MAY_BE_NULL(leafless_layer_from_mesh, look, leafless_layer_from_mesh(mesh, NULL, &made));
    drop();
    NULL_POINTER(leafless_layer_from_mesh, layer, leafless_layer_from_mesh(mesh, NULL, NULL));
    OK(leafless_init(&look, sizeof look));
    look.faces = 2;
    BAD_NUMBER(leafless_layer_from_octree, faces, leafless_layer_from_octree(octree, &look, result));
    BAD_NUMBER(leafless_layer_from_mesh, faces, leafless_layer_from_mesh(mesh, &look, result));
    look.faces = 1;
    BAD_NUMBER(leafless_layer_from_solid, faces, leafless_layer_from_solid(solid, &frame, &look, result));
    look.faces = 0;
    look.edges = 3;
    BAD_NUMBER(leafless_layer_from_octree, edges, leafless_layer_from_octree(octree, &look, result));
    BAD_NUMBER(leafless_layer_from_mesh, edges, leafless_layer_from_mesh(mesh, &look, result));
    look.edges = 0;
    look.triangle_count = 1;
    NULL_POINTER(leafless_layer_from_mesh, triangle_colours, leafless_layer_from_mesh(mesh, &look, result));
    BAD_NUMBER(leafless_layer_from_solid, triangle_count, leafless_layer_from_solid(solid, &frame, &look, result));
    look.struct_size = 7;
    BAD_NUMBER(leafless_layer_from_octree, look, leafless_layer_from_octree(octree, &look, result));

    NULL_POINTER(leafless_layer_new_lines, points_model, leafless_layer_new_lines(NULL, 1, 1, colour, result));
    MAY_BE_NULL(leafless_layer_new_lines, colour, leafless_layer_new_lines(ends, 1, 1, NULL, &made));
    drop();
    NULL_POINTER(leafless_layer_new_lines, layer, leafless_layer_new_lines(ends, 1, 1, colour, NULL));
    NULL_POINTER(leafless_layer_new_cells, frame, leafless_layer_new_cells(NULL, cells, 2, 1, colour, result));
    NULL_POINTER(leafless_layer_new_cells, cells, leafless_layer_new_cells(&frame, NULL, 2, 1, colour, result));
    MAY_BE_NULL(leafless_layer_new_cells, colour, leafless_layer_new_cells(&frame, cells, 2, 1, NULL, &made));
    drop();
    NULL_POINTER(leafless_layer_new_cells, layer, leafless_layer_new_cells(&frame, cells, 2, 1, colour, NULL));

    NULL_POINTER(leafless_layer_from_octree_slice, octree, leafless_layer_from_octree_slice(NULL, plane, NULL, result));
    NULL_POINTER(leafless_layer_from_octree_slice, plane, leafless_layer_from_octree_slice(octree, NULL, NULL, result));
    MAY_BE_NULL(leafless_layer_from_octree_slice, look, leafless_layer_from_octree_slice(octree, plane, NULL, &made));
    drop();
    NULL_POINTER(leafless_layer_from_octree_slice, layer, leafless_layer_from_octree_slice(octree, plane, NULL, NULL));
    BAD_NUMBER(leafless_layer_from_octree_slice, normal, leafless_layer_from_octree_slice(octree, flat, NULL, result));
    OK(leafless_init(&slice_look, sizeof slice_look));
    slice_look.is_plain = 2;
    BAD_NUMBER(leafless_layer_from_octree_slice, is_plain, leafless_layer_from_octree_slice(octree, plane, &slice_look, result));
    NULL_POINTER(leafless_layer_from_solid_slice, solid,
                 leafless_layer_from_solid_slice(NULL, &frame, plane, NULL, result));
    NULL_POINTER(leafless_layer_from_solid_slice, frame,
                 leafless_layer_from_solid_slice(solid, NULL, plane, NULL, result));
    NULL_POINTER(leafless_layer_from_solid_slice, plane,
                 leafless_layer_from_solid_slice(solid, &frame, NULL, NULL, result));
    MAY_BE_NULL(leafless_layer_from_solid_slice, look,
                leafless_layer_from_solid_slice(solid, &frame, plane, NULL, &made));
    drop();
    NULL_POINTER(leafless_layer_from_solid_slice, layer,
                 leafless_layer_from_solid_slice(solid, &frame, plane, NULL, NULL));
    CHECK(never == UNTOUCHED);
}

static void voxels(void) {
    void *out = fresh(), *never = UNTOUCHED;
    leafless_layer **result = (leafless_layer **)&never;
    const uint64_t code = 0;
    const uint8_t level = 0, kind = LEAFLESS_VOXEL_KIND_BOUNDARY;
    const double value = 1;
    double *parts = (double *)out, part;
    leafless_voxel_arrays arrays;
    leafless_transfer transfer;
    NULL_POINTER(leafless_voxels_solid_parts, lattice,
                 leafless_voxels_solid_parts(NULL, &code, &level, &kind, 1, solid, NULL, parts));
    NULL_POINTER(leafless_voxels_solid_parts, codes,
                 leafless_voxels_solid_parts(&frame, NULL, &level, &kind, 1, solid, NULL, parts));
    NULL_POINTER(leafless_voxels_solid_parts, levels,
                 leafless_voxels_solid_parts(&frame, &code, NULL, &kind, 1, solid, NULL, parts));
    NULL_POINTER(leafless_voxels_solid_parts, kinds,
                 leafless_voxels_solid_parts(&frame, &code, &level, NULL, 1, solid, NULL, parts));
    NULL_POINTER(leafless_voxels_solid_parts, solid,
                 leafless_voxels_solid_parts(&frame, &code, &level, &kind, 1, NULL, NULL, parts));
    MAY_BE_NULL(leafless_voxels_solid_parts, options,
                leafless_voxels_solid_parts(&frame, &code, &level, &kind, 1, solid, NULL, &part));
    NULL_POINTER(leafless_voxels_solid_parts, parts,
                 leafless_voxels_solid_parts(&frame, &code, &level, &kind, 1, solid, NULL, NULL));
    OK(leafless_init(&arrays, sizeof arrays));
    OK(leafless_init(&transfer, sizeof transfer));
    transfer.range_upper = 1;
    arrays.lattice = frame;
    arrays.count = 1;
    NULL_POINTER(leafless_layer_new_voxels, codes, leafless_layer_new_voxels(&arrays, &transfer, 0, result));
    arrays.codes = &code;
    NULL_POINTER(leafless_layer_new_voxels, levels, leafless_layer_new_voxels(&arrays, &transfer, 0, result));
    arrays.levels = &level;
    NULL_POINTER(leafless_layer_new_voxels, kinds, leafless_layer_new_voxels(&arrays, &transfer, 0, result));
    arrays.kinds = &kind;
    arrays.components = 1;
    NULL_POINTER(leafless_layer_new_voxels, values, leafless_layer_new_voxels(&arrays, &transfer, 0, result));
    arrays.values = &value;
    arrays.components = 5;
    arrays.count = UINT64_MAX;
    BAD_NUMBER(leafless_layer_new_voxels, codes, leafless_layer_new_voxels(&arrays, &transfer, 0, result));
    arrays.components = 1;
    arrays.count = 1;
    NULL_POINTER(leafless_layer_new_voxels, voxels, leafless_layer_new_voxels(NULL, &transfer, 0, result));
    NULL_POINTER(leafless_layer_new_voxels, transfer, leafless_layer_new_voxels(&arrays, NULL, 0, result));
    NULL_POINTER(leafless_layer_new_voxels, layer, leafless_layer_new_voxels(&arrays, &transfer, 0, NULL));
    BAD_NUMBER(leafless_layer_new_voxels, unit, leafless_layer_new_voxels(&arrays, &transfer, NAN, result));
    transfer.alpha_lower = 2;
    BAD_NUMBER(leafless_layer_new_voxels, alpha, leafless_layer_new_voxels(&arrays, &transfer, 0, result));
    untouched();
    CHECK(never == UNTOUCHED);
}

static void pictures(void) {
    void *out = fresh();
    static uint8_t colours[4 * 16 * 16];
    static char PATH[] = "never.png";
    const double points[6] = {0, 0, 0, 1, 1, 1};
    const leafless_layer *all[1];
    leafless_shot shot;
    leafless_transfer transfer;
    leafless_legend_name name = {"x", 1, {0, 0, 0, 0}, 0};
    leafless_legend_box *box = (leafless_legend_box *)out, found;
    all[0] = layer;
    OK(leafless_init(&shot, sizeof shot));
    OK(leafless_camera_fitted(points, 2, 0, 0, 0, 1, &shot.camera));
    shot.width = shot.height = 1;
    NULL_POINTER(leafless_picture_render, shot, leafless_picture_render(NULL, all, 1, NULL, (uint8_t *)out, 4, (float *)out, 1));
    NULL_POINTER(leafless_picture_render, layers, leafless_picture_render(&shot, NULL, 1, NULL, (uint8_t *)out, 4, (float *)out, 1));
    MAY_BE_NULL(leafless_picture_render, options, leafless_picture_render(&shot, all, 1, NULL, colours, 4, NULL, 0));
    MAY_BE_NULL(leafless_picture_render, colours, leafless_picture_render(&shot, all, 1, NULL, NULL, 0, NULL, 0));
    MAY_BE_NULL(leafless_picture_render, depths, leafless_picture_render(&shot, all, 1, NULL, colours, 4, NULL, 0));
    NULL_POINTER(leafless_picture_render, colours, leafless_picture_render(&shot, all, 1, NULL, NULL, 4, NULL, 0));
    MISALIGNED(leafless_picture_render, depths, leafless_picture_render(&shot, all, 1, NULL, NULL, 0, (float *)WRONG(out), 1));
    shot.clip_plane_count = 1;
    NULL_POINTER(leafless_picture_render, clip_planes, leafless_picture_render(&shot, all, 1, NULL, (uint8_t *)out, 4, NULL, 0));
    shot.clip_plane_count = 0;
    shot.reserved = 1;
    BAD_NUMBER(leafless_picture_render, reserved, leafless_picture_render(&shot, all, 1, NULL, (uint8_t *)out, 4, NULL, 0));
    shot.reserved = 0;
    NULL_POINTER(leafless_shot_line_of_sight, shot,
                 leafless_shot_line_of_sight(NULL, 0, 0, (double *)out, (double *)out + 3));
    NULL_POINTER(leafless_shot_line_of_sight, from_model,
                 leafless_shot_line_of_sight(&shot, 0, 0, NULL, (double *)out + 3));
    NULL_POINTER(leafless_shot_line_of_sight, direction, leafless_shot_line_of_sight(&shot, 0, 0, (double *)out, NULL));
    shot.width = 0;
    BAD_NUMBER(leafless_shot_line_of_sight, width,
               leafless_shot_line_of_sight(&shot, 0, 0, (double *)out, (double *)out + 3));
    NULL_POINTER(leafless_picture_write, colours, picture_save(NULL, 16, 16, PATH, sizeof PATH - 1));
    NULL_POINTER(leafless_picture_write, sink, leafless_picture_write(colours, 16, 16, NULL));
    OK(leafless_init(&transfer, sizeof transfer));
    BAD_NUMBER(leafless_picture_draw_bar, range,
               leafless_picture_draw_bar(colours, 16, 16, "x", 1, &transfer, 0, box));
    BAD_NUMBER(leafless_transfer_colour, range, leafless_transfer_colour(&transfer, points, 1, (uint8_t *)out));
    transfer.range_upper = 1;
    NULL_POINTER(leafless_transfer_colour, transfer, leafless_transfer_colour(NULL, points, 1, (uint8_t *)out));
    NULL_POINTER(leafless_transfer_colour, value, leafless_transfer_colour(&transfer, NULL, 1, (uint8_t *)out));
    NULL_POINTER(leafless_transfer_colour, colour, leafless_transfer_colour(&transfer, points, 1, NULL));
    BAD_NUMBER(leafless_transfer_colour, components, leafless_transfer_colour(&transfer, points, 5, (uint8_t *)out));
    NULL_POINTER(leafless_picture_draw_bar, colours, leafless_picture_draw_bar(NULL, 16, 16, "x", 1, &transfer, 0, box));
    NULL_POINTER(leafless_picture_draw_bar, title, leafless_picture_draw_bar(colours, 16, 16, NULL, 1, &transfer, 0, box));
    NULL_POINTER(leafless_picture_draw_bar, transfer, leafless_picture_draw_bar(colours, 16, 16, "x", 1, NULL, 0, box));
    NULL_POINTER(leafless_picture_draw_bar, covered, leafless_picture_draw_bar(colours, 16, 16, "x", 1, &transfer, 0, NULL));
    BAD_NUMBER(leafless_picture_draw_bar, side, leafless_picture_draw_bar(colours, 16, 16, "x", 1, &transfer, 2, box));
    BAD_NUMBER(leafless_picture_draw_bar, size, leafless_picture_draw_bar(colours, 0, 16, "x", 1, &transfer, 0, box));
    NULL_POINTER(leafless_picture_draw_names, colours,
                 leafless_picture_draw_names(NULL, 16, 16, "x", 1, &name, 1, 0, box));
    NULL_POINTER(leafless_picture_draw_names, title,
                 leafless_picture_draw_names(colours, 16, 16, NULL, 1, &name, 1, 0, box));
    NULL_POINTER(leafless_picture_draw_names, names, leafless_picture_draw_names(colours, 16, 16, "x", 1, NULL, 1, 0, box));
    NULL_POINTER(leafless_picture_draw_names, covered,
                 leafless_picture_draw_names(colours, 16, 16, "x", 1, &name, 1, 0, NULL));
    name.name = NULL;
    NULL_POINTER(leafless_picture_draw_names, name, leafless_picture_draw_names(colours, 16, 16, "x", 1, &name, 1, 0, box));
    name.name = "x";
    name.reserved = 1;
    BAD_NUMBER(leafless_picture_draw_names, reserved,
               leafless_picture_draw_names(colours, 16, 16, "x", 1, &name, 1, 0, box));
    name.reserved = 0;
    OK(leafless_picture_draw_names(colours, 16, 16, NULL, 0, &name, 1, 0, &found));
    untouched();
}

int main(void) {
    const leafless_mesh_arrays arrays = check_arrays(CHECK_CUBE, 8, CHECK_CUBE_TRIANGLES, 12);
    frame = check_frame(3);
    solid = check_ball_solid();
    octree = check_ball(3, LEAFLESS_RULE_CERTIFIED);
    OK(leafless_mesh_new(&arrays, &mesh));
    OK(leafless_layer_from_octree(octree, NULL, &layer));
    cameras();
    structs();
    layers();
    voxels();
    pictures();
    leafless_layer_free(layer);
    leafless_mesh_free(mesh);
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    return 0;
}
