//! Any solid under an affine map.

use super::exact::Expansion;
use super::{Scratch, Solid, Verdict};
use crate::error::Error;
use crate::lattice::exact::{floor, sqrt, two_product};
use crate::lattice::{Affine, Cell, Cube, Frame};
use crate::octree::Tag;
use alloc::vec::Vec;

/// A solid, known on a frame of its own, under an affine placement.
///
/// A cell is FULL or EMPTY if all the cells of the solid's own frame are that its inverse image touches: cells of about
/// its size, or larger ones that are decided. So a surface that is not parallel to the lattice blurs by about a cell,
/// which a finer frame makes as small as one likes, down to the depth of the solid's own. Rounding is outward.
///
/// Where the map takes lattice planes to lattice planes (a permutation of the axes, with signs and powers of two as
/// scales, and an offset of whole cells) no rounding occurs and nothing blurs: of cells of one size each finest cell of
/// the result is one of the solid's.
///
/// What sticks out of the solid's own universe is as [`exterior`](Solid::exterior) tells: undecided, unless the solid is
/// proven to end inside. Centres ([`Rule::Sampled`](crate::Rule::Sampled)) are decided where cells of the solid's own
/// depth decide them, or, if the placement is an offset of whole cells, by the solid.
///
/// ```
/// use leafless::{Affine, AxisBox, Control, Frame, Rule, Transform, build};
/// let block = AxisBox::new([-1.0, -0.5, -0.25], [1.0, 0.5, 0.25])?;
/// let own = Frame::new([-2.0; 3], 4.0, 8)?;
/// // Turned by the angle whose cosine is 0.8, and moved.
/// let placement =
///     Affine::new([[0.8, -0.6, 0.0, 3.0], [0.6, 0.8, 0.0, 2.0], [0.0, 0.0, 1.0, 2.0]])?;
/// let solid = Transform::new(block, &own, &placement);
/// let tree = build(&solid, &Frame::new([0.0; 3], 5.0, 7)?, Rule::Certified, &Control::default())?;
/// assert!(tree.statistics().volume().contains(1.0));
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Transform<S> {
    solid: S,
    own: Frame,
    placement: Affine,
    inverse: [[f64; 3]; 3],
}

/// Where the cells of its own frame that a cell touches lie in the scratch memory.
#[derive(Debug, Clone, Copy)]
pub struct TransformPart(usize);

/// What is known of one cell of the solid's own frame.
type Known<P> = (Cell, Verdict<P>);

/// Lists of cells of the solid's own frame, one for each PARTIAL cell.
pub struct TransformScratch<S: Solid> {
    maps: Option<Maps>,
    known: Vec<Known<S::Part>>,
    /// Per list its end among the cells, and the height that the solid's own memory had when it was made.
    lists: Vec<(usize, usize)>,
    /// Cells at hand during a split, each with the children that it touches.
    at_hand: Vec<(Known<S::Part>, u8)>,
    own: S::Scratch,
}

impl<S: Solid> Default for TransformScratch<S> {
    fn default() -> Self {
        let (known, lists, at_hand) = (Vec::new(), Vec::new(), Vec::new());
        TransformScratch { maps: None, known, lists, at_hand, own: S::Scratch::default() }
    }
}

impl<S: Solid> Scratch for TransformScratch<S> {
    fn mark(&self) -> usize {
        self.lists.len()
    }

    fn release(&mut self, mark: usize) {
        self.lists.truncate(mark);
        let &(known, own) = self.lists.last().unwrap_or(&(0, 0));
        self.known.truncate(known);
        self.own.release(own);
    }

    fn evaluations(&self) -> u64 {
        self.own.evaluations()
    }
}

impl<S: Solid> TransformScratch<S> {
    fn list(&self, part: TransformPart) -> &[Known<S::Part>] {
        let first = part.0.checked_sub(1).map_or(Some(0), |before| Some(self.lists.get(before)?.0));
        let end = self.lists.get(part.0).map(|list| list.0);
        first.zip(end).and_then(|(first, end)| self.known.get(first..end)).unwrap_or(&[])
    }

