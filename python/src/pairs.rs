//! Queries of two solids: overlap, distance, and deviation of the boundaries.

use crate::affine::affines;
use crate::anywhere::anywhere;
use crate::arguments::{Depth, named};
use crate::arrays;
use crate::ask::{FrameLike, Wish};
use crate::error::OrRaise;
use crate::frame::Frame;
use crate::from_package;
use crate::interval::Interval;
use crate::solid::{Given, given};
use crate::words;
use crate::work::Limits;
use leafless::query::{self, clearance_at, gap_at_least_at, interference_at};
use leafless::{Affine, AnySolid, Bounds, Control, Error, Frame as Inner};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// The default depth of the frame for two solids.
const DEPTH: u8 = 16;

/// The default number of splits for each answer.
const SPLITS: u64 = 100_000;

/// The default tolerance of distances, as a part of the frame's edge.
const TOLERANCE: f64 = 1e-6;

/// Converts an answer about an overlap.
fn overlap(py: Python<'_>, found: query::Interference) -> PyResult<Bound<'_, PyAny>> {
    from_package!(py, "leafless._answers", "Interference")?.call1((
        words::word(found.verdict),
        Interval(found.volume),
        found.ball.map(|ball| (<(f64, f64, f64)>::from(ball.centre), ball.radius)),
        found.clipped,
        <(u64, u64)>::from(found.splits),
    ))
}

/// Converts an answer about a distance.
fn distance(py: Python<'_>, found: query::Clearance) -> PyResult<Bound<'_, PyAny>> {
    from_package!(py, "leafless._answers", "Clearance")?.call1((
        Interval(found.distance),
        found.points.map(|points| arrays::rows(py, points.to_vec())).transpose()?,
        found.depth,
        words::word(found.stop_reason),
        found.clipped,
        <(u64, u64)>::from(found.splits),
    ))
}

/// Converts an answer about a gap.
fn gap(py: Python<'_>, found: query::Gap) -> PyResult<Bound<'_, PyAny>> {
    let answer = from_package!(py, "leafless._answers", "Gap")?;
    answer.call1((words::word(found.verdict), Interval(found.evidence.distance)))
}

/// Two solids, the placements of the second, and the frame of the query.
struct Pair {
    a: Given,
    b: Given,
    /// `None`: the second solid stays where it is.
    placements: Option<Vec<Affine>>,
    /// True if the answer is single: at most one placement was given.
    is_one: bool,
    frame: Inner,
    own: Inner,
    limits: Limits,
}

/// Returns limits with a maximum number of splits.
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
        // An octree is prepared on its own frame. Any other solid is prepared on a frame around it, or,
        // without bounds, around everything that the placements move into the frame.
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

    /// Returns a solid that is not moved. It remembers the frame, or can be queried on any.
    fn still(&self, solid: &Given) -> AnySolid {
        if solid.own.is_some() { anywhere(solid.any()) } else { AnySolid::new(solid.shape.clone()) }
    }

    /// Answers the query at all placements.
    fn ask<'py, T: Send>(
        &self,
        py: Python<'py>,
        here: impl FnOnce(&AnySolid, &AnySolid, &Control<'_>) -> Result<T, Error> + Send,
        there: impl FnOnce(&AnySolid, &AnySolid, &[Affine], &Control<'_>) -> Result<Vec<T>, Error> + Send,
        answer: impl Fn(Python<'py>, T) -> PyResult<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let found = self.limits.run(py, |control| {
            match &self.placements {
                None => Ok(vec![here(&self.still(&self.a), &self.still(&self.b), control)?]),
                Some(places) => {
                    // Octrees on their own frames are compared as stored trees.
                    let is_home = self.a.own.is_none_or(|own| own.same_universe(&self.frame));
                    let a = if is_home { self.a.any().clone() } else { anywhere(self.a.any()) };
                    there(&a, self.b.any(), places, control)
                }
            }
        })?;
        let mut answers = Vec::with_capacity(found.len());
        for one in found {
            answers.push(answer(py, one)?);
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

/// Decides whether two solids overlap: `a` where it is, and `b` under a placement. `placements` is an
/// `Affine` or a matrix, or a sequence of them; a sequence gives a list of answers.
///
/// `frame` is the cube of the query: a `Frame`, or an octree on that frame. Without it, it is a cube around
/// both solids under all placements. `depth` replaces the depth of the frame. The default is 16, or the depth
/// of an octree.
///
/// With a `tolerance` (cubic model units), the volume of the intersection is measured until its interval is
/// no wider. Each placement may split `max_splits` cells, 100,000 by default.
///
/// >>> pin, plate = Csg.cylinder(2, -5, 5), Csg.cuboid([-9, -9, 0], [9, 9, 1]) - Csg.cylinder(2, -1, 2)
/// >>> interference(pin, plate).verdict
/// 'disjoint'
/// >>> places = [Affine.translation([x, 0, 0]) for x in (0, 0.1)]
/// >>> [found.verdict for found in interference(plate, pin, places)]
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
        overlap,
    )
}

/// Measures the distance between two solids, to a `tolerance` (model units; the default is a millionth of the
/// frame's edge). `a` stays where it is, and `b` is moved by one placement or by each of many. `placements`,
/// `frame` and `depth` are those of `interference`.
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
        distance,
    )
}

/// Decides whether every point of `a` is at least `least` (model units) away from every point of `b`. It is
/// cheaper than the distance. `placements`, `frame` and `depth` are those of `interference`.
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
        gap,
    )
}

