//! Pointer checks, panic handling and error messages: the first and last steps of every function of the
//! interface.

use super::status::keep;
use super::status::leafless_status::{self, *};
use core::any::Any;
use core::ffi::{c_char, c_void};
use core::fmt::{self, Display};
use core::marker::PhantomData;
use core::mem::{align_of, size_of};
use core::ptr::NonNull;
use leafless::Error;
use leafless::error::FormatError;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// The reason why a call fails.
pub(super) enum Failure {
    Null {
        name: &'static str,
    },
    Argument {
        name: &'static str,
        problem: &'static str,
    },
    /// An element of an array is refused.
    Element {
        name: &'static str,
        index: u64,
        error: Error,
    },
    Utf8 {
        name: &'static str,
    },
    Nul {
        name: &'static str,
    },
    Buffer {
        name: &'static str,
        needed: u64,
        capacity: u64,
    },
    Busy {
        name: &'static str,
    },
    Library(Error),
}

impl<E: Into<Error>> From<E> for Failure {
    fn from(error: E) -> Failure {
        Failure::Library(error.into())
    }
}

impl Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::Null { name } => write!(f, "{name}: must not be NULL"),
            Failure::Argument { name, problem } => write!(f, "{name}: {problem}"),
            Failure::Element { name, index, error } => write!(f, "{name}[{index}]: {error}"),
            Failure::Utf8 { name } => write!(f, "{name}: is not UTF-8"),
            Failure::Nul { name } => write!(f, "{name}: holds a NUL"),
            Failure::Buffer { name, needed, capacity } => {
                write!(f, "{name}: has a capacity of {capacity}, and {needed} is needed")
            }
            Failure::Busy { name } => write!(f, "{name}: is in use by another call that has not returned"),
            Failure::Library(Error::File { path, error }) => {
                write!(f, "{}: {error}", end(&path.to_string_lossy()))
            }
            Failure::Library(error) => write!(f, "{error}"),
        }
    }
}

/// Returns the end of a path, so that the description of the problem fits beside it.
fn end(path: &str) -> &str {
    let start = path.len().saturating_sub(255);
    (start..=path.len()).find_map(|start| path.get(start..)).unwrap_or_default()
}

impl From<&Failure> for leafless_status {
    fn from(failure: &Failure) -> leafless_status {
        match failure {
            Failure::Null { .. } => LEAFLESS_E_NULL,
            Failure::Argument { .. } | Failure::Element { .. } => LEAFLESS_E_ARGUMENT,
            Failure::Utf8 { .. } | Failure::Nul { .. } => LEAFLESS_E_UTF8,
            Failure::Buffer { .. } => LEAFLESS_E_BUFFER,
            Failure::Busy { .. } => LEAFLESS_E_BUSY,
            Failure::Library(error) => match error.cause() {
                Error::Argument { .. } => LEAFLESS_E_ARGUMENT,
                Error::FrameMismatch { .. } => LEAFLESS_E_FRAME,
                Error::SourceMismatch => LEAFLESS_E_SOURCE,
                Error::NotSampled => LEAFLESS_E_NOT_SAMPLED,
                Error::Mesh(_) | Error::Polyhedron(_) => LEAFLESS_E_MESH,
                Error::MeshFile(_) | Error::Package(_) => LEAFLESS_E_MESH_FILE,
                Error::VolumeFile(_) => LEAFLESS_E_VOLUME_FILE,
                Error::Scene(_) => LEAFLESS_E_SCENE,
                Error::Format(FormatError::Version { .. } | FormatError::Required { .. }) => {
                    LEAFLESS_E_VERSION
                }
                // The host's address is wrong, not the contents.
                Error::Format(
                    FormatError::Alignment | FormatError::NotRegular | FormatError::OtherModel { .. },
                ) => LEAFLESS_E_ARGUMENT,
                Error::Format(_) => LEAFLESS_E_FORMAT,
                Error::Damaged(_) | Error::DamagedRays { .. } => LEAFLESS_E_DAMAGED,
                Error::Limit { .. } | Error::TooLarge { .. } => LEAFLESS_E_LIMIT,
                Error::OutOfMemory => LEAFLESS_E_NO_MEMORY,
                Error::Cancelled => LEAFLESS_E_CANCELLED,
                Error::Callback { .. } => LEAFLESS_E_CALLBACK,
                Error::Io(_) | Error::File { .. } => LEAFLESS_E_IO,
                // No other variant exists: a test compares this list with the library's.
                _ => LEAFLESS_E_ARGUMENT,
            },
        }
    }
}

