/* Files: all ways in and out, and files that are cut short, flipped, removed and replaced. */
#define _POSIX_C_SOURCE 200809L
#include "check.h"

#include <unistd.h>

#define PATH(name) (name), strlen(name)

typedef leafless_status (*way_in)(const char *path, size_t path_length, leafless_octree **octree);

static const way_in WAYS[] = {octree_open, octree_map, octree_map_verified};

/* What `writes` was called with, one after the other. */
typedef struct sink {
    uint8_t *bytes;
    size_t length;
    size_t capacity;
    size_t calls;
    size_t fails_at;
} sink;

static int32_t writes(void *ctx, const uint8_t *bytes, uint64_t count) {
    sink *s = (sink *)ctx;
    if (s->calls++ == s->fails_at || s->length + count > s->capacity) {
        return 77;
    }
    memcpy(s->bytes + s->length, bytes, count);
    s->length += count;
    return 0;
}

/* Runs every query on a tree that may be damaged. All of them return. */
static void ask_everything(const leafless_octree *octree) {
    static const double POINTS[5][3] = {{0, 0, 0}, {0.7, 0, 0}, {-0.3, 0.4, 0.5}, {0.99, -0.99, 0.99}, {5, 5, 5}};
    const double low[3] = {-0.9, -0.9, -0.9}, high[3] = {0.9, 0.9, 0.9};
    leafless_membership answers[5];
    leafless_region region;
    leafless_statistics statistics;
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
    leafless_octree *result = NULL;
    leafless_options options;
    OK(leafless_octree_contains_many(octree, &POINTS[0][0], 5, answers));
    OK(leafless_octree_classify_box(octree, low, high, &region));
    OK(leafless_octree_statistics(octree, &statistics));
    OK(leafless_octree_describe(octree, &info));
    OK(leafless_init(&options, sizeof options));
    options.threads = 1;
    if (leafless_octree_complement(octree, &options, &result) == LEAFLESS_OK) {
        leafless_octree_free(result);
    }
    (void)leafless_octree_check(octree);
}

/* Bytes that no verified way in may take; a plain one may, and then must stay in bounds. */
static void refused(uint8_t *bytes, uint64_t length, const leafless_octree *original, bool in_files) {
    leafless_octree *octree = NULL;
    leafless_status status;
    CHECK(verify_bytes(bytes, length) != LEAFLESS_OK);
    status = octree_from_bytes(bytes, length, &octree);
    CHECK(octree == NULL);
    CHECK(status == LEAFLESS_E_FORMAT || status == LEAFLESS_E_DAMAGED || status == LEAFLESS_E_VERSION);
    CHECK(octree_view_verified(bytes, length, &octree) == status && octree == NULL);
    status = octree_view_bytes(bytes, length, &octree);
    CHECK((status == LEAFLESS_OK) == (octree != NULL));
    if (status == LEAFLESS_OK) {
        ask_everything(octree);
        leafless_octree_free(octree);
        octree = NULL;
    }
    if (in_files) {
        check_write("damaged.lfl", bytes, (size_t)length);
        CHECK(octree_open(PATH("damaged.lfl"), &octree) != LEAFLESS_OK);
        CHECK(octree_map_verified(PATH("damaged.lfl"), &octree) != LEAFLESS_OK);
        CHECK(verify_path(PATH("damaged.lfl"), LEAFLESS_ACCESS_COPY) != LEAFLESS_OK);
        CHECK(verify_path(PATH("damaged.lfl"), LEAFLESS_ACCESS_MAP) != LEAFLESS_OK);
        CHECK(octree == NULL);
        if (octree_map(PATH("damaged.lfl"), &octree) == LEAFLESS_OK) {
            ask_everything(octree);
            leafless_octree_free(octree);
        }
    }
    (void)original;
}

