//! The three axes of space.

/// Builds an array with one element for each axis: `[of(0), of(1), of(2)]`. (It replaces `[0, 1, 2].map(of)`,
/// which takes ten times as many instructions to compile.)
#[inline(always)]
pub(crate) fn axes<T>(mut of: impl FnMut(usize) -> T) -> [T; 3] {
    [of(0), of(1), of(2)]
}
