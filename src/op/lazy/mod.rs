//! Octrees that are split on demand.

mod nodes;

use super::build_on;
use super::rule::Rule;
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::{Cell, Cube, Frame, MAX_DEPTH};
use crate::memory;
use crate::octree::{Octree, Statistics, Tag};
use crate::parallel;
use crate::solid::{
    AnyClassifier, AnyWorker, Batch, Classifier, DynSolid, ErasedPart, Parts, Solid, Verdict,
};
use crate::walk;
use crate::walk::{Reach, Trail, Zone};
use alloc::boxed::Box;
use alloc::string::ToString;
use alloc::vec::Vec;
use nodes::{Children, Nodes, Place};

/// The metadata key of the source's fingerprint.
const SOURCE: &str = "source";

/// An octree that is built on demand: a cell is split when an application asks for it, and the octree
/// remembers all splits. (Split on demand: Dai, Zha and Ni 1994, who measure work in splits.)
///
/// All answers are certified: FULL and EMPTY cells are proven, and cells that have not been split yet are
/// PARTIAL. Splitting a cell twice costs nothing. Eight children that turn out EMPTY, or FULL, are merged,
/// and their memory is reused.
///
/// The octree does not keep the parts of cells. To split a cell, it splits the cell's ancestors anew, except
/// those that are also ancestors of the cell that was split last. So memory is 8 to 64 bytes per split. The
/// additional splits are counted separately ([`replays`](Self::replays)); they are few if requests follow
/// each other in space.
///
/// ```
/// use leafless::{Cell, Control, Csg, Frame, LazyOctree, Membership, Tag, op::{Refinement, Zone}};
/// let frame = Frame::new([0.0; 3], 64.0, 20)?; // up to 2^20 cells per axis
/// let mut ball = LazyOctree::new(Csg::ball([32.0; 3], 24.0)?, &frame)?;
/// assert_eq!(ball.tag(Cell::ROOT), Tag::Partial);
///
/// // Is this point inside?
/// let point = [32.0, 32.0, 55.9];
/// ball.refine(&Zone::Point(point), 20, &Control::default())?;
/// assert_eq!(ball.contains(point), Membership::Inside);
/// assert!(ball.splits() <= 20);
///
/// // What is the volume, as far as a thousand splits tell?
/// let control = Control { max_splits: Some(1000), ..Control::default() };
/// assert_eq!(ball.refine(&Zone::Whole, 20, &control)?, Refinement::Spent);
/// let volume = ball.statistics().volume();
/// assert!(volume.contains(4.0 / 3.0 * std::f64::consts::PI * 24.0f64.powi(3)));
/// # Ok::<(), leafless::Error>(())
/// ```
pub struct LazyOctree<'s> {
    solid: Box<dyn DynSolid + 's>,
    classifier: AnyClassifier<'s>,
    nodes: Nodes,
    trail: Trail<AnyWorker<'s>>,
    /// Number of split cells on each level.
    splits: [u64; MAX_DEPTH as usize],
}

/// The way in which a refinement by [`LazyOctree::refine`] ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Refinement {
    /// Every cell of the zone is decided, or as fine as requested, or splitting does not help it.
    Done,
    /// A limit was reached first. A resumed octree may return this value although splitting does not help any
    /// of the remaining cells, because it does not store which cells these are.
    Spent,
}

/// One call of [`LazyOctree::refine`].
struct Run<'c> {
    job: Job<'c>,
    reach: Reach,
    /// The XOR mask that puts octants into visiting order.
    order: u8,
    /// Cells above this level are split.
    level: u8,
    /// The number of splits that may still be made.
    left: u64,
    reports: bool,
}

impl Run<'_> {
    /// Returns whether a limit forbids a further split.
    fn is_spent(&self, nodes: &Nodes) -> bool {
        self.left == 0
            || self.job.control().max_nodes.is_some_and(|most| nodes.count_nodes() >= most)
            || self.job.control().max_bytes.is_some_and(|most| nodes.bytes() + Nodes::BLOCK > most)
    }

    /// Reports a cell of `level` as done.
    fn advance(&self, level: u8) {
        // For finer cells, their ancestor is reported.
        if self.reports && level <= 2 {
            self.job.advance(WHOLE >> (3 * level));
        }
    }
}

