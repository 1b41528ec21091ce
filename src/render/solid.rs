//! Surfaces of solids, by rays.

use super::light::{Light, brightness};
use super::normals::Normals;
use super::stage::{Draw, Painter, Stage};
use super::tile::Tile;
use crate::error::Error;
use crate::lattice::Frame;
use crate::memory;
use crate::octree::OctreeRef;
use crate::query::{Obstacle, Ray, RayHit};
use alloc::boxed::Box;
use alloc::vec::Vec;
use glam::DVec3;

/// What surfaces look like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finish {
    /// The colour in full light: red, green, blue (sRGB) and opacity, 0 to 255.
    pub colour: [u8; 4],
    /// The colour of what a clip plane cuts open.
    pub cut: [u8; 4],
    /// Shows cells by their faces, instead of the surface that they stand for.
    pub faces: bool,
}

impl Default for Finish {
    /// Opaque grey, orange where it is cut.
    fn default() -> Finish {
        Finish { colour: [178, 187, 196, 255], cut: [213, 142, 74, 255], faces: false }
    }
}

/// The surface of a stored octree, or of any solid: the first cells that are not EMPTY along each line of sight.
///
/// Normals are those of planes fitted to the cells of 12³ about each block of 4³; where the surface is not plane there, the
/// gradient of the occupancy over 5³ cells, in which PARTIAL cells count half. What is cut open by a clip plane is shown flat.
///
/// O(samples · cells along a line of sight).
#[derive(Debug, Clone, Copy)]
pub struct OctreeLayer<'a> {
    tree: OctreeRef<'a>,
    finish: Finish,
}

impl<'a> OctreeLayer<'a> {
    /// The cells of an octree that are not EMPTY.
    pub fn new(tree: &OctreeRef<'a>, finish: Finish) -> OctreeLayer<'a> {
        OctreeLayer { tree: *tree, finish }
    }
}

/// Samples of a block that rays are cast of at once: columns and rows.
const BLOCK: [usize; 2] = [8, 4];

impl Draw for OctreeLayer<'_> {
    fn prepare<'a>(&'a self, stage: &Stage<'a>) -> Result<Box<dyn Painter + 'a>, Error> {
        Ok(memory::boxed(OctreePainter { layer: self, stage: *stage })?)
    }
}

struct OctreePainter<'a> {
    layer: &'a OctreeLayer<'a>,
    stage: Stage<'a>,
}

impl Painter for OctreePainter<'_> {
    fn paint(&self, tile: &mut Tile<'_>) -> Result<(), Error> {
        let tree = &self.layer.tree;
        let mut normals = Normals::new(tree);
        let (mut rays, mut sights): (Vec<Ray>, Vec<Sight>) = (Vec::new(), Vec::new());
        let mut hits = [None; BLOCK[0] * BLOCK[1]];
        for row in (0..tile.height()).step_by(BLOCK[1]) {
            self.stage.job.check()?;
            for column in (0..tile.width()).step_by(BLOCK[0]) {
                rays.clear();
                sights.clear();
                for y in row..(row + BLOCK[1]).min(tile.height()) {
                    for x in column..(column + BLOCK[0]).min(tile.width()) {
                        if let Some((sight, ray)) = Sight::new(&self.stage, tile, [x, y]) {
                            memory::push(&mut rays, ray)?;
                            memory::push(&mut sights, sight)?;
                        }
                    }
                }
                let hits = &mut hits[..rays.len()];
                tree.cast_rays(&rays, Obstacle::Upper, hits)?;
                for (sight, hit) in sights.iter().zip(hits) {
                    if let Some(hit) = hit {
                        let normal = |point: DVec3| normal_of_cells(&mut normals, tree.frame(), point, hit);
                        sight.draw(&self.layer.finish, tile, hit, normal)?;
                    }
                }
            }
        }
        Ok(())
    }
}

/// A line of sight that begins where it is shown.
struct Sight {
    sample: usize,
    from: DVec3,
    along: DVec3,
    /// The depth at which it begins, and the outward normal of the clip plane there.
    start: f64,
    entry: Option<DVec3>,
}

impl Sight {
    /// `None` if nothing of it is shown.
    fn new(stage: &Stage<'_>, tile: &Tile<'_>, [x, y]: [usize; 2]) -> Option<(Sight, Ray)> {
        let (eye, along) = tile.line(x, y);
        let shown = stage.clip.shown(eye, along)?;
        let from = eye + along * shown.from;
        // Components far below a rounding of the others only get in the way.
        let plain = along.to_array().map(|c| if c.abs() < 1e-60 { 0.0 } else { c });
        let ray = Ray::new(from.to_array(), plain).and_then(|ray| ray.until(shown.to - shown.from)).ok()?;
        let sample = y * tile.width() + x;
        Some((Sight { sample, from, along, start: shown.from, entry: shown.entry }, ray))
    }

    /// Draws what it meets; `normal` finds the outward normal at a point.
    fn draw(
        &self,
        finish: &Finish,
        tile: &mut Tile<'_>,
        hit: &RayHit,
        normal: impl FnOnce(DVec3) -> Result<DVec3, Error>,
    ) -> Result<(), Error> {
        let t = hit.t.lower.max(0.0);
        let face = DVec3::from(hit.normal);
        let is_cut = t == 0.0 && face == DVec3::ZERO;
        let normal = if is_cut {
            self.entry.unwrap_or(-self.along)
        } else if finish.faces {
            face
        } else {
            let found = normal(self.from + self.along * t)?;
            // What is seen faces whoever sees it.
            if found.dot(self.along) < 0.0 { found } else { facing(found, face, self.along) }
        };
        let camera = &tile.view.camera;
        let [right, up, forward] = [camera.right(), camera.up(), camera.forward()].map(DVec3::from);
        let colour = Light::of(if is_cut { finish.cut } else { finish.colour });
        let light = colour.lit(brightness(normal, self.along, right, up, forward));
        tile.put(self.sample, self.start + t, light)
    }
}

/// A normal that seems to face away, brought to the silhouette; the face's if there is none.
fn facing(normal: DVec3, face: DVec3, along: DVec3) -> DVec3 {
    let across = normal - along * (normal.dot(along) / along.length_squared());
    across.try_normalize().unwrap_or(if face == DVec3::ZERO { -along } else { face })
}

fn normal_of_cells(
    normals: &mut Normals<'_>,
    frame: &Frame,
    point: DVec3,
    hit: &RayHit,
) -> Result<DVec3, Error> {
    let scaled = DVec3::from([0, 1, 2].map(|axis| frame.scaled(axis, point[axis])));
    let shift = frame.depth() - hit.cell.level;
    let at = [0, 1, 2].map(|axis| {
        let (low, high) = (hit.cell.at[axis] << shift, ((hit.cell.at[axis] + 1) << shift) - 1);
        // (A cast saturates.)
        (scaled[axis] as u32).clamp(low, high)
    });
    normals.at(scaled, at)
}
