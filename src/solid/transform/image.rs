//! Maps boxes of one lattice to another lattice.

use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::Expansion;
use crate::lattice::exact::{floor, sqrt, two_product};
use crate::lattice::{Affine, Bounds, Cell, Cube, Frame, MAX_DEPTH};

/// A map from the lattice of one frame to that of another, in finest cells: u = linear · k + offset.
#[derive(Debug, Clone, Copy)]
pub(super) struct LatticeMap {
    pub(super) linear: [[f64; 3]; 3],
    offset: [f64; 3],
    /// For each axis, the greatest error of [`image`](Self::image) for boxes of the universe. Zero means
    /// exact.
    pub(super) error: [f64; 3],
    /// For each axis, whether nothing is rounded along it; then only one axis of the source contributes.
    exact: [bool; 3],
}

impl LatticeMap {
    /// Builds the map p ↦ linear · (p − before) + after of model space. Each entry of `linear` may have a
    /// relative error of 5 · 2^-53. A row with `monomial` set is exact: it has one entry, which is a power of
    /// two.
    fn new(
        linear: &[[f64; 3]; 3],
        before: [f64; 3],
        after: [f64; 3],
        monomial: [bool; 3],
        from: &Frame,
        to: &Frame,
    ) -> LatticeMap {
        let (step, cell) = (from.cell_size(), to.cell_size());
        let mut map =
            LatticeMap { linear: [[0.0; 3]; 3], offset: [0.0; 3], error: [0.0; 3], exact: monomial };
        for i in 0..3 {
            let (mut offset, mut size) = (after[i] - to.origin()[i], after[i].abs() + to.origin()[i].abs());
            let mut reach = 0.0;
            for j in 0..3 {
                let entry = linear[i][j] * step / cell;
                map.linear[i][j] = entry;
                reach += entry.abs() * from.cells() as f64;
                map.exact[i] &= two_product(entry, cell) == (linear[i][j] * step, 0.0);
                offset += linear[i][j] * (from.origin()[j] - before[j]);
                size += linear[i][j].abs() * (from.origin()[j].abs() + before[j].abs());
            }
            map.offset[i] = offset / cell;
            // Each sum below has at most a dozen roundings, each relative to this size. The entries add five
            // more.
            map.error[i] = 32.0 * f64::EPSILON * (reach + size / cell);
        }
        for i in 0..3 {
            map.exact[i] = map.exact[i] && map.offset_is_exact(i, &linear[i], before, after[i], from, to);
        }
        if map.exact == [true; 3] {
            map.error = [0.0; 3];
        }
        map
    }

    /// Returns whether the offset along an axis of a monomial map leaves every sum unrounded. Corrects the
    /// offset if so.
    fn offset_is_exact(
        &mut self,
        i: usize,
        linear: &[f64; 3],
        before: [f64; 3],
        after: f64,
        from: &Frame,
        to: &Frame,
    ) -> bool {
        let products = (0..3).flat_map(|j| [linear[j] * from.origin()[j], -(linear[j] * before[j])]);
        let sum = Expansion::sum(products.chain([after, -to.origin()[i]]));
        let offset = sum.estimate() / to.cell_size();
        let (product, error) = two_product(offset, to.cell_size());
        self.offset[i] = offset;
        let span = self.linear[i].iter().map(|entry| entry.abs()).sum::<f64>() * from.cells() as f64;
        are_sums_exact(span, offset) && sum.minus(&Expansion::sum([error, product])).sign() == 0
    }

    /// The box around the image of a cube of the source lattice, without the error. Corner and edge are given
    /// in whole or half cells.
    #[inline(always)]
    pub(super) fn image(&self, corner: [f64; 3], edge: f64) -> ([f64; 3], [f64; 3]) {
        let (mut low, mut high) = ([0.0; 3], [0.0; 3]);
        for i in 0..3 {
            let [a, b, c] = self.linear[i];
            let half = 0.5 * edge;
            let centre =
                a * (corner[0] + half) + b * (corner[1] + half) + c * (corner[2] + half) + self.offset[i];
            let radius = (a.abs() + b.abs() + c.abs()) * half;
            (low[i], high[i]) = (centre - radius, centre + radius);
        }
        (low, high)
    }

    /// As [`image`](Self::image), with the error.
    #[inline(always)]
    pub(super) fn around(&self, corner: [f64; 3], edge: f64) -> ([f64; 3], [f64; 3]) {
        let (mut low, mut high) = self.image(corner, edge);
        for i in 0..3 {
            (low[i], high[i]) = (low[i] - self.error[i], high[i] + self.error[i]);
        }
        (low, high)
    }

