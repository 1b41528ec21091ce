//! Boxes that contain a solid and its complement.

use super::word::MOST;
use super::{Join, Kind, Node};
use crate::lattice::{Affine, Bounds, Frame};
use crate::octree::Tag;
use crate::solid::AnySolid;
use alloc::sync::Arc;
use alloc::vec::Vec;

/// What a solid surely does not reach beyond, in model units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Extent {
    /// It is empty.
    Nothing,
    /// A box.
    Box(Bounds),
    /// Nobody knows.
    Unbounded,
}

impl Extent {
    /// Of what is known to lie in a box, or not.
    pub(super) fn of(bounds: Option<Bounds>) -> Extent {
        bounds.map_or(Extent::Unbounded, Extent::Box)
    }

    /// Whether the solid surely lies in the universe.
    fn within(self, frame: &Frame) -> bool {
        match self {
            Extent::Nothing => true,
            Extent::Unbounded => false,
            Extent::Box(bounds) => bounds.is_within(frame),
        }
    }

    /// Of the union of two solids.
    pub(super) fn hull(self, other: Extent) -> Extent {
        match (self, other) {
            (Extent::Nothing, extent) | (extent, Extent::Nothing) => extent,
            (Extent::Box(a), Extent::Box(b)) => Extent::Box(a.hull(&b)),
            _ => Extent::Unbounded,
        }
    }

    /// Of the intersection of two solids.
    pub(super) fn common(self, other: Extent) -> Extent {
        match (self, other) {
            (Extent::Unbounded, extent) | (extent, Extent::Unbounded) => extent,
            (Extent::Box(a), Extent::Box(b)) => a.common(&b).map_or(Extent::Nothing, Extent::Box),
            _ => Extent::Nothing,
        }
    }

    /// Of the solid under a placement, rounded outward.
    pub(super) fn placed(self, placement: &Affine) -> Extent {
        match self {
            Extent::Box(bounds) => Extent::of(bounds.placed(placement)),
            other => other,
        }
    }
}

/// The placements that a node stands under, from the inside out.
pub(super) struct Outward {
    placement: Affine,
    outer: Option<Arc<Outward>>,
    /// How many there are, this one included.
    count: u32,
}

/// Placements within each other through which boxes are followed.
const MOST_FOLLOWED: u32 = 64;

/// A box in unit coordinates, in which the universe is [0, 1]³.
pub(super) type UnitBox = ([f64; 3], [f64; 3]);

impl Outward {
    pub(super) fn new(placement: &Affine, outer: Option<Arc<Outward>>) -> Arc<Outward> {
        let count = outer.as_ref().map_or(0, |outer| outer.count) + 1;
        // Of more of them nothing is known, and none is kept.
        let outer = outer.filter(|_| count <= MOST_FOLLOWED);
        Arc::new(Outward { placement: *placement, outer, count: count.min(MOST_FOLLOWED + 1) })
    }

    /// The box around an extent in unit coordinates, rounded outward; `None` if there is none.
    pub(super) fn into_universe(this: Option<&Outward>, extent: Extent, frame: &Frame) -> Option<UnitBox> {
        if this.is_some_and(|outward| outward.count > MOST_FOLLOWED) {
            return None;
        }
        let (mut extent, mut next) = (extent, this);
        while let (Extent::Box(_), Some(outward)) = (extent, next) {
            (extent, next) = (extent.placed(&outward.placement), outward.outer.as_deref());
        }
        let Extent::Box(Bounds { min, max }) = extent else { return None };
        // A difference and a quotient, each rounded once.
        let unit = |axis: usize, end: f64| {
            let distance = end - frame.origin()[axis];
            let error = 4.0 * f64::EPSILON * (end.abs() + frame.origin()[axis].abs()) / frame.edge();
            (distance / frame.edge(), error + f64::MIN_POSITIVE)
        };
        let low = [0, 1, 2].map(|axis| {
            let (at, error) = unit(axis, min[axis]);
            at - error
        });
        let high = [0, 1, 2].map(|axis| {
            let (at, error) = unit(axis, max[axis]);
            at + error
        });
        low.iter().chain(&high).all(|c| c.is_finite()).then_some((low, high))
    }
}

impl Node {
    /// What is known of the space around the universe, by what `of_solid` says of other solids; `None` if
    /// memory runs out.
    pub(super) fn exterior(&self, frame: &Frame, of_solid: impl Fn(&AnySolid) -> Option<Tag>) -> Option<Tag> {
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
                    Kind::Solid(solid) => tags.push(of_solid(solid)?),
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
