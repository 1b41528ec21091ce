//! What a cell's words say of its children, and the words that each child keeps.

use super::bounds::{Octants, centre};
use super::kleene::Kleene;
use super::program::{Op, Program, Word, push};
use super::{Join, points};
use crate::error::Error;
use crate::lattice::{Cube, Frame};
use crate::solid::{ErasedPart, ErasedScratch, Scratch, Solid, Verdict};
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::ops::Range;

/// What a [`Csg`](super::Csg) remembers about a cell: the words of its expression that are still open there.
#[derive(Debug, Clone, Copy)]
pub struct CsgPart {
    start: u32,
    pub(super) len: u32,
}

impl CsgPart {
    /// Of a cell that cannot be split.
    const HOPELESS: CsgPart = CsgPart { start: 0, len: 0 };

    fn range(self) -> Range<usize> {
        self.start as usize..self.start as usize + self.len as usize
    }
}

/// Scratch memory of a [`Csg`](super::Csg).
#[derive(Default)]
pub struct CsgScratch {
    program: Option<Arc<Program>>,
    words: Vec<Word>,
    /// Parts of other solids that words refer to.
    slots: Vec<Slot>,
    /// One for each other solid.
    scratches: Vec<ErasedScratch>,
    evaluations: u64,
    /// Of the split under way: verdicts by each word, those of the operands that wait, what other solids answered, and
    /// the operands of a child.
    masks: Vec<Kleene>,
    operands: Vec<Kleene>,
    answers: Vec<Answer>,
    open: Vec<Operand>,
}

/// A cell's part of another solid.
#[derive(Clone, Copy)]
struct Slot {
    solid: u32,
    part: ErasedPart,
    /// The number of words when its cell's were begun (words may be taken back until the cell's are complete, and then
    /// there are more), and the height of the solid's own scratch memory before.
    words: usize,
    height: usize,
}

impl Slot {
    /// Keeps a slot; returns its index, which a word can hold.
    fn keep(slots: &mut Vec<Slot>, slot: Slot) -> Result<u32, Error> {
        let index = u32::try_from(slots.len()).ok().filter(|&index| index <= Word::MOST);
        push(slots, slot)?;
        index.ok_or(Error::OutOfMemory)
    }
}

/// What another solid says of eight cells, and the height of its scratch memory before.
struct Answer {
    solid: u32,
    height: usize,
    verdicts: [Verdict<ErasedPart>; 8],
}

/// Eight cells: their verdicts and the parts of those that are PARTIAL.
pub(super) struct Cells {
    pub(super) kleene: Kleene,
    pub(super) parts: [CsgPart; 8],
}

/// An operand while the words of a child are written: decided there, or written from a word on.
#[derive(Clone, Copy)]
enum Operand {
    Decided(bool),
    Open(usize),
}

impl Scratch for CsgScratch {
    fn mark(&self) -> usize {
        self.words.len()
    }

    fn release(&mut self, mark: usize) {
        self.words.truncate(mark);
        while let Some(slot) = self.slots.pop_if(|slot| slot.words >= mark) {
            if let Some(scratch) = self.scratches.get_mut(slot.solid as usize) {
                scratch.release(slot.height);
            }
        }
    }

    fn evaluations(&self) -> u64 {
        self.scratches.iter().fold(self.evaluations, |sum, scratch| sum + scratch.evaluations())
    }
}

/// What is asked of the other solids: about the universe, or about the children of a cell.
#[derive(Clone, Copy)]
pub(super) enum Ask<'q, 'f> {
    Root(&'q Frame),
    Split(&'q Cube<'f>),
}

impl CsgScratch {
    /// Runs `work` with the program at hand; `None` if there is none.
    #[inline(always)]
    pub(super) fn with_program<T>(
        &mut self,
        work: impl FnOnce(&mut CsgScratch, &Program) -> Result<T, Error>,
    ) -> Result<Option<T>, Error> {
        // Taken out for the time, since a shared count costs more than a split.
        let Some(program) = self.program.take() else { return Ok(None) };
        let result = work(self, &program);
        self.program = Some(program);
        result.map(Some)
    }

