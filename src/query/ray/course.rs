//! A ray in lattice coordinates, in doubles whose errors are bounded.

use super::Ray;
use crate::lattice::Each;
use crate::lattice::Frame;
use crate::lattice::axes;
use crate::lattice::morton::SLABS;
use wide::f64x4;

/// A ray in lattice coordinates, mirrored so that no coordinate decreases, in doubles with bounds of their
/// errors. The fourth coordinate fills a register: the ray does not move along it.
#[derive(Clone, Copy)]
pub(super) struct Course {
    /// The start of the ray.
    pub(super) from: [f64; 4],
    /// The speed, in cells for a unit of t.
    pub(super) speed: [f64; 4],
    /// The slowness, in units of t for a cell.
    pub(super) slowness: [f64; 4],
    /// A bound of the error of a coordinate at an exact t.
    place_error: [f64; 4],
    /// A bound of the error of the t at which a plane of the universe is passed.
    pub(super) time_error: [f64; 4],
    /// An exclusive or with this mirrors the coordinate of a cell.
    pub(super) mirror: [u32; 4],
}

/// A bound of all relative rounding errors of a coordinate together. Each error is 2^-53, and none counts
/// more than twice. The errors are relative to the universe and the ray's start.
const ERROR: f64 = 1.0 / (1u64 << 48) as f64;

/// Adding this constant leaves the nearest integer in the low bits.
const ROUND: f64 = (3u64 << 51) as f64;

impl Course {
    #[inline(always)]
    pub(super) fn new(frame: &Frame, ray: &Ray) -> Course {
        let cells = frame.cells() as f64;
        // Along the fourth axis, the ray stays in the middle of cell 0.
        let mut course = Course {
            from: [0.5; 4],
            speed: [0.0; 4],
            slowness: [NEVER; 4],
            place_error: [0.0; 4],
            time_error: [0.0; 4],
            mirror: [0; 4],
        };
        for axis in 0..3 {
            let direction = ray.direction[axis][0];
            let from = frame.scaled(axis, ray.from[axis]);
            let falls = direction < 0.0;
            course.from[axis] = if falls { cells - from } else { from };
            course.mirror[axis] = if falls { frame.cells() - 1 } else { 0 };
            course.speed[axis] = frame.scaled_length(direction.abs());
            course.place_error[axis] = (from.abs() + cells) * ERROR;
            let still = direction == 0.0;
            // A ray that does not move along an axis passes its planes in the far past and the far future.
            course.slowness[axis] = if still { NEVER } else { 1.0 / course.speed[axis] };
            course.time_error[axis] =
                if still { 0.0 } else { course.place_error[axis] * course.slowness[axis] };
        }
        course
    }

    /// Returns the cells of an element that a ray in one of them may still meet; the cells have an edge of
    /// 2^shift.
    #[inline(always)]
    pub(super) fn ahead(&self, place: [u32; 4], shift: u32) -> u64 {
        let [x, y, z] = axes(|axis| {
            let k = (place[axis] >> shift & 3) as usize;
            if self.falls(axis) { SLABS[axis][0][k] } else { SLABS[axis][k][3] }
        });
        x & y & z
    }

    /// True if the ray was mirrored along an axis.
    #[inline(always)]
    pub(super) fn falls(&self, axis: usize) -> bool {
        self.mirror[axis] != 0
    }

    /// Returns the time at which the ray passes a plane of an axis.
    #[inline(always)]
    pub(super) fn time(&self, axis: usize, plane: u32) -> f64 {
        (plane as f64 - self.from[axis]) * self.slowness[axis]
    }

    /// Returns the coordinate of the ray's cell at a time with this error, and whether the coordinate is
    /// certain in spite of rounding errors.
    #[inline(always)]
    pub(super) fn cell(&self, axis: usize, t: f64, time_error: f64) -> (u32, bool) {
        let error = self.speed[axis] * time_error + self.place_error[axis];
        let place = self.from[axis] + t * self.speed[axis] - 0.5;
        let shifted = place + ROUND;
        (shifted.to_bits() as u32, (place - (shifted - ROUND)).abs() < 0.5 - error)
    }
}

/// The same for all four coordinates at once.
impl Course {
    /// Returns the planes by which the ray leaves a cell with an edge of 2^shift, and the times at which it
    /// passes them. The ray is in cell `at` of edge 1 there.
    #[inline(always)]
    pub(super) fn leaves(&self, at: [u32; 4], shift: u32) -> (f64x4, f64x4) {
        let far = f64x4::from(at.each(|a| (((a >> shift) + 1) << shift) as i32 as f64));
        (far, (far - f64x4::from(self.from)) * f64x4::from(self.slowness))
    }

