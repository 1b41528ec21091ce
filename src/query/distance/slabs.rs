//! The distance of a point from a solid in a cell with a known enclosure.
//!
//! All coordinates are the cell's own, from its centre in half edges. For any direction d, no point x of the
//! solid has d · x > reach. Hence the distance of a point p is at least (d · p − reach) / |d|. A direction
//! near that of the nearest point gives a bound whose error is the square of the angle between them.

use crate::cut::reach;
use crate::lattice::Each;
use crate::lattice::Interval;
use crate::lattice::axes;
use crate::solid::{Enclosure, Slab, SlabJoin};

/// A point in a cell's coordinates.
pub(super) type Seen = [Interval; 3];

/// Returns a proven lower bound of the distance of the solid in the cell; ∞ if the cell has no part of the
/// solid.
pub(super) fn lower(enclosure: &Enclosure, point: &Seen) -> f64 {
    match enclosure.join {
        SlabJoin::All => lower_of_all(enclosure, point),
        SlabJoin::Any => {
            let each = alone(enclosure).map(|one| lower_of_all(&one, point));
            // Without slabs nothing is known.
            each.reduce(f64::min).unwrap_or(0.0)
        }
    }
}

/// Returns an upper bound of the distance, and a point of the closed solid in the cell that is proven to be
/// no further away. `None` if no point of the solid is found.
pub(super) fn upper(enclosure: &Enclosure, point: &Seen) -> Option<(f64, [f64; 3])> {
    match enclosure.join {
        SlabJoin::All => upper_of_all(enclosure, point),
        SlabJoin::Any => {
            let each = alone(enclosure).filter_map(|one| upper_of_all(&one, point));
            each.min_by(|a, b| a.0.total_cmp(&b.0))
        }
    }
}

fn slabs(enclosure: &Enclosure) -> impl Iterator<Item = &Slab> {
    enclosure.slabs.iter().filter(|slab| slab.normal != [0.0; 3])
}

/// The enclosures by each of the slabs alone.
fn alone(enclosure: &Enclosure) -> impl Iterator<Item = Enclosure> {
    slabs(enclosure).map(|&slab| Enclosure {
        slabs: [slab, Slab::NONE, Slab::NONE],
        join: SlabJoin::All,
        cone: enclosure.cone,
    })
}

fn middle(point: &Seen) -> [f64; 3] {
    point.each(|c| 0.5 * (c.lower + c.upper))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn in_cell(point: [f64; 3]) -> [f64; 3] {
    point.each(|c| c.clamp(-1.0, 1.0))
}

fn length(vector: &Seen) -> Interval {
    let [x, y, z] = vector.each(Interval::square);
    x.plus(y).plus(z).root()
}

fn lower_of_all(enclosure: &Enclosure, point: &Seen) -> f64 {
    let about = middle(point);
    let mut best: f64 = 0.0;
    let from_cell = minus(about, in_cell(about));
    let from_slab = minus(about, pulled(enclosure, about));
    let normals = slabs(enclosure).filter(|slab| slab.outer.is_finite()).map(|slab| slab.normal);
    for direction in [from_cell, from_slab].into_iter().chain(normals) {
        if direction == [0.0; 3] || !direction.iter().all(|c| c.is_finite()) {
            continue;
        }
        let reach = reach::upper(enclosure, direction);
        if reach == f64::NEG_INFINITY {
            return f64::INFINITY;
        }
        let direction = direction.each(Interval::exactly);
        let [x, y, z] = axes(|axis| direction[axis].times(point[axis]));
        let gap = x.plus(y).plus(z).minus(Interval::exactly(reach));
        best = best.max(gap.over(length(&direction)).lower);
    }
    best
}

fn upper_of_all(enclosure: &Enclosure, point: &Seen) -> Option<(f64, [f64; 3])> {
    let about = middle(point);
    let near = pulled(enclosure, about);
    let found = if is_inside(enclosure, near) {
        near
    } else {
        let towards = minus(about, near);
        reach::witness(enclosure, towards)?
    };
    Some((length(&axes(|axis| point[axis].minus(Interval::exactly(found[axis])))).upper, found))
}

/// Returns a point of the cell near `point` that lies, to rounding, slightly inside of all slabs, if `TURNS`
/// rounds of projections find one.
fn pulled(enclosure: &Enclosure, point: [f64; 3]) -> [f64; 3] {
    const TURNS: usize = 16;
    /// The distance from the slabs' inner ends, as a share of the normal's range.
    const MARGIN: f64 = 1.0 / (1u64 << 44) as f64;
    let mut point = in_cell(point);
    for _ in 0..TURNS {
        let mut moved = false;
        for slab in slabs(enclosure).filter(|slab| slab.inner.is_finite()) {
            let range: f64 = slab.normal.iter().map(|c| c.abs()).sum();
            let beyond = dot(slab.normal, point) - (slab.inner - MARGIN * range);
            if beyond > 0.0 {
                let step = beyond / dot(slab.normal, slab.normal);
                point = in_cell(minus(point, slab.normal.each(|c| step * c)));
                moved = true;
            }
        }
        if !moved {
            break;
        }
    }
    point
}

/// True if a point of the closed cell is proven to be a limit of points that lie inside of all slabs.
fn is_inside(enclosure: &Enclosure, point: [f64; 3]) -> bool {
    slabs(enclosure).all(|slab| {
        let [x, y, z] =
            axes(|axis| Interval::exactly(slab.normal[axis]).times(Interval::exactly(point[axis])));
        x.plus(y).plus(z).upper < slab.inner
    }) && slabs(enclosure).next().is_some()
}
