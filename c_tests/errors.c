/* Every status once, with its name and its message, and with the result left as it was. */
#define _POSIX_C_SOURCE 200809L
#include "check.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

static bool seen[64];

/* Checks how the last call failed: status, message, and every function that reports them. */
static void failed(leafless_status expected, const char *name, const char *part) {
    char message[512], shorter[8], one[1] = {'x'};
    size_t length = leafless_last_error(message, sizeof message);
    seen[expected] = true;
    CHECK(leafless_last_status() == expected);
    CHECK(strcmp(leafless_status_name(expected), name) == 0);
    CHECK(length == strlen(message) && length > 0 && length <= 511);
    if (strstr(message, part) == NULL) {
        fprintf(stderr, "%s: \"%s\" does not say \"%s\"\n", name, message, part);
        exit(1);
    }
    /* A buffer that is too short gets a terminated beginning, and the whole length is returned all the same. */
    CHECK(leafless_last_error(NULL, 0) == length);
    CHECK(leafless_last_error(shorter, sizeof shorter) == length);
    CHECK(strlen(shorter) <= 7 && strncmp(shorter, message, strlen(shorter)) == 0);
    CHECK(leafless_last_error(one, 1) == length && one[0] == '\0');
}

static leafless_octree *const UNTOUCHED = (leafless_octree *)(uintptr_t)0x5a5a5a58;

static int32_t gives_up(void *ctx, const uint8_t *bytes, uint64_t count) {
    (void)ctx;
    (void)bytes;
    (void)count;
    return -4711;
}

static int32_t knows_nothing(void *ctx, const double *points, uint64_t count, double *distances) {
    (void)ctx;
    (void)points;
    (void)count;
    (void)distances;
    return -815;
}

static int32_t has_no_values(void *ctx, const double *points, uint64_t count, double *values) {
    (void)ctx;
    (void)points;
    (void)count;
    (void)values;
    return -4712;
}

/* As different from place to place as can be. */
static int32_t grain(void *ctx, const double *points, uint64_t count, double *values) {
    uint64_t i;
    (void)ctx;
    for (i = 0; i < count; i++) {
        values[i] = fmod(1e4 * points[3 * i] + 3e5 * points[3 * i + 1] + 7e6 * points[3 * i + 2] + 1e8, 251.0);
    }
    return 0;
}

static leafless_attribute *host_attribute(leafless_attribute_values_fn values) {
    leafless_attribute_callbacks callbacks;
    leafless_attribute *attribute = NULL;
    OK(leafless_init(&callbacks, sizeof callbacks));
    callbacks.components = 1;
    callbacks.values = values;
    OK(leafless_attribute_new_callbacks(&callbacks, &attribute));
    return attribute;
}

static int32_t uses_the_octree(void *ctx, const double *min, const double *max) {
    leafless_lazy *const lazy = *(leafless_lazy **)ctx;
    leafless_lazy_info counts = LEAFLESS_INIT(leafless_lazy_info);
    (void)min;
    (void)max;
    if (lazy == NULL) {
        return LEAFLESS_TAG_PARTIAL;
    }
    FAILS(LEAFLESS_E_BUSY, leafless_lazy_describe(lazy, &counts));
    failed(LEAFLESS_E_BUSY, "LEAFLESS_E_BUSY", "lazy: is in use");
    return -LEAFLESS_E_BUSY;
}

static int32_t stops(void *ctx, double fraction) {
    (void)ctx;
    (void)fraction;
    return 1;
}

/* Places in a file, from the format's specification. */
enum {
    MAJOR_VERSION = 8,
    SECTION_COUNT = 96,
    TABLE_CRC = 100,
    HEADER_CRC = 124,
    TABLE = 128,
    ENTRY = 48,
    ENTRY_OFFSET = 16,
    ENTRY_LENGTH = 24,
    ENTRY_CRC = 40,
    SECTION_REL = 5
};

static uint64_t number(const uint8_t *bytes, size_t size) {
    uint64_t value = 0;
    while (size-- > 0) {
        value = value << 8 | bytes[size];
    }
    return value;
}

/* Writes the checksum that zlib and PNG have too. */
static void write_crc(uint8_t *to, const uint8_t *bytes, size_t length) {
    uint32_t crc = 0xffffffffu;
    size_t i;
    int bit;
    for (i = 0; i < length; i++) {
        crc ^= bytes[i];
        for (bit = 0; bit < 8; bit++) {
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
        }
    }
    crc = ~crc;
    for (i = 0; i < 4; i++) {
        to[i] = (uint8_t)(crc >> 8 * i);
    }
}

static void make_checksums_right(uint8_t *file) {
    const size_t sections = (size_t)number(file + SECTION_COUNT, 4);
    size_t i;
    for (i = 0; i < sections; i++) {
        uint8_t *entry = file + TABLE + ENTRY * i;
        write_crc(entry + ENTRY_CRC, file + number(entry + ENTRY_OFFSET, 8), (size_t)number(entry + ENTRY_LENGTH, 8));
    }
    write_crc(file + TABLE_CRC, file + TABLE, ENTRY * sections);
    write_crc(file + HEADER_CRC, file, HEADER_CRC);
}

/* Work under a limit of memory, in a process of its own: exits with the status that the work returned, or 99. */
static int with_memory(rlim_t bytes, leafless_status (*work)(void)) {
    int status;
    pid_t child = fork();
    CHECK(child >= 0);
    if (child == 0) {
        struct rlimit limit;
        limit.rlim_cur = limit.rlim_max = bytes;
        if (setrlimit(RLIMIT_AS, &limit) != 0) {
            _exit(99);
        }
        _exit(work());
    }
    CHECK(waitpid(child, &status, 0) == child);
    if (!WIFEXITED(status)) {
        fprintf(stderr, "with %lu bytes: signal %d\n", (unsigned long)bytes, WTERMSIG(status));
        exit(1);
    }
    return WEXITSTATUS(status);
}

