//! Octrees in shards: building, cutting and joining them, and adding up their measures.

use crate::arguments::{Argument, Deep, Level, named, other_type};
use crate::arrays;
use crate::ask::FrameLike;
use crate::error::{OrRaise, called, refused};
use crate::frame::{Frame, level_of};
use crate::measures::{self, wanted};
use crate::octree::Octree;
use crate::solid::{Given, Solid, given};
use crate::words;
use crate::work::Limits;
use leafless::octree::{OctreeRef, Statistics};
use leafless::query;
use leafless::solid::ShardedOctree;
use leafless::surface::{Resolve, marching_cubes_in};
use leafless::{AnySolid, Cell, Shard as Inner};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

/// The cells of a shard: the cells down to a level, or the cells below one cell of a level. A cell is named
/// by its `level` and its `code` (Morton order) among the 8^level cells of the level.
#[pyclass(frozen, eq, hash, from_py_object, module = "leafless.shards")]
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Shard(pub Inner);

#[pymethods]
impl Shard {
    /// Returns the top: the cells down to a `level`, from 0 to the depth of the frame. A cell that would be
    /// split on that level stays PARTIAL.
    #[staticmethod]
    fn top(#[pyo3(from_py_with = named::level)] level: Level) -> Shard {
        Shard(Inner::Top { level: level.0 })
    }

    /// Returns the shard of the cell with this `code` on a `level`: the cells in that cell, and the cells
    /// around it.
    #[staticmethod]
    fn below(
        py: Python<'_>,
        #[pyo3(from_py_with = named::level)] level: Level,
        #[pyo3(from_py_with = named::code)] code: u64,
    ) -> PyResult<Shard> {
        cell(py, "code", level.0, code).map(|cell| Shard(Inner::Below(cell)))
    }

    /// The level.
    #[getter]
    fn level(&self) -> u8 {
        match self.0 {
            Inner::Top { level } => level,
            Inner::Below(cell) => cell.level,
        }
    }

    /// The Morton code of the cell; `None` for a top.
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

/// Returns the cell with a code on a level. A refusal names the parameter `name`.
fn cell(py: Python<'_>, name: &str, level: u8, code: u64) -> PyResult<Cell> {
    let problem = || format!("must be a code below 8^{level}, the number of cells of the level, not {code}");
    Cell::from_morton(level, code).ok_or_else(|| refused(py, name, problem()))
}

/// Returns the cell with a code on a level of a frame.
fn cell_of(py: Python<'_>, frame: &leafless::Frame, level: Level, code: u64) -> PyResult<Cell> {
    cell(py, "code", level_of(py, frame, level)?, code)
}

/// Reads pairs of a cell's code and a value. `kind` describes the value in refusals.
fn by_codes<'py, T>(
    given: &Bound<'py, PyAny>,
    frame: &leafless::Frame,
    level: Level,
    kind: &str,
    take: impl Fn(&Bound<'py, PyAny>) -> PyResult<T>,
) -> PyResult<Vec<(Cell, T)>> {
    let py = given.py();
    let level = level_of(py, frame, level)?;
    let pair = |item: PyResult<Bound<'py, PyAny>>| {
        let item = item?;
        let pair: (Bound<'py, PyAny>, Bound<'py, PyAny>) =
            item.extract().map_err(|_| other_type(&item, "shards", &format!("a code with {kind}")))?;
        let code = Argument::take(&pair.0, "shards")?;
        Ok((cell(py, "shards", level, code)?, take(&pair.1)?))
    };
    sequence(given, "shards", &format!("a sequence of codes with {kind}"))?.map(pair).collect()
}

/// Iterates over a sequence.
fn sequence<'py>(
    given: &Bound<'py, PyAny>,
    name: &str,
    kind: &str,
) -> PyResult<impl Iterator<Item = PyResult<Bound<'py, PyAny>>> + use<'py>> {
    given.try_iter().map_err(|error| {
        if error.is_instance_of::<PyTypeError>(given.py()) { other_type(given, name, kind) } else { error }
    })
}

/// A sum of volume and moments of a solid over some cells of its frame. Sums are exact, so their order does
/// not matter: the intervals of `a + b - b` are those of `a`. Only the number of splits keeps counting.
#[pyclass(frozen, eq, module = "leafless.shards")]
#[derive(PartialEq)]
pub struct MassSum(query::MassSum);

