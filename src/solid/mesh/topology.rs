//! How the triangles of a mesh hang together: open and misoriented edges, bodies.
//!
//! Every triangle uses three edges, each in one direction. The uses are distributed to the lower one of
//! their two vertices by counting (linear time, and triangles that are near in memory stay so) and sorted
//! only within these short lists, which is several times faster than one sort of all edges.

use alloc::vec::Vec;

use crate::error::Error;

/// What the edges of a mesh say.
#[derive(Debug, Clone)]
pub(super) struct Topology {
    /// Edges that an odd number of triangles use.
    pub boundary_edges: u64,
    /// Edges that an even number of triangles use, but not half of them in each direction.
    pub misoriented_edges: u64,
    /// Edges that more than two triangles use.
    pub non_manifold_edges: u64,
    /// Sets of triangles that hang together over edges.
    pub bodies: u64,
    /// The vertices of the boundary edges, ascending.
    pub open_vertices: Vec<u32>,
    /// The surface's boundary as a chain: each edge that more triangles run along in one direction than in the other,
    /// in that direction, as often as there are more. Of a surface whose triangles cancel each other's edges it is
    /// empty; otherwise every vertex begins as many of these edges as it ends.
    pub boundary: Vec<[u32; 2]>,
}

impl Topology {
    /// Analyses `triangles`, whose corners must be three different numbers below `vertices`.
    ///
    /// O(t + v) time on ordinary meshes, O(t log t) when many edges share one vertex; 28 bytes per triangle
    /// and 8 bytes per vertex of scratch memory. Fails with [`Error::OutOfMemory`].
    pub fn of(triangles: &[[u32; 3]], vertices: usize) -> Result<Self, Error> {
        let uses = triangles.len().checked_mul(3).ok_or(Error::OutOfMemory)?;
        // Slot v + 1 counts first, then holds the place where the next use of vertex v goes, and at last the
        // end of v's list, which is the start of the list of v + 1.
        let mut ends: Vec<usize> = filled(vertices.checked_add(2).ok_or(Error::OutOfMemory)?, 0)?;
        for &[a, b, c] in triangles {
            ends[a.min(b) as usize + 2] += 1;
            ends[b.min(c) as usize + 2] += 1;
            ends[c.min(a) as usize + 2] += 1;
        }
        let mut sum = 0;
        for end in &mut ends {
            sum += *end;
            *end = sum;
        }
        // One use is (higher vertex, triangle). Its direction is looked up in the triangle, since 65 bits do
        // not fit.
        let mut lists: Vec<u64> = filled(uses, 0)?;
        for (t, &[a, b, c]) in triangles.iter().enumerate() {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let place = &mut ends[from.min(to) as usize + 1];
                lists[*place] = u64::from(from.max(to)) << 32 | t as u64;
                *place += 1;
            }
        }
        let mut result = Self {
            boundary_edges: 0,
            misoriented_edges: 0,
            non_manifold_edges: 0,
            bodies: 0,
            open_vertices: Vec::new(),
            boundary: Vec::new(),
        };
        let mut bodies = DisjointSets::new(triangles.len())?;
        for low in 0..vertices {
            let list = &mut lists[ends[low]..ends[low + 1]];
            list.sort_unstable();
            for edge in list.chunk_by(|a, b| a >> 32 == b >> 32) {
                let (mut forward, mut first) = (0, None);
                for &item in edge {
                    let t = item as u32;
                    forward +=
                        usize::from(is_forward(triangles[t as usize], low as u32, (item >> 32) as u32));
                    match first {
                        None => first = Some(t),
                        Some(other) => bodies.unite(other, t),
                    }
                }
                if edge.len() % 2 == 1 {
                    result.boundary_edges += 1;
                    result.open_vertices.try_reserve(2).map_err(|_| Error::OutOfMemory)?;
                    result.open_vertices.extend([low as u32, (edge[0] >> 32) as u32]);
                } else if 2 * forward != edge.len() {
                    result.misoriented_edges += 1;
                }
                result.non_manifold_edges += u64::from(edge.len() > 2);
                let high = (edge[0] >> 32) as u32;
                let directed = if 2 * forward > edge.len() { [low as u32, high] } else { [high, low as u32] };
                let excess = (2 * forward).abs_diff(edge.len());
                result.boundary.try_reserve(excess).map_err(|_| Error::OutOfMemory)?;
                result.boundary.extend(core::iter::repeat_n(directed, excess));
            }
        }
        result.bodies = bodies.count;
        result.open_vertices.sort_unstable();
        result.open_vertices.dedup();
        Ok(result)
    }
}

/// Whether the triangle runs from `from` to `to`; both must be corners of it.
fn is_forward([a, b, c]: [u32; 3], from: u32, to: u32) -> bool {
    (a == from) & (b == to) | (b == from) & (c == to) | (c == from) & (a == to)
}

/// A vector of `len` times `value`.
fn filled<T: Clone>(len: usize, value: T) -> Result<Vec<T>, Error> {
    let mut v = Vec::new();
    v.try_reserve_exact(len).map_err(|_| Error::OutOfMemory)?;
    v.resize(len, value);
    Ok(v)
}

/// Union-find. The root of a set is its least member, so that every link leads downwards.
struct DisjointSets {
    parents: Vec<u32>,
    count: u64,
}

