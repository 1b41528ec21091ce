//! Versions of library and interface.

use core::ffi::{CStr, c_char};

/// Major version of the library that this header belongs to.
pub const LEAFLESS_VERSION_MAJOR: u32 = 0;
/// Minor version of the library that this header belongs to.
pub const LEAFLESS_VERSION_MINOR: u32 = 0;
/// Patch level of the library that this header belongs to.
pub const LEAFLESS_VERSION_PATCH: u32 = 1;
/// Number of the binary interface. Programs and libraries with the same number are compatible. It is 0 until
/// the release 0.1, which means that nothing is promised yet.
pub const LEAFLESS_ABI: u32 = 0;

const TEXT: &CStr = {
    match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(text) => text,
        Err(_) => panic!("a version has no NUL"),
    }
};

/// Returns the version of the library that is linked: major · 1 000 000 + minor · 1000 + patch, as
/// LEAFLESS_VERSION.
///
/// - Result: the number.
#[unsafe(no_mangle)]
pub extern "C" fn leafless_version() -> u32 {
    LEAFLESS_VERSION_MAJOR * 1_000_000 + LEAFLESS_VERSION_MINOR * 1000 + LEAFLESS_VERSION_PATCH
}

/// Returns the version of the library that is linked, as a text such as "0.1.0".
///
/// - Result: a NUL-terminated text, never NULL.
/// - Ownership: the text is static; do not free it.
#[unsafe(no_mangle)]
pub extern "C" fn leafless_version_string() -> *const c_char {
    TEXT.as_ptr()
}

/// Returns the number of the binary interface of the library that is linked. Compare it with LEAFLESS_ABI, or
/// use LEAFLESS_COMPATIBLE, which compares the version too.
///
/// - Result: the number.
#[unsafe(no_mangle)]
pub extern "C" fn leafless_abi() -> u32 {
    LEAFLESS_ABI
}
