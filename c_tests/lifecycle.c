/* Everything once, from the first call to the last _free: the way a host program would do it. */
#include "check.h"

static void text_equals(const char *text, size_t length, const char *expected) {
    CHECK(text != NULL && length == strlen(expected) && memcmp(text, expected, length) == 0);
}

static void frames(void) {
    const double min[3] = {0.0, 1.0, 2.0}, max[3] = {32.0, 2.0, 4.0}, uneven[3] = {32.1, 2.0, 4.0};
    const double inside[3] = {0.5, -0.5, -1.0};
    leafless_frame frame;
    leafless_interval plane;
    double size;
    uint32_t cell[3];

    OK(leafless_frame_around(min, max, 8, &frame));
    CHECK(frame.edge == 33.0 && frame.depth == 8 && frame.origin[0] == -0.5);
    OK(leafless_frame_check(&frame));
    OK(leafless_frame_aligned(min, max, 8, &frame));
    CHECK(frame.edge == 32.0 && frame.origin[0] == 0.0 && frame.origin[1] == 0.0 && frame.origin[2] == 0.0);
    OK(leafless_frame_fitted(min, max, 8, &frame));
    CHECK(frame.edge == 32.0 && frame.depth == 8);
    OK(leafless_frame_fitted(min, uneven, 8, &frame));
    CHECK(frame.edge == uneven[0] * 33.0 / 32.0);
    OK(leafless_frame_with_cells(min, max, 0.5, &frame));
    CHECK(frame.edge == 32.0 && frame.depth == 6);

    frame = check_frame(3);
    OK(leafless_frame_cell_size(&frame, &size));
    CHECK(size == 0.25);
    OK(leafless_frame_cell_at(&frame, inside, cell));
    CHECK(cell[0] == 6 && cell[1] == 2 && cell[2] == 0);
    OK(leafless_frame_plane(&frame, 0, 8, &plane));
    CHECK(plane.lower == 1.0 && plane.upper == 1.0);

    /* Planes that no double can represent lie between two. */
    frame.edge = 0x1.0000000000001p+0;
    frame.origin[0] = 0x1p-30;
    frame.depth = 20;
    OK(leafless_frame_plane(&frame, 0, 3, &plane));
    CHECK(plane.lower < plane.upper && nextafter(plane.lower, plane.upper) == plane.upper);
}

