//! Surfaces of stored octrees, by rays.

use super::normals::{Normals, normal_of_cells};
use super::sight::Finish;
use super::solid::{DEEPEST, painter};
use super::stage::{Colouring, Draw, Painter, Stage};
use super::surface::{Seen, Skin, paint};
use super::tile::Tile;
use crate::attribute::Attribute;
use crate::error::Error;
use crate::memory;
use crate::octree::OctreeRef;
use alloc::boxed::Box;
use glam::DVec3;

/// A layer that shows the surface of a stored octree: the first cells that are not EMPTY along each line of
/// sight.
///
/// An extended octree ([`build_extended`](crate::build_extended)) is shown as the solid that its cuts
/// describe, like a [`SolidLayer`](crate::render::SolidLayer). With [`faces`](Finish::faces) its own cells
/// are shown. Use the tree of [`plain`](crate::op::plain) for smaller cells.
///
/// Normals are those of planes fitted to the surface in windows of 24³ cells, or of 12³ where it is not
/// plane. Where it is not plane there either, the normal is the gradient of the occupancy over 5³ cells, in
/// which PARTIAL cells count half. A part that a clip plane cuts open is shown flat. Through a translucent
/// surface other layers are visible, but nothing more of this layer.
///
/// O(samples · cells along a line of sight).
#[derive(Clone, Copy)]
pub struct OctreeLayer<'a> {
    tree: OctreeRef<'a>,
    skin: Skin<'a>,
}

impl core::fmt::Debug for OctreeLayer<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("OctreeLayer").field("finish", &self.skin.finish).finish_non_exhaustive()
    }
}

impl<'a> OctreeLayer<'a> {
    /// Creates a layer of the cells of an octree that are not EMPTY.
    pub fn new(tree: &OctreeRef<'a>, finish: Finish) -> OctreeLayer<'a> {
        OctreeLayer { tree: *tree, skin: Skin { finish, values: None } }
    }

    /// Shows the colours of an attribute's values, for example those of a channel: `colour` returns the
    /// colour of a value, and of a missing value. The value is taken half a finest cell below the surface,
    /// where a solid's channel has one.
    #[must_use]
    pub fn values(self, attribute: &'a dyn Attribute, colour: Colouring<'a>) -> OctreeLayer<'a> {
        OctreeLayer { skin: Skin { values: Some((attribute, colour)), ..self.skin }, ..self }
    }
}

impl Draw for OctreeLayer<'_> {
    fn prepare<'a>(&'a self, stage: &Stage<'a>) -> Result<Box<dyn Painter + 'a>, Error> {
        self.skin.check()?;
        if self.tree.cuts().is_some() && !self.skin.finish.faces {
            return painter(&self.tree, self.tree.frame(), DEEPEST, &self.skin, stage);
        }
        Ok(memory::boxed(OctreePainter { layer: self, stage: *stage })?)
    }
}

struct OctreePainter<'a> {
    layer: &'a OctreeLayer<'a>,
    stage: Stage<'a>,
}

impl Painter for OctreePainter<'_> {
    fn paint(&self, tile: &mut Tile<'_>) -> Result<(), Error> {
        let OctreeLayer { tree, skin } = self.layer;
        let mut normals = Normals::new(tree);
        let blur = if skin.finish.faces { 0.0 } else { BLUR * tree.frame().cell_size() };
        paint(tile, &self.stage, tree, skin, blur, |sight, touch| {
            let (t, face) = (touch.t, DVec3::from(touch.normal));
            let normal = if sight.begins_in(t, face) {
                None
            } else if skin.finish.faces {
                Some(face)
            } else {
                let point = sight.from + sight.along * t;
                let found = normal_of_cells(&mut normals, tree.frame(), point, &touch)?;
                Some(if found == DVec3::ZERO { face } else { found })
            };
            Ok(Some(Seen { t, normal }))
        })
    }
}

/// The number of cells over which normals turn at an edge.
const BLUR: f64 = 6.0;
