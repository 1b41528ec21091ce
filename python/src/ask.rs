//! The choice of the frame of a query.

use crate::arguments::{Deep, Depth, other_type};
use crate::error::{OrRaise, refused};
use crate::frame::Frame;
use crate::octree::Octree;
use crate::solid::Given;
use leafless::lattice::MAX_DEPTH;
use leafless::{Affine, Bounds, Error, Frame as Inner};
use pyo3::Borrowed;
use pyo3::prelude::*;

/// A frame, given directly or as an octree on the frame.
#[derive(Clone, Copy)]
pub struct FrameLike(pub Inner);

impl<'a, 'py> FromPyObject<'a, 'py> for FrameLike {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<FrameLike> {
        match given.cast::<Octree>() {
            Ok(octree) => Ok(FrameLike(*octree.get().octree.frame())),
            Err(_) => match given.cast::<Frame>() {
                Ok(frame) => Ok(FrameLike(frame.get().0)),
                Err(_) => Err(other_type(&given, "frame", "a Frame or an Octree")),
            },
        }
    }
}

/// The caller's wishes about the frame.
#[derive(Clone, Copy, Default)]
pub struct Wish {
    /// The frame.
    pub frame: Option<FrameLike>,
    /// The depth, in place of the frame's own.
    pub depth: Option<Depth>,
}

impl Wish {
    /// Returns the given frame, with the wished depth.
    fn given(&self, py: Python<'_>) -> PyResult<Option<Inner>> {
        let Some(FrameLike(frame)) = self.frame else { return Ok(None) };
        self.depth.map_or(Ok(frame), |Deep(depth)| frame.with_depth(depth)).or_raise(py).map(Some)
    }

    /// Returns the given frame, which is required when there is no solid.
    pub fn alone(&self, py: Python<'_>) -> PyResult<Inner> {
        self.given(py)?.ok_or_else(|| refused(py, "frame", "must be given without a solid"))
    }

    /// Returns the frame for queries of one solid: the wished frame, the frame of an octree or of a volume's
    /// voxels, or a frame around the solid. The depth is `deepest` if nothing limits it.
    pub fn of(&self, py: Python<'_>, solid: &Given, deepest: u8) -> PyResult<Inner> {
        if let Some(frame) = self.given(py)? {
            return Ok(frame);
        }
        let deepest = self.depth.map_or(deepest, |Deep(depth)| depth);
        match solid.own {
            // Cells that keep surfaces are large and carry little information alone.
            Some(own) if solid.keeps_surfaces => own.with_depth(deepest).or_raise(py),
            Some(own) => {
                let own = self.depth.map_or(Ok(own), |Deep(depth)| own.with_depth(depth)).or_raise(py)?;
                // An expression may reach beyond the octree that it contains.
                solid.bounds(py).map_or(Ok(own), |all| doubled(own, &all)).or_raise(py)
            }
            None => fitted(py, &bounds(py, solid)?, deepest),
        }
    }

    /// Returns the frame for queries of two solids, the second under placements: the frame of the first
    /// solid, doubled as often as necessary, or a frame around both.
    pub fn of_both(
        &self,
        py: Python<'_>,
        [a, b]: [&Given; 2],
        placements: &[Affine],
        deepest: u8,
    ) -> PyResult<Inner> {
        if let Some(frame) = self.given(py)? {
            return Ok(frame);
        }
        let deepest = self.depth.map_or(deepest, |Deep(depth)| depth);
        let (mut all, second) = (bounds(py, a)?, bounds(py, b)?);
        for placement in placements {
            let Some(moved) = second.placed(placement) else {
                return Err(refused(py, "placements", "must not move the solid beyond the doubles"));
            };
            all = all.hull(&moved);
        }
        match a.own {
            Some(own) => {
                let own =
                    if a.keeps_surfaces || self.depth.is_some() { own.with_depth(deepest) } else { Ok(own) };
                own.and_then(|own| doubled(own, &all)).or_raise(py)
            }
            None => fitted(py, &all, deepest),
        }
    }
}

fn fitted(py: Python<'_>, Bounds { min, max }: &Bounds, depth: u8) -> PyResult<Inner> {
    Inner::fitted(*min, *max, depth).or_raise(py)
}

/// Returns a box that contains a solid: its bounds if they are known, else its frame.
pub fn bounds(py: Python<'_>, solid: &Given) -> PyResult<Bounds> {
    match (solid.bounds(py), solid.own) {
        (Some(bounds), _) => Ok(bounds),
        (None, Some(own)) => Ok(Bounds::of(&own)),
        (None, None) => Err(refused(py, "frame", "must be given: no bounds of the solid are known")),
    }
}

/// The maximum number of doublings of a frame.
const DOUBLINGS: u32 = 64;

/// Doubles a frame until it contains a box. Cells stay whole, as long as the depth can grow.
fn doubled(mut frame: Inner, all: &Bounds) -> Result<Inner, Error> {
    for _ in 0..DOUBLINGS {
        // The bounds of an octree are the bounds of its frame, rounded outward.
        if *all == Bounds::of(&frame) || all.is_within(&frame) {
            break;
        }
        let (origin, edge) = (frame.origin(), frame.edge());
        // Grow towards the side where more is missing.
        let grown = [0, 1, 2].map(|axis| {
            let above = all.max[axis] - (origin[axis] + edge) >= origin[axis] - all.min[axis];
            if above { origin[axis] } else { origin[axis] - edge }
        });
        frame = Inner::new(grown, 2.0 * edge, (frame.depth() + 1).min(MAX_DEPTH))?;
    }
    Ok(frame)
}
