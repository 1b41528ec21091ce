//! The settling of placed items: moves towards the corner, as far as they are proven to be free.

use super::super::Layout;
use super::budget::Budget;
use crate::error::Error;
use crate::lattice::{Affine, axes};
use crate::memory;
use alloc::vec::Vec;

/// The binary logarithm of the ratio between the first step along an axis and the last.
const HALVINGS: u32 = 5;

/// The number of passes over all placed items.
const PASSES: usize = 1;

/// Moves all copies from number `first` on down along z, y and x, the lowest first; `step` is the first step
/// (model units).
pub(super) fn settle(
    layout: &mut Layout,
    first: usize,
    step: f64,
    budget: &mut Budget<'_>,
) -> Result<(), Error> {
    for _ in 0..PASSES {
        for axis in [2, 1, 0] {
            let mut order: Vec<usize> = memory::collected(first..layout.placed.len())?;
            order.sort_unstable_by(|&a, &b| {
                layout.boxes[a].min[axis].total_cmp(&layout.boxes[b].min[axis]).then(a.cmp(&b))
            });
            for number in order {
                lower(layout, number, axis, step, budget)?;
            }
        }
    }
    Ok(())
}

/// Moves a copy down along an axis. The steps grow as long as they succeed, and are halved where they fail.
fn lower(
    layout: &mut Layout,
    number: usize,
    axis: usize,
    step: f64,
    budget: &mut Budget<'_>,
) -> Result<(), Error> {
    let floor = layout.container.bounds().min[axis] + layout.container.clearance();
    let (mut by, mut grows) = (step, true);
    let least = step / f64::from(1u32 << HALVINGS);
    while by >= least && !budget.is_spent() {
        let room = layout.boxes[number].min[axis] - floor;
        if room < least {
            return Ok(());
        }
        by = by.min(room);
        let own = layout.placed[number];
        let rows = own.placement.rows();
        let Ok(placement) = Affine::new(axes(|k| {
            let to = rows[k][3] - if k == axis { by } else { 0.0 };
            [rows[k][0], rows[k][1], rows[k][2], to]
        })) else {
            return Ok(());
        };
        if budget.tested(|control| layout.stands(own.item, &placement, Some(number), control))? {
            layout.move_to(number, &placement)?;
            by *= if grows { 2.0 } else { 1.0 };
        } else {
            grows = false;
            by *= 0.5;
        }
    }
    Ok(())
}
