//! The cells in which a solid may have points.

use super::super::item::on_any_frame;
use super::bits::Bits;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Bounds, Frame, MAX_DEPTH, axes};
use crate::memory;
use crate::op::{Rule, build};
use crate::solid::AnySolid;
use alloc::vec::Vec;

/// The cells of a solid, and the lower corner of the first of them (model units).
pub(super) struct Voxels {
    pub(super) bits: Bits,
    pub(super) origin: [f64; 3],
}

/// The distance from the first cell's lower end to the solid, as a part of a cell: it ensures that no two
/// solids in neighbouring cells touch.
const BELOW: f64 = 1.0 / 64.0;

impl Voxels {
    /// Computes the cells, of edge `cell`, of a solid in a box. Their corners are multiples of `cell` beyond
    /// `from`, if that is given.
    pub(super) fn of(
        solid: &AnySolid,
        bounds: &Bounds,
        cell: f64,
        from: Option<[f64; 3]>,
        control: &Control<'_>,
    ) -> Result<Voxels, Error> {
        let origin = axes(|k| match from {
            Some(from) => from[k] + libm::floor((bounds.min[k] - from[k]) / cell) * cell,
            None => bounds.min[k] - BELOW * cell,
        });
        let size: [usize; 3] =
            axes(|k| (libm::ceil((bounds.max[k] - origin[k]) / cell + BELOW)).max(1.0) as usize);
        let longest = size.into_iter().fold(1, usize::max);
        let depth = longest.next_power_of_two().ilog2().max(1);
        if depth > u32::from(MAX_DEPTH) {
            return Err(Error::Argument {
                name: "cells",
                problem: "must be fewer: an item takes more than 2^20 of them along an axis",
            });
        }
        let frame = Frame::new(origin, cell * f64::from(1u32 << depth), depth as u8)?;
        let needed = Bits::bytes(size);
        if let Some(limit) = control.max_bytes
            && needed > limit
        {
            return Err(Error::TooLarge { what: "the cells of an item", needed, limit });
        }
        let mut bits = Bits::new(size)?;
        on_frame(solid, &frame, &mut bits, control)?;
        Ok(Voxels { bits, origin })
    }
}

/// Returns the cells of a box that are not proven to lie in a solid, and all cells of a margin of `pad` cells
/// at every end.
pub(super) fn outside(
    solid: &AnySolid,
    origin: [f64; 3],
    cell: f64,
    size: [usize; 3],
    pad: usize,
    control: &Control<'_>,
) -> Result<Bits, Error> {
    let longest = size.into_iter().fold(1, usize::max);
    let depth = longest.next_power_of_two().ilog2().max(1);
    let frame = Frame::new(origin, cell * f64::from(1u32 << depth), depth as u8)?;
    let mut inside = Bits::new(size)?;
    inside.bits = on_frame(solid, &frame, &mut inside, control)?;
    let mut outside = Bits::new(size.each(|size| size + 2 * pad))?;
    for z in 0..outside.size[2] {
        for y in 0..outside.size[1] {
            let is_beyond = |at: usize, k: usize| at < pad || at >= size[k] + pad;
            let mut from = 0;
            if !is_beyond(y, 1) && !is_beyond(z, 2) {
                let mut gaps = Vec::new();
                inside.runs_of(y - pad, z - pad, |x, length| {
                    memory::push(&mut gaps, (x + pad, x + pad + length))
                })?;
                for (start, end) in gaps {
                    outside.set_row(from, start, y, z);
                    from = end;
                }
            }
            let end = outside.size[0];
            outside.set_row(from, end, y, z);
        }
    }
    Ok(outside)
}

/// Computes the cells of a frame in which a solid may have points, in the box of `outer`, and the cells that
/// are proven to lie in the solid.
fn on_frame(
    solid: &AnySolid,
    frame: &Frame,
    outer: &mut Bits,
    control: &Control<'_>,
) -> Result<Vec<u64>, Error> {
    let own = Control { progress: None, max_splits: None, ..*control };
    let tree = build(&on_any_frame(solid), frame, Rule::Certified, &own)?;
    let mut inner = memory::filled(outer.bits.len(), 0)?;
    let end = outer.size.each(|cells| cells as u32);
    tree.bitmap(frame.depth(), [0; 3], end, &mut inner, Some(&mut outer.bits), &own)?;
    Ok(inner)
}
