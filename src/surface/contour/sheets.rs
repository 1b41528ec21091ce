//! The pieces of the surface in each cell.
//!
//! Corners of cells lie inside or outside. The surface crosses minimal edges between an inside corner and an
//! outside one. In a minimal face, arcs join the crossings in pairs; both cells beside the face share the
//! arcs. Arcs form loops around cells, and each loop bounds one sheet, a disc. So crossings, arcs and sheets
//! form a closed surface for any signs: each arc lies between two sheets, and each crossing is surrounded by
//! three or four sheets.

use super::cells::{Cells, Kind, OUTSIDE};
use super::walk::{Edge, Face, Visitor, walk};
use crate::error::{Error, MeshError};
use crate::lattice::Each;
use crate::memory;
use alloc::vec::Vec;
use hashbrown::HashMap;

/// No arc.
pub(super) const NONE: u32 = u32::MAX;

/// A test of points. Their coordinates are counted in halves of finest cells.
pub(super) trait Inside {
    fn is_inside(&mut self, at: [u32; 3]) -> Result<bool, Error>;
}

/// A minimal edge that the surface crosses.
#[derive(Debug, Clone, Copy)]
pub(super) struct Crossing {
    pub(super) axis: u8,
    pub(super) starts_inside: bool,
    pub(super) length: u32,
    /// The lower end, in finest cells.
    pub(super) at: [u32; 3],
    /// The leaves around the edge, counter-clockwise as seen from above.
    pub(super) around: [u32; 4],
    /// The arc between each leaf and the next one; [`NONE`] if both are the same leaf.
    pub(super) arcs: [u32; 4],
}

impl Crossing {
    /// A key that sorts crossings so that those on one line follow each other.
    fn key(&self) -> u128 {
        key(usize::from(self.axis), self.at)
    }

    /// The first place of a leaf around the crossing.
    fn place(&self, leaf: u32) -> Option<usize> {
        self.around.iter().position(|&around| around == leaf)
    }
}

fn key(axis: usize, at: [u32; 3]) -> u128 {
    let [along, u, v] = [0, 1, 2].each(|step| u128::from(at[(axis + step) % 3]));
    (axis as u128) << 96 | u << 64 | v << 32 | along
}

/// A connection of two crossings in a face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arc {
    pub(super) crossings: [u32; 2],
    /// The leaves beside the arc.
    pub(super) leaves: [u32; 2],
    pub(super) axis: u8,
}

/// A disc in a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sheet {
    pub(super) leaf: u32,
    /// The number of crossings around the disc.
    pub(super) crossings: u32,
}

pub(super) struct Sheets {
    pub(super) crossings: Vec<Crossing>,
    pub(super) arcs: Vec<Arc>,
    pub(super) sheets: Vec<Sheet>,
    /// For each crossing, the sheets in the cells around it.
    pub(super) around: Vec<[u32; 4]>,
    /// The number of sheets of each leaf.
    pub(super) counts: Vec<u32>,
}

/// The flags of a corner: decided cells around it are empty, or full.
const EMPTY: u8 = 1;
const FULL: u8 = 2;
/// The corner was queried.
const ASKED: u8 = 4;
const INSIDE: u8 = 8;

/// Returns whether there are only empty cells around an edge, so that both its ends lie outside. Any other
/// edge that meets such an end also knows this.
fn is_empty(cells: &Cells, edge: &Edge) -> bool {
    let mut around = edge.around.iter().map(|&leaf| cells.leaves.get(leaf as usize));
    around.all(|leaf| leaf.is_none_or(|leaf| leaf.kind == Kind::Empty))
}

/// Collects the verdicts of cells on corners.
struct Touched<'c> {
    cells: &'c Cells,
    states: HashMap<[u32; 3], u8>,
}

impl Visitor for Touched<'_> {
    fn face(&mut self, _: &Face) -> Result<(), Error> {
        Ok(())
    }

    fn edge(&mut self, edge: &Edge) -> Result<(), Error> {
        if is_empty(self.cells, edge) {
            return Ok(());
        }
        let mut state = 0;
        for leaf in edge.around {
            state |= match self.cells.leaves.get(leaf as usize).map(|leaf| leaf.kind) {
                None | Some(Kind::Empty) => EMPTY,
                Some(Kind::Full) => FULL,
                Some(Kind::Open) => 0,
            };
        }
        let mut end = edge.at;
        end[edge.axis] += edge.length;
        for corner in [edge.at, end] {
            self.states.try_reserve(1)?;
            *self.states.entry(corner).or_insert(0) |= state;
        }
        Ok(())
    }
}

