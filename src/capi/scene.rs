//! Scenes in the language of OpenSCAD's CSG dumps.

use super::boundary::{Failure, guard, handle, out, path, refer, release, shared, slice, text};
use super::frame::{frame, leafless_frame};
use super::solid::{give, leafless_solid};
use super::status::leafless_status;
use crate::scene::{Scene, open_scene, read_scene};
use core::ffi::c_char;
use std::path::Path;

/// What a text describes: set operations on primitives, swept figures, meshes and octrees.
///
/// The language is that of the CSG dumps which OpenSCAD exports (group union difference intersection
/// multmatrix color render cube sphere cylinder polyhedron linear_extrude rotate_extrude square circle
/// polygon, and import of meshes), with these calls besides: halfspace([a, b, c, d]), which is a x + b y + c
/// z + d ≥ 0, quadric([10 numbers]), power([A, a, n1], [B, b, n2], [C, c, n3], R), torus(major, minor),
/// mesh("file.stl") and octree("file.lfl"). Curved shapes are exact, without facets. What is not supported
/// (hull, minkowski, text, projection and others) is refused by name.
///
/// Immutable: all its functions may be called at once from any number of threads, but leafless_scene_free
/// needs the reference that it gives back for itself.
pub struct leafless_scene {
    scene: Scene,
}

/// Reads a scene from a file. Files that it names are looked for beside it.
///
/// - Buffers: `path`, `path_length` bytes of UTF-8; `scene`, one pointer.
/// - Result: `*scene`.
/// - Errors: LEAFLESS_E_SCENE, with line and column in the message, for whatever is wrong with the text or a
///   file that it names; LEAFLESS_E_IO if the file itself cannot be read; LEAFLESS_E_UTF8;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*scene` back with leafless_scene_free.
/// - Threads: any.
/// - Untrusted input: any text; nesting costs memory, not stack, and memory is linear in the text and in the
///   files that it names. It may name any file, by absolute paths too, which is then read as a mesh or an
///   octree.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_scene_open(
    path: *const c_char,
    path_length: usize,
    scene: *mut *mut leafless_scene,
) -> leafless_status {
    guard(|| unsafe {
        let path = self::path(path, path_length)?;
        let result = out(scene, "scene")?;
        result.write(handle(leafless_scene { scene: open_scene(path)? }))
    })
}

/// As leafless_scene_open for a text in memory, in UTF-8. Files that it names are looked for in `folder`.
///
/// - Buffers: `bytes`, `length` bytes; may be NULL if there are none. `folder`, `folder_length` bytes of
///   UTF-8; NULL if the scene may name no files. `scene`, one pointer.
/// - Result: `*scene`.
/// - Errors: as leafless_scene_open, but LEAFLESS_E_IO; of names of files, if there is no folder,
///   LEAFLESS_E_SCENE.
/// - Ownership: the bytes are not kept; give `*scene` back with leafless_scene_free.
/// - Threads: any.
/// - Untrusted input: any bytes, as for leafless_scene_open.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_scene_from_bytes(
    bytes: *const u8,
    length: u64,
    folder: *const c_char,
    folder_length: usize,
    scene: *mut *mut leafless_scene,
) -> leafless_status {
    guard(|| unsafe {
        let bytes = slice(bytes, length, "bytes")?;
        let folder = if folder.is_null() { None } else { Some(text(folder, folder_length, "folder")?) };
        let result = out(scene, "scene")?;
        let scene = read_scene(bytes, folder.map(Path::new))?;
        result.write(handle(leafless_scene { scene }))
    })
}

/// One more reference to a scene.
///
/// - Buffers: `scene`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `scene`.
/// - Errors: only the general ones.
/// - Ownership: give each reference back with leafless_scene_free.
/// - Threads: any.
/// - Untrusted input: none.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_scene_ref(
    scene: *const leafless_scene,
    reference: *mut *mut leafless_scene,
) -> leafless_status {
    guard(|| unsafe { refer(scene, "scene", reference) })
}

/// Gives back a reference to a scene; with the last one the scene is gone. Solids made of it stay.
///
/// - Buffers: `scene`, a handle or NULL, which does nothing.
/// - Result: none.
/// - Errors: none.
/// - Ownership: the reference is gone.
/// - Threads: any; no other call may use this reference.
/// - Untrusted input: none.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_scene_free(scene: *mut leafless_scene) {
    // SAFETY: the caller's promise.
    unsafe { release(scene) }
}

/// A box that holds the solid of a scene. It may be larger than the solid.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each.
/// - Result: both.
/// - Errors: LEAFLESS_E_ARGUMENT if none is known: the scene is empty, or may be unbounded;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: nothing changes hands.
/// - Threads: any.
/// - Untrusted input: none.
/// - Since: 0.1
///
/// cbindgen:ptrs-as-arrays=[[min_model; 3], [max_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_scene_bounds(
    scene: *const leafless_scene,
    min_model: *mut f64,
    max_model: *mut f64,
) -> leafless_status {
    guard(|| unsafe {
        let scene = &shared(scene, "scene")?.scene;
        let min = out(min_model.cast(), "min_model")?;
        let max = out(max_model.cast(), "max_model")?;
        let Some((low, high)) = scene.bounds()? else {
            return Err(Failure::Argument { name: "scene", problem: "has no bounds that are known" });
        };
        let (low, high): ([f64; 3], [f64; 3]) = (low, high);
        min.write(low)?;
        max.write(high)
    })
}

/// The solid of a scene, to be built on this frame. If there are neither meshes nor octrees in it, it can be
/// built on any.
///
/// - Buffers: `frame`, one struct; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check; LEAFLESS_E_LIMIT if a mesh or octree is within more
///   than 256 matrices; LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*solid` back with leafless_solid_free.
/// - Threads: any.
/// - Untrusted input: any scene.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_new_scene(
    scene: *const leafless_scene,
    frame: *const leafless_frame,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let scene = &shared(scene, "scene")?.scene;
        let frame = self::frame(frame)?;
        let solid = out(solid, "solid")?;
        solid.write(give(scene.solid(&frame)?))
    })
}
