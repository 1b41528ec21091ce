//! Boxes that contain a solid and its complement.

use super::{Join, Kind, MOST, Node};
use crate::error::Error;
use crate::lattice::axes;
use crate::lattice::{Affine, Bounds, Composed, Frame};
use crate::memory;
use crate::octree::Tag;
use crate::solid::AnySolid;
use alloc::vec::Vec;

/// The bounds of a solid, in model units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Extent {
    /// The solid is empty.
    Nothing,
    /// The solid lies in a box.
    Box(Bounds),
    /// No bounds are known.
    Unbounded,
}

impl Extent {
    /// The extent of a solid with these bounds, if they are known.
    pub(super) fn of(bounds: Option<Bounds>) -> Extent {
        bounds.map_or(Extent::Unbounded, Extent::Box)
    }

    /// Returns whether the solid surely lies in the universe.
    fn within(self, frame: &Frame) -> bool {
        match self {
            Extent::Nothing => true,
            Extent::Unbounded => false,
            Extent::Box(bounds) => bounds.is_within(frame),
        }
    }

    /// The extent of the union of two solids.
    pub(super) fn hull(self, other: Extent) -> Extent {
        match (self, other) {
            (Extent::Nothing, extent) | (extent, Extent::Nothing) => extent,
            (Extent::Box(a), Extent::Box(b)) => Extent::Box(a.hull(&b)),
            _ => Extent::Unbounded,
        }
    }

    /// The extent of the intersection of two solids.
    pub(super) fn common(self, other: Extent) -> Extent {
        match (self, other) {
            (Extent::Unbounded, extent) | (extent, Extent::Unbounded) => extent,
            (Extent::Box(a), Extent::Box(b)) => a.common(&b).map_or(Extent::Nothing, Extent::Box),
            _ => Extent::Nothing,
        }
    }

    /// The extent of the solid under placements, rounded outward.
    pub(super) fn under(self, map: &Composed) -> Extent {
        match self {
            Extent::Box(bounds) => Extent::of(bounds.under(map)),
            other => other,
        }
    }
}

/// A box in unit coordinates, in which the universe is [0, 1]³.
pub(super) type UnitBox = ([f64; 3], [f64; 3]);

/// Returns the box around an extent under placements in unit coordinates, rounded outward; `None` if there is
/// none.
pub(super) fn into_universe(extent: Extent, outward: Option<&Composed>, frame: &Frame) -> Option<UnitBox> {
    let extent = outward.map_or(extent, |map| extent.under(map));
    let Extent::Box(Bounds { min, max }) = extent else { return None };
    // One rounding each for a difference and a quotient.
    let unit = |axis: usize, end: f64| {
        let distance = end - frame.origin()[axis];
        let error = 4.0 * f64::EPSILON * (end.abs() + frame.origin()[axis].abs()) / frame.edge();
        (distance / frame.edge(), error + f64::MIN_POSITIVE)
    };
    let low = axes(|axis| {
        let (at, error) = unit(axis, min[axis]);
        at - error
    });
    let high = axes(|axis| {
        let (at, error) = unit(axis, max[axis]);
        at + error
    });
    low.iter().chain(&high).all(|c| c.is_finite()).then_some((low, high))
}

/// The most nodes that are visited for one placement. Below more nodes, boxes around boxes are used.
const MOST_FOLLOWED: usize = 512;

/// The deepest nesting of placements that is followed. Deeper nests consist of translations, scalings and
/// quarter turns, under which boxes lose nothing, since other maps become too long to be exact (`MOST_BITS`).
const MOST_NESTED: u32 = 128;

