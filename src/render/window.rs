//! A part of a picture, and the lines of sight of its samples.

use super::camera::View;
use crate::lattice::Each;
use glam::DVec3;

/// The samples of some pixels.
#[derive(Debug, Clone, Copy)]
pub struct Window<'v> {
    pub view: &'v View,
    /// The first pixel, and the number of pixels.
    pub first: [u32; 2],
    pub size: [u32; 2],
    /// Samples of a pixel along each axis.
    pub grid: u32,
}

impl<'v> Window<'v> {
    /// The window with some more pixels on each side, up to the borders of the picture.
    pub fn widened(&self, pixels: u32) -> Window<'v> {
        let whole = [self.view.width, self.view.height];
        let first = self.first.each(|first| first.saturating_sub(pixels));
        let end = [0, 1].each(|k| (self.first[k] + self.size[k] + pixels).min(whole[k]));
        Window { first, size: [end[0] - first[0], end[1] - first[1]], ..*self }
    }

    /// The number of samples in a row.
    #[inline(always)]
    pub fn width(&self) -> usize {
        (self.size[0] * self.grid) as usize
    }

    /// The number of rows of samples.
    #[inline(always)]
    pub fn height(&self) -> usize {
        (self.size[1] * self.grid) as usize
    }

    /// The place of the sample (column, row) of the tile in the picture, in pixels.
    #[inline(always)]
    pub fn place(&self, column: usize, row: usize) -> [f64; 2] {
        let step = 1.0 / f64::from(self.grid);
        [
            f64::from(self.first[0]) + (column as f64 + 0.5) * step,
            f64::from(self.first[1]) + (row as f64 + 0.5) * step,
        ]
    }

    /// The samples that lie between two places along x (axis 0) or y (1), in pixels, as columns or rows of
    /// the tile.
    #[inline]
    pub fn between(&self, axis: usize, low: f64, high: f64) -> core::ops::Range<usize> {
        let grid = f64::from(self.grid);
        let index = |x: f64| (x - f64::from(self.first[axis])) * grid - 0.5;
        let count = f64::from(self.size[axis] * self.grid);
        // (NaN counts as far away.)
        let first = libm::ceil(index(low)).max(0.0).min(count) as usize;
        let end = (libm::floor(index(high)) + 1.0).max(0.0).min(count) as usize;
        first..end.max(first)
    }

    /// The line of sight of a sample.
    #[inline]
    pub fn line(&self, column: usize, row: usize) -> (DVec3, DVec3) {
        let [x, y] = self.place(column, row);
        self.view.line(x, y)
    }

    /// The line of sight of a sample that may lie beside the window.
    pub fn line_at(&self, [column, row]: [i32; 2]) -> (DVec3, DVec3) {
        let place = |axis: usize, sample: i32| {
            f64::from(self.first[axis]) + (f64::from(sample) + 0.5) / f64::from(self.grid)
        };
        self.view.line(place(0, column), place(1, row))
    }
}
