//! The wedges between a plane, a surface near it, and a face through which both leave a polyhedron.

use super::graph::Graph;
use super::polygon::Line;
use super::surplus::{Surplus, sum};
use wide::f64x4;

/// Four nodes of Gauss's quadrature in [-1, 1] and their weights: exact for polynomials of degree seven.
const NODES: [f64; 4] =
    [-0.861_136_311_594_052_6, -0.339_981_043_584_856_3, 0.339_981_043_584_856_3, 0.861_136_311_594_052_6];
const WEIGHTS: [f64; 4] =
    [0.347_854_845_137_453_85, 0.652_145_154_862_546_2, 0.652_145_154_862_546_2, 0.347_854_845_137_453_85];

/// The sides x = ±1 of the square.
const SIDES: [Line; 2] = [
    Line { slope: [1.0, 0.0], constant: 1.0, rise: 0.0 },
    Line { slope: [-1.0, 0.0], constant: 1.0, rise: 0.0 },
];

/// The line where a plane leaves through a face, seen along z, and the lines around it.
struct Edge<'a> {
    graph: &'a Graph,
    lines: &'a [Line],
    own: usize,
}

impl Surplus {
    /// Adds the correction for columns that end at the face of line `own`: columns where the face lies
    /// between the plane and the surface. `None` if the plane is nearly parallel to a neighbouring face.
    ///
    /// Let t be the distance from the plane up to the face, and τ the distance to the surface. These columns
    /// are those with t between 0 and τ. Their excess or deficit is ∫ |τ − t| dt = τ²/2, if τ does not depend
    /// on t.
    #[inline(always)]
    pub(super) fn add_wedge(&mut self, graph: &Graph, lines: &[Line], own: usize) -> Option<()> {
        let Line { slope: [sx, sy], constant, rise } = lines[own];
        if rise == 0.0 || constant.abs() - (sx.abs() + sy.abs()) > rise.abs() * graph.most {
            return Some(());
        }
        // x is the axis along which the distance from the face grows faster.
        if sx.abs() >= sy.abs() {
            return self.add(&Edge { graph, lines, own }, |x, y| (x, y));
        }
        let mut exchanged = [lines[own]; 4];
        for (to, from) in exchanged.iter_mut().zip(lines) {
            let [x, y] = from.slope;
            *to = Line { slope: [y, x], ..*from };
        }
        let graph = graph.exchanged();
        self.add(&Edge { graph: &graph, lines: &exchanged[..lines.len()], own }, |x, y| (y, x))
    }

    fn add(&mut self, edge: &Edge<'_>, order: impl Fn(f64x4, f64x4) -> (f64x4, f64x4)) -> Option<()> {
        let Edge { graph, lines, own } = *edge;
        let Line { slope: [sx, sy], constant, rise } = lines[own];
        // The change of x for a change in the distance from the face.
        let steep = rise.abs() / sx.abs();
        if steep.is_nan() || graph.most * steep > 1.0 {
            return None;
        }
        let [_, _, (low, high)] = edge.chords(graph.most * steep, graph.most);
        if low >= high {
            return Some(());
        }
        let x_at = |y: f64x4| (y * -sy - constant) * (1.0 / sx);
        // Bounds along the line, where v is quadratic and derivatives are linear.
        let y = f64x4::new([low, 0.5 * (low + high), high, high]);
        let at = graph.at(x_at(y), y);
        let [v0, v1, v2, _] = at.v.to_array();
        let v = v0.abs().max(v2.abs()).max((2.0 * v1 - 0.5 * (v0 + v2)).abs());
        let greatest = |lanes: f64x4| {
            let [a, _, _, b] = lanes.abs().to_array();
            a.max(b)
        };
        // The change of τ with t.
        let per = 1.0 / (1.0 - graph.steepest);
        let bend = 2.0 * graph.bends()[0].abs() * (graph.most * steep);
        let turn = graph.turn().abs();
        let change = ((greatest(graph.rise(x_at(y), y)) + bend) + turn * graph.most) * per * steep;
        if change.is_nan() || change > 0.75 {
            return None;
        }
        let spread = 1.0 / (1.0 - change);
        let most = graph.most.min((v * per + graph.rounding) * spread);
        let slope = (greatest(at.slope) + turn * (most * steep)) + 2.0 * graph.bend * most;
        let [inner, section, outer] = edge.chords(most * steep, most);
        if outer.0 >= outer.1 {
            return Some(());
        }
        let nodes = |(low, high): (f64, f64)| {
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            let y = f64x4::new(NODES) * half + middle;
            (x_at(y), y, f64x4::new(WEIGHTS) * half)
        };
        let (x, y, weight) = nodes(outer);
        let v = graph.at(x, y).v.abs() + graph.rounding;
        let all = sum(weight * v * v);
        // τ²/2 is at most this times v². (Weights may be greater than 1 beyond the cube.)
        let beyond = 1.0 + most;
        let full = 0.5 * steep * (per * per) * (beyond * beyond);
        if inner.0 >= inner.1 {
            self.error += full * spread * all;
            return Some(());
        }
        let (x, y, weight) = nodes(section);
        let v = graph.at(x, y).v;
        let one = weight * v * v * (if rise < 0.0 { -0.5 } else { 0.5 } * steep);
        let [a, b, c] = graph.plane;
        let z = -((x * a + y * b) + c);
        let (x, y) = order(x, y);
        let (vx, vy, vz) = (one * x, one * y, one * z);
        let terms = [one, vx, vy, vz, vx * x, vy * y, vz * z, vx * y, vx * z, vy * z];
        self.moments.iter_mut().zip(terms).for_each(|(moment, term)| *moment += sum(term));
        // At the ends, any part of the wedge may be present.
        let (x, y, weight) = nodes(inner);
        let v = graph.at(x, y).v;
        let ends = (all - sum(weight * v * v)).max(0.0);
        // Elsewhere τ changes with t, and differs from −v by the slope. Weights change by at most twice the
        // distances, whose mean is a third (and more along another plane).
        let reach = if own < 2 { steep.max(1.0) } else { 3.0 + 3.0 * steep };
        let weights = 2.0 / 3.0 * most * reach * (spread * spread);
        self.error += full * (spread * ends + (change * spread + 2.0 * slope + weights) * all);
        Some(())
    }
}

impl Edge<'_> {
    /// Ranges of y on the line: where the wedge certainly has its whole width, where the line bounds the
    /// section, and where there may be a part of the wedge, which extends by at most `dx` and `dz`.
    fn chords(&self, dx: f64, dz: f64) -> [(f64, f64); 3] {
        let mut ends = [(-1.0f64, 1.0f64); 3];
        let own = &self.lines[self.own];
        let others = self.lines.iter().enumerate().filter(|&(k, _)| k != self.own).map(|(_, line)| line);
        for other in others.chain(&SIDES) {
            // At x = −(constant + sy y) / sx.
            let per_x = other.slope[0] / own.slope[0];
            let slope = other.slope[1] - own.slope[1] * per_x;
            let constant = other.constant - own.constant * per_x;
            let margin = (other.slope[0].abs() * dx + other.rise.abs() * dz) + self.graph.rounding;
            for ((low, high), margin) in ends.iter_mut().zip([margin, 0.0, -margin]) {
                let need = margin - constant;
                if slope > 0.0 {
                    *low = low.max(need / slope);
                } else if slope < 0.0 {
                    *high = high.min(need / slope);
                } else if need > 0.0 {
                    *high = *low;
                }
            }
        }
        ends
    }
}
