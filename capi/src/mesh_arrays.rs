//! Triangle meshes from the host's arrays.

use super::boundary::{Failure, Sized32, Strided, guard, out, sized, strided};
use super::mesh::{give, leafless_mesh};
use super::number::{Number, enumeration};
use super::status::leafless_status;
use core::ffi::c_void;
use leafless::Error;
use leafless::TriangleMesh;
use leafless::error::MeshError;
use leafless::memory;
use leafless_index_type::*;
use leafless_vertex_type::*;
use std::borrow::Cow;

enumeration! {
    leafless_vertex_type => leafless_vertex_type {
        LEAFLESS_VERTEX_TYPE_F64 => LEAFLESS_VERTEX_TYPE_F64,
        LEAFLESS_VERTEX_TYPE_F32 => LEAFLESS_VERTEX_TYPE_F32,
    }
}

enumeration! {
    leafless_index_type => leafless_index_type {
        LEAFLESS_INDEX_TYPE_U32 => LEAFLESS_INDEX_TYPE_U32,
        LEAFLESS_INDEX_TYPE_U64 => LEAFLESS_INDEX_TYPE_U64,
        LEAFLESS_INDEX_TYPE_U16 => LEAFLESS_INDEX_TYPE_U16,
    }
}

/// The type of the coordinates of vertices.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_vertex_type {
    /// double.
    LEAFLESS_VERTEX_TYPE_F64 = 0,
    /// float.
    LEAFLESS_VERTEX_TYPE_F32 = 1,
}

/// The type of the indices of vertices.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_index_type {
    /// uint32_t.
    LEAFLESS_INDEX_TYPE_U32 = 0,
    /// uint64_t.
    LEAFLESS_INDEX_TYPE_U64 = 1,
    /// uint16_t.
    LEAFLESS_INDEX_TYPE_U16 = 2,
}

/// The arrays that a mesh is made of: vertices of three coordinates, and triangles of three indices. They
/// need not be aligned, and may lie among other data, such as normals, which are not read. Zero is the
/// default of every field but the first.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_mesh_arrays {
    /// sizeof(leafless_mesh_arrays).
    pub struct_size: u32,
    /// A leafless_vertex_type.
    pub vertex_type: Number<leafless_vertex_type>,
    /// The first vertex. May be NULL if there is none.
    pub vertices: *const c_void,
    /// Number of vertices.
    pub vertex_count: u64,
    /// Bytes from one vertex to the next; 0 means that they follow each other without a gap.
    pub vertex_stride: u64,
    /// The first triangle: three indices, counted from 0. NULL if there is none, or if every three
    /// consecutive vertices are a triangle.
    pub indices: *const c_void,
    /// Number of triangles. If `indices` is NULL, this must be 0 or a third of `vertex_count`.
    pub triangle_count: u64,
    /// Bytes from one triangle to the next; 0 means that they follow each other without a gap.
    pub triangle_stride: u64,
    /// A leafless_index_type.
    pub index_type: Number<leafless_index_type>,
    /// Factor from coordinates to model units: 2^-256 to 2^256, or 0, which means 1.
    pub scale: f64,
}

// SAFETY: numbers and pointers.
unsafe impl Sized32 for leafless_mesh_arrays {}

/// Vertices of the host.
#[derive(Clone, Copy)]
pub(super) struct Vertices<'a> {
    numbers: Numbers<'a>,
    scale: f64,
}

#[derive(Clone, Copy)]
enum Numbers<'a> {
    F64(Strided<'a, [f64; 3]>),
    F32(Strided<'a, [f32; 3]>),
}

/// A host's description of its vertices.
pub(super) struct GivenVertices {
    pub start: *const c_void,
    pub count: u64,
    pub stride: u64,
    pub kind: Number<leafless_vertex_type>,
    pub scale: f64,
}

impl<'a> Vertices<'a> {
    /// # Safety
    /// The array is as `given` describes it, and does not change during the call.
    pub(super) unsafe fn new(given: GivenVertices) -> Result<Vertices<'a>, Failure> {
        let scale = match given.scale {
            0.0 => 1.0,
            scale if (2f64.powi(-256)..=2f64.powi(256)).contains(&scale) => scale,
            _ => {
                let problem = "must be between 2^-256 and 2^256";
                return Err(Failure::Argument { name: "arrays.scale", problem });
            }
        };
        let names = ["arrays.vertices", "arrays.vertex_stride"];
        let GivenVertices { start, count, stride, .. } = given;
        // SAFETY: the caller's promise; any bytes are numbers.
        let numbers = unsafe {
            match given.kind.known("arrays.vertex_type")? {
                LEAFLESS_VERTEX_TYPE_F64 => Numbers::F64(strided(start, count, stride, names)?),
                LEAFLESS_VERTEX_TYPE_F32 => Numbers::F32(strided(start, count, stride, names)?),
            }
        };
        if u32::try_from(count).is_err() {
            return Err(MeshError::TooMany.into());
        }
        Ok(Vertices { numbers, scale })
    }

    fn len(&self) -> usize {
        match &self.numbers {
            Numbers::F64(numbers) => numbers.len(),
            Numbers::F32(numbers) => numbers.len(),
        }
    }

    /// Returns a vertex in model units.
    #[inline(always)]
    fn at(&self, index: usize) -> [f64; 3] {
        let vertex = match &self.numbers {
            Numbers::F64(numbers) => numbers.at(index),
            Numbers::F32(numbers) => numbers.at(index).map(f64::from),
        };
        vertex.map(|x| x * self.scale)
    }

    /// Returns a copy of all vertices.
    fn copied(&self) -> Result<Vec<[f64; 3]>, Error> {
        let mut own = memory::with_capacity(self.len())?;
        own.extend((0..self.len()).map(|index| self.at(index)));
        Ok(own)
    }

    /// Returns the host's array if it has the library's layout, else a copy.
    pub(super) fn get(&self) -> Result<Cow<'a, [[f64; 3]]>, Error> {
        match self.numbers {
            Numbers::F64(numbers) if self.scale == 1.0 => match numbers.as_slice() {
                Some(numbers) => Ok(Cow::Borrowed(numbers)),
                None => self.copied().map(Cow::Owned),
            },
            _ => self.copied().map(Cow::Owned),
        }
    }
}

