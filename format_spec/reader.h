/*
 * The interface of the reader of files of the Leafless format: reader.c, which says how it is compiled. The sections (§)
 * are those of specification.md.
 */

#ifndef LEAFLESS_READER_H
#define LEAFLESS_READER_H

#include <stddef.h>
#include <stdint.h>

enum { LFL_MAX_DEPTH = 20, LFL_KINDS = 48 };

/* §2.2. The last is no tag: it says that the bytes on the way to a cell are damaged (§6). */
enum lfl_tag { LFL_EMPTY = 0, LFL_BRANCH = 1, LFL_PARTIAL = 2, LFL_FULL = 3, LFL_DAMAGED = 4 };

/* §7.1 */
enum lfl_answer { LFL_OUTSIDE, LFL_INSIDE, LFL_UNDECIDED };

/* §4: an entry of the section table. */
struct lfl_section {
    uint32_t kind, owner, flags, crc, same;
    unsigned element_type, components, encoding, reserved;
    uint64_t offset, length, count;
};

/* §5.3: an entry of the level table. */
struct lfl_level {
    uint64_t nodes, full, partial;
};

/* §5.2: a fact. Neither text has a terminator; both may contain any byte until the metadata have been checked. */
struct lfl_fact {
    const unsigned char *key, *value;
    size_t key_length, value_length;
};

/* §5.7: the rays of a direction, as indices on the other two axes, the lower axis first. */
struct lfl_window {
    uint32_t first[2], size[2];
};

/* §5.7: an interval of a ray, its ends in cells. What is not stored is unknown: no surface, no normal, material 0. */
struct lfl_interval {
    double end[2];
    uint32_t normal[2], surface[2], material;
};

struct lfl_reader {
    const unsigned char *bytes;
    size_t length;

    /* §3 */
    unsigned major, minor;
    uint64_t file_length;
    uint64_t origin[3], edge, displacement; /* the bits of the f64 */
    uint32_t required_flags;
    unsigned depth, root, exterior, brick_planes, encoding, shift, proof, form;
    uint64_t elements, bricks, entries;
    uint32_t section_count;

    /* §4: the number of objects. */
    uint64_t object_count;

    /* §5: the sections of the solid of known kinds, by kind; of those that are absent the count is 0. */
    struct lfl_section section[LFL_KINDS];

    /* §2.3: L. §5.3: start[0] to start[L]. */
    unsigned levels;
    uint64_t start[LFL_MAX_DEPTH / 2 + 1];

    /* §5.7: of a tri-dexel model. */
    struct lfl_window window[3];
};

/* §5.6. The tree of a channel is read as that of the solid: `tree` has the depth, tags, counts and sections of the
   channel, and is otherwise the reader of the file. */
struct lfl_channel {
    struct lfl_reader tree;
    uint32_t owner;
    unsigned value_type, components;
    uint64_t values;
};

/* These return 1, or 0 after setting *error to the name of the rule that refuses the file. After a refusal by
   lfl_probe or lfl_open the reader must not be used. */
int lfl_probe(const void *bytes, size_t length, struct lfl_reader *reader, const char **error); /* §10.1 */
int lfl_open(const void *bytes, size_t length, struct lfl_reader *reader, const char **error);  /* and §10.2 */
int lfl_check_metadata(const struct lfl_reader *reader, const char **error); /* the rest of §10.2, with channels */
int lfl_verify(const struct lfl_reader *reader, const char **error);         /* §10.3, or lfl_out_of_memory */

extern const char lfl_out_of_memory[];

/* Whether the file holds a tri-dexel model (§2.8), else an octree. After lfl_probe, too. */
int lfl_is_dexels(const struct lfl_reader *reader);

/* All of the following need a reader from lfl_open; none of them needs more. Those of levels, tags, points, channels and
   volumes are for octrees. */

/* Entry `index`, less than reader->section_count, of the section table (§4). After lfl_probe, too. */
struct lfl_section lfl_section(const struct lfl_reader *reader, uint32_t index);

/* Entry `level`, at most reader->depth, of the level table (§5.3). */
struct lfl_level lfl_level(const struct lfl_reader *reader, unsigned level);

/* The solid's fact at *position, which begins as 0 and is moved on (§5.2): 1; at the end 0; -1 if the lengths are
   damaged. */
int lfl_metadata(const struct lfl_reader *reader, uint64_t *position, struct lfl_fact *fact);

/* The tag of a finest cell (§6); each coordinate must be less than 2^depth. Never BRANCH. */
enum lfl_tag lfl_cell_tag(const struct lfl_reader *reader, uint32_t x, uint32_t y, uint32_t z);

/* The finest cell in which a coordinate lies on an axis, 0 to 2 (§7.1): 1, or 0 if it lies in none. Exact. */
int lfl_cell(const struct lfl_reader *reader, unsigned axis, double coordinate, uint32_t *cell);

/* Does the solid contain the point (§7.1)? Exact for each f64. Cuts are not looked at. */
enum lfl_answer lfl_contains(const struct lfl_reader *reader, double x, double y, double z);

/* The same with what the cuts say (§7.5), by interval arithmetic: undecided next to a surface, too. */
enum lfl_answer lfl_contains_with_cuts(const struct lfl_reader *reader, double x, double y, double z);

/* The first channel whose object is not before *owner, which begins as 1 and is moved on behind it: 1; at the end 0. Needs
   a file that has passed lfl_check_metadata. */
int lfl_channel(const struct lfl_reader *reader, uint32_t *owner, struct lfl_channel *channel);

/* The channel's value at a point (§7.3), `components` numbers: 1; 0 where it has none, or the file is damaged. */
int lfl_value(const struct lfl_channel *channel, double x, double y, double z, double value[4]);

/* The intervals of a ray of a tri-dexel model, as numbers of the direction's intervals from *first to *end - 1: 1, or 0 if the
   model has no such direction. Of a damaged ray none. */
int lfl_ray(const struct lfl_reader *reader, unsigned axis, const uint32_t ray[2], uint64_t *first, uint64_t *end);

/* Interval i of a direction, which there is. */
void lfl_interval(const struct lfl_reader *reader, unsigned axis, uint64_t i, struct lfl_interval *interval);

/* Whether the centre of a finest cell lies inside, as a direction says it (§7.4): 1 or 0, or -1 without that direction. */
int lfl_holds(const struct lfl_reader *reader, unsigned axis, const uint32_t cell[3]);

/* V and W of §7.2 in finest cells. On a file that was not verified they saturate. */
void lfl_volume_cells(const struct lfl_reader *reader, uint64_t *lower, uint64_t *upper);

/* The same in cubic model units, the first rounded down, the second up. */
void lfl_volume(const struct lfl_reader *reader, double *lower, double *upper);

#endif
