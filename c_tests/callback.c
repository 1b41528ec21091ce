/* The host's own shape: a ball given only by verdicts on boxes or by distances; and mistakes of hosts. */
#include "check.h"

typedef struct host {
    double radius;
    int classified;
    int decided;
    int destroyed;
    int32_t answer;          /* the result of `garbage` */
    leafless_octree *octree; /* the octree that `asks` uses */
    leafless_solid *self;
    int calls;               /* of functions that get many at once */
    uint64_t most_boxes;     /* in one call, and so on */
    uint64_t most_points;
    uint64_t most_distances;
    double nothing;          /* the answer of `says_nothing` */
    int fails_at;            /* the call in which `distances` gives up, or 0 */
} host;

static host ball_host(void) {
    host h;
    memset(&h, 0, sizeof h);
    h.radius = 0.75;
    return h;
}

/* Exact enough: the frame's planes are short binary fractions, so that no sum here is rounded. */
static int32_t ball(void *ctx, const double *min, const double *max) {
    host *h = (host *)ctx;
    double near = 0.0, far = 0.0;
    int axis;
    h->classified++;
    for (axis = 0; axis < 3; axis++) {
        const double low = min[axis] > 0.0 ? min[axis] : max[axis] < 0.0 ? -max[axis] : 0.0;
        const double high = -min[axis] > max[axis] ? -min[axis] : max[axis];
        near += low * low;
        far += high * high;
    }
    /* Touching alone leaves a cell outside. */
    return near >= h->radius * h->radius  ? LEAFLESS_TAG_EMPTY
           : far <= h->radius * h->radius ? LEAFLESS_TAG_FULL
                                          : LEAFLESS_TAG_PARTIAL;
}

static int32_t in_ball(void *ctx, const double *point) {
    host *h = (host *)ctx;
    h->decided++;
    return point[0] * point[0] + point[1] * point[1] + point[2] * point[2] < h->radius * h->radius;
}

static int32_t garbage(void *ctx, const double *min, const double *max) {
    (void)min;
    (void)max;
    return ((host *)ctx)->answer;
}

static int32_t garbage_point(void *ctx, const double *point) {
    (void)point;
    return ((host *)ctx)->answer;
}

/* Asks the library about the box, and builds, fails and frees on the way. */
static int32_t asks(void *ctx, const double *min, const double *max) {
    host *h = (host *)ctx;
    leafless_region region;
    h->classified++;
    if (leafless_octree_classify_box(h->octree, min, max, &region) != LEAFLESS_OK) {
        return -1;
    }
    if (h->classified % 50 == 1) {
        leafless_octree *other = NULL, *joined = NULL;
        leafless_solid *again = NULL;
        if (check_octrees(LEAFLESS_OPERATION_UNION, h->octree, NULL, NULL, &other) != LEAFLESS_E_NULL) {
            return -2;
        }
        if (leafless_octree_complement(h->octree, NULL, &other) != LEAFLESS_OK ||
            check_octrees(LEAFLESS_OPERATION_UNION, h->octree, other, NULL, &joined) != LEAFLESS_OK) {
            return -3;
        }
        leafless_octree_free(other);
        leafless_octree_free(joined);
        /* References of the very solid that is being built. */
        if (leafless_solid_ref(h->self, &again) != LEAFLESS_OK) {
            return -4;
        }
        leafless_solid_free(again);
    }
    switch (region) {
        case LEAFLESS_REGION_OUTSIDE: return LEAFLESS_TAG_EMPTY;
        case LEAFLESS_REGION_INSIDE: return LEAFLESS_TAG_FULL;
        default: return LEAFLESS_TAG_PARTIAL;
    }
}

static void gone(void *ctx) {
    ((host *)ctx)->destroyed++;
}

/* May call the library: here it frees the context's objects. */
static void gone_with_all(void *ctx) {
    host *h = (host *)ctx;
    leafless_octree *complement = NULL;
    OK(leafless_octree_complement(h->octree, NULL, &complement));
    leafless_octree_free(complement);
    leafless_octree_free(h->octree);
    FAILS(LEAFLESS_E_NULL, leafless_octree_check(NULL));
    h->destroyed++;
}

static int32_t balls(void *ctx, const double *boxes, uint64_t count, int32_t *tags) {
    host *h = (host *)ctx;
    uint64_t i;
    h->calls++;
    h->most_boxes = count > h->most_boxes ? count : h->most_boxes;
    CHECK(count > 0);
    for (i = 0; i < count; i++) {
        tags[i] = ball(ctx, boxes + 6 * i, boxes + 6 * i + 3);
    }
    return ((host *)ctx)->answer;
}

