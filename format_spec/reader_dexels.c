/*
 * The part of reader.c that reads tri-dexel models (§2.8, §5.7). reader.c includes this file behind what all files have
 * in common, which this part uses.
 */

#include "reader.h"

/* §5.7: kinds of sections. Each direction has five, from KIND_STARTS + 5 · axis on. */
enum { KIND_WINDOWS = 32, KIND_STARTS = 33, KIND_END = 48 };
enum column { STARTS, SPANS, NORMALS, SURFACES, MATERIALS, COLUMNS };

/* §5.7: the bits of `form`. */
static int has_doubles(const struct lfl_reader *r) { return r->form & 1; }
static unsigned normal_kind(const struct lfl_reader *r) { return r->form >> 1 & 3; }
static int has_surfaces(const struct lfl_reader *r) { return r->form >> 3 & 1; }
static int has_materials(const struct lfl_reader *r) { return r->form >> 4 & 1; }
static int has_direction(const struct lfl_reader *r, unsigned axis) { return r->form >> (5 + axis) & 1; }

/* §3: the numbers of intervals stand where an octree has those of elements, bricks and dictionary entries. */
static uint64_t intervals(const struct lfl_reader *r, unsigned axis)
{
    return axis == 0 ? r->elements : axis == 1 ? r->bricks : r->entries;
}

static unsigned column_kind(unsigned axis, enum column column) { return KIND_STARTS + 5 * axis + column; }

/* A row of §5.7's table. The number of starts follows from the windows, which are not known yet. */
static struct demand demanded_of_dexels(const struct lfl_reader *r, uint32_t kind)
{
    struct demand d = {TYPE_U32, 1, 0, 0};
    unsigned axis = kind < KIND_STARTS ? 0 : (kind - KIND_STARTS) / 5;
    if (kind == KIND_WINDOWS) {
        d.components = 4;
        d.count = (uint64_t)has_direction(r, 0) + has_direction(r, 1) + has_direction(r, 2);
        return d;
    }
    d.count = intervals(r, axis);
    switch ((kind - KIND_STARTS) % 5) {
    case STARTS: d.any_count = 1, d.count = 0; break;
    case SPANS: d.element_type = has_doubles(r) ? TYPE_F64 : TYPE_U32, d.components = 2; break;
    case NORMALS:
        d.element_type = normal_kind(r) == 1 ? TYPE_U16 : TYPE_U32, d.components = 2;
        d.count = normal_kind(r) != 0 ? d.count : 0;
        break;
    case SURFACES: d.components = 2, d.count = has_surfaces(r) ? d.count : 0; break;
    default: d.count = has_materials(r) ? d.count : 0; break;
    }
    return d;
}

/* §10.1: what is another in the header of a tri-dexel model. */
static const char *check_dexel_header(const struct lfl_reader *r)
{
    unsigned axis;
    REFUSE_IF(r->root != 0 || r->exterior != 0 || r->brick_planes != 0, "dexel-field");
    REFUSE_IF(r->encoding != 0 || r->shift != 0 || r->proof != 0 || r->displacement != 0, "dexel-field");
    REFUSE_IF(r->form >> 5 == 0 || normal_kind(r) == 3, "dexel-form");
    for (axis = 0; axis < 3; axis++)
        REFUSE_IF(intervals(r, axis) > (has_direction(r, axis) ? UINT32_MAX - 1 : 0), "dexel-intervals");
    return NULL;
}

/* §10.2: the windows, and how many starts there are. */
static const char *check_windows(struct lfl_reader *r)
{
    uint64_t cells = UINT64_C(1) << r->depth;
    unsigned axis, i, index = 0;
    for (axis = 0; axis < 3; axis++) {
        struct lfl_window *w = &r->window[axis];
        const unsigned char *p;
        memset(w, 0, sizeof *w);
        if (!has_direction(r, axis))
            continue;
        p = item(r, KIND_WINDOWS, index++);
        for (i = 0; i < 2; i++) {
            w->first[i] = u32(p + 4 * i);
            w->size[i] = u32(p + 8 + 4 * i);
            REFUSE_IF((uint64_t)w->first[i] + w->size[i] > cells, "dexel-window");
        }
        REFUSE_IF((w->size[0] == 0 || w->size[1] == 0) && !all_zero(p, 16), "dexel-window");
    }
    for (axis = 0; axis < 3; axis++) {
        const struct lfl_window *w = &r->window[axis];
        uint64_t rays = (uint64_t)w->size[0] * w->size[1];
        uint64_t starts = r->section[column_kind(axis, STARTS)].count;
        REFUSE_IF(starts != (has_direction(r, axis) ? rays + 1 : 0), "dexel-rays");
    }
    return NULL;
}

