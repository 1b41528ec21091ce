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
 *   1. Objects
 *   2. Versions
 *   3. Errors
 *   4. Options, cancelling, progress
 *   5. Frames
 *   6. Sources and sinks
 *   7. Meshes
 *   8. Mesh files
 *   9. Solids
 *   10. Solids by functions of the host
 *   11. Volumes
 *   12. Scenes
 *   13. Octrees
 *   14. Extended octrees
 *   15. Shards: octrees in parts
 *   16. Points and boxes
 *   17. Cells of octrees
 *   18. Rays, columns, heights
 *   19. Volumes, areas, bounding boxes
 *   20. Distance and interference
 *   21. Layouts: solids in a container
 *   22. Octrees that are split on demand
 *   23. Attributes
 *   24. Channels
 *   25. Voxel records
 *   26. Surfaces
 *   27. Tri-dexel models
 *   28. Files of octrees and tri-dexel models
 *   29. Pictures
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

/* ---- 1. Objects --------------------------------------------------------------------------------------- */

/// A switch that stops long operations from any thread and reports their progress.
///
/// All its functions may be called at once from any number of threads.
typedef struct leafless_control leafless_control;

/// A surface of triangles with shared vertices. Vertices at equal positions are welded. A mesh need not be
/// closed.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_mesh_free releases.
typedef struct leafless_mesh leafless_mesh;

/// A shape that can split a cell of space into eight classified cells.
///
/// Before a solid can classify cells of a frame, the library prepares it for the frame. This takes time in
/// proportion to the model: a mesh is brought onto the lattice, an expression is expanded, all links of an
/// octree are checked. The solid keeps the last preparation, so that a second query on the same frame costs
/// none of that time; another frame replaces it. (Solids made from this solid do not share its preparation.)
///
/// Otherwise a solid is immutable: all its functions may be called at once from any number of threads, but no
/// other call may use the reference that leafless_solid_free releases. Threads that query different frames at
/// the same time prepare the solid again and again: give each thread a solid of its own.
typedef struct leafless_solid leafless_solid;

/// A three-dimensional bitmap or array of samples, with its position. Each sample stands for the closed box
/// around it, its voxel: on each axis voxel i reaches from corner + i·spacing to corner + (i + 1)·spacing.
/// leafless_solid_from_volume makes a solid from the voxels whose samples lie in a band.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_volume_free releases.
typedef struct leafless_volume leafless_volume;

/// A scene that a text describes: set operations on primitives, swept figures, meshes and octrees.
///
/// The language is that of the CSG dumps that OpenSCAD exports (group union difference intersection
/// multmatrix color render cube sphere cylinder polyhedron linear_extrude rotate_extrude square circle
/// polygon, and import of meshes), with these additional calls: halfspace([a, b, c, d]), which is a x + b y +
/// c z + d ≥ 0, quadric([10 numbers]), power([A, a, n1], [B, b, n2], [C, c, n3], R), torus(major, minor),
/// mesh("file.stl") and octree("file.lfl"). Curved shapes are exact, except shapes with a $fn of 12 or less,
/// which are the polygons, prisms and polyhedra that OpenSCAD draws; leafless_scene_options can change this.
/// Unsupported calls (hull, minkowski, text, projection and others) are refused by name.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_scene_free releases.
typedef struct leafless_scene leafless_scene;

/// A leaf-free octree, in memory or mapped from a file.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_octree_free releases.
typedef struct leafless_octree leafless_octree;

/// A cursor for point queries that keeps the path to the last cell: for points near each other, such as along
/// a line or in scan order.
///
/// Every call changes the cursor: only one thread may use it at a time. Each thread may have its own cursor.
typedef struct leafless_point_cursor leafless_point_cursor;

/// A table of all cells of one level, for point queries at random positions: about twice as fast as
/// leafless_octree_contains, because the table decides most points. It takes 4 * 8^level bytes: 1 MiB for
/// level 6, 64 MiB for level 8. Queries do not change the table: any threads may use it at once.
typedef struct leafless_point_table leafless_point_table;

/// A position in an octree that moves along its links, one level at a step. It starts at the universe.
///
/// Moving changes the cursor: while one thread moves it, no other thread may use it. Each thread may have its
/// own cursor.
typedef struct leafless_cursor leafless_cursor;

/// An iterator over cells of an octree. Its position is before the next cell.
///
/// Reading changes it: while one thread reads, no other may use it. Threads may have one each.
typedef struct leafless_cells leafless_cells;

/// An iterator over boundary faces of an octree. Its position is before the next face.
///
/// Reading changes it: while one thread reads, no other may use it. Threads may have one each.
typedef struct leafless_faces leafless_faces;

/// The solid cells of columns, as runs.
///
/// Immutable: any number of threads may read it at once.
typedef struct leafless_columns leafless_columns;

/// A container, obstacles and items, from which leafless_layout_new makes a layout. One thread at a time may
/// fill it.
typedef struct leafless_bay leafless_bay;

/// A container with obstacles, items, and placed copies of these items. Solids are prepared once, when the
/// layout is made. Copies are numbered from 0, in the order of placing.
///
/// While one call changes a layout, every other call returns LEAFLESS_E_BUSY, both from another thread and
/// from the host's functions inside the call. While a call reads it, calls that change it return
/// LEAFLESS_E_BUSY. Any number of threads may read it at once.
typedef struct leafless_layout leafless_layout;

/// An octree of a solid that is split on demand: a cell is split when a call requests it, and split cells are
/// stored. FULL and EMPTY cells are proven; cells that are not split yet are PARTIAL.
///
/// Splitting and refining change the octree. While one call changes it, every other call returns
/// LEAFLESS_E_BUSY, both from another thread and from the host's functions inside the call. While a call
/// reads it, splitting and refining return LEAFLESS_E_BUSY. Its other functions may be called at once from
/// any number of threads.
typedef struct leafless_lazy leafless_lazy;

/// An attribute: a value at every point of model space, or at some points. It is a constant, the host's own
/// function, the values of a channel, of a mesh or of a volume, or any of these under a map. A value has one
/// to four numbers, the same count at all points. Where a value is written and there is none, its numbers are
/// NaN.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_attribute_free releases.
typedef struct leafless_attribute leafless_attribute;

/// Values inside a cube, stored in a tree of their own: a colour, a temperature or a material at every point,
/// or at some points. leafless_octree_with_channel attaches a channel to an octree, whose file then contains
/// it. The tree may be finer or coarser than the octree.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_channel_free releases.
typedef struct leafless_channel leafless_channel;

/// The boundary of a solid: a mesh whose triangles refer to their surfaces, and its faces.
///
/// A region is a part of the boundary on one surface that is connected by edges of the mesh. On a plane it is
/// one face: an outer loop, counter-clockwise as seen from outside the solid, and a clockwise loop around
/// each hole. On a curved surface its triangles are the faces. Two faces that meet in an edge have the same
/// vertices there.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_boundary_free releases.
typedef struct leafless_boundary leafless_boundary;

/// A tri-dexel model: a solid as intervals along the rays of a lattice, in one to three directions.
///
/// Rays run through the centres of the finest cells of a frame. Each ray has the sorted, disjoint intervals
/// of its points inside the solid. An interval is half-open: it contains its start and not its end, so that
/// set algebra is exact. All directions agree about the centres of cells.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_tridexel_free releases. A leafless_tridexel_editor changes a copy in place.
typedef struct leafless_tridexel leafless_tridexel;

/// A copy of a tri-dexel model that is changed in place, for machining. The time of a change is proportional
/// to the rays and intervals that the second operand touches. It takes 12 bytes for each ray of the lattice
/// in addition to the intervals.
///
/// While one call changes an editor, every other call returns LEAFLESS_E_BUSY, both from another thread and
/// from the host's functions inside the call. While a call reads it, calls that change it return
/// LEAFLESS_E_BUSY. Any number of threads may read it at once.
typedef struct leafless_tridexel_editor leafless_tridexel_editor;

/// A layer of a picture: the surface of an octree, a solid or a mesh, lines, a plane section, or voxels.
///
/// A layer shares or copies the objects that it shows, so these may be freed. It is independent of cameras,
/// and may be part of any number of pictures.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_layer_free releases.
typedef struct leafless_layer leafless_layer;

/* ---- 2. Versions -------------------------------------------------------------------------------------- */

/// Major version of the library that this header belongs to.
#define LEAFLESS_VERSION_MAJOR 0

/// Minor version of the library that this header belongs to.
#define LEAFLESS_VERSION_MINOR 0

/// Patch level of the library that this header belongs to.
#define LEAFLESS_VERSION_PATCH 1

/// Number of the binary interface. Programs and libraries with the same number are compatible. It is 0 until
/// the release 0.1, which means that nothing is promised yet.
#define LEAFLESS_ABI 0

/// Returns the version of the library that is linked: major · 1 000 000 + minor · 1000 + patch, as
/// LEAFLESS_VERSION.
///
/// - Result: the number.
uint32_t leafless_version(void);

/// Returns the version of the library that is linked, as a text such as "0.1.0".
///
/// - Result: a NUL-terminated text, never NULL.
/// - Ownership: the text is static; do not free it.
const char *leafless_version_string(void);

/// Returns the number of the binary interface of the library that is linked. Compare it with LEAFLESS_ABI, or
/// use LEAFLESS_COMPATIBLE, which compares the version too.
///
/// - Result: the number.
uint32_t leafless_abi(void);

/* ---- 3. Errors ---------------------------------------------------------------------------------------- */

/// The status codes that functions return. A code is never renumbered or reused; new codes are added at the
/// end.
LEAFLESS_ENUM(leafless_status, int32_t) {
    LEAFLESS_OK = 0,  ///< Success.
    LEAFLESS_E_NULL = 1,  ///< A pointer that must not be NULL is NULL.
    LEAFLESS_E_ARGUMENT = 2,  ///< An argument is out of its range, not a number, or misaligned.
    LEAFLESS_E_UTF8 = 3,  ///< A text is not UTF-8, or a path holds a NUL.
    LEAFLESS_E_BUFFER = 4,  ///< A buffer is too small for the result.
    LEAFLESS_E_FRAME = 5,  ///< Operands lie on different frames, or a solid belongs to another frame.
    /// The sampled rule was requested for a solid that cannot decide single points.
    LEAFLESS_E_NOT_SAMPLED = 6,
    LEAFLESS_E_MESH = 7,  ///< A mesh does not bound a solid.
    LEAFLESS_E_MESH_FILE = 8,  ///< A mesh file cannot be read.
    LEAFLESS_E_FORMAT = 9,  ///< The bytes are not a Leafless file, or the file is damaged.
    LEAFLESS_E_VERSION = 10,  ///< The file needs a newer version of the library.
    LEAFLESS_E_DAMAGED = 11,  ///< The arrays of an octree or of a tri-dexel model contradict each other.
    LEAFLESS_E_LIMIT = 12,  ///< The result would need more nodes or bytes than leafless_options allows.
    LEAFLESS_E_NO_MEMORY = 13,  ///< An allocation failed.
    /// The host cancelled the operation, through a control or from its progress function.
    LEAFLESS_E_CANCELLED = 14,
    /// A function of the host, other than the progress function, ended the operation by its return value.
    LEAFLESS_E_CALLBACK = 15,
    LEAFLESS_E_IO = 16,  ///< The operating system refused to read or write.
    /// The library has a defect; please report it with the message. All objects stay usable, except an editor
    /// or a layout that the call was changing.
    LEAFLESS_E_PANIC = 17,
    LEAFLESS_E_SOURCE = 18,  ///< The octree to refine was made from another solid.
    LEAFLESS_E_SCENE = 19,  ///< A scene cannot be read.
    /// A lazy octree, an editor or a layout is in use by another call, in another thread or around this one.
    /// Nothing was done.
    LEAFLESS_E_BUSY = 20,
    LEAFLESS_E_VOLUME_FILE = 21,  ///< A volume file cannot be read.
};

/// Returns the name of a status, such as "LEAFLESS_E_NULL".
///
/// - Result: a NUL-terminated text, never NULL; "LEAFLESS_E_UNKNOWN" for a number that is not a status.
/// - Ownership: the text is static; do not free it.
/// - Untrusted input: any number.
const char *leafless_status_name(int32_t status);

/// Copies the message of the last failure in the calling thread: a sentence in UTF-8 for the user. If the
/// failure is about a file, the message begins with the path, or with the end of a long path. A call that
/// succeeds leaves the message unchanged. Before the first failure the message is empty.
///
/// - Buffers: `message`, `capacity` bytes; may be NULL if `capacity` is 0.
/// - Result: the message's length in bytes, without the terminating NUL, also if the buffer is too small; at
///   most 511. The text in the buffer is cut between characters and NUL-terminated.
/// - Ownership: the message is copied.
/// - Threads: any; every thread has its own message.
size_t leafless_last_error(char *message, size_t capacity);

/// Returns the status of the last failure in the calling thread; LEAFLESS_OK before the first failure.
///
/// - Result: the status.
/// - Threads: any; every thread has its own status.
leafless_status leafless_last_status(void);

/// Returns the value with which a function of the host ended the operation, if that was the last failure in
/// the calling thread (LEAFLESS_E_CALLBACK); else 0. Distinct values tell the host which of its functions
/// failed, and why.
///
/// - Result: the number.
/// - Threads: any; every thread has its own number.
int32_t leafless_last_code(void);

/* ---- 4. Options, cancelling, progress ----------------------------------------------------------------- */

/// The host's progress function: receives the fraction that is done (0 to 1) and returns 0 to go on. Any
/// other value ends the operation with LEAFLESS_E_CANCELLED, unless it is already done, and cancels the
/// `control` of its options, if there is one, until leafless_control_reset.
///
/// Any of the operation's threads may call it, also two at once and then not in ascending order; with
/// `threads` = 1 only the calling thread does. It must return: no exception, no longjmp. It may call this
/// library.
typedef int32_t (*leafless_progress_fn)(void *ctx, double fraction);

/// Options of long operations: threads, limits, progress and cancelling. Where a function takes options, NULL
/// means the defaults. Zero is the default of every field but the first. No option but `max_splits` changes a
/// result.
typedef struct leafless_options {
    uint32_t struct_size;  ///< sizeof(leafless_options).
    /// Number of threads; 0 means the number of processors, numbers beyond 1024 mean 1024. Inside a function
    /// that the library calls it is always 1.
    uint32_t threads;
    /// Largest number of octree nodes of a result; 0 means no limit. A larger result is refused with
    /// LEAFLESS_E_LIMIT.
    uint64_t max_nodes;
    /// Largest size in bytes of a result's working form; 0 means no limit. A larger result is refused with
    /// LEAFLESS_E_LIMIT, before any work if the size is known beforehand. Assembling a result needs the same
    /// amount once more for a moment. Set a limit if a solid or its depth is untrusted: a file of some
    /// hundred bytes may hold a cell whose surface has 2^43 triangles. Interference, clearance, deviations
    /// and bounding boxes stop before their cache of a solid's parts exceeds the limit; as when max_splits is
    /// spent, they return the answer found so far.
    uint64_t max_bytes;
    /// Largest number of cells to split; 0 means no limit, or the default that the function names. It applies
    /// only to functions that split on demand, and their comments say so. When it is spent, they stop and
    /// keep or return the result so far, without an error.
    uint64_t max_splits;
    leafless_progress_fn progress;  ///< The progress function; optional.
    void *progress_ctx;  ///< The context that `progress` is called with.
    /// A control that can cancel the operation and report its progress; optional. Give operations that run at
    /// the same time a control each, or their progress is mixed up.
    const leafless_control *control;
} leafless_options;

/// Sets any struct that begins with `struct_size` to its default: its size, and zeros. In C and C++ the macro
/// LEAFLESS_INIT does the same; this function is for other languages.
///
/// - Buffers: `value`, one struct of `struct_size` bytes, which need not be initialised.
/// - Result: `*value`.
/// - Errors: LEAFLESS_E_ARGUMENT if `struct_size` is not sensible.
leafless_status leafless_init(void *value, size_t struct_size);

/// Makes a control.
///
/// - Buffers: `control`, one pointer.
/// - Result: `*control`, not cancelled.
/// - Ownership: release `*control` with leafless_control_free, after the operations that use it are done.
leafless_status leafless_control_new(leafless_control **control);

/// Releases a control.
///
/// - Buffers: `control`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
void leafless_control_free(leafless_control *control);

/// Cancels the operations that run with this control. They return LEAFLESS_E_CANCELLED soon, and so do later
/// operations until leafless_control_reset.
///
/// - Buffers: `control`, a handle.
/// - Result: none; returns at once.
leafless_status leafless_control_cancel(const leafless_control *control);

/// Makes a cancelled control usable again.
///
/// - Buffers: `control`, a handle.
/// - Threads: any, but operations that have not noticed the cancellation yet may go on.
leafless_status leafless_control_reset(const leafless_control *control);

/// Returns whether a control was cancelled, and the progress of the operation that runs with it.
///
/// - Buffers: `control`, a handle; `cancelled` and `fraction`, one each, each may be NULL.
/// - Result: `*cancelled`; `*fraction`, 0 to 1.
leafless_status leafless_control_state(const leafless_control *control, bool *cancelled, double *fraction);

/* ---- 5. Frames ---------------------------------------------------------------------------------------- */

/// The lattice of a tree: the cube [origin, origin + edge]³ in model units, cut into 2^depth cells per axis.
///
/// A coordinate of the origin is 0 or of a magnitude between 2^-256 and 2^256, the edge between 2^-256 and
/// 2^256, the depth 1 to 20. The lattice planes are the real numbers origin + i·edge/2^depth, whether or not
/// doubles can represent them: comparisons with them are exact.
typedef struct leafless_frame {
    double origin[3];  ///< Lower corner of the universe.
    double edge;  ///< Edge length of the universe.
    uint32_t depth;  ///< Levels below the universe.
} leafless_frame;

/// An interval that contains the truth: lower ≤ truth ≤ upper.
typedef struct leafless_interval {
    double lower;  ///< Proven lower bound.
    double upper;  ///< Proven upper bound.
} leafless_interval;

/// Checks a frame's fields.
///
/// - Buffers: `frame`, one struct.
/// - Result: LEAFLESS_OK if the frame can be used.
/// - Errors: LEAFLESS_E_ARGUMENT, with the field that is out of range in the message.
/// - Untrusted input: any values.
leafless_status leafless_frame_check(const leafless_frame *frame);

/// Makes a frame around a shape: a cube of edge L·(1 + 1/32) around the centre of the bounds, where L is the
/// longest extent. The universe is the same at every depth. For parts with round dimensions
/// leafless_frame_aligned is better.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `frame`, one struct.
/// - Result: `*frame`.
/// - Errors: LEAFLESS_E_MESH if the longest extent is 0; LEAFLESS_E_ARGUMENT if min > max on an axis, if
///   `depth` is not 1 to 20, or if a bound is not a finite number in range, or so far from the origin that
///   doubles cannot resolve the cube.
/// - Untrusted input: any values.
leafless_status leafless_frame_around(const double min_model[3], const double max_model[3], uint32_t depth,
    leafless_frame *frame);

/// Makes the frame of leafless_frame_around whose finest cells are no longer than a tolerance. The tolerance
/// is the greater of a length and a fraction of the longest extent. The depth is the least one that suffices;
/// it is 20 if no depth suffices, and for tolerances of 0.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `frame`, one struct.
/// - Result: `*frame`.
/// - Errors: as leafless_frame_around; LEAFLESS_E_ARGUMENT if a tolerance is negative or no number.
/// - Untrusted input: any values.
leafless_status leafless_frame_to_tolerance(const double min_model[3], const double max_model[3],
    double tolerance_model, double relative, leafless_frame *frame);

/// Makes a frame whose lattice planes are round numbers, around a shape with these bounds. Its edge is the
/// smallest power of two that holds the bounds; its origin is a multiple of the largest possible power of
/// two. Faces at 25, 12.5 or -0.75 then lie on lattice planes, where they take no cells and the certified
/// volume is exact. The universe is the same at every depth.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `frame`, one struct.
/// - Result: `*frame`.
/// - Errors: as leafless_frame_around.
/// - Untrusted input: any values.
leafless_status leafless_frame_aligned(const double min_model[3], const double max_model[3], uint32_t depth,
    leafless_frame *frame);

/// Makes a frame with cells of a given size around a shape with these bounds. Its depth is the least one that
/// holds the bounds. Its origin is a multiple of the cell size times the largest possible power of two.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `frame`, one struct.
/// - Result: `*frame`.
/// - Errors: as leafless_frame_around; LEAFLESS_E_ARGUMENT also if `cell_size_model` is not 2^-256 to 2^256,
///   or if the bounds take more than 2^20 cells on an axis.
/// - Untrusted input: any values.
leafless_status leafless_frame_with_cells(const double min_model[3], const double max_model[3],
    double cell_size_model, leafless_frame *frame);

/// Makes the frame that suits a shape with these bounds: leafless_frame_aligned if all bounds are multiples
/// of 2^-12 of its edge, as for parts drawn with round dimensions, else leafless_frame_around. The universe
/// is the same at every depth.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `frame`, one struct.
/// - Result: `*frame`.
/// - Errors: as leafless_frame_around.
/// - Untrusted input: any values.
leafless_status leafless_frame_fitted(const double min_model[3], const double max_model[3], uint32_t depth,
    leafless_frame *frame);

/// Returns the edge length of a finest cell: edge / 2^depth, exactly.
///
/// - Buffers: `frame`, one struct; `cell_size_model`, one number.
/// - Result: `*cell_size_model`, in model units.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check.
/// - Untrusted input: any values.
leafless_status leafless_frame_cell_size(const leafless_frame *frame, double *cell_size_model);

/// Returns the finest cell that contains a point. A point on a plane between two cells belongs to the upper
/// cell; a point on the universe's upper face belongs to the last cell. The comparison is exact.
///
/// - Buffers: `frame`, one struct; `point_model`, 3 numbers; `cell`, room for 3.
/// - Result: `cell`, each below 2^depth.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check, and if the point is outside the universe or not a
///   number.
/// - Untrusted input: any values.
leafless_status leafless_frame_cell_at(const leafless_frame *frame, const double point_model[3],
    uint32_t cell[3]);

/// Returns the position of a lattice plane: the tightest interval of doubles that contains it.
///
/// - Buffers: `frame`, one struct; `plane_model`, one struct.
/// - Result: `*plane_model`; lower = upper if the position is a double.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check, if `axis` is not 0 to 2, or `index` beyond 2^depth.
/// - Untrusted input: any values.
leafless_status leafless_frame_plane(const leafless_frame *frame, uint32_t axis, uint32_t index,
    leafless_interval *plane_model);

/* ---- 6. Sources and sinks ----------------------------------------------------------------------------- */

/// The way in which a source is accessed. Octrees, tri-dexel models and samples in memory can be used in
/// place; everything else is read with LEAFLESS_ACCESS_COPY.
LEAFLESS_ENUM(leafless_access, uint32_t) {
    /// Reads the source into memory and verifies all of it. This is the default, and the way for untrusted
    /// files. Later changes of the file or of the bytes do not matter. Bytes may have any address.
    LEAFLESS_ACCESS_COPY = 0,
    /// Uses the source in place: a file is mapped into memory, bytes are viewed. Only the header, the section
    /// table, the bounds, the level table or windows, and the metadata are checked, in some microseconds for
    /// any length. The rest is read when queries touch it. If the rest is damaged, queries may answer
    /// undecided or wrong, but they stay in bounds and end.
    LEAFLESS_ACCESS_MAP = 1,
    /// As LEAFLESS_ACCESS_MAP, but all of the source is verified first, in one scan. Writing to the source
    /// afterwards invalidates the verification.
    LEAFLESS_ACCESS_MAP_VERIFIED = 2,
};

/// The input of a reading function: a file by its path, or the bytes of a whole file in memory. Exactly one
/// of the two is given, and the fields of the other are zero, else functions return LEAFLESS_E_ARGUMENT.
/// leafless_from_file and leafless_from_bytes make this struct.
///
/// A mapped file must be a regular file. While the object that was read lives, or an object that shares the
/// file with it, the file must not become shorter: reading beyond its new end raises SIGBUS, which by default
/// ends the process. The file must not be written to either: answers may then be wrong, and nothing more is
/// promised. Removing the file, or replacing it by renaming another file over it, as a leafless_sink does, is
/// harmless.
///
/// Viewed bytes begin at an address that is a multiple of 8, and belong to the host. They must stay in place,
/// unchanged, until the last reference is released to the object that was read and to every object that
/// shares the bytes: cursors, solids, channels, models with other metadata, and objects made from these.
/// Viewed bytes are for files that are part of a program, or that the host maps itself.
///
/// Untrusted input: with LEAFLESS_ACCESS_COPY any file and any bytes; memory is at most a small multiple of
/// their length, unless the function says more. With the other two any content too, but only if no other
/// program can change it.
typedef struct leafless_source {
    uint32_t struct_size;  ///< sizeof(leafless_source).
    leafless_access access;  ///< A leafless_access.
    const char *path;  ///< The file's path, UTF-8; NULL if bytes are given.
    size_t path_length;  ///< Length of the path in bytes.
    const uint8_t *bytes;  ///< All bytes of a file; NULL if a path is given, or if the file is empty.
    uint64_t length;  ///< Number of bytes.
} leafless_source;

/// Receives the bytes of a file in order. It takes all `count` bytes and returns 0; any other value ends the
/// writing with LEAFLESS_E_CALLBACK. It is called in the calling thread. It must return: no exception, no
/// longjmp. It may call this library.
typedef int32_t (*leafless_write_fn)(void *ctx, const uint8_t *bytes, uint64_t count);

/// The destination of a file: a path, a function of the host, or a buffer. Exactly one of `path`, `write` and
/// `length` is given, and the fields of the others are zero, else functions return LEAFLESS_E_ARGUMENT.
/// leafless_to_file, leafless_to_function and leafless_to_buffer make this struct.
///
/// A path. At any moment, also after a crash or a power failure, the old file or the new file exists,
/// complete; after LEAFLESS_OK the new file is on the disk. The bytes go to a temporary file in the same
/// directory, which is synchronised with the disk and then renamed over the old file. On Linux, if the file
/// system supports it, the temporary file has no name until it is complete, so that nothing is left of it
/// when the process is killed. Elsewhere a file `.leafless-….tmp` may stay behind. A replaced file keeps its
/// permissions; its other hard links keep the old contents. A symbolic link is followed. A file that is not
/// regular, such as a pipe, is written to directly. A pipe without a reader raises SIGPIPE, and a file beyond
/// the process's size limit raises SIGXFSZ, unless the host ignores these signals. The call waits until a
/// pipe is opened for reading, also if signal handlers run meanwhile. After an error, LEAFLESS_E_IO or
/// another, the old file is unchanged; only if the last step fails, synchronising the directory, the new file
/// is in place.
///
/// A function. It is called with a few large pieces, from the first byte to the last. The message of
/// LEAFLESS_E_CALLBACK contains the function's return value. Other errors occur before anything is written.
///
/// A buffer. Computing only the length takes as long as filling the buffer. LEAFLESS_E_BUFFER if the capacity
/// is too small.
typedef struct leafless_sink {
    uint32_t struct_size;  ///< sizeof(leafless_sink).
    uint32_t reserved;  ///< Reserved; must be 0.
    const char *path;  ///< The file's path, UTF-8.
    size_t path_length;  ///< Length of the path in bytes.
    leafless_write_fn write;  ///< The function that receives the bytes.
    void *write_ctx;  ///< The context that `write` is called with.
    uint8_t *bytes;  ///< Room for `capacity` bytes, or NULL to get only the length.
    uint64_t capacity;  ///< Capacity of the buffer in bytes.
    uint64_t *length;  ///< Receives the length of the file in bytes.
} leafless_sink;

/// Makes a source of the file at a NUL-terminated path.
static inline leafless_source leafless_from_file(const char *path, leafless_access access) {
    leafless_source source = LEAFLESS_INIT(leafless_source);
    source.access = access;
    source.path = path;
    /* With the length 1, a NULL path is refused as such, and not read as an empty path. */
    source.path_length = path ? strlen(path) : 1;
    return source;
}

/// Makes a source of the bytes of a whole file.
static inline leafless_source leafless_from_bytes(const void *bytes, uint64_t length,
                                                  leafless_access access) {
    leafless_source source = LEAFLESS_INIT(leafless_source);
    source.access = access;
#ifdef __cplusplus
    source.bytes = static_cast<const uint8_t *>(bytes);
#else
    source.bytes = (const uint8_t *)bytes;
#endif
    source.length = length;
    return source;
}

/// Makes a sink that writes to the file at a NUL-terminated path.
static inline leafless_sink leafless_to_file(const char *path) {
    leafless_sink sink = LEAFLESS_INIT(leafless_sink);
    sink.path = path;
    sink.path_length = path ? strlen(path) : 1;
    return sink;
}

/// Makes a sink that writes to a buffer; `bytes` is NULL and `capacity` 0 to get only the length.
static inline leafless_sink leafless_to_buffer(uint8_t *bytes, uint64_t capacity, uint64_t *length) {
    leafless_sink sink = LEAFLESS_INIT(leafless_sink);
    sink.bytes = bytes;
    sink.capacity = capacity;
    sink.length = length;
    return sink;
}

/// Makes a sink that passes the bytes to a function, which is called with `ctx`.
static inline leafless_sink leafless_to_function(leafless_write_fn write, void *ctx) {
    leafless_sink sink = LEAFLESS_INIT(leafless_sink);
    sink.write = write;
    sink.write_ctx = ctx;
    return sink;
}

/* ---- 7. Meshes ---------------------------------------------------------------------------------------- */

/// The fill rule: which points a surface encloses.
///
/// The winding number of a surface at a point is the solid angle that the surface subtends there, divided by
/// 4π, positive where the point sees the inner side. For a closed surface it is an integer. For a surface
/// with holes, fins or inverted triangles it is a fraction, and by convention the nearest integer decides: a
/// hole is closed by the surface from which half of all directions lead out.
LEAFLESS_ENUM(leafless_fill, uint32_t) {
    /// Points whose winding number is at least 1/2 in magnitude: overlapping bodies are united, and an
    /// inside-out body counts as a body.
    LEAFLESS_FILL_NON_ZERO = 0,
    /// Points from which a ray crosses the surface an odd number of times: the overlap of two bodies is
    /// outside. Orientation does not matter. An even number of triangles must meet on every edge.
    LEAFLESS_FILL_EVEN_ODD = 1,
    /// Points whose winding number is at least 1/2: an inside-out body is a cavity, and is subtracted from
    /// bodies that it overlaps.
    LEAFLESS_FILL_POSITIVE = 2,
};

/// A report of the import of a mesh and of the connectivity of its triangles.
typedef struct leafless_mesh_report {
    uint32_t struct_size;  ///< sizeof(leafless_mesh_report).
    uint64_t facets_read;  ///< Triangles of the input: triangles + degenerate.
    uint64_t triangles;  ///< Triangles of the mesh.
    uint64_t vertices;  ///< Vertices of the mesh, all at different positions.
    uint64_t welded;  ///< Vertices of the input at the position of an earlier vertex.
    uint64_t degenerate;  ///< Triangles that were dropped because two of their corners coincide.
    /// Edges that an odd number of triangles use. A mesh is closed if it has no such edge.
    uint64_t boundary_edges;
    /// Loops of boundary edges that pass each vertex once: the holes of the surface and the rims of sheets.
    uint64_t boundary_loops;
    /// Edges that an even number of triangles use, but not half of them in each direction. A closed mesh is
    /// consistently oriented if it has no such edge.
    uint64_t misoriented_edges;
    /// Edges that more than two triangles use, for instance where two bodies touch. They are harmless.
    uint64_t non_manifold_edges;
    /// Triangles that repeat an earlier one, in the same orientation. Each repetition counts.
    uint64_t duplicate;
    /// Pairs of triangles with the same corners and opposite orientations: walls without thickness. The two
    /// cancel each other.
    uint64_t opposite;
    uint64_t flat;  ///< Triangles without area whose corners are three different vertices. They are harmless.
    /// Sets of triangles that are connected by edges. Bodies that touch only in single vertices count
    /// separately, and so do the outer and the inner surface of a hollow body.
    uint64_t bodies;
    uint64_t open_bodies;  ///< Bodies that are open or not consistently oriented.
    /// Other bodies that enclose a negative volume: cavities and inside-out bodies.
    uint64_t inside_out_bodies;
    uint64_t sewn;  ///< Vertices that leafless_mesh_sewn moved onto another vertex.
    /// Largest displacement of a sewn vertex along an axis, in model units, without a stated deviation.
    double displacement_model;
    /// Closed bodies that are proven to overlap another one: their surfaces cross, or one lies inside the
    /// other with the same orientation and no cavity between them. The winding number then exceeds 1 in
    /// magnitude at some points, and leafless_mesh_volume differs from the volume that a fill rule encloses.
    uint64_t overlapping_bodies;
    /// Other closed bodies that may overlap another one: they touch in a way that is not decided, such as a
    /// peg that fits its hole exactly, or the search had to stop.
    uint64_t undecided_bodies;
    /// Faces of more than three corners that were triangulated: from OBJ, PLY and OFF files and from
    /// polyhedra. 0 for other meshes.
    uint64_t polygons;
    /// Polygons that are not flat: corners lie off the face's plane by more than 2^-40 of its extent. Such a
    /// face does not define a surface. The mesh is one of its triangulations, and every proof about the mesh
    /// is about that triangulation.
    uint64_t bent_polygons;
    /// Half the distance, in model units and up to rounding, between the two planes parallel to a face that
    /// have all its corners between them, for the face where it is greatest. Every triangulation of the face
    /// lies between the planes.
    double polygon_deviation_model;
    uint64_t edges;  ///< Edges, each counted once.
    /// V - E + F of the vertices that triangles use, the edges and the triangles. For a 2-manifold it is 2
    /// for each component less 2 for each handle.
    int64_t euler_characteristic;
    /// Whether the mesh is closed and consistently oriented: every edge is used as often in one direction as
    /// in the other. An empty mesh is closed.
    bool is_closed;
    /// Whether exactly two triangles meet at every edge and use it in opposite directions.
    bool is_manifold;
} leafless_mesh_report;

/// Kinds of defects of a mesh, the most harmful first.
LEAFLESS_ENUM(leafless_defect, uint32_t) {
    /// A loop of edges that an odd number of triangles use: around a hole, or around a sheet.
    LEAFLESS_DEFECT_HOLE = 0,
    /// Edges that an even number of triangles use, but not half of them in each direction.
    LEAFLESS_DEFECT_MISORIENTED = 1,
    /// Triangles with the same corners as an earlier one, in the same or the opposite orientation.
    LEAFLESS_DEFECT_DUPLICATE = 2,
    LEAFLESS_DEFECT_NON_MANIFOLD = 3,  ///< Edges that more than two triangles use. They are harmless.
    LEAFLESS_DEFECT_FLAT = 4,  ///< Triangles without area. They are harmless.
};

/// A defective part of a mesh: one loop around a hole, or, for the other kinds, edges or triangles that are
/// connected by common vertices.
typedef struct leafless_mesh_defect {
    double min_model[3];  ///< Lower corner of the bounding box of its vertices.
    double max_model[3];  ///< Upper corner of the bounding box of its vertices.
    double length_model;  ///< Total length of the edges, in model units; 0 for kinds that count triangles.
    /// Number of edges; for LEAFLESS_DEFECT_DUPLICATE and LEAFLESS_DEFECT_FLAT number of triangles.
    uint64_t count;
    leafless_defect kind;  ///< The kind of defect.
} leafless_mesh_defect;

/// Returns one more reference to a mesh.
///
/// - Buffers: `mesh`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `mesh`.
/// - Ownership: release each reference with leafless_mesh_free.
leafless_status leafless_mesh_ref(const leafless_mesh *mesh, leafless_mesh **reference);

/// Releases a reference to a mesh; the last release frees the mesh. Solids made of it stay.
///
/// - Buffers: `mesh`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
void leafless_mesh_free(leafless_mesh *mesh);

/// Basic facts about a mesh.
typedef struct leafless_mesh_info {
    uint32_t struct_size;  ///< sizeof(leafless_mesh_info).
    /// Number of attributes of its triangles; leafless_mesh_peek_attribute_at describes each.
    uint32_t attributes;
    uint64_t vertices;  ///< Vertices.
    uint64_t triangles;  ///< Triangles.
    /// Bytes of memory that the mesh keeps: its arrays and attributes, and the analysis of its edges if it
    /// was computed. Memory that meshes and solids share counts for each of them.
    uint64_t bytes;
    /// Largest distance between the true boundary and the mesh, as stated by leafless_mesh_with_deviation.
    double deviation_model;
    /// Largest distance between the true boundary and the mesh along an axis: the deviation, plus the
    /// displacement that closed hair cracks, plus the rounding of a placement.
    double displacement_model;
} leafless_mesh_info;

/// Returns basic facts about a mesh. O(1), but for the names of attributes.
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
leafless_status leafless_mesh_describe(const leafless_mesh *mesh, leafless_mesh_info *info);

/// Copies the arrays of a mesh; leafless_mesh_describe returns their lengths.
///
/// - Buffers: `vertices`, room for `vertex_capacity` vertices of 3 numbers; `triangles`, room for
///   `triangle_capacity` triangles of 3 indices. Each may be NULL if it is not wanted.
/// - Result: both arrays.
/// - Errors: LEAFLESS_E_BUFFER if a capacity is too small; then neither is written.
leafless_status leafless_mesh_copy(const leafless_mesh *mesh, double *vertices, uint64_t vertex_capacity,
    uint32_t *triangles, uint64_t triangle_capacity);

/// Computes the unit normals at the vertices of a mesh. They point outward where triangles turn
/// counter-clockwise as seen from outside. A normal is the mean of the normals of the adjacent triangles,
/// each weighted by its angle at the vertex, so it does not depend on the triangulation of plane parts. Where
/// the mean is zero, as at a vertex without triangles, the normal is zero. O(t + v).
///
/// - Buffers: `normals`, room for `capacity` normals of 3 numbers, or NULL to get only their number; `count`,
///   one number.
/// - Result: `*count`, the number of vertices; the normals, in the order of the vertices.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_NO_MEMORY.
/// - Threads: any. Each call computes them.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_normals(const leafless_mesh *mesh, double *normals, uint64_t capacity,
    uint64_t *count);

/// Returns the bounding box of a mesh's triangles.
///
/// - Buffers: `min_model` and `max_model`, room for 3 numbers each.
/// - Result: both corners.
/// - Errors: LEAFLESS_E_MESH if the mesh has no triangle.
leafless_status leafless_mesh_bounds(const leafless_mesh *mesh, double min_model[3], double max_model[3]);

/// Returns the volume that a mesh encloses, by the divergence theorem: overlaps count twice, inside-out
/// bodies count negative. For an open mesh it has no meaning. The result is rounded; an octree provides a
/// certified volume.
///
/// - Buffers: `volume_model`, one number.
/// - Result: `*volume_model`, in cubic model units.
leafless_status leafless_mesh_volume(const leafless_mesh *mesh, double *volume_model);

/// Returns the sum of the areas of a mesh's triangles. The result is rounded; leafless_solid_surface_area
/// returns the certified area of a solid's boundary. O(t).
///
/// - Buffers: `area_model`, one number.
/// - Result: `*area_model`, in square model units.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_area(const leafless_mesh *mesh, double *area_model);

/// Reports the import of a mesh and the connectivity of its triangles. The first call analyses the edges and
/// searches for overlapping bodies; later calls take no time.
///
/// - Buffers: `report`, one struct.
/// - Result: `*report`.
/// - Errors: LEAFLESS_E_NO_MEMORY.
leafless_status leafless_mesh_inspect(const leafless_mesh *mesh, leafless_mesh_report *report);

/// Lists the defects of a mesh, the worst first: in the order of leafless_defect, and within a kind by the
/// longest side of their boxes, then by count, then by position.
///
/// - Buffers: `defects`, room for `capacity` of them, or NULL to get only their number.
/// - Result: `*count`, the number of defects, but not more than `limit`; the worst ones in `defects`.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_NO_MEMORY.
/// - Threads: any. Each call analyses the mesh.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_defects(const leafless_mesh *mesh, uint64_t limit,
    leafless_mesh_defect *defects, uint64_t capacity, uint64_t *count);

/// Checks that a mesh has no hole, so that every point off the surface is inside or outside. An even number
/// of triangles must meet at every edge and, except for LEAFLESS_FILL_EVEN_ODD, half of them must use it in
/// each direction. Self-intersections, overlaps, nested and inside-out bodies are all allowed. The mesh of a
/// solid need not pass this check.
///
/// - Buffers: none. `fill` is a leafless_fill.
/// - Result: LEAFLESS_OK if the mesh passes.
/// - Errors: LEAFLESS_E_MESH if the mesh is empty, not closed, or (except for LEAFLESS_FILL_EVEN_ODD) not
///   consistently oriented; LEAFLESS_E_ARGUMENT if `fill` is not a leafless_fill; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_check_closed(const leafless_mesh *mesh, leafless_fill fill);

/// Returns the mesh with hair cracks closed. Two vertices at open edges are merged if their distance is at
/// most 2^-24 of the longest extent of the larger of their pieces. (A piece is a set of triangles that are
/// connected by common vertices.) Verdicts about solids made of the mesh stay proven, because they allow for
/// the displacement.
///
/// - Buffers: `sewn`, one pointer.
/// - Result: `*sewn`; leafless_mesh_inspect reports how many vertices moved and how far.
/// - Errors: LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` is unchanged; release `*sewn` with leafless_mesh_free.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_sewn(const leafless_mesh *mesh, leafless_mesh **sewn);

/// Returns the same mesh with a stated deviation: the true boundary is known only to lie within this distance
/// of the mesh, as the boundary of a part lies near a tessellation with that deflection. The new deviation
/// replaces an earlier one.
///
/// The assumption: the boundary of the true solid is the mesh's surface after a continuous displacement of
/// each point by at most this distance, without inverting any part. A dent, a hole or a body that the mesh
/// lacks is not covered, however small it is. Everything proven about solids made of the mesh is then proven
/// about the true solid: cells near the triangles are undecided, intervals contain the truth, and a point too
/// close to the surface gets no verdict. The area of the true boundary is not known. Placements and set
/// operations keep the deviation, and leafless_proof reports it. Results that are not proofs describe the
/// mesh itself: a sampled octree, a tri-dexel model, a picture, leafless_mesh_bounds and
/// leafless_mesh_volume.
///
/// - Buffers: `stated`, one pointer.
/// - Result: `*stated`; leafless_mesh_describe returns its deviation. A solid of it needs a closed mesh, and
///   is refused with LEAFLESS_E_MESH otherwise.
/// - Errors: LEAFLESS_E_ARGUMENT unless `deviation_model` is finite, not negative, and at most 2^256;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` is unchanged; release `*stated` with leafless_mesh_free.
/// - Untrusted input: any number.
leafless_status leafless_mesh_with_deviation(const leafless_mesh *mesh, double deviation_model,
    leafless_mesh **stated);

/// Returns the mesh under an affine map: x' = M x + t, rounded. A reflection turns the mesh inside out. The
/// moved vertices count as exact: the displacement of closed cracks and a stated deviation are dropped.
/// leafless_solid_placed keeps both.
///
/// - Buffers: `matrix`, 12 numbers: three rows of M and t, (m00 m01 m02 t0, m10 …); `moved`, one pointer.
/// - Result: `*moved`, welded as by leafless_mesh_new.
/// - Errors: LEAFLESS_E_ARGUMENT if a number of the matrix is not finite; LEAFLESS_E_MESH if a vertex leaves
///   ±2^256; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` is unchanged; release `*moved` with leafless_mesh_free.
/// - Untrusted input: any numbers.
leafless_status leafless_mesh_transformed(const leafless_mesh *mesh, const double matrix[12],
    leafless_mesh **moved);

/// Returns the mesh moved by a vector, rounded. The displacement found by leafless_mesh_sewn and a stated
/// deviation are kept.
///
/// - Buffers: `offset_model`, 3 numbers; `moved`, one pointer.
/// - Result: `*moved`.
/// - Errors: LEAFLESS_E_ARGUMENT if a number of the offset is not finite; LEAFLESS_E_MESH if a vertex leaves
///   ±2^256; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` is unchanged; release `*moved` with leafless_mesh_free.
/// - Untrusted input: any numbers.
leafless_status leafless_mesh_translated(const leafless_mesh *mesh, const double offset_model[3],
    leafless_mesh **moved);

/// The type of the coordinates of vertices.
LEAFLESS_ENUM(leafless_vertex_type, uint32_t) {
    LEAFLESS_VERTEX_TYPE_F64 = 0,  ///< double.
    LEAFLESS_VERTEX_TYPE_F32 = 1,  ///< float.
};

/// The type of the indices of vertices.
LEAFLESS_ENUM(leafless_index_type, uint32_t) {
    LEAFLESS_INDEX_TYPE_U32 = 0,  ///< uint32_t.
    LEAFLESS_INDEX_TYPE_U64 = 1,  ///< uint64_t.
    LEAFLESS_INDEX_TYPE_U16 = 2,  ///< uint16_t.
};

/// The arrays that a mesh is made of: vertices of three coordinates, and triangles of three indices. They
/// need not be aligned, and may lie among other data, such as normals, which are not read. Zero is the
/// default of every field but the first.
typedef struct leafless_mesh_arrays {
    uint32_t struct_size;  ///< sizeof(leafless_mesh_arrays).
    leafless_vertex_type vertex_type;  ///< A leafless_vertex_type.
    const void *vertices;  ///< The first vertex. May be NULL if there is none.
    uint64_t vertex_count;  ///< Number of vertices.
    /// Bytes from one vertex to the next; 0 means that they follow each other without a gap.
    uint64_t vertex_stride;
    /// The first triangle: three indices, counted from 0. NULL if there is none, or if every three
    /// consecutive vertices are a triangle.
    const void *indices;
    /// Number of triangles. If `indices` is NULL, this must be 0 or a third of `vertex_count`.
    uint64_t triangle_count;
    /// Bytes from one triangle to the next; 0 means that they follow each other without a gap.
    uint64_t triangle_stride;
    leafless_index_type index_type;  ///< A leafless_index_type.
    double scale;  ///< Factor from coordinates to model units: 2^-256 to 2^256, or 0, which means 1.
} leafless_mesh_arrays;

/// Makes a mesh from arrays. Equal vertices are welded. Triangles with two coincident corners are dropped and
/// counted. Coordinates below 2^-256 in magnitude count as zero. Seen from outside the solid, the corners of
/// a triangle turn counter-clockwise.
///
/// - Buffers: `arrays`, one struct; its arrays must not change during the call. `mesh`, one pointer.
/// - Result: `*mesh`; not checked to be closed.
/// - Errors: LEAFLESS_E_MESH if a coordinate is infinite, not a number, or beyond ±2^256, or if an index is
///   out of range, with the index of the vertex or triangle in the message, or if there are more than 2^32 -
///   1 vertices or triangles; LEAFLESS_E_ARGUMENT if a type, a stride or the scale is invalid, or if
///   `indices` is NULL and `triangle_count` is neither 0 nor a third of `vertex_count`; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the arrays are only read during the call, once and in their order, and may be freed after it,
///   because the mesh has its own copies. Release `*mesh` with leafless_mesh_free.
/// - Untrusted input: any values in the arrays.
leafless_status leafless_mesh_new(const leafless_mesh_arrays *arrays, leafless_mesh **mesh);

/// Solids with plane faces, as in a boundary representation: solids consist of shells, shells of faces, faces
/// of loops, and loops of corners.
///
/// Each level is an array of offsets into the level below, with one more offset than there are parts: part k
/// goes from offset k up to, but not including, offset k + 1. So each array begins with 0, increases, and
/// ends with the number of parts below. Loops turn counter-clockwise as seen from outside the solid's
/// material, and holes of a face against its outer loop. Corners and offsets are of one type, without gaps,
/// and need not be aligned. Zero is the default of every field but the first.
typedef struct leafless_polyhedron_arrays {
    uint32_t struct_size;  ///< sizeof(leafless_polyhedron_arrays).
    leafless_vertex_type vertex_type;  ///< A leafless_vertex_type.
    const void *vertices;  ///< The first vertex: three coordinates. May be NULL if there is none.
    uint64_t vertex_count;  ///< Number of vertices.
    /// Bytes from one vertex to the next; 0 means that they follow each other without a gap.
    uint64_t vertex_stride;
    /// The corners of all loops, one loop after the other: indices of vertices, counted from 0.
    const void *corners;
    uint64_t corner_count;  ///< Number of corners.
    /// Offsets of the loops in the corners. A loop has at least three; its last edge leads back to the first.
    const void *loops;
    uint64_t loop_count;  ///< Number of loops.
    /// Offsets of the faces in the loops: the first loop of a face is its outer one, the others are holes.
    /// NULL, with a count of 0, means that each loop is a face.
    const void *faces;
    uint64_t face_count;  ///< Number of faces.
    /// Offsets of the shells in the faces. NULL, with a count of 0, means that all faces are one shell.
    const void *shells;
    uint64_t shell_count;  ///< Number of shells.
    /// Offsets of the solids in the shells: the first shell of a solid bounds it from outside, the others are
    /// voids. NULL, with a count of 0, means that all shells are one solid.
    const void *solids;
    uint64_t solid_count;  ///< Number of solids.
    leafless_index_type index_type;  ///< A leafless_index_type: the type of corners and offsets.
    double scale;  ///< Factor from coordinates to model units: 2^-256 to 2^256, or 0, which means 1.
    /// Largest distance of corners from the plane of their face, in model units: half the distance between
    /// two planes parallel to the face that have all its corners between them. 0 means 10^-9 of the longest
    /// extent.
    double tolerance_model;
} leafless_polyhedron_arrays;

/// Checks solids with plane faces and makes a closed, consistently oriented mesh from them. If a face is not
/// exactly plane, its triangles define the surface.
///
/// Requirements: each edge of a loop occurs exactly once more in its shell, in the opposite direction. The
/// first shell of a solid encloses a positive volume; its voids enclose negative volumes inside it. Vertices
/// at equal positions stay distinct, so shells may touch. Faces that intersect and solids that overlap are
/// accepted, because a mesh is well-defined for them.
///
/// - Buffers: `arrays`, one struct; its arrays must not change during the call. `deviation_model`, one
///   number, or NULL if it is not wanted; `mesh`, one pointer.
/// - Result: `*mesh`, with the attributes `face`, `shell` and `solid` (leafless_mesh_peek_attribute_at): the
///   numbers of the parts that each triangle belongs to; `*deviation_model`, the largest distance of a corner
///   from the plane of its face.
/// - Errors: LEAFLESS_E_MESH, with the numbers of loop, face, shell or vertices in the message, if the arrays
///   are not such solids, if a coordinate is infinite, not a number, or beyond ±2^256, if there is no solid,
///   or if there are more than 2^32 - 1 of anything; LEAFLESS_E_ARGUMENT if a type, a stride, the scale or
///   the tolerance is invalid; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the arrays are only read during the call, and may be freed after it; release `*mesh` with
///   leafless_mesh_free.
/// - Untrusted input: any values in the arrays.
leafless_status leafless_mesh_from_polyhedron(const leafless_polyhedron_arrays *arrays,
    double *deviation_model, leafless_mesh **mesh);

/// Verdict on whether the moments of the enclosed volume are known from the triangles of a mesh.
LEAFLESS_ENUM(leafless_moments_verdict, uint32_t) {
    /// The moments are known, up to rounding and to the mesh's displacement.
    LEAFLESS_MOMENTS_VERDICT_KNOWN = 0,
    /// Not known: the mesh is empty, not closed, or not consistently oriented as the fill rule demands.
    LEAFLESS_MOMENTS_VERDICT_OPEN = 1,
    /// Not known: too many triangles lie too close to each other, or all triangles of a body are slivers.
    LEAFLESS_MOMENTS_VERDICT_UNDECIDED = 2,
    LEAFLESS_MOMENTS_VERDICT_INTERSECTING = 3,  ///< Not known: two triangles intersect.
};

/// Mass properties of the volume that a mesh encloses, for density 1, as in leafless_measures. Unless they
/// are known, each interval contains all numbers.
typedef struct leafless_mesh_moments {
    uint32_t struct_size;  ///< sizeof(leafless_mesh_moments).
    leafless_interval volume_model;  ///< Volume.
    leafless_interval centroid_model[3];  ///< Centroid; intervals of all numbers unless `has_centroid`.
    leafless_interval inertia_origin_model[9];  ///< Tensor of inertia about the model's origin, row by row.
    leafless_interval inertia_centroid_model[9];  ///< The same about the centroid.
    /// Indices of two triangles that intersect, if `known` is LEAFLESS_MOMENTS_VERDICT_INTERSECTING; else 0.
    uint32_t triangles[2];
    leafless_moments_verdict known;  ///< Whether the moments are known, or why not.
    bool has_centroid;  ///< Whether the volume is proven not to be 0.
} leafless_mesh_moments;

/// Two triangles with a common point that is not on a common vertex or edge.
typedef struct leafless_intersecting_pair {
    /// Lower corner of a box in which they meet: the intersection of their bounding boxes.
    double min_model[3];
    double max_model[3];  ///< Its upper corner.
    uint32_t triangles[2];  ///< Indices of the triangles, ascending.
} leafless_intersecting_pair;

/// Computes the volume and the moments of the region that a mesh encloses by a fill rule, exact up to
/// rounding: usually to 14 digits. They are known if the mesh is closed and no two triangles intersect.
/// leafless_solid_measure returns the same for a solid of such a mesh.
///
/// - Buffers: `options`, one struct or NULL (its limits are ignored); `moments`, one struct. `fill` is a
///   leafless_fill.
/// - Result: `*moments`, written whether they are known or not.
/// - Errors: LEAFLESS_E_ARGUMENT if `fill` is not a leafless_fill; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Threads: any; works in the calling thread. Each call analyses the mesh.
/// - Untrusted input: any mesh; the work is limited.
leafless_status leafless_mesh_measure(const leafless_mesh *mesh, leafless_fill fill,
    const leafless_options *options, leafless_mesh_moments *moments);

/// Finds the pairs of triangles that intersect: they cross, touch, or fold onto each other. The test is
/// exact. Triangles without area are left out.
///
/// - Buffers: `options`, one struct or NULL (its limits are ignored); `pairs`, room for `capacity` of them,
///   or NULL to get only their number; `count`, one number; `is_complete`, one number.
/// - Result: `*count`, the number of pairs found; the first `capacity` of them in `pairs`, in ascending order
///   of triangles; `*is_complete`, false if the search stopped because too many triangles lie close to each
///   other.
/// - Errors: LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY. A `capacity` that is too small is not an error.
/// - Threads: any; works in the calling thread. Each call analyses the mesh.
/// - Untrusted input: any mesh; the work is limited.
leafless_status leafless_mesh_intersecting_pairs(const leafless_mesh *mesh, const leafless_options *options,
    leafless_intersecting_pair *pairs, uint64_t capacity, uint64_t *count, bool *is_complete);

/* ---- 8. Mesh files ------------------------------------------------------------------------------------ */

/// The formats of mesh files that can be read and written.
LEAFLESS_ENUM(leafless_mesh_format, uint32_t) {
    /// To be detected: when reading, from the file's content and, if that is ambiguous, its name; when
    /// writing, from its name.
    LEAFLESS_MESH_FORMAT_ANY = 0,
    LEAFLESS_MESH_FORMAT_STL = 1,  ///< STL, binary or ASCII; which of the two is always detected.
    LEAFLESS_MESH_FORMAT_OBJ = 2,  ///< Wavefront OBJ.
    LEAFLESS_MESH_FORMAT_PLY = 3,  ///< Stanford PLY, binary or ASCII.
    LEAFLESS_MESH_FORMAT_OFF = 4,  ///< Geomview OFF.
    /// 3MF, the 3D Manufacturing Format. Its surfaces follow LEAFLESS_FILL_POSITIVE.
    LEAFLESS_MESH_FORMAT_3MF = 5,
};

/// Units of length. Coordinates have no unit: the host decides the meaning of an unknown unit.
LEAFLESS_ENUM(leafless_unit, uint32_t) {
    LEAFLESS_UNIT_UNKNOWN = 0,  ///< Not known.
    LEAFLESS_UNIT_MICROMETRE = 1,  ///< 1/1000 of a millimetre.
    LEAFLESS_UNIT_MILLIMETRE = 2,  ///< The millimetre.
    LEAFLESS_UNIT_CENTIMETRE = 3,  ///< 10 millimetres.
    LEAFLESS_UNIT_METRE = 4,  ///< 1000 millimetres.
    LEAFLESS_UNIT_INCH = 5,  ///< 25.4 millimetres.
    LEAFLESS_UNIT_FOOT = 6,  ///< 12 inches.
};

/// Options of reading a mesh file. NULL means the defaults. Zero is the default of every field but the first.
typedef struct leafless_mesh_options {
    uint32_t struct_size;  ///< sizeof(leafless_mesh_options).
    leafless_mesh_format format;  ///< The file's format.
    /// The unit of the numbers in the file. LEAFLESS_UNIT_UNKNOWN means the unit that the file states (only
    /// 3MF files do); any other value overrides it.
    leafless_unit unit;
    /// The unit of the resulting mesh. LEAFLESS_UNIT_UNKNOWN means the unit of the file.
    leafless_unit target;
    double scale;  ///< Additional factor for all coordinates: 2^-256 to 2^256, or 0, which means 1.
} leafless_mesh_options;

/// Facts that a mesh file states besides the mesh.
typedef struct leafless_mesh_file_info {
    uint32_t struct_size;  ///< sizeof(leafless_mesh_file_info).
    leafless_mesh_format format;  ///< The file's format.
    leafless_unit unit;  ///< The unit of the mesh after conversion and before scaling, if it is known.
    /// Number of instances of objects that are not meant to be solid, such as supports in a 3MF. The mesh
    /// does not contain them.
    uint64_t skipped;
    /// Largest distance between the true boundary and the mesh according to the file, converted and scaled; 0
    /// if the file does not state it. The library does not rely on it; to rely on it, state it with
    /// leafless_mesh_with_deviation.
    double deviation_model;
} leafless_mesh_file_info;

/// Reads a mesh file. Everything in it becomes one mesh, welded as by leafless_mesh_new; polygons become
/// triangles. Hair cracks, which come from rounded numbers in files, are closed as by leafless_mesh_sewn;
/// leafless_mesh_inspect reports how many vertices moved and how far. Bytes in memory have no name, so their
/// format is detected from the content only.
///
/// - Buffers: `source`, one struct, with LEAFLESS_ACCESS_COPY; `options`, one struct, or NULL; `found`, one
///   struct, or NULL if it is not wanted; `mesh`, one pointer.
/// - Result: `*mesh`, not checked to be closed; `*found`. leafless_mesh_peek_warning_at returns the
///   violations of the format that did not prevent reading.
/// - Errors: LEAFLESS_E_MESH_FILE, with the part, line, facet or byte in the message, if the file cannot be
///   read, if its format is not known, or if `target` is given and neither `unit` nor the file states a unit;
///   LEAFLESS_E_MESH, with the vertex, if a coordinate is beyond ±2^256 once it is scaled;
///   LEAFLESS_E_ARGUMENT if the format or a unit is invalid, or the scale is out of range; LEAFLESS_E_IO;
///   LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*mesh` with leafless_mesh_free.
/// - Untrusted input: any file. Memory is at most a small multiple of its length. For a 3MF, which is
///   compressed, it is at most a small multiple of 64 times its length plus 16 MiB, and its instances may
///   have up to 2^25 vertices and 2^25 triangles, or as many as the file has.
leafless_status leafless_mesh_read(const leafless_source *source, const leafless_mesh_options *options,
    leafless_mesh_file_info *found, leafless_mesh **mesh);

/// Returns one of the warnings from reading a mesh file, by its index: a sentence in UTF-8 for each kind of
/// violation of the format that did not prevent reading. A mesh that was not read from a file, or was made
/// from another mesh, has none.
///
/// - Buffers: `count`, one number; `warning`, `warning_length`, one each, both NULL to get only the count.
/// - Result: `*count`, the number of all warnings; the text, not NUL-terminated, with its length in bytes.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no warning `index`, unless only the count is requested.
/// - Ownership: the text belongs to the mesh and lives as long as the reference `mesh`.
leafless_status leafless_mesh_peek_warning_at(const leafless_mesh *mesh, uint64_t index, uint64_t *count,
    const char **warning, size_t *warning_length);

/// Options of writing a mesh file. NULL means the defaults. Zero is the default of every field but the first.
typedef struct leafless_mesh_write_options {
    uint32_t struct_size;  ///< sizeof(leafless_mesh_write_options).
    /// The file's format. LEAFLESS_MESH_FORMAT_ANY means the format of the path's extension: .stl, .obj,
    /// .ply, .off or .3mf, in any letter case.
    leafless_mesh_format format;
    /// 1 to write STL and PLY as text, which is several times as long; else 0. OBJ and OFF are always text;
    /// 3MF never is.
    uint32_t is_text;
    /// The unit of the coordinates, which only a 3MF stores. LEAFLESS_UNIT_UNKNOWN means the millimetre.
    /// Coordinates are not converted.
    leafless_unit unit;
    /// 1 to write PLY and OBJ with the normals of leafless_mesh_normals, which other formats do not store;
    /// else 0.
    uint32_t has_normals;
    /// Largest distance between the true boundary and the mesh; 0 means that it is not stated. It is stored
    /// in a comment of PLY, OBJ and OFF files and in the metadata of a 3MF; an STL cannot store it. When the
    /// file is read, leafless_mesh_file_info contains it.
    double deviation_model;
} leafless_mesh_write_options;

/// Writes a mesh file: STL, PLY, OBJ, OFF or 3MF.
///
/// Vertices and triangles keep their order. PLY (little-endian, of type double), OBJ and OFF hold the
/// coordinates exactly; a 3MF has one object, which is the build's one item, and leaves out triangles that
/// have a vertex twice. STL rounds coordinates to 32 bits silently: a mesh that is small and far from the
/// origin loses triangles, up to all of them. leafless_mesh_written_form shows the loss beforehand, and
/// leafless_mesh_in_single_precision avoids it as far as possible. O(n) time and memory.
///
/// - Buffers: `options`, one struct, or NULL, with a format unless the sink has a path; `sink`, one struct.
/// - Errors: LEAFLESS_E_ARGUMENT if the format or the unit is invalid, if the format is
///   LEAFLESS_MESH_FORMAT_ANY and there is no path or the path has none of the extensions, for an STL of
///   coordinates beyond the range of float, or for an OBJ without vertices; LEAFLESS_E_IO;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_BUFFER; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_write(const leafless_mesh *mesh, const leafless_mesh_write_options *options,
    const leafless_sink *sink);

/// A report of leafless_mesh_in_single_precision.
typedef struct leafless_single_precision {
    uint32_t struct_size;  ///< sizeof(leafless_single_precision).
    uint32_t reserved;  ///< Reserved; 0.
    double rounding_model;  ///< Largest displacement of a vertex along an axis by rounding, in model units.
    /// Proven bound of the distance between the two meshes, in model units: no point of either mesh is
    /// further from the other mesh.
    double deviation_model;
    uint64_t collapsed;  ///< Triangles that rounding turned into an edge or a point; they were removed.
    uint64_t flipped;  ///< Triangles that rounding turned into a line; they were joined to their neighbours.
    uint64_t moved;  ///< Vertices that were moved to representable positions next to their nearest ones.
    /// Triangles without area and vertices at the position of another vertex that remain.
    uint64_t degenerate;
    uint64_t intersecting_pairs;  ///< Pairs of intersecting triangles that remain.
} leafless_single_precision;

/// Returns the mesh with 32-bit coordinates, as in an STL. As far as possible, it removes the triangles that
/// rounding makes degenerate and the intersections that rounding causes: leafless_mesh_write then loses
/// nothing. Edges whose ends coincide are collapsed, and triangles that become lines are joined to their
/// neighbours. Vertices of triangles that are then still degenerate or intersect move to neighbouring
/// representable positions, if these are no further than `tolerance_model` from the given positions. A closed
/// mesh stays closed. A mesh whose coordinates already are 32-bit numbers is returned unchanged, and nothing
/// is counted.
///
/// It takes a few times as long as leafless_mesh_intersecting_pairs.
///
/// - Buffers: `options`, one struct or NULL; `report`, one struct, or NULL if it is not wanted; `single`, one
///   pointer.
/// - Result: `*single`, without attributes; `*report`.
/// - Errors: LEAFLESS_E_ARGUMENT if the tolerance is negative or not a number, or for coordinates beyond the
///   range of float; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` is unchanged; release `*single` with leafless_mesh_free.
/// - Untrusted input: any mesh; the work is bounded.
leafless_status leafless_mesh_in_single_precision(const leafless_mesh *mesh, double tolerance_model,
    const leafless_options *options, leafless_single_precision *report, leafless_mesh **single);

/// Writes solids with plane faces as a file of polygons: OBJ or OFF. A face with holes, which these formats
/// cannot store, is cut into a few polygons without holes; all other faces are written as given. No vertex is
/// added, and vertices keep their order.
///
/// The faces are checked as in leafless_mesh_from_polyhedron, always with its default tolerance. O(n log n)
/// time.
///
/// - Buffers: `arrays`, one struct, whose `tolerance_model` is 0; its arrays must not change during the call.
///   `options`, one struct, or NULL (only the format and the deviation are used), with a format unless the
///   sink has a path; `sink`, one struct.
/// - Errors: those of leafless_mesh_from_polyhedron; LEAFLESS_E_ARGUMENT if the format is neither OBJ nor
///   OFF, or is LEAFLESS_MESH_FORMAT_ANY and there is no path or the path has none of the extensions;
///   LEAFLESS_E_IO; LEAFLESS_E_CALLBACK; LEAFLESS_E_BUFFER; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the arrays are only read during the call, and may be freed after it.
/// - Untrusted input: any values in the arrays.
leafless_status leafless_mesh_write_polygons(const leafless_polyhedron_arrays *arrays,
    const leafless_mesh_write_options *options, const leafless_sink *sink);

/// Returns the mesh that a reader gets from the file that leafless_mesh_write writes. An STL has 32-bit
/// coordinates: vertices move, vertices that coincide are merged, and triangles with coincident corners are
/// dropped, so that the surface may be pinched, flat or empty. Compare leafless_mesh_inspect of both meshes
/// to see the loss. All other formats keep vertices and triangles unchanged. O(n) time and memory.
///
/// - Buffers: `options`, one struct, with a format; `kept`, one pointer.
/// - Result: `*kept`.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_mesh_write without a path; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` is unchanged; release `*kept` with leafless_mesh_free.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_written_form(const leafless_mesh *mesh,
    const leafless_mesh_write_options *options, leafless_mesh **kept);

/* ---- 9. Solids ---------------------------------------------------------------------------------------- */

/// A set operation on several operands.
LEAFLESS_ENUM(leafless_operation, uint32_t) {
    LEAFLESS_OPERATION_UNION = 0,  ///< The points of at least one operand.
    LEAFLESS_OPERATION_INTERSECTION = 1,  ///< The points that all operands have in common.
    LEAFLESS_OPERATION_DIFFERENCE = 2,  ///< The points of the first operand that lie in none of the others.
    /// The points that lie in an odd number of operands: for two operands, in exactly one.
    LEAFLESS_OPERATION_XOR = 3,
};

/// Makes a solid from the region that a mesh encloses. On a frame whose universe does not hold the mesh, the
/// solid is clipped by the universe.
///
/// For a closed mesh, the inside is exact. Around holes, the convention of leafless_fill decides whether a
/// point is inside: a cell is FULL or EMPTY if that is proven for all of its points; other cells are PARTIAL
/// though no triangle cuts them. leafless_mesh_inspect reports whether to expect such cells.
///
/// Queries of rays, points, boxes and distances need no cells and take some microseconds each. For a mesh
/// with holes a query visits all edges of the holes, at some nanoseconds an edge. It uses cells for rays that
/// come very near to such an edge, for distances and boxes next to a hole, and, if there are more than 16384
/// such edges, for all queries except points. The first query builds data that the solid keeps: a tree over
/// the triangles (O(t log t): 0.1 to 0.3 microseconds a triangle; 36 bytes a triangle, which
/// leafless_solid_info includes); for distances of a closed mesh also the sides of its triangles on which the
/// solid lies (about twice that time, and 1 byte a triangle); or the edges of holes (48 bytes an edge). If
/// the first query must not take longer than others, make one query beforehand. Placed solids take over the
/// order of the tree and compute its boxes anew. Threads that make the first query at the same time may each
/// build the data once.
///
/// - Buffers: `solid`, one pointer. `fill` is a leafless_fill.
/// - Result: `*solid`. Time is linear in the mesh (n log n in the edges of its boundary).
/// - Errors: LEAFLESS_E_MESH if the mesh is empty, or (LEAFLESS_FILL_EVEN_ODD) an odd number of triangles
///   meet on an edge; LEAFLESS_E_ARGUMENT if `fill` is not a leafless_fill; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the solid shares the mesh, which may be freed; release `*solid` with leafless_solid_free.
/// - Untrusted input: any mesh.
leafless_status leafless_solid_from_mesh(const leafless_mesh *mesh, leafless_fill fill,
    leafless_solid **solid);

/// Makes a solid from a stored octree, on the octree's universe. An octree built from it to fewer levels is
/// cut off there; in one built to more levels its PARTIAL cells stay undecided.
///
/// - Buffers: `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: only the general ones; building from it returns LEAFLESS_E_DAMAGED if the octree was mapped
///   unverified and its links are damaged.
/// - Ownership: the solid shares the octree, which may be freed; release `*solid` with leafless_solid_free.
/// - Untrusted input: any octree.
leafless_status leafless_solid_from_octree(const leafless_octree *octree, leafless_solid **solid);

/// Basic facts about a solid.
typedef struct leafless_solid_info {
    uint32_t struct_size;  ///< sizeof(leafless_solid_info).
    /// Number of evaluations of half-spaces so far, each at a point or over a box, for a solid that contains
    /// half-spaces (see leafless_solid_new_halfspace and the functions after it). It counts calls that have
    /// returned, and lazy octrees and similar objects that were freed. Solids made from this solid count
    /// separately. 0 for solids of other kinds.
    uint64_t evaluations;
    /// Approximate number of bytes of memory (or of mapped files) that the solid keeps alive: its own, those
    /// of the meshes, octrees and samples that it shares, and those of the last frame that it was prepared
    /// for. An expression counts each of its parts once, but two parts that share a mesh count the mesh
    /// twice. Objects of the host are not counted.
    uint64_t bytes;
} leafless_solid_info;

/// Returns basic facts about a solid. O(1), but O(n) in the parts of an expression.
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
/// - Untrusted input: any solid.
leafless_status leafless_solid_describe(const leafless_solid *solid, leafless_solid_info *info);

/// Returns one more reference to a solid.
///
/// - Buffers: `solid`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `solid`.
/// - Ownership: release each reference with leafless_solid_free.
leafless_status leafless_solid_ref(const leafless_solid *solid, leafless_solid **reference);

/// Releases a reference to a solid; the last release frees the solid. Octrees built from it stay.
///
/// - Buffers: `solid`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
void leafless_solid_free(leafless_solid *solid);

/// The rule of touching: whether a cell that meets the boundary of an expression of half-spaces, but not its
/// interior, is EMPTY.
LEAFLESS_ENUM(leafless_touch, uint32_t) {
    LEAFLESS_TOUCH_EXACT = 0,  ///< Contact is not overlap: a cell is EMPTY if the interiors are disjoint.
    /// A vertex on the surface counts as inside, so that a cell that touches a primitive with a vertex from
    /// outside is PARTIAL. This rule reproduces published tables and has no other advantage.
    LEAFLESS_TOUCH_PAPER = 1,
};

/// Makes the ball of all points at most `radius` from `centre`. Its verdicts are exact.
///
/// - Buffers: `centre_model`, 3 numbers; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if the radius is not between 2^-256 and 2^256, or a coordinate neither 0 nor
///   of such a magnitude.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_ball(const double centre_model[3], double radius_model,
    leafless_solid **solid);

/// Makes the box [min, max] with faces parallel to the lattice. Its verdicts are exact, so a face on a
/// lattice plane leaves nothing undecided.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if min ≥ max on an axis, or a coordinate is neither 0 nor of a magnitude
///   between 2^-256 and 2^256.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_box(const double min_model[3], const double max_model[3],
    leafless_solid **solid);

/// Makes the half-space of the points p with normal · p + offset ≥ 0. Its verdicts are exact.
///
/// - Buffers: `normal`, 3 numbers, of any length and pointing into the solid; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if the normal is zero, or a coefficient neither 0 nor of a magnitude between
///   2^-256 and 2^256.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_halfspace(const double normal[3], double offset, leafless_solid **solid);

/// Makes the quadric of the points p with a x² + b y² + c z² + d xy + e yz + f zx + g x + h y + i z + j ≥ 0.
/// The ten coefficients are a to j. Its signs are exact.
///
/// - Buffers: `coefficients`, 10 numbers; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if all coefficients but the last are 0, or one is neither 0 nor of a
///   magnitude between 2^-256 and 2^256.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_quadric(const double coefficients[10], leafless_solid **solid);

/// Makes the ellipsoid around `centre` with the semi-axes `radii` along x, y and z, moved by `matrix` unless
/// that is NULL. The surface has exact coefficients. Its verdicts are exact, too, unless `matrix` rotates it.
///
/// - Buffers: `centre_model` and `radii_model`, 3 numbers each; `matrix`, 12 numbers as for
///   leafless_solid_placed, or NULL; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if a radius is not between 2^-256 and 2^256, or a coordinate neither 0 nor
///   of such a magnitude; for `matrix` as leafless_solid_placed.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_ellipsoid(const double centre_model[3], const double radii_model[3],
    const double matrix[12], leafless_solid **solid);

/// Makes the cylinder of `radius` around the segment between two points, with flat ends through the points.
/// The axis may have any direction. Nothing is rounded: the surface has exact coefficients. If the axis is
/// parallel to x, y or z, the verdicts are exact, too.
///
/// - Buffers: `from_model` and `to_model`, 3 numbers each; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if the points are equal, the radius is not between 2^-256 and 2^256, or a
///   coordinate neither 0 nor of such a magnitude.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_cylinder(const double from_model[3], const double to_model[3],
    double radius_model, leafless_solid **solid);

/// Makes the frustum of a cone around the segment between two points, with the radius `from_radius` at `from`
/// and `to_radius` at `to`. One of the radii may be 0, which makes a cone. It is as exact as
/// leafless_solid_new_cylinder.
///
/// - Buffers: `from_model` and `to_model`, 3 numbers each; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if the points are equal, if both radii are 0 or one is not between 2^-256
///   and 2^256, or a coordinate neither 0 nor of such a magnitude.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_frustum(const double from_model[3], const double to_model[3],
    double from_radius_model, double to_radius_model, leafless_solid **solid);

/// Makes the solid of the points p with A (x − a)^n + B (y − b)^m + C (z − c)^k + `constant` ≥ 0. Its signs
/// are exact.
///
/// - Buffers: `coefficients` A, B, C, `centre_model` a, b, c, and `exponents` n, m, k, 3 numbers each;
///   `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if all coefficients are 0, an exponent is not 1 to 64, or a number neither 0
///   nor of a magnitude between 2^-256 and 2^256.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_power(const double coefficients[3], const double centre_model[3],
    const uint32_t exponents[3], double constant, leafless_solid **solid);

/// Makes the torus around the axis through `centre` in the direction `axis`, of any length: all points at
/// most `minor` from the circle of radius `major` around the centre. If `minor` is greater than `major`,
/// there is no hollow core. If the axis is parallel to x, y or z, nothing is rounded. Otherwise its direction
/// is rounded to double precision.
///
/// - Buffers: `centre_model` and `axis`, 3 numbers each; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if the axis is zero, a radius is not between 2^-256 and 2^256, or a
///   coordinate neither 0 nor of such a magnitude; `major` may be 0, which makes a ball.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_torus(const double centre_model[3], const double axis[3],
    double major_model, double minor_model, leafless_solid **solid);

/// Makes the right angular wedge of STEP (ISO 10303-42): the box between the origin and `size` whose face at
/// the greatest y is narrowed, or widened, to 0 ≤ x ≤ `top`; 0 makes that face an edge. `matrix` moves it
/// without rounding.
///
/// - Buffers: `size_model`, 3 numbers; `matrix`, 12 numbers as for leafless_solid_placed, or NULL; `solid`,
///   one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if a size, or `top` unless it is 0, is not between 2^-256 and 2^256; for
///   `matrix` as leafless_solid_placed.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_wedge(const double size_model[3], double top_model,
    const double matrix[12], leafless_solid **solid);

/// Makes the prism over a simple polygon in the xy plane, between z = `low` and z = `high`. The polygon's
/// corners are given in order, in either direction of rotation; the last corner is joined to the first. The
/// planes through its edges are exact. `matrix` moves it without rounding.
///
/// - Buffers: `polygon_model`, `count` points of 2 numbers each; `matrix`, 12 numbers as for
///   leafless_solid_placed, or NULL; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if the outline touches or crosses itself or encloses nothing, a coordinate
///   is neither 0 nor of a magnitude between 2^-256 and 2^256, or `low` is not less than `high`; for `matrix`
///   as leafless_solid_placed; LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_prism(const double *polygon_model, uint64_t count, double low_model,
    double high_model, const double matrix[12], leafless_solid **solid);

/// Makes the convex polyhedron of the points p with normal · p + offset ≥ 0 for all planes. It may be
/// unbounded or empty.
///
/// - Buffers: `planes`, `count` of 4 numbers each: the normal, of any length and pointing inward, and the
///   offset; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no plane, a normal is zero, or a number neither 0 nor of a
///   magnitude between 2^-256 and 2^256; LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_convex(const double *planes, uint64_t count, leafless_solid **solid);

/// Combines solids by a set operation. Without operands, the union and the xor are empty, and the
/// intersection is all of space. No octree is built: the result queries its operands for each cell, and
/// expressions of half-spaces are joined into one expression.
///
/// - Buffers: `solids`, `count` handles, or NULL if there is none; `result`, one pointer. `operation` is a
///   leafless_operation.
/// - Result: `*result`.
/// - Errors: LEAFLESS_E_NULL, also of an element; LEAFLESS_E_ARGUMENT, also if `count` is 0 for a difference;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: the operands are shared and may be freed; release `*result` with leafless_solid_free.
/// - Untrusted input: any solids.
leafless_status leafless_solid_combine(leafless_operation operation, const leafless_solid *const *solids,
    uint64_t count, leafless_solid **result);

/// Makes the complement of a solid: the points that `operand` does not contain. A solid and its complement
/// share their boundary.
///
/// - Buffers: `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_NULL.
/// - Ownership: the operand is shared and may be freed; release `*solid` with leafless_solid_free.
/// - Untrusted input: any solids.
leafless_status leafless_solid_complement(const leafless_solid *operand, leafless_solid **solid);

/// The effect of an affine map on the precision of a solid.
LEAFLESS_ENUM(leafless_motion, uint32_t) {
    LEAFLESS_MOTION_EXACT = 0,  ///< Nothing is rounded: half-spaces and expressions of them.
    /// The vertices of a mesh are moved and rounded, by some 10^-16 of their coordinates; all proofs allow
    /// for that.
    LEAFLESS_MOTION_VERTICES = 1,
    /// A surface that is not parallel to the lattice blurs by about a cell, as with
    /// leafless_solid_transformed on a frame that is chosen for the solid. A host's shape is queried for
    /// boxes around the inverse images of cells. If the map takes cells to cells, nothing blurs.
    LEAFLESS_MOTION_CONSERVATIVE = 2,
};

/// Makes a solid moved by an affine map, in the best way for its kind: half-spaces exactly, meshes by their
/// vertices, others as by leafless_solid_transformed. Each part of an expression is moved in its own way.
///
/// - Buffers: `matrix`, 12 numbers, the rows of [M | t], where a point p goes to M p + t; `motion`, one
///   leafless_motion or NULL; `solid`, one pointer.
/// - Result: `*solid`; `*motion`, the worst effect of the map on any part (the identity has no effect).
/// - Errors: LEAFLESS_E_ARGUMENT if an entry is neither 0 nor of a magnitude between 2^-64 and 2^64, or M is
///   singular; LEAFLESS_E_MESH if a vertex leaves the range of coordinates of meshes, ±2^256;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: the operand is shared and may be freed; release `*solid` with leafless_solid_free.
/// - Untrusted input: any solids and numbers.
leafless_status leafless_solid_placed(const leafless_solid *operand, const double matrix[12],
    leafless_motion *motion, leafless_solid **solid);

/// Makes a solid whose cells are not split where its surface is known to lie within a layer no thicker than a
/// tolerance: an octree of it stays coarse where the surface is flat. Such cells stay PARTIAL. Half-spaces
/// provide such layers; a solid that provides none is split as usual.
///
/// - Result: `*solid`, a new solid.
/// - Errors: LEAFLESS_E_ARGUMENT if `tolerance_model` is negative or not a number; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the operand is shared and may be freed; release `*solid` with leafless_solid_free.
/// - Untrusted input: any solid.
leafless_status leafless_solid_adaptive(const leafless_solid *operand, double tolerance_model,
    leafless_solid **solid);

/// Makes the same solid with another rule of touching, which holds for the whole expression. An expression
/// that joins it to other solids follows its own rule.
///
/// - Buffers: `solid`, one pointer. `touch` is a leafless_touch.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_NULL; LEAFLESS_E_ARGUMENT if `touch` is not a leafless_touch.
/// - Ownership: the operand is shared and may be freed; release `*solid` with leafless_solid_free.
/// - Untrusted input: any solids.
leafless_status leafless_solid_with_touch(const leafless_solid *operand, leafless_touch touch,
    leafless_solid **solid);

/* ---- 10. Solids by functions of the host -------------------------------------------------------------- */

/// A host's promise about its shape outside the universe of the frame in use.
LEAFLESS_ENUM(leafless_exterior, uint32_t) {
    LEAFLESS_EXTERIOR_UNKNOWN = 0,  ///< No promise: the shape counts as clipped by the universe.
    LEAFLESS_EXTERIOR_EMPTY = 1,  ///< The shape ends inside the universe.
    LEAFLESS_EXTERIOR_FULL = 2,  ///< Everything outside the universe belongs to the shape.
};

/// Classifies the box [min, max] (3 numbers each, model units) for the host's own shape: Returns
/// LEAFLESS_TAG_EMPTY or LEAFLESS_TAG_FULL if that is proven for all of the box, or LEAFLESS_TAG_PARTIAL to
/// be called for its eight parts. Any other value ends the operation with LEAFLESS_E_CALLBACK and the value
/// in the message; use negative numbers for the host's own errors.
///
/// It is called from several threads at once, which may all be the library's own, unless the operation's
/// options have `threads` = 1. It must give the same answer to the same box. It must return: no exception, no
/// longjmp. It may call this library.
typedef int32_t (*leafless_classify_fn)(void *ctx, const double *min, const double *max);

/// Decides a point (3 numbers, model units) for the host's own shape: returns 1 inside, 0 outside; any other
/// value ends the operation with LEAFLESS_E_CALLBACK. Otherwise as leafless_classify_fn.
typedef int32_t (*leafless_contains_fn)(void *ctx, const double *point);

/// Classifies `count` boxes (6 numbers each: min, then max) at once, for hosts that do this faster than one
/// by one: sets `tags` to the answers of leafless_classify_fn. Returns 0, or the host's own error code, which
/// ends the operation with LEAFLESS_E_CALLBACK. Otherwise as leafless_classify_fn.
typedef int32_t (*leafless_classify_many_fn)(void *ctx, const double *boxes, uint64_t count, int32_t *tags);

/// Decides `count` points (3 numbers each) at once: sets each of `inside` to 1 or 0. Returns 0, or the host's
/// own error code. Otherwise as leafless_contains_fn.
typedef int32_t (*leafless_contains_many_fn)(void *ctx, const double *points, uint64_t count,
    int32_t *inside);

/// Bounds the distances of `count` points (3 numbers each, model units) from the surface of the host's own
/// shape. It sets each of `distances_model` to a number whose magnitude is at most that distance, negative
/// inside and positive outside; 0 or NaN proves nothing. Returns 0, or the host's own error code. Otherwise
/// as leafless_classify_fn.
typedef int32_t (*leafless_distance_many_fn)(void *ctx, const double *points, uint64_t count,
    double *distances_model);

/// Bounds of a function f of the host over a box. The shape is the set of the points where f is not positive,
/// as for a signed distance; the gradient points out of it. NaN, or lower > upper, proves nothing about the
/// box.
typedef struct leafless_gradient {
    /// An interval that contains the value of f at the middle of the box. One end may be infinite.
    leafless_interval value;
    /// For each axis, an interval that contains the partial derivative of f everywhere in the box. f must be
    /// continuous there; where it has no derivative, the interval must contain the one-sided derivatives.
    leafless_interval gradient[3];
} leafless_gradient;

/// Bounds the host's function f over the box [min, max] (3 numbers each, model units) with the centre
/// `middle` (3 numbers): sets `*gradient`, whose numbers are all NaN before. Returns 0, or the host's own
/// error code. Otherwise as leafless_classify_fn.
typedef int32_t (*leafless_gradient_fn)(void *ctx, const double *min, const double *max, const double *middle,
    leafless_gradient *gradient);

/// Two balls that touch the surface of the host's shape at a point, one inside and one outside.
///
/// Let d = y - `point` for a point y of the box, and n = `normal` divided by its length. Each y of the box
/// with n . d < -(inner_curvature / 2 |d|^2 + error) must lie in the shape, and no y with n . d >
/// outer_curvature / 2 |d|^2 + error may. So if `error` is 0, the balls have the radii 1 / `inner_curvature`
/// and 1 / `outer_curvature`. A curvature of 0 means a half-space, a negative curvature the outside of a
/// ball, and infinity nothing. The reciprocal of the surface's reach is valid for both: it is at least every
/// curvature, and at least 2 over the width of every wall or gap. NaN, or a negative error, proves nothing
/// about the box.
typedef struct leafless_tangent {
    /// The point where the balls touch (model units); best the surface's nearest point to the middle of the
    /// box.
    double point[3];
    double normal[3];  ///< The direction that points out of the shape there, of any length.
    double inner_curvature;  ///< The reciprocal of the radius of the ball inside.
    double outer_curvature;  ///< The reciprocal of the radius of the ball outside.
    /// Bound of the error of the surface (model units), from rounding in `point` and `normal`.
    double error;
} leafless_tangent;

/// Describes the position and the curvature of the surface of the host's own shape next to the middle of a
/// box: sets `*tangent`, whose numbers are all NaN before. Otherwise as leafless_gradient_fn.
typedef int32_t (*leafless_tangent_fn)(void *ctx, const double *min, const double *max, const double *middle,
    leafless_tangent *tangent);

/// Called once, when nothing uses `ctx` any more, in the thread that released the last reference. It must
/// return: no exception, no longjmp. It may call this library.
typedef void (*leafless_destroy_fn)(void *ctx);

/// The host's own shape. All fields but the first may be zero; `classify` or `distance_many` must be set.
typedef struct leafless_solid_callbacks {
    uint32_t struct_size;  ///< sizeof(leafless_solid_callbacks).
    /// A leafless_exterior: the host's promise about the space outside the universe.
    leafless_exterior exterior;
    leafless_classify_fn classify;  ///< Classifies boxes.
    leafless_contains_fn contains;  ///< Decides points: LEAFLESS_RULE_SAMPLED needs it; optional.
    leafless_destroy_fn destroy;  ///< Called when the library no longer needs `ctx`; optional.
    void *ctx;  ///< The context that the functions are called with.
    /// A number of 128 bits that identifies the shape, such as a hash of its parameters; 0 means none.
    /// Octrees from leafless_lazy_freeze store it, and only the same shape can continue them.
    uint64_t fingerprint[2];
    /// Classifies many boxes at once, as many as the operation has ready; optional. `classify` must be set as
    /// well.
    leafless_classify_many_fn classify_many;
    /// Decides many points at once; optional, with or without `contains`.
    leafless_contains_many_fn contains_many;
    /// Bounds the distances of points from the surface; optional. It is called for the middles of cells
    /// before boxes are classified. A cell whose middle is further from the surface than from its own corners
    /// is decided. If it is set, `classify` is optional.
    leafless_distance_many_fn distance_many;
    /// Bounds a function of the host over boxes; optional. It is called for undecided cells. Measures,
    /// bounding boxes and adaptive octrees need far fewer splits with it. No verdict depends on it.
    leafless_gradient_fn gradient;
    /// Describes the surface next to the middle of a box; optional. It serves the same purposes as
    /// `gradient`. If both are set, it is called where `gradient` proves nothing.
    leafless_tangent_fn tangent;
    /// A box that contains the shape: its lower and its upper corner (model units). All zero means that no
    /// box is known. In a universe that holds the box the shape ends inside, whatever `exterior` is. The box
    /// moves with the shape; for a moved shape `exterior` is ignored.
    double bounds[6];
} leafless_solid_callbacks;

/// Makes a solid from the host's own shape.
///
/// - Buffers: `callbacks`, one struct, which is copied; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_NULL if `classify` is NULL, unless `distance_many` is set and `classify_many` is not;
///   LEAFLESS_E_ARGUMENT if `exterior` is not a leafless_exterior, or `bounds` is not a box. After an error
///   `destroy` is not called.
/// - Ownership: `ctx` must live until `destroy` is called with it; release `*solid` with leafless_solid_free.
/// - Threads: any; leafless_classify_fn describes the threads that call the functions.
/// - Untrusted input: any answers.
leafless_status leafless_solid_new_callbacks(const leafless_solid_callbacks *callbacks,
    leafless_solid **solid);

/// Computes the value of the host's function at a point (3 numbers, model units): sets `*value`. Returns 0,
/// or the host's own error code, which ends the operation with LEAFLESS_E_CALLBACK. Otherwise as
/// leafless_classify_fn.
typedef int32_t (*leafless_value_fn)(void *ctx, const double *point, double *value);

/// Computes an interval that contains all values of the host's function over the box [min, max] (3 numbers
/// each, model units): sets `*range`. Otherwise as leafless_value_fn.
typedef int32_t (*leafless_range_fn)(void *ctx, const double *min, const double *max,
    leafless_interval *range);

/// A half-space of the host: the points where its function is not negative. `value` and `range` must be set.
typedef struct leafless_solid_function {
    uint32_t struct_size;  ///< sizeof(leafless_solid_function).
    uint32_t reserved;  ///< Reserved; must be 0.
    /// Computes the function's value at a point; NaN where the function is undefined. Only the sign matters.
    leafless_value_fn value;
    /// Bounds the function over a box. Only this range proves that a cell lies inside or outside. A NaN, or
    /// lower > upper, proves nothing.
    leafless_range_fn range;
    leafless_destroy_fn destroy;  ///< Called when the library no longer needs `ctx`; optional.
    void *ctx;  ///< The context that the functions are called with.
    uint64_t fingerprint[2];  ///< As in leafless_solid_callbacks.
} leafless_solid_function;

/// Makes a half-space of the host. It can be combined with other half-spaces and placed. The functions of a
/// placed half-space are called in its own space, for the box around a cell's inverse image and for the
/// rounded inverse image of a point.
///
/// - Buffers: `function`, one struct, which is copied; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_NULL if `value` or `range` is NULL; LEAFLESS_E_ARGUMENT. After an error `destroy` is
///   not called.
/// - Ownership: `ctx` must live until `destroy` is called with it; release `*solid` with leafless_solid_free.
/// - Threads: any; leafless_classify_fn describes the threads that call the functions.
/// - Untrusted input: any answers.
leafless_status leafless_solid_new_function(const leafless_solid_function *function, leafless_solid **solid);

/* ---- 11. Volumes -------------------------------------------------------------------------------------- */

/// The type of samples. The arrays of a volume have one of the first five types. Samples of other types are
/// converted to one of these when they are copied.
LEAFLESS_ENUM(leafless_sample_type, uint32_t) {
    LEAFLESS_SAMPLE_TYPE_U8 = 0,  ///< uint8_t.
    LEAFLESS_SAMPLE_TYPE_U16 = 1,  ///< uint16_t.
    LEAFLESS_SAMPLE_TYPE_I16 = 2,  ///< int16_t, as the Hounsfield units of tomography.
    LEAFLESS_SAMPLE_TYPE_F32 = 3,  ///< float. A sample that is not a number is never inside.
    /// Bits with the values 0 and 1, in uint64_t: each row along x begins with a word of its own, and the bit
    /// of the sample (x, y, z) is bit x mod 64 of word x / 64 + w (y + ny z), where w = ⌈nx / 64⌉. The other
    /// bits of a row's last word are ignored. leafless_octree_bitmap writes the same layout.
    LEAFLESS_SAMPLE_TYPE_BITS = 4,
    /// Bits in bytes, eight to a byte, the lowest first: each row along x begins with a byte of its own. They
    /// become LEAFLESS_SAMPLE_TYPE_BITS.
    LEAFLESS_SAMPLE_TYPE_BITS_IN_BYTES = 5,
    LEAFLESS_SAMPLE_TYPE_I8 = 6,  ///< int8_t. It becomes int16_t.
    LEAFLESS_SAMPLE_TYPE_I32 = 7,  ///< int32_t. It becomes float, as do all following types.
    LEAFLESS_SAMPLE_TYPE_U32 = 8,  ///< uint32_t.
    LEAFLESS_SAMPLE_TYPE_I64 = 9,  ///< int64_t.
    LEAFLESS_SAMPLE_TYPE_U64 = 10,  ///< uint64_t.
    LEAFLESS_SAMPLE_TYPE_F64 = 11,  ///< double.
};

/// The formats of volume files.
LEAFLESS_ENUM(leafless_volume_format, uint32_t) {
    /// The samples alone. A leafless_volume_layout describes them for reading.
    LEAFLESS_VOLUME_FORMAT_RAW = 0,
    LEAFLESS_VOLUME_FORMAT_NRRD = 1,  ///< NRRD, `.nrrd` or `.nhdr`. When written, samples are uncompressed.
    LEAFLESS_VOLUME_FORMAT_METAIMAGE = 2,  ///< MetaImage, `.mha` or `.mhd`, for reading only.
    /// For writing only: NRRD with samples compressed by DEFLATE. (A NRRD file that was read has
    /// LEAFLESS_VOLUME_FORMAT_NRRD, compressed or not.)
    LEAFLESS_VOLUME_FORMAT_NRRD_GZIP = 3,
};

/// Basic facts about a volume.
typedef struct leafless_volume_info {
    uint32_t struct_size;  ///< sizeof(leafless_volume_info).
    uint32_t extents[3];  ///< Number of samples along x, y and z.
    leafless_sample_type sample_type;  ///< Type of the samples in memory: one of the first five.
    /// Type of the samples in the file or array that the volume was made from.
    leafless_sample_type file_type;
    leafless_volume_format format;  ///< The file's format; LEAFLESS_VOLUME_FORMAT_RAW for arrays.
    leafless_unit unit;  ///< The unit of all lengths, if the file states it.
    bool is_placed;  ///< Whether the file's axes are not x, y and z: then `placement` moves the voxels.
    uint64_t sample_count;  ///< The number of samples.
    uint64_t rounded;  ///< Number of samples that were rounded to single precision.
    /// The least value that is inside by default: the middle of the range of `file_type`. 0.5 for bits, 127.5
    /// for uint8_t, 32767.5 for uint16_t, -0.5 for integers with a sign, 0 for float and double.
    double default_threshold;
    double corner_model[3];  ///< The lower corner of the first voxel, before `placement` moves it.
    double spacing_model[3];  ///< The edges of a voxel.
    /// The affine map x' = M x + t that moves the voxels to the position of the file: three rows of M and t.
    /// Its directions are rounded. The identity unless `is_placed`.
    double placement[12];
    /// Bytes of the samples, in memory or in the host's memory, and of the index for solids.
    uint64_t bytes;
} leafless_volume_info;

/// Returns one more reference to a volume.
///
/// - Buffers: `volume`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `volume`.
/// - Ownership: release each reference with leafless_volume_free.
leafless_status leafless_volume_ref(const leafless_volume *volume, leafless_volume **reference);

/// Releases a reference to a volume; the last release frees the volume. Solids made of it stay, and keep its
/// samples.
///
/// - Buffers: `volume`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
void leafless_volume_free(leafless_volume *volume);

/// Returns basic facts about a volume. O(1).
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
leafless_status leafless_volume_describe(const leafless_volume *volume, leafless_volume_info *info);

/// Returns the address of a volume's samples, without a copy: x varies fastest, in the `sample_type` of
/// leafless_volume_describe.
///
/// - Buffers: `samples` and `length`, one each.
/// - Result: `*samples`, the address of the first sample; `*length`, their size in bytes.
/// - Ownership: the samples belong to the volume, or to the host if it uses the host's array, and live as
///   long as the reference `volume`.
leafless_status leafless_volume_peek_samples(const leafless_volume *volume, const void **samples,
    uint64_t *length);

/// Makes the frame whose finest cells are the voxels of a volume, with the least depth that holds all voxels.
/// On this frame a solid of the volume has no PARTIAL cell, and its octree is the bitmap, bit for bit.
///
/// - Buffers: `frame`, one struct.
/// - Result: `*frame`.
/// - Errors: LEAFLESS_E_ARGUMENT if voxels are not cubes, or their axes are not x, y and z; use a frame
///   around leafless_volume_bounds then.
/// - Untrusted input: any volume.
leafless_status leafless_volume_frame(const leafless_volume *volume, leafless_frame *frame);

/// Returns a box that contains all voxels of a volume at the position that the file states, rounded outward.
///
/// - Buffers: `min_model` and `max_model`, room for 3 numbers each.
/// - Result: both corners.
/// - Errors: LEAFLESS_E_ARGUMENT if the box is beyond the range of double.
/// - Untrusted input: any volume.
leafless_status leafless_volume_bounds(const leafless_volume *volume, double min_model[3],
    double max_model[3]);

/// Returns the least and the greatest sample of a volume. O(n); O(n / 64) after the first solid or range.
///
/// - Buffers: `options`, one struct or NULL (its limits are ignored); `range`, one struct.
/// - Result: `*range`: 0 to 1 for bits; all numbers if a sample is not a number.
/// - Errors: LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any volume.
leafless_status leafless_volume_range(const leafless_volume *volume, const leafless_options *options,
    leafless_interval *range);

/// Makes a solid from a volume: the union of the closed voxels whose samples lie in a band, at the position
/// that the file states. Space beyond the voxels is outside. All functions for solids accept it: it can be
/// built, combined, measured, and have its surface extracted.
///
/// On the frame of leafless_volume_frame, finest cells are voxels and no cell is PARTIAL. On any other frame,
/// a cell is PARTIAL if it meets both voxels inside the band and voxels outside it.
///
/// The first solid of a volume reads all samples, in O(n). Later solids, with other bands, read only the
/// blocks that the block's least and greatest value do not decide. The samples are shared; for uint8_t the
/// solid takes about 1/32 of their memory in addition.
///
/// - Buffers: `band`, one struct: the least and the greatest value that are inside, which may be infinite; or
///   NULL, which means all values from the `default_threshold` of leafless_volume_describe on. `options`, one
///   struct or NULL (its limits are ignored); `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if an end of the band is not a number, or the lower end exceeds the upper
///   end; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the solid shares the samples, and `volume` may be freed; release `*solid` with
///   leafless_solid_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any volume.
leafless_status leafless_solid_from_volume(const leafless_volume *volume, const leafless_interval *band,
    const leafless_options *options, leafless_solid **solid);

/// The order of a number's bytes.
LEAFLESS_ENUM(leafless_byte_order, uint32_t) {
    LEAFLESS_BYTE_ORDER_NATIVE = 0,  ///< The order of this machine.
    LEAFLESS_BYTE_ORDER_LITTLE = 1,  ///< The byte of the lowest weight first.
    LEAFLESS_BYTE_ORDER_BIG = 2,  ///< The byte of the highest weight first.
};

/// The layout and the position of an array of samples: x varies fastest, then y, then z, without gaps. Zero
/// is the default of every field but the first and `extents`.
typedef struct leafless_volume_layout {
    uint32_t struct_size;  ///< sizeof(leafless_volume_layout).
    uint32_t sample_type;  ///< A leafless_sample_type.
    /// Number of samples along x, y and z: 1 to 2^20 each. An octree's cube may be larger; the space beyond
    /// the samples takes no memory.
    uint32_t extents[3];
    uint32_t byte_order;  ///< A leafless_byte_order.
    uint64_t skip;  ///< Bytes before the first sample.
    /// The lower corner of the first voxel: the position of the first sample minus half the spacing. Each
    /// coordinate is 0 or of a magnitude between 2^-256 and 2^256.
    double corner_model[3];
    double spacing_model[3];  ///< The edges of a voxel, 2^-256 to 2^256; all three 0 means 1.
} leafless_volume_layout;

/// Makes a volume from an array of samples without a header, in memory or in a file.
///
/// With LEAFLESS_ACCESS_COPY the samples are copied: O(n); bytes may have any address. With
/// LEAFLESS_ACCESS_MAP, which is for bytes only, they are used in place: O(1). The layout's type must then be
/// LEAFLESS_SAMPLE_TYPE_U8, _U16, _I16, _F32 or _BITS, the byte order this machine's, `skip` 0, and the bytes
/// aligned for their type. LEAFLESS_ACCESS_MAP_VERIFIED is the same, because any samples are a valid volume.
///
/// - Buffers: `layout`, one struct; `source`, one struct; `volume`, one pointer.
/// - Result: `*volume`.
/// - Errors: LEAFLESS_E_ARGUMENT if the type, the byte order, an extent, the corner or the spacing is
///   invalid, if the layout or the source does not fit the access, or if the number of bytes is not `skip`
///   plus the size of the samples; LEAFLESS_E_VOLUME_FILE if a file has a wrong number of bytes;
///   LEAFLESS_E_IO; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: samples that are copied may be freed after the call. Samples used in place belong to the
///   host. They must stay in place, unchanged, until the last reference is released to the volume, to every
///   solid made from it, and to every object made from these, except octrees and meshes, which have their own
///   data. Release `*volume` with leafless_volume_free.
/// - Untrusted input: any layout, any bytes, any file; memory is at most the file's length and as much again
///   for the samples, twice as much for int8_t.
leafless_status leafless_volume_new(const leafless_volume_layout *layout, const leafless_source *source,
    leafless_volume **volume);

/// Reads a volume file, NRRD or MetaImage, detected from the content. If it names another file for its
/// samples, that file is read from the same folder or below it, or is given as `data`.
///
/// NRRD: versions 1 to 5, attached and detached, raw, gzip and ascii. MetaImage: binary, ASCII and
/// compressed. All scalar sample types and both byte orders are supported. Samples that are neither 8 nor 16
/// bits wide become float, and int8_t becomes int16_t. O(n); the samples are copied once.
///
/// Samples in another file must lie in the header's folder or below it, by their real path: links are
/// followed before this check. The header's folder is the folder of the given path and, if the header is a
/// link, also the folder of the link's target, which is searched second. For bytes in memory no other file is
/// read.
///
/// - Buffers: `source`, one struct, with LEAFLESS_ACCESS_COPY. `data`, one struct of the same kind: the file
///   of the samples, which replaces the file that the header names; or NULL. Bytes in memory whose samples
///   are in another file need `data`, else the result is LEAFLESS_E_VOLUME_FILE. leafless_volume_data_file
///   returns the name of that file. `volume`, one pointer.
/// - Result: `*volume`; leafless_volume_describe returns the facts that the file states.
/// - Errors: LEAFLESS_E_VOLUME_FILE, with the problem and its position in the message, if the file has
///   neither format, is damaged, or uses an unsupported feature; LEAFLESS_E_IO; LEAFLESS_E_UTF8;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*volume` with leafless_volume_free.
/// - Untrusted input: any file. A header that asks for more samples than its data can hold is refused before
///   anything is allocated; compressed samples become at most 1032 times as long as the file.
leafless_status leafless_volume_read(const leafless_source *source, const leafless_source *data,
    leafless_volume **volume);

/// Returns the name of the file that contains the samples of a volume file, relative to the volume file.
///
/// - Buffers: `bytes`, `length` bytes: the file, or all of its header; may be NULL if `length` is 0. `name`,
///   room for `capacity` bytes, or NULL to get only the length; `name_length`, one number.
/// - Result: `*name_length`, in bytes; 0 if the samples follow the header. The name, in UTF-8, not
///   NUL-terminated. It may be any text: check it before you open such a file.
/// - Errors: LEAFLESS_E_VOLUME_FILE; LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any bytes.
leafless_status leafless_volume_data_file(const uint8_t *bytes, uint64_t length, char *name,
    uint64_t capacity, uint64_t *name_length);

/// Writes a volume file.
///
/// The byte order is little-endian, and bits become bytes 0 and 1. A NRRD stores the position of the first
/// sample, corner + spacing / 2, rounded so that reading restores the same corner. Near a power of two no
/// such double may exist; then the position is off by half a unit in the last place. It stores no unit. A raw
/// file stores no position. O(n) time and memory.
///
/// - Buffers: `sink`, one struct.
/// - Errors: LEAFLESS_E_ARGUMENT if `format` is not a format that can be written, or if a volume with axes
///   other than x, y and z is written as NRRD; LEAFLESS_E_IO; LEAFLESS_E_CALLBACK; LEAFLESS_E_BUFFER;
///   LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any volume.
leafless_status leafless_volume_write(const leafless_volume *volume, leafless_volume_format format,
    const leafless_sink *sink);

/* ---- 12. Scenes --------------------------------------------------------------------------------------- */

/// The circles, balls, cylinders and solids of revolution that are drawn as polygons, prisms and polyhedra.
LEAFLESS_ENUM(leafless_facets, uint32_t) {
    LEAFLESS_FACETS_AUTO = 0,  ///< Curves with a $fn of 12 or less; all others are exact.
    LEAFLESS_FACETS_EXACT = 1,  ///< None: all curves are exact.
    /// All, with as many sides as OpenSCAD draws. A scene with more than 1024 sides to a curve is refused.
    LEAFLESS_FACETS_POLYGON = 2,
};

/// Options of reading a scene. NULL means the defaults. Zero is the default of every field but the first.
typedef struct leafless_scene_options {
    uint32_t struct_size;  ///< sizeof(leafless_scene_options).
    leafless_facets facets;  ///< A leafless_facets: the curves that are drawn as polygons.
    /// The folder of the files that a text in memory names, UTF-8; NULL if it must not name files. NULL for a
    /// scene with a path, whose files are in the scene's folder.
    const char *folder;
    /// Length of `folder` in bytes. An empty folder that is not NULL is the current directory of the process.
    size_t folder_length;
} leafless_scene_options;

/// Reads a scene, a text in UTF-8. Files that it names are read from the scene's folder or, for a text in
/// memory, from the folder of the options.
///
/// - Buffers: `source`, one struct, with LEAFLESS_ACCESS_COPY; `options`, one struct, or NULL; `scene`, one
///   pointer.
/// - Result: `*scene`.
/// - Errors: LEAFLESS_E_SCENE, with line and column in the message, if the text or a file that it names
///   cannot be used, also if a file is named and there is no folder; LEAFLESS_E_ARGUMENT if both a path and a
///   folder are given; LEAFLESS_E_IO if the file itself cannot be read; LEAFLESS_E_UTF8;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*scene` with leafless_scene_free.
/// - Untrusted input: any text; nesting costs memory, not stack, and memory is linear in the text and in the
///   files that it names; with LEAFLESS_FACETS_POLYGON a ball may take memory for half a million half-spaces.
///   The text may name any file, also by an absolute path; the file is then read as a mesh or an octree.
leafless_status leafless_scene_read(const leafless_source *source, const leafless_scene_options *options,
    leafless_scene **scene);

/// A report of the reading of a scene.
typedef struct leafless_scene_info {
    uint32_t struct_size;  ///< sizeof(leafless_scene_info).
    uint64_t polygons;  ///< Calls of circle, sphere, cylinder and rotate_extrude that were drawn as polygons.
    uint64_t exact;  ///< Calls of the same functions that are exact. OpenSCAD draws them as polygons.
    /// Calls of linear_extrude whose `slices` has no effect here, but has one in OpenSCAD.
    uint64_t ignored_slices;
    /// Meshes and polyhedra that have triangles: leafless_scene_describe_mesh_at describes each.
    uint64_t meshes;
    /// Whether the scene is known to be empty: it has no objects, or the operands of an intersection are
    /// disjoint.
    bool is_empty;
} leafless_scene_info;

/// Facts about a mesh or polyhedron in a scene.
typedef struct leafless_scene_mesh_info {
    uint32_t struct_size;  ///< sizeof(leafless_scene_mesh_info).
    uint64_t line;  ///< Line of the call in the text, counted from 1.
    uint64_t column;  ///< Column of the call in characters, counted from 1.
    /// Triangles whose orientation differs from that of most triangles that they are connected with.
    uint64_t turned;
} leafless_scene_mesh_info;

/// Returns the report of the reading of a scene.
///
/// - Buffers: `report`, one struct.
/// - Result: `*report`.
leafless_status leafless_scene_describe(const leafless_scene *scene, leafless_scene_info *report);

/// Returns facts about a mesh or polyhedron of a scene, and the report of its import.
///
/// - Buffers: `mesh`, one struct; `report`, one struct, or NULL if it is not wanted. `index`, in the order of
///   the text, is less than `meshes` of leafless_scene_info.
/// - Result: `*mesh`; `*report`, the report of the mesh as it was imported.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no such mesh.
leafless_status leafless_scene_describe_mesh_at(const leafless_scene *scene, uint64_t index,
    leafless_scene_mesh_info *mesh, leafless_mesh_report *report);

/// Returns the file name of a mesh in a scene, as written in the text, in UTF-8 and not terminated by NUL;
/// empty for a polyhedron.
///
/// - Buffers: `bytes`, room for `capacity` bytes, or NULL to get only the length; `length`, one number.
///   `index`, in the order of the text, is less than `meshes` of leafless_scene_info.
/// - Result: `*length`, the length of the name in bytes; the name in `bytes`.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_ARGUMENT if there is no such mesh.
leafless_status leafless_scene_mesh_file_at(const leafless_scene *scene, uint64_t index, uint8_t *bytes,
    uint64_t capacity, uint64_t *length);

/// Returns one more reference to a scene.
///
/// - Buffers: `scene`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `scene`.
/// - Ownership: release each reference with leafless_scene_free.
leafless_status leafless_scene_ref(const leafless_scene *scene, leafless_scene **reference);

/// Releases a reference to a scene; the last release frees the scene. Solids made of it stay.
///
/// - Buffers: `scene`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
void leafless_scene_free(leafless_scene *scene);

/// Returns a box that contains the solid of a scene. It may be larger than the solid.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each.
/// - Result: both.
/// - Errors: LEAFLESS_E_ARGUMENT if no box is known: the scene is empty, or may be unbounded;
///   LEAFLESS_E_NO_MEMORY.
leafless_status leafless_scene_bounds(const leafless_scene *scene, double min_model[3], double max_model[3]);

/// Makes the solid of a scene, to be built on this frame. If it contains neither meshes nor octrees, it can
/// be built on any frame.
///
/// - Buffers: `frame`, one struct; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check; LEAFLESS_E_LIMIT if a mesh or octree is within more
///   than 256 matrices; LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any scene.
leafless_status leafless_solid_from_scene(const leafless_scene *scene, const leafless_frame *frame,
    leafless_solid **solid);

/* ---- 13. Octrees -------------------------------------------------------------------------------------- */

/// The tag of a cell: the cell's relation to the solid.
LEAFLESS_ENUM(leafless_tag, uint8_t) {
    LEAFLESS_TAG_EMPTY = 0,  ///< Proven outside the solid.
    LEAFLESS_TAG_BRANCH = 1,  ///< Cut and split: the cell has a node.
    LEAFLESS_TAG_PARTIAL = 2,  ///< Not decided.
    LEAFLESS_TAG_FULL = 3,  ///< Proven inside the solid.
};

/// The proofs that the cells of an octree give about the solid that it was made from. Certified octrees prove
/// FULL and EMPTY, inner octrees FULL, outer octrees EMPTY, sampled octrees nothing. Results of set
/// operations prove what their operands prove, and files store it.
typedef struct leafless_proof {
    /// Displacement of the surfaces from the given surfaces, in model units: by sewn cracks, rounded
    /// vertices, and a stated deviation of a tessellation.
    double displacement_model;
    bool full;  ///< A FULL cell is proven to lie in the solid.
    bool empty;  ///< An EMPTY cell is proven to lie outside it.
} leafless_proof;

/// The tags of an octree's cells that are proven.
LEAFLESS_ENUM(leafless_proven, uint32_t) {
    LEAFLESS_PROVEN_NOTHING = 0,  ///< Neither.
    LEAFLESS_PROVEN_FULL = 1,  ///< FULL.
    LEAFLESS_PROVEN_EMPTY = 2,  ///< EMPTY.
    LEAFLESS_PROVEN_BOTH = 3,  ///< FULL and EMPTY.
};

/// Basic facts about an octree.
typedef struct leafless_octree_info {
    uint32_t struct_size;  ///< sizeof(leafless_octree_info).
    leafless_frame frame;  ///< The frame: position, size and depth.
    uint64_t elements;  ///< Array elements without bricks; each holds two levels.
    uint64_t bricks;  ///< Array elements of the deepest level.
    uint64_t channels;  ///< Channels, 0 to 256: leafless_octree_channel_at returns each.
    /// Bytes of its arrays and its channels, in memory or in a mapped file. Memory that octrees share counts
    /// for each of them.
    uint64_t bytes;
    leafless_proof proof;  ///< The proofs that the cells give.
    leafless_tag root;  ///< The tag of the whole universe; BRANCH if it is split.
    leafless_tag exterior;  ///< The tag of the space outside the universe; never BRANCH.
    bool is_binary;  ///< Whether no cell is undecided.
    /// Whether the solid may extend beyond the universe; then volumes are those of the part inside.
    bool is_clipped;
} leafless_octree_info;

/// Counts and certified volumes. The volume is that of the part inside the universe.
typedef struct leafless_statistics {
    uint64_t nodes;  ///< Internal nodes: cells that are split.
    uint64_t empty;  ///< EMPTY cells.
    uint64_t full;  ///< FULL cells.
    uint64_t partial;  ///< PARTIAL cells.
    uint64_t lower_cells;  ///< Volume that is certainly solid, in finest cells.
    uint64_t upper_cells;  ///< Volume that is possibly solid, in finest cells.
    leafless_interval volume_model;  ///< Both volumes in cubic model units, rounded outward.
} leafless_statistics;

/// Makes the octree whose whole universe has one tag.
///
/// - Buffers: `frame`, one struct; `octree`, one pointer. `tag` and `exterior`, which must not be BRANCH, are
///   the tags of the universe and of the space around it.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_ARGUMENT.
/// - Ownership: release `*octree` with leafless_octree_free.
/// - Untrusted input: any numbers.
leafless_status leafless_octree_new_uniform(const leafless_frame *frame, leafless_tag tag,
    leafless_tag exterior, leafless_octree **octree);

/// Returns one more reference to an octree.
///
/// - Buffers: `octree`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `octree`.
/// - Ownership: release each reference with leafless_octree_free.
leafless_status leafless_octree_ref(const leafless_octree *octree, leafless_octree **reference);

/// Releases a reference to an octree. The last release frees the octree. The mapping of its file ends too,
/// unless a cursor, a solid, or an octree with other metadata still shares it.
///
/// - Buffers: `octree`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
void leafless_octree_free(leafless_octree *octree);

/// Returns basic facts about an octree. O(1).
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
/// - Untrusted input: any octree.
leafless_status leafless_octree_describe(const leafless_octree *octree, leafless_octree_info *info);

/// Returns the same octree with stated proofs; the arrays and the channels are shared. Use it for octrees
/// whose proofs another program knows. If both FULL and EMPTY are stated to be proven, the cells themselves
/// count as the solid: measures of a sampled octree are then measures of its cells, not of the sampled solid.
///
/// - Buffers: `octree`, a handle; `proven`, a leafless_proven; `displacement_model` as in leafless_proof;
///   `result`, one pointer.
/// - Result: `*result`.
/// - Errors: LEAFLESS_E_ARGUMENT if `proven` is not a leafless_proven, or the displacement is negative or not
///   finite.
/// - Ownership: release `*result` with leafless_octree_free.
/// - Untrusted input: any octree, any numbers.
leafless_status leafless_octree_with_proof(const leafless_octree *octree, leafless_proven proven,
    double displacement_model, leafless_octree **result);

/// Returns counts over all levels, and the volume of the cells. O(depth) if the counts are known, as for an
/// octree from a file; for a new octree the first call takes one pass over its arrays.
///
/// - Buffers: `statistics`, one struct.
/// - Result: `*statistics`.
/// - Untrusted input: any octree; of one that was mapped unverified the numbers may be wrong.
leafless_status leafless_octree_statistics(const leafless_octree *octree, leafless_statistics *statistics);

/// Returns the counts of each level, and the certified volumes of the octree cut off at that level. Entry 0
/// is the universe, entry `depth` the finest cells.
///
/// - Buffers: `levels`, room for `capacity` structs, or NULL to get only the count; `count`, one number.
/// - Result: `*count`, depth + 1; the levels.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small.
/// - Untrusted input: any octree; of one that was mapped unverified the numbers may be wrong.
leafless_status leafless_octree_levels(const leafless_octree *octree, leafless_statistics *levels,
    uint64_t capacity, uint64_t *count);

/// Checks that an octree is well-formed and canonical: O(n). Octrees that the library makes, opens or maps
/// verified always are. Channels are not checked; see leafless_channel_check. Checksums of files are not
/// checked; see leafless_file_verify.
///
/// - Result: LEAFLESS_OK if the octree passes.
/// - Errors: LEAFLESS_E_DAMAGED, with the first damage in the message; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree.
leafless_status leafless_octree_check(const leafless_octree *octree);

/// Returns whether two octrees have the same cells with the same tags and the same surfaces, on the same
/// frame. Metadata and channels are not compared. O(n).
///
/// - Buffers: `equal`, one truth value.
/// - Result: `*equal`.
/// - Untrusted input: any octrees.
leafless_status leafless_octree_equal(const leafless_octree *a, const leafless_octree *b, bool *equal);

/// Returns the octree with one more fact in its metadata, or with a new value of a fact; the arrays and the
/// channels are shared. Names in use: "name", "units", "source", "rule".
///
/// - Buffers: `key` and `value`, `key_length` and `value_length` bytes of UTF-8; `named`, one pointer.
/// - Result: `*named`.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_ARGUMENT if all facts would take more than 1 MiB in a file (each
///   takes 8 bytes and its two texts); LEAFLESS_E_NO_MEMORY.
/// - Ownership: the texts are copied. `*named` shares the arrays of `octree`, which may be freed. Bytes that
///   `octree` views must outlive `*named` too, and a file that it maps must stay unchanged as long. Release
///   `*named` with leafless_octree_free.
/// - Untrusted input: any texts.
leafless_status leafless_octree_with_metadata(const leafless_octree *octree, const char *key,
    size_t key_length, const char *value, size_t value_length, leafless_octree **named);

/// Returns the octree with one fact less in its metadata, or without metadata; the arrays and the channels
/// are shared.
///
/// - Buffers: `key`, `key_length` bytes of UTF-8, or NULL for all facts; `unnamed`, one pointer.
/// - Result: `*unnamed`; it is not an error if there is no such fact.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_octree_with_metadata.
/// - Untrusted input: any texts.
leafless_status leafless_octree_without_metadata(const leafless_octree *octree, const char *key,
    size_t key_length, leafless_octree **unnamed);

/// Returns the value of a fact in an octree's metadata.
///
/// - Buffers: `key`, `key_length` bytes of UTF-8; `value` and `value_length`, one each.
/// - Result: `*value`, not NUL-terminated; NULL if there is no such fact. `*value_length`, in bytes.
/// - Errors: LEAFLESS_E_UTF8.
/// - Ownership: the text belongs to the octree and lives as long as the reference `octree`.
/// - Untrusted input: any octree.
leafless_status leafless_octree_peek_metadata(const leafless_octree *octree, const char *key,
    size_t key_length, const char **value, size_t *value_length);

/// Returns a fact of an octree's metadata by its index. Facts are sorted by key.
///
/// - Buffers: `count`, one number; `key`, `key_length`, `value`, `value_length`, one each, all four NULL to
///   get only the count.
/// - Result: `*count`, the number of all facts; key and value, not NUL-terminated, with their lengths in
///   bytes.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no fact `index`, unless only the count is requested.
/// - Ownership: the texts belong to the octree and live as long as the reference `octree`.
/// - Untrusted input: any octree.
leafless_status leafless_octree_peek_metadata_at(const leafless_octree *octree, uint64_t index,
    uint64_t *count, const char **key, size_t *key_length, const char **value, size_t *value_length);

/// The rule for finest cells that are not decided.
LEAFLESS_ENUM(leafless_rule, uint32_t) {
    /// They stay PARTIAL: FULL cells are proven full, EMPTY cells proven empty.
    LEAFLESS_RULE_CERTIFIED = 0,
    LEAFLESS_RULE_SAMPLED = 1,  ///< The centre of the cell decides.
    LEAFLESS_RULE_INNER = 2,  ///< They become EMPTY: the result lies in the solid.
    LEAFLESS_RULE_OUTER = 3,  ///< They become FULL: the result covers the solid.
};

/// Builds the octree of a solid to the depth of a frame. The result is identical, bit for bit, for any number
/// of threads.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `octree`, one pointer. `rule` is a
///   leafless_rule.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_FRAME if the solid belongs to another frame; LEAFLESS_E_NOT_SAMPLED if `rule` is
///   LEAFLESS_RULE_SAMPLED and the solid cannot decide points; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED;
///   LEAFLESS_E_ARGUMENT; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*octree` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid; set `max_bytes` if the depth or the solid is untrusted.
leafless_status leafless_octree_build(const leafless_solid *solid, const leafless_frame *frame,
    leafless_rule rule, const leafless_options *options, leafless_octree **octree);

/// Returns the octree with its PARTIAL cells resolved: EMPTY under LEAFLESS_RULE_INNER, FULL under
/// LEAFLESS_RULE_OUTER. An octree that keeps surfaces is refused, because its cells are few and large:
/// leafless_octree_plain resolves it at a depth.
///
/// - Buffers: `options`, one struct or NULL; `resolved`, one pointer. `rule` is a leafless_rule.
/// - Result: `*resolved`, with the octree's channels and, of its metadata, the facts "name" and "units".
/// - Errors: LEAFLESS_E_NOT_SAMPLED under LEAFLESS_RULE_SAMPLED if a cell is PARTIAL, because a stored octree
///   has no more information about the cell; LEAFLESS_E_ARGUMENT, also if the octree keeps surfaces;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `octree` is unchanged; release `*resolved` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octree.
leafless_status leafless_octree_resolve(const leafless_octree *octree, leafless_rule rule,
    const leafless_options *options, leafless_octree **resolved);

/// Returns the same octree with its bricks encoded as in a file, through a dictionary where that is shorter.
/// All functions accept it like any other octree.
///
/// - Buffers: `compacted`, one pointer.
/// - Result: `*compacted`, with the same metadata and channels.
/// - Errors: LEAFLESS_E_DAMAGED if a brick cannot be read; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `octree` is unchanged; release `*compacted` with leafless_octree_free.
/// - Untrusted input: any octree.
leafless_status leafless_octree_compact(const leafless_octree *octree, leafless_octree **compacted);

/// Combines octrees, at least one, by a set operation. The result is exact, and identical, bit for bit, for
/// any number of threads. It has no channels: leafless_octree_carry_channels adds the channels of the
/// operands.
///
/// Octrees without surfaces are combined in pairs: the limits of `options` apply to each of these steps, and
/// the result is never larger than all operands together. If an octree keeps surfaces
/// (leafless_octree_build_extended), the result keeps surfaces. Then all operands are walked at once, and no
/// intermediate result is copied: pass the stock and all tools in one call, not one call a tool. A cell ends
/// as soon as three surfaces are left in it. A cell that more surfaces cross at the frame's depth is given
/// up: no function of surfaces is stored for it. An octree without surfaces takes part as a certified octree.
/// Equal surfaces of two octrees are recognised: A minus A is LEAFLESS_TAG_EMPTY except in cells that were
/// given up. The result may be larger than the operands. Curved surfaces that nearly coincide may need very
/// many cells: set `max_bytes` of `options`.
///
/// - Buffers: `octrees`, `count` handles; `options`, one struct or NULL; `result`, one pointer. `operation`
///   is a leafless_operation.
/// - Result: `*result`, with the facts "name" and "units" if all operands have the same value of them, and no
///   other metadata.
/// - Errors: LEAFLESS_E_FRAME if the frames differ; LEAFLESS_E_NULL, also of an element; LEAFLESS_E_ARGUMENT,
///   also if `count` is 0; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT, also if the exact map of a surface's
///   placements is too long; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the operands are unchanged; release `*result` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octrees; damage in octrees that were mapped unverified is an error or reads as
///   PARTIAL. Set `max_bytes` if an octree keeps surfaces and is untrusted.
leafless_status leafless_octree_combine(leafless_operation operation, const leafless_octree *const *octrees,
    uint64_t count, const leafless_options *options, leafless_octree **result);

/// Returns the complement of an octree, inside its universe and outside. Surfaces are kept.
///
/// - Buffers: `options`, one struct or NULL; `result`, one pointer.
/// - Result: as leafless_octree_combine.
/// - Errors: LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_octree_combine.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: as leafless_octree_combine.
leafless_status leafless_octree_complement(const leafless_octree *octree, const leafless_options *options,
    leafless_octree **result);

/* ---- 14. Extended octrees ----------------------------------------------------------------------------- */

/// Options of the surfaces that an extended octree keeps.
typedef struct leafless_cut_options {
    uint32_t struct_size;  ///< sizeof(leafless_cut_options).
    /// Largest distance, in model units, of the two parallel planes that replace a surface without an exact
    /// form (a mesh, a function of the host). 0: only exact surfaces are kept.
    double tolerance_model;
} leafless_cut_options;

/// Counts of the surfaces that the PARTIAL cells of an octree keep.
typedef struct leafless_cut_counts {
    uint32_t struct_size;  ///< sizeof(leafless_cut_counts).
    uint32_t surfaces;  ///< Number of surfaces.
    /// Cells in which the solid is a known function of surfaces. Parts of cells with functions of their own
    /// count.
    uint64_t cells;
    uint64_t given_up;  ///< Cells that were given up: no function is known.
    /// PARTIAL cells that are split without a node, because all of their parts are PARTIAL.
    uint64_t splits;
    uint64_t bytes;  ///< Bytes of the surfaces and functions.
} leafless_cut_counts;

/// The kind of function whose zero set a surface is, and the meaning of its numbers.
LEAFLESS_ENUM(leafless_stored_surface_kind, uint32_t) {
    LEAFLESS_STORED_SURFACE_KIND_PLANE = 0,  ///< a, b, c, d of a x + b y + c z + d.
    LEAFLESS_STORED_SURFACE_KIND_QUADRIC = 1,  ///< The coefficients of x², y², z², xy, yz, zx, x, y, z and 1.
    /// A, a, n, B, b, m, C, c, k, D of A (x - a)^n + B (y - b)^m + C (z - c)^k + D.
    LEAFLESS_STORED_SURFACE_KIND_POWERS = 2,
    LEAFLESS_STORED_SURFACE_KIND_TORUS = 3,  ///< R, q, s, t of q - (sqrt((s x)² + (s y)²) - R)² - (s z + t)².
    /// a, b, c and two offsets: positive where a x + b y + c z is less than the first, negative where it is
    /// greater than the second, and unknown in between.
    LEAFLESS_STORED_SURFACE_KIND_SLAB = 4,
};

/// A surface of an octree.
typedef struct leafless_stored_surface_info {
    uint32_t struct_size;  ///< sizeof(leafless_stored_surface_info).
    leafless_stored_surface_kind kind;  ///< The kind of surface.
    uint32_t number_count;  ///< Count of its numbers.
    uint32_t placement_count;  ///< Count of the maps that place it.
    uint32_t terms[10];  ///< For each number, the count of doubles whose exact sum it is.
    uint32_t term_count;  ///< Count of these doubles in all.
    bool has_origin;  ///< Whether a slab has an identity, by which equal slabs are recognised.
    /// If `has_origin`, the slab's number in its origin. Numbers from 2^63 on belong to slabs that were made
    /// for one cell.
    uint64_t origin_number;
    uint64_t origin[2];  ///< If `has_origin`, the fingerprint of the origin, the lower half first.
} leafless_stored_surface_info;

/// The solid in a cell as a function of surfaces.
typedef struct leafless_cell_function {
    uint32_t surfaces[3];  ///< Indices of its surfaces, ascending.
    /// Number of surfaces, 0 to 3; 0 if no function is known, or if the cell is decided.
    uint32_t surface_count;
    /// Truth table. Bit m is set if a point lies in the solid that is on the positive side of each surface i
    /// whose bit i of m is set, and on the negative side of the others.
    uint8_t table;
} leafless_cell_function;

/// Builds the extended octree of a solid: a certified octree whose PARTIAL cells keep the surfaces that cross
/// them, up to three, and the solid as a function of the surfaces' sides. A cell is not split further when
/// three surfaces are left in it, at any size, so that the octree is small, and as exact as the solid. If all
/// surfaces are exact, use a frame of depth 20. The result is identical, bit for bit, for any number of
/// threads.
///
/// In such an octree, the surfaces decide queries of points, rays and boxes (leafless_octree_contains,
/// leafless_octree_cast_rays, leafless_octree_classify_box); next to a surface they may stay undecided. As a
/// solid (leafless_solid_from_octree) it answers like its source. Set operations (leafless_octree_combine,
/// leafless_octree_complement) keep the surfaces. Functions for cells see only the cells:
/// leafless_octree_plain converts the octree for them.
///
/// - Buffers: `frame`, one struct; `cuts`, one struct or NULL; `options`, one struct or NULL; `octree`, one
///   pointer.
/// - Result: `*octree`.
/// - Errors: as leafless_octree_build under LEAFLESS_RULE_CERTIFIED; LEAFLESS_E_ARGUMENT if the tolerance is
///   negative or not a number; LEAFLESS_E_LIMIT also if an exact number of a surface is the sum of more than
///   seven doubles.
/// - Ownership: release `*octree` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid; set `max_bytes` if the depth or the solid is untrusted.
leafless_status leafless_octree_build_extended(const leafless_solid *solid, const leafless_frame *frame,
    const leafless_cut_options *cuts, const leafless_options *options, leafless_octree **octree);

/// Converts an extended octree to an octree without surfaces, to a depth, for functions that work on cells.
/// Cells that are undecided at the depth are resolved by a rule. For an octree without surfaces the result is
/// the same octree, cut off at the depth.
///
/// - Buffers: `options`, one struct or NULL; `plain`, one pointer. `rule` is a leafless_rule.
/// - Result: `*plain`, with the octree's metadata and channels.
/// - Errors: as leafless_octree_build; LEAFLESS_E_ARGUMENT if `depth` is not 1 to 20.
/// - Ownership: `octree` is unchanged; release `*plain` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octree; set `max_bytes` if the depth is untrusted.
leafless_status leafless_octree_plain(const leafless_octree *octree, uint32_t depth, leafless_rule rule,
    const leafless_options *options, leafless_octree **plain);

/// Counts the surfaces that the PARTIAL cells of an octree keep; all 0 if they keep none. O(cells that keep
/// surfaces).
///
/// - Buffers: `counts`, one struct.
/// - Result: `*counts`.
/// - Untrusted input: any octree; of one that was mapped unverified the numbers may be wrong.
leafless_status leafless_octree_count_cuts(const leafless_octree *octree, leafless_cut_counts *counts);

/// Returns a surface of an extended octree: its kind, its numbers, and the maps that place it. O(1).
///
/// - Buffers: `info`, one struct; `terms`, room for `term_capacity` doubles, or NULL: the doubles whose sums
///   are the numbers, one number after the other; `placements`, room for `placement_capacity` doubles, or
///   NULL: the 12 of the rows of [M | t] of each map, in the order in which the maps are applied.
/// - Result: `*info`, `terms` and `placements`.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no such surface, or it is damaged; LEAFLESS_E_BUFFER if a
///   capacity is too small.
/// - Untrusted input: any octree, any number.
leafless_status leafless_octree_surface_at(const leafless_octree *octree, uint32_t surface,
    leafless_stored_surface_info *info, double *terms, uint64_t term_capacity, double *placements,
    uint64_t placement_capacity);

/// Returns the function of surfaces that the solid is in a cell. The cell is PARTIAL or lies in a PARTIAL
/// cell. O(depth).
///
/// - Buffers: `cell`, 3 numbers, each less than 2^level; `function`, one struct.
/// - Result: `*function`. It has no surface if no function is known, if the cell is decided, if different
///   functions hold in parts of the cell, or if there is no such cell.
/// - Untrusted input: any octree, any numbers.
leafless_status leafless_octree_cell_function(const leafless_octree *octree, uint32_t level,
    const uint32_t cell[3], leafless_cell_function *function);

/* ---- 15. Shards: octrees in parts --------------------------------------------------------------------- */

/// The kind of a shard: which cells it contains.
LEAFLESS_ENUM(leafless_shard_kind, uint32_t) {
    /// The cells down to a level. Cells of the last level that would be split stay PARTIAL.
    LEAFLESS_SHARD_KIND_TOP = 0,
    LEAFLESS_SHARD_KIND_BELOW = 1,  ///< The cells inside one cell, and the cells that contain it.
};

/// The set of cells that a shard of an octree contains. All other cells of the shard are PARTIAL.
///
/// An octree is cut at a level into its top, and into one shard for each cell of that level that the top
/// leaves open (leafless_octree_open_cells). Every shard is an octree on the frame of the whole, and its
/// verdicts hold for the whole solid. leafless_octree_join joins shards again.
///
/// The code of a cell is its index in Morton order among the 8^level cells of its level. Bit 3k of the code
/// is bit k of the cell's index along x, bit 3k + 1 that along y, bit 3k + 2 that along z.
typedef struct leafless_shard {
    uint64_t code;  ///< The code of the cell; 0 for a top.
    uint32_t level;  ///< The level of the cell, or the last level of a top: 0 to the depth of the frame.
    leafless_shard_kind kind;  ///< A leafless_shard_kind.
} leafless_shard;

/// Builds one shard of the octree of a solid: the cells of the shard are those that leafless_octree_build
/// makes. All other cells are PARTIAL under every rule. Time and memory are linear in the cells of the shard
/// and the cells that contain it.
///
/// Joining the top and the shards of all cells that it leaves open (leafless_octree_join) makes the octree
/// that leafless_octree_build makes, byte for byte.
///
/// - Buffers: `frame` and `shard`, one struct each; `options`, one struct or NULL; `octree`, one pointer.
///   `rule` is a leafless_rule.
/// - Result: `*octree`.
/// - Errors: as leafless_octree_build; LEAFLESS_E_ARGUMENT also if the frame does not have the cells of the
///   shard.
/// - Ownership: release `*octree` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid, any numbers; set `max_bytes` if the depth or the solid is untrusted.
leafless_status leafless_octree_build_shard(const leafless_solid *solid, const leafless_frame *frame,
    leafless_rule rule, const leafless_shard *shard, const leafless_options *options,
    leafless_octree **octree);

/// Builds one shard of the extended octree of a solid: the cells of the shard are those that
/// leafless_octree_build_extended makes. All other cells are PARTIAL, without surfaces.
///
/// - Buffers: `frame` and `shard`, one struct each; `cuts`, one struct or NULL; `options`, one struct or
///   NULL; `octree`, one pointer.
/// - Result: `*octree`.
/// - Errors: as leafless_octree_build_extended; LEAFLESS_E_ARGUMENT also if the frame does not have the cells
///   of the shard.
/// - Ownership: release `*octree` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid, any numbers; set `max_bytes` if the depth or the solid is untrusted.
leafless_status leafless_octree_build_extended_shard(const leafless_solid *solid, const leafless_frame *frame,
    const leafless_cut_options *cuts, const leafless_shard *shard, const leafless_options *options,
    leafless_octree **octree);

/// Cuts a shard off an octree. The shard is the octree that leafless_octree_build_shard or
/// leafless_octree_build_extended_shard makes of the solid that the octree was built from.
///
/// - Buffers: `shard`, one struct; `options`, one struct or NULL; `result`, one pointer.
/// - Result: `*result`, without metadata and channels.
/// - Errors: LEAFLESS_E_ARGUMENT if the octree's frame does not have the cells of the shard;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `octree` is unchanged; release `*result` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octree, any numbers; damage in an octree that was mapped unverified is an error or
///   reads as PARTIAL.
leafless_status leafless_octree_shard(const leafless_octree *octree, const leafless_shard *shard,
    const leafless_options *options, leafless_octree **result);

/// Joins several octrees of one solid on one frame. A cell is FULL or EMPTY if one of the octrees decides it,
/// and PARTIAL if all octrees leave it open. Surfaces of a PARTIAL cell are kept if one of the octrees keeps
/// them.
///
/// This is the reverse of cutting an octree into shards: the result is the whole, byte for byte. The cell of
/// a missing shard is PARTIAL. The octrees may overlap. If two of them keep surfaces of one cell, the
/// surfaces of the first octree are kept.
///
/// Time is linear in the cells that are split in one octree and not open in another one, plus the memory
/// traffic of copied parts.
///
/// - Buffers: `octrees`, `count` handles; `options`, one struct or NULL; `result`, one pointer.
/// - Result: `*result`, without metadata and channels.
/// - Errors: LEAFLESS_E_FRAME if the frames differ; LEAFLESS_E_NULL, also of an element; LEAFLESS_E_ARGUMENT
///   if `count` is 0, or if a cell is FULL in one octree and EMPTY in another one, so that they are not of
///   one solid; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the octrees are unchanged; release `*result` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octrees; damage in octrees that were mapped unverified is an error or reads as
///   PARTIAL.
leafless_status leafless_octree_join(const leafless_octree *const *octrees, uint64_t count,
    const leafless_options *options, leafless_octree **result);

/// Returns the codes of the open cells of a level: the cells that an octree leaves open. Each is PARTIAL, or
/// lies in a PARTIAL cell, and keeps no surfaces. If the octree is a top of that level, each of these cells
/// needs a shard. O(cells of the levels above, and of the result).
///
/// - Buffers: `codes`, room for `capacity` numbers, or NULL to get only the count; `count`, one number.
/// - Result: `codes`, ascending, as in leafless_shard; `*count`.
/// - Errors: LEAFLESS_E_ARGUMENT if `level` is greater than the octree's depth; LEAFLESS_E_BUFFER if the
///   capacity is too small; LEAFLESS_E_LIMIT if there are more than 2^24 cells; LEAFLESS_E_DAMAGED;
///   LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree, any number.
leafless_status leafless_octree_open_cells(const leafless_octree *octree, uint32_t level, uint64_t *codes,
    uint64_t capacity, uint64_t *count);

/// Computes the statistics of the octree that leafless_octree_join would make of a top and its shards, level
/// by level, without joining. Each shard is represented by its counts, which leafless_octree_levels returns
/// on the machine that has the shard. The cell of a missing shard is PARTIAL. O(cells × depth).
///
/// Only `nodes`, `full` and `partial` of the counts are read.
///
/// - Buffers: `codes`, `code_count` numbers as in leafless_shard, ascending: the cells of the shards, all of
///   level `level`; `levels`, `level_count` structs: depth + 1 of the first shard, from the universe on, then
///   those of the second one, and so on; `joined`, room for `capacity` structs, or NULL to get only the
///   count; `count`, one number.
/// - Result: `*count`, depth + 1; `joined`, the levels of the whole as from leafless_octree_levels. The last
///   level has the volume.
/// - Errors: LEAFLESS_E_ARGUMENT if `level` is not less than the depth, a code is not less than 8^level, the
///   codes do not ascend, `level_count` is not `code_count` × (depth + 1), a cell is not open in `octree`, or
///   a shard does not split its cell: join such a shard and the top (leafless_octree_join), and pass the
///   result as the top; LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree, any numbers; wrong counts give wrong statistics.
leafless_status leafless_octree_statistics_with(const leafless_octree *octree, uint32_t level,
    const uint64_t *codes, uint64_t code_count, const leafless_statistics *levels, uint64_t level_count,
    leafless_statistics *joined, uint64_t capacity, uint64_t *count);

/// Makes a solid from a top and its shards, on their universe. The solid answers like the joined octree
/// (leafless_octree_join, leafless_solid_from_octree), without joining. The library reads a shard only when
/// one of its cells is queried, so that a mapped file is not read before. The cell of a missing shard is
/// PARTIAL.
///
/// The solid keeps no list of surfaces. To build its extended octree, join the shards.
///
/// - Buffers: `codes`, `count` numbers as in leafless_shard, in any order: the cells of the shards, all of
///   level `level`; `octrees`, `count` handles: the shards; `solid`, one pointer.
/// - Result: `*solid`. O(shards).
/// - Errors: LEAFLESS_E_FRAME if the frames differ; LEAFLESS_E_NULL, also of an element; LEAFLESS_E_ARGUMENT
///   if `level` is greater than the depth, a code is not less than 8^level, or two shards have the same cell;
///   LEAFLESS_E_NO_MEMORY. Queries of the solid return LEAFLESS_E_DAMAGED if an octree was mapped unverified
///   and its links are damaged.
/// - Ownership: the solid shares the octrees, which may be freed; release `*solid` with leafless_solid_free.
/// - Untrusted input: any octrees, any numbers.
leafless_status leafless_solid_from_shards(const leafless_octree *top, uint32_t level, const uint64_t *codes,
    const leafless_octree *const *octrees, uint64_t count, leafless_solid **solid);

/* ---- 16. Points and boxes ----------------------------------------------------------------------------- */

/// The answer to a point query.
LEAFLESS_ENUM(leafless_membership, uint8_t) {
    LEAFLESS_MEMBERSHIP_OUTSIDE = 0,  ///< Proven outside.
    LEAFLESS_MEMBERSHIP_INSIDE = 1,  ///< Proven inside.
    LEAFLESS_MEMBERSHIP_UNDECIDED = 2,  ///< In a PARTIAL cell, outside the universe, or not a number.
};

/// The answer to a box query. Each is proven, except UNDECIDED.
LEAFLESS_ENUM(leafless_region, uint8_t) {
    LEAFLESS_REGION_OUTSIDE = 0,  ///< The interiors of box and solid are disjoint.
    LEAFLESS_REGION_INSIDE = 1,  ///< The box lies in the solid.
    LEAFLESS_REGION_UNDECIDED = 2,  ///< Nothing could be proven at the octree's depth.
    LEAFLESS_REGION_CROSSING = 3,  ///< Part of the box lies inside, part outside.
};

/// Returns whether the solid of an octree contains a point. A point on the boundary may be inside or outside;
/// a point that is outside the universe or not a number is undecided. At most ⌈depth/2⌉ array elements are
/// read.
///
/// - Buffers: `point_model`, 3 numbers; `membership`, one.
/// - Result: `*membership`.
/// - Untrusted input: any octree, any numbers; damage reads as undecided.
leafless_status leafless_octree_contains(const leafless_octree *octree, const double point_model[3],
    leafless_membership *membership);

/// Like leafless_octree_contains for many points at once, which is faster than one by one.
///
/// - Buffers: `points_model`, `count` points of 3 numbers; `memberships`, room for `count`. Both may be NULL
///   if `count` is 0.
/// - Result: `memberships[i]` for point i.
/// - Untrusted input: any octree, any numbers; damage reads as undecided.
leafless_status leafless_octree_contains_many(const leafless_octree *octree, const double *points_model,
    uint64_t count, leafless_membership *memberships);

/// Returns the tag of a finest cell.
///
/// - Buffers: `cell`, 3 numbers; `tag`, one.
/// - Result: `*tag`: EMPTY, FULL or PARTIAL; PARTIAL if a coordinate is not below 2^depth.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
leafless_status leafless_octree_tag_at(const leafless_octree *octree, const uint32_t cell[3],
    leafless_tag *tag);

/// Classifies a box against the solid of an octree. The part of the box outside the universe is undecided.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `region`, one.
/// - Result: `*region`.
/// - Errors: LEAFLESS_E_ARGUMENT if min > max on an axis, or a coordinate is not a number.
/// - Untrusted input: any octree, any numbers; no array element is read twice; damage reads as undecided.
leafless_status leafless_octree_classify_box(const leafless_octree *octree, const double min_model[3],
    const double max_model[3], leafless_region *region);

/// Returns whether a solid contains points, without an octree. A point is undecided if it lies in a cell of
/// the frame that is undecided at the frame's depth, lies outside the universe, or is not a number. A point
/// on the boundary may be inside or outside. If the solid has a `contains` function of the host, it is called
/// first. Otherwise each point splits at most one cell a level, and points near each other share splits.
///
/// - Buffers: `frame`, one struct; `points_model`, `count` points of 3 numbers; `options`, one struct or NULL
///   (its limits are ignored); `memberships`, room for `count`. `points_model` and `memberships` may be NULL
///   if `count` is 0.
/// - Result: `memberships[i]` for point i; identical for any number of threads.
/// - Errors: LEAFLESS_E_FRAME if the solid belongs to another frame; LEAFLESS_E_ARGUMENT as
///   leafless_frame_check; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid, any numbers.
leafless_status leafless_solid_contains_many(const leafless_solid *solid, const leafless_frame *frame,
    const double *points_model, uint64_t count, const leafless_options *options,
    leafless_membership *memberships);

/// Classifies a box against a solid, without an octree, as far as the cells of the frame decide it. The part
/// of the box outside the universe is undecided. The work ends as soon as the answer is known, or when
/// `max_splits` cells are split.
///
/// - Buffers: `frame`, one struct; `min_model` and `max_model`, 3 numbers each; `options`, one struct or
///   NULL; `region`, one.
/// - Result: `*region`.
/// - Errors: LEAFLESS_E_ARGUMENT if min > max on an axis, or a coordinate is not a number; otherwise as
///   leafless_solid_contains_many.
/// - Untrusted input: any solid, any numbers; set `max_splits` if the depth or the solid is untrusted.
leafless_status leafless_solid_classify_box(const leafless_solid *solid, const leafless_frame *frame,
    const double min_model[3], const double max_model[3], const leafless_options *options,
    leafless_region *region);

/// Makes a point cursor.
///
/// - Buffers: `cursor`, one pointer.
/// - Result: `*cursor`.
/// - Ownership: the cursor shares the octree, which may be freed; release `*cursor` with
///   leafless_point_cursor_free.
/// - Untrusted input: any octree.
leafless_status leafless_point_cursor_new(const leafless_octree *octree, leafless_point_cursor **cursor);

/// Releases a point cursor.
///
/// - Buffers: `cursor`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
void leafless_point_cursor_free(leafless_point_cursor *cursor);

/// Like leafless_octree_contains, from the path to the last cell.
///
/// - Buffers: `point_model`, 3 numbers; `membership`, one.
/// - Result: `*membership`.
/// - Threads: no other call may use the cursor.
/// - Untrusted input: any octree, any numbers; damage reads as undecided.
leafless_status leafless_point_cursor_contains(leafless_point_cursor *cursor, const double point_model[3],
    leafless_membership *membership);

/// Like leafless_octree_tag_at, from the path to the last cell.
///
/// - Buffers: `cell`, 3 numbers; `tag`, one.
/// - Result: `*tag`: EMPTY, FULL or PARTIAL; PARTIAL if a coordinate is not below 2^depth.
/// - Threads: no other call may use the cursor.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
leafless_status leafless_point_cursor_tag_at(leafless_point_cursor *cursor, const uint32_t cell[3],
    leafless_tag *tag);

/// Makes a point table.
///
/// - Buffers: `table`, one pointer; `table_level`, one.
/// - Result: `*table`; `*table_level`: the level of the table's cells, which is `level` or the next coarser
///   level at which the octree's array elements, of two levels each, begin. A `level` beyond 8, or beyond the
///   octree's depth, is reduced to that limit.
/// - Errors: LEAFLESS_E_NO_MEMORY.
/// - Ownership: the table shares the octree, which may be freed; release `*table` with
///   leafless_point_table_free.
/// - Untrusted input: any octree; the work is bounded by 8^level.
leafless_status leafless_point_table_new(const leafless_octree *octree, uint8_t level,
    leafless_point_table **table, uint8_t *table_level);

/// Releases a point table.
///
/// - Buffers: `table`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
void leafless_point_table_free(leafless_point_table *table);

/// Like leafless_octree_contains, through a table.
///
/// - Buffers: `point_model`, 3 numbers; `membership`, one.
/// - Result: `*membership`.
/// - Untrusted input: any octree, any numbers; damage reads as undecided.
leafless_status leafless_point_table_contains(const leafless_point_table *table, const double point_model[3],
    leafless_membership *membership);

/// Like leafless_octree_contains_many, through a table.
///
/// - Buffers: `points_model`, `count` points of 3 numbers; `memberships`, room for `count`. Both may be NULL
///   if `count` is 0.
/// - Result: `memberships[i]` for point i.
/// - Untrusted input: any octree, any numbers; damage reads as undecided.
leafless_status leafless_point_table_contains_many(const leafless_point_table *table,
    const double *points_model, uint64_t count, leafless_membership *memberships);

/* ---- 17. Cells of octrees ----------------------------------------------------------------------------- */

/// The state of a cursor: the cell that it is at.
typedef struct leafless_cursor_info {
    uint32_t struct_size;  ///< sizeof(leafless_cursor_info).
    uint32_t cell[3];  ///< The cell's index on each axis among the cells of its level.
    uint32_t level;  ///< The cell's level; 0 is the universe.
    leafless_tag tag;  ///< The cell's tag.
    /// For a BRANCH, the tags of its children in octant order (bit 0 of the octant is x, bit 1 y, bit 2 z);
    /// else eight times the cell's own tag.
    leafless_tag children[8];
} leafless_cursor_info;

/// Makes a cursor at the universe.
///
/// - Buffers: `cursor`, one pointer.
/// - Result: `*cursor`.
/// - Ownership: the cursor shares the octree, which may be freed; release `*cursor` with
///   leafless_cursor_free.
/// - Untrusted input: any octree.
leafless_status leafless_cursor_new(const leafless_octree *octree, leafless_cursor **cursor);

/// Releases a cursor.
///
/// - Buffers: `cursor`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
void leafless_cursor_free(leafless_cursor *cursor);

/// Returns the state of a cursor.
///
/// - Buffers: `state`, one struct.
/// - Result: `*state`.
/// - Threads: any, while no thread moves the cursor.
/// - Untrusted input: any octree.
leafless_status leafless_cursor_describe(const leafless_cursor *cursor, leafless_cursor_info *state);

/// Moves a cursor to a child of its cell. On a cell that is not a BRANCH it does not move.
///
/// - Buffers: `moved`, one truth value, or NULL. `octant` is 0 to 7.
/// - Result: `*moved`, whether the cell is a BRANCH.
/// - Errors: LEAFLESS_E_ARGUMENT if `octant` is not 0 to 7.
/// - Threads: no other call may use the cursor.
/// - Untrusted input: any octree; damage reads as PARTIAL, so that a walk visits every cell at most once.
leafless_status leafless_cursor_descend(leafless_cursor *cursor, uint32_t octant, bool *moved);

/// Moves a cursor to the parent of its cell. On the universe it does not move.
///
/// - Buffers: `moved`, one truth value, or NULL.
/// - Result: `*moved`, whether there is a parent.
/// - Threads: no other call may use the cursor.
/// - Untrusted input: any octree.
leafless_status leafless_cursor_ascend(leafless_cursor *cursor, bool *moved);

/// A cell of an octree and its tag.
typedef struct leafless_cell {
    /// The cell's index on each axis among the cells of its level: its lower corner in units of its edge.
    uint32_t cell[3];
    uint32_t level;  ///< The cell's level; 0 is the universe.
    leafless_tag tag;  ///< The cell's tag.
} leafless_cell;

/// A square between two cells that are not split: one with a requested tag, and one with another tag. It is a
/// whole face of the smaller cell.
typedef struct leafless_boundary_face {
    leafless_cell inner;  ///< The cell with a requested tag.
    /// The cell with another tag. Outside the universe: the inner cell's index and level, with the exterior's
    /// tag.
    leafless_cell outer;
    uint8_t axis;  ///< The axis from the inner cell to the outer one: 0 is x, 1 y, 2 z.
    bool is_upper;  ///< Whether the outer cell lies above the inner one on that axis.
    bool has_outer;  ///< Whether the outer cell lies in the universe.
} leafless_boundary_face;

/// A set of tags: one of these values, or several joined by `|`.
LEAFLESS_ENUM(leafless_tags, uint32_t) {
    LEAFLESS_TAGS_EMPTY = 1,  ///< EMPTY cells.
    LEAFLESS_TAGS_BRANCH = 2,  ///< BRANCH cells: cells that are split.
    LEAFLESS_TAGS_PARTIAL = 4,  ///< PARTIAL cells.
    LEAFLESS_TAGS_FULL = 8,  ///< FULL cells.
    LEAFLESS_TAGS_LEAVES = 13,  ///< All cells that are not split.
};

/// Returns the box of a cell of any level, in model units, rounded outward to the nearest doubles.
///
/// - Buffers: `frame`, one struct; `cell`, 3 numbers; `min_model` and `max_model`, room for 3 numbers each.
/// - Result: `min_model` and `max_model`; the exact corners if these are doubles.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check, if `level` is greater than the frame's depth, or a
///   coordinate of `cell` not below 2^level.
/// - Untrusted input: any values.
leafless_status leafless_frame_cell_bounds(const leafless_frame *frame, const uint32_t cell[3],
    uint32_t level, double min_model[3], double max_model[3]);

/// Moves a cursor to a cell, or to the cell that contains it and is not split. O(levels below the common
/// ancestor).
///
/// - Buffers: `cell`, 3 numbers; `reached`, one truth value, or NULL.
/// - Result: `*reached`, whether the cursor is at the cell itself.
/// - Errors: LEAFLESS_E_ARGUMENT if `level` is greater than the octree's depth, or a coordinate of `cell` not
///   below 2^level; then the cursor does not move.
/// - Threads: no other call may use the cursor.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
leafless_status leafless_cursor_seek(leafless_cursor *cursor, const uint32_t cell[3], uint32_t level,
    bool *reached);

/// Returns the neighbour of a cursor's cell across a face, an edge or a vertex: the cell of the same size,
/// which is a BRANCH if it is split, or the larger cell that contains it and is not split. The cursor does
/// not move. Amortised O(1) along a walk, at most O(depth).
///
/// - Buffers: `direction`, 3 numbers of -1, 0 and 1: the steps along x, y and z; `neighbour`, one struct;
///   `exists`, one truth value, or NULL.
/// - Result: `*neighbour`; `*exists`, whether it lies in the universe. If not, `*neighbour` is the cursor's
///   own cell with the exterior's tag.
/// - Errors: LEAFLESS_E_ARGUMENT if `direction` is not a direction.
/// - Threads: any, while no thread moves the cursor.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
leafless_status leafless_cursor_neighbour(const leafless_cursor *cursor, const int32_t direction[3],
    leafless_cell *neighbour, bool *exists);

/// Returns all cells that are not split and touch a cursor's cell on one side: one cell that is at least as
/// large, or the smaller cells at its face, edge or vertex, in Morton order.
///
/// - Buffers: `direction`, 3 numbers of -1, 0 and 1: the steps along x, y and z; `cells`, room for `capacity`
///   structs, or NULL to get only the count; `count`, one number.
/// - Result: `*count`, 0 if the side lies on the boundary of the universe; the cells.
/// - Errors: LEAFLESS_E_ARGUMENT if `direction` is not a direction; LEAFLESS_E_BUFFER if the capacity is too
///   small.
/// - Threads: any, while no thread moves the cursor.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL, and no array element is visited
///   twice.
leafless_status leafless_cursor_neighbours(const leafless_cursor *cursor, const int32_t direction[3],
    leafless_cell *cells, uint64_t capacity, uint64_t *count);

/// Makes an iterator over the cells of an octree with some tags, on some levels, in a box, in Morton order. A
/// cell that is split comes before the cells in it. The iterator reads no parts of the octree outside the box
/// or below the levels.
///
/// - Buffers: `min_cell` and `max_cell`, 3 numbers each, or both NULL for the whole universe: the first
///   finest cell of the box on each axis, and the first cell beyond it; `cells`, one pointer. `tags` are
///   leafless_tags. `min_level` and `max_level` may be greater than the depth.
/// - Result: `*cells`, positioned before the first such cell.
/// - Errors: LEAFLESS_E_ARGUMENT if `tags` is not a combination of leafless_tags.
/// - Ownership: `*cells` shares the octree, which may be freed; release it with leafless_cells_free.
/// - Untrusted input: any octree, any numbers.
leafless_status leafless_cells_new(const leafless_octree *octree, uint32_t tags, uint32_t min_level,
    uint32_t max_level, const uint32_t min_cell[3], const uint32_t max_cell[3], leafless_cells **cells);

/// Frees an iterator over cells.
///
/// - Buffers: `cells`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
void leafless_cells_free(leafless_cells *cells);

/// Moves an iterator to a cell: the next cell is that cell, or the cell that contains it and is not split, or
/// the first requested cell after it in Morton order. O(depth).
///
/// - Buffers: `cell`, 3 numbers.
/// - Errors: LEAFLESS_E_ARGUMENT if `level` is greater than the octree's depth, or a coordinate of `cell` not
///   below 2^level; then nothing changes.
/// - Threads: no other call may use `cells`.
/// - Untrusted input: any octree, any numbers.
leafless_status leafless_cells_seek(leafless_cells *cells, const uint32_t cell[3], uint32_t level);

/// Reads the next cells.
///
/// - Buffers: `buffer`, room for `capacity` structs, which may be NULL if `capacity` is 0; `count`, one
///   number.
/// - Result: the cells; `*count`, their number: less than `capacity` only if there are no more.
/// - Threads: no other call may use `cells`.
/// - Untrusted input: any octree; damage reads as PARTIAL, and no array element is visited twice.
leafless_status leafless_cells_next(leafless_cells *cells, leafless_cell *buffer, uint64_t capacity,
    uint64_t *count);

/// Makes an iterator over the boundary faces of an octree: faces between cells with some tags and cells with
/// other tags, both not split. FULL gives the boundary of the region that is certainly solid; FULL and
/// PARTIAL that of the region that is possibly solid. Where cells of different sizes meet, there is one face
/// for each of the smaller cells. The space outside the universe has the exterior's tag. Faces come in Morton
/// order of the inner cells, for each inner cell in the order -z, -y, -x, +x, +y, +z, and for each side in
/// the Morton order of the outer cells.
///
/// - Buffers: as leafless_cells_new; levels and box apply to the inner cells; `faces`, one pointer. BRANCH
///   among the tags is ignored.
/// - Result: `*faces`, positioned before the first face.
/// - Errors: LEAFLESS_E_ARGUMENT if `tags` is not a combination of leafless_tags.
/// - Ownership: `*faces` shares the octree, which may be freed; release it with leafless_faces_free.
/// - Untrusted input: any octree, any numbers.
leafless_status leafless_faces_new(const leafless_octree *octree, uint32_t tags, uint32_t min_level,
    uint32_t max_level, const uint32_t min_cell[3], const uint32_t max_cell[3], leafless_faces **faces);

/// Frees an iterator over boundary faces.
///
/// - Buffers: `faces`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
void leafless_faces_free(leafless_faces *faces);

/// Moves an iterator to the faces of a cell, or of the cell that contains it and is not split, or of the
/// first requested cell after it in Morton order. O(depth).
///
/// - Buffers: `cell`, 3 numbers.
/// - Errors: LEAFLESS_E_ARGUMENT if `level` is greater than the octree's depth, or a coordinate of `cell` not
///   below 2^level; then nothing changes.
/// - Threads: no other call may use `faces`.
/// - Untrusted input: any octree, any numbers.
leafless_status leafless_faces_seek(leafless_faces *faces, const uint32_t cell[3], uint32_t level);

/// Reads the next faces.
///
/// - Buffers: `buffer`, room for `capacity` structs, which may be NULL if `capacity` is 0; `count`, one
///   number.
/// - Result: the faces; `*count`, their number: less than `capacity` only if there are no more.
/// - Threads: no other call may use `faces`.
/// - Untrusted input: any octree; damage reads as PARTIAL. An array element is visited once for its own
///   cells, and at most six times for neighbouring cells, as in a sound octree.
leafless_status leafless_faces_next(leafless_faces *faces, leafless_boundary_face *buffer, uint64_t capacity,
    uint64_t *count);

/// Writes the cells of a level in a box as bits: `inner` has the FULL cells, and `outer` the cells that are
/// not EMPTY. Cells that are only in `outer` are PARTIAL or split further.
///
/// The bit of the cell min_cell + (x, y, z) is bit x mod 64 of word x / 64 + w (y + ny z), where w = ⌈nx /
/// 64⌉, and nx, ny and nz are max_cell - min_cell: x varies fastest, each row begins with a word of its own,
/// and bits beyond a row are 0. This is the layout LEAFLESS_SAMPLE_TYPE_BITS, from which leafless_volume_new
/// makes a volume.
///
/// Time is linear in the words and the array elements in the box.
///
/// - Buffers: `min_cell` and `max_cell`, 3 numbers each: the first cell of the box, and the first cell beyond
///   it on each axis, in cells of `level`, which is 0 for the universe and the frame's depth for the finest;
///   `options`, one struct or NULL (its limits are ignored); `inner` and `outer`, room for `capacity` words
///   each. `inner` is NULL to get only the count; `outer` may be NULL if it is not wanted. `count`, one
///   number.
/// - Result: `*count`, the number of words of a bitmap, w ny nz; the words, identical for any number of
///   threads.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no such level, min > max on an axis, or the box is not within
///   the universe; LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
leafless_status leafless_octree_bitmap(const leafless_octree *octree, uint32_t level,
    const uint32_t min_cell[3], const uint32_t max_cell[3], const leafless_options *options, uint64_t *inner,
    uint64_t *outer, uint64_t capacity, uint64_t *count);

/* ---- 18. Rays, columns, heights ----------------------------------------------------------------------- */

/// A half-line or a segment: the points origin + t · direction with 0 ≤ t ≤ t_last. Each coordinate is 0 or
/// has a magnitude between 2^-256 and 2^256.
typedef struct leafless_ray {
    double origin_model[3];  ///< The start of the ray.
    /// The direction, not zero, of any length. t is a distance if the length is 1.
    double direction_model[3];
    /// The greatest t: INFINITY for a half-line, or between 2^-256 and 2^256; 1 for the segment from
    /// `origin_model` to `origin_model` + `direction_model`.
    double t_last;
} leafless_ray;

/// The first hit of a ray with a solid.
typedef struct leafless_ray_hit {
    /// The interval that contains the least t at which the ray is in the solid: before `lower` the ray is
    /// proven outside, at `upper` inside. `upper` is INFINITY if the ray is nowhere proven inside; then it
    /// may miss the solid. Both are INFINITY if nothing stops the ray.
    leafless_interval t;
    /// The outward normal of the face through which the ray enters the cell, or of the surface if the solid
    /// provides it. Its length is 1 up to rounding; it is zero if the ray starts in the cell, or nothing
    /// stops it.
    double normal[3];
    /// The index, on each axis, of the first cell that stops the ray among the cells of its level.
    uint32_t cell[3];
    uint32_t level;  ///< The cell's level; 0 is the universe.
    /// The number of the surface that stops the ray, if the solid answers rays itself: for a mesh, the
    /// triangle's index. UINT32_MAX otherwise, and where the ray meets the closure of a hole of a mesh.
    uint32_t surface;
    bool is_hit;  ///< Whether something stops the ray.
} leafless_ray_hit;

/// The cells that stop a ray.
LEAFLESS_ENUM(leafless_obstacle, uint32_t) {
    LEAFLESS_OBSTACLE_FULL = 0,  ///< Proven solid cells: FULL.
    LEAFLESS_OBSTACLE_UPPER = 1,  ///< Possibly solid cells: FULL and PARTIAL.
};

/// The verdict on a line of sight between two points past a solid.
LEAFLESS_ENUM(leafless_sight, uint8_t) {
    LEAFLESS_SIGHT_CLEAR = 0,  ///< Proven: no point of the segment lies in the solid.
    LEAFLESS_SIGHT_BLOCKED = 1,  ///< Proven: some point of the segment lies in the solid, or on its surface.
    LEAFLESS_SIGHT_UNDECIDED = 2,  ///< Neither could be proven with the cells of the frame.
};

/// Finds the first hits of rays with an octree's cells, regardless of their proofs about the original solid.
/// Space outside the universe is ignored. A ray visits at most 3 · 2^depth cells, usually about a dozen.
///
/// - Buffers: `rays`, `count` structs; `hits`, room for `count`. Both may be NULL if `count` is 0. `on` is a
///   leafless_obstacle.
/// - Result: `hits[i]` for ray i.
/// - Errors: LEAFLESS_E_ARGUMENT if `on` is not a leafless_obstacle, or a ray violates the ranges of
///   leafless_ray.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
leafless_status leafless_octree_cast_rays(const leafless_octree *octree, const leafless_ray *rays,
    uint64_t count, leafless_obstacle on, leafless_ray_hit *hits);

/// Finds the first hits of rays with a solid, without an octree, as far as the cells of the frame decide it;
/// in the finest cells the solid's own surfaces refine the hit. Space outside the universe is ignored. A ray
/// splits the PARTIAL cells that it passes up to the first FULL one: O(depth) cells across a surface, up to
/// O(2^depth) along one.
///
/// - Buffers: `frame`, one struct; `rays`, `count` structs; `options`, one struct or NULL (its limit
///   `max_splits` applies to each ray separately: cells that were not split count as PARTIAL); `hits`, room
///   for `count`. `rays` and `hits` may be NULL if `count` is 0. `on` is a leafless_obstacle.
/// - Result: `hits[i]` for ray i; identical for any number of threads.
/// - Errors: LEAFLESS_E_ARGUMENT if `on` is not a leafless_obstacle, or a ray violates the ranges of
///   leafless_ray; otherwise as leafless_solid_contains_many.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid, any numbers; set `max_splits` if the depth or the solid is untrusted.
leafless_status leafless_solid_cast_rays(const leafless_solid *solid, const leafless_frame *frame,
    const leafless_ray *rays, uint64_t count, leafless_obstacle on, const leafless_options *options,
    leafless_ray_hit *hits);

/// Returns the intervals of a ray in an octree's cells, regardless of their proofs about the original solid:
/// ascending, disjoint intervals of t. Space outside the universe is ignored. O(cells along the ray · depth).
///
/// - Buffers: `ray`, one struct; `inner` and `outer`, room for `inner_capacity` and `outer_capacity` structs,
///   each NULL to get only its count; `inner_count` and `outer_count`, one number each.
/// - Result: `inner`, the intervals in FULL cells, rounded inward; `outer`, the intervals in FULL or PARTIAL
///   cells, rounded outward; their counts.
/// - Errors: LEAFLESS_E_ARGUMENT if the ray violates the ranges of leafless_ray; LEAFLESS_E_BUFFER if a
///   capacity is too small: nothing is written then; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
leafless_status leafless_octree_ray_spans(const leafless_octree *octree, const leafless_ray *ray,
    leafless_interval *inner, uint64_t inner_capacity, uint64_t *inner_count, leafless_interval *outer,
    uint64_t outer_capacity, uint64_t *outer_count);

/// Returns the intervals of a ray in a solid, without an octree, as far as the cells of the frame decide it:
/// ascending, disjoint intervals of t. Space outside the universe is ignored. The ray splits all PARTIAL
/// cells that it passes: O(depth) cells where it crosses a surface, up to O(2^depth) along one. Returning
/// only the counts costs as much as returning the intervals.
///
/// - Buffers: as leafless_octree_ray_spans; `frame`, one struct; `options`, one struct or NULL (with its
///   limit `max_splits`: cells that were not split count as PARTIAL).
/// - Result: `inner`, the intervals proven inside, rounded inward; `outer`, the intervals not proven outside,
///   rounded outward; their counts.
/// - Errors: LEAFLESS_E_ARGUMENT if the ray violates the ranges of leafless_ray; LEAFLESS_E_BUFFER if a
///   capacity is too small: nothing is written then; otherwise as leafless_solid_contains_many.
/// - Untrusted input: any solid, any numbers; set `max_splits` if the depth or the solid is untrusted.
leafless_status leafless_solid_ray_spans(const leafless_solid *solid, const leafless_frame *frame,
    const leafless_ray *ray, const leafless_options *options, leafless_interval *inner,
    uint64_t inner_capacity, uint64_t *inner_count, leafless_interval *outer, uint64_t outer_capacity,
    uint64_t *outer_count);

/// Returns whether two points see each other past a solid, without an octree, as far as the cells of the
/// frame decide it. If the solid may extend beyond the universe and a point lies there, the answer is not
/// LEAFLESS_SIGHT_CLEAR. Costs as much as one ray of leafless_solid_cast_rays.
///
/// - Buffers: `frame`, one struct; `from_model` and `to_model`, 3 numbers each; `options`, one struct or NULL
///   (with its limit `max_splits`: cells that were not split count as PARTIAL); `sight`, one.
/// - Result: `*sight`.
/// - Errors: LEAFLESS_E_ARGUMENT if the points are equal, or a coordinate is neither 0 nor of a magnitude
///   between 2^-256 and 2^256; otherwise as leafless_solid_contains_many.
/// - Untrusted input: any solid, any numbers; set `max_splits` if the depth or the solid is untrusted.
leafless_status leafless_solid_line_of_sight(const leafless_solid *solid, const leafless_frame *frame,
    const double from_model[3], const double to_model[3], const leafless_options *options,
    leafless_sight *sight);

/// Consecutive finest cells of a column.
typedef struct leafless_run {
    uint32_t start;  ///< The coordinate of the lowest cell along the column.
    uint32_t length;  ///< Number of cells, at least one.
} leafless_run;

/// The side from which columns are viewed.
LEAFLESS_ENUM(leafless_side, uint32_t) {
    /// From above, towards lower coordinates: the height is that of the highest cell.
    LEAFLESS_SIDE_ABOVE = 0,
    LEAFLESS_SIDE_BELOW = 1,  ///< From below: the height is that of the lowest cell.
};

/// Returns the solid cells of an octree in a rectangle of columns, regardless of their proofs about the
/// original solid. A column is a row of finest cells along an axis, from one side of the universe to the
/// other. It stands for all lines along the axis within it, such as the ray through the centres of its cells.
/// O(cells in the columns + columns · cells along each), where a stored cell counts once.
///
/// - Buffers: `first` and `end`, 2 numbers each, or both NULL for all columns: the coordinates of the first
///   column's cells on the other two axes in the order x, y, z, and the first coordinates beyond the last
///   column; `columns`, one pointer. `axis` is 0 for x, 1 for y, 2 for z.
/// - Result: `*columns`, to be read with leafless_columns_copy.
/// - Errors: LEAFLESS_E_ARGUMENT if `axis` is greater than 2, `first` lies beyond `end`, or the columns reach
///   beyond the universe; LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*columns` with leafless_columns_free.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL, and no array element is visited
///   twice.
leafless_status leafless_octree_columns(const leafless_octree *octree, uint32_t axis, const uint32_t first[2],
    const uint32_t end[2], leafless_columns **columns);

/// Returns the solid cells of a frame in a rectangle of columns, without an octree: all PARTIAL cells in the
/// columns are split down to the frame's depth.
///
/// - Buffers: as leafless_octree_columns; `frame`, one struct; `options`, one struct or NULL (only its limit
///   `max_bytes` applies).
/// - Result: `*columns`, to be read with leafless_columns_copy; identical for any number of threads.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_octree_columns; LEAFLESS_E_LIMIT if the result takes more than
///   `max_bytes`; otherwise as leafless_solid_contains_many.
/// - Ownership: release `*columns` with leafless_columns_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid, any numbers; choose the depth and the rectangle yourself.
leafless_status leafless_solid_columns(const leafless_solid *solid, const leafless_frame *frame,
    uint32_t axis, const uint32_t first[2], const uint32_t end[2], const leafless_options *options,
    leafless_columns **columns);

/// Copies the runs of solid cells in columns, in compressed rows: the runs of column i are `runs[offsets[i]]`
/// up to, but not including, `runs[offsets[i + 1]]`. They ascend, and no two of them touch. In a rectangle
/// that is `width` columns wide along the first of the other two axes, the column at steps (u, v) from the
/// first has the index i = v · width + u.
///
/// - Buffers: `offsets`, room for `offset_capacity` numbers, and `runs`, room for `run_capacity` structs,
///   each NULL to get only its count; `offset_count` and `run_count`, one number each. `on` is a
///   leafless_obstacle: FULL for cells that are proven solid, UPPER for cells that may be solid.
/// - Result: `offsets`, one more than columns; `runs`; their counts.
/// - Errors: LEAFLESS_E_ARGUMENT if `on` is not a leafless_obstacle; LEAFLESS_E_BUFFER if a capacity is too
///   small: nothing is written then.
leafless_status leafless_columns_copy(const leafless_columns *columns, leafless_obstacle on,
    uint64_t *offsets, uint64_t offset_capacity, uint64_t *offset_count, leafless_run *runs,
    uint64_t run_capacity, uint64_t *run_count);

/// Frees columns.
///
/// - Buffers: `columns`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
void leafless_columns_free(leafless_columns *columns);

/// Computes a height map: how far an octree's solid cells reach in a rectangle of columns, regardless of
/// their proofs about the original solid. It costs as much as leafless_octree_columns.
///
/// - Buffers: `first` and `end` as leafless_octree_columns; `heights_model`, room for `capacity` structs, or
///   NULL to get only the count; `count`, one number. `side` is a leafless_side.
/// - Result: `*count`, the number of columns; for each column, in the order of leafless_columns_copy, an
///   interval that contains the greatest coordinate of the solid's points in the column, or from below the
///   least one. The end that needs a proof is infinite if no cell of the column is FULL. Both are -INFINITY
///   (from below INFINITY) if the column is empty.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_octree_columns, or if `side` is not a leafless_side;
///   LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL, and no array element is visited
///   twice.
leafless_status leafless_octree_heights(const leafless_octree *octree, uint32_t axis, const uint32_t first[2],
    const uint32_t end[2], leafless_side side, leafless_interval *heights_model, uint64_t capacity,
    uint64_t *count);

/// Computes a height map: how far a solid reaches in a rectangle of columns, without an octree, as far as the
/// cells of the frame decide it. PARTIAL cells in the columns are split down to the frame's depth, unless
/// FULL cells hide them.
///
/// - Buffers: as leafless_octree_heights; `frame`, one struct; `options`, one struct or NULL (only its limit
///   `max_bytes` applies).
/// - Result: as leafless_octree_heights; identical for any number of threads.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_octree_heights; LEAFLESS_E_BUFFER if the capacity is too small;
///   LEAFLESS_E_LIMIT if the result takes more than `max_bytes`; otherwise as leafless_solid_contains_many.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid, any numbers; choose the depth and the rectangle yourself.
leafless_status leafless_solid_heights(const leafless_solid *solid, const leafless_frame *frame,
    uint32_t axis, const uint32_t first[2], const uint32_t end[2], leafless_side side,
    const leafless_options *options, leafless_interval *heights_model, uint64_t capacity, uint64_t *count);

/* ---- 19. Volumes, areas, bounding boxes --------------------------------------------------------------- */

/// Bounds on the number of finest cells of a solid in a region. A cell where the region is FULL lies in the
/// region, a cell where it is EMPTY does not, and a cell where it is PARTIAL may. So the bounds hold whether
/// a cell counts if all of it lies in the region, if its centre does, or if it shares any volume with the
/// region.
typedef struct leafless_cells_in {
    uint64_t full_least;  ///< FULL cells of the solid that are proven to lie in the region.
    uint64_t full_most;  ///< FULL cells of the solid that may lie in the region.
    uint64_t upper_least;  ///< FULL and PARTIAL cells of the solid that are proven to lie in the region.
    uint64_t upper_most;  ///< FULL and PARTIAL cells of the solid that may lie in the region.
} leafless_cells_in;

/// Counts the finest cells in a box that are certainly solid (FULL), and those that are possibly solid (FULL
/// or PARTIAL).
///
/// - Buffers: `min_cell` and `max_cell`, 3 numbers each: the first finest cell of the box, and the first cell
///   beyond it on each axis; `least` and `most`, one number each.
/// - Result: `*least` and `*most`.
/// - Errors: LEAFLESS_E_ARGUMENT if min > max on an axis, or the box is not within the universe.
/// - Untrusted input: any octree, any numbers; no array element is read twice; damage reads as PARTIAL.
leafless_status leafless_octree_cells_in_box(const leafless_octree *octree, const uint32_t min_cell[3],
    const uint32_t max_cell[3], uint64_t *least, uint64_t *most);

/// Returns the volume that the solid of an octree shares with a box at any position. FULL cells bound it from
/// below, FULL and PARTIAL cells from above. Cells that the box cuts count with their part in the box,
/// rounded outward. Space outside the universe is ignored.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `volume_model`, one struct.
/// - Result: `*volume_model`, in cubic model units.
/// - Errors: LEAFLESS_E_ARGUMENT if min > max on an axis, or a coordinate is not a number.
/// - Untrusted input: any octree, any numbers; no array element is read more than 27 times; damage reads as
///   PARTIAL.
leafless_status leafless_octree_volume_in_box(const leafless_octree *octree, const double min_model[3],
    const double max_model[3], leafless_interval *volume_model);

/// Classifies a region, which is a ball or any other solid, against a solid, as far as the cells of the frame
/// decide it. LEAFLESS_REGION_INSIDE means that all of the region lies in the solid; LEAFLESS_REGION_OUTSIDE
/// that the interiors are disjoint, also if the region is empty; LEAFLESS_REGION_CROSSING that a part of the
/// region lies in the solid and a part does not. The work ends as soon as the answer is known, or when
/// `max_splits` cells of both are split.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `relation`, one.
/// - Result: `*relation`.
/// - Errors: LEAFLESS_E_FRAME if solid or region belong to another frame; LEAFLESS_E_ARGUMENT as
///   leafless_frame_check; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any solids; set `max_splits` if the depth or the solids are untrusted.
leafless_status leafless_solid_classify_in(const leafless_solid *solid, const leafless_solid *region,
    const leafless_frame *frame, const leafless_options *options, leafless_region *relation);

/// Counts the finest cells of an octree in a region, which is a ball or any other solid. The octree's cells
/// count as they are, regardless of their proofs; unproven tags of the region count as PARTIAL. Space outside
/// the universe is ignored.
///
/// Where the region is FULL, whole subtrees are counted, 64 cells at a time; where it is EMPTY, nothing is
/// read; where it is undecided and the octree is not EMPTY, it is split, down to the octree's depth. When
/// `max_splits` cells of both are split, the others count as undecided.
///
/// - Buffers: `options`, one struct or NULL; `cells`, one struct.
/// - Result: `*cells`.
/// - Errors: LEAFLESS_E_FRAME if the region belongs to another frame; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED
///   if the region is damaged; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree, any region; no array element is read twice; damage reads as PARTIAL; set
///   `max_splits` if the depth or the region is untrusted.
leafless_status leafless_octree_cells_in(const leafless_octree *octree, const leafless_solid *region,
    const leafless_options *options, leafless_cells_in *cells);

/// Returns the volume that the solid of an octree shares with a region. FULL cells bound it from below, FULL
/// and PARTIAL cells from above. In a finest cell that the region cuts, the precision is that of the region's
/// own bounds: third order for a ball. Space outside the universe is ignored. The work is that of
/// leafless_octree_cells_in, with a microsecond or two more for each cell that is cut.
///
/// - Buffers: `options`, one struct or NULL; `volume_model`, one struct.
/// - Result: `*volume_model`, in cubic model units.
/// - Errors: as leafless_octree_cells_in.
/// - Untrusted input: as leafless_octree_cells_in.
leafless_status leafless_octree_volume_in(const leafless_octree *octree, const leafless_solid *region,
    const leafless_options *options, leafless_interval *volume_model);

/// Counts the finest cells of a frame that lie in a solid and in a region, which is a ball or any other
/// solid. Unproven tags of either count as PARTIAL. Space outside the universe is ignored. No octree is made:
/// the time is about that of splitting the region's boundary inside the solid and the solid's boundary inside
/// the region, and the memory is proportional to the depth. When `max_splits` cells of both are split, the
/// others count as undecided.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `cells`, one struct.
/// - Result: `*cells`.
/// - Errors: LEAFLESS_E_FRAME if solid or region belong to another frame; LEAFLESS_E_ARGUMENT as
///   leafless_frame_check; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any solids; set `max_splits` if the depth or the solids are untrusted.
leafless_status leafless_solid_cells_in(const leafless_solid *solid, const leafless_solid *region,
    const leafless_frame *frame, const leafless_options *options, leafless_cells_in *cells);

/// Returns the volume that a solid and a region share inside a frame's universe: an interval that contains
/// the truth. In a finest cell, the precision is that of the own bounds of solid and region. The work is that
/// of leafless_solid_cells_in, with a microsecond or two more for each cell that is cut. (To split until a
/// volume is known to a tolerance, use leafless_solid_measure on the intersection.)
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `volume_model`, one struct.
/// - Result: `*volume_model`, in cubic model units.
/// - Errors: as leafless_solid_cells_in.
/// - Untrusted input: as leafless_solid_cells_in.
leafless_status leafless_solid_volume_in(const leafless_solid *solid, const leafless_solid *region,
    const leafless_frame *frame, const leafless_options *options, leafless_interval *volume_model);

/// The reason why a search or a measurement ended.
LEAFLESS_ENUM(leafless_stop_reason, uint32_t) {
    LEAFLESS_STOP_REASON_TOLERANCE = 0,  ///< The result has the requested precision.
    /// `max_splits` of the options, or the function's default limit, is spent.
    LEAFLESS_STOP_REASON_BUDGET = 1,
    /// No cell is left whose split would help: undecided cells have the size of the frame's finest cells, or
    /// the solid itself has no more information about them, such as an octree about its PARTIAL cells.
    LEAFLESS_STOP_REASON_EXHAUSTED = 2,
};

/// Mass properties of a solid of density 1. All intervals contain the truth. They are those of the part
/// inside the universe, which is the whole solid unless `is_clipped`.
typedef struct leafless_measures {
    uint32_t struct_size;  ///< sizeof(leafless_measures).
    leafless_interval volume_model;  ///< Volume.
    leafless_interval centroid_model[3];  ///< Centroid; intervals of all numbers unless `has_centroid`.
    /// Tensor of inertia about the model's origin, row by row: the integral of |p|²δij - pi·pj over the
    /// points p of the solid. So products of inertia are negative where the product of the coordinates is
    /// mostly positive.
    leafless_interval inertia_origin_model[9];
    /// Tensor of inertia about the centroid, for every position of the centroid in its interval.
    leafless_interval inertia_centroid_model[9];
    leafless_proof proof;  ///< The proofs about the solid; unproven tags count as undecided.
    uint64_t splits;  ///< Number of cell splits.
    uint32_t level;  ///< The finest level of the visited cells.
    leafless_stop_reason measured;  ///< The reason why the computation ended.
    /// Whether a cell is proven full. Otherwise the solid may be empty, and the centroid is not known.
    bool has_centroid;
    bool is_clipped;  ///< Whether the solid may extend beyond the universe, or does.
    /// Whether the solid was not split because it provides its own moments, up to rounding, as a closed mesh
    /// without intersecting triangles does.
    bool is_exact;
} leafless_measures;

/// The area of a solid's boundary.
typedef struct leafless_surface_area {
    uint32_t struct_size;  ///< sizeof(leafless_surface_area).
    /// Area. The interval contains the truth; its upper end is infinite if the area has no known bound.
    leafless_interval area_model;
    uint64_t splits;  ///< Number of cell splits.
    uint32_t level;  ///< The finest level of the visited cells.
    leafless_stop_reason measured;  ///< The reason why the computation ended.
    /// Whether the solid may extend beyond the universe, or does; then the area is that of the boundary
    /// inside.
    bool is_clipped;
} leafless_surface_area;

/// The area of a solid's section with a plane.
typedef struct leafless_section_area {
    uint32_t struct_size;  ///< sizeof(leafless_section_area).
    leafless_interval area_model;  ///< Area. The interval contains the truth.
    leafless_proof proof;  ///< The proofs about the solid; unproven tags count as undecided.
    uint64_t splits;  ///< Number of cell splits.
    leafless_stop_reason measured;  ///< The reason why the computation ended.
    /// Whether the solid may extend beyond the universe, or does; then the area is that of the section
    /// inside.
    bool is_clipped;
} leafless_section_area;

/// Proven bounds of a solid's bounding box inside the universe.
typedef struct leafless_extent {
    uint32_t struct_size;  ///< sizeof(leafless_extent).
    leafless_interval min_model[3];  ///< Lower corner; intervals of all numbers if `is_empty`.
    leafless_interval max_model[3];  ///< Upper corner; intervals of all numbers if `is_empty`.
    leafless_proof proof;  ///< The proofs about the solid; unproven tags count as undecided.
    uint64_t splits;  ///< Number of cell splits.
    leafless_stop_reason measured;  ///< The reason why the computation ended.
    bool is_empty;  ///< Whether the solid is proven to be empty.
    /// Whether the solid is proven not to be empty. If neither is proven, the corners bound the region that
    /// may be solid.
    bool is_occupied;
    bool is_clipped;  ///< Whether the solid may extend beyond the universe, or does.
} leafless_extent;

/// Measures a solid in the universe of a frame, without building an octree. The cells with the largest
/// uncertainty are split first, until the width of the volume's interval is at most `relative` times its
/// middle or at most `absolute_model` (cubic model units), until `max_splits` of the options is spent (2^26
/// splits if it is 0), or until no cell is left to split at the frame's depth. When the splits are spent, the
/// result is that of the last complete pass. The result is identical, bit for bit, for any number of threads.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL (`max_nodes` and `max_bytes` are ignored);
///   `measures`, one struct.
/// - Result: `*measures`.
/// - Errors: LEAFLESS_E_ARGUMENT, also if a tolerance is negative or not a number; LEAFLESS_E_FRAME if the
///   solid belongs to another frame; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid; set `max_splits` if the depth or the solid is untrusted.
leafless_status leafless_solid_measure(const leafless_solid *solid, const leafless_frame *frame,
    double relative, double absolute_model, const leafless_options *options, leafless_measures *measures);

/// Computes the area of a solid's boundary in the universe of a frame, as leafless_solid_measure computes the
/// volume: `relative` and `absolute_model` (square model units) bound the width of the interval, and if
/// `max_splits` of the options is 0, the search ends after 2^23 splits. With N splits the width decreases as
/// 1/N on curved surfaces; plane faces are exact. If faces lie in planes of the frame's lattice, and the
/// solid ends inside the universe, another lattice is used. For an octree that keeps surfaces, an octree
/// without undecided cells, and an expression that is clipped, the faces between cells are added up. The area
/// of other octrees, of a host program's functions, and of a clipped mesh with such faces is not known.
///
/// - Buffers: as leafless_solid_measure; `surface`, one struct.
/// - Result: `*surface`.
/// - Errors: as leafless_solid_measure.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid; the default of `max_splits` bounds the work.
leafless_status leafless_solid_surface_area(const leafless_solid *solid, const leafless_frame *frame,
    double relative, double absolute_model, const leafless_options *options, leafless_surface_area *surface);

/// Computes the area of a solid's section with a plane, in the universe of a frame. The plane goes through a
/// point, perpendicular to a normal of any length and either direction. The search splits only cells that the
/// plane crosses. It ends with LEAFLESS_STOP_REASON_TOLERANCE if the interval is no wider than `relative`
/// times its middle, or than `absolute_model` (square model units); with LEAFLESS_STOP_REASON_EXHAUSTED if no
/// cell is left whose split would help; with LEAFLESS_STOP_REASON_BUDGET after `max_splits` of the options,
/// or 2^20 splits if that is 0. With N splits the width decreases as 1/N² on curved surfaces of half-spaces
/// and expressions of them, and as 1/N for other solids; plane faces of expressions are exact up to rounding.
///
/// If faces of the solid lie in the plane, the sections on both sides of it differ. The section with a plane
/// perpendicular to an axis is the limit from above, or, in the universe's upper face, the limit from below.
/// If it is a plane of the lattice, the cells above it count, and faces in the plane cause no uncertainty.
/// For any other plane the interval contains the limits from both sides, and faces in the plane widen it.
///
/// - Buffers: as leafless_solid_measure; `point_model` and `normal`, 3 numbers each; `section`, one struct.
/// - Result: `*section`.
/// - Errors: as leafless_solid_measure, and LEAFLESS_E_ARGUMENT also if the normal is zero, or a number of
///   point or normal is neither 0 nor of a magnitude between 2^-256 and 2^256.
/// - Threads: any; works in the calling thread.
/// - Untrusted input: any solid, any numbers; the default of `max_splits` bounds the work.
leafless_status leafless_solid_section_area(const leafless_solid *solid, const leafless_frame *frame,
    const double point_model[3], const double normal[3], double relative, double absolute_model,
    const leafless_options *options, leafless_section_area *section);

/// Computes the bounding box of a solid in the universe of a frame: six intervals, one for each side. The
/// search splits only cells that may reach beyond the proven part of the solid. It ends with
/// LEAFLESS_STOP_REASON_TOLERANCE if no interval is wider than `tolerance_model`, or than 2^-44 of the
/// universe's edge; with LEAFLESS_STOP_REASON_EXHAUSTED if the outermost undecided cells cannot be split, and
/// either the interval is no wider than one of the frame's finest cells, or nothing else is left to split;
/// with LEAFLESS_STOP_REASON_BUDGET after `max_splits` of the options, or 2^20 splits if that is 0.
///
/// For half-spaces and expressions of them, a corner of three plane faces is exact up to rounding, and a
/// curved side is known to some 10^-12 of the universe's edge at depth 20, after some hundred splits; a side
/// that a cylinder touches along a line takes more. For other solids, with n the universe's edge divided by
/// the tolerance, a curved side takes some n splits; a flat side takes n² splits, unless it lies on a plane
/// of the lattice.
///
/// - Buffers: as leafless_solid_measure; `extent`, one struct.
/// - Result: `*extent`.
/// - Errors: as leafless_solid_measure, with `tolerance_model` for its tolerances.
/// - Untrusted input: any solid; the default of `max_splits` bounds the work.
leafless_status leafless_solid_bounding_box(const leafless_solid *solid, const leafless_frame *frame,
    double tolerance_model, const leafless_options *options, leafless_extent *extent);

/// The volume and the moments of a solid in some cells of its frame.
///
/// Sums are exact: they are the same in any order, and subtracting a sum that was added restores the earlier
/// sum. So several machines can measure the cells of one solid, and one machine adds the results.
///
/// The struct has no pointers. A program may store its bytes or send them to another machine. Only the
/// version of the library that made a sum can read it. The functions refuse bytes that are not a sum, but
/// they cannot detect every damage.
typedef struct leafless_mass_sum {
    uint32_t struct_size;  ///< sizeof(leafless_mass_sum).
    uint8_t bytes[404];  ///< For internal use of the library.
} leafless_mass_sum;

/// Measures the part of a solid in one cell of a frame, as leafless_solid_measure measures the whole. The
/// tolerances apply to the volume in the cell. A solid that provides its own moments is split all the same.
///
/// If the solid is an octree without surfaces, and both tolerances are 0, the sum over all cells of a level
/// has the measures of the whole octree.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL (`max_nodes` and `max_bytes` are ignored);
///   `sum`, one struct. `code` is the code of a cell of level `level`, as in leafless_shard.
/// - Result: `*sum`.
/// - Errors: as leafless_solid_measure; LEAFLESS_E_ARGUMENT also if the frame does not have the cell.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid, any numbers; set `max_splits` if the depth or the solid is untrusted.
leafless_status leafless_solid_measure_cell(const leafless_solid *solid, const leafless_frame *frame,
    uint32_t level, uint64_t code, double relative, double absolute_model, const leafless_options *options,
    leafless_mass_sum *sum);

/// Returns the sum of a cell whose content is unknown. Adding it to a sum keeps the proofs of that sum.
///
/// To measure a top and its shards: take the sum of the top in the whole universe (level 0, code 0). For each
/// shard subtract the unknown sum of its cell, and add the sum of the shard in that cell.
///
/// - Buffers: `frame` and `sum`, one struct each. `code` is the code of a cell of level `level`, as in
///   leafless_shard.
/// - Result: `*sum`.
/// - Errors: LEAFLESS_E_ARGUMENT if the frame does not have the cell.
/// - Untrusted input: any numbers.
leafless_status leafless_mass_sum_unknown(const leafless_frame *frame, uint32_t level, uint64_t code,
    leafless_mass_sum *sum);

/// Adds two sums over disjoint sets of cells.
///
/// - Buffers: `a`, `b` and `sum`, one struct each; `sum` may be `a` or `b`.
/// - Result: `*sum`.
/// - Errors: LEAFLESS_E_ARGUMENT if `a` or `b` is not a sum of this version, or if the result exceeds the
///   universe, because a cell was added twice; LEAFLESS_E_FRAME if the frames differ.
/// - Untrusted input: any bytes; damaged sums give a wrong result.
leafless_status leafless_mass_sum_add(const leafless_mass_sum *a, const leafless_mass_sum *b,
    leafless_mass_sum *sum);

/// Subtracts the sum `b` over some cells of `a` from `a`. The result proves what `a` proves. The numbers of
/// splits are added.
///
/// - Buffers: as leafless_mass_sum_add.
/// - Result: `*sum`.
/// - Errors: LEAFLESS_E_ARGUMENT if `a` or `b` is not a sum of this version, or if the result would be
///   negative; LEAFLESS_E_FRAME if the frames differ.
/// - Untrusted input: any bytes; damaged sums give a wrong result.
leafless_status leafless_mass_sum_subtract(const leafless_mass_sum *a, const leafless_mass_sum *b,
    leafless_mass_sum *sum);

/// Returns volume, centroid and inertia of the solid in the cells of a sum. `is_exact` is false.
///
/// - Buffers: `sum` and `measures`, one struct each.
/// - Result: `*measures`.
/// - Errors: LEAFLESS_E_ARGUMENT if `sum` is not a sum of this version, or if the frame's universe is too
///   small for cells of level 20.
/// - Untrusted input: any bytes; a damaged sum gives wrong measures.
leafless_status leafless_mass_sum_measures(const leafless_mass_sum *sum, leafless_measures *measures);

/* ---- 20. Distance and interference -------------------------------------------------------------------- */

/// The set that a distance is measured to.
LEAFLESS_ENUM(leafless_distance_to, uint32_t) {
    LEAFLESS_DISTANCE_TO_SOLID = 0,  ///< To the solid: 0 for its points.
    LEAFLESS_DISTANCE_TO_COMPLEMENT = 1,  ///< To the complement of the solid: 0 for points outside.
    /// To the boundary, with a sign: positive outside the solid, negative inside.
    LEAFLESS_DISTANCE_TO_BOUNDARY = 2,
};

/// Bounds of the distance of a point from a solid.
typedef struct leafless_point_distance {
    /// The distance, in model units. The upper bound is infinite as long as no point of the set is proven,
    /// and the lower bound is infinite if the set is proven to be empty.
    leafless_interval distance_model;
    uint64_t splits;  ///< Number of cell splits.
    /// The nearest point of the boundary, up to rounding, if `has_nearest`; else zeros.
    double nearest_model[3];
    /// The number of the surface that the nearest point lies on: for a mesh, the triangle's index. If there
    /// are several, one that bounds the solid next to the point, if one is found. UINT32_MAX if there is
    /// none.
    uint32_t surface;
    leafless_stop_reason measured;  ///< The reason why the search ended.
    /// Whether the nearest point is known. A mesh inside the universe provides it with the triangle, unless
    /// the nearest triangle intersects another one, or the boundary may be nearer across a hole. For other
    /// solids it is known if the upper bound is finite, and its distance is at most that bound; but it is not
    /// known if the point may lie on the side of the boundary from which no distance is measured.
    bool has_nearest;
} leafless_point_distance;

/// A cell near a point.
typedef struct leafless_near_cell {
    /// The point of the closed cell that is nearest to the given point: each coordinate is that of the given
    /// point, or a rounded coordinate of a face of the cell.
    double point_model[3];
    /// The distance of the closed cell from the given point, rounded outward.
    leafless_interval distance_model;
    leafless_cell found;  ///< The cell and its tag.
} leafless_near_cell;

/// Computes the distances of points from the solid of an octree, its complement or its boundary, from the
/// octree's cells and its exterior. For the distance from the solid, FULL cells give the upper bound, FULL
/// and PARTIAL cells the lower bound. Points may lie outside the universe. Usually some dozen array elements
/// are read for each point.
///
/// - Buffers: `points_model`, `count` points of 3 numbers; `options`, one struct or NULL (its limits are
///   ignored); `distances_model`, room for `count`. `points_model` and `distances_model` may be NULL if
///   `count` is 0. `to` is a leafless_distance_to.
/// - Result: `distances_model[i]` for point i, identical for any number of threads: 0 to infinity if a
///   coordinate is not a finite number, or all numbers for LEAFLESS_DISTANCE_TO_BOUNDARY.
/// - Errors: LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL, and for each point at most twice as
///   many array elements are read as the octree has.
leafless_status leafless_octree_distances(const leafless_octree *octree, const double *points_model,
    uint64_t count, leafless_distance_to to, const leafless_options *options,
    leafless_interval *distances_model);

/// Computes the distances of points from a solid, its complement or its boundary, without an octree. Points
/// may lie outside the universe of the frame. The cells that may be nearest are split first.
///
/// `measured` of a result is the reason why the search for the point ended. With
/// LEAFLESS_STOP_REASON_TOLERANCE the interval is no wider than `tolerance_model` (model units), or both ends
/// are infinite. With LEAFLESS_STOP_REASON_EXHAUSTED no cell is left whose split would help, or, for a solid
/// without slabs, the nearest undecided cell cannot be split, and the interval is no wider than twice the
/// diagonal of the frame's finest cells. With LEAFLESS_STOP_REASON_BUDGET `max_splits` cells were split for
/// the point, or 65 536 if that is 0.
///
/// - Buffers: `frame`, one struct; `points_model`, `count` points of 3 numbers; `options`, one struct or
///   NULL; `distances`, room for `count`. `points_model` and `distances` may be NULL if `count` is 0. `to` is
///   a leafless_distance_to.
/// - Result: `distances[i]` for point i, identical for any number of threads.
/// - Errors: LEAFLESS_E_FRAME if the solid belongs to another frame; LEAFLESS_E_ARGUMENT as
///   leafless_frame_check, or if the tolerance is negative or not a number; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid, any numbers; the default of `max_splits` bounds the work.
leafless_status leafless_solid_distances(const leafless_solid *solid, const leafless_frame *frame,
    const double *points_model, uint64_t count, leafless_distance_to to, double tolerance_model,
    const leafless_options *options, leafless_point_distance *distances);

/// Returns the cells of an octree with tags in `tags` that are nearest to a point, the nearest first; equally
/// near cells come in Morton order. A cell is closed, has its stored size, and is not a BRANCH. With
/// LEAFLESS_TAGS_FULL and a capacity of 1 this is the nearest cell that is proven solid. The point may lie
/// outside the universe. Before cells are compared, the point is rounded to 2^-56 of the universe's edge, or,
/// if it is far away, to 2^-57 of its distance.
///
/// - Buffers: `point_model`, 3 numbers; `cells`, room for `capacity` structs, which may be NULL if `capacity`
///   is 0; `count`, one number. `tags` is one or several leafless_tags.
/// - Result: `*count`, which is `capacity` unless the octree has fewer such cells; the cells.
/// - Errors: LEAFLESS_E_ARGUMENT if `tags` is not a combination of leafless_tags, or a coordinate is not a
///   finite number; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL, and at most as many array elements
///   are read as the octree has.
leafless_status leafless_octree_nearest_cells(const leafless_octree *octree, const double point_model[3],
    uint32_t tags, leafless_near_cell *cells, uint64_t capacity, uint64_t *count);

/// Computes the signed distances of the finest cells in a box from the boundary of the solid. Entry (z·ny +
/// y)·nx + x, two numbers, belongs to the cell `min_cell` + (x, y, z), where nx, ny and nz are `max_cell` −
/// `min_cell`.
///
/// The interval between the two numbers (model units) contains the signed distance of the cell's centre from
/// the boundary of any solid that the octree's cells and its exterior describe: positive outside, negative
/// inside. The field is that of the whole solid, including the parts outside the box. The ends are distances
/// from the nearest closed cells, exact up to one outward rounding; they are infinite if there is no such
/// cell.
///
/// The time is linear in the cells of the box and a margin around it as wide as the largest distance. In
/// addition to `field`, memory is a quarter of a byte for each of these cells, and for each thread some 140
/// bytes for each cell of a slice across z. A small box far away from the solid costs as much as
/// leafless_octree_distances for its cells.
///
/// - Buffers: `min_cell` and `max_cell`, 3 numbers each: the first finest cell of the box, and the first cell
///   beyond it on each axis; `options`, one struct or NULL (its limits are ignored); `field`, `capacity`
///   numbers, two for each cell; it may be NULL if the box has no cells.
/// - Result: the field, identical for any number of threads.
/// - Errors: LEAFLESS_E_ARGUMENT if min > max on an axis, if the box is not within the universe, or if
///   `capacity` is not twice the number of its cells; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
leafless_status leafless_octree_distance_field(const leafless_octree *octree, const uint32_t min_cell[3],
    const uint32_t max_cell[3], const leafless_options *options, float *field, uint64_t capacity);

/// The verdict on whether the interiors of two solids share points.
LEAFLESS_ENUM(leafless_overlap, uint32_t) {
    LEAFLESS_OVERLAP_DISJOINT = 0,  ///< Proven: the interiors are disjoint. The solids may touch.
    LEAFLESS_OVERLAP_OVERLAPPING = 1,  ///< Proven: a ball lies in both.
    /// Not decided at the frame's depth, or before the splits were spent; or both solids may extend beyond
    /// the universe and overlap there.
    LEAFLESS_OVERLAP_UNDECIDED = 2,
};

/// Facts about the overlap of two solids inside the universe of a frame.
typedef struct leafless_interference {
    /// The volume of their intersection, in cubic model units; the upper bound is infinite if `is_clipped`.
    leafless_interval volume_model;
    leafless_proof proof_a;  ///< The proofs about the first solid; unproven tags count as undecided.
    leafless_proof proof_b;  ///< The proofs about the second solid.
    uint64_t splits_a;  ///< Cells of the first solid that were split.
    uint64_t splits_b;  ///< Cells of the second solid that were split.
    uint32_t verdict;  ///< A leafless_overlap.
    uint32_t level;  ///< The finest level of the visited cells.
    /// If the solids are proven to overlap, the centre, in model units, of a ball that is proven to lie in
    /// both; else zeros. It is not the largest such ball.
    double ball_centre_model[3];
    double ball_radius_model;  ///< The radius of that ball.
    /// The witness: the cell that contains that ball, by its index on each axis; else zeros.
    /// leafless_frame_cell_bounds returns its box. (For octrees under a map there may be no such cell,
    /// because they may overlap by less than a cell.)
    uint32_t witness[3];
    uint32_t witness_level;  ///< The level of that cell.
    /// Whether both solids may extend beyond the universe. Then they are not proven to be disjoint.
    bool is_clipped;
} leafless_interference;

/// Bounds of the distance between two solids inside the universe of a frame.
typedef struct leafless_clearance {
    uint32_t struct_size;  ///< sizeof(leafless_clearance).
    /// The least distance between points of the two solids, in model units: 0 if they touch or overlap. The
    /// upper bound is infinite as long as no point of one solid is proven; the lower bound is infinite, too,
    /// if one solid is proven to be empty.
    leafless_interval distance_model;
    /// If `has_nearest`, a point of the first solid, in model units. The distance of the two points is at
    /// most the upper bound, up to rounding of their coordinates; for solids with a `depth_model` the points
    /// are equal. Else zeros.
    double point_a_model[3];
    double point_b_model[3];  ///< A point of the second solid.
    /// A unit vector that points out of the first solid at its point, if one is known; else zeros.
    double normal_a[3];
    double normal_b[3];  ///< The same for the second solid.
    /// For solids that overlap, the radius, in model units, of a ball that is proven to lie in both; 0 if no
    /// ball was found.
    double depth_model;
    leafless_proof proof_a;  ///< The proofs about the first solid; unproven tags count as undecided.
    leafless_proof proof_b;  ///< The proofs about the second solid.
    uint64_t splits_a;  ///< Cells of the first solid that were split.
    uint64_t splits_b;  ///< Cells of the second solid that were split.
    /// If `has_nearest`, the cell of the first solid with its point, by its index on each axis; else zeros.
    uint32_t nearest_a[3];
    uint32_t nearest_a_level;  ///< The level of that cell.
    uint32_t nearest_b[3];  ///< The cell of the second solid with its point.
    uint32_t nearest_b_level;  ///< The level of that cell.
    leafless_stop_reason measured;  ///< The reason why the search ended.
    bool has_nearest;  ///< Whether the upper bound is finite.
    /// Whether one of the solids may extend beyond the universe; the result says nothing about the part
    /// beyond.
    bool is_clipped;
} leafless_clearance;

/// Makes a solid under an affine map, from its cells on a frame of its own.
///
/// A cell is FULL or EMPTY if its inverse image touches only cells of the solid's own frame with that tag:
/// cells of about its size, or larger decided cells. So a surface that is not parallel to the lattice blurs
/// by about a cell, down to the depth of the solid's own frame; rounding is outward. If the map takes lattice
/// planes to lattice planes, nothing blurs. Parts outside the solid's own universe are undecided, unless the
/// solid is proven to end inside. (leafless_solid_placed moves a solid in the best way for its kind, and
/// chooses a frame if one is needed.)
///
/// - Buffers: `own`, one struct; `matrix`, 12 numbers, the rows of [M | t], where a point p goes to M p + t;
///   `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check, or if an entry is neither 0 nor of a magnitude
///   between 2^-64 and 2^64, or M is singular; LEAFLESS_E_LIMIT if too many transforms are nested. Queries of
///   the result return LEAFLESS_E_FRAME if `operand` belongs to another frame than `own`.
/// - Ownership: the operand is shared and may be freed; release `*solid` with leafless_solid_free.
/// - Untrusted input: any solid and numbers.
leafless_status leafless_solid_transformed(const leafless_solid *operand, const leafless_frame *own,
    const double matrix[12], leafless_solid **solid);

/// Like leafless_solid_transformed, except that LEAFLESS_RULE_SAMPLED decides every centre by the cell of the
/// solid's own frame that contains its inverse image: the centre is inside if that cell is FULL, or if that
/// cell's own centre lies inside.
///
/// So a sampled octree can be sampled again on a rotated, coarser or finer lattice, where
/// leafless_solid_transformed is refused with LEAFLESS_E_NOT_SAMPLED. A surface is displaced by up to half a
/// diagonal of the solid's own cells. A centre whose inverse image lies on a face between two cells belongs
/// to the upper cell. Other rules, and the classification of cells, are as for leafless_solid_transformed.
///
/// - Buffers: `own`, one struct; `matrix`, 12 numbers, the rows of [M | t], where a point p goes to M p + t;
///   `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: as leafless_solid_transformed. Building with LEAFLESS_RULE_SAMPLED returns
///   LEAFLESS_E_NOT_SAMPLED only if the inverse image of a centre lies in an undecided cell;
///   leafless_octree_resolve decides such cells beforehand.
/// - Ownership: the operand is shared and may be freed; release `*solid` with leafless_solid_free.
/// - Untrusted input: any solid and numbers.
leafless_status leafless_solid_resampled(const leafless_solid *operand, const leafless_frame *own,
    const double matrix[12], leafless_solid **solid);

/// Returns whether two solids overlap inside the universe of a frame. Once an overlap is proven, its volume
/// is refined until the interval is no wider than `tolerance_model` cubic model units; an infinite tolerance
/// ends the work with the proof.
///
/// If both solids consist of surfaces (expressions of half-spaces, and octrees that keep their surfaces), a
/// surface that bounds both is recognised under all placements, and solids that touch in it from opposite
/// sides are proven to be disjoint. Meshes and functions of the host that touch stay undecided.
///
/// Cells of one solid are split only where the other solid may be. The work ends at the frame's depth, or
/// when `max_splits` cells of both are split, and returns the result so far.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `interference`, one struct.
/// - Result: `*interference`.
/// - Errors: LEAFLESS_E_FRAME if a solid belongs to another frame; LEAFLESS_E_ARGUMENT as
///   leafless_frame_check, or if the tolerance is negative or not a number; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any solids; set `max_splits` if the depth or the solids are untrusted.
leafless_status leafless_solid_interfere(const leafless_solid *a, const leafless_solid *b,
    const leafless_frame *frame, double tolerance_model, const leafless_options *options,
    leafless_interference *interference);

/// Like leafless_solid_interfere for `a` and `b` under each of many affine maps, applied as by
/// leafless_solid_transformed. `max_splits` applies to each map. The results are identical for any number of
/// threads.
///
/// - Buffers: `own`, one struct, the frame of `b`; `matrices`, `count` times 12 numbers; `frame`, one struct,
///   that of `a`; `options`, one struct or NULL; `interferences`, room for `count`. `matrices` and
///   `interferences` may be NULL if `count` is 0.
/// - Result: `interferences[i]` for map i.
/// - Errors: as leafless_solid_interfere and leafless_solid_transformed; nothing is then written.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: as leafless_solid_interfere, and any numbers.
leafless_status leafless_solid_interfere_many(const leafless_solid *a, const leafless_solid *b,
    const leafless_frame *own, const double *matrices, uint64_t count, const leafless_frame *frame,
    double tolerance_model, const leafless_options *options, leafless_interference *interferences);

/// Computes the distance between two solids inside the universe of a frame.
///
/// `measured` of the result is the reason why the search ended. With LEAFLESS_STOP_REASON_TOLERANCE the
/// interval is no wider than `tolerance_model` (model units). With LEAFLESS_STOP_REASON_EXHAUSTED the cells
/// of the frame's depth cannot raise the lower bound, and the interval is no wider than twice their diagonal,
/// which is the limit of cells for most solids; or no pair of cells is left; or a solid may extend beyond the
/// universe, which keeps the lower bound at 0. With LEAFLESS_STOP_REASON_BUDGET `max_splits` steps were
/// taken, or 1 048 576 if that is 0. A step visits the children of one cell. A cell whose children are
/// visited again, next to another cell, counts once more.
///
/// The distance of two closed meshes in the universe is computed from their triangles, exact up to rounding:
/// some 10^-13 of their sizes and of the distance. Bodies of a mesh may overlap, unless only positive winding
/// numbers count, triangles lie on each other, or vertices were moved. A step is then 64 pairs of boxes
/// around triangles, and no cells are split.
///
/// If both solids provide slabs, as expressions, open meshes and extended octrees do, each level makes the
/// interval about four times as narrow, and plane faces, balls and cylinders are resolved at once. Other
/// solids are resolved to the size of cells: the upper bound is finite once the search has found a FULL cell
/// of each, and the work grows with the area where the distance is close to the least one, measured in cells
/// of the size of the tolerance.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `clearance`, one struct.
/// - Result: `*clearance`.
/// - Errors: as leafless_solid_interfere.
/// - Untrusted input: any solids; the default of `max_splits` bounds the work.
leafless_status leafless_solid_clearance(const leafless_solid *a, const leafless_solid *b,
    const leafless_frame *frame, double tolerance_model, const leafless_options *options,
    leafless_clearance *clearance);

/// The verdict on whether two solids keep a least distance.
LEAFLESS_ENUM(leafless_gap_verdict, uint32_t) {
    LEAFLESS_GAP_VERDICT_YES = 0,  ///< Proven: no two points of the solids are nearer.
    LEAFLESS_GAP_VERDICT_NO = 1,  ///< Proven: two points are nearer.
    /// Not decided at the frame's depth, or before the splits were spent; or a solid may extend beyond the
    /// universe.
    LEAFLESS_GAP_VERDICT_UNDECIDED = 2,
};

/// The verdict on whether two solids keep a least distance, with its proof.
typedef struct leafless_gap {
    uint32_t struct_size;  ///< sizeof(leafless_gap).
    uint32_t verdict;  ///< A leafless_gap_verdict.
    leafless_interval distance_model;  ///< Bounds of the distance when the search ended, in model units.
    /// If `has_points`, a point of the first solid, in model units. The distance of the two points is at most
    /// the upper bound, up to rounding of their coordinates. Else zeros.
    double point_a_model[3];
    double point_b_model[3];  ///< A point of the second solid.
    uint64_t splits_a;  ///< Cells of the first solid that were split.
    uint64_t splits_b;  ///< Cells of the second solid that were split.
    /// The reason why the search ended; LEAFLESS_STOP_REASON_TOLERANCE if the verdict is proven.
    leafless_stop_reason measured;
    bool has_points;  ///< Whether the upper bound is finite.
    /// Whether one of the solids may extend beyond the universe; the result says nothing about the part
    /// beyond.
    bool is_clipped;
} leafless_gap;

/// The verdict on whether two solids, one of which is moved, keep a least distance.
typedef struct leafless_placed_gap {
    leafless_interval distance_model;  ///< As in leafless_gap.
    double point_a_model[3];  ///< If `has_points`, a point of the first solid, in model units; else zeros.
    double point_b_model[3];  ///< A point of the second solid.
    uint64_t splits_a;  ///< Cells of the first solid that were split.
    uint64_t splits_b;  ///< Cells of the second solid that were split.
    uint32_t verdict;  ///< A leafless_gap_verdict.
    /// The reason why the search ended; LEAFLESS_STOP_REASON_TOLERANCE if the verdict is proven.
    leafless_stop_reason measured;
    bool has_points;  ///< Whether the upper bound is finite.
    /// Whether one of the solids may extend beyond the universe; the result says nothing about the part
    /// beyond.
    bool is_clipped;
} leafless_placed_gap;

/// Bounds of the distance between two solids, one of which is moved.
typedef struct leafless_placed_clearance {
    leafless_interval distance_model;  ///< As in leafless_clearance.
    double point_a_model[3];  ///< If `has_points`, a point of the first solid, in model units; else zeros.
    double point_b_model[3];  ///< A point of the second solid.
    double depth_model;  ///< As in leafless_clearance.
    uint64_t splits_a;  ///< Cells of the first solid that were split.
    uint64_t splits_b;  ///< Cells of the second solid that were split.
    leafless_stop_reason measured;  ///< The reason why the search ended.
    bool has_points;  ///< Whether the upper bound is finite.
    /// Whether one of the solids may extend beyond the universe; the result says nothing about the part
    /// beyond.
    bool is_clipped;
} leafless_placed_clearance;

/// Returns whether two solids keep the distance `least_model` (model units) inside the universe of a frame.
/// The search ends as soon as this is proven or disproven. If the distance is almost exactly `least_model`,
/// nothing may be proven within `max_splits`, which are counted and limited as for leafless_solid_clearance.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `gap`, one struct.
/// - Result: `*gap`.
/// - Errors: as leafless_solid_interfere; LEAFLESS_E_ARGUMENT also if `least_model` is not between 2^-256 and
///   2^256.
/// - Untrusted input: any solids; the default of `max_splits` bounds the work.
leafless_status leafless_solid_gap_at_least(const leafless_solid *a, const leafless_solid *b,
    const leafless_frame *frame, double least_model, const leafless_options *options, leafless_gap *gap);

/// Like leafless_solid_clearance for `a` and `b` under each of many affine maps, applied as by
/// leafless_solid_transformed. `max_splits` applies to each map. The results are identical for any number of
/// threads.
///
/// - Buffers: `own`, one struct, the frame of `b`; `matrices`, `count` times 12 numbers; `frame`, one struct,
///   that of `a`; `options`, one struct or NULL; `clearances`, room for `count`. `matrices` and `clearances`
///   may be NULL if `count` is 0.
/// - Result: `clearances[i]` for map i.
/// - Errors: as leafless_solid_interfere and leafless_solid_transformed; nothing is then written.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: as leafless_solid_clearance, and any numbers.
leafless_status leafless_solid_clearance_many(const leafless_solid *a, const leafless_solid *b,
    const leafless_frame *own, const double *matrices, uint64_t count, const leafless_frame *frame,
    double tolerance_model, const leafless_options *options, leafless_placed_clearance *clearances);

/// Like leafless_solid_gap_at_least for `a` and `b` under each of many affine maps, applied as by
/// leafless_solid_transformed. `max_splits` applies to each map. The results are identical for any number of
/// threads.
///
/// - Buffers: `own`, one struct, the frame of `b`; `matrices`, `count` times 12 numbers; `frame`, one struct,
///   that of `a`; `options`, one struct or NULL; `gaps`, room for `count`. `matrices` and `gaps` may be NULL
///   if `count` is 0.
/// - Result: `gaps[i]` for map i.
/// - Errors: as leafless_solid_gap_at_least and leafless_solid_transformed; nothing is then written.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: as leafless_solid_gap_at_least, and any numbers.
leafless_status leafless_solid_gap_at_least_many(const leafless_solid *a, const leafless_solid *b,
    const leafless_frame *own, const double *matrices, uint64_t count, const leafless_frame *frame,
    double least_model, const leafless_options *options, leafless_placed_gap *gaps);

/// The one-sided distance of one boundary from another.
typedef struct leafless_one_way {
    /// The greatest distance of a point of the first boundary from the nearest point of the second, in model
    /// units. 0 if the first solid has no boundary; infinite if only the second solid has none.
    leafless_interval distance_model;
    double point_model[3];  ///< If `has_witness`, a point next to the first boundary; else zeros.
    /// If `has_witness`, an upper bound of the point's distance from the first boundary, in model units; else
    /// 0.
    double apart_model;
    /// If `has_witness`, the point next to the second boundary that is nearest to `point_model`, as far as
    /// the boundary is known; else zeros.
    double nearest_model[3];
    bool has_witness;  ///< Whether the lower bound was attained at a point, the witness.
} leafless_one_way;

/// The verdict on whether two boundaries are within a distance of each other.
LEAFLESS_ENUM(leafless_within, uint32_t) {
    LEAFLESS_WITHIN_YES = 0,  ///< Proven: each point of either boundary is within the distance of the other.
    LEAFLESS_WITHIN_NO = 1,  ///< Proven: a point of one boundary is further away from the other.
    LEAFLESS_WITHIN_UNDECIDED = 2,  ///< Not decided by the bounds.
};

/// Bounds of the distance of the boundaries of two solids.
typedef struct leafless_deviation {
    uint32_t struct_size;  ///< sizeof(leafless_deviation).
    /// The greater of the two one-sided distances, in model units: the Hausdorff distance of the boundaries.
    leafless_interval distance_model;
    leafless_one_way a_to_b;  ///< The one-sided distance of the first boundary from the second.
    leafless_one_way b_to_a;  ///< The one-sided distance of the second boundary from the first.
    leafless_proof proof_a;  ///< The proofs about the first solid; unproven tags count as undecided.
    leafless_proof proof_b;  ///< The proofs about the second solid.
    /// Cells of the first solid that were split; 0 if its boundary is known to consist of triangles.
    uint64_t splits_a;
    uint64_t splits_b;  ///< Cells of the second solid that were split.
    uint64_t cuts_a;  ///< Number of cuts of pieces of the first boundary.
    uint64_t cuts_b;  ///< Number of cuts of pieces of the second boundary.
    uint32_t verdict;  ///< A leafless_within: whether the boundaries are within `within_model` of each other.
    leafless_stop_reason measured;  ///< The reason why the search ended.
    /// Whether the first solid may extend beyond the universe; the result says nothing about the part beyond.
    bool is_clipped_a;
    bool is_clipped_b;  ///< Whether the second solid may extend beyond the universe.
} leafless_deviation;

/// Computes the distance of the boundaries of two solids, in both directions, inside the universe of a frame.
///
/// The boundary of a closed mesh whose triangles do not intersect is known exactly; for two such meshes the
/// result is exact up to rounding. For any other solid, cells are split until the slabs of each cell locate
/// the boundary to a twelfth of `tolerance_model` (model units); undecided parts widen the intervals.
///
/// `measured` of the result is the reason why the search ended. With LEAFLESS_STOP_REASON_TOLERANCE both
/// intervals are no wider than `tolerance_model`. With LEAFLESS_STOP_REASON_EXHAUSTED neither splits of cells
/// nor cuts of pieces of the boundaries improve the result. With LEAFLESS_STOP_REASON_BUDGET `max_splits`
/// cells of a solid were split (262 144 if that is 0), or 64 times as many pieces of a boundary were cut, or
/// `max_bytes` is almost reached.
///
/// `verdict` of the result is a leafless_within: whether the boundaries are proven to be within
/// `within_model` of each other. If `within_model` is not a number, the verdict is undecided.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `deviation`, one struct.
/// - Result: `*deviation`.
/// - Errors: as leafless_solid_interfere.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solids; the default of `max_splits` bounds the work.
leafless_status leafless_solid_deviation(const leafless_solid *a, const leafless_solid *b,
    const leafless_frame *frame, double tolerance_model, double within_model, const leafless_options *options,
    leafless_deviation *deviation);

/* ---- 21. Layouts: solids in a container --------------------------------------------------------------- */

/// The orientations that an item may take.
LEAFLESS_ENUM(leafless_orientations, uint32_t) {
    LEAFLESS_ORIENTATIONS_TURNS = 0,  ///< The 24 rotations that take axes to axes. They are exact.
    LEAFLESS_ORIENTATIONS_AS_GIVEN = 1,  ///< Only the given orientation.
    /// The given orientation, and `free_count` random rotations, distributed uniformly over all rotations.
    /// They depend on the seed of the search.
    LEAFLESS_ORIENTATIONS_FREE = 2,
    LEAFLESS_ORIENTATIONS_LIST = 3,  ///< The linear parts M of `matrices`.
};

/// Options of an item.
typedef struct leafless_item_options {
    uint32_t struct_size;  ///< sizeof(leafless_item_options).
    leafless_orientations orientations;  ///< A leafless_orientations: how a search may turn the item.
    double density;  ///< Mass per cubic model unit, a positive number; 0 means 1.
    /// For LEAFLESS_ORIENTATIONS_LIST: `matrix_count` times 12 numbers, the rows of [M | t]. M must be a
    /// rotation: it must not mirror, nor change lengths by more than 10^-9 of them.
    const double *matrices;
    uint64_t matrix_count;  ///< For LEAFLESS_ORIENTATIONS_LIST: number of matrices, 1 to 4096.
    uint32_t free_count;  ///< For LEAFLESS_ORIENTATIONS_FREE: number of random rotations, 1 to 4096.
    uint32_t reserved;  ///< Reserved; 0.
} leafless_item_options;

/// Makes a bay with a container, without obstacles and items. The container is any bounded solid.
///
/// - Buffers: `bay`, one pointer. `clearance_model` is the least distance between two items, and between an
///   item and an obstacle; `wall_clearance_model` is the least distance between an item and the outside of
///   the container. Both are in model units.
/// - Result: `*bay`.
/// - Errors: LEAFLESS_E_ARGUMENT if a distance is not between 0 and 2^64; if the container has no bounds, or
///   no extent along an axis.
/// - Ownership: the bay shares the container, which may be freed; release `*bay` with leafless_bay_free.
/// - Untrusted input: any solid and numbers.
leafless_status leafless_bay_new(const leafless_solid *container, double clearance_model,
    double wall_clearance_model, leafless_bay **bay);

/// Releases a bay. Layouts that were made from it stay.
///
/// - Buffers: `bay`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
void leafless_bay_free(leafless_bay *bay);

/// Adds an obstacle: a solid with a fixed position that items must keep away from.
///
/// - Buffers: `number`, one number.
/// - Result: `*number`, the number of the obstacle in leafless_neighbour, counted from 0.
/// - Errors: LEAFLESS_E_ARGUMENT if the solid has no bounds, or no extent along an axis;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: the bay shares the solid, which may be freed.
/// - Threads: any, but no other call may use the bay.
/// - Untrusted input: any solid.
leafless_status leafless_bay_add_obstacle(leafless_bay *bay, const leafless_solid *solid, uint64_t *number);

/// Adds an item: a solid of which leafless_layout_search places `count` copies. leafless_layout_place places
/// any number of copies.
///
/// - Buffers: `item`, one struct or NULL, which means 24 rotations and a density of 1; `number`, one number.
/// - Result: `*number`, the number of the item for leafless_layout_place, counted from 0.
/// - Errors: LEAFLESS_E_ARGUMENT if the solid has no bounds, or no extent along an axis; if a field of `item`
///   is not a member of its enumeration, or is set though it is not used; if the density is neither 0 nor a
///   positive number; if a matrix is not a rotation, or a required matrix is missing; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the bay shares the solid, which may be freed. It copies the matrices.
/// - Threads: any, but no other call may use the bay.
/// - Untrusted input: any solid and numbers. A search takes memory for the cells of each orientation.
leafless_status leafless_bay_add_item(leafless_bay *bay, const leafless_solid *solid, uint32_t count,
    const leafless_item_options *item, uint64_t *number);

/// A placed copy of an item.
typedef struct leafless_placement {
    uint64_t item;  ///< The number of the item.
    double matrix[12];  ///< The placement: the rows of [M | t], where a point p of the item goes to M p + t.
} leafless_placement;

/// The kinds of objects that a copy may be too near to.
LEAFLESS_ENUM(leafless_beside, uint32_t) {
    LEAFLESS_BESIDE_WALL = 0,  ///< The outside of the container.
    LEAFLESS_BESIDE_OBSTACLE = 1,  ///< An obstacle.
    LEAFLESS_BESIDE_PLACED = 2,  ///< Another copy.
};

/// The relation of a copy to a neighbour.
typedef struct leafless_neighbour {
    leafless_interval gap_model;  ///< The distance of the two, in model units: 0 if they touch or overlap.
    uint64_t number;  ///< The number of the obstacle or of the other copy; 0 for the wall.
    uint32_t beside;  ///< A leafless_beside: the kind of the neighbour.
    /// A leafless_gap_verdict: whether the two are proven to keep their clearance, or to violate it.
    uint32_t verdict;
} leafless_neighbour;

/// The check of a copy, with its nearest neighbour.
typedef struct leafless_standing {
    uint32_t struct_size;  ///< sizeof(leafless_standing).
    /// A leafless_gap_verdict. YES: the copy is proven to lie in the container, to overlap nothing, and to
    /// keep all clearances. NO: one of these is proven to be violated.
    uint32_t verdict;
    /// Number of conflicts: neighbours without a proven YES. All are counted; only the first 256 are
    /// returned.
    uint64_t conflict_count;
    uint64_t splits;  ///< Cells that were split.
    /// If `has_nearest`, the nearest neighbour except the wall; its gap contains the least of all distances.
    /// Otherwise the wall with the verdict UNDECIDED.
    leafless_neighbour nearest;
    bool has_nearest;  ///< Whether the container holds anything else.
} leafless_standing;

/// The check of one of many copies.
typedef struct leafless_placed_standing {
    uint64_t conflict_count;  ///< As in leafless_standing.
    uint64_t splits;  ///< Cells that were split.
    uint32_t verdict;  ///< A leafless_gap_verdict.
} leafless_placed_standing;

/// Makes a layout from a bay, with nothing placed. It takes the time to prepare each of its solids once.
///
/// - Buffers: `options`, one struct or NULL; `layout`, one pointer.
/// - Result: `*layout`.
/// - Errors: LEAFLESS_E_ARGUMENT if the container or an obstacle has no bounds, or no extent along an axis;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the layout shares the solids. The bay may be changed and freed without effect on the layout.
///   Release `*layout` with leafless_layout_free.
/// - Untrusted input: any solids.
leafless_status leafless_layout_new(const leafless_bay *bay, const leafless_options *options,
    leafless_layout **layout);

/// Releases a layout.
///
/// - Buffers: `layout`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
void leafless_layout_free(leafless_layout *layout);

/// Places a copy of an item anywhere. Nothing is checked, and the count of the item is ignored.
///
/// - Buffers: `matrix`, 12 numbers, the rows of [M | t], where a point p of the item goes to M p + t;
///   `number`, one number.
/// - Result: `*number`, the number of the copy, one greater than that of the previous copy.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no such item; if an entry is neither 0 nor of a magnitude
///   between 2^-64 and 2^64; if M mirrors, or changes lengths by more than 10^-9 of them;
///   LEAFLESS_E_NO_MEMORY; LEAFLESS_E_BUSY.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the layout.
/// - Untrusted input: any numbers.
leafless_status leafless_layout_place(leafless_layout *layout, uint64_t item, const double matrix[12],
    uint64_t *number);

/// Moves a copy to another placement. Nothing is checked; leafless_layout_check does that.
///
/// - Buffers: `matrix`, 12 numbers, as for leafless_layout_place.
/// - Errors: as leafless_layout_place, and LEAFLESS_E_ARGUMENT if there is no copy with this number.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the layout.
/// - Untrusted input: any numbers.
leafless_status leafless_layout_move_to(leafless_layout *layout, uint64_t number, const double matrix[12]);

/// Removes a copy. The numbers of copies that were placed later decrease by one.
///
/// - Errors: LEAFLESS_E_ARGUMENT if there is no copy of this number; LEAFLESS_E_BUSY.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the layout.
/// - Untrusted input: any number.
leafless_status leafless_layout_remove(leafless_layout *layout, uint64_t number);

/// Returns the placements of all copies, in the order of their numbers.
///
/// - Buffers: `placements`, room for `capacity` structs, or NULL to get only their number; `count`, one
///   number.
/// - Result: `*count`; `placements`.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_BUSY.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the layout.
leafless_status leafless_layout_placements(const leafless_layout *layout, leafless_placement *placements,
    uint64_t capacity, uint64_t *count);

/// Returns the placement of one copy.
///
/// - Buffers: `placement`, one struct.
/// - Result: `*placement`.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no copy of this number; LEAFLESS_E_BUSY.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the layout.
/// - Untrusted input: any number.
leafless_status leafless_layout_placement_at(const leafless_layout *layout, uint64_t number,
    leafless_placement *placement);

/// Checks the placement of a copy: whether it is valid, its conflicts, and its nearest neighbour. Only near
/// objects are examined; disjoint bounding boxes cost almost nothing.
///
/// A pair of closed meshes takes some ten microseconds. Other pairs take splits. `max_splits` limits their
/// number for each pair, 0 meaning 4 096; when it is spent, the answer is UNDECIDED.
///
/// - Buffers: `options`, one struct or NULL; `conflicts`, room for `capacity` structs, or NULL; `standing`,
///   one struct.
/// - Result: `*standing`; in `conflicts` the first `capacity` neighbours without a proven YES, at most 256.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no copy of this number; LEAFLESS_E_FRAME if a solid belongs to
///   another frame; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY;
///   LEAFLESS_E_BUSY. A `capacity` that is too small is not an error.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the layout.
/// - Untrusted input: any number; the default of `max_splits` bounds the work.
leafless_status leafless_layout_check(const leafless_layout *layout, uint64_t number,
    const leafless_options *options, leafless_neighbour *conflicts, uint64_t capacity,
    leafless_standing *standing);

/// Like leafless_layout_check for all copies, in the order of their numbers, but without their nearest
/// neighbours. The results are identical for any number of threads.
///
/// - Buffers: `options`, one struct or NULL; `standings`, room for `capacity` structs, or NULL to get only
///   their number, without checks; `count`, one number.
/// - Result: `*count`, the number of copies; `standings`.
/// - Errors: as leafless_layout_check, and LEAFLESS_E_BUFFER if the capacity is too small.
/// - Threads: any; runs on as many threads as `options` says; LEAFLESS_E_BUSY while another call changes the
///   layout.
/// - Untrusted input: only the solids; the default of `max_splits` bounds the work for each pair.
leafless_status leafless_layout_check_all(const leafless_layout *layout, const leafless_options *options,
    leafless_placed_standing *standings, uint64_t capacity, uint64_t *count);

/// The objective of a search. The first aim is always to place as much as possible.
LEAFLESS_ENUM(leafless_objective, uint32_t) {
    LEAFLESS_OBJECTIVE_COUNT = 0,  ///< As many copies as possible.
    LEAFLESS_OBJECTIVE_HEIGHT = 1,  ///< As many copies as possible, as low as possible along z.
    LEAFLESS_OBJECTIVE_DENSITY = 2,  ///< As much volume as possible.
    /// As many copies as possible, with their common centre of gravity near to `target_model`.
    LEAFLESS_OBJECTIVE_BALANCE = 3,
};

/// A direction along which all copies can be taken out.
LEAFLESS_ENUM(leafless_free_along, uint32_t) {
    LEAFLESS_FREE_ALONG_NONE = 0,  ///< No direction is required.
    LEAFLESS_FREE_ALONG_X_UP = 1,  ///< Along x, to greater coordinates.
    LEAFLESS_FREE_ALONG_X_DOWN = 2,  ///< Along x, to lesser coordinates.
    LEAFLESS_FREE_ALONG_Y_UP = 3,  ///< Along y, to greater coordinates.
    LEAFLESS_FREE_ALONG_Y_DOWN = 4,  ///< Along y, to lesser coordinates.
    LEAFLESS_FREE_ALONG_Z_UP = 5,  ///< Along z, to greater coordinates.
    LEAFLESS_FREE_ALONG_Z_DOWN = 6,  ///< Along z, to lesser coordinates.
};

/// Options of a search.
typedef struct leafless_search_options {
    uint32_t struct_size;  ///< sizeof(leafless_search_options).
    leafless_objective objective;  ///< A leafless_objective: the objective of the search.
    /// For LEAFLESS_OBJECTIVE_BALANCE: the target of the centre of gravity, in model units.
    double target_model[3];
    /// Seed of the random choices: the same seed gives the same layout, for any number of threads.
    uint64_t seed;
    /// Largest number of placements that are tested with the solids themselves; 0 means no limit.
    uint64_t max_tests;
    /// Number of rounds. Each round places everything anew in another order, and the best round is kept; 0
    /// means 4.
    uint32_t rounds;
    /// Cells along the longest side of the container, 4 to 512; 0 means as many as the items need.
    uint32_t cells;
    /// A leafless_free_along: the direction in which all copies can be taken out, one after another, the copy
    /// that was placed last first. No other copy and no obstacle blocks a straight move; the container may.
    leafless_free_along free_along;
    uint32_t reserved;  ///< Reserved; 0.
} leafless_search_options;

/// The reason why a search ended.
LEAFLESS_ENUM(leafless_search_end, uint32_t) {
    LEAFLESS_SEARCH_END_COMPLETE = 0,  ///< Everything is placed, and the objective needs no more rounds.
    LEAFLESS_SEARCH_END_ROUNDS = 1,  ///< All rounds were made.
    LEAFLESS_SEARCH_END_BUDGET = 2,  ///< `max_tests` of the search, or `max_splits` of the options, is spent.
    LEAFLESS_SEARCH_END_CANCELLED = 3,  ///< The search was cancelled. The best layout found is placed.
};

/// A report of a search.
typedef struct leafless_search_report {
    uint32_t struct_size;  ///< sizeof(leafless_search_report).
    leafless_search_end end;  ///< The reason why the search ended.
    uint64_t placed;  ///< Copies that the search placed.
    uint64_t left;  ///< Copies that are still to be placed.
    uint64_t rounds;  ///< Completed rounds, without the rounds that use only boxes.
    uint64_t tests;  ///< Placements that were tested with the solids themselves.
    /// Cells that were split for these tests. (Cells of items and of the container that are used to find
    /// placements are not counted.)
    uint64_t splits;
} leafless_search_report;

/// Measures of all copies together. All intervals contain the truth. Overlaps count twice.
typedef struct leafless_layout_measures {
    uint32_t struct_size;  ///< sizeof(leafless_layout_measures).
    leafless_interval volume_model;  ///< The volume of all copies.
    leafless_interval filled_part;  ///< That volume as a fraction of the container's volume.
    /// Height of the highest point above the lower end of the container's bounds along z, in model units; 0
    /// if nothing is placed.
    leafless_interval height_model;
    leafless_interval mass;  ///< The mass, from the densities of the items.
    /// The centre of gravity; intervals of all numbers unless `has_centroid`.
    leafless_interval centroid_model[3];
    /// Tensor of inertia about the model's origin, row by row, as in leafless_measures, times the densities.
    leafless_interval inertia_origin_model[9];
    /// The same about the centre of gravity; about the origin unless `has_centroid`.
    leafless_interval inertia_centroid_model[9];
    bool has_centroid;  ///< Whether a copy is placed, and every placed item is proven not to be empty.
} leafless_layout_measures;

/// Places the copies that are still missing from the counts of the items. Copies that are placed already do
/// not move.
///
/// Each copy is proven to lie in the container, to overlap nothing, and to keep all clearances: by boxes, by
/// the triangles of meshes, or by splits of the solids. A copy without this proof is not placed. The best
/// layout of all rounds by the objective is kept. If the search is cancelled, or a limit is spent, it keeps
/// the best layout found; neither is an error.
///
/// Memory is that of the items' cells in all orientations, and of the container's cells: some megabytes. A
/// step takes O(r n² / 64) for each layer of cells that is examined, with n the cells along the container and
/// r the runs of cells of an item.
///
/// - Buffers: `search`, one struct or NULL; `options`, one struct or NULL; `report`, one struct.
/// - Result: the layout is changed; `*report`.
/// - Errors: LEAFLESS_E_ARGUMENT if `cells` is neither 0 nor between 4 and 512, if a field is not a member of
///   its enumeration, or if `target_model` is not finite, or is set though it is not used; LEAFLESS_E_FRAME
///   if a solid belongs to another frame; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_NO_MEMORY;
///   LEAFLESS_E_BUSY. After an error the layout is unchanged.
/// - Threads: any; runs on as many threads as `options` says; LEAFLESS_E_BUSY while another call uses the
///   layout.
/// - Untrusted input: any numbers; set `max_tests` and `max_splits` if the solids are untrusted.
leafless_status leafless_layout_search(leafless_layout *layout, const leafless_search_options *search,
    const leafless_options *options, leafless_search_report *report);

/// Measures all copies together. The container and each placed item are measured once, as by
/// leafless_solid_measure, and the copies are added. `relative` bounds the width of each volume's interval as
/// a fraction of the volume.
///
/// - Buffers: `options`, one struct or NULL; `measures`, one struct.
/// - Result: `*measures`.
/// - Errors: LEAFLESS_E_ARGUMENT if `relative` is negative or not a number; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_BUSY.
/// - Threads: any; runs on as many threads as `options` says; LEAFLESS_E_BUSY while another call changes the
///   layout.
/// - Untrusted input: any number; the default of `max_splits`, that of leafless_solid_measure, bounds the
///   work.
leafless_status leafless_layout_measure(const leafless_layout *layout, double relative,
    const leafless_options *options, leafless_layout_measures *measures);

/* ---- 22. Octrees that are split on demand ------------------------------------------------------------- */

/// Basic facts about a lazy octree.
typedef struct leafless_lazy_info {
    uint32_t struct_size;  ///< sizeof(leafless_lazy_info).
    leafless_frame frame;  ///< The universe and the greatest depth of cells.
    leafless_statistics statistics;  ///< Counts over all levels, and the certified volume.
    /// Cells that were split in total, including cells that were merged again. No cell is counted twice.
    uint64_t splits;
    uint64_t replays;  ///< Splits that the solid repeated because cells below were to be split.
    uint64_t bytes;  ///< Bytes of the split cells.
} leafless_lazy_info;

/// Makes a lazy octree in which only the universe is classified. The frame's depth limits the depth of cells;
/// a great depth costs nothing until its cells are requested.
///
/// - Buffers: `frame`, one struct; `lazy`, one pointer.
/// - Result: `*lazy`.
/// - Errors: LEAFLESS_E_FRAME if the solid belongs to another frame; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED;
///   LEAFLESS_E_ARGUMENT; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the octree shares the solid, which may be freed; release `*lazy` with leafless_lazy_free.
/// - Untrusted input: any solid.
leafless_status leafless_lazy_new(const leafless_solid *solid, const leafless_frame *frame,
    leafless_lazy **lazy);

/// Makes a lazy octree that continues an octree of leafless_lazy_freeze. The octree must come from the same
/// solid, which the fingerprint identifies; `frame` may be deeper than the octree's frame. The octree's cells
/// are trusted, unless splits of the solid contradict them. Splits are counted from zero.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `lazy`, one pointer.
/// - Result: `*lazy`. O(n).
/// - Errors: LEAFLESS_E_SOURCE if the octree does not hold the solid's fingerprint; LEAFLESS_E_ARGUMENT if
///   the solid has none, or the octree is deeper than the frame; LEAFLESS_E_FRAME if the octree has another
///   universe, or the solid belongs to another frame; LEAFLESS_E_DAMAGED; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `octree` is unchanged; `*lazy` shares the solid, which may be freed; release it with
///   leafless_lazy_free.
/// - Untrusted input: any octree; set `max_bytes` if it is untrusted.
leafless_status leafless_lazy_resume(const leafless_octree *octree, const leafless_solid *solid,
    const leafless_frame *frame, const leafless_options *options, leafless_lazy **lazy);

/// Releases a lazy octree.
///
/// - Buffers: `lazy`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
void leafless_lazy_free(leafless_lazy *lazy);

/// Splits a PARTIAL cell. It costs nothing if the cell was split before, is decided, or cannot be improved by
/// splitting.
///
/// - Buffers: `cell`, 3 numbers, the cell's index on each axis; `tags`, room for 8.
/// - Result: the tags of its children in octant order (bit 0 of the octant is x, bit 1 y, bit 2 z).
/// - Errors: LEAFLESS_E_ARGUMENT if the cell is not in the frame, has the frame's depth, or lies in a cell
///   that is not split yet; LEAFLESS_E_SOURCE if the solid contradicts the octree; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_NO_MEMORY.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the handle.
/// - Untrusted input: any solid, any numbers.
leafless_status leafless_lazy_split(leafless_lazy *lazy, const uint32_t cell[3], uint32_t level,
    leafless_tag tags[8]);

/// The kind of zone: which cells are refined.
LEAFLESS_ENUM(leafless_zone_kind, uint32_t) {
    LEAFLESS_ZONE_KIND_EVERYTHING = 0,  ///< All of the universe.
    /// The cells whose interiors meet the box from `min_model` to `max_model`; for a box without thickness,
    /// the cells that contain it.
    LEAFLESS_ZONE_KIND_BOX = 1,
    LEAFLESS_ZONE_KIND_POINT = 2,  ///< The cells that contain `point_model`: one of each level.
    /// All cells that the points `point_model` + t · `direction_model` with `from` ≤ t ≤ `to` touch.
    LEAFLESS_ZONE_KIND_RAY = 3,
};

/// A zone of model space in which cells are refined. Fields that its kind does not use are ignored.
typedef struct leafless_zone {
    uint32_t struct_size;  ///< sizeof(leafless_zone).
    leafless_zone_kind kind;  ///< A leafless_zone_kind: the kind decides which of the fields below are used.
    double min_model[3];  ///< A box's lower corner.
    double max_model[3];  ///< A box's upper corner.
    /// A point, or a point of a ray. For a ray each coordinate is 0 or of a magnitude between 2^-256 and
    /// 2^256.
    double point_model[3];
    /// A ray's direction, of any length but zero; its coordinates have the range of a ray's point.
    double direction_model[3];
    double from;  ///< The parameter t of a ray's start; may be -INFINITY.
    double to;  ///< The parameter t of a ray's end; may be INFINITY.
} leafless_zone;

/// Splits the cells of a zone down to `level`, as far as they can be split. The limits in `options`
/// (`max_splits`; `max_nodes` and `max_bytes` of the whole octree) end the work without damage to the octree.
/// With limits, coarser cells are split before finer ones, and along a ray the nearest cells first.
///
/// - Buffers: `zone`, one struct, or NULL for everything; `options`, one struct or NULL; `done`, one truth
///   value, or NULL.
/// - Result: `*done`, whether the work was completed before a limit was reached.
/// - Errors: LEAFLESS_E_ARGUMENT if `level` is beyond the frame's depth, a box has min > max on an axis, a
///   number violates the ranges of leafless_zone, or from > to; LEAFLESS_E_SOURCE if the solid contradicts
///   the octree; LEAFLESS_E_CALLBACK; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY. Cells that were split
///   before the error stay split.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the handle; works in the calling thread.
/// - Untrusted input: any solid, any numbers; set limits if the level or the solid is untrusted.
leafless_status leafless_lazy_refine(leafless_lazy *lazy, const leafless_zone *zone, uint32_t level,
    const leafless_options *options, bool *done);

/// Returns the tag of a cell. Cells inside a cell that is decided, or not split yet, have its tag.
///
/// - Buffers: `cell`, 3 numbers, the cell's index on each axis; `tag`, one; `can_split`, one truth value, or
///   NULL.
/// - Result: `*tag`; BRANCH if the cell was split and its children differ; PARTIAL if it is not a cell of the
///   frame. `*can_split`, whether leafless_lazy_split would query the solid: the cell is PARTIAL, its parent
///   was split, it is above the frame's depth, and the solid did not report that splitting does not help.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the octree.
/// - Untrusted input: any numbers.
leafless_status leafless_lazy_tag_at(const leafless_lazy *lazy, const uint32_t cell[3], uint32_t level,
    leafless_tag *tag, bool *can_split);

/// Returns whether the solid contains a point, as far as cells have been split. A point on the boundary may
/// be inside or outside.
///
/// - Buffers: `point_model`, 3 numbers; `membership`, one.
/// - Result: `*membership`.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the octree.
/// - Untrusted input: any numbers.
leafless_status leafless_lazy_contains(const leafless_lazy *lazy, const double point_model[3],
    leafless_membership *membership);

/// Returns basic facts about a lazy octree, as far as cells have been split. O(depth).
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`. A cell counts as a node also if its eight children are PARTIAL.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the octree.
leafless_status leafless_lazy_describe(const leafless_lazy *lazy, leafless_lazy_info *info);

/// Returns the counts of each level, and the certified volumes of the octree cut off at that level. Entry 0
/// is the universe, entry `depth` the finest cells.
///
/// - Buffers: `levels`, room for `capacity` structs, or NULL to get only the count; `count`, one number.
/// - Result: `*count`, depth + 1; the levels.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the octree.
leafless_status leafless_lazy_levels(const leafless_lazy *lazy, leafless_statistics *levels,
    uint64_t capacity, uint64_t *count);

/// Returns the number of cells of each level that were split, including cells that were merged again. Entry 0
/// is the universe.
///
/// - Buffers: `splits`, room for `capacity` numbers, or NULL to get only the count; `count`, one number.
/// - Result: `*count`, the frame's depth; the numbers.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the octree.
leafless_status leafless_lazy_splits(const leafless_lazy *lazy, uint64_t *splits, uint64_t capacity,
    uint64_t *count);

/// Returns the current octree: canonical, with PARTIAL cells where cells are not split. Its fact "source" is
/// the solid's fingerprint, if there is one. leafless_lazy_resume continues it, also from a file.
///
/// - Buffers: `options`, one struct or NULL; `octree`, one pointer.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*octree` with leafless_octree_free.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the octree; runs on as many threads as
///   `options` says.
leafless_status leafless_lazy_freeze(const leafless_lazy *lazy, const leafless_options *options,
    leafless_octree **octree);

/* ---- 23. Attributes ----------------------------------------------------------------------------------- */

/// The kind of knowledge about the values in the interior of a box.
LEAFLESS_ENUM(leafless_range_kind, uint32_t) {
    LEAFLESS_RANGE_KIND_UNKNOWN = 0,  ///< The values are not known.
    LEAFLESS_RANGE_KIND_NOWHERE = 1,  ///< No point has a value.
    /// Every point has a value, and each of its numbers lies in its interval.
    LEAFLESS_RANGE_KIND_WITHIN = 2,
};

/// The range of the values of an attribute in the interior of a box.
typedef struct leafless_value_range {
    /// For each number of a value an interval that contains it, if `kind` is LEAFLESS_RANGE_KIND_WITHIN. All
    /// numbers are NaN otherwise, and beyond the numbers that a value has.
    leafless_interval values[4];
    uint32_t kind;  ///< A leafless_range_kind.
} leafless_value_range;

/// Makes the attribute that has one value everywhere.
///
/// - Buffers: `value`, `components` numbers; `attribute`, one pointer.
/// - Result: `*attribute`.
/// - Errors: LEAFLESS_E_ARGUMENT unless `components` is 1 to 4, and no number NaN.
/// - Ownership: release `*attribute` with leafless_attribute_free.
/// - Untrusted input: any numbers.
leafless_status leafless_attribute_new_constant(const double *value, uint32_t components,
    leafless_attribute **attribute);

/// Makes an attribute under an affine map: its value at the image M p + t of a point p is that of `operand`
/// at p. Use it to move attributes and channels with a solid that leafless_solid_placed moves by the same
/// map. The map is inverted; the rounding displaces the values by about 2^-50 of the coordinates.
///
/// - Buffers: `matrix`, 12 numbers, the rows of [M | t]; `attribute`, one pointer.
/// - Result: `*attribute`.
/// - Errors: LEAFLESS_E_ARGUMENT if an entry is neither 0 nor of a magnitude between 2^-64 and 2^64, M is
///   singular, or an entry of the inverse is beyond 2^64.
/// - Ownership: the operand is shared and may be freed; release `*attribute` with leafless_attribute_free.
/// - Untrusted input: any attribute and numbers.
leafless_status leafless_attribute_placed(const leafless_attribute *operand, const double matrix[12],
    leafless_attribute **attribute);

/// Basic facts about an attribute.
typedef struct leafless_attribute_info {
    uint32_t struct_size;  ///< sizeof(leafless_attribute_info).
    uint32_t components;  ///< Numbers per value: 1 to 4.
    /// Approximate number of bytes of memory (or of mapped files) that the attribute keeps alive: its own,
    /// and those of the mesh, channel or samples that it shares. 0 for constants and for objects of the host.
    uint64_t bytes;
} leafless_attribute_info;

/// Returns basic facts about an attribute. O(1).
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
/// - Untrusted input: any attribute.
leafless_status leafless_attribute_describe(const leafless_attribute *attribute,
    leafless_attribute_info *info);

/// Returns the values of an attribute at points.
///
/// - Buffers: `points_model`, `count` points of 3 numbers; `values`, room for `count` values with
///   `components` numbers each, from leafless_attribute_describe. Both may be NULL if `count` is 0.
/// - Result: the value at point i from `values[components * i]` on; NaN where there is no value.
/// - Errors: LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any attribute, any numbers.
leafless_status leafless_attribute_values(const leafless_attribute *attribute, const double *points_model,
    uint64_t count, double *values);

/// Returns the range of the values of an attribute in the interior of a box.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `range`, one struct.
/// - Result: `*range`.
/// - Errors: LEAFLESS_E_ARGUMENT unless min <= max on every axis, and all coordinates are finite;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED.
/// - Untrusted input: any attribute, any numbers; the work is bounded.
leafless_status leafless_attribute_range(const leafless_attribute *attribute, const double min_model[3],
    const double max_model[3], leafless_value_range *range);

/// Returns one more reference to an attribute.
///
/// - Buffers: `attribute`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `attribute`.
/// - Ownership: release each reference with leafless_attribute_free.
leafless_status leafless_attribute_ref(const leafless_attribute *attribute, leafless_attribute **reference);

/// Releases a reference to an attribute; the last release frees the attribute. Channels that were filled from
/// it stay.
///
/// - Buffers: `attribute`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
void leafless_attribute_free(leafless_attribute *attribute);

/// Computes the value of the host's attribute at a point (3 numbers, model units): sets the numbers of
/// `value`, one for each component of the attribute. All are NaN before and stay NaN where there is no value;
/// a value whose first number is NaN counts as no value. Returns 0, or the host's own error code, which ends
/// the operation with LEAFLESS_E_CALLBACK and the code in the message.
///
/// It is called from several threads at once, which may all be the library's own, unless the operation's
/// options have `threads` = 1. It must give the same answer to the same point. It must return: no exception,
/// no longjmp. It may call this library.
typedef int32_t (*leafless_attribute_value_fn)(void *ctx, const double *point, double *value);

/// Computes the values at `count` points (3 numbers each) at once, for hosts that do this faster than one by
/// one: the numbers of the first value, then those of the second, and so on. Otherwise as
/// leafless_attribute_value_fn.
typedef int32_t (*leafless_attribute_values_fn)(void *ctx, const double *points, uint64_t count,
    double *values);

/// Bounds the values of the host's attribute in the interior of the box [min, max] (3 numbers each, model
/// units): sets `kind` and the intervals of `*range`. Before the call the kind is LEAFLESS_RANGE_KIND_UNKNOWN
/// and all numbers are NaN. The range must be proven: a wrong range hides details, because the library does
/// not search further. An interval that contains a NaN, or with lower > upper, proves nothing; an invalid
/// `kind` ends the operation with LEAFLESS_E_CALLBACK. Otherwise as leafless_attribute_value_fn.
typedef int32_t (*leafless_attribute_range_fn)(void *ctx, const double *min, const double *max,
    leafless_value_range *range);

/// An attribute of the host. `components` and one of `value` and `values` must be set; all other fields but
/// the first may be zero.
typedef struct leafless_attribute_callbacks {
    uint32_t struct_size;  ///< sizeof(leafless_attribute_callbacks).
    uint32_t components;  ///< Numbers per value: 1 to 4.
    leafless_attribute_value_fn value;  ///< Computes the value at a point; not called if `values` is set.
    /// Computes the values at many points, as many as the operation has ready.
    leafless_attribute_values_fn values;
    /// Bounds the values in a box; optional. With it, channels that hardly change are filled without a call
    /// for every cell, and LEAFLESS_CRITERION_RANGE misses no detail.
    leafless_attribute_range_fn range;
    leafless_destroy_fn destroy;  ///< Called when the library no longer needs `ctx`; optional.
    void *ctx;  ///< The context that the functions are called with.
} leafless_attribute_callbacks;

/// Makes an attribute from the host's own functions.
///
/// - Buffers: `callbacks`, one struct, which is copied; `attribute`, one pointer.
/// - Result: `*attribute`.
/// - Errors: LEAFLESS_E_NULL if `value` and `values` are NULL; LEAFLESS_E_ARGUMENT unless `components` is 1
///   to 4. After an error `destroy` is not called.
/// - Ownership: `ctx` must live until `destroy` is called with it; release `*attribute` with
///   leafless_attribute_free.
/// - Threads: any; leafless_attribute_value_fn describes the threads that call the functions.
/// - Untrusted input: any answers.
leafless_status leafless_attribute_new_callbacks(const leafless_attribute_callbacks *callbacks,
    leafless_attribute **attribute);

/// Returns an attribute of the triangles of a mesh, by its index: an array of values with a name. Files in
/// PLY and 3MF provide `colour` (red, green, blue and opacity from 0 to 255); 3MF files also provide
/// `material` and `object` (numbers, which may have names). A mesh from a polyhedron has `face`, `shell` and
/// `solid`, the numbers of the parts that a triangle belongs to.
///
/// - Buffers: `count`, one number; `name`, `name_length`, `components` and `per_corner`, one each, all NULL
///   to get only the count.
/// - Result: `*count`, the number of all attributes; the name in UTF-8, not NUL-terminated, with its length
///   in bytes; `*components`, the numbers per value, 1 to 4; `*per_corner`, true if each corner of a triangle
///   has a value, false if each triangle has one.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no attribute `index`, unless only the count is requested.
/// - Ownership: the name belongs to the mesh and lives as long as the reference `mesh`.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_peek_attribute_at(const leafless_mesh *mesh, uint64_t index, uint64_t *count,
    const char **name, size_t *name_length, uint32_t *components, bool *per_corner);

/// Returns the name of the value `value` of an attribute of a mesh: the name of a material or of an object.
///
/// - Buffers: `count`, one number; `name` and `name_length`, one each, both NULL to get only the count.
/// - Result: `*count`, the number of values, from 0 on, that have names; the name in UTF-8, not
///   NUL-terminated, with its length in bytes.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no attribute `index`, or the value has no name, unless only the
///   count is requested.
/// - Ownership: the name belongs to the mesh and lives as long as the reference `mesh`.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_peek_attribute_name_at(const leafless_mesh *mesh, uint64_t index,
    uint64_t value, uint64_t *count, const char **name, size_t *name_length);

/// Returns the values of an attribute of a mesh at the corners of all triangles.
///
/// - Buffers: `values`, room for `capacity` numbers, or NULL to get only the count; `count`, one number.
/// - Result: `*count`, 3 · components · triangles; in `values` the numbers at the three corners of the first
///   triangle, then of the second: NaN where there is no value.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no attribute `index`; LEAFLESS_E_BUFFER if the capacity is too
///   small.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_attribute_values(const leafless_mesh *mesh, uint64_t index, double *values,
    uint64_t capacity, uint64_t *count);

/// Returns the body of each triangle of a mesh. A body is a set of triangles that are connected by edges.
/// Bodies are numbered from 0 by their first triangles. Shells that touch only in single vertices, or lie
/// inside each other, are different bodies.
///
/// - Buffers: `bodies`, room for `capacity` numbers, or NULL to get only the count; `count`, one number.
/// - Result: `*count`, the number of triangles; in `bodies` the number of each triangle's body.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_bodies(const leafless_mesh *mesh, uint32_t *bodies, uint64_t capacity,
    uint64_t *count);

/// Returns the same mesh with one more attribute with a name, whose values come from `attribute`. The value
/// of a triangle is the value just inside it, `depth_model` behind its centroid. If there is none, it is the
/// value at a quarter of the depth, at twice the depth, or at the centroid itself; otherwise the triangle has
/// no value. So a surface takes values from the channels of its solid: half the edge of a channel's cells is
/// a good depth. leafless_mesh_write writes colours as `colour`, and materials as `material`.
///
/// O(t) queries. An attribute of the mesh with the same name is replaced.
///
/// - Buffers: `name`, `name_length` bytes of UTF-8; `options`, one struct or NULL; `bearing`, one pointer.
/// - Result: `*bearing`, identical for any number of threads.
/// - Errors: LEAFLESS_E_ARGUMENT unless the depth is finite and not negative; LEAFLESS_E_UTF8;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` and `attribute` are unchanged; release `*bearing` with leafless_mesh_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any mesh, any attribute, any text.
leafless_status leafless_mesh_with_values(const leafless_mesh *mesh, const leafless_attribute *attribute,
    const char *name, size_t name_length, double depth_model, const leafless_options *options,
    leafless_mesh **bearing);

/// Makes an attribute from an attribute of a mesh. Its value at a point is the value at the nearest point of
/// the mesh's surface: the value of the nearest triangle, or, with values for corners, the interpolated
/// value. If several triangles are equally near, the first one counts. Its ranges are proven.
///
/// - Buffers: `name`, `name_length` bytes of UTF-8: the name of an attribute of the mesh; `attribute`, one
///   pointer.
/// - Result: `*attribute`.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_ARGUMENT if the mesh has no such attribute; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the mesh is shared and may be freed; release `*attribute` with leafless_attribute_free.
/// - Untrusted input: any mesh, any text.
leafless_status leafless_attribute_from_mesh(const leafless_mesh *mesh, const char *name, size_t name_length,
    leafless_attribute **attribute);

/// Like leafless_attribute_from_mesh, with the host's own values: of bodies, faces, materials, or colours of
/// corners.
///
/// - Buffers: `values`, `count` numbers: `components` for each triangle, or for each of its three corners,
///   one after the other; `attribute`, one pointer.
/// - Result: `*attribute`. A value with a number that is not finite counts as no value.
/// - Errors: LEAFLESS_E_ARGUMENT unless `components` is 1 to 4, and there are values for all triangles;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: the values are copied, the mesh is shared and may be freed; release `*attribute` with
///   leafless_attribute_free.
/// - Untrusted input: any mesh, any numbers.
leafless_status leafless_attribute_from_mesh_values(const leafless_mesh *mesh, const double *values,
    uint64_t count, uint32_t components, bool per_corner, leafless_attribute **attribute);

/* ---- 24. Channels ------------------------------------------------------------------------------------- */

/// The type of the numbers of a channel. Numbers are rounded to the nearest number of the type; half-way
/// cases go to the even integer.
LEAFLESS_ENUM(leafless_scalar_type, uint32_t) {
    LEAFLESS_SCALAR_TYPE_F32 = 0,  ///< Finite numbers of single precision.
    LEAFLESS_SCALAR_TYPE_U8 = 1,  ///< Integers from 0 to 255.
    LEAFLESS_SCALAR_TYPE_U16 = 2,  ///< Integers from 0 to 65 535.
    LEAFLESS_SCALAR_TYPE_U32 = 3,  ///< Integers from 0 to 4 294 967 295.
};

/// Basic facts about a channel.
typedef struct leafless_channel_info {
    uint32_t struct_size;  ///< sizeof(leafless_channel_info).
    leafless_frame frame;  ///< The frame: the cube of its solid, with a depth of its own.
    leafless_scalar_type scalar;  ///< The type of the numbers.
    uint32_t components;  ///< Numbers per value: 1 to 4.
    uint64_t value_count;  ///< Number of stored values: one for each run of equal values.
    uint64_t elements;  ///< Array elements and bricks of the tree.
    uint64_t bytes;  ///< Bytes that the channel takes in memory.
} leafless_channel_info;

/// Returns one more reference to a channel.
///
/// - Buffers: `channel`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `channel`.
/// - Ownership: release each reference with leafless_channel_free.
leafless_status leafless_channel_ref(const leafless_channel *channel, leafless_channel **reference);

/// Releases a reference to a channel. The last release frees the channel. The mapping of its file ends too,
/// unless an octree, an attribute, or a channel with other metadata still shares it.
///
/// - Buffers: `channel`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
void leafless_channel_free(leafless_channel *channel);

/// Returns basic facts about a channel. O(1), except for a channel of a file that was mapped unverified: the
/// first function that reads it checks its links in one pass.
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
/// - Errors: LEAFLESS_E_DAMAGED.
/// - Untrusted input: any channel.
leafless_status leafless_channel_describe(const leafless_channel *channel, leafless_channel_info *info);

/// Checks that a channel is well-formed: O(n). Channels that the library makes, opens or maps verified always
/// are.
///
/// - Result: LEAFLESS_OK if the check passes.
/// - Errors: LEAFLESS_E_DAMAGED, with the first damage in the message; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any channel.
leafless_status leafless_channel_check(const leafless_channel *channel);

/// Returns whether two channels have the same values of the same type in the same cells, on the same frame.
/// Metadata is not compared. O(n).
///
/// - Buffers: `equal`, one truth value.
/// - Result: `*equal`.
/// - Untrusted input: any channels.
leafless_status leafless_channel_equal(const leafless_channel *a, const leafless_channel *b, bool *equal);

/// Makes an attribute from the values of a channel, for example to place them, or to fill a channel on
/// another frame. It has no values outside the channel's cube.
///
/// - Buffers: `attribute`, one pointer.
/// - Result: `*attribute`.
/// - Errors: only the general ones; reading its values returns LEAFLESS_E_DAMAGED if the channel was mapped
///   unverified and its links are damaged.
/// - Ownership: the attribute shares the channel, which may be freed; release `*attribute` with
///   leafless_attribute_free.
/// - Untrusted input: any channel.
leafless_status leafless_attribute_from_channel(const leafless_channel *channel,
    leafless_attribute **attribute);

/// Returns the channel with one more fact in its metadata, or with a new value of a fact; the arrays are
/// shared. Names in use: "name" (by which an octree finds the channel), "unit" (of the values), "meaning" (of
/// the values, such as "colour" or "density").
///
/// - Buffers: `key` and `value`, `key_length` and `value_length` bytes of UTF-8; `named`, one pointer.
/// - Result: `*named`.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_ARGUMENT if all facts would take more than 64 KiB in a file (each
///   takes 8 bytes and its two texts); LEAFLESS_E_NO_MEMORY.
/// - Ownership: the texts are copied. `*named` shares the arrays of `channel`, which may be freed. Bytes that
///   `channel` views must outlive `*named` too, and a file that it maps must stay unchanged as long. Release
///   `*named` with leafless_channel_free.
/// - Untrusted input: any texts.
leafless_status leafless_channel_with_metadata(const leafless_channel *channel, const char *key,
    size_t key_length, const char *value, size_t value_length, leafless_channel **named);

/// Returns the channel with one fact less in its metadata, or without metadata; the arrays are shared.
///
/// - Buffers: `key`, `key_length` bytes of UTF-8, or NULL for all facts; `unnamed`, one pointer.
/// - Result: `*unnamed`; it is not an error if there is no such fact.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_channel_with_metadata.
/// - Untrusted input: any texts.
leafless_status leafless_channel_without_metadata(const leafless_channel *channel, const char *key,
    size_t key_length, leafless_channel **unnamed);

/// Returns the value of a fact in a channel's metadata, such as "name".
///
/// - Buffers: `key`, `key_length` bytes of UTF-8; `value` and `value_length`, one each.
/// - Result: `*value`, not NUL-terminated; NULL if there is no such fact. `*value_length`, in bytes.
/// - Errors: LEAFLESS_E_UTF8.
/// - Ownership: the text belongs to the channel and lives as long as the reference `channel`.
/// - Untrusted input: any channel.
leafless_status leafless_channel_peek_metadata(const leafless_channel *channel, const char *key,
    size_t key_length, const char **value, size_t *value_length);

/// Returns a fact of a channel's metadata by its index. Facts are sorted by key.
///
/// - Buffers: `count`, one number; `key`, `key_length`, `value`, `value_length`, one each, all four NULL to
///   get only the count.
/// - Result: `*count`, the number of all facts; key and value, not NUL-terminated, with their lengths in
///   bytes.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no fact `index`, unless only the count is requested.
/// - Ownership: the texts belong to the channel and live as long as the reference `channel`.
/// - Untrusted input: any channel.
leafless_status leafless_channel_peek_metadata_at(const leafless_channel *channel, uint64_t index,
    uint64_t *count, const char **key, size_t *key_length, const char **value, size_t *value_length);

/// The criterion for the size of cells that follow an attribute.
LEAFLESS_ENUM(leafless_criterion, uint32_t) {
    /// Cells are split to the finest level, unless a cell is proven to have one value.
    LEAFLESS_CRITERION_NONE = 0,
    /// Cells are split until the variance of the values at a cell's corners is at most the square of the
    /// tolerance. The variance of several numbers is the sum of their variances. A detail between the corners
    /// is missed.
    LEAFLESS_CRITERION_VARIANCE = 1,
    /// Cells are split until the values in a cell are proven to differ by no more than the tolerance, in each
    /// of their numbers. No detail is missed. A cell whose range is unknown is split.
    LEAFLESS_CRITERION_RANGE = 2,
};

/// Options of filling a channel. NULL means the defaults. Zero is the default of every field but the first.
typedef struct leafless_channel_fill_options {
    uint32_t struct_size;  ///< sizeof(leafless_channel_fill_options).
    leafless_scalar_type scalar;  ///< A leafless_scalar_type: the type that numbers are rounded to.
    /// Numbers per value, the same as for the attribute; 0 means those of the attribute.
    uint32_t components;
    uint32_t depth;  ///< Depth of the channel; 0 means the depth of the frame.
    /// The octree inside which values matter; optional. Where it is EMPTY, the channel has arbitrary values
    /// that take the least memory.
    const leafless_octree *solid;
    /// A leafless_criterion. Unless it is LEAFLESS_CRITERION_NONE, a cell is split until its edge is at most
    /// `coarse_model` and the criterion holds, or until its edge is at most `fine_model`. It then has the
    /// value at its centre.
    leafless_criterion criterion;
    uint32_t reserved;  ///< Reserved; must be 0.
    double coarse_model;  ///< With a criterion, the longest edge of cells; 0 means any.
    /// With a criterion, cells of this edge or less are not split. At most `coarse_model`; 0 means the edge
    /// of the finest cells.
    double fine_model;
    double tolerance;  ///< The tolerance of the criterion, in the attribute's units; may be infinite.
    const char *name;  ///< The name of the channel, `name_length` bytes of UTF-8; optional.
    size_t name_length;  ///< Length of the name in bytes.
} leafless_channel_fill_options;

/// Fills a channel from an attribute: each cell gets the attribute's value at its centre, rounded to the type
/// of the numbers; a cell whose centre has no value gets none. Cells are as large as proven ranges and the
/// criterion allow. The result is identical, bit for bit, for any number of threads.
///
/// Without a criterion the result is that of evaluating the attribute at the centre of every finest cell. An
/// attribute without ranges is evaluated at all these centres: 8^depth times, or, with a solid, once for each
/// finest cell that is not EMPTY.
///
/// - Buffers: `frame`, one struct, or NULL for the frame of `fill->solid`, which is then needed; `fill`, one
///   struct or NULL; `options`, one struct or NULL; `channel`, one pointer.
/// - Result: `*channel`, with the name as its only fact, if there is one.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check, if a field of `fill` is wrong, or if a value is
///   beyond the range of the type, infinite, or partly NaN; LEAFLESS_E_FRAME if the solid lies in another
///   cube than the frame; LEAFLESS_E_NULL if both are missing; LEAFLESS_E_UTF8; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the library keeps no reference to the attribute, the solid and the name; release `*channel`
///   with leafless_channel_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any attribute, any octree; set `max_bytes` if the depth or the attribute is untrusted.
leafless_status leafless_channel_fill(const leafless_attribute *attribute, const leafless_frame *frame,
    const leafless_channel_fill_options *fill, const leafless_options *options, leafless_channel **channel);

/// Returns the values of a channel at points. A point on a face between cells belongs to the upper cell.
/// O(depth) each.
///
/// - Buffers: `points_model`, `count` points of 3 numbers; `values`, room for `count` values with
///   `components` numbers each, from leafless_channel_describe. Both may be NULL if `count` is 0.
/// - Result: the value at point i from `values[components * i]` on; NaN where there is no value, and outside
///   the channel's cube.
/// - Errors: LEAFLESS_E_DAMAGED.
/// - Untrusted input: any channel, any numbers; damage reads as no value.
leafless_status leafless_channel_values(const leafless_channel *channel, const double *points_model,
    uint64_t count, double *values);

/// Returns the value of a channel at a point, like leafless_channel_values.
///
/// - Buffers: `point_model`, 3 numbers; `value`, room for 4 numbers.
/// - Result: `value`: the numbers of the channel's value, and 0 beyond them; four NaN if there is no value.
/// - Errors: LEAFLESS_E_DAMAGED.
/// - Untrusted input: any channel, any numbers; damage reads as no value.
leafless_status leafless_channel_value(const leafless_channel *channel, const double point_model[3],
    double value[4]);

/// Returns the value of a finest cell of a channel's own frame. O(depth).
///
/// - Buffers: `cell`, 3 numbers; `value`, room for 4 numbers.
/// - Result: `value`, as leafless_channel_value; four NaN if a coordinate is not below 2^depth.
/// - Errors: LEAFLESS_E_DAMAGED.
/// - Untrusted input: any channel, any numbers; damage reads as no value.
leafless_status leafless_channel_value_at(const leafless_channel *channel, const uint32_t cell[3],
    double value[4]);

/// Returns the channel with one value wherever an octree is not EMPTY, and unchanged elsewhere. It has the
/// depth of the deeper of the two. The result is identical, bit for bit, for any number of threads.
///
/// - Buffers: `region`, a handle; `value`, as many numbers as the channel's values have, or NULL to remove
///   values; `options`, one struct or NULL; `changed`, one pointer.
/// - Result: `*changed`, with the metadata of `channel`.
/// - Errors: LEAFLESS_E_ARGUMENT if the value is beyond the type's range, or not finite; LEAFLESS_E_FRAME
///   unless both lie in one cube; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: `channel` is unchanged; release `*changed` with leafless_channel_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any channel, any octree, any numbers.
leafless_status leafless_channel_with_value_in(const leafless_channel *channel, const leafless_octree *region,
    const double *value, const leafless_options *options, leafless_channel **changed);

/// The interpolation between the samples of a volume.
LEAFLESS_ENUM(leafless_interpolation, uint32_t) {
    /// The trilinear interpolation of the eight samples around a point.
    LEAFLESS_INTERPOLATION_TRILINEAR = 0,
    /// The sample of the voxel that contains the point; on a face between voxels, the sample of the upper
    /// voxel.
    LEAFLESS_INTERPOLATION_NEAREST = 1,
};

/// A summary of a channel's values in a region, number by number; entries beyond the numbers of a value are
/// 0. All intervals contain the truth, as far as the cells of the solid and of the channel represent it.
typedef struct leafless_channel_summary {
    uint32_t struct_size;  ///< sizeof(leafless_channel_summary).
    double least[4];  ///< The least value of any cell that may belong to the region.
    double greatest[4];  ///< The greatest value of any cell that may belong to the region.
    /// The integral of the value over the region, in the value's units times cubic model units: for a
    /// density, the mass.
    leafless_interval integral[4];
    leafless_interval mean[4];  ///< The mean value.
    leafless_interval volume_model;  ///< The volume of the region that has values, in cubic model units.
    /// The volume of the region without values, in cubic model units.
    leafless_interval volume_without_model;
    bool has_values;  ///< Whether a part of the region may have a value. If not, all other fields are 0.
} leafless_channel_summary;

/// Volume, centroid and inertia of the part of a solid that has one value.
typedef struct leafless_material {
    double value[4];  ///< The value; entries beyond its numbers are 0.
    leafless_measures measures;  ///< Measures of the part of the solid that has the value, for density 1.
} leafless_material;

/// Computes least, greatest, mean and integral of a channel's values in the part of a solid that lies in a
/// box at any position. O(cells that the box meets).
///
/// - Buffers: `solid`, a handle, or NULL for all space; `min_model` and `max_model`, 3 numbers each, which
///   may be infinite, or both NULL for all of the channel's cube; `options`, one struct or NULL (its limits
///   are ignored); `summary`, one struct.
/// - Result: `*summary`.
/// - Errors: LEAFLESS_E_ARGUMENT if a coordinate is not a number, or min > max; LEAFLESS_E_FRAME if the solid
///   lies in another cube; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED.
/// - Untrusted input: any channel, any octree, any numbers.
leafless_status leafless_channel_summarise(const leafless_channel *channel, const leafless_octree *solid,
    const double min_model[3], const double max_model[3], const leafless_options *options,
    leafless_channel_summary *summary);

/// Makes the octree of the cells whose values lie in a band: every number between those of `low` and `high`,
/// both included. Cells without a value are EMPTY. The octree lies on the channel's frame, and no cell is
/// PARTIAL. Intersect it with a part to get, for example, the region of a material, or the region hotter than
/// a limit.
///
/// - Buffers: `low` and `high`, as many numbers each as the channel's values have, which may be infinite;
///   `options`, one struct or NULL; `octree`, one pointer.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_ARGUMENT if a bound is not a number; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT;
///   LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*octree` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any channel, any numbers.
leafless_status leafless_channel_region(const leafless_channel *channel, const double *low,
    const double *high, const leafless_options *options, leafless_octree **octree);

/// Measures the parts of a solid in which a channel has one value, each as leafless_solid_measure: one for
/// each value of the channel that the solid may have somewhere, in ascending order of the values. The cells
/// of the channel decide the material. Returning only the count takes as long.
///
/// - Buffers: `frame`, one struct: the frame on which the solid is split, with the channel's cube; `options`,
///   one struct or NULL; `measured`, room for `capacity` structs, or NULL to get only the count; `count`, one
///   number. `relative` and `absolute_model` are those of leafless_solid_measure.
/// - Result: `*count`; the materials.
/// - Errors: LEAFLESS_E_LIMIT if the channel has more than 4096 different values; LEAFLESS_E_FRAME unless
///   `frame` has the channel's cube; LEAFLESS_E_BUFFER if the capacity is too small; otherwise as
///   leafless_solid_measure.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid, any channel; the default of `max_splits` bounds the work for each value.
leafless_status leafless_solid_materials(const leafless_solid *solid, const leafless_channel *channel,
    const leafless_frame *frame, double relative, double absolute_model, const leafless_options *options,
    leafless_material *measured, uint64_t capacity, uint64_t *count);

/// Makes an attribute of one number from the samples of a volume, at the position that the file states. There
/// is no value outside the voxels, nor where a sample used for the value is not a number. The first solid,
/// range or attribute of a volume reads all samples, in O(n).
///
/// - Buffers: `interpolation`, a leafless_interpolation; `options`, one struct or NULL (its limits are
///   ignored); `attribute`, one pointer.
/// - Result: `*attribute`.
/// - Errors: LEAFLESS_E_ARGUMENT if the map that places the volume has no valid inverse;
///   LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the attribute shares the samples, and `volume` may be freed; release `*attribute` with
///   leafless_attribute_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any volume.
leafless_status leafless_attribute_from_volume(const leafless_volume *volume,
    leafless_interpolation interpolation, const leafless_options *options, leafless_attribute **attribute);

/// The rule for the value of a point that lies in several operands.
LEAFLESS_ENUM(leafless_carry, uint32_t) {
    LEAFLESS_CARRY_LEFT = 0,  ///< The value of the first operand that has one.
    LEAFLESS_CARRY_RIGHT = 1,  ///< The value of the last operand that has one.
    LEAFLESS_CARRY_MAX = 2,  ///< The greatest of all values, number by number.
    LEAFLESS_CARRY_MEAN = 3,  ///< The mean of all values, number by number, rounded to the type.
};

/// The rule for carrying channels of one name.
typedef struct leafless_carry_rule {
    const char *name;  ///< The name of the channels, `name_length` bytes of UTF-8.
    size_t name_length;  ///< Length of the name in bytes.
    leafless_carry carry;  ///< A leafless_carry.
} leafless_carry_rule;

/// Returns the octree with one more channel, which replaces a channel of the same name; the arrays of both
/// are shared. A channel without a name has the empty name.
///
/// - Buffers: `result`, one pointer.
/// - Result: `*result`, with the metadata of `octree`.
/// - Errors: LEAFLESS_E_FRAME if the channel lies in another cube than the octree; LEAFLESS_E_ARGUMENT if
///   there are 256 channels already; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `*result` shares the arrays of `octree` and `channel`, which may be freed. Bytes that these
///   view must outlive `*result` too, and files that they map must stay unchanged as long. Release `*result`
///   with leafless_octree_free.
/// - Untrusted input: any octree, any channel.
leafless_status leafless_octree_with_channel(const leafless_octree *octree, const leafless_channel *channel,
    leafless_octree **result);

/// Returns the octree without the channel of a name, or without all channels; the arrays are shared.
///
/// - Buffers: `name`, `name_length` bytes of UTF-8, or NULL for all channels; `result`, one pointer.
/// - Result: `*result`, with the metadata of `octree`; it is not an error if there is no such channel.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_octree_with_channel.
/// - Untrusted input: any octree, any text.
leafless_status leafless_octree_without_channel(const leafless_octree *octree, const char *name,
    size_t name_length, leafless_octree **result);

/// Returns a channel of an octree by its index. Channels are sorted by name.
///
/// - Buffers: `channel`, one pointer.
/// - Result: `*channel`.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no channel `index`.
/// - Ownership: `*channel` shares the arrays of `octree`, which may be freed. Bytes that `octree` views must
///   outlive `*channel` too, and a file that it maps must stay unchanged as long. Release `*channel` with
///   leafless_channel_free.
/// - Untrusted input: any octree.
leafless_status leafless_octree_channel_at(const leafless_octree *octree, uint64_t index,
    leafless_channel **channel);

/// Returns the channel of an octree with a name.
///
/// - Buffers: `name`, `name_length` bytes of UTF-8; `channel`, one pointer.
/// - Result: `*channel`; NULL if there is no such channel.
/// - Errors: LEAFLESS_E_UTF8.
/// - Ownership: as leafless_octree_channel_at.
/// - Untrusted input: any octree, any text.
leafless_status leafless_octree_channel(const leafless_octree *octree, const char *name, size_t name_length,
    leafless_channel **channel);

/// Returns an octree with the channels of its operands. The octree was made by any operation from operands in
/// the same cube. Channels of one name become one channel, in which, at each point, the values of the
/// operands count that are not EMPTY there. A channel that only one operand has is shared unchanged. The
/// result is identical, bit for bit, for any number of threads.
///
/// - Buffers: `octree`, a handle; `operands`, `count` handles; `carry`, a leafless_carry, the rule for
///   channels that none of `rules` names; `rules`, `rule_count` structs, or NULL if that is 0; the first rule
///   that names a channel applies. `options`, one struct or NULL, whose limits apply to each channel;
///   `result`, one pointer.
/// - Result: `*result`: the cells and metadata of `octree`; its own channels, except those whose name a
///   channel of an operand has; each such channel with the metadata of the first operand that has it.
/// - Errors: LEAFLESS_E_ARGUMENT if channels of one name have values of two types, or there are more than
///   256; LEAFLESS_E_FRAME unless all lie in one cube; LEAFLESS_E_UTF8; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT;
///   LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_octree_with_channel.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octrees, any texts.
leafless_status leafless_octree_carry_channels(const leafless_octree *octree,
    const leafless_octree *const *operands, uint64_t count, leafless_carry carry,
    const leafless_carry_rule *rules, uint64_t rule_count, const leafless_options *options,
    leafless_octree **result);

/* ---- 25. Voxel records -------------------------------------------------------------------------------- */

/// The kind of a voxel: a number in the array `kinds`.
LEAFLESS_ENUM(leafless_voxel_kind, uint8_t) {
    LEAFLESS_VOXEL_KIND_OUTSIDE = 0,  ///< The voxel lies outside the solid.
    LEAFLESS_VOXEL_KIND_INSIDE = 1,  ///< The voxel lies inside the solid.
    LEAFLESS_VOXEL_KIND_BOUNDARY = 2,  ///< The boundary of the solid passes through the voxel, or along it.
    LEAFLESS_VOXEL_KIND_REFINED = 3,  ///< The voxel consists of the smaller voxels that follow it.
};

/// The rule for boundary voxels.
LEAFLESS_ENUM(leafless_voxel_boundary, uint32_t) {
    /// Cells of the boundary depth that are split further, and cells that are not decided.
    LEAFLESS_VOXEL_BOUNDARY_CUT = 0,
    /// The voxels of LEAFLESS_VOXEL_BOUNDARY_CUT, and inside cells of the boundary depth that share a face
    /// with an outside cell.
    LEAFLESS_VOXEL_BOUNDARY_TOUCHING = 1,
};

/// The voxels that are listed in addition to inside and boundary voxels: 0, one of these values, or both
/// joined by `|`.
LEAFLESS_ENUM(leafless_voxel_lists, uint32_t) {
    LEAFLESS_VOXEL_LISTS_OUTSIDE = 1,  ///< Outside voxels.
    LEAFLESS_VOXEL_LISTS_REFINED = 2,  ///< Refined voxels.
};

/// Options of listing voxels: which voxels of an octree are listed, and their sizes. Zero is the default of
/// every field but the first.
typedef struct leafless_voxel_options {
    uint32_t struct_size;  ///< sizeof(leafless_voxel_options).
    /// The level of boundary voxels; 0, or more than the octree's depth, means the octree's depth.
    uint32_t boundary_depth;
    leafless_voxel_boundary boundary;  ///< A leafless_voxel_boundary.
    uint32_t lists;  ///< 0, or leafless_voxel_lists.
    /// The longest edge of inside voxels, in model units; 0 means the size of the octree's cells.
    double coarse_model;
    /// With a criterion, inside voxels of this edge (model units) are not split; 0 means the coarse edge.
    double fine_model;
    /// With a criterion, the tolerance for changes of the attribute in an inside voxel that is longer than
    /// the fine edge.
    double tolerance;
    /// The attribute that inside voxels follow, and whose values are listed; optional.
    const leafless_attribute *attribute;
    /// A leafless_criterion: decides whether an inside voxel between the fine and the coarse edge is fine
    /// enough. Without a criterion, all inside voxels have the coarse edge or less.
    leafless_criterion criterion;
    uint32_t reserved;  ///< Reserved; must be 0.
} leafless_voxel_options;

/// Lists the voxels of an octree: inside and boundary voxels, and others that `voxel_options` requests. They
/// are sorted by linear octree code; of two voxels with the same code the larger comes first. The code of a
/// voxel is the Morton code of its minimum corner on the lattice `*lattice`: one octal digit for each level
/// of the lattice, from the root on; the first digits, as many as the voxel's level, are significant. Call it
/// once for the count, and then with buffers.
///
/// - Buffers: `voxel_options`, one struct or NULL; `options`, one struct or NULL (only its limit `max_bytes`
///   applies); `lattice`, one struct; `codes`, `levels`, `kinds`, `corners_model` (3 numbers a record) and
///   `values` (as many numbers a record as values have components), room for `capacity` records each; each
///   may be NULL if it is not wanted; `count`, one number.
/// - Result: `*lattice`, the octree's universe with the depth of the finest possible voxel; the arrays;
///   `*count`, the number of records. `kinds` are leafless_voxel_kind. Corners that are not doubles are
///   rounded down. Values are those at the centres of voxels, NaN where there is no value.
/// - Errors: LEAFLESS_E_ARGUMENT if an option is out of its range, or the universe would take more than 20
///   levels to the fine edge; LEAFLESS_E_BUFFER if `capacity` is too small: nothing is written then;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_CANCELLED.
/// - Untrusted input: any octree: damage reads as boundary voxels.
leafless_status leafless_octree_voxels(const leafless_octree *octree,
    const leafless_voxel_options *voxel_options, const leafless_options *options, leafless_frame *lattice,
    uint64_t *codes, uint8_t *levels, leafless_voxel_kind *kinds, double *corners_model, double *values,
    uint64_t capacity, uint64_t *count);

/// Finds the record of an unrefined voxel that contains a cell. O(log count).
///
/// - Buffers: `lattice`, one struct; `codes`, `levels` and `kinds`, `count` elements each, as written by
///   leafless_octree_voxels; `cell`, 3 numbers: the cell's index on each axis; `index`, one number.
/// - Result: `*index`, the index of the record, or UINT64_MAX if there is none.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check.
/// - Untrusted input: any numbers; the answer is meaningful only if the records are sorted.
leafless_status leafless_voxels_find(const leafless_frame *lattice, const uint64_t *codes,
    const uint8_t *levels, const leafless_voxel_kind *kinds, uint64_t count, const uint32_t cell[3],
    uint32_t level, uint64_t *index);

/// Returns the indices of the records from front to back: a voxel comes before every other voxel that it
/// hides in part. Refined voxels are left out. The order is exact, and computed without comparing records.
///
/// - Buffers: `lattice`, `codes`, `levels` and `kinds` as leafless_voxels_find; `from`, 3 numbers: the
///   direction of sight, or, if `is_eye`, the eye point (model units); `options`, one struct or NULL;
///   `order`, room for `capacity` numbers, or NULL to get only their count; `order_count`, one number.
/// - Result: `order`; `*order_count`, the number of records that are not refined.
/// - Errors: LEAFLESS_E_ARGUMENT if the arrays are not valid records, the direction is zero, or a number is
///   not finite (for an eye also if a nonzero coordinate has a magnitude beyond 2^256 or below 2^-256);
///   LEAFLESS_E_BUFFER if `capacity` is too small: nothing is written then; LEAFLESS_E_NO_MEMORY;
///   LEAFLESS_E_CANCELLED.
/// - Untrusted input: any numbers.
leafless_status leafless_voxels_order(const leafless_frame *lattice, const uint64_t *codes,
    const uint8_t *levels, const leafless_voxel_kind *kinds, uint64_t count, const double from[3],
    bool is_eye, const leafless_options *options, uint64_t *order, uint64_t capacity, uint64_t *order_count);

/// Returns the records under one of the 48 symmetries of the universe about its centre, followed by an offset
/// of whole finest cells of the lattice. The map is exact: the octree of the result is the octree of the
/// records under the same map. Call it once for the count, and then with buffers.
///
/// A record whose image is not a cell becomes the largest cells that compose its image. Parts that leave the
/// universe are cut off; the space that enters has no records. A refined voxel is left out if its image is
/// not a cell of the universe.
///
/// - Buffers: `lattice`, `codes`, `levels` and `kinds` as leafless_voxels_find; `axes` and `offset_cells`, 3
///   numbers each; `options`, one struct or NULL (only its limit `max_bytes` applies); `moved_codes`,
///   `moved_levels`, `moved_kinds` and `sources`, room for `capacity` elements each; each may be NULL if it
///   is not wanted; `moved_count`, one number. `axes[i]` is the old axis that becomes the new axis i: 1 for
///   x, 2 for y, 3 for z, negative if its direction is reversed; 1, 2, 3 is the identity.
/// - Result: the arrays, sorted as by leafless_octree_voxels; `sources`, the index of the record that each
///   comes from; `*moved_count`, their number.
/// - Errors: LEAFLESS_E_ARGUMENT if the arrays are not valid records, or `axes` are not three different axes;
///   LEAFLESS_E_BUFFER if `capacity` is too small: nothing is written then; LEAFLESS_E_LIMIT;
///   LEAFLESS_E_NO_MEMORY; LEAFLESS_E_CANCELLED.
/// - Untrusted input: any numbers.
leafless_status leafless_voxels_moved(const leafless_frame *lattice, const uint64_t *codes,
    const uint8_t *levels, const leafless_voxel_kind *kinds, uint64_t count, const int32_t axes[3],
    const int32_t offset_cells[3], const leafless_options *options, uint64_t *moved_codes,
    uint8_t *moved_levels, leafless_voxel_kind *moved_kinds, uint64_t *sources, uint64_t capacity,
    uint64_t *moved_count);

/// Finds the triangles of a mesh that meet each boundary voxel, in compressed rows: the triangles of record i
/// are `triangles[offsets[i]]` up to, but not including, `triangles[offsets[i + 1]]`, ascending. A triangle
/// that only touches a voxel meets it. The test is exact.
///
/// - Buffers: `lattice`, `codes`, `levels` and `kinds` as leafless_voxels_find; `options`, one struct or NULL
///   (only its limit `max_bytes` applies); `offsets`, room for `offset_capacity` numbers, and `triangles`,
///   room for `triangle_capacity`, each NULL to get only its count; `offset_count` and `triangle_count`, one
///   number each.
/// - Result: `offsets`, one more than there are records; `triangles`, indices into the mesh; their counts.
/// - Errors: LEAFLESS_E_ARGUMENT if the arrays are not valid records; LEAFLESS_E_BUFFER if a capacity is too
///   small: nothing is written then; LEAFLESS_E_LIMIT; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_CANCELLED.
/// - Untrusted input: any numbers, any mesh.
leafless_status leafless_voxels_triangles(const leafless_frame *lattice, const uint64_t *codes,
    const uint8_t *levels, const leafless_voxel_kind *kinds, uint64_t count, const leafless_mesh *mesh,
    const leafless_options *options, uint64_t *offsets, uint64_t offset_capacity, uint64_t *offset_count,
    uint32_t *triangles, uint64_t triangle_capacity, uint64_t *triangle_count);

/// Makes the octree of records, to the depth of their lattice: inside voxels are FULL; outside voxels and
/// space without records are EMPTY. The space outside the universe is undecided, and nothing is proven.
///
/// - Buffers: `lattice`, `codes`, `levels` and `kinds` as leafless_voxels_find; `options`, one struct or
///   NULL; `octree`, one pointer. `boundary` is the tag of boundary voxels: LEAFLESS_TAG_EMPTY,
///   LEAFLESS_TAG_PARTIAL or LEAFLESS_TAG_FULL.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_ARGUMENT if the arrays are not valid records, or `boundary` is another tag;
///   LEAFLESS_E_LIMIT; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_CANCELLED.
/// - Ownership: release `*octree` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any numbers.
leafless_status leafless_octree_from_voxels(const leafless_frame *lattice, const uint64_t *codes,
    const uint8_t *levels, const leafless_voxel_kind *kinds, uint64_t count, leafless_tag boundary,
    const leafless_options *options, leafless_octree **octree);

/* ---- 26. Surfaces ------------------------------------------------------------------------------------- */

/// The method that makes a surface.
LEAFLESS_ENUM(leafless_surface_method, uint32_t) {
    /// Marching cubes: vertices on the edges between inside and outside samples. Exactly two triangles meet
    /// at every edge.
    LEAFLESS_SURFACE_METHOD_MARCHING_CUBES = 0,
    /// Simple marching cubes: all vertices are samples, and all normals have one of 13 directions up to sign.
    /// The mesh is closed, but where its sheets touch, more than two triangles meet at an edge.
    LEAFLESS_SURFACE_METHOD_SIMPLE_MARCHING_CUBES = 1,
    /// Coplanar shrink: the surface of simple marching cubes with far fewer triangles where it has plane
    /// parts. All triangles in one plane become one region with straight edges. There are no cracks;
    /// triangles may be long and thin.
    LEAFLESS_SURFACE_METHOD_SHRINK = 2,
    /// Coplanar shrink in its published form, for comparison. It has cracks, so that the mesh is open where
    /// merged cells of several sizes meet.
    LEAFLESS_SURFACE_METHOD_SHRINK_PUBLISHED = 3,
    /// Dual contouring, for solids only: edges and corners stay sharp. Samples are the centres of cells. It
    /// is leafless_tridexel_surface of a temporary tri-dexel model with normals; that function also reports
    /// features that the mesh does not represent.
    LEAFLESS_SURFACE_METHOD_DUAL_CONTOURING = 4,
    /// Surface nets, for octrees only: a vertex in each cube between samples that do not all lie on one side,
    /// in the middle of the surface's crossings with the cube. Steps of the cells are smoothed; exactly two
    /// triangles meet at every edge.
    LEAFLESS_SURFACE_METHOD_SURFACE_NETS = 5,
};

/// The end of an edge between an inside and an outside sample to which simple marching cubes and coplanar
/// shrink move the vertex.
LEAFLESS_ENUM(leafless_snap, uint32_t) {
    LEAFLESS_SNAP_FAT = 0,  ///< The outer end: the mesh contains all inside samples.
    /// The inner end: inside samples are vertices. Parts that are one cell thick then have no thickness.
    LEAFLESS_SNAP_THIN = 1,
};

/// The side of the surface for the PARTIAL cells of an octree, which have no sign of their own.
LEAFLESS_ENUM(leafless_resolve, uint32_t) {
    LEAFLESS_RESOLVE_NONE = 0,  ///< Not given, which is an error if there are PARTIAL cells.
    /// Outside: the surface is that of the FULL cells, which are certainly solid.
    LEAFLESS_RESOLVE_INNER = 1,
    /// Inside: the surface is that of the FULL and PARTIAL cells, which are possibly solid.
    LEAFLESS_RESOLVE_OUTER = 2,
    /// Decided by `source`, the solid that the octree was made from: each cell's centre decides, as under
    /// LEAFLESS_RULE_SAMPLED. The solid is built anew on the octree's frame.
    LEAFLESS_RESOLVE_SOURCE = 3,
};

/// The position of a vertex of marching cubes on an edge between an inside and an outside sample.
LEAFLESS_ENUM(leafless_vertex_placement, uint32_t) {
    /// Half-way. The mesh has steps, and is up to half a cell away from the surface.
    LEAFLESS_VERTEX_PLACEMENT_MIDPOINT = 0,
    /// Where the edge crosses the solid's surface; if it crosses several times, at one of the crossings.
    /// Half-spaces, meshes and solids made of them provide the crossing up to rounding. For a solid that only
    /// classifies boxes, cells along the edge are split down to depth 20, and the crossing is known to a cell
    /// of that depth.
    LEAFLESS_VERTEX_PLACEMENT_CROSSING = 1,
};

/// Options of extracting a surface. NULL means the defaults. Zero is the default of every field but the
/// first. A field that the method does not use must be zero.
typedef struct leafless_surface_options {
    uint32_t struct_size;  ///< sizeof(leafless_surface_options).
    leafless_surface_method method;  ///< A leafless_surface_method.
    /// A leafless_snap, for LEAFLESS_SURFACE_METHOD_SIMPLE_MARCHING_CUBES and both kinds of
    /// LEAFLESS_SURFACE_METHOD_SHRINK.
    leafless_snap snap;
    leafless_resolve resolve;  ///< A leafless_resolve, for octrees. Solids decide all samples themselves.
    /// A leafless_vertex_placement, for LEAFLESS_SURFACE_METHOD_MARCHING_CUBES of solids. Octrees do not
    /// store the position of their solid's surface.
    leafless_vertex_placement placement;
    uint32_t reserved;  ///< Reserved; 0.
    const leafless_solid *source;  ///< The solid that the octree was made from, for LEAFLESS_RESOLVE_SOURCE.
} leafless_surface_options;

/// Extracts the surface of an octree: a closed mesh between the centres of finest cells that lie inside and
/// those that lie outside. The space around the universe counts as outside, so that the mesh is closed there,
/// too.
///
/// Every edge is used as often in one direction as in the other, except for
/// LEAFLESS_SURFACE_METHOD_SHRINK_PUBLISHED. Triangles turn counter-clockwise as seen from outside; no two
/// vertices are equal, and no triangle has a vertex twice. The order of vertices and triangles is always the
/// same: the Morton order of the cells, or, for coplanar shrink, the order of positions and planes.
/// leafless_mesh_describe and leafless_mesh_copy return the arrays, leafless_mesh_inspect and
/// leafless_mesh_area analyse them, leafless_mesh_intersecting_pairs finds triangles that intersect, and
/// leafless_mesh_write writes them.
///
/// Time is linear in the octree's array elements and the mesh: it grows with the surface, not with the
/// volume. (Coplanar shrink takes O(n log n + n w) for n cells at the surface, with at most w of them along a
/// line in a plane region.) In addition to the mesh, memory is 56 bytes (simple marching cubes: up to 128)
/// for each block of 4³ cells at the surface, and for coplanar shrink up to 200 bytes for each cell at a
/// curved surface.
///
/// - Buffers: `surface`, one struct or NULL; `options`, one struct or NULL (`max_nodes` and `max_bytes` apply
///   to LEAFLESS_RESOLVE_SOURCE only); `mesh`, one pointer.
/// - Result: `*mesh`, identical for any number of threads; it has no triangles if no sample is inside.
/// - Errors: LEAFLESS_E_ARGUMENT if the octree has PARTIAL cells and `resolve` is LEAFLESS_RESOLVE_NONE, if a
///   field of `surface` is not a member of its enumeration, or is set though the method does not use it, or
///   if the frame is so far from the origin that doubles cannot distinguish its cells; LEAFLESS_E_NULL if
///   LEAFLESS_RESOLVE_SOURCE has no `source`; LEAFLESS_E_MESH if there would be more than 2^32 - 1 vertices
///   or triangles; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY; and those of
///   leafless_octree_build for the source.
/// - Ownership: `octree` is unchanged; release `*mesh` with leafless_mesh_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octree; damage is LEAFLESS_E_DAMAGED or another surface.
leafless_status leafless_octree_surface(const leafless_octree *octree,
    const leafless_surface_options *surface, const leafless_options *options, leafless_mesh **mesh);

/// Extracts the surface of a solid, sampled at the corners of the cells of a frame: 2^depth + 1 on each axis.
/// Dual contouring samples at the centres. Otherwise as leafless_octree_surface. Parts of the solid outside
/// the universe are cut off.
///
/// Time is that of leafless_octree_build with LEAFLESS_RULE_SAMPLED on as many cells as there are corners,
/// and for LEAFLESS_VERTEX_PLACEMENT_CROSSING a few more queries of the solid for each vertex; memory as
/// well. With crossings, vertices at equal positions are merged, and triangles without area are dropped.
/// Where the solid has no thickness at a sample, more than two triangles may then meet at an edge.
///
/// - Buffers: `frame`, one struct; `surface`, one struct or NULL, whose `resolve` and `source` are 0;
///   `options`, one struct or NULL; `mesh`, one pointer.
/// - Result: `*mesh`, identical for any number of threads; it has no triangles if no sample is inside.
/// - Errors: LEAFLESS_E_ARGUMENT if the depth is 20, which leaves no level for corners, if a field of
///   `surface` is not a member of its enumeration, or is set though it is not used, or if the frame is so far
///   from the origin that doubles cannot distinguish its corners; LEAFLESS_E_NOT_SAMPLED if the solid cannot
///   decide points; LEAFLESS_E_FRAME for a solid of leafless_solid_from_octree, which has samples of its own,
///   and for other solids that belong to another frame; LEAFLESS_E_MESH if there would be more than 2^32 - 1
///   vertices or triangles; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*mesh` with leafless_mesh_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid; set `max_bytes` if the depth or the solid is untrusted.
leafless_status leafless_solid_surface(const leafless_solid *solid, const leafless_frame *frame,
    const leafless_surface_options *surface, const leafless_options *options, leafless_mesh **mesh);

/// Extracts the surface of a volume by marching cubes. Its samples are the centres of voxels, which need not
/// be cubes. Its vertices lie where the values, interpolated between two voxels, leave the band. For samples
/// of a smooth function the vertices lie on the surface to second order in the spacing. Between bits, and
/// next to a sample that is infinite or not a number, they lie half-way.
///
/// Otherwise as leafless_octree_surface. Vertices at equal positions are merged; there more than two
/// triangles may meet at an edge. Time is linear in the samples, and in the surface.
///
/// - Buffers: `band`, one struct, or NULL, as for leafless_solid_from_volume; `options`, one struct or NULL
///   (its limits are ignored); `mesh`, one pointer.
/// - Result: `*mesh`, identical for any number of threads, at the position that the volume's file states.
/// - Errors: those of leafless_solid_from_volume; LEAFLESS_E_ARGUMENT if the volume is so far from the origin
///   that doubles cannot distinguish its voxels; LEAFLESS_E_MESH if there would be more than 2^32 - 1
///   vertices or triangles.
/// - Ownership: `volume` is unchanged; release `*mesh` with leafless_mesh_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any volume.
leafless_status leafless_volume_surface(const leafless_volume *volume, const leafless_interval *band,
    const leafless_options *options, leafless_mesh **mesh);

/// The kind of a surface.
LEAFLESS_ENUM(leafless_surface_kind, uint32_t) {
    /// A surface without numbers of its own: a sum of powers, a stretched torus.
    LEAFLESS_SURFACE_KIND_OTHER = 0,
    LEAFLESS_SURFACE_KIND_PLANE = 1,  ///< A plane: the points p with `direction` · p = `offset_model`.
    /// A ball: the points at the distance `radius_model` from `point_model`.
    LEAFLESS_SURFACE_KIND_BALL = 2,
    /// A cylinder: the points at the distance `radius_model` from the line through `point_model` along
    /// `direction`.
    LEAFLESS_SURFACE_KIND_CYLINDER = 3,
    /// A cone: the lines through `point_model` at the angle `half_angle_radians` to `direction`.
    LEAFLESS_SURFACE_KIND_CONE = 4,
    /// A torus: the points at the distance `minor_model` from the circle of radius `radius_model` around
    /// `point_model`, perpendicular to `direction`.
    LEAFLESS_SURFACE_KIND_TORUS = 5,
    LEAFLESS_SURFACE_KIND_QUADRIC = 6,  ///< Any other surface of degree two.
};

/// A surface in model space. Fields that the kind does not use are 0.
///
/// The numbers are those of the exact surface, rounded. A surface of degree two has the kind of a ball, a
/// cylinder or a cone if its coefficients match one to a relative 10^-9.
typedef struct leafless_boundary_surface {
    leafless_surface_kind kind;  ///< A leafless_surface_kind.
    uint32_t reserved;  ///< Reserved; 0.
    /// Ball and torus: the centre. Cylinder: the point of the axis that is nearest to the origin. Cone: the
    /// apex.
    double point_model[3];
    /// Plane: the normal, which points out of the half-space that it bounds. Cylinder, cone and torus: the
    /// axis. The length is 1.
    double direction[3];
    double offset_model;  ///< Plane: its distance from the origin, along the normal.
    double radius_model;  ///< Ball, cylinder, and circle of a torus: the radius.
    double minor_model;  ///< Torus: the radius of the tube.
    double half_angle_radians;  ///< Cone: the angle between axis and surface, between 0 and π/2.
    /// Quadric: the coefficients of x², y², z², xy, yz, zx, x, y, z and 1, as for leafless_solid_new_quadric.
    /// The largest magnitude is between 1/2 and 1.
    double coefficients[10];
} leafless_boundary_surface;

/// A connected part of a boundary on one surface.
typedef struct leafless_boundary_region {
    /// The index of its surface in leafless_boundary_surfaces; UINT32_MAX if the boundary is known only to a
    /// cell.
    uint32_t surface;
    uint32_t first_face;  ///< Index of its first face. The others follow.
    uint32_t face_count;  ///< Number of its faces.
    uint32_t triangle_count;  ///< Number of its triangles in the mesh.
    double area_model;  ///< The area of these triangles, in square model units.
    /// Whether the normal of the surface points into the solid. The normal of a plane is `direction`; that of
    /// a ball, a cylinder, a cone and a torus points away from the centre, axis or circle. So it is true for
    /// a bore, and false for a pin.
    bool is_turned;
} leafless_boundary_region;

/// Facts about the boundary of a solid.
typedef struct leafless_boundary_report {
    uint32_t struct_size;  ///< sizeof(leafless_boundary_report).
    /// Proven bound of the distance between the mesh and the boundary of the solid, in both directions, in
    /// model units; infinite if nothing is proven.
    double deviation_model;
    /// Pairs of triangles that intersect each other: 0 unless cells of the frame's depth do not separate
    /// surfaces.
    uint64_t intersecting_pairs;
    uint64_t cells;  ///< Cells that the boundary crosses.
    uint64_t splits;  ///< Cells that were split.
    uint64_t surfaces;  ///< Number of surfaces that the solid is made of.
    uint64_t regions;  ///< Number of regions.
    uint64_t faces;  ///< Number of faces.
} leafless_boundary_report;

/// Makes the boundary of a solid that provides its surfaces, such as solids of half-spaces, and octrees that
/// keep their surfaces. Plane faces are exact, with triangles only between their corners. Curved faces become
/// chords at a distance of about `tolerance_model` at most. Edges are sharp, and corners are exact up to
/// rounding. The solid must end inside the universe of the frame.
///
/// The mesh is closed, and exactly two triangles meet at each edge; where the solid touches itself, vertices
/// have equal positions. Cells are split until at most three surfaces in each have a simple arrangement.
/// Where more surfaces meet in a point, and where surfaces touch, cells are split to the depth of the frame,
/// which costs little: a depth of 12 to 16 is good for parts.
///
/// The surfaces prove a bound of the distance between mesh and boundary. Where it exceeds the tolerance,
/// cells are split, down to the depth of the frame.
///
/// It takes about 50 microseconds and 500 bytes a cell; threads share the proof.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `boundary`, one pointer.
/// - Result: `*boundary`.
/// - Errors: LEAFLESS_E_ARGUMENT if the solid is not known to end inside the universe, or does not consist of
///   surfaces only (a mesh and a host program's function do not), or if `tolerance_model` is not between
///   2^-256 and 2^256; LEAFLESS_E_MESH if there would be more than 2^32 - 1 vertices, triangles or corners;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `solid` is unchanged; release `*boundary` with leafless_boundary_free.
/// - Threads: any.
/// - Untrusted input: any solid; set `max_nodes` if the depth or the solid is untrusted.
leafless_status leafless_solid_boundary(const leafless_solid *solid, const leafless_frame *frame,
    double tolerance_model, const leafless_options *options, leafless_boundary **boundary);

/// Returns one more reference to a boundary.
///
/// - Buffers: `boundary`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `boundary`.
/// - Ownership: release each reference with leafless_boundary_free.
leafless_status leafless_boundary_ref(const leafless_boundary *boundary, leafless_boundary **reference);

/// Releases a reference to a boundary; the last release frees the boundary. References to its mesh stay
/// valid.
///
/// - Buffers: `boundary`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
void leafless_boundary_free(leafless_boundary *boundary);

/// Returns facts about a boundary. O(1).
///
/// - Buffers: `report`, one struct.
/// - Result: `*report`.
leafless_status leafless_boundary_describe(const leafless_boundary *boundary,
    leafless_boundary_report *report);

/// Returns the mesh of a boundary. O(1).
///
/// - Buffers: `mesh`, one pointer.
/// - Result: `*mesh`.
/// - Ownership: the mesh is shared, and `boundary` may be freed; release `*mesh` with leafless_mesh_free.
leafless_status leafless_boundary_mesh(const leafless_boundary *boundary, leafless_mesh **mesh);

/// Returns the surfaces that a solid is made of, with their kinds and numbers. Some of them may bound
/// nothing.
///
/// - Buffers: `surfaces`, room for `capacity` structs, or NULL to get only the count; `count`, one number.
/// - Result: `*count`; the surfaces.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small.
leafless_status leafless_boundary_surfaces(const leafless_boundary *boundary,
    leafless_boundary_surface *surfaces, uint64_t capacity, uint64_t *count);

/// Returns the regions of a boundary, in the order of their faces.
///
/// - Buffers: `regions`, room for `capacity` structs, or NULL to get only the count; `count`, one number.
/// - Result: `*count`; the regions.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small.
leafless_status leafless_boundary_regions(const leafless_boundary *boundary,
    leafless_boundary_region *regions, uint64_t capacity, uint64_t *count);

/// Returns the region of each triangle of the mesh of a boundary.
///
/// - Buffers: `regions`, room for `capacity` numbers, or NULL to get only the count; `count`, one number.
/// - Result: `*count`, the number of triangles; in `regions` the index of each triangle's region.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small.
leafless_status leafless_boundary_triangle_regions(const leafless_boundary *boundary, uint32_t *regions,
    uint64_t capacity, uint64_t *count);

/// Returns the faces of a boundary in place, without a copy, in the form for leafless_mesh_write_polygons and
/// leafless_mesh_from_polyhedron: vertices of type double, which are those of the mesh, and indices of 32
/// bits.
///
/// A plane region consists of triangles, too, if its loops touch each other along edges, as where the solid
/// touches itself, or if its corners lie off one plane by more than 10^-9 of the solid's extent. A shell
/// around a void belongs to the smallest solid that contains it.
///
/// - Buffers: `arrays`, one struct.
/// - Result: `*arrays`.
/// - Ownership: the arrays belong to the boundary and live as long as the reference `boundary`.
leafless_status leafless_boundary_peek_faces(const leafless_boundary *boundary,
    leafless_polyhedron_arrays *arrays);

/// A report of leafless_solid_contour.
typedef struct leafless_contour_report {
    uint32_t struct_size;  ///< sizeof(leafless_contour_report).
    /// Proven bound of the distance between the mesh and the boundary of the solid, in both directions, in
    /// model units; infinite if nothing is proven.
    double deviation_model;
    /// Pairs of triangles that intersect each other: 0 unless cells of the frame's depth do not separate
    /// sheets of the surface.
    uint64_t intersecting_pairs;
    uint64_t cells;  ///< Cells that the surface passes through.
    uint64_t splits;  ///< Cells that were split.
    uint64_t undecided;  ///< Points that the solid could not decide; they counted as outside.
} leafless_contour_report;

/// Makes a closed mesh of any solid, with few triangles where it is flat and small triangles where it is not:
/// of meshes, expressions with meshes in them, volumes, octrees, tri-dexel models, and functions of the host.
/// The solid must end inside the universe of the frame. (leafless_solid_boundary is sharper for solids that
/// provide their surfaces.)
///
/// Cells are split until the surface in each is one piece that a single vertex can represent: the vertex lies
/// where planes of the surface meet, so that edges and corners are sharp. The distance of the mesh from the
/// solid is then about `tolerance_model`, as far as cells of the frame's depth allow. For every solid the
/// mesh is closed, exactly two triangles meet at each edge, and the triangles around each vertex are one fan.
/// A solid that is thinner than a finest cell may vanish. Points that the solid cannot decide count as
/// outside.
///
/// It takes about 100 microseconds a cell for a mesh, and more for solids that answer no rays, in one thread.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL (`max_nodes` bounds the splits; when
///   `max_splits` is spent, cells are not split further); `report`, one struct or NULL; `mesh`, one pointer.
/// - Result: `*mesh`; `*report`.
/// - Errors: LEAFLESS_E_ARGUMENT if the solid is not known to end inside the universe, or `tolerance_model`
///   is not between 2^-256 and 2^256; LEAFLESS_E_MESH if there would be more than 2^32 - 1 vertices or
///   triangles; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*mesh` with leafless_mesh_free.
/// - Threads: any.
/// - Untrusted input: any solid; set `max_nodes` if the depth or the solid is untrusted.
leafless_status leafless_solid_contour(const leafless_solid *solid, const leafless_frame *frame,
    double tolerance_model, const leafless_options *options, leafless_contour_report *report,
    leafless_mesh **mesh);

/// A report of leafless_mesh_simplify.
typedef struct leafless_simplified {
    uint32_t struct_size;  ///< sizeof(leafless_simplified).
    /// Proven bound of the distance between the two meshes, in model units: no point of either mesh is
    /// further from the other mesh.
    double deviation_model;
    uint64_t removed;  ///< Triangles that were removed.
    /// Pairs of intersecting triangles of the result. All of them come from intersections of the input.
    uint64_t intersecting_pairs;
} leafless_simplified;

/// Returns the mesh with fewer triangles. No point of either mesh is further than `tolerance_model` from the
/// other mesh; this is proven in both directions.
///
/// Vertices are removed; no vertex is moved. Edges between triangles whose normals differ by more than 30
/// degrees stay edges, and so do edges between triangles with different attribute values. Vertices along such
/// an edge are removed as far as the tolerance allows; corners stay. A closed manifold mesh stays a closed
/// manifold, with as many bodies and holes. Vertices on open edges, and vertices on edges of more than two
/// triangles, stay. No new intersections of triangles arise.
///
/// O(n log n) time for n triangles if each vertex has few triangles: some 20 microseconds and some 300 bytes
/// a triangle. One thread removes vertices; all threads prove the bound.
///
/// - Buffers: `options`, one struct or NULL; `report`, one struct, or NULL if it is not wanted; `simple`, one
///   pointer.
/// - Result: `*simple`, with the attribute values of the remaining triangles, without the values of corners;
///   its stated deviation is that of `mesh` plus the bound proven here; `*report`. Both are identical for any
///   number of threads.
/// - Errors: LEAFLESS_E_ARGUMENT if `tolerance_model` is not between 2^-256 and 2^256; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` is unchanged; release `*simple` with leafless_mesh_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_simplify(const leafless_mesh *mesh, double tolerance_model,
    const leafless_options *options, leafless_simplified *report, leafless_mesh **simple);

/* ---- 27. Tri-dexel models ----------------------------------------------------------------------------- */

/// The axes that rays run along. The numbers may be added.
LEAFLESS_ENUM(leafless_axes, uint32_t) {
    LEAFLESS_AXES_X = 1,  ///< Along x.
    LEAFLESS_AXES_Y = 2,  ///< Along y.
    LEAFLESS_AXES_Z = 4,  ///< Along z.
    LEAFLESS_AXES_ALL = 7,  ///< Along all three.
};

/// The storage format of the ends of intervals.
LEAFLESS_ENUM(leafless_dexel_ends, uint32_t) {
    /// Start and length in units of 2^-31 edges of the universe, 8 bytes an interval. An end is off by at
    /// most one unit.
    LEAFLESS_DEXEL_ENDS_FIXED = 0,
    LEAFLESS_DEXEL_ENDS_DOUBLE = 1,  ///< Start and end as doubles, 16 bytes an interval.
};

/// The storage format of the unit normals at the ends of intervals, an octahedral code.
LEAFLESS_ENUM(leafless_dexel_normals, uint32_t) {
    LEAFLESS_DEXEL_NORMALS_NONE = 0,  ///< Normals are not stored.
    LEAFLESS_DEXEL_NORMALS_16 = 1,  ///< 16 bits a normal, 4 bytes an interval, within a degree.
    LEAFLESS_DEXEL_NORMALS_32 = 2,  ///< 32 bits a normal, 8 bytes an interval, within 0.005 degrees.
};

/// The format of a tri-dexel model: which data it stores. NULL means the defaults. Zero is the default of
/// every field but the first.
typedef struct leafless_tridexel_format {
    uint32_t struct_size;  ///< sizeof(leafless_tridexel_format).
    /// The axes that rays run along, a sum of leafless_axes; 0 means the axes of the operand if there is one,
    /// else LEAFLESS_AXES_ALL.
    uint32_t directions;
    uint32_t ends;  ///< A leafless_dexel_ends.
    uint32_t normals;  ///< A leafless_dexel_normals.
    uint32_t has_surfaces;  ///< 1 to store the source's surface of each end, 8 bytes an interval; else 0.
    uint32_t has_materials;  ///< 1 to store the material of each interval, 4 bytes an interval; else 0.
} leafless_tridexel_format;

/// Basic facts about a tri-dexel model.
typedef struct leafless_tridexel_info {
    uint32_t struct_size;  ///< sizeof(leafless_tridexel_info).
    leafless_frame frame;  ///< The lattice: rays run through the centres of its finest cells.
    uint32_t directions;  ///< The axes that rays run along, a sum of leafless_axes.
    leafless_dexel_ends ends;  ///< The storage format of the ends of intervals.
    leafless_dexel_normals normals;  ///< The storage format of unit normals.
    uint32_t has_surfaces;  ///< 1 if the surfaces of the ends are stored, else 0.
    uint32_t has_materials;  ///< 1 if the materials of intervals are stored, else 0.
    uint32_t bytes_per_interval;  ///< Bytes of an interval.
    uint64_t interval_count;  ///< Number of intervals in all directions.
    uint64_t bytes;  ///< Bytes of the arrays.
} leafless_tridexel_info;

/// Makes the tri-dexel model of a solid on the lattice of a frame. O(rays + crossings). The result is
/// identical, bit for bit, for any number of threads.
///
/// Under LEAFLESS_RULE_SAMPLED the intervals are those of the solid on each ray. The centres of cells next to
/// an end lie on the same side of it as in the solid; apart from that, an end is off by at most 2^-31 of the
/// universe's edge, or 2^-36 with LEAFLESS_DEXEL_ENDS_DOUBLE. This holds for closed meshes, for half-spaces
/// and expressions of them, and for octrees. Solids of other kinds, and open meshes around their holes, are
/// sampled: an end between centres on different sides is located by cells to a depth of 20, and a wall
/// between two neighbouring centres is missed. Under LEAFLESS_RULE_INNER the intervals are those of the
/// solid's FULL cells, under LEAFLESS_RULE_OUTER those of all cells that are not EMPTY.
///
/// - Buffers: `frame`, one struct; `format`, one struct or NULL; `options`, one struct or NULL; `tridexel`,
///   one pointer. `rule` is a leafless_rule.
/// - Result: `*tridexel`.
/// - Errors: LEAFLESS_E_ARGUMENT also for LEAFLESS_RULE_CERTIFIED, because an interval cannot be undecided,
///   and if a field of `format` is wrong; LEAFLESS_E_FRAME if the solid belongs to another frame;
///   LEAFLESS_E_NOT_SAMPLED if `rule` is LEAFLESS_RULE_SAMPLED and the solid cannot decide points;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT, also for 2^32 rays or intervals along one
///   axis; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the model keeps no reference to the solid; release `*tridexel` with leafless_tridexel_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid; set `max_bytes` if the depth or the solid is untrusted.
leafless_status leafless_tridexel_build(const leafless_solid *solid, const leafless_frame *frame,
    leafless_rule rule, const leafless_tridexel_format *format, const leafless_options *options,
    leafless_tridexel **tridexel);

/// Returns one more reference to a tri-dexel model.
///
/// - Buffers: `tridexel`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `tridexel`.
/// - Ownership: release each reference with leafless_tridexel_free.
leafless_status leafless_tridexel_ref(const leafless_tridexel *tridexel, leafless_tridexel **reference);

/// Releases a reference to a tri-dexel model. The last release frees the model. The mapping of its file ends
/// too, unless a model with other metadata still shares its arrays.
///
/// - Buffers: `tridexel`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
void leafless_tridexel_free(leafless_tridexel *tridexel);

/// Returns basic facts about a tri-dexel model. O(1).
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
/// - Untrusted input: any model.
leafless_status leafless_tridexel_describe(const leafless_tridexel *tridexel, leafless_tridexel_info *info);

/// Checks that a tri-dexel model is well-formed: intervals are in order, disjoint and inside the universe.
/// O(n). Whether the directions agree is not checked. Models that the library makes, opens or maps verified
/// are well-formed.
///
/// - Result: LEAFLESS_OK if the check passes.
/// - Errors: LEAFLESS_E_DAMAGED, with the first damage in the message.
/// - Untrusted input: any model.
leafless_status leafless_tridexel_check(const leafless_tridexel *tridexel);

/// Returns whether two tri-dexel models store the same data, bit for bit, on the same frame. Metadata is not
/// compared. O(n).
///
/// - Buffers: `equal`, one truth value.
/// - Result: `*equal`.
/// - Untrusted input: any models.
leafless_status leafless_tridexel_equal(const leafless_tridexel *a, const leafless_tridexel *b, bool *equal);

/// Returns the tri-dexel model with one more fact in its metadata, or with a new value of a fact; the arrays
/// are shared. Names in use: "name", "units".
///
/// - Buffers: `key` and `value`, `key_length` and `value_length` bytes of UTF-8; `named`, one pointer.
/// - Result: `*named`.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_ARGUMENT if all facts would take more than 1 MiB in a file (each
///   takes 8 bytes and its two texts); LEAFLESS_E_NO_MEMORY.
/// - Ownership: the texts are copied. `*named` shares the arrays of `tridexel`, which may be freed. Bytes
///   that `tridexel` views must outlive `*named` too, and a file that it maps must stay unchanged as long.
///   Release `*named` with leafless_tridexel_free.
/// - Untrusted input: any texts.
leafless_status leafless_tridexel_with_metadata(const leafless_tridexel *tridexel, const char *key,
    size_t key_length, const char *value, size_t value_length, leafless_tridexel **named);

/// Returns the tri-dexel model with one fact less in its metadata, or without metadata; the arrays are
/// shared.
///
/// - Buffers: `key`, `key_length` bytes of UTF-8, or NULL for all facts; `unnamed`, one pointer.
/// - Result: `*unnamed`; it is not an error if there is no such fact.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_tridexel_with_metadata.
/// - Untrusted input: any texts.
leafless_status leafless_tridexel_without_metadata(const leafless_tridexel *tridexel, const char *key,
    size_t key_length, leafless_tridexel **unnamed);

/// Returns the value of a fact in a tri-dexel model's metadata, such as "name".
///
/// - Buffers: `key`, `key_length` bytes of UTF-8; `value` and `value_length`, one each.
/// - Result: `*value`, not NUL-terminated; NULL if there is no such fact. `*value_length`, in bytes.
/// - Errors: LEAFLESS_E_UTF8.
/// - Ownership: the text belongs to the model and lives as long as the reference `tridexel`.
/// - Untrusted input: any model.
leafless_status leafless_tridexel_peek_metadata(const leafless_tridexel *tridexel, const char *key,
    size_t key_length, const char **value, size_t *value_length);

/// Returns a fact of a tri-dexel model's metadata by its index. Facts are sorted by key.
///
/// - Buffers: `count`, one number; `key`, `key_length`, `value`, `value_length`, one each, all four NULL to
///   get only the count.
/// - Result: `*count`, the number of all facts; key and value, not NUL-terminated, with their lengths in
///   bytes.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no fact `index`, unless only the count is requested.
/// - Ownership: the texts belong to the model and live as long as the reference `tridexel`.
/// - Untrusted input: any model.
leafless_status leafless_tridexel_peek_metadata_at(const leafless_tridexel *tridexel, uint64_t index,
    uint64_t *count, const char **key, size_t *key_length, const char **value, size_t *value_length);

/// The intervals of rays along one axis, as written by leafless_tridexel_copy.
typedef struct leafless_tridexel_arrays {
    uint32_t axis;  ///< The axis that the rays run along: 0 for x, 1 for y, 2 for z.
    uint32_t reserved;  ///< Reserved; must be 0.
    uint32_t first[2];  ///< The indices of the first ray's cells on the other two axes in the order x, y, z.
    uint32_t end[2];  ///< The first indices beyond the last ray. Rays outside the rectangle are empty.
    /// Offsets, one more than there are rays, ascending: the intervals of ray i are those from `offsets[i]`
    /// up to, but not including, `offsets[i + 1]`. The ray at steps (u, v) from the first has the index i = v
    /// · width + u.
    const uint64_t *offsets;
    uint64_t interval_count;  ///< Number of intervals, which is the last offset.
    /// Two coordinates for each interval, its start and its end. NULL if `ends_cells` gives them.
    const double *ends_model;
    /// Six numbers for each interval: the outward normals at its start and at its end, of any length; three
    /// zeros for an unknown normal. NULL if no normal is known.
    const double *normals;
    /// Two numbers for each interval: the surfaces of its start and its end; UINT32_MAX for an unknown
    /// surface. NULL if no surface is known.
    const uint32_t *surfaces;
    /// A number for each interval, its material; 0 if none is given. NULL if no material is given.
    const uint32_t *materials;
    /// Two numbers for each interval: its start and its end in finest cells from the universe's lower face,
    /// as written by leafless_tridexel_copy_cells; the centre of cell k lies at k + 1/2. This number defines
    /// an end if `ends_model` is NULL, or if the coordinate in `ends_model` is the one that
    /// leafless_tridexel_copy would write for it; otherwise the coordinate defines the end. NULL if only
    /// coordinates are given.
    const double *ends_cells;
} leafless_tridexel_arrays;

/// Makes a tri-dexel model from intervals of another program or a machine. O(rays of the universe +
/// intervals).
///
/// The intervals of a ray ascend and are disjoint. Parts beyond the universe are cut off; data that `format`
/// does not store are left out. Ends are rounded to `format`, and keep their side of every cell centre, which
/// is the real number origin + (k + 1/2) edge / 2^depth; the side is decided exactly. Intervals that are
/// empty after rounding are left out; intervals that touch are joined, unless both have materials and these
/// differ. The directions are not compared with each other. The complete output of leafless_tridexel_copy and
/// leafless_tridexel_copy_cells for a model makes an equal model on the same frame.
///
/// - Buffers: `frame`, one struct; `format`, one struct or NULL, whose `directions` are 0 or the axes of
///   `rays`; `rays`, `count` structs, 1 to 3, each for another axis; `options`, one struct or NULL;
///   `tridexel`, one pointer.
/// - Result: `*tridexel`.
/// - Errors: LEAFLESS_E_ARGUMENT also if offsets do not ascend, if an end of an interval is not a number or
///   not greater than its start, if an end in cells does not lie in the universe, or if an interval begins
///   before the end of the previous interval; LEAFLESS_E_LIMIT for 2^32 rays or intervals along one axis,
///   which is a depth of 16; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the arrays are copied and may be freed; release `*tridexel` with leafless_tridexel_free.
/// - Untrusted input: any numbers.
leafless_status leafless_tridexel_new(const leafless_frame *frame, const leafless_tridexel_format *format,
    const leafless_tridexel_arrays *rays, uint64_t count, const leafless_options *options,
    leafless_tridexel **tridexel);

/// One end of a leafless_dexel.
typedef struct leafless_dexel_end {
    /// The coordinate along the ray. It is on the stored side of every cell centre, as far as there is a
    /// double between two centres.
    double at_model;
    /// The same coordinate in finest cells from the universe's lower face, exactly as stored; the centre of
    /// cell k lies at k + 1/2.
    double at_cells;
    double normal[3];  ///< The outward unit normal of the surface there; three zeros if it is not known.
    /// The source's surface at this end: the triangle of a mesh, or the half-space in the order of the
    /// expanded expression. UINT32_MAX if it is not known.
    uint32_t surface;
} leafless_dexel_end;

/// An interval of a ray that lies inside the solid.
typedef struct leafless_dexel {
    leafless_dexel_end start;  ///< The start of the interval.
    leafless_dexel_end end;  ///< The end of the interval, greater than the start.
    uint32_t material;  ///< The material; 0 if none was given.
} leafless_dexel;

/// Statistics of the rays along one axis.
typedef struct leafless_dexel_statistics {
    uint32_t struct_size;  ///< sizeof(leafless_dexel_statistics).
    uint64_t rays;  ///< Number of rays that cross the solid.
    uint64_t intervals;  ///< Number of intervals.
    uint64_t bytes;  ///< Bytes of the arrays.
    /// Sum of the lengths of all intervals times the area of a cell's face: an estimate of the volume in
    /// cubic model units, not a bound.
    double volume_model;
    double min_model[3];  ///< The least coordinates of all intervals; INFINITY if there are none.
    double max_model[3];  ///< The greatest coordinates of all intervals; -INFINITY if there are none.
} leafless_dexel_statistics;

/// Returns statistics of the rays along an axis. O(n).
///
/// - Buffers: `statistics`, one struct. `axis` is 0 for x, 1 for y, 2 for z.
/// - Result: `*statistics`.
/// - Errors: LEAFLESS_E_ARGUMENT if the model has no rays along `axis`.
/// - Untrusted input: any model, any number.
leafless_status leafless_tridexel_statistics(const leafless_tridexel *tridexel, uint32_t axis,
    leafless_dexel_statistics *statistics);

/// Returns whether the centre of a finest cell lies inside. O(log intervals of a ray).
///
/// - Buffers: `cell`, 3 numbers; `inside`, one truth value.
/// - Result: `*inside`; false if a coordinate is not below 2^depth. Where the directions disagree, as can
///   happen with arrays of other programs, the highest axis decides.
/// - Untrusted input: any model, any numbers.
leafless_status leafless_tridexel_contains_cell(const leafless_tridexel *tridexel, const uint32_t cell[3],
    bool *inside);

/// Returns the window: the smallest rectangle of rays along an axis that contains all rays that cross the
/// solid.
///
/// - Buffers: `first` and `end`, 2 numbers each: the indices of the first ray's cells on the other two axes
///   in the order x, y, z, and the first indices beyond the last ray. `axis` is 0 for x, 1 for y, 2 for z.
/// - Result: `first` and `end`; equal to each other if no ray crosses the solid.
/// - Errors: LEAFLESS_E_ARGUMENT if the model has no rays along `axis`.
/// - Untrusted input: any model, any number.
leafless_status leafless_tridexel_window(const leafless_tridexel *tridexel, uint32_t axis, uint32_t first[2],
    uint32_t end[2]);

/// Returns the intervals of one ray, in ascending order.
///
/// - Buffers: `ray`, 2 numbers, the indices of the ray's cells on the other two axes in the order x, y, z;
///   `dexels`, room for `capacity` structs, or NULL to get only the count; `count`, one number. `axis` is 0
///   for x, 1 for y, 2 for z.
/// - Result: `*count`; the intervals. A ray outside the universe has none.
/// - Errors: LEAFLESS_E_ARGUMENT if the model has no rays along `axis`; LEAFLESS_E_BUFFER if the capacity is
///   too small.
/// - Untrusted input: any model, any numbers.
leafless_status leafless_tridexel_ray(const leafless_tridexel *tridexel, uint32_t axis, const uint32_t ray[2],
    leafless_dexel *dexels, uint64_t capacity, uint64_t *count);

/// Copies the intervals of many rays along one axis, in compressed rows: the intervals of ray i are the
/// elements from `offsets[i]` up to, but not including, `offsets[i + 1]` of each array. In a rectangle that
/// is `width` rays wide along the first of the other two axes, the ray at steps (u, v) from the first has the
/// index i = v · width + u. O(rays + intervals).
///
/// - Buffers: `first` and `end`, 2 numbers each, or both NULL for the rectangle of leafless_tridexel_window:
///   the indices of the first ray's cells on the other two axes in the order x, y, z, and the first indices
///   beyond the last ray. `offsets`, room for `offset_capacity` numbers; for each of `interval_capacity`
///   intervals, `ends_model` has room for 2 numbers, `normals` for 6, `surfaces` for 2, `materials` for 1.
///   Each of the five may be NULL if it is not wanted. `offset_count` and `interval_count`, one number each.
///   `axis` is 0 for x, 1 for y, 2 for z.
/// - Result: `offsets`, one more than there are rays. For each interval: the coordinates of its start and its
///   end, on the stored sides of cell centres, as far as there are doubles between two centres; the outward
///   unit normals there, three zeros if unknown; the surfaces there, UINT32_MAX if unknown; the material, 0
///   if none was given. The counts of offsets and intervals.
/// - Errors: LEAFLESS_E_ARGUMENT if the model has no rays along `axis`, `first` lies beyond `end`, or the
///   rays reach beyond the universe; LEAFLESS_E_BUFFER if a capacity is too small: nothing is written then.
/// - Untrusted input: any model, any numbers.
leafless_status leafless_tridexel_copy(const leafless_tridexel *tridexel, uint32_t axis,
    const uint32_t first[2], const uint32_t end[2], uint64_t *offsets, uint64_t offset_capacity,
    uint64_t *offset_count, double *ends_model, double *normals, uint32_t *surfaces, uint32_t *materials,
    uint64_t interval_capacity, uint64_t *interval_count);

/// Copies the starts and ends of the intervals of many rays along one axis, exactly as stored: in finest
/// cells from the universe's lower face; the centre of cell k lies at k + 1/2. The intervals are those of
/// leafless_tridexel_copy, in the same order. O(rays + intervals).
///
/// - Buffers: `first` and `end`, 2 numbers each, or both NULL, as for leafless_tridexel_copy; `ends_cells`,
///   room for 2 numbers for each of `interval_capacity` intervals, or NULL to get only the count;
///   `interval_count`, one number. `axis` is 0 for x, 1 for y, 2 for z.
/// - Result: `ends_cells`, 0 to 2^depth; `*interval_count`.
/// - Errors: as leafless_tridexel_copy.
/// - Untrusted input: any model, any numbers.
leafless_status leafless_tridexel_copy_cells(const leafless_tridexel *tridexel, uint32_t axis,
    const uint32_t first[2], const uint32_t end[2], double *ends_cells, uint64_t interval_capacity,
    uint64_t *interval_count);

/// Combines tri-dexel models, at least one, by a set operation. The result is exact: all laws of sets hold.
/// It takes O(rays + intervals · log models), and is identical, bit for bit, for any number of threads. The
/// result stores the data that any operand stores; ends are doubles if those of one operand are. An end keeps
/// its surface and its normal, which is reversed where a subtraction exposes the other side. Where several
/// operands overlap, the material of the first one counts. Operands are combined in pairs: the limits of
/// `options` apply to each of these steps.
///
/// - Buffers: `tridexels`, `count` handles; `options`, one struct or NULL; `result`, one pointer. `operation`
///   is a leafless_operation.
/// - Result: `*result`, with the facts "name" and "units" if all operands have the same value of them, and no
///   other metadata.
/// - Errors: LEAFLESS_E_FRAME if the frames differ; LEAFLESS_E_NULL, also of an element; LEAFLESS_E_ARGUMENT,
///   also if `count` is 0 or the operands have rays along different axes; LEAFLESS_E_DAMAGED if an operand
///   was mapped unverified and is damaged; LEAFLESS_E_LIMIT, also for 2^32 intervals along one axis;
///   LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the operands are unchanged; release `*result` with leafless_tridexel_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any models.
leafless_status leafless_tridexel_combine(leafless_operation operation,
    const leafless_tridexel *const *tridexels, uint64_t count, const leafless_options *options,
    leafless_tridexel **result);

/// Returns the complement of a tri-dexel model inside its universe. O(rays of the universe + intervals).
///
/// - Buffers: `options`, one struct or NULL; `result`, one pointer.
/// - Result: as leafless_tridexel_combine.
/// - Errors: LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT, also for 2^32 rays along one axis; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_tridexel_combine.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any model; set `max_bytes` if its depth is untrusted.
leafless_status leafless_tridexel_complement(const leafless_tridexel *tridexel,
    const leafless_options *options, leafless_tridexel **result);

/// Returns the same tri-dexel model in another storage format. Data that `tridexel` does not store are
/// unknown in the result: no surface, no normal, material 0. Doubles become fixed-point numbers and vice
/// versa; an interval that becomes empty by rounding is left out.
///
/// - Buffers: `format`, one struct or NULL; `options`, one struct or NULL; `result`, one pointer.
/// - Result: `*result`, with the metadata of `tridexel`.
/// - Errors: LEAFLESS_E_ARGUMENT if a field of `format` is wrong, or `directions` are neither 0 nor those of
///   `tridexel`; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `tridexel` is unchanged; release `*result` with leafless_tridexel_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any model.
leafless_status leafless_tridexel_with_format(const leafless_tridexel *tridexel,
    const leafless_tridexel_format *format, const leafless_options *options, leafless_tridexel **result);

/// Returns the same tri-dexel model with one material for all intervals.
///
/// - Buffers: `options`, one struct or NULL; `result`, one pointer. `material` is any number.
/// - Result: `*result`, which stores materials, with the metadata of `tridexel`.
/// - Errors: LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `tridexel` is unchanged; release `*result` with leafless_tridexel_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any model, any number.
leafless_status leafless_tridexel_with_material(const leafless_tridexel *tridexel, uint32_t material,
    const leafless_options *options, leafless_tridexel **result);

/// A report of a change of an editor.
///
/// Volumes are sums of lengths along the rays of one axis times the area of a cell's face. So they are
/// estimates, not bounds, and differ between axes by the parts between neighbouring rays.
typedef struct leafless_dexel_change {
    uint32_t struct_size;  ///< sizeof(leafless_dexel_change).
    uint64_t rays;  ///< Number of rays, in all directions, whose intervals changed their start or end.
    /// The volume that the rays along x, y and z lost, in cubic model units; 0 for an axis without rays.
    double removed_model[3];
    /// The volume that the rays along x, y and z gained, in cubic model units; 0 for an axis without rays.
    double added_model[3];
    /// First cell of the box of finest cells that the changed parts of rays pass through.
    uint32_t min_cell[3];
    /// The first cell beyond that box on each axis; both corners are zero if no ray changed.
    uint32_t max_cell[3];
} leafless_dexel_change;

/// Makes an editor: a copy of a tri-dexel model that can be changed. O(rays of the universe + intervals).
///
/// - Buffers: `editor`, one pointer.
/// - Result: `*editor`, with the storage format of `tridexel`.
/// - Errors: LEAFLESS_E_DAMAGED if the model was mapped unverified and is damaged; LEAFLESS_E_LIMIT for 2^32
///   rays along one axis, which is a depth of 16; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the library keeps no reference to `tridexel`; release `*editor` with
///   leafless_tridexel_editor_free.
/// - Untrusted input: any model; memory is needed for each ray of its universe.
leafless_status leafless_tridexel_editor_new(const leafless_tridexel *tridexel,
    leafless_tridexel_editor **editor);

/// Releases an editor. Tri-dexel models that were frozen from it stay.
///
/// - Buffers: `editor`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
void leafless_tridexel_editor_free(leafless_tridexel_editor *editor);

/// Returns basic facts about an editor. O(rays of the universe).
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`; `bytes` is the memory of the editor.
/// - Errors: LEAFLESS_E_BUSY.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the editor.
leafless_status leafless_tridexel_editor_describe(const leafless_tridexel_editor *editor,
    leafless_tridexel_info *info);

/// Combines the editor with a tri-dexel model in place by a set operation: LEAFLESS_OPERATION_DIFFERENCE
/// subtracts the model. O(rays of the model's window + intervals there); for LEAFLESS_OPERATION_INTERSECTION
/// O(rays of the universe). Data of the model that the editor does not store are left out.
///
/// - Buffers: `options`, one struct or NULL; `change`, one struct or NULL. `operation` is a
///   leafless_operation.
/// - Result: the editor is changed; `*change`, what was removed and added.
/// - Errors: LEAFLESS_E_FRAME if the frames differ; LEAFLESS_E_ARGUMENT also if the model has rays along
///   other axes; LEAFLESS_E_DAMAGED if the model was mapped unverified and is damaged; LEAFLESS_E_LIMIT for
///   2^32 intervals along one axis; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_BUSY. After
///   LEAFLESS_E_LIMIT, LEAFLESS_E_CANCELLED and LEAFLESS_E_NO_MEMORY some rays may be changed and others not;
///   the same call can be made again, except for LEAFLESS_OPERATION_XOR.
/// - Ownership: the library keeps no reference to `tridexel`.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the editor; works in the calling thread.
/// - Untrusted input: any model.
leafless_status leafless_tridexel_editor_combine(leafless_tridexel_editor *editor,
    leafless_operation operation, const leafless_tridexel *tridexel, const leafless_options *options,
    leafless_dexel_change *change);

/// Like leafless_tridexel_editor_combine, with a solid: LEAFLESS_OPERATION_DIFFERENCE is one step of a tool.
/// The solid's intervals are those of leafless_tridexel_build under LEAFLESS_RULE_SAMPLED, in the directions
/// and the storage format of the editor. Only rays through the solid's bounding box are visited.
///
/// - Buffers: `options`, one struct or NULL; `change`, one struct or NULL. `operation` is a
///   leafless_operation.
/// - Result: the editor is changed; `*change`, what was removed and added.
/// - Errors: those of leafless_tridexel_build, after which nothing is changed; those of
///   leafless_tridexel_editor_combine.
/// - Ownership: the library keeps no reference to the solid.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the editor; runs on as many threads as `options`
///   says.
/// - Untrusted input: any solid.
leafless_status leafless_tridexel_editor_combine_solid(leafless_tridexel_editor *editor,
    leafless_operation operation, const leafless_solid *solid, const leafless_options *options,
    leafless_dexel_change *change);

/// Returns the current tri-dexel model. O(rays of the universe + intervals). The editor can be changed
/// further.
///
/// - Buffers: `options`, one struct or NULL; `tridexel`, one pointer.
/// - Result: `*tridexel`, without metadata.
/// - Errors: LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_BUSY.
/// - Ownership: the editor is unchanged; release `*tridexel` with leafless_tridexel_free.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the editor; works in the calling thread.
leafless_status leafless_tridexel_editor_freeze(const leafless_tridexel_editor *editor,
    const leafless_options *options, leafless_tridexel **tridexel);

/// The method that extracts the surface of a tri-dexel model.
LEAFLESS_ENUM(leafless_dexel_surface_method, uint32_t) {
    /// Marching cubes: a vertex where a ray crosses the surface between two neighbouring centres of cells.
    /// Edges and corners of the solid are cut off by up to one cell.
    LEAFLESS_DEXEL_SURFACE_METHOD_MARCHING_CUBES = 0,
    /// Dual contouring: a vertex for each sheet of the surface in a cube between eight centres, at the best
    /// fit of the planes at its crossings. Edges and corners of the solid are kept if the model stores
    /// normals.
    LEAFLESS_DEXEL_SURFACE_METHOD_DUAL_CONTOURING = 1,
};

/// A report of how exactly a surface of a tri-dexel model follows its rays.
typedef struct leafless_dexel_surface_report {
    uint32_t struct_size;  ///< sizeof(leafless_dexel_surface_report).
    /// Edges between two neighbouring cell centres of which one lies inside: places where a ray crosses the
    /// surface.
    uint64_t crossings;
    /// Crossings on edges where the ray crosses the surface more than once: details thinner than a cell are
    /// lost there.
    uint64_t several;
    /// Crossings that were put in the middle of their edges, because the model has no rays along these edges.
    uint64_t without_rays;
    /// Crossings that were put in the middle of their edges, because the directions of the model disagree
    /// there.
    uint64_t disagreeing;
    uint64_t without_normals;  ///< Crossings without a known normal. (Only for dual contouring.)
    /// Vertices with no normal at any of their crossings, placed at the mean of the crossings. (Only for dual
    /// contouring.)
    uint64_t means;
    /// Vertices that were kept inside their cells though they would fit their planes better outside. (Only
    /// for dual contouring.)
    uint64_t clamped;
    /// Bodies that are missing in the mesh: sets of inside cell centres, connected along axes, whose
    /// crossings have no triangle, because the surface is nearer to the centres than doubles can resolve.
    uint64_t vanished;
    /// Intervals in all directions that contain no cell centre, where touching intervals count as one:
    /// details thinner than the lattice that are missing in the mesh.
    uint64_t without_centres;
} leafless_dexel_surface_report;

/// A row of voxels along y with the same kind and material.
typedef struct leafless_long_voxel {
    /// Indices of the first voxel. The voxel (x, y, z) lies between the centres of the cells x - 1 and x, and
    /// likewise on the other axes: each index is from 0 to the number of cells of an axis, inclusive.
    uint32_t first[3];
    uint32_t length;  ///< Number of voxels.
    uint32_t material;  ///< The material; 0 if none was given.
    uint8_t colour[4];  ///< The material's colour: red, green, blue and opacity, 0 to 255.
    leafless_voxel_kind kind;  ///< LEAFLESS_VOXEL_KIND_INSIDE or LEAFLESS_VOXEL_KIND_BOUNDARY.
} leafless_long_voxel;

/// Extracts the surface of a tri-dexel model: a closed mesh. Samples are the centres of cells; space outside
/// the universe counts as outside.
///
/// Triangles turn counter-clockwise as seen from outside. Every edge belongs to exactly two triangles, except
/// where vertices coincide: these are merged, and triangles without area are dropped. Where no ray gives the
/// crossing, because the model has no rays along an axis or its directions disagree, the crossing lies
/// half-way between the two centres; the report counts such places.
///
/// O(rays + intervals + octree + mesh), with the octree of leafless_octree_from_tridexel.
///
/// - Buffers: `options`, one struct or NULL; `report`, one struct, or NULL if it is not wanted; `mesh`, one
///   pointer. `method` is a leafless_dexel_surface_method.
/// - Result: `*mesh`, identical for any number of threads; it has no triangles if no centre lies inside, or
///   if all bodies vanish. `*report`.
/// - Errors: LEAFLESS_E_ARGUMENT also if the frame is so far from the origin that doubles cannot distinguish
///   its cells; LEAFLESS_E_MESH if there would be more than 2^32 - 1 vertices or triangles;
///   LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `tridexel` is unchanged; release `*mesh` with leafless_mesh_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any model; a damaged model is refused (LEAFLESS_E_DAMAGED).
leafless_status leafless_tridexel_surface(const leafless_tridexel *tridexel,
    leafless_dexel_surface_method method, const leafless_options *options,
    leafless_dexel_surface_report *report, leafless_mesh **mesh);

/// Makes the octree of a tri-dexel model by the centres of cells: a finest cell is FULL if its centre lies
/// inside, else EMPTY. The octree proves nothing.
///
/// - Buffers: `options`, one struct or NULL; `octree`, one pointer.
/// - Result: `*octree`, with the model's facts "name" and "units" and no others; if the model stores
///   materials, with a channel "material" of type U32, the material's number at the centre of each cell;
///   identical for any number of threads.
/// - Errors: LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `tridexel` is unchanged; release `*octree` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any model; a damaged model is refused (LEAFLESS_E_DAMAGED); set `max_bytes` if its
///   depth is untrusted.
leafless_status leafless_octree_from_tridexel(const leafless_tridexel *tridexel,
    const leafless_options *options, leafless_octree **octree);

/// Makes the octree of a tri-dexel model by the ends of its intervals: a finest cell is FULL if all rays
/// through it are entirely inside, EMPTY if all are entirely outside, and PARTIAL if an end lies in the cell
/// or the directions disagree.
///
/// A decided cell agrees with every ray through it. Details thinner than a cell are undecided where a ray
/// meets them, and not lost. Nothing is known between the rays: the cells prove nothing about the solid that
/// the rays came from, and the volumes of FULL and PARTIAL cells are not proven bounds.
///
/// - Buffers: `options`, one struct or NULL; `octree`, one pointer.
/// - Result: `*octree`, with facts and a channel as from leafless_octree_from_tridexel.
/// - Errors: LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `tridexel` is unchanged; release `*octree` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any model; a damaged model is refused (LEAFLESS_E_DAMAGED); set `max_bytes` if its
///   depth is untrusted.
leafless_status leafless_octree_from_tridexel_ends(const leafless_tridexel *tridexel,
    const leafless_options *options, leafless_octree **octree);

/// Makes a solid from a tri-dexel model, for any frame: the inside of its surface by marching cubes.
///
/// That surface is near the surface that the model was made from, not on it. So octrees of the solid prove
/// nothing, and its measures are not bounds. With `is_truth` the surface counts as the truth, and both are as
/// for any mesh.
///
/// - Buffers: `options`, one struct or NULL; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: as leafless_tridexel_surface, and LEAFLESS_E_MESH if no centre of a cell lies inside.
/// - Ownership: the library keeps no reference to `tridexel`; release `*solid` with leafless_solid_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any model; a damaged model is refused (LEAFLESS_E_DAMAGED).
leafless_status leafless_solid_from_tridexel(const leafless_tridexel *tridexel, bool is_truth,
    const leafless_options *options, leafless_solid **solid);

/// Lists the voxels of a tri-dexel model. The corners of a voxel are cell centres: it is inside if all of its
/// eight corners are inside, outside if none is, and otherwise on the boundary. Inside and boundary voxels
/// are merged along y where kind and material are the same. A voxel has the material of its first inside
/// corner, with x varying fastest and z slowest, and the colour in `colours` at the index of the material's
/// number; materials beyond are grey (128, 128, 128, 255). Call it once for the count, and then with a
/// buffer.
///
/// O(rays of the window + blocks + rows), for blocks of 64 x 64 x 64 cells in which centres lie inside.
///
/// - Buffers: `options`, one struct or NULL; `colours`, `colour_count` colours of four bytes (red, green,
///   blue, opacity), or NULL for none; `voxels`, room for `capacity` structs, or NULL to get only the count;
///   `count`, one number.
/// - Result: `*count`; the rows of voxels by z, then by x, then by y.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any model; a damaged model is refused (LEAFLESS_E_DAMAGED).
leafless_status leafless_tridexel_voxels(const leafless_tridexel *tridexel, const leafless_options *options,
    const uint8_t *colours, uint64_t colour_count, leafless_long_voxel *voxels, uint64_t capacity,
    uint64_t *count);

/* ---- 28. Files of octrees and tri-dexel models -------------------------------------------------------- */

/// Major version of the file format that this library writes, and the only one that it reads.
#define LEAFLESS_FORMAT_MAJOR 0

/// Minor version of the file format that this library writes; it also reads newer minor versions.
#define LEAFLESS_FORMAT_MINOR 4

/// Facts about a tri-dexel model from the header and the section table of its file.
typedef struct leafless_file_tridexel_info {
    /// The axes that rays run along, a sum of leafless_axes; 0 if the file holds an octree.
    uint32_t directions;
    leafless_dexel_ends ends;  ///< The storage format of the ends of intervals.
    leafless_dexel_normals normals;  ///< The storage format of unit normals.
    uint32_t has_surfaces;  ///< 1 if the surfaces of the ends are stored, else 0.
    uint32_t has_materials;  ///< 1 if the materials of intervals are stored, else 0.
    uint32_t reserved;  ///< Reserved; 0.
    uint64_t rays[3];  ///< Rays in the window along each axis, including empty rays.
    uint64_t intervals[3];  ///< Intervals along each axis.
} leafless_file_tridexel_info;

/// Facts from the header and the section table of a file.
typedef struct leafless_file_info {
    uint32_t struct_size;  ///< sizeof(leafless_file_info).
    uint32_t major;  ///< Major version of the format.
    uint32_t minor;  ///< Minor version of the format.
    leafless_frame frame;  ///< The frame of the octree or the tri-dexel model.
    uint64_t elements;  ///< Array elements without bricks; 0 for a tri-dexel model.
    uint64_t bricks;  ///< Array elements of the deepest level; 0 for a tri-dexel model.
    uint64_t file_length;  ///< Length of the file in bytes.
    uint64_t sections;  ///< Number of sections of the file.
    leafless_proof proof;  ///< The proofs that the cells give; none for a tri-dexel model.
    /// The tag of the whole universe; BRANCH if it is split; EMPTY for a tri-dexel model.
    leafless_tag root;
    /// The tag of the space outside the universe; never BRANCH; EMPTY for a tri-dexel model.
    leafless_tag exterior;
    bool is_binary;  ///< Whether no cell is undecided.
    leafless_file_tridexel_info tridexel;  ///< Facts about a tri-dexel model; all zeros for an octree.
} leafless_file_info;

/// A section of a file.
typedef struct leafless_file_section {
    uint32_t kind;  ///< Number of its kind.
    uint32_t owner;  ///< The object that the section belongs to: 0 is the solid.
    bool is_required;  ///< Whether a reader must know the kind to read the file.
    char name[24];  ///< Name of its kind, NUL-terminated; empty if this library does not know it.
    uint64_t offset;  ///< Its offset in the file, in bytes.
    uint64_t length;  ///< Its length in bytes.
    uint64_t count;  ///< Its length in elements.
} leafless_file_section;

/// Describes a file from its header and section table. The rest of the file is not checked. A source of bytes
/// may hold only the first bytes of a file: 128, plus 40 for each section. 488 bytes suffice for an octree
/// without channels that this library wrote, 808 for a tri-dexel model, 163 968 for any file.
///
/// - Buffers: `source`, one struct (`access` is ignored); `probe`, one struct; `sections`, room for
///   `capacity` structs, or NULL if they are not wanted.
/// - Result: `*probe`; as many sections as `sections` of `*probe`.
/// - Errors: LEAFLESS_E_FORMAT, also if bytes end before the section table does; LEAFLESS_E_VERSION;
///   LEAFLESS_E_IO; LEAFLESS_E_BUFFER; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any file, any bytes.
leafless_status leafless_file_describe(const leafless_source *source, leafless_file_info *probe,
    leafless_file_section *sections, uint64_t capacity);

/// Verifies a whole file of an octree or a tri-dexel model against all rules of the format: O(n). With
/// LEAFLESS_ACCESS_COPY a file is read into memory, else it is mapped. Bytes are checked in place.
///
/// - Buffers: `source`, one struct; bytes on an address that is a multiple of 8.
/// - Result: LEAFLESS_OK if the file is valid.
/// - Errors: LEAFLESS_E_FORMAT; LEAFLESS_E_VERSION; LEAFLESS_E_DAMAGED; LEAFLESS_E_ARGUMENT if the bytes are
///   misaligned, or if the file to map is not a regular file; LEAFLESS_E_IO; LEAFLESS_E_UTF8;
///   LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: as described in leafless_source.
leafless_status leafless_file_verify(const leafless_source *source);

/// Reads an octree, with its metadata and channels.
///
/// - Buffers: `source`, one struct; `octree`, one pointer.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_FORMAT; LEAFLESS_E_VERSION; LEAFLESS_E_DAMAGED, with LEAFLESS_ACCESS_MAP only if the
///   level table contradicts the header; LEAFLESS_E_ARGUMENT if the file holds a tri-dexel model, if the file
///   to map is not a regular file, or if bytes to view are misaligned; LEAFLESS_E_IO; LEAFLESS_E_UTF8;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: leafless_source describes how long a file or bytes must stay unchanged. Release `*octree`
///   with leafless_octree_free.
/// - Untrusted input: as described in leafless_source.
leafless_status leafless_octree_read(const leafless_source *source, leafless_octree **octree);

/// Writes an octree's file. Equal octrees with equal metadata and channels give equal bytes. The whole file
/// is in memory only if the sink is a buffer.
///
/// - Buffers: `sink`, one struct.
/// - Errors: LEAFLESS_E_DAMAGED if the octree was mapped unverified and is damaged; LEAFLESS_E_IO;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_BUFFER; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree.
leafless_status leafless_octree_write(const leafless_octree *octree, const leafless_sink *sink);

/// Reads a tri-dexel model, with its metadata. If a file is damaged in parts that LEAFLESS_ACCESS_MAP does
/// not check, queries return the damaged intervals, and stay in bounds; set algebra, editors and writing
/// check the whole model first and return LEAFLESS_E_DAMAGED.
///
/// - Buffers: `source`, one struct; `tridexel`, one pointer.
/// - Result: `*tridexel`.
/// - Errors: LEAFLESS_E_FORMAT; LEAFLESS_E_VERSION; LEAFLESS_E_DAMAGED; LEAFLESS_E_ARGUMENT if the file holds
///   an octree, if the file to map is not a regular file, or if bytes to view are misaligned; LEAFLESS_E_IO;
///   LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: leafless_source describes how long a file or bytes must stay unchanged. Release `*tridexel`
///   with leafless_tridexel_free.
/// - Untrusted input: as described in leafless_source.
leafless_status leafless_tridexel_read(const leafless_source *source, leafless_tridexel **tridexel);

/// Writes a tri-dexel model's file. Equal models with equal metadata give equal bytes. The whole file is in
/// memory only if the sink is a buffer.
///
/// - Buffers: `sink`, one struct.
/// - Errors: LEAFLESS_E_DAMAGED if the model was mapped unverified and is damaged; LEAFLESS_E_IO;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_BUFFER; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any model.
leafless_status leafless_tridexel_write(const leafless_tridexel *tridexel, const leafless_sink *sink);

/* ---- 29. Pictures ------------------------------------------------------------------------------------- */

/// The viewpoint of a picture. leafless_camera_fitted sets all fields; a host may set them, too.
typedef struct leafless_camera {
    double eye_model[3];  ///< The position of the eye.
    double at_model[3];  ///< A point that appears in the middle of the picture.
    double up[3];  ///< The direction that points up in the picture, of any length but 0; not along the view.
    /// The field of view in degrees, from the lower to the upper edge of the picture: above 0, below 180, for
    /// a perspective view. 0 means a parallel view, which uses `height_model`.
    double field_of_view_degrees;
    double height_model;  ///< For a parallel view, the visible height in model units; else ignored.
} leafless_camera;

/// Makes a camera that shows all given points in a picture of width : height = `aspect`, as large as possible
/// with a small margin. Points may be the vertices of a mesh, or the eight corners of a bounding box. The
/// view direction is given by an azimuth and an elevation in degrees: 0, 0 is the view from -y with x to the
/// right and z up; a positive azimuth moves the eye to the right, a positive elevation moves it up.
///
/// - Buffers: `points_model`, 3 · `count` numbers; `camera`, one struct.
/// - Result: `*camera`. O(count).
/// - Errors: LEAFLESS_E_ARGUMENT if there is no point, a number is neither 0 nor of a magnitude between
///   2^-256 and 2^256, the field of view is neither 0 (a parallel view) nor between 0 and 180 degrees, or the
///   aspect is not above 0.
/// - Untrusted input: any numbers.
leafless_status leafless_camera_fitted(const double *points_model, uint64_t count, double azimuth_degrees,
    double elevation_degrees, double field_of_view_degrees, double aspect, leafless_camera *camera);

/// Colour maps. Equal steps of a value look like equal steps of colour.
LEAFLESS_ENUM(leafless_colour_map, uint32_t) {
    LEAFLESS_COLOUR_MAP_VIRIDIS = 0,  ///< From dark violet through green to yellow.
    LEAFLESS_COLOUR_MAP_CIVIDIS = 1,  ///< From dark blue to yellow; it looks the same to colour-blind people.
    LEAFLESS_COLOUR_MAP_INFERNO = 2,  ///< From black through red to light yellow.
    LEAFLESS_COLOUR_MAP_MAGMA = 3,  ///< From black through purple to near white.
    LEAFLESS_COLOUR_MAP_PLASMA = 4,  ///< From dark blue through red to yellow.
    LEAFLESS_COLOUR_MAP_GREY = 5,  ///< From black to white.
};

/// A transfer function: the colours of values. A value of one number has the colour of a map over a range. A
/// value of three or four numbers is a colour itself: red, green and blue in sRGB, 0 to 255, and, for
/// volumes, an opacity, 0 to 255, that scales `alpha_upper`. For a value of two numbers the first is used.
/// Without a value the colour is grey.
///
/// The range must be set, and for volumes the opacity. Zero is the default of all other fields but the first.
typedef struct leafless_transfer {
    uint32_t struct_size;  ///< sizeof(leafless_transfer).
    leafless_colour_map map;  ///< A leafless_colour_map.
    double range_lower;  ///< The value at the start of the map.
    double range_upper;  ///< The value at the end of the map; greater than `range_lower`.
    /// For volumes: the opacity, 0 to 1, of a path of `length_model` through the value `range_lower`. It
    /// changes linearly over the range.
    double alpha_lower;
    /// For volumes: the opacity for `range_upper`, for values that are colours, and for voxels without a
    /// value.
    double alpha_upper;
    /// The path length of the opacities, in model units: a medium of opacity a transmits (1 - a)^(s /
    /// length_model) of the light over a path s. 0 means 1.
    double length_model;
} leafless_transfer;

/// Returns the colour of a value under a transfer function, as surfaces show it in full light, for a legend
/// of the host's own.
///
/// - Buffers: `transfer`, one struct; `value`, `components` numbers; `colour`, 4 bytes.
/// - Result: `colour`: red, green and blue (sRGB), and 255. Grey if a number is NaN.
/// - Errors: LEAFLESS_E_ARGUMENT if the transfer function is invalid, or `components` not 1 to 4.
/// - Untrusted input: any numbers.
leafless_status leafless_transfer_colour(const leafless_transfer *transfer, const double *value,
    uint32_t components, uint8_t colour[4]);

/// Returns a layer clipped by planes and a box of its own, which replace those of the picture: for instance,
/// a surface that is cut away to show the voxels behind it. A layer that is clipped already is clipped by all
/// of them.
///
/// - Buffers: `planes`, 4 · `plane_count` numbers: a, b, c and d of each plane, which keeps the points with a
///   x + b y + c z + d ≥ 0; `box_model`, 6 numbers, the least and the greatest corner of the box, or NULL for
///   none; `clipped`, one pointer.
/// - Result: `*clipped`.
/// - Errors: LEAFLESS_E_ARGUMENT if a number is neither 0 nor of a magnitude between 2^-256 and 2^256, a, b
///   and c are zero, or the box has min > max on an axis; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the layer is shared and may be freed; release `*clipped` with leafless_layer_free.
/// - Untrusted input: any numbers.
leafless_status leafless_layer_clipped(const leafless_layer *layer, const double *planes,
    uint64_t plane_count, const double *box_model, leafless_layer **clipped);

/// Returns the approximate number of bytes of memory (or of mapped files) that a layer keeps alive: its own,
/// and those of the octree, solid, mesh and attribute that it shows, as in leafless_octree_describe,
/// leafless_solid_describe and so on. Memory for rendering a picture is not included.
///
/// - Buffers: `bytes`, one number.
/// - Result: `*bytes`.
/// - Untrusted input: any layer.
leafless_status leafless_layer_bytes(const leafless_layer *layer, uint64_t *bytes);

/// Returns one more reference to a layer.
///
/// - Buffers: `layer`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `layer`.
/// - Ownership: release each reference with leafless_layer_free.
leafless_status leafless_layer_ref(const leafless_layer *layer, leafless_layer **reference);

/// Releases a reference to a layer; the last release frees the layer. Objects that it shows stay if other
/// references exist.
///
/// - Buffers: `layer`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
void leafless_layer_free(leafless_layer *layer);

/// The edges that are drawn as lines.
LEAFLESS_ENUM(leafless_edges, uint32_t) {
    LEAFLESS_EDGES_NONE = 0,  ///< None.
    /// For meshes, open edges and edges whose triangles meet at more than the crease angle. For octrees and
    /// solids, silhouettes and edges whose faces meet at more than that angle.
    LEAFLESS_EDGES_FEATURES = 1,
    LEAFLESS_EDGES_ALL = 2,  ///< The edges of all triangles of a mesh.
};

/// The appearance of a surface. NULL means the defaults. Zero is the default of every field but the first. A
/// field that a layer does not use must be zero. Colours are red, green and blue (sRGB) and opacity, 0 to
/// 255.
typedef struct leafless_look {
    uint32_t struct_size;  ///< sizeof(leafless_look).
    /// For octrees: 1 to show the faces of cells instead of the surface that they represent; else 0.
    uint32_t faces;
    uint8_t colour[4];  ///< The colour in full light; all zero means light grey.
    /// The colour of parts that clip planes cut open, and of a mesh's faces seen from behind. All zero means
    /// orange, or, for a mesh, the face's own colour mixed with orange.
    uint8_t inside[4];
    leafless_edges edges;  ///< A leafless_edges.
    uint8_t edge_colour[4];  ///< The colour of edges; all zero means dark grey.
    /// The width of edges in pixels, at most 256, or 8 for octrees and solids; 0 means 1, or 1.5 for octrees
    /// and solids.
    double edge_width;
    /// The angle in degrees, at most 180, above which faces meet at an edge, and up to which neighbouring
    /// triangles of a mesh look smooth; 0 means 30.
    double crease_degrees;
    /// For meshes: 4 · `triangle_count` bytes, a colour for each triangle; NULL means that all have `colour`.
    const uint8_t *triangle_colours;
    uint64_t triangle_count;  ///< Number of colours of triangles.
    /// For octrees and solids: the attribute whose values, such as those of a channel, are shown, taken half
    /// a finest cell below the surface, or half a pixel for solids; optional.
    const leafless_attribute *attribute;
    const leafless_transfer *transfer;  ///< With an attribute: the colours of its values.
} leafless_look;

/// Makes a layer of the surface of an octree: along each line of sight the first cell that is not EMPTY. Its
/// normals are estimates of the surface that the cells represent. An octree that keeps surfaces is shown as
/// by leafless_layer_from_solid, unless the look requests faces of cells; these are the octree's own cells,
/// so make smaller cells with leafless_octree_plain first.
///
/// - Buffers: `look`, one struct or NULL; `layer`, one pointer.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_ARGUMENT if the look is invalid. For an octree that keeps surfaces, taking a picture
///   also returns the errors of leafless_octree_build.
/// - Ownership: the layer shares the octree and the attribute, which may be freed; release `*layer` with
///   leafless_layer_free.
/// - Untrusted input: any octree.
leafless_status leafless_layer_from_octree(const leafless_octree *octree, const leafless_look *look,
    leafless_layer **layer);

/// Makes a layer of the surface of a solid inside a universe. For each picture the solid is split to cells of
/// the size of a pixel, at most 2^11 on an axis. In these cells a line of sight meets the boundary that the
/// solid provides there, with its normals.
///
/// - Buffers: `frame`, one struct (its depth is ignored); `look`, one struct or NULL; `layer`, one pointer.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_ARGUMENT if the look or the frame is invalid; taking a picture also returns the
///   errors of leafless_octree_build.
/// - Ownership: the layer shares the solid and the attribute, which may be freed; release `*layer` with
///   leafless_layer_free.
/// - Untrusted input: any solid.
leafless_status leafless_layer_from_solid(const leafless_solid *solid, const leafless_frame *frame,
    const leafless_look *look, leafless_layer **layer);

/// Makes a layer of the triangles of a mesh.
///
/// - Buffers: `look`, one struct or NULL; `layer`, one pointer.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_ARGUMENT if the look is invalid, or if the number of triangle colours is not that of
///   the triangles; LEAFLESS_E_NO_MEMORY. Taking a picture returns LEAFLESS_E_ARGUMENT if the width or the
///   crease angle is out of range.
/// - Ownership: the layer shares the mesh, which may be freed, and copies the colours; release `*layer` with
///   leafless_layer_free.
/// - Untrusted input: any mesh.
leafless_status leafless_layer_from_mesh(const leafless_mesh *mesh, const leafless_look *look,
    leafless_layer **layer);

/// Makes a layer of lines in space, some pixels wide, with round ends. Surfaces hide lines behind them; a
/// line on a surface is visible.
///
/// - Buffers: `points_model`, 6 · `count` numbers: the ends of each line; `colour`, 4 numbers: red, green,
///   blue (sRGB) and opacity, or NULL for dark grey; `layer`, one pointer. `width` is in pixels, at most 256;
///   0 means 1.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_NO_MEMORY. Taking a picture returns LEAFLESS_E_ARGUMENT if the width is out of range,
///   or a coordinate is neither 0 nor of a magnitude between 2^-256 and 2^256.
/// - Ownership: the layer copies the lines; release `*layer` with leafless_layer_free.
/// - Untrusted input: any numbers.
leafless_status leafless_layer_new_lines(const double *points_model, uint64_t count, double width,
    const uint8_t *colour, leafless_layer **layer);

/// Makes a layer of the edges of cells as lines. Edges that cells share are drawn once. Cells that are not in
/// the frame are left out. Tags are not read.
///
/// - Buffers: `frame`, one struct; `cells`, `count` structs; `colour`, `width` and `layer` as
///   leafless_layer_new_lines.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check, and as leafless_layer_new_lines;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*layer` with leafless_layer_free.
/// - Untrusted input: any numbers.
leafless_status leafless_layer_new_cells(const leafless_frame *frame, const leafless_cell *cells,
    uint64_t count, double width, const uint8_t *colour, leafless_layer **layer);

/// The appearance of a plane section. NULL means the defaults. Zero is the default of every field but the
/// first. Colours are red, green and blue (sRGB) and opacity, 0 to 255; {255, 255, 255, 0} makes a part
/// invisible.
typedef struct leafless_slice_look {
    uint32_t struct_size;  ///< sizeof(leafless_slice_look).
    uint32_t is_plain;  ///< 1 to draw no outlines of cells; else 0.
    uint8_t empty_colour[4];  ///< The colour of EMPTY cells; all zero means sky blue, hardly visible.
    uint8_t full_colour[4];  ///< The colour of FULL cells; all zero means blue.
    uint8_t partial_colour[4];  ///< The colour of PARTIAL cells; all zero means orange.
    uint8_t outline_colour[4];  ///< The colour of outlines; all zero means dark grey.
    /// The attribute whose values, such as those of a channel, are shown where cells are not EMPTY; optional.
    const leafless_attribute *attribute;
    const leafless_transfer *transfer;  ///< With an attribute: the colours of its values.
} leafless_slice_look;

/// Makes a layer of a plane section of an octree, in the colours of its cells' tags or of an attribute's
/// values, with the outlines of the cells.
///
/// - Buffers: `plane`, 4 numbers a, b, c and d: the plane of the points with a x + b y + c z + d = 0; `look`,
///   one struct or NULL; `layer`, one pointer.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_ARGUMENT if a number is neither 0 nor of a magnitude between 2^-256 and 2^256, a, b
///   and c are zero, or the look is invalid.
/// - Ownership: the layer shares the octree and the attribute, which may be freed; release `*layer` with
///   leafless_layer_free.
/// - Untrusted input: any octree, any numbers.
leafless_status leafless_layer_from_octree_slice(const leafless_octree *octree, const double plane[4],
    const leafless_slice_look *look, leafless_layer **layer);

/// Makes a layer of a plane section of a solid on a frame. Cells at the plane are split down to the frame's
/// depth.
///
/// - Buffers: `frame`, one struct; the others as leafless_layer_from_octree_slice.
/// - Result: `*layer`.
/// - Errors: as leafless_layer_from_octree_slice; LEAFLESS_E_ARGUMENT as leafless_frame_check. Taking a
///   picture also returns the errors of leafless_octree_build.
/// - Ownership: the layer shares the solid and the attribute, which may be freed; release `*layer` with
///   leafless_layer_free.
/// - Untrusted input: any solid, any numbers.
leafless_status leafless_layer_from_solid_slice(const leafless_solid *solid, const leafless_frame *frame,
    const double plane[4], const leafless_slice_look *look, leafless_layer **layer);

/// Computes the solid fraction of each voxel, 0 to 1, for use as the weights of voxels in a picture. Inside
/// voxels have 1, outside and refined voxels 0. For a boundary voxel it is the fraction from the solid's own
/// volume there, or the middle of the bounds from its slabs; 1/2 if the solid provides neither.
///
/// - Buffers: `lattice`, `codes`, `levels` and `kinds` as leafless_voxels_find; `options`, one struct or
///   NULL; `parts`, room for `count` numbers.
/// - Result: `parts`. O(count · levels).
/// - Errors: LEAFLESS_E_ARGUMENT if the arrays are not valid records; the errors of the solid;
///   LEAFLESS_E_NO_MEMORY; LEAFLESS_E_CANCELLED.
/// - Untrusted input: any numbers, any solid.
leafless_status leafless_voxels_solid_parts(const leafless_frame *lattice, const uint64_t *codes,
    const uint8_t *levels, const leafless_voxel_kind *kinds, uint64_t count, const leafless_solid *solid,
    const leafless_options *options, double *parts);

/// Voxels in arrays, as written by leafless_octree_voxels: record i is `codes[i]`, `levels[i]`, `kinds[i]`.
/// All fields must be set, except where a comment allows 0 or NULL.
typedef struct leafless_voxel_arrays {
    uint32_t struct_size;  ///< sizeof(leafless_voxel_arrays).
    uint32_t components;  ///< Numbers per value, 1 to 4; 0 without values.
    leafless_frame lattice;  ///< The lattice that codes belong to.
    uint64_t count;  ///< Number of voxels.
    const uint64_t *codes;  ///< Linear octree codes, ascending.
    const uint8_t *levels;  ///< Levels of the voxels.
    /// A leafless_voxel_kind for each voxel. Inside and boundary voxels are visible.
    const leafless_voxel_kind *kinds;
    /// `components` · `count` numbers, NaN where there is no value; NULL without values.
    const double *values;
    /// The solid fraction of each voxel, 0 to 1, as written by leafless_voxels_solid_parts; NULL means 1
    /// inside and 1/2 at the boundary.
    const double *weights;
} leafless_voxel_arrays;

/// Makes a layer of voxels as a translucent volume, composited in the correct order from every viewpoint.
/// Surfaces of other layers hide voxels, and are visible through them. If a picture has two such layers, the
/// first one counts as in front.
///
/// - Buffers: `voxels`, one struct; `transfer`, one struct: the colours of values; `layer`, one pointer. If
///   `unit_model` is 0, voxels are composited by the exact length of each line of sight in a voxel. Otherwise
///   the published method (Zhu, Tang and Dong 2002) is used: a voxel is a cell of the edge `unit_model`,
///   repeated once for each such length in its own edge, and the transfer function's opacity applies to one
///   repetition.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_ARGUMENT if the arrays are not valid records, a weight is not 0 to 1, the transfer
///   function is invalid, or the unit is below 0 or not finite; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the layer copies the arrays; release `*layer` with leafless_layer_free.
/// - Untrusted input: any numbers.
leafless_status leafless_layer_new_voxels(const leafless_voxel_arrays *voxels,
    const leafless_transfer *transfer, double unit_model, leafless_layer **layer);

/// The parameters of a picture. The size and the camera must be set; zero is the default of all other fields
/// but the first.
typedef struct leafless_shot {
    uint32_t struct_size;  ///< sizeof(leafless_shot).
    uint32_t width;  ///< Pixels of a row, 1 to 16384.
    uint32_t height;  ///< Rows, 1 to 16384.
    uint32_t samples;  ///< Samples of a pixel, on a grid: 1, 4, 9, 16, 25, 36, 49 or 64; 0 means 4.
    leafless_camera camera;  ///< The camera.
    /// 4 · `clip_plane_count` numbers: a, b, c and d of each plane, which cuts away the points with a x + b y
    /// + c z + d < 0.
    const double *clip_planes;
    uint64_t clip_plane_count;  ///< Number of clip planes.
    /// 6 numbers, the least and the greatest corner of a box; everything outside it is cut away. NULL means
    /// none.
    const double *clip_box_model;
    /// The background colour: red, green, blue (sRGB) and opacity. All zero means transparent.
    uint8_t background[4];
    uint32_t reserved;  ///< Reserved; 0.
} leafless_shot;

/// Returns the line of sight of a position in a picture, in pixels from its upper left corner: the middle of
/// the first pixel is 0.5, 0.5. A point visible there at the depth d is `from_model` + d · `direction`.
///
/// - Buffers: `shot`, one struct; `from_model` and `direction`, 3 numbers each.
/// - Result: `from_model`, the start of the line of sight; `direction`, with the component 1 along the view.
/// - Errors: LEAFLESS_E_ARGUMENT if the camera or the size is invalid.
/// - Untrusted input: any numbers.
leafless_status leafless_shot_line_of_sight(const leafless_shot *shot, double x, double y,
    double from_model[3], double direction[3]);

/// Renders a picture of layers. Surfaces hide objects behind them in all layers; of two surfaces at one depth
/// that of the first layer is visible. The bytes are identical for any number of threads.
///
/// - Buffers: `shot`, one struct; `layers`, `layer_count` handles; `options`, one struct or NULL; `colours`,
///   room for `colour_capacity` bytes, and `depths`, room for `depth_capacity` numbers, each NULL if it is
///   not wanted.
/// - Result: in `colours` 4 · width · height bytes: red, green, blue (sRGB, not multiplied by the opacity)
///   and opacity of each pixel, row by row from the upper left corner without gaps. In `depths` width ·
///   height numbers: the distance from the plane of the eye to the nearest opaque point, in model units;
///   infinity if there is none, or if it is beyond the range of float.
/// - Errors: LEAFLESS_E_ARGUMENT if the shot is invalid; LEAFLESS_E_BUFFER if a capacity is too small:
///   nothing is written then; the errors of solids and attributes of layers; LEAFLESS_E_NO_MEMORY;
///   LEAFLESS_E_CANCELLED.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any layers, any numbers.
leafless_status leafless_picture_render(const leafless_shot *shot, const leafless_layer *const *layers,
    uint64_t layer_count, const leafless_options *options, uint8_t *colours, uint64_t colour_capacity,
    float *depths, uint64_t depth_capacity);

/// Writes a picture as a PNG file: without opacity if all pixels are opaque. The same picture makes the same
/// bytes.
///
/// - Buffers: `colours`, 4 · `width` · `height` bytes, as written by leafless_picture_render; `sink`, one
///   struct.
/// - Errors: LEAFLESS_E_ARGUMENT unless the sides are 1 to 16384 pixels; LEAFLESS_E_IO; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_BUFFER; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any bytes.
leafless_status leafless_picture_write(const uint8_t *colours, uint32_t width, uint32_t height,
    const leafless_sink *sink);

/// The side of a picture where a legend lies.
LEAFLESS_ENUM(leafless_legend_side, uint32_t) {
    LEAFLESS_LEGEND_SIDE_RIGHT = 0,  ///< In the middle of the right side, at most a third of the width.
    LEAFLESS_LEGEND_SIDE_BOTTOM = 1,  ///< In the middle of the lower side, at most a third of the height.
};

/// The part of a picture that a legend covers; all zero if there is none.
typedef struct leafless_legend_box {
    uint32_t left;  ///< Pixels to the left of the legend.
    uint32_t top;  ///< Rows above the legend.
    uint32_t width;  ///< Its width in pixels.
    uint32_t height;  ///< Its height in pixels.
} leafless_legend_box;

/// Draws a bar of the colours of values over a transfer function's range into a picture, with a title and
/// numbers, on a light panel. Titles that are too long are cut.
///
/// - Buffers: `colours`, 4 · `width` · `height` bytes, as leafless_picture_render writes them; `title`,
///   `title_length` bytes of UTF-8; `transfer`, one struct; `covered`, one struct. `side` is a
///   leafless_legend_side.
/// - Result: the picture with the legend; in `*covered` the box that it covers, all zero if the picture is
///   smaller than 160 x 120 pixels, which has no legend.
/// - Errors: LEAFLESS_E_ARGUMENT unless the sides are 1 to 16384 pixels, or if the transfer function is
///   invalid; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY. After an error the picture is unchanged.
/// - Untrusted input: any bytes.
leafless_status leafless_picture_draw_bar(uint8_t *colours, uint32_t width, uint32_t height,
    const char *title, size_t title_length, const leafless_transfer *transfer, leafless_legend_side side,
    leafless_legend_box *covered);

/// A colour with its meaning in a legend.
typedef struct leafless_legend_name {
    const char *name;  ///< The name in UTF-8; need not be NUL-terminated.
    size_t name_length;  ///< Length of the name in bytes.
    uint8_t colour[4];  ///< Red, green, blue (sRGB) and opacity.
    uint32_t reserved;  ///< Reserved; 0.
} leafless_legend_name;

/// Draws boxes of colours with their names into a picture, under a title, on a light panel. Names that do not
/// fit are left out or cut.
///
/// - Buffers: `colours`, `title`, `side` and `covered` as leafless_picture_draw_bar; `names`, `name_count`
///   structs.
/// - Result: as leafless_picture_draw_bar; there is also no legend if there is neither a title nor a name.
/// - Errors: as leafless_picture_draw_bar.
/// - Untrusted input: any bytes.
leafless_status leafless_picture_draw_names(uint8_t *colours, uint32_t width, uint32_t height,
    const char *title, size_t title_length, const leafless_legend_name *names, uint64_t name_count,
    leafless_legend_side side, leafless_legend_box *covered);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* LEAFLESS_H */
