//! Building elements from cells, from the finest up.

use super::function::{Done, Function, Known};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, Frame};
use crate::memory;
use crate::octree::cuts::{Cut, CutWriter};
use crate::octree::view::{element_levels, starts_half_way};
use crate::octree::writer::Writer;
use crate::octree::{Planes, Tag};
use crate::solid::OCTANTS;
use alloc::vec::Vec;

/// The result of examining a cell.
#[derive(Clone)]
pub(super) enum Fate<P> {
    /// The cell is decided.
    Settled(Tag),
    /// The cell is PARTIAL, and is not split.
    Ends(Cut),
    /// The cell is split.
    Goes(P),
}

impl<P> Fate<P> {
    fn done(self) -> Result<Done, P> {
        match self {
            Fate::Settled(tag) => Ok((tag, Cut::None)),
            Fate::Ends(cut) => Ok((Tag::Partial, cut)),
            Fate::Goes(part) => Err(part),
        }
    }
}

impl<P> From<Done> for Fate<P> {
    fn from((tag, cut): Done) -> Fate<P> {
        if tag == Tag::Partial { Fate::Ends(cut) } else { Fate::Settled(tag) }
    }
}

/// The fates of the eight children of a cell.
pub(super) type Family<P> = [Fate<P>; 8];

/// The output of a thread: elements, and their cuts.
pub(super) struct Output<'j> {
    pub writer: Writer<'j>,
    pub cuts: CutWriter,
}

impl<'j> Output<'j> {
    pub(super) fn new(writer: Writer<'j>, frame: &Frame) -> Result<Output<'j>, Error> {
        Ok(Output { writer, cuts: CutWriter::new(element_levels(frame.depth()))? })
    }

    /// Returns an empty output for a part of the same tree.
    pub(super) fn sibling(&self, frame: &Frame) -> Result<Output<'j>, Error> {
        Output::new(self.writer.sibling(), frame)
    }
}

/// The source of a tree's cells.
pub(super) trait Source<'j> {
    /// The content of a cell that is to be split.
    type Part;
    /// The state of a thread.
    type Hand: AsMut<Output<'j>>;

    fn frame(&self) -> &Frame;

    fn surfaces(&self) -> &impl Known;

    /// Returns the fates of the children of a cell.
    fn children(
        &self,
        cell: Cell,
        part: &Self::Part,
        hand: &mut Self::Hand,
    ) -> Result<Family<Self::Part>, Error>;

    /// Writes cells as elements of level `e`, one after the other.
    fn elements(
        &self,
        e: usize,
        open: Vec<(Cell, Self::Part)>,
        hand: &mut Self::Hand,
    ) -> Result<Vec<Done>, Error>;
}

/// An octant of an element: one cell, or eight cells.
enum Octant<T> {
    One(Done),
    Eight([T; 8]),
}

