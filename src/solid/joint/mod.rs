//! The intersection of two solids, cell by cell.

mod common;

use super::{
    Ask, Batch, Classifier, Enclosure, OCTANTS, OpenSurfaces, Parts, Question, Verdict, WholeQuestion,
    Worker, surface_cell,
};
use crate::control::Control;
use crate::cut;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, Frame};
use crate::memory;
use crate::octree::{Proof, Tag};
use alloc::sync::Arc;
use alloc::vec::Vec;
use common::{Common, Contacts};

/// The intersection of two solids on one frame.
///
/// A cell is EMPTY where one of the solids is EMPTY. Where one of them is FULL, the cell is as it is in the
/// other. Where both solids are functions of surfaces, their common function is examined: the two sides of a
/// surface that bounds both solids exclude each other, and bounds exclude sides of other surfaces. The cells
/// below depend on that function alone. Where one of the solids has no function, slabs of both may prove that
/// the cell is EMPTY.
#[derive(Clone)]
pub(crate) struct Joint<A, B> {
    a: A,
    b: B,
    common: Option<Arc<Common>>,
}

impl<A: Classifier, B: Classifier> Joint<A, B> {
    /// Builds the intersection. O(surfaces).
    pub(crate) fn new(a: A, b: B, control: &Control<'_>) -> Result<Joint<A, B>, Error> {
        let common = Common::of(&a, &b, control)?.map(Arc::new);
        Ok(Joint { a, b, common })
    }
}

impl<A: Classifier, B: Classifier> Classifier for Joint<A, B> {
    type Worker = JointWorker<A::Worker, B::Worker>;

    fn frame(&self) -> &Frame {
        self.a.frame()
    }

    fn worker(&self) -> Result<Self::Worker, Error> {
        Ok(JointWorker {
            a: self.a.worker()?,
            b: self.b.worker()?,
            common: self.common.clone(),
            contacts: Contacts::default(),
            heights: Vec::new(),
            spared: 0,
        })
    }

    fn exterior(&self) -> Tag {
        match (self.a.exterior(), self.b.exterior()) {
            (Tag::Empty, _) | (_, Tag::Empty) => Tag::Empty,
            (Tag::Full, Tag::Full) => Tag::Full,
            _ => Tag::Partial,
        }
    }

    fn proof(&self) -> Proof {
        self.a.proof().and(self.b.proof())
    }

    fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        Ok(())
    }

    fn kept_bytes(&self) -> u64 {
        let common = self.common.as_ref().map_or(0, |common| common.bytes() as u64);
        self.a.kept_bytes() + self.b.kept_bytes() + common
    }
}

/// The open data of a PARTIAL cell.
#[derive(Clone)]
enum Open<P, Q> {
    /// Both solids; neither is EMPTY, and at least one is PARTIAL.
    Both(Verdict<P>, Verdict<Q>),
    /// The function of surfaces that the intersection is.
    Function(OpenSurfaces),
}

/// A PARTIAL cell of an intersection.
#[derive(Clone)]
pub(crate) struct JointPart<P, Q> {
    open: Open<P, Q>,
    /// The estimated share of the cell that lies in both solids, 0 to 1, from the siblings.
    pub(crate) likely: f64,
}

impl<P, Q> JointPart<P, Q> {
    /// For each of the two solids, whether splitting this cell splits a cell of that solid.
    pub(crate) fn splits(&self) -> [bool; 2] {
        match &self.open {
            Open::Both(a, b) => [matches!(a, Verdict::Partial(_)), matches!(b, Verdict::Partial(_))],
            Open::Function(_) => [true; 2],
        }
    }
}

type PartOf<A, B> = JointPart<<A as Parts>::Part, <B as Parts>::Part>;

pub(crate) struct JointWorker<A, B> {
    a: A,
    b: B,
    common: Option<Arc<Common>>,
    contacts: Contacts,
    /// The heights of both memories before each step.
    heights: Vec<[usize; 2]>,
    /// The number of splits of the second solid that were saved because the first solid is nowhere there.
    pub(crate) spared: u64,
}

impl<A: Worker, B: Worker> Parts for JointWorker<A, B> {
    type Part = PartOf<A, B>;

    fn mark(&self) -> usize {
        self.heights.len()
    }