static int32_t in_balls(void *ctx, const double *points, uint64_t count, int32_t *inside) {
    host *h = (host *)ctx;
    uint64_t i;
    h->most_points = count > h->most_points ? count : h->most_points;
    CHECK(count > 0);
    for (i = 0; i < count; i++) {
        inside[i] = in_ball(ctx, points + 3 * i);
    }
    return ((host *)ctx)->answer;
}

/* The exact signed distances, with a margin far larger than the rounding. */
static int32_t distances(void *ctx, const double *points, uint64_t count, double *distances_model) {
    host *h = (host *)ctx;
    uint64_t i;
    h->calls++;
    h->most_distances = count > h->most_distances ? count : h->most_distances;
    CHECK(count > 0);
    if (h->calls == h->fails_at) {
        return -23;
    }
    for (i = 0; i < count; i++) {
        const double *p = points + 3 * i;
        const double distance = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) - h->radius;
        distances_model[i] = distance > 1e-12 ? distance - 1e-12 : distance < -1e-12 ? distance + 1e-12 : 0.0;
    }
    return 0;
}

/* The same number for each point; if it is 1, none is set at all. */
static int32_t says_nothing(void *ctx, const double *points, uint64_t count, double *distances_model) {
    host *h = (host *)ctx;
    uint64_t i;
    (void)points;
    h->calls++;
    for (i = 0; i < count && h->nothing != 1.0; i++) {
        distances_model[i] = h->nothing;
    }
    return 0;
}

/* The function |p|^2 - r^2 over a box, with a margin larger than the rounding; or the value of `nothing`. */
static int32_t gradient(void *ctx, const double *min, const double *max, const double *middle,
                        leafless_gradient *gradient) {
    host *h = (host *)ctx;
    const double value = middle[0] * middle[0] + middle[1] * middle[1] + middle[2] * middle[2] - h->radius * h->radius;
    int axis;
    h->calls++;
    if (h->calls == h->fails_at) {
        return -23;
    }
    CHECK(isnan(gradient->value.lower) && isnan(gradient->gradient[2].upper));
    if (h->nothing == 1.0) {
        return 0;
    }
    gradient->value.lower = value - 1e-12;
    gradient->value.upper = value + 1e-12;
    for (axis = 0; axis < 3; axis++) {
        CHECK(min[axis] <= middle[axis] && middle[axis] <= max[axis]);
        gradient->gradient[axis].lower = 2 * min[axis] - 1e-12;
        gradient->gradient[axis].upper = 2 * max[axis] + 1e-12;
    }
    return 0;
}

/* The ball by its nearest point, and by a half-space outside; or the value of `nothing`. */
static int32_t tangent(void *ctx, const double *min, const double *max, const double *middle,
                       leafless_tangent *tangent) {
    host *h = (host *)ctx;
    const double length = sqrt(middle[0] * middle[0] + middle[1] * middle[1] + middle[2] * middle[2]);
    int axis;
    (void)min, (void)max;
    h->calls++;
    if (h->calls == h->fails_at) {
        return -23;
    }
    CHECK(isnan(tangent->point[0]) && isnan(tangent->normal[2]) && isnan(tangent->error));
    if (h->nothing == 1.0 || length < 0.1) {
        return 0;
    }
    for (axis = 0; axis < 3; axis++) {
        tangent->point[axis] = middle[axis] * h->radius / length;
        tangent->normal[axis] = middle[axis];
    }
    tangent->inner_curvature = 1 / h->radius;
    tangent->outer_curvature = 0;
    tangent->error = 1e-12;
    return 0;
}

/* A brick with corners at (0, 0, -0.25) and (0.5, 0.25, 0.125). */
static const double BRICK[2][3] = {{0, 0, -0.25}, {0.5, 0.25, 0.125}};

static int32_t brick(void *ctx, const double *min, const double *max) {
    bool inside = true;
    int axis;
    ((host *)ctx)->classified++;
    for (axis = 0; axis < 3; axis++) {
        if (max[axis] <= BRICK[0][axis] || min[axis] >= BRICK[1][axis]) {
            return LEAFLESS_TAG_EMPTY;
        }
        inside = inside && BRICK[0][axis] <= min[axis] && max[axis] <= BRICK[1][axis];
    }
    return inside ? LEAFLESS_TAG_FULL : LEAFLESS_TAG_PARTIAL;
}

/* Sets nothing. */
static int32_t lazy_balls(void *ctx, const double *boxes, uint64_t count, int32_t *tags) {
    (void)ctx, (void)boxes, (void)count, (void)tags;
    return 0;
}

static leafless_solid_callbacks callbacks_of(host *h) {
    leafless_solid_callbacks callbacks;
    memset(&callbacks, 0, sizeof callbacks);
    callbacks.struct_size = sizeof callbacks;
    callbacks.exterior = LEAFLESS_EXTERIOR_EMPTY;
    callbacks.classify = ball;
    callbacks.contains = in_ball;
    callbacks.destroy = gone;
    callbacks.ctx = h;
    return callbacks;
}

