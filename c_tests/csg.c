/* Constructive solid geometry: primitives, their combinations and placements, and refused calls. */
#include "check.h"

static const leafless_frame frame = {{-2, -2, -2}, 4, 6};
static const double origin[3] = {0, 0, 0};

static leafless_statistics statistics_of(const leafless_solid *solid, uint32_t rule) {
    leafless_octree *octree = NULL;
    leafless_statistics statistics;
    OK(leafless_octree_build(solid, &frame, rule, NULL, &octree));
    OK(leafless_octree_statistics(octree, &statistics));
    leafless_octree_free(octree);
    return statistics;
}

/* The certified volume contains the truth and is not idle. */
static void has_volume(leafless_solid *solid, double truth) {
    const leafless_statistics found = statistics_of(solid, LEAFLESS_RULE_CERTIFIED);
    CHECK(found.volume_model.lower <= truth && truth <= found.volume_model.upper);
    CHECK(found.volume_model.upper - found.volume_model.lower < 4.0);
    leafless_solid_free(solid);
}

static leafless_solid *ball(double radius) {
    leafless_solid *solid = NULL;
    OK(leafless_solid_new_ball(origin, radius, &solid));
    return solid;
}

/* z <= x y, which over a box is least and greatest at corners; on this frame nothing is rounded. */
static int32_t saddle_value(void *ctx, const double *p, double *value) {
    ++*(int *)ctx;
    *value = p[0] * p[1] - p[2];
    return 0;
}

static int32_t saddle_range(void *ctx, const double *min, const double *max, leafless_interval *range) {
    const double xy[4] = {min[0] * min[1], min[0] * max[1], max[0] * min[1], max[0] * max[1]};
    double least = xy[0], most = xy[0];
    int i;
    ++*(int *)ctx;
    for (i = 1; i < 4; i++) {
        least = xy[i] < least ? xy[i] : least;
        most = xy[i] > most ? xy[i] : most;
    }
    range->lower = least - max[2];
    range->upper = most - min[2];
    return 0;
}

static int32_t failing_range(void *ctx, const double *min, const double *max, leafless_interval *range) {
    (void)ctx, (void)min, (void)max, (void)range;
    return -42;
}

static int32_t constant_range(void *ctx, const double *min, const double *max, leafless_interval *range) {
    (void)min, (void)max;
    *range = *(const leafless_interval *)ctx;
    return 0;
}

static int32_t constant_value(void *ctx, const double *p, double *value) {
    (void)p;
    *value = ((const leafless_interval *)ctx)->lower > 0 ? 1 : -1;
    return 0;
}

static void gone(void *ctx) {
    *(int *)ctx = -1;
}

/* Bounds the wrong way round, or that are not numbers, say nothing: no cell is decided by them. */
static void ranges_that_say_nothing(void) {
    const leafless_frame small = {{-2, -2, -2}, 4, 2};
    const leafless_interval nothing[] = {{1, -1},    {-1, -2},   {2, 1},      {NAN, 1},  {NAN, -1},
                                         {1, NAN},   {-1, NAN},  {NAN, NAN},  {INFINITY, -INFINITY}},
                            all_inside = {1, INFINITY}, all_outside = {-INFINITY, -1}, open = {-1, INFINITY};
    leafless_solid_function function;
    size_t i;
    OK(leafless_init(&function, sizeof function));
    function.value = constant_value;
    function.range = constant_range;
    for (i = 0; i < COUNT(nothing) + 3; i++) {
        leafless_interval said = i < COUNT(nothing) ? nothing[i] : i == COUNT(nothing) ? open
                               : i == COUNT(nothing) + 1 ? all_inside : all_outside;
        leafless_solid *solid = NULL;
        leafless_octree *octree = NULL;
        leafless_statistics statistics;
        function.ctx = &said;
        OK(leafless_solid_new_function(&function, &solid));
        OK(leafless_octree_build(solid, &small, LEAFLESS_RULE_CERTIFIED, NULL, &octree));
        OK(leafless_octree_statistics(octree, &statistics));
        CHECK(statistics.volume_model.lower == (i == COUNT(nothing) + 1 ? 64 : 0));
        CHECK(statistics.volume_model.upper == (i == COUNT(nothing) + 2 ? 0 : 64));
        leafless_octree_free(octree);
        leafless_solid_free(solid);
    }
}

