//! A channel as an attribute: on another frame, or moved.

use super::{Attribute, ValueRange};
use crate::error::Error;
use crate::lattice::{Affine, Bounds, Cell, Cube, Window};
use crate::octree::channel::Spot;
use crate::octree::{Channel, ChannelRef};

/// The greatest number of cells that are visited for a range.
const MOST_CELLS: u32 = 512;

impl Attribute for ChannelRef<'_> {
    fn components(&self) -> usize {
        self.value_type().components()
    }

    fn values(&self, points: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) -> Result<(), Error> {
        self.values_at(points, values);
        Ok(())
    }

    /// The range of the values of all cells that the box meets; unknown if there are too many cells.
    fn range(&self, bounds: &Bounds) -> Result<ValueRange, Error> {
        let Some((window, outside)) = Window::new(self.frame(), bounds.min, bounds.max)? else {
            return Ok(ValueRange::Nowhere);
        };
        let mut met = Met { channel: self, window, range: None, left: MOST_CELLS };
        if outside {
            met.add(None);
        }
        met.walk(Cell::ROOT, &self.root());
        Ok(met.range.unwrap_or(ValueRange::Nowhere))
    }
}

impl Attribute for Channel {
    fn components(&self) -> usize {
        self.value_type().components()
    }

    fn values(&self, points: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) -> Result<(), Error> {
        Attribute::values(self.view()?, points, values)
    }

    fn range(&self, bounds: &Bounds) -> Result<ValueRange, Error> {
        Attribute::range(self.view()?, bounds)
    }

    fn kept_bytes(&self) -> u64 {
        self.bytes()
    }
}

/// The values found in a window so far.
struct Met<'a> {
    channel: &'a ChannelRef<'a>,
    window: Window,
    range: Option<ValueRange>,
    left: u32,
}

impl Met<'_> {
    fn add(&mut self, value: Option<[f64; 4]>) {
        let fresh = ValueRange::exactly(value);
        self.range = Some(match (self.range, fresh) {
            (None, fresh) => fresh,
            (Some(ValueRange::Nowhere), ValueRange::Nowhere) => fresh,
            (Some(ValueRange::Within(mut known)), ValueRange::Within(fresh)) => {
                for (known, fresh) in known.iter_mut().zip(fresh) {
                    *known = known.joined(fresh);
                }
                ValueRange::Within(known)
            }
            _ => ValueRange::Unknown,
        });
    }

    fn walk(&mut self, cell: Cell, spot: &Spot) {
        if self.left == 0 {
            self.range = Some(ValueRange::Unknown);
        }
        if self.range == Some(ValueRange::Unknown)
            || !self.window.meets(&Cube { frame: self.channel.frame(), cell })
        {
            return;
        }
        self.left -= 1;
        match spot {
            Spot::Settled(value) => self.add(value.map(|bits| self.channel.value_type().decode(bits))),
            Spot::Split(_) => {
                for (spot, k) in self.channel.children(spot).iter().zip(0..) {
                    self.walk(cell.child(k), spot);
                }
            }
        }
    }
}

/// An attribute in another place: its value at a point is that of another attribute at the image of the point
/// under a map.
///
/// To carry a channel along with a solid that was moved by a placement, `back` is the inverse of the
/// placement.
#[derive(Debug, Clone, Copy)]
pub struct MovedAttribute<A> {
    attribute: A,
    back: Affine,
}

impl<A: Attribute> MovedAttribute<A> {
    /// Makes the attribute whose value at p is that of `attribute` at `back` applied to p.
    pub fn new(attribute: A, back: Affine) -> MovedAttribute<A> {
        MovedAttribute { attribute, back }
    }
}

impl<A: Attribute> Attribute for MovedAttribute<A> {
    fn components(&self) -> usize {
        self.attribute.components()
    }

    fn kept_bytes(&self) -> u64 {
        self.attribute.kept_bytes()
    }

    fn values(&self, points: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) -> Result<(), Error> {
        let mut moved = [[0.0; 3]; 64];
        for (points, values) in points.chunks(moved.len()).zip(values.chunks_mut(moved.len())) {
            for (moved, &point) in moved.iter_mut().zip(points) {
                *moved = self.back.apply(point);
            }
            self.attribute.values(&moved[..points.len()], values)?;
        }
        Ok(())
    }

    fn range(&self, bounds: &Bounds) -> Result<ValueRange, Error> {
        // A point of the box may be rounded out of the exact image, so the image is a little larger.
        match bounds.placed(&self.back) {
            Some(image) => {
                // Summands that cancel have rounding errors that may exceed the size of the image.
                let reach = |axis: usize| bounds.min[axis].abs().max(bounds.max[axis].abs());
                let summands = |row: &[f64; 4]| {
                    (0..3).fold(row[3].abs(), |sum, axis| sum + row[axis].abs() * reach(axis))
                };
                let largest = self.back.rows().iter().map(summands).fold(0.0, f64::max);
                self.attribute.range(&image.grown(4.0 * f64::EPSILON * largest))
            }
            None => Ok(ValueRange::Unknown),
        }
    }
}
