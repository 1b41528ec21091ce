//! Fills a channel with the values of any attribute at the centres of cells.

use super::fill::fill;
use super::source::{Known, Source};
use super::{Attribute, Detail, ValueRange};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::{Bounds, Cell, Cube, Frame};
use crate::octree::channel::Bits;
use crate::octree::{Channel, OctreeRef, ValueType};
use crate::solid::Verdict;
use crate::solid::stored::StoredPart;

/// The options for filling a channel.
#[derive(Debug, Clone, Copy)]
pub struct FillOptions<'a> {
    /// The type of a value; it has as many components as the attribute.
    pub value_type: ValueType,
    /// The frame of the channel: the cube of the solid that it is for, and a depth of its own.
    pub frame: Frame,
    /// The solid inside which values matter. Where it is EMPTY, the channel has the values that take the
    /// least memory. `None` means that values matter everywhere.
    pub solid: Option<&'a OctreeRef<'a>>,
    /// The resolution at which the attribute is followed. `None` means down to the finest cells, except where
    /// a whole cell is proven to have one value.
    pub detail: Option<Detail>,
}

/// Fills a channel with the values of `attribute`. Each cell has the attribute's value at its centre, rounded
/// to the type of the values, or no value if the centre has none. Cells are as large as proven ranges and the
/// options' detail allow. The channel has no name; see [`Channel::with_name`].
///
/// Without a detail the result is the same as that of sampling every finest cell. The attribute's
/// [range](Attribute::range) shows whether all values in a cell round to one. An attribute without ranges is
/// evaluated at every finest centre: 8^depth times, or as often as the solid has cells there.
///
/// The result is the same bit for bit for any number of threads.
///
/// # Errors
/// [`Error::Argument`] if the attribute has another number of components than the type, or a value is beyond
/// the type's range; [`Error::FrameMismatch`] if the solid lies in another cube; [`Error::Damaged`] for a
/// solid with damaged links; the errors of the attribute; and the errors that `control` causes.
///
/// ```
/// use leafless::{
///     Control, Frame, attribute::{ConstantAttribute, FillOptions, ScalarType, ValueType, fill_channel},
/// };
/// let options = FillOptions {
///     value_type: ValueType::new(ScalarType::F32, 1)?,
///     frame: Frame::new([0.0; 3], 1.0, 10)?,
///     solid: None,
///     detail: None,
/// };
/// let density = fill_channel(&ConstantAttribute::new(&[7.85])?, &options, &Control::default())?;
/// assert_eq!(density.view()?.value_at([0.5; 3]), Some([7.85f32.into(), 0.0, 0.0, 0.0]));
/// assert_eq!(density.bytes(), 4);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn fill_channel(
    attribute: &dyn Attribute,
    options: &FillOptions<'_>,
    control: &Control<'_>,
) -> Result<Channel, Error> {
    let FillOptions { value_type, frame, solid, detail } = *options;
    if attribute.components() != value_type.components() {
        let problem = "must be as many as the attribute's";
        return Err(Error::Argument { name: "components", problem });
    }
    if let Some(solid) = solid {
        if !frame.same_universe(solid.frame()) {
            return Err(solid.frame().mismatch(&frame));
        }
        solid.check_links()?;
    }
    fill(&Sampled { attribute, value_type, frame, solid, detail }, &frame, value_type, control)
}

struct Sampled<'a> {
    attribute: &'a dyn Attribute,
    value_type: ValueType,
    frame: Frame,
    solid: Option<&'a OctreeRef<'a>>,
    detail: Option<Detail>,
}

/// The solid's description of the cell; `None` if the solid is EMPTY nowhere in the cell.
type Part = Option<StoredPart>;

impl Sampled<'_> {
    fn centre(&self, cell: Cell) -> [f64; 3] {
        let parts = (2u64 << cell.level) as f64;
        axes(|axis| {
            let middle = f64::from(cell.at[axis]) * 2.0 + 1.0;
            self.frame.origin()[axis] + self.frame.edge() * (middle / parts)
        })
    }

    fn encoded(&self, value: Option<[f64; 4]>) -> Result<Option<Bits>, Error> {
        value.map(|value| self.value_type.encode(value)).transpose()
    }

    fn known(&self, cell: Cell, verdict: Verdict<StoredPart>) -> Result<Known<Part>, Error> {
        let part = match verdict {
            Verdict::Empty => return Ok(Known::Free),
            Verdict::Full | Verdict::Undecided => None,
            Verdict::Partial(part) => Some(part),
        };
        if cell.level >= self.frame.depth() {
            return Ok(Known::Open(part));
        }
        let cube = Cube { frame: &self.frame, cell };
        let (min, max) = cube.bounds();
        let bounds = Bounds { min, max };
        match self.attribute.range(&bounds)? {
            ValueRange::Unknown => {}
            ValueRange::Nowhere => return Ok(Known::Settled(None)),
            ValueRange::Within(ranges) => {
                let end = |upper: bool| {
                    self.value_type.encode(ranges.each(|r| if upper { r.upper } else { r.lower })).ok()
                };
                if let (Some(low), Some(high)) = (end(false), end(true))
                    && low == high
                {
                    return Ok(Known::Settled(Some(low)));
                }
            }
        }
        if let Some(detail) = &self.detail
            && detail.is_fine(self.attribute, &bounds, 2.0 * cube.half_edge())?
        {
            let value = self.attribute.value(self.centre(cell))?;
            return Ok(Known::Settled(self.encoded(value)?));
        }
        Ok(Known::Open(part))
    }
}

impl Source for Sampled<'_> {
    type Part = Part;

    fn root(&self) -> Result<Known<Part>, Error> {
        self.known(Cell::ROOT, self.solid.map_or(Verdict::Full, OctreeRef::root_verdict))
    }

    fn split(&self, cell: Cell, part: &Part) -> Result<[Known<Part>; 8], Error> {
        let verdicts = match (self.solid, part) {
            (Some(solid), Some(part)) => solid.child_verdicts(part),
            _ => [const { Verdict::Full }; 8],
        };
        let mut children = [const { Known::Free }; 8];
        for ((child, verdict), k) in children.iter_mut().zip(verdicts).zip(0..) {
            *child = self.known(cell.child(k), verdict)?;
        }
        Ok(children)
    }

    fn settle(&self, cells: &[(Cell, Part)], values: &mut [Option<Bits>]) -> Result<(), Error> {
        let (mut points, mut found) = ([[0.0; 3]; 64], [None; 64]);
        for (point, &(cell, _)) in points.iter_mut().zip(cells) {
            *point = self.centre(cell);
        }
        let count = cells.len();
        self.attribute.values(&points[..count], &mut found[..count])?;
        for (value, found) in values.iter_mut().zip(found) {
            *value = self.encoded(found)?;
        }
        Ok(())
    }
}
