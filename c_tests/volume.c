/* Volumes: arrays of every type, in place and copied; bands, frames and bounds; files; the cells of a box as bits.
   All of it against the samples themselves, voxel by voxel. */
#include "check.h"

enum { NX = 21, NY = 18, NZ = 13, COUNT_ALL = NX * NY * NZ };

/* Two blobs and some noise: 0 to 120, in whole numbers, so that every type holds it. */
static int value(int x, int y, int z) {
    const int a = (x - 6) * (x - 6) + (y - 7) * (y - 7) + (z - 6) * (z - 6);
    const int b = (x - 15) * (x - 15) + (y - 11) * (y - 11) + (z - 5) * (z - 5);
    const int nearer = a < b ? a : b, noise = (x * 7 + y * 13 + z * 29) % 11;
    const int found = 110 - nearer + noise;
    return found < 0 ? 0 : found;
}

static size_t place(int x, int y, int z) {
    return (size_t)x + NX * ((size_t)y + NY * (size_t)z);
}

/* Whether the voxel is inside, for values from `low` to `high`. */
static bool inside(const leafless_interval *band, int x, int y, int z) {
    const int found = value(x, y, z);
    return band->lower <= found && found <= band->upper;
}

static leafless_volume_layout layout_of(uint32_t type) {
    leafless_volume_layout layout;
    OK(leafless_init(&layout, sizeof layout));
    layout.sample_type = type;
    layout.extents[0] = NX;
    layout.extents[1] = NY;
    layout.extents[2] = NZ;
    return layout;
}

/* The octree of a solid on the volume's own frame has these voxels, and nothing else. */
static leafless_octree *same_voxels(const leafless_volume *volume, const leafless_interval *band) {
    leafless_solid *solid = NULL;
    leafless_octree *octree = NULL;
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
    leafless_frame frame;
    uint32_t cell[3];
    OK(leafless_volume_frame(volume, &frame));
    CHECK(frame.depth == 5);
    OK(leafless_solid_from_volume(volume, band, NULL, &solid));
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &octree));
    OK(leafless_octree_describe(octree, &info));
    CHECK(info.is_binary);
    for (cell[2] = 0; cell[2] < 32; cell[2]++) {
        for (cell[1] = 0; cell[1] < 32; cell[1]++) {
            for (cell[0] = 0; cell[0] < 32; cell[0]++) {
                const int x = (int)cell[0], y = (int)cell[1], z = (int)cell[2];
                const bool in = x < NX && y < NY && z < NZ && inside(band, x, y, z);
                leafless_tag tag;
                OK(leafless_octree_tag_at(octree, cell, &tag));
                CHECK(tag == (in ? LEAFLESS_TAG_FULL : LEAFLESS_TAG_EMPTY));
            }
        }
    }
    leafless_solid_free(solid);
    return octree;
}

/* Bytes of a number's value in memory of this machine. */
static size_t put(uint8_t *to, uint32_t type, int number) {
#define PUT(c_type)                                                                                              \
    {                                                                                                            \
        const c_type typed = (c_type)number;                                                                     \
        memcpy(to, &typed, sizeof typed);                                                                        \
        return sizeof typed;                                                                                     \
    }
    switch (type) {
    case LEAFLESS_SAMPLE_TYPE_U8: PUT(uint8_t)
    case LEAFLESS_SAMPLE_TYPE_I8: PUT(int8_t)
    case LEAFLESS_SAMPLE_TYPE_U16: PUT(uint16_t)
    case LEAFLESS_SAMPLE_TYPE_I16: PUT(int16_t)
    case LEAFLESS_SAMPLE_TYPE_U32: PUT(uint32_t)
    case LEAFLESS_SAMPLE_TYPE_I32: PUT(int32_t)
    case LEAFLESS_SAMPLE_TYPE_U64: PUT(uint64_t)
    case LEAFLESS_SAMPLE_TYPE_I64: PUT(int64_t)
    case LEAFLESS_SAMPLE_TYPE_F32: PUT(float)
    default: PUT(double)
    }
#undef PUT
}

/* All samples as an array of this type, from `to` on; its length in bytes. */
static size_t fill(uint8_t *to, uint32_t type, bool reverse) {
    size_t length = 0, size, i;
    int x, y, z;
    for (z = 0; z < NZ; z++) {
        for (y = 0; y < NY; y++) {
            for (x = 0; x < NX; x++) {
                uint8_t *const at = to + length;
                length += size = put(at, type, value(x, y, z));
                for (i = 0; reverse && i < size / 2; i++) {
                    const uint8_t byte = at[i];
                    at[i] = at[size - 1 - i];
                    at[size - 1 - i] = byte;
                }
            }
        }
    }
    return length;
}

