//! Straight lines in space, drawn a few pixels wide.

use super::bins::Bins;
use super::camera::View;
use super::light::Light;
use super::stage::Stage;
use super::tile::Tile;
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use alloc::vec::Vec;
use glam::{DVec2, DVec3};

/// The nearest part of a line that is drawn, as a part of its farthest depth. Nearer parts lie far beside the
/// picture.
const NEAREST: f64 = 1e-9;

/// The shift of samples, in pixels. With it, a line whose width is a whole number of pixels and that runs
/// between samples covers that number of pixels, not one more.
const NUDGE: DVec2 = DVec2::new(1e-6, 2e-6);

/// An end of a line: its place in pixels, and its depth (or one over its depth under a perspective).
#[derive(Clone, Copy)]
struct End {
    place: DVec2,
    depth: f64,
}

/// A line in the picture, and its part of the colour's opacity.
#[derive(Clone, Copy)]
struct Line {
    ends: [End; 2],
    opacity: f32,
}

/// Lines in space that are ready to be drawn. A line on a surface is visible, because it counts as nearer
/// than it is by its width and a pixel.
pub struct Strokes {
    lines: Vec<Line>,
    bins: Bins,
    /// In pixels.
    half_width: f64,
    light: Light,
}

impl Strokes {
    /// Prepares lines between points of model space, cut by the clip planes, each with its part of the
    /// opacity of `light`, 0 to 1. `width` is in pixels. O(lines + tiles).
    pub fn new(
        stage: &Stage<'_>,
        lines: impl ExactSizeIterator<Item = ([DVec3; 2], f32)>,
        width: f64,
        light: Light,
    ) -> Result<Strokes, Error> {
        let view = stage.view;
        let half_width = 0.5 * width;
        let mut seen: Vec<Line> = memory::with_capacity(lines.len())?;
        for (i, (line, opacity)) in lines.enumerate() {
            if i % (1 << 12) == 0 {
                stage.job.check()?;
            }
            let cut = stage.clip.planes().iter().try_fold(line, |line, &(normal, offset)| {
                cut(line, line.each(|end| normal.dot(end) + offset))
            });
            let ends = cut.map(|line| line.each(|end| view.camera.seen(end)));
            let near = |ends: [DVec3; 2]| match view.is_perspective() {
                true => NEAREST * ends[0].z.max(ends[1].z),
                false => 0.0,
            };
            seen.extend(ends.and_then(|ends| {
                let near = near(ends);
                // NaN is not visible.
                let ends = cut_numbers(ends, ends.each(|end| end.z - near))?;
                Some(Line { ends: ends.each(|end| End::new(view, end, near)), opacity })
            }));
        }
        let margin = DVec2::splat(half_width);
        let size = DVec2::new(f64::from(view.width), f64::from(view.height));
        let bins = Bins::new([view.width, view.height], seen.len(), stage.job, |i| {
            let [a, b] = within(seen[i].ends.each(|end| end.place), -margin, size + margin)?;
            let (low, high) = (a.min(b) - margin, a.max(b) + margin);
            Some([low.x, low.y, high.x, high.y])
        })?;
        Ok(Strokes { lines: seen, bins, half_width, light })
    }

    /// Draws the lines in a tile. Where several of these lines overlap, only the nearest is drawn, so that
    /// translucent lines are not darker there.
    pub fn paint(&self, tile: &mut Tile<'_>) -> Result<(), Error> {
        let lines = self.bins.of(tile)?;
        if lines.is_empty() || self.light.0.w <= 0.0 {
            return Ok(());
        }
        let mut nearest = memory::filled(tile.width() * tile.height(), (f64::INFINITY, 0.0))?;
        for i in lines {
            self.reach(tile, self.lines[i as usize], &mut nearest);
        }
        let width = 1.0 + 2.0 * self.half_width;
        for (sample, (depth, opacity)) in nearest.into_iter().enumerate() {
            if depth < f64::INFINITY {
                // At least half the depth, for wide lines close to the eye.
                let nearer = (depth - width * tile.view.pixel_at(depth)).max(0.5 * depth);
                tile.put(sample, nearer, self.light * opacity)?;
            }
        }
        Ok(())
    }

