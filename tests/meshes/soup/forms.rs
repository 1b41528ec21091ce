//! Shapes to be damaged, and shapes that are open by themselves. Raising `detail` by one doubles the number
//! of facets in each direction.

use crate::shapes::*;
use leafless_testkit::Random;
use std::f64::consts::{PI, TAU};

/// Cuts every facet into four at the middles of its edges, `times` over. The result is exact for corners with
/// short numbers.
pub fn refined(soup: &Soup, times: usize) -> Soup {
    let middle = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|axis| (a[axis] + b[axis]) / 2.0);
    let cut = |&[a, b, c]: &[[f64; 3]; 3]| {
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    };
    (0..times).fold(soup.clone(), |soup, _| soup.iter().flat_map(cut).collect())
}

/// A ball of 8·4^times facets.
pub fn sphere(centre: [f64; 3], radius: f64, times: usize) -> Soup {
    // Middles are put onto the sphere at once, so that neighbours agree on them.
    let onto = |p: [f64; 3]| {
        let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        p.map(|x| x / length)
    };
    let unit = (0..times).fold(octahedron([0.0; 3], 1.0), |soup, _| moved(&refined(&soup, 1), onto));
    moved(&unit, |p| [0, 1, 2].map(|axis| centre[axis] + radius * p[axis]))
}

/// A prism over an L-shape of three unit squares, scaled by `scale`.
pub fn ell(corner: [f64; 3], scale: f64, height: f64) -> Soup {
    let polygon = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let at = |[x, y]: [f64; 2]| [corner[0] + scale * x, corner[1] + scale * y];
    prism(&polygon.map(at), at([0.5, 0.5]), corner[2], corner[2] + height)
}

/// A block from `low` to `high` with a square hole along z. The hole is `margin` away from the block's four
/// sides.
pub fn tube(low: [f64; 3], high: [f64; 3], margin: f64) -> Soup {
    let ring = |inset: f64| {
        let (x, y) = ([low[0] + inset, high[0] - inset], [low[1] + inset, high[1] - inset]);
        [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]
    };
    let (outer, inner) = (ring(0.0), ring(margin));
    let mut soup = Soup::new();
    let mut quad = |a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]| soup.extend([[a, b, c], [a, c, d]]);
    for i in 0..4 {
        let j = (i + 1) % 4;
        let at = |p: [f64; 2], z: f64| [p[0], p[1], z];
        let (bottom, top) = (low[2], high[2]);
        quad(at(outer[i], top), at(outer[j], top), at(inner[j], top), at(inner[i], top));
        quad(at(inner[i], bottom), at(inner[j], bottom), at(outer[j], bottom), at(outer[i], bottom));
        quad(at(outer[i], bottom), at(outer[j], bottom), at(outer[j], top), at(outer[i], top));
        quad(at(inner[j], bottom), at(inner[i], bottom), at(inner[i], top), at(inner[j], top));
    }
    soup
}

