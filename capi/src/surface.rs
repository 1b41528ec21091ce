//! Surfaces: closed triangle meshes of octrees and solids.

use super::boundary::{Failure, Sized32, guard, out, shared, sized};
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame, leafless_interval};
use super::mesh::{give, leafless_mesh};
use super::number::{Number, enumeration};
use super::octree::leafless_octree;
use super::solid::leafless_solid;
use super::status::leafless_status;
use super::volume::leafless_volume;
use leafless::marching_cubes;
use leafless::surface::{
    Resolve, Snap, VertexPlacement, coplanar_shrink, coplanar_shrink_solid, dual_contouring_solid,
    marching_cubes_solid, marching_cubes_volume, published_shrink, published_shrink_solid,
    simple_marching_cubes, simple_marching_cubes_solid, surface_nets,
};
use leafless_resolve::*;
use leafless_surface_method::*;

/// The method that makes a surface.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_surface_method {
    /// Marching cubes: vertices on the edges between inside and outside samples. Exactly two triangles meet
    /// at every edge.
    LEAFLESS_SURFACE_METHOD_MARCHING_CUBES = 0,
    /// Simple marching cubes: all vertices are samples, and all normals have one of 13 directions up to sign.
    /// The mesh is closed, but where its sheets touch, more than two triangles meet at an edge.
    LEAFLESS_SURFACE_METHOD_SIMPLE_MARCHING_CUBES = 1,
    /// Coplanar shrink: the surface of simple marching cubes with far fewer triangles where it has plane
    /// parts. All triangles in one plane become one region with straight edges. There are no cracks;
    /// triangles may be long and thin.
    LEAFLESS_SURFACE_METHOD_SHRINK = 2,
    /// Coplanar shrink in its published form, for comparison. It has cracks, so that the mesh is open where
    /// merged cells of several sizes meet.
    LEAFLESS_SURFACE_METHOD_SHRINK_PUBLISHED = 3,
    /// Dual contouring, for solids only: edges and corners stay sharp. Samples are the centres of cells. It
    /// is leafless_tridexel_surface of a temporary tri-dexel model with normals; that function also reports
    /// features that the mesh does not represent.
    LEAFLESS_SURFACE_METHOD_DUAL_CONTOURING = 4,
    /// Surface nets, for octrees only: a vertex in each cube between samples that do not all lie on one side,
    /// in the middle of the surface's crossings with the cube. Steps of the cells are smoothed; exactly two
    /// triangles meet at every edge.
    LEAFLESS_SURFACE_METHOD_SURFACE_NETS = 5,
}

enumeration! {
    leafless_surface_method => leafless_surface_method {
        LEAFLESS_SURFACE_METHOD_MARCHING_CUBES => LEAFLESS_SURFACE_METHOD_MARCHING_CUBES,
        LEAFLESS_SURFACE_METHOD_SIMPLE_MARCHING_CUBES => LEAFLESS_SURFACE_METHOD_SIMPLE_MARCHING_CUBES,
        LEAFLESS_SURFACE_METHOD_SHRINK => LEAFLESS_SURFACE_METHOD_SHRINK,
        LEAFLESS_SURFACE_METHOD_SHRINK_PUBLISHED => LEAFLESS_SURFACE_METHOD_SHRINK_PUBLISHED,
        LEAFLESS_SURFACE_METHOD_DUAL_CONTOURING => LEAFLESS_SURFACE_METHOD_DUAL_CONTOURING,
        LEAFLESS_SURFACE_METHOD_SURFACE_NETS => LEAFLESS_SURFACE_METHOD_SURFACE_NETS,
    }
}

/// The end of an edge between an inside and an outside sample to which simple marching cubes and coplanar
/// shrink move the vertex.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_snap {
    /// The outer end: the mesh contains all inside samples.
    LEAFLESS_SNAP_FAT = 0,
    /// The inner end: inside samples are vertices. Parts that are one cell thick then have no thickness.
    LEAFLESS_SNAP_THIN = 1,
}

enumeration! {
    leafless_snap => Snap {
        LEAFLESS_SNAP_FAT => Snap::Fat,
        LEAFLESS_SNAP_THIN => Snap::Thin,
    }
}

/// The side of the surface for the PARTIAL cells of an octree, which have no sign of their own.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_resolve {
    /// Not given, which is an error if there are PARTIAL cells.
    LEAFLESS_RESOLVE_NONE = 0,
    /// Outside: the surface is that of the FULL cells, which are certainly solid.
    LEAFLESS_RESOLVE_INNER = 1,
    /// Inside: the surface is that of the FULL and PARTIAL cells, which are possibly solid.
    LEAFLESS_RESOLVE_OUTER = 2,
    /// Decided by `source`, the solid that the octree was made from: each cell's centre decides, as under
    /// LEAFLESS_RULE_SAMPLED. The solid is built anew on the octree's frame.
    LEAFLESS_RESOLVE_SOURCE = 3,
}

