//! Editors: tri-dexel models that are changed in place.

use super::boundary::{Failure, discard, filled, guard, out, output, shared};
use super::control::{controlled, leafless_options};
use super::number::Number;
use super::operation::{leafless_operation, leafless_operation::*};
use super::solid::leafless_solid;
use super::status::leafless_status;
use super::tridexel::{described, give, leafless_tridexel, leafless_tridexel_info};
use leafless::Control;
use leafless::Error;
use leafless::dexel::{DexelChange, DexelEditor};
use std::sync::{RwLock, RwLockReadGuard, RwLockWriteGuard, TryLockError, TryLockResult};

/// A copy of a tri-dexel model that is changed in place, for machining. The time of a change is proportional
/// to the rays and intervals that the second operand touches. It takes 12 bytes for each ray of the lattice
/// in addition to the intervals.
///
/// While one call changes an editor, every other call returns LEAFLESS_E_BUSY, both from another thread and
/// from the host's functions inside the call. While a call reads it, calls that change it return
/// LEAFLESS_E_BUSY. Any number of threads may read it at once.
pub struct leafless_tridexel_editor(RwLock<DexelEditor>);

/// Returns the model for reading, unless another call changes it.
///
/// # Safety
/// As [`shared`].
unsafe fn read<'a>(
    editor: *const leafless_tridexel_editor,
) -> Result<RwLockReadGuard<'a, DexelEditor>, Failure> {
    // SAFETY: the caller's promise.
    unlocked(unsafe { shared(editor, "editor")? }.0.try_read())
}

/// Returns the model for changing, unless another call uses it.
///
/// # Safety
/// As [`shared`].
unsafe fn change<'a>(
    editor: *const leafless_tridexel_editor,
) -> Result<RwLockWriteGuard<'a, DexelEditor>, Failure> {
    // SAFETY: the caller's promise.
    unlocked(unsafe { shared(editor, "editor")? }.0.try_write())
}

fn unlocked<G>(held: TryLockResult<G>) -> Result<G, Failure> {
    match held {
        Ok(held) => Ok(held),
        // A change that panicked may have left intervals half-written.
        Err(TryLockError::Poisoned(_)) => panic!("an earlier call left this editor by a panic"),
        Err(TryLockError::WouldBlock) => Err(Failure::Busy { name: "editor" }),
    }
}

/// A report of a change of an editor.
///
/// Volumes are sums of lengths along the rays of one axis times the area of a cell's face. So they are
/// estimates, not bounds, and differ between axes by the parts between neighbouring rays.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_dexel_change {
    /// sizeof(leafless_dexel_change).
    pub struct_size: u32,
    /// Number of rays, in all directions, whose intervals changed their start or end.
    pub rays: u64,
    /// The volume that the rays along x, y and z lost, in cubic model units; 0 for an axis without rays.
    pub removed_model: [f64; 3],
    /// The volume that the rays along x, y and z gained, in cubic model units; 0 for an axis without rays.
    pub added_model: [f64; 3],
    /// First cell of the box of finest cells that the changed parts of rays pass through.
    pub min_cell: [u32; 3],
    /// The first cell beyond that box on each axis; both corners are zero if no ray changed.
    pub max_cell: [u32; 3],
}

output!(leafless_dexel_change);

impl From<DexelChange> for leafless_dexel_change {
    fn from(change: DexelChange) -> leafless_dexel_change {
        let [min_cell, max_cell] = change.cells.unwrap_or_default();
        leafless_dexel_change {
            struct_size: size_of::<leafless_dexel_change>() as u32,
            rays: change.rays,
            removed_model: change.removed,
            added_model: change.added,
            min_cell,
            max_cell,
        }
    }
}

/// # Safety
/// `options` and `change` are as for the functions below.
unsafe fn changed(
    options: *const leafless_options,
    change: *mut leafless_dexel_change,
    operation: impl FnOnce(&Control<'_>) -> Result<DexelChange, Error>,
) -> Result<(), Failure> {
    // SAFETY: the caller's promise.
    unsafe {
        let change = if change.is_null() { None } else { Some(filled(change, "change")?) };
        let done = controlled(options, operation)?;
        change.map_or(Ok(()), |change| change.write(done.into()))
    }
}

/// Makes an editor: a copy of a tri-dexel model that can be changed. O(rays of the universe + intervals).
///
/// - Buffers: `editor`, one pointer.
/// - Result: `*editor`, with the storage format of `tridexel`.
/// - Errors: LEAFLESS_E_DAMAGED if the model was mapped unverified and is damaged; LEAFLESS_E_LIMIT for 2^32
///   rays along one axis, which is a depth of 16; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the library keeps no reference to `tridexel`; release `*editor` with
///   leafless_tridexel_editor_free.
/// - Untrusted input: any model; memory is needed for each ray of its universe.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_editor_new(
    tridexel: *const leafless_tridexel,
    editor: *mut *mut leafless_tridexel_editor,
) -> leafless_status {
    guard(|| unsafe {
        let model = shared(tridexel, "tridexel")?.model.view();
        let editor = out(editor, "editor")?;
        let made = DexelEditor::new(model)?;
        editor.write(Box::into_raw(Box::new(leafless_tridexel_editor(RwLock::new(made)))))
    })
}

