//! The boundary of a solid in a cell with a known enclosure, as polygons.
//!
//! All coordinates are the cell's own, from its centre in half edges. The slabs of a union are replaced by
//! those of the complement, which has the same boundary.

use super::piece::dot;
use super::polygon::Polygon;
use crate::cut;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::solid::{Enclosure, Slab, SlabJoin};

/// A bound above the rounding error in the coordinates of a cell, as a part of the normal's range.
pub(super) const ROUNDING: f64 = 1.0 / (1u64 << 42) as f64;

/// A part of a cell: the points with n · x ≤ offset for all of up to three half-spaces.
#[derive(Clone, Copy)]
pub(super) struct Region {
    halves: [([f64; 3], f64); 3],
    count: usize,
}

impl Region {
    pub(super) const ALL: Region = Region { halves: [([0.0; 3], 0.0); 3], count: 0 };

    fn push(&mut self, normal: [f64; 3], offset: f64) {
        self.halves[self.count] = (normal, offset);
        self.count += 1;
    }

    /// Reduces a polygon in another cell's coordinates to the part that surely lies in the region. The
    /// region's coordinates are the polygon's times `ratio`, plus `from`.
    pub(super) fn clip(&self, polygon: &mut Polygon, ratio: f64, from: [f64; 3]) {
        for &(normal, offset) in &self.halves[..self.count] {
            let range: f64 = normal.iter().map(|c| c.abs()).sum();
            polygon.clip(normal.each(|c| ratio * c), offset - dot(normal, from) - 4.0 * ROUNDING * range);
        }
    }
}

/// The slabs that cross a cell. The solid, or its complement, is the region behind all of them.
#[derive(Clone, Copy)]
pub(super) struct Slabs {
    slabs: [Slab; 3],
    count: u8,
    /// Whether the region is the complement.
    is_hollow: bool,
    /// Whether the region behind all slabs is empty.
    is_void: bool,
    /// The walls of the cell that lie entirely on the wall of a FULL cell, and those on the wall of an EMPTY
    /// cell, as bits: 2 · axis, and one more for the upper wall.
    walls: [u8; 2],
}

impl Slabs {
    /// Returns the slabs of an enclosure; `None` if they do not bound the boundary.
    pub(super) fn new(enclosure: &Enclosure) -> Option<Slabs> {
        let is_hollow = enclosure.join == SlabJoin::Any;
        let enclosure = if is_hollow { enclosure.complement() } else { *enclosure };
        let mut own = Slabs { slabs: [Slab::NONE; 3], count: 0, is_hollow, is_void: false, walls: [0; 2] };
        let mut is_any = false;
        for slab in enclosure.slabs.into_iter().filter(|slab| slab.normal != [0.0; 3]) {
            let Slab { normal, inner, outer } = slab;
            let range: f64 = normal.iter().map(|c| c.abs()).sum();
            if !(range > 0.0 && range.is_finite() && inner <= outer) {
                return None;
            }
            is_any = true;
            if outer <= -range {
                own.is_void = true;
            } else if inner < range {
                own.slabs[own.count as usize] = slab;
                own.count += 1;
            }
        }
        let is_known = |slab: &Slab| slab.inner.is_finite() && slab.outer.is_finite();
        let is_told = is_any && (own.is_void || own.slabs().iter().all(is_known));
        is_told.then_some(own)
    }

    fn slabs(&self) -> &[Slab] {
        &self.slabs[..self.count as usize]
    }

    /// Half the width of a slab, slightly enlarged.
    fn half_width(slab: &Slab) -> f64 {
        let length = sqrt(dot(slab.normal, slab.normal));
        0.5 * (slab.outer - slab.inner) / length * (1.0 + ROUNDING) + 4.0 * ROUNDING
    }

    /// An upper bound of the boundary's distance from the polygons; 0 if the cell has no boundary.
    pub(super) fn radius(&self) -> f64 {
        if self.is_void { 0.0 } else { self.slabs().iter().map(Slabs::half_width).fold(0.0, f64::max) }
    }

    /// Records that a wall lies entirely on the wall of a FULL cell, or of an EMPTY one.
    pub(super) fn meet(&mut self, axis: usize, is_upper: bool, is_full: bool) {
        self.walls[usize::from(!is_full)] |= 1 << (2 * axis + usize::from(is_upper));
    }

