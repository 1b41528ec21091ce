//! The frame that a question uses by default.

use crate::arguments::{Deep, Depth, other_type};
use crate::error::{OrRaise, refused};
use crate::frame::Frame;
use crate::octree::Octree;
use crate::solid::Given;
use leafless::lattice::MAX_DEPTH;
use leafless::{Affine, Bounds, Error, Frame as Inner};
use pyo3::Borrowed;
use pyo3::prelude::*;

/// A frame, given as such or by an octree that has it.
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

/// What a caller says of the frame.
#[derive(Clone, Copy, Default)]
pub struct Wish {
    /// The frame.
    pub frame: Option<FrameLike>,
    /// Its depth.
    pub depth: Option<Depth>,
}

impl Wish {
    /// The frame that is given, as deep as is wished.
    fn given(&self, py: Python<'_>) -> PyResult<Option<Inner>> {
        let Some(FrameLike(frame)) = self.frame else { return Ok(None) };
        self.depth.map_or(Ok(frame), |Deep(depth)| frame.with_depth(depth)).or_raise(py).map(Some)
    }

    /// The frame that is given where there is no solid to ask for one.
    pub fn alone(&self, py: Python<'_>) -> PyResult<Inner> {
        self.given(py)?.ok_or_else(|| refused(py, "frame", "must be given without a solid"))
    }

    /// The frame to ask a solid on: the wished one, that of an octree or of a volume's voxels, or one around
    /// the solid, which is `deepest` deep where nothing limits the depth.
    pub fn of(&self, py: Python<'_>, solid: &Given, deepest: u8) -> PyResult<Inner> {
        if let Some(frame) = self.given(py)? {
            return Ok(frame);
        }
        let deepest = self.depth.map_or(deepest, |Deep(depth)| depth);
        match solid.own {
            // Cells that keep surfaces are large, and say little.
            Some(own) if solid.keeps_surfaces => own.with_depth(deepest).or_raise(py),
            Some(own) => {
                let own = self.depth.map_or(Ok(own), |Deep(depth)| own.with_depth(depth)).or_raise(py)?;
                // An expression may reach beyond the octree in it.
                solid.bounds(py).map_or(Ok(own), |all| doubled(own, &all)).or_raise(py)
            }
            None => fitted(py, &bounds(py, solid)?, deepest),
        }
    }

    /// The frame to ask two solids on, the second under placements: of one of them its own, as often doubled
    /// as it takes, or one around both.
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

/// A box that holds a solid, or all that is known of it.
pub fn bounds(py: Python<'_>, solid: &Given) -> PyResult<Bounds> {
    match (solid.bounds(py), solid.own) {
        (Some(bounds), _) => Ok(bounds),
        (None, Some(own)) => Ok(Bounds::of(&own)),
        (None, None) => Err(refused(py, "frame", "must be given: no bounds of the solid are known")),
    }
}

/// Most doublings of a frame.
const DOUBLINGS: u32 = 64;

/// A frame doubled until it holds a box: its cells stay whole, as long as there is a depth for them.
fn doubled(mut frame: Inner, all: &Bounds) -> Result<Inner, Error> {
    for _ in 0..DOUBLINGS {
        // (The bounds of an octree are those of its frame, rounded outward.)
        if *all == Bounds::of(&frame) || all.is_within(&frame) {
            break;
        }
        let (origin, edge) = (frame.origin(), frame.edge());
        // Towards the side where more is missing.
        let grown = [0, 1, 2].map(|axis| {
            let above = all.max[axis] - (origin[axis] + edge) >= origin[axis] - all.min[axis];
            if above { origin[axis] } else { origin[axis] - edge }
        });
        frame = Inner::new(grown, 2.0 * edge, (frame.depth() + 1).min(MAX_DEPTH))?;
    }
    Ok(frame)
}
