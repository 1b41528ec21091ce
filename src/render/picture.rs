//! Finished pictures.

use alloc::vec::Vec;

/// A picture: a colour and a depth for each pixel, row by row from the upper left corner.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) colours: Vec<[u8; 4]>,
    pub(super) depths: Vec<f32>,
}

impl Picture {
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

    /// The distance from the plane of the eye to what is nearest and opaque, in model units; ∞ where nothing is.
    pub fn depths(&self) -> &[f32] {
        &self.depths
    }

    /// The colours as bytes, four a pixel.
    pub fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.colours)
    }
}
