//! The centres of cells that lie inside, 64 at a time.
//!
//! If their arrays come from elsewhere, rays of three directions may disagree about a centre. One direction
//! decides for all: the highest axis that has rays.

use super::item::Item;
use super::place::{Place, Span};
use super::view::{OTHERS, Rows, RowsRef, TriDexelRef, with_rows};
use crate::lattice::Each;
use core::ops::Range;

/// The edge of a block of cells.
pub(crate) const BLOCK: u32 = 64;

/// The position of rays relative to a box of finest cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Passage {
    /// No ray is inside anywhere in the box.
    Outside,
    /// Every ray is inside all the way through the box, in one material.
    Inside(u32),
    /// Every ray is inside all the way through the box, in several materials.
    Mixed,
    /// A ray begins or ends in the box, or one ray is inside and another one outside.
    Crossed,
}

impl Passage {
    fn and(self, other: Passage) -> Passage {
        match (self, other) {
            (a, b) if a == b => a,
            (Passage::Outside | Passage::Crossed, _) | (_, Passage::Outside | Passage::Crossed) => {
                Passage::Crossed
            }
            _ => Passage::Mixed,
        }
    }
}

impl TriDexelRef<'_> {
    /// The position of the rays along an axis relative to the cells in these ranges; `None` without rays. An
    /// end in a face of the box does not count as in the box. O(rays in the box · log intervals of a ray),
    /// less where the first rays differ.
    pub(crate) fn passage(&self, axis: usize, cells: &[Range<u32>; 3]) -> Option<Passage> {
        let rows = self.rays.get(axis)?.as_ref()?;
        let ([u, v], depth) = (OTHERS[axis], self.frame.depth());
        let mut found: Option<Passage> = None;
        for second in cells[v].clone() {
            for first in cells[u].clone() {
                let one = with_rows!(rows, rows => passage(rows, [first, second], &cells[axis], depth));
                let both = found.map_or(one, |found| found.and(one));
                if both == Passage::Crossed {
                    return Some(both);
                }
                found = Some(both);
            }
        }
        found
    }

    /// The position of the rays along all axes; `None` without any rays.
    pub(crate) fn passages(&self, cells: &[Range<u32>; 3]) -> Option<Passage> {
        let mut found: Option<Passage> = None;
        for axis in 0..3 {
            let Some(one) = self.passage(axis, cells) else { continue };
            let both = found.map_or(one, |found| found.and(one));
            if both == Passage::Crossed {
                return Some(both);
            }
            found = Some(both);
        }
        found
    }

    /// Returns whether the centre of a finest cell lies inside. Where the directions differ, as in arrays
    /// from elsewhere, the highest axis that has rays decides. A cell outside the universe does not lie
    /// inside. O(log intervals of a ray).
    pub fn contains_cell(&self, cell: [u32; 3]) -> bool {
        let Some((axis, rows)) = self.deciding() else { return false };
        let [u, v] = OTHERS[axis];
        with_rows!(rows, rows => find(rows, [cell[u], cell[v]], cell[axis], self.frame.depth())).is_some()
    }

    /// The material of a finest cell, by the rays that decide whether its centre lies inside; 0 if the centre
    /// lies outside, or no material is stored.
    pub(crate) fn material_of_cell(&self, cell: [u32; 3]) -> u32 {
        let Some((axis, rows)) = self.deciding() else { return 0 };
        let [u, v] = OTHERS[axis];
        with_rows!(rows, rows => {
            let interval = find(rows, [cell[u], cell[v]], cell[axis], self.frame.depth());
            interval.map_or(0, |i| { let Item { material, .. } = rows.columns.item(i); material })
        })
    }

    /// The number of intervals, in all directions, that contain no centre of a cell; intervals that touch
    /// count as one. Such parts are thinner than the lattice, and do not appear in any octree or surface of
    /// the model. O(rays of the windows + intervals).
    pub fn without_centres(&self) -> u64 {
        let depth = self.frame.depth();
        self.rays.iter().flatten().map(|rows| with_rows!(rows, rows => without_centres(rows, depth))).sum()
    }

    /// The rays that decide about centres, and their axis.
    pub(crate) fn deciding(&self) -> Option<(usize, &Rows<'_>)> {
        (0..3).rev().find_map(|axis| Some((axis, self.rays[axis].as_ref()?)))
    }

    /// Computes which of the 64³ centres from cell `first` on lie inside, as bit columns along an axis. Bit k
    /// of `words[p + 64 q]` is cell k along `along`, cell p along the lower and cell q along the higher one
    /// of the other two axes. Returns whether any centre may lie inside; if not, the words do not change.
    pub(crate) fn fill_centres(&self, first: [u32; 3], along: usize, words: &mut [u64; 4096]) -> bool {
        let Some((axis, rows)) = self.deciding() else { return false };
        with_rows!(rows, rows => fill(rows, axis, first, along, self.frame.depth(), words))
    }
}

