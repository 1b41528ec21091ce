//! Dictionaries of bricks.
//!
//! A smooth surface cuts 4³ cells in few ways. So most bricks of a tree are repetitions, and a 16-bit index
//! into the distinct bricks is four or eight times smaller. A fixed rule decides, so that equal solids have
//! equal files: fewest bytes among raw bricks, one dictionary for all bricks, and dictionaries for segments
//! of 2^k bricks by descending k, in this order where sizes tie. Entries are sorted by descending frequency,
//! then value.

use super::brick::{Brick, BrickArray, Bricks, OwnedArray, OwnedBricks};
use super::view::OctreeRef;
use crate::error::{Damage, Error};
use crate::memory;
use alloc::vec::Vec;
use hashbrown::{HashMap, HashSet};

/// Most entries that a 16-bit index can name.
const MOST: usize = 1 << 16;

/// Bricks of a segment if there is only one segment: 2^63 is more than any number.
pub(crate) const WHOLE: u8 = 63;

/// Returns the bytes of `bricks` bricks as `entries` entries in `segments` segments.
fn bytes<T>(bricks: usize, entries: usize, segments: usize) -> usize {
    size_of::<u16>() * bricks + size_of::<T>() * entries + size_of::<u64>() * segments
}

/// Returns the bricks in the encoding that the rule demands; `None` if they are raw and stay raw, so that
/// they need not be copied.
///
/// # Errors
///
/// [`Error::OutOfMemory`], and [`Error::Damaged`] if a brick cannot be read.
pub(crate) fn encode(bricks: &Bricks<'_>) -> Result<Option<OwnedBricks>, Error> {
    Ok(match bricks {
        Bricks::One(bricks) => encode_array(bricks)?.map(OwnedBricks::One),
        Bricks::Two(bricks) => encode_array(bricks)?.map(OwnedBricks::Two),
    })
}

fn encode_array<T: Brick>(bricks: &BrickArray<'_, T>) -> Result<Option<OwnedArray<T>>, Error> {
    let decoded = match bricks {
        BrickArray::Raw(raw) => return shortest(raw),
        BrickArray::Dictionary { .. } => {
            let mut raw = memory::with_capacity(bricks.len())?;
            if !bricks.extend(0..bricks.len(), &mut raw, |brick| brick) {
                let bad = (0..bricks.len()).find(|&b| bricks.get(b).is_none()).unwrap_or(0);
                return Err(Damage::Dictionary { brick: bad as u64 }.into());
            }
            raw
        }
    };
    Ok(Some(shortest(&decoded)?.unwrap_or(OwnedArray::Raw(decoded))))
}

/// Returns the bricks through the dictionary that the rule demands; `None` if it demands raw bricks.
fn shortest<T: Brick>(raw: &[T]) -> Result<Option<OwnedArray<T>>, Error> {
    // Halving the segments never makes the sum of their dictionaries smaller, so the first size that fits
    // 16-bit indices is the smallest.
    if raw.is_empty() {
        return Ok(None);
    }
    let longest = raw.len().next_power_of_two().trailing_zeros().saturating_sub(1) as u8;
    for shift in core::iter::once(WHOLE).chain((16..=longest).rev()) {
        match segmented(raw, shift)? {
            Segmented::Fits(coded) => return Ok(Some(coded)),
            Segmented::Longer => return Ok(None),
            Segmented::TooManyEntries => {}
        }
    }
    Ok(None)
}

/// The result for segments of one size.
enum Segmented<T> {
    /// A dictionary, shorter than raw bricks.
    Fits(OwnedArray<T>),
    /// No shorter than raw bricks.
    Longer,
    /// An index would not fit.
    TooManyEntries,
}

