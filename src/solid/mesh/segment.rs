//! The first crossing of a segment with the boundary of a mesh's solid.
//!
//! The winding number at the segment's start is computed on the way from a base. From there on, it changes at
//! each triangle that the segment passes through. The boundary is where the fill rule's answer changes. Error
//! bounds decide whether the segment passes through a triangle. Where this stays unsure, as next to edges of
//! triangles, there is no answer.

use super::local::{Point, UNIT, View, cross, dot, minus};
use crate::lattice::Each;
use crate::mesh::FillRule;
use crate::solid::{Crossing, Segment};

/// A segment that passes through more triangles than this in one cell gets no answer.
const MOST: usize = 16;

/// A triangle that a segment passes through.
#[derive(Clone, Copy)]
struct Hit {
    t: f64,
    /// The change of the winding number.
    step: i32,
    normal: Point,
}

impl View<'_> {
    /// Returns where a segment in the cell first crosses the boundary. `None` if it does not, or if this is
    /// unsure.
    pub(super) fn first_crossing(&self, segment: &Segment, fill: FillRule) -> Option<Crossing> {
        let base = self.base()?;
        let [from, to] = [segment.from, segment.to].each(|p| self.local(p));
        // The error of the ends: two roundings of lattice coordinates, and one here. Where the surface may
        // deviate from the mesh, the segment passes through it if the mesh's crossing is that far from the
        // triangle's edges.
        let frame = &self.placed.frame;
        let error = 4.0 * UNIT * f64::from(frame.cells()) * self.scale() + 2.0 * self.displacement();
        let mut winding = base.winding;
        let mut hits = [Hit { t: f64::INFINITY, step: 0, normal: [0.0; 3] }; MOST];
        let mut count = 0;
        for &triangle in self.triangles {
            let mut seen = self.seen(triangle);
            seen.error += error;
            winding += seen.pierced(&base.at, &from)?;
            let step = seen.pierced(&from, &to)?;
            if step != 0 {
                // Computed in model space, so that the bits do not depend on the cell.
                let [a, b, c] = self.placed.original(triangle);
                let normal = cross(&minus(&b, &a), &minus(&c, &a));
                let way = dot(&normal, &minus(&segment.to, &segment.from));
                let t = dot(&normal, &minus(&a, &segment.from)) / way;
                if !t.is_finite() {
                    return None;
                }
                *hits.get_mut(count)? = Hit { t: t.clamp(0.0, 1.0), step, normal };
                count += 1;
            }
        }
        let hits = &mut hits[..count];
        hits.sort_unstable_by(|a, b| a.t.total_cmp(&b.t));
        for hit in hits {
            let before = fill.encloses(winding);
            winding += hit.step;
            if fill.encloses(winding) != before {
                // A way that leaves the solid through the back of a triangle leaves along the triangle's
                // normal.
                let is_along = hit.step < 0;
                let normal = if is_along == before { hit.normal } else { hit.normal.each(|n| -n) };
                return Some(Crossing { t: hit.t, normal });
            }
        }
        None
    }

    /// A point of model space in the coordinates of the cell.
    fn local(&self, p: Point) -> Point {
        let half = f64::from(self.size) / 2.0;
        core::array::from_fn(|axis| {
            (self.placed.frame.scaled(axis, p[axis]) - (f64::from(self.at[axis]) + half)) * self.scale()
        })
    }
}