static bool is_little(void) {
    const uint16_t one = 1;
    uint8_t first;
    memcpy(&first, &one, 1);
    return first == 1;
}

static void arrays(void) {
    /* What each type becomes. */
    static const uint32_t TYPES[][2] = {
        {LEAFLESS_SAMPLE_TYPE_U8, LEAFLESS_SAMPLE_TYPE_U8},   {LEAFLESS_SAMPLE_TYPE_U16, LEAFLESS_SAMPLE_TYPE_U16},
        {LEAFLESS_SAMPLE_TYPE_I16, LEAFLESS_SAMPLE_TYPE_I16}, {LEAFLESS_SAMPLE_TYPE_F32, LEAFLESS_SAMPLE_TYPE_F32},
        {LEAFLESS_SAMPLE_TYPE_I8, LEAFLESS_SAMPLE_TYPE_I16},  {LEAFLESS_SAMPLE_TYPE_I32, LEAFLESS_SAMPLE_TYPE_F32},
        {LEAFLESS_SAMPLE_TYPE_U32, LEAFLESS_SAMPLE_TYPE_F32}, {LEAFLESS_SAMPLE_TYPE_I64, LEAFLESS_SAMPLE_TYPE_F32},
        {LEAFLESS_SAMPLE_TYPE_U64, LEAFLESS_SAMPLE_TYPE_F32}, {LEAFLESS_SAMPLE_TYPE_F64, LEAFLESS_SAMPLE_TYPE_F32}};
    static uint64_t samples[COUNT_ALL + 8];
    static uint8_t becomes[COUNT_ALL * 4];
    uint8_t *const bytes = (uint8_t *)samples;
    const leafless_interval band = {60, INFINITY};
    leafless_octree *first = NULL;
    size_t i;
    int reverse, way;
    for (i = 0; i < COUNT(TYPES); i++) {
        for (reverse = 0; reverse < 2; reverse++) {
            /* Copied from an aligned address, from another with bytes before, and in place. */
            for (way = 0; way < 3; way++) {
                leafless_volume_layout layout = layout_of(TYPES[i][0]);
                const size_t skip = way == 1 ? 5 : 0, length = fill(bytes + skip, TYPES[i][0], reverse);
                const bool in_place = way == 2 && !reverse && TYPES[i][0] == TYPES[i][1];
                leafless_volume *volume = NULL;
                leafless_octree *octree;
                leafless_volume_info info = LEAFLESS_INIT(leafless_volume_info);
                leafless_interval range;
                const void *peeked;
                uint64_t peeked_length;
                if (way == 2 && !in_place) {
                    continue;
                }
                layout.skip = skip;
                if (reverse || way == 1) {
                    layout.byte_order = is_little() == (reverse == 0) ? LEAFLESS_BYTE_ORDER_LITTLE
                                                                      : LEAFLESS_BYTE_ORDER_BIG;
                }
                if (in_place) {
                    OK(volume_in_place(&layout, bytes, length, &volume));
                } else {
                    OK(volume_of_array(&layout, bytes, length + skip, &volume));
                }
                FAILS(LEAFLESS_E_ARGUMENT, volume_of_array(&layout, bytes, length + skip - 1, &volume));
                FAILS(LEAFLESS_E_ARGUMENT, volume_of_array(&layout, bytes, length + skip + 1, &volume));
                OK(leafless_volume_describe(volume, &info));
                CHECK(info.extents[0] == NX && info.extents[1] == NY && info.extents[2] == NZ);
                CHECK(info.sample_type == TYPES[i][1] && info.file_type == TYPES[i][0]);
                CHECK(info.format == LEAFLESS_VOLUME_FORMAT_RAW && info.unit == LEAFLESS_UNIT_UNKNOWN);
                CHECK(info.sample_count == COUNT_ALL && info.rounded == 0 && !info.is_placed);
                CHECK(info.spacing_model[2] == 1 && info.corner_model[0] == 0 && info.placement[5] == 1);
                OK(leafless_volume_peek_samples(volume, &peeked, &peeked_length));
                CHECK(peeked_length == fill(becomes, TYPES[i][1], false));
                CHECK(memcmp(peeked, becomes, (size_t)peeked_length) == 0 && (peeked == bytes) == in_place);
                OK(leafless_volume_range(volume, NULL, &range));
                CHECK(range.lower == 0 && range.upper > 110 && range.upper <= 120);
                octree = same_voxels(volume, &band);
                if (first == NULL) {
                    first = octree;
                } else {
                    CHECK(check_same(octree, first));
                    leafless_octree_free(octree);
                }
                leafless_volume_free(volume);
            }
        }
    }
    leafless_octree_free(first);
}

