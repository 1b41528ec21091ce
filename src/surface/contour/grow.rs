//! Splitting cells until each represents its surface by one vertex.

use super::cells::{Cells, Kind};
use super::fit::{Fit, Space, fit};
use super::probe::Probe;
use super::sheets::Inside;
use super::triangles::{Place, dot};
use crate::control::Job;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::lattice::{Cell, MAX_DEPTH, axes};
use crate::octree::Tag;
use crate::solid::{Slab, Worker};
use alloc::vec::Vec;

/// Cells coarser than this level are always split, so that lines see something of the solid.
const COARSEST: u8 = 3;

/// The greatest distance of a cell's planes from its vertex, in tolerances.
const FAR: f64 = 2.0;

/// A cell up to this size (in tolerances) with one piece of the surface always ends, because a comparison
/// with the mesh follows.
const SMALL: f64 = 8.0;

/// The greatest distance of a vertex outside its cell, in edges of the cell.
const SLACK: f64 = 0.1;

/// The number of levels examined below a cell whose own slab is not thin.
const AHEAD: u8 = 3;

/// The number of cells that may be split to locate the boundary: for each cell of the contour, and for any
/// contour.
const SPLITS: u64 = 16;
const ANYWAY: u64 = 4096;

/// Cells are rare if there are at least this many times as many others.
const RARE: u64 = 512;

/// The greatest deviation of the normals of a flat piece from the normal of its slab.
const CONE: f64 = 1.0;

/// The least dot product of two normals on a smooth piece.
const BENT: f64 = 0.3;

/// The builder of the cells.
pub(super) struct Grower<'g, 'c, W: Worker> {
    pub(super) cells: Cells,
    pub(super) probe: &'g mut Probe<'c, W>,
    pub(super) tolerance: f64,
    pub(super) job: &'g Job<'g>,
    pub(super) splits: u64,
    places: Vec<Place>,
}

pub(super) fn kind(tag: Tag) -> Kind {
    match tag {
        Tag::Empty => Kind::Empty,
        Tag::Full => Kind::Full,
        Tag::Partial | Tag::Branch => Kind::Open,
    }
}

impl<'g, 'c, W: Worker> Grower<'g, 'c, W> {
    pub(super) fn new(
        probe: &'g mut Probe<'c, W>,
        depth: u8,
        tolerance: f64,
        job: &'g Job<'g>,
    ) -> Result<Self, Error> {
        let cells = Cells::new(kind(probe.root()), depth)?;
        Ok(Grower { cells, probe, tolerance, job, splits: 0, places: Vec::new() })
    }

    /// Splits a leaf, if possible, and the new leaves as far as necessary. Reports `parts` of the work.
    pub(super) fn split(&mut self, leaf: u32, parts: usize) -> Result<bool, Error> {
        let cell = self.cells.leaves[leaf as usize].cell;
        let is_spent = self.job.control().max_splits.is_some_and(|most| self.splits >= most);
        if cell.level >= self.cells.depth || is_spent {
            return Ok(false);
        }
        let Some(tags) = self.probe.children(cell)? else { return Ok(false) };
        self.job.spend(1, size_of::<super::cells::Leaf>() * 8)?;
        self.splits += 1;
        let first = self.cells.split(leaf, tags.each(kind))?;
        for octant in 0..8 {
            self.grow(first + octant, parts / 8)?;
        }
        Ok(true)
    }

    /// Splits leaves that are not split yet; `count` is their approximate number. If these are few beside all
    /// others, their children are split, too, because one round then does the work of two. Returns whether a
    /// leaf was split.
    pub(super) fn split_all(
        &mut self,
        count: usize,
        leaves: impl IntoIterator<Item = u32>,
    ) -> Result<bool, Error> {
        let is_rare = count as u64 * RARE <= self.cells.open();
        let mut is_any = false;
        for leaf in leaves {
            let first = self.cells.leaves.len() as u32;
            if self.cells.leaves[leaf as usize].is_gone || !self.split(leaf, 0)? {
                continue;
            }
            is_any = true;
            for part in (first..first + 8).filter(|_| is_rare) {
                let own = self.cells.leaves[part as usize];
                if own.kind == Kind::Open && !own.is_gone {
                    self.split(part, 0)?;
                }
            }
        }
        Ok(is_any)
    }

