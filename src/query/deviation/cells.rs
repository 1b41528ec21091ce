//! The boundary of a solid from its cells.
//!
//! The cells with the greatest doubt are split first, until all polygons are exact enough. The boundary then
//! consists of the polygons in PARTIAL cells, of the walls between the inside and the outside of the solid,
//! and of the remaining PARTIAL cells of which nothing is known. Such a cell is represented by its middle,
//! which is known to be near to the boundary if the closed cell holds points inside of the solid and points
//! outside.

use super::polygon::Polygon;
use super::slabs::{Region, Slabs};
use super::surface::{Layer, ROUNDING, Surface};
use crate::control::Job;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::lattice::{Cell, Cube, Frame, axes};
use crate::memory;
use crate::mesh::TriangleMesh;
use crate::octree::Tag;
use crate::solid::{Ask, Classifier, Verdict, Worker};
use crate::walk::{Part, Queue, Subject};
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::cmp::Reverse;

/// The state of a cell.
#[derive(Clone, Copy)]
enum Known {
    Empty,
    Full,
    /// PARTIAL: the boundary may be anywhere in the cell. Whether the closed cell surely has points inside of
    /// the solid, and points outside.
    Open([bool; 2]),
    /// PARTIAL, with known slabs: an index into the list.
    Slabs(u32),
    /// Split: the index of the first of its eight children.
    Split(u32),
}

/// The cells that were met.
struct Cells {
    frame: Frame,
    nodes: Vec<(Cell, Known)>,
    slabs: Vec<Slabs>,
}

/// An open cell: its node and its part.
type Waiting<P> = (usize, P);

/// The greatest radius first, then the cell met earlier.
type Rank = (u64, Reverse<u64>);

/// Returns the boundary of a solid in the universe, to `tolerance` where slabs determine it.
pub(super) fn surface<C: Classifier>(
    solid: &C,
    tolerance: f64,
    budget: u64,
    job: &Job<'_>,
) -> Result<Surface, Error> {
    let frame = *solid.frame();
    let most = frame.origin().iter().fold(0.0, |most: f64, c| most.max(c.abs())) + frame.edge();
    let rounding = ROUNDING * most;
    let tolerance = tolerance.max(8.0 * rounding);
    let mut subject = Subject::new(solid, job.control())?;
    let mut cells = Cells { frame, nodes: Vec::new(), slabs: Vec::new() };
    let mut open: Queue<Rank, Waiting<Part<C>>> = Queue::new();
    let root = subject.worker.root()?;
    cells.add(&mut subject, &mut open, Cell::ROOT, root, tolerance)?;
    let mut is_cut_short = false;
    while open.peek().is_some() {
        job.check()?;
        let allowed = job.control().max_bytes.unwrap_or(u64::MAX);
        let taken = memory::bytes_of(&cells.nodes) + memory::bytes_of(&cells.slabs);
        is_cut_short = subject.splits >= budget || subject.takes(8) || taken as u64 > allowed / 8;
        if is_cut_short {
            break;
        }
        let Some((node, part)) = open.pop() else { break };
        let cell = cells.nodes[node].0;
        let children = subject.split(cell, &part)?;
        let first = cells.nodes.len();
        for (octant, child) in (0..8).zip(children) {
            cells.add(&mut subject, &mut open, cell.child(octant), child, tolerance)?;
        }
        // (2^32 nodes would take a hundred gigabytes.)
        cells.nodes[node].1 = Known::Split(first as u32);
    }
    drop(open);
    let exterior = solid.exterior();
    let mut covers = Layers { tolerance, rounding, layers: Vec::new() };
    let mut cores = Layers { tolerance, rounding, layers: Vec::new() };
    cells.walls(exterior, &mut covers, &mut cores, job)?;
    cells.insides(&mut covers, &mut cores, job)?;
    Ok(Surface {
        covers: covers.finished()?,
        cores: Some(cores.finished()?),
        clipped: (exterior != Tag::Empty).then_some(frame),
        splits: subject.splits,
        is_cut_short,
    })
}

