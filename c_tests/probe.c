/* Points and boxes of solids without an octree: of every kind, on any frame, in any number of threads. */
#include "check.h"

#define POINTS 20000

static double points[POINTS][3];

static leafless_options threads(uint32_t count) {
    leafless_options options;
    OK(leafless_init(&options, sizeof options));
    options.threads = count;
    return options;
}

static double fraction(void) {
    static uint64_t state = 11;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (double)(state >> 11) / 9007199254740992.0;
}

/* The answers are the same for any number of threads, and limits do not matter. */
static void asked(const leafless_solid *solid, const leafless_frame *frame, leafless_membership *answers) {
    static leafless_membership again[POINTS];
    leafless_options options = threads(1);
    uint32_t count;
    memset(answers, 0x5a, POINTS);
    OK(leafless_solid_contains_many(solid, frame, points[0], POINTS, &options, answers));
    for (count = 0; count < 5; count++) {
        options.threads = count;
        options.max_splits = options.max_nodes = options.max_bytes = count % 2;
        memset(again, 0xa5, POINTS);
        OK(leafless_solid_contains_many(solid, frame, points[0], POINTS, &options, again));
        CHECK(memcmp(again, answers, POINTS) == 0);
    }
    memset(again, 0xa5, POINTS);
    OK(leafless_solid_contains_many(solid, frame, points[0], POINTS, NULL, again));
    CHECK(memcmp(again, answers, POINTS) == 0);
    /* One by one they are no others. */
    for (count = 0; count < 100; count++) {
        OK(leafless_solid_contains_many(solid, frame, points[count], 1, NULL, again));
        CHECK(again[0] == answers[count] && again[1] == answers[1]);
    }
}

/* Points and boxes are answered as by the octree of the same frame, or (a mesh knows them without cells) where that leaves them
 * undecided. */
static void agrees(const leafless_solid *solid, const leafless_frame *frame, bool knows_more) {
    static leafless_membership answers[POINTS], built[POINTS];
    leafless_octree *octree = NULL;
    uint64_t inside = 0, outside = 0, seen[4] = {0, 0, 0, 0};
    size_t i;
    int axis;
    asked(solid, frame, answers);
    OK(leafless_octree_build(solid, frame, LEAFLESS_RULE_CERTIFIED, NULL, &octree));
    OK(leafless_octree_contains_many(octree, points[0], POINTS, built));
    CHECK(knows_more != (memcmp(answers, built, POINTS) == 0));
    for (i = 0; i < POINTS; i++) {
        CHECK(answers[i] == built[i] || (knows_more && built[i] == LEAFLESS_MEMBERSHIP_UNDECIDED));
        inside += answers[i] == LEAFLESS_MEMBERSHIP_INSIDE;
        outside += answers[i] == LEAFLESS_MEMBERSHIP_OUTSIDE;
        CHECK(answers[i] <= LEAFLESS_MEMBERSHIP_UNDECIDED);
    }
    CHECK(inside > 300 && outside > 300);
    for (i = 0; i < 1500; i++) {
        double low[3], high[3];
        leafless_region region = 77, of_octree = 78;
        for (axis = 0; axis < 3; axis++) {
            const double size = fraction() < 0.3 ? 0.0 : 0.3 * fraction();
            low[axis] = points[i][axis];
            high[axis] = low[axis] + size;
        }
        OK(leafless_solid_classify_box(solid, frame, low, high, NULL, &region));
        OK(leafless_octree_classify_box(octree, low, high, &of_octree));
        CHECK(region < 4);
        CHECK(region == of_octree || (knows_more && of_octree == LEAFLESS_REGION_UNDECIDED));
        seen[region]++;
    }
    CHECK(seen[0] > 0 && seen[1] > 0 && seen[2] > 0 && (knows_more || seen[3] > 0));
    leafless_octree_free(octree);
}

