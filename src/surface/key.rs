//! Keys of blocks of 4³ samples: numbers that ascend in Morton order.

use super::masks::bits;

/// The place of a block: the bits of its three coordinates, interleaved. Coordinates are biased, because some
/// blocks lie before the universe: they contain the dual cells between the first samples and the
/// surroundings.
pub(super) type Key = u64;

/// The bits of x.
const X: u64 = 0x1249_2492_4924_9249;

/// Returns the key of a block. `bias` is added to its coordinates.
#[cfg(test)]
pub(super) fn of(at: [i32; 3], bias: i32) -> Key {
    let spread = |v: i32| {
        let v = (v + bias) as u64;
        (0..20).fold(0, |word: u64, bit| word | (v >> bit & 1) << (3 * bit))
    };
    spread(at[0]) | spread(at[1]) << 1 | spread(at[2]) << 2
}

/// Returns the place of the block with a key.
#[inline(always)]
pub(super) fn position(key: Key, bias: i32) -> [i32; 3] {
    // Each step halves the gaps between the bits of one coordinate.
    let compact = |mut v: u64| {
        v &= X;
        v = (v | v >> 2) & 0x30C3_0C30_C30C_30C3;
        v = (v | v >> 4) & 0xF00F_00F0_0F00_F00F;
        v = (v | v >> 8) & 0x00FF_0000_FF00_00FF;
        v = (v | v >> 16) & 0xFFFF_0000_0000_FFFF;
        v = (v | v >> 32) & 0x1F_FFFF;
        v as i32 - bias
    };
    [compact(key), compact(key >> 1), compact(key >> 2)]
}

/// Returns the key of node j of the block.
#[inline(always)]
pub(super) fn node(key: Key, j: usize) -> Key {
    let mut result = key;
    for axis in 0..3 {
        if j >> axis & 1 != 0 {
            let own = X << axis;
            // The bits of the other axes pass the carry on.
            result = ((result | !own).wrapping_add(1 << axis) & own) | result & !own;
        }
    }
    result
}

/// Returns the first place from `from` on in an ascending list whose key is at least `key`. O(log of the
/// distance to that place).
#[inline(always)]
pub(super) fn seek<T>(list: &[T], from: usize, key: Key, key_of: impl Fn(&T) -> Key) -> usize {
    let rest = list.get(from..).unwrap_or_default();
    let mut width = 1;
    while width < rest.len() && key_of(&rest[width - 1]) < key {
        width *= 2;
    }
    let (low, high) = (width / 2, width.min(rest.len()));
    from + low + rest[low.min(high)..high].partition_point(|item| key_of(item) < key)
}

/// Returns the places of the nodes 1 to 7 of the block at place `own` of a list; `None` for nodes that are
/// not in the list. Only the nodes in `wanted` (bit j: node j) are searched for.
#[inline(always)]
pub(super) fn find_nodes<T>(
    list: &[T],
    own: usize,
    key: Key,
    wanted: u64,
    key_of: impl Fn(&T) -> Key + Copy,
) -> [Option<usize>; 8] {
    let mut nodes = [None; 8];
    nodes[0] = Some(own);
    for j in bits(wanted & 0xFE) {
        let sought = node(key, j as usize);
        let place = seek(list, own + 1, sought, key_of);
        nodes[j as usize] = list.get(place).is_some_and(|item| key_of(item) == sought).then_some(place);
    }
    nodes
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec::Vec;

    #[test]
    fn keys_tell_positions_and_neighbours() {
        let bias = 1 << 18;
        let mut blocks = Vec::new();
        let mut state = 1u64;
        for i in 0..4000 {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            let reach = if i % 2 == 0 { 6 } else { 1 << 18 };
            let at = [20, 35, 50].map(|shift| ((state >> shift) % reach) as i32 - 1);
            assert_eq!(position(of(at, bias), bias), at);
            for j in 0..8 {
                let beside = [0, 1, 2].map(|axis| at[axis] + (j >> axis & 1) as i32);
                assert_eq!(node(of(at, bias), j), of(beside, bias));
            }
            blocks.push(at);
        }
        blocks.sort_unstable();
        blocks.dedup();
        let mut keys: Vec<Key> = blocks.iter().map(|&at| of(at, bias)).collect();
        keys.sort_unstable();
        for (place, &key) in keys.iter().enumerate() {
            let nodes = find_nodes(&keys, place, key, 0xFF, |&key| key);
            for j in 0..8 {
                assert_eq!(nodes[j], keys.binary_search(&node(key, j)).ok());
            }
        }
    }
}
