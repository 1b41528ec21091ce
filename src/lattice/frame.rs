//! The position of the lattice in model space.

use super::array::Each;
use super::axes;
use super::exact::{DoubleDouble, Expansion, floor, sign_of_sum, two_diff, two_product, two_sum};
use super::{Interval, MAX_DEPTH, valid};
use crate::error::{Error, MeshError};

/// The position of a tree: the cube `[origin, origin + edge]³` in model units, divided into 2^depth cells per
/// axis.
///
/// The lattice planes are the *real* numbers origin + i·edge/2^depth, whether or not they are representable;
/// comparisons with them are exact.
///
/// ```
/// use leafless::Frame;
/// let frame = Frame::new([0.0; 3], 1.0, 4)?;
/// assert_eq!(frame.cell_size(), 0.0625);
/// assert_eq!(frame.cell_at(0, 0.3), Some(4));
/// assert_eq!(frame.cell_at(0, 1.1), None);
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    origin: [f64; 3],
    edge: f64,
    depth: u8,
    // Derived from the two numbers above, and kept because every query needs them.
    cell: f64,
    per_unit: f64,
}

impl Frame {
    /// Makes a universe with its lower corner at `origin` (model units; each coordinate is zero or of a
    /// magnitude between 2^-256 and 2^256), the edge length `edge` (2^-256 to 2^256) and `depth` (1 to
    /// [`MAX_DEPTH`]) levels.
    ///
    /// # Errors
    /// [`Error::Argument`] names the parameter that is out of range.
    pub fn new(origin: [f64; 3], edge: f64, depth: u8) -> Result<Frame, Error> {
        valid::numbers("origin", &origin)?;
        valid::length("edge", edge)?;
        if !(1..=MAX_DEPTH).contains(&depth) {
            return Err(Error::Argument { name: "depth", problem: "must be 1 to 20" });
        }
        let cells = (1u32 << depth) as f64;
        Ok(Frame {
            origin: origin.each(|c| c + 0.0),
            edge,
            depth,
            cell: edge / cells,
            per_unit: cells / edge,
        })
    }

    /// Makes a frame around a shape with the bounds `min`, `max`: a cube of edge L·(1 + 1/32) with the same
    /// centre, where L is the longest extent of the shape. The universe is the same at every depth. For parts
    /// with round dimensions [`aligned`](Self::aligned) is better.
    ///
    /// # Errors
    /// [`MeshError::NoExtent`] if L is zero; [`Error::Argument`] if min > max on an axis, or if a bound is
    /// not a finite number in range. Also [`Error::Argument`] if a bound lies so far from the origin that
    /// doubles cannot resolve the cube around it.
    pub fn around(min: [f64; 3], max: [f64; 3], depth: u8) -> Result<Frame, Error> {
        let edge = longest_extent(min, max)? * (1.0 + 1.0 / 32.0);
        let frame = Frame::new(axes(|axis| centred(min[axis], max[axis], edge)), edge, depth)?;
        if frame.holds(min, max) { Ok(frame) } else { Err(UNRESOLVED) }
    }

