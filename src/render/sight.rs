//! Lines of sight, and how what they meet is drawn.

use super::camera::View;
use super::light::Light;
use super::outline::Outline;
use super::stage::Stage;
use super::window::Window;
use crate::lattice::Bounds;
use crate::query::Ray;
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
    /// The edges that are drawn, if any are.
    pub edges: Option<Outline>,
}

impl Default for Finish {
    /// Opaque grey, orange where it is cut.
    fn default() -> Finish {
        Finish { colour: [178, 187, 196, 255], cut: [213, 142, 74, 255], faces: false, edges: None }
    }
}

/// Part of the universe's edge by which a line of sight keeps away from clip planes and from the eye.
const ASIDE: f64 = 1e-9;

/// Roundings of its depth by which it does at least.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;

/// Part of the universe's edge by which a line of sight begins before it enters the universe.
const BEFORE: f64 = 1e-3;

/// A line of sight that begins where it is shown.
pub struct SightLine {
    /// The sample of the window that it belongs to.
    pub sample: usize,
    pub from: DVec3,
    pub along: DVec3,
    /// The depth at which it begins, and the outward normal of the clip plane there.
    pub start: f64,
    /// Where it ends.
    length: f64,
    entry: Option<DVec3>,
}

impl SightLine {
    /// That of a sample in a universe; `None` if nothing of it is shown.
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
        // Cells are closed: those beyond a clip plane that only touch it are not seen. An eye in a plane of
        // the lattice would have all lines of sight begin on faces.
        let aside = |depth: f64| (ASIDE * unit).max(ROUNDINGS * depth);
        // Far from the universe a time would say little of a place in it.
        let enters = (0..3).fold(0.0f64, |enters, axis| {
            let planes = [low[axis], high[axis]].map(|plane| (plane - eye[axis]) / along[axis]);
            // (A line along the planes says nothing.)
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

    /// The rest of it after t times its direction; `None` if that is nothing.
    #[inline]
    pub fn beyond(&self, t: f64) -> Option<Ray> {
        // Components far below a rounding of the others only get in the way.
        let plain = self.along.to_array().map(|c| if c.abs() < 1e-60 { 0.0 } else { c });
        let from = (self.from + self.along * t).to_array().map(|c| if c.abs() < 1e-60 { 0.0 } else { c });
        Ray::new(from, plain).and_then(|ray| ray.until(self.length - t)).ok()
    }

    /// After how many times its direction it ends.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Whether it begins in what it meets by such a face after t times its direction.
    pub fn begins_in(&self, t: f64, face: DVec3) -> bool {
        t == 0.0 && face == DVec3::ZERO
    }

    /// The light of what it meets, given the outward normal there; `None` if it begins in it.
    pub fn light(&self, finish: &Finish, view: &View, normal: Option<DVec3>) -> Light {
        let colour = if normal.is_some() { finish.colour } else { finish.cut };
        let facing = self.outward(normal);
        // (What is perpendicular to the line of sight would face it or not as it is rounded.)
        let facing = if facing.dot(self.along) < 0.0 { facing } else { silhouette(facing, self.along) };
        Light::of(colour).lit(view.lamps.brightness(facing, -facing))
    }

    /// A normal, or where it begins inside that of what cuts it open.
    pub fn outward(&self, normal: Option<DVec3>) -> DVec3 {
        normal.or(self.entry).unwrap_or(-self.along)
    }
}

/// The normal nearest to one that seems to face away, though it is seen: that of a silhouette.
fn silhouette(normal: DVec3, along: DVec3) -> DVec3 {
    let across = normal - along * (normal.dot(along) / along.length_squared());
    across.try_normalize().unwrap_or(-along)
}