impl<'s> LazyOctree<'s> {
    /// Creates an octree of which only the universe is known. No cell will be finer than the frame's depth. A
    /// deep frame costs nothing until its cells are requested.
    ///
    /// # Errors
    /// The errors of putting the solid on this frame, and [`Error::OutOfMemory`].
    pub fn new(solid: impl Solid + 's, frame: &Frame) -> Result<LazyOctree<'s>, Error> {
        let classifier = solid.on(frame, &Control::default())?.erased();
        let trail = Trail::new(classifier.worker()?)?;
        let nodes = Nodes::new(*frame, trail.root(), classifier.exterior(), classifier.proof())?;
        Ok(LazyOctree { solid: Box::new(solid), classifier, nodes, trail, splits: [0; MAX_DEPTH as usize] })
    }

    /// Resumes an octree that [`freeze`](Self::freeze) made from the same solid. `frame` may be deeper than
    /// the octree's. O(n). The limits of `control` apply to the octree's nodes and to the bytes that they
    /// take in memory. Splits are counted from zero.
    ///
    /// The fingerprint identifies the solid. All other contents of the octree are trusted, unless the solid's
    /// splits contradict them when they are replayed.
    ///
    /// # Errors
    /// [`Error::SourceMismatch`] if the octree does not hold the solid's fingerprint, or the solid has
    /// another verdict on the universe; [`Error::Argument`] if the solid has no fingerprint, or the octree is
    /// deeper than the frame; [`Error::FrameMismatch`] if the octree lies on another universe;
    /// [`Error::Damaged`] if it was mapped unverified and its links are damaged; the errors of the solid; and
    /// cancellation or an exceeded limit of `control`.
    pub fn resume(
        octree: &Octree,
        solid: impl Solid + 's,
        frame: &Frame,
        control: &Control<'_>,
    ) -> Result<LazyOctree<'s>, Error> {
        let Some(fingerprint) = solid.fingerprint() else {
            return Err(Error::Argument {
                name: "solid",
                problem: "has no fingerprint, which resuming needs; LazyOctree::new needs none",
            });
        };
        if octree.metadata().get(SOURCE) != Some(&fingerprint.to_string()) {
            return Err(Error::SourceMismatch);
        }
        if octree.frame().depth() > frame.depth() {
            return Err(Error::Argument { name: "frame", problem: "must be at least as deep as the octree" });
        }
        let mut stored = LazyOctree::new(*octree.view(), frame)?;
        let control = &Control { max_splits: None, ..*control };
        if stored.refine(&Zone::Whole, frame.depth(), control)? == Refinement::Spent {
            let nodes = stored.nodes.count_nodes();
            return Err(match (control.max_nodes, control.max_bytes) {
                (Some(limit), _) if nodes >= limit => Error::Limit { what: "nodes", limit },
                (_, limit) => Error::Limit { what: "bytes", limit: limit.unwrap_or(0) },
            });
        }
        let mut resumed = LazyOctree::new(solid, frame)?;
        if !agree(resumed.trail.root(), stored.tag(Cell::ROOT)) {
            return Err(Error::SourceMismatch);
        }
        // Even if the stored octree cannot split a cell, the solid may be able to.
        stored.nodes.forget_hopeless();
        stored.nodes.exterior = resumed.nodes.exterior;
        stored.nodes.proof = stored.nodes.proof.and(resumed.nodes.proof);
        resumed.nodes = stored.nodes;
        Ok(resumed)
    }

    /// The solid of the octree.
    pub fn solid(&self) -> &(dyn DynSolid + 's) {
        &*self.solid
    }

    /// The frame: the place of the octree, and the depth that limits its cells.
    pub fn frame(&self) -> &Frame {
        self.nodes.frame()
    }

    /// Returns whether `cell` is an octant of the universe.
    fn has(&self, cell: Cell) -> bool {
        cell.level <= self.frame().depth() && cell.at.iter().all(|&a| a < 1 << cell.level)
    }

    /// Returns the tag of a cell: BRANCH if the cell was split and its children differ. A cell in a decided
    /// or unsplit cell has the tag of that cell. A cell that does not belong to the frame is PARTIAL.
    /// O(level).
    pub fn tag(&self, cell: Cell) -> Tag {
        if !self.has(cell) {
            return Tag::Partial;
        }
        let (way, level) = self.nodes.way(cell);
        self.nodes.tag(way[level as usize])
    }

