/* Structs that begin with their own size: older programs have shorter ones, newer programs longer ones. */
#include "check.h"

static leafless_solid *solid;
static leafless_frame frame;
static leafless_octree *expected;

static void accepted(const void *options) {
    leafless_octree *octree = NULL;
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, (const leafless_options *)options, &octree));
    CHECK(check_same(octree, expected));
    leafless_octree_free(octree);
}

static void refused(const void *options, const char *why) {
    leafless_octree *octree = NULL;
    char message[512];
    FAILS(LEAFLESS_E_ARGUMENT,
          leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, (const leafless_options *)options, &octree));
    CHECK(octree == NULL);
    (void)leafless_last_error(message, sizeof message);
    CHECK(strstr(message, "options") != NULL && strstr(message, why) != NULL);
}

/* What this header's struct may be in a later one. */
typedef struct newer_options {
    leafless_options known;
    uint64_t unknown[4];
} newer_options;

static int32_t full(void *ctx, const double *min, const double *max) {
    (void)ctx;
    (void)min;
    (void)max;
    return LEAFLESS_TAG_FULL;
}

static int32_t distance(void *ctx, const double *points, uint64_t count, double *distances) {
    (void)ctx, (void)points, (void)count, (void)distances;
    return -1;
}

static int32_t count(void *ctx, double fraction) {
    (void)fraction;
    ++*(int *)ctx;
    return 0;
}

