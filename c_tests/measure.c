/* What is proven of solids without an octree: volume, centroid, inertia, areas, bounding box. */
#include "check.h"

static const double PI = 3.14159265358979323846;

static bool holds(leafless_interval interval, double value) {
    return interval.lower <= value + 1e-12 && value - 1e-12 <= interval.upper;
}

static int32_t stop(void *ctx, double fraction) {
    double *last = (double *)ctx;
    CHECK(fraction >= *last && fraction <= 1.0);
    *last = fraction;
    return 0;
}

static int32_t refuse(void *ctx, double fraction) {
    (void)ctx;
    (void)fraction;
    return 1;
}

static int32_t fails(void *ctx, const double *min, const double *max) {
    (void)ctx;
    (void)min;
    (void)max;
    return -7;
}

static int32_t doubts(void *ctx, const double *min, const double *max) {
    (void)ctx;
    (void)min;
    (void)max;
    return LEAFLESS_TAG_PARTIAL;
}

/* The ball of radius 0.75 around the origin. */
static void ball(void) {
    const leafless_frame frame = check_frame(20);
    const double volume = 4.0 / 3.0 * PI * 0.75 * 0.75 * 0.75, inertia = 0.4 * volume * 0.75 * 0.75;
    leafless_solid *solid = check_ball_solid();
    leafless_options options;
    leafless_measures measures = LEAFLESS_INIT(leafless_measures);
    leafless_measures again = LEAFLESS_INIT(leafless_measures);
    leafless_extent extent = LEAFLESS_INIT(leafless_extent);
    double last = 0.0;
    int i;
    OK(leafless_solid_measure(solid, &frame, 0.05, 0.0, NULL, &measures));
    CHECK(measures.volume_model.lower < volume && volume < measures.volume_model.upper);
    CHECK(measures.volume_model.upper - measures.volume_model.lower <= 0.05 * measures.volume_model.upper);
    CHECK(measures.measured == LEAFLESS_STOP_REASON_TOLERANCE && measures.has_centroid && !measures.is_clipped);
    CHECK(!measures.is_exact);
    CHECK(measures.splits > 20 && measures.level >= 2 && measures.level < 12);
    for (i = 0; i < 3; i++) {
        CHECK(holds(measures.centroid_model[i], 0.0));
    }
    for (i = 0; i < 9; i++) {
        CHECK(holds(measures.inertia_origin_model[i], i % 4 == 0 ? inertia : 0.0));
        CHECK(holds(measures.inertia_centroid_model[i], i % 4 == 0 ? inertia : 0.0));
    }

    OK(leafless_init(&options, sizeof options));
    options.threads = 1;
    options.progress = stop;
    options.progress_ctx = &last;
    OK(leafless_solid_measure(solid, &frame, 0.05, 0.0, &options, &again));
    CHECK(last == 1.0 && again.splits == measures.splits && again.level == measures.level);
    CHECK(again.volume_model.lower == measures.volume_model.lower);
    CHECK(again.centroid_model[1].upper == measures.centroid_model[1].upper);
    options.max_splits = 65;
    last = 0.0;
    OK(leafless_solid_measure(solid, &frame, 0.0, 0.0, &options, &again));
    /* The last whole pass counts. */
    CHECK(again.measured == LEAFLESS_STOP_REASON_BUDGET && again.splits > 0 && again.splits <= 65 && last == 1.0);
    CHECK(again.volume_model.lower < volume && volume < again.volume_model.upper);

    options.max_splits = 0;
    last = 0.0;
    OK(leafless_solid_bounding_box(solid, &frame, 0.01, &options, &extent));
    CHECK(extent.measured == LEAFLESS_STOP_REASON_TOLERANCE && last == 1.0 && extent.splits < 20000);
    CHECK(extent.is_occupied && !extent.is_empty && !extent.is_clipped);
    for (i = 0; i < 3; i++) {
        CHECK(holds(extent.min_model[i], -0.75) && holds(extent.max_model[i], 0.75));
        CHECK(extent.max_model[i].upper - extent.max_model[i].lower <= 0.0100001);
    }

    /* Either tolerance ends it. */
    OK(leafless_solid_measure(solid, &frame, 0.0, 0.01, NULL, &again));
    CHECK(again.measured == LEAFLESS_STOP_REASON_TOLERANCE);
    CHECK(again.volume_model.upper - again.volume_model.lower <= 0.01);
    CHECK(again.volume_model.lower < volume && volume < again.volume_model.upper);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_measure(solid, &frame, 0.0, -1.0, NULL, &again));

    /* The area, with one thread and with many. If a block reaches beyond the universe, its face in a plane of the lattice
     * counts. */
    {
        const double area = 4.0 * PI * 0.75 * 0.75, low[3] = {-9.0, -9.0, -9.0}, high[3] = {0.5, 9.0, 9.0};
        leafless_solid *block = NULL;
        leafless_surface_area surface = LEAFLESS_INIT(leafless_surface_area);
        leafless_surface_area same = LEAFLESS_INIT(leafless_surface_area);
        OK(leafless_solid_surface_area(solid, &frame, 0.001, 0.0, NULL, &surface));
        CHECK(holds(surface.area_model, area) && surface.measured == LEAFLESS_STOP_REASON_TOLERANCE);
        CHECK(surface.area_model.upper - surface.area_model.lower <= 0.001 * area && !surface.is_clipped);
        options.max_splits = 0;
        last = 0.0;
        OK(leafless_solid_surface_area(solid, &frame, 0.001, 0.0, &options, &same));
        CHECK(last == 1.0 && same.splits == surface.splits && same.level == surface.level);
        CHECK(same.area_model.lower == surface.area_model.lower && same.area_model.upper == surface.area_model.upper);
        OK(leafless_solid_new_box(low, high, &block));
        OK(leafless_solid_surface_area(block, &frame, 0.001, 0.0, NULL, &same));
        CHECK(same.is_clipped);
        CHECK(same.measured == LEAFLESS_STOP_REASON_TOLERANCE && holds(same.area_model, 4.0));
        CHECK(same.area_model.upper - same.area_model.lower <= 0.004);
        FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_surface_area(solid, &frame, -1.0, 0.0, NULL, &same));
        options.progress = refuse;
        FAILS(LEAFLESS_E_CANCELLED, leafless_solid_surface_area(solid, &frame, 0.0, 0.0, &options, &same));
        options.progress = stop;
        leafless_solid_free(block);
    }

    /* The section with a plane at a distance of 0.45 from the centre is a disc of radius 0.6. */
    {
        const double point[3] = {0.45, 0.6, -0.1}, normal[3] = {-3.0, 0.0, 0.0}, tilted[3] = {2.0, -1.0, 3.0};
        const double none[3] = {0.0, 0.0, 0.0}, far[3] = {9.0, 9.0, 9.0}, wild[3] = {0.0, NAN, 0.0};
        leafless_section_area section = LEAFLESS_INIT(leafless_section_area);
        leafless_section_area same = LEAFLESS_INIT(leafless_section_area);
        OK(leafless_solid_section_area(solid, &frame, point, normal, 1e-6, 0.0, NULL, &section));
        CHECK(holds(section.area_model, PI * 0.36) && section.measured == LEAFLESS_STOP_REASON_TOLERANCE);
        CHECK(section.area_model.upper - section.area_model.lower <= 1e-6 * section.area_model.upper);
        CHECK(section.proof.full && section.proof.empty && !section.is_clipped && section.splits > 10);
        options.max_splits = 0;
        last = 0.0;
        OK(leafless_solid_section_area(solid, &frame, point, normal, 1e-6, 0.0, &options, &same));
        CHECK(last == 1.0 && same.splits == section.splits);
        CHECK(same.area_model.lower == section.area_model.lower && same.area_model.upper == section.area_model.upper);
        options.max_splits = 3;
        last = 0.0;
        OK(leafless_solid_section_area(solid, &frame, none, tilted, 0.0, 0.0, &options, &same));
        CHECK(same.measured == LEAFLESS_STOP_REASON_BUDGET && same.splits == 3 && holds(same.area_model, PI * 0.5625));
        OK(leafless_solid_section_area(solid, &frame, none, tilted, 0.0, 1e-4, NULL, &same));
        CHECK(same.measured == LEAFLESS_STOP_REASON_TOLERANCE && holds(same.area_model, PI * 0.5625));
        OK(leafless_solid_section_area(solid, &frame, far, normal, 0.0, 0.0, NULL, &same));
        CHECK(same.area_model.lower == 0.0 && same.area_model.upper == 0.0 && same.splits == 0);
        memset(&same, 0x5a, sizeof same);
        same.struct_size = sizeof same;
        FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_section_area(solid, &frame, point, none, 0.0, 0.0, NULL, &same));
        FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_section_area(solid, &frame, wild, normal, 0.0, 0.0, NULL, &same));
        FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_section_area(solid, &frame, point, normal, -1.0, 0.0, NULL, &same));
        options.max_splits = 0;
        options.progress = refuse;
        FAILS(LEAFLESS_E_CANCELLED, leafless_solid_section_area(solid, &frame, point, normal, 0.0, 0.0, &options, &same));
        options.progress = stop;
        for (i = sizeof same.struct_size; i < (int)sizeof same; i++) {
            CHECK(((const unsigned char *)&same)[i] == 0x5a);
        }
    }

    /* Where the surface is known to a hundredth the octree is coarse. */
    {
        const leafless_frame shallow = check_frame(8);
        leafless_solid *adaptive = NULL;
        leafless_octree *whole = NULL, *coarse = NULL;
        leafless_statistics fine, rough;
        OK(leafless_solid_adaptive(solid, 0.01, &adaptive));
        OK(leafless_octree_build(solid, &shallow, LEAFLESS_RULE_CERTIFIED, NULL, &whole));
        OK(leafless_octree_build(adaptive, &shallow, LEAFLESS_RULE_CERTIFIED, NULL, &coarse));
        OK(leafless_octree_statistics(whole, &fine));
        OK(leafless_octree_statistics(coarse, &rough));
        CHECK(rough.volume_model.lower <= fine.volume_model.lower && fine.volume_model.upper <= rough.volume_model.upper);
        CHECK(rough.nodes * 10 < fine.nodes);
        leafless_octree_free(coarse), leafless_octree_free(whole), leafless_solid_free(adaptive);
        adaptive = NULL;
        FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_adaptive(solid, -1.0, &adaptive));
        CHECK(adaptive == NULL);
    }

    /* Nothing is written when it fails. */
    options.progress = refuse;
    memset(&again, 0x5a, sizeof again);
    again.struct_size = sizeof again;
    FAILS(LEAFLESS_E_CANCELLED, leafless_solid_measure(solid, &frame, 0.0, 0.0, &options, &again));
    FAILS(LEAFLESS_E_CANCELLED, leafless_solid_bounding_box(solid, &frame, 0.0, &options, &extent));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_measure(solid, &frame, -1.0, 0.0, NULL, &again));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_measure(solid, &frame, NAN, 0.0, NULL, &again));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_solid_bounding_box(solid, &frame, NAN, NULL, &extent));
    for (i = sizeof again.struct_size; i < (int)sizeof again; i++) {
        CHECK(((const unsigned char *)&again)[i] == 0x5a);
    }
    CHECK(extent.splits < 20000);
    leafless_solid_free(solid);
}

