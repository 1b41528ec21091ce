//! Finished pictures.

use crate::error::Error;
use crate::memory;
use alloc::vec::Vec;

/// Most pixels of a row, and most rows.
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
    /// A picture of somebody else's colours, row by row from the upper left corner, without depths: to draw a
    /// legend on it, or to write it.
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

    /// The same picture with depths, row by row from the upper left corner: of one that was taken apart, and
    /// is put together again.
    ///
    /// # Errors
    /// [`Error::Argument`] unless there is one depth for each pixel.
    pub fn with_depths(self, depths: Vec<f32>) -> Result<Picture, Error> {
        if depths.len() == self.colours.len() {
            return Ok(Picture { depths, ..self });
        }
        Err(Error::Argument { name: "depths", problem: "must be one for each pixel" })
    }

    /// Pixels of a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Red, green, blue (sRGB) and opacity, 0 to 255; colours are not multiplied by the opacity.
    pub fn colours(&self) -> &[[u8; 4]] {
        &self.colours
    }

    /// The distance from the plane of the eye to what is nearest and opaque, in model units; ∞ where nothing
    /// is.
    pub fn depths(&self) -> &[f32] {
        &self.depths
    }

    /// The colours as bytes, four a pixel.
    pub fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.colours)
    }
}

/// Refuses a width and a height that no picture has.
pub(super) fn check_size(sides: [u32; 2]) -> Result<(), Error> {
    if sides.iter().all(|side| (1..=MOST_PIXELS).contains(side)) {
        Ok(())
    } else {
        Err(Error::Argument { name: "size", problem: "must be 1 to 16384 pixels on each side" })
    }
}
