//! Sources and sinks: where files are read from and written to.

use super::boundary::{Buffer, Failure, Out, Sized32, buffer, named_path, out, sized, slice};
use super::number::{Number, enumeration};
use core::ffi::{c_char, c_void};
use leafless::Error;
use leafless::exchange::read_whole;
use leafless::file::replace;
use leafless_access::*;
use std::borrow::Cow;
use std::io::{self, Write};
use std::path::Path;

/// The way in which a source is accessed. Octrees, tri-dexel models and samples in memory can be used in
/// place; everything else is read with LEAFLESS_ACCESS_COPY.
#[derive(Clone, Copy, PartialEq)]
#[repr(u32)]
pub enum leafless_access {
    /// Reads the source into memory and verifies all of it. This is the default, and the way for untrusted
    /// files. Later changes of the file or of the bytes do not matter. Bytes may have any address.
    LEAFLESS_ACCESS_COPY = 0,
    /// Uses the source in place: a file is mapped into memory, bytes are viewed. Only the header, the section
    /// table, the bounds, the level table or windows, and the metadata are checked, in some microseconds for
    /// any length. The rest is read when queries touch it. If the rest is damaged, queries may answer
    /// undecided or wrong, but they stay in bounds and end.
    LEAFLESS_ACCESS_MAP = 1,
    /// As LEAFLESS_ACCESS_MAP, but all of the source is verified first, in one scan. Writing to the source
    /// afterwards invalidates the verification.
    LEAFLESS_ACCESS_MAP_VERIFIED = 2,
}

enumeration! {
    leafless_access => leafless_access {
        LEAFLESS_ACCESS_COPY => LEAFLESS_ACCESS_COPY,
        LEAFLESS_ACCESS_MAP => LEAFLESS_ACCESS_MAP,
        LEAFLESS_ACCESS_MAP_VERIFIED => LEAFLESS_ACCESS_MAP_VERIFIED,
    }
}

/// The input of a reading function: a file by its path, or the bytes of a whole file in memory. Exactly one
/// of the two is given, and the fields of the other are zero, else functions return LEAFLESS_E_ARGUMENT.
/// leafless_from_file and leafless_from_bytes make this struct.
///
/// A mapped file must be a regular file. While the object that was read lives, or an object that shares the
/// file with it, the file must not become shorter: reading beyond its new end raises SIGBUS, which by default
/// ends the process. The file must not be written to either: answers may then be wrong, and nothing more is
/// promised. Removing the file, or replacing it by renaming another file over it, as a leafless_sink does, is
/// harmless.
///
/// Viewed bytes begin at an address that is a multiple of 8, and belong to the host. They must stay in place,
/// unchanged, until the last reference is released to the object that was read and to every object that
/// shares the bytes: cursors, solids, channels, models with other metadata, and objects made from these.
/// Viewed bytes are for files that are part of a program, or that the host maps itself.
///
/// Untrusted input: with LEAFLESS_ACCESS_COPY any file and any bytes; memory is at most a small multiple of
/// their length, unless the function says more. With the other two any content too, but only if no other
/// program can change it.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_source {
    /// sizeof(leafless_source).
    pub struct_size: u32,
    /// A leafless_access.
    pub access: Number<leafless_access>,
    /// The file's path, UTF-8; NULL if bytes are given.
    pub path: *const c_char,
    /// Length of the path in bytes.
    pub path_length: usize,
    /// All bytes of a file; NULL if a path is given, or if the file is empty.
    pub bytes: *const u8,
    /// Number of bytes.
    pub length: u64,
}

// SAFETY: numbers and pointers.
unsafe impl Sized32 for leafless_source {}

/// Receives the bytes of a file in order. It takes all `count` bytes and returns 0; any other value ends the
/// writing with LEAFLESS_E_CALLBACK. It is called in the calling thread. It must return: no exception, no
/// longjmp. It may call this library.
pub type leafless_write_fn =
    Option<unsafe extern "C" fn(ctx: *mut c_void, bytes: *const u8, count: u64) -> i32>;

