//! Triangle meshes from arrays as host programs have them.

use super::boundary::{Failure, Sized32, guard, initialise, out, sized, strided};
use super::mesh::{give, leafless_mesh};
use super::status::leafless_status;
use crate::error::{Error, MeshError};
use crate::lattice::{LARGEST, SMALLEST};
use crate::solid::TriangleMesh;
use alloc::vec::Vec;
use core::ffi::c_void;

/// What the coordinates of vertices are.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_vertex_type {
    /// double.
    LEAFLESS_VERTEX_F64 = 0,
    /// float.
    LEAFLESS_VERTEX_F32 = 1,
}

/// What the indices of vertices are.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_index_type {
    /// uint32_t.
    LEAFLESS_INDEX_U32 = 0,
    /// uint64_t.
    LEAFLESS_INDEX_U64 = 1,
    /// uint16_t.
    LEAFLESS_INDEX_U16 = 2,
}

/// The arrays that a mesh is made of: vertices of three coordinates, and triangles of three indices. They need not
/// be aligned, and may lie among other data, such as normals, which are not read. All fields but the first may be
/// zero, which is their default; leafless_mesh_arrays_init sets them so.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_mesh_arrays {
    /// sizeof(leafless_mesh_arrays).
    pub struct_size: u32,
    /// A leafless_vertex_type.
    pub vertex_type: u32,
    /// The first vertex. May be NULL if there is none.
    pub vertices: *const c_void,
    /// Number of vertices.
    pub vertex_count: u64,
    /// Bytes from one vertex to the next; 0 means that they follow each other without a gap.
    pub vertex_stride: u64,
    /// The first triangle: three indices, counted from 0. NULL if there is none, or if every three vertices are
    /// one.
    pub indices: *const c_void,
    /// Number of triangles. Where every three vertices are one, this must be a third of `vertex_count`.
    pub triangle_count: u64,
    /// Bytes from one triangle to the next; 0 means that they follow each other without a gap.
    pub triangle_stride: u64,
    /// A leafless_index_type.
    pub index_type: u32,
    /// What the coordinates are multiplied by to become model units: 2^-256 to 2^256, or 0, which means 1.
    pub scale: f64,
}

// SAFETY: numbers and pointers.
unsafe impl Sized32 for leafless_mesh_arrays {}

impl leafless_mesh_arrays {
    /// # Safety
    /// The arrays are what the fields say, and do not change during the call.
    unsafe fn mesh(&self) -> Result<TriangleMesh, Failure> {
        // SAFETY: the caller's promise.
        unsafe {
            match self.vertex_type {
                known if known == leafless_vertex_type::LEAFLESS_VERTEX_F64 as u32 => self.mesh_of::<f64>(),
                known if known == leafless_vertex_type::LEAFLESS_VERTEX_F32 as u32 => self.mesh_of::<f32>(),
                _ => {
                    let problem = "is no leafless_vertex_type";
                    Err(Failure::Argument { name: "arrays.vertex_type", problem })
                }
            }
        }
    }

    /// # Safety
    /// As [`mesh`](Self::mesh).
    unsafe fn mesh_of<T: Copy + Into<f64>>(&self) -> Result<TriangleMesh, Failure> {
        let scale = match self.scale {
            0.0 => 1.0,
            scale if (SMALLEST..=LARGEST).contains(&scale) => scale,
            _ => {
                let problem = "must be 0 or between 2^-256 and 2^256";
                return Err(Failure::Argument { name: "arrays.scale", problem });
            }
        };
        let names = ["arrays.vertices", "arrays.vertex_stride"];
        // SAFETY: the caller's promise; any bytes are numbers.
        let vertices =
            unsafe { strided::<[T; 3]>(self.vertices, self.vertex_count, self.vertex_stride, names)? };
        let position = |vertex: [T; 3]| vertex.map(|x| x.into() * scale);
        // SAFETY: the caller's promise.
        let triangles = unsafe {
            match self.index_type {
                known if known == leafless_index_type::LEAFLESS_INDEX_U16 as u32 => {
                    self.triangles::<u16>()?
                }
                known if known == leafless_index_type::LEAFLESS_INDEX_U32 as u32 => {
                    self.triangles::<u32>()?
                }
                known if known == leafless_index_type::LEAFLESS_INDEX_U64 as u32 => {
                    self.triangles::<u64>()?
                }
                _ => {
                    let problem = "is no leafless_index_type";
                    return Err(Failure::Argument { name: "arrays.index_type", problem });
                }
            }
        };
        let Some(triangles) = triangles else {
            let facet = |t| [3 * t, 3 * t + 1, 3 * t + 2].map(|corner| position(vertices.at(corner)));
            return Ok(TriangleMesh::from_facets((0..self.triangle_count as usize).map(facet))?);
        };
        let mut own = Vec::new();
        own.try_reserve_exact(vertices.len()).map_err(|_| Error::OutOfMemory)?;
        own.extend(vertices.iter().map(position));
        Ok(TriangleMesh::new(own, triangles)?)
    }

