/* Solids of meshes in any condition: with holes, inverted facets, overlapping and inside-out bodies, under each
   leafless_fill; against the definition, a sum of solid angles. */
#include "check.h"

enum { DEPTH = 6, CELLS = 1 << DEPTH, POINTS = 2000, MOST = 64 };

typedef struct surface {
    double vertices[MOST][3];
    uint32_t triangles[MOST][3];
    uint32_t vertex_count, triangle_count;
} surface;

/* The lower corner and the edge of single cubes. The first has no symmetry. The second's diagonals lead through centres
   of cells, and so do all edges of the third. */
static const struct {
    double skew[3], low, edge;
} CUBES[] = {{{0.0, 0.013, -0.0087}, -0.7, 1.4}, {{0, 0, 0}, -0.7, 1.4}, {{0, 0, 0}, -22.5 / 32, 45.0 / 32}};

static void add_cube(surface *all, const double *skew, double low, double edge, bool inside_out) {
    uint32_t i, k;
    for (i = 0; i < 8; i++) {
        for (k = 0; k < 3; k++) {
            all->vertices[all->vertex_count + i][k] = low + edge * CHECK_CUBE[i][k] + skew[k];
        }
    }
    for (i = 0; i < 12; i++) {
        for (k = 0; k < 3; k++) {
            all->triangles[all->triangle_count + i][k] =
                all->vertex_count + CHECK_CUBE_TRIANGLES[i][inside_out ? 2 - k : k];
        }
    }
    all->vertex_count += 8;
    all->triangle_count += 12;
}

static void remove_triangle(surface *all, uint32_t which) {
    all->triangle_count--;
    memcpy(all->triangles[which], all->triangles[all->triangle_count], sizeof all->triangles[which]);
}

static void turn_over(surface *all, uint32_t which) {
    const uint32_t first = all->triangles[which][0];
    all->triangles[which][0] = all->triangles[which][1];
    all->triangles[which][1] = first;
}

static double dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* van Oosterom and Strackee: the solid angle of each triangle, over 4 pi. */
static double winding_number(const surface *all, const double *point) {
    const double two_pi = 6.283185307179586;
    double sum = 0.0;
    uint32_t i, k, axis;
    for (i = 0; i < all->triangle_count; i++) {
        double v[3][3], length[3], determinant;
        for (k = 0; k < 3; k++) {
            for (axis = 0; axis < 3; axis++) {
                v[k][axis] = all->vertices[all->triangles[i][k]][axis] - point[axis];
            }
            length[k] = sqrt(dot(v[k], v[k]));
        }
        determinant = v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) +
                      v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
                      v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
        sum += atan2(determinant, length[0] * length[1] * length[2] + dot(v[0], v[1]) * length[2] +
                                      dot(v[1], v[2]) * length[0] + dot(v[2], v[0]) * length[1]);
    }
    return sum / two_pi;
}

/* By how much a point is inside, or outside if that is negative; for closed surfaces only it may be even-odd. */
static double inside_by(const surface *all, const double *point, uint32_t fill) {
    const double winding = winding_number(all, point);
    if (fill == LEAFLESS_FILL_EVEN_ODD) {
        return fabs(fmod(fabs(floor(winding + 0.5)), 2.0)) - 0.5;
    }
    return (fill == LEAFLESS_FILL_POSITIVE ? winding : fabs(winding)) - 0.5;
}

/* Numbers in [0, 1), the same each time. */
static double next_random(void) {
    static uint64_t state = 12345;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (double)(state >> 11) * 0x1p-53;
}

/* Whether a point lies in the plane of a face of the first cube: where there is surface, either side is right. */
static bool on_face(const surface *all, const double *point) {
    uint32_t axis;
    for (axis = 0; axis < 3; axis++) {
        if (point[axis] == all->vertices[0][axis] || point[axis] == all->vertices[7][axis]) {
            return true;
        }
    }
    return false;
}

static leafless_octree *built(const surface *all, uint32_t fill, uint32_t rule) {
    const leafless_frame frame = check_frame(DEPTH);
    const leafless_mesh_arrays arrays =
        check_arrays(all->vertices, all->vertex_count, all->triangles, all->triangle_count);
    leafless_mesh *mesh = NULL;
    leafless_solid *solid = NULL;
    leafless_octree *octree = NULL;
    OK(leafless_mesh_new(&arrays, &mesh));
    OK(leafless_solid_from_mesh(mesh, fill, &solid));
    leafless_mesh_free(mesh);
    OK(leafless_octree_build(solid, &frame, rule, NULL, &octree));
    leafless_solid_free(solid);
    OK(leafless_octree_check(octree));
    return octree;
}