    /// Makes a list of the cells at hand that child `k` touches.
    fn keep(&mut self, k: usize) -> Result<TransformPart, Error> {
        let touched = self.at_hand.iter().filter(|(_, children)| children >> k & 1 != 0);
        self.known.try_reserve(touched.clone().count()).map_err(|_| Error::OutOfMemory)?;
        self.known.extend(touched.map(|(known, _)| known.clone()));
        self.close()
    }

    fn close(&mut self) -> Result<TransformPart, Error> {
        self.lists.try_reserve(1).map_err(|_| Error::OutOfMemory)?;
        self.lists.push((self.known.len(), self.own.mark()));
        Ok(TransformPart(self.lists.len() - 1))
    }
}

/// From the lattice of one frame to that of another, in finest cells: u = linear · k + offset.
#[derive(Debug, Clone, Copy)]
struct LatticeMap {
    linear: [[f64; 3]; 3],
    offset: [f64; 3],
    /// How far what [`image`](Self::image) computes for boxes of the universe may be off. Zero: not at all.
    error: [f64; 3],
}

impl LatticeMap {
    /// The map p ↦ linear · (p − before) + after of model space. `linear` may be off by 5 · 2^-53, relatively, in each
    /// entry; none of it is if the map is `monomial`, and then its entries are powers of two, one a row.
    fn new(
        linear: &[[f64; 3]; 3],
        before: [f64; 3],
        after: [f64; 3],
        monomial: bool,
        from: &Frame,
        to: &Frame,
    ) -> LatticeMap {
        let (step, cell) = (from.cell_size(), to.cell_size());
        let mut map = LatticeMap { linear: [[0.0; 3]; 3], offset: [0.0; 3], error: [0.0; 3] };
        let mut exact = monomial;
        for i in 0..3 {
            let (mut offset, mut size) = (after[i] - to.origin()[i], after[i].abs() + to.origin()[i].abs());
            let mut reach = 0.0;
            for j in 0..3 {
                let entry = linear[i][j] * step / cell;
                map.linear[i][j] = entry;
                reach += entry.abs() * from.cells() as f64;
                exact &= is_short(entry * from.cells() as f64)
                    && two_product(entry, cell) == (linear[i][j] * step, 0.0);
                offset += linear[i][j] * (from.origin()[j] - before[j]);
                size += linear[i][j].abs() * (from.origin()[j].abs() + before[j].abs());
            }
            map.offset[i] = offset / cell;
            // Every sum below has a dozen roundings at the most, each relative to this size; the entries bring five
            // more.
            map.error[i] = 32.0 * f64::EPSILON * (reach + size / cell);
        }
        if exact && (0..3).all(|i| map.offset_is_exact(i, &linear[i], before, after[i], from, to)) {
            map.error = [0.0; 3];
        }
        map
    }

