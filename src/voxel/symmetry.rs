//! The symmetries of a cube.

use crate::error::Error;
use crate::lattice::Affine;
use crate::lattice::Each;

/// One of the 48 symmetries of a cube: a permutation of the axes, with some axes reversed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Symmetry {
    /// The old axis that becomes axis i.
    axes: [u8; 3],
    /// For each new axis i, whether it is reversed.
    flipped: [bool; 3],
}

impl Symmetry {
    /// The identity.
    pub const IDENTITY: Symmetry = Symmetry { axes: [0, 1, 2], flipped: [false; 3] };

    /// Makes the symmetry that turns the old axis `axes[i]` into the new axis i, reversed if `flipped[i]`.
    ///
    /// # Errors
    /// [`Error::Argument`] unless `axes` are 0, 1 and 2 in any order.
    pub fn new(axes: [u8; 3], flipped: [bool; 3]) -> Result<Symmetry, Error> {
        if axes.iter().fold(0u8, |bits, &axis| bits | 1u8.checked_shl(axis.into()).unwrap_or(0)) != 7 {
            return Err(Error::Argument { name: "axes", problem: "must be 0, 1 and 2 in any order" });
        }
        Ok(Symmetry { axes, flipped })
    }

    /// Returns all 48 symmetries; the first is the identity.
    pub fn all() -> impl Iterator<Item = Symmetry> {
        let orders = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [1, 0, 2], [0, 2, 1], [2, 1, 0]];
        orders.into_iter().flat_map(|axes| {
            (0..8u8).map(move |bits| Symmetry { axes, flipped: [0, 1, 2].each(|axis| bits >> axis & 1 != 0) })
        })
    }

    /// The old axis that becomes axis i.
    pub fn axes(self) -> [u8; 3] {
        self.axes
    }

    /// For each new axis i, whether it is reversed.
    pub fn flipped(self) -> [bool; 3] {
        self.flipped
    }

    /// The image of an octant.
    pub(super) fn octant(self, old: u8) -> u8 {
        (0..3).fold(0, |bits, axis| bits | ((old >> self.axes[axis] & 1) ^ self.flipped[axis] as u8) << axis)
    }

    /// The symmetry and the scale of a map whose matrix is a symmetry times a power of two.
    pub(super) fn of(map: &Affine) -> Option<(Symmetry, f64)> {
        let scale = map.rows()[0][..3].iter().fold(0.0, |most: f64, entry| most.max(entry.abs()));
        let (mut axes, mut flipped) = ([0; 3], [false; 3]);
        for (axis, row) in map.rows().iter().enumerate() {
            let mut entries = (0u8..).zip(&row[..3]).filter(|(_, entry)| **entry != 0.0);
            let (from, &entry) = entries.next()?;
            if entries.next().is_some() || entry.abs() != scale {
                return None;
            }
            (axes[axis], flipped[axis]) = (from, entry < 0.0);
        }
        let is_power = scale.to_bits() & ((1 << 52) - 1) == 0;
        let symmetry = Symmetry::new(axes, flipped).ok()?;
        is_power.then_some((symmetry, scale))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec::Vec;

    #[test]
    fn there_are_48_of_them_and_maps_are_told() {
        let all: Vec<Symmetry> = Symmetry::all().collect();
        assert_eq!((all.len(), all[0]), (48, Symmetry::IDENTITY));
        for (i, symmetry) in all.iter().enumerate() {
            assert!(!all[..i].contains(symmetry));
            let mut rows = [[0.0; 4]; 3];
            for axis in 0..3 {
                rows[axis][symmetry.axes[axis] as usize] = if symmetry.flipped[axis] { -0.25 } else { 0.25 };
                rows[axis][3] = 7.0;
            }
            assert_eq!(Symmetry::of(&Affine::new(rows).unwrap()), Some((*symmetry, 0.25)));
            rows[2] = rows[2].map(|entry| 2.0 * entry);
            assert_eq!(Symmetry::of(&Affine::new(rows).unwrap()), None);
        }
        let thrice = Affine::new([[3.0, 0.0, 0.0, 0.0], [0.0, 3.0, 0.0, 0.0], [0.0, 0.0, 3.0, 0.0]]).unwrap();
        assert_eq!(Symmetry::of(&thrice), None);
        assert!(
            Symmetry::new([0, 0, 1], [false; 3]).is_err() && Symmetry::new([0, 1, 99], [false; 3]).is_err()
        );
    }
}