enumeration! {
    leafless_resolve => leafless_resolve {
        LEAFLESS_RESOLVE_NONE => LEAFLESS_RESOLVE_NONE,
        LEAFLESS_RESOLVE_INNER => LEAFLESS_RESOLVE_INNER,
        LEAFLESS_RESOLVE_OUTER => LEAFLESS_RESOLVE_OUTER,
        LEAFLESS_RESOLVE_SOURCE => LEAFLESS_RESOLVE_SOURCE,
    }
}

/// The position of a vertex of marching cubes on an edge between an inside and an outside sample.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_vertex_placement {
    /// Half-way. The mesh has steps, and is up to half a cell away from the surface.
    LEAFLESS_VERTEX_PLACEMENT_MIDPOINT = 0,
    /// Where the edge crosses the solid's surface; if it crosses several times, at one of the crossings.
    /// Half-spaces, meshes and solids made of them provide the crossing up to rounding. For a solid that only
    /// classifies boxes, cells along the edge are split down to depth 20, and the crossing is known to a cell
    /// of that depth.
    LEAFLESS_VERTEX_PLACEMENT_CROSSING = 1,
}

enumeration! {
    leafless_vertex_placement => VertexPlacement {
        LEAFLESS_VERTEX_PLACEMENT_MIDPOINT => VertexPlacement::Midpoint,
        LEAFLESS_VERTEX_PLACEMENT_CROSSING => VertexPlacement::Crossing,
    }
}

/// Options of extracting a surface. NULL means the defaults. Zero is the default of every field but the
/// first. A field that the method does not use must be zero.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_surface_options {
    /// sizeof(leafless_surface_options).
    pub struct_size: u32,
    /// A leafless_surface_method.
    pub method: Number<leafless_surface_method>,
    /// A leafless_snap, for LEAFLESS_SURFACE_METHOD_SIMPLE_MARCHING_CUBES and both kinds of
    /// LEAFLESS_SURFACE_METHOD_SHRINK.
    pub snap: Number<leafless_snap>,
    /// A leafless_resolve, for octrees. Solids decide all samples themselves.
    pub resolve: Number<leafless_resolve>,
    /// A leafless_vertex_placement, for LEAFLESS_SURFACE_METHOD_MARCHING_CUBES of solids. Octrees do not
    /// store the position of their solid's surface.
    pub placement: Number<leafless_vertex_placement>,
    /// Reserved; 0.
    pub reserved: u32,
    /// The solid that the octree was made from, for LEAFLESS_RESOLVE_SOURCE.
    pub source: *const leafless_solid,
}

// SAFETY: numbers and a pointer.
unsafe impl Sized32 for leafless_surface_options {}

#[derive(Clone, Copy)]
enum Method {
    MarchingCubes,
    Smc(Snap),
    Shrink(Snap),
    PublishedShrink(Snap),
    DualContouring,
    SurfaceNets,
}

/// Refuses a field that should be zero and is not.
fn zero(is_zero: bool, name: &'static str, problem: &'static str) -> Result<(), Failure> {
    if is_zero { Ok(()) } else { Err(Failure::Argument { name, problem }) }
}

impl leafless_surface_options {
    fn method(&self) -> Result<Method, Failure> {
        zero(self.reserved == 0, "surface.reserved", "must be 0")?;
        let snap = self.snap.known("surface.snap")?;
        match self.method.known("surface.method")? {
            LEAFLESS_SURFACE_METHOD_MARCHING_CUBES => {
                let problem = "is not for marching cubes, whose vertices lie between samples";
                zero(snap == Snap::Fat, "surface.snap", problem)?;
                Ok(Method::MarchingCubes)
            }
            LEAFLESS_SURFACE_METHOD_SIMPLE_MARCHING_CUBES => Ok(Method::Smc(snap)),
            LEAFLESS_SURFACE_METHOD_SHRINK => Ok(Method::Shrink(snap)),
            LEAFLESS_SURFACE_METHOD_SHRINK_PUBLISHED => Ok(Method::PublishedShrink(snap)),
            LEAFLESS_SURFACE_METHOD_DUAL_CONTOURING => {
                let problem = "is not for dual contouring, whose vertices lie between samples";
                zero(snap == Snap::Fat, "surface.snap", problem)?;
                Ok(Method::DualContouring)
            }
            LEAFLESS_SURFACE_METHOD_SURFACE_NETS => {
                let problem = "is not for surface nets, whose vertices lie between samples";
                zero(snap == Snap::Fat, "surface.snap", problem)?;
                Ok(Method::SurfaceNets)
            }
        }
    }

