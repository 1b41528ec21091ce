/* Attributes and channels: filled, queried, changed, carried, saved and read again, against queries cell by cell. */
#include "check.h"

#include <math.h>

enum { DEPTH = 4, SIDE = 1 << DEPTH };

/* What the host counts. */
typedef struct {
    int calls, points, ranges, destroyed, fails_at;
    uint32_t kind;
} host;

/* Three numbers that change along the axes; none where x + y > 1.2. */
static void number(const double *at, double *value) {
    if (at[0] + at[1] > 1.2) {
        return;
    }
    value[0] = 100.0 + 100.0 * at[0];
    value[1] = 7.0 * (1.0 + at[1]);
    value[2] = at[2] > 0.25 ? 3.0 : 9.0;
}

static int32_t value_at(void *ctx, const double *point, double *value) {
    host *const own = (host *)ctx;
    own->calls++;
    CHECK(isnan(value[0]) && isnan(value[1]) && isnan(value[2]));
    number(point, value);
    return own->calls == own->fails_at ? -77 : 0;
}

static int32_t values_at(void *ctx, const double *points, uint64_t count, double *values) {
    host *const own = (host *)ctx;
    uint64_t i;
    own->calls++;
    own->points += (int)count;
    for (i = 0; i < count; i++) {
        CHECK(isnan(values[3 * i]) && isnan(values[3 * i + 2]));
        number(points + 3 * i, values + 3 * i);
    }
    return 0;
}

static int32_t one_number_at(void *ctx, const double *point, double *value) {
    const host *const own = (const host *)ctx;
    (void)own;
    *value = point[2];
    return 0;
}

static int32_t range_along_z(void *ctx, const double *min, const double *max, leafless_value_range *range) {
    host *const own = (host *)ctx;
    own->ranges++;
    CHECK(range->kind == LEAFLESS_RANGE_KIND_UNKNOWN && isnan(range->values[0].lower) && isnan(range->values[3].upper));
    range->kind = own->kind;
    range->values[0].lower = min[2];
    range->values[0].upper = max[2];
    return own->ranges == own->fails_at ? 4711 : 0;
}

static void destroyed(void *ctx) {
    ((host *)ctx)->destroyed++;
}

static leafless_attribute *host_attribute(host *own, bool many) {
    leafless_attribute_callbacks callbacks;
    leafless_attribute *attribute = NULL;
    OK(leafless_init(&callbacks, sizeof callbacks));
    callbacks.components = 3;
    callbacks.value = value_at;
    callbacks.values = many ? values_at : NULL;
    callbacks.destroy = destroyed;
    callbacks.ctx = own;
    OK(leafless_attribute_new_callbacks(&callbacks, &attribute));
    return attribute;
}

static leafless_attribute *along_z(host *own) {
    leafless_attribute_callbacks callbacks;
    leafless_attribute *attribute = NULL;
    OK(leafless_init(&callbacks, sizeof callbacks));
    callbacks.components = 1;
    callbacks.value = one_number_at;
    callbacks.range = range_along_z;
    callbacks.ctx = own;
    OK(leafless_attribute_new_callbacks(&callbacks, &attribute));
    return attribute;
}

static leafless_attribute *constant(double value) {
    leafless_attribute *attribute = NULL;
    OK(leafless_attribute_new_constant(&value, 1, &attribute));
    return attribute;
}

static leafless_channel_fill_options fill_options(void) {
    leafless_channel_fill_options fill;
    OK(leafless_init(&fill, sizeof fill));
    return fill;
}

static bool same(const leafless_channel *a, const leafless_channel *b) {
    bool equal = false;
    OK(leafless_channel_equal(a, b, &equal));
    return equal;
}

