//! Layers: the contents of pictures.

use super::attribute::{AnyAttribute, components, leafless_attribute};
use super::boundary::{Failure, Sized32, guard, handle, out, refer, release, shared, sized, slice};
use super::number::{Number, enumeration};
use super::status::leafless_status;
use leafless::Bounds;
use leafless::attribute::Attribute;
use leafless::render::{Clip, ClippedLayer, ColourMap, Layer, Transfer};
use std::sync::Arc;

/// A layer of a picture: the surface of an octree, a solid or a mesh, lines, a plane section, or voxels.
///
/// A layer shares or copies the objects that it shows, so these may be freed. It is independent of cameras,
/// and may be part of any number of pictures.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_layer_free releases.
pub struct leafless_layer {
    shape: Arc<dyn Shown>,
    clip: Option<Clip>,
}

/// The content of a layer's handle.
pub(super) trait Shown: Send + Sync {
    /// Returns the layer that shows the content.
    fn layer(&self) -> Result<Box<dyn Layer + '_>, Failure>;

    /// Returns the approximate number of bytes that the content keeps alive.
    fn kept_bytes(&self) -> u64;
}

/// Returns a handle of a layer.
pub(super) fn give(shape: impl Shown + 'static) -> *mut leafless_layer {
    handle(leafless_layer { shape: Arc::new(shape), clip: None })
}

impl leafless_layer {
    pub(super) fn layer(&self) -> Result<Box<dyn Layer + '_>, Failure> {
        self.shape.layer()
    }

    /// Returns `layer` within this handle's own clip, if it has one.
    pub(super) fn clipped<'a>(&self, layer: &'a dyn Layer) -> Option<ClippedLayer<'a>> {
        self.clip.clone().map(|clip| ClippedLayer::new(layer, clip))
    }
}

/// Colour maps. Equal steps of a value look like equal steps of colour.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_colour_map {
    /// From dark violet through green to yellow.
    LEAFLESS_COLOUR_MAP_VIRIDIS = 0,
    /// From dark blue to yellow; it looks the same to colour-blind people.
    LEAFLESS_COLOUR_MAP_CIVIDIS = 1,
    /// From black through red to light yellow.
    LEAFLESS_COLOUR_MAP_INFERNO = 2,
    /// From black through purple to near white.
    LEAFLESS_COLOUR_MAP_MAGMA = 3,
    /// From dark blue through red to yellow.
    LEAFLESS_COLOUR_MAP_PLASMA = 4,
    /// From black to white.
    LEAFLESS_COLOUR_MAP_GREY = 5,
}

enumeration! {
    leafless_colour_map => ColourMap {
        LEAFLESS_COLOUR_MAP_VIRIDIS => ColourMap::Viridis,
        LEAFLESS_COLOUR_MAP_CIVIDIS => ColourMap::Cividis,
        LEAFLESS_COLOUR_MAP_INFERNO => ColourMap::Inferno,
        LEAFLESS_COLOUR_MAP_MAGMA => ColourMap::Magma,
        LEAFLESS_COLOUR_MAP_PLASMA => ColourMap::Plasma,
        LEAFLESS_COLOUR_MAP_GREY => ColourMap::Grey,
    }
}

/// A transfer function: the colours of values. A value of one number has the colour of a map over a range. A
/// value of three or four numbers is a colour itself: red, green and blue in sRGB, 0 to 255, and, for
/// volumes, an opacity, 0 to 255, that scales `alpha_upper`. For a value of two numbers the first is used.
/// Without a value the colour is grey.
///
/// The range must be set, and for volumes the opacity. Zero is the default of all other fields but the first.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_transfer {
    /// sizeof(leafless_transfer).
    pub struct_size: u32,
    /// A leafless_colour_map.
    pub map: Number<leafless_colour_map>,
    /// The value at the start of the map.
    pub range_lower: f64,
    /// The value at the end of the map; greater than `range_lower`.
    pub range_upper: f64,
    /// For volumes: the opacity, 0 to 1, of a path of `length_model` through the value `range_lower`. It
    /// changes linearly over the range.
    pub alpha_lower: f64,
    /// For volumes: the opacity for `range_upper`, for values that are colours, and for voxels without a
    /// value.
    pub alpha_upper: f64,
    /// The path length of the opacities, in model units: a medium of opacity a transmits (1 - a)^(s /
    /// length_model) of the light over a path s. 0 means 1.
    pub length_model: f64,
}

// SAFETY: numbers.
unsafe impl Sized32 for leafless_transfer {}

impl leafless_transfer {
    pub(super) fn check(&self) -> Result<Transfer, Failure> {
        let map = self.map.known("transfer.map")?;
        let length = if self.length_model == 0.0 { 1.0 } else { self.length_model };
        let range = [self.range_lower, self.range_upper];
        Ok(Transfer::new(map, range, self.alpha_upper, length)?.ramp([self.alpha_lower, self.alpha_upper])?)
    }
}

/// Returns the colour of a value under a transfer function, as surfaces show it in full light, for a legend
/// of the host's own.
///
/// - Buffers: `transfer`, one struct; `value`, `components` numbers; `colour`, 4 bytes.
/// - Result: `colour`: red, green and blue (sRGB), and 255. Grey if a number is NaN.
/// - Errors: LEAFLESS_E_ARGUMENT if the transfer function is invalid, or `components` not 1 to 4.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[colour; 4]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_transfer_colour(
    transfer: *const leafless_transfer,
    value: *const f64,
    components: u32,
    colour: *mut u8,
) -> leafless_status {
    guard(|| unsafe {
        shared(transfer, "transfer")?;
        let transfer = sized(transfer, "transfer")?.check()?;
        let components = self::components(components, "components")?;
        let value = slice(value, components as u64, "value")?;
        let colour = out(colour.cast::<[u8; 4]>(), "colour")?;
        let [r, g, b] = transfer.colour(value);
        colour.write([r, g, b, 255])
    })
}

