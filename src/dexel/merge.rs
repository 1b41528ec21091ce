//! The set operations on one ray.

use super::columns::{Columns, ColumnsRef};
use super::item::{Item, Mark};
use super::place::{Place, Span};
use crate::error::Error;
use crate::memory;
use alloc::vec::Vec;
use core::ops::Range;

/// A set operation of two operands. The result lies in the union of the operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SetOp {
    Union,
    Intersection,
    Difference,
    Xor,
}

impl SetOp {
    #[inline(always)]
    pub fn holds(self, a: bool, b: bool) -> bool {
        match self {
            SetOp::Union => a | b,
            SetOp::Intersection => a & b,
            SetOp::Difference => a & !b,
            SetOp::Xor => a ^ b,
        }
    }

    /// Returns whether the result contains places of the first operand only, and places of the second operand
    /// only.
    pub fn keeps(self) -> [bool; 2] {
        [self.holds(true, false), self.holds(false, true)]
    }
}

/// Appends the result on one ray of two intervals without data, the most frequent case.
#[inline(always)]
pub(crate) fn merge_single<S: Span>(op: SetOp, a: S, b: S, out: &mut Vec<S>) -> Result<(), Error> {
    fn lower<P: Place>(x: P, y: P) -> P {
        if y < x { y } else { x }
    }
    fn upper<P: Place>(x: P, y: P) -> P {
        if x < y { y } else { x }
    }
    let ([a_start, a_end], [b_start, b_end]) = (a.ends(), b.ends());
    let (start, end) = (upper(a_start, b_start), lower(a_end, b_end));
    let mut add = |start: S::Place, end: S::Place| {
        if start < end { memory::push(out, S::new([start, end])) } else { Ok(()) }
    };
    match op {
        SetOp::Intersection => add(start, end),
        SetOp::Difference => {
            add(a_start, lower(a_end, b_start))?;
            add(upper(a_start, b_end), a_end)
        }
        SetOp::Union | SetOp::Xor => {
            let (least, most) = (lower(a_start, b_start), upper(a_end, b_end));
            if end < start || op == SetOp::Xor && end != start {
                add(least, lower(start, end))?;
                add(upper(start, end), most)
            } else {
                add(least, most)
            }
        }
    }
}

/// Appends the result on one ray of intervals without data. O(intervals).
#[inline(always)]
pub(crate) fn merge_plain<S: Span>(op: SetOp, a: &[S], b: &[S], out: &mut Vec<S>) -> Result<(), Error> {
    out.try_reserve(a.len() + b.len())?;
    let (mut i, mut j) = (0, 0);
    // An even index: the next end is a start.
    let (last_a, last_b) = (2 * a.len(), 2 * b.len());
    let end = |list: &[S], k: usize| list[k / 2].ends()[k % 2];
    let (mut inside, mut start) = (false, S::Place::LOW);
    while i < last_a || j < last_b {
        let at = if j == last_b {
            end(a, i)
        } else if i == last_a {
            end(b, j)
        } else {
            let (x, y) = (end(a, i), end(b, j));
            if y < x { y } else { x }
        };
        // Where intervals touch, both ends are passed.
        while i < last_a && end(a, i) <= at {
            i += 1;
        }
        while j < last_b && end(b, j) <= at {
            j += 1;
        }
        let now = op.holds(i % 2 == 1, j % 2 == 1);
        if now != inside {
            if now {
                start = at;
            } else {
                out.push(S::new([start, at]));
            }
            inside = now;
        }
    }
    Ok(())
}

/// The material of a ray at a place, if the place lies inside.
type Matter = Option<u32>;