impl Cells {
    fn add<C: Classifier>(
        &mut self,
        subject: &mut Subject<'_, C>,
        open: &mut Queue<Rank, Waiting<Part<C>>>,
        cell: Cell,
        verdict: Verdict<Part<C>>,
        tolerance: f64,
    ) -> Result<(), Error> {
        let half = Cube { frame: &self.frame, cell }.half_edge();
        let known = match verdict {
            Verdict::Empty => Known::Empty,
            Verdict::Full => Known::Full,
            Verdict::Undecided => Known::Open([false; 2]),
            Verdict::Partial(part) => {
                let slabs = subject.worker.enclosure(cell, &part)?.as_ref().and_then(Slabs::new);
                let whole = sqrt(3.0) * half;
                let radius = slabs.as_ref().map_or(whole, |slabs| (slabs.radius() * half).min(whole));
                // Where the boundary runs along a wall, cells with slabs some times thinner decide the side.
                const THINNER: f64 = 64.0;
                let is_met = slabs.as_ref().is_none_or(Slabs::is_met);
                let doubt = if is_met { radius } else { (THINNER * radius).min(whole) };
                let is_finest = cell.level >= self.frame.depth();
                let known = match slabs.filter(|_| radius < whole) {
                    Some(slabs) => {
                        memory::push(&mut self.slabs, slabs)?;
                        Known::Slabs(self.slabs.len() as u32 - 1)
                    }
                    None if is_finest => {
                        // A centre in the solid, or on its boundary, is a limit of the solid's points. The
                        // same holds for the outside.
                        let inside = subject.worker.sample(cell, &part)?;
                        Known::Open([inside == Some(true), inside == Some(false)])
                    }
                    None => Known::Open([false; 2]),
                };
                if doubt > tolerance && !is_finest {
                    let rank = (doubt.to_bits(), Reverse(open.met()));
                    open.push(rank, (self.nodes.len(), part))?;
                }
                known
            }
        };
        memory::push(&mut self.nodes, (cell, known))
    }

    /// Regions of a cell that surely lie inside of the solid, or surely outside. `None` as the node: the
    /// space outside of the universe.
    fn regions(&self, node: Option<usize>, exterior: Tag, solid: bool) -> ([Region; 3], usize) {
        let all = |is_there: bool| ([Region::ALL; 3], usize::from(is_there));
        match node.map(|node| self.nodes[node].1) {
            None => all(exterior == if solid { Tag::Full } else { Tag::Empty }),
            Some(Known::Full) => all(solid),
            Some(Known::Empty) => all(!solid),
            Some(Known::Open(_) | Known::Split(_)) => all(false),
            Some(Known::Slabs(slabs)) => self.slabs[slabs as usize].regions(solid),
        }
    }

    /// Processes all walls between cells.
    fn walls(
        &mut self,
        exterior: Tag,
        covers: &mut Layers,
        cores: &mut Layers,
        job: &Job<'_>,
    ) -> Result<(), Error> {
        // Two cells, or a cell and the space outside, with a common wall across an axis: the lower one first.
        let mut walls: Vec<([Option<usize>; 2], usize)> = Vec::new();
        for axis in 0..3 {
            memory::push(&mut walls, ([None, Some(0)], axis))?;
            memory::push(&mut walls, ([Some(0), None], axis))?;
        }
        let mut node = 0;
        loop {
            while let Some((pair, axis)) = walls.pop() {
                let first = |node: Option<usize>| match node.map(|node| self.nodes[node].1) {
                    Some(Known::Split(first)) => Some(first as usize),
                    _ => None,
                };
                let firsts = pair.each(first);
                if firsts == [None; 2] {
                    self.wall(pair, axis, exterior, covers, cores)?;
                    continue;
                }
                for k in 0..4 {
                    let (u, v) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
                    let octant = u * (k & 1) + v * (k >> 1);
                    // In the lower cell, the upper children.
                    let part = |side: usize| match firsts[side] {
                        Some(first) => Some(first + octant + if side == 0 { 1 << axis } else { 0 }),
                        None => pair[side],
                    };
                    memory::push(&mut walls, ([part(0), part(1)], axis))?;
                }
            }
            let Some((_, known)) = self.nodes.get(node) else { return Ok(()) };
            if let &Known::Split(first) = known {
                job.check()?;
                for axis in 0..3 {
                    for octant in (0..8).filter(|octant| octant >> axis & 1 == 0) {
                        let lower = first as usize + octant;
                        memory::push(&mut walls, ([Some(lower), Some(lower + (1 << axis))], axis))?;
                    }
                }
            }
            node += 1;
        }
    }

