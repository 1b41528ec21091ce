/* Shows a bored block in three ways: its surface, cut open, with the axis of the bore as a line; a section with the
 * cells of its octree; its inside coloured by temperature.
 *
 *     pictures
 *
 * writes surface.png, section.png and volume.png. include/README.md describes how to build it.
 */
#include <leafless.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 400, HEIGHT = 300 };

static uint8_t colours[4 * WIDTH * HEIGHT];

/* The block [-1, 1] x [-0.6, 0.6] x [-0.5, 0.5] with a bore along y. */
static leafless_status block(leafless_solid **solid) {
    const double min[3] = {-1, -0.6, -0.5}, max[3] = {1, 0.6, 0.5};
    const double front[3] = {0.3, -1, 0}, back[3] = {0.3, 1, 0};
    leafless_solid *whole = NULL, *bore = NULL;
    leafless_status s = leafless_solid_new_box(min, max, &whole);
    if (!s) s = leafless_solid_new_cylinder(front, back, 0.3, &bore);
    if (!s) {
        const leafless_solid *const operands[] = {whole, bore};
        s = leafless_solid_combine(LEAFLESS_OPERATION_DIFFERENCE, operands, 2, solid);
    }
    leafless_solid_free(whole);
    leafless_solid_free(bore);
    return s;
}

/* The temperature: hot at one end. */
static int32_t temperature(void *ctx, const double *point, double *value) {
    (void)ctx;
    value[0] = 50 + 40 * point[0];
    return 0;
}

static leafless_status look_from(double azimuth, double elevation, leafless_shot *shot) {
    double corners[8][3];
    int i;
    leafless_status s = LEAFLESS_OK;
    for (i = 0; i < 8; i++) {
        corners[i][0] = i & 1 ? 1 : -1;
        corners[i][1] = i & 2 ? 0.6 : -0.6;
        corners[i][2] = i & 4 ? 0.5 : -0.5;
    }
    *shot = LEAFLESS_INIT(leafless_shot);
    shot->width = WIDTH;
    shot->height = HEIGHT;
    memset(shot->background, 255, 4);
    if (!s) s = leafless_camera_fitted(corners[0], 8, azimuth, elevation, 30, (double)WIDTH / HEIGHT, &shot->camera);
    return s;
}

static leafless_status take(const leafless_shot *shot, leafless_layer *const *layers, uint64_t count) {
    return leafless_picture_render(shot, (const leafless_layer *const *)layers, count, NULL, colours, sizeof colours, NULL, 0);
}

static leafless_status save(const char *path) {
    const leafless_sink file = leafless_to_file(path);
    const leafless_status s = leafless_picture_write(colours, WIDTH, HEIGHT, &file);
    if (!s) printf("written   %s\n", path);
    return s;
}

/* The surface without the part above z = 0.2, and the axis of the bore. */
static leafless_status surface(const leafless_solid *solid, const leafless_frame *frame) {
    const double cut[4] = {0, 0, -1, 0.2}, axis[6] = {0.3, -0.9, 0, 0.3, 0.9, 0};
    const uint8_t red[4] = {200, 30, 30, 255};
    leafless_layer *layers[2] = {NULL, NULL};
    leafless_shot shot;
    leafless_status s = look_from(30, 35, &shot);
    shot.clip_planes = cut;
    shot.clip_plane_count = 1;
    if (!s) s = leafless_layer_from_solid(solid, frame, NULL, &layers[0]);
    if (!s) s = leafless_layer_new_lines(axis, 1, 2, red, &layers[1]);
    if (!s) s = take(&shot, layers, 2);
    if (!s) s = save("surface.png");
    leafless_layer_free(layers[1]);
    leafless_layer_free(layers[0]);
    return s;
}

static leafless_status section(const leafless_octree *octree) {
    const leafless_legend_name tags[3] = {{"EMPTY", 5, {86, 180, 233, 40}, 0},
                                          {"FULL", 4, {0, 114, 178, 255}, 0},
                                          {"PARTIAL", 7, {230, 159, 0, 255}, 0}};
    const double plane[4] = {0, 1, 0, -0.1};
    leafless_layer *layer = NULL;
    leafless_legend_box covered;
    leafless_shot shot;
    leafless_status s = look_from(0, 0, &shot);
    if (!s) s = leafless_layer_from_octree_slice(octree, plane, NULL, &layer);
    if (!s) s = take(&shot, &layer, 1);
    if (!s) s = leafless_picture_draw_names(colours, WIDTH, HEIGHT, NULL, 0, tags, 3, LEAFLESS_LEGEND_SIDE_BOTTOM, &covered);
    if (!s) s = save("section.png");
    leafless_layer_free(layer);
    return s;
}

