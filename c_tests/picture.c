/* Pictures: of a ball, a cube, cells and voxels, by the depths and colours that formulas say. */
#include "check.h"

enum { SIDE = 96, PIXELS = SIDE * SIDE };

static uint8_t colours[4 * PIXELS];
static float depths[PIXELS];
static leafless_camera front;

static const uint8_t NOTHING[4] = {0, 0, 0, 0};

/* From -y with parallel lines: x to the right, z upward. */
static void look_from_front(void) {
    double corners[8][3];
    int i;
    for (i = 0; i < 8; i++) {
        corners[i][0] = i & 1 ? 1 : -1;
        corners[i][1] = i & 2 ? 1 : -1;
        corners[i][2] = i & 4 ? 1 : -1;
    }
    OK(leafless_camera_fitted(&corners[0][0], 8, 0, 0, 0, 1, &front));
    CHECK(front.eye_model[1] < -1 && fabs(front.eye_model[0]) < 1e-12 && fabs(front.eye_model[2]) < 1e-12);
    CHECK(front.up[2] == 1 && front.field_of_view_degrees == 0 && front.height_model > 2 && front.height_model < 2.4);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_camera_fitted(&corners[0][0], 0, 0, 0, 0, 1, &front));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_camera_fitted(&corners[0][0], 8, 0, 0, 180, 1, &front));
}

static leafless_shot shot_of(uint32_t samples) {
    leafless_shot shot;
    OK(leafless_init(&shot, sizeof shot));
    shot.width = shot.height = SIDE;
    shot.samples = samples;
    shot.camera = front;
    return shot;
}

static void take(const leafless_shot *shot, const leafless_layer *layer) {
    OK(leafless_picture_render(shot, &layer, 1, NULL, colours, sizeof colours, depths, PIXELS));
}

/* Where the middle of a pixel lies across the view. */
static double across(int i) {
    return (i + 0.5 - SIDE / 2.0) * front.height_model / SIDE;
}

static const uint8_t *pixel(int x, int y) {
    return colours + 4 * (x + SIDE * y);
}

static int is(const uint8_t *found, const uint8_t *expected) {
    return memcmp(found, expected, 4) == 0;
}

/* Checks a picture of 1 sample of the ball of radius 0.75, to a tolerance. Only the part beyond y = `cut` is shown. */
static void check_ball_depths(double cut, double tolerance) {
    int x, y, seen = 0;
    for (y = 0; y < SIDE; y++) {
        for (x = 0; x < SIDE; x++) {
            const double u = across(x), v = -across(y), rest = 0.75 * 0.75 - u * u - v * v;
            const float depth = depths[x + SIDE * y];
            /* At the rim rounding and cells decide. */
            if (rest > 0.06) {
                const double near = fmax(-sqrt(rest), cut), far = sqrt(rest);
                if (near < far - tolerance) {
                    CHECK(fabs(depth - (near - front.eye_model[1])) <= tolerance);
                    CHECK(pixel(x, y)[3] == 255);
                    seen++;
                }
            } else if (rest < -0.06) {
                CHECK(isinf(depth) && is(pixel(x, y), NOTHING));
            }
        }
    }
    CHECK(seen > 1000);
}

