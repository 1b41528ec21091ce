//! The moments of the solid, as they are stored.

use crate::lattice::Each;
use crate::lattice::{Interval, VolumeMoments};
use bytemuck::{Pod, Zeroable};

/// The moments of the source of an extended octree, if the source provided them without being split: the
/// point, and both ends of the volume, of the three first and of the six second moments.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct StoredMoments {
    pub point: [f64; 3],
    pub volume: [f64; 2],
    pub first: [[f64; 2]; 3],
    pub second: [[f64; 2]; 6],
}

impl StoredMoments {
    pub(crate) fn new(moments: &VolumeMoments) -> StoredMoments {
        // (Zero has one representation.)
        let ends = |own: Interval| [own.lower + 0.0, own.upper + 0.0];
        StoredMoments {
            point: moments.point.each(|c| c + 0.0),
            volume: ends(moments.volume),
            first: moments.first.each(ends),
            second: moments.second.each(ends),
        }
    }

    /// Returns the moments; `None` if they are damaged.
    pub(crate) fn moments(&self) -> Option<VolumeMoments> {
        let numbers: &[f64; 23] = bytemuck::cast_ref(self);
        let is_positive_zero = |c: &f64| *c != 0.0 || c.is_sign_positive();
        let interval = |[lower, upper]: [f64; 2]| Interval::new(lower, upper);
        let all = |own: &[[f64; 2]]| own.iter().all(|&ends| interval(ends).is_some());
        let is_sound = numbers.iter().all(|c| c.is_finite() && is_positive_zero(c))
            && self.volume[0] >= 0.0
            && all(&[self.volume])
            && all(&self.first)
            && all(&self.second);
        let interval = |[lower, upper]: [f64; 2]| Interval::between(lower, upper);
        is_sound.then(|| VolumeMoments {
            point: self.point,
            volume: interval(self.volume),
            first: self.first.each(interval),
            second: self.second.each(interval),
        })
    }
}
