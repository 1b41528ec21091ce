//! Scenes in the language of OpenSCAD's CSG dumps.

use super::boundary::{
    Failure, Sized32, buffer, filled, guard, handle, out, output, refer, release, shared, sized, text,
};
use super::frame::{frame, leafless_frame};
use super::mesh::leafless_mesh_report;
use super::number::{Number, enumeration};
use super::solid::{give, leafless_solid};
use super::source::{Source, copy, leafless_source};
use super::status::leafless_status;
use core::ffi::c_char;
use leafless::scene::{Facets, Scene, SceneMesh, SceneOptions};
use std::path::Path;

/// A scene that a text describes: set operations on primitives, swept figures, meshes and octrees.
///
/// The language is that of the CSG dumps that OpenSCAD exports (group union difference intersection
/// multmatrix color render cube sphere cylinder polyhedron linear_extrude rotate_extrude square circle
/// polygon, and import of meshes), with these additional calls: halfspace([a, b, c, d]), which is a x + b y +
/// c z + d ≥ 0, quadric([10 numbers]), power([A, a, n1], [B, b, n2], [C, c, n3], R), torus(major, minor),
/// mesh("file.stl") and octree("file.lfl"). Curved shapes are exact, except shapes with a $fn of 12 or less,
/// which are the polygons, prisms and polyhedra that OpenSCAD draws; leafless_scene_options can change this.
/// Unsupported calls (hull, minkowski, text, projection and others) are refused by name.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_scene_free releases.
pub struct leafless_scene {
    scene: Scene,
}

/// The circles, balls, cylinders and solids of revolution that are drawn as polygons, prisms and polyhedra.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_facets {
    /// Curves with a $fn of 12 or less; all others are exact.
    LEAFLESS_FACETS_AUTO = 0,
    /// None: all curves are exact.
    LEAFLESS_FACETS_EXACT = 1,
    /// All, with as many sides as OpenSCAD draws. A scene with more than 1024 sides to a curve is refused.
    LEAFLESS_FACETS_POLYGON = 2,
}

enumeration! {
    leafless_facets => Facets {
        LEAFLESS_FACETS_AUTO => Facets::Auto,
        LEAFLESS_FACETS_EXACT => Facets::Exact,
        LEAFLESS_FACETS_POLYGON => Facets::Polygon,
    }
}

/// Options of reading a scene. NULL means the defaults. Zero is the default of every field but the first.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_scene_options {
    /// sizeof(leafless_scene_options).
    pub struct_size: u32,
    /// A leafless_facets: the curves that are drawn as polygons.
    pub facets: Number<leafless_facets>,
    /// The folder of the files that a text in memory names, UTF-8; NULL if it must not name files. NULL for a
    /// scene with a path, whose files are in the scene's folder.
    pub folder: *const c_char,
    /// Length of `folder` in bytes. An empty folder that is not NULL is the current directory of the process.
    pub folder_length: usize,
}

// SAFETY: numbers and a pointer.
unsafe impl Sized32 for leafless_scene_options {}

/// Returns the options and the folder.
///
/// # Safety
/// `options` is NULL or points to valid options, whose folder lives as long as the result is used.
unsafe fn options<'a>(
    options: *const leafless_scene_options,
) -> Result<(SceneOptions, Option<&'a Path>), Failure> {
    // SAFETY: the caller's promise.
    let given = unsafe { sized(options, "options")? };
    let facets = given.facets.known("options.facets")?;
    // SAFETY: the caller's promise.
    let folder = unsafe { text(given.folder, given.folder_length, "options.folder")? };
    Ok((SceneOptions::with_facets(facets), (!given.folder.is_null()).then_some(Path::new(folder))))
}

/// Reads a scene, a text in UTF-8. Files that it names are read from the scene's folder or, for a text in
/// memory, from the folder of the options.
///
/// - Buffers: `source`, one struct, with LEAFLESS_ACCESS_COPY; `options`, one struct, or NULL; `scene`, one
///   pointer.
/// - Result: `*scene`.
/// - Errors: LEAFLESS_E_SCENE, with line and column in the message, if the text or a file that it names
///   cannot be used, also if a file is named and there is no folder; LEAFLESS_E_ARGUMENT if both a path and a
///   folder are given; LEAFLESS_E_IO if the file itself cannot be read; LEAFLESS_E_UTF8;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*scene` with leafless_scene_free.
/// - Untrusted input: any text; nesting costs memory, not stack, and memory is linear in the text and in the
///   files that it names; with LEAFLESS_FACETS_POLYGON a ball may take memory for half a million half-spaces.
///   The text may name any file, also by an absolute path; the file is then read as a mesh or an octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_scene_read(
    source: *const leafless_source,
    options: *const leafless_scene_options,
    scene: *mut *mut leafless_scene,
) -> leafless_status {
    guard(|| unsafe {
        let source = copy(source)?;
        let (options, folder) = self::options(options)?;
        let result = out(scene, "scene")?;
        let scene = match (source, folder) {
            (Source::Path(path), None) => options.open(path)?,
            (Source::Bytes(bytes), folder) => options.read(bytes, folder)?,
            (Source::Path(_), Some(_)) => {
                let problem = "must be NULL for a scene with a path, whose files lie beside it";
                return Err(Failure::Argument { name: "options.folder", problem });
            }
        };
        result.write(handle(leafless_scene { scene }))
    })
}