/// Writes the element of level `e` of a split cell; returns the cell's tag, and its cut if the tag is
/// PARTIAL.
pub(super) fn element<'j, S: Source<'j>>(
    source: &S,
    e: usize,
    cell: Cell,
    part: &S::Part,
    hand: &mut S::Hand,
) -> Result<Done, Error> {
    hand.as_mut().writer.job().check()?;
    // The octants, each with its cells.
    let mut octants = memory::with_capacity(8)?;
    if e == 0 && starts_half_way(source.frame().depth()) {
        octants.push((cell, Octant::Eight(source.children(cell, part, hand)?)));
    } else {
        for (k, fate) in OCTANTS.into_iter().zip(source.children(cell, part, hand)?) {
            let child = cell.child(k);
            octants.push((
                child,
                match fate.done() {
                    Ok(done) => Octant::One(done),
                    Err(part) => Octant::Eight(source.children(child, &part, hand)?),
                },
            ));
        }
    }
    // Finished cells stay here; cells that go on are moved to `open`.
    let mut open = Vec::new();
    let mut told = memory::with_capacity(octants.len())?;
    for (octant, cells) in octants {
        told.push((
            octant,
            match cells {
                Octant::One(done) => Octant::One(done),
                Octant::Eight(eight) => {
                    open.try_reserve(8)?;
                    let mut octants = OCTANTS.into_iter();
                    Octant::Eight(eight.each(|fate| {
                        let child = octants.next().map(|k| octant.child(k));
                        fate.done().map_err(|part| open.extend(child.map(|child| (child, part)))).ok()
                    }))
                }
            },
        ));
    }
    let mut written = source.elements(e + 1, open, hand)?.into_iter();
    let mut cells = memory::with_capacity(8)?;
    for (at, octant) in told {
        cells.push(match octant {
            Octant::One(one) => Octant::One(one),
            Octant::Eight(eight) => {
                let eight =
                    eight.each(|done| done.or_else(|| written.next()).unwrap_or((Tag::Partial, Cut::None)));
                match joined(at, eight.iter(), source)? {
                    Some(done) => Octant::One(done),
                    None => merged(eight),
                }
            }
        });
    }
    if cells.len() == 8 && cells.iter().all(|octant| matches!(octant, Octant::One(_))) {
        let ones = cells.iter().filter_map(|octant| match octant {
            Octant::One(one) => Some(one),
            Octant::Eight(_) => None,
        });
        if let Some(done) = joined(cell, ones, source)? {
            return Ok(done);
        }
    }
    put(e, cells, hand.as_mut())
}

/// Joins a cell whose eight children are one function of up to three surfaces.
fn joined<'d, 'j>(
    cell: Cell,
    children: impl Iterator<Item = &'d Done> + Clone,
    source: &impl Source<'j>,
) -> Result<Option<Done>, Error> {
    let joined = Function::joined(cell, children, source.surfaces())?;
    Ok(joined.and_then(|function| function.end()))
}

/// Stores the element of level `e` with these octants, unless all its cells agree.
fn put(e: usize, octants: Vec<Octant<Done>>, out: &mut Output<'_>) -> Result<Done, Error> {
    let mut planes = Planes::uniform(Tag::Empty);
    for (k, octant) in octants.iter().enumerate() {
        for c in 0..8 {
            let (tag, _) = match octant {
                Octant::One(one) => one,
                Octant::Eight(eight) => &eight[c],
            };
            planes.set((8 * k + c) as u32, *tag);
        }
    }
    let tag = out.writer.put(e, planes)?;
    match tag {
        Tag::Branch => {
            let cells = octants.iter().flat_map(|octant| match octant {
                Octant::One(one) => core::slice::from_ref(one),
                Octant::Eight(eight) => eight,
            });
            let cuts = cells.filter(|(tag, _)| *tag == Tag::Partial).map(|(_, cut)| cut);
            let count = out.cuts.put(e, cuts)?;
            out.writer.job().spend(0, size_of::<Cut>() * count)?;
            Ok((tag, Cut::None))
        }
        Tag::Partial => {
            out.writer.job().spend(0, size_of::<[Cut; 8]>())?;
            let mut own = octants.into_iter().map(|octant| match octant {
                Octant::One((_, cut)) => cut,
                // (At an odd depth, the root element has only one octant.)
                Octant::Eight(eight) => Cut::of_children(eight.each(|(_, cut)| cut)),
            });
            let children: [Option<Cut>; 8] = core::array::from_fn(|_| own.next());
            Ok((
                tag,
                match children {
                    [Some(one), None, ..] => one,
                    all => Cut::of_children(all.each(|cut| cut.unwrap_or(Cut::None))),
                },
            ))
        }
        _ => Ok((tag, Cut::None)),
    }
}

/// Merges eight cells into one if they agree.
fn merged(cells: [Done; 8]) -> Octant<Done> {
    let [(tag, _), ..] = cells;
    if tag == Tag::Branch || cells.iter().any(|(other, _)| *other != tag) {
        return Octant::Eight(cells);
    }
    Octant::One((tag, Cut::of_children(cells.each(|(_, cut)| cut))))
}
