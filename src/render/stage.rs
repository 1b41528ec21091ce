//! The interface between layers and pictures.

use super::camera::View;
use super::clip::Clip;
use super::tile::Tile;
use crate::control::Job;
use crate::error::Error;
use alloc::boxed::Box;

/// Colours of values: red, green, blue (sRGB) and opacity.
pub type Colouring<'a> = &'a (dyn Fn(Option<[f64; 4]>) -> [u8; 4] + Sync);

/// The data of a picture that layers use.
#[derive(Clone, Copy)]
pub struct Stage<'a> {
    pub(crate) view: &'a View,
    pub(crate) clip: &'a Clip,
    pub(crate) job: &'a Job<'a>,
}

/// The drawing interface of a layer.
pub trait Draw {
    /// Prepares the data that all tiles need.
    ///
    /// # Errors
    /// The errors of the layer.
    fn prepare<'a>(&'a self, stage: &Stage<'a>) -> Result<Box<dyn Painter + 'a>, Error>;
}

/// Something that can be drawn.
pub trait Layer: Sync + Draw {}

impl<T: Sync + Draw> Layer for T {}

/// The pass in which a layer is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pass {
    /// Drawn together with the surfaces.
    Surfaces,
    /// Drawn after all surfaces.
    Volumes,
}

/// A layer that is ready to draw.
pub trait Painter: Sync {
    /// Returns the pass in which the layer is drawn.
    fn pass(&self) -> Pass {
        Pass::Surfaces
    }

    /// Draws the layer's part of a tile.
    ///
    /// # Errors
    /// The errors of the layer.
    fn paint(&self, tile: &mut Tile<'_>) -> Result<(), Error>;
}

/// A fallible allocation returns a box of an array.
impl<P: Painter> Painter for [P; 1] {
    fn pass(&self) -> Pass {
        self[0].pass()
    }

    fn paint(&self, tile: &mut Tile<'_>) -> Result<(), Error> {
        self[0].paint(tile)
    }
}