/* A box that lies on the lattice, directly, and as an octree. */
static void block(void) {
    const leafless_frame frame = check_frame(5);
    leafless_octree *octree = check_box(5, -0.5, 0.25);
    leafless_solid *solid = NULL;
    leafless_measures measures = LEAFLESS_INIT(leafless_measures);
    leafless_extent extent = LEAFLESS_INIT(leafless_extent);
    int i;
    OK(leafless_solid_from_octree(octree, &solid));
    OK(leafless_solid_measure(solid, &frame, 0.0, 0.0, NULL, &measures));
    OK(leafless_solid_bounding_box(solid, &frame, 0.0, NULL, &extent));
    CHECK(measures.volume_model.lower == 0.421875 && measures.volume_model.upper == 0.421875);
    for (i = 0; i < 3; i++) {
        CHECK(measures.centroid_model[i].lower == -0.125 && measures.centroid_model[i].upper == -0.125);
        CHECK(extent.min_model[i].lower == -0.5 && extent.min_model[i].upper == -0.5);
        CHECK(extent.max_model[i].lower == 0.25 && extent.max_model[i].upper == 0.25);
    }
    /* Cut in its lower face, between planes of the lattice, and in its upper face. */
    {
        const double normal[3] = {0.0, 0.0, 1.0}, heights[3] = {-0.5, 0.01, 0.25};
        leafless_section_area section = LEAFLESS_INIT(leafless_section_area);
        for (i = 0; i < 3; i++) {
            const double point[3] = {0.0, 0.0, heights[i]}, area = i < 2 ? 0.5625 : 0.0;
            OK(leafless_solid_section_area(solid, &frame, point, normal, 0.0, 0.0, NULL, &section));
            CHECK(section.area_model.lower == area && section.area_model.upper == area);
        }
    }
    /* An octree on another frame is none on this. */
    {
        const leafless_frame other = {{0, 0, 0}, 1, 5};
        FAILS(LEAFLESS_E_FRAME, leafless_solid_measure(solid, &other, 0.0, 0.0, NULL, &measures));
        FAILS(LEAFLESS_E_FRAME, leafless_solid_bounding_box(solid, &other, 0.0, NULL, &extent));
    }
    leafless_solid_free(solid);
    leafless_octree_free(octree);
}