    /// Whether the offset on an axis of a monomial map is one with which no sum is rounded; corrects it if so.
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
        is_short(offset) && sum.minus(&Expansion::sum([error, product])).sign() == 0
    }

    /// The box around the image of a cube with this corner and edge (or half of both) of the source lattice, without
    /// the error.
    #[inline(always)]
    fn image(&self, corner: [f64; 3], edge: f64) -> ([f64; 3], [f64; 3]) {
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

    /// The same with the error.
    #[inline(always)]
    fn around(&self, corner: [f64; 3], edge: f64) -> ([f64; 3], [f64; 3]) {
        let (mut low, mut high) = self.image(corner, edge);
        for i in 0..3 {
            (low[i], high[i]) = (low[i] - self.error[i], high[i] + self.error[i]);
        }
        (low, high)
    }

    /// The edge of the cells that the image of a unit cube is to be covered with: the cube's longest image, or half of
    /// that again and again while a few dozen cells will do.
    fn grain(&self) -> f64 {
        const MOST: f64 = 32.0;
        let square = |j: usize| (0..3).map(|i| self.linear[i][j] * self.linear[i][j]).sum::<f64>();
        // Rounding must not make what is equal a little larger.
        let mut edge = sqrt(square(0).max(square(1)).max(square(2))) * (1.0 + 1e-9);
        let extents = self.linear.map(|[a, b, c]| a.abs() + b.abs() + c.abs());
        let count = |edge: f64| extents.iter().map(|extent| extent / edge + 1.0).product::<f64>();
        let halvings = if self.is_exact() { 0 } else { 64 };
        for _ in 0..halvings {
            if count(0.5 * edge) > MOST {
                break;
            }
            edge *= 0.5;
        }
        edge
    }

    fn is_exact(&self) -> bool {
        self.error == [0.0; 3]
    }

    /// Whether a cell of the other lattice may hold the point that has this image. Where there is no error, what lies
    /// on a plane goes where the shift of all centres by (ε, ε², ε³) leads.
    fn leads_into(&self, image: [f64; 3], corner: [f64; 3], edge: f64) -> bool {
        (0..3).all(|axis| {
            let (x, error) = (image[axis], self.error[axis]);
            let (low, high) = (corner[axis], corner[axis] + edge);
            if error != 0.0 {
                return !(x + error < low || x - error > high);
            }
            match self.linear[axis].iter().find(|&&c| c != 0.0) {
                Some(&c) if c < 0.0 => low < x && x <= high,
                _ => low <= x && x < high,
            }
        })
    }

    /// Whether the map is an offset of whole cells.
    fn keeps_centres(&self) -> bool {
        const UNIT: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        self.is_exact() && self.linear == UNIT && self.offset.iter().all(|&c| c == floor(c) as f64)
    }
}

/// Whether sums and halves of a few such numbers are doubles: at most 2^28, and a multiple of 2^-12.
fn is_short(value: f64) -> bool {
    const GRAIN: f64 = 4096.0;
    let steps = value * GRAIN;
    value.abs() <= (1u64 << 28) as f64 && steps == floor(steps) as f64
}

/// Both ways between the lattice of a frame and that of the solid.
#[derive(Debug, Clone, Copy)]
struct Maps {
    inward: LatticeMap,
    outward: LatticeMap,
    /// The largest cells to cover a finest cell's inverse image with.
    edge: f64,
}

/// The inverse images of the eight children of a cube, or of a single one.
struct Images {
    low: [[f64; 8]; 3],
    high: [[f64; 8]; 3],
    /// The planes that bound the children, in the frame's finest cells.
    planes: [[f64; 3]; 3],
    /// Cells of the solid's own frame larger than this are split.
    edge: f64,
}

impl Maps {
    fn new<S>(transform: &Transform<S>, frame: &Frame) -> Maps {
        let rows = transform.placement.rows();
        let linear = rows.map(|[x, y, z, _]| [x, y, z]);
        let offset = rows.map(|[_, _, _, t]| t);
        let monomial = is_monomial(&linear);
        let inward = LatticeMap::new(&transform.inverse, offset, [0.0; 3], monomial, frame, &transform.own);
        let outward = LatticeMap::new(&linear, [0.0; 3], offset, monomial, &transform.own, frame);
        Maps { inward, outward, edge: inward.grain() }
    }

    /// The images of the children of a cube (`parts` = 2), or of the cube itself (1), in all lanes.
    fn images(&self, cube: &Cube<'_>, parts: u32) -> Images {
        let (lower, upper) = cube.planes();
        let mut images = Images { low: [[0.0; 8]; 3], high: [[0.0; 8]; 3], planes: [[0.0; 3]; 3], edge: 0.0 };
        let edge = (upper[0] - lower[0]) as f64 / parts as f64;
        for axis in 0..3 {
            let low = lower[axis] as f64;
            images.planes[axis] = [low, low + edge, upper[axis] as f64];
        }
        for k in 0..8 {
            let corner =
                [0, 1, 2].map(|axis| images.planes[axis][if parts == 2 { k >> axis & 1 } else { 0 }]);
            let (low, high) = self.inward.around(corner, edge);
            for axis in 0..3 {
                (images.low[axis][k], images.high[axis][k]) = (low[axis], high[axis]);
            }
        }
        images.edge = self.edge * edge;
        images
    }