/// Appends the result on one ray. Where both operands contain a place, material and mark are those of the
/// first one.
pub(crate) fn merge<S: Span>(
    op: SetOp,
    (a, range_a): (&ColumnsRef<'_, S>, Range<usize>),
    (b, range_b): (&ColumnsRef<'_, S>, Range<usize>),
    out: &mut Columns<S>,
) -> Result<(), Error> {
    let mut ways = [Way::new(a, range_a), Way::new(b, range_b)];
    let mut matter: Matter = None;
    let mut open = Item::plain([S::Place::LOW; 2]);
    while let Some(at) = least(ways[0].next(), ways[1].next()) {
        // The ends at this place: for each operand its last start or end here.
        let marks = [ways[0].pass(at), ways[1].pass(at)];
        let [first, second] = [ways[0].matter, ways[1].matter];
        let now = if op.holds(first.is_some(), second.is_some()) { first.or(second) } else { None };
        if now == matter {
            continue;
        }
        let mark = |side: usize| {
            let wanted = marks.iter().flatten().find(|passed| passed.has[side]);
            if let Some(passed) = wanted {
                return passed.marks[side];
            }
            // An end that becomes a start in the result, or a start that becomes an end, shows its other
            // side.
            let other = marks.iter().flatten().find(|passed| passed.has[1 - side]);
            other.map_or(Mark::NONE, |passed| passed.marks[1 - side].flipped())
        };
        if matter.is_some() {
            (open.ends[1], open.marks[1]) = (at, mark(1));
            out.push(&open)?;
        }
        if let Some(material) = now {
            open = Item { ends: [at; 2], marks: [mark(0), Mark::NONE], material };
        }
        matter = now;
    }
    Ok(())
}

fn least<P: Place>(a: Option<P>, b: Option<P>) -> Option<P> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b < a { b } else { a }),
        (a, b) => a.or(b),
    }
}

/// The ends of one operand at a place.
#[derive(Clone, Copy)]
struct Passed {
    has: [bool; 2],
    marks: [Mark; 2],
}

/// A cursor along a ray of one operand.
struct Way<'c, 'a, S: Span> {
    columns: &'c ColumnsRef<'a, S>,
    range: Range<usize>,
    /// The interval that comes next, or that contains the cursor.
    item: Option<Item<S::Place>>,
    matter: Matter,
}

impl<'c, 'a, S: Span> Way<'c, 'a, S> {
    fn new(columns: &'c ColumnsRef<'a, S>, mut range: Range<usize>) -> Self {
        let item = range.next().map(|i| columns.item(i));
        Way { columns, range, item, matter: None }
    }

    fn next(&self) -> Option<S::Place> {
        self.item.map(|item| item.ends[usize::from(self.matter.is_some())])
    }

    /// Passes all ends at a place: the end of one interval, and the start of the next one if they touch.
    fn pass(&mut self, at: S::Place) -> Option<Passed> {
        let mut passed = None;
        while let Some(item) = self.item {
            let side = usize::from(self.matter.is_some());
            if item.ends[side] > at {
                break;
            }
            let seen = passed.get_or_insert(Passed { has: [false; 2], marks: [Mark::NONE; 2] });
            (seen.has[side], seen.marks[side]) = (true, item.marks[side]);
            if side == 0 {
                self.matter = Some(item.material);
            } else {
                self.matter = None;
                self.item = self.range.next().map(|i| self.columns.item(i));
            }
        }
        passed
    }
}

/// Appends the complement of one ray of a universe: the range between the lower and the upper face of the
/// universe, without the intervals. Its material is 0.
pub(crate) fn complement<S: Span>(
    columns: &ColumnsRef<'_, S>,
    range: Range<usize>,
    depth: u8,
    out: &mut Columns<S>,
) -> Result<(), Error> {
    let mut open = Item::plain([S::Place::LOW; 2]);
    for i in range {
        let item = columns.item(i);
        if open.ends[0] < item.ends[0] {
            (open.ends[1], open.marks[1]) = (item.ends[0], item.marks[0].flipped());
            out.push(&open)?;
        }
        (open.ends[0], open.marks[0]) = (item.ends[1], item.marks[1].flipped());
    }
    let high = S::Place::high(depth);
    if open.ends[0] < high {
        (open.ends[1], open.marks[1]) = (high, Mark::NONE);
        out.push(&open)?;
    }
    Ok(())
}
