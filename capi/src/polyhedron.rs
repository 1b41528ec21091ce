//! Triangle meshes from the faces of boundary representations.

use super::boundary::{Failure, Out, Sized32, guard, out, output, sized};
use super::mesh::{give, leafless_mesh};
use super::mesh_arrays::{GivenVertices, Indices, Vertices, leafless_index_type, leafless_vertex_type};
use super::number::Number;
use super::status::leafless_status;
use core::ffi::c_void;
use leafless::error::{MeshError, PolyhedronError};
use leafless::memory;
use leafless::mesh::{MeshAttribute, Polyhedron, PolyhedronArrays, PolyhedronPart};
use std::borrow::Cow;

/// Solids with plane faces, as in a boundary representation: solids consist of shells, shells of faces, faces
/// of loops, and loops of corners.
///
/// Each level is an array of offsets into the level below, with one more offset than there are parts: part k
/// goes from offset k up to, but not including, offset k + 1. So each array begins with 0, increases, and
/// ends with the number of parts below. Loops turn counter-clockwise as seen from outside the solid's
/// material, and holes of a face against its outer loop. Corners and offsets are of one type, without gaps,
/// and need not be aligned. Zero is the default of every field but the first.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_polyhedron_arrays {
    /// sizeof(leafless_polyhedron_arrays).
    pub struct_size: u32,
    /// A leafless_vertex_type.
    pub vertex_type: Number<leafless_vertex_type>,
    /// The first vertex: three coordinates. May be NULL if there is none.
    pub vertices: *const c_void,
    /// Number of vertices.
    pub vertex_count: u64,
    /// Bytes from one vertex to the next; 0 means that they follow each other without a gap.
    pub vertex_stride: u64,
    /// The corners of all loops, one loop after the other: indices of vertices, counted from 0.
    pub corners: *const c_void,
    /// Number of corners.
    pub corner_count: u64,
    /// Offsets of the loops in the corners. A loop has at least three; its last edge leads back to the first.
    pub loops: *const c_void,
    /// Number of loops.
    pub loop_count: u64,
    /// Offsets of the faces in the loops: the first loop of a face is its outer one, the others are holes.
    /// NULL, with a count of 0, means that each loop is a face.
    pub faces: *const c_void,
    /// Number of faces.
    pub face_count: u64,
    /// Offsets of the shells in the faces. NULL, with a count of 0, means that all faces are one shell.
    pub shells: *const c_void,
    /// Number of shells.
    pub shell_count: u64,
    /// Offsets of the solids in the shells: the first shell of a solid bounds it from outside, the others are
    /// voids. NULL, with a count of 0, means that all shells are one solid.
    pub solids: *const c_void,
    /// Number of solids.
    pub solid_count: u64,
    /// A leafless_index_type: the type of corners and offsets.
    pub index_type: Number<leafless_index_type>,
    /// Factor from coordinates to model units: 2^-256 to 2^256, or 0, which means 1.
    pub scale: f64,
    /// Largest distance of corners from the plane of their face, in model units: half the distance between
    /// two planes parallel to the face that have all its corners between them. 0 means 10^-9 of the longest
    /// extent.
    pub tolerance_model: f64,
}

// SAFETY: numbers and pointers.
unsafe impl Sized32 for leafless_polyhedron_arrays {}

output!(leafless_polyhedron_arrays);

/// Returns the indices in the library's layout: the host's array if it has this layout, else a copy.
/// `refused` makes the error for an index whose value does not fit in 32 bits, from its position and value.
fn narrow<'a>(
    indices: Indices<'a, 1>,
    refused: impl Fn(u64, u64) -> PolyhedronError,
) -> Result<Cow<'a, [u32]>, Failure> {
    if let Indices::U32(indices) = indices
        && let Some(indices) = indices.as_slice()
    {
        return Ok(Cow::Borrowed(indices.as_flattened()));
    }
    let mut narrowed = memory::with_capacity(indices.len())?;
    for index in 0..indices.len() {
        let [value] = indices.at(index);
        narrowed.push(u32::try_from(value).map_err(|_| refused(index as u64, value))?);
    }
    Ok(Cow::Owned(narrowed))
}

/// An array of offsets, which may be absent.
struct Level {
    start: *const c_void,
    count: u64,
    name: &'static str,
    /// Names of the parts and of the parts below.
    parts: [&'static str; 2],
}

impl Level {
    fn is_absent(&self) -> bool {
        self.start.is_null() && self.count == 0
    }

    /// # Safety
    /// The array is NULL, or has `count` + 1 offsets of this kind that do not change during the call.
    unsafe fn offsets<'a>(&self, kind: Number<leafless_index_type>) -> Result<Cow<'a, [u32]>, Failure> {
        if u32::try_from(self.count).is_err() {
            return Err(MeshError::TooMany.into());
        }
        // SAFETY: the caller's promise.
        let offsets = unsafe { Indices::new(self.start, self.count + 1, 0, kind, [self.name; 2])? };
        let [array, parts] = self.parts;
        narrow(offsets, |index, _| PolyhedronError::Offsets { array, parts, index })
    }
}

/// Returns the offsets of one part that consists of all `count` parts below, if there are any.
fn whole(count: usize) -> Cow<'static, [u32]> {
    const NONE: [u32; 1] = [0];
    match u32::try_from(count) {
        Ok(count) if count > 0 => Cow::Owned(std::vec![0, count]),
        _ => Cow::Borrowed(&NONE),
    }
}

