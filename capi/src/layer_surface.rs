//! Layers of surfaces of octrees, solids and meshes, and of lines.

use super::attribute::leafless_attribute;
use super::boundary::{Failure, Sized32, guard, out, share, shared, sized, slice};
use super::cells::leafless_cell;
use super::frame::{frame, leafless_frame};
use super::layer::{Shown, Values, bytes_of_values, chosen, give, leafless_layer, leafless_transfer, values};
use super::mesh::leafless_mesh;
use super::number::{Number, enumeration};
use super::octree::leafless_octree;
use super::solid::leafless_solid;
use super::status::leafless_status;
use core::mem::MaybeUninit;
use leafless::TriangleMesh;
use leafless::memory;
use leafless::render::{Finish, Layer, LinesLayer, MeshEdges, MeshLayer, OctreeLayer, Outline, SolidLayer};
use leafless::{Cell, Frame, Solid};
use std::sync::Arc;

/// The edges that are drawn as lines.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_edges {
    /// None.
    LEAFLESS_EDGES_NONE = 0,
    /// For meshes, open edges and edges whose triangles meet at more than the crease angle. For octrees and
    /// solids, silhouettes and edges whose faces meet at more than that angle.
    LEAFLESS_EDGES_FEATURES = 1,
    /// The edges of all triangles of a mesh.
    LEAFLESS_EDGES_ALL = 2,
}

enumeration! {
    leafless_edges => MeshEdges {
        LEAFLESS_EDGES_NONE => MeshEdges::None,
        LEAFLESS_EDGES_FEATURES => MeshEdges::Features,
        LEAFLESS_EDGES_ALL => MeshEdges::All,
    }
}

/// The appearance of a surface. NULL means the defaults. Zero is the default of every field but the first. A
/// field that a layer does not use must be zero. Colours are red, green and blue (sRGB) and opacity, 0
/// to 255.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_look {
    /// sizeof(leafless_look).
    pub struct_size: u32,
    /// For octrees: 1 to show the faces of cells instead of the surface that they represent; else 0.
    pub faces: u32,
    /// The colour in full light; all zero means light grey.
    pub colour: [u8; 4],
    /// The colour of parts that clip planes cut open, and of a mesh's faces seen from behind. All zero means
    /// orange, or, for a mesh, the face's own colour mixed with orange.
    pub inside: [u8; 4],
    /// A leafless_edges.
    pub edges: Number<leafless_edges>,
    /// The colour of edges; all zero means dark grey.
    pub edge_colour: [u8; 4],
    /// The width of edges in pixels, at most 256, or 8 for octrees and solids; 0 means 1, or 1.5 for octrees
    /// and solids.
    pub edge_width: f64,
    /// The angle in degrees, at most 180, above which faces meet at an edge, and up to which neighbouring
    /// triangles of a mesh look smooth; 0 means 30.
    pub crease_degrees: f64,
    /// For meshes: 4 · `triangle_count` bytes, a colour for each triangle; NULL means that all have `colour`.
    pub triangle_colours: *const u8,
    /// Number of colours of triangles.
    pub triangle_count: u64,
    /// For octrees and solids: the attribute whose values, such as those of a channel, are shown, taken half
    /// a finest cell below the surface, or half a pixel for solids; optional.
    pub attribute: *const leafless_attribute,
    /// With an attribute: the colours of its values.
    pub transfer: *const leafless_transfer,
}

// SAFETY: numbers and pointers.
unsafe impl Sized32 for leafless_look {}

/// Returns a chosen width or angle; 0 stands for the default.
fn chosen_length(length: f64) -> Option<f64> {
    (length != 0.0).then_some(length)
}

fn unused(is_unused: bool, name: &'static str, problem: &'static str) -> Result<(), Failure> {
    if is_unused { Ok(()) } else { Err(Failure::Argument { name, problem }) }
}

