//! The cells along a ray, front to back.

use super::cut::CutLine;
use super::line::{Line, Moment, Passage};
use super::{Obstacle, RayHit, RaySpans};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::sqrt;
use crate::lattice::{Cell, Cube, Interval};
use crate::memory;
use crate::solid::{Enclosure, OCTANTS, Slab, SlabJoin, Verdict};
use alloc::vec::Vec;

/// A source of cells.
pub(super) trait Cells {
    /// The stored data of a cell that can be split.
    type Part;

    fn root(&mut self) -> Result<Verdict<Self::Part>, Error>;

    /// Returns the children of a cell; `None` if the cell is not to be split.
    fn split(&mut self, cell: Cell, part: &Self::Part) -> Result<Option<[Verdict<Self::Part>; 8]>, Error>;

    /// Returns the enclosure of a cell, like [`Ask::enclosure`](crate::solid::Ask::enclosure).
    fn enclosure(&mut self, cell: Cell, part: &Self::Part) -> Result<Option<Enclosure>, Error>;

    /// Returns the table of surfaces that a cell keeps, along a ray between two times.
    fn table(&self, _: &Self::Part, _: &Line<'_>, _: [f64; 2]) -> Option<CutLine<'_>> {
        None
    }

    /// Marks the memory of parts, like [`Parts::mark`](crate::solid::Parts::mark).
    fn mark(&self) -> usize;

    /// Releases the memory of parts, like [`Parts::release`](crate::solid::Parts::release).
    fn release(&mut self, mark: usize);
}

/// A receiver of the cells that a search meets.
pub(super) trait Visitor {
    /// Returns whether a cell may be skipped.
    fn skips(&self, passage: &Passage) -> bool;

    /// Returns whether the cells behind a cell that was met may be skipped.
    fn ends(&self, passage: &Passage) -> bool;

    /// Takes in a cell that is not EMPTY and not split further.
    fn meet(&mut self, line: &Line<'_>, cell: Cell, passage: &Passage, known: Known<'_>)
    -> Result<(), Error>;
}

/// The knowledge about a cell.
pub(super) enum Known<'a> {
    Full,
    /// PARTIAL, perhaps with slabs.
    Partial(Option<Enclosure>),
    /// PARTIAL, with surfaces.
    Table(&'a CutLine<'a>),
}

/// Passes all cells along a ray to a visitor, roughly front to back. The recursion is as deep as the frame.
fn walk<C: Cells>(
    cells: &mut C,
    line: &Line<'_>,
    cell: Cell,
    verdict: Verdict<C::Part>,
    visitor: &mut impl Visitor,
) -> Result<(), Error> {
    if matches!(verdict, Verdict::Empty) {
        return Ok(());
    }
    let Some(passage) = line.passage(cell) else { return Ok(()) };
    if visitor.skips(&passage) {
        return Ok(());
    }
    let part = match verdict {
        Verdict::Empty => return Ok(()),
        Verdict::Full => return visitor.meet(line, cell, &passage, Known::Full),
        Verdict::Undecided => return visitor.meet(line, cell, &passage, Known::Partial(None)),
        Verdict::Partial(part) => part,
    };
    let mark = cells.mark();
    let children = if cell.level < line.frame.depth() { cells.split(cell, &part)? } else { None };
    match children {
        Some(mut children) => {
            for k in OCTANTS.each(|k| k ^ line.mirror) {
                let child = core::mem::replace(&mut children[k as usize], Verdict::Empty);
                walk(cells, line, cell.child(k), child, visitor)?;
            }
            cells.release(mark);
            Ok(())
        }
        None => {
            let times = [passage.entry.t.lower, passage.exit.t.upper];
            if let Some(table) = cells.table(&part, line, times) {
                return visitor.meet(line, cell, &passage, Known::Table(&table));
            }
            let enclosure = cells.enclosure(cell, &part)?;
            visitor.meet(line, cell, &passage, Known::Partial(enclosure))
        }
    }
}

/// A cell that a ray enters, and the lattice plane by which it enters; `None` if it starts there.
pub(super) type Met = (Cell, Option<(usize, u32)>);

