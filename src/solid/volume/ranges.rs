//! The least and the greatest sample of every block of 4³. For any band, they usually tell, without the
//! samples, whether a block lies inside as a whole or does not touch the solid.

use super::slices::in_slices;
use super::value::Value;
use super::{Samples, VoxelGrid};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use alloc::vec::Vec;

/// `[least, greatest]` of each block, x fastest. In a block with NaN samples, the least is NaN, and the
/// greatest is that of the other samples.
#[derive(Debug)]
pub(super) enum Ranges {
    /// Bits have no ranges: reading the bits is as fast.
    None,
    U8(Vec<[u8; 2]>),
    U16(Vec<[u16; 2]>),
    I16(Vec<[i16; 2]>),
    F32(Vec<[f32; 2]>),
}

impl Ranges {
    /// Reads all samples once.
    pub(super) fn new(
        grid: &VoxelGrid,
        samples: &Samples<'_>,
        control: &Control<'_>,
    ) -> Result<Ranges, Error> {
        Ok(match samples {
            Samples::Bits(_) => Ranges::None,
            Samples::U8(values) => Ranges::U8(ranges(grid, values.values(), control)?),
            Samples::U16(values) => Ranges::U16(ranges(grid, values.values(), control)?),
            Samples::I16(values) => Ranges::I16(ranges(grid, values.values(), control)?),
            Samples::F32(values) => Ranges::F32(ranges(grid, values.values(), control)?),
        })
    }

    /// The number of bytes of the ranges.
    pub(super) fn bytes(&self) -> usize {
        match self {
            Ranges::None => 0,
            Ranges::U8(ranges) => size_of_val(&ranges[..]),
            Ranges::U16(ranges) => size_of_val(&ranges[..]),
            Ranges::I16(ranges) => size_of_val(&ranges[..]),
            Ranges::F32(ranges) => size_of_val(&ranges[..]),
        }
    }

    /// The least and the greatest of all samples; `None` for bits, and if one sample is NaN.
    pub(super) fn all(&self) -> Option<[f64; 2]> {
        fn of<T: Value>(ranges: &[[T; 2]]) -> Option<[f64; 2]> {
            let mut all = [f64::INFINITY, f64::NEG_INFINITY];
            for &[least, greatest] in ranges {
                if least.is_nan() {
                    return None;
                }
                all = [all[0].min(least.to_f64()), all[1].max(greatest.to_f64())];
            }
            (all[0] <= all[1]).then_some(all)
        }
        match self {
            Ranges::None => None,
            Ranges::U8(ranges) => of(ranges),
            Ranges::U16(ranges) => of(ranges),
            Ranges::I16(ranges) => of(ranges),
            Ranges::F32(ranges) => of(ranges),
        }
    }
}

fn ranges<T: Value>(grid: &VoxelGrid, values: &[T], control: &Control<'_>) -> Result<Vec<[T; 2]>, Error> {
    let [nx, ny, nz] = grid.extents().each(|extent| extent as usize);
    let blocks = grid.extents().each(|extent| extent.div_ceil(4) as usize);
    let mut ranges = memory::filled(blocks[0] * blocks[1] * blocks[2], [T::GREATEST, T::LEAST])?;
    in_slices(&mut ranges, blocks[0] * blocks[1], control, |bz, slice| {
        let mut least = memory::filled(nx, T::GREATEST)?;
        let mut greatest = memory::filled(nx, T::LEAST)?;
        let mut is_number = memory::filled(nx, true)?;
        for (by, row) in slice.chunks_mut(blocks[0]).enumerate() {
            least.fill(T::GREATEST);
            greatest.fill(T::LEAST);
            is_number.fill(true);
            for z in 4 * bz..nz.min(4 * bz + 4) {
                for y in 4 * by..ny.min(4 * by + 4) {
                    let first = (z * ny + y) * nx;
                    let samples = values.get(first..first + nx).unwrap_or(&[]);
                    // Two loops, so that each can be vectorised.
                    for (least, &value) in least.iter_mut().zip(samples) {
                        *least = if value < *least { value } else { *least };
                    }
                    for (greatest, &value) in greatest.iter_mut().zip(samples) {
                        *greatest = if value > *greatest { value } else { *greatest };
                    }
                    if T::NONE.is_nan() {
                        for (is_number, &value) in is_number.iter_mut().zip(samples) {
                            *is_number &= !value.is_nan();
                        }
                    }
                }
            }
            let columns = least.chunks(4).zip(greatest.chunks(4)).zip(is_number.chunks(4));
            for (range, ((least, greatest), is_number)) in row.iter_mut().zip(columns) {
                for (&low, &high) in least.iter().zip(greatest) {
                    range[0] = if low < range[0] { low } else { range[0] };
                    range[1] = if high > range[1] { high } else { range[1] };
                }
                if is_number.contains(&false) {
                    range[0] = T::NONE;
                }
            }
        }
        Ok(())
    })?;
    Ok(ranges)
}
