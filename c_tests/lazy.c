/* Octrees that are split on demand: cell by cell, in zones, within limits; frozen, saved and taken up again. */
#include "check.h"

#define DEPTH 6

static leafless_frame frame;
static leafless_octree *built;

static leafless_octree *frozen(const leafless_lazy *lazy) {
    leafless_octree *octree = NULL;
    OK(leafless_lazy_freeze(lazy, NULL, &octree));
    OK(leafless_octree_check(octree));
    return octree;
}

static bool is_built(const leafless_lazy *lazy) {
    leafless_octree *octree = frozen(lazy);
    const bool same = check_same(octree, built);
    leafless_octree_free(octree);
    return same;
}

static uint64_t evaluations_of(const leafless_solid *solid) {
    leafless_solid_info info = LEAFLESS_INIT(leafless_solid_info);
    OK(leafless_solid_describe(solid, &info));
    return info.evaluations;
}

static leafless_lazy_info counts_of(const leafless_lazy *lazy) {
    leafless_lazy_info counts = LEAFLESS_INIT(leafless_lazy_info);
    OK(leafless_lazy_describe(lazy, &counts));
    return counts;
}

static leafless_membership at(const leafless_lazy *lazy, double x, double y, double z) {
    const double point[3] = {x, y, z};
    leafless_membership membership;
    OK(leafless_lazy_contains(lazy, point, &membership));
    return membership;
}

/* The host descends by itself, to all cells that are not decided. */
static void cell_by_cell(const leafless_solid *solid) {
    leafless_lazy *lazy = NULL;
    uint32_t (*queue)[4] = (uint32_t (*)[4])malloc(sizeof *queue << 18);
    uint64_t first = 0, end = 1, splits[DEPTH], count = 0, sum = 0, i;
    leafless_lazy_info info = LEAFLESS_INIT(leafless_lazy_info);
    leafless_statistics levels[DEPTH + 1], all, of_octree[DEPTH + 1];
    CHECK(queue != NULL);
    memset(queue[0], 0, sizeof queue[0]);
    OK(leafless_lazy_new(solid, &frame, &lazy));
    while (first < end) {
        const uint32_t *cell = queue[first++];
        leafless_tag tags[8], tag, again[8];
        bool can_split = false;
        uint32_t k;
        OK(leafless_lazy_tag_at(lazy, cell, cell[3], &tag, &can_split));
        CHECK(tag == LEAFLESS_TAG_PARTIAL && can_split);
        OK(leafless_lazy_split(lazy, cell, cell[3], tags));
        OK(leafless_lazy_split(lazy, cell, cell[3], again));
        CHECK(memcmp(tags, again, sizeof tags) == 0);
        OK(leafless_lazy_tag_at(lazy, cell, cell[3], &tag, &can_split));
        CHECK(!can_split);
        for (k = 0; k < 8; k++) {
            if (tags[k] == LEAFLESS_TAG_PARTIAL && cell[3] + 1 < DEPTH) {
                CHECK(end < (uint64_t)1 << 18);
                queue[end][0] = 2 * cell[0] + (k & 1);
                queue[end][1] = 2 * cell[1] + (k >> 1 & 1);
                queue[end][2] = 2 * cell[2] + (k >> 2 & 1);
                queue[end++][3] = cell[3] + 1;
            }
        }
    }
    CHECK(is_built(lazy));
    CHECK(counts_of(lazy).splits == end && counts_of(lazy).bytes > 0);
    OK(leafless_lazy_splits(lazy, NULL, 0, &count));
    CHECK(count == DEPTH);
    FAILS(LEAFLESS_E_BUFFER, leafless_lazy_splits(lazy, splits, DEPTH - 1, &count));
    OK(leafless_lazy_splits(lazy, splits, DEPTH, &count));
    for (i = 0; i < DEPTH; i++) {
        sum += splits[i];
    }
    CHECK(sum == end && splits[0] == 1);
    OK(leafless_lazy_levels(lazy, NULL, 0, &count));
    CHECK(count == DEPTH + 1);
    FAILS(LEAFLESS_E_BUFFER, leafless_lazy_levels(lazy, levels, DEPTH, &count));
    OK(leafless_lazy_levels(lazy, levels, DEPTH + 1, &count));
    OK(leafless_octree_levels(built, of_octree, DEPTH + 1, &count));
    for (i = 0; i <= DEPTH; i++) {
        CHECK(levels[i].lower_cells == of_octree[i].lower_cells && levels[i].upper_cells == of_octree[i].upper_cells);
        CHECK(levels[i].volume_model.lower == of_octree[i].volume_model.lower);
        CHECK(levels[i].nodes >= of_octree[i].nodes);
    }
    OK(leafless_lazy_describe(lazy, &info));
    all = info.statistics;
    CHECK(info.frame.depth == DEPTH && info.frame.edge == frame.edge && info.frame.origin[2] == frame.origin[2]);
    CHECK(all.lower_cells == of_octree[DEPTH].lower_cells && all.upper_cells == of_octree[DEPTH].upper_cells);
    CHECK(all.nodes == sum);
    leafless_lazy_free(lazy);
    free(queue);
}