/// Runs the body of a function.
///
/// A panic does not reach the host. No object that survives the panic can be half-changed: handles are
/// immutable, except atomic flags, cursors, bays, lazy octrees, editors and layouts. A cursor's position is
/// checked at every step. A bay changes in one step. A lazy octree changes only after the solid has answered.
/// An editor and a layout that a panic interrupted refuse every call.
#[inline(always)]
pub(super) fn guard(body: impl FnOnce() -> Result<(), Failure>) -> leafless_status {
    match catch_unwind(AssertUnwindSafe(body)) {
        Ok(Ok(())) => leafless_status::LEAFLESS_OK,
        Ok(Err(failure)) => refused(failure),
        Err(payload) => panicked(payload),
    }
}

/// Like [`guard`], for functions that cannot fail, such as `_free`.
fn guard_free(body: impl FnOnce()) {
    if let Err(payload) = catch_unwind(AssertUnwindSafe(body)) {
        panicked(payload);
    }
}

#[cold]
fn refused(failure: Failure) -> leafless_status {
    let status = leafless_status::from(&failure);
    let code = match &failure {
        Failure::Library(error) => match error.cause() {
            Error::Callback { code } => *code,
            _ => 0,
        },
        _ => 0,
    };
    keep(status, code, &failure);
    status
}

#[cold]
fn panicked(payload: Box<dyn Any + Send>) -> leafless_status {
    let text = match (payload.downcast_ref::<&str>(), payload.downcast_ref::<std::string::String>()) {
        (Some(text), _) => text,
        (_, Some(text)) => text.as_str(),
        _ => "no message",
    };
    let status = leafless_status::LEAFLESS_E_PANIC;
    keep(status, 0, &format_args!("a defect of the library, please report it: {text}"));
    status
}

#[inline(always)]
fn checked<T>(pointer: *const T, name: &'static str) -> Result<(), Failure> {
    if pointer.is_null() {
        return Err(Failure::Null { name });
    }
    if !pointer.is_aligned() {
        return Err(Failure::Argument { name, problem: "is misaligned for its type" });
    }
    Ok(())
}

/// Returns the `T` that `pointer` points to.
///
/// # Safety
/// Unless `pointer` is NULL or misaligned, it points to a `T` that lives and does not change during the call.
#[inline(always)]
pub(super) unsafe fn shared<'a, T>(pointer: *const T, name: &'static str) -> Result<&'a T, Failure> {
    checked(pointer, name)?;
    // SAFETY: neither NULL nor misaligned; the rest the caller promises.
    Ok(unsafe { &*pointer })
}

/// Returns the `T` that `pointer` points to, for changing it.
///
/// # Safety
/// As [`shared`], and nothing else uses the `T` during the call.
#[inline(always)]
pub(super) unsafe fn exclusive<'a, T>(pointer: *mut T, name: &'static str) -> Result<&'a mut T, Failure> {
    checked(pointer, name)?;
    // SAFETY: neither NULL nor misaligned; the rest the caller promises.
    Ok(unsafe { &mut *pointer })
}

/// Returns the `N` numbers at `pointer`.
///
/// # Safety
/// Unless `pointer` is NULL or misaligned, it points to `N` elements.
#[inline(always)]
pub(super) unsafe fn array<T: Copy, const N: usize>(
    pointer: *const T,
    name: &'static str,
) -> Result<[T; N], Failure> {
    checked(pointer, name)?;
    // SAFETY: neither NULL nor misaligned; the rest the caller promises.
    Ok(unsafe { *pointer.cast() })
}

/// Returns the `count` elements at `pointer`, which may be NULL if `count` is 0.
///
/// # Safety
/// Unless `pointer` is NULL or misaligned, it points to `count` elements that live and do not change during
/// the call.
pub(super) unsafe fn slice<'a, T>(
    pointer: *const T,
    count: u64,
    name: &'static str,
) -> Result<&'a [T], Failure> {
    if count == 0 {
        return Ok(&[]);
    }
    let count = length::<T>(pointer, count, name)?;
    // SAFETY: neither NULL nor misaligned, and not longer than memory can be; the caller promises the rest.
    Ok(unsafe { core::slice::from_raw_parts(pointer, count) })
}

