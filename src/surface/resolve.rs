//! What undecided cells count as.

use crate::error::Error;
use crate::octree::OctreeRef;
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

/// Whether PARTIAL cells of a tree count as inside, by a choice that needs no source.
///
/// # Errors
/// [`Error::Argument`] if the tree has PARTIAL cells and nothing is chosen.
pub(super) fn partial_is_inside(tree: &OctreeRef<'_>, resolve: Option<&Resolve<'_>>) -> Result<bool, Error> {
    match resolve {
        Some(Resolve::Outer) => Ok(true),
        Some(_) => Ok(false),
        None if tree.is_binary() => Ok(false),
        None => {
            let problem = "the octree has PARTIAL cells, which have no sign: choose inner, outer or source";
            Err(Error::Argument { name: "resolve", problem })
        }
    }
}