/* Bits in words and in bytes, and the bitmap of the octree that they become. */
static void bits(void) {
    static uint64_t words[NY * NZ], again[NY * NZ], others[NY * NZ];
    static uint8_t bytes[3 * NY * NZ];
    const leafless_interval band = {60, INFINITY}, zeros = {-INFINITY, 0};
    const uint32_t min[3] = {0, 0, 0}, max[3] = {NX, NY, NZ};
    leafless_volume_layout layout = layout_of(LEAFLESS_SAMPLE_TYPE_BITS);
    leafless_volume *in_place = NULL, *copied = NULL, *packed = NULL;
    leafless_octree *octree[3], *outside;
    leafless_solid *solid = NULL;
    leafless_volume_info info = LEAFLESS_INIT(leafless_volume_info);
    leafless_interval range;
    leafless_frame frame;
    uint64_t count;
    int x, y, z;
    for (z = 0; z < NZ; z++) {
        for (y = 0; y < NY; y++) {
            for (x = 0; x < NX; x++) {
                if (inside(&band, x, y, z)) {
                    words[y + NY * z] |= (uint64_t)1 << x;
                    bytes[3 * (y + NY * z) + x / 8] |= (uint8_t)(1 << x % 8);
                }
            }
            /* What lies beyond a row does not count. */
            words[y + NY * z] |= (uint64_t)0xabc << 40;
        }
    }
    OK(volume_in_place(&layout, words, sizeof words, &in_place));
    OK(volume_of_array(&layout, words, sizeof words, &copied));
    layout.sample_type = LEAFLESS_SAMPLE_TYPE_BITS_IN_BYTES;
    OK(volume_of_array(&layout, bytes, sizeof bytes, &packed));
    FAILS(LEAFLESS_E_ARGUMENT, volume_in_place(&layout, bytes, sizeof bytes, &packed));
    OK(leafless_volume_describe(packed, &info));
    CHECK(info.sample_type == LEAFLESS_SAMPLE_TYPE_BITS && info.file_type == LEAFLESS_SAMPLE_TYPE_BITS_IN_BYTES);
    CHECK(info.default_threshold == 0.5);
    OK(leafless_volume_range(packed, NULL, &range));
    CHECK(range.lower == 0 && range.upper == 1);
    /* A band of values: 1 is inside, or 0 is. */
    {
        const leafless_interval ones = {0.5, INFINITY};
        leafless_solid *of_band = NULL;
        OK(leafless_volume_frame(in_place, &frame));
        OK(leafless_solid_from_volume(in_place, NULL, NULL, &solid));
        OK(leafless_solid_from_volume(in_place, &ones, NULL, &of_band));
        OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_SAMPLED, NULL, &octree[0]));
        OK(leafless_octree_build(of_band, &frame, LEAFLESS_RULE_SAMPLED, NULL, &octree[1]));
        CHECK(check_same(octree[0], octree[1]));
        leafless_octree_free(octree[1]);
        leafless_solid_free(of_band);
        leafless_solid_free(solid);
        OK(leafless_solid_from_volume(in_place, &zeros, NULL, &solid));
        OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_SAMPLED, NULL, &outside));
        leafless_solid_free(solid);
    }
    OK(leafless_solid_from_volume(copied, NULL, NULL, &solid));
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_SAMPLED, NULL, &octree[1]));
    leafless_solid_free(solid);
    OK(leafless_solid_from_volume(packed, NULL, NULL, &solid));
    /* The solid keeps the samples. */
    leafless_volume_free(packed);
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_SAMPLED, NULL, &octree[2]));
    leafless_solid_free(solid);
    CHECK(check_same(octree[0], octree[1]) && check_same(octree[0], octree[2]));
    /* And back. */
    OK(leafless_octree_bitmap(octree[0], frame.depth, min, max, NULL, NULL, NULL, 0, &count));
    CHECK(count == COUNT(words));
    FAILS(LEAFLESS_E_BUFFER,
          leafless_octree_bitmap(octree[0], frame.depth, min, max, NULL, again, NULL, count - 1, &count));
    OK(leafless_octree_bitmap(octree[0], frame.depth, min, max, NULL, again, others, COUNT(again), &count));
    for (y = 0; y < NY * NZ; y++) {
        CHECK(again[y] == (words[y] & 0x1fffff) && others[y] == again[y]);
    }
    OK(leafless_octree_bitmap(outside, frame.depth, min, max, NULL, again, NULL, COUNT(again), &count));
    for (y = 0; y < NY * NZ; y++) {
        CHECK(again[y] == (~words[y] & 0x1fffff));
    }
    leafless_octree_free(outside);
    leafless_octree_free(octree[0]);
    leafless_octree_free(octree[1]);
    leafless_octree_free(octree[2]);
    leafless_volume_free(in_place);
    leafless_volume_free(copied);
}

