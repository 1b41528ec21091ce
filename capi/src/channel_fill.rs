//! Channels: filling from attributes, values at points, and changes in regions.

use super::attribute::{components, leafless_attribute, sample};
use super::boundary::{Failure, Sized32, array, guard, out, shared, sized, slice, text};
use super::channel::{give, leafless_channel, leafless_scalar_type};
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame};
use super::number::{Number, enumeration};
use super::octree::leafless_octree;
use super::status::leafless_status;
use core::ffi::c_char;
use leafless::Metadata;
use leafless::attribute::ValueType;
use leafless::attribute::{Attribute, Criterion, Detail, FillOptions, fill_channel};
use leafless::octree::MetadataLimit;

/// The criterion for the size of cells that follow an attribute.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_criterion {
    /// Cells are split to the finest level, unless a cell is proven to have one value.
    LEAFLESS_CRITERION_NONE = 0,
    /// Cells are split until the variance of the values at a cell's corners is at most the square of the
    /// tolerance. The variance of several numbers is the sum of their variances. A detail between the corners
    /// is missed.
    LEAFLESS_CRITERION_VARIANCE = 1,
    /// Cells are split until the values in a cell are proven to differ by no more than the tolerance, in each
    /// of their numbers. No detail is missed. A cell whose range is unknown is split.
    LEAFLESS_CRITERION_RANGE = 2,
}

enumeration! {
    leafless_criterion => Option<Criterion> {
        LEAFLESS_CRITERION_NONE => None,
        LEAFLESS_CRITERION_VARIANCE => Some(Criterion::Variance),
        LEAFLESS_CRITERION_RANGE => Some(Criterion::Range),
    }
}

/// Options of filling a channel. NULL means the defaults. Zero is the default of every field but the first.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_channel_fill_options {
    /// sizeof(leafless_channel_fill_options).
    pub struct_size: u32,
    /// A leafless_scalar_type: the type that numbers are rounded to.
    pub scalar: Number<leafless_scalar_type>,
    /// Numbers per value, the same as for the attribute; 0 means those of the attribute.
    pub components: u32,
    /// Depth of the channel; 0 means the depth of the frame.
    pub depth: u32,
    /// The octree inside which values matter; optional. Where it is EMPTY, the channel has arbitrary values
    /// that take the least memory.
    pub solid: *const leafless_octree,
    /// A leafless_criterion. Unless it is LEAFLESS_CRITERION_NONE, a cell is split until its edge is at most
    /// `coarse_model` and the criterion holds, or until its edge is at most `fine_model`. It then has the
    /// value at its centre.
    pub criterion: Number<leafless_criterion>,
    /// Reserved; must be 0.
    pub reserved: u32,
    /// With a criterion, the longest edge of cells; 0 means any.
    pub coarse_model: f64,
    /// With a criterion, cells of this edge or less are not split. At most `coarse_model`; 0 means the edge
    /// of the finest cells.
    pub fine_model: f64,
    /// The tolerance of the criterion, in the attribute's units; may be infinite.
    pub tolerance: f64,
    /// The name of the channel, `name_length` bytes of UTF-8; optional.
    pub name: *const c_char,
    /// Length of the name in bytes.
    pub name_length: usize,
}

// SAFETY: numbers and pointers.
unsafe impl Sized32 for leafless_channel_fill_options {}

impl leafless_channel_fill_options {
    fn value_type(&self, attribute: &dyn Attribute) -> Result<ValueType, Failure> {
        let scalar = self.scalar.known("fill.scalar")?;
        let components = match self.components {
            0 => attribute.components(),
            given => components(given, "fill.components")?,
        };
        Ok(ValueType::new(scalar, components as u8)?)
    }

    fn detail(&self) -> Result<Option<Detail>, Failure> {
        let Some(criterion) = self.criterion.known("fill.criterion")? else {
            if self.coarse_model != 0.0 || self.fine_model != 0.0 || self.tolerance != 0.0 {
                let problem = "is needed for edges and a tolerance";
                return Err(Failure::Argument { name: "fill.criterion", problem });
            }
            return Ok(None);
        };
        let coarse = if self.coarse_model == 0.0 { f64::INFINITY } else { self.coarse_model };
        // No cell is this small.
        let fine = if self.fine_model == 0.0 { f64::MIN_POSITIVE } else { self.fine_model };
        Ok(Some(Detail::new(coarse, fine, self.tolerance, criterion)?))
    }
}

