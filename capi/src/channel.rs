//! Channels: description, comparison, metadata, and use as attributes.

use super::attribute::{give as give_attribute, leafless_attribute};
use super::boundary::{filled, guard, handle, out, output, refer, release, shared};
use super::frame::leafless_frame;
use super::metadata::{self, Fact};
use super::number::enumeration;
use super::status::leafless_status;
use core::ffi::c_char;
use leafless::attribute::{Channel, ScalarType};
use leafless::octree::MetadataLimit;
use leafless_scalar_type::*;

/// Values inside a cube, stored in a tree of their own: a colour, a temperature or a material at every point,
/// or at some points. leafless_octree_with_channel attaches a channel to an octree, whose file then contains
/// it. The tree may be finer or coarser than the octree.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_channel_free releases.
pub struct leafless_channel {
    pub(super) channel: Channel,
}

/// The type of the numbers of a channel. Numbers are rounded to the nearest number of the type; half-way
/// cases go to the even integer.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_scalar_type {
    /// Finite numbers of single precision.
    LEAFLESS_SCALAR_TYPE_F32 = 0,
    /// Integers from 0 to 255.
    LEAFLESS_SCALAR_TYPE_U8 = 1,
    /// Integers from 0 to 65 535.
    LEAFLESS_SCALAR_TYPE_U16 = 2,
    /// Integers from 0 to 4 294 967 295.
    LEAFLESS_SCALAR_TYPE_U32 = 3,
}

enumeration! {
    leafless_scalar_type => ScalarType {
        LEAFLESS_SCALAR_TYPE_F32 => ScalarType::F32,
        LEAFLESS_SCALAR_TYPE_U8 => ScalarType::U8,
        LEAFLESS_SCALAR_TYPE_U16 => ScalarType::U16,
        LEAFLESS_SCALAR_TYPE_U32 => ScalarType::U32,
    }
}

impl From<ScalarType> for leafless_scalar_type {
    fn from(scalar: ScalarType) -> leafless_scalar_type {
        match scalar {
            ScalarType::F32 => LEAFLESS_SCALAR_TYPE_F32,
            ScalarType::U8 => LEAFLESS_SCALAR_TYPE_U8,
            ScalarType::U16 => LEAFLESS_SCALAR_TYPE_U16,
            ScalarType::U32 => LEAFLESS_SCALAR_TYPE_U32,
        }
    }
}

/// Basic facts about a channel.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_channel_info {
    /// sizeof(leafless_channel_info).
    pub struct_size: u32,
    /// The frame: the cube of its solid, with a depth of its own.
    pub frame: leafless_frame,
    /// The type of the numbers.
    pub scalar: leafless_scalar_type,
    /// Numbers per value: 1 to 4.
    pub components: u32,
    /// Number of stored values: one for each run of equal values.
    pub value_count: u64,
    /// Array elements and bricks of the tree.
    pub elements: u64,
    /// Bytes that the channel takes in memory.
    pub bytes: u64,
}

output!(leafless_channel_info);

/// Returns a handle of a channel.
pub(super) fn give(channel: Channel) -> *mut leafless_channel {
    handle(leafless_channel { channel })
}

/// Returns one more reference to a channel.
///
/// - Buffers: `channel`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `channel`.
/// - Ownership: release each reference with leafless_channel_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_channel_ref(
    channel: *const leafless_channel,
    reference: *mut *mut leafless_channel,
) -> leafless_status {
    guard(|| unsafe { refer(channel, "channel", reference) })
}

/// Releases a reference to a channel. The last release frees the channel. The mapping of its file ends too,
/// unless an octree, an attribute, or a channel with other metadata still shares it.
///
/// - Buffers: `channel`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_channel_free(channel: *mut leafless_channel) {
    // SAFETY: the caller's promise.
    unsafe { release(channel) }
}

/// Returns basic facts about a channel. O(1), except for a channel of a file that was mapped unverified: the
/// first function that reads it checks its links in one pass.
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
/// - Errors: LEAFLESS_E_DAMAGED.
/// - Untrusted input: any channel.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_channel_describe(
    channel: *const leafless_channel,
    info: *mut leafless_channel_info,
) -> leafless_status {
    guard(|| unsafe {
        let channel = &shared(channel, "channel")?.channel;
        let info = filled(info, "info")?;
        let value_type = channel.value_type();
        info.write(leafless_channel_info {
            struct_size: size_of::<leafless_channel_info>() as u32,
            frame: channel.frame().into(),
            scalar: value_type.scalar().into(),
            components: value_type.components() as u32,
            value_count: channel.value_count(),
            elements: channel.view()?.element_count(),
            bytes: channel.bytes(),
        })
    })
}

/// Checks that a channel is well-formed: O(n). Channels that the library makes, opens or maps verified always
/// are.
///
/// - Result: LEAFLESS_OK if the check passes.
/// - Errors: LEAFLESS_E_DAMAGED, with the first damage in the message; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any channel.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_channel_check(channel: *const leafless_channel) -> leafless_status {
    guard(|| unsafe { Ok(shared(channel, "channel")?.channel.view()?.check()?) })
}