/* The channel of one number inside a solid. */
static leafless_channel *uniform(const leafless_octree *solid, double value, uint32_t scalar, const char *name) {
    leafless_channel_fill_options fill = fill_options();
    leafless_attribute *attribute = constant(value);
    leafless_channel *channel = NULL;
    fill.solid = solid;
    fill.scalar = scalar;
    fill.name = name;
    fill.name_length = strlen(name);
    OK(leafless_channel_fill(attribute, NULL, &fill, NULL, &channel));
    leafless_attribute_free(attribute);
    return channel;
}

static bool is_named(const leafless_channel *channel, const char *key, const char *expected) {
    const char *value = NULL;
    size_t length = 0;
    OK(leafless_channel_peek_metadata(channel, key, strlen(key), &value, &length));
    return expected == NULL ? value == NULL : length == strlen(expected) && memcmp(value, expected, length) == 0;
}

static double first_at(const leafless_octree *octree, const char *name, double x, double y, double z) {
    const double point[3] = {x, y, z};
    double value[4] = {-1, -1, -1, -1};
    leafless_channel *channel = NULL;
    OK(leafless_octree_channel(octree, name, strlen(name), &channel));
    OK(leafless_channel_value(channel, point, value));
    leafless_channel_free(channel);
    return value[0];
}

static double rounded(double value, uint32_t scalar) {
    return scalar == LEAFLESS_SCALAR_TYPE_F32 ? (double)(float)value : rint(value);
}

static void attributes(void) {
    const double points[5][3] = {{0, 0, 0}, {0.5, 0.25, 0.75}, {1, 1, 1}, {-3, 2, 0.125}, {NAN, 0, 0}};
    const double shift[12] = {0, -1, 0, 0.5, 1, 0, 0, 0, 0, 0, 2, 0};
    const double low[3] = {0, 0, 0.25}, high[3] = {1, 1, 0.5};
    const double colour[4] = {1, 2, 3, INFINITY};
    host own = {0}, many = {0}, z = {0};
    leafless_attribute *one = host_attribute(&own, false), *batch = host_attribute(&many, true);
    leafless_attribute *placed = NULL, *reference = NULL, *attribute = NULL, *up = along_z(&z);
    leafless_value_range range;
    double found[15], also[15], expected[3];
    static double crowd[3 * 1000], numbers[3 * 1000];
    leafless_attribute_info info = LEAFLESS_INIT(leafless_attribute_info);
    int i, k;
    OK(leafless_attribute_describe(one, &info));
    CHECK(info.components == 3 && info.bytes == 0);
    OK(leafless_attribute_values(one, &points[0][0], 5, found));
    OK(leafless_attribute_values(batch, &points[0][0], 5, also));
    CHECK(own.calls == 5 && many.calls == 1 && many.points == 5);
    for (i = 0; i < 4; i++) {
        expected[0] = expected[1] = expected[2] = NAN;
        number(points[i], expected);
        for (k = 0; k < 3; k++) {
            CHECK(isnan(expected[k]) ? isnan(found[3 * i + k]) : found[3 * i + k] == expected[k]);
            CHECK(isnan(expected[k]) ? isnan(also[3 * i + k]) : also[3 * i + k] == expected[k]);
        }
    }
    CHECK(isnan(found[6]) && isnan(found[8]));
    /* Many points are queried in several calls. */
    for (i = 0; i < 1000; i++) {
        crowd[3 * i] = i * 0.001;
    }
    OK(leafless_attribute_values(batch, crowd, 1000, numbers));
    CHECK(many.points == 1005 && many.calls < 10);
    for (i = 0; i < 1000; i++) {
        CHECK(numbers[3 * i] == 100.0 + 100.0 * crowd[3 * i] && numbers[3 * i + 1] == 7.0);
    }
    /* Its own errors reach the host. */
    own.fails_at = own.calls + 2;
    FAILS(LEAFLESS_E_CALLBACK, leafless_attribute_values(one, &points[0][0], 5, found));
    own.fails_at = 0;
    /* In another place: the image of (0.5, 0.25, 0.75) is (0.25, 0.5, 1.5). */
    OK(leafless_attribute_placed(one, shift, &placed));
    leafless_attribute_free(one);
    CHECK(own.destroyed == 0);
    {
        const double image[3] = {0.25, 0.5, 1.5};
        OK(leafless_attribute_values(placed, image, 1, found));
        expected[0] = NAN;
        number(points[1], expected);
        CHECK(found[0] == expected[0] && found[1] == expected[1] && found[2] == expected[2]);
    }
    OK(leafless_attribute_ref(placed, &reference));
    leafless_attribute_free(placed);
    CHECK(own.destroyed == 0);
    leafless_attribute_free(reference);
    CHECK(own.destroyed == 1);
    /* Ranges. */
    OK(leafless_attribute_range(batch, low, high, &range));
    CHECK(range.kind == LEAFLESS_RANGE_KIND_UNKNOWN && isnan(range.values[0].lower));
    leafless_attribute_free(batch);
    CHECK(many.destroyed == 1);
    z.kind = LEAFLESS_RANGE_KIND_WITHIN;
    OK(leafless_attribute_range(up, low, high, &range));
    CHECK(range.kind == LEAFLESS_RANGE_KIND_WITHIN && range.values[0].lower == 0.25 && range.values[0].upper == 0.5);
    CHECK(isnan(range.values[1].lower));
    z.kind = LEAFLESS_RANGE_KIND_NOWHERE;
    OK(leafless_attribute_range(up, low, high, &range));
    CHECK(range.kind == LEAFLESS_RANGE_KIND_NOWHERE && isnan(range.values[0].lower));
    z.kind = 3;
    FAILS(LEAFLESS_E_CALLBACK, leafless_attribute_range(up, low, high, &range));
    z.kind = LEAFLESS_RANGE_KIND_WITHIN;
    z.fails_at = z.ranges + 1;
    FAILS(LEAFLESS_E_CALLBACK, leafless_attribute_range(up, low, high, &range));
    leafless_attribute_free(up);
    OK(leafless_attribute_new_constant(colour, 4, &attribute));
    OK(leafless_attribute_range(attribute, low, high, &range));
    CHECK(range.kind == LEAFLESS_RANGE_KIND_WITHIN && range.values[1].lower == 2 && range.values[3].upper == INFINITY);
    OK(leafless_attribute_values(attribute, &points[0][0], 1, found));
    CHECK(found[0] == 1 && found[3] == INFINITY);
    leafless_attribute_free(attribute);
}