static void functions(void) {
    const double low[3] = {-1, -1, -1}, high[3] = {1, 1, 1};
    int calls = 0;
    leafless_solid_function function;
    leafless_solid *a = NULL, *b = NULL, *c = NULL;
    const leafless_solid *parts[2];
    leafless_octree *octree = NULL;
    char message[512];
    OK(leafless_init(&function, sizeof function));
    function.value = saddle_value;
    function.range = saddle_range;
    function.destroy = gone;
    function.ctx = &calls;
    OK(leafless_solid_new_function(&function, &a));
    OK(leafless_solid_new_box(low, high, &b));
    parts[0] = a, parts[1] = b;
    OK(leafless_solid_combine(LEAFLESS_OPERATION_INTERSECTION, parts, 2, &c));
    leafless_solid_free(b);
    CHECK(statistics_of(c, LEAFLESS_RULE_SAMPLED).partial == 0);
    has_volume(c, 4);
    CHECK(calls > 1000);
    leafless_solid_free(a);
    CHECK(calls == -1);
    function.range = failing_range;
    OK(leafless_solid_new_function(&function, &a));
    FAILS(LEAFLESS_E_CALLBACK, leafless_octree_build(a, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &octree));
    leafless_last_error(message, sizeof message);
    CHECK(strstr(message, "-42") != NULL);
    leafless_solid_free(a);
}

/* Whether a point is proven to lie inside. */
static bool contains(const leafless_solid *solid, double x, double y, double z) {
    const leafless_frame around = {{-4, -4, -4}, 8, 12};
    const double point[3] = {x, y, z};
    leafless_membership membership = LEAFLESS_MEMBERSHIP_UNDECIDED;
    OK(leafless_solid_contains_many(solid, &around, point, 1, NULL, &membership));
    CHECK(membership != LEAFLESS_MEMBERSHIP_UNDECIDED);
    return membership == LEAFLESS_MEMBERSHIP_INSIDE;
}

static void other_primitives(void) {
    const double up[3] = {0, 0, 2}, aside[3] = {0.5, 0.25, 0}, slanted[3] = {0.5, 1, 0.25};
    /* A quarter turn around z: x to y. */
    const double turned[12] = {0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0}, singular[12] = {0};
    const double pi = 3.14159265358979323846;
    const double weights[3] = {-1, -1, -1}, centre[3] = {0, 0, 0}, size[3] = {1, 1.5, 0.5};
    const uint32_t exponents[3] = {4, 4, 4}, too_high[3] = {4, 65, 4};
    /* An L, clockwise. */
    const double polygon[6][2] = {{0, 0}, {0, 2}, {1, 2}, {1, 1}, {2, 1}, {2, 0}};
    const double crossing[4][2] = {{0, 0}, {1, 1}, {1, 0}, {0, 1}};
    /* The octahedron |x| + |y| + |z| <= 1. */
    double planes[8][4];
    leafless_solid *a = NULL;
    int i;
    OK(leafless_solid_new_power(weights, centre, exponents, 1, &a));
    /* 8 gamma(5/4)^3 / gamma(7/4) */
    has_volume(a, 6.48200);
    OK(leafless_solid_new_torus(centre, up, 1.25, 0.5, &a));
    has_volume(a, 2 * pi * pi * 1.25 * 0.25);
    OK(leafless_solid_new_torus(aside, slanted, 0.75, 0.25, &a));
    CHECK(contains(a, 0.5 + 0.75 * 2 / sqrt(5), 0.25 - 0.75 / sqrt(5), 0) && !contains(a, 0.5, 0.25, 0));
    CHECK(!contains(a, 0.5 + 0.3, 0.25 + 0.6, 0.15));
    has_volume(a, 2 * pi * pi * 0.75 * 0.0625);
    OK(leafless_solid_new_wedge(size, 0.25, NULL, &a));
    has_volume(a, 0.5 * 1.5 * (1 + 0.25) / 2);
    OK(leafless_solid_new_wedge(size, 0.25, turned, &a));
    CHECK(contains(a, -1.4, 0.2, 0.25) && !contains(a, -1.4, 0.9, 0.25) && contains(a, -0.1, 0.9, 0.25));
    has_volume(a, 0.5 * 1.5 * (1 + 0.25) / 2);
    OK(leafless_solid_new_prism(&polygon[0][0], 6, -1, 1, NULL, &a));
    has_volume(a, 6);
    OK(leafless_solid_new_prism(&polygon[0][0], 6, -1, 1, turned, &a));
    CHECK(contains(a, -1.5, 0.5, 0) && contains(a, -0.5, 1.5, 0) && !contains(a, -1.5, 1.5, 0));
    has_volume(a, 6);
    OK(leafless_solid_new_ellipsoid(aside, size, turned, &a));
    CHECK(contains(a, -0.25 - 1.4, 0.5, 0) && !contains(a, -0.25, 0.5 + 1.1, 0) && contains(a, -0.25, 0.5 + 0.9, 0));
    has_volume(a, 4.0 / 3.0 * pi * 0.75);
    for (i = 0; i < 8; i++) {
        planes[i][0] = i & 1 ? 1 : -1, planes[i][1] = i & 2 ? 1 : -1, planes[i][2] = i & 4 ? 1 : -1;
        planes[i][3] = 1;
    }
    OK(leafless_solid_new_convex(&planes[0][0], 8, &a));
    has_volume(a, 4.0 / 3.0);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_power(weights, centre, too_high, 1, &a));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_power(centre, centre, exponents, 1, &a));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_torus(centre, up, 1, 0, &a));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_torus(centre, centre, 1, 0.5, &a));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_wedge(size, 0.25, singular, &a));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_wedge(size, -1, NULL, &a));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_prism(&crossing[0][0], 4, 0, 1, NULL, &a));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_prism(&polygon[0][0], 2, 0, 1, NULL, &a));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_prism(&polygon[0][0], 6, 1, 0, NULL, &a));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_convex(NULL, 0, &a));
}

