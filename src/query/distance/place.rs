//! A point on a lattice so fine that hardly any doubles lie between its planes. Distances to cells are
//! integers on this lattice.

use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::{floor, two_diff, two_product};
use crate::lattice::{Cell, Cube, Frame, Interval};

/// The edge of the universe is 2^UNITS units, or fewer for points far away.
const UNITS: u32 = 56;

/// A bound of the coordinates' distance from the universe's corner, in units. Squares of distances are
/// therefore below 2^120.
const FAR: i64 = 1 << 58;

/// The square of a distance, in units.
pub(super) type Square = u128;

/// A square greater than that of all cells.
pub(super) const NOWHERE: Square = u128::MAX;

/// A lattice point next to the queried point.
#[derive(Clone, Copy)]
pub(super) struct Place<'f> {
    frame: &'f Frame,
    at: [i64; 3],
    /// The edge of the universe is 2^bits units.
    bits: u32,
    /// A bound of the distance from the queried point, in model units.
    error: f64,
}

impl<'f> Place<'f> {
    /// Rounds a point to the lattice; `None` if a coordinate is not a finite number.
    pub(super) fn new(frame: &'f Frame, point: [f64; 3]) -> Option<Place<'f>> {
        if !point.iter().all(|c| c.is_finite()) {
            return None;
        }
        let mut bits = UNITS;
        let edges = axes(|axis| (point[axis] - frame.origin()[axis]) / frame.edge());
        let most = edges.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        while bits > frame.depth().into() && most * (1u64 << bits) as f64 >= (FAR / 2) as f64 {
            bits -= 1;
        }
        let unit = frame.edge() / (1u64 << bits) as f64;
        let (mut at, mut square) = ([0; 3], Interval::exactly(0.0));
        for axis in 0..3 {
            let nearest = |units: f64| floor(units.clamp(-FAR as f64, FAR as f64) + 0.5);
            // The quotient may be off by some units.
            let about = nearest(edges[axis] * (1u64 << bits) as f64);
            let off = rest(frame, axis, point[axis], about, unit).lower / unit;
            at[axis] = (about + nearest(off)).clamp(-FAR, FAR);
            square = square.plus(rest(frame, axis, point[axis], at[axis], unit).square());
        }
        Some(Place { frame, at, bits, error: square.root().upper })
    }

    /// The point with these lattice coordinates, in half cells; exact.
    pub(super) fn between_cells(frame: &'f Frame, half_cells: [i64; 3]) -> Place<'f> {
        let shift = UNITS - u32::from(frame.depth()) - 1;
        Place { frame, at: half_cells.each(|c| c << shift), bits: UNITS, error: 0.0 }
    }

    /// Converts a square to half cells, for a place that lies [between cells](Self::between_cells).
    pub(super) fn in_half_cells(&self, square: Square) -> Square {
        square >> (2 * (self.shift(self.frame.depth()) - 1))
    }

    /// The number of a coordinate's bits below a cell of this level.
    fn shift(&self, level: u8) -> u32 {
        self.bits - u32::from(level)
    }

    /// The squares of the distances along each axis from four successive cells of `level`; the first cell is
    /// `first`.
    pub(super) fn squares(&self, level: u8, first: [u32; 3]) -> [[Square; 4]; 3] {
        let shift = self.shift(level);
        axes(|axis| {
            [0, 1, 2, 3].each(|k| {
                let low = i64::from(first[axis] + k) << shift;
                square(gap(self.at[axis], low, low + (1 << shift)))
            })
        })
    }

    /// The square of the distance from a closed cell.
    pub(super) fn square_from(&self, cell: Cell) -> Square {
        let shift = self.shift(cell.level);
        let along = |axis: usize| {
            let low = i64::from(cell.at[axis]) << shift;
            square(gap(self.at[axis], low, low + (1 << shift)))
        };
        along(0) + along(1) + along(2)
    }

    /// The square of the distance from the space outside of the universe.
    pub(super) fn square_from_outside(&self) -> Square {
        let depth = |at: i64| at.min((1 << self.bits) - at).max(0) as u64;
        square(self.at.into_iter().map(depth).fold(u64::MAX, u64::min))
    }

    /// Converts a square to a distance from the queried point.
    pub(super) fn distance(&self, square: Square) -> Interval {
        if square == NOWHERE {
            return Interval::exactly(f64::INFINITY);
        }
        let root = square.isqrt();
        let units = if root * root == square {
            Interval::of_integer(root as i128)
        } else {
            Interval::of_integer(square as i128).root()
        };
        let distance = units.times(Interval::exactly(self.frame.edge() / (1u64 << self.bits) as f64));
        distance.plus(Interval::between(-self.error, self.error)).not_negative()
    }

    /// The point of a closed cell that is nearest to `point`, which this place represents: its coordinates
    /// are those of the point, or rounded coordinates of the cell's faces.
    pub(super) fn nearest_in(&self, cell: Cell, point: [f64; 3]) -> [f64; 3] {
        let (lower, upper) = Cube { frame: self.frame, cell }.planes();
        axes(|axis| {
            let side = |plane: u32| self.frame.side(axis, point[axis], 2 * i64::from(plane));
            if side(lower[axis]) < 0 {
                self.frame.plane(axis, lower[axis]).upper
            } else if side(upper[axis]) > 0 {
                self.frame.plane(axis, upper[axis]).lower
            } else {
                point[axis]
            }
        })
    }
}

/// x − origin − units · unit, rounded outward.
fn rest(frame: &Frame, axis: usize, x: f64, units: i64, unit: f64) -> Interval {
    // Each of the two factors has at most 31 bits, so that the products are exact as pairs.
    let coarse = units >> 28 << 28;
    let (high, low) = two_diff(x, frame.origin()[axis]);
    let (product, error) = two_product(coarse as f64, unit);
    let (fine, fine_error) = two_product((units - coarse) as f64, unit);
    let [high, low, product, error, fine, fine_error] =
        [high, low, product, error, fine, fine_error].each(Interval::exactly);
    high.minus(product).minus(fine).plus(low.minus(error.plus(fine_error)))
}

/// The distance of a coordinate from an interval.
#[inline(always)]
fn gap(at: i64, low: i64, high: i64) -> u64 {
    (low - at).max(at - high).max(0) as u64
}

#[inline(always)]
fn square(gap: u64) -> Square {
    Square::from(gap) * Square::from(gap)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_the_lattice_are_exact() {
        for depth in [1, 7, 20] {
            let frame = Frame::new([-3.0, 0.5, 1024.0], 4.0, depth).unwrap();
            for point in [[-3.0, 0.5, 1024.0], [-2.5, 7.25, 1000.0], [0.0, -0.0, 1e9], [1e-300, 0.0, 0.0]] {
                let place = Place::new(&frame, point).unwrap();
                assert!(
                    place.error <= if point[0] == 1e-300 { 1e-16 } else { 0.0 },
                    "{point:?} {}",
                    place.error
                );
            }
            let corner = Cell { level: depth, at: [0; 3] };
            let place = Place::new(&frame, [-6.0, 0.5 - 4.0, 1024.0]).unwrap();
            assert_eq!(place.distance(place.square_from(corner)), Interval::exactly(5.0));
            assert_eq!(place.nearest_in(corner, [-6.0, -3.5, 1024.0]), [-3.0, 0.5, 1024.0]);
            assert_eq!(place.square_from_outside(), 0);
            let place = Place::new(&frame, [-2.0, 3.75, 1026.0]).unwrap();
            assert_eq!(place.distance(place.square_from_outside()), Interval::exactly(0.75));
        }
    }

    #[test]
    fn rounded_points_know_by_how_much() {
        let frame = Frame::new([0.1, 0.2, 0.3], 0.7, 11).unwrap();
        for point in [[0.15, 0.25, 0.35], [0.3, -7.7, 1e12], [1e300, 0.0, -1e300], [5e-324, 0.1, 0.1]] {
            let place = Place::new(&frame, point).unwrap();
            let unit = 0.7 / (1u64 << place.bits) as f64;
            let largest = point.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
            assert!(place.error <= unit || largest > 1e20 && place.error >= largest * 0.9, "{point:?}");
            let found = place.distance(place.square_from(Cell::ROOT));
            let past = |axis: usize| {
                let low: f64 = [0.1, 0.2, 0.3][axis];
                (low - point[axis]).max(point[axis] - (low + 0.7)).max(0.0)
            };
            let about = libm::sqrt(past(0).powi(2) + past(1).powi(2) + past(2).powi(2));
            assert!(
                found.lower <= about * (1.0 + 1e-14) && found.upper >= about * (1.0 - 1e-14),
                "{found:?} {about}"
            );
        }
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(Place::new(&frame, [0.0, bad, 0.0]).is_none());
        }
    }
}