/// The first cells that stop a ray.
#[derive(Default)]
pub(super) struct First {
    /// The possible solid with the least t.
    outer: Option<(f64, Cell, [f64; 3])>,
    /// The proven solid with the least t.
    inner: Option<(f64, Cell, [f64; 3])>,
}

impl First {
    pub(super) fn search<C: Cells>(cells: &mut C, line: &Line<'_>) -> Result<First, Error> {
        let mut first = First::default();
        let root = cells.root()?;
        walk(cells, line, Cell::ROOT, root, &mut first)?;
        Ok(first)
    }

    /// Builds the result from the first cells that a ray enters, each with the lattice plane of the entry.
    pub(super) fn of(line: &Line<'_>, outer: Option<Met>, inner: Option<Met>) -> First {
        let entry = |(cell, by): Met| {
            let moment = by.map_or(Moment::START, |(axis, plane)| line.passes(axis, plane));
            (moment.t, cell, line.face(&moment))
        };
        let outer_entry = outer.map(entry);
        let inner_entry = if inner == outer { outer_entry } else { inner.map(entry) };
        First {
            outer: outer_entry.map(|(t, cell, face)| (t.lower, cell, face)),
            inner: inner_entry.map(|(t, cell, face)| (t.upper, cell, face)),
        }
    }

    /// Returns the answer to a query.
    pub(super) fn hit(&self, on: Obstacle) -> Option<RayHit> {
        let (_, cell, normal) = match on {
            Obstacle::Full => self.inner?,
            Obstacle::Upper => self.outer?,
        };
        let upper = self.inner.map_or(f64::INFINITY, |(t, ..)| t);
        // The proven solid is also possible. If the slabs of a solid contradict this, the proven part is
        // trusted.
        let lower = self.outer?.0.min(upper);
        Some(RayHit { t: Interval::between(lower, upper), cell, normal, surface: None })
    }

    /// Returns whether the ray is surely stopped, and whether it may be stopped.
    pub(super) fn stops(&self) -> (bool, bool) {
        (self.inner.is_some(), self.outer.is_some())
    }
}

/// Keeps the lesser of two; among equals the earlier one.
fn keep(kept: &mut Option<(f64, Cell, [f64; 3])>, t: f64, cell: Cell, normal: [f64; 3]) {
    if kept.is_none_or(|(before, ..)| t < before) {
        *kept = Some((t, cell, normal));
    }
}

impl Visitor for First {
    fn skips(&self, passage: &Passage) -> bool {
        self.inner.is_some_and(|(t, ..)| passage.entry.t.lower >= t)
    }

    fn ends(&self, passage: &Passage) -> bool {
        self.inner.is_some_and(|(t, ..)| passage.exit.t.lower >= t)
    }

    fn meet(
        &mut self,
        line: &Line<'_>,
        cell: Cell,
        passage: &Passage,
        known: Known<'_>,
    ) -> Result<(), Error> {
        let (entry, face) = (passage.entry.t, line.face(&passage.entry));
        match known {
            Known::Full => {
                keep(&mut self.outer, entry.lower, cell, face);
                keep(&mut self.inner, entry.upper, cell, face);
            }
            Known::Partial(None) => keep(&mut self.outer, entry.lower, cell, face),
            Known::Partial(Some(enclosure)) => {
                let found = Enclosed::new(line, cell, passage, &enclosure);
                let normal = |slab: Option<usize>| slab.map_or(face, |n| unit(enclosure.slabs[n].normal));
                for (stay, slab) in found.possible.into_iter().flatten() {
                    keep(&mut self.outer, stay.entry.t.lower, cell, normal(slab));
                }
                for (stay, slab) in found.certain.into_iter().flatten() {
                    keep(&mut self.inner, stay.entry.t.upper, cell, normal(slab));
                }
            }
            Known::Table(table) => {
                // The normal belongs to the surface by which the ray enters the possible solid.
                let mut normal = None;
                table.walk(|piece| {
                    if piece.is_inside == Some(false) {
                        normal = None;
                        return true;
                    }
                    let [from, _] = table.around(piece.low, piece.high);
                    let own = *normal.get_or_insert_with(|| {
                        let crossed = piece.surface.filter(|_| piece.low > 0.0);
                        crossed.and_then(|surface| table.normal(line, surface, from)).map_or(face, unit)
                    });
                    keep(&mut self.outer, from, cell, own);
                    let [from, to] = table.within(piece.low, piece.high);
                    let stay = piece.is_inside.and_then(|_| certain_stay(passage, from, to));
                    if let Some(stay) = stay {
                        keep(&mut self.inner, stay.entry.t.upper, cell, own);
                    }
                    stay.is_none()
                });
            }
        }
        Ok(())
    }
}

