//! Drawing a solid that consists of a single mesh by its triangles.
//!
//! From outside, a closed mesh and its solid look the same: the first triangle that a line of sight meets
//! leads into the solid under every fill rule, if it is met from the front. So triangles are drawn, which
//! takes less time than rays. If one is seen from behind, the tile is drawn like that of any solid.

use super::mesh::MeshLayer;
use super::sight::Finish;
use super::stage::{Draw, Painter, Stage};
use super::surface::Skin;
use super::tile::Tile;
use crate::error::Error;
use crate::lattice::{Bounds, Frame};
use crate::memory;
use crate::mesh::{FillRule, TriangleMesh};
use alloc::boxed::Box;
use glam::DVec3;
use once_cell::race::OnceBox;

/// The triangles of a solid, in the solid's colour.
pub struct Facets<'a> {
    mesh: &'a TriangleMesh,
    layer: MeshLayer<'a>,
}

/// The colour of back faces: transparent, which distinguishes them from everything else.
const BEHIND: [u8; 4] = [0; 4];

impl<'a> Facets<'a> {
    pub fn new(mesh: &'a TriangleMesh, finish: &Finish) -> Facets<'a> {
        Facets { mesh, layer: MeshLayer::new(mesh).colour(finish.colour).inside(BEHIND).crease(0.0) }
    }

    /// Returns whether the triangles look like the solid: the mesh is closed, lies in the universe and in
    /// front of the eye, is opaque, has no edges and no values to show, and nothing of it is cut away.
    pub fn show_the_solid(&self, skin: &Skin<'_>, frame: &Frame, stage: &Stage<'_>) -> Result<bool, Error> {
        let Finish { colour, edges, .. } = skin.finish;
        if skin.values.is_some() || edges.is_some() || colour[3] < 255 || !stage.clip.is_empty() {
            return Ok(false);
        }
        let ((low, high), universe) = (self.mesh.bounds(), Bounds::of(frame));
        let is_within = (0..3).all(|axis| {
            // (A mesh with corners in a face of the universe may seem to extend beyond it.)
            universe.min[axis] <= low[axis] && high[axis] <= universe.max[axis]
        });
        let corners = Bounds { min: low, max: high }.corners();
        let is_before = corners.iter().all(|&corner| stage.view.camera.seen(DVec3::from(corner)).z > 0.0);
        if !is_within || !is_before {
            return Ok(false);
        }
        match self.mesh.check_closed(FillRule::NonZero) {
            Ok(()) => Ok(true),
            Err(Error::Mesh(_)) => Ok(false),
            Err(error) => Err(error),
        }
    }

    /// Returns the painter of the triangles. For tiles with back faces it uses the painter that `make`
    /// creates.
    pub fn painter<'b, P: Painter + Send + 'b>(
        &'b self,
        stage: &Stage<'b>,
        make: impl Fn() -> Result<P, Error> + Sync + 'b,
    ) -> Result<Box<dyn Painter + 'b>, Error> {
        let facets = self.layer.prepare(stage)?;
        Ok(memory::boxed(FacetPainter { facets, make, solid: OnceBox::new() })?)
    }
}

struct FacetPainter<'b, P, F> {
    facets: Box<dyn Painter + 'b>,
    make: F,
    /// The painter of any solid, created when it is first needed.
    solid: OnceBox<P>,
}

impl<P: Painter + Send, F: Fn() -> Result<P, Error> + Sync> Painter for FacetPainter<'_, P, F> {
    fn paint(&self, tile: &mut Tile<'_>) -> Result<(), Error> {
        let mut own = Tile::new(tile.view, tile.first, tile.size, tile.grid)?;
        self.facets.paint(&mut own)?;
        own.sort();
        if !own.fragments.is_empty() {
            let solid = self.solid.get_or_try_init(|| (self.make)().map(Box::new))?;
            return solid.paint(tile);
        }
        for (sample, seen) in own.opaque.iter().enumerate() {
            if seen.depth < f64::INFINITY {
                tile.put(sample, seen.depth, seen.light)?;
            }
        }
        Ok(())
    }
}
