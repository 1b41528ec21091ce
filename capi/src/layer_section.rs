//! Layers of the inside: plane sections, and voxels as a translucent volume.

use super::attribute::leafless_attribute;
use super::boundary::{Failure, Sized32, array, buffer, guard, out, share, shared, sized, slice};
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame};
use super::layer::{Shown, Values, bytes_of_values, chosen, give, leafless_layer, leafless_transfer, values};
use super::number::Byte;
use super::octree::leafless_octree;
use super::solid::leafless_solid;
use super::status::leafless_status;
use super::voxel::{leafless_voxel_kind, records};
use leafless::memory;
use leafless::render::{Compositing, Layer, SliceLayer, SlicePlane, TAG_COLOURS, Transfer, VolumeLayer};
use leafless::voxel::VoxelRecords;
use leafless::{Frame, Solid};
use std::sync::Arc;

/// The appearance of a plane section. NULL means the defaults. Zero is the default of every field but the
/// first. Colours are red, green and blue (sRGB) and opacity, 0 to 255; {255, 255, 255, 0} makes a part
/// invisible.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_slice_look {
    /// sizeof(leafless_slice_look).
    pub struct_size: u32,
    /// 1 to draw no outlines of cells; else 0.
    pub is_plain: u32,
    /// The colour of EMPTY cells; all zero means sky blue, hardly visible.
    pub empty_colour: [u8; 4],
    /// The colour of FULL cells; all zero means blue.
    pub full_colour: [u8; 4],
    /// The colour of PARTIAL cells; all zero means orange.
    pub partial_colour: [u8; 4],
    /// The colour of outlines; all zero means dark grey.
    pub outline_colour: [u8; 4],
    /// The attribute whose values, such as those of a channel, are shown where cells are not EMPTY; optional.
    pub attribute: *const leafless_attribute,
    /// With an attribute: the colours of its values.
    pub transfer: *const leafless_transfer,
}

// SAFETY: numbers and pointers.
unsafe impl Sized32 for leafless_slice_look {}

struct OfSlice {
    cut: Cut,
    plane: SlicePlane,
    colours: [[u8; 4]; 3],
    outlines: Option<[u8; 4]>,
    values: Option<Values>,
}

/// The object that is cut.
enum Cut {
    Octree(Arc<leafless_octree>),
    Solid(Arc<leafless_solid>, Frame),
}

impl Shown for OfSlice {
    fn kept_bytes(&self) -> u64 {
        let cut = match &self.cut {
            Cut::Octree(octree) => octree.octree.bytes(),
            Cut::Solid(solid, _) => solid.solid.kept_bytes(),
        };
        cut + bytes_of_values(&self.values)
    }

    fn layer(&self) -> Result<Box<dyn Layer + '_>, Failure> {
        let slice = match &self.cut {
            Cut::Octree(octree) => SliceLayer::new(octree.octree.view(), self.plane),
            Cut::Solid(solid, frame) => SliceLayer::of_solid(&solid.solid, frame, self.plane),
        };
        let slice = slice.colours(self.colours).outlines(self.outlines);
        Ok(match &self.values {
            Some(values) => Box::new(slice.values(&values.attribute, &values.colour)),
            None => Box::new(slice),
        })
    }
}

/// # Safety
/// As for the functions below.
unsafe fn section(
    cut: Cut,
    plane: *const f64,
    look: *const leafless_slice_look,
    layer: *mut *mut leafless_layer,
) -> Result<(), Failure> {
    // SAFETY: the caller's promise.
    unsafe {
        let [a, b, c, d] = array(plane, "plane")?;
        let plane = SlicePlane::new([a, b, c], d)?;
        let look = sized(look, "look")?;
        if look.is_plain > 1 {
            return Err(Failure::Argument { name: "look.is_plain", problem: "must be 0 or 1" });
        }
        let values = values(look.attribute, look.transfer, ["look.attribute", "look.transfer"])?;
        let given = [look.empty_colour, look.full_colour, look.partial_colour];
        let colours = [0, 1, 2].map(|tag| chosen(given[tag]).unwrap_or(TAG_COLOURS[tag]));
        let outlines = (look.is_plain == 0).then(|| chosen(look.outline_colour).unwrap_or([40, 40, 40, 255]));
        out(layer, "layer")?.write(give(OfSlice { cut, plane, colours, outlines, values }))
    }
}

