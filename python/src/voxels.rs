//! Voxels as records.

use crate::arrays::{self, layout, required, shown};
use crate::error::{OrRaise, refused};
use crate::frame::Frame;
use crate::from_package;
use crate::octree::{Octree, Proof};
use crate::words;
use crate::work::Limits;
use leafless::Tag;
use leafless::voxel::{Viewpoint, VoxelRecords as Inner};
use numpy::{PyArrayMethods, PyUntypedArrayMethods};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Voxels as records, sorted by code: arrays of `codes`, `levels`, `kinds` (`VoxelKind`: 0 outside, 1 inside, 2 boundary,
/// 3 refined) and `values`, which are views of the library's own memory.
///
/// >>> records = build(Csg.cuboid([0, 0, 0], [3, 1, 1]), Frame([0, 0, 0], 4, 2)).voxels()
/// >>> len(records), records.corners().tolist()
/// (3, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
#[pyclass(frozen, weakref, module = "leafless")]
pub struct VoxelRecords(pub Inner);

#[pymethods]
impl VoxelRecords {
    /// Records from arrays of your own, sorted by code, with values of shape (n,) or (n, components) if they have any.
    #[new]
    #[pyo3(signature = (frame, codes, levels, kinds, values=None))]
    fn new(
        frame: Frame,
        codes: &Bound<'_, PyAny>,
        levels: &Bound<'_, PyAny>,
        kinds: &Bound<'_, PyAny>,
        values: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<VoxelRecords> {
        let py = codes.py();
        let codes = required::<u64>(codes, "uint64", "codes")?.readonly().as_slice()?.to_vec();
        let levels = required::<u8>(levels, "uint8", "levels")?.readonly().as_slice()?.to_vec();
        let kinds = required::<u8>(kinds, "uint8", "kinds")?.readonly().as_slice()?.to_vec();
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
                            format!("must have the shape (n,) or (n, m), not {shape:?}"),
                        ));
                    }
                };
                (components, values.readonly().as_slice()?.to_vec())
            }
        };
        let records = Inner::from_arrays(&frame.0, codes, levels, kinds, components, values);
        records.or_raise(py).map(VoxelRecords)
    }

    /// Records of your own with what else a list that the library made says, as it was pickled.
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

    /// The lattice.
    #[getter]
    fn frame(&self) -> Frame {
        Frame(*self.0.view().frame())
    }

    /// Codes of voxels: three bits a level, x the lowest.
    #[getter]
    fn codes<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let list = slf.get().0.view().codes();
        shown(slf.as_any(), list, layout([list.len()], false))
    }

    /// Levels of voxels.
    #[getter]
    fn levels<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let list = slf.get().0.view().levels();
        shown(slf.as_any(), list, layout([list.len()], false))
    }

    /// Kinds of voxels.
    #[getter]
    fn kinds<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let list = slf.get().0.view().kinds();
        shown(slf.as_any(), list, layout([list.len()], false))
    }

    /// Values of voxels, shape (n, components), NaN where there is none.
    #[getter]
    fn values<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let view = slf.get().0.view();
        let (list, components) = (view.values(), view.components());
        shown(slf.as_any(), list, layout([view.len(), components], false))
    }

    /// The lower corners of voxels (model units), shape (n, 3).
    fn corners<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let view = self.0.view();
        let all = (0..view.len()).map(|i| view.corner(i).unwrap_or([f64::NAN; 3])).collect();
        Ok(arrays::rows(py, all)?.into_any())
    }

    /// The edges of voxels (model units), shape (n,).
    fn edges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let view = self.0.view();
        let all: Vec<f64> = (0..view.len()).map(|i| view.edge(i).unwrap_or(f64::NAN)).collect();
        let count = all.len();
        Ok(arrays::array(py, all, &[count])?.into_any())
    }

    /// The order in which voxels are seen from a point, those in front first: indices of shape (n,).
    fn depth_order<'py>(&self, eye: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let (py, eye) = (eye.py(), arrays::triple(eye, "eye")?);
        let view = self.0.view();
        let order =
            Limits::default().run(py, |control| view.depth_order(&Viewpoint::Perspective(eye), control))?;
        let count = order.len();
        Ok(arrays::array(py, order, &[count])?.into_any())
    }

    /// The octree of the voxels. `boundary` says what boundary voxels become: "partial", "full" or "empty".
    #[pyo3(signature = (boundary="partial", **limits))]
    fn to_octree<'py>(
        &self,
        py: Python<'py>,
        boundary: &str,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, Octree>> {
        let boundary: Tag = words::value_of(py, "boundary", boundary)?;
        if boundary == Tag::Branch {
            return Err(refused(py, "boundary", "must be one of 'empty', 'partial', 'full'"));
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
