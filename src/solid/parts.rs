//! Where the parts of cells live.

use crate::error::Error;

/// What a worker remembers about PARTIAL cells, and the scratch memory that it remembers this in.
///
/// A *part* may refer to the worker's scratch memory, which is a stack: parts that were made after a
/// [mark](Parts::mark) are gone once the mark is [released](Parts::release). A part means something to the
/// worker that made it, and to no other. (Another worker may take it for anything, and may panic.)
///
/// No method has a default, because these methods are right together or wrong across threads. A worker whose
/// parts refer to nothing says so in one line: [`FreeParts`].
///
/// ```
/// use leafless::{Error, solid::Parts};
///
/// /// A worker that remembers which of many shapes cut a cell: a part is a range of `lists`.
/// struct Lists {
///     lists: Vec<u32>,
/// }
///
/// impl Parts for Lists {
///     type Part = (usize, usize);
///
///     fn mark(&self) -> usize {
///         self.lists.len()
///     }
///
///     fn release(&mut self, mark: usize) {
///         self.lists.truncate(mark);
///     }
///
///     fn scratch_bytes(&self) -> usize {
///         size_of_val(&*self.lists)
///     }
///
///     // Another worker's part refers to another worker's memory: what it refers to is copied.
///     fn hand_over(&mut self, from: &Lists, part: &(usize, usize)) -> Result<(usize, usize), Error> {
///         let list = &from.lists[part.0..part.1];
///         let first = self.lists.len();
///         self.lists.try_reserve(list.len())?;
///         self.lists.extend_from_slice(list);
///         Ok((first, self.lists.len()))
///     }
/// }
///
/// let mut first = Lists { lists: vec![3, 5, 8] };
/// let mut second = Lists { lists: vec![13] };
/// let part = second.hand_over(&first, &(1, 3))?;
/// assert_eq!((&second.lists[part.0..part.1], second.mark()), (&[5, 8][..], 3));
/// second.release(1);
/// assert_eq!((second.lists, first.scratch_bytes()), (vec![13], 12));
/// # first.release(0);
/// # Ok::<(), Error>(())
/// ```
pub trait Parts: Send + Sync {
    /// What is remembered about one PARTIAL cell.
    type Part: Clone + Send + Sync;

    /// The present height of the scratch memory. O(1).
    fn mark(&self) -> usize;

    /// Takes the scratch memory back to an earlier height.
    fn release(&mut self, mark: usize);

    /// Bytes that the scratch memory takes for parts. A caller that keeps many parts at once limits this
    /// number.
    fn scratch_bytes(&self) -> usize;

    /// Takes over a part of another worker of the same classifier, with what the part refers to.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    fn hand_over(&mut self, from: &Self, part: &Self::Part) -> Result<Self::Part, Error>;
}

/// A worker whose parts refer to nothing: they are copied, they never become invalid, and any worker of the
/// same classifier understands them. The worker then needs no scratch memory, and has [`Parts`] by this line
/// alone.
pub trait FreeParts: Send + Sync {
    /// What is remembered about one PARTIAL cell.
    type Part: Clone + Send + Sync;
}

impl<W: FreeParts> Parts for W {
    type Part = W::Part;

    fn mark(&self) -> usize {
        0
    }

    fn release(&mut self, _: usize) {}

    fn scratch_bytes(&self) -> usize {
        0
    }

    fn hand_over(&mut self, _: &Self, part: &W::Part) -> Result<W::Part, Error> {
        Ok(part.clone())
    }
}
