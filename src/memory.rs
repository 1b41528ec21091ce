//! Memory that can be refused: every allocation whose size depends on an input or a result goes through here
//! or through `try_reserve`, and a refusal is [`Error::OutOfMemory`].

use crate::error::Error;
use alloc::boxed::Box;
use alloc::collections::TryReserveError;
use alloc::string::String;
use alloc::vec::Vec;

impl From<TryReserveError> for Error {
    fn from(_: TryReserveError) -> Error {
        Error::OutOfMemory
    }
}

impl From<hashbrown::TryReserveError> for Error {
    fn from(_: hashbrown::TryReserveError) -> Error {
        Error::OutOfMemory
    }
}

/// An empty vector with room for exactly `count`.
pub fn with_capacity<T>(count: usize) -> Result<Vec<T>, Error> {
    let mut list = Vec::new();
    list.try_reserve_exact(count)?;
    Ok(list)
}

/// Appends; O(1) amortised.
#[inline(always)]
pub fn push<T>(list: &mut Vec<T>, item: T) -> Result<(), Error> {
    list.try_reserve(1)?;
    list.push(item);
    Ok(())
}

/// `count` times `value`.
pub fn filled<T: Clone>(count: usize, value: T) -> Result<Vec<T>, Error> {
    let mut list = with_capacity(count)?;
    list.resize(count, value);
    Ok(list)
}

/// `count` times `value`, in the memory of a list as far as that is large enough.
pub fn refilled<T: Clone>(mut list: Vec<T>, count: usize, value: T) -> Result<Vec<T>, Error> {
    list.clear();
    list.try_reserve_exact(count)?;
    list.resize(count, value);
    Ok(list)
}

/// The bytes that a list takes in memory, with its room to spare.
pub fn bytes_of<T>(list: &Vec<T>) -> usize {
    list.capacity() * size_of::<T>()
}

/// What an iterator yields that knows how much that is.
pub fn collected<T>(items: impl ExactSizeIterator<Item = T>) -> Result<Vec<T>, Error> {
    let mut list = with_capacity(items.len())?;
    list.extend(items);
    Ok(list)
}

/// A copy.
pub fn copied<T: Copy>(slice: &[T]) -> Result<Vec<T>, Error> {
    let mut copy = with_capacity(slice.len())?;
    copy.extend_from_slice(slice);
    Ok(copy)
}

/// A copy of a text.
pub fn text(text: &str) -> Result<String, Error> {
    let mut copy = String::new();
    copy.try_reserve_exact(text.len())?;
    copy.push_str(text);
    Ok(copy)
}

/// A value with an address of its own.
pub fn boxed<T>(value: T) -> Result<Box<[T; 1]>, Error> {
    let mut one = with_capacity(1)?;
    one.push(value);
    one.into_boxed_slice().try_into().map_err(|_| Error::OutOfMemory)
}

/// `N` times zero.
pub fn zeros<T: Copy + Default, const N: usize>() -> Result<Box<[T; N]>, Error> {
    filled(N, T::default())?.into_boxed_slice().try_into().map_err(|_| Error::OutOfMemory)
}
