//! A simple polygon as a formula of half-planes.
//!
//! Every simple polygon is a monotone formula (unions and intersections, no complements) in which the
//! half-plane of each edge occurs once (Peterson, *Halfspace representation of extrusions, solids of
//! revolution, and pyramids*, 1984). A three-valued evaluation needs such a formula: where the line of an
//! edge continues through the interior, the rest of the formula must decide without that edge. A
//! triangulation and a convex decomposition leave seams at their cuts. Differences of convex hulls (Tor and
//! Middleditch 1984) have such cuts at the edges of the hulls.
//!
//! The formula is found as in the proof of Dobkin, Guibas, Hershberger and Snoeyink, *An efficient algorithm
//! for finding the CSG representation of a simple polygon* (SIGGRAPH 1988; Algorithmica 1993). The polygon is
//! cut at its first and last corner in lexicographic order, into chains of edges whose end edges are extended
//! to infinity. A chain may be cut at any corner on its convex hull. At a corner that turns left, the chain's
//! side is the intersection of the sides of both parts; at a corner that turns right, it is their union.
//! Their algorithm finds all cuts in O(n log n) with a structure for hulls of paths; here each cut takes
//! O(log² n), with a tree of hulls. All decisions are signs of exact arithmetic.

use alloc::vec::Vec;

use super::hulls::Hulls;
use super::segment::{before, turn};
use super::simple;
use crate::error::Error;
use crate::lattice::valid;
use crate::memory;

/// One term of a formula in postfix order: operators combine the terms directly before them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Term {
    /// The half-plane to the left of the line from one point to the other (indices into the points).
    Edge([usize; 2]),
    /// The intersection of this number of terms (two or more).
    All(usize),
    /// The union of this number of terms (two or more).
    Any(usize),
}

/// Returns the formula of the polygon with these corners, in order, in either direction of rotation. The last
/// corner is joined to the first. Corners that repeat the one before, and corners on the straight line
/// between their neighbours, are left out, so that there may be fewer edges than points. Every other edge
/// occurs once.
///
/// O(n log² n) time, O(n log n) memory.
///
/// # Errors
/// [`Error::Argument`] if a coordinate is neither zero nor of a magnitude between 2^-256 and 2^256, or if the
/// outline touches or crosses itself or encloses nothing; [`Error::OutOfMemory`].
pub(crate) fn monotone_formula(points: &[[f64; 2]]) -> Result<Vec<Term>, Error> {
    valid::numbers("polygon", points.as_flattened())?;
    let mut corners = memory::with_capacity(points.len())?;
    for (i, point) in points.iter().enumerate() {
        if corners.last().is_none_or(|&last: &usize| points[last] != *point) {
            corners.push(i);
        }
    }
    while corners.len() > 1 && points[corners[0]] == points[corners[corners.len() - 1]] {
        corners.pop();
    }
    let mut outline = Outline { points, corners };
    outline.check()?;
    outline.normalise()?;
    outline.formula()
}

fn refuse<T>(problem: &'static str) -> Result<T, Error> {
    Err(Error::Argument { name: "polygon", problem })
}

/// The corners of a closed polygon in order.
struct Outline<'a> {
    points: &'a [[f64; 2]],
    corners: Vec<usize>,
}

