//! Tri-dexel models that are changed in place.

use super::boundary::{Failure, discard, guard, out, shared};
use super::control::{controlled, leafless_options};
use super::frame::leafless_frame;
use super::solid::leafless_solid;
use super::status::leafless_status;
use super::tridexel::{give, leafless_tridexel};
use leafless::Control;
use leafless::Error;
use leafless::dexel::{DexelEditor, TriDexelRef};
use leafless::solid::Prepared;
use std::sync::{RwLock, RwLockReadGuard, RwLockWriteGuard, TryLockError, TryLockResult};

/// A copy of a tri-dexel model that is changed in place, in time proportional to what the second operand's rays touch: for
/// machining. It takes 12 bytes for each ray of the lattice beside the intervals.
///
/// While one call changes it, every other call returns LEAFLESS_E_BUSY, from another thread as from the host's functions
/// that are asked about a cell. While another call reads it, changing it returns LEAFLESS_E_BUSY. Calls that read it may
/// be made at once from any number of threads.
pub struct leafless_tridexel_editor(RwLock<DexelEditor>);

/// To read the model, unless another call changes it.
///
/// # Safety
/// As [`shared`].
unsafe fn read<'a>(
    editor: *const leafless_tridexel_editor,
) -> Result<RwLockReadGuard<'a, DexelEditor>, Failure> {
    // SAFETY: the caller's promise.
    unlocked(unsafe { shared(editor, "editor")? }.0.try_read())
}

/// To change the model, unless another call uses it.
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
        // A change that was cut off may have left intervals half-written.
        Err(TryLockError::Poisoned(_)) => panic!("an earlier call left this editor by a panic"),
        Err(TryLockError::WouldBlock) => Err(Failure::Busy { name: "editor" }),
    }
}

type Change = fn(&mut DexelEditor, &TriDexelRef<'_>, &Control<'_>) -> Result<(), Error>;
type ChangeBySolid = fn(&mut DexelEditor, &Prepared, &Control<'_>) -> Result<(), Error>;

/// # Safety
/// As the functions below.
unsafe fn change_by(
    operation: Change,
    editor: *mut leafless_tridexel_editor,
    tridexel: *const leafless_tridexel,
    options: *const leafless_options,
) -> leafless_status {
    guard(|| unsafe {
        let mut editor = change(editor)?;
        let other = shared(tridexel, "tridexel")?.model.view();
        controlled(options, |control| operation(&mut editor, other, control))
    })
}

/// # Safety
/// As the functions below.
unsafe fn change_by_solid(
    operation: ChangeBySolid,
    editor: *mut leafless_tridexel_editor,
    solid: *const leafless_solid,
    options: *const leafless_options,
) -> leafless_status {
    guard(|| unsafe {
        let mut editor = change(editor)?;
        let solid = &shared(solid, "solid")?.solid;
        controlled(options, |control| operation(&mut editor, solid, control))
    })
}

/// A copy of a tri-dexel model that can be changed. O(rays of the universe + intervals).
///
/// - Buffers: `editor`, one pointer.
/// - Result: `*editor`, which stores what `tridexel` does.
/// - Errors: LEAFLESS_E_DAMAGED if the model was mapped unverified and is damaged; LEAFLESS_E_LIMIT for 2^32 rays along
///   one axis, which is a depth of 16; LEAFLESS_E_NO_MEMORY.
/// - Ownership: nothing is kept of `tridexel`; give `*editor` back with leafless_tridexel_editor_free.
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

/// Gives back an editor. Tri-dexel models that it froze stay.
///
/// - Buffers: `editor`, a handle or NULL, which does nothing.
/// - Ownership: the handle is gone.
/// - Threads: no other call may use the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_editor_free(editor: *mut leafless_tridexel_editor) {
    // SAFETY: the caller's promise.
    unsafe { discard(editor) }
}

/// The lattice of an editor.
///
/// - Buffers: `frame`, one struct.
/// - Result: `*frame`, that of the model which was copied.
/// - Errors: LEAFLESS_E_BUSY.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the editor.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_editor_frame(
    editor: *const leafless_tridexel_editor,
    frame: *mut leafless_frame,
) -> leafless_status {
    guard(|| unsafe {
        let editor = read(editor)?;
        out(frame, "frame")?.write(editor.frame().into())
    })
}

/// Bytes that an editor takes.
///
/// - Buffers: `bytes`, one number.
/// - Result: `*bytes`.
/// - Errors: LEAFLESS_E_BUSY.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the editor.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_editor_bytes(
    editor: *const leafless_tridexel_editor,
    bytes: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let editor = read(editor)?;
        out(bytes, "bytes")?.write(editor.bytes())
    })
}

