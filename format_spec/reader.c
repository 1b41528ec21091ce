/*
 * A reader of files of the Leafless format, version 0.4, in C99 and nothing but its library. reader.h declares its
 * interface. What only tri-dexel models have is read by reader_dexels.c, cuts by reader_cuts.c. This file includes both.
 *
 * It is meant to be read beside specification.md, whose sections the comments name (§): each rule of §10 stands here
 * under its name, in the order in which the specification lists it. It favours being evident over being fast; yet every
 * check takes no more than the work that the specification promises.
 *
 * As a program:
 *
 *     cc -std=c99 -O2 -o reader reader.c
 *     reader [--probe | --plain | --metadata] FILE...    prints what the files say, as vectors/valid/NAME.txt does
 *     reader [--plain | --metadata] --points FILE        reads lines `x y z`, prints inside, outside or undecided
 *     reader [--plain | --metadata] --cut-points FILE    the same, with what the cuts say
 *     reader [--plain | --metadata] --volume FILE...     prints the volume in cubic model units, rounded outwards
 *     reader [--metadata] --values FILE                  reads lines `x y z`, prints the values of all channels
 *     reader [--plain | --metadata] --cells FILE         of a tri-dexel model: reads lines `i j k` of indices of a finest
 *                                                        cell, prints for x, y and z whether its centre lies in or out
 *
 * The option says how much is checked (§10): §10.1; also §10.2 without metadata and channels; also these; without any
 * option all. The exit code is 0, or 1 if a file is refused (`refused: RULE`), or 2 for wrong usage and failing input.
 *
 * As a library: compile this file with LEAFLESS_READER_NO_MAIN, and include reader.h. The bytes of a file must stay as
 * they are while its reader is used. Only lfl_verify allocates memory, and releases it itself: at most 1.3 MB at a time, or
 * a byte for each cut and 16 bytes for each group of cell slabs.
 *
 * No byte order, alignment or layout of structures is assumed. But for the sides of surfaces (reader_cuts.c), no
 * floating-point arithmetic is done: doubles are taken apart and put together as 64 bits. The platform's `double` must be
 * IEEE 754 binary64, in the byte order of its 64-bit integers.
 */

#include "reader.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#if FLT_RADIX != 2 || DBL_MANT_DIG != 53 || DBL_MAX_EXP != 1024
#error "double is not IEEE 754 binary64"
#endif

/* ---- §1 Words and conventions ----------------------------------------------------------------------------------- */

const char lfl_out_of_memory[] = "out of memory";

/* Each function that checks returns NULL or the name of the first rule that refuses the file. */
#define REFUSE_IF(condition, rule) \
    do {                           \
        if (condition)             \
            return (rule);         \
    } while (0)

static uint64_t little_endian(const unsigned char *p, unsigned bytes)
{
    uint64_t value = 0;
    while (bytes-- > 0)
        value = value << 8 | p[bytes];
    return value;
}

static unsigned u16(const unsigned char *p) { return (unsigned)little_endian(p, 2); }
static uint32_t u32(const unsigned char *p) { return (uint32_t)little_endian(p, 4); }
static uint64_t u64(const unsigned char *p) { return little_endian(p, 8); }

static int all_zero(const unsigned char *p, size_t length)
{
    size_t i;
    for (i = 0; i < length; i++) {
        if (p[i] != 0)
            return 0;
    }
    return 1;
}

static unsigned popcount(uint64_t w)
{
    unsigned count = 0;
    for (; w != 0; w &= w - 1)
        count++;
    return count;
}

static uint64_t quotient_up(uint64_t a, uint64_t b) { return a / b + (a % b != 0); }

static uint32_t crc32(const unsigned char *p, size_t length)
{
    uint32_t table[256], crc = 0xFFFFFFFF;
    unsigned i, bit;
    for (i = 0; i < 256; i++) {
        table[i] = i;
        for (bit = 0; bit < 8; bit++)
            table[i] = table[i] >> 1 ^ (table[i] & 1 ? 0xEDB88320 : 0);
    }
    for (; length > 0; length--, p++)
        crc = crc >> 8 ^ table[(crc ^ *p) & 0xFF];
    return crc ^ 0xFFFFFFFF;
}

/* ---- §2 What a file says ---------------------------------------------------------------------------------------- */

/* §2.2, §2.3: the tags of 64 cells. */
struct words {
    uint64_t lower, upper;
};

static uint64_t branch_cells(struct words w) { return w.lower & ~w.upper; }
static uint64_t partial_cells(struct words w) { return ~w.lower & w.upper; }
static uint64_t full_cells(struct words w) { return w.lower & w.upper; }

static enum lfl_tag tag_of(struct words w, unsigned c)
{
    return (enum lfl_tag)((w.lower >> c & 1) + 2 * (w.upper >> c & 1));
}

/* Whether all of the cells in `mask` have the same tag, which is not BRANCH (§8). */
static int is_uniform(struct words w, uint64_t mask)
{
    uint64_t lower = w.lower & mask, upper = w.upper & mask;
    return (lower == 0 && upper == 0) || (lower == 0 && upper == mask) || (lower == mask && upper == mask);
}

static unsigned morton(uint32_t x, uint32_t y, uint32_t z)
{
    return (unsigned)((x & 1) | (y & 1) << 1 | (z & 1) << 2 | (x & 2) << 2 | (y & 2) << 3 | (z & 2) << 4);
}

/* p of §2.3: 1 for odd depth, where the universe is octant 0 of the root element. */
static unsigned parity(const struct lfl_reader *r) { return r->depth % 2; }

/* The cells that exist in an element of an element level: 0 to 7 in the root of an odd depth, else all. */
static uint64_t existing_cells(const struct lfl_reader *r, unsigned element_level)
{
    return element_level == 0 && parity(r) == 1 ? 0xFF : UINT64_MAX;
}

/* ---- Doubles as integers ---------------------------------------------------------------------------------------- */

/* A finite f64 is (-1)^negative · mantissa · 2^exponent, with -1074 ≤ exponent ≤ 971. */
struct dyadic {
    int negative, finite;
    uint64_t mantissa;
    int exponent;
};

static struct dyadic take_apart(uint64_t bits)
{
    struct dyadic d;
    int biased = (int)(bits >> 52 & 0x7FF);
    d.negative = bits >> 63 != 0;
    d.finite = biased != 0x7FF;
    d.mantissa = bits & ((UINT64_C(1) << 52) - 1);
    if (biased != 0)
        d.mantissa |= UINT64_C(1) << 52;
    d.exponent = (biased != 0 ? biased : 1) - 1075;
    return d;
}

