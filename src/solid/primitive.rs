//! Shapes that end: the ball and the axis-aligned box.

use super::{Classifier, Fingerprint, Fingerprinter, OCTANTS, Solid, Verdict, Worker, is_moderate};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::exact::{Expansion, certain};
use crate::lattice::exact::{sign_of_sum, two_product};
use crate::lattice::{Bounds, Cell, Cube, Frame};
use crate::octree::Tag;

/// A shape whose verdict of a cell needs nothing but the cell.
pub trait Primitive: Copy + Send + Sync {
    /// What is known of a cell.
    fn verdict(&self, cube: &Cube<'_>) -> Verdict<()>;

    /// Whether the centre of a finest cell lies inside.
    fn sample(&self, cube: &Cube<'_>) -> bool;

    /// What is known of the space around the universe.
    fn exterior(&self, frame: &Frame) -> Tag;
}

/// A primitive on a frame: handle and worker are the same.
#[derive(Debug, Clone, Copy)]
pub struct OnFrame<P> {
    shape: P,
    frame: Frame,
}

impl<P: Primitive> Classifier for OnFrame<P> {
    type Worker = OnFrame<P>;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn worker(&self) -> Result<OnFrame<P>, Error> {
        Ok(*self)
    }

    fn exterior(&self) -> Tag {
        self.shape.exterior(&self.frame)
    }
}

impl<P: Primitive> Worker for OnFrame<P> {
    type Part = ();

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<()>, Error> {
        Ok(self.shape.verdict(&Cube { frame: &self.frame, cell: Cell::ROOT }))
    }

    #[inline]
    fn split(&mut self, cell: Cell, _: &()) -> Result<[Verdict<()>; 8], Error> {
        let cube = Cube { frame: &self.frame, cell };
        Ok(OCTANTS.map(|k| self.shape.verdict(&cube.child(k))))
    }

    fn recall(&mut self, _: Cell) -> Option<()> {
        Some(())
    }

    #[inline]
    fn sample(&mut self, cell: Cell, _: &()) -> Result<Option<bool>, Error> {
        Ok(Some(self.shape.sample(&Cube { frame: &self.frame, cell })))
    }
}

/// A ball. Verdicts are exact for the centre and radius given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    centre: [f64; 3],
    radius: f64,
}

impl Ball {
    /// The ball of all points at most `radius` (model units) from `centre`.
    ///
    /// # Errors
    /// [`Error::Argument`] if the radius is not a number between 2^-256 and 2^256, or a coordinate is not
    /// zero and not of such a magnitude.
    pub fn new(centre: [f64; 3], radius: f64) -> Result<Ball, Error> {
        if !centre.iter().all(|&c| c == 0.0 || is_moderate(c)) {
            let problem = "every coordinate must be zero or of a magnitude between 2^-256 and 2^256";
            return Err(Error::Argument { name: "centre", problem });
        }
        if !(radius > 0.0 && is_moderate(radius)) {
            return Err(Error::Argument { name: "radius", problem: "must be between 2^-256 and 2^256" });
        }
        Ok(Ball { centre, radius })
    }

    /// Exact sign of radius² − distance² from the centre to the point where the half-cell planes `k` meet;
    /// `None` stands for the plane through the centre.
    fn sign_at(&self, frame: &Frame, k: [Option<i64>; 3]) -> i32 {
        let half = 0.5 * frame.cell_size();
        let mut value = self.radius * self.radius;
        let mut size = value;
        for axis in 0..3 {
            if let Some(k) = k[axis] {
                let (offset, step) = (frame.origin()[axis] - self.centre[axis], k as f64 * half);
                let distance = offset + step;
                value -= distance * distance;
                // The distance's own error is relative to what was added up to it.
                let parts = frame.origin()[axis].abs() + self.centre[axis].abs() + step.abs();
                size += parts * (parts * f64::EPSILON + distance.abs());
            }
        }
        certain(value, 16.0 * f64::EPSILON * size).unwrap_or_else(|| {
            let (square, error) = two_product(self.radius, self.radius);
            (0..3)
                .filter_map(|axis| Some(Expansion::offset(frame, axis, self.centre[axis], k[axis]?)))
                .fold(Expansion::sum([error, square]), |sum, distance| sum.minus(&distance.times(&distance)))
                .sign()
        })
    }
}

impl Primitive for Ball {
    fn verdict(&self, cube: &Cube<'_>) -> Verdict<()> {
        let (lower, upper) = cube.planes();
        let mut farthest = [None; 3];
        let mut nearest = [None; 3];
        for axis in 0..3 {
            let (low, high) = (2 * lower[axis] as i64, 2 * upper[axis] as i64);
            let side = |k| cube.frame.side(axis, self.centre[axis], k);
            farthest[axis] = Some(if side((low + high) / 2) > 0 { low } else { high });
            nearest[axis] = if side(low) < 0 {
                Some(low)
            } else if side(high) > 0 {
                Some(high)
            } else {
                None
            };
        }
        if self.sign_at(cube.frame, farthest) >= 0 {
            Verdict::Full
        } else if self.sign_at(cube.frame, nearest) <= 0 {
            Verdict::Empty
        } else {
            Verdict::Partial(())
        }
    }