static leafless_options one_thread(void) {
    leafless_options options;
    OK(leafless_init(&options, sizeof options));
    options.threads = 1;
    return options;
}

static void equals_the_library(void) {
    static const uint32_t rules[] = {LEAFLESS_RULE_CERTIFIED, LEAFLESS_RULE_SAMPLED, LEAFLESS_RULE_INNER,
                                     LEAFLESS_RULE_OUTER};
    const leafless_options options = one_thread();
    size_t i;
    for (i = 0; i < COUNT(rules); i++) {
        const leafless_frame frame = check_frame(6);
        host h = ball_host();
        leafless_solid_callbacks callbacks = callbacks_of(&h);
        leafless_solid *solid = NULL;
        leafless_octree *own = NULL, *known = check_ball(6, rules[i]);
        leafless_octree_info a = LEAFLESS_INIT(leafless_octree_info);
        leafless_octree_info b = LEAFLESS_INIT(leafless_octree_info);
        OK(leafless_solid_new_callbacks(&callbacks, &solid));
        /* The struct was copied. */
        memset(&callbacks, 0xff, sizeof callbacks);
        OK(leafless_octree_build(solid, &frame, rules[i], &options, &own));
        CHECK(check_same(own, known));
        OK(leafless_octree_describe(own, &a));
        OK(leafless_octree_describe(known, &b));
        CHECK(a.exterior == b.exterior && a.elements == b.elements && a.bricks == b.bricks && !a.is_clipped);
        CHECK(h.classified > 0 && (h.decided > 0) == (rules[i] == LEAFLESS_RULE_SAMPLED));
        CHECK(h.destroyed == 0);
        leafless_solid_free(solid);
        CHECK(h.destroyed == 1);
        /* The octree does not need the host. */
        OK(leafless_octree_check(own));
        leafless_octree_free(own);
        leafless_octree_free(known);
        CHECK(h.destroyed == 1);
    }
}

static void is_destroyed_once(void) {
    host h = ball_host();
    leafless_solid_callbacks callbacks = callbacks_of(&h);
    leafless_solid *solid = NULL, *references[5];
    size_t i;
    /* Not if there is no solid in the end. */
    callbacks.exterior = 3;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_callbacks(&callbacks, &solid));
    callbacks.exterior = LEAFLESS_EXTERIOR_UNKNOWN;
    callbacks.classify = NULL;
    FAILS(LEAFLESS_E_NULL, leafless_solid_new_callbacks(&callbacks, &solid));
    callbacks.contains_many = in_balls;
    FAILS(LEAFLESS_E_NULL, leafless_solid_new_callbacks(&callbacks, &solid));
    callbacks.classify_many = balls;
    FAILS(LEAFLESS_E_NULL, leafless_solid_new_callbacks(&callbacks, &solid));
    /* Distances make up for `classify`, but not beside `classify_many`. */
    callbacks.distance_many = distances;
    FAILS(LEAFLESS_E_NULL, leafless_solid_new_callbacks(&callbacks, &solid));
    callbacks.contains_many = NULL;
    callbacks.classify_many = NULL;
    callbacks.distance_many = NULL;
    callbacks.classify = ball;
    FAILS(LEAFLESS_E_NULL, leafless_solid_new_callbacks(&callbacks, NULL));
    callbacks.struct_size = 3;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_callbacks(&callbacks, &solid));
    CHECK(h.destroyed == 0 && solid == NULL);

    callbacks.struct_size = sizeof callbacks;
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    for (i = 0; i < COUNT(references); i++) {
        OK(leafless_solid_ref(solid, &references[i]));
    }
    leafless_solid_free(solid);
    for (i = 0; i < COUNT(references); i++) {
        CHECK(h.destroyed == 0);
        leafless_solid_free(references[i]);
    }
    CHECK(h.destroyed == 1);

    /* `destroy` and the context are optional. */
    callbacks.destroy = NULL;
    callbacks.contains = NULL;
    callbacks.classify = garbage;
    h.answer = LEAFLESS_TAG_FULL;
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    leafless_solid_free(solid);
    CHECK(h.destroyed == 1);
}