/* The host's own shapes: one that fails, and one that decides nothing. */
static void host(void) {
    const leafless_frame frame = check_frame(3);
    leafless_solid_callbacks callbacks;
    leafless_solid *solid = NULL;
    leafless_measures measures = LEAFLESS_INIT(leafless_measures);
    leafless_extent extent = LEAFLESS_INIT(leafless_extent);
    OK(leafless_init(&callbacks, sizeof callbacks));
    callbacks.classify = fails;
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    FAILS(LEAFLESS_E_CALLBACK, leafless_solid_measure(solid, &frame, 0.0, 0.0, NULL, &measures));
    FAILS(LEAFLESS_E_CALLBACK, leafless_solid_bounding_box(solid, &frame, 0.0, NULL, &extent));
    leafless_solid_free(solid);
    callbacks.classify = doubts;
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    OK(leafless_solid_measure(solid, &frame, 0.0, 0.0, NULL, &measures));
    CHECK(measures.volume_model.lower == 0.0 && measures.volume_model.upper == 8.0);
    CHECK(measures.measured == LEAFLESS_STOP_REASON_EXHAUSTED && !measures.has_centroid && measures.is_clipped);
    CHECK(measures.centroid_model[2].lower == -INFINITY && measures.centroid_model[2].upper == INFINITY);
    OK(leafless_solid_bounding_box(solid, &frame, 0.0, NULL, &extent));
    CHECK(!extent.is_empty && !extent.is_occupied && extent.is_clipped);
    CHECK(extent.min_model[0].lower == -1.0 && extent.min_model[0].upper == 1.0);
    leafless_solid_free(solid);
    {
        const double far[3] = {9, 9, 9};
        OK(leafless_solid_new_ball(far, 1, &solid));
        OK(leafless_solid_bounding_box(solid, &frame, 0.0, NULL, &extent));
        CHECK(extent.is_empty && !extent.is_occupied && extent.max_model[0].upper == INFINITY);
        leafless_solid_free(solid);
    }
}

int main(void) {
    ball();
    block();
    host();
    return 0;
}