/// Returns the frame on which `interference`, `clearance` and `gap_at_least` compare two solids, `a` and `b`,
/// under these `placements`, with the same `frame` and `depth`. Pass this frame to several calls with parts
/// of the placements, and their answers are those of one call. But a `b` without known bounds is prepared
/// anew for the placements of each call.
///
/// >>> from leafless._leafless import frame_of_pair
/// >>> a, b = Csg.ball([0, 0, 0], 1), Csg.ball([0, 0, 0], 2)
/// >>> places = [Affine.translation([x, 0, 0]) for x in range(4, 8)]
/// >>> frame = frame_of_pair(a, b, places)
/// >>> apart = [clearance(a, b, place, frame=frame).distance for place in places]
/// >>> apart == [found.distance for found in clearance(a, b, places)]
/// True
#[pyfunction]
#[pyo3(signature = (a, b, placements=None, *, frame=None, depth=None))]
pub fn frame_of_pair(
    a: &Bound<'_, PyAny>,
    b: &Bound<'_, PyAny>,
    placements: Option<&Bound<'_, PyAny>>,
    frame: Option<FrameLike>,
    #[pyo3(from_py_with = named::depth)] depth: Option<Depth>,
) -> PyResult<Frame> {
    Pair::of(a, b, placements, Wish { frame, depth }, Limits::default()).map(|pair| Frame(pair.frame))
}

/// Measures the distance between the boundaries of two solids, `a` and `b`, to a `tolerance` (model units;
/// the default is a ten-thousandth of the frame's edge). `frame` and `depth` are those of `interference`.
///
/// >>> found = deviation(Csg.ball([0, 0, 0], 1), Csg.ball([0.1, 0, 0], 1), tolerance=0.01)
/// >>> 0.1 in found.distance, found.within(0.2)
/// (True, 'yes')
#[pyfunction]
#[pyo3(signature = (a, b, *, tolerance=None, frame=None, depth=None, **limits))]
pub fn deviation<'py>(
    a: &Bound<'py, PyAny>,
    b: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = named::tolerance)] tolerance: Option<f64>,
    frame: Option<FrameLike>,
    #[pyo3(from_py_with = named::depth)] depth: Option<Depth>,
    limits: Option<&Bound<'_, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = a.py();
    let pair = Pair::of(a, b, None, Wish { frame, depth }, Limits::of(limits)?)?;
    let frame = pair.frame;
    let tolerance = tolerance.unwrap_or(1e-4 * frame.edge());
    let found = pair.limits.run(py, |control| {
        let (a, b) = (pair.still(&pair.a), pair.still(&pair.b));
        query::deviation(&a, &b, &frame, tolerance, control)
    })?;
    let (one, other) = (&found.a_to_b, &found.b_to_a);
    let farther = if one.distance.lower >= other.distance.lower { one } else { other };
    from_package!(py, "leafless._answers", "Deviation")?.call1((
        Interval(found.distance()),
        Interval(one.distance),
        Interval(other.distance),
        farther.at.map(|at| arrays::rows(py, vec![at.point, at.nearest])).transpose()?,
        words::word(found.stop_reason),
    ))
}

/// Returns a box that contains everything that any placement moves into a frame.
fn moved_there(frame: &Inner, placements: &[Affine]) -> Result<Bounds, Error> {
    let universe = Bounds::of(frame);
    let mut all: Option<Bounds> = None;
    for placement in placements {
        // No frame can contain points beyond the range of doubles.
        let Some(before) = universe.placed(&placement.inverse()?) else { continue };
        all = Some(all.map_or(before, |all| all.hull(&before)));
    }
    Ok(all.unwrap_or(universe))
}
