//! Attributes: values at points of model space.

use super::boundary::{
    Failure, array, buffer, filled, guard, handle, out, output, refer, release, shared, slice,
};
use super::csg::placement;
use super::frame::leafless_interval;
use super::status::leafless_status;
use leafless::Error;
use leafless::attribute::{Attribute, ConstantAttribute, MovedAttribute, ValueRange};
use leafless::{Bounds, Interval};
use leafless_range_kind::*;
use std::sync::Arc;

/// An attribute: a value at every point of model space, or at some points. It is a constant, the host's own
/// function, the values of a channel, of a mesh or of a volume, or any of these under a map. A value has one
/// to four numbers, the same count at all points. Where a value is written and there is none, its numbers are
/// NaN.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_attribute_free releases.
pub struct leafless_attribute {
    pub(super) attribute: AnyAttribute,
}

/// An attribute of any kind; a copy shares it.
#[derive(Clone)]
pub(super) struct AnyAttribute(Arc<dyn Attribute + Send>);

impl Attribute for AnyAttribute {
    fn components(&self) -> usize {
        self.0.components()
    }

    fn values(&self, points: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) -> Result<(), Error> {
        self.0.values(points, values)
    }

    fn range(&self, bounds: &Bounds) -> Result<ValueRange, Error> {
        self.0.range(bounds)
    }

    fn kept_bytes(&self) -> u64 {
        self.0.kept_bytes()
    }
}

/// Returns a handle of an attribute.
pub(super) fn give(attribute: impl Attribute + Send + 'static) -> *mut leafless_attribute {
    handle(leafless_attribute { attribute: AnyAttribute(Arc::new(attribute)) })
}

/// The kind of knowledge about the values in the interior of a box.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_range_kind {
    /// The values are not known.
    LEAFLESS_RANGE_KIND_UNKNOWN = 0,
    /// No point has a value.
    LEAFLESS_RANGE_KIND_NOWHERE = 1,
    /// Every point has a value, and each of its numbers lies in its interval.
    LEAFLESS_RANGE_KIND_WITHIN = 2,
}

/// The range of the values of an attribute in the interior of a box.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_value_range {
    /// For each number of a value an interval that contains it, if `kind` is LEAFLESS_RANGE_KIND_WITHIN. All
    /// numbers are NaN otherwise, and beyond the numbers that a value has.
    pub values: [leafless_interval; 4],
    /// A leafless_range_kind.
    pub kind: u32,
}

impl leafless_value_range {
    /// The range of unknown values.
    pub(super) const UNKNOWN: leafless_value_range = leafless_value_range {
        values: [leafless_interval { lower: f64::NAN, upper: f64::NAN }; 4],
        kind: LEAFLESS_RANGE_KIND_UNKNOWN as u32,
    };

    fn new(range: ValueRange, components: usize) -> leafless_value_range {
        let mut given = leafless_value_range::UNKNOWN;
        given.kind = match range {
            ValueRange::Unknown => LEAFLESS_RANGE_KIND_UNKNOWN as u32,
            ValueRange::Nowhere => LEAFLESS_RANGE_KIND_NOWHERE as u32,
            ValueRange::Within(ranges) => {
                for (given, range) in given.values.iter_mut().zip(ranges).take(components) {
                    *given = range.into();
                }
                LEAFLESS_RANGE_KIND_WITHIN as u32
            }
        };
        given
    }

    /// Returns the range that a host means. Invalid intervals mean that nothing is known.
    pub(super) fn range(&self, components: usize) -> Result<ValueRange, Error> {
        match self.kind {
            kind if kind == LEAFLESS_RANGE_KIND_UNKNOWN as u32 => Ok(ValueRange::Unknown),
            kind if kind == LEAFLESS_RANGE_KIND_NOWHERE as u32 => Ok(ValueRange::Nowhere),
            kind if kind == LEAFLESS_RANGE_KIND_WITHIN as u32 => {
                let mut ranges = [Interval::exactly(0.0); 4];
                for (range, given) in ranges.iter_mut().zip(&self.values).take(components) {
                    let Some(given) = Interval::new(given.lower, given.upper) else {
                        return Ok(ValueRange::Unknown);
                    };
                    *range = given;
                }
                Ok(ValueRange::Within(ranges))
            }
            kind => Err(Error::Callback { code: kind as i32 }),
        }
    }
}

/// Number of points that are queried at once.
const BATCH: usize = 256;

/// Writes the values of an attribute at the host's points, one after another; NaN where there is no value.
///
/// # Safety
/// As [`slice`] with `count` points, and [`buffer`] with `count` values.
pub(super) unsafe fn sample(
    attribute: &dyn Attribute,
    points_model: *const f64,
    count: u64,
    values: *mut f64,
) -> Result<(), Failure> {
    // SAFETY: the caller's promise.
    let points: &[[f64; 3]] = unsafe { slice(points_model.cast(), count, "points_model")? };
    if points.is_empty() {
        return Ok(());
    }
    let components = attribute.components();
    // A value has at most four numbers; a point has three.
    let numbers = points.len().saturating_mul(components);
    // SAFETY: the caller's promise; the buffer is for this call alone.
    let values = unsafe {
        out(values, "values")?;
        buffer(values, numbers as u64, "values")?.zeroed(numbers)?.unwrap_or_default()
    };
    let mut found = [None; BATCH];
    for (points, values) in points.chunks(BATCH).zip(values.chunks_mut(BATCH * components)) {
        let found = &mut found[..points.len()];
        attribute.values(points, found)?;
        for (to, found) in values.chunks_exact_mut(components).zip(found) {
            to.copy_from_slice(&found.unwrap_or([f64::NAN; 4])[..components]);
        }
    }
    Ok(())
}