    /// The children (bit k: child k) whose inverse image may have inner points in common with a cell of the solid's own
    /// frame: those that neither a plane of that lattice nor one of the frame's separates from it. A number that is
    /// none separates nothing.
    #[inline(always)]
    fn touched(&self, images: &Images, corner: [f64; 3], edge: f64) -> u8 {
        let mut apart = [false; 8];
        for axis in 0..3 {
            let (low, high) = (corner[axis], corner[axis] + edge);
            for k in 0..8 {
                apart[k] |= images.low[axis][k] >= high || images.high[axis][k] <= low;
            }
        }
        let mut touched = (0..8).fold(0u8, |mask, k| mask | ((!apart[k]) as u8) << k);
        if touched == 0 || self.inward.is_exact() {
            return touched;
        }
        const UPPER: [u8; 3] = [0xAA, 0xCC, 0xF0];
        let (low, high) = self.outward.around(corner, edge);
        for axis in 0..3 {
            let [first, middle, last] = images.planes[axis];
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

/// Whether a matrix has one entry a row, and that a power of two. (It is not singular.)
fn is_monomial(linear: &[[f64; 3]; 3]) -> bool {
    const MANTISSA: u64 = (1 << 52) - 1;
    linear.iter().all(|row| {
        let mut entries = row.iter().filter(|&&c| c != 0.0);
        entries.next().is_some_and(|c| c.to_bits() & MANTISSA == 0) && entries.next().is_none()
    })
}

/// The inverse of the linear part, each entry off by 5 · 2^-53 of itself at the most: quotients of a minor and the
/// determinant, both of which come from exact sums.
fn inverse(placement: &Affine) -> [[f64; 3]; 3] {
    let m = placement.rows();
    let minor = |i: usize, j: usize| {
        let (r, s) = ((i + 1) % 3, (i + 2) % 3);
        let (c, d) = ((j + 1) % 3, (j + 2) % 3);
        let (plus, minus) = (two_product(m[r][c], m[s][d]), two_product(m[r][d], m[s][c]));
        Expansion::sum([plus.1, -minus.1, plus.0, -minus.0])
    };
    let cofactors = [0, 1, 2].map(|i| [0, 1, 2].map(|j| minor(i, j)));
    let determinant = (0..3)
        .fold(Expansion::default(), |sum, j| sum.plus(&cofactors[0][j].times(&Expansion::sum([m[0][j]]))));
    let determinant = determinant.estimate();
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| cofactors[j][i].estimate() / determinant))
}

/// What has been met in a cell, as bits.
mod met {
    use crate::octree::Tag;

    pub(super) const EMPTY: u8 = 1;
    pub(super) const FULL: u8 = 2;
    pub(super) const UNDECIDED: u8 = 4;
    pub(super) const PART: u8 = 8;

    /// The bit of a cell that is not decided by splitting if it is at the finest level.
    pub(super) fn tag(tag: Tag) -> u8 {
        match tag {
            Tag::Empty => EMPTY,
            Tag::Full => FULL,
            _ => UNDECIDED,
        }
    }
}

impl<S: Solid> Transform<S> {
    /// The image under `placement` of a solid that is known on the frame `own`, and there to no more than its depth.
    pub fn new(solid: S, own: &Frame, placement: &Affine) -> Transform<S> {
        Transform { solid, own: *own, placement: *placement, inverse: inverse(placement) }
    }

    /// Lower corner and edge of a cell of the solid's own frame, in its finest cells.
    #[inline(always)]
    fn extent(&self, cell: Cell) -> ([f64; 3], f64) {
        let shift = self.own.depth() - cell.level;
        (cell.at.map(|a| (a << shift) as f64), (1u32 << shift) as f64)
    }

