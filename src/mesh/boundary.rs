//! Decomposition of a surface's boundary into simple loops.

use crate::error::{Error, MeshError};
use crate::memory;
use alloc::vec::Vec;

/// Closed walks that visit no vertex twice.
#[derive(Debug, Default)]
pub(crate) struct Loops {
    vertices: Vec<u32>,
    /// One past the last vertex of each loop.
    ends: Vec<usize>,
}

impl Loops {
    /// Returns the bytes that the lists take.
    pub(crate) fn bytes(&self) -> usize {
        memory::bytes_of(&self.vertices) + memory::bytes_of(&self.ends)
    }

    /// Splits directed edges into loops. At every vertex as many edges must begin as end. Each loop has three
    /// vertices or more and no vertex twice; together the loops have the given edges.
    ///
    /// O(n log n).
    ///
    /// # Errors
    /// [`MeshError::TooMany`], [`Error::OutOfMemory`].
    pub(crate) fn of(boundary: &[[u32; 2]]) -> Result<Loops, Error> {
        let mut edges = memory::copied(boundary)?;
        edges.sort_unstable();
        let loops = EdgeLoops::of(&edges, true)?;
        let mut vertices = memory::with_capacity(edges.len())?;
        for walk in loops.iter() {
            let in_order = walk[1..].iter().chain(&walk[..1]);
            vertices.extend(in_order.map(|&edge| edges[edge as usize][0]));
        }
        Ok(Loops { vertices, ends: loops.ends })
    }

    /// Returns the number of triangles that fill all loops.
    pub(crate) fn caps(&self) -> usize {
        self.vertices.len() - 2 * self.ends.len()
    }

    /// Returns the number of edges of all loops.
    pub(crate) fn edges(&self) -> usize {
        self.vertices.len()
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let starts = core::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| &self.vertices[start..end])
    }
}

/// Loops of edges. In each loop the closing edge comes first; the others follow in order.
#[derive(Default)]
pub(super) struct EdgeLoops {
    edges: Vec<u32>,
    /// One past the last edge of each loop.
    ends: Vec<usize>,
}

impl EdgeLoops {
    /// Splits a boundary into loops. If it is directed, as many edges must begin at every vertex as end
    /// there. If it is undirected, the edges must differ and every vertex must have an even number of them.
    /// No loop has a vertex twice; each edge is in one loop.
    ///
    /// O(n log n).
    ///
    /// # Errors
    /// [`MeshError::TooMany`] or [`Error::OutOfMemory`].
    pub fn of(open: &[[u32; 2]], is_directed: bool) -> Result<EdgeLoops, Error> {
        if u32::try_from(open.len()).is_err() {
            return Err(MeshError::TooMany.into());
        }
        // The edges that leave a vertex are consecutive, and vertices are numbered by them.
        let mut uses: Vec<(u32, u32)> = memory::with_capacity(open.len() * 2)?;
        let ends = if is_directed { 1 } else { 2 };
        uses.extend(open.iter().zip(0..).flat_map(|(edge, e)| edge[..ends].iter().map(move |&v| (v, e))));
        uses.sort_unstable();
        let mut firsts: Vec<usize> = memory::with_capacity(uses.len() + 1)?;
        firsts.extend((0..uses.len()).filter(|&u| u == 0 || uses[u - 1].0 != uses[u].0));
        let count = firsts.len();
        firsts.push(uses.len());
        let number = |vertex: u32| firsts[..count].partition_point(|&first| uses[first].0 < vertex);

        let mut next = memory::copied(&firsts[..count])?;
        let mut walked: Vec<bool> = memory::filled(open.len(), false)?;
        // The position of each vertex on the path.
        let mut places = memory::filled(count, usize::MAX)?;
        // Each vertex of the path, and the edge that led to it.
        let mut path: Vec<(usize, u32)> = memory::with_capacity(count)?;
        let mut loops = EdgeLoops::default();
        loops.edges.try_reserve_exact(open.len())?;
        for start in 0..count {
            path.push((start, 0));
            places[start] = 0;
            // The walk can only end where it began: at every other vertex an edge leads on.
            while let Some(&(last, _)) = path.last()
                && next[last] < firsts[last + 1]
            {
                let edge = uses[next[last]].1;
                next[last] += 1;
                if core::mem::replace(&mut walked[edge as usize], true) {
                    continue;
                }
                let [a, b] = open[edge as usize];
                let onto = number(if uses[firsts[last]].0 == a { b } else { a });
                if places[onto] == usize::MAX {
                    places[onto] = path.len();
                    path.push((onto, edge));
                    continue;
                }
                let place = places[onto];
                loops.edges.push(edge);
                loops.edges.extend(path[place + 1..].iter().map(|&(_, edge)| edge));
                memory::push(&mut loops.ends, loops.edges.len())?;
                path.drain(place + 1..).for_each(|(vertex, _)| places[vertex] = usize::MAX);
            }
            places[start] = usize::MAX;
            path.clear();
        }
        Ok(loops)
    }

    pub fn count(&self) -> usize {
        self.ends.len()
    }

    /// Iterates over the edges of each loop.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let starts = core::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| &self.edges[start..end])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Loops are simple, and together have the given edges.
    fn check(boundary: &[[u32; 2]]) -> usize {
        let loops = Loops::of(boundary).unwrap();
        let mut edges = Vec::new();
        for walk in loops.iter() {
            assert!(walk.len() >= 3, "{walk:?}");
            let mut sorted = walk.to_vec();
            sorted.sort_unstable();
            sorted.dedup();
            assert_eq!(sorted.len(), walk.len(), "{walk:?}");
            edges.extend((0..walk.len()).map(|i| [walk[i], walk[(i + 1) % walk.len()]]));
        }
        let mut given = boundary.to_vec();
        given.sort_unstable();
        edges.sort_unstable();
        assert_eq!(edges, given);
        loops.iter().count()
    }

    #[test]
    fn small_boundaries() {
        assert_eq!(check(&[]), 0);
        assert_eq!(check(&[[7, 3], [3, 9], [9, 7]]), 1);
        // The same loop twice.
        assert_eq!(check(&[[7, 3], [3, 9], [9, 7], [7, 3], [3, 9], [9, 7]]), 2);
        // A figure of eight.
        assert_eq!(check(&[[0, 1], [1, 2], [2, 0], [0, 3], [3, 4], [4, 0]]), 2);
        // Three walks between two vertices.
        assert_eq!(check(&[[0, 1], [0, 2], [1, 3], [2, 3], [3, 4], [4, 0], [3, 5], [5, 0]]), 2);
    }

    #[test]
    fn random_boundaries() {
        let mut state = 1u64;
        let mut random = |below: u32| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            ((state >> 33) % u64::from(below)) as u32
        };
        for round in 0..500 {
            // The boundary of a few random triangles, as a chain.
            let vertices = 4 + random(2 + round / 4);
            let mut chain = alloc::collections::BTreeMap::<(u32, u32), i32>::new();
            for _ in 0..1 + random(1 + round / 3) {
                let t = [random(vertices), random(vertices), random(vertices)];
                if t[0] == t[1] || t[1] == t[2] || t[2] == t[0] {
                    continue;
                }
                for i in 0..3 {
                    let (a, b) = (t[i], t[(i + 1) % 3]);
                    *chain.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
                }
            }
            let mut boundary = Vec::new();
            for ((a, b), times) in chain {
                let edge = if times > 0 { [a, b] } else { [b, a] };
                boundary.extend(core::iter::repeat_n(edge, times.unsigned_abs() as usize));
            }
            check(&boundary);
        }
    }
}