/// The number of runs of touching intervals that contain no centre.
fn without_centres<S: Span>(rows: &RowsRef<'_, S>, depth: u8) -> u64 {
    let mut count = 0;
    for index in 0..rows.window.count() as usize {
        let mut list = rows.columns.spans[rows.at(index)].iter().map(|span| span.ends()).peekable();
        while let Some([start, mut end]) = list.next() {
            while let Some([_, next]) = list.next_if(|next| next[0] <= end) {
                end = next;
            }
            count += u64::from(start.gap(depth) == end.gap(depth));
        }
    }
    count
}

/// The position of a ray relative to the cells in a range.
fn passage<S: Span>(rows: &RowsRef<'_, S>, ray: [u32; 2], cells: &Range<u32>, depth: u8) -> Passage {
    let range = rows.ray(ray);
    let [low, high] = [cells.start, cells.end].each(|plane| S::Place::rounded(f64::from(plane), depth));
    let list = &rows.columns.spans[range.clone()];
    let first = list.partition_point(|span| span.ends()[1] <= low);
    let Some([start, mut end]) = list.get(first).map(|span| span.ends()) else { return Passage::Outside };
    if start >= high {
        return Passage::Outside;
    }
    if start > low {
        return Passage::Crossed;
    }
    let material =
        |i: usize| rows.columns.materials.and_then(|m| m.get(range.start + i)).copied().unwrap_or(0);
    let mut found = Passage::Inside(material(first));
    // Intervals of different materials may touch.
    let mut next = first + 1;
    while end < high {
        match list.get(next).map(|span| span.ends()) {
            Some([start, to]) if start <= end => {
                found = found.and(Passage::Inside(material(next)));
                (end, next) = (to, next + 1);
            }
            _ => return Passage::Crossed,
        }
    }
    found
}

/// The interval of the ray that contains the centre of cell k.
fn find<S: Span>(rows: &RowsRef<'_, S>, ray: [u32; 2], k: u32, depth: u8) -> Option<usize> {
    let range = rows.ray(ray);
    let list = &rows.columns.spans[range.clone()];
    let after = list.partition_point(|span| span.ends()[0].gap(depth) <= k);
    (after > 0 && list[after - 1].ends()[1].gap(depth) > k).then(|| range.start + after - 1)
}

