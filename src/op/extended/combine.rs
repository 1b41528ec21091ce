//! Set operations of stored trees of which at least one keeps surfaces.
//!
//! All operands are walked at once. Where only one operand leaves a cell undecided, the cell is copied from
//! that operand: whole subtrees as runs of their arrays, with their cuts. Where several operands end with
//! functions of surfaces, these become one function, and the cell ends as soon as the function needs no more
//! than three surfaces. Otherwise the cell is split.

use super::element::{Family, Fate, Output, Source, element};
use super::function::{Done, Function, Known};
use super::joint::JointSurfaces;
use crate::control::{Control, Job, WHOLE};
use crate::error::{Damage, Error};
use crate::lattice::Each;
use crate::lattice::{Cell, Frame, Shard};
use crate::memory;
use crate::octree::cuts::{CellCut, Cut, Cuts, CutsRef, Head, StoredMoments, SurfacesRef};
use crate::octree::links::Windows;
use crate::octree::view::{OctreeRef, starts_half_way};
use crate::octree::writer::Writer;
use crate::octree::{CellFilter, Octree, Planes, Proof, Tag};
use crate::parallel::each;
use crate::solid::OCTANTS;
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::ops::Range;

/// A set operation on any number of trees.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::op) enum Combination {
    /// The points that lie in all trees; with `flip`, the complement.
    All { flip: bool },
    /// The points that lie in an odd number of the trees.
    Odd,
    /// One solid, of which each tree knows a part.
    Known,
}

/// Entries of all operands from which threads pay.
const WORTH_THREADS: u64 = 1 << 13;

/// The greatest number of operands with threads: each task stores its position in all of them.
const MOST_IN_PARALLEL: usize = 1 << 12;

