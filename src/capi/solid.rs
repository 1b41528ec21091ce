//! Solids: everything that can split a cell.

use super::boundary::{guard, handle, out, refer, release, shared};
use super::frame::{frame, leafless_frame};
use super::mesh::{fill_rule, leafless_mesh};
use super::octree::leafless_octree;
use super::status::leafless_status;
use crate::solid::{AnySolid, MeshSolid, Solid};

/// Anything that has a shape: it can split a cell of space into eight classified ones.
///
/// Immutable: all its functions may be called at once from any number of threads, but leafless_solid_free needs
/// the reference that it gives back for itself.
pub struct leafless_solid {
    pub(super) solid: AnySolid,
}

/// A handle of a solid.
pub(super) fn give<S: Solid<Part: 'static, Scratch: 'static> + Send + 'static>(
    solid: S,
) -> *mut leafless_solid {
    handle(leafless_solid { solid: AnySolid::new(solid) })
}

/// What a mesh encloses, on the lattice of one frame: the solid can be built on that frame only. A mesh that reaches
/// beyond the universe is clipped by it.
///
/// Where the mesh is closed, what it encloses is exact. Around holes leafless_fill says by which convention a point is
/// inside: a cell is FULL or EMPTY if that is proven for all of its points, and others are PARTIAL though no triangle
/// cuts them. leafless_mesh_describe tells whether to expect them.
///
/// - Buffers: `frame`, one struct; `solid`, one pointer. `fill` is a leafless_fill.
/// - Result: `*solid`. Time and memory are linear in the mesh (n log n in the edges of its boundary).
/// - Errors: LEAFLESS_E_MESH if the mesh is empty, or (LEAFLESS_FILL_EVEN_ODD) an odd number of triangles meet on an
///   edge; LEAFLESS_E_ARGUMENT as leafless_frame_check, or if `fill` is no leafless_fill; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the solid shares the mesh, which may be freed; give `*solid` back with leafless_solid_free.
/// - Threads: any.
/// - Untrusted input: any mesh.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_new_mesh(
    mesh: *const leafless_mesh,
    frame: *const leafless_frame,
    fill: u32,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = shared(mesh, "mesh")?.mesh.clone();
        let frame = self::frame(frame)?;
        let fill = fill_rule(fill)?;
        let solid = out(solid, "solid")?;
        solid.write(give(MeshSolid::new(mesh, &frame, fill)?))
    })
}

/// A stored octree as a solid on its own universe. Built to fewer levels it is cut there, built to more its
/// PARTIAL cells stay undecided.
///
/// - Buffers: `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: only the general ones; building it returns LEAFLESS_E_DAMAGED if the octree was mapped unverified
///   and its links are damaged.
/// - Ownership: the solid shares the octree, which may be freed; give `*solid` back with leafless_solid_free.
/// - Threads: any.
/// - Untrusted input: any octree.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_as_solid(
    octree: *const leafless_octree,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let solid = out(solid, "solid")?;
        solid.write(give(octree.clone()))
    })
}

/// One more reference to a solid.
///
/// - Buffers: `solid`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `solid`.
/// - Errors: only the general ones.
/// - Ownership: give each reference back with leafless_solid_free.
/// - Threads: any.
/// - Untrusted input: none.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_ref(
    solid: *const leafless_solid,
    reference: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe { refer(solid, "solid", reference) })
}

/// Gives back a reference to a solid; with the last one the solid is gone. Octrees built from it stay.
///
/// - Buffers: `solid`, a handle or NULL, which does nothing.
/// - Result: none.
/// - Errors: none.
/// - Ownership: the reference is gone.
/// - Threads: any; no other call may use this reference.
/// - Untrusted input: none.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_free(solid: *mut leafless_solid) {
    // SAFETY: the caller's promise.
    unsafe { release(solid) }
}