/// Adds the points of a tri-dexel model. O(rays of its window + intervals there). What the model stores beyond what the
/// editor does is left out.
///
/// - Buffers: `options`, one struct or NULL.
/// - Result: the editor is changed.
/// - Errors: LEAFLESS_E_FRAME if the frames differ; LEAFLESS_E_ARGUMENT if the model has rays along other axes;
///   LEAFLESS_E_DAMAGED if the model was mapped unverified and is damaged; LEAFLESS_E_LIMIT for 2^32 intervals along one
///   axis; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_BUSY.
///   After LEAFLESS_E_LIMIT, LEAFLESS_E_CANCELLED and LEAFLESS_E_NO_MEMORY some rays may be changed and others not; the
///   same call can be made again.
/// - Ownership: nothing is kept of `tridexel`.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the editor; uses the calling thread alone.
/// - Untrusted input: any model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_editor_unite(
    editor: *mut leafless_tridexel_editor,
    tridexel: *const leafless_tridexel,
    options: *const leafless_options,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { change_by(DexelEditor::unite, editor, tridexel, options) }
}

/// Takes away the points of a tri-dexel model. O(rays of its window + intervals there).
///
/// - Buffers: `options`, one struct or NULL.
/// - Result: the editor is changed.
/// - Errors: as leafless_tridexel_editor_unite.
/// - Ownership: nothing is kept of `tridexel`.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the editor; uses the calling thread alone.
/// - Untrusted input: any model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_editor_subtract(
    editor: *mut leafless_tridexel_editor,
    tridexel: *const leafless_tridexel,
    options: *const leafless_options,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { change_by(DexelEditor::subtract, editor, tridexel, options) }
}

/// Keeps only the points that lie in a tri-dexel model, too. O(rays of the universe).
///
/// - Buffers: `options`, one struct or NULL.
/// - Result: the editor is changed.
/// - Errors: as leafless_tridexel_editor_unite.
/// - Ownership: nothing is kept of `tridexel`.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the editor; uses the calling thread alone.
/// - Untrusted input: any model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_editor_intersect(
    editor: *mut leafless_tridexel_editor,
    tridexel: *const leafless_tridexel,
    options: *const leafless_options,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { change_by(DexelEditor::intersect, editor, tridexel, options) }
}

/// Adds a solid. Its intervals are those of leafless_tridexel_make under LEAFLESS_RULE_SAMPLED, in the directions and
/// with the contents of the editor. Only rays through the solid's bounding box are looked at.
///
/// - Buffers: `options`, one struct or NULL.
/// - Result: the editor is changed.
/// - Errors: as leafless_tridexel_make, and nothing is changed; as leafless_tridexel_editor_unite.
/// - Ownership: nothing is kept of the solid.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the editor; uses as many as `options` says.
/// - Untrusted input: any solid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_editor_unite_solid(
    editor: *mut leafless_tridexel_editor,
    solid: *const leafless_solid,
    options: *const leafless_options,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { change_by_solid(DexelEditor::unite_solid, editor, solid, options) }
}

/// Takes a solid away: one step of a tool. Its intervals are those of leafless_tridexel_make under LEAFLESS_RULE_SAMPLED,
/// in the directions and with the contents of the editor. Only rays through the solid's bounding box are looked at.
///
/// - Buffers: `options`, one struct or NULL.
/// - Result: the editor is changed.
/// - Errors: as leafless_tridexel_make, and nothing is changed; as leafless_tridexel_editor_unite.
/// - Ownership: nothing is kept of the solid.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the editor; uses as many as `options` says.
/// - Untrusted input: any solid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_editor_subtract_solid(
    editor: *mut leafless_tridexel_editor,
    solid: *const leafless_solid,
    options: *const leafless_options,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { change_by_solid(DexelEditor::subtract_solid, editor, solid, options) }
}

/// Keeps only the points that lie in a solid, too. Its intervals are those of leafless_tridexel_make under
/// LEAFLESS_RULE_SAMPLED, in the directions and with the contents of the editor. O(rays of the universe), and
/// the rays through the solid's bounding box.
///
/// - Buffers: `options`, one struct or NULL.
/// - Result: the editor is changed.
/// - Errors: as leafless_tridexel_make, and nothing is changed; as leafless_tridexel_editor_unite.
/// - Ownership: nothing is kept of the solid.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the editor; uses as many as `options` says.
/// - Untrusted input: any solid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_editor_intersect_solid(
    editor: *mut leafless_tridexel_editor,
    solid: *const leafless_solid,
    options: *const leafless_options,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { change_by_solid(DexelEditor::intersect_solid, editor, solid, options) }
}

/// The tri-dexel model as it is now. O(rays of the universe + intervals). The editor can be changed further.
///
/// - Buffers: `options`, one struct or NULL; `tridexel`, one pointer.
/// - Result: `*tridexel`, without metadata.
/// - Errors: LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_BUSY.
/// - Ownership: the editor stays as it is; give `*tridexel` back with leafless_tridexel_free.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the editor; uses the calling thread alone.
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
