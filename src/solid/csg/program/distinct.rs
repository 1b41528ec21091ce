//! Removal of equal operands: in a union or an intersection, the same operand twice is that operand; in a
//! parity, it cancels. So a scene of thousands of equal parts costs as much as one of them, and coincident
//! faces leave nothing undecided.

use super::hierarchy::Operand;
use super::word::Word;
use crate::error::Error;
use crate::memory;
use crate::solid::csg::Join;
use alloc::vec::Vec;
use core::ops::Range;
use hashbrown::HashMap;
use hashbrown::hash_map::Entry;

/// Removes the operands from `first` on that change nothing because an equal operand comes before them. In a
/// parity, pairs of equal operands are removed.
///
/// O(operands) if all operands have different lengths. Otherwise, only operands that are as long as another
/// one are read. The joined result is at least twice as long as such an operand. So no word of an expression
/// is read more often than the logarithm of the expression's length, however deep it is nested.
pub(crate) fn reduce(
    join: Join,
    first: usize,
    operands: &mut Vec<Operand>,
    words: &mut Vec<Word>,
) -> Result<(), Error> {
    let own = &operands[first..];
    if own.len() < 2 {
        return Ok(());
    }
    let range =
        |i: usize| -> Range<usize> { own[i].start..own.get(i + 1).map_or(words.len(), |next| next.start) };
    let mut lengths: HashMap<usize, u32> = HashMap::new();
    lengths.try_reserve(own.len())?;
    for i in 0..own.len() {
        *lengths.entry(range(i).len()).or_insert(0) += 1;
    }
    if lengths.len() == own.len() {
        return Ok(());
    }
    let like_others = || (0..own.len()).filter(|&i| lengths[&range(i).len()] > 1);
    // The number of occurrences of each operand, at the place of the first occurrence.
    let mut counts: Vec<u32> = memory::filled(own.len(), 1)?;
    let mut seen: HashMap<&[Word], usize> = HashMap::new();
    seen.try_reserve(own.len())?;
    for i in like_others() {
        match seen.entry(&words[range(i)]) {
            Entry::Occupied(entry) => {
                counts[i] = 0;
                counts[*entry.get()] += 1;
            }
            Entry::Vacant(entry) => _ = entry.insert(i),
        }
    }
    drop(seen);
    if counts.iter().all(|&count| count == 1) {
        return Ok(());
    }
    let is_kept = |i: usize| if join == Join::Parity { counts[i] % 2 == 1 } else { counts[i] > 0 };
    let mut kept = memory::with_capacity(own.len())?;
    kept.extend((0..own.len()).filter(|&i| is_kept(i)).map(|i| (i, range(i))));
    let (mut to, mut number) = (own[0].start, first);
    for (i, range) in kept {
        let length = range.len();
        words.copy_within(range, to);
        operands.swap(number, first + i);
        operands[number].start = to;
        (to, number) = (to + length, number + 1);
    }
    words.truncate(to);
    operands.truncate(number);
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::control::Control;
    use crate::lattice::{Affine, Frame};
    use crate::solid::Csg;
    use crate::solid::csg::program::Program;
    use alloc::vec::Vec;

    fn words(csg: &Csg) -> usize {
        let frame = Frame::new([-2.0; 3], 4.0, 4).unwrap();
        Program::new(csg, &frame, &Control::default()).unwrap().words.len()
    }

    fn cube() -> Csg {
        Csg::cuboid([-1.0; 3], [0.5, 1.0, 1.0]).unwrap()
    }

    #[test]
    fn equal_operands_are_one() {
        let many = |count: usize| (0..count).map(|_| cube()).collect::<Vec<_>>();
        let one = words(&cube());
        assert_eq!(words(&Csg::union_of(many(100)).unwrap()), one);
        assert_eq!(words(&Csg::intersection_of(many(100)).unwrap()), one);
        assert_eq!(words(&Csg::xor_of(many(101)).unwrap()), one);
        // An empty join.
        assert_eq!(words(&Csg::xor_of(many(100)).unwrap()), 1);
        // Equal operands are found however they were placed.
        let there = Affine::translation([0.25, 0.0, 0.0]).unwrap();
        let back = Affine::translation([-0.25, 0.0, 0.0]).unwrap();
        let moved = cube().placed(&there).unwrap().placed(&back).unwrap();
        assert_eq!(words(&Csg::union_of([cube(), moved]).unwrap()), one);
        assert_eq!(words(&Csg::union_of([cube(), cube().placed(&there).unwrap()]).unwrap()), 2 * one + 1);
        // A complement is a different operand.
        let plane = |scale: f64| Csg::half_space([scale, 0.0, 0.0], scale).unwrap();
        assert_eq!(words(&Csg::union_of([plane(1.0), plane(1.0)]).unwrap()), 1);
        assert_eq!(words(&Csg::union_of([plane(1.0), plane(1.0).complement()]).unwrap()), 3);
    }
}
