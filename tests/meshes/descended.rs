//! A wrapper that switches block-wise scanning off.

use leafless::solid::{OneByOne, Parts, Question, WholeQuestion};
use leafless::{Cell, Classifier, Control, Error, Frame, MeshSolid, Proof, Solid, Tag, Verdict, Worker};

/// A mesh that is only split and never scanned in blocks.
pub struct Descended<'a>(pub &'a MeshSolid);

type Inner = <MeshSolid as Solid>::Classifier;
type InnerWorker = <Inner as Classifier>::Worker;
type Part = <InnerWorker as Parts>::Part;

/// The wrapper's classifier on a frame.
#[derive(Clone)]
pub struct DescendedOnFrame(Inner);

pub struct DescendedWorker(InnerWorker);

impl Solid for Descended<'_> {
    type Classifier = DescendedOnFrame;
    fn on(&self, frame: &Frame, control: &Control<'_>) -> Result<DescendedOnFrame, Error> {
        Ok(DescendedOnFrame(self.0.on(frame, control)?))
    }
}

impl Classifier for DescendedOnFrame {
    type Worker = DescendedWorker;
    fn frame(&self) -> &Frame {
        self.0.frame()
    }
    fn worker(&self) -> Result<DescendedWorker, Error> {
        Ok(DescendedWorker(self.0.worker()?))
    }
    fn exterior(&self) -> Tag {
        self.0.exterior()
    }
    fn proof(&self) -> Proof {
        self.0.proof()
    }
    fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        Ok(())
    }
}

impl Parts for DescendedWorker {
    type Part = Part;
    fn mark(&self) -> usize {
        self.0.mark()
    }
    fn release(&mut self, mark: usize) {
        self.0.release(mark);
    }
    fn scratch_bytes(&self) -> usize {
        self.0.scratch_bytes()
    }
    fn hand_over(&mut self, from: &Self, part: &Part) -> Result<Part, Error> {
        self.0.hand_over(&from.0, part)
    }
}

impl OneByOne for DescendedWorker {}

impl Worker for DescendedWorker {
    fn frame(&self) -> &Frame {
        self.0.frame()
    }
    fn root(&mut self) -> Result<Verdict<Part>, Error> {
        self.0.root()
    }
    fn split(&mut self, cell: Cell, part: &Part) -> Result<[Verdict<Part>; 8], Error> {
        self.0.split(cell, part)
    }
    fn answer(&mut self, cell: Cell, part: &Part, question: Question<'_>) -> Result<(), Error> {
        match question {
            Question::Centre(_) => self.0.answer(cell, part, question),
            _ => Ok(()),
        }
    }
}
