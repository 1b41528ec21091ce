//! A ray on the lattice of a frame, exactly.

use super::Ray;
use crate::lattice::Each;
use crate::lattice::exact::{Expansion, sign};
use crate::lattice::{Cell, Frame, Interval};
use core::cmp::Ordering;

/// The time at which a ray begins, ends or passes a lattice plane.
#[derive(Clone, Copy)]
pub(super) struct Moment {
    /// The tightest known interval around t.
    pub(super) t: Interval,
    /// The axis and the finest lattice plane; `None` if t is exact.
    plane: Option<(u8, u32)>,
}

impl Moment {
    /// t = 0.
    pub(super) const START: Moment = Moment::exactly(0.0);

    pub(super) const fn exactly(t: f64) -> Moment {
        Moment { t: Interval::exactly(t), plane: None }
    }

    /// The axis of the passed plane.
    pub(super) fn axis(&self) -> Option<usize> {
        self.plane.map(|(axis, _)| axis.into())
    }
}

/// The time that a ray spends between two parallel planes.
#[derive(Clone, Copy)]
enum Stay {
    Never,
    Always,
    Between(Moment, Moment),
}

/// The time that a ray spends in a closed cell.
#[derive(Clone, Copy)]
pub(super) struct Passage {
    pub(super) entry: Moment,
    pub(super) exit: Moment,
}

/// A ray on a frame.
pub(super) struct Line<'f> {
    pub(super) frame: &'f Frame,
    pub(super) ray: Ray,
    /// The components of the direction, rounded outward.
    pub(super) direction: [Interval; 3],
    /// The mirror that orders octants front to back: k becomes k ^ `mirror`.
    pub(super) mirror: u8,
}

impl<'f> Line<'f> {
    pub(super) fn new(frame: &'f Frame, ray: Ray) -> Line<'f> {
        let direction =
            ray.direction.each(|[high, low]| Interval::exactly(high).plus(Interval::exactly(low)));
        let mirror = (0..3).fold(0, |mirror, axis| mirror | ((ray.direction[axis][0] < 0.0) as u8) << axis);
        Line { frame, ray, direction, mirror }
    }

    /// Returns the time at which the ray passes the finest lattice plane `plane` of an axis along which it
    /// moves.
    pub(super) fn passes(&self, axis: usize, plane: u32) -> Moment {
        let offset = self.frame.rounded_offset(axis, self.ray.from[axis], 2 * plane as i64);
        let direction = self.direction[axis];
        let t = if direction.lower > 0.0 {
            offset.negated().over(direction)
        } else {
            offset.over(direction.negated())
        };
        Moment { t, plane: Some((axis as u8, plane)) }
    }

    fn stay(&self, axis: usize, lower: u32, upper: u32) -> Stay {
        let direction = self.ray.direction[axis][0];
        if direction == 0.0 {
            let side = |plane: u32| self.frame.side(axis, self.ray.from[axis], 2 * plane as i64);
            return if side(lower) >= 0 && side(upper) <= 0 { Stay::Always } else { Stay::Never };
        }
        let (lower, upper) = (self.passes(axis, lower), self.passes(axis, upper));
        if direction > 0.0 { Stay::Between(lower, upper) } else { Stay::Between(upper, lower) }
    }

    /// Returns the time that the ray spends in a closed cell; `None` if it never meets the cell.
    pub(super) fn passage(&self, cell: Cell) -> Option<Passage> {
        let shift = self.frame.depth() - cell.level;
        let mut passage = Passage { entry: Moment::START, exit: Moment::exactly(self.ray.last) };
        for axis in 0..3 {
            match self.stay(axis, cell.at[axis] << shift, (cell.at[axis] + 1) << shift) {
                Stay::Never => return None,
                Stay::Always => {}
                Stay::Between(near, far) => {
                    if self.order(&near, &passage.entry).is_gt() {
                        passage.entry = near;
                    }
                    if self.order(&far, &passage.exit).is_lt() {
                        passage.exit = far;
                    }
                }
            }
        }
        self.order(&passage.entry, &passage.exit).is_le().then_some(passage)
    }

    /// Compares two moments exactly.
    pub(super) fn order(&self, a: &Moment, b: &Moment) -> Ordering {
        if a.t.upper < b.t.lower {
            Ordering::Less
        } else if a.t.lower > b.t.upper {
            Ordering::Greater
        } else if a.plane == b.plane && a.plane.is_some() || a.t.width() == 0.0 && b.t.width() == 0.0 {
            Ordering::Equal
        } else {
            self.order_exactly(a, b)
        }
    }

    #[cold]
    fn order_exactly(&self, a: &Moment, b: &Moment) -> Ordering {
        let ((a, a_divisor), (b, b_divisor)) = (self.fraction(a), self.fraction(b));
        let difference = a.times(&b_divisor).minus(&b.times(&a_divisor)).sign();
        (difference * a_divisor.sign() * b_divisor.sign()).cmp(&0)
    }

    /// A moment as a fraction.
    fn fraction(&self, moment: &Moment) -> (Expansion, Expansion) {
        let Some((axis, plane)) = moment.plane else {
            return (Expansion::sum([moment.t.lower]), Expansion::sum([1.0]));
        };
        let axis = axis as usize;
        let offset = self.frame.offset(axis, self.ray.from[axis], 2 * plane as i64);
        (Expansion::default().minus(&offset), Expansion::sum(self.ray.direction[axis]))
    }

    /// Returns the normal of the face by which the ray enters a cell; zero if it starts there.
    pub(super) fn face(&self, entry: &Moment) -> [f64; 3] {
        let mut normal = [0.0; 3];
        if let Some(axis) = entry.axis() {
            normal[axis] = -sign(self.ray.direction[axis][0]) as f64;
        }
        normal
    }
}