static void surfaces(void) {
    const leafless_frame frame = check_frame(7);
    const leafless_mesh_arrays arrays = check_arrays(CHECK_CUBE, 8, CHECK_CUBE_TRIANGLES, 12);
    const double plane[4] = {0, 1, 0, 0.25};
    const double half[6] = {-0.5, -1, -1, 1, 1, 1};
    leafless_solid *solid = check_ball_solid();
    leafless_octree *octree = check_ball(7, LEAFLESS_RULE_CERTIFIED);
    leafless_layer *layer, *clipped, *again;
    uint64_t bytes = 0;
    leafless_shot shot = shot_of(1);
    leafless_mesh *mesh;
    leafless_look look;
    int x, y;
    OK(leafless_layer_from_solid(solid, &frame, NULL, &layer));
    take(&shot, layer);
    check_ball_depths(-1, 2e-3);
    /* Cut by the picture, and by the layer alone. */
    shot.clip_planes = plane;
    shot.clip_plane_count = 1;
    take(&shot, layer);
    check_ball_depths(-0.25, 2e-3);
    CHECK(pixel(SIDE / 2, SIDE / 2)[0] > pixel(SIDE / 2, SIDE / 2)[2] + 40);
    shot.clip_plane_count = 0;
    OK(leafless_layer_clipped(layer, plane, 1, NULL, &clipped));
    take(&shot, clipped);
    check_ball_depths(-0.25, 2e-3);
    OK(leafless_layer_clipped(clipped, NULL, 0, half, &again));
    take(&shot, again);
    for (x = 0; x < SIDE; x++) {
        CHECK(isinf(depths[x + SIDE * (SIDE / 2)]) == (across(x) < -0.5 || fabs(across(x)) > 0.75));
    }
    leafless_layer_free(again);
    leafless_layer_free(clipped);
    leafless_layer_free(layer);
    /* A layer keeps its octree. */
    OK(leafless_init(&look, sizeof look));
    look.colour[1] = look.colour[3] = 255;
    OK(leafless_layer_from_octree(octree, &look, &layer));
    leafless_octree_free(octree);
    OK(leafless_layer_bytes(layer, &bytes));
    CHECK(bytes > 10000);
    take(&shot, layer);
    /* A cell is seen where the surface is anywhere in it, and that rises by up to three cells a cell. */
    check_ball_depths(-1, 5.5 / 64);
    CHECK(pixel(SIDE / 2, SIDE / 2)[0] == 0 && pixel(SIDE / 2, SIDE / 2)[1] > 150);
    OK(leafless_layer_ref(layer, &again));
    leafless_layer_free(layer);
    take(&shot, again);
    leafless_layer_free(again);
    look.edges = LEAFLESS_EDGES_ALL;
    octree = check_ball(3, LEAFLESS_RULE_CERTIFIED);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_layer_from_octree(octree, &look, &layer));
    /* The silhouette of a ball is black, its middle is not. */
    look.edges = LEAFLESS_EDGES_FEATURES;
    look.edge_colour[3] = 255;
    look.edge_width = 9;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_layer_from_solid(solid, &frame, &look, &layer));
    look.edge_width = 3;
    OK(leafless_layer_from_solid(solid, &frame, &look, &layer));
    take(&shot, layer);
    for (x = 0; x < SIDE; x++) {
        const double from_rim = (0.75 - fabs(across(x))) / front.height_model * SIDE;
        if (from_rim > 0.1 && from_rim < 1.4) {
            CHECK(pixel(x, SIDE / 2)[1] == 0 && pixel(x, SIDE / 2)[3] == 255);
        }
        CHECK(from_rim < 5 || pixel(x, SIDE / 2)[1] > 50);
    }
    leafless_layer_free(layer);
    leafless_octree_free(octree);
    /* A cube whose triangles are red except those of the front. */
    OK(leafless_mesh_new(&arrays, &mesh));
    {
        double vertices[24];
        uint32_t indices[36];
        uint8_t triangle_colours[12][4];
        double least[3] = {1e300, 1e300, 1e300}, greatest[3] = {-1e300, -1e300, -1e300};
        int i, k;
        OK(leafless_mesh_copy(mesh, vertices, 8, indices, 12));
        for (i = 0; i < 24; i++) {
            least[i % 3] = fmin(least[i % 3], vertices[i]);
            greatest[i % 3] = fmax(greatest[i % 3], vertices[i]);
        }
        for (i = 0; i < 12; i++) {
            const int is_front = vertices[3 * indices[3 * i] + 1] == least[1] &&
                                 vertices[3 * indices[3 * i + 1] + 1] == least[1] &&
                                 vertices[3 * indices[3 * i + 2] + 1] == least[1];
            for (k = 0; k < 4; k++) {
                triangle_colours[i][k] = (uint8_t)(k == 3 || k == (is_front ? 2 : 0) ? 255 : 0);
            }
        }
        OK(leafless_init(&look, sizeof look));
        look.triangle_colours = &triangle_colours[0][0];
        look.triangle_count = 11;
        FAILS(LEAFLESS_E_ARGUMENT, leafless_layer_from_mesh(mesh, &look, &layer));
        look.triangle_count = 12;
        OK(leafless_layer_from_mesh(mesh, &look, &layer));
        memset(triangle_colours, 0, sizeof triangle_colours);
        take(&shot, layer);
        for (y = 0; y < SIDE; y++) {
            for (x = 0; x < SIDE; x++) {
                const double u = across(x), v = -across(y);
                const int inside = u > least[0] && u < greatest[0] && v > least[2] && v < greatest[2];
                const float depth = depths[x + SIDE * y];
                CHECK(inside ? fabs(depth - (least[1] - front.eye_model[1])) < 1e-6 : isinf(depth));
                CHECK(!inside || (pixel(x, y)[0] == 0 && pixel(x, y)[2] > 150));
            }
        }
        leafless_layer_free(layer);
        look.edges = 7;
        FAILS(LEAFLESS_E_ARGUMENT, leafless_layer_from_mesh(mesh, &look, &layer));
    }
    leafless_mesh_free(mesh);
    leafless_solid_free(solid);
}

