/* Tri-dexel models: rays, cells and volumes against analytic ones; laws of sets; cuts in place. */
#include "check.h"

static const double PI = 3.14159265358979323846, RADIUS = 0.75;

static leafless_tridexel_format format_of(uint32_t ends, uint32_t normals, uint32_t surfaces, uint32_t materials) {
    leafless_tridexel_format format;
    OK(leafless_init(&format, sizeof format));
    format.ends = ends;
    format.normals = normals;
    format.has_surfaces = surfaces;
    format.has_materials = materials;
    return format;
}

static leafless_tridexel *made(const leafless_solid *solid, uint32_t depth, const leafless_tridexel_format *format) {
    const leafless_frame frame = check_frame(depth);
    leafless_tridexel *model = NULL;
    OK(leafless_tridexel_build(solid, &frame, LEAFLESS_RULE_SAMPLED, format, NULL, &model));
    OK(leafless_tridexel_check(model));
    return model;
}

static leafless_solid *ball_at(double x, double y, double z, double radius) {
    const double centre[3] = {x, y, z};
    leafless_solid *solid = NULL;
    OK(leafless_solid_new_ball(centre, radius, &solid));
    return solid;
}

static leafless_solid *box_between(double low, double high) {
    const double min[3] = {low, low, low}, max[3] = {high, high, high};
    leafless_solid *solid = NULL;
    OK(leafless_solid_new_box(min, max, &solid));
    return solid;
}

/* The model of a solid that is not needed any more. */
static leafless_tridexel *made_of(leafless_solid *solid, uint32_t depth, const leafless_tridexel_format *format) {
    leafless_tridexel *model = made(solid, depth, format);
    leafless_solid_free(solid);
    return model;
}

static bool same(const leafless_tridexel *a, const leafless_tridexel *b) {
    bool equal = false;
    OK(leafless_tridexel_equal(a, b, &equal));
    return equal;
}

/* The same, and neither is needed any more. */
static bool same_and_free(leafless_tridexel *a, leafless_tridexel *b) {
    const bool equal = same(a, b);
    leafless_tridexel_free(a);
    leafless_tridexel_free(b);
    return equal;
}

static double volume(const leafless_tridexel *model, uint32_t axis) {
    leafless_dexel_statistics statistics = LEAFLESS_INIT(leafless_dexel_statistics);
    OK(leafless_tridexel_statistics(model, axis, &statistics));
    return statistics.volume_model;
}

static leafless_tridexel *both(uint32_t operation, const leafless_tridexel *a, const leafless_tridexel *b) {
    leafless_tridexel *result = NULL;
    OK(check_tridexels(operation, a, b, NULL, &result));
    OK(leafless_tridexel_check(result));
    return result;
}

static leafless_tridexel *complement(const leafless_tridexel *model) {
    leafless_tridexel *result = NULL;
    OK(leafless_tridexel_complement(model, NULL, &result));
    OK(leafless_tridexel_check(result));
    return result;
}

/* A box on the planes between cells: all is exact. */
static void boxes(void) {
    const leafless_tridexel_format all = format_of(LEAFLESS_DEXEL_ENDS_FIXED, LEAFLESS_DEXEL_NORMALS_32, 1, 1);
    leafless_tridexel *model = made_of(box_between(-0.5, 0.5), 5, &all);
    leafless_tridexel_info info = LEAFLESS_INIT(leafless_tridexel_info);
    uint32_t axis, k;
    OK(leafless_tridexel_describe(model, &info));
    CHECK(info.frame.depth == 5 && info.frame.edge == 2 && info.frame.origin[1] == -1);
    CHECK(info.directions == LEAFLESS_AXES_ALL && info.ends == LEAFLESS_DEXEL_ENDS_FIXED);
    CHECK(info.normals == LEAFLESS_DEXEL_NORMALS_32 && info.has_surfaces == 1 && info.has_materials == 1);
    CHECK(info.bytes_per_interval == 8 + 8 + 8 + 4 && info.interval_count == 3 * 16 * 16);
    CHECK(info.bytes == info.interval_count * info.bytes_per_interval + 3 * 4 * (16 * 16 + 1));
    for (axis = 0; axis < 3; axis++) {
        const uint32_t in[2] = {8, 23}, out[2] = {8, 24}, beyond[2] = {40, UINT32_MAX};
        uint32_t first[2], end[2];
        leafless_dexel_statistics statistics = LEAFLESS_INIT(leafless_dexel_statistics);
        leafless_dexel dexels[2];
        uint64_t count = 77;
        OK(leafless_tridexel_window(model, axis, first, end));
        CHECK(first[0] == 8 && first[1] == 8 && end[0] == 24 && end[1] == 24);
        OK(leafless_tridexel_statistics(model, axis, &statistics));
        CHECK(statistics.rays == 256 && statistics.intervals == 256 && statistics.volume_model == 1.0);
        CHECK(statistics.bytes == 256 * 28 + 4 * 257);
        for (k = 0; k < 3; k++) {
            /* Along the rays the box itself; across, the outermost rays. */
            const double reach = k == axis ? 0.5 : 0.5 - 1.0 / 32;
            CHECK(statistics.min_model[k] == -reach && statistics.max_model[k] == reach);
        }
        OK(leafless_tridexel_ray(model, axis, in, NULL, 0, &count));
        CHECK(count == 1);
        OK(leafless_tridexel_ray(model, axis, in, dexels, 2, &count));
        CHECK(count == 1 && dexels[0].start.at_model == -0.5 && dexels[0].end.at_model == 0.5);
        CHECK(dexels[0].material == 0);
        CHECK(dexels[0].start.surface != UINT32_MAX && dexels[0].end.surface != UINT32_MAX);
        for (k = 0; k < 3; k++) {
            CHECK(dexels[0].start.normal[k] == (k == axis ? -1 : 0));
            CHECK(dexels[0].end.normal[k] == (k == axis ? 1 : 0));
        }
        OK(leafless_tridexel_ray(model, axis, out, dexels, 0, &count));
        CHECK(count == 0);
        OK(leafless_tridexel_ray(model, axis, beyond, dexels, 2, &count));
        CHECK(count == 0);
    }
    leafless_tridexel_free(model);
    {
        /* One direction; queries of the others are refused. */
        leafless_tridexel_format along_y = format_of(0, 0, 0, 0);
        leafless_dexel dexel;
        leafless_dexel_statistics statistics = LEAFLESS_INIT(leafless_dexel_statistics);
        const uint32_t ray[2] = {16, 16};
        uint64_t count = 77;
        along_y.directions = LEAFLESS_AXES_Y;
        model = made_of(box_between(-0.5, 0.5), 5, &along_y);
        OK(leafless_tridexel_describe(model, &info));
        CHECK(info.directions == LEAFLESS_AXES_Y && info.interval_count == 256 && info.bytes_per_interval == 8);
        OK(leafless_tridexel_ray(model, 1, ray, &dexel, 1, &count));
        CHECK(count == 1 && dexel.start.surface == UINT32_MAX && dexel.end.surface == UINT32_MAX);
        CHECK(dexel.start.normal[1] == 0 && dexel.end.normal[1] == 0 && dexel.material == 0);
        FAILS(LEAFLESS_E_ARGUMENT, leafless_tridexel_ray(model, 0, ray, &dexel, 1, &count));
        FAILS(LEAFLESS_E_ARGUMENT, leafless_tridexel_statistics(model, 2, &statistics));
        leafless_tridexel_free(model);
    }
    {
        /* Nothing. */
        uint32_t first[2], end[2];
        leafless_dexel_statistics statistics = LEAFLESS_INIT(leafless_dexel_statistics);
        uint64_t offsets[1] = {77}, offset_count = 0, intervals = 77;
        model = made_of(ball_at(50, 50, 50, 1), 5, NULL);
        OK(leafless_tridexel_window(model, 2, first, end));
        CHECK(first[0] == end[0] && first[1] == end[1]);
        OK(leafless_tridexel_statistics(model, 2, &statistics));
        CHECK(statistics.rays == 0 && statistics.volume_model == 0 && statistics.min_model[0] == INFINITY);
        CHECK(statistics.max_model[2] == -INFINITY);
        OK(leafless_tridexel_copy(model, 2, NULL, NULL, offsets, 1, &offset_count, NULL, NULL, NULL, NULL, 0, &intervals));
        CHECK(offset_count == 1 && offsets[0] == 0 && intervals == 0);
        leafless_tridexel_free(model);
    }
}

