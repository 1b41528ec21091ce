//! Bounds of the distance by which the solid of an open surface may reach beyond the surface.
//!
//! The surface and caps over the loops of its boundary form a closed surface within the bounding box of the
//! vertices. At a point outside the box, the surface and the caps together have winding number 0. So the
//! surface's own number is the caps' number with the opposite sign. It is less than ½ in magnitude if the
//! solid angles of the caps at the point sum to less than 2π: then every rule leaves the point out.
//!
//! The solid angle of a flat, convex cap is less than 2π from everywhere off its plane, and at most its area
//! over the square of the distance. So a surface with one such hole does not reach beyond its box at all.
//! With more holes it may: seen from a point close to an inverted facet, the hole that the facet leaves and
//! the facet's own wrong side together have a solid angle of nearly 4π.

use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::sqrt;
use crate::memory;
use crate::mesh::{Loops, TriangleMesh};
use alloc::vec::Vec;
use core::f64::consts::TAU;
use glam::DVec3;

use super::winding::halve;

/// The number of bisection steps for a distance.
const STEPS: usize = 24;

/// A margin for rounding in sums of areas and solid angles, which have fewer than 2^32 terms.
const SLACK: f64 = 1.0 + 1e-6;

/// A flat, convex cap. The unit is the longest side of the bounding box of the surface, the origin the box's
/// lower corner.
struct Patch {
    area: f64,
    min: DVec3,
    max: DVec3,
}

/// Returns how far the solid may reach beyond the bounding box of the vertices: beyond its lower and its
/// upper side on each axis. `displacement` is the greatest distance of the surface from the mesh along each
/// axis; it is added.
///
/// O(n) in the edges of the boundary.
///
/// # Errors
/// [`Error::OutOfMemory`].
pub(super) fn reach(mesh: &TriangleMesh, loops: &Loops, displacement: f64) -> Result<[[f64; 3]; 2], Error> {
    let (min, max) = mesh.bounds();
    let extents = axes(|axis| max[axis] - min[axis]);
    let unit = extents[0].max(extents[1]).max(extents[2]);
    if unit == 0.0 {
        return Ok([[0.0; 3]; 2]);
    }
    let place = |vertex: u32| (DVec3::from(mesh.vertices()[vertex as usize]) - DVec3::from(min)) / unit;
    let patches = patches(loops, &place, displacement / unit)?;
    if patches.len() < 2 {
        return Ok([[0.0; 3]; 2]);
    }
    let total: f64 = patches.iter().map(|patch| patch.area).sum();
    let most = sqrt(total / TAU) * SLACK;
    let beyond = |gap: &dyn Fn(&Patch) -> f64| {
        // Whether the solid angles of all caps sum to less than 2π at `distance` beyond the side.
        let is_enough = |distance: f64| {
            let angle = |patch: &Patch| {
                let away = gap(patch) + distance;
                (patch.area / (away * away)).min(TAU)
            };
            patches.iter().map(angle).sum::<f64>() * SLACK <= TAU
        };
        if is_enough(0.0) {
            return 0.0;
        }
        let (mut too_near, mut enough) = (0.0, most);
        for _ in 0..STEPS {
            let middle = (too_near + enough) / 2.0;
            *(if is_enough(middle) { &mut enough } else { &mut too_near }) = middle;
        }
        enough * unit * SLACK
    };
    Ok([
        axes(|axis| beyond(&|patch| patch.min[axis])),
        axes(|axis| beyond(&|patch| extents[axis] / unit - patch.max[axis])),
    ])
}

/// Returns caps over the loops: one cap for a flat and convex loop, otherwise triangles.
fn patches(loops: &Loops, place: &impl Fn(u32) -> DVec3, displacement: f64) -> Result<Vec<Patch>, Error> {
    let mut patches: Vec<Patch> = memory::with_capacity(loops.caps())?;
    for walk in loops.iter() {
        let at = |corner: usize| place(walk[corner % walk.len()]);
        let first = patches.len();
        halve(walk.len(), &mut |corners, _| {
            let [a, b, c] = corners.each(at);
            let (u, v) = (b - a, c - a);
            let product = length(u) * length(v);
            // Displaced ends may make each edge longer than computed, by a diagonal at both ends.
            let longer = 4.0 * displacement;
            let excess = longer * (length(u) + length(v) + longer) / 2.0;
            // (The computed area of a needle may be all rounding.)
            let area = length(u.cross(v)) / 2.0 * SLACK + excess + 1e-15 * product + 1e-200;
            patches.push(Patch { area, min: a.min(b).min(c), max: a.max(b).max(c) });
        });
        if displacement == 0.0 && walk.len() > 3 && is_flat_and_convex(walk.len(), &at) {
            let whole = patches.drain(first..).reduce(|a, b| Patch {
                area: a.area + b.area,
                min: a.min.min(b.min),
                max: a.max.max(b.max),
            });
            patches.extend(whole);
        }
    }
    Ok(patches)
}

fn length(v: DVec3) -> f64 {
    sqrt(v.length_squared())
}

/// Returns whether a loop surely is a convex polygon in a plane across an axis.
fn is_flat_and_convex(count: usize, at: &impl Fn(usize) -> DVec3) -> bool {
    let Some(across) = (0..3).find(|&axis| (1..count).all(|i| at(i)[axis] == at(0)[axis])) else {
        return false;
    };
    let (x, y) = ((across + 1) % 3, (across + 2) % 3);
    let (mut left, mut right, mut reversals) = (0, 0, 0);
    for i in 0..count {
        let (a, b) = (at(i + 1) - at(i), at(i + 2) - at(i + 1));
        let (p, q) = (a[x] * b[y], a[y] * b[x]);
        let is_sure = (p - q).abs() > 8.0 * f64::EPSILON * (p.abs() + q.abs());
        left += usize::from(is_sure && p > q);
        right += usize::from(is_sure && p < q);
        // In lexicographic order, a convex polygon goes forth and back once.
        let is_forth = |step: DVec3| step[x] > 0.0 || step[x] == 0.0 && step[y] > 0.0;
        reversals += usize::from(is_forth(a) != is_forth(b));
    }
    left.max(right) == count && reversals == 2
}