    /// The triangles as the library has them, or none if every three vertices are one.
    ///
    /// # Safety
    /// As [`mesh`](Self::mesh).
    unsafe fn triangles<T: Copy + Into<u64>>(&self) -> Result<Option<Vec<[u32; 3]>>, Failure> {
        if self.indices.is_null() && self.triangle_count > 0 {
            if self.triangle_count.checked_mul(3) != Some(self.vertex_count) {
                let problem = "may be NULL only if there are three vertices for each triangle";
                return Err(Failure::Argument { name: "arrays.indices", problem });
            }
            return Ok(None);
        }
        let names = ["arrays.indices", "arrays.triangle_stride"];
        // SAFETY: the caller's promise; any bytes are numbers.
        let given =
            unsafe { strided::<[T; 3]>(self.indices, self.triangle_count, self.triangle_stride, names)? };
        let vertices = self.vertex_count;
        if u32::try_from(vertices.max(self.triangle_count)).is_err() {
            return Err(MeshError::TooMany.into());
        }
        let mut triangles = Vec::new();
        triangles.try_reserve_exact(given.len()).map_err(|_| Error::OutOfMemory)?;
        for (corners, triangle) in given.iter().zip(0..) {
            let corners: [u64; 3] = corners.map(T::into);
            if let Some(&vertex) = corners.iter().find(|&&vertex| vertex >= vertices) {
                return Err(MeshError::Index { triangle, vertex, vertices }.into());
            }
            // Less than the number of vertices, which 32 bits can hold.
            triangles.push(corners.map(|vertex| vertex as u32));
        }
        Ok(Some(triangles))
    }
}

/// Sets arrays to their defaults: none.
///
/// - Buffers: `arrays`, one struct of `struct_size` bytes, which is sizeof(leafless_mesh_arrays); need not be
///   initialised.
/// - Result: `*arrays`.
/// - Errors: LEAFLESS_E_ARGUMENT if `struct_size` cannot be right.
/// - Ownership: nothing changes hands.
/// - Threads: any.
/// - Untrusted input: none.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_arrays_init(
    arrays: *mut leafless_mesh_arrays,
    struct_size: usize,
) -> leafless_status {
    guard(|| unsafe { initialise(arrays, struct_size, "arrays") })
}

/// Makes a mesh of arrays. Equal vertices are welded, triangles with two corners at one place dropped and counted;
/// coordinates below 2^-256 count as zero. Seen from outside of the solid the corners turn counter-clockwise.
///
/// - Buffers: `arrays`, one struct; what its pointers lead to must not change during the call. `mesh`, one pointer.
/// - Result: `*mesh`; not checked to be closed.
/// - Errors: LEAFLESS_E_MESH if a coordinate is infinite, not a number, or beyond ±2^256, or if an index is out of
///   range, with the index of the vertex or triangle in the message, or if there are more than 2^32 - 1 vertices or
///   triangles; LEAFLESS_E_ARGUMENT if a type, a stride or the scale is none, or `indices` NULL though there are
///   triangles and not three vertices for each; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the arrays are only read during the call, once and in their order, and may be freed after it: the
///   mesh has its own. Give `*mesh` back with leafless_mesh_free.
/// - Threads: any.
/// - Untrusted input: any values in the arrays.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_new(
    arrays: *const leafless_mesh_arrays,
    mesh: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe {
        if arrays.is_null() {
            return Err(Failure::Null { name: "arrays" });
        }
        let arrays = sized(arrays, "arrays")?;
        let mesh = out(mesh, "mesh")?;
        mesh.write(give(arrays.mesh()?))
    })
}
