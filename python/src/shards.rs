//! Octrees in shards: building, cutting and joining them, and adding up what is measured of them.

use crate::arrays;
use crate::ask::FrameLike;
use crate::error::{OrRaise, refused};
use crate::frame::Frame;
use crate::measures;
use crate::octree::Octree;
use crate::solid::{Given, Solid, given};
use crate::work::Limits;
use leafless::octree::OctreeRef;
use leafless::query;
use leafless::solid::ShardedOctree;
use leafless::surface::{Resolve, marching_cubes_in};
use leafless::{AnySolid, Cell, Shard as Inner, Tolerance};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

/// The cells that a shard knows: those down to a level, or those below one cell of a level. A cell is named by its place in Morton
/// order among the 8^level of its level.
#[pyclass(frozen, eq, hash, from_py_object, module = "leafless.shards")]
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Shard(pub Inner);

#[pymethods]
impl Shard {
    /// The cells down to a level. What would be split there stays PARTIAL.
    #[staticmethod]
    fn top(level: u8) -> Shard {
        Shard(Inner::Top { level })
    }

    /// The cells in one cell, and those around it.
    #[staticmethod]
    fn below(py: Python<'_>, level: u8, code: u64) -> PyResult<Shard> {
        cell(py, level, code).map(|cell| Shard(Inner::Below(cell)))
    }

    /// The level.
    #[getter]
    fn level(&self) -> u8 {
        match self.0 {
            Inner::Top { level } => level,
            Inner::Below(cell) => cell.level,
        }
    }

    /// The place of the cell in Morton order; `None` of a top.
    #[getter]
    fn code(&self) -> Option<u64> {
        match self.0 {
            Inner::Top { .. } => None,
            Inner::Below(cell) => Some(cell.morton()),
        }
    }

    fn __repr__(&self) -> String {
        match self.0 {
            Inner::Top { level } => format!("Shard.top({level})"),
            Inner::Below(cell) => format!("Shard.below({}, {})", cell.level, cell.morton()),
        }
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let (py, kind, own) = (slf.py(), slf.get_type(), slf.get());
        Ok(match own.code() {
            None => (kind.getattr("top")?, (own.level(),).into_bound_py_any(py)?),
            Some(code) => (kind.getattr("below")?, (own.level(), code).into_bound_py_any(py)?),
        })
    }
}

/// The cell of a level at a place in Morton order.
fn cell(py: Python<'_>, level: u8, code: u64) -> PyResult<Cell> {
    Cell::from_morton(level, code)
        .ok_or_else(|| refused(py, "code", "must be less than 8^level, for a level up to 20"))
}

/// What is known of the volume and the moments of a solid in some cells of its frame. Sums are exact, so that their order does not
/// matter: `a + b - b == a`.
#[pyclass(frozen, eq, module = "leafless.shards")]
#[derive(PartialEq)]
pub struct MassSum(query::MassSum);

#[pymethods]
impl MassSum {
    /// Of a cell of which nothing is known.
    #[staticmethod]
    fn unknown(py: Python<'_>, frame: FrameLike, level: u8, code: u64) -> PyResult<MassSum> {
        query::MassSum::unknown(&frame.0, cell(py, level, code)?).or_raise(py).map(MassSum)
    }

    /// The sum in bytes that `to_bytes` made.
    #[staticmethod]
    fn from_bytes(py: Python<'_>, data: &[u8]) -> PyResult<MassSum> {
        query::MassSum::from_bytes(data).or_raise(py).map(MassSum)
    }

    /// The sum as bytes, for another process of the same version.
    fn to_bytes<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &self.0.to_bytes())
    }

    /// The frame.
    #[getter]
    fn frame(&self) -> Frame {
        Frame(*self.0.frame())
    }

    /// Volume, centroid and inertia.
    #[getter]
    fn properties<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        measures::told(py, &self.0.properties().or_raise(py)?)
    }

    fn __add__(&self, py: Python<'_>, other: &MassSum) -> PyResult<MassSum> {
        self.0.plus(&other.0).or_raise(py).map(MassSum)
    }

    fn __sub__(&self, py: Python<'_>, other: &MassSum) -> PyResult<MassSum> {
        self.0.minus(&other.0).or_raise(py).map(MassSum)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("<MassSum: volume {}>", self.0.properties().or_raise(py)?.volume))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let py = slf.py();
        Ok((slf.get_type().getattr("from_bytes")?, (slf.get().to_bytes(py),).into_bound_py_any(py)?))
    }
}

/// Measures the part of a solid in one cell of a frame, as `measure` does the whole; the tolerances concern the volume in the cell.
/// Without `level` and `code` it is the whole frame.
///
/// >>> from leafless.shards import measure_cell
/// >>> ball, frame = Csg.ball([0, 0, 0], 1), Frame([-1, -1, -1], 2, 20)
/// >>> octants = [measure_cell(ball, frame, 1, code, tolerance=1e-4) for code in range(8)]
/// >>> 4.18879020478639 in sum(octants[1:], octants[0]).properties.volume
/// True
#[pyfunction]
#[pyo3(signature = (solid, frame, level=0, code=0, *, tolerance=1e-3, absolute=0.0, **limits))]
pub fn measure_cell(
    solid: &Bound<'_, PyAny>,
    frame: FrameLike,
    level: u8,
    code: u64,
    tolerance: f64,
    absolute: f64,
    limits: Option<&Bound<'_, PyDict>>,
) -> PyResult<MassSum> {
    let (py, limits) = (solid.py(), Limits::of(limits)?);
    let (solid, cell) = (given(solid, "solid")?, cell(py, level, code)?);
    let tolerance = Tolerance { relative: tolerance, absolute };
    let ask =
        |control: &leafless::Control<'_>| query::measure_in(&solid.shape, &frame.0, cell, tolerance, control);
    limits.run(py, ask).map(MassSum)
}

