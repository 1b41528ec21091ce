//! Fallible allocation. Every allocation whose size depends on an input or a result goes through this module
//! or through `try_reserve`; a refusal is [`Error::OutOfMemory`].

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

/// Returns an empty vector with room for exactly `count` items.
pub fn with_capacity<T>(count: usize) -> Result<Vec<T>, Error> {
    let mut list = Vec::new();
    list.try_reserve_exact(count)?;
    Ok(list)
}

/// Appends an item; O(1) amortised.
#[inline(always)]
pub fn push<T>(list: &mut Vec<T>, item: T) -> Result<(), Error> {
    list.try_reserve(1)?;
    list.push(item);
    Ok(())
}

/// Returns a vector of `count` times `value`.
pub fn filled<T: Clone>(count: usize, value: T) -> Result<Vec<T>, Error> {
    let mut list = with_capacity(count)?;
    list.resize(count, value);
    Ok(list)
}

/// Returns a vector of `count` times `value`, which reuses the memory of `list` if that is large enough.
pub fn refilled<T: Clone>(mut list: Vec<T>, count: usize, value: T) -> Result<Vec<T>, Error> {
    list.clear();
    list.try_reserve_exact(count)?;
    list.resize(count, value);
    Ok(list)
}

/// Returns the bytes of memory that a list takes, including its spare capacity.
pub fn bytes_of<T>(list: &Vec<T>) -> usize {
    list.capacity() * size_of::<T>()
}

/// Collects the items of an iterator of known length.
pub fn collected<T>(items: impl ExactSizeIterator<Item = T>) -> Result<Vec<T>, Error> {
    let mut list = with_capacity(items.len())?;
    list.extend(items);
    Ok(list)
}

/// Returns a copy of a slice.
pub fn copied<T: Copy>(slice: &[T]) -> Result<Vec<T>, Error> {
    let mut copy = with_capacity(slice.len())?;
    copy.extend_from_slice(slice);
    Ok(copy)
}

/// Returns a copy of a text.
pub fn text(text: &str) -> Result<String, Error> {
    let mut copy = String::new();
    copy.try_reserve_exact(text.len())?;
    copy.push_str(text);
    Ok(copy)
}

/// Returns a value in an allocation of its own.
pub fn boxed<T>(value: T) -> Result<Box<[T; 1]>, Error> {
    let mut one = with_capacity(1)?;
    one.push(value);
    one.into_boxed_slice().try_into().map_err(|_| Error::OutOfMemory)
}

/// Returns `N` times zero.
pub fn zeros<T: Copy + Default, const N: usize>() -> Result<Box<[T; N]>, Error> {
    filled(N, T::default())?.into_boxed_slice().try_into().map_err(|_| Error::OutOfMemory)
}