impl DisjointSets {
    /// `len` sets of one member each; `len` is at most 2^32 - 1.
    fn new(len: usize) -> Result<Self, Error> {
        let mut parents = Vec::new();
        parents.try_reserve_exact(len).map_err(|_| Error::OutOfMemory)?;
        parents.extend((0..len).map(|i| i as u32));
        Ok(Self { parents, count: len as u64 })
    }

    fn root(&mut self, mut i: u32) -> u32 {
        loop {
            let parent = self.parents[i as usize];
            if parent == i {
                return i;
            }
            // Path halving: keeps the paths short without a second walk.
            let grandparent = self.parents[parent as usize];
            self.parents[i as usize] = grandparent;
            i = grandparent;
        }
    }

    fn unite(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        if a != b {
            self.parents[a.max(b) as usize] = a.min(b);
            self.count -= 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::collections::BTreeMap;

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    fn of(triangles: &[[u32; 3]]) -> [u64; 4] {
        let vertices = triangles.iter().flatten().max().map_or(0, |&v| v as usize + 1);
        let t = Topology::of(triangles, vertices).unwrap();
        [t.boundary_edges, t.misoriented_edges, t.non_manifold_edges, t.bodies]
    }

    /// The same by the definition.
    fn slow(triangles: &[[u32; 3]]) -> [u64; 4] {
        let mut edges: BTreeMap<(u32, u32), Vec<(usize, bool)>> = BTreeMap::new();
        for (t, &[a, b, c]) in triangles.iter().enumerate() {
            for (x, y) in [(a, b), (b, c), (c, a)] {
                edges.entry((x.min(y), x.max(y))).or_default().push((t, x < y));
            }
        }
        let mut label: Vec<usize> = (0..triangles.len()).collect();
        let mut changed = true;
        while changed {
            changed = false;
            for uses in edges.values() {
                let least = uses.iter().map(|u| label[u.0]).min().unwrap();
                for u in uses {
                    changed |= label[u.0] != least;
                    label[u.0] = least;
                }
            }
        }
        let mut result = [0; 4];
        for uses in edges.values() {
            let forward = uses.iter().filter(|u| u.1).count();
            result[0] += (uses.len() % 2) as u64;
            result[1] += u64::from(uses.len() % 2 == 0 && 2 * forward != uses.len());
            result[2] += u64::from(uses.len() > 2);
        }
        result[3] = label.iter().enumerate().filter(|&(t, &l)| t == l).count() as u64;
        result
    }

    #[test]
    fn small_meshes() {
        assert_eq!(of(&[]), [0, 0, 0, 0]);
        assert_eq!(of(&[[0, 1, 2]]), [3, 0, 0, 1]);
        assert_eq!(of(&TETRAHEDRON), [0, 0, 0, 1]);
        assert_eq!(of(&TETRAHEDRON[..3]), [3, 0, 0, 1]);
        // One face turned over: its three edges are used twice in the same direction.
        assert_eq!(of(&[[0, 1, 2], [0, 1, 3], [1, 2, 3], [2, 0, 3]]), [0, 3, 0, 1]);
        // Both sides of one triangle, and the same triangle twice.
        assert_eq!(of(&[[0, 1, 2], [2, 1, 0]]), [0, 0, 0, 1]);
        assert_eq!(of(&[[0, 1, 2], [1, 2, 0]]), [0, 3, 0, 1]);
        // A fin on a tetrahedron: one edge is used three times, two only once.
        let mut fin = TETRAHEDRON.to_vec();
        fin.push([0, 1, 4]);
        assert_eq!(of(&fin), [3, 0, 1, 1]);
    }

    #[test]
    fn bodies_hang_together_over_edges_only() {
        let shifted = |offset: u32, shared: &[u32]| {
            TETRAHEDRON.map(|t| t.map(|v| if shared.contains(&v) { v } else { v + offset }))
        };
        let both = |other: [[u32; 3]; 4]| of(&[TETRAHEDRON, other].concat());
        assert_eq!(both(shifted(4, &[])), [0, 0, 0, 2]);
        assert_eq!(both(shifted(4, &[0])), [0, 0, 0, 2]);
        assert_eq!(both(shifted(4, &[0, 1])), [0, 0, 1, 1]);
    }

    #[test]
    fn random_soups_agree_with_the_definition() {
        let mut state = 1u64;
        let mut random = |below: u32| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            ((state >> 33) % u64::from(below)) as u32
        };
        for round in 0..300 {
            let vertices = 3 + random(if round % 2 == 0 { 6 } else { 60 });
            let mut triangles = Vec::new();
            while triangles.len() < 1 + round / 4 {
                let t = [random(vertices), random(vertices), random(vertices)];
                if t[0] != t[1] && t[1] != t[2] && t[2] != t[0] {
                    triangles.push(t);
                }
            }
            assert_eq!(of(&triangles), slow(&triangles), "{triangles:?}");
        }
    }

    #[test]
    fn one_vertex_of_many_triangles() {
        // An umbrella of 100 000 triangles around vertex 0, closed from below by the same, turned over.
        let n = 100_000;
        let umbrella = (0..n).map(|i| [0, 1 + i, 1 + (i + 1) % n]);
        let below = (0..n).map(|i| [n + 1, 1 + (i + 1) % n, 1 + i]);
        assert_eq!(of(&umbrella.clone().chain(below).collect::<Vec<_>>()), [0, 0, 0, 1]);
        assert_eq!(of(&umbrella.collect::<Vec<_>>()), [u64::from(n), 0, 0, 1]);
    }
}