fn length<T>(pointer: *const T, count: u64, name: &'static str) -> Result<usize, Failure> {
    checked(pointer, name)?;
    let most = isize::MAX as usize / size_of::<T>().max(1);
    match usize::try_from(count) {
        Ok(count) if count <= most => Ok(count),
        _ => Err(Failure::Argument { name, problem: "has more elements than memory can hold" }),
    }
}

/// Elements in the host's memory, at equal distances and at any address. The bytes between elements are not
/// read.
#[derive(Clone, Copy)]
pub(super) struct Strided<'a, T> {
    start: *const u8,
    stride: usize,
    len: usize,
    host: PhantomData<&'a T>,
}

/// Returns the `count` elements from `start` on. `stride` is the number of bytes from the start of one
/// element to the start of the next; 0 means that elements follow each other without gaps. `start` may be
/// NULL if `count` is 0. `names` are the names of `start` and `stride` in messages.
///
/// # Safety
/// Any bytes are a valid `T`. `start` is NULL, or points to `count` elements that live and do not change
/// during the call.
pub(super) unsafe fn strided<'a, T>(
    start: *const c_void,
    count: u64,
    stride: u64,
    names: [&'static str; 2],
) -> Result<Strided<'a, T>, Failure> {
    let size = size_of::<T>() as u64;
    let stride = if stride == 0 { size } else { stride };
    if stride < size {
        let problem = "must be 0 or at least the size of an element";
        return Err(Failure::Argument { name: names[1], problem });
    }
    if count == 0 {
        return Ok(Strided { start: NonNull::dangling().as_ptr(), stride: 0, len: 0, host: PhantomData });
    }
    // The span runs from the first byte of the first element to the last byte of the last element.
    let span = stride.checked_mul(count - 1).and_then(|before| before.checked_add(size));
    length::<u8>(start.cast(), span.unwrap_or(u64::MAX), names[0])?;
    // Both fit because the span fits. The stride of a single element need not fit, and is not used.
    let stride = usize::try_from(stride).unwrap_or(0);
    Ok(Strided { start: start.cast(), stride, len: count as usize, host: PhantomData })
}

impl<T: Copy> Strided<'_, T> {
    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// Returns the element with this index, which must exist.
    #[inline(always)]
    pub(super) fn at(&self, index: usize) -> T {
        assert!(index < self.len, "index {index} of {}", self.len);
        // SAFETY: one of the elements promised to `strided`; its offset is less than the span, which is no
        // longer than memory can be.
        unsafe { self.start.add(index * self.stride).cast::<T>().read_unaligned() }
    }
}

impl<'a, T> Strided<'a, T> {
    /// Returns the elements as a slice, if they are aligned and follow each other without gaps.
    pub(super) fn as_slice(&self) -> Option<&'a [T]> {
        if self.len == 0 {
            return Some(&[]);
        }
        let start = self.start.cast::<T>();
        let is_packed = self.stride == size_of::<T>() || self.len == 1;
        // SAFETY: promised to `strided`: `len` elements that live and do not change during the call. Their
        // span is no longer than memory can be.
        (is_packed && start.is_aligned()).then(|| unsafe { core::slice::from_raw_parts(start, self.len) })
    }
}

/// Returns the UTF-8 text of `length` bytes at `pointer`, which may be NULL if `length` is 0.
///
/// # Safety
/// As [`slice`].
pub(super) unsafe fn text<'a>(
    pointer: *const c_char,
    length: usize,
    name: &'static str,
) -> Result<&'a str, Failure> {
    // SAFETY: the caller's promise is that of `slice`.
    let bytes = unsafe { slice(pointer.cast(), length as u64, name)? };
    core::str::from_utf8(bytes).map_err(|_| Failure::Utf8 { name })
}

