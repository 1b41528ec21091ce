//! What a pair of solids asks each of the two.

use crate::error::Error;
use crate::lattice::Cell;
use crate::memory;
use crate::octree::Tag;
use crate::solid::{Classifier, Verdict};
use crate::walk::Part;
use crate::walk::Subject;
use alloc::vec::Vec;

/// Eight siblings, and how likely it is for each that it lies in the solid.
pub(super) type Children<P> = ([Verdict<P>; 8], [f64; 8]);

/// The children of a cell. If it cannot be split, each is as the cell.
pub(super) fn split<C: Classifier>(
    subject: &mut Subject<'_, C>,
    cell: Cell,
    verdict: &Verdict<Part<C>>,
) -> Result<Children<Part<C>>, Error> {
    match verdict {
        Verdict::Partial(part) => subject.split(cell, part).map(guessed),
        decided => Ok(alike(decided)),
    }
}

/// The children of several cells.
pub(super) fn split_many<'k, C: Classifier>(
    subject: &mut Subject<'_, C>,
    cells: impl ExactSizeIterator<Item = (Cell, &'k Verdict<Part<C>>)> + Clone,
    threads: usize,
) -> Result<Vec<Children<Part<C>>>, Error>
where
    Part<C>: 'k,
{
    let mut asked = memory::with_capacity(cells.len())?;
    asked.extend(cells.clone().filter_map(|(cell, verdict)| match verdict {
        Verdict::Partial(part) => Some((cell, part.clone())),
        _ => None,
    }));
    let mut found = subject.split_many(&asked, threads)?.into_iter();
    memory::collected(cells.map(|(_, verdict)| match verdict {
        Verdict::Partial(_) => found.next().map_or_else(|| alike(&Verdict::Undecided), guessed),
        decided => alike(decided),
    }))
}

/// The children of a cell that is FULL or undecided.
fn alike<P>(verdict: &Verdict<P>) -> Children<P> {
    match verdict {
        Verdict::Full => ([const { Verdict::Full }; 8], [1.0; 8]),
        _ => ([const { Verdict::Undecided }; 8], [0.0; 8]),
    }
}

/// Eight siblings with a guess for each, between 0 and 1, how much of it lies in the solid. The guess is made
/// from the siblings that share a face with it.
fn guessed<P>(verdicts: [Verdict<P>; 8]) -> Children<P> {
    let weight = |k: usize| match verdicts[k].tag() {
        Tag::Full => 1.0,
        Tag::Empty => -1.0,
        _ => 0.0,
    };
    let likely = [0, 1, 2, 3, 4, 5, 6, 7].map(|k: usize| {
        let around: f64 = [1, 2, 4].iter().map(|axis| weight(k ^ axis)).sum();
        match verdicts[k] {
            Verdict::Full => 1.0,
            _ => (3.5 + around) / 7.0,
        }
    });
    (verdicts, likely)
}
