//! Voxels as records.

use crate::arguments::named;
use crate::arrays::{self, layout, required, shape_text, shown};
use crate::error::{OrRaise, called, refused};
use crate::frame::Frame;
use crate::from_package;
use crate::octree::{Octree, Proof};
use crate::words;
use crate::work::Limits;
use leafless::Tag;
use leafless::voxel::{Viewpoint, VoxelRecords as Inner};
use numpy::{Element, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A list of voxels, sorted by code: arrays of `codes`, `levels`, `kinds` (`VoxelKind`: 0 outside, 1 inside,
/// 2 boundary, 3 refined) and `values`. The arrays are views of the library's own memory. `frame` is the
/// lattice of the voxels.
///
/// >>> records = build(Csg.cuboid([0, 0, 0], [3, 1, 1]), Frame([0, 0, 0], 4, 2)).voxels()
/// >>> len(records), records.corners().tolist()
/// (3, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
#[pyclass(frozen, weakref, module = "leafless")]
pub struct VoxelRecords(pub Inner);

#[pymethods]
impl VoxelRecords {
    /// Makes records from arrays of your own, sorted by code, with optional values of shape (n,) or (n,
    /// components).
    #[new]
    #[pyo3(signature = (frame, codes, levels, kinds, values=None))]
    fn new(
        #[pyo3(from_py_with = named::frame)] frame: Bound<'_, Frame>,
        codes: &Bound<'_, PyAny>,
        levels: &Bound<'_, PyAny>,
        kinds: &Bound<'_, PyAny>,
        values: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<VoxelRecords> {
        let py = codes.py();
        let codes = list::<u64>(codes, "uint64", "codes")?;
        let levels = list::<u8>(levels, "uint8", "levels")?;
        let kinds = list::<u8>(kinds, "uint8", "kinds")?;
        let (components, values) = match values {
            None => (0, Vec::new()),
            Some(values) => {
                let values = arrays::doubles(values, "values")?;
                let components = match *values.shape() {
                    [_] => 1,
                    [_, components] => components,
                    ref shape => {
                        return Err(refused(
                            py,
                            "values",
                            format!("must have the shape (n,) or (n, m), not {}", shape_text(shape)),
                        ));
                    }
                };
                (components, values.readonly().as_slice()?.to_vec())
            }
        };
        for (name, count) in [("levels", levels.len()), ("kinds", kinds.len())] {
            if count != codes.len() {
                return Err(refused(
                    py,
                    name,
                    format!("must be as many as codes, {}, not {count}", codes.len()),
                ));
            }
        }
        if values.len() != components * codes.len() {
            let count = values.len() / components.max(1);
            return Err(refused(
                py,
                "values",
                format!("must be as many as codes, {}, not {count}", codes.len()),
            ));
        }
        let frame = frame.get().0;
        let records = py.detach(|| Inner::from_arrays(&frame, codes, levels, kinds, components, values));
        records.map_err(called([("records", "codes")])).or_raise(py).map(VoxelRecords)
    }

    /// Restores pickled records: adds the facts that the library stores beside the arrays.
    #[staticmethod]
    fn _restored(
        py: Python<'_>,
        records: &VoxelRecords,
        exterior: &str,
        boundary: &str,
        proof: Proof,
    ) -> PyResult<VoxelRecords> {
        let (exterior, boundary) =
            (words::value_of(py, "exterior", exterior)?, words::value_of(py, "boundary", boundary)?);
        let records = records.0.clone().with_exterior(exterior, proof.inner().or_raise(py)?);
        Ok(VoxelRecords(records.with_boundary(boundary)))
    }

    /// The lattice of the voxels.
    #[getter]
    fn frame(&self) -> Frame {
        Frame(*self.0.view().frame())
    }

    /// The codes of voxels: three bits for each level, x the lowest bit.
    #[getter]
    fn codes<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let list = slf.get().0.view().codes();
        shown(slf.as_any(), list, layout([list.len()], false))
    }

    /// The levels of voxels.
    #[getter]
    fn levels<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let list = slf.get().0.view().levels();
        shown(slf.as_any(), list, layout([list.len()], false))
    }

    /// The kinds of voxels.
    #[getter]
    fn kinds<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let list = slf.get().0.view().kinds();
        shown(slf.as_any(), list, layout([list.len()], false))
    }

    /// The values of voxels, shape (n, components), NaN where there is none.
    #[getter]
    fn values<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let view = slf.get().0.view();
        let (list, components) = (view.values(), view.components());
        shown(slf.as_any(), list, layout([view.len(), components], false))
    }

    /// Returns the lower corners of voxels (model units), shape (n, 3).
    fn corners<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let view = self.0.view();
        let all = py.detach(|| (0..view.len()).map(|i| view.corner(i).unwrap_or([f64::NAN; 3])).collect());
        Ok(arrays::rows(py, all)?.into_any())
    }

    /// Returns the edges of voxels (model units), shape (n,).
    fn edges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let view = self.0.view();
        let all: Vec<f64> = py.detach(|| (0..view.len()).map(|i| view.edge(i).unwrap_or(f64::NAN)).collect());
        let count = all.len();
        Ok(arrays::array(py, all, &[count])?.into_any())
    }

    /// Returns the order of voxels as seen from the point `eye`, the front ones first: indices of shape (n,).
    #[pyo3(signature = (eye, **limits))]
    fn depth_order<'py>(
        &self,
        eye: &Bound<'py, PyAny>,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (py, eye) = (eye.py(), arrays::triple(eye, "eye")?);
        let view = self.0.view();
        let order =
            Limits::of(limits)?.run(py, |control| view.depth_order(&Viewpoint::Perspective(eye), control))?;
        let count = order.len();
        Ok(arrays::array(py, order, &[count])?.into_any())
    }

    /// Returns the octree of the voxels. `boundary` is the tag of boundary voxels: "partial" (the default),
    /// "full" or "empty", or one of the constants PARTIAL, FULL and EMPTY.
    #[pyo3(signature = (boundary=None, **limits), text_signature = "($self, boundary='partial', **limits)")]
    fn to_octree<'py>(
        &self,
        py: Python<'py>,
        boundary: Option<&Bound<'py, PyAny>>,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, Octree>> {
        let boundary = boundary.map_or(Ok(Tag::Partial), |tag| words::tag(tag, "boundary"))?;
        if boundary == Tag::Branch {
            return Err(refused(py, "boundary", "must be one of 'empty', 'partial', 'full', not 'branch'"));
        }
        let view = self.0.view();
        let octree = Limits::of(limits)?.run(py, |control| view.to_octree(boundary, control))?;
        Octree::bound(py, octree)
    }

    fn __len__(&self) -> usize {
        self.0.view().len()
    }

    fn __repr__(&self) -> String {
        format!("<VoxelRecords: {}>", self.0.view().len())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let again = from_package!(slf.py(), "leafless._pickle", "voxels")?;
        let view = slf.get().0.view();
        let values = if view.components() == 0 { None } else { Some(VoxelRecords::values(slf)?) };
        let arrays =
            (VoxelRecords::codes(slf)?, VoxelRecords::levels(slf)?, VoxelRecords::kinds(slf)?, values);
        let known = (words::word(view.exterior()), words::word(view.boundary()), Proof::from(view.proof()));
        Ok((again, (slf.get().frame(), arrays, known).into_bound_py_any(slf.py())?))
    }
}

/// Reads a list of whole numbers.
fn list<T: Element + Copy>(given: &Bound<'_, PyAny>, kind: &str, name: &str) -> PyResult<Vec<T>> {
    let array = required::<T>(given, kind, name)?;
    if array.ndim() != 1 {
        let shape = shape_text(array.shape());
        return Err(refused(given.py(), name, format!("must have the shape (n,), not {shape}")));
    }
    Ok(array.readonly().as_slice()?.to_vec())
}
