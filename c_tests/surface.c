/* Surfaces of octrees, volumes and solids: checks of the arrays for closedness, enclosed volume and places of vertices;
   refused calls. */
#include "check.h"

static const double PI = 3.14159265358979323846;

/* A mesh as the host has it. */
typedef struct surface_of {
    uint64_t vertex_count, triangle_count;
    double (*vertices)[3];
    uint32_t (*triangles)[3];
} surface_of;

static surface_of take(const leafless_mesh *mesh) {
    surface_of s;
    OK(check_counts(mesh, &s.vertex_count, &s.triangle_count));
    s.vertices = (double (*)[3])malloc((size_t)s.vertex_count * sizeof *s.vertices + 1);
    s.triangles = (uint32_t (*)[3])malloc((size_t)s.triangle_count * sizeof *s.triangles + 1);
    CHECK(s.vertices != NULL && s.triangles != NULL);
    if (s.triangle_count > 0) {
        FAILS(LEAFLESS_E_BUFFER, leafless_mesh_copy(mesh, s.vertices[0], s.vertex_count - 1, NULL, 0));
        FAILS(LEAFLESS_E_BUFFER, leafless_mesh_copy(mesh, NULL, 0, s.triangles[0], s.triangle_count - 1));
        OK(leafless_mesh_copy(mesh, s.vertices[0], s.vertex_count, s.triangles[0], s.triangle_count));
    }
    return s;
}

static void drop(surface_of *s) {
    free(s->vertices);
    free(s->triangles);
}

