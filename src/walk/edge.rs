//! Finds the crossing of an edge between two samples with the surface of a solid.
//!
//! The edge runs along edges of cells, and each of these cells narrows down the crossing. A FULL or EMPTY
//! cell decides the side of its whole edge. The slabs of a PARTIAL cell leave only the range between their
//! two planes. The next cell to query is as small as the remaining range. Slabs are thinner than their cells
//! by a factor of the cell's size, so that each step doubles the number of digits; a plane surface is found
//! at once.

use super::trail::Trail;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::axes;
use crate::lattice::{Cell, Frame, MAX_DEPTH};
use crate::octree::Tag;
use crate::solid::{Enclosure, Segment, SlabJoin, Worker};

/// An edge from one lattice corner of a frame to another one along an axis.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Edge {
    pub axis: usize,
    /// The lower end.
    pub lower: [i32; 3],
    /// The length in cells of the frame.
    pub steps: u32,
    /// Whether the lower end lies inside; the upper end lies on the other side.
    pub starts_inside: bool,
}

/// The width below which a bracket is not narrowed further.
const FINE: f64 = 1.0 / (1u64 << 44) as f64;

/// The place along a bracket of the next cell to query.
#[derive(Clone, Copy)]
enum Place {
    Middle,
    Low,
    High,
}

impl Place {
    /// The greatest number of cells of a level to query there, one after the other. The middle ones end by
    /// themselves.
    fn most(self) -> usize {
        match self {
            Place::Middle => MAX_DEPTH as usize + 2,
            Place::Low | Place::High => 4,
        }
    }
}

impl Edge {
    /// Returns the crossing with the surface of the solid that `trail` queries on the finest lattice of the
    /// universe: 0 at the lower end, 1 at the upper one. Proofs narrow down the crossing; the result is the
    /// middle of the remaining range.
    ///
    /// # Errors
    /// Those of the solid.
    pub fn crossing<W: Worker>(
        &self,
        frame: &Frame,
        trail: &mut Trail<W>,
        control: &Control<'_>,
    ) -> Result<f64, Error> {
        let cells = frame.cells() as i32;
        // The universe ends at an end of the edge.
        if self.lower[self.axis] < 0 {
            return Ok(1.0);
        }
        if self.lower[self.axis] >= cells {
            return Ok(0.0);
        }
        let mut bracket = Bracket { low: 0.0, high: 1.0, starts_inside: self.starts_inside };
        let mut level = frame.depth();
        loop {
            if let Some(crossing) = self.narrow(frame, level, &mut bracket, trail, control)? {
                return Ok(crossing);
            }
            let width = bracket.high - bracket.low;
            if level >= MAX_DEPTH || width <= FINE {
                return Ok(bracket.middle());
            }
            // The size of the next cells is at least the width.
            let levels = MAX_DEPTH - frame.depth();
            let cells = width * f64::from(self.steps);
            let finer = (1..=levels).take_while(|&k| cells * f64::from(1u32 << k) <= 1.0).last().unwrap_or(0);
            level = (frame.depth() + finer).max(level + 1).min(MAX_DEPTH);
        }
    }

    /// Returns whether the edge's lower or upper end lies inside. The finest cell of the universe there
    /// decides, or, if that cell is undecided, its centre. `None` if the solid cannot decide.
    ///
    /// # Errors
    /// Those of the solid.
    pub fn face<W: Worker>(
        &self,
        frame: &Frame,
        upper: bool,
        trail: &mut Trail<W>,
        control: &Control<'_>,
    ) -> Result<Option<bool>, Error> {
        let pieces = self.steps << (MAX_DEPTH - frame.depth());
        let (cell, _) = self.cell(frame, MAX_DEPTH, if upper { pieces - 1 } else { 0 });
        trail.follow(cell.parent(), control)?;
        match trail.verdict(cell).tag() {
            Tag::Empty => Ok(Some(false)),
            Tag::Full => Ok(Some(true)),
            Tag::Partial | Tag::Branch => trail.sample(cell),
        }
    }