/* All cells and all rays of a ball, in every format, against its equation. */
static void balls(void) {
    enum { DEPTH = 6, SIDE = 1 << DEPTH };
    static uint64_t offsets[SIDE * SIDE + 1];
    static double ends[SIDE * SIDE][2], normals[SIDE * SIDE][2][3], also[SIDE * SIDE][2];
    static uint32_t surfaces[SIDE * SIDE][2], materials[SIDE * SIDE];
    const uint32_t none[2] = {0, 0}, all[2] = {SIDE, SIDE};
    const double step = 2.0 / SIDE;
    uint32_t at[3], code;
    for (code = 0; code < 24; code++) {
        const leafless_tridexel_format format = format_of(code & 1, code / 8, code >> 1 & 1, code >> 2 & 1);
        const double unit = format.ends ? ldexp(2.0, -36) : ldexp(2.0, -31);
        leafless_tridexel *model = made_of(ball_at(0, 0, 0, RADIUS), DEPTH, &format);
        uint32_t axis;
        for (at[2] = 0; at[2] < SIDE; at[2]++) {
            for (at[1] = 0; at[1] < SIDE; at[1]++) {
                for (at[0] = 0; at[0] < SIDE; at[0]++) {
                    const double x = -1 + (at[0] + 0.5) * step, y = -1 + (at[1] + 0.5) * step,
                                 z = -1 + (at[2] + 0.5) * step;
                    bool inside;
                    OK(leafless_tridexel_contains_cell(model, at, &inside));
                    CHECK(inside == (x * x + y * y + z * z < RADIUS * RADIUS));
                }
            }
        }
        at[0] = SIDE;
        at[1] = at[2] = SIDE / 2;
        {
            bool inside = true;
            OK(leafless_tridexel_contains_cell(model, at, &inside));
            CHECK(!inside);
        }
        for (axis = 0; axis < 3; axis++) {
            const uint32_t u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
            uint64_t offset_count, count, total = 0;
            uint32_t i, j;
            double length = 0;
            OK(leafless_tridexel_copy(model, axis, none, all, NULL, 0, &offset_count, NULL, NULL, NULL, NULL, 0, &count));
            CHECK(offset_count == COUNT(offsets) && count < COUNT(ends));
            OK(leafless_tridexel_copy(model, axis, none, all, offsets, COUNT(offsets), &offset_count, &ends[0][0],
                                      &normals[0][0][0], &surfaces[0][0], materials, COUNT(ends), &count));
            for (j = 0; j < SIDE; j++) {
                for (i = 0; i < SIDE; i++) {
                    const double a = -1 + (i + 0.5) * step, b = -1 + (j + 0.5) * step;
                    const double square = RADIUS * RADIUS - a * a - b * b;
                    const uint64_t from = offsets[j * SIDE + i], to = offsets[j * SIDE + i + 1];
                    const uint32_t ray[2] = {i, j};
                    leafless_dexel dexel;
                    uint64_t number;
                    int k;
                    CHECK(from == total && to - from == (square > 0));
                    OK(leafless_tridexel_ray(model, axis, ray, &dexel, 1, &number));
                    CHECK(number == to - from);
                    if (number == 0) {
                        continue;
                    }
                    CHECK(dexel.start.at_model == ends[from][0] && dexel.end.at_model == ends[from][1]);
                    CHECK(dexel.start.surface == surfaces[from][0] && dexel.end.surface == surfaces[from][1]);
                    CHECK(dexel.material == 0 && materials[from] == 0);
                    for (k = 0; k < 2; k++) {
                        const double along = (k ? 1 : -1) * sqrt(square), *normal = normals[from][k];
                        CHECK(fabs(ends[from][k] - along) <= unit);
                        CHECK(surfaces[from][k] == (format.has_surfaces ? 0 : UINT32_MAX));
                        CHECK(memcmp(normal, k ? dexel.end.normal : dexel.start.normal, sizeof(double[3])) == 0);
                        if (format.normals == LEAFLESS_DEXEL_NORMALS_NONE) {
                            CHECK(normal[0] == 0 && normal[1] == 0 && normal[2] == 0);
                        } else {
                            const double cosine = (normal[u] * a + normal[v] * b + normal[axis] * along) / RADIUS;
                            const double degrees = format.normals == LEAFLESS_DEXEL_NORMALS_16 ? 1 : 0.005;
                            CHECK(acos(cosine < 1 ? cosine : 1) <= degrees * PI / 180);
                        }
                    }
                    length += ends[from][1] - ends[from][0];
                    total++;
                }
            }
            CHECK(total == count && offsets[SIDE * SIDE] == total);
            CHECK(fabs(volume(model, axis) - length * step * step) < 1e-12);
            CHECK(fabs(volume(model, axis) - 4.0 / 3 * PI * RADIUS * RADIUS * RADIUS) < 4e-3);
            {
                /* Within the window there are the same; of some rays, theirs; of one array, that one. */
                const uint32_t low[2] = {20, 30}, high[2] = {24, 33};
                uint64_t some[13], few, k;
                OK(leafless_tridexel_copy(model, axis, NULL, NULL, NULL, 0, &offset_count, &also[0][0], NULL, NULL, NULL,
                                          count, &few));
                CHECK(few == count && memcmp(also, ends, (size_t)count * sizeof ends[0]) == 0);
                OK(leafless_tridexel_copy(model, axis, low, high, some, 13, &offset_count, &also[0][0], NULL, NULL, NULL,
                                          12, &few));
                CHECK(offset_count == 13 && few == 12);
                for (k = 0; k < 12; k++) {
                    const uint64_t ray = (30 + k / 4) * SIDE + 20 + k % 4;
                    CHECK(some[k] == k && memcmp(also[k], ends[offsets[ray]], sizeof also[k]) == 0);
                }
                /* Too small a buffer: nothing is written. */
                some[0] = 77;
                materials[0] = 77;
                FAILS(LEAFLESS_E_BUFFER, leafless_tridexel_copy(model, axis, low, high, some, 12, &offset_count, NULL,
                                                                NULL, NULL, materials, 12, &few));
                FAILS(LEAFLESS_E_BUFFER, leafless_tridexel_copy(model, axis, low, high, some, 13, &offset_count, NULL,
                                                                NULL, NULL, materials, 11, &few));
                CHECK(some[0] == 77 && materials[0] == 77);
                FAILS(LEAFLESS_E_ARGUMENT, leafless_tridexel_copy(model, axis, high, low, some, 13, &offset_count, NULL,
                                                                  NULL, NULL, NULL, 0, &few));
            }
        }
        leafless_tridexel_free(model);
    }
}

