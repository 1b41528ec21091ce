//! Changes in place: rows with slack.
//!
//! Every ray has a slot in one array of intervals, as large as the ray once needed. A ray that outgrows its
//! slot moves to the end. The array is packed when most of it is unused. So the cost of a cut is proportional
//! to the part that it touches.

use super::arrays::{Form, ModelArrays, OwnedRows};
use super::assemble::{Piece, assembled};
use super::boolean::check_operands;
use super::change::{DexelChange, Part, Tally, part};
use super::columns::Columns;
use super::format::{DexelEnds, DexelFormat};
use super::merge::{SetOp, merge, merge_plain};
use super::model::TriDexel;
use super::place::{DoubleSpan, FixedSpan, Place, Span};
use super::view::{Rows, RowsRef, TriDexelRef, Window};
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::Frame;
use crate::memory;
use alloc::vec::Vec;
use core::ops::Range;

/// A tri-dexel model that is changed in place, for machining. The time of a change is proportional to the
/// number of rays and intervals that the second operand touches.
///
/// The editor takes 12 bytes for each ray of the lattice, beside the intervals.
///
/// ```
/// use leafless::{Control, Csg, Frame, dexelize, dexel::DexelEditor, op::DexelOptions};
/// let (frame, control) = (Frame::new([0.0; 3], 64.0, 6)?, Control::default());
/// let dexels = |solid: Csg| dexelize(&solid, &frame, &DexelOptions::default(), &control);
/// let mut part = DexelEditor::new(dexels(Csg::cuboid([2.0; 3], [62.0; 3])?)?.view())?;
/// for x in [10.0, 20.0, 30.0] {
///     let change = part.subtract(dexels(Csg::ball([x, 32.0, 62.0], 4.0)?)?.view(), &control)?;
///     // Half a ball: 2π/3 · 4³.
///     assert!(change.removed.iter().all(|volume| (volume - 134.0).abs() < 7.0));
/// }
/// let part = part.freeze(&control)?;
/// assert!(!part.view().contains_cell([20, 32, 60]) && part.view().contains_cell([20, 32, 50]));
/// # Ok::<(), leafless::Error>(())
/// ```
pub struct DexelEditor {
    frame: Frame,
    format: DexelFormat,
    rays: Rays,
}

/// All directions, in one of the two forms of ends.
enum Rays {
    Fixed([Option<Slots<FixedSpan>>; 3]),
    Double([Option<Slots<DoubleSpan>>; 3]),
}

/// The slot of one ray's intervals.
#[derive(Debug, Clone, Copy, Default)]
struct Slot {
    first: u32,
    count: u32,
    room: u32,
}

impl Slot {
    fn range(&self) -> Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }
}

/// The rays of one direction: all rays of the universe.
struct Slots<S> {
    window: Window,
    slots: Vec<Slot>,
    columns: Columns<S>,
    /// The number of intervals that belong to no slot any more.
    lost: usize,
    scratch: Columns<S>,
}

impl DexelEditor {
    /// Makes a copy that can be changed. O(rays + intervals).
    ///
    /// # Errors
    /// [`Error::Limit`] for 2^32 rays in one direction (a depth of 16), [`Error::OutOfMemory`],
    /// [`Error::DamagedRays`].
    pub fn new(model: &TriDexelRef<'_>) -> Result<DexelEditor, Error> {
        model.sound()?;
        let rays = match model.kind() {
            DexelEnds::Fixed => Rays::Fixed(thawed(model)?),
            DexelEnds::Double => Rays::Double(thawed(model)?),
        };
        Ok(DexelEditor { frame: model.frame, format: model.format, rays })
    }

    /// The lattice.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// The stored data of each interval: the format of the model that was copied. Further data of an operand
    /// is dropped.
    pub fn format(&self) -> DexelFormat {
        self.format
    }

    /// For each axis, x, y and z, whether there are rays along it.
    pub fn directions(&self) -> [bool; 3] {
        match &self.rays {
            Rays::Fixed(all) => all.each_ref().each(Option::is_some),
            Rays::Double(all) => all.each_ref().each(Option::is_some),
        }
    }

    /// Adds the places that lie in `other`. O(rays of its window + intervals there).
    ///
    /// # Errors
    /// As [`TriDexelRef::union`]. After [`Error::OutOfMemory`] and [`Error::Cancelled`] some rays are changed
    /// and others are not. The same operation can then be repeated, or the editor dropped. (After
    /// [`xor`](Self::xor) it can only be dropped.)
    pub fn unite(&mut self, other: &TriDexelRef<'_>, control: &Control<'_>) -> Result<DexelChange, Error> {
        self.apply(SetOp::Union, other, control)
    }