/* Every type, one by one and in batches, on one thread and on several, against the values at centres. */
static void filled(void) {
    const leafless_frame frame = check_frame(DEPTH);
    const double step = 2.0 / SIDE;
    static double points[SIDE * SIDE * SIDE][3], values[SIDE * SIDE * SIDE][3];
    uint32_t scalar, x, y, z;
    int many, i = 0;
    for (z = 0; z < SIDE; z++) {
        for (y = 0; y < SIDE; y++) {
            for (x = 0; x < SIDE; x++, i++) {
                points[i][0] = -1 + (x + 0.5) * step;
                points[i][1] = -1 + (y + 0.5) * step;
                points[i][2] = -1 + (z + 0.5) * step;
            }
        }
    }
    for (scalar = 0; scalar < 4; scalar++) {
        leafless_channel *channels[2] = {NULL, NULL};
        for (many = 0; many < 2; many++) {
            host own = {0};
            leafless_attribute *attribute = host_attribute(&own, many);
            leafless_channel_fill_options fill = fill_options();
            leafless_options options;
            leafless_channel_info info = LEAFLESS_INIT(leafless_channel_info);
            OK(leafless_init(&options, sizeof options));
            options.threads = 1;
            fill.scalar = scalar;
            fill.components = 3;
            OK(leafless_channel_fill(attribute, &frame, &fill, &options, &channels[many]));
            OK(leafless_channel_check(channels[many]));
            CHECK(many ? own.points == SIDE * SIDE * SIDE && own.calls <= SIDE * SIDE * SIDE / 64
                       : own.calls == SIDE * SIDE * SIDE);
            leafless_attribute_free(attribute);
            CHECK(own.destroyed == 1);
            OK(leafless_channel_describe(channels[many], &info));
            CHECK(info.scalar == scalar && info.components == 3 && info.frame.depth == DEPTH && info.frame.edge == 2);
            CHECK(info.value_count > 100 && info.bytes >= 3 * info.value_count && info.elements > 1);
            CHECK(is_named(channels[many], "name", NULL));
        }
        CHECK(same(channels[0], channels[1]));
        OK(leafless_channel_values(channels[0], &points[0][0], COUNT(points), &values[0][0]));
        for (i = 0; i < (int)COUNT(points); i++) {
            const uint32_t cell[3] = {(uint32_t)i % SIDE, (uint32_t)i / SIDE % SIDE, (uint32_t)i / SIDE / SIDE};
            double expected[3] = {NAN, NAN, NAN}, value[4], at[4];
            int k;
            number(points[i], expected);
            OK(leafless_channel_value_at(channels[0], cell, value));
            OK(leafless_channel_value(channels[0], points[i], at));
            for (k = 0; k < 3; k++) {
                const double wanted = rounded(expected[k], scalar);
                CHECK(isnan(wanted) ? isnan(value[k]) : value[k] == wanted);
                CHECK(isnan(wanted) ? isnan(at[k]) : at[k] == wanted);
                CHECK(isnan(wanted) ? isnan(values[i][k]) : values[i][k] == wanted);
            }
            CHECK(isnan(expected[0]) ? isnan(value[3]) && isnan(at[3]) : value[3] == 0 && at[3] == 0);
        }
        leafless_channel_free(channels[0]);
        leafless_channel_free(channels[1]);
    }
    {
        /* Points outside the cube have no value, nor have points with NaN. */
        const double beyond[2][3] = {{1.5, 0, 0}, {0, NAN, 0}};
        const uint32_t cell[3] = {0, SIDE, 0};
        leafless_attribute *attribute = constant(4);
        leafless_channel *channel = NULL;
        leafless_channel_info info = LEAFLESS_INIT(leafless_channel_info);
        double value[4];
        OK(leafless_channel_fill(attribute, &frame, NULL, NULL, &channel));
        OK(leafless_channel_values(channel, &beyond[0][0], 2, value));
        CHECK(isnan(value[0]) && isnan(value[1]));
        OK(leafless_channel_value_at(channel, cell, value));
        CHECK(isnan(value[0]) && isnan(value[3]));
        OK(leafless_channel_describe(channel, &info));
        CHECK(info.value_count == 1 && info.bytes == 4 && info.elements == 0 && info.scalar == LEAFLESS_SCALAR_TYPE_F32);
        leafless_channel_free(channel);
        leafless_attribute_free(attribute);
    }
}

