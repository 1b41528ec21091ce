//! Frames: the position, the size and the resolution of a tree in model space.

use super::boundary::{Failure, array, guard, out, shared};
use super::status::leafless_status;
use leafless::Error;
use leafless::{Frame, Interval};

/// The lattice of a tree: the cube [origin, origin + edge]³ in model units, cut into 2^depth cells per axis.
///
/// A coordinate of the origin is 0 or of a magnitude between 2^-256 and 2^256, the edge between 2^-256 and
/// 2^256, the depth 1 to 20. The lattice planes are the real numbers origin + i·edge/2^depth, whether or not
/// doubles can represent them: comparisons with them are exact.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_frame {
    /// Lower corner of the universe.
    pub origin: [f64; 3],
    /// Edge length of the universe.
    pub edge: f64,
    /// Levels below the universe.
    pub depth: u32,
}

impl From<&Frame> for leafless_frame {
    fn from(frame: &Frame) -> leafless_frame {
        leafless_frame { origin: frame.origin(), edge: frame.edge(), depth: frame.depth() as u32 }
    }
}

/// A depth that is out of range stays out of range.
fn depth(depth: u32) -> u8 {
    u8::try_from(depth).unwrap_or(u8::MAX)
}

/// The frame at `pointer`, the parameter `frame`.
///
/// # Safety
/// As [`shared`].
pub(super) unsafe fn frame(pointer: *const leafless_frame) -> Result<Frame, Failure> {
    // SAFETY: the caller's promise.
    unsafe { frame_of(pointer, "frame") }
}

/// The frame at `pointer`.
///
/// # Safety
/// As [`shared`].
pub(super) unsafe fn frame_of(pointer: *const leafless_frame, name: &'static str) -> Result<Frame, Failure> {
    // SAFETY: the caller's promise.
    let frame = unsafe { shared(pointer, name)? };
    Ok(Frame::new(frame.origin, frame.edge, depth(frame.depth))?)
}

/// An interval that contains the truth: lower ≤ truth ≤ upper.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_interval {
    /// Proven lower bound.
    pub lower: f64,
    /// Proven upper bound.
    pub upper: f64,
}

impl leafless_interval {
    /// Returns the interval that a host means. Bounds in the wrong order, or that are not numbers, mean the
    /// interval of all numbers.
    pub(super) fn known(self) -> Interval {
        Interval::new(self.lower, self.upper).unwrap_or(Interval::ALL)
    }
}

impl From<Interval> for leafless_interval {
    fn from(interval: Interval) -> leafless_interval {
        leafless_interval { lower: interval.lower, upper: interval.upper }
    }
}

impl From<&Interval> for leafless_interval {
    fn from(interval: &Interval) -> leafless_interval {
        leafless_interval::from(*interval)
    }
}

/// Checks a frame's fields.
///
/// - Buffers: `frame`, one struct.
/// - Result: LEAFLESS_OK if the frame can be used.
/// - Errors: LEAFLESS_E_ARGUMENT, with the field that is out of range in the message.
/// - Untrusted input: any values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_frame_check(frame: *const leafless_frame) -> leafless_status {
    guard(|| unsafe { self::frame(frame).map(|_| ()) })
}

/// Writes the frame that `make` makes of the corners of a box.
///
/// # Safety
/// As [`array`] for the corners and [`out`] for the frame.
unsafe fn around(
    min_model: *const f64,
    max_model: *const f64,
    frame: *mut leafless_frame,
    make: impl FnOnce([f64; 3], [f64; 3]) -> Result<Frame, Error>,
) -> Result<(), Failure> {
    // SAFETY: the caller's promise.
    unsafe {
        let (min, max) = (array(min_model, "min_model")?, array(max_model, "max_model")?);
        out(frame, "frame")?.write((&make(min, max)?).into())
    }
}

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
///
/// cbindgen:ptrs-as-arrays=[[min_model; 3], [max_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_frame_around(
    min_model: *const f64,
    max_model: *const f64,
    depth: u32,
    frame: *mut leafless_frame,
) -> leafless_status {
    guard(|| unsafe {
        around(min_model, max_model, frame, |min, max| Frame::around(min, max, self::depth(depth)))
    })
}

/// Makes the frame of leafless_frame_around whose finest cells are no longer than a tolerance. The tolerance
/// is the greater of a length and a fraction of the longest extent. The depth is the least one that suffices;
/// it is 20 if no depth suffices, and for tolerances of 0.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `frame`, one struct.
/// - Result: `*frame`.
/// - Errors: as leafless_frame_around; LEAFLESS_E_ARGUMENT if a tolerance is negative or no number.
/// - Untrusted input: any values.
///
/// cbindgen:ptrs-as-arrays=[[min_model; 3], [max_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_frame_to_tolerance(
    min_model: *const f64,
    max_model: *const f64,
    tolerance_model: f64,
    relative: f64,
    frame: *mut leafless_frame,
) -> leafless_status {
    guard(|| unsafe {
        around(min_model, max_model, frame, |min, max| {
            Frame::to_tolerance(min, max, tolerance_model, relative)
        })
    })
}

