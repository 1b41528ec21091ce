/* Makes an octree from a mesh in arrays, drills it, saves it, maps it and queries it.
 *
 * include/README.md describes how to build it:
 *
 *     gcc examples/c/voxelise.c -Iinclude target/release/libleafless.a -lgcc_s ... -o voxelise
 */
#include <leafless.h>

#include <stdio.h>

/* A wedge: 6 corners (mm), 8 triangles whose corners turn counter-clockwise as seen from outside. */
static const double CORNERS[6][3] = {{0, 0, 0}, {40, 0, 0}, {0, 30, 0}, {40, 30, 0}, {0, 0, 20}, {0, 30, 20}};
static const uint32_t TRIANGLES[8][3] = {{0, 2, 3}, {0, 3, 1}, {0, 4, 5}, {0, 5, 2},
                                         {1, 3, 5}, {1, 5, 4}, {0, 1, 4}, {2, 5, 3}};

static void print_row(const char *name, const leafless_octree *octree) {
    leafless_statistics all;
    if (leafless_octree_statistics(octree, &all) == LEAFLESS_OK) {
        printf("%-14s %9lu %12.2f %12.2f\n", name, (unsigned long)all.nodes, all.volume_model.lower,
               all.volume_model.upper);
    }
}

int main(void) {
    static const char PATH[] = "wedge.lfl";
    static const char *const ANSWERS[] = {"outside", "inside", "undecided"};
    static const double POINTS[3][3] = {{2, 2, 2}, {12, 15, 6}, {39, 1, 19}};
    const double centre[3] = {12, 15, 8};
    const leafless_mesh_arrays arrays = {.struct_size = sizeof arrays,
                                         .vertices = CORNERS,
                                         .vertex_count = 6,
                                         .indices = TRIANGLES,
                                         .triangle_count = 8};
    leafless_mesh *mesh = NULL;
    leafless_solid *wedge_solid = NULL, *hole_solid = NULL;
    leafless_octree *wedge = NULL, *hole = NULL, *drilled = NULL, *named = NULL, *mapped = NULL;
    const leafless_octree *operands[2];
    leafless_frame frame;
    const leafless_sink file = leafless_to_file(PATH);
    const leafless_source in_place = leafless_from_file(PATH, LEAFLESS_ACCESS_MAP);
    leafless_membership answers[3];
    double min[3], max[3];
    int i, exit_code = 1;

    /* All octrees to combine must have the same frame: here 2^8 cells along the edge of the wedge's cube. */
    if (leafless_mesh_new(&arrays, &mesh) != LEAFLESS_OK ||
        leafless_mesh_bounds(mesh, min, max) != LEAFLESS_OK ||
        leafless_frame_around(min, max, 8, &frame) != LEAFLESS_OK ||
        leafless_solid_from_mesh(mesh, LEAFLESS_FILL_NON_ZERO, &wedge_solid) != LEAFLESS_OK ||
        leafless_solid_new_ball(centre, 5.0, &hole_solid) != LEAFLESS_OK) {
        goto failed;
    }
    if (leafless_octree_build(wedge_solid, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &wedge) != LEAFLESS_OK ||
        leafless_octree_build(hole_solid, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &hole) != LEAFLESS_OK) {
        goto failed;
    }
    operands[0] = wedge, operands[1] = hole;
    if (leafless_octree_combine(LEAFLESS_OPERATION_DIFFERENCE, operands, 2, NULL, &drilled) != LEAFLESS_OK) {
        goto failed;
    }
    printf("%-14s %9s %12s %12s\n", "", "nodes", "volume >=", "volume <=");
    print_row("wedge", wedge);
    print_row("hole", hole);
    print_row("drilled", drilled);

    /* The file consists of the octree's arrays: a mapped file is ready at once, at any size. */
    if (leafless_octree_with_metadata(drilled, "units", 5, "mm", 2, &named) != LEAFLESS_OK ||
        leafless_octree_write(named, &file) != LEAFLESS_OK ||
        leafless_octree_read(&in_place, &mapped) != LEAFLESS_OK ||
        leafless_octree_contains_many(mapped, &POINTS[0][0], 3, answers) != LEAFLESS_OK) {
        goto failed;
    }
    for (i = 0; i < 3; i++) {
        printf("(%g, %g, %g) is %s\n", POINTS[i][0], POINTS[i][1], POINTS[i][2], ANSWERS[answers[i]]);
    }
    exit_code = 0;

failed:
    if (exit_code != 0) {
        char message[512];
        leafless_last_error(message, sizeof message);
        fprintf(stderr, "%s: %s\n", leafless_status_name(leafless_last_status()), message);
    }
    /* In any order; objects that were never made are NULL. */
    leafless_octree_free(mapped);
    leafless_octree_free(named);
    leafless_octree_free(drilled);
    leafless_octree_free(hole);
    leafless_octree_free(wedge);
    leafless_solid_free(hole_solid);
    leafless_solid_free(wedge_solid);
    leafless_mesh_free(mesh);
    return exit_code;
}