/// Makes the attribute that has one value everywhere.
///
/// - Buffers: `value`, `components` numbers; `attribute`, one pointer.
/// - Result: `*attribute`.
/// - Errors: LEAFLESS_E_ARGUMENT unless `components` is 1 to 4, and no number NaN.
/// - Ownership: release `*attribute` with leafless_attribute_free.
/// - Untrusted input: any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_attribute_new_constant(
    value: *const f64,
    components: u32,
    attribute: *mut *mut leafless_attribute,
) -> leafless_status {
    guard(|| unsafe {
        let components = self::components(components, "components")?;
        let value = slice(value, components as u64, "value")?;
        if value.iter().any(|number| number.is_nan()) {
            return Err(Failure::Argument { name: "value", problem: "must not be NaN" });
        }
        let attribute = out(attribute, "attribute")?;
        attribute.write(give(ConstantAttribute::new(value)?))
    })
}

/// Checks a number of components.
pub(super) fn components(components: u32, name: &'static str) -> Result<usize, Failure> {
    match components {
        1..=4 => Ok(components as usize),
        _ => Err(Failure::Argument { name, problem: "must be 1 to 4" }),
    }
}

/// Makes an attribute under an affine map: its value at the image M p + t of a point p is that of `operand`
/// at p. Use it to move attributes and channels with a solid that leafless_solid_placed moves by the same
/// map. The map is inverted; the rounding displaces the values by about 2^-50 of the coordinates.
///
/// - Buffers: `matrix`, 12 numbers, the rows of [M | t]; `attribute`, one pointer.
/// - Result: `*attribute`.
/// - Errors: LEAFLESS_E_ARGUMENT if an entry is neither 0 nor of a magnitude between 2^-64 and 2^64, M is
///   singular, or an entry of the inverse is beyond 2^64.
/// - Ownership: the operand is shared and may be freed; release `*attribute` with leafless_attribute_free.
/// - Untrusted input: any attribute and numbers.
///
/// cbindgen:ptrs-as-arrays=[[matrix; 12]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_attribute_placed(
    operand: *const leafless_attribute,
    matrix: *const f64,
    attribute: *mut *mut leafless_attribute,
) -> leafless_status {
    guard(|| unsafe {
        let operand = shared(operand, "operand")?.attribute.clone();
        let back = placement(matrix)?.inverse()?;
        let attribute = out(attribute, "attribute")?;
        attribute.write(give(MovedAttribute::new(operand, back)))
    })
}

/// Basic facts about an attribute.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_attribute_info {
    /// sizeof(leafless_attribute_info).
    pub struct_size: u32,
    /// Numbers per value: 1 to 4.
    pub components: u32,
    /// Approximate number of bytes of memory (or of mapped files) that the attribute keeps alive: its own,
    /// and those of the mesh, channel or samples that it shares. 0 for constants and for objects of the host.
    pub bytes: u64,
}

output!(leafless_attribute_info);

/// Returns basic facts about an attribute. O(1).
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
/// - Untrusted input: any attribute.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_attribute_describe(
    attribute: *const leafless_attribute,
    info: *mut leafless_attribute_info,
) -> leafless_status {
    guard(|| unsafe {
        let attribute = &shared(attribute, "attribute")?.attribute;
        filled(info, "info")?.write(leafless_attribute_info {
            struct_size: size_of::<leafless_attribute_info>() as u32,
            components: attribute.components() as u32,
            bytes: attribute.kept_bytes(),
        })
    })
}

/// Returns the values of an attribute at points.
///
/// - Buffers: `points_model`, `count` points of 3 numbers; `values`, room for `count` values with
///   `components` numbers each, from leafless_attribute_describe. Both may be NULL if `count` is 0.
/// - Result: the value at point i from `values[components * i]` on; NaN where there is no value.
/// - Errors: LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any attribute, any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_attribute_values(
    attribute: *const leafless_attribute,
    points_model: *const f64,
    count: u64,
    values: *mut f64,
) -> leafless_status {
    guard(|| unsafe {
        let attribute = &shared(attribute, "attribute")?.attribute;
        sample(attribute, points_model, count, values)
    })
}

/// Returns the range of the values of an attribute in the interior of a box.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `range`, one struct.
/// - Result: `*range`.
/// - Errors: LEAFLESS_E_ARGUMENT unless min <= max on every axis, and all coordinates are finite;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED.
/// - Untrusted input: any attribute, any numbers; the work is bounded.
///
/// cbindgen:ptrs-as-arrays=[[min_model; 3], [max_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_attribute_range(
    attribute: *const leafless_attribute,
    min_model: *const f64,
    max_model: *const f64,
    range: *mut leafless_value_range,
) -> leafless_status {
    guard(|| unsafe {
        let attribute = &shared(attribute, "attribute")?.attribute;
        let (min, max) = (array(min_model, "min_model")?, array(max_model, "max_model")?);
        let range = out(range, "range")?;
        let problem = "must be no less than min on every axis, and both finite";
        let bounds = Bounds::new(min, max).ok_or(Failure::Argument { name: "max_model", problem })?;
        range.write(leafless_value_range::new(attribute.range(&bounds)?, attribute.components()))
    })
}

/// Returns one more reference to an attribute.
///
/// - Buffers: `attribute`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `attribute`.
/// - Ownership: release each reference with leafless_attribute_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_attribute_ref(
    attribute: *const leafless_attribute,
    reference: *mut *mut leafless_attribute,
) -> leafless_status {
    guard(|| unsafe { refer(attribute, "attribute", reference) })
}

/// Releases a reference to an attribute; the last release frees the attribute. Channels that were filled from
/// it stay.
///
/// - Buffers: `attribute`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_attribute_free(attribute: *mut leafless_attribute) {
    // SAFETY: the caller's promise.
    unsafe { release(attribute) }
}
