/* What meshes bear: colours of a PLY file, parts of a polyhedron, bodies, and values of the host; at the nearest point of
   the surface, and in a channel. */
#include "check.h"

static const char PLY[] = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                          "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\n"
                          "property list uchar int vertex_indices\nend_header\n"
                          "0 0 0 0 7 7\n8 0 0 0 7 7\n8 8 0 240 7 7\n0 8 0 240 7 7\n3 0 1 2\n3 0 2 3\n";

static void colours(void) {
    leafless_mesh_file_info found = LEAFLESS_INIT(leafless_mesh_file_info);
    leafless_mesh *mesh;
    leafless_attribute *colour;
    leafless_channel *channel;
    leafless_channel_fill_options fill;
    const leafless_frame frame = {{0, 0, -4}, 8, 3};
    const char *name;
    size_t length;
    uint64_t count, number = 0;
    uint32_t components;
    bool per_corner;
    double values[24], at[2][4];
    const double points[2][3] = {{4, 2, 3}, {1, 6, -1}};
    OK(mesh_from_bytes((const uint8_t *)PLY, sizeof PLY - 1, NULL, &found, &mesh));
    OK(leafless_mesh_peek_attribute_at(mesh, 9, &count, NULL, NULL, NULL, NULL));
    CHECK(count == 1);
    OK(leafless_mesh_peek_attribute_at(mesh, 0, &count, &name, &length, &components, &per_corner));
    CHECK(length == 6 && memcmp(name, "colour", 6) == 0 && components == 4 && per_corner);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_mesh_peek_attribute_at(mesh, 1, &count, &name, &length, &components, &per_corner));
    OK(leafless_mesh_peek_attribute_name_at(mesh, 0, 0, &count, NULL, NULL));
    CHECK(count == 0);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_mesh_peek_attribute_name_at(mesh, 0, 0, &count, &name, &length));
    OK(leafless_mesh_attribute_values(mesh, 0, NULL, 0, &number));
    CHECK(number == 24);
    FAILS(LEAFLESS_E_BUFFER, leafless_mesh_attribute_values(mesh, 0, values, 23, &number));
    OK(leafless_mesh_attribute_values(mesh, 0, values, 24, &number));
    CHECK(values[0] == 0 && values[3] == 255 && values[8] == 240 && values[12] == 0 && values[16] == 240);
    OK(leafless_attribute_from_mesh(mesh, "colour", 6, &colour));
    leafless_mesh_free(mesh);
    OK(leafless_attribute_values(colour, &points[0][0], 2, &at[0][0]));
    CHECK(fabs(at[0][0] - 60) < 1e-9 && at[0][1] == 7 && at[0][3] == 255 && fabs(at[1][0] - 180) < 1e-9);
    OK(leafless_init(&fill, sizeof fill));
    fill.scalar = LEAFLESS_SCALAR_TYPE_U8;
    OK(leafless_channel_fill(colour, &frame, &fill, NULL, &channel));
    OK(leafless_channel_values(channel, &points[0][0], 2, &at[0][0]));
    /* The values of the cells from y = 2 and from y = 6. */
    CHECK(at[0][0] == 75 && at[1][0] == 195);
    leafless_channel_free(channel);
    leafless_attribute_free(colour);
}