    /// Splits the cells at hand until none is larger than `edge`, leaving out what `touched` finds to touch nothing.
    fn refine(
        &self,
        scratch: &mut TransformScratch<S>,
        largest: f64,
        touched: impl Fn([f64; 3], f64) -> u8,
    ) -> Result<(), Error> {
        let mut i = 0;
        while let Some(((cell, verdict), _)) = scratch.at_hand.get(i) {
            let cell = *cell;
            let large = cell.level < self.own.depth() && self.extent(cell).1 > largest;
            let part = match verdict {
                Verdict::Partial(part) if large => part.clone(),
                _ => {
                    i += 1;
                    continue;
                }
            };
            scratch.at_hand.swap_remove(i);
            let cube = Cube { frame: &self.own, cell };
            let children = self.solid.split(&mut scratch.own, &cube, &part)?;
            scratch.at_hand.try_reserve(8).map_err(|_| Error::OutOfMemory)?;
            for (octant, child) in (0..8).zip(children) {
                let cell = cell.child(octant);
                let (corner, edge) = self.extent(cell);
                let touched = touched(corner, edge);
                if touched != 0 {
                    scratch.at_hand.push(((cell, child), touched));
                }
            }
        }
        Ok(())
    }

    /// Puts the cells of a list at hand that touch something.
    fn take(
        &self,
        scratch: &mut TransformScratch<S>,
        part: TransformPart,
        touched: impl Fn([f64; 3], f64) -> u8,
    ) -> Result<(), Error> {
        let mut at_hand = core::mem::take(&mut scratch.at_hand);
        at_hand.clear();
        let list = scratch.list(part);
        at_hand.try_reserve(list.len()).map_err(|_| Error::OutOfMemory)?;
        at_hand.extend(list.iter().filter_map(|known| {
            let (corner, edge) = self.extent(known.0);
            let touched = touched(corner, edge);
            (touched != 0).then(|| (known.clone(), touched))
        }));
        scratch.at_hand = at_hand;
        Ok(())
    }

    /// What the cells at hand say of child `k`, whose centre may be asked for if it is of the finest level.
    fn verdict(
        &self,
        scratch: &mut TransformScratch<S>,
        images: &Images,
        k: usize,
        finest: bool,
    ) -> Result<Verdict<TransformPart>, Error> {
        let inside = self.is_inside([0, 1, 2].map(|axis| (images.low[axis][k], images.high[axis][k])));
        Ok(match self.met(&scratch.at_hand, k, inside) {
            met::EMPTY => Verdict::Empty,
            met::FULL => Verdict::Full,
            met::UNDECIDED if !finest => Verdict::Undecided,
            _ => Verdict::Partial(scratch.keep(k)?),
        })
    }

    /// Whether a box lies in the solid's own universe. A number that is none does not.
    fn is_inside(&self, ranges: [(f64, f64); 3]) -> bool {
        ranges.iter().all(|&(low, high)| low >= 0.0 && high <= self.own.cells() as f64)
    }

    /// What has been met in child `k`.
    fn met(&self, at_hand: &[(Known<S::Part>, u8)], k: usize, inside: bool) -> u8 {
        let mut found = if inside { 0 } else { met::tag(self.solid.exterior(&self.own)) };
        for ((cell, verdict), touched) in at_hand {
            if touched >> k & 1 != 0 {
                found |= match verdict {
                    Verdict::Partial(_) if cell.level < self.own.depth() => met::PART,
                    verdict => met::tag(verdict.tag()),
                };
            }
        }
        found
    }

    /// As [`root`](Solid::root) with what the solid itself said of its universe, in the same scratch memory.
    pub(crate) fn root_from(
        &self,
        scratch: &mut TransformScratch<S>,
        frame: &Frame,
        own: &Verdict<S::Part>,
    ) -> Result<Verdict<TransformPart>, Error> {
        let maps = *scratch.maps.insert(Maps::new(self, frame));
        let images = maps.images(&Cube { frame, cell: Cell::ROOT }, 1);
        scratch.at_hand.clear();
        let (corner, edge) = self.extent(Cell::ROOT);
        let touched = maps.touched(&images, corner, edge);
        scratch.at_hand.try_reserve(1).map_err(|_| Error::OutOfMemory)?;
        scratch.at_hand.push(((Cell::ROOT, own.clone()), touched));
        self.refine(scratch, images.edge, |corner, edge| maps.touched(&images, corner, edge))?;
        self.verdict(scratch, &images, 0, false)
    }
}

impl<S: Solid> Solid for Transform<S> {
    type Part = TransformPart;
    type Scratch = TransformScratch<S>;

