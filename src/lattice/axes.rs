//! The three axes of space.

/// What there is along each axis: `[of(0), of(1), of(2)]`. (`[0, 1, 2].map(of)` says the same; spelled out it
/// takes a tenth of the instructions to compile.)
#[inline(always)]
pub(crate) fn axes<T>(mut of: impl FnMut(usize) -> T) -> [T; 3] {
    [of(0), of(1), of(2)]
}
