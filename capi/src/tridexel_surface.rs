//! Conversion of tri-dexel models: meshes, octrees, solids, voxels.

use super::boundary::{buffer, filled, guard, out, output, shared, slice};
use super::control::{controlled, leafless_options};
use super::mesh::{give as give_mesh, leafless_mesh};
use super::number::{Number, enumeration};
use super::octree::{give as give_octree, leafless_octree};
use super::solid::{give as give_solid, leafless_solid};
use super::status::leafless_status;
use super::tridexel::leafless_tridexel;
use super::voxel::leafless_voxel_kind::{self, *};
use leafless::attribute::dexel_materials;
use leafless::op::{octree_from_dexel_ends, octree_from_dexels};
use leafless::surface::{DexelSolid, DexelSurfaceReport, dual_contouring_dexels, marching_cubes_dexels};
use leafless::voxel::{LongVoxel, VoxelKind, dexel_voxels};
use leafless::{Control, Error, Metadata, Octree, TriDexel};
use leafless_dexel_surface_method::*;

/// The method that extracts the surface of a tri-dexel model.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_dexel_surface_method {
    /// Marching cubes: a vertex where a ray crosses the surface between two neighbouring centres of cells.
    /// Edges and corners of the solid are cut off by up to one cell.
    LEAFLESS_DEXEL_SURFACE_METHOD_MARCHING_CUBES = 0,
    /// Dual contouring: a vertex for each sheet of the surface in a cube between eight centres, at the best
    /// fit of the planes at its crossings. Edges and corners of the solid are kept if the model stores
    /// normals.
    LEAFLESS_DEXEL_SURFACE_METHOD_DUAL_CONTOURING = 1,
}

enumeration! {
    leafless_dexel_surface_method => leafless_dexel_surface_method {
        LEAFLESS_DEXEL_SURFACE_METHOD_MARCHING_CUBES => LEAFLESS_DEXEL_SURFACE_METHOD_MARCHING_CUBES,
        LEAFLESS_DEXEL_SURFACE_METHOD_DUAL_CONTOURING => LEAFLESS_DEXEL_SURFACE_METHOD_DUAL_CONTOURING,
    }
}

/// A report of how exactly a surface of a tri-dexel model follows its rays.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_dexel_surface_report {
    /// sizeof(leafless_dexel_surface_report).
    pub struct_size: u32,
    /// Edges between two neighbouring cell centres of which one lies inside: places where a ray crosses the
    /// surface.
    pub crossings: u64,
    /// Crossings on edges where the ray crosses the surface more than once: details thinner than a cell are
    /// lost there.
    pub several: u64,
    /// Crossings that were put in the middle of their edges, because the model has no rays along these edges.
    pub without_rays: u64,
    /// Crossings that were put in the middle of their edges, because the directions of the model disagree
    /// there.
    pub disagreeing: u64,
    /// Crossings without a known normal. (Only for dual contouring.)
    pub without_normals: u64,
    /// Vertices with no normal at any of their crossings, placed at the mean of the crossings. (Only for dual
    /// contouring.)
    pub means: u64,
    /// Vertices that were kept inside their cells though they would fit their planes better outside. (Only
    /// for dual contouring.)
    pub clamped: u64,
    /// Bodies that are missing in the mesh: sets of inside cell centres, connected along axes, whose
    /// crossings have no triangle, because the surface is nearer to the centres than doubles can resolve.
    pub vanished: u64,
    /// Intervals in all directions that contain no cell centre, where touching intervals count as one:
    /// details thinner than the lattice that are missing in the mesh.
    pub without_centres: u64,
}

output!(leafless_dexel_surface_report);

impl From<DexelSurfaceReport> for leafless_dexel_surface_report {
    fn from(report: DexelSurfaceReport) -> leafless_dexel_surface_report {
        leafless_dexel_surface_report {
            struct_size: size_of::<leafless_dexel_surface_report>() as u32,
            crossings: report.crossings,
            several: report.several,
            without_rays: report.without_rays,
            disagreeing: report.disagreeing,
            without_normals: report.without_normals,
            means: report.means,
            clamped: report.clamped,
            vanished: report.vanished,
            without_centres: report.without_centres,
        }
    }
}

