/* Octrees in shards, as several machines make them: joined, counted, measured and queried part by part, they equal the whole,
 * byte for byte. */
#include "check.h"

enum { DEPTH = 6, LEVELS = DEPTH + 1, MOST = 512, POINTS = 2000 };

/* How octrees are made of the solid. */
typedef struct way {
    bool keeps_surfaces;
    leafless_rule rule;
} way;

/* A top, and the shards of the cells that it leaves open. */
typedef struct parts {
    uint32_t level;
    leafless_octree *top;
    uint64_t count;
    uint64_t codes[MOST];
    leafless_octree *shards[MOST];
} parts;

static leafless_solid *solid;
static leafless_frame frame;

/* A block with a bore of a ball's form, and a ball beside it. */
static leafless_solid *part(void) {
    static const double low[3] = {-0.8, -0.7, -0.6}, high[3] = {0.8, 0.4, 0.7};
    static const double bore[3] = {0.2, 0, 0}, beside[3] = {-0.6, 0.6, -0.4};
    leafless_solid *block = NULL, *ball = NULL, *bored = NULL, *both = NULL;
    OK(leafless_solid_new_box(low, high, &block));
    OK(leafless_solid_new_ball(bore, 0.52, &ball));
    OK(check_solids(LEAFLESS_OPERATION_DIFFERENCE, block, ball, &bored));
    leafless_solid_free(ball);
    OK(leafless_solid_new_ball(beside, 0.22, &ball));
    OK(check_solids(LEAFLESS_OPERATION_UNION, bored, ball, &both));
    leafless_solid_free(bored);
    leafless_solid_free(ball);
    leafless_solid_free(block);
    return both;
}

static leafless_shard top_of(uint32_t level) {
    leafless_shard shard = {0, 0, LEAFLESS_SHARD_KIND_TOP};
    shard.level = level;
    return shard;
}

static leafless_shard below(uint32_t level, uint64_t code) {
    leafless_shard shard = {0, 0, LEAFLESS_SHARD_KIND_BELOW};
    shard.level = level;
    shard.code = code;
    return shard;
}

static leafless_octree *whole_of(way how) {
    leafless_octree *octree = NULL;
    if (how.keeps_surfaces) {
        OK(leafless_octree_build_extended(solid, &frame, NULL, NULL, &octree));
    } else {
        OK(leafless_octree_build(solid, &frame, how.rule, NULL, &octree));
    }
    return octree;
}

/* Built of the solid, or cut off `whole` if that is not NULL. */
static leafless_octree *shard_of(way how, const leafless_octree *whole, leafless_shard shard) {
    leafless_octree *octree = NULL;
    if (whole != NULL) {
        OK(leafless_octree_shard(whole, &shard, NULL, &octree));
    } else if (how.keeps_surfaces) {
        OK(leafless_octree_build_extended_shard(solid, &frame, NULL, &shard, NULL, &octree));
    } else {
        OK(leafless_octree_build_shard(solid, &frame, how.rule, &shard, NULL, &octree));
    }
    OK(leafless_octree_check(octree));
    return octree;
}

static void make(way how, const leafless_octree *whole, uint32_t level, parts *made) {
    uint64_t i, again = 0;
    made->level = level;
    made->top = shard_of(how, whole, top_of(level));
    OK(leafless_octree_open_cells(made->top, level, NULL, 0, &made->count));
    CHECK(made->count <= MOST);
    OK(leafless_octree_open_cells(made->top, level, made->codes, MOST, &again));
    CHECK(again == made->count);
    for (i = 0; i < made->count; i++) {
        CHECK(i == 0 || made->codes[i - 1] < made->codes[i]);
        made->shards[i] = shard_of(how, whole, below(level, made->codes[i]));
    }
}

static void release(parts *made) {
    uint64_t i;
    for (i = 0; i < made->count; i++) leafless_octree_free(made->shards[i]);
    leafless_octree_free(made->top);
}