/* Boxes of cells of a certified ball, at all levels, against the cells one by one. */
static void bitmaps(void) {
    static uint64_t inner[32 * 32 + 1], outer[32 * 32 + 1];
    leafless_octree *octree = check_ball(5, LEAFLESS_RULE_CERTIFIED);
    leafless_cursor *cursor = NULL;
    leafless_options options;
    uint32_t level, box;
    OK(leafless_init(&options, sizeof options));
    options.threads = 2;
    OK(leafless_cursor_new(octree, &cursor));
    for (level = 0; level <= 5; level++) {
        for (box = 0; box < 4; box++) {
            const uint32_t all = 1u << level, from = box * all / 8;
            const uint32_t min[3] = {from, from / 2, 0}, max[3] = {all, all - from, all - box * all / 16};
            const uint32_t ny = max[1] - min[1], nz = max[2] - min[2];
            uint32_t x, y, z;
            uint64_t count;
            memset(inner, 0x5a, sizeof inner);
            memset(outer, 0x5a, sizeof outer);
            OK(leafless_octree_bitmap(octree, level, min, max, box == 1 ? &options : NULL, inner, outer, 32 * 32, &count));
            CHECK(count == ny * nz && inner[count] == outer[count] && inner[count] == 0x5a5a5a5a5a5a5a5a);
            for (z = 0; z < nz; z++) {
                for (y = 0; y < ny; y++) {
                    CHECK(inner[y + ny * z] >> (max[0] - min[0]) == 0 && outer[y + ny * z] >> (max[0] - min[0]) == 0);
                    for (x = 0; x < max[0] - min[0]; x++) {
                        const uint32_t at[3] = {min[0] + x, min[1] + y, min[2] + z};
                        leafless_cursor_info state = LEAFLESS_INIT(leafless_cursor_info);
                        bool reached;
                        OK(leafless_cursor_seek(cursor, at, level, &reached));
                        OK(leafless_cursor_describe(cursor, &state));
                        CHECK((inner[y + ny * z] >> x & 1) == (state.tag == LEAFLESS_TAG_FULL));
                        CHECK((outer[y + ny * z] >> x & 1) == (state.tag != LEAFLESS_TAG_EMPTY));
                    }
                }
            }
        }
    }
    {
        const uint32_t min[3] = {3, 3, 3}, max[3] = {8, 3, 8}, beyond[3] = {9, 9, 33};
        uint64_t count = 7;
        OK(leafless_octree_bitmap(octree, 5, min, max, NULL, NULL, NULL, 0, &count));
        CHECK(count == 0);
        FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_bitmap(octree, 6, min, max, NULL, NULL, NULL, 0, &count));
        FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_bitmap(octree, 256, min, max, NULL, NULL, NULL, 0, &count));
        FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_bitmap(octree, 5, max, min, NULL, NULL, NULL, 0, &count));
        FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_bitmap(octree, 5, min, beyond, NULL, NULL, NULL, 0, &count));
        FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_bitmap(octree, 5, min, beyond, NULL, inner, NULL, 32, &count));
        CHECK(count == 0);
    }
    leafless_cursor_free(cursor);
    leafless_octree_free(octree);
}

