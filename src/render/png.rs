//! Writer of PNG.

use super::picture::Picture;
use crate::error::Error;
use alloc::vec::Vec;
use png::{BitDepth, ColorType, Encoder, SrgbRenderingIntent};

/// Returns the colours of a picture as a PNG file: red, green and blue in sRGB, and opacity if any pixel is
/// not opaque. Equal pictures give equal bytes.
///
/// # Errors
/// [`Error::OutOfMemory`]. (If the encoder's own memory cannot be allocated, some hundred kilobytes and a
/// copy of the picture, the process ends.)
///
/// ```
/// use leafless::{Control, render::{Camera, Lens, Shot, render, write_png}};
/// let camera = Camera::new([0.0, -5.0, 0.0], [0.0; 3], [0.0, 0.0, 1.0], Lens::Perspective(30.0))?;
/// let picture = render(&Shot::new(camera, [64, 48]), &[], &Control::default())?;
/// assert!(write_png(&picture)?.starts_with(b"\x89PNG"));
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn write_png(picture: &Picture) -> Result<Vec<u8>, Error> {
    let is_opaque = picture.colours().iter().all(|colour| colour[3] == 255);
    let mut rows = Vec::new();
    let data = if is_opaque {
        rows.try_reserve_exact(3 * picture.colours().len())?;
        for &[r, g, b, _] in picture.colours() {
            rows.extend_from_slice(&[r, g, b]);
        }
        &rows[..]
    } else {
        picture.bytes()
    };
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, picture.width(), picture.height());
    encoder.set_color(if is_opaque { ColorType::Rgb } else { ColorType::Rgba });
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    // A vector accepts all bytes, and the format supports every picture size.
    let write = || -> Result<(), png::EncodingError> {
        let mut writer = encoder.write_header()?;
        writer.write_image_data(data)?;
        writer.finish()
    };
    write().map_err(|_| Error::OutOfMemory)?;
    Ok(bytes)
}
