//! The slab of a cell, from the slabs of the cells of the solid's own frame that it touches.
//!
//! Each of these cells bounds the slab along one direction ν, the mean of their normals. A slab with normal n
//! becomes a slab along ν if its offsets leave room for (ν − λ n) · u, for any λ > 0. That term is small over
//! a cell. A FULL cell bounds the outer side by its extent along ν, an EMPTY cell the inner side. A cell of
//! which nothing is known bounds both. The worst bound of all cells counts.

use super::image::Maps;
use crate::lattice::Cube;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::sqrt;
use crate::octree::Tag;
use crate::solid::{Enclosure, Slab, SlabJoin};

/// A bound of the roundings of a sum of a dozen products, each relative to the sum of the magnitudes.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// A cell of the solid's own frame, in finest cells.
pub(super) struct Source {
    pub(super) corner: [f64; 3],
    pub(super) edge: f64,
    pub(super) tag: Tag,
    pub(super) enclosure: Option<Enclosure>,
}

/// The position of a cell in the solid's own lattice, in finest cells.
struct View<'m> {
    maps: &'m Maps,
    /// The half edge of the cell itself, in its own lattice.
    half: f64,
    /// The image of its centre, rounded.
    centre: [f64; 3],
    /// A box around its image.
    low: [f64; 3],
    high: [f64; 3],
}

/// Bounds along a direction: everything below `inner` lies inside, everything beyond `outer` lies outside.
#[derive(Clone, Copy)]
struct Known {
    inner: f64,
    outer: f64,
}

/// The slab of a cell, from the cells that it touches. `exterior` is the state beyond the universe of `cells`
/// finest cells.
pub(super) fn enclosure(
    maps: &Maps,
    cube: &Cube<'_>,
    cells: f64,
    exterior: Tag,
    sources: &[Source],
) -> Option<Enclosure> {
    let view = View::new(maps, cube)?;
    if let [source] = sources
        && maps.inward.is_exact()
        && source.corner == view.low
        && (0..3).all(|axis| source.corner[axis] + source.edge == view.high[axis])
    {
        return view.handed_on(source);
    }
    let beyond = view.beyond(cells, exterior);
    let all = || sources.iter().chain(beyond.iter().flatten());
    let known = |direction| view.worst(all(), direction);
    let slab = match view.mean(sources) {
        Some(direction) => view.slab(direction, known(direction)),
        None => {
            // Where all cells are decided, the surface may be a plane of their lattice.
            let (mut best, mut thinnest) = (None, f64::INFINITY);
            for axis in 0..3 {
                let [plus, minus] = [1.0, -1.0].each(|sign| {
                    let mut direction = [0.0; 3];
                    direction[axis] = sign;
                    let known = known(direction);
                    (known.outer - known.inner, direction, known)
                });
                // (If both directions are equally good, neither is used.)
                let thinner = if plus.0 < minus.0 { plus } else { minus };
                if plus.0 != minus.0 && thinner.0 < thinnest {
                    (best, thinnest) = (Some((thinner.1, thinner.2)), thinner.0);
                }
            }
            let (direction, known) = best?;
            view.slab(direction, known)
        }
    };
    let range = slab.normal.iter().map(|c| c.abs()).sum::<f64>();
    let is_worth_it = slab.inner > -range || slab.outer < range;
    is_worth_it.then(|| Enclosure::of_one(slab, f64::INFINITY)).flatten()
}

