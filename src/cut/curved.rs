//! A cube that one curved surface and up to two planes cut: moments to third order.
//!
//! In the cell the function is f = c + g · x + xᵀ Q x, and Q is small compared with g. So the surface is a
//! graph z*(x, y) along the axis z with the greatest component of g. A plane z₀(x, y) near the surface cuts
//! off a polyhedron with known moments. The rest lies between plane and surface. It consists of the integral
//! over the plane's section of each column between them, and of wedges along the section's outline, where
//! columns end at other faces. Both are computed to second order in z* − z₀, and the remainder is bounded.

use super::graph::Graph;
use super::polygon::{Line, Polygon};
use super::quadratic::Quadratic;
use super::surplus::Surplus;
use super::{ERROR, Half};
use crate::lattice::{CellMoments, CubeMoments, PAIRS, PLACES};

/// Returns the moments of { x in [-1, 1]³ : f(x) ≥ 0 } on the inner sides of up to two planes; `None` if they
/// are not known to third order. `flat` returns the moments with a further plane in place of f.
#[inline(always)]
pub(super) fn moments(
    f: &Quadratic,
    planes: &[Half],
    flat: impl Fn(&Half) -> Option<CubeMoments>,
) -> Option<CellMoments> {
    // The faces across z, and the planes.
    let face = |k: usize| match k {
        0 => ([0.0, 0.0, 1.0], 1.0),
        1 => ([0.0, 0.0, -1.0], 1.0),
        _ => (planes[k - 2].normal, planes[k - 2].offset),
    };
    let count = 2 + planes.len();
    let line = |axes: &[usize; 3], plane: &[f64; 3], k: usize| {
        let (normal, offset) = face(k);
        let axes = if k < 2 { &[0, 1, 2] } else { axes };
        Line::new(axes, plane, &normal, offset)
    };
    let section =
        |axes: &[usize; 3], plane: &[f64; 3]| Polygon::new((0..count).map(|k| line(axes, plane, k)));
    let graph = Graph::new(f, section)?;
    let Graph { axes, plane, .. } = graph;
    let mut lines = [Line { slope: [0.0; 2], constant: 1.0, rise: 0.0 }; 4];
    lines[..count].iter_mut().enumerate().for_each(|(k, own)| *own = line(&axes, &plane, k));
    let lines = &lines[..count];
    let polygon = Polygon::new(lines.iter().copied())?;
    let mut surplus = Surplus::over(&polygon, &graph);
    for k in 0..count {
        surplus.add_wedge(&graph, lines, k)?;
    }
    let [a, b, c] = plane;
    let sign = if graph.scale > 0.0 { 1.0 } else { -1.0 };
    let per = sign / (1.0 + (a.abs() + b.abs()));
    let mut half = Half { normal: [0.0; 3], offset: per * c };
    for (axis, n) in axes.into_iter().zip([a, b, 1.0]) {
        half.normal[axis] = -per * n;
    }
    let mut moments = flat(&half)?;
    let [volume, first @ .., xx, yy, zz, xy, xz, yz] = surplus.moments;
    moments.volume += sign * volume;
    for (axis, more) in axes.into_iter().zip(first) {
        moments.first[axis] += sign * more;
    }
    for ((i, j), more) in PAIRS.into_iter().zip([xx, yy, zz, xy, xz, yz]) {
        moments.second[PLACES[axes[i]][axes[j]]] += sign * more;
    }
    // The error of the function moves the surface by this much along z. If that is little, a weight has one
    // sign in the affected part of a column, or is small.
    let moved = f.error / (graph.scale.abs() * (1.0 - graph.steepest));
    if moved.is_nan() || moved > 0.125 {
        return None;
    }
    // (The sums were rounded, too.)
    let error = (surplus.error + 4.0 * moved) * (1.0 + 1e-9) + 16.0 * graph.rounding + ERROR;
    Some(CellMoments { moments, error })
}
