//! An expression on a universe: placements applied, complements pushed down to the half-spaces, and the whole written as
//! words in postfix order, so that a cell's share of it is an array of words again.

use super::extent::{Extent, Outward};
use super::halfspace::{HalfSpace, Placed};
use super::hierarchy::{Group, Operand};
use super::map::ExactMap;
use super::{Csg, Join, Kind, Node, Touch};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Frame;
use crate::memory;
use crate::octree::Tag;
use crate::solid::{AnyClassifier, AnySolid, Classifier, Solid};
use alloc::sync::Arc;
use alloc::vec::Vec;
use hashbrown::HashMap;

/// One word: an operand, or what joins the operands before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Word(u32);

/// A word taken apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Op {
    /// Half-space `index`, or its complement.
    HalfSpace { index: u32, complement: bool },
    /// Another solid, or its complement. `index` counts the parts that a worker keeps, of which the first are the
    /// universe's parts of the program's solids.
    Solid { index: u32, complement: bool },
    /// Nothing is known, and splitting does not help.
    Unknown,
    /// The operation on the `count` operands before; or its complement.
    Join { join: Join, complement: bool, count: u32 },
    /// Operands that are not looked at one by one: group `index` of the program's.
    Group { index: u32 },
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
            Op::Group { index } => word(7, false, index),
        })
    }

    /// Half of a number that lies among words.
    pub(super) fn raw(bits: u32) -> Word {
        Word(bits)
    }

    /// The bits of such a half.
    pub(super) fn bits(self) -> u32 {
        self.0
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
            7 => Op::Group { index: value },
            _ => Op::Unknown,
        }
    }
}

impl Word {
    /// Bits of a half-space's index, of which there are no more than [`MOST`].
    const VARIABLE: u32 = 25;

    /// A half-space with its number in a truth table.
    pub(super) fn of_variable(i: usize, index: u32) -> Word {
        Word(index | (i as u32) << Word::VARIABLE)
    }

    /// The number of a half-space in a truth table, and which one it is.
    #[inline(always)]
    pub(super) fn variable(self) -> (usize, u32) {
        ((self.0 >> Word::VARIABLE) as usize, self.0 & ((1 << Word::VARIABLE) - 1))
    }
}

impl Op {
    /// The value of an operand that decides the operation.
    pub(super) fn absorbs(self) -> Option<bool> {
        match self {
            Op::Join { join: Join::Union, .. } => Some(true),
            Op::Join { join: Join::Intersection, .. } | Op::Primitive { .. } => Some(false),
            _ => None,
        }
    }

    /// The value of an operation of which `open` operands are not decided, if it has one: one that decides it was
    /// `absorbed`, or none is open.
    pub(super) fn decided(self, open: u32, parity: bool, absorbed: bool) -> Option<bool> {
        let (none, complement) = match self {
            Op::Join { join: Join::Union, complement, .. } => (false, complement),
            Op::Join { join: Join::Intersection, complement, .. } => (true, complement),
            Op::Join { join: Join::Parity, complement, .. } => (parity, complement),
            _ => (true, false),
        };
        match (absorbed, open) {
            (true, _) => Some(!none ^ complement),
            (false, 0) => Some(none ^ complement),
            _ => None,
        }
    }

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
    pub(super) frame: Frame,
    /// Whether [`Touch::Paper`] holds.
    pub(super) paper: bool,
    pub(super) half_spaces: Vec<Placed>,
    pub(super) solids: Vec<AnyClassifier>,
    /// Operands of large operations by where they lie, and the words of those that are in groups.
    pub(super) groups: Vec<Group>,
    pub(super) grouped: Vec<Word>,
    pub(super) words: Vec<Word>,
    /// What is known of the space around the universe.
    pub(super) exterior: Tag,
    /// Counts the evaluations of workers that are gone.
    pub(super) root: Arc<Node>,
}

/// What is left to be written.
enum Task<'a> {
    /// `shared`: it, or what it is a part of, may occur again.
    Write {
        node: &'a Arc<Node>,
        complement: bool,
        shared: bool,
        space: Space,
    },
    Join {
        join: Join,
        complement: bool,
        start: usize,
    },
}

