//! The identification of half-spaces that are the same, wherever they come from: planes and quadrics whose
//! coefficients on the universe are proportional, with either sign, and other surfaces with the same numbers
//! and the same placement.
//!
//! So the truth tables of cells see coinciding surfaces. A solid minus itself is empty, and solids that touch
//! in a face have nothing in common, without a split.

use super::map::ExactMap;
use super::{HalfSpace, Placed, Surface};
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::hash::{Hash, Hasher};
use hashbrown::HashMap;

/// The half-spaces met so far, indexed by keys that equal half-spaces share.
#[derive(Default)]
pub(crate) struct Identities {
    /// The last plane or quadric with about this likeness. `before` has for each the one before it.
    last: HashMap<i64, u32>,
    before: Vec<u32>,
    others: HashMap<Exactly, u32>,
}

/// Marks that there is no earlier one.
const NONE: u32 = u32::MAX;

/// The number of steps of likeness per unit: about 10⁹. A likeness is precise to `KNOWN` steps.
const STEPS: f64 = (1u64 << 30) as f64;
const KNOWN: f64 = 1e-3;

/// The most candidates with nearly the same likeness that are compared. (A missed match costs only time.)
const MOST: usize = 16;

impl Identities {
    /// Returns the number of the same half-space among `known`, and whether it is the complement. If there is
    /// none, the number is the next one. O(1).
    pub(crate) fn find(
        &mut self,
        half_space: &HalfSpace,
        map: &Arc<ExactMap>,
        placed: &Placed,
        known: &[Placed],
    ) -> Result<(u32, bool), Error> {
        let next = known.len() as u32;
        let Some(likeness) = placed.likeness() else {
            self.others.try_reserve(1)?;
            let exactly = Exactly { half_space: half_space.clone(), map: map.clone() };
            let found = *self.others.entry(exactly).or_insert(next);
            if found == next {
                memory::push(&mut self.before, NONE)?;
            }
            return Ok((found, false));
        };
        let step = |room: f64| libm::floor(likeness * STEPS + room) as i64;
        let (own, low, high) = (step(0.0), step(-KNOWN), step(KNOWN));
        for step in low..=high {
            let mut number = self.last.get(&step).copied().unwrap_or(NONE);
            for _ in 0..MOST {
                let Some(other) = known.get(number as usize) else { break };
                if let Some(is_turned) = other.is_turned(placed) {
                    return Ok((number, is_turned));
                }
                number = self.before[number as usize];
            }
        }
        self.last.try_reserve(1)?;
        memory::push(&mut self.before, NONE)?;
        self.before[next as usize] = self.last.insert(own, next).unwrap_or(NONE);
        Ok((next, false))
    }
}

/// A half-space and its placement, compared by their exact numbers.
struct Exactly {
    half_space: HalfSpace,
    map: Arc<ExactMap>,
}

impl PartialEq for Exactly {
    fn eq(&self, other: &Exactly) -> bool {
        let is_same = match (&*self.half_space.0, &*other.half_space.0) {
            (Surface::Powers(a), Surface::Powers(b)) => a == b,
            (Surface::Torus(a), Surface::Torus(b)) => a == b,
            (Surface::Host(a), Surface::Host(b)) => Arc::ptr_eq(a, b),
            _ => false,
        };
        is_same && (Arc::ptr_eq(&self.map, &other.map) || self.map == other.map)
    }
}

impl Eq for Exactly {}

impl Hash for Exactly {
    fn hash<H: Hasher>(&self, state: &mut H) {
        match &*self.half_space.0 {
            Surface::Plane(coefficients) => coefficients.hash(state),
            Surface::Quadric(coefficients) => coefficients.hash(state),
            Surface::Torus(torus) => torus.hash(state),
            Surface::Powers(powers) => {
                for (coefficient, centre, exponent) in powers.terms {
                    // Zero has two signs, which are equal.
                    ([coefficient, centre].each(|x| (x + 0.0).to_bits()), exponent).hash(state);
                }
                (powers.constant + 0.0).to_bits().hash(state);
            }
            Surface::Host(host) => Arc::as_ptr(host).hash(state),
            Surface::Slab(_) => core::ptr::from_ref(&*self.half_space.0).hash(state),
        }
        self.map.hash(state);
    }
}
