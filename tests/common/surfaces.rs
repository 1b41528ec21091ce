//! What is asked of the meshes of surfaces.

use leafless::TriangleMesh;
use std::collections::HashMap;

/// Every edge is run along as often in one direction as in the other, and every vertex is used.
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

/// Every edge belongs to two triangles, in opposite directions; every vertex is used; around each its
/// triangles form one fan. Returns V − E + F.
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

/// Sets of triangles that hang together over vertices.
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