static leafless_solid *placed(const leafless_solid *operand, const double *matrix, leafless_motion expected) {
    leafless_solid *solid = NULL;
    leafless_motion motion = 77;
    OK(leafless_solid_placed(operand, matrix, &motion, &solid));
    CHECK(motion == expected);
    return solid;
}

/* The inner and outer bounds of a solid's volume have one value. */
static void has_exactly(leafless_solid *solid, double truth) {
    const leafless_statistics found = statistics_of(solid, LEAFLESS_RULE_CERTIFIED);
    CHECK(found.volume_model.lower == truth && found.volume_model.upper == truth);
    leafless_solid_free(solid);
}

static leafless_solid *joined(uint32_t operation, const leafless_solid *a, const leafless_solid *b) {
    leafless_solid *solid = NULL;
    OK(check_solids(operation, a, b, &solid));
    return solid;
}

/* The reported motions of a solid of each kind, and of all of them in one; and their places afterwards. */
static void motions(void) {
    /* A quarter turn about x, half the size, and an offset of whole cells. */
    const double exact[12] = {0.5, 0, 0, 0.25, 0, 0, -0.5, 0.5, 0, 0.5, 0, -0.75};
    /* Rotated by the angle with cosine 0.8, half the size, moved. */
    const double turn[12] = {0.4, -0.3, 0, 0.2, 0.3, 0.4, 0, -0.1, 0, 0, 0.5, 0.3};
    const double low[3] = {-1, -1, -1}, high[3] = {1, 1, 1}, above[3] = {0.25, 0.25, 0.55};
    const double outside[3] = {-1.5, 1.5, 1.5};
    const double ends[2][3] = {{-1.5, -0.5, -0.5}, {-1.25, 0.5, 0.5}};
    leafless_mesh *mesh = check_cube();
    leafless_octree *octree = NULL, *direct = NULL, *moved = NULL;
    leafless_solid *box = NULL, *end = NULL, *meshed = NULL, *stored = NULL, *two = NULL, *all = NULL, *not_all = NULL;
    leafless_solid *a = NULL, *b = NULL;
    leafless_membership answers[2];
    OK(leafless_solid_new_box(low, high, &box));
    OK(leafless_solid_new_box(ends[0], ends[1], &end));
    OK(leafless_solid_from_mesh(mesh, LEAFLESS_FILL_NON_ZERO, &meshed));
    leafless_mesh_free(mesh);
    OK(leafless_octree_build(end, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &octree));
    OK(leafless_solid_from_octree(octree, &stored));
    leafless_octree_free(octree);

    /* Where no number is rounded and cells are the images of cells, each is moved without loss. */
    has_exactly(placed(box, exact, LEAFLESS_MOTION_EXACT), 1);
    has_volume(placed(meshed, exact, LEAFLESS_MOTION_VERTICES), 0.125);
    has_exactly(placed(stored, exact, LEAFLESS_MOTION_CONSERVATIVE), 0.25 / 8);
    a = placed(stored, exact, LEAFLESS_MOTION_CONSERVATIVE);
    b = placed(end, exact, LEAFLESS_MOTION_EXACT);
    OK(leafless_octree_build(a, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &moved));
    OK(leafless_octree_build(b, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &direct));
    CHECK(check_same(moved, direct));
    leafless_octree_free(moved);
    leafless_octree_free(direct);
    leafless_solid_free(a);
    leafless_solid_free(b);
    /* The moved mesh is the cube [0, 1]^3 under the map. */
    {
        const double cube_low[3] = {0.25, 0, -0.75}, cube_high[3] = {0.75, 0.5, -0.25};
        a = placed(meshed, exact, LEAFLESS_MOTION_VERTICES);
        OK(leafless_solid_new_box(cube_low, cube_high, &b));
        OK(leafless_octree_build(a, &frame, LEAFLESS_RULE_SAMPLED, NULL, &moved));
        OK(leafless_octree_build(b, &frame, LEAFLESS_RULE_SAMPLED, NULL, &direct));
        CHECK(check_same(moved, direct));
        leafless_octree_free(moved);
        leafless_octree_free(direct);
        leafless_solid_free(b);
        /* Moved again it is a mesh still. */
        has_volume(placed(a, turn, LEAFLESS_MOTION_VERTICES), 1.0 / 64);
        leafless_solid_free(a);
    }

    /* The worst of all parts is reported, in every combination. */
    two = joined(LEAFLESS_OPERATION_UNION, box, meshed);
    all = joined(LEAFLESS_OPERATION_UNION, two, stored);
    OK(leafless_solid_complement(all, &not_all));
    has_volume(placed(box, turn, LEAFLESS_MOTION_EXACT), 1);
    has_volume(placed(meshed, turn, LEAFLESS_MOTION_VERTICES), 0.125);
    has_volume(placed(stored, turn, LEAFLESS_MOTION_CONSERVATIVE), 0.25 / 8);
    has_volume(placed(two, turn, LEAFLESS_MOTION_VERTICES), 1);
    has_volume(placed(all, turn, LEAFLESS_MOTION_CONSERVATIVE), 1 + 0.25 / 8);
    a = placed(not_all, turn, LEAFLESS_MOTION_CONSERVATIVE);
    b = placed(a, exact, LEAFLESS_MOTION_CONSERVATIVE);
    OK(leafless_solid_contains_many(a, &frame, above, 1, NULL, answers));
    OK(leafless_solid_contains_many(a, &frame, outside, 1, NULL, answers + 1));
    CHECK(answers[0] == LEAFLESS_MEMBERSHIP_OUTSIDE && answers[1] == LEAFLESS_MEMBERSHIP_INSIDE);
    leafless_solid_free(b);
    leafless_solid_free(a);
    /* Nobody has to hear of it. */
    OK(leafless_solid_placed(all, turn, NULL, &a));
    leafless_solid_free(all);
    leafless_solid_free(two);
    has_volume(a, 1 + 0.25 / 8);
    leafless_solid_free(not_all);
    leafless_solid_free(stored);
    leafless_solid_free(meshed);
    leafless_solid_free(end);
    leafless_solid_free(box);
}