static void lines(void) {
    static const uint8_t RED[4] = {255, 0, 0, 255};
    const double ends[6] = {-0.5, 0, 0, 0.5, 0, 0};
    const leafless_frame frame = check_frame(3);
    leafless_cell cell;
    leafless_layer *layer;
    leafless_shot shot = shot_of(4);
    int x;
    OK(leafless_layer_new_lines(ends, 1, 4, RED, &layer));
    take(&shot, layer);
    for (x = 0; x < SIDE; x++) {
        const double beyond = fabs(across(x)) - 0.5;
        const uint8_t *found = pixel(x, SIDE / 2);
        CHECK(fabs(beyond) < 0.1 || is(found, beyond < 0 ? RED : NOTHING));
    }
    leafless_layer_free(layer);
    OK(leafless_layer_new_lines(ends, 1, 1000, RED, &layer));
    FAILS(LEAFLESS_E_ARGUMENT,
          leafless_picture_render(&shot, (const leafless_layer *const *)&layer, 1, NULL, colours, sizeof colours, NULL, 0));
    leafless_layer_free(layer);
    /* The universe as a cell: its edges are seen, its middle is not. */
    memset(&cell, 0, sizeof cell);
    memset(&cell.tag, 0x5a, sizeof cell.tag);
    OK(leafless_layer_new_cells(&frame, &cell, 1, 3, RED, &layer));
    take(&shot, layer);
    CHECK(is(pixel(SIDE / 2, SIDE / 2), NOTHING));
    for (x = 0; x < SIDE && across(x) < -1; x++) {
    }
    CHECK(pixel(x, SIDE / 2)[3] == 255 || pixel(x - 1, SIDE / 2)[3] == 255);
    leafless_layer_free(layer);
}