/* All that the parts know together, but for the shard `missing`. */
static leafless_octree *joined(const parts *made, uint64_t missing) {
    const leafless_octree *all[1 + MOST];
    leafless_octree *result = NULL;
    uint64_t i, count = 0;
    /* In an order that is none. */
    for (i = made->count; i-- > 0;) {
        if (i != missing) all[count++] = made->shards[i];
        if (i == made->count / 2) all[count++] = made->top;
    }
    if (made->count == 0) all[count++] = made->top;
    OK(leafless_octree_join(all, count, NULL, &result));
    OK(leafless_octree_check(result));
    return result;
}

static bool same_bytes(const leafless_octree *a, const leafless_octree *b) {
    uint64_t lengths[2];
    uint8_t *bytes[2];
    bool same;
    bytes[0] = check_bytes(a, &lengths[0]);
    bytes[1] = check_bytes(b, &lengths[1]);
    same = lengths[0] == lengths[1] && memcmp(bytes[0], bytes[1], (size_t)lengths[0]) == 0;
    free(bytes[0]);
    free(bytes[1]);
    return same;
}

/* Moves the data of shards that do not split their cell into the top. */
static void settle(parts *made) {
    const leafless_octree *few[1 + MOST];
    leafless_octree *top = NULL;
    leafless_statistics levels[LEVELS];
    uint64_t i, count = 0, known = 0, number;
    few[known++] = made->top;
    for (i = 0; i < made->count; i++) {
        OK(leafless_octree_levels(made->shards[i], levels, LEVELS, &number));
        if (levels[made->level].nodes == 0) few[known++] = made->shards[i];
    }
    OK(leafless_octree_join(few, known, NULL, &top));
    for (i = 0; i < made->count; i++) {
        OK(leafless_octree_levels(made->shards[i], levels, LEVELS, &number));
        if (levels[made->level].nodes == 0) {
            leafless_octree_free(made->shards[i]);
        } else {
            made->codes[count] = made->codes[i];
            made->shards[count++] = made->shards[i];
        }
    }
    made->count = count;
    leafless_octree_free(made->top);
    made->top = top;
}

/* The counts of the whole, from the counts that each machine reports for its shard. */
static void statistics(const parts *made, const leafless_octree *whole) {
    static leafless_statistics told[LEVELS * MOST];
    leafless_statistics expected[LEVELS], found[LEVELS];
    uint64_t i, count = 0;
    for (i = 0; i < made->count; i++) {
        OK(leafless_octree_levels(made->shards[i], told + LEVELS * i, LEVELS, &count));
    }
    OK(leafless_octree_levels(whole, expected, LEVELS, &count));
    OK(leafless_octree_statistics_with(made->top, made->level, made->codes, made->count, told, LEVELS * made->count, found,
                                       LEVELS, &count));
    CHECK(count == LEVELS && memcmp(found, expected, sizeof found) == 0);
    if (made->count < 2) return;
    /* Without the last one its cell is in doubt. */
    OK(leafless_octree_statistics_with(made->top, made->level, made->codes, made->count - 1, told,
                                       LEVELS * (made->count - 1), found, LEVELS, &count));
    CHECK(found[DEPTH].upper_cells - found[DEPTH].lower_cells > expected[DEPTH].upper_cells - expected[DEPTH].lower_cells);
    CHECK(found[DEPTH].lower_cells <= expected[DEPTH].lower_cells && found[DEPTH].upper_cells >= expected[DEPTH].upper_cells);
    /* A cell that the octree decides has no more counts, and codes must ascend. */
    FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_statistics_with(whole, made->level, made->codes, 1, told, LEVELS, found, LEVELS,
                                                               &count));
    {
        uint64_t codes[2];
        codes[0] = made->codes[1], codes[1] = made->codes[0];
        FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_statistics_with(made->top, made->level, codes, 2, told, 2 * LEVELS, found,
                                                                   LEVELS, &count));
        codes[0] = codes[1];
        FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_statistics_with(made->top, made->level, codes, 2, told, 2 * LEVELS, found,
                                                                   LEVELS, &count));
    }
    /* Counts that cannot be are no harm. */
    memset(told, 0xff, sizeof(leafless_statistics) * LEVELS);
    told[made->level].nodes = 1;
    OK(leafless_octree_statistics_with(made->top, made->level, made->codes, 1, told, LEVELS, found, LEVELS, &count));
    told[made->level].nodes = 2;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_statistics_with(made->top, made->level, made->codes, 1, told, LEVELS, found,
                                                               LEVELS, &count));
}

