//! The split of a cell by its words, and the words that each child keeps.

use super::Program;
use super::at_hand::AtHand;
use super::hierarchy::Taken;
use super::kleene::Kleene;
use super::word::{Op, Word};
use crate::error::Error;
use crate::lattice::Cell;
use crate::lattice::Each;
use crate::memory;
use crate::octree::Tag;
use crate::solid::ErasedPart;
use crate::solid::csg::Join;
use crate::solid::half_space::bounds::Octants;
use crate::solid::half_space::points;
use crate::solid::half_space::table;
use crate::solid::half_space::table::Table;
use crate::solid::{AnyWorker, Batch, Classifier, OCTANTS, Parts, Verdict, Worker};
use alloc::vec::Vec;

/// The state of a cell for a [`Csg`](crate::solid::csg::Csg): the words of the expression that are still open
/// in the cell.
#[derive(Debug, Clone, Copy)]
pub struct CsgPart {
    pub(crate) start: u32,
    pub(crate) len: u32,
}

impl CsgPart {
    /// The part of a cell that cannot be split.
    const HOPELESS: CsgPart = CsgPart { start: 0, len: 0 };

    /// A flag in the length: the part has that number of words of half-spaces, each with its number in the
    /// table, followed by the two halves of a truth table.
    const TABLE: u32 = 1 << 31;

    /// The number of words of the part.
    #[inline(always)]
    pub(crate) fn words(self) -> usize {
        match self.len & CsgPart::TABLE {
            0 => self.len as usize,
            _ => (self.len & !CsgPart::TABLE) as usize + 2,
        }
    }

    #[inline(always)]
    pub(crate) fn is_table(self) -> bool {
        self.len & CsgPart::TABLE != 0
    }
}

/// Scratch memory of a [`Csg`](crate::solid::csg::Csg).
#[derive(Default)]
pub(crate) struct Scratch {
    pub(crate) words: Vec<Word>,
    /// Parts of other solids that words refer to. Their numbers follow those of the universe's parts.
    pub(crate) slots: Vec<Slot>,
    /// One worker for each other solid, made on first use.
    pub(crate) workers: Vec<Option<Other>>,
    pub(crate) evaluations: u64,
    /// The state of the current split: the verdicts by each word, the verdicts of the waiting operands, the
    /// answers of other solids, and the operands of a child.
    masks: Vec<Kleene>,
    pub(crate) operands: Vec<Kleene>,
    answers: Vec<Answer>,
    open: Vec<Operand>,
    /// Parts of another solid that are being copied in or out.
    pub(crate) passing: Vec<(u8, ErasedPart)>,
    pub(crate) at_hand: AtHand,
}

/// A worker on another solid, and its part of the universe.
pub(crate) struct Other {
    pub(crate) worker: AnyWorker<'static>,
    pub(crate) root: Verdict<ErasedPart>,
}

/// A cell's part of another solid.
#[derive(Clone, Copy)]
pub(crate) struct Slot {
    pub(crate) solid: u32,
    pub(crate) part: ErasedPart,
    /// The number of words when the words of the slot's cell were begun, and the height of the solid's own
    /// scratch memory before. Once the cell's words are complete, there are more words.
    pub(crate) words: usize,
    pub(crate) height: usize,
}

/// The answer of another solid for eight cells, and the height of its scratch memory before.
struct Answer {
    solid: u32,
    height: usize,
    verdicts: [Verdict<ErasedPart>; 8],
}

/// The verdicts of eight cells, and the parts of the PARTIAL ones.
pub(crate) struct Cells {
    pub(crate) kleene: Kleene,
    pub(crate) parts: [CsgPart; 8],
}

impl Cells {
    fn set(&mut self, k: u32, tag: Tag) {
        let bit = 1 << k;
        self.kleene.lower = self.kleene.lower & !bit | (tag.lower() as u8) << k;
        self.kleene.upper = self.kleene.upper & !bit | (tag.upper() as u8) << k;
    }
}

/// An operand while the words of a child are written: decided in the child, or written from a word on.
#[derive(Clone, Copy)]
enum Operand {
    Decided(bool),
    Open(usize),
}

/// The outcome of writing a child's words.
enum Reduced {
    Decided(bool),
    Part(CsgPart),
}

/// The target of a query: the universe, or the children of a cell.
#[derive(Clone, Copy)]
pub(crate) enum Ask {
    Root,
    Split(Cell),
}