/// A row of voxels along y with the same kind and material.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_long_voxel {
    /// Indices of the first voxel. The voxel (x, y, z) lies between the centres of the cells x - 1 and x, and
    /// likewise on the other axes: each index is from 0 to the number of cells of an axis, inclusive.
    pub first: [u32; 3],
    /// Number of voxels.
    pub length: u32,
    /// The material; 0 if none was given.
    pub material: u32,
    /// The material's colour: red, green, blue and opacity, 0 to 255.
    pub colour: [u8; 4],
    /// LEAFLESS_VOXEL_KIND_INSIDE or LEAFLESS_VOXEL_KIND_BOUNDARY.
    pub kind: leafless_voxel_kind,
}

impl From<&LongVoxel> for leafless_long_voxel {
    fn from(voxel: &LongVoxel) -> leafless_long_voxel {
        leafless_long_voxel {
            first: voxel.first,
            length: voxel.length,
            material: voxel.material,
            colour: voxel.colour,
            kind: match voxel.kind {
                VoxelKind::Inside => LEAFLESS_VOXEL_KIND_INSIDE,
                _ => LEAFLESS_VOXEL_KIND_BOUNDARY,
            },
        }
    }
}

/// Extracts the surface of a tri-dexel model: a closed mesh. Samples are the centres of cells; space outside
/// the universe counts as outside.
///
/// Triangles turn counter-clockwise as seen from outside. Every edge belongs to exactly two triangles, except
/// where vertices coincide: these are merged, and triangles without area are dropped. Where no ray gives the
/// crossing, because the model has no rays along an axis or its directions disagree, the crossing lies
/// half-way between the two centres; the report counts such places.
///
/// O(rays + intervals + octree + mesh), with the octree of leafless_octree_from_tridexel.
///
/// - Buffers: `options`, one struct or NULL; `report`, one struct, or NULL if it is not wanted; `mesh`, one
///   pointer. `method` is a leafless_dexel_surface_method.
/// - Result: `*mesh`, identical for any number of threads; it has no triangles if no centre lies inside, or
///   if all bodies vanish. `*report`.
/// - Errors: LEAFLESS_E_ARGUMENT also if the frame is so far from the origin that doubles cannot distinguish
///   its cells; LEAFLESS_E_MESH if there would be more than 2^32 - 1 vertices or triangles;
///   LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `tridexel` is unchanged; release `*mesh` with leafless_mesh_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any model; a damaged model is refused (LEAFLESS_E_DAMAGED).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_surface(
    tridexel: *const leafless_tridexel,
    method: Number<leafless_dexel_surface_method>,
    options: *const leafless_options,
    report: *mut leafless_dexel_surface_report,
    mesh: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe {
        let model = shared(tridexel, "tridexel")?.model.view();
        let extract = match method.known("method")? {
            LEAFLESS_DEXEL_SURFACE_METHOD_MARCHING_CUBES => marching_cubes_dexels,
            LEAFLESS_DEXEL_SURFACE_METHOD_DUAL_CONTOURING => dual_contouring_dexels,
        };
        let report = if report.is_null() { None } else { Some(filled(report, "report")?) };
        let mesh = out(mesh, "mesh")?;
        let (made, found) = controlled(options, |control| extract(model, control))?;
        if let Some(report) = report {
            report.write(found.into())?;
        }
        mesh.write(give_mesh(made))
    })
}

/// Makes the octree of a tri-dexel model by the centres of cells: a finest cell is FULL if its centre lies
/// inside, else EMPTY. The octree proves nothing.
///
/// - Buffers: `options`, one struct or NULL; `octree`, one pointer.
/// - Result: `*octree`, with the model's facts "name" and "units" and no others; if the model stores
///   materials, with a channel "material" of type U32, the material's number at the centre of each cell;
///   identical for any number of threads.
/// - Errors: LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `tridexel` is unchanged; release `*octree` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any model; a damaged model is refused (LEAFLESS_E_DAMAGED); set `max_bytes` if its
///   depth is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_from_tridexel(
    tridexel: *const leafless_tridexel,
    options: *const leafless_options,
    octree: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let model = &shared(tridexel, "tridexel")?.model;
        let octree = out(octree, "octree")?;
        let made = controlled(options, |control| {
            with_materials(octree_from_dexels(model.view(), control)?, model, control)
        })?;
        octree.write(give_octree(made.with_metadata(Metadata::common([model.metadata()])?)))
    })
}

