//! Cells of an open surface.
//!
//! Lines count the winding number of the surface *and its caps*. This file subtracts the caps' own winding
//! number. Around the middle of a cell, the caps' number is known to second order, with error bounds, and it
//! jumps by an integer on every cap. Three cases follow for a cell:
//!
//! * If no cap cuts the cell, and the caps' winding number stays within one half of an integer, the surface's
//!   own number is an integer up to less than one half. The cell and all cells below it are then treated as
//!   cells of a closed surface.
//! * If the surface does not cut the cell, its winding number is continuous in the cell, caps or not. If the
//!   number is bounded away from the fill rule's threshold, the cell is FULL or EMPTY.
//! * Otherwise the cell's children decide. A finest cell near a hole may stay PARTIAL although nothing cuts
//!   it.
//!
//! Centres and rays are not computed cell by cell, but by pieces as large as an expansion is precise for
//! (`open_rays`).

use super::on_frame::{Branch, MeshOnFrame, MeshPart};
use super::slab;
use super::winding::{Local, Range};
use crate::lattice::Each;
use crate::lattice::MAX_DEPTH;
use crate::lattice::exact::floor;
use crate::memory;
use crate::mesh::FillRule;
use crate::solid::{Enclosure, Slab, Verdict};
use alloc::vec::Vec;

/// Half the diagonal of a cube of edge 1, rounded up.
const HALF_DIAGONAL: f64 = 0.866_025_404;

/// The greatest error of each of two winding numbers that differ by an integer, so that rounding their
/// difference gives the integer: the two errors sum to less than one half.
const SURE: f64 = 0.2;

/// The error that a group of caps may add in a cell.
const ENOUGH: f64 = 1.0 / 4096.0;

/// The error that a group of caps may add where a centre's side depends on it.
const LEAST: f64 = 1.0 / 1073741824.0;

/// The most squares of the universe's faces that are divided to prove that the outside is empty.
const MOST_SQUARES: usize = 2048;

/// The approximate number of caps that this proof may evaluate in all.
const MOST_CAPS: usize = 1 << 22;

/// The caps' winding number around the latest cells of each level: a function of the cell alone, kept for the
/// cells below it.
#[derive(Default)]
pub(super) struct Surroundings {
    /// Empty before a level's first cell. Then one place for each grandchild of a cell, because builders
    /// divide a cell twice before they go below the first of its grandchildren.
    levels: [Vec<Slot>; MAX_DEPTH as usize + 1],
}

/// A cell's lower corner, and its expansion; `None` if the boundary passes close by.
type Slot = Option<([i32; 3], Option<Local>)>;

/// The number of cells of a level that are kept along each axis: a power of two.
const KEPT: i32 = 4;

impl Surroundings {
    /// Returns the caps' winding number around the middle of the cell of `level` that contains `at`. For a
    /// finest cell, the number holds on the side of every cap on which the cell's centre counts.
    fn local(&mut self, mesh: &MeshOnFrame, level: u8, at: [i32; 3]) -> Option<Local> {
        let size = 1 << (mesh.placed.frame.depth() - level);
        let corner = at.each(|a| a & -size);
        let place = |axis: usize| ((corner[axis] / size) & (KEPT - 1)) as usize;
        let place = (place(2) * KEPT as usize + place(1)) * KEPT as usize + place(0);
        let slots = &mut self.levels[level as usize];
        if let Some(Some((kept, local))) = slots.get(place)
            && *kept == corner
        {
            return *local;
        }
        let radius = size as f64 * HALF_DIAGONAL;
        let cell = (size == 1).then_some(corner);
        let local = mesh.caps.local(&mesh.placed, middle(corner, size), radius, ENOUGH, cell);
        if slots.is_empty()
            && let Ok(none) = memory::filled((KEPT * KEPT * KEPT) as usize, None)
        {
            *slots = none;
        }
        // (Without memory, the number is computed anew each time.)
        if let Some(slot) = slots.get_mut(place) {
            *slot = Some((corner, local));
        }
        local
    }
}

/// The caps' winding number at the centre of a finest cell.
pub(super) fn at_centre(mesh: &MeshOnFrame, at: [i32; 3], enough: f64) -> Range {
    let local = mesh.caps.local(&mesh.placed, middle(at, 1), 0.0, enough, Some(at));
    local.map_or(Range::UNKNOWN, |local| local.within(0.0))
}

fn middle(corner: [i32; 3], size: i32) -> [f64; 3] {
    corner.each(|a| a as f64 + size as f64 / 2.0)
}

