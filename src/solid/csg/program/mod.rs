//! An expression on a universe. Placements are applied, complements are pushed down to the half-spaces, and
//! the whole is written as words in postfix order, so that a cell's share of it is an array of words, too.

mod area;
mod at_hand;
mod batch;
mod centres;
mod chords;
mod distinct;
mod hierarchy;
mod kleene;
mod lone;
mod slabs;
mod split;
mod surfaces;
pub(crate) mod word;
mod worker;

use super::extent::{Extent, into_universe};
use super::{Csg, Join, Kind, MOST, Node, Touch};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Affine, Composed, Frame};
use crate::memory;
use crate::octree::{Proof, Tag};
use crate::solid::half_space::identity::Identities;
use crate::solid::half_space::map::ExactMap;
use crate::solid::half_space::{HalfSpace, Placed};
use crate::solid::{AnyClassifier, AnySolid, Classifier, Solid};
use alloc::sync::Arc;
use alloc::vec::Vec;
use hashbrown::HashMap;
use hierarchy::{Groups, Operand};
use once_cell::race::OnceBox;
use surfaces::Start;
use word::{Op, Word};

/// An expression on one universe.
pub(crate) struct Program {
    pub(crate) frame: Frame,
    /// Whether [`Touch::Paper`] holds.
    pub(crate) paper: bool,
    pub(crate) half_spaces: Vec<Placed>,
    /// Each half-space as it was given, and the number of its chain of placements.
    sources: Vec<(HalfSpace, u32)>,
    /// Chains of placements: the number of the chain before, and the last map. Chains are numbered from 1; 0
    /// is the empty chain.
    chains: Vec<(u32, Affine)>,
    /// For each of the other solids, where its surfaces begin behind the half-spaces: in the list without
    /// layers, and in the list with them. (Set on first use.)
    surfaces: [OnceBox<Vec<Start>>; 2],
    pub(crate) solids: Vec<AnyClassifier<'static>>,
    /// The operands of large operations, grouped by place.
    pub(crate) groups: Groups,
    pub(crate) words: Vec<Word>,
    /// The tag of the space around the universe.
    pub(crate) exterior: Tag,
    /// The proof of the verdicts: the other solids' proofs combined.
    pub(crate) proof: Proof,
    /// Whether one of the other solids prefers queries about many cells at once.
    pub(crate) likes_many: bool,
    /// For each of the other solids, whether the universe is PARTIAL with a part that is available without
    /// another query.
    pub(crate) recalls: Vec<bool>,
    /// The node that counts the evaluations of dropped workers.
    pub(crate) root: Arc<Node>,
}

/// A task that is left for writing.
enum Task<'a> {
    /// `shared`: the node, or a node that contains it, may occur again.
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

/// The space in which a node is given: the exact map into it from the universe, and the map back to model
/// space for boxes, if this is not the identity.
#[derive(Clone)]
struct Space {
    map: Arc<ExactMap>,
    outward: Option<Arc<Composed>>,
    /// The number of its chain of placements.
    chain: u32,
}

/// An expression while it is written.
struct Writer<'c> {
    program: Program,
    control: &'c Control<'c>,
    /// The operands of the pending joins.
    operands: Vec<Operand>,
    /// Half-spaces and other solids that may occur again, because they are written once. A half-space comes
    /// with whether it is the complement of the numbered one.
    seen_half_spaces: HashMap<(usize, usize), (u32, bool)>,
    seen_solids: HashMap<usize, u32>,
    /// The half-spaces by identity, wherever they come from.
    identities: Identities,
    /// The spaces of placements that may occur again.
    spaces: HashMap<(usize, usize), Space>,
}