static int ascending(const void *a, const void *b) {
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* Directed edges, sorted: every edge is run along as often in one direction as in the other. Returns how many edges
   there are, or 0 if one is met by more than two triangles. */
static uint64_t edges_of(const surface_of *s, bool *is_balanced) {
    const size_t count = 3 * (size_t)s->triangle_count;
    uint64_t *there = (uint64_t *)malloc(8 * count + 1), *back = (uint64_t *)malloc(8 * count + 1);
    bool is_manifold = true;
    size_t i;
    CHECK(there != NULL && back != NULL);
    for (i = 0; i < count; i++) {
        const uint64_t a = s->triangles[i / 3][i % 3], b = s->triangles[i / 3][(i + 1) % 3];
        CHECK(a != b && a < s->vertex_count);
        there[i] = a << 32 | b;
        back[i] = b << 32 | a;
    }
    qsort(there, count, sizeof *there, ascending);
    qsort(back, count, sizeof *back, ascending);
    *is_balanced = memcmp(there, back, 8 * count) == 0;
    for (i = 1; i < count; i++) {
        is_manifold = is_manifold && there[i] != there[i - 1];
    }
    free(there);
    free(back);
    return is_manifold && *is_balanced ? count / 2 : 0;
}

/* Checks the library's report against the arrays. */
static leafless_mesh_report told(const leafless_mesh *mesh) {
    surface_of s = take(mesh);
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    double volume = 0, area = 0, found;
    bool is_balanced;
    uint64_t i, edges = edges_of(&s, &is_balanced);
    int k;
    OK(leafless_mesh_inspect(mesh, &report));
    CHECK(report.is_closed && is_balanced && report.is_manifold == (edges > 0 || s.triangle_count == 0));
    CHECK(report.boundary_edges == 0 && report.misoriented_edges == 0);
    CHECK(report.vertices == s.vertex_count && report.triangles == s.triangle_count);
    CHECK(report.euler_characteristic == (int64_t)(s.vertex_count + s.triangle_count) - (int64_t)report.edges);
    if (edges > 0) {
        CHECK(report.edges == edges);
    }
    for (i = 0; i < s.triangle_count; i++) {
        const double *a = s.vertices[s.triangles[i][0]], *b = s.vertices[s.triangles[i][1]];
        const double *c = s.vertices[s.triangles[i][2]];
        double n[3];
        for (k = 0; k < 3; k++) {
            const int p = (k + 1) % 3, q = (k + 2) % 3;
            n[k] = (b[p] - a[p]) * (c[q] - a[q]) - (b[q] - a[q]) * (c[p] - a[p]);
        }
        volume += (a[0] * n[0] + a[1] * n[1] + a[2] * n[2]) / 6;
        area += sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
        CHECK(n[0] != 0 || n[1] != 0 || n[2] != 0);
    }
    OK(leafless_mesh_volume(mesh, &found));
    CHECK(fabs(found - volume) <= 1e-9 * (1 + fabs(volume)));
    OK(leafless_mesh_area(mesh, &found));
    CHECK(fabs(found - area) <= 1e-9 * (1 + area));
    drop(&s);
    return report;
}

static bool same(const leafless_mesh *a, const leafless_mesh *b) {
    surface_of s = take(a), t = take(b);
    const bool equal = s.vertex_count == t.vertex_count && s.triangle_count == t.triangle_count &&
                       memcmp(s.vertices, t.vertices, (size_t)s.vertex_count * sizeof *s.vertices) == 0 &&
                       memcmp(s.triangles, t.triangles, (size_t)s.triangle_count * sizeof *s.triangles) == 0;
    drop(&s);
    drop(&t);
    return equal;
}

static leafless_surface_options defaults(void) {
    leafless_surface_options surface;
    OK(leafless_init(&surface, sizeof surface));
    return surface;
}

static double volume_of(const leafless_mesh *mesh) {
    double volume;
    OK(leafless_mesh_volume(mesh, &volume));
    return volume;
}

/* Vertices are at multiples of `step` from the frame's origin, `at` of a step beside them. */
static void on_lattice(const leafless_mesh *mesh, double step, double at) {
    surface_of s = take(mesh);
    uint64_t i;
    int axis;
    for (i = 0; i < s.vertex_count; i++) {
        for (axis = 0; axis < 3; axis++) {
            const double place = (s.vertices[i][axis] + 1) / step - at;
            CHECK(place == floor(place));
        }
    }
    drop(&s);
}

/* Normals have components 0, 1 and -1, up to a common factor. */
static void thirteen_directions(const leafless_mesh *mesh) {
    surface_of s = take(mesh);
    uint64_t i;
    int k;
    for (i = 0; i < s.triangle_count; i++) {
        const double *a = s.vertices[s.triangles[i][0]], *b = s.vertices[s.triangles[i][1]];
        const double *c = s.vertices[s.triangles[i][2]];
        double n[3], greatest = 0;
        for (k = 0; k < 3; k++) {
            const int p = (k + 1) % 3, q = (k + 2) % 3;
            n[k] = fabs((b[p] - a[p]) * (c[q] - a[q]) - (b[q] - a[q]) * (c[p] - a[p]));
            greatest = n[k] > greatest ? n[k] : greatest;
        }
        for (k = 0; k < 3; k++) {
            CHECK(n[k] == 0 || n[k] == greatest);
        }
    }
    drop(&s);
}

static void octrees(void) {
    const double ball = 4.0 / 3 * PI * 0.75 * 0.75 * 0.75;
    leafless_octree *sampled = check_ball(6, LEAFLESS_RULE_SAMPLED), *certified = check_ball(6, LEAFLESS_RULE_CERTIFIED);
    leafless_solid *solid = check_ball_solid();
    leafless_surface_options surface = defaults();
    leafless_mesh *mesh = NULL, *other = NULL, *inner = NULL, *outer = NULL;
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    leafless_options options;
    char message[512];
    double area, smooth;
    uint32_t snap;
    OK(leafless_octree_surface(sampled, NULL, NULL, &mesh));
    report = told(mesh);
    CHECK(report.is_manifold && report.bodies == 1 && report.euler_characteristic == 2 && report.degenerate == 0);
    CHECK(report.triangles > 10000);
    CHECK(fabs(volume_of(mesh) - ball) < 0.01 * ball);
    OK(leafless_mesh_area(mesh, &area));
    CHECK(area > 4 * PI * 0.5625 && area < 1.3 * 4 * PI * 0.5625);
    on_lattice(mesh, 1.0 / 64, 0);
    /* The same for any number of threads. */
    OK(leafless_init(&options, sizeof options));
    for (options.threads = 1; options.threads < 4; options.threads++) {
        OK(leafless_octree_surface(sampled, &surface, &options, &other));
        CHECK(same(mesh, other));
        leafless_mesh_free(other);
    }
    /* Undecided cells have no sign. */
    other = NULL;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_surface(certified, NULL, NULL, &other));
    (void)leafless_last_error(message, sizeof message);
    CHECK(strstr(message, "resolve") && strstr(message, "inner") && strstr(message, "outer") && strstr(message, "source"));
    CHECK(other == NULL);
    surface.resolve = LEAFLESS_RESOLVE_INNER;
    OK(leafless_octree_surface(certified, &surface, NULL, &inner));
    surface.resolve = LEAFLESS_RESOLVE_OUTER;
    OK(leafless_octree_surface(certified, &surface, NULL, &outer));
    CHECK(told(inner).is_manifold && told(outer).is_manifold);
    CHECK(volume_of(inner) < ball && ball < volume_of(outer));
    leafless_mesh_free(inner);
    leafless_mesh_free(outer);
    surface.resolve = LEAFLESS_RESOLVE_SOURCE;
    FAILS(LEAFLESS_E_NULL, leafless_octree_surface(certified, &surface, NULL, &other));
    surface.source = solid;
    OK(leafless_octree_surface(certified, &surface, NULL, &other));
    CHECK(same(mesh, other));
    leafless_mesh_free(other);

    /* Surface nets: smoother, hence nearer to the ball in area. Vertices are no place of the lattice. */
    surface = defaults();
    surface.method = LEAFLESS_SURFACE_METHOD_SURFACE_NETS;
    OK(leafless_octree_surface(sampled, &surface, NULL, &other));
    report = told(other);
    CHECK(report.is_manifold && report.bodies == 1 && report.euler_characteristic == 2 && report.degenerate == 0);
    CHECK(fabs(volume_of(other) - ball) < 0.01 * ball);
    OK(leafless_mesh_area(other, &smooth));
    CHECK(smooth > 4 * PI * 0.5625 && smooth < area);
    leafless_mesh_free(other);
    surface.resolve = LEAFLESS_RESOLVE_OUTER;
    OK(leafless_octree_surface(certified, &surface, NULL, &other));
    CHECK(told(other).is_manifold && volume_of(other) > ball);
    leafless_mesh_free(other);

    /* Simple marching cubes: all vertices are centres of cells, all normals have one of 13 directions. */
    for (snap = LEAFLESS_SNAP_FAT; snap <= LEAFLESS_SNAP_THIN; snap++) {
        surface = defaults();
        surface.method = LEAFLESS_SURFACE_METHOD_SIMPLE_MARCHING_CUBES;
        surface.snap = snap;
        OK(leafless_octree_surface(sampled, &surface, NULL, &other));
        report = told(other);
        CHECK(report.bodies == 1 && report.triangles > 5000);
        CHECK((volume_of(other) > volume_of(mesh)) == (snap == LEAFLESS_SNAP_FAT));
        on_lattice(other, 1.0 / 32, 0.5);
        thirteen_directions(other);
        leafless_mesh_free(other);
    }
    leafless_mesh_free(mesh);
    leafless_solid_free(solid);
    leafless_octree_free(sampled);
    leafless_octree_free(certified);
}

