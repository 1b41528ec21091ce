//! Two solids: whether they overlap, how far apart they are, and how far their boundaries differ.

use crate::affine::affines;
use crate::anywhere::anywhere;
use crate::arguments::{Depth, named};
use crate::arrays;
use crate::ask::{FrameLike, Wish};
use crate::error::OrRaise;
use crate::interval::Interval;
use crate::solid::{Given, given};
use crate::words;
use crate::work::Limits;
use leafless::query::{self, clearance_at, gap_at_least_at, interference_at};
use leafless::{Affine, AnySolid, Bounds, Control, Error, Frame as Inner};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// The default depth of the frame for two solids.
const DEPTH: u8 = 16;

/// The default number of splits for each answer.
const SPLITS: u64 = 100_000;

/// The default tolerance of distances, as a part of the frame.
const TOLERANCE: f64 = 1e-6;

/// Whether two solids overlap.
#[pyclass(frozen, module = "leafless")]
pub struct Interference(query::Interference);

#[pymethods]
impl Interference {
    /// "disjoint" (proven: no common point but on the boundaries), "overlapping" (proven) or "undecided".
    #[getter]
    fn verdict(&self) -> &'static str {
        words::word(self.0.verdict)
    }

    /// The volume of what both have in common (cubic model units).
    #[getter]
    fn volume(&self) -> Interval {
        Interval(self.0.volume)
    }

    /// A ball that lies in both, as its centre and radius, if an overlap is proven.
    #[getter]
    fn ball(&self) -> Option<((f64, f64, f64), f64)> {
        self.0.ball.map(|ball| (ball.centre.into(), ball.radius))
    }

    /// Whether a solid may go on beyond the frame.
    #[getter]
    fn clipped(&self) -> bool {
        self.0.clipped
    }

    /// How many cells of each were split.
    #[getter]
    fn splits(&self) -> (u64, u64) {
        self.0.splits.into()
    }

    fn __repr__(&self) -> String {
        format!("<Interference: {}, volume {}>", self.verdict(), self.0.volume)
    }
}

/// How far two solids are apart.
#[pyclass(frozen, module = "leafless")]
pub struct Clearance(query::Clearance);

#[pymethods]
impl Clearance {
    /// The distance (model units); 0 where they overlap.
    #[getter]
    fn distance(&self) -> Interval {
        Interval(self.0.distance)
    }

    /// A point of each, as near as the upper bound says: an array of shape (2, 3), if they are known.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let array = self.0.points.map(|points| arrays::rows(py, points.to_vec()));
        Ok(array.transpose()?.map(Bound::into_any))
    }

    /// How deep they overlap at the least; 0 if they do not, or nothing is known.
    #[getter]
    fn depth(&self) -> f64 {
        self.0.depth
    }

    /// Why it ended: "tolerance", "budget" or "exhausted".
    #[getter]
    fn stop_reason(&self) -> &'static str {
        words::word(self.0.stop_reason)
    }

    /// Whether a solid may go on beyond the frame.
    #[getter]
    fn clipped(&self) -> bool {
        self.0.clipped
    }

    /// How many cells of each were split.
    #[getter]
    fn splits(&self) -> (u64, u64) {
        self.0.splits.into()
    }

    fn __repr__(&self) -> String {
        format!("<Clearance: {}>", self.0.distance)
    }
}

/// Whether two solids are far enough apart.
#[pyclass(frozen, module = "leafless")]
pub struct Gap(query::Gap);

#[pymethods]
impl Gap {
    /// "yes" (proven), "no" (proven) or "undecided".
    #[getter]
    fn verdict(&self) -> &'static str {
        words::word(self.0.verdict)
    }

    /// What is known of the distance by then.
    #[getter]
    fn distance(&self) -> Interval {
        Interval(self.0.evidence.distance)
    }

    fn __repr__(&self) -> String {
        format!("<Gap: {}, distance {}>", self.verdict(), self.0.evidence.distance)
    }
}