/// Returns a normal of length 1, up to rounding. Zeros stay zeros; a triangle thinner than the rounding error
/// has such a normal.
pub(super) fn unit(normal: [f64; 3]) -> [f64; 3] {
    let largest = normal.iter().fold(0.0, |largest: f64, c| largest.max(c.abs()));
    if largest == 0.0 {
        return normal;
    }
    let scaled = normal.each(|c| c / largest);
    let length = sqrt(scaled.iter().map(|c| c * c).sum());
    scaled.each(|c| c / length)
}

/// A stay of a ray, and the slab with which it begins; `None` if the ray enters the cell there.
type Bounded = (Passage, Option<usize>);

/// The stays of a ray in a cell according to slabs: when it may be in the solid, and when it surely is.
struct Enclosed {
    possible: [Option<Bounded>; 3],
    certain: [Option<Bounded>; 3],
}

/// An interval of t, and the slab that bounds it from below.
#[derive(Clone, Copy)]
struct Spell {
    from: f64,
    to: f64,
    slab: Option<usize>,
}

impl Spell {
    /// The intersection of two spells.
    fn and(self, other: Spell) -> Spell {
        let slab = if other.from > self.from { other.slab } else { self.slab };
        Spell { from: self.from.max(other.from), to: self.to.min(other.to), slab }
    }
}

impl Enclosed {
    fn new(line: &Line<'_>, cell: Cell, passage: &Passage, enclosure: &Enclosure) -> Enclosed {
        let (entry, exit) = (passage.entry.t, passage.exit.t);
        let (mut possible, mut certain) = ([None; 3], [None; 3]);
        for (n, slab) in enclosure.slabs.iter().enumerate().filter(|(_, slab)| slab.normal != [0.0; 3]) {
            let height = Height::new(line, cell, slab, Interval::between(entry.lower, exit.upper));
            possible[n] = Some(height.perhaps_below(slab.outer, n));
            certain[n] = Some(height.surely_below(slab.inner, n));
        }
        let whole = Spell { from: entry.lower, to: exit.upper, slab: None };
        let joined = |spells: [Option<Spell>; 3]| match enclosure.join {
            SlabJoin::All => [Some(spells.into_iter().flatten().fold(whole, Spell::and)), None, None],
            SlabJoin::Any => spells.each(|spell| spell.map(|spell| whole.and(spell))),
        };
        let may_be =
            |Spell { from, to, slab }: Spell| (from <= to).then(|| (possible_stay(passage, from, to), slab));
        let must_be =
            |Spell { from, to, slab }: Spell| certain_stay(passage, from, to).map(|stay| (stay, slab));
        Enclosed {
            possible: joined(possible).each(|spell| spell.and_then(may_be)),
            certain: joined(certain).each(|spell| spell.and_then(must_be)),
        }
    }
}

/// Returns the stay between two times in a cell. A stay that begins with the cell's entry gets exactly that
/// moment, so that it continues the stay in the previous cell.
fn possible_stay(passage: &Passage, from: f64, to: f64) -> Passage {
    let entry = if from <= passage.entry.t.lower { passage.entry } else { Moment::exactly(from) };
    let exit = if to >= passage.exit.t.upper { passage.exit } else { Moment::exactly(to) };
    Passage { entry, exit }
}