/* Whether the sampled octree is right about the centre of the cell that a point lies in. */
static void centre_agrees(const surface *all, uint32_t fill, const leafless_octree *sampled, const double *point) {
    leafless_membership verdict = 77;
    double centre[3];
    uint32_t axis;
    for (axis = 0; axis < 3; axis++) {
        centre[axis] = (floor(point[axis] * (CELLS / 2)) + 0.5) / (CELLS / 2);
    }
    OK(leafless_octree_contains(sampled, centre, &verdict));
    if (on_face(all, centre)) {
        return;
    }
    if (verdict == LEAFLESS_MEMBERSHIP_INSIDE) {
        CHECK(inside_by(all, centre, fill) > -1e-9);
    } else {
        CHECK(verdict == LEAFLESS_MEMBERSHIP_OUTSIDE && inside_by(all, centre, fill) < 1e-9);
    }
}

/* What the certified octree says is never wrong, the sampled one is right about the centres of cells, and the
   volume lies between the bounds. Returns how many points are left open. */
static uint32_t agrees(const surface *all, uint32_t fill) {
    leafless_octree *certified = built(all, fill, LEAFLESS_RULE_CERTIFIED);
    leafless_octree *sampled = built(all, fill, LEAFLESS_RULE_SAMPLED);
    leafless_statistics bounds, estimate;
    uint32_t open = 0, i, axis;
    OK(leafless_octree_statistics(certified, &bounds));
    OK(leafless_octree_statistics(sampled, &estimate));
    CHECK(bounds.volume_model.lower <= estimate.volume_model.lower);
    CHECK(bounds.volume_model.upper >= estimate.volume_model.upper);
    for (i = 0; i < POINTS; i++) {
        leafless_membership verdict = 77;
        double point[3];
        for (axis = 0; axis < 3; axis++) {
            point[axis] = 2.0 * next_random() - 1.0;
        }
        OK(leafless_octree_contains(certified, point, &verdict));
        if (verdict == LEAFLESS_MEMBERSHIP_INSIDE) {
            CHECK(inside_by(all, point, fill) > -1e-9);
        } else if (verdict == LEAFLESS_MEMBERSHIP_OUTSIDE) {
            CHECK(inside_by(all, point, fill) < 1e-9);
        } else {
            CHECK(verdict == LEAFLESS_MEMBERSHIP_UNDECIDED);
            open++;
        }
        centre_agrees(all, fill, sampled, point);
    }
    /* Along the diagonals of the universe. */
    for (i = 0; i < 4 * CELLS; i++) {
        double point[3];
        for (axis = 0; axis < 3; axis++) {
            point[axis] = (2 * (i % CELLS) + 1.0) / CELLS - 1.0;
            if ((i / CELLS) >> axis & 1) {
                point[axis] = -point[axis];
            }
        }
        centre_agrees(all, fill, sampled, point);
    }
    leafless_octree_free(sampled);
    leafless_octree_free(certified);
    return open;
}

static leafless_membership at(const surface *all, uint32_t fill, double x, double y, double z) {
    leafless_octree *octree = built(all, fill, LEAFLESS_RULE_CERTIFIED);
    const double point[3] = {x, y, z};
    leafless_membership verdict = 77;
    OK(leafless_octree_contains(octree, point, &verdict));
    leafless_octree_free(octree);
    return verdict;
}