/// A report of the reading of a scene.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_scene_info {
    /// sizeof(leafless_scene_info).
    pub struct_size: u32,
    /// Calls of circle, sphere, cylinder and rotate_extrude that were drawn as polygons.
    pub polygons: u64,
    /// Calls of the same functions that are exact. OpenSCAD draws them as polygons.
    pub exact: u64,
    /// Calls of linear_extrude whose `slices` has no effect here, but has one in OpenSCAD.
    pub ignored_slices: u64,
    /// Meshes and polyhedra that have triangles: leafless_scene_describe_mesh_at describes each.
    pub meshes: u64,
    /// Whether the scene is known to be empty: it has no objects, or the operands of an intersection are
    /// disjoint.
    pub is_empty: bool,
}

output!(leafless_scene_info);

/// Facts about a mesh or polyhedron in a scene.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_scene_mesh_info {
    /// sizeof(leafless_scene_mesh_info).
    pub struct_size: u32,
    /// Line of the call in the text, counted from 1.
    pub line: u64,
    /// Column of the call in characters, counted from 1.
    pub column: u64,
    /// Triangles whose orientation differs from that of most triangles that they are connected with.
    pub turned: u64,
}

output!(leafless_scene_mesh_info);

/// Returns the report of the reading of a scene.
///
/// - Buffers: `report`, one struct.
/// - Result: `*report`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_scene_describe(
    scene: *const leafless_scene,
    report: *mut leafless_scene_info,
) -> leafless_status {
    guard(|| unsafe {
        let scene = &shared(scene, "scene")?.scene;
        let result = filled(report, "report")?;
        let found = scene.report();
        result.write(leafless_scene_info {
            struct_size: size_of::<leafless_scene_info>() as u32,
            polygons: found.polygons,
            exact: found.exact,
            ignored_slices: found.ignored_slices,
            meshes: found.meshes.len() as u64,
            is_empty: scene.is_empty()?,
        })
    })
}

/// # Safety
/// `scene` is NULL or a valid scene.
unsafe fn mesh<'a>(scene: *const leafless_scene, index: u64) -> Result<&'a SceneMesh, Failure> {
    // SAFETY: the caller's promise.
    let meshes = unsafe { &shared(scene, "scene")?.scene.report().meshes };
    let found = usize::try_from(index).ok().and_then(|index| meshes.get(index));
    found.ok_or(Failure::Argument { name: "index", problem: "must be less than the number of meshes" })
}

/// Returns facts about a mesh or polyhedron of a scene, and the report of its import.
///
/// - Buffers: `mesh`, one struct; `report`, one struct, or NULL if it is not wanted. `index`, in the order of
///   the text, is less than `meshes` of leafless_scene_info.
/// - Result: `*mesh`; `*report`, the report of the mesh as it was imported.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no such mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_scene_describe_mesh_at(
    scene: *const leafless_scene,
    index: u64,
    mesh: *mut leafless_scene_mesh_info,
    report: *mut leafless_mesh_report,
) -> leafless_status {
    guard(|| unsafe {
        let found = self::mesh(scene, index)?;
        let result = filled(mesh, "mesh")?;
        let to = if report.is_null() { None } else { Some(filled(report, "report")?) };
        let SceneMesh { line, column, turned, report, .. } = found;
        result.write(leafless_scene_mesh_info {
            struct_size: size_of::<leafless_scene_mesh_info>() as u32,
            line: *line,
            column: *column,
            turned: *turned,
        })?;
        to.map_or(Ok(()), |to| to.write((*report).into()))
    })
}

/// Returns the file name of a mesh in a scene, as written in the text, in UTF-8 and not terminated by NUL;
/// empty for a polyhedron.
///
/// - Buffers: `bytes`, room for `capacity` bytes, or NULL to get only the length; `length`, one number.
///   `index`, in the order of the text, is less than `meshes` of leafless_scene_info.
/// - Result: `*length`, the length of the name in bytes; the name in `bytes`.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_ARGUMENT if there is no such mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_scene_mesh_file_at(
    scene: *const leafless_scene,
    index: u64,
    bytes: *mut u8,
    capacity: u64,
    length: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let file = &self::mesh(scene, index)?.file;
        let bytes = buffer(bytes, capacity, "bytes")?;
        let length = out(length, "length")?;
        bytes.fill(file.as_bytes())?;
        length.write(file.len() as u64)
    })
}

/// Returns one more reference to a scene.
///
/// - Buffers: `scene`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `scene`.
/// - Ownership: release each reference with leafless_scene_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_scene_ref(
    scene: *const leafless_scene,
    reference: *mut *mut leafless_scene,
) -> leafless_status {
    guard(|| unsafe { refer(scene, "scene", reference) })
}

/// Releases a reference to a scene; the last release frees the scene. Solids made of it stay.
///
/// - Buffers: `scene`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_scene_free(scene: *mut leafless_scene) {
    // SAFETY: the caller's promise.
    unsafe { release(scene) }
}

/// Returns a box that contains the solid of a scene. It may be larger than the solid.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each.
/// - Result: both.
/// - Errors: LEAFLESS_E_ARGUMENT if no box is known: the scene is empty, or may be unbounded;
///   LEAFLESS_E_NO_MEMORY.
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

/// Makes the solid of a scene, to be built on this frame. If it contains neither meshes nor octrees, it can
/// be built on any frame.
///
/// - Buffers: `frame`, one struct; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check; LEAFLESS_E_LIMIT if a mesh or octree is within more
///   than 256 matrices; LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any scene.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_from_scene(
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
