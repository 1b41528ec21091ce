/* A part of two materials with one hot side: materials and temperatures are channels of its octree. They are carried
 * through a Boolean, saved with the solid, and read in place from the mapped file.
 *
 *     attributes [FILE]
 *
 * include/README.md describes how to build it.
 */
#include <leafless.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { DEPTH = 8, STEEL = 1, COPPER = 2 };

/* The cube that contains all parts, in millimetres. */
static const leafless_frame FRAME = {{-64, -64, -64}, 128, DEPTH};

/* The parameters of the temperature. */
typedef struct {
    double cold, hot, from, to;
} gradient;

static double clamped(double x) {
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

static double temperature(const gradient *g, double x) {
    return g->cold + (g->hot - g->cold) * clamped((x - g->from) / (g->to - g->from));
}

static int32_t temperatures(void *ctx, const double *points, uint64_t count, double *values) {
    uint64_t i;
    for (i = 0; i < count; i++) {
        values[i] = temperature((const gradient *)ctx, points[3 * i]);
    }
    return 0;
}

/* The temperature rises along x, so its extremes are at the faces of a box; rounding is less than a millionth. */
static int32_t temperature_range(void *ctx, const double *min, const double *max, leafless_value_range *range) {
    range->kind = LEAFLESS_RANGE_KIND_WITHIN;
    range->values[0].lower = temperature((const gradient *)ctx, min[0]) - 1e-6;
    range->values[0].upper = temperature((const gradient *)ctx, max[0]) + 1e-6;
    return 0;
}

/* Fills a channel inside an octree and attaches it: `*octree` becomes the octree with the channel. */
static leafless_status attach(leafless_octree **octree, const leafless_attribute *attribute,
                              leafless_channel_fill_options *fill, const char *name) {
    leafless_channel *channel = NULL;
    leafless_octree *with = NULL;
    leafless_status s;
    fill->solid = *octree;
    fill->name = name;
    fill->name_length = strlen(name);
    s = leafless_channel_fill(attribute, NULL, fill, NULL, &channel);
    if (!s) s = leafless_octree_with_channel(*octree, channel, &with);
    leafless_channel_free(channel);
    if (!s) {
        leafless_octree_free(*octree);
        *octree = with;
    }
    return s;
}

/* Makes the octree of a solid of one material, with the temperature at each point. */
static leafless_status part(const leafless_solid *solid, int number, const leafless_attribute *heat,
                            leafless_octree **octree) {
    const double value = number;
    leafless_channel_fill_options material = {.struct_size = sizeof material, .scalar = LEAFLESS_SCALAR_TYPE_U8};
    /* A cell of the channel is fine enough if the temperature in it varies by at most three degrees. */
    leafless_channel_fill_options degrees = {.struct_size = sizeof degrees,
                                             .scalar = LEAFLESS_SCALAR_TYPE_F32,
                                             .criterion = LEAFLESS_CRITERION_RANGE,
                                             .tolerance = 3.0};
    leafless_attribute *one = NULL;
    leafless_status s = leafless_octree_build(solid, &FRAME, LEAFLESS_RULE_CERTIFIED, NULL, octree);
    if (!s) s = leafless_attribute_new_constant(&value, 1, &one);
    if (!s) s = attach(octree, one, &material, "material");
    if (!s) s = attach(octree, heat, &degrees, "temperature");
    leafless_attribute_free(one);
    return s;
}

/* Prints the channels of an octree and their sizes. */
static leafless_status print_channels(const leafless_octree *octree) {
    static const char *const types[] = {"f32", "u8", "u16", "u32"};
    leafless_octree_info of_octree = LEAFLESS_INIT(leafless_octree_info);
    uint64_t i;
    leafless_status s = leafless_octree_describe(octree, &of_octree);
    for (i = 0; !s && i < of_octree.channels; i++) {
        leafless_channel *channel = NULL;
        leafless_channel_info info = LEAFLESS_INIT(leafless_channel_info);
        const char *name = "";
        size_t length = 0;
        s = leafless_octree_channel_at(octree, i, &channel);
        if (!s) s = leafless_channel_describe(channel, &info);
        if (!s) s = leafless_channel_peek_metadata(channel, "name", 4, &name, &length);
        if (!s) {
            printf("%-12.*s %-3s  depth %u  %6lu values  %7lu bytes\n", (int)length, name, types[info.scalar],
                   (unsigned)info.frame.depth, (unsigned long)info.value_count, (unsigned long)info.bytes);
        }
        leafless_channel_free(channel);
    }
    return s;
}

/* Prints the values of both channels along the axis of the rod. */
static leafless_status print_values(const leafless_octree *octree) {
    enum { POINTS = 7 };
    double points[POINTS][3] = {{0}}, materials[POINTS], degrees[POINTS];
    leafless_channel *material = NULL, *heat = NULL;
    leafless_status s = leafless_octree_channel(octree, "material", 8, &material);
    int i;
    for (i = 0; i < POINTS; i++) {
        points[i][0] = -54 + 18 * i;
    }
    if (!s) s = leafless_octree_channel(octree, "temperature", 11, &heat);
    if (!s) s = leafless_channel_values(material, &points[0][0], POINTS, materials);
    if (!s) s = leafless_channel_values(heat, &points[0][0], POINTS, degrees);
    for (i = 0; !s && i < POINTS; i++) {
        printf("x = %3.0f    %-6s  %5.1f degrees\n", points[i][0],
               materials[i] == STEEL ? "steel" : materials[i] == COPPER ? "copper" : "none", degrees[i]);
    }
    leafless_channel_free(material), leafless_channel_free(heat);
    return s;
}

int main(int argc, char **argv) {
    const char *path = argc > 1 ? argv[1] : "attributes.lfl";
    const leafless_sink file = leafless_to_file(path);
    const leafless_source in_place = leafless_from_file(path, LEAFLESS_ACCESS_MAP);
    const double low[3] = {-30, -30, -30}, high[3] = {30, 30, 30};
    const double left[3] = {-60, 0, 0}, right[3] = {60, 0, 0};
    gradient along_x = {20, 180, -60, 60};
    const leafless_attribute_callbacks callbacks = {.struct_size = sizeof callbacks,
                                                    .components = 1,
                                                    .values = temperatures,
                                                    .range = temperature_range,
                                                    .ctx = &along_x};
    /* Where block and rod overlap, the rod is inside: its material counts. */
    const leafless_carry_rule rules[] = {{"material", 8, LEAFLESS_CARRY_RIGHT}};
    const leafless_octree *parts[2];
    leafless_attribute *heat = NULL;
    leafless_solid *block = NULL, *rod = NULL;
    leafless_octree *steel = NULL, *copper = NULL, *both = NULL, *whole = NULL, *stored = NULL;
    leafless_status s = leafless_attribute_new_callbacks(&callbacks, &heat);
    if (!s) s = leafless_solid_new_box(low, high, &block);
    if (!s) s = leafless_solid_new_cylinder(left, right, 12, &rod);
    if (!s) s = part(block, STEEL, heat, &steel);
    if (!s) s = part(rod, COPPER, heat, &copper);
    parts[0] = steel, parts[1] = copper;
    if (!s) s = leafless_octree_combine(LEAFLESS_OPERATION_UNION, parts, 2, NULL, &both);
    if (!s) s = leafless_octree_carry_channels(both, parts, 2, LEAFLESS_CARRY_MEAN, rules, 1, NULL, &whole);
    if (!s) s = leafless_octree_write(whole, &file);
    /* Channels of a mapped file are read in place. */
    if (!s) s = leafless_octree_read(&in_place, &stored);
    if (!s) s = print_channels(stored);
    if (!s) s = print_values(stored);
    if (s) {
        char message[512];
        leafless_last_error(message, sizeof message);
        fprintf(stderr, "%s: %s\n", leafless_status_name(s), message);
    }
    leafless_octree_free(stored), leafless_octree_free(whole), leafless_octree_free(both);
    leafless_octree_free(copper), leafless_octree_free(steel);
    leafless_solid_free(rod), leafless_solid_free(block);
    leafless_attribute_free(heat);
    return s ? 1 : 0;
}