static void meshes(void) {
    leafless_mesh *cube = check_cube(), *twice = NULL, *moved = NULL, *again = NULL, *sewn = NULL, *reference = NULL;
    const double matrix[12] = {2, 0, 0, 10, 0, 2, 0, 20, 0, 0, 2, 30}, offset[3] = {1, 2, 3};
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    double min[3], max[3], volume, vertices[8][3];
    uint64_t vertex_count, triangle_count, length;
    uint32_t triangles[12][3];
    uint8_t *stl;

    OK(check_counts(cube, &vertex_count, &triangle_count));
    CHECK(vertex_count == 8 && triangle_count == 12);
    OK(leafless_mesh_copy(cube, &vertices[0][0], 8, &triangles[0][0], 12));
    CHECK(memcmp(vertices, CHECK_CUBE, sizeof vertices) == 0);
    CHECK(memcmp(triangles, CHECK_CUBE_TRIANGLES, sizeof triangles) == 0);
    OK(leafless_mesh_bounds(cube, min, max));
    CHECK(min[0] == 0 && min[1] == 0 && min[2] == 0 && max[0] == 1 && max[1] == 1 && max[2] == 1);
    OK(leafless_mesh_volume(cube, &volume));
    CHECK(volume == 1.0);
    OK(leafless_mesh_check_closed(cube, LEAFLESS_FILL_NON_ZERO));
    OK(leafless_mesh_inspect(cube, &report));
    CHECK(report.facets_read == 12 && report.triangles == 12 && report.vertices == 8 && report.welded == 0);
    CHECK(report.boundary_edges == 0 && report.bodies == 1 && report.sewn == 0 && report.displacement_model == 0.0);

    /* Vertices with something else between them, some of them equal. */
    {
        double strided[9][5];
        uint32_t other[12][3];
        leafless_mesh_arrays arrays = check_arrays(strided, 9, other, 12);
        int i, j;
        for (i = 0; i < 9; i++) {
            for (j = 0; j < 5; j++) {
                strided[i][j] = j < 3 ? CHECK_CUBE[i % 8][j] : NAN;
            }
        }
        memcpy(other, CHECK_CUBE_TRIANGLES, sizeof other);
        other[0][0] = 8;
        arrays.vertex_stride = sizeof strided[0];
        OK(leafless_mesh_new(&arrays, &twice));
        OK(leafless_mesh_inspect(twice, &report));
        CHECK(report.vertices == 8 && report.welded == 1 && report.boundary_edges == 0);
    }

    OK(leafless_mesh_transformed(cube, matrix, &moved));
    OK(leafless_mesh_bounds(moved, min, max));
    CHECK(min[0] == 10 && min[1] == 20 && min[2] == 30 && max[0] == 12 && max[1] == 22 && max[2] == 32);
    leafless_mesh_free(moved);
    OK(leafless_mesh_translated(cube, offset, &moved));
    OK(leafless_mesh_bounds(moved, min, max));
    CHECK(min[0] == 1 && min[1] == 2 && min[2] == 3);
    OK(leafless_mesh_sewn(moved, &sewn));

    OK(mesh_to_stl(cube, NULL, 0, &length));
    CHECK(length == 84 + 50 * 12);
    stl = (uint8_t *)malloc((size_t)length);
    CHECK(stl != NULL);
    OK(mesh_to_stl(cube, stl, length, &length));
    OK(mesh_from_bytes(stl, length, NULL, NULL, &again));
    OK(leafless_mesh_volume(again, &volume));
    CHECK(volume == 1.0);
    leafless_mesh_free(again);
    check_write("cube.stl", stl, (size_t)length);
    free(stl);
    OK(mesh_open("cube.stl", strlen("cube.stl"), NULL, NULL, &again));
    OK(leafless_mesh_volume(again, &volume));
    CHECK(volume == 1.0);

    OK(leafless_mesh_ref(cube, &reference));
    CHECK(reference == cube);
    leafless_mesh_free(cube);
    OK(leafless_mesh_volume(reference, &volume));
    leafless_mesh_free(reference);
    leafless_mesh_free(twice);
    leafless_mesh_free(moved);
    leafless_mesh_free(again);
    leafless_mesh_free(sewn);

    /* A mesh of nothing is a mesh. */
    {
        const leafless_mesh_arrays nothing = check_arrays(NULL, 0, NULL, 0);
        OK(leafless_mesh_new(&nothing, &cube));
        leafless_mesh_free(cube);
    }
}