impl<'m> View<'m> {
    /// `None` if the cell's image is beyond the resolution of doubles.
    fn new(maps: &'m Maps, cube: &Cube<'_>) -> Option<View<'m>> {
        let (lower, upper) = cube.planes();
        let (corner, half) = (lower.each(f64::from), 0.5 * (upper[0] - lower[0]) as f64);
        let (centre, _) = maps.inward.image(corner.each(|c| c + half), 0.0);
        let (low, high) = maps.inward.around(corner, 2.0 * half);
        let is_finite = low.iter().chain(&high).all(|c| c.is_finite());
        is_finite.then_some(View { maps, half, centre, low, high })
    }

    /// The enclosure of the cell whose exact image this cell is.
    fn handed_on(&self, source: &Source) -> Option<Enclosure> {
        let mut enclosure = source.enclosure?;
        for slab in &mut enclosure.slabs {
            // The axes change places and signs, and the factor is one.
            slab.normal = self.pulled_back(slab.normal).each(|c| c / (0.5 * source.edge));
        }
        Some(enclosure)
    }

    /// Aᵀ ν for the map A from the coordinates of the cell, in half edges.
    fn pulled_back(&self, direction: [f64; 3]) -> [f64; 3] {
        let rows = &self.maps.inward.linear;
        axes(|j| {
            let sum = direction[0] * rows[0][j] + direction[1] * rows[1][j] + direction[2] * rows[2][j];
            sum * self.half
        })
    }

    /// Up to six cubes around the part of the cell's image beyond the universe.
    fn beyond(&self, cells: f64, exterior: Tag) -> [Option<Source>; 6] {
        let edge = (0..3).map(|axis| 2.0 * (self.high[axis] - self.low[axis])).fold(0.0, f64::max);
        [0, 1, 2, 3, 4, 5].each(|side| {
            let axis = side / 2;
            let mut corner = self.low;
            let reaches = if side % 2 == 0 {
                corner[axis] = corner[axis].min(-edge);
                self.low[axis] < 0.0
            } else {
                corner[axis] = corner[axis].max(cells);
                self.high[axis] > cells
            };
            reaches.then_some(Source { corner, edge, tag: exterior, enclosure: None })
        })
    }

    /// The mean of the normals, `None` if there are none.
    fn mean(&self, sources: &[Source]) -> Option<[f64; 3]> {
        let mut sum = [0.0; 3];
        for slab in sources.iter().filter_map(|source| source.enclosure.as_ref()).flat_map(|e| &e.slabs) {
            let length = sqrt(slab.normal.iter().map(|c| c * c).sum());
            if length > 0.0 && length.is_finite() {
                (0..3).for_each(|axis| sum[axis] += slab.normal[axis] / length);
            }
        }
        (sum != [0.0; 3]).then_some(sum)
    }

    /// The worst bounds of all cells along a direction.
    fn worst<'s>(&self, sources: impl Iterator<Item = &'s Source>, direction: [f64; 3]) -> Known {
        let nothing_against = Known { inner: f64::INFINITY, outer: f64::NEG_INFINITY };
        sources.fold(nothing_against, |worst, source| {
            let known = self.known(source, direction);
            Known { inner: worst.inner.min(known.inner), outer: worst.outer.max(known.outer) }
        })
    }

    /// The bounds of one cell along a direction, measured from the centre's image.
    fn known(&self, source: &Source, direction: [f64; 3]) -> Known {
        let high = source.corner.each(|c| c + source.edge);
        let low = axes(|axis| source.corner[axis].max(self.low[axis]));
        let high = axes(|axis| high[axis].min(self.high[axis]));
        let (begin, end) = extremes(direction, low, high, self.centre, 0.0);
        match source.tag {
            Tag::Full => Known { inner: f64::INFINITY, outer: end },
            Tag::Empty => Known { inner: begin, outer: f64::NEG_INFINITY },
            Tag::Partial | Tag::Branch => {
                let Some(enclosure) = &source.enclosure else { return Known { inner: begin, outer: end } };
                let slabs = enclosure.slabs.iter().filter(|slab| slab.normal != [0.0; 3]);
                let by = |slab: &Slab| self.by_slab(source, slab, direction, low, high);
                let known = match enclosure.join {
                    SlabJoin::All => slabs
                        .map(by)
                        .reduce(|a, b| Known { inner: a.inner.min(b.inner), outer: a.outer.min(b.outer) }),
                    SlabJoin::Any => slabs
                        .map(by)
                        .reduce(|a, b| Known { inner: a.inner.max(b.inner), outer: a.outer.max(b.outer) }),
                };
                let known = known.unwrap_or(NOTHING);
                // Outside its own extent, the cell restricts nothing.
                Known { inner: known.inner.max(begin), outer: known.outer.min(end) }
            }
        }
    }

    /// The bounds of one slab of a cell along a direction in a box.
    fn by_slab(
        &self,
        source: &Source,
        slab: &Slab,
        direction: [f64; 3],
        low: [f64; 3],
        high: [f64; 3],
    ) -> Known {
        let half = 0.5 * source.edge;
        let normal = slab.normal.each(|c| c / half);
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let share = dot(direction, normal) / dot(normal, normal);
        if !(share > 0.0 && share.is_finite()) {
            return NOTHING;
        }
        let centre = source.corner.each(|c| c + half);
        let rest = axes(|axis| direction[axis] - share * normal[axis]);
        // The error of the components of the rest, relative to these.
        let size = axes(|axis| direction[axis].abs() + share * normal[axis].abs());
        let (least, most) = extremes(rest, low, high, centre, dot(size, [ROUNDING * half; 3]));
        let offset = axes(|axis| centre[axis] - self.centre[axis]);
        let shift = dot(direction, offset);
        let size = dot(direction.each(f64::abs), offset.each(f64::abs));
        let end = |offset: f64, rest: f64| {
            let error = ROUNDING * (share * offset.abs() + rest.abs() + size);
            (share * offset + rest + shift, error)
        };
        let (inner, below) = end(slab.inner, least);
        let (outer, above) = end(slab.outer, most);
        Known { inner: inner - below, outer: outer + above }
    }

    /// The slab in the coordinates of the cell.
    fn slab(&self, direction: [f64; 3], known: Known) -> Slab {
        let inward = &self.maps.inward;
        let mut slack = 0.0;
        for axis in 0..3 {
            let [a, b, c] = inward.linear[axis].each(f64::abs);
            let rounded = ROUNDING * self.half * ((a + b) + c);
            slack += direction[axis].abs() * (2.0 * inward.error[axis] + rounded);
        }
        // (Rounding to a neighbour covers the error of the difference itself.)
        let Known { inner, outer } = known;
        Slab {
            normal: self.pulled_back(direction),
            inner: (inner - slack).next_down(),
            outer: (outer + slack).next_up(),
        }
    }
}

const NOTHING: Known = Known { inner: f64::NEG_INFINITY, outer: f64::INFINITY };

/// Bounds of ν · (u − centre) over a box, widened by `error`.
fn extremes(direction: [f64; 3], low: [f64; 3], high: [f64; 3], centre: [f64; 3], error: f64) -> (f64, f64) {
    let (mut least, mut most, mut size) = (0.0, 0.0, 0.0);
    for axis in 0..3 {
        let ends = [low[axis], high[axis]].each(|end| direction[axis] * (end - centre[axis]));
        (least, most) = (least + ends[0].min(ends[1]), most + ends[0].max(ends[1]));
        size += ends[0].abs().max(ends[1].abs());
    }
    let error = error + ROUNDING * size;
    (least - error, most + error)
}
