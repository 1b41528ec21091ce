/* The host's own shape: a ball that the library knows only through boxes, and what a host may get wrong. */
#include "check.h"

typedef struct host {
    double radius;
    int classified;
    int decided;
    int destroyed;
    int32_t answer;          /* what `garbage` returns */
    leafless_octree *octree; /* what `asks` asks */
    leafless_solid *self;
} host;

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
        if (leafless_octree_union(h->octree, NULL, NULL, &other) != LEAFLESS_E_NULL) {
            return -2;
        }
        if (leafless_octree_complement(h->octree, NULL, &other) != LEAFLESS_OK ||
            leafless_octree_union(h->octree, other, NULL, &joined) != LEAFLESS_OK) {
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

/* May call the library: here it gives back what the context holds. */
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
    uint64_t i;
    for (i = 0; i < count; i++) {
        tags[i] = ball(ctx, boxes + 6 * i, boxes + 6 * i + 3);
    }
    return ((host *)ctx)->answer;
}

static int32_t in_balls(void *ctx, const double *points, uint64_t count, int32_t *inside) {
    uint64_t i;
    for (i = 0; i < count; i++) {
        inside[i] = in_ball(ctx, points + 3 * i);
    }
    return ((host *)ctx)->answer;
}

/* Sets nothing. */
static int32_t lazy_balls(void *ctx, const double *boxes, uint64_t count, int32_t *tags) {
    (void)ctx, (void)boxes, (void)count, (void)tags;
    return 0;
}

static leafless_callbacks callbacks_of(host *h) {
    leafless_callbacks callbacks;
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
    OK(leafless_options_init(&options, sizeof options));
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
        host h = {0.75, 0, 0, 0, 0, NULL, NULL};
        leafless_callbacks callbacks = callbacks_of(&h);
        leafless_solid *solid = NULL;
        leafless_octree *own = NULL, *known = check_ball(6, rules[i]);
        leafless_octree_info a, b;
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
    host h = {0.75, 0, 0, 0, 0, NULL, NULL};
    leafless_callbacks callbacks = callbacks_of(&h);
    leafless_solid *solid = NULL, *references[5];
    size_t i;
    /* Not if there is no solid in the end. */
    callbacks.exterior = 3;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_callbacks(&callbacks, &solid));
    callbacks.exterior = LEAFLESS_EXTERIOR_UNKNOWN;
    callbacks.classify = NULL;
    FAILS(LEAFLESS_E_NULL, leafless_solid_new_callbacks(&callbacks, &solid));
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

    /* Nobody has to be told, and nobody needs a context. */
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
    host h = {0.75, 0, 0, 0, 0, NULL, NULL};
    leafless_callbacks callbacks = callbacks_of(&h);
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
        leafless_octree_info info;
        OK(leafless_octree_describe(octree, &info));
        CHECK(info.is_clipped && info.exterior == LEAFLESS_TAG_PARTIAL);
    }
    leafless_octree_free(octree);
}

static void may_call_the_library(void) {
    const leafless_frame frame = check_frame(5);
    host h = {0.75, 0, 0, 0, 0, NULL, NULL};
    leafless_callbacks callbacks = callbacks_of(&h);
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
        host h = {0.75, 0, 0, 0, 0, NULL, NULL};
        leafless_callbacks callbacks = callbacks_of(&h);
        leafless_solid *solid = NULL;
        leafless_octree *own = NULL, *known = check_ball(6, rules[i]);
        callbacks.classify_many = balls;
        callbacks.contains_many = in_balls;
        callbacks.contains = NULL;
        OK(leafless_solid_new_callbacks(&callbacks, &solid));
        OK(leafless_octree_build(solid, &frame, rules[i], &options, &own));
        CHECK(check_same(own, known));
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

int main(void) {
    equals_the_library();
    many_at_once();
    is_destroyed_once();
    garbage_is_refused();
    may_call_the_library();
    return 0;
}
