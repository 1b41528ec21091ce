//! Finished pictures.

use crate::error::Error;
use crate::memory;
use alloc::vec::Vec;

/// The greatest number of pixels in a row, and of rows.
const MOST_PIXELS: u32 = 1 << 14;

/// A picture: a colour and a depth for each pixel, row by row from the upper left corner.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) colours: Vec<[u8; 4]>,
    pub(super) depths: Vec<f32>,
}

impl Picture {
    /// Creates a picture from given colours, row by row from the upper left corner, without depths. Use it to
    /// draw a legend on the picture, or to write it.
    ///
    /// # Errors
    /// [`Error::Argument`] unless the sides (width and height) are 1 to 16384 pixels and there is one colour
    /// for each pixel; [`Error::OutOfMemory`].
    pub fn of_colours([width, height]: [u32; 2], colours: Vec<[u8; 4]>) -> Result<Picture, Error> {
        check_size([width, height])?;
        if colours.len() != width as usize * height as usize {
            return Err(Error::Argument { name: "colours", problem: "must be one for each pixel" });
        }
        let depths = memory::filled(colours.len(), f32::INFINITY)?;
        Ok(Picture { width, height, colours, depths })
    }

    /// Sets the depths, row by row from the upper left corner. Use it to reassemble a picture that was taken
    /// apart.
    ///
    /// # Errors
    /// [`Error::Argument`] unless there is one depth for each pixel.
    pub fn with_depths(self, depths: Vec<f32>) -> Result<Picture, Error> {
        if depths.len() == self.colours.len() {
            return Ok(Picture { depths, ..self });
        }
        Err(Error::Argument { name: "depths", problem: "must be one for each pixel" })
    }

    /// The number of pixels in a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// The number of rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Red, green, blue (sRGB) and opacity, 0 to 255; the colours are not multiplied by the opacity.
    pub fn colours(&self) -> &[[u8; 4]] {
        &self.colours
    }

    /// The distance from the plane of the eye to the nearest opaque surface, in model units; ∞ where there is
    /// none.
    pub fn depths(&self) -> &[f32] {
        &self.depths
    }

    /// The colours as bytes, four per pixel.
    pub fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.colours)
    }
}

/// Refuses an invalid width or height of a picture.
pub(super) fn check_size(sides: [u32; 2]) -> Result<(), Error> {
    if sides.iter().all(|side| (1..=MOST_PIXELS).contains(side)) {
        Ok(())
    } else {
        Err(Error::Argument { name: "size", problem: "must be 1 to 16384 pixels on each side" })
    }
}
