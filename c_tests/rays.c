/* Rays on an octree and on a solid: the true hits of a ball lie in the intervals; segments end; spans and sight. A closed mesh
   answers single rays by its triangles, and tells which. */
#include "check.h"

#define DEPTH 8
#define RAYS 2000

static const double RADIUS = 0.75;

static leafless_solid *solid;
static leafless_octree *octree;
static leafless_frame frame;

static double between(double low, double high) {
    static uint64_t state = 11;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * ((double)(state >> 11) / 9007199254740992.0);
}

static bool same(const leafless_ray_hit *a, const leafless_ray_hit *b) {
    return a->t.lower == b->t.lower && a->t.upper == b->t.upper && a->level == b->level && a->is_hit == b->is_hit &&
           memcmp(a->normal, b->normal, sizeof a->normal) == 0 && memcmp(a->cell, b->cell, sizeof a->cell) == 0;
}

/* Where a ray enters the ball, but for rounding; false if it does not. */
static bool enters(const leafless_ray *ray, double *t, double *cosine) {
    double a = 0, b = 0, c = -RADIUS * RADIUS, root;
    int axis;
    for (axis = 0; axis < 3; axis++) {
        a += ray->direction_model[axis] * ray->direction_model[axis];
        b += ray->direction_model[axis] * ray->origin_model[axis];
        c += ray->origin_model[axis] * ray->origin_model[axis];
    }
    root = b * b - a * c;
    if (c <= 0) {
        *t = 0, *cosine = 1;
        return true;
    }
    if (root < 0 || b > 0) {
        return false;
    }
    *t = (-b - sqrt(root)) / a;
    *cosine = sqrt(root / a) / RADIUS;
    return *t <= ray->t_last;
}

static void first_hits(void) {
    static leafless_ray rays[RAYS];
    static leafless_ray_hit full[RAYS], upper[RAYS], exact[RAYS], again[RAYS];
    int met = 0, missed = 0, ended = 0, i, axis;
    for (i = 0; i < RAYS; i++) {
        rays[i].t_last = i % 5 == 0 ? 1 : INFINITY;
        for (axis = 0; axis < 3; axis++) {
            rays[i].origin_model[axis] = between(-2, 2);
            rays[i].direction_model[axis] = between(-0.7, 0.7) - rays[i].origin_model[axis];
            if (i % 5 == 0) {
                rays[i].direction_model[axis] *= between(0, 1.5);
            }
        }
    }
    OK(leafless_octree_cast_rays(octree, rays, RAYS, LEAFLESS_OBSTACLE_FULL, full));
    OK(leafless_octree_cast_rays(octree, rays, RAYS, LEAFLESS_OBSTACLE_UPPER, upper));
    OK(leafless_solid_cast_rays(solid, &frame, rays, RAYS, LEAFLESS_OBSTACLE_UPPER, NULL, exact));
    for (i = 0; i < RAYS; i++) {
        double t = INFINITY, cosine = 0;
        const bool truly = enters(&rays[i], &t, &cosine);
        /* One by one it is the same. */
        OK(leafless_octree_cast_rays(octree, &rays[i], 1, LEAFLESS_OBSTACLE_UPPER, &again[i]));
        CHECK(same(&again[i], &upper[i]));
        if (!upper[i].is_hit) {
            CHECK(!full[i].is_hit && !exact[i].is_hit && upper[i].t.lower == INFINITY && upper[i].level == 0);
            CHECK(!truly || t > rays[i].t_last - 1e-9);
            ended += rays[i].t_last == 1;
            missed++;
            continue;
        }
        CHECK(!truly || (upper[i].t.lower <= t + 1e-12 && upper[i].t.upper >= t - 1e-12));
        CHECK(!truly || (exact[i].is_hit && exact[i].t.lower <= t + 1e-12 && exact[i].t.upper >= t - 1e-12));
        CHECK(full[i].is_hit == (upper[i].t.upper < INFINITY));
        CHECK(!full[i].is_hit || (full[i].t.lower == upper[i].t.lower && full[i].t.upper == upper[i].t.upper));
        CHECK(upper[i].t.lower <= rays[i].t_last && upper[i].level <= DEPTH);
        if (truly && full[i].is_hit && t > 0 && cosine > 0.3) {
            double turned = 0;
            for (axis = 0; axis < 3; axis++) {
                const double at = rays[i].origin_model[axis] + t * rays[i].direction_model[axis];
                turned += at / RADIUS * exact[i].normal[axis];
            }
            CHECK(turned > 0.99);
            met++;
        }
    }
    CHECK(met > 500 && missed > 100 && ended > 50);
}