    /// True if polygons show where the boundary is, not only where it may be: a single slab has both its
    /// sides in the cell.
    pub(super) fn is_met(&self) -> bool {
        let slab = &self.slabs[0];
        let is_away = self.is_void || self.count != 1 || cut::corners(slab).next().is_none();
        is_away || self.whole(slab).is_some_and(|(_, radius)| radius < 1.0)
    }

    /// Returns the middle plane of a single slab, with an upper bound of the distance between each of the
    /// plane's points and the boundary, if there is one. A line from a point of the slab to a point inside of
    /// the solid, or to a point outside, meets the boundary.
    fn whole(&self, slab: &Slab) -> Option<(Polygon, f64)> {
        let polygon = Polygon::of_plane(slab.normal, 0.5 * slab.inner + 0.5 * slab.outer, 1.0);
        // (Where rounding makes a difference, no polygon is returned.)
        cut::corners(slab).next()?;
        let sides = cut::sides(slab);
        let mut radius: f64 = 0.0;
        for (side, within) in sides.into_iter().enumerate() {
            // The region behind the slab is the solid or its complement.
            let walls = self.walls[side ^ usize::from(self.is_hollow)];
            let from_wall = (0..6).filter(|wall| walls >> wall & 1 != 0).map(|wall| {
                let sign = if wall & 1 != 0 { 1.0 } else { -1.0 };
                // (Some point of the slab is as far as this.)
                cut::corners(slab).map(|p| 1.0 - sign * p[wall / 2]).fold(0.0, f64::max)
            });
            radius = radius.max(from_wall.fold(within, f64::min));
        }
        let radius = radius * (1.0 + ROUNDING) + 8.0 * ROUNDING;
        (radius < f64::INFINITY).then_some((polygon, radius))
    }

    /// Returns polygons with the radius of each. If `all`, each boundary point in the cell is within the
    /// radius of a polygon; otherwise each point of a polygon is within the radius of the boundary.
    ///
    /// A point of a slab that lies in front of no other slab is within half the slab's width of a point on
    /// the slab's middle plane. This point lies at most as far beyond the other slabs and the walls.
    /// Conversely, take a point of the middle plane that lies half the width behind the other slabs and
    /// within the walls. The lines from this point to both sides of its slab lead into the solid and out of
    /// it.
    pub(super) fn polygons(&self, all: bool) -> impl Iterator<Item = (Polygon, f64)> + '_ {
        let count = if self.is_void { 0 } else { self.count as usize };
        (0..count).map(move |k| {
            let slab = &self.slabs[k];
            let half_width = Slabs::half_width(slab);
            let margin = if all { half_width } else { -half_width };
            let mut polygon =
                Polygon::of_plane(slab.normal, 0.5 * slab.inner + 0.5 * slab.outer, 1.0 + margin);
            for other in (0..count).filter(|&other| other != k).map(|other| &self.slabs[other]) {
                let length = sqrt(dot(other.normal, other.normal));
                let end = if all { other.outer } else { other.inner };
                polygon.clip(other.normal, end + margin * length * (1.0 + ROUNDING));
            }
            (polygon, half_width)
        })
    }

    /// Returns one more polygon that lies near to the boundary as a whole, if the other polygons may omit a
    /// large part of a slab near a wall.
    pub(super) fn beside_walls(&self) -> Option<(Polygon, f64)> {
        let is_alone = self.count == 1 && !self.is_void;
        is_alone.then(|| self.whole(&self.slabs[0])).flatten()
    }

    /// Regions that surely lie inside of the solid, or surely outside.
    pub(super) fn regions(&self, solid: bool) -> ([Region; 3], usize) {
        let mut regions = [Region::ALL; 3];
        if solid != self.is_hollow {
            if self.is_void {
                return (regions, 0);
            }
            self.slabs().iter().for_each(|slab| regions[0].push(slab.normal, slab.inner));
            return (regions, 1);
        }
        if self.is_void {
            return (regions, 1);
        }
        for (region, slab) in regions.iter_mut().zip(self.slabs()) {
            region.push(slab.normal.each(|c| -c), -slab.outer);
        }
        (regions, self.count as usize)
    }
}
