//! From where a picture is taken.

use crate::error::Error;
use crate::lattice::Bounds;
use crate::lattice::valid::numbers;
use glam::DVec3;

/// How a camera shows what is farther away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lens {
    /// Smaller. The field of view in degrees, from the lower to the upper edge of the picture: above 0, below 180.
    Perspective(f64),
    /// As large as what is near. The height of what is seen, in model units.
    Parallel(f64),
}

/// A point from which one looks into a direction, and what is up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    lens: Lens,
}

/// Part of a fitted picture's width and height that is left free at each side.
const MARGIN: f64 = 0.04;

/// Field of view of a fitted camera, in degrees, unless another one is asked for.
pub const FIELD_OF_VIEW: f64 = 30.0;

impl Camera {
    /// A camera at `eye` that looks at the point `at`; `up`, of any length, is shown upward. Model units.
    ///
    /// # Errors
    /// [`Error::Argument`] if a number is not finite or beyond ±2^256, if eye and point are one, if `up` is zero or lies along
    /// the view, or if the lens is not as it must be.
    pub fn new(eye: [f64; 3], at: [f64; 3], up: [f64; 3], lens: Lens) -> Result<Camera, Error> {
        let [eye, at, up] = [("eye", eye), ("at", at), ("up", up)].map(|(name, v)| vector(name, v));
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

    /// A camera that shows all of a box in a picture of width : height = `aspect`, as large as can be with a small margin.
    /// It looks at the box from an azimuth and an elevation in degrees: 0, 0 is from −y with x to the right and z upward, a
    /// positive azimuth from further right, a positive elevation from further above. `field_of_view`: degrees, as in
    /// [`Lens::Perspective`]; `None` for a parallel lens.
    ///
    /// # Errors
    /// [`Error::Argument`] if a number is not finite, the field of view not between 0 and 180, or the aspect not above 0.
    pub fn fitted(
        bounds: &Bounds,
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
        let (sin, cos) = libm::sincos(azimuth.to_radians());
        let (rise, flat) = libm::sincos(elevation.to_radians());
        let right = DVec3::new(cos, sin, 0.0);
        let forward = DVec3::new(-sin * flat, cos * flat, -rise);
        let (min, max) = (DVec3::from(bounds.min), DVec3::from(bounds.max));
        let centre = 0.5 * min + 0.5 * max;
        // A point has no size to be fitted.
        let size = (max - min).length().max(centre.length() * 1e-9).max(f64::MIN_POSITIVE.sqrt());
        let camera = Camera::facing(centre, forward, right, lens);
        let corners = (0..8).map(|k| {
            let corner = DVec3::select(glam::BVec3::new(k & 1 != 0, k & 2 != 0, k & 4 != 0), max, min);
            camera.seen(corner)
        });
        let fill = 1.0 - 2.0 * MARGIN;
        Ok(match lens {
            Lens::Parallel(_) => {
                let half = corners.fold(0.0, |half: f64, at| half.max(at.y.abs()).max(at.x.abs() / aspect));
                let height = (2.0 * half / fill).max(size * 1e-9);
                Camera { eye: centre - forward * size, lens: Lens::Parallel(height), ..camera }
            }
            Lens::Perspective(_) => {
                let tangent = camera.half_height() * fill;
                let far = corners.fold(0.0, |far: f64, at| {
                    far.max(at.y.abs() / tangent - at.z).max(at.x.abs() / (tangent * aspect) - at.z)
                });
                Camera { eye: centre - forward * far.max(0.51 * size), ..camera }
            }
        })
    }

    fn facing(eye: DVec3, forward: DVec3, right: DVec3, lens: Lens) -> Camera {
        Camera { eye, right, up: right.cross(forward), forward, lens }
    }

    /// Where the camera is.
    pub fn eye(&self) -> [f64; 3] {
        self.eye.to_array()
    }

    /// The direction into which it looks; its length is 1.
    pub fn forward(&self) -> [f64; 3] {
        self.forward.to_array()
    }

    /// The direction to the right of the picture; its length is 1.
    pub fn right(&self) -> [f64; 3] {
        self.right.to_array()
    }

    /// The direction upward in the picture; its length is 1.
    pub fn up(&self) -> [f64; 3] {
        self.up.to_array()
    }

    /// How it shows what is farther away.
    pub fn lens(&self) -> Lens {
        self.lens
    }

    /// A point in the camera's own coordinates: to the right, upward, and away from the plane of the eye. Model units.
    #[inline]
    pub(crate) fn seen(&self, point: DVec3) -> DVec3 {
        let from = point - self.eye;
        DVec3::new(from.dot(self.right), from.dot(self.up), from.dot(self.forward))
    }

    /// Half of what is seen from the lower to the upper edge: a tangent, or model units.
    pub(crate) fn half_height(&self) -> f64 {
        match self.lens {
            Lens::Perspective(degrees) => libm::tan(0.5 * degrees.to_radians()),
            Lens::Parallel(height) => 0.5 * height,
        }
    }
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

/// A camera and the size of its picture: where a pixel looks, and where a point is seen.
#[derive(Debug, Clone, Copy)]
pub struct View {
    pub camera: Camera,
    pub width: u32,
    pub height: u32,
    /// Model units, or of a perspective tangents, to a pixel.
    pixel: f64,
}

impl View {
    pub fn new(camera: &Camera, [width, height]: [u32; 2]) -> View {
        View { camera: *camera, width, height, pixel: 2.0 * camera.half_height() / f64::from(height) }
    }

    /// Whether what is farther away is smaller.
    pub fn is_perspective(&self) -> bool {
        matches!(self.camera.lens, Lens::Perspective(_))
    }

    /// What is seen at a place of the picture, in pixels from its upper left corner: from where, and in which direction. The
    /// direction is 1 long along the view, so that what is t times it away has the depth t.
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

    /// Where a point in the camera's own coordinates is seen: place in pixels, and depth. Behind the eye of a perspective it
    /// is nowhere (infinite, or mirrored).
    #[inline]
    pub fn place(&self, seen: DVec3) -> [f64; 2] {
        let scale = if self.is_perspective() { 1.0 / (self.pixel * seen.z) } else { 1.0 / self.pixel };
        [0.5 * f64::from(self.width) + seen.x * scale, 0.5 * f64::from(self.height) - seen.y * scale]
    }

    /// Model units to a pixel at a depth.
    pub fn pixel_at(&self, depth: f64) -> f64 {
        if self.is_perspective() { self.pixel * depth } else { self.pixel }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn a_fitted_camera_shows_all_of_the_box() {
        let bounds = Bounds::new([1.0, -2.0, 5.0], [4.0, 7.0, 5.5]).unwrap();
        for aspect in [0.5, 1.0, 3.0] {
            for from in [[0.0, 0.0], [30.0, 20.0], [215.0, -80.0], [0.0, 90.0]] {
                for lens in [None, Some(30.0), Some(120.0)] {
                    let camera = Camera::fitted(&bounds, from, lens, aspect).unwrap();
                    let view = View::new(&camera, [(1000.0 * aspect) as u32, 1000]);
                    let mut least = [f64::INFINITY; 2];
                    for k in 0..8 {
                        let corner =
                            [0, 1, 2].map(|i| if k >> i & 1 == 0 { bounds.min[i] } else { bounds.max[i] });
                        let seen = camera.seen(DVec3::from(corner));
                        assert!(seen.z > 0.0);
                        let place = view.place(seen);
                        let size = [view.width, view.height].map(f64::from);
                        for axis in 0..2 {
                            let margin = place[axis].min(size[axis] - place[axis]) / size[axis];
                            least[axis] = least[axis].min(margin);
                        }
                    }
                    let margin = least[0].min(least[1]);
                    assert!(
                        margin > 0.039 && margin < 0.05 || lens == Some(120.0) && margin > 0.039,
                        "{least:?}"
                    );
                }
            }
        }
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
