//! Solids: everything that can split a cell.

use super::boundary::{Failure, Sized32, guard, handle, initialise, out, refer, release, shared, sized};
use super::frame::{frame, leafless_frame};
use super::mesh::{fill_rule, leafless_mesh};
use super::octree::{leafless_octree, settled_tag};
use super::status::leafless_status;
use crate::error::Error;
use crate::octree::Tag;
use crate::solid::{AnySolid, Callback, Fingerprint, MeshSolid, Solid, Verdict};
use alloc::sync::Arc;
use core::ffi::c_void;

/// Anything that has a shape: it can split a cell of space into eight classified ones.
///
/// Immutable: all its functions may be called at once from any number of threads, but leafless_solid_free needs
/// the reference that it gives back for itself.
pub struct leafless_solid {
    pub(super) solid: AnySolid,
}

/// What a host promises of its shape outside of the universe that it is asked about.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_exterior {
    /// Nothing: the shape counts as clipped by the universe.
    LEAFLESS_EXTERIOR_UNKNOWN = 0,
    /// The shape ends inside of the universe.
    LEAFLESS_EXTERIOR_EMPTY = 1,
    /// Everything outside of the universe belongs to the shape.
    LEAFLESS_EXTERIOR_FULL = 2,
}
use leafless_exterior::*;

/// Classifies the box [min, max] (3 numbers each, model units) for the host's own shape: LEAFLESS_TAG_EMPTY or
/// LEAFLESS_TAG_FULL if that is proven for all of the box, LEAFLESS_TAG_PARTIAL to be asked about its eight parts.
/// Anything else ends the operation with LEAFLESS_E_CALLBACK and the number in the message; so use a negative
/// number for the host's own errors.
///
/// It is called from several threads at once, which may all be the library's own, unless the operation's options say
/// `threads` = 1; and it must give the same answer to the same box. It must return: no exception, no longjmp. It may
/// call this library.
pub type leafless_classify_fn =
    Option<unsafe extern "C" fn(ctx: *mut c_void, min: *const f64, max: *const f64) -> i32>;

/// Decides a point (3 numbers, model units) for the host's own shape: 1 inside, 0 outside; anything else ends the
/// operation with LEAFLESS_E_CALLBACK. Else as leafless_classify_fn.
pub type leafless_contains_fn = Option<unsafe extern "C" fn(ctx: *mut c_void, point: *const f64) -> i32>;

/// Called once, when nothing uses `ctx` any more, in the thread that gave back the last reference. It must return: no
/// exception, no longjmp. It may call this library.
pub type leafless_destroy_fn = Option<unsafe extern "C" fn(ctx: *mut c_void)>;

/// The host's own shape. All fields but the first may be zero; `classify` must be set.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_callbacks {
    /// sizeof(leafless_callbacks).
    pub struct_size: u32,
    /// A leafless_exterior.
    pub exterior: u32,
    /// Classifies boxes.
    pub classify: leafless_classify_fn,
    /// Decides points: LEAFLESS_RULE_SAMPLED needs it; optional.
    pub contains: leafless_contains_fn,
    /// Called when `ctx` is not needed any more; optional.
    pub destroy: leafless_destroy_fn,
    /// What the functions are called with.
    pub ctx: *mut c_void,
    /// Any number but 0, of 128 bits, that tells the shape from others, such as a hash of what it is made of: octrees
    /// that leafless_lazy_freeze makes remember it, and are taken up again by no other shape. Optional.
    pub fingerprint: [u64; 2],
}

// SAFETY: numbers, a pointer, and optional functions.
unsafe impl Sized32 for leafless_callbacks {}

/// The host's functions with their context.
struct Host(leafless_callbacks);

// SAFETY: the library does nothing with `ctx` but hand it back; that the functions may be called from any thread
// is their documented contract.
unsafe impl Send for Host {}
// SAFETY: as above.
unsafe impl Sync for Host {}