impl MeshOnFrame {
    /// The verdict of a cell in which the caps' winding number is not known to be near one integer.
    #[cold]
    pub(super) fn open_verdict(
        &self,
        surroundings: &mut Surroundings,
        triangles: &[u32],
        at: [i32; 3],
        size: i32,
        mut part: MeshPart,
    ) -> Verdict<MeshPart> {
        let (is_cut, is_capped) = (self.is_cut(triangles), self.is_capped(triangles));
        if is_cut && (size == 1 || is_capped) {
            return Verdict::Partial(part);
        }
        let mut is_fresh = false;
        loop {
            let caps = self.caps_over(surroundings, at, size, part);
            if !is_capped && let Some(nearest) = caps.nearest() {
                part.winding -= nearest;
                part.caps = None;
                return self.closed_verdict(part);
            }
            if !is_cut {
                let excess = self.excess(part.winding as f64 - caps.value);
                if excess.abs() > caps.change + caps.error {
                    return if excess > 0.0 { Verdict::Full } else { Verdict::Empty };
                }
            }
            // If the inherited error is at most half the change, a better sum would not help much. (False for
            // NaN.)
            let is_sharp = caps.error <= 0.5 * caps.change;
            if is_sharp || is_fresh {
                // If only the error keeps the verdict open, a better sum may decide.
                let excess = self.excess(part.winding as f64 - caps.value).abs();
                let is_close = size == 1 && !is_cut && caps.error < 2.0 && excess > caps.change;
                return if is_close { self.close_verdict(at, part) } else { Verdict::Partial(part) };
            }
            part.caps = Some(self.branch(surroundings, at, size, is_capped, part));
            is_fresh = true;
        }
    }

    /// The verdict of a finest cell that nothing cuts, from a better sum.
    fn close_verdict(&self, at: [i32; 3], part: MeshPart) -> Verdict<MeshPart> {
        let local = self.caps.local(&self.placed, middle(at, 1), HALF_DIAGONAL, ENOUGH / 16.0, Some(at));
        let caps = local.map_or(Range::UNKNOWN, |local| local.over(at, 1));
        let excess = self.excess(part.winding as f64 - caps.value);
        match excess.abs() > caps.change + caps.error {
            true if excess > 0.0 => Verdict::Full,
            true => Verdict::Empty,
            false => Verdict::Partial(part),
        }
    }

    /// Returns whether the centre of a finest cell is inside.
    #[cold]
    pub(super) fn open_sample(&self, surroundings: &mut Surroundings, at: [i32; 3], part: MeshPart) -> bool {
        let excess = |caps: Range| self.excess(part.winding as f64 - caps.value);
        let mut caps = self.caps_at(surroundings, at, part);
        for enough in [ENOUGH, LEAST] {
            if excess(caps).abs() > caps.error {
                break;
            }
            caps = at_centre(self, at, enough);
        }
        excess(caps) >= 0.0
    }

    /// Returns the integer nearest to the surface's own winding number throughout a cell, apart from the
    /// changes at triangles of the surface; that is the integer at the lowest centre. `None` if the number
    /// may differ from the integer by one half.
    pub(super) fn nearest_winding(
        &self,
        surroundings: &mut Surroundings,
        triangles: &[u32],
        at: [i32; 3],
        size: i32,
        mut part: MeshPart,
    ) -> Option<i32> {
        if part.caps?.level != self.level(size) {
            part.caps = Some(self.branch(surroundings, at, size, self.is_capped(triangles), part));
        }
        let nearest = self.caps_over(surroundings, at, size, part).nearest()?;
        Some(part.winding - nearest)
    }

    /// Returns a slab that contains the boundary in a cell that the surface does not cut: the points whose
    /// winding number is one half.
    pub(super) fn open_slab(
        &self,
        surroundings: &mut Surroundings,
        triangles: &[u32],
        at: [i32; 3],
        size: i32,
        mut part: MeshPart,
    ) -> Option<Enclosure> {
        if self.is_cut(triangles) {
            return None;
        }
        if part.caps.is_some_and(|branch| branch.level != self.level(size)) {
            part.caps = Some(self.branch(surroundings, at, size, !triangles.is_empty(), part));
        }
        let Branch { level: level @ 0..=MAX_DEPTH, step } = part.caps? else { return None };
        let (value, slope, rest) = surroundings.local(self, level, at)?.tangent(at, size);
        // The number is `middle` − slope · x, with an error of `rest`. This is more than all roundings.
        let middle = part.winding as f64 - (value + step as f64);
        let rest = rest * (1.0 + 1e-9) + 1e-12 * (1.0 + middle.abs());
        let range = slope.iter().map(|s| s.abs()).sum::<f64>() + rest;
        let is_at_plus_half = self.fill == FillRule::Positive || middle - range > -0.5;
        let (normal, end) = if is_at_plus_half {
            (slope, middle - 0.5)
        } else if middle + range < 0.5 {
            (slope.each(|s| -s), -middle - 0.5)
        } else {
            return None;
        };
        // (NaN decides nothing.)
        let is_known = range.is_finite() && normal != [0.0; 3];
        is_known.then(|| slab::enclosure(Slab { normal, inner: end - rest, outer: end + rest }))
    }