    /// # Safety
    /// `source` is NULL or misaligned, or a handle that is alive.
    unsafe fn resolve<'a>(&self) -> Result<Option<Resolve<'a>>, Failure> {
        let resolve = self.resolve.known("surface.resolve")?;
        if let LEAFLESS_RESOLVE_SOURCE = resolve {
            // SAFETY: the caller's promise.
            let source = unsafe { shared(self.source, "surface.source")? };
            return Ok(Some(Resolve::Source(source.solid.solid())));
        }
        zero(self.source.is_null(), "surface.source", "is for LEAFLESS_RESOLVE_SOURCE only")?;
        Ok(match resolve {
            LEAFLESS_RESOLVE_INNER => Some(Resolve::Inner),
            LEAFLESS_RESOLVE_OUTER => Some(Resolve::Outer),
            _ => None,
        })
    }
}

/// Extracts the surface of an octree: a closed mesh between the centres of finest cells that lie inside and
/// those that lie outside. The space around the universe counts as outside, so that the mesh is closed there,
/// too.
///
/// Every edge is used as often in one direction as in the other, except for
/// LEAFLESS_SURFACE_METHOD_SHRINK_PUBLISHED. Triangles turn counter-clockwise as seen from outside; no two
/// vertices are equal, and no triangle has a vertex twice. The order of vertices and triangles is always the
/// same: the Morton order of the cells, or, for coplanar shrink, the order of positions and planes.
/// leafless_mesh_describe and leafless_mesh_copy return the arrays, leafless_mesh_inspect and
/// leafless_mesh_area analyse them, leafless_mesh_intersecting_pairs finds triangles that intersect, and
/// leafless_mesh_write writes them.
///
/// Time is linear in the octree's array elements and the mesh: it grows with the surface, not with the
/// volume. (Coplanar shrink takes O(n log n + n w) for n cells at the surface, with at most w of them along a
/// line in a plane region.) In addition to the mesh, memory is 56 bytes (simple marching cubes: up to 128)
/// for each block of 4³ cells at the surface, and for coplanar shrink up to 200 bytes for each cell at a
/// curved surface.
///
/// - Buffers: `surface`, one struct or NULL; `options`, one struct or NULL (`max_nodes` and `max_bytes` apply
///   to LEAFLESS_RESOLVE_SOURCE only); `mesh`, one pointer.
/// - Result: `*mesh`, identical for any number of threads; it has no triangles if no sample is inside.
/// - Errors: LEAFLESS_E_ARGUMENT if the octree has PARTIAL cells and `resolve` is LEAFLESS_RESOLVE_NONE, if a
///   field of `surface` is not a member of its enumeration, or is set though the method does not use it, or
///   if the frame is so far from the origin that doubles cannot distinguish its cells; LEAFLESS_E_NULL if
///   LEAFLESS_RESOLVE_SOURCE has no `source`; LEAFLESS_E_MESH if there would be more than 2^32 - 1 vertices
///   or triangles; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY; and those of
///   leafless_octree_build for the source.
/// - Ownership: `octree` is unchanged; release `*mesh` with leafless_mesh_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octree; damage is LEAFLESS_E_DAMAGED or another surface.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_surface(
    octree: *const leafless_octree,
    surface: *const leafless_surface_options,
    options: *const leafless_options,
    mesh: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe {
        let octree = shared(octree, "octree")?.octree.view();
        let surface = sized(surface, "surface")?;
        let (method, resolve) = (surface.method()?, surface.resolve()?);
        let problem = "octrees do not know where their solid's surface is: extract that of the solid";
        zero(
            surface.placement.known("surface.placement")? == VertexPlacement::Midpoint,
            "surface.placement",
            problem,
        )?;
        let problem = "is dual contouring, which needs normals: extract the surface of the solid";
        zero(!matches!(method, Method::DualContouring), "surface.method", problem)?;
        let mesh = out(mesh, "mesh")?;
        mesh.write(give(controlled(options, |control| match method {
            Method::MarchingCubes | Method::DualContouring => marching_cubes(octree, resolve, control),
            Method::SurfaceNets => surface_nets(octree, resolve, control),
            Method::Smc(snap) => simple_marching_cubes(octree, snap, resolve, control),
            Method::Shrink(snap) => coplanar_shrink(octree, snap, resolve, control),
            Method::PublishedShrink(snap) => published_shrink(octree, snap, resolve, control),
        })?))
    })
}

