//! Lines of sight, and the light of the surfaces that they meet.

use super::camera::View;
use super::light::Light;
use super::outline::Outline;
use super::stage::Stage;
use super::window::Window;
use crate::lattice::Bounds;
use crate::lattice::Each;
use crate::query::Ray;
use glam::DVec3;

/// The appearance of surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finish {
    /// The colour in full light: red, green, blue (sRGB) and opacity, 0 to 255.
    pub colour: [u8; 4],
    /// The colour of parts that a clip plane cuts open.
    pub cut: [u8; 4],
    /// Shows cells by their faces, instead of the surface that they represent.
    pub faces: bool,
    /// The edges that are drawn, if any.
    pub edges: Option<Outline>,
}

impl Default for Finish {
    /// Opaque grey, orange on cuts.
    fn default() -> Finish {
        Finish { colour: [178, 187, 196, 255], cut: [213, 142, 74, 255], faces: false, edges: None }
    }
}

/// The distance that a line of sight keeps from clip planes and from the eye, as a part of the universe's
/// edge.
const ASIDE: f64 = 1e-9;

/// The least such distance, in roundings of the line's depth.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;

/// The distance before the universe at which a line of sight begins, as a part of the universe's edge.
const BEFORE: f64 = 1e-3;

/// A line of sight that begins where it is shown.
pub struct SightLine {
    /// The sample of the window to which the line belongs.
    pub sample: usize,
    pub from: DVec3,
    pub along: DVec3,
    /// The depth at which the line begins. If it begins at a clip plane, `entry` is the plane's outward
    /// normal.
    pub start: f64,
    /// The length of the line, in units of its direction.
    length: f64,
    entry: Option<DVec3>,
}

impl SightLine {
    /// The line of sight of a sample in a universe; `None` if nothing of it is shown.
    #[inline]
    pub fn new(
        stage: &Stage<'_>,
        window: &Window<'_>,
        [x, y]: [usize; 2],
        universe: &Bounds,
    ) -> Option<(SightLine, Ray)> {
        let (eye, along) = window.line(x, y);
        let shown = stage.clip.shown(eye, along)?;
        let (low, high) = (DVec3::from(universe.min), DVec3::from(universe.max));
        let unit = (high.x - low.x) / along.length();
        // Cells are closed: cells beyond a clip plane that only touch it must not be visible. With an eye in
        // a plane of the lattice, all lines of sight would begin on faces.
        let aside = |depth: f64| (ASIDE * unit).max(ROUNDINGS * depth);
        // Far from the universe a time would be too inexact for a place in it.
        let enters = (0..3).fold(0.0f64, |enters, axis| {
            let planes = [low[axis], high[axis]].each(|plane| (plane - eye[axis]) / along[axis]);
            // (A line parallel to the planes does not cross them.)
            if along[axis] == 0.0 { enters } else { enters.max(planes[0].min(planes[1])) }
        });
        let start = (shown.from + aside(shown.from)).max(enters - BEFORE * unit);
        let end = shown.to - aside(start);
        let from = eye + along * start;
        let sample = y * window.width() + x;
        let sight = SightLine { sample, from, along, start, length: end - start, entry: shown.entry };
        let ray = sight.beyond(0.0)?;
        Some((sight, ray))
    }

    /// The rest of the line after t times its direction; `None` if nothing is left.
    #[inline]
    pub fn beyond(&self, t: f64) -> Option<Ray> {
        // Components far below a rounding of the others only disturb.
        let plain = self.along.to_array().each(|c| if c.abs() < 1e-60 { 0.0 } else { c });
        let from = (self.from + self.along * t).to_array().each(|c| if c.abs() < 1e-60 { 0.0 } else { c });
        Ray::new(from, plain).and_then(|ray| ray.until(self.length - t)).ok()
    }

    /// The length of the line in units of its direction.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Returns whether the line begins inside the thing that it meets through this face after t times its
    /// direction.
    pub fn begins_in(&self, t: f64, face: DVec3) -> bool {
        t == 0.0 && face == DVec3::ZERO
    }

    /// The light of the surface that the line meets, given the outward normal there; `None` if the line
    /// begins inside.
    pub fn light(&self, finish: &Finish, view: &View, normal: Option<DVec3>) -> Light {
        let colour = if normal.is_some() { finish.colour } else { finish.cut };
        let facing = self.outward(normal);
        // (For a normal perpendicular to the line of sight, rounding would decide whether it faces the line.)
        let facing = if facing.dot(self.along) < 0.0 { facing } else { silhouette(facing, self.along) };
        Light::of(colour).lit(view.lamps.brightness(facing, -facing))
    }

    /// The normal, or, if the line begins inside, that of the plane that cuts the solid open.
    pub fn outward(&self, normal: Option<DVec3>) -> DVec3 {
        normal.or(self.entry).unwrap_or(-self.along)
    }
}

/// The silhouette normal nearest to a normal that seems to face away, although its surface is visible.
fn silhouette(normal: DVec3, along: DVec3) -> DVec3 {
    let across = normal - along * (normal.dot(along) / along.length_squared());
    across.try_normalize().unwrap_or(-along)
}