static void solids(void) {
    const double radius = 0.75, ball = 4.0 / 3 * PI * radius * radius * radius;
    leafless_solid *solid = check_ball_solid(), *stored = NULL;
    leafless_octree *octree = check_ball(5, LEAFLESS_RULE_SAMPLED);
    leafless_surface_options surface = defaults();
    leafless_frame frame = check_frame(5);
    leafless_mesh *mesh = NULL, *other = NULL, *cut = NULL;
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    leafless_options options;
    double error[2];
    uint64_t i;
    uint32_t k;
    /* Half-way, and where the ball is: second order. */
    OK(leafless_solid_surface(solid, &frame, NULL, NULL, &mesh));
    CHECK(told(mesh).is_manifold);
    on_lattice(mesh, 1.0 / 32, 0);
    leafless_mesh_free(mesh);
    surface.placement = LEAFLESS_VERTEX_PLACEMENT_CROSSING;
    for (k = 0; k < 2; k++) {
        frame.depth = 5 + k;
        OK(leafless_solid_surface(solid, &frame, &surface, NULL, &mesh));
        report = told(mesh);
        CHECK(report.is_manifold && report.bodies == 1 && report.euler_characteristic == 2);
        error[k] = ball - volume_of(mesh);
        CHECK(error[k] > 0 && error[k] < 0.01 * ball);
        leafless_mesh_free(mesh);
    }
    CHECK(error[1] < 0.35 * error[0]);
    OK(leafless_solid_surface(solid, &frame, &surface, NULL, &mesh));
    {
        surface_of s = take(mesh);
        for (i = 0; i < s.vertex_count; i++) {
            const double *p = s.vertices[i];
            CHECK(fabs(sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) - radius) < 1e-11);
        }
        drop(&s);
    }
    OK(leafless_init(&options, sizeof options));
    for (options.threads = 1; options.threads < 3; options.threads++) {
        OK(leafless_solid_surface(solid, &frame, &surface, &options, &other));
        CHECK(same(mesh, other));
        leafless_mesh_free(other);
    }
    leafless_mesh_free(mesh);
    /* Simple marching cubes has vertices at corners. */
    surface = defaults();
    surface.method = LEAFLESS_SURFACE_METHOD_SIMPLE_MARCHING_CUBES;
    OK(leafless_solid_surface(solid, &frame, &surface, NULL, &mesh));
    told(mesh);
    on_lattice(mesh, 1.0 / 32, 0);
    thirteen_directions(mesh);
    leafless_mesh_free(mesh);
    /* What is beyond the universe is cut off there. */
    frame.edge = 1;
    frame.depth = 4;
    surface = defaults();
    surface.placement = LEAFLESS_VERTEX_PLACEMENT_CROSSING;
    OK(leafless_solid_surface(solid, &frame, &surface, NULL, &cut));
    CHECK(told(cut).is_closed);
    CHECK(fabs(volume_of(cut) - ball / 8) < 0.02 * ball);
    leafless_mesh_free(cut);

    /* An octree has samples of its own. */
    mesh = other = NULL;
    OK(leafless_solid_from_octree(octree, &stored));
    FAILS(LEAFLESS_E_FRAME, leafless_solid_surface(stored, &frame, NULL, NULL, &mesh));
    frame.depth = 20;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_surface(solid, &frame, NULL, NULL, &mesh));
    CHECK(mesh == NULL);
    leafless_solid_free(stored);
    leafless_octree_free(octree);
    leafless_solid_free(solid);
}

