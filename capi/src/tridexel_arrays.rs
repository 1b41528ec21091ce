//! Tri-dexel models from the host's arrays.

use super::boundary::{Failure, guard, out, sized, slice};
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame};
use super::status::leafless_status;
use super::tridexel::{give, leafless_tridexel, leafless_tridexel_format};
use core::ops::Range;
use leafless::Frame;
use leafless::TriDexel;
use leafless::dexel::{Dexel, DexelEnd};
use leafless::memory;

/// The intervals of rays along one axis, as written by leafless_tridexel_copy.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_tridexel_arrays {
    /// The axis that the rays run along: 0 for x, 1 for y, 2 for z.
    pub axis: u32,
    /// Reserved; must be 0.
    pub reserved: u32,
    /// The indices of the first ray's cells on the other two axes in the order x, y, z.
    pub first: [u32; 2],
    /// The first indices beyond the last ray. Rays outside the rectangle are empty.
    pub end: [u32; 2],
    /// Offsets, one more than there are rays, ascending: the intervals of ray i are those from `offsets[i]`
    /// up to, but not including, `offsets[i + 1]`. The ray at steps (u, v) from the first has the index i = v
    /// · width + u.
    pub offsets: *const u64,
    /// Number of intervals, which is the last offset.
    pub interval_count: u64,
    /// Two coordinates for each interval, its start and its end. NULL if `ends_cells` gives them.
    pub ends_model: *const f64,
    /// Six numbers for each interval: the outward normals at its start and at its end, of any length; three
    /// zeros for an unknown normal. NULL if no normal is known.
    pub normals: *const f64,
    /// Two numbers for each interval: the surfaces of its start and its end; UINT32_MAX for an unknown
    /// surface. NULL if no surface is known.
    pub surfaces: *const u32,
    /// A number for each interval, its material; 0 if none is given. NULL if no material is given.
    pub materials: *const u32,
    /// Two numbers for each interval: its start and its end in finest cells from the universe's lower face,
    /// as written by leafless_tridexel_copy_cells; the centre of cell k lies at k + 1/2. This number defines
    /// an end if `ends_model` is NULL, or if the coordinate in `ends_model` is the one that
    /// leafless_tridexel_copy would write for it; otherwise the coordinate defines the end. NULL if only
    /// coordinates are given.
    pub ends_cells: *const f64,
}

/// Checked arrays.
struct Arrays<'a> {
    first: [u32; 2],
    end: [u32; 2],
    offsets: &'a [u64],
    frame: &'a Frame,
    axis: usize,
    /// The ends as coordinates, or an empty slice.
    ends: &'a [[f64; 2]],
    /// The ends in cells, or an empty slice.
    cells: &'a [[f64; 2]],
    normals: &'a [[[f64; 3]; 2]],
    surfaces: &'a [[u32; 2]],
    materials: &'a [u32],
}

impl leafless_tridexel_arrays {
    /// # Safety
    /// As [`slice`] for all arrays.
    unsafe fn checked<'a>(&self, frame: &'a Frame) -> Result<Arrays<'a>, Failure> {
        let refused = |name, problem| Err(Failure::Argument { name, problem });
        if self.axis > 2 {
            return refused("rays.axis", "must be 0, 1 or 2");
        }
        if self.reserved != 0 {
            return refused("rays.reserved", "must be zero");
        }
        if (0..2).any(|i| self.first[i] > self.end[i]) {
            return refused("rays.first", "must not lie beyond end");
        }
        if (0..2).any(|i| self.end[i] > frame.cells()) {
            return refused("rays.end", "must not lie beyond the universe");
        }
        let size = [0, 1].map(|i| u64::from(self.end[i] - self.first[i]));
        let count = self.interval_count;
        let optional = |is_null: bool| if is_null { 0 } else { count };
        // (One of the two arrays of ends is required.)
        let ends = if self.ends_cells.is_null() { count } else { optional(self.ends_model.is_null()) };
        // SAFETY: the caller's promise.
        let arrays = unsafe {
            Arrays {
                first: self.first,
                end: self.end,
                offsets: slice(self.offsets, size[0] * size[1] + 1, "rays.offsets")?,
                frame,
                axis: self.axis as usize,
                ends: slice(self.ends_model.cast(), ends, "rays.ends_model")?,
                cells: slice(self.ends_cells.cast(), optional(self.ends_cells.is_null()), "rays.ends_cells")?,
                normals: slice(self.normals.cast(), optional(self.normals.is_null()), "rays.normals")?,
                surfaces: slice(self.surfaces.cast(), optional(self.surfaces.is_null()), "rays.surfaces")?,
                materials: slice(self.materials, optional(self.materials.is_null()), "rays.materials")?,
            }
        };
        if arrays.offsets.first() != Some(&0) || arrays.offsets.last() != Some(&count) {
            return refused("rays.offsets", "must begin with 0 and end with interval_count");
        }
        if arrays.offsets.windows(2).any(|pair| pair[0] > pair[1]) {
            return refused("rays.offsets", "must ascend");
        }
        let most = f64::from(frame.cells());
        if arrays.cells.as_flattened().iter().any(|end| !(0.0..=most).contains(end)) {
            return refused("rays.ends_cells", "must be 0 to 2^depth");
        }
        Ok(arrays)
    }
}

