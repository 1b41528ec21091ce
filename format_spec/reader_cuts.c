/*
 * The part of reader.c that only octrees with cuts need. reader.c includes this file behind what all files have in common,
 * which this part uses.
 *
 * Sides of surfaces are found by interval arithmetic in doubles. Every result is widened by one double on both sides, which
 * covers the rounding of the operation in any rounding mode, and a second rounding where the machine computes with more bits.
 */

#include "reader.h"

/* ---- §5.8 Cuts -------------------------------------------------------------------------------------------------- */

enum { TABLE_SURFACES = 3, MAX_NUMBERS = 10, MAX_MAPS = 64, HEAD_NOTHING = 0x00, HEAD_SPLIT = 0xFF, CUTS_OF_BLOCK = 32 };
enum { PLANE, QUADRIC, POWERS, TORUS, SLAB, SURFACE_KINDS };

/* A point, and both ends of ten moments. */
enum { MOMENTS_NUMBERS = 3 + 2 * 10 };

/* Numbers of a surface of each kind. */
static const unsigned number_count[SURFACE_KINDS] = {4, 10, 10, 4, 5};

static int is_cut_kind(uint32_t kind)
{
    return (kind >= KIND_CUT_HEADS && kind <= KIND_SURFACES) ||
           (kind >= KIND_SURFACE_NUMBERS && kind <= KIND_MOMENTS);
}

static struct demand demanded_of_cuts(uint32_t kind)
{
    struct demand d = {TYPE_U32, 1, 1, 0};
    switch (kind) {
    case KIND_CUT_HEADS:
    case KIND_CUT_IDS: d.element_type = TYPE_U8; break;
    case KIND_CUT_BLOCKS: d.components = 2; break;
    case KIND_CUT_FIRST: break;
    case KIND_SURFACES: d.components = 4; break;
    case KIND_SURFACE_NUMBERS: d.element_type = TYPE_F64; break;
    case KIND_PLACEMENTS: d.element_type = TYPE_RECORD, d.components = 13; break;
    case KIND_CELL_SLAB_GROUPS: d.element_type = TYPE_U64, d.components = 3; break;
    case KIND_MOMENTS: d.element_type = TYPE_F64, d.components = MOMENTS_NUMBERS; break;
    default: d.element_type = TYPE_U64, d.components = 2; break; /* origins, cell slabs */
    }
    return d;
}

static uint64_t count_of(const struct lfl_reader *r, unsigned kind) { return r->section[kind].count; }

/* Surfaces have the numbers of their records, and then those of the slabs of cells. */
static uint64_t surface_count(const struct lfl_reader *r)
{
    return count_of(r, KIND_SURFACES) + count_of(r, KIND_CELL_SLABS);
}

/* Bits of an id. */
static unsigned id_bits(const struct lfl_reader *r)
{
    unsigned bits = 1;
    while (bits < 32 && surface_count(r) > UINT64_C(1) << bits)
        bits++;
    return bits;
}

/* §5.8: the table, and what is below it. */
static const char *check_cut_sections(const struct lfl_reader *r)
{
    static const unsigned others[] = {KIND_CUT_IDS,         KIND_CUT_BLOCKS, KIND_CUT_FIRST, KIND_SURFACES,
                                      KIND_SURFACE_NUMBERS, KIND_PLACEMENTS, KIND_ORIGINS,   KIND_CELL_SLABS,
                                      KIND_CELL_SLAB_GROUPS, KIND_MOMENTS};
    enum { OTHERS = sizeof others / sizeof *others };
    uint64_t heads = count_of(r, KIND_CUT_HEADS), records = count_of(r, KIND_SURFACES);
    uint64_t slabs = count_of(r, KIND_CELL_SLABS);
    unsigned i;
    if (heads == 0) {
        for (i = 0; i < OTHERS; i++)
            REFUSE_IF(count_of(r, others[i]) != 0, "section-cuts");
        return NULL;
    }
    REFUSE_IF(heads > UINT32_MAX, "section-cuts");
    for (i = 0; i < OTHERS; i++)
        REFUSE_IF(others[i] != KIND_CUT_IDS && others[i] != KIND_CUT_FIRST && count_of(r, others[i]) > UINT32_MAX,
                  "section-cuts");
    REFUSE_IF(records + slabs > UINT32_MAX, "section-cuts");
    REFUSE_IF(count_of(r, KIND_CUT_IDS) > quotient_up(UINT64_C(0xFFFFFFFF) * id_bits(r), 8), "section-cuts");
    REFUSE_IF(count_of(r, KIND_CUT_BLOCKS) != quotient_up(heads, CUTS_OF_BLOCK), "section-cuts");
    /* No overflow: there are sections of so many elements and bricks. */
    REFUSE_IF(count_of(r, KIND_CUT_FIRST) != r->elements + r->bricks + 1, "section-cuts");
    REFUSE_IF((count_of(r, KIND_CUT_IDS) != 0) != (records + slabs != 0), "section-cuts");
    REFUSE_IF((count_of(r, KIND_SURFACE_NUMBERS) != 0) != (records != 0), "section-cuts");
    REFUSE_IF(count_of(r, KIND_PLACEMENTS) != 0 && records == 0, "section-cuts");
    REFUSE_IF(count_of(r, KIND_ORIGINS) != 0 && records == 0, "section-cuts");
    REFUSE_IF((count_of(r, KIND_CELL_SLAB_GROUPS) != 0) != (slabs != 0), "section-cuts");
    REFUSE_IF(count_of(r, KIND_CELL_SLAB_GROUPS) > slabs, "section-cuts");
    REFUSE_IF(count_of(r, KIND_MOMENTS) > 1, "section-cuts");
    return NULL;
}

