//! The comparison of two layouts.

use super::super::{Layout, Placed};
use super::Objective;
use crate::lattice::exact::sqrt;
use crate::lattice::{Bounds, axes};

/// The approximate size and centre of an item.
#[derive(Debug, Clone, Copy)]
pub(super) struct Figure {
    /// The volume, in cubic model units.
    pub(super) volume: f64,
    /// The longest side of the item's box (model units).
    pub(super) longest: f64,
    /// The centre, in the item's own coordinates.
    pub(super) centre: [f64; 3],
}

impl Figure {
    pub(super) fn of_box(bounds: &Bounds) -> Figure {
        let sides: [f64; 3] = axes(|k| bounds.max[k] - bounds.min[k]);
        Figure {
            volume: sides.iter().product(),
            longest: sides.iter().fold(0.0, |longest, &side| longest.max(side)),
            centre: axes(|k| 0.5 * (bounds.min[k] + bounds.max[k])),
        }
    }
}

/// A sum of masses, for a centre of gravity.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Masses {
    mass: f64,
    moment: [f64; 3],
}

impl Masses {
    /// The masses of all placed copies.
    pub(super) fn of(layout: &Layout, figures: &[Figure]) -> Masses {
        let mut masses = Masses::default();
        layout.placed.iter().for_each(|placed| masses.add(layout, figures, placed));
        masses
    }

    pub(super) fn add(&mut self, layout: &Layout, figures: &[Figure], placed: &Placed) {
        let figure = &figures[placed.item];
        let mass = figure.volume * layout.items[placed.item].density;
        let centre = placed.placement.apply(figure.centre);
        self.mass += mass;
        (0..3).for_each(|k| self.moment[k] += mass * centre[k]);
    }

    /// Returns the centre of another mass that moves the centre of gravity of the whole to a point.
    pub(super) fn wanted(&self, mass: f64, target: &[f64; 3]) -> [f64; 3] {
        if mass <= 0.0 {
            return *target;
        }
        axes(|k| ((self.mass + mass) * target[k] - self.moment[k]) / mass)
    }

    /// The distance of the centre of gravity from a point.
    fn off(&self, target: &[f64; 3]) -> f64 {
        if self.mass <= 0.0 {
            return f64::INFINITY;
        }
        let off: [f64; 3] = axes(|k| self.moment[k] / self.mass - target[k]);
        sqrt(off.iter().map(|off| off * off).sum::<f64>())
    }
}

/// The compared quantities of a layout.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tally {
    count: f64,
    volume: f64,
    /// The greatest height along z.
    height: f64,
    /// The distance of the centre of gravity from its target.
    off: f64,
}

impl Tally {
    /// Computes the tally of a layout, in which the search placed all copies from `first` on.
    pub(super) fn of(layout: &Layout, first: usize, figures: &[Figure], objective: Objective) -> Tally {
        let new = &layout.placed[first..];
        let off = match objective {
            Objective::Balance(target) => Masses::of(layout, figures).off(&target),
            _ => 0.0,
        };
        Tally {
            count: new.len() as f64,
            volume: new.iter().map(|placed| figures[placed.item].volume).sum(),
            height: layout.boxes.iter().map(|block| block.max[2]).fold(f64::NEG_INFINITY, f64::max),
            off,
        }
    }

    pub(super) fn is_better_than(&self, other: &Tally, objective: Objective) -> bool {
        let rank = |tally: &Tally| match objective {
            Objective::Count => [tally.count, tally.volume, -tally.height],
            Objective::Height => [tally.count, -tally.height, tally.volume],
            Objective::Density => [tally.volume, -tally.height, tally.count],
            Objective::Balance(_) => [tally.count, -tally.off, tally.volume],
        };
        rank(self) > rank(other)
    }
}
