//! Volumes, areas and boxes, as intervals that contain the truth.

use crate::arguments::{Depth, named};
use crate::ask::{FrameLike, Wish};
use crate::error::refused;
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

/// Volume, centroid and inertia of a solid.
#[pyclass(frozen, module = "leafless")]
pub struct MassProperties(query::MassProperties);

#[pymethods]
impl MassProperties {
    /// The volume (cubic model units).
    #[getter]
    fn volume(&self) -> Interval {
        Interval(self.0.volume)
    }

    /// The centroid: `Intervals` of shape (3,); `None` if the solid may be empty.
    #[getter]
    fn centroid<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.0.centroid.map(|centroid| intervals(py, centroid, &[3])).transpose()
    }

    /// The inertia tensor about the origin, of density 1: `Intervals` of shape (3, 3).
    #[getter]
    fn inertia_about_origin<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        intervals(py, self.0.inertia_about_origin.into_iter().flatten(), &[3, 3])
    }

    /// The inertia tensor about the centroid, of density 1: `Intervals` of shape (3, 3).
    #[getter]
    fn inertia_about_centroid<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        intervals(py, self.0.inertia_about_centroid.into_iter().flatten(), &[3, 3])
    }

    /// Whether nothing is in doubt but rounding.
    #[getter]
    fn exact(&self) -> bool {
        self.0.exact
    }

    /// Whether the solid may go on beyond the frame.
    #[getter]
    fn clipped(&self) -> bool {
        self.0.clipped
    }

    /// What of the solid is proven.
    #[getter]
    fn proof(&self) -> Proof {
        self.0.proof.into()
    }

    /// Why it ended: "tolerance", "budget" or "exhausted".
    #[getter]
    fn stop_reason(&self) -> &'static str {
        words::word(self.0.stop_reason)
    }

    /// How many times a cell was split.
    #[getter]
    fn splits(&self) -> u64 {
        self.0.splits
    }

    fn __repr__(&self) -> String {
        let centroid = self.0.centroid.map(|at| at.map(|x| x.to_string()).join(", "));
        let centroid = centroid.unwrap_or_else(|| "unknown".into());
        format!("<MassProperties: volume {}, centroid ({centroid})>", self.0.volume)
    }
}

/// The area of a solid's boundary.
#[pyclass(frozen, module = "leafless")]
pub struct SurfaceArea(query::SurfaceArea);

#[pymethods]
impl SurfaceArea {
    /// The area (square model units).
    #[getter]
    fn area(&self) -> Interval {
        Interval(self.0.area)
    }

    /// Whether the solid may go on beyond the frame.
    #[getter]
    fn clipped(&self) -> bool {
        self.0.clipped
    }

    /// Why it ended: "tolerance", "budget" or "exhausted".
    #[getter]
    fn stop_reason(&self) -> &'static str {
        words::word(self.0.stop_reason)
    }

    /// How many times a cell was split.
    #[getter]
    fn splits(&self) -> u64 {
        self.0.splits
    }

    fn __repr__(&self) -> String {
        format!("<SurfaceArea: {}>", self.0.area)
    }
}

/// What is proven of a bounding box.
#[pyclass(frozen, module = "leafless")]
pub struct BoundingBox(query::Extent);

#[pymethods]
impl BoundingBox {
    /// The lower and the upper corner: `Intervals` of shape (2, 3); `None` if the solid is proven empty.
    #[getter]
    fn corners<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.0.corners.map(|corners| intervals(py, corners.into_iter().flatten(), &[2, 3])).transpose()
    }

    /// Whether the solid is proven not to be empty.
    #[getter]
    fn occupied(&self) -> bool {
        self.0.occupied
    }

    /// Whether the solid may go on beyond the frame.
    #[getter]
    fn clipped(&self) -> bool {
        self.0.clipped
    }

    /// Why it ended: "tolerance", "budget" or "exhausted".
    #[getter]
    fn stop_reason(&self) -> &'static str {
        words::word(self.0.stop_reason)
    }

    /// How many times a cell was split.
    #[getter]
    fn splits(&self) -> u64 {
        self.0.splits
    }

    fn __repr__(&self) -> String {
        match &self.0.corners {
            None => "<BoundingBox: empty>".into(),
            Some([low, high]) => {
                let told = |corner: &[leafless::Interval; 3]| corner.map(|x| x.to_string()).join(", ");
                format!("<BoundingBox: ({}) to ({})>", told(low), told(high))
            }
        }
    }
}