impl Drop for Host {
    fn drop(&mut self) {
        if let Some(destroy) = self.0.destroy {
            // SAFETY: as the host gave it, with its own context; this is the only place that calls it.
            unsafe { destroy(self.0.ctx) }
        }
    }
}

impl Host {
    fn classify(&self, min: [f64; 3], max: [f64; 3]) -> Result<Verdict<()>, Error> {
        let Some(classify) = self.0.classify else { return Ok(Verdict::Undecided) };
        // SAFETY: as the host gave it, with its own context.
        let code = unsafe { classify(self.0.ctx, min.as_ptr(), max.as_ptr()) };
        match settled_tag(code.into(), "verdict") {
            Ok(Tag::Empty) => Ok(Verdict::Empty),
            Ok(Tag::Full) => Ok(Verdict::Full),
            Ok(_) => Ok(Verdict::Partial(())),
            Err(_) => Err(Error::Callback { code }),
        }
    }

    fn contains(&self, point: [f64; 3]) -> Result<bool, Error> {
        // SAFETY: as the host gave it, with its own context.
        match self.0.contains.map_or(-1, |contains| unsafe { contains(self.0.ctx, point.as_ptr()) }) {
            0 => Ok(false),
            1 => Ok(true),
            code => Err(Error::Callback { code }),
        }
    }
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

/// Sets callbacks to their defaults; `classify` must then be set.
///
/// - Buffers: `callbacks`, one struct of `struct_size` bytes, which is sizeof(leafless_callbacks); need not be
///   initialised.
/// - Result: `*callbacks`.
/// - Errors: LEAFLESS_E_ARGUMENT if `struct_size` cannot be right.
/// - Ownership: nothing changes hands.
/// - Threads: any.
/// - Untrusted input: none.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_callbacks_init(
    callbacks: *mut leafless_callbacks,
    struct_size: usize,
) -> leafless_status {
    guard(|| unsafe { initialise(callbacks, struct_size, "callbacks") })
}

/// The host's own shape.
///
/// - Buffers: `callbacks`, one struct, which is copied; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_NULL if `classify` is NULL; LEAFLESS_E_ARGUMENT if `exterior` is no leafless_exterior.
///   After an error `destroy` is not called.
/// - Ownership: `ctx` must live until `destroy` is called with it; give `*solid` back with leafless_solid_free.
/// - Threads: any; in which the functions are called, leafless_classify_fn says.
/// - Untrusted input: any answers.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_new_callbacks(
    callbacks: *const leafless_callbacks,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        if callbacks.is_null() {
            return Err(Failure::Null { name: "callbacks" });
        }
        let callbacks = sized(callbacks, "callbacks")?;
        if callbacks.classify.is_none() {
            return Err(Failure::Null { name: "callbacks.classify" });
        }
        let exterior = match callbacks.exterior {
            known if known == LEAFLESS_EXTERIOR_UNKNOWN as u32 => Tag::Partial,
            known if known == LEAFLESS_EXTERIOR_EMPTY as u32 => Tag::Empty,
            known if known == LEAFLESS_EXTERIOR_FULL as u32 => Tag::Full,
            _ => {
                let problem = "is no leafless_exterior";
                return Err(Failure::Argument { name: "callbacks.exterior", problem });
            }
        };
        let solid = out(solid, "solid")?;
        let decides_points = callbacks.contains.is_some();
        let fingerprint = (callbacks.fingerprint != [0; 2])
            .then(|| Fingerprint::of_bytes(bytemuck::bytes_of(&callbacks.fingerprint.map(u64::to_le))));
        // From here on the host's context is ours.
        let host = Arc::new(Host(callbacks));
        let classify = {
            let host = host.clone();
            move |min, max| host.classify(min, max)
        };
        let mut callback = Callback::new(classify).with_exterior(exterior);
        if let Some(fingerprint) = fingerprint {
            callback = callback.with_fingerprint(fingerprint);
        }
        if decides_points {
            callback = callback.with_contains(move |point| host.contains(point));
        }
        solid.write(give(callback))
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