static leafless_volume *bytes_volume(const double corner[3], const double spacing[3]) {
    static uint8_t samples[COUNT_ALL];
    leafless_volume_layout layout = layout_of(LEAFLESS_SAMPLE_TYPE_U8);
    leafless_volume *volume = NULL;
    memcpy(layout.corner_model, corner, sizeof layout.corner_model);
    memcpy(layout.spacing_model, spacing, sizeof layout.spacing_model);
    OK(volume_of_array(&layout, samples, fill(samples, LEAFLESS_SAMPLE_TYPE_U8, false), &volume));
    return volume;
}

static void bands_and_places(void) {
    const double corner[3] = {-3, 0.5, 2}, cubes[3] = {0.25, 0.25, 0.25}, boxes[3] = {0.25, 0.5, 1};
    const leafless_interval bands[] = {{60, INFINITY}, {30, 80}, {-INFINITY, 40}, {100, 101}, {119.5, 120.5}};
    const leafless_interval nan = {NAN, 3}, turned = {5, 3};
    leafless_volume *volume = bytes_volume(corner, cubes), *other;
    leafless_solid *solid = NULL, *unmade = NULL;
    leafless_octree *octree = NULL;
    leafless_volume_info info = LEAFLESS_INIT(leafless_volume_info);
    leafless_statistics statistics;
    leafless_frame frame;
    double min[3], max[3];
    uint64_t all = 0;
    size_t i;
    int x, y, z;
    /* One band after another: only the first call reads all samples. */
    for (i = 0; i < COUNT(bands); i++) {
        leafless_octree_free(same_voxels(volume, &bands[i]));
    }
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_from_volume(volume, &nan, NULL, &unmade));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_from_volume(volume, &turned, NULL, &unmade));
    CHECK(unmade == NULL);
    OK(leafless_volume_describe(volume, &info));
    CHECK(info.default_threshold == 127.5 && memcmp(info.corner_model, corner, sizeof corner) == 0);
    OK(leafless_volume_frame(volume, &frame));
    CHECK(frame.origin[0] == -3 && frame.origin[2] == 2 && frame.edge == 8 && frame.depth == 5);
    OK(leafless_volume_bounds(volume, min, max));
    CHECK(min[1] == 0.5 && max[0] == -3 + 0.25 * NX && max[1] == 0.5 + 0.25 * NY && max[2] == 2 + 0.25 * NZ);

    /* Voxels that are no cubes: any frame is allowed, and the volume lies within the proven bounds. */
    other = bytes_volume(corner, boxes);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_volume_frame(other, &frame));
    OK(leafless_volume_bounds(other, min, max));
    CHECK(min[0] == -3 && max[0] == -3 + 0.25 * NX && max[1] == 0.5 + 0.5 * NY && max[2] == 2 + NZ);
    OK(leafless_frame_around(min, max, 7, &frame));
    OK(leafless_solid_from_volume(other, &bands[0], NULL, &solid));
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &octree));
    OK(leafless_octree_statistics(octree, &statistics));
    for (z = 0; z < NZ; z++) {
        for (y = 0; y < NY; y++) {
            for (x = 0; x < NX; x++) {
                all += inside(&bands[0], x, y, z);
            }
        }
    }
    CHECK(statistics.volume_model.lower <= 0.125 * (double)all && 0.125 * (double)all <= statistics.volume_model.upper);
    CHECK(statistics.volume_model.upper < 0.125 * (double)all * 1.3);
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    leafless_volume_free(other);
    leafless_volume_free(volume);
}

static uint8_t *bytes_of(const leafless_volume *volume, uint32_t format, uint64_t *length) {
    uint8_t *bytes;
    uint64_t again;
    OK(volume_to_bytes(volume, format, NULL, 0, length));
    bytes = (uint8_t *)malloc((size_t)*length);
    CHECK(bytes != NULL);
    FAILS(LEAFLESS_E_BUFFER, volume_to_bytes(volume, format, bytes, *length - 1, &again));
    OK(volume_to_bytes(volume, format, bytes, *length, &again));
    CHECK(again == *length);
    return bytes;
}

static void same_file(const char *path, const uint8_t *bytes, uint64_t length) {
    size_t found;
    uint8_t *file = check_read(path, &found);
    CHECK(found == length && memcmp(file, bytes, found) == 0);
    free(file);
}

