//! Volume, moments and area of what planes and curved surfaces cut off a cube.
//!
//! The cube is [-1, 1]³: a cell, measured from its centre in half edges.
//!
//! - For one plane, closed forms give the moments (for the volume: Scardovelli and Zaleski, J. Comput. Phys.
//!   164 (2000) 228–237; the others follow in the same way). Where these would cancel, and for two or three
//!   planes, the cube is clipped and integrated over its faces. Moments are off by less than [`ERROR`].
//! - For one curved surface and up to two planes, a plane near the surface stands for it, and what lies
//!   between both is integrated. Moments are known to third order, with a bound of their error.
//! - A plane and the cube have a polygon in common; slabs bound how much of it belongs to a solid.
//! - The area of one surface is the flux through the walls of the cube, to third order. Where surfaces meet,
//!   each is projected to a wall.

mod ball;
mod clip;
mod curved;
#[cfg(test)]
mod curved_tests;
mod enclosure;
mod face;
mod flux;
mod formula;
mod graph;
mod layer;
mod polygon;
mod quadratic;
pub(crate) mod reach;
mod section;
mod surplus;
mod taylor;
#[cfg(test)]
mod tests;
mod wedge;

use crate::lattice::{CellMoments, CubeMoments};
pub(crate) use ball::ball;
pub use enclosure::{Crossing, Enclosure, Segment, Slab, SlabJoin};
pub(crate) use face::{area_of_faces, area_within};
pub(crate) use flux::{area_of_surface, most_area};
pub(crate) use layer::{corners, sides, stray};
pub(crate) use quadratic::Quadratic;
pub(crate) use section::{SETTLED, Section};
pub(crate) use taylor::Taylor;

/// More than the error of any moment. (Twice what comes of the largest term that the formula admits; clipping
/// is off by a tenth of that.)
pub(crate) const ERROR: f64 = 1.0 / (1u64 << 39) as f64;

/// The points of the cube with n · x ≤ offset.
#[derive(Debug, Clone, Copy)]
struct Half {
    normal: [f64; 3],
    offset: f64,
}

/// Sets that lie in a solid, and that contain it, in a cell of which the enclosure is known: their moments in
/// the coordinates of the cell.
pub(crate) fn bounds(enclosure: &Enclosure) -> (CubeMoments, CubeMoments) {
    let of = |outer: bool| match enclosure.join {
        SlabJoin::All => intersection(&enclosure.slabs, outer).unwrap_or(if outer {
            CubeMoments::FULL
        } else {
            CubeMoments::EMPTY
        }),
        // The union is what lies outside of the complements' intersection.
        SlabJoin::Any => intersection(&enclosure.slabs.map(|slab| slab.complement()), !outer)
            .map_or(if outer { CubeMoments::FULL } else { CubeMoments::EMPTY }, |m| m.complement()),
    };
    (of(false), of(true))
}

/// The moments of a solid in a cell of which the enclosure is known.
pub(crate) fn between(enclosure: &Enclosure) -> CellMoments {
    let (inner, outer) = bounds(enclosure);
    // No moment of what lies between both sets, or of a part of that, is greater than the volume between
    // them.
    let error = 0.5 * (outer.volume - inner.volume).max(0.0) + 2.0 * ERROR;
    CellMoments { moments: inner.mean(&outer), error }
}

/// A point inside of the points of the cell with n · x ≤ offset for up to three `halves`, where that is more
/// than rounding makes; nothing if there are none. `None` if rounding hinders.
pub(crate) fn middle(halves: &[([f64; 3], f64)]) -> Option<Option<[f64; 3]>> {
    let mut own = [Half { normal: [0.0; 3], offset: 0.0 }; 3];
    for (own, &(normal, offset)) in own.iter_mut().zip(halves) {
        *own = Half { normal, offset };
    }
    clip::middle(&own[..halves.len().min(3)])
}

/// Moments of { x in the cell : f(x) ≥ 0 } on the inner sides of up to two planes, of which slabs tell all
/// but what rounding leaves open; `None` if they are not known to third order.
pub(crate) fn curved(f: &Quadratic, planes: &[Slab]) -> Option<CellMoments> {
    let mut halves = [Half { normal: [0.0; 3], offset: 0.0 }; 3];
    let (mut count, mut error) = (0, 0.0);
    for Slab { normal, inner, outer } in planes {
        let range: f64 = normal.iter().map(|c| c.abs()).sum();
        let open = (outer - inner) / range;
        if !(range > 0.0 && range.is_finite() && (0.0..1.0).contains(&open)) {
            return None;
        }
        // Seen along the axis to which the normal is nearest, the section is at most a face.
        error += 12.0 * open;
        if *inner < range {
            halves[count] = Half { normal: normal.map(|c| c / range), offset: inner / range };
            count += 1;
        }
    }
    let known = curved::moments(f, &halves[..count], |tangent| {
        let mut all = halves;
        all[count] = *tangent;
        match count {
            0 => formula::below(tangent).or_else(|| clip::moments(&all[..1])),
            _ => clip::moments(&all[..=count]),
        }
    })?;
    let error = known.error + error;
    (error < 8.0).then_some(CellMoments { error, ..known })
}

/// More than the volume, of 8, between the sets of [`bounds`]; cheap, and about right.
pub(crate) fn doubt(enclosure: &Enclosure) -> f64 {
    let (mut doubt, mut is_known) = (0.0, false);
    for Slab { normal, inner, outer } in &enclosure.slabs {
        let [a, b, c] = normal.map(f64::abs);
        let (high, rest) = (a.max(b), a.min(b));
        let (most, middle, least) = (high.max(c), high.min(c).max(rest), rest.min(c));
        if most > 0.0 {
            // Seen along the axis to which the normal is nearest, a section is at most a face; near an edge
            // or a corner of the cube it is smaller.
            let range = (a + b) + c;
            if !range.is_finite() {
                return 8.0;
            }
            let (inner, outer) = (inner.max(-range), outer.min(range));
            let nearest = inner.max(-outer).max(0.0);
            let reach = range - nearest;
            let face = 4.0 / most;
            let edge = 2.0 * (reach / most) / middle;
            let corner = 0.5 * (reach / most) * (reach / middle) / least;
            // (No number, where components are 0, is not less.)
            doubt += (outer - inner).max(0.0) * face.min(edge).min(corner);
            is_known = true;
        }
    }
    // (What is no number is no less than that.)
    if is_known { 8.0f64.min(doubt) } else { 8.0 }
}

/// Moments of the cube's points that lie on the inner side of all planes, of the outer ends of the slabs or
/// of the inner ends; `None` if they are not had.
fn intersection(slabs: &[Slab; 3], outer: bool) -> Option<CubeMoments> {
    let mut halves = [Half { normal: [0.0; 3], offset: 0.0 }; 3];
    let (mut count, mut is_known) = (0, false);
    for slab in slabs {
        let range: f64 = slab.normal.iter().map(|c| c.abs()).sum();
        if range == 0.0 {
            continue;
        }
        is_known = true;
        let offset = if outer { slab.outer } else { slab.inner };
        if offset.is_nan() || !range.is_finite() {
            return None;
        }
        if offset >= range {
            continue;
        }
        if offset <= -range {
            return Some(CubeMoments::EMPTY);
        }
        halves[count] = Half { normal: slab.normal.map(|c| c / range), offset: offset / range };
        count += 1;
    }
    match count {
        0 if !is_known => None,
        0 => Some(CubeMoments::FULL),
        1 => formula::below(&halves[0]).or_else(|| clip::moments(&halves[..1])),
        count => clip::moments(&halves[..count]),
    }
}
