//! The surfaces that bound a solid, as functions on the lattice of a boundary evaluation.
//!
//! Points are in unit coordinates: the universe is [0, 1]³. The side of a surface on which a corner of the
//! lattice lies is an exact sign. Places are computed in plain doubles, to the last digits; they decide
//! nothing but the order of places.

use crate::cut::{Quadratic, Taylor};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::lattice::{Cell, Frame, axes};
use crate::memory;
use crate::solid::PlacedHalfSpace;
use crate::solid::half_space::Placed;
use alloc::vec::Vec;

/// The curvature class of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    Plane,
    /// Curved along one direction at each point, as a cylinder or a cone.
    Ruled,
    Bent,
}

struct Figure {
    placed: Placed,
    shape: Shape,
}

/// The surfaces, by their numbers in the classifier's list.
pub(super) struct Figures {
    list: Vec<Figure>,
}

/// The greatest determinant of a cylinder or a cone, as a part of the product whose sum it is.
const SINGULAR: f64 = 1e-9;

/// Half the edge of the cube in which a function is expanded to get its value and its gradient at the centre:
/// a power of two.
const NEAR: f64 = 1.0 / (1u64 << 24) as f64;

/// The number of Newton steps.
const STEPS: usize = 24;

/// The number of steps along an edge.
const HALVINGS: usize = 80;

/// The error for a host program's function, whose gradient is unknown.
pub(super) const UNKNOWN: Error =
    Error::Argument { name: "solid", problem: "must consist of surfaces with known functions" };

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    axes(|axis| a[axis] - b[axis])
}

pub(super) fn length(a: [f64; 3]) -> f64 {
    sqrt(dot(a, a))
}

pub(super) fn middle(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    axes(|axis| 0.5 * (a[axis] + b[axis]))
}

impl Figures {
    pub(super) fn new(surfaces: &[PlacedHalfSpace], frame: &Frame) -> Result<Figures, Error> {
        let mut list = memory::with_capacity(surfaces.len())?;
        for surface in surfaces {
            let placed = surface.on(frame)?;
            let shape = match &placed {
                Placed::Host(_) => return Err(UNKNOWN),
                Placed::Plane(_) | Placed::Slab(_) => Shape::Plane,
                Placed::Quadric(_) if placed.taylor([0.5; 3], 0.5).is_some_and(|f| is_ruled(&f.f)) => {
                    Shape::Ruled
                }
                _ => Shape::Bent,
            };
            list.push(Figure { placed, shape });
        }
        Ok(Figures { list })
    }

    pub(super) fn shape(&self, surface: u32) -> Shape {
        self.list[surface as usize].shape
    }

    /// Returns whether a point lies on the positive side of a surface. A point on the surface is treated as a
    /// point a little further along x, y and z.
    pub(super) fn is_positive(&self, surface: u32, at: [f64; 3]) -> Result<bool, Error> {
        let placed = &self.list[surface as usize].placed;
        if !matches!(placed, Placed::Slab(_))
            && let Some(side) = placed.contains_off_lattice(at)?
        {
            return Ok(side);
        }
        // For a plane with a width, its middle decides.
        Ok(self.about(surface, at).0 >= 0.0)
    }

    /// The Taylor expansion of a surface's function in a cell, if it is known.
    pub(super) fn taylor(&self, surface: u32, cell: Cell) -> Option<Taylor> {
        let half = 0.5 / f64::from(1u32 << cell.level);
        let centre = cell.at.each(|at| (2.0 * f64::from(at) + 1.0) * half);
        self.over(surface, centre, half)
    }

    fn over(&self, surface: u32, centre: [f64; 3], half: f64) -> Option<Taylor> {
        Some(self.near(surface, centre, half)?.0)
    }

    /// The Taylor expansion of a surface's function in a cube, the greatest deviation of the surface from the
    /// zeros of this function, and whether the function has no further terms.
    pub(super) fn near(&self, surface: u32, centre: [f64; 3], half: f64) -> Option<(Taylor, f64, bool)> {
        let placed = &self.list[surface as usize].placed;
        match placed {
            Placed::Slab(_) => {
                let tangent = placed.tangent(centre, half)?;
                let (value, width) = (0.5 * (tangent.low + tangent.high), 0.5 * (tangent.high - tangent.low));
                let f = Quadratic { value, gradient: tangent.gradient, squares: [0.0; 6], error: 0.0 };
                Some((Taylor { f, bend: 0.0, degree: 1 }, width, true))
            }
            Placed::Plane(_) | Placed::Quadric(_) => Some((placed.taylor(centre, half)?, 0.0, true)),
            _ => Some((placed.taylor(centre, half)?, 0.0, false)),
        }
    }

    /// The value of a surface's function and its gradient at a point.
    pub(super) fn about(&self, surface: u32, at: [f64; 3]) -> (f64, [f64; 3]) {
        match self.over(surface, at, NEAR) {
            Some(taylor) => (taylor.f.value, taylor.f.gradient.each(|c| c / NEAR)),
            None => (0.0, [0.0; 3]),
        }
    }

