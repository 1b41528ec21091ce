//! Reading tri-dexel models: cells, rays, intervals in the host's arrays, statistics.

use super::boundary::{Buffer, Failure, array, buffer, filled, guard, out, output, shared};
use super::status::leafless_status;
use super::tridexel::leafless_tridexel;
use core::ops::Range;
use leafless::TriDexel;
use leafless::dexel::{Dexel, DexelEnd, DexelRays, DexelStatistics};

/// One end of a leafless_dexel.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_dexel_end {
    /// The coordinate along the ray. It is on the stored side of every cell centre, as far as there is a
    /// double between two centres.
    pub at_model: f64,
    /// The same coordinate in finest cells from the universe's lower face, exactly as stored; the centre of
    /// cell k lies at k + 1/2.
    pub at_cells: f64,
    /// The outward unit normal of the surface there; three zeros if it is not known.
    pub normal: [f64; 3],
    /// The source's surface at this end: the triangle of a mesh, or the half-space in the order of the
    /// expanded expression. UINT32_MAX if it is not known.
    pub surface: u32,
}

/// An interval of a ray that lies inside the solid.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_dexel {
    /// The start of the interval.
    pub start: leafless_dexel_end,
    /// The end of the interval, greater than the start.
    pub end: leafless_dexel_end,
    /// The material; 0 if none was given.
    pub material: u32,
}

impl From<&DexelEnd> for leafless_dexel_end {
    fn from(end: &DexelEnd) -> leafless_dexel_end {
        leafless_dexel_end {
            at_model: end.at,
            at_cells: end.cells.unwrap_or(f64::NAN),
            normal: end.normal.unwrap_or_default(),
            surface: end.surface.unwrap_or(u32::MAX),
        }
    }
}

impl From<&Dexel> for leafless_dexel {
    fn from(dexel: &Dexel) -> leafless_dexel {
        leafless_dexel { start: (&dexel.start).into(), end: (&dexel.end).into(), material: dexel.material }
    }
}

/// Statistics of the rays along one axis.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_dexel_statistics {
    /// sizeof(leafless_dexel_statistics).
    pub struct_size: u32,
    /// Number of rays that cross the solid.
    pub rays: u64,
    /// Number of intervals.
    pub intervals: u64,
    /// Bytes of the arrays.
    pub bytes: u64,
    /// Sum of the lengths of all intervals times the area of a cell's face: an estimate of the volume in
    /// cubic model units, not a bound.
    pub volume_model: f64,
    /// The least coordinates of all intervals; INFINITY if there are none.
    pub min_model: [f64; 3],
    /// The greatest coordinates of all intervals; -INFINITY if there are none.
    pub max_model: [f64; 3],
}

output!(leafless_dexel_statistics);

impl From<&DexelStatistics> for leafless_dexel_statistics {
    fn from(found: &DexelStatistics) -> leafless_dexel_statistics {
        leafless_dexel_statistics {
            struct_size: size_of::<leafless_dexel_statistics>() as u32,
            rays: found.rays,
            intervals: found.intervals,
            bytes: found.bytes,
            volume_model: found.volume,
            min_model: found.extent.map(|[least, _]| least),
            max_model: found.extent.map(|[_, most]| most),
        }
    }
}

/// Returns the rays along an axis.
fn rays(model: &TriDexel, axis: u32) -> Result<DexelRays<'_>, Failure> {
    if axis > 2 {
        return Err(Failure::Argument { name: "axis", problem: "must be 0, 1 or 2" });
    }
    let missing = Failure::Argument { name: "axis", problem: "is none that the model has rays along" };
    model.view().rays(axis as usize).ok_or(missing)
}

/// Returns statistics of the rays along an axis. O(n).
///
/// - Buffers: `statistics`, one struct. `axis` is 0 for x, 1 for y, 2 for z.
/// - Result: `*statistics`.
/// - Errors: LEAFLESS_E_ARGUMENT if the model has no rays along `axis`.
/// - Untrusted input: any model, any number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_statistics(
    tridexel: *const leafless_tridexel,
    axis: u32,
    statistics: *mut leafless_dexel_statistics,
) -> leafless_status {
    guard(|| unsafe {
        let model = &shared(tridexel, "tridexel")?.model;
        let axis = rays(model, axis)?.axis();
        let statistics = filled(statistics, "statistics")?;
        let missing = Failure::Argument { name: "axis", problem: "is none that the model has rays along" };
        statistics.write((&model.view().statistics(axis).ok_or(missing)?).into())
    })
}