/// Makes a frame whose lattice planes are round numbers, around a shape with these bounds. Its edge is the
/// smallest power of two that holds the bounds; its origin is a multiple of the largest possible power of
/// two. Faces at 25, 12.5 or -0.75 then lie on lattice planes, where they take no cells and the certified
/// volume is exact. The universe is the same at every depth.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `frame`, one struct.
/// - Result: `*frame`.
/// - Errors: as leafless_frame_around.
/// - Untrusted input: any values.
///
/// cbindgen:ptrs-as-arrays=[[min_model; 3], [max_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_frame_aligned(
    min_model: *const f64,
    max_model: *const f64,
    depth: u32,
    frame: *mut leafless_frame,
) -> leafless_status {
    guard(|| unsafe {
        around(min_model, max_model, frame, |min, max| Frame::aligned(min, max, self::depth(depth)))
    })
}

/// Makes a frame with cells of a given size around a shape with these bounds. Its depth is the least one that
/// holds the bounds. Its origin is a multiple of the cell size times the largest possible power of two.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `frame`, one struct.
/// - Result: `*frame`.
/// - Errors: as leafless_frame_around; LEAFLESS_E_ARGUMENT also if `cell_size_model` is not 2^-256 to 2^256,
///   or if the bounds take more than 2^20 cells on an axis.
/// - Untrusted input: any values.
///
/// cbindgen:ptrs-as-arrays=[[min_model; 3], [max_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_frame_with_cells(
    min_model: *const f64,
    max_model: *const f64,
    cell_size_model: f64,
    frame: *mut leafless_frame,
) -> leafless_status {
    guard(|| unsafe {
        around(min_model, max_model, frame, |min, max| Frame::with_cells(min, max, cell_size_model))
    })
}

/// Makes the frame that suits a shape with these bounds: leafless_frame_aligned if all bounds are multiples
/// of 2^-12 of its edge, as for parts drawn with round dimensions, else leafless_frame_around. The universe
/// is the same at every depth.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `frame`, one struct.
/// - Result: `*frame`.
/// - Errors: as leafless_frame_around.
/// - Untrusted input: any values.
///
/// cbindgen:ptrs-as-arrays=[[min_model; 3], [max_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_frame_fitted(
    min_model: *const f64,
    max_model: *const f64,
    depth: u32,
    frame: *mut leafless_frame,
) -> leafless_status {
    guard(|| unsafe {
        around(min_model, max_model, frame, |min, max| Frame::fitted(min, max, self::depth(depth)))
    })
}

/// Returns the edge length of a finest cell: edge / 2^depth, exactly.
///
/// - Buffers: `frame`, one struct; `cell_size_model`, one number.
/// - Result: `*cell_size_model`, in model units.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check.
/// - Untrusted input: any values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_frame_cell_size(
    frame: *const leafless_frame,
    cell_size_model: *mut f64,
) -> leafless_status {
    guard(|| unsafe {
        let frame = self::frame(frame)?;
        out(cell_size_model, "cell_size_model")?.write(frame.cell_size())
    })
}

/// Returns the finest cell that contains a point. A point on a plane between two cells belongs to the upper
/// cell; a point on the universe's upper face belongs to the last cell. The comparison is exact.
///
/// - Buffers: `frame`, one struct; `point_model`, 3 numbers; `cell`, room for 3.
/// - Result: `cell`, each below 2^depth.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check, and if the point is outside the universe or not a
///   number.
/// - Untrusted input: any values.
///
/// cbindgen:ptrs-as-arrays=[[point_model; 3], [cell; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_frame_cell_at(
    frame: *const leafless_frame,
    point_model: *const f64,
    cell: *mut u32,
) -> leafless_status {
    guard(|| unsafe {
        let frame = self::frame(frame)?;
        let point = array(point_model, "point_model")?;
        let cell = out(cell.cast::<[u32; 3]>(), "cell")?;
        let problem = "lies outside of the universe, or is not a number";
        cell.write(frame.cell_of(point).ok_or(Failure::Argument { name: "point_model", problem })?)
    })
}

/// Returns the position of a lattice plane: the tightest interval of doubles that contains it.
///
/// - Buffers: `frame`, one struct; `plane_model`, one struct.
/// - Result: `*plane_model`; lower = upper if the position is a double.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check, if `axis` is not 0 to 2, or `index` beyond 2^depth.
/// - Untrusted input: any values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_frame_plane(
    frame: *const leafless_frame,
    axis: u32,
    index: u32,
    plane_model: *mut leafless_interval,
) -> leafless_status {
    guard(|| unsafe {
        let frame = self::frame(frame)?;
        let plane = out(plane_model, "plane_model")?;
        if axis > 2 {
            return Err(Failure::Argument { name: "axis", problem: "must be 0, 1 or 2" });
        }
        if index > frame.cells() {
            return Err(Failure::Argument { name: "index", problem: "must be 0 to 2^depth" });
        }
        plane.write(frame.plane(axis as usize, index).into())
    })
}
