//! Cameras and views.

use super::light::Lamps;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::Frame;
use crate::lattice::valid::numbers;
use glam::DVec3;

/// The projection of a camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lens {
    /// A perspective: distant things look smaller. The field of view in degrees, from the lower to the upper
    /// edge of the picture: above 0, below 180.
    Perspective(f64),
    /// A parallel projection: distant things look as large as near ones. The height of the visible part, in
    /// model units.
    Parallel(f64),
}

/// A camera: an eye point, a direction of view, and an upward direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    lens: Lens,
}

/// The part of a fitted picture's width and height that is left free on each side.
const MARGIN: f64 = 0.04;

/// The default field of view of a fitted camera, in degrees.
pub const FIELD_OF_VIEW: f64 = 30.0;

impl Camera {
    /// Creates a camera at `eye` that looks at the point `at`; `up`, of any length, is shown upward. Model
    /// units.
    ///
    /// # Errors
    /// [`Error::Argument`] if a number is not zero and not between 2^-256 and 2^256 in magnitude, if `eye`
    /// and `at` are the same point, if `up` is zero or parallel to the view, or if the lens is invalid.
    pub fn new(eye: [f64; 3], at: [f64; 3], up: [f64; 3], lens: Lens) -> Result<Camera, Error> {
        let [eye, at, up] = [("eye", eye), ("at", at), ("up", up)].each(|(name, v)| vector(name, v));
        let (eye, at, up) = (eye?, at?, up?);
        check(lens)?;
        let refused = |name, problem| Error::Argument { name, problem };
        let forward = (at - eye).try_normalize().ok_or(refused("at", "must not be the eye"))?;
        let up = up.try_normalize().ok_or(refused("up", "must not be zero"))?;
        let right = forward.cross(up);
        if right.length() < 1e-9 {
            return Err(refused("up", "must not lie along the view"));
        }
        Ok(Camera::facing(eye, forward, right.normalize(), lens))
    }

    /// Creates a camera that shows one or more points (model units) in a picture of width : height =
    /// `aspect`, as large as possible with a small margin. It looks at them from an azimuth and an elevation
    /// in degrees: 0, 0 is from −y with x to the right and z upward; a positive azimuth is further to the
    /// right, a positive elevation further above. `field_of_view`: degrees, as in [`Lens::Perspective`];
    /// `None` for a parallel lens. O(points).
    ///
    /// # Errors
    /// [`Error::Argument`] if there is no point, a number is not zero and not between 2^-256 and 2^256 in
    /// magnitude, the field of view is not between 0 and 180, or the aspect is not above 0.
    pub fn fitted(
        points: &[[f64; 3]],
        [azimuth, elevation]: [f64; 2],
        field_of_view: Option<f64>,
        aspect: f64,
    ) -> Result<Camera, Error> {
        numbers("from", &[azimuth, elevation])?;
        let aspect_is_good = aspect > 0.0 && aspect.is_finite();
        if !aspect_is_good {
            return Err(Error::Argument { name: "aspect", problem: "must be above 0" });
        }
        let lens = field_of_view.map_or(Lens::Parallel(1.0), Lens::Perspective);
        check(lens)?;
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for point in points {
            numbers("points", point)?;
            (min, max) = (min.min(DVec3::from(*point)), max.max(DVec3::from(*point)));
        }
        if points.is_empty() {
            return Err(Error::Argument { name: "points", problem: "at least one is needed" });
        }
        let (sin, cos) = libm::sincos(azimuth.to_radians());
        let (rise, flat) = libm::sincos(elevation.to_radians());
        let right = DVec3::new(cos, sin, 0.0);
        let forward = DVec3::new(-sin * flat, cos * flat, -rise);
        let centre = 0.5 * min + 0.5 * max;
        // A single point has no size to fit.
        let size = (max - min).length().max(centre.length() * 1e-9).max(1e-60);
        let mut camera = Camera::facing(centre, forward, right, lens);
        let seen = |camera: &Camera| {
            let camera = *camera;
            points.iter().map(move |&point| camera.seen(DVec3::from(point)))
        };
        let fill = 1.0 - 2.0 * MARGIN;
        let tangent = camera.half_height() * fill;
        match lens {
            Lens::Parallel(_) => {
                let (low, high) = extremes(seen(&camera));
                let half = 0.5 * (high - low);
                let height = 2.0 * half.y.max(half.x / aspect) / fill;
                let middle = 0.5 * (low + high);
                camera.eye += right * middle.x + camera.up * middle.y - forward * size;
                camera.lens = Lens::Parallel(height.max(size * 1e-9));
            }
            Lens::Perspective(_) => {
                // The eye lies where the wedges from left and right, and those from above and below, just
                // contain all points.
                let [wide, high] = [(tangent * aspect, 0), (tangent, 1)].each(|(tangent, axis)| {
                    let sides = seen(&camera).fold([f64::NEG_INFINITY; 2], |sides, at| {
                        let (across, deep) = (at[axis] / tangent, at.z);
                        [sides[0].max(-across - deep), sides[1].max(across - deep)]
                    });
                    // Across by x, back by y: y + x ≥ sides[0], y − x ≥ sides[1], in units of the tangent.
                    (0.5 * (sides[1] - sides[0]) * tangent, 0.5 * (sides[0] + sides[1]))
                });
                let nearest = seen(&camera).fold(f64::INFINITY, |nearest, at| nearest.min(at.z));
                let back = wide.1.max(high.1).max(0.01 * size - nearest);
                camera.eye += right * wide.0 + camera.up * high.0 - forward * back;
            }
        }
        Ok(camera)
    }