    /// Narrows the bracket down by cells of a level: by bisection, as long as cells in the middle are
    /// decided, then from both ends. If the solid knows the crossing, that is the answer.
    fn narrow<W: Worker>(
        &self,
        frame: &Frame,
        level: u8,
        bracket: &mut Bracket,
        trail: &mut Trail<W>,
        control: &Control<'_>,
    ) -> Result<Option<f64>, Error> {
        let pieces = self.steps << (level - frame.depth());
        let mut last = None;
        for place in [Place::Middle, Place::Low, Place::High] {
            for _ in 0..place.most() {
                let number = match place {
                    Place::Middle => (bracket.middle() * f64::from(pieces)) as u32,
                    Place::Low => (bracket.low * f64::from(pieces)) as u32,
                    Place::High => (libm::ceil(bracket.high * f64::from(pieces)) as u32).saturating_sub(1),
                };
                let number = number.min(pieces - 1);
                if bracket.high - bracket.low <= FINE || last == Some(number) {
                    break;
                }
                last = Some(number);
                let (cell, piece) = self.cell(frame, level, number);
                trail.follow(cell.parent(), control)?;
                match trail.verdict(cell).tag() {
                    Tag::Empty => bracket.cut(&[piece.range()], false),
                    Tag::Full => bracket.cut(&[piece.range()], true),
                    Tag::Partial | Tag::Branch => {
                        if level == frame.depth()
                            && let Some(crossing) = trail.crossing(cell, &self.segment(frame, number))?
                        {
                            let t = (f64::from(number) + crossing.t.clamp(0.0, 1.0)) / f64::from(self.steps);
                            return Ok(Some(t));
                        }
                        if let Some(enclosure) = trail.enclosure(cell)? {
                            let (inside, outside) = piece.sides(&enclosure);
                            bracket.cut(&inside, true);
                            bracket.cut(&outside, false);
                        }
                    }
                }
            }
        }
        Ok(None)
    }

    /// Piece `number` of the edge, as long as a cell of the frame, in model units.
    fn segment(&self, frame: &Frame, number: u32) -> Segment {
        let corner = |axis: usize, i: i32| {
            let plane = frame.plane(axis, i as u32);
            0.5 * plane.lower + 0.5 * plane.upper
        };
        let mut from = axes(|axis| corner(axis, self.lower[axis]));
        let mut to = from;
        from[self.axis] = corner(self.axis, self.lower[self.axis] + number as i32);
        to[self.axis] = corner(self.axis, self.lower[self.axis] + number as i32 + 1);
        Segment { from, to }
    }

    /// The cell of a level, at least the frame's depth, that has piece `number` of the edge as one of its
    /// edges.
    fn cell(&self, frame: &Frame, level: u8, number: u32) -> (Cell, Piece) {
        let finer = level - frame.depth();
        let (mut at, mut others) = ([0; 3], [0.0; 3]);
        for axis in 0..3 {
            // Beyond the last cell there is none.
            let is_last = self.lower[axis] >= frame.cells() as i32;
            at[axis] = ((self.lower[axis] as u32) << finer) - u32::from(is_last);
            others[axis] = if is_last { 1.0 } else { -1.0 };
        }
        at[self.axis] = ((self.lower[self.axis] as u32) << finer) + number;
        let size = 1.0 / f64::from(self.steps << finer);
        let piece = Piece { axis: self.axis, others, start: f64::from(number) * size, size };
        (Cell { level, at }, piece)
    }
}

/// The part of an edge that is an edge of a cell.
struct Piece {
    axis: usize,
    /// The position of the edge on the other axes, from the cell's centre in half edges.
    others: [f64; 3],
    start: f64,
    size: f64,
}

/// A range from one number to a greater one; empty if the second number is less.
type Range = [f64; 2];

const NOTHING: Range = [f64::INFINITY, f64::NEG_INFINITY];

impl Piece {
    fn range(&self) -> Range {
        [self.start, self.start + self.size]
    }