/// Returns the path of `length` bytes of UTF-8 at `pointer`.
///
/// # Safety
/// As [`slice`].
pub(super) unsafe fn named_path<'a>(
    pointer: *const c_char,
    length: usize,
    name: &'static str,
) -> Result<&'a str, Failure> {
    checked(pointer, name)?;
    // SAFETY: the caller's promise is that of `slice`.
    let path = unsafe { text(pointer, length, name)? };
    if path.is_empty() {
        return Err(Failure::Argument { name, problem: "is empty" });
    }
    if path.contains('\0') {
        return Err(Failure::Nul { name });
    }
    Ok(path)
}

/// Checks at compile time what the header promises about handles and threads.
const _: () = {
    const fn shared_by_threads<T: Send + Sync>() {}
    shared_by_threads::<super::leafless_control>();
    shared_by_threads::<super::leafless_mesh>();
    shared_by_threads::<super::leafless_octree>();
    shared_by_threads::<super::leafless_scene>();
    shared_by_threads::<super::leafless_solid>();
    shared_by_threads::<super::leafless_volume>();
    shared_by_threads::<super::leafless_attribute>();
    shared_by_threads::<super::leafless_channel>();
    shared_by_threads::<super::leafless_layer>();
    shared_by_threads::<super::leafless_lazy>();
    shared_by_threads::<super::leafless_cursor>();
    shared_by_threads::<super::leafless_point_cursor>();
    shared_by_threads::<super::leafless_cells>();
    shared_by_threads::<super::leafless_faces>();
    shared_by_threads::<super::leafless_columns>();
    shared_by_threads::<super::leafless_tridexel>();
    shared_by_threads::<super::leafless_tridexel_editor>();
    shared_by_threads::<super::leafless_bay>();
    shared_by_threads::<super::leafless_layout>();
};

/// The location of a result, checked before the work begins and written when the work is done.
pub(super) struct Out<T>(NonNull<T>);

/// # Safety
/// Unless it is NULL or misaligned, `pointer` points to room for a `T` that nothing else uses during the
/// call.
#[inline(always)]
pub(super) unsafe fn out<T>(pointer: *mut T, name: &'static str) -> Result<Out<T>, Failure> {
    checked(pointer, name)?;
    NonNull::new(pointer).map(Out).ok_or(Failure::Null { name })
}

impl<T> Out<T> {
    #[inline(always)]
    pub(super) fn write(self, value: T) -> Result<(), Failure> {
        // SAFETY: promised to `out`. The old value is not dropped, because it may be uninitialised.
        unsafe { self.0.write(value) };
        Ok(())
    }
}

/// A buffer for many elements. It is absent if only the number of elements is wanted.
pub(super) struct Buffer<T> {
    name: &'static str,
    start: *mut T,
    capacity: u64,
}

/// # Safety
/// Unless it is NULL or misaligned, `start` points to room for `capacity` elements that nothing else uses
/// during the call.
pub(super) unsafe fn buffer<T>(
    start: *mut T,
    capacity: u64,
    name: &'static str,
) -> Result<Buffer<T>, Failure> {
    if capacity > 0 || !start.is_null() {
        length(start, capacity, name)?;
    }
    Ok(Buffer { name, start, capacity })
}

impl<T: Copy> Buffer<T> {
    /// Returns whether elements are wanted, and not only their number.
    pub(super) fn wanted(&self) -> bool {
        !self.start.is_null()
    }

    /// Returns an error if there is a buffer that is too small for `count` elements.
    pub(super) fn check(&self, count: usize) -> Result<(), Failure> {
        if self.wanted() && count as u64 > self.capacity {
            let (name, capacity) = (self.name, self.capacity);
            return Err(Failure::Buffer { name, needed: count as u64, capacity });
        }
        Ok(())
    }

    /// Fills the buffer, if there is one.
    pub(super) fn fill(&self, elements: &[T]) -> Result<(), Failure> {
        self.check(elements.len())?;
        if self.wanted() {
            // SAFETY: promised to `buffer`, and there is room for them.
            unsafe { core::ptr::copy_nonoverlapping(elements.as_ptr(), self.start, elements.len()) };
        }
        Ok(())
    }

    /// Writes one element, if there is a buffer with room for it.
    #[inline]
    pub(super) fn put(&self, index: usize, element: T) {
        if self.wanted() && (index as u64) < self.capacity {
            // SAFETY: promised to `buffer`, and there is room.
            unsafe { self.start.add(index).write(element) };
        }
    }