    fn facing(eye: DVec3, forward: DVec3, right: DVec3, lens: Lens) -> Camera {
        Camera { eye, right, up: right.cross(forward), forward, lens }
    }

    /// The place of the eye.
    pub fn eye(&self) -> [f64; 3] {
        self.eye.to_array()
    }

    /// The direction of view, of length 1.
    pub fn forward(&self) -> [f64; 3] {
        self.forward.to_array()
    }

    /// The direction to the right of the picture, of length 1.
    pub fn right(&self) -> [f64; 3] {
        self.right.to_array()
    }

    /// The upward direction of the picture, of length 1.
    pub fn up(&self) -> [f64; 3] {
        self.up.to_array()
    }

    /// The projection of the camera.
    pub fn lens(&self) -> Lens {
        self.lens
    }

    /// Returns a point in the camera's own coordinates: to the right, upward, and away from the plane of the
    /// eye. Model units.
    #[inline]
    pub(crate) fn seen(&self, point: DVec3) -> DVec3 {
        let from = point - self.eye;
        DVec3::new(from.dot(self.right), from.dot(self.up), from.dot(self.forward))
    }

    /// Half the height of the visible part, from the lower to the upper edge: a tangent, or model units.
    pub(crate) fn half_height(&self) -> f64 {
        match self.lens {
            Lens::Perspective(degrees) => libm::tan(0.5 * degrees.to_radians()),
            Lens::Parallel(height) => 0.5 * height,
        }
    }
}

fn extremes(points: impl Iterator<Item = DVec3>) -> (DVec3, DVec3) {
    points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)))
}

fn vector(name: &'static str, v: [f64; 3]) -> Result<DVec3, Error> {
    numbers(name, &v)?;
    Ok(DVec3::from(v))
}

fn check(lens: Lens) -> Result<(), Error> {
    let (good, problem) = match lens {
        Lens::Perspective(degrees) => {
            (degrees > 0.0 && degrees < 180.0, "a field of view must lie between 0 and 180 degrees")
        }
        Lens::Parallel(height) => (height > 0.0 && height.is_finite(), "a height must be above 0 and finite"),
    };
    if good { Ok(()) } else { Err(Error::Argument { name: "lens", problem }) }
}

/// A camera and the size of its picture. Maps pixels to lines of sight, and points to pixels.
#[derive(Debug, Clone, Copy)]
pub struct View {
    pub camera: Camera,
    pub lamps: Lamps,
    pub width: u32,
    pub height: u32,
    /// The size of a pixel: model units, or tangents for a perspective.
    pixel: f64,
}

impl View {
    pub fn new(camera: &Camera, [width, height]: [u32; 2]) -> View {
        let lamps = Lamps::new(camera.right, camera.up, camera.forward);
        View { camera: *camera, lamps, width, height, pixel: 2.0 * camera.half_height() / f64::from(height) }
    }

    /// Returns whether the projection is a perspective.
    pub fn is_perspective(&self) -> bool {
        matches!(self.camera.lens, Lens::Perspective(_))
    }

    /// Returns the line of sight at a place of the picture, in pixels from its upper left corner: its start
    /// and its direction. The direction has length 1 along the view, so a point at t times the direction has
    /// the depth t.
    #[inline]
    pub fn line(&self, x: f64, y: f64) -> (DVec3, DVec3) {
        let camera = &self.camera;
        let across = camera.right * ((x - 0.5 * f64::from(self.width)) * self.pixel)
            + camera.up * ((0.5 * f64::from(self.height) - y) * self.pixel);
        match camera.lens {
            Lens::Perspective(_) => (camera.eye, camera.forward + across),
            Lens::Parallel(_) => (camera.eye + across, camera.forward),
        }
    }

    /// Returns the place of a point in the picture, in pixels. The point is given in the camera's own
    /// coordinates. A point behind the eye of a perspective has no place (infinite, or mirrored).
    #[inline]
    pub fn place(&self, seen: DVec3) -> [f64; 2] {
        let scale = if self.is_perspective() { 1.0 / (self.pixel * seen.z) } else { 1.0 / self.pixel };
        [0.5 * f64::from(self.width) + seen.x * scale, 0.5 * f64::from(self.height) - seen.y * scale]
    }