/// The destination of a file: a path, a function of the host, or a buffer. Exactly one of `path`, `write` and
/// `length` is given, and the fields of the others are zero, else functions return LEAFLESS_E_ARGUMENT.
/// leafless_to_file, leafless_to_function and leafless_to_buffer make this struct.
///
/// A path. At any moment, also after a crash or a power failure, the old file or the new file exists,
/// complete; after LEAFLESS_OK the new file is on the disk. The bytes go to a temporary file in the same
/// directory, which is synchronised with the disk and then renamed over the old file. On Linux, if the file
/// system supports it, the temporary file has no name until it is complete, so that nothing is left of it
/// when the process is killed. Elsewhere a file `.leafless-….tmp` may stay behind. A replaced file keeps its
/// permissions; its other hard links keep the old contents. A symbolic link is followed. A file that is not
/// regular, such as a pipe, is written to directly. A pipe without a reader raises SIGPIPE, and a file beyond
/// the process's size limit raises SIGXFSZ, unless the host ignores these signals. The call waits until a
/// pipe is opened for reading, also if signal handlers run meanwhile. After an error, LEAFLESS_E_IO or
/// another, the old file is unchanged; only if the last step fails, synchronising the directory, the new file
/// is in place.
///
/// A function. It is called with a few large pieces, from the first byte to the last. The message of
/// LEAFLESS_E_CALLBACK contains the function's return value. Other errors occur before anything is written.
///
/// A buffer. Computing only the length takes as long as filling the buffer. LEAFLESS_E_BUFFER if the capacity
/// is too small.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_sink {
    /// sizeof(leafless_sink).
    pub struct_size: u32,
    /// Reserved; must be 0.
    pub reserved: u32,
    /// The file's path, UTF-8.
    pub path: *const c_char,
    /// Length of the path in bytes.
    pub path_length: usize,
    /// The function that receives the bytes.
    pub write: leafless_write_fn,
    /// The context that `write` is called with.
    pub write_ctx: *mut c_void,
    /// Room for `capacity` bytes, or NULL to get only the length.
    pub bytes: *mut u8,
    /// Capacity of the buffer in bytes.
    pub capacity: u64,
    /// Receives the length of the file in bytes.
    pub length: *mut u64,
}

// SAFETY: numbers, pointers, and an optional function.
unsafe impl Sized32 for leafless_sink {}

/// Names of the source's parameter and of its fields in messages.
const SOURCE: [&str; 4] = ["source", "source.access", "source.path", "source.bytes"];
const DATA: [&str; 4] = ["data", "data.access", "data.path", "data.bytes"];

/// The input that a source names.
pub(super) enum Source<'a> {
    Path(&'a str),
    Bytes(&'a [u8]),
}

impl<'a> Source<'a> {
    /// Returns all bytes of the file.
    pub(super) fn whole(&self) -> Result<Cow<'a, [u8]>, Error> {
        match *self {
            Source::Path(path) => {
                let path = Path::new(path);
                Ok(Cow::Owned(read_whole(path).map_err(|error| error.of_file(path))?))
            }
            Source::Bytes(bytes) => Ok(Cow::Borrowed(bytes)),
        }
    }
}

/// # Safety
/// `source` is NULL or misaligned, or a valid struct whose path and bytes live and do not change as long as
/// the result is used.
unsafe fn named<'a>(
    source: *const leafless_source,
    names: [&'static str; 4],
) -> Result<(Source<'a>, leafless_access), Failure> {
    let [name, access_name, path_name, bytes_name] = names;
    if source.is_null() {
        return Err(Failure::Null { name });
    }
    // SAFETY: the caller's promise.
    let given = unsafe { sized(source, name)? };
    let access = given.access.known(access_name)?;
    let has_path = !given.path.is_null() || given.path_length != 0;
    let has_bytes = !given.bytes.is_null() || given.length != 0;
    // SAFETY: the caller's promise.
    let found = match (has_path, has_bytes) {
        (true, true) => return Err(Failure::Argument { name, problem: "has both a path and bytes" }),
        (true, false) => Source::Path(unsafe { named_path(given.path, given.path_length, path_name)? }),
        (false, _) => Source::Bytes(unsafe { slice(given.bytes, given.length, bytes_name)? }),
    };
    Ok((found, access))
}

/// Returns the input of a source that can only be copied.
///
/// # Safety
/// As [`named`].
unsafe fn named_copy<'a>(
    source: *const leafless_source,
    names: [&'static str; 4],
) -> Result<Source<'a>, Failure> {
    // SAFETY: the caller's promise.
    match unsafe { named(source, names)? } {
        (found, LEAFLESS_ACCESS_COPY) => Ok(found),
        _ => Err(Failure::Argument { name: names[1], problem: "must be LEAFLESS_ACCESS_COPY here" }),
    }
}

/// Returns the input of a source and its access.
///
/// # Safety
/// As [`named`]. With access other than a copy, path and bytes live as long as every object made from the
/// result.
pub(super) unsafe fn source<'a>(
    source: *const leafless_source,
) -> Result<(Source<'a>, leafless_access), Failure> {
    // SAFETY: the caller's promise.
    unsafe { named(source, SOURCE) }
}

/// Returns the input of a source that can only be copied, the parameter `source`.
///
/// # Safety
/// As [`named`].
pub(super) unsafe fn copy<'a>(source: *const leafless_source) -> Result<Source<'a>, Failure> {
    // SAFETY: the caller's promise.
    unsafe { named_copy(source, SOURCE) }
}

