//! A small part of a picture while it is drawn.
//!
//! Each pixel has k × k samples on a grid. A sample has the nearest opaque surface, the translucent ones
//! before it, and what volumes before or between these let through. In the end all is put together from front
//! to back.

use super::camera::View;
use super::light::Light;
use super::window::Window;
use crate::error::Error;
use crate::memory;
use alloc::vec::Vec;

/// Pixels of a tile along each axis.
pub const TILE: u32 = 32;

/// What is seen at a sample: opaque.
#[derive(Debug, Clone, Copy)]
pub struct Opaque {
    pub light: Light,
    /// ∞ if nothing is.
    pub depth: f64,
}

/// A translucent surface.
#[derive(Debug, Clone, Copy)]
pub struct Fragment {
    pub sample: u32,
    /// The number with which it was drawn.
    order: u32,
    pub depth: f64,
    pub light: Light,
}

/// The samples of some pixels, and what is seen at them.
pub struct Tile<'v> {
    window: Window<'v>,
    /// Row by row.
    pub opaque: Vec<Opaque>,
    /// By sample, and those of a sample by depth, once [`Tile::sort`] was called.
    pub fragments: Vec<Fragment>,
    /// What volumes show, in front of what is behind: their light, and how opaque they are.
    pub volume: Vec<Light>,
    /// How many fragments of each sample are in [`Tile::volume`] already.
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

    /// Draws a surface at a sample: hides what is farther away if it is opaque.
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

    /// Puts the translucent surfaces in order; those of one depth stay in the order in which they were drawn.
    /// Call it once all surfaces are drawn, before volumes are.
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

    /// Puts the samples of each pixel together, row by row.
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