/// How narrow an interval is to be.
fn wanted(py: Python<'_>, relative: f64, absolute: f64) -> PyResult<Tolerance> {
    if absolute.is_nan() || absolute < 0.0 {
        return Err(refused(
            py,
            "absolute",
            format!("must be a number that is not negative, not {absolute}"),
        ));
    }
    Ok(Tolerance { relative, absolute })
}

/// Measures a `solid`: volume, centroid and inertia, until the width of the volume's interval is `tolerance` of it, or at most
/// `absolute` (cubic model units). Closed meshes are known to rounding at once.
///
/// `frame` is the cube in which the solid is looked at: a `Frame`, or an octree that has it. Without it, it is a cube around the solid.
/// `depth` replaces its depth.
///
/// >>> found = measure(Csg.ball([0, 0, 0], 1), tolerance=1e-6)
/// >>> 4.18879020478639 in found.volume, 0.0 in found.centroid[2]
/// (True, True)
#[pyfunction]
#[pyo3(signature = (solid, *, tolerance=1e-3, absolute=0.0, frame=None, depth=None, **limits))]
pub fn measure(
    solid: &Bound<'_, PyAny>,
    #[pyo3(from_py_with = named::tolerance)] tolerance: f64,
    #[pyo3(from_py_with = named::absolute)] absolute: f64,
    frame: Option<FrameLike>,
    #[pyo3(from_py_with = named::depth)] depth: Option<Depth>,
    limits: Option<&Bound<'_, PyDict>>,
) -> PyResult<MassProperties> {
    let (py, limits) = (solid.py(), Limits::of(limits)?);
    let solid = given(solid, "solid")?;
    let frame = Wish { frame, depth }.of(py, &solid, MAX_DEPTH)?;
    let tolerance = wanted(py, tolerance, absolute)?;
    limits.run(py, |control| query::measure(&solid.shape, &frame, tolerance, control)).map(MassProperties)
}

/// The area of the boundary of a `solid`, until the width of its interval is `tolerance` of it, or at most `absolute` (square model units).
///
/// `frame` is the cube in which the solid is looked at: a `Frame`, or an octree that has it. Without it, it is a cube around the solid.
/// `depth` replaces its depth.
///
/// >>> 12.566370614359172 in surface_area(Csg.ball([0, 0, 0], 1), tolerance=0.01).area
/// True
#[pyfunction]
#[pyo3(signature = (solid, *, tolerance=1e-2, absolute=0.0, frame=None, depth=None, **limits))]
pub fn surface_area(
    solid: &Bound<'_, PyAny>,
    #[pyo3(from_py_with = named::tolerance)] tolerance: f64,
    #[pyo3(from_py_with = named::absolute)] absolute: f64,
    frame: Option<FrameLike>,
    #[pyo3(from_py_with = named::depth)] depth: Option<Depth>,
    limits: Option<&Bound<'_, PyDict>>,
) -> PyResult<SurfaceArea> {
    let (py, limits) = (solid.py(), Limits::of(limits)?);
    let solid = given(solid, "solid")?;
    let frame = Wish { frame, depth }.of(py, &solid, MAX_DEPTH)?;
    let tolerance = wanted(py, tolerance, absolute)?;
    limits.run(py, |control| query::surface_area(&solid.shape, &frame, tolerance, control)).map(SurfaceArea)
}

/// The bounding box of a `solid`, each side known to `tolerance` (model units; by default a millionth of the frame).
///
/// `frame` is the cube in which the solid is looked at: a `Frame`, or an octree that has it. Without it, it is a cube around the solid.
/// `depth` replaces its depth.
///
/// >>> box = bounding_box(Csg.ball([0, 0, 0], 1))
/// >>> 1.0 in box.corners[1, 0]
/// True
#[pyfunction]
#[pyo3(signature = (solid, *, tolerance=None, frame=None, depth=None, **limits))]
pub fn bounding_box(
    solid: &Bound<'_, PyAny>,
    #[pyo3(from_py_with = named::tolerance)] tolerance: Option<f64>,
    frame: Option<FrameLike>,
    #[pyo3(from_py_with = named::depth)] depth: Option<Depth>,
    limits: Option<&Bound<'_, PyDict>>,
) -> PyResult<BoundingBox> {
    let (py, limits) = (solid.py(), Limits::of(limits)?);
    let solid = given(solid, "solid")?;
    let frame = Wish { frame, depth }.of(py, &solid, MAX_DEPTH)?;
    let tolerance = tolerance.unwrap_or(1e-6 * frame.edge());
    limits.run(py, |control| query::bounding_box(&solid.shape, &frame, tolerance, control)).map(BoundingBox)
}