/// Puts together what several octrees on one frame know of one solid: a cell is FULL or EMPTY if one of them says so, and PARTIAL where
/// all leave it open. Surfaces that one of them keeps are kept. This is the reverse of cutting an octree into shards, byte for byte.
///
/// >>> from leafless.shards import Shard, join
/// >>> whole = build(Csg.ball([0, 0, 0], 1), depth=6)
/// >>> top = whole.shard(Shard.top(1))
/// >>> parts = [whole.shard(Shard.below(1, int(code))) for code in top.open_cells(1)]
/// >>> join([top, *parts]) == whole
/// True
#[pyfunction]
#[pyo3(signature = (octrees, **limits))]
pub fn join<'py>(
    py: Python<'py>,
    octrees: Vec<Py<Octree>>,
    limits: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, Octree>> {
    let limits = Limits::of(limits)?;
    let views: Vec<OctreeRef<'_>> = octrees.iter().map(|octree| *octree.get().octree.view()).collect();
    Octree::bound(py, limits.run(py, |control| leafless::op::join(&views, control))?)
}

/// A solid of shards that are not joined: a top, and shards of cells of one level that it leaves open. A shard is looked at when one of
/// its cells is asked for. A cell without a shard is PARTIAL.
#[pyclass(extends = Solid, frozen, module = "leafless.shards")]
pub struct ShardedSolid(ShardedOctree);

#[pymethods]
impl ShardedSolid {
    /// Of a top, and shards by the codes of their cells.
    #[new]
    fn new(
        py: Python<'_>,
        top: &Octree,
        level: u8,
        shards: Vec<(u64, Py<Octree>)>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let mut list = Vec::with_capacity(shards.len());
        for (code, shard) in &shards {
            list.push((cell(py, level, *code)?, shard.get().octree.clone()));
        }
        let sharded = ShardedOctree::new(top.octree.clone(), list).or_raise(py)?;
        let given = Given::new(AnySolid::new(sharded.clone()));
        Ok(PyClassInitializer::from(Solid::new(given)).add_subclass(ShardedSolid(sharded)))
    }

    /// Where it lies.
    #[getter]
    fn frame(&self) -> Frame {
        Frame(*self.0.frame())
    }

    fn __repr__(&self) -> String {
        format!("<ShardedSolid: depth {}, {} shards>", self.0.frame().depth(), self.0.shards().len())
    }

    /// By the bytes of the octrees.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let (py, own) = (slf.py(), &slf.get().0);
        let mut list = Vec::new();
        for (cell, shard) in own.shards() {
            list.push((cell.morton(), Octree::bound(py, shard.clone())?));
        }
        let level = own.shards().next().map_or(0, |(cell, _)| cell.level);
        let top = Octree::bound(py, own.top().clone())?;
        Ok((slf.get_type().into_any(), (top, level, list).into_bound_py_any(py)?))
    }
}

/// Level by level the nodes, the FULL and the PARTIAL cells.
type Counts = Vec<[u64; 3]>;

/// The statistics of a top and of shards by the codes of their cells, with the nodes, the FULL and the PARTIAL cells of each level.
#[pyfunction]
pub fn joined_statistics<'py>(
    py: Python<'py>,
    top: &Octree,
    level: u8,
    shards: Vec<(u64, Counts)>,
) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let frame = top.octree.frame();
    let mut list = Vec::with_capacity(shards.len());
    for (code, counts) in shards {
        list.push((cell(py, level, code)?, leafless::octree::Statistics::of_counts(frame, &counts)));
    }
    crate::octree::told(py, &top.octree.statistics_with(&list).or_raise(py)?)
}

/// The triangles of marching cubes in one cell, as vertices and faces: of the octree of the cell's shard, joined with those of the
/// neighbours behind it. `resolve` says what undecided cells count as.
#[pyfunction]
#[pyo3(signature = (octree, level, code, resolve, **limits))]
pub fn surface_in<'py>(
    py: Python<'py>,
    octree: &Octree,
    level: u8,
    code: u64,
    resolve: &str,
    limits: Option<&Bound<'py, PyDict>>,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
    let cell = cell(py, level, code)?;
    let resolve = match resolve {
        "inner" => Resolve::Inner,
        "outer" => Resolve::Outer,
        _ => return Err(refused(py, "resolve", "must be 'inner' or 'outer'")),
    };
    let view = octree.octree.view();
    let mesh =
        Limits::of(limits)?.run(py, |control| marching_cubes_in(view, Some(resolve), cell, control))?;
    let (vertices, faces) = (mesh.vertices().to_vec(), mesh.triangles().to_vec());
    let count = faces.len();
    let faces = arrays::array(py, faces.into_flattened(), &[count, 3])?;
    Ok((arrays::rows(py, vertices)?.into_any(), faces.into_any()))
}