static void ways_in_and_out(void) {
    leafless_octree *ball = check_ball(6, LEAFLESS_RULE_CERTIFIED), *named = NULL, *octree = NULL;
    leafless_file_info probe = LEAFLESS_INIT(leafless_file_info);
    leafless_file_info of_bytes = LEAFLESS_INIT(leafless_file_info);
    leafless_file_section sections[16], same[16];
    uint64_t length, i;
    size_t on_disk;
    uint8_t *bytes, *file;
    const char *value;
    size_t value_length;
    sink s;

    OK(leafless_octree_with_metadata(ball, "units", 5, "mm", 2, &named));
    OK(octree_save(named, PATH("ball.lfl")));
    bytes = check_bytes(named, &length);
    file = check_read("ball.lfl", &on_disk);
    CHECK(on_disk == length && memcmp(file, bytes, on_disk) == 0);
    free(file);

    for (i = 0; i < COUNT(WAYS); i++) {
        octree = NULL;
        OK(WAYS[i](PATH("ball.lfl"), &octree));
        CHECK(check_same(octree, ball));
        OK(leafless_octree_check(octree));
        OK(leafless_octree_peek_metadata(octree, "units", 5, &value, &value_length));
        CHECK(value_length == 2 && memcmp(value, "mm", 2) == 0);
        leafless_octree_free(octree);
    }
    OK(verify_bytes(bytes, length));
    OK(verify_path(PATH("ball.lfl"), LEAFLESS_ACCESS_COPY));
    OK(verify_path(PATH("ball.lfl"), LEAFLESS_ACCESS_MAP_VERIFIED));
    OK(octree_view_verified(bytes, length, &octree));
    CHECK(check_same(octree, ball));
    leafless_octree_free(octree);
    OK(octree_from_bytes(bytes, length, &octree));
    CHECK(check_same(octree, ball));
    leafless_octree_free(octree);
    OK(octree_view_bytes(bytes, length, &octree));
    CHECK(check_same(octree, ball));
    /* What is read in place is the host's: no copy was made of it. */
    OK(leafless_octree_peek_metadata(octree, "units", 5, &value, &value_length));
    CHECK(value_length == 2);
    leafless_octree_free(octree);

    OK(probe_path(PATH("ball.lfl"), &probe, sections, COUNT(sections)));
    CHECK(probe.major == 0 && probe.frame.depth == 6 && probe.frame.edge == 2.0 && probe.file_length == length);
    CHECK(probe.root == LEAFLESS_TAG_BRANCH && probe.exterior == LEAFLESS_TAG_EMPTY && !probe.is_binary);
    CHECK(probe.sections > 2 && probe.sections <= COUNT(sections));
    for (i = 0; i < probe.sections; i++) {
        CHECK(sections[i].name[0] != '\0' && sections[i].name[23] == '\0');
        CHECK(sections[i].offset % 64 == 0 && sections[i].length > 0);
        CHECK(i == 0 || sections[i].offset >= sections[i - 1].offset + sections[i - 1].length);
        CHECK(sections[i].offset + sections[i].length <= length);
    }
    CHECK(strcmp(sections[0].name, "objects") == 0 && sections[0].is_required && sections[0].owner == 0);
    CHECK(strcmp(sections[1].name, "metadata") == 0 && !sections[1].is_required && sections[1].owner == 0);
    CHECK(probe.proof.full && probe.proof.empty && probe.proof.displacement_model == 0.0);
    memset(&of_bytes, 0xaa, sizeof of_bytes);
    of_bytes.struct_size = sizeof of_bytes;
    OK(probe_bytes(bytes, length, &of_bytes, same, COUNT(same)));
    CHECK(of_bytes.sections == probe.sections && of_bytes.elements == probe.elements);
    CHECK(same[1].offset == sections[1].offset && same[1].kind == sections[1].kind);
    OK(probe_path(PATH("ball.lfl"), &probe, NULL, 0));

    /* The same bytes through a function, as often as it takes; every call of it may fail. */
    s.bytes = (uint8_t *)malloc((size_t)length);
    CHECK(s.bytes != NULL);
    s.capacity = (size_t)length;
    s.length = s.calls = 0;
    s.fails_at = SIZE_MAX;
    OK(octree_write_to(named, writes, &s));
    CHECK(s.length == length && memcmp(s.bytes, bytes, s.length) == 0);
    {
        const size_t calls = s.calls;
        CHECK(calls > 0);
        for (i = 0; i < calls; i++) {
            char message[512];
            s.length = s.calls = 0;
            s.fails_at = (size_t)i;
            FAILS(LEAFLESS_E_CALLBACK, octree_write_to(named, writes, &s));
            CHECK(s.calls == i + 1);
            (void)leafless_last_error(message, sizeof message);
            CHECK(strstr(message, "77") != NULL);
        }
    }
    free(s.bytes);
    free(bytes);
    leafless_octree_free(named);

    /* A file states what its cells prove. */
    OK(leafless_octree_with_proof(ball, LEAFLESS_PROVEN_EMPTY, 0.5, &named));
    OK(octree_save(named, PATH("ball.lfl")));
    leafless_octree_free(named);
    OK(probe_path(PATH("ball.lfl"), &probe, NULL, 0));
    CHECK(!probe.proof.full && probe.proof.empty && probe.proof.displacement_model == 0.5);
    for (i = 0; i < COUNT(WAYS); i++) {
        leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
        OK(WAYS[i](PATH("ball.lfl"), &octree));
        OK(leafless_octree_describe(octree, &info));
        CHECK(!info.proof.full && info.proof.empty && info.proof.displacement_model == 0.5);
        leafless_octree_free(octree);
    }
    leafless_octree_free(ball);
}

