//! An expression on a universe: placements applied, complements pushed down to the half-spaces, and the whole written as
//! words in postfix order, so that a cell's share of it is an array of words again.

use super::halfspace::{HalfSpace, Placed};
use super::map::ExactMap;
use super::{Csg, Join, Kind, Node, Touch};
use crate::error::Error;
use crate::lattice::Frame;
use crate::solid::AnySolid;
use alloc::sync::Arc;
use alloc::vec::Vec;

/// One word: an operand, or what joins the operands before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Word(u32);

/// A word taken apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Op {
    /// Half-space `index`, or its complement.
    HalfSpace { index: u32, complement: bool },
    /// Another solid, or its complement. In the program `index` counts the program's solids, in a cell's words the
    /// parts that the scratch memory keeps.
    Solid { index: u32, complement: bool },
    /// Nothing is known, and splitting does not help.
    Unknown,
    /// The operation on the `count` operands before; or its complement.
    Join { join: Join, complement: bool, count: u32 },
    /// The intersection of the `count` half-spaces before, which are classified together by [`Touch::Paper`].
    Primitive { count: u32 },
}

/// Most half-spaces, other solids, operations and placements of an expression that is written out. (A half-space takes a kilobyte,
/// and a node that contains another twice, which contains another twice …, soon comes to more than there is.)
pub(super) const MOST: u64 = 1 << 22;

impl Word {
    /// The greatest index or count that a word can hold.
    pub(super) const MOST: u32 = (1 << 28) - 1;

    pub(super) fn new(op: Op) -> Word {
        let word = |tag: u32, complement: bool, value: u32| tag | (complement as u32) << 3 | value << 4;
        Word(match op {
            Op::HalfSpace { index, complement } => word(0, complement, index),
            Op::Solid { index, complement } => word(1, complement, index),
            Op::Unknown => word(2, false, 0),
            Op::Join { join: Join::Intersection, complement, count } => word(3, complement, count),
            Op::Join { join: Join::Union, complement, count } => word(4, complement, count),
            Op::Join { join: Join::Parity, complement, count } => word(5, complement, count),
            Op::Primitive { count } => word(6, false, count),
        })
    }

    #[inline(always)]
    pub(super) fn op(self) -> Op {
        let (complement, value) = (self.0 & 8 != 0, self.0 >> 4);
        let join = |join| Op::Join { join, complement, count: value };
        match self.0 & 7 {
            0 => Op::HalfSpace { index: value, complement },
            1 => Op::Solid { index: value, complement },
            3 => join(Join::Intersection),
            4 => join(Join::Union),
            5 => join(Join::Parity),
            6 => Op::Primitive { count: value },
            _ => Op::Unknown,
        }
    }
}

impl Op {
    /// What remains of an operation of which `open` operands are not decided; `None` if one operand is all that
    /// remains. Those of unions and intersections that are decided say nothing, those of parities their `parity`.
    pub(super) fn of_open(self, open: u32, parity: bool) -> Option<Op> {
        match self {
            Op::Join { join: Join::Parity, complement, .. } => {
                let complement = complement ^ parity;
                (open > 1 || complement).then_some(Op::Join { join: Join::Parity, complement, count: open })
            }
            Op::Join { join, complement, .. } => {
                (open > 1).then_some(Op::Join { join, complement, count: open })
            }
            Op::Primitive { .. } => Some(Op::Primitive { count: open }),
            _ => Some(self),
        }
    }
}

/// An expression on one universe.
pub(super) struct Program {
    /// Whether [`Touch::Paper`] holds.
    pub(super) paper: bool,
    pub(super) half_spaces: Vec<Placed>,
    pub(super) solids: Vec<AnySolid>,
    pub(super) words: Vec<Word>,
}

/// What is left to be written.
enum Task<'a> {
    Write { node: &'a Node, complement: bool, map: Arc<ExactMap> },
    Join { join: Join, complement: bool, start: usize },
}

/// Appends, where there is memory.
pub(super) fn push<T>(list: &mut Vec<T>, value: T) -> Result<(), Error> {
    list.try_reserve(1).map_err(|_| Error::OutOfMemory)?;
    list.push(value);
    Ok(())
}