/// Returns a second file that belongs to a source; `None` if `data` is NULL.
///
/// # Safety
/// As [`named`].
pub(super) unsafe fn data<'a>(data: *const leafless_source) -> Result<Option<Source<'a>>, Failure> {
    // SAFETY: the caller's promise.
    (!data.is_null()).then(|| unsafe { named_copy(data, DATA) }).transpose()
}

/// Passes bytes to the host.
pub(super) struct Writer {
    write: unsafe extern "C" fn(*mut c_void, *const u8, u64) -> i32,
    ctx: *mut c_void,
    code: i32,
}

impl Write for Writer {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        // SAFETY: as the host gave it, with its own context.
        self.code = unsafe { (self.write)(self.ctx, bytes.as_ptr(), bytes.len() as u64) };
        if self.code == 0 { Ok(bytes.len()) } else { Err(io::ErrorKind::Other.into()) }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Writer {
    /// If the host's function ended the work, its return value is the error.
    fn run(mut self, work: impl FnOnce(&mut Writer) -> Result<(), Error>) -> Result<(), Failure> {
        match work(&mut self) {
            Err(Error::Io(_)) if self.code != 0 => Err(Error::Callback { code: self.code }.into()),
            done => Ok(done?),
        }
    }
}

/// Size in bytes of the pieces of a file in memory that are passed to a function of the host.
const PIECE: usize = 1 << 20;

/// The destination of a file.
pub(super) enum Sink<'a> {
    Path(&'a str),
    Function(Writer),
    Buffer { bytes: Buffer<u8>, length: Out<u64> },
}

/// # Safety
/// `sink` is NULL or misaligned, or a valid struct whose path and buffers live as long as the result is used.
pub(super) unsafe fn sink<'a>(sink: *const leafless_sink) -> Result<Sink<'a>, Failure> {
    if sink.is_null() {
        return Err(Failure::Null { name: "sink" });
    }
    // SAFETY: the caller's promise.
    let given = unsafe { sized(sink, "sink")? };
    if given.reserved != 0 {
        return Err(Failure::Argument { name: "sink.reserved", problem: "must be zero" });
    }
    let has_path = !given.path.is_null() || given.path_length != 0;
    let has_function = given.write.is_some() || !given.write_ctx.is_null();
    let has_buffer = !given.length.is_null() || !given.bytes.is_null() || given.capacity != 0;
    // SAFETY: the caller's promise.
    match (has_path, has_function, has_buffer) {
        (true, false, false) => {
            Ok(Sink::Path(unsafe { named_path(given.path, given.path_length, "sink.path")? }))
        }
        (false, true, false) => {
            let write = given.write.ok_or(Failure::Null { name: "sink.write" })?;
            Ok(Sink::Function(Writer { write, ctx: given.write_ctx, code: 0 }))
        }
        (false, false, true) => {
            let bytes = unsafe { buffer(given.bytes, given.capacity, "sink.bytes")? };
            let length = unsafe { out(given.length, "sink.length")? };
            Ok(Sink::Buffer { bytes, length })
        }
        _ => {
            let problem = "must have just one of a path, a function and a buffer with a length";
            Err(Failure::Argument { name: "sink", problem })
        }
    }
}

impl Sink<'_> {
    /// Returns the path, if the file has one.
    pub(super) fn path(&self) -> Option<&Path> {
        match self {
            Sink::Path(path) => Some(Path::new(path)),
            _ => None,
        }
    }

    /// Writes a file in the way that suits the sink: saved to a path, written in pieces, or whole.
    pub(super) fn put(
        self,
        save: impl FnOnce(&str) -> Result<(), Error>,
        write: impl FnOnce(&mut Writer) -> Result<(), Error>,
        whole: impl FnOnce() -> Result<Vec<u8>, Error>,
    ) -> Result<(), Failure> {
        match self {
            Sink::Path(path) => Ok(save(path)?),
            Sink::Function(writer) => writer.run(write),
            Sink::Buffer { .. } => self.put_whole(&whole()?),
        }
    }

    /// Writes a file that is in memory.
    pub(super) fn put_whole(self, file: &[u8]) -> Result<(), Failure> {
        match self {
            Sink::Path(path) => Ok(replace(path, |to| Ok(to.write_all(file)?))?),
            Sink::Function(writer) => {
                writer.run(|to| file.chunks(PIECE).try_for_each(|piece| Ok(to.write_all(piece)?)))
            }
            Sink::Buffer { bytes, length } => {
                bytes.fill(file)?;
                length.write(file.len() as u64)
            }
        }
    }
}
