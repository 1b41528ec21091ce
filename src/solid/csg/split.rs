//! A CSG expression as a solid: the split of a cell.

use super::bounds::{Octants, Sides, centre};
use super::program::{Op, Program, Word, push};
use super::{Csg, Join, points};
use crate::error::Error;
use crate::lattice::{Cube, Frame};
use crate::octree::{Planes, Tag};
use crate::solid::{ErasedPart, ErasedScratch, Fingerprint, Scratch, Solid, Verdict};
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::ops::Range;

/// What a [`Csg`] remembers about a cell: the words of its expression that are still open there.
#[derive(Debug, Clone, Copy)]
pub struct CsgPart {
    start: u32,
    len: u32,
}

impl CsgPart {
    /// Of a cell that cannot be split.
    const HOPELESS: CsgPart = CsgPart { start: 0, len: 0 };

    fn range(self) -> Range<usize> {
        self.start as usize..self.start as usize + self.len as usize
    }
}

/// Scratch memory of a [`Csg`].
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
struct Cells {
    kleene: Kleene,
    parts: [CsgPart; 8],
}

/// The verdicts of eight cells: bit k of `lower` says that cell k is surely solid, of `upper` that it is possibly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Kleene {
    lower: u8,
    upper: u8,
}

impl Kleene {
    const FULL: Kleene = Kleene { lower: 0xFF, upper: 0xFF };
    const EMPTY: Kleene = Kleene { lower: 0, upper: 0 };
    const UNKNOWN: Kleene = Kleene { lower: 0, upper: 0xFF };

    #[inline(always)]
    fn complemented(self, complement: bool) -> Kleene {
        if complement { Kleene { lower: !self.upper, upper: !self.lower } } else { self }
    }

    #[inline(always)]
    fn and(self, other: Kleene) -> Kleene {
        Kleene { lower: self.lower & other.lower, upper: self.upper & other.upper }
    }

    #[inline(always)]
    fn or(self, other: Kleene) -> Kleene {
        Kleene { lower: self.lower | other.lower, upper: self.upper | other.upper }
    }

    #[inline(always)]
    fn xor(self, other: Kleene) -> Kleene {
        let known = self.decided() & other.decided();
        let value = self.lower ^ other.lower;
        Kleene { lower: value & known, upper: value | !known }
    }

    #[inline(always)]
    fn decided(self) -> u8 {
        self.lower | !self.upper
    }

    #[inline(always)]
    fn partial(self) -> u8 {
        self.upper & !self.lower
    }

    fn join(join: Join, operands: &[Kleene]) -> Kleene {
        let fold = |start, step: fn(Kleene, Kleene) -> Kleene| operands.iter().copied().fold(start, step);
        match join {
            Join::Intersection => fold(Kleene::FULL, Kleene::and),
            Join::Union => fold(Kleene::EMPTY, Kleene::or),
            Join::Parity => fold(Kleene::EMPTY, Kleene::xor),
        }
    }

    #[inline(always)]
    fn of(sides: Sides, complement: bool) -> Kleene {
        Kleene { lower: sides.inside, upper: !sides.outside }.complemented(complement)
    }

