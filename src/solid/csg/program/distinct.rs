//! Operands that are one: in a union or an intersection the same operand twice is that operand, and in a parity it is
//! nothing. A scene of thousands of equal parts costs as much as one of them, and coincident faces leave no doubt.

use super::hierarchy::Operand;
use super::word::{Op, Word};
use crate::error::Error;
use crate::memory;
use crate::solid::csg::Join;
use crate::solid::half_space::map::ExactMap;
use crate::solid::half_space::{HalfSpace, Surface};
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::hash::{Hash, Hasher};
use core::ops::Range;
use hashbrown::HashMap;
use hashbrown::hash_map::Entry;

/// A half-space and where it stands, by their exact numbers.
struct Exactly {
    half_space: HalfSpace,
    map: Arc<ExactMap>,
}

impl PartialEq for Exactly {
    fn eq(&self, other: &Exactly) -> bool {
        let (a, b) = (&*self.half_space.0, &*other.half_space.0);
        let is_same = match (a, b) {
            (Surface::Plane(a), Surface::Plane(b)) => a == b,
            (Surface::Quadric(a), Surface::Quadric(b)) => a == b,
            (Surface::Powers(a), Surface::Powers(b)) => a == b,
            (Surface::Torus(a), Surface::Torus(b)) => a == b,
            (Surface::Host(a), Surface::Host(b)) => Arc::ptr_eq(a, b),
            _ => false,
        };
        is_same && (Arc::ptr_eq(&self.map, &other.map) || self.map == other.map)
    }
}

impl Eq for Exactly {}

impl Hash for Exactly {
    fn hash<H: Hasher>(&self, state: &mut H) {
        match &*self.half_space.0 {
            Surface::Plane(coefficients) => coefficients.hash(state),
            Surface::Quadric(coefficients) => coefficients.hash(state),
            Surface::Torus(torus) => torus.hash(state),
            Surface::Powers(powers) => {
                for (coefficient, centre, exponent) in powers.terms {
                    // Zero has two signs, and is equal to itself.
                    ([coefficient, centre].map(|x| (x + 0.0).to_bits()), exponent).hash(state);
                }
                (powers.constant + 0.0).to_bits().hash(state);
            }
            Surface::Host(host) => Arc::as_ptr(host).hash(state),
            Surface::Slab(_) => core::ptr::from_ref(&*self.half_space.0).hash(state),
        }
        self.map.hash(state);
    }
}

/// Which half-spaces of an expression are equal.
#[derive(Default)]
pub(crate) struct Equals {
    /// The first half-space with these numbers.
    first: HashMap<Exactly, u32>,
    /// For each half-space the first one that is equal.
    of: Vec<u32>,
}

impl Equals {
    /// Notes the next half-space.
    pub(crate) fn note(&mut self, half_space: &HalfSpace, map: &Arc<ExactMap>) -> Result<(), Error> {
        self.first.try_reserve(1)?;
        let next = self.of.len() as u32;
        let exactly = Exactly { half_space: half_space.clone(), map: map.clone() };
        memory::push(&mut self.of, *self.first.entry(exactly).or_insert(next))
    }

    /// A word in the form that all equal ones have.
    fn plain(&self, word: Word) -> Word {
        match word.op() {
            Op::HalfSpace { index, complement } => {
                let index = self.of.get(index as usize).copied().unwrap_or(index);
                Word::new(Op::HalfSpace { index, complement })
            }
            _ => word,
        }
    }

    /// Takes away those of the operands from `first` on that change nothing, because an equal one stands before them.
    ///
    /// O(operands) where no two are of one length. Otherwise those are read that are as long as another one: what they are
    /// joined to is twice as long at least, so that no word of an expression is read more often than the logarithm of its
    /// length, however deep it is nested.
    pub(crate) fn reduce(
        &self,
        join: Join,
        first: usize,
        operands: &mut Vec<Operand>,
        words: &mut Vec<Word>,
    ) -> Result<(), Error> {
        let own = &operands[first..];
        if own.len() < 2 {
            return Ok(());
        }
        let range = |i: usize| -> Range<usize> {
            own[i].start..own.get(i + 1).map_or(words.len(), |next| next.start)
        };
        let mut lengths: HashMap<usize, u32> = HashMap::new();
        lengths.try_reserve(own.len())?;
        for i in 0..own.len() {
            *lengths.entry(range(i).len()).or_insert(0) += 1;
        }
        if lengths.len() == own.len() {
            return Ok(());
        }
        let like_others = || (0..own.len()).filter(|&i| lengths[&range(i).len()] > 1);
        let mut plain = memory::with_capacity(like_others().map(|i| range(i).len()).sum())?;
        for i in like_others() {
            plain.extend(words[range(i)].iter().map(|&word| self.plain(word)));
        }
        // For each operand how often it occurs, at the place of the first one.
        let mut counts: Vec<u32> = memory::filled(own.len(), 1)?;
        let mut seen: HashMap<&[Word], usize> = HashMap::new();
        seen.try_reserve(own.len())?;
        let mut rest = &*plain;
        for i in like_others() {
            let text;
            (text, rest) = rest.split_at(range(i).len());
            match seen.entry(text) {
                Entry::Occupied(entry) => {
                    counts[i] = 0;
                    counts[*entry.get()] += 1;
                }
                Entry::Vacant(entry) => _ = entry.insert(i),
            }
        }
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
        // However they came to stand there.
        let there = Affine::translation([0.25, 0.0, 0.0]).unwrap();
        let back = Affine::translation([-0.25, 0.0, 0.0]).unwrap();
        let moved = cube().placed(&there).unwrap().placed(&back).unwrap();
        assert_eq!(words(&Csg::union_of([cube(), moved]).unwrap()), one);
        assert_eq!(words(&Csg::union_of([cube(), cube().placed(&there).unwrap()]).unwrap()), 2 * one + 1);
        // A complement is another operand.
        let plane = |scale: f64| Csg::half_space([scale, 0.0, 0.0], scale).unwrap();
        assert_eq!(words(&Csg::union_of([plane(1.0), plane(1.0)]).unwrap()), 1);
        assert_eq!(words(&Csg::union_of([plane(1.0), plane(1.0).complement()]).unwrap()), 3);
    }
}