    /// Returns the first `count` elements of the buffer, set to zero; `None` if there is no buffer.
    ///
    /// # Safety
    /// The promise made to [`buffer`] holds for `'a`, and there is no other slice of the buffer.
    pub(super) unsafe fn zeroed<'a>(&self, count: usize) -> Result<Option<&'a mut [T]>, Failure>
    where
        T: bytemuck::Zeroable,
    {
        self.check(count)?;
        if !self.wanted() {
            return Ok(None);
        }
        // SAFETY: promised to `buffer`, and there is room for them; zero bytes are a `T`.
        unsafe {
            self.start.write_bytes(0, count);
            Ok(Some(core::slice::from_raw_parts_mut(self.start, count)))
        }
    }

    /// Fills the buffer, if there is one, with the C forms of elements of the library.
    pub(super) fn fill_with<'e, E>(&self, elements: &'e [E]) -> Result<(), Failure>
    where
        T: From<&'e E>,
    {
        self.check(elements.len())?;
        if self.wanted() {
            for (index, element) in elements.iter().enumerate() {
                // SAFETY: promised to `buffer`, and there is room for them.
                unsafe { self.start.add(index).write(element.into()) };
            }
        }
        Ok(())
    }
}

/// A struct of the host that begins with its own size. Older hosts have shorter structs, newer hosts longer
/// ones.
///
/// # Safety
/// All-zero bytes are a valid `T`.
pub(super) unsafe trait Sized32: Copy {}

/// The largest size in bytes that a struct of any version has.
const LARGEST_STRUCT: usize = 4096;

/// Returns whether a host's struct can have this size. The struct of every version has a size that is a
/// multiple of its alignment, so no version ends within a field, and half a pointer is never read.
fn sensible<T>(size: usize) -> bool {
    (size_of::<u32>()..=LARGEST_STRUCT).contains(&size) && size.is_multiple_of(align_of::<T>())
}

/// Returns the host's struct, or the default (all zero) if `pointer` is NULL. Fields that an older host lacks
/// are zero. Fields that this library lacks must be zero.
///
/// # Safety
/// Unless `pointer` is NULL or misaligned, it points to as many bytes as its first four bytes say.
pub(super) unsafe fn sized<T: Sized32>(pointer: *const T, name: &'static str) -> Result<T, Failure> {
    // SAFETY: a promise of the trait.
    let mut known: T = unsafe { core::mem::zeroed() };
    if pointer.is_null() {
        return Ok(known);
    }
    checked(pointer, name)?;
    // SAFETY: the caller promises four bytes, and then as many as they say.
    let given = unsafe {
        let size = pointer.cast::<u32>().read() as usize;
        if !sensible::<T>(size) {
            return Err(Failure::Argument {
                name,
                problem: "has no sensible struct_size; was it initialised?",
            });
        }
        core::slice::from_raw_parts(pointer.cast::<u8>(), size)
    };
    let (given, unknown) = given.split_at(given.len().min(size_of::<T>()));
    if unknown.iter().any(|&byte| byte != 0) {
        let problem = "has fields that this version of the library does not know";
        return Err(Failure::Argument { name, problem });
    }
    // SAFETY: not longer than `known`; the fields are numbers, pointers and functions that the host has set.
    unsafe { core::ptr::copy_nonoverlapping(given.as_ptr(), (&raw mut known).cast(), given.len()) };
    Ok(known)
}

/// A struct that the library fills and that begins with its own size, which the host sets. Older hosts have
/// shorter structs, newer hosts longer ones.
///
/// # Safety
/// The struct is `repr(C)`, and its first field is `struct_size`, a `u32`. [`output`] ensures that.
pub(super) unsafe trait Output: Copy {}

/// Declares that a struct is an [`Output`].
macro_rules! output {
    ($name:ident) => {
        const _: () = assert!(core::mem::offset_of!($name, struct_size) == 0);
        // SAFETY: as just checked; `layout` has the fields of all structs.
        unsafe impl $crate::boundary::Output for $name {}
    };
}
pub(super) use output;

/// The location of an output, checked before the work begins and written when the work is done.
pub(super) struct Filled<T> {
    start: NonNull<T>,
    size: usize,
}

