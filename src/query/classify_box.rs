//! The position of a box relative to a solid: inside, outside or across its boundary.

use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::{Ball, Bounds, Cell, Cube, Frame, Window, morton};
use crate::octree::cuts::{CellCut, CellIds, CutsRef, Figure, Head};
use crate::octree::links::Windows;
use crate::octree::view::OctreeRef;
use crate::octree::{Octree, Planes, Tag};
use crate::solid::{AskDirect, AskWhole, BoxContent, Classifier, Direct, DynSolid, OCTANTS, Verdict, Worker};
use crate::walk::Proven;
use crate::walk::{Step, descend};

/// The answer to a box query. Each variant but the last is proven.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Region {
    /// The interiors of box and solid are disjoint.
    Outside = 0,
    /// The box lies in the solid.
    Inside = 1,
    /// Part of the box lies inside, part outside.
    Crossing = 2,
    /// None of the other answers could be proven at the tree's depth.
    Undecided = 3,
}

/// Returns the position of the box `[min, max]` (model units, min ≤ max) relative to a solid, as far as the
/// cells of `frame` determine it. Any part of the box outside of the universe is undecided. The search ends
/// as soon as the answer is known, or once `control.max_splits` cells are split. It uses one thread.
///
/// A mesh answers most boxes in the universe from a tree over its triangles, without cells
/// ([`MeshSolid`](crate::MeshSolid)).
///
/// # Errors
/// [`Error::Argument`] if min > max on an axis, or a coordinate is not a number; the solid's own errors;
/// [`Error::OutOfMemory`] and [`Error::Cancelled`].
///
/// ```
/// use leafless::{Control, Csg, Frame, query::{Region, classify_box}};
/// let (frame, control) = (Frame::new([-2.0; 3], 4.0, 12)?, Control::default());
/// let ball = Csg::ball([0.0; 3], 1.0)?;
/// let ask = |min: [f64; 3], max: [f64; 3]| classify_box(&ball, &frame, min, max, &control);
/// assert_eq!(ask([-0.5; 3], [0.5; 3])?, Region::Inside);
/// assert_eq!(ask([0.6; 3], [1.0; 3])?, Region::Outside);
/// assert_eq!(ask([0.5; 3], [1.0; 3])?, Region::Crossing);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn classify_box(
    solid: &dyn DynSolid,
    frame: &Frame,
    min: [f64; 3],
    max: [f64; 3],
    control: &Control<'_>,
) -> Result<Region, Error> {
    let region = Survey::new(frame, min, max)?;
    let classifier = Proven(solid.on(frame, control)?);
    let Some(mut survey) = region else { return Ok(Region::Undecided) };
    let job = Job::new(control);
    let is_direct = !survey.partial && classifier.is_direct(Direct::Boxes, control)?;
    let mut worker = classifier.worker()?;
    if is_direct
        && let Verdict::Partial(root) = worker.root()?
        && let Some(bounds) = Bounds::new(min, max)
        && let Some(content) = worker.content_of(&root, &bounds)?
    {
        return Ok(match content {
            BoxContent::Empty => Region::Outside,
            BoxContent::Full => Region::Inside,
            BoxContent::Both => Region::Crossing,
        });
    }
    let mut left = control.max_splits.unwrap_or(u64::MAX);
    let mut step = |cell: Cell, verdict| match verdict {
        _ if !survey.window.meets(&Cube { frame, cell }) => Step::Past,
        Verdict::Partial(part) if cell.level < frame.depth() && left > 0 => {
            left -= 1;
            Step::Into(part)
        }
        verdict => {
            survey.note(Planes::uniform(verdict.tag()), 1);
            if survey.empty && survey.full { Step::End } else { Step::Past }
        }
    };
    if let Step::Into(part) = step(Cell::ROOT, worker.root()?) {
        descend(&mut worker, Cell::ROOT, &part, &job, &mut step)?;
    }
    Ok(survey.region())
}

/// A box in finest cells, and the kinds of cells met in it so far.
struct Survey {
    window: Window,
    empty: bool,
    full: bool,
    partial: bool,
}

impl Survey {
    /// Starts a survey; `None` if all of the box lies outside of the universe. A part of the box outside is
    /// undecided.
    fn new(frame: &Frame, min: [f64; 3], max: [f64; 3]) -> Result<Option<Survey>, Error> {
        let found = Window::new(frame, min, max)?;
        Ok(found.map(|(window, partial)| Survey { window, empty: false, full: false, partial }))
    }

