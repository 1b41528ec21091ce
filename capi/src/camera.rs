//! Cameras: the viewpoints of pictures.

use super::boundary::{Failure, guard, out, slice};
use super::status::leafless_status;
use leafless::render::{Camera, Lens};

/// The viewpoint of a picture. leafless_camera_fitted sets all fields; a host may set them, too.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_camera {
    /// The position of the eye.
    pub eye_model: [f64; 3],
    /// A point that appears in the middle of the picture.
    pub at_model: [f64; 3],
    /// The direction that points up in the picture, of any length but 0; not along the view.
    pub up: [f64; 3],
    /// The field of view in degrees, from the lower to the upper edge of the picture: above 0, below 180, for
    /// a perspective view. 0 means a parallel view, which uses `height_model`.
    pub field_of_view_degrees: f64,
    /// For a parallel view, the visible height in model units; else ignored.
    pub height_model: f64,
}

/// Returns the field of view; 0 stands for none.
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

/// Makes a camera that shows all given points in a picture of width : height = `aspect`, as large as possible
/// with a small margin. Points may be the vertices of a mesh, or the eight corners of a bounding box. The
/// view direction is given by an azimuth and an elevation in degrees: 0, 0 is the view from -y with x to the
/// right and z up; a positive azimuth moves the eye to the right, a positive elevation moves it up.
///
/// - Buffers: `points_model`, 3 · `count` numbers; `camera`, one struct.
/// - Result: `*camera`. O(count).
/// - Errors: LEAFLESS_E_ARGUMENT if there is no point, a number is neither 0 nor of a magnitude between
///   2^-256 and 2^256, the field of view is neither 0 (a parallel view) nor between 0 and 180 degrees, or the
///   aspect is not above 0.
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
        // The eye is as far away as the points extend: a distance of 1 would be lost for large coordinates.
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
