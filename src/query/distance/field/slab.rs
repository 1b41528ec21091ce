//! Successive slices of the field, across z.

use super::envelope::Envelope;
use super::mask::{Mask, Range};
use super::rounding::Scale;
use super::sides::{NONE, Signed, along};
use crate::control::Job;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::memory;
use alloc::vec::Vec;

/// The number of slices processed together: the squares of one column fill a cache line.
pub(super) const DEEP: usize = 16;

/// Successive slices of the field.
pub(super) struct Slab<'s> {
    pub(super) wanted: Range,
    /// The first slice.
    pub(super) first: u32,
    /// The number of slices, at most [`DEEP`].
    pub(super) deep: usize,
    pub(super) scale: &'s Scale,
    pub(super) job: &'s Job<'s>,
}

impl Slab<'_> {
    /// Fills the slab's part of the field, from the sets around the solid and inside.
    pub(super) fn fill(
        &self,
        (outer, inner): &(Mask, Option<Mask>),
        part: &mut [[f32; 2]],
    ) -> Result<(), Error> {
        let scale = self.scale;
        let lower = |square: Option<u64>, is_member: bool| {
            if is_member { -scale.up(square) } else { scale.down(square) }
        };
        let upper = |square: Option<u64>, is_member: bool| {
            if is_member { -scale.down(square) } else { scale.up(square) }
        };
        match inner {
            Some(inner) => {
                self.squares(outer, part, |entry, square, is_member| entry[0] = lower(square, is_member))?;
                self.squares(inner, part, |entry, square, is_member| entry[1] = upper(square, is_member))
            }
            None => self.squares(outer, part, |entry, square, is_member| {
                *entry = [lower(square, is_member), upper(square, is_member)];
            }),
        }
    }

    /// Computes the squares of the distances from the other side of a set: along z, then y, then x.
    fn squares(
        &self,
        mask: &Mask,
        part: &mut [[f32; 2]],
        put: impl Fn(&mut [f32; 2], Option<u64>, bool),
    ) -> Result<(), Error> {
        let (seen, wanted) = (mask.range, self.wanted);
        let [width, height, length] = seen.size().each(|edge| edge as usize);
        let [nx, ny, _] = wanted.size().each(|edge| edge as usize);
        let first = axes(|axis| (wanted.min[axis] - seen.min[axis]) as usize);
        let below = (self.first - seen.min[2]) as usize;
        let longest = width.max(height);
        let mut envelope = Envelope::new(longest)?;
        let mut line: Vec<Signed> = memory::filled(longest, 0)?;
        let mut result: Vec<Signed> = memory::filled(nx.max(ny), 0)?;
        // Columns along y for one x, each with its cells along z; then the same for all x, for the wanted y.
        let mut column: Vec<[Signed; DEEP]> = memory::filled(height, [0; DEEP])?;
        let mut flat: Vec<[Signed; DEEP]> = memory::filled(ny, [0; DEEP])?;
        let mut plane: Vec<[Signed; DEEP]> = memory::filled(width * ny, [0; DEEP])?;
        for x in 0..width {
            self.job.check()?;
            for (y, cells) in (seen.min[1]..).zip(&mut column) {
                along(mask.row(seen.min[0] + x as u32, y), length, below, &mut cells[..self.deep]);
            }
            for z in 0..self.deep {
                line.iter_mut().zip(&column).for_each(|(value, cells)| *value = cells[z]);
                envelope.run(&line[..height], first[1], &mut result[..ny]);
                flat.iter_mut().zip(&result).for_each(|(cells, &square)| cells[z] = square);
            }
            for (cells, row) in flat.iter().zip(plane.chunks_exact_mut(width)) {
                row[x] = *cells;
            }
        }
        for y in 0..ny {
            for z in 0..self.deep {
                let cells = &plane[y * width..(y + 1) * width];
                line.iter_mut().zip(cells).for_each(|(value, cells)| *value = cells[z]);
                envelope.run(&line[..width], first[0], &mut result[..nx]);
                let row = &mut part[(z * ny + y) * nx..][..nx];
                for (entry, &square) in row.iter_mut().zip(&result[..nx]) {
                    let magnitude = square.abs();
                    put(entry, (magnitude != NONE).then_some(magnitude as u64), square < 0);
                }
            }
        }
        Ok(())
    }
}