/// Indices of the host, in groups of N.
#[derive(Clone, Copy)]
pub(super) enum Indices<'a, const N: usize> {
    U16(Strided<'a, [u16; N]>),
    U32(Strided<'a, [u32; N]>),
    U64(Strided<'a, [u64; N]>),
}

impl<const N: usize> Indices<'_, N> {
    /// # Safety
    /// `start`, `count` and `stride` as for [`strided`]; `kind` is the type of the elements there.
    pub(super) unsafe fn new(
        start: *const c_void,
        count: u64,
        stride: u64,
        kind: Number<leafless_index_type>,
        names: [&'static str; 2],
    ) -> Result<Self, Failure> {
        // SAFETY: the caller's promise; any bytes are numbers.
        unsafe {
            match kind.known("arrays.index_type")? {
                LEAFLESS_INDEX_TYPE_U16 => Ok(Indices::U16(strided(start, count, stride, names)?)),
                LEAFLESS_INDEX_TYPE_U32 => Ok(Indices::U32(strided(start, count, stride, names)?)),
                LEAFLESS_INDEX_TYPE_U64 => Ok(Indices::U64(strided(start, count, stride, names)?)),
            }
        }
    }

    pub(super) fn len(&self) -> usize {
        match self {
            Indices::U16(indices) => indices.len(),
            Indices::U32(indices) => indices.len(),
            Indices::U64(indices) => indices.len(),
        }
    }

    /// Returns a group.
    #[inline(always)]
    pub(super) fn at(&self, index: usize) -> [u64; N] {
        match self {
            Indices::U16(indices) => indices.at(index).map(u64::from),
            Indices::U32(indices) => indices.at(index).map(u64::from),
            Indices::U64(indices) => indices.at(index),
        }
    }
}

impl leafless_mesh_arrays {
    /// # Safety
    /// The arrays are as the fields describe them, and do not change during the call.
    unsafe fn mesh(&self) -> Result<TriangleMesh, Failure> {
        let given = GivenVertices {
            start: self.vertices,
            count: self.vertex_count,
            stride: self.vertex_stride,
            kind: self.vertex_type,
            scale: self.scale,
        };
        let is_soup = self.indices.is_null() && self.triangle_count > 0;
        if is_soup && self.triangle_count.checked_mul(3) != Some(self.vertex_count) {
            let problem = "may be NULL only if there are three vertices for each triangle";
            return Err(Failure::Argument { name: "arrays.indices", problem });
        }
        let triangle_count = if is_soup { 0 } else { self.triangle_count };
        let names = ["arrays.indices", "arrays.triangle_stride"];
        // SAFETY: the caller's promise.
        let (vertices, indices) = unsafe {
            let (stride, kind) = (self.triangle_stride, self.index_type);
            let indices = Indices::<3>::new(self.indices, triangle_count, stride, kind, names)?;
            (Vertices::new(given)?, indices)
        };
        if is_soup {
            let facet = |t| [3 * t, 3 * t + 1, 3 * t + 2].map(|corner| vertices.at(corner));
            return Ok(TriangleMesh::from_facets((0..vertices.len() / 3).map(facet))?);
        }
        if u32::try_from(triangle_count).is_err() {
            return Err(MeshError::TooMany.into());
        }
        let mut triangles = memory::with_capacity(indices.len())?;
        let count = vertices.len() as u64;
        for triangle in 0..indices.len() {
            let corners = indices.at(triangle);
            if let Some(&vertex) = corners.iter().find(|&&vertex| vertex >= count) {
                let triangle = triangle as u64;
                return Err(MeshError::Index { triangle, vertex, vertices: count }.into());
            }
            // The index is less than the number of vertices, which fits in 32 bits.
            triangles.push(corners.map(|vertex| vertex as u32));
        }
        Ok(TriangleMesh::new(vertices.copied()?, triangles)?)
    }
}

/// Makes a mesh from arrays. Equal vertices are welded. Triangles with two coincident corners are dropped and
/// counted. Coordinates below 2^-256 in magnitude count as zero. Seen from outside the solid, the corners of
/// a triangle turn counter-clockwise.
///
/// - Buffers: `arrays`, one struct; its arrays must not change during the call. `mesh`, one pointer.
/// - Result: `*mesh`; not checked to be closed.
/// - Errors: LEAFLESS_E_MESH if a coordinate is infinite, not a number, or beyond ±2^256, or if an index is
///   out of range, with the index of the vertex or triangle in the message, or if there are more than 2^32 -
///   1 vertices or triangles; LEAFLESS_E_ARGUMENT if a type, a stride or the scale is invalid, or if
///   `indices` is NULL and `triangle_count` is neither 0 nor a third of `vertex_count`;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: the arrays are only read during the call, once and in their order, and may be freed after it,
///   because the mesh has its own copies. Release `*mesh` with leafless_mesh_free.
/// - Untrusted input: any values in the arrays.
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