static void zones(const leafless_solid *solid) {
    const double min[3] = {-1, -1, -1}, middle[3] = {1, 1, 0}, edge[3] = {0.75, 0, 0};
    const double origin[3] = {-2, 0.1, 0.2}, along[3] = {1, 0, 0}, nowhere[3] = {0, 0, 0};
    const uint32_t universe[3] = {0, 0, 0}, outside[3] = {2, 0, 0}, finest[3] = {1, 2, 3};
    leafless_lazy *lazy = NULL;
    leafless_tag tags[8], tag = LEAFLESS_TAG_FULL;
    bool done = false, can_split = true;
    leafless_lazy_info before = LEAFLESS_INIT(leafless_lazy_info);
    leafless_lazy_info after = LEAFLESS_INIT(leafless_lazy_info);

    OK(leafless_lazy_new(solid, &frame, &lazy));
    CHECK(at(lazy, 0, 0, 0) == LEAFLESS_MEMBERSHIP_UNDECIDED);
    OK(check_refine(lazy, check_zone_point(edge), DEPTH, &done));
    CHECK(done && counts_of(lazy).splits <= DEPTH && counts_of(lazy).replays == 0);
    OK(check_refine(lazy, check_zone_ray(origin, along, 0, INFINITY), DEPTH, &done));
    CHECK(done && at(lazy, 0, 0.1, 0.2) == LEAFLESS_MEMBERSHIP_INSIDE);
    CHECK(at(lazy, -0.9, 0.1, 0.2) == LEAFLESS_MEMBERSHIP_OUTSIDE);
    OK(check_refine(lazy, check_zone_box(min, middle), DEPTH, NULL));
    OK(leafless_lazy_describe(lazy, &before));
    OK(check_refine(lazy, check_zone_box(min, middle), DEPTH, &done));
    OK(leafless_lazy_describe(lazy, &after));
    CHECK(done && memcmp(&before, &after, sizeof before) == 0);
    OK(leafless_lazy_refine(lazy, NULL, DEPTH, NULL, &done));
    CHECK(done && is_built(lazy));

    OK(leafless_lazy_tag_at(lazy, outside, 1, &tag, NULL));
    CHECK(tag == LEAFLESS_TAG_PARTIAL);
    OK(leafless_lazy_tag_at(lazy, universe, UINT32_MAX, &tag, &can_split));
    CHECK(tag == LEAFLESS_TAG_PARTIAL && !can_split);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_lazy_split(lazy, outside, 1, tags));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_lazy_split(lazy, finest, DEPTH, tags));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_lazy_split(lazy, universe, 256, tags));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_lazy_refine(lazy, NULL, DEPTH + 1, NULL, &done));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_lazy_refine(lazy, NULL, 256, NULL, &done));
    FAILS(LEAFLESS_E_ARGUMENT, check_refine(lazy, check_zone_box(middle, min), DEPTH, &done));
    FAILS(LEAFLESS_E_ARGUMENT, check_refine(lazy, check_zone_ray(origin, nowhere, 0, 1), DEPTH, &done));
    FAILS(LEAFLESS_E_ARGUMENT, check_refine(lazy, check_zone_ray(origin, along, 1, 0), DEPTH, &done));
    FAILS(LEAFLESS_E_ARGUMENT, check_refine(lazy, check_zone_ray(origin, along, NAN, 0), DEPTH, &done));
    leafless_lazy_free(lazy);
}