static unsigned cut_head(const struct lfl_reader *r, uint64_t cut) { return *item(r, KIND_CUT_HEADS, cut); }
static uint32_t cut_first(const struct lfl_reader *r, uint64_t n) { return u32(item(r, KIND_CUT_FIRST, n)); }

/* Whether the section goes on for so many ids. */
static int has_ids(const struct lfl_reader *r, uint64_t count)
{
    return quotient_up(count * id_bits(r), 8) <= count_of(r, KIND_CUT_IDS);
}

/* Id i, which must be there: w bits from bit w i of the section on. */
static uint32_t cut_id(const struct lfl_reader *r, uint64_t i)
{
    unsigned bits = id_bits(r), k;
    uint64_t at = i * bits;
    uint32_t id = 0;
    for (k = 0; k < bits; k++, at++)
        id |= (uint32_t)(*item(r, KIND_CUT_IDS, at / 8) >> at % 8 & 1) << k;
    return id;
}

/* The bits of a table in which its surface i, 0 to 2, is positive. */
static unsigned where_positive(unsigned i)
{
    static const unsigned bits[TABLE_SURFACES] = {0xAA, 0xCC, 0xF0};
    return bits[i];
}

static int depends_on(unsigned table, unsigned i)
{
    return (table & where_positive(i)) >> (1 << i) != (table & ~where_positive(i));
}

/* How many surfaces a table has; none of those that say that nothing is known, or that the cell is split. */
static unsigned table_surfaces(unsigned table)
{
    unsigned i = TABLE_SURFACES;
    while (i > 0 && !depends_on(table, i - 1))
        i--;
    return i;
}

static int is_legal_head(unsigned table)
{
    unsigned i;
    for (i = 0; i < table_surfaces(table); i++) {
        if (!depends_on(table, i))
            return 0;
    }
    return 1;
}

/* The octants of an element that are PARTIAL as a whole, one bit for each. */
static unsigned partial_octants(struct words w)
{
    unsigned k, whole = 0;
    for (k = 0; k < 8; k++)
        whole |= (unsigned)((partial_cells(w) >> 8 * k & 0xFF) == 0xFF) << k;
    return whole;
}

/* ---- Surfaces --------------------------------------------------------------------------------------------------- */

/* A surface: where the doubles of its numbers begin, and how many each has. */
struct surface {
    unsigned kind;
    uint64_t first, end;
    uint64_t begin[MAX_NUMBERS];
    unsigned terms[MAX_NUMBERS];
    uint32_t placement;
    uint32_t origin; /* 0, or one more than the place of a slab's origin */
    uint64_t number; /* of a slab with an origin */
    int is_number_stored;
};

static uint64_t double_bits(const struct lfl_reader *r, uint64_t i) { return u64(item(r, KIND_SURFACE_NUMBERS, i)); }

static double first_double(const struct lfl_reader *r, const struct surface *s, unsigned i)
{
    return s->terms[i] == 0 ? 0.0 : from_bits(double_bits(r, s->begin[i]));
}

/* The sign of a number is that of its first double. */
static int number_sign(const struct lfl_reader *r, const struct surface *s, unsigned i)
{
    double c = first_double(r, s, i);
    return (c > 0) - (c < 0);
}

/* Whether |b| ≤ |a| · 2^-53. A product of a double and 2^53 is exact, or infinite. */
static int is_far_below(double b, double a)
{
    volatile double product = (b < 0 ? -b : b) * 9007199254740992.0;
    return product <= (a < 0 ? -a : a);
}

static int is_whole(double c, double least, double most)
{
    return c >= least && c <= most && c == (double)(uint64_t)c;
}

static int is_moderate(double c)
{
    uint64_t bits;
    memcpy(&bits, &c, sizeof bits);
    return c == 0.0 || !is_illegal(bits);
}

/* What the table of kinds in §5.8 demands of the numbers. */
static int is_legal_figure(const struct lfl_reader *r, const struct surface *s)
{
    unsigned i, any = 0;
    int high = 0;
    double n[MAX_NUMBERS];
    for (i = 0; i < number_count[s->kind]; i++) {
        n[i] = first_double(r, s, i);
        any |= (unsigned)(n[i] != 0.0) << i;
        if ((s->kind == POWERS || s->kind == SLAB) && s->terms[i] > 1)
            return 0;
    }
    switch (s->kind) {
    case PLANE: return (any & 7) != 0;
    case QUADRIC: return (any & 0x1FF) != 0;
    case POWERS:
        for (i = 0; i < 9; i += 3) {
            if (!is_moderate(n[i]) || !is_moderate(n[i + 1]) || !is_whole(n[i + 2], 1, 64))
                return 0;
            high |= n[i] != 0.0 && n[i + 2] > 2.0;
        }
        return high && is_moderate(n[9]);
    case TORUS: return number_sign(r, s, 0) > 0 && number_sign(r, s, 1) > 0 && number_sign(r, s, 2) > 0;
    default: /* slab */
        return (any & 7) != 0 && n[3] <= n[4];
    }
}

