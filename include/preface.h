/*
 * Leafless: a solid-modelling kernel on octrees without leaves. Every answer is proven.
 *
 * Generated from the sources; do not edit. SPDX-License-Identifier: MIT OR Apache-2.0
 *
 * OBJECTS, and how they become each other:
 *
 *   primitives, your own functions, ------.
 *   leafless_mesh, leafless_volume,        >---> leafless_solid ---> leafless_octree, leafless_tridexel,
 *   leafless_scene -----------------------'        ^                 leafless_lazy, leafless_mesh
 *                                                  |                   |
 *                                                  '-------------------' each is a solid again
 *
 *   A leafless_solid is a shape: it answers queries about points, rays, boxes, volumes and other solids, and
 *   an octree can be built from it. A leafless_octree stores a shape in the cells of a leafless_frame; set
 *   operations on one frame are exact. A leafless_tridexel stores a shape as intervals of rays. Octrees and
 *   tri-dexel models are written to files, and mapped from them. A cell is EMPTY or FULL, which is proven, or
 *   PARTIAL, which is undecided. A volume is an interval that contains the true volume. A leafless_layout
 *   checks the placements of solids in a container, and searches for valid placements.
 *
 * EXAMPLE: a bored ball, its volume, a file. (Check each status; see RULES.)
 *
 *   const double centre[3] = {0, 0, 0}, bottom[3] = {0, 0, -1}, top[3] = {0, 0, 1};
 *   const leafless_frame frame = {{-1, -1, -1}, 2, 8};
 *   const leafless_sink file = leafless_to_file("bored.lfl");
 *   leafless_solid *parts[2] = {NULL, NULL}, *bored = NULL;
 *   leafless_octree *octree = NULL;
 *   leafless_statistics all;
 *   leafless_solid_new_ball(centre, 0.75, &parts[0]);
 *   leafless_solid_new_cylinder(bottom, top, 0.25, &parts[1]);
 *   leafless_solid_combine(LEAFLESS_OPERATION_DIFFERENCE, (const leafless_solid *const *)parts, 2, &bored);
 *   leafless_octree_build(bored, &frame, LEAFLESS_RULE_CERTIFIED, NULL, &octree);
 *   leafless_octree_statistics(octree, &all);
 *   printf("%f to %f\n", all.volume_model.lower, all.volume_model.upper);
 *   leafless_octree_write(octree, &file);
 *
 * CONTENTS
 *
@CONTENTS@
 *
 * RULES that hold for all functions
 *
 * Results. A function that can fail returns a leafless_status; LEAFLESS_OK is 0. leafless_last_error gives
 * the message of the last failure in the calling thread. Results are written to the last parameters, and only
 * on success. After a failure the results are as they were before the call; the contents of buffers may have
 * changed. No parameter is both read and written, except struct_size.
 *
 * General errors. Every function may return these, and its comment does not repeat them:
 * - LEAFLESS_E_NULL: a pointer is NULL, and the function does not say that it may be.
 * - LEAFLESS_E_ARGUMENT: a pointer is misaligned; a count is more than memory can hold; a number is not in
 *   its enumeration; a path is empty; a struct_size is not sensible, or fields are set that this library does
 *   not know.
 * - LEAFLESS_E_PANIC: the library has a defect. The host program goes on, and all objects stay usable, except
 *   a leafless_tridexel_editor or a leafless_layout that the call was changing. Rust prints a message to
 *   stderr.
 *
 * Memory. The library returns LEAFLESS_E_NO_MEMORY if the system refuses memory whose size depends on an
 * input or a result. The process ends only if the system refuses one of the remaining small pieces (2 KiB at
 * most), or the memory of a new thread. Triangulating a non-convex polygon, or one with holes, needs 320
 * bytes a corner: the library reserves and releases that amount first, so that a shortage is an error.
 *
 * Objects. Objects are opaque handles. _new, _read and similar functions return a reference; _ref returns one
 * more; _free releases one, and accepts NULL. References may be released in any order, because an object
 * shares the data that it needs from another one. A pointer from a _peek function belongs to the object.
 *
 * Threads. Calls that take only pointers to const handles may run at once, on the same object too. Other
 * calls need the object for themselves. A _free needs only its own reference; other references may be in use
 * meanwhile. A leafless_lazy, a leafless_tridexel_editor and a leafless_layout return LEAFLESS_E_BUSY while
 * they are in use. Different objects never interfere. The library has no global state. No thread of the
 * library outlives the call that started it.
 *
 * Names. A function is named by its object, which is the first parameter or the result, and a verb. _new
 * makes an object from parameters, _from_x from another model, _read from a source; _build does so under
 * options. _with_x and _without_x return a copy with one thing more or less; participles (_placed, _sewn)
 * return a changed copy. _describe fills a struct of facts, such as leafless_octree_info; _copy fills buffers
 * of the caller; _write writes to a sink. _at takes a position or an index, _many an array of queries. Set
 * operations are _combine for any number of operands, and _complement. A member of an enumeration begins with
 * the name of the enumeration, a leafless_status alone with an E. UNDECIDED is 2 in every answer, as
 * LEAFLESS_TAG_PARTIAL is. UNKNOWN, a value that is not given, is 0.
 *
 * Structs. A struct with a field struct_size begins with its own sizeof, which the caller sets, also before
 * the library fills it: LEAFLESS_INIT(type) does so, and zeroes all other fields. Zero is the default of
 * fields that the library reads. Such structs may grow at their end, and programs that were compiled with an
 * older, shorter struct go on working: missing fields count as zero, and are not written. In a newer, longer
 * struct the library writes the fields that it knows. Structs without the field, including elements of
 * arrays, are fixed for one LEAFLESS_ABI.
 *
 * Numbers. A number that stands for a member of an enumeration has its type, and is checked: C++ refuses
 * another type, and the library refuses a number that is no member. In C, write leafless_tag for a variable,
 * not enum leafless_tag: only the former has the size that the library writes. Lengths of texts and structs
 * are size_t; all other lengths and counts are uint64_t.
 *
 * Texts. A text is UTF-8 of a given length in bytes, and may be NULL if the length is 0. A path is UTF-8 on
 * every platform, and never empty.
 *
 * Units. Names that end in _model are in model units; names that end in _cells are in finest cells. "3
 * numbers" are x, y and z.
 *
 * Cells. A cell is identified by its level and by its index on each axis among the cells of that level. Level
 * 0 is the universe. leafless_frame_cell_bounds returns the box of any cell in model units, also of witnesses
 * and nearest cells.
 *
 * Buffers. A buffer whose size the caller cannot know is filled in two steps. With a NULL buffer and the
 * capacity 0 the function returns the number of elements; the second call fills the buffer. Capacities count
 * elements. Buffers and results of one call must not overlap.
 *
 * Functions of the host get their context first, return 0 to go on, and must not throw or longjmp through the
 * library.
 *
 * Comments of functions have entries in a fixed order. A missing entry means:
 * - Buffers: none.
 * - Result: the status alone.
 * - Errors: only the general ones.
 * - Ownership: no reference changes hands; the library keeps no pointer that it was given.
 * - Threads: any thread may call, and the work is done in the calling thread.
 * - Untrusted input: the function takes none.
 * - Since: 0.1. Before version 0.1 everything may still change.
 */

