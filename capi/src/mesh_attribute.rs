//! Attributes of triangles and corners of meshes: colours, materials, faces and bodies.

use super::attribute::{components, give, leafless_attribute};
use super::boundary::{Failure, buffer, guard, out, shared, slice, text};
use super::control::{controlled, leafless_options};
use super::mesh::{give as give_mesh, leafless_mesh};
use super::status::leafless_status;
use core::ffi::c_char;
use leafless::TriangleMesh;
use leafless::attribute::{SurfaceAttribute, sample_triangles};
use leafless::mesh::{AttributeDomain, MeshAttribute};

/// Returns the attribute of a mesh with an index.
fn at(mesh: &TriangleMesh, index: u64) -> Result<&MeshAttribute, Failure> {
    let missing = Failure::Argument { name: "index", problem: "is not below the number of attributes" };
    usize::try_from(index).ok().and_then(|index| mesh.attributes().get(index)).ok_or(missing)
}

/// Returns an attribute of the triangles of a mesh, by its index: an array of values with a name. Files in
/// PLY and 3MF provide `colour` (red, green, blue and opacity from 0 to 255); 3MF files also provide
/// `material` and `object` (numbers, which may have names). A mesh from a polyhedron has `face`, `shell` and
/// `solid`, the numbers of the parts that a triangle belongs to.
///
/// - Buffers: `count`, one number; `name`, `name_length`, `components` and `per_corner`, one each, all NULL
///   to get only the count.
/// - Result: `*count`, the number of all attributes; the name in UTF-8, not NUL-terminated, with its length
///   in bytes; `*components`, the numbers per value, 1 to 4; `*per_corner`, true if each corner of a triangle
///   has a value, false if each triangle has one.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no attribute `index`, unless only the count is requested.
/// - Ownership: the name belongs to the mesh and lives as long as the reference `mesh`.
/// - Untrusted input: any mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_peek_attribute_at(
    mesh: *const leafless_mesh,
    index: u64,
    count: *mut u64,
    name: *mut *const c_char,
    name_length: *mut usize,
    components: *mut u32,
    per_corner: *mut bool,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let count = out(count, "count")?;
        let number = mesh.attributes().len() as u64;
        if name.is_null() && name_length.is_null() && components.is_null() && per_corner.is_null() {
            return count.write(number);
        }
        let (name, name_length) = (out(name, "name")?, out(name_length, "name_length")?);
        let (components, per_corner) = (out(components, "components")?, out(per_corner, "per_corner")?);
        let found = at(mesh, index)?;
        name.write(found.name().as_ptr().cast())?;
        name_length.write(found.name().len())?;
        components.write(found.components() as u32)?;
        per_corner.write(found.domain() == AttributeDomain::Corner)?;
        count.write(number)
    })
}

/// Returns the name of the value `value` of an attribute of a mesh: the name of a material or of an object.
///
/// - Buffers: `count`, one number; `name` and `name_length`, one each, both NULL to get only the count.
/// - Result: `*count`, the number of values, from 0 on, that have names; the name in UTF-8, not
///   NUL-terminated, with its length in bytes.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no attribute `index`, or the value has no name, unless only the
///   count is requested.
/// - Ownership: the name belongs to the mesh and lives as long as the reference `mesh`.
/// - Untrusted input: any mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_peek_attribute_name_at(
    mesh: *const leafless_mesh,
    index: u64,
    value: u64,
    count: *mut u64,
    name: *mut *const c_char,
    name_length: *mut usize,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let count = out(count, "count")?;
        if name.is_null() && name_length.is_null() {
            return count.write(at(mesh, index)?.names().len() as u64);
        }
        let (name, name_length) = (out(name, "name")?, out(name_length, "name_length")?);
        let names = at(mesh, index)?.names();
        let missing = Failure::Argument { name: "value", problem: "has no name" };
        let found = usize::try_from(value).ok().and_then(|value| names.get(value)).ok_or(missing)?;
        name.write(found.as_ptr().cast())?;
        name_length.write(found.len())?;
        count.write(names.len() as u64)
    })
}

/// Returns the values of an attribute of a mesh at the corners of all triangles.
///
/// - Buffers: `values`, room for `capacity` numbers, or NULL to get only the count; `count`, one number.
/// - Result: `*count`, 3 · components · triangles; in `values` the numbers at the three corners of the first
///   triangle, then of the second: NaN where there is no value.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no attribute `index`; LEAFLESS_E_BUFFER if the capacity is too
///   small.
/// - Untrusted input: any mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_attribute_values(
    mesh: *const leafless_mesh,
    index: u64,
    values: *mut f64,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let (values, count) = (buffer(values, capacity, "values")?, out(count, "count")?);
        let found = at(mesh, index)?;
        let each = found.components();
        let all = found.len().saturating_mul(3 * each);
        if let Some(values) = values.zeroed(all)? {
            for (to, place) in values.chunks_exact_mut(each).zip(0..) {
                let value = found.value(place / 3, place % 3).unwrap_or([f64::NAN; 4]);
                to.copy_from_slice(&value[..each]);
            }
        }
        count.write(all as u64)
    })
}

