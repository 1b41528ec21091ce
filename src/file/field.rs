//! Checks of fields that allow only a few values.

use crate::error::FormatError;

pub(super) fn illegal(name: &'static str, value: impl Into<u64>) -> FormatError {
    FormatError::Field { name, value: value.into() }
}

/// Refuses `value` unless it is `expected`.
pub(super) fn demand(
    name: &'static str,
    value: impl Into<u64>,
    expected: impl Into<u64>,
) -> Result<(), FormatError> {
    let value = value.into();
    if value == expected.into() { Ok(()) } else { Err(illegal(name, value)) }
}