/// How far the boundaries of two solids are from each other.
#[pyclass(frozen, module = "leafless")]
pub struct Deviation(query::Deviation);

#[pymethods]
impl Deviation {
    /// The greatest distance of a boundary point of one from the boundary of the other (Hausdorff).
    #[getter]
    fn distance(&self) -> Interval {
        Interval(self.0.distance())
    }

    /// The same of points of the first only.
    #[getter]
    fn a_to_b(&self) -> Interval {
        Interval(self.0.a_to_b.distance)
    }

    /// The same of points of the second only.
    #[getter]
    fn b_to_a(&self) -> Interval {
        Interval(self.0.b_to_a.distance)
    }

    /// Where that is: a point of one boundary and the nearest of the other, as an array of shape (2, 3), if it is known.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let (one, other) = (&self.0.a_to_b, &self.0.b_to_a);
        let farther = if one.distance.lower >= other.distance.lower { one } else { other };
        let array = farther.at.map(|at| arrays::rows(py, vec![at.point, at.nearest]));
        Ok(array.transpose()?.map(Bound::into_any))
    }

    /// Whether the boundaries are within a `distance` (model units) of each other: "yes", "no" or "undecided".
    fn within(&self, #[pyo3(from_py_with = named::distance)] distance: f64) -> &'static str {
        words::word(self.0.within(distance))
    }

    /// Why it ended: "tolerance", "budget" or "exhausted".
    #[getter]
    fn stop_reason(&self) -> &'static str {
        words::word(self.0.stop_reason)
    }

    fn __repr__(&self) -> String {
        format!("<Deviation: {}>", self.0.distance())
    }
}

/// Two solids, the places of the second, and the frame to look at.
struct Pair {
    a: Given,
    b: Given,
    /// None: where it is.
    placements: Option<Vec<Affine>>,
    /// Whether one placement was given, and one answer is expected.
    is_one: bool,
    frame: Inner,
    own: Inner,
    limits: Limits,
}

/// Limits with a number of splits.
fn budgeted(limits: Option<&Bound<'_, PyDict>>) -> PyResult<Limits> {
    let mut limits = Limits::of(limits)?;
    limits.max_splits = limits.max_splits.or(Some(SPLITS));
    Ok(limits)
}

impl Pair {
    fn of(
        a: &Bound<'_, PyAny>,
        b: &Bound<'_, PyAny>,
        placements: Option<&Bound<'_, PyAny>>,
        wish: Wish,
        limits: Limits,
    ) -> PyResult<Pair> {
        let py = a.py();
        let (a, b) = (given(a, "a")?, given(b, "b")?);
        let is_one = match placements {
            None => true,
            Some(given) => {
                given.cast::<crate::affine::Affine>().is_ok() || crate::affine::affine(given, "").is_ok()
            }
        };
        let placements = placements.map(|given| affines(given, "placements")).transpose()?;
        let places = placements.as_deref().unwrap_or(&[Affine::IDENTITY]);
        let frame = wish.of_both(py, [&a, &b], places, DEPTH)?;
        // An octree is known on its own frame, all else on one around it, or around whatever comes to lie in the frame.
        let own = match (placements.is_some(), b.own) {
            (true, Some(own)) => own,
            (true, None) => {
                let Bounds { min, max } = match b.bounds(py) {
                    Some(bounds) => bounds,
                    None => moved_there(&frame, places).or_raise(py)?,
                };
                Inner::around(min, max, frame.depth()).or_raise(py)?
            }
            (false, _) => frame,
        };
        Ok(Pair { a, b, placements, is_one, frame, own, limits })
    }

    /// A solid that stays where it is: it remembers the frame, or can be asked on any.
    fn still(&self, solid: &Given) -> AnySolid {
        if solid.own.is_some() { anywhere(solid.any()) } else { AnySolid::new(solid.shape.clone()) }
    }