static leafless_status deep_ball(void) {
    const leafless_frame frame = check_frame(9);
    leafless_solid *solid = check_ball_solid();
    leafless_octree *octree = UNTOUCHED;
    leafless_options options;
    leafless_status status;
    OK(leafless_init(&options, sizeof options));
    options.threads = 1;
    status = leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &octree);
    if (status == LEAFLESS_OK) {
        leafless_octree_free(octree);
    } else if (octree != UNTOUCHED) {
        return LEAFLESS_E_PANIC;
    } else if (status != leafless_last_status() || leafless_last_error(NULL, 0) == 0) {
        return LEAFLESS_E_PANIC;
    }
    leafless_solid_free(solid);
    return status;
}

/* A wavy sheet of 2 * 80 * 80 triangles, some missing: all operations on an open mesh. */
static leafless_status open_sheet(void) {
    enum { SIDE = 81 };
    static float vertices[SIDE * SIDE][3];
    static uint16_t triangles[2 * (SIDE - 1) * (SIDE - 1)][3];
    static leafless_mesh_defect defects[4000];
    const leafless_frame frame = check_frame(6);
    leafless_mesh_arrays arrays = check_arrays(vertices, SIDE * SIDE, triangles, 0);
    leafless_mesh *mesh = (leafless_mesh *)UNTOUCHED;
    leafless_solid *solid = NULL;
    leafless_octree *octree = NULL;
    leafless_options options;
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    uint64_t count = 0;
    leafless_status status;
    int i, j;
    for (i = 0; i < SIDE; i++) {
        for (j = 0; j < SIDE; j++) {
            vertices[SIDE * i + j][0] = (float)i * 0.02f - 0.8f;
            vertices[SIDE * i + j][1] = (float)j * 0.02f - 0.8f;
            vertices[SIDE * i + j][2] = (float)(i * j % 5) * 0.1f;
            if (i > 0 && j > 0 && (i % 40 != 5 || j % 40 != 3)) {
                const uint16_t a = (uint16_t)(SIDE * i + j), b = (uint16_t)(a - 1);
                const uint16_t c = (uint16_t)(a - SIDE), d = (uint16_t)(b - SIDE);
                const uint16_t one[3] = {d, b, a}, other[3] = {d, a, c};
                memcpy(triangles[arrays.triangle_count++], one, sizeof one);
                memcpy(triangles[arrays.triangle_count++], other, sizeof other);
            }
        }
    }
    arrays.vertex_type = LEAFLESS_VERTEX_TYPE_F32;
    arrays.index_type = LEAFLESS_INDEX_TYPE_U16;
    OK(leafless_init(&options, sizeof options));
    options.threads = 1;
    status = leafless_mesh_new(&arrays, &mesh);
    if (status != LEAFLESS_OK) {
        return mesh == (leafless_mesh *)UNTOUCHED ? status : LEAFLESS_E_PANIC;
    }
    status = leafless_mesh_defects(mesh, UINT64_MAX, defects, COUNT(defects), &count);
    if (status == LEAFLESS_OK) {
        CHECK(count >= 5);
        status = leafless_mesh_inspect(mesh, &report);
    }
    if (status == LEAFLESS_OK) {
        status = leafless_solid_from_mesh(mesh, LEAFLESS_FILL_NON_ZERO, &solid);
    }
    if (status == LEAFLESS_OK) {
        status = leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &octree);
    }
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    leafless_mesh_free(mesh);
    return status;
}

