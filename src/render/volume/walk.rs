//! The walk through the voxels of a tile, from front to back.
//!
//! The records are sorted by code, so that the records of a cell are a range. A tile walks through these
//! ranges from the root on, octant by octant from front to back, and skips the cells that lie beside the
//! tile. Each remaining voxel is composited behind the light of its samples so far.

use super::layer::{Compositing, VolumeLayer};
use super::light_path::light_paths;
use super::sides::{Side, sides};
use super::voxel::Voxels;
use crate::control::Job;
use crate::error::Error;
use crate::lattice::{Cell, MAX_DEPTH};
use crate::memory;
use crate::render::light::Light;
use crate::render::stage::{Draw, Painter, Pass, Stage};
use crate::render::tile::Tile;
use crate::voxel::VoxelKind;
use alloc::boxed::Box;
use core::ops::Range;

impl Draw for VolumeLayer<'_> {
    fn prepare<'a>(&'a self, stage: &Stage<'a>) -> Result<Box<dyn Painter + 'a>, Error> {
        Ok(Box::new(Volume { voxels: Voxels::new(self, stage.clip)?, job: stage.job }))
    }
}

/// A layer that is ready to draw.
struct Volume<'a> {
    voxels: Voxels<'a>,
    job: &'a Job<'a>,
}

impl Painter for Volume<'_> {
    fn pass(&self) -> Pass {
        Pass::Volumes
    }

    fn paint(&self, tile: &mut Tile<'_>) -> Result<(), Error> {
        let layer = self.voxels.layer;
        match layer.compositing {
            Compositing::Exact => self.draw::<true>(tile, layer.transfer.length()),
            Compositing::Published { unit } => self.draw::<false>(tile, unit),
        }
    }
}

/// A cell and the records in it.
struct Part {
    cell: Cell,
    records: Range<usize>,
}

impl Volume<'_> {
    /// Draws a tile, by exact paths or as published. The optical depth of a voxel is that of its value per
    /// `length`.
    fn draw<const EXACT: bool>(&self, tile: &mut Tile<'_>, length: f64) -> Result<(), Error> {
        let voxels = &self.voxels;
        let records = &voxels.layer.records;
        let (view, codes, depth) = (tile.view, records.codes(), records.frame().depth());
        let place = voxels.coordinates.place(&view.camera);
        let mut sides = sides(tile, voxels.clip, &place, &voxels.coordinates)?;
        if codes.is_empty() || !self.is_seen(&sides, Cell::ROOT) {
            return Ok(());
        }
        let mut paths = light_paths(tile, EXACT.then_some(voxels.clip), &voxels.coordinates)?;
        let mut open = paths.iter().filter(|path| path.is_open()).count();
        let far = paths.iter().fold(f64::NEG_INFINITY, |far: f64, path| far.max(path.end));
        if far < f64::INFINITY {
            memory::push(&mut sides, Side::new(-place.forward, place.eye + place.forward * far))?;
        }

        // Each level has at most seven waiting parts.
        let mut parts = memory::with_capacity(8 * (MAX_DEPTH as usize + 2))?;
        parts.push(Part { cell: Cell::ROOT, records: 0..codes.len() });
        let mut count = 0u32;
        while let Some(Part { mut cell, records: mut range }) = parts.pop() {
            if open == 0 {
                break;
            }
            count = count.wrapping_add(1);
            if count.is_multiple_of(256) {
                self.job.check()?;
            }
            if range.len() == 1 {
                cell = records.cell_at(range.start);
            }
            if !self.is_seen(&sides, cell) {
                continue;
            }
            if records.levels()[range.start] <= cell.level {
                if records.kind_at(range.start) != VoxelKind::Refined {
                    open -= voxels.draw::<EXACT>(tile, &place, &mut paths, range.start, cell, length);
                    continue;
                }
                range.start += 1;
                if range.is_empty() {
                    continue;
                }
            }
            if cell.level >= depth {
                continue;
            }
            let middle = |axis: usize| {
                (2 * cell.at[axis] + 1) as f64 * voxels.coordinates.edges[cell.level as usize + 1]
            };
            let is_upper = |axis: usize| {
                if view.is_perspective() {
                    place.eye[axis] >= middle(axis)
                } else {
                    place.forward[axis] < 0.0
                }
            };
            let near = (0..3).fold(0, |bits, axis| bits | u8::from(is_upper(axis)) << axis);
            let ends = ends(&codes[range.clone()], 3 * (depth - cell.level - 1));
            // The last part is taken first.
            for octant in (0..8).rev().map(|k| k ^ near) {
                let records = range.start + ends[octant as usize]..range.start + ends[octant as usize + 1];
                if !records.is_empty() {
                    parts.push(Part { cell: cell.child(octant), records });
                }
            }
        }

        for (sample, path) in paths.iter().enumerate() {
            tile.volume[sample] = Light(path.light.extend(1.0 - path.through).as_vec4());
            tile.passed[sample] += path.passed;
        }
        Ok(())
    }

    #[inline]
    fn is_seen(&self, sides: &[Side], cell: Cell) -> bool {
        let cube = self.voxels.coordinates.cube(cell);
        sides.iter().all(|side| side.meets(cube))
    }
}

/// The end of the records of each octant, by the digit at `shift` of their codes; the first is 0.
fn ends(codes: &[u64], shift: u8) -> [usize; 9] {
    let digit = |code: u64| (code >> shift & 7) as usize;
    let mut ends = [0; 9];
    if codes.len() <= 24 {
        for &code in codes {
            ends[digit(code) + 1] += 1;
        }
        for k in 1..9 {
            ends[k] += ends[k - 1];
        }
    } else {
        for k in 0..8 {
            let rest = &codes[ends[k]..];
            ends[k + 1] = ends[k] + rest.partition_point(|&code| digit(code) <= k);
        }
    }
    ends
}