#define IS(verdict, all, fill, place) \
    CHECK(at(all, LEAFLESS_FILL_##fill, place, place, place) == LEAFLESS_MEMBERSHIP_##verdict)

/* Two cubes along the diagonal whose overlap is [-0.2, 0.2] on each axis. */
static void overlapping(bool inside_out) {
    surface both = {0};
    add_cube(&both, CUBES[0].skew, -0.7, 0.9, false);
    add_cube(&both, CUBES[0].skew, -0.2, 0.9, inside_out);
    IS(INSIDE, &both, NON_ZERO, -0.4);
    IS(INSIDE, &both, EVEN_ODD, -0.4);
    IS(INSIDE, &both, POSITIVE, -0.4);
    IS(OUTSIDE, &both, EVEN_ODD, 0.0);
    IS(INSIDE, &both, NON_ZERO, 0.4);
    IS(INSIDE, &both, EVEN_ODD, 0.4);
    if (inside_out) {
        IS(OUTSIDE, &both, NON_ZERO, 0.0);
        IS(OUTSIDE, &both, POSITIVE, 0.0);
        IS(OUTSIDE, &both, POSITIVE, 0.4);
    } else {
        IS(INSIDE, &both, NON_ZERO, 0.0);
        IS(INSIDE, &both, POSITIVE, 0.0);
        IS(INSIDE, &both, POSITIVE, 0.4);
    }
    (void)agrees(&both, LEAFLESS_FILL_NON_ZERO);
    (void)agrees(&both, LEAFLESS_FILL_EVEN_ODD);
    (void)agrees(&both, LEAFLESS_FILL_POSITIVE);
}

static surface cube(uint32_t which) {
    surface all = {0};
    add_cube(&all, CUBES[which].skew, CUBES[which].low, CUBES[which].edge, false);
    return all;
}

/* A cube with holes, and with inverted facets, under the rules that allow them. */
static void damaged(const surface *closed, uint32_t fill) {
    const uint32_t few = 2 * agrees(closed, LEAFLESS_FILL_EVEN_ODD);
    leafless_octree *even_odd = built(closed, LEAFLESS_FILL_EVEN_ODD, LEAFLESS_RULE_CERTIFIED);
    leafless_octree *octree = built(closed, fill, LEAFLESS_RULE_CERTIFIED);
    surface mesh = *closed;
    uint32_t i;
    /* For a closed body the rules agree. */
    CHECK(check_same(octree, even_odd));
    leafless_octree_free(octree);
    leafless_octree_free(even_odd);
    /* Cells stay open where there is no surface, too, but not many more than it had: without one triangle, without a
       lid, and finally with two triangles only. */
    remove_triangle(&mesh, 3);
    CHECK(agrees(&mesh, fill) < few);
    remove_triangle(&mesh, 2);
    CHECK(agrees(&mesh, fill) < few);
    for (i = 0; i < 8; i++) {
        remove_triangle(&mesh, 0);
        if (i % 2 == 0) {
            (void)agrees(&mesh, fill);
        }
    }
    mesh = *closed;
    turn_over(&mesh, 5);
    turn_over(&mesh, 10);
    (void)agrees(&mesh, fill);
}

int main(void) {
    uint32_t which, fill;
    for (which = 0; which < COUNT(CUBES); which++) {
        const surface closed = cube(which);
        damaged(&closed, LEAFLESS_FILL_NON_ZERO);
        damaged(&closed, LEAFLESS_FILL_POSITIVE);
    }

    /* Far from the hole nothing changes. */
    {
        surface lidless = cube(0);
        remove_triangle(&lidless, 3);
        remove_triangle(&lidless, 2);
        CHECK(at(&lidless, LEAFLESS_FILL_NON_ZERO, 0.5, -0.5, -0.5) == LEAFLESS_MEMBERSHIP_INSIDE);
        CHECK(at(&lidless, LEAFLESS_FILL_NON_ZERO, 0.9, 0.9, -0.9) == LEAFLESS_MEMBERSHIP_OUTSIDE);
    }
    /* All of it inside out is the same solid but where orientation matters. */
    {
        surface inside_out = {0};
        add_cube(&inside_out, CUBES[0].skew, -0.7, 1.4, true);
        IS(INSIDE, &inside_out, NON_ZERO, 0.0);
        IS(INSIDE, &inside_out, EVEN_ODD, 0.0);
        IS(OUTSIDE, &inside_out, POSITIVE, 0.0);
    }
    overlapping(false);
    overlapping(true);

    /* What even-odd needs is refused where it is not there. */
    {
        leafless_mesh *open = check_some_of_cube(11), *none = check_some_of_cube(0);
        leafless_solid *solid = NULL;
        FAILS(LEAFLESS_E_MESH, leafless_solid_from_mesh(open, LEAFLESS_FILL_EVEN_ODD, &solid));
        FAILS(LEAFLESS_E_MESH, leafless_mesh_check_closed(open, LEAFLESS_FILL_NON_ZERO));
        FAILS(LEAFLESS_E_MESH, leafless_mesh_check_closed(open, LEAFLESS_FILL_POSITIVE));
        for (fill = 0; fill < 3; fill++) {
            FAILS(LEAFLESS_E_MESH, leafless_solid_from_mesh(none, fill, &solid));
        }
        CHECK(solid == NULL);
        OK(leafless_solid_from_mesh(open, LEAFLESS_FILL_POSITIVE, &solid));
        leafless_solid_free(solid);
        leafless_mesh_free(open);
        leafless_mesh_free(none);
    }
    return 0;
}
