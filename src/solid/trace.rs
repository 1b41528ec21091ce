//! Where a ray goes in and out of a solid.

use crate::error::Error;
use crate::lattice::{Interval, Ray};
use crate::memory;
use crate::mesh::TriangleMesh;
use alloc::sync::Arc;
use alloc::vec::Vec;

/// Where a ray goes in and out of a solid.
///
/// The solid is a closed set. Beside its crossings a ray is either proven inside or proven outside, and
/// within the interval of a crossing it may be either.
#[derive(Debug, Clone, PartialEq)]
pub struct RayTrace {
    /// Whether the ray is inside until its first crossing.
    pub begins_inside: bool,
    /// Ascending; their intervals have no more than ends in common.
    pub crossings: Vec<RayCrossing>,
    /// Until when it is known. Nothing is known of later times.
    pub until: f64,
}

/// Where a ray crosses the boundary of a solid, or touches it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayCrossing {
    /// When.
    pub t: Interval,
    /// Whether the ray is inside from then on until the next crossing.
    pub is_inside_after: bool,
    /// Whether a point of the interval is proven to be inside: a crossing of which both sides are outside may
    /// be a touch.
    pub is_met: bool,
    /// The outward normal of the boundary there, of any length.
    pub normal: [f64; 3],
    /// The number of the surface: of a mesh, the triangle's.
    pub surface: Option<u32>,
}

impl RayTrace {
    /// Nothing is known.
    pub const UNKNOWN: RayTrace =
        RayTrace { begins_inside: false, crossings: Vec::new(), until: f64::NEG_INFINITY };

    /// Whether the ray is outside before and after a crossing, which may be a touch.
    pub(crate) fn has_touches(&self) -> bool {
        let mut before = self.begins_inside;
        self.crossings.iter().any(|crossing| {
            let is_touch = !before && !crossing.is_inside_after;
            before = crossing.is_inside_after;
            is_touch
        })
    }

    /// Forgets what is known.
    pub(crate) fn clear(&mut self) {
        self.crossings.clear();
        (self.begins_inside, self.until) = (false, f64::NEG_INFINITY);
    }

    /// Whether anything is known.
    pub fn is_known(&self) -> bool {
        self.until >= 0.0
    }

    /// The trace in what either of two solids holds, of both of which it is the same ray's.
    pub(crate) fn united(&self, other: &RayTrace) -> Result<RayTrace, Error> {
        let mut sides = [Side::new(self), Side::new(other)];
        let begins_inside = self.begins_inside || other.begins_inside;
        let until = self.until.min(other.until);
        let mut united = RayTrace { begins_inside, until, ..RayTrace::UNKNOWN };
        let mut open: Option<RayCrossing> = None;
        loop {
            // Of equal times, crossings begin before others end.
            let times = [0, 1].map(|k| (sides[k].time(), sides[k].is_within));
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
                    // What it began with may only be a touch.
                    let RayCrossing { normal, surface, .. } = if is_inside_after { crossing } else { begun };
                    united.push(RayCrossing { t, is_inside_after, is_met, normal, surface })?;
                    open = None;
                }
                _ => {}
            }
        }
    }

    /// The trace in the complement.
    pub(crate) fn complement(&mut self) {
        self.begins_inside = !self.begins_inside;
        let mut before = self.begins_inside;
        for crossing in &mut self.crossings {
            crossing.is_inside_after = !crossing.is_inside_after;
            // The complement is closed, too: it holds its limit points.
            crossing.is_met = before || crossing.is_inside_after;
            before = crossing.is_inside_after;
            crossing.normal = crossing.normal.map(|c| -c);
        }
    }

    /// Adds a crossing. One that begins before the last one ends goes on from there.
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
    /// Whether it is enough to know the trace until the ray is first proven inside.
    pub is_first_enough: bool,
    /// The trace, if it is known, as far as the ray runs in the cell.
    pub trace: &'q mut RayTrace,
}

/// The point of the boundary that is nearest to another one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestSurface {
    /// The distance, which is not negative.
    pub distance: Interval,
    /// On which side of the boundary the other point lies, if that is sure.
    pub is_inside: Option<bool>,
    /// The nearest point, or one that is hardly further away: a point of the surface but for rounding.
    pub point: [f64; 3],
    /// The number of the surface: of a mesh, the triangle's.
    pub surface: Option<u32>,
}

impl NearestSurface {
    pub(crate) fn complement(self) -> NearestSurface {
        NearestSurface { is_inside: self.is_inside.map(|is_inside| !is_inside), ..self }
    }
}

/// Triangles that the boundary of a solid consists of.
#[derive(Clone)]
pub struct BoundaryFacets {
    /// The triangles; its [`displacement`](TriangleMesh::displacement) is how far, along each axis, the
    /// boundary may lie from them.
    pub mesh: Arc<TriangleMesh>,
    /// Whether each triangle belongs to the boundary. Empty: all of them do.
    pub chosen: Vec<bool>,
}

/// Triangles that the boundary of a solid consists of but where triangles intersect, and pieces of these.
#[derive(Clone)]
pub struct BoundaryPieces {
    /// Triangles that belong to the boundary.
    pub facets: BoundaryFacets,
    /// Pieces of others that do. They have no vertices in common.
    pub sure: Vec<[[f64; 3]; 3]>,
    /// Pieces that may. All that is not among the facets or the pieces does not belong to the boundary.
    pub doubtful: Vec<[[f64; 3]; 3]>,
    /// How far pieces may lie beside the triangles of the mesh, in model units.
    pub rounding: f64,
}

/// How a box lies to a solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoxContent {
    /// Its interior is disjoint from the solid's.
    Empty,
    /// It lies in the solid.
    Full,
    /// Part of it lies inside, part outside.
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

/// How far one of two traces has been followed.
struct Side<'t> {
    trace: &'t RayTrace,
    next: usize,
    /// Whether the next crossing has begun.
    is_within: bool,
    /// Whether the ray is inside; nothing within a crossing.
    state: Option<bool>,
}

impl<'t> Side<'t> {
    fn new(trace: &'t RayTrace) -> Side<'t> {
        Side { trace, next: 0, is_within: false, state: Some(trace.begins_inside) }
    }

    /// When its state changes next.
    fn time(&self) -> f64 {
        self.trace.crossings.get(self.next).map_or(f64::INFINITY, |crossing| {
            if self.is_within { crossing.t.upper } else { crossing.t.lower }
        })
    }

    /// Changes its state, at the beginning or the end of a crossing.
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