/// The space that a node is given in, by its map from the universe, and the way of a box back into the universe.
#[derive(Clone)]
struct Space {
    map: Arc<ExactMap>,
    outward: Option<Arc<Outward>>,
}

/// An expression while it is written.
struct Writer<'c> {
    program: Program,
    control: &'c Control<'c>,
    /// Operands of the joins that are pending.
    operands: Vec<Operand>,
    /// Half-spaces that may occur again, and other solids: they are written once.
    seen_half_spaces: HashMap<(usize, usize), u32>,
    seen_solids: HashMap<usize, u32>,
    /// The spaces of placements that may occur again.
    spaces: HashMap<(usize, usize), Space>,
}

impl Program {
    /// Time and memory are linear in the expression, written out: a node that occurs twice counts twice. (Operations of
    /// many operands sort them.)
    pub(super) fn new(csg: &Csg, frame: &Frame, control: &Control<'_>) -> Result<Program, Error> {
        if csg.root.size > MOST {
            return Err(Error::Limit { what: "half-spaces, operations and placements", limit: MOST });
        }
        let program = Program {
            frame: *frame,
            paper: csg.touch == Touch::Paper,
            half_spaces: Vec::new(),
            solids: Vec::new(),
            groups: Vec::new(),
            grouped: Vec::new(),
            words: Vec::new(),
            exterior: Tag::Partial,
            root: csg.root.clone(),
        };
        let mut writer = Writer {
            program,
            control,
            operands: Vec::new(),
            seen_half_spaces: HashMap::new(),
            seen_solids: HashMap::new(),
            spaces: HashMap::new(),
        };
        writer.write(&csg.root)?;
        let Writer { mut program, seen_solids, .. } = writer;
        let exterior = |solid: &AnySolid| {
            let index = *seen_solids.get(&solid.address())? as usize;
            Some(program.solids.get(index)?.exterior())
        };
        program.exterior = csg.root.exterior(frame, exterior).unwrap_or(Tag::Partial);
        Ok(program)
    }
}

