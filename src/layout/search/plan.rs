//! In which order items are placed, and which places are preferred.

use super::super::random::Random;
use super::tally::Figure;
use crate::error::Error;
use crate::lattice::Affine;
use crate::memory;
use alloc::vec::Vec;

/// Something that is to be placed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    pub(super) item: usize,
    pub(super) placement: Affine,
}

/// How one round goes.
#[derive(Debug, Clone)]
pub(super) struct Plan {
    /// The items, as often as they are to be placed.
    pub(super) order: Vec<usize>,
    /// How much the height of an item counts beside that of its place.
    pub(super) lean: f64,
    /// How much contact with others counts: all around, as much as so many of its mean sides in height.
    pub(super) grip: f64,
    /// Whether items go where the centre of gravity wants them, and not down: where there is hardly room, not
    /// all go there.
    pub(super) is_for_balance: bool,
    /// Which way items go within a layer.
    pub(super) way: Way,
}

/// Which of the places of a layer is preferred.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Way {
    /// The least along y, then along x.
    Rows,
    /// The least along x, then along y.
    Columns,
    /// That nearest to the corner.
    Corner,
}

impl Plan {
    /// The plan of a round: `left` says how many copies of each item are to be placed, `figures` how large
    /// each is.
    pub(super) fn new(left: &[u32], figures: &[Figure], round: u64, seed: u64) -> Result<Plan, Error> {
        const LEANS: [f64; 4] = [1.0, 0.5, 0.75, 0.25];
        const GRIPS: [f64; 4] = [2.0, 4.0, 0.5, 1.0];
        const WAYS: [Way; 3] = [Way::Corner, Way::Rows, Way::Columns];
        let mut random = Random::new(seed.wrapping_add(round.wrapping_mul(0xA076_1D64_78BD_642F)));
        // The first rounds go by size, later ones more and more by chance.
        let spread = if round < LEANS.len() as u64 { 0.0 } else { 0.15 * (1 + (round - 4) % 8) as f64 };
        // What is long finds no place late, and what is large neither.
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

    /// The rank of a place: the least comes first. `left` is what is left beside the item where it is
    /// tightest.
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
