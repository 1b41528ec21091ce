//! Solids that are prepared for comparison with each other under any placement.

use super::facets::Boundary;
use super::search::Goal;
use super::{Clearance, Moved};
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::{Affine, Bounds, Frame, MAX_DEPTH};
use crate::solid::{AnyClassifier, AnySolid, Classifier, Solid, Transform};
use crate::walk::Proven;

/// A bounded solid, on a frame of its own and on a frame that holds its possible neighbours.
pub(crate) struct Ready {
    solid: AnySolid,
    bounds: Bounds,
    own: Frame,
    moved: Proven<AnyClassifier<'static>>,
    fixed: Proven<AnyClassifier<'static>>,
    boundary: Option<Boundary>,
}

/// The query about two solids.
#[derive(Clone, Copy)]
pub(crate) enum Asked {
    /// Whether the solids are at least so far apart (model units), as
    /// [`gap_at_least`](crate::query::gap_at_least) determines it.
    AtLeast(f64),
    /// The distance of the solids, within an interval no wider than `tolerance`, unless the distance is at
    /// least `below` (model units), as [`clearance`](crate::clearance) determines it.
    Distance { tolerance: f64, below: f64 },
}

impl Ready {
    /// Prepares a solid. Other solids are compared in the universe of `frame`, which should hold the possible
    /// neighbours. Complexity: O(t) for a mesh with t triangles, and the cost of putting the solid on frames.
    pub(crate) fn new(
        solid: &AnySolid,
        bounds: &Bounds,
        frame: &Frame,
        control: &Control<'_>,
    ) -> Result<Ready, Error> {
        // (A stored octree exists only on its own frame.)
        let (own, moved, fixed) = match solid.home() {
            Some(home) => {
                let around = AnySolid::new(Transform::of(solid.clone(), &Affine::IDENTITY));
                (home, solid.on(&home, control)?, around.on(frame, control)?)
            }
            None => {
                let on = solid.on(frame, control)?;
                (*frame, on.clone(), on)
            }
        };
        let (moved, fixed) = (Proven(moved), Proven(fixed));
        let boundary = Boundary::of(&moved, control)?;
        Ok(Ready { solid: solid.clone(), bounds: *bounds, own, moved, fixed, boundary })
    }

    pub(crate) fn solid(&self) -> &AnySolid {
        &self.solid
    }

    /// The bounding box.
    pub(crate) fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// Returns the clearance between this solid and another one under a placement, without the depth of an
    /// overlap.
    pub(crate) fn compared(
        &self,
        other: &Ready,
        placement: &Affine,
        asked: Asked,
        control: &Control<'_>,
    ) -> Result<Clearance, Error> {
        let wanted = match asked {
            Asked::AtLeast(least) => Goal::AtLeast(least),
            Asked::Distance { tolerance, below } => Goal::Width { tolerance, below },
        };
        let boundaries = self.boundary.as_ref().zip(other.boundary.as_ref()).map(|(a, b)| [a, b]);
        let moved = Moved::new(&other.solid, &other.own, &other.moved, control)?;
        let moved = Moved { is_clipped: false, asks_depth: false, ..moved };
        let job = &Job::new(control);
        if boundaries.is_none()
            && let Some(around) = other.bounds.placed(placement)
            && !around.is_within(self.fixed.frame())
        {
            // (Solids that far away are rarely compared.)
            let both = self.bounds.hull(&around);
            let frame = Frame::fitted(both.min, both.max, MAX_DEPTH)?;
            let far = Ready::new(&self.solid, &self.bounds, &frame, control)?;
            return moved.apart_from(&far.fixed, None, placement, wanted, job);
        }
        moved.apart_from(&self.fixed, boundaries, placement, wanted, job)
    }
}