static void truncated(void) {
    leafless_octree *ball = check_ball(3, LEAFLESS_RULE_CERTIFIED), *octree = NULL;
    uint64_t length, cut;
    size_t way;
    uint8_t *bytes = check_bytes(ball, &length);
    leafless_file_info probe = LEAFLESS_INIT(leafless_file_info);
    OK(octree_save(ball, PATH("cut.lfl")));
    for (cut = length; cut-- > 0;) {
        /* Exactly as long, so that memory checkers see every byte beyond the end. */
        uint64_t *exact = (uint64_t *)malloc((size_t)cut + (cut == 0));
        leafless_status status;
        CHECK(exact != NULL);
        memcpy(exact, bytes, (size_t)cut);
        FAILS(LEAFLESS_E_FORMAT, verify_bytes((uint8_t *)exact, cut));
        FAILS(LEAFLESS_E_FORMAT, octree_from_bytes((uint8_t *)exact, cut, &octree));
        FAILS(LEAFLESS_E_FORMAT, octree_view_bytes((uint8_t *)exact, cut, &octree));
        /* Header and section table may be there. */
        status = probe_bytes((uint8_t *)exact, cut, &probe, NULL, 0);
        CHECK(status == LEAFLESS_E_FORMAT || (status == LEAFLESS_OK && cut >= 128));
        free(exact);
        CHECK(truncate("cut.lfl", (off_t)cut) == 0);
        for (way = 0; way < COUNT(WAYS); way++) {
            FAILS(LEAFLESS_E_FORMAT, WAYS[way](PATH("cut.lfl"), &octree));
        }
        FAILS(LEAFLESS_E_FORMAT, probe_path(PATH("cut.lfl"), &probe, NULL, 0));
        CHECK(octree == NULL);
    }
    /* Nor longer. */
    {
        uint8_t *longer = (uint8_t *)calloc(1, (size_t)length + 8);
        CHECK(longer != NULL);
        memcpy(longer, bytes, (size_t)length);
        FAILS(LEAFLESS_E_FORMAT, verify_bytes(longer, length + 8));
        FAILS(LEAFLESS_E_FORMAT, octree_view_bytes(longer, length + 1, &octree));
        check_write("cut.lfl", longer, (size_t)length + 8);
        for (way = 0; way < COUNT(WAYS); way++) {
            FAILS(LEAFLESS_E_FORMAT, WAYS[way](PATH("cut.lfl"), &octree));
        }
        free(longer);
    }
    free(bytes);
    leafless_octree_free(ball);
}

static void flipped(void) {
    leafless_octree *ball = check_ball(4, LEAFLESS_RULE_CERTIFIED);
    uint64_t length, i;
    uint8_t *bytes = check_bytes(ball, &length);
    for (i = 0; i < length; i++) {
        static const uint8_t FLIPS[] = {0x01, 0x80, 0xff};
        size_t flip;
        for (flip = 0; flip < COUNT(FLIPS); flip++) {
            bytes[i] ^= FLIPS[flip];
            refused(bytes, length, ball, flip == 0 && i % 7 == 0);
            bytes[i] ^= FLIPS[flip];
        }
    }
    OK(verify_bytes(bytes, length));
    free(bytes);
    leafless_octree_free(ball);
}