/// Returns the same where the ray is surely in the cell. (Surfaces that agree only at a single point do not
/// prove the ray to be inside.)
fn certain_stay(passage: &Passage, from: f64, to: f64) -> Option<Passage> {
    let Passage { entry, exit } = passage;
    let late = if from > entry.t.lower { from.max(entry.t.upper) } else { from };
    let early = if to < exit.t.upper { to.min(exit.t.lower) } else { to };
    let stay = possible_stay(passage, late, early);
    (stay.entry.t.upper < stay.exit.t.lower).then_some(stay)
}

/// Parts of a ray's stay in a cell, ascending. No two of them meet.
#[derive(Default)]
struct Spans(Vec<(f64, f64)>);

impl Spans {
    fn add(&mut self, low: f64, high: f64) -> Result<(), Error> {
        match self.0.last_mut() {
            Some((_, end)) if *end == low => *end = high,
            _ => memory::push(&mut self.0, (low, high))?,
        }
        Ok(())
    }
}

/// The height n · x along a ray: at + t · slope.
struct Height {
    at: Interval,
    slope: Interval,
    /// All heights in the cell.
    range: Interval,
}

impl Height {
    fn new(line: &Line<'_>, cell: Cell, slab: &Slab, stay: Interval) -> Height {
        let cube = Cube { frame: line.frame, cell };
        let centre = cube.centre_from(line.ray.from);
        let half = Interval::exactly(cube.half_edge());
        let dot = |v: [Interval; 3]| {
            let [x, y, z] = axes(|axis| v[axis].times(Interval::exactly(slab.normal[axis])));
            x.plus(y).plus(z).over(half)
        };
        let (at, slope) = (dot(centre).negated(), dot(line.direction));
        Height { at, slope, range: at.plus(slope.times(stay)) }
    }

    /// Returns the time at which n · x = `bound`; `None` if the slope may be zero.
    fn reaches(&self, bound: f64) -> Option<Interval> {
        let rest = Interval::exactly(bound).minus(self.at);
        if self.slope.lower > 0.0 {
            Some(rest.over(self.slope))
        } else if self.slope.upper < 0.0 {
            Some(rest.negated().over(self.slope.negated()))
        } else {
            None
        }
    }

    /// Returns a spell outside of which n · x > `bound`.
    fn perhaps_below(&self, bound: f64, slab: usize) -> Spell {
        match self.reaches(bound) {
            Some(t) if self.slope.lower > 0.0 => Spell { to: t.upper, ..ALWAYS },
            Some(t) => Spell { from: t.lower, slab: Some(slab), ..ALWAYS },
            None if self.range.lower > bound => NEVER,
            None => ALWAYS,
        }
    }

    /// Returns a spell within which n · x < `bound`, except perhaps at its ends.
    fn surely_below(&self, bound: f64, slab: usize) -> Spell {
        match self.reaches(bound) {
            Some(t) if self.slope.lower > 0.0 => Spell { to: t.lower, ..ALWAYS },
            Some(t) => Spell { from: t.upper, slab: Some(slab), ..ALWAYS },
            None if self.range.upper < bound => ALWAYS,
            None => NEVER,
        }
    }
}

const ALWAYS: Spell = Spell { from: f64::NEG_INFINITY, to: f64::INFINITY, slab: None };
const NEVER: Spell = Spell { from: f64::INFINITY, to: f64::NEG_INFINITY, slab: None };

/// The stays of a ray in cells of two kinds.
#[derive(Default)]
pub(super) struct Stays {
    inner: Vec<Passage>,
    outer: Vec<Passage>,
}

impl Stays {
    pub(super) fn search<C: Cells>(cells: &mut C, line: &Line<'_>) -> Result<RaySpans, Error> {
        let mut stays = Stays::default();
        let root = cells.root()?;
        walk(cells, line, Cell::ROOT, root, &mut stays)?;
        stays.spans(line)
    }