    /// Processes the wall between two cells that are not split.
    fn wall(
        &mut self,
        pair: [Option<usize>; 2],
        axis: usize,
        exterior: Tag,
        covers: &mut Layers,
        cores: &mut Layers,
    ) -> Result<(), Error> {
        for side in 0..2 {
            let other = match pair[1 - side].map(|node| self.nodes[node].1) {
                None => exterior,
                Some(Known::Full) => Tag::Full,
                Some(Known::Empty) => Tag::Empty,
                _ => Tag::Partial,
            };
            let Some(node) = pair[side] else { continue };
            let level = |node: usize| self.nodes[node].0.level;
            let is_whole = pair[1 - side].is_none_or(|other| level(other) <= level(node));
            let is_known = matches!(other, Tag::Full | Tag::Empty);
            match &mut self.nodes[node].1 {
                Known::Open(met) => {
                    met[0] |= other == Tag::Full;
                    met[1] |= other == Tag::Empty;
                }
                Known::Slabs(slabs) if is_whole && is_known => {
                    self.slabs[*slabs as usize].meet(axis, side == 0, other == Tag::Full);
                }
                _ => {}
            }
        }
        // The wall of the smaller cell lies entirely on the wall of the larger one.
        let level = |node: Option<usize>| node.map_or(-1, |node| i32::from(self.nodes[node].0.level));
        let side = usize::from(level(pair[1]) > level(pair[0]));
        let Some(own) = pair[side] else { return Ok(()) };
        let cell = self.nodes[own].0;
        for solid in 0..2 {
            let (inner, inner_count) = self.regions(pair[solid], exterior, true);
            let (outer, outer_count) = self.regions(pair[1 - solid], exterior, false);
            for inside in &inner[..inner_count] {
                for outside in &outer[..outer_count] {
                    let at = if side == 0 { 1.0 } else { -1.0 };
                    let mut polygon = Polygon::square(axis, at, 1.0);
                    for (region, node) in [(inside, pair[solid]), (outside, pair[1 - solid])] {
                        let (ratio, from) =
                            node.map_or((1.0, [0.0; 3]), |node| seen_from(cell, self.nodes[node].0));
                        region.clip(&mut polygon, ratio, from);
                    }
                    covers.add(&self.frame, cell, &polygon, 0.0)?;
                    cores.add(&self.frame, cell, &polygon, 0.0)?;
                }
            }
        }
        Ok(())
    }

    /// Processes all cells that may contain a part of the boundary.
    fn insides(&self, covers: &mut Layers, cores: &mut Layers, job: &Job<'_>) -> Result<(), Error> {
        for (count, &(cell, known)) in self.nodes.iter().enumerate() {
            if count % 4096 == 0 {
                job.check()?;
            }
            match known {
                Known::Empty | Known::Full | Known::Split(_) => {}
                Known::Slabs(slabs) => {
                    let slabs = &self.slabs[slabs as usize];
                    for (polygon, radius) in slabs.polygons(true) {
                        covers.add(&self.frame, cell, &polygon, radius)?;
                    }
                    for (polygon, radius) in slabs.polygons(false).chain(slabs.beside_walls()) {
                        cores.add(&self.frame, cell, &polygon, radius)?;
                    }
                }
                Known::Open(met) => {
                    let mut polygon = Polygon::square(0, 0.0, 0.125);
                    // The remaining polygon has the middle of the cell as a corner.
                    polygon.clip([0.0, -1.0, 0.0], 0.0);
                    polygon.clip([0.0, 0.0, -1.0], 0.0);
                    covers.add(&self.frame, cell, &polygon, sqrt(3.0))?;
                    if met == [true; 2] {
                        // All points of the cell are within this distance of the boundary.
                        cores.add(&self.frame, cell, &polygon, sqrt(3.0) + 0.25)?;
                    }
                }
            }
        }
        Ok(())
    }
}

