//! The half-space a·x + b·y + c·z + d ≥ 0.

use super::exact::{Expansion, certain};
use super::{Solid, Verdict};
use crate::error::Error;
use crate::lattice::{Cell, Cube, Frame};

/// The points where `normal · p + offset ≥ 0`. Signs are exact for the coefficients given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfSpace {
    normal: [f64; 3],
    offset: f64,
}

impl HalfSpace {
    /// A half-space from its coefficients; `normal` (any length, pointing into the solid) times model units
    /// plus `offset`.
    ///
    /// # Errors
    /// [`Error::Argument`] if the normal is zero, or a coefficient is not a number between −2^256 and 2^256,
    /// or is not zero and smaller than 2^-256.
    pub fn new(normal: [f64; 3], offset: f64) -> Result<HalfSpace, Error> {
        let problem = "must be zero or a number whose magnitude lies between 2^-256 and 2^256";
        if !normal.iter().all(|&c| c == 0.0 || super::is_moderate(c)) {
            return Err(Error::Argument { name: "normal", problem });
        }
        if normal == [0.0; 3] {
            return Err(Error::Argument { name: "normal", problem: "must not be zero" });
        }
        if !(offset == 0.0 || super::is_moderate(offset)) {
            return Err(Error::Argument { name: "offset", problem });
        }
        Ok(HalfSpace { normal, offset })
    }

    /// Exact sign of the function where the half-cell planes `k` meet.
    fn sign_at(&self, frame: &Frame, k: [i64; 3]) -> i32 {
        let half = 0.5 * frame.cell_size();
        let mut value = self.offset;
        let mut size = self.offset.abs();
        for axis in 0..3 {
            let (origin, step) = (frame.origin()[axis], k[axis] as f64 * half);
            value += self.normal[axis] * (origin + step);
            size += self.normal[axis].abs() * (origin.abs() + step.abs());
        }
        // Ten roundings at the most go into any term.
        certain(value, 16.0 * f64::EPSILON * size).unwrap_or_else(|| {
            (0..3)
                .map(|axis| {
                    // offset() measures plane to point, the function grows the other way.
                    Expansion::sum([-self.normal[axis]]).times(&Expansion::offset(frame, axis, 0.0, k[axis]))
                })
                .fold(Expansion::sum([self.offset]), |sum, term| sum.plus(&term))
                .sign()
        })
    }

    fn verdict(&self, cube: &Cube<'_>) -> Verdict<()> {
        let (lower, upper) = cube.planes();
        let corner = |greatest: bool| {
            [0, 1, 2].map(|axis| {
                let up = (self.normal[axis] > 0.0) == greatest;
                2 * (if up { upper[axis] } else { lower[axis] }) as i64
            })
        };
        if self.sign_at(cube.frame, corner(false)) >= 0 {
            Verdict::Full
        } else if self.sign_at(cube.frame, corner(true)) <= 0 {
            Verdict::Empty
        } else {
            Verdict::Partial(())
        }
    }
}

impl Solid for HalfSpace {
    type Part = ();
    type Scratch = ();

    fn root(&self, _: &mut (), frame: &Frame) -> Result<Verdict<()>, Error> {
        Ok(self.verdict(&Cube { frame, cell: Cell::ROOT }))
    }

    fn split(&self, _: &mut (), cube: &Cube<'_>, _: &()) -> Result<[Verdict<()>; 8], Error> {
        Ok([0, 1, 2, 3, 4, 5, 6, 7].map(|k| self.verdict(&cube.child(k))))
    }

    fn sample(&self, _: &mut (), cube: &Cube<'_>, _: &()) -> Result<Option<bool>, Error> {
        let centre = cube.cell.at.map(|i| 2 * i as i64 + 1);
        // On the plane the first coefficient that is not zero decides where (ε, ε², ε³) leads.
        let shift = || self.normal.iter().find(|&&c| c != 0.0).is_some_and(|&c| c > 0.0);
        Ok(Some(match self.sign_at(cube.frame, centre) {
            0 => shift(),
            sign => sign > 0,
        }))
    }
}