    /// Updates the depth and the opacity at the samples that a line covers: those within half its width.
    fn reach(&self, tile: &Tile<'_>, line: Line, nearest: &mut [(f64, f32)]) {
        let [a, b] = line.ends;
        let along = b.place - a.place;
        let (square, reach) = (along.length_squared(), self.half_width + 2.0 * NUDGE.y);
        let top = a.place.y.min(b.place.y) - reach;
        let bottom = a.place.y.max(b.place.y) + reach;
        for row in tile.between(1, top, bottom) {
            let y = tile.place(0, row)[1];
            // The part of the line that lies within reach of the row.
            let part = |y: f64| ((y - a.place.y) / along.y).clamp(0.0, 1.0);
            let parts = if along.y == 0.0 { [0.0, 1.0] } else { [part(y - reach), part(y + reach)] };
            let ends = parts.each(|part| a.place.x + along.x * part);
            let (left, right) = (ends[0].min(ends[1]) - reach, ends[0].max(ends[1]) + reach);
            for column in tile.between(0, left, right) {
                let from = DVec2::from(tile.place(column, row)) + NUDGE - a.place;
                let part = if square > 0.0 { (from.dot(along) / square).clamp(0.0, 1.0) } else { 0.0 };
                if (from - along * part).length_squared() > self.half_width * self.half_width {
                    continue;
                }
                let depth = a.depth + (b.depth - a.depth) * part;
                let depth = if tile.view.is_perspective() { 1.0 / depth } else { depth };
                let nearest = &mut nearest[row * tile.width() + column];
                // If lines meet at their ends, the most opaque one is visible.
                if depth < nearest.0 || depth == nearest.0 && line.opacity > nearest.1 {
                    *nearest = (depth, line.opacity);
                }
            }
        }
    }
}

impl End {
    fn new(view: &View, seen: DVec3, near: f64) -> End {
        // An end that was cut may be rounded to behind the cut.
        let seen = seen.with_z(seen.z.max(near));
        let depth = if view.is_perspective() { 1.0 / seen.z } else { seen.z };
        End { place: DVec2::from(view.place(seen)), depth }
    }
}

/// The part of a line where a linear function is not negative, given its values at the ends.
fn cut(line: [DVec3; 2], heights: [f64; 2]) -> Option<[DVec3; 2]> {
    let [a, b] = line;
    match heights.each(|height| height >= 0.0) {
        [true, true] => Some(line),
        [false, false] => None,
        [a_is_kept, _] => {
            let between = a + (b - a) * (heights[0] / (heights[0] - heights[1]));
            Some(if a_is_kept { [a, between] } else { [between, b] })
        }
    }
}

fn cut_numbers(line: [DVec3; 2], heights: [f64; 2]) -> Option<[DVec3; 2]> {
    let are_numbers = line.iter().all(|end| end.is_finite()) && heights.iter().any(|&height| height > 0.0);
    if are_numbers { cut(line, heights) } else { None }
}

/// The part of a line in the plane that lies in a box.
fn within(line: [DVec2; 2], low: DVec2, high: DVec2) -> Option<[DVec2; 2]> {
    let [a, b] = line;
    let along = b - a;
    let (mut from, mut to) = (0.0, 1.0);
    for axis in 0..2 {
        if along[axis] == 0.0 {
            if a[axis] < low[axis] || a[axis] > high[axis] {
                return None;
            }
            continue;
        }
        let [enter, leave] = [low, high].each(|side| (side[axis] - a[axis]) / along[axis]);
        from = enter.min(leave).max(from);
        to = enter.max(leave).min(to);
    }
    (from <= to).then(|| [a + along * from, a + along * to])
}