    fn release(&mut self, mark: usize) {
        if let Some(&[a, b]) = self.heights.get(mark) {
            self.a.release(a);
            self.b.release(b);
            self.heights.truncate(mark);
        }
    }

    fn scratch_bytes(&self) -> usize {
        self.a.scratch_bytes()
            + self.b.scratch_bytes()
            + memory::bytes_of(&self.heights)
            + self.contacts.bytes()
    }

    fn hand_over(&mut self, from: &Self, part: &Self::Part) -> Result<Self::Part, Error> {
        self.step()?;
        let open = match &part.open {
            Open::Both(a, b) => {
                let a = a.clone().try_map(|part| self.a.hand_over(&from.a, &part))?;
                Open::Both(a, b.clone().try_map(|part| self.b.hand_over(&from.b, &part))?)
            }
            Open::Function(known) => Open::Function(*known),
        };
        Ok(JointPart { open, likely: part.likely })
    }
}

impl<A: Worker, B: Worker> Batch for JointWorker<A, B> {
    fn likes_many(&self) -> bool {
        self.a.likes_many() || self.b.likes_many()
    }

    fn split_many(
        &mut self,
        cells: &[(Cell, Self::Part)],
        control: &Control<'_>,
        verdicts: &mut Vec<[Verdict<Self::Part>; 8]>,
    ) -> Result<(), Error> {
        self.step()?;
        let (mut of_a, mut of_b) = (Vec::new(), Vec::new());
        let mut asked = Vec::new();
        for (cell, part) in cells {
            if let Open::Both(Verdict::Partial(part), _) = &part.open {
                memory::push(&mut asked, (*cell, part.clone()))?;
            }
        }
        self.a.split_many(&asked, control, &mut of_a)?;
        let mut of_a = of_a.into_iter();
        // The children by the first solid, and the cells in which the second solid must be split.
        let mut firsts = memory::with_capacity(cells.len())?;
        let mut asked = Vec::new();
        for (cell, part) in cells {
            let Open::Both(a, b) = &part.open else {
                firsts.push(None);
                continue;
            };
            let children = children(a, || of_a.next().ok_or(Error::OutOfMemory))?;
            let is_due = !is_nowhere(&children);
            if let (true, Verdict::Partial(part)) = (is_due, b) {
                memory::push(&mut asked, (*cell, part.clone()))?;
            }
            firsts.push(Some((children, is_due)));
        }
        self.b.split_many(&asked, control, &mut of_b)?;
        let mut of_b = of_b.into_iter();
        verdicts.try_reserve(cells.len())?;
        for ((cell, part), first) in cells.iter().zip(firsts) {
            let met = match (&part.open, first) {
                (Open::Both(_, b), Some((of_a, true))) => {
                    let of_b = children(b, || of_b.next().ok_or(Error::OutOfMemory))?;
                    self.meet_children(*cell, of_a, of_b)?
                }
                (Open::Function(known), _) => self.split_function(*cell, known)?,
                _ => OCTANTS.each(|_| Verdict::Empty),
            };
            verdicts.push(met);
        }
        Ok(())
    }

    fn sample_many(
        &mut self,
        cells: &[(Cell, Self::Part)],
        control: &Control<'_>,
        inside: &mut Vec<Option<bool>>,
    ) -> Result<(), Error> {
        super::sample_one_by_one(self, cells, control, inside)
    }

    fn inside(&mut self, _: &[[f64; 3]], _: &mut [Option<bool>]) -> Result<(), Error> {
        Ok(())
    }

    fn recall(&mut self, _: Cell) -> Option<Self::Part> {
        None
    }
}

impl<A: Worker, B: Worker> Worker for JointWorker<A, B> {
    fn frame(&self) -> &Frame {
        self.a.frame()
    }

    fn root(&mut self) -> Result<Verdict<Self::Part>, Error> {
        self.step()?;
        let a = self.a.root()?;
        if matches!(a, Verdict::Empty) {
            return Ok(Verdict::Empty);
        }
        let b = self.b.root()?;
        self.meet(Cell::ROOT, a, b, 1.0)
    }

