/* The clearance of two mesh files, as the driver compares it with the program's and with Python's. */
#include "check.h"

static leafless_solid *solid_of(const char *path) {
    leafless_source source = LEAFLESS_INIT(leafless_source);
    leafless_mesh *mesh = NULL;
    leafless_solid *solid = NULL;
    source.path = path;
    source.path_length = strlen(path);
    OK(leafless_mesh_read(&source, NULL, NULL, &mesh));
    OK(leafless_solid_from_mesh(mesh, LEAFLESS_FILL_NON_ZERO, &solid));
    leafless_mesh_free(mesh);
    return solid;
}

int main(int argc, char **argv) {
    const leafless_frame frame = {{-8, -8, -16}, 32, 10};
    leafless_clearance found = LEAFLESS_INIT(leafless_clearance);
    leafless_solid *a, *b;
    CHECK(argc == 3);
    a = solid_of(argv[1]), b = solid_of(argv[2]);
    OK(leafless_solid_clearance(a, b, &frame, 32e-9, NULL, &found));
    printf("%.17g %.17g\n", found.distance_model.lower, found.distance_model.upper);
    leafless_solid_free(a), leafless_solid_free(b);
    return 0;
}
