/* Neighbours of cells, and cells and boundary faces one after another: of a ball, against its points. */
#include "check.h"

#define DEPTH 5

static leafless_octree *octree;

static bool same(const leafless_cell *a, const leafless_cell *b) {
    return memcmp(a->cell, b->cell, sizeof a->cell) == 0 && a->level == b->level && a->tag == b->tag;
}

/* All leaves fill the universe, and agree with the points in them. */
static void leaves(void) {
    static leafless_cell all[40000], again[40000];
    leafless_cells *cells = NULL;
    leafless_statistics statistics;
    uint64_t count, volume = 0, tags[4] = {0, 0, 0, 0}, i, pieces = 0, more;
    OK(leafless_cells_new(octree, LEAFLESS_TAGS_LEAVES, 0, 20, NULL, NULL, &cells));
    OK(leafless_cells_next(cells, all, COUNT(all), &count));
    CHECK(count > 1000 && count < COUNT(all));
    for (i = 0; i < count; i++) {
        const uint32_t shift = DEPTH - all[i].level;
        const uint32_t at[3] = {all[i].cell[0] << shift, all[i].cell[1] << shift, all[i].cell[2] << shift};
        leafless_tag tag;
        OK(leafless_octree_tag_at(octree, at, &tag));
        CHECK(tag == all[i].tag);
        tags[tag]++;
        volume += (uint64_t)1 << (3 * shift);
    }
    CHECK(volume == (uint64_t)1 << (3 * DEPTH));
    OK(leafless_octree_statistics(octree, &statistics));
    CHECK(tags[LEAFLESS_TAG_EMPTY] == statistics.empty && tags[LEAFLESS_TAG_FULL] == statistics.full);
    CHECK(tags[LEAFLESS_TAG_PARTIAL] == statistics.partial);
    OK(leafless_cells_next(cells, again, 5, &more));
    CHECK(more == 0);
    /* In pieces, from the middle. */
    OK(leafless_cells_seek(cells, all[count / 2].cell, all[count / 2].level));
    for (i = count / 2; i < count; i += more) {
        OK(leafless_cells_next(cells, again, 1 + pieces++ % 50, &more));
        CHECK(more > 0 && i + more <= count && same(&again[0], &all[i]) && same(&again[more - 1], &all[i + more - 1]));
    }
    OK(leafless_cells_next(cells, NULL, 0, &more));
    CHECK(more == 0);
    leafless_cells_free(cells);
    {
        const uint32_t low[3] = {0, 0, 0}, high[3] = {16, 32, 32};
        OK(leafless_cells_new(octree, LEAFLESS_TAGS_FULL | LEAFLESS_TAGS_BRANCH, 3, 3, low, high, &cells));
        OK(leafless_cells_next(cells, all, COUNT(all), &count));
        CHECK(count > 10);
        for (i = 0; i < count; i++) {
            CHECK(all[i].level == 3 && all[i].cell[0] < 4);
            CHECK(all[i].tag == LEAFLESS_TAG_FULL || all[i].tag == LEAFLESS_TAG_BRANCH);
        }
        leafless_cells_free(cells);
    }
}

/* The ball is convex: along each axis, each column that it meets has one face below and one above. */
static void faces(void) {
    static leafless_boundary_face some[1000];
    static int columns[3][2][32][32];
    leafless_faces *faces = NULL;
    uint64_t count, i;
    uint32_t u, v;
    OK(leafless_faces_new(octree, LEAFLESS_TAGS_FULL, 0, 20, NULL, NULL, &faces));
    do {
        OK(leafless_faces_next(faces, some, COUNT(some), &count));
        for (i = 0; i < count; i++) {
            const leafless_boundary_face *face = &some[i];
            const leafless_cell *smaller = face->outer.level > face->inner.level ? &face->outer : &face->inner;
            const uint32_t shift = DEPTH - smaller->level, edge = 1u << shift;
            const uint32_t p = (face->axis + 1u) % 3, q = (face->axis + 2u) % 3;
            CHECK(face->axis < 3 && face->has_outer);
            CHECK(face->inner.tag == LEAFLESS_TAG_FULL && face->outer.tag != LEAFLESS_TAG_FULL);
            for (u = 0; u < edge; u++) {
                for (v = 0; v < edge; v++) {
                    columns[face->axis][face->is_upper][(smaller->cell[p] << shift) + u][(smaller->cell[q] << shift) + v]++;
                }
            }
        }
    } while (count == COUNT(some));
    for (i = 0; i < 3; i++) {
        int met = 0;
        for (u = 0; u < 32; u++) {
            for (v = 0; v < 32; v++) {
                CHECK(columns[i][0][u][v] == columns[i][1][u][v] && columns[i][0][u][v] <= 1);
                met += columns[i][0][u][v];
            }
        }
        CHECK(met > 300);
    }
    OK(leafless_faces_seek(faces, some[0].inner.cell, some[0].inner.level));
    OK(leafless_faces_next(faces, some, 1, &count));
    CHECK(count == 1);
    leafless_faces_free(faces);
    /* The faces of the outside exclude the universe's own boundary, because the exterior is EMPTY. */
    OK(leafless_faces_new(octree, LEAFLESS_TAGS_EMPTY, 0, 20, NULL, NULL, &faces));
    OK(leafless_faces_next(faces, some, 100, &count));
    CHECK(count == 100 && some[0].inner.tag == LEAFLESS_TAG_EMPTY && some[0].has_outer);
    leafless_faces_free(faces);
    OK(leafless_faces_new(octree, LEAFLESS_TAGS_EMPTY | LEAFLESS_TAGS_FULL | LEAFLESS_TAGS_PARTIAL, 0, 20, NULL, NULL, &faces));
    OK(leafless_faces_next(faces, some, 100, &count));
    CHECK(count == 0);
    leafless_faces_free(faces);
}

