//! The volume layer and its settings.

use crate::error::Error;
use crate::render::Transfer;
use crate::voxel::VoxelRecordsRef;

/// A way of compositing voxels of different sizes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Compositing {
    /// By the exact length of each line of sight's path through a voxel. Clip planes and opaque surfaces cut
    /// paths, and translucent surfaces divide them.
    #[default]
    Exact,
    /// As published (Zhu, Tang and Dong 2002): a voxel is a cell of one unit, repeated edge / unit times,
    /// wherever its projection covers a sample. The transfer function's opacity holds for one repetition, and
    /// its length does not count. A voxel whose centre is cut away is left out. A voxel lies behind a surface
    /// if the line of sight enters the voxel behind the surface; otherwise the whole voxel lies in front of
    /// the surface.
    ///
    /// Let n repetitions of the colour C and the opacity α lie in front of the light D (a colour times its
    /// opacity) with the opacity β. The light of both is D (1 − α)^n + C (1 − (1 − α)^n), and their opacity
    /// is 1 − (1 − β)(1 − α)^n. The number n need not be whole.
    Published {
        /// The edge of a cell that is composited once, in model units: above 0.
        unit: f64,
    },
}

/// A layer that shows voxel records as a translucent volume. Inside and boundary voxels are visible; outside
/// and refined ones are not.
///
/// The weight of a voxel, 0 to 1, scales its optical depth, as if only that part of it were filled. Inside
/// voxels weigh 1 and boundary voxels ½ unless [`weights`](Self::weights) are given.
///
/// The voxels of one layer are composited in the correct order from everywhere, also from among them. Among
/// two volume layers, the one that comes first in the picture counts as in front.
///
/// O(pairs of a voxel and a sample that it covers + pairs of a voxel and a tile that it meets · levels).
/// Where less than 10⁻⁷ of the light comes through, nothing farther away is drawn. So the error of each
/// channel, as linear light from 0 to 1, is at most 10⁻⁶.
///
/// ```
/// use leafless::{
///     Bounds, Control, Csg, Frame, Rule, build,
///     render::{Camera, ColourMap, Shot, Transfer, VolumeLayer, render},
///     voxel::{VoxelOptions, VoxelRecords},
/// };
/// let (frame, control) = (Frame::new([-1.0; 3], 2.0, 5)?, Control::default());
/// let ball = build(&Csg::ball([0.0; 3], 0.9)?, &frame, Rule::Certified, &control)?;
/// let records = VoxelRecords::of(ball.view(), &VoxelOptions::new(), None, &control)?;
/// // Voxels without values are grey. Half a model unit absorbs 30 % of the light.
/// let transfer = Transfer::new(ColourMap::Viridis, [0.0, 1.0], 0.3, 0.5)?;
/// let layer = VolumeLayer::new(records.view(), transfer);
/// let camera = Camera::fitted(&Bounds::of(&frame).corners(), [30.0, 20.0], None, 1.0)?;
/// let picture = render(&Shot::new(camera, [64, 64]), &[&layer], &control)?;
/// assert_eq!(picture.colours()[0], [255; 4]);
/// assert!(picture.colours()[64 * 32 + 32][0] < 240);
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct VolumeLayer<'a> {
    pub(super) records: VoxelRecordsRef<'a>,
    pub(super) transfer: Transfer,
    pub(super) weights: Option<&'a [f64]>,
    pub(super) compositing: Compositing,
}

impl<'a> VolumeLayer<'a> {
    /// Creates a layer of records whose values look as the transfer function says, with exact compositing.
    pub fn new(records: VoxelRecordsRef<'a>, transfer: Transfer) -> VolumeLayer<'a> {
        VolumeLayer { records, transfer, weights: None, compositing: Compositing::Exact }
    }

    /// Sets a weight, 0 to 1, for each record: the part of the voxel that is solid. O(records).
    ///
    /// # Errors
    /// [`Error::Argument`] if there are not as many weights as records, or if one is not in [0, 1].
    pub fn weights(self, weights: &'a [f64]) -> Result<VolumeLayer<'a>, Error> {
        let refused = |problem| Err(Error::Argument { name: "weights", problem });
        if weights.len() != self.records.len() {
            return refused("there must be one for each record");
        }
        if !weights.iter().all(|weight| (0.0..=1.0).contains(weight)) {
            return refused("must be 0 to 1");
        }
        Ok(VolumeLayer { weights: Some(weights), ..self })
    }

    /// Sets the way of compositing.
    ///
    /// # Errors
    /// [`Error::Argument`] if the unit is not above 0 and finite.
    pub fn compositing(self, compositing: Compositing) -> Result<VolumeLayer<'a>, Error> {
        if let Compositing::Published { unit } = compositing {
            let good = unit > 0.0 && unit.is_finite();
            if !good {
                return Err(Error::Argument { name: "unit", problem: "must be above 0 and finite" });
            }
        }
        Ok(VolumeLayer { compositing, ..self })
    }
}
