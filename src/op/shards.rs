//! Cutting a stored octree into shards, and joining them.

use super::extended::{self, Combination};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Shard;
use crate::memory;
use crate::octree::{Octree, OctreeRef};

/// Joins several trees that each know a part of one solid. A cell is FULL or EMPTY if one of the trees says
/// so, and PARTIAL where all trees leave it open. The surfaces of a PARTIAL cell are kept if one of the trees
/// keeps them.
///
/// This operation reverses the cutting of an octree into [shards](Shard), plain or extended: the bytes are
/// those of the whole octree. A missing shard is a PARTIAL cell. The trees may overlap. If one tree keeps
/// surfaces of a cell, the cell ends there and is not split, even where other trees know its parts. If two
/// trees keep surfaces of a cell, those of the first tree are kept. Moments are those of the first tree that
/// has them. The result has no metadata and no channels.
///
/// Time is linear in the cells that are cut in one tree and known in another, plus the memory traffic of the
/// copied subtrees.
///
/// # Errors
/// [`Error::Argument`] if there is no tree, or if one tree says FULL where another says EMPTY, because they
/// do not describe one solid; [`Error::FrameMismatch`]; [`Error::Damaged`] if an unverified tree turns out to
/// be damaged; and cancellation or an exceeded limit of `control`.
pub fn join(trees: &[OctreeRef<'_>], control: &Control<'_>) -> Result<Octree, Error> {
    let operands = memory::collected(trees.iter().map(|tree| (*tree, false)))?;
    extended::combine_cells(&operands, Combination::Known, None, control)
}

/// Cuts the [`Shard`] out of an octree: the tree that [`build_shard`](crate::build_shard) and
/// [`build_extended_shard`](crate::op::build_extended_shard) build from its source. The shard has no metadata
/// and no channels.
///
/// # Errors
/// [`Error::Argument`] if the tree's frame does not contain the shard's cells; [`Error::Damaged`] if an
/// unverified tree turns out to be damaged; and cancellation or an exceeded limit of `control`.
///
/// ```
/// use leafless::op::{join, shard};
/// use leafless::{Control, Csg, Frame, Rule, Shard, build};
/// let (frame, control) = (Frame::new([-1.0; 3], 2.0, 7)?, Control::default());
/// let ball = build(&Csg::ball([0.1, 0.0, 0.0], 0.75)?, &frame, Rule::Certified, &control)?;
/// let top = shard(ball.view(), Shard::Top { level: 1 }, &control)?;
/// // Without the other seven octants the bounds of the volume are wider, and still true.
/// let cell = top.view().open_cells(1)?[0];
/// let one = shard(ball.view(), Shard::Below(cell), &control)?;
/// let most = join(&[*top.view(), *one.view()], &control)?.statistics().volume();
/// assert!(most.lower < 0.3 && most.upper > 7.0);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn shard(tree: &OctreeRef<'_>, shard: Shard, control: &Control<'_>) -> Result<Octree, Error> {
    shard.check(tree.frame().depth())?;
    extended::combine_cells(&[(*tree, false)], Combination::Known, Some(shard), control)
}