/* Surface i, which must be that of a record: the record, and whether its numbers are legal. Not its origin, its placement, and
   the place of its doubles. */
static const char *read_surface(const struct lfl_reader *r, uint64_t i, struct surface *s)
{
    const unsigned char *p = item(r, KIND_SURFACES, i);
    uint32_t kind = u32(p) & 0xFF, terms = u32(p + 4);
    unsigned k, m;
    REFUSE_IF(kind >= SURFACE_KINDS, "surface-record");
    s->kind = kind;
    s->first = s->end = u32(p + 8);
    s->placement = u32(p + 12);
    s->origin = u32(p) >> 8;
    s->number = i;
    s->is_number_stored = 0;
    for (k = 0; k < number_count[kind]; k++, terms >>= 3) {
        s->begin[k] = s->end;
        s->terms[k] = terms & 7;
        s->end += s->terms[k];
    }
    if (kind == SLAB && terms == 1) {
        terms = 0;
        s->is_number_stored = 1;
        s->end++;
    }
    REFUSE_IF(terms != 0 || s->end > count_of(r, KIND_SURFACE_NUMBERS), "surface-record");
    if (s->is_number_stored)
        s->number = double_bits(r, s->end - 1);
    for (k = 0; k < number_count[kind]; k++) {
        for (m = 0; m < s->terms[k]; m++) {
            uint64_t bits = double_bits(r, s->begin[k] + m);
            REFUSE_IF(!take_apart(bits).finite || bits << 1 == 0, "surface-number");
            REFUSE_IF(m > 0 && !is_far_below(from_bits(bits), from_bits(double_bits(r, s->begin[k] + m - 1))),
                      "surface-number");
        }
    }
    REFUSE_IF(!is_legal_figure(r, s), "surface-number");
    return NULL;
}

static double map_entry(const struct lfl_reader *r, uint64_t map, unsigned row, unsigned column)
{
    return from_bits(u64(item(r, KIND_PLACEMENTS, map) + 8 * (4 * row + column)));
}

static uint64_t map_outer(const struct lfl_reader *r, uint64_t map)
{
    return u64(item(r, KIND_PLACEMENTS, map) + 96);
}

/* A slab of a cell. */
struct cell_slab {
    unsigned level, index;
    uint32_t at[3];
    /* In units of the universe: the normal, and the offsets of the inner and of the outer face. */
    double number[5];
};

/* Whether an entry of a map is legal. */
static int is_entry(uint64_t bits)
{
    uint64_t magnitude = bits & UINT64_MAX >> 1;
    return bits == 0 || (magnitude >= (uint64_t)(1023 - 64) << 52 && magnitude <= (uint64_t)(1023 + 64) << 52);
}

/* 2^-n. */
static double power_of_half(unsigned n) { return from_bits((uint64_t)(1023 - n) << 52); }

/* Slab i of those of cells, which must be there. All numbers are exact: multiples of 2^-50 of less than 2^17, or of 2^-36. */
static const char *read_cell_slab(const struct lfl_reader *r, uint64_t i, struct cell_slab *s)
{
    const unsigned char *p = item(r, KIND_CELL_SLABS, i);
    uint64_t home = u64(p), planes = u64(p + 8), octants = home & ((UINT64_C(1) << 61) - 1);
    unsigned axis = planes >> 61 & 3, step = planes >> 55 & 63, width = planes >> 51 & 15, k, b;
    uint32_t others[2], offset = (uint32_t)(planes >> 32) & 0x7FFFF;
    double along = 0.0;
    others[0] = planes & 0xFFFF;
    others[1] = planes >> 16 & 0xFFFF;
    for (s->level = 0; s->level <= r->depth && octants >> 3 * s->level != 1; s->level++)
        ;
    s->index = home >> 61 & 3;
    REFUSE_IF(!is_entry(r->edge), "cell-slab");
    for (k = 0; k < 3; k++)
        REFUSE_IF(!is_entry(r->origin[k]), "cell-slab");
    REFUSE_IF(home >> 63 != 0 || s->index > 2 || s->level > r->depth, "cell-slab");
    REFUSE_IF(axis > 2 || others[0] == 0x8000 || others[1] == 0x8000 || step < 2 || step > 50, "cell-slab");
    memset(s->at, 0, sizeof s->at);
    for (b = 0; b < s->level; b++) {
        for (k = 0; k < 3; k++)
            s->at[k] |= (uint32_t)(octants >> (3 * b + k) & 1) << b;
    }
    s->number[axis] = planes >> 63 ? -1.0 : 1.0;
    for (k = 0; k < 2; k++)
        s->number[(axis + 1 + k) % 3] = ((double)others[k] - (others[k] >> 15 ? 65536.0 : 0.0)) * power_of_half(15);
    for (k = 0; k < 3; k++)
        along += s->number[k] * ((2.0 * s->at[k] + 1.0) * power_of_half(s->level + 1));
    along += ((double)offset - (offset >> 18 ? 524288.0 : 0.0)) * power_of_half(step);
    s->number[3] = along;
    s->number[4] = along + width * power_of_half(step);
    return NULL;
}

