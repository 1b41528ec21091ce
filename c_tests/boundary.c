/* What a point query costs through the C interface: one by one, in a batch, and with a cursor along lines.
 *
 *     ./boundary [POINTS]
 *
 * include/README.md tells how to build it: gcc -O2 c_tests/boundary.c -Iinclude target/release/libleafless.a ...
 * benches/boundary.rs measures the same ball and points from Rust. */
#define _POSIX_C_SOURCE 200809L
#include "check.h"

#include <time.h>

static double now(void) {
    struct timespec time;
    CHECK(clock_gettime(CLOCK_MONOTONIC, &time) == 0);
    return (double)time.tv_sec * 1e9 + (double)time.tv_nsec;
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

enum { ROUNDS = 11 };

static void report(const char *name, double *times, size_t points) {
    qsort(times, ROUNDS, sizeof times[0], ascending);
    printf("%-12s %8.2f ns a point\n", name, times[ROUNDS / 2] / (double)points);
}

int main(int argc, char **argv) {
    const size_t count = argc > 1 ? (size_t)strtoul(argv[1], NULL, 10) : 1000000;
    leafless_octree *ball = check_ball(10, LEAFLESS_RULE_CERTIFIED);
    double *points = (double *)malloc(3 * count * sizeof(double));
    leafless_membership *answers = (leafless_membership *)malloc(count);
    leafless_membership answer = LEAFLESS_MEMBERSHIP_UNDECIDED;
    leafless_point_cursor *cursor = NULL;
    double times[3][ROUNDS];
    size_t i, inside[3] = {0, 0, 0};
    int round;
    uint64_t state = 1;
    CHECK(count > 0 && points != NULL && answers != NULL);
    /* The generator of benches/boundary.rs: the upper 53 bits, over the universe. */
    for (i = 0; i < 3 * count; i++) {
        state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        points[i] = (double)(state >> 11) / 9007199254740992.0 * 2.0 - 1.0;
    }
    OK(leafless_point_cursor_new(ball, &cursor));
    for (round = 0; round < ROUNDS; round++) {
        double start = now();
        inside[0] = inside[1] = inside[2] = 0;
        for (i = 0; i < count; i++) {
            leafless_octree_contains(ball, points + 3 * i, &answer);
            inside[0] += answer == LEAFLESS_MEMBERSHIP_INSIDE;
        }
        times[0][round] = now() - start;

        start = now();
        leafless_octree_contains_many(ball, points, count, answers);
        times[1][round] = now() - start;
        for (i = 0; i < count; i++) {
            inside[1] += answers[i] == LEAFLESS_MEMBERSHIP_INSIDE;
        }

        start = now();
        for (i = 0; i < count; i++) {
            /* Lines of 1000 points through the universe. */
            const size_t line = i / 1000 * 1000;
            const double point[3] = {((double)(i % 1000) + 0.5) / 500.0 - 1.0, points[3 * line], points[3 * line + 1]};
            leafless_point_cursor_contains(cursor, point, &answer);
            inside[2] += answer == LEAFLESS_MEMBERSHIP_INSIDE;
        }
        times[2][round] = now() - start;
        CHECK(inside[0] == inside[1]);
    }
    report("one by one", times[0], count);
    report("batch", times[1], count);
    report("lines", times[2], count);
    fprintf(stderr, "%lu and %lu of %lu points inside\n", (unsigned long)inside[0], (unsigned long)inside[2],
            (unsigned long)count);
    leafless_point_cursor_free(cursor);
    leafless_octree_free(ball);
    free(points);
    free(answers);
    return 0;
}
