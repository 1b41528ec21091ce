//! Splitting the cells of a mesh.

use super::boundary::Loops;
use super::crossing::Projection;
use super::overlap::Overlap;
use super::placed::{Corners, Placed, bounds, ranks};
use super::scan::{Scan, Task};
use super::surface::{FillRule, TriangleMesh};
use super::winding::{Local, Range};
use crate::error::{Error, MeshError};
use crate::lattice::exact::floor;
use crate::lattice::{Cell, Cube, Frame, MAX_DEPTH};
use crate::octree::{Block, Tag};
use crate::solid::{Scratch, Solid, Verdict};
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
    placed: Placed,
    fill: FillRule,
}

/// What is remembered of a cell: the triangles that cut it, and the winding number of its lowest centre.
#[derive(Debug, Clone, Copy)]
pub struct MeshPart {
    /// Where the triangles lie in the scratch memory.
    first: usize,
    count: usize,
    /// Of the surface with its caps; without them if that is settled.
    winding: i32,
    /// The caps' own, which is not an integer, is known from its first order around the cell of this level that holds this
    /// one, or not at all; at the lowest centre it is that and this integer.
    level: u8,
    branch: i32,
    /// Whether the surface's winding number in the cell is `winding`, up to less than one half: always if there are no
    /// caps.
    settled: bool,
}

/// Lists of triangles, one for each cell on the way down, and what a block is scanned with.
#[derive(Default)]
pub struct MeshScratch {
    triangles: Vec<u32>,
    /// Bit k: the triangle belongs to child k.
    masks: Vec<u8>,
    /// The caps' winding number around the latest cells.
    locals: Locals,
    scan: Option<Box<Scan>>,
}

