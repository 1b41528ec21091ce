//! Surfaces of any solids, by rays.

use super::sight::{Finish, Sight};
use super::stage::{Draw, Painter, Stage};
use super::tile::Tile;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Frame, MAX_DEPTH};
use crate::memory;
use crate::query::{Glance, Ray};
use crate::solid::{Classifier, Solid, WorkerOf};
use alloc::boxed::Box;
use glam::DVec3;

/// The surface of any solid within a universe: where lines of sight meet it to a quarter of a pixel. Normals are those of
/// slabs to 0.05 degrees where the solid knows slabs; elsewhere those of the plane through what is met and what is met half a
/// pixel beside it.
///
/// O(samples · cells along a line of sight · depth).
pub struct SolidLayer<'a, S> {
    solid: &'a S,
    frame: Frame,
    finish: Finish,
}

impl<'a, S: Solid> SolidLayer<'a, S> {
    /// What lies of a solid in the universe of a frame. A stored octree shows the cells that it has; for these an
    /// [`OctreeLayer`](crate::OctreeLayer) finds better normals.
    pub fn new(solid: &'a S, frame: &Frame, finish: Finish) -> SolidLayer<'a, S> {
        SolidLayer { solid, frame: *frame, finish }
    }

    /// How closely lines of sight look, and the frame whose cells are as fine.
    fn closely(&self, stage: &Stage<'_>) -> Result<(Glance, Frame), Error> {
        let view = stage.view;
        let share = 0.25 / f64::from(stage.grid);
        let pixel = |depth: f64| view.pixel_at(depth) * share;
        let growth = if view.is_perspective() { pixel(1.0) } else { 0.0 };
        let near = if view.is_perspective() { 0.0 } else { pixel(0.0) };
        // The nearest that the universe comes to the eye.
        let frame = &self.frame;
        let eye = DVec3::from(view.camera.eye());
        let (low, high) = (DVec3::from(frame.origin()), DVec3::from(frame.origin()) + frame.edge());
        let nearest = (eye.clamp(low, high) - eye).length().max(frame.edge() / 64.0);
        let fine = near + growth * nearest;
        let depth = (1..MAX_DEPTH).find(|&depth| frame.edge() / f64::from(1u32 << depth) <= fine);
        let glance = Glance { near, growth, cone: CONE };
        Ok((glance, frame.with_depth(depth.unwrap_or(MAX_DEPTH).max(frame.depth().min(8)))?))
    }
}

/// Radians by which the surface in a cell may turn.
const CONE: f64 = 0.05 * core::f64::consts::PI / 180.0;

impl<S: Solid> Draw for SolidLayer<'_, S> {
    fn prepare<'a>(&'a self, stage: &Stage<'a>) -> Result<Box<dyn Painter + 'a>, Error> {
        let (glance, frame) = self.closely(stage)?;
        let control = Control { progress: None, ..*stage.job.control() };
        let classifier = self.solid.on(&frame, &control)?;
        Ok(memory::boxed(SolidPainter::<S> { finish: self.finish, stage: *stage, classifier, glance })?)
    }
}

struct SolidPainter<'a, S: Solid> {
    finish: Finish,
    stage: Stage<'a>,
    classifier: S::Classifier,
    glance: Glance,
}

impl<S: Solid> Painter for SolidPainter<'_, S> {
    fn paint(&self, tile: &mut Tile<'_>) -> Result<(), Error> {
        let mut worker = self.classifier.worker()?;
        for y in 0..tile.height() {
            for x in 0..tile.width() {
                let Some((sight, ray)) = Sight::new(&self.stage, tile, [x, y]) else { continue };
                let Some((t, face)) = self.meets(&mut worker, &sight, &ray)? else { continue };
                let normal = if sight.begins_in(t, face) {
                    None
                } else if self.finish.faces || face.abs().max_element() < 1.0 {
                    // (A normal that is not an axis is a slab's.)
                    Some(face)
                } else {
                    Some(self.beside(&mut worker, tile, [x, y], sight.from + sight.along * t, face)?)
                };
                sight.draw(&self.finish, tile, t, normal)?;
            }
        }
        Ok(())
    }
}

impl<S: Solid> SolidPainter<'_, S> {
    fn meets(
        &self,
        worker: &mut WorkerOf<S>,
        sight: &Sight,
        ray: &Ray,
    ) -> Result<Option<(f64, DVec3)>, Error> {
        let glance = Glance { near: self.glance.near + self.glance.growth * sight.start, ..self.glance };
        let hit = glance.first(worker, ray, self.stage.job)?;
        Ok(hit.map(|hit| {
            let t = hit.t.lower.max(0.0);
            let middle = 0.5 * t + 0.5 * hit.t.upper;
            let is_known = middle - t <= 4.0 * (glance.near + glance.growth * t);
            (if is_known { middle } else { t }, DVec3::from(hit.normal))
        }))
    }

    /// The normal of the plane through a point of the surface and what is seen half a pixel beside it.
    fn beside(
        &self,
        worker: &mut WorkerOf<S>,
        tile: &Tile<'_>,
        [x, y]: [usize; 2],
        point: DVec3,
        face: DVec3,
    ) -> Result<DVec3, Error> {
        let [column, row] = tile.place(x, y);
        let mut find = |dx: f64, dy: f64| -> Result<Option<DVec3>, Error> {
            // Of both sides the one that differs less: the other may lie behind an edge.
            let mut nearest = None;
            for side in [-0.5, 0.5] {
                let (eye, along) = tile.view.line(column + dx * side, row + dy * side);
                let Some((sight, ray)) = Sight::along(&self.stage, eye, along) else { continue };
                let Some((t, _)) = self.meets(worker, &sight, &ray)? else { continue };
                let from = (sight.from + sight.along * t - point) * side.signum();
                if nearest.is_none_or(|other: DVec3| from.length_squared() < other.length_squared()) {
                    nearest = Some(from);
                }
            }
            Ok(nearest)
        };
        let (Some(across), Some(down)) = (find(1.0, 0.0)?, find(0.0, 1.0)?) else { return Ok(face) };
        // Rows go downward.
        Ok(down.cross(across).normalize_or_zero())
    }
}