impl Ask {
    #[inline(always)]
    fn octants(self) -> Octants {
        match self {
            Ask::Root => Octants::of_universe(),
            Ask::Split(cell) => Octants::of(cell),
        }
    }
}

impl Scratch {
    /// Makes empty scratch memory for a program.
    pub(crate) fn new(program: &Program) -> Result<Scratch, Error> {
        let mut scratch = Scratch::default();
        scratch.workers.try_reserve_exact(program.solids.len())?;
        scratch.workers.resize_with(program.solids.len(), || None);
        Ok(scratch)
    }

    pub(crate) fn mark(&self) -> usize {
        self.words.len()
    }

    /// The bytes of the parts, and of the other solids' parts.
    pub(crate) fn bytes(&self) -> usize {
        let others = self.workers.iter().flatten().map(|other| other.worker.scratch_bytes()).sum::<usize>();
        size_of_val(&*self.words) + size_of_val(&*self.slots) + others
    }

    pub(crate) fn release(&mut self, mark: usize) {
        self.words.truncate(mark);
        while let Some(slot) = self.slots.pop_if(|slot| slot.words >= mark) {
            if let Some(other) = &mut self.workers[slot.solid as usize] {
                other.worker.release(slot.height);
            }
        }
    }

    /// Computes the verdict of the universe from the words of the whole program. The open words remain as its
    /// part.
    pub(crate) fn begin(&mut self, program: &Program) -> Result<Verdict<CsgPart>, Error> {
        let len = u32::try_from(program.words.len()).map_err(|_| Error::OutOfMemory)?;
        let cells = self.cells(program, CsgPart { start: 0, len }, Ask::Root)?;
        Ok(cells.kleene.verdict(0, cells.parts[0]))
    }

    /// Returns the words that are open in the universe, with which a program replaces its own words.
    pub(crate) fn into_words(self, program: &Program, part: CsgPart) -> Result<(Vec<Word>, CsgPart), Error> {
        let mut words = memory::with_capacity(part.words())?;
        words.extend_from_slice(Scratch::list(program, &self.words, part));
        Ok((words, CsgPart { start: 0, ..part }))
    }

    /// Returns the words of a part. The universe's words are the program's, the others lie in the scratch
    /// memory.
    #[inline(always)]
    pub(crate) fn list<'w>(program: &'w Program, words: &'w [Word], part: CsgPart) -> &'w [Word] {
        match (part.start as usize).checked_sub(program.words.len()) {
            None => &program.words[part.start as usize..part.start as usize + part.words()],
            Some(start) => &words[start..start + part.words()],
        }
    }

    /// Returns the word of a part with one word.
    #[inline(always)]
    fn only_word(&self, program: &Program, part: CsgPart) -> Word {
        let start = part.start as usize;
        match program.words.get(start) {
            Some(&word) => word,
            None => self.words[start - program.words.len()],
        }
    }

    /// The place where the next part begins.
    pub(crate) fn start(&self, program: &Program) -> Result<u32, Error> {
        u32::try_from(program.words.len() + self.words.len()).map_err(|_| Error::OutOfMemory)
    }