/* How finely values are followed. */
static void details(void) {
    const leafless_frame frame = check_frame(6);
    host z = {0};
    leafless_attribute *attribute = along_z(&z);
    leafless_channel_fill_options fill = fill_options();
    leafless_channel *fine = NULL, *coarse = NULL, *ranged = NULL, *varied = NULL, *mirror = NULL, *again = NULL;
    leafless_channel_info info = LEAFLESS_INIT(leafless_channel_info);
    double value[4];
    const double point[3] = {0.1, 0.2, 0.3};
    z.kind = LEAFLESS_RANGE_KIND_WITHIN;
    OK(leafless_channel_fill(attribute, &frame, &fill, NULL, &fine));
    OK(leafless_channel_describe(fine, &info));
    CHECK(info.value_count >= 64 && info.frame.depth == 6);
    OK(leafless_channel_value(fine, point, value));
    CHECK(fabs(value[0] - 0.3) <= 1.0 / 64);
    fill.depth = 3;
    OK(leafless_channel_fill(attribute, &frame, &fill, NULL, &coarse));
    OK(leafless_channel_describe(coarse, &info));
    CHECK(info.frame.depth == 3);
    OK(leafless_channel_value(coarse, point, value));
    CHECK(value[0] == 0.375);
    fill.depth = 0;
    fill.criterion = LEAFLESS_CRITERION_RANGE;
    fill.tolerance = 0.25;
    OK(leafless_channel_fill(attribute, &frame, &fill, NULL, &ranged));
    /* The same cells, in another tree. */
    OK(leafless_channel_value(ranged, point, value));
    CHECK(value[0] == 0.375);
    OK(leafless_channel_describe(ranged, &info));
    CHECK(info.frame.depth == 6 && info.value_count < 512);
    fill.criterion = LEAFLESS_CRITERION_VARIANCE;
    fill.tolerance = INFINITY;
    fill.coarse_model = fill.fine_model = 0.5;
    OK(leafless_channel_fill(attribute, &frame, &fill, NULL, &varied));
    OK(leafless_channel_value(varied, point, value));
    CHECK(value[0] == 0.25);
    {
        /* Turned upside down, and back by another fill. */
        const double over[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0};
        leafless_attribute *stored = NULL, *turned = NULL;
        OK(leafless_attribute_from_channel(fine, &stored));
        OK(leafless_attribute_placed(stored, over, &turned));
        leafless_attribute_free(stored);
        OK(leafless_channel_fill(turned, &frame, NULL, NULL, &mirror));
        leafless_attribute_free(turned);
        CHECK(!same(mirror, fine));
        OK(leafless_channel_value(mirror, point, value));
        CHECK(fabs(value[0] + 0.3) <= 1.0 / 64);
        OK(leafless_attribute_from_channel(mirror, &stored));
        OK(leafless_attribute_placed(stored, over, &turned));
        leafless_attribute_free(stored);
        OK(leafless_channel_fill(turned, &frame, NULL, NULL, &again));
        leafless_attribute_free(turned);
        CHECK(same(again, fine));
    }
    leafless_channel_free(fine);
    leafless_channel_free(coarse);
    leafless_channel_free(ranged);
    leafless_channel_free(varied);
    leafless_channel_free(mirror);
    leafless_channel_free(again);
    leafless_attribute_free(attribute);
}

