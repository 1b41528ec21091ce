/* Questions to a mesh's solid through the C interface, one call for each and one for all: what benches/mesh_queries.rs asks from
 * Rust, on the same frame. One thread, processor time, medians of five rounds.
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

static void *room_for(size_t count, size_t size) {
    void *room = malloc(count * size);
    if (room == NULL) {
        fprintf(stderr, "no memory\n");
        exit(1);
    }
    return room;
}

static void add_hit(sums *all, const leafless_ray_hit *hit) {
    if (hit->is_hit && hit->t.upper == INFINITY) {
        all->undecided += 1;
    } else if (hit->is_hit) {
        all->count += 1;
        add(all, hit->t);
    }
}

/* `size` questions a call. */
static void ask_rays(const char *name, const leafless_solid *solid, const leafless_frame *frame,
                     const leafless_ray *rays, size_t count, size_t size, const leafless_options *options) {
    double times[ROUNDS];
    leafless_ray_hit *hits = (leafless_ray_hit *)room_for(size, sizeof *hits);
    sums all;
    size_t i, k;
    int round;
    for (round = 0; round < ROUNDS; round++) {
        const double start = now();
        memset(&all, 0, sizeof all);
        for (i = 0; i < count; i += size) {
            check(leafless_solid_cast_rays(solid, frame, &rays[i], size, LEAFLESS_OBSTACLE_UPPER, options, hits));
            for (k = 0; k < size; k++) {
                add_hit(&all, &hits[k]);
            }
        }
        times[round] = now() - start;
    }
    report(name, times, count, &all);
    free(hits);
}

static void ask_distances(const char *name, const leafless_solid *solid, const leafless_frame *frame,
                          const double *points, size_t count, size_t size, double tolerance,
                          const leafless_options *options) {
    double times[ROUNDS];
    leafless_point_distance *found = (leafless_point_distance *)room_for(size, sizeof *found);
    sums all;
    size_t i, k;
    int round;
    for (round = 0; round < ROUNDS; round++) {
        const double start = now();
        memset(&all, 0, sizeof all);
        for (i = 0; i < count; i += size) {
            check(leafless_solid_distances(solid, frame, &points[3 * i], size, LEAFLESS_DISTANCE_TO_BOUNDARY, tolerance,
                                           options, found));
            for (k = 0; k < size; k++) {
                all.undecided += found[k].measured != LEAFLESS_STOP_REASON_TOLERANCE;
                add(&all, found[k].distance_model);
            }
        }
        times[round] = now() - start;
    }
    report(name, times, count, &all);
    free(found);
}

static void ask_points(const char *name, const leafless_solid *solid, const leafless_frame *frame,
                       const double *points, size_t count, size_t size, const leafless_options *options) {
    double times[ROUNDS];
    leafless_membership *answers = (leafless_membership *)room_for(size, sizeof *answers);
    sums all;
    size_t i, k;
    int round;
    for (round = 0; round < ROUNDS; round++) {
        const double start = now();
        memset(&all, 0, sizeof all);
        for (i = 0; i < count; i += size) {
            check(leafless_solid_contains_many(solid, frame, &points[3 * i], size, options, answers));
            for (k = 0; k < size; k++) {
                all.count += answers[k] == LEAFLESS_MEMBERSHIP_INSIDE;
                all.undecided += answers[k] == LEAFLESS_MEMBERSHIP_UNDECIDED;
            }
        }
        times[round] = now() - start;
    }
    report(name, times, count, &all);
    free(answers);
}

static void as_asked(const question_ray *rays, size_t count, leafless_ray *asked) {
    size_t i;
    int axis;
    for (i = 0; i < count; i++) {
        for (axis = 0; axis < 3; axis++) {
            asked[i].origin_model[axis] = rays[i].from[axis];
            asked[i].direction_model[axis] = rays[i].along[axis];
        }
        asked[i].t_last = INFINITY;
    }
}

int main(int argc, char **argv) {
    const size_t count = argc > 2 ? (size_t)strtoul(argv[2], NULL, 10) : 1000;
    leafless_options options = LEAFLESS_INIT(leafless_options);
    leafless_mesh *mesh = NULL, *sewn = NULL;
    leafless_solid *solid = NULL;
    leafless_frame frame;
    leafless_source file;
    double min[3], max[3], extent[3];
    question_ray *rays = (question_ray *)room_for(count, sizeof *rays);
    question_point *points = (question_point *)room_for(count, sizeof *points);
    leafless_ray *asked = (leafless_ray *)room_for(count, sizeof *asked);
    double *places = (double *)room_for(count, 3 * sizeof *places), tolerance;
    size_t i;
    int axis;
    if (argc < 2 || count == 0) {
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
    as_asked(rays, count, asked);
    ask_rays("rays from afar, one by one", solid, &frame, asked, count, 1, &options);
    ask_rays("rays from afar, in a batch", solid, &frame, asked, count, count, &options);
    rays_from_within(min, max, count, rays);
    as_asked(rays, count, asked);
    ask_rays("rays from within, one by one", solid, &frame, asked, count, 1, &options);
    ask_rays("rays from within, in a batch", solid, &frame, asked, count, count, &options);

    for (i = 0; i < count; i++) {
        for (axis = 0; axis < 3; axis++) {
            places[3 * i + axis] = points[i].at[axis];
        }
    }
    tolerance = 1e-9 * length_of(extent);
    ask_distances("distances, one by one", solid, &frame, places, count, 1, tolerance, &options);
    ask_distances("distances, in a batch", solid, &frame, places, count, count, tolerance, &options);
    ask_points("points, one by one", solid, &frame, places, count, 1, &options);
    ask_points("points, in a batch", solid, &frame, places, count, count, &options);

    leafless_solid_free(solid);
    leafless_mesh_free(sewn);
    leafless_mesh_free(mesh);
    free(rays);
    free(points);
    free(asked);
    free(places);
    return 0;
}
