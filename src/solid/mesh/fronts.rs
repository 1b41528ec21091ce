//! The side of each triangle in a small cell on which the solid lies.
//!
//! The knowledge about whole triangles ([`Sides`](crate::mesh::Sides)) leaves out triangles that intersect
//! others somewhere, and all triangles of an open surface. In a cell in which no two triangles intersect, the
//! winding number in front of each triangle is constant within the cell. It is computed at one point in front
//! of the triangle, on the way there from a base.

use super::base::Base;
use super::local::{Polygon, Seen, View};
use crate::error::Error;
use crate::lattice::axes;
use crate::mesh::{FillRule, Sides};
use alloc::vec::Vec;

/// A triangle and its part in the cell.
struct Part {
    triangle: u32,
    seen: Seen,
    polygon: Polygon,
    sense: Option<i8>,
}

impl View<'_> {
    /// Returns on which side of each triangle of the cell the solid lies: 1 if only behind it, −1 if only in
    /// front of it, 0 if on both sides or on neither, or if the triangle does not reach into the cell. `None`
    /// if this stays undecided. O(n²).
    pub(super) fn senses(
        &self,
        sides: &Sides,
        base: &Base,
        fill: FillRule,
    ) -> Result<Option<Vec<i8>>, Error> {
        let mut parts = Vec::new();
        parts.try_reserve_exact(self.triangles.len())?;
        for &triangle in self.triangles {
            let seen = self.seen(triangle);
            let Some(polygon) = seen.clipped(1.0 + 4.0 * seen.slack()) else { return Ok(None) };
            let is_absent = polygon.points().is_empty();
            if sides.is_flat(triangle) && !is_absent {
                return Ok(None);
            }
            let sense = if is_absent { Some(0) } else { sides.of(triangle) };
            parts.push(Part { triangle, seen, polygon, sense });
        }
        if !are_apart(sides, &parts) {
            return Ok(None);
        }
        let mut senses = Vec::new();
        senses.try_reserve_exact(parts.len())?;
        for k in 0..parts.len() {
            let found = parts[k].sense.or_else(|| {
                let front = front(&parts, k, base)?;
                Some(fill.encloses(front + 1) as i8 - fill.encloses(front) as i8)
            });
            let Some(sense) = found else { return Ok(None) };
            senses.push(sense);
        }
        Ok(Some(senses))
    }
}

/// Returns whether surely no two triangles intersect in the cell.
fn are_apart(sides: &Sides, parts: &[Part]) -> bool {
    let mut unknown = parts.iter().enumerate().filter(|(_, part)| part.sense.is_none());
    unknown.all(|(k, a)| {
        parts[k + 1..].iter().all(|b| {
            b.sense.is_some() || !sides.is_pair(a.triangle, b.triangle) || a.is_beside(b) || b.is_beside(a)
        })
    })
}

impl Part {
    /// Returns whether the part of another triangle in the cell lies on one side of this one's plane.
    fn is_beside(&self, other: &Part) -> bool {
        let error = other.seen.slack();
        let mut sides = other.polygon.points().iter().map(|p| self.seen.side(p, error));
        let Some(first) = sides.next() else { return true };
        first != 0 && sides.all(|side| side == first)
    }
}

/// The winding number in front of a part. `None` if it stays undecided.
fn front(parts: &[Part], own: usize, base: &Base) -> Option<i32> {
    let part = &parts[own];
    let middle = part.polygon.middle();
    // The middle, and points towards three corners.
    let points = part.polygon.points();
    let tries = core::iter::once(middle)
        .chain(points.iter().take(3).map(|corner| axes(|k| 0.75 * middle[k] + 0.25 * corner[k])));
    tries.into_iter().find_map(|p| {
        if !p.iter().all(|x| x.abs() < 1.0) {
            return None;
        }
        let side = part.seen.side(&base.at, 0.0);
        if side == 0 {
            return None;
        }
        let others = (0..parts.len()).filter(|&k| k != own);
        let number = others
            .into_iter()
            .try_fold(base.winding, |sum, k| Some(sum + parts[k].seen.pierced(&base.at, &p)?))?;
        // A way that arrives from behind would still have to pass the triangle itself.
        Some(if side > 0 { number } else { number - 1 })
    })
}