    /// Makes the frame [`around`](Self::around) a shape whose finest cells are no longer than a tolerance:
    /// the greater of `absolute` (model units) and `relative` times the longest extent. The frame has the
    /// least such depth. Where 20 levels do not suffice, it has 20. A tolerance of zero also gives 20 levels,
    /// which suits [`build_extended`](crate::build_extended) of exact surfaces: their cells end at any size.
    ///
    /// # Errors
    /// As [`around`](Self::around); [`Error::Argument`] if a tolerance is negative or NaN.
    ///
    /// ```
    /// use leafless::Frame;
    /// let ([min, max], depth) = ([[0.0; 3], [100.0, 60.0, 30.0]], |frame: Frame| frame.depth());
    /// assert_eq!(depth(Frame::to_tolerance(min, max, 0.2, 0.0)?), 10);
    /// assert_eq!(depth(Frame::to_tolerance(min, max, 0.0, 1e-3)?), 11);
    /// assert_eq!(depth(Frame::to_tolerance(min, max, 0.0, 0.0)?), 20);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn to_tolerance(min: [f64; 3], max: [f64; 3], absolute: f64, relative: f64) -> Result<Frame, Error> {
        valid::tolerance("absolute tolerance", absolute)?;
        valid::tolerance("relative tolerance", relative)?;
        let tolerance = absolute.max(relative * longest_extent(min, max)?);
        let frame = Frame::around(min, max, MAX_DEPTH)?;
        let fits = |depth: u8| frame.with_depth(depth).is_ok_and(|frame| frame.cell_size() <= tolerance);
        frame.with_depth((1..MAX_DEPTH).find(|&depth| fits(depth)).unwrap_or(MAX_DEPTH))
    }

    /// Makes a frame with round lattice planes around a shape with the bounds `min`, `max`. The cell size is
    /// a power of two, and the origin is a multiple of as great a power of two as possible. Faces at 25, 12.5
    /// or −0.75 then lie on lattice planes. Such a face needs no cells along it, and the certified volume is
    /// exact there. For example, a part of 100 × 60 × 30 with four bores and four rounded edges is an octree
    /// of 30 820 nodes at depth 9, and its volume to 2 % takes 419 splits. With [`around`](Self::around) it
    /// takes 208 377 nodes and 2 177 splits. (For solids without slabs, such as octrees, the splits differ by
    /// a factor of a hundred.)
    ///
    /// The edge is the smallest power of two whose cube can hold the bounds. So the edge is up to twice their
    /// longest extent, and cells are up to twice as long as those of [`around`](Self::around). On each axis a
    /// 128th of the edge is left free on both sides where there is room. The universe is the same at every
    /// depth.
    ///
    /// # Errors
    /// As [`around`](Self::around).
    ///
    /// ```
    /// use leafless::Frame;
    /// let frame = Frame::aligned([0.0; 3], [100.0, 60.0, 30.0], 9)?;
    /// assert_eq!((frame.origin(), frame.edge(), frame.cell_size()), ([-16.0, -64.0, -64.0], 128.0, 0.25));
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn aligned(min: [f64; 3], max: [f64; 3], depth: u8) -> Result<Frame, Error> {
        let longest = longest_extent(min, max)?;
        let mut edge = power_of_two_from(longest);
        // If the bounds are as long as the edge, no origin on the lattice may fit. With twice the edge one
        // does.
        for _ in 0..2 {
            if let Some(origin) = aligned_origin(min, max, edge) {
                let frame = Frame::new(origin, edge, depth)?;
                if frame.holds(min, max) {
                    return Ok(frame);
                }
            }
            edge *= 2.0;
        }
        Err(UNRESOLVED)
    }

    /// Makes a frame with cells of the edge length `cell` (model units, 2^-256 to 2^256) around a shape with
    /// the bounds `min`, `max`. Its origin is a multiple of `cell` times as great a power of two as possible.
    /// The depth is the least that holds the bounds, so edge = cell · 2^depth. With `cell` = 0.25 the lattice
    /// planes are the multiples of 0.25. (Doubles are binary fractions: with a `cell` of 0.1 the planes are
    /// multiples of the double nearest to 0.1, and these are not the doubles nearest to 0.3 or 0.7.)
    ///
    /// # Errors
    /// As [`around`](Self::around); [`Error::Argument`] if `cell` is out of range, or if more than 2^20 cells
    /// would be needed on an axis.
    ///
    /// ```
    /// use leafless::Frame;
    /// let frame = Frame::with_cells([0.0; 3], [100.0, 60.0, 30.0], 0.5)?;
    /// assert_eq!((frame.origin(), frame.edge(), frame.depth()), ([-16.0, -64.0, -64.0], 128.0, 8));
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn with_cells(min: [f64; 3], max: [f64; 3], cell: f64) -> Result<Frame, Error> {
        longest_extent(min, max)?;
        valid::length("cell", cell)?;
        for depth in 1..=MAX_DEPTH {
            let edge = cell * (1u32 << depth) as f64;
            let Some(origin) = aligned_origin(min, max, edge) else { continue };
            let frame = Frame::new(origin, edge, depth)?;
            if frame.holds(min, max) {
                return Ok(frame);
            }
        }
        Err(Error::Argument { name: "cell", problem: "so small that the bounds take more than 2^20 cells" })
    }

    /// Makes the frame that suits a shape with the bounds `min`, `max`, the default of the program
    /// `leafless`. It is [`aligned`](Self::aligned) if all bounds are multiples of 2^-12 of its edge, as is
    /// common for parts that people draw; otherwise it is [`around`](Self::around). The universe is the same
    /// at every depth.
    ///
    /// # Errors
    /// As [`around`](Self::around).
    pub fn fitted(min: [f64; 3], max: [f64; 3], depth: u8) -> Result<Frame, Error> {
        if let Ok(aligned) = Frame::aligned(min, max, depth) {
            let unit = aligned.edge / 4096.0;
            if min.iter().chain(&max).all(|bound| bound % unit == 0.0) {
                return Ok(aligned);
            }
        }
        Frame::around(min, max, depth)
    }

    /// Returns whether the universe contains the box from `min` to `max`; exact.
    fn holds(&self, min: [f64; 3], max: [f64; 3]) -> bool {
        let top = 2 * self.cells() as i64;
        (0..3).all(|axis| self.side(axis, min[axis], 0) >= 0 && self.side(axis, max[axis], top) <= 0)
    }

    /// The error for two frames that should be equal.
    pub(crate) fn mismatch(&self, other: &Frame) -> Error {
        Error::FrameMismatch {
            origins: [self.origin, other.origin],
            edges: [self.edge, other.edge],
            depths: [self.depth, other.depth],
        }
    }

    /// Makes a frame of the same universe with another depth.
    ///
    /// # Errors
    /// [`Error::Argument`] if `depth` is not 1 to [`MAX_DEPTH`].
    pub fn with_depth(&self, depth: u8) -> Result<Frame, Error> {
        Frame::new(self.origin, self.edge, depth)
    }

    /// The lower corner of the universe, in model units.
    pub fn origin(&self) -> [f64; 3] {
        self.origin
    }

    /// The edge length of the universe, in model units.
    pub fn edge(&self) -> f64 {
        self.edge
    }

    /// The number of levels below the universe; the finest lattice has 2^depth cells per axis.
    #[inline]
    pub fn depth(&self) -> u8 {
        self.depth
    }

    /// The number of finest cells per axis, 2^depth.
    #[inline]
    pub fn cells(&self) -> u32 {
        1 << self.depth
    }

    /// The edge length of a finest cell, in model units: edge / 2^depth, exact.
    pub fn cell_size(&self) -> f64 {
        self.cell
    }

    /// Returns whether both frames have the same universe; the depths may differ.
    pub fn same_universe(&self, other: &Frame) -> bool {
        self.origin == other.origin && self.edge == other.edge
    }

    /// The tightest interval of doubles that contains lattice plane `i` (0 ≤ i ≤ 2^depth) of `axis`.
    pub fn plane(&self, axis: usize, i: u32) -> Interval {
        // `i` has at most 21 bits, so that the product has an error term: the plane is the sum of three
        // doubles.
        let (product, product_error) = two_product(i as f64, self.cell);
        let (sum, sum_error) = two_sum(self.origin[axis], product);
        let rounded = sum + (sum_error + product_error);
        match sign_of_sum(&[sum, sum_error, product_error, -rounded]) {
            0 => Interval::exactly(rounded),
            1 => Interval::between(rounded, rounded.next_up()),
            _ => Interval::between(rounded.next_down(), rounded),
        }
    }

    /// `x − (origin + k·cell/2)` on an axis: the distance of a coordinate from a lattice plane (even k) or
    /// from a plane of cell centres (odd k).
    pub(crate) fn offset(&self, axis: usize, x: f64, k: i64) -> Expansion {
        Expansion::sum(self.offset_terms(axis, x, k))
    }

    /// The exact sign of `x − (origin + k·cell/2)` on `axis`: even k are lattice planes, odd k cell centres.
    pub(crate) fn side(&self, axis: usize, x: f64, k: i64) -> i32 {
        sign_of_sum(&self.offset_terms(axis, x, k))
    }

    /// As [`offset`](Self::offset), rounded outward. The width is tiny if `x` lies near the plane.
    pub(crate) fn rounded_offset(&self, axis: usize, x: f64, k: i64) -> Interval {
        let [a, b, c, d] = self.offset_terms(axis, x, k).each(Interval::exactly);
        c.plus(d).plus(a.plus(b))
    }

    /// As [`offset`](Self::offset), in about 106 bits.
    #[inline]
    pub(crate) fn near_offset(&self, axis: usize, x: f64, k: i64) -> DoubleDouble {
        let [low, error, high, product] = self.offset_terms(axis, x, k);
        DoubleDouble::sum(high, product) + DoubleDouble::sum(low, error)
    }

    #[inline(always)]
    fn offset_terms(&self, axis: usize, x: f64, k: i64) -> [f64; 4] {
        let (high, low) = two_diff(x, self.origin[axis]);
        let (product, error) = two_product(k as f64, 0.5 * self.cell);
        [low, -error, high, -product]
    }

    /// `(x − origin) / cell` on `axis`: lattice coordinates, with a relative error below 2^-51.
    #[inline(always)]
    pub(crate) fn scaled(&self, axis: usize, x: f64) -> f64 {
        (x - self.origin[axis]) * self.per_unit
    }

    /// A length in cells, with a relative error below 2^-51.
    #[inline(always)]
    pub(crate) fn scaled_length(&self, length: f64) -> f64 {
        length * self.per_unit
    }

    /// The index along `axis` of the finest cell that contains the model coordinate `x`. The universe's upper
    /// face belongs to the last cell. `None` outside the universe and for NaN. Exact for every double.
    #[inline]
    pub fn cell_at(&self, axis: usize, x: f64) -> Option<u32> {
        let (cell, sure) = self.cell_nearby(axis, x);
        if sure && cell < self.cells() as u64 { Some(cell as u32) } else { self.cell_at_exactly(axis, x) }
    }

    /// The indices of the finest cell that contains a model point; see [`cell_at`](Self::cell_at).
    #[inline(always)]
    pub fn cell_of(&self, point: [f64; 3]) -> Option<[u32; 3]> {
        let (x, x_sure) = self.cell_nearby(0, point[0]);
        let (y, y_sure) = self.cell_nearby(1, point[1]);
        let (z, z_sure) = self.cell_nearby(2, point[2]);
        // The number of cells is a power of two, so that one comparison decides whether all three indices are
        // cells.
        if x_sure & y_sure & z_sure && (x | y | z) < self.cells() as u64 {
            return Some([x as u32, y as u32, z as u32]);
        }
        self.cell_of_exactly(point)
    }

    /// The first and the last finest cell along `axis` whose interior meets `[min, max]` (numbers, min ≤
    /// max), and whether a part of the range lies outside the universe. `None` if the whole range does.
    pub(crate) fn cells_between(&self, axis: usize, min: f64, max: f64) -> Option<(u32, u32, bool)> {
        let cells = self.cells();
        // Far outside, the comparison with a plane needs no exactness, but must not overflow.
        const FAR: f64 = f64::from_bits((1023 + 400) << 52);
        let (min, max) = (min.clamp(-FAR, FAR), max.clamp(-FAR, FAR));
        let (low, high) = (0, 2 * cells as i64);
        // A range with thickness that only touches the universe shares no cell with it. A range without
        // thickness may lie in the face.
        let thick = (min < max) as i32;
        if self.side(axis, max, low) < thick || self.side(axis, min, high) > -thick {
            return None;
        }
        let (below, above) = (self.side(axis, min, low) < 0, self.side(axis, max, high) > 0);
        let first = if below { 0 } else { self.cell_at(axis, min)? };
        let mut last = if above { cells - 1 } else { self.cell_at(axis, max)? };
        if last > first && self.side(axis, max, 2 * last as i64) == 0 {
            last -= 1;
        }
        Some((first, last, below || above))
    }

    /// The lattice coordinate of `x`, rounded down, and whether rounding errors cannot have changed it. A
    /// coordinate outside the universe gives a number that is no cell, or an unsure one.
    #[inline(always)]
    fn cell_nearby(&self, axis: usize, x: f64) -> (u64, bool) {
        // Adding this leaves the nearest integer in the low bits. (NaN and far coordinates give other bits.)
        const SHIFT: f64 = (3u64 << 51) as f64;
        // Inside the universe the scaled coordinate is at most 2^20 and its error below 2^-31.
        const SURE: f64 = 0.5 - 1.0 / (1u64 << 30) as f64;
        let scaled = self.scaled(axis, x) - 0.5;
        let shifted = scaled + SHIFT;
        let cell = shifted.to_bits().wrapping_sub(SHIFT.to_bits());
        (cell, (scaled - (shifted - SHIFT)).abs() < SURE)
    }

    #[cold]
    fn cell_of_exactly(&self, point: [f64; 3]) -> Option<[u32; 3]> {
        Some([self.cell_at(0, point[0])?, self.cell_at(1, point[1])?, self.cell_at(2, point[2])?])
    }

    #[cold]
    fn cell_at_exactly(&self, axis: usize, x: f64) -> Option<u32> {
        let cells = self.cells() as i64;
        let scaled = self.scaled(axis, x);
        if !(scaled > -1.0 && scaled < cells as f64 + 1.0) {
            return None;
        }
        let nearest = floor(scaled + 0.5);
        match self.side(axis, x, 2 * nearest) {
            // Exactly on a plane: the cell above it, or the last one on the universe's upper face.
            0 if nearest == cells => Some(cells as u32 - 1),
            0 | 1 if (0..cells).contains(&nearest) => Some(nearest as u32),
            -1 if (1..=cells).contains(&nearest) => Some(nearest as u32 - 1),
            _ => None,
        }
    }
}