static void neighbours(void) {
    static leafless_cell beside[1024];
    leafless_cursor *cursor = NULL;
    leafless_cells *cells = NULL;
    leafless_cell all[2000], found;
    uint64_t count, number, i;
    int32_t x, y, z;
    bool reached, exists;
    OK(leafless_cursor_new(octree, &cursor));
    OK(leafless_cells_new(octree, LEAFLESS_TAGS_LEAVES, 0, 20, NULL, NULL, &cells));
    leafless_octree_free(octree);
    OK(leafless_cells_next(cells, all, COUNT(all), &count));
    for (i = 0; i < count; i += 7) {
        OK(leafless_cursor_seek(cursor, all[i].cell, all[i].level, &reached));
        CHECK(reached);
        for (z = -1; z <= 1; z++) {
            for (y = -1; y <= 1; y++) {
                for (x = -1; x <= 1; x++) {
                    const int32_t direction[3] = {x, y, z};
                    uint64_t k;
                    if (x == 0 && y == 0 && z == 0) {
                        continue;
                    }
                    OK(leafless_cursor_neighbour(cursor, direction, &found, &exists));
                    OK(leafless_cursor_neighbours(cursor, direction, NULL, 0, &number));
                    CHECK(exists == (number > 0));
                    OK(leafless_cursor_neighbours(cursor, direction, beside, number, &number));
                    if (!exists) {
                        CHECK(found.tag == LEAFLESS_TAG_EMPTY && found.level == all[i].level);
                    } else if (found.tag != LEAFLESS_TAG_BRANCH) {
                        CHECK(number == 1 && same(&found, &beside[0]) && found.level <= all[i].level);
                    } else {
                        /* The smaller cells lie in the equal one. */
                        CHECK(found.level == all[i].level);
                        for (k = 0; k < number; k++) {
                            const uint32_t shift = beside[k].level - found.level;
                            CHECK(beside[k].level > found.level && beside[k].tag != LEAFLESS_TAG_BRANCH);
                            CHECK(beside[k].cell[0] >> shift == found.cell[0] && beside[k].cell[2] >> shift == found.cell[2]);
                        }
                        FAILS(LEAFLESS_E_BUFFER, leafless_cursor_neighbours(cursor, direction, beside, number - 1, &count));
                    }
                }
            }
        }
    }
    {
        const uint32_t outside[3] = {32, 0, 0}, corner[3] = {0, 0, 0};
        FAILS(LEAFLESS_E_ARGUMENT, leafless_cursor_seek(cursor, outside, 5, &reached));
        FAILS(LEAFLESS_E_ARGUMENT, leafless_cursor_seek(cursor, corner, 6, &reached));
        OK(leafless_cursor_seek(cursor, corner, 5, &reached));
        CHECK(!reached);
    }
    leafless_cells_free(cells);
    leafless_cursor_free(cursor);
}

static void boxes(void) {
    const leafless_frame frame = {{-1, 0, 2}, 4, 3};
    const uint32_t cell[3] = {3, 0, 1}, universe[3] = {0, 0, 0};
    double low[3], high[3];
    OK(leafless_frame_cell_bounds(&frame, cell, 2, low, high));
    CHECK(low[0] == 2 && low[1] == 0 && low[2] == 3 && high[0] == 3 && high[1] == 1 && high[2] == 4);
    OK(leafless_frame_cell_bounds(&frame, universe, 0, low, high));
    CHECK(low[0] == -1 && high[2] == 6);
    FAILS(LEAFLESS_E_ARGUMENT, leafless_frame_cell_bounds(&frame, cell, 1, low, high));
    FAILS(LEAFLESS_E_ARGUMENT, leafless_frame_cell_bounds(&frame, universe, 4, low, high));
}

int main(void) {
    octree = check_ball(DEPTH, LEAFLESS_RULE_CERTIFIED);
    leaves();
    faces();
    neighbours();
    boxes();
    return 0;
}
