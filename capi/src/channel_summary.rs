//! Channels: summaries, regions of a band of values, materials; volumes as attributes.

use super::attribute::{give as give_attribute, leafless_attribute};
use super::boundary::{array, buffer, filled, guard, out, output, shared, slice};
use super::channel::leafless_channel;
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame, leafless_interval};
use super::measure::leafless_measures;
use super::number::{Number, enumeration};
use super::octree::{give as give_octree, leafless_octree};
use super::solid::leafless_solid;
use super::status::leafless_status;
use super::volume::leafless_volume;
use leafless::Tolerance;
use leafless::attribute::{
    ChannelSummary, Interpolation, MaterialProperties, MovedAttribute, VolumeAttribute, materials,
};
use leafless::solid::Band;
use leafless::{Bounds, Interval};

/// The interpolation between the samples of a volume.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_interpolation {
    /// The trilinear interpolation of the eight samples around a point.
    LEAFLESS_INTERPOLATION_TRILINEAR = 0,
    /// The sample of the voxel that contains the point; on a face between voxels, the sample of the upper
    /// voxel.
    LEAFLESS_INTERPOLATION_NEAREST = 1,
}

enumeration! {
    leafless_interpolation => Interpolation {
        LEAFLESS_INTERPOLATION_TRILINEAR => Interpolation::Trilinear,
        LEAFLESS_INTERPOLATION_NEAREST => Interpolation::Nearest,
    }
}

/// A summary of a channel's values in a region, number by number; entries beyond the numbers of a value
/// are 0. All intervals contain the truth, as far as the cells of the solid and of the channel represent it.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_channel_summary {
    /// sizeof(leafless_channel_summary).
    pub struct_size: u32,
    /// The least value of any cell that may belong to the region.
    pub least: [f64; 4],
    /// The greatest value of any cell that may belong to the region.
    pub greatest: [f64; 4],
    /// The integral of the value over the region, in the value's units times cubic model units: for a
    /// density, the mass.
    pub integral: [leafless_interval; 4],
    /// The mean value.
    pub mean: [leafless_interval; 4],
    /// The volume of the region that has values, in cubic model units.
    pub volume_model: leafless_interval,
    /// The volume of the region without values, in cubic model units.
    pub volume_without_model: leafless_interval,
    /// Whether a part of the region may have a value. If not, all other fields are 0.
    pub has_values: bool,
}

output!(leafless_channel_summary);

impl From<Option<ChannelSummary>> for leafless_channel_summary {
    fn from(found: Option<ChannelSummary>) -> leafless_channel_summary {
        let zero = Interval::exactly(0.0);
        let summary = found.unwrap_or(ChannelSummary {
            least: [0.0; 4],
            greatest: [0.0; 4],
            volume: zero,
            integral: [zero; 4],
            mean: [zero; 4],
            volume_without: zero,
        });
        leafless_channel_summary {
            struct_size: size_of::<leafless_channel_summary>() as u32,
            least: summary.least,
            greatest: summary.greatest,
            integral: summary.integral.map(Into::into),
            mean: summary.mean.map(Into::into),
            volume_model: summary.volume.into(),
            volume_without_model: summary.volume_without.into(),
            has_values: found.is_some(),
        }
    }
}

/// Volume, centroid and inertia of the part of a solid that has one value.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_material {
    /// The value; entries beyond its numbers are 0.
    pub value: [f64; 4],
    /// Measures of the part of the solid that has the value, for density 1.
    pub measures: leafless_measures,
}

impl From<&MaterialProperties> for leafless_material {
    fn from(found: &MaterialProperties) -> leafless_material {
        leafless_material { value: found.value, measures: found.properties.into() }
    }
}

/// Computes least, greatest, mean and integral of a channel's values in the part of a solid that lies in a
/// box at any position. O(cells that the box meets).
///
/// - Buffers: `solid`, a handle, or NULL for all space; `min_model` and `max_model`, 3 numbers each, which
///   may be infinite, or both NULL for all of the channel's cube; `options`, one struct or NULL (its limits
///   are ignored); `summary`, one struct.
/// - Result: `*summary`.
/// - Errors: LEAFLESS_E_ARGUMENT if a coordinate is not a number, or min > max; LEAFLESS_E_FRAME if the solid
///   lies in another cube; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED.
/// - Untrusted input: any channel, any octree, any numbers.
///
/// cbindgen:ptrs-as-arrays=[[min_model; 3], [max_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_channel_summarise(
    channel: *const leafless_channel,
    solid: *const leafless_octree,
    min_model: *const f64,
    max_model: *const f64,
    options: *const leafless_options,
    summary: *mut leafless_channel_summary,
) -> leafless_status {
    guard(|| unsafe {
        let channel = &shared(channel, "channel")?.channel;
        let solid = match solid.is_null() {
            true => None,
            false => Some(shared(solid, "solid")?.octree.view()),
        };
        let bounds = match min_model.is_null() && max_model.is_null() {
            true => None,
            false => {
                Some(Bounds { min: array(min_model, "min_model")?, max: array(max_model, "max_model")? })
            }
        };
        let summary = filled(summary, "summary")?;
        let view = channel.view()?;
        summary.write(controlled(options, |control| view.summary(solid, bounds.as_ref(), control))?.into())
    })
}