/* Voxels that follow the temperature; a path of 2 units transmits a tenth of the light. */
static leafless_status volume(const leafless_octree *octree, const leafless_solid *solid) {
    const leafless_attribute_callbacks callbacks = {.struct_size = sizeof callbacks, .components = 1, .value = temperature};
    leafless_voxel_options options = {.struct_size = sizeof options};
    leafless_voxel_arrays voxels = {.struct_size = sizeof voxels, .components = 1};
    const leafless_transfer transfer = {.struct_size = sizeof transfer,
                                        .map = LEAFLESS_COLOUR_MAP_VIRIDIS,
                                        .range_lower = 10,
                                        .range_upper = 90,
                                        .alpha_lower = 0.9,
                                        .alpha_upper = 0.9,
                                        .length_model = 2};
    leafless_attribute *heat = NULL;
    leafless_layer *layer = NULL;
    leafless_legend_box covered;
    leafless_shot shot;
    uint64_t *codes = NULL, count = 0;
    uint8_t *levels = NULL, *kinds = NULL;
    double *values = NULL, *weights = NULL;
    leafless_status s = leafless_attribute_new_callbacks(&callbacks, &heat);
    options.attribute = heat;
    options.coarse_model = 0.25;
    options.fine_model = 1.0 / 32;
    options.tolerance = 2;
    options.criterion = LEAFLESS_CRITERION_VARIANCE;
    if (!s) {
        s = leafless_octree_voxels(octree, &options, NULL, &voxels.lattice, NULL, NULL, NULL, NULL, NULL, 0, &voxels.count);
    }
    codes = malloc(voxels.count * sizeof *codes + 1);
    levels = malloc(voxels.count + 1);
    kinds = malloc(voxels.count + 1);
    values = malloc(voxels.count * sizeof *values + 1);
    weights = malloc(voxels.count * sizeof *weights + 1);
    if (!codes || !levels || !kinds || !values || !weights) {
        abort();
    }
    if (!s) {
        s = leafless_octree_voxels(octree, &options, NULL, &voxels.lattice, codes, levels, kinds, NULL, values, voxels.count,
                                   &count);
    }
    if (!s) s = leafless_voxels_solid_parts(&voxels.lattice, codes, levels, kinds, voxels.count, solid, NULL, weights);
    voxels.codes = codes;
    voxels.levels = levels;
    voxels.kinds = kinds;
    voxels.values = values;
    voxels.weights = weights;
    if (!s) s = leafless_layer_new_voxels(&voxels, &transfer, 0, &layer);
    if (!s) printf("voxels    %lu\n", (unsigned long)count);
    if (!s) s = look_from(30, 25, &shot);
    if (!s) s = take(&shot, &layer, 1);
    if (!s) {
        s = leafless_picture_draw_bar(colours, WIDTH, HEIGHT, "heat", 4, &transfer, LEAFLESS_LEGEND_SIDE_RIGHT, &covered);
    }
    if (!s) s = save("volume.png");
    leafless_layer_free(layer);
    leafless_attribute_free(heat);
    free(codes);
    free(levels);
    free(kinds);
    free(values);
    free(weights);
    return s;
}

int main(void) {
    const leafless_frame frame = {{-1.1, -1.1, -1.1}, 2.2, 7};
    leafless_solid *solid = NULL;
    leafless_octree *octree = NULL;
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
    leafless_status s = block(&solid);
    if (!s) s = leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &octree);
    if (!s) s = leafless_octree_describe(octree, &info);
    if (!s) printf("elements  %lu\n", (unsigned long)info.elements);
    if (!s) s = surface(solid, &frame);
    if (!s) s = section(octree);
    if (!s) s = volume(octree, solid);
    if (s) {
        char message[512];
        leafless_last_error(message, sizeof message);
        fprintf(stderr, "%s\n", message);
    }
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    return s != LEAFLESS_OK;
}