fn fill<S: Span>(
    rows: &RowsRef<'_, S>,
    axis: usize,
    first: [u32; 3],
    along: usize,
    depth: u8,
    words: &mut [u64; 4096],
) -> bool {
    let others = OTHERS[axis];
    let apart = |i: usize| {
        let (window, low) = (rows.window.range(i), first[others[i]]);
        window.end <= low || window.start >= low.saturating_add(BLOCK)
    };
    if apart(0) || apart(1) {
        return false;
    }
    let row = |v: u32, into: &mut [u64; 64]| {
        for (u, word) in (0..BLOCK).zip(into) {
            let range = rows.ray([first[others[0]] + u, first[others[1]] + v]);
            *word = if range.is_empty() { 0 } else { column(&rows.columns.spans[range], first[axis], depth) };
        }
    };
    if axis == along {
        let (lines, _) = words.as_chunks_mut::<64>();
        for (v, line) in (0..BLOCK).zip(lines) {
            row(v, line);
        }
        return true;
    }
    // Here the words run along the rays. Planes that contain both axes are transposed.
    let mut block = [[0; 64]; 64];
    for (v, line) in (0..BLOCK).zip(&mut block) {
        row(v, line);
    }
    let third = 3 - axis - along;
    for t in 0..64 {
        // Bit r of matrix[k]: the cell at k along `along`, and at r along the rays.
        let mut matrix = [0u64; 64];
        for (k, word) in matrix.iter_mut().enumerate() {
            *word = if third == others[0] { block[k][t] } else { block[t][k] };
        }
        turn(&mut matrix);
        for (r, &word) in matrix.iter().enumerate() {
            // The other two axes of `along` are the axis of the rays and the third axis.
            let place = if axis < third { r + 64 * t } else { t + 64 * r };
            words[place] = word;
        }
    }
    true
}

/// The bits of the 64 centres from cell `first` on that the intervals of a ray contain.
#[inline(always)]
fn column<S: Span>(spans: &[S], first: u32, depth: u8) -> u64 {
    let last = first + BLOCK;
    // Most rays have few intervals.
    let skip =
        if spans.len() > 8 { spans.partition_point(|span| span.ends()[1].gap(depth) <= first) } else { 0 };
    let mut word = 0;
    for span in &spans[skip..] {
        let [start, end] = span.ends().each(|end| end.gap(depth));
        if start >= last {
            break;
        }
        let (start, end) = (start.max(first) - first, end.min(last).saturating_sub(first));
        if start < end {
            word |= (!0 >> (63 - (end - 1 - start))) << start;
        }
    }
    word
}

/// Transposes a bit matrix: bit j of word i becomes bit i of word j. (Warren, Hacker's Delight, 7-3.)
fn turn(matrix: &mut [u64; 64]) {
    let (mut width, mut mask) = (32, 0x0000_0000_FFFF_FFFF_u64);
    while width != 0 {
        let mut k = 0;
        while k < 64 {
            let swapped = (matrix[k] >> width ^ matrix[k + width]) & mask;
            matrix[k] ^= swapped << width;
            matrix[k + width] ^= swapped;
            k = (k + width + 1) & !width;
        }
        width /= 2;
        mask ^= mask << width;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dexel::FixedSpan;
    use alloc::vec::Vec;

    #[test]
    fn turning_swaps_rows_and_columns() {
        let mut state = 3u64;
        let matrix: [u64; 64] = core::array::from_fn(|_| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            state ^ state >> 31
        });
        let mut turned = matrix;
        turn(&mut turned);
        for i in 0..64 {
            for j in 0..64 {
                assert_eq!(turned[j] >> i & 1, matrix[i] >> j & 1);
            }
        }
    }

    #[test]
    fn columns_hold_what_intervals_hold() {
        let depth = 8;
        let mut state = 11u64;
        let mut random = |below: u32| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            ((state >> 33) % u64::from(below)) as u32
        };
        for count in [1, 2, 5, 20] {
            let mut ends: Vec<u32> = (0..2 * count).map(|_| random((1 << 31) + 1)).collect();
            ends.sort_unstable();
            let spans: Vec<FixedSpan> = ends.chunks(2).map(|e| FixedSpan::new([e[0], e[1]])).collect();
            for first in [0, 64, 192] {
                let word = column(&spans, first, depth);
                for k in 0..64 {
                    let centre = (2 * (first + k) + 1) << (30 - depth);
                    let holds = ends.chunks(2).any(|e| e[0] <= centre && centre < e[1]);
                    assert_eq!(word >> k & 1 == 1, holds);
                }
            }
        }
    }
}
