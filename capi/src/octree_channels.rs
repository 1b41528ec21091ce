//! The channels of octrees.

use super::boundary::{Failure, guard, out, shared, slice, text};
use super::channel::{give as give_channel, leafless_channel};
use super::control::{controlled, leafless_options};
use super::number::{Number, enumeration};
use super::octree::{give, leafless_octree};
use super::operation::operands;
use super::status::leafless_status;
use core::ffi::c_char;
use leafless::attribute::{CarryRule, carry_channels};
use leafless::memory;

/// The rule for the value of a point that lies in several operands.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_carry {
    /// The value of the first operand that has one.
    LEAFLESS_CARRY_LEFT = 0,
    /// The value of the last operand that has one.
    LEAFLESS_CARRY_RIGHT = 1,
    /// The greatest of all values, number by number.
    LEAFLESS_CARRY_MAX = 2,
    /// The mean of all values, number by number, rounded to the type.
    LEAFLESS_CARRY_MEAN = 3,
}

enumeration! {
    leafless_carry => CarryRule {
        LEAFLESS_CARRY_LEFT => CarryRule::Left,
        LEAFLESS_CARRY_RIGHT => CarryRule::Right,
        LEAFLESS_CARRY_MAX => CarryRule::Max,
        LEAFLESS_CARRY_MEAN => CarryRule::Mean,
    }
}

/// The rule for carrying channels of one name.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_carry_rule {
    /// The name of the channels, `name_length` bytes of UTF-8.
    pub name: *const c_char,
    /// Length of the name in bytes.
    pub name_length: usize,
    /// A leafless_carry.
    pub carry: Number<leafless_carry>,
}

/// Returns the octree with one more channel, which replaces a channel of the same name; the arrays of both
/// are shared. A channel without a name has the empty name.
///
/// - Buffers: `result`, one pointer.
/// - Result: `*result`, with the metadata of `octree`.
/// - Errors: LEAFLESS_E_FRAME if the channel lies in another cube than the octree; LEAFLESS_E_ARGUMENT if
///   there are 256 channels already; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `*result` shares the arrays of `octree` and `channel`, which may be freed. Bytes that these
///   view must outlive `*result` too, and files that they map must stay unchanged as long. Release `*result`
///   with leafless_octree_free.
/// - Untrusted input: any octree, any channel.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_with_channel(
    octree: *const leafless_octree,
    channel: *const leafless_channel,
    result: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let channel = &shared(channel, "channel")?.channel;
        let result = out(result, "result")?;
        result.write(give(octree.with_channel(channel.clone())?))
    })
}

/// Returns the octree without the channel of a name, or without all channels; the arrays are shared.
///
/// - Buffers: `name`, `name_length` bytes of UTF-8, or NULL for all channels; `result`, one pointer.
/// - Result: `*result`, with the metadata of `octree`; it is not an error if there is no such channel.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_octree_with_channel.
/// - Untrusted input: any octree, any text.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_without_channel(
    octree: *const leafless_octree,
    name: *const c_char,
    name_length: usize,
    result: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let result = out(result, "result")?;
        result.write(give(match name.is_null() {
            true => octree.without_channels(),
            false => octree.without_channel(text(name, name_length, "name")?)?,
        }))
    })
}

/// Returns a channel of an octree by its index. Channels are sorted by name.
///
/// - Buffers: `channel`, one pointer.
/// - Result: `*channel`.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no channel `index`.
/// - Ownership: `*channel` shares the arrays of `octree`, which may be freed. Bytes that `octree` views must
///   outlive `*channel` too, and a file that it maps must stay unchanged as long. Release `*channel` with
///   leafless_channel_free.
/// - Untrusted input: any octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_channel_at(
    octree: *const leafless_octree,
    index: u64,
    channel: *mut *mut leafless_channel,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let channel = out(channel, "channel")?;
        let found = usize::try_from(index).ok().and_then(|index| octree.channels().get(index));
        let missing = Failure::Argument { name: "index", problem: "is not below the number of channels" };
        channel.write(give_channel(found.ok_or(missing)?.clone()))
    })
}

/// Returns the channel of an octree with a name.
///
/// - Buffers: `name`, `name_length` bytes of UTF-8; `channel`, one pointer.
/// - Result: `*channel`; NULL if there is no such channel.
/// - Errors: LEAFLESS_E_UTF8.
/// - Ownership: as leafless_octree_channel_at.
/// - Untrusted input: any octree, any text.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_channel(
    octree: *const leafless_octree,
    name: *const c_char,
    name_length: usize,
    channel: *mut *mut leafless_channel,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let name = text(name, name_length, "name")?;
        let channel = out(channel, "channel")?;
        let found = octree.channel(name).map(|found| give_channel(found.clone()));
        channel.write(found.unwrap_or(core::ptr::null_mut()))
    })
}

/// Returns an octree with the channels of its operands. The octree was made by any operation from operands in
/// the same cube. Channels of one name become one channel, in which, at each point, the values of the
/// operands count that are not EMPTY there. A channel that only one operand has is shared unchanged. The
/// result is identical, bit for bit, for any number of threads.
///
/// - Buffers: `octree`, a handle; `operands`, `count` handles; `carry`, a leafless_carry, the rule for
///   channels that none of `rules` names; `rules`, `rule_count` structs, or NULL if that is 0; the first rule
///   that names a channel applies. `options`, one struct or NULL, whose limits apply to each channel;
///   `result`, one pointer.
/// - Result: `*result`: the cells and metadata of `octree`; its own channels, except those whose name a
///   channel of an operand has; each such channel with the metadata of the first operand that has it.
/// - Errors: LEAFLESS_E_ARGUMENT if channels of one name have values of two types, or there are more than
///   256; LEAFLESS_E_FRAME unless all lie in one cube; LEAFLESS_E_UTF8; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT;
///   LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_octree_with_channel.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octrees, any texts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_carry_channels(
    octree: *const leafless_octree,
    operands: *const *const leafless_octree,
    count: u64,
    carry: Number<leafless_carry>,
    rules: *const leafless_carry_rule,
    rule_count: u64,
    options: *const leafless_options,
    result: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let octrees = self::operands(operands, count, true, "operands", |handle| &handle.octree)?;
        let carry = carry.known("carry")?;
        let rules = slice(rules, rule_count, "rules")?;
        let result = out(result, "result")?;
        let mut named = memory::with_capacity(rules.len())?;
        for given in rules {
            let name = text(given.name, given.name_length, "rules.name")?;
            named.push((name, given.carry.known("rules.carry")?));
        }
        let of = |name: &str| named.iter().find(|(known, _)| *known == name).map_or(carry, |&(_, rule)| rule);
        let made = controlled(options, |control| carry_channels(octree, &octrees, of, control))?;
        result.write(give(made))
    })
}
