//! The region between a plane and a surface near it, in columns across the plane.

use super::graph::Graph;
use super::polygon::Polygon;
use crate::lattice::Each;
use wide::f64x4;

/// Nodes and weights of a quadrature over a triangle, exact for polynomials of degree five (Radon, 1948): the
/// centroid, and points on the medians, each given by the share of two corners.
const CENTROID: f64 = 0.225;
const MEDIANS: [(f64, f64); 2] = [
    (0.101_286_507_323_456_34, 0.125_939_180_544_827_16),
    (0.470_142_064_105_115_1, 0.132_394_152_788_506_17),
];

/// The moments of the points above a surface, minus those of the points above a plane.
pub(super) struct Surplus {
    /// The integrals of 1, x, y, z, xx, yy, zz, xy, xz, yz.
    pub(super) moments: [f64; 10],
    /// A bound of the error of each moment.
    pub(super) error: f64,
}

impl Surplus {
    /// The surplus in the columns that meet the plane in the cube, as if the columns did not end at faces.
    ///
    /// The surface is at z₀ + τ, where τ = −v to first order, −v (1 − slope) to second. The integral of a
    /// weight w from z₀ to the surface is w τ + w' τ²/2 + w'' τ³/6.
    #[inline(always)]
    pub(super) fn over(polygon: &Polygon, graph: &Graph) -> Surplus {
        let corners = polygon.corners();
        if corners.len() < 3 {
            return Surplus { moments: [0.0; 10], error: 0.0 };
        }
        let [a, b, c] = graph.plane;
        // ∫ −τ times 1, x, y, xx, yy, xy; ∫ v² times 1, x, y; the area.
        let mut lanes = [f64x4::ZERO; 10];
        let (x0, y0) = (f64x4::splat(corners[0][0]), f64x4::splat(corners[0][1]));
        // Triangles from the first corner, four at a time.
        let mut k = 2;
        while k < corners.len() {
            let corner = |offset: usize, axis: usize| {
                let at = |lane: usize| {
                    let i = k + lane;
                    corners[if i < corners.len() { i - offset } else { 0 }][axis]
                };
                f64x4::new([at(0), at(1), at(2), at(3)])
            };
            let (x1, y1, x2, y2) = (corner(1, 0), corner(1, 1), corner(0, 0), corner(0, 1));
            let area = ((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)) * 0.5;
            let (sum_x, sum_y) = ((x0 + x1) + x2, (y0 + y1) + y2);
            let mut add = |x: f64x4, y: f64x4, weight: f64| {
                let at = graph.at(x, y);
                let first = at.v * (area * weight);
                let one = first - first * at.slope;
                let square = first * at.v;
                let (vx, vy) = (one * x, one * y);
                let terms = [one, vx, vy, vx * x, vy * y, vx * y, square, square * x, square * y];
                lanes.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
            };
            add(sum_x * (1.0 / 3.0), sum_y * (1.0 / 3.0), CENTROID);
            for (node, weight) in MEDIANS {
                let own = 1.0 - 3.0 * node;
                for (x, y) in [(x0, y0), (x1, y1), (x2, y2)] {
                    add(sum_x * node + x * own, sum_y * node + y * own, weight);
                }
            }
            lanes[9] += area;
            k += 4;
        }
        let [one, x, y, xx, yy, xy, square, square_x, square_y, area] = lanes.each(sum);
        // On the plane, z is a linear function of x and y.
        let z = |one: f64, x: f64, y: f64| -((a * x + b * y) + c * one);
        let (xz, yz) = (z(x, xx, xy), z(y, xy, yy));
        let moments = [
            one,
            x,
            y,
            z(one, x, y) - 0.5 * square,
            xx,
            yy,
            z(z(one, x, y), xz, yz) - z(square, square_x, square_y),
            xy,
            xz - 0.5 * square_x,
            yz - 0.5 * square_y,
        ];
        Surplus { moments, error: Surplus::error(polygon, graph, square.max(0.0), area.max(0.0)) }
    }

    /// A bound of the error. With D the greatest distance, d the local one and r a bound of R's derivative
    /// along z, the error of τ is at most r² d + (1 + r) bend d². With weights of at most 1, whose
    /// derivatives are at most 2, the integral has a further error of 2 r d² + d³/3.
    fn error(polygon: &Polygon, graph: &Graph, square: f64, area: f64) -> f64 {
        let (mut v, mut slope) = (0.0f64, 0.0f64);
        for &[x, y] in polygon.corners() {
            let at = graph.at(f64x4::splat(x), f64x4::splat(y));
            v = v.max(at.v.to_array()[0].abs());
            slope = slope.max(at.slope.to_array()[0].abs());
        }
        // Between corners v differs from a linear function by its second derivatives.
        let [low, high] = polygon.bounds();
        let [wx, wy] = [0, 1].each(|i| 0.5 * (high[i] - low[i]));
        let [xx, yy, xy] = graph.bends().each(f64::abs);
        let v = v + ((xx * wx * wx + yy * wy * wy) + xy * wx * wy);
        let most = graph.most.min(v / (1.0 - graph.steepest) + graph.rounding);
        let r = graph.steepest.min(slope + 2.0 * graph.bend * most);
        let per = 1.0 / (1.0 - r);
        // ∫ |v| is at most the root of ∫ 1 ∫ v².
        r * r * per * libm::sqrt(area * square)
            + ((1.0 + r) * graph.bend + 2.0 * r + most / 3.0) * (per * per) * square
    }
}

/// The sum of four numbers.
#[inline(always)]
pub(super) fn sum(lanes: f64x4) -> f64 {
    let [a, b, c, d] = lanes.to_array();
    (a + b) + (c + d)
}
