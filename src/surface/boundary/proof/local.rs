//! Expansions of a surface's function around a place.

use super::super::figures::{Figures, dot, length, middle, minus};
use crate::lattice::Each;
use crate::lattice::axes;

/// The rounding error, as a part of all terms.
const ROUNDING: f64 = 1e-14;

/// The margin beside a triangle, as a part of its sides, within which a place counts as inside: rounding must
/// not lose it between two triangles.
const BESIDE: f64 = 1e-6;

/// A function within a cube: value + gradient · x + xᵀ squares x, where x is measured from the centre in
/// edges of the universe.
#[derive(Debug, Clone, Copy)]
pub(super) struct Local {
    centre: [f64; 3],
    value: f64,
    gradient: [f64; 3],
    /// A symmetric matrix.
    squares: [[f64; 3]; 3],
    /// The greatest difference of the function from the expansion. (Between two planes all functions count as
    /// one.)
    error: f64,
    /// Whether the terms are the function's own, so that gradients follow from them.
    is_polynomial: bool,
    /// Whether there are no second-order terms.
    is_flat: bool,
    /// The greatest difference of a gradient in the cube from the gradient at the centre.
    bend: f64,
}

/// A box of any orientation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Prism {
    pub(super) centre: [f64; 3],
    /// Unit vectors at right angles. The last one is approximately normal to the surface.
    pub(super) axes: [[f64; 3]; 3],
    pub(super) half: [f64; 3],
}

impl Prism {
    /// The extent along a direction, from the centre.
    pub(super) fn along(&self, direction: [f64; 3]) -> f64 {
        (0..3).map(|i| self.half[i] * dot(self.axes[i], direction).abs()).sum()
    }

    /// The extent along x, y and z, from the centre.
    pub(super) fn reach(&self) -> [f64; 3] {
        axes(|k| (0..3).map(|i| self.half[i] * self.axes[i][k].abs()).sum())
    }

    /// The point at a place in the box's coordinates.
    pub(super) fn point(&self, place: [f64; 3]) -> [f64; 3] {
        axes(|k| self.centre[k] + (0..3).map(|i| place[i] * self.axes[i][k]).sum::<f64>())
    }

    /// The place of a point along the axes, from the centre.
    pub(super) fn place(&self, point: [f64; 3]) -> [f64; 3] {
        let away = minus(point, self.centre);
        axes(|i| dot(away, self.axes[i]))
    }
}

