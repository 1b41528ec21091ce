//! What layers know of the picture, and what they do.

use super::camera::View;
use super::clip::Clip;
use super::tile::Tile;
use crate::control::Job;
use crate::error::Error;
use alloc::boxed::Box;

/// Colours of values: red, green, blue (sRGB) and opacity.
pub type Colouring<'a> = &'a (dyn Fn(Option<[f64; 4]>) -> [u8; 4] + Sync);

/// What layers know of the picture.
#[derive(Clone, Copy)]
pub struct Stage<'a> {
    pub(crate) view: &'a View,
    pub(crate) clip: &'a Clip,
    pub(crate) job: &'a Job<'a>,
}

/// What a layer does.
pub trait Draw {
    /// Makes ready what all tiles need.
    ///
    /// # Errors
    /// The layer's own.
    fn prepare<'a>(&'a self, stage: &Stage<'a>) -> Result<Box<dyn Painter + 'a>, Error>;
}

/// Something that can be drawn.
pub trait Layer: Sync + Draw {}

impl<T: Sync + Draw> Layer for T {}

/// When a layer is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pass {
    /// With the surfaces.
    Surfaces,
    /// Once all surfaces are there.
    Volumes,
}

/// A layer that is ready to draw.
pub trait Painter: Sync {
    /// When it draws.
    fn pass(&self) -> Pass {
        Pass::Surfaces
    }

    /// Draws what it shows of a tile.
    ///
    /// # Errors
    /// The layer's own.
    fn paint(&self, tile: &mut Tile<'_>) -> Result<(), Error>;
}

/// What an allocation that may fail makes of one.
impl<P: Painter> Painter for [P; 1] {
    fn pass(&self) -> Pass {
        self[0].pass()
    }

    fn paint(&self, tile: &mut Tile<'_>) -> Result<(), Error> {
        self[0].paint(tile)
    }
}