/* The ball is known on frames of any depth, and answers are true. */
static void ball(void) {
    const leafless_frame frame = check_frame(20);
    static leafless_membership answers[POINTS];
    leafless_solid *solid = check_ball_solid();
    uint64_t undecided = 0, i;
    asked(solid, &frame, answers);
    for (i = 0; i < POINTS; i++) {
        const double *p = points[i];
        const double beyond = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) - 0.75;
        const bool in_universe = fabs(p[0]) <= 1 && fabs(p[1]) <= 1 && fabs(p[2]) <= 1;
        CHECK(answers[i] != LEAFLESS_MEMBERSHIP_INSIDE || (in_universe && beyond < 1e-12));
        CHECK(answers[i] != LEAFLESS_MEMBERSHIP_OUTSIDE || (in_universe && beyond > -1e-12));
        CHECK(in_universe || answers[i] == LEAFLESS_MEMBERSHIP_UNDECIDED);
        undecided += in_universe && answers[i] == LEAFLESS_MEMBERSHIP_UNDECIDED;
    }
    CHECK(undecided < 10);
    {
        const double odd[6][3] = {{NAN, 0, 0}, {0, INFINITY, 0}, {0, 0, -INFINITY}, {0, 0, 1.5}, {0, 0, 0}, {1e300, 0, 0}};
        leafless_membership of_odd[8];
        memset(of_odd, 0x5a, sizeof of_odd);
        OK(leafless_solid_contains_many(solid, &frame, odd[0], 6, NULL, of_odd));
        for (i = 0; i < 6; i++) {
            CHECK(of_odd[i] == (i == 4 ? LEAFLESS_MEMBERSHIP_INSIDE : LEAFLESS_MEMBERSHIP_UNDECIDED));
        }
        /* No more answers are written than points are given; without points, none. */
        CHECK(of_odd[6] == 0x5a);
        OK(leafless_solid_contains_many(solid, &frame, odd[0], 0, NULL, of_odd + 6));
        OK(leafless_solid_contains_many(solid, &frame, NULL, 0, NULL, NULL));
        CHECK(of_odd[6] == 0x5a);
    }
    leafless_solid_free(solid);
}

static leafless_region region_of(const leafless_solid *solid, uint64_t max_splits, double low, double high) {
    const leafless_frame frame = check_frame(12);
    const double min[3] = {low, low, low}, max[3] = {high, high, high};
    leafless_options options = threads(1);
    leafless_region region = 77;
    options.max_splits = max_splits;
    OK(leafless_solid_classify_box(solid, &frame, min, max, &options, &region));
    return region;
}

static void boxes(void) {
    leafless_solid *solid = check_ball_solid();
    uint64_t splits;
    CHECK(region_of(solid, 0, -0.4, 0.4) == LEAFLESS_REGION_INSIDE);
    CHECK(region_of(solid, 0, 0.45, 1.0) == LEAFLESS_REGION_OUTSIDE);
    CHECK(region_of(solid, 0, 0.4, 1.0) == LEAFLESS_REGION_CROSSING);
    CHECK(region_of(solid, 0, 0.1, 0.1) == LEAFLESS_REGION_INSIDE);
    CHECK(region_of(solid, 0, 0.43302, 0.43302) == LEAFLESS_REGION_UNDECIDED);
    CHECK(region_of(solid, 0, -INFINITY, INFINITY) == LEAFLESS_REGION_CROSSING);
    /* What is outside of the universe is not known. */
    CHECK(region_of(solid, 0, 0.9, 1.5) == LEAFLESS_REGION_UNDECIDED);
    CHECK(region_of(solid, 0, 1.5, 1.75) == LEAFLESS_REGION_UNDECIDED);
    /* Under a limit, the answer is undecided or right. */
    CHECK(region_of(solid, 1, -0.4, 0.4) == LEAFLESS_REGION_UNDECIDED);
    for (splits = 1; splits < 200; splits++) {
        const leafless_region inside = region_of(solid, splits, -0.4, 0.4);
        const leafless_region crossing = region_of(solid, splits, 0.4, 1.0);
        CHECK(inside == LEAFLESS_REGION_INSIDE || inside == LEAFLESS_REGION_UNDECIDED);
        CHECK(crossing == LEAFLESS_REGION_CROSSING || crossing == LEAFLESS_REGION_UNDECIDED);
    }
    CHECK(region_of(solid, 5000, -0.4, 0.4) == LEAFLESS_REGION_INSIDE);
    leafless_solid_free(solid);
}

/* One solid of a mesh on one frame after another, and back. */
static void mesh(void) {
    const leafless_frame frames[3] = {{{-1, -1, -1}, 2, 5}, {{-1, -1, -1}, 2, 4}, {{-0.9375, -1.25, -1}, 2.5, 5}};
    leafless_mesh *cube = check_cube(), *moved = NULL;
    leafless_solid *solid = NULL;
    const double middle[12] = {0.8, -0.6, 0, 0, 0.6, 0.8, 0, -0.5, 0, 0, 1, -0.4};
    size_t i;
    OK(leafless_mesh_transformed(cube, middle, &moved));
    OK(leafless_solid_from_mesh(moved, LEAFLESS_FILL_NON_ZERO, &solid));
    leafless_mesh_free(moved);
    leafless_mesh_free(cube);
    for (i = 0; i < 6; i++) {
        agrees(solid, &frames[i % 3], true);
    }
    leafless_solid_free(solid);
}