/* Ends beside centres of cells, on a frame whose centres are no doubles: read and written back, by coordinates, by places,
   and by both. */
static void places(void) {
    enum { DEPTH = 3 };
    static const double ends_cells[4] = {1.5000000000000002, 2.5, 3.4999999999999996, 7.5};
    const double low[2] = {-5.148202647275424, 1e9};
    static const uint64_t offsets[2] = {0, 2};
    static const uint32_t first[2] = {2, 5}, end[2] = {3, 6};
    int code;
    for (code = 0; code < 4; code++) {
        const leafless_tridexel_format format = format_of(code & 1, 0, 0, 0);
        const bool is_far = code >= 2;
        double model_ends[4], cells[4], also[4];
        leafless_tridexel *models[3] = {NULL, NULL, NULL};
        leafless_tridexel_arrays rays;
        leafless_frame frame = check_frame(DEPTH);
        leafless_dexel dexels[2];
        uint64_t count, offset_count;
        int i, k;
        frame.origin[0] = frame.origin[1] = frame.origin[2] = low[is_far];
        frame.edge = 8.342378659550686e-3;
        memset(&rays, 0, sizeof rays);
        rays.axis = 1;
        memcpy(rays.first, first, sizeof first);
        memcpy(rays.end, end, sizeof end);
        rays.offsets = offsets;
        rays.interval_count = 2;
        rays.ends_cells = ends_cells;
        OK(leafless_tridexel_new(&frame, &format, &rays, 1, NULL, &models[0]));
        for (k = 0; k < 8; k++) {
            const uint32_t cell[3] = {2, (uint32_t)k, 5};
            bool inside;
            OK(leafless_tridexel_contains_cell(models[0], cell, &inside));
            CHECK(inside == (k >= 3 && k < 7));
        }
        OK(leafless_tridexel_copy_cells(models[0], 1, first, end, NULL, 0, &count));
        CHECK(count == 2);
        OK(leafless_tridexel_copy_cells(models[0], 1, NULL, NULL, cells, 2, &count));
        OK(leafless_tridexel_copy(models[0], 1, NULL, NULL, NULL, 0, &offset_count, model_ends, NULL, NULL, NULL, 2, &count));
        CHECK(count == 2 && (!format.ends || memcmp(cells, ends_cells, sizeof cells) == 0));
        OK(leafless_tridexel_ray(models[0], 1, first, dexels, 2, &count));
        for (i = 0; i < 2; i++) {
            CHECK(dexels[i].start.at_cells == cells[2 * i] && dexels[i].end.at_cells == cells[2 * i + 1]);
            CHECK(dexels[i].start.at_model == model_ends[2 * i] && dexels[i].end.at_model == model_ends[2 * i + 1]);
        }
        /* Too small a buffer: nothing is written. */
        also[0] = 77;
        FAILS(LEAFLESS_E_BUFFER, leafless_tridexel_copy_cells(models[0], 1, first, end, also, 1, &count));
        CHECK(also[0] == 77);
        rays.ends_cells = cells;
        rays.ends_model = model_ends;
        OK(leafless_tridexel_new(&frame, &format, &rays, 1, NULL, &models[1]));
        CHECK(same(models[0], models[1]));
        if (!is_far) {
            rays.ends_cells = NULL;
            OK(leafless_tridexel_new(&frame, &format, &rays, 1, NULL, &models[2]));
            CHECK(format.ends || same(models[0], models[2]));
            for (k = 0; k < 8; k++) {
                const uint32_t cell[3] = {2, (uint32_t)k, 5};
                bool inside;
                OK(leafless_tridexel_contains_cell(models[2], cell, &inside));
                CHECK(inside == (k >= 3 && k < 7));
            }
            /* A coordinate that was changed counts. */
            rays.ends_cells = cells;
            model_ends[3] = model_ends[2] + 0.5 * (model_ends[3] - model_ends[2]);
            leafless_tridexel_free(models[2]);
            OK(leafless_tridexel_new(&frame, &format, &rays, 1, NULL, &models[2]));
            CHECK(!same(models[0], models[2]));
        }
        for (i = 0; i < 3; i++) {
            leafless_tridexel_free(models[i]);
        }
    }
}