/// Finds the crossed edges.
struct Crossed<'i, I> {
    cells: &'i Cells,
    states: HashMap<[u32; 3], u8>,
    inside: &'i mut I,
    crossings: Vec<Crossing>,
}

impl<I: Inside> Crossed<'_, I> {
    fn is_inside(&mut self, corner: [u32; 3]) -> Result<bool, Error> {
        let Some(state) = self.states.get_mut(&corner) else { return Ok(false) };
        if *state & ASKED == 0 {
            // (Where an empty cell and a full one touch, the surface lies in their common corners.)
            let is_inside = match *state & (EMPTY | FULL) {
                0 => self.inside.is_inside(corner.each(|c| 2 * c))?,
                FULL => true,
                _ => false,
            };
            *state |= ASKED | if is_inside { INSIDE } else { 0 };
        }
        Ok(*state & INSIDE != 0)
    }
}

impl<I: Inside> Visitor for Crossed<'_, I> {
    fn face(&mut self, _: &Face) -> Result<(), Error> {
        Ok(())
    }

    fn edge(&mut self, edge: &Edge) -> Result<(), Error> {
        if is_empty(self.cells, edge) {
            return Ok(());
        }
        let mut end = edge.at;
        end[edge.axis] += edge.length;
        let starts_inside = self.is_inside(edge.at)?;
        if starts_inside == self.is_inside(end)? {
            return Ok(());
        }
        let &Edge { axis, at, length, around } = edge;
        let crossing = Crossing { axis: axis as u8, starts_inside, length, at, around, arcs: [NONE; 4] };
        memory::push(&mut self.crossings, crossing)
    }
}

/// Finds the arcs.
struct Joined<'i, I> {
    inside: &'i mut I,
    crossings: Vec<Crossing>,
    /// The keys of the crossings.
    keys: Vec<u128>,
    /// Whether crossings lie around each leaf. Other leaves have no crossings in their faces.
    is_crossed: Vec<bool>,
    arcs: Vec<Arc>,
    /// The crossings around the current face, counter-clockwise, and whether the corner before each lies
    /// inside.
    ring: Vec<(u32, bool)>,
}

impl<I> Joined<'_, I> {
    /// Adds the crossings from a corner along an axis to the ring.
    fn along(&mut self, axis: usize, at: [u32; 3], length: u32, is_backward: bool) -> Result<(), Error> {
        let mut over = at;
        over[axis] += length;
        let first = self.keys.partition_point(|&own| own < key(axis, at));
        let count = self.keys[first..].iter().take_while(|&&own| own < key(axis, over)).count();
        let end = first + count;
        for k in 0..end - first {
            let number = if is_backward { end - 1 - k } else { first + k };
            let starts_inside = self.crossings[number].starts_inside;
            memory::push(&mut self.ring, (number as u32, starts_inside != is_backward))?;
        }
        Ok(())
    }
}

impl<I: Inside> Visitor for Joined<'_, I> {
    fn edge(&mut self, _: &Edge) -> Result<(), Error> {
        Ok(())
    }

    fn face(&mut self, face: &Face) -> Result<(), Error> {
        let &Face { axis, at, length, sides } = face;
        if sides.iter().any(|&leaf| leaf == OUTSIDE || !self.is_crossed[leaf as usize]) {
            return Ok(());
        }
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (mut right, mut top) = (at, at);
        right[u] += length;
        top[v] += length;
        self.ring.clear();
        self.along(u, at, length, false)?;
        self.along(v, right, length, false)?;
        self.along(u, top, length, true)?;
        self.along(v, at, length, true)?;
        let count = self.ring.len();
        if count < 2 {
            return Ok(());
        }
        // If there is a choice, the centre decides whether the inside or the outside is in one piece.
        let mut centre = at.each(|c| 2 * c);
        centre[u] += length;
        centre[v] += length;
        let is_whole = count > 2 && self.inside.is_inside(centre)?;
        // An arc cuts off the corners between a crossing and the next one: those that lie inside, or those
        // that lie outside.
        let first = usize::from(self.ring[0].1 != is_whole);
        for k in (first..count + first).step_by(2) {
            let crossings = [self.ring[k % count].0, self.ring[(k + 1) % count].0];
            let number = self.arcs.len() as u32;
            memory::push(&mut self.arcs, Arc { crossings, leaves: sides, axis: axis as u8 })?;
            for crossing in crossings {
                let crossing = &mut self.crossings[crossing as usize];
                for place in 0..4 {
                    let pair = [crossing.around[place], crossing.around[(place + 1) % 4]];
                    if pair == sides || pair == [sides[1], sides[0]] {
                        crossing.arcs[place] = number;
                    }
                }
            }
        }
        Ok(())
    }
}

