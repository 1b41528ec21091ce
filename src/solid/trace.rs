//! Rays, nearest points and boxes against a solid, without cells.

use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Interval, Ray};
use crate::memory;
use crate::mesh::TriangleMesh;
use alloc::sync::Arc;
use alloc::vec::Vec;

/// The crossings of a ray with the boundary of a solid.
///
/// The solid is a closed set. Between its crossings the ray is proven inside or proven outside. Within the
/// interval of a crossing it may be either.
#[derive(Debug, Clone, PartialEq)]
pub struct RayTrace {
    /// Whether the ray is inside until its first crossing.
    pub begins_inside: bool,
    /// The crossings in ascending order. Their intervals share no more than end points.
    pub crossings: Vec<RayCrossing>,
    /// The end of the time range in which the trace is known. Nothing is known of later times.
    pub until: f64,
}

/// A crossing of a ray with the boundary of a solid, or a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayCrossing {
    /// The time of the crossing.
    pub t: Interval,
    /// Whether the ray is inside between this crossing and the next.
    pub is_inside_after: bool,
    /// Whether a point of the interval is proven to be inside: a crossing with both sides outside may be a
    /// contact.
    pub is_met: bool,
    /// The outward normal of the boundary there, of any length.
    pub normal: [f64; 3],
    /// The number of the surface; for a mesh, the number of the triangle.
    pub surface: Option<u32>,
}

impl RayTrace {
    /// The trace of which nothing is known.
    pub const UNKNOWN: RayTrace =
        RayTrace { begins_inside: false, crossings: Vec::new(), until: f64::NEG_INFINITY };

    /// Returns whether the ray is outside before and after some crossing, which may be a contact.
    pub(crate) fn has_touches(&self) -> bool {
        let mut before = self.begins_inside;
        self.crossings.iter().any(|crossing| {
            let is_touch = !before && !crossing.is_inside_after;
            before = crossing.is_inside_after;
            is_touch
        })
    }

    /// Resets the trace to unknown.
    pub(crate) fn clear(&mut self) {
        self.crossings.clear();
        (self.begins_inside, self.until) = (false, f64::NEG_INFINITY);
    }

    /// Returns whether anything is known.
    pub fn is_known(&self) -> bool {
        self.until >= 0.0
    }

    /// The trace of the same ray in the union of two solids.
    pub(crate) fn united(&self, other: &RayTrace) -> Result<RayTrace, Error> {
        let mut sides = [Side::new(self), Side::new(other)];
        let begins_inside = self.begins_inside || other.begins_inside;
        let until = self.until.min(other.until);
        let mut united = RayTrace { begins_inside, until, ..RayTrace::UNKNOWN };
        let mut open: Option<RayCrossing> = None;
        loop {
            // At equal times, crossings begin before others end.
            let times = [0, 1].each(|k| (sides[k].time(), sides[k].is_within));
            let k = usize::from(times[1] < times[0]);
            let Some(crossing) = sides[k].advance() else { return Ok(united) };
            let state = match [sides[0].state, sides[1].state] {
                [Some(true), _] | [_, Some(true)] => Some(true),
                [Some(false), Some(false)] => Some(false),
                _ => None,
            };
            let t = times[k].0;
            match (state, open) {
                (None, None) => open = Some(RayCrossing { t: Interval::exactly(t), ..crossing }),
                (None, Some(begun)) => {
                    open = Some(RayCrossing { is_met: begun.is_met || crossing.is_met, ..begun });
                }
                (Some(is_inside_after), Some(begun)) => {
                    let t = Interval::between(begun.t.lower, t);
                    let is_met = begun.is_met || crossing.is_met || is_inside_after;
                    // The crossing that began the interval may only be a contact.
                    let RayCrossing { normal, surface, .. } = if is_inside_after { crossing } else { begun };
                    united.push(RayCrossing { t, is_inside_after, is_met, normal, surface })?;
                    open = None;
                }
                _ => {}
            }
        }
    }

    /// Turns the trace into that of the complement.
    pub(crate) fn complement(&mut self) {
        self.begins_inside = !self.begins_inside;
        let mut before = self.begins_inside;
        for crossing in &mut self.crossings {
            crossing.is_inside_after = !crossing.is_inside_after;
            // The complement is closed, too: it contains its limit points.
            crossing.is_met = before || crossing.is_inside_after;
            before = crossing.is_inside_after;
            crossing.normal = crossing.normal.each(|c| -c);
        }
    }

