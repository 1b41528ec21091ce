//! What tri-dexel models hold: cells, rays, intervals in the host's arrays, statistics.

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
    /// The coordinate along the ray. It lies on the side of every centre of a cell that is stored, as far as
    /// there is a double between two centres.
    pub at_model: f64,
    /// The same in finest cells from the universe's lower face, exactly as it is stored; the centre of cell k
    /// lies at k + 1/2.
    pub at_cells: f64,
    /// The outward unit normal of the surface there; three zeros if it is not known.
    pub normal: [f64; 3],
    /// On which of the source's surfaces it lies: a triangle of a mesh, a half-space in the order of the
    /// expression written out. UINT32_MAX if it is not known.
    pub surface: u32,
}

/// An interval of a ray that lies inside the solid.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_dexel {
    /// Where it begins.
    pub start: leafless_dexel_end,
    /// Where it ends, which is behind its start.
    pub end: leafless_dexel_end,
    /// What it is made of; 0 where nothing was said.
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

/// What the rays along one axis hold.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_dexel_statistics {
    /// sizeof(leafless_dexel_statistics).
    pub struct_size: u32,
    /// Rays that cross the solid.
    pub rays: u64,
    /// Intervals.
    pub intervals: u64,
    /// Bytes of the arrays.
    pub bytes: u64,
    /// The lengths of all intervals, each times the area of a cell's face: an estimate of the volume in cubic
    /// model units, no bound.
    pub volume_model: f64,
    /// The least coordinates of what the rays cross; INFINITY if they cross nothing.
    pub min_model: [f64; 3],
    /// The greatest coordinates of what the rays cross; -INFINITY if they cross nothing.
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

/// The rays along an axis.
fn rays(model: &TriDexel, axis: u32) -> Result<DexelRays<'_>, Failure> {
    if axis > 2 {
        return Err(Failure::Argument { name: "axis", problem: "must be 0, 1 or 2" });
    }
    let missing = Failure::Argument { name: "axis", problem: "is none that the model has rays along" };
    model.view().rays(axis as usize).ok_or(missing)
}

/// What the rays along an axis hold. O(n).
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

/// Whether the centre of a finest cell lies inside. O(log intervals of a ray).
///
/// - Buffers: `cell`, 3 numbers; `inside`, one truth value.
/// - Result: `*inside`; false if a coordinate is not below 2^depth. Where the directions differ, as those of
///   arrays from elsewhere may, the highest axis decides.
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

/// The smallest rectangle of rays along an axis that holds all rays that cross the solid.
///
/// - Buffers: `first` and `end`, 2 numbers each: the indices of the first ray's cells on the other two axes
///   in the order x, y, z, and the first beyond the last one's. `axis` is 0 for x, 1 for y, 2 for z.
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

/// The intervals of one ray, in ascending order.
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

/// The rays in a rectangle with these corners, or in the window.
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
        // An array that is absent has no elements, whatever the others have.
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

/// Where the intervals of many rays along one axis start and end, exactly as it is stored: in finest cells
/// from the universe's lower face, of which the centre of cell k lies at k + 1/2. The intervals are those of
/// leafless_tridexel_copy, in the same order. O(rays + intervals).
///
/// - Buffers: `first` and `end`, 2 numbers each, or NULL both, as leafless_tridexel_copy has them;
///   `ends_cells`, room for 2 numbers for each of `interval_capacity` intervals, or NULL to get only the
///   count; `interval_count`, one number. `axis` is 0 for x, 1 for y, 2 for z.
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