    /// Takes in the cells that `mask` selects from 64 cells.
    #[inline]
    fn note(&mut self, planes: Planes, mask: u64) {
        self.empty |= planes.empty() & mask != 0;
        self.full |= planes.full() & mask != 0;
        self.partial |= planes.partial() & mask != 0;
    }

    fn region(&self) -> Region {
        match (self.empty, self.full, self.partial) {
            (true, true, _) => Region::Crossing,
            (true, false, false) => Region::Outside,
            (false, true, false) => Region::Inside,
            _ => Region::Undecided,
        }
    }
}

impl OctreeRef<'_> {
    /// Returns the position of the box `[min, max]` (model units, min ≤ max) relative to the solid. Any part
    /// of the box outside of the universe is undecided. The search ends as soon as the answer is known. No
    /// element is read twice, whatever the bytes. Cuts decide in place, each by at most 64 boxes: a box that
    /// touches a surface, or comes very near to a surface, may be undecided.
    ///
    /// # Errors
    /// [`Error::Argument`] if min > max on an axis, or a coordinate is not a number.
    pub fn classify_box(&self, min: [f64; 3], max: [f64; 3]) -> Result<Region, Error> {
        let Some(survey) = Survey::new(&self.frame, min, max)? else { return Ok(Region::Undecided) };
        let records = self.cuts.as_ref().map_or(0, |cuts| cuts.heads.len());
        let mut search =
            Search { tree: self, survey, windows: Windows::new(self), asked: [min, max], records };
        match (self.root, &self.cuts) {
            (Tag::Branch, _) => search.element(0, 0, [0; 3]),
            (Tag::Partial, Some(cuts)) => search.cut(cuts, CutsRef::ROOT, Cell::ROOT),
            (tag, _) => search.survey.note(Planes::uniform(tag), 1),
        }
        Ok(search.survey.region())
    }
}

/// The descent in a stored tree.
struct Search<'t, 'a> {
    tree: &'t OctreeRef<'a>,
    survey: Survey,
    windows: Windows,
    /// The box, in model units.
    asked: [[f64; 3]; 2],
    /// The number of records that may still be visited: in a damaged tree several cells may lead to one
    /// record.
    records: usize,
}

/// The maximal number of pieces that a box is divided into in a cell with a table.
const MOST_PIECES: usize = 64;

impl Search<'_, '_> {
    /// Visits the part of element `index` of level `e` that lies in the box; `origin` is the element's lowest
    /// finest cell. The recursion is as deep as the tree has element levels, ten at the most.
    fn element(&mut self, e: usize, index: usize, origin: [u32; 3]) {
        let levels = self.tree.levels();
        let Some(planes) = self.tree.entry(index) else {
            self.survey.partial = true;
            return;
        };
        let shift = 2 * (levels - 1 - e);
        let mut mask = !0;
        for (axis, &start) in origin.iter().enumerate() {
            let end = start + (4 << shift) - 1;
            let first = self.survey.window.first[axis].max(start) - start;
            let last = self.survey.window.last[axis].min(end) - start;
            mask &= morton::slabs(axis, first >> shift, last >> shift);
        }
        match &self.tree.cuts {
            Some(cuts) => self.cuts_of(cuts, e, index, planes, mask, origin),
            None => self.survey.note(planes, mask),
        }
        let mut branches = planes.branch() & mask;
        while branches != 0 && !(self.survey.empty && self.survey.full) {
            let c = branches.trailing_zeros();
            branches &= branches - 1;
            match self.windows.child(self.tree, index, planes.branch(), c, (e + 1).min(levels - 1)) {
                Ok(child) if e + 1 < levels => {
                    let at = morton::position(c);
                    self.element(e + 1, child, axes(|axis| origin[axis] + (at[axis] << shift)));
                }
                _ => self.survey.partial = true,
            }
        }
    }
}

