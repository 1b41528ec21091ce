//! Cutting a stored octree into shards, and joining them.

use super::extended::{self, Combination};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Shard;
use crate::memory;
use crate::octree::{Octree, OctreeRef};

/// Puts together what several trees know of one solid: a cell is FULL or EMPTY if one of them says so, and
/// PARTIAL where all leave it open. Surfaces of a PARTIAL cell are kept, if one of them does.
///
/// This is the reverse of cutting an octree into [shards](Shard), plain or extended: the bytes are those of
/// the whole. A shard that is missing is a PARTIAL cell. The trees may overlap. A cell of which one keeps
/// surfaces ends there: what others know of its parts is passed over, and if two keep surfaces of it, those
/// of the first are kept. Moments are those of the first that has them. The result has no metadata and no
/// channels.
///
/// Time is linear in the cells that are cut in one tree and known in another one, plus the memory traffic of
/// what is copied.
///
/// # Errors
/// [`Error::Argument`] if there is no tree, or one says FULL where another one says EMPTY: they are not of
/// one solid; [`Error::FrameMismatch`]; [`Error::Damaged`] if an unverified tree turns out damaged; and what
/// `control` asks for.
pub fn join(trees: &[OctreeRef<'_>], control: &Control<'_>) -> Result<Octree, Error> {
    let operands = memory::collected(trees.iter().map(|tree| (*tree, false)))?;
    extended::combine_cells(&operands, Combination::Known, None, control)
}

/// The [`Shard`] of an octree: the tree that [`build_shard`](crate::build_shard) and
/// [`build_extended_shard`](crate::op::build_extended_shard) make of its source. Without metadata and
/// channels.
///
/// # Errors
/// [`Error::Argument`] if the tree's frame does not have the shard's cells; [`Error::Damaged`] if an
/// unverified tree turns out damaged; and what `control` asks for.
///
/// ```
/// use leafless::op::{join, shard};
/// use leafless::{Control, Csg, Frame, Rule, Shard, build};
/// let (frame, control) = (Frame::new([-1.0; 3], 2.0, 7)?, Control::default());
/// let ball = build(&Csg::ball([0.1, 0.0, 0.0], 0.75)?, &frame, Rule::Certified, &control)?;
/// let top = shard(ball.view(), Shard::Top { level: 1 }, &control)?;
/// // Without the other seven octants the volume is known less well, and is no less true.
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