/* Coplanar shrink: the surface of simple marching cubes with fewer triangles. */
static void shrink(void) {
    leafless_octree *octrees[2] = {check_ball(6, LEAFLESS_RULE_SAMPLED), check_box(6, -0.5, 0.5)};
    leafless_solid *solid = check_ball_solid();
    const leafless_frame frame = check_frame(5);
    leafless_surface_options surface = defaults();
    leafless_mesh *all = NULL, *few = NULL, *again = NULL, *published = NULL;
    leafless_options options;
    uint32_t i, snap;
    OK(leafless_init(&options, sizeof options));
    options.threads = 1;
    for (i = 0; i < 2; i++) {
        for (snap = LEAFLESS_SNAP_FAT; snap <= LEAFLESS_SNAP_THIN; snap++) {
            leafless_mesh_report reports[3] = {LEAFLESS_INIT(leafless_mesh_report), LEAFLESS_INIT(leafless_mesh_report),
                                               LEAFLESS_INIT(leafless_mesh_report)};
            double areas[2];
            surface.snap = snap;
            surface.method = LEAFLESS_SURFACE_METHOD_SIMPLE_MARCHING_CUBES;
            OK(leafless_octree_surface(octrees[i], &surface, NULL, &all));
            surface.method = LEAFLESS_SURFACE_METHOD_SHRINK;
            OK(leafless_octree_surface(octrees[i], &surface, NULL, &few));
            OK(leafless_octree_surface(octrees[i], &surface, &options, &again));
            surface.method = LEAFLESS_SURFACE_METHOD_SHRINK_PUBLISHED;
            OK(leafless_octree_surface(octrees[i], &surface, NULL, &published));
            reports[0] = told(all);
            reports[1] = told(few);
            OK(leafless_mesh_inspect(published, &reports[2]));
            CHECK(same(few, again));
            on_lattice(few, 1.0 / 32, 0.5);
            thirteen_directions(few);
            CHECK(fabs(volume_of(few) - volume_of(all)) < 1e-9 && reports[1].euler_characteristic == 2);
            OK(leafless_mesh_area(all, &areas[0]));
            OK(leafless_mesh_area(few, &areas[1]));
            CHECK(fabs(areas[0] - areas[1]) < 1e-9);
            CHECK(reports[1].triangles < reports[0].triangles && reports[2].triangles < reports[0].triangles);
            CHECK(reports[1].triangles <= reports[2].triangles);
            /* Twelve for a block, and where the cells outside of it are vertices, bevels. */
            CHECK(i == 0 || reports[1].triangles == (snap == LEAFLESS_SNAP_FAT ? 44 : 12));
            leafless_mesh_free(all);
            leafless_mesh_free(few);
            leafless_mesh_free(again);
            leafless_mesh_free(published);
        }
        leafless_octree_free(octrees[i]);
    }
    for (i = LEAFLESS_SURFACE_METHOD_SHRINK; i <= LEAFLESS_SURFACE_METHOD_SHRINK_PUBLISHED; i++) {
        surface = defaults();
        surface.method = i;
        OK(leafless_solid_surface(solid, &frame, &surface, NULL, &few));
        if (i == LEAFLESS_SURFACE_METHOD_SHRINK) {
            CHECK(told(few).is_closed);
            on_lattice(few, 1.0 / 16, 0);
        }
        leafless_mesh_free(few);
    }
    leafless_solid_free(solid);
}

/* Dual contouring keeps the edges and corners of a block, in one call. */
static void sharp(void) {
    const double min[3] = {-0.52, -0.33, -0.71}, max[3] = {0.61, 0.47, 0.29};
    const leafless_frame frame = check_frame(4);
    leafless_surface_options surface = defaults();
    leafless_solid *block = NULL;
    leafless_octree *octree = NULL;
    leafless_mesh *mesh = NULL;
    double low[3], high[3];
    int axis;
    OK(leafless_solid_new_box(min, max, &block));
    surface.method = LEAFLESS_SURFACE_METHOD_DUAL_CONTOURING;
    OK(leafless_solid_surface(block, &frame, &surface, NULL, &mesh));
    CHECK(told(mesh).is_manifold && fabs(volume_of(mesh) - 1.13 * 0.8) < 1e-6);
    OK(leafless_mesh_bounds(mesh, low, high));
    for (axis = 0; axis < 3; axis++) {
        CHECK(fabs(low[axis] - min[axis]) < 1e-6 && fabs(high[axis] - max[axis]) < 1e-6);
    }
    leafless_mesh_free(mesh);
    surface.snap = LEAFLESS_SNAP_THIN;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_surface(block, &frame, &surface, NULL, &mesh));
    surface.snap = LEAFLESS_SNAP_FAT;
    surface.placement = LEAFLESS_VERTEX_PLACEMENT_CROSSING;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_surface(block, &frame, &surface, NULL, &mesh));
    surface.placement = LEAFLESS_VERTEX_PLACEMENT_MIDPOINT;
    OK(leafless_octree_build(block, &frame, LEAFLESS_RULE_SAMPLED, NULL, &octree));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_surface(octree, &surface, NULL, &mesh));
    leafless_octree_free(octree);
    leafless_solid_free(block);
}