impl leafless_look {
    /// Returns the finish of objects made of cells.
    fn finish(&self) -> Result<Finish, Failure> {
        unused(self.triangle_colours.is_null(), "look.triangle_colours", "is for meshes only")?;
        unused(self.triangle_count == 0, "look.triangle_count", "is for meshes only")?;
        unused(self.faces <= 1, "look.faces", "must be 0 or 1")?;
        let plain = Finish::default();
        let outline = Outline::default();
        let edges = match self.edges.known("look.edges")? {
            MeshEdges::None => None,
            MeshEdges::Features => Some(Outline {
                width: chosen_length(self.edge_width).unwrap_or(outline.width),
                colour: chosen(self.edge_colour).unwrap_or(outline.colour),
                crease: chosen_length(self.crease_degrees).unwrap_or(outline.crease),
            }),
            MeshEdges::All => {
                return Err(Failure::Argument {
                    name: "look.edges",
                    problem: "of all triangles are for meshes",
                });
            }
        };
        edges.map_or(Ok(()), |outline| outline.check())?;
        Ok(Finish {
            colour: chosen(self.colour).unwrap_or(plain.colour),
            cut: chosen(self.inside).unwrap_or(plain.cut),
            faces: self.faces == 1,
            edges,
        })
    }

    /// # Safety
    /// As [`values`].
    unsafe fn values(&self) -> Result<Option<Values>, Failure> {
        // SAFETY: the caller's promise.
        unsafe { values(self.attribute, self.transfer, ["look.attribute", "look.transfer"]) }
    }
}

struct OfOctree {
    octree: Arc<leafless_octree>,
    finish: Finish,
    values: Option<Values>,
}

impl Shown for OfOctree {
    fn kept_bytes(&self) -> u64 {
        self.octree.octree.bytes() + bytes_of_values(&self.values)
    }

    fn layer(&self) -> Result<Box<dyn Layer + '_>, Failure> {
        let layer = OctreeLayer::new(self.octree.octree.view(), self.finish);
        Ok(match &self.values {
            Some(values) => Box::new(layer.values(&values.attribute, &values.colour)),
            None => Box::new(layer),
        })
    }
}

/// Makes a layer of the surface of an octree: along each line of sight the first cell that is not EMPTY. Its
/// normals are estimates of the surface that the cells represent. An octree that keeps surfaces is shown as
/// by leafless_layer_from_solid, unless the look requests faces of cells; these are the octree's own cells,
/// so make smaller cells with leafless_octree_plain first.
///
/// - Buffers: `look`, one struct or NULL; `layer`, one pointer.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_ARGUMENT if the look is invalid. For an octree that keeps surfaces, taking a picture
///   also returns the errors of leafless_octree_build.
/// - Ownership: the layer shares the octree and the attribute, which may be freed; release `*layer` with
///   leafless_layer_free.
/// - Untrusted input: any octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layer_from_octree(
    octree: *const leafless_octree,
    look: *const leafless_look,
    layer: *mut *mut leafless_layer,
) -> leafless_status {
    guard(|| unsafe {
        let octree = share(octree, "octree")?;
        let look = sized(look, "look")?;
        let finish = look.finish()?;
        let values = look.values()?;
        out(layer, "layer")?.write(give(OfOctree { octree, finish, values }))
    })
}

struct OfSolid {
    solid: Arc<leafless_solid>,
    frame: Frame,
    finish: Finish,
    values: Option<Values>,
}

impl Shown for OfSolid {
    fn kept_bytes(&self) -> u64 {
        self.solid.solid.kept_bytes() + bytes_of_values(&self.values)
    }

    fn layer(&self) -> Result<Box<dyn Layer + '_>, Failure> {
        let layer = SolidLayer::new(&self.solid.solid, &self.frame, self.finish);
        Ok(match &self.values {
            Some(values) => Box::new(layer.values(&values.attribute, &values.colour)),
            None => Box::new(layer),
        })
    }
}