    /// Returns the union of all stays that were met.
    pub(super) fn spans(self, line: &Line<'_>) -> Result<RaySpans, Error> {
        let inner = |[entry, exit]: [Moment; 2]| Interval::new(entry.t.upper, exit.t.lower);
        let outer = |[entry, exit]: [Moment; 2]| Interval::new(entry.t.lower, exit.t.upper);
        Ok(RaySpans { inner: united(line, self.inner, inner)?, outer: united(line, self.outer, outer)? })
    }
}

impl Visitor for Stays {
    fn skips(&self, _: &Passage) -> bool {
        false
    }

    fn ends(&self, _: &Passage) -> bool {
        false
    }

    fn meet(
        &mut self,
        line: &Line<'_>,
        cell: Cell,
        passage: &Passage,
        known: Known<'_>,
    ) -> Result<(), Error> {
        match known {
            Known::Full => {
                add(line, &mut self.inner, passage)?;
                add(line, &mut self.outer, passage)
            }
            Known::Partial(None) => add(line, &mut self.outer, passage),
            Known::Partial(Some(enclosure)) => {
                let Enclosed { possible, certain } = Enclosed::new(line, cell, passage, &enclosure);
                for (stay, _) in certain.iter().flatten() {
                    add(line, &mut self.inner, stay)?;
                }
                possible.iter().flatten().try_for_each(|(stay, _)| add(line, &mut self.outer, stay))
            }
            Known::Table(table) => {
                // Merge pieces that follow each other.
                let (mut inner, mut outer) = (Spans::default(), Spans::default());
                let mut added = Ok(());
                table.walk(|piece| {
                    added = [
                        (piece.is_inside != Some(false), &mut outer),
                        (piece.is_inside == Some(true), &mut inner),
                    ]
                    .into_iter()
                    .filter(|(is_of, _)| *is_of)
                    .try_for_each(|(_, spans)| spans.add(piece.low, piece.high));
                    added.is_ok()
                });
                added?;
                for (low, high) in outer.0 {
                    let [from, to] = table.around(low, high);
                    add(line, &mut self.outer, &possible_stay(passage, from, to))?;
                }
                for (low, high) in inner.0 {
                    let [from, to] = table.within(low, high);
                    if let Some(stay) = certain_stay(passage, from, to) {
                        add(line, &mut self.inner, &stay)?;
                    }
                }
                Ok(())
            }
        }
    }
}

/// Adds a stay, which usually begins where the last one ended.
fn add(line: &Line<'_>, stays: &mut Vec<Passage>, next: &Passage) -> Result<(), Error> {
    match stays.last_mut() {
        Some(last) if goes_on(line, last, next) => extend(line, last, next),
        _ => memory::push(stays, *next)?,
    }
    Ok(())
}

/// True if `next` begins in `last`.
fn goes_on(line: &Line<'_>, last: &Passage, next: &Passage) -> bool {
    line.order(&last.entry, &next.entry).is_le() && line.order(&next.entry, &last.exit).is_le()
}

fn extend(line: &Line<'_>, last: &mut Passage, next: &Passage) {
    if line.order(&next.exit, &last.exit).is_gt() {
        last.exit = next.exit;
    }
}

/// Returns the union of stays.
fn united(
    line: &Line<'_>,
    mut stays: Vec<Passage>,
    rounded: impl Fn([Moment; 2]) -> Option<Interval>,
) -> Result<Vec<Interval>, Error> {
    stays.sort_unstable_by(|a, b| line.order(&a.entry, &b.entry).then_with(|| line.order(&a.exit, &b.exit)));
    let mut united: Vec<Passage> = memory::with_capacity(stays.len())?;
    for stay in &stays {
        match united.last_mut() {
            Some(last) if goes_on(line, last, stay) => extend(line, last, stay),
            _ => united.push(*stay),
        }
    }
    let mut spans: Vec<Interval> = memory::with_capacity(united.len())?;
    for Passage { entry, exit } in united {
        // A stay shorter than the rounding of its ends is not proven.
        let Some(span) = rounded([entry, exit]) else { continue };
        match spans.last_mut() {
            // The two ends differ by less than a rounding.
            Some(last) if span.lower <= last.upper => *last = last.joined(span),
            _ => spans.push(span),
        }
    }
    Ok(spans)
}