/* ---- §10.3 Verification ----------------------------------------------------------------------------------------- */

/* The octree levels of the cells of the tree's cuts, in their order: *known of them. There is room for all cuts. */
static const char *verify_first(const struct lfl_reader *r, unsigned char *level, uint64_t *known)
{
    uint64_t n, all = r->elements + r->bricks, cuts = count_of(r, KIND_CUT_HEADS);
    unsigned e = 0, k, m;
    *known = 0;
    if (r->root == LFL_PARTIAL)
        level[(*known)++] = 0;
    for (n = 0; n <= all; n++) {
        struct words w;
        unsigned whole, cells;
        REFUSE_IF(*known > cuts || cut_first(r, n) != *known, "cut-first");
        if (n == all)
            break;
        while (n >= r->start[e + 1])
            e++;
        if (n < r->elements)
            w = element(r, n);
        else
            REFUSE_IF(!brick(r, n - r->elements, &w), "dictionary-index"); /* never: the segments have been verified */
        whole = partial_octants(w);
        cells = 2 * e + 2 - parity(r);
        for (k = 0; k < 8; k++) {
            unsigned own = whole >> k & 1 ? 1 : popcount(partial_cells(w) >> 8 * k & 0xFF);
            for (m = 0; m < own; m++, ++*known) {
                if (*known < cuts)
                    level[*known] = (unsigned char)(whole >> k & 1 ? cells - 1 : cells);
            }
        }
    }
    return NULL;
}

static uint64_t group_end(const struct lfl_reader *r, uint64_t g)
{
    return u64(item(r, KIND_CELL_SLAB_GROUPS, g) + 16);
}

static int compare_origins(const void *a, const void *b)
{
    const unsigned char *p = *(const unsigned char *const *)a, *q = *(const unsigned char *const *)b;
    int order = memcmp(p, q, 16);
    return order != 0 ? order : (p > q) - (p < q);
}

/* The groups of slabs of cells: each has some, all together have all, and no two have one origin. */
static const char *verify_groups(const struct lfl_reader *r)
{
    uint64_t g, end = 0, groups = count_of(r, KIND_CELL_SLAB_GROUPS);
    const unsigned char **order;
    const char *error = NULL;
    for (g = 0; g < groups; g++) {
        REFUSE_IF(group_end(r, g) <= end, "cell-slab-group");
        end = group_end(r, g);
    }
    REFUSE_IF(end != count_of(r, KIND_CELL_SLABS), "cell-slab-group");
    if (groups < 2)
        return NULL;
    order = malloc((size_t)groups * sizeof *order);
    if (order == NULL)
        return lfl_out_of_memory;
    for (g = 0; g < groups; g++)
        order[g] = item(r, KIND_CELL_SLAB_GROUPS, g);
    qsort(order, (size_t)groups, sizeof *order, compare_origins);
    for (g = 1; g < groups && error == NULL; g++) {
        if (memcmp(order[g - 1], order[g], 16) == 0)
            error = "cell-slab-group";
    }
    free(order);
    return error;
}

/* Which surfaces have been met: of each group how many. Group 0 are the surfaces of records. */
struct met {
    uint64_t groups;
    uint64_t *count; /* for each group, and one more: for all of them together */
};

/* The number of the first surface of a group. */
static uint64_t group_begin(const struct lfl_reader *r, uint64_t g)
{
    if (g == 0)
        return 0;
    return count_of(r, KIND_SURFACES) + (g == 1 ? 0 : group_end(r, g - 2));
}

/* Meets a surface; returns 0 if it is not its turn. */
static int meet(const struct lfl_reader *r, struct met *met, uint32_t id)
{
    /* The last group that begins at the surface or before. */
    uint64_t low = 0, high = met->groups, begin;
    if (id >= surface_count(r))
        return 0;
    if (id < count_of(r, KIND_SURFACES))
        high = 1;
    while (high - low > 1) {
        uint64_t middle = low + (high - low) / 2;
        if (group_begin(r, middle) <= id)
            low = middle;
        else
            high = middle;
    }
    begin = group_begin(r, low);
    if (id - begin > met->count[low])
        return 0;
    if (low > 1 && met->count[low - 1] == 0)
        return 0;
    if (id - begin == met->count[low]) {
        met->count[low]++;
        met->count[met->groups]++;
    }
    return 1;
}

