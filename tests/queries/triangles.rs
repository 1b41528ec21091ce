//! The first triangle that a ray meets, in doubles with error bounds.

use leafless::{Interval, TriangleMesh};

/// A bound of the accumulated relative error of the products and sums here. The error of each is 2^-53.
const ERROR: f64 = 1e-14;
/// The number of triangles that are not divided further.
const FEW: usize = 4;

struct Bounds {
    min: [f64; 3],
    max: [f64; 3],
}

impl Bounds {
    fn of(triangles: &[[[f64; 3]; 3]]) -> Bounds {
        let corners = || triangles.iter().flatten();
        let fold = |axis: usize, f: fn(f64, f64) -> f64, start| corners().map(|c| c[axis]).fold(start, f);
        Bounds {
            min: [0, 1, 2].map(|axis| fold(axis, f64::min, f64::INFINITY)),
            max: [0, 1, 2].map(|axis| fold(axis, f64::max, f64::NEG_INFINITY)),
        }
    }

    /// Returns the time range in which a ray may be in the box, slightly too wide.
    fn stay(&self, from: [f64; 3], direction: [f64; 3]) -> Option<[f64; 2]> {
        let mut stay = [0.0, f64::INFINITY];
        for axis in 0..3 {
            let margin = ERROR * (from[axis].abs() + self.min[axis].abs() + self.max[axis].abs());
            let (low, high) = (self.min[axis] - margin, self.max[axis] + margin);
            if direction[axis] == 0.0 {
                if from[axis] < low || from[axis] > high {
                    return None;
                }
                continue;
            }
            let [a, b] = [low, high].map(|plane| (plane - from[axis]) / direction[axis]);
            let (near, far) = (a.min(b), a.max(b));
            stay = [f64::max(stay[0], near - ERROR * near.abs()), f64::min(stay[1], far + ERROR * far.abs())];
        }
        (stay[0] <= stay[1]).then_some(stay)
    }
}

enum Tree {
    Leaf(Bounds, Vec<[[f64; 3]; 3]>),
    Node(Bounds, Box<[Tree; 2]>),
}

/// Triangles in a tree of boxes.
pub struct Triangles(Tree);

impl Triangles {
    pub fn new(mesh: &TriangleMesh) -> Triangles {
        let vertices = mesh.vertices();
        let corners = |t: &[u32; 3]| t.map(|v| vertices[v as usize]);
        Triangles(divided(mesh.triangles().iter().map(corners).collect()))
    }

    /// Returns an interval that contains the least t at which the ray meets a triangle: ∞ if it may miss all
    /// triangles.
    pub fn first_hit(&self, from: [f64; 3], direction: [f64; 3]) -> Interval {
        let mut first = Interval::new(f64::INFINITY, f64::INFINITY).unwrap();
        search(&self.0, from, direction, &mut first);
        first
    }
}

fn divided(mut triangles: Vec<[[f64; 3]; 3]>) -> Tree {
    let bounds = Bounds::of(&triangles);
    if triangles.len() <= FEW {
        return Tree::Leaf(bounds, triangles);
    }
    let extent = |axis: &usize| bounds.max[*axis] - bounds.min[*axis];
    let axis = (0..3).max_by(|a, b| extent(a).total_cmp(&extent(b))).unwrap();
    let middle = |t: &[[f64; 3]; 3]| t.iter().map(|corner| corner[axis]).sum::<f64>();
    triangles.sort_by(|a, b| middle(a).total_cmp(&middle(b)));
    let rest = triangles.split_off(triangles.len() / 2);
    Tree::Node(bounds, Box::new([divided(triangles), divided(rest)]))
}

fn search(tree: &Tree, from: [f64; 3], direction: [f64; 3], first: &mut Interval) {
    let (Tree::Leaf(bounds, _) | Tree::Node(bounds, _)) = tree;
    match bounds.stay(from, direction) {
        Some([near, _]) if near <= first.upper => {}
        _ => return,
    }
    match tree {
        Tree::Leaf(_, triangles) => triangles.iter().for_each(|t| meet(t, from, direction, first)),
        Tree::Node(_, children) => children.iter().for_each(|child| search(child, from, direction, first)),
    }
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// Adds a ray and a triangle, by the method of Möller and Trumbore: they meet, they do not meet, or rounding
/// errors decide.
fn meet(triangle: &[[f64; 3]; 3], from: [f64; 3], direction: [f64; 3], first: &mut Interval) {
    let [a, b, c] = *triangle;
    let (ab, ac, way) = (minus(b, a), minus(c, a), minus(from, a));
    let across = cross(direction, ac);
    let turned = cross(way, ab);
    let determinant = dot(ab, across);
    let sign = determinant.signum();
    let determinant = determinant.abs();
    let [u, v, t] = [dot(way, across), dot(direction, turned), dot(ac, turned)].map(|x| x * sign);
    let (edge, far, speed) = (length(ab).max(length(ac)), length(way), length(direction));
    let determinant_error = ERROR * speed * edge * edge;
    let error = ERROR * speed * edge * far.max(edge);
    let t_error = ERROR * edge * edge * far;
    if determinant <= determinant_error {
        // Along its plane, or nearly so.
        if let Some([near, _]) = Bounds::of(&[*triangle]).stay(from, direction) {
            *first = Interval::new(first.lower.min(near), first.upper).unwrap();
        }
        return;
    }
    let w = determinant - u - v;
    if u < -error || v < -error || w < -3.0 * error || t < -t_error {
        return;
    }
    let lower = ((t - t_error) / (determinant + determinant_error)).max(0.0);
    let upper = (t + t_error) / (determinant - determinant_error);
    let least = first.lower.min(lower * (1.0 - ERROR));
    *first = Interval::new(least, first.upper).unwrap();
    if u > error && v > error && w > 3.0 * error && t > t_error {
        *first = Interval::new(first.lower, first.upper.min(upper * (1.0 + ERROR))).unwrap();
    }
}
