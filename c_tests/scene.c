/* Scenes from files and from memory: their bounds, their solids, files that they name, and errors in texts. */
#include "check.h"

static const leafless_frame frame = {{-4, -4, -4}, 8, 5};

static leafless_scene *scene_of(const char *text) {
    leafless_scene *scene = NULL;
    OK(scene_from_text(text, NULL, LEAFLESS_FACETS_AUTO, &scene));
    return scene;
}

/* Takes the scene over. */
static leafless_interval volume_of(leafless_scene *scene) {
    leafless_solid *solid = NULL;
    leafless_octree *octree = NULL;
    leafless_statistics statistics;
    OK(leafless_solid_from_scene(scene, &frame, &solid));
    leafless_scene_free(scene);
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &octree));
    leafless_solid_free(solid);
    OK(leafless_octree_statistics(octree, &statistics));
    leafless_octree_free(octree);
    return statistics.volume_model;
}

static void refused(const char *text, const char *folder, const char *words) {
    char message[512];
    leafless_scene *scene = NULL;
    FAILS(LEAFLESS_E_SCENE, scene_from_text(text, folder, LEAFLESS_FACETS_AUTO, &scene));
    CHECK(scene == NULL);
    leafless_last_error(message, sizeof message);
    if (strstr(message, words) == NULL) {
        fprintf(stderr, "%s: %s\n", text, message);
        exit(1);
    }
}

/* Options, and the report about a scene. */
static void reports(void) {
    static const char text[] = "cylinder($fn = 6, h = 4, r = 2);\n"
                               " polyhedron([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]], "
                               "[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 3, 2]]);";
    const uint64_t polygons[] = {1, 0, 1};
    const uint32_t facets[] = {LEAFLESS_FACETS_AUTO, LEAFLESS_FACETS_EXACT, LEAFLESS_FACETS_POLYGON};
    const leafless_source nothing = leafless_from_bytes(NULL, 0, LEAFLESS_ACCESS_COPY);
    leafless_scene_options options;
    leafless_scene_info report = LEAFLESS_INIT(leafless_scene_info);
    leafless_scene_mesh_info mesh = LEAFLESS_INIT(leafless_scene_mesh_info);
    leafless_mesh_report of_mesh = LEAFLESS_INIT(leafless_mesh_report);
    leafless_scene *scene = NULL;
    uint64_t length = 7;
    size_t i;
    uint8_t name[8];
    OK(leafless_init(&options, sizeof options));
    CHECK(options.struct_size == sizeof options && options.facets == LEAFLESS_FACETS_AUTO);
    for (i = 0; i < 3; i++) {
        OK(scene_from_text(text, NULL, facets[i], &scene));
        OK(leafless_scene_describe(scene, &report));
        CHECK(report.polygons == polygons[i] && report.exact == 1 - polygons[i] && report.ignored_slices == 0);
        CHECK(report.meshes == 1 && !report.is_empty);
        OK(leafless_scene_describe_mesh_at(scene, 0, &mesh, &of_mesh));
        CHECK(mesh.line == 2 && mesh.column == 2 && mesh.turned == 1);
        CHECK(of_mesh.triangles == 4 && of_mesh.misoriented_edges == 3 && of_mesh.boundary_edges == 0);
        FAILS(LEAFLESS_E_ARGUMENT, leafless_scene_describe_mesh_at(scene, 1, &mesh, NULL));
        OK(leafless_scene_mesh_file_at(scene, 0, NULL, 0, &length));
        CHECK(length == 0);
        FAILS(LEAFLESS_E_ARGUMENT, leafless_scene_mesh_file_at(scene, 1, NULL, 0, &length));
        leafless_scene_free(scene);
    }
    FAILS(LEAFLESS_E_ARGUMENT, scene_from_text(text, NULL, 3, &scene));
    OK(leafless_scene_read(&nothing, NULL, &scene));
    OK(leafless_scene_describe(scene, &report));
    CHECK(report.is_empty && report.meshes == 0);
    leafless_scene_free(scene);
    /* A mesh file. */
    check_write("t.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", 36);
    check_write("mesh.csg", "mesh(\"t.off\");", 14);
    OK(scene_open("mesh.csg", 8, NULL, &scene));
    OK(leafless_scene_describe_mesh_at(scene, 0, &mesh, &of_mesh));
    CHECK(mesh.line == 1 && mesh.column == 1 && of_mesh.boundary_edges == 3);
    FAILS(LEAFLESS_E_BUFFER, leafless_scene_mesh_file_at(scene, 0, name, 4, &length));
    OK(leafless_scene_mesh_file_at(scene, 0, name, sizeof name, &length));
    CHECK(length == 5 && memcmp(name, "t.off", 5) == 0);
    leafless_scene_free(scene);
}