/* A mesh's own surface: vertices on its faces, and the faces in planes of the lattice exactly. */
static void meshes(void) {
    leafless_mesh *cube = check_cube(), *mesh = NULL;
    leafless_surface_options surface = defaults();
    leafless_solid *solid = NULL;
    const leafless_frame frame = {{-0.3, -0.3, -0.3}, 1.6, 5};
    double min[3], max[3];
    surface.placement = LEAFLESS_VERTEX_PLACEMENT_CROSSING;
    OK(leafless_solid_from_mesh(cube, LEAFLESS_FILL_NON_ZERO, &solid));
    OK(leafless_solid_surface(solid, &frame, &surface, NULL, &mesh));
    CHECK(told(mesh).is_manifold);
    OK(leafless_mesh_bounds(mesh, min, max));
    CHECK(fabs(min[0]) < 1e-9 && fabs(min[2]) < 1e-9 && fabs(max[1] - 1) < 1e-9);
    CHECK(volume_of(mesh) > 0.95 && volume_of(mesh) < 1);
    leafless_mesh_free(mesh);
    leafless_solid_free(solid);
    leafless_mesh_free(cube);
}

/* Samples of a volume are those of the surface: two voxels that touch in an edge, and one by itself. */
static void volumes(void) {
    static uint8_t samples[4 * 5 * 6];
    leafless_volume_layout layout;
    leafless_volume *volume = NULL;
    leafless_solid *solid = NULL;
    leafless_octree *octree = NULL;
    leafless_surface_options surface = defaults();
    leafless_mesh *mesh = NULL;
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    leafless_frame frame;
    leafless_interval band = {100, INFINITY};
    double d, e;
    samples[0] = 200;
    samples[2 + 4 * (1 + 5 * 1)] = 255;
    samples[3 + 4 * (2 + 5 * 1)] = 128;
    OK(leafless_init(&layout, sizeof layout));
    layout.extents[0] = 4;
    layout.extents[1] = 5;
    layout.extents[2] = 6;
    OK(volume_in_place(&layout, samples, sizeof samples, &volume));
    OK(leafless_volume_frame(volume, &frame));
    CHECK(frame.depth == 3);
    /* Where samples cross 100, and half-way where the grid ends: three octahedra again. */
    OK(leafless_volume_surface(volume, &band, NULL, &mesh));
    report = told(mesh);
    CHECK(report.is_manifold && report.bodies == 3 && report.triangles == 24);
    d = 155.0 / 255, e = 28.0 / 128;
    CHECK(fabs(volume_of(mesh) - 4.0 / 3 * (0.125 + d * d * d) - (0.5 + e) * 2 * e * 2 * e / 6) < 1e-12);
    leafless_mesh_free(mesh);
    band.lower = NAN;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_volume_surface(volume, &band, NULL, &mesh));
    OK(leafless_solid_from_volume(volume, NULL, NULL, &solid));
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &octree));
    OK(leafless_octree_surface(octree, NULL, NULL, &mesh));
    report = told(mesh);
    /* Inside voxels hang together by faces alone: three octahedra, of half an edge from centre to corner. */
    CHECK(report.is_manifold && report.bodies == 3 && report.triangles == 24 && report.euler_characteristic == 6);
    CHECK(fabs(volume_of(mesh) - 3 * 4.0 / 3 * 0.125) < 1e-12);
    leafless_mesh_free(mesh);
    /* One cell thick, they have no thickness. */
    surface.method = LEAFLESS_SURFACE_METHOD_SIMPLE_MARCHING_CUBES;
    surface.snap = LEAFLESS_SNAP_THIN;
    OK(leafless_octree_surface(octree, &surface, NULL, &mesh));
    CHECK(told(mesh).triangles == 0);
    leafless_mesh_free(mesh);
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    leafless_volume_free(volume);
}

static void surface_refused(const leafless_octree *octree, const leafless_solid *solid, const leafless_frame *frame,
                            const leafless_surface_options *surface, const char *field, bool of_octree, bool of_solid) {
    leafless_mesh *mesh = NULL;
    char message[512];
    if (of_octree) {
        FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_surface(octree, surface, NULL, &mesh));
        (void)leafless_last_error(message, sizeof message);
        CHECK(strstr(message, field) != NULL);
    }
    if (of_solid) {
        FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_surface(solid, frame, surface, NULL, &mesh));
        (void)leafless_last_error(message, sizeof message);
        CHECK(strstr(message, field) != NULL);
    }
    CHECK(mesh == NULL);
}