/// Makes a layer of a plane section of an octree, in the colours of its cells' tags or of an attribute's
/// values, with the outlines of the cells.
///
/// - Buffers: `plane`, 4 numbers a, b, c and d: the plane of the points with a x + b y + c z + d = 0; `look`,
///   one struct or NULL; `layer`, one pointer.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_ARGUMENT if a number is neither 0 nor of a magnitude between 2^-256 and 2^256, a, b
///   and c are zero, or the look is invalid.
/// - Ownership: the layer shares the octree and the attribute, which may be freed; release `*layer` with
///   leafless_layer_free.
/// - Untrusted input: any octree, any numbers.
///
/// cbindgen:ptrs-as-arrays=[[plane; 4]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layer_from_octree_slice(
    octree: *const leafless_octree,
    plane: *const f64,
    look: *const leafless_slice_look,
    layer: *mut *mut leafless_layer,
) -> leafless_status {
    guard(|| unsafe { section(Cut::Octree(share(octree, "octree")?), plane, look, layer) })
}

/// Makes a layer of a plane section of a solid on a frame. Cells at the plane are split down to the frame's
/// depth.
///
/// - Buffers: `frame`, one struct; the others as leafless_layer_from_octree_slice.
/// - Result: `*layer`.
/// - Errors: as leafless_layer_from_octree_slice; LEAFLESS_E_ARGUMENT as leafless_frame_check. Taking a
///   picture also returns the errors of leafless_octree_build.
/// - Ownership: the layer shares the solid and the attribute, which may be freed; release `*layer` with
///   leafless_layer_free.
/// - Untrusted input: any solid, any numbers.
///
/// cbindgen:ptrs-as-arrays=[[plane; 4]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layer_from_solid_slice(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    plane: *const f64,
    look: *const leafless_slice_look,
    layer: *mut *mut leafless_layer,
) -> leafless_status {
    guard(|| unsafe {
        let solid = share(solid, "solid")?;
        section(Cut::Solid(solid, self::frame(frame)?), plane, look, layer)
    })
}

/// Computes the solid fraction of each voxel, 0 to 1, for use as the weights of voxels in a picture. Inside
/// voxels have 1, outside and refined voxels 0. For a boundary voxel it is the fraction from the solid's own
/// volume there, or the middle of the bounds from its slabs; 1/2 if the solid provides neither.
///
/// - Buffers: `lattice`, `codes`, `levels` and `kinds` as leafless_voxels_find; `options`, one struct or
///   NULL; `parts`, room for `count` numbers.
/// - Result: `parts`. O(count · levels).
/// - Errors: LEAFLESS_E_ARGUMENT if the arrays are not valid records; the errors of the solid;
///   LEAFLESS_E_NO_MEMORY; LEAFLESS_E_CANCELLED.
/// - Untrusted input: any numbers, any solid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_voxels_solid_parts(
    lattice: *const leafless_frame,
    codes: *const u64,
    levels: *const u8,
    kinds: *const Byte<leafless_voxel_kind>,
    count: u64,
    solid: *const leafless_solid,
    options: *const leafless_options,
    parts: *mut f64,
) -> leafless_status {
    guard(|| unsafe {
        let records = records(&super::frame::frame_of(lattice, "lattice")?, codes, levels, kinds, count)?;
        let solid = &shared(solid, "solid")?.solid;
        out(parts, "parts")?;
        let parts = buffer(parts, count, "parts")?;
        parts.fill(&controlled(options, |control| records.solid_parts(solid, control))?)
    })
}