/// Combines trees on one frame. An operand with `true` stands for its complement.
pub(in crate::op) fn combine(
    operands: &[(OctreeRef<'_>, bool)],
    combination: Combination,
    control: &Control<'_>,
) -> Result<Octree, Error> {
    combine_cells(operands, combination, None, control)
}

/// Combines trees on one frame in the cells of a shard, if there is one.
pub(in crate::op) fn combine_cells(
    operands: &[(OctreeRef<'_>, bool)],
    combination: Combination,
    shard: Option<Shard>,
    control: &Control<'_>,
) -> Result<Octree, Error> {
    let Some((first, _)) = operands.first() else {
        return Err(Error::Argument { name: "trees", problem: "at least one is needed" });
    };
    let (frame, job) = (*first.frame(), Job::new(control));
    job.check()?;
    if let Some((other, _)) = operands.iter().find(|(tree, _)| *tree.frame() != frame) {
        return Err(frame.mismatch(other.frame()));
    }
    let (mut entries, mut tables) = (0, memory::with_capacity(operands.len())?);
    for (tree, _) in operands {
        tree.ensure_cuts()?;
        tables.push(tree.cuts.map_or(SurfacesRef::NONE, |cuts| cuts.surfaces));
        let records = tree.cuts.map_or(0, |cuts| cuts.heads.len());
        entries += tree.element_count() + tree.brick_count() + records as u64;
    }
    let surfaces = JointSurfaces::new(&frame, tables)?;
    let last = shard.map_or(frame.depth(), |shard| shard.last(frame.depth()));
    let walk = Walk { frame, operands, combination, shard, last, surfaces };
    let exterior = walk.exterior()?;
    // Without surfaces, PARTIAL cells need no records.
    let has_cuts = operands.iter().any(|(tree, _)| tree.cuts.is_some());
    control.run(entries > WORTH_THREADS, |parallel| {
        let parallel = parallel && operands.len() <= MOST_IN_PARALLEL;
        let walk = Threads { walk: &walk, parallel };
        let mut writer = Writer::new(&job, frame.depth(), false);
        if has_cuts {
            writer.note_runs();
        }
        let mut hand = Hand {
            windows: memory::collected(operands.iter().map(|(tree, _)| Windows::new(tree)))?,
            out: Output::new(writer, &frame)?,
        };
        let root = walk.root(&mut hand)?;
        // In all other cases the progress is counted in the elements below the root's.
        if !matches!(root, Fate::Goes(Part::Open(..) | Part::Function(_))) {
            job.advance(WHOLE);
        }
        let (tag, cut) = match root {
            Fate::Goes(part) => walk.one(0, Cell::ROOT, &part, &mut hand)?,
            Fate::Settled(tag) => (tag, Cut::None),
            Fate::Ends(cut) => (Tag::Partial, cut),
        };
        let Output { writer, cuts } = hand.out;
        let surfaces = &walk.walk.surfaces;
        let (order, group) = (|a, b| surfaces.order(a, b), |id| surfaces.group(id));
        let cuts = match has_cuts {
            true => cuts.finish((tag == Tag::Partial).then_some(cut), order, group)?,
            false => None,
        };
        let cuts = match cuts {
            Some((cuts, used)) => {
                let (surfaces, moments) = (surfaces.written(&used)?, walk.walk.moments());
                Some(Cuts { surfaces, moments, ..cuts })
            }
            None => None,
        };
        Ok(writer.finish_with(&frame, tag, exterior, cuts)?.with_proof(walk.walk.proof()))
    })
}

/// The content of an operand in a cell that it does not decide.
#[derive(Debug, Clone, Copy)]
enum Side {
    /// Nothing is known.
    Unknown,
    /// A function of surfaces, complemented if the operand is; `is_wide` if it belongs to a larger cell.
    Function { ids: [u32; 3], table: u8, is_wide: bool },
    /// The index of the first of eight records.
    Records(usize),
    /// An octant of an element.
    Octant { index: usize, octant: u8 },
    /// A whole element.
    Element { parent: usize, index: usize },
}

/// The content of an operand in a cell.
enum Met {
    Empty,
    Full,
    Open(Side),
}

/// A subtree to be copied.
#[derive(Debug, Clone, Copy)]
struct Copied {
    of: u32,
    parent: usize,
    index: usize,
    flip: bool,
}

/// The joint tag of one cell from two trees, where PARTIAL means unknown.
fn both(one: Tag, other: Tag) -> Result<Tag, Error> {
    match (one, other) {
        (Tag::Partial, known) | (known, Tag::Partial) => Ok(known),
        (one, other) if one == other => Ok(one),
        _ => Err(contradiction()),
    }
}

fn contradiction() -> Error {
    let problem = "do not describe one solid: one says FULL where another one says EMPTY";
    Error::Argument { name: "trees", problem }
}

/// The content of a cell that is to be split.
enum Part {
    /// Only one operand matters, and the cell has an element there.
    Copy(Copied),
    /// The undecided operands, and whether their combination is complemented.
    Open(Vec<(u32, Side)>, bool),
    /// A function of surfaces.
    Function(Function),
}

/// The state of one thread, and its output.
struct Hand<'j> {
    /// The passed part of each operand.
    windows: Vec<Windows>,
    out: Output<'j>,
}

impl<'j> AsMut<Output<'j>> for Hand<'j> {
    fn as_mut(&mut self) -> &mut Output<'j> {
        &mut self.out
    }
}

struct Walk<'a> {
    frame: Frame,
    operands: &'a [(OctreeRef<'a>, bool)],
    combination: Combination,
    /// The wanted cells; `None` for all cells.
    shard: Option<Shard>,
    /// The level below which cells are not split.
    last: u8,
    surfaces: JointSurfaces<'a>,
}

