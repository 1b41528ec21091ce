//! Sets the values in a region.

use super::fill::fill;
use super::source::{Known, Source};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Cell;
use crate::lattice::Each;
use crate::octree::channel::{Bits, Spot};
use crate::octree::{Channel, ChannelRef, OctreeRef};
use crate::solid::Verdict;
use crate::solid::stored::StoredPart;

impl ChannelRef<'_> {
    /// The channel with `value` wherever `region` is not EMPTY, and unchanged elsewhere. `None` removes
    /// values. The result is as deep as the deeper of the two, and has no metadata. (For a box, build the
    /// region from [`Csg::cuboid`](crate::Csg::cuboid).)
    ///
    /// # Errors
    /// [`Error::Argument`] if the value is beyond the type's range; [`Error::FrameMismatch`] unless both lie
    /// in one cube; [`Error::Damaged`] for damaged links; and the errors that `control` causes.
    pub fn with_value_in(
        &self,
        region: &OctreeRef<'_>,
        value: Option<[f64; 4]>,
        control: &Control<'_>,
    ) -> Result<Channel, Error> {
        let value = value.map(|value| self.value_type().encode(value)).transpose()?;
        if !self.frame().same_universe(region.frame()) {
            return Err(self.frame().mismatch(region.frame()));
        }
        region.check_links()?;
        let frame = self.frame().with_depth(self.frame().depth().max(region.frame().depth()))?;
        fill(&Edited { channel: self, region, value }, &frame, self.value_type(), control)
    }
}

struct Edited<'a> {
    channel: &'a ChannelRef<'a>,
    region: &'a OctreeRef<'a>,
    value: Option<Bits>,
}

type Part = (Verdict<StoredPart>, Spot);

impl Edited<'_> {
    fn known(&self, (verdict, spot): Part) -> Known<Part> {
        match (verdict, spot) {
            (Verdict::Full | Verdict::Undecided, _) => Known::Settled(self.value),
            (Verdict::Empty, Spot::Settled(value)) => Known::Settled(value),
            (Verdict::Partial(_), Spot::Settled(value)) if value == self.value => Known::Settled(value),
            part => Known::Open(part),
        }
    }
}

impl Source for Edited<'_> {
    type Part = Part;

    fn root(&self) -> Result<Known<Part>, Error> {
        Ok(self.known((self.region.root_verdict(), self.channel.root())))
    }

    fn split(&self, _: Cell, (verdict, spot): &Part) -> Result<[Known<Part>; 8], Error> {
        let verdicts = self.region.verdicts_below(verdict);
        let mut spots = self.channel.children(spot).into_iter();
        Ok(verdicts.each(|verdict| self.known((verdict, spots.next().unwrap_or(Spot::Settled(None))))))
    }

    /// If the links are sound, neither of the two is cut at the finest level, and no cell is left open.
    fn settle(&self, cells: &[(Cell, Part)], values: &mut [Option<Bits>]) -> Result<(), Error> {
        for (value, (_, (verdict, spot))) in values.iter_mut().zip(cells) {
            *value = match (verdict, spot) {
                (Verdict::Empty, Spot::Settled(value)) => *value,
                _ => self.value,
            };
        }
        Ok(())
    }
}
