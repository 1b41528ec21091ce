//! Places for boxes in the free space between boxes.
//!
//! The free space of a box with boxes in it is the union of the largest free boxes. A new box goes to the
//! lower corner of a free box, and divides the free boxes that it meets (Lai & Chan 1997).

use crate::error::Error;
use crate::lattice::{Bounds, axes};
use crate::memory;
use alloc::vec::Vec;

/// The largest free boxes.
#[derive(Debug, Clone)]
pub(super) struct Free {
    boxes: Vec<Bounds>,
}

impl Free {
    pub(super) fn new(whole: &Bounds) -> Result<Free, Error> {
        let mut boxes = Vec::new();
        memory::push(&mut boxes, *whole)?;
        Ok(Free { boxes })
    }

    pub(super) fn boxes(&self) -> &[Bounds] {
        &self.boxes
    }

    /// Removes a box from the free space.
    pub(super) fn take(&mut self, taken: &Bounds) -> Result<(), Error> {
        let meets = |own: &Bounds| (0..3).all(|k| own.min[k] < taken.max[k] && taken.min[k] < own.max[k]);
        let mut pieces: Vec<Bounds> = Vec::new();
        let mut kept = 0;
        for i in 0..self.boxes.len() {
            let own = self.boxes[i];
            if !meets(&own) {
                self.boxes[kept] = own;
                kept += 1;
                continue;
            }
            for axis in 0..3 {
                if taken.min[axis] > own.min[axis] {
                    let max = axes(|k| if k == axis { taken.min[k] } else { own.max[k] });
                    memory::push(&mut pieces, Bounds { min: own.min, max })?;
                }
                if taken.max[axis] < own.max[axis] {
                    let min = axes(|k| if k == axis { taken.max[k] } else { own.min[k] });
                    memory::push(&mut pieces, Bounds { min, max: own.max })?;
                }
            }
        }
        self.boxes.truncate(kept);
        let holds = |a: &Bounds, b: &Bounds| (0..3).all(|k| a.min[k] <= b.min[k] && b.max[k] <= a.max[k]);
        for (i, piece) in pieces.iter().enumerate() {
            let is_held = self.boxes[..kept].iter().any(|own| holds(own, piece))
                || pieces
                    .iter()
                    .enumerate()
                    .any(|(j, other)| j != i && holds(other, piece) && (j < i || !holds(piece, other)));
            if !is_held {
                memory::push(&mut self.boxes, *piece)?;
            }
        }
        Ok(())
    }

    /// Removes free boxes with an edge shorter than `least`, which hold no item.
    pub(super) fn forget_below(&mut self, least: f64) {
        self.boxes.retain(|own| (0..3).all(|k| own.max[k] - own.min[k] >= least));
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::random::Random;
    use super::*;

    /// A point is in a free box if and only if it is in no taken box, and no free box contains another one.
    #[test]
    fn what_is_free_is_what_is_not_taken() {
        let mut random = Random::new(5);
        for _ in 0..40 {
            let whole = Bounds::new([0.0; 3], [8.0; 3]).unwrap();
            let mut free = Free::new(&whole).unwrap();
            let mut taken = Vec::new();
            for _ in 0..12 {
                let min: [f64; 3] = axes(|_| random.below(8) as f64);
                let size: [f64; 3] = axes(|_| 1.0 + random.below(3) as f64);
                let block = Bounds::new(min, axes(|k| min[k] + size[k])).unwrap();
                free.take(&block).unwrap();
                taken.push(block);
                let is_in = |list: &[Bounds], p: [f64; 3]| {
                    list.iter().any(|own| (0..3).all(|k| own.min[k] < p[k] && p[k] < own.max[k]))
                };
                for cell in 0..512 {
                    let p = [cell % 8, cell / 8 % 8, cell / 64].map(|c| c as f64 + 0.5);
                    assert_ne!(is_in(&taken, p), is_in(free.boxes(), p));
                }
                for (i, a) in free.boxes().iter().enumerate() {
                    for (j, b) in free.boxes().iter().enumerate() {
                        let holds = (0..3).all(|k| a.min[k] <= b.min[k] && b.max[k] <= a.max[k]);
                        assert!(i == j || !holds);
                    }
                }
            }
        }
    }
}
