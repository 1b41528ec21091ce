//! The part of a solid in which a channel's values lie in a band.

use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Bounds, Cell, Frame};
use crate::memory;
use crate::octree::channel::{Bits, Spot};
use crate::octree::{ChannelRef, Octree, Proof, Tag, ValueType};
use crate::op::{Rule, build};
use crate::solid::{Batch, Classifier, Direct, Parts, Question, Solid, Verdict, WholeQuestion, Worker};
use alloc::vec::Vec;

/// The part of a solid in which the values of a channel lie in a band: one material of a part, or everything
/// hotter than a limit. The region is a solid itself, and lies in the channel's cube.
///
/// Where the channel has one value, the region gives the solid's own answers. So a region of a solid with
/// [enclosures](crate::solid::Enclosure) is measured as fast as the solid.
#[derive(Debug, Clone, Copy)]
pub struct ValueRegion<'a, S> {
    solid: S,
    channel: &'a ChannelRef<'a>,
    band: Band,
}

#[derive(Debug, Clone, Copy)]
struct Band {
    value_type: ValueType,
    low: [f64; 4],
    high: [f64; 4],
}

impl Band {
    fn contains(&self, value: Option<Bits>) -> bool {
        value.is_some_and(|bits| {
            let value = self.value_type.decode(bits);
            (0..self.value_type.components()).all(|k| self.low[k] <= value[k] && value[k] <= self.high[k])
        })
    }
}

impl<'a, S: Solid> ValueRegion<'a, S> {
    /// Makes the region of the points of `solid` at which every component of the value lies between those of
    /// `low` and `high`, both included. Numbers beyond the components do not count. Points without a value do
    /// not belong to the region.
    ///
    /// # Errors
    /// [`Error::Argument`] if a bound is NaN; [`Error::Damaged`] for a channel with damaged links.
    pub fn new(
        solid: S,
        channel: &'a ChannelRef<'a>,
        low: [f64; 4],
        high: [f64; 4],
    ) -> Result<ValueRegion<'a, S>, Error> {
        let value_type = channel.value_type();
        if (0..value_type.components()).any(|k| low[k].is_nan() || high[k].is_nan()) {
            return Err(Error::Argument { name: "band", problem: "must be numbers" });
        }
        channel.check_links()?;
        Ok(ValueRegion { solid, channel, band: Band { value_type, low, high } })
    }
}

impl ChannelRef<'_> {
    /// Builds the region of the cells whose values lie between `low` and `high`, component by component, both
    /// included, as a binary octree of the channel's own frame. See [`ValueRegion`]. The cells' proofs
    /// concern the values in the channel, not the source from which the channel was filled.
    ///
    /// # Errors
    /// Those of [`ValueRegion::new`], and the errors that `control` causes.
    pub fn region(&self, low: [f64; 4], high: [f64; 4], control: &Control<'_>) -> Result<Octree, Error> {
        let all = Octree::uniform(*self.frame(), Tag::Full, Tag::Empty)?;
        build(&ValueRegion::new(all.view(), self, low, high)?, self.frame(), Rule::Certified, control)
    }
}

impl<'a, S: Solid> Solid for ValueRegion<'a, S> {
    type Classifier = RegionOnFrame<'a, S::Classifier>;

    fn on(&self, frame: &Frame, control: &Control<'_>) -> Result<Self::Classifier, Error> {
        if !self.channel.frame().same_universe(frame) {
            return Err(self.channel.frame().mismatch(frame));
        }
        Ok(RegionOnFrame { solid: self.solid.on(frame, control)?, channel: self.channel, band: self.band })
    }

    fn bounds(&self) -> Option<Bounds> {
        let cube = Bounds::of(self.channel.frame());
        self.solid.bounds().map_or(Some(cube), |bounds| bounds.common(&cube).or(Some(cube)))
    }

    fn home(&self) -> Option<Frame> {
        Some(*self.channel.frame())
    }

    /// Counts the solid only: the channel is borrowed.
    fn kept_bytes(&self) -> u64 {
        self.solid.kept_bytes()
    }
}

