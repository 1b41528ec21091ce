//! Joints: places where one surface continues as another one that touches it, for example where a ball ends a
//! round bar, or where the round end of a slot begins.
//!
//! Such surfaces, a and b, have a plane p through the curve in which they touch. On p both functions are 0 in
//! the same places: b = m a there. On one side of p the solid depends on a alone, and on the other side on b
//! alone. So the boundary is a single smooth sheet with an edge on p.

use super::figures::{Figures, length};
use super::redundant::{least_squares, never, rest, without};
use super::scaled::{Scaled, Terms};
use crate::lattice::Each;
use crate::lattice::{Cell, axes};
use crate::solid::OpenSurfaces;

/// The greatest deviation of the boundary from the surfaces of a joint (edges of the universe).
const SLACK: f64 = 1e-9;

/// The greatest difference on a plane of two functions that are nearly the same there (half edges of the
/// cell).
const NEAR: f64 = 1e-6;

/// The least factor m in a cell.
const FACTOR: f64 = 0.1;

/// Half the diagonal of a cell in half edges.
const DIAGONAL: f64 = 1.733;

/// A joint, by the places of three surfaces in the list of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Joint {
    pub(super) plane: usize,
    /// Where the plane's function is negative, the boundary lies on the first surface, otherwise on the
    /// second.
    pub(super) sides: [usize; 2],
}

impl Joint {
    /// Finds the joint in a cell that depends on three surfaces. Also returns the function that shows the
    /// joint, and the greatest deviation of the boundary (edges of the universe).
    pub(super) fn find(
        figures: &Figures,
        cell: Cell,
        open: &OpenSurfaces,
    ) -> Option<(Joint, OpenSurfaces, f64)> {
        let &[x, y, z] = open.indices() else { return None };
        let known = [x, y, z].each(|surface| Scaled::of(figures, surface, cell));
        let [Some(x), Some(y), Some(z)] = known else { return None };
        let known = [x, y, z];
        let half = 0.5 / f64::from(1u32 << cell.level);
        (0..3).filter(|&plane| known[plane].is_plane).find_map(|plane| {
            let [a, b] = [(plane + 1) % 3, (plane + 2) % 3];
            let touch = known[b].touches(&known[a])?;
            let cannot_be = never(3, [a, b], touch.is_turned, touch.is_above);
            let halves = [false, true]
                .each(|is_above| without(open.with_table(open.table().with(plane, is_above)), cannot_be));
            let alone = |half: &OpenSurfaces| {
                let mut variables = half.variables();
                let (Some((only, _)), None) = (variables.next(), variables.next()) else { return None };
                Some((only, half.inside(0)))
            };
            let [(below, first), (above, last)] = [alone(&halves[0])?, alone(&halves[1])?];
            if below == above || below == plane || above == plane || (first != last) != touch.is_turned {
                return None;
            }
            let off = off(&known[a], &known[b], &known[plane], touch.is_turned)?;
            let away = (touch.away() + 4.0 * off / FACTOR) * half;
            let joint = Joint { plane, sides: [below, above] };
            (away <= SLACK).then(|| (joint, OpenSurfaces::choice(plane, halves), away))
        })
    }
}

/// Returns three surfaces of a cell through the point in which a joint ends: the plane of the joint, one of
/// the two touching surfaces, and one that cuts them off. `None` if there is no such point.
pub(super) fn end(figures: &Figures, cell: Cell, open: &OpenSurfaces) -> Option<[u32; 3]> {
    let surfaces = open.indices();
    let count = surfaces.len();
    let mut known = [Scaled::default(); OpenSurfaces::MOST];
    for (place, &surface) in known.iter_mut().zip(surfaces) {
        *place = Scaled::of(figures, surface, cell)?;
    }
    let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b]));
    let touches = |[a, b]: [usize; 2]| Some(known[b].touches(&known[a])?.is_turned);
    let mut touching = pairs.filter_map(|pair| Some((pair, touches(pair)?)));
    touching.find_map(|([a, b], is_turned)| {
        let others = (0..count).filter(|&k| k != a && k != b);
        let is_plane = |&p: &usize| {
            known[p].is_plane
                && off(&known[a], &known[b], &known[p], is_turned).is_some_and(|off| off <= NEAR)
        };
        let plane = others.clone().find(is_plane)?;
        let cut = others.clone().find(|&k| k != plane)?;
        Some([plane, a, cut].each(|k| surfaces[k]))
    })
}

/// The greatest deviation of a surface's function from a positive multiple of another one's, on a plane in
/// the cell.
fn off(a: &Scaled, b: &Scaled, plane: &Scaled, is_turned: bool) -> Option<f64> {
    let (normal, away) = (plane.normal(), plane.terms[0]);
    let foot = axes(|k| -away * normal[k]);
    // Two directions at right angles to the normal.
    let least = (0..3).fold(0, |least, k| if normal[k].abs() < normal[least].abs() { k } else { least });
    let unit = axes(|k| f64::from(u8::from(k == least)) - normal[least] * normal[k]);
    let size = length(unit);
    let first = unit.each(|c| c / size);
    let second = axes(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        normal[i] * first[j] - normal[j] * first[i]
    });
    // Either a plane times a linear function, or a quadric times a number.
    let (flat, other) = if b.is_plane { (b, a) } else { (a, b) };
    let [flat_on, other_on] = [flat, other].each(|known| on_plane(&known.terms, foot, [first, second]));
    let [f, u, v, ..] = flat_on;
    let (factors, rest) = match flat.is_plane {
        true => {
            let columns = [flat_on, [0.0, f, 0.0, u, v, 0.0], [0.0, 0.0, f, 0.0, u, v]];
            let factors = least_squares(&columns, &other_on)?;
            (factors, rest(&other_on, &columns, &factors))
        }
        false => {
            let [factor] = least_squares(&[flat_on], &other_on)?;
            ([factor, 0.0, 0.0], rest(&other_on, &[flat_on], &[factor]))
        }
    };
    let sign = if is_turned { -1.0 } else { 1.0 };
    // No point of the cell is further than the half diagonal from its centre. So no point of the cell on the
    // plane is further from the foot.
    let least = sign * factors[0] - DIAGONAL * (factors[1].abs() + factors[2].abs());
    if least.is_nan() || least < FACTOR {
        return None;
    }
    // No term is a product of more than two coordinates.
    let off: f64 = rest.iter().map(|term| term.abs()).sum();
    Some(DIAGONAL * DIAGONAL * off + a.error + b.error)
}

/// A polynomial restricted to a plane: the terms 1, u, v, u², u v, v².
fn on_plane(terms: &Terms, at: [f64; 3], [p, q]: [[f64; 3]; 2]) -> [f64; 6] {
    let [value, x, y, z, xx, yy, zz, xy, xz, yz] = *terms;
    let product = |a: [f64; 3], b: [f64; 3]| {
        let squares = xx * a[0] * b[0] + yy * a[1] * b[1] + zz * a[2] * b[2];
        let mixed = |f: f64, i: usize, j: usize| 0.5 * f * (a[i] * b[j] + a[j] * b[i]);
        squares + mixed(xy, 0, 1) + mixed(xz, 0, 2) + mixed(yz, 1, 2)
    };
    let slope = |d: [f64; 3]| x * d[0] + y * d[1] + z * d[2];
    [
        value + slope(at) + product(at, at),
        slope(p) + 2.0 * product(at, p),
        slope(q) + 2.0 * product(at, q),
        product(p, p),
        2.0 * product(p, q),
        product(q, q),
    ]
}