    /// Returns the worker on a solid, made on first use.
    pub(crate) fn other<'w>(
        workers: &'w mut [Option<Other>],
        program: &Program,
        solid: u32,
    ) -> Result<&'w mut Other, Error> {
        let other = &mut workers[solid as usize];
        Ok(match other {
            Some(other) => other,
            none => {
                let mut worker = program.solids[solid as usize].worker()?;
                let known = if program.recalls.get(solid as usize) == Some(&true) {
                    worker.recall(Cell::ROOT)
                } else {
                    None
                };
                let root = match known {
                    Some(part) => Verdict::Partial(part),
                    None => worker.root()?,
                };
                none.insert(Other { worker, root })
            }
        })
    }

    /// Splits a cell of another solid, or takes the answer at hand. Also returns the height of the solid's
    /// scratch memory before.
    pub(crate) fn split_other(
        workers: &mut [Option<Other>],
        at_hand: &mut AtHand,
        program: &Program,
        solid: u32,
        cell: Cell,
        part: &ErasedPart,
    ) -> Result<(usize, [Verdict<ErasedPart>; 8]), Error> {
        if let Some(known) = at_hand.split(solid) {
            return Ok(known);
        }
        let worker = &mut Scratch::other(workers, program, solid)?.worker;
        let height = worker.mark();
        Ok((height, worker.split(cell, part)?))
    }

    /// Returns the solid and the part for an index in a word.
    #[inline]
    pub(crate) fn slot(&mut self, program: &Program, index: u32) -> Result<Option<(u32, ErasedPart)>, Error> {
        match (index as usize).checked_sub(program.solids.len()) {
            Some(slot) => Ok(Some((self.slots[slot].solid, self.slots[slot].part))),
            None => Ok(match Scratch::other(&mut self.workers, program, index)?.root {
                Verdict::Partial(part) => Some((index, part)),
                _ => None,
            }),
        }
    }

    /// Keeps a slot, and returns its index, which fits into a word.
    pub(crate) fn keep(&mut self, program: &Program, slot: Slot) -> Result<u32, Error> {
        let index = u32::try_from(program.solids.len() + self.slots.len()).ok();
        memory::push(&mut self.slots, slot)?;
        index.filter(|&index| index <= Word::MOST).ok_or(Error::OutOfMemory)
    }

    /// Copies a part with everything that it refers to from another scratch memory.
    pub(crate) fn copy(
        &mut self,
        program: &Program,
        from: &Scratch,
        part: CsgPart,
    ) -> Result<CsgPart, Error> {
        if (part.start as usize) < program.words.len() {
            return Ok(part);
        }
        let start = self.start(program)?;
        let words = Scratch::list(program, &from.words, part);
        self.words.try_reserve(words.len())?;
        if part.is_table() {
            self.words.extend_from_slice(words);
            return Ok(CsgPart { start, ..part });
        }
        for word in words {
            let word = match word.op() {
                Op::Solid { index, complement } if index as usize >= program.solids.len() => {
                    let Slot { solid, part, .. } = from.slots[index as usize - program.solids.len()];
                    let Some(source) = &from.workers[solid as usize] else {
                        unreachable!("a part has a worker that made it");
                    };
                    let target = &mut Scratch::other(&mut self.workers, program, solid)?.worker;
                    let height = target.mark();
                    let part = target.hand_over(&source.worker, &part)?;
                    let index = self.keep(program, Slot { solid, part, words: self.words.len(), height })?;
                    Word::new(Op::Solid { index, complement })
                }
                _ => *word,
            };
            self.words.push(word);
        }
        Ok(CsgPart { start, ..part })
    }

    /// Returns the children of a cell, from the words of its part.
    #[inline]
    pub(crate) fn split(
        &mut self,
        program: &Program,
        cell: Cell,
        part: CsgPart,
    ) -> Result<[Verdict<CsgPart>; 8], Error> {
        if self.may_be_lone(program, part)
            && let Some(verdicts) = self.lone8(program, cell, part)?
        {
            return Ok(verdicts);
        }
        let cells = self.cells(program, part, Ask::Split(cell))?;
        Ok(OCTANTS.each(|k| cells.kleene.verdict(k.into(), cells.parts[k as usize])))
    }

    /// Returns the eight cells of the query, from the words of a part.
    #[inline(always)]
    pub(crate) fn cells(&mut self, program: &Program, part: CsgPart, ask: Ask) -> Result<Cells, Error> {
        // Most cells are cut by one half-space, and their children share its word.
        if part.len == 1
            && !program.paper
            && let Op::HalfSpace { index, complement } = self.only_word(program, part).op()
        {
            let half_space = &program.half_spaces[index as usize];
            let sides = half_space.sides(&ask.octants(), 0xFF, &mut self.evaluations)?;
            return Ok(Cells { kleene: Kleene::of(sides, complement), parts: [part; 8] });
        }
        if part.is_table() {
            return self.cells_by_table(program, part, ask);
        }
        self.cells_by_words(program, part, ask)
    }

    #[inline(never)]
    fn cells_by_words(&mut self, program: &Program, part: CsgPart, ask: Ask) -> Result<Cells, Error> {
        let at = ask.octants();
        let (kleene, somewhere) = self.verdicts(program, part, ask)?;
        let mut cells = Cells { kleene, parts: [CsgPart::HOPELESS; 8] };
        let open = kleene.partial() & at.all();
        let list = Scratch::list(program, &self.words, part);
        let grouped = list.iter().any(|word| matches!(word.op(), Op::Group { .. }));
        for k in (0..8).filter(|k| open >> k & 1 != 0) {
            let (words, slots) = (self.words.len(), self.slots.len());
            if !grouped && self.answers.is_empty() && somewhere >> k & 1 == 0 {
                cells.parts[k as usize] = part;
                if let Ask::Root = ask {
                    self.tabulate(program, &mut cells, k, false)?;
                }
                continue;
            }
            match self.reduced(program, part, &at, k)? {
                Reduced::Decided(inside) => cells.set(k, if inside { Tag::Full } else { Tag::Empty }),
                Reduced::Part(part) => {
                    cells.parts[k as usize] = part;
                    self.tabulate(program, &mut cells, k, true)?;
                }
            }
            // A child without words has no slots, because they would be released as slots of words after its
            // siblings. The other solids' memory for it is released with the siblings' or the parent's.
            if self.words.len() == words {
                self.slots.truncate(slots);
            }
        }
        Ok(cells)
    }

    /// Replaces the words of child `k` by a truth table, if it has few half-spaces and no other operands. If
    /// the table is constant, the child is decided. `fresh` means that the words are the last ones, and
    /// belong to this child alone.
    fn tabulate(&mut self, program: &Program, cells: &mut Cells, k: u32, fresh: bool) -> Result<(), Error> {
        let part = cells.parts[k as usize];
        if part.len < 2 || part.len > 64 || program.paper {
            return Ok(());
        }
        let mut variables = [0; table::MOST];
        let mut count = 0;
        let mut stack = [Table::EMPTY; 64];
        let mut top = 0;
        for word in Scratch::list(program, &self.words, part) {
            let value = match word.op() {
                Op::HalfSpace { index, complement } => {
                    let known = variables[..count].iter().position(|&variable| variable == index);
                    let i = match known {
                        Some(i) => i,
                        None if count == table::MOST => return Ok(()),
                        None => {
                            variables[count] = index;
                            count += 1;
                            count - 1
                        }
                    };
                    Table::of(i, complement)
                }
                Op::Join { join, complement, count } => {
                    let first = top - count as usize;
                    let operands = stack[first..top].iter().map(|table| table.0);
                    let joined = match join {
                        Join::Intersection => operands.fold(!0, |all, one| all & one),
                        Join::Union => operands.fold(0, |all, one| all | one),
                        Join::Parity => operands.fold(0, |all, one| all ^ one),
                    };
                    top = first;
                    Table(if complement { !joined } else { joined })
                }
                _ => return Ok(()),
            };
            stack[top] = value;
            top += 1;
        }
        if fresh {
            self.words.truncate(self.words.len() - part.words());
        }
        self.put_table(program, cells, k, &variables[..count], stack[0])
    }

    /// Writes a truth table of half-spaces as the part of child `k`, or decides the child.
    fn put_table(
        &mut self,
        program: &Program,
        cells: &mut Cells,
        k: u32,
        half_spaces: &[u32],
        table: Table,
    ) -> Result<(), Error> {
        if table == Table::EMPTY || table == Table::FULL {
            cells.set(k, if table == Table::FULL { Tag::Full } else { Tag::Empty });
            return Ok(());
        }
        let start = self.start(program)?;
        self.words.try_reserve(half_spaces.len() + 2)?;
        let (mut count, mut last) = (0, 0);
        for (i, &index) in half_spaces.iter().enumerate().filter(|(i, _)| table.depends_on(*i)) {
            self.words.push(Word::of_variable(i, index));
            (count, last) = (count + 1, i);
        }
        cells.parts[k as usize] = if count == 1 {
            // A half-space, or its complement.
            let word = Word::new(Op::HalfSpace {
                index: half_spaces[last],
                complement: table != Table::of(last, false),
            });
            if let Some(only) = self.words.last_mut() {
                *only = word;
            }
            CsgPart { start, len: 1 }
        } else {
            self.words.extend([Word::raw(table.0 as u32), Word::raw((table.0 >> 32) as u32)]);
            CsgPart { start, len: count | CsgPart::TABLE }
        };
        Ok(())
    }

    /// Returns the half-spaces and the truth table of a part. Each half-space has its number in the table.
    #[inline(always)]
    pub(crate) fn table_of(words: &[Word]) -> (&[Word], Table) {
        let (half_spaces, halves) = words.split_at(words.len() - 2);
        (half_spaces, Table(halves[0].bits() as u64 | (halves[1].bits() as u64) << 32))
    }

    #[inline(never)]
    fn cells_by_table(&mut self, program: &Program, part: CsgPart, ask: Ask) -> Result<Cells, Error> {
        let at = ask.octants();
        let Scratch { words, evaluations, .. } = self;
        let (half_spaces, table) = Scratch::table_of(Scratch::list(program, words, part));
        let mut tables = [table; 8];
        let mut somewhere = 0;
        let mut indices = [0; table::MOST];
        for word in half_spaces {
            let (i, index) = word.variable();
            indices[i] = index;
            let sides = program.half_spaces[index as usize].sides(&at, 0xFF, evaluations)?;
            somewhere |= sides.inside | sides.outside;
            for (k, table) in (0..).zip(&mut tables) {
                *table = table.known(i, sides, k);
            }
        }
        let mut cells = Cells { kleene: Kleene::UNKNOWN, parts: [part; 8] };
        for k in (0..8).filter(|k| somewhere >> k & 1 != 0) {
            self.put_table(program, &mut cells, k, &indices, tables[k as usize])?;
        }
        Ok(cells)
    }

    /// Returns the verdicts of the eight cells, and in which cells a word is decided. The verdicts by each
    /// word are kept.
    fn verdicts(&mut self, program: &Program, part: CsgPart, ask: Ask) -> Result<(Kleene, u8), Error> {
        let at = &ask.octants();
        let Scratch { words, masks, operands, answers, workers, slots, evaluations, at_hand, .. } = self;
        let words = Scratch::list(program, words, part);
        masks.clear();
        operands.clear();
        answers.clear();
        masks.try_reserve(words.len())?;
        operands.try_reserve(words.len())?;
        let mut somewhere = 0;
        for (i, word) in words.iter().enumerate() {
            let kleene = match word.op() {
                // The primitive classifies its half-spaces.
                Op::HalfSpace { .. } if program.paper => Kleene::UNKNOWN,
                Op::HalfSpace { index, complement } => {
                    Kleene::of(program.half_spaces[index as usize].sides(at, 0xFF, evaluations)?, complement)
                }
                Op::Solid { index, complement } => {
                    let slot = (index as usize).checked_sub(program.solids.len());
                    let (solid, part) = match slot {
                        Some(slot) => (slots[slot].solid, Verdict::Partial(slots[slot].part)),
                        None => (index, Scratch::other(workers, program, index)?.root),
                    };
                    let (height, verdicts) = match (ask, part) {
                        (Ask::Split(cell), Verdict::Partial(part)) => {
                            Scratch::split_other(workers, at_hand, program, solid, cell, &part)?
                        }
                        (_, verdict) => {
                            (Scratch::other(workers, program, solid)?.worker.mark(), [verdict; 8])
                        }
                    };
                    let answer = Answer { solid, height, verdicts };
                    let kleene = Kleene::of_tags(answer.verdicts.each(|verdict| verdict.tag()));
                    memory::push(answers, answer)?;
                    kleene.complemented(complement)
                }
                Op::Unknown => Kleene::UNKNOWN,
                Op::Join { join, complement, count } => {
                    Kleene::join_last(operands, join, count).complemented(complement)
                }
                Op::Group { index } => program.groups.kleene(index as usize, at),
                Op::Primitive { count } => {
                    let first = i - count as usize;
                    operands.truncate(operands.len() - count as usize);
                    primitive_by_paper(program, &words[first..i], at, evaluations)?
                }
            };
            somewhere |= kleene.decided();
            masks.push(kleene);
            operands.push(kleene);
        }
        Ok((operands.pop().unwrap_or(Kleene::UNKNOWN), somewhere))
    }

    /// Writes the words that are open in child `k`, and returns the child's part.
    fn reduced(&mut self, program: &Program, part: CsgPart, at: &Octants, k: u32) -> Result<Reduced, Error> {
        let start = self.words.len();
        let begin = self.start(program)?;
        let bit = 1u8 << k;
        let corners = at.octant(k);
        // Whether the child's own children are finest cells.
        let finest = 0.5 * at.half <= 1.0 / program.frame.cells() as f64;
        self.open.clear();
        self.open.try_reserve(part.words())?;
        self.words.try_reserve(part.words())?;
        let (mut answers, mut hopeful) = (0, false);
        for i in 0..self.masks.len() {
            let op = Scratch::list(program, &self.words, part)[i].op();
            let kleene = self.masks[i];
            let mut first = self.words.len();
            let emitted = match op {
                Op::HalfSpace { .. } => {
                    hopeful |= kleene.decided() & bit == 0;
                    Some(op)
                }
                Op::Unknown => Some(op),
                Op::Group { .. } if kleene.decided() & bit != 0 => None,
                Op::Group { index } => {
                    hopeful = true;
                    match program.groups.take_apart(index as usize, corners, finest, &mut self.words)? {
                        Taken::Written => self.open.push(Operand::Open(first)),
                        Taken::Nothing => {
                            self.open.push(Operand::Decided(program.groups.neutral(index as usize)))
                        }
                    }
                    continue;
                }
                Op::Solid { complement, .. } => {
                    let Answer { solid, height, verdicts } = self.answers[answers];
                    answers += 1;
                    Some(match verdicts[k as usize] {
                        Verdict::Partial(part) => {
                            let index = if at.half == 1.0 {
                                // The universe's part is available to all.
                                solid
                            } else {
                                self.keep(program, Slot { solid, part, words: start, height })?
                            };
                            hopeful = true;
                            Op::Solid { index, complement }
                        }
                        _ => Op::Unknown,
                    })
                }
                Op::Join { count, .. } | Op::Primitive { count } => {
                    let operands = self.open.len() - count as usize;
                    let (mut open, mut parity, mut absorbed) = (0, false, false);
                    let absorbs = op.absorbs();
                    for operand in self.open.drain(operands..) {
                        match operand {
                            Operand::Open(from) => (first, open) = (first.min(from), open + 1),
                            Operand::Decided(value) => {
                                parity ^= value;
                                absorbed |= absorbs == Some(value);
                            }
                        }
                    }
                    // Groups that turned out empty may decide an operation that was open.
                    if let Some(value) = op.decided(open, parity, absorbed) {
                        self.words.truncate(first);
                        self.open.push(Operand::Decided(value));
                        continue;
                    }
                    op.of_open(open, parity)
                }
            };
            if kleene.decided() & bit != 0 {
                self.words.truncate(first);
                self.open.push(Operand::Decided(kleene.lower & bit != 0));
            } else {
                self.words.try_reserve(1)?;
                self.words.extend(emitted.map(Word::new));
                self.open.push(Operand::Open(first));
            }
        }
        if let Some(&Operand::Decided(inside)) = self.open.last() {
            return Ok(Reduced::Decided(inside));
        }
        if !hopeful {
            return Ok(Reduced::Part(CsgPart::HOPELESS));
        }
        // More words than this take seventeen gigabytes.
        let len = u32::try_from(self.words.len() - start).ok().filter(|&len| len < CsgPart::TABLE);
        Ok(Reduced::Part(CsgPart { start: begin, len: len.ok_or(Error::OutOfMemory)? }))
    }
}