static void sections(void) {
    static const uint8_t FULL[4] = {1, 2, 3, 255}, VIOLET[4] = {68, 1, 84, 255};
    const double plane[4] = {0, 1, 0, -0.01}, value = 20;
    const leafless_frame frame = check_frame(5);
    leafless_solid *solid = check_ball_solid();
    leafless_octree *octree = check_ball(5, LEAFLESS_RULE_CERTIFIED);
    leafless_attribute *attribute;
    leafless_transfer transfer;
    leafless_slice_look look;
    leafless_look surface;
    uint8_t colour[4];
    leafless_layer *layer;
    leafless_shot shot = shot_of(1);
    uint8_t first[sizeof colours];
    int x, y;
    OK(leafless_init(&look, sizeof look));
    look.is_plain = 1;
    memcpy(look.full_colour, FULL, 4);
    OK(leafless_layer_from_octree_slice(octree, plane, &look, &layer));
    take(&shot, layer);
    for (y = 0; y < SIDE; y++) {
        for (x = 0; x < SIDE; x++) {
            const double u = across(x), v = -across(y);
            leafless_tag tag = LEAFLESS_TAG_BRANCH;
            if (fabs(u) < 1 && fabs(v) < 1) {
                const uint32_t cell[3] = {(uint32_t)((u + 1) * 16), (uint32_t)(1.01 * 16), (uint32_t)((v + 1) * 16)};
                OK(leafless_octree_tag_at(octree, cell, &tag));
            }
            CHECK(is(pixel(x, y), FULL) == (tag == LEAFLESS_TAG_FULL));
            CHECK((pixel(x, y)[3] == 0) == (tag == LEAFLESS_TAG_BRANCH));
        }
    }
    leafless_layer_free(layer);
    /* A solid that is split on the way shows the same. */
    memcpy(first, colours, sizeof colours);
    OK(leafless_layer_from_solid_slice(solid, &frame, plane, &look, &layer));
    take(&shot, layer);
    CHECK(memcmp(first, colours, sizeof colours) == 0);
    leafless_layer_free(layer);
    OK(leafless_attribute_new_constant(&value, 1, &attribute));
    OK(leafless_init(&transfer, sizeof transfer));
    look.attribute = attribute;
    FAILS(LEAFLESS_E_NULL, leafless_layer_from_octree_slice(octree, plane, &look, &layer));
    look.transfer = &transfer;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_layer_from_octree_slice(octree, plane, &look, &layer));
    transfer.range_lower = 20;
    transfer.range_upper = 80;
    OK(leafless_layer_from_octree_slice(octree, plane, &look, &layer));
    leafless_attribute_free(attribute);
    take(&shot, layer);
    CHECK(is(pixel(SIDE / 2, SIDE / 2), VIOLET));
    leafless_layer_free(layer);
    OK(leafless_transfer_colour(&transfer, &value, 1, colour));
    CHECK(is(colour, VIOLET));
    {
        const double green[3] = {1, 200, 3}, none = NAN;
        OK(leafless_transfer_colour(&transfer, green, 3, colour));
        CHECK(colour[0] == 1 && colour[1] == 200 && colour[2] == 3 && colour[3] == 255);
        OK(leafless_transfer_colour(&transfer, &none, 1, colour));
        CHECK(colour[0] == colour[1] && colour[1] == colour[2]);
    }
    /* The same on the surface, shaded: the ratio of red to blue light stays. */
    OK(leafless_attribute_new_constant(&value, 1, &attribute));
    OK(leafless_init(&surface, sizeof surface));
    surface.attribute = attribute;
    surface.transfer = &transfer;
    for (x = 0; x < 2; x++) {
        if (x == 0) {
            OK(leafless_layer_from_octree(octree, &surface, &layer));
        } else {
            OK(leafless_layer_from_solid(solid, &frame, &surface, &layer));
        }
        take(&shot, layer);
        CHECK(pixel(SIDE / 2, SIDE / 2)[1] < 3 && pixel(SIDE / 2, SIDE / 2)[2] > 60);
        leafless_layer_free(layer);
    }
    leafless_attribute_free(attribute);
    leafless_octree_free(octree);
    leafless_solid_free(solid);
}

static void volumes(void) {
    const uint64_t code = 0;
    const uint8_t level = 0, inside = LEAFLESS_VOXEL_KIND_INSIDE;
    const leafless_frame frame = check_frame(4);
    leafless_voxel_arrays voxels;
    leafless_transfer transfer;
    leafless_layer *layer;
    leafless_shot shot = shot_of(1);
    leafless_solid *solid = check_ball_solid();
    leafless_octree *octree = check_ball(5, LEAFLESS_RULE_CERTIFIED);
    uint64_t *codes, count, again, i;
    uint8_t *levels, *kinds;
    double *parts, volume = 0, weight;
    leafless_frame lattice;
    const uint8_t *middle = pixel(SIDE / 2, SIDE / 2);
    OK(leafless_init(&transfer, sizeof transfer));
    transfer.range_upper = 1;
    transfer.alpha_lower = transfer.alpha_upper = 0.5;
    transfer.length_model = 1;
    OK(leafless_init(&voxels, sizeof voxels));
    voxels.lattice = frame;
    voxels.count = 1;
    voxels.codes = &code;
    voxels.levels = &level;
    voxels.kinds = &inside;
    /* Two units of a medium that transmits one half. */
    OK(leafless_layer_new_voxels(&voxels, &transfer, 0, &layer));
    take(&shot, layer);
    CHECK(abs(middle[3] - 191) <= 1 && abs(middle[0] - 160) <= 1);
    CHECK(isinf(depths[SIDE / 2 + SIDE * (SIDE / 2)]));
    leafless_layer_free(layer);
    /* A voxel of two units, as published; one that is half filled. */
    OK(leafless_layer_new_voxels(&voxels, &transfer, 2, &layer));
    take(&shot, layer);
    CHECK(abs(middle[3] - 128) <= 1);
    leafless_layer_free(layer);
    weight = 0.5;
    voxels.weights = &weight;
    OK(leafless_layer_new_voxels(&voxels, &transfer, 0, &layer));
    take(&shot, layer);
    CHECK(abs(middle[3] - 128) <= 1);
    leafless_layer_free(layer);
    weight = 2;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_layer_new_voxels(&voxels, &transfer, 0, &layer));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_layer_new_voxels(&voxels, &transfer, -1, &layer));
    transfer.map = 99;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_layer_new_voxels(&voxels, &transfer, 0, &layer));
    /* The parts of a ball's voxels that are solid add up to its volume. */
    OK(leafless_octree_voxels(octree, NULL, NULL, &lattice, NULL, NULL, NULL, NULL, NULL, 0, &count));
    codes = (uint64_t *)malloc(count * sizeof *codes);
    levels = (uint8_t *)malloc(count);
    kinds = (uint8_t *)malloc(count);
    parts = (double *)malloc(count * sizeof *parts);
    CHECK(codes && levels && kinds && parts);
    OK(leafless_octree_voxels(octree, NULL, NULL, &lattice, codes, levels, kinds, NULL, NULL, count, &again));
    OK(leafless_voxels_solid_parts(&lattice, codes, levels, kinds, count, solid, NULL, parts));
    for (i = 0; i < count; i++) {
        const double edge = lattice.edge / (double)(1u << levels[i]);
        volume += parts[i] * edge * edge * edge;
    }
    CHECK(fabs(volume - 4.0 / 3 * 3.14159265358979 * 0.75 * 0.75 * 0.75) < 1e-4);
    free(parts);
    free(kinds);
    free(levels);
    free(codes);
    leafless_octree_free(octree);
    leafless_solid_free(solid);
}