/* Solids of other kinds, and other rules. */
static void sources(void) {
    enum { DEPTH = 5, SIDE = 1 << DEPTH };
    const leafless_tridexel_format marked = format_of(LEAFLESS_DEXEL_ENDS_DOUBLE, 0, 1, 0);
    const leafless_frame frame = check_frame(DEPTH);
    leafless_mesh_arrays arrays = check_arrays(CHECK_CUBE, 8, CHECK_CUBE_TRIANGLES, 12);
    leafless_mesh *cube = NULL;
    leafless_solid *solid = NULL, *ball = check_ball_solid();
    leafless_octree *octree = check_ball(DEPTH, LEAFLESS_RULE_SAMPLED);
    leafless_tridexel *model, *inner = NULL, *outer = NULL, *threads = NULL;
    leafless_options options;
    uint32_t axis, at[3];
    arrays.scale = 0.5;
    OK(leafless_mesh_new(&arrays, &cube));
    OK(leafless_solid_from_mesh(cube, LEAFLESS_FILL_NON_ZERO, &solid));
    leafless_mesh_free(cube);
    model = made_of(solid, DEPTH, &marked);
    for (axis = 0; axis < 3; axis++) {
        /* The faces of the cube by triangles: below and above, as check.h lists them. */
        static const uint32_t below[3] = {8, 4, 0}, above[3] = {10, 6, 2};
        const uint32_t ray[2] = {18, 22}, beside[2] = {15, 22};
        leafless_dexel dexel;
        uint64_t count;
        OK(leafless_tridexel_ray(model, axis, ray, &dexel, 1, &count));
        CHECK(count == 1 && dexel.start.at_model == 0 && dexel.end.at_model == 0.5);
        CHECK(dexel.start.surface / 2 * 2 == below[axis] && dexel.end.surface / 2 * 2 == above[axis]);
        OK(leafless_tridexel_ray(model, axis, beside, &dexel, 1, &count));
        CHECK(count == 0);
        CHECK(volume(model, axis) == 0.125);
    }
    leafless_tridexel_free(model);
    solid = NULL;
    OK(leafless_solid_from_octree(octree, &solid));
    model = made_of(solid, DEPTH, NULL);
    solid = NULL;
    for (at[2] = 0; at[2] < SIDE; at[2]++) {
        for (at[1] = 0; at[1] < SIDE; at[1]++) {
            for (at[0] = 0; at[0] < SIDE; at[0]++) {
                double point[3];
                leafless_membership found;
                bool inside;
                int k;
                for (k = 0; k < 3; k++) {
                    point[k] = -1 + (at[k] + 0.5) * 2 / SIDE;
                }
                OK(leafless_octree_contains(octree, point, &found));
                OK(leafless_tridexel_contains_cell(model, at, &inside));
                CHECK(inside == (found == LEAFLESS_MEMBERSHIP_INSIDE));
            }
        }
    }
    leafless_tridexel_free(model);
    leafless_octree_free(octree);

    OK(leafless_tridexel_build(ball, &frame, LEAFLESS_RULE_INNER, NULL, NULL, &inner));
    OK(leafless_tridexel_build(ball, &frame, LEAFLESS_RULE_OUTER, NULL, NULL, &outer));
    OK(leafless_init(&options, sizeof options));
    options.threads = 3;
    OK(leafless_tridexel_build(ball, &frame, LEAFLESS_RULE_SAMPLED, NULL, &options, &threads));
    model = made(ball, DEPTH, NULL);
    CHECK(same(model, threads));
    for (axis = 0; axis < 3; axis++) {
        CHECK(volume(inner, axis) < volume(model, axis) && volume(model, axis) < volume(outer, axis));
    }
    /* The inner model lies in the model, and the model in the outer one. */
    CHECK(same_and_free(both(LEAFLESS_OPERATION_UNION, inner, model), both(LEAFLESS_OPERATION_UNION, model, inner)));
    CHECK(same_and_free(both(LEAFLESS_OPERATION_DIFFERENCE, inner, model),
                        both(LEAFLESS_OPERATION_DIFFERENCE, model, outer)));
    leafless_tridexel_free(inner);
    leafless_tridexel_free(outer);
    leafless_tridexel_free(threads);
    leafless_tridexel_free(model);
    leafless_solid_free(ball);
}