#[pymethods]
impl MassSum {
    /// Returns the sum of one unknown cell, with this `code` on a `level`. `frame` is a `Frame`, or an octree
    /// on that frame.
    #[staticmethod]
    fn unknown(
        py: Python<'_>,
        frame: FrameLike,
        #[pyo3(from_py_with = named::level)] level: Level,
        #[pyo3(from_py_with = named::code)] code: u64,
    ) -> PyResult<MassSum> {
        query::MassSum::unknown(&frame.0, cell_of(py, &frame.0, level, code)?).or_raise(py).map(MassSum)
    }

    /// Reads a sum from `data`, the bytes that `to_bytes` made.
    #[staticmethod]
    fn from_bytes(py: Python<'_>, #[pyo3(from_py_with = named::data)] data: &[u8]) -> PyResult<MassSum> {
        query::MassSum::from_bytes(data).map_err(called([("bytes", "data")])).or_raise(py).map(MassSum)
    }

    /// Returns the sum as bytes, for another process of the same version.
    fn to_bytes<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &self.0.to_bytes())
    }

    /// The frame.
    #[getter]
    fn frame(&self) -> Frame {
        Frame(*self.0.frame())
    }

    /// The volume, the centroid and the inertia.
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

/// Measures volume, centroid and inertia of the part of a `solid` in one cell of a `frame` (a `Frame`, or an
/// octree on that frame). It ends when the width of the interval of the volume in the cell is at most
/// `tolerance` times that volume, or at most `absolute` (cubic model units).
///
/// The cell is the one with this `code` (Morton order) on a `level`. Without them, it is the whole frame.
/// `max_splits` limits the number of splits.
///
/// >>> from leafless.shards import measure_cell
/// >>> ball, frame = Csg.ball([0, 0, 0], 1), Frame([-1, -1, -1], 2, 20)
/// >>> octants = [measure_cell(ball, frame, 1, code, tolerance=1e-4) for code in range(8)]
/// >>> 4.18879020478639 in sum(octants[1:], octants[0]).properties.volume
/// True
#[pyfunction]
#[pyo3(signature = (solid, frame, level=Deep(0), code=0, *, tolerance=1e-3, absolute=0.0, **limits),
    text_signature = "(solid, frame, level=0, code=0, *, tolerance=1e-3, absolute=0.0, **limits)")]
pub fn measure_cell(
    solid: &Bound<'_, PyAny>,
    frame: FrameLike,
    #[pyo3(from_py_with = named::level)] level: Level,
    #[pyo3(from_py_with = named::code)] code: u64,
    #[pyo3(from_py_with = named::tolerance)] tolerance: f64,
    #[pyo3(from_py_with = named::absolute)] absolute: f64,
    limits: Option<&Bound<'_, PyDict>>,
) -> PyResult<MassSum> {
    let (py, limits) = (solid.py(), Limits::of(limits)?);
    let (solid, cell) = (given(solid, "solid")?, cell_of(py, &frame.0, level, code)?);
    let tolerance = wanted(py, tolerance, absolute)?;
    let ask =
        |control: &leafless::Control<'_>| query::measure_in(&solid.shape, &frame.0, cell, tolerance, control);
    limits.run(py, ask).map(MassSum)
}

/// Joins the knowledge of several `octrees` on one frame about one solid. A cell is FULL or EMPTY if one of
/// them says so, and PARTIAL where all leave it open. Surfaces that one of them keeps are kept. This is the
/// reverse of cutting an octree into shards, byte for byte.
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
    octrees: &Bound<'py, PyAny>,
    limits: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, Octree>> {
    let limits = Limits::of(limits)?;
    let all: Vec<Bound<'_, Octree>> = sequence(octrees, "octrees", "a sequence of octrees")?
        .map(|one| Argument::take(&one?, "octrees"))
        .collect::<PyResult<_>>()?;
    let views: Vec<OctreeRef<'_>> = all.iter().map(|octree| *octree.get().octree.view()).collect();
    let found = limits
        .run(py, |control| leafless::op::join(&views, control).map_err(called([("trees", "octrees")])))?;
    Octree::bound(py, found)
}