/// Returns whether two channels have the same values of the same type in the same cells, on the same frame.
/// Metadata is not compared. O(n).
///
/// - Buffers: `equal`, one truth value.
/// - Result: `*equal`.
/// - Untrusted input: any channels.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_channel_equal(
    a: *const leafless_channel,
    b: *const leafless_channel,
    equal: *mut bool,
) -> leafless_status {
    guard(|| unsafe {
        let (a, b) = (shared(a, "a")?, shared(b, "b")?);
        out(equal, "equal")?.write(a.channel == b.channel)
    })
}

/// Makes an attribute from the values of a channel, for example to place them, or to fill a channel on
/// another frame. It has no values outside the channel's cube.
///
/// - Buffers: `attribute`, one pointer.
/// - Result: `*attribute`.
/// - Errors: only the general ones; reading its values returns LEAFLESS_E_DAMAGED if the channel was mapped
///   unverified and its links are damaged.
/// - Ownership: the attribute shares the channel, which may be freed; release `*attribute` with
///   leafless_attribute_free.
/// - Untrusted input: any channel.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_attribute_from_channel(
    channel: *const leafless_channel,
    attribute: *mut *mut leafless_attribute,
) -> leafless_status {
    guard(|| unsafe {
        let channel = &shared(channel, "channel")?.channel;
        let attribute = out(attribute, "attribute")?;
        attribute.write(give_attribute(channel.clone()))
    })
}

/// Returns the channel with one more fact in its metadata, or with a new value of a fact; the arrays are
/// shared. Names in use: "name" (by which an octree finds the channel), "unit" (of the values), "meaning" (of
/// the values, such as "colour" or "density").
///
/// - Buffers: `key` and `value`, `key_length` and `value_length` bytes of UTF-8; `named`, one pointer.
/// - Result: `*named`.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_ARGUMENT if all facts would take more than 64 KiB in a file (each
///   takes 8 bytes and its two texts); LEAFLESS_E_NO_MEMORY.
/// - Ownership: the texts are copied. `*named` shares the arrays of `channel`, which may be freed. Bytes that
///   `channel` views must outlive `*named` too, and a file that it maps must stay unchanged as long. Release
///   `*named` with leafless_channel_free.
/// - Untrusted input: any texts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_channel_with_metadata(
    channel: *const leafless_channel,
    key: *const c_char,
    key_length: usize,
    value: *const c_char,
    value_length: usize,
    named: *mut *mut leafless_channel,
) -> leafless_status {
    guard(|| unsafe {
        let channel = &shared(channel, "channel")?.channel;
        let named = out(named, "named")?;
        let (key, value) = ((key, key_length), (value, value_length));
        let facts = metadata::with(channel.metadata(), key, value, MetadataLimit::CHANNEL)?;
        named.write(give(channel.with_metadata(facts)))
    })
}

/// Returns the channel with one fact less in its metadata, or without metadata; the arrays are shared.
///
/// - Buffers: `key`, `key_length` bytes of UTF-8, or NULL for all facts; `unnamed`, one pointer.
/// - Result: `*unnamed`; it is not an error if there is no such fact.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_channel_with_metadata.
/// - Untrusted input: any texts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_channel_without_metadata(
    channel: *const leafless_channel,
    key: *const c_char,
    key_length: usize,
    unnamed: *mut *mut leafless_channel,
) -> leafless_status {
    guard(|| unsafe {
        let channel = &shared(channel, "channel")?.channel;
        let unnamed = out(unnamed, "unnamed")?;
        unnamed.write(give(channel.with_metadata(metadata::without(channel.metadata(), key, key_length)?)))
    })
}

/// Returns the value of a fact in a channel's metadata, such as "name".
///
/// - Buffers: `key`, `key_length` bytes of UTF-8; `value` and `value_length`, one each.
/// - Result: `*value`, not NUL-terminated; NULL if there is no such fact. `*value_length`, in bytes.
/// - Errors: LEAFLESS_E_UTF8.
/// - Ownership: the text belongs to the channel and lives as long as the reference `channel`.
/// - Untrusted input: any channel.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_channel_peek_metadata(
    channel: *const leafless_channel,
    key: *const c_char,
    key_length: usize,
    value: *mut *const c_char,
    value_length: *mut usize,
) -> leafless_status {
    guard(|| unsafe {
        let channel = &shared(channel, "channel")?.channel;
        metadata::peek(channel.metadata(), key, key_length, value, value_length)
    })
}

/// Returns a fact of a channel's metadata by its index. Facts are sorted by key.
///
/// - Buffers: `count`, one number; `key`, `key_length`, `value`, `value_length`, one each, all four NULL to
///   get only the count.
/// - Result: `*count`, the number of all facts; key and value, not NUL-terminated, with their lengths in
///   bytes.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no fact `index`, unless only the count is requested.
/// - Ownership: the texts belong to the channel and live as long as the reference `channel`.
/// - Untrusted input: any channel.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_channel_peek_metadata_at(
    channel: *const leafless_channel,
    index: u64,
    count: *mut u64,
    key: *mut *const c_char,
    key_length: *mut usize,
    value: *mut *const c_char,
    value_length: *mut usize,
) -> leafless_status {
    guard(|| unsafe {
        let channel = &shared(channel, "channel")?.channel;
        let fact = Fact { key, key_length, value, value_length };
        metadata::peek_at(channel.metadata(), index, count, fact)
    })
}
