//! The winding number of any triangle soup by its definition: the sum of the solid angles of all triangles,
//! after van Oosterom and Strackee, each with an error bound.
//!
//! No facet is welded, closed, sorted or left out. The only decision is the side of a triangle on which a
//! point lies, where the triangle covers nearly a half-space. This decision is made in integers.

use crate::oracle;
use crate::shapes::Soup;
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

type Point = [f64; 3];

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}

/// A winding number and its error bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Winding {
    pub value: f64,
    /// Error bound; infinite on an edge or a vertex of the soup, where no winding number exists.
    pub error: f64,
    /// True if the point lies on a triangle. The winding number is then the limit from the direction (ε, ε²,
    /// ε³).
    pub on_surface: bool,
}

/// An upper bound of the rounding error in a sum of solid angles without difficult triangles. The sum of 100
/// 000 solid angles is far better.
const REST: f64 = 1e-9;

/// A soup, prepared for evaluation at many points.
pub struct Soupy {
    vertices: Vec<Point>,
    triangles: Vec<[u32; 3]>,
    /// The vertices relative to the point: directions and distances.
    seen: Vec<[f64; 4]>,
    /// Largest magnitude of a coordinate.
    reach: f64,
    /// Least coordinates; `high` has the greatest.
    pub low: Point,
    pub high: Point,
}

impl Soupy {
    pub fn new(soup: &Soup) -> Soupy {
        let mut indices = HashMap::new();
        let mut vertices = Vec::new();
        // Sharing equal vertices only saves work: each distance is computed once.
        let mut index = |p: Point| {
            *indices.entry(p.map(f64::to_bits)).or_insert_with(|| {
                vertices.push(p);
                vertices.len() as u32 - 1
            })
        };
        let triangles = soup.iter().map(|facet| facet.map(&mut index)).collect();
        let fold = |f: fn(f64, f64) -> f64, start: f64| {
            [0, 1, 2].map(|axis| vertices.iter().map(|p| p[axis]).fold(start, f))
        };
        let (low, high) = (fold(f64::min, f64::INFINITY), fold(f64::max, f64::NEG_INFINITY));
        let reach = low.iter().chain(&high).fold(0.0, |most: f64, x| most.max(x.abs()));
        Soupy { triangles, seen: vec![[0.0; 4]; vertices.len()], vertices, reach, low, high }
    }

    /// The winding number around `p`.
    pub fn at(&mut self, p: Point) -> Winding {
        for (seen, &vertex) in self.seen.iter_mut().zip(&self.vertices) {
            let d = sub(vertex, p);
            *seen = [d[0], d[1], d[2], length(d)];
        }
        let reach = p.iter().fold(self.reach, |most, x| most.max(x.abs()));
        // The half angles of easy triangles (below a quarter of π) add up in the argument of a product of
        // complex numbers, which is taken to the sum before it comes near its branch cut.
        let (mut re, mut im) = (1.0f64, 0.0f64);
        let mut sum = Sum::default();
        let (mut error, mut on_surface) = (REST, false);
        for &t in &self.triangles {
            let [a, b, c] = t.map(|v| self.seen[v as usize]);
            let (la, lb, lc) = (a[3], b[3], c[3]);
            let [a, b, c] = [a, b, c].map(|v| [v[0], v[1], v[2]]);
            let x = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
            let y = dot(a, cross(b, c));
            let size = la * lb * lc;
            if x > y.abs() && x > 0.1 * size {
                (re, im) = (re * x - im * y, re * y + im * x);
                if re <= im.abs() || !(1e-150..1e150).contains(&re) {
                    sum.add(im.atan2(re));
                    (re, im) = (1.0, 0.0);
                }
                continue;
            }
            // Rounding of the differences and of the products, relative to the number whose argument is
            // taken.
            let noise = f64::EPSILON * (16.0 * size + 8.0 * reach * (la * lb + lb * lc + lc * la));
            let modulus = x.hypot(y);
            if modulus <= noise {
                // (For a triangle with coincident corners, all terms and its solid angle are zero.)
                if !self.is_point(t) {
                    error = f64::INFINITY;
                }
                continue;
            }
            error += 4.0 * noise / modulus;
            if x < 0.0 && y.abs() <= noise {
                let corners = t.map(|v| self.vertices[v as usize]);
                let side = oracle::over(corners, p);
                on_surface |= side == 0;
                let side = if side != 0 { side } else { oracle::facing(corners) };
                // Behind the triangle, opposite to its normal, the winding number is greater by one.
                sum.add(-side as f64 * y.abs().atan2(x));
            } else {
                sum.add(y.atan2(x));
            }
        }
        sum.add(im.atan2(re));
        Winding { value: sum.value() / TAU, error, on_surface }
    }