/// A solid of shards that are not joined: a `top`, and `shards` of cells of one `level` that the top leaves
/// open, as pairs of the cell's code and the octree. A shard is read when a query needs one of its cells. A
/// cell without a shard is PARTIAL.
#[pyclass(extends = Solid, frozen, module = "leafless.shards")]
pub struct ShardedSolid(ShardedOctree);

#[pymethods]
impl ShardedSolid {
    /// Makes a solid of a top, and of shards with the codes of their cells.
    #[new]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = named::top)] top: Bound<'_, Octree>,
        #[pyo3(from_py_with = named::level)] level: Level,
        shards: &Bound<'_, PyAny>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let top = &top.get().octree;
        let octree =
            |given: &Bound<'_, PyAny>| Ok(<Bound<'_, Octree>>::take(given, "shards")?.get().octree.clone());
        let list = by_codes(shards, top.frame(), level, "an octree", octree)?;
        let sharded = py.detach(|| ShardedOctree::new(top.clone(), list)).or_raise(py)?;
        let given = Given::new(AnySolid::new(sharded.clone()));
        Ok(PyClassInitializer::from(Solid::new(given)).add_subclass(ShardedSolid(sharded)))
    }

    /// The frame of the whole.
    #[getter]
    fn frame(&self) -> Frame {
        Frame(*self.0.frame())
    }

    fn __repr__(&self) -> String {
        format!("<ShardedSolid: depth {}, {} shards>", self.0.frame().depth(), self.0.shards().len())
    }

    /// Pickles the bytes of the octrees.
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

/// Returns the statistics of a `top` and of `shards` of cells of a `level`, in the form of
/// `Octree.statistics`. A shard is a pair of the cell's code and of counts: for each level of the frame, the
/// numbers of nodes, FULL cells and PARTIAL cells.
#[pyfunction]
pub fn joined_statistics<'py>(
    py: Python<'py>,
    #[pyo3(from_py_with = named::top)] top: Bound<'py, Octree>,
    #[pyo3(from_py_with = named::level)] level: Level,
    shards: &Bound<'py, PyAny>,
) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let top = &top.get().octree;
    let frame = top.frame();
    let counts = |given: &Bound<'py, PyAny>| {
        let rows = sequence(given, "shards", "a sequence of counts")?;
        rows.map(|row| Argument::take(&row?, "shards")).collect::<PyResult<Vec<[u64; 3]>>>()
    };
    let list = by_codes(shards, frame, level, "counts", counts)?;
    let found = py.detach(|| {
        let list: Vec<_> =
            list.into_iter().map(|(cell, counts)| (cell, Statistics::of_counts(frame, &counts))).collect();
        top.statistics_with(&list)
    });
    crate::octree::told(py, &found.or_raise(py)?)
}

/// Returns the triangles of marching cubes in the cell with this `code` on a `level`, as vertices and faces.
/// `octree` is the cell's shard, joined with the shards of its neighbours towards +x, +y and +z. `resolve`
/// decides whether undecided cells belong to the solid: "outer" (they do) or "inner" (they do not).
#[pyfunction]
#[pyo3(signature = (octree, level, code, resolve, **limits))]
pub fn surface_in<'py>(
    py: Python<'py>,
    #[pyo3(from_py_with = named::octree)] octree: Bound<'py, Octree>,
    #[pyo3(from_py_with = named::level)] level: Level,
    #[pyo3(from_py_with = named::code)] code: u64,
    #[pyo3(from_py_with = named::resolve)] resolve: &str,
    limits: Option<&Bound<'py, PyDict>>,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
    let limits = Limits::of(limits)?;
    let view = octree.get().octree.view();
    let cell = cell_of(py, view.frame(), level, code)?;
    let resolve: Resolve<'static> = words::value(py, resolve)?;
    let (vertices, faces) = limits.run(py, |control| {
        let mesh =
            marching_cubes_in(view, Some(resolve), cell, control).map_err(called([("cell", "level")]))?;
        Ok((mesh.vertices().to_vec(), mesh.triangles().to_vec()))
    })?;
    Ok((arrays::rows(py, vertices)?.into_any(), arrays::rows(py, faces)?.into_any()))
}
