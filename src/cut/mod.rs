//! Volume, moments and area of the part of a cube that planes and curved surfaces cut off.
//!
//! The cube is [-1, 1]³: a cell, measured from its centre in half edges.
//!
//! - For one plane, closed forms give the moments. (For the volume: Scardovelli and Zaleski, J. Comput. Phys.
//!   164 (2000) 228–237; the others follow in the same way.) Where these would cancel, and for two or three
//!   planes, the cube is clipped and integrated over its faces. The errors of moments are below [`ERROR`].
//! - For one curved surface and up to two planes, a plane near the surface replaces it, and the region
//!   between the two is integrated. Moments are known to third order, with an error bound.
//! - The intersection of a plane with the cube is a polygon; slabs bound the part of it that belongs to a
//!   solid.
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

use crate::lattice::Each;
use crate::lattice::{CellMoments, CubeMoments};
pub(crate) use ball::ball;
pub use enclosure::{Crossing, Enclosure, Segment, Slab, SlabJoin};
pub(crate) use face::{area_of_faces, area_within};
pub(crate) use flux::{area_of_surface, most_area};
pub(crate) use layer::{corners, sides, stray};
pub(crate) use quadratic::Quadratic;
pub(crate) use section::{SETTLED, Section};
pub(crate) use taylor::Taylor;

/// A bound of the error of any moment. (It is twice the error from the largest term that the formula admits;
/// clipping has a tenth of that error.)
pub(crate) const ERROR: f64 = 1.0 / (1u64 << 39) as f64;

/// The points of the cube with n · x ≤ offset.
#[derive(Debug, Clone, Copy)]
struct Half {
    normal: [f64; 3],
    offset: f64,
}

/// Returns the moments of a set that lies in a solid, and of a set that contains it, in a cell whose
/// enclosure is known, in the coordinates of the cell.
pub(crate) fn bounds(enclosure: &Enclosure) -> (CubeMoments, CubeMoments) {
    let of = |outer: bool| match enclosure.join {
        SlabJoin::All => intersection(&enclosure.slabs, outer).unwrap_or(if outer {
            CubeMoments::FULL
        } else {
            CubeMoments::EMPTY
        }),
        // The union is the complement of the complements' intersection.
        SlabJoin::Any => intersection(&enclosure.slabs.each(|slab| slab.complement()), !outer)
            .map_or(if outer { CubeMoments::FULL } else { CubeMoments::EMPTY }, |m| m.complement()),
    };
    (of(false), of(true))
}

/// Returns the moments of a solid in a cell whose enclosure is known.
pub(crate) fn between(enclosure: &Enclosure) -> CellMoments {
    let (inner, outer) = bounds(enclosure);
    // No moment of the region between both sets, or of a part of it, is greater than the volume of the
    // region.
    let error = 0.5 * (outer.volume - inner.volume).max(0.0) + 2.0 * ERROR;
    CellMoments { moments: inner.mean(&outer), error }
}

/// Returns a point inside the set of the cell's points with n · x ≤ offset for up to three `halves`, if the
/// set is larger than rounding errors; `Some(None)` if the set is empty. `None` if rounding prevents an
/// answer.
pub(crate) fn middle(halves: &[([f64; 3], f64)]) -> Option<Option<[f64; 3]>> {
    let mut own = [Half { normal: [0.0; 3], offset: 0.0 }; 3];
    for (own, &(normal, offset)) in own.iter_mut().zip(halves) {
        *own = Half { normal, offset };
    }
    clip::middle(&own[..halves.len().min(3)])
}

/// Returns the moments of { x in the cell : f(x) ≥ 0 } on the inner sides of up to two planes; `None` if they
/// are not known to third order. The planes are slabs that are as thin as rounding allows.
pub(crate) fn curved(f: &Quadratic, planes: &[Slab]) -> Option<CellMoments> {
    let mut halves = [Half { normal: [0.0; 3], offset: 0.0 }; 3];
    let (mut count, mut error) = (0, 0.0);
    for Slab { normal, inner, outer } in planes {
        let range: f64 = normal.iter().map(|c| c.abs()).sum();
        let open = (outer - inner) / range;
        if !(range > 0.0 && range.is_finite() && (0.0..1.0).contains(&open)) {
            return None;
        }
        // Seen along the axis nearest to the normal, the section is at most a face.
        error += 12.0 * open;
        if *inner < range {
            halves[count] = Half { normal: normal.each(|c| c / range), offset: inner / range };
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

/// An upper bound of the volume, at most 8, between the sets of [`bounds`]; cheap, and approximately right.
pub(crate) fn doubt(enclosure: &Enclosure) -> f64 {
    let (mut doubt, mut is_known) = (0.0, false);
    for Slab { normal, inner, outer } in &enclosure.slabs {
        let [a, b, c] = normal.each(f64::abs);
        let (high, rest) = (a.max(b), a.min(b));
        let (most, middle, least) = (high.max(c), high.min(c).max(rest), rest.min(c));
        if most > 0.0 {
            // Seen along the axis nearest to the normal, a section is at most a face. Near an edge or a
            // corner of the cube it is smaller.
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
            // (`min` ignores the NaN that components of 0 give.)
            doubt += (outer - inner).max(0.0) * face.min(edge).min(corner);
            is_known = true;
        }
    }
    // (`min` ignores a NaN.)
    if is_known { 8.0f64.min(doubt) } else { 8.0 }
}

/// The moments of the cube's points on the inner side of all planes, at the outer or the inner ends of the
/// slabs; `None` if they cannot be computed.
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
        halves[count] = Half { normal: slab.normal.each(|c| c / range), offset: offset / range };
        count += 1;
    }
    match count {
        0 if !is_known => None,
        0 => Some(CubeMoments::FULL),
        1 => formula::below(&halves[0]).or_else(|| clip::moments(&halves[..1])),
        count => clip::moments(&halves[..count]),
    }
}
