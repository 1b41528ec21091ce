//! Layers with clip planes of their own.

use super::Layer;
use super::clip::Clip;
use super::stage::{Draw, Painter, Stage};
use crate::error::Error;
use alloc::boxed::Box;

/// A layer with clip planes of its own, instead of those of the picture. Use it, for example, to cut surfaces
/// away and show the volume behind them.
pub struct ClippedLayer<'a> {
    layer: &'a dyn Layer,
    clip: Clip,
}

impl<'a> ClippedLayer<'a> {
    /// Creates a layer that shows the part of `layer` within a clip.
    pub fn new(layer: &'a dyn Layer, clip: Clip) -> ClippedLayer<'a> {
        ClippedLayer { layer, clip }
    }
}

impl Draw for ClippedLayer<'_> {
    fn prepare<'a>(&'a self, stage: &Stage<'a>) -> Result<Box<dyn Painter + 'a>, Error> {
        self.layer.prepare(&Stage { clip: &self.clip, ..*stage })
    }
}