impl Walk<'_> {
    /// Returns whether the combination of the operands is complemented.
    fn flip(&self) -> bool {
        self.combination == Combination::All { flip: true }
    }

    fn is_odd(&self) -> bool {
        self.combination == Combination::Odd
    }

    /// The tag outside the universe.
    fn exterior(&self) -> Result<Tag, Error> {
        let all =
            self.operands.iter().map(|(tree, flip)| Planes::uniform(tree.exterior()).complement_if(*flip));
        let one = match self.combination {
            Combination::Known => {
                return all.map(|planes| planes.tag(0)).try_fold(Tag::Partial, both);
            }
            Combination::All { .. } => all.reduce(Planes::intersection),
            Combination::Odd => all.reduce(|a, b| {
                if [a, b].iter().any(|planes| planes.tag(0) == Tag::Partial) {
                    Planes::uniform(Tag::Partial)
                } else {
                    a.xor(b)
                }
            }),
        };
        Ok(one.unwrap_or(Planes::uniform(Tag::Partial)).complement_if(self.flip()).tag(0))
    }

    /// The proof of the result's cells.
    fn proof(&self) -> Proof {
        let proof = |(tree, flip): &(OctreeRef<'_>, bool)| {
            if *flip { tree.proof().complement() } else { tree.proof() }
        };
        let one =
            self.operands.iter().map(proof).reduce(|a, b| if self.is_odd() { a.xor(b) } else { a.and(b) });
        let one = one.unwrap_or(Proof::CERTIFIED);
        if self.flip() { one.complement() } else { one }
    }

    /// The moments of the solid, if the operation does not change the solid.
    fn moments(&self) -> Option<StoredMoments> {
        match self.combination {
            Combination::Known => self.operands.iter().find_map(|(tree, _)| tree.cuts?.moments).copied(),
            _ => None,
        }
    }

    /// Returns whether a cell contains no wanted cell.
    fn is_without(&self, cell: Cell) -> bool {
        self.shard.is_some_and(|shard| shard.is_without(cell))
    }

    fn operand(&self, of: u32) -> (&OctreeRef<'_>, bool) {
        let (tree, flip) = &self.operands[of as usize];
        (tree, *flip)
    }

    /// A decided cell of an operand.
    fn settled(is_full: bool) -> Met {
        if is_full { Met::Full } else { Met::Empty }
    }

    /// Returns the content of a record of an operand.
    fn record(&self, of: u32, record: usize) -> Side {
        let (tree, flip) = self.operand(of);
        match tree.cuts.as_ref().map_or(CellCut::None, |cuts| cuts.at(record)) {
            CellCut::None => Side::Unknown,
            CellCut::Split(first) => Side::Records(first),
            CellCut::Table { ids: own, table } => {
                let names = self.surfaces.names(of as usize);
                let (mut ids, mut table) = ([0; 3], if flip { !table } else { table });
                for (i, &id) in own.iter().enumerate() {
                    let Some(&(name, negated)) = names.get(id as usize) else { return Side::Unknown };
                    if negated {
                        table = Head::negated(table, i);
                    }
                    ids[i] = name;
                }
                Side::Function { ids, table, is_wide: false }
            }
        }
    }

    /// Returns the cut of an operand's record in a cell that the other operands leave to it.
    fn taken(&self, of: u32, record: usize, flip: bool) -> Cut {
        match self.record(of, record) {
            Side::Function { ids, table, .. } => Cut::Table { ids, table: if flip { !table } else { table } },
            Side::Records(first) => {
                Cut::Split(Box::new(core::array::from_fn(|k| self.taken(of, first + k, flip))))
            }
            _ => Cut::None,
        }
    }

    /// Refuses operands that contradict the decision for the whole cell in a part of it.
    fn agree(&self, cell: Cell, settled: Tag, open: &[(u32, Side)]) -> Result<(), Error> {
        let opposite = if settled == Tag::Full { Tag::Empty } else { Tag::Full };
        let first = cell.first_at(self.frame.depth()).at;
        let edge = 1 << (self.frame.depth() - cell.level);
        let against = CellFilter::tags(&[opposite]).within(first, first.each(|at| at + edge));
        for (of, side) in open {
            let is_split = matches!(side, Side::Element { .. } | Side::Octant { .. });
            if is_split && self.operand(*of).0.cells(against).next().is_some() {
                return Err(contradiction());
            }
        }
        Ok(())
    }

    /// Returns the fate of a cell for [`Combination::Known`]. The operands in `open` know a part of the cell
    /// without deciding it; all others know nothing.
    fn known(&self, cell: Cell, open: Vec<(u32, Side)>) -> Fate<Part> {
        let function = open.iter().find_map(|(_, side)| match *side {
            Side::Function { ids, table, .. } => Some(Cut::Table { ids, table }),
            _ => None,
        });
        if let Some(cut) = function {
            return Fate::Ends(cut);
        }
        if open.is_empty() || cell.level == self.last {
            return Fate::Ends(Cut::None);
        }
        match *open {
            _ if self.shard.is_some_and(|shard| !shard.has_all_in(cell)) => {}
            [(of, Side::Element { parent, index })] => {
                return Fate::Goes(Part::Copy(Copied { of, parent, index, flip: false }));
            }
            [(of, Side::Records(first))] => {
                let eight = core::array::from_fn(|k| self.taken(of, first + k, false));
                return Fate::Ends(Cut::Split(Box::new(eight)));
            }
            _ => {}
        }
        Fate::Goes(Part::Open(open, false))
    }

    /// Returns the fate of a cell that the operands in `open` do not decide, and in which all others do not
    /// matter.
    fn fate(&self, cell: Cell, open: Vec<(u32, Side)>, flip: bool) -> Result<Fate<Part>, Error> {
        let is_last = cell.level == self.last;
        match *open {
            [] => {
                // All operands are FULL for an intersection; the number is even for an XOR.
                let is_full = self.is_odd() == flip;
                return Ok(Fate::Settled(if is_full { Tag::Full } else { Tag::Empty }));
            }
            [(of, Side::Element { parent, index })] => {
                let flip = flip ^ self.operand(of).1;
                return Ok(Fate::Goes(Part::Copy(Copied { of, parent, index, flip })));
            }
            [(of, Side::Records(first))] => {
                let eight = core::array::from_fn(|k| self.taken(of, first + k, flip));
                return Ok(Fate::Ends(Cut::Split(Box::new(eight))));
            }
            [(_, Side::Function { ids, table, is_wide: false })] => {
                return Ok(Fate::Ends(Cut::Table { ids, table: if flip { !table } else { table } }));
            }
            _ => {}
        }
        let is_unknown = |(_, side): &(u32, Side)| matches!(side, Side::Unknown);
        let ends = |(_, side): &(u32, Side)| matches!(side, Side::Unknown | Side::Function { .. });
        if open.iter().any(is_unknown) && (self.is_odd() || open.iter().all(ends)) {
            return Ok(Fate::Ends(Cut::None));
        }
        if open.iter().all(ends)
            && let Some(function) = self.function(&open, flip)
        {
            let function = function.simplified(cell, &self.surfaces)?;
            return Ok(match function.end() {
                Some(done) => done.into(),
                None if is_last => Fate::Ends(Cut::None),
                None => Fate::Goes(Part::Function(function)),
            });
        }
        Ok(if is_last { Fate::Ends(Cut::None) } else { Fate::Goes(Part::Open(open, flip)) })
    }

    /// Combines the functions of the operands; `None` if the result needs more than six surfaces.
    fn function(&self, open: &[(u32, Side)], flip: bool) -> Option<Function> {
        let mut all: Option<Function> = None;
        for (_, side) in open {
            let Side::Function { ids, table, .. } = side else { return None };
            let own = Function::of_record(*ids, *table);
            all = Some(match all {
                None => own,
                Some(all) if self.is_odd() => all.with(&own, |a, b| a ^ b)?,
                Some(all) => all.with(&own, |a, b| a & b)?,
            });
        }
        all.map(|all| all.complement_if(flip))
    }

    /// Returns the content of an operand in the children of a cell.
    fn below(
        &self,
        of: u32,
        side: &Side,
        cell: Cell,
        e: usize,
        windows: &mut Windows,
    ) -> Result<[Met; 8], Error> {
        let (tree, flip) = self.operand(of);
        let entry = |index: usize| {
            let brick = index.saturating_sub(tree.planes.len()) as u64;
            tree.entry(index).ok_or(Damage::Dictionary { brick })
        };
        let mut met = OCTANTS.each(|_| Met::Open(Side::Unknown));
        let partial = |index: usize, planes: Planes, c: u32| {
            let record = tree.cuts.as_ref().map(|cuts| cuts.record(index, planes, c));
            Met::Open(record.map_or(Side::Unknown, |record| self.record(of, record)))
        };
        match *side {
            Side::Unknown => {}
            Side::Function { ids, table, .. } => {
                let children = Function::of_record(ids, table).below(cell, &self.surfaces)?;
                for (met, child) in met.iter_mut().zip(children) {
                    *met = match child.end() {
                        Some((Tag::Partial, Cut::Table { ids, table })) => {
                            Met::Open(Side::Function { ids, table, is_wide: true })
                        }
                        Some((tag, _)) => Walk::settled(tag == Tag::Full),
                        None => Met::Open(Side::Unknown),
                    };
                }
            }
            Side::Records(first) => {
                for (k, met) in met.iter_mut().enumerate() {
                    *met = Met::Open(self.record(of, first + k));
                }
            }
            Side::Element { index, .. } => {
                let planes = entry(index)?;
                for (k, met) in OCTANTS.into_iter().zip(&mut met) {
                    *met = match planes.octant(k.into()) {
                        Tag::Branch => Met::Open(Side::Octant { index, octant: k }),
                        Tag::Partial => partial(index, planes, 8 * u32::from(k)),
                        tag => Walk::settled((tag == Tag::Full) != flip),
                    };
                }
            }
            Side::Octant { index, octant } => {
                let planes = entry(index)?;
                for (k, met) in OCTANTS.into_iter().zip(&mut met) {
                    let c = 8 * u32::from(octant) + u32::from(k);
                    *met = match planes.tag(c) {
                        Tag::Branch if e + 1 == tree.levels() => {
                            let brick = index.saturating_sub(tree.planes.len()) as u64;
                            return Err(Damage::BrickBranch { brick }.into());
                        }
                        Tag::Branch => Met::Open(Side::Element {
                            parent: index,
                            index: windows.child(tree, index, planes.branch(), c, e + 1)?,
                        }),
                        Tag::Partial => partial(index, planes, c),
                        tag => Walk::settled((tag == Tag::Full) != flip),
                    };
                }
            }
        }
        Ok(met)
    }

    /// Copies neighbouring subtrees, whose elements `run` of level `e` have been admitted.
    fn copy(&self, copied: &Copied, e: usize, run: Range<usize>, hand: &mut Hand<'_>) -> Result<(), Error> {
        let Copied { of, parent, flip, .. } = *copied;
        let (tree, _) = self.operand(of);
        let Hand { windows, out: Output { writer, cuts } } = hand;
        let names = self.surfaces.names(of as usize);
        let windows = &mut windows[of as usize];
        windows.put_back(e, run.start);
        writer.copy(tree, windows, parent, e, run, flip)?;
        let mut bytes = 0;
        for (level, run) in writer.noted_runs() {
            bytes += match &tree.cuts {
                Some(own) => cuts.copy(level, own, run, names, flip)?,
                None => cuts.copy_plain(level, run.filter_map(|index| tree.entry(index)))?,
            };
        }
        writer.job().spend(0, bytes)
    }
}

