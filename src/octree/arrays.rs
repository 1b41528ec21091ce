//! The arrays of a tree in memory.

use super::brick::OwnedBricks;
use super::cuts::Cuts;
use super::proof::Proof;
use super::tag::Tag;
use super::view::{MAX_ELEMENT_LEVELS, OctreeRef, element_levels};
use super::word::Planes;
use crate::error::{Damage, Error};
use crate::lattice::Frame;
use alloc::vec::Vec;

/// The arrays behind an octree in memory.
pub(crate) struct Arrays {
    pub frame: Frame,
    pub root: Tag,
    pub exterior: Tag,
    pub planes: Vec<Planes>,
    pub rel: Vec<u16>,
    pub base: Vec<u64>,
    pub bricks: OwnedBricks,
    pub starts: [usize; MAX_ELEMENT_LEVELS + 1],
    /// True if the links are those that the planes determine.
    pub is_linked: bool,
    /// The surfaces that PARTIAL cells keep.
    pub cuts: Option<Cuts>,
}

impl Arrays {
    /// Ranks the children of `planes`, which lie in level order as `starts` says.
    ///
    /// # Errors
    ///
    /// [`Damage::Count`] if the number of elements of a level differs from the number that its parents
    /// demand. Copying from damaged operands can cause this.
    pub(crate) fn link(
        frame: Frame,
        root: Tag,
        exterior: Tag,
        planes: Vec<Planes>,
        bricks: OwnedBricks,
        starts: [usize; MAX_ELEMENT_LEVELS + 1],
    ) -> Result<Arrays, Error> {
        let mut rel = Vec::new();
        let mut base = Vec::new();
        rel.try_reserve_exact(planes.len())?;
        base.try_reserve_exact(planes.len().div_ceil(1024))?;
        let levels = element_levels(frame.depth());
        let mut next = (root == Tag::Branch) as usize;
        for e in 0..levels {
            let (found, expected) = (starts[e + 1], next);
            if found != expected {
                let (expected, found) = ((expected - starts[e]) as u64, (found - starts[e]) as u64);
                return Err(Damage::Count { level: e as u8, expected, found }.into());
            }
            for (n, planes) in planes.iter().enumerate().take(starts[e + 1]).skip(starts[e]) {
                if n % 1024 == 0 {
                    base.push(next as u64);
                }
                rel.push((next as u64 - base[n >> 10]) as u16);
                next += planes.branch().count_ones() as usize;
            }
        }
        Ok(Arrays { frame, root, exterior, planes, rel, base, bricks, starts, is_linked: true, cuts: None })
    }

    pub(crate) fn view(&self) -> OctreeRef<'_> {
        OctreeRef {
            frame: self.frame,
            root: self.root,
            exterior: self.exterior,
            proof: Proof::CERTIFIED,
            planes: &self.planes,
            rel: &self.rel,
            base: &self.base,
            bricks: self.bricks.view(),
            starts: self.starts,
            table: None,
            is_linked: self.is_linked,
            cuts: self.cuts.as_ref().map(Cuts::view),
        }
    }
}