impl leafless_polyhedron_arrays {
    /// Calls `take` with the arrays in the library's layout and returns its result.
    ///
    /// # Safety
    /// The arrays are as the fields describe them, and do not change during the call.
    pub(super) unsafe fn taken<R>(
        &self,
        take: impl FnOnce(&PolyhedronArrays<'_>) -> Result<R, Failure>,
    ) -> Result<R, Failure> {
        let given = GivenVertices {
            start: self.vertices,
            count: self.vertex_count,
            stride: self.vertex_stride,
            kind: self.vertex_type,
            scale: self.scale,
        };
        let kind = self.index_type;
        let level = |start, count, name, parts| Level { start, count, name, parts };
        let loops = level(self.loops, self.loop_count, "arrays.loops", ["loops", "corners"]);
        let faces = level(self.faces, self.face_count, "arrays.faces", ["faces", "loops"]);
        let shells = level(self.shells, self.shell_count, "arrays.shells", ["shells", "faces"]);
        let solids = level(self.solids, self.solid_count, "arrays.solids", ["solids", "shells"]);
        // SAFETY: the caller's promise.
        let (vertices, corners, loops) = unsafe {
            let vertices = Vertices::new(given)?;
            let corners = Indices::new(self.corners, self.corner_count, 0, kind, ["arrays.corners"; 2])?;
            let loops = if loops.is_absent() { whole(0) } else { loops.offsets(kind)? };
            (vertices, corners, loops)
        };
        let count = self.vertex_count;
        let corners =
            narrow(corners, |corner, vertex| PolyhedronError::Vertex { corner, vertex, vertices: count })?;
        let faces = if faces.is_absent() {
            let mut each = memory::with_capacity(loops.len())?;
            each.extend((0..).take(loops.len()));
            Cow::Owned(each)
        } else {
            // SAFETY: the caller's promise.
            unsafe { faces.offsets(kind)? }
        };
        let part = |level: Level, below: &[u32]| match level.is_absent() {
            true => Ok(whole(below.len() - 1)),
            // SAFETY: the caller's promise.
            false => unsafe { level.offsets(kind) },
        };
        let shells = part(shells, &faces)?;
        let solids = part(solids, &shells)?;
        let vertices = vertices.get()?;
        take(&PolyhedronArrays {
            vertices: &vertices,
            corners: &corners,
            loops: &loops,
            faces: &faces,
            shells: &shells,
            solids: &solids,
        })
    }

    /// Returns the polyhedron of the arrays.
    ///
    /// # Safety
    /// As `taken`.
    unsafe fn polyhedron(&self) -> Result<Polyhedron, Failure> {
        // SAFETY: the caller's promise.
        unsafe {
            self.taken(|arrays| match self.tolerance_model {
                0.0 => Ok(Polyhedron::new(arrays)?),
                tolerance if tolerance > 0.0 => Ok(Polyhedron::with_tolerance(arrays, tolerance)?),
                _ => {
                    let problem = "must be a number, and not negative";
                    Err(Failure::Argument { name: "arrays.tolerance_model", problem })
                }
            })
        }
    }
}

/// Checks solids with plane faces and makes a closed, consistently oriented mesh from them. If a face is not
/// exactly plane, its triangles define the surface.
///
/// Requirements: each edge of a loop occurs exactly once more in its shell, in the opposite direction. The
/// first shell of a solid encloses a positive volume; its voids enclose negative volumes inside it. Vertices
/// at equal positions stay distinct, so shells may touch. Faces that intersect and solids that overlap are
/// accepted, because a mesh is well-defined for them.
///
/// - Buffers: `arrays`, one struct; its arrays must not change during the call. `deviation_model`, one
///   number, or NULL if it is not wanted; `mesh`, one pointer.
/// - Result: `*mesh`, with the attributes `face`, `shell` and `solid` (leafless_mesh_peek_attribute_at): the
///   numbers of the parts that each triangle belongs to; `*deviation_model`, the largest distance of a corner
///   from the plane of its face.
/// - Errors: LEAFLESS_E_MESH, with the numbers of loop, face, shell or vertices in the message, if the arrays
///   are not such solids, if a coordinate is infinite, not a number, or beyond ±2^256, if there is no solid,
///   or if there are more than 2^32 - 1 of anything; LEAFLESS_E_ARGUMENT if a type, a stride, the scale or
///   the tolerance is invalid; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the arrays are only read during the call, and may be freed after it; release `*mesh` with
///   leafless_mesh_free.
/// - Untrusted input: any values in the arrays.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_from_polyhedron(
    arrays: *const leafless_polyhedron_arrays,
    deviation_model: *mut f64,
    mesh: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe {
        if arrays.is_null() {
            return Err(Failure::Null { name: "arrays" });
        }
        let arrays = sized(arrays, "arrays")?;
        let deviation: Option<Out<f64>> =
            if deviation_model.is_null() { None } else { Some(out(deviation_model, "deviation_model")?) };
        let mesh = out(mesh, "mesh")?;
        let mut polyhedron = arrays.polyhedron()?;
        for (name, part) in [
            ("face", PolyhedronPart::Face),
            ("shell", PolyhedronPart::Shell),
            ("solid", PolyhedronPart::Solid),
        ] {
            let parts = polyhedron.parts(part)?;
            polyhedron.add_attribute(MeshAttribute::labels(name, parts)?)?;
        }
        if let Some(deviation) = deviation {
            deviation.write(polyhedron.deviation())?;
        }
        mesh.write(give(polyhedron.into_mesh()))
    })
}
