//! What cells contribute to volume and moments.

use super::moments::{Moments, Tally, UNIVERSE};
use super::quantity::{self, Quantity};
use crate::error::Error;
use crate::lattice::{Cell, CellMoments};
use crate::solid::{Enclosure, Worker, cut};
use core::ops::AddAssign;

/// Moments of what is proven inside, and of what is open.
#[derive(Clone, Copy, Default)]
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

/// What is known of an open cell.
pub(super) enum Known {
    Nothing,
    Slabs(Enclosure),
    Moments(CellMoments),
}

/// Volume and moments.
pub(super) struct Volume {
    full: Tally,
    open: Tally,
    /// Of cells whose moments are known.
    known: Tally,
    /// Of cells that an enclosure cuts: the sets in the solid, and those around it.
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
        let [full, open, known, low, high] = [(); 5].map(|()| Tally::new());
        Volume { full, open, known, low, high }
    }

    fn full(&mut self, cell: Cell) {
        self.full.add(cell);
    }

    fn open(&mut self, cell: Cell, known: &Known) {
        match known {
            Known::Nothing => self.open.add(cell),
            Known::Slabs(enclosure) => {
                let (low, high) = cut::bounds(enclosure);
                self.low.add_cut(cell, &low);
                self.high.add_cut(cell, &high);
            }
            Known::Moments(moments) => self.known.add_known(cell, moments),
        }
    }

    fn finish(self) -> Found {
        let low = self.low.finish();
        let full = self.full.finish() + self.known.finish() + low;
        Found { full, open: self.open.finish() + (self.high.finish() - low) }
    }
}