    fn is_point(&self, t: [u32; 3]) -> bool {
        t[0] == t[1] && t[1] == t[2]
    }

    /// Returns the corners of triangle `t`.
    pub fn corners(&self, t: usize) -> [Point; 3] {
        self.triangles[t].map(|v| self.vertices[v as usize])
    }

    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// True if any triangle comes within `radius` of `p`.
    pub fn is_near(&self, p: Point, radius: f64) -> bool {
        self.triangles.iter().any(|t| {
            let corners = t.map(|v| self.vertices[v as usize]);
            // The box around the triangle first.
            let apart = (0..3).any(|axis| {
                let at = corners.map(|corner| corner[axis]);
                at[0].min(at[1]).min(at[2]) > p[axis] + radius
                    || at[0].max(at[1]).max(at[2]) < p[axis] - radius
            });
            !apart && distance(corners, p) <= radius
        })
    }
}

/// A compensated sum, which carries the rounded-off part (Neumaier).
#[derive(Default)]
struct Sum {
    sum: f64,
    lost: f64,
}

impl Sum {
    fn add(&mut self, x: f64) {
        let sum = self.sum + x;
        self.lost += if self.sum.abs() >= x.abs() { (self.sum - sum) + x } else { (x - sum) + self.sum };
        self.sum = sum;
    }

    fn value(&self) -> f64 {
        self.sum + self.lost
    }
}

/// Returns the distance of a point from a triangle.
pub fn distance(corners: [Point; 3], p: Point) -> f64 {
    let [a, b, c] = corners;
    let normal = cross(sub(b, a), sub(c, a));
    let area = length(normal);
    // Above the interior?
    let within = [(a, b), (b, c), (c, a)]
        .iter()
        .all(|&(from, to)| dot(cross(sub(to, from), sub(p, from)), normal) >= 0.0);
    if area > 0.0 && within {
        return dot(sub(p, a), normal).abs() / area;
    }
    [(a, b), (b, c), (c, a)].map(|edge| distance_from_edge(edge, p)).into_iter().fold(f64::INFINITY, f64::min)
}

/// Returns the distance of a point from a line segment.
pub fn distance_from_edge((a, b): (Point, Point), p: Point) -> f64 {
    let (along, to) = (sub(b, a), sub(p, a));
    let square = dot(along, along);
    let t = if square > 0.0 { (dot(to, along) / square).clamp(0.0, 1.0) } else { 0.0 };
    length(sub(to, along.map(|x| x * t)))
}

/// The boundary of a soup: edges that more triangles use in one direction than in the other, with the
/// surplus.
pub struct Boundary(pub Vec<((Point, Point), f64)>);

impl Boundary {
    pub fn of(soup: &Soup) -> Boundary {
        let mut uses: HashMap<[[u64; 3]; 2], i32> = HashMap::new();
        // -0.0 is at the same place as 0.0.
        let key = |p: Point| p.map(|x| (x + 0.0).to_bits());
        for facet in soup {
            for k in 0..3 {
                let (from, to) = (key(facet[k]), key(facet[(k + 1) % 3]));
                match from.cmp(&to) {
                    std::cmp::Ordering::Less => *uses.entry([from, to]).or_default() += 1,
                    std::cmp::Ordering::Greater => *uses.entry([to, from]).or_default() -= 1,
                    std::cmp::Ordering::Equal => {}
                }
            }
        }
        let mut edges: Vec<_> = uses.into_iter().filter(|edge| edge.1 != 0).collect();
        edges.sort_unstable();
        let point = |p: [u64; 3]| p.map(f64::from_bits);
        Boundary(edges.into_iter().map(|([a, b], n)| ((point(a), point(b)), n.abs() as f64)).collect())
    }

    /// Returns a bound of the gradient of the winding number within `radius` of `p`, if no triangle is there.
    /// By the Biot–Savart law, ∇w = ±(1/4π) ∮ dl × r / |r|³.
    pub fn gradient(&self, p: Point, radius: f64) -> f64 {
        let share = |&(edge, times): &((Point, Point), f64)| {
            let far = (distance_from_edge(edge, p) - radius).max(0.0);
            times * length(sub(edge.1, edge.0)) / (far * far)
        };
        self.0.iter().map(share).sum::<f64>() / (4.0 * PI)
    }
}