static void garbage_is_refused(void) {
    static const int32_t verdicts[] = {-1, LEAFLESS_TAG_BRANCH, 4, 255, 256, 258, INT32_MAX, INT32_MIN, -4711};
    static const int32_t decisions[] = {-1, 2, 3, 256, 257, INT32_MAX, INT32_MIN};
    const leafless_frame frame = check_frame(6);
    host h = ball_host();
    leafless_solid_callbacks callbacks = callbacks_of(&h);
    leafless_solid *solid = NULL;
    leafless_octree *octree = NULL;
    leafless_options options = one_thread();
    char message[512], expected[32];
    size_t i;
    uint32_t threads;

    callbacks.classify = garbage;
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    for (i = 0; i < COUNT(verdicts); i++) {
        h.answer = verdicts[i];
        FAILS(LEAFLESS_E_CALLBACK, leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &octree));
        (void)leafless_last_error(message, sizeof message);
        snprintf(expected, sizeof expected, "code %ld", (long)verdicts[i]);
        CHECK(octree == NULL && strstr(message, expected) != NULL);
    }
    leafless_solid_free(solid);

    callbacks.classify = ball;
    callbacks.contains = garbage_point;
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    for (threads = 1; threads <= 4; threads += 3) {
        options.threads = threads;
        for (i = 0; i < COUNT(decisions); i++) {
            /* Only one thread counts. */
            h.answer = decisions[i];
            if (threads == 1) {
                FAILS(LEAFLESS_E_CALLBACK, leafless_octree_build(solid, &frame, LEAFLESS_RULE_SAMPLED, &options, &octree));
                (void)leafless_last_error(message, sizeof message);
                snprintf(expected, sizeof expected, "code %ld", (long)decisions[i]);
                CHECK(octree == NULL && strstr(message, expected) != NULL);
            }
        }
    }
    leafless_solid_free(solid);

    /* A host that cannot decide points cannot be sampled, and says nothing about the outside by default. */
    options.threads = 1;
    callbacks.contains = NULL;
    callbacks.exterior = LEAFLESS_EXTERIOR_UNKNOWN;
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    FAILS(LEAFLESS_E_NOT_SAMPLED, leafless_octree_build(solid, &frame, LEAFLESS_RULE_SAMPLED, &options, &octree));
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &octree));
    leafless_solid_free(solid);
    {
        leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
        OK(leafless_octree_describe(octree, &info));
        CHECK(info.is_clipped && info.exterior == LEAFLESS_TAG_PARTIAL);
    }
    leafless_octree_free(octree);
}

static void may_call_the_library(void) {
    const leafless_frame frame = check_frame(5);
    host h = ball_host();
    leafless_solid_callbacks callbacks = callbacks_of(&h);
    leafless_solid *solid = NULL;
    leafless_octree *octree = NULL;
    leafless_options options = one_thread();
    h.octree = check_ball(5, LEAFLESS_RULE_CERTIFIED);
    callbacks.classify = asks;
    callbacks.contains = NULL;
    callbacks.destroy = gone_with_all;
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    h.self = solid;
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &octree));
    CHECK(h.classified > 50);
    CHECK(check_same(octree, h.octree));
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    CHECK(h.destroyed == 1);
}

/* Many at once: the same octrees, in fewer calls; errors, and tags that are not set, end the work. */
static void many_at_once(void) {
    static const uint32_t rules[] = {LEAFLESS_RULE_CERTIFIED, LEAFLESS_RULE_SAMPLED};
    const leafless_frame frame = check_frame(6);
    const leafless_options options = one_thread();
    size_t i;
    for (i = 0; i < COUNT(rules); i++) {
        host h = ball_host();
        leafless_solid_callbacks callbacks = callbacks_of(&h);
        leafless_solid *solid = NULL;
        leafless_octree *own = NULL, *known = check_ball(6, rules[i]);
        callbacks.classify_many = balls;
        callbacks.contains_many = in_balls;
        callbacks.contains = NULL;
        OK(leafless_solid_new_callbacks(&callbacks, &solid));
        OK(leafless_octree_build(solid, &frame, rules[i], &options, &own));
        CHECK(check_same(own, known));
        /* As many as there are at hand, not only the children of one cell. */
        CHECK(h.most_boxes > 64 && h.most_boxes % 8 == 0 && h.calls * 64 < h.classified);
        CHECK(rules[i] != LEAFLESS_RULE_SAMPLED || (h.most_points > 64 && h.decided > 64));
        leafless_octree_free(own);
        own = NULL;
        h.answer = -17;
        FAILS(LEAFLESS_E_CALLBACK, leafless_octree_build(solid, &frame, rules[i], &options, &own));
        leafless_solid_free(solid);
        callbacks.classify_many = lazy_balls;
        OK(leafless_solid_new_callbacks(&callbacks, &solid));
        FAILS(LEAFLESS_E_CALLBACK, leafless_octree_build(solid, &frame, rules[i], &options, &own));
        leafless_solid_free(solid);
        leafless_octree_free(known);
    }
}

static leafless_statistics statistics_of(const leafless_octree *octree) {
    leafless_statistics statistics;
    OK(leafless_octree_check(octree));
    OK(leafless_octree_statistics(octree, &statistics));
    return statistics;
}