impl Arrays<'_> {
    /// Returns the indices of a ray's intervals.
    fn range(&self, ray: [u32; 2]) -> Range<usize> {
        if (0..2).any(|i| ray[i] < self.first[i] || ray[i] >= self.end[i]) {
            return 0..0;
        }
        let [u, v] = [0, 1].map(|i| (ray[i] - self.first[i]) as usize);
        let index = v * (self.end[0] - self.first[0]) as usize + u;
        // (Offsets ascend, and the last is a length in memory.)
        self.offsets[index] as usize..self.offsets[index + 1] as usize
    }

    fn dexel(&self, index: usize) -> Dexel {
        let end = |k: usize| DexelEnd {
            at: match self.ends.get(index) {
                Some(both) => both[k],
                // (Both numbers were checked.)
                None => DexelEnd::in_cells(self.frame, self.axis, self.cells[index][k])
                    .map_or(f64::NAN, |end| end.at),
            },
            cells: self.cells.get(index).map(|both| both[k]),
            surface: self.surfaces.get(index).map(|both| both[k]).filter(|&surface| surface != u32::MAX),
            normal: self.normals.get(index).map(|both| both[k]).filter(|&normal| normal != [0.0; 3]),
        };
        Dexel { start: end(0), end: end(1), material: self.materials.get(index).copied().unwrap_or_default() }
    }
}

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
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_new(
    frame: *const leafless_frame,
    format: *const leafless_tridexel_format,
    rays: *const leafless_tridexel_arrays,
    count: u64,
    options: *const leafless_options,
    tridexel: *mut *mut leafless_tridexel,
) -> leafless_status {
    guard(|| unsafe {
        let frame = self::frame(frame)?;
        let (directions, format) = sized(format, "format")?.parts()?;
        if !(1..=3).contains(&count) {
            return Err(Failure::Argument { name: "count", problem: "must be 1, 2 or 3" });
        }
        let rays = slice(rays, count, "rays")?;
        let tridexel = out(tridexel, "tridexel")?;
        let mut given: [Option<Arrays<'_>>; 3] = [const { None }; 3];
        for arrays in rays {
            let checked = arrays.checked(&frame)?;
            let place = &mut given[arrays.axis as usize];
            if place.replace(checked).is_some() {
                return Err(Failure::Argument { name: "rays.axis", problem: "must not be that of others" });
            }
        }
        let axes = given.each_ref().map(Option::is_some);
        if directions.is_some_and(|wanted| wanted != axes) {
            return Err(Failure::Argument {
                name: "format.directions",
                problem: "must be 0, or the axes of rays",
            });
        }
        let made = controlled(options, |control| {
            let of_ray = |axis: usize, ray: [u32; 2], list: &mut Vec<Dexel>| {
                if let Some(arrays) = &given[axis] {
                    for index in arrays.range(ray) {
                        memory::push(list, arrays.dexel(index))?;
                    }
                }
                Ok(())
            };
            TriDexel::from_rays(&frame, format, axes, of_ray, control)
        })?;
        tridexel.write(give(made))
    })
}
