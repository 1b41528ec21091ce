/* Makes a solid from a volume of a tomograph, measures it, and writes its surface as a PLY file.
 *
 *     isosurface [VOLUME [THRESHOLD]]
 *
 * reads a NRRD or MetaImage file; without one, it makes the scan of a block with two bores.
 * include/README.md describes how to build it.
 */
#include <leafless.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { NX = 96, NY = 64, NZ = 48 };

/* Dense material is bright; each voxel is half a millimetre wide. */
static uint8_t samples[NX * NY * NZ];

static double clamped(double x) {
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

static leafless_status scan(leafless_volume **volume) {
    const leafless_volume_layout layout = {.struct_size = sizeof layout,
                                           .sample_type = LEAFLESS_SAMPLE_TYPE_U8,
                                           .extents = {NX, NY, NZ},
                                           .spacing_model = {0.5, 0.5, 0.5}};
    /* The library uses the samples in place; they stay until the program ends. */
    const leafless_source array = leafless_from_bytes(samples, sizeof samples, LEAFLESS_ACCESS_MAP);
    int x, y, z;
    for (z = 0; z < NZ; z++) {
        for (y = 0; y < NY; y++) {
            for (x = 0; x < NX; x++) {
                /* The depth of the voxel in the block, and its distance from the walls of the bores, in voxels. */
                const double block = fmin(fmin(fmin(x - 6.0, 90.0 - x), fmin(y - 6.0, 58.0 - y)), fmin(z - 6.0, 42.0 - z));
                const double first = sqrt((x - 28.0) * (x - 28.0) + (y - 32.0) * (y - 32.0)) - 11;
                const double second = sqrt((x - 66.0) * (x - 66.0) + (z - 24.0) * (z - 24.0)) - 8;
                const double depth = fmin(block, fmin(first, second));
                samples[x + NX * (y + NY * z)] = (uint8_t)(20 + 200 * clamped(0.5 + 0.5 * depth));
            }
        }
    }
    return leafless_volume_new(&layout, &array, volume);
}

static leafless_status print_volume(const leafless_volume *volume) {
    leafless_volume_info info = LEAFLESS_INIT(leafless_volume_info);
    leafless_interval range;
    leafless_status s = leafless_volume_describe(volume, &info);
    if (!s) s = leafless_volume_range(volume, NULL, &range);
    if (!s) {
        printf("samples   %u x %u x %u, %g to %g\n", (unsigned)info.extents[0], (unsigned)info.extents[1],
               (unsigned)info.extents[2], range.lower, range.upper);
        printf("voxels    %g x %g x %g\n", info.spacing_model[0], info.spacing_model[1], info.spacing_model[2]);
    }
    return s;
}

/* Makes the frame of the voxels, or a frame around them if they are not cubes along the axes. */
static leafless_status frame_of(const leafless_volume *volume, leafless_frame *frame) {
    double min[3], max[3];
    leafless_status s = leafless_volume_frame(volume, frame);
    if (s == LEAFLESS_E_ARGUMENT) {
        s = leafless_volume_bounds(volume, min, max);
        if (!s) s = leafless_frame_fitted(min, max, 9, frame);
    }
    return s;
}

static leafless_status print_surface(const char *method, const leafless_mesh *mesh) {
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    double area, volume;
    leafless_status s = leafless_mesh_inspect(mesh, &report);
    if (!s) s = leafless_mesh_area(mesh, &area);
    if (!s) s = leafless_mesh_volume(mesh, &volume);
    if (!s) {
        printf("%-9s %lu vertices, %lu triangles, %s, Euler characteristic %ld, area %.6g, volume %.6g\n", method,
               (unsigned long)report.vertices, (unsigned long)report.triangles, report.is_closed ? "closed" : "open",
               (long)report.euler_characteristic, area, volume);
    }
    return s;
}

int main(int argc, char **argv) {
    static const char PATH[] = "isosurface.ply";
    const leafless_source given = leafless_from_file(argc > 1 ? argv[1] : "", LEAFLESS_ACCESS_COPY);
    const leafless_sink file = leafless_to_file(PATH);
    const leafless_interval band = {argc > 2 ? atof(argv[2]) : 0, INFINITY};
    leafless_surface_options shrink = {.struct_size = sizeof shrink, .method = LEAFLESS_SURFACE_METHOD_SHRINK};
    leafless_volume *volume = NULL;
    leafless_solid *solid = NULL;
    leafless_octree *octree = NULL;
    leafless_mesh *surface = NULL, *shrunk = NULL;
    leafless_statistics statistics;
    leafless_frame frame;
    leafless_status s = argc > 1 ? leafless_volume_read(&given, NULL, &volume) : scan(&volume);
    if (!s) s = print_volume(volume);
    if (!s) s = frame_of(volume, &frame);
    /* Without a band the threshold is the middle of the samples' type. */
    if (!s) s = leafless_solid_from_volume(volume, argc > 2 ? &band : NULL, NULL, &solid);
    /* The result is a solid like any other: it could be combined with others, or moved. */
    if (!s) s = leafless_octree_build(solid, &frame, LEAFLESS_RULE_SAMPLED, NULL, &octree);
    if (!s) s = leafless_octree_statistics(octree, &statistics);
    if (!s) printf("octree    %lu nodes, volume %.6g\n", (unsigned long)statistics.nodes, statistics.volume_model.lower);
    if (!s) s = leafless_octree_surface(octree, NULL, NULL, &surface);
    if (!s) s = print_surface("cubes", surface);
    if (!s) s = leafless_octree_surface(octree, &shrink, NULL, &shrunk);
    if (!s) s = print_surface("shrunk", shrunk);
    if (!s) s = leafless_mesh_write(surface, NULL, &file);
    if (!s) printf("written   %s\n", PATH);
    if (s) {
        char message[512];
        leafless_last_error(message, sizeof message);
        fprintf(stderr, "%s\n", message);
    }
    leafless_mesh_free(shrunk);
    leafless_mesh_free(surface);
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    leafless_volume_free(volume);
    return s != LEAFLESS_OK;
}
