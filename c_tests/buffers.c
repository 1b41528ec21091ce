/* Two-step buffers: the needed size comes first; every smaller capacity is refused with the count left as it was; no
   byte is written beyond a capacity. */
#include "check.h"

enum { GUARD = 64 };

/* Memory of `size` bytes that begins with GUARD bytes of 0xc3 and ends with as many. */
static unsigned char *guarded(size_t size) {
    unsigned char *start = (unsigned char *)malloc(size + 2 * GUARD);
    CHECK(start != NULL);
    memset(start, 0xc3, size + 2 * GUARD);
    return start + GUARD;
}

static void intact(const unsigned char *buffer, size_t size) {
    size_t i;
    for (i = 0; i < GUARD; i++) {
        CHECK(buffer[-1 - (long)i] == 0xc3 && buffer[size + i] == 0xc3);
    }
}

static void release(unsigned char *buffer) {
    free(buffer - GUARD);
}

typedef leafless_status (*two_step)(void *buffer, uint64_t capacity, uint64_t *count);

static leafless_octree *octree;
static leafless_mesh *mesh, *holed;
static uint8_t *bytes;
static uint64_t length;

static leafless_status octree_bytes(void *buffer, uint64_t capacity, uint64_t *count) {
    return octree_to_bytes(octree, (uint8_t *)buffer, capacity, count);
}

static leafless_status stl_bytes(void *buffer, uint64_t capacity, uint64_t *count) {
    return mesh_to_stl(mesh, (uint8_t *)buffer, capacity, count);
}

static leafless_status levels(void *buffer, uint64_t capacity, uint64_t *count) {
    return leafless_octree_levels(octree, (leafless_statistics *)buffer, capacity, count);
}

static leafless_status open_cells(void *buffer, uint64_t capacity, uint64_t *count) {
    return leafless_octree_open_cells(octree, 4, (uint64_t *)buffer, capacity, count);
}

static leafless_status statistics_with(void *buffer, uint64_t capacity, uint64_t *count) {
    return leafless_octree_statistics_with(octree, 1, NULL, 0, NULL, 0, (leafless_statistics *)buffer, capacity, count);
}

static leafless_status sections(void *buffer, uint64_t capacity, uint64_t *count) {
    leafless_file_info probe = LEAFLESS_INIT(leafless_file_info);
    const leafless_status status =
        probe_bytes(bytes, length, &probe, (leafless_file_section *)buffer, capacity);
    if (status == LEAFLESS_OK) {
        *count = probe.sections;
    }
    return status;
}

static leafless_status file_sections(void *buffer, uint64_t capacity, uint64_t *count) {
    leafless_file_info probe = LEAFLESS_INIT(leafless_file_info);
    const leafless_status status =
        probe_path("buffers.lfl", 11, &probe, (leafless_file_section *)buffer, capacity);
    if (status == LEAFLESS_OK) {
        *count = probe.sections;
    }
    return status;
}

static leafless_status vertices(void *buffer, uint64_t capacity, uint64_t *count) {
    uint64_t other;
    const leafless_status status = leafless_mesh_copy(mesh, (double *)buffer, capacity, NULL, 0);
    if (status == LEAFLESS_OK) {
        OK(check_counts(mesh, count, &other));
    }
    return status;
}

static leafless_status defects(void *buffer, uint64_t capacity, uint64_t *count) {
    return leafless_mesh_defects(holed, UINT64_MAX, (leafless_mesh_defect *)buffer, capacity, count);
}

static leafless_status triangles(void *buffer, uint64_t capacity, uint64_t *count) {
    uint64_t other;
    const leafless_status status = leafless_mesh_copy(mesh, NULL, 0, (uint32_t *)buffer, capacity);
    if (status == LEAFLESS_OK) {
        OK(check_counts(mesh, &other, count));
    }
    return status;
}

/* Whether two arrays are the same but for the bytes of each element from `padding` on, up to a multiple of 8. */
static bool same(const unsigned char *a, const unsigned char *b, size_t count, size_t element, size_t padding) {
    size_t i;
    for (i = 0; i < count * element; i++) {
        if ((i % element < padding || i % element >= (padding + 7) / 8 * 8) && a[i] != b[i]) {
            return false;
        }
    }
    return true;
}

/* `padding` is where an element has bytes that belong to no field, or its size. */
static void check(two_step function, size_t element, size_t padding) {
    uint64_t needed = 0, count, capacity;
    unsigned char *first;
    OK(function(NULL, 0, &needed));
    CHECK(needed > 0);
    first = guarded((size_t)needed * element);
    for (capacity = 0; capacity <= needed + 1; capacity++) {
        unsigned char *buffer = guarded((size_t)capacity * element);
        count = 0x77;
        if (capacity < needed) {
            char expected[64], message[512];
            FAILS(LEAFLESS_E_BUFFER, function(buffer, capacity, &count));
            CHECK(count == 0x77);
            /* The message has both numbers. */
            (void)leafless_last_error(message, sizeof message);
            snprintf(expected, sizeof expected, "a capacity of %lu, and %lu is needed", (unsigned long)capacity,
                     (unsigned long)needed);
            CHECK(strstr(message, expected) != NULL);
        } else {
            OK(function(buffer, capacity, &count));
            CHECK(count == needed);
            if (capacity == needed) {
                memcpy(first, buffer, (size_t)needed * element);
            } else {
                /* The same again; what is beyond stays as it was. */
                size_t i;
                CHECK(same(first, buffer, (size_t)needed, element, padding));
                for (i = 0; i < element; i++) {
                    CHECK(buffer[(size_t)needed * element + i] == 0xc3);
                }
            }
        }
        intact(buffer, (size_t)capacity * element);
        release(buffer);
    }
    release(first);
}

