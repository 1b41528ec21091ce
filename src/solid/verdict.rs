//! What a solid says of one cell.

use crate::error::Error;
use crate::octree::Tag;

/// What a solid says of one cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict<P> {
    /// The cell's interior and the solid's are proven disjoint.
    Empty,
    /// The cell is proven to lie in the solid.
    Full,
    /// Not decided, and splitting does not help.
    Undecided,
    /// Not decided; the part is what the solid remembers about the cell, so that it can split it.
    Partial(P),
}

impl<P> Verdict<P> {
    /// The verdict as a tag.
    #[inline(always)]
    pub fn tag(&self) -> Tag {
        match self {
            Verdict::Empty => Tag::Empty,
            Verdict::Full => Tag::Full,
            Verdict::Undecided | Verdict::Partial(_) => Tag::Partial,
        }
    }

    /// The same verdict with another part.
    #[inline(always)]
    pub fn map<Q>(self, part: impl FnOnce(P) -> Q) -> Verdict<Q> {
        match self {
            Verdict::Empty => Verdict::Empty,
            Verdict::Full => Verdict::Full,
            Verdict::Undecided => Verdict::Undecided,
            Verdict::Partial(own) => Verdict::Partial(part(own)),
        }
    }

    /// The same verdict with another part, if that can be made.
    ///
    /// # Errors
    /// Those of `part`.
    #[inline(always)]
    pub fn try_map<Q>(self, part: impl FnOnce(P) -> Result<Q, Error>) -> Result<Verdict<Q>, Error> {
        Ok(match self {
            Verdict::Empty => Verdict::Empty,
            Verdict::Full => Verdict::Full,
            Verdict::Undecided => Verdict::Undecided,
            Verdict::Partial(own) => Verdict::Partial(part(own)?),
        })
    }

    /// The verdict of the complement.
    #[inline(always)]
    #[must_use]
    pub fn complement(self) -> Verdict<P> {
        match self {
            Verdict::Empty => Verdict::Full,
            Verdict::Full => Verdict::Empty,
            open => open,
        }
    }
}