static void files(void) {
    static const uint32_t FORMATS[] = {LEAFLESS_VOLUME_FORMAT_NRRD, LEAFLESS_VOLUME_FORMAT_NRRD_GZIP};
    static const char *const PATHS[] = {"volume.nrrd", "volume_gzip.nrrd"};
    const double corner[3] = {-3, 0.5, 2}, spacing[3] = {0.25, 0.25, 0.25};
    const leafless_interval band = {60, INFINITY};
    leafless_volume *volume = bytes_volume(corner, spacing), *back = NULL;
    leafless_octree *octree = same_voxels(volume, &band), *again;
    leafless_volume_layout layout = layout_of(LEAFLESS_SAMPLE_TYPE_U8);
    leafless_volume_info info = LEAFLESS_INIT(leafless_volume_info);
    uint64_t length, lengths[2];
    uint8_t *bytes;
    size_t i;
    for (i = 0; i < 2; i++) {
        OK(volume_save(volume, FORMATS[i], PATHS[i], strlen(PATHS[i])));
        bytes = bytes_of(volume, FORMATS[i], &lengths[i]);
        same_file(PATHS[i], bytes, lengths[i]);
        OK(volume_from_bytes(bytes, lengths[i], NULL, 0, &back));
        OK(leafless_volume_describe(back, &info));
        CHECK(info.format == LEAFLESS_VOLUME_FORMAT_NRRD && info.file_type == LEAFLESS_SAMPLE_TYPE_U8 && !info.is_placed);
        CHECK(memcmp(info.corner_model, corner, sizeof corner) == 0 && info.spacing_model[1] == 0.25);
        leafless_volume_free(back);
        OK(volume_open(PATHS[i], strlen(PATHS[i]), &back));
        again = same_voxels(back, &band);
        CHECK(check_same(again, octree));
        leafless_octree_free(again);
        leafless_volume_free(back);
        /* Cut anywhere: refused. */
        for (length = 0; length < lengths[i]; length += 1 + length / 3) {
            FAILS(LEAFLESS_E_VOLUME_FILE, volume_from_bytes(bytes, length, NULL, 0, &back));
        }
        free(bytes);
    }
    CHECK(lengths[1] < lengths[0] && lengths[0] > COUNT_ALL);
    bytes = bytes_of(volume, LEAFLESS_VOLUME_FORMAT_RAW, &length);
    CHECK(length == COUNT_ALL);
    OK(volume_save(volume, LEAFLESS_VOLUME_FORMAT_RAW, "volume.raw", 10));
    same_file("volume.raw", bytes, length);
    free(bytes);
    memcpy(layout.corner_model, corner, sizeof corner);
    memcpy(layout.spacing_model, spacing, sizeof spacing);
    OK(volume_open_raw("volume.raw", 10, &layout, &back));
    again = same_voxels(back, &band);
    CHECK(check_same(again, octree));
    leafless_octree_free(again);
    leafless_volume_free(back);
    back = NULL;
    layout.extents[2]++;
    FAILS(LEAFLESS_E_VOLUME_FILE, volume_open_raw("volume.raw", 10, &layout, &back));
    FAILS(LEAFLESS_E_IO, volume_open_raw("no/such/file", 12, &layout, &back));
    FAILS(LEAFLESS_E_IO, volume_open("no/such/file", 12, &back));
    FAILS(LEAFLESS_E_IO, volume_save(volume, LEAFLESS_VOLUME_FORMAT_RAW, "no/such/file", 12));
    FAILS(LEAFLESS_E_VOLUME_FILE, volume_open("volume.raw", 10, &back));
    FAILS(LEAFLESS_E_VOLUME_FILE, volume_from_bytes(NULL, 0, NULL, 0, &back));
    FAILS(LEAFLESS_E_ARGUMENT, volume_save(volume, LEAFLESS_VOLUME_FORMAT_METAIMAGE, "volume.mha", 10));
    FAILS(LEAFLESS_E_ARGUMENT, volume_save(volume, 4, "volume.mha", 10));
    CHECK(back == NULL);
    leafless_octree_free(octree);
    leafless_volume_free(volume);
}