static bool same_intervals(const leafless_interval *a, const leafless_interval *b, int count) {
    int i;
    for (i = 0; i < count; i++) {
        if (a[i].lower != b[i].lower || a[i].upper != b[i].upper) return false;
    }
    return true;
}

static bool same_measures(const leafless_measures *a, const leafless_measures *b) {
    return same_intervals(&a->volume_model, &b->volume_model, 1) && same_intervals(a->centroid_model, b->centroid_model, 3) &&
           same_intervals(a->inertia_origin_model, b->inertia_origin_model, 9) &&
           same_intervals(a->inertia_centroid_model, b->inertia_centroid_model, 9) && a->has_centroid == b->has_centroid &&
           a->is_clipped == b->is_clipped && a->proof.full == b->proof.full && a->proof.empty == b->proof.empty;
}

/* The sum of an octree in a cell. */
static leafless_mass_sum measured(const leafless_octree *octree, uint32_t level, uint64_t code) {
    leafless_mass_sum sum = LEAFLESS_INIT(leafless_mass_sum);
    leafless_solid *stored = NULL;
    OK(leafless_solid_from_octree(octree, &stored));
    OK(leafless_solid_measure_cell(stored, &frame, level, code, 0, 0, NULL, &sum));
    leafless_solid_free(stored);
    return sum;
}

/* The measures of the whole, from the sums that each machine sends. */
static void masses(const parts *made, const leafless_octree *whole) {
    leafless_mass_sum sum = measured(made->top, 0, 0), unknown = LEAFLESS_INIT(leafless_mass_sum);
    leafless_measures expected = LEAFLESS_INIT(leafless_measures), found = LEAFLESS_INIT(leafless_measures);
    leafless_solid *stored = NULL;
    unsigned char sent[sizeof sum];
    uint64_t i;
    for (i = 0; i < made->count; i++) {
        leafless_mass_sum own = measured(made->shards[i], made->level, made->codes[i]);
        memcpy(sent, &own, sizeof sent);
        memset(&own, 0, sizeof own);
        memcpy(&own, sent, sizeof sent);
        OK(leafless_mass_sum_unknown(&frame, made->level, made->codes[i], &unknown));
        OK(leafless_mass_sum_subtract(&sum, &unknown, &sum));
        OK(leafless_mass_sum_add(&own, &sum, &sum));
    }
    OK(leafless_solid_from_octree(whole, &stored));
    OK(leafless_solid_measure(stored, &frame, 0, 0, NULL, &expected));
    leafless_solid_free(stored);
    OK(leafless_mass_sum_measures(&sum, &found));
    CHECK(same_measures(&found, &expected) && !found.is_exact && found.volume_model.upper > 1);
    if (made->count == 0) return;
    /* Subtracting a part and adding it again restores the sum. */
    {
        const leafless_mass_sum own = measured(made->shards[0], made->level, made->codes[0]);
        leafless_mass_sum less = LEAFLESS_INIT(leafless_mass_sum);
        OK(leafless_mass_sum_subtract(&sum, &own, &less));
        OK(leafless_mass_sum_add(&less, &own, &less));
        OK(leafless_mass_sum_measures(&less, &found));
        CHECK(same_measures(&found, &expected));
    }
}

