/* The questions of benches/mesh_questions.rs, in C99 and C++: the same numbers, if the compiler fuses no products and sums
 * (-ffp-contract=off). And the clock of processor time. */
#ifndef MESH_QUERIES_H
#define MESH_QUERIES_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { ROUNDS = 5 };

typedef struct {
    float from[3], along[3];
} question_ray;

typedef struct {
    float at[3];
} question_point;

/* Nanoseconds of processor time. */
static inline double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1e9 * (double)time.tv_sec + (double)time.tv_nsec;
}

static inline int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* splitmix64: a number in [0, 1). */
static inline double next_share(uint64_t *state) {
    uint64_t z = *state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
    z ^= z >> 31;
    return (double)(z >> 11) / 9007199254740992.0;
}

static inline void next_in_box(uint64_t *state, const double min[3], const double max[3], double point[3]) {
    int axis;
    for (axis = 0; axis < 3; axis++) {
        point[axis] = min[axis] + next_share(state) * (max[axis] - min[axis]);
    }
}

static inline double length_of(const double v[3]) {
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* A direction, all equally likely: that of a point of the unit ball. */
static inline void next_direction(uint64_t *state, double v[3]) {
    double length;
    int axis;
    do {
        for (axis = 0; axis < 3; axis++) {
            v[axis] = 2.0 * next_share(state) - 1.0;
        }
        length = length_of(v);
    } while (length > 1.0 || length < 1e-3);
    for (axis = 0; axis < 3; axis++) {
        v[axis] /= length;
    }
}

/* Rays from the sphere of 1.5 diagonals around the box to points of the box. */
static inline void rays_from_afar(const double min[3], const double max[3], size_t count, question_ray *rays) {
    const double extent[3] = {max[0] - min[0], max[1] - min[1], max[2] - min[2]};
    const double radius = 1.5 * length_of(extent);
    uint64_t state = 1;
    size_t i;
    int axis;
    for (i = 0; i < count; i++) {
        double from[3], to[3], length;
        next_direction(&state, from);
        next_in_box(&state, min, max, to);
        for (axis = 0; axis < 3; axis++) {
            from[axis] = min[axis] + 0.5 * extent[axis] + radius * from[axis];
            to[axis] -= from[axis];
        }
        length = length_of(to);
        for (axis = 0; axis < 3; axis++) {
            rays[i].from[axis] = (float)from[axis];
            rays[i].along[axis] = (float)(to[axis] / length);
        }
    }
}

/* Rays from points of the box, in any direction. */
static inline void rays_from_within(const double min[3], const double max[3], size_t count, question_ray *rays) {
    uint64_t state = 2;
    size_t i;
    int axis;
    for (i = 0; i < count; i++) {
        double from[3], along[3];
        next_in_box(&state, min, max, from);
        next_direction(&state, along);
        for (axis = 0; axis < 3; axis++) {
            rays[i].from[axis] = (float)from[axis];
            rays[i].along[axis] = (float)along[axis];
        }
    }
}

/* Points of the box. */
static inline void points_within(const double min[3], const double max[3], size_t count, question_point *points) {
    uint64_t state = 3;
    size_t i;
    int axis;
    for (i = 0; i < count; i++) {
        double at[3];
        next_in_box(&state, min, max, at);
        for (axis = 0; axis < 3; axis++) {
            points[i].at[axis] = (float)at[axis];
        }
    }
}

/* The sum of the numbers' bits: tells whether questions are the same. */
static inline uint64_t sum_of_bits(const void *questions, size_t bytes) {
    uint64_t sum = 0;
    size_t i;
    for (i = 0; i + 4 <= bytes; i += 4) {
        uint32_t bits;
        memcpy(&bits, (const char *)questions + i, 4);
        sum += bits;
    }
    return sum;
}

#endif