/// Returns the bytes that the values of a layer keep alive, if it has values.
pub(super) fn bytes_of_values(values: &Option<Values>) -> u64 {
    values.as_ref().map_or(0, |values| values.attribute.kept_bytes())
}

/// An attribute, and the colours of its values on surfaces.
pub(super) struct Values {
    pub(super) attribute: AnyAttribute,
    pub(super) colour: Box<dyn Fn(Option<[f64; 4]>) -> [u8; 4] + Send + Sync>,
}

/// Returns the attribute and the transfer function of a layer, which has both or neither.
///
/// # Safety
/// `attribute` is NULL or a handle that is alive; `transfer` is NULL or a valid struct.
pub(super) unsafe fn values(
    attribute: *const leafless_attribute,
    transfer: *const leafless_transfer,
    names: [&'static str; 2],
) -> Result<Option<Values>, Failure> {
    if attribute.is_null() {
        return match transfer.is_null() {
            true => Ok(None),
            false => {
                Err(Failure::Argument { name: names[1], problem: "is for layers with an attribute only" })
            }
        };
    }
    if transfer.is_null() {
        return Err(Failure::Null { name: names[1] });
    }
    // SAFETY: the caller's promise.
    let (attribute, transfer) =
        unsafe { (shared(attribute, names[0])?.attribute.clone(), sized(transfer, names[1])?.check()?) };
    let components = attribute.components();
    Ok(Some(Values { attribute, colour: Box::new(move |value| transfer.opaque(value, components)) }))
}

/// Returns a chosen colour; all bytes zero stand for the default.
pub(super) fn chosen(colour: [u8; 4]) -> Option<[u8; 4]> {
    (colour != [0; 4]).then_some(colour)
}

/// Returns the clip: the points in the box, if there is one, with a x + b y + c z + d ≥ 0 for all planes.
///
/// # Safety
/// As [`slice`] for 4 · `count` numbers, and for 6 unless the box is NULL.
pub(super) unsafe fn clip(
    start: Clip,
    planes: *const f64,
    count: u64,
    box_model: *const f64,
    names: [&'static str; 2],
) -> Result<Clip, Failure> {
    // SAFETY: the caller's promise.
    let (planes, corners) = unsafe {
        let planes: &[[f64; 4]] = slice(planes.cast(), count, names[0])?;
        let corners: &[[f64; 3]] =
            slice(box_model.cast(), if box_model.is_null() { 0 } else { 2 }, names[1])?;
        (planes, corners)
    };
    let mut clip = start;
    for &plane in planes {
        clip = clip.plane(plane)?;
    }
    if let &[min, max] = corners {
        let none = Failure::Argument { name: names[1], problem: "must be finite, the least corner first" };
        clip = clip.within(&Bounds::new(min, max).ok_or(none)?)?;
    }
    Ok(clip)
}

/// Returns a layer clipped by planes and a box of its own, which replace those of the picture: for instance,
/// a surface that is cut away to show the voxels behind it. A layer that is clipped already is clipped by all
/// of them.
///
/// - Buffers: `planes`, 4 · `plane_count` numbers: a, b, c and d of each plane, which keeps the points with a
///   x + b y + c z + d ≥ 0; `box_model`, 6 numbers, the least and the greatest corner of the box, or NULL for
///   none; `clipped`, one pointer.
/// - Result: `*clipped`.
/// - Errors: LEAFLESS_E_ARGUMENT if a number is neither 0 nor of a magnitude between 2^-256 and 2^256, a, b
///   and c are zero, or the box has min > max on an axis; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the layer is shared and may be freed; release `*clipped` with leafless_layer_free.
/// - Untrusted input: any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layer_clipped(
    layer: *const leafless_layer,
    planes: *const f64,
    plane_count: u64,
    box_model: *const f64,
    clipped: *mut *mut leafless_layer,
) -> leafless_status {
    guard(|| unsafe {
        let layer = shared(layer, "layer")?;
        let start = layer.clip.clone().unwrap_or_default();
        let clip = clip(start, planes, plane_count, box_model, ["planes", "box_model"])?;
        let clipped = out(clipped, "clipped")?;
        clipped.write(handle(leafless_layer { shape: layer.shape.clone(), clip: Some(clip) }))
    })
}

/// Returns the approximate number of bytes of memory (or of mapped files) that a layer keeps alive: its own,
/// and those of the octree, solid, mesh and attribute that it shows, as in leafless_octree_describe,
/// leafless_solid_describe and so on. Memory for rendering a picture is not included.
///
/// - Buffers: `bytes`, one number.
/// - Result: `*bytes`.
/// - Untrusted input: any layer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layer_bytes(
    layer: *const leafless_layer,
    bytes: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let layer = shared(layer, "layer")?;
        out(bytes, "bytes")?.write(layer.shape.kept_bytes())
    })
}

/// Returns one more reference to a layer.
///
/// - Buffers: `layer`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `layer`.
/// - Ownership: release each reference with leafless_layer_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layer_ref(
    layer: *const leafless_layer,
    reference: *mut *mut leafless_layer,
) -> leafless_status {
    guard(|| unsafe { refer(layer, "layer", reference) })
}

/// Releases a reference to a layer; the last release frees the layer. Objects that it shows stay if other
/// references exist.
///
/// - Buffers: `layer`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layer_free(layer: *mut leafless_layer) {
    // SAFETY: the caller's promise.
    unsafe { release(layer) }
}