/* As a solid the parts answer as the whole does. */
static void questions(const parts *made, const leafless_octree *whole) {
    static double points[POINTS][3];
    static leafless_membership expected[POINTS], found[POINTS];
    const leafless_octree *shards[MOST];
    leafless_octree *rebuilt = NULL, *again = NULL;
    leafless_solid *sharded = NULL, *stored = NULL;
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
    uint64_t codes[MOST], i;
    uint32_t state = 7;
    int k, axis, decided = 0;
    OK(leafless_octree_describe(whole, &info));
    for (i = 0; i < made->count; i++) {
        codes[i] = made->codes[made->count - 1 - i];
        shards[i] = made->shards[made->count - 1 - i];
    }
    for (k = 0; k < POINTS; k++) {
        for (axis = 0; axis < 3; axis++) {
            state = state * 1664525u + 1013904223u;
            points[k][axis] = (state / 4294967296.0 - 0.5) * 2.1;
        }
    }
    OK(leafless_solid_from_shards(made->top, made->level, codes, shards, made->count, &sharded));
    OK(leafless_solid_from_octree(whole, &stored));
    OK(leafless_solid_contains_many(sharded, &frame, &points[0][0], POINTS, NULL, found));
    OK(leafless_solid_contains_many(stored, &frame, &points[0][0], POINTS, NULL, expected));
    for (k = 0; k < POINTS; k++) {
        CHECK(found[k] == expected[k]);
        decided += found[k] != LEAFLESS_MEMBERSHIP_UNDECIDED;
    }
    CHECK(decided > POINTS / 2 || !info.proof.full || !info.proof.empty);
    OK(leafless_octree_build(sharded, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &rebuilt));
    OK(leafless_octree_build(stored, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &again));
    CHECK(same_bytes(rebuilt, again));
    leafless_octree_free(rebuilt);
    leafless_octree_free(again);
    leafless_solid_free(sharded);
    if (made->count > 0) {
        /* Without the first one no other answer comes than before, and some do not come. */
        int fewer = 0;
        const uint64_t last = made->count - 1;
        OK(leafless_solid_from_shards(made->top, made->level, codes, shards, last, &sharded));
        OK(leafless_solid_contains_many(sharded, &frame, &points[0][0], POINTS, NULL, found));
        for (k = 0; k < POINTS; k++) {
            CHECK(found[k] == expected[k] || found[k] == LEAFLESS_MEMBERSHIP_UNDECIDED);
            fewer += found[k] == LEAFLESS_MEMBERSHIP_UNDECIDED;
        }
        CHECK(made->level > 2 || decided == 0 || fewer > POINTS - decided);
        leafless_solid_free(sharded);
    }
    leafless_solid_free(stored);
}

/* A shard that is missing is a PARTIAL cell, and nothing else changes. */
static void missing(const parts *made, const leafless_octree *whole) {
    leafless_octree *less = joined(made, 0);
    uint64_t codes[MOST], count = 0, i;
    uint32_t cell[3];
    leafless_tag known, expected;
    bool is_open = false;
    CHECK(!check_same(less, whole));
    OK(leafless_octree_open_cells(less, made->level, codes, MOST, &count));
    for (i = 0; i < count; i++) is_open = is_open || codes[i] == made->codes[0];
    CHECK(is_open);
    for (cell[0] = 0; cell[0] < 1u << DEPTH; cell[0] += 3) {
        for (cell[1] = 0; cell[1] < 1u << DEPTH; cell[1] += 3) {
            for (cell[2] = 0; cell[2] < 1u << DEPTH; cell[2] += 3) {
                uint64_t code = 0;
                uint32_t bit, axis;
                for (bit = 0; bit < made->level; bit++) {
                    for (axis = 0; axis < 3; axis++) {
                        code |= (uint64_t)(cell[axis] >> (DEPTH - made->level + bit) & 1) << (3 * bit + axis);
                    }
                }
                OK(leafless_octree_tag_at(less, cell, &known));
                OK(leafless_octree_tag_at(whole, cell, &expected));
                CHECK(known == (code == made->codes[0] ? LEAFLESS_TAG_PARTIAL : expected));
            }
        }
    }
    leafless_octree_free(less);
}