/// # Safety
/// Unless `pointer` is NULL or misaligned, it points to as many bytes as its first four bytes say. Nothing
/// else uses these bytes during the call.
pub(super) unsafe fn filled<T: Output>(pointer: *mut T, name: &'static str) -> Result<Filled<T>, Failure> {
    checked(pointer, name)?;
    // SAFETY: the caller promises four bytes.
    let size = unsafe { pointer.cast::<u32>().read() } as usize;
    if !sensible::<T>(size) {
        let problem = "has no sensible struct_size; was it initialised?";
        return Err(Failure::Argument { name, problem });
    }
    NonNull::new(pointer).map(|start| Filled { start, size }).ok_or(Failure::Null { name })
}

impl<T: Output> Filled<T> {
    /// Writes the fields that the host's struct has room for. The struct's size, and fields that this library
    /// does not know, are unchanged.
    pub(super) fn write(self, value: T) -> Result<(), Failure> {
        const FIRST: usize = size_of::<u32>();
        let end = self.size.min(size_of::<T>());
        // SAFETY: promised to `filled`, and within both structs.
        unsafe {
            let from = (&raw const value).cast::<u8>().add(FIRST);
            core::ptr::copy_nonoverlapping(from, self.start.as_ptr().cast::<u8>().add(FIRST), end - FIRST);
        }
        Ok(())
    }
}

/// Sets a struct of the host to its default: the size in the first field, and zeros.
///
/// # Safety
/// Unless it is NULL or misaligned, `pointer` points to room for `size` bytes.
pub(super) unsafe fn initialise(pointer: *mut c_void, size: usize) -> Result<(), Failure> {
    checked(pointer.cast::<u32>(), "value")?;
    if !sensible::<u32>(size) {
        return Err(Failure::Argument { name: "struct_size", problem: "must be sizeof of the struct" });
    }
    // SAFETY: the caller's promise.
    unsafe {
        pointer.cast::<u8>().write_bytes(0, size);
        pointer.cast::<u32>().write(size as u32);
    }
    Ok(())
}

/// Returns a new handle with one reference.
pub(super) fn handle<T>(value: T) -> *mut T {
    Arc::into_raw(Arc::new(value)).cast_mut()
}

/// Returns one more share of a handle's object. The code uses no Rust reference, because the count lies
/// outside the memory that a reference covers.
///
/// # Safety
/// The handle is NULL or misaligned, or it is alive and came from [`handle`].
pub(super) unsafe fn share<T>(handle: *const T, name: &'static str) -> Result<Arc<T>, Failure> {
    checked(handle, name)?;
    // SAFETY: `handle` came from `Arc::into_raw`.
    Ok(unsafe {
        Arc::increment_strong_count(handle);
        Arc::from_raw(handle)
    })
}

/// Writes one more reference to a handle.
///
/// # Safety
/// As [`share`] and [`out`].
pub(super) unsafe fn refer<T>(
    handle: *const T,
    name: &'static str,
    reference: *mut *mut T,
) -> Result<(), Failure> {
    checked(handle, name)?;
    // SAFETY: the caller's promises.
    unsafe {
        let reference = out(reference, "reference")?;
        reference.write(Arc::into_raw(share(handle, name)?).cast_mut())
    }
}

/// Releases one reference.
///
/// # Safety
/// The handle is NULL, or alive and came from [`handle`]; the reference is the caller's.
pub(super) unsafe fn release<T>(handle: *mut T) {
    if !handle.is_null() {
        // SAFETY: `handle` came from `Arc::into_raw`.
        guard_free(|| drop(unsafe { Arc::from_raw(handle.cast_const()) }));
    }
}

/// Releases a handle that nothing shares.
///
/// # Safety
/// The handle is NULL, or alive and came from `Box::into_raw`; no other call uses it.
pub(super) unsafe fn discard<T>(handle: *mut T) {
    if !handle.is_null() {
        // SAFETY: `handle` came from `Box::into_raw`.
        guard_free(|| drop(unsafe { Box::from_raw(handle) }));
    }
}

/// Panics inside, to test how a panic is handled. It exists only in libraries that are built for tests.
///
/// - Result: LEAFLESS_E_PANIC.
#[cfg(feature = "test")]
#[unsafe(no_mangle)]
pub extern "C" fn leafless_test_panic() -> leafless_status {
    guard(|| panic!("as the test wanted"))
}