/* Half-spaces are counted once an octree that is split on demand is freed; only some solids need replays. */
static void evaluations(void) {
    const double centre[3] = {0, 0, 0}, here[3] = {0.74, 0.11, 0.05}, there[3] = {-0.74, 0.11, 0.05};
    leafless_solid *solid = NULL;
    leafless_lazy *lazy = NULL;
    uint64_t before, during, after, again;
    OK(leafless_solid_new_ball(centre, 0.75, &solid));
    before = evaluations_of(solid);
    CHECK(before == 0);
    OK(leafless_lazy_new(solid, &frame, &lazy));
    before = evaluations_of(solid);
    OK(check_refine(lazy, check_zone_point(here), DEPTH, NULL));
    OK(check_refine(lazy, check_zone_point(there), DEPTH, NULL));
    OK(check_refine(lazy, check_zone_point(here), DEPTH, NULL));
    CHECK(counts_of(lazy).splits >= 2 * DEPTH - 1);
    during = evaluations_of(solid);
    CHECK(during == before);
    leafless_lazy_free(lazy);
    after = evaluations_of(solid);
    CHECK(after > before);
    /* The solid is on this frame already: repeated queries count again, and nothing else does. */
    OK(leafless_lazy_new(solid, &frame, &lazy));
    OK(check_refine(lazy, check_zone_point(here), DEPTH, NULL));
    leafless_lazy_free(lazy);
    again = evaluations_of(solid);
    CHECK(again > after && again - after < after);
    leafless_solid_free(solid);
}

static int32_t stops(void *ctx, double fraction) {
    (void)fraction;
    return ++*(int *)ctx > 3;
}

static void limits(const leafless_solid *solid) {
    leafless_options options;
    leafless_control *control = NULL;
    leafless_octree *octree = NULL;
    leafless_lazy *lazy = NULL;
    bool done = true;
    uint64_t calls = 0;
    int reports = 0;

    OK(leafless_lazy_new(solid, &frame, &lazy));
    OK(leafless_init(&options, sizeof options));
    options.max_splits = 100;
    for (;;) {
        OK(leafless_lazy_refine(lazy, NULL, DEPTH, &options, &done));
        if (done) {
            break;
        }
        calls++;
        CHECK(counts_of(lazy).splits == 100 * calls);
    }
    CHECK(calls > 5 && is_built(lazy));
    leafless_lazy_free(lazy);

    OK(leafless_lazy_new(solid, &frame, &lazy));
    options.max_splits = 0;
    options.max_nodes = 50;
    OK(leafless_lazy_refine(lazy, NULL, DEPTH, &options, &done));
    CHECK(!done && counts_of(lazy).splits == 50);
    options.max_nodes = 0;
    options.max_bytes = 6400;
    OK(leafless_lazy_refine(lazy, NULL, DEPTH, &options, &done));
    CHECK(!done && counts_of(lazy).bytes <= 6400 && counts_of(lazy).splits > 50);
    options.max_bytes = 0;

    /* After a cancel, it keeps its cells, and can go on. */
    OK(leafless_control_new(&control));
    options.control = control;
    options.progress = stops;
    options.progress_ctx = &reports;
    FAILS(LEAFLESS_E_CANCELLED, leafless_lazy_refine(lazy, NULL, DEPTH, &options, &done));
    FAILS(LEAFLESS_E_CANCELLED, leafless_lazy_freeze(lazy, &options, &octree));
    CHECK(octree == NULL);
    OK(leafless_control_reset(control));
    options.progress = NULL;
    OK(leafless_lazy_refine(lazy, NULL, DEPTH, &options, &done));
    CHECK(done && is_built(lazy));
    leafless_lazy_free(lazy);
    leafless_control_free(control);
}

/* A slab -0.3 <= z <= 0.4 of the host. It counts its calls. */
static int32_t slab(void *ctx, const double *min, const double *max) {
    /* Several threads call. (C99 has no atomics; these are the builtins of gcc and clang.) */
    __atomic_add_fetch((uint64_t *)ctx, 1, __ATOMIC_RELAXED);
    if (max[2] <= -0.3 || min[2] >= 0.4) {
        return LEAFLESS_TAG_EMPTY;
    }
    return min[2] >= -0.3 && max[2] <= 0.4 ? LEAFLESS_TAG_FULL : LEAFLESS_TAG_PARTIAL;
}

static int32_t gives_up(void *ctx, const double *min, const double *max) {
    if (__atomic_load_n((uint64_t *)ctx, __ATOMIC_RELAXED) > 100) {
        return -7;
    }
    return slab(ctx, min, max);
}

