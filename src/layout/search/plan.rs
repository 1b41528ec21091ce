//! The order of placement, and the preferred places.

use super::super::random::Random;
use super::tally::Figure;
use crate::error::Error;
use crate::lattice::Affine;
use crate::memory;
use alloc::vec::Vec;

/// A copy to place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    pub(super) item: usize,
    pub(super) placement: Affine,
}

/// The plan of one round.
#[derive(Debug, Clone)]
pub(super) struct Plan {
    /// The items, repeated by the number of copies to place.
    pub(super) order: Vec<usize>,
    /// The weight of an item's height relative to the height of its place.
    pub(super) lean: f64,
    /// The weight of contact with others: full contact counts as much as this many mean sides of the item in
    /// height.
    pub(super) grip: f64,
    /// Whether places are chosen for the centre of gravity instead of for the least height. Where space is
    /// scarce, not all items fit that way.
    pub(super) is_for_balance: bool,
    /// The preferred direction within a layer.
    pub(super) way: Way,
}

/// The preference among the places of a layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Way {
    /// The least coordinate along y, then along x.
    Rows,
    /// The least coordinate along x, then along y.
    Columns,
    /// The place nearest to the corner.
    Corner,
}

impl Plan {
    /// Builds the plan of a round. `left` is the number of copies of each item to place, `figures` are the
    /// sizes of the items.
    pub(super) fn new(left: &[u32], figures: &[Figure], round: u64, seed: u64) -> Result<Plan, Error> {
        const LEANS: [f64; 4] = [1.0, 0.5, 0.75, 0.25];
        const GRIPS: [f64; 4] = [2.0, 4.0, 0.5, 1.0];
        const WAYS: [Way; 3] = [Way::Corner, Way::Rows, Way::Columns];
        let mut random = Random::new(seed.wrapping_add(round.wrapping_mul(0xA076_1D64_78BD_642F)));
        // The first rounds go by size, later rounds are increasingly random.
        let spread = if round < LEANS.len() as u64 { 0.0 } else { 0.15 * (1 + (round - 4) % 8) as f64 };
        // Long items hardly find a place late, and neither do large ones.
        let size = |figure: &Figure| match round % 2 {
            0 => figure.volume,
            _ => figure.longest * figure.longest * figure.longest,
        };
        let mut keyed = Vec::new();
        for (item, (&count, figure)) in left.iter().zip(figures).enumerate() {
            for _ in 0..count {
                let factor = libm::exp(2.0 * spread * (random.part() - 0.5));
                memory::push(&mut keyed, (size(figure) * factor, item))?;
            }
        }
        keyed.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut order = memory::with_capacity(keyed.len())?;
        order.extend(keyed.iter().map(|&(_, item)| item));
        let pick = |count: usize| (round % count as u64) as usize;
        Ok(Plan {
            order,
            lean: LEANS[pick(LEANS.len())],
            grip: GRIPS[pick(GRIPS.len())],
            is_for_balance: round.is_multiple_of(2),
            way: WAYS[pick(WAYS.len())],
        })
    }

    /// Returns the rank of a place; the least rank is best. `left` is the remaining space beside the item in
    /// the tightest direction.
    pub(super) fn rank(&self, at: [f64; 3], size: [f64; 3], left: f64) -> [f64; 4] {
        let [x, y, z] = at;
        let high = z + self.lean * size[2];
        match self.way {
            Way::Rows => [high, y, x, left],
            Way::Columns => [high, x, y, left],
            Way::Corner => [high, x + y, left, x],
        }
    }
}