/// A region on a frame: both handle and worker.
#[derive(Debug, Clone)]
pub struct RegionOnFrame<'a, C> {
    solid: C,
    channel: &'a ChannelRef<'a>,
    band: Band,
}

impl<'a, C: Classifier> Classifier for RegionOnFrame<'a, C> {
    type Worker = RegionOnFrame<'a, C::Worker>;

    fn frame(&self) -> &Frame {
        self.solid.frame()
    }

    fn worker(&self) -> Result<Self::Worker, Error> {
        Ok(RegionOnFrame { solid: self.solid.worker()?, channel: self.channel, band: self.band })
    }

    /// A channel has no values outside its cube.
    fn exterior(&self) -> Tag {
        Tag::Empty
    }

    fn proof(&self) -> Proof {
        self.solid.proof()
    }

    /// The solid's answers do not take values into account. Only its answer that a point lies outside holds
    /// for the region.
    fn answer_whole(&self, question: WholeQuestion<'_>, control: &Control<'_>) -> Result<(), Error> {
        match question {
            WholeQuestion::Direct(Direct::Points, _) => self.solid.answer_whole(question, control),
            _ => Ok(()),
        }
    }

    fn kept_bytes(&self) -> u64 {
        self.solid.kept_bytes()
    }
}

/// The data about a cell of a region.
#[derive(Clone)]
pub enum RegionPart<P> {
    /// All values lie in the band, and the solid is open.
    Solid(P),
    /// The solid is FULL, or (`true`) undecided and not to be split, and the values change.
    Values(ChannelSpot, bool),
    /// Both are open.
    Both(P, ChannelSpot),
}

/// The place of a cell's description in a channel.
#[derive(Clone, Copy)]
pub struct ChannelSpot(Spot);

impl<C> RegionOnFrame<'_, C> {
    fn verdict<P>(&self, solid: Verdict<P>, spot: Spot) -> Verdict<RegionPart<P>> {
        match (solid, spot) {
            (Verdict::Empty, _) => Verdict::Empty,
            (solid, Spot::Settled(value)) => match solid {
                _ if !self.band.contains(value) => Verdict::Empty,
                Verdict::Partial(part) => Verdict::Partial(RegionPart::Solid(part)),
                Verdict::Full => Verdict::Full,
                _ => Verdict::Undecided,
            },
            (Verdict::Full, spot) => Verdict::Partial(RegionPart::Values(ChannelSpot(spot), false)),
            (Verdict::Undecided, spot) => Verdict::Partial(RegionPart::Values(ChannelSpot(spot), true)),
            (Verdict::Partial(part), spot) => Verdict::Partial(RegionPart::Both(part, ChannelSpot(spot))),
        }
    }
}

impl<W: Worker> Parts for RegionOnFrame<'_, W> {
    type Part = RegionPart<W::Part>;

    fn mark(&self) -> usize {
        self.solid.mark()
    }

    fn release(&mut self, mark: usize) {
        self.solid.release(mark);
    }

    fn scratch_bytes(&self) -> usize {
        self.solid.scratch_bytes()
    }

    fn hand_over(&mut self, from: &Self, part: &Self::Part) -> Result<Self::Part, Error> {
        Ok(match part {
            RegionPart::Solid(part) => RegionPart::Solid(self.solid.hand_over(&from.solid, part)?),
            RegionPart::Both(part, spot) => RegionPart::Both(self.solid.hand_over(&from.solid, part)?, *spot),
            RegionPart::Values(spot, open) => RegionPart::Values(*spot, *open),
        })
    }
}