static void parts(void) {
    static const double corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const uint32_t faces[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3}, loops[5] = {0, 3, 6, 9, 12};
    leafless_polyhedron_arrays arrays;
    leafless_mesh *mesh;
    leafless_attribute *attribute;
    const char *name;
    size_t length;
    uint64_t count, i;
    uint32_t components, bodies[4] = {9, 9, 9, 9};
    bool per_corner;
    double labels[12], own[8], value[2];
    const double below[3] = {0.2, 0.2, -1};
    OK(leafless_init(&arrays, sizeof arrays));
    arrays.vertices = corners;
    arrays.vertex_count = 4;
    arrays.corners = faces;
    arrays.corner_count = 12;
    arrays.loops = loops;
    arrays.loop_count = 4;
    OK(leafless_mesh_from_polyhedron(&arrays, NULL, &mesh));
    OK(leafless_mesh_peek_attribute_at(mesh, 0, &count, &name, &length, &components, &per_corner));
    CHECK(count == 3 && length == 4 && memcmp(name, "face", 4) == 0 && components == 1 && !per_corner);
    OK(leafless_mesh_attribute_values(mesh, 0, labels, 12, &count));
    for (i = 0; i < 12; i++) {
        CHECK(labels[i] == (double)(i / 3));
    }
    /* A pair of numbers for each face, by the faces of the triangles. */
    for (i = 0; i < 4; i++) {
        own[2 * i] = 10 + labels[3 * i];
        own[2 * i + 1] = -labels[3 * i];
    }
    OK(leafless_attribute_from_mesh_values(mesh, own, 8, 2, false, &attribute));
    OK(leafless_attribute_values(attribute, below, 1, value));
    CHECK(value[0] == 10 && value[1] == 0);
    leafless_attribute_free(attribute);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_attribute_from_mesh_values(mesh, own, 7, 2, false, &attribute));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_attribute_from_mesh_values(mesh, own, 8, 2, true, &attribute));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_attribute_from_mesh_values(mesh, own, 8, 5, false, &attribute));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_attribute_from_mesh(mesh, "colour", 6, &attribute));
    OK(leafless_mesh_bodies(mesh, NULL, 0, &count));
    CHECK(count == 4);
    FAILS(LEAFLESS_E_BUFFER, leafless_mesh_bodies(mesh, bodies, 3, &count));
    OK(leafless_mesh_bodies(mesh, bodies, 4, &count));
    CHECK(bodies[0] == 0 && bodies[3] == 0);
    leafless_mesh_free(mesh);
}

/* The values of an attribute on the triangles of a surface: of each just inside of it. */
static void sampled(void) {
    const double low[3] = {0, 0, 0}, high[3] = {4, 4, 4}, five = 5;
    const leafless_frame frame = {{-2, -2, -2}, 8, 3};
    leafless_solid *solid = NULL;
    leafless_mesh *mesh = NULL, *bearing = NULL, *again = NULL;
    leafless_attribute *constant = NULL, *of_faces = NULL;
    const char *name;
    size_t length;
    uint64_t count = 0, all = 0, i;
    uint32_t components;
    bool per_corner;
    double *values, *own;
    OK(leafless_solid_new_box(low, high, &solid));
    OK(leafless_solid_surface(solid, &frame, NULL, NULL, &mesh));
    OK(leafless_attribute_new_constant(&five, 1, &constant));
    OK(leafless_mesh_with_values(mesh, constant, "material", 8, 0.25, NULL, &bearing));
    OK(leafless_mesh_peek_attribute_at(mesh, 0, &count, NULL, NULL, NULL, NULL));
    CHECK(count == 0);
    OK(leafless_mesh_peek_attribute_at(bearing, 0, &count, &name, &length, &components, &per_corner));
    CHECK(count == 1 && length == 8 && memcmp(name, "material", 8) == 0 && components == 1 && !per_corner);
    OK(leafless_mesh_attribute_values(bearing, 0, NULL, 0, &all));
    values = (double *)malloc((size_t)all * sizeof *values);
    own = (double *)malloc((size_t)all * sizeof *own);
    CHECK(all > 0 && values != NULL && own != NULL);
    OK(leafless_mesh_attribute_values(bearing, 0, values, all, &all));
    for (i = 0; i < all; i++) {
        CHECK(values[i] == 5);
        own[i] = (double)(i / 3);
    }
    /* Its number for each triangle: the nearest triangle is the triangle itself. The name is given once more. */
    OK(leafless_attribute_from_mesh_values(mesh, own, all, 1, true, &of_faces));
    OK(leafless_mesh_with_values(bearing, of_faces, "material", 8, 0, NULL, &again));
    OK(leafless_mesh_peek_attribute_at(again, 0, &count, NULL, NULL, NULL, NULL));
    CHECK(count == 1);
    OK(leafless_mesh_attribute_values(again, 0, values, all, &all));
    for (i = 0; i < all; i++) {
        CHECK(values[i] == own[i]);
    }
    FAILS(LEAFLESS_E_ARGUMENT, leafless_mesh_with_values(mesh, constant, "a", 1, -1, NULL, &bearing));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_mesh_with_values(mesh, constant, "a", 1, (double)INFINITY, NULL, &bearing));
    FAILS(LEAFLESS_E_UTF8, leafless_mesh_with_values(mesh, constant, "\xff", 1, 0, NULL, &bearing));
    free(values);
    free(own);
    leafless_attribute_free(of_faces);
    leafless_attribute_free(constant);
    leafless_mesh_free(again);
    leafless_mesh_free(bearing);
    leafless_mesh_free(mesh);
    leafless_solid_free(solid);
}

int main(void) {
    sampled();
    colours();
    parts();
    return 0;
}
