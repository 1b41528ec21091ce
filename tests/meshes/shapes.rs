//! Closed meshes of many kinds, as triangle soups.

// Each test program uses its own part of this.
#![allow(dead_code)]

use leafless::TriangleMesh;
use leafless_testkit::Random;

pub type Soup = Vec<[[f64; 3]; 3]>;

pub fn mesh(soup: &Soup) -> TriangleMesh {
    TriangleMesh::from_facets(soup).unwrap()
}

/// A block with outward faces, if min < max on every axis.
pub fn block(min: [f64; 3], max: [f64; 3]) -> Soup {
    let corner = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 != 0 { max[axis] } else { min[axis] });
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let quads = faces.iter().map(|face| face.map(corner));
    quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect()
}

/// A tetrahedron with outward faces for any order of the corners. Flat tetrahedra have no defined
/// orientation.
pub fn tetrahedron(corners: [[f64; 3]; 4]) -> Soup {
    let [a, b, c, d] = corners;
    let edge = |to: [f64; 3]| [0, 1, 2].map(|i| to[i] - a[i]);
    let (p, q, r) = (edge(b), edge(c), edge(d));
    let volume = p[0] * (q[1] * r[2] - q[2] * r[1])
        + p[1] * (q[2] * r[0] - q[0] * r[2])
        + p[2] * (q[0] * r[1] - q[1] * r[0]);
    let (b, c) = if volume < 0.0 { (c, b) } else { (b, c) };
    vec![[a, c, b], [a, b, d], [b, c, d], [c, a, d]]
}

/// An octahedron: |x − c| + |y − c| + |z − c| ≤ r.
pub fn octahedron(centre: [f64; 3], radius: f64) -> Soup {
    let tip = |axis: usize, sign: f64| {
        let mut tip = centre;
        tip[axis] += sign * radius;
        tip
    };
    (0..8)
        .map(|octant| {
            let [a, b, c] = [0, 1, 2].map(|axis| tip(axis, if octant >> axis & 1 != 0 { 1.0 } else { -1.0 }));
            if (octant as u32).count_ones() % 2 == 1 { [a, b, c] } else { [a, c, b] }
        })
        .collect()
}

/// A prism over a counter-clockwise polygon around `centre`, from z = low to high. Every edge of the polygon
/// sees `centre` on its left.
pub fn prism(polygon: &[[f64; 2]], centre: [f64; 2], low: f64, high: f64) -> Soup {
    let mut soup = Soup::new();
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let at = |p: [f64; 2], z: f64| [p[0], p[1], z];
        soup.push([at(centre, high), at(a, high), at(b, high)]);
        soup.push([at(centre, low), at(b, low), at(a, low)]);
        soup.push([at(a, low), at(b, low), at(b, high)]);
        soup.push([at(a, low), at(b, high), at(a, high)]);
    }
    soup
}

/// A torus around z.
pub fn torus(centre: [f64; 3], major: f64, minor: f64, around: usize, across: usize) -> Soup {
    let at = |i: usize, j: usize| {
        let (u, v) = (
            (i % around) as f64 / around as f64 * std::f64::consts::TAU,
            (j % across) as f64 / across as f64 * std::f64::consts::TAU,
        );
        let r = major + minor * v.cos();
        [centre[0] + r * u.cos(), centre[1] + r * u.sin(), centre[2] + minor * v.sin()]
    };
    let mut soup = Soup::new();
    for i in 0..around {
        for j in 0..across {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            soup.extend([[a, b, c], [a, c, d]]);
        }
    }
    soup
}

pub fn inside_out(soup: Soup) -> Soup {
    soup.into_iter().map(|[a, b, c]| [a, c, b]).collect()
}

pub fn moved(soup: &Soup, f: impl Fn([f64; 3]) -> [f64; 3]) -> Soup {
    soup.iter().map(|facet| facet.map(&f)).collect()
}

/// Closed tetrahedra with random corners.
pub fn tetrahedra(
    random: &mut Random,
    count: usize,
    mut corner: impl FnMut(&mut Random) -> [f64; 3],
) -> Soup {
    (0..count)
        .flat_map(|_| {
            let corners = [0; 4].map(|_: i32| corner(random));
            let mut soup = tetrahedron(corners);
            if random.below(4) == 0 {
                soup = inside_out(soup);
            }
            soup
        })
        .collect()
}
