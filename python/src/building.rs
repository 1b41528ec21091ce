//! Building octrees.

use crate::arguments::{Depth, named, other_type};
use crate::ask::{self, FrameLike, Wish};
use crate::error::{OrRaise, refused};
use crate::frame::Frame;
use crate::octree::{DEPTH, Octree};
use crate::shards::Shard;
use crate::solid::{Given, given};
use crate::words;
use crate::work::Limits;
use leafless::{Rule, SurfaceOptions, build_extended, op};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Reads the parameter `surfaces`.
fn kept_surfaces(surfaces: Option<&Bound<'_, PyAny>>) -> PyResult<Option<SurfaceOptions>> {
    let Some(kept) = surfaces else { return Ok(None) };
    if let Ok(all) = kept.extract::<bool>() {
        return Ok(all.then_some(SurfaceOptions { tolerance: None }));
    }
    match kept.extract::<f64>() {
        Ok(thick) if thick.is_finite() && thick > 0.0 => Ok(Some(SurfaceOptions { tolerance: Some(thick) })),
        Ok(thick) => Err(refused(kept.py(), "surfaces", format!("must be a positive length, not {thick}"))),
        Err(_) => Err(other_type(kept, "surfaces", "True, False or a number")),
    }
}

/// Returns the frame for building an octree.
fn frame_for(
    py: Python<'_>,
    solid: &Given,
    wish: Wish,
    surfaces: Option<&SurfaceOptions>,
) -> PyResult<leafless::Frame> {
    let deepest = match surfaces {
        // A given frame has a depth of its own.
        Some(options) if wish.frame.is_none() => {
            options.frame(&ask::bounds(py, solid)?).or_raise(py)?.depth()
        }
        _ => DEPTH,
    };
    wish.of(py, solid, deepest)
}

/// Returns the frame that `build` would use for a `solid` with the same `frame`, `depth` and `surfaces`.
#[pyfunction]
#[pyo3(signature = (solid, frame=None, *, depth=None, surfaces=None))]
pub fn frame_of(
    solid: &Bound<'_, PyAny>,
    frame: Option<FrameLike>,
    #[pyo3(from_py_with = named::depth)] depth: Option<Depth>,
    surfaces: Option<&Bound<'_, PyAny>>,
) -> PyResult<Frame> {
    let py = solid.py();
    let solid = given(solid, "solid")?;
    frame_for(py, &solid, Wish { frame, depth }, kept_surfaces(surfaces)?.as_ref()).map(Frame)
}

/// Builds an octree of a `solid`: cells are split until they are decided, or the frame's depth is reached.
///
/// `rule` decides the cells that are undecided at the finest level. "certified" keeps the doubt, so every
/// answer is proven. "sampled" evaluates the solid at the centres of the cells. "inner" makes undecided cells
/// EMPTY, "outer" makes them FULL.
///
/// `surfaces=True` keeps the surfaces that cross undecided cells. For an expression these surfaces are exact:
/// the octree is small, and as exact as the solid. For a mesh, a number keeps layers around the surface
/// instead, at most that thick (model units).
///
/// `frame` is a `Frame`, or an octree on that frame. Without it, the frame is a cube around the solid.
/// `depth` replaces the frame's depth. A cube around the solid has the depth 9 by default.
///
/// With a `shard` (a `leafless.shards.Shard`), only the cells of the shard are built. All other cells are
/// PARTIAL.
///
/// >>> block = build(Csg.cuboid([0, 0, 0], [3, 2, 1]), depth=5)
/// >>> block.volume, bool(block.proof)
/// (6, True)
#[pyfunction]
#[pyo3(signature = (solid, frame=None, *, depth=None, rule="certified", surfaces=None, shard=None, **limits))]
pub fn build<'py>(
    solid: &Bound<'py, PyAny>,
    frame: Option<FrameLike>,
    #[pyo3(from_py_with = named::depth)] depth: Option<Depth>,
    #[pyo3(from_py_with = named::rule)] rule: &str,
    surfaces: Option<&Bound<'py, PyAny>>,
    #[pyo3(from_py_with = named::shard)] shard: Option<Bound<'py, Shard>>,
    limits: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, Octree>> {
    let py = solid.py();
    let limits = Limits::of(limits)?;
    let rule: Rule = words::value(py, rule)?;
    let solid = given(solid, "solid")?;
    let surfaces = kept_surfaces(surfaces)?;
    let frame = frame_for(py, &solid, Wish { frame, depth }, surfaces.as_ref())?;
    if surfaces.is_some() && rule != Rule::Certified {
        return Err(refused(py, "rule", "must be 'certified' with surfaces, which decide what cells do not"));
    }
    let shard = shard.map(|shard| shard.get().0);
    let octree = limits.run(py, |control| match (&surfaces, shard) {
        (Some(options), None) => build_extended(&solid.shape, &frame, options, control),
        (Some(options), Some(shard)) => {
            op::build_extended_shard(&solid.shape, &frame, options, shard, control)
        }
        (None, None) => leafless::build(&solid.shape, &frame, rule, control),
        (None, Some(shard)) => leafless::build_shard(&solid.shape, &frame, rule, shard, control),
    })?;
    Octree::bound(py, octree)
}
