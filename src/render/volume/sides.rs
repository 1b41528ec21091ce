//! Half-spaces that a cell must meet to be visible in a tile.

use super::coordinates::{Coordinates, Place};
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use crate::render::clip::Clip;
use crate::render::tile::Tile;
use alloc::vec::Vec;
use glam::DVec3;

/// The points with normal · point + offset ≥ 0.
pub(super) struct Side {
    normal: DVec3,
    offset: f64,
    /// The extent of a cube with the half edge 1 along the normal.
    reach: f64,
}

impl Side {
    pub fn new(normal: DVec3, through: DVec3) -> Side {
        Side { normal, offset: -normal.dot(through), reach: reach(normal) }
    }

    /// Returns whether some of a cube lies on this side.
    #[inline(always)]
    pub fn meets(&self, (centre, half): (DVec3, f64)) -> bool {
        self.normal.dot(centre) + self.offset + self.reach * half >= 0.0
    }
}

/// The extent of a cube with the half edge 1 along a direction.
pub(super) fn reach(normal: DVec3) -> f64 {
    normal.abs().element_sum()
}

/// The sides of a tile, of the eye, and of the clip planes.
pub(super) fn sides(
    tile: &Tile<'_>,
    clip: &Clip,
    place: &Place,
    coordinates: &Coordinates,
) -> Result<Vec<Side>, Error> {
    let clip = clip.planes();
    let mut sides = memory::with_capacity(6 + clip.len())?;
    // Half a sample beyond the outermost samples, so that rounding does not matter.
    let [left, top] = tile.first.each(f64::from);
    let (from, first) = tile.view.line(left, top);
    let (end, last) = tile.view.line(left + f64::from(tile.size[0]), top + f64::from(tile.size[1]));
    let (from, end) = (from - coordinates.origin, end - coordinates.origin);
    let lean = |axis: DVec3, along: DVec3| axis - place.forward * along.dot(axis);
    sides.push(Side::new(lean(place.right, first), from));
    sides.push(Side::new(-lean(place.right, last), end));
    sides.push(Side::new(-lean(place.up, first), from));
    sides.push(Side::new(lean(place.up, last), end));
    sides.push(Side::new(place.forward, place.eye));
    for &(normal, offset) in clip {
        sides.push(Side { normal, offset: normal.dot(coordinates.origin) + offset, reach: reach(normal) });
    }
    Ok(sides)
}