static const char *verify_cuts_in_order(const struct lfl_reader *r, unsigned char *level, uint64_t known, struct met *met)
{
    uint64_t cut, ids = 0, splits = 0, cuts = count_of(r, KIND_CUT_HEADS);
    unsigned i, nothing;
    for (cut = 0; cut < known; cut++) {
        unsigned head = cut_head(r, cut), own = table_surfaces(head);
        if (cut % CUTS_OF_BLOCK == 0) {
            const unsigned char *block = item(r, KIND_CUT_BLOCKS, cut / CUTS_OF_BLOCK);
            REFUSE_IF(u32(block) != ids || u32(block + 4) != splits, "cut-block");
        }
        REFUSE_IF(!is_legal_head(head), "cut-head");
        if (head == HEAD_SPLIT) {
            REFUSE_IF(level[cut] >= r->depth, "cut-head");
            REFUSE_IF(cuts - known < 8, "cut-group");
            for (i = 0, nothing = 0; i < 8; i++) {
                nothing += cut_head(r, known + i) == HEAD_NOTHING;
                level[known + i] = (unsigned char)(level[cut] + 1);
            }
            REFUSE_IF(nothing == 8, "cut-uniform");
            known += 8;
            splits++;
        }
        for (i = 0; i < own; i++, ids++) {
            uint32_t id;
            REFUSE_IF(ids >= UINT32_MAX || !has_ids(r, ids + 1), "cut-ids");
            id = cut_id(r, ids);
            REFUSE_IF(i > 0 && id <= cut_id(r, ids - 1), "cut-ids");
            REFUSE_IF(!meet(r, met, id), "cut-ids");
        }
    }
    REFUSE_IF(known != cuts, "cut-group");
    REFUSE_IF(quotient_up(ids * id_bits(r), 8) != count_of(r, KIND_CUT_IDS), "cut-ids");
    if (ids * id_bits(r) % 8 != 0)
        REFUSE_IF(*item(r, KIND_CUT_IDS, count_of(r, KIND_CUT_IDS) - 1) >> ids * id_bits(r) % 8 != 0, "cut-ids");
    REFUSE_IF(met->count[met->groups] != surface_count(r), "cut-ids");
    return NULL;
}

/* Number i of the moments, which must be there. */
static uint64_t moments_bits(const struct lfl_reader *r, unsigned i) { return u64(item(r, KIND_MOMENTS, 0) + 8 * i); }

static const char *verify_moments(const struct lfl_reader *r)
{
    unsigned i;
    if (count_of(r, KIND_MOMENTS) == 0)
        return NULL;
    for (i = 0; i < MOMENTS_NUMBERS; i++) {
        uint64_t bits = moments_bits(r, i);
        REFUSE_IF(!take_apart(bits).finite || bits == UINT64_C(1) << 63, "moments");
    }
    REFUSE_IF(from_bits(moments_bits(r, 3)) < 0.0, "moments");
    for (i = 3; i < MOMENTS_NUMBERS; i += 2)
        REFUSE_IF(from_bits(moments_bits(r, i)) > from_bits(moments_bits(r, i + 1)), "moments");
    return NULL;
}

static const char *verify_surfaces(const struct lfl_reader *r)
{
    uint64_t i, doubles = 0, maps = 0, origins = 0, m;
    unsigned length;
    for (i = 0; i < count_of(r, KIND_SURFACES); i++) {
        struct surface s;
        const char *error = read_surface(r, i, &s);
        REFUSE_IF(error != NULL && strcmp(error, "surface-record") == 0, error);
        REFUSE_IF(s.first != doubles, "surface-record");
        REFUSE_IF(error != NULL, error);
        doubles = s.end;
        REFUSE_IF(s.origin != 0 && s.kind != SLAB, "surface-origin");
        REFUSE_IF(s.is_number_stored && (s.origin == 0 || s.number == i), "surface-origin");
        REFUSE_IF(s.origin > origins + 1, "surface-origin");
        if (s.origin > origins)
            origins = s.origin;
        REFUSE_IF(s.placement > count_of(r, KIND_PLACEMENTS), "surface-placement");
        if (s.placement > maps) {
            REFUSE_IF(map_outer(r, maps) > maps, "surface-placement");
            for (m = maps + 1; m < s.placement; m++)
                REFUSE_IF(map_outer(r, m) != m, "surface-placement");
            maps = s.placement;
        }
        for (m = s.placement, length = 0; m != 0; m = map_outer(r, m - 1)) /* to earlier ones, which have been looked at */
            REFUSE_IF(++length > MAX_MAPS, "surface-placement");
    }
    REFUSE_IF(doubles != count_of(r, KIND_SURFACE_NUMBERS), "surface-record");
    REFUSE_IF(origins != count_of(r, KIND_ORIGINS), "surface-origin");
    REFUSE_IF(maps != count_of(r, KIND_PLACEMENTS), "surface-placement");
    for (i = 0; i < count_of(r, KIND_CELL_SLABS); i++) {
        struct cell_slab s;
        REFUSE_IF(read_cell_slab(r, i, &s) != NULL, "cell-slab");
    }
    return NULL;
}

/* Adds the product of three entries of a map, as a multiple of 2^-348, to the sum of its sign. Entries that are not 0 are
   multiples of 2^-116 and at most 2^64. */
