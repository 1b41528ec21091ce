//! The surfaces that bound a solid, as functions on the lattice of a boundary evaluation.
//!
//! Points are in unit coordinates: the universe is [0, 1]³. Which side of a surface a corner of the lattice
//! lies on is an exact sign. Places are found in plain doubles, to the last digits: nothing is decided by
//! them but the order of places.

use crate::cut::{Quadratic, Taylor};
use crate::error::Error;
use crate::lattice::exact::sqrt;
use crate::lattice::{Cell, Frame, axes};
use crate::memory;
use crate::solid::PlacedHalfSpace;
use crate::solid::half_space::Placed;
use alloc::vec::Vec;

/// How a surface is curved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    Plane,
    /// Along one direction at each point, as a cylinder or a cone.
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

/// A cylinder or a cone has a determinant that is no greater part than this of the product that it is a sum
/// of.
const SINGULAR: f64 = 1e-9;

/// Half the edge of a cube in which a function is known well enough for its value and its gradient at the
/// centre: a power of two.
const NEAR: f64 = 1.0 / (1u64 << 24) as f64;

/// Steps of Newton's method.
const STEPS: usize = 24;

/// Steps along an edge.
const HALVINGS: usize = 80;

/// Of a host program's function no gradient is known.
pub(super) const UNKNOWN: Error =
    Error::Argument { name: "solid", problem: "must consist of surfaces that are known" };

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

    /// Whether a point lies on the positive side of a surface. A point on it is taken as a point a little
    /// further along x, y and z.
    pub(super) fn is_positive(&self, surface: u32, at: [f64; 3]) -> Result<bool, Error> {
        let placed = &self.list[surface as usize].placed;
        if !matches!(placed, Placed::Slab(_))
            && let Some(side) = placed.contains_off_lattice(at)?
        {
            return Ok(side);
        }
        // Within the width of a plane its middle counts.
        Ok(self.about(surface, at).0 >= 0.0)
    }

    /// What is known of a surface's function in a cell.
    pub(super) fn taylor(&self, surface: u32, cell: Cell) -> Option<Taylor> {
        let half = 0.5 / f64::from(1u32 << cell.level);
        let centre = cell.at.map(|at| (2.0 * f64::from(at) + 1.0) * half);
        self.over(surface, centre, half)
    }

    fn over(&self, surface: u32, centre: [f64; 3], half: f64) -> Option<Taylor> {
        Some(self.near(surface, centre, half)?.0)
    }

    /// What is known of a surface's function in a cube, by how much the surface may differ from where that is
    /// 0, and whether the terms are all that the function has.
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
            Some(taylor) => (taylor.f.value, taylor.f.gradient.map(|c| c / NEAR)),
            None => (0.0, [0.0; 3]),
        }
    }

    /// About how far a point is from a surface.
    pub(super) fn distance(&self, surface: u32, at: [f64; 3]) -> f64 {
        let (value, gradient) = self.about(surface, at);
        let away = value.abs() / length(gradient);
        if away.is_finite() { away } else { 0.0 }
    }

    /// Where a segment along an axis, whose ends lie on different sides of a surface, meets it.
    pub(super) fn on_edge(&self, surface: u32, axis: usize, from: [f64; 3], to: f64) -> f64 {
        let at = |x: f64| {
            let mut point = from;
            point[axis] = x;
            let (value, gradient) = self.about(surface, point);
            (value, gradient[axis])
        };
        let (mut low, mut high) = (from[axis], to);
        let (first, last) = (at(low).0, at(high).0);
        // (Next to a corner, rounding may show both ends on one side.)
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

    /// A point next to another one on up to three surfaces, which keeps a coordinate if that is said: by
    /// steps that are as short as they can be. Nothing if there is none.
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
                (rows[k], values[k]) = (gradient.map(|c| c / size), value / size);
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

/// The shortest vector whose products with up to three unit vectors are `values`.
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
            // Of three, the vector itself by Cramer's rule.
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

/// Whether the surface of a polynomial of degree two is a cylinder or a cone: whether its matrix of four rows
/// is singular.
fn is_ruled(f: &Quadratic) -> bool {
    let ([x, y, z], [xx, yy, zz, xy, xz, yz]) = (f.gradient.map(|c| 0.5 * c), f.squares);
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
