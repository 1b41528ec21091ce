//! The contributions of cells to volume and moments.

use super::moments::{Moments, Tally, UNIVERSE};
use super::quantity::{self, Quantity};
use crate::cut;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, CellMoments, CubeMoments};
use crate::solid::{Ask, Enclosure, Worker};
use core::ops::AddAssign;

/// The moments of the proven part and of the open part.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Found {
    pub(super) full: Moments,
    pub(super) open: Moments,
}

impl quantity::Found for Found {
    fn least(&self) -> f64 {
        self.full.volume as f64
    }

    fn doubt(&self) -> f64 {
        (self.open.volume + self.open.error + 2 * self.full.error) as f64
    }
}

impl AddAssign for Found {
    fn add_assign(&mut self, other: Found) {
        self.full += other.full;
        self.open += other.open;
    }
}

/// The knowledge about an open cell.
pub(super) enum Known {
    Nothing,
    Slabs(Enclosure),
    Moments(CellMoments),
}

/// Volume and moments.
pub(super) struct Volume {
    full: Tally,
    open: Tally,
    /// For cells that an enclosure cuts: the sets inside the solid, and the sets around it. For cells with
    /// known moments: their bounds.
    low: Tally,
    high: Tally,
}

impl Quantity for Volume {
    type Known = Known;
    type Found = Found;

    const DIMENSION: u8 = 3;
    const SIZE: f64 = 1.0;
    const UNIVERSE: f64 = UNIVERSE as f64;
    const NOTHING: Known = Known::Nothing;

    fn known<W: Worker>(worker: &mut W, cell: Cell, part: &W::Part) -> Result<Known, Error> {
        if let Some(moments) = worker.moments(cell, part)? {
            return Ok(Known::Moments(moments));
        }
        Ok(worker.enclosure(cell, part)?.map_or(Known::Nothing, Known::Slabs))
    }

    fn doubt(known: &Known) -> f64 {
        match known {
            Known::Nothing => 1.0,
            Known::Slabs(enclosure) => cut::doubt(enclosure) / 8.0,
            Known::Moments(moments) => (2.0 * moments.error / 8.0).min(1.0),
        }
    }

    fn new() -> Volume {
        let [full, open, low, high] = [(); 4].each(|()| Tally::new());
        Volume { full, open, low, high }
    }

    fn full(&mut self, cell: Cell) {
        self.full.add(cell);
    }

    fn open(&mut self, cell: Cell, known: &Known) {
        match known {
            Known::Nothing => self.open.add(cell),
            Known::Slabs(enclosure) => self.add_cut(cell, cut::bounds(enclosure)),
            Known::Moments(moments) => self.add_cut(cell, bounds(moments)),
        }
    }

    fn finish(self) -> Found {
        let low = self.low.finish();
        let full = self.full.finish() + low;
        Found { full, open: self.open.finish() + (self.high.finish() - low) }
    }
}

impl Volume {
    fn add_cut(&mut self, cell: Cell, (low, high): (CubeMoments, CubeMoments)) {
        self.low.add_cut(cell, &low);
        self.high.add_cut(cell, &high);
    }
}

/// Returns moments whose matrices lie, in the order of Loewner, below and above that of the solid. The
/// conclusions from sets between which the solid lies use no other property.
///
/// The matrix is that of the products of 1, x, y and z. The error of each element is at most e. A diagonal
/// matrix is above all such differences if, for some s, its first element is e (1 + 3 s), and the others are
/// e (3 + 1/s): its rows then dominate those of the difference, with the weights 1, s, s, s. A smaller s
/// means less volume in doubt, but greater second moments about the centre, which count little in a small
/// cell.
fn bounds(known: &CellMoments) -> (CubeMoments, CubeMoments) {
    let CellMoments { moments, error } = *known;
    let s = if error < 1.0 / 16.0 { 1.0 / 48.0 } else { 0.5 };
    let (volume, square) = (error * (1.0 + 3.0 * s), error * (3.0 + 1.0 / s));
    let [mut low, mut high] = [moments; 2];
    low.volume -= volume;
    high.volume += volume;
    for i in 0..3 {
        low.second[i] -= square;
        high.second[i] += square;
    }
    (
        if low.volume > 0.0 { low } else { CubeMoments::EMPTY },
        if high.volume < 8.0 { high } else { CubeMoments::FULL },
    )
}
