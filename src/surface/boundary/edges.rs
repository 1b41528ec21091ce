//! Crossings of surfaces and edges of cells.

use super::figures::Figures;
use super::leaves::{Leaf, Leaves, OpenLeaf};
use super::walk::{Edge, Face, Visitor};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::memory;
use crate::solid::OpenSurfaces;
use alloc::vec::Vec;
use hashbrown::HashMap;

/// No vertex, or no surface.
pub(super) const NONE: u32 = u32::MAX;

/// A surface that crosses an edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Crossing {
    /// The surface, or [`NONE`] where the solid begins or ends, and no surface is known.
    pub(super) surface: u32,
    /// The vertex, if the solid begins or ends at the crossing; otherwise [`NONE`].
    pub(super) vertex: u32,
    /// The place in unit coordinates.
    pub(super) at: [f64; 3],
}

/// An edge: its axis, the lower end on the other two axes, and its place along the axis.
type Key = (u8, u32, u32, u32);

struct Crossed {
    key: Key,
    first: u32,
    count: u32,
}

/// A test of lattice corners where no surfaces are known.
pub(super) trait Corners {
    fn is_inside(&mut self, at: [u32; 3], unit: [f64; 3]) -> Result<bool, Error>;
}

/// The edges that surfaces cross, and the vertices there.
pub(super) struct Edges<'f> {
    pub(super) figures: &'f Figures,
    list: Vec<Crossed>,
    crossings: Vec<Crossing>,
    /// Whether each visited corner lies in the solid.
    states: HashMap<[u32; 3], bool>,
    pub(super) vertices: Vec<[f64; 3]>,
    /// Finest cells per axis.
    cells: f64,
}

/// The builder of [`Edges`].
struct Finder<'f, 'l, C> {
    edges: Edges<'f>,
    leaves: &'l Leaves,
    corners: C,
}

impl<'f> Edges<'f> {
    pub(super) fn find(
        leaves: &Leaves,
        figures: &'f Figures,
        corners: impl Corners,
    ) -> Result<Edges<'f>, Error> {
        let edges = Edges {
            figures,
            list: Vec::new(),
            crossings: Vec::new(),
            states: HashMap::new(),
            vertices: Vec::new(),
            cells: f64::from(1u32 << leaves.depth),
        };
        let mut finder = Finder { edges, leaves, corners };
        leaves.walk(&mut finder)?;
        let mut edges = finder.edges;
        edges.list.sort_unstable_by_key(|crossed| crossed.key);
        Ok(edges)
    }

    pub(super) fn unit(&self, at: [u32; 3]) -> [f64; 3] {
        at.each(|c| f64::from(c) / self.cells)
    }

    /// Returns whether a corner lies in the solid, as the search for edges found.
    pub(super) fn is_inside(&self, at: [u32; 3]) -> bool {
        self.states.get(&at).copied().unwrap_or(false)
    }

    /// The crossings from a corner along an axis, in ascending order.
    pub(super) fn along(
        &self,
        axis: usize,
        at: [u32; 3],
        length: u32,
    ) -> impl DoubleEndedIterator<Item = &Crossing> {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let key = |start: u32| (axis as u8, at[u], at[v], start);
        let first = self.list.partition_point(|crossed| crossed.key < key(at[axis]));
        let end = self.list.partition_point(|crossed| crossed.key < key(at[axis] + length));
        self.list[first..end].iter().flat_map(|crossed| {
            &self.crossings[crossed.first as usize..(crossed.first + crossed.count) as usize]
        })
    }
}

/// Returns the open cell of which most is known.
pub(super) fn best(leaves: &Leaves, around: impl Iterator<Item = Leaf>) -> Option<&OpenLeaf> {
    let rank = |leaf: &OpenLeaf| (leaf.is_simple, leaf.open.is_some());
    let mut best: Option<&OpenLeaf> = None;
    for leaf in around {
        let Leaf::Open(number) = leaf else { continue };
        let own = &leaves.open[number as usize];
        if best.is_none_or(|best| rank(own) > rank(best)) {
            best = Some(own);
        }
    }
    best
}