/* A box and two balls that overlap each other. */
static void laws(void) {
    enum { DEPTH = 6 };
    uint32_t ends;
    for (ends = 0; ends < 2; ends++) {
        const leafless_tridexel_format format = format_of(ends, 0, 0, 0);
        leafless_tridexel *a = made_of(box_between(-0.6, 0.4), DEPTH, &format);
        leafless_tridexel *b = made_of(ball_at(0.3, 0.1, 0.2, 0.45), DEPTH, &format);
        leafless_tridexel *c = made_of(ball_at(0.1, -0.4, 0.3, 0.5), DEPTH, &format);
        leafless_tridexel *not_a = complement(a), *not_b = complement(b), *result = NULL;
        leafless_tridexel *joined = both(LEAFLESS_OPERATION_UNION, a, b);
        leafless_tridexel *common = both(LEAFLESS_OPERATION_INTERSECTION, a, b), *others;
        leafless_tridexel *rest = both(LEAFLESS_OPERATION_DIFFERENCE, a, b);
        const leafless_tridexel *list[3];
        uint32_t axis, operation;
        for (axis = 0; axis < 3; axis++) {
            CHECK(volume(common, axis) > 0.1 && volume(rest, axis) > 0.1);
            CHECK(fabs(volume(joined, axis) + volume(common, axis) - volume(a, axis) - volume(b, axis)) < 1e-9);
            CHECK(fabs(volume(rest, axis) + volume(common, axis) - volume(a, axis)) < 1e-9);
            CHECK(fabs(volume(not_a, axis) + volume(a, axis) - 8) < 1e-9);
        }
        CHECK(same_and_free(complement(joined), both(LEAFLESS_OPERATION_INTERSECTION, not_a, not_b)));
        CHECK(same_and_free(complement(common), both(LEAFLESS_OPERATION_UNION, not_a, not_b)));
        CHECK(same_and_free(both(LEAFLESS_OPERATION_INTERSECTION, a, not_b), both(LEAFLESS_OPERATION_DIFFERENCE, a, b)));
        CHECK(same_and_free(both(LEAFLESS_OPERATION_DIFFERENCE, joined, common), both(LEAFLESS_OPERATION_XOR, b, a)));
        CHECK(same_and_free(both(LEAFLESS_OPERATION_UNION, rest, common), both(LEAFLESS_OPERATION_UNION, a, a)));
        CHECK(same_and_free(complement(not_a), both(LEAFLESS_OPERATION_INTERSECTION, a, joined)));
        list[0] = a, list[1] = b, list[2] = c;
        for (operation = 0; operation < 4; operation++) {
            leafless_tridexel *two = both(operation, a, b);
            OK(leafless_tridexel_combine(operation, list, 3, NULL, &result));
            CHECK(same_and_free(result, both(operation, two, c)));
            leafless_tridexel_free(two);
            OK(leafless_tridexel_combine(operation, list, 1, NULL, &result));
            CHECK(same(result, a));
            leafless_tridexel_free(result);
            result = NULL;
            FAILS(LEAFLESS_E_ARGUMENT, leafless_tridexel_combine(operation, NULL, 0, NULL, &result));
            FAILS(LEAFLESS_E_ARGUMENT, leafless_tridexel_combine(operation, list, 0, NULL, &result));
            CHECK(result == NULL);
        }
        FAILS(LEAFLESS_E_ARGUMENT, leafless_tridexel_combine(4, list, 2, NULL, &result));
        CHECK(result == NULL);
        /* The first less the union of the others. */
        OK(leafless_tridexel_combine(LEAFLESS_OPERATION_DIFFERENCE, list, 3, NULL, &result));
        others = both(LEAFLESS_OPERATION_UNION, b, c);
        for (axis = 0; axis < 3; axis++) {
            CHECK(volume(result, axis) > 0.1 && volume(result, axis) < volume(rest, axis) - 0.01);
        }
        CHECK(same_and_free(result, both(LEAFLESS_OPERATION_DIFFERENCE, a, others)));
        leafless_tridexel_free(others);
        leafless_tridexel_free(rest);
        leafless_tridexel_free(common);
        leafless_tridexel_free(joined);
        leafless_tridexel_free(not_b);
        leafless_tridexel_free(not_a);
        leafless_tridexel_free(c);
        leafless_tridexel_free(b);
        leafless_tridexel_free(a);
    }
}

static bool is_named(const leafless_tridexel *model, const char *key, const char *expected) {
    const char *value = NULL;
    size_t length = 0;
    OK(leafless_tridexel_peek_metadata(model, key, strlen(key), &value, &length));
    return expected == NULL ? value == NULL : length == strlen(expected) && memcmp(value, expected, length) == 0;
}

static leafless_tridexel *with_fact(leafless_tridexel *model, const char *key, const char *value) {
    leafless_tridexel *named = NULL;
    OK(leafless_tridexel_with_metadata(model, key, strlen(key), value, strlen(value), &named));
    CHECK(same(model, named));
    leafless_tridexel_free(model);
    return named;
}