const UNRESOLVED: Error =
    Error::Argument { name: "bounds", problem: "so far from the origin that doubles cannot resolve them" };

/// The longest extent of a box; an error if it is zero.
fn longest_extent(min: [f64; 3], max: [f64; 3]) -> Result<f64, Error> {
    valid::ordered("bounds", min, max)?;
    let longest = (0..3).fold(0.0, |longest: f64, axis| longest.max(max[axis] - min[axis]));
    if longest == 0.0 { Err(MeshError::NoExtent.into()) } else { Ok(longest) }
}

/// The origin of an edge whose middle is the middle between `min` and `max`.
fn centred(min: f64, max: f64, edge: f64) -> f64 {
    (min + (max - min) / 2.0) - edge / 2.0
}

/// The least power of two that is not less than a positive number.
fn power_of_two_from(x: f64) -> f64 {
    let power = f64::from_bits(x.to_bits() & f64::INFINITY.to_bits());
    if power < x { 2.0 * power } else { power }
}

/// The origin of a universe of this edge around a box. On each axis it is the multiple of edge / 2^k with the
/// least k, at most [`MAX_DEPTH`]. `None` if an axis has no such multiple.
fn aligned_origin(min: [f64; 3], max: [f64; 3], edge: f64) -> Option<[f64; 3]> {
    let mut origin = [0.0; 3];
    for axis in 0..3 {
        let margin = edge / 128.0;
        let (least, greatest) = (max[axis] - edge, min[axis]);
        let roomy = nearest_multiple(least + margin, greatest - margin, edge);
        origin[axis] = roomy.or_else(|| nearest_multiple(least, greatest, edge))?;
    }
    Some(origin)
}

