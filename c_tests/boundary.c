/* What queries cost through the C interface: points, rays and distances, one by one and in a batch, and points with a
 * cursor along lines.
 *
 *     ./boundary [POINTS]
 *
 * include/README.md tells how to build it: gcc -O2 c_tests/boundary.c -Iinclude target/release/libleafless.a ...
 * benches/boundary.rs measures the same ball and points from Rust. */
#define _POSIX_C_SOURCE 200809L
#include "check.h"

#include <time.h>

/* Processor time: other programs may run beside this one. */
static double now(void) {
    struct timespec time;
    CHECK(clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time) == 0);
    return (double)time.tv_sec * 1e9 + (double)time.tv_nsec;
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

enum { ROUNDS = 11 };

static void report(const char *name, double *times, size_t points) {
    qsort(times, ROUNDS, sizeof times[0], ascending);
    printf("%-22s %9.2f ns\n", name, times[ROUNDS / 2] / (double)points);
}

/* Rays from points of the universe to the next ones, and distances of points from the surface. */
static void rays_and_distances(const leafless_octree *ball, const double *points, size_t rays, size_t far) {
    leafless_ray *list = (leafless_ray *)calloc(rays, sizeof *list);
    leafless_ray_hit *hits = (leafless_ray_hit *)calloc(rays, sizeof *hits);
    leafless_interval *distances = (leafless_interval *)calloc(far, sizeof *distances);
    leafless_options options = LEAFLESS_INIT(leafless_options);
    double times[4][ROUNDS], sums[2] = {0, 0};
    size_t i, met[2] = {0, 0};
    int round, axis;
    CHECK(list != NULL && hits != NULL && distances != NULL);
    options.threads = 1;
    for (i = 0; i < rays; i++) {
        for (axis = 0; axis < 3; axis++) {
            list[i].origin_model[axis] = points[3 * i + axis];
            list[i].direction_model[axis] = points[(3 * i + 3) % (3 * rays) + axis] - points[3 * i + axis];
        }
        list[i].t_last = INFINITY;
    }
    for (round = 0; round < ROUNDS; round++) {
        double start = now();
        met[0] = met[1] = 0;
        sums[0] = sums[1] = 0;
        for (i = 0; i < rays; i++) {
            leafless_octree_cast_rays(ball, list + i, 1, LEAFLESS_OBSTACLE_UPPER, hits);
            met[0] += hits[0].is_hit;
        }
        times[0][round] = now() - start;
        start = now();
        leafless_octree_cast_rays(ball, list, rays, LEAFLESS_OBSTACLE_UPPER, hits);
        times[1][round] = now() - start;
        for (i = 0; i < rays; i++) {
            met[1] += hits[i].is_hit;
        }
        start = now();
        for (i = 0; i < far; i++) {
            leafless_octree_distances(ball, points + 3 * i, 1, LEAFLESS_DISTANCE_TO_BOUNDARY, &options, distances);
            sums[0] += distances[0].lower;
        }
        times[2][round] = now() - start;
        start = now();
        leafless_octree_distances(ball, points, far, LEAFLESS_DISTANCE_TO_BOUNDARY, &options, distances);
        times[3][round] = now() - start;
        for (i = 0; i < far; i++) {
            sums[1] += distances[i].lower;
        }
        CHECK(met[0] == met[1] && sums[0] == sums[1]);
    }
    report("rays one by one", times[0], rays);
    report("rays batch", times[1], rays);
    report("distances one by one", times[2], far);
    report("distances batch", times[3], far);
    free(list);
    free(hits);
    free(distances);
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
    report("points one by one", times[0], count);
    report("points batch", times[1], count);
    report("points on lines", times[2], count);
    rays_and_distances(ball, points, count / 10, count / 1000);
    fprintf(stderr, "%lu and %lu of %lu points inside\n", (unsigned long)inside[0], (unsigned long)inside[2],
            (unsigned long)count);
    leafless_point_cursor_free(cursor);
    leafless_octree_free(ball);
    free(points);
    free(answers);
    return 0;
}