/* What is stored, materials, and facts. */
static void contents(void) {
    enum { DEPTH = 5 };
    const leafless_tridexel_format most = format_of(LEAFLESS_DEXEL_ENDS_DOUBLE, LEAFLESS_DEXEL_NORMALS_32, 1, 1);
    leafless_tridexel_format least = format_of(0, 0, 0, 0);
    const uint32_t ray[2] = {16, 16};
    leafless_tridexel *ball = made_of(check_ball_solid(), DEPTH, &most), *box = made_of(box_between(0, 0.9), DEPTH, NULL);
    leafless_tridexel *plain = NULL, *back = NULL, *steel = NULL, *copper = NULL, *joined, *cut, *reference = NULL;
    leafless_tridexel_info info = LEAFLESS_INIT(leafless_tridexel_info);
    leafless_dexel dexels[3];
    uint64_t count;
    OK(leafless_tridexel_with_format(ball, &least, NULL, &plain));
    OK(leafless_tridexel_describe(plain, &info));
    CHECK(info.bytes_per_interval == 8 && info.ends == LEAFLESS_DEXEL_ENDS_FIXED && info.has_materials == 0);
    CHECK(same_and_free(plain, made_of(check_ball_solid(), DEPTH, NULL)));
    OK(leafless_tridexel_with_format(box, &most, NULL, &back));
    OK(leafless_tridexel_describe(back, &info));
    CHECK(info.bytes_per_interval == 16 + 8 + 8 + 4);
    OK(leafless_tridexel_ray(back, 0, ray, dexels, 1, &count));
    CHECK(count == 1 && dexels[0].start.surface == UINT32_MAX && dexels[0].start.normal[0] == 0);
    least.directions = LEAFLESS_AXES_ALL;
    OK(leafless_tridexel_with_format(back, &least, NULL, &plain));
    CHECK(same(plain, box));
    leafless_tridexel_free(plain);
    leafless_tridexel_free(back);
    plain = NULL;
    least.directions = LEAFLESS_AXES_X;
    FAILS(LEAFLESS_E_ARGUMENT, leafless_tridexel_with_format(box, &least, NULL, &plain));
    CHECK(plain == NULL);

    /* Along x through (1/32, 1/32): steel to about 0.75. The order of the operands decides where copper begins or ends. */
    OK(leafless_tridexel_with_material(ball, 1, NULL, &steel));
    OK(leafless_tridexel_with_material(box, 2, NULL, &copper));
    steel = with_fact(with_fact(with_fact(steel, "name", "part"), "units", "mm"), "maker", "me");
    copper = with_fact(with_fact(copper, "name", "part"), "units", "inch");
    joined = both(LEAFLESS_OPERATION_UNION, steel, copper);
    OK(leafless_tridexel_ray(joined, 0, ray, dexels, 3, &count));
    CHECK(count == 2 && dexels[0].material == 1 && dexels[1].material == 2);
    CHECK(dexels[0].end.at_model == dexels[1].start.at_model && dexels[1].end.at_model > 0.89);
    CHECK(fabs(dexels[0].end.at_model - 0.75) < 2e-3);
    CHECK(is_named(joined, "name", "part") && is_named(joined, "units", NULL) && is_named(joined, "maker", NULL));
    leafless_tridexel_free(joined);
    joined = both(LEAFLESS_OPERATION_UNION, copper, steel);
    OK(leafless_tridexel_ray(joined, 0, ray, dexels, 3, &count));
    CHECK(count == 2 && dexels[0].material == 1 && dexels[1].material == 2 && fabs(dexels[1].start.at_model) < 1e-9);
    leafless_tridexel_free(joined);
    /* A cut shows the other side of the tool: its surface with the reversed normal. */
    cut = both(LEAFLESS_OPERATION_DIFFERENCE, box, ball);
    OK(leafless_tridexel_ray(cut, 0, ray, dexels, 3, &count));
    CHECK(count == 1 && dexels[0].start.surface == 0 && dexels[0].start.normal[0] < -0.99);
    leafless_tridexel_free(cut);

    OK(leafless_tridexel_ref(steel, &reference));
    CHECK(reference == steel);
    leafless_tridexel_free(steel);
    {
        const char *key, *value;
        size_t key_length, value_length;
        leafless_tridexel *less = NULL, *bare = NULL;
        OK(leafless_tridexel_peek_metadata_at(reference, 0, &count, NULL, NULL, NULL, NULL));
        CHECK(count == 3);
        OK(leafless_tridexel_peek_metadata_at(reference, 2, &count, &key, &key_length, &value, &value_length));
        CHECK(key_length == 5 && memcmp(key, "units", 5) == 0 && value_length == 2 && memcmp(value, "mm", 2) == 0);
        OK(leafless_tridexel_without_metadata(reference, "units", 5, &less));
        OK(leafless_tridexel_without_metadata(reference, NULL, 0, &bare));
        leafless_tridexel_free(reference);
        CHECK(is_named(less, "units", NULL) && is_named(less, "maker", "me") && is_named(bare, "maker", NULL));
        OK(leafless_tridexel_with_material(less, 5, NULL, &back));
        CHECK(is_named(back, "maker", "me"));
        CHECK(same_and_free(less, bare));
        leafless_tridexel_free(back);
    }
    leafless_tridexel_free(copper);
    leafless_tridexel_free(ball);
    leafless_tridexel_free(box);
}

static leafless_tridexel *frozen(const leafless_tridexel_editor *editor) {
    leafless_tridexel *model = NULL;
    OK(leafless_tridexel_editor_freeze(editor, NULL, &model));
    OK(leafless_tridexel_check(model));
    return model;
}

static leafless_solid *step_of_tool(int i) {
    return ball_at(-0.6 + 0.06 * i, 0.3 * sin(0.5 * i), 0.7, 0.2);
}