    /// Returns whether [`split`](Self::split) would evaluate the solid for this cell: the cell is PARTIAL,
    /// its parent was split, it is above the frame's depth, and the solid has not reported that splitting
    /// does not help. O(level).
    pub fn can_split(&self, cell: Cell) -> bool {
        if !self.has(cell) || cell.level == self.frame().depth() {
            return false;
        }
        let (way, level) = self.nodes.way(cell);
        let place = way[level as usize];
        level == cell.level && self.nodes.tag(place) == Tag::Partial && !self.nodes.is_hopeless(place)
    }

    /// Splits a PARTIAL cell and returns the tags of its children in octant order. If the cell is already
    /// split or decided, or if splitting does not help it, the call costs nothing and returns the known tags.
    ///
    /// # Errors
    /// [`Error::Argument`] if the cell does not belong to the frame, lies at the frame's depth, or in a cell
    /// that has not been split yet; [`Error::SourceMismatch`] if the solid contradicts the octree; the errors
    /// of the solid; [`Error::OutOfMemory`]. After an error the octree is unchanged.
    pub fn split(&mut self, cell: Cell) -> Result<[Tag; 8], Error> {
        let refuse = |problem| Err(Error::Argument { name: "cell", problem });
        if !self.has(cell) {
            return refuse("is none of the frame's");
        }
        if cell.level == self.frame().depth() {
            return refuse("lies at the frame's depth");
        }
        let (way, level) = self.nodes.way(cell);
        let place = way[level as usize];
        Ok(match self.nodes.tag(place) {
            Tag::Branch => self.nodes.children(place).tags(),
            Tag::Partial if !self.nodes.is_hopeless(place) => {
                if level < cell.level {
                    return refuse("lies in a cell that is still to be split");
                }
                let tags = self.split_at(cell, place, &Control::default())?.unwrap_or([Tag::Partial; 8]);
                for (level, &place) in way.iter().enumerate().take(level.into()).rev() {
                    self.nodes.merge(place, level as u8);
                }
                tags
            }
            tag => [tag; 8],
        })
    }

    /// Splits the cells of a zone down to `level` (0 to the frame's depth), where splitting is possible. One
    /// thread does the work. A shape of a host program is split by all threads that `control` allows, level
    /// by level, unless nodes or bytes are limited. A limit of `control` (`max_splits`, or `max_nodes` and
    /// `max_bytes` of everything that the octree then holds) ends the work, not the octree. Coarser cells are
    /// split before finer ones; the cells along a ray are split in the order in which the ray meets them.
    ///
    /// # Errors
    /// [`Error::Argument`] if the zone's numbers are invalid, or `level` is beyond the frame's depth;
    /// [`Error::Cancelled`]; and as [`split`](Self::split). Cells that were split before the error stay
    /// split.
    pub fn refine(&mut self, zone: &Zone, level: u8, control: &Control<'_>) -> Result<Refinement, Error> {
        let frame = *self.frame();
        if level > frame.depth() {
            return Err(Error::Argument { name: "level", problem: "must not be beyond the frame's depth" });
        }
        let reach = match Reach::new(&frame, zone)? {
            Some(reach) if reach.meets(&Cube { frame: &frame, cell: Cell::ROOT }) => reach,
            _ => return Ok(Refinement::Done),
        };
        let limited = [control.max_splits, control.max_nodes, control.max_bytes].iter().any(Option::is_some);
        let direction = reach.order();
        let by_level = limited && direction.is_none();
        let order = direction.unwrap_or(0);
        let left = control.max_splits.unwrap_or(u64::MAX);
        let mut run = Run { job: Job::new(control), reach, order, level, left, reports: true };
        let unlimited = control.max_nodes.is_none() && control.max_bytes.is_none();
        if unlimited && (direction.is_none() || control.max_splits.is_none()) && self.trail.likes_many() {
            // Splits all open cells of a level at once; the walk below then merges the results.
            let done = control.run(true, |parallel| {
                let threads = if parallel { parallel::threads() } else { 1 };
                for above in 0..level {
                    if self.split_level(&mut run, above, threads)? == Refinement::Spent {
                        return Ok(Refinement::Spent);
                    }
                }
                Ok(Refinement::Done)
            });
            if !matches!(done, Ok(Refinement::Done)) {
                self.merge_below(Nodes::ROOT, 0);
                return done;
            }
        } else if by_level {
            run.reports = false;
            for above in 1..level {
                run.level = above;
                if self.nodes.is_undecided_at(above - 1)
                    && self.visit(&mut run, Cell::ROOT, Nodes::ROOT)? == Refinement::Spent
                {
                    return Ok(Refinement::Spent);
                }
            }
            (run.level, run.reports) = (level, true);
        }
        self.visit(&mut run, Cell::ROOT, Nodes::ROOT)
    }

