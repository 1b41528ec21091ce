//! Measures of a solid: volume, centroid, inertia, area and bounding box, as intervals that contain the
//! truth.

use crate::arguments::{Depth, named};
use crate::ask::{FrameLike, Wish};
use crate::error::refused;
use crate::from_package;
use crate::interval::{Interval, intervals};
use crate::octree::Proof;
use crate::solid::given;
use crate::words;
use crate::work::Limits;
use leafless::Tolerance;
use leafless::lattice::MAX_DEPTH;
use leafless::query;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Returns the tolerance for the width of an interval.
pub fn wanted(py: Python<'_>, relative: f64, absolute: f64) -> PyResult<Tolerance> {
    if absolute.is_nan() || absolute < 0.0 {
        return Err(refused(
            py,
            "absolute",
            format!("must be a number that is not negative, not {absolute}"),
        ));
    }
    Ok(Tolerance { relative, absolute })
}

/// Measures volume, centroid and inertia of a `solid`. It ends when the width of the volume's interval is at
/// most `tolerance` times the volume, or at most `absolute` (cubic model units). A closed mesh without
/// intersecting triangles is measured to rounding at once.
///
/// `frame` is the cube of the query: a `Frame`, or an octree on that frame. Without it, it is a cube around
/// the solid. `depth` replaces the depth of the frame.
///
/// >>> found = measure(Csg.ball([0, 0, 0], 1), tolerance=1e-6)
/// >>> 4.18879020478639 in found.volume, 0.0 in found.centroid[2]
/// (True, True)
#[pyfunction]
#[pyo3(signature = (solid, *, tolerance=1e-3, absolute=0.0, frame=None, depth=None, **limits))]
pub fn measure<'py>(
    solid: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = named::tolerance)] tolerance: f64,
    #[pyo3(from_py_with = named::absolute)] absolute: f64,
    frame: Option<FrameLike>,
    #[pyo3(from_py_with = named::depth)] depth: Option<Depth>,
    limits: Option<&Bound<'_, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let (py, limits) = (solid.py(), Limits::of(limits)?);
    let solid = given(solid, "solid")?;
    let frame = Wish { frame, depth }.of(py, &solid, MAX_DEPTH)?;
    let tolerance = wanted(py, tolerance, absolute)?;
    told(py, &limits.run(py, |control| query::measure(&solid.shape, &frame, tolerance, control))?)
}

/// Converts mass properties to Python.
pub fn told<'py>(py: Python<'py>, found: &query::MassProperties) -> PyResult<Bound<'py, PyAny>> {
    from_package!(py, "leafless._answers", "MassProperties")?.call1((
        Interval(found.volume),
        found.centroid.map(|centroid| intervals(py, centroid, &[3])).transpose()?,
        intervals(py, found.inertia_about_origin.into_iter().flatten(), &[3, 3])?,
        intervals(py, found.inertia_about_centroid.into_iter().flatten(), &[3, 3])?,
        found.exact,
        found.clipped,
        Proof::from(found.proof),
        words::word(found.stop_reason),
        found.splits,
    ))
}

/// Measures the area of the boundary of a `solid`. It ends when the width of the interval is at most
/// `tolerance` times the area, or at most `absolute` (square model units).
///
/// `frame` is the cube of the query: a `Frame`, or an octree on that frame. Without it, it is a cube around
/// the solid. `depth` replaces the depth of the frame.
///
/// >>> 12.566370614359172 in surface_area(Csg.ball([0, 0, 0], 1), tolerance=0.01).area
/// True
#[pyfunction]
#[pyo3(signature = (solid, *, tolerance=1e-2, absolute=0.0, frame=None, depth=None, **limits))]
pub fn surface_area<'py>(
    solid: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = named::tolerance)] tolerance: f64,
    #[pyo3(from_py_with = named::absolute)] absolute: f64,
    frame: Option<FrameLike>,
    #[pyo3(from_py_with = named::depth)] depth: Option<Depth>,
    limits: Option<&Bound<'_, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let (py, limits) = (solid.py(), Limits::of(limits)?);
    let solid = given(solid, "solid")?;
    let frame = Wish { frame, depth }.of(py, &solid, MAX_DEPTH)?;
    let tolerance = wanted(py, tolerance, absolute)?;
    let found = limits.run(py, |control| query::surface_area(&solid.shape, &frame, tolerance, control))?;
    let answer = from_package!(py, "leafless._answers", "SurfaceArea")?;
    answer.call1((Interval(found.area), found.clipped, words::word(found.stop_reason), found.splits))
}

/// Returns the bounding box of a `solid`. Each side is known to `tolerance` (model units; the default is a
/// millionth of the frame's edge).
///
/// `frame` is the cube of the query: a `Frame`, or an octree on that frame. Without it, it is a cube around
/// the solid. `depth` replaces the depth of the frame.
///
/// >>> box = bounding_box(Csg.ball([0, 0, 0], 1))
/// >>> 1.0 in box.corners[1, 0]
/// True
#[pyfunction]
#[pyo3(signature = (solid, *, tolerance=None, frame=None, depth=None, **limits))]
pub fn bounding_box<'py>(
    solid: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = named::tolerance)] tolerance: Option<f64>,
    frame: Option<FrameLike>,
    #[pyo3(from_py_with = named::depth)] depth: Option<Depth>,
    limits: Option<&Bound<'_, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let (py, limits) = (solid.py(), Limits::of(limits)?);
    let solid = given(solid, "solid")?;
    let frame = Wish { frame, depth }.of(py, &solid, MAX_DEPTH)?;
    let tolerance = tolerance.unwrap_or(1e-6 * frame.edge());
    let found = limits.run(py, |control| query::bounding_box(&solid.shape, &frame, tolerance, control))?;
    from_package!(py, "leafless._answers", "BoundingBox")?.call1((
        found.corners.map(|corners| intervals(py, corners.into_iter().flatten(), &[2, 3])).transpose()?,
        found.occupied,
        found.clipped,
        words::word(found.stop_reason),
        found.splits,
    ))
}