impl Sheets {
    pub(super) fn find(cells: &Cells, inside: &mut impl Inside) -> Result<Sheets, Error> {
        let mut touched = Touched { cells, states: HashMap::new() };
        walk(cells, &mut touched)?;
        let mut crossed = Crossed { cells, states: touched.states, inside, crossings: Vec::new() };
        walk(cells, &mut crossed)?;
        let Crossed { mut crossings, states, .. } = crossed;
        drop(states);
        if crossings.len() > (u32::MAX / 8) as usize {
            return Err(MeshError::TooMany.into());
        }
        crossings.sort_unstable_by_key(Crossing::key);
        let mut is_crossed = memory::filled(cells.leaves.len(), false)?;
        for leaf in crossings.iter().flat_map(|crossing| crossing.around) {
            is_crossed[leaf as usize] = true;
        }
        let keys = memory::collected(crossings.iter().map(Crossing::key))?;
        let mut joined = Joined { inside, crossings, keys, is_crossed, arcs: Vec::new(), ring: Vec::new() };
        walk(cells, &mut joined)?;
        let Joined { crossings, arcs, .. } = joined;
        let mut sheets =
            Sheets { crossings, arcs, sheets: Vec::new(), around: Vec::new(), counts: Vec::new() };
        sheets.link(cells)?;
        Ok(sheets)
    }

    /// Joins arcs to loops.
    fn link(&mut self, cells: &Cells) -> Result<(), Error> {
        // The place of a cell around a crossing represents the part of the cell's surface there.
        let mut parents = memory::collected(0..4 * self.crossings.len() as u32)?;
        for arc in &self.arcs {
            for leaf in arc.leaves {
                let [a, b] = arc.crossings.each(|crossing| {
                    let place = self.crossings[crossing as usize].place(leaf).unwrap_or(0);
                    root(&mut parents, 4 * crossing + place as u32)
                });
                parents[a.max(b) as usize] = a.min(b);
            }
        }
        self.counts = memory::filled(cells.leaves.len(), 0)?;
        self.around = memory::with_capacity(self.crossings.len())?;
        let mut numbers = memory::filled(parents.len(), NONE)?;
        for (number, crossing) in (0u32..).zip(&self.crossings) {
            let mut around = [NONE; 4];
            for (slot, &leaf) in around.iter_mut().zip(&crossing.around) {
                let place = crossing.place(leaf).unwrap_or(0) as u32;
                let root = root(&mut parents, 4 * number + place) as usize;
                if numbers[root] == NONE {
                    numbers[root] = self.sheets.len() as u32;
                    memory::push(&mut self.sheets, Sheet { leaf, crossings: 0 })?;
                    self.counts[leaf as usize] += 1;
                }
                *slot = numbers[root];
            }
            for k in 0..4 {
                if !around[..k].contains(&around[k]) {
                    self.sheets[around[k] as usize].crossings += 1;
                }
            }
            self.around.push(around);
        }
        Ok(())
    }

    /// The sheets beside an arc.
    pub(super) fn beside(&self, arc: &Arc) -> [u32; 2] {
        let crossing = arc.crossings[0] as usize;
        arc.leaves.each(|leaf| self.around[crossing][self.crossings[crossing].place(leaf).unwrap_or(0)])
    }
}

fn root(parents: &mut [u32], mut node: u32) -> u32 {
    while parents[node as usize] != node {
        parents[node as usize] = parents[parents[node as usize] as usize];
        node = parents[node as usize];
    }
    node
}
