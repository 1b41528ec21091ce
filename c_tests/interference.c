/* Two solids, one of them under a map: overlap, distance, many placements at once. */
#include "check.h"

#include <math.h>

static const leafless_frame frame = {{0, 0, 0}, 128, 10};

static leafless_solid *ball(double at) {
    const double centre[3] = {at, at, at};
    leafless_solid *solid = NULL;
    OK(leafless_solid_new_ball(centre, 30, &solid));
    return solid;
}

static leafless_solid *moved(const leafless_solid *operand, double offset) {
    const double matrix[12] = {1, 0, 0, offset, 0, 1, 0, offset, 0, 0, 1, offset};
    leafless_solid *solid = NULL;
    OK(leafless_solid_transformed(operand, &frame, matrix, &solid));
    return solid;
}

/* The published pair of balls, by way of a map or not. */
static void two_balls(const leafless_solid *a, const leafless_solid *apart, const leafless_solid *over,
                      uint64_t most) {
    leafless_interference found;
    leafless_clearance near = LEAFLESS_INIT(leafless_clearance);
    leafless_gap gap = LEAFLESS_INIT(leafless_gap);
    double low[3], high[3];
    OK(leafless_solid_interfere(a, apart, &frame, INFINITY, NULL, &found));
    CHECK(found.verdict == LEAFLESS_OVERLAP_DISJOINT && !found.is_clipped && found.witness_level == 0);
    CHECK(found.volume_model.lower == 0 && found.volume_model.upper == 0);
    CHECK(found.splits_a + found.splits_b <= most);
    OK(leafless_solid_interfere(a, over, &frame, INFINITY, NULL, &found));
    CHECK(found.verdict == LEAFLESS_OVERLAP_OVERLAPPING && found.splits_a + found.splits_b <= most);
    CHECK(found.witness_level > 0 && found.witness_level <= found.level);
    CHECK(found.witness[0] < 1u << found.witness_level);
    OK(leafless_frame_cell_bounds(&frame, found.witness, found.witness_level, low, high));
    CHECK(high[0] - low[0] == ldexp(frame.edge, -(int)found.witness_level) && low[0] >= frame.origin[0]);
    CHECK(found.ball_radius_model > 0 && found.ball_centre_model[0] - found.ball_radius_model >= low[0]);
    CHECK(found.ball_centre_model[2] + found.ball_radius_model <= high[2]);
    CHECK(found.volume_model.lower > 0 && found.volume_model.upper > 374);
    OK(leafless_solid_interfere(a, over, &frame, 200, NULL, &found));
    CHECK(found.volume_model.lower < 375 && found.volume_model.upper > 374);
    CHECK(found.volume_model.upper - found.volume_model.lower <= 200);
    OK(leafless_solid_clearance(a, apart, &frame, 0.5, NULL, &near));
    CHECK(near.distance_model.lower < 2.35383 && near.distance_model.upper > 2.35382 && near.has_nearest);
    CHECK(near.distance_model.upper - near.distance_model.lower <= 0.5 && !near.is_clipped);
    CHECK(near.measured == LEAFLESS_STOP_REASON_TOLERANCE);
    CHECK(near.nearest_a[0] < 1u << near.nearest_a_level && near.nearest_b[0] < 1u << near.nearest_b_level);
    CHECK(near.point_a_model[0] < near.point_b_model[0] && near.point_b_model[0] - near.point_a_model[0] < 2.8);
    OK(leafless_solid_clearance(a, over, &frame, 0.5, NULL, &near));
    CHECK(near.distance_model.lower == 0);
    CHECK(near.depth_model >= 0 && (near.depth_model == 0 || near.point_a_model[0] == near.point_b_model[0]));
    /* Finer than the finest cells, with the points that are nearest. */
    OK(leafless_solid_clearance(a, apart, &frame, 1e-6, NULL, &near));
    CHECK(near.distance_model.upper < 2.8 && near.depth_model == 0);
    CHECK(near.point_a_model[0] < near.point_b_model[0] && near.point_b_model[0] - near.point_a_model[0] < 2.8);
    CHECK(near.distance_model.lower < 2.3539);
    /* Whether that is enough. */
    OK(leafless_solid_gap_at_least(a, apart, &frame, 1, NULL, &gap));
    CHECK(gap.verdict == LEAFLESS_GAP_VERDICT_YES && gap.distance_model.lower >= 1);
    OK(leafless_solid_gap_at_least(a, apart, &frame, 4, NULL, &gap));
    CHECK(gap.verdict == LEAFLESS_GAP_VERDICT_NO && gap.distance_model.upper < 4 && gap.has_points);
}