/// Returns whether the centre of a finest cell lies inside. O(log intervals of a ray).
///
/// - Buffers: `cell`, 3 numbers; `inside`, one truth value.
/// - Result: `*inside`; false if a coordinate is not below 2^depth. Where the directions disagree, as can
///   happen with arrays of other programs, the highest axis decides.
/// - Untrusted input: any model, any numbers.
///
/// cbindgen:ptrs-as-arrays=[[cell; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_contains_cell(
    tridexel: *const leafless_tridexel,
    cell: *const u32,
    inside: *mut bool,
) -> leafless_status {
    guard(|| unsafe {
        let view = shared(tridexel, "tridexel")?.model.view();
        let cell: [u32; 3] = array(cell, "cell")?;
        let inside = out(inside, "inside")?;
        let within = cell.iter().all(|&at| at < view.frame().cells());
        inside.write(within && view.contains_cell(cell))
    })
}

/// Returns the window: the smallest rectangle of rays along an axis that contains all rays that cross the
/// solid.
///
/// - Buffers: `first` and `end`, 2 numbers each: the indices of the first ray's cells on the other two axes
///   in the order x, y, z, and the first indices beyond the last ray. `axis` is 0 for x, 1 for y, 2 for z.
/// - Result: `first` and `end`; equal to each other if no ray crosses the solid.
/// - Errors: LEAFLESS_E_ARGUMENT if the model has no rays along `axis`.
/// - Untrusted input: any model, any number.
///
/// cbindgen:ptrs-as-arrays=[[first; 2], [end; 2]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_window(
    tridexel: *const leafless_tridexel,
    axis: u32,
    first: *mut u32,
    end: *mut u32,
) -> leafless_status {
    guard(|| unsafe {
        let window = rays(&shared(tridexel, "tridexel")?.model, axis)?.window();
        let (first, end) = (out(first.cast(), "first")?, out(end.cast(), "end")?);
        first.write([window[0].start, window[1].start])?;
        end.write([window[0].end, window[1].end])
    })
}

/// Returns the intervals of one ray, in ascending order.
///
/// - Buffers: `ray`, 2 numbers, the indices of the ray's cells on the other two axes in the order x, y, z;
///   `dexels`, room for `capacity` structs, or NULL to get only the count; `count`, one number. `axis` is 0
///   for x, 1 for y, 2 for z.
/// - Result: `*count`; the intervals. A ray outside the universe has none.
/// - Errors: LEAFLESS_E_ARGUMENT if the model has no rays along `axis`; LEAFLESS_E_BUFFER if the capacity is
///   too small.
/// - Untrusted input: any model, any numbers.
///
/// cbindgen:ptrs-as-arrays=[[ray; 2]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_ray(
    tridexel: *const leafless_tridexel,
    axis: u32,
    ray: *const u32,
    dexels: *mut leafless_dexel,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let rays = rays(&shared(tridexel, "tridexel")?.model, axis)?;
        let ray = array(ray, "ray")?;
        let (to, count) = (buffer(dexels, capacity, "dexels")?, out(count, "count")?);
        let found = rays.dexels(ray);
        let number = found.len();
        to.check(number)?;
        if to.wanted() {
            for (index, dexel) in found.enumerate() {
                to.put(index, (&dexel).into());
            }
        }
        count.write(number as u64)
    })
}

/// Returns the rays in a rectangle with these corners, or in the window.
///
/// # Safety
/// As [`array`] for a corner that is not NULL.
unsafe fn rectangle(
    model: &TriDexel,
    rays: &DexelRays<'_>,
    first: *const u32,
    end: *const u32,
) -> Result<[Range<u32>; 2], Failure> {
    // A rectangle needs both of its corners.
    if first.is_null() && end.is_null() {
        return Ok(rays.window());
    }
    // SAFETY: the caller's promise.
    let (first, end): ([u32; 2], [u32; 2]) = unsafe { (array(first, "first")?, array(end, "end")?) };
    if (0..2).any(|i| first[i] > end[i]) {
        return Err(Failure::Argument { name: "first", problem: "must not lie beyond end" });
    }
    if (0..2).any(|i| end[i] > model.frame().cells()) {
        return Err(Failure::Argument { name: "end", problem: "must not lie beyond the universe" });
    }
    Ok([first[0]..end[0], first[1]..end[1]])
}

/// Arrays of the host for intervals, each of which may be absent.
struct Arrays {
    ends: Buffer<[f64; 2]>,
    normals: Buffer<[[f64; 3]; 2]>,
    surfaces: Buffer<[u32; 2]>,
    materials: Buffer<u32>,
}

