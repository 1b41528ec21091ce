//! Cameras: from where a picture is taken.

use super::boundary::{Failure, guard, out, slice};
use super::status::leafless_status;
use leafless::render::{Camera, Lens};

/// From where a picture is taken. leafless_camera_fitted sets all of it; a host may as well.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_camera {
    /// The point from which one looks.
    pub eye_model: [f64; 3],
    /// A point at which one looks, in the middle of the picture.
    pub at_model: [f64; 3],
    /// The direction that is shown upward, of any length but 0; not along the view.
    pub up: [f64; 3],
    /// The field of view in degrees, from the lower to the upper edge of the picture: above 0, below 180.
    /// What is farther away looks smaller. 0: parallel lines stay parallel, and `height_model` counts.
    pub field_of_view_degrees: f64,
    /// With parallel lines the height of what is seen; else not read.
    pub height_model: f64,
}

/// A field of view of 0 stands for none.
fn field_of_view(degrees: f64) -> Option<f64> {
    (degrees != 0.0).then_some(degrees)
}

impl leafless_camera {
    pub(super) fn check(&self) -> Result<Camera, Failure> {
        let lens = field_of_view(self.field_of_view_degrees)
            .map_or(Lens::Parallel(self.height_model), Lens::Perspective);
        Ok(Camera::new(self.eye_model, self.at_model, self.up, lens)?)
    }
}

/// A camera that shows all of some points in a picture of width : height = `aspect`, as large as can be with
/// a small margin. Points may be the vertices of a mesh, or the eight corners of a bounding box. It looks at
/// them from an azimuth and an elevation in degrees: 0, 0 is from -y with x to the right and z upward, a
/// positive azimuth from further right, a positive elevation from further above.
///
/// - Buffers: `points_model`, 3 · `count` numbers; `camera`, one struct.
/// - Result: `*camera`. O(count).
/// - Errors: LEAFLESS_E_ARGUMENT if there is no point, a number is not zero and not between 2^-256 and 2^256
///   in magnitude, the field of view neither 0 (parallel lines stay parallel) nor between 0 and 180 degrees,
///   or the aspect not above 0.
/// - Untrusted input: any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_camera_fitted(
    points_model: *const f64,
    count: u64,
    azimuth_degrees: f64,
    elevation_degrees: f64,
    field_of_view_degrees: f64,
    aspect: f64,
    camera: *mut leafless_camera,
) -> leafless_status {
    guard(|| unsafe {
        let points: &[[f64; 3]] = slice(points_model.cast(), count, "points_model")?;
        let camera = out(camera, "camera")?;
        let field_of_view = field_of_view(field_of_view_degrees);
        let found = Camera::fitted(points, [azimuth_degrees, elevation_degrees], field_of_view, aspect)?;
        let (eye, forward) = (found.eye(), found.forward());
        // As far away as the points are: a distance of 1 would be lost where coordinates are large.
        let depths =
            points.iter().map(|point| (0..3).map(|axis| (point[axis] - eye[axis]) * forward[axis]).sum());
        let distance = depths.fold(0.0, f64::max);
        camera.write(leafless_camera {
            eye_model: eye,
            at_model: [0, 1, 2].map(|axis| eye[axis] + forward[axis] * distance),
            up: found.up(),
            field_of_view_degrees,
            height_model: match found.lens() {
                Lens::Parallel(height) => height,
                Lens::Perspective(_) => 0.0,
            },
        })
    })
}