    /// The answers at all places.
    fn ask<'py, T: Send, W: IntoPyObject<'py>>(
        &self,
        py: Python<'py>,
        here: impl FnOnce(&AnySolid, &AnySolid, &Control<'_>) -> Result<T, Error> + Send,
        there: impl FnOnce(&AnySolid, &AnySolid, &[Affine], &Control<'_>) -> Result<Vec<T>, Error> + Send,
        wrap: impl Fn(T) -> W,
    ) -> PyResult<Bound<'py, PyAny>> {
        let found = self.limits.run(py, |control| {
            match &self.placements {
                None => Ok(vec![here(&self.still(&self.a), &self.still(&self.b), control)?]),
                Some(places) => {
                    // Octrees on their own frames are compared as such.
                    let is_home = self.a.own.is_none_or(|own| own.same_universe(&self.frame));
                    let a = if is_home { self.a.any().clone() } else { anywhere(self.a.any()) };
                    there(&a, self.b.any(), places, control)
                }
            }
        })?;
        let mut answers = Vec::with_capacity(found.len());
        for one in found {
            answers.push(wrap(one).into_bound_py_any(py)?);
        }
        match (self.is_one, answers.pop()) {
            (true, Some(one)) => Ok(one),
            (_, last) => {
                answers.extend(last);
                Ok(PyList::new(py, answers)?.into_any())
            }
        }
    }
}

/// Whether two solids overlap, `a` where it is and `b` under a placement, or under each of many: then the answer is a list. `placements` is an
/// `Affine` or a matrix, or a sequence of them.
///
/// `frame` is the cube in which both are looked at: a `Frame`, or an octree that has it. Without it, it is a cube around both, under all
/// placements. `depth` replaces its depth; 16 by default, or that of an octree.
///
/// With a `tolerance` (cubic model units) the common volume is measured until its interval is no wider. Each placement may split
/// `max_splits` cells, 100,000 by default.
///
/// >>> pin, plate = Csg.cylinder(2, -5, 5), Csg.cuboid([-9, -9, 0], [9, 9, 1]) - Csg.cylinder(2, -1, 2)
/// >>> interference(pin, plate).verdict
/// 'disjoint'
/// >>> [found.verdict for found in interference(plate, pin, [Affine.translation([x, 0, 0]) for x in (0, 0.1)])]
/// ['disjoint', 'overlapping']
#[pyfunction]
#[pyo3(signature = (a, b, placements=None, *, tolerance=f64::INFINITY, frame=None, depth=None, **limits))]
pub fn interference<'py>(
    a: &Bound<'py, PyAny>,
    b: &Bound<'py, PyAny>,
    placements: Option<&Bound<'py, PyAny>>,
    #[pyo3(from_py_with = named::tolerance)] tolerance: f64,
    frame: Option<FrameLike>,
    #[pyo3(from_py_with = named::depth)] depth: Option<Depth>,
    limits: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let pair = Pair::of(a, b, placements, Wish { frame, depth }, budgeted(limits)?)?;
    let (frame, own) = (pair.frame, pair.own);
    pair.ask(
        a.py(),
        |a, b, control| query::interference(a, b, &frame, tolerance, control),
        |a, b, places, control| interference_at(a, b, &own, places, &frame, tolerance, control),
        Interference,
    )
}

