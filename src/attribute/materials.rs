//! Mass properties of each material of a part.

use super::value_region::ValueRegion;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Frame;
use crate::memory;
use crate::octree::ChannelRef;
use crate::octree::channel::Bits;
use crate::query::{MassProperties, Tolerance, measure};
use crate::solid::DynSolid;
use alloc::vec::Vec;

/// The greatest number of different values of a channel whose regions are measured.
const MOST_MATERIALS: usize = 4096;

/// Volume, centroid and inertia of the part of a solid that has one value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaterialProperties {
    /// The value.
    pub value: [f64; 4],
    /// The measures of the points of the solid that have the value, for density 1.
    pub properties: MassProperties,
}

/// Measures the parts of `solid` in which `channel` has one value, each as by [`measure`], with its
/// tolerance. There is one result for each value of the channel that may occur in the solid, in ascending
/// order of the values. The cells of the channel decide the material; the channel is not resampled.
///
/// # Errors
/// [`Error::Limit`] if the channel has more than 4096 different values; [`Error::FrameMismatch`] unless
/// `frame` lies in the channel's cube; and the errors of [`measure`] and [`ValueRegion::new`].
///
/// ```
/// use leafless::{
///     Control, Csg, Frame, Rule, build,
///     attribute::{ConstantAttribute, FillOptions, ScalarType, ValueType, fill_channel, materials},
/// };
/// let (frame, control) = (Frame::new([-1.0; 3], 2.0, 6)?, Control::default());
/// let value_type = ValueType::new(ScalarType::U8, 1)?;
/// let options = FillOptions { value_type, frame, solid: None, detail: None };
/// let steel = fill_channel(&ConstantAttribute::new(&[1.0])?, &options, &control)?;
/// let upper = build(&Csg::cuboid([-1.0, -1.0, 0.0], [1.0; 3])?, &frame, Rule::Certified, &control)?;
/// let parts = steel.view()?.with_value_in(upper.view(), Some([2.0, 0.0, 0.0, 0.0]), &control)?;
///
/// let ball = Csg::ball([0.0; 3], 0.75)?;
/// let found = materials(&ball, parts.view()?, &frame.with_depth(20)?, 1e-4, &control)?;
/// assert_eq!(found.len(), 2);
/// for material in found {
///     assert!(material.properties.volume.contains(2.0 / 3.0 * std::f64::consts::PI * 0.75f64.powi(3)));
/// }
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn materials(
    solid: &dyn DynSolid,
    channel: &ChannelRef<'_>,
    frame: &Frame,
    tolerance: impl Into<Tolerance>,
    control: &Control<'_>,
) -> Result<Vec<MaterialProperties>, Error> {
    let (tolerance, value_type) = (tolerance.into(), channel.value_type());
    let mut values: Vec<Bits> = Vec::new();
    for bits in (0..).map_while(|index| channel.stored(index)) {
        if let Err(place) = values.binary_search(&bits) {
            if values.len() == MOST_MATERIALS {
                return Err(Error::Limit { what: "materials", limit: MOST_MATERIALS as u64 });
            }
            values.try_reserve(1)?;
            values.insert(place, bits);
        }
    }
    let mut values: Vec<[f64; 4]> = memory::collected(values.iter().map(|&bits| value_type.decode(bits)))?;
    values.sort_unstable_by(|a, b| a.partial_cmp(b).unwrap_or(core::cmp::Ordering::Equal));
    let mut found = memory::with_capacity(values.len())?;
    let count = values.len() as f64;
    for (value, i) in values.into_iter().zip(0..) {
        let region = ValueRegion::new(solid, channel, value, value)?;
        let share = [f64::from(i) / count, (f64::from(i) + 1.0) / count];
        let properties = control.share(share, |control| measure(&region, frame, tolerance, control))?;
        if properties.volume.upper > 0.0 {
            found.push(MaterialProperties { value, properties });
        }
    }
    Ok(found)
}