/// Returns the body of each triangle of a mesh. A body is a set of triangles that are connected by edges.
/// Bodies are numbered from 0 by their first triangles. Shells that touch only in single vertices, or lie
/// inside each other, are different bodies.
///
/// - Buffers: `bodies`, room for `capacity` numbers, or NULL to get only the count; `count`, one number.
/// - Result: `*count`, the number of triangles; in `bodies` the number of each triangle's body.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_bodies(
    mesh: *const leafless_mesh,
    bodies: *mut u32,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let (bodies, count) = (buffer(bodies, capacity, "bodies")?, out(count, "count")?);
        bodies.check(mesh.triangles().len())?;
        if bodies.wanted() {
            bodies.fill(&mesh.bodies()?)?;
        }
        count.write(mesh.triangles().len() as u64)
    })
}

/// Returns the same mesh with one more attribute with a name, whose values come from `attribute`. The value
/// of a triangle is the value just inside it, `depth_model` behind its centroid. If there is none, it is the
/// value at a quarter of the depth, at twice the depth, or at the centroid itself; otherwise the triangle has
/// no value. So a surface takes values from the channels of its solid: half the edge of a channel's cells is
/// a good depth. leafless_mesh_write writes colours as `colour`, and materials as `material`.
///
/// O(t) queries. An attribute of the mesh with the same name is replaced.
///
/// - Buffers: `name`, `name_length` bytes of UTF-8; `options`, one struct or NULL; `bearing`, one pointer.
/// - Result: `*bearing`, identical for any number of threads.
/// - Errors: LEAFLESS_E_ARGUMENT unless the depth is finite and not negative; LEAFLESS_E_UTF8;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` and `attribute` are unchanged; release `*bearing` with leafless_mesh_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any mesh, any attribute, any text.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_with_values(
    mesh: *const leafless_mesh,
    attribute: *const leafless_attribute,
    name: *const c_char,
    name_length: usize,
    depth_model: f64,
    options: *const leafless_options,
    bearing: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let attribute = &shared(attribute, "attribute")?.attribute;
        let name = text(name, name_length, "name")?;
        let bearing = out(bearing, "bearing")?;
        let values =
            controlled(options, |control| sample_triangles(mesh, attribute, name, depth_model, control))?;
        let mut found = mesh.try_clone()?;
        let mut kept = found.take_attributes();
        kept.retain(|own| own.name() != name);
        for own in kept {
            found.add_attribute(own)?;
        }
        found.add_attribute(values)?;
        bearing.write(give_mesh(found))
    })
}

/// Makes an attribute from an attribute of a mesh. Its value at a point is the value at the nearest point of
/// the mesh's surface: the value of the nearest triangle, or, with values for corners, the interpolated
/// value. If several triangles are equally near, the first one counts. Its ranges are proven.
///
/// - Buffers: `name`, `name_length` bytes of UTF-8: the name of an attribute of the mesh; `attribute`, one
///   pointer.
/// - Result: `*attribute`.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_ARGUMENT if the mesh has no such attribute; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the mesh is shared and may be freed; release `*attribute` with leafless_attribute_free.
/// - Untrusted input: any mesh, any text.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_attribute_from_mesh(
    mesh: *const leafless_mesh,
    name: *const c_char,
    name_length: usize,
    attribute: *mut *mut leafless_attribute,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = shared(mesh, "mesh")?.mesh.clone();
        let name = text(name, name_length, "name")?;
        let attribute = out(attribute, "attribute")?;
        attribute.write(give(SurfaceAttribute::of_mesh(mesh, name)?))
    })
}

/// Like leafless_attribute_from_mesh, with the host's own values: of bodies, faces, materials, or colours of
/// corners.
///
/// - Buffers: `values`, `count` numbers: `components` for each triangle, or for each of its three corners,
///   one after the other; `attribute`, one pointer.
/// - Result: `*attribute`. A value with a number that is not finite counts as no value.
/// - Errors: LEAFLESS_E_ARGUMENT unless `components` is 1 to 4, and there are values for all triangles;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: the values are copied, the mesh is shared and may be freed; release `*attribute` with
///   leafless_attribute_free.
/// - Untrusted input: any mesh, any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_attribute_from_mesh_values(
    mesh: *const leafless_mesh,
    values: *const f64,
    count: u64,
    components: u32,
    per_corner: bool,
    attribute: *mut *mut leafless_attribute,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = shared(mesh, "mesh")?.mesh.clone();
        let values = slice(values, count, "values")?;
        let components = self::components(components, "components")?;
        let attribute = out(attribute, "attribute")?;
        let own = match per_corner {
            true => MeshAttribute::per_corner("", components, values)?,
            false => MeshAttribute::per_triangle("", components, values)?,
        };
        attribute.write(give(SurfaceAttribute::new(mesh, own)?))
    })
}