    /// Removes the places that lie in `other`. O(rays of its window + intervals there).
    ///
    /// # Errors
    /// As [`TriDexelRef::union`]. After [`Error::OutOfMemory`] and [`Error::Cancelled`] some rays are
    /// changed, and the same operation can be repeated, as for [`unite`](Self::unite).
    pub fn subtract(&mut self, other: &TriDexelRef<'_>, control: &Control<'_>) -> Result<DexelChange, Error> {
        self.apply(SetOp::Difference, other, control)
    }

    /// Keeps only the places that also lie in `other`. O(rays of the lattice).
    ///
    /// # Errors
    /// As [`TriDexelRef::union`]. After [`Error::OutOfMemory`] and [`Error::Cancelled`] some rays are
    /// changed, and the same operation can be repeated, as for [`unite`](Self::unite).
    pub fn intersect(
        &mut self,
        other: &TriDexelRef<'_>,
        control: &Control<'_>,
    ) -> Result<DexelChange, Error> {
        self.apply(SetOp::Intersection, other, control)
    }

    /// Removes the places that lie in both, and adds the rest of `other`. O(rays of its window + intervals
    /// there).
    ///
    /// # Errors
    /// As [`TriDexelRef::union`]. After [`Error::OutOfMemory`] and [`Error::Cancelled`] the editor can only
    /// be dropped.
    pub fn xor(&mut self, other: &TriDexelRef<'_>, control: &Control<'_>) -> Result<DexelChange, Error> {
        self.apply(SetOp::Xor, other, control)
    }

    /// The number of intervals in all directions. O(rays).
    pub fn interval_count(&self) -> u64 {
        fn of<S>(all: &[Option<Slots<S>>]) -> u64 {
            all.iter().flatten().flat_map(|slots| &slots.slots).map(|slot| u64::from(slot.count)).sum()
        }
        match &self.rays {
            Rays::Fixed(all) => of(all),
            Rays::Double(all) => of(all),
        }
    }

    /// The number of bytes of the editor.
    pub fn bytes(&self) -> u64 {
        fn of<S: Span>(all: &[Option<Slots<S>>], format: &DexelFormat) -> u64 {
            let one = |slots: &Slots<S>| {
                size_of_val(&*slots.slots) + slots.columns.spans.len() * format.bytes_per_interval()
            };
            all.iter().flatten().map(one).sum::<usize>() as u64
        }
        match &self.rays {
            Rays::Fixed(all) => of(all, &self.format),
            Rays::Double(all) => of(all, &self.format),
        }
    }

    /// Makes a model of the current state, in dense arrays. O(rays + intervals).
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], [`Error::Cancelled`].
    pub fn freeze(&self, control: &Control<'_>) -> Result<TriDexel, Error> {
        let rays = match &self.rays {
            Rays::Fixed(all) => frozen(all, &self.format, control)?,
            Rays::Double(all) => frozen(all, &self.format, control)?,
        };
        Ok(TriDexel::new(ModelArrays { frame: self.frame, format: self.format, rays }))
    }

    fn apply(
        &mut self,
        op: SetOp,
        other: &TriDexelRef<'_>,
        control: &Control<'_>,
    ) -> Result<DexelChange, Error> {
        check_operands(&self.frame, self.directions(), other)?;
        other.sound()?;
        if other.kind() != self.format.ends {
            let format = DexelFormat { ends: self.format.ends, ..other.format };
            let other = control.share([0.0, 0.5], |control| other.to_format(format, control))?;
            return control.share([0.5, 1.0], |control| self.apply(op, other.view(), control));
        }
        let plain = self.format.is_plain();
        let job = Job::new(control);
        job.check()?;
        let axes = self.directions().iter().filter(|&&has| has).count();
        let mut change = DexelChange::NONE;
        for axis in 0..3 {
            let parts = WHOLE / axes;
            let tally = match (&mut self.rays, &other.rays[axis]) {
                (Rays::Fixed(all), Some(rows)) => changed(op, &mut all[axis], rows, plain, parts, &job)?,
                (Rays::Double(all), Some(rows)) => changed(op, &mut all[axis], rows, plain, parts, &job)?,
                _ => continue,
            };
            change.add(axis, &tally, &self.frame);
        }
        Ok(change)
    }
}

fn thawed<S: Form>(model: &TriDexelRef<'_>) -> Result<[Option<Slots<S>>; 3], Error> {
    let mut all = [const { None }; 3];
    for (slots, rows) in all.iter_mut().zip(&model.rays) {
        if let Some(rows) = rows.as_ref().and_then(S::rows) {
            *slots = Some(Slots::new(&rows, model)?);
        }
    }
    Ok(all)
}