/// Makes a layer of the surface of a solid inside a universe. For each picture the solid is split to cells of
/// the size of a pixel, at most 2^11 on an axis. In these cells a line of sight meets the boundary that the
/// solid provides there, with its normals.
///
/// - Buffers: `frame`, one struct (its depth is ignored); `look`, one struct or NULL; `layer`, one pointer.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_ARGUMENT if the look or the frame is invalid; taking a picture also returns the
///   errors of leafless_octree_build.
/// - Ownership: the layer shares the solid and the attribute, which may be freed; release `*layer` with
///   leafless_layer_free.
/// - Untrusted input: any solid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layer_from_solid(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    look: *const leafless_look,
    layer: *mut *mut leafless_layer,
) -> leafless_status {
    guard(|| unsafe {
        let solid = share(solid, "solid")?;
        let frame = self::frame(frame)?;
        let look = sized(look, "look")?;
        unused(look.faces == 0, "look.faces", "is for octrees only")?;
        let finish = look.finish()?;
        let values = look.values()?;
        out(layer, "layer")?.write(give(OfSolid { solid, frame, finish, values }))
    })
}

struct OfMesh {
    mesh: Arc<TriangleMesh>,
    look: MeshLook,
    colours: Option<Vec<[u8; 4]>>,
}

/// The part of a look that applies to meshes.
struct MeshLook {
    colour: Option<[u8; 4]>,
    inside: Option<[u8; 4]>,
    crease: Option<f64>,
    edges: MeshEdges,
    edge_width: f64,
    edge_colour: [u8; 4],
}

impl Shown for OfMesh {
    fn kept_bytes(&self) -> u64 {
        self.mesh.bytes() + self.colours.as_ref().map_or(0, |colours| size_of_val(&**colours) as u64)
    }

    fn layer(&self) -> Result<Box<dyn Layer + '_>, Failure> {
        let look = &self.look;
        let mut layer = MeshLayer::new(&self.mesh).edges(look.edges, look.edge_width, look.edge_colour);
        if let Some(colour) = look.colour {
            layer = layer.colour(colour);
        }
        if let Some(colour) = look.inside {
            layer = layer.inside(colour);
        }
        if let Some(degrees) = look.crease {
            layer = layer.crease(degrees);
        }
        if let Some(colours) = &self.colours {
            layer = layer.triangle_colours(colours);
        }
        Ok(Box::new(layer))
    }
}

/// Makes a layer of the triangles of a mesh.
///
/// - Buffers: `look`, one struct or NULL; `layer`, one pointer.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_ARGUMENT if the look is invalid, or if the number of triangle colours is not that of
///   the triangles; LEAFLESS_E_NO_MEMORY. Taking a picture returns LEAFLESS_E_ARGUMENT if the width or the
///   crease angle is out of range.
/// - Ownership: the layer shares the mesh, which may be freed, and copies the colours; release `*layer` with
///   leafless_layer_free.
/// - Untrusted input: any mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layer_from_mesh(
    mesh: *const leafless_mesh,
    look: *const leafless_look,
    layer: *mut *mut leafless_layer,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = shared(mesh, "mesh")?.mesh.clone();
        let given = sized(look, "look")?;
        unused(given.faces == 0, "look.faces", "is for octrees only")?;
        unused(given.attribute.is_null(), "look.attribute", "is not for meshes")?;
        unused(given.transfer.is_null(), "look.transfer", "is not for meshes")?;
        let look = MeshLook {
            colour: chosen(given.colour),
            inside: chosen(given.inside),
            crease: chosen_length(given.crease_degrees),
            edges: given.edges.known("look.edges")?,
            edge_width: chosen_length(given.edge_width).unwrap_or(1.0),
            edge_colour: chosen(given.edge_colour).unwrap_or(INK),
        };
        let colours: &[[u8; 4]] =
            slice(given.triangle_colours.cast(), given.triangle_count, "look.triangle_colours")?;
        let colours = match given.triangle_colours.is_null() {
            true => None,
            false if colours.len() != mesh.triangles().len() => {
                let problem = "must be the number of triangles";
                return Err(Failure::Argument { name: "look.triangle_count", problem });
            }
            false => Some(memory::copied(colours)?),
        };
        out(layer, "layer")?.write(give(OfMesh { mesh, look, colours }))
    })
}

