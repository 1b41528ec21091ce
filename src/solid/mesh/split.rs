//! Splitting the cells of a mesh.

use super::boundary::Loops;
use super::crossing::Projection;
use super::open::{Branch, Surroundings};
use super::overlap::Overlap;
use super::placed::{Corners, Placed, bounds, ranks};
use super::scan::{Scan, Task};
use super::surface::{FillRule, TriangleMesh};
use crate::error::{Error, MeshError};
use crate::lattice::{Cell, Cube, Frame};
use crate::octree::{Block, Tag};
use crate::solid::{Fingerprint, Fingerprinter, Scratch, Solid, Verdict};
use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;

/// A triangle mesh as a solid on the lattice of one frame.
///
/// Any mesh will do. Where it is closed, what it encloses is exact. Where it is not, [`FillRule`] says by which convention
/// a point is inside; a cell is FULL or EMPTY if that is proven for all of its points, and around holes stay
/// PARTIAL cells which no triangle cuts: [`TriangleMesh::report`] tells whether to expect them.
///
/// ```
/// use leafless::{Control, FillRule, Frame, MeshSolid, Rule, TriangleMesh, build};
/// let vertices = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let mesh = TriangleMesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])?;
/// let frame = Frame::new([0.0; 3], 1.0, 6)?;
/// let solid = MeshSolid::new(mesh, &frame, FillRule::NonZero)?;
/// let tree = build(&solid, &frame, Rule::Certified, &Control::default())?;
/// assert!(tree.statistics().volume().contains(1.0 / 6.0));
/// # Ok::<(), leafless::Error>(())
/// ```
pub struct MeshSolid {
    pub(super) placed: Placed,
    pub(super) fill: FillRule,
}

/// What is remembered of a cell: the triangles that cut it, and the winding number of its lowest centre.
#[derive(Debug, Clone, Copy)]
pub struct MeshPart {
    /// Where the triangles lie in the scratch memory.
    first: usize,
    pub(super) count: usize,
    /// Of the surface with its caps; of the surface alone if `caps` is None.
    pub(super) winding: i32,
    /// What is known of the caps' winding number, which is not an integer. None if the surface's own rounds to
    /// `winding` throughout the cell, but for what the triangles that cut it change: always if there are no caps.
    pub(super) caps: Option<Branch>,
}

/// Lists of triangles, one for each cell on the way down, and what a block is scanned with.
#[derive(Default)]
pub struct MeshScratch {
    triangles: Vec<u32>,
    /// Bit k: the triangle belongs to child k.
    masks: Vec<u8>,
    surroundings: Surroundings,
    scan: Option<Box<Scan>>,
}

impl Scratch for MeshScratch {
    fn mark(&self) -> usize {
        self.triangles.len()
    }

    fn release(&mut self, mark: usize) {
        self.triangles.truncate(mark);
    }
}

impl MeshSolid {
    /// A mesh on the lattice of `frame`; time and memory linear in the mesh, which is shared (an `Arc`) or taken
    /// over. (Boundaries are sorted: n log n in the number of their edges.) A mesh that reaches beyond the universe is
    /// clipped by it, which [`exterior`](Solid::exterior) tells.
    ///
    /// # Errors
    /// [`Error::Mesh`] if the mesh is empty, or, for [`FillRule::EvenOdd`], if an odd number of triangles meet on an
    /// edge; [`Error::OutOfMemory`].
    pub fn new(
        mesh: impl Into<Arc<TriangleMesh>>,
        frame: &Frame,
        fill: FillRule,
    ) -> Result<MeshSolid, Error> {
        let mesh = mesh.into();
        let loops = match fill {
            FillRule::EvenOdd => {
                mesh.check_closed(fill)?;
                Loops::default()
            }
            FillRule::NonZero | FillRule::Positive if mesh.triangles().is_empty() => {
                return Err(MeshError::Empty.into());
            }
            FillRule::NonZero | FillRule::Positive => mesh.loops()?,
        };
        Ok(MeshSolid { placed: Placed::new(mesh, frame, &loops)?, fill })
    }

    /// What is known of a cell that these triangles cut.
    #[inline]
    fn verdict(
        &self,
        surroundings: &mut Surroundings,
        triangles: &[u32],
        at: [i32; 3],
        size: i32,
        part: MeshPart,
    ) -> Verdict<MeshPart> {
        match part.caps {
            Some(_) => self.open_verdict(surroundings, triangles, at, size, part),
            None => self.closed_verdict(part),
        }
    }