impl Local {
    /// The expansion within `reach` of a point along each axis; `None` if nothing is known.
    pub(super) fn new(figures: &Figures, surface: u32, centre: [f64; 3], reach: f64) -> Option<Local> {
        let (taylor, width, is_polynomial) = figures.near(surface, centre, reach)?;
        let f = taylor.f;
        let [xx, yy, zz, xy, xz, yz] = f.squares.each(|c| c / (reach * reach));
        let local = Local {
            centre,
            value: f.value,
            gradient: f.gradient.each(|c| c / reach),
            squares: [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]],
            error: f.error + width + ROUNDING * f.size(),
            is_polynomial,
            is_flat: f.squares == [0.0; 6],
            bend: taylor.bend / reach,
        };
        (local.error.is_finite() && local.steepness() > 0.0).then_some(local)
    }

    /// The function times a sign, minus another one times a factor.
    pub(super) fn combined(&self, sign: f64, factor: f64, other: &Local) -> Local {
        Local {
            centre: self.centre,
            value: sign * self.value - factor * other.value,
            gradient: axes(|k| sign * self.gradient[k] - factor * other.gradient[k]),
            squares: axes(|i| axes(|k| sign * self.squares[i][k] - factor * other.squares[i][k])),
            error: self.error + factor.abs() * other.error,
            is_polynomial: self.is_polynomial && other.is_polynomial,
            is_flat: self.is_flat && other.is_flat,
            bend: self.bend + factor.abs() * other.bend,
        }
    }

    pub(super) fn gradient(&self) -> [f64; 3] {
        self.gradient
    }

    pub(super) fn error(&self) -> f64 {
        self.error
    }

    /// The length of the gradient at the centre.
    pub(super) fn steepness(&self) -> f64 {
        length(self.gradient)
    }

    /// The length of the gradient at a point, up to the error.
    pub(super) fn steepness_at(&self, point: [f64; 3]) -> f64 {
        let x = minus(point, self.centre);
        length(axes(|k| self.gradient[k] + 2.0 * dot(self.squares[k], x)))
    }

    /// The second-order product of two vectors.
    pub(super) fn second(&self, a: [f64; 3], b: [f64; 3]) -> f64 {
        let rows: [f64; 3] = axes(|i| dot(self.squares[i], b));
        dot(a, rows)
    }

    fn at(&self, point: [f64; 3]) -> f64 {
        let x = minus(point, self.centre);
        self.value + dot(self.gradient, x) + self.second(x, x)
    }

    /// The least and the greatest value on the convex hull of points in a plane, given in order around it.
    pub(super) fn over(&self, corners: &[[f64; 3]]) -> [f64; 2] {
        let mut range = Range::NONE;
        if self.is_flat {
            corners
                .iter()
                .for_each(|&corner| range.add(self.value + dot(self.gradient, minus(corner, self.centre))));
        } else if let Some(&last) = corners.last() {
            let mut from = (last, self.at(last));
            for &corner in corners {
                let to = (corner, self.at(corner));
                range.add(to.1);
                self.along_side(from, to, &mut range);
                from = to;
            }
            for k in 1..corners.len().saturating_sub(1) {
                self.inside_triangle([corners[0], corners[k], corners[k + 1]], &mut range);
            }
        }
        [range.0[0] - self.error, range.0[1] + self.error]
    }

    /// Adds the values between the ends of a side, whose values are given.
    fn along_side(&self, (a, first): ([f64; 3], f64), (b, last): ([f64; 3], f64), range: &mut Range) {
        let half = self.at(middle(a, b));
        // The parabola through the three values.
        let (slope, bent) = (4.0 * half - 3.0 * first - last, 2.0 * (first + last - 2.0 * half));
        let place = -slope / (2.0 * bent);
        if 0.0 < place && place < 1.0 {
            range.add(first + 0.5 * place * slope);
        }
    }

    /// Adds the value at a stationary point within a triangle or a little beside it.
    fn inside_triangle(&self, [a, b, c]: [[f64; 3]; 3], range: &mut Range) {
        let (u, v, from) = (minus(b, a), minus(c, a), minus(a, self.centre));
        let slope = |d: [f64; 3]| dot(self.gradient, d) + 2.0 * self.second(from, d);
        let (uu, uv, vv) = (2.0 * self.second(u, u), 2.0 * self.second(u, v), 2.0 * self.second(v, v));
        let (su, sv, determinant) = (slope(u), slope(v), uu * vv - uv * uv);
        let (x, y) = ((uv * sv - vv * su) / determinant, (uv * su - uu * sv) / determinant);
        if x > -BESIDE && y > -BESIDE && x + y < 1.0 + BESIDE {
            range.add(self.at(a) + 0.5 * (x * su + y * sv));
        }
    }

    /// The least and the greatest value in a box around the centre.
    pub(super) fn within(&self, prism: &Prism) -> [f64; 2] {
        let mut most = prism.along(self.gradient) + self.error;
        for i in 0..3 {
            for k in 0..3 {
                most += self.second(prism.axes[i], prism.axes[k]).abs() * prism.half[i] * prism.half[k];
            }
        }
        [self.value - most, self.value + most]
    }

    /// The least and the greatest derivative along a direction in a box around the centre.
    pub(super) fn slopes(&self, direction: [f64; 3], prism: &Prism) -> [f64; 2] {
        let middle = dot(self.gradient, direction);
        let most = if self.is_polynomial {
            2.0 * (0..3).map(|i| self.second(direction, prism.axes[i]).abs() * prism.half[i]).sum::<f64>()
        } else {
            self.bend * length(direction)
        };
        let most = most + ROUNDING * self.steepness();
        [middle - most, middle + most]
    }
}

/// The values from the first to the last.
struct Range([f64; 2]);

impl Range {
    const NONE: Range = Range([f64::INFINITY, f64::NEG_INFINITY]);

    fn add(&mut self, value: f64) {
        self.0 = [self.0[0].min(value), self.0[1].max(value)];
    }
}

/// The greatest magnitude in a range.
pub(super) fn magnitude([low, high]: [f64; 2]) -> f64 {
    high.max(-low)
}