/// Extracts the surface of a solid, sampled at the corners of the cells of a frame: 2^depth + 1 on each axis.
/// Dual contouring samples at the centres. Otherwise as leafless_octree_surface. Parts of the solid outside
/// the universe are cut off.
///
/// Time is that of leafless_octree_build with LEAFLESS_RULE_SAMPLED on as many cells as there are corners,
/// and for LEAFLESS_VERTEX_PLACEMENT_CROSSING a few more queries of the solid for each vertex; memory as
/// well. With crossings, vertices at equal positions are merged, and triangles without area are dropped.
/// Where the solid has no thickness at a sample, more than two triangles may then meet at an edge.
///
/// - Buffers: `frame`, one struct; `surface`, one struct or NULL, whose `resolve` and `source` are 0;
///   `options`, one struct or NULL; `mesh`, one pointer.
/// - Result: `*mesh`, identical for any number of threads; it has no triangles if no sample is inside.
/// - Errors: LEAFLESS_E_ARGUMENT if the depth is 20, which leaves no level for corners, if a field of
///   `surface` is not a member of its enumeration, or is set though it is not used, or if the frame is so far
///   from the origin that doubles cannot distinguish its corners; LEAFLESS_E_NOT_SAMPLED if the solid cannot
///   decide points; LEAFLESS_E_FRAME for a solid of leafless_solid_from_octree, which has samples of its own,
///   and for other solids that belong to another frame; LEAFLESS_E_MESH if there would be more than 2^32 - 1
///   vertices or triangles; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*mesh` with leafless_mesh_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid; set `max_bytes` if the depth or the solid is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_surface(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    surface: *const leafless_surface_options,
    options: *const leafless_options,
    mesh: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe {
        // The corners lie on a frame of their own, so no preparation is kept for the solid.
        let solid = shared(solid, "solid")?.solid.solid();
        let frame = self::frame(frame)?;
        let surface = sized(surface, "surface")?;
        let (method, placement) = (surface.method()?, surface.placement.known("surface.placement")?);
        let is_midpoint = placement == VertexPlacement::Midpoint;
        let problem = "is for octrees: a solid decides all samples itself";
        let resolve = surface.resolve.known("surface.resolve")?;
        zero(matches!(resolve, LEAFLESS_RESOLVE_NONE), "surface.resolve", problem)?;
        zero(surface.source.is_null(), "surface.source", problem)?;
        let mesh = out(mesh, "mesh")?;
        if !matches!(method, Method::MarchingCubes) {
            let problem = "is for marching cubes only: other methods place vertices themselves";
            zero(is_midpoint, "surface.placement", problem)?;
        }
        let problem = "is surface nets, which are of octrees: build one, or extract by dual contouring";
        zero(!matches!(method, Method::SurfaceNets), "surface.method", problem)?;
        mesh.write(give(controlled(options, |control| match method {
            Method::MarchingCubes | Method::SurfaceNets => {
                marching_cubes_solid(solid, &frame, placement, control)
            }
            Method::Smc(snap) => simple_marching_cubes_solid(solid, &frame, snap, control),
            Method::Shrink(snap) => coplanar_shrink_solid(solid, &frame, snap, control),
            Method::PublishedShrink(snap) => published_shrink_solid(solid, &frame, snap, control),
            Method::DualContouring => Ok(dual_contouring_solid(solid, &frame, control)?.0),
        })?))
    })
}

/// Extracts the surface of a volume by marching cubes. Its samples are the centres of voxels, which need not
/// be cubes. Its vertices lie where the values, interpolated between two voxels, leave the band. For samples
/// of a smooth function the vertices lie on the surface to second order in the spacing. Between bits, and
/// next to a sample that is infinite or not a number, they lie half-way.
///
/// Otherwise as leafless_octree_surface. Vertices at equal positions are merged; there more than two
/// triangles may meet at an edge. Time is linear in the samples, and in the surface.
///
/// - Buffers: `band`, one struct, or NULL, as for leafless_solid_from_volume; `options`, one struct or NULL
///   (its limits are ignored); `mesh`, one pointer.
/// - Result: `*mesh`, identical for any number of threads, at the position that the volume's file states.
/// - Errors: those of leafless_solid_from_volume; LEAFLESS_E_ARGUMENT if the volume is so far from the origin
///   that doubles cannot distinguish its voxels; LEAFLESS_E_MESH if there would be more than 2^32 - 1
///   vertices or triangles.
/// - Ownership: `volume` is unchanged; release `*mesh` with leafless_mesh_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any volume.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_volume_surface(
    volume: *const leafless_volume,
    band: *const leafless_interval,
    options: *const leafless_options,
    mesh: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe {
        let volume = shared(volume, "volume")?;
        let band = volume.band(band)?;
        let mesh = out(mesh, "mesh")?;
        let surface = controlled(options, |control| {
            let voxels = volume.voxels(band, control)?;
            marching_cubes_volume(&voxels, control)
        })?;
        mesh.write(give(match &volume.placement {
            Some(placement) => surface.placed(placement)?,
            None => surface,
        }))
    })
}