    fn split(&mut self, cell: Cell, part: &Self::Part) -> Result<[Verdict<Self::Part>; 8], Error> {
        self.step()?;
        match &part.open {
            Open::Function(known) => self.split_function(cell, known),
            Open::Both(a, b) => {
                let of_a = match a {
                    Verdict::Partial(part) => self.a.split(cell, part)?,
                    a => alike(a),
                };
                if is_nowhere(&of_a) {
                    self.spared += u64::from(matches!(b, Verdict::Partial(_)));
                    return Ok(OCTANTS.each(|_| Verdict::Empty));
                }
                let of_b = match b {
                    Verdict::Partial(part) => self.b.split(cell, part)?,
                    b => alike(b),
                };
                self.meet_children(cell, of_a, of_b)
            }
        }
    }

    fn answer(&mut self, cell: Cell, part: &Self::Part, question: Question<'_>) -> Result<(), Error> {
        match (&part.open, question) {
            // (The common numbers of surfaces belong to no list that a caller has.)
            (_, Question::Surfaces(_) | Question::Layers(_)) => Ok(()),
            (Open::Function(known), question) => match &self.common {
                Some(common) => surface_cell::answer(&common.all, cell, known, question),
                None => Ok(()),
            },
            (Open::Both(Verdict::Partial(part), Verdict::Full), question) => {
                self.a.answer(cell, part, question)
            }
            (Open::Both(Verdict::Full, Verdict::Partial(part)), question) => {
                self.b.answer(cell, part, question)
            }
            (Open::Both(a, b), Question::Centre(inside)) => {
                let of_a = sample(&mut self.a, cell, a)?;
                *inside = match of_a {
                    Some(false) => Some(false),
                    of_a => match (of_a, sample(&mut self.b, cell, b)?) {
                        (_, Some(false)) => Some(false),
                        (Some(true), of_b) => of_b,
                        _ => None,
                    },
                };
                Ok(())
            }
            (Open::Both(a, b), Question::Enclosure(known)) => {
                *known = self.enclosure_of(cell, a, b)?;
                Ok(())
            }
            _ => Ok(()),
        }
    }
}

impl<A: Worker, B: Worker> JointWorker<A, B> {
    /// Records the current heights of the memories.
    fn step(&mut self) -> Result<(), Error> {
        memory::push(&mut self.heights, [self.a.mark(), self.b.mark()])
    }

    fn split_function(
        &mut self,
        cell: Cell,
        known: &OpenSurfaces,
    ) -> Result<[Verdict<PartOf<A, B>>; 8], Error> {
        let Some(common) = &self.common else { return Ok(OCTANTS.each(|_| Verdict::Undecided)) };
        let children = surface_cell::split(&common.all, cell, known)?;
        let mut met = OCTANTS.each(|_| Verdict::Empty);
        for ((k, known), met) in OCTANTS.into_iter().zip(children).zip(&mut met) {
            *met = of_function(common.possible(cell.child(k), &known, &mut self.contacts)?, 1.0);
        }
        let likely = guesses(&met);
        for (met, likely) in met.iter_mut().zip(likely) {
            if let Verdict::Partial(part) = met {
                part.likely = likely;
            }
        }
        Ok(met)
    }

    fn meet_children(
        &mut self,
        cell: Cell,
        of_a: [Verdict<A::Part>; 8],
        of_b: [Verdict<B::Part>; 8],
    ) -> Result<[Verdict<PartOf<A, B>>; 8], Error> {
        let (likely_a, likely_b) = (guesses(&of_a), guesses(&of_b));
        let mut met = OCTANTS.each(|_| Verdict::Empty);
        for ((k, (a, b)), met) in OCTANTS.into_iter().zip(of_a.into_iter().zip(of_b)).zip(&mut met) {
            let likely = likely_a[usize::from(k)] * likely_b[usize::from(k)];
            *met = self.meet(cell.child(k), a, b, likely)?;
        }
        Ok(met)
    }

    /// The verdict on a cell, from the verdicts of both solids.
    fn meet(
        &mut self,
        cell: Cell,
        a: Verdict<A::Part>,
        b: Verdict<B::Part>,
        likely: f64,
    ) -> Result<Verdict<PartOf<A, B>>, Error> {
        match (&a, &b) {
            (Verdict::Empty, _) | (_, Verdict::Empty) => return Ok(Verdict::Empty),
            (Verdict::Full, Verdict::Full) => return Ok(Verdict::Full),
            (Verdict::Partial(of_a), Verdict::Partial(of_b)) => {
                if let Some(common) = &self.common
                    && let Some(known_a) = self.a.surfaces(cell, of_a)?
                    && let Some(known_b) = self.b.surfaces(cell, of_b)?
                    && let Some(both) = common.both(cell, &known_a, &known_b, &mut self.contacts)?
                {
                    return Ok(of_function(both, likely));
                }
                let known = self.enclosure_of(cell, &a, &b)?;
                if known.is_some_and(|known| is_empty(&known)) {
                    return Ok(Verdict::Empty);
                }
            }
            (Verdict::Partial(_), _) | (_, Verdict::Partial(_)) => {}
            _ => return Ok(Verdict::Undecided),
        }
        Ok(Verdict::Partial(JointPart { open: Open::Both(a, b), likely }))
    }

