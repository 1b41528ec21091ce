/* A ball end mill runs along a spiral and mills a pocket into a block. The block is stored as intervals along rays of
 * three directions, and is cut in place, step by step.
 *
 *     dexel_cuts [FILE.stl]
 *
 * include/README.md describes how to build it.
 */
#include <leafless.h>

#include <math.h>
#include <stdio.h>

enum { DEPTH = 8, STEPS = 300 };

static const double RADIUS = 4, TOP = 20;

/* Returns the centre of the mill at a step: from the middle outward, deeper at each step. */
static void place(int step, double *centre) {
    const double t = (double)step / STEPS, angle = 8 * 2 * 3.14159265358979 * t;
    centre[0] = 22 * t * cos(angle);
    centre[1] = 22 * t * sin(angle);
    centre[2] = TOP - 6 * t;
}

/* Subtracts the mill at one position and adds the removed volume to the sum. Only rays through the mill are visited. */
static leafless_status cut(leafless_tridexel_editor *part, int step, double *removed) {
    leafless_dexel_change change = LEAFLESS_INIT(leafless_dexel_change);
    double centre[3];
    leafless_solid *mill = NULL;
    leafless_status s;
    place(step, centre);
    s = leafless_solid_new_ball(centre, RADIUS, &mill);
    if (!s) s = leafless_tridexel_editor_combine_solid(part, LEAFLESS_OPERATION_DIFFERENCE, mill, NULL, &change);
    if (!s) *removed += change.removed_model[2];
    leafless_solid_free(mill);
    return s;
}

/* Prints statistics along each axis. The volumes agree within the resolution of the rays. */
static leafless_status print_model(const char *name, const leafless_tridexel *model) {
    leafless_tridexel_info info = LEAFLESS_INIT(leafless_tridexel_info);
    leafless_dexel_statistics along = LEAFLESS_INIT(leafless_dexel_statistics);
    uint32_t axis;
    leafless_status s = leafless_tridexel_describe(model, &info);
    if (!s) {
        printf("%-6s %7lu intervals, %lu bytes\n", name, (unsigned long)info.interval_count, (unsigned long)info.bytes);
    }
    for (axis = 0; !s && axis < 3; axis++) {
        s = leafless_tridexel_statistics(model, axis, &along);
        if (!s) {
            printf("    along %c: %6lu rays, volume %.1f mm3\n", "xyz"[axis], (unsigned long)along.rays,
                   along.volume_model);
        }
    }
    return s;
}

/* Prints the height of the part above some points of the x axis: the end of the last interval along z. */
static leafless_status print_heights(const leafless_tridexel *model) {
    leafless_tridexel_info info = LEAFLESS_INIT(leafless_tridexel_info);
    double x;
    leafless_status s = leafless_tridexel_describe(model, &info);
    for (x = -30; !s && x <= 30; x += 10) {
        const double cell = info.frame.edge / (1 << DEPTH);
        uint32_t ray[2];
        leafless_dexel dexels[8];
        uint64_t count = 0;
        ray[0] = (uint32_t)((x - info.frame.origin[0]) / cell);
        ray[1] = (uint32_t)((0 - info.frame.origin[1]) / cell);
        s = leafless_tridexel_ray(model, 2, ray, dexels, 8, &count);
        if (!s && count > 0) {
            printf("x = %3.0f: height %7.4f mm\n", x, dexels[count - 1].end.at_model);
        }
    }
    return s;
}

int main(int argc, char **argv) {
    const double low[3] = {-32, -32, 0}, high[3] = {32, 32, 20};
    /* Rays 0.375 mm apart, from each side. */
    const leafless_frame frame = {{-48, -48, -48}, 96, DEPTH};
    /* With normals, edges of the part stay sharp in its surface. */
    const leafless_tridexel_format format = {.struct_size = sizeof format, .normals = LEAFLESS_DEXEL_NORMALS_32};
    leafless_solid *box = NULL;
    leafless_tridexel *block = NULL, *part = NULL, *chips = NULL;
    leafless_tridexel_editor *editor = NULL;
    double removed = 0;
    int step;
    leafless_status s = leafless_solid_new_box(low, high, &box);
    if (!s) s = leafless_tridexel_build(box, &frame, LEAFLESS_RULE_SAMPLED, &format, NULL, &block);
    if (!s) s = leafless_tridexel_editor_new(block, &editor);
    for (step = 0; !s && step <= STEPS; step++) {
        s = cut(editor, step, &removed);
    }
    if (!s) s = leafless_tridexel_editor_freeze(editor, NULL, &part);
    if (!s) {
        const leafless_tridexel *const operands[] = {block, part};
        s = leafless_tridexel_combine(LEAFLESS_OPERATION_DIFFERENCE, operands, 2, NULL, &chips);
    }
    if (!s) s = print_model("block", block);
    if (!s) s = print_model("part", part);
    if (!s) s = print_model("chips", chips);
    if (!s) printf("removed in %d steps: %.1f mm3 along z\n", STEPS + 1, removed);
    if (!s) s = print_heights(part);
    if (!s && argc > 1) {
        const leafless_sink file = leafless_to_file(argv[1]);
        leafless_mesh *mesh = NULL;
        s = leafless_tridexel_surface(part, LEAFLESS_DEXEL_SURFACE_METHOD_DUAL_CONTOURING, NULL, NULL, &mesh);
        if (!s) s = leafless_mesh_write(mesh, NULL, &file);
        leafless_mesh_free(mesh);
    }
    if (s) {
        char message[512];
        leafless_last_error(message, sizeof message);
        fprintf(stderr, "%s: %s\n", leafless_status_name(s), message);
    }
    leafless_tridexel_editor_free(editor);
    leafless_tridexel_free(chips), leafless_tridexel_free(part), leafless_tridexel_free(block);
    leafless_solid_free(box);
    return s ? 1 : 0;
}