/* A header apart from its samples, MetaImage, and rotated axes. */
static void headers(void) {
    static const char DETACHED[] = "NRRD0004\ntype: int\ndimension: 3\nsizes: 2 2 2\nencoding: raw\nendian: little\n"
                                   "space units: \"mm\" \"mm\" \"mm\"\nspace dimension: 3\n"
                                   "space directions: (0,2,0) (-2,0,0) (0,0,2)\nspace origin: (10,20,30)\n"
                                   "data file: eight.raw\n";
    static const char META[] = "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n"
                               "ElementSpacing = 1 2 3\nOffset = 0.5 1 1.5\nElementDataFile = LOCAL\n";
    uint8_t data[32] = {0}, file[sizeof META - 1 + 8];
    const leafless_interval band = {1, INFINITY};
    leafless_volume *volume = NULL;
    leafless_volume_info info = LEAFLESS_INIT(leafless_volume_info);
    leafless_solid *solid = NULL;
    leafless_octree *octree = NULL;
    leafless_statistics statistics;
    leafless_frame frame;
    double min[3], max[3];
    char name[16];
    uint64_t length, i;
    for (i = 0; i < 8; i++) {
        data[4 * i] = (uint8_t)i;
    }
    OK(leafless_volume_data_file((const uint8_t *)DETACHED, sizeof DETACHED - 1, NULL, 0, &length));
    CHECK(length == 9);
    FAILS(LEAFLESS_E_BUFFER, leafless_volume_data_file((const uint8_t *)DETACHED, sizeof DETACHED - 1, name, 8, &length));
    OK(leafless_volume_data_file((const uint8_t *)DETACHED, sizeof DETACHED - 1, name, sizeof name, &length));
    CHECK(memcmp(name, "eight.raw", 9) == 0);
    FAILS(LEAFLESS_E_VOLUME_FILE,
          volume_from_bytes((const uint8_t *)DETACHED, sizeof DETACHED - 1, NULL, 0, &volume));
    FAILS(LEAFLESS_E_VOLUME_FILE,
          volume_from_bytes((const uint8_t *)DETACHED, sizeof DETACHED - 1, data, 31, &volume));
    CHECK(volume == NULL);
    OK(volume_from_bytes((const uint8_t *)DETACHED, sizeof DETACHED - 1, data, 32, &volume));
    OK(leafless_volume_describe(volume, &info));
    CHECK(info.unit == LEAFLESS_UNIT_MILLIMETRE && info.file_type == LEAFLESS_SAMPLE_TYPE_I32);
    CHECK(info.sample_type == LEAFLESS_SAMPLE_TYPE_F32 && info.default_threshold == -0.5 && info.is_placed);
    CHECK(info.placement[0] == 0 && info.placement[1] == -1 && info.placement[4] == 1 && info.placement[7] == 20);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_volume_frame(volume, &frame));
    FAILS(LEAFLESS_E_ARGUMENT, volume_to_bytes(volume, LEAFLESS_VOLUME_FORMAT_NRRD, NULL, 0, &length));
    OK(volume_to_bytes(volume, LEAFLESS_VOLUME_FORMAT_RAW, NULL, 0, &length));
    CHECK(length == 32);
    /* Voxels of 2³, rotated by a quarter turn: from 7 to 11, 19 to 23, 29 to 33. */
    OK(leafless_volume_bounds(volume, min, max));
    CHECK(min[0] <= 7 && min[0] > 6.999 && max[0] >= 11 && max[0] < 11.001 && min[1] <= 19 && max[1] >= 23);
    OK(leafless_frame_around(min, max, 6, &frame));
    OK(leafless_solid_from_volume(volume, &band, NULL, &solid));
    leafless_volume_free(volume);
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &octree));
    OK(leafless_octree_statistics(octree, &statistics));
    CHECK(statistics.volume_model.lower <= 56 && 56 <= statistics.volume_model.upper);
    CHECK(statistics.volume_model.lower > 45 && statistics.volume_model.upper < 70);
    {
        /* Sample (0, 0, 0) is 0, and the one beside it along the file's first axis, which is y, is not. */
        const double zero[3] = {10, 20, 30}, one[3] = {10, 22, 30};
        leafless_membership membership;
        OK(leafless_octree_contains(octree, zero, &membership));
        CHECK(membership == LEAFLESS_MEMBERSHIP_OUTSIDE);
        OK(leafless_octree_contains(octree, one, &membership));
        CHECK(membership == LEAFLESS_MEMBERSHIP_INSIDE);
    }
    leafless_octree_free(octree);
    leafless_solid_free(solid);

    memcpy(file, META, sizeof META - 1);
    for (i = 0; i < 8; i++) {
        file[sizeof META - 1 + i] = (uint8_t)(40 * i);
    }
    check_write("volume.mha", file, sizeof file);
    volume = NULL;
    OK(volume_open("volume.mha", 10, &volume));
    OK(leafless_volume_describe(volume, &info));
    CHECK(info.format == LEAFLESS_VOLUME_FORMAT_METAIMAGE && info.file_type == LEAFLESS_SAMPLE_TYPE_U8 && !info.is_placed);
    CHECK(info.corner_model[0] == 0 && info.corner_model[2] == 0 && info.spacing_model[2] == 3);
    OK(leafless_volume_data_file(file, sizeof file, NULL, 0, &length));
    CHECK(length == 0);
    {
        leafless_volume *reference = NULL;
        OK(leafless_volume_ref(volume, &reference));
        CHECK(reference == volume);
        leafless_volume_free(volume);
        OK(leafless_volume_describe(reference, &info));
        leafless_volume_free(reference);
    }
}