static uint64_t evaluations_of(const leafless_solid *solid) {
    leafless_solid_info info = LEAFLESS_INIT(leafless_solid_info);
    OK(leafless_solid_describe(solid, &info));
    return info.evaluations;
}

static void build_alone(const leafless_solid *solid) {
    leafless_options options;
    leafless_octree *octree = NULL;
    OK(leafless_init(&options, sizeof options));
    options.threads = 1;
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &octree));
    leafless_octree_free(octree);
}

/* Each expression counts only its own evaluations. */
static void evaluations(void) {
    const double low[3] = {-1, -1, -1}, high[3] = {1, 1, 1}, at[3] = {0.3, 0.2, 0.95};
    leafless_solid *box = NULL, *round = ball(1.125), *both, *again, *other = NULL, *reference = NULL;
    leafless_mesh *mesh = check_cube();
    leafless_octree *octree = NULL;
    leafless_membership answer;
    leafless_region region;
    leafless_interference overlap;
    leafless_measures measures = LEAFLESS_INIT(leafless_measures);
    uint64_t built, asked;
    OK(leafless_solid_new_box(low, high, &box));
    both = joined(LEAFLESS_OPERATION_INTERSECTION, box, round);
    again = joined(LEAFLESS_OPERATION_INTERSECTION, box, round);
    CHECK(evaluations_of(both) == 0 && evaluations_of(box) == 0);
    build_alone(both);
    built = evaluations_of(both);
    CHECK(built > 1000 && evaluations_of(box) == 0 && evaluations_of(round) == 0 && evaluations_of(again) == 0);
    /* The same work is the same count; on the same frame a second time, at most that. */
    build_alone(again);
    CHECK(evaluations_of(again) == built);
    build_alone(both);
    asked = evaluations_of(both);
    CHECK(asked > built && asked <= 2 * built);
    /* References are one solid. */
    OK(leafless_solid_ref(both, &reference));
    OK(leafless_solid_contains_many(reference, &frame, at, 1, NULL, &answer));
    CHECK(answer == LEAFLESS_MEMBERSHIP_INSIDE && evaluations_of(both) > asked);
    CHECK(evaluations_of(both) - asked < 1000 && evaluations_of(reference) == evaluations_of(both));
    leafless_solid_free(reference);
    asked = evaluations_of(both);
    OK(leafless_solid_classify_box(both, &frame, low, at, NULL, &region));
    CHECK(region == LEAFLESS_REGION_CROSSING && evaluations_of(both) > asked);
    asked = evaluations_of(both);
    OK(leafless_solid_measure(both, &frame, 0.1, 0.0, NULL, &measures));
    CHECK(evaluations_of(both) > asked);
    asked = evaluations_of(both);
    OK(leafless_solid_interfere(both, round, &frame, 0, NULL, &overlap));
    CHECK(evaluations_of(both) > asked && evaluations_of(round) > 0 && evaluations_of(box) == 0);
    /* What is moved, joined or taken for a part counts for itself. */
    asked = evaluations_of(both);
    OK(leafless_solid_complement(both, &other));
    (void)statistics_of(other, LEAFLESS_RULE_CERTIFIED);
    CHECK(evaluations_of(both) == asked && evaluations_of(other) > 1000);
    leafless_solid_free(other);

    /* Solids of other kinds have none to count. */
    OK(leafless_solid_from_mesh(mesh, LEAFLESS_FILL_NON_ZERO, &other));
    (void)statistics_of(other, LEAFLESS_RULE_CERTIFIED);
    CHECK(evaluations_of(other) == 0);
    leafless_solid_free(other);
    OK(leafless_octree_build(both, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &octree));
    OK(leafless_solid_from_octree(octree, &other));
    asked = evaluations_of(both);
    (void)statistics_of(other, LEAFLESS_RULE_CERTIFIED);
    CHECK(evaluations_of(other) == 0 && evaluations_of(both) == asked);
    leafless_solid_free(other);
    leafless_octree_free(octree);
    leafless_mesh_free(mesh);
    leafless_solid_free(again);
    leafless_solid_free(both);
    leafless_solid_free(round);
    leafless_solid_free(box);
}