impl Search<'_, '_> {
    /// Visits the PARTIAL cells of an element that `mask` selects.
    fn cuts_of(
        &mut self,
        cuts: &CutsRef<'_>,
        e: usize,
        index: usize,
        planes: Planes,
        mask: u64,
        origin: [u32; 3],
    ) {
        let partial = planes.partial() & mask;
        self.survey.note(planes, mask & !partial);
        let (level, depth) = (self.tree.cell_level(e), self.tree.frame.depth());
        for octant in 0..8 {
            let own = (partial >> (8 * octant)) as u8;
            // An octant that is PARTIAL as a whole has one cut.
            let whole = planes.octant(octant) == Tag::Partial;
            for k in (0..8).filter(|k| if whole { *k == 0 && own != 0 } else { own >> k & 1 != 0 }) {
                if self.survey.empty && self.survey.full {
                    return;
                }
                let (c, level) = (8 * octant + k, level - u8::from(whole));
                let at = morton::position(c);
                let finest = axes(|axis| origin[axis] + (at[axis] << (depth - self.tree.cell_level(e))));
                let cell = Cell { level, at: finest.each(|a| a >> (depth - level)) };
                self.cut(cuts, cuts.record(index, planes, c), cell);
            }
        }
    }

    /// Visits a PARTIAL cell. The recursion is as deep as the frame.
    fn cut(&mut self, cuts: &CutsRef<'_>, record: usize, cell: Cell) {
        let depth = self.tree.frame.depth();
        self.records = self.records.saturating_sub(1);
        match cuts.at(record) {
            CellCut::Table { ids, table } => self.table(cuts, &ids, table, cell),
            CellCut::Split(first) if cell.level < depth && self.records > 0 => {
                for k in OCTANTS {
                    let child = cell.child(k);
                    let is_met = self.survey.window.meets(&Cube { frame: &self.tree.frame, cell: child });
                    if is_met && !(self.survey.empty && self.survey.full) {
                        self.cut(cuts, first + usize::from(k), child);
                    }
                }
            }
            _ => self.survey.partial = true,
        }
    }

    /// Visits the part of the box that lies in a cell with a table. The part is divided into pieces;
    /// undecided pieces are halved.
    fn table(&mut self, cuts: &CutsRef<'_>, ids: &CellIds, table: u8, cell: Cell) {
        let mut figures = [None; 3];
        for (figure, &id) in figures.iter_mut().zip(ids.iter()) {
            *figure = Figure::new(&cuts.surfaces, id);
        }
        let frame = &self.tree.frame;
        let (lower, upper) = Cube { frame, cell }.planes();
        let (mut low, mut high, mut slack) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        for axis in 0..3 {
            let [first, last] = [lower[axis], upper[axis]].each(|i| frame.plane(axis, i));
            low[axis] = first.lower.max(self.asked[0][axis]);
            high[axis] = last.upper.min(self.asked[1][axis]).max(low[axis]);
            // The part of the box in the cell certainly meets a piece thicker than this.
            slack[axis] = 64.0 * f64::EPSILON * (low[axis].abs() + high[axis].abs());
        }
        let mut waiting = [([0.0; 3], [0.0; 3], 0); MOST_PIECES];
        waiting[0] = (low, high, table);
        let (mut next, mut made) = (0, 1);
        while next < made && !(self.survey.empty && self.survey.full) {
            let (low, high, mut table) = waiting[next];
            next += 1;
            let centre = axes(|axis| 0.5 * low[axis] + 0.5 * high[axis]);
            let radius =
                axes(|axis| (high[axis] - centre[axis]).max(centre[axis] - low[axis]) * (1.0 + f64::EPSILON));
            for (i, figure) in figures.iter().enumerate().filter(|_| centre.iter().all(|c| c.is_finite())) {
                if let (true, Some(figure)) = (Head::needs(table, i), figure)
                    && let Some(side) = figure.side(centre.each(Ball::exactly), radius)
                {
                    table = Head::on_side(table, i, side);
                }
            }
            let widths = axes(|axis| high[axis] - low[axis]);
            let longest = (0..3).fold(0, |best, axis| if widths[axis] > widths[best] { axis } else { best });
            match Head(table) {
                Head::NOWHERE => self.survey.empty = true,
                Head::EVERYWHERE => self.survey.full = true,
                _ if made + 2 <= MOST_PIECES && widths[longest] > slack[longest] => {
                    let (mut below, mut above) = (high, low);
                    (below[longest], above[longest]) = (centre[longest], centre[longest]);
                    waiting[made] = (low, below, table);
                    waiting[made + 1] = (above, high, table);
                    made += 2;
                }
                _ => self.survey.partial = true,
            }
        }
    }
}

impl Octree {
    /// Returns the position of a box relative to the solid. See [`OctreeRef::classify_box`] for the full
    /// contract.
    ///
    /// # Errors
    /// As [`OctreeRef::classify_box`].
    pub fn classify_box(&self, min: [f64; 3], max: [f64; 3]) -> Result<Region, Error> {
        self.view().classify_box(min, max)
    }
}
