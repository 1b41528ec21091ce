//! The orientations of items.

use super::random::Random;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::lattice::{Affine, axes};
use crate::memory;
use alloc::vec::Vec;

/// The allowed orientations of an item.
#[derive(Debug, Clone, PartialEq)]
pub enum Orientations {
    /// Only the given orientation.
    AsGiven,
    /// The 24 rotations that map axes to axes. They are exact.
    Turns,
    /// The given orientation, and this number of random rotations, at least 1 and at most
    /// [`MOST`](Orientations::MOST). The random rotations are uniformly distributed over all rotations and
    /// depend on the seed of the search.
    Free(u32),
    /// The rotations of a list. Only the linear part of a map counts, which must be a rotation: see
    /// [`Item::with_orientations`](super::Item).
    List(Vec<Affine>),
}

/// The greatest relative change of lengths by a matrix that still counts as a rotation.
pub(super) const STRETCH: f64 = 1e-9;

impl Orientations {
    /// The greatest number of orientations of one item: a search keeps the cells of the item in each of them.
    pub const MOST: u32 = 1 << 12;

    pub(super) fn try_clone(&self) -> Result<Orientations, Error> {
        Ok(match self {
            Orientations::AsGiven => Orientations::AsGiven,
            Orientations::Turns => Orientations::Turns,
            Orientations::Free(count) => Orientations::Free(*count),
            Orientations::List(list) => Orientations::List(memory::copied(list)?),
        })
    }

    /// Returns the maps, all of which fix the origin.
    pub(super) fn maps(&self, seed: u64) -> Result<Vec<Affine>, Error> {
        let mut maps = Vec::new();
        match self {
            Orientations::AsGiven => memory::push(&mut maps, Affine::IDENTITY)?,
            Orientations::Turns => {
                for turn in turns() {
                    memory::push(&mut maps, turn)?;
                }
            }
            Orientations::Free(count) => {
                memory::push(&mut maps, Affine::IDENTITY)?;
                let mut random = Random::new(seed);
                for _ in 0..*count {
                    memory::push(&mut maps, any(&mut random)?)?;
                }
            }
            Orientations::List(list) => {
                for map in list {
                    let own = Affine::new(map.rows().each(|[x, y, z, _]| [x, y, z, 0.0]))?;
                    memory::push(&mut maps, own)?;
                }
            }
        }
        Ok(maps)
    }
}

/// Returns an upper bound of the relative change of lengths by a map.
pub(super) fn stretch(map: &Affine) -> f64 {
    // The eigenvalues of MᵀM are at most this far from 1, and their roots are no further.
    let entry = |i: usize, j: usize| {
        let parts = map.rows().each(|row| row[i] * row[j]);
        let size = parts.iter().map(|part| part.abs()).sum::<f64>();
        let unit = if i == j { 1.0 } else { 0.0 };
        let off = (parts.iter().sum::<f64>() - unit).abs();
        let is_exact = parts.iter().all(|part| libm::floor(*part) == *part);
        if is_exact { off } else { off + 8.0 * f64::EPSILON * (size + unit) }
    };
    (0..3).fold(0.0, |most: f64, i| most.max((0..3).map(|j| entry(i, j)).sum()))
}

/// True if a map rotates and moves, but neither stretches nor mirrors.
pub(super) fn is_motion(map: &Affine) -> bool {
    map.orientation() == 1 && stretch(map) <= STRETCH
}

/// The 24 rotations that map axes to axes; the identity comes first.
pub(super) fn turns() -> impl Iterator<Item = Affine> {
    const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [1, 0, 2], [0, 2, 1], [2, 1, 0]];
    let all = ORDERS.into_iter().enumerate().flat_map(|(k, order)| {
        (0..8usize).filter(move |signs| (signs.count_ones() % 2 == 1) == (k >= 3)).map(move |signs| {
            axes(|i| {
                let mut row = [0.0; 4];
                row[order[i]] = if signs >> i & 1 == 0 { 1.0 } else { -1.0 };
                row
            })
        })
    });
    all.filter_map(|rows| Affine::new(rows).ok())
}

/// A random rotation: a point of the sphere of quaternions, taken from the cube around it.
fn any(random: &mut Random) -> Result<Affine, Error> {
    let (q, square) = loop {
        let q: [f64; 4] = core::array::from_fn(|_| 2.0 * random.part() - 1.0);
        let square = q.iter().map(|c| c * c).sum::<f64>();
        if (0.01..=1.0).contains(&square) {
            break (q, square);
        }
    };
    let [w, x, y, z] = q.each(|c| c / sqrt(square));
    Affine::new([
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y), 0.0],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x), 0.0],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y), 0.0],
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_24_turns() {
        let all: Vec<Affine> = turns().collect();
        assert_eq!(all.len(), 24);
        assert!(all[0].is_identity());
        for (k, turn) in all.iter().enumerate() {
            assert!(turn.orientation() == 1 && stretch(turn) == 0.0);
            assert!(!all[..k].contains(turn));
        }
    }

    #[test]
    fn chance_makes_turns() {
        let maps = Orientations::Free(200).maps(7).unwrap();
        assert_eq!(maps.len(), 201);
        assert!(maps.iter().all(|map| is_motion(map) && stretch(map) < 1e-14));
        assert_eq!(maps, Orientations::Free(200).maps(7).unwrap());
        assert_ne!(maps, Orientations::Free(200).maps(8).unwrap());
    }

    #[test]
    fn what_stretches_is_no_turn() {
        let map = |rows: [[f64; 3]; 3]| Affine::new(rows.map(|[x, y, z]| [x, y, z, 5.0])).unwrap();
        assert!(!is_motion(&map([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.001]])));
        assert!(!is_motion(&map([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]])));
        assert!(!is_motion(&map([[1.0, 1e-6, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])));
        let doubled = map([[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]]);
        assert!(stretch(&doubled) >= 1.0);
        assert!(is_motion(&map([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])));
    }
}