fn frozen<S: Form>(
    all: &[Option<Slots<S>>; 3],
    format: &DexelFormat,
    control: &Control<'_>,
) -> Result<[Option<OwnedRows>; 3], Error> {
    let mut rays = [const { None }; 3];
    let job = Job::new(control);
    let axes = all.iter().flatten().count();
    let mut done = 0;
    for (rows, slots) in rays.iter_mut().zip(all) {
        if let Some(slots) = slots {
            let before = WHOLE * done / axes;
            done += 1;
            let (parts, mut told) = (WHOLE * done / axes - before, 0);
            let mut piece = Piece::new(format, slots.slots.len())?;
            let view = slots.columns.view();
            let live = slots.slots.iter().map(|slot| slot.count as usize).sum();
            piece.columns.reserve(live, true)?;
            for (i, slot) in slots.slots.iter().enumerate() {
                if i % (1 << 14) == 0 {
                    job.check()?;
                    let done = (parts as u64 * i as u64 / slots.slots.len() as u64) as usize;
                    job.advance(done - told);
                    told = done;
                }
                piece.columns.copy(&view, slot.range())?;
                piece.end_ray()?;
            }
            job.advance(parts - told);
            let mut pieces = memory::with_capacity(1)?;
            pieces.push(piece);
            *rows = Some(S::own(assembled(slots.window, format, pieces)?));
        }
    }
    Ok(rays)
}

/// Changes the rays along one axis. `parts` is their share of the progress.
fn changed<S: Form>(
    op: SetOp,
    slots: &mut Option<Slots<S>>,
    rows: &Rows<'_>,
    plain: bool,
    parts: usize,
    job: &Job<'_>,
) -> Result<Tally, Error> {
    match (slots, S::rows(rows)) {
        (Some(slots), Some(rows)) => slots.apply(op, &rows, plain, parts, job),
        _ => Ok(Tally::NONE),
    }
}

/// The number of rows of rays between reports of progress and checks for cancellation.
const STEP: u32 = 64;

impl<S: Span> Slots<S> {
    fn new(rows: &RowsRef<'_, S>, model: &TriDexelRef<'_>) -> Result<Slots<S>, Error> {
        const MOST: u64 = u32::MAX as u64;
        let window = Window::all(model.frame.depth());
        if window.count() > MOST {
            return Err(Error::Limit { what: "rays in one direction", limit: MOST });
        }
        let mut slots = memory::filled(window.count() as usize, Slot::default())?;
        let mut columns = Columns::new(&model.format);
        columns.reserve(rows.columns.spans.len(), true)?;
        for v in rows.window.range(1) {
            for u in rows.window.range(0) {
                let range = rows.ray([u, v]);
                if let Some(index) = window.index([u, v])
                    && !range.is_empty()
                {
                    let count = range.len() as u32;
                    slots[index] = Slot { first: columns.spans.len() as u32, count, room: count };
                    columns.copy(&rows.columns, range)?;
                }
            }
        }
        Ok(Slots { window, slots, columns, lost: 0, scratch: Columns::new(&model.format) })
    }

    fn apply(
        &mut self,
        op: SetOp,
        other: &RowsRef<'_, S>,
        plain: bool,
        parts: usize,
        job: &Job<'_>,
    ) -> Result<Tally, Error> {
        let (mut tally, depth) = (Tally::NONE, self.window.size[0].trailing_zeros() as u8);
        if op == SetOp::Intersection {
            // Everything outside the other model's window is removed.
            for v in self.window.range(1) {
                for u in self.window.range(0) {
                    if other.ray([u, v]).is_empty()
                        && let Some(index) = self.window.index([u, v])
                        && self.slots[index].count > 0
                    {
                        let own = &self.columns.spans[self.slots[index].range()];
                        if let Some(part) = part(op, own, &[], &[], depth) {
                            tally.add([u, v], &part);
                        }
                        self.slots[index].count = 0;
                    }
                }
            }
        }
        let (all, mut told) = (other.window.range(1), 0);
        for v in all.clone() {
            if (v - all.start) % STEP == 0 {
                job.check()?;
                let done = parts / all.len() * (v - all.start) as usize;
                job.advance(done - told);
                told = done;
            }
            let (Some(first), Some(from)) = (
                self.window.index([other.window.first[0], v]),
                other.window.index([other.window.first[0], v]),
            ) else {
                continue;
            };
            for k in 0..other.window.size[0] as usize {
                let range = other.at(from + k);
                let slot = self.slots[first + k];
                if range.is_empty() || slot.count == 0 && !op.keeps()[1] {
                    continue;
                }
                let ray = [other.window.first[0] + k as u32, v];
                if plain && op == SetOp::Difference && range.len() == 1 {
                    let ends = other.columns.spans[range.start].ends();
                    if let Some(done) = cut(&mut self.columns.spans, &mut self.slots[first + k], ends, depth)
                    {
                        if let Some(part) = done {
                            tally.add(ray, &part);
                        }
                        continue;
                    }
                }
                self.scratch.clear();
                let (own, others) = (&self.columns.spans[slot.range()], &other.columns.spans[range.clone()]);
                if plain {
                    merge_plain(op, own, others, &mut self.scratch.spans)?;
                } else {
                    let view = self.columns.view();
                    merge(op, (&view, slot.range()), (&other.columns, range), &mut self.scratch)?;
                }
                if let Some(part) = part(op, own, others, &self.scratch.spans, depth) {
                    tally.add(ray, &part);
                }
                self.put(first + k)?;
            }
        }
        job.advance(parts - told);
        if self.lost > self.columns.spans.len() / 2 + 1024 {
            self.pack()?;
        }
        Ok(tally)
    }