static void check(way how, uint32_t level) {
    static parts built, cut;
    leafless_octree *whole = whole_of(how), *all;
    uint64_t i;
    make(how, NULL, level, &built);
    all = joined(&built, MOST);
    CHECK(same_bytes(all, whole));
    leafless_octree_free(all);

    make(how, whole, level, &cut);
    all = joined(&cut, MOST);
    CHECK(same_bytes(all, whole));
    leafless_octree_free(all);
    CHECK(cut.count <= built.count);
    for (i = 0; i < cut.count && cut.count == built.count; i++) {
        /* The same as is built, where the cell is split at all. */
        leafless_statistics levels[LEVELS];
        uint64_t count;
        CHECK(cut.codes[i] == built.codes[i]);
        OK(leafless_octree_levels(cut.shards[i], levels, LEVELS, &count));
        CHECK(levels[level].nodes == 0 || same_bytes(cut.shards[i], built.shards[i]));
    }
    release(&cut);

    if (!how.keeps_surfaces && level > 0 && built.count > 0) missing(&built, whole);
    if (level < DEPTH) {
        settle(&built);
        statistics(&built, whole);
        if (!how.keeps_surfaces) masses(&built, whole);
    }
    questions(&built, whole);
    release(&built);
    leafless_octree_free(whole);
}

/* Shards on disk. Only the solid is left in memory. */
static void mapped(void) {
    const way how = {false, LEAFLESS_RULE_CERTIFIED};
    static parts made;
    leafless_octree *whole = whole_of(how), *own = NULL;
    leafless_solid *sharded = NULL, *stored = NULL;
    leafless_measures expected = LEAFLESS_INIT(leafless_measures), found = LEAFLESS_INIT(leafless_measures);
    leafless_options options = LEAFLESS_INIT(leafless_options);
    uint64_t i;
    make(how, NULL, 1, &made);
    for (i = 0; i < made.count; i++) {
        char path[32];
        leafless_sink to;
        leafless_source in;
        snprintf(path, sizeof path, "shard%d.lfl", (int)i);
        to = leafless_to_file(path);
        in = leafless_from_file(path, LEAFLESS_ACCESS_MAP);
        OK(leafless_octree_write(made.shards[i], &to));
        OK(leafless_octree_read(&in, &own));
        leafless_octree_free(made.shards[i]);
        made.shards[i] = own;
    }
    OK(leafless_solid_from_shards(made.top, 1, made.codes, (const leafless_octree *const *)made.shards, made.count, &sharded));
    release(&made);
    OK(leafless_solid_from_octree(whole, &stored));
    leafless_octree_free(whole);
    options.threads = 2;
    OK(leafless_solid_measure(stored, &frame, 1e-3, 0, &options, &expected));
    OK(leafless_solid_measure(sharded, &frame, 1e-3, 0, &options, &found));
    CHECK(same_measures(&found, &expected));
    leafless_solid_free(stored);
    leafless_solid_free(sharded);
}

/* Solids are measured cell by cell without any octree. */
static void solids(void) {
    const double truth = 4.0 / 3.0 * 3.14159265358979323846 * 0.75 * 0.75 * 0.75;
    leafless_solid *ball = check_ball_solid();
    leafless_mass_sum sum = LEAFLESS_INIT(leafless_mass_sum), own = LEAFLESS_INIT(leafless_mass_sum);
    leafless_measures measures = LEAFLESS_INIT(leafless_measures);
    const leafless_frame fine = check_frame(20);
    uint64_t code;
    for (code = 0; code < 8; code++) {
        OK(leafless_solid_measure_cell(ball, &fine, 1, code, 1e-4, 0, NULL, code == 0 ? &sum : &own));
        if (code > 0) OK(leafless_mass_sum_add(&sum, &own, &sum));
    }
    OK(leafless_mass_sum_measures(&sum, &measures));
    CHECK(measures.volume_model.lower <= truth && truth <= measures.volume_model.upper);
    CHECK(measures.volume_model.upper - measures.volume_model.lower < 1.01e-4 * truth && measures.has_centroid);
    leafless_solid_free(ball);
}