/// The colour of lines.
const INK: [u8; 4] = [30, 30, 30, 255];

struct OfLines {
    lines: Vec<[[f64; 3]; 2]>,
    width: f64,
    colour: [u8; 4],
}

impl OfLines {
    fn new(lines: Vec<[[f64; 3]; 2]>, width: f64, colour: Option<[u8; 4]>) -> OfLines {
        OfLines { lines, width: chosen_length(width).unwrap_or(1.0), colour: colour.unwrap_or(INK) }
    }
}

impl Shown for OfLines {
    fn kept_bytes(&self) -> u64 {
        size_of_val(&*self.lines) as u64
    }

    fn layer(&self) -> Result<Box<dyn Layer + '_>, Failure> {
        Ok(Box::new(LinesLayer::new(&self.lines).width(self.width).colour(self.colour)))
    }
}

/// # Safety
/// As [`slice`] for 4 bytes, unless it is NULL.
unsafe fn colour_at(colour: *const u8) -> Result<Option<[u8; 4]>, Failure> {
    // SAFETY: the caller's promise.
    let colours: &[[u8; 4]] = unsafe { slice(colour.cast(), u64::from(!colour.is_null()), "colour")? };
    Ok(colours.first().copied().and_then(chosen))
}

/// Makes a layer of lines in space, some pixels wide, with round ends. Surfaces hide lines behind them; a
/// line on a surface is visible.
///
/// - Buffers: `points_model`, 6 · `count` numbers: the ends of each line; `colour`, 4 numbers: red, green,
///   blue (sRGB) and opacity, or NULL for dark grey; `layer`, one pointer. `width` is in pixels, at most 256;
///   0 means 1.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_NO_MEMORY. Taking a picture returns LEAFLESS_E_ARGUMENT if the width is out of range,
///   or a coordinate is neither 0 nor of a magnitude between 2^-256 and 2^256.
/// - Ownership: the layer copies the lines; release `*layer` with leafless_layer_free.
/// - Untrusted input: any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layer_new_lines(
    points_model: *const f64,
    count: u64,
    width: f64,
    colour: *const u8,
    layer: *mut *mut leafless_layer,
) -> leafless_status {
    guard(|| unsafe {
        let lines = slice(points_model.cast(), count, "points_model")?;
        let colour = colour_at(colour)?;
        let layer = out(layer, "layer")?;
        layer.write(give(OfLines::new(memory::copied(lines)?, width, colour)))
    })
}

/// A leafless_cell whose tag the host may have left uninitialised.
#[repr(C)]
struct Untagged {
    cell: [u32; 3],
    level: u32,
    tag: MaybeUninit<u32>,
}

const _: () = assert!(size_of::<Untagged>() == size_of::<leafless_cell>());

/// Makes a layer of the edges of cells as lines. Edges that cells share are drawn once. Cells that are not in
/// the frame are left out. Tags are not read.
///
/// - Buffers: `frame`, one struct; `cells`, `count` structs; `colour`, `width` and `layer` as
///   leafless_layer_new_lines.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check, and as leafless_layer_new_lines;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*layer` with leafless_layer_free.
/// - Untrusted input: any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layer_new_cells(
    frame: *const leafless_frame,
    cells: *const leafless_cell,
    count: u64,
    width: f64,
    colour: *const u8,
    layer: *mut *mut leafless_layer,
) -> leafless_status {
    guard(|| unsafe {
        let frame = self::frame(frame)?;
        let cells: &[Untagged] = slice(cells.cast(), count, "cells")?;
        let colour = colour_at(colour)?;
        let layer = out(layer, "layer")?;
        let cells = cells.iter().filter(|cell| cell.level <= u32::from(frame.depth()));
        let edges =
            LinesLayer::of_cells(&frame, cells.map(|cell| Cell { level: cell.level as u8, at: cell.cell }))?;
        layer.write(give(OfLines::new(memory::copied(edges.lines())?, width, colour)))
    })
}