static void fails_with(leafless_status status, const char *what) {
    char message[512];
    CHECK(status == LEAFLESS_E_CALLBACK && leafless_last_status() == LEAFLESS_E_CALLBACK);
    (void)leafless_last_error(message, sizeof message);
    CHECK(strstr(message, what) != NULL);
}

/* A ball that is given only by its distances: each verdict is right, and they are not idle. */
static void by_distance_alone(void) {
    const double volume = 4.0 / 3.0 * 3.14159265358979323846 * 0.75 * 0.75 * 0.75;
    const leafless_frame frame = check_frame(6), deep = check_frame(20);
    const leafless_options options = one_thread();
    host h = ball_host();
    leafless_solid_callbacks callbacks = callbacks_of(&h);
    leafless_solid *solid = NULL;
    leafless_octree *own = NULL, *known = check_ball(6, LEAFLESS_RULE_CERTIFIED), *sampled = NULL;
    leafless_statistics found, best = statistics_of(known);
    leafless_measures measures = LEAFLESS_INIT(leafless_measures);
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
    uint32_t cell[3];
    callbacks.classify = NULL;
    callbacks.contains = NULL;
    callbacks.distance_many = distances;
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &own));
    CHECK(h.classified == 0 && h.decided == 0 && h.calls > 0 && h.most_distances > 8);
    OK(leafless_octree_describe(own, &info));
    CHECK(info.exterior == LEAFLESS_TAG_EMPTY && !info.is_clipped);
    found = statistics_of(own);
    CHECK(found.volume_model.lower < volume && volume < found.volume_model.upper);
    CHECK(found.volume_model.upper - found.volume_model.lower < 2 * (best.volume_model.upper - best.volume_model.lower));
    /* What is decided by a ball around a cell's middle is decided by the cell, too. */
    for (cell[2] = 0; cell[2] < 64; cell[2]++) {
        for (cell[1] = 0; cell[1] < 64; cell[1]++) {
            for (cell[0] = 0; cell[0] < 64; cell[0]++) {
                leafless_tag tag, exact;
                OK(leafless_octree_tag_at(own, cell, &tag));
                OK(leafless_octree_tag_at(known, cell, &exact));
                CHECK(tag == exact || tag == LEAFLESS_TAG_PARTIAL);
            }
        }
    }
    OK(leafless_solid_measure(solid, &deep, 0.05, 0.0, &options, &measures));
    CHECK(measures.volume_model.lower < volume && volume < measures.volume_model.upper);
    CHECK(measures.measured == LEAFLESS_STOP_REASON_TOLERANCE);
    {
        /* As near to the surface as the frame goes. */
        const double at[4][3] = {{0.75 - 1e-5, 0, 0}, {0, 0.75 + 1e-5, 0}, {0.45, 0, -0.6}, {0, 0, 0}};
        const double low[3] = {-0.4, -0.4, -0.4}, high[3] = {0.4, 0.4, 0.4}, out[3] = {0.9, 0.9, 0.9};
        leafless_membership answers[4];
        leafless_region region;
        OK(leafless_solid_contains_many(solid, &deep, at[0], 4, &options, answers));
        CHECK(answers[0] == LEAFLESS_MEMBERSHIP_INSIDE && answers[1] == LEAFLESS_MEMBERSHIP_OUTSIDE);
        CHECK(answers[2] == LEAFLESS_MEMBERSHIP_UNDECIDED && answers[3] == LEAFLESS_MEMBERSHIP_INSIDE);
        OK(leafless_solid_classify_box(solid, &deep, low, high, &options, &region));
        CHECK(region == LEAFLESS_REGION_INSIDE);
        OK(leafless_solid_classify_box(solid, &deep, high, out, &options, &region));
        CHECK(region == LEAFLESS_REGION_CROSSING);
    }
    /* Points are not decided by distances, but by `contains`, as ever. */
    FAILS(LEAFLESS_E_NOT_SAMPLED, leafless_octree_build(solid, &frame, LEAFLESS_RULE_SAMPLED, &options, &sampled));
    leafless_octree_free(known);
    leafless_solid_free(solid);
    CHECK(h.destroyed == 1 && h.classified == 0);
    callbacks.contains = in_ball;
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_SAMPLED, &options, &sampled));
    known = check_ball(6, LEAFLESS_RULE_SAMPLED);
    CHECK(check_same(sampled, known) && h.decided > 0);
    leafless_octree_free(sampled);
    leafless_octree_free(known);
    leafless_octree_free(own);
    leafless_solid_free(solid);
    CHECK(h.destroyed == 2);
}

