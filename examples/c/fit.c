/* Checks whether a shaft fits into a housing. The solids are expressions of half-spaces, and no octree is built. The
 * program prints volume and centre of mass, and at a series of positions overlap, distance and collision volume.
 *
 *     fit
 *
 * include/README.md describes how to build it.
 */
#include <leafless.h>

#include <math.h>
#include <stdio.h>

enum { POSITIONS = 9, DEPTH = 12 };

/* A block of 120 with a bore of radius 22, and below it a narrower bore for the end of the shaft. */
static leafless_status housing(leafless_solid **result) {
    const double low[3] = {-60, -60, -60}, high[3] = {60, 60, 60};
    const double top[3] = {0, 0, 61}, step[3] = {0, 0, -20}, bottom[3] = {0, 0, -61};
    leafless_solid *block = NULL, *bore = NULL, *seat = NULL;
    leafless_status s = leafless_solid_new_box(low, high, &block);
    if (!s) s = leafless_solid_new_cylinder(step, top, 22, &bore);
    if (!s) s = leafless_solid_new_cylinder(bottom, step, 13, &seat);
    if (!s) {
        const leafless_solid *const operands[] = {block, bore, seat};
        s = leafless_solid_combine(LEAFLESS_OPERATION_DIFFERENCE, operands, 3, result);
    }
    leafless_solid_free(seat), leafless_solid_free(bore), leafless_solid_free(block);
    return s;
}

/* A shaft of radius 20 with a journal of radius 11.5, tilted by the angle whose tangent is `slope`. */
static leafless_status shaft(double slope, double height, leafless_solid **result) {
    const double length = sqrt(1 + slope * slope), c = 1 / length, d = slope / length;
    const double matrix[12] = {c, 0, d, 0, 0, 1, 0, 0, -d, 0, c, height};
    const double tip[3] = {0, 0, -35}, origin[3] = {0, 0, 0}, inner[3] = {0, 0, 1}, end[3] = {0, 0, 90};
    leafless_solid *thick = NULL, *thin = NULL, *both = NULL;
    leafless_status s = leafless_solid_new_cylinder(origin, end, 20, &thick);
    if (!s) s = leafless_solid_new_cylinder(tip, inner, 11.5, &thin);
    if (!s) {
        const leafless_solid *const parts[] = {thick, thin};
        s = leafless_solid_combine(LEAFLESS_OPERATION_UNION, parts, 2, &both);
    }
    if (!s) s = leafless_solid_placed(both, matrix, NULL, result);
    leafless_solid_free(both), leafless_solid_free(thin), leafless_solid_free(thick);
    return s;
}

int main(void) {
    static const char *const verdicts[] = {"disjoint", "overlapping", "undecided"};
    const leafless_frame frame = {{-128, -128, -128}, 256, DEPTH};
    leafless_solid *fixed = NULL, *moving = NULL;
    leafless_measures measures = LEAFLESS_INIT(leafless_measures);
    leafless_options options = LEAFLESS_INIT(leafless_options);
    leafless_status s = LEAFLESS_OK;
    int i;
    options.max_splits = 200000; /* for each query */
    if (!s) s = housing(&fixed);
    if (!s) s = leafless_solid_measure(fixed, &frame, 0.02, 0.0, NULL, &measures);
    if (!s) {
        printf("housing: volume %.0f to %.0f", measures.volume_model.lower, measures.volume_model.upper);
        printf(", centre of mass at z = %.2f to %.2f\n", measures.centroid_model[2].lower,
               measures.centroid_model[2].upper);
    }
    for (i = 0; !s && i < POSITIONS; i++) {
        /* The shaft is lowered to the step at z = -20, and beyond; in the end it is slightly tilted. */
        const double height = 60 - 10 * i, slope = i == POSITIONS - 2 ? 0.05 : 0;
        leafless_interference found;
        leafless_clearance near = LEAFLESS_INIT(leafless_clearance);
        s = shaft(slope, height, &moving);
        if (!s) s = leafless_solid_interfere(moving, fixed, &frame, 10, &options, &found);
        if (!s) s = leafless_solid_clearance(moving, fixed, &frame, 0.25, &options, &near);
        if (!s) {
            printf("at %3.0f: %-11s overlap %6.1f to %7.1f, clearance %.2f to %.2f, %llu splits\n", height,
                   verdicts[found.verdict], found.volume_model.lower, found.volume_model.upper,
                   near.distance_model.lower, near.distance_model.upper,
                   (unsigned long long)(found.splits_a + found.splits_b));
        }
        leafless_solid_free(moving);
        moving = NULL;
    }
    leafless_solid_free(fixed);
    if (s) {
        char message[512];
        leafless_last_error(message, sizeof message);
        fprintf(stderr, "%s\n", message);
    }
    return s != LEAFLESS_OK;
}