    /// The edge of the cells that cover the image of a unit cube: the longest image of an edge of the cube,
    /// halved as long as a few dozen cells suffice.
    fn grain(&self) -> f64 {
        const MOST: f64 = 32.0;
        let square = |j: usize| (0..3).map(|i| self.linear[i][j] * self.linear[i][j]).sum::<f64>();
        // Rounding must not make an equal length a little larger.
        let mut edge = sqrt(square(0).max(square(1)).max(square(2))) * (1.0 + 1e-9);
        let extents = self.linear.each(|[a, b, c]| a.abs() + b.abs() + c.abs());
        let count = |edge: f64| extents.iter().map(|extent| extent / edge + 1.0).product::<f64>();
        // Where nothing blurs, cells as long as the shortest image are as good as smaller ones.
        let least = if self.is_exact() { sqrt(square(0).min(square(1)).min(square(2))) } else { 0.0 };
        // (More steps are needed only for maps far beyond the resolution of doubles.)
        for _ in 0..64 {
            if 0.5 * edge < least || count(0.5 * edge) > MOST {
                break;
            }
            edge *= 0.5;
        }
        edge
    }

    /// Returns whether nothing is rounded along an axis.
    pub(super) fn is_exact_along(&self, axis: usize) -> bool {
        self.exact[axis]
    }

    pub(super) fn is_exact(&self) -> bool {
        self.error == [0.0; 3]
    }

    /// Returns whether the map is an offset by whole cells.
    pub(super) fn keeps_centres(&self) -> bool {
        const UNIT: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        self.is_exact() && self.linear == UNIT && self.offset.iter().all(|&c| c == floor(c) as f64)
    }
}

/// Returns whether all coordinates of the images of cells, and their halves, are doubles. The image of the
/// universe spans `span` cells. The coordinates are multiples of a power of two, and must be smaller than
/// 2^53 times that power. The result does not depend on the depth.
fn are_sums_exact(span: f64, offset: f64) -> bool {
    const STEP: f64 = 1.0 / (2u64 << MAX_DEPTH) as f64;
    const MOST: f64 = (1u64 << 53) as f64;
    let grain = lowest_bit(span * STEP).min(lowest_bit(offset));
    span + offset.abs() <= MOST * grain
}

/// The largest power of two that divides a number.
fn lowest_bit(x: f64) -> f64 {
    if x == 0.0 {
        return f64::INFINITY;
    }
    // The number without its last bit is a double, too, and so is the difference.
    let bits = x.abs().to_bits();
    let without = if bits & MANTISSA == 0 { 0 } else { bits & (bits - 1) };
    x.abs() - f64::from_bits(without)
}

/// The mantissa bits of a double.
const MANTISSA: u64 = (1 << 52) - 1;

/// The maps in both directions between the lattice of a frame and that of the solid.
#[derive(Debug, Clone, Copy)]
pub(super) struct Maps {
    pub(super) inward: LatticeMap,
    pub(super) outward: LatticeMap,
    /// The largest edge of cells that cover the inverse image of a finest cell.
    grain: f64,
}

impl Maps {
    pub(super) fn new(placement: &Affine, inverse: &[[f64; 3]; 3], frame: &Frame, own: &Frame) -> Maps {
        let rows = placement.rows();
        let linear = rows.each(|[x, y, z, _]| [x, y, z]);
        let offset = rows.each(|[_, _, _, t]| t);
        // An axis that maps to a single axis, which no other axis maps to, has an exact inverse.
        let (mut inverse, mut to, mut from) = (*inverse, [false; 3], [false; 3]);
        for (i, row) in linear.iter().enumerate() {
            let is_power = |c: f64| c.is_normal() && c.to_bits() & ((1 << 52) - 1) == 0;
            let Some(j) = (0..3).find(|&j| row[j] != 0.0) else { continue };
            let is_lone = (0..3).all(|k| k == j || row[k] == 0.0) && is_power(row[j]);
            to[i] = is_lone;
            if is_lone && (0..3).all(|k| k == i || linear[k][j] == 0.0) {
                inverse[j] = axes(|k| if k == i { 1.0 / row[j] } else { 0.0 });
                from[j] = true;
            }
        }
        let inward = LatticeMap::new(&inverse, offset, [0.0; 3], from, frame, own);
        let outward = LatticeMap::new(&linear, [0.0; 3], offset, to, own, frame);
        Maps { inward, outward, grain: inward.grain() }
    }
}

/// A target of the comparison with cells of the solid's own frame.
pub(super) trait Target {
    /// Which of up to eight objects (bit k: object k) the cell with this corner and edge touches.
    fn touched(&self, corner: [f64; 3], edge: f64) -> u8;

