//! Tri-dexel models.

use crate::arguments::{Argument, Depth, named};
use crate::arrays;
use crate::ask::{FrameLike, Wish};
use crate::error::{OrRaise, refused};
use crate::frame::Frame;
use crate::from_package;
use crate::mesh::Mesh;
use crate::octree::Octree;
use crate::solid::{Given, Solid, given};
use crate::words;
use crate::work::Limits;
use leafless::dexel::{DexelEnds, DexelFormat, DexelNormals, TriDexelRef};
use leafless::op::{DexelOptions, octree_from_dexel_ends, octree_from_dexels};
use leafless::surface::{DexelSolid as Inside, dual_contouring_dexels, marching_cubes_dexels};
use leafless::{AnySolid, Control, Error, FillRule, Rule, TriDexel as Inner};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};
use std::path::PathBuf;

/// The default depth of a model: 256 rays along each axis of a face.
const DEPTH: u8 = 8;

/// A solid as intervals along the rays of a lattice. The ends of intervals are far finer than cells.
///
/// `|`, `&`, `-`, `^` and `~` merge the intervals of models on one frame. A model proves nothing, because
/// rays miss everything between them. `solid()` returns the solid inside the surface of marching cubes.
///
/// >>> model = dexelize(Csg.ball([0, 0, 0], 1), depth=6)
/// >>> round(model.volume(), 3)
/// 4.19
#[pyclass(frozen, weakref, module = "leafless")]
pub struct TriDexel {
    pub model: Inner,
    /// The mapped file, with the checksum of its header.
    pub mapped: Option<(PathBuf, u64)>,
}

impl TriDexel {
    pub fn new(model: Inner) -> TriDexel {
        TriDexel { model, mapped: None }
    }

    /// Returns the refusal of an axis along which no rays run.
    fn no_rays(&self, py: Python<'_>, axis: usize) -> PyErr {
        let problem = format!(
            "must be one along which rays run, 0, 1 or 2 for x, y and z, not {axis}; rays of this model run along {}",
            self.directions()
        );
        refused(py, "axis", problem)
    }

    /// Combines any number of models.
    fn all_combined(
        models: &Bound<'_, PyTuple>,
        limits: Option<&Bound<'_, PyDict>>,
        combine: impl FnOnce(&[TriDexelRef<'_>], &Control<'_>) -> Result<Inner, Error> + Send,
    ) -> PyResult<TriDexel> {
        let (py, limits) = (models.py(), Limits::of(limits)?);
        let all: Vec<Bound<'_, TriDexel>> =
            models.iter().map(|one| Argument::take(&one, "models")).collect::<PyResult<_>>()?;
        let views: Vec<_> = all.iter().map(|one| *one.get().model.view()).collect();
        limits.run(py, |control| combine(&views, control)).map(TriDexel::new)
    }

    fn combined<'py>(
        py: Python<'py>,
        other: &Bound<'py, PyAny>,
        combine: impl FnOnce(&Inner, &Control<'_>) -> Result<Inner, Error> + Send,
    ) -> PyResult<Bound<'py, PyAny>> {
        let Ok(other) = other.cast::<TriDexel>() else { return Ok(py.NotImplemented().into_bound(py)) };
        let other = &other.get().model;
        TriDexel::new(Limits::default().run(py, |control| combine(other, control))?).into_bound_py_any(py)
    }
}

#[pymethods]
impl TriDexel {
    /// Reads a model from the bytes of a file, `data`.
    #[staticmethod]
    fn from_bytes(py: Python<'_>, #[pyo3(from_py_with = named::data)] data: &[u8]) -> PyResult<TriDexel> {
        py.detach(|| leafless::file::dexels::from_bytes(data)).or_raise(py).map(TriDexel::new)
    }

    /// Returns the bytes of the model's file.
    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = py.detach(|| leafless::file::dexels::to_bytes(&self.model)).or_raise(py)?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Returns the union of any number of `models` on one frame, as `|` does for two.
    #[staticmethod]
    #[pyo3(signature = (*models, **limits))]
    fn union_of(models: &Bound<'_, PyTuple>, limits: Option<&Bound<'_, PyDict>>) -> PyResult<TriDexel> {
        TriDexel::all_combined(models, limits, Inner::union_of)
    }