static void solids(void) {
    const leafless_frame frame = check_frame(5);
    const double min[3] = {0, 0, 0}, max[3] = {1, 1, 1}, up[3] = {0, 0, 2};
    leafless_mesh *mesh = check_cube();
    leafless_solid *solid = NULL, *reference = NULL;
    leafless_octree *box = NULL, *cube = NULL, *half = NULL, *slab = NULL, *cut = NULL;
    leafless_statistics statistics;
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);

    OK(leafless_solid_new_box(min, max, &solid));
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &box));
    leafless_solid_free(solid);

    /* A solid keeps its mesh. */
    OK(leafless_solid_from_mesh(mesh, LEAFLESS_FILL_NON_ZERO, &solid));
    leafless_mesh_free(mesh);
    OK(leafless_solid_ref(solid, &reference));
    CHECK(reference == solid);
    leafless_solid_free(solid);
    OK(leafless_octree_build(reference, &frame, LEAFLESS_RULE_SAMPLED, NULL, &cube));
    CHECK(check_same(box, cube));
    /* It answers by itself, on any frame, and can be moved. */
    {
        const leafless_frame deep = {{-4, -4, -4}, 16, 20};
        const double at[2][3] = {{0.5, 0.5, 0.999}, {0.5, 0.5, 1.001}}, matrix[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 9};
        leafless_membership answers[2];
        leafless_region region;
        leafless_motion motion;
        leafless_solid *moved = NULL;
        leafless_solid_info info = LEAFLESS_INIT(leafless_solid_info);
        OK(leafless_solid_contains_many(reference, &deep, at[0], 2, NULL, answers));
        CHECK(answers[0] == LEAFLESS_MEMBERSHIP_INSIDE && answers[1] == LEAFLESS_MEMBERSHIP_OUTSIDE);
        OK(leafless_solid_classify_box(reference, &frame, min, max, NULL, &region));
        CHECK(region == LEAFLESS_REGION_INSIDE);
        OK(leafless_solid_placed(reference, matrix, &motion, &moved));
        CHECK(motion == LEAFLESS_MOTION_VERTICES);
        OK(leafless_solid_contains_many(moved, &deep, at[0], 2, NULL, answers));
        CHECK(answers[0] == LEAFLESS_MEMBERSHIP_OUTSIDE && answers[1] == LEAFLESS_MEMBERSHIP_OUTSIDE);
        OK(leafless_solid_describe(moved, &info));
        CHECK(info.evaluations == 0 && info.bytes > 1000);
        leafless_solid_free(moved);
    }
    leafless_solid_free(reference);

    OK(leafless_solid_new_halfspace(up, 0.5, &solid));
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_INNER, NULL, &half));
    leafless_solid_free(solid);
    OK(leafless_octree_statistics(half, &statistics));
    CHECK(statistics.volume_model.lower == 5.0 && statistics.volume_model.upper == 5.0);
    OK(leafless_octree_describe(half, &info));
    CHECK(info.bytes >= 8 * info.elements && info.bytes <= 64 * (info.elements + info.bricks) + 4096);
    CHECK(info.is_binary && info.is_clipped && info.exterior == LEAFLESS_TAG_PARTIAL);

    /* A stored octree is a solid again, and the solid keeps it. */
    OK(leafless_solid_from_octree(half, &solid));
    leafless_octree_free(half);
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &slab));
    leafless_solid_free(solid);

    OK(check_octrees(LEAFLESS_OPERATION_DIFFERENCE, box, slab, NULL, &cut));
    OK(leafless_octree_statistics(cut, &statistics));
    CHECK(statistics.volume_model.lower == 0.0 && statistics.volume_model.upper == 0.0);
    leafless_octree_free(box);
    leafless_octree_free(cube);
    leafless_octree_free(slab);
    leafless_octree_free(cut);
}

