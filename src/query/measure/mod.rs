//! Certified volume, centroid and inertia of any solid.

mod area;
mod bounds;
mod faces;
mod mass_sum;
mod moments;
mod quantity;
mod volume;
mod walk;

pub use area::{AREA_SPLITS, SurfaceArea, surface_area};
pub use mass_sum::{MassSum, measure_in};

use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Frame, Interval, MAX_DEPTH, VolumeMoments, valid};
use crate::octree::{Proof, Tag};
use crate::solid::{AskWhole, Classifier, DynSolid};
use crate::walk::Proven;
use bounds::Known;
use volume::Volume;

/// The reason why a search or a measurement ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum StopReason {
    /// The result is as exact as the tolerance requires.
    Tolerance,
    /// `max_splits` is spent.
    Budget,
    /// No cell is left whose split would help: the undecided cells have the size of the frame's finest cells,
    /// or the solid itself provides nothing more about them, as a stored octree for its PARTIAL cells.
    Exhausted,
}

/// Mass properties of a solid of density 1, in model units. All intervals contain the true values, including
/// all rounding errors.
///
/// The properties are those of the solid's part inside of the universe. If `clipped` is not set, this is the
/// whole solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassProperties {
    /// The volume.
    pub volume: Interval,
    /// The centroid; `None` as long as no cell is proven full, so that the solid may be empty.
    pub centroid: Option<[Interval; 3]>,
    /// The tensor of inertia about the origin of the model: ∫ (|p|² δij − pi pj) over the points p of the
    /// solid. Products of inertia are therefore negative where the product of the coordinates is mostly
    /// positive. The tensor is symmetric.
    pub inertia_about_origin: [[Interval; 3]; 3],
    /// The tensor of inertia about the solid's own centroid, wherever in its interval the centroid lies.
    pub inertia_about_centroid: [[Interval; 3]; 3],
    /// The proof of the solid: which verdicts are proven. Unproven verdicts count as undecided. If nothing is
    /// proven, as for a sampled octree, the volume is only known to fit into the universe.
    pub proof: Proof,
    /// Whether the solid continues, or may continue, outside of the universe. The measures are then those of
    /// the part inside.
    pub clipped: bool,
    /// Whether the solid was not split because it provides its own moments, up to rounding. A closed mesh
    /// whose triangles do not intersect does so.
    pub exact: bool,
    /// The reason why the measurement ended.
    pub stop_reason: StopReason,
    /// The finest level of the visited cells.
    pub level: u8,
    /// Number of cell splits.
    pub splits: u64,
}

impl MassProperties {
    /// Builds the mass properties of a solid in the universe that was not split, because it provides its
    /// moments.
    fn known(moments: &VolumeMoments, proof: Proof, tolerance: Tolerance) -> MassProperties {
        let volume = moments.volume;
        let wanted = tolerance.absolute.max(tolerance.relative * (0.5 * (volume.lower + volume.upper)));
        MassProperties {
            volume,
            centroid: moments.centroid(),
            inertia_about_origin: moments.inertia_about_origin(),
            inertia_about_centroid: moments.inertia_about_centroid(),
            proof,
            clipped: false,
            exact: true,
            stop_reason: if volume.width() <= wanted { StopReason::Tolerance } else { StopReason::Exhausted },
            level: 0,
            splits: 0,
        }
    }
}

/// The proven bounds of a volume.
pub(super) struct Measured {
    /// In cubic model units.
    pub(super) volume: Interval,
    pub(super) level: u8,
    pub(super) splits: u64,
}

/// Measures the volume of a solid in the universe of its frame, to an absolute tolerance, as [`measure`]
/// does.
pub(super) fn volume_within<C: Classifier>(
    classifier: &C,
    tolerance: f64,
    max_splits: u64,
    control: &Control<'_>,
) -> Result<Measured, Error> {
    let tolerance = Tolerance { relative: 0.0, absolute: tolerance };
    let walked = walk::walk::<Volume, _>(classifier, tolerance, max_splits, control)?;
    let known = Known { frame: classifier.frame().with_depth(MAX_DEPTH)?, found: walked.found };
    Ok(Measured { volume: known.volume(), level: walked.level, splits: walked.splits })
}

