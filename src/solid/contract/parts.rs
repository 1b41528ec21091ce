//! The data that workers keep about cells.

use crate::error::Error;

/// A worker's memory of PARTIAL cells: the type of a cell's part, and the scratch memory that parts refer to.
///
/// A *part* may refer to the worker's scratch memory, which is a stack: [releasing](Parts::release) a
/// [mark](Parts::mark) invalidates all parts that were made after the mark. A part is valid only for the
/// worker that made it. (Another worker may misinterpret the part, and may panic.)
///
/// No method has a default, because these methods are correct only together, and a mistake shows only across
/// threads. A worker whose parts refer to nothing implements [`FreeParts`], in one line.
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
///     // The part of another worker refers to that worker's memory, so that the list is copied.
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
    /// The data about one PARTIAL cell.
    type Part: Clone + Send + Sync;

    /// The current height of the scratch memory. O(1).
    fn mark(&self) -> usize;

    /// Truncates the scratch memory to an earlier height.
    fn release(&mut self, mark: usize);

    /// The number of bytes that parts occupy in the scratch memory. A caller that keeps many parts at once
    /// limits this number.
    fn scratch_bytes(&self) -> usize;

    /// Copies a part from another worker of the same classifier, together with the data that the part refers
    /// to.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    fn hand_over(&mut self, from: &Self, part: &Self::Part) -> Result<Self::Part, Error>;
}

/// A worker whose parts refer to nothing. Such parts can be copied, never become invalid, and are valid for
/// any worker of the same classifier. The worker needs no scratch memory for them; this trait alone gives it
/// [`Parts`].
pub trait FreeParts: Send + Sync {
    /// The data about one PARTIAL cell.
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
