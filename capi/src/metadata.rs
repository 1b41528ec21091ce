//! Key–value metadata of octrees and channels for C.

use super::boundary::{Failure, out, text};
use core::ffi::c_char;
use leafless::Metadata;
use leafless::octree::MetadataLimit;

/// Returns a copy of `metadata` with one more fact, or with a new value of a fact.
///
/// # Safety
/// As [`text`].
pub(super) unsafe fn with(
    metadata: &Metadata,
    key: (*const c_char, usize),
    value: (*const c_char, usize),
    limit: MetadataLimit,
) -> Result<Metadata, Failure> {
    // SAFETY: the caller's promise.
    let (key, value) = unsafe { (text(key.0, key.1, "key")?, text(value.0, value.1, "value")?) };
    Ok(metadata.changed(key, Some(value), limit)?)
}

/// Returns a copy of `metadata` with one fact less, or without facts if `key` is NULL.
///
/// # Safety
/// As [`text`].
pub(super) unsafe fn without(
    metadata: &Metadata,
    key: *const c_char,
    key_length: usize,
) -> Result<Metadata, Failure> {
    if key.is_null() {
        return Ok(Metadata::new());
    }
    // SAFETY: the caller's promise.
    let key = unsafe { text(key, key_length, "key")? };
    Ok(metadata.changed(key, None, MetadataLimit::SOLID)?)
}

/// Writes the value of a fact; NULL if there is no such fact.
///
/// # Safety
/// As [`text`] and [`out`].
pub(super) unsafe fn peek(
    metadata: &Metadata,
    key: *const c_char,
    key_length: usize,
    value: *mut *const c_char,
    value_length: *mut usize,
) -> Result<(), Failure> {
    // SAFETY: the caller's promises.
    let (key, value, value_length) =
        unsafe { (text(key, key_length, "key")?, out(value, "value")?, out(value_length, "value_length")?) };
    let found = metadata.get(key);
    value.write(found.map_or(core::ptr::null(), |found| found.as_ptr().cast()))?;
    value_length.write(found.map_or(0, str::len))
}

/// The locations that a fact is written to; all NULL if only the number of facts is wanted.
pub(super) struct Fact {
    pub key: *mut *const c_char,
    pub key_length: *mut usize,
    pub value: *mut *const c_char,
    pub value_length: *mut usize,
}

/// Writes the fact with an index.
///
/// # Safety
/// As [`out`].
pub(super) unsafe fn peek_at(
    metadata: &Metadata,
    index: u64,
    count: *mut u64,
    fact: Fact,
) -> Result<(), Failure> {
    let Fact { key, key_length, value, value_length } = fact;
    // SAFETY: the caller's promise.
    let count = unsafe { out(count, "count")? };
    let number = metadata.iter().count() as u64;
    if key.is_null() && key_length.is_null() && value.is_null() && value_length.is_null() {
        return count.write(number);
    }
    // SAFETY: the caller's promise.
    let (key, key_length, value, value_length) = unsafe {
        (
            out(key, "key")?,
            out(key_length, "key_length")?,
            out(value, "value")?,
            out(value_length, "value_length")?,
        )
    };
    let mut there = metadata.iter().skip(usize::try_from(index).unwrap_or(usize::MAX));
    let missing = Failure::Argument { name: "index", problem: "is not below the number of facts" };
    let (found_key, found_value) = there.next().ok_or(missing)?;
    key.write(found_key.as_ptr().cast())?;
    key_length.write(found_key.len())?;
    value.write(found_value.as_ptr().cast())?;
    value_length.write(found_value.len())?;
    count.write(number)
}
