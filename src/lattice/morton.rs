//! Morton order on 4 × 4 × 4 blocks, which are the granularity of storage.
//!
//! The position of a cell within its block of 64 interleaves two bits per axis: bits 0 to 2 are the low bits
//! of x, y, z, bits 3 to 5 the high bits. So byte k of a 64-bit plane is octant k.

/// Two bits v = 0..=3 spread to Morton bits 0 and 3.
#[inline(always)]
pub const fn spread(v: u32) -> u32 {
    (v * 5) & 0b1001
}

/// Index within the block of 64 of the cell at (x, y, z), each taken modulo 4.
#[inline(always)]
pub const fn index(x: u32, y: u32, z: u32) -> u32 {
    spread(x & 3) | spread(y & 3) << 1 | spread(z & 3) << 2
}

/// Position (x, y, z), each 0..=3, of cell `index` of a block.
#[inline(always)]
pub const fn position(index: u32) -> [u32; 3] {
    [(index & 1) | (index >> 2 & 2), (index >> 1 & 1) | (index >> 3 & 2), (index >> 2 & 1) | (index >> 4 & 2)]
}

const fn slab(axis: u32, at: u32) -> u64 {
    let mut mask = 0;
    let mut i = 0;
    while i < 64 {
        if position(i)[axis as usize] == at {
            mask |= 1 << i;
        }
        i += 1;
    }
    mask
}

/// `SLAB[axis][k]`: the 16 cells of a block whose coordinate along `axis` is k.
pub const SLAB: [[u64; 4]; 3] = {
    let mut slabs = [[0; 4]; 3];
    let mut axis = 0;
    while axis < 3 {
        let mut at = 0;
        while at < 4 {
            slabs[axis][at] = slab(axis as u32, at as u32);
            at += 1;
        }
        axis += 1;
    }
    slabs
};

/// `SLABS[axis][first][last]`: the cells of a block whose coordinate along `axis` lies in `first..=last`
/// (none if `first > last`).
pub const SLABS: [[[u64; 4]; 4]; 3] = {
    let mut slabs = [[[0; 4]; 4]; 3];
    let mut axis = 0;
    while axis < 3 {
        let mut first = 0;
        while first < 4 {
            let (mut cells, mut last) = (0, first);
            while last < 4 {
                cells |= SLAB[axis][last];
                slabs[axis][first][last] = cells;
                last += 1;
            }
            first += 1;
        }
        axis += 1;
    }
    slabs
};

/// The cells of a block whose coordinate along `axis` lies in `first..=last` (empty if `first > last`).
#[inline]
pub fn slabs(axis: usize, first: u32, last: u32) -> u64 {
    SLABS[axis][first as usize][last as usize]
}

/// The cells of `mask`, moved one place up along `axis`, or one place down if not `up`. Cells that leave the
/// block are dropped.
#[inline(always)]
pub const fn shifted(mask: u64, axis: usize, up: bool) -> u64 {
    let [first, second, third, last] = SLAB[axis];
    // From place 0 to 1 and from 2 to 3 a bit moves by one position of its axis; from 1 to 2 it moves by
    // seven.
    let (one, seven) = (1 << axis, 7 << axis);
    if up {
        (mask & (first | third)) << one | (mask & second) << seven
    } else {
        (mask & (second | last)) >> one | (mask & third) >> seven
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn index_and_position_are_inverse() {
        for i in 0..64 {
            let [x, y, z] = position(i);
            assert_eq!(index(x, y, z), i);
            assert_eq!(SLAB[0][x as usize] >> i & SLAB[1][y as usize] >> i & SLAB[2][z as usize] >> i & 1, 1);
        }
        for i in 0..64 {
            for axis in 0..3 {
                let mut place = position(i);
                for (up, end) in [(true, 3), (false, 0)] {
                    place[axis] = if up { position(i)[axis] + 1 } else { position(i)[axis].wrapping_sub(1) };
                    let [x, y, z] = place;
                    let beside = if position(i)[axis] == end { 0 } else { 1 << index(x, y, z) };
                    assert_eq!(shifted(1 << i, axis, up), beside);
                }
            }
        }
        assert_eq!(slabs(0, 0, 3), !0);
        assert_eq!(slabs(2, 2, 1), 0);
    }
}