/* Many placements are as one after the other (expressions are moved exactly), for any number of threads. */
static void many(const leafless_solid *a, const leafless_solid *b) {
    double matrices[40][12];
    leafless_interference found[40], one;
    leafless_options options;
    size_t i;
    uint32_t threads;
    memset(matrices, 0, sizeof matrices);
    for (i = 0; i < 40; i++) {
        matrices[i][0] = matrices[i][5] = matrices[i][10] = 1;
        matrices[i][3] = 8.0 * (double)i - 160.0;
    }
    OK(leafless_init(&options, sizeof options));
    options.max_splits = 2000;
    for (threads = 1; threads <= 2; threads++) {
        options.threads = threads;
        OK(leafless_solid_interfere_many(a, b, &frame, matrices[0], 40, &frame, INFINITY, &options, found));
        for (i = 0; i < 40; i++) {
            leafless_solid *placed = NULL;
            OK(leafless_solid_placed(b, matrices[i], NULL, &placed));
            OK(leafless_solid_interfere(a, placed, &frame, INFINITY, &options, &one));
            CHECK(found[i].verdict == one.verdict && found[i].splits_b == one.splits_b);
            CHECK(found[i].volume_model.upper == one.volume_model.upper);
            CHECK(found[i].splits_a + found[i].splits_b <= 2000);
            /* Equal balls whose centres are moved apart along x. */
            CHECK(one.verdict != (fabs(matrices[i][3]) < 60 ? LEAFLESS_OVERLAP_DISJOINT : LEAFLESS_OVERLAP_OVERLAPPING));
            leafless_solid_free(placed);
        }
    }
    OK(leafless_solid_interfere_many(a, b, &frame, NULL, 0, &frame, INFINITY, &options, NULL));
    for (threads = 1; threads <= 2; threads++) {
        leafless_placed_clearance near[4];
        options.threads = threads;
        OK(leafless_solid_clearance_many(a, b, &frame, matrices[30], 4, &frame, 1, &options, near));
        for (i = 0; i < 4; i++) {
            leafless_clearance single = LEAFLESS_INIT(leafless_clearance);
            leafless_solid *placed = NULL;
            OK(leafless_solid_placed(b, matrices[30 + i], NULL, &placed));
            OK(leafless_solid_clearance(a, placed, &frame, 1, &options, &single));
            CHECK(near[i].distance_model.upper == single.distance_model.upper && near[i].splits_b == single.splits_b);
            leafless_solid_free(placed);
        }
    }
    OK(leafless_solid_clearance_many(a, b, &frame, NULL, 0, &frame, 1, &options, NULL));
    for (threads = 1; threads <= 2; threads++) {
        leafless_placed_gap gaps[4];
        options.threads = threads;
        OK(leafless_solid_gap_at_least_many(a, b, &frame, matrices[28], 4, &frame, 4, &options, gaps));
        for (i = 0; i < 4; i++) {
            /* Equal balls of radius 30, whose centres are 64, 72, 80 and 88 apart. */
            const double apart = matrices[28 + i][3] - 60;
            CHECK(gaps[i].verdict != LEAFLESS_GAP_VERDICT_NO);
            CHECK(gaps[i].distance_model.lower <= apart);
            CHECK(!gaps[i].has_points || apart <= gaps[i].distance_model.upper);
        }
    }
    OK(leafless_solid_gap_at_least_many(a, b, &frame, NULL, 0, &frame, 1, &options, NULL));
}