int main(void) {
    leafless_options options;
    leafless_solid_callbacks callbacks;
    newer_options newer;
    size_t size, i;

    frame = check_frame(5);
    solid = check_ball_solid();
    expected = check_ball(5, LEAFLESS_RULE_CERTIFIED);
    accepted(NULL);

    /* From zeros by hand, by the macro, and by leafless_init from arbitrary bytes. */
    memset(&options, 0, sizeof options);
    options.struct_size = sizeof options;
    accepted(&options);
    memset(&options, 0xee, sizeof options);
    options = LEAFLESS_INIT(leafless_options);
    accepted(&options);
    memset(&options, 0xee, sizeof options);
    OK(leafless_init(&options, sizeof options));
    CHECK(options.struct_size == sizeof options && options.threads == 0 && options.max_nodes == 0);
    CHECK(options.max_bytes == 0 && options.max_splits == 0 && options.progress == NULL);
    CHECK(options.progress_ctx == NULL && options.control == NULL);
    accepted(&options);
    /* An older program's struct is not written beyond its end. */
    for (size = 8; size < sizeof options; size += 8) {
        memset(&options, 0xee, sizeof options);
        OK(leafless_init(&options, size));
        CHECK(options.struct_size == size);
        for (i = size; i < sizeof options; i++) {
            CHECK(((const unsigned char *)&options)[i] == 0xee);
        }
    }
    for (size = 0; size < 8; size++) {
        if (size != 4) {
            FAILS(LEAFLESS_E_ARGUMENT, leafless_init(&options, size));
        }
    }
    FAILS(LEAFLESS_E_ARGUMENT, leafless_init(&options, SIZE_MAX));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_init(&callbacks, sizeof callbacks + 1));
    OK(leafless_init(&callbacks, sizeof callbacks));
    CHECK(callbacks.struct_size == sizeof callbacks && callbacks.classify == NULL && callbacks.ctx == NULL);
    CHECK(callbacks.classify_many == NULL && callbacks.contains_many == NULL && callbacks.distance_many == NULL);
    CHECK(callbacks.gradient == NULL && callbacks.tangent == NULL);
    OK(leafless_init(&options, sizeof options));
    options.threads = 3;
    options.max_nodes = UINT64_MAX;
    options.max_bytes = UINT64_MAX;
    options.max_splits = UINT64_MAX;
    accepted(&options);

    /* Never initialised: a size that makes no sense. */
    memset(&options, 0, sizeof options);
    refused(&options, "struct_size");
    for (i = 1; i < 256; i++) {
        memset(&options, (int)i, sizeof options);
        refused(&options, "struct_size");
    }
    OK(leafless_init(&options, sizeof options));
    for (size = 0; size < 4; size++) {
        options.struct_size = (uint32_t)size;
        refused(&options, "struct_size");
    }
    options.struct_size = UINT32_MAX;
    refused(&options, "struct_size");
    options.struct_size = 1 << 20;
    refused(&options, "struct_size");

    /* Older, shorter ones: missing fields are not read, and count as zero. */
    {
        int calls = 0;
        OK(leafless_init(&options, sizeof options));
        options.progress = count;
        options.progress_ctx = &calls;
        options.max_nodes = 1;
        options.control = (const leafless_control *)(uintptr_t)0x5a5a5a58;
        options.struct_size = offsetof(leafless_options, max_nodes);
        accepted(&options);
        CHECK(calls == 0);
        options.max_nodes = 0;
        options.struct_size = offsetof(leafless_options, control);
        accepted(&options);
        CHECK(calls > 0);
        /* On the heap, so that memory checkers notice reads beyond the end. */
        for (size = 8; size <= sizeof options; size += 8) {
            void *exact = malloc(size);
            leafless_options zeros;
            CHECK(exact != NULL);
            memset(&zeros, 0, sizeof zeros);
            zeros.struct_size = (uint32_t)size;
            memcpy(exact, &zeros, size);
            accepted(exact);
            free(exact);
        }
        /* No struct of any version ends within a field: half a pointer is none. */
        options.control = NULL;
        for (size = 4; size < sizeof options; size++) {
            if (size % 8 != 0) {
                options.struct_size = (uint32_t)size;
                refused(&options, "struct_size");
            }
        }
    }

    /* Newer, longer ones: fields unknown to this library must be zero. */
    memset(&newer, 0, sizeof newer);
    newer.known.struct_size = sizeof newer;
    accepted(&newer);
    for (i = 0; i < sizeof newer.unknown; i++) {
        memset(newer.unknown, 0, sizeof newer.unknown);
        ((unsigned char *)newer.unknown)[i] = 1;
        refused(&newer, "does not know");
    }
    /* Beyond the size that it says it may hold anything. */
    newer.known.struct_size = sizeof newer.known;
    accepted(&newer);

    /* The same for callbacks. */
    {
        leafless_solid_callbacks callbacks;
        struct {
            leafless_solid_callbacks known;
            uint64_t unknown;
        } longer;
        leafless_solid *all = NULL;
        memset(&callbacks, 0, sizeof callbacks);
        callbacks.classify = full;
        for (size = 0; size < 4; size++) {
            callbacks.struct_size = (uint32_t)size;
            FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_callbacks(&callbacks, &all));
        }
        callbacks.struct_size = offsetof(leafless_solid_callbacks, classify);
        FAILS(LEAFLESS_E_NULL, leafless_solid_new_callbacks(&callbacks, &all));
        callbacks.struct_size = offsetof(leafless_solid_callbacks, contains);
        OK(leafless_solid_new_callbacks(&callbacks, &all));
        leafless_solid_free(all);
        all = NULL;
        memset(&longer, 0, sizeof longer);
        longer.known = callbacks;
        longer.known.struct_size = sizeof longer;
        longer.unknown = 1;
        FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_new_callbacks(&longer.known, &all));
        CHECK(all == NULL);
        longer.unknown = 0;
        OK(leafless_solid_new_callbacks(&longer.known, &all));
        leafless_solid_free(all);
        all = NULL;
        /* A program older than distances: the bytes at their place are not called. */
        callbacks.distance_many = distance;
        callbacks.struct_size = offsetof(leafless_solid_callbacks, distance_many);
        {
            leafless_octree *octree = NULL;
            leafless_statistics statistics;
            OK(leafless_solid_new_callbacks(&callbacks, &all));
            OK(leafless_octree_build(all, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &octree));
            OK(leafless_octree_statistics(octree, &statistics));
            CHECK(statistics.full == 1 && statistics.volume_model.lower == 8.0);
            leafless_octree_free(octree);
            leafless_solid_free(all);
            all = NULL;
        }
        callbacks.classify = NULL;
        FAILS(LEAFLESS_E_NULL, leafless_solid_new_callbacks(&callbacks, &all));
        CHECK(all == NULL);
        callbacks.struct_size = sizeof callbacks;
        OK(leafless_solid_new_callbacks(&callbacks, &all));
        leafless_solid_free(all);
    }
    leafless_octree_free(expected);
    leafless_solid_free(solid);
    return 0;
}
