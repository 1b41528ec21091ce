//! Octrees that are split where and when somebody asks.

mod nodes;

use super::build_on;
use super::rule::Rule;
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::{Cell, Cube, Frame, MAX_DEPTH};
use crate::memory;
use crate::octree::{Octree, Statistics, Tag};
use crate::parallel;
use crate::solid::{Batch, Classifier, PartOf, Parts, Solid, Verdict, WorkerOf};
use crate::walk;
use crate::walk::{Reach, Trail, Zone};
use alloc::string::ToString;
use alloc::vec::Vec;
use nodes::{Children, Nodes, Place};

/// Key of the fact that holds the fingerprint of what a tree was made from.
const SOURCE: &str = "source";

/// An octree of a solid that is not built in one go: a cell is split when an application asks for it, and
/// what was split is remembered. (Split on demand: Dai, Zha and Ni 1994, who count its work in splits.)
///
/// All that is known is certified: FULL and EMPTY cells are proven, and cells that nobody has split yet are
/// PARTIAL. Splitting a cell twice costs nothing. Eight children that turn out EMPTY, or FULL, are merged,
/// and their memory is used again.
///
/// The parts of cells are not kept: to split a cell, its ancestors are split anew, but for those that are
/// also ancestors of the cell that was split last. So memory is 8 to 64 bytes a split, and the work beyond
/// the splits that were asked for, which is counted apart, is small where these follow each other in space.
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
pub struct LazyOctree<S: Solid> {
    solid: S,
    classifier: S::Classifier,
    nodes: Nodes,
    trail: Trail<WorkerOf<S>>,
    /// Cells of each level that were split.
    splits: [u64; MAX_DEPTH as usize],
}

/// How a refinement by [`LazyOctree::refine`] ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Refinement {
    /// Every cell of the zone is decided, as fine as was asked for, or one that splitting does not help.
    Done,
    /// A limit was reached first. A resumed octree may say so although all that is left are cells that
    /// splitting does not help: it forgot which those are.
    Spent,
}

/// One call of [`LazyOctree::refine`].
struct Run<'c> {
    job: Job<'c>,
    reach: Reach,
    /// What octants are changed by to come in their order.
    order: u8,
    /// Cells above this level are split.
    level: u8,
    /// Splits that may still be made.
    left: u64,
    reports: bool,
}

impl Run<'_> {
    /// Whether a limit forbids a further split.
    fn is_spent(&self, nodes: &Nodes) -> bool {
        self.left == 0
            || self.job.control().max_nodes.is_some_and(|most| nodes.count_nodes() >= most)
            || self.job.control().max_bytes.is_some_and(|most| nodes.bytes() + Nodes::BLOCK > most)
    }

    /// Reports a cell of `level` as done.
    fn advance(&self, level: u8) {
        // Of finer cells the ancestor is reported.
        if self.reports && level <= 2 {
            self.job.advance(WHOLE >> (3 * level));
        }
    }
}

impl<S: Solid> LazyOctree<S> {
    /// An octree of which only the universe is known. No cell will ever be finer than the frame's depth,
    /// which costs nothing until they are asked for.
    ///
    /// # Errors
    /// If the solid cannot be had in this frame, or memory runs out.
    pub fn new(solid: S, frame: &Frame) -> Result<LazyOctree<S>, Error> {
        let classifier = solid.on(frame, &Control::default())?;
        let trail = Trail::new(classifier.worker()?)?;
        let nodes = Nodes::new(*frame, trail.root(), classifier.exterior(), classifier.proof())?;
        Ok(LazyOctree { solid, classifier, nodes, trail, splits: [0; MAX_DEPTH as usize] })
    }

