//! A bundle of rays through the centres of cells, which a solid fills with intervals.

use super::assemble::Piece;
use super::item::{Item, Mark, NO_SURFACE};
use super::normal::{NO_NORMAL, encoded};
use super::place::{Place, Span, gap, within};
use super::view::Window;
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use alloc::vec::Vec;
use core::ops::Range;

/// A point where a ray enters or leaves a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamEnd {
    /// The position in finest cells from the universe's lower face.
    pub(crate) at: f64,
    pub(crate) mark: Mark,
}

impl BeamEnd {
    /// Makes an end at about `at` cells from the universe's lower face. `above` (0 to the number of cells of
    /// an axis) is the first cell whose centre does not lie below the end. The end is moved into the gap that
    /// `above` determines.
    pub fn new(at: f64, above: u32, cells: u32) -> BeamEnd {
        let at = within(at, above.min(cells) as i32, f64::from(cells));
        BeamEnd { at: if at.is_nan() { 0.0 } else { at }, mark: Mark::NONE }
    }

    /// Makes an end in the plane between cells `above` − 1 and `above`.
    pub fn between(above: u32) -> BeamEnd {
        BeamEnd { at: f64::from(above), mark: Mark::NONE }
    }

    /// The same end in the complement.
    fn flipped(self) -> BeamEnd {
        BeamEnd { mark: self.mark.flipped(), ..self }
    }

    /// The same end on a surface of the solid with this outward normal, of any length; a normal without
    /// direction counts as none.
    #[must_use]
    pub fn on(self, surface: u32, normal: [f64; 3]) -> BeamEnd {
        BeamEnd { mark: Mark { surface, normal: encoded(normal) }, ..self }
    }
}

/// An interval of a ray.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Chord {
    /// The index of the ray in the window.
    pub ray: u32,
    /// The ends, in finest cells from the universe's lower face.
    pub ends: [f64; 2],
}

/// Parallel rays through the centres of finest cells, within one cell. A [`Worker`](crate::Worker) that knows
/// the intervals of the rays fills them in.
pub struct Beam {
    axis: usize,
    depth: u8,
    /// All rays that are requested, one cell after the other.
    window: Window,
    /// The rays of the current cell, and their range along the axis.
    rays: Window,
    span: Range<u32>,
    marked: bool,
    chords: Vec<Chord>,
    /// The marks of the ends, if they are requested.
    marks: Vec<[Mark; 2]>,
}

impl Beam {
    /// Makes empty rays along an axis of a universe of 2^depth cells. `marked` requests surfaces and normals.
    pub(crate) fn new(axis: usize, depth: u8, window: Window, marked: bool) -> Beam {
        Beam {
            axis,
            depth,
            window,
            rays: window,
            span: 0..1 << depth,
            marked,
            chords: Vec::new(),
            marks: Vec::new(),
        }
    }

    /// Starts again with other rays, in the same memory.
    pub(crate) fn restart(&mut self, window: Window) {
        self.chords.clear();
        self.marks.clear();
        (self.window, self.rays) = (window, window);
    }

    /// Requests the part of the rays in a cell.
    pub(crate) fn enter(&mut self, rays: Window, span: Range<u32>) {
        (self.rays, self.span) = (rays, span);
    }

    /// The axis along which the rays run.
    pub fn axis(&self) -> usize {
        self.axis
    }

    /// The depth of the universe.
    pub fn depth(&self) -> u8 {
        self.depth
    }

    /// The rays that are requested: indices of finest cells on the other two axes, the lower axis first.
    pub fn rays(&self) -> [Range<u32>; 2] {
        [self.rays.range(0), self.rays.range(1)]
    }

    /// The planes of the lattice between which intervals are requested.
    pub fn span(&self) -> Range<u32> {
        self.span.clone()
    }

    /// Returns whether surfaces and normals at ends are requested.
    pub fn is_marked(&self) -> bool {
        self.marked
    }

    /// Appends an interval. The intervals of a ray must come in ascending order. No interval may reach beyond
    /// the span; one that continues beyond it must end there, [between](BeamEnd::between) cells.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    #[inline]
    pub fn push(&mut self, ray: [u32; 2], start: BeamEnd, end: BeamEnd) -> Result<(), Error> {
        match self.window.index(ray) {
            Some(index) if start.at < end.at => {
                if self.marked {
                    memory::push(&mut self.marks, [start.mark, end.mark])?;
                }
                memory::push(&mut self.chords, Chord { ray: index as u32, ends: [start.at, end.at] })
            }
            _ => Ok(()),
        }
    }

    /// The number of intervals.
    pub(crate) fn len(&self) -> usize {
        self.chords.len()
    }

    /// One end of an interval.
    fn end(&self, i: usize, side: usize) -> BeamEnd {
        let mark = self.marks.get(i).map_or(Mark::NONE, |marks| marks[side]);
        BeamEnd { at: self.chords[i].ends[side], mark }
    }

    /// Replaces the intervals from index `first` on by their complement. These intervals are those of the
    /// current rays in the current cell.
    pub(crate) fn complement(&mut self, first: usize) -> Result<(), Error> {
        let count = self.chords.len() - first;
        let mut own = memory::with_capacity(count)?;
        own.extend(
            (first..self.chords.len()).map(|i| (self.chords[i].ray, [self.end(i, 0), self.end(i, 1)])),
        );
        self.chords.truncate(first);
        self.marks.truncate(first);
        own.sort_unstable_by(|(ray, ends), (other, others)| {
            ray.cmp(other).then(ends[0].at.total_cmp(&others[0].at))
        });
        let mut own = own.into_iter().peekable();
        let span = [self.span.start, self.span.end].each(BeamEnd::between);
        for v in self.rays.range(1) {
            for u in self.rays.range(0) {
                let Some(ray) = self.window.index([u, v]) else { continue };
                let mut start = span[0];
                while let Some((_, ends)) = own.next_if(|&(of, _)| of as usize == ray) {
                    self.push([u, v], start, ends[0].flipped())?;
                    start = ends[1].flipped();
                }
                self.push([u, v], start, span[1])?;
            }
        }
        Ok(())
    }