    /// The approximate distance of a point from a surface.
    pub(super) fn distance(&self, surface: u32, at: [f64; 3]) -> f64 {
        let (value, gradient) = self.about(surface, at);
        let away = value.abs() / length(gradient);
        if away.is_finite() { away } else { 0.0 }
    }

    /// The place where a segment along an axis meets a surface. The ends of the segment lie on different
    /// sides of the surface.
    pub(super) fn on_edge(&self, surface: u32, axis: usize, from: [f64; 3], to: f64) -> f64 {
        let at = |x: f64| {
            let mut point = from;
            point[axis] = x;
            let (value, gradient) = self.about(surface, point);
            (value, gradient[axis])
        };
        let (mut low, mut high) = (from[axis], to);
        let (first, last) = (at(low).0, at(high).0);
        // (Next to a corner, rounding may put both ends on one side.)
        if first == 0.0 || first * last > 0.0 && first.abs() <= last.abs() {
            return low;
        }
        if last == 0.0 || first * last > 0.0 {
            return high;
        }
        let mut x = low + (high - low) * (first / (first - last));
        for _ in 0..HALVINGS {
            let (value, slope) = at(x);
            if value == 0.0 {
                return x;
            }
            if (value > 0.0) == (first > 0.0) {
                low = x
            } else {
                high = x
            }
            let step = x - value / slope;
            let next = if low < step && step < high { step } else { 0.5 * (low + high) };
            if (next - x).abs() <= 2.0 * f64::EPSILON * x.abs() {
                return next;
            }
            x = next;
        }
        x
    }

    /// A point on up to three surfaces near another point, found by the shortest possible steps. If `kept` is
    /// given, this coordinate stays constant. `None` if no such point is found.
    pub(super) fn onto(&self, surfaces: &[u32], kept: Option<usize>, start: [f64; 3]) -> Option<[f64; 3]> {
        let mut point = start;
        let mut before = f64::INFINITY;
        for _ in 0..STEPS {
            let (mut rows, mut values) = ([[0.0; 3]; 3], [0.0; 3]);
            for (k, &surface) in surfaces.iter().enumerate() {
                let (value, mut gradient) = self.about(surface, point);
                if let Some(axis) = kept {
                    gradient[axis] = 0.0;
                }
                let size = length(gradient);
                (rows[k], values[k]) = (gradient.each(|c| c / size), value / size);
            }
            let step = shortest(&rows[..surfaces.len()], &values)?;
            let next = minus(point, step);
            let size = length(step);
            if size.is_nan() || size >= 1.0 {
                return None;
            }
            point = next;
            if size <= 1e-16 || size >= before && size < 1e-13 {
                return Some(point);
            }
            before = size;
        }
        (before < 1e-12).then_some(point)
    }
}

/// The shortest vector whose dot products with up to three unit vectors are `values`.
pub(super) fn shortest(rows: &[[f64; 3]], values: &[f64; 3]) -> Option<[f64; 3]> {
    let factors = match *rows {
        [a] => {
            let square = dot(a, a);
            [(square > 0.0).then_some(values[0] / square)?, 0.0, 0.0]
        }
        [a, b] => {
            let (aa, ab, bb) = (dot(a, a), dot(a, b), dot(b, b));
            let determinant = aa * bb - ab * ab;
            (determinant > 1e-12).then_some(())?;
            let [x, y, _] = *values;
            [(x * bb - y * ab) / determinant, (y * aa - x * ab) / determinant, 0.0]
        }
        [a, b, c] => {
            // With three vectors, the solution is unique (Cramer's rule).
            let cross = |p: [f64; 3], q: [f64; 3]| {
                [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
            };
            let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
            let determinant = dot(a, bc);
            (determinant.abs() > 1e-9).then_some(())?;
            let [x, y, z] = *values;
            return Some(axes(|i| (x * bc[i] + y * ca[i] + z * ab[i]) / determinant));
        }
        _ => return None,
    };
    let vector = axes(|i| rows.iter().zip(factors).map(|(row, factor)| factor * row[i]).sum::<f64>());
    vector.iter().all(|c| c.is_finite()).then_some(vector)
}

/// Returns whether the surface of a polynomial of degree two is a cylinder or a cone: whether its 4×4 matrix
/// is singular.
fn is_ruled(f: &Quadratic) -> bool {
    let ([x, y, z], [xx, yy, zz, xy, xz, yz]) = (f.gradient.each(|c| 0.5 * c), f.squares);
    let mut rows = [[xx, xy, xz, x], [xy, yy, yz, y], [xz, yz, zz, z], [x, y, z, f.value]];
    let size = rows.as_flattened().iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    for k in 0..4 {
        let pivot = (k..4).fold(k, |best, i| if rows[i][k].abs() > rows[best][k].abs() { i } else { best });
        rows.swap(k, pivot);
        if rows[k][k].abs() <= SINGULAR * size {
            return true;
        }
        let own = rows[k];
        for row in &mut rows[k + 1..] {
            let factor = row[k] / own[k];
            row.iter_mut().zip(own).for_each(|(c, own)| *c -= factor * own);
        }
    }
    false
}
