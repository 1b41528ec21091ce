/*
 * Leafless: a solid-modelling kernel on leaf-free octrees.
 *
 * Generated from the sources by cbindgen; do not edit. SPDX-License-Identifier: MIT OR Apache-2.0
 *
 * What holds for all functions:
 *
 * - A function that can fail returns a leafless_status. LEAFLESS_OK is 0. leafless_last_error has the message of
 *   the last failure in the calling thread.
 * - Results are written to the last parameters, and only on success: after a failure they are as they were, but for
 *   the contents of buffers. No parameter is both read and written.
 * - General errors, which the functions do not list again: LEAFLESS_E_NULL if a pointer is NULL that the function
 *   does not say may be; LEAFLESS_E_ARGUMENT if one is misaligned for what it points to, if a count is more than
 *   memory can hold, a number none of its enum, a path empty, or a struct_size not sensible or with fields set that
 *   this library does not know; LEAFLESS_E_PANIC if the library has a defect. That never ends the host program and
 *   leaves all objects usable, but a leafless_tridexel_editor that it was changing; Rust's message about it also goes to
 *   stderr.
 * - Memory whose size depends on an input or a result can be refused, and is then LEAFLESS_E_NO_MEMORY. What remains
 *   is at most 2 KiB a piece, what threads cost, and what polygons with holes or dents are triangulated with, for which
 *   as much was asked for, and given back, before; if even that cannot be had, the process ends.
 * - Objects are opaque handles. What _new, _open and the like return is a reference; _ref gives one more; _free
 *   gives one back, and takes NULL. References may be given back in any order: what an object needs of another it
 *   shares. Pointers from _peek functions belong to the object.
 * - Threads: calls whose handle parameters are pointers to const may run at once, on the same object too. Other
 *   calls need the object for themselves; but _free needs only its own reference, others may be in use meanwhile.
 *   A leafless_lazy or a leafless_tridexel_editor that is in use says so itself: LEAFLESS_E_BUSY.
 *   Different objects never interfere. Nothing global is changed. No thread of the library outlives the call that
 *   started it.
 * - Structs with a field struct_size begin with sizeof of themselves, and all their other fields may be zero.
 *   Programs that were compiled with an older, shorter struct go on working.
 *   Other structs are fixed for one LEAFLESS_ABI.
 * - Numbers for which there is an enum come in as uint32_t and are checked. As types of your own variables write
 *   leafless_tag, not enum leafless_tag: in C only the former has the size that the library writes.
 * - Lengths of texts and structs are size_t, all other lengths and counts uint64_t.
 * - Texts are UTF-8 of a given length in bytes, and may be NULL if it is 0; paths are, too, on every platform, but
 *   never empty.
 * - Coordinates whose names end in _model are in model units, those in _cells in finest cells. "3 numbers" are x, y
 *   and z.
 * - Buffers that are not known to be large enough are filled in two steps: with a NULL buffer and the capacity 0 the
 *   function tells the number of elements, then it fills. Capacities count elements.
 * - Buffers and results of one call must not overlap.
 * - Functions of the host get their context first, return 0 to go on, and must not throw or longjmp through the
 *   library.
 *
 * The doc block of a function says, in this order: what it is for, which buffers it needs, what it results in, its
 * errors, who owns what, in which threads it may run, what it makes of untrusted input, and since which version of
 * the library it exists. Before version 0.1 all of it may still change.
 */