/* A sum with any bytes is refused or evaluated. */
static void damaged(void) {
    leafless_octree *octree = check_ball(4, LEAFLESS_RULE_CERTIFIED);
    const leafless_frame other = check_frame(5);
    leafless_mass_sum good = LEAFLESS_INIT(leafless_mass_sum), bad, out = LEAFLESS_INIT(leafless_mass_sum), before;
    leafless_measures measures = LEAFLESS_INIT(leafless_measures);
    leafless_solid *stored = NULL;
    leafless_frame coarse = check_frame(4);
    uint32_t state = 1;
    size_t at;
    int k, refused = 0;
    OK(leafless_solid_from_octree(octree, &stored));
    OK(leafless_solid_measure_cell(stored, &coarse, 0, 0, 0, 0, NULL, &good));
    OK(leafless_mass_sum_measures(&good, &measures));
    for (k = 0; k < 256; k++) {
        bad = good;
        memset(bad.bytes, k, sizeof bad.bytes);
        FAILS(LEAFLESS_E_ARGUMENT, leafless_mass_sum_measures(&bad, &measures));
        FAILS(LEAFLESS_E_ARGUMENT, leafless_mass_sum_add(&good, &bad, &out));
        bad = good;
        bad.bytes[0] = (uint8_t)k;
        if (bad.bytes[0] != good.bytes[0]) FAILS(LEAFLESS_E_ARGUMENT, leafless_mass_sum_measures(&bad, &measures));
    }
    for (k = 0; k < 40000; k++) {
        leafless_status status;
        int changes = k < 8 * (int)sizeof bad.bytes ? 0 : 1 + k % 7;
        bad = good;
        if (changes == 0) bad.bytes[k / 8] ^= (uint8_t)(1 << k % 8);
        while (changes-- > 0) {
            state = state * 1664525u + 1013904223u;
            at = (state >> 8) % sizeof bad.bytes;
            state = state * 1664525u + 1013904223u;
            bad.bytes[at] = (uint8_t)(state >> 24 & (state >> 16 & 1 ? 0xff : 0));
        }
        status = leafless_mass_sum_measures(&bad, &measures);
        CHECK(status == LEAFLESS_OK || status == LEAFLESS_E_ARGUMENT);
        refused += status != LEAFLESS_OK;
        status = leafless_mass_sum_add(&bad, &good, &out);
        CHECK(status == LEAFLESS_OK || status == LEAFLESS_E_ARGUMENT || status == LEAFLESS_E_FRAME);
        status = leafless_mass_sum_subtract(&bad, &good, &out);
        CHECK(status == LEAFLESS_OK || status == LEAFLESS_E_ARGUMENT || status == LEAFLESS_E_FRAME);
        status = leafless_mass_sum_subtract(&out, &bad, &out);
        CHECK(status == LEAFLESS_OK || status == LEAFLESS_E_ARGUMENT || status == LEAFLESS_E_FRAME);
    }
    CHECK(refused > 1000);

    /* Incompatible sums. The output stays unchanged. */
    out = good;
    before = out;
    OK(leafless_mass_sum_unknown(&other, 0, 0, &bad));
    FAILS(LEAFLESS_E_FRAME, leafless_mass_sum_add(&good, &bad, &out));
    FAILS(LEAFLESS_E_FRAME, leafless_mass_sum_subtract(&good, &bad, &out));
    OK(leafless_mass_sum_unknown(&coarse, 0, 0, &bad));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_mass_sum_add(&bad, &bad, &out));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_mass_sum_subtract(&good, &bad, &out));
    memset(&bad, 0, sizeof bad);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_mass_sum_add(&bad, &good, &out));
    bad = LEAFLESS_INIT(leafless_mass_sum);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_mass_sum_add(&bad, &good, &out));
    CHECK(memcmp(&out, &before, sizeof out) == 0);
    leafless_solid_free(stored);
    leafless_octree_free(octree);
}