static void metadata(void) {
    leafless_octree *ball = check_ball(3, LEAFLESS_RULE_CERTIFIED);
    leafless_channel *channel = uniform(ball, 2, LEAFLESS_SCALAR_TYPE_U8, "density");
    leafless_channel *unit = NULL, *bare = NULL, *renamed = NULL, *reference = NULL;
    const char *key = NULL, *value = NULL;
    static char large[1 << 16];
    size_t key_length = 0, value_length = 0;
    uint64_t count = 0;
    CHECK(is_named(channel, "name", "density"));
    OK(leafless_channel_with_metadata(channel, "unit", 4, "g/cm\xc2\xb3", 6, &unit));
    leafless_channel_free(channel);
    OK(leafless_channel_peek_metadata_at(unit, 1, &count, &key, &key_length, &value, &value_length));
    CHECK(count == 2 && key_length == 4 && memcmp(key, "unit", 4) == 0 && value_length == 6);
    OK(leafless_channel_with_metadata(unit, "name", 4, "mass", 4, &renamed));
    CHECK(is_named(renamed, "name", "mass") && is_named(renamed, "unit", "g/cm\xc2\xb3"));
    CHECK(is_named(unit, "name", "density"));
    CHECK(same(renamed, unit));
    OK(leafless_channel_without_metadata(unit, "name", 4, &bare));
    CHECK(is_named(bare, "name", NULL) && is_named(bare, "unit", "g/cm\xc2\xb3"));
    leafless_channel_free(bare);
    OK(leafless_channel_without_metadata(unit, NULL, 0, &bare));
    OK(leafless_channel_peek_metadata_at(bare, 0, &count, NULL, NULL, NULL, NULL));
    CHECK(count == 0);
    OK(leafless_channel_ref(bare, &reference));
    CHECK(reference == bare);
    leafless_channel_free(reference);
    memset(large, 'x', sizeof large);
    channel = NULL;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_channel_with_metadata(bare, "k", 1, large, sizeof large - 8, &channel));
    FAILS(LEAFLESS_E_UTF8, leafless_channel_with_metadata(bare, "\xff", 1, "", 0, &channel));
    CHECK(channel == NULL);
    OK(leafless_channel_with_metadata(bare, "k", 1, large, sizeof large - 9, &channel));
    leafless_channel_free(channel);
    leafless_channel_free(bare);
    leafless_channel_free(renamed);
    leafless_channel_free(unit);
    leafless_octree_free(ball);
}