    /// The number of cells that may be split to locate the boundary.
    pub(super) fn budget(&self) -> u64 {
        let most = self.job.control().max_splits.map_or(u64::MAX, |most| most.saturating_sub(self.splits));
        (SPLITS * self.cells.open() + ANYWAY).min(most)
    }

    /// Splits a leaf as far as necessary.
    pub(super) fn grow(&mut self, leaf: u32, parts: usize) -> Result<(), Error> {
        let own = self.cells.leaves[leaf as usize];
        let is_done = own.kind != Kind::Open
            || own.cell.level >= COARSEST && self.is_done(leaf)?
            || !self.split(leaf, parts)?;
        if is_done && parts > 0 {
            self.job.advance(parts);
        }
        Ok(())
    }

    fn is_done(&mut self, leaf: u32) -> Result<bool, Error> {
        let cell = self.cells.leaves[leaf as usize].cell;
        let edge = 1.0 / f64::from(1u32 << cell.level);
        // No two points of a cell are further apart.
        if edge * 1.75 <= self.tolerance {
            return Ok(true);
        }
        let half = 1u32 << (self.cells.depth - cell.level);
        let mut corners = 0u8;
        for corner in 0..8u8 {
            let at = axes(|k| 2 * half * (cell.at[k] + u32::from(corner >> k & 1)));
            corners |= u8::from(self.probe.is_inside(at)?) << corner;
        }
        let slab = self.slab(cell)?;
        if corners == 0 || corners == 0xFF {
            // The surface can only reach a little into the cell. A comparison with the mesh finds this case.
            return Ok(cell.level > COARSEST || slab.is_some());
        }
        if !is_connected(corners) || !is_connected(!corners) {
            return Ok(false);
        }
        let is_thin = slab.is_some_and(|slab| slab.outer - slab.inner <= 1.5 * FAR * self.tolerance);
        let Some(fit) = self.fit(cell, corners, is_thin)? else { return Ok(edge <= SMALL * self.tolerance) };
        let is_known = match slab.filter(|_| is_thin) {
            Some(slab) => self.is_within(&slab, fit.at),
            None => self.agrees(cell, fit.at, AHEAD)?,
        };
        if is_known {
            self.cells.leaves[leaf as usize].vertex = Some(fit.at);
        }
        Ok(is_known || edge <= SMALL * self.tolerance)
    }

    /// The two planes between which the surface in a cell lies, if it is nearly flat: in unit coordinates,
    /// with a unit normal.
    fn slab(&mut self, cell: Cell) -> Result<Option<Slab>, Error> {
        let Some(enclosure) = self.probe.enclosure(cell)? else { return Ok(None) };
        let mut slabs = enclosure.slabs.iter().filter(|slab| slab.normal != [0.0; 3]);
        let (Some(slab), None) = (slabs.next(), slabs.next()) else { return Ok(None) };
        Ok((enclosure.cone <= CONE).then(|| unit_slab(slab, cell)))
    }

    /// Returns whether both planes of a slab are near a vertex.
    fn is_within(&self, slab: &Slab, at: [f64; 3]) -> bool {
        let height = dot(slab.normal, at);
        (height - slab.inner).abs().max((height - slab.outer).abs()) <= FAR * self.tolerance
    }

