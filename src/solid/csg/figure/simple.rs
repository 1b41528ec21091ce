//! A test of whether a closed polygon is simple.
//!
//! The test is a sweep over the corners in lexicographic order, as Shamos and Hoey (*Geometric intersection
//! problems*, 1976) describe it. The edges over the sweep line are kept in their order from below, and only
//! neighbours are compared: two edges are neighbours before they meet for the first time. All decisions are
//! signs of exact arithmetic.

use super::segment::{before, meet, turn};
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use alloc::collections::BTreeSet;
use alloc::vec::Vec;
use core::cmp::Ordering;
use core::ops::Bound::{Excluded, Unbounded};

/// An edge from its lower to its higher end in lexicographic order.
#[derive(Clone, Copy)]
struct Edge {
    low: [f64; 2],
    high: [f64; 2],
    index: usize,
}

impl Edge {
    /// Returns on which side of the edge's line a point lies: 1 above.
    fn side(&self, point: [f64; 2]) -> i32 {
        turn([self.low, self.high], [self.low, point])
    }
}

/// The order from below of edges that a common sweep line meets. It does not depend on the sweep line as long
/// as the edges do not meet.
impl Ord for Edge {
    fn cmp(&self, other: &Edge) -> Ordering {
        if self.index == other.index {
            return Ordering::Equal;
        }
        // Compare the ends of the edge that begins later with the other edge.
        let (first, second, sense) =
            if before(other.low, self.low) { (other, self, 1) } else { (self, other, -1) };
        let side = match first.side(second.low) {
            0 => first.side(second.high),
            side => side,
        };
        (sense * side).cmp(&0).then(self.index.cmp(&other.index))
    }
}

impl PartialOrd for Edge {
    fn partial_cmp(&self, other: &Edge) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Edge {
    fn eq(&self, other: &Edge) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Edge {}

/// The most memory of an edge in the sorted set, in bytes.
const BYTES: usize = 2 * size_of::<Edge>() + 32;

/// Returns whether no two edges of a closed polygon have a point in common, except for the corners of
/// consecutive edges. No two consecutive corners may be equal, and no edge may go back along the one before.
///
/// O(n log n).
///
/// # Errors
/// [`Error::OutOfMemory`].
pub(crate) fn is_simple(corners: &[[f64; 2]]) -> Result<bool, Error> {
    let count = corners.len();
    // The set allocates memory in small pieces, and such an allocation cannot fail gracefully. So the same
    // amount is reserved and released first, which makes a shortage an error.
    memory::with_capacity::<u8>(count.saturating_mul(BYTES))?;
    let mut order: Vec<usize> = memory::with_capacity(count)?;
    order.extend(0..count);
    let place = |&i: &usize| corners[i];
    order.sort_unstable_by(|i, j| {
        let (p, q) = (place(i), place(j));
        p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1]))
    });
    if order.windows(2).any(|pair| corners[pair[0]] == corners[pair[1]]) {
        return Ok(false);
    }
    let edge = |index: usize| {
        let (a, b) = (corners[index], corners[(index + 1) % count]);
        if before(a, b) { Edge { low: a, high: b, index } } else { Edge { low: b, high: a, index } }
    };
    let are_apart = |a: &Edge, b: &Edge| {
        let are_next = (a.index + 1) % count == b.index || (b.index + 1) % count == a.index;
        are_next || !meet([a.low, a.high], [b.low, b.high])
    };
    let mut open: BTreeSet<Edge> = BTreeSet::new();
    for &corner in &order {
        let both = [edge((corner + count - 1) % count), edge(corner)];
        let begins = both.each(|edge| edge.low == corners[corner]);
        for (edge, _) in both.iter().zip(begins).filter(|(_, begins)| !begins) {
            // (An edge that is not found has changed its order with another edge.)
            if !open.remove(edge) {
                return Ok(false);
            }
            let below = open.range((Unbounded, Excluded(edge))).next_back();
            let above = open.range((Excluded(edge), Unbounded)).next();
            if let (Some(below), Some(above)) = (below, above)
                && !are_apart(below, above)
            {
                return Ok(false);
            }
        }
        for (edge, _) in both.iter().zip(begins).filter(|(_, begins)| *begins) {
            let below = open.range((Unbounded, Excluded(edge))).next_back();
            let above = open.range((Excluded(edge), Unbounded)).next();
            if [below, above].into_iter().flatten().any(|other| !are_apart(edge, other)) {
                return Ok(false);
            }
            open.insert(*edge);
        }
    }
    Ok(true)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares all pairs of edges.
    fn oracle(corners: &[[f64; 2]]) -> bool {
        let count = corners.len();
        let edge = |i: usize| [corners[i], corners[(i + 1) % count]];
        (0..count).all(|i| (i + 2..count).all(|j| (j + 1) % count == i || !meet(edge(i), edge(j))))
    }

    fn goes_back(corners: &[[f64; 2]]) -> bool {
        let count = corners.len();
        (0..count).any(|i| {
            let [a, b, c] = [0, 1, 2].map(|k| corners[(i + k) % count]);
            let dot = (a[0] - b[0]) * (c[0] - b[0]) + (a[1] - b[1]) * (c[1] - b[1]);
            a == b || turn([a, b], [b, c]) == 0 && dot > 0.0
        })
    }

    fn random(state: &mut u64) -> u64 {
        *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = *state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Polygons of small integers, which touch and cross in all ways. Reversing parts makes many of them
    /// simple.
    #[test]
    fn random_polygons_against_all_pairs() {
        let mut state = 11;
        let mut counts = [0; 2];
        for round in 0..60_000 {
            let size = 3 + round % 6;
            let count = 3 + (random(&mut state) % 14) as usize;
            let mut corners: Vec<[f64; 2]> =
                (0..count).map(|_| [0, 1].map(|_| (random(&mut state) % size) as f64)).collect();
            for _ in 0..random(&mut state) % 80 {
                let (i, j) = (random(&mut state) as usize % count, random(&mut state) as usize % count);
                let (i, j) = (i.min(j), i.max(j));
                let next = |k: usize| corners[(k + 1) % count];
                if j > i + 1 && meet([corners[i], next(i)], [corners[j], next(j)]) {
                    corners[i + 1..=j].reverse();
                }
            }
            if goes_back(&corners) {
                continue;
            }
            let truth = oracle(&corners);
            counts[usize::from(truth)] += 1;
            assert_eq!(is_simple(&corners).unwrap(), truth, "{corners:?}");
        }
        assert!(counts.iter().all(|&count| count > 3000), "{counts:?}");
    }

    /// Long outlines that are simple except for one corner, which barely touches or crosses another edge.
    #[test]
    fn a_hair_in_a_long_outline() {
        let zigzag = |shift: f64| -> Vec<[f64; 2]> {
            let teeth = (0..400).map(|i| [f64::from(i), if i % 2 == 0 { 0.0 } else { 10.0 }]);
            let back = (0..400).rev().map(|i| [f64::from(i), if i % 2 == 0 { 1.0 } else { 11.0 }]);
            let mut corners: Vec<_> = teeth.chain(back).collect();
            corners[600][1] += shift;
            corners
        };
        assert!(is_simple(&zigzag(0.0)).unwrap() && oracle(&zigzag(0.0)));
        for shift in [-1.0, -11.0, -1.0 - 1e-9, -1.0 + 1e-9, 1e3] {
            for corners in [zigzag(shift), zigzag(shift).iter().map(|&[x, y]| [y, x]).collect()] {
                assert_eq!(is_simple(&corners).unwrap(), oracle(&corners), "{shift}");
            }
        }
    }
}