typedef struct host {
    uint64_t classified;
    uint64_t decided;
} host;

/* The half-space x <= 0.2. Its points are decided exactly. */
static int32_t half(void *ctx, const double *min, const double *max) {
    ((host *)ctx)->classified++;
    return max[0] <= 0.2 ? LEAFLESS_TAG_FULL : min[0] >= 0.2 ? LEAFLESS_TAG_EMPTY : LEAFLESS_TAG_PARTIAL;
}

static int32_t in_half(void *ctx, const double *at, uint64_t count, int32_t *inside) {
    uint64_t i;
    ((host *)ctx)->decided += count;
    for (i = 0; i < count; i++) {
        inside[i] = at[3 * i] <= 0.2;
    }
    return 0;
}

/* Points that the host decides are not sought among the cells. */
static void own_points(void) {
    const leafless_frame frame = check_frame(3);
    const leafless_options options = threads(1);
    static leafless_membership answers[POINTS];
    host h = {0, 0};
    leafless_solid_callbacks callbacks;
    leafless_solid *solid = NULL;
    uint64_t i;
    bool in_universe = false;
    OK(leafless_init(&callbacks, sizeof callbacks));
    callbacks.classify = half;
    callbacks.ctx = &h;
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    OK(leafless_solid_contains_many(solid, &frame, points[0], 1000, &options, answers));
    CHECK(h.classified > 1 && h.decided == 0);
    leafless_solid_free(solid);
    callbacks.contains_many = in_half;
    h.classified = 0;
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    OK(leafless_solid_contains_many(solid, &frame, points[0], POINTS, &options, answers));
    CHECK(h.classified < 10 && h.decided > POINTS / 2 && h.decided <= POINTS);
    for (i = 0; i < POINTS; i++) {
        const double *p = points[i];
        in_universe = fabs(p[0]) <= 1 && fabs(p[1]) <= 1 && fabs(p[2]) <= 1;
        CHECK(answers[i] == (!in_universe  ? LEAFLESS_MEMBERSHIP_UNDECIDED
                             : p[0] <= 0.2 ? LEAFLESS_MEMBERSHIP_INSIDE
                                           : LEAFLESS_MEMBERSHIP_OUTSIDE));
    }
    leafless_solid_free(solid);
}

static int32_t stop(void *ctx, double done) {
    (void)done;
    ++*(int *)ctx;
    return 1;
}

/* Whatever fails leaves the solid as good as ever. */
static void refusals(void) {
    const leafless_frame frame = check_frame(6);
    const double low[3] = {0.3, 0.3, 0.3}, high[3] = {0.5, 0.5, 0.5};
    static leafless_membership answers[POINTS];
    leafless_solid *solid = check_ball_solid();
    leafless_options options = threads(1);
    leafless_control *control = NULL;
    leafless_region region = 77;
    int calls = 0;
    OK(leafless_control_new(&control));
    OK(leafless_control_cancel(control));
    options.control = control;
    FAILS(LEAFLESS_E_CANCELLED, leafless_solid_contains_many(solid, &frame, points[0], POINTS, &options, answers));
    FAILS(LEAFLESS_E_CANCELLED, leafless_solid_classify_box(solid, &frame, low, high, &options, &region));
    OK(leafless_control_reset(control));
    options.progress = stop;
    options.progress_ctx = &calls;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_classify_box(solid, &frame, high, low, &options, &region));
    CHECK(calls == 0 && region == 77);
    options.progress = NULL;
    OK(leafless_solid_contains_many(solid, &frame, low, 1, &options, answers));
    CHECK(answers[0] == LEAFLESS_MEMBERSHIP_INSIDE);
    OK(leafless_solid_classify_box(solid, &frame, low, high, &options, &region));
    CHECK(region == LEAFLESS_REGION_CROSSING);
    leafless_control_free(control);
    leafless_solid_free(solid);
}

int main(void) {
    const leafless_frame frame = check_frame(5);
    leafless_solid *solid = check_ball_solid(), *stored = NULL;
    leafless_octree *octree = check_ball(5, LEAFLESS_RULE_CERTIFIED);
    size_t i;
    int axis;
    for (i = 0; i < POINTS; i++) {
        for (axis = 0; axis < 3; axis++) {
            points[i][axis] = 2.2 * fraction() - 1.1;
        }
    }
    agrees(solid, &frame, false);
    OK(leafless_solid_from_octree(octree, &stored));
    leafless_octree_free(octree);
    agrees(stored, &frame, false);
    leafless_solid_free(stored);
    leafless_solid_free(solid);
    ball();
    boxes();
    mesh();
    own_points();
    refusals();
    return 0;
}