    /// Returns whether the planes of the surface in all parts of a cell pass near a vertex.
    fn agrees(&mut self, cell: Cell, vertex: [f64; 3], ahead: u8) -> Result<bool, Error> {
        if ahead == 0 || cell.level >= MAX_DEPTH {
            return self.passes(cell, vertex);
        }
        let Some(tags) = self.probe.children(cell)? else { return self.passes(cell, vertex) };
        for (octant, tag) in (0..8u8).zip(tags) {
            if kind(tag) != Kind::Open {
                continue;
            }
            let child = cell.child(octant);
            if let Some(enclosure) = self.probe.enclosure(child)? {
                let mut slabs = enclosure.slabs.iter().filter(|slab| slab.normal != [0.0; 3]);
                if slabs.all(|slab| self.is_within(&unit_slab(slab, child), vertex)) {
                    continue;
                }
            }
            if !self.agrees(child, vertex, ahead - 1)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Returns whether the planes at crossings on lines through the middle of a cell pass near a vertex.
    fn passes(&mut self, cell: Cell, vertex: [f64; 3]) -> Result<bool, Error> {
        self.places.clear();
        self.probe.middle(cell, &mut self.places)?;
        let most = FAR * self.tolerance;
        Ok(self.places.iter().all(|place| dot(place.normal, axes(|k| vertex[k] - place.at[k])).abs() <= most))
    }

    /// Fits the vertex of a cell with one simple piece of the surface, to the crossings on the cell's edges,
    /// and on further lines unless `by_edges` is set.
    fn fit(&mut self, cell: Cell, corners: u8, by_edges: bool) -> Result<Option<Fit>, Error> {
        let half = 1u32 << (self.cells.depth - cell.level);
        let low = cell.at.each(|c| c * 2 * half);
        self.places.clear();
        let mut most = 0;
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            for number in 0..9u32 {
                let mut steps = [0; 3];
                (steps[u], steps[v]) = (number % 3, number / 3);
                let is_edge = steps.iter().all(|step| step % 2 == 0);
                if by_edges && !is_edge {
                    continue;
                }
                let before = self.places.len();
                let from = axes(|k| low[k] + steps[k] * half);
                self.probe.line(axis, from, 2 * half, &mut self.places)?;
                let found = self.places.len() - before;
                if is_edge {
                    let corner = (steps[u] / 2) << u | (steps[v] / 2) << v;
                    let is_crossed = (corners >> corner ^ corners >> (corner | 1 << axis)) & 1 == 1;
                    // (Two crossings between ends on one side mean that a sharp edge reaches out of another
                    // cell.)
                    if found % 2 != usize::from(is_crossed) {
                        return Ok(None);
                    }
                }
                most = most.max(found);
            }
        }
        if most > 2 {
            return Ok(None);
        }
        let edge = 1.0 / f64::from(1u32 << cell.level);
        let space = Space { low: self.probe.unit(low), edge };
        let found = fit(&self.places, &space, FAR * self.tolerance, SLACK);
        Ok(found.filter(|found| found.rank > 1 || most == 1 && self.is_smooth()))
    }

    fn is_smooth(&self) -> bool {
        let first = self.places.iter().map(|place| place.normal).find(|normal| *normal != [0.0; 3]);
        let Some(first) = first else { return false };
        self.places.iter().all(|place| place.normal == [0.0; 3] || dot(first, place.normal) >= BENT)
    }
}

/// A slab of a cell in unit coordinates, with a unit normal.
fn unit_slab(slab: &Slab, cell: Cell) -> Slab {
    let edge = 1.0 / f64::from(1u32 << cell.level);
    let centre = cell.at.each(|c| (f64::from(c) + 0.5) * edge);
    let length = sqrt(dot(slab.normal, slab.normal));
    let normal = slab.normal.each(|c| c / length);
    let shift = dot(normal, centre);
    let [inner, outer] = [slab.inner, slab.outer].each(|offset| offset / length * 0.5 * edge + shift);
    Slab { normal, inner, outer }
}

/// Returns whether some corners of a cell are connected along its edges.
fn is_connected(corners: u8) -> bool {
    let mut met = corners & corners.wrapping_neg();
    loop {
        // Neighbours along x, y and z.
        let beside = (met & 0x55) << 1
            | (met & 0xAA) >> 1
            | (met & 0x33) << 2
            | (met & 0xCC) >> 2
            | (met & 0x0F) << 4
            | (met & 0xF0) >> 4;
        let next = met | beside & corners;
        if next == met {
            return met == corners;
        }
        met = next;
    }
}