/// Voxels in arrays, as written by leafless_octree_voxels: record i is `codes[i]`, `levels[i]`, `kinds[i]`.
/// All fields must be set, except where a comment allows 0 or NULL.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_voxel_arrays {
    /// sizeof(leafless_voxel_arrays).
    pub struct_size: u32,
    /// Numbers per value, 1 to 4; 0 without values.
    pub components: u32,
    /// The lattice that codes belong to.
    pub lattice: leafless_frame,
    /// Number of voxels.
    pub count: u64,
    /// Linear octree codes, ascending.
    pub codes: *const u64,
    /// Levels of the voxels.
    pub levels: *const u8,
    /// A leafless_voxel_kind for each voxel. Inside and boundary voxels are visible.
    pub kinds: *const Byte<leafless_voxel_kind>,
    /// `components` · `count` numbers, NaN where there is no value; NULL without values.
    pub values: *const f64,
    /// The solid fraction of each voxel, 0 to 1, as written by leafless_voxels_solid_parts; NULL means 1
    /// inside and 1/2 at the boundary.
    pub weights: *const f64,
}

// SAFETY: numbers and pointers.
unsafe impl Sized32 for leafless_voxel_arrays {}

struct OfVoxels {
    records: VoxelRecords,
    weights: Option<Vec<f64>>,
    transfer: Transfer,
    compositing: Compositing,
}

impl Shown for OfVoxels {
    fn kept_bytes(&self) -> u64 {
        self.records.bytes() + self.weights.as_ref().map_or(0, |weights| size_of_val(&**weights) as u64)
    }

    fn layer(&self) -> Result<Box<dyn Layer + '_>, Failure> {
        let layer = VolumeLayer::new(self.records.view(), self.transfer).compositing(self.compositing)?;
        Ok(match &self.weights {
            Some(weights) => Box::new(layer.weights(weights)?),
            None => Box::new(layer),
        })
    }
}

/// Makes a layer of voxels as a translucent volume, composited in the correct order from every viewpoint.
/// Surfaces of other layers hide voxels, and are visible through them. If a picture has two such layers, the
/// first one counts as in front.
///
/// - Buffers: `voxels`, one struct; `transfer`, one struct: the colours of values; `layer`, one pointer. If
///   `unit_model` is 0, voxels are composited by the exact length of each line of sight in a voxel. Otherwise
///   the published method (Zhu, Tang and Dong 2002) is used: a voxel is a cell of the edge `unit_model`,
///   repeated once for each such length in its own edge, and the transfer function's opacity applies to one
///   repetition.
/// - Result: `*layer`.
/// - Errors: LEAFLESS_E_ARGUMENT if the arrays are not valid records, a weight is not 0 to 1, the transfer
///   function is invalid, or the unit is below 0 or not finite; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the layer copies the arrays; release `*layer` with leafless_layer_free.
/// - Untrusted input: any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layer_new_voxels(
    voxels: *const leafless_voxel_arrays,
    transfer: *const leafless_transfer,
    unit_model: f64,
    layer: *mut *mut leafless_layer,
) -> leafless_status {
    guard(|| unsafe {
        shared(voxels, "voxels")?;
        shared(transfer, "transfer")?;
        let (voxels, transfer) = (sized(voxels, "voxels")?, sized(transfer, "transfer")?.check()?);
        let layer = out(layer, "layer")?;
        let frame = self::frame(&voxels.lattice)?;
        let numbers = voxels.count.saturating_mul(u64::from(voxels.components));
        let weights =
            slice(voxels.weights, if voxels.weights.is_null() { 0 } else { voxels.count }, "voxels.weights")?;
        let records = VoxelRecords::from_arrays(
            &frame,
            memory::copied(slice(voxels.codes, voxels.count, "voxels.codes")?)?,
            memory::copied(slice(voxels.levels, voxels.count, "voxels.levels")?)?,
            memory::copied(slice(voxels.kinds.cast(), voxels.count, "voxels.kinds")?)?,
            voxels.components as usize,
            memory::copied(slice(voxels.values, numbers, "voxels.values")?)?,
        )?;
        let weights = if voxels.weights.is_null() { None } else { Some(memory::copied(weights)?) };
        let compositing =
            if unit_model == 0.0 { Compositing::Exact } else { Compositing::Published { unit: unit_model } };
        let shown = OfVoxels { records, weights, transfer, compositing };
        // Errors are reported now, not when a picture is taken.
        shown.layer()?;
        layer.write(give(shown))
    })
}