    fn root(
        &self,
        scratch: &mut TransformScratch<S>,
        frame: &Frame,
    ) -> Result<Verdict<TransformPart>, Error> {
        let own = self.solid.root(&mut scratch.own, &self.own)?;
        self.root_from(scratch, frame, &own)
    }

    fn split(
        &self,
        scratch: &mut TransformScratch<S>,
        cube: &Cube<'_>,
        part: &TransformPart,
    ) -> Result<[Verdict<TransformPart>; 8], Error> {
        const UNDECIDED: Verdict<TransformPart> = Verdict::Undecided;
        let mut verdicts = [UNDECIDED; 8];
        let Some(maps) = scratch.maps else { return Ok(verdicts) };
        let images = maps.images(cube, 2);
        let touched = |corner, edge| maps.touched(&images, corner, edge);
        self.take(scratch, *part, touched)?;
        self.refine(scratch, images.edge, touched)?;
        let finest = cube.cell.level + 1 == cube.frame.depth();
        for (k, verdict) in verdicts.iter_mut().enumerate() {
            *verdict = self.verdict(scratch, &images, k, finest)?;
        }
        Ok(verdicts)
    }

    fn sample(
        &self,
        scratch: &mut TransformScratch<S>,
        cube: &Cube<'_>,
        part: &TransformPart,
    ) -> Result<Option<bool>, Error> {
        let Some(Maps { inward, .. }) = scratch.maps else { return Ok(None) };
        let mark = scratch.own.mark();
        let centre = inward.image(cube.cell.at.map(|a| a as f64 + 0.5), 0.0).0;
        let touched = |corner, edge| inward.leads_into(centre, corner, edge) as u8;
        self.take(scratch, *part, touched)?;
        self.refine(scratch, 0.0, touched)?;
        let range = |axis: usize| (centre[axis] - inward.error[axis], centre[axis] + inward.error[axis]);
        let inside = match self.met(&scratch.at_hand, 0, self.is_inside([0, 1, 2].map(range))) {
            met::EMPTY => Some(false),
            met::FULL => Some(true),
            _ => match scratch.at_hand.as_slice() {
                [((cell, Verdict::Partial(part)), _)] if inward.keeps_centres() => {
                    let (cell, part) = (*cell, part.clone());
                    self.solid.sample(&mut scratch.own, &Cube { frame: &self.own, cell }, &part)?
                }
                _ => None,
            },
        };
        scratch.own.release(mark);
        Ok(inside)
    }

    fn exterior(&self, frame: &Frame) -> Tag {
        let maps = Maps::new(self, frame);
        let (low, high) = maps.outward.around([0.0; 3], self.own.cells() as f64);
        let inside = (0..3).all(|axis| low[axis] >= 0.0 && high[axis] <= frame.cells() as f64);
        if inside { self.solid.exterior(&self.own) } else { Tag::Partial }
    }

    fn hand_over(
        &self,
        from: &TransformScratch<S>,
        part: &TransformPart,
        to: &mut TransformScratch<S>,
    ) -> Result<TransformPart, Error> {
        to.maps = from.maps;
        let list = from.list(*part);
        to.known.try_reserve(list.len()).map_err(|_| Error::OutOfMemory)?;
        for (cell, verdict) in list {
            let verdict = match verdict {
                Verdict::Partial(part) => {
                    Verdict::Partial(self.solid.hand_over(&from.own, part, &mut to.own)?)
                }
                decided => decided.clone(),
            };
            to.known.push((*cell, verdict));
        }
        to.close()
    }
}
