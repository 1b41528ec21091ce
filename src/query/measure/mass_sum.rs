//! Measures of single cells of a frame, which add up exactly.

use super::bounds::Known;
use super::moments::{Moments, Tally, UNIVERSE};
use super::volume::{Found, Volume};
use super::walk::{Walked, walk_in};
use super::{MEASURE_SPLITS, MassProperties, StopReason, Tolerance};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Cell, Frame, MAX_DEPTH, valid};
use crate::octree::{Proof, Tag};
use crate::solid::{Classifier, DynSolid};
use crate::walk::Proven;

/// Bounds of the volume and the moments of a solid in some cells of its frame.
///
/// Sums are in fixed point: they are the same in any order, and a subtraction exactly reverses an addition.
/// The measures of a solid can therefore be computed cell by cell, on several machines, and added up. The sum
/// over all cells of one level equals the result of [`measure`](crate::measure), as long as the splits are
/// the same: for octrees without surfaces always, with a tolerance of 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassSum {
    frame: Frame,
    found: Found,
    proof: Proof,
    clipped: bool,
    stop_reason: StopReason,
    level: u8,
    splits: u64,
}

/// Measures the part of `solid` in one cell of `frame`, as [`measure`](crate::measure) does for the whole
/// solid. The tolerance applies to the volume in the cell. A solid that provides its moments is split all the
/// same.
///
/// # Errors
/// As [`measure`](crate::measure); [`Error::Argument`] if the frame does not have the cell.
///
/// ```
/// use leafless::query::{MassSum, measure_in};
/// use leafless::{Cell, Control, Csg, Frame, Rule, build, measure};
/// let (frame, control) = (Frame::new([-1.0; 3], 2.0, 7)?, Control::default());
/// let ball = build(&Csg::ball([0.1, 0.0, 0.0], 0.75)?, &frame, Rule::Certified, &control)?;
/// let mut sum: Option<MassSum> = None;
/// for octant in 0..8 {
///     let part = measure_in(&ball, &frame, Cell::ROOT.child(octant), 0.0, &control)?;
///     sum = Some(match sum {
///         Some(sum) => sum.plus(&part)?,
///         None => part,
///     });
/// }
/// let whole = measure(&ball, &frame, 0.0, &control)?;
/// assert_eq!(sum.unwrap().properties()?.volume, whole.volume);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn measure_in(
    solid: &dyn DynSolid,
    frame: &Frame,
    cell: Cell,
    tolerance: impl Into<Tolerance>,
    control: &Control<'_>,
) -> Result<MassSum, Error> {
    let tolerance = tolerance.into();
    valid::tolerance("tolerance", tolerance.relative)?;
    valid::tolerance("tolerance", tolerance.absolute)?;
    check(frame, cell)?;
    let classifier = Proven(solid.on(frame, control)?);
    let splits = control.max_splits.unwrap_or(MEASURE_SPLITS);
    let walked = walk_in::<Volume, _>(&classifier, cell, tolerance, splits, control)?;
    Ok(MassSum::new(&classifier, walked))
}

fn check(frame: &Frame, cell: Cell) -> Result<(), Error> {
    if cell.level <= frame.depth() && cell.at.iter().all(|&a| a >> cell.level == 0) {
        return Ok(());
    }
    Err(Error::Argument { name: "cell", problem: "is none of the frame" })
}

impl MassSum {
    pub(super) fn new<C: Classifier>(classifier: &C, walked: Walked<Found>) -> MassSum {
        MassSum {
            frame: *classifier.frame(),
            found: walked.found,
            proof: classifier.proof(),
            clipped: classifier.exterior() != Tag::Empty,
            stop_reason: walked.stop_reason,
            level: walked.level,
            splits: walked.splits,
        }
    }

    /// Builds the sum of a cell of which nothing is known. Adding it does not reduce the proof of other
    /// cells.
    ///
    /// # Errors
    /// [`Error::Argument`] if the frame does not have the cell.
    pub fn unknown(frame: &Frame, cell: Cell) -> Result<MassSum, Error> {
        check(frame, cell)?;
        let mut open = Tally::new();
        open.add(cell);
        Ok(MassSum {
            frame: *frame,
            found: Found { full: Moments::default(), open: open.finish() },
            proof: Proof::CERTIFIED,
            clipped: false,
            stop_reason: StopReason::Tolerance,
            level: cell.level,
            splits: 0,
        })
    }

    /// The frame.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Adds the sum of other cells.
    ///
    /// # Errors
    /// [`Error::FrameMismatch`]; [`Error::Argument`] if the result exceeds the universe, which means that a
    /// cell was added twice.
    pub fn plus(&self, other: &MassSum) -> Result<MassSum, Error> {
        self.with(
            other,
            Found { full: self.found.full + other.found.full, open: self.found.open + other.found.open },
        )
    }

    /// Subtracts the sum of some of the cells: the reverse of [`plus`](Self::plus). The proof and the number
    /// of splits stay as they are.
    ///
    /// # Errors
    /// [`Error::FrameMismatch`]; [`Error::Argument`] if the result is less than nothing.
    pub fn minus(&self, other: &MassSum) -> Result<MassSum, Error> {
        let less = |a: Moments, b: Moments| Moments { error: a.error - b.error, ..a - b };
        let (full, open) = (less(self.found.full, other.found.full), less(self.found.open, other.found.open));
        let with = self.with(other, Found { full, open })?;
        Ok(MassSum { proof: self.proof, clipped: self.clipped, stop_reason: self.stop_reason, ..with })
    }