    fn reset(&mut self) {
        self.words.clear();
        self.slots.clear();
        // What the others counted stays counted.
        self.evaluations = self.evaluations();
        self.scratches.clear();
    }

    /// Begins with a program: the first of the cells is the universe.
    pub(super) fn begin(&mut self, program: Program, frame: &Frame) -> Result<Cells, Error> {
        self.reset();
        self.scratches.try_reserve(program.solids.len()).map_err(|_| Error::OutOfMemory)?;
        self.scratches.resize_with(program.solids.len(), ErasedScratch::default);
        self.words.try_reserve(program.words.len()).map_err(|_| Error::OutOfMemory)?;
        self.words.extend_from_slice(&program.words);
        let part =
            CsgPart { start: 0, len: u32::try_from(program.words.len()).map_err(|_| Error::OutOfMemory)? };
        let cells = self.cells(&program, part, &Octants::of_universe(), Ask::Root(frame))?;
        self.program = Some(Arc::new(program));
        Ok(cells)
    }

    /// Copies a part with what it refers to out of another scratch memory.
    pub(super) fn copy(&mut self, from: &CsgScratch, part: CsgPart) -> Result<CsgPart, Error> {
        let Some(program) = &from.program else { return Ok(CsgPart::HOPELESS) };
        // Parts of another root mean nothing beside these.
        if !self.program.as_ref().is_some_and(|own| Arc::ptr_eq(own, program)) {
            self.reset();
            self.program = Some(program.clone());
        }
        if self.scratches.len() < from.scratches.len() {
            let missing = from.scratches.len() - self.scratches.len();
            self.scratches.try_reserve(missing).map_err(|_| Error::OutOfMemory)?;
            self.scratches.resize_with(from.scratches.len(), ErasedScratch::default);
        }
        let start = u32::try_from(self.words.len()).map_err(|_| Error::OutOfMemory)?;
        let words = from.words.get(part.range()).unwrap_or(&[]);
        self.words.try_reserve(words.len()).map_err(|_| Error::OutOfMemory)?;
        for word in words {
            let word = match word.op() {
                Op::Solid { index, complement } => {
                    let Slot { solid, part, .. } = from.slots[index as usize];
                    let (source, target) = (solid as usize, &mut self.scratches[solid as usize]);
                    let height = target.mark();
                    let part = program.solids[source].hand_over(&from.scratches[source], &part, target)?;
                    let slot = Slot { solid, part, words: self.words.len(), height };
                    let index = Slot::keep(&mut self.slots, slot)?;
                    Word::new(Op::Solid { index, complement })
                }
                _ => *word,
            };
            self.words.push(word);
        }
        Ok(CsgPart { start, len: part.len })
    }

    /// The eight cells `at`, by the words of a part.
    #[inline(always)]
    pub(super) fn cells(
        &mut self,
        program: &Program,
        part: CsgPart,
        at: &Octants,
        ask: Ask<'_, '_>,
    ) -> Result<Cells, Error> {
        // Most cells are cut by one half-space: they share its word.
        if part.len == 1
            && !program.paper
            && let Some(Op::HalfSpace { index, complement }) =
                self.words.get(part.start as usize).map(|word| word.op())
        {
            let half_space = &program.half_spaces[index as usize];
            let sides = half_space.sides(at, 0xFF, &mut self.evaluations)?;
            return Ok(Cells { kleene: Kleene::of(sides, complement), parts: [part; 8] });
        }
        self.cells_by_words(program, part, at, ask)
    }

    #[inline(never)]
    fn cells_by_words(
        &mut self,
        program: &Program,
        part: CsgPart,
        at: &Octants,
        ask: Ask<'_, '_>,
    ) -> Result<Cells, Error> {
        let (kleene, somewhere) = self.verdicts(program, part, at, ask)?;
        let mut cells = Cells { kleene, parts: [CsgPart::HOPELESS; 8] };
        let open = kleene.partial() & at.all();
        for k in (0..8).filter(|k| open >> k & 1 != 0) {
            let unchanged = self.answers.is_empty() && somewhere >> k & 1 == 0;
            cells.parts[k as usize] = if unchanged { part } else { self.reduced(part, k)? };
        }
        Ok(cells)
    }