    /// The slabs of both solids.
    fn enclosure_of(
        &mut self,
        cell: Cell,
        a: &Verdict<A::Part>,
        b: &Verdict<B::Part>,
    ) -> Result<Option<Enclosure>, Error> {
        let of_a = enclosure(&mut self.a, cell, a)?;
        let of_b = enclosure(&mut self.b, cell, b)?;
        Ok(Enclosure::of_intersection([of_a, of_b].into_iter().flatten()))
    }
}

/// Returns whether the slabs prove that no point of a cell lies in the solid.
fn is_empty(known: &Enclosure) -> bool {
    cut::reach::upper(known, [1.0, 0.0, 0.0]) == f64::NEG_INFINITY
}

/// The verdict on a cell by its function.
fn of_function<P, Q>(known: OpenSurfaces, likely: f64) -> Verdict<JointPart<P, Q>> {
    match known.settled() {
        Some(true) => Verdict::Full,
        Some(false) => Verdict::Empty,
        None => Verdict::Partial(JointPart { open: Open::Function(known), likely }),
    }
}

/// The enclosure of one solid in a cell; `None` for FULL, which cuts nothing off.
fn enclosure<W: Worker>(
    worker: &mut W,
    cell: Cell,
    verdict: &Verdict<W::Part>,
) -> Result<Option<Option<Enclosure>>, Error> {
    Ok(match verdict {
        Verdict::Full => None,
        Verdict::Partial(part) => Some(worker.enclosure(cell, part)?),
        Verdict::Empty | Verdict::Undecided => Some(None),
    })
}

fn sample<W: Worker>(worker: &mut W, cell: Cell, verdict: &Verdict<W::Part>) -> Result<Option<bool>, Error> {
    Ok(match verdict {
        Verdict::Full => Some(true),
        Verdict::Empty => Some(false),
        Verdict::Partial(part) => worker.sample(cell, part)?,
        Verdict::Undecided => None,
    })
}

/// The verdicts on the children of a cell; for a PARTIAL cell they are those of `split`.
fn children<P>(
    verdict: &Verdict<P>,
    split: impl FnOnce() -> Result<[Verdict<P>; 8], Error>,
) -> Result<[Verdict<P>; 8], Error> {
    match verdict {
        Verdict::Partial(_) => split(),
        decided => Ok(alike(decided)),
    }
}

/// The children of a cell that is not split.
fn alike<P>(verdict: &Verdict<P>) -> [Verdict<P>; 8] {
    match verdict {
        Verdict::Full => [const { Verdict::Full }; 8],
        Verdict::Empty => [const { Verdict::Empty }; 8],
        _ => [const { Verdict::Undecided }; 8],
    }
}

fn is_nowhere<P>(children: &[Verdict<P>; 8]) -> bool {
    children.iter().all(|verdict| matches!(verdict, Verdict::Empty))
}

/// For each of eight siblings, its estimated share in the solid, 0 to 1, from the siblings that share a face
/// with it.
fn guesses<P>(verdicts: &[Verdict<P>; 8]) -> [f64; 8] {
    // A cell that cannot be split further counts as outside, because nothing shows otherwise.
    if verdicts.iter().all(|verdict| matches!(verdict, Verdict::Undecided)) {
        return [0.0; 8];
    }
    let weight = |k: usize| match verdicts[k].tag() {
        Tag::Full => 1.0,
        Tag::Empty => -1.0,
        _ => 0.0,
    };
    [0, 1, 2, 3, 4, 5, 6, 7].each(|k: usize| {
        let around: f64 = [1, 2, 4].iter().map(|axis| weight(k ^ axis)).sum();
        if matches!(verdicts[k], Verdict::Full) { 1.0 } else { (3.5 + around) / 7.0 }
    })
}