/// Returns the scale and the offset that map the coordinates of `cell` to those of `other`, which is no
/// smaller.
fn seen_from(cell: Cell, other: Cell) -> (f64, [f64; 3]) {
    let scale = 1i64 << (cell.level - other.level);
    let middle = |cell: Cell, axis: usize| 2 * i64::from(cell.at[axis]) + 1;
    let from = axes(|axis| (middle(cell, axis) - scale * middle(other, axis)) as f64 / scale as f64);
    (1.0 / scale as f64, from)
}

/// Triangles with about the same radius.
#[derive(Default)]
struct Growing {
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    radius: f64,
}

/// Triangles by their radii: up to the tolerance, and up to each further factor of four.
struct Layers {
    tolerance: f64,
    /// A bound above the displacement of points by rounding.
    rounding: f64,
    layers: Vec<Growing>,
}

impl Layers {
    /// Adds a polygon of a cell, with a radius in half edges of the cell.
    fn add(&mut self, frame: &Frame, cell: Cell, polygon: &Polygon, radius: f64) -> Result<(), Error> {
        let corners = polygon.corners();
        let Some(first) = corners.first() else { return Ok(()) };
        let cube = Cube { frame, cell };
        let (half, (min, max)) = (cube.half_edge(), cube.bounds());
        // (Corners of cells are exact.)
        let place = |corner: &[f64; 3]| {
            axes(|axis| match corner[axis] {
                1.0 => max[axis],
                -1.0 => min[axis],
                c => 0.5 * min[axis] + 0.5 * max[axis] + half * c,
            })
        };
        let radius = radius * half + self.rounding;
        let mut number = 0;
        let mut limit = self.tolerance;
        while radius > limit && number < 24 {
            (number, limit) = (number + 1, 4.0 * limit);
        }
        while self.layers.len() <= number {
            memory::push(&mut self.layers, Growing::default())?;
        }
        let layer = &mut self.layers[number];
        layer.radius = layer.radius.max(radius);
        let start = layer.vertices.len() as u32;
        for corner in corners {
            memory::push(&mut layer.vertices, place(corner))?;
        }
        let mut is_any = false;
        for k in 1..corners.len() - 1 {
            let [a, b, c] = [0, k, k + 1].each(|k| layer.vertices[start as usize + k]);
            if a != b && b != c && c != a {
                memory::push(&mut layer.triangles, [start, start + k as u32, start + k as u32 + 1])?;
                is_any = true;
            }
        }
        if !is_any {
            // The polygon is hardly longer than the rounding error, or degenerates to a line: use triangles
            // with three different corners, next to it.
            layer.radius = layer.radius.max(radius + self.rounding);
            let mut beside = place(first);
            for axis in 0..2 {
                beside[axis] += 0.5 * self.rounding;
                memory::push(&mut layer.vertices, beside)?;
            }
            let last = start + corners.len() as u32 + 1;
            for k in start..last - 1 {
                memory::push(&mut layer.triangles, [k, last - 1, last])?;
            }
        }
        Ok(())
    }

    fn finished(self) -> Result<Vec<Layer>, Error> {
        let mut layers = memory::with_capacity(self.layers.len())?;
        for Growing { vertices, triangles, radius } in self.layers {
            if triangles.is_empty() {
                continue;
            }
            let mesh = Arc::new(TriangleMesh::new(vertices, triangles)?);
            layers.push(Layer { mesh, chosen: Vec::new(), radius });
        }
        Ok(layers)
    }
}