    pub(crate) fn chords(&self) -> &[Chord] {
        &self.chords
    }

    pub(crate) fn window(&self) -> Window {
        self.window
    }

    /// Sorts the intervals by rays, and joins those that touch.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(crate) fn join(&mut self, scratch: &mut Scratch) -> Result<(), Error> {
        if !self.chords.is_sorted_by_key(|chord| chord.ray) {
            let rays = self.window.count() as usize;
            scratch.order(&self.chords, rays)?;
            scratch.chords.move_in(&mut self.chords, &scratch.places)?;
            scratch.marks.move_in(&mut self.marks, &scratch.places)?;
        }
        let mut kept = 0usize;
        for i in 0..self.chords.len() {
            let next = self.chords[i];
            let last = kept.checked_sub(1).map(|last| (last, self.chords[last]));
            if let Some((place, last)) = last
                && last.ray == next.ray
                && next.ends[0] <= last.ends[1]
            {
                self.chords[place].ends[1] = next.ends[1];
                if self.marked {
                    self.marks[place][1] = self.marks[i][1];
                }
                continue;
            }
            self.chords[kept] = next;
            if self.marked {
                self.marks[kept] = self.marks[i];
            }
            kept += 1;
        }
        self.chords.truncate(kept);
        self.marks.truncate(kept);
        Ok(())
    }

    /// Moves an end of an interval.
    pub(crate) fn set_end(&mut self, i: usize, side: usize, end: BeamEnd) {
        self.chords[i].ends[side] = end.at;
        if let Some(marks) = self.marks.get_mut(i) {
            marks[side] = end.mark;
        }
    }

    /// Appends the joined rays to a piece of a model, without intervals that rounding empties.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(crate) fn append<S: Span>(&self, piece: &mut Piece<S>) -> Result<(), Error> {
        piece.columns.reserve(self.chords.len(), false)?;
        let mut chords = self.chords.iter().enumerate().peekable();
        for ray in 0..self.window.count() as u32 {
            while let Some((i, chord)) = chords.next_if(|(_, chord)| chord.ray == ray) {
                let ends = chord.ends.each(|end| S::Place::rounded(end, self.depth));
                let marks = if self.marked { [self.faced(i, 0), self.faced(i, 1)] } else { [Mark::NONE; 2] };
                // Rounded intervals may touch, or be empty.
                piece.add(&Item { ends, marks, material: 0 })?;
            }
            piece.end_ray()?;
        }
        Ok(())
    }

    /// The mark of an end. For an end in a plane between cells, the surface is this plane.
    fn faced(&self, i: usize, side: usize) -> Mark {
        let end = self.end(i, side);
        let Mark { surface, normal } = end.mark;
        let is_between = crate::lattice::exact::floor(end.at) as f64 == end.at;
        if surface != NO_SURFACE || normal != NO_NORMAL || !self.marked || !is_between {
            return end.mark;
        }
        let mut outward = [0.0; 3];
        outward[self.axis] = if side == 0 { -1.0 } else { 1.0 };
        Mark { surface, normal: encoded(outward) }
    }
}

/// Memory for sorting, kept from piece to piece.
#[derive(Default)]
pub(crate) struct Scratch {
    starts: Vec<u32>,
    /// The new index of each chord.
    places: Vec<u32>,
    chords: Spare<Chord>,
    marks: Spare<[Mark; 2]>,
}

impl Scratch {
    /// Computes the indices of chords that are sorted by rays. The chords of a ray keep their order.
    fn order(&mut self, chords: &[Chord], rays: usize) -> Result<(), Error> {
        self.starts.clear();
        self.starts.try_reserve(rays + 1)?;
        self.starts.resize(rays + 1, 0);
        self.places.clear();
        self.places.try_reserve(chords.len())?;
        for chord in chords {
            self.starts[chord.ray as usize + 1] += 1;
        }
        for i in 1..self.starts.len() {
            self.starts[i] += self.starts[i - 1];
        }
        for chord in chords {
            let place = &mut self.starts[chord.ray as usize];
            self.places.push(*place);
            *place += 1;
        }
        Ok(())
    }
}

/// A second list, for items that are reordered.
struct Spare<T>(Vec<T>);

impl<T> Default for Spare<T> {
    fn default() -> Spare<T> {
        Spare(Vec::new())
    }
}

impl<T: Copy> Spare<T> {
    /// Moves each item of a list to its new index, if there are items.
    fn move_in(&mut self, list: &mut Vec<T>, places: &[u32]) -> Result<(), Error> {
        self.0.clear();
        self.0.try_reserve(list.len())?;
        self.0.extend_from_slice(list);
        for (&item, &place) in list.iter().zip(places) {
            self.0[place as usize] = item;
        }
        core::mem::swap(list, &mut self.0);
        Ok(())
    }
}

/// The first cell whose centre does not lie below a position in cells.
pub(crate) fn first_above(at: f64) -> i64 {
    gap(at)
}
