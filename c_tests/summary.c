/* What channels amount to in boxes, their regions, materials of a ball, and volumes as attributes. */
#include "check.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

static bool contains(leafless_interval interval, double value) {
    return interval.lower <= value && value <= interval.upper;
}

/* The channel of a number inside of an octree, or in all of the cube. */
static leafless_channel *uniform(const leafless_octree *solid, const leafless_frame *frame, double value) {
    leafless_channel_fill_options fill;
    leafless_attribute *attribute = NULL;
    leafless_channel *channel = NULL;
    OK(leafless_init(&fill, sizeof fill));
    fill.solid = solid;
    OK(leafless_attribute_new_constant(&value, 1, &attribute));
    OK(leafless_channel_fill(attribute, frame, &fill, NULL, &channel));
    leafless_attribute_free(attribute);
    return channel;
}

/* 2 where z > 0, else 1. */
static leafless_channel *halves(const leafless_frame *frame) {
    const double low[3] = {-1, -1, 0}, high[3] = {1, 1, 1}, two = 2;
    leafless_channel *all = uniform(NULL, frame, 1), *result = NULL;
    leafless_solid *box = NULL;
    leafless_octree *upper = NULL;
    OK(leafless_solid_new_box(low, high, &box));
    OK(leafless_octree_build(box, frame, LEAFLESS_RULE_CERTIFIED, NULL, &upper));
    OK(leafless_channel_with_value_in(all, upper, &two, NULL, &result));
    leafless_octree_free(upper);
    leafless_solid_free(box);
    leafless_channel_free(all);
    return result;
}

static void summaries(void) {
    leafless_octree *ball = check_ball(6, LEAFLESS_RULE_CERTIFIED);
    const double volume = 4.0 / 3.0 * PI * 0.75 * 0.75 * 0.75;
    const double low[3] = {0, 0, 0}, high[3] = {INFINITY, 2, 1}, far[3] = {3, 3, 3}, beyond[3] = {4, 4, 4};
    leafless_channel *density = uniform(ball, NULL, 0.5);
    leafless_channel_summary summary = LEAFLESS_INIT(leafless_channel_summary);
    const leafless_frame frame = check_frame(3);
    leafless_channel *two = halves(&frame);
    OK(leafless_channel_summarise(density, ball, NULL, NULL, NULL, &summary));
    CHECK(summary.has_values && summary.least[0] == 0.5 && summary.greatest[0] == 0.5 && summary.least[1] == 0);
    CHECK(contains(summary.volume_model, volume) && contains(summary.integral[0], 0.5 * volume));
    CHECK(summary.integral[0].upper - summary.integral[0].lower < 0.2 * volume);
    CHECK(contains(summary.mean[0], 0.5) && summary.volume_without_model.lower == 0);
    OK(leafless_channel_summarise(density, ball, low, high, NULL, &summary));
    CHECK(contains(summary.volume_model, volume / 8));
    /* Nothing there: all is 0. */
    memset(&summary, 0x5a, sizeof summary);
    summary.struct_size = sizeof summary;
    OK(leafless_channel_summarise(density, ball, far, beyond, NULL, &summary));
    CHECK(!summary.has_values && summary.volume_model.upper == 0 && summary.greatest[3] == 0);
    OK(leafless_channel_summarise(two, NULL, NULL, NULL, NULL, &summary));
    CHECK(summary.least[0] == 1 && summary.greatest[0] == 2);
    CHECK(contains(summary.volume_model, 8) && contains(summary.integral[0], 12) && contains(summary.mean[0], 1.5));
    CHECK(summary.mean[0].upper - summary.mean[0].lower < 1e-9);
    leafless_channel_free(two);
    leafless_channel_free(density);
    leafless_octree_free(ball);
}

static void regions(void) {
    const leafless_frame frame = check_frame(4);
    leafless_channel *two = halves(&frame);
    const double low = 1.5, high = INFINITY, none = 3;
    leafless_octree *region = NULL, *empty = NULL;
    leafless_statistics statistics;
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
    OK(leafless_channel_region(two, &low, &high, NULL, &region));
    OK(leafless_octree_statistics(region, &statistics));
    CHECK(statistics.lower_cells == 2048 && statistics.upper_cells == 2048);
    OK(leafless_octree_describe(region, &info));
    CHECK(info.is_binary && info.frame.depth == 4);
    OK(leafless_channel_region(two, &none, &high, NULL, &empty));
    OK(leafless_octree_statistics(empty, &statistics));
    CHECK(statistics.upper_cells == 0);
    leafless_octree_free(empty);
    leafless_octree_free(region);
    leafless_channel_free(two);
}