/// Classifies a primitive by the published method: first the vertices of the children, where a vertex on the
/// surface is inside; then, half-space by half-space, the children whose vertices agree.
fn primitive_by_paper(
    program: &Program,
    words: &[Word],
    at: &Octants,
    evaluations: &mut u64,
) -> Result<Kleene, Error> {
    let half_spaces = || {
        words.iter().filter_map(|word| match word.op() {
            Op::HalfSpace { index, .. } => Some(&program.half_spaces[index as usize]),
            _ => None,
        })
    };
    let (inner, outer) = points::vertices(at, at.all(), |t| {
        let mut inside = Some(true);
        for half_space in half_spaces() {
            *evaluations += 1;
            match half_space.sign_at(t)? {
                Some(sign) if sign < 0 => return Ok(Some(false)),
                Some(_) => {}
                None => inside = None,
            }
        }
        Ok(inside)
    })?;
    let (black, white) = (!outer, !inner);
    let (mut inside, mut outside) = (0xFF, 0);
    if black | white != 0 {
        for half_space in half_spaces() {
            let sides = half_space.sides(at, black | white, evaluations)?;
            inside &= sides.inside;
            outside |= sides.outside;
        }
    }
    Ok(Kleene { lower: black & inside, upper: !(white & outside) })
}

impl Kleene {
    #[inline(always)]
    pub(crate) fn verdict(self, k: u32, part: CsgPart) -> Verdict<CsgPart> {
        match (self.lower >> k & 1 != 0, self.upper >> k & 1 != 0) {
            (true, _) => Verdict::Full,
            (_, false) => Verdict::Empty,
            _ if part.len == 0 => Verdict::Undecided,
            _ => Verdict::Partial(part),
        }
    }
}