static void regions(void) {
    leafless_octree *ball = check_ball(4, LEAFLESS_RULE_CERTIFIED), *box = check_box(5, -0.5, 0.0), *other = NULL;
    leafless_channel *channel = uniform(ball, 2, LEAFLESS_SCALAR_TYPE_U8, "material"), *changed = NULL, *taken = NULL;
    leafless_channel_info info = LEAFLESS_INIT(leafless_channel_info);
    leafless_frame elsewhere = {{0, 0, 0}, 1, 4};
    const double inside[3] = {-0.25, -0.25, -0.25}, outside[3] = {0.25, 0.25, 0.25};
    double value[4], number = 5, beyond = 256;
    OK(leafless_channel_with_value_in(channel, box, &number, NULL, &changed));
    OK(leafless_channel_check(changed));
    OK(leafless_channel_describe(changed, &info));
    CHECK(info.frame.depth == 5 && is_named(changed, "name", "material"));
    OK(leafless_channel_value(changed, inside, value));
    CHECK(value[0] == 5);
    OK(leafless_channel_value(changed, outside, value));
    CHECK(value[0] == 2);
    OK(leafless_channel_with_value_in(changed, box, NULL, NULL, &taken));
    OK(leafless_channel_value(taken, inside, value));
    CHECK(isnan(value[0]));
    OK(leafless_channel_value(taken, outside, value));
    CHECK(value[0] == 2);
    leafless_channel_free(taken);
    taken = NULL;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_channel_with_value_in(channel, box, &beyond, NULL, &taken));
    OK(leafless_octree_new_uniform(&elsewhere, LEAFLESS_TAG_FULL, LEAFLESS_TAG_EMPTY, &other));
    FAILS(LEAFLESS_E_FRAME, leafless_channel_with_value_in(channel, other, &number, NULL, &taken));
    CHECK(taken == NULL);
    leafless_octree_free(other);
    leafless_channel_free(changed);
    leafless_channel_free(channel);
    leafless_octree_free(ball);
    leafless_octree_free(box);
}

/* The octree with a channel; the octree is given back. */
static leafless_octree *bearing(leafless_octree *octree, double value, const char *name) {
    leafless_channel *channel = uniform(octree, value, LEAFLESS_SCALAR_TYPE_F32, name);
    leafless_octree *result = NULL;
    OK(leafless_octree_with_channel(octree, channel, &result));
    leafless_channel_free(channel);
    leafless_octree_free(octree);
    return result;
}

/* Both channels of `bearing` are there. */
static void keeps(leafless_octree *octree) {
    CHECK(check_channels(octree) == 2);
    CHECK(first_at(octree, "heat", 0, 0, 0) == 20.5 && first_at(octree, "material", 0, 0, 0) == 3);
    leafless_octree_free(octree);
}

static leafless_octree *two_channels(void) {
    return bearing(bearing(check_ball(4, LEAFLESS_RULE_CERTIFIED), 3, "material"), 20.5, "heat");
}