static void set_algebra(void) {
    leafless_octree *a = check_box(4, -0.75, 0.25), *b = check_box(4, -0.25, 0.75), *c = check_box(4, -0.5, 0.0);
    leafless_octree *r[9], *one = NULL, *others = NULL, *rest = NULL;
    const leafless_octree *both[3], *three[3];
    leafless_statistics s;
    leafless_options options;
    size_t i;
    uint32_t operation;
    double volume[9];
    OK(leafless_init(&options, sizeof options));
    options.threads = 1;
    both[0] = a, both[1] = b, both[2] = a;
    three[0] = a, three[1] = b, three[2] = c;
    for (operation = 0; operation < 4; operation++) {
        OK(check_octrees(operation, a, b, &options, &r[operation]));
        OK(leafless_octree_combine(operation, both, 3, &options, &r[4 + operation]));
        /* The combination of one octree is the octree itself. */
        OK(leafless_octree_combine(operation, both, 1, &options, &one));
        CHECK(check_same(one, a));
        leafless_octree_free(one);
        /* Three octrees, one after the other. */
        OK(leafless_octree_combine(operation, three, 3, &options, &one));
        OK(check_octrees(operation, r[operation], c, &options, &rest));
        CHECK(check_same(one, rest));
        leafless_octree_free(one);
        leafless_octree_free(rest);
    }
    OK(leafless_octree_complement(a, &options, &r[8]));
    for (i = 0; i < 9; i++) {
        OK(leafless_octree_statistics(r[i], &s));
        OK(leafless_octree_check(r[i]));
        CHECK(s.volume_model.lower == s.volume_model.upper);
        volume[i] = s.volume_model.lower;
    }
    CHECK(volume[0] == 1.875 && volume[1] == 0.125 && volume[2] == 0.875 && volume[3] == 1.75 && volume[8] == 7.0);
    CHECK(check_same(r[0], r[4]) && check_same(r[1], r[5]) && volume[6] == 0.0 && check_same(b, r[7]));
    CHECK(!check_same(a, b));
    /* The first less the union of the others. */
    OK(leafless_octree_combine(LEAFLESS_OPERATION_DIFFERENCE, three, 3, &options, &one));
    OK(leafless_octree_combine(LEAFLESS_OPERATION_UNION, three + 1, 2, &options, &others));
    OK(check_octrees(LEAFLESS_OPERATION_DIFFERENCE, a, others, &options, &rest));
    OK(leafless_octree_statistics(one, &s));
    CHECK(check_same(one, rest) && s.volume_model.lower == 0.765625);
    leafless_octree_free(one);
    leafless_octree_free(others);
    leafless_octree_free(rest);
    /* In the order in which they came, which is not that in which they were made. */
    leafless_octree_free(a);
    for (i = 0; i < 9; i++) {
        leafless_octree_free(r[i]);
    }
    leafless_octree_free(c);
    leafless_octree_free(b);
}

static void queries(void) {
    leafless_octree *octree = check_ball(6, LEAFLESS_RULE_CERTIFIED);
    const double points[4][3] = {{0, 0, 0}, {0.9, 0.9, 0.9}, {0.43, 0.43, 0.43}, {0, 0, NAN}};
    const double low[3] = {-0.1, -0.1, -0.1}, high[3] = {0.1, 0.1, 0.1}, far[3] = {0.95, 0.95, 0.95}, out[3] = {1, 1, 1};
    const uint32_t middle[3] = {32, 32, 32}, corner[3] = {0, 63, 0}, beyond[3] = {64, 0, 0};
    leafless_membership one, many[4];
    leafless_region region;
    leafless_tag tag;
    leafless_point_cursor *near = NULL;
    leafless_point_table *table = NULL;
    uint8_t level = 99;
    leafless_cursor *cursor = NULL;
    leafless_cursor_info state = LEAFLESS_INIT(leafless_cursor_info);
    bool moved;
    int i;

    OK(leafless_octree_contains_many(octree, &points[0][0], 4, many));
    CHECK(many[0] == LEAFLESS_MEMBERSHIP_INSIDE && many[1] == LEAFLESS_MEMBERSHIP_OUTSIDE);
    CHECK(many[2] == LEAFLESS_MEMBERSHIP_UNDECIDED && many[3] == LEAFLESS_MEMBERSHIP_UNDECIDED);
    OK(leafless_octree_contains_many(octree, NULL, 0, NULL));
    OK(leafless_point_cursor_new(octree, &near));
    OK(leafless_point_table_new(octree, 5, &table, &level));
    CHECK(level == 4);
    for (i = 0; i < 4; i++) {
        OK(leafless_octree_contains(octree, points[i], &one));
        CHECK(one == many[i]);
        OK(leafless_point_cursor_contains(near, points[i], &one));
        CHECK(one == many[i]);
        OK(leafless_point_table_contains(table, points[i], &one));
        CHECK(one == many[i]);
    }
    many[0] = LEAFLESS_MEMBERSHIP_UNDECIDED;
    OK(leafless_point_table_contains_many(table, &points[0][0], 4, many));
    CHECK(many[0] == LEAFLESS_MEMBERSHIP_INSIDE && many[1] == LEAFLESS_MEMBERSHIP_OUTSIDE);
    OK(leafless_point_table_contains_many(table, NULL, 0, NULL));
    OK(leafless_octree_tag_at(octree, middle, &tag));
    CHECK(tag == LEAFLESS_TAG_FULL);
    OK(leafless_octree_tag_at(octree, corner, &tag));
    CHECK(tag == LEAFLESS_TAG_EMPTY);
    OK(leafless_octree_tag_at(octree, beyond, &tag));
    CHECK(tag == LEAFLESS_TAG_PARTIAL);
    OK(leafless_octree_classify_box(octree, low, high, &region));
    CHECK(region == LEAFLESS_REGION_INSIDE);
    OK(leafless_octree_classify_box(octree, far, out, &region));
    CHECK(region == LEAFLESS_REGION_OUTSIDE);
    OK(leafless_octree_classify_box(octree, low, out, &region));
    CHECK(region == LEAFLESS_REGION_CROSSING);

    OK(leafless_cursor_new(octree, &cursor));
    /* Cursors keep the octree. */
    leafless_octree_free(octree);
    OK(leafless_point_cursor_tag_at(near, middle, &tag));
    CHECK(tag == LEAFLESS_TAG_FULL);
    leafless_point_cursor_free(near);
    OK(leafless_point_table_contains(table, points[0], &one));
    CHECK(one == LEAFLESS_MEMBERSHIP_INSIDE);
    leafless_point_table_free(table);

    OK(leafless_cursor_describe(cursor, &state));
    CHECK(state.level == 0 && state.tag == LEAFLESS_TAG_BRANCH && state.children[7] == LEAFLESS_TAG_BRANCH);
    OK(leafless_cursor_ascend(cursor, &moved));
    CHECK(!moved);
    OK(leafless_cursor_descend(cursor, 7, &moved));
    CHECK(moved);
    OK(leafless_cursor_descend(cursor, 0, NULL));
    OK(leafless_cursor_describe(cursor, &state));
    CHECK(state.level == 2 && state.cell[0] == 2 && state.cell[1] == 2 && state.cell[2] == 2);
    CHECK(state.tag == LEAFLESS_TAG_BRANCH || state.tag == LEAFLESS_TAG_FULL);
    OK(leafless_cursor_ascend(cursor, NULL));
    OK(leafless_cursor_descend(cursor, 0, &moved));
    /* Down to a cell that is no branch: there is no way further. */
    for (i = 0; i < 20 && moved; i++) {
        OK(leafless_cursor_descend(cursor, 0, &moved));
    }
    OK(leafless_cursor_describe(cursor, &state));
    CHECK(!moved && state.tag != LEAFLESS_TAG_BRANCH && state.children[3] == state.tag);
    leafless_cursor_free(cursor);
}