static void add_product(struct natural sum[2], double a, double b, double c, int negative)
{
    double factors[3];
    struct natural product = {{1}};
    int i, shift = 348;
    factors[0] = a, factors[1] = b, factors[2] = c;
    for (i = 0; i < 3; i++) {
        uint64_t bits;
        struct dyadic d;
        memcpy(&bits, &factors[i], sizeof bits);
        d = take_apart(bits);
        if (d.mantissa == 0)
            return;
        product = natural_product(&product, d.mantissa);
        shift += d.exponent;
        negative ^= d.negative;
    }
    for (i = 0; i < 12; i++) /* three mantissas have 159 bits */
        natural_add(&sum[negative], product.limb[i], (unsigned)shift + 32 * (unsigned)i);
}

static int is_singular(const struct lfl_reader *r, uint64_t map)
{
    struct natural sum[2];
    unsigned i;
    memset(sum, 0, sizeof sum);
    for (i = 0; i < 3; i++) {
        unsigned j = (i + 1) % 3, k = (i + 2) % 3;
        double a = map_entry(r, map, 0, i);
        add_product(sum, a, map_entry(r, map, 1, j), map_entry(r, map, 2, k), 0);
        add_product(sum, a, map_entry(r, map, 1, k), map_entry(r, map, 2, j), 1);
    }
    return natural_compare(&sum[0], &sum[1]) == 0;
}

static const char *verify_placements(const struct lfl_reader *r)
{
    uint64_t map;
    unsigned i;
    for (map = 0; map < count_of(r, KIND_PLACEMENTS); map++) {
        for (i = 0; i < 12; i++) {
            REFUSE_IF(!is_entry(u64(item(r, KIND_PLACEMENTS, map) + 8 * i)), "placement-map");
        }
        REFUSE_IF(is_singular(r, map), "placement-map");
    }
    return NULL;
}

static const char *verify_cuts(const struct lfl_reader *r)
{
    uint64_t known;
    unsigned char *level;
    struct met met;
    const char *error;
    if (count_of(r, KIND_CUT_HEADS) == 0)
        return NULL;
    met.groups = 1 + count_of(r, KIND_CELL_SLAB_GROUPS);
    met.count = calloc((size_t)met.groups + 1, sizeof *met.count);
    level = malloc((size_t)count_of(r, KIND_CUT_HEADS));
    if (level == NULL || met.count == NULL)
        error = lfl_out_of_memory;
    else if ((error = verify_first(r, level, &known)) == NULL && (error = verify_groups(r)) == NULL)
        error = verify_cuts_in_order(r, level, known, &met);
    free(level);
    free(met.count);
    if (error != NULL || (error = verify_moments(r)) != NULL || (error = verify_surfaces(r)) != NULL)
        return error;
    return verify_placements(r);
}

/* ---- Intervals of doubles --------------------------------------------------------------------------------------- */

struct interval {
    double low, high;
};

static const struct interval zero = {0.0, 0.0};

static double infinite(int negative) { return from_bits((uint64_t)0x7FF << 52 | (uint64_t)(negative != 0) << 63); }

/* The next double above v, or below it; an infinity where there is none. */
static double beside(double v, int up)
{
    uint64_t bits;
    if (v == infinite(!up))
        return v;
    if (v == infinite(up) || v == 0.0)
        return v == 0.0 ? from_bits(1 | (uint64_t)!up << 63) : v;
    memcpy(&bits, &v, sizeof bits);
    bits += (v > 0) == (up != 0) ? 1 : UINT64_MAX;
    return from_bits(bits);
}

/* Everything from the least to the greatest of some rounded results; all numbers if one is none. */
static struct interval around(const double *v, unsigned count)
{
    struct interval all;
    unsigned i;
    all.low = infinite(0);
    all.high = infinite(1);
    for (i = 0; i < count; i++) {
        if (v[i] != v[i]) {
            all.low = infinite(1);
            all.high = infinite(0);
            return all;
        }
        if (v[i] < all.low)
            all.low = v[i];
        if (v[i] > all.high)
            all.high = v[i];
    }
    all.low = beside(all.low, 0);
    all.high = beside(all.high, 1);
    return all;
}

static int is_zero(struct interval a) { return a.low == 0.0 && a.high == 0.0; }

static struct interval exactly(double c)
{
    struct interval a;
    a.low = a.high = c;
    return a;
}

static struct interval negative(struct interval a)
{
    struct interval n;
    n.low = -a.high;
    n.high = -a.low;
    return n;
}

static struct interval sum(struct interval a, struct interval b)
{
    double v[2];
    if (is_zero(a) || is_zero(b))
        return is_zero(a) ? b : a;
    v[0] = a.low + b.low;
    v[1] = a.high + b.high;
    return around(v, 2);
}

static struct interval product(struct interval a, struct interval b)
{
    double v[4];
    if (is_zero(a) || is_zero(b))
        return zero;
    v[0] = a.low * b.low;
    v[1] = a.low * b.high;
    v[2] = a.high * b.low;
    v[3] = a.high * b.high;
    return around(v, 4);
}

static struct interval quotient(struct interval a, struct interval b)
{
    double v[4];
    if (b.low <= 0.0 && b.high >= 0.0) {
        v[0] = infinite(0) - infinite(0);
        return around(v, 1);
    }
    v[0] = a.low / b.low;
    v[1] = a.low / b.high;
    v[2] = a.high / b.low;
    v[3] = a.high / b.high;
    return around(v, 4);
}