static void refusals(void) {
    leafless_octree *octree = check_ball(4, LEAFLESS_RULE_SAMPLED);
    leafless_solid *solid = check_ball_solid();
    const leafless_frame frame = check_frame(4);
    leafless_surface_options surface;
    leafless_options options;
    leafless_control *control = NULL;
    leafless_mesh *mesh = NULL;
    uint32_t size;
#define REFUSED(field, value, of_octree, of_solid)                                                               \
    surface.field = value;                                                                                       \
    surface_refused(octree, solid, &frame, &surface, "surface." #field, of_octree, of_solid);                    \
    surface = defaults()
    surface = defaults();
    REFUSED(method, 6, true, true);
    REFUSED(method, LEAFLESS_SURFACE_METHOD_SURFACE_NETS, false, true);
    REFUSED(method, LEAFLESS_SURFACE_METHOD_DUAL_CONTOURING, true, false);
    REFUSED(method, UINT32_MAX, true, true);
    REFUSED(snap, 2, true, true);
    REFUSED(snap, LEAFLESS_SNAP_THIN, true, true);
    REFUSED(resolve, 4, true, true);
    REFUSED(resolve, LEAFLESS_RESOLVE_INNER, false, true);
    REFUSED(source, solid, true, true);
    REFUSED(placement, 2, true, true);
    REFUSED(placement, LEAFLESS_VERTEX_PLACEMENT_CROSSING, true, false);
    REFUSED(reserved, 1, true, true);
    surface.method = LEAFLESS_SURFACE_METHOD_SIMPLE_MARCHING_CUBES;
    REFUSED(placement, LEAFLESS_VERTEX_PLACEMENT_CROSSING, true, true);
    surface.method = LEAFLESS_SURFACE_METHOD_SHRINK;
    REFUSED(placement, LEAFLESS_VERTEX_PLACEMENT_CROSSING, true, true);
    surface.method = LEAFLESS_SURFACE_METHOD_SURFACE_NETS;
    REFUSED(snap, LEAFLESS_SNAP_THIN, true, true);
    surface.method = LEAFLESS_SURFACE_METHOD_SIMPLE_MARCHING_CUBES;
    REFUSED(snap, 7, true, true);
    /* Older programs have shorter structs. */
    for (size = 8; size <= sizeof surface; size += 8) {
        memset(&surface, 0xee, sizeof surface);
        OK(leafless_init(&surface, size));
        OK(leafless_octree_surface(octree, &surface, NULL, &mesh));
        leafless_mesh_free(mesh);
        OK(leafless_solid_surface(solid, &frame, &surface, NULL, &mesh));
        leafless_mesh_free(mesh);
    }
    mesh = NULL;
    surface = defaults();
    for (size = 0; size < 8; size++) {
        surface.struct_size = size;
        FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_surface(octree, &surface, NULL, &mesh));
    }
    OK(leafless_control_new(&control));
    OK(leafless_control_cancel(control));
    OK(leafless_init(&options, sizeof options));
    options.control = control;
    FAILS(LEAFLESS_E_CANCELLED, leafless_octree_surface(octree, NULL, &options, &mesh));
    FAILS(LEAFLESS_E_CANCELLED, leafless_solid_surface(solid, &frame, NULL, &options, &mesh));
    OK(leafless_init(&options, sizeof options));
    options.max_nodes = 1;
    FAILS(LEAFLESS_E_LIMIT, leafless_solid_surface(solid, &frame, NULL, &options, &mesh));
    CHECK(mesh == NULL);
    leafless_control_free(control);
    leafless_solid_free(solid);
    leafless_octree_free(octree);
    /* Nothing has no surface. */
    OK(leafless_octree_new_uniform(&frame, LEAFLESS_TAG_EMPTY, LEAFLESS_TAG_EMPTY, &octree));
    OK(leafless_octree_surface(octree, NULL, NULL, &mesh));
    CHECK(told(mesh).triangles == 0);
    leafless_mesh_free(mesh);
    leafless_octree_free(octree);
}

/* What is known of a boundary, and its mesh. */
static leafless_mesh *mesh_of(const leafless_boundary *boundary, leafless_boundary_report *report) {
    leafless_mesh *mesh = NULL;
    OK(leafless_init(report, sizeof *report));
    OK(leafless_boundary_describe(boundary, report));
    OK(leafless_boundary_mesh(boundary, &mesh));
    return mesh;
}

