//! Bitmaps of the cells in a box.

use super::boundary::{array, buffer, guard, out, shared};
use super::control::{controlled, leafless_options};
use super::octree::leafless_octree;
use super::status::leafless_status;

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
///
/// cbindgen:ptrs-as-arrays=[[min_cell; 3], [max_cell; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_bitmap(
    octree: *const leafless_octree,
    level: u32,
    min_cell: *const u32,
    max_cell: *const u32,
    options: *const leafless_options,
    inner: *mut u64,
    outer: *mut u64,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let octree = shared(octree, "octree")?.octree.view();
        let (min, max) = (array(min_cell, "min_cell")?, array(max_cell, "max_cell")?);
        let inner = buffer(inner, capacity, "inner")?;
        let outer = buffer(outer, if outer.is_null() { 0 } else { capacity }, "outer")?;
        let count = out(count, "count")?;
        let level = u8::try_from(level).unwrap_or(u8::MAX);
        let words = octree.bitmap_words(level, min, max)?;
        // A count that does not fit into the address space does not fit into a buffer either.
        let needed = usize::try_from(words).unwrap_or(usize::MAX);
        outer.check(needed)?;
        if let Some(inner) = inner.zeroed(needed)? {
            let outer = outer.zeroed(needed)?;
            controlled(options, |control| octree.bitmap(level, min, max, inner, outer, control))?;
        }
        count.write(words)
    })
}
