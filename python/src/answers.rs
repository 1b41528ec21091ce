//! Conversion of answers about points and rays to Python.

use crate::arrays;
use crate::from_package;
use crate::interval::{Interval, intervals};
use leafless::Membership;
use leafless::query::{PointDistance, RayHit};
use pyo3::prelude::*;

/// Converts answers about the membership of points.
pub fn memberships<'py>(
    py: Python<'py>,
    answers: &[Membership],
    is_one: bool,
) -> PyResult<Bound<'py, PyAny>> {
    if let (&[answer], true) = (answers, is_one) {
        return from_package!(py, "leafless._answers", "Membership")?.call1((answer as u8,));
    }
    let codes = answers.iter().map(|&answer| answer as u8).collect();
    Ok(arrays::array::<u8>(py, codes, &[answers.len()])?.into_any())
}

/// Returns the number of a surface, or −1.
fn number(surface: Option<u32>) -> i64 {
    surface.map_or(-1, i64::from)
}

/// Converts answers about distances of points.
pub fn distances_found<'py>(
    py: Python<'py>,
    found: &[PointDistance],
    tolerance: f64,
    is_one: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let near = |found: &PointDistance| found.nearest.map_or([f64::NAN; 3], |near| near.point);
    let number = |found: &PointDistance| number(found.nearest.and_then(|near| near.surface));
    // If nothing is there, by proof, both ends are infinite, and the width is NaN.
    let is_wide = |found: &PointDistance| found.distance.width() > tolerance;
    if let (&[one], true) = (found, is_one) {
        let answer = from_package!(py, "leafless._answers", "Distance")?;
        let nearest = arrays::array(py, near(&one).to_vec(), &[3])?;
        return answer.call1((Interval(one.distance), nearest, number(&one), is_wide(&one)));
    }
    let count = found.len();
    let (nearest, surface, undecided) = py.detach(|| {
        let nearest = found.iter().map(near).collect();
        (nearest, found.iter().map(number).collect(), found.iter().map(is_wide).collect())
    });
    from_package!(py, "leafless._answers", "Distances")?.call1((
        intervals(py, found.iter().map(|found| found.distance), &[count])?,
        arrays::rows(py, nearest)?,
        arrays::array(py, surface, &[count])?,
        arrays::array(py, undecided, &[count])?,
    ))
}

/// Converts answers about rays.
pub fn rays_found<'py>(
    py: Python<'py>,
    found: &[Option<RayHit>],
    is_one: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let unknown = leafless::Interval::exactly(f64::INFINITY);
    let distance = |hit: &Option<RayHit>| hit.map_or(unknown, |hit| hit.t);
    let normal = |hit: &Option<RayHit>| hit.map_or([f64::NAN; 3], |hit| hit.normal);
    let number = |hit: &Option<RayHit>| number(hit.and_then(|hit| hit.surface));
    if let ([one], true) = (found, is_one) {
        let answer = from_package!(py, "leafless._answers", "RayHit")?;
        let normal = arrays::array(py, normal(one).to_vec(), &[3])?;
        return answer.call1((one.is_some(), Interval(distance(one)), normal, number(one)));
    }
    let count = found.len();
    let (hit, normal, surface) = py.detach(|| {
        let hit = found.iter().map(Option::is_some).collect();
        (hit, found.iter().map(normal).collect(), found.iter().map(number).collect())
    });
    from_package!(py, "leafless._answers", "RayHits")?.call1((
        arrays::array(py, hit, &[count])?,
        intervals(py, found.iter().map(distance), &[count])?,
        arrays::rows(py, normal)?,
        arrays::array(py, surface, &[count])?,
    ))
}