    /// The same for the eight children of the cell.
    fn touched_by_children(&self, corner: [f64; 3], edge: f64) -> [u8; 8] {
        let half = 0.5 * edge;
        [0, 1, 2, 3, 4, 5, 6, 7].each(|octant: u8| {
            self.touched(axes(|axis| corner[axis] + (octant >> axis & 1) as f64 * half), half)
        })
    }
}

/// The inverse images of the eight children of a cube, or of a single cube.
///
/// A cell touches an image unless a plane of the cell's lattice or of the frame separates their interiors. A
/// NaN separates nothing.
pub(super) struct Images<'m> {
    maps: &'m Maps,
    /// The boxes around the images.
    low: [[f64; 8]; 3],
    high: [[f64; 8]; 3],
    /// The planes that bound the children, in the frame's finest cells.
    planes: [[f64; 3]; 3],
    /// The largest edge of cells that cover the images.
    pub(super) grain: f64,
}

impl<'m> Images<'m> {
    /// The images of the children of a cube (`parts` = 2), or eight copies of the image of the cube itself
    /// (1).
    pub(super) fn new(maps: &'m Maps, cube: &Cube<'_>, parts: u32) -> Images<'m> {
        let (lower, upper) = cube.planes();
        let edge = (upper[0] - lower[0]) as f64 / parts as f64;
        let planes = axes(|axis| {
            let low = lower[axis] as f64;
            [low, low + edge, upper[axis] as f64]
        });
        let grain = maps.grain * edge;
        let mut images = Images { maps, low: [[0.0; 8]; 3], high: [[0.0; 8]; 3], planes, grain };
        for k in 0..8 {
            let corner = axes(|axis| planes[axis][if parts == 2 { k >> axis & 1 } else { 0 }]);
            let (low, high) = maps.inward.around(corner, edge);
            for axis in 0..3 {
                (images.low[axis][k], images.high[axis][k]) = (low[axis], high[axis]);
            }
        }
        images
    }

    /// Those that may reach beyond the universe of `cells` cells. A NaN may.
    pub(super) fn reach_beyond(&self, cells: f64) -> u8 {
        (0..8).fold(0, |beyond, k| {
            let inside = (0..3).all(|axis| self.low[axis][k] >= 0.0 && self.high[axis][k] <= cells);
            beyond | (!inside as u8) << k
        })
    }

    /// Those whose boxes overlap the range between two planes of the solid's lattice.
    #[inline(always)]
    fn between(&self, axis: usize, low: f64, high: f64) -> u8 {
        let mut apart = 0;
        for k in 0..8 {
            apart |= ((self.low[axis][k] >= high || self.high[axis][k] <= low) as u8) << k;
        }
        !apart
    }

    /// Those that the frame's planes do not separate from a cell with this image.
    #[inline(always)]
    fn beside(&self, low: [f64; 3], high: [f64; 3]) -> u8 {
        const UPPER: [u8; 3] = [0xAA, 0xCC, 0xF0];
        let mut touched = 0xFF;
        for axis in 0..3 {
            let [first, middle, last] = self.planes[axis];
            if low[axis] >= middle || high[axis] <= first {
                touched &= UPPER[axis];
            }
            if low[axis] >= last || high[axis] <= middle {
                touched &= !UPPER[axis];
            }
        }
        touched
    }
}

impl Target for Images<'_> {
    fn touched(&self, corner: [f64; 3], edge: f64) -> u8 {
        let touched =
            (0..3).fold(0xFF, |all, axis| all & self.between(axis, corner[axis], corner[axis] + edge));
        if touched == 0 || self.maps.inward.is_exact() {
            return touched;
        }
        let (low, high) = self.maps.outward.around(corner, edge);
        touched & self.beside(low, high)
    }

    fn touched_by_children(&self, corner: [f64; 3], edge: f64) -> [u8; 8] {
        // Children share their planes, and their images differ by an offset.
        let half = 0.5 * edge;
        let halves = axes(|axis| {
            let middle = corner[axis] + half;
            [self.between(axis, corner[axis], middle), self.between(axis, middle, corner[axis] + edge)]
        });
        let outward = &self.maps.outward;
        let (low, high) = outward.around(corner, half);
        let mut touched = [0; 8];
        for (octant, touched) in touched.iter_mut().enumerate() {
            let upper = axes(|axis| octant >> axis & 1);
            *touched = halves[0][upper[0]] & halves[1][upper[1]] & halves[2][upper[2]];
            if *touched != 0 && !self.maps.inward.is_exact() {
                let step = outward.linear.each(|[a, b, c]| {
                    a * (upper[0] as f64 * half) + b * (upper[1] as f64 * half) + c * (upper[2] as f64 * half)
                });
                let moved = |box_end: [f64; 3]| axes(|i| box_end[i] + step[i]);
                *touched &= self.beside(moved(low), moved(high));
            }
        }
        touched
    }
}

