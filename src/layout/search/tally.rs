//! Which of two layouts is the better one.

use super::super::{Layout, Placed};
use super::Objective;
use crate::lattice::exact::sqrt;
use crate::lattice::{Bounds, axes};

/// About how large an item is, and where its middle lies.
#[derive(Debug, Clone, Copy)]
pub(super) struct Figure {
    /// Cubic model units.
    pub(super) volume: f64,
    /// The longest side of its box (model units).
    pub(super) longest: f64,
    /// In the item's own coordinates.
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

/// Masses, for a centre of gravity.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Masses {
    mass: f64,
    moment: [f64; 3],
}

impl Masses {
    /// Those of everything that is placed.
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

    /// Where the centre of another mass should be for that of the whole to be at a point.
    pub(super) fn wanted(&self, mass: f64, target: &[f64; 3]) -> [f64; 3] {
        if mass <= 0.0 {
            return *target;
        }
        axes(|k| ((self.mass + mass) * target[k] - self.moment[k]) / mass)
    }

    /// How far the centre of gravity is from a point.
    fn off(&self, target: &[f64; 3]) -> f64 {
        if self.mass <= 0.0 {
            return f64::INFINITY;
        }
        let off: [f64; 3] = axes(|k| self.moment[k] / self.mass - target[k]);
        sqrt(off.iter().map(|off| off * off).sum::<f64>())
    }
}

/// What counts of a layout.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tally {
    count: f64,
    volume: f64,
    /// How far the highest reaches along z.
    height: f64,
    /// How far the centre of gravity is from where it should be.
    off: f64,
}

impl Tally {
    /// That of a layout, in which all from `first` on were placed by the search.
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