    fn of_tags(tags: [Tag; 8]) -> Kleene {
        let mut kleene = Kleene::EMPTY;
        for (k, tag) in tags.iter().enumerate() {
            kleene.lower |= (tag.lower() as u8) << k;
            kleene.upper |= (tag.upper() as u8) << k;
        }
        kleene
    }
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
enum Ask<'q, 'f> {
    Root(&'q Frame),
    Split(&'q Cube<'f>),
}

impl CsgScratch {
    /// The eight cells `at`, by the words of a part.
    #[inline(always)]
    fn cells(
        &mut self,
        program: &Program,
        part: CsgPart,
        at: &Octants,
        ask: Ask<'_, '_>,
    ) -> Result<Cells, Error> {
        // Most cells are cut by one half-space: they share its word.
        if part.len == 1 {
            if let Some(Op::HalfSpace { index, complement }) =
                self.words.get(part.start as usize).map(|word| word.op())
            {
                if !program.paper {
                    let sides = program.half_spaces[index as usize].sides(at, 0xFF, &mut self.evaluations)?;
                    return Ok(Cells { kleene: Kleene::of(sides, complement), parts: [part; 8] });
                }
            }
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
        for k in (0..8).filter(|k| kleene.partial() >> k & 1 != 0) {
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
                    let first = operands.len() - count as usize;
                    let kleene = Kleene::join(join, &operands[first..]).complemented(complement);
                    operands.truncate(first);
                    kleene
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
        // Two billion words are eight gigabytes.
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

impl Csg {
    /// Runs `work` on the program that the scratch memory holds, with the memory.
    #[inline(always)]
    fn with_program<T>(
        scratch: &mut CsgScratch,
        work: impl FnOnce(&mut CsgScratch, &Program) -> Result<T, Error>,
    ) -> Result<Option<T>, Error> {
        // Taken out for the time, since a shared count costs more than a split.
        let Some(program) = scratch.program.take() else { return Ok(None) };
        let result = work(scratch, &program);
        scratch.program = Some(program);
        result.map(Some)
    }
}

impl Solid for Csg {
    type Part = CsgPart;
    type Scratch = CsgScratch;

    fn root(&self, scratch: &mut CsgScratch, frame: &Frame) -> Result<Verdict<CsgPart>, Error> {
        let program = Program::new(self, frame)?;
        scratch.words.clear();
        scratch.slots.clear();
        // What the others counted stays counted.
        scratch.evaluations = scratch.evaluations();
        scratch.scratches.clear();
        scratch.scratches.try_reserve(program.solids.len()).map_err(|_| Error::OutOfMemory)?;
        scratch.scratches.resize_with(program.solids.len(), ErasedScratch::default);
        scratch.words.try_reserve(program.words.len()).map_err(|_| Error::OutOfMemory)?;
        scratch.words.extend_from_slice(&program.words);
        let part =
            CsgPart { start: 0, len: u32::try_from(program.words.len()).map_err(|_| Error::OutOfMemory)? };
        let Cells { kleene, parts } =
            scratch.cells(&program, part, &Octants::of_universe(), Ask::Root(frame))?;
        scratch.program = Some(Arc::new(program));
        Ok(kleene.verdict(0, parts[0]))
    }

    fn split(
        &self,
        scratch: &mut CsgScratch,
        cube: &Cube<'_>,
        part: &CsgPart,
    ) -> Result<[Verdict<CsgPart>; 8], Error> {
        let cells = Csg::with_program(scratch, |scratch, program| {
            scratch.cells(program, *part, &Octants::of(cube.cell), Ask::Split(cube))
        })?;
        let Some(Cells { kleene, parts }) = cells else { return Ok([Verdict::Undecided; 8]) };
        Ok([0, 1, 2, 3, 4, 5, 6, 7].map(|k| kleene.verdict(k, parts[k as usize])))
    }

    fn split64(
        &self,
        scratch: &mut CsgScratch,
        cube: &Cube<'_>,
        part: &CsgPart,
        parts: &mut Vec<(u8, CsgPart)>,
    ) -> Result<Planes, Error> {
        parts.try_reserve(64).map_err(|_| Error::OutOfMemory)?;
        let planes = Csg::with_program(scratch, |scratch, program| {
            let octants = scratch.cells(program, *part, &Octants::of(cube.cell), Ask::Split(cube))?;
            let mut planes = Planes::uniform(Tag::Empty);
            for k in 0..8u8 {
                let (lower, upper) = (octants.kleene.lower >> k & 1 != 0, octants.kleene.upper >> k & 1 != 0);
                let part = octants.parts[k as usize];
                let mut cells =
                    Kleene { lower: if lower { 0xFF } else { 0 }, upper: if upper { 0xFF } else { 0 } };
                if upper && !lower && part.len > 0 {
                    let child = cube.child(k);
                    let split = scratch.cells(program, part, &Octants::of(child.cell), Ask::Split(&child))?;
                    cells = split.kleene;
                    let mut partial = cells.partial();
                    while partial != 0 {
                        let c = partial.trailing_zeros() as u8;
                        partial &= partial - 1;
                        if split.parts[c as usize].len > 0 {
                            parts.push((8 * k + c, split.parts[c as usize]));
                        }
                    }
                }
                planes.lower |= (cells.lower as u64) << (8 * k);
                planes.upper |= (cells.upper as u64) << (8 * k);
            }
            Ok(planes)
        })?;
        Ok(planes.unwrap_or(Planes::uniform(Tag::Partial)))
    }

    fn sample(
        &self,
        scratch: &mut CsgScratch,
        cube: &Cube<'_>,
        part: &CsgPart,
    ) -> Result<Option<bool>, Error> {
        let inside = Csg::with_program(scratch, |scratch, program| {
            scratch.contains(program, *part, cube, centre(cube.cell))
        })?;
        Ok(inside.flatten())
    }

    fn sample64(
        &self,
        scratch: &mut CsgScratch,
        cube: &Cube<'_>,
        parts: &[(u8, CsgPart)],
    ) -> Result<Option<u64>, Error> {
        let inside = Csg::with_program(scratch, |scratch, program| scratch.contained(program, cube, parts))?;
        Ok(inside.flatten())
    }

    fn exterior(&self, frame: &Frame) -> Tag {
        self.root.exterior(frame).unwrap_or(Tag::Partial)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        self.fingerprint_of_expression()
    }

    fn hand_over(&self, from: &CsgScratch, part: &CsgPart, to: &mut CsgScratch) -> Result<CsgPart, Error> {
        let Some(program) = &from.program else { return Ok(CsgPart::HOPELESS) };
        to.program.get_or_insert_with(|| program.clone());
        if to.scratches.len() < from.scratches.len() {
            let missing = from.scratches.len() - to.scratches.len();
            to.scratches.try_reserve(missing).map_err(|_| Error::OutOfMemory)?;
            to.scratches.resize_with(from.scratches.len(), ErasedScratch::default);
        }
        let start = u32::try_from(to.words.len()).map_err(|_| Error::OutOfMemory)?;
        let words = from.words.get(part.range()).unwrap_or(&[]);
        to.words.try_reserve(words.len()).map_err(|_| Error::OutOfMemory)?;
        for word in words {
            let word = match word.op() {
                Op::Solid { index, complement } => {
                    let Slot { solid, part, .. } = from.slots[index as usize];
                    let (source, target) = (solid as usize, &mut to.scratches[solid as usize]);
                    let height = target.mark();
                    let part = program.solids[source].hand_over(&from.scratches[source], &part, target)?;
                    let slot = Slot { solid, part, words: to.words.len(), height };
                    let index = Slot::keep(&mut to.slots, slot)?;
                    Word::new(Op::Solid { index, complement })
                }
                _ => *word,
            };
            to.words.push(word);
        }
        Ok(CsgPart { start, len: part.len })
    }
}

impl Kleene {
    #[inline(always)]
    fn verdict(self, k: u32, part: CsgPart) -> Verdict<CsgPart> {
        match (self.lower >> k & 1 != 0, self.upper >> k & 1 != 0) {
            (true, _) => Verdict::Full,
            (_, false) => Verdict::Empty,
            _ if part.len == 0 => Verdict::Undecided,
            _ => Verdict::Partial(part),
        }
    }
}

impl CsgScratch {
    /// Which of the given grandchildren of a cell have their centre inside; `None` if that cannot be told.
    fn contained(
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
            if first.len == 1 && octant.len() > 1 && octant.iter().all(|(_, part)| part.start == first.start)
            {
                if let Some(Op::HalfSpace { index, complement }) =
                    self.words.get(first.start as usize).map(|word| word.op())
                {
                    (inside, outside) = program.half_spaces[index as usize].centres(&Octants::of(child.cell));
                    self.evaluations += octant.len() as u64;
                    if complement {
                        (inside, outside) = (outside, inside);
                    }
                }
            }
            for &(c, part) in octant {
                let bit = 1u8 << (c & 7);
                if (inside | outside) & bit == 0 {
                    let cell = child.child(c & 7);
                    match self.contains(program, part, &cell, centre(cell.cell))? {
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
    fn contains(
        &mut self,
        program: &Program,
        part: CsgPart,
        cube: &Cube<'_>,
        centre: [f64; 3],
    ) -> Result<Option<bool>, Error> {
        let CsgScratch { words, operands, scratches, slots, evaluations, .. } = self;
        let words = words.get(part.range()).unwrap_or(&[]);
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
                    let first = operands.len() - count as usize;
                    let kleene = Kleene::join(join, &operands[first..]).complemented(complement);
                    operands.truncate(first);
                    kleene
                }
                Op::Primitive { count } => {
                    let first = operands.len() - count as usize;
                    let kleene = Kleene::join(Join::Intersection, &operands[first..]);
                    operands.truncate(first);
                    kleene
                }
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
