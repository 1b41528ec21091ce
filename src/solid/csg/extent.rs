//! Boxes that contain a solid and its complement.

use super::program::MOST;
use super::{Join, Kind, Node};
use crate::lattice::exact::{sign_of_sum, two_product, two_sum};
use crate::lattice::{Affine, Frame};
use crate::octree::Tag;
use crate::solid::Solid;
use alloc::vec::Vec;

/// What a solid surely does not reach beyond, in model units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Extent {
    /// It is empty.
    Nothing,
    /// The box between two corners.
    Box([f64; 3], [f64; 3]),
    /// Nobody knows.
    Unbounded,
}

impl Extent {
    /// Whether the solid surely lies in the universe.
    fn within(self, frame: &Frame) -> bool {
        match self {
            Extent::Nothing => true,
            Extent::Unbounded => false,
            Extent::Box(min, max) => (0..3).all(|axis| {
                let origin = frame.origin()[axis];
                min[axis] >= origin && sign_of_sum(&[origin, frame.edge(), -max[axis]]) >= 0
            }),
        }
    }

    /// Of the union of two solids.
    pub(super) fn hull(self, other: Extent) -> Extent {
        match (self, other) {
            (Extent::Nothing, extent) | (extent, Extent::Nothing) => extent,
            (Extent::Box(a, b), Extent::Box(c, d)) => Extent::Box(
                [0, 1, 2].map(|axis| a[axis].min(c[axis])),
                [0, 1, 2].map(|axis| b[axis].max(d[axis])),
            ),
            _ => Extent::Unbounded,
        }
    }

    /// Of the intersection of two solids.
    pub(super) fn common(self, other: Extent) -> Extent {
        match (self, other) {
            (Extent::Unbounded, extent) | (extent, Extent::Unbounded) => extent,
            (Extent::Box(a, b), Extent::Box(c, d)) => {
                let low = [0, 1, 2].map(|axis| a[axis].max(c[axis]));
                let high = [0, 1, 2].map(|axis| b[axis].min(d[axis]));
                if (0..3).any(|axis| low[axis] > high[axis]) {
                    Extent::Nothing
                } else {
                    Extent::Box(low, high)
                }
            }
            _ => Extent::Nothing,
        }
    }

    /// Of the solid under a placement, rounded outward.
    pub(super) fn placed(self, placement: &Affine) -> Extent {
        let Extent::Box(low, high) = self else { return self };
        let (mut min, mut max) = ([0.0; 3], [0.0; 3]);
        for (i, row) in placement.rows().iter().enumerate() {
            let (mut least, mut most, mut size) = (row[3], row[3], row[3].abs());
            // Where nothing is rounded; in numbers this small errors get lost.
            let is_tellable = |c: f64| c == 0.0 || c.abs() > 1e-100;
            let mut is_exact = low.iter().chain(&high).all(|&end| is_tellable(end));
            for axis in 0..3 {
                let [a, b] = [low[axis], high[axis]].map(|end| two_product(row[axis], end));
                let (a, b) = if a.0 <= b.0 { (a, b) } else { (b, a) };
                let (lower, upper) = (two_sum(least, a.0), two_sum(most, b.0));
                is_exact &= [a.1, b.1, lower.1, upper.1] == [0.0; 4];
                (least, most, size) = (lower.0, upper.0, size + a.0.abs().max(b.0.abs()));
            }
            // Each summand is rounded at most six times.
            let error = if is_exact { 0.0 } else { 16.0 * f64::EPSILON * size + f64::MIN_POSITIVE };
            (min[i], max[i]) = (least - error, most + error);
        }
        if min.iter().chain(&max).all(|c| c.is_finite()) { Extent::Box(min, max) } else { Extent::Unbounded }
    }
}

impl Node {
    /// What is known of the space around the universe; `None` if memory runs out.
    pub(super) fn exterior(&self, frame: &Frame) -> Option<Tag> {
        // Operands first; each operation then takes its own from the end.
        let (mut tasks, mut tags) = (Vec::new(), Vec::new());
        let mut next = Some((self, false));
        while let Some((node, operands_done)) = next.take().or_else(|| tasks.pop()) {
            tags.try_reserve(1).ok()?;
            if node.extent.within(frame) {
                tags.push(Tag::Empty);
            } else if node.opposite.within(frame) {
                tags.push(Tag::Full);
            } else {
                match &node.kind {
                    // Of half-spaces the boxes say all that is known.
                    _ if !node.mixed => tags.push(Tag::Partial),
                    // Nor is it worth as much time as the expression, which is refused, too.
                    _ if node.size > MOST => tags.push(Tag::Partial),
                    Kind::Solid(solid) => tags.push(solid.exterior(frame)),
                    Kind::Join(_, parts) if !operands_done => {
                        tasks.try_reserve(parts.len() + 1).ok()?;
                        tasks.push((node, true));
                        tasks.extend(parts.iter().map(|part| (&**part, false)));
                    }
                    Kind::Complement(part) if !operands_done => {
                        tasks.try_reserve(1).ok()?;
                        tasks.push((node, true));
                        next = Some((part, false));
                    }
                    Kind::Join(join, parts) => {
                        let first = tags.len() - parts.len();
                        let tag = join.of_tags(&tags[first..]);
                        tags.truncate(first);
                        tags.push(tag);
                    }
                    Kind::Complement(_) => {
                        let operand = tags.pop()?;
                        tags.push(operand.complement());
                    }
                    Kind::HalfSpace(_) | Kind::Placed(..) => tags.push(Tag::Partial),
                }
            }
        }
        tags.pop()
    }
}

impl Join {
    /// Of operands that are EMPTY, FULL or PARTIAL.
    fn of_tags(self, operands: &[Tag]) -> Tag {
        let any = |tag| operands.contains(&tag);
        match self {
            Join::Intersection if any(Tag::Empty) => Tag::Empty,
            Join::Union if any(Tag::Full) => Tag::Full,
            _ if any(Tag::Partial) => Tag::Partial,
            Join::Intersection => Tag::Full,
            Join::Union => Tag::Empty,
            Join::Parity => {
                let odd = operands.iter().filter(|&&tag| tag == Tag::Full).count() % 2 != 0;
                if odd { Tag::Full } else { Tag::Empty }
            }
        }
    }
}