#ifndef LEAFLESS_H
#define LEAFLESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* LEAFLESS_ENUM: an enumeration of a fixed size. C has none; there the name is that of the integer type.
 * LEAFLESS_INIT: the default of a struct with a struct_size, as in
 *     leafless_options options = LEAFLESS_INIT(leafless_options); */
#ifdef __cplusplus
#define LEAFLESS_ENUM(name, integer) enum name : integer
#define LEAFLESS_INIT(type) \
    ([]() { type made_ = type(); made_.struct_size = static_cast<uint32_t>(sizeof(type)); return made_; }())
extern "C" {
#else
#define LEAFLESS_ENUM(name, integer) typedef integer name; enum name
#define LEAFLESS_INIT(type) ((type){.struct_size = sizeof(type)})
#endif

/// Version of the library that this header belongs to: major * 1000000 + minor * 1000 + patch.
#define LEAFLESS_VERSION \
    (LEAFLESS_VERSION_MAJOR * 1000000 + LEAFLESS_VERSION_MINOR * 1000 + LEAFLESS_VERSION_PATCH)

/// True if the linked library fits this header: it has the same binary interface, and is not older. Before
/// 0.1, where nothing is promised, it must have the same version.
#define LEAFLESS_COMPATIBLE() \
    (leafless_abi() == LEAFLESS_ABI && \
     (LEAFLESS_ABI > 0 ? leafless_version() >= LEAFLESS_VERSION : leafless_version() == LEAFLESS_VERSION))
