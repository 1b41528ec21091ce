//! Compositing of translucent surfaces and voxels along a line of sight.

use super::coordinates::Coordinates;
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use crate::render::clip::Clip;
use crate::render::tile::{Fragment, Tile};
use crate::render::transfer::absorbed;
use alloc::vec::Vec;
use glam::DVec3;

/// The remaining share of the light at which samples count as opaque.
const DARK: f64 = 1e-7;

/// A line of sight, on which point + t · direction has the depth t, and the light that comes along it.
pub(super) struct LightPath {
    from: DVec3,
    /// One over each component of the direction.
    inverse: DVec3,
    /// Model units per unit of depth.
    stretch: f64,
    /// The depths between which something can be visible. Where nothing is visible any more, the end is −∞.
    start: f64,
    pub end: f64,
    /// The next translucent surface among all of the tile, its depth (∞ if there is none), and the number of
    /// surfaces that have been passed.
    fragment: usize,
    next: f64,
    pub passed: u32,
    /// The light so far (linear), and the share of the light behind that comes through.
    pub light: DVec3,
    pub through: f64,
}

/// The paths of a tile's samples, with the light that other layers have left. A clip cuts the paths off;
/// without one they are whole.
pub(super) fn light_paths(
    tile: &Tile<'_>,
    clip: Option<&Clip>,
    coordinates: &Coordinates,
) -> Result<Vec<LightPath>, Error> {
    let mut paths = memory::with_capacity(tile.opaque.len())?;
    let mut first = 0;
    for sample in 0..tile.opaque.len() {
        let (from, along) = tile.line(sample % tile.width(), sample / tile.width());
        let (mut start, mut end) = (0.0, f64::INFINITY);
        if let Some(clip) = clip.filter(|clip| !clip.is_empty()) {
            let shown = clip.shown(from, along);
            (start, end) = shown.map_or((0.0, f64::NEG_INFINITY), |shown| (shown.from, shown.to));
        }
        let before = tile.volume[sample].0.as_dvec4();
        let through = 1.0 - before.w;
        end = if through < DARK { f64::NEG_INFINITY } else { end.min(tile.opaque[sample].depth) };
        // The tile's list is sorted by sample.
        let of_sample = |fragment: &&Fragment| fragment.sample as usize == sample;
        let count = tile.fragments[first..].iter().take_while(of_sample).count();
        let fragment = first + (tile.passed[sample] as usize).min(count);
        first += count;
        let next = if fragment < first { tile.fragments[fragment].depth } else { f64::INFINITY };
        paths.push(LightPath {
            from: from - coordinates.origin,
            inverse: DVec3::from(along.to_array().each(inverse)),
            stretch: along.length(),
            start,
            end,
            fragment,
            next,
            passed: 0,
            light: before.truncate(),
            through,
        });
    }
    Ok(paths)
}

/// One over a component of a direction. A line in a plane between voxels belongs to the upper voxel: it
/// counts as rising, so slowly that it stays where it is.
fn inverse(component: f64) -> f64 {
    const LEAST: f64 = 1e-300;
    1.0 / if component.abs() < LEAST { LEAST } else { component }
}

impl LightPath {
    /// Returns whether something can be visible.
    pub fn is_open(&self) -> bool {
        self.start < self.end
    }

    /// The depths between which the path is in a box; the first is not before the start of the path.
    #[inline(always)]
    pub fn within(&self, [low, high]: [DVec3; 2]) -> [f64; 2] {
        let (a, b) = ((low - self.from) * self.inverse, (high - self.from) * self.inverse);
        [a.min(b).max_element().max(self.start), a.max(b).min_element()]
    }

    /// Composites a voxel behind the light so far, by the length of the path in it; surfaces divide the path.
    /// `depth` is the optical depth of a model unit. Returns whether nothing beyond the voxel is visible any
    /// more.
    #[inline(always)]
    pub fn cross(&mut self, [mut from, to]: [f64; 2], colour: DVec3, depth: f64, all: &[Fragment]) -> bool {
        let to = to.min(self.end);
        if from >= to {
            return false;
        }
        while self.next < to {
            if self.next > from {
                self.meet(colour, absorbed(depth * ((self.next - from) * self.stretch)));
                from = self.next;
            }
            self.pass(all);
        }
        self.meet(colour, absorbed(depth * ((to - from) * self.stretch)));
        self.close()
    }

    /// Composites a voxel behind the light so far, as one thing at the depth where the path enters it.
    /// Returns whether nothing beyond the voxel is visible any more.
    #[inline(always)]
    pub fn enter(&mut self, [from, to]: [f64; 2], colour: DVec3, opacity: f64, all: &[Fragment]) -> bool {
        if from >= to || from >= self.end {
            return false;
        }
        while self.next <= from {
            self.pass(all);
        }
        self.meet(colour, opacity);
        self.close()
    }

    /// Composites a colour with an opacity behind the light so far.
    #[inline(always)]
    fn meet(&mut self, colour: DVec3, opacity: f64) {
        self.light += colour * (self.through * opacity);
        self.through *= 1.0 - opacity;
    }

    /// Composites the next translucent surface behind the light so far.
    fn pass(&mut self, fragments: &[Fragment]) {
        let (now, next) = (&fragments[self.fragment], fragments.get(self.fragment + 1));
        let light = now.light.0.as_dvec4();
        self.light += light.truncate() * self.through;
        self.through *= 1.0 - light.w;
        (self.fragment, self.passed) = (self.fragment + 1, self.passed + 1);
        self.next = next.filter(|next| next.sample == now.sample).map_or(f64::INFINITY, |next| next.depth);
    }

    /// Ends the path if hardly any light comes through; returns whether it does.
    #[inline(always)]
    fn close(&mut self) -> bool {
        let is_dark = self.through < DARK;
        if is_dark {
            self.end = f64::NEG_INFINITY;
        }
        is_dark
    }
}