static void materials(void) {
    const leafless_frame frame = check_frame(5), fine = check_frame(20), apart = {{0, 0, 0}, 1, 5};
    const double half = 2.0 / 3.0 * PI * 0.75 * 0.75 * 0.75;
    leafless_solid *ball = check_ball_solid();
    leafless_channel *two = halves(&frame);
    leafless_material found[2];
    uint64_t count = 77;
    int i;
    OK(leafless_solid_materials(ball, two, &fine, 1e-3, 0, NULL, NULL, 0, &count));
    CHECK(count == 2);
    count = 77;
    FAILS(LEAFLESS_E_BUFFER, leafless_solid_materials(ball, two, &fine, 1e-3, 0, NULL, found, 1, &count));
    FAILS(LEAFLESS_E_FRAME, leafless_solid_materials(ball, two, &apart, 1e-3, 0, NULL, found, 2, &count));
    CHECK(count == 77);
    OK(leafless_solid_materials(ball, two, &fine, 1e-3, 0, NULL, found, 2, &count));
    for (i = 0; i < 2; i++) {
        const leafless_interval volume = found[i].measures.volume_model, z = found[i].measures.centroid_model[2];
        CHECK(found[i].value[0] == i + 1 && found[i].value[1] == 0);
        CHECK(contains(volume, half) && volume.upper - volume.lower < 2e-3 * half);
        /* The centroid of a half ball is 3/8 of its radius from the face. */
        CHECK(found[i].measures.has_centroid && contains(z, (i == 0 ? -1 : 1) * 0.375 * 0.75));
    }
    leafless_channel_free(two);
    leafless_solid_free(ball);
}

/* Samples that rise along x: 0, 10, 20, 30 at 0.5, 1.5, 2.5, 3.5. */
static void volumes(void) {
    uint8_t samples[4 * 2 * 2];
    leafless_volume_layout layout;
    leafless_volume *volume = NULL;
    leafless_attribute *smooth = NULL, *steps = NULL, *turned = NULL;
    const double points[3][3] = {{1, 1, 1}, {2.25, 0.75, 1}, {5, 1, 1}}, low[3] = {1, 1, 1}, high[3] = {2, 1.5, 1.5};
    static const char NRRD[] = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 1 1\nencoding: raw\nspace dimension: 3\n"
                               "space directions: (0,1,0) (-1,0,0) (0,0,1)\nspace origin: (10,20,30)\n\n\x05\x09";
    const double first[2][3] = {{10, 20, 30}, {10, 21, 30}};
    leafless_value_range range;
    double values[3];
    int i;
    for (i = 0; i < 16; i++) {
        samples[i] = (uint8_t)(10 * (i % 4));
    }
    OK(leafless_init(&layout, sizeof layout));
    layout.sample_type = LEAFLESS_SAMPLE_TYPE_U8;
    layout.extents[0] = 4;
    layout.extents[1] = layout.extents[2] = 2;
    OK(volume_of_array(&layout, samples, sizeof samples, &volume));
    OK(leafless_attribute_from_volume(volume, LEAFLESS_INTERPOLATION_TRILINEAR, NULL, &smooth));
    OK(leafless_attribute_from_volume(volume, LEAFLESS_INTERPOLATION_NEAREST, NULL, &steps));
    leafless_volume_free(volume);
    volume = NULL;
    OK(leafless_attribute_values(steps, &points[0][0], 3, values));
    CHECK(values[0] == 10 && values[1] == 20 && isnan(values[2]));
    OK(leafless_attribute_values(smooth, &points[0][0], 3, values));
    CHECK(fabs(values[0] - 5) < 1e-9 && fabs(values[1] - 17.5) < 1e-9 && isnan(values[2]));
    OK(leafless_attribute_range(smooth, low, high, &range));
    CHECK(range.kind == LEAFLESS_RANGE_KIND_WITHIN && range.values[0].lower <= 5 && range.values[0].upper >= 15);
    leafless_attribute_free(smooth);
    leafless_attribute_free(steps);
    OK(volume_from_bytes((const uint8_t *)NRRD, sizeof NRRD - 1, NULL, 0, &volume));
    OK(leafless_attribute_from_volume(volume, LEAFLESS_INTERPOLATION_NEAREST, NULL, &turned));
    OK(leafless_attribute_values(turned, &first[0][0], 2, values));
    CHECK(values[0] == 5 && values[1] == 9);
    leafless_attribute_free(turned);
    leafless_volume_free(volume);
}

int main(void) {
    summaries();
    regions();
    materials();
    volumes();
    return 0;
}
