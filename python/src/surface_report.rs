//! The report about a mesh that was made of a solid.

use crate::arguments::named;
use crate::error::refused;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

/// The values of `method` in a report.
const METHODS: [&str; 6] = ["faces", "adaptive", "cubes", "nets", "shrink", "simplify"];

/// A report about a mesh that was made of a solid: the `method`, the proven `deviation` of the mesh from the
/// solid's boundary, and the number of `intersecting_pairs` of triangles. With `from_mesh` the deviation is
/// only that from another mesh.
#[pyclass(frozen, eq, get_all, weakref, from_py_object, module = "leafless")]
#[derive(Clone, Copy, PartialEq)]
pub struct SurfaceReport {
    /// "faces", "adaptive", "cubes", "nets", "shrink" or "simplify".
    pub method: &'static str,
    /// The proven maximum distance of mesh and boundary, in both directions: of each point of the mesh from
    /// the solid's boundary, and of each point of the boundary from the mesh (model units). Infinite if
    /// nothing is known.
    pub deviation: f64,
    /// True if the deviation is that from another mesh whose own deviation is unknown: `simplify` of a mesh
    /// from a file.
    pub from_mesh: bool,
    /// The number of pairs of triangles that intersect each other, where the method counts them.
    pub intersecting_pairs: u64,
}

#[pymethods]
impl SurfaceReport {
    /// Makes a report, as `mesh.surface_report` returns it.
    #[new]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = named::method)] method: &str,
        #[pyo3(from_py_with = named::deviation)] deviation: f64,
        #[pyo3(from_py_with = named::from_mesh)] from_mesh: bool,
        #[pyo3(from_py_with = named::intersecting_pairs)] intersecting_pairs: u64,
    ) -> PyResult<SurfaceReport> {
        let unknown =
            || refused(py, "method", format!("must be one of '{}', not '{method}'", METHODS.join("', '")));
        let method = METHODS.into_iter().find(|known| *known == method).ok_or_else(unknown)?;
        Ok(SurfaceReport { method, deviation, from_mesh, intersecting_pairs })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let SurfaceReport { method, deviation, from_mesh, intersecting_pairs } = *slf.get();
        let arguments = (method, deviation, from_mesh, intersecting_pairs);
        Ok((slf.get_type().into_any(), arguments.into_bound_py_any(slf.py())?))
    }

    fn __repr__(&self) -> String {
        let SurfaceReport { method, deviation, intersecting_pairs, .. } = self;
        format!(
            "<SurfaceReport: {method}, deviation {deviation:.3e}, {intersecting_pairs} intersecting pairs>"
        )
    }
}