/// Makes the octree of a tri-dexel model by the ends of its intervals: a finest cell is FULL if all rays
/// through it are entirely inside, EMPTY if all are entirely outside, and PARTIAL if an end lies in the cell
/// or the directions disagree.
///
/// A decided cell agrees with every ray through it. Details thinner than a cell are undecided where a ray
/// meets them, and not lost. Nothing is known between the rays: the cells prove nothing about the solid that
/// the rays came from, and the volumes of FULL and PARTIAL cells are not proven bounds.
///
/// - Buffers: `options`, one struct or NULL; `octree`, one pointer.
/// - Result: `*octree`, with facts and a channel as from leafless_octree_from_tridexel.
/// - Errors: LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `tridexel` is unchanged; release `*octree` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any model; a damaged model is refused (LEAFLESS_E_DAMAGED); set `max_bytes` if its
///   depth is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_from_tridexel_ends(
    tridexel: *const leafless_tridexel,
    options: *const leafless_options,
    octree: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let model = &shared(tridexel, "tridexel")?.model;
        let octree = out(octree, "octree")?;
        let made = controlled(options, |control| {
            with_materials(octree_from_dexel_ends(model.view(), control)?, model, control)
        })?;
        octree.write(give_octree(made.with_metadata(Metadata::common([model.metadata()])?)))
    })
}

/// Returns an octree of a model with the model's materials as a channel.
fn with_materials(octree: Octree, model: &TriDexel, control: &Control<'_>) -> Result<Octree, Error> {
    let quiet = Control { progress: None, ..*control };
    match dexel_materials(model.view(), octree.view(), &quiet)? {
        Some(channel) => octree.with_channel(channel),
        None => Ok(octree),
    }
}

/// Makes a solid from a tri-dexel model, for any frame: the inside of its surface by marching cubes.
///
/// That surface is near the surface that the model was made from, not on it. So octrees of the solid prove
/// nothing, and its measures are not bounds. With `is_truth` the surface counts as the truth, and both are as
/// for any mesh.
///
/// - Buffers: `options`, one struct or NULL; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: as leafless_tridexel_surface, and LEAFLESS_E_MESH if no centre of a cell lies inside.
/// - Ownership: the library keeps no reference to `tridexel`; release `*solid` with leafless_solid_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any model; a damaged model is refused (LEAFLESS_E_DAMAGED).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_from_tridexel(
    tridexel: *const leafless_tridexel,
    is_truth: bool,
    options: *const leafless_options,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let model = shared(tridexel, "tridexel")?.model.view();
        let solid = out(solid, "solid")?;
        let made = controlled(options, |control| DexelSolid::new(model, control))?;
        solid.write(give_solid(if is_truth { made.as_truth() } else { made }))
    })
}

/// Lists the voxels of a tri-dexel model. The corners of a voxel are cell centres: it is inside if all of its
/// eight corners are inside, outside if none is, and otherwise on the boundary. Inside and boundary voxels
/// are merged along y where kind and material are the same. A voxel has the material of its first inside
/// corner, with x varying fastest and z slowest, and the colour in `colours` at the index of the material's
/// number; materials beyond are grey (128, 128, 128, 255). Call it once for the count, and then with a
/// buffer.
///
/// O(rays of the window + blocks + rows), for blocks of 64 x 64 x 64 cells in which centres lie inside.
///
/// - Buffers: `options`, one struct or NULL; `colours`, `colour_count` colours of four bytes (red, green,
///   blue, opacity), or NULL for none; `voxels`, room for `capacity` structs, or NULL to get only the count;
///   `count`, one number.
/// - Result: `*count`; the rows of voxels by z, then by x, then by y.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any model; a damaged model is refused (LEAFLESS_E_DAMAGED).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_voxels(
    tridexel: *const leafless_tridexel,
    options: *const leafless_options,
    colours: *const u8,
    colour_count: u64,
    voxels: *mut leafless_long_voxel,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let model = shared(tridexel, "tridexel")?.model.view();
        let colours = slice(colours.cast::<[u8; 4]>(), colour_count, "colours")?;
        let voxels = buffer(voxels, capacity, "voxels")?;
        let count = out(count, "count")?;
        let found = controlled(options, |control| dexel_voxels(model, colours, control))?;
        voxels.fill_with(found.list())?;
        count.write(found.list().len() as u64)
    })
}