static double from_bits(uint64_t bits)
{
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Illegal are NaN, the infinities, and magnitudes outside of 2^-256 to 2^256. So is zero, which callers except. */
static int is_illegal(uint64_t bits)
{
    uint64_t magnitude = bits & UINT64_MAX >> 1; /* ordered as the magnitudes are, the infinity and NaN above all */
    return magnitude < (uint64_t)(1023 - 256) << 52 || magnitude > (uint64_t)(1023 + 256) << 52;
}

/* Natural numbers of up to 2112 bits. As multiples of 2^-1074, all f64 and a few times the greatest are such numbers,
   since 2^1024 / 2^-1074 = 2^2098. */
enum { LIMBS = 66, UNIT_EXPONENT = -1074 };

struct natural {
    uint32_t limb[LIMBS]; /* the least significant first */
};

/* sum += value · 2^shift, which must not exceed the range. */
static void natural_add(struct natural *sum, uint64_t value, unsigned shift)
{
    uint64_t carry = (value & 0xFFFFFFFF) << shift % 32, high = (value >> 32) << shift % 32;
    size_t i;
    for (i = shift / 32; i < LIMBS && (carry != 0 || high != 0); i++) {
        carry += sum->limb[i]; /* less than 2^63 + 2^32 */
        sum->limb[i] = (uint32_t)(carry & 0xFFFFFFFF);
        carry = (carry >> 32) + high;
        high = 0;
    }
}

static struct natural natural_product(const struct natural *a, uint64_t b)
{
    struct natural product = {{0}};
    unsigned i;
    for (i = 0; i < LIMBS; i++) {
        natural_add(&product, a->limb[i] * (b & 0xFFFFFFFF), 32 * i);
        natural_add(&product, a->limb[i] * (b >> 32), 32 * (i + 1));
    }
    return product;
}

static int natural_compare(const struct natural *a, const struct natural *b)
{
    size_t i;
    for (i = LIMBS; i-- > 0;) {
        if (a->limb[i] != b->limb[i])
            return a->limb[i] < b->limb[i] ? -1 : 1;
    }
    return 0;
}

static unsigned natural_bit(const struct natural *a, int bit) { return a->limb[bit / 32] >> bit % 32 & 1; }

/* a · 2^exponent as a double, rounded down or up. Unless a is 0, this must be far from the least and greatest f64. */
static double natural_round(const struct natural *a, int exponent, int up)
{
    uint64_t mantissa = 0;
    int top = 32 * LIMBS - 1, bit, rest = 0;
    while (top >= 0 && !natural_bit(a, top))
        top--;
    if (top < 0)
        return 0.0;
    for (bit = top; bit > top - 53; bit--)
        mantissa = mantissa << 1 | (bit >= 0 ? natural_bit(a, bit) : 0);
    for (; bit >= 0 && !rest; bit--)
        rest = natural_bit(a, bit) != 0;
    exponent += top - 52;
    if (up && rest && ++mantissa >> 53 != 0) {
        mantissa >>= 1;
        exponent++;
    }
    return from_bits((uint64_t)(exponent + 1075) << 52 | (mantissa & ((UINT64_C(1) << 52) - 1)));
}

/* ---- §5 Sections ------------------------------------------------------------------------------------------------ */

enum {
    KIND_OBJECTS = 1,
    KIND_METADATA,
    KIND_LEVEL_TABLE,
    KIND_PLANES,
    KIND_REL,
    KIND_BASE,
    KIND_BRICKS,
    KIND_BRICK_INDICES,
    KIND_DICTIONARY_ENTRIES,
    KIND_DICTIONARY_SEGMENTS,
    KIND_CUT_HEADS,
    KIND_CUT_IDS,
    KIND_CUT_BLOCKS,
    KIND_CUT_FIRST,
    KIND_SURFACES,
    KIND_VALUES,
    KIND_VALUE_REL = 18,
    KIND_VALUE_BASE,
    KIND_SURFACE_NUMBERS,
    KIND_PLACEMENTS,
    KIND_ORIGINS,
    KIND_CELL_SLABS,
    KIND_CELL_SLAB_GROUPS,
    KIND_MOMENTS
};

/* Types of objects (§5.1). */
enum { SOLID = 1, CHANNEL = 2, DEXELS = 3 };
enum { MAX_CHANNELS = 256, MAX_CHANNEL_METADATA = 1 << 16 };

enum { RAW = 0, DICTIONARY = 1, ONE_SEGMENT = 63, MAX_METADATA = 1 << 20, MAX_SEGMENT_ENTRIES = 1 << 16 };

/* Element types (§4), with their sizes. */
enum { TYPE_RECORD, TYPE_U8, TYPE_U16, TYPE_U32, TYPE_U64, TYPE_F32, TYPE_F64, TYPES };
static const unsigned type_size[TYPES] = {8, 1, 2, 4, 8, 4, 8};

/* §3: bit 0 of the required flags, which versions before 0.3 do not know. */
int lfl_is_dexels(const struct lfl_reader *r) { return r->minor >= 3 && (r->required_flags & 1) != 0; }

/* A row of §5's table. */
struct demand {
    unsigned element_type, components;
    int any_count;  /* objects, metadata and cuts: other rules bound their counts */
    uint64_t count; /* 0 where the section must be absent */
};

/* An element of a section of the solid. The index must be less than the section's count. */
static const unsigned char *item(const struct lfl_reader *r, unsigned kind, uint64_t index)
{
    const struct lfl_section *section = &r->section[kind];
    uint64_t size = type_size[section->element_type] * section->components;
    return r->bytes + (size_t)section->offset + (size_t)(index * size);
}

/* §5.4 */
static struct words element(const struct lfl_reader *r, uint64_t n)
{
    const unsigned char *p = item(r, KIND_PLANES, n);
    struct words w = {0, 0};
    w.lower = u64(p);
    w.upper = u64(p + 8);
    return w;
}

/* §2.4. Of damaged bytes the sum may wrap around; whoever uses it compares it with something (§6, §10.3). */
static uint64_t first_child(const struct lfl_reader *r, uint64_t n)
{
    return u64(item(r, KIND_BASE, n / 1024)) + u16(item(r, KIND_REL, n));
}

/* §5.5: entry `index` of the bricks or of the dictionary. */
static struct words brick_entry(const struct lfl_reader *r, unsigned kind, uint64_t index)
{
    const unsigned char *p = item(r, kind, index);
    struct words w = {0, 0};
    w.lower = u64(p);
    w.upper = r->brick_planes == 2 ? u64(p + 8) : w.lower;
    return w;
}

/* §5.5: brick b. Returns 0 if its index leads outside of the dictionary (§6). */
static int brick(const struct lfl_reader *r, uint64_t b, struct words *w)
{
    uint64_t segment, index;
    if (r->encoding == RAW) {
        *w = brick_entry(r, KIND_BRICKS, b);
        return 1;
    }
    segment = u64(item(r, KIND_DICTIONARY_SEGMENTS, b >> r->shift));
    index = u16(item(r, KIND_BRICK_INDICES, b));
    if (segment >= r->entries || index >= r->entries - segment)
        return 0;
    *w = brick_entry(r, KIND_DICTIONARY_ENTRIES, segment + index);
    return 1;
}

/* §5.3 */
struct lfl_level lfl_level(const struct lfl_reader *r, unsigned level)
{
    const unsigned char *p = item(r, KIND_LEVEL_TABLE, level);
    struct lfl_level entry;
    entry.nodes = u64(p);
    entry.full = u64(p + 8);
    entry.partial = u64(p + 16);
    return entry;
}

/* §5.3: the octree level whose nodes are the elements of element level e. */
static unsigned level_of(const struct lfl_reader *r, unsigned e) { return e == 0 ? 0 : 2 * e - parity(r); }

/* ---- §5.7 Tri-dexel models, §5.8 cuts --------------------------------------------------------------------------- */

/* They use what stands above, and nothing that stands below. */
#include "reader_dexels.c"
#include "reader_cuts.c"

/* ---- §5 The sections that a file must have, and its metadata ----------------------------------------------------- */

/* Kinds of sections of object 0: those of §5, from version 0.4 on with those of §5.8, or of a tri-dexel model those of §5.7. */
static int is_known_kind(const struct lfl_reader *r, uint32_t kind)
{
    if (kind == KIND_OBJECTS || kind == KIND_METADATA)
        return 1;
    if (lfl_is_dexels(r))
        return kind >= 32 && kind < 48;
    if (is_cut_kind(kind))
        return r->minor >= 4;
    return kind > KIND_METADATA && kind <= KIND_DICTIONARY_SEGMENTS;
}

static int is_known(const struct lfl_reader *r, const struct lfl_section *s)
{
    return s->owner == 0 && is_known_kind(r, s->kind);
}

static struct demand demanded(const struct lfl_reader *r, uint32_t kind)
{
    int dictionary = r->encoding == DICTIONARY;
    struct demand d = {TYPE_U64, 1, 0, 0};
    if (kind >= 32)
        return demanded_of_dexels(r, kind);
    if (is_cut_kind(kind))
        return demanded_of_cuts(kind);
    switch (kind) {
    case KIND_OBJECTS: d.element_type = TYPE_RECORD, d.components = 16, d.any_count = 1; break;
    case KIND_METADATA: d.element_type = TYPE_U8, d.any_count = 1; break;
    case KIND_LEVEL_TABLE: d.components = 3, d.count = r->depth + 1; break;
    case KIND_PLANES: d.components = 2, d.count = r->elements; break;
    case KIND_REL: d.element_type = TYPE_U16, d.count = r->elements; break;
    case KIND_BASE: d.count = quotient_up(r->elements, 1024); break;
    case KIND_BRICKS: d.components = r->brick_planes, d.count = dictionary ? 0 : r->bricks; break;
    case KIND_BRICK_INDICES: d.element_type = TYPE_U16, d.count = dictionary ? r->bricks : 0; break;
    case KIND_DICTIONARY_ENTRIES: d.components = r->brick_planes, d.count = r->entries; break;
    default: /* dictionary segments */
        d.count = dictionary ? quotient_up(r->bricks, UINT64_C(1) << r->shift) : 0;
        break;
    }
    return d;
}

/* §5.2 */
int lfl_metadata(const struct lfl_reader *r, uint64_t *position, struct lfl_fact *fact)
{
    uint64_t rest = r->section[KIND_METADATA].length, key_length, value_length;
    const unsigned char *p;
    if (*position >= rest)
        return 0;
    p = item(r, KIND_METADATA, *position);
    rest -= *position;
    if (rest < 8)
        return -1;
    key_length = u32(p);
    value_length = u32(p + 4);
    if (key_length + value_length > rest - 8) /* the sum of two u32 does not overflow */
        return -1;
    fact->key = p + 8;
    fact->key_length = (size_t)key_length;
    fact->value = fact->key + fact->key_length;
    fact->value_length = (size_t)value_length;
    *position += 8 + key_length + value_length;
    return 1;
}

/* UTF-8 in the shortest form, without surrogates. */
static int is_utf8(const unsigned char *p, size_t length)
{
    size_t i = 0;
    while (i < length) {
        unsigned lead = p[i++], more, k;
        uint32_t c, least;
        if (lead < 0x80)
            continue;
        if (lead >= 0xC0 && lead < 0xE0)
            more = 1, least = 0x80, c = lead & 0x1F;
        else if (lead >= 0xE0 && lead < 0xF0)
            more = 2, least = 0x800, c = lead & 0x0F;
        else if (lead >= 0xF0 && lead < 0xF8)
            more = 3, least = 0x10000, c = lead & 0x07;
        else
            return 0;
        if (length - i < more)
            return 0;
        for (k = 0; k < more; k++, i++) {
            if ((p[i] & 0xC0) != 0x80)
                return 0;
            c = c << 6 | (p[i] & 0x3F);
        }
        if (c < least || c > 0x10FFFF || (c >= 0xD800 && c <= 0xDFFF))
            return 0;
    }
    return 1;
}

/* Whether key a stands before key b: byte by byte, a prefix before what it begins. */
static int ascends(const struct lfl_fact *a, const struct lfl_fact *b)
{
    size_t common = a->key_length < b->key_length ? a->key_length : b->key_length;
    int order = common == 0 ? 0 : memcmp(a->key, b->key, common);
    return order < 0 || (order == 0 && a->key_length < b->key_length);
}

/* ---- §10.1 Header and section table ----------------------------------------------------------------------------- */

static const unsigned char magic[8] = {0x89, 0x4C, 0x46, 0x4C, 0x0D, 0x0A, 0x1A, 0x0A};

/* Whether bytes that do not begin with the magic begin with what a transfer in text mode makes of it. */
static int is_text_mode(const unsigned char *p, size_t length)
{
    size_t i = 4;
    if (length < 4 || memcmp(p, magic, 4) != 0)
        return 0;
    while (i < length && i < 8 && (p[i] == 0x0D || p[i] == 0x0A))
        i++;
    return i > 4 && length - i >= 2 && p[i] == 0x1A && (p[i + 1] == 0x0D || p[i + 1] == 0x0A);
}

/* §10: whether a later version wrote the file, which may have given a meaning to what is reserved today. */
static int is_newer(const struct lfl_reader *r) { return r->minor > 4; }

static uint64_t end_of_table(const struct lfl_reader *r) { return 128 + 48 * (uint64_t)r->section_count; }

/* The rules of §10.1 on how bricks are coded and how much there is of everything. */
static const char *check_counts(const struct lfl_reader *r)
{
    REFUSE_IF(r->encoding != RAW && r->encoding != DICTIONARY, "header-encoding");
    REFUSE_IF(r->encoding == RAW && r->shift != 0, "header-raw-shift");
    REFUSE_IF(r->encoding == RAW && r->entries != 0, "header-raw-entries");
    if (r->encoding == DICTIONARY) {
        REFUSE_IF(r->shift < 16 || r->shift > ONE_SEGMENT, "header-shift");
        REFUSE_IF(r->shift == ONE_SEGMENT && r->bricks == 0, "header-shift");
        REFUSE_IF(r->shift < ONE_SEGMENT && r->bricks >= 1 && r->bricks <= UINT64_C(1) << r->shift, "header-shift");
        REFUSE_IF(r->entries == 0 || r->entries > r->bricks, "header-entries");
    }
    REFUSE_IF(r->elements != 0 && (r->depth <= 2 || r->root != LFL_BRANCH), "header-elements");
    REFUSE_IF(r->bricks != 0 && r->root != LFL_BRANCH, "header-bricks");
    return NULL;
}

/* What only octrees have. */
static const char *check_octree_header(const struct lfl_reader *r)
{
    REFUSE_IF(r->root > 3, "header-root");
    REFUSE_IF(r->exterior == 1 || r->exterior > 3, "header-exterior");
    REFUSE_IF(r->proof > 3, "header-proof");
    REFUSE_IF(r->displacement >= UINT64_C(0x7FF) << 52, "header-displacement"); /* the sign, the infinity, NaN */
    REFUSE_IF(r->brick_planes != 1 && r->brick_planes != 2, "header-brick-planes");
    return check_counts(r);
}

static const char *check_header(struct lfl_reader *r)
{
    const unsigned char *h = r->bytes;
    const char *error;
    size_t beginning = r->length < 8 ? r->length : 8;
    int is_magic = beginning == 0 || memcmp(h, magic, beginning) == 0, i;

    REFUSE_IF(!is_magic && is_text_mode(h, r->length), "header-text-mode");
    REFUSE_IF(!is_magic, "header-magic");
    REFUSE_IF(r->length < 128, "header-short");

    /* §3 */
    r->major = u16(h + 8);
    r->minor = u16(h + 10);
    r->required_flags = u32(h + 16);
    r->file_length = u64(h + 24);
    for (i = 0; i < 3; i++)
        r->origin[i] = u64(h + 32 + 8 * i);
    r->edge = u64(h + 56);
    r->depth = h[64];
    r->root = h[65];
    r->exterior = h[66];
    r->brick_planes = h[67];
    r->encoding = h[68];
    r->shift = h[69];
    r->proof = h[70];
    r->form = h[71];
    r->elements = u64(h + 72);
    r->bricks = u64(h + 80);
    r->entries = u64(h + 88);
    r->section_count = u32(h + 96);
    r->displacement = u64(h + 104);

    REFUSE_IF(r->major != 0 || r->minor == 0, "header-major");
    REFUSE_IF(crc32(h, 124) != u32(h + 124), "header-crc");
    REFUSE_IF(u32(h + 12) != 128, "header-length");
    REFUSE_IF(r->required_flags != (lfl_is_dexels(r) ? 1u : 0u), "header-required-flags");
    REFUSE_IF(u32(h + 20) != 0 && !is_newer(r), "header-optional-flags");
    REFUSE_IF(h[71] != 0 && !lfl_is_dexels(r) && !is_newer(r), "header-reserved");
    REFUSE_IF(!all_zero(h + 112, 12) && !is_newer(r), "header-reserved");
    for (i = 0; i < 3; i++)
        REFUSE_IF(r->origin[i] != 0 && is_illegal(r->origin[i]), "header-origin");
    REFUSE_IF(r->edge >> 63 != 0 || is_illegal(r->edge), "header-edge");
    REFUSE_IF(r->depth < 1 || r->depth > LFL_MAX_DEPTH, "header-depth");
    error = lfl_is_dexels(r) ? check_dexel_header(r) : check_octree_header(r);
    REFUSE_IF(error != NULL, error);
    REFUSE_IF(r->section_count == 0 || r->section_count > 4096, "header-section-count");
    REFUSE_IF(r->file_length <= end_of_table(r), "header-file-length");
    return NULL;
}

/* §4 */
struct lfl_section lfl_section(const struct lfl_reader *r, uint32_t index)
{
    const unsigned char *p = r->bytes + 128 + 48 * (size_t)index;
    struct lfl_section s;
    s.kind = u32(p);
    s.owner = u32(p + 4);
    s.element_type = p[8];
    s.components = p[9];
    s.encoding = p[10];
    s.reserved = p[11];
    s.flags = u32(p + 12);
    s.offset = u64(p + 16);
    s.length = u64(p + 24);
    s.count = u64(p + 32);
    s.crc = u32(p + 40);
    s.same = u32(p + 44);
    return s;
}

/* §4: whether an entry may have the bytes of an earlier one. */
static int may_share(const struct lfl_section *s, const struct lfl_section *earlier)
{
    return earlier->same == 0 && s->element_type == earlier->element_type && s->components == earlier->components &&
           s->encoding == earlier->encoding && s->reserved == earlier->reserved && s->offset == earlier->offset &&
           s->length == earlier->length && s->count == earlier->count && s->crc == earlier->crc;
}

/* The entry `index`. What precedes it ends at *end; *owner and *kind are those of the entry before. All move on. */
static const char *check_section(struct lfl_reader *r, uint32_t index, uint64_t *end, uint32_t *owner, uint32_t *kind)
{
    struct lfl_section s = lfl_section(r, index), earlier;
    struct demand d;
    int known = is_known(r, &s), newer = is_newer(r);

    REFUSE_IF(s.kind == 0, "section-kind");
    REFUSE_IF(s.flags >> 1 != 0 && !newer, "section-flags");
    REFUSE_IF(s.reserved != 0 && !newer, "table-reserved");
    REFUSE_IF(s.encoding != RAW && (!newer || known), "table-encoding");
    REFUSE_IF(s.components == 0 || (s.element_type >= TYPES && !newer), "table-element");
    REFUSE_IF(s.length == 0 || s.count == 0, "section-length");
    if (s.encoding == RAW && s.element_type < TYPES) {
        unsigned size = type_size[s.element_type] * s.components;
        REFUSE_IF(s.count > UINT64_MAX / size || s.length != s.count * size, "section-length");
    }
    if (index == 0) {
        REFUSE_IF(!known || s.kind != KIND_OBJECTS || s.count > 4096, "object-count");
        r->object_count = s.count;
    }
    REFUSE_IF(s.owner >= r->object_count, "table-owner");
    REFUSE_IF(s.owner < *owner || (s.owner == *owner && s.kind <= *kind), "table-order");
    *owner = s.owner;
    *kind = s.kind;
    if (s.same != 0) {
        REFUSE_IF(s.same > index, "table-same");
        earlier = lfl_section(r, s.same - 1);
        REFUSE_IF(!may_share(&s, &earlier), "table-same");
    } else {
        REFUSE_IF(s.offset % 64 != 0, "section-alignment");
        REFUSE_IF(s.offset < *end, "section-overlap");
        REFUSE_IF(s.offset > r->file_length || s.length > r->file_length - s.offset, "section-beyond");
        *end = s.offset + s.length;
    }
    REFUSE_IF(s.owner == 0 && !known && s.flags & 1, "section-unknown");
    if (!known)
        return NULL;
    d = demanded(r, s.kind);
    REFUSE_IF(s.element_type != d.element_type || s.components != d.components, "section-size");
    REFUSE_IF(!d.any_count && s.count != d.count, "section-count");
    REFUSE_IF(s.kind == KIND_METADATA && s.length > MAX_METADATA, "section-metadata-length");
    REFUSE_IF((s.flags & 1) != (s.kind != KIND_METADATA && !is_cut_kind(s.kind)), "section-required");
    r->section[s.kind] = s;
    return NULL;
}

static const char *check_table(struct lfl_reader *r)
{
    uint64_t end = end_of_table(r);
    uint32_t i, owner = 0, kind = 0;
    const char *error;

    REFUSE_IF(r->length < end, "table-short");
    REFUSE_IF(crc32(r->bytes + 128, (size_t)end - 128) != u32(r->bytes + 100), "table-crc");
    for (i = 0; i < r->section_count; i++) {
        error = check_section(r, i, &end, &owner, &kind);
        REFUSE_IF(error != NULL, error);
    }
    for (i = KIND_OBJECTS; i < LFL_KINDS; i++)
        REFUSE_IF(is_known_kind(r, i) && demanded(r, i).count != 0 && r->section[i].count == 0, "section-missing");
    if ((error = check_cut_sections(r)) != NULL)
        return error;
    REFUSE_IF(end != r->file_length, "section-end");
    return NULL;
}

/* ---- §10.2 Before the arrays are used --------------------------------------------------------------------------- */

/* §5.1: record 0 repeats the header. */
static int is_the_solid(const struct lfl_reader *r, const unsigned char *p)
{
    uint32_t flags = u32(p + 8);
    unsigned i;
    if (u32(p) != (lfl_is_dexels(r) ? DEXELS : SOLID) || u32(p + 4) != UINT32_MAX || (flags & 1) == 0)
        return 0;
    if (!is_newer(r) && (flags != 1 || !all_zero(p + 22, 2) || !all_zero(p + 76, 4) || !all_zero(p + 112, 16)))
        return 0;
    if (lfl_is_dexels(r) ? p[21] != r->form : p[21] != 0 && !is_newer(r))
        return 0;
    for (i = 0; i < 3; i++) {
        if (u64(p + 32 + 8 * i) != r->origin[i])
            return 0;
    }
    return p[12] == r->depth && p[13] == r->root && p[14] == r->exterior && p[15] == r->proof &&
           p[16] == r->brick_planes && p[17] == r->encoding && p[18] == r->shift && p[19] == 0 && p[20] == 0 &&
           u64(p + 24) == r->displacement && u64(p + 56) == r->edge && all_zero(p + 64, 12) &&
           u64(p + 80) == r->elements && u64(p + 88) == r->bricks && u64(p + 96) == r->entries && u64(p + 104) == 0;
}

static const char *check_objects(const struct lfl_reader *r)
{
    uint32_t i;
    REFUSE_IF(!is_the_solid(r, item(r, KIND_OBJECTS, 0)), "object-mirror");
    for (i = 1; i < r->object_count; i++) {
        const unsigned char *p = item(r, KIND_OBJECTS, i);
        uint32_t parent = u32(p + 4), flags = u32(p + 8);
        REFUSE_IF(u32(p) == 0, "object-type");
        REFUSE_IF(flags >> 1 != 0 && !is_newer(r), "object-flags");
        REFUSE_IF(parent != UINT32_MAX && parent >= i, "object-parent");
        REFUSE_IF(flags & 1, "object-required");
    }
    return NULL;
}

static const char *check_level_table(struct lfl_reader *r)
{
    uint64_t all = r->elements + r->bricks; /* no overflow: there are sections of so many elements */
    unsigned e;

    REFUSE_IF(lfl_level(r, 0).nodes != (r->root == LFL_BRANCH), "level-table-root");
    r->levels = (r->depth + 1) / 2;
    r->start[0] = 0;
    for (e = 0; e < r->levels; e++) {
        uint64_t nodes = lfl_level(r, level_of(r, e)).nodes;
        REFUSE_IF(nodes > all - r->start[e], "level-table-starts");
        r->start[e + 1] = r->start[e] + nodes;
    }
    REFUSE_IF(r->start[r->levels - 1] != r->elements || r->start[r->levels] != all, "level-table-sum");
    return NULL;
}

static const char *check_metadata(const struct lfl_reader *r)
{
    struct lfl_fact fact, previous;
    uint64_t position = 0;
    int first = 1, found;
    while ((found = lfl_metadata(r, &position, &fact)) > 0) {
        REFUSE_IF(!is_utf8(fact.key, fact.key_length), "metadata-text");
        REFUSE_IF(!is_utf8(fact.value, fact.value_length), "metadata-text");
        REFUSE_IF(!first && !ascends(&previous, &fact), "metadata-text");
        previous = fact;
        first = 0;
    }
    REFUSE_IF(found < 0, "metadata-text");
    return NULL;
}

/* ---- Channels --------------------------------------------------------------------------------------------------- */

/* §5.6: how many elements a section of a channel must have. */
static struct demand demanded_of_channel(const struct lfl_channel *c, uint32_t kind)
{
    uint64_t all = c->tree.elements + c->tree.bricks; /* what follows from a sum that overflows fits into no file */
    struct demand d = {TYPE_U64, 1, 0, 0};
    switch (kind) {
    case KIND_VALUES: d.element_type = c->value_type, d.components = c->components, d.count = c->values; break;
    case KIND_VALUE_REL: d.element_type = TYPE_U16, d.count = all; break;
    case KIND_VALUE_BASE: d.count = quotient_up(all, 1024); break;
    default: d = demanded(&c->tree, kind); break;
    }
    return d;
}

static int is_known_of_channel(uint32_t kind)
{
    return (kind >= KIND_METADATA && kind <= KIND_DICTIONARY_SEGMENTS) || kind == KIND_VALUES ||
           kind == KIND_VALUE_REL || kind == KIND_VALUE_BASE;
}

/* §10.2: the record of the object `owner`, a channel. */
static const char *check_record(const struct lfl_reader *r, uint32_t owner, struct lfl_channel *c)
{
    const unsigned char *p = item(r, KIND_OBJECTS, owner), *solid = item(r, KIND_OBJECTS, 0);
    struct lfl_reader *t = &c->tree;
    *t = *r;
    memset(t->section, 0, sizeof t->section);
    c->owner = owner;
    t->depth = p[12];
    t->root = p[13];
    t->exterior = LFL_EMPTY;
    t->brick_planes = 2;
    t->encoding = p[17];
    t->shift = p[18];
    c->value_type = p[19];
    c->components = p[20];
    t->elements = u64(p + 80);
    t->bricks = u64(p + 88);
    t->entries = u64(p + 96);
    c->values = u64(p + 104);

    REFUSE_IF(u32(p + 4) != 0, "channel-record"); /* the parent */
    REFUSE_IF(memcmp(p + 32, solid + 32, 32) != 0, "channel-record"); /* origin and edge */
    REFUSE_IF(p[14] != 0 || p[15] != 0 || u64(p + 24) != 0, "channel-record"); /* exterior, proof, displacement */
    REFUSE_IF(p[16] != 2 || !all_zero(p + 64, 12), "channel-record"); /* planes of a brick, extents */
    if (!is_newer(r))
        REFUSE_IF(!all_zero(p + 21, 3) || !all_zero(p + 76, 4) || !all_zero(p + 112, 16), "channel-record");
    REFUSE_IF(t->root > 3 || t->root == LFL_PARTIAL, "channel-root");
    REFUSE_IF(t->depth < 1 || t->depth > LFL_MAX_DEPTH, "channel-depth");
    REFUSE_IF(c->value_type < TYPE_U8 || c->value_type > TYPE_F32 || c->value_type == TYPE_U64, "channel-type");
    REFUSE_IF(c->components < 1 || c->components > 4, "channel-type");
    REFUSE_IF(check_counts(t) != NULL, "channel-counts");
    return NULL;
}

/* §10.2: the sections of a channel. */
static const char *check_channel_sections(struct lfl_channel *c)
{
    uint32_t i, kind;
    for (i = 0; i < c->tree.section_count; i++) {
        struct lfl_section s = lfl_section(&c->tree, i);
        struct demand d;
        if (s.owner != c->owner)
            continue;
        if (!is_known_of_channel(s.kind)) {
            REFUSE_IF(s.flags & 1, "channel-unknown");
            continue;
        }
        REFUSE_IF(s.encoding != RAW, "channel-unknown");
        d = demanded_of_channel(c, s.kind);
        REFUSE_IF(s.element_type != d.element_type || s.components != d.components, "channel-section");
        REFUSE_IF(!d.any_count && s.count != d.count, "channel-section");
        REFUSE_IF(s.kind == KIND_METADATA && s.length > MAX_CHANNEL_METADATA, "channel-section");
        REFUSE_IF((s.flags & 1) != (s.kind != KIND_METADATA), "channel-section");
        c->tree.section[s.kind] = s;
    }
    for (kind = KIND_METADATA; kind < LFL_KINDS; kind++) {
        if (is_known_of_channel(kind))
            REFUSE_IF(demanded_of_channel(c, kind).count != 0 && c->tree.section[kind].count == 0, "channel-section");
    }
    return NULL;
}

static const char *check_channel(const struct lfl_reader *r, uint32_t owner, struct lfl_channel *c)
{
    const char *error;
    if ((error = check_record(r, owner, c)) != NULL || (error = check_channel_sections(c)) != NULL ||
        (error = check_level_table(&c->tree)) != NULL)
        return error;
    return check_metadata(&c->tree);
}

/* The name of a channel as the value of a fact, empty without one. */
static struct lfl_fact name_of(const struct lfl_channel *c)
{
    struct lfl_fact fact, none = {NULL, NULL, 0, 0};
    uint64_t position = 0;
    while (lfl_metadata(&c->tree, &position, &fact) > 0) {
        if (fact.key_length == 4 && memcmp(fact.key, "name", 4) == 0)
            return fact;
    }
    return none;
}

/* Files of 0.1 have no channels: objects of type 2 are unknown ones there. */
static int is_channel(const struct lfl_reader *r, uint32_t owner)
{
    return r->minor >= 2 && u32(item(r, KIND_OBJECTS, owner)) == CHANNEL;
}

int lfl_channel(const struct lfl_reader *r, uint32_t *owner, struct lfl_channel *c)
{
    while (*owner < r->object_count && !is_channel(r, *owner))
        ++*owner;
    return *owner < r->object_count && check_channel(r, (*owner)++, c) == NULL;
}

static const char *check_channels(const struct lfl_reader *r)
{
    struct lfl_channel c;
    struct lfl_fact name, previous = {NULL, NULL, 0, 0};
    uint32_t owner, count = 0;
    for (owner = 1; owner < r->object_count; owner++) {
        const char *error;
        if (!is_channel(r, owner))
            continue;
        REFUSE_IF(++count > MAX_CHANNELS, "channel-count");
        error = check_channel(r, owner, &c);
        REFUSE_IF(error != NULL, error);
        name = name_of(&c);
        name.key = name.value; /* names are ordered as keys are */
        name.key_length = name.value_length;
        REFUSE_IF(count > 1 && !ascends(&previous, &name), "channel-name");
        previous = name;
    }
    return NULL;
}

static const char *check_metadata_and_channels(const struct lfl_reader *r)
{
    const char *error = check_metadata(r);
    return error != NULL || lfl_is_dexels(r) ? error : check_channels(r);
}

static const char *check_all_before_use(const void *bytes, size_t length, struct lfl_reader *r, int probing)
{
    const char *error;
    memset(r, 0, sizeof *r);
    r->bytes = bytes;
    r->length = length;
    error = check_header(r);
    if (error == NULL && !probing && length != r->file_length)
        error = "file-length"; /* all bytes are at hand, so it is looked at before the table */
    if (error == NULL)
        error = check_table(r);
    if (error == NULL && !probing)
        error = check_objects(r);
    if (error == NULL && !probing)
        error = lfl_is_dexels(r) ? check_windows(r) : check_level_table(r);
    return error;
}

int lfl_probe(const void *bytes, size_t length, struct lfl_reader *r, const char **error)
{
    return (*error = check_all_before_use(bytes, length, r, 1)) == NULL;
}

int lfl_open(const void *bytes, size_t length, struct lfl_reader *r, const char **error)
{
    return (*error = check_all_before_use(bytes, length, r, 0)) == NULL;
}

int lfl_check_metadata(const struct lfl_reader *r, const char **error)
{
    return (*error = check_metadata_and_channels(r)) == NULL;
}

/* ---- §10.3 Verification ----------------------------------------------------------------------------------------- */

static const char *verify_sections(const struct lfl_reader *r)
{
    size_t end = (size_t)end_of_table(r);
    uint32_t i;
    for (i = 0; i < r->section_count; i++) {
        struct lfl_section s = lfl_section(r, i);
        size_t offset = (size_t)s.offset, length = (size_t)s.length;
        if (s.same != 0)
            continue; /* the bytes and their CRC32 are those of another entry */
        REFUSE_IF(!all_zero(r->bytes + end, offset - end), "padding");
        REFUSE_IF(crc32(r->bytes + offset, length) != s.crc, "section-crc");
        end = offset + length;
    }
    return NULL;
}

static const char *verify_links(const struct lfl_reader *r)
{
    uint64_t n, next = r->root == LFL_BRANCH;
    unsigned e;
    for (e = 0; e < r->levels; e++) {
        REFUSE_IF(r->start[e + 1] != next, "element-count");
        for (n = r->start[e]; e + 1 < r->levels && n < r->start[e + 1]; n++) {
            REFUSE_IF(first_child(r, n) != next, "element-link");
            REFUSE_IF(n % 1024 == 0 && u16(item(r, KIND_REL, n)) != 0, "element-link");
            next += popcount(branch_cells(element(r, n)));
        }
    }
    return NULL;
}

/* §5.3: adds what an element or brick of element level e holds: octants on one octree level, cells on the next. */
static void count_cells(const struct lfl_reader *r, unsigned e, struct words w, struct lfl_level *counts)
{
    struct lfl_level *octants = &counts[2 * e + 1 - parity(r)], *cells = octants + 1;
    unsigned k;
    for (k = 0; k < 8; k++) {
        uint64_t octant = UINT64_C(0xFF) << 8 * k;
        if (is_uniform(w, octant)) {
            octants->full += (full_cells(w) & octant) != 0;
            octants->partial += (partial_cells(w) & octant) != 0;
        } else {
            octants->nodes++;
            cells->nodes += popcount(branch_cells(w) & octant);
            cells->full += popcount(full_cells(w) & octant);
            cells->partial += popcount(partial_cells(w) & octant);
        }
    }
}

static const char *verify_elements(const struct lfl_reader *r, struct lfl_level *counts)
{
    unsigned e;
    uint64_t n;
    for (e = 0; e + 1 < r->levels; e++) {
        uint64_t existing = existing_cells(r, e);
        for (n = r->start[e]; n < r->start[e + 1]; n++) {
            struct words w = element(r, n);
            REFUSE_IF((w.lower | w.upper) & ~existing, "element-padding");
            REFUSE_IF(is_uniform(w, existing), "element-uniform");
            count_cells(r, e, w, counts);
        }
    }
    return NULL;
}

static int compare_words(const void *a, const void *b)
{
    const struct words *v = a, *w = b;
    if (v->lower != w->lower)
        return v->lower < w->lower ? -1 : 1;
    return v->upper < w->upper ? -1 : v->upper > w->upper;
}

/* §5.5: one segment, with room for the number of uses and for copies of its entries. */
static const char *verify_segment(const struct lfl_reader *r, uint64_t s, uint64_t begin, uint64_t end, uint32_t *uses,
                                  struct words *values)
{
    uint64_t first = s << r->shift, b, i, size = end - begin;
    uint64_t bricks = r->bricks - first;
    if (bricks > UINT64_C(1) << r->shift)
        bricks = UINT64_C(1) << r->shift;

    for (i = 0; i < size; i++) {
        uses[i] = 0;
        values[i] = brick_entry(r, KIND_DICTIONARY_ENTRIES, begin + i);
    }
    for (b = first; b < first + bricks; b++) {
        unsigned index = u16(item(r, KIND_BRICK_INDICES, b));
        REFUSE_IF(index >= size, "dictionary-index");
        if (uses[index] < UINT32_MAX)
            uses[index]++;
    }
    for (i = 0; i < size; i++)
        REFUSE_IF(uses[i] == 0, "dictionary-unused");
    for (i = 1; i < size; i++) {
        REFUSE_IF(uses[i - 1] < uses[i], "dictionary-order");
        REFUSE_IF(uses[i - 1] == uses[i] && compare_words(&values[i - 1], &values[i]) >= 0, "dictionary-order");
    }
    if (size > 0)
        qsort(values, (size_t)size, sizeof *values, compare_words);
    for (i = 1; i < size; i++)
        REFUSE_IF(compare_words(&values[i - 1], &values[i]) == 0, "dictionary-duplicate");
    return NULL;
}

static const char *verify_dictionary(const struct lfl_reader *r)
{
    uint64_t s, segments = r->section[KIND_DICTIONARY_SEGMENTS].count, previous_end = 0;
    size_t room = (size_t)(r->entries < MAX_SEGMENT_ENTRIES ? r->entries : MAX_SEGMENT_ENTRIES);
    uint32_t *uses;
    struct words *values;
    const char *error = NULL;
    if (r->encoding == RAW)
        return NULL;

    uses = malloc(room * sizeof *uses);
    values = malloc(room * sizeof *values);
    if (uses == NULL || values == NULL)
        error = lfl_out_of_memory;
    for (s = 0; s < segments && error == NULL; s++) {
        uint64_t begin = u64(item(r, KIND_DICTIONARY_SEGMENTS, s)), end = r->entries;
        if (s + 1 < segments)
            end = u64(item(r, KIND_DICTIONARY_SEGMENTS, s + 1));
        if (begin != previous_end || end < begin || end > r->entries || end - begin > MAX_SEGMENT_ENTRIES)
            error = "dictionary-range";
        else
            error = verify_segment(r, s, begin, end, uses, values);
        previous_end = end;
    }
    free(values);
    free(uses);
    return error;
}

static const char *verify_bricks(const struct lfl_reader *r, struct lfl_level *counts)
{
    unsigned e = r->levels - 1;
    uint64_t existing = existing_cells(r, e), b;
    for (b = 0; b < r->bricks; b++) {
        struct words w;
        REFUSE_IF(!brick(r, b, &w), "dictionary-index"); /* never: the segments have been verified */
        REFUSE_IF((w.lower | w.upper) & ~existing, "brick-padding");
        REFUSE_IF(is_uniform(w, existing), "brick-uniform");
        REFUSE_IF(branch_cells(w) != 0, "brick-branch");
        count_cells(r, e, w, counts);
    }
    return NULL;
}

/* What follows from all elements and bricks: the number of planes. */
static const char *verify_planes(const struct lfl_reader *r, const struct lfl_level *counts)
{
    int any_partial = 0;
    unsigned l;
    for (l = 0; l <= r->depth; l++)
        any_partial |= counts[l].partial != 0;
    REFUSE_IF(r->brick_planes == 1 && any_partial, "planes-missing");
    REFUSE_IF(r->brick_planes == 2 && !any_partial, "planes-needless");
    return NULL;
}

/* And the level table. */
static const char *verify_counts(const struct lfl_reader *r, const struct lfl_level *counts)
{
    unsigned l;
    for (l = 0; l <= r->depth; l++) {
        struct lfl_level given = lfl_level(r, l);
        REFUSE_IF(given.nodes != counts[l].nodes, "level-table-counts");
        REFUSE_IF(given.full != counts[l].full, "level-table-counts");
        REFUSE_IF(given.partial != counts[l].partial, "level-table-counts");
    }
    return NULL;
}

/* §2.7: a cell of a channel has a value if its upper bit is set, and starts one if the lower is, too. */
static uint64_t valued_cells(struct words w) { return w.upper; }
static uint64_t starting_cells(struct words w) { return full_cells(w); }

/* §5.6: element or brick n of a channel. Returns 0 if it cannot be read (§6). */
static int entry_of(const struct lfl_channel *c, uint64_t n, struct words *w)
{
    if (n >= c->tree.elements)
        return brick(&c->tree, n - c->tree.elements, w);
    *w = element(&c->tree, n);
    return 1;
}

/* §2.7: how many cells of the elements and bricks before n start a value. */
static uint64_t rank_of(const struct lfl_channel *c, uint64_t n)
{
    return u64(item(&c->tree, KIND_VALUE_BASE, n / 1024)) + u16(item(&c->tree, KIND_VALUE_REL, n));
}

/* §5.3, of a channel. In an octant of one value the first cell alone may start it, and the octant counts once. */
static void count_values(const struct lfl_channel *c, unsigned e, struct words w, struct lfl_level *counts)
{
    struct lfl_level *octants = &counts[2 * e + 1 - parity(&c->tree)], *cells = octants + 1;
    unsigned k, existing = e == 0 && parity(&c->tree) ? 1 : 8;
    for (k = 0; k < existing; k++) {
        unsigned lower = (unsigned)(w.lower >> 8 * k & 0xFF), upper = (unsigned)(w.upper >> 8 * k & 0xFF);
        if (existing == 8 && lower == 0 && upper == 0)
            continue;
        if (existing == 8 && lower <= 1 && upper == 0xFF) {
            octants->full++;
            octants->partial += lower;
        } else {
            octants->nodes++;
            cells->nodes += popcount(lower & ~upper);
            cells->full += popcount(upper);
            cells->partial += popcount(lower & upper);
        }
    }
}

static const char *verify_entries(const struct lfl_channel *c, struct lfl_level *counts)
{
    const struct lfl_reader *t = &c->tree;
    uint64_t n, all = t->elements + t->bricks, values = 0;
    unsigned e = 0;
    for (n = 0; n < all; n++) {
        struct words w;
        uint64_t existing, valued, starting;
        while (n >= t->start[e + 1])
            e++;
        existing = existing_cells(t, e);
        REFUSE_IF(!entry_of(c, n, &w), "dictionary-index"); /* never: the segments have been verified */
        valued = valued_cells(w);
        starting = starting_cells(w);
        REFUSE_IF((w.lower | w.upper) & ~existing, n < t->elements ? "element-padding" : "brick-padding");
        REFUSE_IF((w.lower | w.upper) == 0, "channel-uniform");
        REFUSE_IF(valued == existing && w.lower <= 1, "channel-uniform");
        REFUSE_IF(n >= t->elements && branch_cells(w) != 0, "brick-branch");
        REFUSE_IF(rank_of(c, n) != values, "channel-rank");
        REFUSE_IF(n % 1024 == 0 && u16(item(t, KIND_VALUE_REL, n)) != 0, "channel-rank");
        REFUSE_IF(values == 0 && (valued & -valued & ~starting) != 0, "channel-start");
        values += popcount(starting);
        count_values(c, e, w, counts);
    }
    if (t->root == LFL_FULL)
        values = 1;
    REFUSE_IF(c->values != values, "channel-values");
    return NULL;
}

static const char *verify_values(const struct lfl_channel *c)
{
    unsigned size = type_size[c->value_type], k;
    uint64_t i;
    for (i = 0; i < c->values; i++) {
        const unsigned char *p = item(&c->tree, KIND_VALUES, i);
        for (k = 0; c->value_type == TYPE_F32 && k < c->components; k++) {
            uint32_t bits = u32(p + 4 * k);
            REFUSE_IF((bits & 0x7F800000) == 0x7F800000 || bits == 0x80000000, "channel-value");
        }
        REFUSE_IF(i > 0 && memcmp(p, p - size * c->components, size * c->components) == 0, "channel-value");
    }
    return NULL;
}

static const char *verify_channels(const struct lfl_reader *r)
{
    struct lfl_channel c;
    uint32_t owner = 1;
    while (lfl_channel(r, &owner, &c)) {
        struct lfl_level counts[LFL_MAX_DEPTH + 1];
        const char *error;
        unsigned l;
        memset(counts, 0, sizeof counts);
        counts[0].nodes = c.tree.root == LFL_BRANCH && parity(&c.tree) == 0;
        counts[0].full = counts[0].partial = c.tree.root == LFL_FULL;
        if ((error = verify_links(&c.tree)) != NULL || (error = verify_dictionary(&c.tree)) != NULL ||
            (error = verify_entries(&c, counts)) != NULL || (error = verify_values(&c)) != NULL)
            return error;
        for (l = 0; l <= c.tree.depth; l++) {
            struct lfl_level given = lfl_level(&c.tree, l);
            REFUSE_IF(given.nodes != counts[l].nodes, "level-table-counts");
            REFUSE_IF(given.full != counts[l].full, "level-table-counts");
            REFUSE_IF(given.partial != counts[l].partial, "level-table-counts");
        }
    }
    return NULL;
}

static const char *verify(const struct lfl_reader *r)
{
    struct lfl_level counts[LFL_MAX_DEPTH + 1];
    const char *error;
    if (lfl_is_dexels(r)) {
        if ((error = verify_sections(r)) != NULL || (error = check_metadata(r)) != NULL)
            return error;
        return verify_dexels(r);
    }
    memset(counts, 0, sizeof counts);
    /* The universe itself. Of odd depth its node is counted as octant 0 of the root element. */
    counts[0].nodes = r->root == LFL_BRANCH && parity(r) == 0;
    counts[0].full = r->root == LFL_FULL;
    counts[0].partial = r->root == LFL_PARTIAL;

    if ((error = verify_sections(r)) != NULL || (error = check_metadata_and_channels(r)) != NULL ||
        (error = verify_links(r)) != NULL || (error = verify_elements(r, counts)) != NULL ||
        (error = verify_dictionary(r)) != NULL || (error = verify_bricks(r, counts)) != NULL ||
        (error = verify_planes(r, counts)) != NULL || (error = verify_cuts(r)) != NULL ||
        (error = verify_counts(r, counts)) != NULL)
        return error;
    return verify_channels(r);
}

int lfl_verify(const struct lfl_reader *r, const char **error) { return (*error = verify(r)) == NULL; }

/* ---- §6 Finding a cell ------------------------------------------------------------------------------------------ */

enum lfl_tag lfl_cell_tag(const struct lfl_reader *r, uint32_t x, uint32_t y, uint32_t z)
{
    struct words w;
    enum lfl_tag tag;
    uint64_t n = 0;
    unsigned e, c;
    if (r->root != LFL_BRANCH)
        return (enum lfl_tag)r->root;
    for (e = 0; e + 1 < r->levels; e++) {
        unsigned s = 2 * (r->levels - 1 - e);
        c = morton(x >> s, y >> s, z >> s);
        w = element(r, n);
        tag = tag_of(w, c);
        if (tag != LFL_BRANCH)
            return tag;
        n = first_child(r, n) + popcount(branch_cells(w) & ((UINT64_C(1) << c) - 1));
        if (n < r->start[e + 1] || n >= r->start[e + 2])
            return LFL_DAMAGED;
    }
    if (!brick(r, n - r->elements, &w))
        return LFL_DAMAGED;
    tag = tag_of(w, morton(x, y, z));
    return tag == LFL_BRANCH ? LFL_DAMAGED : tag;
}

/* ---- §7 Questions and answers ----------------------------------------------------------------------------------- */

/* sum += |d| · factor, for a factor less than 2^32. */
static void add_multiple(struct natural *sum, struct dyadic d, uint64_t factor)
{
    unsigned shift = (unsigned)(d.exponent - UNIT_EXPONENT);
    natural_add(sum, (d.mantissa & 0xFFFFFFFF) * factor, shift);
    natural_add(sum, (d.mantissa >> 32) * factor, shift + 32);
}

/*
 * Compares v with the lattice plane i of an axis, which is the real number origin + i · edge / 2^depth: the result is
 * negative, zero or positive. The summands are moved to the sides on which they are positive:
 *
 *     v⁺ + origin⁻   ?   v⁻ + origin⁺ + i · edge / 2^depth
 *
 * All are natural multiples of 2^-1074 (edge / 2^depth, of 53 bits, is at least 2^-276), so nothing is ever rounded.
 */
static int compare_with_plane(const struct lfl_reader *r, unsigned axis, struct dyadic v, uint64_t i)
{
    struct natural left = {{0}}, right = {{0}};
    struct dyadic origin = take_apart(r->origin[axis]), h = take_apart(r->edge);
    h.exponent -= (int)r->depth;
    add_multiple(v.negative ? &right : &left, v, 1);
    add_multiple(origin.negative ? &left : &right, origin, 1);
    add_multiple(&right, h, i);
    return natural_compare(&left, &right);
}

int lfl_cell(const struct lfl_reader *r, unsigned axis, double coordinate, uint32_t *cell)
{
    uint32_t low = 0, high = (uint32_t)1 << r->depth;
    uint64_t bits;
    struct dyadic v;
    int last;
    memcpy(&bits, &coordinate, sizeof bits);
    v = take_apart(bits);
    if (!v.finite || compare_with_plane(r, axis, v, low) < 0)
        return 0;
    last = compare_with_plane(r, axis, v, high);
    if (last > 0)
        return 0;
    if (last == 0) /* the universe's upper face belongs to the last cell */
        low = high - 1;
    while (high - low > 1) { /* plane low ≤ v < plane high */
        uint32_t middle = low + (high - low) / 2;
        if (compare_with_plane(r, axis, v, middle) >= 0)
            low = middle;
        else
            high = middle;
    }
    *cell = low;
    return 1;
}

enum lfl_answer lfl_contains(const struct lfl_reader *r, double x, double y, double z)
{
    uint32_t i, j, k;
    if (!lfl_cell(r, 0, x, &i) || !lfl_cell(r, 1, y, &j) || !lfl_cell(r, 2, z, &k))
        return LFL_UNDECIDED;
    switch (lfl_cell_tag(r, i, j, k)) {
    case LFL_EMPTY: return LFL_OUTSIDE;
    case LFL_FULL: return LFL_INSIDE;
    default: return LFL_UNDECIDED; /* PARTIAL, or damaged (§10.4) */
    }
}

/* §7.3: the place of the value of a finest cell. Returns 0 if it has none, or the bytes are damaged. */
static int find_value(const struct lfl_channel *c, uint32_t x, uint32_t y, uint32_t z, uint64_t *place)
{
    const struct lfl_reader *t = &c->tree;
    uint64_t n = 0;
    unsigned e;
    *place = 0;
    if (t->root != LFL_BRANCH)
        return t->root == LFL_FULL;
    for (e = 0; e < t->levels; e++) {
        unsigned s = 2 * (t->levels - 1 - e), cell = morton(x >> s, y >> s, z >> s);
        struct words w;
        uint64_t up_to_cell = (UINT64_C(2) << cell) - 1; /* all bits for cell 63 */
        if (!entry_of(c, n, &w))
            return 0;
        if (valued_cells(w) >> cell & 1) {
            *place = rank_of(c, n) + popcount(starting_cells(w) & up_to_cell) - 1;
            return 1;
        }
        if (tag_of(w, cell) != LFL_BRANCH || e + 1 == t->levels)
            return 0;
        n = first_child(t, n) + popcount(branch_cells(w) & up_to_cell) - 1;
        if (n < t->start[e + 1] || n >= t->start[e + 2])
            return 0;
    }
    return 0;
}

int lfl_value(const struct lfl_channel *c, double x, double y, double z, double value[4])
{
    const struct lfl_reader *t = &c->tree;
    uint32_t i, j, k;
    uint64_t place;
    unsigned m;
    if (!lfl_cell(t, 0, x, &i) || !lfl_cell(t, 1, y, &j) || !lfl_cell(t, 2, z, &k))
        return 0;
    if (!find_value(c, i, j, k, &place) || place >= c->values)
        return 0;
    for (m = 0; m < c->components; m++) {
        const unsigned char *p = item(t, KIND_VALUES, place) + type_size[c->value_type] * m;
        if (c->value_type == TYPE_F32) {
            uint32_t bits = u32(p);
            float number;
            memcpy(&number, &bits, sizeof number);
            value[m] = number;
        } else {
            value[m] = (double)little_endian(p, type_size[c->value_type]);
        }
    }
    return 1;
}

/* sum + count · 8^levels, or 2^64 - 1 if that is greater. */
static uint64_t saturating_sum(uint64_t sum, uint64_t count, unsigned levels)
{
    uint64_t cells = UINT64_C(1) << 3 * levels;
    return count > (UINT64_MAX - sum) / cells ? UINT64_MAX : sum + count * cells;
}

void lfl_volume_cells(const struct lfl_reader *r, uint64_t *lower, uint64_t *upper)
{
    unsigned l;
    *lower = *upper = 0;
    for (l = 0; l <= r->depth; l++) {
        struct lfl_level level = lfl_level(r, l);
        *lower = saturating_sum(*lower, level.full, r->depth - l);
        *upper = saturating_sum(*upper, level.full, r->depth - l);
        *upper = saturating_sum(*upper, level.partial, r->depth - l);
    }
}

/* cells · h³ with h = edge / 2^depth: exactly, as an integer of at most 64 + 3 · 53 bits, and then rounded once. */
static double cubic_units(const struct lfl_reader *r, uint64_t cells, int up)
{
    struct natural volume = {{0}};
    struct dyadic edge = take_apart(r->edge);
    int i;
    natural_add(&volume, cells, 0);
    for (i = 0; i < 3; i++)
        volume = natural_product(&volume, edge.mantissa);
    return natural_round(&volume, 3 * (edge.exponent - (int)r->depth), up);
}

void lfl_volume(const struct lfl_reader *r, double *lower, double *upper)
{
    uint64_t surely, possibly;
    lfl_volume_cells(r, &surely, &possibly);
    *lower = cubic_units(r, surely, 0);
    *upper = cubic_units(r, possibly, 1);
}

/* ---- The program ------------------------------------------------------------------------------------------------ */

#ifndef LEAFLESS_READER_NO_MAIN

#include <inttypes.h>
#include <stdio.h>

enum { OK = 0, REFUSED = 1, FAILED = 2 };
enum checks { PROBE, PLAIN, METADATA, ALL };
enum question { FACTS, POINTS, CUT_POINTS, VALUES, VOLUME, CELLS };

/* Control characters could do things to a terminal, and are printed as \xHH. */
static void print_text(const unsigned char *p, size_t length)
{
    size_t i;
    for (i = 0; i < length; i++) {
        int control = p[i] < 0x20 || p[i] == 0x7F;
        int second = i > 0 && p[i - 1] == 0xC2 && p[i] < 0xA0; /* U+0080 to U+009F */
        int first = p[i] == 0xC2 && i + 1 < length && p[i + 1] < 0xA0;
        if (control || first || second)
            printf("\\x%02X", p[i]);
        else
            putchar(p[i]);
    }
}

static void print_sections(const struct lfl_reader *r)
{
    uint32_t i;
    printf("objects: %" PRIu64 "\n", r->object_count);
    printf("sections:");
    for (i = 0; i < r->section_count; i++)
        printf(" %" PRIu32, lfl_section(r, i).kind);
    printf("\nowners:");
    for (i = 0; i < r->section_count; i++)
        printf(" %" PRIu32, lfl_section(r, i).owner);
    putchar('\n');
}

static void print_metadata(const struct lfl_reader *r)
{
    struct lfl_fact fact;
    uint64_t position = 0;
    while (lfl_metadata(r, &position, &fact) > 0) {
        printf("metadata: ");
        print_text(fact.key, fact.key_length);
        putchar('\t');
        print_text(fact.value, fact.value_length);
        putchar('\n');
    }
}

static void print_intervals(const struct lfl_reader *r, unsigned axis, const uint32_t ray[2])
{
    struct lfl_interval one;
    uint64_t i, end;
    for (lfl_ray(r, axis, ray, &i, &end); i < end; i++) {
        lfl_interval(r, axis, i, &one);
        printf("interval: %u %" PRIu32 " %" PRIu32 " %a %a", axis, ray[0], ray[1], one.end[0], one.end[1]);
        if (normal_kind(r) != 0)
            printf(" %" PRIu32 " %" PRIu32, one.normal[0], one.normal[1]);
        if (has_surfaces(r))
            printf(" %" PRIu32 " %" PRIu32, one.surface[0], one.surface[1]);
        if (has_materials(r))
            printf(" %" PRIu32, one.material);
        putchar('\n');
    }
}

/* The part of the facts that only tri-dexel models have. Intervals are printed if all of them are verified. */
static void print_dexels(const struct lfl_reader *r, enum checks checks)
{
    unsigned axis;
    printf("ends: %s\nnormals: %u\n", has_doubles(r) ? "double" : "fixed", 16 * normal_kind(r));
    printf("surfaces: %s\nmaterials: %s\n", has_surfaces(r) ? "yes" : "no", has_materials(r) ? "yes" : "no");
    print_sections(r);
    for (axis = 0; axis < 3 && checks != PROBE; axis++) {
        const struct lfl_window *w = &r->window[axis];
        if (has_direction(r, axis))
            printf("direction: %u %" PRIu32 " %" PRIu32 " %" PRIu32 " %" PRIu32 " %" PRIu64 "\n", axis, w->first[0],
                   w->first[1], w->size[0], w->size[1], intervals(r, axis));
    }
    if (checks >= METADATA)
        print_metadata(r);
    for (axis = 0; axis < 3 && checks == ALL; axis++) {
        const struct lfl_window *w = &r->window[axis];
        uint32_t ray[2], u, v;
        for (v = 0; v < w->size[1]; v++) {
            for (u = 0; u < w->size[0]; u++) {
                ray[0] = w->first[0] + u;
                ray[1] = w->first[1] + v;
                print_intervals(r, axis, ray);
            }
        }
    }
}

static void print_facts(const struct lfl_reader *r, enum checks checks)
{
    static const char *const tags[] = {"EMPTY", "BRANCH", "PARTIAL", "FULL"};
    uint64_t lower, upper;
    uint32_t i;

    printf("length: %" PRIu64 "\n", r->file_length);
    printf("version: %u.%u\n", r->major, r->minor);
    printf("origin: %a %a %a\n", from_bits(r->origin[0]), from_bits(r->origin[1]), from_bits(r->origin[2]));
    printf("edge: %a\n", from_bits(r->edge));
    printf("depth: %u\n", r->depth);
    if (lfl_is_dexels(r)) {
        print_dexels(r, checks);
        return;
    }
    printf("root: %s\n", tags[r->root]);
    printf("exterior: %s\n", tags[r->exterior]);
    printf("proof: %u\n", r->proof);
    printf("displacement: %a\n", from_bits(r->displacement));
    printf("planes: %u\n", r->brick_planes);
    printf("encoding: %s\n", r->encoding == RAW ? "raw" : "dictionary");
    printf("shift: %u\n", r->shift);
    printf("elements: %" PRIu64 "\n", r->elements);
    printf("bricks: %" PRIu64 "\n", r->bricks);
    printf("entries: %" PRIu64 "\n", r->entries);
    print_sections(r);
    if (checks == PROBE)
        return;
    for (i = 0; i <= r->depth; i++) {
        struct lfl_level level = lfl_level(r, i);
        printf("level: %" PRIu32 " %" PRIu64 " %" PRIu64 " %" PRIu64 "\n", i, level.nodes, level.full, level.partial);
    }
    lfl_volume_cells(r, &lower, &upper);
    printf("cells: %" PRIu64 " %" PRIu64 "\n", lower, upper);
    if (checks >= METADATA)
        print_metadata(r);
}

static void print_channels(const struct lfl_reader *r)
{
    static const char *const tags[] = {"EMPTY", "BRANCH", "PARTIAL", "FULL"};
    static const char *const types[] = {"", "u8", "u16", "u32", "", "f32"};
    struct lfl_channel c;
    struct lfl_fact fact;
    uint64_t position;
    uint32_t owner, i;
    for (owner = 1; lfl_channel(r, &owner, &c);) {
        const struct lfl_reader *t = &c.tree;
        printf("channel: %" PRIu32 " %u %s %s %u %" PRIu64, c.owner, t->depth, tags[t->root], types[c.value_type],
               c.components, c.values);
        printf(" %s %u %" PRIu64 " %" PRIu64 " %" PRIu64 "\n", t->encoding == RAW ? "raw" : "dictionary", t->shift,
               t->elements, t->bricks, t->entries);
    }
    for (owner = 1; lfl_channel(r, &owner, &c);) {
        for (i = 0; i <= c.tree.depth; i++) {
            struct lfl_level level = lfl_level(&c.tree, i);
            printf("channel-level: %" PRIu32 " %" PRIu32 " %" PRIu64 " %" PRIu64 " %" PRIu64 "\n", c.owner, i,
                   level.nodes, level.full, level.partial);
        }
    }
    for (owner = 1; lfl_channel(r, &owner, &c);) {
        for (position = 0; lfl_metadata(&c.tree, &position, &fact) > 0;) {
            printf("channel-metadata: %" PRIu32 " ", c.owner);
            print_text(fact.key, fact.key_length);
            putchar('\t');
            print_text(fact.value, fact.value_length);
            putchar('\n');
        }
    }
}

/* Of verified files. */
static void print_cuts(const struct lfl_reader *r)
{
    static const char *const kinds[] = {"plane", "quadric", "powers", "torus", "slab"};
    uint64_t i, cuts = count_of(r, KIND_CUT_HEADS), nothing = 0, splits = 0;
    unsigned k, m;
    if (cuts == 0)
        return;
    for (i = 0; i < cuts; i++) {
        nothing += cut_head(r, i) == HEAD_NOTHING;
        splits += cut_head(r, i) == HEAD_SPLIT;
    }
    printf("cuts: %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 "\n",
           cuts - nothing - splits, nothing, splits, surface_count(r), count_of(r, KIND_PLACEMENTS),
           count_of(r, KIND_ORIGINS), count_of(r, KIND_CELL_SLABS), count_of(r, KIND_CELL_SLAB_GROUPS));
    for (i = 0; i < count_of(r, KIND_SURFACES); i++) {
        struct surface s;
        if (read_surface(r, i, &s) != NULL)
            continue;
        printf("surface: %" PRIu64 " %s %" PRIu32, i, kinds[s.kind], s.placement);
        for (k = 0; k < number_count[s.kind]; k++) {
            printf(s.terms[k] == 0 ? " 0" : " ");
            for (m = 0; m < s.terms[k]; m++)
                printf("%s%a", m == 0 ? "" : ",", from_bits(double_bits(r, s.begin[k] + m)));
        }
        if (s.kind == SLAB)
            printf(" %" PRIu32 " %" PRIu64, s.origin, s.origin == 0 ? 0 : s.number);
        putchar('\n');
    }
    for (i = 0; i < count_of(r, KIND_PLACEMENTS); i++) {
        printf("placement: %" PRIu64 " %" PRIu64, i, map_outer(r, i));
        for (k = 0; k < 12; k++)
            printf(" %a", map_entry(r, i, k / 4, k % 4));
        putchar('\n');
    }
    for (i = 0; i < count_of(r, KIND_ORIGINS); i++) {
        const unsigned char *p = item(r, KIND_ORIGINS, i);
        printf("slab-origin: %" PRIu64 " %016" PRIx64 " %016" PRIx64 "\n", i, u64(p), u64(p + 8));
    }
    for (i = 0; i < count_of(r, KIND_CELL_SLABS); i++) {
        struct cell_slab s;
        if (read_cell_slab(r, i, &s) != NULL)
            continue;
        printf("cell-slab: %" PRIu64 " %u", count_of(r, KIND_SURFACES) + i, s.level);
        printf(" %" PRIu32 " %" PRIu32 " %" PRIu32 " %u", s.at[0], s.at[1], s.at[2], s.index);
        for (k = 0; k < 5; k++)
            printf(" %a", s.number[k]);
        putchar('\n');
    }
    for (i = 0; i < count_of(r, KIND_CELL_SLAB_GROUPS); i++) {
        const unsigned char *p = item(r, KIND_CELL_SLAB_GROUPS, i);
        printf("cell-slab-group: %" PRIu64 " %016" PRIx64 " %016" PRIx64, i, u64(p), u64(p + 8));
        printf(" %" PRIu64 "\n", u64(p + 16));
    }
    if (count_of(r, KIND_MOMENTS) != 0) {
        printf("moments:");
        for (k = 0; k < MOMENTS_NUMBERS; k++)
            printf(" %a", from_bits(moments_bits(r, k)));
        putchar('\n');
    }
}

static void print_volume(const struct lfl_reader *r)
{
    double lower, upper;
    lfl_volume(r, &lower, &upper);
    printf("volume: %a %a\n", lower, upper);
}

/* The values of all channels at a point, each in a line of its own with the number of the channel's object. */
static void print_values(const struct lfl_reader *r, const double point[3])
{
    struct lfl_channel c;
    uint32_t owner = 1;
    while (lfl_channel(r, &owner, &c)) {
        double value[4];
        unsigned m, count = lfl_value(&c, point[0], point[1], point[2], value) ? c.components : 0;
        printf("%" PRIu32 "%s", c.owner, count == 0 ? " none" : "");
        for (m = 0; m < count; m++)
            printf(" %a", value[m]);
        putchar('\n');
    }
}

/* For each direction whether the centre of a finest cell lies inside. */
static void print_cell(const struct lfl_reader *r, const double indices[3])
{
    static const char *const answers[] = {"none", "out", "in"};
    uint32_t cell[3];
    unsigned axis;
    for (axis = 0; axis < 3; axis++)
        cell[axis] = indices[axis] >= 0 && indices[axis] < 1 << 20 ? (uint32_t)indices[axis] : UINT32_MAX;
    for (axis = 0; axis < 3; axis++)
        printf("%s%c", answers[lfl_holds(r, axis, cell) + 1], axis < 2 ? ' ' : '\n');
}

static int answer_points(const struct lfl_reader *r, enum question question)
{
    static const char *const answers[] = {"outside", "inside", "undecided"};
    char line[1024];
    while (fgets(line, sizeof line, stdin) != NULL) {
        double v[3];
        char *p = line, *end;
        int i;
        for (i = 0; i < 3; i++, p = end) {
            v[i] = strtod(p, &end);
            if (end == p)
                break;
        }
        if (i < 3 || p[strspn(p, " \t\r\n")] != '\0' || (strchr(p, '\n') == NULL && !feof(stdin))) {
            fprintf(stderr, "not a point: %s", line);
            return FAILED;
        }
        if (question == CELLS)
            print_cell(r, v);
        else if (question == VALUES)
            print_values(r, v);
        else if (question == CUT_POINTS)
            puts(answers[lfl_contains_with_cuts(r, v[0], v[1], v[2])]);
        else
            puts(answers[lfl_contains(r, v[0], v[1], v[2])]);
    }
    return ferror(stdin) ? FAILED : OK;
}

/* The bytes of a file and then of nothing; to be freed. NULL if it cannot be read. */
static unsigned char *read_file(const char *path, size_t *length)
{
    FILE *file = fopen(path, "rb");
    size_t room = 1 << 16;
    unsigned char *bytes = malloc(room), *more;
    *length = 0;
    while (file != NULL && bytes != NULL) {
        *length += fread(bytes + *length, 1, room - *length, file);
        if (*length < room)
            break; /* the end, or an error */
        more = room <= SIZE_MAX / 2 ? realloc(bytes, room *= 2) : NULL;
        if (more == NULL)
            free(bytes);
        bytes = more;
    }
    if (file == NULL || ferror(file)) {
        free(bytes);
        bytes = NULL;
    }
    if (file != NULL)
        fclose(file);
    return bytes;
}

static int read_one(const char *path, enum checks checks, enum question question)
{
    struct lfl_reader reader;
    size_t length;
    const char *error;
    unsigned char *bytes = read_file(path, &length);
    int code = OK, passed;
    if (bytes == NULL) {
        fprintf(stderr, "cannot read %s\n", path);
        return FAILED;
    }
    passed = checks == PROBE ? lfl_probe(bytes, length, &reader, &error) : lfl_open(bytes, length, &reader, &error);
    if (passed && checks == METADATA)
        passed = lfl_check_metadata(&reader, &error);
    if (passed && checks == ALL)
        passed = lfl_verify(&reader, &error);

    if (!passed && error == lfl_out_of_memory) {
        fprintf(stderr, "%s\n", error);
        code = FAILED;
    } else if (!passed) {
        printf("refused: %s\n", error);
        code = REFUSED;
    } else if (question != FACTS && (question == CELLS) != lfl_is_dexels(&reader)) {
        fprintf(stderr, "the question is for %s\n", question == CELLS ? "tri-dexel models" : "octrees");
        code = FAILED;
    } else if (question == POINTS || question == CUT_POINTS || question == VALUES || question == CELLS) {
        code = answer_points(&reader, question);
    } else if (question == VOLUME) {
        print_volume(&reader);
    } else {
        print_facts(&reader, checks);
        if (checks >= METADATA && !lfl_is_dexels(&reader))
            print_channels(&reader);
        if (checks == ALL && !lfl_is_dexels(&reader))
            print_cuts(&reader);
    }
    free(bytes);
    return code;
}

int main(int argc, char **argv)
{
    enum checks checks = ALL;
    enum question question = FACTS;
    int i = 1, files, code = OK;
    for (; i < argc && strncmp(argv[i], "--", 2) == 0; i++) {
        if (strcmp(argv[i], "--probe") == 0)
            checks = PROBE;
        else if (strcmp(argv[i], "--plain") == 0)
            checks = PLAIN;
        else if (strcmp(argv[i], "--metadata") == 0)
            checks = METADATA;
        else if (strcmp(argv[i], "--points") == 0)
            question = POINTS;
        else if (strcmp(argv[i], "--cut-points") == 0)
            question = CUT_POINTS;
        else if (strcmp(argv[i], "--values") == 0)
            question = VALUES;
        else if (strcmp(argv[i], "--volume") == 0)
            question = VOLUME;
        else if (strcmp(argv[i], "--cells") == 0)
            question = CELLS;
        else
            break;
    }
    files = argc - i;
    if (files < 1 || argv[i][0] == '-' || (question != FACTS && question != VOLUME && files > 1) ||
        (question != FACTS && checks == PROBE) || (question == VALUES && checks == PLAIN)) {
        fprintf(stderr, "usage: reader [--probe | --plain | --metadata] FILE...\n"
                        "       reader [--plain | --metadata] --points FILE\n"
                        "       reader [--plain | --metadata] --cut-points FILE\n"
                        "       reader [--plain | --metadata] --volume FILE...\n"
                        "       reader [--metadata] --values FILE\n"
                        "       reader [--plain | --metadata] --cells FILE\n");
        return FAILED;
    }
    for (; i < argc; i++) {
        int one;
        if (files > 1)
            printf("file: %s\n", argv[i]);
        one = read_one(argv[i], checks, question);
        if (one > code)
            code = one;
    }
    if (fflush(stdout) != 0 || ferror(stdout))
        code = FAILED;
    return code;
}

#endif