/// Encodes the bricks in segments of 2^shift.
fn segmented<T: Brick>(raw: &[T], shift: u8) -> Result<Segmented<T>, Error> {
    let length = if shift == WHOLE { raw.len().max(1) } else { 1 << shift };
    let mut indices: Vec<u16> = memory::with_capacity(raw.len())?;
    let mut entries: Vec<T> = Vec::new();
    let mut segments: Vec<u64> = memory::with_capacity(raw.len().div_ceil(length))?;
    let mut seen: HashMap<T, u32> = HashMap::new();
    let mut counts: Vec<u64> = Vec::new();
    let mut distinct: Vec<T> = Vec::new();
    for segment in raw.chunks(length) {
        seen.clear();
        counts.clear();
        distinct.clear();
        let first = indices.len();
        // Indices are first assigned in order of appearance, and renamed once the frequencies are known.
        for &brick in segment {
            let fresh = counts.len();
            seen.try_reserve(1)?;
            let index = *seen.entry(brick).or_insert(fresh as u32) as usize;
            if index == fresh {
                if fresh == MOST {
                    return Ok(Segmented::TooManyEntries);
                }
                counts.try_reserve(1)?;
                distinct.try_reserve(1)?;
                counts.push(0);
                distinct.push(brick);
            }
            counts[index] += 1;
            indices.push(index as u16);
        }
        let mut order: Vec<u16> = memory::with_capacity(distinct.len())?;
        order.extend((0..=u16::MAX).take(distinct.len()));
        let key = |&i: &u16| (core::cmp::Reverse(counts[i as usize]), distinct[i as usize]);
        order.sort_unstable_by_key(key);
        let mut rename = memory::filled(order.len(), 0u16)?;
        for (new, &old) in order.iter().enumerate() {
            rename[old as usize] = new as u16;
        }
        indices[first..].iter_mut().for_each(|index| *index = rename[*index as usize]);
        segments.push(entries.len() as u64);
        entries.try_reserve(order.len())?;
        entries.extend(order.iter().map(|&i| distinct[i as usize]));
        // The encoding is already no shorter than raw bricks; further segments, or smaller ones, will not
        // make it shorter.
        if bytes::<T>(raw.len(), entries.len(), segments.len()) >= size_of_val(raw) {
            return Ok(Segmented::Longer);
        }
    }
    Ok(Segmented::Fits(OwnedArray::Dictionary { indices, entries, segments, shift }))
}

/// Checks that the dictionary, if there is one, is the one that the bricks determine.
///
/// # Errors
///
/// [`Error::Damaged`]; [`Error::OutOfMemory`], because entries are counted and compared, a segment at a time.
pub(crate) fn check(tree: &OctreeRef<'_>) -> Result<(), Error> {
    match &tree.bricks {
        Bricks::One(bricks) => check_array(bricks),
        Bricks::Two(bricks) => check_array(bricks),
    }
}

