/* A mesh from a scanner: its defects with their positions, and the solid that it encloses in spite of them.
 *
 *     scan [FILE]
 *
 * reads an STL, OBJ, PLY, OFF or 3MF file; without one, it makes a dome of coloured points without a bottom.
 * include/README.md describes how to build it.
 */
#include <leafless.h>

#include <math.h>
#include <stdio.h>

enum { AROUND = 48, UP = 12, DEPTH = 7, WORST = 10 };

/* The output of scanners: a position and a colour. */
typedef struct {
    float place[3];
    uint8_t colour[4];
} point;

/* A triangle, and a label that the library ignores. */
typedef struct {
    uint16_t corners[3];
    uint16_t label;
} facet;

static leafless_status dome(leafless_mesh **mesh) {
    static point points[(UP + 1) * AROUND];
    static facet facets[2 * UP * AROUND];
    leafless_mesh_arrays arrays = {.struct_size = sizeof arrays};
    uint16_t ring, i;
    uint64_t count = 0;
    for (ring = 0; ring <= UP; ring++) {
        for (i = 0; i < AROUND; i++) {
            const double up = 1.5707963 * ring / UP, around = 6.2831853 * i / AROUND;
            /* At the top all points coincide, and every second triangle is degenerate. */
            const double radius = ring < UP ? 50 * cos(up) : 0;
            point *p = &points[ring * AROUND + i];
            p->place[0] = (float)(radius * cos(around));
            p->place[1] = (float)(radius * sin(around));
            p->place[2] = (float)(50 * sin(up));
            p->colour[0] = (uint8_t)(20 * ring);
            if (ring < UP) {
                const uint16_t next = (uint16_t)((i + 1) % AROUND), low = (uint16_t)(ring * AROUND);
                const uint16_t a = (uint16_t)(low + i), b = (uint16_t)(low + next);
                const uint16_t c = (uint16_t)(b + AROUND), d = (uint16_t)(a + AROUND);
                const facet one = {{a, b, c}, 1}, other = {{a, c, d}, 1}, turned = {{a, d, c}, 1};
                /* A dark spot is missing in the scan, and one facet is inverted. */
                if (ring != 6 || i != 10) {
                    facets[count++] = one;
                    facets[count++] = ring == 3 && i == 30 ? turned : other;
                }
            }
        }
    }
    /* The library reads the host's own arrays during this call, and ignores the bytes between elements. */
    arrays.vertices = points[0].place;
    arrays.vertex_type = LEAFLESS_VERTEX_TYPE_F32;
    arrays.vertex_count = sizeof points / sizeof *points;
    arrays.vertex_stride = sizeof *points;
    arrays.indices = facets[0].corners;
    arrays.index_type = LEAFLESS_INDEX_TYPE_U16;
    arrays.triangle_count = count;
    arrays.triangle_stride = sizeof *facets;
    return leafless_mesh_new(&arrays, mesh);
}

static leafless_status print_report(const leafless_mesh *mesh) {
    static const char *const KINDS[] = {"hole", "misoriented", "duplicate", "non-manifold", "flat"};
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    leafless_mesh_defect worst[WORST];
    uint64_t count = 0, i;
    leafless_status s = leafless_mesh_inspect(mesh, &report);
    if (!s) s = leafless_mesh_defects(mesh, WORST, worst, WORST, &count);
    if (s) {
        return s;
    }
#define ROW(name, field) printf("%-22s %10lu\n", name, (unsigned long)report.field)
    ROW("triangles", triangles);
    ROW("vertices", vertices);
    ROW("vertices welded", welded);
    ROW("degenerate triangles", degenerate);
    ROW("flat triangles", flat);
    ROW("duplicate triangles", duplicate);
    ROW("walls of no thickness", opposite);
    ROW("boundary edges", boundary_edges);
    ROW("boundary loops", boundary_loops);
    ROW("misoriented edges", misoriented_edges);
    ROW("non-manifold edges", non_manifold_edges);
    ROW("bodies", bodies);
    ROW("  open", open_bodies);
    ROW("  inside out", inside_out_bodies);
    for (i = 0; i < count; i++) {
        const leafless_mesh_defect *d = &worst[i];
        printf("%-12s of %5lu in [%.4g, %.4g] x [%.4g, %.4g] x [%.4g, %.4g]\n", KINDS[d->kind],
               (unsigned long)d->count, d->min_model[0], d->max_model[0], d->min_model[1], d->max_model[1],
               d->min_model[2], d->max_model[2]);
    }
    return s;
}

int main(int argc, char **argv) {
    leafless_mesh *mesh = NULL;
    leafless_solid *solid = NULL;
    leafless_octree *certified = NULL, *sampled = NULL;
    leafless_statistics bounds, estimate;
    leafless_frame frame;
    double min[3], max[3];
    const leafless_source file = leafless_from_file(argc > 1 ? argv[1] : "", LEAFLESS_ACCESS_COPY);
    leafless_status s = argc > 1 ? leafless_mesh_read(&file, NULL, NULL, &mesh) : dome(&mesh);
    if (!s) s = print_report(mesh);
    /* Around holes a point is inside if the winding number is at least one half. A certified tag holds for each
       point of a cell; near the holes more cells stay undecided than the surface cuts. */
    if (!s) s = leafless_mesh_bounds(mesh, min, max);
    if (!s) s = leafless_frame_around(min, max, DEPTH, &frame);
    if (!s) s = leafless_solid_from_mesh(mesh, LEAFLESS_FILL_NON_ZERO, &solid);
    if (!s) s = leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &certified);
    if (!s) s = leafless_octree_build(solid, &frame, LEAFLESS_RULE_SAMPLED, NULL, &sampled);
    if (!s) s = leafless_octree_statistics(certified, &bounds);
    if (!s) s = leafless_octree_statistics(sampled, &estimate);
    if (s) {
        char message[512];
        leafless_last_error(message, sizeof message);
        fprintf(stderr, "%s\n", message);
    } else {
        printf("volume between %.6g and %.6g, about %.6g; undecided %.3g\n", bounds.volume_model.lower,
               bounds.volume_model.upper, estimate.volume_model.lower,
               bounds.volume_model.upper - bounds.volume_model.lower);
    }
    leafless_octree_free(sampled);
    leafless_octree_free(certified);
    leafless_solid_free(solid);
    leafless_mesh_free(mesh);
    return s != LEAFLESS_OK;
}
