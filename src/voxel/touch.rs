//! Exact test whether a closed triangle and a closed cube intersect.
//!
//! Two convex polytopes are disjoint if one of finitely many directions separates them (the separating-axis
//! test, Gottschalk, Lin and Manocha 1996). For a triangle and a cube these are the cube's axes, the
//! triangle's normal, and the products of the axes with the triangle's edges. Intervals decide nearly all
//! cases; integers decide the rest.

use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::Dyadic;
use crate::lattice::{Bounds, Cube, Interval};
use crate::mesh::TriangleMesh;

/// The corners of a triangle in model units.
pub(super) type Corners = [[f64; 3]; 3];

/// The corners of a triangle of a mesh.
pub(super) fn corners(mesh: &TriangleMesh, triangle: [u32; 3]) -> Corners {
    triangle.each(|vertex| mesh.vertices()[vertex as usize])
}

/// The least box around a triangle.
pub(super) fn bounds([a, b, c]: &Corners) -> Bounds {
    Bounds {
        min: axes(|axis| a[axis].min(b[axis]).min(c[axis])),
        max: axes(|axis| a[axis].max(b[axis]).max(c[axis])),
    }
}

/// Returns whether a triangle and a cube intersect.
pub(super) fn meets(corners: &Corners, cube: &Cube<'_>) -> bool {
    by_intervals(corners, cube).or_else(|| exactly(corners, cube)).unwrap_or(true)
}

/// Returns whether a triangle and a cube may intersect: true also where intervals leave it open.
pub(super) fn may_meet(corners: &Corners, cube: &Cube<'_>) -> bool {
    by_intervals(corners, cube).unwrap_or(true)
}

fn by_intervals(corners: &Corners, cube: &Cube<'_>) -> Option<bool> {
    let places = corners.each(|corner| cube.centre_from(corner).each(Interval::negated));
    let edge = |k: usize, axis: usize| {
        Interval::exactly(corners[(k + 1) % 3][axis]).minus(Interval::exactly(corners[k][axis]))
    };
    let edges = axes(|k| axes(|axis| edge(k, axis)));
    apart(&places, &edges, &Interval::exactly(cube.half_edge())).map(|apart| !apart)
}

fn exactly(corners: &Corners, cube: &Cube<'_>) -> Option<bool> {
    let (lower, upper) = cube.planes();
    let half_cell = Dyadic::new(cube.frame.cell_size()).shifted(-1);
    let centre = axes(|axis| {
        let middle = Dyadic::new((lower[axis] + upper[axis]) as f64);
        &Dyadic::new(cube.frame.origin()[axis]) + &(&middle * &half_cell)
    });
    let places = corners.each(|corner| axes(|axis| &Dyadic::new(corner[axis]) - &centre[axis]));
    let edges = axes(|k| axes(|axis| &places[(k + 1) % 3][axis] - &places[k][axis]));
    apart(&places, &edges, &Dyadic::new(cube.half_edge())).map(|apart| !apart)
}

/// Numbers that are exact, or known only within bounds.
trait Number: Clone {
    fn plus(&self, other: &Self) -> Self;
    fn minus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
    fn magnitude(&self) -> Self;
    fn negated(&self) -> Self;
    /// Returns whether this number is greater than the other; `None` if that is uncertain.
    fn exceeds(&self, other: &Self) -> Option<bool>;
}

impl Number for Interval {
    fn plus(&self, other: &Interval) -> Interval {
        Interval::plus(*self, *other)
    }

    fn minus(&self, other: &Interval) -> Interval {
        Interval::minus(*self, *other)
    }

    fn times(&self, other: &Interval) -> Interval {
        Interval::times(*self, *other)
    }

    fn magnitude(&self) -> Interval {
        let least = self.lower.max(-self.upper).max(0.0);
        Interval::between(least, self.upper.max(-self.lower))
    }

    fn negated(&self) -> Interval {
        Interval::negated(*self)
    }

    fn exceeds(&self, other: &Interval) -> Option<bool> {
        if self.lower > other.upper {
            Some(true)
        } else if self.upper <= other.lower {
            Some(false)
        } else {
            None
        }
    }
}

impl Number for Dyadic {
    fn plus(&self, other: &Dyadic) -> Dyadic {
        self + other
    }

    fn minus(&self, other: &Dyadic) -> Dyadic {
        self - other
    }

    fn times(&self, other: &Dyadic) -> Dyadic {
        self * other
    }

    fn magnitude(&self) -> Dyadic {
        if self.sign() < 0 { self.negated() } else { self.clone() }
    }

    fn negated(&self) -> Dyadic {
        &Dyadic::zero() - self
    }

    fn exceeds(&self, other: &Dyadic) -> Option<bool> {
        Some(self > other)
    }
}

/// Returns whether a direction separates a triangle from a cube; `None` if that is uncertain. The triangle's
/// corners are relative to the centre of the cube.
fn apart<N: Number>(places: &[[N; 3]; 3], edges: &[[N; 3]; 3], half: &N) -> Option<bool> {
    let mut sure = true;
    // Returns whether all of these numbers lie beyond the reach, on one side.
    let mut separates = |numbers: [&N; 3], reach: &N| {
        let beyond = |turned: bool| {
            let mut all = Some(true);
            for number in numbers {
                let exceeds = if turned { number.negated().exceeds(reach) } else { number.exceeds(reach) };
                match exceeds {
                    Some(false) => return Some(false),
                    None => all = None,
                    Some(true) => {}
                }
            }
            all
        };
        let sides = [beyond(false), beyond(true)];
        sure &= sides.iter().all(|side| side.is_some());
        sides.contains(&Some(true))
    };
    for axis in 0..3 {
        if separates([&places[0][axis], &places[1][axis], &places[2][axis]], half) {
            return Some(true);
        }
    }
    let difference = |a: &N, b: &N, c: &N, d: &N| a.times(b).minus(&c.times(d));
    for edge in edges {
        for axis in 0..3 {
            // The axis times the edge has the components −w along u and u along w.
            let (u, w) = ((axis + 1) % 3, (axis + 2) % 3);
            let along = axes(|k| difference(&places[k][w], &edge[u], &places[k][u], &edge[w]));
            let reach = half.times(&edge[u].magnitude().plus(&edge[w].magnitude()));
            if separates([&along[0], &along[1], &along[2]], &reach) {
                return Some(true);
            }
        }
    }
    let [a, b, _] = edges;
    let normal = axes(|axis| {
        let (u, w) = ((axis + 1) % 3, (axis + 2) % 3);
        difference(&a[u], &b[w], &a[w], &b[u])
    });
    let term = |axis: usize| normal[axis].times(&places[0][axis]);
    let height = term(0).plus(&term(1)).plus(&term(2));
    let reach = half.times(&normal[0].magnitude().plus(&normal[1].magnitude()).plus(&normal[2].magnitude()));
    if separates([&height, &height, &height], &reach) {
        return Some(true);
    }
    sure.then_some(false)
}