static void octrees(void) {
    leafless_octree *octree = two_channels(), *result = NULL, *bare = NULL, *other = NULL;
    leafless_channel *channel = NULL;
    leafless_frame elsewhere = {{0, 0, 0}, 1, 4};
    int i;
    CHECK(check_channels(octree) == 2);
    /* In the order of their names. */
    OK(leafless_octree_channel_at(octree, 0, &channel));
    CHECK(is_named(channel, "name", "heat"));
    leafless_channel_free(channel);
    OK(leafless_octree_channel(octree, "none", 4, &channel));
    CHECK(channel == NULL);
    /* Equality concerns the cells. */
    OK(leafless_octree_without_channel(octree, "heat", 4, &bare));
    CHECK(check_channels(bare) == 1 && check_same(bare, octree));
    leafless_octree_free(bare);
    OK(leafless_octree_without_channel(octree, NULL, 0, &bare));
    CHECK(check_channels(bare) == 0);
    octree = bearing(octree, 30.5, "heat");
    CHECK(check_channels(octree) == 2 && first_at(octree, "heat", 0, 0, 0) == 30.5);
    octree = bearing(octree, 20.5, "heat");

    /* What has the same cells, or the same solid, keeps the channels. */
    OK(leafless_octree_with_metadata(octree, "units", 5, "mm", 2, &result));
    keeps(result);
    OK(leafless_octree_without_metadata(octree, NULL, 0, &result));
    keeps(result);
    OK(leafless_octree_with_proof(octree, LEAFLESS_PROVEN_BOTH, 0.5, &result));
    keeps(result);
    OK(leafless_octree_compact(octree, &result));
    keeps(result);
    OK(leafless_octree_resolve(octree, LEAFLESS_RULE_OUTER, NULL, &result));
    keeps(result);
    /* What makes another solid has none. */
    OK(leafless_octree_complement(octree, NULL, &result));
    CHECK(check_channels(result) == 0);
    leafless_octree_free(result);
    OK(check_octrees(LEAFLESS_OPERATION_UNION, octree, octree, NULL, &result));
    CHECK(check_channels(result) == 0);
    leafless_octree_free(result);
    result = NULL;

    OK(leafless_octree_new_uniform(&elsewhere, LEAFLESS_TAG_FULL, LEAFLESS_TAG_EMPTY, &other));
    channel = uniform(other, 1, LEAFLESS_SCALAR_TYPE_U8, "far");
    FAILS(LEAFLESS_E_FRAME, leafless_octree_with_channel(octree, channel, &result));
    leafless_octree_free(other);
    leafless_channel_free(channel);
    /* No more than 256. */
    for (i = 0; i < 256; i++) {
        char name[16];
        sprintf(name, "%d", i);
        bare = bearing(bare, i, name);
    }
    channel = uniform(bare, 1, LEAFLESS_SCALAR_TYPE_U8, "");
    FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_with_channel(bare, channel, &result));
    CHECK(result == NULL && first_at(bare, "200", 0, 0, 0) == 200);
    leafless_channel_free(channel);
    leafless_octree_free(bare);
    leafless_octree_free(octree);
}

/* Files and bytes keep channels, however they are read. */
static void files(void) {
    static const char PATH[] = "channels.lfl";
    leafless_octree *octree = two_channels(), *back = NULL;
    leafless_channel *before = NULL, *after = NULL;
    uint64_t length = 0, again = 0;
    uint8_t *bytes, *other;
    OK(octree_save(octree, PATH, strlen(PATH)));
    OK(octree_open(PATH, strlen(PATH), &back));
    OK(leafless_octree_channel(octree, "heat", 4, &before));
    OK(leafless_octree_channel(back, "heat", 4, &after));
    CHECK(same(before, after) && is_named(after, "name", "heat"));
    leafless_channel_free(before);
    leafless_channel_free(after);
    keeps(back);
    OK(octree_map(PATH, strlen(PATH), &back));
    /* The channel keeps the mapping. */
    OK(leafless_octree_channel_at(back, 1, &after));
    keeps(back);
    OK(leafless_channel_check(after));
    CHECK(is_named(after, "name", "material"));
    leafless_channel_free(after);
    OK(octree_map_verified(PATH, strlen(PATH), &back));
    keeps(back);
    bytes = check_bytes(octree, &length);
    OK(octree_from_bytes(bytes, length, &back));
    other = check_bytes(back, &again);
    CHECK(length == again && memcmp(bytes, other, (size_t)length) == 0);
    free(other);
    keeps(back);
    free(bytes);
    leafless_octree_free(octree);
    remove(PATH);
}

