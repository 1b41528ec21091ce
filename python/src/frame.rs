//! The frame: the cube of an octree, and its depth.

use crate::arguments::{Deep, Depth, Level, named};
use crate::arrays::{self, Rows, doubles, shape_text, triple};
use crate::error::{OrRaise, called, refused};
use leafless::Frame as Inner;
use leafless::lattice::MAX_DEPTH;
use numpy::{PyArrayMethods, PyUntypedArrayMethods};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

/// The lattice of an octree: a cube in model space, the *universe*, and the number of times that it may be
/// halved. `origin` is the lower corner and `edge` the length of the cube (model units). The cube has
/// 2^`depth` cells along each axis, with `depth` from 1 to 20.
///
/// >>> frame = Frame([0, 0, 0], 128.0, depth=10)
/// >>> frame.cells, frame.cell_size
/// (1024, 0.125)
/// >>> Frame.around([[0, 0, 0], [80, 60, 10]], depth=10).edge >= 80
/// True
#[pyclass(frozen, eq, weakref, from_py_object, module = "leafless")]
#[derive(Clone, Copy, PartialEq)]
pub struct Frame(pub Inner);

#[pymethods]
impl Frame {
    /// Makes the frame with the lower corner `origin` and the length `edge` (model units), in 2^`depth` cells
    /// along each axis, `depth` from 1 to 20.
    #[new]
    #[pyo3(signature = (origin, edge, depth))]
    fn new(
        origin: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = named::edge)] edge: f64,
        #[pyo3(from_py_with = named::depth)] depth: Depth,
    ) -> PyResult<Frame> {
        let py = origin.py();
        Inner::new(triple(origin, "origin")?, edge, depth.0).or_raise(py).map(Frame)
    }

    /// Returns a frame of a `depth` around `bounds` (lower and upper corner), somewhat larger than the
    /// bounds.
    #[staticmethod]
    #[pyo3(signature = (bounds, depth=Deep(MAX_DEPTH)), text_signature = "(bounds, depth=20)")]
    fn around(
        bounds: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = named::depth)] depth: Depth,
    ) -> PyResult<Frame> {
        let [min, max] = corners(bounds, "bounds")?;
        Inner::around(min, max, depth.0).map_err(called(CORNERS)).or_raise(bounds.py()).map(Frame)
    }

    /// Returns a frame of a `depth` around `bounds` that suits parts with round dimensions. If the bounds
    /// allow it, the lattice planes are round numbers, and plane faces of such parts lie in them. Otherwise
    /// the frame is that of `around`.
    #[staticmethod]
    #[pyo3(signature = (bounds, depth=Deep(MAX_DEPTH)), text_signature = "(bounds, depth=20)")]
    fn fitted(
        bounds: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = named::depth)] depth: Depth,
    ) -> PyResult<Frame> {
        let [min, max] = corners(bounds, "bounds")?;
        Inner::fitted(min, max, depth.0).map_err(called(CORNERS)).or_raise(bounds.py()).map(Frame)
    }

    /// Returns a frame around `bounds` whose finest cells have the edge `cell`.
    #[staticmethod]
    fn with_cells(
        bounds: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = named::cell)] cell: f64,
    ) -> PyResult<Frame> {
        let [min, max] = corners(bounds, "bounds")?;
        Inner::with_cells(min, max, cell).map_err(called(CORNERS)).or_raise(bounds.py()).map(Frame)
    }

    /// Returns the same cube with another `depth`.
    fn with_depth(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = named::depth)] depth: Depth,
    ) -> PyResult<Frame> {
        self.0.with_depth(depth.0).or_raise(py).map(Frame)
    }

    /// The lower corner (model units).
    #[getter]
    fn origin(&self) -> (f64, f64, f64) {
        self.0.origin().into()
    }

    /// The length of the cube's edge (model units).
    #[getter]
    fn edge(&self) -> f64 {
        self.0.edge()
    }

    /// The number of times that the cube may be halved.
    #[getter]
    fn depth(&self) -> u8 {
        self.0.depth()
    }

    /// The number of finest cells along an edge: 2^depth.
    #[getter]
    fn cells(&self) -> u32 {
        self.0.cells()
    }

    /// The edge of a finest cell (model units).
    #[getter]
    fn cell_size(&self) -> f64 {
        self.0.cell_size()
    }

    /// Returns the codes (Morton order) of the cells of a `level` that contain `points` (shape (n, 3)): an
    /// array of type uint64. A point outside the cube has the code 2^64 - 1. A point on a wall belongs to the
    /// cell behind it.
    fn codes<'py>(
        &self,
        points: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = named::level)] level: Level,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (py, frame) = (points.py(), self.0);
        let level = level_of(py, &frame, level)?;
        let points = Rows::of(points, "points")?;
        let list = points.list();
        let code = |point: &[f64; 3]| {
            let at = frame.cell_of(*point)?.map(|a| a >> (frame.depth() - level));
            Some(leafless::Cell { level, at }.morton())
        };
        let codes: Vec<u64> =
            py.detach(|| list.iter().map(|point| code(point).unwrap_or(u64::MAX)).collect());
        let count = codes.len();
        Ok(arrays::array(py, codes, &[count])?.into_any())
    }

    fn __repr__(&self) -> String {
        let [x, y, z] = self.0.origin();
        format!("Frame(({x:?}, {y:?}, {z:?}), {:?}, depth={})", self.0.edge(), self.0.depth())
    }

    fn __hash__(&self) -> u64 {
        hash(&self.0)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let frame = slf.get();
        let arguments = (frame.origin(), frame.edge(), frame.depth());
        Ok((slf.get_type().into_any(), arguments.into_bound_py_any(slf.py())?))
    }
}

/// Reads a lower and an upper corner.
pub fn corners(given: &Bound<'_, PyAny>, name: &str) -> PyResult<[[f64; 3]; 2]> {
    let array = doubles(given, name)?;
    match (array.shape(), array.readonly().as_slice()?) {
        ([2, 3], &[a, b, c, d, e, f]) => Ok([[a, b, c], [d, e, f]]),
        (shape, _) => {
            let shape = shape_text(shape);
            let problem = format!("must be a lower and an upper corner, of the shape (2, 3), not {shape}");
            Err(refused(given.py(), name, problem))
        }
    }
}

/// Returns a level, or refuses one below the depth of the frame.
pub fn level_of(py: Python<'_>, frame: &Inner, Deep(level): Level) -> PyResult<u8> {
    if level <= frame.depth() {
        return Ok(level);
    }
    let problem = format!("must be at most the depth of the frame, {}, not {level}", frame.depth());
    Err(refused(py, "level", problem))
}

/// The library's names of the corners of bounds.
pub const CORNERS: [(&str, &str); 2] = [("min", "bounds"), ("max", "bounds")];

/// Returns a hash of a frame. Equal frames have equal hashes.
pub fn hash(frame: &Inner) -> u64 {
    let numbers = frame.origin().into_iter().chain([frame.edge()]);
    numbers.fold(frame.depth().into(), |hash: u64, x| hash.rotate_left(13) ^ (x + 0.0).to_bits())
}
