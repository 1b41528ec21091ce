//! Channels: what they hold, and the facts that travel with them.

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

/// Values inside a cube, in a tree of their own: a colour, a temperature, a material at every point, or at
/// some. leafless_octree_with_channel attaches it to a solid, in whose file it then travels. The tree may be
/// finer or coarser than the solid's.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_channel_free releases.
pub struct leafless_channel {
    pub(super) channel: Channel,
}

/// The type of the numbers of a channel. Numbers are rounded to the nearest one of the type, to an even
/// integer half-way.
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
    /// Where it lies: in the cube of its solid, with a depth of its own.
    pub frame: leafless_frame,
    /// The type of the numbers.
    pub scalar: leafless_scalar_type,
    /// How many numbers a value has: 1 to 4.
    pub components: u32,
    /// Values that are stored: one for each run of equal ones.
    pub value_count: u64,
    /// Array elements and bricks of the tree.
    pub elements: u64,
    /// Bytes that the channel takes in memory.
    pub bytes: u64,
}

output!(leafless_channel_info);

/// A handle of a channel.
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

/// Releases a reference to a channel. With the last one the channel is gone, and with it the mapping of its
/// file, unless an octree, an attribute, or a channel with other metadata still shares it.
///
/// - Buffers: `channel`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_channel_free(channel: *mut leafless_channel) {
    // SAFETY: the caller's promise.
    unsafe { release(channel) }
}

/// Returns basic facts about a channel. O(1), but for a channel of a file that was mapped unverified: when
/// such a channel is first read, by whichever function, its links are checked in one pass.
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

/// Checks that a channel is well-formed: O(n). Those that the library makes, opens or maps verified are.
///
/// - Result: LEAFLESS_OK if it is.
/// - Errors: LEAFLESS_E_DAMAGED, with the first damage in the message; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any channel.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_channel_check(channel: *const leafless_channel) -> leafless_status {
    guard(|| unsafe { Ok(shared(channel, "channel")?.channel.view()?.check()?) })
}

/// Whether two channels have the same values in the same cells, of one type and on one frame. Metadata does
/// not count. O(n).
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

/// The values of a channel as an attribute, which may be placed, or fill a channel on another frame. It has
/// no values outside the channel's cube.
///
/// - Buffers: `attribute`, one pointer.
/// - Result: `*attribute`.
/// - Errors: only the general ones; asking for its values returns LEAFLESS_E_DAMAGED if the channel was
///   mapped unverified and its links are damaged.
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

/// The channel with one more fact in its metadata, or with another value of one; the arrays are shared. Names
/// in use: "name", by which a solid knows the channel, "unit" (of the values), "meaning" (what they are, such
/// as "colour" or "density").
///
/// - Buffers: `key` and `value`, `key_length` and `value_length` bytes of UTF-8; `named`, one pointer.
/// - Result: `*named`.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_ARGUMENT if all facts would take more than 64 KiB in a file, 8 bytes
///   and the two texts each; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the texts are copied. `*named` shares the arrays of `channel`, which may be freed: what must
///   outlive `channel`, such as bytes that it views, must outlive `*named` too. Release that with
///   leafless_channel_free.
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

/// The channel with one fact less in its metadata, or with none; the arrays are shared.
///
/// - Buffers: `key`, `key_length` bytes of UTF-8, or NULL for all facts; `unnamed`, one pointer.
/// - Result: `*unnamed`; a fact that is not there need not be.
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

/// The value of a fact in a channel's metadata, such as "name".
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

/// A fact of a channel's metadata by its place among all, which stand by ascending key.
///
/// - Buffers: `count`, one number; `key`, `key_length`, `value`, `value_length`, one each, all four NULL to
///   get only the count.
/// - Result: `*count`, the number of all facts; key and value, not NUL-terminated, with their lengths in
///   bytes.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no fact `index`, unless only the count is asked for.
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