/* Octrees that are not of one solid, or not on one frame; limits; cancelling. */
static void refusals(void) {
    const leafless_shard top = {0, 1, LEAFLESS_SHARD_KIND_TOP}, octant = below(1, 6);
    const uint64_t codes[2] = {0, 3};
    leafless_octree *globe = check_ball(DEPTH, LEAFLESS_RULE_CERTIFIED), *other = check_box(DEPTH, 0.5, 0.9);
    leafless_octree *shallow = check_ball(DEPTH - 1, LEAFLESS_RULE_CERTIFIED), *full = NULL, *result = NULL;
    leafless_options options = LEAFLESS_INIT(leafless_options);
    leafless_control *control = NULL;
    leafless_solid *ball = check_ball_solid(), *none = NULL;
    const leafless_octree *pair[2];
    uint64_t count = 77;
    OK(leafless_octree_new_uniform(&frame, LEAFLESS_TAG_FULL, LEAFLESS_TAG_EMPTY, &full));
    pair[0] = globe, pair[1] = other;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_join(pair, 2, NULL, &result));
    pair[1] = full;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_join(pair, 2, NULL, &result));
    pair[1] = shallow;
    FAILS(LEAFLESS_E_FRAME, leafless_octree_join(pair, 2, NULL, &result));
    FAILS(LEAFLESS_E_FRAME, leafless_solid_from_shards(globe, 1, codes, pair, 2, &none));
    FAILS(LEAFLESS_E_FRAME, leafless_solid_from_shards(shallow, 1, codes, pair, 1, &none));
    pair[1] = globe;
    OK(leafless_octree_join(pair, 2, NULL, &result));
    CHECK(same_bytes(result, globe));
    leafless_octree_free(result);
    result = NULL;

    options.max_nodes = 2;
    FAILS(LEAFLESS_E_LIMIT, leafless_octree_join(pair, 2, &options, &result));
    FAILS(LEAFLESS_E_LIMIT, leafless_octree_build_shard(ball, &frame, LEAFLESS_RULE_CERTIFIED, &octant, &options, &result));
    options.max_nodes = 0;
    OK(leafless_control_new(&control));
    OK(leafless_control_cancel(control));
    options.control = control;
    FAILS(LEAFLESS_E_CANCELLED, leafless_octree_join(pair, 2, &options, &result));
    FAILS(LEAFLESS_E_CANCELLED, leafless_octree_shard(globe, &top, &options, &result));
    FAILS(LEAFLESS_E_CANCELLED, leafless_octree_build_shard(ball, &frame, 0, &top, &options, &result));
    FAILS(LEAFLESS_E_CANCELLED, leafless_octree_build_extended_shard(ball, &frame, NULL, &top, &options, &result));
    leafless_control_free(control);
    CHECK(result == NULL && none == NULL);

    /* More open cells than a list has. */
    leafless_octree_free(full);
    {
        const leafless_frame fine = check_frame(20);
        OK(leafless_octree_new_uniform(&fine, LEAFLESS_TAG_PARTIAL, LEAFLESS_TAG_PARTIAL, &full));
        FAILS(LEAFLESS_E_LIMIT, leafless_octree_open_cells(full, 20, NULL, 0, &count));
        CHECK(count == 77);
        OK(leafless_octree_open_cells(full, 2, NULL, 0, &count));
        CHECK(count == 64);
    }
    leafless_octree_free(full);
    leafless_octree_free(shallow);
    leafless_octree_free(other);
    leafless_octree_free(globe);
    leafless_solid_free(ball);
}

int main(void) {
    uint32_t level;
    leafless_rule rule;
    way how = {false, 0};
    frame = check_frame(DEPTH);
    solid = part();
    for (level = 0; level <= 3; level++) {
        for (rule = LEAFLESS_RULE_CERTIFIED; rule <= LEAFLESS_RULE_OUTER; rule++) {
            how.keeps_surfaces = false;
            how.rule = rule;
            check(how, level);
        }
        how.keeps_surfaces = true;
        check(how, level);
    }
    mapped();
    solids();
    damaged();
    refusals();
    leafless_solid_free(solid);
    return 0;
}