/* Beside `classify` and `classify_many` distances save boxes, and change nothing. */
static void by_distance_and_boxes(void) {
    static const uint32_t rules[] = {LEAFLESS_RULE_CERTIFIED, LEAFLESS_RULE_SAMPLED};
    static const double nothings[] = {0.0, -0.0, NAN, 1.0};
    const leafless_frame frame = check_frame(6);
    const leafless_options options = one_thread();
    size_t i, many, n;
    for (i = 0; i < COUNT(rules); i++) {
        for (many = 0; many < 2; many++) {
            host h = ball_host();
            leafless_solid_callbacks callbacks = callbacks_of(&h);
            leafless_solid *solid = NULL;
            leafless_octree *own = NULL, *known = check_ball(6, rules[i]);
            int without;
            callbacks.classify_many = many ? balls : NULL;
            OK(leafless_solid_new_callbacks(&callbacks, &solid));
            OK(leafless_octree_build(solid, &frame, rules[i], &options, &own));
            CHECK(check_same(own, known));
            leafless_octree_free(own);
            leafless_solid_free(solid);
            without = h.classified;

            h.classified = 0;
            callbacks.distance_many = distances;
            OK(leafless_solid_new_callbacks(&callbacks, &solid));
            OK(leafless_octree_build(solid, &frame, rules[i], &options, &own));
            CHECK(check_same(own, known));
            CHECK(h.classified > 0 && h.classified < without && h.most_distances > 8);
            CHECK(!many || h.most_boxes > 8);
            leafless_octree_free(own);
            leafless_solid_free(solid);

            /* Distances that say nothing leave all to the boxes. */
            callbacks.distance_many = says_nothing;
            OK(leafless_solid_new_callbacks(&callbacks, &solid));
            for (n = 0; n < COUNT(nothings); n++) {
                h.classified = h.calls = 0;
                h.nothing = nothings[n];
                OK(leafless_octree_build(solid, &frame, rules[i], &options, &own));
                CHECK(check_same(own, known) && h.classified == without && h.calls > 0);
                leafless_octree_free(own);
            }
            leafless_solid_free(solid);
            leafless_octree_free(known);
        }
    }
    /* And without boxes nothing is known at all. */
    for (n = 0; n < COUNT(nothings); n++) {
        const leafless_frame shallow = check_frame(3);
        const double at[3] = {0.1, 0.1, 0.1};
        host h = ball_host();
        leafless_solid_callbacks callbacks = callbacks_of(&h);
        leafless_solid *solid = NULL;
        leafless_octree *own = NULL;
        leafless_membership answer = 77;
        leafless_statistics found;
        callbacks.classify = NULL;
        callbacks.contains = NULL;
        callbacks.distance_many = says_nothing;
        h.nothing = nothings[n];
        OK(leafless_solid_new_callbacks(&callbacks, &solid));
        OK(leafless_octree_build(solid, &shallow, LEAFLESS_RULE_CERTIFIED, &options, &own));
        found = statistics_of(own);
        CHECK(found.volume_model.lower == 0.0 && found.volume_model.upper == 8.0 && found.full == 0);
        OK(leafless_solid_contains_many(solid, &shallow, at, 1, &options, &answer));
        CHECK(answer == LEAFLESS_MEMBERSHIP_UNDECIDED);
        leafless_octree_free(own);
        leafless_solid_free(solid);
    }
}

/* An error of the host ends the work: the host is not called again. */
static void distance_gives_up(void) {
    const leafless_frame frame = check_frame(6);
    const double at[3] = {0.7, 0.2, 0.1}, beside[3] = {0.8, 0.3, 0.2};
    const leafless_options options = one_thread();
    int last;
    for (last = 1; last <= 3; last++) {
        host h = ball_host();
        leafless_solid_callbacks callbacks = callbacks_of(&h);
        leafless_solid *solid = NULL;
        leafless_octree *octree = NULL;
        leafless_lazy *lazy = NULL;
        leafless_membership answer = 77;
        leafless_region region = 77;
        leafless_measures measures = LEAFLESS_INIT(leafless_measures);
        leafless_extent extent = LEAFLESS_INIT(leafless_extent);
        callbacks.classify = last == 2 ? ball : NULL;
        callbacks.contains = NULL;
        callbacks.distance_many = distances;
        OK(leafless_solid_new_callbacks(&callbacks, &solid));
#define GIVES_UP(call)                                                                                           \
    h.calls = 0;                                                                                                 \
    fails_with((call), "code -23");                                                                              \
    CHECK(h.calls == last)
        h.fails_at = last;
        GIVES_UP(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &octree));
        GIVES_UP(leafless_solid_contains_many(solid, &frame, at, 1, &options, &answer));
        GIVES_UP(leafless_solid_classify_box(solid, &frame, at, beside, &options, &region));
        GIVES_UP(leafless_solid_measure(solid, &frame, 0.0, 0.0, &options, &measures));
        GIVES_UP(leafless_solid_bounding_box(solid, &frame, 0.0, &options, &extent));
        CHECK(octree == NULL && region == 77);
        h.calls = 0;
        if (last == 1) {
            fails_with(leafless_lazy_new(solid, &frame, &lazy), "code -23");
            CHECK(lazy == NULL);
        } else {
            OK(leafless_lazy_new(solid, &frame, &lazy));
            fails_with(leafless_lazy_refine(lazy, NULL, 6, &options, NULL), "code -23");
            CHECK(h.calls == last);
            /* The failed call is repeated. */
            h.fails_at = 0;
            OK(leafless_lazy_refine(lazy, NULL, 6, &options, NULL));
            leafless_lazy_free(lazy);
        }
        /* The solid is as good as ever. */
        h.fails_at = 0;
        OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &octree));
        OK(leafless_octree_check(octree));
        leafless_octree_free(octree);
        leafless_solid_free(solid);
        CHECK(h.destroyed == 1);
    }
}