/// By level the lower corner of a cell and what is known around its middle.
type Locals = [Option<([i32; 3], Local)>; MAX_DEPTH as usize + 1];

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
        locals: &mut Locals,
        triangles: &[u32],
        at: [i32; 3],
        size: i32,
        part: MeshPart,
    ) -> Verdict<MeshPart> {
        if !part.settled {
            return self.open_verdict(locals, triangles, at, size, part);
        }
        if part.count > 0 {
            Verdict::Partial(part)
        } else if self.fill.encloses(part.winding) {
            Verdict::Full
        } else {
            Verdict::Empty
        }
    }

    /// The same where the caps' winding number is not known to be near one integer.
    #[cold]
    fn open_verdict(
        &self,
        locals: &mut Locals,
        triangles: &[u32],
        at: [i32; 3],
        size: i32,
        mut part: MeshPart,
    ) -> Verdict<MeshPart> {
        let is_cut = triangles.first().is_some_and(|&first| !self.placed.is_cap(first));
        let is_capped = triangles.last().is_some_and(|&last| self.placed.is_cap(last));
        if is_cut && (size == 1 || is_capped) {
            // Only what its parts are can be decided.
            return Verdict::Partial(part);
        }
        let mut is_fresh = false;
        loop {
            let range = self.caps_over(locals, at, size, part);
            let change = range.change + range.doubt;
            if !is_capped {
                let nearest = floor(range.value + 0.5);
                if (range.value - nearest as f64).abs() + change < 0.5 {
                    let winding = part.winding - nearest as i32;
                    let part = MeshPart { winding, settled: true, ..part };
                    return self.verdict(locals, triangles, at, size, part);
                }
            }
            if !is_cut {
                let excess = self.excess(part.winding as f64 - range.value);
                if excess.abs() > change {
                    return if excess > 0.0 { Verdict::Full } else { Verdict::Empty };
                }
            }
            // Also false for NaN.
            let is_sharp = range.doubt <= 0.5 * range.change;
            if is_sharp || is_fresh {
                return Verdict::Partial(part);
            }
            part = self.localised(locals, at, size, part);
            is_fresh = true;
        }
    }

    /// By how much a winding number is inside.
    fn excess(&self, winding: f64) -> f64 {
        match self.fill {
            FillRule::Positive => winding - 0.5,
            FillRule::NonZero | FillRule::EvenOdd => winding.abs() - 0.5,
        }
    }

    fn level(&self, size: i32) -> u8 {
        self.placed.frame.depth() - size.trailing_zeros() as u8
    }

    /// Range of the caps' winding number over a cell, continued from the cell's lowest centre through caps.
    fn caps_over(&self, locals: &mut Locals, at: [i32; 3], size: i32, part: MeshPart) -> Range {
        if part.level == NOWHERE {
            return Range { value: 0.0, change: 0.0, doubt: f64::INFINITY };
        }
        let range = self.local(locals, part.level, at).over(at, size);
        Range { value: range.value + part.branch as f64, ..range }
    }

    /// The same at the lowest centre.
    fn caps_at(&self, locals: &mut Locals, at: [i32; 3], part: MeshPart) -> Range {
        if part.level == NOWHERE {
            return Range { value: 0.0, change: 0.0, doubt: f64::INFINITY };
        }
        let range = self.local(locals, part.level, at).at_centre(at);
        Range { value: range.value + part.branch as f64, ..range }
    }

    /// The caps' winding number around the cell of `level` that holds `at`: a function of that cell alone, kept until the
    /// next cell of the level is asked for.
    fn local(&self, locals: &mut Locals, level: u8, at: [i32; 3]) -> Local {
        let size = 1 << (self.placed.frame.depth() - level);
        let corner = at.map(|a| a & -size);
        match &locals[level as usize] {
            Some((kept, local)) if *kept == corner => *local,
            _ => {
                let middle = corner.map(|a| a as f64 + size as f64 / 2.0);
                let radius = size as f64 * HALF_DIAGONAL;
                // As good as the first order is, or will be in the cells of the finest level.
                let enough = |local: &Local| (local.within(1.0).change / 8.0).min(ENOUGH);
                let cell = (size == 1).then_some(corner);
                let local = self.placed.caps.local(&self.placed, middle, radius, enough, cell);
                locals[level as usize] = Some((corner, local));
                local
            }
        }
    }

    /// The part with the caps' winding number as it is around this cell itself.
    fn localised(&self, locals: &mut Locals, at: [i32; 3], size: i32, part: MeshPart) -> MeshPart {
        let level = self.level(size);
        if size == 1 {
            // Made for the cell's centre, on whose side of the caps it is right.
            return MeshPart { level, branch: 0, ..part };
        }
        let here = self.local(locals, level, at).at_centre(at);
        let mut known = self.caps_at(locals, at, part);
        if !(known.doubt < SURE) {
            let centre = at.map(|a| a as f64 + 0.5);
            known = self.placed.caps.local(&self.placed, centre, 0.0, |_| SURE / 2.0, Some(at)).at_centre(at);
        }
        if known.doubt < SURE && here.doubt < SURE {
            MeshPart { level, branch: floor(known.value - here.value + 0.5) as i32, ..part }
        } else {
            MeshPart { level: NOWHERE, ..part }
        }
    }

    /// Whether the centre of a finest cell is inside.
    fn sampled(&self, locals: &mut Locals, at: [i32; 3], part: MeshPart) -> bool {
        if part.settled {
            return self.fill.encloses(part.winding);
        }
        let mut caps = self.caps_at(locals, at, part);
        let excess = |caps: Range| self.excess(part.winding as f64 - caps.value);
        if !(excess(caps).abs() > caps.doubt) {
            let centre = at.map(|a| a as f64 + 0.5);
            let enough = |local: &Local| excess(local.at_centre(at)).abs();
            caps = self.placed.caps.local(&self.placed, centre, 0.0, enough, Some(at)).at_centre(at);
        }
        excess(caps) >= 0.0
    }

    /// Winding numbers of the lowest centres of a cell's eight children of edge `half`, the cell's own being
    /// that of child 0, and what of the difference caps make.
    fn windings(&self, triangles: &[u32], at: [i32; 3], half: i32, own: i32) -> [[i32; 8]; 2] {
        // What changes on the ways along x, y and z, by the child at whose lowest centre the way begins.
        let mut steps = [[0; 8]; 2];
        let next = at.map(|a| a + half);
        for &triangle in triangles {
            let corners = self.placed.corners(triangle);
            let ranges = [ranks(&corners, 0), ranks(&corners, 1), ranks(&corners, 2)];
            let spans = |axis: usize, k: i32| ranges[axis].0 <= k && k < ranges[axis].1;
            // The way along an axis leads from `at` to `next`: it passes the triangle between two ranks.
            let reaches = |axis: usize| ranges[axis].0 <= next[axis] && ranges[axis].1 > at[axis];
            let mut pierce = |w: usize, u: i32, v: i32, child: usize| {
                let mut seen = Projection::new(&self.placed, triangle, corners, w);
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
        for steps in &mut steps {
            for child in 2..8 {
                // The way to children 2 and 3 begins at 0 and 1, to 4 … 7 at 0 … 3.
                steps[child] += steps[child - if child < 4 { 2 } else { 4 }];
            }
        }
        let [all, caps] = steps;
        [all.map(|step| own + step), caps]
    }
}

impl MeshSolid {
    /// Whether the winding number is proven less than one half in magnitude everywhere outside of the universe, which holds
    /// the whole surface: a harmonic function that vanishes at infinity takes its extremes on the faces.
    fn is_quiet_outside(&self) -> bool {
        let caps = &self.placed.caps;
        if caps.triangles().is_empty() {
            return true;
        }
        let cells = self.placed.frame.cells() as f64;
        let mut evaluations = 0;
        // A square on each face: the face, its lowest corner, its edge.
        let mut squares: Vec<(usize, [f64; 2], f64)> = Vec::new();
        if squares.try_reserve(6 + 3 * QUIET_EVALUATIONS).is_err() {
            return false;
        }
        squares.extend((0..6).map(|face| (face, [0.0; 2], cells)));
        while let Some((face, corner, size)) = squares.pop() {
            let (w, height) = (face / 2, if face % 2 == 0 { 0.0 } else { cells });
            let middle = corner.map(|x| x + size / 2.0);
            let mut point = [height; 3];
            (point[(w + 1) % 3], point[(w + 2) % 3]) = (middle[0], middle[1]);
            let radius = size * core::f64::consts::FRAC_1_SQRT_2;
            let around = caps.local(&self.placed, point, radius, |_| ENOUGH, None);
            let seen = around.within(radius);
            if seen.value.abs() + seen.change + seen.doubt < 0.5 {
                continue;
            }
            evaluations += 1;
            if evaluations > QUIET_EVALUATIONS || !(seen.value.abs() < 0.5) {
                return false;
            }
            for k in 0..4 {
                let step = |bit: usize| if k >> bit & 1 != 0 { size / 2.0 } else { 0.0 };
                squares.push((face, [corner[0] + step(0), corner[1] + step(1)], size / 2.0));
            }
        }
        true
    }
}

/// How many squares of the universe's faces are divided at most to learn what is outside.
const QUIET_EVALUATIONS: usize = 2048;

/// Half the diagonal of a cube of edge 1, rounded up.
const HALF_DIAGONAL: f64 = 0.866_025_404;

/// An error of winding numbers that is of no account.
const ENOUGH: f64 = 1.0 / 256.0;

/// Two winding numbers that are known so well differ by the nearest integer, if they should differ by an integer.
const SURE: f64 = 0.2;

/// In place of a level: nothing is known.
const NOWHERE: u8 = u8::MAX;

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
        let settled = self.placed.caps.triangles().is_empty();
        let part = MeshPart { first, count: triangles.len(), winding, level: NOWHERE, branch: 0, settled };
        Ok(self.verdict(&mut scratch.locals, triangles, [0; 3], frame.cells() as i32, part))
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
        let MeshScratch { triangles, masks, locals, .. } = scratch;
        let range = part.first..part.first + part.count;
        let [windings, jumps] = self.windings(&triangles[range.clone()], at, half, part.winding);

        masks.clear();
        masks.try_reserve(part.count).map_err(|_| Error::OutOfMemory)?;
        let mut counts = [0; 8];
        for &triangle in &triangles[range.clone()] {
            let corners = self.placed.corners(triangle);
            let mask = children_cut(&self.placed, &corners, at, half, height);
            masks.push(mask);
            counts.iter_mut().enumerate().for_each(|(k, count)| *count += (mask >> k & 1) as usize);
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
        Ok([0, 1, 2, 3, 4, 5, 6, 7].map(|k: usize| {
            let (first, count) = (firsts[k], counts[k]);
            let at = [0, 1, 2].map(|axis| at[axis] + if k >> axis & 1 != 0 { half } else { 0 });
            let branch = part.branch + jumps[k];
            let part = MeshPart { first, count, winding: windings[k], branch, ..*part };
            self.verdict(locals, &triangles[first..first + count], at, half, part)
        }))
    }

    fn fill(
        &self,
        scratch: &mut MeshScratch,
        cube: &Cube<'_>,
        part: &MeshPart,
        block: &mut Block,
    ) -> Result<bool, Error> {
        if !part.settled {
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
        Ok(Some(self.sampled(&mut scratch.locals, at, *part)))
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

/// Which of the children of edge `half` of the cell at `at` a triangle cuts.
fn children_cut(placed: &Placed, corners: &Corners<'_>, at: [i32; 3], half: i32, height: u8) -> u8 {
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
