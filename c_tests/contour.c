/* Contours: of a mesh, whose corners they meet, and of a function of the host; what is refused. */
#include "check.h"

static leafless_mesh_report told(const leafless_mesh *mesh) {
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    OK(leafless_mesh_inspect(mesh, &report));
    return report;
}

static double volume_of(const leafless_mesh *mesh) {
    double volume = 0;
    OK(leafless_mesh_volume(mesh, &volume));
    return volume;
}

/* The unit cube as a mesh: few triangles, and vertices in all of its corners. */
static void of_a_mesh(void) {
    const leafless_frame frame = {{-0.25, -0.25, -0.25}, 1.5, 8};
    leafless_contour_report report = LEAFLESS_INIT(leafless_contour_report);
    leafless_mesh *cube = check_cube(), *mesh = NULL;
    leafless_solid *solid = NULL;
    double low[3], high[3];
    int axis;
    OK(leafless_solid_from_mesh(cube, LEAFLESS_FILL_NON_ZERO, &solid));
    OK(leafless_solid_contour(solid, &frame, 0.01, NULL, &report, &mesh));
    CHECK(told(mesh).is_manifold && told(mesh).euler_characteristic == 2);
    CHECK(report.intersecting_pairs == 0 && report.cells > 0 && report.splits > 0 && report.undecided == 0);
    CHECK(told(mesh).triangles < 4000 && fabs(volume_of(mesh) - 1) < 0.01);
    OK(leafless_mesh_bounds(mesh, low, high));
    for (axis = 0; axis < 3; axis++) {
        CHECK(fabs(low[axis]) < 1e-9 && fabs(high[axis] - 1) < 1e-9);
    }
    leafless_mesh_free(mesh);
    leafless_solid_free(solid);
    leafless_mesh_free(cube);
}

/* A function of the host: a ball around the origin. */
typedef struct host {
    double radius;
    int32_t answer; /* if it is not 0, the answer for points */
} host;

static int32_t boxes(void *ctx, const double *min, const double *max) {
    const double radius = ((const host *)ctx)->radius;
    double near = 0, far = 0;
    int axis;
    for (axis = 0; axis < 3; axis++) {
        const double low = min[axis] > 0 ? min[axis] : max[axis] < 0 ? -max[axis] : 0;
        const double high = -min[axis] > max[axis] ? -min[axis] : max[axis];
        near += low * low;
        far += high * high;
    }
    return near > radius * radius * (1 + 1e-12)  ? LEAFLESS_TAG_EMPTY
           : far < radius * radius * (1 - 1e-12) ? LEAFLESS_TAG_FULL
                                                 : LEAFLESS_TAG_PARTIAL;
}

static int32_t points(void *ctx, const double *point) {
    const host *own = (const host *)ctx;
    const double square = point[0] * point[0] + point[1] * point[1] + point[2] * point[2];
    return own->answer != 0 ? own->answer : square < own->radius * own->radius;
}

static void of_a_function(void) {
    const leafless_frame frame = check_frame(7);
    const double ball = 4.0 / 3 * 3.14159265358979323846 * 0.75 * 0.75 * 0.75;
    leafless_contour_report report = LEAFLESS_INIT(leafless_contour_report);
    leafless_solid_callbacks callbacks = LEAFLESS_INIT(leafless_solid_callbacks);
    leafless_options options = LEAFLESS_INIT(leafless_options);
    leafless_control *control = NULL;
    leafless_solid *solid = NULL;
    leafless_mesh *mesh = NULL;
    host own = {0.75, 0};
    callbacks.exterior = LEAFLESS_EXTERIOR_EMPTY;
    callbacks.classify = boxes;
    callbacks.contains = points;
    callbacks.ctx = &own;
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    OK(leafless_solid_contour(solid, &frame, 0.02, NULL, &report, &mesh));
    CHECK(told(mesh).is_manifold && told(mesh).euler_characteristic == 2 && report.undecided == 0);
    CHECK(fabs(volume_of(mesh) - ball) < 0.05 * ball);
    leafless_mesh_free(mesh);
    mesh = NULL;

    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_contour(solid, &frame, 0, NULL, &report, &mesh));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_contour(solid, &frame, NAN, NULL, &report, &mesh));
    own.answer = 7;
    FAILS(LEAFLESS_E_CALLBACK, leafless_solid_contour(solid, &frame, 0.02, NULL, &report, &mesh));
    own.answer = 0;
    options.max_nodes = 3;
    FAILS(LEAFLESS_E_LIMIT, leafless_solid_contour(solid, &frame, 0.02, &options, &report, &mesh));
    OK(leafless_init(&options, sizeof options));
    OK(leafless_control_new(&control));
    OK(leafless_control_cancel(control));
    options.control = control;
    FAILS(LEAFLESS_E_CANCELLED, leafless_solid_contour(solid, &frame, 0.02, &options, &report, &mesh));
    leafless_control_free(control);
    CHECK(mesh == NULL);
    leafless_solid_free(solid);
    /* What goes on outside of the universe has no closed mesh. */
    callbacks.exterior = LEAFLESS_EXTERIOR_UNKNOWN;
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_contour(solid, &frame, 0.02, NULL, &report, &mesh));
    leafless_solid_free(solid);
}

int main(void) {
    of_a_mesh();
    of_a_function();
    return 0;
}