impl<W: Worker> Batch for RegionOnFrame<'_, W> {
    fn likes_many(&self) -> bool {
        self.solid.likes_many()
    }

    fn split_many(
        &mut self,
        cells: &[(Cell, Self::Part)],
        control: &Control<'_>,
        verdicts: &mut Vec<[Verdict<Self::Part>; 8]>,
    ) -> Result<(), Error> {
        verdicts.try_reserve(cells.len())?;
        let mut asked = memory::with_capacity(cells.len())?;
        asked.extend(cells.iter().filter_map(|(cell, part)| Some((*cell, part.of_solid()?.clone()))));
        let mut found = Vec::new();
        let done = self.solid.split_many(&asked, control, &mut found);
        let mut found = found.into_iter();
        for (_, part) in cells {
            let solids = match part.of_solid().map(|_| found.next()) {
                // The solid's answers ended early.
                Some(None) => break,
                Some(Some(verdicts)) => Some(verdicts),
                None => None,
            };
            verdicts.push(self.children(part, solids));
        }
        done
    }

    fn sample_many(
        &mut self,
        cells: &[(Cell, Self::Part)],
        control: &Control<'_>,
        inside: &mut Vec<Option<bool>>,
    ) -> Result<(), Error> {
        inside.try_reserve(cells.len())?;
        let mut asked = memory::with_capacity(cells.len())?;
        asked.extend(cells.iter().filter_map(|(cell, part)| match part {
            RegionPart::Solid(part) => Some((*cell, part.clone())),
            RegionPart::Values(..) | RegionPart::Both(..) => None,
        }));
        let mut found = Vec::new();
        let done = self.solid.sample_many(&asked, control, &mut found);
        let mut found = found.into_iter();
        for (_, part) in cells {
            match part {
                RegionPart::Solid(_) => match found.next() {
                    Some(answer) => inside.push(answer),
                    None => break,
                },
                _ => inside.push(None),
            }
        }
        done
    }

    /// A point of the solid may have any value, so that only the answer "outside" is kept.
    fn inside(&mut self, points: &[[f64; 3]], answers: &mut [Option<bool>]) -> Result<(), Error> {
        self.solid.inside(points, answers)?;
        answers.iter_mut().for_each(|answer| *answer = answer.filter(|&inside| !inside));
        Ok(())
    }

    /// The channel's description of a cell needs the path to it.
    fn recall(&mut self, _: Cell) -> Option<Self::Part> {
        None
    }
}

impl<P> RegionPart<P> {
    /// The part of the solid.
    fn of_solid(&self) -> Option<&P> {
        match self {
            RegionPart::Solid(part) | RegionPart::Both(part, _) => Some(part),
            RegionPart::Values(..) => None,
        }
    }
}

impl<W: Worker> RegionOnFrame<'_, W> {
    /// The children of a cell; `solid` holds those of the solid if it is open there.
    fn children(
        &self,
        part: &RegionPart<W::Part>,
        solids: Option<[Verdict<W::Part>; 8]>,
    ) -> [Verdict<RegionPart<W::Part>>; 8] {
        let (solids, spot) = match (part, solids) {
            (RegionPart::Solid(_), Some(solids)) => return solids.each(|solid| solid.map(RegionPart::Solid)),
            (RegionPart::Both(_, spot), Some(solids)) => (solids, spot),
            (RegionPart::Values(spot, false), _) => ([const { Verdict::Full }; 8], spot),
            (RegionPart::Values(spot, true) | RegionPart::Both(_, spot), _) => {
                ([const { Verdict::Undecided }; 8], spot)
            }
            (RegionPart::Solid(_), None) => return [const { Verdict::Undecided }; 8],
        };
        let mut spots = self.channel.children(&spot.0).into_iter();
        solids.each(|solid| self.verdict(solid, spots.next().unwrap_or(Spot::Settled(None))))
    }
}

impl<W: Worker> Worker for RegionOnFrame<'_, W> {
    fn frame(&self) -> &Frame {
        self.solid.frame()
    }

    fn root(&mut self) -> Result<Verdict<Self::Part>, Error> {
        let solid = self.solid.root()?;
        Ok(self.verdict(solid, self.channel.root()))
    }

    fn split(&mut self, cell: Cell, part: &Self::Part) -> Result<[Verdict<Self::Part>; 8], Error> {
        let solids = part.of_solid().map(|part| self.solid.split(cell, part)).transpose()?;
        Ok(self.children(part, solids))
    }

    /// Where all values lie in the band, the region is the solid.
    fn answer(&mut self, cell: Cell, part: &Self::Part, question: Question<'_>) -> Result<(), Error> {
        match part {
            RegionPart::Solid(part) => self.solid.answer(cell, part, question),
            RegionPart::Values(..) | RegionPart::Both(..) => Ok(()),
        }
    }
}
