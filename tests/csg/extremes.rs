//! The least and the greatest value of a polynomial without mixed products over a box, exactly.

use crate::common::exact::Exact;
use leafless::{Cell, Frame, Tag};

/// constant + Σ (square · t + linear) · t.
#[derive(Clone, Debug)]
pub struct Separable {
    pub square: [Exact; 3],
    pub linear: [Exact; 3],
    pub constant: Exact,
}

/// A fraction with a positive denominator.
#[derive(Clone)]
struct Ratio {
    above: Exact,
    below: Exact,
}

impl Ratio {
    fn plus(&self, other: &Ratio) -> Ratio {
        let above = self.above.times(&other.below).plus(&other.above.times(&self.below));
        Ratio { above, below: self.below.times(&other.below) }
    }
}

impl Separable {
    /// a x² + b y² + c z² + d x + e y + f z + g.
    pub fn new([a, b, c, d, e, f, g]: [f64; 7]) -> Separable {
        Separable {
            square: [a, b, c].map(Exact::from),
            linear: [d, e, f].map(Exact::from),
            constant: Exact::from(g),
        }
    }

    pub fn value(&self, p: &[Exact; 3]) -> Exact {
        (0..3).fold(self.constant.clone(), |sum, axis| sum.plus(&self.along(axis, &p[axis])))
    }

    fn along(&self, axis: usize, t: &Exact) -> Exact {
        self.square[axis].times(t).plus(&self.linear[axis]).times(t)
    }

    /// The extreme in the direction of `way` (−1 least, 1 greatest) along an axis.
    fn extreme_along(&self, axis: usize, ends: &[Exact; 2], way: i32) -> Ratio {
        let one = || Exact::from(1.0);
        let square = &self.square[axis];
        let slope = |t: &Exact| square.times(t).times(&Exact::from(2.0)).plus(&self.linear[axis]).sign();
        if square.sign() == -way && slope(&ends[0]) * slope(&ends[1]) < 0 {
            // −linear² / (4 square).
            let linear = self.linear[axis].times(&self.linear[axis]);
            let [above, below] = [linear, square.times(&Exact::from(4.0))];
            return match way {
                1 => Ratio { above, below: Exact::from(0.0).minus(&below) },
                _ => Ratio { above: Exact::from(0.0).minus(&above), below },
            };
        }
        let [low, high] = [0, 1].map(|end| self.along(axis, &ends[end]));
        let above = if way > 0 { low.max(high) } else { low.min(high) };
        Ratio { above, below: one() }
    }

    /// Signs of the least and the greatest value over a cell.
    pub fn signs(&self, frame: &Frame, cell: Cell) -> [i32; 2] {
        let bounds = corners(frame, cell);
        [-1, 1].map(|way| {
            let start = Ratio { above: self.constant.clone(), below: Exact::from(1.0) };
            let total =
                (0..3).fold(start, |sum, axis| sum.plus(&self.extreme_along(axis, &bounds[axis], way)));
            total.above.sign()
        })
    }

    /// The best possible verdict.
    pub fn tag(&self, frame: &Frame, cell: Cell) -> Tag {
        match self.signs(frame, cell) {
            [0 | 1, _] => Tag::Full,
            [_, 0 | -1] => Tag::Empty,
            _ => Tag::Partial,
        }
    }
}

/// Where a cell begins and ends on each axis.
pub fn corners(frame: &Frame, cell: Cell) -> [[Exact; 2]; 3] {
    let shift = frame.depth() - cell.level;
    [0, 1, 2].map(|axis| [0, 1].map(|end| Exact::plane(frame, axis, (cell.at[axis] + end) << shift)))
}