/* A volume of 64³ samples: its solid, its octree, the surface and its report, its file and the volume's. */
static leafless_status scanned_ball(void) {
    enum { SIDE = 64 };
    static uint16_t samples[SIDE * SIDE * SIDE];
    leafless_volume *volume = (leafless_volume *)UNTOUCHED;
    leafless_solid *solid = NULL;
    leafless_octree *octree = NULL;
    leafless_mesh *mesh = NULL, *other = NULL;
    leafless_volume_layout layout;
    leafless_surface_options surface;
    leafless_mesh_write_options write;
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    leafless_options options;
    leafless_frame frame;
    leafless_status status;
    uint64_t length;
    int x, y, z;
    for (z = 0; z < SIDE; z++) {
        for (y = 0; y < SIDE; y++) {
            for (x = 0; x < SIDE; x++) {
                const int d[3] = {x - 31, y - 33, z - 30};
                samples[x + SIDE * (y + SIDE * z)] = (uint16_t)(40000 - 11 * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
            }
        }
    }
    OK(leafless_init(&layout, sizeof layout));
    layout.sample_type = LEAFLESS_SAMPLE_TYPE_U16;
    layout.extents[0] = layout.extents[1] = layout.extents[2] = SIDE;
    OK(leafless_init(&surface, sizeof surface));
    surface.method = LEAFLESS_SURFACE_METHOD_SIMPLE_MARCHING_CUBES;
    OK(leafless_init(&write, sizeof write));
    write.format = LEAFLESS_MESH_FORMAT_PLY;
    OK(leafless_init(&options, sizeof options));
    options.threads = 1;
    status = volume_of_array(&layout, samples, sizeof samples, &volume);
    if (status != LEAFLESS_OK) {
        return volume == (leafless_volume *)UNTOUCHED ? status : LEAFLESS_E_PANIC;
    }
    OK(leafless_volume_frame(volume, &frame));
    status = leafless_solid_from_volume(volume, NULL, &options, &solid);
    if (!status) status = leafless_octree_build(solid, &frame, LEAFLESS_RULE_SAMPLED, &options, &octree);
    if (!status) status = leafless_octree_surface(octree, NULL, &options, &mesh);
    if (!status) status = leafless_octree_surface(octree, &surface, &options, &other);
    if (!status) status = leafless_mesh_inspect(mesh, &report);
    if (!status) status = mesh_to_bytes(mesh, &write, NULL, 0, &length);
    if (!status) status = volume_to_bytes(volume, LEAFLESS_VOLUME_FORMAT_NRRD_GZIP, NULL, 0, &length);
    if (!status) {
        CHECK(report.is_manifold && report.triangles > 5000);
    }
    leafless_mesh_free(other);
    leafless_mesh_free(mesh);
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    leafless_volume_free(volume);
    return status;
}

/* Where values of channels matter. */
static leafless_octree *grainy;

/* A channel of many values: filled, attached, carried, changed, written and read. */
static leafless_status grainy_ball(void) {
    leafless_octree *with = NULL, *carried = NULL, *back = NULL;
    leafless_attribute *attribute = host_attribute(grain);
    leafless_channel *channel = (leafless_channel *)UNTOUCHED, *changed = NULL;
    const leafless_octree *operands[2];
    leafless_channel_fill_options fill;
    leafless_options options;
    leafless_status status;
    uint64_t length = 0;
    uint8_t *bytes = NULL;
    const double value = 3;
    OK(leafless_init(&fill, sizeof fill));
    fill.solid = grainy;
    fill.name = "grain";
    fill.name_length = 5;
    OK(leafless_init(&options, sizeof options));
    options.threads = 1;
    status = leafless_channel_fill(attribute, NULL, &fill, &options, &channel);
    if (status != LEAFLESS_OK) {
        return channel == (leafless_channel *)UNTOUCHED ? status : LEAFLESS_E_PANIC;
    }
    status = leafless_octree_with_channel(grainy, channel, &with);
    operands[0] = operands[1] = with;
    if (!status) {
        status = leafless_octree_carry_channels(grainy, operands, 2, LEAFLESS_CARRY_MEAN, NULL, 0, &options, &carried);
    }
    if (!status) status = leafless_channel_with_value_in(channel, grainy, &value, &options, &changed);
    if (!status) status = octree_to_bytes(carried, NULL, 0, &length);
    if (!status) {
        bytes = (uint8_t *)malloc((size_t)length);
        status = bytes == NULL ? LEAFLESS_E_NO_MEMORY : octree_to_bytes(carried, bytes, length, &length);
    }
    if (!status) status = octree_from_bytes(bytes, length, &back);
    free(bytes);
    leafless_octree_free(back);
    leafless_channel_free(changed);
    leafless_octree_free(carried);
    leafless_octree_free(with);
    leafless_channel_free(channel);
    leafless_attribute_free(attribute);
    return status;
}

static long address_space(void) {
    FILE *file = fopen("/proc/self/statm", "r");
    long pages = -1;
    if (file == NULL) {
        return -1;
    }
    if (fscanf(file, "%ld", &pages) != 1) {
        pages = -1;
    }
    fclose(file);
    return pages < 0 ? -1 : pages * sysconf(_SC_PAGESIZE);
}

/* Work under many limits of memory, some of them sufficient. */
static void runs_out(leafless_status (*work)(void), long first, long end, long step) {
    int refused = 0, done = 0;
    long more;
    CHECK(address_space() > 0);
    for (more = first; more < end; more += step) {
        const int status = with_memory((rlim_t)address_space() + ((rlim_t)more << 10), work);
        refused += status == LEAFLESS_E_NO_MEMORY;
        done += status == LEAFLESS_OK;
        if (status != LEAFLESS_OK && status != LEAFLESS_E_NO_MEMORY) {
            fprintf(stderr, "with %ld KiB more: %s\n", more, leafless_status_name(status));
            exit(1);
        }
    }
    CHECK(refused > 3 && done > 0);
}

int main(int argc, char **argv) {
    /* Sanitizers and valgrind need address space beyond any limit. Requests that allocators refuse by themselves are
       tested with them, too. */
    const bool limited = argc > 1 && strcmp(argv[1], "limited") == 0;
    const leafless_frame frame = check_frame(4), other = check_frame(5);
    leafless_octree *ball = check_ball(4, LEAFLESS_RULE_CERTIFIED), *finer = check_ball(5, LEAFLESS_RULE_CERTIFIED);
    leafless_octree *octree = UNTOUCHED;
    leafless_mesh *mesh = (leafless_mesh *)UNTOUCHED, *cube = check_cube();
    leafless_solid *solid = NULL;
    leafless_options options;
    leafless_control *control = NULL;
    uint64_t length = 0, count = 77;
    uint8_t *bytes = check_bytes(ball, &length), buffer[16];
    leafless_statistics levels[2];
    size_t i;

    /* The names of all statuses, and of invalid ones. */
    CHECK(strcmp(leafless_status_name(LEAFLESS_OK), "LEAFLESS_OK") == 0);
    CHECK(strcmp(leafless_status_name(-1), "LEAFLESS_E_UNKNOWN") == 0);
    CHECK(strcmp(leafless_status_name(22), "LEAFLESS_E_UNKNOWN") == 0);
    CHECK(strcmp(leafless_status_name(INT32_MIN), "LEAFLESS_E_UNKNOWN") == 0);
    CHECK(leafless_last_status() == LEAFLESS_OK);
    seen[LEAFLESS_OK] = true;

    FAILS(LEAFLESS_E_NULL, check_octrees(LEAFLESS_OPERATION_UNION, ball, NULL, NULL, &octree));
    failed(LEAFLESS_E_NULL, "LEAFLESS_E_NULL", "octrees: must not be NULL");
    /* What succeeds leaves the message alone. */
    OK(leafless_octree_check(ball));
    CHECK(leafless_last_status() == LEAFLESS_E_NULL);

    solid = check_ball_solid();
    FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_build(solid, &frame, 4, NULL, &octree));
    failed(LEAFLESS_E_ARGUMENT, "LEAFLESS_E_ARGUMENT", "rule");

    FAILS(LEAFLESS_E_UTF8, octree_open("\xff", 1, &octree));
    failed(LEAFLESS_E_UTF8, "LEAFLESS_E_UTF8", "path: is not UTF-8");
    FAILS(LEAFLESS_E_UTF8, leafless_octree_with_metadata(ball, "\xc3", 1, "", 0, &octree));
    FAILS(LEAFLESS_E_UTF8, leafless_octree_with_metadata(ball, "k", 1, "\xed\xa0\x80", 3, &octree));

    FAILS(LEAFLESS_E_BUFFER, octree_to_bytes(ball, buffer, sizeof buffer, &count));
    failed(LEAFLESS_E_BUFFER, "LEAFLESS_E_BUFFER", "16");
    FAILS(LEAFLESS_E_BUFFER, leafless_octree_levels(ball, levels, 2, &count));
    CHECK(count == 77);

    FAILS(LEAFLESS_E_FRAME, check_octrees(LEAFLESS_OPERATION_UNION, ball, finer, NULL, &octree));
    failed(LEAFLESS_E_FRAME, "LEAFLESS_E_FRAME", "different frames: origin [");
    {
        /* Every query of a stored octree needs its own universe; a mesh allows any. */
        const leafless_frame apart = {{0, 0, 0}, 1, 4};
        const double centre[3] = {0.5, 0.5, 0.5}, corner[3] = {0.75, 0.75, 0.75};
        leafless_solid *stored = NULL, *meshed = NULL;
        leafless_membership membership = 77;
        leafless_region region = 77;
        OK(leafless_solid_from_octree(ball, &stored));
        FAILS(LEAFLESS_E_FRAME, leafless_octree_build(stored, &apart, LEAFLESS_RULE_CERTIFIED, NULL, &octree));
        FAILS(LEAFLESS_E_FRAME, leafless_solid_contains_many(stored, &apart, centre, 1, NULL, &membership));
        FAILS(LEAFLESS_E_FRAME, leafless_solid_classify_box(stored, &apart, centre, corner, NULL, &region));
        failed(LEAFLESS_E_FRAME, "LEAFLESS_E_FRAME", "different frames: origin [");
        CHECK(region == 77);
        OK(leafless_solid_from_mesh(cube, LEAFLESS_FILL_NON_ZERO, &meshed));
        OK(leafless_solid_contains_many(meshed, &apart, centre, 1, NULL, &membership));
        CHECK(membership == LEAFLESS_MEMBERSHIP_INSIDE);
        OK(leafless_solid_classify_box(meshed, &other, centre, corner, NULL, &region));
        CHECK(region == LEAFLESS_REGION_INSIDE);
        leafless_solid_free(meshed);
        leafless_solid_free(stored);
    }

    FAILS(LEAFLESS_E_NOT_SAMPLED, leafless_octree_resolve(ball, LEAFLESS_RULE_SAMPLED, NULL, &octree));
    failed(LEAFLESS_E_NOT_SAMPLED, "LEAFLESS_E_NOT_SAMPLED", "single points");

    {
        const double bad[3] = {0.0, INFINITY, 0.0};
        const uint32_t beyond[3] = {0, 1, 8};
        leafless_mesh *open = check_some_of_cube(11);
        leafless_solid *none = NULL;
        leafless_mesh_arrays arrays = check_arrays(bad, 1, NULL, 0);
        FAILS(LEAFLESS_E_MESH, leafless_mesh_new(&arrays, &mesh));
        failed(LEAFLESS_E_MESH, "LEAFLESS_E_MESH", "vertex 0");
        arrays = check_arrays(CHECK_CUBE, 8, beyond, 1);
        FAILS(LEAFLESS_E_MESH, leafless_mesh_new(&arrays, &mesh));
        failed(LEAFLESS_E_MESH, "LEAFLESS_E_MESH", "triangle 0 refers to vertex 8");
        FAILS(LEAFLESS_E_MESH, leafless_mesh_check_closed(open, LEAFLESS_FILL_EVEN_ODD));
        failed(LEAFLESS_E_MESH, "LEAFLESS_E_MESH", "3 edges");
        FAILS(LEAFLESS_E_MESH, leafless_solid_from_mesh(open, LEAFLESS_FILL_EVEN_ODD, &none));
        leafless_mesh_free(open);
        {
            /* Moved beyond the numbers that meshes may have, which end at 2^256. */
            const double larger[12] = {0x1p60, 0, 0, 0, 0, 0x1p60, 0, 0, 0, 0, 0x1p60, 0};
            leafless_solid *rest = NULL, *moved = NULL;
            leafless_motion motion = 77;
            int i;
            OK(leafless_solid_from_mesh(cube, LEAFLESS_FILL_NON_ZERO, &rest));
            for (i = 0; i < 4; i++) {
                OK(leafless_solid_placed(rest, larger, NULL, &moved));
                leafless_solid_free(rest);
                rest = moved;
                moved = NULL;
            }
            FAILS(LEAFLESS_E_MESH, leafless_solid_placed(rest, larger, &motion, &moved));
            failed(LEAFLESS_E_MESH, "LEAFLESS_E_MESH", "vertex");
            CHECK(moved == NULL && motion == 77);
            leafless_solid_free(rest);
        }
        CHECK(none == NULL);
    }

    FAILS(LEAFLESS_E_MESH_FILE, mesh_from_bytes((const uint8_t *)"solid\nfacet normal 0 0 0\nouter hoop\n", 36,
                                                         NULL, NULL, &mesh));
    failed(LEAFLESS_E_MESH_FILE, "LEAFLESS_E_MESH_FILE", "line 3");
    FAILS(LEAFLESS_E_MESH_FILE, mesh_from_bytes(NULL, 0, NULL, NULL, &mesh));
    CHECK(mesh == (leafless_mesh *)UNTOUCHED);

    {
        static const char text[] = "group() {\n  cube(size = [1, 2]);\n}";
        leafless_scene *scene = (leafless_scene *)UNTOUCHED;
        FAILS(LEAFLESS_E_SCENE, scene_from_text(text, NULL, LEAFLESS_FACETS_AUTO, &scene));
        failed(LEAFLESS_E_SCENE, "LEAFLESS_E_SCENE", "line 2, column 15: expected 3 items");
        CHECK(scene == (leafless_scene *)UNTOUCHED);
    }

    FAILS(LEAFLESS_E_FORMAT, octree_from_bytes((const uint8_t *)"no file at all, but of some length, more than a header"
        " has, and so on, and so on, and so on, and so on, and so on, and so on, and so on, and so on", 128, &octree));
    failed(LEAFLESS_E_FORMAT, "LEAFLESS_E_FORMAT", "not a Leafless file");
    FAILS(LEAFLESS_E_FORMAT, octree_from_bytes(bytes, length - 1, &octree));
    failed(LEAFLESS_E_FORMAT, "LEAFLESS_E_FORMAT", "bytes");

    {
        uint8_t *altered = (uint8_t *)malloc((size_t)length);
        leafless_file_info probe = LEAFLESS_INIT(leafless_file_info);
        leafless_file_section sections[8];
        CHECK(altered != NULL);
        memcpy(altered, bytes, (size_t)length);
        altered[MAJOR_VERSION] = 3;
        make_checksums_right(altered);
        FAILS(LEAFLESS_E_VERSION, octree_from_bytes(altered, length, &octree));
        failed(LEAFLESS_E_VERSION, "LEAFLESS_E_VERSION", "3.1");
        check_write("newer.lfl", altered, (size_t)length);
        FAILS(LEAFLESS_E_VERSION, octree_open("newer.lfl", 9, &octree));
        FAILS(LEAFLESS_E_VERSION, octree_map("newer.lfl", 9, &octree));

        /* All checksums right, but the cells of the first brick are all EMPTY, so it should not be there. A brick
           of a certified octree has two planes of 64 bits. */
        memcpy(altered, bytes, (size_t)length);
        OK(probe_bytes(bytes, length, &probe, sections, COUNT(sections)));
        for (i = 0; i < probe.sections; i++) {
            if (strcmp(sections[i].name, "bricks") == 0) {
                memset(altered + sections[i].offset, 0, 16);
            }
        }
        make_checksums_right(altered);
        FAILS(LEAFLESS_E_DAMAGED, verify_bytes(altered, length));
        failed(LEAFLESS_E_DAMAGED, "LEAFLESS_E_DAMAGED", "the octree is damaged");
        FAILS(LEAFLESS_E_DAMAGED, octree_from_bytes(altered, length, &octree));
        check_write("damaged.lfl", altered, (size_t)length);
        FAILS(LEAFLESS_E_DAMAGED, octree_open("damaged.lfl", 11, &octree));
        FAILS(LEAFLESS_E_DAMAGED, octree_map_verified("damaged.lfl", 11, &octree));
        CHECK(octree == UNTOUCHED);
        OK(octree_map("damaged.lfl", 11, &octree));
        FAILS(LEAFLESS_E_DAMAGED, leafless_octree_check(octree));
        leafless_octree_free(octree);
        octree = UNTOUCHED;
        free(altered);
    }

    OK(leafless_init(&options, sizeof options));
    options.max_nodes = 10;
    FAILS(LEAFLESS_E_LIMIT, leafless_octree_complement(ball, &options, &octree));
    failed(LEAFLESS_E_LIMIT, "LEAFLESS_E_LIMIT", "10 nodes");
    FAILS(LEAFLESS_E_LIMIT, leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &octree));
    options.max_nodes = 0;
    options.max_bytes = 100;
    FAILS(LEAFLESS_E_LIMIT, leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &octree));
    failed(LEAFLESS_E_LIMIT, "LEAFLESS_E_LIMIT", "100 bytes");

    /* 96 GB of vertices. None is read before there is memory for all. */
    if (limited) {
        const leafless_mesh_arrays arrays = check_arrays(CHECK_CUBE, UINT32_MAX, NULL, 0);
        struct rlimit limit, old;
        CHECK(getrlimit(RLIMIT_AS, &old) == 0);
        limit = old;
        limit.rlim_cur = (rlim_t)1 << 32;
        CHECK(setrlimit(RLIMIT_AS, &limit) == 0);
        FAILS(LEAFLESS_E_NO_MEMORY, leafless_mesh_new(&arrays, &mesh));
        CHECK(setrlimit(RLIMIT_AS, &old) == 0);
        failed(LEAFLESS_E_NO_MEMORY, "LEAFLESS_E_NO_MEMORY", "memory");
    } else {
        seen[LEAFLESS_E_NO_MEMORY] = true;
    }
    CHECK(mesh == (leafless_mesh *)UNTOUCHED);
    if (limited) {
        /* Memory that runs out half-way, at many places. */
        runs_out(deep_ball, 0, 8192, 256);
        runs_out(open_sheet, 0, 2560, 160);
        runs_out(scanned_ball, 0, 6144, 256);
        grainy = check_ball(6, LEAFLESS_RULE_CERTIFIED);
        runs_out(grainy_ball, 0, 4096, 192);
        leafless_octree_free(grainy);
    }

    OK(leafless_init(&options, sizeof options));
    OK(leafless_control_new(&control));
    OK(leafless_control_cancel(control));
    options.control = control;
    FAILS(LEAFLESS_E_CANCELLED, check_octrees(LEAFLESS_OPERATION_UNION, ball, ball, &options, &octree));
    failed(LEAFLESS_E_CANCELLED, "LEAFLESS_E_CANCELLED", "cancelled");
    OK(leafless_init(&options, sizeof options));
    options.progress = stops;
    FAILS(LEAFLESS_E_CANCELLED, leafless_octree_build(solid, &other, LEAFLESS_RULE_CERTIFIED, &options, &octree));

    {
        /* Every query of a solid can be cancelled, and returns the host's own errors. */
        const double at[3] = {0.7, 0.2, 0.1}, beside[3] = {0.8, 0.3, 0.2};
        leafless_solid_callbacks callbacks;
        leafless_solid *host = NULL;
        leafless_membership membership = 77;
        leafless_region region = 77;
        options.progress = NULL;
        options.control = control;
        FAILS(LEAFLESS_E_CANCELLED, leafless_solid_contains_many(solid, &other, at, 1, &options, &membership));
        FAILS(LEAFLESS_E_CANCELLED, leafless_solid_classify_box(solid, &other, at, beside, &options, &region));
        OK(leafless_init(&callbacks, sizeof callbacks));
        callbacks.distance_many = knows_nothing;
        OK(leafless_solid_new_callbacks(&callbacks, &host));
        FAILS(LEAFLESS_E_CALLBACK, leafless_solid_contains_many(host, &other, at, 1, NULL, &membership));
        failed(LEAFLESS_E_CALLBACK, "LEAFLESS_E_CALLBACK", "-815");
        CHECK(leafless_last_code() == -815);
        FAILS(LEAFLESS_E_CALLBACK, leafless_solid_classify_box(host, &other, at, beside, NULL, &region));
        failed(LEAFLESS_E_CALLBACK, "LEAFLESS_E_CALLBACK", "-815");
        CHECK(region == 77);
        leafless_solid_free(host);
    }
    FAILS(LEAFLESS_E_CALLBACK, octree_write_to(ball, gives_up, NULL));
    failed(LEAFLESS_E_CALLBACK, "LEAFLESS_E_CALLBACK", "-4711");
    CHECK(leafless_last_code() == -4711);
    FAILS(LEAFLESS_E_NULL, leafless_octree_check(NULL));
    CHECK(leafless_last_code() == 0);

    FAILS(LEAFLESS_E_IO, octree_open("no/such/file", 12, &octree));
    failed(LEAFLESS_E_IO, "LEAFLESS_E_IO", "no/such/file: No such file");
    FAILS(LEAFLESS_E_IO, octree_map("no/such/file", 12, &octree));
    failed(LEAFLESS_E_IO, "LEAFLESS_E_IO", "no/such/file: No such file");
    FAILS(LEAFLESS_E_IO, octree_save(ball, "no/such/file", 12));
    failed(LEAFLESS_E_IO, "LEAFLESS_E_IO", "no/such/file: No such file");
    FAILS(LEAFLESS_E_IO, mesh_open("no/such/file", 12, NULL, NULL, &mesh));
    failed(LEAFLESS_E_IO, "LEAFLESS_E_IO", "no/such/file: No such file");
    {
        /* For a long path, the message has its end, and the reason after it. */
        char path[3 * 1000 + 9] = {0};
        int i;
        for (i = 0; i < 1000; i++) memcpy(path + 3 * i, "no/", 3);
        memcpy(path + 3000, "part.lfl", 8);
        FAILS(LEAFLESS_E_IO, octree_open(path, 3008, &octree));
        failed(LEAFLESS_E_IO, "LEAFLESS_E_IO", "no/part.lfl: No such file");
    }
    /* A device that is always full. */
    if (access("/dev/full", W_OK) == 0) {
        FAILS(LEAFLESS_E_IO, octree_save(ball, "/dev/full", 9));
        failed(LEAFLESS_E_IO, "LEAFLESS_E_IO", "space");
    }

    {
        static const uint8_t cut[] = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n1234567";
        leafless_volume *volume = (leafless_volume *)UNTOUCHED;
        FAILS(LEAFLESS_E_VOLUME_FILE, volume_from_bytes(cut, sizeof cut - 1, NULL, 0, &volume));
        failed(LEAFLESS_E_VOLUME_FILE, "LEAFLESS_E_VOLUME_FILE", "8 bytes of samples are expected, but 7 were found");
        check_write("errors.nrrd", cut, 20);
        FAILS(LEAFLESS_E_VOLUME_FILE, volume_open("errors.nrrd", 11, &volume));
        failed(LEAFLESS_E_VOLUME_FILE, "LEAFLESS_E_VOLUME_FILE", "errors.nrrd: ");
        FAILS(LEAFLESS_E_IO, volume_open("no/such/file", 12, &volume));
        failed(LEAFLESS_E_IO, "LEAFLESS_E_IO", "no/such/file: No such file");
        FAILS(LEAFLESS_E_IO, mesh_save(cube, "no/such/file.stl", 16, NULL));
        failed(LEAFLESS_E_IO, "LEAFLESS_E_IO", "no/such/file.stl: No such file");
        CHECK(volume == (leafless_volume *)UNTOUCHED);
    }

    {
        /* Channels: numbers that a type has not, another cube, the host's own error, limits, and a damaged file. */
        const double large = 256;
        const leafless_frame apart = {{0, 0, 0}, 1, 4};
        leafless_attribute *one = NULL, *bad = host_attribute(has_no_values), *many = host_attribute(grain);
        leafless_channel *channel = (leafless_channel *)UNTOUCHED, *filled = NULL;
        leafless_octree *with = NULL;
        leafless_channel_fill_options fill;
        leafless_channel_info info = LEAFLESS_INIT(leafless_channel_info);
        leafless_file_info probe = LEAFLESS_INIT(leafless_file_info);
        leafless_file_section sections[32];
        uint64_t file_length = 0;
        uint8_t *file;
        double value = 77;
        OK(leafless_attribute_new_constant(&large, 1, &one));
        OK(leafless_init(&fill, sizeof fill));
        fill.scalar = LEAFLESS_SCALAR_TYPE_U8;
        FAILS(LEAFLESS_E_ARGUMENT, leafless_channel_fill(one, &frame, &fill, NULL, &channel));
        failed(LEAFLESS_E_ARGUMENT, "LEAFLESS_E_ARGUMENT", "value: must lie in the range of the channel's type");
        fill.solid = ball;
        FAILS(LEAFLESS_E_FRAME, leafless_channel_fill(many, &apart, &fill, NULL, &channel));
        failed(LEAFLESS_E_FRAME, "LEAFLESS_E_FRAME", "different frames: origin [");
        FAILS(LEAFLESS_E_CALLBACK, leafless_channel_fill(bad, NULL, &fill, NULL, &channel));
        failed(LEAFLESS_E_CALLBACK, "LEAFLESS_E_CALLBACK", "-4712");
        FAILS(LEAFLESS_E_CALLBACK, leafless_attribute_values(bad, apart.origin, 1, &value));
        fill.name = "\xff";
        fill.name_length = 1;
        FAILS(LEAFLESS_E_UTF8, leafless_channel_fill(many, NULL, &fill, NULL, &channel));
        fill.name_length = 0;
        OK(leafless_init(&options, sizeof options));
        options.max_bytes = 100;
        FAILS(LEAFLESS_E_LIMIT, leafless_channel_fill(many, NULL, &fill, &options, &channel));
        failed(LEAFLESS_E_LIMIT, "LEAFLESS_E_LIMIT", "100 bytes");
        options.max_bytes = 0;
        options.control = control;
        FAILS(LEAFLESS_E_CANCELLED, leafless_channel_fill(many, NULL, &fill, &options, &channel));
        options.control = NULL;
        CHECK(channel == (leafless_channel *)UNTOUCHED);

        OK(leafless_channel_fill(many, NULL, &fill, NULL, &filled));
        OK(leafless_octree_with_channel(ball, filled, &with));
        file = check_bytes(with, &file_length);
        OK(probe_bytes(file, file_length, &probe, sections, COUNT(sections)));
        for (i = 0; i < probe.sections; i++) {
            if (sections[i].owner != 0 && sections[i].kind == SECTION_REL) {
                memset(file + sections[i].offset, 0x5a, (size_t)sections[i].length);
            }
        }
        make_checksums_right(file);
        FAILS(LEAFLESS_E_DAMAGED, octree_from_bytes(file, file_length, &octree));
        check_write("channel.lfl", file, (size_t)file_length);
        leafless_octree_free(with);
        OK(octree_map("channel.lfl", 11, &with));
        leafless_channel_free(filled);
        OK(leafless_octree_channel_at(with, 0, &filled));
        FAILS(LEAFLESS_E_DAMAGED, leafless_channel_describe(filled, &info));
        FAILS(LEAFLESS_E_DAMAGED, leafless_channel_values(filled, apart.origin, 1, &value));
        failed(LEAFLESS_E_DAMAGED, "LEAFLESS_E_DAMAGED", "damaged");
        FAILS(LEAFLESS_E_DAMAGED, leafless_channel_check(filled));
        free(file);
        leafless_octree_free(with);
        leafless_channel_free(filled);
        leafless_attribute_free(one);
        leafless_attribute_free(bad);
        leafless_attribute_free(many);
    }

    {
        /* Tri-dexel models: two lattices, other directions, impossible intervals, and limits. */
        const leafless_frame apart = {{0, 0, 0}, 1, 4};
        leafless_tridexel *model = NULL, *other = NULL, *column = NULL, *result = (leafless_tridexel *)UNTOUCHED;
        leafless_tridexel_editor *editor = NULL;
        leafless_tridexel_format along_y;
        const uint32_t ray[2] = {8, 8};
        uint64_t count = 77, offset_count = 77;
        OK(leafless_init(&along_y, sizeof along_y));
        along_y.directions = LEAFLESS_AXES_Y;
        OK(leafless_tridexel_build(solid, &frame, LEAFLESS_RULE_SAMPLED, NULL, NULL, &model));
        OK(leafless_tridexel_build(solid, &apart, LEAFLESS_RULE_SAMPLED, NULL, NULL, &other));
        OK(leafless_tridexel_build(solid, &frame, LEAFLESS_RULE_SAMPLED, &along_y, NULL, &column));
        OK(leafless_tridexel_editor_new(model, &editor));
        FAILS(LEAFLESS_E_ARGUMENT, leafless_tridexel_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, NULL, NULL, &result));
        failed(LEAFLESS_E_ARGUMENT, "LEAFLESS_E_ARGUMENT", "take sampled, inner or outer");
        FAILS(LEAFLESS_E_FRAME, check_tridexels(LEAFLESS_OPERATION_UNION, model, other, NULL, &result));
        failed(LEAFLESS_E_FRAME, "LEAFLESS_E_FRAME", "different frames: origin [-1");
        failed(LEAFLESS_E_FRAME, "LEAFLESS_E_FRAME", "origin [0");
        FAILS(LEAFLESS_E_FRAME, leafless_tridexel_editor_combine(editor, LEAFLESS_OPERATION_DIFFERENCE, other, NULL, NULL));
        failed(LEAFLESS_E_FRAME, "LEAFLESS_E_FRAME", "different frames: origin [-1");
        FAILS(LEAFLESS_E_ARGUMENT, check_tridexels(LEAFLESS_OPERATION_XOR, model, column, NULL, &result));
        failed(LEAFLESS_E_ARGUMENT, "LEAFLESS_E_ARGUMENT", "must have rays in the same directions");
        FAILS(LEAFLESS_E_ARGUMENT, leafless_tridexel_ray(column, 2, ray, NULL, 0, &count));
        failed(LEAFLESS_E_ARGUMENT, "LEAFLESS_E_ARGUMENT", "axis: is none that the model has rays along");
        FAILS(LEAFLESS_E_BUFFER, leafless_tridexel_copy(column, 1, NULL, NULL, &count, 1, &offset_count, NULL, NULL, NULL, NULL,
                                                        0, &count));
        failed(LEAFLESS_E_BUFFER, "LEAFLESS_E_BUFFER", "offsets: has a capacity of 1, and ");
        {
            /* Intervals of an unverified file. */
            leafless_tridexel *viewed = NULL;
            leafless_file_info probe = LEAFLESS_INIT(leafless_file_info);
            leafless_file_section sections[32];
            uint64_t file_length = 0;
            uint8_t *file;
            OK(tridexel_to_bytes(model, NULL, 0, &file_length));
            file = (uint8_t *)malloc((size_t)file_length);
            CHECK(file != NULL);
            OK(tridexel_to_bytes(model, file, file_length, &file_length));
            FAILS(LEAFLESS_E_ARGUMENT, octree_from_bytes(file, file_length, &octree));
            failed(LEAFLESS_E_ARGUMENT, "LEAFLESS_E_ARGUMENT", "the file holds a tri-dexel model, but an octree is needed");
            FAILS(LEAFLESS_E_ARGUMENT, tridexel_from_bytes(bytes, length, &result));
            failed(LEAFLESS_E_ARGUMENT, "LEAFLESS_E_ARGUMENT", "the file holds an octree, but a tri-dexel model is needed");
            OK(probe_bytes(file, file_length, &probe, sections, COUNT(sections)));
            for (i = 0; i < probe.sections; i++) {
                if (strstr(sections[i].name, "spans") != NULL) {
                    memset(file + sections[i].offset, 0xff, (size_t)sections[i].length);
                }
            }
            OK(tridexel_view_bytes(file, file_length, &viewed));
            FAILS(LEAFLESS_E_DAMAGED, leafless_tridexel_check(viewed));
            failed(LEAFLESS_E_DAMAGED, "LEAFLESS_E_DAMAGED", "the tri-dexel model is damaged along axis 0");
            FAILS(LEAFLESS_E_DAMAGED, check_tridexels(LEAFLESS_OPERATION_UNION, model, viewed, NULL, &result));
            FAILS(LEAFLESS_E_DAMAGED, leafless_tridexel_editor_combine(editor, LEAFLESS_OPERATION_DIFFERENCE, viewed, NULL, NULL));
            FAILS(LEAFLESS_E_DAMAGED, tridexel_save(viewed, "damaged.lfl", 11));
            leafless_tridexel_free(viewed);
            free(file);
        }
        OK(leafless_init(&options, sizeof options));
        options.max_bytes = 100;
        FAILS(LEAFLESS_E_LIMIT, leafless_tridexel_build(solid, &frame, LEAFLESS_RULE_SAMPLED, NULL, &options, &result));
        failed(LEAFLESS_E_LIMIT, "LEAFLESS_E_LIMIT", "100 bytes");
        options.max_bytes = 0;
        options.control = control;
        FAILS(LEAFLESS_E_CANCELLED, leafless_tridexel_editor_combine_solid(editor, LEAFLESS_OPERATION_DIFFERENCE, solid, &options, NULL));
        failed(LEAFLESS_E_CANCELLED, "LEAFLESS_E_CANCELLED", "cancelled");
        options.control = NULL;
        CHECK(result == (leafless_tridexel *)UNTOUCHED && count == 77 && offset_count == 77);
        leafless_tridexel_editor_free(editor);
        leafless_tridexel_free(column);
        leafless_tridexel_free(other);
        leafless_tridexel_free(model);
    }

    FAILS(LEAFLESS_E_PANIC, leafless_test_panic());
    failed(LEAFLESS_E_PANIC, "LEAFLESS_E_PANIC", "as the test wanted");

    {
        leafless_lazy *lazy = NULL;
        FAILS(LEAFLESS_E_SOURCE, leafless_lazy_resume(ball, solid, &frame, NULL, &lazy));
        failed(LEAFLESS_E_SOURCE, "LEAFLESS_E_SOURCE", "fingerprint");
        CHECK(lazy == NULL);
    }

    {
        /* A function called for a cell of an octree uses that octree. */
        leafless_lazy *lazy = NULL;
        leafless_solid_callbacks callbacks;
        leafless_solid *host = NULL;
        OK(leafless_init(&callbacks, sizeof callbacks));
        callbacks.classify = uses_the_octree;
        callbacks.ctx = &lazy;
        OK(leafless_solid_new_callbacks(&callbacks, &host));
        OK(leafless_lazy_new(host, &frame, &lazy));
        FAILS(LEAFLESS_E_CALLBACK, leafless_lazy_refine(lazy, NULL, 1, NULL, NULL));
        failed(LEAFLESS_E_CALLBACK, "LEAFLESS_E_CALLBACK", "-20");
        leafless_lazy_free(lazy);
        leafless_solid_free(host);
    }

    CHECK(octree == UNTOUCHED && mesh == (leafless_mesh *)UNTOUCHED);
    for (i = 0; strcmp(leafless_status_name((int32_t)i), "LEAFLESS_E_UNKNOWN") != 0; i++) {
        if (!seen[i]) {
            fprintf(stderr, "%s was never provoked\n", leafless_status_name((int32_t)i));
            return 1;
        }
    }
    CHECK(i == 22);

    free(bytes);
    leafless_control_free(control);
    leafless_solid_free(solid);
    leafless_mesh_free(cube);
    leafless_octree_free(ball);
    leafless_octree_free(finer);
    return 0;
}
