//! The exact least and greatest value over a box of a polynomial without mixed products.

use leafless::{Cell, Frame, Tag};
use leafless_testkit::exact::Exact;

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

    /// Returns the extreme value along an axis: the least for `way` −1, the greatest for 1.
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

    /// Returns the signs of the least and the greatest value over a cell.
    pub fn signs(&self, frame: &Frame, cell: Cell) -> [i32; 2] {
        let bounds = corners(frame, cell);
        [-1, 1].map(|way| {
            let start = Ratio { above: self.constant.clone(), below: Exact::from(1.0) };
            let total =
                (0..3).fold(start, |sum, axis| sum.plus(&self.extreme_along(axis, &bounds[axis], way)));
            total.above.sign()
        })
    }
}

/// Σ coefficient · (t − centre)^exponent + constant, as given.
#[derive(Clone, Debug)]
pub struct Powers {
    pub terms: [(f64, f64, u32); 3],
    pub constant: f64,
}

impl Powers {
    fn signs(&self, frame: &Frame, cell: Cell) -> [i32; 2] {
        let bounds = corners(frame, cell);
        [-1, 1].map(|way| {
            let constant = Exact::from(self.constant);
            let total = (0..3).fold(constant, |sum, axis| {
                let (coefficient, centre, exponent) = self.terms[axis];
                let base = bounds[axis].each_ref().map(|end| end.minus(&Exact::from(centre)));
                let weighted = |base: &Exact| {
                    (0..exponent).fold(Exact::from(coefficient), |product, _| product.times(base))
                };
                let mut ends = vec![weighted(&base[0]), weighted(&base[1])];
                // Between ends of different signs, the power is zero somewhere. Zero is the least or the
                // greatest value of an even power, and lies between the end values of an odd power.
                if base[0].sign() * base[1].sign() < 0 {
                    ends.push(Exact::from(0.0));
                }
                let extreme = ends.into_iter().reduce(if way > 0 { Exact::max } else { Exact::min });
                sum.plus(&extreme.unwrap())
            });
            total.sign()
        })
    }
}

/// minor² − (ρ − major)² − z² with ρ² = (x − cx)² + (y − cy)², z from cz.
#[derive(Clone, Debug)]
pub struct Torus {
    pub centre: [f64; 3],
    pub major: f64,
    pub minor: f64,
}

impl Torus {
    fn signs(&self, frame: &Frame, cell: Cell) -> [i32; 2] {
        let square = |x: &Exact| x.times(x);
        let bounds = corners(frame, cell);
        // The least and the greatest square on each axis.
        let [x, y, z] = [0, 1, 2].map(|axis| {
            let [a, b] = bounds[axis].each_ref().map(|end| end.minus(&Exact::from(self.centre[axis])));
            let across = a.sign() * b.sign() < 0;
            let [a, b] = [square(&a), square(&b)];
            [if across { Exact::from(0.0) } else { a.clone().min(b.clone()) }, a.max(b)]
        });
        let [near, far] = [x[0].plus(&y[0]), x[1].plus(&y[1])];
        let (major, minor) = (square(&Exact::from(self.major)), square(&Exact::from(self.minor)));
        let sign = |rho: &Exact, z: &Exact| {
            // 2 major ρ − rest.
            let rest = rho.plus(z).plus(&major).minus(&minor);
            match rest.sign() {
                -1 => 1,
                _ => Exact::from(4.0).times(&major).times(rho).minus(&square(&rest)).sign(),
            }
        };
        // Where ρ is nearest to the ring's radius.
        let best = major.clone().max(near.clone()).min(far.clone());
        [sign(&near, &z[1]).min(sign(&far, &z[1])), sign(&best, &z[0])]
    }
}

/// A function with known extremes over boxes.
#[derive(Clone, Debug)]
pub enum Truth {
    Separable(Separable),
    Powers(Powers),
    Torus(Torus),
}

impl Truth {
    /// Returns the best possible verdict.
    pub fn tag(&self, frame: &Frame, cell: Cell) -> Tag {
        let signs = match self {
            Truth::Separable(separable) => separable.signs(frame, cell),
            Truth::Powers(powers) => powers.signs(frame, cell),
            Truth::Torus(torus) => torus.signs(frame, cell),
        };
        match signs {
            [0 | 1, _] => Tag::Full,
            [_, 0 | -1] => Tag::Empty,
            _ => Tag::Partial,
        }
    }
}

/// Returns the ends of a cell on each axis.
pub fn corners(frame: &Frame, cell: Cell) -> [[Exact; 2]; 3] {
    let shift = frame.depth() - cell.level;
    [0, 1, 2].map(|axis| [0, 1].map(|end| Exact::plane(frame, axis, (cell.at[axis] + end) << shift)))
}
