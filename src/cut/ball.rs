//! A ball that lies in a solid, in a cell of which the enclosure is known.

use super::{Enclosure, Slab, SlabJoin, middle};
use crate::lattice::Interval;
use crate::lattice::axes;

/// A point of the cube and a radius: all of the ball around it lies in the cube and, that is proven, in the
/// solid. `None` if none is found. It is not the largest one.
pub(crate) fn ball(enclosure: &Enclosure) -> Option<([f64; 3], f64)> {
    let known = enclosure.slabs.iter().filter(|slab| slab.normal != [0.0; 3]);
    match enclosure.join {
        SlabJoin::All => within(known.copied()),
        SlabJoin::Any => {
            known.filter_map(|slab| within(core::iter::once(*slab))).max_by(|(_, a), (_, b)| a.total_cmp(b))
        }
    }
}

/// A ball on the inner sides of all slabs.
fn within(slabs: impl Iterator<Item = Slab> + Clone) -> Option<([f64; 3], f64)> {
    let mut halves = [([0.0; 3], 0.0); 3];
    let mut count = 0;
    for slab in slabs.clone().filter(|slab| slab.inner < f64::INFINITY) {
        *halves.get_mut(count)? = (slab.normal, slab.inner);
        count += 1;
    }
    let at = middle(&halves[..count])??;
    let room = halves[..count].iter().map(|&(normal, end)| room(normal, end, at));
    let radius = at.iter().map(|c| (1.0 - c.abs()).next_down()).chain(room).fold(1.0, f64::min);
    // (What is no number is not greater.)
    (radius > 0.0).then_some((at, radius))
}

/// No more than the distance from a point to the plane n · x = end, before which the point lies; less than 0
/// if that is not sure.
fn room(normal: [f64; 3], end: f64, at: [f64; 3]) -> f64 {
    // Lengths are of a normal that is neither huge nor tiny.
    let size = normal.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    if !(1e-100..1e100).contains(&size) {
        return -1.0;
    }
    let terms = axes(|k| Interval::exactly(normal[k]).times(Interval::exactly(at[k])));
    let left = Interval::exactly(end).minus(terms[0].plus(terms[1]).plus(terms[2])).lower;
    let length = libm::sqrt(normal.iter().map(|c| c * c).sum::<f64>());
    left / length * (1.0 - 16.0 * f64::EPSILON)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ball_lies_in_the_solid() {
        let slab = |normal, inner| Slab { normal, inner, outer: f64::INFINITY };
        let all = |slabs| Enclosure { slabs, join: SlabJoin::All, cone: f64::INFINITY };
        // Between planes that are 2 · 10⁻⁹ apart.
        let thin =
            all([slab([1.0, 1.0, 1.0], 0.5 + 1e-9), slab([-1.0, -1.0, -1.0], -0.5 + 1e-9), Slab::NONE]);
        let (at, radius) = ball(&thin).unwrap();
        assert!(
            (at.iter().sum::<f64>() - 0.5).abs() < 1e-9 && radius > 1e-10 && radius < 2e-9,
            "{at:?} {radius}"
        );
        let none = all([slab([1.0, 0.0, 0.0], -0.5), slab([-1.0, 0.0, 0.0], 0.5 - 1e-12), Slab::NONE]);
        assert_eq!(ball(&none), None);
        // All of the cube.
        let (at, radius) = ball(&all([slab([0.0, 2.0, 0.0], 3.0), Slab::NONE, Slab::NONE])).unwrap();
        assert!(at.iter().all(|c| c.abs() < 1e-12) && radius > 0.99);
        let nothing = all([slab([0.0, 2.0, 0.0], f64::NEG_INFINITY), Slab::NONE, Slab::NONE]);
        assert_eq!(ball(&nothing), None);
        // Of a union the best.
        let any = Enclosure {
            slabs: [slab([1.0, 0.0, 0.0], -0.9), slab([0.0, -3.0, 0.0], 0.0), Slab::NONE],
            join: SlabJoin::Any,
            cone: f64::INFINITY,
        };
        let (at, radius) = ball(&any).unwrap();
        assert!(at[1] > 0.0 && radius > 0.4);
    }
}