/// A walk, possibly with several threads.
struct Threads<'w, 'a> {
    walk: &'w Walk<'a>,
    parallel: bool,
}

impl Threads<'_, '_> {
    fn root(&self, hand: &mut Hand<'_>) -> Result<Fate<Part>, Error> {
        let half = starts_half_way(self.walk.frame.depth());
        let mut met = memory::with_capacity(self.walk.operands.len())?;
        for ((of, (tree, flip)), windows) in (0..).zip(self.walk.operands).zip(&mut hand.windows) {
            met.push((
                of,
                match tree.root_tag() {
                    Tag::Branch => {
                        windows.admit(0, 0, 0, 1)?;
                        Met::Open(match half {
                            true => Side::Octant { index: 0, octant: 0 },
                            false => Side::Element { parent: 0, index: 0 },
                        })
                    }
                    Tag::Partial => Met::Open(match tree.cuts {
                        Some(_) => self.walk.record(of, CutsRef::ROOT),
                        None => Side::Unknown,
                    }),
                    tag => Walk::settled((tag == Tag::Full) != *flip),
                },
            ));
        }
        self.gathered(Cell::ROOT, met.into_iter(), self.walk.flip())
    }

    /// Returns the fate of a cell with these contents of the operands.
    fn gathered(
        &self,
        cell: Cell,
        met: impl ExactSizeIterator<Item = (u32, Met)>,
        mut flip: bool,
    ) -> Result<Fate<Part>, Error> {
        let mut open = Vec::new();
        if self.walk.combination == Combination::Known {
            return self.gathered_known(cell, met);
        }
        let is_odd = self.walk.is_odd();
        for (of, met) in met {
            match met {
                Met::Empty if !is_odd => {
                    return Ok(Fate::Settled(if flip { Tag::Full } else { Tag::Empty }));
                }
                Met::Full => flip ^= is_odd,
                Met::Empty => {}
                Met::Open(side) => memory::push(&mut open, (of, side))?,
            }
        }
        self.walk.fate(cell, open, flip)
    }