/// Returns the bounding boxes of a node's solid and of its complement under a placement, rounded outward.
///
/// A box around a turned box is larger than the solid needs, and the excess multiplies in nested placements.
/// So the parts' boxes are taken under all placements at once, down to the parts without boxes inside. The
/// box of the whole node under the placement is valid, too; the intersection of both is returned.
///
/// O(size of the expression), but limited: nesting and sharing cost at most a constant each.
///
/// # Errors
/// [`Error::OutOfMemory`].
pub(super) fn placed(root: &Node, placement: &Affine) -> Result<(Extent, Extent), Error> {
    enum Task<'a> {
        Look(&'a Node, Composed),
        Join(Join, usize),
        Swap,
        Meet(&'a Node, Composed),
    }
    let own = |node: &Node, map: &Composed| (node.extent.under(map), node.opposite.under(map));
    if root.placements > MOST_NESTED {
        return Ok(own(root, &placement.into()));
    }
    let (mut tasks, mut boxes) = (Vec::new(), Vec::new());
    let mut left = MOST_FOLLOWED;
    memory::push(&mut tasks, Task::Look(root, placement.into()))?;
    while let Some(task) = tasks.pop() {
        match task {
            Task::Look(node, map) => {
                left = left.saturating_sub(1);
                match &node.kind {
                    Kind::Placed(part, inner) if left > 0 => {
                        memory::push(&mut tasks, Task::Meet(node, map))?;
                        memory::push(&mut tasks, Task::Look(part, map.after(inner)))?;
                    }
                    Kind::Complement(part) if left > 0 => {
                        memory::push(&mut tasks, Task::Swap)?;
                        memory::push(&mut tasks, Task::Look(part, map))?;
                    }
                    Kind::Join(join, parts)
                        if parts.len() <= left && parts.iter().any(|part| part.has_box()) =>
                    {
                        let first = boxes.len();
                        memory::push(&mut tasks, Task::Meet(node, map))?;
                        memory::push(&mut tasks, Task::Join(*join, first))?;
                        tasks.try_reserve(parts.len())?;
                        tasks.extend(parts.iter().map(|part| Task::Look(part, map)));
                    }
                    _ => memory::push(&mut boxes, own(node, &map))?,
                }
            }
            Task::Join(join, first) => {
                let joined = join.boxes(boxes.drain(first..));
                memory::push(&mut boxes, joined)?;
            }
            Task::Swap => {
                if let Some((extent, opposite)) = boxes.last_mut() {
                    core::mem::swap(extent, opposite);
                }
            }
            Task::Meet(node, map) => {
                let whole = own(node, &map);
                if let Some((extent, opposite)) = boxes.last_mut() {
                    (*extent, *opposite) = (extent.common(whole.0), opposite.common(whole.1));
                }
            }
        }
    }
    Ok(boxes.pop().unwrap_or((Extent::Unbounded, Extent::Unbounded)))
}

impl Join {
    /// Returns the boxes around the joined operands and around the complement of the result, from the
    /// operands' boxes.
    pub(super) fn boxes(
        self,
        mut operands: impl ExactSizeIterator<Item = (Extent, Extent)>,
    ) -> (Extent, Extent) {
        let (none, all) = ((Extent::Nothing, Extent::Unbounded), (Extent::Unbounded, Extent::Nothing));
        match self {
            Join::Union => operands.fold(none, |a, b| (a.0.hull(b.0), a.1.common(b.1))),
            Join::Intersection => operands.fold(all, |a, b| (a.0.common(b.0), a.1.hull(b.1))),
            Join::Parity if operands.len() == 1 => operands.next().unwrap_or(none),
            Join::Parity => (operands.fold(none, |a, b| (a.0.hull(b.0), a.1)).0, Extent::Unbounded),
        }
    }
}

impl Node {
    /// Returns whether a box of the solid or of its complement is known.
    fn has_box(&self) -> bool {
        [self.extent, self.opposite].iter().any(|extent| *extent != Extent::Unbounded)
    }

    /// Returns the tag of the space around the universe. `of_solid` gives the tags of other solids. `None` if
    /// memory runs out.
    pub(super) fn exterior(&self, frame: &Frame, of_solid: impl Fn(&AnySolid) -> Option<Tag>) -> Option<Tag> {
        // Operands first; then each operation takes its operands from the end.
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
                    // For half-spaces alone, the boxes already contain all that is known.
                    _ if !node.mixed => tags.push(Tag::Partial),
                    // The computation is not worth more time than the expression, which is refused at this
                    // size, too.
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
    /// The tag of joined operands, each EMPTY, FULL or PARTIAL.
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