/// Fills a channel from an attribute: each cell gets the attribute's value at its centre, rounded to the type
/// of the numbers; a cell whose centre has no value gets none. Cells are as large as proven ranges and the
/// criterion allow. The result is identical, bit for bit, for any number of threads.
///
/// Without a criterion the result is that of evaluating the attribute at the centre of every finest cell. An
/// attribute without ranges is evaluated at all these centres: 8^depth times, or, with a solid, once for each
/// finest cell that is not EMPTY.
///
/// - Buffers: `frame`, one struct, or NULL for the frame of `fill->solid`, which is then needed; `fill`, one
///   struct or NULL; `options`, one struct or NULL; `channel`, one pointer.
/// - Result: `*channel`, with the name as its only fact, if there is one.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check, if a field of `fill` is wrong, or if a value is
///   beyond the range of the type, infinite, or partly NaN; LEAFLESS_E_FRAME if the solid lies in another
///   cube than the frame; LEAFLESS_E_NULL if both are missing; LEAFLESS_E_UTF8; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the library keeps no reference to the attribute, the solid and the name; release `*channel`
///   with leafless_channel_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any attribute, any octree; set `max_bytes` if the depth or the attribute is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_channel_fill(
    attribute: *const leafless_attribute,
    frame: *const leafless_frame,
    fill: *const leafless_channel_fill_options,
    options: *const leafless_options,
    channel: *mut *mut leafless_channel,
) -> leafless_status {
    guard(|| unsafe {
        let attribute = &shared(attribute, "attribute")?.attribute;
        let fill = sized(fill, "fill")?;
        let channel = out(channel, "channel")?;
        let solid = match fill.solid.is_null() {
            true => None,
            false => Some(shared(fill.solid, "fill.solid")?.octree.view()),
        };
        let frame = match solid {
            Some(solid) if frame.is_null() => *solid.frame(),
            _ => self::frame(frame)?,
        };
        let frame = match fill.depth {
            0 => frame,
            depth => frame.with_depth(u8::try_from(depth).unwrap_or(u8::MAX))?,
        };
        if fill.reserved != 0 {
            return Err(Failure::Argument { name: "fill.reserved", problem: "must be zero" });
        }
        let name = text(fill.name, fill.name_length, "fill.name")?;
        let metadata = match name.is_empty() {
            true => Metadata::new(),
            false => Metadata::new().changed("name", Some(name), MetadataLimit::CHANNEL)?,
        };
        let filling =
            FillOptions { value_type: fill.value_type(attribute)?, frame, solid, detail: fill.detail()? };
        let filled = controlled(options, |control| fill_channel(attribute, &filling, control))?;
        channel.write(give(filled.with_metadata(metadata)))
    })
}

/// Returns the values of a channel at points. A point on a face between cells belongs to the upper cell.
/// O(depth) each.
///
/// - Buffers: `points_model`, `count` points of 3 numbers; `values`, room for `count` values with
///   `components` numbers each, from leafless_channel_describe. Both may be NULL if `count` is 0.
/// - Result: the value at point i from `values[components * i]` on; NaN where there is no value, and outside
///   the channel's cube.
/// - Errors: LEAFLESS_E_DAMAGED.
/// - Untrusted input: any channel, any numbers; damage reads as no value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_channel_values(
    channel: *const leafless_channel,
    points_model: *const f64,
    count: u64,
    values: *mut f64,
) -> leafless_status {
    guard(|| unsafe {
        let channel = shared(channel, "channel")?.channel.view()?;
        sample(channel, points_model, count, values)
    })
}

/// Returns a value as four numbers: 0 beyond its own numbers, and all NaN if there is no value.
fn four(value: Option<[f64; 4]>) -> [f64; 4] {
    value.unwrap_or([f64::NAN; 4])
}

/// Returns the value of a channel at a point, like leafless_channel_values.
///
/// - Buffers: `point_model`, 3 numbers; `value`, room for 4 numbers.
/// - Result: `value`: the numbers of the channel's value, and 0 beyond them; four NaN if there is no value.
/// - Errors: LEAFLESS_E_DAMAGED.
/// - Untrusted input: any channel, any numbers; damage reads as no value.
///
/// cbindgen:ptrs-as-arrays=[[point_model; 3], [value; 4]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_channel_value(
    channel: *const leafless_channel,
    point_model: *const f64,
    value: *mut f64,
) -> leafless_status {
    guard(|| unsafe {
        let channel = &shared(channel, "channel")?.channel;
        let point = array(point_model, "point_model")?;
        let value = out(value.cast(), "value")?;
        value.write(four(channel.view()?.value_at(point)))
    })
}

/// Returns the value of a finest cell of a channel's own frame. O(depth).
///
/// - Buffers: `cell`, 3 numbers; `value`, room for 4 numbers.
/// - Result: `value`, as leafless_channel_value; four NaN if a coordinate is not below 2^depth.
/// - Errors: LEAFLESS_E_DAMAGED.
/// - Untrusted input: any channel, any numbers; damage reads as no value.
///
/// cbindgen:ptrs-as-arrays=[[cell; 3], [value; 4]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_channel_value_at(
    channel: *const leafless_channel,
    cell: *const u32,
    value: *mut f64,
) -> leafless_status {
    guard(|| unsafe {
        let channel = &shared(channel, "channel")?.channel;
        let cell = array(cell, "cell")?;
        let value = out(value.cast(), "value")?;
        value.write(four(channel.view()?.value_of_cell(cell)))
    })
}

/// Returns the channel with one value wherever an octree is not EMPTY, and unchanged elsewhere. It has the
/// depth of the deeper of the two. The result is identical, bit for bit, for any number of threads.
///
/// - Buffers: `region`, a handle; `value`, as many numbers as the channel's values have, or NULL to remove
///   values; `options`, one struct or NULL; `changed`, one pointer.
/// - Result: `*changed`, with the metadata of `channel`.
/// - Errors: LEAFLESS_E_ARGUMENT if the value is beyond the type's range, or not finite; LEAFLESS_E_FRAME
///   unless both lie in one cube; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: `channel` is unchanged; release `*changed` with leafless_channel_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any channel, any octree, any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_channel_with_value_in(
    channel: *const leafless_channel,
    region: *const leafless_octree,
    value: *const f64,
    options: *const leafless_options,
    changed: *mut *mut leafless_channel,
) -> leafless_status {
    guard(|| unsafe {
        let channel = &shared(channel, "channel")?.channel;
        let region = shared(region, "region")?.octree.view();
        let changed = out(changed, "changed")?;
        let value = match value.is_null() {
            true => None,
            false => {
                let numbers = slice(value, channel.value_type().components() as u64, "value")?;
                let mut value = [0.0; 4];
                value[..numbers.len()].copy_from_slice(numbers);
                Some(value)
            }
        };
        let view = channel.view()?;
        let made = controlled(options, |control| view.with_value_in(region, value, control))?;
        changed.write(give(made.with_metadata_from(channel)))
    })
}
