//! Chains of chords along curves.

use super::figures::{Figures, Shape, length, middle, minus};
use crate::error::Error;
use crate::memory;
use alloc::vec::Vec;

/// The greatest number of halvings of a chord.
const HALVINGS: u32 = 12;

/// Adds points of a curve between two of its points, so that no chord is further from the curve than the
/// tolerance (edges of the universe). The curve consists of the points on one or two surfaces. If `kept` is
/// given, this coordinate stays constant.
pub(super) fn refine(
    figures: &Figures,
    surfaces: &[u32],
    kept: Option<usize>,
    ends: [[f64; 3]; 2],
    tolerance: f64,
    points: &mut Vec<[f64; 3]>,
) -> Result<(), Error> {
    if surfaces.iter().all(|&surface| figures.shape(surface) == Shape::Plane) {
        return Ok(());
    }
    halve(figures, surfaces, kept, ends, tolerance, HALVINGS, points)
}

fn halve(
    figures: &Figures,
    surfaces: &[u32],
    kept: Option<usize>,
    [from, to]: [[f64; 3]; 2],
    tolerance: f64,
    left: u32,
    points: &mut Vec<[f64; 3]>,
) -> Result<(), Error> {
    let chord = middle(from, to);
    let Some(point) = figures.onto(surfaces, kept, chord) else { return Ok(()) };
    let (rise, long) = (length(minus(point, chord)), length(minus(to, from)));
    // (A point that lies elsewhere does not belong to the curve between the ends.)
    if left == 0 || rise <= tolerance || rise > long {
        return Ok(());
    }
    halve(figures, surfaces, kept, [from, point], tolerance, left - 1, points)?;
    memory::push(points, point)?;
    halve(figures, surfaces, kept, [point, to], tolerance, left - 1, points)
}