static void carried(void) {
    /* Boxes from -0.5 to 0.25 and from -0.25 to 0.5. */
    leafless_octree *a = check_box(4, -0.5, 0.25), *b = check_box(4, -0.25, 0.5);
    leafless_octree *both = NULL, *result = NULL, *odd = NULL;
    const leafless_octree *operands[2];
    const leafless_carry_rule rules[2] = {{"heat", 4, LEAFLESS_CARRY_MEAN}, {"heat", 4, LEAFLESS_CARRY_MAX}};
    const struct {
        uint32_t carry;
        double expected;
    } all[4] = {{LEAFLESS_CARRY_LEFT, 10}, {LEAFLESS_CARRY_RIGHT, 30}, {LEAFLESS_CARRY_MAX, 30},
                {LEAFLESS_CARRY_MEAN, 20}};
    leafless_channel *one = NULL;
    leafless_options options;
    int i;
    a = bearing(bearing(bearing(a, 10, "heat"), 30, "wear"), 1, "only a");
    b = bearing(bearing(bearing(b, 30, "heat"), 10, "wear"), 2, "only b");
    operands[0] = a;
    operands[1] = b;
    OK(check_octrees(LEAFLESS_OPERATION_UNION, a, b, NULL, &both));
    both = bearing(both, 7, "own");
    for (i = 0; i < 4; i++) {
        OK(leafless_octree_carry_channels(both, operands, 2, all[i].carry, NULL, 0, NULL, &result));
        CHECK(check_channels(result) == 5 && check_same(result, both));
        CHECK(first_at(result, "heat", -0.4, -0.4, -0.4) == 10 && first_at(result, "heat", 0.4, 0.4, 0.4) == 30);
        CHECK(first_at(result, "heat", 0.1, 0.1, 0.1) == all[i].expected);
        CHECK(first_at(result, "only a", 0.1, 0.1, 0.1) == 1 && first_at(result, "only b", 0.1, 0.1, 0.1) == 2);
        CHECK(first_at(result, "own", 0.1, 0.1, 0.1) == 7);
        leafless_octree_free(result);
    }
    /* By name: the first rule that names a channel counts. */
    OK(leafless_init(&options, sizeof options));
    options.threads = 2;
    OK(leafless_octree_carry_channels(both, operands, 2, LEAFLESS_CARRY_RIGHT, rules, 2, &options, &result));
    CHECK(first_at(result, "heat", 0.1, 0.1, 0.1) == 20 && first_at(result, "wear", 0.1, 0.1, 0.1) == 10);
    leafless_octree_free(result);
    result = NULL;
    /* Two types under one name. */
    one = uniform(b, 3, LEAFLESS_SCALAR_TYPE_U8, "heat");
    OK(leafless_octree_with_channel(b, one, &odd));
    operands[1] = odd;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_carry_channels(both, operands, 2, 0, NULL, 0, NULL, &result));
    CHECK(result == NULL);
    leafless_channel_free(one);
    leafless_octree_free(odd);
    leafless_octree_free(both);
    leafless_octree_free(a);
    leafless_octree_free(b);
}

int main(void) {
    attributes();
    filled();
    details();
    metadata();
    regions();
    octrees();
    files();
    carried();
    return 0;
}