/* Both have one octree; the first is freed. */
static void same_octrees(leafless_solid *solid, const leafless_solid *other) {
    leafless_octree *a = NULL, *b = NULL;
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_SAMPLED, NULL, &a));
    OK(leafless_octree_build(other, &frame, LEAFLESS_RULE_SAMPLED, NULL, &b));
    CHECK(check_same(a, b));
    leafless_octree_free(a);
    leafless_octree_free(b);
    leafless_solid_free(solid);
}

/* No solid, one, and three; and invalid operations. */
static void other_numbers(void) {
    const double low[3] = {-1, -1, -1}, high[3] = {1, 1, 1}, slab[3] = {0.5, -2, -2}, end[3] = {2, 2, 2};
    const double of_none[4] = {0, 64, -1, 0};
    leafless_solid *box = NULL, *round = ball(1.125), *side = NULL, *solid = NULL, *two, *three;
    const leafless_solid *parts[3];
    uint32_t operation;
    OK(leafless_solid_new_box(low, high, &box));
    OK(leafless_solid_new_box(slab, end, &side));
    parts[0] = box, parts[1] = round, parts[2] = side;
    for (operation = 0; operation < 4; operation++) {
        if (operation == LEAFLESS_OPERATION_DIFFERENCE) {
            FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_combine(operation, NULL, 0, &solid));
            FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_combine(operation, parts, 0, &solid));
            CHECK(solid == NULL);
        } else {
            leafless_statistics found;
            OK(leafless_solid_combine(operation, NULL, 0, &solid));
            found = statistics_of(solid, LEAFLESS_RULE_CERTIFIED);
            CHECK(found.volume_model.lower == of_none[operation] && found.volume_model.upper == of_none[operation]);
            leafless_solid_free(solid);
        }
        OK(leafless_solid_combine(operation, parts, 1, &solid));
        same_octrees(solid, box);
        /* Three solids, one after the other. */
        OK(leafless_solid_combine(operation, parts, 3, &solid));
        two = joined(operation, box, round);
        three = joined(operation, two, side);
        same_octrees(solid, three);
        leafless_solid_free(three);
        leafless_solid_free(two);
        solid = NULL;
    }
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_combine(4, parts, 2, &solid));
    CHECK(solid == NULL);
    /* The first less the union of the others. */
    OK(leafless_solid_combine(LEAFLESS_OPERATION_DIFFERENCE, parts, 3, &solid));
    two = joined(LEAFLESS_OPERATION_UNION, round, side);
    three = joined(LEAFLESS_OPERATION_DIFFERENCE, box, two);
    same_octrees(solid, three);
    leafless_solid_free(three);
    leafless_solid_free(two);
    leafless_solid_free(side);
    leafless_solid_free(round);
    leafless_solid_free(box);
}

