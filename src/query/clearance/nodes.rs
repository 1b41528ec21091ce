//! The cells of a solid that a search has met.

use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::{Cell, Cube, MAX_DEPTH};
use crate::memory;
use crate::solid::{Classifier, Verdict, Worker};
use crate::walk::Part;
use crate::walk::Subject;
use alloc::vec::Vec;
use core::ops::Range;

/// What is known of a cell.
pub(super) enum Known<P> {
    /// What the solid says of it.
    Whole(Verdict<P>),
    /// Split, into those nodes that are not EMPTY.
    Split(Range<usize>),
}

/// A solid's cells that are not EMPTY, each split once at the most.
pub(super) struct Nodes<'s, C: Classifier> {
    pub(super) subject: Subject<'s, C>,
    pub(super) nodes: Vec<(Cell, Known<Part<C>>)>,
}

impl<'s, C: Classifier> Nodes<'s, C> {
    /// The universe, unless it is EMPTY.
    pub(super) fn new(classifier: &'s C, control: &'s Control<'s>) -> Result<Self, Error> {
        let mut nodes = Nodes { subject: Subject::new(classifier, control)?, nodes: Vec::new() };
        let root = nodes.subject.worker.root()?;
        nodes.add(Cell::ROOT, root)?;
        Ok(nodes)
    }

    fn add(&mut self, cell: Cell, verdict: Verdict<Part<C>>) -> Result<(), Error> {
        let is_finest = cell.level == self.subject.classifier.frame().depth();
        let known = match verdict {
            Verdict::Empty => return Ok(()),
            Verdict::Partial(_) if is_finest => Verdict::Undecided,
            verdict => verdict,
        };
        memory::push(&mut self.nodes, (cell, Known::Whole(known)))
    }

    pub(super) fn is_full(&self, node: usize) -> bool {
        matches!(self.nodes[node].1, Known::Whole(Verdict::Full))
    }

    /// Whether there are finer cells.
    pub(super) fn can_be_split(&self, node: usize) -> bool {
        matches!(self.nodes[node].1, Known::Whole(Verdict::Partial(_)) | Known::Split(_))
    }

    /// The children of a node that can be split; those of no other.
    pub(super) fn children(&mut self, node: usize) -> Result<Range<usize>, Error> {
        if let (cell, Known::Whole(Verdict::Partial(part))) = &self.nodes[node] {
            let cell = *cell;
            let children = self.subject.split(cell, part)?;
            let first = self.nodes.len();
            for (octant, child) in (0..8).zip(children) {
                self.add(cell.child(octant), child)?;
            }
            self.nodes[node].1 = Known::Split(first..self.nodes.len());
        }
        Ok(match &self.nodes[node].1 {
            Known::Split(children) => children.clone(),
            Known::Whole(_) => 0..0,
        })
    }

    pub(super) fn cell(&self, node: usize) -> Cell {
        self.nodes[node].0
    }

    /// Whether no cell of the solid is left: it is proven to be empty, if all of them were looked at.
    pub(super) fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The first FULL cell that turns up, for `budget` splits at the most; what was split does not cost any.
    ///
    /// The largest open cell and one of the smallest are split by turns: large FULL cells are found by going
    /// through the coarse levels, which a thin wall has none on, and thin walls by going down, where a solid's
    /// sharp edge would hold the search up.
    pub(super) fn find_full(&mut self, budget: &mut u64, job: &Job<'_>) -> Result<Option<usize>, Error> {
        let mut open: Vec<Vec<usize>> = memory::filled(MAX_DEPTH as usize + 1, Vec::new())?;
        if !self.is_empty() {
            memory::push(&mut open[0], 0)?;
        }
        for turn in 0u64.. {
            job.check()?;
            let mut levels = open.iter_mut().filter(|level| !level.is_empty());
            let level = if turn % 2 == 0 { levels.next() } else { levels.next_back() };
            let Some(node) = level.and_then(Vec::pop) else { break };
            if self.is_full(node) {
                return Ok(Some(node));
            }
            if matches!(self.nodes[node].1, Known::Whole(Verdict::Partial(_))) {
                let Some(left) = budget.checked_sub(1).filter(|_| !self.subject.takes(4)) else { break };
                *budget = left;
            }
            for child in self.children(node)? {
                if self.is_full(child) {
                    return Ok(Some(child));
                }
                if self.can_be_split(child) {
                    memory::push(&mut open[self.cell(child).level as usize], child)?;
                }
            }
        }
        Ok(None)
    }

    /// The least and the greatest coordinates, in finest cells.
    pub(super) fn extent(&self, node: usize) -> ([u32; 3], [u32; 3]) {
        Cube { frame: self.subject.classifier.frame(), cell: self.cell(node) }.planes()
    }
}