    pub(super) fn closed_verdict(&self, part: MeshPart) -> Verdict<MeshPart> {
        if part.count > 0 {
            Verdict::Partial(part)
        } else if self.fill.encloses(part.winding) {
            Verdict::Full
        } else {
            Verdict::Empty
        }
    }

    /// Adds to `steps` by how much a triangle changes the winding number on the ways along x, y and z to the lowest
    /// centres of a cell's children of edge `half`, by the child that the way leads to.
    #[inline]
    fn pierce(
        &self,
        triangle: u32,
        [low, high]: [[i32; 3]; 2],
        at: [i32; 3],
        half: i32,
        steps: &mut [[i32; 8]; 2],
    ) {
        let next = at.map(|a| a + half);
        let spans = |axis: usize, k: i32| low[axis] <= k && k < high[axis];
        // The way along an axis leads from `at` to `next`: it passes the triangle between two ranks.
        let reaches = |axis: usize| low[axis] <= next[axis] && high[axis] > at[axis];
        let mut pierce = |w: usize, u: i32, v: i32, child: usize| {
            let mut seen = Projection::new(&self.placed, triangle, self.placed.corners(triangle), w);
            if let Some(span) = seen.span(v).filter(|span| span.first <= u && u < span.end) {
                let above = seen.above(u, v, span.step);
                if at[w] < above && above <= next[w] {
                    steps[0][child] += span.step;
                    if self.placed.is_cap(triangle) {
                        steps[1][child] += span.step;
                    }
                }
            }
        };
        let [x, y, z] = at;
        if reaches(0) && spans(1, y) && spans(2, z) {
            pierce(0, y, z, 1);
        }
        if reaches(1) && spans(2, z) {
            for (child, x) in [(2, x), (3, next[0])] {
                if spans(0, x) {
                    pierce(1, x, z, child);
                }
            }
        }
        if reaches(2) {
            for (child, x, y) in [(4, x, y), (5, next[0], y), (6, x, next[1]), (7, next[0], next[1])] {
                if spans(0, x) && spans(1, y) {
                    pierce(2, x, y, child);
                }
            }
        }
    }
}

/// How many triangles are looked at together.
const BATCH: usize = 64;

/// The lowest finest cell of `cell`, and its edge in finest cells.
fn extent(cell: Cell, depth: u8) -> ([i32; 3], i32) {
    (cell.first_at(depth).at.map(|a| a as i32), 1 << (depth - cell.level))
}

impl Solid for MeshSolid {
    type Part = MeshPart;
    type Scratch = MeshScratch;

    fn root(&self, scratch: &mut MeshScratch, frame: &Frame) -> Result<Verdict<MeshPart>, Error> {
        if *frame != self.placed.frame {
            return Err(Error::FrameMismatch);
        }
        let first = scratch.triangles.len();
        let count = self.placed.count();
        scratch.triangles.try_reserve(count as usize).map_err(|_| Error::OutOfMemory)?;
        let size = frame.cells() as f64;
        let mut winding = 0;
        for triangle in 0..count {
            let corners = self.placed.corners(triangle);
            // The winding number is zero at infinity: follow the lowest centre's line along x from there.
            let spans = |axis: usize| {
                let (first, end) = ranks(&corners, axis);
                first <= 0 && 0 < end
            };
            if spans(1) && spans(2) && ranks(&corners, 0).0 <= 0 {
                let mut seen = Projection::new(&self.placed, triangle, corners, 0);
                if let Some(span) = seen.span(0).filter(|span| span.first <= 0 && 0 < span.end)
                    && seen.above(0, 0, span.step) <= 0
                {
                    winding += span.step;
                }
            }
            let (min, max) = bounds(&self.placed, &corners);
            let within = (0..3).all(|axis| min[axis] > 0.0 && max[axis] < size);
            if within || Overlap::new(&self.placed, &corners, size, frame.depth()).cuts([0.0; 3], size) {
                scratch.triangles.push(triangle);
            }
        }
        let triangles = &scratch.triangles[first..];
        let caps = if self.placed.caps.is_empty() { None } else { Some(Branch::UNKNOWN) };
        let part = MeshPart { first, count: triangles.len(), winding, caps };
        Ok(self.verdict(&mut scratch.surroundings, triangles, [0; 3], frame.cells() as i32, part))
    }