int main(void) {
    const double pi = 3.14159265358979323846;
    const double low[3] = {-1, -1, -1}, high[3] = {1, 1, 1}, radii[3] = {1, 1.5, 0.5};
    /* 1 - x^2 - y^2 - z^2 + xy, an ellipsoid: det of the form is 3/4. */
    const double quadric[10] = {-1, -1, -1, 1, 0, 0, 0, 0, 0, 1};
    /* Half the size, rotated about z, moved. */
    const double matrix[12] = {0.4, -0.3, 0, 0.2, 0.3, 0.4, 0, -0.1, 0, 0, 0.5, 0.3};
    const double singular[12] = {1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0};
    const double from[3] = {0, 0, -1}, to[3] = {0, 0, 1.5}, up[3] = {0, 0, 1};
    const double tip[3] = {0.5, -1, 1}, tail[3] = {-0.5, 1, -1};
    leafless_solid *a = NULL, *b = NULL, *c = NULL, *deep = NULL;
    const leafless_solid *parts[3];
    leafless_statistics exact, paper;
    int i;

    functions();
    ranges_that_say_nothing();
    other_primitives();
    motions();
    evaluations();
    other_numbers();
    OK(leafless_solid_new_quadric(quadric, &a));
    has_volume(a, 4.0 / 3.0 * pi / sqrt(0.75));
    OK(leafless_solid_new_ellipsoid(origin, radii, NULL, &a));
    has_volume(a, 4.0 / 3.0 * pi * 0.75);
    OK(leafless_solid_new_cylinder(from, to, 1, &a));
    has_volume(a, pi * 2.5);
    OK(leafless_solid_new_frustum(from, up, 1.5, 0.5, &a));
    has_volume(a, 2.0 / 3.0 * pi * (2.25 + 0.75 + 0.25));
    OK(leafless_solid_new_frustum(to, origin, 1, 0, &a));
    has_volume(a, pi * 0.5);
    /* Axes of any direction: these have the lengths 1.5 and 3. */
    OK(leafless_solid_new_cylinder(tip, origin, 0.75, &a));
    has_volume(a, pi * 0.75 * 0.75 * 1.5);
    OK(leafless_solid_new_frustum(tip, tail, 0.5, 0.25, &a));
    has_volume(a, pi * (0.25 + 0.125 + 0.0625));

    /* A box minus a ball, and the like; the operands are freed at once. */
    OK(leafless_solid_new_box(low, high, &a));
    b = ball(1);
    OK(check_solids(LEAFLESS_OPERATION_DIFFERENCE, a, b, &c));
    has_volume(c, 8 - 4.0 / 3.0 * pi);
    parts[0] = a, parts[1] = b, parts[2] = a;
    OK(leafless_solid_combine(LEAFLESS_OPERATION_UNION, parts, 3, &c));
    has_volume(c, 8);
    OK(leafless_solid_combine(LEAFLESS_OPERATION_INTERSECTION, parts, 2, &c));
    has_volume(c, 4.0 / 3.0 * pi);
    OK(leafless_solid_combine(LEAFLESS_OPERATION_XOR, parts, 2, &c));
    has_volume(c, 8 - 4.0 / 3.0 * pi);
    OK(leafless_solid_complement(b, &c));
    leafless_solid_free(b);
    parts[1] = c;
    OK(leafless_solid_combine(LEAFLESS_OPERATION_INTERSECTION, parts, 2, &b));
    leafless_solid_free(c);
    OK(leafless_solid_placed(b, matrix, NULL, &c));
    leafless_solid_free(b);
    has_volume(c, (8 - 4.0 / 3.0 * pi) / 8);

    /* Solids of any kind join, and are placed together. */
    {
        leafless_octree *octree = NULL;
        OK(leafless_octree_build(a, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &octree));
        OK(leafless_solid_from_octree(octree, &b));
        leafless_octree_free(octree);
        c = ball(1);
        OK(check_solids(LEAFLESS_OPERATION_DIFFERENCE, b, c, &deep));
        leafless_solid_free(c);
        leafless_solid_free(b);
        b = placed(deep, matrix, LEAFLESS_MOTION_CONSERVATIVE);
        has_volume(deep, 8 - 4.0 / 3.0 * pi);
        has_volume(b, (8 - 4.0 / 3.0 * pi) / 8);
    }

    /* A chain of a hundred thousand is freed and built without recursion. */
    deep = ball(1);
    for (i = 0; i < 100000; i++) {
        OK(leafless_solid_complement(deep, &b));
        leafless_solid_free(deep);
        deep = b;
    }
    has_volume(deep, 4.0 / 3.0 * pi);
    /* What doubles again and again has a limit. */
    deep = ball(1);
    for (i = 0; i < 60; i++) {
        parts[0] = parts[1] = deep;
        OK(leafless_solid_combine(LEAFLESS_OPERATION_UNION, parts, 2, &b));
        leafless_solid_free(deep);
        deep = b;
    }
    {
        leafless_octree *octree = NULL;
        FAILS(LEAFLESS_E_LIMIT, leafless_octree_build(deep, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &octree));
    }
    leafless_solid_free(deep);

    /* The published rule counts cells that only touch. */
    b = ball(1);
    OK(leafless_solid_with_touch(b, LEAFLESS_TOUCH_PAPER, &c));
    exact = statistics_of(b, LEAFLESS_RULE_CERTIFIED);
    paper = statistics_of(c, LEAFLESS_RULE_CERTIFIED);
    CHECK(exact.lower_cells == paper.lower_cells && exact.upper_cells < paper.upper_cells);
    CHECK(statistics_of(b, LEAFLESS_RULE_SAMPLED).partial == 0);
    leafless_solid_free(c);

    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_placed(b, singular, NULL, &c));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_cylinder(from, to, 0, &c));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_cylinder(to, to, 1, &c));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_cylinder(from, to, NAN, &c));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_frustum(from, to, 0, 0, &c));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_frustum(from, to, -1, 1, &c));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_ellipsoid(origin, origin, NULL, &c));
    {
        const double constant[10] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
        FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_quadric(constant, &c));
    }
    leafless_solid_free(b);
    leafless_solid_free(a);
    return 0;
}
