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
 *   A leafless_solid is a shape: it can be asked about points, rays, boxes, volumes and other solids, and
 *   it can be built. A leafless_octree stores a shape in the cells of a leafless_frame; set operations on
 *   one frame are exact. A leafless_tridexel stores a shape as intervals of rays. Octrees and tri-dexel
 *   models are written to files, and mapped from them. A cell is EMPTY or FULL, which is proven, or PARTIAL,
 *   which is undecided. A volume is an interval that contains the true volume. A leafless_layout tells which
 *   solids may stand where in a container, and places them.
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
 * most), or the memory of a new thread. Triangulating a polygon with holes or dents needs 320 bytes a corner:
 * the library reserves and releases that amount first, so that a shortage is an error.
 *
 * Objects. Objects are opaque handles. _new, _read and the like return a reference; _ref returns one more;
 * _free gives one back, and accepts NULL. References may be given back in any order: an object shares what it
 * needs of another one. A pointer from a _peek function belongs to the object.
 *
 * Threads. Calls that take only pointers to const handles may run at once, on the same object too. Other
 * calls need the object for themselves. A _free needs only its own reference; other references may be in use
 * meanwhile. A leafless_lazy, a leafless_tridexel_editor and a leafless_layout return LEAFLESS_E_BUSY while
 * they are in use. Different objects never interfere. The library has no global state. No thread of the
 * library outlives the call that started it.
 *
 * Names. A function has the name of its object, which is the first parameter or the result, and a verb. _new
 * makes an object of parameters, _from_x of another model, _read of a source; _build does so under options.
 * _with_x and _without_x return a copy with one thing more or less; participles (_placed, _sewn) a copy that
 * is changed. _describe fills a struct of facts, such as leafless_octree_info; _copy fills buffers of the
 * caller; _write goes to a sink. _at takes a place or an index, _many takes an array of questions. Set
 * operations are _combine for any number of operands, and _complement. A member of an enumeration begins with
 * the name of the enumeration, a leafless_status alone with an E. UNDECIDED is 2 in every answer, as
 * LEAFLESS_TAG_PARTIAL is. UNKNOWN, that nobody has said, is 0.
 *
 * Structs. A struct with a field struct_size begins with its own sizeof, which the caller sets, also before
 * the library fills it: LEAFLESS_INIT(type) does so, and zeroes all other fields. Zero is the default of what
 * the library reads. Such structs may grow at their end, and programs that were compiled with an older,
 * shorter one go on working: fields that they do not have count as zero, and are not written. Of a newer,
 * longer one the library writes the fields that it knows. Structs without the field, elements of arrays among
 * them, are fixed for one LEAFLESS_ABI.
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
 * Cells. A cell is told by its level and by its place among the cells of that level. Level 0 is the universe.
 * leafless_frame_cell_bounds gives the box of any cell in model units, also of witnesses and nearest cells.
 *
 * Buffers. A buffer whose size the caller cannot know is filled in two steps. With a NULL buffer and the
 * capacity 0 the function returns the number of elements; the second call fills the buffer. Capacities count
 * elements. Buffers and results of one call must not overlap.
 *
 * Functions of the host get their context first, return 0 to go on, and must not throw or longjmp through the
 * library.
 *
 * Comments of functions have entries in a fixed order. An entry is left out where it says just this:
 * - Buffers: none.
 * - Result: the status alone.
 * - Errors: only the general ones.
 * - Ownership: nothing changes hands; the library keeps nothing that it was given.
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

/* LEAFLESS_ENUM: an enumeration of a fixed size. C has no such thing; there the name is the integer's.
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

/// Whether the library that is linked fits this header: it has the same binary interface, and is not older.
/// Before 0.1, where nothing is promised, it must have the same version.
#define LEAFLESS_COMPATIBLE() \
    (leafless_abi() == LEAFLESS_ABI && \
     (LEAFLESS_ABI > 0 ? leafless_version() >= LEAFLESS_VERSION : leafless_version() == LEAFLESS_VERSION))

/* ---- 1. Objects --------------------------------------------------------------------------------------- */

/// A switch to stop long operations from any thread, and to ask how far they are.
///
/// All its functions may be called at once from any number of threads.
typedef struct leafless_control leafless_control;

/// A surface of triangles with shared vertices. Vertices at equal places are welded; whether the mesh is
/// closed is not implied, and need not be.
///
/// Immutable: all its functions may be called at once from any number of threads, but leafless_mesh_free
/// needs the reference that it gives back for itself.
typedef struct leafless_mesh leafless_mesh;

/// Anything that has a shape: it can split a cell of space into eight classified ones.
///
/// To answer about cells of a frame a solid is prepared for it, which takes time in proportion to the model:
/// a mesh is brought onto the lattice, an expression is written out, all links of an octree are checked. It
/// keeps the last frame that it was prepared for, so that a second question on the same frame costs none of
/// that; another frame takes its place. (It keeps the last frame of its own only: what is made of it prepares
/// it anew.)
///
/// Immutable otherwise: all its functions may be called at once from any number of threads, but
/// leafless_solid_free needs the reference that it gives back for itself. Threads that ask on different
/// frames at the same time prepare it again and again: give each a solid of its own.
typedef struct leafless_solid leafless_solid;

/// A three-dimensional bitmap or array of samples, and where it lies. Each sample stands for the closed box
/// around it, its voxel: on each axis voxel i reaches from corner + i·spacing to corner + (i + 1)·spacing.
/// leafless_solid_from_volume makes a solid of those whose samples lie in a band.
///
/// Immutable: all its functions may be called at once from any number of threads, but leafless_volume_free
/// needs the reference that it gives back for itself.
typedef struct leafless_volume leafless_volume;

/// What a text describes: set operations on primitives, swept figures, meshes and octrees.
///
/// The language is that of the CSG dumps which OpenSCAD exports (group union difference intersection
/// multmatrix color render cube sphere cylinder polyhedron linear_extrude rotate_extrude square circle
/// polygon, and import of meshes), with these calls besides: halfspace([a, b, c, d]), which is a x + b y + c
/// z + d ≥ 0, quadric([10 numbers]), power([A, a, n1], [B, b, n2], [C, c, n3], R), torus(major, minor),
/// mesh("file.stl") and octree("file.lfl"). Curved shapes are exact, but for those with a $fn of 12 or less,
/// which are the polygons, prisms and polyhedra that OpenSCAD draws; leafless_scene_options ask for others.
/// What is not supported (hull, minkowski, text, projection and others) is refused by name.
///
/// Immutable: all its functions may be called at once from any number of threads, but leafless_scene_free
/// needs the reference that it gives back for itself.
typedef struct leafless_scene leafless_scene;

/// A leaf-free octree, in memory or mapped from a file.
///
/// Immutable: all its functions may be called at once from any number of threads, but leafless_octree_free
/// needs the reference that it gives back for itself.
typedef struct leafless_octree leafless_octree;

/// Point queries that remember the way to the last answer: for points that lie near each other, such as along
/// a line or in scan order.
///
/// Every call changes it: only one thread may use a cursor at a time. Threads may have a cursor each.
typedef struct leafless_point_cursor leafless_point_cursor;

/// Point queries by way of a table of all cells of one level, where most points are decided: about twice as
/// fast as leafless_octree_contains for points anywhere. The table takes 4 * 8^level bytes: 1 MiB for level
/// 6, 64 MiB for level 8. Questions do not change it: any threads may ask at once.
typedef struct leafless_point_table leafless_point_table;

/// A position in an octree that moves along its links, one level at a step. At first it stands on the
/// universe.
///
/// Moving changes it: while one thread moves a cursor, no other may use it. Threads may have a cursor each.
typedef struct leafless_cursor leafless_cursor;

/// Cells of an octree one after another. It stands before its next cell.
///
/// Reading changes it: while one thread reads, no other may use it. Threads may have one each.
typedef struct leafless_cells leafless_cells;

/// Boundary faces of an octree one after another. It stands before its next face.
///
/// Reading changes it: while one thread reads, no other may use it. Threads may have one each.
typedef struct leafless_faces leafless_faces;

/// The solid cells of columns, as runs.
///
/// It does not change: any number of threads may read it at once.
typedef struct leafless_columns leafless_columns;

/// A container, obstacles and items: what leafless_layout_new makes a layout of. It is filled by one thread
/// at a time.
typedef struct leafless_bay leafless_bay;

/// A container with obstacles, items, and the places of copies of these items. Solids are prepared once, when
/// the layout is made. Copies are numbered from 0, in the order in which they were placed.
///
/// While one call changes it, every other call returns LEAFLESS_E_BUSY, from another thread as from the
/// host's functions that are asked about a cell. While another call reads it, changing it returns
/// LEAFLESS_E_BUSY. Calls that read it may be made at once from any number of threads.
typedef struct leafless_layout leafless_layout;

/// An octree of a solid that is not built in one go: a cell is split when somebody asks for it, and what was
/// split is remembered. FULL and EMPTY cells are proven; cells that nobody has split yet are PARTIAL.
///
/// Splitting and refining change it: while one call does so, every other call returns LEAFLESS_E_BUSY, from
/// another thread as from the host's functions that are asked about a cell. While another call reads it,
/// splitting and refining return LEAFLESS_E_BUSY. Its other functions may be called at once from any number
/// of threads.
typedef struct leafless_lazy leafless_lazy;

/// Something that has a value at every point of model space, or at some: one number, the host's own function,
/// the values of a channel, any of them in another place. A value has one to four numbers, as many at all
/// points of an attribute. Where a value is written and there is none, its numbers are NaN.
///
/// Immutable: all its functions may be called at once from any number of threads, but leafless_attribute_free
/// needs the reference that it gives back for itself.
typedef struct leafless_attribute leafless_attribute;

/// Values inside a cube, in a tree of their own: a colour, a temperature, a material at every point, or at
/// some. leafless_octree_with_channel attaches it to a solid, in whose file it then travels. The tree may be
/// finer or coarser than the solid's.
///
/// Immutable: all its functions may be called at once from any number of threads, but leafless_channel_free
/// needs the reference that it gives back for itself.
typedef struct leafless_channel leafless_channel;

/// The boundary of a solid: a mesh whose triangles know their surfaces, and its faces.
///
/// A region is what hangs together on one surface, over edges of the mesh. On a plane it is one face: an
/// outer loop, which runs counter-clockwise as seen from outside of the solid, and a loop around each hole,
/// which runs the other way. On a curved surface its triangles are the faces. Two faces that meet in an edge
/// have the same vertices there.
///
/// Immutable: all its functions may be called at once from any number of threads, but leafless_boundary_free
/// needs the reference that it gives back for itself.
typedef struct leafless_boundary leafless_boundary;

/// A solid as intervals along the rays of a lattice, in one to three directions: a tri-dexel model.
///
/// Rays run through the centres of the finest cells of a frame. Each has the sorted, disjoint intervals in
/// which it runs inside of the solid. An interval holds its start and not its end, so that set algebra is
/// exact. All directions agree about the centres of cells.
///
/// Immutable: all its functions may be called at once from any number of threads, but leafless_tridexel_free
/// needs the reference that it gives back for itself. A leafless_tridexel_editor changes a copy in place.
typedef struct leafless_tridexel leafless_tridexel;

/// A copy of a tri-dexel model that is changed in place, in time proportional to what the second operand's
/// rays touch: for machining. It takes 12 bytes for each ray of the lattice beside the intervals.
///
/// While one call changes it, every other call returns LEAFLESS_E_BUSY, from another thread as from the
/// host's functions that are asked about a cell. While another call reads it, changing it returns
/// LEAFLESS_E_BUSY. Calls that read it may be made at once from any number of threads.
typedef struct leafless_tridexel_editor leafless_tridexel_editor;

/// Something that is seen in a picture: the surface of an octree, a solid or a mesh, lines, a plane section,
/// voxels.
///
/// A layer shares or copies what it shows, which may be freed. It knows nothing of cameras: it may be part of
/// any number of pictures.
///
/// Immutable: all its functions may be called at once from any number of threads, but leafless_layer_free
/// needs the reference that it gives back for itself.
typedef struct leafless_layer leafless_layer;

/* ---- 2. Versions -------------------------------------------------------------------------------------- */

/// Major version of the library that this header belongs to.
#define LEAFLESS_VERSION_MAJOR 0

/// Minor version of the library that this header belongs to.
#define LEAFLESS_VERSION_MINOR 0

/// Patch level of the library that this header belongs to.
#define LEAFLESS_VERSION_PATCH 1

/// Number of the binary interface: programs and libraries of one number fit together. 0 until the release
/// 0.1, which means that nothing is promised yet.
#define LEAFLESS_ABI 0

/// The version of the library that is linked: major · 1 000 000 + minor · 1000 + patch, as LEAFLESS_VERSION.
///
/// - Result: the number.
uint32_t leafless_version(void);

/// The version of the library that is linked, as a text such as "0.1.0".
///
/// - Result: a NUL-terminated text, never NULL.
/// - Ownership: the text is static; do not free it.
const char *leafless_version_string(void);

/// The number of the binary interface of the library that is linked; compare it with LEAFLESS_ABI, or use
/// LEAFLESS_COMPATIBLE, which compares the version too.
///
/// - Result: the number.
uint32_t leafless_abi(void);

/* ---- 3. Errors ---------------------------------------------------------------------------------------- */

/// What a function returns. Codes are never renumbered and never used for something else; new ones may be
/// added at the end.
LEAFLESS_ENUM(leafless_status, int32_t) {
    LEAFLESS_OK = 0,  ///< Done.
    LEAFLESS_E_NULL = 1,  ///< A pointer that must not be NULL is.
    LEAFLESS_E_ARGUMENT = 2,  ///< An argument is out of its range, not a number, or misaligned.
    LEAFLESS_E_UTF8 = 3,  ///< A text is not UTF-8, or a path holds a NUL.
    LEAFLESS_E_BUFFER = 4,  ///< A buffer is too small for what would be written to it.
    LEAFLESS_E_FRAME = 5,  ///< Operands lie on different frames, or a solid belongs to another frame.
    LEAFLESS_E_NOT_SAMPLED = 6,  ///< The sampled rule was asked of a solid that cannot decide single points.
    LEAFLESS_E_MESH = 7,  ///< A mesh does not bound a solid.
    LEAFLESS_E_MESH_FILE = 8,  ///< A mesh file cannot be read.
    LEAFLESS_E_FORMAT = 9,  ///< The bytes are no Leafless file, or a damaged one.
    LEAFLESS_E_VERSION = 10,  ///< The file needs a newer version of the library.
    LEAFLESS_E_DAMAGED = 11,  ///< The arrays of an octree or of a tri-dexel model contradict each other.
    LEAFLESS_E_LIMIT = 12,  ///< More nodes or bytes than leafless_options allows.
    LEAFLESS_E_NO_MEMORY = 13,  ///< An allocation failed.
    /// The host asked to stop, through a control or from a function that hears of progress.
    LEAFLESS_E_CANCELLED = 14,
    /// A function of the host, other than one that hears of progress, ended the work by what it returned.
    LEAFLESS_E_CALLBACK = 15,
    LEAFLESS_E_IO = 16,  ///< The operating system refused to read or write.
    /// A defect of the library, please report it with the message. What the function worked on is as before.
    LEAFLESS_E_PANIC = 17,
    LEAFLESS_E_SOURCE = 18,  ///< An octree that is to be refined was made from another solid.
    LEAFLESS_E_SCENE = 19,  ///< A scene cannot be read.
    /// A lazy octree or an editor is in use by another call, in another thread or around this one. Nothing
    /// was done.
    LEAFLESS_E_BUSY = 20,
    LEAFLESS_E_VOLUME_FILE = 21,  ///< A volume file cannot be read.
};

/// The name of a status, such as "LEAFLESS_E_NULL".
///
/// - Result: a NUL-terminated text, never NULL; "LEAFLESS_E_UNKNOWN" for a number that is no status.
/// - Ownership: the text is static; do not free it.
/// - Untrusted input: any number.
const char *leafless_status_name(int32_t status);

/// The message of the last failure in the calling thread: a sentence that a user can act on, in UTF-8. If it
/// is about a file, the message begins with the path, or with the end of a long one. Calls that succeed leave
/// it as it is; before the first failure it is empty.
///
/// - Buffers: `message`, `capacity` bytes; may be NULL if `capacity` is 0.
/// - Result: the message's length in bytes, without the terminating NUL, also if not all of it was written;
///   at most 511. What is written is cut at a character and NUL-terminated.
/// - Ownership: the message is copied.
/// - Threads: any; every thread has its own message.
size_t leafless_last_error(char *message, size_t capacity);

/// The status of the last failure in the calling thread, LEAFLESS_OK before the first.
///
/// - Result: the status.
/// - Threads: any; every thread has its own status.
leafless_status leafless_last_status(void);

/// What a function of the host returned that ended the work, if that was the last failure in the calling
/// thread (LEAFLESS_E_CALLBACK); else 0. So the host knows which of its functions it was, and why.
///
/// - Result: the number.
/// - Threads: any; every thread has its own number.
int32_t leafless_last_code(void);

/* ---- 4. Options, cancelling, progress ----------------------------------------------------------------- */

/// Hears how far an operation is, with the fraction done (0 to 1); returns 0 to go on. Anything else ends the
/// operation with LEAFLESS_E_CANCELLED, unless it is already done, and cancels the `control` of its options,
/// if there is one, until leafless_control_reset.
///
/// It is called from any of the operation's threads, also from two at once and then not in ascending order;
/// with `threads` = 1 from the calling thread only. It must return: no exception, no longjmp. It may call
/// this library.
typedef int32_t (*leafless_progress_fn)(void *ctx, double fraction);

/// How a long operation may proceed. Where a function takes options, NULL means the defaults. All fields but
/// the first may be zero, which is their default. No option but `max_splits` changes a result.
typedef struct leafless_options {
    uint32_t struct_size;  ///< sizeof(leafless_options).
    /// Threads to use; 0 means as many as the machine has processors, numbers beyond 1024 mean 1024. Inside
    /// of a function that the library calls it is always 1.
    uint32_t threads;
    uint64_t max_nodes;  ///< Refuse results of more octree nodes than this; 0 means no limit.
    /// Refuse results whose working form is larger than this many bytes; 0 means no limit. Where the size is
    /// known beforehand nothing is done. When a result is put together, it takes as much again for a moment.
    /// Set a limit where a solid or its depth is not your own choice: a file of some hundred bytes may hold a
    /// cell whose surface has 2^43 triangles. Interference, clearance, deviations and bounding boxes end with
    /// what they know, as with max_splits spent, before what they remember of a solid's parts takes so much.
    uint64_t max_bytes;
    /// Split at most this many cells; 0 means no limit, or the one that the function names. Only functions
    /// that split on demand heed it, and say so: with it spent they stop, and keep or return what they have;
    /// it is no error.
    uint64_t max_splits;
    leafless_progress_fn progress;  ///< Hears of the progress; optional.
    void *progress_ctx;  ///< What `progress` is called with.
    /// Ends the operation when it is cancelled, and can be asked for the progress; optional. Give operations
    /// that run at once a control each, or their progress is mixed up.
    const leafless_control *control;
} leafless_options;

/// Makes any struct that begins with `struct_size` its default: its size, and zeros. In C and C++ the macro
/// LEAFLESS_INIT does the same; this function is for other languages.
///
/// - Buffers: `value`, one struct of `struct_size` bytes, which need not be initialised.
/// - Result: `*value`.
/// - Errors: LEAFLESS_E_ARGUMENT if `struct_size` cannot be right.
leafless_status leafless_init(void *value, size_t struct_size);

/// Makes a control.
///
/// - Buffers: `control`, one pointer.
/// - Result: `*control`, not cancelled.
/// - Ownership: give `*control` back with leafless_control_free, not before the operations that use it are
///   done.
leafless_status leafless_control_new(leafless_control **control);

/// Gives back a control.
///
/// - Buffers: `control`, a handle or NULL, which does nothing.
/// - Ownership: the handle is gone.
/// - Threads: no other call may use the handle.
void leafless_control_free(leafless_control *control);

/// Ends the operations that run with this control: they return LEAFLESS_E_CANCELLED soon, and so do later
/// ones until leafless_control_reset.
///
/// - Buffers: `control`, a handle.
/// - Result: none; returns at once.
leafless_status leafless_control_cancel(const leafless_control *control);

/// Makes a cancelled control usable again.
///
/// - Buffers: `control`, a handle.
/// - Threads: any, but operations that have not noticed the cancelling yet may go on.
leafless_status leafless_control_reset(const leafless_control *control);

/// Whether a control was cancelled, and how far the operation is that runs with it.
///
/// - Buffers: `control`, a handle; `cancelled` and `fraction`, one each, each may be NULL.
/// - Result: `*cancelled`; `*fraction`, 0 to 1.
leafless_status leafless_control_state(const leafless_control *control, bool *cancelled, double *fraction);

/* ---- 5. Frames ---------------------------------------------------------------------------------------- */

/// Where a tree lies: the cube [origin, origin + edge]³ in model units, cut into 2^depth cells per axis.
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

/// The cube of edge L·(1 + 1/32) around the centre of a shape, L being its longest extent; the same universe
/// at every depth. For parts with round dimensions leafless_frame_aligned is better.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `frame`, one struct.
/// - Result: `*frame`.
/// - Errors: LEAFLESS_E_MESH if the longest extent is 0; LEAFLESS_E_ARGUMENT if min > max on an axis, if
///   `depth` is not 1 to 20, or if a bound is not a finite number in range, or so far from the origin that
///   doubles cannot resolve the cube.
/// - Untrusted input: any values.
leafless_status leafless_frame_around(const double min_model[3], const double max_model[3], uint32_t depth,
    leafless_frame *frame);

/// The frame of leafless_frame_around whose finest cells are no longer than a tolerance, the greater of a
/// length and a part of the longest extent. It has the least such depth; where 20 levels do not suffice, and
/// for tolerances of 0, it has 20.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `frame`, one struct.
/// - Result: `*frame`.
/// - Errors: as leafless_frame_around; LEAFLESS_E_ARGUMENT if a tolerance is negative or no number.
/// - Untrusted input: any values.
leafless_status leafless_frame_to_tolerance(const double min_model[3], const double max_model[3],
    double tolerance_model, double relative, leafless_frame *frame);

/// A frame whose lattice planes are round numbers, around a shape with these bounds: its edge is the smallest
/// power of two that holds them, its origin a multiple of as great a power of two as possible. Faces at 25,
/// 12.5 or -0.75 then lie on lattice planes, where they take no cells and the certified volume is exact. The
/// same universe at every depth.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `frame`, one struct.
/// - Result: `*frame`.
/// - Errors: as leafless_frame_around.
/// - Untrusted input: any values.
leafless_status leafless_frame_aligned(const double min_model[3], const double max_model[3], uint32_t depth,
    leafless_frame *frame);

/// A frame with cells of a given size around a shape with these bounds, its origin a multiple of the cell
/// size times as great a power of two as possible, of the least depth that holds the bounds.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `frame`, one struct.
/// - Result: `*frame`.
/// - Errors: as leafless_frame_around; LEAFLESS_E_ARGUMENT also if `cell_size_model` is not 2^-256 to 2^256,
///   or if the bounds take more than 2^20 cells on an axis.
/// - Untrusted input: any values.
leafless_status leafless_frame_with_cells(const double min_model[3], const double max_model[3],
    double cell_size_model, leafless_frame *frame);

/// The frame that suits a shape with these bounds: leafless_frame_aligned if all bounds are multiples of
/// 2^-12 of its edge, as those of parts that people draw, else leafless_frame_around. The same universe at
/// every depth.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `frame`, one struct.
/// - Result: `*frame`.
/// - Errors: as leafless_frame_around.
/// - Untrusted input: any values.
leafless_status leafless_frame_fitted(const double min_model[3], const double max_model[3], uint32_t depth,
    leafless_frame *frame);

/// The edge length of a finest cell: edge / 2^depth, exactly.
///
/// - Buffers: `frame`, one struct; `cell_size_model`, one number.
/// - Result: `*cell_size_model`, in model units.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check.
/// - Untrusted input: any values.
leafless_status leafless_frame_cell_size(const leafless_frame *frame, double *cell_size_model);

/// The finest cell that a point lies in. A point on a plane between two cells belongs to the upper one, on
/// the universe's upper face to the last; the comparison is exact.
///
/// - Buffers: `frame`, one struct; `point_model`, 3 numbers; `cell`, room for 3.
/// - Result: `cell`, each below 2^depth.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check, and if the point is outside of the universe or not
///   a number.
/// - Untrusted input: any values.
leafless_status leafless_frame_cell_at(const leafless_frame *frame, const double point_model[3],
    uint32_t cell[3]);

/// Where a lattice plane lies: the tightest interval of doubles that contains it.
///
/// - Buffers: `frame`, one struct; `plane_model`, one struct.
/// - Result: `*plane_model`; lower = upper if the plane is a double.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check, if `axis` is not 0 to 2, or `index` beyond 2^depth.
/// - Untrusted input: any values.
leafless_status leafless_frame_plane(const leafless_frame *frame, uint32_t axis, uint32_t index,
    leafless_interval *plane_model);

/* ---- 6. Sources and sinks ----------------------------------------------------------------------------- */

/// How a source is used. Octrees, tri-dexel models and samples in memory can be used where they lie;
/// everything else is read with LEAFLESS_ACCESS_COPY.
LEAFLESS_ENUM(leafless_access, uint32_t) {
    /// It is read into memory, and all of it is verified: the plain way, and the one for files that may not
    /// be trusted. Later changes of the file or of the bytes do not matter. Bytes may lie on any address.
    LEAFLESS_ACCESS_COPY = 0,
    /// It is used where it lies: a file is mapped into memory, bytes are viewed. Only its header, section
    /// table, bounds, level table or windows, and metadata are checked: some microseconds for any length.
    /// What queries touch is read when they do. Of what is damaged elsewhere queries answer undecided or
    /// wrong, but stay in bounds and end.
    LEAFLESS_ACCESS_MAP = 1,
    /// As LEAFLESS_ACCESS_MAP, but all of it is verified first, in one scan. Who writes to it afterwards
    /// undoes that.
    LEAFLESS_ACCESS_MAP_VERIFIED = 2,
};

/// What is read: a file by its path, or the bytes of a whole file in memory. One of the two is given, and the
/// fields of the other are zero, else functions return LEAFLESS_E_ARGUMENT. leafless_from_file and
/// leafless_from_bytes make it.
///
/// A file that is mapped must be a regular one. While the object that was read lives, or one that shares the
/// file with it, nobody may make the file shorter: reading beyond its new end raises SIGBUS, which by default
/// ends the process. Nobody may write to it either: answers may then be wrong, and nothing more is promised.
/// Removing the file, or replacing it by renaming another over it, as a leafless_sink does, is harmless.
///
/// Bytes that are viewed begin on an address that is a multiple of 8, and stay the host's. They must stay,
/// unchanged, until the last reference is given back to the object that was read, and to all that was made of
/// it and shares them: cursors, solids, channels, models with other metadata, and all that was made of these.
/// They are for files that are part of a program, or that the host maps itself.
///
/// Untrusted input: with LEAFLESS_ACCESS_COPY any file and any bytes, and memory is at most a small multiple
/// of their length, unless the function says more. With the other two any content too, but only where nobody
/// else can change it.
typedef struct leafless_source {
    uint32_t struct_size;  ///< sizeof(leafless_source).
    leafless_access access;  ///< How it is used.
    const char *path;  ///< The file's path, UTF-8; NULL if bytes are given.
    size_t path_length;  ///< Its length in bytes.
    const uint8_t *bytes;  ///< All bytes of a file; NULL if a path is given, or if there are none.
    uint64_t length;  ///< Their number.
} leafless_source;

/// Takes bytes of a file in order: all `count` of them, and returns 0; anything else ends the writing with
/// LEAFLESS_E_CALLBACK. It is called in the calling thread. It must return: no exception, no longjmp. It may
/// call this library.
typedef int32_t (*leafless_write_fn)(void *ctx, const uint8_t *bytes, uint64_t count);

/// Where a file is written to: a path, a function of the host, or a buffer. Just one of `path`, `write` and
/// `length` is given, and the fields of the others are zero, else functions return LEAFLESS_E_ARGUMENT.
/// leafless_to_file, leafless_to_function and leafless_to_buffer make it.
///
/// A path. At any moment, also after a crash or a power failure, there is the old file or the new one, each
/// complete; after LEAFLESS_OK the new one is on the disk. The bytes go to a temporary file in the same
/// directory, which is synchronised with the disk and then renamed over the old file. On Linux the temporary
/// file has no name until it is complete, so that nothing is left of it when the process is killed, where the
/// file system has such files. Elsewhere a file `.leafless-….tmp` may stay behind. A file that is replaced
/// keeps its permissions, its other hard links keep the old contents. A symbolic link is followed. What is no
/// regular file, such as a pipe, is written to directly; a pipe that nobody reads raises SIGPIPE, and a file
/// beyond the process's limit SIGXFSZ, if the host has not ignored them. A pipe that nobody has opened for
/// reading is waited for, also if signal handlers run meanwhile. After an error, LEAFLESS_E_IO or another,
/// the old file is as it was; only if the very last step fails, synchronising the directory, the new one is
/// in place.
///
/// A function. It is called with a few large pieces, from the first byte to the last. LEAFLESS_E_CALLBACK has
/// what it returned in the message. Other errors come before anything is written.
///
/// A buffer. Asking for the length takes as long as filling. LEAFLESS_E_BUFFER if the capacity is too small.
typedef struct leafless_sink {
    uint32_t struct_size;  ///< sizeof(leafless_sink).
    uint32_t reserved;  ///< Zero.
    const char *path;  ///< The file's path, UTF-8.
    size_t path_length;  ///< Its length in bytes.
    leafless_write_fn write;  ///< Takes the bytes.
    void *write_ctx;  ///< What `write` is called with.
    uint8_t *bytes;  ///< Room for `capacity` bytes, or NULL to ask for the length only.
    uint64_t capacity;  ///< How many bytes there is room for.
    uint64_t *length;  ///< Where the length of the file is written to: the number of bytes.
} leafless_sink;

/// The file at a path, which ends with a NUL.
static inline leafless_source leafless_from_file(const char *path, leafless_access access) {
    leafless_source source = LEAFLESS_INIT(leafless_source);
    source.access = access;
    source.path = path;
    /* NULL is refused for what it is, and not taken for no bytes. */
    source.path_length = path ? strlen(path) : 1;
    return source;
}

/// The bytes of a whole file.
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

/// To the file at a path, which ends with a NUL.
static inline leafless_sink leafless_to_file(const char *path) {
    leafless_sink sink = LEAFLESS_INIT(leafless_sink);
    sink.path = path;
    sink.path_length = path ? strlen(path) : 1;
    return sink;
}

/// To a buffer; `bytes` is NULL and `capacity` 0 to ask for the length only.
static inline leafless_sink leafless_to_buffer(uint8_t *bytes, uint64_t capacity, uint64_t *length) {
    leafless_sink sink = LEAFLESS_INIT(leafless_sink);
    sink.bytes = bytes;
    sink.capacity = capacity;
    sink.length = length;
    return sink;
}

/// To a function, which is called with `ctx`.
static inline leafless_sink leafless_to_function(leafless_write_fn write, void *ctx) {
    leafless_sink sink = LEAFLESS_INIT(leafless_sink);
    sink.write = write;
    sink.write_ctx = ctx;
    return sink;
}

/* ---- 7. Meshes ---------------------------------------------------------------------------------------- */

/// Which points a surface encloses.
///
/// The winding number of a surface at a point is the solid angle at which it is seen from there, over 4π,
/// counted positive where the inner side is seen. Of a closed surface it is an integer. Where a surface has
/// holes, fins, or triangles turned over, it is a fraction, and the nearest integer decides by convention: a
/// hole is closed by the surface from which half of all directions lead out.
LEAFLESS_ENUM(leafless_fill, uint32_t) {
    /// Points whose winding number is at least 1/2 in magnitude: overlapping bodies are united, and a body
    /// that is inside out is a body.
    LEAFLESS_FILL_NON_ZERO = 0,
    /// Points from which a ray crosses the surface an odd number of times: the overlap of two bodies is
    /// outside. Orientation does not matter. An even number of triangles must meet on every edge.
    LEAFLESS_FILL_EVEN_ODD = 1,
    /// Points whose winding number is at least 1/2: a body that is inside out is a cavity, and takes away
    /// from bodies that it overlaps.
    LEAFLESS_FILL_POSITIVE = 2,
};

/// What was found while a mesh was taken in, and how its triangles hang together.
typedef struct leafless_mesh_report {
    uint32_t struct_size;  ///< sizeof(leafless_mesh_report).
    uint64_t facets_read;  ///< Triangles that were handed in: triangles + degenerate.
    uint64_t triangles;  ///< Triangles of the mesh.
    uint64_t vertices;  ///< Vertices of the mesh, all at different places.
    uint64_t welded;  ///< Vertices that were handed in and lay on an earlier one.
    uint64_t degenerate;  ///< Triangles that were dropped because two of their corners lie at one place.
    /// Edges that an odd number of triangles use. A mesh is closed if there is none.
    uint64_t boundary_edges;
    /// Loops of these edges, without vertices that occur twice: the holes of the surface and the rims of
    /// sheets.
    uint64_t boundary_loops;
    /// Edges that an even number of triangles use, but not half of them in each direction. A closed mesh is
    /// consistently oriented if there is none.
    uint64_t misoriented_edges;
    /// Edges that more than two triangles use, for instance where two bodies touch. They do no harm.
    uint64_t non_manifold_edges;
    /// Triangles that repeat an earlier one, in the same direction. They count as often as they occur.
    uint64_t duplicate;
    /// Pairs of triangles with the same corners in opposite directions: walls without thickness. The two
    /// cancel each other.
    uint64_t opposite;
    uint64_t flat;  ///< Triangles without area whose corners are three different vertices. They do no harm.
    /// Sets of triangles that hang together over edges. Bodies that touch only in single vertices count
    /// separately, and so does the outer from the inner surface of a hollow body.
    uint64_t bodies;
    uint64_t open_bodies;  ///< Bodies that are open or not consistently oriented.
    /// Other bodies that enclose a negative volume: cavities, and bodies that are inside out.
    uint64_t inside_out_bodies;
    uint64_t sewn;  ///< Vertices that leafless_mesh_sewn moved onto another one.
    /// The farthest that any of them was moved along an axis, in model units. (A stated deviation is not in
    /// it.)
    double displacement_model;
    /// Closed bodies that are proven to overlap another one: their surfaces cross, or one lies within the
    /// other with the same sense and no cavity between them. There the surface winds around points more than
    /// once, and leafless_mesh_volume is not what a fill rule encloses.
    uint64_t overlapping_bodies;
    /// Other closed bodies that may overlap another one: they touch in a way that is not decided, such as a
    /// peg that fits its hole exactly, or there was too much to look at.
    uint64_t undecided_bodies;
    /// Faces of more than three corners that the triangles were made from: of OBJ, PLY and OFF files and of
    /// polyhedra. 0 for other meshes.
    uint64_t polygons;
    /// Those that are not flat: corners lie beside the face's plane, by more than 2^-40 of its extent. Such a
    /// face has no shape of its own. The mesh is one of its triangulations, and whatever is proven of the
    /// mesh is proven of that one.
    uint64_t bent_polygons;
    /// Half the distance, in model units and up to rounding, between the two planes parallel to a face that
    /// have all its corners between them, for the face where it is greatest. Each triangulation of the face
    /// lies between the planes.
    double polygon_deviation_model;
    uint64_t edges;  ///< Edges, each counted once.
    /// V - E + F of the vertices that triangles use, the edges and the triangles: of a 2-manifold, 2 for each
    /// component less 2 for each of its handles.
    int64_t euler_characteristic;
    /// Whether the mesh is closed and consistently oriented: every edge is run along as often in one
    /// direction as in the other. (An empty mesh is.)
    bool is_closed;
    /// Whether exactly two triangles meet on every edge, which run along it in opposite directions.
    bool is_manifold;
} leafless_mesh_report;

/// What is wrong with a part of a mesh, the most harmful first.
LEAFLESS_ENUM(leafless_defect, uint32_t) {
    /// A loop of edges that an odd number of triangles use: around a hole, or around a sheet.
    LEAFLESS_DEFECT_HOLE = 0,
    /// Edges that an even number of triangles use, but not half of them in each direction.
    LEAFLESS_DEFECT_MISORIENTED = 1,
    /// Triangles with the same corners as an earlier one, in the same or the opposite direction.
    LEAFLESS_DEFECT_DUPLICATE = 2,
    LEAFLESS_DEFECT_NON_MANIFOLD = 3,  ///< Edges that more than two triangles use. They do no harm.
    LEAFLESS_DEFECT_FLAT = 4,  ///< Triangles without area. They do no harm.
};

/// A part of a mesh that is not as it should be: one loop of a hole, or, of the other kinds, edges or
/// triangles that hang together over common vertices.
typedef struct leafless_mesh_defect {
    double min_model[3];  ///< The least coordinates of all its vertices.
    double max_model[3];  ///< The greatest coordinates of all its vertices.
    double length_model;  ///< The edges' lengths, added up; 0 where triangles are counted.
    uint64_t count;  ///< Edges; or triangles of LEAFLESS_DEFECT_DUPLICATE and LEAFLESS_DEFECT_FLAT.
    leafless_defect kind;  ///< What is wrong.
} leafless_mesh_defect;

/// One more reference to a mesh.
///
/// - Buffers: `mesh`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `mesh`.
/// - Ownership: give each reference back with leafless_mesh_free.
leafless_status leafless_mesh_ref(const leafless_mesh *mesh, leafless_mesh **reference);

/// Gives back a reference to a mesh; with the last one the mesh is gone. Solids made of it stay.
///
/// - Buffers: `mesh`, a handle or NULL, which does nothing.
/// - Ownership: the reference is gone.
/// - Threads: any; no other call may use this reference.
void leafless_mesh_free(leafless_mesh *mesh);

/// What can be said of a mesh at once.
typedef struct leafless_mesh_info {
    uint32_t struct_size;  ///< sizeof(leafless_mesh_info).
    /// Attributes that its triangles bear: leafless_mesh_peek_attribute_at tells of each.
    uint32_t attributes;
    uint64_t vertices;  ///< Vertices.
    uint64_t triangles;  ///< Triangles.
    /// Bytes of memory that it keeps: its arrays and attributes, and what was found out about its edges if
    /// somebody asked. What meshes and solids share counts for each of them.
    uint64_t bytes;
    /// How far the true boundary may lie from the mesh: what leafless_mesh_with_deviation stated of it.
    double deviation_model;
    /// How far it may lie from the mesh along an axis: the deviation, what vertices were moved by to close
    /// hair cracks, and what a placement rounded.
    double displacement_model;
} leafless_mesh_info;

/// What can be said of a mesh at once. O(1), but for the names of attributes.
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
leafless_status leafless_mesh_describe(const leafless_mesh *mesh, leafless_mesh_info *info);

/// Copies the arrays of a mesh; leafless_mesh_describe tells their lengths.
///
/// - Buffers: `vertices`, room for `vertex_capacity` vertices of 3 numbers; `triangles`, room for
///   `triangle_capacity` triangles of 3 indices. Each may be NULL if it is not wanted.
/// - Result: both arrays.
/// - Errors: LEAFLESS_E_BUFFER if a capacity is too small; then neither is written.
leafless_status leafless_mesh_copy(const leafless_mesh *mesh, double *vertices, uint64_t vertex_capacity,
    uint32_t *triangles, uint64_t triangle_capacity);

/// The unit normals at the vertices of a mesh, outward where triangles turn counter-clockwise as seen from
/// outside: the mean of the normals of the triangles there, each weighted by its angle. So they do not depend
/// on how plane parts are cut into triangles. Where the mean is zero, as at a vertex without triangles, so is
/// the normal. O(t + v).
///
/// - Buffers: `normals`, room for `capacity` normals of 3 numbers, or NULL to ask for their number only;
///   `count`, one number.
/// - Result: `*count`, that of the vertices; the normals, in the order of the vertices.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_NO_MEMORY.
/// - Threads: any. Each call computes them.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_normals(const leafless_mesh *mesh, double *normals, uint64_t capacity,
    uint64_t *count);

/// The bounding box of a mesh's triangles.
///
/// - Buffers: `min_model` and `max_model`, room for 3 numbers each.
/// - Result: both corners.
/// - Errors: LEAFLESS_E_MESH if the mesh has no triangle.
leafless_status leafless_mesh_bounds(const leafless_mesh *mesh, double min_model[3], double max_model[3]);

/// The volume that a mesh encloses, by the divergence theorem: overlaps count twice, bodies that are inside
/// out negative. Of an open mesh it has no meaning. Rounded; the certified volume is that of an octree.
///
/// - Buffers: `volume_model`, one number.
/// - Result: `*volume_model`, in cubic model units.
leafless_status leafless_mesh_volume(const leafless_mesh *mesh, double *volume_model);

/// The sum of the areas of a mesh's triangles. Rounded; the certified area of a solid's boundary is told by
/// leafless_solid_surface_area. O(t).
///
/// - Buffers: `area_model`, one number.
/// - Result: `*area_model`, in square model units.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_area(const leafless_mesh *mesh, double *area_model);

/// What was found when a mesh was made, and how its triangles hang together. The first call analyses the
/// edges and looks for bodies that overlap, later ones are free.
///
/// - Buffers: `report`, one struct.
/// - Result: `*report`.
/// - Errors: LEAFLESS_E_NO_MEMORY.
leafless_status leafless_mesh_inspect(const leafless_mesh *mesh, leafless_mesh_report *report);

/// Where a mesh is not as it should be, the worst first: in the order of leafless_defect, and those of one
/// kind by the longest side of their boxes, then by count, then by position.
///
/// - Buffers: `defects`, room for `capacity` of them, or NULL to ask for their number only.
/// - Result: `*count`, how many there are, but not more than `limit`; the worst ones in `defects`.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_NO_MEMORY.
/// - Threads: any. Each call analyses the mesh.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_defects(const leafless_mesh *mesh, uint64_t limit,
    leafless_mesh_defect *defects, uint64_t capacity, uint64_t *count);

/// Checks that a mesh has no hole, so that every point that is not on it is clearly inside or outside: an
/// even number of triangles meet on every edge, and but for LEAFLESS_FILL_EVEN_ODD half of them run in each
/// direction. Self-intersections, overlaps, nested and inside-out bodies are all allowed. Solids need not
/// pass this.
///
/// - Buffers: none. `fill` is a leafless_fill.
/// - Result: LEAFLESS_OK if it is so.
/// - Errors: LEAFLESS_E_MESH if the mesh is empty, not closed, or (but for LEAFLESS_FILL_EVEN_ODD) not
///   consistently oriented; LEAFLESS_E_ARGUMENT if `fill` is no leafless_fill; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_check_closed(const leafless_mesh *mesh, leafless_fill fill);

/// The mesh with hair cracks closed: vertices at open edges become one if they lie no further apart than
/// 2^-24 of the longest extent of the larger one of their pieces. (A piece is all triangles that hang
/// together by common vertices.) Verdicts about solids made of it stay proven: the distance is added outward.
///
/// - Buffers: `sewn`, one pointer.
/// - Result: `*sewn`; leafless_mesh_inspect tells how many vertices moved and how far.
/// - Errors: LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` stays as it is; give `*sewn` back with leafless_mesh_free.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_sewn(const leafless_mesh *mesh, leafless_mesh **sewn);

/// The same mesh, of which it is known only that the true boundary lies within a distance of it, as the
/// boundary of a part lies beside a tessellation with that deflection. It takes the place of a deviation that
/// was stated before.
///
/// The true solid is bounded by the mesh's surface, of which each point was moved by that distance at the
/// most, continuously, and no part of which was turned over. A dent, a hole or a body that the mesh does not
/// have at all is not covered, however small it is. Whatever is proven of solids made of the mesh is then
/// proven of the true solid: cells near to the triangles are undecided, intervals contain the truth, and
/// nothing is told of a point that is too near. The area of the true boundary is not known. Placements and
/// set operations carry the deviation along, and leafless_proof tells it. What is no proof, as a sampled
/// octree, a tri-dexel model, a picture, leafless_mesh_bounds and leafless_mesh_volume, is that of the mesh.
///
/// - Buffers: `stated`, one pointer.
/// - Result: `*stated`; leafless_mesh_describe tells its deviation. A solid of it needs a closed mesh, and is
///   refused with LEAFLESS_E_MESH otherwise.
/// - Errors: LEAFLESS_E_ARGUMENT unless `deviation_model` is finite, not negative, and at most 2^256;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` stays as it is; give `*stated` back with leafless_mesh_free.
/// - Untrusted input: any number.
leafless_status leafless_mesh_with_deviation(const leafless_mesh *mesh, double deviation_model,
    leafless_mesh **stated);

/// The mesh under an affine map: x' = M x + t, rounded. A reflection turns it inside out. The moved vertices
/// count as the truth, whatever cracks were closed before, and whatever deviation was stated:
/// leafless_solid_placed keeps both.
///
/// - Buffers: `matrix`, 12 numbers: three rows of M and t, (m00 m01 m02 t0, m10 …); `moved`, one pointer.
/// - Result: `*moved`, welded as by leafless_mesh_new.
/// - Errors: LEAFLESS_E_ARGUMENT if a number of the matrix is not finite; LEAFLESS_E_MESH if a vertex leaves
///   ±2^256; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` stays as it is; give `*moved` back with leafless_mesh_free.
/// - Untrusted input: any numbers.
leafless_status leafless_mesh_transformed(const leafless_mesh *mesh, const double matrix[12],
    leafless_mesh **moved);

/// The mesh moved by a vector, rounded. What leafless_mesh_sewn has found stays known, and so does a
/// deviation.
///
/// - Buffers: `offset_model`, 3 numbers; `moved`, one pointer.
/// - Result: `*moved`.
/// - Errors: LEAFLESS_E_ARGUMENT if a number of the offset is not finite; LEAFLESS_E_MESH if a vertex leaves
///   ±2^256; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` stays as it is; give `*moved` back with leafless_mesh_free.
/// - Untrusted input: any numbers.
leafless_status leafless_mesh_translated(const leafless_mesh *mesh, const double offset_model[3],
    leafless_mesh **moved);

/// What the coordinates of vertices are.
LEAFLESS_ENUM(leafless_vertex_type, uint32_t) {
    LEAFLESS_VERTEX_TYPE_F64 = 0,  ///< double.
    LEAFLESS_VERTEX_TYPE_F32 = 1,  ///< float.
};

/// What the indices of vertices are.
LEAFLESS_ENUM(leafless_index_type, uint32_t) {
    LEAFLESS_INDEX_TYPE_U32 = 0,  ///< uint32_t.
    LEAFLESS_INDEX_TYPE_U64 = 1,  ///< uint64_t.
    LEAFLESS_INDEX_TYPE_U16 = 2,  ///< uint16_t.
};

/// The arrays that a mesh is made of: vertices of three coordinates, and triangles of three indices. They
/// need not be aligned, and may lie among other data, such as normals, which are not read. All fields but the
/// first may be zero, which is their default.
typedef struct leafless_mesh_arrays {
    uint32_t struct_size;  ///< sizeof(leafless_mesh_arrays).
    leafless_vertex_type vertex_type;  ///< A leafless_vertex_type.
    const void *vertices;  ///< The first vertex. May be NULL if there is none.
    uint64_t vertex_count;  ///< Number of vertices.
    /// Bytes from one vertex to the next; 0 means that they follow each other without a gap.
    uint64_t vertex_stride;
    /// The first triangle: three indices, counted from 0. NULL if there is none, or if every three vertices
    /// are one.
    const void *indices;
    /// Number of triangles. Where every three vertices are one, this must be a third of `vertex_count`.
    uint64_t triangle_count;
    /// Bytes from one triangle to the next; 0 means that they follow each other without a gap.
    uint64_t triangle_stride;
    leafless_index_type index_type;  ///< A leafless_index_type.
    /// What the coordinates are multiplied by to become model units: 2^-256 to 2^256, or 0, which means 1.
    double scale;
} leafless_mesh_arrays;

/// Makes a mesh of arrays. Equal vertices are welded, triangles with two corners at one place dropped and
/// counted; coordinates below 2^-256 count as zero. Seen from outside of the solid the corners turn
/// counter-clockwise.
///
/// - Buffers: `arrays`, one struct; what its pointers lead to must not change during the call. `mesh`, one
///   pointer.
/// - Result: `*mesh`; not checked to be closed.
/// - Errors: LEAFLESS_E_MESH if a coordinate is infinite, not a number, or beyond ±2^256, or if an index is
///   out of range, with the index of the vertex or triangle in the message, or if there are more than 2^32 -
///   1 vertices or triangles; LEAFLESS_E_ARGUMENT if a type, a stride or the scale is none, or `indices` NULL
///   though there are triangles and not three vertices for each; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the arrays are only read during the call, once and in their order, and may be freed after it:
///   the mesh has its own. Give `*mesh` back with leafless_mesh_free.
/// - Untrusted input: any values in the arrays.
leafless_status leafless_mesh_new(const leafless_mesh_arrays *arrays, leafless_mesh **mesh);

/// Solids that plane faces bound, as boundary representations have them: solids of shells of faces of loops
/// of corners.
///
/// Each level is an array of offsets into the level below, one more than there are parts: part k goes from
/// offset k up to, but not including, offset k + 1. So each array begins with 0, rises, and ends at the
/// number of parts below. Loops turn counter-clockwise as seen from outside of the solid's material, and
/// holes of a face against its outer loop. Corners and offsets are of one type, without gaps, and need not be
/// aligned. All fields but the first may be zero, which is their default.
typedef struct leafless_polyhedron_arrays {
    uint32_t struct_size;  ///< sizeof(leafless_polyhedron_arrays).
    leafless_vertex_type vertex_type;  ///< A leafless_vertex_type.
    const void *vertices;  ///< The first vertex: three coordinates. May be NULL if there is none.
    uint64_t vertex_count;  ///< Number of vertices.
    /// Bytes from one vertex to the next; 0 means that they follow each other without a gap.
    uint64_t vertex_stride;
    /// The corners of all loops, one loop behind the other: indices of vertices, counted from 0.
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
    leafless_index_type index_type;  ///< A leafless_index_type: that of corners and offsets.
    /// What the coordinates are multiplied by to become model units: 2^-256 to 2^256, or 0, which means 1.
    double scale;
    /// How far corners may lie beside the plane of their face, in model units: half the distance of two
    /// planes parallel to the face that have all its corners between them. 0 means 10^-9 of the longest
    /// extent.
    double tolerance_model;
} leafless_polyhedron_arrays;

/// Checks solids of plane faces and makes a closed, consistently oriented mesh of them. Where a face is not
/// plane to the last digit, its triangles say from then on where the surface is.
///
/// Each edge of a loop is run through once more in its shell, in the opposite direction; vertices at one
/// place are two vertices there, so that shells may touch. The first shell of a solid encloses a positive
/// volume, its voids negative ones within it. Faces that cut through each other and solids that overlap are
/// let through: a mesh has a meaning for them.
///
/// - Buffers: `arrays`, one struct; what its pointers lead to must not change during the call.
///   `deviation_model`, one number, or NULL if it is not wanted; `mesh`, one pointer.
/// - Result: `*mesh`, with the attributes `face`, `shell` and `solid` (leafless_mesh_peek_attribute_at): the
///   numbers of the parts that each triangle belongs to; `*deviation_model`, how far a corner lies beside the
///   plane of its face at most.
/// - Errors: LEAFLESS_E_MESH, with the numbers of loop, face, shell or vertices in the message, if the arrays
///   are not such solids, if a coordinate is infinite, not a number, or beyond ±2^256, if there is no solid,
///   or if there are more than 2^32 - 1 of anything; LEAFLESS_E_ARGUMENT if a type, a stride, the scale or
///   the tolerance is none; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the arrays are only read during the call, and may be freed after it; give `*mesh` back with
///   leafless_mesh_free.
/// - Untrusted input: any values in the arrays.
leafless_status leafless_mesh_from_polyhedron(const leafless_polyhedron_arrays *arrays,
    double *deviation_model, leafless_mesh **mesh);

/// Whether the moments of what a mesh encloses are known from its triangles.
LEAFLESS_ENUM(leafless_moments_verdict, uint32_t) {
    LEAFLESS_MOMENTS_VERDICT_KNOWN = 0,  ///< They are, up to rounding and to the mesh's displacement.
    /// They are not: the mesh is empty, not closed, or not consistently oriented as the fill rule demands.
    LEAFLESS_MOMENTS_VERDICT_OPEN = 1,
    /// They are not: too many triangles lie close to each other to find out, or all triangles of a body are
    /// slivers.
    LEAFLESS_MOMENTS_VERDICT_UNDECIDED = 2,
    LEAFLESS_MOMENTS_VERDICT_INTERSECTING = 3,  ///< They are not: two triangles intersect.
};

/// Mass properties of what a mesh encloses, of density 1, as in leafless_measures: all numbers unless they
/// are known.
typedef struct leafless_mesh_moments {
    uint32_t struct_size;  ///< sizeof(leafless_mesh_moments).
    leafless_interval volume_model;  ///< Volume.
    leafless_interval centroid_model[3];  ///< Centroid; all numbers unless `has_centroid`.
    leafless_interval inertia_origin_model[9];  ///< Tensor of inertia about the model's origin, row by row.
    leafless_interval inertia_centroid_model[9];  ///< The same about the centroid.
    uint32_t triangles[2];  ///< Two triangles that intersect, if `known` says so; else 0.
    leafless_moments_verdict known;  ///< Whether they are known, or why not.
    bool has_centroid;  ///< Whether the volume is proven not to be 0.
} leafless_mesh_moments;

/// Two triangles that have a point in common which is not on a common vertex or edge.
typedef struct leafless_intersecting_pair {
    double min_model[3];  ///< A box in which they meet: where the boxes around the two overlap.
    double max_model[3];  ///< Its upper corner.
    uint32_t triangles[2];  ///< Indices of the triangles, ascending.
} leafless_intersecting_pair;

/// The volume and the moments of what a mesh encloses by a fill rule, exact up to rounding: usually to 14
/// digits. They are known if the mesh is closed and no two triangles intersect. leafless_solid_measure of a
/// solid of such a mesh tells the same.
///
/// - Buffers: `options`, one struct or NULL, of which the limits do not matter; `moments`, one struct. `fill`
///   is a leafless_fill.
/// - Result: `*moments`, whether they are known or not.
/// - Errors: LEAFLESS_E_ARGUMENT if `fill` is no leafless_fill; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Threads: any; works in the calling thread. Each call analyses the mesh.
/// - Untrusted input: any mesh; the work is limited.
leafless_status leafless_mesh_measure(const leafless_mesh *mesh, leafless_fill fill,
    const leafless_options *options, leafless_mesh_moments *moments);

/// The pairs of triangles that intersect: they cross, touch, or fold onto each other. Decided exactly.
/// Triangles without area are left out.
///
/// - Buffers: `options`, one struct or NULL, of which the limits do not matter; `pairs`, room for `capacity`
///   of them, or NULL to ask for their number only; `count`, one number; `is_complete`, one number.
/// - Result: `*count`, how many were found; the first `capacity` of them in `pairs`, in ascending order of
///   triangles; `*is_complete`, whether these are all: else the search was ended, because too many triangles
///   lie close to each other.
/// - Errors: LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY. A `capacity` that is too small is none.
/// - Threads: any; works in the calling thread. Each call analyses the mesh.
/// - Untrusted input: any mesh; the work is limited.
leafless_status leafless_mesh_intersecting_pairs(const leafless_mesh *mesh, const leafless_options *options,
    leafless_intersecting_pair *pairs, uint64_t capacity, uint64_t *count, bool *is_complete);

/* ---- 8. Mesh files ------------------------------------------------------------------------------------ */

/// The formats of mesh files, which can be read and written.
LEAFLESS_ENUM(leafless_mesh_format, uint32_t) {
    /// To be found out: when reading from the file's content and, where that is not clear, its name; when
    /// writing from its name.
    LEAFLESS_MESH_FORMAT_ANY = 0,
    LEAFLESS_MESH_FORMAT_STL = 1,  ///< STL, binary or ASCII; which of the two is always found out.
    LEAFLESS_MESH_FORMAT_OBJ = 2,  ///< Wavefront OBJ.
    LEAFLESS_MESH_FORMAT_PLY = 3,  ///< Stanford PLY, binary or ASCII.
    LEAFLESS_MESH_FORMAT_OFF = 4,  ///< Geomview OFF.
    /// 3MF, the 3D Manufacturing Format. What it means by its surfaces is LEAFLESS_FILL_POSITIVE.
    LEAFLESS_MESH_FORMAT_3MF = 5,
};

/// Units of length. Coordinates have none: what an unknown unit means is up to the host.
LEAFLESS_ENUM(leafless_unit, uint32_t) {
    LEAFLESS_UNIT_UNKNOWN = 0,  ///< Not known.
    LEAFLESS_UNIT_MICROMETRE = 1,  ///< 1/1000 of a millimetre.
    LEAFLESS_UNIT_MILLIMETRE = 2,  ///< The millimetre.
    LEAFLESS_UNIT_CENTIMETRE = 3,  ///< 10 millimetres.
    LEAFLESS_UNIT_METRE = 4,  ///< 1000 millimetres.
    LEAFLESS_UNIT_INCH = 5,  ///< 25.4 millimetres.
    LEAFLESS_UNIT_FOOT = 6,  ///< 12 inches.
};

/// How a mesh file is to be taken. NULL means the defaults. All fields but the first may be zero, which is
/// their default.
typedef struct leafless_mesh_options {
    uint32_t struct_size;  ///< sizeof(leafless_mesh_options).
    leafless_mesh_format format;  ///< The file's format.
    /// The unit of the numbers in the file. LEAFLESS_UNIT_UNKNOWN means what the file says, which only a 3MF
    /// does; anything else overrides that.
    leafless_unit unit;
    /// The unit that the mesh shall have. LEAFLESS_UNIT_UNKNOWN means that of the file.
    leafless_unit target;
    double scale;  ///< What all coordinates are multiplied by besides: 2^-256 to 2^256, or 0, which means 1.
} leafless_mesh_options;

/// What a mesh file says besides the mesh.
typedef struct leafless_mesh_file_info {
    uint32_t struct_size;  ///< sizeof(leafless_mesh_file_info).
    leafless_mesh_format format;  ///< The file's format.
    leafless_unit unit;  ///< The unit of the mesh, converted but not scaled, if it is known.
    /// Instances of objects that are not meant to be solid, such as supports in a 3MF, and that the mesh does
    /// not contain.
    uint64_t skipped;
    /// How far, as the file says, the true boundary may lie from the mesh, converted and scaled; 0 if it does
    /// not say so. It is not believed: leafless_mesh_with_deviation states it, for who does.
    double deviation_model;
} leafless_mesh_file_info;

/// Reads a mesh file. Everything in it becomes one mesh, welded as by leafless_mesh_new; polygons become
/// triangles. Hair cracks, which files have because their numbers are rounded, are closed as by
/// leafless_mesh_sewn; leafless_mesh_inspect tells how many vertices moved and how far. Of bytes no name is
/// known that could tell the format.
///
/// - Buffers: `source`, one struct, with LEAFLESS_ACCESS_COPY; `options`, one struct, or NULL; `found`, one
///   struct, or NULL if it is not wanted; `mesh`, one pointer.
/// - Result: `*mesh`, not checked to be closed; `*found`. leafless_mesh_peek_warning_at tells where the file
///   departs from its format, though it could be read.
/// - Errors: LEAFLESS_E_MESH_FILE, with the part, line, facet or byte in the message, if the file cannot be
///   read, if its format is not known, or if `target` is given and nobody says from which unit;
///   LEAFLESS_E_MESH, with the vertex, if a coordinate is beyond ±2^256 once it is scaled;
///   LEAFLESS_E_ARGUMENT if the format or a unit is none, or the scale out of range; LEAFLESS_E_IO;
///   LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*mesh` back with leafless_mesh_free.
/// - Untrusted input: any file. Memory is at most a small multiple of its length; of a 3MF, which is
///   compressed, of 64 times its length and 16 MiB, and its instances may come to 2^25 vertices and 2^25
///   triangles, or to as many as the file has.
leafless_status leafless_mesh_read(const leafless_source *source, const leafless_mesh_options *options,
    leafless_mesh_file_info *found, leafless_mesh **mesh);

/// What a mesh file departs from its format in, though it could be read: a sentence in UTF-8 for each kind of
/// departure, by its place among all. A mesh that was not read from a file, or was made from another mesh,
/// has none.
///
/// - Buffers: `count`, one number; `warning`, `warning_length`, one each, both NULL to ask for the count
///   only.
/// - Result: `*count`, the number of all warnings; the text, not NUL-terminated, with its length in bytes.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no warning `index`, unless only the count is asked for.
/// - Ownership: the text belongs to the mesh and lives as long as the reference `mesh`.
leafless_status leafless_mesh_peek_warning_at(const leafless_mesh *mesh, uint64_t index, uint64_t *count,
    const char **warning, size_t *warning_length);

/// How a mesh file is written. NULL means the defaults. All fields but the first may be zero, which is their
/// default.
typedef struct leafless_mesh_write_options {
    uint32_t struct_size;  ///< sizeof(leafless_mesh_write_options).
    /// The file's format. LEAFLESS_MESH_FORMAT_ANY means what the extension of the path says: .stl, .obj,
    /// .ply, .off or .3mf, in any letter case.
    leafless_mesh_format format;
    /// 1 to write STL and PLY as text, which is several times as long; OBJ and OFF always are text, and a 3MF
    /// never is. Else 0.
    uint32_t is_text;
    /// The unit of the coordinates, which only a 3MF tells. LEAFLESS_UNIT_UNKNOWN means the millimetre.
    /// Nothing is converted.
    leafless_unit unit;
    /// 1 to write PLY and OBJ with the normals that leafless_mesh_normals tells; other formats have none.
    /// Else 0.
    uint32_t has_normals;
    /// How far the true boundary may lie from the mesh, which a comment of PLY, OBJ and OFF and metadata of a
    /// 3MF tell; an STL has no place for it. leafless_mesh_file_info has it when the file is read. 0 tells
    /// nothing.
    double deviation_model;
} leafless_mesh_write_options;

/// Writes a mesh file: STL, PLY, OBJ, OFF or 3MF.
///
/// Vertices and triangles keep their order. PLY (little-endian, of type double), OBJ and OFF hold the
/// coordinates exactly; a 3MF has one object, which is the build's one item, and leaves out triangles that
/// have a vertex twice. STL rounds coordinates to 32 bits without a word: what is small and far away loses
/// triangles, up to all of them. leafless_mesh_written_form tells before, and
/// leafless_mesh_in_single_precision mends what can be mended. O(n) time and memory.
///
/// - Buffers: `options`, one struct, or NULL, with a format unless the sink has a path; `sink`, one struct.
/// - Errors: LEAFLESS_E_ARGUMENT if the format or the unit is none, if the format is LEAFLESS_MESH_FORMAT_ANY
///   and there is no path or it has none of the extensions, for an STL of coordinates beyond the range of
///   float, or for an OBJ without vertices; LEAFLESS_E_IO; LEAFLESS_E_CALLBACK; LEAFLESS_E_BUFFER;
///   LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_write(const leafless_mesh *mesh, const leafless_mesh_write_options *options,
    const leafless_sink *sink);

/// What became of a mesh in single precision.
typedef struct leafless_single_precision {
    uint32_t struct_size;  ///< sizeof(leafless_single_precision).
    uint32_t reserved;  ///< 0.
    double rounding_model;  ///< The farthest that rounding moves a vertex along an axis.
    /// No point of the given mesh is further from the other one, and none of that further from the given one:
    /// proven.
    double deviation_model;
    uint64_t collapsed;  ///< Triangles of which rounding made an edge or a point, and which are gone.
    /// Triangles of which rounding made a line, and which were joined to their neighbours.
    uint64_t flipped;
    uint64_t moved;  ///< Vertices that were moved, to places next to their nearest ones.
    uint64_t degenerate;  ///< Triangles without area that are left, and vertices that lie where others do.
    uint64_t intersecting_pairs;  ///< Pairs of triangles that intersect each other and are left.
} leafless_single_precision;

/// The mesh with coordinates that are 32-bit numbers, as an STL has them, without triangles that rounding
/// makes degenerate and without pairs that it makes intersect, as far as that can be had: leafless_mesh_write
/// then loses nothing. Edges whose ends meet are collapsed, triangles that become lines are joined to their
/// neighbours, and vertices of what is degenerate or intersects after that go to places next to theirs, if
/// these are no further than `tolerance_model` from where they were given. A closed mesh stays closed. A mesh
/// whose coordinates are 32-bit numbers already is given back as it is, and of it nothing is counted.
///
/// Time is that of leafless_mesh_intersecting_pairs, a few times.
///
/// - Buffers: `options`, one struct or NULL; `report`, one struct, or NULL if it is not wanted; `single`, one
///   pointer.
/// - Result: `*single`, without attributes; `*report`.
/// - Errors: LEAFLESS_E_ARGUMENT if the tolerance is negative or not a number, or for coordinates beyond the
///   range of float; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` stays as it is; give `*single` back with leafless_mesh_free.
/// - Untrusted input: any mesh; the work is bounded.
leafless_status leafless_mesh_in_single_precision(const leafless_mesh *mesh, double tolerance_model,
    const leafless_options *options, leafless_single_precision *report, leafless_mesh **single);

/// Writes solids of plane faces as a file of polygons: OBJ or OFF. A face with holes, which these formats do
/// not have, is cut into a few polygons without; all other faces are as they are given. No vertex is added,
/// and vertices keep their order.
///
/// The faces are checked as leafless_mesh_from_polyhedron does, whose default tolerance is the only one here.
/// O(n log n) time.
///
/// - Buffers: `arrays`, one struct, whose `tolerance_model` is 0; what its pointers lead to must not change
///   during the call. `options`, one struct, or NULL, of which the format and the deviation count, with a
///   format unless the sink has a path; `sink`, one struct.
/// - Errors: those of leafless_mesh_from_polyhedron; LEAFLESS_E_ARGUMENT if the format is neither OBJ nor
///   OFF, or is LEAFLESS_MESH_FORMAT_ANY and there is no path or it has none of the extensions;
///   LEAFLESS_E_IO; LEAFLESS_E_CALLBACK; LEAFLESS_E_BUFFER; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the arrays are only read during the call, and may be freed after it.
/// - Untrusted input: any values in the arrays.
leafless_status leafless_mesh_write_polygons(const leafless_polyhedron_arrays *arrays,
    const leafless_mesh_write_options *options, const leafless_sink *sink);

/// The mesh that a reader gets back from the file that leafless_mesh_write writes. An STL has 32-bit
/// coordinates: vertices move, vertices that meet are one, and triangles of which two corners meet are
/// dropped, so that the surface may be pinched, flat or gone. leafless_mesh_inspect of both meshes tells. All
/// other formats keep vertices and triangles as they are. O(n) time and memory.
///
/// - Buffers: `options`, one struct, with a format; `kept`, one pointer.
/// - Result: `*kept`.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_mesh_write without a path; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` stays as it is; give `*kept` back with leafless_mesh_free.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_written_form(const leafless_mesh *mesh,
    const leafless_mesh_write_options *options, leafless_mesh **kept);

/* ---- 9. Solids ---------------------------------------------------------------------------------------- */

/// What is made of several operands.
LEAFLESS_ENUM(leafless_operation, uint32_t) {
    LEAFLESS_OPERATION_UNION = 0,  ///< The points of at least one operand.
    LEAFLESS_OPERATION_INTERSECTION = 1,  ///< The points that all operands have in common.
    LEAFLESS_OPERATION_DIFFERENCE = 2,  ///< The points of the first operand that lie in none of the others.
    LEAFLESS_OPERATION_XOR = 3,  ///< The points that lie in an odd number of operands: of two, in just one.
};

/// What a mesh encloses. On a frame whose universe it reaches beyond it is clipped by that.
///
/// Where the mesh is closed, what it encloses is exact. Around holes leafless_fill says by which convention a
/// point is inside: a cell is FULL or EMPTY if that is proven for all of its points, and others are PARTIAL
/// though no triangle cuts them. leafless_mesh_inspect tells whether to expect them.
///
/// Rays, points, boxes and distances are told without cells: in some microseconds each. A mesh with holes
/// looks at all edges of its holes for a question, which takes some nanoseconds an edge, and asks its cells
/// of rays that come very near to such an edge, of distances and boxes next to a hole, and of all but points
/// if there are more than 16384 edges. The first such question makes what that takes, and the solid keeps it:
/// a tree over the triangles (O(t log t): 0.1 to 0.3 microseconds a triangle; 36 bytes a triangle, which
/// leafless_solid_info tells), and for distances of a closed mesh, on which sides of its triangles the solid
/// lies (about twice that time, and 1 byte), or the edges of holes (48 bytes an edge). So ask one question
/// beforehand if the first is not to take longer than others. Placed solids take over the order of the tree,
/// and make its boxes anew. Threads that ask first at the same time may each make it once.
///
/// - Buffers: `solid`, one pointer. `fill` is a leafless_fill.
/// - Result: `*solid`. Time is linear in the mesh (n log n in the edges of its boundary).
/// - Errors: LEAFLESS_E_MESH if the mesh is empty, or (LEAFLESS_FILL_EVEN_ODD) an odd number of triangles
///   meet on an edge; LEAFLESS_E_ARGUMENT if `fill` is no leafless_fill; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the solid shares the mesh, which may be freed; give `*solid` back with leafless_solid_free.
/// - Untrusted input: any mesh.
leafless_status leafless_solid_from_mesh(const leafless_mesh *mesh, leafless_fill fill,
    leafless_solid **solid);

/// A stored octree as a solid on its own universe. Built to fewer levels it is cut there, built to more its
/// PARTIAL cells stay undecided.
///
/// - Buffers: `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: only the general ones; building it returns LEAFLESS_E_DAMAGED if the octree was mapped
///   unverified and its links are damaged.
/// - Ownership: the solid shares the octree, which may be freed; give `*solid` back with leafless_solid_free.
/// - Untrusted input: any octree.
leafless_status leafless_solid_from_octree(const leafless_octree *octree, leafless_solid **solid);

/// What can be said of a solid at once.
typedef struct leafless_solid_info {
    uint32_t struct_size;  ///< sizeof(leafless_solid_info).
    /// Half-spaces that were evaluated so far, each at a point or over a box, for a solid that is made of
    /// half-spaces (see leafless_solid_new_halfspace and what follows it) and perhaps others: by calls that
    /// have returned, and by lazy octrees and the like that are given back. What else is made of the solid
    /// counts for itself. 0 for solids of other kinds.
    uint64_t evaluations;
    /// About how many bytes of memory (or of mapped files) the solid keeps alive: its own, those of the
    /// meshes, octrees and samples that it shares, and those of the last frame that it was prepared for. An
    /// expression counts each of its parts once, but two parts that share a mesh count the mesh twice.
    /// Objects of the host are not counted.
    uint64_t bytes;
} leafless_solid_info;

/// What can be said of a solid at once. O(1), but O(n) in the parts of an expression.
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
/// - Untrusted input: any solid.
leafless_status leafless_solid_describe(const leafless_solid *solid, leafless_solid_info *info);

/// One more reference to a solid.
///
/// - Buffers: `solid`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `solid`.
/// - Ownership: give each reference back with leafless_solid_free.
leafless_status leafless_solid_ref(const leafless_solid *solid, leafless_solid **reference);

/// Gives back a reference to a solid; with the last one the solid is gone. Octrees built from it stay.
///
/// - Buffers: `solid`, a handle or NULL, which does nothing.
/// - Ownership: the reference is gone.
/// - Threads: any; no other call may use this reference.
void leafless_solid_free(leafless_solid *solid);

/// What counts as touching: when a cell that meets the boundary of an expression of half-spaces, but not its
/// interior, is EMPTY.
LEAFLESS_ENUM(leafless_touch, uint32_t) {
    LEAFLESS_TOUCH_EXACT = 0,  ///< Contact is not overlap: a cell is EMPTY if the interiors are disjoint.
    /// A vertex on the surface counts as inside, so that a cell that touches a primitive with a vertex from
    /// outside is PARTIAL. It reproduces published tables and is no better for anything else.
    LEAFLESS_TOUCH_PAPER = 1,
};

/// The ball of all points at most `radius` from `centre`. Its verdicts are exact.
///
/// - Buffers: `centre_model`, 3 numbers; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if the radius is not between 2^-256 and 2^256, or a coordinate neither 0 nor
///   of such a magnitude.
/// - Ownership: give `*solid` back with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_ball(const double centre_model[3], double radius_model,
    leafless_solid **solid);

/// The box [min, max] with faces parallel to the lattice. Its verdicts are exact, so a face on a lattice
/// plane leaves nothing undecided.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if min ≥ max on an axis, or a coordinate is neither 0 nor of a magnitude
///   between 2^-256 and 2^256.
/// - Ownership: give `*solid` back with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_box(const double min_model[3], const double max_model[3],
    leafless_solid **solid);

/// The half-space of the points p with normal · p + offset ≥ 0. Its verdicts are exact.
///
/// - Buffers: `normal`, 3 numbers, of any length and pointing into the solid; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if the normal is zero, or a coefficient neither 0 nor of a magnitude between
///   2^-256 and 2^256.
/// - Ownership: give `*solid` back with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_halfspace(const double normal[3], double offset, leafless_solid **solid);

/// The points p with a x² + b y² + c z² + d xy + e yz + f zx + g x + h y + i z + j ≥ 0, of which the ten
/// coefficients are a to j. Its signs are exact.
///
/// - Buffers: `coefficients`, 10 numbers; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if all coefficients but the last are 0, or one is neither 0 nor of a
///   magnitude between 2^-256 and 2^256.
/// - Ownership: give `*solid` back with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_quadric(const double coefficients[10], leafless_solid **solid);

/// The ellipsoid around `centre` with the semi-axes `radii` along x, y and z, moved by `matrix` if there is
/// one. The surface has exact coefficients. Its verdicts are exact, too, unless `matrix` turns it.
///
/// - Buffers: `centre_model` and `radii_model`, 3 numbers each; `matrix`, 12 numbers as for
///   leafless_solid_placed, or NULL; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if a radius is not between 2^-256 and 2^256, or a coordinate neither 0 nor
///   of such a magnitude; for `matrix` as leafless_solid_placed.
/// - Ownership: give `*solid` back with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_ellipsoid(const double centre_model[3], const double radii_model[3],
    const double matrix[12], leafless_solid **solid);

/// The cylinder of `radius` around the segment between two points, with flat ends through them. The axis may
/// have any direction, and nothing is rounded: the surface has exact coefficients. If the axis is parallel to
/// x, y or z, the verdicts are exact, too.
///
/// - Buffers: `from_model` and `to_model`, 3 numbers each; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if the points are equal, the radius is not between 2^-256 and 2^256, or a
///   coordinate neither 0 nor of such a magnitude.
/// - Ownership: give `*solid` back with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_cylinder(const double from_model[3], const double to_model[3],
    double radius_model, leafless_solid **solid);

/// The frustum of a cone around the segment between two points: it has the radius `from_radius` at `from`,
/// and `to_radius` at `to`. One of the radii may be 0, which makes a cone. Exact as
/// leafless_solid_new_cylinder is.
///
/// - Buffers: `from_model` and `to_model`, 3 numbers each; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if the points are equal, if both radii are 0 or one is not between 2^-256
///   and 2^256, or a coordinate neither 0 nor of such a magnitude.
/// - Ownership: give `*solid` back with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_frustum(const double from_model[3], const double to_model[3],
    double from_radius_model, double to_radius_model, leafless_solid **solid);

/// The points p with A (x − a)^n + B (y − b)^m + C (z − c)^k + `constant` ≥ 0. Its signs are exact.
///
/// - Buffers: `coefficients` A, B, C, `centre_model` a, b, c, and `exponents` n, m, k, 3 numbers each;
///   `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if all coefficients are 0, an exponent is not 1 to 64, or a number neither 0
///   nor of a magnitude between 2^-256 and 2^256.
/// - Ownership: give `*solid` back with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_power(const double coefficients[3], const double centre_model[3],
    const uint32_t exponents[3], double constant, leafless_solid **solid);

/// The torus around the axis through `centre` in the direction `axis`, of any length: all points at most
/// `minor` from the circle of radius `major` around the centre; where `minor` is greater, there is no hollow
/// core. If the axis is parallel to x, y or z, nothing is rounded. Otherwise its direction is rounded to
/// double precision.
///
/// - Buffers: `centre_model` and `axis`, 3 numbers each; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if the axis is zero, a radius is not between 2^-256 and 2^256, or a
///   coordinate neither 0 nor of such a magnitude; `major` may be 0, which makes a ball.
/// - Ownership: give `*solid` back with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_torus(const double centre_model[3], const double axis[3],
    double major_model, double minor_model, leafless_solid **solid);

/// The right angular wedge: the box between the origin and `size` whose face at the greatest y is narrowed,
/// or widened, to 0 ≤ x ≤ `top`; 0 makes that face an edge. (So it is defined by STEP, ISO 10303-42.)
/// `matrix` moves it elsewhere without rounding.
///
/// - Buffers: `size_model`, 3 numbers; `matrix`, 12 numbers as for leafless_solid_placed, or NULL; `solid`,
///   one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if a size, or `top` unless it is 0, is not between 2^-256 and 2^256; for
///   `matrix` as leafless_solid_placed.
/// - Ownership: give `*solid` back with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_wedge(const double size_model[3], double top_model,
    const double matrix[12], leafless_solid **solid);

/// The prism over a simple polygon in the xy plane, between z = `low` and z = `high`. The polygon's corners
/// are given in order, in either direction of rotation; the last is joined to the first. The planes through
/// its edges are exact. `matrix` moves it elsewhere without rounding.
///
/// - Buffers: `polygon_model`, `count` points of 2 numbers each; `matrix`, 12 numbers as for
///   leafless_solid_placed, or NULL; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if the outline touches or crosses itself or encloses nothing, a coordinate
///   is neither 0 nor of a magnitude between 2^-256 and 2^256, or `low` not less than `high`; for `matrix` as
///   leafless_solid_placed; LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*solid` back with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_prism(const double *polygon_model, uint64_t count, double low_model,
    double high_model, const double matrix[12], leafless_solid **solid);

/// The convex polyhedron of the points p with normal · p + offset ≥ 0 for all of the planes. It may be
/// unbounded, or empty.
///
/// - Buffers: `planes`, `count` of 4 numbers each: the normal, of any length and pointing inward, and the
///   offset; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no plane, a normal is zero, or a number neither 0 nor of a
///   magnitude between 2^-256 and 2^256; LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*solid` back with leafless_solid_free.
/// - Untrusted input: any numbers.
leafless_status leafless_solid_new_convex(const double *planes, uint64_t count, leafless_solid **solid);

/// What a set operation makes of solids. Of no solid, the union and the xor are empty. The intersection of no
/// solid is everything. No tree is built: the result asks its operands about each cell that it is asked
/// about, and expressions of half-spaces join into one.
///
/// - Buffers: `solids`, `count` handles, or NULL if there is none; `result`, one pointer. `operation` is a
///   leafless_operation.
/// - Result: `*result`.
/// - Errors: LEAFLESS_E_NULL, also of an element; LEAFLESS_E_ARGUMENT, also if `count` is 0 for a difference;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: the operands are shared and may be freed; give `*result` back with leafless_solid_free.
/// - Untrusted input: any solids.
leafless_status leafless_solid_combine(leafless_operation operation, const leafless_solid *const *solids,
    uint64_t count, leafless_solid **result);

/// What `operand` does not contain. A solid and its complement share their boundary.
///
/// - Buffers: `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_NULL.
/// - Ownership: the operand is shared and may be freed; give `*solid` back with leafless_solid_free.
/// - Untrusted input: any solids.
leafless_status leafless_solid_complement(const leafless_solid *operand, leafless_solid **solid);

/// What an affine map does to a solid.
LEAFLESS_ENUM(leafless_motion, uint32_t) {
    LEAFLESS_MOTION_EXACT = 0,  ///< Nothing is rounded: half-spaces, and what is made of them.
    /// The vertices of a mesh are moved and rounded, by some 10^-16 of their coordinates; what is proven
    /// allows for that.
    LEAFLESS_MOTION_VERTICES = 1,
    /// A surface that is not parallel to the lattice blurs by about a cell: as leafless_solid_transformed
    /// does, on a frame that is chosen for the solid; a host's shape is asked about boxes around the inverse
    /// images of cells. Where cells are the images of cells, nothing blurs.
    LEAFLESS_MOTION_CONSERVATIVE = 2,
};

/// A solid moved by an affine map, in the best way that its kind knows: half-spaces exactly, meshes by their
/// vertices, others as leafless_solid_transformed; of an expression each part in its own way.
///
/// - Buffers: `matrix`, 12 numbers, the rows of [M | t], where a point p goes to M p + t; `motion`, one
///   leafless_motion or NULL; `solid`, one pointer.
/// - Result: `*solid`; `*motion`, the worst that a map does to any part (the identity does nothing).
/// - Errors: LEAFLESS_E_ARGUMENT if an entry is neither 0 nor of a magnitude between 2^-64 and 2^64, or M is
///   singular; LEAFLESS_E_MESH if a mesh is moved beyond the numbers that meshes may have;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: the operand is shared and may be freed; give `*solid` back with leafless_solid_free.
/// - Untrusted input: any solids and numbers.
leafless_status leafless_solid_placed(const leafless_solid *operand, const double matrix[12],
    leafless_motion *motion, leafless_solid **solid);

/// A solid whose cells are not split where its surface is known to lie within a layer no thicker than a
/// tolerance: an octree of it stays coarse where the surface is flat. Such cells stay PARTIAL. Half-spaces
/// know such layers; a solid that knows none is split as ever.
///
/// - Result: `*solid`, a new solid.
/// - Errors: LEAFLESS_E_ARGUMENT if `tolerance_model` is negative or not a number; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the caller's, to be given to leafless_solid_free; `operand` stays the caller's.
/// - Untrusted input: any solid.
leafless_status leafless_solid_adaptive(const leafless_solid *operand, double tolerance_model,
    leafless_solid **solid);

/// The same solid by another rule of touching, which holds for the whole expression. What joins it to others
/// follows its own rule.
///
/// - Buffers: `solid`, one pointer. `touch` is a leafless_touch.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_NULL; LEAFLESS_E_ARGUMENT if `touch` is no leafless_touch.
/// - Ownership: the operand is shared and may be freed; give `*solid` back with leafless_solid_free.
/// - Untrusted input: any solids.
leafless_status leafless_solid_with_touch(const leafless_solid *operand, leafless_touch touch,
    leafless_solid **solid);

/* ---- 10. Solids by functions of the host -------------------------------------------------------------- */

/// What a host promises of its shape outside of the universe that it is asked about.
LEAFLESS_ENUM(leafless_exterior, uint32_t) {
    LEAFLESS_EXTERIOR_UNKNOWN = 0,  ///< Nothing: the shape counts as clipped by the universe.
    LEAFLESS_EXTERIOR_EMPTY = 1,  ///< The shape ends inside of the universe.
    LEAFLESS_EXTERIOR_FULL = 2,  ///< Everything outside of the universe belongs to the shape.
};

/// Classifies the box [min, max] (3 numbers each, model units) for the host's own shape: LEAFLESS_TAG_EMPTY
/// or LEAFLESS_TAG_FULL if that is proven for all of the box, LEAFLESS_TAG_PARTIAL to be asked about its
/// eight parts. Anything else ends the operation with LEAFLESS_E_CALLBACK and the number in the message; so
/// use a negative number for the host's own errors.
///
/// It is called from several threads at once, which may all be the library's own, unless the operation's
/// options say `threads` = 1; and it must give the same answer to the same box. It must return: no exception,
/// no longjmp. It may call this library.
typedef int32_t (*leafless_classify_fn)(void *ctx, const double *min, const double *max);

/// Decides a point (3 numbers, model units) for the host's own shape: 1 inside, 0 outside; anything else ends
/// the operation with LEAFLESS_E_CALLBACK. Else as leafless_classify_fn.
typedef int32_t (*leafless_contains_fn)(void *ctx, const double *point);

/// Classifies `count` boxes (6 numbers each: min, then max) at once, for hosts that do that faster than one
/// by one: sets `tags` to what leafless_classify_fn would answer. 0, or the number of the host's own error,
/// which ends the operation with LEAFLESS_E_CALLBACK. Else as leafless_classify_fn.
typedef int32_t (*leafless_classify_many_fn)(void *ctx, const double *boxes, uint64_t count, int32_t *tags);

/// Decides `count` points (3 numbers each) at once: sets each of `inside` to 1 or 0. 0, or the number of the
/// host's own error. Else as leafless_contains_fn.
typedef int32_t (*leafless_contains_many_fn)(void *ctx, const double *points, uint64_t count,
    int32_t *inside);

/// Bounds the distances of `count` points (3 numbers each, model units) from the surface of the host's own
/// shape: sets each of `distances_model` to a number whose magnitude is at most that distance, negative
/// inside and positive outside; 0, or what is no number, says nothing. 0, or the number of the host's own
/// error. Else as leafless_classify_fn.
typedef int32_t (*leafless_distance_many_fn)(void *ctx, const double *points, uint64_t count,
    double *distances_model);

/// What a function f of the host does over a box. The shape is the set of the points where f is not positive,
/// as for a signed distance; the gradient leads out of it. NaN, or lower > upper, says nothing of the box.
typedef struct leafless_gradient {
    leafless_interval value;  ///< Contains the value of f at the middle of the box. One end may be infinite.
    /// For each axis: contains the partial derivative of f everywhere in the box. f must be continuous there;
    /// where it has no derivative, the range must contain the slopes on all sides.
    leafless_interval gradient[3];
} leafless_gradient;

/// Bounds the host's function f over the box [min, max] (3 numbers each, model units), of which `middle` is
/// the middle (3 numbers): sets `*gradient`, all of which is NaN before. 0, or the number of the host's own
/// error. Else as leafless_classify_fn.
typedef int32_t (*leafless_gradient_fn)(void *ctx, const double *min, const double *max, const double *middle,
    leafless_gradient *gradient);

/// Two balls that touch the surface of the host's shape at a point, one inside and one outside.
///
/// Let d = y - `point` for a point y of the box, and n = `normal` divided by its length. Each y of the box
/// with n . d < -(inner_curvature / 2 |d|^2 + error) must lie in the shape, and no y with n . d >
/// outer_curvature / 2 |d|^2 + error may. So without an error the balls have the radii 1 / `inner_curvature`
/// and 1 / `outer_curvature`; 0 stands for a half-space, a negative curvature for all that lies outside of a
/// ball, and infinity for nothing. The reciprocal of the surface's reach does for both: it is no less than
/// any curvature, nor than 2 over the width of any wall or gap. NaN, or a negative error, says nothing of the
/// box.
typedef struct leafless_tangent {
    /// Where the balls touch (model units); best the surface's nearest point to the middle of the box.
    double point[3];
    double normal[3];  ///< The direction that leads out of the shape there, of any length.
    double inner_curvature;  ///< The reciprocal of the radius of the ball inside.
    double outer_curvature;  ///< The reciprocal of the radius of the ball outside.
    /// By how much the surface may be off (model units), for what is rounded in `point` and `normal`.
    double error;
} leafless_tangent;

/// Tells where the surface of the host's own shape runs next to the middle of a box, and how it bends: sets
/// `*tangent`, all of which is NaN before. Else as leafless_gradient_fn.
typedef int32_t (*leafless_tangent_fn)(void *ctx, const double *min, const double *max, const double *middle,
    leafless_tangent *tangent);

/// Called once, when nothing uses `ctx` any more, in the thread that gave back the last reference. It must
/// return: no exception, no longjmp. It may call this library.
typedef void (*leafless_destroy_fn)(void *ctx);

/// The host's own shape. All fields but the first may be zero; `classify` or `distance_many` must be set.
typedef struct leafless_solid_callbacks {
    uint32_t struct_size;  ///< sizeof(leafless_solid_callbacks).
    leafless_exterior exterior;  ///< What is known of the space outside of the universe.
    leafless_classify_fn classify;  ///< Classifies boxes.
    leafless_contains_fn contains;  ///< Decides points: LEAFLESS_RULE_SAMPLED needs it; optional.
    leafless_destroy_fn destroy;  ///< Called when `ctx` is not needed any more; optional.
    void *ctx;  ///< What the functions are called with.
    /// Any number but 0, of 128 bits, that tells the shape from others, such as a hash of what it is made of:
    /// octrees that leafless_lazy_freeze makes remember it, and are taken up again by no other shape.
    /// Optional.
    uint64_t fingerprint[2];
    /// Classifies many boxes at once, as many as the work has at hand; optional, and `classify` must be set
    /// all the same.
    leafless_classify_many_fn classify_many;
    /// Decides many points at once; optional, with or without `contains`.
    leafless_contains_many_fn contains_many;
    /// Bounds the distances of points from the surface; optional. It is asked about the middles of cells
    /// before boxes are classified, and a cell whose middle is further from the surface than its corners is
    /// decided. With it `classify` is optional.
    leafless_distance_many_fn distance_many;
    /// Bounds a function of the host over boxes; optional. It is asked about undecided cells. Measures,
    /// bounding boxes and adaptive octrees need far fewer splits with it. No verdict depends on it.
    leafless_gradient_fn gradient;
    /// Tells of the surface next to the middle of a box; optional. It is asked for the same as `gradient`; if
    /// both are set, where that one proves nothing.
    leafless_tangent_fn tangent;
    /// A box that the shape lies in: its lower and its upper corner (model units). All zero: none is known.
    /// In a universe that holds the box the shape ends inside, whatever `exterior` says. The box moves along
    /// with the shape; of a moved shape `exterior` says nothing.
    double bounds[6];
} leafless_solid_callbacks;

/// The host's own shape.
///
/// - Buffers: `callbacks`, one struct, which is copied; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_NULL if `classify` is NULL, unless `distance_many` is set and `classify_many` is not;
///   LEAFLESS_E_ARGUMENT if `exterior` is no leafless_exterior, or `bounds` is no box. After an error
///   `destroy` is not called.
/// - Ownership: `ctx` must live until `destroy` is called with it; give `*solid` back with
///   leafless_solid_free.
/// - Threads: any; in which the functions are called, leafless_classify_fn says.
/// - Untrusted input: any answers.
leafless_status leafless_solid_new_callbacks(const leafless_solid_callbacks *callbacks,
    leafless_solid **solid);

/// The value of the host's function at a point (3 numbers, model units): sets `*value`. 0, or the number of
/// the host's own error, which ends the operation with LEAFLESS_E_CALLBACK. Else as leafless_classify_fn.
typedef int32_t (*leafless_value_fn)(void *ctx, const double *point, double *value);

/// An interval that contains all values of the host's function over the box [min, max] (3 numbers each, model
/// units): sets `*range`. Else as leafless_value_fn.
typedef int32_t (*leafless_range_fn)(void *ctx, const double *min, const double *max,
    leafless_interval *range);

/// A half-space of the host: the points where its function is not negative. `value` and `range` must be set.
typedef struct leafless_solid_function {
    uint32_t struct_size;  ///< sizeof(leafless_solid_function).
    uint32_t reserved;  ///< Zero.
    /// The function's value at a point; NaN where it has none. Only its sign counts.
    leafless_value_fn value;
    /// Its range over a box. It alone proves that a cell lies inside or outside. A NaN, or lower > upper,
    /// proves nothing.
    leafless_range_fn range;
    leafless_destroy_fn destroy;  ///< Called when `ctx` is not needed any more; optional.
    void *ctx;  ///< What the functions are called with.
    uint64_t fingerprint[2];  ///< As in leafless_solid_callbacks.
} leafless_solid_function;

/// A half-space of the host. It joins others, and may be placed: then its functions are asked in its own
/// space, about the box around a cell's inverse image and about the rounded inverse image of a point.
///
/// - Buffers: `function`, one struct, which is copied; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_NULL if `value` or `range` is NULL; LEAFLESS_E_ARGUMENT. After an error `destroy` is
///   not called.
/// - Ownership: `ctx` must live until `destroy` is called with it; give `*solid` back with
///   leafless_solid_free.
/// - Threads: any; in which the functions are called, leafless_classify_fn says.
/// - Untrusted input: any answers.
leafless_status leafless_solid_new_function(const leafless_solid_function *function, leafless_solid **solid);

/* ---- 11. Volumes -------------------------------------------------------------------------------------- */

/// The type of samples. The arrays of a volume are of the first five types. Samples of other types are
/// converted to one of these when they are copied.
LEAFLESS_ENUM(leafless_sample_type, uint32_t) {
    LEAFLESS_SAMPLE_TYPE_U8 = 0,  ///< uint8_t.
    LEAFLESS_SAMPLE_TYPE_U16 = 1,  ///< uint16_t.
    LEAFLESS_SAMPLE_TYPE_I16 = 2,  ///< int16_t, as the Hounsfield units of tomography.
    LEAFLESS_SAMPLE_TYPE_F32 = 3,  ///< float. One that is not a number is never inside.
    /// Bits with the values 0 and 1, in uint64_t: each row along x begins with a word of its own, and the bit
    /// of the sample (x, y, z) is bit x mod 64 of word x / 64 + w (y + ny z), where w = ⌈nx / 64⌉. Other bits
    /// of a row's last word do not count. leafless_octree_bitmap writes the same.
    LEAFLESS_SAMPLE_TYPE_BITS = 4,
    /// Bits in bytes, eight to a byte, the lowest first: each row along x begins with a byte of its own. They
    /// become LEAFLESS_SAMPLE_TYPE_BITS.
    LEAFLESS_SAMPLE_TYPE_BITS_IN_BYTES = 5,
    LEAFLESS_SAMPLE_TYPE_I8 = 6,  ///< int8_t. It becomes int16_t.
    LEAFLESS_SAMPLE_TYPE_I32 = 7,  ///< int32_t. It becomes float, and so do all that follow.
    LEAFLESS_SAMPLE_TYPE_U32 = 8,  ///< uint32_t.
    LEAFLESS_SAMPLE_TYPE_I64 = 9,  ///< int64_t.
    LEAFLESS_SAMPLE_TYPE_U64 = 10,  ///< uint64_t.
    LEAFLESS_SAMPLE_TYPE_F64 = 11,  ///< double.
};

/// The formats of volume files.
LEAFLESS_ENUM(leafless_volume_format, uint32_t) {
    /// The samples alone. A leafless_volume_layout tells what must be known to read them.
    LEAFLESS_VOLUME_FORMAT_RAW = 0,
    LEAFLESS_VOLUME_FORMAT_NRRD = 1,  ///< NRRD, `.nrrd` or `.nhdr`. When written, with samples as they are.
    LEAFLESS_VOLUME_FORMAT_METAIMAGE = 2,  ///< MetaImage, `.mha` or `.mhd`, which can be read only.
    /// To be written: NRRD with samples compressed by DEFLATE. (A file that is read is
    /// LEAFLESS_VOLUME_FORMAT_NRRD, compressed or not.)
    LEAFLESS_VOLUME_FORMAT_NRRD_GZIP = 3,
};

/// What can be said of a volume at once.
typedef struct leafless_volume_info {
    uint32_t struct_size;  ///< sizeof(leafless_volume_info).
    uint32_t extents[3];  ///< How many samples there are along x, y and z.
    leafless_sample_type sample_type;  ///< Their type in memory: one of the first five.
    leafless_sample_type file_type;  ///< Their type in the file or array that the volume was made from.
    leafless_volume_format format;  ///< The file's format; LEAFLESS_VOLUME_FORMAT_RAW for arrays.
    leafless_unit unit;  ///< The unit of all lengths, if the file says it.
    bool is_placed;  ///< Whether the file's axes are not x, y and z: then `placement` moves the voxels.
    uint64_t sample_count;  ///< The number of samples.
    uint64_t rounded;  ///< How many of them single precision had to round.
    /// The least value that is inside if nobody says which: the middle of the range of `file_type`. 0.5 for
    /// bits, 127.5 for uint8_t, 32767.5 for uint16_t, -0.5 for integers with a sign, 0 for float and double.
    double default_threshold;
    double corner_model[3];  ///< The lower corner of the first voxel, before `placement` moves it.
    double spacing_model[3];  ///< The edges of a voxel.
    /// The affine map x' = M x + t that moves the voxels to where the file says: three rows of M and t. Its
    /// directions are rounded. The map that moves nothing unless `is_placed`.
    double placement[12];
    /// Bytes that the samples take, in memory or where the host has them, and what was found out about them
    /// for solids.
    uint64_t bytes;
} leafless_volume_info;

/// One more reference to a volume.
///
/// - Buffers: `volume`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `volume`.
/// - Ownership: give each reference back with leafless_volume_free.
leafless_status leafless_volume_ref(const leafless_volume *volume, leafless_volume **reference);

/// Gives back a reference to a volume; with the last one the volume is gone. Solids made of it stay, and keep
/// its samples.
///
/// - Buffers: `volume`, a handle or NULL, which does nothing.
/// - Ownership: the reference is gone.
/// - Threads: any; no other call may use this reference.
void leafless_volume_free(leafless_volume *volume);

/// What can be said of a volume at once. O(1).
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
leafless_status leafless_volume_describe(const leafless_volume *volume, leafless_volume_info *info);

/// The samples of a volume where they lie, without a copy: x fastest, of the `sample_type` of
/// leafless_volume_describe.
///
/// - Buffers: `samples` and `length`, one each.
/// - Result: `*samples`, the address of the first one; `*length`, their bytes.
/// - Ownership: the samples belong to the volume, or to the host if it uses the host's array, and live as
///   long as the reference `volume`.
leafless_status leafless_volume_peek_samples(const leafless_volume *volume, const void **samples,
    uint64_t *length);

/// The frame whose finest cells are the voxels of a volume: of the least depth that holds all of them. On
/// this frame a solid of the volume has no PARTIAL cell, and its octree is the bitmap, bit for bit.
///
/// - Buffers: `frame`, one struct.
/// - Result: `*frame`.
/// - Errors: LEAFLESS_E_ARGUMENT if voxels are no cubes, or their axes not x, y and z: take a frame around
///   leafless_volume_bounds.
/// - Untrusted input: any volume.
leafless_status leafless_volume_frame(const leafless_volume *volume, leafless_frame *frame);

/// A box that contains all voxels of a volume, where the file says that they lie; rounded outward.
///
/// - Buffers: `min_model` and `max_model`, room for 3 numbers each.
/// - Result: both corners.
/// - Errors: LEAFLESS_E_ARGUMENT if the box is beyond the range of double.
/// - Untrusted input: any volume.
leafless_status leafless_volume_bounds(const leafless_volume *volume, double min_model[3],
    double max_model[3]);

/// The least and the greatest sample of a volume. O(n), and O(n / 64) once a solid or a range was asked for.
///
/// - Buffers: `options`, one struct or NULL, of which limits do not matter; `range`, one struct.
/// - Result: `*range`: of bits 0 to 1, and all numbers if a sample is not a number.
/// - Errors: LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any volume.
leafless_status leafless_volume_range(const leafless_volume *volume, const leafless_options *options,
    leafless_interval *range);

/// The solid of a volume: the union of the closed voxels whose samples lie in a band, where the file says
/// that they lie. What is beyond the voxels is outside. It is taken wherever solids are: it can be built,
/// joined with others, measured, and have its surface extracted.
///
/// On the frame of leafless_volume_frame finest cells are voxels, and nothing is PARTIAL. On any other,
/// however its cells lie to the voxels, PARTIAL cells are those that voxels of both kinds share.
///
/// The first solid of a volume reads all samples, in O(n); the next, with other bands, read only blocks of
/// which the least and the greatest value do not tell. Beside the samples, which are shared, it takes about
/// 1/32 of their memory for uint8_t.
///
/// - Buffers: `band`, one struct: the least and the greatest value that are inside, which may be infinite; or
///   NULL, which means all values from the `default_threshold` of leafless_volume_describe on. `options`, one
///   struct or NULL, of which limits do not matter; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if an end of the band is not a number, or the lower above the upper one;
///   LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the solid shares the samples, and `volume` may be freed; give `*solid` back with
///   leafless_solid_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any volume.
leafless_status leafless_solid_from_volume(const leafless_volume *volume, const leafless_interval *band,
    const leafless_options *options, leafless_solid **solid);

/// The order of a number's bytes.
LEAFLESS_ENUM(leafless_byte_order, uint32_t) {
    LEAFLESS_BYTE_ORDER_NATIVE = 0,  ///< As this machine has them.
    LEAFLESS_BYTE_ORDER_LITTLE = 1,  ///< The byte of the lowest weight first.
    LEAFLESS_BYTE_ORDER_BIG = 2,  ///< The byte of the highest weight first.
};

/// How an array of samples is laid out, and where it lies: x varies fastest, then y, then z, without gaps.
/// All fields but the first and `extents` may be zero, which is their default.
typedef struct leafless_volume_layout {
    uint32_t struct_size;  ///< sizeof(leafless_volume_layout).
    uint32_t sample_type;  ///< A leafless_sample_type.
    /// How many samples there are along x, y and z: 1 to 2^20 each. An octree's cube may reach beyond them;
    /// nothing is stored there.
    uint32_t extents[3];
    uint32_t byte_order;  ///< A leafless_byte_order.
    uint64_t skip;  ///< Bytes before the first sample.
    /// The lower corner of the first voxel: the place of the first sample less half the spacing. Each
    /// coordinate is 0 or of a magnitude between 2^-256 and 2^256.
    double corner_model[3];
    double spacing_model[3];  ///< The edges of a voxel, 2^-256 to 2^256; all three 0 means 1.
} leafless_volume_layout;

/// Makes a volume of an array of samples without a header, in memory or in a file.
///
/// With LEAFLESS_ACCESS_COPY the samples are copied: O(n); bytes may lie on any address. With
/// LEAFLESS_ACCESS_MAP, which is for bytes only, they are used where they lie: O(1). The layout's type is
/// then LEAFLESS_SAMPLE_TYPE_U8, _U16, _I16, _F32 or _BITS, its byte order is this machine's, it has nothing
/// to skip, and the bytes are aligned for their type. LEAFLESS_ACCESS_MAP_VERIFIED is the same: any samples
/// are a volume.
///
/// - Buffers: `layout`, one struct; `source`, one struct; `volume`, one pointer.
/// - Result: `*volume`.
/// - Errors: LEAFLESS_E_ARGUMENT if the type, the byte order, an extent, the corner or the spacing is none,
///   if the layout or the source is not as the access demands, or if the number of bytes is not that of the
///   samples and those to skip; LEAFLESS_E_VOLUME_FILE if that is so of a file; LEAFLESS_E_IO;
///   LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: samples that are copied may be freed after the call. Others stay the host's. They must stay,
///   unchanged, until the last reference is given back to the volume, to every solid that is made of it, and
///   to what is made of these, but for octrees and meshes, which have all of their own. Give `*volume` back
///   with leafless_volume_free.
/// - Untrusted input: any layout, any bytes, any file; memory is at most the file's length and as much again
///   for the samples, twice as much for int8_t.
leafless_status leafless_volume_new(const leafless_volume_layout *layout, const leafless_source *source,
    leafless_volume **volume);

/// Reads a volume file, NRRD or MetaImage; the content tells which. If it names another file for its samples,
/// that is read from the same folder or below it, or given as `data`.
///
/// NRRD: versions 1 to 5, attached and detached, raw, gzip and ascii. MetaImage: binary, ASCII and
/// compressed. All types of single numbers, both byte orders. What is neither 8 nor 16 bits wide becomes
/// float, and int8_t becomes int16_t. O(n); the samples are copied once.
///
/// Samples in another file must lie in the header's folder or below it, by their real path: links are
/// followed before that is judged. The header's folder is the one that the path names and, if the header is a
/// link, also the one in which the header really lies, which is searched second. For bytes no file is looked
/// for.
///
/// - Buffers: `source`, one struct, with LEAFLESS_ACCESS_COPY. `data`, one struct of the same kind: the file
///   of the samples, which is then not looked for; else NULL, and of bytes that need one
///   LEAFLESS_E_VOLUME_FILE. leafless_volume_data_file tells its name. `volume`, one pointer.
/// - Result: `*volume`; leafless_volume_describe tells what the file says.
/// - Errors: LEAFLESS_E_VOLUME_FILE, with what is wrong where in the message, if the file is neither, is
///   damaged, or uses something that cannot be read; LEAFLESS_E_IO; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*volume` back with leafless_volume_free.
/// - Untrusted input: any file. A header that asks for more samples than its data can hold is refused before
///   anything is allocated; compressed samples become at most 1032 times as long as the file.
leafless_status leafless_volume_read(const leafless_source *source, const leafless_source *data,
    leafless_volume **volume);

/// The name of the file that has the samples of a volume file, relative to that.
///
/// - Buffers: `bytes`, `length` bytes: the file, or all of its header; may be NULL if there are none. `name`,
///   room for `capacity` bytes, or NULL to ask for the length only; `name_length`, one number.
/// - Result: `*name_length`, in bytes; 0 if the samples stand behind the header. The name, in UTF-8, not
///   NUL-terminated. It may be any text: check it before you open such a file.
/// - Errors: LEAFLESS_E_VOLUME_FILE; LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any bytes.
leafless_status leafless_volume_data_file(const uint8_t *bytes, uint64_t length, char *name,
    uint64_t capacity, uint64_t *name_length);

/// Writes a volume file.
///
/// The byte of the lowest weight comes first, and bits become bytes 0 and 1. A NRRD holds the place of the
/// first sample, corner + spacing / 2, rounded so that the same corner is read again; where no double does
/// that, near a power of two, the volume lies half a last place beside. It holds no unit. A raw file holds no
/// place at all. O(n) time and memory.
///
/// - Buffers: `sink`, one struct.
/// - Errors: LEAFLESS_E_ARGUMENT if `format` is none that can be written, or if the volume has other axes
///   than x, y and z and shall become a NRRD; LEAFLESS_E_IO; LEAFLESS_E_CALLBACK; LEAFLESS_E_BUFFER;
///   LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any volume.
leafless_status leafless_volume_write(const leafless_volume *volume, leafless_volume_format format,
    const leafless_sink *sink);

/* ---- 12. Scenes --------------------------------------------------------------------------------------- */

/// Which circles, balls, cylinders and solids of revolution are drawn as polygons, prisms and polyhedra.
LEAFLESS_ENUM(leafless_facets, uint32_t) {
    LEAFLESS_FACETS_AUTO = 0,  ///< Those with a $fn of 12 or less; all others are exact.
    LEAFLESS_FACETS_EXACT = 1,  ///< None: circles are round.
    /// All, with as many sides as OpenSCAD gives them, which must be 1024 at most.
    LEAFLESS_FACETS_POLYGON = 2,
};

/// How a scene is to be read. NULL means the defaults. All fields but the first may be zero, which is their
/// default.
typedef struct leafless_scene_options {
    uint32_t struct_size;  ///< sizeof(leafless_scene_options).
    leafless_facets facets;  ///< Which curves are drawn as polygons.
    /// Where files are looked for that a text in memory names, UTF-8; NULL if it may name none. NULL for a
    /// scene with a path, whose files are looked for beside it.
    const char *folder;
    /// Its length in bytes. An empty one that is not NULL is the folder that the process is in.
    size_t folder_length;
} leafless_scene_options;

/// Reads a scene, a text in UTF-8. Files that it names are looked for beside it, or in the folder of the
/// options for a text in memory.
///
/// - Buffers: `source`, one struct, with LEAFLESS_ACCESS_COPY; `options`, one struct, or NULL; `scene`, one
///   pointer.
/// - Result: `*scene`.
/// - Errors: LEAFLESS_E_SCENE, with line and column in the message, for whatever is wrong with the text or a
///   file that it names, also if there is no folder; LEAFLESS_E_ARGUMENT if there are a path and a folder;
///   LEAFLESS_E_IO if the file itself cannot be read; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*scene` back with leafless_scene_free.
/// - Untrusted input: any text; nesting costs memory, not stack, and memory is linear in the text and in the
///   files that it names; with LEAFLESS_FACETS_POLYGON a ball may take memory for half a million half-spaces.
///   It may name any file, by absolute paths too, which is then read as a mesh or an octree.
leafless_status leafless_scene_read(const leafless_source *source, const leafless_scene_options *options,
    leafless_scene **scene);

/// What was found while a scene was read.
typedef struct leafless_scene_info {
    uint32_t struct_size;  ///< sizeof(leafless_scene_info).
    uint64_t polygons;  ///< Calls of circle, sphere, cylinder and rotate_extrude that were drawn as polygons.
    uint64_t exact;  ///< Calls of these that are exact. OpenSCAD draws them as polygons.
    /// Calls of linear_extrude of which `slices` has no effect though it has one in OpenSCAD.
    uint64_t ignored_slices;
    /// Meshes and polyhedra that have triangles: leafless_scene_describe_mesh_at tells of each.
    uint64_t meshes;
    /// Whether the scene is known to be empty: there is nothing in it, or what is intersected lies apart.
    bool is_empty;
} leafless_scene_info;

/// What is told of a mesh or polyhedron in a scene.
typedef struct leafless_scene_mesh_info {
    uint32_t struct_size;  ///< sizeof(leafless_scene_mesh_info).
    uint64_t line;  ///< Line of the call in the text, counted from 1.
    uint64_t column;  ///< Column of the call in characters, counted from 1.
    uint64_t turned;  ///< Triangles that face the other way than most of those that they hang together with.
} leafless_scene_mesh_info;

/// What was found while a scene was read.
///
/// - Buffers: `report`, one struct.
/// - Result: `*report`.
leafless_status leafless_scene_describe(const leafless_scene *scene, leafless_scene_info *report);

/// What was found while a mesh or polyhedron of a scene was taken in.
///
/// - Buffers: `mesh`, one struct; `report`, one struct, or NULL if it is not wanted. `index`, in the order of
///   the text, is less than `meshes` of leafless_scene_info.
/// - Result: `*mesh`; `*report`, the report of the mesh as it was taken in.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no such mesh.
leafless_status leafless_scene_describe_mesh_at(const leafless_scene *scene, uint64_t index,
    leafless_scene_mesh_info *mesh, leafless_mesh_report *report);

/// The file of a mesh in a scene, as the text names it, in UTF-8 and not terminated by NUL; nothing for a
/// polyhedron.
///
/// - Buffers: `bytes`, room for `capacity` bytes, or NULL to ask for the length only; `length`, one number.
///   `index`, in the order of the text, is less than `meshes` of leafless_scene_info.
/// - Result: `*length`, the length of the name in bytes; the name in `bytes`.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_ARGUMENT if there is no such mesh.
leafless_status leafless_scene_mesh_file_at(const leafless_scene *scene, uint64_t index, uint8_t *bytes,
    uint64_t capacity, uint64_t *length);

/// One more reference to a scene.
///
/// - Buffers: `scene`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `scene`.
/// - Ownership: give each reference back with leafless_scene_free.
leafless_status leafless_scene_ref(const leafless_scene *scene, leafless_scene **reference);

/// Gives back a reference to a scene; with the last one the scene is gone. Solids made of it stay.
///
/// - Buffers: `scene`, a handle or NULL, which does nothing.
/// - Ownership: the reference is gone.
/// - Threads: any; no other call may use this reference.
void leafless_scene_free(leafless_scene *scene);

/// A box that holds the solid of a scene. It may be larger than the solid.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each.
/// - Result: both.
/// - Errors: LEAFLESS_E_ARGUMENT if none is known: the scene is empty, or may be unbounded;
///   LEAFLESS_E_NO_MEMORY.
leafless_status leafless_scene_bounds(const leafless_scene *scene, double min_model[3], double max_model[3]);

/// The solid of a scene, to be built on this frame. If there are neither meshes nor octrees in it, it can be
/// built on any.
///
/// - Buffers: `frame`, one struct; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check; LEAFLESS_E_LIMIT if a mesh or octree is within more
///   than 256 matrices; LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*solid` back with leafless_solid_free.
/// - Untrusted input: any scene.
leafless_status leafless_solid_from_scene(const leafless_scene *scene, const leafless_frame *frame,
    leafless_solid **solid);

/* ---- 13. Octrees -------------------------------------------------------------------------------------- */

/// What is known of a cell.
LEAFLESS_ENUM(leafless_tag, uint8_t) {
    LEAFLESS_TAG_EMPTY = 0,  ///< Proven outside of the solid.
    LEAFLESS_TAG_BRANCH = 1,  ///< Cut and split: the cell has a node.
    LEAFLESS_TAG_PARTIAL = 2,  ///< Not decided.
    LEAFLESS_TAG_FULL = 3,  ///< Proven to lie in the solid.
};

/// What the cells of an octree prove of the solid that it was made from. Certified trees prove both, inner
/// ones FULL, outer ones EMPTY, sampled ones nothing. Booleans prove what their operands do, and files keep
/// it.
typedef struct leafless_proof {
    /// How far the surfaces that the cells speak of were moved from those that were handed in, in model
    /// units: cracks that were sewn, vertices that were rounded, a stated deviation of a tessellation.
    double displacement_model;
    bool full;  ///< A FULL cell is proven to lie in the solid.
    bool empty;  ///< An EMPTY cell is proven to lie outside of it.
} leafless_proof;

/// Which tags of an octree's cells are proven.
LEAFLESS_ENUM(leafless_proven, uint32_t) {
    LEAFLESS_PROVEN_NOTHING = 0,  ///< Neither.
    LEAFLESS_PROVEN_FULL = 1,  ///< FULL.
    LEAFLESS_PROVEN_EMPTY = 2,  ///< EMPTY.
    LEAFLESS_PROVEN_BOTH = 3,  ///< FULL and EMPTY.
};

/// What can be said of an octree at once.
typedef struct leafless_octree_info {
    uint32_t struct_size;  ///< sizeof(leafless_octree_info).
    leafless_frame frame;  ///< Where it lies, and its depth.
    uint64_t elements;  ///< Array elements without bricks; each holds two levels.
    uint64_t bricks;  ///< Array elements of the deepest level.
    uint64_t channels;  ///< Channels, 0 to 256: leafless_octree_channel_at returns each.
    /// Bytes that its arrays and its channels take: in memory, or where a file is mapped. What octrees share
    /// counts for each of them.
    uint64_t bytes;
    leafless_proof proof;  ///< What the cells prove.
    leafless_tag root;  ///< The tag of the whole universe; BRANCH if it is cut.
    leafless_tag exterior;  ///< What is known of the space outside of the universe; never BRANCH.
    bool is_binary;  ///< Whether nothing is undecided.
    /// Whether the solid is not known to end inside of the universe: volumes then concern the part inside.
    bool is_clipped;
} leafless_octree_info;

/// Counts and certified volumes. The volume is that of the part inside of the universe.
typedef struct leafless_statistics {
    uint64_t nodes;  ///< Internal nodes: cells that are cut and split.
    uint64_t empty;  ///< EMPTY cells.
    uint64_t full;  ///< FULL cells.
    uint64_t partial;  ///< PARTIAL cells.
    uint64_t lower_cells;  ///< Volume that is surely solid, in finest cells.
    uint64_t upper_cells;  ///< Volume that is possibly solid, in finest cells.
    leafless_interval volume_model;  ///< The same two in cubic model units, rounded outward.
} leafless_statistics;

/// The octree whose whole universe has one tag.
///
/// - Buffers: `frame`, one struct; `octree`, one pointer. `tag` and `exterior`, which are not BRANCH, say
///   what is known of the universe, and of the space around it.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_ARGUMENT.
/// - Ownership: give `*octree` back with leafless_octree_free.
/// - Untrusted input: any numbers.
leafless_status leafless_octree_new_uniform(const leafless_frame *frame, leafless_tag tag,
    leafless_tag exterior, leafless_octree **octree);

/// One more reference to an octree.
///
/// - Buffers: `octree`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `octree`.
/// - Ownership: give each reference back with leafless_octree_free.
leafless_status leafless_octree_ref(const leafless_octree *octree, leafless_octree **reference);

/// Gives back a reference to an octree. With the last one the octree is gone, and with it the mapping of its
/// file, unless a cursor, a solid, or an octree with other metadata still shares it.
///
/// - Buffers: `octree`, a handle or NULL, which does nothing.
/// - Ownership: the reference is gone.
/// - Threads: any; no other call may use this reference.
void leafless_octree_free(leafless_octree *octree);

/// What can be said of an octree at once. O(1).
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
/// - Untrusted input: any octree.
leafless_status leafless_octree_describe(const leafless_octree *octree, leafless_octree_info *info);

/// The same octree, of whose cells this is said; the arrays and the channels are shared. Octrees that other
/// programs made prove what these know. If FULL and EMPTY are said to be proven, the cells themselves are
/// taken for the solid: measures of a sampled octree then are those of its cells, and not of what was
/// sampled.
///
/// - Buffers: `octree`, a handle; `proven`, a leafless_proven; `displacement_model` as in leafless_proof;
///   `result`, one pointer.
/// - Result: `*result`.
/// - Errors: LEAFLESS_E_ARGUMENT unless `proven` is one, and the displacement finite and not negative.
/// - Ownership: give `*result` back with leafless_octree_free.
/// - Untrusted input: any octree, any numbers.
leafless_status leafless_octree_with_proof(const leafless_octree *octree, leafless_proven proven,
    double displacement_model, leafless_octree **result);

/// Counts over all levels, and the volume of the cells. O(depth) once the counts are known, which for an
/// octree from a file they are and for a new one takes one pass over its arrays.
///
/// - Buffers: `statistics`, one struct.
/// - Result: `*statistics`.
/// - Untrusted input: any octree; of one that was mapped unverified the numbers may be wrong.
leafless_status leafless_octree_statistics(const leafless_octree *octree, leafless_statistics *statistics);

/// Counts of each level, and the certified volumes of the tree cut there. Entry 0 is the universe, entry
/// `depth` the finest cells.
///
/// - Buffers: `levels`, room for `capacity` structs, or NULL to ask for the count only; `count`, one number.
/// - Result: `*count`, depth + 1; the levels.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small.
/// - Untrusted input: any octree; of one that was mapped unverified the numbers may be wrong.
leafless_status leafless_octree_levels(const leafless_octree *octree, leafless_statistics *levels,
    uint64_t capacity, uint64_t *count);

/// Checks that an octree is well-formed and canonical: O(n). Its channels are not looked at: see
/// leafless_channel_check. Those that the library makes, opens or maps verified are; the bytes that checksums
/// cover are not looked at here, see leafless_file_verify.
///
/// - Result: LEAFLESS_OK if it is.
/// - Errors: LEAFLESS_E_DAMAGED, with the first damage in the message; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree.
leafless_status leafless_octree_check(const leafless_octree *octree);

/// Whether two octrees have the same cells with the same tags, and the same surfaces in them, on the same
/// frame. Metadata does not count, nor do channels. O(n).
///
/// - Buffers: `equal`, one truth value.
/// - Result: `*equal`.
/// - Untrusted input: any octrees.
leafless_status leafless_octree_equal(const leafless_octree *a, const leafless_octree *b, bool *equal);

/// The octree with one more fact in its metadata, or with another value of one; the arrays and the channels
/// are shared. Names in use: "name", "units", "source", "rule".
///
/// - Buffers: `key` and `value`, `key_length` and `value_length` bytes of UTF-8; `named`, one pointer.
/// - Result: `*named`.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_ARGUMENT if all facts would take more than 1 MiB in a file, 8 bytes
///   and the two texts each; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the texts are copied. `*named` shares the arrays of `octree`, which may be freed: what must
///   outlive `octree`, such as bytes that it views, must outlive `*named` too. Give that back with
///   leafless_octree_free.
/// - Untrusted input: any texts.
leafless_status leafless_octree_with_metadata(const leafless_octree *octree, const char *key,
    size_t key_length, const char *value, size_t value_length, leafless_octree **named);

/// The octree with one fact less in its metadata, or with none; the arrays and the channels are shared.
///
/// - Buffers: `key`, `key_length` bytes of UTF-8, or NULL for all facts; `unnamed`, one pointer.
/// - Result: `*unnamed`; a fact that is not there need not be.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_octree_with_metadata.
/// - Untrusted input: any texts.
leafless_status leafless_octree_without_metadata(const leafless_octree *octree, const char *key,
    size_t key_length, leafless_octree **unnamed);

/// The value of a fact in an octree's metadata.
///
/// - Buffers: `key`, `key_length` bytes of UTF-8; `value` and `value_length`, one each.
/// - Result: `*value`, not NUL-terminated; NULL if there is no such fact. `*value_length`, in bytes.
/// - Errors: LEAFLESS_E_UTF8.
/// - Ownership: the text belongs to the octree and lives as long as the reference `octree`.
/// - Untrusted input: any octree.
leafless_status leafless_octree_peek_metadata(const leafless_octree *octree, const char *key,
    size_t key_length, const char **value, size_t *value_length);

/// A fact of an octree's metadata by its place among all, which stand by ascending key.
///
/// - Buffers: `count`, one number; `key`, `key_length`, `value`, `value_length`, one each, all four NULL to
///   ask for the count only.
/// - Result: `*count`, the number of all facts; key and value, not NUL-terminated, with their lengths in
///   bytes.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no fact `index`, unless only the count is asked for.
/// - Ownership: the texts belong to the octree and live as long as the reference `octree`.
/// - Untrusted input: any octree.
leafless_status leafless_octree_peek_metadata_at(const leafless_octree *octree, uint64_t index,
    uint64_t *count, const char **key, size_t *key_length, const char **value, size_t *value_length);

/// What becomes of finest cells that are not decided.
LEAFLESS_ENUM(leafless_rule, uint32_t) {
    LEAFLESS_RULE_CERTIFIED = 0,  ///< They stay PARTIAL: FULL is proven full, EMPTY proven empty.
    LEAFLESS_RULE_SAMPLED = 1,  ///< Their centre decides.
    LEAFLESS_RULE_INNER = 2,  ///< EMPTY: the result lies in the solid.
    LEAFLESS_RULE_OUTER = 3,  ///< FULL: the result covers the solid.
};

/// Builds the octree of a solid to the depth of a frame. The result is the same bit for bit for any number of
/// threads.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `octree`, one pointer. `rule` is a
///   leafless_rule.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_FRAME if the solid belongs to another frame; LEAFLESS_E_NOT_SAMPLED if
///   LEAFLESS_RULE_SAMPLED is asked of a solid that cannot decide points; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_ARGUMENT; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*octree` back with leafless_octree_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any solid; set `max_bytes` where the depth or the solid is not your own choice.
leafless_status leafless_octree_build(const leafless_solid *solid, const leafless_frame *frame,
    leafless_rule rule, const leafless_options *options, leafless_octree **octree);

/// The octree with its PARTIAL cells resolved: EMPTY under LEAFLESS_RULE_INNER, FULL under
/// LEAFLESS_RULE_OUTER. An octree that keeps surfaces is refused, because its cells are few and large:
/// leafless_octree_plain resolves it at a depth.
///
/// - Buffers: `options`, one struct or NULL; `resolved`, one pointer. `rule` is a leafless_rule.
/// - Result: `*resolved`, with the octree's facts "name" and "units" and no others, and with its channels.
/// - Errors: LEAFLESS_E_NOT_SAMPLED under LEAFLESS_RULE_SAMPLED if a cell is PARTIAL, because a stored octree
///   knows no more about it; LEAFLESS_E_ARGUMENT, also if the octree keeps surfaces; LEAFLESS_E_DAMAGED;
///   LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `octree` stays as it is; give `*resolved` back with leafless_octree_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any octree.
leafless_status leafless_octree_resolve(const leafless_octree *octree, leafless_rule rule,
    const leafless_options *options, leafless_octree **resolved);

/// The same octree with its bricks encoded as a file would have them, through a dictionary where that is
/// shorter. Everything works on it as on any other.
///
/// - Buffers: `compacted`, one pointer.
/// - Result: `*compacted`, with the same metadata and channels.
/// - Errors: LEAFLESS_E_DAMAGED if a brick cannot be read; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `octree` stays as it is; give `*compacted` back with leafless_octree_free.
/// - Untrusted input: any octree.
leafless_status leafless_octree_compact(const leafless_octree *octree, leafless_octree **compacted);

/// What a set operation makes of octrees, at least one. Exact, and the same bit for bit for any number of
/// threads. The result has no channels: leafless_octree_carry_channels gives it those of the operands.
///
/// Octrees without surfaces are joined two by two: limits of `options` concern each of these steps, and the
/// result is never larger than all operands together. If an octree keeps surfaces
/// (leafless_octree_build_extended), the result keeps surfaces. Then all operands are walked at once, and no
/// intermediate result is copied: pass the stock and all tools in one call, not one call a tool. A cell ends
/// as soon as three surfaces are left in it. A cell that more surfaces cross at the frame's depth is given
/// up, and nothing is known of it. An octree without surfaces takes part as a certified octree. Surfaces that
/// are one in two octrees are one: A less A is LEAFLESS_TAG_EMPTY where nothing was given up. The result may
/// be larger than the operands. Curved surfaces that nearly coincide may need very many cells: set
/// `max_bytes` of `options`.
///
/// - Buffers: `octrees`, `count` handles; `options`, one struct or NULL; `result`, one pointer. `operation`
///   is a leafless_operation.
/// - Result: `*result`, with those of the facts "name" and "units" that all operands have with one value, and
///   no other metadata.
/// - Errors: LEAFLESS_E_FRAME if the frames differ; LEAFLESS_E_NULL, also of an element; LEAFLESS_E_ARGUMENT,
///   also if `count` is 0; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT, also if the exact map of a surface's
///   placements is too long; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the operands stay as they are; give `*result` back with leafless_octree_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any octrees; damage in ones that were mapped unverified is an error or reads as
///   PARTIAL. Set `max_bytes` if an octree keeps surfaces and is not your own choice.
leafless_status leafless_octree_combine(leafless_operation operation, const leafless_octree *const *octrees,
    uint64_t count, const leafless_options *options, leafless_octree **result);

/// Everything but `octree`, inside of its universe and out. Surfaces are kept.
///
/// - Buffers: `options`, one struct or NULL; `result`, one pointer.
/// - Result: as leafless_octree_combine.
/// - Errors: LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_octree_combine.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: as leafless_octree_combine.
leafless_status leafless_octree_complement(const leafless_octree *octree, const leafless_options *options,
    leafless_octree **result);

/* ---- 14. Extended octrees ----------------------------------------------------------------------------- */

/// Which surfaces an extended octree keeps.
typedef struct leafless_cut_options {
    uint32_t struct_size;  ///< sizeof(leafless_cut_options).
    /// Where nothing exact is known of a surface (a mesh, a function of the host), two parallel planes may
    /// stand for it that are at most this far apart. 0: only exact surfaces are kept.
    double tolerance_model;
} leafless_cut_options;

/// What the PARTIAL cells of an octree keep of the surfaces that cross them.
typedef struct leafless_cut_counts {
    uint32_t struct_size;  ///< sizeof(leafless_cut_counts).
    uint32_t surfaces;  ///< Surfaces.
    /// Cells of which it is known which function of surfaces the solid is. Parts of cells count that have
    /// functions of their own.
    uint64_t cells;
    uint64_t given_up;  ///< Cells of which nothing is known.
    /// PARTIAL cells that are split, and have no node, because all of their parts are PARTIAL.
    uint64_t splits;
    uint64_t bytes;  ///< Bytes of all of this.
} leafless_cut_counts;

/// What kind of function a surface is the zero set of, and what its numbers are.
LEAFLESS_ENUM(leafless_stored_surface_kind, uint32_t) {
    LEAFLESS_STORED_SURFACE_KIND_PLANE = 0,  ///< a, b, c, d of a x + b y + c z + d.
    LEAFLESS_STORED_SURFACE_KIND_QUADRIC = 1,  ///< The coefficients of x², y², z², xy, yz, zx, x, y, z and 1.
    /// A, a, n, B, b, m, C, c, k, D of A (x - a)^n + B (y - b)^m + C (z - c)^k + D.
    LEAFLESS_STORED_SURFACE_KIND_POWERS = 2,
    LEAFLESS_STORED_SURFACE_KIND_TORUS = 3,  ///< R, q, s, t of q - (sqrt((s x)² + (s y)²) - R)² - (s z + t)².
    /// a, b, c and two offsets: positive where a x + b y + c z is less than the first, negative where it is
    /// greater than the second, and not known between.
    LEAFLESS_STORED_SURFACE_KIND_SLAB = 4,
};

/// A surface of an octree.
typedef struct leafless_stored_surface_info {
    uint32_t struct_size;  ///< sizeof(leafless_stored_surface_info).
    leafless_stored_surface_kind kind;  ///< What its numbers are.
    uint32_t number_count;  ///< How many numbers there are.
    uint32_t placement_count;  ///< How many maps place it.
    uint32_t terms[10];  ///< Of how many doubles each number is the exact sum.
    uint32_t term_count;  ///< How many doubles that is in all.
    bool has_origin;  ///< Whether a slab can be told from others.
    /// If so: its number where it was made. Numbers from 2^63 on are those of slabs that were made for one
    /// cell.
    uint64_t origin_number;
    uint64_t origin[2];  ///< And the fingerprint of what it was made from, the lower half first.
} leafless_stored_surface_info;

/// The function that the solid is in a cell.
typedef struct leafless_cell_function {
    uint32_t surfaces[3];  ///< The numbers of its surfaces, ascending.
    uint32_t surface_count;  ///< How many they are; 0 if nothing is known of the cell, or if it is decided.
    /// Bit m is set if points lie in the solid that are on the positive side of those surfaces i for which
    /// bit i of m is set, and on the negative side of the others.
    uint8_t table;
} leafless_cell_function;

/// Builds the extended octree of a solid: a certified octree whose PARTIAL cells keep the surfaces that cross
/// them, up to three, and the function of their sides that the solid is. A cell ends as soon as three
/// surfaces are left in it, at any size, so that the octree is small, and as exact as the solid. With exact
/// surfaces alone take a frame of depth 20. The result is the same bit for bit for any number of threads.
///
/// Points, rays and boxes of an octree (leafless_octree_contains, leafless_octree_cast_rays,
/// leafless_octree_classify_box) are decided by the surfaces where they lie; next to a surface they may stay
/// undecided. As a solid (leafless_solid_from_octree) it answers as its source would. Set operations
/// (leafless_octree_combine, leafless_octree_complement) keep the surfaces. Functions that mean cells see the
/// cells alone: leafless_octree_plain makes them.
///
/// - Buffers: `frame`, one struct; `cuts`, one struct or NULL; `options`, one struct or NULL; `octree`, one
///   pointer.
/// - Result: `*octree`.
/// - Errors: as leafless_octree_build under LEAFLESS_RULE_CERTIFIED; LEAFLESS_E_ARGUMENT if the tolerance is
///   negative or no number; LEAFLESS_E_LIMIT also if an exact number of a surface is the sum of more than
///   seven doubles.
/// - Ownership: give `*octree` back with leafless_octree_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any solid; set `max_bytes` where the depth or the solid is not your own choice.
leafless_status leafless_octree_build_extended(const leafless_solid *solid, const leafless_frame *frame,
    const leafless_cut_options *cuts, const leafless_options *options, leafless_octree **octree);

/// The octree without surfaces that says what one with surfaces does, to a depth: for functions that mean
/// cells. What is undecided at the depth is resolved by a rule. Of an octree without surfaces it is the same
/// octree, cut at the depth.
///
/// - Buffers: `options`, one struct or NULL; `plain`, one pointer. `rule` is a leafless_rule.
/// - Result: `*plain`, with the octree's metadata and channels.
/// - Errors: as leafless_octree_build; LEAFLESS_E_ARGUMENT if `depth` is not 1 to 20.
/// - Ownership: `octree` stays as it is; give `*plain` back with leafless_octree_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any octree; set `max_bytes` where the depth is not your own choice.
leafless_status leafless_octree_plain(const leafless_octree *octree, uint32_t depth, leafless_rule rule,
    const leafless_options *options, leafless_octree **plain);

/// What the PARTIAL cells of an octree keep of the surfaces that cross them; all 0 if they keep nothing.
/// O(cells that keep something).
///
/// - Buffers: `counts`, one struct.
/// - Result: `*counts`.
/// - Untrusted input: any octree; of one that was mapped unverified the numbers may be wrong.
leafless_status leafless_octree_count_cuts(const leafless_octree *octree, leafless_cut_counts *counts);

/// A surface of an extended octree: what it is, its numbers, and the maps that place it. O(1).
///
/// - Buffers: `info`, one struct; `terms`, room for `term_capacity` doubles, or NULL: those whose sums the
///   numbers are, one number after the other; `placements`, room for `placement_capacity` doubles, or NULL:
///   the 12 of the rows of [M | t] of each map, in the order in which the maps are applied.
/// - Result: `*info`, `terms` and `placements`.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no such surface, or it is damaged; LEAFLESS_E_BUFFER if a
///   capacity is too small.
/// - Untrusted input: any octree, any number.
leafless_status leafless_octree_surface_at(const leafless_octree *octree, uint32_t surface,
    leafless_stored_surface_info *info, double *terms, uint64_t term_capacity, double *placements,
    uint64_t placement_capacity);

/// The function that the solid is in a cell that lies in a PARTIAL one, or is one. O(depth).
///
/// - Buffers: `cell`, 3 numbers, of which each is less than 2^level; `function`, one struct.
/// - Result: `*function`. It has no surface if nothing is known of the cell, if the cell is decided, if
///   different functions hold in parts of it, or if there is no such cell.
/// - Untrusted input: any octree, any numbers.
leafless_status leafless_octree_cell_function(const leafless_octree *octree, uint32_t level,
    const uint32_t cell[3], leafless_cell_function *function);

/* ---- 15. Shards: octrees in parts --------------------------------------------------------------------- */

/// Which cells a shard knows.
LEAFLESS_ENUM(leafless_shard_kind, uint32_t) {
    LEAFLESS_SHARD_KIND_TOP = 0,  ///< The cells down to a level. What would be split there stays PARTIAL.
    LEAFLESS_SHARD_KIND_BELOW = 1,  ///< The cells in one cell, and the cells that contain it.
};

/// The cells that a shard of an octree knows. The shard knows nothing of other cells: they are PARTIAL.
///
/// An octree is cut at a level into its top, and into one shard for each cell of that level that the top
/// leaves open (leafless_octree_open_cells). Every shard is an octree on the frame of the whole, and true of
/// the whole solid. leafless_octree_join puts shards together again.
///
/// The code of a cell is its place in Morton order among the 8^level cells of its level. Bit 3k of the code
/// is bit k of the cell's place along x, bit 3k + 1 is that along y, bit 3k + 2 that along z.
typedef struct leafless_shard {
    uint64_t code;  ///< The code of the cell; 0 for a top.
    uint32_t level;  ///< The level of the cell, or the last level of a top: 0 to the depth of the frame.
    leafless_shard_kind kind;  ///< A leafless_shard_kind.
} leafless_shard;

/// Builds one shard of the octree of a solid: the cells of the shard are those that leafless_octree_build
/// makes. All other cells are PARTIAL, whatever the rule. Time and memory are linear in the cells of the
/// shard and on the way to it.
///
/// Joining the top and the shards of all cells that it leaves open (leafless_octree_join) makes the octree
/// that leafless_octree_build makes, byte for byte.
///
/// - Buffers: `frame` and `shard`, one struct each; `options`, one struct or NULL; `octree`, one pointer.
///   `rule` is a leafless_rule.
/// - Result: `*octree`.
/// - Errors: as leafless_octree_build; LEAFLESS_E_ARGUMENT also if the frame does not have the cells of the
///   shard.
/// - Ownership: give `*octree` back with leafless_octree_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any solid, any numbers; set `max_bytes` where the depth or the solid is not your own
///   choice.
leafless_status leafless_octree_build_shard(const leafless_solid *solid, const leafless_frame *frame,
    leafless_rule rule, const leafless_shard *shard, const leafless_options *options,
    leafless_octree **octree);

/// Builds one shard of the extended octree of a solid: the cells of the shard are those that
/// leafless_octree_build_extended makes. All other cells are PARTIAL, and nothing is known of them.
///
/// - Buffers: `frame` and `shard`, one struct each; `cuts`, one struct or NULL; `options`, one struct or
///   NULL; `octree`, one pointer.
/// - Result: `*octree`.
/// - Errors: as leafless_octree_build_extended; LEAFLESS_E_ARGUMENT also if the frame does not have the cells
///   of the shard.
/// - Ownership: give `*octree` back with leafless_octree_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any solid, any numbers; set `max_bytes` where the depth or the solid is not your own
///   choice.
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
/// - Ownership: `octree` stays as it is; give `*result` back with leafless_octree_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any octree, any numbers; damage in an octree that was mapped unverified is an error or
///   reads as PARTIAL.
leafless_status leafless_octree_shard(const leafless_octree *octree, const leafless_shard *shard,
    const leafless_options *options, leafless_octree **result);

/// Puts together what several octrees on one frame know of one solid. A cell is FULL or EMPTY if one of the
/// octrees says so. It is PARTIAL where all octrees leave it open. Surfaces of a PARTIAL cell are kept if one
/// of the octrees keeps them.
///
/// This is the reverse of cutting an octree into shards: the result is the whole, byte for byte. The cell of
/// a missing shard is PARTIAL. The octrees may overlap. Where two of them keep surfaces of one cell, the
/// surfaces of the first one are kept.
///
/// Time is linear in the cells that are cut in one octree and known in another one, plus the memory traffic
/// of what is copied.
///
/// - Buffers: `octrees`, `count` handles; `options`, one struct or NULL; `result`, one pointer.
/// - Result: `*result`, without metadata and channels.
/// - Errors: LEAFLESS_E_FRAME if the frames differ; LEAFLESS_E_NULL, also of an element; LEAFLESS_E_ARGUMENT
///   if `count` is 0, or if one octree says FULL where another one says EMPTY: they are not of one solid;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the octrees stay as they are; give `*result` back with leafless_octree_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any octrees; damage in ones that were mapped unverified is an error or reads as
///   PARTIAL.
leafless_status leafless_octree_join(const leafless_octree *const *octrees, uint64_t count,
    const leafless_options *options, leafless_octree **result);

/// The codes of the cells of a level of which an octree knows nothing. Each of them is PARTIAL, or lies in a
/// PARTIAL cell, and no surfaces are kept there. If the octree is a top of that level, each of these cells
/// needs a shard. O(cells of the levels above, and of the result).
///
/// - Buffers: `codes`, room for `capacity` numbers, or NULL to ask for the count only; `count`, one number.
/// - Result: `codes`, ascending, as in leafless_shard; `*count`.
/// - Errors: LEAFLESS_E_ARGUMENT if `level` is greater than the octree's depth; LEAFLESS_E_BUFFER if the
///   capacity is too small; LEAFLESS_E_LIMIT if there are more than 2^24 cells; LEAFLESS_E_DAMAGED;
///   LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree, any number.
leafless_status leafless_octree_open_cells(const leafless_octree *octree, uint32_t level, uint64_t *codes,
    uint64_t capacity, uint64_t *count);

/// The statistics of the octree that leafless_octree_join makes of a top and its shards, level by level.
/// Nothing is joined: a shard is told by its counts, which leafless_octree_levels gives on the machine that
/// has the shard. The cell of a missing shard is PARTIAL. O(cells × depth).
///
/// Only `nodes`, `full` and `partial` of the counts are read.
///
/// - Buffers: `codes`, `code_count` numbers as in leafless_shard, which ascend: the cells of the shards, all
///   of level `level`; `levels`, `level_count` structs: depth + 1 of the first shard, from the universe on,
///   then those of the second one, and so on; `joined`, room for `capacity` structs, or NULL to ask for the
///   count only; `count`, one number.
/// - Result: `*count`, depth + 1; `joined`, the levels of the whole as leafless_octree_levels gives them. The
///   last one has the volume.
/// - Errors: LEAFLESS_E_ARGUMENT if `level` is not less than the depth, a code is not less than 8^level, the
///   codes do not ascend, `level_count` is not `code_count` × (depth + 1), a cell is not open in `octree`, or
///   a shard does not split its cell: join such a shard and the top (leafless_octree_join), and pass the
///   result as the top; LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree, any numbers; of wrong counts the statistics are wrong.
leafless_status leafless_octree_statistics_with(const leafless_octree *octree, uint32_t level,
    const uint64_t *codes, uint64_t code_count, const leafless_statistics *levels, uint64_t level_count,
    leafless_statistics *joined, uint64_t capacity, uint64_t *count);

/// A top and its shards as a solid on their universe. The solid answers as the joined octree does
/// (leafless_octree_join, leafless_solid_from_octree), and nothing is joined. The library looks at a shard
/// when one of its cells is asked for, so that a file that is mapped is not read before. The cell of a
/// missing shard is PARTIAL.
///
/// The solid keeps no list of surfaces. To build its extended octree, join the shards.
///
/// - Buffers: `codes`, `count` numbers as in leafless_shard, in any order: the cells of the shards, all of
///   level `level`; `octrees`, `count` handles: the shards; `solid`, one pointer.
/// - Result: `*solid`. O(shards).
/// - Errors: LEAFLESS_E_FRAME if the frames differ; LEAFLESS_E_NULL, also of an element; LEAFLESS_E_ARGUMENT
///   if `level` is greater than the depth, a code is not less than 8^level, or two shards have one cell;
///   LEAFLESS_E_NO_MEMORY. Asking the solid returns LEAFLESS_E_DAMAGED if an octree was mapped unverified and
///   its links are damaged.
/// - Ownership: the solid shares the octrees, which may be freed; give `*solid` back with
///   leafless_solid_free.
/// - Untrusted input: any octrees, any numbers.
leafless_status leafless_solid_from_shards(const leafless_octree *top, uint32_t level, const uint64_t *codes,
    const leafless_octree *const *octrees, uint64_t count, leafless_solid **solid);

/* ---- 16. Points and boxes ----------------------------------------------------------------------------- */

/// The answer to a point query.
LEAFLESS_ENUM(leafless_membership, uint8_t) {
    LEAFLESS_MEMBERSHIP_OUTSIDE = 0,  ///< Proven outside.
    LEAFLESS_MEMBERSHIP_INSIDE = 1,  ///< Proven inside.
    LEAFLESS_MEMBERSHIP_UNDECIDED = 2,  ///< In a PARTIAL cell, outside of the universe, or not a number.
};

/// The answer to a box query. Each is proven, except UNDECIDED.
LEAFLESS_ENUM(leafless_region, uint8_t) {
    LEAFLESS_REGION_OUTSIDE = 0,  ///< The interiors of box and solid are disjoint.
    LEAFLESS_REGION_INSIDE = 1,  ///< The box lies in the solid.
    LEAFLESS_REGION_UNDECIDED = 2,  ///< Nothing could be proven at the octree's depth.
    LEAFLESS_REGION_CROSSING = 3,  ///< Part of the box lies inside, part outside.
};

/// Whether the solid contains a point. A point on the boundary may be answered either way; one that is
/// outside of the universe or not a number is undecided. At most ⌈depth/2⌉ array elements are read.
///
/// - Buffers: `point_model`, 3 numbers; `membership`, one.
/// - Result: `*membership`.
/// - Untrusted input: any octree, any numbers; damage reads as undecided.
leafless_status leafless_octree_contains(const leafless_octree *octree, const double point_model[3],
    leafless_membership *membership);

/// As leafless_octree_contains for many points at once, which is faster than one by one.
///
/// - Buffers: `points_model`, `count` points of 3 numbers; `memberships`, room for `count`. Both may be NULL
///   if `count` is 0.
/// - Result: `memberships[i]` for point i.
/// - Untrusted input: any octree, any numbers; damage reads as undecided.
leafless_status leafless_octree_contains_many(const leafless_octree *octree, const double *points_model,
    uint64_t count, leafless_membership *memberships);

/// The tag of a finest cell.
///
/// - Buffers: `cell`, 3 numbers; `tag`, one.
/// - Result: `*tag`: EMPTY, FULL or PARTIAL; PARTIAL if a coordinate is not below 2^depth.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
leafless_status leafless_octree_tag_at(const leafless_octree *octree, const uint32_t cell[3],
    leafless_tag *tag);

/// How a box lies to the solid; what of it lies outside of the universe is undecided.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `region`, one.
/// - Result: `*region`.
/// - Errors: LEAFLESS_E_ARGUMENT if min > max on an axis, or a coordinate is not a number.
/// - Untrusted input: any octree, any numbers; no array element is read twice; damage reads as undecided.
leafless_status leafless_octree_classify_box(const leafless_octree *octree, const double min_model[3],
    const double max_model[3], leafless_region *region);

/// Whether a solid contains points, without an octree: a point in a cell of the frame that is undecided at
/// the frame's depth, outside of the universe, or not a number is undecided. A point on the boundary may be
/// answered either way. The host's own `contains` is asked first, where there is one; for others at most one
/// cell a level is split a point, and points near each other share the way.
///
/// - Buffers: `frame`, one struct; `points_model`, `count` points of 3 numbers; `options`, one struct or
///   NULL, of which limits do not matter; `memberships`, room for `count`. `points_model` and `memberships`
///   may be NULL if `count` is 0.
/// - Result: `memberships[i]` for point i; the same for any number of threads.
/// - Errors: LEAFLESS_E_FRAME if the solid belongs to another frame; LEAFLESS_E_ARGUMENT as
///   leafless_frame_check; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any solid, any numbers.
leafless_status leafless_solid_contains_many(const leafless_solid *solid, const leafless_frame *frame,
    const double *points_model, uint64_t count, const leafless_options *options,
    leafless_membership *memberships);

/// How a box lies to a solid, without an octree, as far as cells of the frame tell; what of the box lies
/// outside of the universe is undecided. The work ends as soon as the answer is known, or once `max_splits`
/// cells are split.
///
/// - Buffers: `frame`, one struct; `min_model` and `max_model`, 3 numbers each; `options`, one struct or
///   NULL; `region`, one.
/// - Result: `*region`.
/// - Errors: LEAFLESS_E_ARGUMENT if min > max on an axis, or a coordinate is not a number; else as
///   leafless_solid_contains_many.
/// - Untrusted input: any solid, any numbers; set `max_splits` where the depth or the solid is not your own
///   choice.
leafless_status leafless_solid_classify_box(const leafless_solid *solid, const leafless_frame *frame,
    const double min_model[3], const double max_model[3], const leafless_options *options,
    leafless_region *region);

/// Makes a point cursor.
///
/// - Buffers: `cursor`, one pointer.
/// - Result: `*cursor`.
/// - Ownership: the cursor shares the octree, which may be freed; give `*cursor` back with
///   leafless_point_cursor_free.
/// - Untrusted input: any octree.
leafless_status leafless_point_cursor_new(const leafless_octree *octree, leafless_point_cursor **cursor);

/// Gives back a point cursor.
///
/// - Buffers: `cursor`, a handle or NULL, which does nothing.
/// - Ownership: the handle is gone.
/// - Threads: no other call may use the handle.
void leafless_point_cursor_free(leafless_point_cursor *cursor);

/// As leafless_octree_contains.
///
/// - Buffers: `point_model`, 3 numbers; `membership`, one.
/// - Result: `*membership`.
/// - Threads: no other call may use the cursor.
/// - Untrusted input: any octree, any numbers; damage reads as undecided.
leafless_status leafless_point_cursor_contains(leafless_point_cursor *cursor, const double point_model[3],
    leafless_membership *membership);

/// As leafless_octree_tag_at.
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
/// - Result: `*table`; `*table_level`: the level of the table's cells, `level` or the next coarser one that
///   the octree's arrays lead to, which hold two levels each. Levels beyond 8, and beyond the octree's depth,
///   count as these.
/// - Errors: LEAFLESS_E_NO_MEMORY.
/// - Ownership: the table shares the octree, which may be freed; give `*table` back with
///   leafless_point_table_free.
/// - Untrusted input: any octree; work is bounded by 8^level.
leafless_status leafless_point_table_new(const leafless_octree *octree, uint8_t level,
    leafless_point_table **table, uint8_t *table_level);

/// Gives back a point table.
///
/// - Buffers: `table`, a handle or NULL, which does nothing.
/// - Ownership: the handle is gone.
/// - Threads: no other call may use the handle.
void leafless_point_table_free(leafless_point_table *table);

/// As leafless_octree_contains.
///
/// - Buffers: `point_model`, 3 numbers; `membership`, one.
/// - Result: `*membership`.
/// - Untrusted input: any octree, any numbers; damage reads as undecided.
leafless_status leafless_point_table_contains(const leafless_point_table *table, const double point_model[3],
    leafless_membership *membership);

/// As leafless_octree_contains_many.
///
/// - Buffers: `points_model`, `count` points of 3 numbers; `memberships`, room for `count`. Both may be NULL
///   if `count` is 0.
/// - Result: `memberships[i]` for point i.
/// - Untrusted input: any octree, any numbers; damage reads as undecided.
leafless_status leafless_point_table_contains_many(const leafless_point_table *table,
    const double *points_model, uint64_t count, leafless_membership *memberships);

/* ---- 17. Cells of octrees ----------------------------------------------------------------------------- */

/// Where a cursor stands.
typedef struct leafless_cursor_info {
    uint32_t struct_size;  ///< sizeof(leafless_cursor_info).
    uint32_t cell[3];  ///< The cell's place among those of its level, per axis.
    uint32_t level;  ///< The cell's level; 0 is the universe.
    leafless_tag tag;  ///< The cell's tag.
    /// Of a BRANCH the tags of its children, in octant order (bit 0 of the octant is x, bit 1 y, bit 2 z);
    /// else eight times the cell's own.
    leafless_tag children[8];
} leafless_cursor_info;

/// Makes a cursor that stands on the universe.
///
/// - Buffers: `cursor`, one pointer.
/// - Result: `*cursor`.
/// - Ownership: the cursor shares the octree, which may be freed; give `*cursor` back with
///   leafless_cursor_free.
/// - Untrusted input: any octree.
leafless_status leafless_cursor_new(const leafless_octree *octree, leafless_cursor **cursor);

/// Gives back a cursor.
///
/// - Buffers: `cursor`, a handle or NULL, which does nothing.
/// - Ownership: the handle is gone.
/// - Threads: no other call may use the handle.
void leafless_cursor_free(leafless_cursor *cursor);

/// Where a cursor stands.
///
/// - Buffers: `state`, one struct.
/// - Result: `*state`.
/// - Threads: any, while nobody moves the cursor.
/// - Untrusted input: any octree.
leafless_status leafless_cursor_describe(const leafless_cursor *cursor, leafless_cursor_info *state);

/// Moves a cursor to a child of its cell. On a cell that is no BRANCH it stays where it is.
///
/// - Buffers: `moved`, one truth value, or NULL. `octant` is 0 to 7.
/// - Result: `*moved`, whether the cell is a BRANCH.
/// - Errors: LEAFLESS_E_ARGUMENT if `octant` is not 0 to 7.
/// - Threads: no other call may use the cursor.
/// - Untrusted input: any octree; damage reads as PARTIAL, so that a walk visits every cell at most once.
leafless_status leafless_cursor_descend(leafless_cursor *cursor, uint32_t octant, bool *moved);

/// Moves a cursor to the parent of its cell. On the universe it stays where it is.
///
/// - Buffers: `moved`, one truth value, or NULL.
/// - Result: `*moved`, whether there is a parent.
/// - Threads: no other call may use the cursor.
/// - Untrusted input: any octree.
leafless_status leafless_cursor_ascend(leafless_cursor *cursor, bool *moved);

/// A cell of an octree and what is known of it.
typedef struct leafless_cell {
    /// The cell's place among those of its level, per axis: its lower corner in units of its edge.
    uint32_t cell[3];
    uint32_t level;  ///< The cell's level; 0 is the universe.
    leafless_tag tag;  ///< The cell's tag.
} leafless_cell;

/// A square between two cells that are not split: one of a tag that was asked for, and one of another. It is
/// a whole face of the smaller one.
typedef struct leafless_boundary_face {
    leafless_cell inner;  ///< The cell of a tag that was asked for.
    /// The cell of another tag. Outside of the universe: the inner cell's place and level, with the
    /// exterior's tag.
    leafless_cell outer;
    uint8_t axis;  ///< The axis from the inner cell to the outer one: 0 is x, 1 y, 2 z.
    bool is_upper;  ///< Whether the outer cell lies above the inner one on that axis.
    bool has_outer;  ///< Whether the outer cell lies in the universe.
} leafless_boundary_face;

/// Which tags' cells are wanted: one of these values, or several joined by `|`.
LEAFLESS_ENUM(leafless_tags, uint32_t) {
    LEAFLESS_TAGS_EMPTY = 1,  ///< EMPTY cells.
    LEAFLESS_TAGS_BRANCH = 2,  ///< BRANCH cells: those that are cut and split.
    LEAFLESS_TAGS_PARTIAL = 4,  ///< PARTIAL cells.
    LEAFLESS_TAGS_FULL = 8,  ///< FULL cells.
    LEAFLESS_TAGS_LEAVES = 13,  ///< All cells that are not split.
};

/// The box of a cell of any level, in model units: the doubles nearest to its corners that contain it.
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
/// - Result: `*reached`, whether the cursor stands on the cell itself.
/// - Errors: LEAFLESS_E_ARGUMENT if `level` is greater than the octree's depth, or a coordinate of `cell` not
///   below 2^level; the cursor then stays where it is.
/// - Threads: no other call may use the cursor.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
leafless_status leafless_cursor_seek(leafless_cursor *cursor, const uint32_t cell[3], uint32_t level,
    bool *reached);

/// The neighbour of a cursor's cell through a face, an edge or a vertex: the cell of the same size, which is
/// a BRANCH if it is split, or the larger one that contains it and is not split. The cursor stays where it
/// is. Along a walk amortised O(1), at most O(depth).
///
/// - Buffers: `direction`, 3 numbers of -1, 0 and 1: the steps along x, y and z; `neighbour`, one struct;
///   `exists`, one truth value, or NULL.
/// - Result: `*neighbour`; `*exists`, whether it lies in the universe. If not, `*neighbour` is the cursor's
///   own cell with the exterior's tag.
/// - Errors: LEAFLESS_E_ARGUMENT if `direction` is none.
/// - Threads: any, while nobody moves the cursor.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
leafless_status leafless_cursor_neighbour(const leafless_cursor *cursor, const int32_t direction[3],
    leafless_cell *neighbour, bool *exists);

/// All cells that are not split and touch a cursor's cell on one side: one that is at least as large, or the
/// smaller ones at its face, edge or vertex, in Morton order.
///
/// - Buffers: `direction`, 3 numbers of -1, 0 and 1: the steps along x, y and z; `cells`, room for `capacity`
///   structs, or NULL to ask for the count only; `count`, one number.
/// - Result: `*count`, 0 if the side lies on the boundary of the universe; the cells.
/// - Errors: LEAFLESS_E_ARGUMENT if `direction` is none; LEAFLESS_E_BUFFER if the capacity is too small.
/// - Threads: any, while nobody moves the cursor.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL, and no array element is met twice.
leafless_status leafless_cursor_neighbours(const leafless_cursor *cursor, const int32_t direction[3],
    leafless_cell *cells, uint64_t capacity, uint64_t *count);

/// Cells of an octree one after another, in Morton order: those of some tags, on some levels, in a box. A
/// cell that is split comes before the cells in it. It reads no parts of the octree outside of the box or
/// below the levels.
///
/// - Buffers: `min_cell` and `max_cell`, 3 numbers each, or NULL both for the whole universe: the first
///   finest cell of the box on each axis, and the first beyond it; `cells`, one pointer. `tags` are
///   leafless_tags. `min_level` and `max_level` may be greater than the depth.
/// - Result: `*cells`, which stands before the first such cell.
/// - Errors: LEAFLESS_E_ARGUMENT if `tags` are none.
/// - Ownership: `*cells` shares the octree, which may be freed; give it back with leafless_cells_free.
/// - Untrusted input: any octree, any numbers.
leafless_status leafless_cells_new(const leafless_octree *octree, uint32_t tags, uint32_t min_level,
    uint32_t max_level, const uint32_t min_cell[3], const uint32_t max_cell[3], leafless_cells **cells);

/// Gives back what leafless_cells_new made.
///
/// - Buffers: `cells`, a handle or NULL, which does nothing.
/// - Ownership: the handle is gone.
/// - Threads: no other call may use the handle.
void leafless_cells_free(leafless_cells *cells);

/// Goes on from a cell: the next one is that cell, or the one that contains it and is not split, or the first
/// wanted one after it in Morton order. O(depth).
///
/// - Buffers: `cell`, 3 numbers.
/// - Errors: LEAFLESS_E_ARGUMENT if `level` is greater than the octree's depth, or a coordinate of `cell` not
///   below 2^level; nothing then changes.
/// - Threads: no other call may use `cells`.
/// - Untrusted input: any octree, any numbers.
leafless_status leafless_cells_seek(leafless_cells *cells, const uint32_t cell[3], uint32_t level);

/// Reads the next cells.
///
/// - Buffers: `buffer`, room for `capacity` structs, which may be NULL if `capacity` is 0; `count`, one
///   number.
/// - Result: the cells; `*count`, how many: fewer than `capacity` only if there are no more.
/// - Threads: no other call may use `cells`.
/// - Untrusted input: any octree; damage reads as PARTIAL, and no array element is met twice.
leafless_status leafless_cells_next(leafless_cells *cells, leafless_cell *buffer, uint64_t capacity,
    uint64_t *count);

/// Boundary faces of an octree one after another: those between cells of some tags and cells of others, which
/// are both not split. With FULL, the boundary of what is surely solid; with FULL and PARTIAL, of what is
/// possibly solid. Where cells of different sizes meet there is one face for each of the smaller ones. What
/// is outside of the universe has the exterior's tag. They come in Morton order of the inner cells, for each
/// of these in the order -z, -y, -x, +x, +y, +z, and for each side in the Morton order of the outer cells.
///
/// - Buffers: as leafless_cells_new; levels and box are those of the inner cells; `faces`, one pointer.
///   BRANCH among the tags does nothing.
/// - Result: `*faces`, which stands before the first face.
/// - Errors: LEAFLESS_E_ARGUMENT if `tags` are none.
/// - Ownership: `*faces` shares the octree, which may be freed; give it back with leafless_faces_free.
/// - Untrusted input: any octree, any numbers.
leafless_status leafless_faces_new(const leafless_octree *octree, uint32_t tags, uint32_t min_level,
    uint32_t max_level, const uint32_t min_cell[3], const uint32_t max_cell[3], leafless_faces **faces);

/// Gives back what leafless_faces_new made.
///
/// - Buffers: `faces`, a handle or NULL, which does nothing.
/// - Ownership: the handle is gone.
/// - Threads: no other call may use the handle.
void leafless_faces_free(leafless_faces *faces);

/// Goes on with the faces of a cell, or of the one that contains it and is not split, or of the first wanted
/// one after it in Morton order. O(depth).
///
/// - Buffers: `cell`, 3 numbers.
/// - Errors: LEAFLESS_E_ARGUMENT if `level` is greater than the octree's depth, or a coordinate of `cell` not
///   below 2^level; nothing then changes.
/// - Threads: no other call may use `faces`.
/// - Untrusted input: any octree, any numbers.
leafless_status leafless_faces_seek(leafless_faces *faces, const uint32_t cell[3], uint32_t level);

/// Reads the next faces.
///
/// - Buffers: `buffer`, room for `capacity` structs, which may be NULL if `capacity` is 0; `count`, one
///   number.
/// - Result: the faces; `*count`, how many: fewer than `capacity` only if there are no more.
/// - Threads: no other call may use `faces`.
/// - Untrusted input: any octree; damage reads as PARTIAL. An array element is met once for its own cells,
///   and no oftener for those beside them than in a sound octree: six times.
leafless_status leafless_faces_next(leafless_faces *faces, leafless_boundary_face *buffer, uint64_t capacity,
    uint64_t *count);

/// The cells of a level in a box as bits: `inner` tells which are FULL, and `outer` which are not EMPTY.
/// Those that only `outer` has are PARTIAL, or are cut further.
///
/// The bit of the cell min_cell + (x, y, z) is bit x mod 64 of word x / 64 + w (y + ny z), where w = ⌈nx /
/// 64⌉, and nx, ny and nz are max_cell - min_cell: x is fastest, each row begins with a word of its own, and
/// bits beyond a row are 0. That is LEAFLESS_SAMPLE_TYPE_BITS, of which leafless_volume_new makes a volume
/// again.
///
/// Time is linear in the words and the array elements in the box.
///
/// - Buffers: `min_cell` and `max_cell`, 3 numbers each: the first cell of the box, and the first one beyond
///   it on each axis, in cells of `level`, which is 0 for the universe and the frame's depth for the finest;
///   `options`, one struct or NULL, of which limits do not matter; `inner` and `outer`, room for `capacity`
///   words each. `inner` is NULL to ask for the count only; `outer` may be NULL if it is not wanted. `count`,
///   one number.
/// - Result: `*count`, the words of a bitmap, w ny nz; the words, the same for any number of threads.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no such level, or the box is none or lies outside of the
///   universe; LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
leafless_status leafless_octree_bitmap(const leafless_octree *octree, uint32_t level,
    const uint32_t min_cell[3], const uint32_t max_cell[3], const leafless_options *options, uint64_t *inner,
    uint64_t *outer, uint64_t capacity, uint64_t *count);

/* ---- 18. Rays, columns, heights ----------------------------------------------------------------------- */

/// A half-line or a segment: the points origin + t · direction with 0 ≤ t ≤ t_last. A coordinate is zero or
/// has a magnitude between 2^-256 and 2^256.
typedef struct leafless_ray {
    double origin_model[3];  ///< Where the ray starts.
    double direction_model[3];  ///< Not zero, of any length. t is a distance if the length is 1.
    /// The greatest t: INFINITY for a half-line, or between 2^-256 and 2^256; 1 for the segment from
    /// `origin_model` to `origin_model` + `direction_model`.
    double t_last;
} leafless_ray;

/// Where a ray first meets a solid.
typedef struct leafless_ray_hit {
    /// The least t at which the ray is in the solid lies in this interval: before `lower` the ray is proven
    /// outside, at `upper` inside. `upper` is INFINITY if the ray is nowhere proven inside; then it may miss
    /// the solid. Both are INFINITY if nothing stops the ray.
    leafless_interval t;
    /// The outward normal of the face by which the ray enters the cell, or of the surface where the solid
    /// knows it better. Its length is 1 but for rounding; zero if the ray starts in the cell, or nothing
    /// stops it.
    double normal[3];
    uint32_t cell[3];  ///< The place of the first cell that stops the ray among those of its level, per axis.
    uint32_t level;  ///< The cell's level; 0 is the universe.
    /// The number of the surface that stops the ray, if the solid answers rays itself: of a mesh, the
    /// triangle's. Else, and where the ray meets what closes a hole of a mesh, UINT32_MAX.
    uint32_t surface;
    bool is_hit;  ///< Whether something stops the ray.
} leafless_ray_hit;

/// Which cells stop a ray.
LEAFLESS_ENUM(leafless_obstacle, uint32_t) {
    LEAFLESS_OBSTACLE_FULL = 0,  ///< What is proven to be solid: FULL cells.
    LEAFLESS_OBSTACLE_UPPER = 1,  ///< What may be solid: FULL and PARTIAL cells.
};

/// Whether two points see each other past a solid.
LEAFLESS_ENUM(leafless_sight, uint8_t) {
    LEAFLESS_SIGHT_CLEAR = 0,  ///< Proven: no point of the segment lies in the solid.
    LEAFLESS_SIGHT_BLOCKED = 1,  ///< Proven: some point of the segment lies in the solid, or on its surface.
    LEAFLESS_SIGHT_UNDECIDED = 2,  ///< Neither could be proven with the cells of the frame.
};

/// Where rays first meet an octree's cells, whatever they prove of the solid that it was made from. What lies
/// outside of the universe does not count. At most 3 · 2^depth cells a ray are looked at, about a dozen as a
/// rule.
///
/// - Buffers: `rays`, `count` structs; `hits`, room for `count`. Both may be NULL if `count` is 0. `on` is a
///   leafless_obstacle.
/// - Result: `hits[i]` for ray i.
/// - Errors: LEAFLESS_E_ARGUMENT if `on` is none, or a ray is not as leafless_ray says.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
leafless_status leafless_octree_cast_rays(const leafless_octree *octree, const leafless_ray *rays,
    uint64_t count, leafless_obstacle on, leafless_ray_hit *hits);

/// Where rays first meet a solid, without an octree, as far as cells of the frame tell, and what the solid
/// knows of the surface in the finest of them. What lies outside of the universe does not count. A ray splits
/// the PARTIAL cells that it passes up to the first FULL one: O(depth) cells across a surface, up to
/// O(2^depth) along one.
///
/// - Buffers: `frame`, one struct; `rays`, `count` structs; `options`, one struct or NULL, of which
///   `max_splits` counts for each ray by itself: cells that were not split count as PARTIAL; `hits`, room for
///   `count`. `rays` and `hits` may be NULL if `count` is 0. `on` is a leafless_obstacle.
/// - Result: `hits[i]` for ray i; the same for any number of threads.
/// - Errors: LEAFLESS_E_ARGUMENT if `on` is none, or a ray is not as leafless_ray says; else as
///   leafless_solid_contains_many.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any solid, any numbers; set `max_splits` where the depth or the solid is not your own
///   choice.
leafless_status leafless_solid_cast_rays(const leafless_solid *solid, const leafless_frame *frame,
    const leafless_ray *rays, uint64_t count, leafless_obstacle on, const leafless_options *options,
    leafless_ray_hit *hits);

/// Where a ray is in an octree's cells, whatever they prove of the solid that it was made from: intervals of
/// t that ascend, of which no two of a list meet. What lies outside of the universe does not count. O(cells
/// along the ray · depth).
///
/// - Buffers: `ray`, one struct; `inner` and `outer`, room for `inner_capacity` and `outer_capacity` structs,
///   each NULL to ask for its count only; `inner_count` and `outer_count`, one number each.
/// - Result: `inner`, where the ray is in FULL cells, rounded inward; `outer`, where it is in FULL or PARTIAL
///   cells, rounded outward; their counts.
/// - Errors: LEAFLESS_E_ARGUMENT if the ray is not as leafless_ray says; LEAFLESS_E_BUFFER if a capacity is
///   too small: nothing is written then; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
leafless_status leafless_octree_ray_spans(const leafless_octree *octree, const leafless_ray *ray,
    leafless_interval *inner, uint64_t inner_capacity, uint64_t *inner_count, leafless_interval *outer,
    uint64_t outer_capacity, uint64_t *outer_count);

/// Where a ray is in a solid, without an octree, as far as cells of the frame tell: intervals of t that
/// ascend, of which no two of a list meet. What lies outside of the universe does not count. The ray splits
/// all PARTIAL cells that it passes: O(depth) cells where it crosses a surface, up to O(2^depth) along one.
/// Asking for the counts costs as much as asking for the intervals.
///
/// - Buffers: as leafless_octree_ray_spans; `frame`, one struct; `options`, one struct or NULL, of which
///   `max_splits` counts: cells that were not split count as PARTIAL.
/// - Result: `inner`, where the ray is proven inside, rounded inward; `outer`, where it is not proven
///   outside, rounded outward; their counts.
/// - Errors: LEAFLESS_E_ARGUMENT if the ray is not as leafless_ray says; LEAFLESS_E_BUFFER if a capacity is
///   too small: nothing is written then; else as leafless_solid_contains_many.
/// - Untrusted input: any solid, any numbers; set `max_splits` where the depth or the solid is not your own
///   choice.
leafless_status leafless_solid_ray_spans(const leafless_solid *solid, const leafless_frame *frame,
    const leafless_ray *ray, const leafless_options *options, leafless_interval *inner,
    uint64_t inner_capacity, uint64_t *inner_count, leafless_interval *outer, uint64_t outer_capacity,
    uint64_t *outer_count);

/// Whether two points see each other past a solid, without an octree, as far as cells of the frame tell. If
/// the solid may go on outside of the universe and a point lies there, the answer is not
/// LEAFLESS_SIGHT_CLEAR. Costs as much as one ray of leafless_solid_cast_rays.
///
/// - Buffers: `frame`, one struct; `from_model` and `to_model`, 3 numbers each; `options`, one struct or
///   NULL, of which `max_splits` counts: cells that were not split count as PARTIAL; `sight`, one.
/// - Result: `*sight`.
/// - Errors: LEAFLESS_E_ARGUMENT if the points are equal, or a coordinate is not zero and not of a magnitude
///   between 2^-256 and 2^256; else as leafless_solid_contains_many.
/// - Untrusted input: any solid, any numbers; set `max_splits` where the depth or the solid is not your own
///   choice.
leafless_status leafless_solid_line_of_sight(const leafless_solid *solid, const leafless_frame *frame,
    const double from_model[3], const double to_model[3], const leafless_options *options,
    leafless_sight *sight);

/// Consecutive finest cells of a column.
typedef struct leafless_run {
    uint32_t start;  ///< The coordinate of the lowest cell along the column.
    uint32_t length;  ///< How many cells there are, at least one.
} leafless_run;

/// Where columns are looked at from.
LEAFLESS_ENUM(leafless_side, uint32_t) {
    LEAFLESS_SIDE_ABOVE = 0,  ///< From above, towards lower coordinates: what counts is the highest cell.
    LEAFLESS_SIDE_BELOW = 1,  ///< From below: what counts is the lowest cell.
};

/// Which of an octree's cells are solid in a rectangle of columns, whatever they prove of the solid that it
/// was made from. A column is a row of finest cells along an axis, from one side of the universe to the
/// other. It stands for all lines along the axis within it, such as the ray through the centres of its cells.
/// O(cells in the columns + columns · cells along each), counting cells as they are stored.
///
/// - Buffers: `first` and `end`, 2 numbers each, or NULL both for all columns: the coordinates of the first
///   column's cells on the other two axes in the order x, y, z, and the first beyond the last one's;
///   `columns`, one pointer. `axis` is 0 for x, 1 for y, 2 for z.
/// - Result: `*columns`, to be read with leafless_columns_copy.
/// - Errors: LEAFLESS_E_ARGUMENT if `axis` is greater than 2, `first` lies beyond `end`, or the columns reach
///   beyond the universe; LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*columns` back with leafless_columns_free.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL, and no array element is met twice.
leafless_status leafless_octree_columns(const leafless_octree *octree, uint32_t axis, const uint32_t first[2],
    const uint32_t end[2], leafless_columns **columns);

/// Which cells of a frame are solid in a rectangle of columns, without an octree: all PARTIAL cells in the
/// columns are split down to the frame's depth.
///
/// - Buffers: as leafless_octree_columns; `frame`, one struct; `options`, one struct or NULL, of which
///   `max_bytes` counts and `max_splits` does not.
/// - Result: `*columns`, to be read with leafless_columns_copy; the same for any number of threads.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_octree_columns; LEAFLESS_E_LIMIT if the result takes more than
///   `max_bytes`; else as leafless_solid_contains_many.
/// - Ownership: give `*columns` back with leafless_columns_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any solid, any numbers; choose the depth and the rectangle yourself.
leafless_status leafless_solid_columns(const leafless_solid *solid, const leafless_frame *frame,
    uint32_t axis, const uint32_t first[2], const uint32_t end[2], const leafless_options *options,
    leafless_columns **columns);

/// The runs of solid cells in columns, in compressed rows: those of column i are `runs[offsets[i]]` to before
/// `runs[offsets[i + 1]]`. They ascend, and no two of them touch. The column at steps (u, v) from the first
/// is i = v · width + u, of a rectangle that is `width` columns wide along the first of the other two axes.
///
/// - Buffers: `offsets`, room for `offset_capacity` numbers, and `runs`, room for `run_capacity` structs,
///   each NULL to ask for its count only; `offset_count` and `run_count`, one number each. `on` is a
///   leafless_obstacle: FULL for the cells that are proven to be solid, UPPER for those that may be.
/// - Result: `offsets`, one more than columns; `runs`; their counts.
/// - Errors: LEAFLESS_E_ARGUMENT if `on` is none; LEAFLESS_E_BUFFER if a capacity is too small: nothing is
///   written then.
leafless_status leafless_columns_copy(const leafless_columns *columns, leafless_obstacle on,
    uint64_t *offsets, uint64_t offset_capacity, uint64_t *offset_count, leafless_run *runs,
    uint64_t run_capacity, uint64_t *run_count);

/// Gives back what leafless_octree_columns or leafless_solid_columns made.
///
/// - Buffers: `columns`, a handle or NULL, which does nothing.
/// - Ownership: the handle is gone.
/// - Threads: no other call may use the handle.
void leafless_columns_free(leafless_columns *columns);

/// How far an octree's solid cells reach in a rectangle of columns, whatever they prove of the solid that it
/// was made from: a height map. Costs as leafless_octree_columns.
///
/// - Buffers: `first` and `end` as leafless_octree_columns; `heights_model`, room for `capacity` structs, or
///   NULL to ask for the count only; `count`, one number. `side` is a leafless_side.
/// - Result: `*count`, that of the columns; for each column, in the order of leafless_columns_copy, an
///   interval in which the greatest coordinate of the solid's points in the column lies, or from below the
///   least one. The end that needs a proof is infinite if no cell of the column is FULL. Both are -INFINITY
///   (from below INFINITY) if the column is empty.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_octree_columns, or if `side` is none; LEAFLESS_E_BUFFER if the
///   capacity is too small; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL, and no array element is met twice.
leafless_status leafless_octree_heights(const leafless_octree *octree, uint32_t axis, const uint32_t first[2],
    const uint32_t end[2], leafless_side side, leafless_interval *heights_model, uint64_t capacity,
    uint64_t *count);

/// How far a solid reaches in a rectangle of columns, without an octree, as far as cells of the frame tell: a
/// height map. PARTIAL cells in the columns are split down to the frame's depth, unless FULL ones hide them.
///
/// - Buffers: as leafless_octree_heights; `frame`, one struct; `options`, one struct or NULL, of which
///   `max_bytes` counts and `max_splits` does not.
/// - Result: as leafless_octree_heights; the same for any number of threads.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_octree_heights; LEAFLESS_E_BUFFER if the capacity is too small;
///   LEAFLESS_E_LIMIT if the result takes more than `max_bytes`; else as leafless_solid_contains_many.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any solid, any numbers; choose the depth and the rectangle yourself.
leafless_status leafless_solid_heights(const leafless_solid *solid, const leafless_frame *frame,
    uint32_t axis, const uint32_t first[2], const uint32_t end[2], leafless_side side,
    const leafless_options *options, leafless_interval *heights_model, uint64_t capacity, uint64_t *count);

/* ---- 19. Volumes, areas, bounding boxes --------------------------------------------------------------- */

/// How many finest cells of a solid lie in a region, between bounds. A cell where the region is FULL lies in
/// it, one where it is EMPTY does not, and one where it is PARTIAL may: so the bounds hold whether a cell
/// counts that lies in the region as a whole, whose centre does, or that has any volume in common with it.
typedef struct leafless_cells_in {
    uint64_t full_least;  ///< FULL cells of the solid that are proven to lie in the region.
    uint64_t full_most;  ///< FULL cells of the solid that may lie in the region.
    uint64_t upper_least;  ///< FULL and PARTIAL cells of the solid that are proven to lie in the region.
    uint64_t upper_most;  ///< FULL and PARTIAL cells of the solid that may lie in the region.
} leafless_cells_in;

/// The number of finest cells in a box that are surely solid (FULL), and of those that are possibly solid
/// (FULL or PARTIAL).
///
/// - Buffers: `min_cell` and `max_cell`, 3 numbers each: the first finest cell, and the first one beyond the
///   box on each axis; `least` and `most`, one number each.
/// - Result: `*least` and `*most`.
/// - Errors: LEAFLESS_E_ARGUMENT if the box is none, or lies outside of the universe.
/// - Untrusted input: any octree, any numbers; no array element is read twice; damage reads as PARTIAL.
leafless_status leafless_octree_cells_in_box(const leafless_octree *octree, const uint32_t min_cell[3],
    const uint32_t max_cell[3], uint64_t *least, uint64_t *most);

/// The volume that the solid has in common with a box whose faces may lie anywhere, as an octree's cells tell
/// it: FULL ones bound it from below, FULL and PARTIAL ones from above. Cells that the box cuts count with
/// the part in the box, rounded outward. What lies outside of the universe does not count.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `volume_model`, one struct.
/// - Result: `*volume_model`, in cubic model units.
/// - Errors: LEAFLESS_E_ARGUMENT if min > max on an axis, or a coordinate is not a number.
/// - Untrusted input: any octree, any numbers; no array element is read more than 27 times; damage reads as
///   PARTIAL.
leafless_status leafless_octree_volume_in_box(const leafless_octree *octree, const double min_model[3],
    const double max_model[3], leafless_interval *volume_model);

/// How a region lies to a solid, as far as cells of the frame tell: a ball, or any other solid.
/// LEAFLESS_REGION_INSIDE means that all of the region lies in the solid; LEAFLESS_REGION_OUTSIDE that the
/// interiors are disjoint, as they also are if the region is empty; LEAFLESS_REGION_CROSSING that some of the
/// region does and some does not. The work ends as soon as the answer is known, or once `max_splits` cells of
/// both are split.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `relation`, one.
/// - Result: `*relation`.
/// - Errors: LEAFLESS_E_FRAME if solid or region belong to another frame; LEAFLESS_E_ARGUMENT as
///   leafless_frame_check; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any solids; set `max_splits` where the depth or the solids are not your own choice.
leafless_status leafless_solid_classify_in(const leafless_solid *solid, const leafless_solid *region,
    const leafless_frame *frame, const leafless_options *options, leafless_region *relation);

/// How many finest cells of an octree lie in a region, which is a ball or any other solid. The octree's cells
/// are taken as they are, whatever they prove; what is not proven of the region counts as PARTIAL. What lies
/// outside of the universe does not count.
///
/// Where the region is FULL, whole subtrees are counted, 64 cells at a time; where it is EMPTY, nothing is
/// read; where it is undecided and the octree is not EMPTY, it is split, down to the octree's depth. Once
/// `max_splits` cells of both are split, the others count as undecided.
///
/// - Buffers: `options`, one struct or NULL; `cells`, one struct.
/// - Result: `*cells`.
/// - Errors: LEAFLESS_E_FRAME if the region belongs to another frame; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED
///   if the region is; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree, any region; no array element is read twice; damage reads as PARTIAL; set
///   `max_splits` where the depth or the region are not your own choice.
leafless_status leafless_octree_cells_in(const leafless_octree *octree, const leafless_solid *region,
    const leafless_options *options, leafless_cells_in *cells);

/// The volume that an octree and a region have in common, as the octree's cells tell it: FULL ones bound it
/// from below, FULL and PARTIAL ones from above. In a finest cell that the region cuts, its volume is known
/// as well as the region knows it there: that of a ball to the third order. What lies outside of the universe
/// does not count. The work is that of leafless_octree_cells_in, with a microsecond or two more for each cell
/// that is cut.
///
/// - Buffers: `options`, one struct or NULL; `volume_model`, one struct.
/// - Result: `*volume_model`, in cubic model units.
/// - Errors: as leafless_octree_cells_in.
/// - Untrusted input: as leafless_octree_cells_in.
leafless_status leafless_octree_volume_in(const leafless_octree *octree, const leafless_solid *region,
    const leafless_options *options, leafless_interval *volume_model);

/// How many finest cells of a frame lie in a solid and in a region, which is a ball or any other solid. What
/// is not proven of either counts as PARTIAL, and what lies outside of the universe does not count. No octree
/// is made: the time is about that of splitting the region's boundary inside of the solid and the solid's
/// boundary inside of the region, and the memory is proportional to the depth. Once `max_splits` cells of
/// both are split, the others count as undecided.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `cells`, one struct.
/// - Result: `*cells`.
/// - Errors: LEAFLESS_E_FRAME if solid or region belong to another frame; LEAFLESS_E_ARGUMENT as
///   leafless_frame_check; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any solids; set `max_splits` where the depth or the solids are not your own choice.
leafless_status leafless_solid_cells_in(const leafless_solid *solid, const leafless_solid *region,
    const leafless_frame *frame, const leafless_options *options, leafless_cells_in *cells);

/// The volume that a solid and a region have in common inside of a frame's universe: an interval that
/// contains the truth. In a cell of the finest level it is known as well as solid and region know it there.
/// The work is that of leafless_solid_cells_in, with a microsecond or two more for each cell that is cut. (To
/// split until a volume is known to a tolerance, use leafless_solid_measure on the intersection.)
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `volume_model`, one struct.
/// - Result: `*volume_model`, in cubic model units.
/// - Errors: as leafless_solid_cells_in.
/// - Untrusted input: as leafless_solid_cells_in.
leafless_status leafless_solid_volume_in(const leafless_solid *solid, const leafless_solid *region,
    const leafless_frame *frame, const leafless_options *options, leafless_interval *volume_model);

/// Why a search or a measurement ended.
LEAFLESS_ENUM(leafless_stop_reason, uint32_t) {
    LEAFLESS_STOP_REASON_TOLERANCE = 0,  ///< What was asked for is known well enough.
    LEAFLESS_STOP_REASON_BUDGET = 1,  ///< `max_splits` of the options, or the function's own limit, is spent.
    /// No cell is left whose split would help: what is undecided has the size of the frame's finest cells, or
    /// the solid itself knows no more about it, as an octree does of its PARTIAL cells.
    LEAFLESS_STOP_REASON_EXHAUSTED = 2,
};

/// Mass properties of a solid of density 1. All intervals contain the truth. All of it concerns the part
/// inside of the universe; unless `is_clipped` says otherwise, that is the whole solid.
typedef struct leafless_measures {
    uint32_t struct_size;  ///< sizeof(leafless_measures).
    leafless_interval volume_model;  ///< Volume.
    leafless_interval centroid_model[3];  ///< Centroid; all numbers unless `has_centroid`.
    /// Tensor of inertia about the model's origin, row by row: the integral of |p|²δij - pi·pj over the
    /// points p of the solid. So products of inertia are negative where the product of the coordinates is
    /// mostly positive.
    leafless_interval inertia_origin_model[9];
    /// The same about the solid's own centroid, wherever in the interval that lies.
    leafless_interval inertia_centroid_model[9];
    leafless_proof proof;  ///< What of the solid is proven: what is not counts as undecided.
    uint64_t splits;  ///< How many times a cell was split.
    uint32_t level;  ///< The finest level of which cells were looked at.
    leafless_stop_reason measured;  ///< Why it ended.
    /// Whether a cell is proven full: else the solid may be empty, and nothing is known of a centroid.
    bool has_centroid;
    bool is_clipped;  ///< Whether the solid may go on outside of the universe, or does.
    /// Whether the solid was not split because it knows its own moments, up to rounding: a mesh does that is
    /// closed and whose triangles do not intersect.
    bool is_exact;
} leafless_measures;

/// The area of a solid's boundary.
typedef struct leafless_surface_area {
    uint32_t struct_size;  ///< sizeof(leafless_surface_area).
    /// Area. It contains the truth; its upper end is infinite where nothing is known.
    leafless_interval area_model;
    uint64_t splits;  ///< How many times a cell was split.
    uint32_t level;  ///< The finest level of which cells were looked at.
    leafless_stop_reason measured;  ///< Why it ended.
    /// Whether the solid may go on outside of the universe, or does: then it is the boundary inside of it.
    bool is_clipped;
} leafless_surface_area;

/// The area of a solid's section with a plane.
typedef struct leafless_section_area {
    uint32_t struct_size;  ///< sizeof(leafless_section_area).
    leafless_interval area_model;  ///< Area. It contains the truth.
    leafless_proof proof;  ///< What of the solid is proven: what is not counts as undecided.
    uint64_t splits;  ///< How many times a cell was split.
    leafless_stop_reason measured;  ///< Why it ended.
    /// Whether the solid may go on outside of the universe, or does: then it is the section inside of it.
    bool is_clipped;
} leafless_section_area;

/// What is proven of a solid's bounding box inside of the universe.
typedef struct leafless_extent {
    uint32_t struct_size;  ///< sizeof(leafless_extent).
    leafless_interval min_model[3];  ///< Lower corner; all numbers if `is_empty`.
    leafless_interval max_model[3];  ///< Upper corner; all numbers if `is_empty`.
    leafless_proof proof;  ///< What of the solid is proven: what is not counts as undecided.
    uint64_t splits;  ///< How many times a cell was split.
    leafless_stop_reason measured;  ///< Why it ended.
    bool is_empty;  ///< Whether the solid is proven to be empty.
    /// Whether it is proven not to be. If neither is proven, the corners are those of what the solid may be.
    bool is_occupied;
    bool is_clipped;  ///< Whether the solid may go on outside of the universe, or does.
} leafless_extent;

/// Measures a solid in the universe of a frame, without building an octree: the cells of which most is in
/// doubt are split first, until the width of the volume's interval is at most `relative` times its middle or
/// at most `absolute_model` (cubic model units), `max_splits` of the options is spent (2^26 splits without
/// it), or nothing is left to split at the frame's depth. Under a budget the last whole pass counts. The
/// result is the same bit for bit for any number of threads.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL, of which `max_nodes` and `max_bytes` do not
///   matter; `measures`, one struct.
/// - Result: `*measures`.
/// - Errors: LEAFLESS_E_ARGUMENT, also if a tolerance is negative or not a number; LEAFLESS_E_FRAME if the
///   solid belongs to another frame; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any solid; set `max_splits` where the depth or the solid is not your own choice.
leafless_status leafless_solid_measure(const leafless_solid *solid, const leafless_frame *frame,
    double relative, double absolute_model, const leafless_options *options, leafless_measures *measures);

/// The area of a solid's boundary in the universe of a frame, as leafless_solid_measure finds the volume:
/// `relative` and `absolute_model` (square model units) say how wide the interval may be, and without
/// `max_splits` of the options it ends after 2^23 splits. With N splits the width goes down with 1/N on
/// curved surfaces; plane faces are exact. Where faces lie in planes of the frame's lattice, and the solid
/// ends inside of the universe, another lattice is taken. Of an octree that keeps surfaces, of one without
/// undecided cells, and of an expression that is clipped, faces between cells are counted as they are.
/// Nothing is known of other octrees, of a host program's functions, and of a clipped mesh with such faces.
///
/// - Buffers: as leafless_solid_measure; `surface`, one struct.
/// - Result: `*surface`.
/// - Errors: as leafless_solid_measure.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any solid; the default of `max_splits` bounds the work.
leafless_status leafless_solid_surface_area(const leafless_solid *solid, const leafless_frame *frame,
    double relative, double absolute_model, const leafless_options *options, leafless_surface_area *surface);

/// The area of a solid's section with a plane, in the universe of a frame. The plane goes through a point,
/// perpendicular to a normal of any length and either direction. The search splits only cells that the plane
/// runs through. It ends with LEAFLESS_STOP_REASON_TOLERANCE if the interval is no wider than `relative`
/// times its middle, or than `absolute_model` (square model units); with LEAFLESS_STOP_REASON_EXHAUSTED if no
/// cell is left whose split would help; with LEAFLESS_STOP_REASON_BUDGET after `max_splits` of the options,
/// or 2^20 splits if that is 0. With N splits the width goes down with 1/N² on curved surfaces of half-spaces
/// and what is made of them, with 1/N for other solids; plane faces of the former are known to rounding.
///
/// If faces of the solid lie in the plane, the sections on both sides of it differ. A plane perpendicular to
/// an axis is taken as the limit from above, in the universe's upper face as that from below. If it is a
/// plane of the lattice, the cells above it are those that count, and nothing is in doubt about faces there.
/// Of any other plane the area contains the limits from both sides, and faces that lie in it stay in doubt.
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

/// The bounding box of a solid in the universe of a frame: six intervals, one for each side. The search
/// splits only cells that may reach beyond what is proven solid. It ends with LEAFLESS_STOP_REASON_TOLERANCE
/// if no interval is wider than `tolerance_model`, or than 2^-44 of the universe's edge; with
/// LEAFLESS_STOP_REASON_EXHAUSTED if the outermost undecided cells cannot be split, and either the interval
/// is no wider than one of the frame's finest cells, or nothing else is left to split; with
/// LEAFLESS_STOP_REASON_BUDGET after `max_splits` of the options, or 2^20 splits if that is 0.
///
/// Of half-spaces and what is made of them, a corner of three plane faces is known to rounding, and a curved
/// side to some 10^-12 of the universe's edge at depth 20, after some hundred splits; a side that a cylinder
/// touches along a line takes more. Of other solids, with n the universe's edge over the tolerance, a curved
/// side takes some n splits and, unless it lies on a plane of the lattice, a flat one n².
///
/// - Buffers: as leafless_solid_measure; `extent`, one struct.
/// - Result: `*extent`.
/// - Errors: as leafless_solid_measure, with `tolerance_model` for its tolerances.
/// - Untrusted input: any solid; the default of `max_splits` bounds the work.
leafless_status leafless_solid_bounding_box(const leafless_solid *solid, const leafless_frame *frame,
    double tolerance_model, const leafless_options *options, leafless_extent *extent);

/// What is known of the volume and the moments of a solid in some cells of its frame.
///
/// Sums are exact: they are the same in any order, and subtracting what was added leaves what there was. So
/// several machines can measure the cells of one solid, and one of them adds up.
///
/// The struct has no pointers. A program may store it or send it to another machine as it lies in memory.
/// Only the version of the library that made a sum reads it. The functions refuse bytes that are no sum; they
/// cannot tell every damage.
typedef struct leafless_mass_sum {
    uint32_t struct_size;  ///< sizeof(leafless_mass_sum).
    uint8_t bytes[404];  ///< For the library alone.
} leafless_mass_sum;

/// Measures the part of a solid in one cell of a frame, as leafless_solid_measure measures the whole. The
/// tolerances concern the volume in the cell. A solid that knows its own moments is split all the same.
///
/// If the solid is an octree without surfaces, and both tolerances are 0, the sum over all cells of a level
/// has the measures of the whole octree.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL, of which `max_nodes` and `max_bytes` do not
///   matter; `sum`, one struct. `code` is that of a cell of level `level`, as in leafless_shard.
/// - Result: `*sum`.
/// - Errors: as leafless_solid_measure; LEAFLESS_E_ARGUMENT also if the frame does not have the cell.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any solid, any numbers; set `max_splits` where the depth or the solid is not your own
///   choice.
leafless_status leafless_solid_measure_cell(const leafless_solid *solid, const leafless_frame *frame,
    uint32_t level, uint64_t code, double relative, double absolute_model, const leafless_options *options,
    leafless_mass_sum *sum);

/// The sum of a cell of which nothing is known. Adding it to a sum takes nothing from what that sum proves.
///
/// To measure a top and its shards: take the sum of the top in the whole universe (level 0, code 0). For each
/// shard subtract the unknown sum of its cell, and add the sum of the shard in that cell.
///
/// - Buffers: `frame` and `sum`, one struct each. `code` is that of a cell of level `level`, as in
///   leafless_shard.
/// - Result: `*sum`.
/// - Errors: LEAFLESS_E_ARGUMENT if the frame does not have the cell.
/// - Untrusted input: any numbers.
leafless_status leafless_mass_sum_unknown(const leafless_frame *frame, uint32_t level, uint64_t code,
    leafless_mass_sum *sum);

/// The sum over the cells of two sums.
///
/// - Buffers: `a`, `b` and `sum`, one struct each; `sum` may be `a` or `b`.
/// - Result: `*sum`.
/// - Errors: LEAFLESS_E_ARGUMENT if `a` or `b` is no sum of this version, or if the result is more than the
///   universe holds: then a cell was added twice; LEAFLESS_E_FRAME if the frames differ.
/// - Untrusted input: any bytes; of damaged sums the result is wrong.
leafless_status leafless_mass_sum_add(const leafless_mass_sum *a, const leafless_mass_sum *b,
    leafless_mass_sum *sum);

/// The sum over the cells of `a` without those of `b`, which are some of them. What `a` proves, the result
/// proves. Splits are counted together.
///
/// - Buffers: as leafless_mass_sum_add.
/// - Result: `*sum`.
/// - Errors: LEAFLESS_E_ARGUMENT if `a` or `b` is no sum of this version, or if less than nothing would be
///   left; LEAFLESS_E_FRAME if the frames differ.
/// - Untrusted input: any bytes; of damaged sums the result is wrong.
leafless_status leafless_mass_sum_subtract(const leafless_mass_sum *a, const leafless_mass_sum *b,
    leafless_mass_sum *sum);

/// Volume, centroid and inertia of what is in the cells of a sum. `is_exact` is false.
///
/// - Buffers: `sum` and `measures`, one struct each.
/// - Result: `*measures`.
/// - Errors: LEAFLESS_E_ARGUMENT if `sum` is no sum of this version, or if the frame's universe is too small
///   for cells of level 20.
/// - Untrusted input: any bytes; of a damaged sum the measures are wrong.
leafless_status leafless_mass_sum_measures(const leafless_mass_sum *sum, leafless_measures *measures);

/* ---- 20. Distance and interference -------------------------------------------------------------------- */

/// What a distance is measured to.
LEAFLESS_ENUM(leafless_distance_to, uint32_t) {
    LEAFLESS_DISTANCE_TO_SOLID = 0,  ///< To the solid: 0 for its points.
    LEAFLESS_DISTANCE_TO_COMPLEMENT = 1,  ///< To what is not solid: 0 for points outside.
    /// To the boundary, with a sign: positive outside of the solid, negative inside.
    LEAFLESS_DISTANCE_TO_BOUNDARY = 2,
};

/// What is known of a point's distance from a solid.
typedef struct leafless_point_distance {
    /// The distance, in model units. The upper bound is infinite as long as nothing is proven to be there,
    /// and the lower one if it is proven that nothing is.
    leafless_interval distance_model;
    uint64_t splits;  ///< How many times a cell was split.
    /// The nearest point of the boundary, but for rounding, if `has_nearest`; else zeros.
    double nearest_model[3];
    /// The number of the surface that it lies on: of a mesh, the triangle's; of several, one that bounds the
    /// solid next to the point, if one is found. UINT32_MAX if there is none.
    uint32_t surface;
    leafless_stop_reason measured;  ///< Why the search ended.
    /// Whether the nearest point is known. A mesh within the universe tells it with the triangle, unless the
    /// nearest triangle intersects another one, or the boundary may lie nearer over a hole. Of other solids
    /// it is known if the upper bound is finite, unless the point may lie on the side of the boundary from
    /// which no distance is measured; then it is as near as that bound says.
    bool has_nearest;
} leafless_point_distance;

/// A cell near a point.
typedef struct leafless_near_cell {
    /// The point of the closed cell that is nearest to the given one: each coordinate is the given point's
    /// own, or a rounded one of the cell's faces.
    double point_model[3];
    /// The distance of the closed cell from the given point, rounded outward.
    leafless_interval distance_model;
    leafless_cell found;  ///< The cell and its tag.
} leafless_near_cell;

/// The distances of points from a solid, its complement or its boundary, as an octree's cells and its
/// exterior tell them. FULL cells bound a distance from the solid from above, FULL and PARTIAL ones from
/// below. Points may lie outside of the universe. Some dozen array elements are read a point as a rule.
///
/// - Buffers: `points_model`, `count` points of 3 numbers; `options`, one struct or NULL, of which limits do
///   not matter; `distances_model`, room for `count`. `points_model` and `distances_model` may be NULL if
///   `count` is 0. `to` is a leafless_distance_to.
/// - Result: `distances_model[i]` for point i, the same for any number of threads: 0 to infinity if a
///   coordinate is not a finite number, and all numbers for LEAFLESS_DISTANCE_TO_BOUNDARY.
/// - Errors: LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL, and for each point no more array
///   elements are read than twice those that there are.
leafless_status leafless_octree_distances(const leafless_octree *octree, const double *points_model,
    uint64_t count, leafless_distance_to to, const leafless_options *options,
    leafless_interval *distances_model);

/// The distances of points from a solid, its complement or its boundary, without an octree. Points may lie
/// outside of the universe of the frame. The cells that may be nearest are split first.
///
/// `measured` of a result says why the search for the point ended. With LEAFLESS_STOP_REASON_TOLERANCE the
/// interval is no wider than `tolerance_model` (model units), or both ends are infinite. With
/// LEAFLESS_STOP_REASON_EXHAUSTED no cell is left whose split would help, or of a solid without slabs, the
/// nearest undecided cell cannot be split, and the interval is no wider than twice the diagonal of the
/// frame's finest cells. With LEAFLESS_STOP_REASON_BUDGET `max_splits` cells were split for the point, or 65
/// 536 if that is 0.
///
/// - Buffers: `frame`, one struct; `points_model`, `count` points of 3 numbers; `options`, one struct or
///   NULL; `distances`, room for `count`. `points_model` and `distances` may be NULL if `count` is 0. `to` is
///   a leafless_distance_to.
/// - Result: `distances[i]` for point i, the same for any number of threads.
/// - Errors: LEAFLESS_E_FRAME if the solid belongs to another frame; LEAFLESS_E_ARGUMENT as
///   leafless_frame_check, or if the tolerance is negative or not a number; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any solid, any numbers; the default of `max_splits` bounds the work.
leafless_status leafless_solid_distances(const leafless_solid *solid, const leafless_frame *frame,
    const double *points_model, uint64_t count, leafless_distance_to to, double tolerance_model,
    const leafless_options *options, leafless_point_distance *distances);

/// The cells of an octree that are nearest to a point, of those whose tag is among `tags`: the nearest first,
/// and of equally near ones the first in Morton order. A cell is closed, as large as the octree has it, and
/// no BRANCH. With LEAFLESS_TAGS_FULL and a capacity of 1 this is the nearest cell that is proven solid. The
/// point may lie outside of the universe. It is rounded to 2^-56 of the universe's edge, or further out to
/// 2^-57 of its distance, before cells are compared.
///
/// - Buffers: `point_model`, 3 numbers; `cells`, room for `capacity` structs, which may be NULL if `capacity`
///   is 0; `count`, one number. `tags` is one or several leafless_tags.
/// - Result: `*count`, which is `capacity` unless the octree has fewer such cells; the cells.
/// - Errors: LEAFLESS_E_ARGUMENT if `tags` is none, or a coordinate is not a finite number;
///   LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL, and no more array elements are read
///   than there are.
leafless_status leafless_octree_nearest_cells(const leafless_octree *octree, const double point_model[3],
    uint32_t tags, leafless_near_cell *cells, uint64_t capacity, uint64_t *count);

/// The signed distances of the finest cells in a box from the boundary of the solid. Entry (z·ny + y)·nx + x,
/// two numbers, is for the cell `min_cell` + (x, y, z), where nx, ny and nz are `max_cell` − `min_cell`.
///
/// The interval between the two (model units) contains the signed distance of the cell's centre from the
/// boundary of any solid that the octree's cells and its exterior describe: positive outside, negative
/// inside. The field is that of the whole solid, also of what lies outside of the box. The ends are exact
/// distances from the nearest closed cells, but for one rounding, outward; they are infinite where there is
/// no such cell.
///
/// The time is linear in the cells of the box and a margin around it as wide as the largest distance. Memory
/// beside `field` is a quarter of a byte for each of these, and for each thread some 140 bytes for each cell
/// of a slice across z. A small box far away from the solid costs as much as leafless_octree_distances for
/// its cells.
///
/// - Buffers: `min_cell` and `max_cell`, 3 numbers each: the first finest cell, and the first one beyond the
///   box on each axis; `options`, one struct or NULL, of which limits do not matter; `field`, `capacity`
///   numbers, two for each cell, which may be NULL if there are none.
/// - Result: the field, the same for any number of threads.
/// - Errors: LEAFLESS_E_ARGUMENT if the box is none or lies outside of the universe, or if `capacity` is not
///   twice the number of its cells; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
leafless_status leafless_octree_distance_field(const leafless_octree *octree, const uint32_t min_cell[3],
    const uint32_t max_cell[3], const leafless_options *options, float *field, uint64_t capacity);

/// Whether the interiors of two solids have points in common.
LEAFLESS_ENUM(leafless_overlap, uint32_t) {
    LEAFLESS_OVERLAP_DISJOINT = 0,  ///< Proven: they have none. The solids may touch.
    LEAFLESS_OVERLAP_OVERLAPPING = 1,  ///< Proven: a ball lies in both.
    /// Not decided at the frame's depth, or before the splits were spent; or both solids go on outside of the
    /// universe, where they may overlap.
    LEAFLESS_OVERLAP_UNDECIDED = 2,
};

/// What is known of two solids inside of the universe of a frame.
typedef struct leafless_interference {
    /// The volume of what they have in common, in cubic model units; the upper bound is infinite if
    /// `is_clipped`.
    leafless_interval volume_model;
    leafless_proof proof_a;  ///< What of the first solid is proven: what is not counts as undecided.
    leafless_proof proof_b;  ///< What of the second solid is proven.
    uint64_t splits_a;  ///< Cells of the first solid that were split.
    uint64_t splits_b;  ///< Cells of the second solid that were split.
    uint32_t verdict;  ///< A leafless_overlap.
    uint32_t level;  ///< The finest level of which cells were looked at.
    /// If they are proven to overlap, the centre of a ball, all of which is proven to lie in both, in model
    /// units; else zeros. It is not the largest one.
    double ball_centre_model[3];
    double ball_radius_model;  ///< The radius of that ball.
    /// The cell in which that ball lies: its position in cells of its level; else zeros.
    /// leafless_frame_cell_bounds gives its box. (Of octrees under a map there may be none: they may overlap
    /// by less than a cell.)
    uint32_t witness[3];
    uint32_t witness_level;  ///< The level of that cell.
    /// Whether both solids may go on outside of the universe. Then they are not proven to be disjoint.
    bool is_clipped;
} leafless_interference;

/// What is known of the distance between two solids inside of the universe of a frame.
typedef struct leafless_clearance {
    uint32_t struct_size;  ///< sizeof(leafless_clearance).
    /// The least distance between points of the two, in model units: 0 if they touch or overlap. The upper
    /// bound is infinite as long as no point of one of them is proven, and the lower one too if one of them
    /// is proven to be empty.
    leafless_interval distance_model;
    /// If `has_nearest`, a point of the first solid, in model units. Both points are no further apart than
    /// the upper bound, but for the rounding of their coordinates; of solids with a `depth_model` both are
    /// the same. Else zeros.
    double point_a_model[3];
    double point_b_model[3];  ///< A point of the second solid.
    /// A unit vector that leads out of the first solid at its point, if one is known; else zeros.
    double normal_a[3];
    double normal_b[3];  ///< The same of the second solid.
    /// Of solids that overlap: the radius of a ball, in model units, that is proven to lie in both. 0 if none
    /// was found.
    double depth_model;
    leafless_proof proof_a;  ///< What of the first solid is proven: what is not counts as undecided.
    leafless_proof proof_b;  ///< What of the second solid is proven.
    uint64_t splits_a;  ///< Cells of the first solid that were split.
    uint64_t splits_b;  ///< Cells of the second solid that were split.
    /// If `has_nearest`, cells of the first and of the second solid with such points: the position of the
    /// first in cells of its level; else zeros.
    uint32_t nearest_a[3];
    uint32_t nearest_a_level;  ///< The level of that cell.
    uint32_t nearest_b[3];  ///< The position of the second.
    uint32_t nearest_b_level;  ///< The level of that cell.
    leafless_stop_reason measured;  ///< Why the search ended.
    bool has_nearest;  ///< Whether the upper bound is finite.
    /// Whether one of the solids may go on outside of the universe, of which nothing is said.
    bool is_clipped;
} leafless_clearance;

/// A solid, known on a frame of its own, under an affine map.
///
/// A cell is FULL or EMPTY if all the cells of the solid's own frame are that its inverse image touches:
/// cells of about its size, or larger ones that are decided. So a surface that is not parallel to the lattice
/// blurs by about a cell, down to the depth of the solid's own frame; rounding is outward. Where the map
/// takes lattice planes to lattice planes nothing blurs. What sticks out of the solid's own universe is
/// undecided, unless the solid is proven to end inside. (leafless_solid_placed moves a solid in the best way
/// that its kind knows, and chooses a frame where it takes one.)
///
/// - Buffers: `own`, one struct; `matrix`, 12 numbers, the rows of [M | t], where a point p goes to M p + t;
///   `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check, or if an entry is neither 0 nor of a magnitude
///   between 2^-64 and 2^64, or M is singular; LEAFLESS_E_LIMIT if too many transforms lie within each other.
///   Asking the result returns LEAFLESS_E_FRAME if `operand` belongs to another frame than `own`.
/// - Ownership: the operand is shared and may be freed; give `*solid` back with leafless_solid_free.
/// - Untrusted input: any solid and numbers.
leafless_status leafless_solid_transformed(const leafless_solid *operand, const leafless_frame *own,
    const double matrix[12], leafless_solid **solid);

/// As leafless_solid_transformed, but that LEAFLESS_RULE_SAMPLED decides every centre, by the cell of the
/// solid's own frame from which it comes: that cell is FULL, or its own centre lies inside.
///
/// So an octree that is made of samples is sampled again, on a lattice that is turned, coarser or finer,
/// where leafless_solid_transformed is refused with LEAFLESS_E_NOT_SAMPLED. A surface is displaced by up to
/// half a diagonal of the solid's own cells. A centre that comes from a face between two cells belongs to the
/// one above. Other rules, and all that is said of cells, are as for leafless_solid_transformed.
///
/// - Buffers: `own`, one struct; `matrix`, 12 numbers, the rows of [M | t], where a point p goes to M p + t;
///   `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: as leafless_solid_transformed. An octree by LEAFLESS_RULE_SAMPLED is refused with
///   LEAFLESS_E_NOT_SAMPLED only if a centre comes from a cell that is itself undecided:
///   leafless_octree_resolve decides those before.
/// - Ownership: the operand is shared and may be freed; give `*solid` back with leafless_solid_free.
/// - Untrusted input: any solid and numbers.
leafless_status leafless_solid_resampled(const leafless_solid *operand, const leafless_frame *own,
    const double matrix[12], leafless_solid **solid);

/// Whether two solids overlap, as they are in the universe of a frame. Once an overlap is proven its volume
/// is refined until the interval is no wider than `tolerance_model` cubic model units; infinity ends the work
/// with the proof.
///
/// Where both solids are made of surfaces (expressions of half-spaces, and octrees that keep their surfaces),
/// a surface that bounds both is one, however both were placed, and solids that touch in it from opposite
/// sides are proven to be disjoint. Meshes and functions of the host that touch stay undecided.
///
/// Only cells of one solid are split where the other one is. The work ends at the frame's depth, or once
/// `max_splits` cells of both are split, with what is known by then.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `interference`, one struct.
/// - Result: `*interference`.
/// - Errors: LEAFLESS_E_FRAME if a solid belongs to another frame; LEAFLESS_E_ARGUMENT as
///   leafless_frame_check, or if the tolerance is negative or not a number; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any solids; set `max_splits` where the depth or the solids are not your own choice.
leafless_status leafless_solid_interfere(const leafless_solid *a, const leafless_solid *b,
    const leafless_frame *frame, double tolerance_model, const leafless_options *options,
    leafless_interference *interference);

/// As leafless_solid_interfere of `a` with `b` under each of many affine maps, as leafless_solid_transformed
/// makes them. `max_splits` concerns each of them. The results are the same for any number of threads.
///
/// - Buffers: `own`, one struct, the frame of `b`; `matrices`, `count` times 12 numbers; `frame`, one struct,
///   that of `a`; `options`, one struct or NULL; `interferences`, room for `count`. `matrices` and
///   `interferences` may be NULL if `count` is 0.
/// - Result: `interferences[i]` for map i.
/// - Errors: as leafless_solid_interfere and leafless_solid_transformed; nothing is then written.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: as leafless_solid_interfere, and any numbers.
leafless_status leafless_solid_interfere_many(const leafless_solid *a, const leafless_solid *b,
    const leafless_frame *own, const double *matrices, uint64_t count, const leafless_frame *frame,
    double tolerance_model, const leafless_options *options, leafless_interference *interferences);

/// The distance between two solids, as they are in the universe of a frame.
///
/// `measured` of the result says why the search ended. With LEAFLESS_STOP_REASON_TOLERANCE the interval is no
/// wider than `tolerance_model` (model units). With LEAFLESS_STOP_REASON_EXHAUSTED the cells of the frame's
/// depth cannot raise the lower bound, and the interval is no wider than twice their diagonal, which is what
/// cells can tell of most solids; or no pair of cells is left; or a solid may go on outside of the universe,
/// which keeps the lower bound at 0. With LEAFLESS_STOP_REASON_BUDGET `max_splits` steps were taken, or 1 048
/// 576 if that is 0. A step looks at the children of one cell. A cell whose children are looked at again,
/// next to another cell, counts once more.
///
/// The distance of two closed meshes in the universe is found by their triangles, to rounding: some 10^-13 of
/// their sizes and of the distance. Bodies of a mesh may overlap, unless only positive winding numbers count,
/// triangles lie on each other, or vertices were moved. A step is then 64 pairs of boxes around triangles,
/// and no cells are split.
///
/// Where both solids know slabs, as expressions, open meshes and extended octrees do, each level makes the
/// interval about four times as narrow, and plane faces, balls and cylinders are known at once. Other solids
/// are known to the size of cells: the upper bound is finite once the search has met a FULL cell of each, and
/// the work grows with the area where the distance is about the least one, measured in cells as large as the
/// tolerance.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `clearance`, one struct.
/// - Result: `*clearance`.
/// - Errors: as leafless_solid_interfere.
/// - Untrusted input: any solids; the default of `max_splits` bounds the work.
leafless_status leafless_solid_clearance(const leafless_solid *a, const leafless_solid *b,
    const leafless_frame *frame, double tolerance_model, const leafless_options *options,
    leafless_clearance *clearance);

/// Whether two solids are at least as far apart as they should be.
LEAFLESS_ENUM(leafless_gap_verdict, uint32_t) {
    LEAFLESS_GAP_VERDICT_YES = 0,  ///< Proven: no two points of them are nearer.
    LEAFLESS_GAP_VERDICT_NO = 1,  ///< Proven: two points are nearer.
    /// Not decided at the frame's depth, or before the splits were spent; or a solid may go on outside of the
    /// universe.
    LEAFLESS_GAP_VERDICT_UNDECIDED = 2,
};

/// Whether two solids are at least as far apart as they should be, and what proves it.
typedef struct leafless_gap {
    uint32_t struct_size;  ///< sizeof(leafless_gap).
    uint32_t verdict;  ///< A leafless_gap_verdict.
    /// What was known of the distance when the search ended, in model units.
    leafless_interval distance_model;
    /// If `has_points`, a point of the first solid, in model units: both points are no further apart than the
    /// upper bound, but for the rounding of their coordinates. Else zeros.
    double point_a_model[3];
    double point_b_model[3];  ///< A point of the second solid.
    uint64_t splits_a;  ///< Cells of the first solid that were split.
    uint64_t splits_b;  ///< Cells of the second solid that were split.
    /// Why the search ended; LEAFLESS_STOP_REASON_TOLERANCE if the verdict is proven.
    leafless_stop_reason measured;
    bool has_points;  ///< Whether the upper bound is finite.
    /// Whether one of the solids may go on outside of the universe, of which nothing is said.
    bool is_clipped;
} leafless_gap;

/// Whether two solids, one of which is moved, are at least as far apart as they should be.
typedef struct leafless_placed_gap {
    leafless_interval distance_model;  ///< As leafless_gap has it.
    double point_a_model[3];  ///< If `has_points`, a point of the first solid, in model units; else zeros.
    double point_b_model[3];  ///< A point of the second solid.
    uint64_t splits_a;  ///< Cells of the first solid that were split.
    uint64_t splits_b;  ///< Cells of the second solid that were split.
    uint32_t verdict;  ///< A leafless_gap_verdict.
    /// Why the search ended; LEAFLESS_STOP_REASON_TOLERANCE if the verdict is proven.
    leafless_stop_reason measured;
    bool has_points;  ///< Whether the upper bound is finite.
    /// Whether one of the solids may go on outside of the universe, of which nothing is said.
    bool is_clipped;
} leafless_placed_gap;

/// What is known of the distance between two solids, one of which is moved.
typedef struct leafless_placed_clearance {
    leafless_interval distance_model;  ///< As leafless_clearance has it.
    double point_a_model[3];  ///< If `has_points`, a point of the first solid, in model units; else zeros.
    double point_b_model[3];  ///< A point of the second solid.
    double depth_model;  ///< As leafless_clearance has it.
    uint64_t splits_a;  ///< Cells of the first solid that were split.
    uint64_t splits_b;  ///< Cells of the second solid that were split.
    leafless_stop_reason measured;  ///< Why the search ended.
    bool has_points;  ///< Whether the upper bound is finite.
    /// Whether one of the solids may go on outside of the universe, of which nothing is said.
    bool is_clipped;
} leafless_placed_clearance;

/// Whether no point of a solid is nearer than `least_model` to one of another solid, as they are in the
/// universe of a frame. The search ends as soon as that is proven or disproven. If the distance is
/// `least_model` to the last digit, nothing may be proven within `max_splits`, which are counted and limited
/// as for leafless_solid_clearance.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `gap`, one struct.
/// - Result: `*gap`.
/// - Errors: as leafless_solid_interfere; LEAFLESS_E_ARGUMENT also if `least_model` is not between 2^-256 and
///   2^256.
/// - Untrusted input: any solids; the default of `max_splits` bounds the work.
leafless_status leafless_solid_gap_at_least(const leafless_solid *a, const leafless_solid *b,
    const leafless_frame *frame, double least_model, const leafless_options *options, leafless_gap *gap);

/// As leafless_solid_clearance of `a` with `b` under each of many affine maps, as leafless_solid_transformed
/// makes them. `max_splits` concerns each of them. The results are the same for any number of threads.
///
/// - Buffers: `own`, one struct, the frame of `b`; `matrices`, `count` times 12 numbers; `frame`, one struct,
///   that of `a`; `options`, one struct or NULL; `clearances`, room for `count`. `matrices` and `clearances`
///   may be NULL if `count` is 0.
/// - Result: `clearances[i]` for map i.
/// - Errors: as leafless_solid_interfere and leafless_solid_transformed; nothing is then written.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: as leafless_solid_clearance, and any numbers.
leafless_status leafless_solid_clearance_many(const leafless_solid *a, const leafless_solid *b,
    const leafless_frame *own, const double *matrices, uint64_t count, const leafless_frame *frame,
    double tolerance_model, const leafless_options *options, leafless_placed_clearance *clearances);

/// As leafless_solid_gap_at_least of `a` with `b` under each of many affine maps, as
/// leafless_solid_transformed makes them. `max_splits` concerns each of them. The results are the same for
/// any number of threads.
///
/// - Buffers: `own`, one struct, the frame of `b`; `matrices`, `count` times 12 numbers; `frame`, one struct,
///   that of `a`; `options`, one struct or NULL; `gaps`, room for `count`. `matrices` and `gaps` may be NULL
///   if `count` is 0.
/// - Result: `gaps[i]` for map i.
/// - Errors: as leafless_solid_gap_at_least and leafless_solid_transformed; nothing is then written.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: as leafless_solid_gap_at_least, and any numbers.
leafless_status leafless_solid_gap_at_least_many(const leafless_solid *a, const leafless_solid *b,
    const leafless_frame *own, const double *matrices, uint64_t count, const leafless_frame *frame,
    double least_model, const leafless_options *options, leafless_placed_gap *gaps);

/// How far points of one boundary are from another one.
typedef struct leafless_one_way {
    /// The greatest distance of a point of the one boundary from the nearest point of the other, in model
    /// units. 0 if the first solid has no boundary; infinite if the second has none and the first has.
    leafless_interval distance_model;
    double point_model[3];  ///< If `has_witness`, a point next to the first boundary; else zeros.
    /// If `has_witness`, the first boundary is that near to the point, or nearer; else 0.
    double apart_model;
    /// If `has_witness`, the point next to the second boundary that is nearest to it, but for what is not
    /// known; else zeros.
    double nearest_model[3];
    bool has_witness;  ///< Whether the lower bound was found at a point.
} leafless_one_way;

/// Whether two boundaries are within a distance of each other.
LEAFLESS_ENUM(leafless_within, uint32_t) {
    LEAFLESS_WITHIN_YES = 0,  ///< Proven: each point of one boundary is that near to the other.
    LEAFLESS_WITHIN_NO = 1,  ///< Proven: a point of one boundary is further away from the other.
    LEAFLESS_WITHIN_UNDECIDED = 2,  ///< Not decided by what is known.
};

/// What is known of how far the boundaries of two solids are from each other.
typedef struct leafless_deviation {
    uint32_t struct_size;  ///< sizeof(leafless_deviation).
    /// The greater of both directions, in model units: the Hausdorff distance of the boundaries.
    leafless_interval distance_model;
    leafless_one_way a_to_b;  ///< How far points of the first boundary are from the second one.
    leafless_one_way b_to_a;  ///< How far points of the second boundary are from the first one.
    leafless_proof proof_a;  ///< What of the first solid is proven: what is not counts as undecided.
    leafless_proof proof_b;  ///< What of the second solid is proven.
    /// Cells of the first solid that were split; 0 if its boundary is known to consist of triangles.
    uint64_t splits_a;
    uint64_t splits_b;  ///< Cells of the second solid that were split.
    uint64_t cuts_a;  ///< How often pieces of the first boundary were cut.
    uint64_t cuts_b;  ///< How often pieces of the second boundary were cut.
    uint32_t verdict;  ///< A leafless_within: whether the boundaries are within `within_model` of each other.
    leafless_stop_reason measured;  ///< Why the search ended.
    /// Whether the first solid may go on outside of the universe, of which nothing is said.
    bool is_clipped_a;
    bool is_clipped_b;  ///< Whether the second solid may.
} leafless_deviation;

/// How far the boundaries of two solids are from each other, in both directions, as they are in the universe
/// of a frame.
///
/// The boundary of a closed mesh whose triangles do not intersect is known exactly, and the answer for two of
/// them is found to rounding. Of any other solid, cells are split until the slabs of each tell where the
/// boundary lies to a twelfth of `tolerance_model` (model units); what is not decided widens the intervals.
///
/// `measured` of the result says why the search ended. With LEAFLESS_STOP_REASON_TOLERANCE both intervals are
/// no wider than `tolerance_model`. With LEAFLESS_STOP_REASON_EXHAUSTED neither cells nor pieces of the
/// boundaries have more to tell. With LEAFLESS_STOP_REASON_BUDGET `max_splits` cells of a solid were split,
/// or 262 144 if that is 0, or 64 times as many pieces of a boundary cut, or `max_bytes` are near.
///
/// `verdict` of the result is a leafless_within: whether the boundaries are proven to be within
/// `within_model` of each other. If that is not a number, nothing is decided.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `deviation`, one struct.
/// - Result: `*deviation`.
/// - Errors: as leafless_solid_interfere.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any solids; the default of `max_splits` bounds the work.
leafless_status leafless_solid_deviation(const leafless_solid *a, const leafless_solid *b,
    const leafless_frame *frame, double tolerance_model, double within_model, const leafless_options *options,
    leafless_deviation *deviation);

/* ---- 21. Layouts: solids in a container --------------------------------------------------------------- */

/// The ways in which an item may be turned.
LEAFLESS_ENUM(leafless_orientations, uint32_t) {
    LEAFLESS_ORIENTATIONS_TURNS = 0,  ///< The 24 turns that take axes to axes. They are exact.
    LEAFLESS_ORIENTATIONS_AS_GIVEN = 1,  ///< Only as it is.
    /// As it is, and `free_count` turns by chance, evenly spread over all turns. They depend on the seed of
    /// the search.
    LEAFLESS_ORIENTATIONS_FREE = 2,
    LEAFLESS_ORIENTATIONS_LIST = 3,  ///< Any of `matrices`, of which only the linear part M counts.
};

/// What is said of an item beside its solid.
typedef struct leafless_item_options {
    uint32_t struct_size;  ///< sizeof(leafless_item_options).
    leafless_orientations orientations;  ///< A leafless_orientations: how a search may turn the item.
    double density;  ///< Mass per cubic model unit, a positive number; 0 means 1.
    /// Of LEAFLESS_ORIENTATIONS_LIST: `matrix_count` times 12 numbers, the rows of [M | t]. M must turn; it
    /// may neither mirror nor stretch lengths by more than 10^-9 of them.
    const double *matrices;
    uint64_t matrix_count;  ///< Of LEAFLESS_ORIENTATIONS_LIST: how many matrices there are, 1 to 4096.
    uint32_t free_count;  ///< Of LEAFLESS_ORIENTATIONS_FREE: how many turns by chance there are, 1 to 4096.
    uint32_t reserved;  ///< 0.
} leafless_item_options;

/// A bay with a container, without obstacles and items. The container is any solid that ends.
///
/// - Buffers: `bay`, one pointer. `clearance_model` is the least distance between two items, and between an
///   item and an obstacle; `wall_clearance_model` that between an item and what lies outside of the
///   container.
/// - Result: `*bay`.
/// - Errors: LEAFLESS_E_ARGUMENT if a distance is not between 0 and 2^64; if the container has no bounds, or
///   no extent along an axis.
/// - Ownership: the bay shares the container, which may be freed; give `*bay` back with leafless_bay_free.
/// - Untrusted input: any solid and numbers.
leafless_status leafless_bay_new(const leafless_solid *container, double clearance_model,
    double wall_clearance_model, leafless_bay **bay);

/// Gives back a bay. Layouts that were made of it stay.
///
/// - Buffers: `bay`, a handle or NULL, which does nothing.
/// - Ownership: the handle is gone.
/// - Threads: no other call may use the handle.
void leafless_bay_free(leafless_bay *bay);

/// Adds a solid that stands where it is, and that items must stay away from.
///
/// - Buffers: `number`, one number.
/// - Result: `*number`, which leafless_neighbour tells: obstacles are counted from 0.
/// - Errors: LEAFLESS_E_ARGUMENT if the solid has no bounds, or no extent along an axis;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: the bay shares the solid, which may be freed.
/// - Threads: any, but no other call may use the bay.
/// - Untrusted input: any solid.
leafless_status leafless_bay_add_obstacle(leafless_bay *bay, const leafless_solid *solid, uint64_t *number);

/// Adds an item: a solid, of which leafless_layout_search places so many copies. leafless_layout_place places
/// any number.
///
/// - Buffers: `item`, one struct or NULL, which means 24 turns and a density of 1; `number`, one number.
/// - Result: `*number`, by which leafless_layout_place takes it: items are counted from 0.
/// - Errors: LEAFLESS_E_ARGUMENT if the solid has no bounds, or no extent along an axis; if a field of `item`
///   is none of its enumeration, or is set though it is not used; if the density is neither 0 nor a positive
///   number; if a matrix does not turn, or there is none though there should be one; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the bay shares the solid, which may be freed. It copies the matrices.
/// - Threads: any, but no other call may use the bay.
/// - Untrusted input: any solid and numbers. A search takes memory for the cells of each orientation.
leafless_status leafless_bay_add_item(leafless_bay *bay, const leafless_solid *solid, uint32_t count,
    const leafless_item_options *item, uint64_t *number);

/// A copy of an item in its place.
typedef struct leafless_placement {
    uint64_t item;  ///< The number of the item.
    /// Where it stands: the rows of [M | t], where a point p of the item goes to M p + t.
    double matrix[12];
} leafless_placement;

/// What a copy may be too near to.
LEAFLESS_ENUM(leafless_beside, uint32_t) {
    LEAFLESS_BESIDE_WALL = 0,  ///< What lies outside of the container.
    LEAFLESS_BESIDE_OBSTACLE = 1,  ///< An obstacle.
    LEAFLESS_BESIDE_PLACED = 2,  ///< Another copy.
};

/// What is known of a copy and something beside it.
typedef struct leafless_neighbour {
    leafless_interval gap_model;  ///< The distance of the two, in model units: 0 if they touch or overlap.
    uint64_t number;  ///< The number of the obstacle or of the other copy; 0 for the wall.
    uint32_t beside;  ///< A leafless_beside: what is beside it.
    /// A leafless_gap_verdict: whether the two are proven to be as far apart as they should be, or not to be.
    uint32_t verdict;
} leafless_neighbour;

/// How a copy stands, and what is next to it.
typedef struct leafless_standing {
    uint32_t struct_size;  ///< sizeof(leafless_standing).
    /// A leafless_gap_verdict. YES: the copy is proven to lie in the container, to overlap with nothing, and
    /// to be as far from everything as it should be. NO: one of these is proven to be wrong.
    uint32_t verdict;
    /// How many neighbours are in the way, or may be: those of which YES is not proven. All are counted; no
    /// more than the first 256 are told.
    uint64_t conflict_count;
    uint64_t splits;  ///< Cells that were split.
    /// If `has_nearest`, what is next to the copy, but for the wall: the gap holds the least of all
    /// distances. Else it is UNDECIDED about the wall.
    leafless_neighbour nearest;
    bool has_nearest;  ///< Whether there is anything else in the container.
} leafless_standing;

/// How one of many copies stands.
typedef struct leafless_placed_standing {
    uint64_t conflict_count;  ///< As leafless_standing has it.
    uint64_t splits;  ///< Cells that were split.
    uint32_t verdict;  ///< A leafless_gap_verdict.
} leafless_placed_standing;

/// A layout of what a bay holds, in which nothing is placed. It takes the time that its solids take to be
/// prepared, once each.
///
/// - Buffers: `options`, one struct or NULL; `layout`, one pointer.
/// - Result: `*layout`.
/// - Errors: LEAFLESS_E_ARGUMENT if the container or an obstacle has no bounds, or no extent along an axis;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the layout shares the solids. The bay may be changed and freed, which does not concern the
///   layout. Give `*layout` back with leafless_layout_free.
/// - Untrusted input: any solids.
leafless_status leafless_layout_new(const leafless_bay *bay, const leafless_options *options,
    leafless_layout **layout);

/// Gives back a layout.
///
/// - Buffers: `layout`, a handle or NULL, which does nothing.
/// - Ownership: the handle is gone.
/// - Threads: no other call may use the handle.
void leafless_layout_free(leafless_layout *layout);

/// Places a copy of an item, wherever that is. Nothing is checked, and the count of the item is not looked
/// at.
///
/// - Buffers: `matrix`, 12 numbers, the rows of [M | t], where a point p of the item goes to M p + t;
///   `number`, one number.
/// - Result: `*number`, the number of the copy, which is greater by one than that of the last.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no such item; if an entry is neither 0 nor of a magnitude
///   between 2^-64 and 2^64; if M mirrors, or stretches lengths by more than 10^-9 of them;
///   LEAFLESS_E_NO_MEMORY; LEAFLESS_E_BUSY.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the layout.
/// - Untrusted input: any numbers.
leafless_status leafless_layout_place(leafless_layout *layout, uint64_t item, const double matrix[12],
    uint64_t *number);

/// Moves a copy to another place. Nothing is checked: leafless_layout_check does that.
///
/// - Buffers: `matrix`, 12 numbers, as for leafless_layout_place.
/// - Errors: as leafless_layout_place, and LEAFLESS_E_ARGUMENT if there is no copy of this number.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the layout.
/// - Untrusted input: any numbers.
leafless_status leafless_layout_move_to(leafless_layout *layout, uint64_t number, const double matrix[12]);

/// Takes a copy away. Copies that were placed later get numbers that are less by one.
///
/// - Errors: LEAFLESS_E_ARGUMENT if there is no copy of this number; LEAFLESS_E_BUSY.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the layout.
/// - Untrusted input: any number.
leafless_status leafless_layout_remove(leafless_layout *layout, uint64_t number);

/// Which copies stand where, in the order of their numbers.
///
/// - Buffers: `placements`, room for `capacity` structs, or NULL to ask for their number only; `count`, one
///   number.
/// - Result: `*count`; `placements`.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_BUSY.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the layout.
leafless_status leafless_layout_placements(const leafless_layout *layout, leafless_placement *placements,
    uint64_t capacity, uint64_t *count);

/// Where one copy stands.
///
/// - Buffers: `placement`, one struct.
/// - Result: `*placement`.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no copy of this number; LEAFLESS_E_BUSY.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the layout.
/// - Untrusted input: any number.
leafless_status leafless_layout_placement_at(const leafless_layout *layout, uint64_t number,
    leafless_placement *placement);

/// Whether a copy may stand where it does, what is in its way, and what is next to it. Only what is near is
/// looked at: what boxes tell apart costs nothing.
///
/// A pair of closed meshes takes some ten microseconds. Other pairs take splits. `max_splits` limits their
/// number for each pair, which is 4 096 if that is 0; once it is spent, the answer is UNDECIDED.
///
/// - Buffers: `options`, one struct or NULL; `conflicts`, room for `capacity` structs, or NULL; `standing`,
///   one struct.
/// - Result: `*standing`; in `conflicts` the first `capacity` neighbours that are in the way, or may be, and
///   no more than 256.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no copy of this number; LEAFLESS_E_FRAME if a solid belongs to
///   another frame; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY;
///   LEAFLESS_E_BUSY. A `capacity` that is too small is no error.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the layout.
/// - Untrusted input: any number; the default of `max_splits` bounds the work.
leafless_status leafless_layout_check(const leafless_layout *layout, uint64_t number,
    const leafless_options *options, leafless_neighbour *conflicts, uint64_t capacity,
    leafless_standing *standing);

/// As leafless_layout_check for all copies, in the order of their numbers, but without what is next to them.
/// The results are the same for any number of threads.
///
/// - Buffers: `options`, one struct or NULL; `standings`, room for `capacity` structs, or NULL to ask for
///   their number only, for which nothing is checked; `count`, one number.
/// - Result: `*count`, the number of copies; `standings`.
/// - Errors: as leafless_layout_check, and LEAFLESS_E_BUFFER if the capacity is too small.
/// - Threads: any; uses as many as `options` says; LEAFLESS_E_BUSY while another call changes the layout.
/// - Untrusted input: none but the solids; the default of `max_splits` bounds the work for each pair.
leafless_status leafless_layout_check_all(const leafless_layout *layout, const leafless_options *options,
    leafless_placed_standing *standings, uint64_t capacity, uint64_t *count);

/// What a search is after. First of all it places as much as goes in.
LEAFLESS_ENUM(leafless_objective, uint32_t) {
    LEAFLESS_OBJECTIVE_COUNT = 0,  ///< As many copies as possible.
    LEAFLESS_OBJECTIVE_HEIGHT = 1,  ///< As many copies as possible, as low as possible along z.
    LEAFLESS_OBJECTIVE_DENSITY = 2,  ///< As much volume as possible.
    /// As many copies as possible, with the centre of gravity of all of them near to `target_model`.
    LEAFLESS_OBJECTIVE_BALANCE = 3,
};

/// A direction along which all copies can be taken out.
LEAFLESS_ENUM(leafless_free_along, uint32_t) {
    LEAFLESS_FREE_ALONG_NONE = 0,  ///< None is asked for.
    LEAFLESS_FREE_ALONG_X_UP = 1,  ///< Along x, to greater coordinates.
    LEAFLESS_FREE_ALONG_X_DOWN = 2,  ///< Along x, to lesser coordinates.
    LEAFLESS_FREE_ALONG_Y_UP = 3,  ///< Along y, to greater coordinates.
    LEAFLESS_FREE_ALONG_Y_DOWN = 4,  ///< Along y, to lesser coordinates.
    LEAFLESS_FREE_ALONG_Z_UP = 5,  ///< Along z, to greater coordinates.
    LEAFLESS_FREE_ALONG_Z_DOWN = 6,  ///< Along z, to lesser coordinates.
};

/// How a search proceeds.
typedef struct leafless_search_options {
    uint32_t struct_size;  ///< sizeof(leafless_search_options).
    leafless_objective objective;  ///< A leafless_objective: what the search is after.
    /// Of LEAFLESS_OBJECTIVE_BALANCE: the point that the centre of gravity should be near to, in model units.
    double target_model[3];
    /// What chance depends on: the same seed gives the same layout, for any number of threads.
    uint64_t seed;
    /// How many places the solids themselves are asked about at the most; 0 means no limit.
    uint64_t max_tests;
    /// How often everything is placed anew, in other orders, of which the best one stays; 0 means 4.
    uint32_t rounds;
    /// Cells along the longest side of the container, 4 to 512; 0 means as many as the items ask for.
    uint32_t cells;
    /// A leafless_free_along: all copies can be taken out in this direction, one after another, the last that
    /// was placed first. No other copy and no obstacle is in the way of a straight move; the container may
    /// be.
    leafless_free_along free_along;
    uint32_t reserved;  ///< 0.
} leafless_search_options;

/// Why a search ended.
LEAFLESS_ENUM(leafless_search_end, uint32_t) {
    LEAFLESS_SEARCH_END_COMPLETE = 0,  ///< Everything is placed, and nothing else is asked for.
    LEAFLESS_SEARCH_END_ROUNDS = 1,  ///< All rounds were made.
    LEAFLESS_SEARCH_END_BUDGET = 2,  ///< `max_tests` of the search, or `max_splits` of the options, is spent.
    LEAFLESS_SEARCH_END_CANCELLED = 3,  ///< It was cancelled. What was best until then is placed.
};

/// What a search did.
typedef struct leafless_search_report {
    uint32_t struct_size;  ///< sizeof(leafless_search_report).
    leafless_search_end end;  ///< Why it ended.
    uint64_t placed;  ///< Copies that it placed.
    uint64_t left;  ///< Copies that are still to be placed.
    uint64_t rounds;  ///< Rounds that were made, those by boxes not counted.
    uint64_t tests;  ///< Places that the solids themselves were asked about.
    /// Cells that were split for that. (Cells of items and of the container by which places are found are not
    /// counted.)
    uint64_t splits;
} leafless_search_report;

/// What all copies amount to. All intervals contain the truth. Overlaps, where there are any, count twice.
typedef struct leafless_layout_measures {
    uint32_t struct_size;  ///< sizeof(leafless_layout_measures).
    leafless_interval volume_model;  ///< The volume of all copies.
    leafless_interval filled_part;  ///< The part of the container's volume that this is.
    /// How far the highest point is above the lower end of the container's bounds, along z; 0 if nothing is
    /// placed.
    leafless_interval height_model;
    leafless_interval mass;  ///< The mass, by the densities of the items.
    leafless_interval centroid_model[3];  ///< The centre of gravity; all numbers unless `has_centroid`.
    /// Tensor of inertia about the model's origin, row by row, as leafless_measures has it, times the
    /// densities.
    leafless_interval inertia_origin_model[9];
    /// The same about the centre of gravity; about the origin unless `has_centroid`.
    leafless_interval inertia_centroid_model[9];
    bool has_centroid;  ///< Whether anything is placed, and no placed item may be empty.
} leafless_layout_measures;

/// Places copies of items of which fewer are placed than their counts say. Copies that are placed already
/// stay where they are.
///
/// Each copy is proven to lie in the container, to overlap with nothing, and to be as far from everything as
/// it should be: by boxes, by the triangles of meshes, or by splits of the solids. What could not be proven
/// is not placed. The layout that stays is the best of all rounds by what the search is after. A cancel ends
/// the search and keeps what was best by then, and so does a budget: neither is an error.
///
/// Memory is that of the items' cells in all orientations, and of the container's cells: some megabytes. A
/// step takes O(r n² / 64), with n the cells along the container and r the runs of cells of an item, for each
/// layer of cells that is looked at.
///
/// - Buffers: `search`, one struct or NULL; `options`, one struct or NULL; `report`, one struct.
/// - Result: the layout is changed; `*report`.
/// - Errors: LEAFLESS_E_ARGUMENT if `cells` is neither 0 nor between 4 and 512, if a field is none of its
///   enumeration, or if `target_model` is not finite, or is set though it is not used; LEAFLESS_E_FRAME if a
///   solid belongs to another frame; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_NO_MEMORY;
///   LEAFLESS_E_BUSY. Then the layout is as it was.
/// - Threads: any; uses as many as `options` says; LEAFLESS_E_BUSY while another call uses the layout.
/// - Untrusted input: any numbers; set `max_tests` and `max_splits` where the solids are not your own choice.
leafless_status leafless_layout_search(leafless_layout *layout, const leafless_search_options *search,
    const leafless_options *options, leafless_search_report *report);

/// Measures the container and each item of which there is a copy, once, as leafless_solid_measure does it,
/// and adds up the copies. `relative` says how wide the interval of each volume may be, as a part of it.
///
/// - Buffers: `options`, one struct or NULL; `measures`, one struct.
/// - Result: `*measures`.
/// - Errors: LEAFLESS_E_ARGUMENT if `relative` is negative or not a number; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_BUSY.
/// - Threads: any; uses as many as `options` says; LEAFLESS_E_BUSY while another call changes the layout.
/// - Untrusted input: any number; the default of `max_splits`, that of leafless_solid_measure, bounds the
///   work.
leafless_status leafless_layout_measure(const leafless_layout *layout, double relative,
    const leafless_options *options, leafless_layout_measures *measures);

/* ---- 22. Octrees that are split on demand ------------------------------------------------------------- */

/// What can be said of a lazy octree at once.
typedef struct leafless_lazy_info {
    uint32_t struct_size;  ///< sizeof(leafless_lazy_info).
    leafless_frame frame;  ///< The universe, and how deep cells may be split.
    leafless_statistics statistics;  ///< Counts over all levels, and the certified volume.
    /// Cells that were split, as it happened: also those that were merged again. Nothing is counted twice.
    uint64_t splits;
    uint64_t replays;  ///< Splits that the solid was asked for anew, because cells below were to be split.
    uint64_t bytes;  ///< Bytes that the split cells take.
} leafless_lazy_info;

/// An octree of which only the universe is known. No cell will ever be finer than the frame's depth, which
/// costs nothing until they are asked for.
///
/// - Buffers: `frame`, one struct; `lazy`, one pointer.
/// - Result: `*lazy`.
/// - Errors: LEAFLESS_E_FRAME if the solid belongs to another frame; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED;
///   LEAFLESS_E_ARGUMENT; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the octree shares the solid, which may be freed; give `*lazy` back with leafless_lazy_free.
/// - Untrusted input: any solid.
leafless_status leafless_lazy_new(const leafless_solid *solid, const leafless_frame *frame,
    leafless_lazy **lazy);

/// Takes up an octree that leafless_lazy_freeze made of the same solid, which is known by its fingerprint;
/// `frame` may be deeper than the octree's. Whatever else the octree holds is believed, as far as the solid's
/// splits do not contradict it. Splits are counted from zero.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `lazy`, one pointer.
/// - Result: `*lazy`. O(n).
/// - Errors: LEAFLESS_E_SOURCE if the octree does not hold the solid's fingerprint; LEAFLESS_E_ARGUMENT if
///   the solid has none, or the octree is deeper than the frame; LEAFLESS_E_FRAME if it lies on another
///   universe, or the solid belongs to another frame; LEAFLESS_E_DAMAGED; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `octree` stays as it is; `*lazy` shares the solid, which may be freed; give it back with
///   leafless_lazy_free.
/// - Untrusted input: any octree; set `max_bytes` where it is not your own.
leafless_status leafless_lazy_resume(const leafless_octree *octree, const leafless_solid *solid,
    const leafless_frame *frame, const leafless_options *options, leafless_lazy **lazy);

/// Gives back a lazy octree.
///
/// - Buffers: `lazy`, a handle or NULL, which does nothing.
/// - Ownership: the handle is gone.
/// - Threads: no other call may use the handle.
void leafless_lazy_free(leafless_lazy *lazy);

/// Splits a PARTIAL cell. A cell that was split before, is decided, or that splitting does not help costs
/// nothing.
///
/// - Buffers: `cell`, 3 numbers, the cell's place among those of its level; `tags`, room for 8.
/// - Result: the tags of its children in octant order (bit 0 of the octant is x, bit 1 y, bit 2 z).
/// - Errors: LEAFLESS_E_ARGUMENT if the cell is none of the frame's, lies at its depth, or in a cell that is
///   still to be split; LEAFLESS_E_SOURCE if the solid contradicts what the octree holds;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_NO_MEMORY.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the handle.
/// - Untrusted input: any solid, any numbers.
leafless_status leafless_lazy_split(leafless_lazy *lazy, const uint32_t cell[3], uint32_t level,
    leafless_tag tags[8]);

/// Which cells are refined.
LEAFLESS_ENUM(leafless_zone_kind, uint32_t) {
    LEAFLESS_ZONE_KIND_EVERYTHING = 0,  ///< All of the universe.
    /// The cells that have more than their surface in common with the box from `min_model` to `max_model`; of
    /// a box without thickness, those that it lies in.
    LEAFLESS_ZONE_KIND_BOX = 1,
    LEAFLESS_ZONE_KIND_POINT = 2,  ///< The cells that contain `point_model`: one of each level.
    /// All cells that the points `point_model` + t · `direction_model` with `from` ≤ t ≤ `to` touch.
    LEAFLESS_ZONE_KIND_RAY = 3,
};

/// A part of model space, in which cells are refined. Fields that its kind does not name do not matter.
typedef struct leafless_zone {
    uint32_t struct_size;  ///< sizeof(leafless_zone).
    leafless_zone_kind kind;  ///< Which of the fields below count.
    double min_model[3];  ///< A box's lower corner.
    double max_model[3];  ///< A box's upper corner.
    /// A point, or a point of a ray; of a ray each coordinate is 0 or of a magnitude between 2^-256 and
    /// 2^256.
    double point_model[3];
    /// A ray's direction, of any length but zero; each coordinate is as that of its point.
    double direction_model[3];
    double from;  ///< Where a ray begins; may be -INFINITY.
    double to;  ///< Where a ray ends; may be INFINITY.
} leafless_zone;

/// Splits the cells of a zone down to `level`, those that can be. Limits in `options` (`max_splits`;
/// `max_nodes` and `max_bytes` of all that the octree then holds) end the work, not the octree; coarser cells
/// are then split before finer ones, and along a ray those that it comes to first.
///
/// - Buffers: `zone`, one struct, or NULL for everything; `options`, one struct or NULL; `done`, one truth
///   value, or NULL.
/// - Result: `*done`, whether no limit was reached first.
/// - Errors: LEAFLESS_E_ARGUMENT if `level` is beyond the frame's depth, a box has min > max on an axis, a
///   number is not as leafless_zone says, or not from ≤ to; LEAFLESS_E_SOURCE if the solid contradicts what
///   the octree holds; LEAFLESS_E_CALLBACK; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY. What was split before
///   stays so.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the handle; uses the calling thread alone.
/// - Untrusted input: any solid, any numbers; set limits where the level or the solid is not your own choice.
leafless_status leafless_lazy_refine(leafless_lazy *lazy, const leafless_zone *zone, uint32_t level,
    const leafless_options *options, bool *done);

/// What is known of a cell. In a cell that is decided, or was not split yet, there are only cells like it.
///
/// - Buffers: `cell`, 3 numbers, the cell's place among those of its level; `tag`, one; `can_split`, one
///   truth value, or NULL.
/// - Result: `*tag`; BRANCH if the cell was split and its children differ; PARTIAL if it is none of the
///   frame's. `*can_split`, whether leafless_lazy_split would ask the solid: the cell is PARTIAL, its parent
///   was split, it is above the frame's depth, and the solid did not say that splitting does not help.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the octree.
/// - Untrusted input: any numbers.
leafless_status leafless_lazy_tag_at(const leafless_lazy *lazy, const uint32_t cell[3], uint32_t level,
    leafless_tag *tag, bool *can_split);

/// Whether the solid contains a point, as far as cells have been split. A point on the boundary may be
/// answered either way.
///
/// - Buffers: `point_model`, 3 numbers; `membership`, one.
/// - Result: `*membership`.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the octree.
/// - Untrusted input: any numbers.
leafless_status leafless_lazy_contains(const leafless_lazy *lazy, const double point_model[3],
    leafless_membership *membership);

/// What can be said of a lazy octree at once, as far as cells have been split. O(depth).
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`. A cell counts as a node also if its eight children are PARTIAL.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the octree.
leafless_status leafless_lazy_describe(const leafless_lazy *lazy, leafless_lazy_info *info);

/// Counts of each level, and the certified volumes of the octree cut there. Entry 0 is the universe, entry
/// `depth` the finest cells.
///
/// - Buffers: `levels`, room for `capacity` structs, or NULL to ask for the count only; `count`, one number.
/// - Result: `*count`, depth + 1; the levels.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the octree.
leafless_status leafless_lazy_levels(const leafless_lazy *lazy, leafless_statistics *levels,
    uint64_t capacity, uint64_t *count);

/// How many cells of each level were split, as it happened. Entry 0 is the universe.
///
/// - Buffers: `splits`, room for `capacity` numbers, or NULL to ask for the count only; `count`, one number.
/// - Result: `*count`, the frame's depth; the numbers.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the octree.
leafless_status leafless_lazy_splits(const leafless_lazy *lazy, uint64_t *splits, uint64_t capacity,
    uint64_t *count);

/// The octree as it is now: canonical, and what is not split is PARTIAL. As the fact "source" it holds the
/// solid's fingerprint, if there is one: saved or not, leafless_lazy_resume takes it up again.
///
/// - Buffers: `options`, one struct or NULL; `octree`, one pointer.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*octree` back with leafless_octree_free.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the octree; uses as many as `options` says.
leafless_status leafless_lazy_freeze(const leafless_lazy *lazy, const leafless_options *options,
    leafless_octree **octree);

/* ---- 23. Attributes ----------------------------------------------------------------------------------- */

/// What is known of the values in the interior of a box.
LEAFLESS_ENUM(leafless_range_kind, uint32_t) {
    LEAFLESS_RANGE_KIND_UNKNOWN = 0,  ///< Nothing.
    LEAFLESS_RANGE_KIND_NOWHERE = 1,  ///< No point has a value.
    /// Every point has a value, and each of its numbers lies in its interval.
    LEAFLESS_RANGE_KIND_WITHIN = 2,
};

/// What is known of the values of an attribute in the interior of a box.
typedef struct leafless_value_range {
    /// For each number of a value an interval that contains it, if `kind` is LEAFLESS_RANGE_KIND_WITHIN. All
    /// numbers are NaN otherwise, and beyond the numbers that a value has.
    leafless_interval values[4];
    uint32_t kind;  ///< A leafless_range_kind.
} leafless_value_range;

/// The attribute that has one value everywhere.
///
/// - Buffers: `value`, `components` numbers; `attribute`, one pointer.
/// - Result: `*attribute`.
/// - Errors: LEAFLESS_E_ARGUMENT unless `components` is 1 to 4, and no number NaN.
/// - Ownership: give `*attribute` back with leafless_attribute_free.
/// - Untrusted input: any numbers.
leafless_status leafless_attribute_new_constant(const double *value, uint32_t components,
    leafless_attribute **attribute);

/// An attribute in another place: its value at the image M p + t of a point p is that of `operand` at p. It
/// carries attributes and channels along with a solid that leafless_solid_placed moves by the same map. The
/// map is inverted; what is rounded thereby moves the values by about 2^-50 of the coordinates.
///
/// - Buffers: `matrix`, 12 numbers, the rows of [M | t]; `attribute`, one pointer.
/// - Result: `*attribute`.
/// - Errors: LEAFLESS_E_ARGUMENT if an entry is neither 0 nor of a magnitude between 2^-64 and 2^64, M is
///   singular, or an entry of the inverse is beyond 2^64.
/// - Ownership: the operand is shared and may be freed; give `*attribute` back with leafless_attribute_free.
/// - Untrusted input: any attribute and numbers.
leafless_status leafless_attribute_placed(const leafless_attribute *operand, const double matrix[12],
    leafless_attribute **attribute);

/// What can be said of an attribute at once.
typedef struct leafless_attribute_info {
    uint32_t struct_size;  ///< sizeof(leafless_attribute_info).
    uint32_t components;  ///< How many numbers a value has: 1 to 4.
    /// About how many bytes of memory (or of mapped files) the attribute keeps alive: its own, and those of
    /// the mesh, channel or samples that it shares. 0 for constants and for objects of the host.
    uint64_t bytes;
} leafless_attribute_info;

/// What can be said of an attribute at once. O(1).
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
/// - Untrusted input: any attribute.
leafless_status leafless_attribute_describe(const leafless_attribute *attribute,
    leafless_attribute_info *info);

/// The values of an attribute at points.
///
/// - Buffers: `points_model`, `count` points of 3 numbers; `values`, room for `count` values of as many
///   numbers as leafless_attribute_describe says. Both may be NULL if `count` is 0.
/// - Result: the value at point i from `values[components * i]` on; NaN where there is none.
/// - Errors: LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any attribute, any numbers.
leafless_status leafless_attribute_values(const leafless_attribute *attribute, const double *points_model,
    uint64_t count, double *values);

/// What is known of the values of an attribute in the interior of a box.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `range`, one struct.
/// - Result: `*range`.
/// - Errors: LEAFLESS_E_ARGUMENT unless min <= max on every axis, and all coordinates are finite;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED.
/// - Untrusted input: any attribute, any numbers; the work is bounded.
leafless_status leafless_attribute_range(const leafless_attribute *attribute, const double min_model[3],
    const double max_model[3], leafless_value_range *range);

/// One more reference to an attribute.
///
/// - Buffers: `attribute`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `attribute`.
/// - Ownership: give each reference back with leafless_attribute_free.
leafless_status leafless_attribute_ref(const leafless_attribute *attribute, leafless_attribute **reference);

/// Gives back a reference to an attribute; with the last one the attribute is gone. Channels that were filled
/// from it stay.
///
/// - Buffers: `attribute`, a handle or NULL, which does nothing.
/// - Ownership: the reference is gone.
/// - Threads: any; no other call may use this reference.
void leafless_attribute_free(leafless_attribute *attribute);

/// The value of the host's attribute at a point (3 numbers, model units): sets the numbers of `value`, as
/// many as the attribute has components. All are NaN before; they stay so where there is no value, and a
/// value whose first number is NaN is none. 0, or the number of the host's own error, which ends the
/// operation with LEAFLESS_E_CALLBACK and the number in the message.
///
/// It is called from several threads at once, which may all be the library's own, unless the operation's
/// options say `threads` = 1; and it must give the same answer to the same point. It must return: no
/// exception, no longjmp. It may call this library.
typedef int32_t (*leafless_attribute_value_fn)(void *ctx, const double *point, double *value);

/// The values at `count` points (3 numbers each) at once, for hosts that do that faster than one by one: the
/// numbers of the first, then those of the second, and so on. Else as leafless_attribute_value_fn.
typedef int32_t (*leafless_attribute_values_fn)(void *ctx, const double *points, uint64_t count,
    double *values);

/// Bounds the values of the host's attribute in the interior of the box [min, max] (3 numbers each, model
/// units): sets `kind` and the intervals of `*range`, of which the kind is LEAFLESS_RANGE_KIND_UNKNOWN and
/// all numbers are NaN before. The answer must be proven: a wrong range hides details that nobody looks for
/// any more. An interval that contains a NaN, or of which lower > upper, says nothing; a `kind` that is none
/// ends the operation with LEAFLESS_E_CALLBACK. Else as leafless_attribute_value_fn.
typedef int32_t (*leafless_attribute_range_fn)(void *ctx, const double *min, const double *max,
    leafless_value_range *range);

/// An attribute of the host. `components` and one of `value` and `values` must be set; all other fields but
/// the first may be zero.
typedef struct leafless_attribute_callbacks {
    uint32_t struct_size;  ///< sizeof(leafless_attribute_callbacks).
    uint32_t components;  ///< How many numbers a value has: 1 to 4.
    leafless_attribute_value_fn value;  ///< The value at a point; not called if `values` is set.
    leafless_attribute_values_fn values;  ///< The values at many points, as many as the work has at hand.
    /// Bounds the values in a box; optional. With it channels that hardly change are filled without asking at
    /// every cell, and LEAFLESS_CRITERION_RANGE misses no detail.
    leafless_attribute_range_fn range;
    leafless_destroy_fn destroy;  ///< Called when `ctx` is not needed any more; optional.
    void *ctx;  ///< What the functions are called with.
} leafless_attribute_callbacks;

/// The host's own attribute.
///
/// - Buffers: `callbacks`, one struct, which is copied; `attribute`, one pointer.
/// - Result: `*attribute`.
/// - Errors: LEAFLESS_E_NULL if `value` and `values` are NULL; LEAFLESS_E_ARGUMENT unless `components` is 1
///   to 4. After an error `destroy` is not called.
/// - Ownership: `ctx` must live until `destroy` is called with it; give `*attribute` back with
///   leafless_attribute_free.
/// - Threads: any; in which the functions are called, leafless_attribute_value_fn says.
/// - Untrusted input: any answers.
leafless_status leafless_attribute_new_callbacks(const leafless_attribute_callbacks *callbacks,
    leafless_attribute **attribute);

/// What the triangles of a mesh bear, by its place among all: an array of values with a name. Files in PLY
/// and 3MF give `colour` (red, green, blue and opacity from 0 to 255), 3MF `material` and `object` (numbers,
/// which may have names); a mesh from a polyhedron has `face`, `shell` and `solid`, the numbers of the parts
/// that a triangle belongs to.
///
/// - Buffers: `count`, one number; `name`, `name_length`, `components` and `per_corner`, one each, all NULL
///   to ask for the count only.
/// - Result: `*count`, the number of all attributes; the name in UTF-8, not NUL-terminated, with its length
///   in bytes; `*components`, how many numbers a value has, 1 to 4; `*per_corner`, whether each corner of a
///   triangle has a value, or each triangle one.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no attribute `index`, unless only the count is asked for.
/// - Ownership: the name belongs to the mesh and lives as long as the reference `mesh`.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_peek_attribute_at(const leafless_mesh *mesh, uint64_t index, uint64_t *count,
    const char **name, size_t *name_length, uint32_t *components, bool *per_corner);

/// What the value `value` of an attribute of a mesh is called: the name of a material or of an object.
///
/// - Buffers: `count`, one number; `name` and `name_length`, one each, both NULL to ask for the count only.
/// - Result: `*count`, how many values from 0 on have names; the name in UTF-8, not NUL-terminated, with its
///   length in bytes.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no attribute `index`, or the value has no name, unless only the
///   count is asked for.
/// - Ownership: the name belongs to the mesh and lives as long as the reference `mesh`.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_peek_attribute_name_at(const leafless_mesh *mesh, uint64_t index,
    uint64_t value, uint64_t *count, const char **name, size_t *name_length);

/// The values of an attribute of a mesh at the corners of all triangles.
///
/// - Buffers: `values`, room for `capacity` numbers, or NULL to ask for the count only; `count`, one number.
/// - Result: `*count`, 3 · components · triangles; in `values` the numbers at the three corners of the first
///   triangle, then of the second: NaN where there is no value.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no attribute `index`; LEAFLESS_E_BUFFER if the capacity is too
///   small.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_attribute_values(const leafless_mesh *mesh, uint64_t index, double *values,
    uint64_t capacity, uint64_t *count);

/// The body that each triangle of a mesh belongs to: a set of triangles that hang together over edges. Bodies
/// are numbered from 0 by their first triangles. Shells that touch only in single vertices, or lie within
/// each other, are different bodies.
///
/// - Buffers: `bodies`, room for `capacity` numbers, or NULL to ask for the count only; `count`, one number.
/// - Result: `*count`, the number of triangles; in `bodies` one number for each.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any mesh.
leafless_status leafless_mesh_bodies(const leafless_mesh *mesh, uint32_t *bodies, uint64_t capacity,
    uint64_t *count);

/// The same mesh, whose triangles bear the values of an attribute under a name: that of a triangle is the
/// value just inside of it, `depth_model` behind its centroid. If there is none, it is that at a quarter of
/// the depth, at twice the depth, or at the centroid itself, and otherwise the triangle has no value. So a
/// surface bears what channels of its solid say: half the edge of a channel's cells is a good depth.
/// leafless_mesh_write writes colours as `colour`, and materials as `material`.
///
/// O(t) questions. An attribute that the mesh bears under the name is replaced.
///
/// - Buffers: `name`, `name_length` bytes of UTF-8; `options`, one struct or NULL; `bearing`, one pointer.
/// - Result: `*bearing`, the same for any number of threads.
/// - Errors: LEAFLESS_E_ARGUMENT unless the depth is finite and not negative; LEAFLESS_E_UTF8;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` and `attribute` stay as they are; give `*bearing` back with leafless_mesh_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any mesh, any attribute, any text.
leafless_status leafless_mesh_with_values(const leafless_mesh *mesh, const leafless_attribute *attribute,
    const char *name, size_t name_length, double depth_model, const leafless_options *options,
    leafless_mesh **bearing);

/// The attribute that has at each point what a mesh bears at the point of its surface that is nearest: the
/// value of the nearest triangle, or, with values for corners, what lies between them. Of triangles that are
/// equally near the first one counts. Its ranges are proven.
///
/// - Buffers: `name`, `name_length` bytes of UTF-8: that of an attribute of the mesh; `attribute`, one
///   pointer.
/// - Result: `*attribute`.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_ARGUMENT if the mesh has no such attribute; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the mesh is shared and may be freed; give `*attribute` back with leafless_attribute_free.
/// - Untrusted input: any mesh, any text.
leafless_status leafless_attribute_from_mesh(const leafless_mesh *mesh, const char *name, size_t name_length,
    leafless_attribute **attribute);

/// As leafless_attribute_from_mesh, of the host's own values: of bodies, faces, materials, or colours of
/// corners.
///
/// - Buffers: `values`, `count` numbers: `components` for each triangle, or for each of its three corners,
///   one behind the other; `attribute`, one pointer.
/// - Result: `*attribute`. A value with a number that is not finite counts as none.
/// - Errors: LEAFLESS_E_ARGUMENT unless `components` is 1 to 4, and there are values for all triangles;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: the values are copied, the mesh is shared and may be freed; give `*attribute` back with
///   leafless_attribute_free.
/// - Untrusted input: any mesh, any numbers.
leafless_status leafless_attribute_from_mesh_values(const leafless_mesh *mesh, const double *values,
    uint64_t count, uint32_t components, bool per_corner, leafless_attribute **attribute);

/* ---- 24. Channels ------------------------------------------------------------------------------------- */

/// The type of the numbers of a channel. Numbers are rounded to the nearest one of the type, to an even
/// integer half-way.
LEAFLESS_ENUM(leafless_scalar_type, uint32_t) {
    LEAFLESS_SCALAR_TYPE_F32 = 0,  ///< Finite numbers of single precision.
    LEAFLESS_SCALAR_TYPE_U8 = 1,  ///< Integers from 0 to 255.
    LEAFLESS_SCALAR_TYPE_U16 = 2,  ///< Integers from 0 to 65 535.
    LEAFLESS_SCALAR_TYPE_U32 = 3,  ///< Integers from 0 to 4 294 967 295.
};

/// What can be said of a channel at once.
typedef struct leafless_channel_info {
    uint32_t struct_size;  ///< sizeof(leafless_channel_info).
    leafless_frame frame;  ///< Where it lies: in the cube of its solid, with a depth of its own.
    leafless_scalar_type scalar;  ///< The type of the numbers.
    uint32_t components;  ///< How many numbers a value has: 1 to 4.
    uint64_t value_count;  ///< Values that are stored: one for each run of equal ones.
    uint64_t elements;  ///< Array elements and bricks of the tree.
    uint64_t bytes;  ///< Bytes that the channel takes in memory.
} leafless_channel_info;

/// One more reference to a channel.
///
/// - Buffers: `channel`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `channel`.
/// - Ownership: give each reference back with leafless_channel_free.
leafless_status leafless_channel_ref(const leafless_channel *channel, leafless_channel **reference);

/// Gives back a reference to a channel. With the last one the channel is gone, and with it the mapping of its
/// file, unless an octree, an attribute, or a channel with other metadata still shares it.
///
/// - Buffers: `channel`, a handle or NULL, which does nothing.
/// - Ownership: the reference is gone.
/// - Threads: any; no other call may use this reference.
void leafless_channel_free(leafless_channel *channel);

/// What can be said of a channel at once. O(1), but for a channel of a file that was mapped unverified: when
/// such a channel is first read, by whichever function, its links are checked in one pass.
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
/// - Errors: LEAFLESS_E_DAMAGED.
/// - Untrusted input: any channel.
leafless_status leafless_channel_describe(const leafless_channel *channel, leafless_channel_info *info);

/// Checks that a channel is well-formed: O(n). Those that the library makes, opens or maps verified are.
///
/// - Result: LEAFLESS_OK if it is.
/// - Errors: LEAFLESS_E_DAMAGED, with the first damage in the message; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any channel.
leafless_status leafless_channel_check(const leafless_channel *channel);

/// Whether two channels have the same values in the same cells, of one type and on one frame. Metadata does
/// not count. O(n).
///
/// - Buffers: `equal`, one truth value.
/// - Result: `*equal`.
/// - Untrusted input: any channels.
leafless_status leafless_channel_equal(const leafless_channel *a, const leafless_channel *b, bool *equal);

/// The values of a channel as an attribute, which may be placed, or fill a channel on another frame. It has
/// no values outside of the channel's cube.
///
/// - Buffers: `attribute`, one pointer.
/// - Result: `*attribute`.
/// - Errors: only the general ones; asking for its values returns LEAFLESS_E_DAMAGED if the channel was
///   mapped unverified and its links are damaged.
/// - Ownership: the attribute shares the channel, which may be freed; give `*attribute` back with
///   leafless_attribute_free.
/// - Untrusted input: any channel.
leafless_status leafless_attribute_from_channel(const leafless_channel *channel,
    leafless_attribute **attribute);

/// The channel with one more fact in its metadata, or with another value of one; the arrays are shared. Names
/// in use: "name", by which a solid knows the channel, "unit" (of the values), "meaning" (what they are, such
/// as "colour" or "density").
///
/// - Buffers: `key` and `value`, `key_length` and `value_length` bytes of UTF-8; `named`, one pointer.
/// - Result: `*named`.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_ARGUMENT if all facts would take more than 64 KiB in a file, 8 bytes
///   and the two texts each; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the texts are copied. `*named` shares the arrays of `channel`, which may be freed: what must
///   outlive `channel`, such as bytes that it views, must outlive `*named` too. Give that back with
///   leafless_channel_free.
/// - Untrusted input: any texts.
leafless_status leafless_channel_with_metadata(const leafless_channel *channel, const char *key,
    size_t key_length, const char *value, size_t value_length, leafless_channel **named);

/// The channel with one fact less in its metadata, or with none; the arrays are shared.
///
/// - Buffers: `key`, `key_length` bytes of UTF-8, or NULL for all facts; `unnamed`, one pointer.
/// - Result: `*unnamed`; a fact that is not there need not be.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_channel_with_metadata.
/// - Untrusted input: any texts.
leafless_status leafless_channel_without_metadata(const leafless_channel *channel, const char *key,
    size_t key_length, leafless_channel **unnamed);

/// The value of a fact in a channel's metadata, such as "name".
///
/// - Buffers: `key`, `key_length` bytes of UTF-8; `value` and `value_length`, one each.
/// - Result: `*value`, not NUL-terminated; NULL if there is no such fact. `*value_length`, in bytes.
/// - Errors: LEAFLESS_E_UTF8.
/// - Ownership: the text belongs to the channel and lives as long as the reference `channel`.
/// - Untrusted input: any channel.
leafless_status leafless_channel_peek_metadata(const leafless_channel *channel, const char *key,
    size_t key_length, const char **value, size_t *value_length);

/// A fact of a channel's metadata by its place among all, which stand by ascending key.
///
/// - Buffers: `count`, one number; `key`, `key_length`, `value`, `value_length`, one each, all four NULL to
///   ask for the count only.
/// - Result: `*count`, the number of all facts; key and value, not NUL-terminated, with their lengths in
///   bytes.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no fact `index`, unless only the count is asked for.
/// - Ownership: the texts belong to the channel and live as long as the reference `channel`.
/// - Untrusted input: any channel.
leafless_status leafless_channel_peek_metadata_at(const leafless_channel *channel, uint64_t index,
    uint64_t *count, const char **key, size_t *key_length, const char **value, size_t *value_length);

/// How finely an attribute is followed.
LEAFLESS_ENUM(leafless_criterion, uint32_t) {
    /// To the finest cells, wherever it is not proven that all of a cell has one value.
    LEAFLESS_CRITERION_NONE = 0,
    /// Until the variance of the values at a cell's corners is at most the square of the tolerance. The
    /// variance of several numbers is the sum of their variances. A detail between the corners is missed.
    LEAFLESS_CRITERION_VARIANCE = 1,
    /// Until the values in a cell are proven to differ by no more than the tolerance, in each of their
    /// numbers. Nothing is missed. A cell whose range is unknown is split.
    LEAFLESS_CRITERION_RANGE = 2,
};

/// How a channel is filled. NULL means the defaults. All fields but the first may be zero, which is their
/// default.
typedef struct leafless_channel_fill_options {
    uint32_t struct_size;  ///< sizeof(leafless_channel_fill_options).
    leafless_scalar_type scalar;  ///< A leafless_scalar_type: what numbers are rounded to.
    /// How many numbers a value has, which is as many as those of the attribute; 0 does not ask.
    uint32_t components;
    uint32_t depth;  ///< Levels of the channel; 0 means those of the frame.
    /// The solid inside which values matter; optional. Where it is EMPTY, the channel says whatever takes the
    /// least memory.
    const leafless_octree *solid;
    /// A leafless_criterion. Unless it is LEAFLESS_CRITERION_NONE, a cell is split until its edge is at most
    /// `coarse_model` and the criterion holds, or until its edge is at most `fine_model`. It then has the
    /// value at its centre.
    leafless_criterion criterion;
    uint32_t reserved;  ///< Zero.
    double coarse_model;  ///< The longest edge of cells with a criterion; 0 means any.
    /// The edge below which cells are not split any more, with a criterion, at most `coarse_model`; 0 means
    /// that of the finest cells.
    double fine_model;
    double tolerance;  ///< The tolerance of the criterion, in the attribute's units; may be infinite.
    const char *name;  ///< The name of the channel, `name_length` bytes of UTF-8; optional.
    size_t name_length;  ///< The length of the name.
} leafless_channel_fill_options;

/// The channel of an attribute: each cell has the attribute's value at its centre, rounded to the type of the
/// numbers; a cell whose centre has no value has none. Cells are as large as proven ranges and the criterion
/// allow. The result is the same bit for bit for any number of threads.
///
/// Without a criterion the result is that of asking at the centre of every finest cell. An attribute without
/// ranges is asked there: 8^depth times, or as often as the solid has cells that are not EMPTY.
///
/// - Buffers: `frame`, one struct, or NULL for the frame of `fill->solid`, which is then needed; `fill`, one
///   struct or NULL; `options`, one struct or NULL; `channel`, one pointer.
/// - Result: `*channel`, with the name as its only fact, if there is one.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check, if a field of `fill` is wrong, or a value beyond
///   the range of the type, infinite, or partly NaN; LEAFLESS_E_FRAME if the solid lies in another cube than
///   the frame; LEAFLESS_E_NULL if both are missing; LEAFLESS_E_UTF8; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: nothing is kept of the attribute, the solid and the name; give `*channel` back with
///   leafless_channel_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any attribute, any octree; set `max_bytes` where the depth or the attribute is not your
///   own choice.
leafless_status leafless_channel_fill(const leafless_attribute *attribute, const leafless_frame *frame,
    const leafless_channel_fill_options *fill, const leafless_options *options, leafless_channel **channel);

/// The values of a channel at points. A point on a face between cells belongs to the upper one. O(depth)
/// each.
///
/// - Buffers: `points_model`, `count` points of 3 numbers; `values`, room for `count` values of as many
///   numbers as `components` of leafless_channel_describe. Both may be NULL if `count` is 0.
/// - Result: the value at point i from `values[components * i]` on; NaN where there is none, and outside of
///   the channel's cube.
/// - Errors: LEAFLESS_E_DAMAGED.
/// - Untrusted input: any channel, any numbers; damage reads as no value.
leafless_status leafless_channel_values(const leafless_channel *channel, const double *points_model,
    uint64_t count, double *values);

/// The value of a channel at a point, as leafless_channel_values.
///
/// - Buffers: `point_model`, 3 numbers; `value`, room for 4 numbers.
/// - Result: `value`: as many numbers as the channel's values have, and 0 beyond them; four NaN if there is
///   none.
/// - Errors: LEAFLESS_E_DAMAGED.
/// - Untrusted input: any channel, any numbers; damage reads as no value.
leafless_status leafless_channel_value(const leafless_channel *channel, const double point_model[3],
    double value[4]);

/// The value of a finest cell of a channel's own frame. O(depth).
///
/// - Buffers: `cell`, 3 numbers; `value`, room for 4 numbers.
/// - Result: `value`, as leafless_channel_value; four NaN if a coordinate is not below 2^depth.
/// - Errors: LEAFLESS_E_DAMAGED.
/// - Untrusted input: any channel, any numbers; damage reads as no value.
leafless_status leafless_channel_value_at(const leafless_channel *channel, const uint32_t cell[3],
    double value[4]);

/// The channel with one value wherever an octree is not EMPTY, and as it is elsewhere. It is as deep as the
/// deeper of the two. The same bit for bit for any number of threads.
///
/// - Buffers: `region`, a handle; `value`, as many numbers as the channel's values have, or NULL to take
///   values away; `options`, one struct or NULL; `changed`, one pointer.
/// - Result: `*changed`, with the metadata of `channel`.
/// - Errors: LEAFLESS_E_ARGUMENT if the value is beyond the type's range, or not finite; LEAFLESS_E_FRAME
///   unless both lie in one cube; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: `channel` stays as it is; give `*changed` back with leafless_channel_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any channel, any octree, any numbers.
leafless_status leafless_channel_with_value_in(const leafless_channel *channel, const leafless_octree *region,
    const double *value, const leafless_options *options, leafless_channel **changed);

/// What lies between the samples of a volume.
LEAFLESS_ENUM(leafless_interpolation, uint32_t) {
    /// The trilinear interpolation of the eight samples around a point.
    LEAFLESS_INTERPOLATION_TRILINEAR = 0,
    /// The sample of the voxel that contains the point; on a face between voxels, that of the upper one.
    LEAFLESS_INTERPOLATION_NEAREST = 1,
};

/// What the values of a channel amount to in a region, number by number; places beyond the numbers of a value
/// are 0. All intervals contain the truth, as far as the cells of the solid and of the channel tell it.
typedef struct leafless_channel_summary {
    uint32_t struct_size;  ///< sizeof(leafless_channel_summary).
    double least[4];  ///< The least value of any cell that may belong to the region.
    double greatest[4];  ///< The greatest value of any cell that may belong to the region.
    /// The integral of the value over the region, in the value's units times cubic model units: of a density,
    /// the mass.
    leafless_interval integral[4];
    leafless_interval mean[4];  ///< The mean value.
    leafless_interval volume_model;  ///< The volume of the region that has values, in cubic model units.
    leafless_interval volume_without_model;  ///< The volume of the region that has none.
    bool has_values;  ///< Whether any of the region may have a value. If not, all else is 0.
} leafless_channel_summary;

/// Volume, centroid and inertia of the part of a solid that has one value.
typedef struct leafless_material {
    double value[4];  ///< The value; places beyond its numbers are 0.
    leafless_measures measures;  ///< Measures of the points of the solid that have the value, of density 1.
} leafless_material;

/// Least, greatest, mean and integral of a channel's values in the part of a solid that lies in a box, whose
/// faces may lie anywhere. O(cells that the box meets).
///
/// - Buffers: `solid`, a handle, or NULL for all space; `min_model` and `max_model`, 3 numbers each, which
///   may be infinite, or both NULL for all of the channel's cube; `options`, one struct or NULL, of which
///   limits do not matter; `summary`, one struct.
/// - Result: `*summary`.
/// - Errors: LEAFLESS_E_ARGUMENT if a coordinate is not a number, or min > max; LEAFLESS_E_FRAME if the solid
///   lies in another cube; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED.
/// - Untrusted input: any channel, any octree, any numbers.
leafless_status leafless_channel_summarise(const leafless_channel *channel, const leafless_octree *solid,
    const double min_model[3], const double max_model[3], const leafless_options *options,
    leafless_channel_summary *summary);

/// The octree of the cells whose values lie in a band: every number between those of `low` and `high`, both
/// included. Where there is no value, it is EMPTY. It lies on the channel's frame, and nothing is PARTIAL. A
/// Boolean makes it that of a part: of a material, of all that is hotter than a limit.
///
/// - Buffers: `low` and `high`, as many numbers each as the channel's values have, which may be infinite;
///   `options`, one struct or NULL; `octree`, one pointer.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_ARGUMENT if a bound is not a number; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT;
///   LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*octree` back with leafless_octree_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any channel, any numbers.
leafless_status leafless_channel_region(const leafless_channel *channel, const double *low,
    const double *high, const leafless_options *options, leafless_octree **octree);

/// Measures the parts of a solid in which a channel has one value, each as leafless_solid_measure: one for
/// each value of the channel that the solid may have somewhere, in ascending order of the values. The channel
/// is taken as it is; its cells decide what is which material. To ask for the count alone takes as long.
///
/// - Buffers: `frame`, one struct: where the solid is split, in the channel's cube; `options`, one struct or
///   NULL; `measured`, room for `capacity` structs, or NULL to ask for the count only; `count`, one number.
///   `relative` and `absolute_model` are those of leafless_solid_measure.
/// - Result: `*count`; the materials.
/// - Errors: LEAFLESS_E_LIMIT if the channel has more than 4096 different values; LEAFLESS_E_FRAME unless
///   `frame` is of the channel's cube; LEAFLESS_E_BUFFER if the capacity is too small; else as
///   leafless_solid_measure.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any solid, any channel; the default of `max_splits` bounds the work for each value.
leafless_status leafless_solid_materials(const leafless_solid *solid, const leafless_channel *channel,
    const leafless_frame *frame, double relative, double absolute_model, const leafless_options *options,
    leafless_material *measured, uint64_t capacity, uint64_t *count);

/// The samples of a volume as an attribute of one number, where the file says that they lie. There is no
/// value outside of the voxels, nor where a sample that counts is not a number. The first solid, range or
/// attribute of a volume reads all samples, in O(n).
///
/// - Buffers: `interpolation`, a leafless_interpolation; `options`, one struct or NULL, of which limits do
///   not matter; `attribute`, one pointer.
/// - Result: `*attribute`.
/// - Errors: LEAFLESS_E_ARGUMENT if the map that places the volume has no inverse that a map can have;
///   LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the attribute shares the samples, and `volume` may be freed; give `*attribute` back with
///   leafless_attribute_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any volume.
leafless_status leafless_attribute_from_volume(const leafless_volume *volume,
    leafless_interpolation interpolation, const leafless_options *options, leafless_attribute **attribute);

/// Whose value a point has that lies in several operands.
LEAFLESS_ENUM(leafless_carry, uint32_t) {
    LEAFLESS_CARRY_LEFT = 0,  ///< The first operand's that has one.
    LEAFLESS_CARRY_RIGHT = 1,  ///< The last operand's that has one.
    LEAFLESS_CARRY_MAX = 2,  ///< The greatest of all, number by number.
    LEAFLESS_CARRY_MEAN = 3,  ///< The mean of all, number by number, rounded to the type.
};

/// How channels of one name are carried.
typedef struct leafless_carry_rule {
    const char *name;  ///< The name of the channels, `name_length` bytes of UTF-8.
    size_t name_length;  ///< The length of the name.
    leafless_carry carry;  ///< A leafless_carry.
} leafless_carry_rule;

/// The octree with one more channel, in the place of one of the same name, if there is one; the arrays of
/// both are shared. A channel without a name has the empty one.
///
/// - Buffers: `result`, one pointer.
/// - Result: `*result`, with the metadata of `octree`.
/// - Errors: LEAFLESS_E_FRAME if the channel lies in another cube than the octree; LEAFLESS_E_ARGUMENT if
///   there are 256 channels already; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `*result` shares the arrays of `octree` and `channel`, which may be freed: what must outlive
///   these, such as bytes that they view, must outlive `*result` too. Give that back with
///   leafless_octree_free.
/// - Untrusted input: any octree, any channel.
leafless_status leafless_octree_with_channel(const leafless_octree *octree, const leafless_channel *channel,
    leafless_octree **result);

/// The octree without the channel of a name, or without any; the arrays are shared.
///
/// - Buffers: `name`, `name_length` bytes of UTF-8, or NULL for all channels; `result`, one pointer.
/// - Result: `*result`, with the metadata of `octree`; a channel that is not there need not be.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_octree_with_channel.
/// - Untrusted input: any octree, any text.
leafless_status leafless_octree_without_channel(const leafless_octree *octree, const char *name,
    size_t name_length, leafless_octree **result);

/// A channel of an octree by its place among all, which stand in ascending order of their names.
///
/// - Buffers: `channel`, one pointer.
/// - Result: `*channel`.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no channel `index`.
/// - Ownership: `*channel` shares the arrays of `octree`, which may be freed: what must outlive `octree`,
///   such as bytes that it views, must outlive `*channel` too. Give that back with leafless_channel_free.
/// - Untrusted input: any octree.
leafless_status leafless_octree_channel_at(const leafless_octree *octree, uint64_t index,
    leafless_channel **channel);

/// The channel of an octree with a name.
///
/// - Buffers: `name`, `name_length` bytes of UTF-8; `channel`, one pointer.
/// - Result: `*channel`; NULL if there is no such channel.
/// - Errors: LEAFLESS_E_UTF8.
/// - Ownership: as leafless_octree_channel_at.
/// - Untrusted input: any octree, any text.
leafless_status leafless_octree_channel(const leafless_octree *octree, const char *name, size_t name_length,
    leafless_channel **channel);

/// An octree that was made of operands in the same cube, whatever the operation, with their channels.
/// Channels of one name become one, in which at each point the values of those operands count that are not
/// EMPTY there. A channel that only one operand has is shared as it is. The same bit for bit for any number
/// of threads.
///
/// - Buffers: `octree`, a handle; `operands`, `count` handles; `carry`, a leafless_carry, by which channels
///   are joined that none of `rules` names; `rules`, `rule_count` structs, or NULL if that is 0; the first
///   that names a channel counts. `options`, one struct or NULL, of which limits concern each channel;
///   `result`, one pointer.
/// - Result: `*result`: the cells and metadata of `octree`; its own channels, but those of names that
///   operands have; each channel with the metadata of the first operand that has it.
/// - Errors: LEAFLESS_E_ARGUMENT if channels of one name have values of two types, or there are more than
///   256; LEAFLESS_E_FRAME unless all lie in one cube; LEAFLESS_E_UTF8; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT;
///   LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_octree_with_channel.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any octrees, any texts.
leafless_status leafless_octree_carry_channels(const leafless_octree *octree,
    const leafless_octree *const *operands, uint64_t count, leafless_carry carry,
    const leafless_carry_rule *rules, uint64_t rule_count, const leafless_options *options,
    leafless_octree **result);

/* ---- 25. Voxel records -------------------------------------------------------------------------------- */

/// What a voxel is: a number in the array `kinds`.
LEAFLESS_ENUM(leafless_voxel_kind, uint8_t) {
    LEAFLESS_VOXEL_KIND_OUTSIDE = 0,  ///< It lies outside of the solid.
    LEAFLESS_VOXEL_KIND_INSIDE = 1,  ///< It lies inside.
    LEAFLESS_VOXEL_KIND_BOUNDARY = 2,  ///< The boundary of the solid goes through it, or along it.
    LEAFLESS_VOXEL_KIND_REFINED = 3,  ///< It consists of the smaller voxels that follow it.
};

/// Which voxels are boundary voxels.
LEAFLESS_ENUM(leafless_voxel_boundary, uint32_t) {
    /// Cells of the boundary depth that are cut further there, and cells that are not decided.
    LEAFLESS_VOXEL_BOUNDARY_CUT = 0,
    /// These, and inside cells of the boundary depth that touch an outside cell with a face.
    LEAFLESS_VOXEL_BOUNDARY_TOUCHING = 1,
};

/// Which voxels are listed beside inside and boundary voxels: 0, one of these values, or both joined by `|`.
LEAFLESS_ENUM(leafless_voxel_lists, uint32_t) {
    LEAFLESS_VOXEL_LISTS_OUTSIDE = 1,  ///< Outside voxels.
    LEAFLESS_VOXEL_LISTS_REFINED = 2,  ///< Voxels that are refined.
};

/// Which voxels of an octree are listed, and how large they are. All fields but the first may be zero, which
/// is their default.
typedef struct leafless_voxel_options {
    uint32_t struct_size;  ///< sizeof(leafless_voxel_options).
    uint32_t boundary_depth;  ///< The level of boundary voxels; 0, and what is beyond, is the octree's depth.
    leafless_voxel_boundary boundary;  ///< A leafless_voxel_boundary.
    uint32_t lists;  ///< 0, or leafless_voxel_lists.
    /// The longest edge of inside voxels, in model units; 0: as long as the octree's cells.
    double coarse_model;
    double fine_model;  ///< Inside voxels of this edge are not split, with a criterion; 0: the coarse edge.
    /// How much the attribute may change in an inside voxel that is longer than the fine edge, with a
    /// criterion.
    double tolerance;
    /// The attribute that inside voxels follow, and whose values are listed; optional.
    const leafless_attribute *attribute;
    /// A leafless_criterion: what makes an inside voxel fine enough that is longer than the fine edge and no
    /// longer than the coarse one. Without one, all inside voxels have the coarse edge or less.
    leafless_criterion criterion;
    uint32_t reserved;  ///< Zero.
} leafless_voxel_options;

/// Lists the voxels of an octree: inside and boundary voxels, and others that `voxel_options` asks for,
/// sorted by linear octree code, of two with one code the larger one first. The code of a voxel is the Morton
/// code of its minimum corner on the lattice `*lattice`: an octal digit for each level of it from the root
/// on, of which as many count as the voxel's level says. Call it once for the count, and then with buffers.
///
/// - Buffers: `voxel_options`, one struct or NULL; `options`, one struct or NULL, of which `max_bytes`
///   counts; `lattice`, one struct; `codes`, `levels`, `kinds`, `corners_model` (3 numbers a record) and
///   `values` (as many numbers a record as values have components), room for `capacity` records each, each of
///   them NULL if it is not wanted; `count`, one number.
/// - Result: `*lattice`, the octree's universe with the depth of the finest voxel that there may be; the
///   arrays; `*count`, how many records there are. `kinds` are leafless_voxel_kind. Corners are rounded down
///   where they are no doubles. Values are those at the centres of voxels, NaN where there is none.
/// - Errors: LEAFLESS_E_ARGUMENT if an option is out of its range, or the universe would take more than 20
///   levels to the fine edge; LEAFLESS_E_BUFFER if `capacity` is too small: nothing is written then;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_CANCELLED.
/// - Untrusted input: any octree: damage reads as boundary voxels.
leafless_status leafless_octree_voxels(const leafless_octree *octree,
    const leafless_voxel_options *voxel_options, const leafless_options *options, leafless_frame *lattice,
    uint64_t *codes, uint8_t *levels, leafless_voxel_kind *kinds, double *corners_model, double *values,
    uint64_t capacity, uint64_t *count);

/// The record, not of a refined voxel, that contains a cell. O(log count).
///
/// - Buffers: `lattice`, one struct; `codes`, `levels` and `kinds`, `count` elements each, as
///   leafless_octree_voxels writes them; `cell`, 3 numbers: the cell's place among those of its level;
///   `index`, one number.
/// - Result: `*index`, the index of the record, or UINT64_MAX if there is none.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check.
/// - Untrusted input: any numbers; the answer means something if the records are sorted.
leafless_status leafless_voxels_find(const leafless_frame *lattice, const uint64_t *codes,
    const uint8_t *levels, const leafless_voxel_kind *kinds, uint64_t count, const uint32_t cell[3],
    uint32_t level, uint64_t *index);

/// The indices of the records from front to back: a voxel comes before every other one of which it hides a
/// part. Refined voxels are left out. No two records are compared; exact.
///
/// - Buffers: `lattice`, `codes`, `levels` and `kinds` as leafless_voxels_find; `from`, 3 numbers: the
///   direction of sight, or if `is_eye` the point (model units) from which voxels are seen; `options`, one
///   struct or NULL; `order`, room for `capacity` numbers, or NULL to ask for their count; `order_count`, one
///   number.
/// - Result: `order`; `*order_count`, the number of records that are not refined.
/// - Errors: LEAFLESS_E_ARGUMENT if the arrays are no records, the direction is zero, or a number is not
///   finite (of an eye also one beyond ±2^256 or, but zero, below 2^-256); LEAFLESS_E_BUFFER if `capacity` is
///   too small: nothing is written then; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_CANCELLED.
/// - Untrusted input: any numbers.
leafless_status leafless_voxels_order(const leafless_frame *lattice, const uint64_t *codes,
    const uint8_t *levels, const leafless_voxel_kind *kinds, uint64_t count, const double from[3],
    bool is_eye, const leafless_options *options, uint64_t *order, uint64_t capacity, uint64_t *order_count);

/// The records under one of the 48 symmetries of the universe about its centre, and then an offset of whole
/// finest cells of the lattice. Exact: the octree of the result is the octree of the records under the same
/// map. Call it once for the count, and then with buffers.
///
/// A record whose image is no cell becomes the largest cells that make its image up. What is moved out of the
/// universe is cut off; no record speaks of what comes in. A refined voxel is left out if its image is no
/// cell of the universe.
///
/// - Buffers: `lattice`, `codes`, `levels` and `kinds` as leafless_voxels_find; `axes` and `offset_cells`, 3
///   numbers each; `options`, one struct or NULL, of which `max_bytes` counts; `moved_codes`, `moved_levels`,
///   `moved_kinds` and `sources`, room for `capacity` elements each, each of them NULL if it is not wanted;
///   `moved_count`, one number. `axes[i]` says which old axis becomes the new axis i: 1 for x, 2 for y, 3 for
///   z, negative if it is turned round; 1, 2, 3 moves nothing.
/// - Result: the arrays, sorted as those of leafless_octree_voxels; `sources`, the index of the record that
///   each comes from; `*moved_count`, how many there are.
/// - Errors: LEAFLESS_E_ARGUMENT if the arrays are no records, or `axes` are not three different ones;
///   LEAFLESS_E_BUFFER if `capacity` is too small: nothing is written then; LEAFLESS_E_LIMIT;
///   LEAFLESS_E_NO_MEMORY; LEAFLESS_E_CANCELLED.
/// - Untrusted input: any numbers.
leafless_status leafless_voxels_moved(const leafless_frame *lattice, const uint64_t *codes,
    const uint8_t *levels, const leafless_voxel_kind *kinds, uint64_t count, const int32_t axes[3],
    const int32_t offset_cells[3], const leafless_options *options, uint64_t *moved_codes,
    uint8_t *moved_levels, leafless_voxel_kind *moved_kinds, uint64_t *sources, uint64_t capacity,
    uint64_t *moved_count);

/// For each boundary voxel the triangles of a mesh that meet it, in compressed rows: those of record i are
/// `triangles[offsets[i]]` to before `triangles[offsets[i + 1]]`, and ascend. A triangle that only touches a
/// voxel meets it. Exact.
///
/// - Buffers: `lattice`, `codes`, `levels` and `kinds` as leafless_voxels_find; `options`, one struct or
///   NULL, of which `max_bytes` counts; `offsets`, room for `offset_capacity` numbers, and `triangles`, room
///   for `triangle_capacity`, each NULL to ask for its count only; `offset_count` and `triangle_count`, one
///   number each.
/// - Result: `offsets`, one more than records; `triangles`, indices into the mesh; their counts.
/// - Errors: LEAFLESS_E_ARGUMENT if the arrays are no records; LEAFLESS_E_BUFFER if a capacity is too small:
///   nothing is written then; LEAFLESS_E_LIMIT; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_CANCELLED.
/// - Untrusted input: any numbers, any mesh.
leafless_status leafless_voxels_triangles(const leafless_frame *lattice, const uint64_t *codes,
    const uint8_t *levels, const leafless_voxel_kind *kinds, uint64_t count, const leafless_mesh *mesh,
    const leafless_options *options, uint64_t *offsets, uint64_t offset_capacity, uint64_t *offset_count,
    uint32_t *triangles, uint64_t triangle_capacity, uint64_t *triangle_count);

/// The octree that records speak of, to the depth of their lattice: inside voxels are FULL, outside voxels
/// and what no record speaks of EMPTY. Nothing is known of the space outside, and nothing is proven.
///
/// - Buffers: `lattice`, `codes`, `levels` and `kinds` as leafless_voxels_find; `options`, one struct or
///   NULL; `octree`, one pointer. `boundary` is the tag of boundary voxels: LEAFLESS_TAG_EMPTY,
///   LEAFLESS_TAG_PARTIAL or LEAFLESS_TAG_FULL.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_ARGUMENT if the arrays are no records, or `boundary` is another tag;
///   LEAFLESS_E_LIMIT; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_CANCELLED.
/// - Ownership: give `*octree` back with leafless_octree_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any numbers.
leafless_status leafless_octree_from_voxels(const leafless_frame *lattice, const uint64_t *codes,
    const uint8_t *levels, const leafless_voxel_kind *kinds, uint64_t count, leafless_tag boundary,
    const leafless_options *options, leafless_octree **octree);

/* ---- 26. Surfaces ------------------------------------------------------------------------------------- */

/// How a surface is made.
LEAFLESS_ENUM(leafless_surface_method, uint32_t) {
    /// Marching cubes: vertices on the edges between inside and outside samples. Exactly two triangles meet
    /// on every edge.
    LEAFLESS_SURFACE_METHOD_MARCHING_CUBES = 0,
    /// Simple marching cubes: all vertices are samples, all normals have one of 13 directions up to sign. The
    /// mesh is closed, but where its sheets touch, more than two triangles meet on an edge.
    LEAFLESS_SURFACE_METHOD_SIMPLE_MARCHING_CUBES = 1,
    /// Coplanar shrink: the surface of simple marching cubes with far fewer triangles where it has plane
    /// parts. All that lies in one plane becomes one region with straight edges. There are no cracks;
    /// triangles may be long and thin.
    LEAFLESS_SURFACE_METHOD_SHRINK = 2,
    /// Coplanar shrink in its published form, to compare with. It has cracks, so that the mesh is open where
    /// merged cells of several sizes meet.
    LEAFLESS_SURFACE_METHOD_SHRINK_PUBLISHED = 3,
    /// Dual contouring, of solids alone: edges and corners stay sharp. Samples are the centres of cells. It
    /// is leafless_tridexel_surface of a tri-dexel model with normals, which is made and dropped; that
    /// function also reports what the mesh does not show.
    LEAFLESS_SURFACE_METHOD_DUAL_CONTOURING = 4,
    /// Surface nets, of octrees alone: a vertex in each cube between samples that do not all lie on one side,
    /// in the middle of where the surface crosses it. Steps of the cells are smoothed; exactly two triangles
    /// meet on every edge.
    LEAFLESS_SURFACE_METHOD_SURFACE_NETS = 5,
};

/// To which end of an edge between an inside and an outside sample simple marching cubes and coplanar shrink
/// move the vertex.
LEAFLESS_ENUM(leafless_snap, uint32_t) {
    LEAFLESS_SNAP_FAT = 0,  ///< The outer one: the mesh contains all inside samples.
    /// The inner one: inside samples are vertices. What is one cell thick has no thickness then.
    LEAFLESS_SNAP_THIN = 1,
};

/// On which side of the surface the PARTIAL cells of an octree lie, which have no sign of their own.
LEAFLESS_ENUM(leafless_resolve, uint32_t) {
    LEAFLESS_RESOLVE_NONE = 0,  ///< Nobody says, which is an error if there are such cells.
    LEAFLESS_RESOLVE_INNER = 1,  ///< Outside: the surface is that of the FULL cells, of what is surely solid.
    /// Inside: the surface is that of the FULL and PARTIAL cells, of what is possibly solid.
    LEAFLESS_RESOLVE_OUTER = 2,
    /// Where the solid `source` says that the octree was made from: each cell's centre decides, as under
    /// LEAFLESS_RULE_SAMPLED. It is built anew on the octree's frame.
    LEAFLESS_RESOLVE_SOURCE = 3,
};

/// Where marching cubes puts a vertex on an edge between an inside and an outside sample.
LEAFLESS_ENUM(leafless_vertex_placement, uint32_t) {
    /// Half-way. The mesh has steps, and is as far from the surface as half a cell.
    LEAFLESS_VERTEX_PLACEMENT_MIDPOINT = 0,
    /// Where the edge crosses the solid's surface; if it does so several times, at one of the crossings.
    /// Half-spaces, meshes and solids made of them tell the crossing to rounding. For a solid that only tells
    /// about boxes, cells along the edge are split down to the depth of 20, and the crossing is known to a
    /// cell of that depth.
    LEAFLESS_VERTEX_PLACEMENT_CROSSING = 1,
};

/// How a surface is extracted. NULL means the defaults. All fields but the first may be zero, which is their
/// default. A field that the method does not use must be zero.
typedef struct leafless_surface_options {
    uint32_t struct_size;  ///< sizeof(leafless_surface_options).
    leafless_surface_method method;  ///< A leafless_surface_method.
    /// Of LEAFLESS_SURFACE_METHOD_SIMPLE_MARCHING_CUBES and of both kinds of LEAFLESS_SURFACE_METHOD_SHRINK:
    /// a leafless_snap.
    leafless_snap snap;
    leafless_resolve resolve;  ///< Of octrees: a leafless_resolve. Solids decide all samples themselves.
    /// Of LEAFLESS_SURFACE_METHOD_MARCHING_CUBES of solids: a leafless_vertex_placement. Octrees do not know
    /// where their solid's surface is.
    leafless_vertex_placement placement;
    uint32_t reserved;  ///< 0.
    const leafless_solid *source;  ///< Of LEAFLESS_RESOLVE_SOURCE: the solid that the octree was made from.
} leafless_surface_options;

/// The surface of an octree: a closed mesh between the centres of finest cells that lie inside and those that
/// lie outside. Everything around the universe counts as outside, so that the mesh is closed there, too.
///
/// Every edge is run along as often in one direction as in the other, but for
/// LEAFLESS_SURFACE_METHOD_SHRINK_PUBLISHED. Triangles turn counter-clockwise as seen from outside; no two
/// vertices are equal, and no triangle has a vertex twice. The order of vertices and triangles is always the
/// same: that of the cells in Morton order, or for coplanar shrink that of places and planes.
/// leafless_mesh_describe and leafless_mesh_copy hand the arrays out, leafless_mesh_inspect and
/// leafless_mesh_area tell about them, leafless_mesh_intersecting_pairs finds triangles that meet, and
/// leafless_mesh_write writes them.
///
/// Time is linear in the octree's array elements and the mesh: it grows with the surface, not with the
/// volume. (Coplanar shrink takes O(n log n + n w) for n cells at the surface of which at most w lie along a
/// line in a plane region.) Beside the mesh it takes 56 bytes (simple marching cubes: up to 128) for each
/// block of 4³ cells at the surface, and coplanar shrink up to 200 bytes for each cell at a curved surface.
///
/// - Buffers: `surface`, one struct or NULL; `options`, one struct or NULL, of which `max_nodes` and
///   `max_bytes` count for LEAFLESS_RESOLVE_SOURCE only; `mesh`, one pointer.
/// - Result: `*mesh`, the same for any number of threads; it has no triangles if nothing is inside.
/// - Errors: LEAFLESS_E_ARGUMENT if the octree has PARTIAL cells and `resolve` does not say what they count
///   as, if a field of `surface` is none of its enum, or is set though the method does not use it, or if the
///   frame lies so far from the origin that doubles cannot tell its cells apart; LEAFLESS_E_NULL if
///   LEAFLESS_RESOLVE_SOURCE has no `source`; LEAFLESS_E_MESH if there would be more than 2^32 - 1 vertices
///   or triangles; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY; and those of
///   leafless_octree_build for the source.
/// - Ownership: `octree` stays as it is; give `*mesh` back with leafless_mesh_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any octree; damage is LEAFLESS_E_DAMAGED or another surface.
leafless_status leafless_octree_surface(const leafless_octree *octree,
    const leafless_surface_options *surface, const leafless_options *options, leafless_mesh **mesh);

/// The surface of a solid, which is sampled at the corners of the cells of a frame: 2^depth + 1 to an axis.
/// Dual contouring samples at the centres. Else as leafless_octree_surface. What the solid has outside of the
/// universe is cut off.
///
/// Time is that of leafless_octree_build with LEAFLESS_RULE_SAMPLED on as many cells as there are corners,
/// and for LEAFLESS_VERTEX_PLACEMENT_CROSSING a few questions to the solid for each vertex; memory as well.
/// With crossings, vertices that lie at one place are one, and triangles without area are dropped. Where the
/// solid has no thickness at a sample, more than two triangles may then meet on an edge.
///
/// - Buffers: `frame`, one struct; `surface`, one struct or NULL, whose `resolve` and `source` are 0;
///   `options`, one struct or NULL; `mesh`, one pointer.
/// - Result: `*mesh`, the same for any number of threads; it has no triangles if nothing is inside.
/// - Errors: LEAFLESS_E_ARGUMENT if the depth is 20, which leaves no level for corners, if a field of
///   `surface` is none of its enum, or is set though it is not used, or if the frame lies so far from the
///   origin that doubles cannot tell its corners apart; LEAFLESS_E_NOT_SAMPLED if the solid cannot decide
///   points; LEAFLESS_E_FRAME for the solid of leafless_solid_from_octree, which has samples of its own, and
///   for others that belong to another frame; LEAFLESS_E_MESH if there would be more than 2^32 - 1 vertices
///   or triangles; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*mesh` back with leafless_mesh_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any solid; set `max_bytes` where the depth or the solid is not your own choice.
leafless_status leafless_solid_surface(const leafless_solid *solid, const leafless_frame *frame,
    const leafless_surface_options *surface, const leafless_options *options, leafless_mesh **mesh);

/// The surface of a volume by marching cubes: its samples are the centres of voxels, which need not be cubes,
/// and its vertices lie where the samples, interpolated between two voxels, leave the band. For samples of a
/// smooth function that is on the surface to second order in the spacing. Between bits, and beside a sample
/// that is infinite or not a number, they lie half-way.
///
/// Else as leafless_octree_surface; vertices that lie at one place are one, and there more than two triangles
/// may meet on an edge. Time is linear in the samples, and in the surface.
///
/// - Buffers: `band`, one struct, or NULL, as for leafless_solid_from_volume; `options`, one struct or NULL,
///   of which limits do not matter; `mesh`, one pointer.
/// - Result: `*mesh`, the same for any number of threads, where the file says that the volume lies.
/// - Errors: those of leafless_solid_from_volume; LEAFLESS_E_ARGUMENT if the volume lies so far from the
///   origin that doubles cannot tell its voxels apart; LEAFLESS_E_MESH if there would be more than 2^32 - 1
///   vertices or triangles.
/// - Ownership: `volume` stays as it is; give `*mesh` back with leafless_mesh_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any volume.
leafless_status leafless_volume_surface(const leafless_volume *volume, const leafless_interval *band,
    const leafless_options *options, leafless_mesh **mesh);

/// What a surface is.
LEAFLESS_ENUM(leafless_surface_kind, uint32_t) {
    /// Anything without numbers of its own: a sum of powers, a torus that is stretched.
    LEAFLESS_SURFACE_KIND_OTHER = 0,
    LEAFLESS_SURFACE_KIND_PLANE = 1,  ///< A plane: the points p with `direction` · p = `offset_model`.
    LEAFLESS_SURFACE_KIND_BALL = 2,  ///< The points that are `radius_model` away from `point_model`.
    /// The points that are `radius_model` away from the line through `point_model` along `direction`.
    LEAFLESS_SURFACE_KIND_CYLINDER = 3,
    /// The lines through `point_model` at an angle of `half_angle_radians` to `direction`.
    LEAFLESS_SURFACE_KIND_CONE = 4,
    /// The points that are `minor_model` away from the circle of radius `radius_model` around `point_model`,
    /// across `direction`.
    LEAFLESS_SURFACE_KIND_TORUS = 5,
    LEAFLESS_SURFACE_KIND_QUADRIC = 6,  ///< Any other surface of degree two.
};

/// A surface in model space. Fields that the kind does not use are 0.
///
/// The numbers are those of the exact surface, rounded. A surface of degree two has the name of a ball, a
/// cylinder or a cone if its coefficients are those of one to 10^-9 of their size.
typedef struct leafless_boundary_surface {
    leafless_surface_kind kind;  ///< A leafless_surface_kind.
    uint32_t reserved;  ///< 0.
    /// Of a ball and a torus the centre, of a cylinder the point of the axis that is nearest to the origin,
    /// of a cone the apex.
    double point_model[3];
    /// Of a plane the normal, which points out of the half-space that it bounds; of a cylinder, a cone and a
    /// torus the axis. Of length 1.
    double direction[3];
    double offset_model;  ///< Of a plane: its distance from the origin, along the normal.
    double radius_model;  ///< Of a ball and a cylinder, and of the circle of a torus.
    double minor_model;  ///< Of a torus.
    double half_angle_radians;  ///< Of a cone: the angle between axis and surface, between 0 and π/2.
    /// Of a quadric: the factors of x², y², z², xy, yz, zx, x, y, z and 1, as leafless_solid_new_quadric
    /// takes them. The largest one is between 1/2 and 1.
    double coefficients[10];
} leafless_boundary_surface;

/// A part of a boundary that hangs together on one surface.
typedef struct leafless_boundary_region {
    /// The number of its surface among those of leafless_boundary_surfaces; UINT32_MAX where the boundary is
    /// known to a cell only.
    uint32_t surface;
    uint32_t first_face;  ///< Its first face. The others follow.
    uint32_t face_count;  ///< How many faces it has.
    uint32_t triangle_count;  ///< How many triangles of the mesh.
    double area_model;  ///< The area of these triangles.
    /// Whether the normal of the surface points into the solid: that of a plane as `direction` says, that of
    /// a ball, a cylinder, a cone and a torus away from its centre, axis or circle. So a bore is turned, and
    /// a pin is not.
    bool is_turned;
} leafless_boundary_region;

/// What is known of the boundary of a solid.
typedef struct leafless_boundary_report {
    uint32_t struct_size;  ///< sizeof(leafless_boundary_report).
    /// No point of the mesh is further from the boundary of the solid than that, and no point of the boundary
    /// from the mesh (model units). That is proven; infinite if nothing is.
    double deviation_model;
    /// Pairs of triangles that intersect each other: 0 but where cells of the frame's depth do not tell
    /// surfaces apart.
    uint64_t intersecting_pairs;
    uint64_t cells;  ///< Cells that the boundary passes through.
    uint64_t splits;  ///< Cells that were split.
    uint64_t surfaces;  ///< Surfaces that the solid is made of.
    uint64_t regions;  ///< Regions.
    uint64_t faces;  ///< Faces.
} leafless_boundary_report;

/// The boundary of a solid that knows its surfaces, as solids of half-spaces do, and octrees that keep
/// theirs: its plane faces as they are, with triangles between their corners alone, and curved ones in chords
/// that are no further from them than about `tolerance_model`. Edges are sharp, and corners are exact to
/// rounding. The solid must end inside of the universe of the frame.
///
/// The mesh is closed, and exactly two triangles meet in each edge; where the solid touches itself, vertices
/// lie at one place. Cells are split until at most three surfaces in each have a simple arrangement. Where
/// more meet in a point, and where surfaces touch, they are split as far as the depth of the frame, which
/// costs little: 12 to 16 is good for parts.
///
/// How far the mesh and the boundary are from each other is proven by the surfaces. Where that is more than
/// the tolerance, cells are split, as far as the depth of the frame.
///
/// About 50 microseconds and 500 bytes a cell; threads share the proof.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `boundary`, one pointer.
/// - Result: `*boundary`.
/// - Errors: LEAFLESS_E_ARGUMENT if the solid is not known to end inside of the universe, or consists of
///   something else than surfaces, as a mesh or a host program's function does, or `tolerance_model` is not
///   between 2^-256 and 2^256; LEAFLESS_E_MESH if there would be more than 2^32 - 1 vertices, triangles or
///   corners; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `solid` stays as it is; give `*boundary` back with leafless_boundary_free.
/// - Threads: any.
/// - Untrusted input: any solid; set `max_nodes` where the depth or the solid is not your own choice.
leafless_status leafless_solid_boundary(const leafless_solid *solid, const leafless_frame *frame,
    double tolerance_model, const leafless_options *options, leafless_boundary **boundary);

/// One more reference to a boundary.
///
/// - Buffers: `boundary`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `boundary`.
/// - Ownership: give each reference back with leafless_boundary_free.
leafless_status leafless_boundary_ref(const leafless_boundary *boundary, leafless_boundary **reference);

/// Gives back a reference to a boundary; with the last one the boundary is gone. Its mesh stays if it was
/// asked for.
///
/// - Buffers: `boundary`, a handle or NULL, which does nothing.
/// - Ownership: the reference is gone.
/// - Threads: any; no other call may use this reference.
void leafless_boundary_free(leafless_boundary *boundary);

/// What is known of a boundary. O(1).
///
/// - Buffers: `report`, one struct.
/// - Result: `*report`.
leafless_status leafless_boundary_describe(const leafless_boundary *boundary,
    leafless_boundary_report *report);

/// The mesh of a boundary. O(1).
///
/// - Buffers: `mesh`, one pointer.
/// - Result: `*mesh`.
/// - Ownership: the mesh is shared, and `boundary` may be freed; give `*mesh` back with leafless_mesh_free.
leafless_status leafless_boundary_mesh(const leafless_boundary *boundary, leafless_mesh **mesh);

/// The surfaces that a solid is made of, by their kinds and numbers. Some may bound nothing.
///
/// - Buffers: `surfaces`, room for `capacity` structs, or NULL to ask for the count only; `count`, one
///   number.
/// - Result: `*count`; the surfaces.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small.
leafless_status leafless_boundary_surfaces(const leafless_boundary *boundary,
    leafless_boundary_surface *surfaces, uint64_t capacity, uint64_t *count);

/// The regions of a boundary, in the order of their faces.
///
/// - Buffers: `regions`, room for `capacity` structs, or NULL to ask for the count only; `count`, one number.
/// - Result: `*count`; the regions.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small.
leafless_status leafless_boundary_regions(const leafless_boundary *boundary,
    leafless_boundary_region *regions, uint64_t capacity, uint64_t *count);

/// The region of each triangle of the mesh of a boundary.
///
/// - Buffers: `regions`, room for `capacity` numbers, or NULL to ask for the count only; `count`, one number.
/// - Result: `*count`, the number of triangles; in `regions` the number of the region of each.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small.
leafless_status leafless_boundary_triangle_regions(const leafless_boundary *boundary, uint32_t *regions,
    uint64_t capacity, uint64_t *count);

/// The faces of a boundary where they lie, without a copy, as leafless_mesh_write_polygons and
/// leafless_mesh_from_polyhedron take them: vertices of type double, which are those of the mesh, and indices
/// of 32 bits.
///
/// A plane region is triangles, too, if its loops touch each other along edges, as they do where the solid
/// touches itself, or if its corners lie further beside one plane than 10^-9 of the solid's extent. A shell
/// around a void belongs to the smallest solid in which it lies.
///
/// - Buffers: `arrays`, one struct.
/// - Result: `*arrays`.
/// - Ownership: the arrays belong to the boundary and live as long as the reference `boundary`.
leafless_status leafless_boundary_peek_faces(const leafless_boundary *boundary,
    leafless_polyhedron_arrays *arrays);

/// How a contour was found.
typedef struct leafless_contour_report {
    uint32_t struct_size;  ///< sizeof(leafless_contour_report).
    /// No point of the mesh is further from the boundary of the solid than that, and no point of the boundary
    /// from the mesh (model units). That is proven; infinite if nothing is.
    double deviation_model;
    /// Pairs of triangles that intersect each other: 0 but where cells of the frame's depth do not tell
    /// sheets of the surface apart.
    uint64_t intersecting_pairs;
    uint64_t cells;  ///< Cells that the surface passes through.
    uint64_t splits;  ///< Cells that were split.
    /// Points of which the solid did not tell whether they lie inside; they counted as outside.
    uint64_t undecided;
} leafless_contour_report;

/// A closed mesh of any solid, with few triangles where it is flat and small ones where it is not: of meshes,
/// expressions with meshes in them, volumes, octrees, tri-dexel models, and functions of the host. The solid
/// must end inside of the universe of the frame. (leafless_solid_boundary is sharper for solids that know
/// their surfaces.)
///
/// Cells are split until the surface in each is one piece that a single vertex can stand for: where planes of
/// the surface meet, so that edges and corners are sharp. The mesh is then about as near to the solid as
/// `tolerance_model`, as far as cells of the frame's depth can be. It is closed, exactly two triangles meet
/// in each edge, and the triangles around each vertex are one fan, whatever the solid is. Of a solid that is
/// thinner than a finest cell nothing may be left. Points of which the solid does not tell on which side they
/// lie count as outside.
///
/// About 100 microseconds a cell of a mesh, and more for solids that answer no rays; one thread does it all.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL, of which `max_nodes` bounds the splits, and
///   with `max_splits` spent cells stay as they are; `report`, one struct or NULL; `mesh`, one pointer.
/// - Result: `*mesh`; `*report`.
/// - Errors: LEAFLESS_E_ARGUMENT if the solid is not known to end inside of the universe, or
///   `tolerance_model` is not between 2^-256 and 2^256; LEAFLESS_E_MESH if there would be more than 2^32 - 1
///   vertices or triangles; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*mesh` back with leafless_mesh_free.
/// - Threads: any.
/// - Untrusted input: any solid; set `max_nodes` where the depth or the solid is not your own choice.
leafless_status leafless_solid_contour(const leafless_solid *solid, const leafless_frame *frame,
    double tolerance_model, const leafless_options *options, leafless_contour_report *report,
    leafless_mesh **mesh);

/// How a mesh was simplified.
typedef struct leafless_simplified {
    uint32_t struct_size;  ///< sizeof(leafless_simplified).
    /// No point of either mesh is further from the other one than that (model units). That is proven.
    double deviation_model;
    uint64_t removed;  ///< Triangles that were taken away.
    /// Pairs of triangles of the result that intersect each other. All of them did before.
    uint64_t intersecting_pairs;
} leafless_simplified;

/// The same mesh with fewer triangles, no point of which is further than `tolerance_model` from the mesh, and
/// none of the mesh further from it: proven in both directions by the triangles of both.
///
/// Vertices are taken out, and none is moved. Edges between triangles whose normals differ by more than 30
/// degrees stay edges, and so do those between triangles that bear different values; along an edge vertices
/// go as far as the tolerance allows, and corners stay. A mesh that is closed and a manifold stays so, with
/// as many bodies and holes. Vertices on open edges, and those where more than two triangles meet in an edge,
/// stay. No triangles intersect each other that did not before.
///
/// O(n log n) time for n triangles whose vertices have few: some 20 microseconds a triangle, and some 300
/// bytes. One thread takes vertices out, and all prove.
///
/// - Buffers: `options`, one struct or NULL; `report`, one struct, or NULL if it is not wanted; `simple`, one
///   pointer.
/// - Result: `*simple`, with the values of triangles that are left and without those of corners, whose stated
///   deviation is that of `mesh` with what is proven here; `*report`. The same for any number of threads.
/// - Errors: LEAFLESS_E_ARGUMENT if `tolerance_model` is not between 2^-256 and 2^256; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` stays as it is; give `*simple` back with leafless_mesh_free.
/// - Threads: any; uses as many as `options` says.
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

/// How the ends of intervals are stored.
LEAFLESS_ENUM(leafless_dexel_ends, uint32_t) {
    /// Start and length in units of 2^-31 edges of the universe, 8 bytes an interval. An end is off by at
    /// most one unit.
    LEAFLESS_DEXEL_ENDS_FIXED = 0,
    LEAFLESS_DEXEL_ENDS_DOUBLE = 1,  ///< Start and end as doubles, 16 bytes an interval.
};

/// How the unit normals at the ends of intervals are stored: in an octahedral code.
LEAFLESS_ENUM(leafless_dexel_normals, uint32_t) {
    LEAFLESS_DEXEL_NORMALS_NONE = 0,  ///< Not at all.
    LEAFLESS_DEXEL_NORMALS_16 = 1,  ///< In 16 bits, 4 bytes an interval, within a degree.
    LEAFLESS_DEXEL_NORMALS_32 = 2,  ///< In 32 bits, 8 bytes an interval, within 0.005 degrees.
};

/// What a tri-dexel model stores. NULL means the defaults. All fields but the first may be zero, which is
/// their default.
typedef struct leafless_tridexel_format {
    uint32_t struct_size;  ///< sizeof(leafless_tridexel_format).
    /// The axes that rays run along, a sum of leafless_axes; 0 means those of the operand if there is one,
    /// else LEAFLESS_AXES_ALL.
    uint32_t directions;
    uint32_t ends;  ///< A leafless_dexel_ends.
    uint32_t normals;  ///< A leafless_dexel_normals.
    /// 1 to store on which of the source's surfaces the ends lie, 8 bytes an interval. Else 0.
    uint32_t has_surfaces;
    uint32_t has_materials;  ///< 1 to store what intervals are made of, 4 bytes an interval. Else 0.
} leafless_tridexel_format;

/// What can be said of a tri-dexel model at once.
typedef struct leafless_tridexel_info {
    uint32_t struct_size;  ///< sizeof(leafless_tridexel_info).
    leafless_frame frame;  ///< The lattice: rays run through the centres of its finest cells.
    uint32_t directions;  ///< The axes that rays run along, a sum of leafless_axes.
    leafless_dexel_ends ends;  ///< How the ends of intervals are stored.
    leafless_dexel_normals normals;  ///< How unit normals are stored.
    uint32_t has_surfaces;  ///< 1 if it is stored on which surfaces the ends lie, else 0.
    uint32_t has_materials;  ///< 1 if it is stored what intervals are made of, else 0.
    uint32_t bytes_per_interval;  ///< Bytes that an interval takes.
    uint64_t interval_count;  ///< Intervals in all directions.
    uint64_t bytes;  ///< Bytes that the arrays take.
} leafless_tridexel_info;

/// Makes the tri-dexel model of a solid on the lattice of a frame. O(rays + crossings). The result is the
/// same bit for bit for any number of threads.
///
/// Under LEAFLESS_RULE_SAMPLED intervals are those of the solid on each ray. An end says of the centres of
/// cells beside it just what the solid does; apart from that it is off by at most 2^-31 of the universe's
/// edge, or 2^-36 with LEAFLESS_DEXEL_ENDS_DOUBLE. So it is with closed meshes, with half-spaces and
/// expressions of them, and with octrees. Solids of other kinds, and open meshes around their holes, are
/// sampled: an end between centres on different sides is narrowed down by cells to a depth of 20, and a wall
/// between two neighbouring centres is missed. Under LEAFLESS_RULE_INNER and LEAFLESS_RULE_OUTER intervals
/// are those of the solid's FULL cells, and of all that are not EMPTY.
///
/// - Buffers: `frame`, one struct; `format`, one struct or NULL; `options`, one struct or NULL; `tridexel`,
///   one pointer. `rule` is a leafless_rule.
/// - Result: `*tridexel`.
/// - Errors: LEAFLESS_E_ARGUMENT also for LEAFLESS_RULE_CERTIFIED, because an interval cannot be undecided,
///   and if a field of `format` is wrong; LEAFLESS_E_FRAME if the solid belongs to another frame;
///   LEAFLESS_E_NOT_SAMPLED if LEAFLESS_RULE_SAMPLED is asked of a solid that cannot decide points;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT, also for 2^32 rays or intervals along one
///   axis; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: nothing is kept of the solid; give `*tridexel` back with leafless_tridexel_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any solid; set `max_bytes` where the depth or the solid is not your own choice.
leafless_status leafless_tridexel_build(const leafless_solid *solid, const leafless_frame *frame,
    leafless_rule rule, const leafless_tridexel_format *format, const leafless_options *options,
    leafless_tridexel **tridexel);

/// One more reference to a tri-dexel model.
///
/// - Buffers: `tridexel`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `tridexel`.
/// - Ownership: give each reference back with leafless_tridexel_free.
leafless_status leafless_tridexel_ref(const leafless_tridexel *tridexel, leafless_tridexel **reference);

/// Gives back a reference to a tri-dexel model. With the last one the model is gone, and with it the mapping
/// of its file, unless a model with other metadata still shares its arrays.
///
/// - Buffers: `tridexel`, a handle or NULL, which does nothing.
/// - Ownership: the reference is gone.
/// - Threads: any; no other call may use this reference.
void leafless_tridexel_free(leafless_tridexel *tridexel);

/// What can be said of a tri-dexel model at once. O(1).
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
/// - Untrusted input: any model.
leafless_status leafless_tridexel_describe(const leafless_tridexel *tridexel, leafless_tridexel_info *info);

/// Checks that a tri-dexel model is well-formed: intervals are in order, disjoint and inside of the universe.
/// O(n). Whether the directions agree is not checked. Models that the library makes, opens or maps verified
/// are well-formed.
///
/// - Result: LEAFLESS_OK if it is.
/// - Errors: LEAFLESS_E_DAMAGED, with the first damage in the message.
/// - Untrusted input: any model.
leafless_status leafless_tridexel_check(const leafless_tridexel *tridexel);

/// Whether two tri-dexel models store the same, bit for bit, on the same frame. Metadata does not count.
/// O(n).
///
/// - Buffers: `equal`, one truth value.
/// - Result: `*equal`.
/// - Untrusted input: any models.
leafless_status leafless_tridexel_equal(const leafless_tridexel *a, const leafless_tridexel *b, bool *equal);

/// The tri-dexel model with one more fact in its metadata, or with another value of one; the arrays are
/// shared. Names in use: "name", "units".
///
/// - Buffers: `key` and `value`, `key_length` and `value_length` bytes of UTF-8; `named`, one pointer.
/// - Result: `*named`.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_ARGUMENT if all facts would take more than 1 MiB in a file, 8 bytes
///   and the two texts each; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the texts are copied. `*named` shares the arrays of `tridexel`, which may be freed: what must
///   outlive `tridexel`, such as bytes that it views, must outlive `*named` too. Give that back with
///   leafless_tridexel_free.
/// - Untrusted input: any texts.
leafless_status leafless_tridexel_with_metadata(const leafless_tridexel *tridexel, const char *key,
    size_t key_length, const char *value, size_t value_length, leafless_tridexel **named);

/// The tri-dexel model with one fact less in its metadata, or with none; the arrays are shared.
///
/// - Buffers: `key`, `key_length` bytes of UTF-8, or NULL for all facts; `unnamed`, one pointer.
/// - Result: `*unnamed`; a fact that is not there need not be.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_tridexel_with_metadata.
/// - Untrusted input: any texts.
leafless_status leafless_tridexel_without_metadata(const leafless_tridexel *tridexel, const char *key,
    size_t key_length, leafless_tridexel **unnamed);

/// The value of a fact in a tri-dexel model's metadata, such as "name".
///
/// - Buffers: `key`, `key_length` bytes of UTF-8; `value` and `value_length`, one each.
/// - Result: `*value`, not NUL-terminated; NULL if there is no such fact. `*value_length`, in bytes.
/// - Errors: LEAFLESS_E_UTF8.
/// - Ownership: the text belongs to the model and lives as long as the reference `tridexel`.
/// - Untrusted input: any model.
leafless_status leafless_tridexel_peek_metadata(const leafless_tridexel *tridexel, const char *key,
    size_t key_length, const char **value, size_t *value_length);

/// A fact of a tri-dexel model's metadata by its place among all, which stand by ascending key.
///
/// - Buffers: `count`, one number; `key`, `key_length`, `value`, `value_length`, one each, all four NULL to
///   ask for the count only.
/// - Result: `*count`, the number of all facts; key and value, not NUL-terminated, with their lengths in
///   bytes.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no fact `index`, unless only the count is asked for.
/// - Ownership: the texts belong to the model and live as long as the reference `tridexel`.
/// - Untrusted input: any model.
leafless_status leafless_tridexel_peek_metadata_at(const leafless_tridexel *tridexel, uint64_t index,
    uint64_t *count, const char **key, size_t *key_length, const char **value, size_t *value_length);

/// Intervals of rays along one axis, as leafless_tridexel_copy hands them out.
typedef struct leafless_tridexel_arrays {
    uint32_t axis;  ///< The axis that the rays run along: 0 for x, 1 for y, 2 for z.
    uint32_t reserved;  ///< Zero.
    uint32_t first[2];  ///< The indices of the first ray's cells on the other two axes in the order x, y, z.
    uint32_t end[2];  ///< The first beyond those of the last ray. Rays outside of the rectangle are empty.
    /// The intervals of ray i are those from `offsets[i]` to before `offsets[i + 1]`: one number more than
    /// rays, in ascending order. The ray at steps (u, v) from the first is i = v · width + u.
    const uint64_t *offsets;
    uint64_t interval_count;  ///< How many intervals there are, which is the last offset.
    /// Two coordinates for each interval, its start and its end. NULL if `ends_cells` says where they lie.
    const double *ends_model;
    /// Six numbers for each interval: the outward normals at its start and at its end, of any length; three
    /// zeros where none is known. NULL if none is known at all.
    const double *normals;
    /// Two numbers for each interval: on which surfaces its start and its end lie; UINT32_MAX where it is not
    /// known. NULL if none is known at all.
    const uint32_t *surfaces;
    /// A number for each interval, what it is made of; 0 where nothing is said. NULL if nothing is said at
    /// all.
    const uint32_t *materials;
    /// Two numbers for each interval: its start and its end in finest cells from the universe's lower face,
    /// as leafless_tridexel_copy_cells hands them out; the centre of cell k lies at k + 1/2. An end counts by
    /// this number if its coordinate in `ends_model` is the one that leafless_tridexel_copy would hand out
    /// for it, else by the coordinate. If `ends_model` is NULL it counts always. NULL if coordinates alone
    /// count.
    const double *ends_cells;
} leafless_tridexel_arrays;

/// Makes a tri-dexel model of intervals that another program or a machine has. O(rays of the universe +
/// intervals).
///
/// The intervals of a ray ascend and are disjoint. What reaches beyond the universe is cut off; what `format`
/// does not store is left out. Ends are rounded as `format` says, and keep their side of every centre of a
/// cell, which is the real number origin + (k + 1/2) edge / 2^depth; that is decided exactly. Intervals that
/// are empty after rounding are left out; those that touch are joined, unless both have materials and these
/// differ. The directions are not compared with each other. All that leafless_tridexel_copy and
/// leafless_tridexel_copy_cells hand out of a model makes an equal one on the same frame.
///
/// - Buffers: `frame`, one struct; `format`, one struct or NULL, whose `directions` are 0 or the axes of
///   `rays`; `rays`, `count` structs, 1 to 3, each for another axis; `options`, one struct or NULL;
///   `tridexel`, one pointer.
/// - Result: `*tridexel`.
/// - Errors: LEAFLESS_E_ARGUMENT also if offsets do not ascend, if an end of an interval is not a number or
///   not behind its start, if an end in cells does not lie in the universe, or if an interval begins before
///   the one before it ends; LEAFLESS_E_LIMIT for 2^32 rays or intervals along one axis, which is a depth of
///   16; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the arrays are not kept; give `*tridexel` back with leafless_tridexel_free.
/// - Untrusted input: any numbers.
leafless_status leafless_tridexel_new(const leafless_frame *frame, const leafless_tridexel_format *format,
    const leafless_tridexel_arrays *rays, uint64_t count, const leafless_options *options,
    leafless_tridexel **tridexel);

/// One end of a leafless_dexel.
typedef struct leafless_dexel_end {
    /// The coordinate along the ray. It lies on the side of every centre of a cell that is stored, as far as
    /// there is a double between two centres.
    double at_model;
    /// The same in finest cells from the universe's lower face, exactly as it is stored; the centre of cell k
    /// lies at k + 1/2.
    double at_cells;
    double normal[3];  ///< The outward unit normal of the surface there; three zeros if it is not known.
    /// On which of the source's surfaces it lies: a triangle of a mesh, a half-space in the order of the
    /// expression written out. UINT32_MAX if it is not known.
    uint32_t surface;
} leafless_dexel_end;

/// An interval of a ray that lies inside of the solid.
typedef struct leafless_dexel {
    leafless_dexel_end start;  ///< Where it begins.
    leafless_dexel_end end;  ///< Where it ends, which is behind its start.
    uint32_t material;  ///< What it is made of; 0 where nothing was said.
} leafless_dexel;

/// What the rays along one axis hold.
typedef struct leafless_dexel_statistics {
    uint32_t struct_size;  ///< sizeof(leafless_dexel_statistics).
    uint64_t rays;  ///< Rays that cross the solid.
    uint64_t intervals;  ///< Intervals.
    uint64_t bytes;  ///< Bytes of the arrays.
    /// The lengths of all intervals, each times the area of a cell's face: an estimate of the volume in cubic
    /// model units, no bound.
    double volume_model;
    double min_model[3];  ///< The least coordinates of what the rays cross; INFINITY if they cross nothing.
    /// The greatest coordinates of what the rays cross; -INFINITY if they cross nothing.
    double max_model[3];
} leafless_dexel_statistics;

/// What the rays along an axis hold. O(n).
///
/// - Buffers: `statistics`, one struct. `axis` is 0 for x, 1 for y, 2 for z.
/// - Result: `*statistics`.
/// - Errors: LEAFLESS_E_ARGUMENT if the model has no rays along `axis`.
/// - Untrusted input: any model, any number.
leafless_status leafless_tridexel_statistics(const leafless_tridexel *tridexel, uint32_t axis,
    leafless_dexel_statistics *statistics);

/// Whether the centre of a finest cell lies inside. O(log intervals of a ray).
///
/// - Buffers: `cell`, 3 numbers; `inside`, one truth value.
/// - Result: `*inside`; false if a coordinate is not below 2^depth. Where the directions differ, as those of
///   arrays from elsewhere may, the highest axis decides.
/// - Untrusted input: any model, any numbers.
leafless_status leafless_tridexel_contains_cell(const leafless_tridexel *tridexel, const uint32_t cell[3],
    bool *inside);

/// The smallest rectangle of rays along an axis that holds all rays that cross the solid.
///
/// - Buffers: `first` and `end`, 2 numbers each: the indices of the first ray's cells on the other two axes
///   in the order x, y, z, and the first beyond the last one's. `axis` is 0 for x, 1 for y, 2 for z.
/// - Result: `first` and `end`; equal to each other if no ray crosses the solid.
/// - Errors: LEAFLESS_E_ARGUMENT if the model has no rays along `axis`.
/// - Untrusted input: any model, any number.
leafless_status leafless_tridexel_window(const leafless_tridexel *tridexel, uint32_t axis, uint32_t first[2],
    uint32_t end[2]);

/// The intervals of one ray, in ascending order.
///
/// - Buffers: `ray`, 2 numbers, the indices of the ray's cells on the other two axes in the order x, y, z;
///   `dexels`, room for `capacity` structs, or NULL to ask for the count only; `count`, one number. `axis` is
///   0 for x, 1 for y, 2 for z.
/// - Result: `*count`; the intervals. A ray outside of the universe has none.
/// - Errors: LEAFLESS_E_ARGUMENT if the model has no rays along `axis`; LEAFLESS_E_BUFFER if the capacity is
///   too small.
/// - Untrusted input: any model, any numbers.
leafless_status leafless_tridexel_ray(const leafless_tridexel *tridexel, uint32_t axis, const uint32_t ray[2],
    leafless_dexel *dexels, uint64_t capacity, uint64_t *count);

/// The intervals of many rays along one axis, in compressed rows: those of ray i are the elements
/// `offsets[i]` to before `offsets[i + 1]` of each array. The ray at steps (u, v) from the first is i = v ·
/// width + u, of a rectangle that is `width` rays wide along the first of the other two axes. O(rays +
/// intervals).
///
/// - Buffers: `first` and `end`, 2 numbers each, or NULL both for the rectangle of leafless_tridexel_window:
///   the indices of the first ray's cells on the other two axes in the order x, y, z, and the first beyond
///   the last one's. `offsets`, room for `offset_capacity` numbers; for each of `interval_capacity` intervals
///   `ends_model` has room for 2 numbers, `normals` for 6, `surfaces` for 2, `materials` for 1. Each of the
///   five may be NULL, if it is not wanted. `offset_count` and `interval_count`, one number each. `axis` is 0
///   for x, 1 for y, 2 for z.
/// - Result: `offsets`, one more than rays. For each interval: the coordinates of its start and its end, on
///   the sides of centres that are stored, as far as there are doubles between two centres; the outward unit
///   normals there, three zeros where none is known; the surfaces there, UINT32_MAX where none is known; the
///   material, 0 where nothing was said. The counts of offsets and intervals.
/// - Errors: LEAFLESS_E_ARGUMENT if the model has no rays along `axis`, `first` lies beyond `end`, or the
///   rays reach beyond the universe; LEAFLESS_E_BUFFER if a capacity is too small: nothing is written then.
/// - Untrusted input: any model, any numbers.
leafless_status leafless_tridexel_copy(const leafless_tridexel *tridexel, uint32_t axis,
    const uint32_t first[2], const uint32_t end[2], uint64_t *offsets, uint64_t offset_capacity,
    uint64_t *offset_count, double *ends_model, double *normals, uint32_t *surfaces, uint32_t *materials,
    uint64_t interval_capacity, uint64_t *interval_count);

/// Where the intervals of many rays along one axis start and end, exactly as it is stored: in finest cells
/// from the universe's lower face, of which the centre of cell k lies at k + 1/2. The intervals are those of
/// leafless_tridexel_copy, in the same order. O(rays + intervals).
///
/// - Buffers: `first` and `end`, 2 numbers each, or NULL both, as leafless_tridexel_copy has them;
///   `ends_cells`, room for 2 numbers for each of `interval_capacity` intervals, or NULL to ask for the count
///   only; `interval_count`, one number. `axis` is 0 for x, 1 for y, 2 for z.
/// - Result: `ends_cells`, 0 to 2^depth; `*interval_count`.
/// - Errors: as leafless_tridexel_copy.
/// - Untrusted input: any model, any numbers.
leafless_status leafless_tridexel_copy_cells(const leafless_tridexel *tridexel, uint32_t axis,
    const uint32_t first[2], const uint32_t end[2], double *ends_cells, uint64_t interval_capacity,
    uint64_t *interval_count);

/// What a set operation makes of tri-dexel models, at least one. Exact: all laws of sets hold. O(rays +
/// intervals · log models), and the same bit for bit for any number of threads. The result stores what any
/// operand does; ends are doubles if those of one operand are. An end keeps its surface and its normal,
/// turned about where a subtraction shows its other side. Where several operands hold a place, the material
/// of the first one counts. Operands are joined two by two: limits of `options` concern each of these steps.
///
/// - Buffers: `tridexels`, `count` handles; `options`, one struct or NULL; `result`, one pointer. `operation`
///   is a leafless_operation.
/// - Result: `*result`, with those of the facts "name" and "units" that all operands have with one value, and
///   no other metadata.
/// - Errors: LEAFLESS_E_FRAME if the frames differ; LEAFLESS_E_NULL, also of an element; LEAFLESS_E_ARGUMENT,
///   also if `count` is 0 or the operands have rays along different axes; LEAFLESS_E_DAMAGED if an operand
///   was mapped unverified and is damaged; LEAFLESS_E_LIMIT, also for 2^32 intervals along one axis;
///   LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the operands stay as they are; give `*result` back with leafless_tridexel_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any models.
leafless_status leafless_tridexel_combine(leafless_operation operation,
    const leafless_tridexel *const *tridexels, uint64_t count, const leafless_options *options,
    leafless_tridexel **result);

/// The points of the universe that do not lie in `tridexel`. O(rays of the universe + intervals).
///
/// - Buffers: `options`, one struct or NULL; `result`, one pointer.
/// - Result: as leafless_tridexel_combine.
/// - Errors: LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT, also for 2^32 rays along one axis; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_tridexel_combine.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any model; set `max_bytes` where its depth is not your own choice.
leafless_status leafless_tridexel_complement(const leafless_tridexel *tridexel,
    const leafless_options *options, leafless_tridexel **result);

/// The same tri-dexel model with other things stored. What `tridexel` does not store is unknown in the
/// result: no surface, no normal, material 0. Doubles become fixed-point numbers and back; an interval that
/// this makes empty is left out.
///
/// - Buffers: `format`, one struct or NULL; `options`, one struct or NULL; `result`, one pointer.
/// - Result: `*result`, with the metadata of `tridexel`.
/// - Errors: LEAFLESS_E_ARGUMENT if a field of `format` is wrong, or `directions` are neither 0 nor those of
///   `tridexel`; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `tridexel` stays as it is; give `*result` back with leafless_tridexel_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any model.
leafless_status leafless_tridexel_with_format(const leafless_tridexel *tridexel,
    const leafless_tridexel_format *format, const leafless_options *options, leafless_tridexel **result);

/// The same tri-dexel model, all of it of one material.
///
/// - Buffers: `options`, one struct or NULL; `result`, one pointer. `material` is any number.
/// - Result: `*result`, which stores materials, with the metadata of `tridexel`.
/// - Errors: LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `tridexel` stays as it is; give `*result` back with leafless_tridexel_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any model, any number.
leafless_status leafless_tridexel_with_material(const leafless_tridexel *tridexel, uint32_t material,
    const leafless_options *options, leafless_tridexel **result);

/// What a change of an editor did to its rays.
///
/// Volumes are sums of the lengths along the rays of one axis, each times the area of a cell's face. So they
/// are estimates, not bounds, and differ from axis to axis by what rays beside each other do not see.
typedef struct leafless_dexel_change {
    uint32_t struct_size;  ///< sizeof(leafless_dexel_change).
    uint64_t rays;  ///< Rays of all directions whose intervals begin or end elsewhere than before.
    /// The volume that the rays along x, y and z lost, in cubic model units; 0 for an axis without rays.
    double removed_model[3];
    double added_model[3];  ///< The volume that the rays along x, y and z gained.
    /// The box of finest cells that the changed parts of rays run through: its first cell.
    uint32_t min_cell[3];
    /// The first cell beyond that box on each axis; both corners are zero if no ray changed.
    uint32_t max_cell[3];
} leafless_dexel_change;

/// A copy of a tri-dexel model that can be changed. O(rays of the universe + intervals).
///
/// - Buffers: `editor`, one pointer.
/// - Result: `*editor`, which stores what `tridexel` does.
/// - Errors: LEAFLESS_E_DAMAGED if the model was mapped unverified and is damaged; LEAFLESS_E_LIMIT for 2^32
///   rays along one axis, which is a depth of 16; LEAFLESS_E_NO_MEMORY.
/// - Ownership: nothing is kept of `tridexel`; give `*editor` back with leafless_tridexel_editor_free.
/// - Untrusted input: any model; memory is needed for each ray of its universe.
leafless_status leafless_tridexel_editor_new(const leafless_tridexel *tridexel,
    leafless_tridexel_editor **editor);

/// Gives back an editor. Tri-dexel models that it froze stay.
///
/// - Buffers: `editor`, a handle or NULL, which does nothing.
/// - Ownership: the handle is gone.
/// - Threads: no other call may use the handle.
void leafless_tridexel_editor_free(leafless_tridexel_editor *editor);

/// What can be said of an editor at once. O(rays of the universe).
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`; `bytes` are those that the editor takes.
/// - Errors: LEAFLESS_E_BUSY.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the editor.
leafless_status leafless_tridexel_editor_describe(const leafless_tridexel_editor *editor,
    leafless_tridexel_info *info);

/// Makes the editor what a set operation makes of it and of a tri-dexel model: LEAFLESS_OPERATION_DIFFERENCE
/// takes the model away. O(rays of the model's window + intervals there), for LEAFLESS_OPERATION_INTERSECTION
/// O(rays of the universe). What the model stores beyond what the editor does is left out.
///
/// - Buffers: `options`, one struct or NULL; `change`, one struct or NULL. `operation` is a
///   leafless_operation.
/// - Result: the editor is changed; `*change`, what was removed and added.
/// - Errors: LEAFLESS_E_FRAME if the frames differ; LEAFLESS_E_ARGUMENT also if the model has rays along
///   other axes; LEAFLESS_E_DAMAGED if the model was mapped unverified and is damaged; LEAFLESS_E_LIMIT for
///   2^32 intervals along one axis; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_BUSY. After
///   LEAFLESS_E_LIMIT, LEAFLESS_E_CANCELLED and LEAFLESS_E_NO_MEMORY some rays may be changed and others not;
///   the same call can be made again, but for LEAFLESS_OPERATION_XOR.
/// - Ownership: nothing is kept of `tridexel`.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the editor; uses the calling thread alone.
/// - Untrusted input: any model.
leafless_status leafless_tridexel_editor_combine(leafless_tridexel_editor *editor,
    leafless_operation operation, const leafless_tridexel *tridexel, const leafless_options *options,
    leafless_dexel_change *change);

/// As leafless_tridexel_editor_combine, with a solid: LEAFLESS_OPERATION_DIFFERENCE is one step of a tool.
/// The solid's intervals are those of leafless_tridexel_build under LEAFLESS_RULE_SAMPLED, in the directions
/// and with the contents of the editor. Only rays through the solid's bounding box are looked at.
///
/// - Buffers: `options`, one struct or NULL; `change`, one struct or NULL. `operation` is a
///   leafless_operation.
/// - Result: the editor is changed; `*change`, what was removed and added.
/// - Errors: as leafless_tridexel_build, and nothing is changed; as leafless_tridexel_editor_combine.
/// - Ownership: nothing is kept of the solid.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the editor; uses as many as `options` says.
/// - Untrusted input: any solid.
leafless_status leafless_tridexel_editor_combine_solid(leafless_tridexel_editor *editor,
    leafless_operation operation, const leafless_solid *solid, const leafless_options *options,
    leafless_dexel_change *change);

/// The tri-dexel model as it is now. O(rays of the universe + intervals). The editor can be changed further.
///
/// - Buffers: `options`, one struct or NULL; `tridexel`, one pointer.
/// - Result: `*tridexel`, without metadata.
/// - Errors: LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_BUSY.
/// - Ownership: the editor stays as it is; give `*tridexel` back with leafless_tridexel_free.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the editor; uses the calling thread alone.
leafless_status leafless_tridexel_editor_freeze(const leafless_tridexel_editor *editor,
    const leafless_options *options, leafless_tridexel **tridexel);

/// How the surface of a tri-dexel model is extracted.
LEAFLESS_ENUM(leafless_dexel_surface_method, uint32_t) {
    /// Marching cubes: a vertex where a ray crosses the surface between two neighbouring centres of cells.
    /// Edges and corners of the solid are cut off by up to a cell.
    LEAFLESS_DEXEL_SURFACE_METHOD_MARCHING_CUBES = 0,
    /// Dual contouring: a vertex for each sheet of the surface in a cube between eight centres, where the
    /// planes at its crossings fit best. Edges and corners of the solid stay, if the model stores normals.
    LEAFLESS_DEXEL_SURFACE_METHOD_DUAL_CONTOURING = 1,
};

/// How exactly a surface of a tri-dexel model follows its rays.
typedef struct leafless_dexel_surface_report {
    uint32_t struct_size;  ///< sizeof(leafless_dexel_surface_report).
    /// Edges between neighbouring centres of cells of which one lies inside: places where a ray crosses the
    /// surface.
    uint64_t crossings;
    /// Crossings on edges that the ray crosses more than once: what is thinner than a cell is lost there.
    uint64_t several;
    /// Crossings that were put in the middle of their edges, because the model has no rays along these.
    uint64_t without_rays;
    /// Crossings that were put in the middle of their edges, because the directions of the model disagree
    /// there.
    uint64_t disagreeing;
    uint64_t without_normals;  ///< Crossings of which no normal is known. (By dual contouring alone.)
    /// Vertices with no normal at any of their crossings, which are the mean of these. (By dual contouring
    /// alone.)
    uint64_t means;
    /// Vertices that would fit their planes better outside of their cells. (By dual contouring alone.)
    uint64_t clamped;
    /// Bodies that the mesh does not show at all: sets of centres of cells that lie inside and hang together
    /// along axes, none of whose crossings has a triangle, because the surface lies nearer to them than
    /// doubles can tell.
    uint64_t vanished;
    /// Intervals in all directions that hold no centre of a cell, those that touch counted as one: what is
    /// thinner than the lattice there is not in the mesh.
    uint64_t without_centres;
} leafless_dexel_surface_report;

/// A row of voxels along y that are all of one kind and of one material.
typedef struct leafless_long_voxel {
    /// Its first voxel. The voxel (x, y, z) lies between the centres of the cells x - 1 and x, and likewise
    /// on the other axes: its indices go from 0 to the cells of an axis, that number included.
    uint32_t first[3];
    uint32_t length;  ///< How many voxels it consists of.
    uint32_t material;  ///< What it is made of; 0 where nothing was said.
    uint8_t colour[4];  ///< The material's colour: red, green, blue and opacity, 0 to 255.
    leafless_voxel_kind kind;  ///< LEAFLESS_VOXEL_KIND_INSIDE or LEAFLESS_VOXEL_KIND_BOUNDARY.
} leafless_long_voxel;

/// The surface of a tri-dexel model: a closed mesh. Samples are the centres of cells; everything outside of
/// the universe is outside.
///
/// Triangles turn counter-clockwise as seen from outside. Every edge belongs to exactly two triangles, but
/// where vertices lie at one place: these are one vertex, and triangles without area are dropped. Where a ray
/// does not tell a crossing, because the model has no rays along an axis or its directions disagree, the
/// crossing lies half-way between the two centres; the report counts such places.
///
/// O(rays + intervals + octree + mesh), with the octree of leafless_octree_from_tridexel.
///
/// - Buffers: `options`, one struct or NULL; `report`, one struct, or NULL if it is not wanted; `mesh`, one
///   pointer. `method` is a leafless_dexel_surface_method.
/// - Result: `*mesh`, the same for any number of threads; it has no triangles if no centre lies inside, or if
///   all bodies vanish. `*report`.
/// - Errors: LEAFLESS_E_ARGUMENT also if the frame lies so far from the origin that doubles cannot tell its
///   cells apart; LEAFLESS_E_MESH if there would be more than 2^32 - 1 vertices or triangles;
///   LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `tridexel` stays as it is; give `*mesh` back with leafless_mesh_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any model; a damaged one is refused (LEAFLESS_E_DAMAGED).
leafless_status leafless_tridexel_surface(const leafless_tridexel *tridexel,
    leafless_dexel_surface_method method, const leafless_options *options,
    leafless_dexel_surface_report *report, leafless_mesh **mesh);

/// The octree of a tri-dexel model: a finest cell is FULL if its centre lies inside, else EMPTY. It proves
/// nothing.
///
/// - Buffers: `options`, one struct or NULL; `octree`, one pointer.
/// - Result: `*octree`, with the model's facts "name" and "units" and no others, and, if the model stores
///   materials, a channel "material" with the number of the material at the centre of each cell (U32); the
///   same for any number of threads.
/// - Errors: LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `tridexel` stays as it is; give `*octree` back with leafless_octree_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any model, of which a damaged one is refused (LEAFLESS_E_DAMAGED); set `max_bytes`
///   where its depth is not your own choice.
leafless_status leafless_octree_from_tridexel(const leafless_tridexel *tridexel,
    const leafless_options *options, leafless_octree **octree);

/// The octree of a tri-dexel model by the ends of its intervals: a finest cell is FULL if all rays through it
/// are inside all the way, EMPTY if all are outside all the way, and PARTIAL if an end lies in it or the
/// directions disagree.
///
/// A decided cell agrees with every ray through it; what is thinner than a cell is undecided where a ray
/// meets it, and not lost. Between the rays nothing is known: the cells prove nothing of the solid that the
/// rays came from, and the volumes of FULL and of PARTIAL cells are no proven bounds.
///
/// - Buffers: `options`, one struct or NULL; `octree`, one pointer.
/// - Result: `*octree`, with facts and a channel as from leafless_octree_from_tridexel.
/// - Errors: LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `tridexel` stays as it is; give `*octree` back with leafless_octree_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any model, of which a damaged one is refused (LEAFLESS_E_DAMAGED); set `max_bytes`
///   where its depth is not your own choice.
leafless_status leafless_octree_from_tridexel_ends(const leafless_tridexel *tridexel,
    const leafless_options *options, leafless_octree **octree);

/// A tri-dexel model as a solid on any frame: the inside of its surface by marching cubes.
///
/// That surface is near the one that the model was made from, not on it. So what is built of the solid proves
/// nothing, and measures of it are not bounded; with `is_truth` the surface is taken for the truth, and both
/// are as of any mesh.
///
/// - Buffers: `options`, one struct or NULL; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: as leafless_tridexel_surface, and LEAFLESS_E_MESH if no centre of a cell lies inside.
/// - Ownership: nothing is kept of `tridexel`; give `*solid` back with leafless_solid_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any model; a damaged one is refused (LEAFLESS_E_DAMAGED).
leafless_status leafless_solid_from_tridexel(const leafless_tridexel *tridexel, bool is_truth,
    const leafless_options *options, leafless_solid **solid);

/// The voxels of a tri-dexel model, whose corners are the centres of cells: a voxel lies inside if all of its
/// eight corners do, outside if none does, and else on the boundary. Those that do not lie outside are merged
/// along y, as far as kind and material are the same. A voxel has the material at its first corner that lies
/// inside, x running fastest and z slowest, and the colour that `colours` has at the place of the material's
/// number; materials beyond are grey (128, 128, 128, 255). Call it once for the count, and then with a
/// buffer.
///
/// O(rays of the window + blocks + rows), for blocks of 64 x 64 x 64 cells in which centres lie inside.
///
/// - Buffers: `options`, one struct or NULL; `colours`, `colour_count` colours of four bytes (red, green,
///   blue, opacity), or NULL for none; `voxels`, room for `capacity` structs, or NULL to ask for the count
///   only; `count`, one number.
/// - Result: `*count`; the rows of voxels by z, then by x, then by y.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any model; a damaged one is refused (LEAFLESS_E_DAMAGED).
leafless_status leafless_tridexel_voxels(const leafless_tridexel *tridexel, const leafless_options *options,
    const uint8_t *colours, uint64_t colour_count, leafless_long_voxel *voxels, uint64_t capacity,
    uint64_t *count);

/* ---- 28. Files of octrees and tri-dexel models -------------------------------------------------------- */

/// Major version of the file format that this library writes, and the only one that it reads.
#define LEAFLESS_FORMAT_MAJOR 0

/// Minor version of the file format that this library writes; it reads newer ones, too.
#define LEAFLESS_FORMAT_MINOR 4

/// What header and section table of a tri-dexel model's file say of it.
typedef struct leafless_file_tridexel_info {
    /// The axes that rays run along, a sum of leafless_axes; 0 if the file holds an octree.
    uint32_t directions;
    leafless_dexel_ends ends;  ///< How the ends of intervals are stored.
    leafless_dexel_normals normals;  ///< How unit normals are stored.
    uint32_t has_surfaces;  ///< 1 if it is stored on which surfaces the ends lie, else 0.
    uint32_t has_materials;  ///< 1 if it is stored what intervals are made of, else 0.
    uint32_t reserved;  ///< Zero.
    uint64_t rays[3];  ///< Rays in the window along each axis, empty ones among them.
    uint64_t intervals[3];  ///< Intervals along each axis.
} leafless_file_tridexel_info;

/// What header and section table of a file say.
typedef struct leafless_file_info {
    uint32_t struct_size;  ///< sizeof(leafless_file_info).
    uint32_t major;  ///< Major version of the format.
    uint32_t minor;  ///< Minor version of the format.
    leafless_frame frame;  ///< Where the octree or the tri-dexel model lies, and its depth.
    uint64_t elements;  ///< Array elements without bricks; 0 for a tri-dexel model.
    uint64_t bricks;  ///< Array elements of the deepest level; 0 for a tri-dexel model.
    uint64_t file_length;  ///< Length of the file in bytes.
    uint64_t sections;  ///< Sections of the file.
    leafless_proof proof;  ///< What the cells prove; nothing for a tri-dexel model.
    leafless_tag root;  ///< The tag of the whole universe; BRANCH if it is cut; EMPTY for a tri-dexel model.
    /// What is known of the space outside of the universe; never BRANCH; EMPTY for a tri-dexel model.
    leafless_tag exterior;
    bool is_binary;  ///< Whether nothing is undecided.
    leafless_file_tridexel_info tridexel;  ///< What is stored of a tri-dexel model; all zeros for an octree.
} leafless_file_info;

/// A section of a file.
typedef struct leafless_file_section {
    uint32_t kind;  ///< Number of its kind.
    uint32_t owner;  ///< The object that it belongs to: 0 is the solid.
    bool is_required;  ///< Whether a reader must know the kind to read the file.
    char name[24];  ///< Name of its kind, NUL-terminated; empty if this library does not know it.
    uint64_t offset;  ///< Where it begins in the file, in bytes.
    uint64_t length;  ///< Its length in bytes.
    uint64_t count;  ///< Its length in elements.
} leafless_file_section;

/// What a file says of itself, without looking at more than header and section table. Whether the rest is
/// good is not known then. Bytes may be the first ones of a file only: 128 and 40 for each section. 488
/// suffice for an octree without channels that this library wrote, 808 for a tri-dexel model, 163 968 for any
/// file.
///
/// - Buffers: `source`, one struct, of which `access` makes no difference; `probe`, one struct; `sections`,
///   room for `capacity` structs, or NULL if they are not wanted.
/// - Result: `*probe`; as many sections as it says.
/// - Errors: LEAFLESS_E_FORMAT, also if bytes end before the section table does; LEAFLESS_E_VERSION;
///   LEAFLESS_E_IO; LEAFLESS_E_BUFFER; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any file, any bytes.
leafless_status leafless_file_describe(const leafless_source *source, leafless_file_info *probe,
    leafless_file_section *sections, uint64_t capacity);

/// Checks everything that the format promises of a whole file, of an octree or of a tri-dexel model: O(n).
/// With LEAFLESS_ACCESS_COPY a file is read into memory, else it is mapped. Bytes are looked at where they
/// lie.
///
/// - Buffers: `source`, one struct; bytes on an address that is a multiple of 8.
/// - Result: LEAFLESS_OK if the file is good.
/// - Errors: LEAFLESS_E_FORMAT; LEAFLESS_E_VERSION; LEAFLESS_E_DAMAGED; LEAFLESS_E_ARGUMENT if the bytes are
///   misaligned, or if there is no regular file that could be mapped; LEAFLESS_E_IO; LEAFLESS_E_UTF8;
///   LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: as leafless_source tells.
leafless_status leafless_file_verify(const leafless_source *source);

/// Reads an octree, with its metadata and channels.
///
/// - Buffers: `source`, one struct; `octree`, one pointer.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_FORMAT; LEAFLESS_E_VERSION; LEAFLESS_E_DAMAGED, with LEAFLESS_ACCESS_MAP only if the
///   level table contradicts the header; LEAFLESS_E_ARGUMENT if the file holds a tri-dexel model, if there is
///   no regular file that could be mapped, or if bytes that shall be viewed are misaligned; LEAFLESS_E_IO;
///   LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: how long a file or bytes must stay as they are, leafless_source tells. Give `*octree` back
///   with leafless_octree_free.
/// - Untrusted input: as leafless_source tells.
leafless_status leafless_octree_read(const leafless_source *source, leafless_octree **octree);

/// Writes an octree's file. Equal octrees with equal metadata and channels give equal bytes. Only for a
/// buffer is the file in memory as a whole.
///
/// - Buffers: `sink`, one struct.
/// - Errors: LEAFLESS_E_DAMAGED if the octree was mapped unverified and is damaged; LEAFLESS_E_IO;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_BUFFER; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree.
leafless_status leafless_octree_write(const leafless_octree *octree, const leafless_sink *sink);

/// Reads a tri-dexel model, with its metadata. Of a file that is damaged where LEAFLESS_ACCESS_MAP does not
/// look, intervals are read as they stand there, in bounds; set algebra, editors and writing check all of it
/// first and return LEAFLESS_E_DAMAGED.
///
/// - Buffers: `source`, one struct; `tridexel`, one pointer.
/// - Result: `*tridexel`.
/// - Errors: LEAFLESS_E_FORMAT; LEAFLESS_E_VERSION; LEAFLESS_E_DAMAGED; LEAFLESS_E_ARGUMENT if the file holds
///   an octree, if there is no regular file that could be mapped, or if bytes that shall be viewed are
///   misaligned; LEAFLESS_E_IO; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: how long a file or bytes must stay as they are, leafless_source tells. Give `*tridexel` back
///   with leafless_tridexel_free.
/// - Untrusted input: as leafless_source tells.
leafless_status leafless_tridexel_read(const leafless_source *source, leafless_tridexel **tridexel);

/// Writes a tri-dexel model's file. Equal models with equal metadata give equal bytes. Only for a buffer is
/// the file in memory as a whole.
///
/// - Buffers: `sink`, one struct.
/// - Errors: LEAFLESS_E_DAMAGED if the model was mapped unverified and is damaged; LEAFLESS_E_IO;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_BUFFER; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any model.
leafless_status leafless_tridexel_write(const leafless_tridexel *tridexel, const leafless_sink *sink);

/* ---- 29. Pictures ------------------------------------------------------------------------------------- */

/// From where a picture is taken. leafless_camera_fitted sets all of it; a host may as well.
typedef struct leafless_camera {
    double eye_model[3];  ///< The point from which one looks.
    double at_model[3];  ///< A point at which one looks, in the middle of the picture.
    double up[3];  ///< The direction that is shown upward, of any length but 0; not along the view.
    /// The field of view in degrees, from the lower to the upper edge of the picture: above 0, below 180.
    /// What is farther away looks smaller. 0: parallel lines stay parallel, and `height_model` counts.
    double field_of_view_degrees;
    double height_model;  ///< With parallel lines the height of what is seen; else not read.
} leafless_camera;

/// A camera that shows all of some points in a picture of width : height = `aspect`, as large as can be with
/// a small margin. Points may be the vertices of a mesh, or the eight corners of a bounding box. It looks at
/// them from an azimuth and an elevation in degrees: 0, 0 is from -y with x to the right and z upward, a
/// positive azimuth from further right, a positive elevation from further above.
///
/// - Buffers: `points_model`, 3 · `count` numbers; `camera`, one struct.
/// - Result: `*camera`. O(count).
/// - Errors: LEAFLESS_E_ARGUMENT if there is no point, a number is not zero and not between 2^-256 and 2^256
///   in magnitude, the field of view neither 0 (parallel lines stay parallel) nor between 0 and 180 degrees,
///   or the aspect not above 0.
/// - Untrusted input: any numbers.
leafless_status leafless_camera_fitted(const double *points_model, uint64_t count, double azimuth_degrees,
    double elevation_degrees, double field_of_view_degrees, double aspect, leafless_camera *camera);

/// Colour maps: equal steps of a number look like equal steps of the colour.
LEAFLESS_ENUM(leafless_colour_map, uint32_t) {
    LEAFLESS_COLOUR_MAP_VIRIDIS = 0,  ///< From dark violet by way of green to yellow.
    LEAFLESS_COLOUR_MAP_CIVIDIS = 1,  ///< From dark blue to yellow; the colour-blind see it as others do.
    LEAFLESS_COLOUR_MAP_INFERNO = 2,  ///< From black by way of red to light yellow.
    LEAFLESS_COLOUR_MAP_MAGMA = 3,  ///< From black by way of purple to near white.
    LEAFLESS_COLOUR_MAP_PLASMA = 4,  ///< From dark blue by way of red to yellow.
    LEAFLESS_COLOUR_MAP_GREY = 5,  ///< From black to white.
};

/// What values look like. A value of one number has the colour of a map over a range. A value of three or
/// four numbers is a colour itself: red, green and blue in sRGB, 0 to 255, and of volumes an opacity, 0 to
/// 255, that scales `alpha_upper`. Of a value of two numbers the first counts. Where there is no value the
/// colour is grey.
///
/// The range must be set, and for volumes the opacity. All other fields but the first may be zero, which is
/// their default.
typedef struct leafless_transfer {
    uint32_t struct_size;  ///< sizeof(leafless_transfer).
    leafless_colour_map map;  ///< A leafless_colour_map.
    double range_lower;  ///< The value at the map's beginning.
    double range_upper;  ///< The value at its end; greater than `range_lower`.
    /// Of volumes: the opacity, 0 to 1, of a path of `length_model` through the value `range_lower`. Between
    /// the two ends it changes linearly.
    double alpha_lower;
    /// The same of `range_upper`, of values that are colours, and of voxels without a value.
    double alpha_upper;
    /// The path for which the opacities hold: what has the opacity a for it lets (1 - a)^(s / length_model)
    /// of the light through a path s. 0: 1.
    double length_model;
} leafless_transfer;

/// The colour of a value under a transfer function, as surfaces show it in full light: for a legend of the
/// host's own.
///
/// - Buffers: `transfer`, one struct; `value`, `components` numbers; `colour`, 4 bytes.
/// - Result: `colour`: red, green and blue (sRGB), and 255. Grey if a number is NaN.
/// - Errors: LEAFLESS_E_ARGUMENT if the transfer function is not as it must be, or `components` not 1 to 4.
/// - Untrusted input: any numbers.
leafless_status leafless_transfer_colour(const leafless_transfer *transfer, const double *value,
    uint32_t components, uint8_t colour[4]);

/// What lies of a layer within planes and a box of its own, which count instead of the picture's: a surface
/// that is cut away, for instance, to show the voxels behind it. A layer that has some already keeps what
/// lies within all of them.
///
/// - Buffers: `planes`, 4 · `plane_count` numbers: a, b, c and d of each plane, which keeps the points with a
///   x + b y + c z + d ≥ 0; `box_model`, 6 numbers, the least and the greatest corner of the box, or NULL for
///   none; `clipped`, one pointer.
/// - Result: `*clipped`.
/// - Errors: LEAFLESS_E_ARGUMENT if a number is not zero and not between 2^-256 and 2^256 in magnitude, a, b
///   and c are zero, or the box is none; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the layer is shared and may be freed; give `*clipped` back with leafless_layer_free.
/// - Untrusted input: any numbers.
leafless_status leafless_layer_clipped(const leafless_layer *layer, const double *planes,
    uint64_t plane_count, const double *box_model, leafless_layer **clipped);

/// About how many bytes of memory (or of mapped files) a layer keeps alive: its own, and those of the octree,
/// solid, mesh and attribute that it shows, as leafless_octree_describe, leafless_solid_describe and so on
/// tell them. What a picture needs while it is rendered is not in.
///
/// - Buffers: `bytes`, one number.
/// - Result: `*bytes`.
/// - Untrusted input: any layer.
leafless_status leafless_layer_bytes(const leafless_layer *layer, uint64_t *bytes);

/// One more reference to a layer.
///
/// - Buffers: `layer`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `layer`.
/// - Ownership: give each reference back with leafless_layer_free.
leafless_status leafless_layer_ref(const leafless_layer *layer, leafless_layer **reference);

/// Gives back a reference to a layer; with the last one the layer is gone. What it shows stays, as far as
/// others have references to it.
///
/// - Buffers: `layer`, a handle or NULL, which does nothing.
/// - Ownership: the reference is gone.
/// - Threads: any; no other call may use this reference.
void leafless_layer_free(leafless_layer *layer);

/// Which edges are drawn as lines.
LEAFLESS_ENUM(leafless_edges, uint32_t) {
    LEAFLESS_EDGES_NONE = 0,  ///< None.
    /// Those at which a mesh ends, or where its triangles meet at more than the crease angle. Of octrees and
    /// solids: silhouettes, and where faces meet at more than that angle.
    LEAFLESS_EDGES_FEATURES = 1,
    LEAFLESS_EDGES_ALL = 2,  ///< Those of all triangles of a mesh.
};

/// What a surface looks like. NULL means the defaults. All fields but the first may be zero, which is their
/// default. A field that a shape does not use must be zero. Colours are red, green and blue (sRGB) and
/// opacity, 0 to 255.
typedef struct leafless_look {
    uint32_t struct_size;  ///< sizeof(leafless_look).
    /// Of octrees: 1 to show cells by their faces, instead of the surface that they stand for; else 0.
    uint32_t faces;
    uint8_t colour[4];  ///< The colour in full light; all zero: light grey.
    /// The colour of what clip planes cut open, and of a mesh's faces that are seen from behind; all zero:
    /// orange, or of a mesh the face's own colour mixed with orange.
    uint8_t inside[4];
    leafless_edges edges;  ///< A leafless_edges.
    uint8_t edge_colour[4];  ///< The colour of edges; all zero: dark grey.
    /// The width of edges in pixels, at most 256, or of octrees and solids 8; 0: 1, or of octrees and solids
    /// 1.5.
    double edge_width;
    /// The angle in degrees, at most 180, at which faces meet at an edge, and up to which neighbouring
    /// triangles of a mesh look smooth; 0: 30.
    double crease_degrees;
    /// Of meshes: 4 · `triangle_count` bytes, a colour for each triangle; NULL: all have one.
    const uint8_t *triangle_colours;
    uint64_t triangle_count;  ///< How many colours of triangles there are.
    /// Of octrees and solids: values, as a channel's, that are shown half a finest cell below the surface, or
    /// of solids half a pixel; optional.
    const leafless_attribute *attribute;
    const leafless_transfer *transfer;  ///< With an attribute: the colours of its values.
} leafless_look;

/// The surface of an octree: along each line of sight the first cell that is not EMPTY. Its normals are those
/// of the surface that the cells seem to stand for. An octree that keeps surfaces is shown as
/// leafless_layer_from_solid shows a solid, unless the look asks for faces of cells: these are its own, so
/// leafless_octree_plain makes smaller ones first.
///
/// - Buffers: `look`, one struct or NULL; `layer`, one pointer.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_ARGUMENT if the look is not as it must be. Of an octree that keeps surfaces, taking a
///   picture also returns what leafless_octree_build does.
/// - Ownership: the layer shares the octree and the attribute, which may be freed; give `*layer` back with
///   leafless_layer_free.
/// - Untrusted input: any octree.
leafless_status leafless_layer_from_octree(const leafless_octree *octree, const leafless_look *look,
    leafless_layer **layer);

/// The surface of a solid within a universe. For each picture the solid is split to cells as large as a
/// pixel, 2^11 to an axis at the most; in these a line of sight meets what the solid knows of its boundary
/// there, with the normals of that.
///
/// - Buffers: `frame`, one struct, of which the depth does not count; `look`, one struct or NULL; `layer`,
///   one pointer.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_ARGUMENT if the look or the frame is not as it must be; taking a picture also returns
///   what leafless_octree_build does.
/// - Ownership: the layer shares the solid and the attribute, which may be freed; give `*layer` back with
///   leafless_layer_free.
/// - Untrusted input: any solid.
leafless_status leafless_layer_from_solid(const leafless_solid *solid, const leafless_frame *frame,
    const leafless_look *look, leafless_layer **layer);

/// The triangles of a mesh.
///
/// - Buffers: `look`, one struct or NULL; `layer`, one pointer.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_ARGUMENT if the look is not as it must be, or there are colours of triangles and not
///   one for each; LEAFLESS_E_NO_MEMORY. Taking a picture returns LEAFLESS_E_ARGUMENT if the width or the
///   crease angle is out of range.
/// - Ownership: the layer shares the mesh, which may be freed, and copies the colours; give `*layer` back
///   with leafless_layer_free.
/// - Untrusted input: any mesh.
leafless_status leafless_layer_from_mesh(const leafless_mesh *mesh, const leafless_look *look,
    leafless_layer **layer);

/// Lines in space, some pixels wide, with round ends. A surface hides what lies behind it; a line on a
/// surface is seen.
///
/// - Buffers: `points_model`, 6 · `count` numbers: the ends of each line; `colour`, 4 numbers: red, green,
///   blue (sRGB) and opacity, or NULL for dark grey; `layer`, one pointer. `width` is in pixels, at most 256;
///   0 means 1.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_NO_MEMORY. Taking a picture returns LEAFLESS_E_ARGUMENT if the width is out of range,
///   or a coordinate not zero and not between 2^-256 and 2^256 in magnitude.
/// - Ownership: the layer copies the lines; give `*layer` back with leafless_layer_free.
/// - Untrusted input: any numbers.
leafless_status leafless_layer_new_lines(const double *points_model, uint64_t count, double width,
    const uint8_t *colour, leafless_layer **layer);

/// The edges of cells as lines. What several cells have in common is drawn once. A cell that is none of the
/// frame is left out. Tags are not read.
///
/// - Buffers: `frame`, one struct; `cells`, `count` structs; `colour`, `width` and `layer` as
///   leafless_layer_new_lines.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check, and as leafless_layer_new_lines;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*layer` back with leafless_layer_free.
/// - Untrusted input: any numbers.
leafless_status leafless_layer_new_cells(const leafless_frame *frame, const leafless_cell *cells,
    uint64_t count, double width, const uint8_t *colour, leafless_layer **layer);

/// What a plane section looks like. NULL means the defaults. All fields but the first may be zero, which is
/// their default. Colours are red, green and blue (sRGB) and opacity, 0 to 255; what is to be invisible is
/// {255, 255, 255, 0}.
typedef struct leafless_slice_look {
    uint32_t struct_size;  ///< sizeof(leafless_slice_look).
    uint32_t is_plain;  ///< 1 to draw no outlines of cells; else 0.
    uint8_t empty_colour[4];  ///< The colour of EMPTY cells; all zero: sky blue, hardly visible.
    uint8_t full_colour[4];  ///< The colour of FULL cells; all zero: blue.
    uint8_t partial_colour[4];  ///< The colour of PARTIAL cells; all zero: orange.
    uint8_t outline_colour[4];  ///< The colour of outlines; all zero: dark grey.
    /// Values, as a channel's, that are shown where cells are not EMPTY; optional.
    const leafless_attribute *attribute;
    const leafless_transfer *transfer;  ///< With an attribute: the colours of its values.
} leafless_slice_look;

/// A plane section of an octree: in the colours of its cells' tags or of an attribute's values, with the
/// outlines of the cells.
///
/// - Buffers: `plane`, 4 numbers a, b, c and d: the plane of the points with a x + b y + c z + d = 0; `look`,
///   one struct or NULL; `layer`, one pointer.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_ARGUMENT if a number is not zero and not between 2^-256 and 2^256 in magnitude, a, b
///   and c are zero, or the look is not as it must be.
/// - Ownership: the layer shares the octree and the attribute, which may be freed; give `*layer` back with
///   leafless_layer_free.
/// - Untrusted input: any octree, any numbers.
leafless_status leafless_layer_from_octree_slice(const leafless_octree *octree, const double plane[4],
    const leafless_slice_look *look, leafless_layer **layer);

/// A plane section of a solid on a frame, of which the cells at the plane are split down to the frame's
/// depth.
///
/// - Buffers: `frame`, one struct; the others as leafless_layer_from_octree_slice.
/// - Result: `*layer`.
/// - Errors: as leafless_layer_from_octree_slice; LEAFLESS_E_ARGUMENT as leafless_frame_check. Taking a
///   picture also returns what leafless_octree_build does.
/// - Ownership: the layer shares the solid and the attribute, which may be freed; give `*layer` back with
///   leafless_layer_free.
/// - Untrusted input: any solid, any numbers.
leafless_status leafless_layer_from_solid_slice(const leafless_solid *solid, const leafless_frame *frame,
    const double plane[4], const leafless_slice_look *look, leafless_layer **layer);

/// Which part of each voxel is solid, 0 to 1: weights of voxels in a picture. Inside voxels have 1, outside
/// and refined ones 0. Of a boundary voxel it is what the solid knows of its volume there, or the middle
/// between what its slabs enclose; 1/2 where the solid knows neither.
///
/// - Buffers: `lattice`, `codes`, `levels` and `kinds` as leafless_voxels_find; `options`, one struct or
///   NULL; `parts`, room for `count` numbers.
/// - Result: `parts`. O(count · levels).
/// - Errors: LEAFLESS_E_ARGUMENT if the arrays are no records; the solid's own; LEAFLESS_E_NO_MEMORY;
///   LEAFLESS_E_CANCELLED.
/// - Untrusted input: any numbers, any solid.
leafless_status leafless_voxels_solid_parts(const leafless_frame *lattice, const uint64_t *codes,
    const uint8_t *levels, const leafless_voxel_kind *kinds, uint64_t count, const leafless_solid *solid,
    const leafless_options *options, double *parts);

/// Voxels in arrays, as leafless_octree_voxels writes them: those of record i at `codes[i]`, `levels[i]`,
/// `kinds[i]`. All fields but the first that are not said to be optional must be set.
typedef struct leafless_voxel_arrays {
    uint32_t struct_size;  ///< sizeof(leafless_voxel_arrays).
    uint32_t components;  ///< How many numbers a value has, 1 to 4; 0 without values.
    leafless_frame lattice;  ///< The lattice that codes belong to.
    uint64_t count;  ///< How many voxels there are.
    const uint64_t *codes;  ///< Linear octree codes, ascending.
    const uint8_t *levels;  ///< Levels.
    /// Of each a leafless_voxel_kind. Inside and boundary voxels are seen.
    const leafless_voxel_kind *kinds;
    /// `components` · `count` numbers, NaN where there is no value; NULL without values.
    const double *values;
    /// Of each voxel the part that is filled, 0 to 1; NULL: 1 inside and 1/2 at the boundary. As
    /// leafless_voxels_solid_parts writes it.
    const double *weights;
} leafless_voxel_arrays;

/// Voxels as a translucent volume, seen in their right order from everywhere; surfaces of other layers hide
/// them, and are seen through them. Of two such layers the one that comes first in a picture is taken to be
/// in front.
///
/// - Buffers: `voxels`, one struct; `transfer`, one struct: what values look like; `layer`, one pointer.
///   `unit_model`: 0 composites by the exact length of each line of sight in a voxel. Else it is done as
///   published (Zhu, Tang and Dong 2002): a voxel is a cell of the edge `unit_model`, repeated as often as
///   its own edge is longer, and the transfer function's opacity holds for one repetition.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_ARGUMENT if the arrays are no records, a weight is not 0 to 1, the transfer function
///   not as it must be, or the unit below 0 or not finite; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the layer copies the arrays; give `*layer` back with leafless_layer_free.
/// - Untrusted input: any numbers.
leafless_status leafless_layer_new_voxels(const leafless_voxel_arrays *voxels,
    const leafless_transfer *transfer, double unit_model, leafless_layer **layer);

/// How a picture is taken. The size and the camera must be set; all other fields but the first may be zero,
/// which is their default.
typedef struct leafless_shot {
    uint32_t struct_size;  ///< sizeof(leafless_shot).
    uint32_t width;  ///< Pixels of a row, 1 to 16384.
    uint32_t height;  ///< Rows, 1 to 16384.
    uint32_t samples;  ///< Samples of a pixel: 1, 4, 9, 16, 25, 36, 49 or 64, on a grid; 0: 4.
    leafless_camera camera;  ///< From where.
    /// 4 · `clip_plane_count` numbers: a, b, c and d of each plane, which cuts away the points with a x + b y
    /// + c z + d < 0.
    const double *clip_planes;
    uint64_t clip_plane_count;  ///< How many clip planes there are.
    /// 6 numbers, the least and the greatest corner of a box outside of which all is cut away; NULL: none.
    const double *clip_box_model;
    /// What is seen where nothing is: red, green, blue (sRGB) and opacity. All zero: nothing, transparent.
    uint8_t background[4];
    uint32_t reserved;  ///< 0.
} leafless_shot;

/// The line of sight of a place in a picture, in pixels from its upper left corner: the middle of the first
/// pixel is 0.5, 0.5. What is seen there at the depth d is at `from_model` + d · `direction`.
///
/// - Buffers: `shot`, one struct; `from_model` and `direction`, 3 numbers each.
/// - Result: `from_model`, the point from which one looks there; `direction`, one long along the view.
/// - Errors: LEAFLESS_E_ARGUMENT if the camera is not as it must be, or the size is none.
/// - Untrusted input: any numbers.
leafless_status leafless_shot_line_of_sight(const leafless_shot *shot, double x, double y,
    double from_model[3], double direction[3]);

/// Takes a picture of layers. Surfaces hide what lies behind them, whichever layer it is of; of two at one
/// depth the first layer's is seen. The same bytes for any number of threads.
///
/// - Buffers: `shot`, one struct; `layers`, `layer_count` handles; `options`, one struct or NULL; `colours`,
///   room for `colour_capacity` bytes, and `depths`, room for `depth_capacity` numbers, each NULL if it is
///   not wanted.
/// - Result: in `colours` 4 · width · height bytes: red, green, blue (sRGB, not multiplied by the opacity)
///   and opacity of each pixel, row by row from the upper left corner without gaps. In `depths` width ·
///   height numbers: the distance from the plane of the eye to what is nearest and opaque, in model units;
///   infinity where nothing is, or farther than a float tells.
/// - Errors: LEAFLESS_E_ARGUMENT if the shot is not as it must be; LEAFLESS_E_BUFFER if a capacity is too
///   small: nothing is written then; what solids and attributes of layers return; LEAFLESS_E_NO_MEMORY;
///   LEAFLESS_E_CANCELLED.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any layers, any numbers.
leafless_status leafless_picture_render(const leafless_shot *shot, const leafless_layer *const *layers,
    uint64_t layer_count, const leafless_options *options, uint8_t *colours, uint64_t colour_capacity,
    float *depths, uint64_t depth_capacity);

/// Writes a picture as a PNG file: without opacity if all pixels are opaque. The same picture makes the same
/// bytes.
///
/// - Buffers: `colours`, 4 · `width` · `height` bytes, as leafless_picture_render writes them; `sink`, one
///   struct.
/// - Errors: LEAFLESS_E_ARGUMENT unless the sides are 1 to 16384 pixels; LEAFLESS_E_IO; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_BUFFER; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any bytes.
leafless_status leafless_picture_write(const uint8_t *colours, uint32_t width, uint32_t height,
    const leafless_sink *sink);

/// At which side of a picture a legend lies.
LEAFLESS_ENUM(leafless_legend_side, uint32_t) {
    LEAFLESS_LEGEND_SIDE_RIGHT = 0,  ///< In the middle of the right side, at most a third of the width.
    LEAFLESS_LEGEND_SIDE_BOTTOM = 1,  ///< In the middle of the lower side, at most a third of the height.
};

/// The part of a picture that a legend covers; all zero if there is none.
typedef struct leafless_legend_box {
    uint32_t left;  ///< Pixels to the left of it.
    uint32_t top;  ///< Rows above it.
    uint32_t width;  ///< Its width in pixels.
    uint32_t height;  ///< Its height in pixels.
} leafless_legend_box;

/// Draws a bar of the colours of values over a transfer function's range into a picture, with a title and
/// numbers, on a light panel. Longer titles than find room are cut.
///
/// - Buffers: `colours`, 4 · `width` · `height` bytes, as leafless_picture_render writes them; `title`,
///   `title_length` bytes of UTF-8; `transfer`, one struct; `covered`, one struct. `side` is a
///   leafless_legend_side.
/// - Result: the picture with the legend; in `*covered` the box that it covers, all zero if the picture is
///   smaller than 160 x 120 pixels, which has no legend.
/// - Errors: LEAFLESS_E_ARGUMENT unless the sides are 1 to 16384 pixels, or if the transfer function is not
///   as it must be; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY. The picture is then as it was.
/// - Untrusted input: any bytes.
leafless_status leafless_picture_draw_bar(uint8_t *colours, uint32_t width, uint32_t height,
    const char *title, size_t title_length, const leafless_transfer *transfer, leafless_legend_side side,
    leafless_legend_box *covered);

/// A colour and what it stands for.
typedef struct leafless_legend_name {
    const char *name;  ///< The name in UTF-8; need not be NUL-terminated.
    size_t name_length;  ///< Its length in bytes.
    uint8_t colour[4];  ///< Red, green, blue (sRGB) and opacity.
    uint32_t reserved;  ///< 0.
} leafless_legend_name;

/// Draws boxes of colours with their names into a picture, under a title, on a light panel. Names that find
/// no room are left out, or cut.
///
/// - Buffers: `colours`, `title`, `side` and `covered` as leafless_picture_draw_bar; `names`, `name_count`
///   structs.
/// - Result: as leafless_picture_draw_bar; no legend either if there is neither a title nor a name.
/// - Errors: as leafless_picture_draw_bar.
/// - Untrusted input: any bytes.
leafless_status leafless_picture_draw_names(uint8_t *colours, uint32_t width, uint32_t height,
    const char *title, size_t title_length, const leafless_legend_name *names, uint64_t name_count,
    leafless_legend_side side, leafless_legend_box *covered);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* LEAFLESS_H */