impl Writer<'_> {
    fn write(&mut self, root: &Arc<Node>) -> Result<(), Error> {
        let mut tasks = Vec::new();
        // Which joins are pending, and whether their complements are meant.
        let mut joins: Vec<(Join, bool)> = Vec::new();
        let map = Arc::new(ExactMap::from_universe(&self.program.frame));
        let space = Space { map, outward: None };
        memory::push(&mut tasks, Task::Write { node: root, complement: false, shared: false, space })?;
        while let Some(task) = tasks.pop() {
            match task {
                Task::Join { join, complement, start } => {
                    joins.pop();
                    self.join(join, complement, start)?;
                }
                Task::Write { node, complement, shared, space } => {
                    let shared = shared || Arc::strong_count(node) > 1;
                    match &node.kind {
                        Kind::Complement(part) => {
                            memory::push(
                                &mut tasks,
                                Task::Write { node: part, complement: !complement, shared, space },
                            )?;
                        }
                        Kind::Placed(part, placement) => {
                            let key = (Arc::as_ptr(&space.map) as usize, Arc::as_ptr(node) as usize);
                            let inner = match self.spaces.get(&key) {
                                Some(inner) => inner.clone(),
                                None => {
                                    let map = Arc::new(space.map.of_placed(placement)?);
                                    let outward = Some(Outward::new(placement, space.outward));
                                    let inner = Space { map, outward };
                                    if shared {
                                        self.spaces.try_reserve(1)?;
                                        self.spaces.insert(key, inner.clone());
                                    }
                                    inner
                                }
                            };
                            memory::push(
                                &mut tasks,
                                Task::Write { node: part, complement, shared, space: inner },
                            )?;
                        }
                        Kind::HalfSpace(half_space) => {
                            self.begin(node, complement, &space)?;
                            if self.program.paper {
                                self.primitive([half_space], complement, shared, &space.map)?;
                            } else {
                                self.half_space(half_space, complement, shared, &space.map)?;
                            }
                        }
                        Kind::Solid(solid) => {
                            self.begin(node, complement, &space)?;
                            self.solid(solid, complement)?;
                        }
                        Kind::Join(Join::Intersection, parts)
                            if self.program.paper && all_half_spaces(parts) =>
                        {
                            self.begin(node, complement, &space)?;
                            let half_spaces = parts.iter().filter_map(|part| part.half_space());
                            self.primitive(half_spaces, complement, shared, &space.map)?;
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
                            let flat = !outer
                                && !self.program.paper
                                && !parts.is_empty()
                                && joins.last() == Some(&(join, false));
                            if !flat {
                                self.begin(node, complement, &space)?;
                                memory::push(&mut joins, (join, outer))?;
                                let start = self.operands.len();
                                memory::push(&mut tasks, Task::Join { join, complement: outer, start })?;
                            }
                            tasks.try_reserve(parts.len())?;
                            for part in parts.iter().rev() {
                                tasks.push(Task::Write {
                                    node: part,
                                    complement: inner,
                                    shared,
                                    space: space.clone(),
                                });
                            }
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// Notes that the next words are those of an operand.
    fn begin(&mut self, node: &Node, complement: bool, space: &Space) -> Result<(), Error> {
        let unit =
            |extent: Extent| Outward::into_universe(space.outward.as_deref(), extent, &self.program.frame);
        let (extent, opposite) =
            if complement { (node.opposite, node.extent) } else { (node.extent, node.opposite) };
        let start = self.program.words.len();
        // Parts of other solids belong to the universe, and cannot wait in a group.
        let [extent, opposite] = if node.mixed { [None; 2] } else { [unit(extent), unit(opposite)] };
        memory::push(&mut self.operands, Operand { start, extent, opposite })
    }

    /// Joins the operands from `first` on.
    fn join(&mut self, join: Join, complement: bool, first: usize) -> Result<(), Error> {
        let count = self.program.group(join, &self.operands[first..])?;
        self.operands.truncate(first);
        // One operand is itself.
        if count != 1 || (join == Join::Parity && complement) {
            self.write_join(join, complement, count)?;
        }
        Ok(())
    }

    fn write_join(&mut self, join: Join, complement: bool, count: usize) -> Result<(), Error> {
        let count = count as u32;
        memory::push(&mut self.program.words, Word::new(Op::Join { join, complement, count }))
    }

    fn half_space(
        &mut self,
        half_space: &HalfSpace,
        complement: bool,
        shared: bool,
        map: &Arc<ExactMap>,
    ) -> Result<(), Error> {
        let key = (Arc::as_ptr(&half_space.0) as usize, Arc::as_ptr(map) as usize);
        let index = match self.seen_half_spaces.get(&key) {
            Some(&index) => index,
            None => {
                let index = self.program.half_spaces.len() as u32;
                if index.is_multiple_of(1024) && self.control.is_cancelled() {
                    return Err(Error::Cancelled);
                }
                memory::push(&mut self.program.half_spaces, half_space.0.on(map, &self.program.frame))?;
                if shared {
                    self.seen_half_spaces.try_reserve(1)?;
                    self.seen_half_spaces.insert(key, index);
                }
                index
            }
        };
        memory::push(&mut self.program.words, Word::new(Op::HalfSpace { index, complement }))
    }

    fn primitive<'h>(
        &mut self,
        half_spaces: impl IntoIterator<Item = &'h HalfSpace>,
        complement: bool,
        shared: bool,
        map: &Arc<ExactMap>,
    ) -> Result<(), Error> {
        let before = self.program.words.len();
        for half_space in half_spaces {
            self.half_space(half_space, false, shared, map)?;
        }
        let count = (self.program.words.len() - before) as u32;
        memory::push(&mut self.program.words, Word::new(Op::Primitive { count }))?;
        if complement { self.write_join(Join::Parity, true, 1) } else { Ok(()) }
    }

    fn solid(&mut self, solid: &AnySolid, complement: bool) -> Result<(), Error> {
        let index = match self.seen_solids.get(&solid.address()) {
            Some(&index) => index,
            None => {
                let index = self.program.solids.len() as u32;
                memory::push(&mut self.program.solids, solid.on(&self.program.frame, self.control)?)?;
                self.seen_solids.try_reserve(1)?;
                self.seen_solids.insert(solid.address(), index);
                index
            }
        };
        memory::push(&mut self.program.words, Word::new(Op::Solid { index, complement }))
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