/* The host's knowledge of the surface in a cell makes measures and boxes quick, and changes no verdict. */
static void by_slabs(void) {
    const double volume = 4.0 / 3.0 * 3.14159265358979323846 * 0.75 * 0.75 * 0.75;
    const leafless_frame frame = check_frame(20), shallow = check_frame(6);
    leafless_options options = one_thread();
    int which, fails_at;
    for (which = 1; which <= 3; which++) {
        host h = ball_host();
        leafless_solid_callbacks callbacks = callbacks_of(&h);
        leafless_solid *solid = NULL;
        leafless_octree *own = NULL, *known = check_ball(6, LEAFLESS_RULE_CERTIFIED);
        leafless_measures measures = LEAFLESS_INIT(leafless_measures);
        leafless_extent extent = LEAFLESS_INIT(leafless_extent);
        callbacks.gradient = which & 1 ? gradient : NULL;
        callbacks.tangent = which & 2 ? tangent : NULL;
        OK(leafless_solid_new_callbacks(&callbacks, &solid));
        OK(leafless_octree_build(solid, &shallow, LEAFLESS_RULE_CERTIFIED, &options, &own));
        CHECK(check_same(own, known) && h.calls == 0);
        OK(leafless_solid_measure(solid, &frame, 1e-3, 0.0, &options, &measures));
        CHECK(measures.measured == LEAFLESS_STOP_REASON_TOLERANCE && measures.splits < 60000 && h.calls > 0);
        CHECK(measures.volume_model.lower < volume && volume < measures.volume_model.upper);
        CHECK(measures.volume_model.upper - measures.volume_model.lower <= 1e-3 * volume);
        OK(leafless_solid_bounding_box(solid, &frame, 1e-5, &options, &extent));
        CHECK(extent.measured == LEAFLESS_STOP_REASON_TOLERANCE && extent.splits < 20000);
        CHECK(extent.max_model[1].lower <= 0.75 && 0.75 <= extent.max_model[1].upper);
        for (fails_at = 1; fails_at <= 40; fails_at += 13) {
            h.calls = 0;
            h.fails_at = fails_at;
            fails_with(leafless_solid_measure(solid, &frame, 1e-3, 0.0, &options, &measures), "code -23");
            CHECK(h.calls == fails_at);
        }
        h.fails_at = 0;
        /* Nothing set is nothing said. */
        h.nothing = 1.0;
        options.max_splits = 1000;
        OK(leafless_solid_measure(solid, &frame, 1e-3, 0.0, &options, &measures));
        CHECK(measures.measured == LEAFLESS_STOP_REASON_BUDGET);
        CHECK(measures.volume_model.lower < volume && volume < measures.volume_model.upper);
        options.max_splits = 0;
        leafless_octree_free(own);
        leafless_octree_free(known);
        leafless_solid_free(solid);
        CHECK(h.destroyed == 1);
    }
}

/* The depth of a point in the brick: the least of its depths inside the six faces. The point is taken back by the inverse
   of a rotation by the angle with cosine 0.8 and an offset. */
static double in_brick(const double *offset, const double *point) {
    const double q[3] = {point[0] - offset[0], point[1] - offset[1], point[2] - offset[2]};
    double at[3], least = INFINITY;
    int axis;
    at[0] = 0.8 * q[0] + 0.6 * q[1], at[1] = -0.6 * q[0] + 0.8 * q[1], at[2] = q[2];
    for (axis = 0; axis < 3; axis++) {
        least = fmin(least, fmin(at[axis] - BRICK[0][axis], BRICK[1][axis] - at[axis]));
    }
    return least;
}

