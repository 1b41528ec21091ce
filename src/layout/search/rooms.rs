//! Places for the boxes of items, without splits.

use super::super::Layout;
use super::super::proof::wider;
use super::boxes::Free;
use super::plan::{Plan, Step};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Affine, Bounds, axes};
use crate::memory;
use alloc::vec::Vec;

/// An orientation, and the item's box in it.
struct Turned {
    map: Affine,
    block: Bounds,
    /// The box of the item in the given orientation.
    own: Bounds,
}

/// The boxes of items in their orientations. No two boxes of an item have the same size.
pub(super) struct Rooms {
    items: Vec<Vec<Turned>>,
    whole: Bounds,
    least: f64,
}

impl Rooms {
    /// Prepares the boxes; `None` if the container is not proven to be a box, or has no free space.
    pub(super) fn new(layout: &Layout, maps: &[Vec<Affine>]) -> Result<Option<Rooms>, Error> {
        let container = &layout.container;
        let (bounds, margin) = (container.bounds(), container.clearance());
        let whole = narrower(bounds, margin);
        let Some(whole) = whole.filter(|_| container.is_box()) else { return Ok(None) };
        let mut items = memory::with_capacity(maps.len())?;
        let mut least = f64::INFINITY;
        for (item, maps) in layout.items.iter().zip(maps) {
            let mut list: Vec<Turned> = Vec::new();
            for map in maps {
                let Some(block) = item.bounds.placed(map) else { continue };
                let size = |own: &Bounds| -> [f64; 3] { axes(|k| own.max[k] - own.min[k]) };
                let is_known = list.iter().any(|own| size(&own.block) == size(&block));
                if !is_known {
                    least = size(&block).into_iter().fold(least, f64::min);
                    memory::push(&mut list, Turned { map: *map, block, own: item.bounds })?;
                }
            }
            items.push(list);
        }
        Ok(Some(Rooms { items, whole, least }))
    }

    /// Places items as far as they find a place, in the order of a plan. Nothing is proven yet.
    pub(super) fn round(
        &self,
        layout: &Layout,
        plan: &Plan,
        control: &Control<'_>,
    ) -> Result<Vec<Step>, Error> {
        let mut free = Free::new(&self.whole)?;
        for obstacle in &layout.obstacles {
            free.take(&wider(obstacle.bounds(), layout.clearance))?;
        }
        for block in &layout.boxes {
            free.take(&wider(block, layout.clearance))?;
        }
        let mut steps = memory::with_capacity(plan.order.len())?;
        let mut is_full = memory::filled(self.items.len(), false)?;
        for &item in &plan.order {
            control.check()?;
            if is_full[item] {
                continue;
            }
            match self.place(item, &free, plan) {
                Some((step, block)) => {
                    free.take(&wider(&block, layout.clearance))?;
                    free.forget_below(self.least);
                    steps.push(step);
                }
                None => is_full[item] = true,
            }
        }
        Ok(steps)
    }

    /// Returns the best place for an item, and the item's box there.
    fn place(&self, item: usize, free: &Free, plan: &Plan) -> Option<(Step, Bounds)> {
        let mut best: Option<([f64; 4], Step, Bounds)> = None;
        for turned in &self.items[item] {
            let size: [f64; 3] = axes(|k| turned.block.max[k] - turned.block.min[k]);
            for room in free.boxes() {
                if (0..3).any(|k| size[k] > room.max[k] - room.min[k]) {
                    continue;
                }
                let left = (0..3).map(|k| room.max[k] - room.min[k] - size[k]).fold(f64::INFINITY, f64::min);
                let rank = plan.rank(room.min, size, left);
                if best.as_ref().is_some_and(|best| best.0 <= rank) {
                    continue;
                }
                if let Some((placement, block)) = put(turned, room) {
                    best = Some((rank, Step { item, placement }, block));
                }
            }
        }
        best.map(|(_, step, block)| (step, block))
    }
}

/// Returns the box of points in a box that keep a margin from its faces; `None` if there is none.
fn narrower(bounds: &Bounds, margin: f64) -> Option<Bounds> {
    // (A rounded margin is rounded away from the faces.)
    let low = wider(&Bounds { min: bounds.min, max: bounds.min }, margin).max;
    let high = wider(&Bounds { min: bounds.max, max: bounds.max }, margin).min;
    Bounds::new(low, high)
}

/// Moves a turned item into the lower corner of a room, so that its box lies within in spite of rounding.
fn put(turned: &Turned, room: &Bounds) -> Option<(Affine, Bounds)> {
    let mut to: [f64; 3] = axes(|k| room.min[k] - turned.block.min[k]);
    for _ in 0..4 {
        let rows = turned.map.rows();
        let placement = Affine::new(axes(|k| [rows[k][0], rows[k][1], rows[k][2], to[k]])).ok()?;
        let there = turned.own.placed(&placement)?;
        let is_below = |k: usize| there.min[k] < room.min[k];
        if !(0..3).any(is_below) {
            let is_within = (0..3).all(|k| there.max[k] <= room.max[k]);
            return is_within.then_some((placement, there));
        }
        for k in (0..3).filter(|&k| is_below(k)) {
            to[k] = (to[k] + (room.min[k] - there.min[k])).next_up();
        }
    }
    None
}