    fn with(&self, other: &MassSum, found: Found) -> Result<MassSum, Error> {
        if self.frame != other.frame {
            return Err(self.frame.mismatch(&other.frame));
        }
        let of_reasons = |a: StopReason, b: StopReason| match (a, b) {
            (StopReason::Budget, _) | (_, StopReason::Budget) => StopReason::Budget,
            (StopReason::Exhausted, _) | (_, StopReason::Exhausted) => StopReason::Exhausted,
            _ => StopReason::Tolerance,
        };
        let sum = MassSum {
            frame: self.frame,
            found,
            proof: self.proof.and(other.proof),
            clipped: self.clipped || other.clipped,
            stop_reason: of_reasons(self.stop_reason, other.stop_reason),
            level: self.level.max(other.level),
            splits: self.splits.saturating_add(other.splits),
        };
        match sum.is_sound() {
            true => Ok(sum),
            false => {
                Err(Error::Argument { name: "other", problem: "overlaps the sum, or is not a part of it" })
            }
        }
    }

    /// True if all moments may be those of a set in the universe, as far as single numbers show.
    fn is_sound(&self) -> bool {
        // Lengths are less than 2^21 half grains, and the second moments have a factor of 3.
        let (first, second) = (UNIVERSE << 21, UNIVERSE << 44);
        [self.found.full, self.found.open].iter().all(|moments| {
            let slack = moments.error;
            (0..=UNIVERSE).contains(&slack)
                && (-slack..=UNIVERSE + slack).contains(&moments.volume)
                && moments.first.iter().all(|sum| (-first..=first).contains(sum))
                && moments.second.iter().all(|sum| (-second..=second).contains(sum))
        })
    }

    /// Returns the sum as bytes, for another process that adds it up. Only the same version of the library
    /// can read the bytes.
    pub fn to_bytes(&self) -> [u8; MassSum::BYTES] {
        let flags = self.proof.bits() | u8::from(self.clipped) << 2 | (self.stop_reason as u8) << 3;
        let frame = self.frame;
        let numbers = [self.proof.displacement(), frame.edge()].into_iter().chain(frame.origin());
        let sums = [self.found.full, self.found.open];
        let sums = sums.iter().flat_map(|m| [m.volume, m.error].into_iter().chain(m.first).chain(m.second));
        let head = [MassSum::VERSION, frame.depth(), self.level, flags];
        let mut bytes = [0; MassSum::BYTES];
        let all = head
            .into_iter()
            .chain(self.splits.to_le_bytes())
            .chain(numbers.flat_map(f64::to_le_bytes))
            .chain(sums.flat_map(i128::to_le_bytes));
        bytes.iter_mut().zip(all).for_each(|(byte, own)| *byte = own);
        bytes
    }

    /// Reads a sum from the bytes of [`to_bytes`](Self::to_bytes).
    ///
    /// # Errors
    /// [`Error::Argument`] if the bytes are not those of a sum.
    pub fn from_bytes(bytes: &[u8]) -> Result<MassSum, Error> {
        MassSum::read(bytes)
            .ok_or(Error::Argument { name: "bytes", problem: "must be those of a sum of measures" })
    }

    fn read(bytes: &[u8]) -> Option<MassSum> {
        let (&[MassSum::VERSION, depth, level, flags], rest) = bytes.split_first_chunk()? else {
            return None;
        };
        let (splits, mut rest) = rest.split_first_chunk()?;
        let mut number = || {
            let (number, more) = rest.split_first_chunk()?;
            rest = more;
            Some(f64::from_le_bytes(*number))
        };
        let (displacement, edge) = (number()?, number()?);
        let frame = Frame::new([number()?, number()?, number()?], edge, depth).ok()?;
        let mut sum = || {
            let (sum, more) = rest.split_first_chunk()?;
            rest = more;
            Some(i128::from_le_bytes(*sum))
        };
        let mut moments = || {
            let mut read = Moments { volume: sum()?, error: sum()?, ..Moments::default() };
            for own in read.first.iter_mut().chain(&mut read.second) {
                *own = sum()?;
            }
            Some(read)
        };
        let found = Found { full: moments()?, open: moments()? };
        let stop_reason = match flags >> 3 {
            0 => StopReason::Tolerance,
            1 => StopReason::Budget,
            2 => StopReason::Exhausted,
            _ => return None,
        };
        let proof = Proof::from_bits(flags).with_displacement(displacement).ok()?;
        let splits = u64::from_le_bytes(*splits);
        let sum = MassSum { frame, found, proof, clipped: flags & 4 != 0, stop_reason, level, splits };
        (rest.is_empty() && level <= depth && sum.is_sound()).then_some(sum)
    }

    /// The number of bytes of [`to_bytes`](Self::to_bytes).
    pub const BYTES: usize = 4 + 6 * 8 + 22 * 16;

    const VERSION: u8 = 1;

    /// Returns volume, centroid and inertia.
    ///
    /// # Errors
    /// [`Error::Argument`] if the cells of the frame at depth 20 are too small to have coordinates of their
    /// own.
    pub fn properties(&self) -> Result<MassProperties, Error> {
        let known = Known { frame: self.frame.with_depth(MAX_DEPTH)?, found: self.found };
        Ok(MassProperties {
            volume: known.volume(),
            centroid: known.centroid(),
            inertia_about_origin: known.inertia_about_origin(),
            inertia_about_centroid: known.inertia_about_centroid(),
            proof: self.proof,
            clipped: self.clipped,
            exact: false,
            stop_reason: self.stop_reason,
            level: self.level,
            splits: self.splits,
        })
    }
}