static void not_numbers(void) {
    static float samples[COUNT_ALL];
    leafless_volume_layout layout = layout_of(LEAFLESS_SAMPLE_TYPE_F32);
    const leafless_interval all = {-INFINITY, INFINITY};
    leafless_volume *volume = NULL;
    leafless_solid *solid = NULL;
    leafless_octree *octree = NULL;
    leafless_statistics statistics;
    leafless_interval range;
    leafless_frame frame;
    samples[place(3, 4, 5)] = NAN;
    samples[place(0, 0, 0)] = INFINITY;
    OK(volume_in_place(&layout, samples, sizeof samples, &volume));
    OK(leafless_volume_range(volume, NULL, &range));
    CHECK(range.lower == -INFINITY && range.upper == INFINITY);
    OK(leafless_volume_frame(volume, &frame));
    OK(leafless_solid_from_volume(volume, &all, NULL, &solid));
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_SAMPLED, NULL, &octree));
    OK(leafless_octree_statistics(octree, &statistics));
    CHECK(statistics.lower_cells == COUNT_ALL - 1 && statistics.upper_cells == COUNT_ALL - 1);
    leafless_octree_free(octree);
    leafless_solid_free(solid);
    leafless_volume_free(volume);
}

static void refused_layouts(void) {
    static uint64_t samples[COUNT_ALL];
    leafless_volume_layout layout;
    leafless_volume *volume = NULL;
    int axis;
#define REFUSED(change)                                                                                          \
    layout = layout_of(LEAFLESS_SAMPLE_TYPE_U16);                                                                     \
    change;                                                                                                      \
    FAILS(LEAFLESS_E_ARGUMENT, volume_of_array(&layout, samples, 2 * COUNT_ALL, &volume));                   \
    FAILS(LEAFLESS_E_ARGUMENT, volume_in_place(&layout, samples, 2 * COUNT_ALL, &volume))
    for (axis = 0; axis < 3; axis++) {
        REFUSED(layout.extents[axis] = 0);
        REFUSED(layout.extents[axis] = (1 << 20) + 1);
        REFUSED(layout.extents[axis] = UINT32_MAX);
        REFUSED(layout.extents[axis]++);
        REFUSED(layout.corner_model[axis] = NAN);
        REFUSED(layout.corner_model[axis] = INFINITY);
        /* One alone that is set is not the default. */
        REFUSED(layout.spacing_model[axis] = 1);
        REFUSED(layout.spacing_model[0] = layout.spacing_model[1] = layout.spacing_model[2] = 1;
                layout.spacing_model[axis] = -1);
    }
    REFUSED(layout.extents[0] = layout.extents[1] = layout.extents[2] = 1 << 20);
    REFUSED(layout.sample_type = 12);
    REFUSED(layout.sample_type = UINT32_MAX);
    REFUSED(layout.byte_order = 3);
    REFUSED(layout.skip = UINT64_MAX);
    REFUSED(layout.skip = 1);
    REFUSED(layout.struct_size = 0);
    REFUSED(layout.struct_size = UINT32_MAX);
    layout = layout_of(LEAFLESS_SAMPLE_TYPE_U16);
    FAILS(LEAFLESS_E_ARGUMENT, volume_in_place(&layout, samples, 2 * COUNT_ALL - 1, &volume));
    FAILS(LEAFLESS_E_ARGUMENT, volume_in_place(&layout, (char *)samples + 1, 2 * COUNT_ALL, &volume));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_init(&layout, 3));
    CHECK(volume == NULL);
}

int main(void) {
    arrays();
    bits();
    bitmaps();
    bands_and_places();
    files();
    headers();
    not_numbers();
    refused_layouts();
    return 0;
}