/* The faces of a plate of 80 x 60 x 10 with a bore of radius 5 upwards through (40, 30, 0). */
static void faces(const leafless_boundary *boundary, const leafless_boundary_report *report, double volume) {
    leafless_boundary_surface surfaces[9];
    leafless_boundary_region regions[7];
    leafless_polyhedron_arrays arrays = LEAFLESS_INIT(leafless_polyhedron_arrays);
    leafless_mesh_write_options options = LEAFLESS_INIT(leafless_mesh_write_options);
    leafless_mesh *mesh = NULL;
    const uint32_t *face_offsets;
    uint32_t *of_triangles;
    uint8_t *bytes;
    uint64_t count = 0, length = 0, holes = 0, triangles = 0, planes = 0, i;
    double deviation;
    leafless_sink sink = leafless_to_buffer(NULL, 0, &length);
    leafless_source source;

    /* The two ends of the bore bound nothing. */
    CHECK(report->surfaces == 9 && report->regions == 7);
    OK(leafless_boundary_surfaces(boundary, NULL, 0, &count));
    CHECK(count == 9);
    FAILS(LEAFLESS_E_BUFFER, leafless_boundary_surfaces(boundary, surfaces, 8, &count));
    OK(leafless_boundary_surfaces(boundary, surfaces, 9, &count));
    FAILS(LEAFLESS_E_BUFFER, leafless_boundary_regions(boundary, regions, 6, &count));
    OK(leafless_boundary_regions(boundary, regions, 7, &count));
    CHECK(count == 7);
    OK(leafless_boundary_peek_faces(boundary, &arrays));
    CHECK(arrays.face_count == report->faces && arrays.shell_count == 1 && arrays.solid_count == 1);
    face_offsets = (const uint32_t *)arrays.faces;
    for (i = 0; i < 7; i++) {
        const leafless_boundary_region *region = &regions[i];
        const leafless_boundary_surface *surface = &surfaces[region->surface];
        const double *n = surface->direction;
        CHECK(region->first_face == (i == 0 ? 0 : regions[i - 1].first_face + regions[i - 1].face_count));
        triangles += region->triangle_count;
        if (surface->kind == LEAFLESS_SURFACE_KIND_PLANE) {
            const double size = (n[0] != 0 ? 80 : 0) + (n[1] != 0 ? 60 : 0) + (n[2] != 0 ? 10 : 0);
            CHECK(region->face_count == 1 && !region->is_turned);
            CHECK(fabs(n[0]) + fabs(n[1]) + fabs(n[2]) == 1);
            CHECK(surface->offset_model == (n[0] + n[1] + n[2] < 0 ? 0 : size));
            holes += face_offsets[region->first_face + 1] - face_offsets[region->first_face] - 1;
            planes++;
        } else {
            CHECK(surface->kind == LEAFLESS_SURFACE_KIND_CYLINDER && region->is_turned);
            CHECK(fabs(surface->radius_model - 5) < 1e-14 && fabs(n[2]) == 1);
            CHECK(fabs(surface->point_model[0] - 40) < 1e-12 && fabs(surface->point_model[1] - 30) < 1e-12);
            CHECK(region->face_count == region->triangle_count);
            CHECK(fabs(region->area_model - 100 * 3.14159265358979323846) < 0.5);
        }
    }
    CHECK(planes == 6 && holes == 2);
    OK(leafless_boundary_triangle_regions(boundary, NULL, 0, &count));
    CHECK(count == triangles);
    of_triangles = (uint32_t *)malloc((size_t)count * sizeof *of_triangles);
    CHECK(of_triangles != NULL);
    FAILS(LEAFLESS_E_BUFFER, leafless_boundary_triangle_regions(boundary, of_triangles, count - 1, &count));
    OK(leafless_boundary_triangle_regions(boundary, of_triangles, count, &count));
    for (i = 0; i < count; i++) {
        CHECK(of_triangles[i] < 7 && regions[of_triangles[i]].triangle_count-- > 0);
    }
    free(of_triangles);

    /* The faces are a polyhedron, and a file of polygons. */
    OK(leafless_mesh_from_polyhedron(&arrays, &deviation, &mesh));
    CHECK(fabs(volume_of(mesh) - volume) < 1e-8);
    leafless_mesh_free(mesh);
    options.format = LEAFLESS_MESH_FORMAT_OBJ;
    OK(leafless_mesh_write_polygons(&arrays, &options, &sink));
    bytes = (uint8_t *)malloc((size_t)length);
    CHECK(bytes != NULL && length > 0);
    sink = leafless_to_buffer(bytes, length, &length);
    OK(leafless_mesh_write_polygons(&arrays, &options, &sink));
    source = leafless_from_bytes(bytes, length, LEAFLESS_ACCESS_COPY);
    OK(leafless_mesh_read(&source, NULL, NULL, &mesh));
    CHECK(fabs(volume_of(mesh) - volume) < 1e-8 && told(mesh).is_closed);
    leafless_mesh_free(mesh);
    free(bytes);
    options.format = LEAFLESS_MESH_FORMAT_STL;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_mesh_write_polygons(&arrays, &options, &sink));
    options.format = LEAFLESS_MESH_FORMAT_ANY;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_mesh_write_polygons(&arrays, &options, &sink));
    options.format = LEAFLESS_MESH_FORMAT_OFF;
    arrays.tolerance_model = 1;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_mesh_write_polygons(&arrays, &options, &sink));
    arrays.tolerance_model = 0;
    arrays.face_count--;
    FAILS(LEAFLESS_E_MESH, leafless_mesh_write_polygons(&arrays, &options, &sink));
}

