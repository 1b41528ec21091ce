//! Status codes, and the message of the last failure in a thread.

use core::ffi::{CStr, c_char};
use core::fmt::{self, Display, Write};
use std::cell::RefCell;

/// The status codes that functions return. A code is never renumbered or reused; new codes are added at the
/// end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
pub enum leafless_status {
    /// Success.
    LEAFLESS_OK = 0,
    /// A pointer that must not be NULL is NULL.
    LEAFLESS_E_NULL = 1,
    /// An argument is out of its range, not a number, or misaligned.
    LEAFLESS_E_ARGUMENT = 2,
    /// A text is not UTF-8, or a path holds a NUL.
    LEAFLESS_E_UTF8 = 3,
    /// A buffer is too small for the result.
    LEAFLESS_E_BUFFER = 4,
    /// Operands lie on different frames, or a solid belongs to another frame.
    LEAFLESS_E_FRAME = 5,
    /// The sampled rule was requested for a solid that cannot decide single points.
    LEAFLESS_E_NOT_SAMPLED = 6,
    /// A mesh does not bound a solid.
    LEAFLESS_E_MESH = 7,
    /// A mesh file cannot be read.
    LEAFLESS_E_MESH_FILE = 8,
    /// The bytes are not a Leafless file, or the file is damaged.
    LEAFLESS_E_FORMAT = 9,
    /// The file needs a newer version of the library.
    LEAFLESS_E_VERSION = 10,
    /// The arrays of an octree or of a tri-dexel model contradict each other.
    LEAFLESS_E_DAMAGED = 11,
    /// The result would need more nodes or bytes than leafless_options allows.
    LEAFLESS_E_LIMIT = 12,
    /// An allocation failed.
    LEAFLESS_E_NO_MEMORY = 13,
    /// The host cancelled the operation, through a control or from its progress function.
    LEAFLESS_E_CANCELLED = 14,
    /// A function of the host, other than the progress function, ended the operation by its return value.
    LEAFLESS_E_CALLBACK = 15,
    /// The operating system refused to read or write.
    LEAFLESS_E_IO = 16,
    /// The library has a defect; please report it with the message. All objects stay usable, except an editor
    /// or a layout that the call was changing.
    LEAFLESS_E_PANIC = 17,
    /// The octree to refine was made from another solid.
    LEAFLESS_E_SOURCE = 18,
    /// A scene cannot be read.
    LEAFLESS_E_SCENE = 19,
    /// A lazy octree, an editor or a layout is in use by another call, in another thread or around this one.
    /// Nothing was done.
    LEAFLESS_E_BUSY = 20,
    /// A volume file cannot be read.
    LEAFLESS_E_VOLUME_FILE = 21,
}
use leafless_status::*;

const ALL: [(leafless_status, &CStr); 22] = [
    (LEAFLESS_OK, c"LEAFLESS_OK"),
    (LEAFLESS_E_NULL, c"LEAFLESS_E_NULL"),
    (LEAFLESS_E_ARGUMENT, c"LEAFLESS_E_ARGUMENT"),
    (LEAFLESS_E_UTF8, c"LEAFLESS_E_UTF8"),
    (LEAFLESS_E_BUFFER, c"LEAFLESS_E_BUFFER"),
    (LEAFLESS_E_FRAME, c"LEAFLESS_E_FRAME"),
    (LEAFLESS_E_NOT_SAMPLED, c"LEAFLESS_E_NOT_SAMPLED"),
    (LEAFLESS_E_MESH, c"LEAFLESS_E_MESH"),
    (LEAFLESS_E_MESH_FILE, c"LEAFLESS_E_MESH_FILE"),
    (LEAFLESS_E_FORMAT, c"LEAFLESS_E_FORMAT"),
    (LEAFLESS_E_VERSION, c"LEAFLESS_E_VERSION"),
    (LEAFLESS_E_DAMAGED, c"LEAFLESS_E_DAMAGED"),
    (LEAFLESS_E_LIMIT, c"LEAFLESS_E_LIMIT"),
    (LEAFLESS_E_NO_MEMORY, c"LEAFLESS_E_NO_MEMORY"),
    (LEAFLESS_E_CANCELLED, c"LEAFLESS_E_CANCELLED"),
    (LEAFLESS_E_CALLBACK, c"LEAFLESS_E_CALLBACK"),
    (LEAFLESS_E_IO, c"LEAFLESS_E_IO"),
    (LEAFLESS_E_PANIC, c"LEAFLESS_E_PANIC"),
    (LEAFLESS_E_SOURCE, c"LEAFLESS_E_SOURCE"),
    (LEAFLESS_E_SCENE, c"LEAFLESS_E_SCENE"),
    (LEAFLESS_E_BUSY, c"LEAFLESS_E_BUSY"),
    (LEAFLESS_E_VOLUME_FILE, c"LEAFLESS_E_VOLUME_FILE"),
];

