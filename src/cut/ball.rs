//! Finds a ball that lies in a solid, in a cell whose enclosure is known.

use super::{Enclosure, Slab, SlabJoin, middle};
use crate::lattice::Interval;
use crate::lattice::axes;

/// Returns a point of the cube and a radius. The ball around the point lies in the cube and, provably, in the
/// solid. `None` if none is found. It need not be the largest such ball.
pub(crate) fn ball(enclosure: &Enclosure) -> Option<([f64; 3], f64)> {
    let known = enclosure.slabs.iter().filter(|slab| slab.normal != [0.0; 3]);
    match enclosure.join {
        SlabJoin::All => within(known.copied()),
        SlabJoin::Any => {
            known.filter_map(|slab| within(core::iter::once(*slab))).max_by(|(_, a), (_, b)| a.total_cmp(b))
        }
    }
}

/// Finds a ball on the inner sides of all slabs.
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
    // (A comparison with NaN is false.)
    (radius > 0.0).then_some((at, radius))
}

/// A lower bound of the distance from a point to the plane n · x = end, where the point lies before the
/// plane. Negative if the position of the point is uncertain.
fn room(normal: [f64; 3], end: f64, at: [f64; 3]) -> f64 {
    // Lengths are computed only for a normal that is neither huge nor tiny.
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
        // The whole cube.
        let (at, radius) = ball(&all([slab([0.0, 2.0, 0.0], 3.0), Slab::NONE, Slab::NONE])).unwrap();
        assert!(at.iter().all(|c| c.abs() < 1e-12) && radius > 0.99);
        let nothing = all([slab([0.0, 2.0, 0.0], f64::NEG_INFINITY), Slab::NONE, Slab::NONE]);
        assert_eq!(ball(&nothing), None);
        // The best ball of a union.
        let any = Enclosure {
            slabs: [slab([1.0, 0.0, 0.0], -0.9), slab([0.0, -3.0, 0.0], 0.0), Slab::NONE],
            join: SlabJoin::Any,
            cone: f64::INFINITY,
        };
        let (at, radius) = ball(&any).unwrap();
        assert!(at[1] > 0.0 && radius > 0.4);
    }
}