    fn sample(&self, cube: &Cube<'_>) -> bool {
        let centre = cube.cell.at.map(|i| 2 * i as i64 + 1);
        match self.sign_at(cube.frame, centre.map(Some)) {
            // On the sphere the shift (ε, ε², ε³) leads inside if it leads towards the centre.
            0 => {
                let towards = |axis: usize| cube.frame.side(axis, self.centre[axis], centre[axis]);
                (0..3).map(towards).find(|&side| side != 0).is_some_and(|side| side > 0)
            }
            sign => sign > 0,
        }
    }

    fn exterior(&self, frame: &Frame) -> Tag {
        let inside = (0..3).all(|axis| {
            let (origin, centre) = (frame.origin()[axis], self.centre[axis]);
            sign_of_sum(&[centre, -self.radius, -origin]) >= 0
                && sign_of_sum(&[origin, frame.edge(), -centre, -self.radius]) >= 0
        });
        if inside { Tag::Empty } else { Tag::Partial }
    }
}

impl Solid for Ball {
    type Classifier = OnFrame<Ball>;

    fn on(&self, frame: &Frame, _: &Control<'_>) -> Result<OnFrame<Ball>, Error> {
        Ok(OnFrame { shape: *self, frame: *frame })
    }

    fn bounds(&self) -> Option<Bounds> {
        Bounds::new(
            self.centre.map(|c| (c - self.radius).next_down()),
            self.centre.map(|c| (c + self.radius).next_up()),
        )
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprinter::new("ball").numbers(&self.centre).numbers(&[self.radius]).finish())
    }
}

/// A box with faces parallel to the lattice. Verdicts are exact for the corners given, so a face that lies
/// on a lattice plane leaves nothing undecided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisBox {
    min: [f64; 3],
    max: [f64; 3],
}

impl AxisBox {
    /// The box between two corners (model units), `min < max` on every axis.
    ///
    /// # Errors
    /// [`Error::Argument`] if that does not hold, or a coordinate is not zero and not of a magnitude between
    /// 2^-256 and 2^256.
    pub fn new(min: [f64; 3], max: [f64; 3]) -> Result<AxisBox, Error> {
        if !min.iter().chain(&max).all(|&c| c == 0.0 || is_moderate(c)) {
            let problem = "every coordinate must be zero or of a magnitude between 2^-256 and 2^256";
            return Err(Error::Argument { name: "corner", problem });
        }
        if (0..3).any(|axis| min[axis] >= max[axis]) {
            return Err(Error::Argument { name: "max", problem: "must be greater than min on every axis" });
        }
        Ok(AxisBox { min, max })
    }
}

impl Primitive for AxisBox {
    fn verdict(&self, cube: &Cube<'_>) -> Verdict<()> {
        let (lower, upper) = cube.planes();
        let mut full = true;
        for axis in 0..3 {
            let side = |x: f64, plane: u32| cube.frame.side(axis, x, 2 * plane as i64);
            if side(self.max[axis], lower[axis]) <= 0 || side(self.min[axis], upper[axis]) >= 0 {
                return Verdict::Empty;
            }
            full &= side(self.min[axis], lower[axis]) <= 0 && side(self.max[axis], upper[axis]) >= 0;
        }
        if full { Verdict::Full } else { Verdict::Partial(()) }
    }

    fn sample(&self, cube: &Cube<'_>) -> bool {
        // The shift is positive on every axis: a centre on the lower face goes inside, on the upper outside.
        (0..3).all(|axis| {
            let k = 2 * cube.cell.at[axis] as i64 + 1;
            let side = |x: f64| cube.frame.side(axis, x, k);
            side(self.min[axis]) <= 0 && side(self.max[axis]) > 0
        })
    }

    fn exterior(&self, frame: &Frame) -> Tag {
        let inside = (0..3).all(|axis| {
            let origin = frame.origin()[axis];
            self.min[axis] >= origin && sign_of_sum(&[origin, frame.edge(), -self.max[axis]]) >= 0
        });
        if inside { Tag::Empty } else { Tag::Partial }
    }
}

impl Solid for AxisBox {
    type Classifier = OnFrame<AxisBox>;

    fn on(&self, frame: &Frame, _: &Control<'_>) -> Result<OnFrame<AxisBox>, Error> {
        Ok(OnFrame { shape: *self, frame: *frame })
    }

    fn bounds(&self) -> Option<Bounds> {
        Bounds::new(self.min, self.max)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprinter::new("box").numbers(&self.min).numbers(&self.max).finish())
    }
}