    /// Appends a crossing. A crossing that begins before the last one ends is moved to that end.
    pub(crate) fn push(&mut self, crossing: RayCrossing) -> Result<(), Error> {
        let last = self.crossings.last().map_or(f64::NEG_INFINITY, |last| last.t.upper);
        let t = Interval::between(crossing.t.lower.max(last), crossing.t.upper.max(last));
        memory::push(&mut self.crossings, RayCrossing { t, ..crossing })
    }
}

/// A question about a ray, with the place for its answer.
pub struct RayQuestion<'q> {
    /// The ray.
    pub ray: &'q Ray,
    /// Whether the trace may end where the ray is first proven inside.
    pub is_first_enough: bool,
    /// The trace along the ray's way through the cell, if it is known.
    pub trace: &'q mut RayTrace,
}

/// The point of the boundary that is nearest to a query point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestSurface {
    /// The distance, which is not negative.
    pub distance: Interval,
    /// The side of the boundary on which the query point lies, if that is certain.
    pub is_inside: Option<bool>,
    /// The nearest point, or one that is hardly further away. It lies on the surface up to rounding.
    pub point: [f64; 3],
    /// The number of the surface; for a mesh, the number of the triangle.
    pub surface: Option<u32>,
}

impl NearestSurface {
    pub(crate) fn complement(self) -> NearestSurface {
        NearestSurface { is_inside: self.is_inside.map(|is_inside| !is_inside), ..self }
    }
}

/// Triangles that make up the boundary of a solid.
#[derive(Clone)]
pub struct BoundaryFacets {
    /// The triangles. The [`displacement`](TriangleMesh::displacement) of the mesh bounds, for each axis, how
    /// far the boundary may lie from the triangles.
    pub mesh: Arc<TriangleMesh>,
    /// For each triangle, whether it belongs to the boundary. Empty means that all triangles do.
    pub chosen: Vec<bool>,
}

/// The boundary of a solid as whole triangles, and as pieces of triangles where triangles intersect.
#[derive(Clone)]
pub struct BoundaryPieces {
    /// Triangles that belong to the boundary.
    pub facets: BoundaryFacets,
    /// Pieces of other triangles that belong to the boundary. Pieces share no vertices.
    pub sure: Vec<[[f64; 3]; 3]>,
    /// Pieces that may belong to the boundary. Everything outside the facets and the pieces does not belong
    /// to it.
    pub doubtful: Vec<[[f64; 3]; 3]>,
    /// The greatest distance of pieces from the triangles of the mesh, in model units.
    pub rounding: f64,
}

/// The position of a box relative to a solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoxContent {
    /// The interiors of the box and the solid are disjoint.
    Empty,
    /// The box lies in the solid.
    Full,
    /// Part of the box lies inside, part outside.
    Both,
}

impl BoxContent {
    pub(crate) fn complement(self) -> BoxContent {
        match self {
            BoxContent::Empty => BoxContent::Full,
            BoxContent::Full => BoxContent::Empty,
            BoxContent::Both => BoxContent::Both,
        }
    }
}

/// A cursor in one of two traces.
struct Side<'t> {
    trace: &'t RayTrace,
    next: usize,
    /// Whether the next crossing has begun.
    is_within: bool,
    /// Whether the ray is inside; `None` within a crossing.
    state: Option<bool>,
}

impl<'t> Side<'t> {
    fn new(trace: &'t RayTrace) -> Side<'t> {
        Side { trace, next: 0, is_within: false, state: Some(trace.begins_inside) }
    }

    /// The time of its next change of state.
    fn time(&self) -> f64 {
        self.trace.crossings.get(self.next).map_or(f64::INFINITY, |crossing| {
            if self.is_within { crossing.t.upper } else { crossing.t.lower }
        })
    }

    /// Advances to the beginning or the end of the next crossing.
    fn advance(&mut self) -> Option<RayCrossing> {
        let crossing = *self.trace.crossings.get(self.next)?;
        if self.is_within {
            self.state = Some(crossing.is_inside_after);
            self.next += 1;
        } else {
            self.state = None;
        }
        self.is_within = !self.is_within;
        Some(crossing)
    }
}