static void buffers(void) {
    const leafless_layer *none = NULL;
    leafless_octree *octree = check_ball(6, LEAFLESS_RULE_CERTIFIED);
    leafless_layer *layer;
    leafless_shot shot = shot_of(0);
    leafless_options options;
    leafless_control *control;
    uint8_t first[sizeof colours];
    float one_depth = 5;
    size_t i;
    OK(leafless_layer_from_octree(octree, NULL, &layer));
    take(&shot, layer);
    memcpy(first, colours, sizeof colours);
    /* The same for any number of threads; with and without buffers. */
    OK(leafless_init(&options, sizeof options));
    for (options.threads = 1; options.threads < 5; options.threads += 3) {
        const leafless_layer *layers[1];
        layers[0] = layer;
        memset(colours, 7, sizeof colours);
        OK(leafless_picture_render(&shot, layers, 1, &options, colours, sizeof colours, NULL, 0));
        CHECK(memcmp(first, colours, sizeof colours) == 0);
    }
    {
        const leafless_layer *layers[2];
        layers[0] = layers[1] = layer;
        memset(colours, 7, sizeof colours);
        FAILS(LEAFLESS_E_BUFFER, leafless_picture_render(&shot, layers, 1, NULL, colours, sizeof colours - 1, NULL, 0));
        FAILS(LEAFLESS_E_BUFFER, leafless_picture_render(&shot, layers, 1, NULL, colours, sizeof colours, &one_depth, 1));
        for (i = 0; i < sizeof colours; i++) {
            CHECK(colours[i] == 7);
        }
        CHECK(one_depth == 5);
        OK(leafless_picture_render(&shot, layers, 2, NULL, colours, sizeof colours, NULL, 0));
        CHECK(memcmp(first, colours, sizeof colours) == 0);
        OK(leafless_control_new(&control));
        OK(leafless_control_cancel(control));
        options.control = control;
        FAILS(LEAFLESS_E_CANCELLED, leafless_picture_render(&shot, layers, 1, &options, colours, sizeof colours, NULL, 0));
        leafless_control_free(control);
    }
    /* What a pixel shows is where its line of sight is at its depth. */
    {
        const leafless_layer *layers[1];
        double from[3], along[3], square = 0;
        int axis;
        layers[0] = layer;
        shot.samples = 1;
        OK(leafless_picture_render(&shot, layers, 1, NULL, NULL, 0, depths, PIXELS));
        OK(leafless_shot_line_of_sight(&shot, 40.5, 60.5, from, along));
        for (axis = 0; axis < 3; axis++) {
            const double at = from[axis] + (double)depths[40 + 60 * SIDE] * along[axis];
            square += at * at;
        }
        CHECK(fabs(sqrt(square) - 0.75) < 4.0 / 64);
    }
    /* Nothing at all: the background. */
    shot.background[0] = shot.background[3] = 255;
    OK(leafless_picture_render(&shot, NULL, 0, NULL, colours, sizeof colours, depths, PIXELS));
    CHECK(is(pixel(5, 5), shot.background) && isinf(depths[7]));
    FAILS(LEAFLESS_E_NULL, leafless_picture_render(&shot, &none, 1, NULL, colours, sizeof colours, NULL, 0));
    shot.samples = 5;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_picture_render(&shot, NULL, 0, NULL, colours, sizeof colours, NULL, 0));
    shot.samples = 1;
    shot.width = 0;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_picture_render(&shot, NULL, 0, NULL, colours, sizeof colours, NULL, 0));
    shot.width = UINT32_MAX;
    FAILS(LEAFLESS_E_BUFFER, leafless_picture_render(&shot, NULL, 0, NULL, colours, sizeof colours, NULL, 0));
    shot.width = SIDE;
    shot.camera.up[2] = 0;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_picture_render(&shot, NULL, 0, NULL, colours, sizeof colours, NULL, 0));
    leafless_layer_free(layer);
    leafless_octree_free(octree);
}

