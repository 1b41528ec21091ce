//! Sides for undecided cells.

use crate::control::Control;
use crate::error::Error;
use crate::octree::OctreeRef;
use crate::op::{Rule, build};
use crate::solid::AnySolid;

/// The side of the surface on which the samples of PARTIAL cells lie, which have no sign of their own.
#[derive(Clone, Copy)]
pub enum Resolve<'s> {
    /// Outside: the surface bounds the FULL cells, the part that is certainly solid.
    Inner,
    /// Inside: the surface bounds the FULL and PARTIAL cells, the part that is possibly solid.
    Outer,
    /// On the side that the octree's source solid returns: each cell's centre decides, as under
    /// [`Rule::Sampled`](crate::Rule::Sampled). The solid is built anew on the octree's frame.
    Source(&'s AnySolid),
}

/// Passes a tree to `extract`, and whether its PARTIAL cells count as inside. If a source solid decides, the
/// tree is built from it in the first half of the work.
///
/// # Errors
/// [`Error::Argument`] if the tree has PARTIAL cells and nothing is chosen; and the errors of `extract` and
/// of building.
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
