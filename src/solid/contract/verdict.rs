//! The verdict of a solid on one cell.

use crate::error::Error;
use crate::octree::Tag;

/// The verdict of a solid on one cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict<P> {
    /// The cell's interior and the solid's are proven disjoint.
    Empty,
    /// The cell is proven to lie in the solid.
    Full,
    /// Undecided, and splitting does not help.
    Undecided,
    /// Undecided, and the cell can be split. The part holds the solid's data about the cell.
    Partial(P),
}

impl<P> Verdict<P> {
    /// Returns the verdict as a tag.
    #[inline(always)]
    pub fn tag(&self) -> Tag {
        match self {
            Verdict::Empty => Tag::Empty,
            Verdict::Full => Tag::Full,
            Verdict::Undecided | Verdict::Partial(_) => Tag::Partial,
        }
    }

    /// Returns the same verdict with another part.
    #[inline(always)]
    pub fn map<Q>(self, part: impl FnOnce(P) -> Q) -> Verdict<Q> {
        match self {
            Verdict::Empty => Verdict::Empty,
            Verdict::Full => Verdict::Full,
            Verdict::Undecided => Verdict::Undecided,
            Verdict::Partial(own) => Verdict::Partial(part(own)),
        }
    }

    /// Returns the same verdict with another part, if that part can be made.
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

    /// Returns the verdict of the complement.
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