    /// Takes up an octree that [`freeze`](Self::freeze) made of the same solid. `frame` may be deeper than
    /// the octree's. O(n); the limits of `control` concern the octree's nodes and the bytes that they take
    /// here. Splits are counted from zero.
    ///
    /// That the solid is the same one is known by its fingerprint. Whatever else the octree holds is
    /// believed, as far as the solid's splits, when they are replayed, do not contradict it.
    ///
    /// # Errors
    /// [`Error::SourceMismatch`] if the octree does not hold the solid's fingerprint, or the universe is
    /// something else to the solid; [`Error::Argument`] if the solid has no fingerprint, or the octree is
    /// deeper than the frame; [`Error::FrameMismatch`] if it lies on another universe; [`Error::Damaged`] if
    /// it was mapped unverified and its links are damaged; what the solid refuses; and what `control` asks
    /// for.
    pub fn resume(
        octree: &Octree,
        solid: S,
        frame: &Frame,
        control: &Control<'_>,
    ) -> Result<LazyOctree<S>, Error> {
        let Some(fingerprint) = solid.fingerprint() else {
            return Err(Error::Argument {
                name: "solid",
                problem: "has no fingerprint to know it by; new begins without",
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
        // That the stored octree knows no more of a cell does not mean that the solid does not.
        stored.nodes.forget_hopeless();
        stored.nodes.exterior = resumed.nodes.exterior;
        stored.nodes.proof = stored.nodes.proof.and(resumed.nodes.proof);
        resumed.nodes = stored.nodes;
        Ok(resumed)
    }

    /// What the octree is of.
    pub fn solid(&self) -> &S {
        &self.solid
    }

    /// Where it lies, and how fine its cells may become.
    pub fn frame(&self) -> &Frame {
        self.nodes.frame()
    }

    /// Whether `cell` is an octant of the universe.
    fn has(&self, cell: Cell) -> bool {
        cell.level <= self.frame().depth() && cell.at.iter().all(|&a| a < 1 << cell.level)
    }

    /// What is known of a cell: BRANCH if it was split and its children differ. In a cell that is decided, or
    /// was not split yet, there are only cells like it. PARTIAL of a cell that is none of the frame's.
    /// O(level).
    pub fn tag(&self, cell: Cell) -> Tag {
        if !self.has(cell) {
            return Tag::Partial;
        }
        let (way, level) = self.nodes.way(cell);
        self.nodes.tag(way[level as usize])
    }

    /// Whether [`split`](Self::split) would ask the solid about this cell: it is PARTIAL, its parent was
    /// split, it is above the frame's depth, and the solid did not say that splitting does not help.
    /// O(level).
    pub fn can_split(&self, cell: Cell) -> bool {
        if !self.has(cell) || cell.level == self.frame().depth() {
            return false;
        }
        let (way, level) = self.nodes.way(cell);
        let place = way[level as usize];
        level == cell.level && self.nodes.tag(place) == Tag::Partial && !self.nodes.is_hopeless(place)
    }

    /// Splits a PARTIAL cell: the tags of its children in octant order. A cell that was split before, is
    /// decided, or that splitting does not help costs nothing, and the answer is what is known.
    ///
    /// # Errors
    /// [`Error::Argument`] if the cell is none of the frame's, lies at its depth, or in a cell that is still
    /// to be split; [`Error::SourceMismatch`] if the solid contradicts what the octree holds; what the solid
    /// refuses; [`Error::OutOfMemory`]. The octree stays as it was.
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

    /// Splits the cells of a zone down to `level` (0 to the frame's depth), those that can be. One thread
    /// does it; of a host program's shape all threads that `control` allows, level by level, unless nodes or
    /// bytes are limited. Where `control` has a limit (`max_splits`, `max_nodes` and `max_bytes` of all that
    /// the octree then holds), that ends the work, not the octree, and coarser cells are split before finer
    /// ones; those of a ray as it meets them.
    ///
    /// # Errors
    /// [`Error::Argument`] if the zone's numbers are not as they must be, or `level` is beyond the frame's
    /// depth; [`Error::Cancelled`]; and as [`split`](Self::split). What was split before stays so.
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
            // All that is open on a level at once; what the walk below then finds is to be merged.
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

    /// Splits all cells of a level that are open in the zone, as many as may be, by as many threads as may
    /// be.
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
        let ask = |worker: &mut WorkerOf<S>, cells: &[(Cell, PartOf<S>)], verdicts: &mut Vec<_>| {
            worker.split_many(cells, control, verdicts)
        };
        // Of what was asked before an error nothing is lost.
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

    /// Merges what agrees. The recursion is as deep as the octree.
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

    /// Refines a cell. The recursion is as deep as the octree, twenty levels at the most.
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

    /// Splits a PARTIAL cell of which it is not known that this does not help: the tags of its children, or
    /// `None` if it does not.
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
            // The octree is a resumed one, which forgot it.
            self.nodes.give_up(place);
            return Ok(None);
        };
        let children = Children::new(verdicts);
        self.nodes.open(place, cell.level, children)?;
        self.splits[cell.level as usize] += 1;
        Ok(Some(children.tags()))
    }

    /// Compares the splits of the ancestors of `cell` from `level` on, which were replayed, with what the
    /// octree holds.
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
    /// frozen octree; but a cell counts as a node here also if its eight children are PARTIAL. O(depth).
    pub fn statistics(&self) -> Statistics {
        self.nodes.statistics()
    }

    /// Cells that were split, as it happened: also those that were merged again. Nothing is counted twice.
    pub fn splits(&self) -> u64 {
        self.splits.iter().sum()
    }

    /// Cells of `level` that were split, as it happened.
    pub fn splits_at(&self, level: u8) -> u64 {
        self.splits.get(level as usize).copied().unwrap_or(0)
    }

    /// Splits that the solid was asked for anew, to have the parts of cells again.
    pub fn replays(&self) -> u64 {
        self.trail.splits().saturating_sub(self.splits())
    }

    /// Bytes that the split cells take.
    pub fn bytes(&self) -> u64 {
        self.nodes.bytes()
    }

    /// The octree as it is now: canonical, and what is not split is PARTIAL. As a fact under `source` it
    /// holds the solid's fingerprint, if there is one: saved or not, it can be [resumed](Self::resume). O(n).
    ///
    /// # Errors
    /// What `control` asks for; [`Error::OutOfMemory`].
    pub fn freeze(&self, control: &Control<'_>) -> Result<Octree, Error> {
        let octree = build_on(&&self.nodes, Rule::Certified, control)?;
        let Some(fingerprint) = self.solid.fingerprint() else { return Ok(octree) };
        let mut metadata = octree.metadata().clone();
        metadata.insert(SOURCE, fingerprint.to_string());
        Ok(octree.with_metadata(metadata))
    }
}

/// Whether a cell can have this tag in an octree of the solid whose verdict this is: in what can be split,
/// anything may have come out.
fn agree<P>(verdict: &Verdict<P>, tag: Tag) -> bool {
    matches!(verdict, Verdict::Partial(_)) || verdict.tag() == tag
}