/// The inverse image of a point. A cell touches the image if it may contain it. Where there is no error, the
/// shift of all centres by (ε, ε², ε³) decides for images on a plane.
pub(super) struct Point<'m> {
    pub(super) map: &'m LatticeMap,
    pub(super) at: [f64; 3],
}

impl<'m> Point<'m> {
    /// The image of the centre of a finest cell.
    pub(super) fn centre(map: &'m LatticeMap, cell: Cell) -> Point<'m> {
        Point { map, at: map.image(cell.at.each(|a| a as f64 + 0.5), 0.0).0 }
    }

    /// Returns whether a cell contains the computed image; a face between two cells belongs to one of them.
    pub(super) fn is_in(&self, corner: [f64; 3], edge: f64) -> bool {
        (0..3).all(|axis| self.is_between(axis, corner[axis], corner[axis] + edge))
    }

    fn is_between(&self, axis: usize, low: f64, high: f64) -> bool {
        let x = self.at[axis];
        match self.map.linear[axis].iter().find(|&&c| c != 0.0) {
            Some(&c) if c < 0.0 => low < x && x <= high,
            _ => low <= x && x < high,
        }
    }

    /// Returns 1 if the image may lie beyond the universe of `cells` cells, else 0.
    pub(super) fn reaches_beyond(&self, cells: f64) -> u8 {
        if self.map.is_exact() {
            // The shift decides for the faces of the universe, too: then no cell contains the image.
            return (self.touched([0.0; 3], cells) == 0) as u8;
        }
        !(0..3).all(|axis| {
            let (x, error) = (self.at[axis], self.map.error[axis]);
            x - error >= 0.0 && x + error <= cells
        }) as u8
    }
}

impl Target for Point<'_> {
    fn touched(&self, corner: [f64; 3], edge: f64) -> u8 {
        let holds = (0..3).all(|axis| {
            let (x, error) = (self.at[axis], self.map.error[axis]);
            let (low, high) = (corner[axis], corner[axis] + edge);
            match error {
                0.0 => self.is_between(axis, low, high),
                _ => !(x + error < low || x - error > high),
            }
        });
        holds as u8
    }
}

/// The frame whose cells have the cells of `frame` as their images, if it exists and its origin is a double.
pub(super) fn source_frame(placement: &Affine, inverse: &[[f64; 3]; 3], frame: &Frame) -> Option<Frame> {
    let scale = |row: [f64; 3]| row.iter().map(|c| c.abs()).sum::<f64>();
    let factor = scale(inverse[0]);
    if !placement.is_monomial() || inverse.iter().any(|&row| scale(row) != factor) {
        return None;
    }
    let mut origin = [0.0; 3];
    for (axis, row) in inverse.iter().enumerate() {
        // Where the axis is reversed, the lower end comes from the upper one.
        let (from, entry) = row.iter().enumerate().find(|(_, entry)| **entry != 0.0)?;
        let upper = if *entry < 0.0 { frame.edge() } else { 0.0 };
        let moved = Expansion::sum([frame.origin()[from], upper, -placement.rows()[from][3]]);
        let rounded = moved.estimate();
        if Expansion::sum([frame.origin()[from], upper, -placement.rows()[from][3], -rounded]).sign() != 0 {
            return None;
        }
        origin[axis] = rounded * entry;
    }
    Frame::new(origin, frame.edge() * factor, frame.depth()).ok()
}

/// A box that contains the inverse image of a box: somewhat larger than the computed box.
pub(super) fn source_box(placement: &Affine, inverse: &[[f64; 3]; 3], bounds: &Bounds) -> [[f64; 3]; 2] {
    let (mut min, mut max) = ([0.0; 3], [0.0; 3]);
    for (i, row) in inverse.iter().enumerate() {
        let (mut centre, mut radius, mut size) = (0.0, 0.0, 0.0);
        for j in 0..3 {
            let t = placement.rows()[j][3];
            centre += row[j] * (0.5 * (bounds.min[j] + bounds.max[j]) - t);
            radius += row[j].abs() * 0.5 * (bounds.max[j] - bounds.min[j]);
            size += row[j].abs() * (bounds.min[j].abs() + bounds.max[j].abs() + t.abs());
        }
        let reach = radius + 64.0 * f64::EPSILON * size;
        (min[i], max[i]) = (centre - reach, centre + reach);
    }
    [min, max]
}

/// The length of the shortest column of the inverse: approximately, the smallest factor by which the inverse
/// map scales a length.
pub(super) fn shrinkage(inverse: &[[f64; 3]; 3]) -> f64 {
    let square = |j: usize| (0..3).map(|i| inverse[i][j] * inverse[i][j]).sum::<f64>();
    sqrt(square(0).min(square(1)).min(square(2)))
}
