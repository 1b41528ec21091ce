//! The distances along a row between its cells and the other side.

/// A square in half cells. The sign is the side: members of the set have negative values.
pub(super) type Signed = i32;

/// The other side is empty.
pub(super) const NONE: Signed = i32::MAX;

/// Returns the first place from `from` on, below `end`, at which a row's bit differs from `side` (all ones or
/// zeros).
fn next(row: &[u64], side: u64, from: usize, end: usize) -> Option<usize> {
    let mut word = from / 64;
    let mut differs = (row.get(word)? ^ side) & (!0 << (from % 64));
    while differs == 0 {
        word += 1;
        differs = row.get(word)? ^ side;
    }
    let found = 64 * word + differs.trailing_zeros() as usize;
    (found < end).then_some(found)
}

/// Returns the last place before `before` at which a row's bit differs from `side`.
fn last(row: &[u64], side: u64, before: usize) -> Option<usize> {
    let below = before % 64;
    let mut word = before / 64;
    let mut differs = if below == 0 { 0 } else { (row.get(word)? ^ side) & ((1 << below) - 1) };
    while differs == 0 {
        word = word.checked_sub(1)?;
        differs = row.get(word)? ^ side;
    }
    Some(64 * word + 63 - differs.leading_zeros() as usize)
}

/// Computes the signed squares of the distances of `signed.len()` cells of a row, from `first` on, from the
/// nearest of the row's `length` cells on the other side.
pub(super) fn along(row: &[u64], length: usize, first: usize, signed: &mut [Signed]) {
    let end = first + signed.len();
    let side_at = |place: usize| 0u64.wrapping_sub(row[place / 64] >> (place % 64) & 1);
    let mut from = first;
    let mut before = last(row, side_at(first), first);
    while from < end {
        let side = side_at(from);
        let after = next(row, side, from, length);
        let to = after.unwrap_or(end).min(end);
        for place in from..to {
            let below = before.map_or(usize::MAX, |before| place - before);
            let cells = below.min(after.map_or(usize::MAX, |after| after - place));
            let square = if cells == usize::MAX { NONE } else { (2 * cells as Signed - 1).pow(2) };
            signed[place - first] = if side == 0 { square } else { -square };
        }
        (from, before) = (to, Some(to.wrapping_sub(1)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;
    use alloc::vec::Vec;

    #[test]
    fn rows_against_their_definition() {
        let mut state = 5u64;
        let mut random = |below: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % below
        };
        for _ in 0..2000 {
            let length = 1 + random(200) as usize;
            let mut row: Vec<u64> = vec![0; length.div_ceil(64)];
            let (mut member, turns) = (random(2) == 1, 1 + random(60));
            for place in 0..length {
                if random(turns) == 0 {
                    member = !member;
                }
                row[place / 64] |= u64::from(member) << (place % 64);
            }
            let bit = |place: usize| row[place / 64] >> (place % 64) & 1;
            let first = random(length as u64) as usize;
            let mut signed = vec![0; 1 + random((length - first) as u64) as usize];
            along(&row, length, first, &mut signed);
            for (k, &found) in signed.iter().enumerate() {
                let place = first + k;
                let others = (0..length).filter(|&other| bit(other) != bit(place));
                let square =
                    others.map(|other| (2 * other.abs_diff(place) as i32 - 1).pow(2)).min().unwrap_or(NONE);
                assert_eq!(found, if bit(place) == 1 { -square } else { square });
            }
        }
    }
}