static void octrees(void) {
    leafless_octree *ball = check_ball(6, LEAFLESS_RULE_CERTIFIED), *inner = NULL, *outer = NULL, *compact = NULL;
    leafless_octree *fewer = NULL, *named = NULL, *full = NULL, *reference = NULL, *more = NULL;
    leafless_statistics s, t, levels[7];
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
    leafless_frame frame = check_frame(6);
    const char *key, *value;
    size_t key_length, value_length;
    uint64_t count;
    const double truth = 4.0 / 3.0 * 3.14159265358979323846 * 0.75 * 0.75 * 0.75;

    OK(leafless_octree_describe(ball, &info));
    CHECK(memcmp(&info.frame.origin, &frame.origin, sizeof frame.origin) == 0 && info.frame.edge == 2.0);
    CHECK(info.root == LEAFLESS_TAG_BRANCH && info.exterior == LEAFLESS_TAG_EMPTY && !info.is_binary && !info.is_clipped);
    CHECK(info.elements > 0 && info.bricks > 0);
    OK(leafless_octree_statistics(ball, &s));
    CHECK(s.volume_model.lower < truth && truth < s.volume_model.upper && s.lower_cells < s.upper_cells);
    CHECK(s.empty + s.full + s.partial == 7 * s.nodes + 1);
    OK(leafless_octree_levels(ball, NULL, 0, &count));
    CHECK(count == 7);
    OK(leafless_octree_levels(ball, levels, 7, &count));
    CHECK(levels[6].lower_cells == s.lower_cells && levels[0].nodes == 1 && levels[6].nodes == 0);

    OK(leafless_octree_resolve(ball, LEAFLESS_RULE_INNER, NULL, &inner));
    OK(leafless_octree_statistics(inner, &t));
    CHECK(t.lower_cells == s.lower_cells && t.upper_cells == s.lower_cells && t.partial == 0);
    OK(leafless_octree_resolve(ball, LEAFLESS_RULE_OUTER, NULL, &outer));
    OK(leafless_octree_statistics(outer, &t));
    CHECK(t.lower_cells == s.upper_cells);
    OK(leafless_octree_compact(ball, &compact));
    CHECK(check_same(ball, compact));
    OK(leafless_octree_check(compact));

    /* What cells prove: by the rule that made them, or as the host says. */
    OK(leafless_octree_describe(ball, &info));
    CHECK(info.proof.full && info.proof.empty && info.proof.displacement_model == 0.0);
    OK(leafless_octree_describe(inner, &info));
    CHECK(info.proof.full && !info.proof.empty);
    OK(leafless_octree_describe(outer, &info));
    CHECK(!info.proof.full && info.proof.empty);
    {
        static const uint32_t PROVEN[] = {LEAFLESS_PROVEN_NOTHING, LEAFLESS_PROVEN_FULL, LEAFLESS_PROVEN_EMPTY,
                                          LEAFLESS_PROVEN_BOTH};
        leafless_octree *said = NULL, *inverse = NULL, *both = NULL;
        size_t i;
        for (i = 0; i < COUNT(PROVEN); i++) {
            OK(leafless_octree_with_proof(outer, PROVEN[i], 0.125, &said));
            CHECK(check_same(said, outer));
            OK(leafless_octree_describe(said, &info));
            CHECK(info.proof.full == (i % 2 == 1) && info.proof.empty == (i / 2 == 1));
            CHECK(info.proof.displacement_model == 0.125);
            /* A complement exchanges the bits. A union has the common bits, and the greater displacement. */
            OK(leafless_octree_complement(said, NULL, &inverse));
            OK(leafless_octree_describe(inverse, &info));
            CHECK(info.proof.full == (i / 2 == 1) && info.proof.empty == (i % 2 == 1));
            OK(check_octrees(LEAFLESS_OPERATION_UNION, said, inner, NULL, &both));
            OK(leafless_octree_describe(both, &info));
            CHECK(info.proof.full == (i % 2 == 1) && !info.proof.empty && info.proof.displacement_model == 0.125);
            leafless_octree_free(both);
            leafless_octree_free(inverse);
            leafless_octree_free(said);
        }
        OK(leafless_octree_describe(outer, &info));
        CHECK(!info.proof.full && info.proof.empty && info.proof.displacement_model == 0.0);
    }

    OK(leafless_octree_peek_metadata(ball, "units", 5, &value, &value_length));
    CHECK(value == NULL && value_length == 0);
    OK(leafless_octree_with_metadata(ball, "units", 5, "mm", 2, &named));
    OK(leafless_octree_with_metadata(named, "name", 4, "", 0, &more));
    CHECK(check_same(ball, more));
    OK(leafless_octree_peek_metadata(more, "units", 5, &value, &value_length));
    text_equals(value, value_length, "mm");
    OK(leafless_octree_peek_metadata(more, "name", 4, &value, &value_length));
    text_equals(value, value_length, "");
    OK(leafless_octree_peek_metadata_at(more, 77, &count, NULL, NULL, NULL, NULL));
    CHECK(count == 2);
    OK(leafless_octree_peek_metadata_at(more, 1, &count, &key, &key_length, &value, &value_length));
    text_equals(key, key_length, "units");
    text_equals(value, value_length, "mm");

    {
        /* The result has the metadata that the operands agree on. */
        const leafless_octree *const both[3] = {more, named, more}, *const same[2] = {more, more};
        leafless_octree *made[6] = {NULL, NULL, NULL, NULL, NULL, NULL};
        int i;
        OK(check_octrees(LEAFLESS_OPERATION_UNION, more, named, NULL, &made[0]));
        OK(leafless_octree_combine(LEAFLESS_OPERATION_XOR, both, 3, NULL, &made[1]));
        OK(check_octrees(LEAFLESS_OPERATION_DIFFERENCE, named, ball, NULL, &made[2]));
        OK(leafless_octree_complement(more, NULL, &made[3]));
        OK(leafless_octree_combine(LEAFLESS_OPERATION_INTERSECTION, same, 2, NULL, &made[4]));
        OK(leafless_octree_resolve(more, LEAFLESS_RULE_INNER, NULL, &made[5]));
        for (i = 0; i < 6; i++) {
            OK(leafless_octree_peek_metadata_at(made[i], 0, &count, NULL, NULL, NULL, NULL));
            CHECK(count == (i < 2 ? 1 : i == 2 ? 0 : 2));
            OK(leafless_octree_peek_metadata(made[i], "units", 5, &value, &value_length));
            if (i == 2) {
                CHECK(value == NULL);
            } else {
                text_equals(value, value_length, "mm");
            }
            leafless_octree_free(made[i]);
        }
    }
    OK(leafless_octree_without_metadata(more, "units", 5, &fewer));
    OK(leafless_octree_peek_metadata_at(fewer, 0, &count, &key, &key_length, &value, &value_length));
    CHECK(count == 1);
    text_equals(key, key_length, "name");
    leafless_octree_free(fewer);
    OK(leafless_octree_without_metadata(more, "no such fact", 12, &fewer));
    OK(leafless_octree_peek_metadata_at(fewer, 0, &count, NULL, NULL, NULL, NULL));
    CHECK(count == 2);
    leafless_octree_free(fewer);
    OK(leafless_octree_without_metadata(more, NULL, 0, &fewer));
    OK(leafless_octree_peek_metadata_at(fewer, 0, &count, NULL, NULL, NULL, NULL));
    CHECK(count == 0 && check_same(fewer, more));
    leafless_octree_free(fewer);

    OK(leafless_octree_new_uniform(&frame, LEAFLESS_TAG_FULL, LEAFLESS_TAG_PARTIAL, &full));
    OK(leafless_octree_statistics(full, &t));
    CHECK(t.full == 1 && t.lower_cells == 64 * 64 * 64 && t.volume_model.lower == 8.0);

    OK(leafless_octree_ref(ball, &reference));
    CHECK(reference == ball);
    leafless_octree_free(ball);
    OK(leafless_octree_check(reference));
    leafless_octree_free(reference);
    /* What was made of it does not need it. */
    OK(leafless_octree_check(more));
    leafless_octree_free(named);
    OK(leafless_octree_check(more));
    leafless_octree_free(more);
    leafless_octree_free(inner);
    leafless_octree_free(outer);
    leafless_octree_free(compact);
    leafless_octree_free(full);
}

static void controls(void) {
    leafless_control *control = NULL;
    bool cancelled = true;
    double fraction = -1.0;
    OK(leafless_control_new(&control));
    OK(leafless_control_state(control, &cancelled, &fraction));
    CHECK(!cancelled && fraction == 0.0);
    OK(leafless_control_cancel(control));
    OK(leafless_control_state(control, &cancelled, NULL));
    CHECK(cancelled);
    OK(leafless_control_reset(control));
    OK(leafless_control_state(control, &cancelled, NULL));
    CHECK(!cancelled);
    OK(leafless_control_state(control, NULL, NULL));
    leafless_control_free(control);
}

int main(void) {
    char none[4] = "xyz";
    /* Before anything failed there is no message. */
    CHECK(leafless_last_status() == LEAFLESS_OK);
    CHECK(leafless_last_error(NULL, 0) == 0 && leafless_last_error(none, sizeof none) == 0 && none[0] == '\0');
    frames();
    meshes();
    solids();
    set_algebra();
    queries();
    octrees();
    controls();
    CHECK(leafless_last_status() == LEAFLESS_OK);
    return 0;
}
