//! The truth as a solid, in the simplest way. It is slow, and serves to show that the checks pass on a right
//! solid and fail on a wrong one.

use super::check::{centre, margin};
use super::winding::{Boundary, Soupy};
use crate::shapes::Soup;
use leafless::lattice::Cube;
use leafless::{Cell, Error, FillRule, Frame, Tag, Verdict};
use leafless_testkit::cubes::Cubes;
use std::sync::{Arc, Mutex};

/// Mistakes that a solid of this kind could make.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lie {
    Nothing,
    /// Decides cells by their centres.
    NoGradient,
    /// Takes a cell for clear although a triangle passes through it beside the centre.
    SmallReach,
    /// Uses a threshold other than one half.
    Threshold,
    /// Rounds winding numbers up to integers.
    Closed,
    /// Counts negative winding numbers under any rule.
    Unsigned,
    /// Ignores repeated triangles.
    Unique,
    /// Takes samples at the lowest corner.
    Corner,
    /// Ignores the orientation of facets.
    Unoriented,
    /// Never decides anything near a hole.
    Coward,
    /// Ends the solid where its mesh ends.
    Ends,
}

#[derive(Clone)]
pub struct Reference {
    truth: Arc<Mutex<Soupy>>,
    boundary: Arc<Boundary>,
    fill: FillRule,
    lie: Lie,
}

impl Reference {
    pub fn new(soup: &Soup, fill: FillRule, lie: Lie) -> Reference {
        let mut seen = soup.clone();
        if lie == Lie::Unique {
            seen.sort_by(|a, b| a.partial_cmp(b).unwrap());
            seen.dedup();
        }
        if lie == Lie::Unoriented {
            let middle = |f: &[[f64; 3]; 3]| f[0][0] + f[1][0] + f[2][0];
            seen.sort_by(|a, b| middle(a).total_cmp(&middle(b)));
            let half = seen.len() / 2;
            seen[..half].iter_mut().for_each(|f| f.swap(0, 1));
        }
        let (truth, boundary) = (Mutex::new(Soupy::new(&seen)), Boundary::of(&seen));
        Reference { truth: Arc::new(truth), boundary: Arc::new(boundary), fill, lie }
    }

    fn margin(&self, p: [f64; 3]) -> f64 {
        let winding = self.truth.lock().unwrap().at(p).value;
        match self.lie {
            Lie::Threshold => margin(self.fill, winding) - 0.1,
            Lie::Closed => margin(self.fill, winding.abs().ceil()),
            Lie::Unsigned => margin(FillRule::NonZero, winding),
            _ => margin(self.fill, winding),
        }
    }

    fn verdict(&self, frame: &Frame, cell: Cell) -> Verdict<()> {
        let coarse = frame.with_depth(cell.level.max(1)).unwrap();
        let at = cell.at;
        let (middle, edge) = match cell.level {
            0 => (frame.origin().map(|low| low + frame.edge() / 2.0), frame.edge()),
            _ => (centre(&coarse, at), coarse.cell_size()),
        };
        let radius = 0.866_026 * edge;
        let reach = if self.lie == Lie::SmallReach { 0.3 * edge } else { radius };
        if self.truth.lock().unwrap().is_near(middle, reach) {
            return Verdict::Partial(());
        }
        let margin = self.margin(middle);
        let change = match self.lie {
            Lie::NoGradient => 0.0,
            Lie::Coward => 40.0 * radius * self.boundary.gradient(middle, radius),
            _ => radius * self.boundary.gradient(middle, radius),
        };
        if margin.abs() <= change + 1e-9 {
            Verdict::Partial(())
        } else if margin > 0.0 {
            Verdict::Full
        } else {
            Verdict::Empty
        }
    }
}

impl Cubes for Reference {
    fn verdict(&self, cube: &Cube<'_>) -> Result<Verdict<()>, Error> {
        Ok(Reference::verdict(self, cube.frame, cube.cell))
    }

    fn sample(&self, cube: &Cube<'_>) -> Result<Option<bool>, Error> {
        let mut p = centre(cube.frame, cube.cell.at);
        if self.lie == Lie::Corner {
            p = p.map(|x| x - 0.49 * cube.frame.cell_size());
        }
        // Edges have no defined result here. Step to a place with a winding number.
        if self.truth.lock().unwrap().at(p).error > 1e-3 {
            let shift = [2f64.powi(-12), 2f64.powi(-24), 2f64.powi(-36)];
            p = [0, 1, 2].map(|axis| p[axis] + cube.frame.cell_size() * shift[axis]);
        }
        Ok(Some(self.margin(p) >= 0.0))
    }

    fn exterior(&self, _: &Frame) -> Tag {
        if self.lie == Lie::Ends { Tag::Empty } else { Tag::Partial }
    }
}

leafless_testkit::solid_of_cubes!(Reference);
