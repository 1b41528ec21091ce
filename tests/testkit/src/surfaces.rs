//! Checks of surface meshes.

use leafless::TriangleMesh;
use std::collections::{BTreeMap, HashMap};

/// Asserts that the triangles run along every edge equally often in both directions, and use every vertex.
#[track_caller]
pub fn assert_balanced(mesh: &TriangleMesh) {
    let mut edges: HashMap<(u32, u32), i64> = HashMap::new();
    let mut used = vec![false; mesh.vertices().len()];
    for &[a, b, c] in mesh.triangles() {
        assert!(a != b && b != c && c != a);
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
            used[from as usize] = true;
        }
    }
    assert!(edges.values().all(|&sum| sum == 0), "an edge is open");
    assert!(used.iter().all(|&used| used), "a vertex is not used");
}

/// Asserts that the mesh is a closed manifold, and returns V − E + F. Every edge must belong to two
/// triangles, in opposite directions. Every vertex must be used, and its triangles must form one fan.
#[track_caller]
pub fn euler_of_manifold(mesh: &TriangleMesh) -> i64 {
    let mut next = HashMap::new();
    let mut at_vertex = vec![0u32; mesh.vertices().len()];
    for &[a, b, c] in mesh.triangles() {
        for (from, to, third) in [(a, b, c), (b, c, a), (c, a, b)] {
            assert!(next.insert((from, to), third).is_none(), "two triangles run along {from}, {to}");
            at_vertex[from as usize] += 1;
        }
    }
    assert!(next.keys().all(|&(from, to)| next.contains_key(&(to, from))), "an edge is open");
    let mut first = HashMap::new();
    next.iter().for_each(|(&(from, to), _)| _ = first.insert(from, to));
    for (vertex, &count) in (0u32..).zip(&at_vertex) {
        let start = first[&vertex];
        let (mut at, mut fan) = (next[&(vertex, start)], 1);
        while at != start {
            (at, fan) = (next[&(vertex, at)], fan + 1);
        }
        assert_eq!(fan, count, "the triangles at vertex {vertex} form several fans");
    }
    mesh.vertices().len() as i64 - next.len() as i64 / 2 + mesh.triangles().len() as i64
}

/// Returns the number of sets of triangles that are connected by vertices.
pub fn components(mesh: &TriangleMesh) -> usize {
    let mut parent: Vec<u32> = (0..mesh.vertices().len() as u32).collect();
    fn root(parent: &mut [u32], mut v: u32) -> u32 {
        while parent[v as usize] != v {
            parent[v as usize] = parent[parent[v as usize] as usize];
            v = parent[v as usize];
        }
        v
    }
    for &[a, b, c] in mesh.triangles() {
        for (a, b) in [(a, b), (b, c)] {
            let (a, b) = (root(&mut parent, a), root(&mut parent, b));
            parent[a as usize] = b;
        }
    }
    (0..mesh.vertices().len() as u32).filter(|&v| parent[v as usize] == v).count()
}

/// The lattice coordinates of a sample, or a direction.
pub type Point = [i64; 3];

/// Returns the oriented plane of a triangle: its scaled outward normal, and the product of that normal with a
/// vertex.
fn plane([p, q, r]: [Point; 3]) -> (Point, i64) {
    let (u, v) = ([0, 1, 2].map(|k| q[k] - p[k]), [0, 1, 2].map(|k| r[k] - p[k]));
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let scale = normal.iter().map(|n| n.abs()).max().unwrap();
    assert!(scale > 0, "a triangle has no area");
    let normal = normal.map(|n| n / scale);
    (normal, (0..3).map(|k| normal[k] * p[k]).sum())
}

/// Returns the sample at which a vertex lies, on a lattice of unit cells.
pub fn sample(vertex: [f64; 3]) -> Point {
    vertex.map(|x| (x - 0.5).round() as i64)
}

/// The outlines of planes by normal and offset: the net number of times that each step is traversed forwards.
pub type Outlines = BTreeMap<(Point, i64), BTreeMap<(Point, Point), i64>>;

/// Returns for each plane the outline of the triangles in it: the directed steps from sample to sample,
/// without steps that cancel. If two sets of triangles in a plane have the same outline, they cover the same
/// points equally often.
pub fn outlines(mesh: &TriangleMesh) -> Outlines {
    let mut outlines = Outlines::new();
    for triangle in mesh.triangles() {
        let triangle = triangle.map(|v| sample(mesh.vertices()[v as usize]));
        let outline = outlines.entry(plane(triangle)).or_default();
        for k in 0..3 {
            let (from, to) = (triangle[k], triangle[(k + 1) % 3]);
            let way = [0, 1, 2].map(|k| to[k] - from[k]);
            let steps = way.iter().fold(0, |a, &b| gcd(a, b.abs()));
            for i in 0..steps {
                let point = |i: i64| [0, 1, 2].map(|k| from[k] + way[k] / steps * i);
                let (a, b) = (point(i), point(i + 1));
                *outline.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
            }
        }
    }
    outlines.values_mut().for_each(|outline| outline.retain(|_, count| *count != 0));
    outlines
}

fn gcd(a: i64, b: i64) -> i64 {
    if b == 0 { a } else { gcd(b, a % b) }
}
