//! The crossings of a half-space's surface with a ray through cell centres.
//!
//! A ray is a line of the lattice in unit coordinates. A plane or a quadric is a polynomial of degree two on
//! it, with a known error: its roots have closed forms. Where these are too imprecise, as near to a tangent,
//! and for surfaces of higher degree, the ray is bisected until the function has one sign on a piece, or is
//! monotone on it (Taylor's formula with its remainder); signs are decided exactly. The side of a cell's
//! centre is always its exact sign.

use super::Placed;
use crate::dexel::{first_above, within};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::{DoubleDouble, sqrt};
use crate::memory;
use alloc::vec::Vec;

/// A place where a half-space begins or ends on a ray.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Root {
    /// The place in finest cells from the universe's lower face, between the right centres.
    pub at: f64,
    /// The half-space's number among those of the query.
    pub which: u32,
}

/// The precision of roots, as a fraction of the universe's edge.
const FINE: f64 = 1.0 / (1u64 << 36) as f64;

/// The most pieces of a ray on which a function is evaluated. (Where the function is almost zero along the
/// ray, bisection does not end.)
const MOST_PIECES: u32 = 1 << 12;

/// A piece of a ray between two planes of the lattice.
#[derive(Clone, Copy)]
pub(crate) struct Line {
    pub axis: usize,
    /// The ray's place on the other two axes; the third coordinate is arbitrary.
    pub point: [f64; 3],
    /// The number of cells along an axis.
    pub cells: f64,
    pub low: f64,
    pub high: f64,
}

impl Line {
    fn point(&self, s: f64) -> [f64; 3] {
        let mut point = self.point;
        point[self.axis] = s;
        point
    }

    /// Returns whether a point of the ray lies inside, by the exact sign; the point is shifted if it lies on
    /// the surface.
    fn contains(&self, half_space: &Placed, s: f64) -> Result<bool, Error> {
        Ok(half_space.contains(self.point(s))?.unwrap_or(false))
    }

    /// Returns the answer of [`contains`](Self::contains) between the points of the lattice.
    fn contains_off_lattice(&self, half_space: &Placed, s: f64) -> Result<bool, Error> {
        Ok(half_space.contains_off_lattice(self.point(s))?.unwrap_or(false))
    }

    /// Appends the roots of a half-space, ascending. Returns whether the lower end lies inside.
    pub fn roots(&self, half_space: &Placed, which: u32, roots: &mut Vec<Root>) -> Result<bool, Error> {
        let first = roots.len();
        if let Some(inside) = self.closed_form(half_space, which, roots)? {
            return Ok(inside);
        }
        roots.truncate(first);
        let inside = self.contains(half_space, self.low)?;
        let last = self.contains(half_space, self.high)?;
        if half_space.is_linear_along(self.axis) {
            // The function is monotone or constant.
            if inside != last {
                self.bisect(half_space, which, [self.low, self.high], last, roots)?;
            }
            return Ok(inside);
        }
        let mut pieces = MOST_PIECES;
        self.isolate(half_space, which, [self.low, self.high], [inside, last], &mut pieces, roots)?;
        Ok(inside)
    }

    /// Appends the roots of a polynomial of degree two. Returns `None` if rounding leaves something open.
    #[inline]
    fn closed_form(
        &self,
        half_space: &Placed,
        which: u32,
        roots: &mut Vec<Root>,
    ) -> Result<Option<bool>, Error> {
        let Some(([c, b, a], error)) = half_space.along(self.axis, self.point) else { return Ok(None) };
        let size = (a.abs() + b.abs()) + c.abs();
        let square = b * b;
        let discriminant = square - 4.0 * a * c;
        if discriminant.abs() <= 4.0 * size * error {
            return self.finer_form(half_space, which, roots);
        }
        if discriminant < 0.0 {
            return Ok(Some(c > 0.0));
        }
        let root = sqrt(discriminant);
        // The derivative at a root is the root of the discriminant, up to rounding.
        let wrong = 2.0 * error / root;
        // (This is false for NaN, too.)
        let is_fine = wrong <= FINE;
        if !is_fine {
            return self.finer_form(half_space, which, roots);
        }
        let q = -0.5 * (b + if b < 0.0 { -root } else { root });
        self.place(half_space, which, [a, b], [q / a, c / q], wrong, roots)
    }

    /// Appends the roots as [`closed_form`](Self::closed_form), in numbers of 106 bits.
    #[cold]
    fn finer_form(
        &self,
        half_space: &Placed,
        which: u32,
        roots: &mut Vec<Root>,
    ) -> Result<Option<bool>, Error> {
        let Some(([c, b, a], error)) = half_space.finely_along(self.axis, self.point) else {
            return Ok(None);
        };
        let four = DoubleDouble::from(4.0);
        let discriminant = b * b - four * a * c;
        let size = (a.high.abs() + b.high.abs()) + c.high.abs();
        if discriminant.high.abs() <= 8.0 * size * error {
            return Ok(None);
        }
        if discriminant.high < 0.0 {
            return Ok(Some(c.high > 0.0));
        }
        let root = discriminant.root();
        let wrong = 4.0 * error / root.high;
        // (This is false for NaN, too.)
        let is_fine = wrong <= FINE;
        if !is_fine {
            return Ok(None);
        }
        let sum = b + if b.high < 0.0 { -root } else { root };
        let q = sum * DoubleDouble::from(-0.5);
        let [x, y] = [q.quotient(a), c.quotient(q)];
        self.place(half_space, which, [a.high, b.high], [x, y], wrong + 4.0 * f64::EPSILON, roots)
    }