static void removed_and_replaced(void) {
    leafless_octree *ball = check_ball(6, LEAFLESS_RULE_CERTIFIED), *box = check_box(6, -0.5, 0.5);
    leafless_octree *first = NULL, *second = NULL;
    leafless_solid *solid = NULL;
    leafless_cursor *cursor = NULL;
    leafless_cursor_info state = LEAFLESS_INIT(leafless_cursor_info);
    leafless_frame frame = check_frame(6);

    OK(octree_save(ball, PATH("one.lfl")));
    OK(octree_map(PATH("one.lfl"), &first));
    /* Another solid takes the name. The mapping stays unchanged. */
    OK(octree_save(box, PATH("one.lfl")));
    OK(octree_map(PATH("one.lfl"), &second));
    CHECK(check_same(first, ball) && check_same(second, box));
    CHECK(unlink("one.lfl") == 0);
    CHECK(check_same(first, ball) && check_same(second, box));
    OK(leafless_octree_check(first));
    /* A mapped one is saved over its own file. */
    OK(octree_save(first, PATH("one.lfl")));
    leafless_octree_free(second);
    OK(octree_map_verified(PATH("one.lfl"), &second));
    OK(octree_save(second, PATH("one.lfl")));
    CHECK(check_same(second, ball));
    /* What was made of the mapping keeps it. */
    OK(leafless_solid_from_octree(second, &solid));
    OK(leafless_cursor_new(second, &cursor));
    leafless_octree_free(second);
    CHECK(unlink("one.lfl") == 0);
    OK(leafless_cursor_descend(cursor, 5, NULL));
    OK(leafless_cursor_describe(cursor, &state));
    CHECK(state.level == 1 && state.cell[0] == 1 && state.cell[1] == 0 && state.cell[2] == 1);
    leafless_cursor_free(cursor);
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &second));
    CHECK(check_same(second, ball));
    leafless_solid_free(solid);
    leafless_octree_free(first);
    leafless_octree_free(second);
    leafless_octree_free(ball);
    leafless_octree_free(box);
}

static void what_cannot_be_saved(void) {
    enum { MIB = 1 << 20 };
    leafless_octree *ball = check_ball(5, LEAFLESS_RULE_CERTIFIED), *half = NULL, *big = NULL, *old = NULL;
    const size_t rest = MIB - (8 + 4 + MIB / 2) - (8 + 4);
    char *much = (char *)malloc(MIB);
    uint64_t length = 77;
    CHECK(much != NULL);
    memset(much, 'm', MIB);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_with_metadata(ball, "much", 4, much, MIB, &big));
    CHECK(big == NULL);
    OK(leafless_octree_with_metadata(ball, "much", 4, much, MIB / 2, &half));
    /* What has been taken can be saved, to the last byte; another value takes the place of the old one. */
    FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_with_metadata(half, "more", 4, much, rest + 1, &big));
    CHECK(big == NULL);
    OK(leafless_octree_with_metadata(half, "more", 4, much, rest, &big));
    OK(octree_save(big, PATH("big.lfl")));
    OK(octree_to_bytes(big, NULL, 0, &length));
    CHECK(length > MIB);
    OK(octree_open(PATH("big.lfl"), &old));
    CHECK(check_same(old, ball));
    leafless_octree_free(old);
    leafless_octree_free(big);
    old = big = NULL;
    length = 77;
    OK(leafless_octree_with_metadata(half, "much", 4, much, MIB - 12, &big));
    OK(octree_save(ball, PATH("kept.lfl")));
    FAILS(LEAFLESS_E_IO, octree_save(ball, PATH("kept.lfl/below")));
    FAILS(LEAFLESS_E_IO, octree_save(ball, PATH(".")));
    CHECK(length == 77);
    OK(octree_open(PATH("kept.lfl"), &old));
    CHECK(check_same(old, ball));
    leafless_octree_free(old);
    leafless_octree_free(big);
    leafless_octree_free(half);
    leafless_octree_free(ball);
    free(much);
}

int main(void) {
    ways_in_and_out();
    truncated();
    flipped();
    removed_and_replaced();
    what_cannot_be_saved();
    return 0;
}
