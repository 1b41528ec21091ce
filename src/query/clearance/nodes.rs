//! The cells of a solid that a search has met.

use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Cell, Cube};
use crate::memory;
use crate::op::gathered::Part;
use crate::query::subject::Subject;
use crate::solid::{Classifier, Verdict, Worker};
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

    /// The least and the greatest coordinates, in finest cells.
    pub(super) fn extent(&self, node: usize) -> ([u32; 3], [u32; 3]) {
        Cube { frame: self.subject.classifier.frame(), cell: self.cell(node) }.planes()
    }
}