impl Program {
    /// Writes an expression as a program. Time and memory are linear in the expression written out: a node
    /// that occurs twice counts twice. (Operations with many operands sort them.)
    pub(crate) fn new(csg: &Csg, frame: &Frame, control: &Control<'_>) -> Result<Program, Error> {
        if csg.root.size > MOST {
            return Err(Error::Limit { what: "half-spaces, operations and placements", limit: MOST });
        }
        let program = Program {
            frame: *frame,
            paper: csg.touch == Touch::Paper,
            half_spaces: Vec::new(),
            sources: Vec::new(),
            chains: Vec::new(),
            surfaces: [OnceBox::new(), OnceBox::new()],
            solids: Vec::new(),
            groups: Groups::default(),
            words: Vec::new(),
            exterior: Tag::Partial,
            proof: Proof::CERTIFIED,
            likes_many: false,
            recalls: Vec::new(),
            root: csg.root.clone(),
        };
        let mut writer = Writer {
            program,
            control,
            operands: Vec::new(),
            seen_half_spaces: HashMap::new(),
            seen_solids: HashMap::new(),
            identities: Identities::default(),
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

impl Program {
    /// The approximate bytes of the program beyond the expression, including the other solids' memory for the
    /// universe.
    pub(crate) fn bytes(&self) -> u64 {
        let lists = memory::bytes_of(&self.half_spaces)
            + memory::bytes_of(&self.sources)
            + memory::bytes_of(&self.chains)
            + self
                .surfaces
                .iter()
                .filter_map(OnceBox::get)
                .map(|list| size_of_val(list) + memory::bytes_of(list))
                .sum::<usize>()
            + memory::bytes_of(&self.solids)
            + self.groups.bytes()
            + memory::bytes_of(&self.words)
            + memory::bytes_of(&self.recalls);
        let placed = self.half_spaces.iter().map(Placed::heap_bytes).sum::<usize>();
        let others = self.solids.iter().map(Classifier::kept_bytes).sum::<u64>();
        (size_of::<Program>() + lists + placed) as u64 + others
    }

    /// Returns the only solid, if the program is nothing but one solid.
    pub(crate) fn sole(&self) -> Option<&AnyClassifier<'static>> {
        let [word] = &*self.words else { return None };
        match word.op() {
            Op::Solid { index, complement: false } => self.solids.get(index as usize),
            _ => None,
        }
    }
}

impl Writer<'_> {
    fn write(&mut self, root: &Arc<Node>) -> Result<(), Error> {
        let mut tasks = Vec::new();
        // The pending joins, and whether their complements are meant.
        let mut joins: Vec<(Join, bool)> = Vec::new();
        let map = Arc::new(ExactMap::from_universe(&self.program.frame));
        let space = Space { map, outward: None, chain: 0 };
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
                                    let outward = match &space.outward {
                                        Some(outward) => outward.after(placement),
                                        None => placement.into(),
                                    };
                                    let outward = Some(Arc::new(outward));
                                    let chains = &mut self.program.chains;
                                    memory::push(chains, (space.chain, *placement))?;
                                    let inner = Space { map, outward, chain: chains.len() as u32 };
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
                                self.primitive([half_space], complement, shared, &space)?;
                            } else {
                                self.half_space(half_space, complement, shared, &space)?;
                            }
                        }
                        Kind::Solid(solid) => {
                            self.begin(node, complement, &space)?;
                            let index = self.solid(solid, complement)?;
                            // Under a parity, both sides are needed, whatever stands between.
                            let proof = self.program.solids[index as usize].proof();
                            let proof = match joins.iter().any(|&(join, _)| join == Join::Parity) {
                                true => proof.xor(proof),
                                false if complement => proof.complement(),
                                false => proof,
                            };
                            self.program.proof = self.program.proof.and(proof);
                        }
                        Kind::Join(Join::Intersection, parts)
                            if self.program.paper && all_half_spaces(parts) =>
                        {
                            self.begin(node, complement, &space)?;
                            let half_spaces = parts.iter().filter_map(|part| part.half_space());
                            self.primitive(half_spaces, complement, shared, &space)?;
                        }
                        Kind::Join(join, parts) => {
                            // By De Morgan's laws; the complement of a parity stays.
                            let (join, inner, outer) = match (join, complement) {
                                (Join::Parity, _) => (Join::Parity, false, complement),
                                (Join::Intersection, true) => (Join::Union, true, false),
                                (Join::Union, true) => (Join::Intersection, true, false),
                                (&join, false) => (join, false, false),
                            };
                            // An operand of the same operation hands its operands on to this one.
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

    /// Notes that the next words belong to an operand.
    fn begin(&mut self, node: &Node, complement: bool, space: &Space) -> Result<(), Error> {
        let unit = |extent: Extent| into_universe(extent, space.outward.as_deref(), &self.program.frame);
        let (extent, opposite) =
            if complement { (node.opposite, node.extent) } else { (node.extent, node.opposite) };
        let start = self.program.words.len();
        // Parts of other solids belong to the universe, and cannot wait in a group.
        let [extent, opposite] = if node.mixed { [None; 2] } else { [unit(extent), unit(opposite)] };
        memory::push(&mut self.operands, Operand { start, extent, opposite })
    }

    /// Joins the operands from `first` on.
    fn join(&mut self, join: Join, complement: bool, first: usize) -> Result<(), Error> {
        if !self.program.paper {
            distinct::reduce(join, first, &mut self.operands, &mut self.program.words)?;
        }
        let Program { groups, words, paper, .. } = &mut self.program;
        let operands = &self.operands[first..];
        let count = if *paper { operands.len() } else { groups.gather(join, operands, words)? };
        self.operands.truncate(first);
        // A join of one operand is that operand.
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
        space: &Space,
    ) -> Result<(), Error> {
        let map = &space.map;
        let key = (Arc::as_ptr(&half_space.0) as usize, Arc::as_ptr(map) as usize);
        let (index, is_turned) = match self.seen_half_spaces.get(&key) {
            Some(&known) => known,
            None => {
                let Program { half_spaces, sources, frame, paper, .. } = &mut self.program;
                let next = half_spaces.len() as u32;
                if next.is_multiple_of(1024) && self.control.is_cancelled() {
                    return Err(Error::Cancelled);
                }
                let placed = half_space.0.on(map, frame);
                let found = match *paper {
                    true => (next, false),
                    false => self.identities.find(half_space, map, &placed, half_spaces)?,
                };
                if found.0 == next {
                    memory::push(half_spaces, placed)?;
                    memory::push(sources, (half_space.clone(), space.chain))?;
                }
                if shared {
                    self.seen_half_spaces.try_reserve(1)?;
                    self.seen_half_spaces.insert(key, found);
                }
                found
            }
        };
        let complement = complement != is_turned;
        memory::push(&mut self.program.words, Word::new(Op::HalfSpace { index, complement }))
    }

    fn primitive<'h>(
        &mut self,
        half_spaces: impl IntoIterator<Item = &'h HalfSpace>,
        complement: bool,
        shared: bool,
        space: &Space,
    ) -> Result<(), Error> {
        let before = self.program.words.len();
        for half_space in half_spaces {
            self.half_space(half_space, false, shared, space)?;
        }
        let count = (self.program.words.len() - before) as u32;
        memory::push(&mut self.program.words, Word::new(Op::Primitive { count }))?;
        if complement { self.write_join(Join::Parity, true, 1) } else { Ok(()) }
    }

    fn solid(&mut self, solid: &AnySolid, complement: bool) -> Result<u32, Error> {
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
        memory::push(&mut self.program.words, Word::new(Op::Solid { index, complement }))?;
        Ok(index)
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