    /// [`gathered`](Self::gathered) for operands that each know a part of one solid.
    fn gathered_known(&self, cell: Cell, met: impl Iterator<Item = (u32, Met)>) -> Result<Fate<Part>, Error> {
        let (mut open, mut settled) = (Vec::new(), Tag::Partial);
        if self.walk.is_without(cell) {
            return Ok(Fate::Ends(Cut::None));
        }
        for (of, met) in met {
            match met {
                Met::Empty => settled = both(settled, Tag::Empty)?,
                Met::Full => settled = both(settled, Tag::Full)?,
                Met::Open(Side::Unknown) => {}
                Met::Open(side) => memory::push(&mut open, (of, side))?,
            }
        }
        if settled == Tag::Partial {
            return Ok(self.walk.known(cell, open));
        }
        self.walk.agree(cell, settled, &open)?;
        Ok(Fate::Settled(settled))
    }

    /// Returns the level of the element that contains the children of a cell.
    fn element_level(&self, cell: Cell) -> usize {
        let half = u8::from(starts_half_way(self.walk.frame.depth()));
        usize::from((cell.level + half) / 2)
    }

    /// Writes elements of level `e` as independent tasks, and appends their outputs in order.
    fn elements_in_parallel<'j>(
        &self,
        e: usize,
        open: Vec<(Cell, Part)>,
        hand: &mut Hand<'j>,
    ) -> Result<Vec<Done>, Error> {
        let mut tasks = memory::with_capacity(open.len())?;
        for (cell, part) in open {
            let mut windows = memory::collected(hand.windows.iter().cloned())?;
            let mut cut_off = |of: u32, index: usize| {
                let of = of as usize;
                let (tree, _) = self.walk.operand(of as u32);
                windows[of] = hand.windows[of].below(tree, e, index..index + 1)?;
                Ok::<(), Error>(())
            };
            match &part {
                Part::Copy(copied) => cut_off(copied.of, copied.index)?,
                Part::Open(sides, _) => {
                    for (of, side) in sides {
                        if let Side::Element { index, .. } = side {
                            cut_off(*of, *index)?;
                        }
                    }
                }
                Part::Function(_) => {}
            }
            tasks.push((cell, part, windows));
        }
        let share = self.share(e, tasks.len(), &hand.out);
        let out = &hand.out;
        let done = each(true, tasks.into_iter(), |(cell, part, windows)| {
            let mut own = Hand { windows, out: out.sibling(&self.walk.frame)? };
            let done = self.one(e, cell, &part, &mut own)?;
            own.out.writer.job().advance(share);
            Ok((done, own.out))
        })?;
        let mut all = memory::with_capacity(done.len())?;
        for (done, out) in done {
            hand.out.writer.append(out.writer)?;
            hand.out.cuts.append(out.cuts, u32::MAX, 0)?;
            all.push(done);
        }
        Ok(all)
    }

    /// Returns the progress of each of a number of elements of level `e`, and reports the remainder of the
    /// division.
    fn share(&self, e: usize, elements: usize, out: &Output<'_>) -> usize {
        if e != 1 {
            return 0;
        }
        let share = WHOLE.checked_div(elements).unwrap_or(0);
        out.writer.job().advance(WHOLE - share * elements);
        share
    }

    fn one(&self, e: usize, cell: Cell, part: &Part, hand: &mut Hand<'_>) -> Result<Done, Error> {
        match part {
            Part::Copy(copied) => {
                self.walk.copy(copied, e, copied.index..copied.index + 1, hand)?;
                Ok((Tag::Branch, Cut::None))
            }
            part => element(self, e, cell, part, hand),
        }
    }
}

