//! The area of surfaces in a cube where several of them meet.
//!
//! A face is the part of a surface that lies within the half-spaces of the other surfaces. Its projection
//! along an axis is a convex figure in the plane, whose sides are known as slabs are.

use super::flux::{ROUNDING, area_of_surface};
use super::polygon::{Line, Polygon};
use super::quadratic::Quadratic;
use super::taylor::Taylor;
use crate::lattice::Each;
use crate::lattice::Interval;

/// Bounds of the area of the boundary of { x in the cell : all functions are ≥ 0 }, in squares of the half
/// edge.
pub(crate) fn area_of_faces(surfaces: &[Option<Taylor>; 3]) -> Interval {
    let mut sum = Interval::exactly(0.0);
    for (i, surface) in surfaces.iter().enumerate() {
        let Some(surface) = surface else { continue };
        let mut others = *surfaces;
        others[i] = None;
        let face = area_within(surface, core::iter::once(others));
        sum = Interval::between(sum.lower + face.lower, sum.upper + face.upper);
    }
    sum
}

/// Bounds of the area of a surface in regions that do not overlap. Each region is the set where the functions
/// of some other surfaces are ≥ 0.
pub(crate) fn area_within(surface: &Taylor, regions: impl Iterator<Item = [Option<Taylor>; 3]>) -> Interval {
    let own = area_of_surface(surface);
    let whole = Interval::between(0.0, own.upper);
    let is_known = |surface: &Taylor| surface.f.error < f64::INFINITY;
    let (mut lower, mut upper) = (0.0, 0.0);
    for others in regions {
        let face = if others.iter().flatten().next().is_none() {
            own
        } else if is_known(surface) && others.iter().flatten().all(is_known) {
            area_of_face(surface, others.iter().flatten()).unwrap_or(whole)
        } else {
            whole
        };
        (lower, upper) = (lower + face.lower.max(0.0), upper + face.upper);
    }
    let upper = whole.upper.min(upper);
    Interval::between(lower.clamp(0.0, upper), upper)
}

/// Bounds of the area of a surface within the half-spaces of others; `None` if it is no graph over a wall.
fn area_of_face<'a>(surface: &Taylor, others: impl Iterator<Item = &'a Taylor>) -> Option<Interval> {
    let f = &surface.f;
    let size = f.gradient.each(f64::abs);
    let axis = (0..3).fold(0, |most, axis| if size[axis] > size[most] { axis } else { most });
    let length = surface.steepness();
    let bend = surface.bend + 4.0 * f64::EPSILON * length;
    let is_graph = bend < 0.5 * size[axis];
    if !is_graph {
        return None;
    }
    // Above each point of the wall lies at most one point of the surface, near the zero of the linear
    // function. The greatest difference of f from that function is:
    let off = |f: &Quadratic| f.curvature() + f.error + 16.0 * f64::EPSILON * f.size();
    let axes = [(axis + 1) % 3, (axis + 2) % 3, axis];
    let [a, b, fall] = axes.each(|axis| f.gradient[axis]);
    let plane = [a / fall, b / fall, f.value / fall];
    let moved = off(f) / fall.abs();
    let (mut inner, mut outer) = (Polygon::SQUARE, Polygon::SQUARE);
    let mut clip = |line: Line, off: f64| {
        let Line { slope: [x, y], constant, .. } = line;
        let rounding = ROUNDING * ((constant.abs() + x.abs()) + y.abs());
        let margin = off * (1.0 + 8.0 * f64::EPSILON) + rounding;
        inner.clip(&Line { constant: constant - margin, ..line })?;
        outer.clip(&Line { constant: constant + margin, ..line })
    };
    for side in [1.0, -1.0] {
        clip(Line::new(&[0, 1, 2], &plane, &[0.0, 0.0, side], 1.0), moved)?;
    }
    for Taylor { f: other, .. } in others {
        let line = Line::new(&axes, &plane, &other.gradient.each(|c| -c), other.value);
        let rise = line.rise.abs();
        let terms = rise * plane.iter().map(|c| c.abs()).sum::<f64>();
        clip(line, off(other) + rise * moved + 16.0 * f64::EPSILON * terms)?;
    }
    let steepest = ((length + bend) / (size[axis] - bend)) * (1.0 + 8.0 * f64::EPSILON);
    let flattest = ((length - bend) / (size[axis] + bend)) * (1.0 - 8.0 * f64::EPSILON);
    Interval::new((inner.area() - ROUNDING) * flattest.max(1.0), (outer.area() + ROUNDING) * steepest)
}
