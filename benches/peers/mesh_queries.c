/* Single questions to a mesh's solid through the C interface, one call for each: what benches/mesh_queries.rs asks from Rust,
 * on the same frame. One thread, processor time, medians of five rounds.
 *
 *     mesh_queries_c MESH.stl [QUESTIONS]
 *
 * benches/README.md tells how to build it. */
#define _POSIX_C_SOURCE 200809L
#include "mesh_queries.h"

#include <leafless.h>

enum { DEPTH = 20 };

/* What all answers come to. */
typedef struct {
    size_t count; /* Hits, or points inside. */
    double sum; /* Of the middles of intervals with two ends. */
    size_t undecided; /* Answers that are neither yes nor no, or wider than the tolerance. */
    double widest; /* The widest interval with two ends. */
} sums;

static void check(leafless_status status) {
    if (status != LEAFLESS_OK) {
        char message[512] = "";
        (void)leafless_last_error(message, sizeof message);
        fprintf(stderr, "%s: %s\n", leafless_status_name(status), message);
        exit(1);
    }
}

static void add(sums *all, leafless_interval interval) {
    const double width = interval.upper - interval.lower;
    all->sum += fabs(0.5 * (interval.lower + interval.upper));
    all->widest = width > all->widest ? width : all->widest;
}

static void report(const char *name, double *times, size_t count, const sums *all) {
    qsort(times, ROUNDS, sizeof times[0], ascending);
    printf("%-38s %12.1f ns  %9lu  %.9f  %lu undecided, widest %.1e\n", name, times[ROUNDS / 2] / (double)count,
           (unsigned long)all->count, all->sum, (unsigned long)all->undecided, all->widest);
}

static void ask_rays(const char *name, const leafless_solid *solid, const leafless_frame *frame,
                     const question_ray *rays, size_t count, const leafless_options *options) {
    double times[ROUNDS];
    sums all;
    size_t i;
    int round, axis;
    for (round = 0; round < ROUNDS; round++) {
        const double start = now();
        memset(&all, 0, sizeof all);
        for (i = 0; i < count; i++) {
            leafless_ray ray;
            leafless_ray_hit hit;
            for (axis = 0; axis < 3; axis++) {
                ray.origin_model[axis] = rays[i].from[axis];
                ray.direction_model[axis] = rays[i].along[axis];
            }
            ray.t_last = INFINITY;
            check(leafless_solid_cast_rays(solid, frame, &ray, 1, LEAFLESS_OBSTACLE_UPPER, options, &hit));
            if (hit.is_hit && hit.t.upper == INFINITY) {
                all.undecided += 1;
            } else if (hit.is_hit) {
                all.count += 1;
                add(&all, hit.t);
            }
        }
        times[round] = now() - start;
    }
    report(name, times, count, &all);
}

static void ask_points(const leafless_solid *solid, const leafless_frame *frame, const question_point *points,
                       size_t count, double tolerance, const leafless_options *options) {
    double times[2][ROUNDS];
    sums far, inside;
    size_t i;
    int round;
    for (round = 0; round < ROUNDS; round++) {
        double start = now();
        memset(&far, 0, sizeof far);
        memset(&inside, 0, sizeof inside);
        for (i = 0; i < count; i++) {
            const double point[3] = {points[i].at[0], points[i].at[1], points[i].at[2]};
            leafless_point_distance found;
            check(leafless_solid_distances(solid, frame, point, 1, LEAFLESS_DISTANCE_TO_BOUNDARY, tolerance, options,
                                           &found));
            far.undecided += found.measured != LEAFLESS_STOP_REASON_TOLERANCE;
            add(&far, found.distance_model);
        }
        times[0][round] = now() - start;
        start = now();
        for (i = 0; i < count; i++) {
            const double point[3] = {points[i].at[0], points[i].at[1], points[i].at[2]};
            leafless_membership answer;
            check(leafless_solid_contains_many(solid, frame, point, 1, options, &answer));
            inside.count += answer == LEAFLESS_MEMBERSHIP_INSIDE;
            inside.undecided += answer == LEAFLESS_MEMBERSHIP_UNDECIDED;
        }
        times[1][round] = now() - start;
    }
    report("distances, one by one", times[0], count, &far);
    report("points, one by one", times[1], count, &inside);
}

int main(int argc, char **argv) {
    const size_t count = argc > 2 ? (size_t)strtoul(argv[2], NULL, 10) : 1000;
    leafless_options options = LEAFLESS_INIT(leafless_options);
    leafless_mesh *mesh = NULL, *sewn = NULL;
    leafless_solid *solid = NULL;
    leafless_frame frame;
    leafless_source file;
    double min[3], max[3], extent[3];
    question_ray *rays = (question_ray *)malloc(count * sizeof *rays);
    question_point *points = (question_point *)malloc(count * sizeof *points);
    int axis;
    if (argc < 2 || count == 0 || rays == NULL || points == NULL) {
        fprintf(stderr, "which mesh?\n");
        return 1;
    }
    options.threads = 1;
    file = leafless_from_file(argv[1], LEAFLESS_ACCESS_COPY);
    check(leafless_mesh_read(&file, NULL, NULL, &mesh));
    check(leafless_mesh_sewn(mesh, &sewn));
    check(leafless_mesh_bounds(sewn, min, max));
    check(leafless_frame_around(min, max, DEPTH, &frame));
    check(leafless_solid_from_mesh(sewn, LEAFLESS_FILL_NON_ZERO, &solid));
    for (axis = 0; axis < 3; axis++) {
        extent[axis] = max[axis] - min[axis];
    }

    rays_from_afar(min, max, count, rays);
    printf("%lu questions: %llu", (unsigned long)count, (unsigned long long)sum_of_bits(rays, count * sizeof *rays));
    rays_from_within(min, max, count, rays);
    points_within(min, max, count, points);
    printf(" %llu %llu\n", (unsigned long long)sum_of_bits(rays, count * sizeof *rays),
           (unsigned long long)sum_of_bits(points, count * sizeof *points));

    rays_from_afar(min, max, count, rays);
    ask_rays("rays from afar, one by one", solid, &frame, rays, count, &options);
    rays_from_within(min, max, count, rays);
    ask_rays("rays from within, one by one", solid, &frame, rays, count, &options);
    ask_points(solid, &frame, points, count, 1e-9 * length_of(extent), &options);

    leafless_solid_free(solid);
    leafless_mesh_free(sewn);
    leafless_mesh_free(mesh);
    free(rays);
    free(points);
    return 0;
}
