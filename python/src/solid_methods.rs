//! The methods of all solids: queries with arrays of points and rays, and operators.

use crate::answers::{distances_found, memberships, rays_found};
use crate::arguments::named;
use crate::arrays::{self, Rows};
use crate::ask::{FrameLike, Wish};
use crate::error::{called, refused};
use crate::from_package;
use crate::octree::Octree;
use crate::operators::{self, Operator};
use crate::solid::{Given, Solid, given};
use crate::words;
use crate::work::{Limits, advance};
use leafless::lattice::MAX_DEPTH;
use leafless::query::{DistanceTo, Obstacle, distances};
use leafless::{AnySolid, Control, Membership, Proof, Ray, Solid as _, cast_rays, contains};
use pyo3::exceptions::{PyException, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The maximum sizes of queries that are answered on the calling thread. Larger ones may take longer than a
/// user wants to wait for Ctrl-C.
const FEW_POINTS: usize = 4096;
const FEW_RAYS: usize = 256;
const FEW_DISTANCES: usize = 16;

/// The number of points that an octree classifies between two checks of signals.
const CHUNK: usize = 1 << 16;

/// The library's names of the parts of a ray.
const RAY: [(&str, &str); 2] = [("origin", "origins"), ("direction", "directions")];

/// The default tolerance of distances, as a part of the frame's edge.
const TOLERANCE: f64 = 1e-6;

/// Returns the solid of an object. For an octree it is the solid of the cells, without regard to their proof
/// about the source solid.
fn of_cells(object: &Bound<'_, Solid>) -> PyResult<Given> {
    match object.cast::<Octree>() {
        Ok(octree) if !octree.get().octree.proof().is_certified() => {
            Ok(Given::new(AnySolid::new(octree.get().octree.with_proof(Proof::CERTIFIED))))
        }
        _ => given(object, "self"),
    }
}

#[pymethods]
impl Solid {
    /// Makes NumPy's operators defer to this class.
    #[classattr]
    #[allow(non_upper_case_globals)]
    const __array_ufunc__: Option<u8> = None;

    /// A box that contains the solid, as an array of its lower and its upper corner; `None` if none is known.
    /// The box may be larger than the solid. `bounding_box` returns proven bounds of the solid's extent.
    #[getter]
    fn bounds<'py>(slf: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let bounds = given(slf, "self")?.bounds(slf.py());
        let array = bounds.map(|bounds| arrays::rows(slf.py(), vec![bounds.min, bounds.max]));
        Ok(array.transpose()?.map(Bound::into_any))
    }

    /// A text that identifies the solid: solids with the same fingerprint give the same answers. `None` if a
    /// part of the solid has no fingerprint, as a shape written in Python.
    #[getter]
    fn fingerprint(slf: &Bound<'_, Self>) -> PyResult<Option<String>> {
        let (py, solid) = (slf.py(), given(slf, "self")?);
        Ok(py.detach(|| solid.shape.fingerprint()).map(|fingerprint| fingerprint.to_string()))
    }

    /// Classifies points as inside, outside or undecided. `points` has the shape (n, 3), in model units. The
    /// answer is an array of the codes of `Membership`, of type uint8; compare it, as in
    /// `points[part.contains(points) == INSIDE]`. A single point has a single answer. A point in an undecided
    /// cell of an octree is UNDECIDED, and so is a point outside the frame about which nothing is known. On
    /// the boundary both answers are right.
    ///
    /// `frame` is the cube of the query: a `Frame`, or an octree on that frame. Without it, an octree uses
    /// its own frame, and any other solid a cube around it.
    ///
    /// >>> ball = Csg.ball([0, 0, 0], 1)
    /// >>> ball.contains([[0, 0, 0.999], [0, 0, 1.001]])
    /// array([1, 0], dtype=uint8)
    /// >>> ball.contains([0, 0, 0])
    /// <Membership.INSIDE: 1>
    #[pyo3(signature = (points, *, frame=None, **limits))]
    fn contains<'py>(
        slf: &Bound<'py, Self>,
        points: &Bound<'py, PyAny>,
        frame: Option<FrameLike>,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = slf.py();
        let (limits, points) = (Limits::of(limits)?, Rows::of(points, "points")?);
        let solid = of_cells(slf)?;
        let list = points.list();
        let mut answers = vec![Membership::Undecided; list.len()];
        let long = list.len() > FEW_POINTS || solid.calls_python;
        match slf.cast::<Octree>() {
            Ok(octree) if frame.is_none() && !solid.keeps_surfaces => {
                let view = octree.get().octree.view();
                limits.run_if(long, py, |control| {
                    let chunks = list.chunks(CHUNK).zip(answers.chunks_mut(CHUNK)).enumerate();
                    for (i, (points, answers)) in chunks {
                        advance(control, i * CHUNK, list.len())?;
                        view.contains_many(points, answers)?;
                    }
                    Ok(())
                })?;
            }
            _ => {
                let frame = Wish { frame, depth: None }.of(py, &solid, MAX_DEPTH)?;
                let ask = |control: &Control<'_>| contains(&solid.shape, &frame, list, &mut answers, control);
                limits.run_if(long, py, ask)?;
            }
        }
        // A point beyond the frame and beyond the box that contains the solid is proven outside.
        if let Some(bounds) = solid.bounds(py) {
            let is_beyond = |axis: usize, x: f64| x < bounds.min[axis] || x > bounds.max[axis];
            py.detach(|| {
                for (answer, point) in answers.iter_mut().zip(list) {
                    if *answer == Membership::Undecided && (0..3).any(|axis| is_beyond(axis, point[axis])) {
                        *answer = Membership::Outside;
                    }
                }
            });
        }
        memberships(py, &answers, points.is_one)
    }

    /// Returns the signed distances of points from the boundary, negative inside, as intervals that contain
    /// the truth. `points` has the shape (n, 3), in model units. An interval is no wider than `tolerance`
    /// where that is possible. The default is a millionth of the frame's edge. `to="solid"` measures to the
    /// solid (0 inside), `to="complement"` to the complement (0 outside).
    ///
    /// The answer is a `Distances`: `distance` (`Intervals`), `nearest` (points of the boundary), `surface`
    /// (numbers of the triangles or surfaces there) and `undecided` (true where the interval is wider than
    /// the tolerance). A single point has a `Distance`, whose `distance` is an `Interval`.
    ///
    /// `frame` is the cube of the query: a `Frame`, or an octree on that frame. Without it, it is a cube
    /// around the solid.
    ///
    /// >>> found = Csg.ball([0, 0, 0], 1).distances([[3, 0, 4], [0, 0.5, 0]], tolerance=1e-9)
    /// >>> found.distance.middle.round(6)
    /// array([ 4. , -0.5])
    /// >>> 4 in Csg.ball([0, 0, 0], 1).distances([3, 0, 4]).distance
    /// True
    #[pyo3(signature = (points, *, to="boundary", tolerance=None, frame=None, **limits))]
    fn distances<'py>(
        slf: &Bound<'py, Self>,
        points: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = named::to)] to: &str,
        #[pyo3(from_py_with = named::tolerance)] tolerance: Option<f64>,
        frame: Option<FrameLike>,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = slf.py();
        let (limits, points) = (Limits::of(limits)?, Rows::of(points, "points")?);
        let to: DistanceTo = words::value(py, to)?;
        let solid = of_cells(slf)?;
        let frame = Wish { frame, depth: None }.of(py, &solid, MAX_DEPTH)?;
        let tolerance = tolerance.unwrap_or(TOLERANCE * frame.edge());
        let list = points.list();
        let found = limits.run_if(list.len() > FEW_DISTANCES || solid.calls_python, py, |control| {
            distances(&solid.shape, &frame, list, to, tolerance, control)
        })?;
        distances_found(py, &found, tolerance, points.is_one)
    }

    /// Returns the first hits of rays on the solid. `origins` and `directions` have the shape (n, 3); a
    /// single origin or direction is used for all rays. Distances are multiples of the direction's length.
    /// `on="inner"` stops a ray where the solid is proven, `on="outer"` where the solid is possible. `last`
    /// is the distance at which all rays end.
    ///
    /// The answer is a `RayHits`: `hit`, `distance` (`Intervals`), `normal` and `surface`. The ray is proven
    /// outside before the lower end of a distance, and inside at the upper end. A single origin with a single
    /// direction has a `RayHit`, whose `distance` is an `Interval`.
    ///
    /// `frame` is the cube of the query: a `Frame`, or an octree on that frame. Without it, it is a cube
    /// around the solid.
    ///
    /// >>> hits = Csg.ball([0, 0, 0], 1).rays([[-2, 0.6, 0], [-2, 2, 0]], [1, 0, 0])
    /// >>> hits.hit, 1.2 in hits.distance[0]
    /// (array([ True, False]), True)
    /// >>> Csg.ball([0, 0, 0], 1).rays([-2, 0, 0], [1, 0, 0]).hit
    /// True
    #[pyo3(signature = (origins, directions, *, on="inner", last=f64::INFINITY, frame=None, **limits))]
    fn rays<'py>(
        slf: &Bound<'py, Self>,
        origins: &Bound<'py, PyAny>,
        directions: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = named::on)] on: &str,
        #[pyo3(from_py_with = named::last)] last: f64,
        frame: Option<FrameLike>,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = slf.py();
        let limits = Limits::of(limits)?;
        let on: Obstacle = words::value(py, on)?;
        let (origins, directions) = (Rows::of(origins, "origins")?, Rows::of(directions, "directions")?);
        let solid = of_cells(slf)?;
        let frame = Wish { frame, depth: None }.of(py, &solid, MAX_DEPTH)?;
        let count = match (origins.list().len(), directions.list().len()) {
            (n, m) if n == m => n,
            (n, _) if directions.is_one => n,
            (_, m) if origins.is_one => m,
            (n, m) => {
                return Err(refused(
                    py,
                    "directions",
                    format!("must be one, or as many as origins, {n}, not {m}"),
                ));
            }
        };
        let (from, along) = (origins.list(), directions.list());
        let at = |list: &[[f64; 3]], i: usize| if list.len() == 1 { list[0] } else { list[i] };
        let found = limits.run_if(count > FEW_RAYS || solid.calls_python, py, |control| {
            let mut rays = Vec::new();
            rays.try_reserve_exact(count).map_err(|_| leafless::Error::OutOfMemory)?;
            for i in 0..count {
                rays.push(Ray::new(at(from, i), at(along, i)).map_err(called(RAY))?.until(last)?);
            }
            cast_rays(&solid.shape, &frame, &rays, on, control)
        })?;
        rays_found(py, &found, origins.is_one && directions.is_one)
    }

    /// Returns the solid moved by a `placement`, an `Affine` or a matrix. A mesh stays a mesh; any other
    /// solid becomes an expression. Meshes and expressions are moved exactly. The cells of an octree blur by
    /// about one cell, unless the map consists of quarter turns and moves by whole cells.
    fn placed<'py>(slf: &Bound<'py, Self>, placement: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        operators::placed(slf, placement)
    }

    fn __or__<'py>(slf: &Bound<'py, Self>, other: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        operators::combined(Operator::Union, slf, other)
    }

    fn __and__<'py>(slf: &Bound<'py, Self>, other: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        operators::combined(Operator::Intersection, slf, other)
    }

    fn __sub__<'py>(slf: &Bound<'py, Self>, other: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        operators::combined(Operator::Difference, slf, other)
    }

    fn __xor__<'py>(slf: &Bound<'py, Self>, other: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        operators::combined(Operator::Xor, slf, other)
    }

    fn __invert__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        operators::complement(slf)
    }

    fn __matmul__<'py>(slf: &Bound<'py, Self>, placement: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let _ = (slf, placement);
        Err(PyTypeError::new_err("a placement stands before the solid: placement @ solid"))
    }

    fn __rmatmul__<'py>(
        slf: &Bound<'py, Self>,
        placement: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        operators::placed(slf, placement)
    }

    /// Returns a picture, for notebooks.
    fn _repr_png_<'py>(slf: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyAny>>> {
        // A solid that cannot be drawn is shown as text.
        match from_package!(slf.py(), "leafless._leafless", "render")?.call1((slf,)) {
            Ok(picture) => picture.call_method0("_repr_png_").map(Some),
            Err(error) if error.is_instance_of::<PyException>(slf.py()) => Ok(None),
            Err(error) => Err(error),
        }
    }
}
