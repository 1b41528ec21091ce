//! Dense blocks of 64³ cells, the results of bulk algorithms.

use super::tag::Tag;
use super::word::Planes;
use super::writer::Writer;
use crate::error::Error;
use crate::lattice::morton;
use crate::memory;
use alloc::boxed::Box;

/// Levels of a block: 64³ cells are six octree levels, three elements.
pub(crate) const BLOCK_LEVELS: u8 = 6;

/// A cube of 64³ finest cells as bit columns along z. A [`Worker`](crate::Worker) that can classify many
/// cells at once fills it. Bit k of word x + 64·y is the cell (x, y, k). The maker of a block chooses its
/// contents: the certified planes, the centres, or both.
pub struct Block {
    planes: Option<[Columns; 2]>,
    centres: Option<Columns>,
}

/// One word for each column.
type Columns = Box<[u64; 4096]>;

impl Block {
    /// Returns an empty block with the planes and the centres requested by `planes` and `centres`.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfMemory`].
    pub fn new(planes: bool, centres: bool) -> Result<Block, Error> {
        let planes = if planes { Some([memory::zeros()?, memory::zeros()?]) } else { None };
        Ok(Block { planes, centres: if centres { Some(memory::zeros()?) } else { None } })
    }

    /// Returns the planes of the surely and of the possibly solid cells, to be filled, if they are requested.
    /// A surely solid cell must be possibly solid, too.
    pub fn planes_mut(&mut self) -> Option<(&mut [u64; 4096], &mut [u64; 4096])> {
        self.planes.as_mut().map(|[lower, upper]| (&mut **lower, &mut **upper))
    }

    /// Returns the bits of the cells whose centres lie inside, to be filled, if they are requested. Decided
    /// cells count, too.
    pub fn centres_mut(&mut self) -> Option<&mut [u64; 4096]> {
        self.centres.as_deref_mut()
    }

    /// Turns the block into that of the complement.
    pub fn complement(&mut self) {
        if let Some([lower, upper]) = &mut self.planes {
            core::mem::swap(lower, upper);
            lower.iter_mut().chain(upper.iter_mut()).for_each(|word| *word = !*word);
        }
        if let Some(centres) = &mut self.centres {
            centres.iter_mut().for_each(|word| *word = !*word);
        }
    }

    /// Returns the planes of the surely and of the possibly solid cells, if they were requested.
    pub(crate) fn planes(&self) -> Option<(&[u64; 4096], &[u64; 4096])> {
        self.planes.as_ref().map(|[lower, upper]| (&**lower, &**upper))
    }

    /// Returns the bits of the cells whose centres lie inside, if they were requested.
    pub(crate) fn centres(&self) -> Option<&[u64; 4096]> {
        self.centres.as_deref()
    }
}

/// The cells of a block in the form in which they are stored.
pub(crate) struct Cells<'b> {
    /// True if both planes are the same.
    pub binary: bool,
    pub lower: &'b [u64; 4096],
    pub upper: &'b [u64; 4096],
}

impl Cells<'_> {
    /// Writes the cells as three levels of elements, of which `e` is the first. Returns the tag of the block.
    pub(crate) fn write(&self, e: usize, writer: &mut Writer<'_>) -> Result<Tag, Error> {
        let tiles = self.tiles();
        let mut block = Planes::uniform(Tag::Empty);
        for c in 0..64 {
            let [x, y, z] = morton::position(c);
            block.set(c, self.write_element(&tiles, [4 * x, 4 * y, 4 * z], e + 1, writer)?);
        }
        writer.put(e, block)
    }

    /// Returns the common bits of the 4 × 4 columns of each tile, which decide most bricks.
    fn tiles(&self) -> [Tile; 256] {
        let mut tiles = [Tile { all: Planes::uniform(Tag::Full), any: Planes::uniform(Tag::Empty) }; 256];
        let binary = self.binary;
        for (row, columns) in self.lower.chunks_exact(4).enumerate() {
            let upper = if binary { columns } else { &self.upper[4 * row..4 * row + 4] };
            // Sixteen quadruples of columns to a row of 64, four rows to a row of tiles.
            let tile = &mut tiles[row / 64 * 16 + row % 16];
            for (&lower, &upper) in columns.iter().zip(upper) {
                let column = Planes { lower, upper };
                tile.all = tile.all.intersection(column);
                tile.any = tile.any.union(column);
            }
        }
        tiles
    }

    /// Writes an element of 16³ cells; `at` is in bricks.
    fn write_element(
        &self,
        tiles: &[Tile; 256],
        at: [u32; 3],
        e: usize,
        writer: &mut Writer<'_>,
    ) -> Result<Tag, Error> {
        let mut common = Tile { all: Planes::uniform(Tag::Full), any: Planes::uniform(Tag::Empty) };
        for row in tiles.chunks_exact(16).skip(at[1] as usize).take(4) {
            for tile in &row[at[0] as usize..at[0] as usize + 4] {
                common.all = common.all.intersection(tile.all);
                common.any = common.any.union(tile.any);
            }
        }
        let layers = |word: u64| word >> (4 * at[2]) & 0xFFFF;
        if layers(common.any.upper) == 0 {
            return Ok(Tag::Empty);
        }
        if layers(common.all.lower) == 0xFFFF {
            return Ok(Tag::Full);
        }
        let mut element = Planes::uniform(Tag::Empty);
        for c in 0..64 {
            let [x, y, z] = morton::position(c);
            let (x, y, shift) = (at[0] + x, at[1] + y, 4 * (at[2] + z));
            let Tile { all, any } = tiles[(16 * y + x) as usize];
            let nibble = |word: u64| word >> shift & 0xF;
            let tag = if nibble(any.upper) == 0 {
                Tag::Empty
            } else if nibble(all.lower) == 0xF {
                Tag::Full
            } else if nibble(any.lower) == 0 && nibble(all.upper) == 0xF {
                Tag::Partial
            } else {
                let column = (4 * y * 64 + 4 * x) as usize;
                let lower = gather(self.lower, column, shift);
                let upper = if self.binary { lower } else { gather(self.upper, column, shift) };
                writer.put(e + 1, Planes { lower, upper })?
            };
            element.set(c, tag);
        }
        writer.put(e, element)
    }
}

/// Sixteen columns: the bits set in all of them, and in any of them.
#[derive(Clone, Copy)]
struct Tile {
    all: Planes,
    any: Planes,
}

/// Returns the brick whose lowest column is `column`, with its cells at bits `shift..shift + 4` of 4 × 4
/// columns.
#[inline(always)]
fn gather(words: &[u64; 4096], column: usize, shift: u32) -> u64 {
    // A nibble's four bits (z = 0 to 3) belong at Morton bits 2 and 5 of the brick's index.
    const fn spread_z(nibble: u64) -> u64 {
        (nibble & 1) | (nibble & 2) << 3 | (nibble & 4) << 30 | (nibble & 8) << 33
    }
    const SPREAD: [u64; 16] = {
        let mut table = [0; 16];
        let mut n = 0;
        while n < 16 {
            table[n] = spread_z(n as u64);
            n += 1;
        }
        table
    };
    let mut brick = 0;
    for y in 0..4 {
        for x in 0..4 {
            let nibble = words[column + 64 * y + x] >> shift & 0xF;
            brick |= SPREAD[nibble as usize] << morton::index(x as u32, y as u32, 0);
        }
    }
    brick
}