    /// Returns the intersection of any number of `models` on one frame, as `&` does for two.
    #[staticmethod]
    #[pyo3(signature = (*models, **limits))]
    fn intersection_of(
        models: &Bound<'_, PyTuple>,
        limits: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<TriDexel> {
        TriDexel::all_combined(models, limits, Inner::intersection_of)
    }

    /// Returns the first of the `models` without the others, as `-` does for two.
    #[staticmethod]
    #[pyo3(signature = (*models, **limits))]
    fn difference_of(models: &Bound<'_, PyTuple>, limits: Option<&Bound<'_, PyDict>>) -> PyResult<TriDexel> {
        TriDexel::all_combined(models, limits, Inner::difference_of)
    }

    /// Returns the symmetric difference: the parts that lie in an odd number of the `models`, as `^` does for
    /// two.
    #[staticmethod]
    #[pyo3(signature = (*models, **limits))]
    fn xor_of(models: &Bound<'_, PyTuple>, limits: Option<&Bound<'_, PyDict>>) -> PyResult<TriDexel> {
        TriDexel::all_combined(models, limits, Inner::xor_of)
    }

    /// Returns the complement of a `model` in its frame, as `~model`.
    #[staticmethod]
    #[pyo3(signature = (model, **limits))]
    fn complement_of(
        #[pyo3(from_py_with = named::model)] model: Bound<'_, TriDexel>,
        limits: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<TriDexel> {
        let view = model.get().model.view();
        Limits::of(limits)?.run(model.py(), |control| view.complement(control)).map(TriDexel::new)
    }

    /// The lattice: rays run through the centres of its finest cells.
    #[getter]
    fn frame(&self) -> Frame {
        Frame(*self.model.frame())
    }

    /// The axes along which rays run: any of "x", "y" and "z".
    #[getter]
    fn directions(&self) -> String {
        let has = self.model.view().directions();
        ["x", "y", "z"].into_iter().zip(has).filter_map(|(name, has)| has.then_some(name)).collect()
    }

    /// The number of intervals.
    #[getter]
    fn interval_count(&self) -> u64 {
        self.model.view().interval_count()
    }

    /// The size of the arrays (bytes).
    #[getter]
    fn nbytes(&self) -> u64 {
        self.model.view().bytes()
    }

    /// Returns the sum of the intervals along an `axis`, 0, 1 or 2 for x, y and z, as a volume (cubic model
    /// units). It is an estimate, not a bound.
    #[pyo3(signature = (axis=2))]
    fn volume(&self, py: Python<'_>, #[pyo3(from_py_with = named::axis)] axis: usize) -> PyResult<f64> {
        match py.detach(|| self.model.view().statistics(axis)) {
            Some(statistics) => Ok(statistics.volume),
            None => Err(self.no_rays(py, axis)),
        }
    }

    /// Returns the intervals along an `axis` (0, 1 or 2 for x, y and z) as arrays: `ray` of shape (n, 2)
    /// holds the indices of the ray on the other two axes, the lower axis first. `start` and `end`
    /// (coordinates) and `material` have the shape (n,).
    fn rays<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = named::axis)] axis: usize,
    ) -> PyResult<Bound<'py, PyAny>> {
        let Some(rays) = self.model.view().rays(axis) else { return Err(self.no_rays(py, axis)) };
        let (ray, start, end, material) = py.detach(|| {
            let count = rays.interval_count() as usize;
            let (mut ray, mut start, mut end, mut material) = (
                Vec::with_capacity(count),
                Vec::with_capacity(count),
                Vec::with_capacity(count),
                Vec::with_capacity(count),
            );
            let [first, second] = rays.window();
            for at in second.flat_map(|v| first.clone().map(move |u| [u, v])) {
                for dexel in rays.dexels(at) {
                    ray.push(at);
                    start.push(dexel.start.at);
                    end.push(dexel.end.at);
                    material.push(dexel.material);
                }
            }
            (ray, start, end, material)
        });
        let count = start.len();
        from_package!(py, "leafless._answers", "DexelRays")?.call1((
            arrays::rows(py, ray)?,
            arrays::array(py, start, &[count])?,
            arrays::array(py, end, &[count])?,
            arrays::array(py, material, &[count])?,
        ))
    }

    /// Makes the surface: by dual contouring, with sharp edges, if the model keeps normals, else by marching
    /// cubes.
    #[pyo3(signature = (**limits))]
    fn surface<'py>(
        &self,
        py: Python<'py>,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, Mesh>> {
        let view = self.model.view();
        let (mesh, _) = Limits::of(limits)?.run(py, |control| match view.format().normals {
            DexelNormals::None => marching_cubes_dexels(view, control),
            DexelNormals::Bits16 | DexelNormals::Bits32 => dual_contouring_dexels(view, control),
        })?;
        Mesh::bound(py, mesh, FillRule::NonZero, None, None)
    }

    /// Returns the solid inside the surface of marching cubes, as a `DexelSolid`. Its answers treat this
    /// surface as the truth.
    #[pyo3(signature = (**limits))]
    fn solid<'py>(
        slf: &Bound<'py, Self>,
        py: Python<'py>,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, DexelSolid>> {
        let view = slf.get().model.view();
        let solid = Limits::of(limits)?.run(py, |control| Inside::new(view, control))?;
        let given = Given::new(AnySolid::new(solid.as_truth()));
        let solid = DexelSolid { model: slf.clone().unbind() };
        Bound::new(py, PyClassInitializer::from(Solid::new(given)).add_subclass(solid))
    }

    /// Returns the octree of the samples that the rays decide. With `by_ends=True`, cells in which rays begin
    /// or end stay undecided.
    #[pyo3(signature = (*, by_ends=false, **limits))]
    fn to_octree<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = named::by_ends)] by_ends: bool,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, Octree>> {
        let view = self.model.view();
        let octree = Limits::of(limits)?.run(py, |control| {
            if by_ends { octree_from_dexel_ends(view, control) } else { octree_from_dexels(view, control) }
        })?;
        Octree::bound(py, octree)
    }

    fn __or__<'py>(&self, other: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let own = &self.model;
        TriDexel::combined(other.py(), other, |other, control| own.view().union(other.view(), control))
    }

    fn __and__<'py>(&self, other: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let own = &self.model;
        TriDexel::combined(other.py(), other, |other, control| own.view().intersection(other.view(), control))
    }

    fn __sub__<'py>(&self, other: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let own = &self.model;
        TriDexel::combined(other.py(), other, |other, control| own.view().difference(other.view(), control))
    }

    fn __xor__<'py>(&self, other: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let own = &self.model;
        TriDexel::combined(other.py(), other, |other, control| own.view().xor(other.view(), control))
    }

    fn __invert__(&self, py: Python<'_>) -> PyResult<TriDexel> {
        let view = self.model.view();
        Ok(TriDexel::new(Limits::default().run(py, |control| view.complement(control))?))
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> PyResult<Py<PyAny>> {
        let py = other.py();
        match other.cast::<TriDexel>() {
            Ok(other) => {
                let other = &other.get().model;
                py.detach(|| self.model == *other).into_py_any(py)
            }
            Err(_) => Ok(py.NotImplemented()),
        }
    }

    fn __hash__(&self) -> u64 {
        crate::frame::hash(self.model.frame()) ^ self.model.view().interval_count()
    }

    fn __repr__(&self) -> String {
        let (depth, count) = (self.model.frame().depth(), self.interval_count());
        format!("<TriDexel: depth {depth}, directions {}, {count} intervals>", self.directions())
    }

    /// Pickles the bytes of the file; for a mapped model the path and a checksum.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        match &self.mapped {
            Some((path, checksum)) => {
                let again = from_package!(py, "leafless._pickle", "mapped")?;
                Ok((again, (path, *checksum).into_bound_py_any(py)?))
            }
            None => {
                let again = from_package!(py, "leafless._pickle", "tridexel")?;
                Ok((again, (self.to_bytes(py)?,).into_bound_py_any(py)?))
            }
        }
    }
}

