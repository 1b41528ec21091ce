//! Certified volume, centroid and inertia of any solid.

mod bounds;
mod moments;
mod walk;

use super::proven::Proven;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Frame, Interval, valid};
use crate::octree::{Proof, Tag};
use crate::solid::{Classifier, Solid};
use bounds::Known;

/// Why a search or a measurement ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum StopReason {
    /// The result is known as well as was asked for.
    Tolerance,
    /// `max_splits` is spent.
    Budget,
    /// No cell is left whose split would help: what is undecided has the size of the frame's finest cells, or
    /// the solid itself knows no more about it, as a stored octree does of its PARTIAL cells.
    Exhausted,
}

/// Mass properties of a solid of density 1, in model units. All intervals contain the truth, and no rounding
/// is left out.
///
/// All of it concerns the solid inside of the universe. If `clipped` is not set, that is the whole solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassProperties {
    /// Volume.
    pub volume: Interval,
    /// Centroid; `None` as long as no cell is proven full, and the solid may be empty.
    pub centroid: Option<[Interval; 3]>,
    /// Tensor of inertia about the origin of the model: ∫ (|p|² δij − pi pj) over the points p of the solid,
    /// so products of inertia are negative where the product of the coordinates is mostly positive.
    /// Symmetric.
    pub inertia_about_origin: [[Interval; 3]; 3],
    /// The same about the solid's own centroid, wherever in the interval that lies.
    pub inertia_about_centroid: [[Interval; 3]; 3],
    /// What of the solid is proven: what is not counts as undecided. Where nothing is, as of a sampled
    /// octree, the volume is only known to fit into the universe.
    pub proof: Proof,
    /// Whether the solid may go on outside of the universe, or does: the measures then are those of the part
    /// inside.
    pub clipped: bool,
    /// Why it ended.
    pub stop_reason: StopReason,
    /// Every undecided cell of a lower level was split, if the solid could.
    pub level: u8,
    /// How many times a cell was split.
    pub splits: u64,
}

/// Measures `solid` in the universe of `frame`, without building a tree: the largest undecided cells are
/// split first, until the width of the volume's interval is at most `tolerance` times its middle,
/// `max_splits` of `control` are spent, or nothing is left to split at the frame's depth. With a tolerance of
/// 0 only the latter two end it, or that no cell is undecided.
///
/// The result depends on the solid, the frame, the tolerance and `max_splits` only: it is the same bit for
/// bit for any number of threads. Time is linear in the splits; memory is that of some hundred thousand parts
/// at the most, since from a number of undecided cells on the levels below are walked through again and
/// again, each time deeper, and not kept. (That costs a third more splits, which are counted.) Other limits
/// of `control` are not heeded.
///
/// Of a cell that is not decided any part may belong to the solid, and the intervals contain what comes of
/// each choice. Volume and the diagonals of the tensors cannot be told better from the cells; products of
/// inertia and the centroid are bounded by means of the undecided cells' second moments (Loewner's order;
/// Scarf 1958).
///
/// # Errors
/// [`Error::Argument`] if `tolerance` is negative or not a number; what the solid refuses, as
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
pub fn measure<S: Solid>(
    solid: &S,
    frame: &Frame,
    tolerance: f64,
    control: &Control<'_>,
) -> Result<MassProperties, Error> {
    valid::tolerance("tolerance", tolerance)?;
    let classifier = Proven(solid.on(frame, control)?);
    let walked = walk::walk(&classifier, tolerance, control)?;
    let known = Known { frame, found: walked.found };
    Ok(MassProperties {
        volume: known.volume(),
        centroid: known.centroid(),
        inertia_about_origin: known.inertia_about_origin(),
        inertia_about_centroid: known.inertia_about_centroid(),
        proof: classifier.proof(),
        clipped: classifier.exterior() != Tag::Empty,
        stop_reason: walked.stop_reason,
        level: walked.level,
        splits: walked.splits,
    })
}
