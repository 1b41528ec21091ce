//! Solids: shapes that can split a cell.

use super::boundary::{filled, guard, handle, out, output, refer, release, shared};
use super::mesh::{leafless_fill, leafless_mesh};
use super::number::Number;
use super::octree::leafless_octree;
use super::status::leafless_status;
use leafless::solid::Prepared;
use leafless::{AnySolid, Csg, MeshSolid, Solid};

/// A shape that can split a cell of space into eight classified cells.
///
/// Before a solid can classify cells of a frame, the library prepares it for the frame. This takes time in
/// proportion to the model: a mesh is brought onto the lattice, an expression is expanded, all links of an
/// octree are checked. The solid keeps the last preparation, so that a second query on the same frame costs
/// none of that time; another frame replaces it. (Solids made from this solid do not share its preparation.)
///
/// Otherwise a solid is immutable: all its functions may be called at once from any number of threads, but no
/// other call may use the reference that leafless_solid_free releases. Threads that query different frames at
/// the same time prepare the solid again and again: give each thread a solid of its own.
pub struct leafless_solid {
    pub(super) solid: Prepared,
}

/// Returns a handle of a solid.
pub(super) fn give<S: Solid + 'static>(solid: S) -> *mut leafless_solid {
    give_any(AnySolid::new(solid))
}

/// Returns a handle of a solid of any kind.
pub(super) fn give_any(solid: AnySolid) -> *mut leafless_solid {
    handle(leafless_solid { solid: Prepared::new(solid) })
}

/// Makes a solid from the region that a mesh encloses. On a frame whose universe does not hold the mesh, the
/// solid is clipped by the universe.
///
/// For a closed mesh, the inside is exact. Around holes, the convention of leafless_fill decides whether a
/// point is inside: a cell is FULL or EMPTY if that is proven for all of its points; other cells are PARTIAL
/// though no triangle cuts them. leafless_mesh_inspect reports whether to expect such cells.
///
/// Queries of rays, points, boxes and distances need no cells and take some microseconds each. For a mesh
/// with holes a query visits all edges of the holes, at some nanoseconds an edge. It uses cells for rays that
/// come very near to such an edge, for distances and boxes next to a hole, and, if there are more than 16384
/// such edges, for all queries except points. The first query builds data that the solid keeps: a tree over
/// the triangles (O(t log t): 0.1 to 0.3 microseconds a triangle; 36 bytes a triangle, which
/// leafless_solid_info includes); for distances of a closed mesh also the sides of its triangles on which the
/// solid lies (about twice that time, and 1 byte a triangle); or the edges of holes (48 bytes an edge). If
/// the first query must not take longer than others, make one query beforehand. Placed solids take over the
/// order of the tree and compute its boxes anew. Threads that make the first query at the same time may each
/// build the data once.
///
/// - Buffers: `solid`, one pointer. `fill` is a leafless_fill.
/// - Result: `*solid`. Time is linear in the mesh (n log n in the edges of its boundary).
/// - Errors: LEAFLESS_E_MESH if the mesh is empty, or (LEAFLESS_FILL_EVEN_ODD) an odd number of triangles
///   meet on an edge; LEAFLESS_E_ARGUMENT if `fill` is not a leafless_fill; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the solid shares the mesh, which may be freed; release `*solid` with leafless_solid_free.
/// - Untrusted input: any mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_from_mesh(
    mesh: *const leafless_mesh,
    fill: Number<leafless_fill>,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = shared(mesh, "mesh")?.mesh.clone();
        let fill = fill.known("fill")?;
        let solid = out(solid, "solid")?;
        solid.write(give(MeshSolid::new(mesh, fill)?))
    })
}

/// Makes a solid from a stored octree, on the octree's universe. An octree built from it to fewer levels is
/// cut off there; in one built to more levels its PARTIAL cells stay undecided.
///
/// - Buffers: `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: only the general ones; building from it returns LEAFLESS_E_DAMAGED if the octree was mapped
///   unverified and its links are damaged.
/// - Ownership: the solid shares the octree, which may be freed; release `*solid` with leafless_solid_free.
/// - Untrusted input: any octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_from_octree(
    octree: *const leafless_octree,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let solid = out(solid, "solid")?;
        solid.write(give(octree.clone()))
    })
}

/// Basic facts about a solid.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_solid_info {
    /// sizeof(leafless_solid_info).
    pub struct_size: u32,
    /// Number of evaluations of half-spaces so far, each at a point or over a box, for a solid that contains
    /// half-spaces (see leafless_solid_new_halfspace and the functions after it). It counts calls that have
    /// returned, and lazy octrees and similar objects that were freed. Solids made from this solid count
    /// separately. 0 for solids of other kinds.
    pub evaluations: u64,
    /// Approximate number of bytes of memory (or of mapped files) that the solid keeps alive: its own, those
    /// of the meshes, octrees and samples that it shares, and those of the last frame that it was prepared
    /// for. An expression counts each of its parts once, but two parts that share a mesh count the mesh
    /// twice. Objects of the host are not counted.
    pub bytes: u64,
}

output!(leafless_solid_info);

/// Returns basic facts about a solid. O(1), but O(n) in the parts of an expression.
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
/// - Untrusted input: any solid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_describe(
    solid: *const leafless_solid,
    info: *mut leafless_solid_info,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        filled(info, "info")?.write(leafless_solid_info {
            struct_size: size_of::<leafless_solid_info>() as u32,
            evaluations: solid.solid().get::<Csg>().map_or(0, Csg::evaluations),
            bytes: solid.kept_bytes(),
        })
    })
}

/// Returns one more reference to a solid.
///
/// - Buffers: `solid`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `solid`.
/// - Ownership: release each reference with leafless_solid_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_ref(
    solid: *const leafless_solid,
    reference: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe { refer(solid, "solid", reference) })
}

/// Releases a reference to a solid; the last release frees the solid. Octrees built from it stay.
///
/// - Buffers: `solid`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_free(solid: *mut leafless_solid) {
    // SAFETY: the caller's promise.
    unsafe { release(solid) }
}