/* Every kind of surface, with its numbers. */
static void kinds(void) {
    const leafless_frame frame = {{-50, -50, -50}, 128, 12};
    const double at[3] = {1, 2, 3}, to[3] = {1, 2, 7}, up[3] = {0, 0, 2}, radii[3] = {3, 4, 5};
    const uint32_t expected[4] = {LEAFLESS_SURFACE_KIND_BALL, LEAFLESS_SURFACE_KIND_CONE, LEAFLESS_SURFACE_KIND_TORUS,
                                  LEAFLESS_SURFACE_KIND_QUADRIC};
    leafless_solid *shapes[4] = {NULL, NULL, NULL, NULL};
    size_t i;
    OK(leafless_solid_new_ball(at, 4, &shapes[0]));
    OK(leafless_solid_new_frustum(at, to, 3, 1, &shapes[1]));
    OK(leafless_solid_new_torus(at, up, 5, 1, &shapes[2]));
    OK(leafless_solid_new_ellipsoid(at, radii, NULL, &shapes[3]));
    for (i = 0; i < 4; i++) {
        leafless_boundary *boundary = NULL;
        leafless_boundary_surface surfaces[8], found;
        uint64_t count = 0, k;
        OK(leafless_solid_boundary(shapes[i], &frame, 0.5, NULL, &boundary));
        OK(leafless_boundary_surfaces(boundary, surfaces, 8, &count));
        memset(&found, 0, sizeof found);
        for (k = 0; k < count; k++) {
            if (surfaces[k].kind != LEAFLESS_SURFACE_KIND_PLANE) {
                CHECK((uint32_t)surfaces[k].kind == expected[i]);
                found = surfaces[k];
            }
        }
        CHECK(found.kind != LEAFLESS_SURFACE_KIND_OTHER);
        if (i < 3) {
            CHECK(fabs(found.point_model[0] - 1) < 1e-12 && fabs(found.point_model[1] - 2) < 1e-12);
            CHECK(fabs(found.point_model[2] - (i == 1 ? 9 : 3)) < 1e-12);
        }
        CHECK(i == 0 || i == 3 || fabs(found.direction[2]) == 1);
        CHECK(fabs(found.radius_model - (i == 0 ? 4 : i == 2 ? 5 : 0)) < 1e-12);
        CHECK(fabs(found.minor_model - (i == 2 ? 1 : 0)) < 1e-12);
        CHECK(i != 1 || fabs(tan(found.half_angle_radians) - 0.5) < 1e-12);
        /* (x - 1)² / 9 + (y - 2)² / 16 + (z - 3)² / 25 = 1. */
        if (i == 3) {
            const double *c = found.coefficients;
            CHECK(fabs(c[0] / c[1] - 16.0 / 9) < 1e-12 && fabs(c[0] / c[2] - 25.0 / 9) < 1e-12 && c[0] < 0);
            CHECK(c[3] == 0 && c[4] == 0 && c[5] == 0 && fabs(c[6] / c[0] + 2) < 1e-12);
        }
        leafless_boundary_free(boundary);
        leafless_solid_free(shapes[i]);
    }
}

/* A block with a hole: plane faces between their corners, a wall in chords. */
static void boundaries(void) {
    const double low[3] = {0, 0, 0}, high[3] = {80, 60, 10};
    const double from[3] = {40, 30, -1}, to[3] = {40, 30, 11};
    const leafless_frame frame = {{-10, -20, -45}, 100, 14};
    const double pi = 3.14159265358979323846;
    leafless_solid *block = NULL, *bore = NULL, *plate = NULL;
    leafless_boundary *boundary = NULL, *reference = NULL;
    leafless_mesh *mesh = NULL;
    leafless_boundary_report report;
    OK(leafless_solid_new_box(low, high, &block));
    OK(leafless_solid_boundary(block, &frame, 1, NULL, &boundary));
    mesh = mesh_of(boundary, &report);
    CHECK(report.intersecting_pairs == 0 && report.cells >= 8 && report.splits > 0);
    CHECK(report.deviation_model >= 0 && report.deviation_model < 1e-9);
    CHECK(report.faces == 6 && report.regions == 6 && report.surfaces == 6);
    OK(leafless_boundary_ref(boundary, &reference));
    CHECK(reference == boundary);
    leafless_boundary_free(boundary);
    leafless_boundary_free(reference);
    leafless_boundary_free(NULL);
    CHECK(told(mesh).triangles == 12 && told(mesh).vertices == 8);
    CHECK(fabs(volume_of(mesh) - 48000) < 1e-9);
    leafless_mesh_free(mesh);
    OK(leafless_solid_new_cylinder(from, to, 5, &bore));
    {
        const leafless_solid *both[2];
        both[0] = block;
        both[1] = bore;
        OK(leafless_solid_combine(LEAFLESS_OPERATION_DIFFERENCE, both, 2, &plate));
    }
    OK(leafless_solid_boundary(plate, &frame, 0.008, NULL, &boundary));
    mesh = mesh_of(boundary, &report);
    CHECK(report.deviation_model > 0.001 && report.deviation_model <= 0.008);
    CHECK(report.intersecting_pairs == 0 && told(mesh).is_manifold && told(mesh).euler_characteristic == 0);
    CHECK(told(mesh).triangles < 1500 && fabs(volume_of(mesh) - (48000 - 250 * pi)) < 1);
    faces(boundary, &report, volume_of(mesh));
    leafless_mesh_free(mesh);
    leafless_boundary_free(boundary);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_boundary(plate, &frame, 0, NULL, &boundary));
    {
        leafless_frame small = frame;
        small.edge = 50;
        FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_boundary(plate, &small, 1, NULL, &boundary));
    }
    leafless_solid_free(plate);
    leafless_solid_free(bore);
    leafless_solid_free(block);
}

int main(void) {
    boundaries();
    kinds();
    octrees();
    solids();
    shrink();
    sharp();
    meshes();
    volumes();
    refusals();
    return 0;
}