    /// Appends the roots of a polynomial that lie on the piece. Returns `None` if one lies too near to an
    /// end.
    #[inline]
    fn place(
        &self,
        half_space: &Placed,
        which: u32,
        [a, b]: [f64; 2],
        [mut x, mut y]: [f64; 2],
        wrong: f64,
        roots: &mut Vec<Root>,
    ) -> Result<Option<bool>, Error> {
        if x > y {
            (x, y) = (y, x);
        }
        // Left of both roots, the sign is that of the square's factor, or the opposite of the slope's.
        let mut inside = if a != 0.0 { a > 0.0 } else { b < 0.0 };
        if a == 0.0 {
            // One root is at infinity.
            (x, y) = (if x.is_finite() { x } else { y }, f64::INFINITY);
        }
        let mut at_low = inside;
        for s in [x, y] {
            let margin = wrong + 4.0 * f64::EPSILON;
            if (s - self.low).abs() <= margin || (s - self.high).abs() <= margin || s.is_nan() {
                return Ok(None);
            }
            inside = !inside;
            if s < self.low {
                at_low = inside;
            } else if s < self.high {
                let at = self.settled(half_space, s * self.cells, wrong * self.cells, inside)?;
                memory::push(roots, Root { at, which })?;
            }
        }
        Ok(Some(at_low))
    }

    /// Moves a root into the right gap between centres. The root is given in cells with an error of at most
    /// `wrong`; `inside` says whether the inside lies behind it.
    #[inline]
    fn settled(&self, half_space: &Placed, at: f64, wrong: f64, inside: bool) -> Result<f64, Error> {
        let wrong = wrong + 8.0 * f64::EPSILON * self.cells;
        let k = crate::lattice::exact::floor(at);
        let centre = k as f64 + 0.5;
        let above = if (at - centre).abs() > wrong {
            first_above(at) as i32
        } else {
            // The centre lies behind the root if it is on that side.
            let behind = self.contains(half_space, centre / self.cells)? == inside;
            k as i32 + i32::from(!behind)
        };
        Ok(within(at, above, self.cells))
    }

    /// Appends the roots in a piece whose ends have known sides. The recursion depth is at most the number of
    /// a double's bits.
    fn isolate(
        &self,
        half_space: &Placed,
        which: u32,
        [low, high]: [f64; 2],
        sides: [bool; 2],
        pieces: &mut u32,
        roots: &mut Vec<Root>,
    ) -> Result<(), Error> {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        *pieces = pieces.saturating_sub(1);
        if half <= 0.5 * FINE || *pieces == 0 {
            return self.finest(half_space, which, [low, high], sides, roots);
        }
        if let Some(tangent) = half_space.tangent(self.point(middle), half) {
            let slope = tangent.gradient[self.axis].abs();
            let rounding = half_space.rounding();
            if tangent.low > slope + rounding || tangent.high < -slope - rounding {
                return Ok(());
            }
        }
        if let Some(taylor) = half_space.taylor(self.point(middle), half)
            && taylor.f.gradient[self.axis].abs() > taylor.bend + half_space.rounding() * half
        {
            // The function is monotone.
            if sides[0] != sides[1] {
                self.bisect(half_space, which, [low, high], sides[1], roots)?;
            }
            return Ok(());
        }
        let side = self.contains_off_lattice(half_space, middle)?;
        self.isolate(half_space, which, [low, middle], [sides[0], side], pieces, roots)?;
        self.isolate(half_space, which, [middle, high], [side, sides[1]], pieces, roots)
    }

    /// Appends the only root in a piece. `inside` says whether the inside lies behind it.
    fn bisect(
        &self,
        half_space: &Placed,
        which: u32,
        [mut low, mut high]: [f64; 2],
        inside: bool,
        roots: &mut Vec<Root>,
    ) -> Result<(), Error> {
        while high - low > 0.25 * FINE {
            let middle = 0.5 * (low + high);
            if self.contains_off_lattice(half_space, middle)? == inside {
                high = middle;
            } else {
                low = middle;
            }
        }
        let wrong = (high - low) * self.cells;
        let at = self.settled(half_space, 0.5 * (low + high) * self.cells, wrong, inside)?;
        memory::push(roots, Root { at, which })
    }

    /// Appends the roots in a piece that is not bisected further: as many as follow from its ends and the
    /// centres between them.
    fn finest(
        &self,
        half_space: &Placed,
        which: u32,
        [low, high]: [f64; 2],
        [mut side, last]: [bool; 2],
        roots: &mut Vec<Root>,
    ) -> Result<(), Error> {
        let (mut from, end) = (low * self.cells, high * self.cells);
        let mut k = first_above(from) as i32;
        loop {
            let centre = f64::from(k) + 0.5;
            let is_last = centre >= end;
            let next = if is_last { last } else { self.contains(half_space, centre / self.cells)? };
            if next != side {
                let at = within(0.5 * (from + centre.min(end)), k, self.cells);
                memory::push(roots, Root { at, which })?;
            }
            if is_last {
                return Ok(());
            }
            (from, side, k) = (centre, next, k + 1);
        }
    }

    /// Returns the outward normal of a half-space at a place in cells; of any length, or 0.
    pub fn normal(&self, half_space: &Placed, at: f64) -> [f64; 3] {
        let taylor = half_space.taylor(self.point(at / self.cells), 1.0 / self.cells);
        taylor.map_or([0.0; 3], |taylor| taylor.f.gradient.each(|c| -c))
    }
}