/* A block that a tool runs over: in place, by models, and by one union of all steps. */
static void cuts(void) {
    enum { DEPTH = 6, STEPS = 20 };
    const leafless_tridexel_format format = format_of(LEAFLESS_DEXEL_ENDS_FIXED, LEAFLESS_DEXEL_NORMALS_16, 1, 0);
    leafless_tridexel *block = made_of(box_between(-0.6875, 0.6875), DEPTH, &format), *steps[STEPS], *path = NULL, *part, *early;
    leafless_tridexel_editor *by_solids = NULL, *by_models = NULL;
    leafless_tridexel_info info = LEAFLESS_INIT(leafless_tridexel_info);
    leafless_tridexel_info of_block = LEAFLESS_INIT(leafless_tridexel_info);
    leafless_dexel_change change = LEAFLESS_INIT(leafless_dexel_change);
    leafless_dexel_change other = LEAFLESS_INIT(leafless_dexel_change);
    double removed[3] = {0, 0, 0};
    uint32_t axis;
    int i;
    OK(leafless_tridexel_editor_new(block, &by_solids));
    OK(leafless_tridexel_editor_new(block, &by_models));
    OK(leafless_tridexel_editor_describe(by_solids, &info));
    OK(leafless_tridexel_describe(block, &of_block));
    CHECK(info.frame.depth == DEPTH && info.frame.edge == 2 && info.frame.origin[0] == -1);
    CHECK(info.directions == LEAFLESS_AXES_ALL && info.ends == of_block.ends && info.normals == of_block.normals);
    CHECK(info.has_surfaces == 1 && info.has_materials == 0 && info.bytes_per_interval == of_block.bytes_per_interval);
    CHECK(info.interval_count == of_block.interval_count && info.bytes >= 3 * 12 * 64 * 64);
    CHECK(same_and_free(frozen(by_solids), both(LEAFLESS_OPERATION_UNION, block, block)));
    early = frozen(by_solids);
    for (i = 0; i < STEPS; i++) {
        leafless_solid *ball = step_of_tool(i);
        OK(leafless_tridexel_editor_combine_solid(by_solids, LEAFLESS_OPERATION_DIFFERENCE, ball, NULL, &change));
        steps[i] = made_of(ball, DEPTH, &format);
        OK(leafless_tridexel_editor_combine(by_models, LEAFLESS_OPERATION_DIFFERENCE, steps[i], NULL, &other));
        CHECK(memcmp(&change, &other, sizeof change) == 0 && change.rays > 0);
        for (axis = 0; axis < 3; axis++) {
            /* Less than the ball, in the box around it. */
            CHECK(change.added_model[axis] == 0 && change.removed_model[axis] > 0);
            CHECK(change.removed_model[axis] < 1.1 * 4.0 / 3 * PI * pow(0.2, 3));
            CHECK(change.max_cell[axis] > change.min_cell[axis] && change.max_cell[axis] - change.min_cell[axis] <= 14);
            removed[axis] += change.removed_model[axis];
        }
    }
    /* The same step again finds nothing to take away. */
    OK(leafless_tridexel_editor_combine(by_models, LEAFLESS_OPERATION_DIFFERENCE, steps[STEPS - 1], NULL, &other));
    CHECK(other.rays == 0 && other.removed_model[0] == 0 && other.max_cell[0] == 0 && other.min_cell[2] == 0);
    part = frozen(by_solids);
    CHECK(same_and_free(part, frozen(by_models)));
    /* What was frozen stays. */
    CHECK(same(early, block));
    leafless_tridexel_free(early);
    part = frozen(by_solids);
    OK(leafless_tridexel_combine(LEAFLESS_OPERATION_UNION, (const leafless_tridexel *const *)steps, STEPS, NULL, &path));
    {
        /* Which step shows at an end is another question. */
        const leafless_tridexel_format plain = format_of(0, 0, 0, 0);
        leafless_tridexel *whole = both(LEAFLESS_OPERATION_DIFFERENCE, block, path), *one = NULL, *other = NULL;
        OK(leafless_tridexel_with_format(whole, &plain, NULL, &one));
        OK(leafless_tridexel_with_format(part, &plain, NULL, &other));
        CHECK(same_and_free(one, other));
        leafless_tridexel_free(whole);
    }
    for (axis = 0; axis < 3; axis++) {
        CHECK(volume(part, axis) < volume(block, axis) - 0.05);
        CHECK(fabs(volume(part, axis) - volume(part, 2)) < 2e-3);
        CHECK(fabs(volume(block, axis) - volume(part, axis) - removed[axis]) < 1e-12);
    }
    /* All that is missing is filled in again, and nothing else. */
    for (i = 0; i < STEPS; i++) {
        leafless_solid *ball = step_of_tool(i);
        OK(leafless_tridexel_editor_combine_solid(by_solids, LEAFLESS_OPERATION_UNION, ball, NULL, NULL));
        OK(leafless_tridexel_editor_combine(by_models, LEAFLESS_OPERATION_UNION, steps[i], NULL, NULL));
        leafless_solid_free(ball);
    }
    CHECK(same_and_free(frozen(by_solids), frozen(by_models)));
    {
        leafless_solid *box = box_between(-0.6875, 0.6875);
        OK(leafless_tridexel_editor_combine_solid(by_solids, LEAFLESS_OPERATION_INTERSECTION, box, NULL, NULL));
        OK(leafless_tridexel_editor_combine(by_models, LEAFLESS_OPERATION_INTERSECTION, block, NULL, NULL));
        leafless_solid_free(box);
    }
    CHECK(same_and_free(frozen(by_solids), frozen(by_models)));
    {
        leafless_tridexel *again = frozen(by_models), *xor_made;
        CHECK(fabs(volume(again, 0) - volume(block, 0)) < 1e-12 && fabs(volume(again, 2) - volume(block, 2)) < 1e-12);
        leafless_tridexel_free(again);
        /* Once with, once without: twice is nothing. */
        xor_made = both(LEAFLESS_OPERATION_XOR, block, steps[0]);
        OK(leafless_tridexel_editor_combine(by_models, LEAFLESS_OPERATION_INTERSECTION, block, NULL, NULL));
        OK(leafless_tridexel_editor_combine(by_models, LEAFLESS_OPERATION_XOR, steps[0], NULL, &change));
        again = frozen(by_models);
        for (axis = 0; axis < 3; axis++) {
            CHECK(change.removed_model[axis] > 0 && change.added_model[axis] > 0);
            CHECK(fabs(volume(again, axis) - volume(xor_made, axis)) < 1e-12);
            CHECK(fabs(volume(block, axis) - change.removed_model[axis] + change.added_model[axis] - volume(again, axis)) <
                  1e-12);
        }
        leafless_tridexel_free(xor_made);
        leafless_tridexel_free(again);
        {
            leafless_solid *ball = step_of_tool(0);
            OK(leafless_tridexel_editor_combine_solid(by_models, LEAFLESS_OPERATION_XOR, ball, NULL, &other));
            leafless_solid_free(ball);
        }
        for (axis = 0; axis < 3; axis++) {
            CHECK(fabs(change.removed_model[axis] - other.added_model[axis]) < 1e-12);
            CHECK(fabs(change.added_model[axis] - other.removed_model[axis]) < 1e-12);
            CHECK(change.min_cell[axis] == other.min_cell[axis] && change.max_cell[axis] == other.max_cell[axis]);
        }
    }
    for (i = 0; i < STEPS; i++) {
        leafless_tridexel_free(steps[i]);
    }
    leafless_tridexel_free(path);
    leafless_tridexel_free(part);
    leafless_tridexel_free(block);
    leafless_tridexel_editor_free(by_models);
    leafless_tridexel_editor_free(by_solids);
    {
        /* Half a ball is missing in the middle of a face. */
        leafless_tridexel *box = made_of(box_between(-0.5, 0.5), 7, NULL);
        leafless_solid *ball = ball_at(0, 0, 0.5, 0.375);
        OK(leafless_tridexel_editor_new(box, &by_solids));
        OK(leafless_tridexel_editor_combine_solid(by_solids, LEAFLESS_OPERATION_DIFFERENCE, ball, NULL, NULL));
        part = frozen(by_solids);
        for (axis = 0; axis < 3; axis++) {
            CHECK(fabs(volume(part, axis) - (1 - 2.0 / 3 * PI * pow(0.375, 3))) < 5e-4);
        }
        leafless_tridexel_free(part);
        leafless_tridexel_free(box);
        leafless_solid_free(ball);
        leafless_tridexel_editor_free(by_solids);
    }
}

