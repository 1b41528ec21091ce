//! Octrees that are split on demand.

use crate::answers::memberships;
use crate::arguments::{Level, named, other_type};
use crate::arrays::triple;
use crate::ask::{FrameLike, Wish};
use crate::error::{called, refused};
use crate::frame::{Frame, corners};
use crate::interval::Interval;
use crate::octree::Octree;
use crate::solid::given;
use crate::work::Limits;
use leafless::lattice::MAX_DEPTH;
use leafless::op::{Refinement, Zone};
use leafless::query::Membership;
use leafless::{LazyOctree as Inner, Solid as _};
use pyo3::exceptions::{PyRuntimeError, PyTypeError};
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::{Mutex, MutexGuard, TryLockError};

/// An octree of a `solid` that splits cells only where you ask, and remembers them.
///
/// `frame` is the cube of the octree: a `Frame`, or an octree on that frame. Without it, it is a cube around
/// the solid. With `resume`, the octree begins with the cells of an octree that `freeze` made of the same
/// solid.
///
/// >>> lazy = LazyOctree(Csg.ball([0, 0, 0], 1))
/// >>> lazy.refine(level=4)
/// True
/// >>> lazy.refine(level=12, point=[0, 0, 1])
/// True
/// >>> lazy.freeze()
/// <Octree: depth 20, 345 nodes, volume 3.063 to 5.329>
#[pyclass(frozen, weakref, module = "leafless")]
pub struct LazyOctree {
    lazy: Mutex<Inner<'static>>,
    /// The Python object of the solid, kept alive.
    solid: Py<PyAny>,
}

impl LazyOctree {
    /// Locks the octree, or fails if another call is working on it. A shape's own method must not wait for
    /// the call that called it.
    fn lock(&self) -> PyResult<MutexGuard<'_, Inner<'static>>> {
        match self.lazy.try_lock() {
            Ok(lazy) => Ok(lazy),
            Err(TryLockError::Poisoned(lazy)) => Ok(lazy.into_inner()),
            Err(TryLockError::WouldBlock) => {
                Err(PyRuntimeError::new_err("another call is at work on this LazyOctree"))
            }
        }
    }
}

/// The library's names of the parts of zones.
const ZONE: [(&str, &str); 5] =
    [("min", "bounds"), ("max", "bounds"), ("origin", "ray"), ("direction", "ray"), ("from", "ray")];

#[pymethods]
impl LazyOctree {
    /// Makes an octree of one undecided cell. With `resume`, it begins with the cells of a frozen octree of
    /// the same solid.
    #[new]
    #[pyo3(signature = (solid, frame=None, *, resume=None, **limits))]
    fn new(
        solid: &Bound<'_, PyAny>,
        frame: Option<FrameLike>,
        #[pyo3(from_py_with = named::resume)] resume: Option<Bound<'_, Octree>>,
        limits: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<LazyOctree> {
        let (py, limits) = (solid.py(), Limits::of(limits)?);
        let given = given(solid, "solid")?;
        let resume = resume.as_ref().map(|known| &known.get().octree);
        let frame = match (frame, resume) {
            (None, Some(known)) => *known.frame(),
            (frame, _) => Wish { frame, depth: None }.of(py, &given, MAX_DEPTH)?,
        };
        let shape = given.shape;
        let lazy = limits.run(py, |control| match resume {
            Some(known) => Inner::resume(known, shape, &frame, control),
            None => {
                shape.on(&frame, control)?;
                Inner::new(shape, &frame)
            }
        })?;
        Ok(LazyOctree { lazy: Mutex::new(lazy), solid: solid.clone().unbind() })
    }

    /// Splits undecided cells down to a `level`: all of them, or those in a box (`bounds`), around a `point`,
    /// or along a `ray` (origin and direction). Returns True when all is done. Returns False if a limit came
    /// first (`max_splits`, `max_nodes`, `max_bytes`); the cells split so far are kept.
    #[pyo3(signature = (level, *, bounds=None, point=None, ray=None, **limits))]
    fn refine(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = named::level)] level: Level,
        bounds: Option<&Bound<'_, PyAny>>,
        point: Option<&Bound<'_, PyAny>>,
        ray: Option<&Bound<'_, PyAny>>,
        limits: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<bool> {
        let zone = match (bounds, point, ray) {
            (None, None, None) => Zone::Whole,
            (Some(bounds), None, None) => {
                let [min, max] = corners(bounds, "bounds")?;
                Zone::Box { min, max }
            }
            (None, Some(point), None) => Zone::Point(triple(point, "point")?),
            (None, None, Some(ray)) => {
                let pair = || other_type(ray, "ray", "an origin and a direction");
                let [origin, direction]: [Bound<'_, PyAny>; 2] = ray.extract().map_err(|_| pair())?;
                let (origin, direction) = (triple(&origin, "ray")?, triple(&direction, "ray")?);
                Zone::Ray { origin, direction, from: 0.0, to: f64::INFINITY }
            }
            _ => return Err(refused(py, "bounds", "must be the only zone: bounds, point or ray")),
        };
        let limits = Limits::of(limits)?;
        let mut lazy = self.lock()?;
        let lazy = &mut *lazy;
        let done = limits.run(py, |control| lazy.refine(&zone, level.0, control).map_err(called(ZONE)))?;
        Ok(done == Refinement::Done)
    }

    /// Classifies `points` (shape (n, 3)) by the known cells, without splitting.
    fn contains<'py>(&self, points: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let py = points.py();
        let rows = crate::arrays::Rows::of(points, "points")?;
        let list = rows.list();
        let lazy = self.lock()?;
        let known = &*lazy;
        let answers: Vec<Membership> =
            py.detach(|| list.iter().map(|&point| known.contains(point)).collect());
        memberships(py, &answers, rows.is_one)
    }

    /// The frame of the octree.
    #[getter]
    fn frame(&self) -> PyResult<Frame> {
        Ok(Frame(*self.lock()?.frame()))
    }

    /// The number of cells that were split.
    #[getter]
    fn splits(&self) -> PyResult<u64> {
        Ok(self.lock()?.splits())
    }

    /// The interval of the volume that follows from the known cells.
    #[getter]
    fn volume(&self) -> PyResult<Interval> {
        Ok(Interval(self.lock()?.statistics().volume()))
    }

    /// Returns the known cells as an octree. It remembers the solid, so that `resume` can continue from it.
    #[pyo3(signature = (**limits))]
    fn freeze<'py>(
        &self,
        py: Python<'py>,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, Octree>> {
        let lazy = self.lock()?;
        let known = &*lazy;
        let octree = Limits::of(limits)?.run(py, |control| known.freeze(control))?;
        Octree::bound(py, octree)
    }

    fn __repr__(&self) -> String {
        match self.lock() {
            Ok(lazy) => {
                format!("<LazyOctree: {} splits, volume {}>", lazy.splits(), lazy.statistics().volume())
            }
            Err(_) => "<LazyOctree at work>".into(),
        }
    }

    fn __reduce__(&self) -> PyResult<()> {
        Err(PyTypeError::new_err(
            "a LazyOctree cannot be pickled: pickle the solid and what freeze() makes, and resume with both",
        ))
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&self.solid)
    }
}