/* ---- Numbers of intervals ---------------------------------------------------------------------------------------- */

/* number · 2^exponent, for a number below 2^53, as a double. */
static double scaled(uint64_t number, int exponent)
{
    int top = 52;
    if (number == 0)
        return 0.0;
    while (number >> top == 0)
        top--;
    number = number << (52 - top) & ((UINT64_C(1) << 52) - 1);
    return from_bits((uint64_t)(1023 + top + exponent) << 52 | number);
}

/* The ends of interval i (§5.7) as numbers that ascend as the places do, and that both forms compare alike: units of
   2^-31 edges, or the bits of doubles, which ascend as long as the sign is not set. */
static void ends_of(const struct lfl_reader *r, unsigned axis, uint64_t i, uint64_t ends[2])
{
    const unsigned char *p = item(r, column_kind(axis, SPANS), i);
    if (has_doubles(r)) {
        ends[0] = u64(p);
        ends[1] = u64(p + 8);
    } else {
        ends[0] = u32(p);
        ends[1] = ends[0] + u32(p + 4);
    }
}

/* number · 2^exponent cells, for a number below 2^53, in the same way. */
static uint64_t place(const struct lfl_reader *r, uint64_t number, int exponent)
{
    double value;
    uint64_t bits;
    if (!has_doubles(r))
        return number << (31 - (int)r->depth + exponent);
    value = scaled(number, exponent);
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static double end_in_cells(const struct lfl_reader *r, uint64_t end)
{
    return has_doubles(r) ? from_bits(end) : scaled(end, (int)r->depth - 31);
}

/* The intervals of a ray: from *first to *end - 1. None outside of the window, and of starts that are damaged. */
static void intervals_of_ray(const struct lfl_reader *r, unsigned axis, const uint32_t ray[2], uint64_t *first,
                             uint64_t *end)
{
    const struct lfl_window *w = &r->window[axis];
    uint64_t index;
    *first = *end = 0;
    if (ray[0] - w->first[0] >= w->size[0] || ray[1] - w->first[1] >= w->size[1])
        return;
    index = (uint64_t)(ray[1] - w->first[1]) * w->size[0] + (ray[0] - w->first[0]);
    *first = u32(item(r, column_kind(axis, STARTS), index));
    *end = u32(item(r, column_kind(axis, STARTS), index + 1));
    if (*first > *end || *end > intervals(r, axis))
        *first = *end = 0;
}

int lfl_ray(const struct lfl_reader *r, unsigned axis, const uint32_t ray[2], uint64_t *first, uint64_t *end)
{
    if (!lfl_is_dexels(r) || axis > 2 || !has_direction(r, axis))
        return 0;
    intervals_of_ray(r, axis, ray, first, end);
    return 1;
}

void lfl_interval(const struct lfl_reader *r, unsigned axis, uint64_t i, struct lfl_interval *interval)
{
    uint64_t ends[2];
    unsigned k;
    ends_of(r, axis, i, ends);
    for (k = 0; k < 2; k++) {
        interval->end[k] = end_in_cells(r, ends[k]);
        interval->normal[k] = normal_kind(r) == 1 ? 0x8080 : 0x80008000;
        interval->surface[k] = UINT32_MAX;
        if (normal_kind(r) == 1)
            interval->normal[k] = u16(item(r, column_kind(axis, NORMALS), i) + 2 * k);
        else if (normal_kind(r) == 2)
            interval->normal[k] = u32(item(r, column_kind(axis, NORMALS), i) + 4 * k);
        if (has_surfaces(r))
            interval->surface[k] = u32(item(r, column_kind(axis, SURFACES), i) + 4 * k);
    }
    interval->material = has_materials(r) ? u32(item(r, column_kind(axis, MATERIALS), i)) : 0;
}

/* §7.4 */
int lfl_holds(const struct lfl_reader *r, unsigned axis, const uint32_t cell[3])
{
    uint32_t ray[2];
    uint64_t first, end, centre;
    ray[0] = cell[axis == 0 ? 1 : 0];
    ray[1] = cell[axis == 2 ? 1 : 2];
    if (!lfl_ray(r, axis, ray, &first, &end))
        return -1;
    centre = place(r, 2 * (uint64_t)cell[axis] + 1, -1);
    for (; first < end; first++) {
        uint64_t ends[2];
        ends_of(r, axis, first, ends);
        if (ends[0] <= centre && centre < ends[1])
            return 1;
    }
    return 0;
}

/* ---- §10.3 Verification ------------------------------------------------------------------------------------------ */

/* §5.7: neither component of a code is the least number, or both are, for no normal. */
static int is_code(const struct lfl_reader *r, uint32_t code)
{
    if (normal_kind(r) == 1)
        return code == 0x8080 || ((code & 0xFF) != 0x80 && code >> 8 != 0x80);
    return code == 0x80008000 || ((code & 0xFFFF) != 0x8000 && code >> 16 != 0x8000);
}

static const char *verify_intervals(const struct lfl_reader *r, unsigned axis, uint64_t first, uint64_t end)
{
    uint64_t i, before = 0, high = place(r, UINT64_C(1) << r->depth, 0);
    uint32_t material = 0;
    for (i = first; i < end; i++) {
        struct lfl_interval interval;
        uint64_t ends[2];
        ends_of(r, axis, i, ends);
        lfl_interval(r, axis, i, &interval);
        /* A sign, the infinity and NaN are greater than `high` as bits. */
        REFUSE_IF(ends[0] >= ends[1] || ends[1] > high, "dexel-interval");
        REFUSE_IF(i > first && ends[0] < before, "dexel-interval");
        REFUSE_IF(i > first && ends[0] == before && interval.material == material, "dexel-interval");
        REFUSE_IF(normal_kind(r) != 0 && !is_code(r, interval.normal[0]), "dexel-normal");
        REFUSE_IF(normal_kind(r) != 0 && !is_code(r, interval.normal[1]), "dexel-normal");
        before = ends[1];
        material = interval.material;
    }
    return NULL;
}

static const char *verify_direction(const struct lfl_reader *r, unsigned axis)
{
    const struct lfl_window *w = &r->window[axis];
    uint64_t rays = (uint64_t)w->size[0] * w->size[1], i;
    unsigned sides = 0; /* bits: the first and last column, the first and last row */
    const char *error;
    REFUSE_IF(u32(item(r, column_kind(axis, STARTS), 0)) != 0, "dexel-starts");
    REFUSE_IF(u32(item(r, column_kind(axis, STARTS), rays)) != intervals(r, axis), "dexel-starts");
    for (i = 0; i < rays; i++) {
        uint64_t first = u32(item(r, column_kind(axis, STARTS), i)), u = i % w->size[0], v = i / w->size[0];
        uint64_t end = u32(item(r, column_kind(axis, STARTS), i + 1));
        REFUSE_IF(first > end || end > intervals(r, axis), "dexel-starts");
        if ((error = verify_intervals(r, axis, first, end)) != NULL)
            return error;
        if (first < end)
            sides |= (unsigned)(u == 0) | (unsigned)(u + 1 == w->size[0]) << 1 | (unsigned)(v == 0) << 2 |
                     (unsigned)(v + 1 == w->size[1]) << 3;
    }
    REFUSE_IF(rays != 0 && sides != 15, "dexel-hull");
    return NULL;
}

static const char *verify_dexels(const struct lfl_reader *r)
{
    unsigned axis;
    for (axis = 0; axis < 3; axis++) {
        const char *error = has_direction(r, axis) ? verify_direction(r, axis) : NULL;
        REFUSE_IF(error != NULL, error);
    }
    return NULL;
}