/// Releases an editor. Tri-dexel models that were frozen from it stay.
///
/// - Buffers: `editor`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_editor_free(editor: *mut leafless_tridexel_editor) {
    // SAFETY: the caller's promise.
    unsafe { discard(editor) }
}

/// Returns basic facts about an editor. O(rays of the universe).
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`; `bytes` is the memory of the editor.
/// - Errors: LEAFLESS_E_BUSY.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the editor.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_editor_describe(
    editor: *const leafless_tridexel_editor,
    info: *mut leafless_tridexel_info,
) -> leafless_status {
    guard(|| unsafe {
        let editor = read(editor)?;
        let info = filled(info, "info")?;
        let (format, count) = (editor.format(), editor.interval_count());
        info.write(described(editor.frame(), format, editor.directions(), count, editor.bytes()))
    })
}

/// Combines the editor with a tri-dexel model in place by a set operation: LEAFLESS_OPERATION_DIFFERENCE
/// subtracts the model. O(rays of the model's window + intervals there); for LEAFLESS_OPERATION_INTERSECTION
/// O(rays of the universe). Data of the model that the editor does not store are left out.
///
/// - Buffers: `options`, one struct or NULL; `change`, one struct or NULL. `operation` is a
///   leafless_operation.
/// - Result: the editor is changed; `*change`, what was removed and added.
/// - Errors: LEAFLESS_E_FRAME if the frames differ; LEAFLESS_E_ARGUMENT also if the model has rays along
///   other axes; LEAFLESS_E_DAMAGED if the model was mapped unverified and is damaged; LEAFLESS_E_LIMIT for
///   2^32 intervals along one axis; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_BUSY. After
///   LEAFLESS_E_LIMIT, LEAFLESS_E_CANCELLED and LEAFLESS_E_NO_MEMORY some rays may be changed and others not;
///   the same call can be made again, except for LEAFLESS_OPERATION_XOR.
/// - Ownership: the library keeps no reference to `tridexel`.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the editor; works in the calling thread.
/// - Untrusted input: any model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_editor_combine(
    editor: *mut leafless_tridexel_editor,
    operation: Number<leafless_operation>,
    tridexel: *const leafless_tridexel,
    options: *const leafless_options,
    change: *mut leafless_dexel_change,
) -> leafless_status {
    guard(|| unsafe {
        let mut editor = self::change(editor)?;
        let operation = operation.known("operation")?;
        let model = shared(tridexel, "tridexel")?.model.view();
        changed(options, change, |control| match operation {
            LEAFLESS_OPERATION_UNION => editor.unite(model, control),
            LEAFLESS_OPERATION_INTERSECTION => editor.intersect(model, control),
            LEAFLESS_OPERATION_DIFFERENCE => editor.subtract(model, control),
            LEAFLESS_OPERATION_XOR => editor.xor(model, control),
        })
    })
}

/// Like leafless_tridexel_editor_combine, with a solid: LEAFLESS_OPERATION_DIFFERENCE is one step of a tool.
/// The solid's intervals are those of leafless_tridexel_build under LEAFLESS_RULE_SAMPLED, in the directions
/// and the storage format of the editor. Only rays through the solid's bounding box are visited.
///
/// - Buffers: `options`, one struct or NULL; `change`, one struct or NULL. `operation` is a
///   leafless_operation.
/// - Result: the editor is changed; `*change`, what was removed and added.
/// - Errors: those of leafless_tridexel_build, after which nothing is changed; those of
///   leafless_tridexel_editor_combine.
/// - Ownership: the library keeps no reference to the solid.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the editor; runs on as many threads as `options`
///   says.
/// - Untrusted input: any solid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_editor_combine_solid(
    editor: *mut leafless_tridexel_editor,
    operation: Number<leafless_operation>,
    solid: *const leafless_solid,
    options: *const leafless_options,
    change: *mut leafless_dexel_change,
) -> leafless_status {
    guard(|| unsafe {
        let mut editor = self::change(editor)?;
        let operation = operation.known("operation")?;
        let solid = &shared(solid, "solid")?.solid;
        changed(options, change, |control| match operation {
            LEAFLESS_OPERATION_UNION => editor.unite_solid(solid, control),
            LEAFLESS_OPERATION_INTERSECTION => editor.intersect_solid(solid, control),
            LEAFLESS_OPERATION_DIFFERENCE => editor.subtract_solid(solid, control),
            LEAFLESS_OPERATION_XOR => editor.xor_solid(solid, control),
        })
    })
}

/// Returns the current tri-dexel model. O(rays of the universe + intervals). The editor can be changed
/// further.
///
/// - Buffers: `options`, one struct or NULL; `tridexel`, one pointer.
/// - Result: `*tridexel`, without metadata.
/// - Errors: LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_BUSY.
/// - Ownership: the editor is unchanged; release `*tridexel` with leafless_tridexel_free.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the editor; works in the calling thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_editor_freeze(
    editor: *const leafless_tridexel_editor,
    options: *const leafless_options,
    tridexel: *mut *mut leafless_tridexel,
) -> leafless_status {
    guard(|| unsafe {
        let editor = read(editor)?;
        let tridexel = out(tridexel, "tridexel")?;
        tridexel.write(give(controlled(options, |control| editor.freeze(control))?))
    })
}
