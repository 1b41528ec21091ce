//! A small part of a picture while it is drawn.
//!
//! Each pixel has k × k samples on a grid. A sample has the nearest opaque surface, the translucent surfaces
//! in front of it, and the volumes before or between these. At the end everything is composited from front to
//! back.

use super::camera::View;
use super::light::Light;
use super::window::Window;
use crate::error::Error;
use crate::memory;
use alloc::vec::Vec;

/// The number of pixels of a tile along each axis.
pub const TILE: u32 = 32;

/// The opaque surface at a sample.
#[derive(Debug, Clone, Copy)]
pub struct Opaque {
    pub light: Light,
    /// The depth; ∞ if there is no surface.
    pub depth: f64,
}

/// A translucent surface.
#[derive(Debug, Clone, Copy)]
pub struct Fragment {
    pub sample: u32,
    /// The number in the order of drawing.
    order: u32,
    pub depth: f64,
    pub light: Light,
}

/// The samples of some pixels, and the surfaces and volumes at them.
pub struct Tile<'v> {
    window: Window<'v>,
    /// Row by row.
    pub opaque: Vec<Opaque>,
    /// Sorted by sample and, for each sample, by depth, after [`Tile::sort`] was called.
    pub fragments: Vec<Fragment>,
    /// The light and the opacity of volumes, in front of everything behind.
    pub volume: Vec<Light>,
    /// The number of fragments of each sample that [`Tile::volume`] already contains.
    pub passed: Vec<u32>,
}

impl<'v> core::ops::Deref for Tile<'v> {
    type Target = Window<'v>;

    #[inline(always)]
    fn deref(&self) -> &Window<'v> {
        &self.window
    }
}

impl<'v> Tile<'v> {
    pub fn new(view: &'v View, first: [u32; 2], size: [u32; 2], grid: u32) -> Result<Tile<'v>, Error> {
        let count = (size[0] * size[1] * grid * grid) as usize;
        Ok(Tile {
            window: Window { view, first, size, grid },
            opaque: memory::filled(count, Opaque { light: Light::NONE, depth: f64::INFINITY })?,
            fragments: Vec::new(),
            volume: memory::filled(count, Light::NONE)?,
            passed: memory::filled(count, 0)?,
        })
    }

    /// Draws a surface at a sample. An opaque surface hides everything farther away.
    #[inline]
    pub fn put(&mut self, sample: usize, depth: f64, light: Light) -> Result<(), Error> {
        let opaque = &mut self.opaque[sample];
        if depth >= opaque.depth || depth.is_nan() {
            return Ok(());
        }
        if light.0.w >= 1.0 {
            *opaque = Opaque { light, depth };
            return Ok(());
        }
        let order = self.fragments.len() as u32;
        memory::push(&mut self.fragments, Fragment { sample: sample as u32, order, depth, light })
    }

    /// Sorts the translucent surfaces; those of one depth stay in the order in which they were drawn. Call it
    /// after all surfaces are drawn, and before volumes are.
    pub fn sort(&mut self) {
        let opaque = &self.opaque;
        self.fragments.retain(|fragment| fragment.depth < opaque[fragment.sample as usize].depth);
        // (A stable sort would take memory that cannot be refused.)
        self.fragments.sort_unstable_by(|a, b| {
            a.sample.cmp(&b.sample).then(a.depth.total_cmp(&b.depth)).then(a.order.cmp(&b.order))
        });
    }

    /// The fragments of a sample.
    pub fn fragments_of(&self, sample: usize) -> &[Fragment] {
        let first = self.fragments.partition_point(|fragment| (fragment.sample as usize) < sample);
        let rest = &self.fragments[first..];
        let end = rest.partition_point(|fragment| fragment.sample as usize == sample);
        &rest[..end]
    }

    /// Composites the samples of each pixel, row by row.
    pub fn resolve(&self, background: Light, mut put: impl FnMut(Light, f64)) {
        let grid = self.grid as usize;
        let share = 1.0 / (grid * grid) as f32;
        for y in 0..self.size[1] {
            for x in 0..self.size[0] {
                let (mut light, mut depth) = (Light::NONE, f64::INFINITY);
                for row in 0..grid {
                    for column in 0..grid {
                        let sample = (y as usize * grid + row) * self.width() + x as usize * grid + column;
                        light = light + self.sample(sample, background) * share;
                        depth = depth.min(self.opaque[sample].depth);
                    }
                }
                put(light, depth);
            }
        }
    }

    fn sample(&self, sample: usize, background: Light) -> Light {
        let opaque = self.opaque[sample].light.over(background);
        let fragments = if self.fragments.is_empty() { &[] } else { self.fragments_of(sample) };
        let behind = &fragments[(self.passed[sample] as usize).min(fragments.len())..];
        let behind = behind.iter().rev().fold(opaque, |behind, fragment| fragment.light.over(behind));
        self.volume[sample].over(behind)
    }
}