    fn split(
        &self,
        scratch: &mut MeshScratch,
        cube: &Cube<'_>,
        part: &MeshPart,
    ) -> Result<[Verdict<MeshPart>; 8], Error> {
        let depth = self.placed.frame.depth();
        debug_assert!(cube.cell.level < depth, "finest cells have no children");
        let (at, size) = extent(cube.cell, depth);
        let half = size / 2;
        let height = depth - cube.cell.level - 1;
        let MeshScratch { triangles, masks, surroundings, .. } = scratch;
        let range = part.first..part.first + part.count;

        masks.clear();
        masks.try_reserve(part.count).map_err(|_| Error::OutOfMemory)?;
        let mut counts = [0; 8];
        let mut steps = [[0; 8]; 2];
        let mut boxes = [[[0; 3]; 2]; BATCH];
        for batch in triangles[range].chunks(BATCH) {
            // Memory is slow: many are asked for before the first is looked at.
            for (ranks, &triangle) in boxes.iter_mut().zip(batch) {
                *ranks = self.placed.rank_box(triangle);
            }
            for (&ranks, &triangle) in boxes.iter().zip(batch) {
                self.pierce(triangle, ranks, at, half, &mut steps);
                let mask = match only_child(ranks, at, half) {
                    Some(mask) if self.placed.ranks_tell() && height > 0 => mask,
                    _ => children_cut(&self.placed, &self.placed.corners(triangle), at, half, height),
                };
                masks.push(mask);
                counts.iter_mut().enumerate().for_each(|(k, count)| *count += (mask >> k & 1) as usize);
            }
        }
        let top = triangles.len();
        triangles.try_reserve(counts.iter().sum()).map_err(|_| Error::OutOfMemory)?;
        let mut firsts = [top; 8];
        for k in 1..8 {
            firsts[k] = firsts[k - 1] + counts[k - 1];
        }
        let mut next = firsts;
        triangles.resize(top + counts.iter().sum::<usize>(), 0);
        for (i, &mask) in masks.iter().enumerate() {
            let triangle = triangles[part.first + i];
            let mut left = mask;
            while left != 0 {
                let k = left.trailing_zeros() as usize;
                left &= left - 1;
                triangles[next[k]] = triangle;
                next[k] += 1;
            }
        }
        for steps in &mut steps {
            for child in 2..8 {
                // The way to children 2 and 3 begins at 0 and 1, to 4 … 7 at 0 … 3.
                steps[child] += steps[child - if child < 4 { 2 } else { 4 }];
            }
        }
        let [steps, jumps] = steps;
        let mut verdicts = [Verdict::Undecided; 8];
        for (k, verdict) in verdicts.iter_mut().enumerate() {
            let (first, count) = (firsts[k], counts[k]);
            let at = [0, 1, 2].map(|axis| at[axis] + if k >> axis & 1 != 0 { half } else { 0 });
            let caps = part.caps.map(|branch| branch.plus(jumps[k]));
            let part = MeshPart { first, count, winding: part.winding + steps[k], caps };
            *verdict = self.verdict(surroundings, &triangles[first..first + count], at, half, part);
        }
        Ok(verdicts)
    }

    fn fill(
        &self,
        scratch: &mut MeshScratch,
        cube: &Cube<'_>,
        part: &MeshPart,
        block: &mut Block,
    ) -> Result<bool, Error> {
        if part.caps.is_some() {
            return Ok(false);
        }
        let (at, _) = extent(cube.cell, self.placed.frame.depth());
        let triangles = &scratch.triangles[part.first..part.first + part.count];
        let task = Task { placed: &self.placed, at, triangles, winding: part.winding, fill: self.fill };
        let scan = match &mut scratch.scan {
            Some(scan) => scan,
            none => none.insert(Box::new(Scan::new()?)),
        };
        scan.fill(task, block)?;
        Ok(true)
    }

    fn sample(
        &self,
        scratch: &mut MeshScratch,
        cube: &Cube<'_>,
        part: &MeshPart,
    ) -> Result<Option<bool>, Error> {
        // A finest cell's lowest centre is its only one.
        let (at, _) = extent(cube.cell, self.placed.frame.depth());
        Ok(Some(match part.caps {
            Some(_) => self.open_sample(&mut scratch.surroundings, at, *part),
            None => self.fill.encloses(part.winding),
        }))
    }