static void spans(void) {
    const leafless_ray ray = {{-3, 0.1, 0.2}, {2, 0, 0}, INFINITY};
    const double half = sqrt(RADIUS * RADIUS - 0.01 - 0.04), from = (3 - half) / 2, to = (3 + half) / 2;
    leafless_interval inner[4], outer[4], untouched = {5, 6};
    leafless_ray until = ray;
    uint64_t inner_count = 7, outer_count = 7;
    int of_solid;
    for (of_solid = 0; of_solid < 2; of_solid++) {
        if (of_solid) {
            OK(leafless_solid_ray_spans(solid, &frame, &ray, NULL, inner, 4, &inner_count, outer, 4, &outer_count));
        } else {
            OK(leafless_octree_ray_spans(octree, &ray, inner, 4, &inner_count, outer, 4, &outer_count));
        }
        CHECK(inner_count == 1 && outer_count == 1);
        CHECK(outer[0].lower <= from && from <= inner[0].lower && inner[0].lower < outer[0].lower + 0.02);
        CHECK(inner[0].upper <= to && to <= outer[0].upper && outer[0].upper < inner[0].upper + 0.02);
    }
    /* The end of a segment in the ball is the end of both. */
    until.t_last = 1.5;
    OK(leafless_octree_ray_spans(octree, &until, inner, 1, &inner_count, outer, 1, &outer_count));
    CHECK(inner_count == 1 && outer_count == 1 && inner[0].upper == 1.5 && outer[0].upper == 1.5);
    until.t_last = 1;
    OK(leafless_octree_ray_spans(octree, &until, NULL, 0, &inner_count, NULL, 0, &outer_count));
    CHECK(inner_count == 0 && outer_count == 0);
    /* Only one of the lists; with a buffer that is too small, nothing of either. */
    OK(leafless_octree_ray_spans(octree, &ray, NULL, 0, &inner_count, outer, 4, &outer_count));
    CHECK(inner_count == 1 && outer_count == 1);
    inner[0] = outer[0] = untouched;
    inner_count = 7;
    FAILS(LEAFLESS_E_BUFFER, leafless_octree_ray_spans(octree, &ray, inner, 4, &inner_count, outer, 0, &outer_count));
    FAILS(LEAFLESS_E_BUFFER,
          leafless_solid_ray_spans(solid, &frame, &ray, NULL, inner, 0, &inner_count, outer, 4, &outer_count));
    CHECK(inner[0].lower == 5 && outer[0].lower == 5 && inner_count == 7);
}

static void sight(void) {
    const double left[3] = {-2, 0, 0}, right[3] = {2, 0.1, 0}, above[3] = {0, 2, 0}, near[3] = {-0.76, 0, 0};
    const double tangent[2][3] = {{-2, 0.75, 0}, {2, 0.75, 0}};
    leafless_sight found;
    leafless_options options;
    OK(leafless_solid_line_of_sight(solid, &frame, left, right, NULL, &found));
    CHECK(found == LEAFLESS_SIGHT_BLOCKED);
    OK(leafless_solid_line_of_sight(solid, &frame, left, above, NULL, &found));
    CHECK(found == LEAFLESS_SIGHT_CLEAR);
    OK(leafless_solid_line_of_sight(solid, &frame, left, near, NULL, &found));
    CHECK(found == LEAFLESS_SIGHT_CLEAR);
    /* It touches the ball, which cells cannot decide. */
    OK(leafless_init(&options, sizeof options));
    options.max_splits = 1000;
    OK(leafless_solid_line_of_sight(solid, &frame, tangent[0], tangent[1], &options, &found));
    CHECK(found == LEAFLESS_SIGHT_UNDECIDED);
}

/* One bad ray among good ones: the message names it, and no hit is written. */
static void bad_rays(void) {
    static const double numbers[] = {(double)NAN, INFINITY, -INFINITY, 1e300, 1e-300};
    leafless_ray rays[100];
    leafless_ray_hit hits[100];
    char message[256];
    size_t i, axis;
    for (i = 0; i < COUNT(rays); i++) {
        const leafless_ray ray = {{-2, 0, 0}, {1, 0, 0}, INFINITY};
        rays[i] = ray;
    }
    memset(hits, 0, sizeof hits);
    for (i = 0; i < COUNT(numbers); i++) {
        for (axis = 0; axis < 3; axis++) {
            leafless_ray ray = rays[0];
            ray.origin_model[axis] = numbers[i];
            FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_cast_rays(octree, &ray, 1, 0, hits));
            ray = rays[0];
            ray.direction_model[axis] = numbers[i];
            rays[97] = ray;
            FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_cast_rays(octree, rays, COUNT(rays), 0, hits));
            (void)leafless_last_error(message, sizeof message);
            CHECK(strncmp(message, "rays[97]: direction: ", 21) == 0);
            FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_cast_rays(solid, &frame, rays, COUNT(rays), 0, NULL, hits));
            rays[97] = rays[0];
        }
    }
    CHECK(!hits[0].is_hit && hits[0].t.upper == 0);
    OK(leafless_octree_cast_rays(octree, rays, COUNT(rays), 0, hits));
    for (i = 0; i < COUNT(rays); i++) {
        CHECK(same(&hits[i], &hits[0]) && hits[i].t.lower <= 1.25 && 1.25 <= hits[i].t.upper);
    }
}