impl<C: Corners> Finder<'_, '_, C> {
    fn signs(&self, open: &OpenSurfaces, unit: [f64; 3]) -> Result<u8, Error> {
        let mut signs = 0;
        for (k, &surface) in open.indices().iter().enumerate() {
            signs |= u8::from(self.edges.figures.is_positive(surface, unit)?) << k;
        }
        Ok(signs)
    }

    fn state(&mut self, at: [u32; 3], own: Option<&OpenLeaf>) -> Result<bool, Error> {
        let unit = self.edges.unit(at);
        match own.and_then(|leaf| leaf.open) {
            Some(open) => Ok(open.inside(self.signs(&open, unit)?)),
            None => match self.edges.states.get(&at) {
                Some(&known) => Ok(known),
                None => self.corners.is_inside(at, unit),
            },
        }
    }
}

impl<C: Corners> Visitor for Finder<'_, '_, C> {
    fn face(&mut self, _: &Face) -> Result<(), Error> {
        Ok(())
    }

    fn edge(&mut self, edge: &Edge) -> Result<(), Error> {
        let (axis, leaves) = (edge.axis, self.leaves);
        let mut end = edge.at;
        end[axis] += edge.length;
        let (from, to) = (self.edges.unit(edge.at), self.edges.unit(end));
        let leaf = |q: usize| edge.around[q].leaf;
        let own = best(leaves, (0..4).map(leaf));
        let states = [self.state(edge.at, own)?, self.state(end, own)?];
        let known = [edge.at, end].each(|at| self.edges.states.get(&at).copied());
        for k in 0..2 {
            if known[k].is_none() {
                self.edges.states.try_reserve(1)?;
                self.edges.states.insert([edge.at, end][k], states[k]);
            }
        }
        // All surfaces that cross the edge.
        let mut found: Vec<(f64, u32)> = Vec::new();
        for q in 0..4 {
            let Leaf::Open(number) = leaf(q) else { continue };
            let Some(open) = leaves.open[number as usize].open else { continue };
            for &surface in open.indices() {
                if found.iter().any(|&(_, known)| known == surface) {
                    continue;
                }
                let figures = self.edges.figures;
                if figures.is_positive(surface, from)? != figures.is_positive(surface, to)? {
                    memory::push(&mut found, (figures.on_edge(surface, axis, from, to[axis]), surface))?;
                }
            }
        }
        found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let first = self.edges.crossings.len();
        let place = |x: f64| axes(|k| if k == axis { x } else { from[k] });
        // Where cells contradict each other about a corner, the solid begins or ends at the corner.
        let agreed = [known[0].unwrap_or(states[0]), known[1].unwrap_or(states[1])];
        let mut state = states[0];
        if agreed[0] != state {
            self.cross(NONE, place(from[axis]), true)?;
        }
        match own.and_then(|leaf| leaf.open) {
            Some(open) => {
                let mut signs = self.signs(&open, from)?;
                for &(x, surface) in &found {
                    if let Some(k) = open.indices().iter().position(|&known| known == surface) {
                        signs ^= 1 << k;
                    }
                    let next = open.inside(signs);
                    self.cross(surface, place(x), next != state)?;
                    state = next;
                }
            }
            None => {
                if states[0] != states[1] {
                    self.cross(NONE, place(0.5 * (from[axis] + to[axis])), true)?;
                    state = states[1];
                }
            }
        }
        if agreed[1] != state {
            self.cross(NONE, place(to[axis]), true)?;
        }
        let count = (self.edges.crossings.len() - first) as u32;
        if count > 0 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let key = (axis as u8, edge.at[u], edge.at[v], edge.at[axis]);
            memory::push(&mut self.edges.list, Crossed { key, first: first as u32, count })?;
        }
        Ok(())
    }
}

impl<C> Finder<'_, '_, C> {
    fn cross(&mut self, surface: u32, at: [f64; 3], is_active: bool) -> Result<(), Error> {
        let mut vertex = NONE;
        if is_active {
            vertex = self.edges.vertices.len() as u32;
            memory::push(&mut self.edges.vertices, at)?;
        }
        memory::push(&mut self.edges.crossings, Crossing { surface, vertex, at })
    }
}