    /// The parts of the piece that are certainly inside, and those that are certainly outside.
    fn sides(&self, enclosure: &Enclosure) -> ([Range; 3], [Range; 3]) {
        let all = self.range();
        let (mut inside, mut outside) = ([NOTHING; 3], [NOTHING; 3]);
        let mut count = 0;
        for slab in enclosure.slabs.iter().filter(|slab| slab.normal != [0.0; 3]) {
            let mut height = 0.0;
            for axis in (0..3).filter(|&axis| axis != self.axis) {
                height += slab.normal[axis] * self.others[axis];
            }
            let slope = slab.normal[self.axis];
            // The part where slope · u + height is less than a bound, or greater.
            let side = |bound: f64, is_less: bool| {
                if slope == 0.0 {
                    return if (height < bound) == is_less && height != bound { all } else { NOTHING };
                }
                let u = (bound - height) / slope;
                let t = self.start + self.size * (0.5 * u + 0.5);
                match (is_less == (slope > 0.0), u.is_nan()) {
                    (_, true) => NOTHING,
                    (true, _) => [all[0], t.min(all[1])],
                    (false, _) => [t.max(all[0]), all[1]],
                }
            };
            (inside[count], outside[count]) = (side(slab.inner, true), side(slab.outer, false));
            count += 1;
        }
        let common = |ranges: &mut [Range; 3]| {
            let first = ranges[0];
            let all = ranges[1..count.max(1)].iter().fold(first, |a, b| [a[0].max(b[0]), a[1].min(b[1])]);
            *ranges = [all, NOTHING, NOTHING];
        };
        match enclosure.join {
            SlabJoin::All => common(&mut inside),
            SlabJoin::Any => common(&mut outside),
        }
        (inside, outside)
    }
}

/// The range of the crossing: from a point on the side of the lower end to a point on the other side.
struct Bracket {
    low: f64,
    high: f64,
    starts_inside: bool,
}

impl Bracket {
    fn middle(&self) -> f64 {
        0.5 * (self.low + self.high)
    }

    /// Narrows the bracket by ranges whose points lie inside, or outside.
    fn cut(&mut self, ranges: &[Range], inside: bool) {
        for &[first, last] in ranges {
            let (first, last) = (first.max(self.low), last.min(self.high));
            if first > last {
                continue;
            }
            if inside == self.starts_inside {
                self.low = last;
            } else {
                self.high = first;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::Slab;

    #[test]
    fn slabs_leave_what_lies_between() {
        let piece = Piece { axis: 0, others: [0.0, -1.0, -1.0], start: 0.5, size: 0.25 };
        let slab = |normal: [f64; 3], inner: f64, outer: f64| Slab { normal, inner, outer };
        let none = slab([0.0; 3], 0.0, 0.0);
        let along = slab([2.0, 1.0, 0.0], -1.0, 0.0);
        let enclosure = Enclosure { slabs: [along, none, none], join: SlabJoin::All, cone: 1.0 };
        // 2 u − 1 < −1 and > 0.
        let (inside, outside) = piece.sides(&enclosure);
        assert_eq!((inside[0], outside[0]), ([0.5, 0.625], [0.6875, 0.75]));
        let mut bracket = Bracket { low: 0.0, high: 1.0, starts_inside: true };
        bracket.cut(&inside, true);
        bracket.cut(&outside, false);
        assert_eq!((bracket.low, bracket.high), (0.625, 0.6875));
        let (inside, outside) = piece.sides(&enclosure.complement());
        assert_eq!((inside[0], outside[0]), ([0.6875, 0.75], [0.5, 0.625]));
        // Across the edge: all of it inside, or nothing known.
        let across = slab([0.0, 1.0, 0.0], -0.5, 0.5);
        let enclosure = Enclosure { slabs: [along, across, none], join: SlabJoin::All, cone: 1.0 };
        let (inside, outside) = piece.sides(&enclosure);
        assert_eq!((inside[0], outside[1]), ([0.5, 0.625], NOTHING));
        let across = slab([0.0, 1.0, 0.0], -1.5, 0.5);
        let enclosure = Enclosure { slabs: [along, across, none], join: SlabJoin::Any, cone: 1.0 };
        let (inside, outside) = piece.sides(&enclosure);
        assert_eq!((inside[0], inside[1]), ([0.5, 0.625], NOTHING));
        assert!(outside[0][0] > outside[0][1]);
    }
}
