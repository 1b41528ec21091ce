//! Samples of 4³ blocks as words, and shifts to neighbouring samples.
//!
//! The eight *nodes* of a block are the block itself and its neighbours towards +x, +y and +z: node j lies j
//! & 1 blocks further along x, j >> 1 & 1 along y, j >> 2 along z. A dual cell belongs to the block of its
//! lowest sample.

use crate::lattice::morton::{self, SLAB};

/// The cells of a block for which the cell one place further along `axis` is set; `beyond` is the
/// neighbouring block there.
#[inline(always)]
pub(super) const fn next(own: u64, beyond: u64, axis: usize) -> u64 {
    // The first slab of the block beyond adjoins the last slab of this block.
    morton::shifted(own, axis, false) | (beyond & SLAB[axis][0]) << (9 << axis)
}

/// The samples at each corner of the dual cells: bit c of word j is corner j of dual cell c.
#[inline(always)]
pub(super) fn corners(nodes: [u64; 8]) -> [u64; 8] {
    let mut words = nodes;
    for axis in 0..3 {
        // Corners that are further along this axis come from the nodes that are further along it. Corners and
        // nodes on the axes before and after this one stay separate.
        for j in 0..8 {
            if j >> axis & 1 == 0 {
                words[j | 1 << axis] = next(words[j], words[j | 1 << axis], axis);
            }
        }
    }
    words
}

/// The cells that are set in all words.
#[inline(always)]
pub(super) fn all(words: &[u64; 8]) -> u64 {
    words.iter().fold(!0, |all, word| all & word)
}

/// The cells that are set in at least one word.
#[inline(always)]
pub(super) fn any(words: &[u64; 8]) -> u64 {
    words.iter().fold(0, |any, word| any | word)
}

/// The configuration of dual cell `c`.
#[inline(always)]
pub(super) fn configuration(corners: &[u64; 8], c: u32) -> usize {
    (0..8).fold(0, |configuration, j| configuration | ((corners[j] >> c & 1) as usize) << j)
}

/// `CORNER_AT[c][j]`: the node that contains corner j of dual cell c, and the corner's number in that node.
pub(super) const CORNER_AT: [[(u8, u8); 8]; 64] = {
    let mut table = [[(0, 0); 8]; 64];
    let mut i = 0;
    while i < 512 {
        let (c, j) = (i / 8, i % 8);
        let at = morton::position(c as u32);
        let (mut node, mut axis, mut inner) = (0, 0, [0; 3]);
        while axis < 3 {
            let place = at[axis] + (j >> axis & 1) as u32;
            node |= ((place >> 2) << axis) as u8;
            inner[axis] = place & 3;
            axis += 1;
        }
        table[c][j] = (node, morton::index(inner[0], inner[1], inner[2]) as u8);
        i += 1;
    }
    table
};

/// The numbers of the set bits, in ascending order.
#[inline(always)]
pub(super) fn bits(mut word: u64) -> impl Iterator<Item = u32> {
    core::iter::from_fn(move || {
        let bit = word.trailing_zeros();
        (word != 0).then(|| {
            word &= word - 1;
            bit
        })
    })
}

/// The number of set bits before bit `c`.
#[inline(always)]
pub(super) fn rank(word: u64, c: u32) -> u32 {
    (word & ((1 << c) - 1)).count_ones()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_found_by_shifting() {
        let mut state = 5u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            state ^ state >> 29
        };
        for _ in 0..200 {
            let nodes: [u64; 8] = core::array::from_fn(|_| random());
            let words = corners(nodes);
            for c in 0..64 {
                for j in 0..8 {
                    let (node, inner) = CORNER_AT[c][j];
                    let expected = nodes[node as usize] >> inner & 1;
                    assert_eq!(words[j] >> c & 1, expected, "corner {j} of cell {c}");
                    assert_eq!(configuration(&words, c as u32) >> j & 1, expected as usize);
                }
            }
            let word = nodes[0];
            assert!(
                bits(word).enumerate().all(|(n, bit)| rank(word, bit) == n as u32 && word >> bit & 1 == 1)
            );
            assert_eq!(bits(word).count() as u32, word.count_ones());
        }
    }
}