/// The solid inside the surface that marching cubes makes of a tri-dexel model: `model.solid()`. Its answers
/// treat this surface as the truth.
#[pyclass(extends = Solid, frozen, module = "leafless")]
pub struct DexelSolid {
    model: Py<TriDexel>,
}

#[pymethods]
impl DexelSolid {
    /// The tri-dexel model.
    #[getter]
    fn model(&self, py: Python<'_>) -> Py<TriDexel> {
        self.model.clone_ref(py)
    }

    fn __repr__(&self) -> String {
        format!("<DexelSolid of {}>", self.model.get().__repr__())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let again = from_package!(py, "leafless._pickle", "dexel_solid")?;
        Ok((again, (&self.model,).into_bound_py_any(py)?))
    }
}

/// Makes a tri-dexel model of a `solid`: the intervals in which the rays through the centres of cells run
/// inside.
///
/// `frame` is a `Frame`, or an octree on that frame. Its cube and its cells are those of the lattice. Without
/// it, the frame is a cube around the solid. `depth` replaces the frame's depth. A cube around the solid has
/// the depth 8 by default, which gives 256 × 256 rays along an axis.
///
/// `directions` are the axes along which rays run: some of the letters "xyz". `rule` defines the intervals.
/// "sampled", the default, takes the intervals of the solid on each ray. "inner" takes the FULL cells of the
/// solid, and "outer" all cells that are not EMPTY. "certified" is refused, because an interval cannot be
/// undecided.
///
/// `normals` is the number of bits, 16 or 32, in which the surface's normals at the ends are kept, so that
/// surfaces have sharp edges. The default, 0, keeps none. `surfaces=True` keeps the numbers of the source's
/// surfaces. `doubles=True` stores ends as doubles, in twice the memory; otherwise they are off by up to
/// 2^-31 of the frame's edge.
#[pyfunction]
#[pyo3(signature = (
    solid, frame=None, *, depth=None, directions="xyz", rule="sampled", normals=0, surfaces=false, doubles=false, **limits
))]
#[allow(clippy::too_many_arguments)]
pub fn dexelize(
    solid: &Bound<'_, PyAny>,
    frame: Option<FrameLike>,
    #[pyo3(from_py_with = named::depth)] depth: Option<Depth>,
    #[pyo3(from_py_with = named::directions)] directions: &str,
    #[pyo3(from_py_with = named::rule)] rule: &str,
    #[pyo3(from_py_with = named::normals)] normals: u8,
    #[pyo3(from_py_with = named::surfaces)] surfaces: bool,
    #[pyo3(from_py_with = named::doubles)] doubles: bool,
    limits: Option<&Bound<'_, PyDict>>,
) -> PyResult<TriDexel> {
    let py = solid.py();
    let limits = Limits::of(limits)?;
    let rule: Rule = words::value(py, rule)?;
    if directions.is_empty() || !directions.chars().all(|axis| "xyz".contains(axis)) {
        return Err(refused(
            py,
            "directions",
            format!("must be some of the letters x, y and z, not '{directions}'"),
        ));
    }
    let normals = match normals {
        0 => DexelNormals::None,
        16 => DexelNormals::Bits16,
        32 => DexelNormals::Bits32,
        _ => return Err(refused(py, "normals", format!("must be 0, 16 or 32 bits, not {normals}"))),
    };
    let ends = if doubles { DexelEnds::Double } else { DexelEnds::Fixed };
    let format = DexelFormat { ends, normals, surfaces, ..DexelFormat::default() };
    let directions = ['x', 'y', 'z'].map(|axis| directions.contains(axis));
    let options = DexelOptions { directions, format, rule };
    let solid = given(solid, "solid")?;
    let frame = Wish { frame, depth }.of(py, &solid, DEPTH)?;
    let model = limits.run(py, |control| leafless::dexelize(&solid.shape, &frame, &options, control))?;
    Ok(TriDexel::new(model))
}