    /// Returns the cells of all coordinates, like [`cell`](Self::cell).
    #[inline(always)]
    pub(super) fn cells(&self, t: f64, time_error: f64) -> (f64x4, f64x4) {
        let speed = f64x4::from(self.speed);
        let error = speed * time_error + f64x4::from(self.place_error);
        let place = f64x4::from(self.from) + speed * t - 0.5;
        let cell = (place + ROUND) - ROUND;
        (cell, (place - cell).abs().simd_lt(f64x4::splat(0.5) - error))
    }

    /// Converts integers in doubles to integers.
    #[inline(always)]
    pub(super) fn integers(cells: f64x4) -> [u32; 4] {
        (cells + ROUND).to_array().each(|shifted| shifted.to_bits() as u32)
    }
}

/// The slowness along an axis on which the cell is never left.
const NEVER: f64 = f64::from_bits((1023 + 900) << 52);

/// The start of a ray.
pub(super) enum Start {
    /// The ray does not meet the universe.
    Beside,
    /// The ray begins in this cell, or enters the universe there along an axis.
    At([u32; 4], Option<usize>),
    /// Rounding errors decide.
    Unsure,
}

impl Course {
    #[inline(always)]
    pub(super) fn start(&self, frame: &Frame, last: f64) -> Start {
        let cells = frame.cells() as f64;
        let mut entry = 0;
        let near = axes(|axis| self.time(axis, 0));
        for axis in 1..3 {
            if near[axis] > near[entry] {
                entry = axis;
            }
        }
        let inside = (0..3).all(|axis| near[axis] + self.time_error[axis] < 0.0);
        let (t, error) = if inside { (0.0, 0.0) } else { (near[entry], self.time_error[entry]) };
        let enters = t > error;
        if !(inside || enters) {
            return Start::Unsure;
        }
        let mut at = [0; 4];
        for axis in 0..3 {
            if !inside && axis == entry {
                continue;
            }
            let place = self.from[axis] + t * self.speed[axis];
            if place > cells + (self.speed[axis] * error + self.place_error[axis]) {
                return Start::Beside;
            }
            let (cell, sure) = self.cell(axis, t, error);
            if !(sure && cell < frame.cells()) {
                return Start::Unsure;
            }
            at[axis] = cell;
        }
        if t > last + error {
            Start::Beside
        } else if inside {
            Start::At(at, None)
        } else if t < last - error {
            Start::At(at, Some(entry))
        } else {
            Start::Unsure
        }
    }

    /// Returns the start of a ray that begins `at` a cell `by` a plane, and that nothing stops before the
    /// plane `until` of an axis: the start is in the cell before that plane, if rounding errors cannot change
    /// the choice of the cell.
    #[inline(always)]
    pub(super) fn skip(
        &self,
        frame: &Frame,
        last: f64,
        (at, by): ([u32; 4], Option<usize>),
        clear: Clear,
    ) -> Start {
        let axis = clear.axis;
        if clear.until == f64::INFINITY {
            return Start::Beside;
        } else if clear.until <= at[axis] as f64 + 1.0 {
            return Start::At(at, by);
        }
        let cells = frame.cells() as f64;
        let (t, error) = ((clear.until - 0.5 - self.from[axis]) * self.slowness[axis], self.time_error[axis]);
        let mut all_sure = t < last - error;
        let mut next = at;
        for other in 0..3 {
            if other == axis {
                next[axis] = clear.until as u32 - 1;
                continue;
            }
            if self.from[other] + t * self.speed[other] > cells + 1.0 {
                return Start::Beside;
            }
            let (cell, sure) = self.cell(other, t, error);
            all_sure &= sure & (cell < frame.cells());
            next[other] = cell;
        }
        if all_sure { Start::At(next, None) } else { Start::At(at, by) }
    }
}

/// The planes of an axis, in mirrored coordinates, before which nothing stops a ray.
#[derive(Clone, Copy)]
pub(super) struct Clear {
    pub(super) axis: usize,
    /// The first plane behind which something may stop the ray; ∞ if nothing does.
    pub(super) until: f64,
}

impl Clear {
    /// The value if nothing is known.
    pub(super) const UNKNOWN: Clear = Clear { axis: 0, until: 0.0 };
}