int main(void) {
    const size_t named = offsetof(leafless_file_section, name) + sizeof(((leafless_file_section *)0)->name);
    const size_t kind = offsetof(leafless_mesh_defect, kind) + sizeof(leafless_defect);
    octree = check_ball(4, LEAFLESS_RULE_CERTIFIED);
    mesh = check_cube();
    holed = check_some_of_cube(7);
    bytes = check_bytes(octree, &length);
    check_write("buffers.lfl", bytes, (size_t)length);

    check(octree_bytes, 1, 1);
    check(stl_bytes, 1, 1);
    check(levels, sizeof(leafless_statistics), sizeof(leafless_statistics));
    check(open_cells, sizeof(uint64_t), sizeof(uint64_t));
    check(statistics_with, sizeof(leafless_statistics), sizeof(leafless_statistics));
    check(sections, sizeof(leafless_file_section), named);
    check(file_sections, sizeof(leafless_file_section), named);
    check(vertices, 3 * sizeof(double), 3 * sizeof(double));
    check(defects, sizeof(leafless_mesh_defect), kind);
    check(triangles, 3 * sizeof(uint32_t), 3 * sizeof(uint32_t));

    /* If one of two buffers is too small, the other is not written either. */
    {
        double numbers[8][3];
        uint32_t indices[12][3];
        size_t i;
        memset(numbers, 0x5a, sizeof numbers);
        memset(indices, 0x5a, sizeof indices);
        FAILS(LEAFLESS_E_BUFFER, leafless_mesh_copy(mesh, &numbers[0][0], 8, &indices[0][0], 11));
        FAILS(LEAFLESS_E_BUFFER, leafless_mesh_copy(mesh, &numbers[0][0], 7, &indices[0][0], 12));
        for (i = 0; i < sizeof numbers; i++) {
            CHECK(((unsigned char *)numbers)[i] == 0x5a);
        }
        for (i = 0; i < sizeof indices; i++) {
            CHECK(((unsigned char *)indices)[i] == 0x5a);
        }
    }

    /* Messages, whose capacity counts bytes: always terminated, never beyond. */
    {
        const size_t whole = leafless_last_error(NULL, 0);
        size_t capacity;
        CHECK(whole > 0);
        for (capacity = 0; capacity <= whole + 2; capacity++) {
            unsigned char *buffer = guarded(capacity);
            CHECK(leafless_last_error((char *)buffer, capacity) == whole);
            if (capacity > 0) {
                CHECK(strlen((char *)buffer) == (capacity - 1 < whole ? capacity - 1 : whole));
            }
            intact(buffer, capacity);
            release(buffer);
        }
    }
    /* A message is never longer than 511 bytes, and is cut between characters: of two bytes each here. */
    {
        char path[2000], message[512];
        size_t whole, i;
        for (i = 0; i < sizeof path; i += 2) {
            memcpy(path + i, "\xc3\xa4", 2);
        }
        FAILS(LEAFLESS_E_IO, octree_open(path, sizeof path, &octree));
        whole = leafless_last_error(message, sizeof message);
        CHECK(whole == strlen(message) && whole <= 511);
        for (i = 1; i <= whole; i++) {
            CHECK(leafless_last_error(message, i) == whole);
            CHECK(strlen(message) < i && ((unsigned char)message[strlen(message)] == 0));
            CHECK(strlen(message) == 0 || (unsigned char)message[strlen(message) - 1] != 0xc3);
        }
    }
    /* Many points, and room for as many answers. */
    {
        const double points[3][3] = {{0, 0, 0}, {0.99, 0.99, 0.99}, {2, 2, 2}};
        leafless_membership *answers = (leafless_membership *)guarded(3);
        OK(leafless_octree_contains_many(octree, &points[0][0], 2, answers));
        CHECK(answers[0] == LEAFLESS_MEMBERSHIP_INSIDE && answers[1] == LEAFLESS_MEMBERSHIP_OUTSIDE && answers[2] == 0xc3);
        OK(leafless_octree_contains_many(octree, &points[0][0], 3, answers));
        CHECK(answers[2] == LEAFLESS_MEMBERSHIP_UNDECIDED);
        intact((unsigned char *)answers, 3);
        release((unsigned char *)answers);
    }
    free(bytes);
    leafless_mesh_free(holed);
    leafless_mesh_free(mesh);
    leafless_octree_free(octree);
    return 0;
}