/// The last failure of a thread. Its size is fixed, so that an out-of-memory failure can be recorded.
struct Last {
    status: leafless_status,
    /// The value that a function of the host returned, if that value caused the failure.
    code: i32,
    length: usize,
    text: [u8; 511],
}

std::thread_local! {
    static LAST: RefCell<Last> =
        const { RefCell::new(Last { status: leafless_status::LEAFLESS_OK, code: 0, length: 0, text: [0; 511] }) };
}

/// Returns the largest length up to `most` at which `text` can be cut between characters.
fn cut(text: &str, most: usize) -> usize {
    (0..=most.min(text.len())).rev().find(|&length| text.is_char_boundary(length)).unwrap_or(0)
}

impl Write for Last {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let length = cut(text, self.text.len() - self.length);
        self.text[self.length..self.length + length].copy_from_slice(&text.as_bytes()[..length]);
        self.length += length;
        if length < text.len() { Err(fmt::Error) } else { Ok(()) }
    }
}

pub(super) fn keep(status: leafless_status, code: i32, text: &dyn Display) {
    // Nothing below fails in this thread, so the cell is not borrowed twice.
    LAST.with_borrow_mut(|last| {
        (last.status, last.code, last.length) = (status, code, 0);
        // Text that does not fit is cut off.
        let _ = write!(last, "{text}");
    });
}

/// Returns the name of a status, such as "LEAFLESS_E_NULL".
///
/// - Result: a NUL-terminated text, never NULL; "LEAFLESS_E_UNKNOWN" for a number that is not a status.
/// - Ownership: the text is static; do not free it.
/// - Untrusted input: any number.
#[unsafe(no_mangle)]
pub extern "C" fn leafless_status_name(status: i32) -> *const c_char {
    let named = ALL.iter().find(|(known, _)| *known as i32 == status);
    named.map_or(c"LEAFLESS_E_UNKNOWN", |(_, name)| name).as_ptr()
}

/// Copies the message of the last failure in the calling thread: a sentence in UTF-8 for the user. If the
/// failure is about a file, the message begins with the path, or with the end of a long path. A call that
/// succeeds leaves the message unchanged. Before the first failure the message is empty.
///
/// - Buffers: `message`, `capacity` bytes; may be NULL if `capacity` is 0.
/// - Result: the message's length in bytes, without the terminating NUL, also if the buffer is too small; at
///   most 511. The text in the buffer is cut between characters and NUL-terminated.
/// - Ownership: the message is copied.
/// - Threads: any; every thread has its own message.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_last_error(message: *mut c_char, capacity: usize) -> usize {
    LAST.with_borrow(|last| {
        // The text is cut between characters.
        let text = core::str::from_utf8(&last.text[..last.length]).unwrap_or_default();
        if !message.is_null() && capacity > 0 {
            let length = cut(text, capacity - 1);
            // SAFETY: the caller has `capacity` bytes there; the message is this thread's own.
            unsafe {
                core::ptr::copy_nonoverlapping(text.as_ptr(), message.cast(), length);
                message.add(length).write(0);
            }
        }
        text.len()
    })
}

/// Returns the status of the last failure in the calling thread; LEAFLESS_OK before the first failure.
///
/// - Result: the status.
/// - Threads: any; every thread has its own status.
#[unsafe(no_mangle)]
pub extern "C" fn leafless_last_status() -> leafless_status {
    LAST.with_borrow(|last| last.status)
}

/// Returns the value with which a function of the host ended the operation, if that was the last failure in
/// the calling thread (LEAFLESS_E_CALLBACK); else 0. Distinct values tell the host which of its functions
/// failed, and why.
///
/// - Result: the number.
/// - Threads: any; every thread has its own number.
#[unsafe(no_mangle)]
pub extern "C" fn leafless_last_code() -> i32 {
    LAST.with_borrow(|last| last.code)
}