/// The multiple of edge / 2^k between `least` and `greatest` with the least k. If there are several, the one
/// nearest to the middle.
fn nearest_multiple(least: f64, greatest: f64, edge: f64) -> Option<f64> {
    let middle = least + (greatest - least) / 2.0;
    let mut step = edge;
    for _ in 0..=MAX_DEPTH {
        let below = libm::floor(middle / step) * step;
        let near = [below, below + step];
        let mut inside = near.into_iter().filter(|x| (least..=greatest).contains(x));
        if let Some(first) = inside.next() {
            return Some(inside.find(|next| next - middle < middle - first).unwrap_or(first));
        }
        step /= 2.0;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_are_exact() {
        let frame = Frame::new([0.1; 3], 0.7, 20).unwrap();
        for k in [0i64, 1, 3, 1_000_001, 2_097_152] {
            let plane = 0.1 + k as f64 * (0.7 / 2_097_152.0);
            for x in [plane.next_down(), plane, plane.next_up()] {
                assert_eq!(frame.offset(1, x, k).sign(), frame.side(1, x, k));
            }
        }
    }

    #[test]
    fn what_is_refused() {
        for (origin, edge, depth) in [
            ([f64::NAN, 0.0, 0.0], 1.0, 4),
            ([0.0, f64::INFINITY, 0.0], 1.0, 4),
            ([0.0, 0.0, -1e-300], 1.0, 4),
            ([0.0; 3], 0.0, 4),
            ([0.0; 3], -1.0, 4),
            ([0.0; 3], f64::NAN, 4),
            ([0.0; 3], 1e-100, 4),
            ([0.0; 3], 1.0, 0),
            ([0.0; 3], 1.0, 21),
        ] {
            assert!(Frame::new(origin, edge, depth).is_err(), "{origin:?} {edge} {depth}");
        }
        assert!(Frame::around([1.0; 3], [1.0; 3], 5).is_err());
        assert!(Frame::around([f64::NAN; 3], [1.0; 3], 5).is_err());
    }

    #[test]
    fn a_frame_around_a_part_is_centred_and_depth_free() {
        let frame = Frame::around([0.0, 10.0, 0.0], [32.0, 26.0, 8.0], 7).unwrap();
        assert_eq!((frame.edge(), frame.origin()), (33.0, [-0.5, 1.5, -12.5]));
        assert!(frame.same_universe(&Frame::around([0.0, 10.0, 0.0], [32.0, 26.0, 8.0], 8).unwrap()));
    }

    #[test]
    fn an_aligned_frame_has_round_planes() {
        let min = [[0.0; 3], [-50.0, -0.75, 3.5], [1e6, -1e-3, 0.0], [0.1, 0.2, 0.3], [-64.0, 1.0, 2.0]];
        let extents =
            [[100.0, 60.0, 30.0], [1.0; 3], [128.0, 1.0, 64.0], [1e-3, 0.0, 0.1], [33.0, 0.5, 65.0]];
        for min in min {
            for extent in extents {
                let max = axes(|axis| min[axis] + extent[axis]);
                let Ok(frame) = Frame::aligned(min, max, 9) else { panic!("{min:?} {max:?}") };
                let (edge, longest) = (frame.edge(), extent.into_iter().fold(0.0, f64::max));
                assert!(frame.holds(min, max) && edge < 4.0 * longest, "{frame:?} {min:?} {max:?}");
                assert_eq!((edge.log2().fract(), (edge / longest > 2.0)), (0.0, false), "{frame:?}");
                for axis in 0..3 {
                    assert_eq!(frame.origin()[axis] % (edge / (1 << 20) as f64), 0.0);
                    // A plane of the finest lattice is a round number.
                    let plane = frame.plane(axis, 77);
                    assert_eq!((plane.width(), plane.lower % frame.cell_size()), (0.0, 0.0), "{frame:?}");
                }
                assert!(frame.same_universe(&Frame::aligned(min, max, 1).unwrap()));
                let by_cells = Frame::with_cells(min, max, edge / 512.0).unwrap();
                assert_eq!(by_cells, frame);
            }
        }
    }

    #[test]
    fn origins_are_multiples_of_great_powers() {
        for (min, max, edge, expected) in [
            (0.0, 100.0, 128.0, -16.0),
            (-50.0, 50.0, 128.0, -64.0),
            (0.0, 128.0, 128.0, 0.0),
            (0.0, 127.5, 128.0, 0.0),
            (3.0, 4.0, 2.0, 2.5),
            (-1.0, 1.0, 4.0, -2.0),
            (0.3, 0.5, 0.25, 0.25 + 1.0 / 32.0),
        ] {
            let origin = aligned_origin([min; 3], [max; 3], edge);
            assert_eq!(origin, Some([expected; 3]), "{min} {max}");
        }
        assert_eq!(aligned_origin([0.1; 3], [1.1; 3], 1.0), None);
    }

    #[test]
    fn a_fitted_frame_is_aligned_where_bounds_are_round() {
        let part = ([0.0, 0.0, -12.5], [100.0, 60.0, 17.5]);
        assert_eq!(Frame::fitted(part.0, part.1, 9).unwrap(), Frame::aligned(part.0, part.1, 9).unwrap());
        for scan in [([0.061_7, 0.0, 0.0], [1.0; 3]), ([0.0; 3], [1.0 / 3.0, 0.7, 1.0])] {
            assert_eq!(Frame::fitted(scan.0, scan.1, 9).unwrap(), Frame::around(scan.0, scan.1, 9).unwrap());
        }
        for make in [Frame::aligned, Frame::fitted] {
            assert!(make([1.0; 3], [1.0; 3], 5).is_err() && make([1.0; 3], [0.0; 3], 5).is_err());
            assert!(make([f64::NAN; 3], [1.0; 3], 5).is_err() && make([0.0; 3], [1.0; 3], 21).is_err());
            assert!(make([2f64.powi(255); 3], [2f64.powi(255) * (1.0 + 1e-15); 3], 5).is_ok());
        }
    }

    #[test]
    fn cells_of_a_given_size() {
        let frame = Frame::with_cells([0.0; 3], [10.0, 1.0, 1.0], 0.1).unwrap();
        assert_eq!((frame.cell_size(), frame.depth()), (0.1, 7));
        assert!(Frame::with_cells([0.0; 3], [1.0; 3], 1e-9).is_err());
        assert!(Frame::with_cells([0.0; 3], [1.0; 3], 0.0).is_err());
        assert!(Frame::with_cells([0.0; 3], [1.0; 3], f64::NAN).is_err());
        let coarse = Frame::with_cells([0.0; 3], [1.0; 3], 1e9).unwrap();
        assert_eq!((coarse.depth(), coarse.cell_size()), (1, 1e9));
    }

    #[test]
    fn cells_are_exact_next_to_every_plane() {
        // Neither the cell size nor the planes are representable.
        let frame = Frame::new([0.1, -7.3, 1e5 / 3.0], 10.0 / 3.0, 20).unwrap();
        for axis in 0..3 {
            for i in [0u32, 1, 2, 3, 12_345, 524_288, 1_048_575, 1_048_576] {
                let plane = frame.plane(axis, i);
                assert!(plane.upper == plane.lower || plane.upper == plane.lower.next_up());
                for x in [plane.lower.next_down(), plane.lower, plane.upper, plane.upper.next_up()] {
                    let below = frame.side(axis, x, 2 * i as i64) < 0;
                    let on = frame.side(axis, x, 2 * i as i64) == 0;
                    let expected = match (below, on) {
                        (true, _) if i == 0 => None,
                        (true, _) => Some(i - 1),
                        (_, true) if i == frame.cells() => Some(i - 1),
                        _ if i == frame.cells() => None,
                        _ => Some(i),
                    };
                    assert_eq!(frame.cell_at(axis, x), expected, "axis {axis} plane {i} x {x:e}");
                }
            }
        }
        assert_eq!(frame.cell_at(0, f64::NAN), None);
        assert_eq!(frame.cell_at(0, f64::INFINITY), None);
        assert_eq!(frame.cell_at(0, -1e300), None);
    }
}