impl<'j> Source<'j> for Threads<'_, '_> {
    type Part = Part;
    type Hand = Hand<'j>;

    fn frame(&self) -> &Frame {
        &self.walk.frame
    }

    fn surfaces(&self) -> &impl Known {
        &self.walk.surfaces
    }

    fn children(&self, cell: Cell, part: &Part, hand: &mut Hand<'j>) -> Result<Family<Part>, Error> {
        let mut family = OCTANTS.each(|_| Fate::Ends(Cut::None));
        match part {
            Part::Copy(_) => {}
            Part::Function(function) => {
                let is_last = cell.level + 1 == self.walk.frame.depth();
                let children = function.below(cell, &self.walk.surfaces)?;
                for ((k, fate), child) in OCTANTS.into_iter().zip(&mut family).zip(children) {
                    let child = child.simplified(cell.child(k), &self.walk.surfaces)?;
                    *fate = match child.end() {
                        Some(done) => done.into(),
                        None if is_last => Fate::Ends(Cut::None),
                        None => Fate::Goes(Part::Function(child)),
                    };
                }
            }
            Part::Open(sides, flip) => {
                let e = self.element_level(cell);
                let mut below = memory::with_capacity(sides.len())?;
                for (of, side) in sides {
                    let windows = &mut hand.windows[*of as usize];
                    below.push((*of, self.walk.below(*of, side, cell, e, windows)?.each(Some)));
                }
                for (k, fate) in OCTANTS.into_iter().zip(&mut family) {
                    let met = below.iter_mut().map(|(of, met)| {
                        (*of, met[usize::from(k)].take().unwrap_or(Met::Open(Side::Unknown)))
                    });
                    *fate = self.gathered(cell.child(k), met, *flip)?;
                }
            }
        }
        Ok(family)
    }

    fn elements(&self, e: usize, open: Vec<(Cell, Part)>, hand: &mut Hand<'j>) -> Result<Vec<Done>, Error> {
        if self.parallel && (1..3).contains(&e) && open.len() > 1 {
            return self.elements_in_parallel(e, open, hand);
        }
        let mut done = memory::with_capacity(open.len())?;
        let (share, mut next) = (self.share(e, open.len(), &hand.out), 0);
        while let Some((cell, part)) = open.get(next) {
            // Neighbouring subtrees are copied together.
            let mut run = 1;
            if let Part::Copy(first) = part {
                let follows = |(run, (_, part)): &(usize, &(Cell, Part))| {
                    let next = |own: &Copied| {
                        (own.of, own.index, own.flip) == (first.of, first.index + run, first.flip)
                    };
                    matches!(part, Part::Copy(own) if next(own))
                };
                run += (1..).zip(&open[next + 1..]).take_while(follows).count();
                self.walk.copy(first, e, first.index..first.index + run, hand)?;
                done.extend((0..run).map(|_| (Tag::Branch, Cut::None)));
            } else {
                done.push(element(self, e, *cell, part, hand)?);
            }
            next += run;
            hand.out.writer.job().advance(share * run);
        }
        Ok(done)
    }
}