static void files(void) {
    enum { WIDE = 200, HIGH = 150 };
    static uint8_t large[4 * WIDE * HIGH], before[4 * WIDE * HIGH];
    static const char PATH[] = "picture.png";
    static const uint8_t START[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    const leafless_legend_name names[2] = {{"FULL", 4, {0, 114, 178, 255}, 0}, {"EMPTY", 5, {86, 180, 233, 40}, 0}};
    leafless_legend_box box;
    leafless_transfer transfer;
    uint64_t length, again;
    uint8_t *bytes, *read;
    uint32_t x, y;
    FILE *file;
    memset(large, 255, sizeof large);
    OK(leafless_init(&transfer, sizeof transfer));
    transfer.range_upper = 100;
    OK(leafless_picture_draw_bar(large, WIDE, HIGH, "heat", 4, &transfer, LEAFLESS_LEGEND_SIDE_RIGHT, &box));
    CHECK(box.width > 0 && box.left + box.width == WIDE && box.top + box.height <= HIGH);
    memcpy(before, large, sizeof large);
    OK(leafless_picture_draw_names(large, WIDE, HIGH, "tags", 4, names, 2, LEAFLESS_LEGEND_SIDE_BOTTOM, &box));
    CHECK(box.height > 0 && box.height <= HIGH / 3 && box.top + box.height == HIGH);
    for (y = 0; y < HIGH; y++) {
        for (x = 0; x < WIDE; x++) {
            const int covered = x >= box.left && x < box.left + box.width && y >= box.top;
            CHECK(covered || is(large + 4 * (x + WIDE * y), before + 4 * (x + WIDE * y)));
        }
    }
    CHECK(memcmp(large, before, sizeof large) != 0);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_picture_draw_names(large, WIDE, HIGH, "", 0, names, 2, 2, &box));
    FAILS(LEAFLESS_E_UTF8, leafless_picture_draw_names(large, WIDE, HIGH, "\xff", 1, names, 2, 0, &box));
    OK(leafless_picture_draw_names(colours, SIDE, SIDE, "tags", 4, names, 2, 0, &box));
    CHECK(box.width == 0 && box.height == 0);
    /* In memory and in a file. */
    OK(picture_to_bytes(large, WIDE, HIGH, NULL, 0, &length));
    bytes = (uint8_t *)malloc(length);
    read = (uint8_t *)malloc(length + 1);
    CHECK(bytes && read);
    FAILS(LEAFLESS_E_BUFFER, picture_to_bytes(large, WIDE, HIGH, bytes, length - 1, &again));
    OK(picture_to_bytes(large, WIDE, HIGH, bytes, length, &again));
    CHECK(again == length && memcmp(bytes, START, 8) == 0 && bytes[19] == WIDE && bytes[23] == HIGH);
    OK(picture_save(large, WIDE, HIGH, PATH, sizeof PATH - 1));
    file = fopen(PATH, "rb");
    CHECK(file && fread(read, 1, length + 1, file) == length && memcmp(read, bytes, length) == 0);
    (void)fclose(file);
    (void)remove(PATH);
    FAILS(LEAFLESS_E_IO, picture_save(large, WIDE, HIGH, "no/such/folder/x.png", 20));
    FAILS(LEAFLESS_E_ARGUMENT, picture_to_bytes(large, 0, HIGH, NULL, 0, &length));
    free(read);
    free(bytes);
}

int main(void) {
    look_from_front();
    surfaces();
    lines();
    sections();
    volumes();
    buffers();
    files();
    return 0;
}