    /// Returns whether triangles of the surface are among those that meet a cell: they come first in the
    /// list.
    fn is_cut(&self, triangles: &[u32]) -> bool {
        triangles.first().is_some_and(|&first| !self.placed.is_cap(first))
    }

    /// Returns whether caps are among the triangles that meet a cell: caps come last in the list.
    fn is_capped(&self, triangles: &[u32]) -> bool {
        triangles.last().is_some_and(|&last| self.placed.is_cap(last))
    }

    /// The level of the cells with an edge of `size` finest cells.
    fn level(&self, size: i32) -> u8 {
        self.placed.frame.depth() - size.trailing_zeros() as u8
    }

    /// Returns by how much a winding number exceeds the fill rule's threshold.
    pub(super) fn excess(&self, winding: f64) -> f64 {
        self.fill.excess(winding)
    }

    /// Returns the caps' winding number over a cell, continued from its lowest centre through caps.
    fn caps_over(&self, surroundings: &mut Surroundings, at: [i32; 3], size: i32, part: MeshPart) -> Range {
        self.known(surroundings, at, part, |local| local.over(at, size))
    }

    /// Returns the caps' winding number at a cell's lowest centre.
    fn caps_at(&self, surroundings: &mut Surroundings, at: [i32; 3], part: MeshPart) -> Range {
        self.known(surroundings, at, part, |local| local.at_centre(at))
    }

    fn known(
        &self,
        surroundings: &mut Surroundings,
        at: [i32; 3],
        part: MeshPart,
        range: impl Fn(&Local) -> Range,
    ) -> Range {
        let Some(Branch { level: level @ 0..=MAX_DEPTH, step }) = part.caps else {
            return Range::UNKNOWN;
        };
        let local = surroundings.local(self, level, at);
        local.map_or(Range::UNKNOWN, |local| range(&local).plus(step))
    }

    /// The branch of the caps' winding number relative to the expansion around this cell itself.
    fn branch(
        &self,
        surroundings: &mut Surroundings,
        at: [i32; 3],
        size: i32,
        is_capped: bool,
        part: MeshPart,
    ) -> Branch {
        let level = self.level(size);
        let Some(here) = surroundings.local(self, level, at) else { return Branch::UNKNOWN };
        if size == 1 {
            return Branch { level, step: 0 };
        }
        if !is_capped {
            // No cap lies between the middle, which is on no cap, and the lowest centre.
            return Branch { level, step: 0 };
        }
        let here = here.at_centre(at);
        let mut there = self.caps_at(surroundings, at, part);
        let is_known = there.error < SURE;
        if !is_known {
            there = at_centre(self, at, ENOUGH);
        }
        if here.error < SURE && there.error < SURE {
            Branch { level, step: floor(there.value - here.value + 0.5) as i32 }
        } else {
            Branch::UNKNOWN
        }
    }

    /// Returns whether the winding number is proven less than one half in magnitude everywhere outside the
    /// universe, which contains the whole surface. A harmonic function that vanishes at infinity takes its
    /// extremes on the universe's faces.
    pub(super) fn is_empty_outside(&self) -> bool {
        if self.caps.is_empty() {
            return true;
        }
        let cells = self.placed.frame.cells() as f64;
        // A square on each face: the face, its lowest corner, its edge.
        let mut squares: Vec<(usize, [f64; 2], f64)> = Vec::new();
        if squares.try_reserve(6 + 3 * MOST_SQUARES).is_err() {
            return false;
        }
        squares.extend((0..6).map(|face| (face, [0.0; 2], cells)));
        // The time for each square grows with the number of caps.
        let most = (MOST_CAPS / self.placed.caps.len()).clamp(1, MOST_SQUARES);
        let mut divided = 0;
        while let Some((face, corner, size)) = squares.pop() {
            let (w, height) = (face / 2, if face % 2 == 0 { 0.0 } else { cells });
            let half = size / 2.0;
            let mut point = [height; 3];
            (point[(w + 1) % 3], point[(w + 2) % 3]) = (corner[0] + half, corner[1] + half);
            let radius = half * core::f64::consts::SQRT_2;
            let seen = self.caps.local(&self.placed, point, radius, ENOUGH, None);
            let seen = seen.map_or(Range::UNKNOWN, |local| local.within(radius));
            if seen.value.abs() + seen.change + seen.error < 0.5 {
                continue;
            }
            divided += 1;
            // The proof also fails if the middle shows the contrary.
            if divided > most || seen.error < 0.5 && seen.value.abs() >= 0.5 {
                return false;
            }
            squares.extend((0..4).map(|k| {
                let step = |bit: usize| if k >> bit & 1 != 0 { half } else { 0.0 };
                (face, [corner[0] + step(0), corner[1] + step(1)], half)
            }));
        }
        true
    }
}