/// Triangles over a grid of `n` × `m` quadrangles; `at` has parameters from 0 to 1.
fn grid(n: usize, m: usize, at: impl Fn(f64, f64) -> [f64; 3]) -> Soup {
    let at = |i: usize, j: usize| at(i as f64 / n as f64, j as f64 / m as f64);
    let quads = (0..n).flat_map(|i| (0..m).map(move |j| (i, j)));
    quads
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

/// A wavy sheet without thickness.
pub fn sheet(centre: [f64; 3], size: f64, wave: f64, detail: usize) -> Soup {
    grid(6 << detail, 6 << detail, |u, v| {
        let height = wave * ((TAU * u).sin() + (2.0 * TAU * v).cos());
        [centre[0] + size * (u - 0.5), centre[1] + size * (v - 0.5), centre[2] + height]
    })
}

/// A Möbius strip. No orientation is consistent across its seam.
pub fn moebius(centre: [f64; 3], radius: f64, width: f64, detail: usize) -> Soup {
    grid(24 << detail, 4, |u, v| {
        // The last row of vertices is the first row reversed, to the bit.
        let (u, v) = if u == 1.0 { (0.0, 1.0 - v) } else { (u, v) };
        let (turn, side) = (TAU * u, (v - 0.5) * width);
        let r = radius + side * (turn / 2.0).cos();
        [centre[0] + r * turn.cos(), centre[1] + r * turn.sin(), centre[2] + side * (turn / 2.0).sin()]
    })
}

/// A Klein bottle as a twisted figure of eight. It is closed, intersects itself, and has no consistent
/// orientation.
pub fn klein(centre: [f64; 3], radius: f64, detail: usize) -> Soup {
    // The parameters are dyadic, so that the seams meet to the bit.
    grid(16 << detail, 8 << detail, |u, v| {
        let v = if v == 1.0 { 0.0 } else { v };
        let (u, v) = if u == 1.0 { (0.0, if v == 0.0 { 0.0 } else { 1.0 - v }) } else { (u, v) };
        let (turn, around) = (TAU * u, TAU * v);
        let (sine, double) = (around.sin(), (2.0 * around).sin());
        let r = radius * (1.0 + 0.4 * ((turn / 2.0).cos() * sine - (turn / 2.0).sin() * double));
        let z = radius * 0.4 * ((turn / 2.0).sin() * sine + (turn / 2.0).cos() * double);
        [centre[0] + r * turn.cos(), centre[1] + r * turn.sin(), centre[2] + z]
    })
}

/// Half a ball without a lid.
pub fn bowl(centre: [f64; 3], radius: f64, times: usize) -> Soup {
    let whole = sphere([0.0; 3], radius, times);
    let lower = whole.into_iter().filter(|facet| facet.iter().all(|p| p[2] <= 1e-12 * radius)).collect();
    moved(&lower, |p| [0, 1, 2].map(|axis| centre[axis] + p[axis]))
}

/// A band that winds around its axis several times. The winding number inside is large, and fractional nearly
/// everywhere.
pub fn spiral(centre: [f64; 3], radius: f64, turns: f64, height: f64, detail: usize) -> Soup {
    grid(36 << detail, 4, |u, v| {
        let angle = TAU * turns * u;
        let r = radius * (0.4 + 0.6 * u);
        [centre[0] + r * angle.cos(), centre[1] + r * angle.sin(), centre[2] + height * (v - 0.5)]
    })
}

/// A pipe without ends.
pub fn pipe(centre: [f64; 3], radius: f64, height: f64, detail: usize) -> Soup {
    grid(12 << detail, 3 << detail, |u, v| {
        let angle = if u == 1.0 { 0.0 } else { TAU * u };
        [centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin(), centre[2] + height * (v - 0.5)]
    })
}

/// Unrelated triangles.
pub fn rubble(random: &mut Random, count: usize, low: f64, high: f64) -> Soup {
    let mut corner = || [0; 3].map(|_: i32| random.between(low, high));
    (0..count).map(|_| [corner(), corner(), corner()]).collect()
}

/// Unrelated triangles with corners on the lattice's planes and centres.
pub fn lattice_rubble(random: &mut Random, count: usize, cells: u64) -> Soup {
    let mut corner = || [0; 3].map(|_: i32| random.below(2 * cells + 1) as f64 / 2.0);
    (0..count).map(|_| [corner(), corner(), corner()]).collect()
}

/// Rotates a soup around the origin by an angle that fits no lattice.
pub fn turned(soup: &Soup) -> Soup {
    let (s, c) = (PI / 5.0).sin_cos();
    let (t, d) = 0.6f64.sin_cos();
    moved(soup, |[x, y, z]| {
        let (x, y) = (c * x - s * y, s * x + c * y);
        [d * x + t * z, y, d * z - t * x]
    })
}