static void taken_up(const leafless_solid *ball) {
    const double point[3] = {0.7, 0.1, 0.1};
    leafless_frame deep = frame;
    leafless_solid_callbacks callbacks;
    leafless_solid *solid = NULL, *other = NULL, *nameless = NULL;
    leafless_lazy *lazy = NULL, *never = NULL;
    leafless_octree *octree, *loaded = NULL, *direct, *resumed;
    uint64_t asked = 0, length;
    uint8_t *bytes;
    const char *source = NULL;
    size_t source_length = 0;

    OK(leafless_init(&callbacks, sizeof callbacks));
    callbacks.classify = slab;
    callbacks.ctx = &asked;
    OK(leafless_solid_new_callbacks(&callbacks, &nameless));
    callbacks.fingerprint[1] = 0x123456789abcdef0;
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    callbacks.fingerprint[0] = 1;
    OK(leafless_solid_new_callbacks(&callbacks, &other));

    OK(leafless_lazy_new(solid, &frame, &lazy));
    OK(leafless_lazy_refine(lazy, NULL, 3, NULL, NULL));
    OK(check_refine(lazy, check_zone_point(point), 6, NULL));
    /* No cell is queried twice: the host needs no way to a cell. */
    CHECK(counts_of(lazy).replays == 0 && asked == 1 + 8 * counts_of(lazy).splits);
    octree = frozen(lazy);
    OK(leafless_octree_peek_metadata(octree, "source", 6, &source, &source_length));
    CHECK(source_length == 37 && memcmp(source, "xxh3:", 5) == 0);
    bytes = check_bytes(octree, &length);
    leafless_octree_free(octree);
    OK(octree_from_bytes(bytes, length, &loaded));
    free(bytes);

    /* Only the solid that made it can resume it. */
    FAILS(LEAFLESS_E_SOURCE, leafless_lazy_resume(loaded, other, &frame, NULL, &never));
    FAILS(LEAFLESS_E_SOURCE, leafless_lazy_resume(loaded, ball, &frame, NULL, &never));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_lazy_resume(loaded, nameless, &frame, NULL, &never));
    FAILS(LEAFLESS_E_SOURCE, leafless_lazy_resume(built, ball, &frame, NULL, &never));
    deep.depth = DEPTH - 1;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_lazy_resume(loaded, solid, &deep, NULL, &never));
    deep = frame;
    deep.edge = 4;
    FAILS(LEAFLESS_E_FRAME, leafless_lazy_resume(loaded, solid, &deep, NULL, &never));
    deep = check_frame(20);
    CHECK(never == NULL);
    OK(leafless_lazy_resume(loaded, solid, &deep, NULL, &never));
    OK(check_refine(never, check_zone_point(point), 20, NULL));
    CHECK(at(never, 0.7, 0.1, 0.1) == LEAFLESS_MEMBERSHIP_INSIDE);
    leafless_lazy_free(never);
    never = NULL;
    OK(leafless_lazy_resume(loaded, solid, &frame, NULL, &never));
    CHECK(counts_of(never).splits == 0);
    /* The octree shares its solid. */
    leafless_solid_free(solid);
    leafless_octree_free(loaded);
    OK(leafless_lazy_refine(lazy, NULL, DEPTH, NULL, NULL));
    OK(leafless_lazy_refine(never, NULL, DEPTH, NULL, NULL));
    CHECK(counts_of(never).splits < counts_of(lazy).splits);
    CHECK(counts_of(never).replays == 0 && counts_of(lazy).replays == 0);
    direct = frozen(lazy);
    resumed = frozen(never);
    CHECK(check_same(direct, resumed));
    leafless_octree_free(direct);
    leafless_octree_free(resumed);
    leafless_lazy_free(lazy);
    leafless_lazy_free(never);
    leafless_solid_free(other);
    leafless_solid_free(nameless);

    /* The host gives up in between. */
    callbacks.classify = gives_up;
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    asked = 0;
    OK(leafless_lazy_new(solid, &frame, &lazy));
    FAILS(LEAFLESS_E_CALLBACK, leafless_lazy_refine(lazy, NULL, DEPTH, NULL, NULL));
    FAILS(LEAFLESS_E_CALLBACK, leafless_lazy_refine(lazy, NULL, DEPTH, NULL, NULL));
    CHECK(counts_of(lazy).splits > 0 && counts_of(lazy).replays == 0);
    asked = 0;
    octree = frozen(lazy);
    leafless_octree_free(octree);
    leafless_lazy_free(lazy);
    leafless_solid_free(solid);
}

int main(void) {
    leafless_solid *solid = check_ball_solid();
    frame = check_frame(DEPTH);
    built = check_ball(DEPTH, LEAFLESS_RULE_CERTIFIED);
    cell_by_cell(solid);
    zones(solid);
    evaluations();
    limits(solid);
    taken_up(solid);
    leafless_octree_free(built);
    leafless_solid_free(solid);
    leafless_lazy_free(NULL);
    return 0;
}