/// How far two solids are apart, to a `tolerance` (model units; by default a millionth of the frame): `a` where it is, and `b` under a placement,
/// or under each of many. `placements`, `frame` and `depth` are those of `interference`.
///
/// >>> found = clearance(Csg.ball([0, 0, 0], 1), Csg.ball([5, 0, 0], 2))
/// >>> 2.0 in found.distance, found.points.round(3).tolist()
/// (True, [[1.0, 0.0, 0.0], [3.0, 0.0, 0.0]])
#[pyfunction]
#[pyo3(signature = (a, b, placements=None, *, tolerance=None, frame=None, depth=None, **limits))]
pub fn clearance<'py>(
    a: &Bound<'py, PyAny>,
    b: &Bound<'py, PyAny>,
    placements: Option<&Bound<'py, PyAny>>,
    #[pyo3(from_py_with = named::tolerance)] tolerance: Option<f64>,
    frame: Option<FrameLike>,
    #[pyo3(from_py_with = named::depth)] depth: Option<Depth>,
    limits: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let pair = Pair::of(a, b, placements, Wish { frame, depth }, budgeted(limits)?)?;
    let (frame, own) = (pair.frame, pair.own);
    let tolerance = tolerance.unwrap_or(TOLERANCE * frame.edge());
    pair.ask(
        a.py(),
        |a, b, control| query::clearance(a, b, &frame, tolerance, control),
        |a, b, places, control| clearance_at(a, b, &own, places, &frame, tolerance, control),
        Clearance,
    )
}

/// Whether no point of `a` is nearer than `least` (model units) to one of `b`: cheaper than the distance. `placements`, `frame` and `depth` are
/// those of `interference`.
///
/// >>> gap_at_least(Csg.ball([0, 0, 0], 1), Csg.ball([5, 0, 0], 2), 1.9).verdict
/// 'yes'
#[pyfunction]
#[pyo3(signature = (a, b, least, placements=None, *, frame=None, depth=None, **limits))]
pub fn gap_at_least<'py>(
    a: &Bound<'py, PyAny>,
    b: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = named::least)] least: f64,
    placements: Option<&Bound<'py, PyAny>>,
    frame: Option<FrameLike>,
    #[pyo3(from_py_with = named::depth)] depth: Option<Depth>,
    limits: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let pair = Pair::of(a, b, placements, Wish { frame, depth }, budgeted(limits)?)?;
    let (frame, own) = (pair.frame, pair.own);
    pair.ask(
        a.py(),
        |a, b, control| query::gap_at_least(a, b, &frame, least, control),
        |a, b, places, control| gap_at_least_at(a, b, &own, places, &frame, least, control),
        Gap,
    )
}

/// How far the boundaries of two solids, `a` and `b`, are from each other, to a `tolerance` (model units; by default a ten-thousandth of the
/// frame). `frame` and `depth` are those of `interference`.
///
/// >>> found = deviation(Csg.ball([0, 0, 0], 1), Csg.ball([0.1, 0, 0], 1), tolerance=0.01)
/// >>> 0.1 in found.distance, found.within(0.2)
/// (True, 'yes')
#[pyfunction]
#[pyo3(signature = (a, b, *, tolerance=None, frame=None, depth=None, **limits))]
pub fn deviation(
    a: &Bound<'_, PyAny>,
    b: &Bound<'_, PyAny>,
    #[pyo3(from_py_with = named::tolerance)] tolerance: Option<f64>,
    frame: Option<FrameLike>,
    #[pyo3(from_py_with = named::depth)] depth: Option<Depth>,
    limits: Option<&Bound<'_, PyDict>>,
) -> PyResult<Deviation> {
    let py = a.py();
    let pair = Pair::of(a, b, None, Wish { frame, depth }, Limits::of(limits)?)?;
    let frame = pair.frame;
    let tolerance = tolerance.unwrap_or(1e-4 * frame.edge());
    let found = pair.limits.run(py, |control| {
        let (a, b) = (pair.still(&pair.a), pair.still(&pair.b));
        query::deviation(&a, &b, &frame, tolerance, control)
    })?;
    Ok(Deviation(found))
}

/// A box that holds all that one placement or another moves into a frame.
fn moved_there(frame: &Inner, placements: &[Affine]) -> Result<Bounds, Error> {
    let universe = Bounds::of(frame);
    let mut all: Option<Bounds> = None;
    for placement in placements {
        // What is beyond the doubles no frame can hold.
        let Some(before) = universe.placed(&placement.inverse()?) else { continue };
        all = Some(all.map_or(before, |all| all.hull(&before)));
    }
    Ok(all.unwrap_or(universe))
}