int main(void) {
    static const char part[] = "// a block with a hole\n"
                               "difference() {\n"
                               "\tcube(size = [4, 4, 2], center = true);\n"
                               "\tcylinder($fn = 80, h = 3, r1 = 1, r2 = 1, center = true);\n"
                               "}\n";
    const double pi = 3.14159265358979323846;
    double low[3], high[3];
    leafless_scene *scene = NULL, *other = NULL;
    leafless_interval volume;
    leafless_solid *solid = NULL;
    leafless_octree *octree = NULL;
    const char *octree_path = "scene.lfl", *scene_path = "scene.csg";
    const char *naming = "octree(\"scene.lfl\");";

    reports();
    volume = volume_of(scene_of(part));
    CHECK(volume.lower <= 32 - 2 * pi && 32 - 2 * pi <= volume.upper && volume.upper - volume.lower < 8);
    volume = volume_of(scene_of("cube(2);"));
    CHECK(volume.lower == 8 && volume.upper == 8);
    volume = volume_of(scene_of(""));
    CHECK(volume.lower == 0 && volume.upper == 0);

    /* A reference more, and bounds. */
    scene = scene_of(part);
    OK(leafless_scene_ref(scene, &other));
    leafless_scene_free(scene);
    OK(leafless_scene_bounds(other, low, high));
    CHECK(low[0] == -2 && low[1] == -2 && low[2] == -1 && high[0] == 2 && high[1] == 2 && high[2] == 1);
    OK(leafless_solid_from_scene(other, &frame, &solid));
    leafless_scene_free(other);
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_SAMPLED, NULL, &octree));
    leafless_solid_free(solid);
    OK(octree_save(octree, octree_path, strlen(octree_path)));
    leafless_octree_free(octree);
    scene = scene_of("halfspace([1, 0, 0, 0]);");
    FAILS(LEAFLESS_E_ARGUMENT, leafless_scene_bounds(scene, low, high));
    volume = volume_of(scene);
    CHECK(volume.lower == 256 && volume.upper == 256);

    /* Files. */
    OK(scene_from_text(naming, "", LEAFLESS_FACETS_AUTO, &scene));
    volume = volume_of(scene);
    CHECK(fabs(volume.lower - (32 - 2 * pi)) < 1 && volume.upper == volume.lower);
    refused(naming, NULL, "line 1, column 8: ");
    refused("\n octree(\"none.lfl\");", "", "line 2, column 9: none.lfl");
    check_write(scene_path, naming, strlen(naming));
    OK(scene_open(scene_path, strlen(scene_path), NULL, &scene));
    volume = volume_of(scene);
    CHECK(volume.upper == volume.lower);
    FAILS(LEAFLESS_E_IO, scene_open("none.csg", 8, NULL, &scene));
    FAILS(LEAFLESS_E_UTF8, scene_open("\xff", 1, NULL, &scene));
    FAILS(LEAFLESS_E_UTF8, scene_from_text(naming, "\xff", LEAFLESS_FACETS_AUTO, &scene));

    /* Texts. */
    refused("cube(", NULL, "line 1, column 6: ");
    refused("group() {\n  cubus(1);\n}", NULL, "line 2, column 3: unknown call `cubus`");
    refused("hull() { cube(1); }", NULL, "`hull` is not supported");
    refused("cube(1);\n\xff", NULL, "line 2, column 1: the text is not UTF-8");
    return 0;
}