impl Arrays {
    fn check(&self, count: usize) -> Result<(), Failure> {
        self.ends.check(count)?;
        self.normals.check(count)?;
        self.surfaces.check(count)?;
        self.materials.check(count)
    }

    fn wanted(&self) -> bool {
        self.ends.wanted() || self.normals.wanted() || self.surfaces.wanted() || self.materials.wanted()
    }

    fn put(&self, index: usize, dexel: &Dexel) {
        let both = [dexel.start, dexel.end];
        self.ends.put(index, both.map(|end| end.at));
        self.normals.put(index, both.map(|end| end.normal.unwrap_or_default()));
        self.surfaces.put(index, both.map(|end| end.surface.unwrap_or(u32::MAX)));
        self.materials.put(index, dexel.material);
    }
}

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
///
/// cbindgen:ptrs-as-arrays=[[first; 2], [end; 2]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_copy(
    tridexel: *const leafless_tridexel,
    axis: u32,
    first: *const u32,
    end: *const u32,
    offsets: *mut u64,
    offset_capacity: u64,
    offset_count: *mut u64,
    ends_model: *mut f64,
    normals: *mut f64,
    surfaces: *mut u32,
    materials: *mut u32,
    interval_capacity: u64,
    interval_count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let model = &shared(tridexel, "tridexel")?.model;
        let rays = rays(model, axis)?;
        let [columns, rows] = rectangle(model, &rays, first, end)?;
        let offsets = buffer(offsets, offset_capacity, "offsets")?;
        // An absent array has no elements, whatever the capacity of the others.
        let capacity = |is_null: bool| if is_null { 0 } else { interval_capacity };
        let arrays = Arrays {
            ends: buffer(ends_model.cast(), capacity(ends_model.is_null()), "ends_model")?,
            normals: buffer(normals.cast(), capacity(normals.is_null()), "normals")?,
            surfaces: buffer(surfaces.cast(), capacity(surfaces.is_null()), "surfaces")?,
            materials: buffer(materials, capacity(materials.is_null()), "materials")?,
        };
        let (offset_count, interval_count) =
            (out(offset_count, "offset_count")?, out(interval_count, "interval_count")?);
        let each_ray = || rows.clone().flat_map(|v| columns.clone().map(move |u| [u, v]));
        // At most 2^40 rays, each of at most 2^32 intervals.
        let ray_count = columns.len() as u64 * rows.len() as u64;
        let number: u64 = each_ray().map(|ray| rays.dexels(ray).len() as u64).sum();
        offsets.check(usize::try_from(ray_count + 1).unwrap_or(usize::MAX))?;
        arrays.check(usize::try_from(number).unwrap_or(usize::MAX))?;
        if offsets.wanted() || arrays.wanted() {
            let mut index = 0;
            for (i, ray) in each_ray().enumerate() {
                offsets.put(i, index as u64);
                let found = rays.dexels(ray);
                if arrays.wanted() {
                    found.enumerate().for_each(|(k, dexel)| arrays.put(index + k, &dexel));
                }
                index += rays.dexels(ray).len();
            }
            offsets.put(ray_count as usize, index as u64);
        }
        offset_count.write(ray_count + 1)?;
        interval_count.write(number)
    })
}

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
///
/// cbindgen:ptrs-as-arrays=[[first; 2], [end; 2]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_copy_cells(
    tridexel: *const leafless_tridexel,
    axis: u32,
    first: *const u32,
    end: *const u32,
    ends_cells: *mut f64,
    interval_capacity: u64,
    interval_count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let model = &shared(tridexel, "tridexel")?.model;
        let rays = rays(model, axis)?;
        let [columns, rows] = rectangle(model, &rays, first, end)?;
        let ends = buffer::<[f64; 2]>(ends_cells.cast(), interval_capacity, "ends_cells")?;
        let interval_count = out(interval_count, "interval_count")?;
        let each_ray = || rows.clone().flat_map(|v| columns.clone().map(move |u| [u, v]));
        let number: u64 = each_ray().map(|ray| rays.dexels(ray).len() as u64).sum();
        ends.check(usize::try_from(number).unwrap_or(usize::MAX))?;
        if ends.wanted() {
            for (index, dexel) in each_ray().flat_map(|ray| rays.dexels(ray)).enumerate() {
                ends.put(index, [dexel.start, dexel.end].map(|end| end.cells.unwrap_or(f64::NAN)));
            }
        }
        interval_count.write(number)
    })
}