/* A shape whose function uses the editor that it is subtracted from. */
static int32_t meddles(void *ctx, const double *min, const double *max) {
    leafless_tridexel_editor *const editor = *(leafless_tridexel_editor **)ctx;
    leafless_tridexel_info info = LEAFLESS_INIT(leafless_tridexel_info);
    (void)min, (void)max;
    info.bytes = 77;
    FAILS(LEAFLESS_E_BUSY, leafless_tridexel_editor_describe(editor, &info));
    CHECK(info.bytes == 77);
    return -4713;
}

/* What is refused, and that nothing is changed by it. */
static void refused(void) {
    const leafless_frame frame = check_frame(5);
    leafless_tridexel_format along_z = format_of(0, 0, 0, 0);
    leafless_solid *ball = check_ball_solid(), *busy = NULL;
    leafless_tridexel *model = made(ball, 5, NULL), *finer = made(ball, 6, NULL), *columns, *result = NULL;
    leafless_tridexel_editor *editor = NULL;
    leafless_solid_callbacks callbacks;
    leafless_control *control = NULL;
    leafless_options options;
    along_z.directions = LEAFLESS_AXES_Z;
    columns = made(ball, 5, &along_z);
    OK(leafless_tridexel_editor_new(model, &editor));
    OK(leafless_init(&callbacks, sizeof callbacks));
    callbacks.classify = meddles;
    callbacks.ctx = &editor;
    OK(leafless_solid_new_callbacks(&callbacks, &busy));
    OK(leafless_control_new(&control));
    OK(leafless_init(&options, sizeof options));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_tridexel_build(ball, &frame, LEAFLESS_RULE_CERTIFIED, NULL, NULL, &result));
    FAILS(LEAFLESS_E_CALLBACK, leafless_tridexel_editor_combine_solid(editor, LEAFLESS_OPERATION_DIFFERENCE, busy, NULL, NULL));
    FAILS(LEAFLESS_E_FRAME, check_tridexels(LEAFLESS_OPERATION_UNION, model, finer, NULL, &result));
    FAILS(LEAFLESS_E_FRAME, leafless_tridexel_editor_combine(editor, LEAFLESS_OPERATION_DIFFERENCE, finer, NULL, NULL));
    FAILS(LEAFLESS_E_ARGUMENT, check_tridexels(LEAFLESS_OPERATION_DIFFERENCE, model, columns, NULL, &result));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_tridexel_editor_combine(editor, LEAFLESS_OPERATION_UNION, columns, NULL, NULL));
    options.max_bytes = 1000;
    FAILS(LEAFLESS_E_LIMIT, leafless_tridexel_build(ball, &frame, LEAFLESS_RULE_SAMPLED, NULL, &options, &result));
    FAILS(LEAFLESS_E_LIMIT, check_tridexels(LEAFLESS_OPERATION_UNION, model, model, &options, &result));
    FAILS(LEAFLESS_E_LIMIT, leafless_tridexel_complement(model, &options, &result));
    options.max_bytes = 0;
    options.control = control;
    OK(leafless_control_cancel(control));
    FAILS(LEAFLESS_E_CANCELLED, leafless_tridexel_build(ball, &frame, LEAFLESS_RULE_SAMPLED, NULL, &options, &result));
    FAILS(LEAFLESS_E_CANCELLED, check_tridexels(LEAFLESS_OPERATION_XOR, model, model, &options, &result));
    FAILS(LEAFLESS_E_CANCELLED, leafless_tridexel_with_material(model, 1, &options, &result));
    FAILS(LEAFLESS_E_CANCELLED, leafless_tridexel_editor_combine_solid(editor, LEAFLESS_OPERATION_DIFFERENCE, ball, &options, NULL));
    FAILS(LEAFLESS_E_CANCELLED, leafless_tridexel_editor_combine(editor, LEAFLESS_OPERATION_DIFFERENCE, model, &options, NULL));
    FAILS(LEAFLESS_E_CANCELLED, leafless_tridexel_editor_freeze(editor, &options, &result));
    CHECK(result == NULL);
    result = frozen(editor);
    CHECK(same(result, model));
    leafless_tridexel_free(result);
    leafless_control_free(control);
    leafless_tridexel_editor_free(editor);
    leafless_tridexel_free(columns);
    leafless_tridexel_free(finer);
    leafless_tridexel_free(model);
    leafless_solid_free(busy);
    leafless_solid_free(ball);
}

int main(void) {
    boxes();
    balls();
    places();
    sources();
    laws();
    contents();
    cuts();
    refused();
    return 0;
}