fn check_array<T: Brick>(bricks: &BrickArray<'_, T>) -> Result<(), Error> {
    let BrickArray::Dictionary { indices, entries, segments, shift } = *bricks else { return Ok(()) };
    // Segments longer than the address space are one segment.
    let length = 1usize.checked_shl(shift.into()).unwrap_or(usize::MAX);
    if segments.len() != indices.len().div_ceil(length) {
        return Err(Damage::Dictionary { brick: 0 }.into());
    }
    let mut expected = 0;
    for (s, indices) in indices.chunks(length).enumerate() {
        let brick = (s * length) as u64;
        let end = segments.get(s + 1).map_or(entries.len() as u64, |&end| end);
        let range = segments[s] as usize..usize::try_from(end).unwrap_or(usize::MAX);
        let own = entries.get(range).filter(|own| own.len() <= MOST).ok_or(Damage::Dictionary { brick })?;
        if segments[s] != expected {
            return Err(Damage::Dictionary { brick }.into());
        }
        let mut counts = memory::filled(own.len(), 0u64)?;
        for (b, &index) in indices.iter().enumerate() {
            match counts.get_mut(index as usize) {
                Some(count) => *count += 1,
                None => return Err(Damage::Dictionary { brick: brick + b as u64 }.into()),
            }
        }
        let mut distinct = HashSet::new();
        distinct.try_reserve(own.len())?;
        let key = |i: usize| (core::cmp::Reverse(counts[i]), own[i]);
        // Equal entries with different counts are not adjacent.
        let right = |i: usize, fresh: bool| fresh && counts[i] != 0 && (i == 0 || key(i - 1) < key(i));
        if let Some(i) = (0..own.len()).find(|&i| !right(i, distinct.insert(own[i]))) {
            return Err(Damage::DictionaryOrder { entry: expected + i as u64 }.into());
        }
        expected = end;
    }
    if expected == entries.len() as u64 {
        Ok(())
    } else {
        Err(Damage::DictionaryOrder { entry: expected }.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;

    fn indices(coded: &OwnedArray<u64>) -> (&[u16], &[u64], &[u64], u8) {
        match coded {
            OwnedArray::Dictionary { indices, entries, segments, shift } => {
                (indices, entries, segments, *shift)
            }
            OwnedArray::Raw(_) => panic!("expected a dictionary"),
        }
    }

    #[test]
    fn entries_stand_by_frequency_then_value() {
        let raw: Vec<u64> = [9, 5, 5, 7, 7, 1, 1, 1].repeat(4);
        let coded = encode_array(&BrickArray::Raw(&raw)).unwrap().unwrap();
        let (found, entries, segments, shift) = indices(&coded);
        assert_eq!((entries, segments, shift), (&[1, 5, 7, 9][..], &[0][..], WHOLE));
        assert_eq!(&found[..8], &[3, 1, 1, 2, 2, 0, 0, 0]);
        check_array(&coded.view()).unwrap();
        let mut back = Vec::new();
        assert!(coded.view().extend(0..raw.len(), &mut back, |brick| brick));
        assert_eq!(back, raw);
    }

    #[test]
    fn few_or_all_different_bricks_stay_raw() {
        for raw in [vec![], vec![7], vec![3, 3], (0..500).collect()] {
            assert!(encode_array(&BrickArray::Raw(&raw)).unwrap().is_none());
        }
    }

    #[test]
    fn more_than_65536_distinct_bricks_need_segments() {
        // 4 · 50 000 bricks, each quarter with its own 25 000 values: one dictionary cannot hold 100 000.
        let raw: Vec<u64> = (0..200_000u64).map(|b| (b / 50_000) * 1_000_000 + b % 25_000).collect();
        let coded = encode_array(&BrickArray::Raw(&raw)).unwrap().unwrap();
        let (_, entries, segments, shift) = indices(&coded);
        assert_eq!((shift, segments.len()), (16, 4));
        assert!(entries.len() > 100_000);
        check_array(&coded.view()).unwrap();
        for b in [0, 49_999, 65_535, 65_536, 131_071, 131_072, 199_999] {
            assert_eq!(coded.view().get(b), Some(raw[b]));
        }
        assert_eq!(coded.view().get(200_000), None);
    }

    #[test]
    fn damaged_dictionaries_are_found() {
        let good = (vec![0u16, 0, 1], vec![4u64, 2], vec![0u64], WHOLE);
        type Parts = (Vec<u16>, Vec<u64>, Vec<u64>, u8);
        let verdict = |change: &dyn Fn(&mut Parts)| {
            let mut parts = good.clone();
            change(&mut parts);
            let (indices, entries, segments, shift) = parts;
            match check_array(&OwnedArray::Dictionary { indices, entries, segments, shift }.view()) {
                Ok(()) => Ok(()),
                Err(Error::Damaged(damage)) => Err(damage),
                Err(other) => panic!("{other}"),
            }
        };
        assert_eq!(verdict(&|_| ()), Ok(()));
        assert_eq!(verdict(&|d| d.0[0] = 2), Err(Damage::Dictionary { brick: 0 }));
        assert_eq!(verdict(&|d| d.0[0] = 1), Err(Damage::DictionaryOrder { entry: 1 }));
        assert_eq!(verdict(&|d| d.1.push(1)), Err(Damage::DictionaryOrder { entry: 2 }));
        assert_eq!(verdict(&|d| d.1[1] = 4), Err(Damage::DictionaryOrder { entry: 1 }));
        assert_eq!(verdict(&|d| d.2[0] = 1), Err(Damage::Dictionary { brick: 0 }));
        assert_eq!(verdict(&|d| d.2.push(1)), Err(Damage::Dictionary { brick: 0 }));
        assert_eq!(verdict(&|d| d.3 = 1), Err(Damage::Dictionary { brick: 0 }));
    }
}