    /// Stores the intervals of the scratch memory as those of a ray.
    #[inline]
    fn put(&mut self, index: usize) -> Result<(), Error> {
        let count = self.scratch.spans.len();
        let slot = self.slots[index];
        if count <= slot.room as usize {
            self.columns.overwrite(slot.first as usize, &self.scratch);
            self.slots[index].count = count as u32;
            return Ok(());
        }
        let first = self.columns.spans.len();
        let room = count.next_power_of_two();
        if first + room > u32::MAX as usize {
            let what = "intervals in one direction";
            return Err(Error::Limit { what, limit: u64::from(u32::MAX) });
        }
        self.columns.lengthen(room)?;
        self.columns.overwrite(first, &self.scratch);
        self.slots[index] = Slot { first: first as u32, count: count as u32, room: room as u32 };
        self.lost += slot.room as usize;
        Ok(())
    }

    /// Moves all intervals together.
    fn pack(&mut self) -> Result<(), Error> {
        let mut packed = self.scratch.empty_copy();
        let live = self.slots.iter().map(|slot| slot.count as usize).sum();
        packed.reserve(live, true)?;
        let view = self.columns.view();
        for slot in &mut self.slots {
            let range = slot.range();
            *slot = Slot { first: packed.spans.len() as u32, count: slot.count, room: slot.count };
            packed.copy(&view, range)?;
        }
        (self.columns, self.lost) = (packed, 0);
        Ok(())
    }
}

/// Removes one interval from the intervals in a slot, and returns the change. `None`, without a change, if
/// there is no room for the remaining intervals.
#[inline]
fn cut<S: Span>(
    spans: &mut [S],
    slot: &mut Slot,
    [low, high]: [S::Place; 2],
    depth: u8,
) -> Option<Option<Part>> {
    let own = &mut spans[slot.first as usize..(slot.first + slot.room) as usize];
    let count = slot.count as usize;
    // The intervals that overlap the removed one: `first..end`.
    let mut first = 0;
    while first < count && own[first].ends()[1] <= low {
        first += 1;
    }
    let mut end = first;
    while end < count && own[end].ends()[0] < high {
        end += 1;
    }
    if first == end {
        return Some(None);
    }
    let (start, stop) = (own[first].ends()[0], own[end - 1].ends()[1]);
    let (before, behind) = (start < low, high < stop);
    let [mut removed, from, to] =
        [0.0, if before { low } else { start }.cells(depth), if behind { high } else { stop }.cells(depth)];
    for span in &own[first..end] {
        let [start, stop] = span.ends().each(|end| end.cells(depth));
        removed += stop.min(to) - start.max(from);
    }
    let part = Part { removed, added: 0.0, along: [from, to] };
    let mut left = first;
    if before && behind && end - first == 1 {
        if count == own.len() {
            return None;
        }
        own.copy_within(end..count, end + 1);
        own[first] = S::new([start, low]);
        own[first + 1] = S::new([high, stop]);
        slot.count += 1;
        return Some(Some(part));
    }
    if before {
        own[left] = S::new([start, low]);
        left += 1;
    }
    if behind {
        own[left] = S::new([high, stop]);
        left += 1;
    }
    if left < end {
        own.copy_within(end..count, left);
        slot.count -= (end - left) as u32;
    }
    Some(Some(part))
}