    /// The distance of a frame's universe from the eye, in model units; at least a sixteenth of the
    /// universe's edge.
    pub fn nearest(&self, frame: &Frame) -> f64 {
        let (eye, low) = (self.camera.eye, DVec3::from(frame.origin()));
        (eye.clamp(low, low + frame.edge()) - eye).length().max(frame.edge() / 16.0)
    }

    /// The size of a pixel at a depth, in model units.
    pub fn pixel_at(&self, depth: f64) -> f64 {
        if self.is_perspective() { self.pixel * depth } else { self.pixel }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec::Vec;

    #[test]
    fn places_and_lines_are_inverse() {
        let lenses = [Lens::Perspective(40.0), Lens::Parallel(3.0)];
        for lens in lenses {
            let camera = Camera::new([3.0, -4.0, 2.0], [0.1, 0.2, -0.3], [0.0, 0.2, 1.0], lens).unwrap();
            let view = View::new(&camera, [640, 480]);
            for (x, y, t) in [(0.0, 0.0, 1.0), (320.0, 240.0, 5.0), (639.5, 100.25, 17.0)] {
                let (from, along) = view.line(x, y);
                let seen = camera.seen(from + along * t);
                let [u, v] = view.place(seen);
                assert!((u - x).abs() < 1e-9 && (v - y).abs() < 1e-9 && (seen.z - t).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_fitted_camera_shows_all_points_as_large_as_can_be() {
        let points: Vec<[f64; 3]> = (0..50)
            .map(|i| [0.37, 0.71, 0.13].map(|step| 5.0 * (f64::from(i) * step).fract()))
            .map(|[x, y, z]| [x + 3.0, 2.0 * y, z - 1.0])
            .collect();
        for aspect in [0.5, 1.0, 3.0] {
            for from in [[0.0, 0.0], [30.0, 20.0], [215.0, -80.0], [0.0, 90.0]] {
                for lens in [None, Some(30.0), Some(120.0)] {
                    let camera = Camera::fitted(&points, from, lens, aspect).unwrap();
                    let view = View::new(&camera, [(1000.0 * aspect) as u32, 1000]);
                    let size = [view.width, view.height].map(f64::from);
                    let mut margins = [[f64::INFINITY; 2]; 2];
                    for &point in &points {
                        let seen = camera.seen(DVec3::from(point));
                        assert!(seen.z > 0.0);
                        let place = view.place(seen);
                        for axis in 0..2 {
                            margins[axis][0] = margins[axis][0].min(place[axis] / size[axis]);
                            margins[axis][1] = margins[axis][1].min(1.0 - place[axis] / size[axis]);
                        }
                    }
                    let least = margins.iter().flatten().fold(1.0f64, |least, margin| least.min(*margin));
                    assert!(least > 0.0399, "{margins:?}");
                    // Both sides of one axis are as near as allowed, unless a point would come too near to
                    // the eye.
                    let tight = |[low, high]: [f64; 2]| low < 0.0401 && high < 0.0401;
                    assert!(lens == Some(120.0) || margins.iter().any(|&sides| tight(sides)), "{margins:?}");
                }
            }
        }
        let point = Camera::fitted(&[[1.0, 2.0, 3.0]], [0.0, 0.0], Some(30.0), 1.0).unwrap();
        assert!(point.seen(DVec3::new(1.0, 2.0, 3.0)).z > 0.0);
        assert!(Camera::fitted(&[], [0.0, 0.0], None, 1.0).is_err());
        assert!(Camera::fitted(&[[f64::NAN; 3]], [0.0, 0.0], None, 1.0).is_err());
        assert!(Camera::fitted(&points, [0.0, 0.0], None, 0.0).is_err());
    }

    #[test]
    fn what_is_no_camera_is_refused() {
        let new = |eye, at, up, lens| Camera::new(eye, at, up, lens).is_err();
        let (o, z, lens) = ([0.0; 3], [0.0, 0.0, 1.0], Lens::Perspective(30.0));
        assert!(new(o, o, z, lens) && new(o, z, z, lens) && new(o, z, o, lens));
        assert!(
            new([f64::NAN, 0.0, 0.0], o, z, lens) && new(z, o, [0.0, 1.0, 0.0], Lens::Perspective(180.0))
        );
        assert!(
            new(z, o, [0.0, 1.0, 0.0], Lens::Parallel(0.0))
                && new(z, o, [0.0, 1.0, 0.0], Lens::Parallel(f64::NAN))
        );
        assert!(!new(z, o, [0.0, 1.0, 0.0], lens));
    }
}
