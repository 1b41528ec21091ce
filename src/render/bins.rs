//! Assignment of things to the tiles in which they may be visible.

use super::mapped::mapped;
use super::tile::{TILE, Tile};
use crate::control::Job;
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use alloc::vec::Vec;

/// The first column, first row, last column and last row of tiles. If there are none, the first column lies
/// beyond the last one.
type Span = [u16; 4];

const NOWHERE: Span = [1, 0, 0, 0];

/// A thing that may be visible in more tiles than this is not listed for each of them, so that the lists stay
/// short.
const MOST_TILES: usize = 64;

/// Things that are numbered from 0, by the tiles in which they may be visible.
pub struct Bins {
    columns: usize,
    /// The start of each tile's list, and the end of the last one.
    starts: Vec<usize>,
    items: Vec<u32>,
    /// The things that may be visible in many tiles.
    wide: Vec<(u32, Span)>,
}

impl Bins {
    /// Sorts `count` things, at most 2^32, into the tiles of a picture of this size. `place` returns the
    /// place of a thing in the picture: the least x and y and the greatest ones, in pixels; these may be
    /// infinite. O(count + tiles).
    pub fn new(
        size: [u32; 2],
        count: usize,
        job: &Job<'_>,
        place: impl Fn(usize) -> Option<[f64; 4]> + Sync,
    ) -> Result<Bins, Error> {
        let tiles = size.each(|side| side.div_ceil(TILE) as usize);
        let mut spans: Vec<Span> =
            mapped(job, count, |i| place(i).map_or(NOWHERE, |place| span(place, size)))?;
        let mut starts: Vec<usize> = memory::filled(tiles[0] * tiles[1] + 1, 0)?;
        let mut wide = Vec::new();
        for (i, span) in (0..).zip(&mut spans) {
            if area(*span) > MOST_TILES {
                memory::push(&mut wide, (i, *span))?;
                *span = NOWHERE;
            }
            each_tile(*span, tiles[0], |tile| starts[tile + 1] += 1);
        }
        for tile in 1..starts.len() {
            starts[tile] += starts[tile - 1];
        }
        let mut next = memory::copied(&starts)?;
        let mut items = memory::filled(starts[starts.len() - 1], 0)?;
        for (i, &span) in (0..).zip(&spans) {
            each_tile(span, tiles[0], |tile| {
                items[next[tile]] = i;
                next[tile] += 1;
            });
        }
        Ok(Bins { columns: tiles[0], starts, items, wide })
    }

    /// Returns the things that may be visible in a tile, in ascending order.
    pub fn of(&self, tile: &Tile<'_>) -> Result<Vec<u32>, Error> {
        let [column, row] = tile.first.each(|first| first / TILE);
        let at = row as usize * self.columns + column as usize;
        let own = &self.items[self.starts[at]..self.starts[at + 1]];
        let mut found = memory::copied(own)?;
        for &(i, [left, top, right, bottom]) in &self.wide {
            let within = |low: u16, at: u32, high: u16| (u32::from(low)..=u32::from(high)).contains(&at);
            if within(left, column, right) && within(top, row, bottom) {
                memory::push(&mut found, i)?;
            }
        }
        if found.len() > own.len() {
            found.sort_unstable();
        }
        Ok(found)
    }
}

/// The tiles of a part of a picture. A NaN bound may be anywhere.
fn span([left, top, right, bottom]: [f64; 4], size: [u32; 2]) -> Span {
    // Rounding moves nothing by this much.
    const MARGIN: f64 = 1e-3;
    let [width, height] = size.each(f64::from);
    if right + MARGIN < 0.0 || bottom + MARGIN < 0.0 || left - MARGIN > width || top - MARGIN > height {
        return NOWHERE;
    }
    let tile = |x: f64, side: u32| {
        let last = (side - 1) / TILE;
        (x / f64::from(TILE)).clamp(0.0, f64::from(last)) as u16
    };
    let low = |x: f64, side: u32| if x.is_nan() { 0 } else { tile(x - MARGIN, side) };
    let high = |x: f64, side: u32| tile(if x.is_nan() { f64::INFINITY } else { x + MARGIN }, side);
    [low(left, size[0]), low(top, size[1]), high(right, size[0]), high(bottom, size[1])]
}

fn area([left, top, right, bottom]: Span) -> usize {
    let side = |low: u16, high: u16| (usize::from(high) + 1).saturating_sub(usize::from(low));
    side(left, right) * side(top, bottom)
}

fn each_tile([left, top, right, bottom]: Span, columns: usize, mut visit: impl FnMut(usize)) {
    for row in usize::from(top)..=usize::from(bottom) {
        for column in usize::from(left)..=usize::from(right) {
            visit(row * columns + column);
        }
    }
}
