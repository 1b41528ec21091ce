/* Scenes from files and from memory: their bounds, their solids, files that they name, and what is wrong with texts. */
#include "check.h"

static const leafless_frame frame = {{-4, -4, -4}, 8, 5};

static leafless_scene *scene_of(const char *text) {
    leafless_scene *scene = NULL;
    OK(leafless_scene_from_bytes((const uint8_t *)text, strlen(text), NULL, 0, &scene));
    return scene;
}

/* Takes the scene over. */
static leafless_interval volume_of(leafless_scene *scene) {
    leafless_solid *solid = NULL;
    leafless_octree *octree = NULL;
    leafless_statistics statistics;
    OK(leafless_solid_new_scene(scene, &frame, &solid));
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
    FAILS(LEAFLESS_E_SCENE, leafless_scene_from_bytes((const uint8_t *)text, strlen(text), folder,
                                                      folder == NULL ? 0 : strlen(folder), &scene));
    CHECK(scene == NULL);
    leafless_last_error(message, sizeof message);
    if (strstr(message, words) == NULL) {
        fprintf(stderr, "%s: %s\n", text, message);
        exit(1);
    }
}

int main(void) {
    static const char part[] = "// a block with a hole\n"
                               "difference() {\n"
                               "\tcube(size = [4, 4, 2], center = true);\n"
                               "\tcylinder($fn = 8, h = 3, r1 = 1, r2 = 1, center = true);\n"
                               "}\n";
    const double pi = 3.14159265358979323846;
    double low[3], high[3];
    leafless_scene *scene = NULL, *other = NULL;
    leafless_interval volume;
    leafless_solid *solid = NULL;
    leafless_octree *octree = NULL;
    const char *octree_path = "scene.lfl", *scene_path = "scene.csg";
    const char *naming = "octree(\"scene.lfl\");";

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
    OK(leafless_solid_new_scene(other, &frame, &solid));
    leafless_scene_free(other);
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_SAMPLED, NULL, &octree));
    leafless_solid_free(solid);
    OK(leafless_octree_save(octree, octree_path, strlen(octree_path)));
    leafless_octree_free(octree);
    scene = scene_of("halfspace([1, 0, 0, 0]);");
    FAILS(LEAFLESS_E_ARGUMENT, leafless_scene_bounds(scene, low, high));
    volume = volume_of(scene);
    CHECK(volume.lower == 256 && volume.upper == 256);

    /* Files. */
    OK(leafless_scene_from_bytes((const uint8_t *)naming, strlen(naming), "", 0, &scene));
    volume = volume_of(scene);
    CHECK(fabs(volume.lower - (32 - 2 * pi)) < 1 && volume.upper == volume.lower);
    refused(naming, NULL, "line 1, column 8: ");
    refused("\n octree(\"none.lfl\");", "", "line 2, column 9: none.lfl");
    check_write(scene_path, naming, strlen(naming));
    OK(leafless_scene_open(scene_path, strlen(scene_path), &scene));
    volume = volume_of(scene);
    CHECK(volume.upper == volume.lower);
    FAILS(LEAFLESS_E_IO, leafless_scene_open("none.csg", 8, &scene));
    FAILS(LEAFLESS_E_UTF8, leafless_scene_open("\xff", 1, &scene));
    FAILS(LEAFLESS_E_UTF8, leafless_scene_from_bytes((const uint8_t *)naming, strlen(naming), "\xff", 1, &scene));

    /* Texts. */
    refused("cube(", NULL, "line 1, column 6: ");
    refused("group() {\n  cubus(1);\n}", NULL, "line 2, column 3: unknown call `cubus`");
    refused("hull() { cube(1); }", NULL, "`hull` is not supported");
    refused("cube(1);\n\xff", NULL, "line 2, column 1: the text is not UTF-8");
    return 0;
}