impl Outline<'_> {
    /// The point of corner `i`, counted cyclically.
    fn at(&self, i: usize) -> [f64; 2] {
        self.points[self.corners[i % self.corners.len()]]
    }

    fn edge(&self, i: usize) -> [[f64; 2]; 2] {
        [self.at(i), self.at(i + 1)]
    }

    /// Returns whether corner `i` (≥ 1) turns left (1), right (−1) or not (0).
    fn turn_at(&self, i: usize) -> i32 {
        turn(self.edge(i - 1), self.edge(i))
    }

    /// Refuses outlines that touch or cross themselves.
    fn check(&self) -> Result<(), Error> {
        let n = self.corners.len();
        if n < 3 {
            return refuse("a polygon has at least three corners at different places");
        }
        for i in 1..=n {
            let ([a, b], c) = (self.edge(i - 1), self.at(i + 1));
            let back = |axis: usize| (a[axis] - b[axis]) * (c[axis] - b[axis]) > 0.0;
            if turn([a, b], [b, c]) == 0 && (back(0) || back(1)) {
                return refuse("the outline goes back along one of its edges");
            }
        }
        let corners = memory::collected(self.corners.iter().map(|&corner| self.points[corner]))?;
        if simple::is_simple(&corners)? { Ok(()) } else { refuse("the outline touches or crosses itself") }
    }

    /// Makes the outline counter-clockwise, with the lexicographically smallest corner first, and without
    /// corners that do not turn.
    fn normalise(&mut self) -> Result<(), Error> {
        let n = self.corners.len();
        let mut kept = memory::with_capacity(n)?;
        kept.extend((1..=n).filter(|&i| self.turn_at(i) != 0).map(|i| self.corners[i % n]));
        self.corners = kept;
        let points = self.points;
        let first = self.extreme(|new, old| before(points[new], points[old]));
        if self.turn_at(first + self.corners.len()) < 0 {
            self.corners.reverse();
        }
        let first = self.extreme(|new, old| before(points[new], points[old]));
        self.corners.rotate_left(first);
        Ok(())
    }

    /// Returns the index of the corner whose point is preferred to all others.
    fn extreme(&self, preferred: impl Fn(usize, usize) -> bool) -> usize {
        let mut best = 0;
        for i in 1..self.corners.len() {
            if preferred(self.corners[i], self.corners[best]) {
                best = i;
            }
        }
        best
    }

    /// Returns the formula of a normalised outline.
    fn formula(&self) -> Result<Vec<Term>, Error> {
        enum Task {
            /// The side of the chain of the edges `from..to`, as an operand of `parent`.
            Chain { from: usize, to: usize, parent: Operator },
            /// The operands of an operator are written: write the operator.
            Close(Operator),
        }
        let n = self.corners.len();
        let points = self.points;
        let last = self.extreme(|new, old| before(points[old], points[new]));
        // There are fewer operators than edges. At most one operator and one chain wait for each cut.
        let mut terms = memory::with_capacity(2 * n)?;
        let mut counts = memory::with_capacity(n + 1)?;
        let mut tasks = memory::with_capacity(2 * n + 2)?;
        let hulls = Hulls::new(n, |i| self.at(i))?;
        let whole = Operator::All;
        counts.push(0);
        tasks.push(Task::Close(whole));
        tasks.push(Task::Chain { from: last, to: n, parent: whole });
        tasks.push(Task::Chain { from: 0, to: last, parent: whole });
        while let Some(task) = tasks.pop() {
            match task {
                Task::Chain { from, to, .. } if to - from == 1 => {
                    terms.push(Term::Edge([self.corners[from], self.corners[to % n]]));
                    increment(&mut counts);
                }
                Task::Chain { from, to, parent } => {
                    let cut = self.cut(&hulls, from, to);
                    let operator = if self.turn_at(cut) > 0 { Operator::All } else { Operator::Any };
                    if operator != parent {
                        counts.push(0);
                        tasks.push(Task::Close(operator));
                    }
                    tasks.push(Task::Chain { from: cut, to, parent: operator });
                    tasks.push(Task::Chain { from, to: cut, parent: operator });
                }
                Task::Close(operator) => {
                    let count = counts.pop().unwrap_or(0);
                    terms.push(match operator {
                        Operator::All => Term::All(count),
                        Operator::Any => Term::Any(count),
                    });
                    increment(&mut counts);
                }
            }
        }
        Ok(terms)
    }

    /// Returns a corner within the chain of the edges `from..to` (two or more) that lies on the hull of the
    /// chain with its first and last edge extended to infinity.
    ///
    /// The corner is the farthest one in a direction in which neither extension continues: across the chord
    /// of the chain, which halves an arc, or otherwise across the first edge.
    fn cut(&self, hulls: &Hulls, from: usize, to: usize) -> usize {
        let (first, last) = (self.edge(from), self.edge(to - 1));
        let mut base = [self.at(from), self.at(to)];
        let (rise, fall) = (turn(base, first), turn(base, last));
        let mut side = if rise != 0 { rise } else { -fall };
        if rise * fall > 0 {
            base = first;
            side = -turn(first, last);
        }
        if side < 0 {
            base.reverse();
        }
        hulls.farthest(base, from + 1, to, |i| self.at(i))
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Operator {
    All,
    Any,
}

fn increment(counts: &mut [usize]) {
    if let Some(count) = counts.last_mut() {
        *count += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::csg::figure::segment::meet;

    /// Kleene evaluation from the sides of the edges: 1, −1 or 0.
    fn value(terms: &[Term], side: impl Fn([usize; 2]) -> i32) -> i32 {
        let mut stack: Vec<i32> = Vec::new();
        for &term in terms {
            let value = match term {
                Term::Edge(edge) => side(edge),
                Term::All(count) => stack.drain(stack.len() - count..).min().unwrap(),
                Term::Any(count) => stack.drain(stack.len() - count..).max().unwrap(),
            };
            stack.push(value);
        }
        assert_eq!(stack.len(), 1);
        stack[0]
    }

    /// Returns 1 inside, −1 outside, 0 on the outline, from the crossings of the ray to the right, in exact
    /// arithmetic.
    fn truth(points: &[[f64; 2]], p: [f64; 2]) -> i32 {
        let mut inside = -1;
        for i in 0..points.len() {
            let (a, b) = (points[i], points[(i + 1) % points.len()]);
            let side = turn([a, b], [a, p]);
            if side == 0 && (0..2).all(|k| a[k].min(b[k]) <= p[k] && p[k] <= a[k].max(b[k])) {
                return 0;
            }
            if (a[1] > p[1]) != (b[1] > p[1]) && (side > 0) == (b[1] > a[1]) {
                inside = -inside;
            }
        }
        inside
    }

    fn random(state: &mut u64) -> u64 {
        *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = *state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Checks a polygon of integer corners in 0..size at all points of a lattice of quarters.
    fn check(points: &[[f64; 2]], size: i32) {
        let terms = monotone_formula(points).unwrap();
        let edges: Vec<_> =
            terms.iter().filter_map(|t| if let Term::Edge(e) = t { Some(*e) } else { None }).collect();
        let mut starts: Vec<_> = edges.iter().map(|e| e[0]).collect();
        starts.sort_unstable();
        starts.dedup();
        assert_eq!(starts.len(), edges.len(), "every edge occurs once");
        for x in -2..=4 * size {
            for y in -2..=4 * size {
                // Slightly off the quarters, so that edges rarely pass through a point; both kinds of points
                // are tested.
                for shift in [0.0, 0.015625] {
                    let p = [f64::from(x) / 4.0 + shift, f64::from(y) / 4.0];
                    let side = |[a, b]: [usize; 2]| turn([points[a], points[b]], [points[a], p]);
                    let found = value(&terms, side);
                    let expected = truth(points, p);
                    let on = edges.iter().filter(|&&edge| side(edge) == 0).count();
                    match on {
                        // Where only the line of one edge continues, nothing may be undecided.
                        0 | 1 => assert_eq!(found, expected, "{points:?} at {p:?}: {terms:?}"),
                        _ => assert!(found == expected || found == 0, "{points:?} at {p:?}"),
                    }
                }
            }
        }
    }

    #[test]
    fn formulas_are_the_polygons_without_seams() {
        let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
        check(&square, 5);
        assert_eq!(monotone_formula(&square).unwrap().last(), Some(&Term::All(4)));
        // Repeated corners, straight corners, and the other direction.
        let repeated = [[0.0, 4.0], [4.0, 4.0], [4.0, 4.0], [4.0, 2.0], [4.0, 0.0], [0.0, 0.0], [0.0, 4.0]];
        check(&repeated, 5);
        assert_eq!(monotone_formula(&repeated).unwrap().len(), 5);
        let comb =
            [[0.0, 0.0], [7.0, 0.0], [7.0, 4.0], [6.0, 4.0], [6.0, 1.0], [4.0, 1.0], [4.0, 4.0], [3.0, 4.0]];
        check(&[&comb[..], &[[3.0, 1.0], [1.0, 1.0], [1.0, 4.0], [0.0, 4.0]]].concat(), 8);
        let spiral =
            [[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0], [0.0, 2.0], [6.0, 2.0], [6.0, 6.0], [2.0, 6.0]];
        let inner =
            [[2.0, 4.0], [4.0, 4.0], [4.0, 5.0], [3.0, 5.0], [5.0, 5.0], [5.0, 3.0], [1.0, 3.0], [1.0, 7.0]];
        let outer = [[7.0, 7.0], [7.0, 1.0], [0.0, 1.0]];
        assert!(monotone_formula(&[&spiral[..], &inner, &outer].concat()).is_err());
        let inner = [[2.0, 4.0], [4.0, 4.0], [4.0, 5.0], [5.0, 5.0], [5.0, 3.0], [1.0, 3.0], [1.0, 7.0]];
        check(&[&spiral[..], &inner, &outer].concat(), 9);
    }

    #[test]
    fn random_polygons_of_small_integers() {
        let mut state = 5;
        let mut counts = [0; 12];
        while counts[5..].iter().sum::<i32>() < 3000 {
            let n = 3 + (random(&mut state) % 9) as usize;
            let point = |state: &mut u64| [0, 1].map(|_| (random(state) % 7) as f64);
            let mut points: Vec<_> = (0..n).map(|_| point(&mut state)).collect();
            // Remove crossings by reversing parts, as far as this works.
            for _ in 0..50 {
                let (i, j) = ((random(&mut state) as usize) % n, (random(&mut state) as usize) % n);
                let (i, j) = (i.min(j), i.max(j));
                if j > i + 1 && meet([points[i], points[i + 1]], [points[j], points[(j + 1) % n]]) {
                    points[i + 1..=j].reverse();
                }
            }
            if monotone_formula(&points).is_ok() {
                counts[n] += 1;
                check(&points, 7);
            }
        }
        assert!(counts[8..].iter().all(|&count| count > 20), "{counts:?}");
    }

    #[test]
    fn large_outlines() {
        let n = 20_000;
        let zigzag = |i: usize, turns: f64| {
            let (sin, cos) = libm::sincos(turns * core::f64::consts::TAU * i as f64 / n as f64);
            let radius = if i.is_multiple_of(2) { 1.0 } else { 0.9 };
            [radius * cos, radius * sin]
        };
        let star: Vec<_> = (0..n).map(|i| zigzag(i, 1.0)).collect();
        let terms = monotone_formula(&star).unwrap();
        for p in [[0.0, 0.0], [0.5, 0.7], [0.94, 0.0], [0.2, -0.95], [1.0, 1.0]] {
            let side = |[a, b]: [usize; 2]| turn([star[a], star[b]], [star[a], p]);
            assert_eq!(value(&terms, side), truth(&star, p));
        }
        let disc: Vec<_> = (0..n).map(|i| zigzag(2 * i, 0.5)).collect();
        assert_eq!(monotone_formula(&disc).unwrap().last(), Some(&Term::All(n)));
    }

    /// Outlines in which each cut removes one corner, and outlines in which a sweep line meets every edge.
    #[test]
    #[cfg(feature = "std")]
    fn outlines_that_spiral_and_combs_take_little_time() {
        let n = 20_000;
        let arm = |i: usize, radius: f64| {
            let angle = 40.0 * core::f64::consts::PI * i as f64 / n as f64;
            let (sin, cos) = libm::sincos(angle);
            [(radius + angle) * cos, (radius + angle) * sin]
        };
        let spiral: Vec<_> = (0..n).map(|i| arm(i, 1.0)).chain((0..n).rev().map(|i| arm(i, 2.5))).collect();
        let tooth = |i: usize| {
            let x = 2.0 * i as f64;
            [[x, 0.0], [x, 10.0], [x + 1.0, 10.0], [x + 1.0, 0.0]]
        };
        let comb: Vec<_> = (0..n / 4).flat_map(tooth).chain([[n as f64, -1.0], [0.0, -1.0]]).collect();
        for outline in [spiral, comb] {
            let start = std::time::Instant::now();
            let terms = monotone_formula(&outline).unwrap();
            assert!(start.elapsed().as_secs_f64() < 2.0, "{:?}", start.elapsed());
            for p in [[0.5, 5.0], [1.5, 5.0], [3.5, 0.2], [80.3, 9.0], [-60.0, 60.0], [0.0, -40.5]] {
                let side = |[a, b]: [usize; 2]| turn([outline[a], outline[b]], [outline[a], p]);
                assert_eq!(value(&terms, side), truth(&outline, p), "{p:?}");
            }
        }
    }

    #[test]
    fn refusals() {
        for points in [
            &[][..],
            &[[0.0, 0.0], [1.0, 0.0]],
            &[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]],
            &[[0.0, 0.0], [1.0, 0.0], [0.0, 0.0], [0.0, 0.0]],
            &[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]],
            &[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 0.0], [0.0, 4.0]],
            &[[0.0, 0.0], [2.0, 0.0], [4.0, 0.0], [4.0, 3.0], [2.0, 0.0], [0.0, 3.0]],
            &[[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [6.0, 2.0], [4.0, 2.0], [4.0, 4.0]],
            &[[0.0, 0.0], [1.0, f64::NAN], [1.0, 0.0]],
            &[[0.0, 0.0], [1.0, 1e300], [1.0, 0.0]],
        ] {
            let result = monotone_formula(points);
            assert!(matches!(result, Err(Error::Argument { name: "polygon", .. })), "{points:?}: {result:?}");
        }
    }
}