    /// Splits all cells of a level that are open in the zone, up to the limit, with up to `threads` threads.
    fn split_level(&mut self, run: &mut Run<'_>, level: u8, threads: usize) -> Result<Refinement, Error> {
        run.job.check()?;
        let mut open = Vec::new();
        self.collect(run, level, Cell::ROOT, Nodes::ROOT, &mut open)?;
        let done = if open.len() as u64 > run.left { Refinement::Spent } else { Refinement::Done };
        open.truncate(usize::try_from(run.left).unwrap_or(usize::MAX));
        let LazyOctree { classifier, trail, nodes, splits, .. } = self;
        let (worker, asked) = trail.worker();
        let mark = worker.mark();
        let mut cells = memory::with_capacity(open.len())?;
        let mut places = memory::with_capacity(open.len())?;
        for (cell, place) in open {
            // Each part stands alone.
            if let Some(part) = worker.recall(cell) {
                cells.push((cell, part));
                places.push(place);
            }
        }
        let control = run.job.control();
        let ask = |worker: &mut AnyWorker<'s>, cells: &[(Cell, ErasedPart)], verdicts: &mut Vec<_>| {
            worker.split_many(cells, control, verdicts)
        };
        // Answers that arrived before an error are kept.
        let asked_all = walk::each_known(classifier, worker, &cells, threads, ask, |i, verdicts| {
            nodes.open(places[i], level, Children::new(&verdicts))?;
            splits[level as usize] += 1;
            *asked += 1;
            run.left -= 1;
            Ok(())
        });
        worker.release(mark);
        asked_all?;
        Ok(done)
    }

    /// Merges children that agree. The recursion is as deep as the octree.
    fn merge_below(&mut self, place: Place, level: u8) {
        if self.nodes.tag(place) == Tag::Branch {
            for octant in 0..8 {
                self.merge_below(self.nodes.child(place, octant), level + 1);
            }
            self.nodes.merge(place, level);
        }
    }

    /// Appends the cells of a level that are open in the zone. The recursion is as deep as the octree.
    fn collect(
        &self,
        run: &Run<'_>,
        level: u8,
        cell: Cell,
        place: Place,
        open: &mut Vec<(Cell, Place)>,
    ) -> Result<(), Error> {
        match self.nodes.tag(place) {
            Tag::Partial if cell.level == level && !self.nodes.is_hopeless(place) => {
                memory::push(open, (cell, place))?;
            }
            Tag::Branch if cell.level < level => {
                for octant in 0..8 {
                    let octant = octant ^ run.order;
                    let child = cell.child(octant);
                    if run.reach.meets(&Cube { frame: self.nodes.frame(), cell: child }) {
                        self.collect(run, level, child, self.nodes.child(place, octant), open)?;
                    }
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// Refines a cell. The recursion is as deep as the octree, at most twenty levels.
    fn visit(&mut self, run: &mut Run<'_>, cell: Cell, place: Place) -> Result<Refinement, Error> {
        if self.nodes.tag(place) == Tag::Partial && cell.level < run.level && !self.nodes.is_hopeless(place) {
            if run.is_spent(&self.nodes) {
                return Ok(Refinement::Spent);
            }
            run.job.check()?;
            run.left -= self.split_at(cell, place, run.job.control())?.is_some() as u64;
        }
        if self.nodes.tag(place) == Tag::Branch && cell.level + 1 < run.level {
            let done = self.visit_children(run, cell, place);
            self.nodes.merge(place, cell.level);
            if !matches!(done, Ok(Refinement::Done)) || cell.level < 2 {
                return done;
            }
        }
        run.advance(cell.level);
        Ok(Refinement::Done)
    }

    fn visit_children(&mut self, run: &mut Run<'_>, cell: Cell, place: Place) -> Result<Refinement, Error> {
        run.job.check()?;
        for octant in 0..8 {
            let octant = octant ^ run.order;
            let (cell, place) = (cell.child(octant), self.nodes.child(place, octant));
            let is_open = matches!(self.nodes.tag(place), Tag::Partial | Tag::Branch);
            if !is_open || !run.reach.meets(&Cube { frame: self.nodes.frame(), cell }) {
                run.advance(cell.level);
            } else if self.visit(run, cell, place)? == Refinement::Spent {
                return Ok(Refinement::Spent);
            }
        }
        Ok(Refinement::Done)
    }

    /// Splits a PARTIAL cell that is not marked as hopeless. Returns the tags of its children, or `None` if
    /// splitting does not help.
    fn split_at(
        &mut self,
        cell: Cell,
        place: Place,
        control: &Control<'_>,
    ) -> Result<Option<[Tag; 8]>, Error> {
        let at_hand = self.trail.at_hand(cell) as u8;
        let led = self.trail.lead(cell, control);
        self.check(cell, at_hand)?;
        led?;
        let Some(verdicts) = self.trail.verdicts(cell.level) else {
            // The octree is a resumed one, which did not store this fact.
            self.nodes.give_up(place);
            return Ok(None);
        };
        let children = Children::new(verdicts);
        self.nodes.open(place, cell.level, children)?;
        self.splits[cell.level as usize] += 1;
        Ok(Some(children.tags()))
    }

    /// Compares the replayed splits of the ancestors of `cell`, from `level` on, with the octree.
    fn check(&mut self, cell: Cell, level: u8) -> Result<(), Error> {
        if level >= cell.level {
            return Ok(());
        }
        let (way, _) = self.nodes.way(cell);
        for level in level..cell.level {
            let Some(verdicts) = self.trail.verdicts(level) else { break };
            let tags = self.nodes.children(way[level as usize]).tags();
            if !verdicts.iter().zip(tags).all(|(verdict, tag)| agree(verdict, tag)) {
                self.trail.cut(0);
                return Err(Error::SourceMismatch);
            }
        }
        Ok(())
    }

    /// Nodes, cells and certified volumes level by level, without freezing. The volumes are those of the
    /// frozen octree; but here a cell also counts as a node if its eight children are PARTIAL. O(depth).
    pub fn statistics(&self) -> Statistics {
        self.nodes.statistics()
    }

    /// The number of cells that were split, including cells that were merged again. Each cell is counted
    /// once.
    pub fn splits(&self) -> u64 {
        self.splits.iter().sum()
    }

    /// The number of cells of `level` that were split, including cells that were merged again.
    pub fn splits_at(&self, level: u8) -> u64 {
        self.splits.get(level as usize).copied().unwrap_or(0)
    }

    /// The number of splits that were repeated to recompute the parts of cells.
    pub fn replays(&self) -> u64 {
        self.trail.splits().saturating_sub(self.splits())
    }

    /// The memory of the split cells in bytes.
    pub fn bytes(&self) -> u64 {
        self.nodes.bytes()
    }

    /// Returns the octree in its present state: canonical, with unsplit cells PARTIAL. Its fact `source`
    /// holds the solid's fingerprint, if the solid has one. The octree can be [resumed](Self::resume),
    /// whether it was saved or not. O(n).
    ///
    /// # Errors
    /// Cancellation or an exceeded limit of `control`; [`Error::OutOfMemory`].
    pub fn freeze(&self, control: &Control<'_>) -> Result<Octree, Error> {
        let octree = build_on(&&self.nodes, Rule::Certified, control)?;
        let Some(fingerprint) = self.solid.fingerprint() else { return Ok(octree) };
        let mut metadata = octree.metadata().clone();
        metadata.insert(SOURCE, fingerprint.to_string());
        Ok(octree.with_metadata(metadata))
    }
}

/// Returns whether a cell can have this tag in an octree of a solid with this verdict. A cell that can be
/// split may have any tag.
fn agree<P>(verdict: &Verdict<P>, tag: Tag) -> bool {
    matches!(verdict, Verdict::Partial(_)) || verdict.tag() == tag
}