/* Two balls around one centre, and a ball beside itself. */
static void boundaries(const leafless_solid *a, const leafless_solid *other) {
    const double centre[3] = {50, 50, 50};
    leafless_solid *larger = NULL;
    leafless_deviation apart = LEAFLESS_INIT(leafless_deviation);
    const double root = sqrt(3.0);
    OK(leafless_solid_new_ball(centre, 34, &larger));
    OK(leafless_solid_deviation(a, larger, &frame, 0.5, 5, NULL, &apart));
    CHECK(apart.distance_model.lower <= 4 && apart.distance_model.upper >= 4 && apart.verdict == LEAFLESS_WITHIN_YES);
    CHECK(apart.a_to_b.distance_model.upper - apart.a_to_b.distance_model.lower <= 0.5);
    CHECK(apart.b_to_a.has_witness && apart.b_to_a.apart_model < 0.5 && !apart.is_clipped_a && !apart.is_clipped_b);
    CHECK(apart.measured == LEAFLESS_STOP_REASON_TOLERANCE && apart.splits_a > 0 && apart.proof_a.full);
    /* 36 along the diagonal. */
    OK(leafless_solid_deviation(a, other, &frame, 0.5, 60, NULL, &apart));
    CHECK(apart.distance_model.lower <= 36 * root && apart.distance_model.upper >= 36 * root);
    CHECK(apart.verdict == LEAFLESS_WITHIN_NO);
    OK(leafless_solid_deviation(a, other, &frame, 0.5, NAN, NULL, &apart));
    CHECK(apart.verdict == LEAFLESS_WITHIN_UNDECIDED);
    OK(leafless_solid_deviation(a, a, &frame, 0, 0, NULL, &apart));
    CHECK(apart.distance_model.upper == 0 && apart.verdict == LEAFLESS_WITHIN_YES);
    CHECK(leafless_solid_deviation(a, a, &frame, NAN, 0, NULL, &apart) == LEAFLESS_E_ARGUMENT);
    leafless_solid_free(larger);
}

static void refusals(const leafless_solid *a) {
    const double singular[12] = {1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0};
    leafless_solid *never = NULL;
    leafless_interference found;
    leafless_clearance near = LEAFLESS_INIT(leafless_clearance);
    leafless_frame other = frame;
    leafless_octree *octree = NULL;
    leafless_solid *stored = NULL, *placed = NULL;
    CHECK(leafless_solid_transformed(a, &frame, singular, &never) == LEAFLESS_E_ARGUMENT && never == NULL);
    CHECK(leafless_solid_interfere_many(a, a, &frame, singular, 1, &frame, 0, NULL, &found) == LEAFLESS_E_ARGUMENT);
    CHECK(leafless_solid_interfere(a, a, &frame, NAN, NULL, &found) == LEAFLESS_E_ARGUMENT);
    CHECK(leafless_solid_clearance(a, a, &frame, NAN, NULL, &near) == LEAFLESS_E_ARGUMENT);
    other.depth = 0;
    CHECK(leafless_solid_transformed(a, &other, singular, &never) == LEAFLESS_E_ARGUMENT);
    /* A stored octree is known on its own universe only. */
    other.depth = 6;
    OK(leafless_octree_build(a, &other, LEAFLESS_RULE_CERTIFIED, NULL, &octree));
    OK(leafless_solid_from_octree(octree, &stored));
    other.edge = 256;
    CHECK(leafless_solid_interfere(stored, a, &other, 0, NULL, &found) == LEAFLESS_E_FRAME);
    placed = moved(stored, 1);
    OK(leafless_solid_interfere(a, placed, &other, INFINITY, NULL, &found));
    CHECK(found.verdict == LEAFLESS_OVERLAP_OVERLAPPING);
    leafless_solid_free(placed);
    leafless_solid_free(stored);
    leafless_octree_free(octree);
}

int main(void) {
    leafless_solid *a = ball(50), *apart = ball(86), *over = ball(83);
    leafless_solid *moved_apart = moved(a, 36), *moved_over = moved(a, 33);
    two_balls(a, apart, over, 80);
    /* The maps are offsets of whole finest cells: nothing blurs there, but larger cells of the two do not coincide. */
    two_balls(a, moved_apart, moved_over, 400);
    many(a, a);
    boundaries(a, apart);
    refusals(a);
    leafless_solid_free(moved_over);
    leafless_solid_free(moved_apart);
    leafless_solid_free(over);
    leafless_solid_free(apart);
    leafless_solid_free(a);
    return 0;
}