static int interval_sign(struct interval a) { return (a.low > 0.0) - (a.high < 0.0); }

/* ---- §7.5 What does a cut say of a point? ----------------------------------------------------------------------- */

static struct interval number(const struct lfl_reader *r, const struct surface *s, unsigned i)
{
    struct interval all = zero;
    unsigned m;
    for (m = s->terms[i]; m-- > 0;)
        all = sum(all, exactly(from_bits(double_bits(r, s->begin[i] + m))));
    return all;
}

/* An affine map, as the rows of a matrix whose last column is the shift. */
struct map {
    struct interval row[3][4];
};

/* The map a, then stored map b. */
static struct map then(const struct lfl_reader *r, struct map a, uint64_t b)
{
    struct map all;
    unsigned i, j, k;
    for (i = 0; i < 3; i++) {
        for (j = 0; j < 4; j++) {
            all.row[i][j] = exactly(j < 3 ? 0.0 : map_entry(r, b, i, 3));
            for (k = 0; k < 3; k++)
                all.row[i][j] = sum(all.row[i][j], product(exactly(map_entry(r, b, i, k)), a.row[k][j]));
        }
    }
    return all;
}

/* p becomes the point that a map takes to p, by Cramer's rule. */
static void undo(const struct map *map, struct interval p[3])
{
    struct interval minor[3][3], q[3], determinant = zero;
    unsigned i, j;
    for (i = 0; i < 3; i++) {
        for (j = 0; j < 3; j++) {
            unsigned a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
            minor[i][j] = sum(product(map->row[a][c], map->row[b][d]),
                              negative(product(map->row[a][d], map->row[b][c])));
        }
        q[i] = sum(p[i], negative(map->row[i][3]));
    }
    for (j = 0; j < 3; j++)
        determinant = sum(determinant, product(map->row[0][j], minor[0][j]));
    for (j = 0; j < 3; j++) {
        struct interval all = zero;
        for (i = 0; i < 3; i++)
            all = sum(all, product(q[i], minor[i][j]));
        p[j] = quotient(all, determinant);
    }
}

static struct interval power(struct interval a, unsigned n)
{
    struct interval all = exactly(1.0);
    for (; n > 0; n--)
        all = product(all, a);
    return all;
}

/* 1 where the function of surface `id` is positive, -1 where it is negative, 0 if that cannot be told. */
static int side_of(const struct lfl_reader *r, uint32_t id, const double point[3])
{
    struct surface s;
    struct interval p[3], n[MAX_NUMBERS], value = zero;
    uint64_t next;
    unsigned i, j, length = 0;
    for (i = 0; i < 3; i++)
        p[i] = exactly(point[i]);
    if (id >= count_of(r, KIND_SURFACES)) {
        struct cell_slab slab;
        if (id >= surface_count(r) || read_cell_slab(r, id - count_of(r, KIND_SURFACES), &slab) != NULL)
            return 0;
        /* In units of the universe. */
        for (i = 0; i < 3; i++) {
            p[i] = quotient(sum(p[i], exactly(-from_bits(r->origin[i]))), exactly(from_bits(r->edge)));
            value = sum(value, product(exactly(slab.number[i]), p[i]));
        }
        return (value.high < slab.number[3]) - (value.low > slab.number[4]);
    }
    if (read_surface(r, id, &s) != NULL)
        return 0;
    if (s.placement != 0) {
        struct map all;
        for (i = 0; i < 3; i++) {
            for (j = 0; j < 4; j++)
                all.row[i][j] = exactly(i == j ? 1.0 : 0.0);
        }
        for (next = s.placement; next != 0;) {
            uint64_t map = next - 1;
            if (map >= count_of(r, KIND_PLACEMENTS) || map_outer(r, map) > map || ++length > MAX_MAPS)
                return 0;
            all = then(r, all, map);
            next = map_outer(r, map);
        }
        undo(&all, p);
    }
    for (i = 0; i < number_count[s.kind]; i++)
        n[i] = number(r, &s, i);
    switch (s.kind) {
    case PLANE:
        for (i = 0; i < 3; i++)
            value = sum(value, product(n[i], p[i]));
        return interval_sign(sum(value, n[3]));
    case QUADRIC:
        for (i = 0; i < 3; i++) {
            value = sum(value, product(n[i], product(p[i], p[i])));
            value = sum(value, product(n[3 + i], product(p[i], p[(i + 1) % 3])));
            value = sum(value, product(n[6 + i], p[i]));
        }
        return interval_sign(sum(value, n[9]));
    case POWERS:
        for (i = 0; i < 3; i++) {
            struct interval base = sum(p[i], negative(n[3 * i + 1]));
            value = sum(value, product(n[3 * i], power(base, (unsigned)n[3 * i + 2].low)));
        }
        return interval_sign(sum(value, n[9]));
    case TORUS: {
        /* q - (ρ - R)² - h² = 2 R ρ - (ρ² + R² + h² - q), with ρ² = (s x)² + (s y)² and h = s z + t */
        struct interval square = product(product(n[2], n[2]), sum(product(p[0], p[0]), product(p[1], p[1])));
        struct interval h = sum(product(n[2], p[2]), n[3]), major = product(n[0], n[0]);
        struct interval rest = sum(sum(square, major), sum(product(h, h), negative(n[1])));
        struct interval twice = product(exactly(4.0), product(major, square));
        int sign = interval_sign(sum(twice, negative(product(rest, rest))));
        if (interval_sign(rest) < 0 || sign > 0)
            return 1;
        return interval_sign(rest) > 0 && sign < 0 ? -1 : 0;
    }
    default: /* slab */
        for (i = 0; i < 3; i++)
            value = sum(value, product(n[i], p[i]));
        return (value.high < n[3].low) - (value.low > n[4].high);
    }
}