/* A host's shape is moved on a frame that the library chooses: exactly where cells are the images of cells. */
static void is_moved(void) {
    const leafless_frame frame = check_frame(6);
    const leafless_options options = one_thread();
    /* A quarter turn about z and an offset of whole cells. */
    const double quarter[12] = {0, -1, 0, 0.125, 1, 0, 0, -0.25, 0, 0, 1, 0.03125};
    const double turn[12] = {0.8, -0.6, 0, 0.1, 0.6, 0.8, 0, 0.2, 0, 0, 1, -0.3}, offset[3] = {0.1, 0.2, -0.3};
    const double low[3] = {-0.125, -0.25, -0.21875}, high[3] = {0.125, 0.25, 0.15625};
    const double volume = 0.5 * 0.25 * 0.375;
    static double points[4000][3];
    static leafless_membership answers[4000];
    host h = ball_host();
    leafless_solid_callbacks callbacks = callbacks_of(&h);
    leafless_solid *solid = NULL, *moved = NULL, *known = NULL;
    leafless_octree *own = NULL, *box = NULL;
    leafless_motion motion = 77;
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
    leafless_statistics found;
    uint64_t state = 3;
    size_t i;
    int axis, decided = 0;
    callbacks.classify = brick;
    callbacks.contains = NULL;
    /* What was promised of a universe is not known of another one. */
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    OK(leafless_solid_placed(solid, quarter, NULL, &moved));
    OK(leafless_octree_build(moved, &frame, LEAFLESS_RULE_CERTIFIED, &options, &own));
    OK(leafless_octree_describe(own, &info));
    CHECK(info.is_clipped);
    leafless_octree_free(own);
    leafless_solid_free(moved);
    leafless_solid_free(solid);
    CHECK(h.destroyed == 1);
    for (axis = 0; axis < 6; axis++) {
        callbacks.bounds[axis] = BRICK[axis / 3][axis % 3];
    }
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    OK(leafless_solid_placed(solid, quarter, &motion, &moved));
    CHECK(motion == LEAFLESS_MOTION_CONSERVATIVE);
    OK(leafless_solid_new_box(low, high, &known));
    OK(leafless_octree_build(moved, &frame, LEAFLESS_RULE_CERTIFIED, &options, &own));
    OK(leafless_octree_build(known, &frame, LEAFLESS_RULE_CERTIFIED, &options, &box));
    found = statistics_of(own);
    CHECK(found.volume_model.lower == volume && found.volume_model.upper == volume);
    CHECK(check_same(own, box));
    leafless_octree_free(own);
    leafless_octree_free(box);
    leafless_solid_free(known);
    leafless_solid_free(moved);

    motion = 77;
    OK(leafless_solid_placed(solid, turn, &motion, &moved));
    CHECK(motion == LEAFLESS_MOTION_CONSERVATIVE);
    /* What is moved shares the host's shape. */
    leafless_solid_free(solid);
    CHECK(h.destroyed == 1);
    OK(leafless_octree_build(moved, &frame, LEAFLESS_RULE_CERTIFIED, &options, &own));
    found = statistics_of(own);
    /* The box around the shape moves along. */
    OK(leafless_octree_describe(own, &info));
    CHECK(!info.is_clipped);
    CHECK(0.2 * volume < found.volume_model.lower && found.volume_model.lower < volume);
    CHECK(volume < found.volume_model.upper && found.volume_model.upper < 2.5 * volume);
    for (i = 0; i < COUNT(points); i++) {
        for (axis = 0; axis < 3; axis++) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            points[i][axis] = (double)(state >> 11) / 9007199254740992.0 * 1.2 - 0.5 + offset[axis] / 2;
        }
    }
    OK(leafless_solid_contains_many(moved, &frame, points[0], COUNT(points), &options, answers));
    for (i = 0; i < COUNT(points); i++) {
        const double inside = in_brick(offset, points[i]);
        leafless_membership built;
        OK(leafless_octree_contains(own, points[i], &built));
        CHECK(built == answers[i]);
        CHECK(answers[i] != LEAFLESS_MEMBERSHIP_INSIDE || inside > 0);
        CHECK(answers[i] != LEAFLESS_MEMBERSHIP_OUTSIDE || inside < 0);
        /* It blurs by some cells of 1/32. */
        CHECK(fabs(inside) < 0.125 || answers[i] != LEAFLESS_MEMBERSHIP_UNDECIDED);
        decided += answers[i] != LEAFLESS_MEMBERSHIP_UNDECIDED;
    }
    CHECK(decided > 3000);
    leafless_octree_free(own);
    leafless_solid_free(moved);
    CHECK(h.destroyed == 2);

    callbacks.bounds[3] = -1;
    solid = NULL;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_callbacks(&callbacks, &solid));
    callbacks.bounds[3] = NAN;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_callbacks(&callbacks, &solid));
    CHECK(solid == NULL && h.destroyed == 2);
}

int main(void) {
    equals_the_library();
    many_at_once();
    by_distance_alone();
    by_distance_and_boxes();
    distance_gives_up();
    by_slabs();
    is_moved();
    is_destroyed_once();
    garbage_is_refused();
    may_call_the_library();
    return 0;
}