    /// The verdicts of the eight cells, those by each word being kept; and in which cells a word is decided.
    fn verdicts(
        &mut self,
        program: &Program,
        part: CsgPart,
        at: &Octants,
        ask: Ask<'_, '_>,
    ) -> Result<(Kleene, u8), Error> {
        let CsgScratch { words, masks, operands, answers, scratches, slots, evaluations, .. } = self;
        let words = words.get(part.range()).unwrap_or(&[]);
        masks.clear();
        operands.clear();
        answers.clear();
        masks.try_reserve(words.len()).map_err(|_| Error::OutOfMemory)?;
        operands.try_reserve(words.len()).map_err(|_| Error::OutOfMemory)?;
        let mut somewhere = 0;
        for (i, word) in words.iter().enumerate() {
            let kleene = match word.op() {
                // Their primitive classifies them.
                Op::HalfSpace { .. } if program.paper => Kleene::UNKNOWN,
                Op::HalfSpace { index, complement } => {
                    Kleene::of(program.half_spaces[index as usize].sides(at, 0xFF, evaluations)?, complement)
                }
                Op::Solid { index, complement } => {
                    let answer = match ask {
                        Ask::Root(frame) => {
                            let scratch = &mut scratches[index as usize];
                            let height = scratch.mark();
                            let verdict = program.solids[index as usize].root(scratch, frame)?;
                            Answer { solid: index, height, verdicts: [verdict; 8] }
                        }
                        Ask::Split(cube) => {
                            let Slot { solid, part, .. } = slots[index as usize];
                            let scratch = &mut scratches[solid as usize];
                            let height = scratch.mark();
                            let verdicts = program.solids[solid as usize].split(scratch, cube, &part)?;
                            Answer { solid, height, verdicts }
                        }
                    };
                    let kleene = Kleene::of_tags(answer.verdicts.map(|verdict| verdict.tag()));
                    push(answers, answer)?;
                    kleene.complemented(complement)
                }
                Op::Unknown => Kleene::UNKNOWN,
                Op::Join { join, complement, count } => {
                    Kleene::join_last(operands, join, count).complemented(complement)
                }
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

    /// Writes the words that are open in child `k`; returns the child's part.
    fn reduced(&mut self, part: CsgPart, k: u32) -> Result<CsgPart, Error> {
        let start = self.words.len();
        let bit = 1u8 << k;
        self.open.clear();
        self.open.try_reserve(part.len as usize).map_err(|_| Error::OutOfMemory)?;
        self.words.try_reserve(part.len as usize).map_err(|_| Error::OutOfMemory)?;
        let (mut answers, mut hopeful) = (0, false);
        // One mask a word: a part that means nothing has none.
        for i in 0..self.masks.len() {
            let op = self.words[part.start as usize + i].op();
            let kleene = self.masks[i];
            let mut first = self.words.len();
            let emitted = match op {
                Op::HalfSpace { .. } => {
                    hopeful |= kleene.decided() & bit == 0;
                    Some(op)
                }
                Op::Unknown => Some(op),
                Op::Solid { complement, .. } => {
                    let Answer { solid, height, verdicts } = self.answers[answers];
                    answers += 1;
                    Some(match verdicts[k as usize] {
                        Verdict::Partial(part) => {
                            let slot = Slot { solid, part, words: start, height };
                            let index = Slot::keep(&mut self.slots, slot)?;
                            hopeful = true;
                            Op::Solid { index, complement }
                        }
                        _ => Op::Unknown,
                    })
                }
                Op::Join { count, .. } | Op::Primitive { count } => {
                    let operands = self.open.len() - count as usize;
                    let (mut open, mut parity) = (0, false);
                    for operand in self.open.drain(operands..) {
                        match operand {
                            Operand::Open(from) => (first, open) = (first.min(from), open + 1),
                            Operand::Decided(value) => parity ^= value,
                        }
                    }
                    op.of_open(open, parity)
                }
            };
            if kleene.decided() & bit != 0 {
                self.words.truncate(first);
                self.open.push(Operand::Decided(kleene.lower & bit != 0));
            } else {
                self.words.extend(emitted.map(Word::new));
                self.open.push(Operand::Open(first));
            }
        }
        if !hopeful {
            return Ok(CsgPart::HOPELESS);
        }
        // More words than that take seventeen gigabytes.
        let end = u32::try_from(self.words.len()).map_err(|_| Error::OutOfMemory)?;
        Ok(CsgPart { start: start as u32, len: end - start as u32 })
    }
}

/// A primitive as the method was published: the vertices of the children first, a vertex on the surface being inside;
/// then half-space by half-space the children whose vertices agree.
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

impl CsgScratch {
    /// Which of the given grandchildren of a cell have their centre inside; `None` if that cannot be told.
    pub(super) fn contained(
        &mut self,
        program: &Program,
        cube: &Cube<'_>,
        parts: &[(u8, CsgPart)],
    ) -> Result<Option<u64>, Error> {
        let mut all = 0;
        for octant in parts.chunk_by(|a, b| a.0 >> 3 == b.0 >> 3) {
            let child = cube.child(octant[0].0 >> 3);
            // The centres of cells that one half-space cuts are had at once.
            let first = octant[0].1;
            let (mut inside, mut outside) = (0, 0);
            if first.len == 1
                && octant.len() > 1
                && octant.iter().all(|(_, part)| part.start == first.start)
                && let Some(Op::HalfSpace { index, complement }) =
                    self.words.get(first.start as usize).map(|word| word.op())
            {
                (inside, outside) = program.half_spaces[index as usize].centres(&Octants::of(child.cell));
                self.evaluations += octant.len() as u64;
                if complement {
                    (inside, outside) = (outside, inside);
                }
            }
            for &(c, part) in octant {
                let bit = 1u8 << (c & 7);
                if (inside | outside) & bit == 0 {
                    match self.contains(program, part, &child.child(c & 7))? {
                        Some(true) => inside |= bit,
                        Some(false) => {}
                        None => return Ok(None),
                    }
                }
                all |= ((inside >> (c & 7) & 1) as u64) << (c & 63);
            }
        }
        Ok(Some(all))
    }

    /// Whether the centre of a cell lies inside, by the cell's words; `None` if that cannot be told.
    pub(super) fn contains(
        &mut self,
        program: &Program,
        part: CsgPart,
        cube: &Cube<'_>,
    ) -> Result<Option<bool>, Error> {
        let CsgScratch { words, operands, scratches, slots, evaluations, .. } = self;
        let words = words.get(part.range()).unwrap_or(&[]);
        let centre = centre(cube.cell);
        // A word of one cell: the others say the same.
        let all = |inside: bool| if inside { Kleene::FULL } else { Kleene::EMPTY };
        operands.clear();
        operands.try_reserve(words.len()).map_err(|_| Error::OutOfMemory)?;
        for word in words {
            let kleene = match word.op() {
                Op::HalfSpace { index, complement } => {
                    *evaluations += 1;
                    let inside = program.half_spaces[index as usize].contains(centre)?;
                    inside.map_or(Kleene::UNKNOWN, all).complemented(complement)
                }
                Op::Solid { index, complement } => {
                    let Slot { solid, part, .. } = slots[index as usize];
                    let solid = solid as usize;
                    let inside = program.solids[solid].sample(&mut scratches[solid], cube, &part)?;
                    inside.map_or(Kleene::UNKNOWN, all).complemented(complement)
                }
                Op::Unknown => Kleene::UNKNOWN,
                Op::Join { join, complement, count } => {
                    Kleene::join_last(operands, join, count).complemented(complement)
                }
                Op::Primitive { count } => Kleene::join_last(operands, Join::Intersection, count),
            };
            operands.push(kleene);
        }
        Ok(match operands.pop() {
            Some(Kleene::FULL) => Some(true),
            Some(Kleene::EMPTY) => Some(false),
            _ => None,
        })
    }
}

impl Kleene {
    #[inline(always)]
    pub(super) fn verdict(self, k: u32, part: CsgPart) -> Verdict<CsgPart> {
        match (self.lower >> k & 1 != 0, self.upper >> k & 1 != 0) {
            (true, _) => Verdict::Full,
            (_, false) => Verdict::Empty,
            _ if part.len == 0 => Verdict::Undecided,
            _ => Verdict::Partial(part),
        }
    }
}