/* The cut of the PARTIAL cell in which a finest cell lies, and the cell's level. Returns 0 if it has none. */
static int find_cut(const struct lfl_reader *r, const uint32_t at[3], uint64_t *cut, unsigned *level)
{
    struct words w;
    uint64_t n = 0;
    unsigned e, c, k, whole, s = 0;
    *cut = 0;
    *level = 0;
    if (r->root != LFL_BRANCH)
        return r->root == LFL_PARTIAL;
    for (e = 0;; e++) {
        s = 2 * (r->levels - 1 - e);
        c = morton(at[0] >> s, at[1] >> s, at[2] >> s);
        if (e + 1 == r->levels) {
            if (!brick(r, n - r->elements, &w))
                return 0;
            break;
        }
        w = element(r, n);
        if (tag_of(w, c) != LFL_BRANCH)
            break;
        n = first_child(r, n) + popcount(branch_cells(w) & ((UINT64_C(1) << c) - 1));
        if (n < r->start[e + 1] || n >= r->start[e + 2])
            return 0;
    }
    if (tag_of(w, c) != LFL_PARTIAL)
        return 0;
    *level = 2 * e + 2 - parity(r);
    whole = partial_octants(w);
    *cut = cut_first(r, n);
    if (whole >> c / 8 & 1) {
        --*level;
        c = c / 8 * 8;
    }
    for (k = 0; k < 8; k++) {
        uint64_t own = partial_cells(w) & UINT64_C(0xFF) << 8 * k & ((UINT64_C(1) << c) - 1);
        *cut += whole >> k & 1 ? own != 0 : popcount(own);
    }
    return 1;
}

/* Ids and splits before a cut. */
static void counts_before(const struct lfl_reader *r, uint64_t cut, uint64_t *ids, uint64_t *splits)
{
    const unsigned char *block = item(r, KIND_CUT_BLOCKS, cut / CUTS_OF_BLOCK);
    uint64_t i;
    *ids = u32(block);
    *splits = u32(block + 4);
    for (i = cut / CUTS_OF_BLOCK * CUTS_OF_BLOCK; i < cut; i++) {
        unsigned head = cut_head(r, i);
        *ids += is_legal_head(head) ? table_surfaces(head) : 0;
        *splits += head == HEAD_SPLIT;
    }
}

enum lfl_answer lfl_contains_with_cuts(const struct lfl_reader *r, double x, double y, double z)
{
    uint64_t cut, cuts = count_of(r, KIND_CUT_HEADS), ids, splits, group;
    uint32_t at[3];
    double point[3];
    unsigned level, head, i, s;
    point[0] = x, point[1] = y, point[2] = z;
    for (i = 0; i < 3; i++) {
        if (!lfl_cell(r, i, point[i], &at[i]))
            return LFL_UNDECIDED;
    }
    if (cuts == 0 || !find_cut(r, at, &cut, &level))
        return lfl_contains(r, x, y, z);
    for (;;) {
        if (cut >= cuts)
            return LFL_UNDECIDED;
        head = cut_head(r, cut);
        counts_before(r, cut, &ids, &splits);
        if (head != HEAD_SPLIT)
            break;
        group = cut_first(r, r->elements + r->bricks) + 8 * splits;
        if (group <= cut || group + 8 > cuts || ++level > r->depth)
            return LFL_UNDECIDED;
        s = r->depth - level;
        cut = group + ((at[0] >> s & 1) | (at[1] >> s & 1) << 1 | (at[2] >> s & 1) << 2);
    }
    if (!is_legal_head(head))
        return LFL_UNDECIDED;
    for (i = 0; i < table_surfaces(cut_head(r, cut)); i++) {
        int side;
        unsigned half;
        if (!has_ids(r, ids + i + 1))
            return LFL_UNDECIDED;
        side = side_of(r, cut_id(r, ids + i), point);
        half = side > 0 ? head & where_positive(i) : head & ~where_positive(i);
        if (side > 0)
            head = half | half >> (1 << i);
        else if (side < 0)
            head = half | half << (1 << i);
    }
    if (table_surfaces(head) != 0 || cut_head(r, cut) == HEAD_NOTHING)
        return LFL_UNDECIDED;
    return head == 0 ? LFL_OUTSIDE : LFL_INSIDE;
}
