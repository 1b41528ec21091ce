//! The borrowed view of a channel, which does all reading.

use super::value::{Bits, ValueType};
use crate::lattice::Each;
use crate::lattice::{Frame, morton};
use crate::octree::Tag;
use crate::octree::view::OctreeRef;
use crate::octree::word::Planes;
use yoke::Yokeable;

/// A borrowed channel: values inside a cube, in a separate tree. Copying it copies no values.
///
/// # How values are stored
///
/// The tree of a channel is stored like that of an [octree](OctreeRef), but has another meaning:
///
/// | lower | upper | the cell |
/// |---|---|---|
/// | 0 | 0 | has no value |
/// | 1 | 1 | starts a new value |
/// | 0 | 1 | has the value of the cell before it that has one |
/// | 1 | 0 | is refined: it has a node |
///
/// *Before* means in level order: level by level, in Morton order within a level. So the index of a cell's
/// value in the array of values is a rank: the number of cells up to and including this cell that start a
/// value, less one. A region of equal values costs one value, however many cells it has. A channel with one
/// value everywhere has no element at all.
///
/// Eight equal siblings are one cell, and a cell starts a value only if its value differs from the one
/// before. So the same values in the same cells have only one representation.
#[derive(Debug, Clone, Copy, Yokeable)]
pub struct ChannelRef<'a> {
    pub(crate) tree: OctreeRef<'a>,
    pub(crate) value_type: ValueType,
    /// Number of values that start before each element or brick, less the base of its block of 1024.
    pub(crate) value_rel: &'a [u16],
    /// Number of values that start before every 1024th element or brick.
    pub(crate) value_base: &'a [u64],
    /// The values; their numbers are in this machine's byte order.
    pub(crate) values: &'a [u8],
}

/// A cell of a channel during a descent.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Spot {
    /// The cell has one value everywhere, or none.
    Settled(Option<Bits>),
    /// The cell has a node.
    Split(SplitSpot),
}

/// The node of a cell: an element, or one of its octants.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SplitSpot {
    e: usize,
    index: usize,
    planes: Planes,
    octant: Option<u32>,
}

/// The content of an octant.
pub(crate) enum Octant {
    Nothing,
    /// One value, that of its first cell.
    OneValue,
    Cut,
}

/// Returns the content of octant `k` of an element.
#[inline]
pub(crate) fn octant(planes: Planes, k: u32) -> Octant {
    match ((planes.lower >> (8 * k)) as u8, (planes.upper >> (8 * k)) as u8) {
        (0, 0) => Octant::Nothing,
        (0 | 1, 0xFF) => Octant::OneValue,
        _ => Octant::Cut,
    }
}

impl<'a> ChannelRef<'a> {
    /// Returns the frame of the channel, whose depth limits the resolution of its values.
    pub fn frame(&self) -> &Frame {
        self.tree.frame()
    }

    /// Returns the type of the values.
    pub fn value_type(&self) -> ValueType {
        self.value_type
    }

    /// Returns the number of stored values: one for each run of equal values.
    pub fn value_count(&self) -> u64 {
        (self.values.len() / self.value_type.size()) as u64
    }

    /// Returns the number of elements and bricks of the tree; see [`OctreeRef::element_count`].
    pub fn element_count(&self) -> u64 {
        self.tree.element_count() + self.tree.brick_count()
    }

    /// Returns the stored value with this index; `None` beyond the end.
    #[inline]
    pub(crate) fn stored(&self, index: usize) -> Option<Bits> {
        let size = self.value_type.size();
        let start = index.checked_mul(size)?;
        let raw = self.values.get(start..start.checked_add(size)?)?;
        Some(self.value_type.read(raw))
    }

    /// Returns the value of the cell `c` of the element or brick `index`, whose cells are `planes`.
    #[inline]
    fn value_in(&self, index: usize, planes: Planes, c: u32) -> Option<Bits> {
        let before = self.value_base.get(index >> 10)?.checked_add(u64::from(*self.value_rel.get(index)?))?;
        let rank = (planes.full() & (2u64 << c).wrapping_sub(1)).count_ones();
        self.stored(usize::try_from(before.checked_add(rank.into())?.checked_sub(1)?).ok()?)
    }

    /// Returns the value of the finest cell at `at`, if that lies in the universe.
    pub(crate) fn bits_at(&self, at: [u32; 3]) -> Option<Bits> {
        match self.tree.root {
            Tag::Branch => {}
            Tag::Full => return self.stored(0),
            _ => return None,
        }
        let (levels, mut index) = (self.tree.levels(), 0);
        for e in 0..levels {
            let planes = self.tree.entry(index)?;
            let shift = 2 * (levels - 1 - e);
            let [x, y, z] = at.each(|a| a >> shift);
            let c = morton::index(x, y, z);
            match planes.tag(c) {
                Tag::Empty => return None,
                Tag::Branch => {
                    let child = self.tree.child(index, planes.branch(), c)?;
                    if e + 1 == levels || !self.tree.on_level(child, e + 1) {
                        return None;
                    }
                    index = child;
                }
                Tag::Full | Tag::Partial => return self.value_in(index, planes, c),
            }
        }
        None
    }

    /// Returns the universe.
    pub(crate) fn root(&self) -> Spot {
        match self.tree.root {
            Tag::Branch => {
                let first = (!self.frame().depth().is_multiple_of(2)).then_some(0);
                self.enter(0, 0, first)
            }
            Tag::Full => Spot::Settled(self.stored(0)),
            _ => Spot::Settled(None),
        }
    }

    /// Returns the eight children of a cell.
    pub(crate) fn children(&self, spot: &Spot) -> [Spot; 8] {
        let &Spot::Split(SplitSpot { e, index, planes, octant: half }) = spot else { return [*spot; 8] };
        core::array::from_fn(|k| match half {
            None => {
                let k = k as u32;
                match octant(planes, k) {
                    Octant::Nothing => Spot::Settled(None),
                    Octant::OneValue => Spot::Settled(self.value_in(index, planes, 8 * k)),
                    Octant::Cut => Spot::Split(SplitSpot { e, index, planes, octant: Some(k) }),
                }
            }
            Some(half) => {
                let c = 8 * half + k as u32;
                match planes.tag(c) {
                    Tag::Empty => Spot::Settled(None),
                    Tag::Branch => {
                        let child = self.tree.child(index, planes.branch(), c);
                        let on_next =
                            |&child: &usize| e + 1 < self.tree.levels() && self.tree.on_level(child, e + 1);
                        match child.filter(on_next) {
                            Some(child) => self.enter(e + 1, child, None),
                            None => Spot::Settled(None),
                        }
                    }
                    Tag::Full | Tag::Partial => Spot::Settled(self.value_in(index, planes, c)),
                }
            }
        })
    }

    fn enter(&self, e: usize, index: usize, octant: Option<u32>) -> Spot {
        match self.tree.entry(index) {
            Some(planes) => Spot::Split(SplitSpot { e, index, planes, octant }),
            None => Spot::Settled(None),
        }
    }
}
