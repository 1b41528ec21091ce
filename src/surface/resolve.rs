//! What undecided cells count as.

use crate::control::Control;
use crate::error::Error;
use crate::octree::OctreeRef;
use crate::op::{Rule, build};
use crate::solid::AnySolid;

/// On which side of the surface the samples of PARTIAL cells lie, which have no sign of their own.
#[derive(Clone, Copy)]
pub enum Resolve<'s> {
    /// Outside: the surface is that of the FULL cells, of what is surely solid.
    Inner,
    /// Inside: the surface is that of the FULL and PARTIAL cells, of what is possibly solid.
    Outer,
    /// Where the solid says that the octree was made from: each cell's centre decides, as under
    /// [`Rule::Sampled`](crate::Rule::Sampled). The solid is built anew on the octree's frame.
    Source(&'s AnySolid),
}

/// What `extract` makes of a tree and of whether its PARTIAL cells count as inside. If a source decides, the
/// tree is the one that is built of it, in the first half of the work.
///
/// # Errors
/// [`Error::Argument`] if the tree has PARTIAL cells and nothing is chosen; those of `extract`, and of
/// building.
pub(super) fn resolved<T>(
    tree: &OctreeRef<'_>,
    resolve: Option<Resolve<'_>>,
    control: &Control<'_>,
    extract: impl FnOnce(&OctreeRef<'_>, bool, &Control<'_>) -> Result<T, Error>,
) -> Result<T, Error> {
    match resolve {
        Some(Resolve::Source(solid)) => {
            let sampled =
                control.share([0.0, 0.5], |control| build(solid, tree.frame(), Rule::Sampled, control))?;
            control.share([0.5, 1.0], |control| extract(sampled.view(), false, control))
        }
        Some(Resolve::Inner) => extract(tree, false, control),
        Some(Resolve::Outer) => extract(tree, true, control),
        None if tree.is_binary() => extract(tree, false, control),
        None => {
            let problem = "the octree has PARTIAL cells, which have no sign: choose inner, outer or source";
            Err(Error::Argument { name: "resolve", problem })
        }
    }
}