/// The precision of a volume or an area. The measurement ends as soon as one of both tolerances is met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// The width of the interval, as a share of its middle.
    pub relative: f64,
    /// The width of the interval, in cubic model units; for an area, in square model units.
    pub absolute: f64,
}

impl From<f64> for Tolerance {
    /// Builds a relative tolerance.
    fn from(relative: f64) -> Tolerance {
        Tolerance { relative, absolute: 0.0 }
    }
}

/// The maximal number of splits of a measurement if `max_splits` sets no other limit: about a minute.
pub const MEASURE_SPLITS: u64 = 1 << 26;

/// Measures `solid` in the universe of `frame`, without building a tree. The cells with the greatest doubt
/// are split first. The measurement ends when the width of the volume's interval is within `tolerance` (a
/// plain number is relative to the middle of the interval), when `max_splits` of `control`
/// ([`MEASURE_SPLITS`] if that is `None`) are spent, or when nothing is left to split at the frame's depth.
/// With a tolerance of 0 it ends for one of the latter two reasons, or when nothing is in doubt.
///
/// Where the solid provides slabs of a cell ([`Enclosure`](crate::solid::Enclosure)), the cell contributes
/// the part that the slabs cut off, and only the rest is in doubt. Where it provides the moments
/// ([`Question::Moments`](crate::solid::Question::Moments)), only their error is in doubt. With N splits the
/// width decreases with N^-1.5 where one curved half-space cuts a cell, with 1/N at other curved surfaces,
/// with 1/N² at plane surfaces, and with N^-½ for solids without slabs.
///
/// A solid in the universe that provides its moments is not split. This is so for a closed mesh whose
/// triangles do not intersect ([`TriangleMesh::moments`](crate::TriangleMesh::moments)). Its properties are
/// known up to rounding, whatever the tolerance.
///
/// The result depends only on the solid, the frame, the tolerance and `max_splits`: it is bitwise the same
/// for any number of threads. The work is done in passes. Under a budget the last complete pass counts. Time
/// is linear in the splits. Memory is limited to about ten thousand parts: from a certain number of undecided
/// cells on, the levels below are walked again and again, each time deeper, and not kept. A `max_bytes` of
/// `control` lowers this number. The measurement ignores other limits.
///
/// Any part of the cells in doubt may belong to the solid, and the intervals contain the results of each
/// choice. The bounds of the volume and of the tensors' diagonals are the best that the cells allow. Products
/// of inertia and the centroid are bounded by the second moments of the part in doubt (Loewner's order; Scarf
/// 1958).
///
/// # Errors
/// [`Error::Argument`] if `tolerance` is negative or not a number; the solid's own errors, as
/// [`build`](crate::build); [`Error::Cancelled`]; [`Error::OutOfMemory`].
///
/// ```
/// use leafless::{Control, Csg, Frame, measure};
/// let frame = Frame::new([-1.0; 3], 2.0, 20)?;
/// let ball = measure(&Csg::ball([0.1, 0.0, 0.0], 0.75)?, &frame, 0.02, &Control::default())?;
/// assert!(ball.volume.contains(4.0 / 3.0 * std::f64::consts::PI * 0.75f64.powi(3)));
/// assert!(ball.volume.width() <= 0.02 * ball.volume.upper && !ball.clipped);
/// assert!(ball.centroid.unwrap()[0].contains(0.1));
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn measure(
    solid: &dyn DynSolid,
    frame: &Frame,
    tolerance: impl Into<Tolerance>,
    control: &Control<'_>,
) -> Result<MassProperties, Error> {
    let tolerance = tolerance.into();
    valid::tolerance("tolerance", tolerance.relative)?;
    valid::tolerance("tolerance", tolerance.absolute)?;
    let classifier = Proven(solid.on(frame, control)?);
    if classifier.exterior() == Tag::Empty
        && let Some(moments) = classifier.moments(control)?
    {
        return Ok(MassProperties::known(&moments, classifier.proof(), tolerance));
    }
    let walked = walk::walk::<Volume, _>(
        &classifier,
        tolerance,
        control.max_splits.unwrap_or(MEASURE_SPLITS),
        control,
    )?;
    MassSum::new(&classifier, walked).properties()
}