impl Program {
    /// Time and memory are linear in the expression, written out: a node that occurs twice counts twice.
    pub(super) fn new(csg: &Csg, frame: &Frame) -> Result<Program, Error> {
        if csg.root.size > MOST {
            return Err(Error::Limit { what: "half-spaces, operations and placements", limit: MOST });
        }
        let paper = csg.touch == Touch::Paper;
        let mut program = Program { paper, half_spaces: Vec::new(), solids: Vec::new(), words: Vec::new() };
        let mut tasks = Vec::new();
        // Operands so far; a pending join knows how many there were when it was begun.
        let mut operands = 0;
        // Which joins are pending, and whether their complements are meant.
        let mut joins: Vec<(Join, bool)> = Vec::new();
        let map = Arc::new(ExactMap::from_universe(frame));
        push(&mut tasks, Task::Write { node: &csg.root, complement: false, map })?;
        while let Some(task) = tasks.pop() {
            match task {
                Task::Join { join, complement, start } => {
                    let count = operands - start;
                    operands = start + 1;
                    joins.pop();
                    // One operand is itself.
                    if count != 1 || (join == Join::Parity && complement) {
                        program.join(join, complement, count)?;
                    }
                }
                Task::Write { node, complement, map } => match &node.kind {
                    Kind::Complement(part) => {
                        push(&mut tasks, Task::Write { node: part, complement: !complement, map })?;
                    }
                    Kind::Placed(part, placement) => {
                        let map = Arc::new(map.of_placed(placement)?);
                        push(&mut tasks, Task::Write { node: part, complement, map })?;
                    }
                    Kind::HalfSpace(half_space) => {
                        operands += 1;
                        if paper {
                            program.primitive([half_space], complement, &map, frame)?;
                        } else {
                            program.half_space(half_space, complement, &map, frame)?;
                        }
                    }
                    Kind::Solid(solid) => {
                        operands += 1;
                        program.solid(solid, complement)?;
                    }
                    Kind::Join(Join::Intersection, parts) if paper && all_half_spaces(parts) => {
                        operands += 1;
                        let half_spaces = parts.iter().filter_map(|part| part.half_space());
                        program.primitive(half_spaces, complement, &map, frame)?;
                    }
                    Kind::Join(join, parts) => {
                        // By De Morgan; of a parity the complement remains.
                        let (join, inner, outer) = match (join, complement) {
                            (Join::Parity, _) => (Join::Parity, false, complement),
                            (Join::Intersection, true) => (Join::Union, true, false),
                            (Join::Union, true) => (Join::Intersection, true, false),
                            (&join, false) => (join, false, false),
                        };
                        // An operand of the same operation joins its operands to ours.
                        let flat =
                            !outer && !paper && !parts.is_empty() && joins.last() == Some(&(join, false));
                        if !flat {
                            push(&mut joins, (join, outer))?;
                            push(&mut tasks, Task::Join { join, complement: outer, start: operands })?;
                        }
                        tasks.try_reserve(parts.len()).map_err(|_| Error::OutOfMemory)?;
                        for part in parts.iter().rev() {
                            tasks.push(Task::Write { node: part, complement: inner, map: map.clone() });
                        }
                    }
                },
            }
        }
        Ok(program)
    }

    fn join(&mut self, join: Join, complement: bool, count: usize) -> Result<(), Error> {
        let count = count as u32;
        push(&mut self.words, Word::new(Op::Join { join, complement, count }))
    }

    fn half_space(
        &mut self,
        half_space: &HalfSpace,
        complement: bool,
        map: &ExactMap,
        frame: &Frame,
    ) -> Result<(), Error> {
        let index = self.half_spaces.len() as u32;
        push(&mut self.half_spaces, half_space.0.on(map, frame))?;
        push(&mut self.words, Word::new(Op::HalfSpace { index, complement }))
    }

    fn primitive<'h>(
        &mut self,
        half_spaces: impl IntoIterator<Item = &'h HalfSpace>,
        complement: bool,
        map: &ExactMap,
        frame: &Frame,
    ) -> Result<(), Error> {
        let before = self.words.len();
        for half_space in half_spaces {
            self.half_space(half_space, false, map, frame)?;
        }
        let count = (self.words.len() - before) as u32;
        push(&mut self.words, Word::new(Op::Primitive { count }))?;
        if complement { self.join(Join::Parity, true, 1) } else { Ok(()) }
    }

    fn solid(&mut self, solid: &AnySolid, complement: bool) -> Result<(), Error> {
        let index = self.solids.len() as u32;
        push(&mut self.solids, solid.clone())?;
        push(&mut self.words, Word::new(Op::Solid { index, complement }))
    }
}

impl Node {
    fn half_space(&self) -> Option<&HalfSpace> {
        match &self.kind {
            Kind::HalfSpace(half_space) => Some(half_space),
            _ => None,
        }
    }
}

fn all_half_spaces(parts: &[Arc<Node>]) -> bool {
    !parts.is_empty() && parts.iter().all(|part| part.half_space().is_some())
}