    fn exterior(&self, frame: &Frame) -> Tag {
        let (min, max) = self.placed.mesh.bounds();
        let margin = self.placed.mesh.displacement();
        let outward = |x: f64, margin: f64| match margin {
            0.0 => x,
            margin if margin < 0.0 => (x + margin).next_down(),
            margin => (x + margin).next_up(),
        };
        let within = |axis: usize| {
            let (min, max) = (outward(min[axis], -margin), outward(max[axis], margin));
            frame.side(axis, min, 0) >= 0 && frame.side(axis, max, 2 * frame.cells() as i64) <= 0
        };
        if (0..3).all(within) && self.is_quiet_outside() { Tag::Empty } else { Tag::Partial }
    }

    /// Of the mesh and of its lattice, because bounds are computed in finest cells. O(v + t).
    fn fingerprint(&self) -> Option<Fingerprint> {
        let Placed { frame, mesh, .. } = &self.placed;
        let (vertices, triangles) = (mesh.vertices().as_flattened(), mesh.triangles().as_flattened());
        let all = Fingerprinter::new("mesh")
            .integers(&[self.fill as u64, frame.depth().into()])
            .numbers(&frame.origin())
            .numbers(&[frame.edge(), mesh.displacement()])
            .numbers(vertices)
            .words(triangles.len() as u64, triangles.iter().map(|&index| index.into()));
        Some(all.finish())
    }

    fn hand_over(
        &self,
        from: &MeshScratch,
        part: &MeshPart,
        to: &mut MeshScratch,
    ) -> Result<MeshPart, Error> {
        let first = to.triangles.len();
        to.triangles.try_reserve(part.count).map_err(|_| Error::OutOfMemory)?;
        to.triangles.extend_from_slice(&from.triangles[part.first..part.first + part.count]);
        Ok(MeshPart { first, ..*part })
    }
}

/// The child of edge `half` of the cell at `at` in whose interior a triangle lies, if its ranks tell: what
/// [`children_cut`] would find, without a look at the corners.
#[inline(always)]
fn only_child([low, high]: [[i32; 3]; 2], at: [i32; 3], half: i32) -> Option<u8> {
    let mut mask = 0xFFu8;
    for (axis, upper) in [0b1010_1010u8, 0b1100_1100, 0b1111_0000].into_iter().enumerate() {
        let (bottom, middle, top) = (at[axis], at[axis] + half, at[axis] + 2 * half);
        if low[axis] > bottom && high[axis] < middle {
            mask &= !upper;
        } else if low[axis] > middle && high[axis] < top {
            mask &= upper;
        } else {
            return None;
        }
    }
    Some(mask)
}

/// Which of the children of edge `half` of the cell at `at` a triangle cuts.
fn children_cut(placed: &Placed, corners: &Corners, at: [i32; 3], half: i32, height: u8) -> u8 {
    let (min, max) = bounds(placed, corners);
    let mut candidates = 0xFFu8;
    let mut strictly = true;
    for (axis, upper) in [0b1010_1010u8, 0b1100_1100, 0b1111_0000].into_iter().enumerate() {
        let (low, middle, high) = (at[axis] as f64, (at[axis] + half) as f64, (at[axis] + 2 * half) as f64);
        if max[axis] <= middle {
            candidates &= !upper;
            strictly &= min[axis] > low && max[axis] < middle;
        }
        if min[axis] >= middle {
            candidates &= upper;
            strictly &= min[axis] > middle && max[axis] < high;
        }
    }
    // A triangle well inside of the only child that its box reaches needs no further test. (A finest cell gets
    // it all the same: of a triangle without area only the test knows that it cuts nothing.)
    if candidates.count_ones() == 1 && strictly && height > 0 {
        return candidates;
    }
    let overlap = Overlap::new(placed, corners, half as f64, height);
    let mut cut = 0;
    for k in (0..8).filter(|k| candidates >> k & 1 != 0) {
        let corner = [0, 1, 2].map(|axis| (at[axis] + if k >> axis & 1 != 0 { half } else { 0 }) as f64);
        cut |= (overlap.cuts(corner, half as f64) as u8) << k;
    }
    cut
}
