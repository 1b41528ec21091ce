//! The slab of a cell: how far triangles reach along their mean normal to either side, and which sides are
//! solid.
//!
//! No triangle reaches beyond the slab's ends, so that the winding number is constant on each side. It is
//! computed on the way from a base to a point on that side.

use super::base::Base;
use super::local::{Point, UNIT, View, dot};
use crate::lattice::Each;
use crate::mesh::FillRule;
use crate::solid::{Enclosure, Slab, SlabJoin};

/// With more triangles than this, a slab would be as thick as the cell.
const MOST: usize = 256;

/// With a greatest distance between surface and mesh of more than this, a slab would be too thick; in half
/// edges.
const THICK: f64 = 0.25;

impl View<'_> {
    /// Returns a slab that contains the boundary. `None` if both sides are equal, or one stays undecided.
    pub(super) fn slab(&self, fill: FillRule) -> Option<Enclosure> {
        if self.triangles.len() > MOST || self.displacement() > THICK {
            return None;
        }
        let base = self.base()?;
        let mut normal = [0.0; 3];
        for &triangle in self.triangles {
            let area = self.seen(triangle).clipped(1.0)?.twice_area();
            (0..3).for_each(|k| normal[k] += area[k]);
        }
        let size = normal.iter().fold(0.0, |most: f64, n| most.max(n.abs()));
        // (NaN is in no range.)
        if !(1e-30..1e30).contains(&size) {
            return None;
        }
        let normal = normal.each(|n| n / size);
        let range = normal.iter().map(|n| n.abs()).sum::<f64>();
        let (mut inner, mut outer) = (f64::INFINITY, f64::NEG_INFINITY);
        for &triangle in self.triangles {
            let seen = self.seen(triangle);
            let slack = 4.0 * seen.slack() + 2.0 * self.displacement();
            // Every point of the surface in the cell lies that near to a point of the polygon.
            let polygon = seen.clipped(1.0 + slack)?;
            let margin = range * slack + 16.0 * UNIT;
            for p in polygon.points() {
                let along = dot(&normal, p);
                (inner, outer) = (inner.min(along - margin), outer.max(along + margin));
            }
        }
        let is_known = inner <= outer;
        if !is_known {
            return None;
        }
        // The side in front, and the side behind; a side is empty if the slab reaches to the cell's corner.
        const NEARLY: f64 = 1.0 - 1e-9;
        let beyond = |sign: f64, end: f64| -> Option<Option<bool>> {
            if end >= range * NEARLY {
                return Some(None);
            }
            let share = (0.5 * (1.0 + end / range)).max(0.5);
            let corner = normal.each(|n| if sign * n < 0.0 { -share } else { share });
            Some(Some(fill.encloses(self.winding_at(&corner, &base)?)))
        };
        let (front, behind) = (beyond(1.0, outer)?, beyond(-1.0, -inner)?);
        let is_inside_behind = match (front, behind) {
            (Some(front), Some(behind)) if front == behind => return None,
            (_, Some(behind)) => behind,
            (Some(front), None) => !front,
            (None, None) => return None,
        };
        // If no point lies beyond an end, any claim about the points beyond is true.
        if front.is_none() {
            outer = f64::INFINITY;
        }
        if behind.is_none() {
            inner = f64::NEG_INFINITY;
        }
        let slab = Slab { normal, inner, outer };
        let slab = if is_inside_behind { slab } else { slab.complement() };
        Some(enclosure(slab))
    }

    /// Returns the winding number at a point of the cell that keeps away from all triangles.
    pub(super) fn winding_at(&self, p: &Point, base: &Base) -> Option<i32> {
        /// Intermediate points for a detour where the straight way comes near to an edge. This happens in
        /// cubes, where base and point lie symmetrically.
        const DETOURS: [Point; 3] = [[-0.61, 0.37, 0.83], [0.53, -0.71, 0.29], [0.19, 0.67, -0.43]];
        let change = |from: &Point, to: &Point| {
            let mut triangles = self.triangles.iter();
            triangles.try_fold(0, |sum, &triangle| Some(sum + self.seen(triangle).pierced(from, to)?))
        };
        let straight = change(&base.at, p);
        let by_way = || DETOURS.iter().find_map(|by| Some(change(&base.at, by)? + change(by, p)?));
        Some(base.winding + straight.or_else(by_way)?)
    }
}

/// The enclosure of one slab.
pub(super) fn enclosure(slab: Slab) -> Enclosure {
    const NONE: Slab = Slab { normal: [0.0; 3], inner: 0.0, outer: 0.0 };
    Enclosure { slabs: [slab, NONE, NONE], join: SlabJoin::All, cone: f64::INFINITY }
}