/// Makes the octree of the cells whose values lie in a band: every number between those of `low` and `high`,
/// both included. Cells without a value are EMPTY. The octree lies on the channel's frame, and no cell is
/// PARTIAL. Intersect it with a part to get, for example, the region of a material, or the region hotter than
/// a limit.
///
/// - Buffers: `low` and `high`, as many numbers each as the channel's values have, which may be infinite;
///   `options`, one struct or NULL; `octree`, one pointer.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_ARGUMENT if a bound is not a number; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT;
///   LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*octree` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any channel, any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_channel_region(
    channel: *const leafless_channel,
    low: *const f64,
    high: *const f64,
    options: *const leafless_options,
    octree: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let channel = &shared(channel, "channel")?.channel;
        let components = channel.value_type().components() as u64;
        let mut band = [[0.0; 4]; 2];
        for (to, given) in
            band.iter_mut().zip([slice(low, components, "low")?, slice(high, components, "high")?])
        {
            to[..given.len()].copy_from_slice(given);
        }
        let octree = out(octree, "octree")?;
        let view = channel.view()?;
        octree.write(give_octree(controlled(options, |control| view.region(band[0], band[1], control))?))
    })
}

/// Measures the parts of a solid in which a channel has one value, each as leafless_solid_measure: one for
/// each value of the channel that the solid may have somewhere, in ascending order of the values. The cells
/// of the channel decide the material. Returning only the count takes as long.
///
/// - Buffers: `frame`, one struct: the frame on which the solid is split, with the channel's cube; `options`,
///   one struct or NULL; `measured`, room for `capacity` structs, or NULL to get only the count; `count`, one
///   number. `relative` and `absolute_model` are those of leafless_solid_measure.
/// - Result: `*count`; the materials.
/// - Errors: LEAFLESS_E_LIMIT if the channel has more than 4096 different values; LEAFLESS_E_FRAME unless
///   `frame` has the channel's cube; LEAFLESS_E_BUFFER if the capacity is too small; otherwise as
///   leafless_solid_measure.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid, any channel; the default of `max_splits` bounds the work for each value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_materials(
    solid: *const leafless_solid,
    channel: *const leafless_channel,
    frame: *const leafless_frame,
    relative: f64,
    absolute_model: f64,
    options: *const leafless_options,
    measured: *mut leafless_material,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        let channel = &shared(channel, "channel")?.channel;
        let frame = self::frame(frame)?;
        let measured = buffer(measured, capacity, "measured")?;
        let count = out(count, "count")?;
        let tolerance = Tolerance { relative, absolute: absolute_model };
        let view = channel.view()?;
        let found = controlled(options, |control| materials(solid, view, &frame, tolerance, control))?;
        measured.fill_with(&found)?;
        count.write(found.len() as u64)
    })
}

/// Makes an attribute of one number from the samples of a volume, at the position that the file states. There
/// is no value outside the voxels, nor where a sample used for the value is not a number. The first solid,
/// range or attribute of a volume reads all samples, in O(n).
///
/// - Buffers: `interpolation`, a leafless_interpolation; `options`, one struct or NULL (its limits are
///   ignored); `attribute`, one pointer.
/// - Result: `*attribute`.
/// - Errors: LEAFLESS_E_ARGUMENT if the map that places the volume has no valid inverse;
///   LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the attribute shares the samples, and `volume` may be freed; release `*attribute` with
///   leafless_attribute_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any volume.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_attribute_from_volume(
    volume: *const leafless_volume,
    interpolation: Number<leafless_interpolation>,
    options: *const leafless_options,
    attribute: *mut *mut leafless_attribute,
) -> leafless_status {
    guard(|| unsafe {
        let volume = shared(volume, "volume")?;
        let interpolation = interpolation.known("interpolation")?;
        let attribute = out(attribute, "attribute")?;
        // Any band will do.
        let band = Band::between(f64::NEG_INFINITY, f64::INFINITY)?;
        let samples = controlled(options, |control| volume.voxels(band, control))?;
        let samples = VolumeAttribute::new(samples, interpolation);
        attribute.write(match &volume.placement {
            Some(placement) => give_attribute(MovedAttribute::new(samples, placement.inverse()?)),
            None => give_attribute(samples),
        })
    })
}
