//! Operations that make octrees: building, resolving, set algebra.

use super::boundary::{guard, out, shared};
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame};
use super::number::{Number, enumeration};
use super::octree::{give, leafless_octree};
use super::operation::{leafless_operation, leafless_operation::*, operands};
use super::solid::leafless_solid;
use super::status::leafless_status;
use leafless::op::{difference_of, intersection_of, resolve, union_of, xor_of};
use leafless::{Metadata, Rule, build, compact, memory};

/// The rule for finest cells that are not decided.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_rule {
    /// They stay PARTIAL: FULL cells are proven full, EMPTY cells proven empty.
    LEAFLESS_RULE_CERTIFIED = 0,
    /// The centre of the cell decides.
    LEAFLESS_RULE_SAMPLED = 1,
    /// They become EMPTY: the result lies in the solid.
    LEAFLESS_RULE_INNER = 2,
    /// They become FULL: the result covers the solid.
    LEAFLESS_RULE_OUTER = 3,
}

enumeration! {
    leafless_rule => Rule {
        LEAFLESS_RULE_CERTIFIED => Rule::Certified,
        LEAFLESS_RULE_SAMPLED => Rule::Sampled,
        LEAFLESS_RULE_INNER => Rule::Inner,
        LEAFLESS_RULE_OUTER => Rule::Outer,
    }
}

/// Builds the octree of a solid to the depth of a frame. The result is identical, bit for bit, for any number
/// of threads.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `octree`, one pointer. `rule` is a
///   leafless_rule.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_FRAME if the solid belongs to another frame; LEAFLESS_E_NOT_SAMPLED if `rule` is
///   LEAFLESS_RULE_SAMPLED and the solid cannot decide points; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED;
///   LEAFLESS_E_ARGUMENT; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*octree` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid; set `max_bytes` if the depth or the solid is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_build(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    rule: Number<leafless_rule>,
    options: *const leafless_options,
    octree: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        let frame = self::frame(frame)?;
        let rule = rule.known("rule")?;
        let octree = out(octree, "octree")?;
        octree.write(give(controlled(options, |control| build(solid, &frame, rule, control))?))
    })
}

/// Returns the octree with its PARTIAL cells resolved: EMPTY under LEAFLESS_RULE_INNER, FULL under
/// LEAFLESS_RULE_OUTER. An octree that keeps surfaces is refused, because its cells are few and large:
/// leafless_octree_plain resolves it at a depth.
///
/// - Buffers: `options`, one struct or NULL; `resolved`, one pointer. `rule` is a leafless_rule.
/// - Result: `*resolved`, with the octree's channels and, of its metadata, the facts "name" and "units".
/// - Errors: LEAFLESS_E_NOT_SAMPLED under LEAFLESS_RULE_SAMPLED if a cell is PARTIAL, because a stored octree
///   has no more information about the cell; LEAFLESS_E_ARGUMENT, also if the octree keeps surfaces;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `octree` is unchanged; release `*resolved` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_resolve(
    octree: *const leafless_octree,
    rule: Number<leafless_rule>,
    options: *const leafless_options,
    resolved: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let rule = rule.known("rule")?;
        let resolved = out(resolved, "resolved")?;
        let made = controlled(options, |control| resolve(octree.view(), rule, control))?;
        let made = made.with_metadata(Metadata::common([octree.metadata()])?);
        resolved.write(give(made.with_channels_from(octree)))
    })
}

/// Returns the same octree with its bricks encoded as in a file, through a dictionary where that is shorter.
/// All functions accept it like any other octree.
///
/// - Buffers: `compacted`, one pointer.
/// - Result: `*compacted`, with the same metadata and channels.
/// - Errors: LEAFLESS_E_DAMAGED if a brick cannot be read; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `octree` is unchanged; release `*compacted` with leafless_octree_free.
/// - Untrusted input: any octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_compact(
    octree: *const leafless_octree,
    compacted: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let compacted = out(compacted, "compacted")?;
        let compact = compact(octree.view())?.with_metadata_from(octree);
        compacted.write(give(compact.with_channels_from(octree)))
    })
}

/// Combines octrees, at least one, by a set operation. The result is exact, and identical, bit for bit, for
/// any number of threads. It has no channels: leafless_octree_carry_channels adds the channels of the
/// operands.
///
/// Octrees without surfaces are combined in pairs: the limits of `options` apply to each of these steps, and
/// the result is never larger than all operands together. If an octree keeps surfaces
/// (leafless_octree_build_extended), the result keeps surfaces. Then all operands are walked at once, and no
/// intermediate result is copied: pass the stock and all tools in one call, not one call a tool. A cell ends
/// as soon as three surfaces are left in it. A cell that more surfaces cross at the frame's depth is given
/// up: no function of surfaces is stored for it. An octree without surfaces takes part as a certified octree.
/// Equal surfaces of two octrees are recognised: A minus A is LEAFLESS_TAG_EMPTY except in cells that were
/// given up. The result may be larger than the operands. Curved surfaces that nearly coincide may need very
/// many cells: set `max_bytes` of `options`.
///
/// - Buffers: `octrees`, `count` handles; `options`, one struct or NULL; `result`, one pointer. `operation`
///   is a leafless_operation.
/// - Result: `*result`, with the facts "name" and "units" if all operands have the same value of them, and no
///   other metadata.
/// - Errors: LEAFLESS_E_FRAME if the frames differ; LEAFLESS_E_NULL, also of an element; LEAFLESS_E_ARGUMENT,
///   also if `count` is 0; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT, also if the exact map of a surface's
///   placements is too long; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the operands are unchanged; release `*result` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octrees; damage in octrees that were mapped unverified is an error or reads as
///   PARTIAL. Set `max_bytes` if an octree keeps surfaces and is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_combine(
    operation: Number<leafless_operation>,
    octrees: *const *const leafless_octree,
    count: u64,
    options: *const leafless_options,
    result: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let operation = operation.known("operation")?;
        let octrees = operands(octrees, count, false, "octrees", |handle| &handle.octree)?;
        let result = out(result, "result")?;
        let views = memory::collected(octrees.iter().map(|octree| *octree.view()))?;
        let made = controlled(options, |control| match operation {
            LEAFLESS_OPERATION_UNION => union_of(&views, control),
            LEAFLESS_OPERATION_INTERSECTION => intersection_of(&views, control),
            LEAFLESS_OPERATION_DIFFERENCE => difference_of(&views, control),
            LEAFLESS_OPERATION_XOR => xor_of(&views, control),
        })?;
        let common = Metadata::common(octrees.iter().map(|octree| octree.metadata()))?;
        result.write(give(made.with_metadata(common)))
    })
}

/// Returns the complement of an octree, inside its universe and outside. Surfaces are kept.
///
/// - Buffers: `options`, one struct or NULL; `result`, one pointer.
/// - Result: as leafless_octree_combine.
/// - Errors: LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_octree_combine.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: as leafless_octree_combine.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_complement(
    octree: *const leafless_octree,
    options: *const leafless_options,
    result: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let result = out(result, "result")?;
        let made = controlled(options, |control| leafless::complement(octree.view(), control))?;
        result.write(give(made.with_metadata(Metadata::common([octree.metadata()])?)))
    })
}