/* Rays on a cube of triangles: each face is met by one of its two, from both sides of the diagonal and on it, and the normal
   is that of the face. */
static void closed_mesh(void) {
    leafless_mesh *mesh = check_cube();
    const leafless_frame around = {{-3, -3, -3}, 8, 5};
    const double aside[3] = {3, 3, 2};
    leafless_ray rays[6 * 3];
    leafless_ray_hit hits[6 * 3], again[6 * 3];
    leafless_interval inner[2], outer[2];
    uint64_t inner_count, outer_count;
    leafless_solid *cube;
    leafless_sight found;
    int face, i, axis;
    OK(leafless_solid_from_mesh(mesh, LEAFLESS_FILL_NON_ZERO, &cube));
    leafless_mesh_free(mesh);
    for (i = 0; i < 18; i++) {
        /* The faces in the order of the triangles: below and above along z, y and x. */
        const double places[3][2] = {{0.25, 0.625}, {0.625, 0.25}, {0.5, 0.5}};
        face = i / 3;
        axis = 2 - face / 2;
        rays[i].t_last = INFINITY;
        rays[i].origin_model[axis] = face % 2 == 0 ? -2 : 3;
        rays[i].origin_model[(axis + 1) % 3] = places[i % 3][0];
        rays[i].origin_model[(axis + 2) % 3] = places[i % 3][1];
        rays[i].direction_model[axis] = face % 2 == 0 ? 4 : -4;
        rays[i].direction_model[(axis + 1) % 3] = rays[i].direction_model[(axis + 2) % 3] = 0;
    }
    OK(leafless_solid_cast_rays(cube, &around, rays, 18, LEAFLESS_OBSTACLE_FULL, NULL, hits));
    OK(leafless_solid_cast_rays(cube, &around, rays, 18, LEAFLESS_OBSTACLE_UPPER, NULL, again));
    for (i = 0; i < 18; i++) {
        const uint32_t surface = hits[i].surface;
        face = i / 3;
        axis = 2 - face / 2;
        CHECK(hits[i].is_hit && hits[i].t.lower == 0.5 && hits[i].t.upper == 0.5 && hits[i].level == 5);
        CHECK(same(&hits[i], &again[i]) && surface == again[i].surface && surface / 2 == (uint32_t)face);
        CHECK(hits[i].normal[axis] == (face % 2 == 0 ? -1 : 1));
        CHECK(hits[i].normal[(axis + 1) % 3] == 0 && hits[i].normal[(axis + 2) % 3] == 0);
        /* On either side of the diagonal is another triangle. */
        CHECK(i % 3 == 0 || i % 3 == 2 || surface != hits[i - 1].surface);
    }
    /* From within there is no surface, and no normal; beside it there is no hit, and no surface either. */
    rays[0].origin_model[2] = 0.5;
    rays[1].origin_model[0] = 2;
    OK(leafless_solid_cast_rays(cube, &around, rays, 2, LEAFLESS_OBSTACLE_FULL, NULL, hits));
    CHECK(hits[0].is_hit && hits[0].t.upper == 0 && hits[0].surface == UINT32_MAX);
    CHECK(hits[0].normal[0] == 0 && hits[0].normal[1] == 0 && hits[0].normal[2] == 0);
    CHECK(!hits[1].is_hit && hits[1].t.lower == INFINITY && hits[1].surface == UINT32_MAX);
    /* A ball does not answer rays itself. */
    OK(leafless_solid_cast_rays(solid, &frame, &rays[2], 1, LEAFLESS_OBSTACLE_UPPER, NULL, hits));
    CHECK(hits[0].surface == UINT32_MAX);
    OK(leafless_solid_ray_spans(cube, &around, &rays[3], NULL, inner, 2, &inner_count, outer, 2, &outer_count));
    CHECK(inner_count == 1 && outer_count == 1 && inner[0].lower == 0.5 && inner[0].upper == 0.75);
    CHECK(outer[0].lower == 0.5 && outer[0].upper == 0.75);
    OK(leafless_solid_line_of_sight(cube, &around, rays[3].origin_model, rays[2].origin_model, NULL, &found));
    CHECK(found == LEAFLESS_SIGHT_BLOCKED);
    OK(leafless_solid_line_of_sight(cube, &around, rays[3].origin_model, aside, NULL, &found));
    CHECK(found == LEAFLESS_SIGHT_CLEAR);
    leafless_solid_free(cube);
}

int main(void) {
    frame = check_frame(DEPTH);
    solid = check_ball_solid();
    octree = check_ball(DEPTH, LEAFLESS_RULE_CERTIFIED);
    first_hits();
    spans();
    sight();
    bad_rays();
    closed_mesh();
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    return 0;
}
