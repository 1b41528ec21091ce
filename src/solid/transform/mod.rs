//! Any solid under an affine map.

mod image;

use super::{Fingerprint, Fingerprinter, Scratch, Solid, Verdict};
use crate::error::Error;
use crate::lattice::{Affine, Cell, Cube, Frame};
use crate::octree::Tag;
use alloc::vec::Vec;
use core::ops::Range;
use image::{Images, Maps, Point, Target, inverse};

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
    /// Where the list of a part lies; empty for one that nobody made.
    fn range(&self, part: TransformPart) -> Range<usize> {
        let first = part.0.checked_sub(1).map_or(Some(0), |before| Some(self.lists.get(before)?.0));
        let end = self.lists.get(part.0).map(|list| list.0);
        first.zip(end).map_or(0..0, |(first, end)| first..end)
    }

    /// Makes a list of the cells at hand that a child (as a bit) touches.
    fn keep(&mut self, child: u8) -> Result<TransformPart, Error> {
        self.known.try_reserve(self.at_hand.len()).map_err(|_| Error::OutOfMemory)?;
        let touched = self.at_hand.iter().filter(|(_, children)| children & child != 0);
        self.known.extend(touched.map(|(known, _)| known.clone()));
        self.close()
    }

    fn close(&mut self) -> Result<TransformPart, Error> {
        self.lists.try_reserve(1).map_err(|_| Error::OutOfMemory)?;
        self.lists.push((self.known.len(), self.own.mark()));
        Ok(TransformPart(self.lists.len() - 1))
    }
}

/// In which of up to eight cells (bit k: cell k) something has been met.
#[derive(Default)]
struct Met {
    empty: u8,
    full: u8,
    undecided: u8,
    /// What may yet be decided by splitting.
    part: u8,
}

impl Met {
    fn add(&mut self, tag: Tag, cells: u8) {
        match tag {
            Tag::Empty => self.empty |= cells,
            Tag::Full => self.full |= cells,
            Tag::Partial | Tag::Branch => self.undecided |= cells,
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

    /// Puts the cells of a list at hand that touch a target, those larger than its grain replaced by their children.
    fn gather(
        &self,
        scratch: &mut TransformScratch<S>,
        part: TransformPart,
        target: &impl Target,
        grain: f64,
    ) -> Result<(), Error> {
        let range = scratch.range(part);
        let TransformScratch { known, at_hand, own, .. } = scratch;
        at_hand.clear();
        let list = known.get(range).unwrap_or(&[]);
        at_hand.try_reserve(list.len()).map_err(|_| Error::OutOfMemory)?;
        for known in list {
            let touched = if self.is_large(known, grain) {
                self.replace(known, own, target, at_hand)?;
                0
            } else {
                let (corner, edge) = self.extent(known.0);
                target.touched(corner, edge)
            };
            if touched != 0 {
                at_hand.try_reserve(1).map_err(|_| Error::OutOfMemory)?;
                at_hand.push((known.clone(), touched));
            }
        }
        // Mostly one step is all; the first, and that to a point, may take more.
        let mut i = 0;
        while let Some((known, _)) = at_hand.get(i) {
            if self.is_large(known, grain) {
                let (known, _) = at_hand.swap_remove(i);
                self.replace(&known, own, target, at_hand)?;
            } else {
                i += 1;
            }
        }
        Ok(())
    }

    /// Whether a cell is to be split.
    #[inline(always)]
    fn is_large(&self, (cell, verdict): &Known<S::Part>, grain: f64) -> bool {
        matches!(verdict, Verdict::Partial(_))
            && cell.level < self.own.depth()
            && self.extent(*cell).1 > grain
    }

    /// Puts the children of a PARTIAL cell at hand that touch a target.
    fn replace(
        &self,
        (cell, verdict): &Known<S::Part>,
        own: &mut S::Scratch,
        target: &impl Target,
        at_hand: &mut Vec<(Known<S::Part>, u8)>,
    ) -> Result<(), Error> {
        let Verdict::Partial(part) = verdict else { return Ok(()) };
        let children = self.solid.split(own, &Cube { frame: &self.own, cell: *cell }, part)?;
        let (corner, edge) = self.extent(*cell);
        let touched = target.touched_by_children(corner, edge);
        at_hand.try_reserve(8).map_err(|_| Error::OutOfMemory)?;
        for (octant, (child, touched)) in (0..8).zip(children.into_iter().zip(touched)) {
            if touched != 0 {
                at_hand.push(((cell.child(octant), child), touched));
            }
        }
        Ok(())
    }

    /// What the cells at hand say of the first `count` children, whose centres may be asked for if they are `finest`.
    fn verdicts(
        &self,
        scratch: &mut TransformScratch<S>,
        images: &Images<'_>,
        count: usize,
        finest: bool,
    ) -> Result<[Verdict<TransformPart>; 8], Error> {
        let Met { empty, full, undecided, part } =
            self.met(&scratch.at_hand, images.reach_beyond(self.own.cells() as f64));
        let mut verdicts = [const { Verdict::Undecided }; 8];
        for (k, verdict) in verdicts.iter_mut().enumerate().take(count) {
            let child = 1 << k;
            *verdict = match [empty, full, undecided, part].map(|met| met & child != 0) {
                [true, false, false, false] => Verdict::Empty,
                [false, true, false, false] => Verdict::Full,
                [false, false, _, false] if !finest => Verdict::Undecided,
                _ => Verdict::Partial(scratch.keep(child)?),
            };
        }
        Ok(verdicts)
    }

    /// What has been met, in those that reach `beyond` the solid's own universe also what is there.
    fn met(&self, at_hand: &[(Known<S::Part>, u8)], beyond: u8) -> Met {
        let mut met = Met::default();
        if beyond != 0 {
            met.add(self.solid.exterior(&self.own), beyond);
        }
        for ((cell, verdict), touched) in at_hand {
            match verdict {
                Verdict::Partial(_) if cell.level < self.own.depth() => met.part |= touched,
                verdict => met.add(verdict.tag(), *touched),
            }
        }
        met
    }

    /// Whether cells that are not EMPTY (not FULL, if `hollow`) may reach beyond the universe of `frame`: some cells that
    /// do are split to see.
    fn reaches_beyond(&self, frame: &Frame, hollow: bool) -> Result<bool, Error> {
        const MOST: usize = 512;
        let outward = self.maps(frame).outward;
        let cells = frame.cells() as f64;
        let mut scratch = S::Scratch::default();
        let mut open = Vec::new();
        open.try_reserve(8 * MOST).map_err(|_| Error::OutOfMemory)?;
        open.push((Cell::ROOT, self.solid.root(&mut scratch, &self.own)?));
        let mut left = MOST;
        while let Some((cell, verdict)) = open.pop() {
            let (corner, edge) = self.extent(cell);
            let (low, high) = outward.around(corner, edge);
            if verdict.tag() == if hollow { Tag::Full } else { Tag::Empty }
                || (0..3).all(|axis| low[axis] >= 0.0 && high[axis] <= cells)
            {
                continue;
            }
            let Verdict::Partial(part) = verdict else { return Ok(true) };
            if cell.level == self.own.depth() || left == 0 {
                return Ok(true);
            }
            left -= 1;
            let children = self.solid.split(&mut scratch, &Cube { frame: &self.own, cell }, &part)?;
            open.extend((0..8).map(|octant| cell.child(octant)).zip(children));
        }
        Ok(false)
    }

    fn maps(&self, frame: &Frame) -> Maps {
        Maps::new(&self.placement, &self.inverse, frame, &self.own)
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
        let maps = *scratch.maps.insert(self.maps(frame));
        scratch.lists.clear();
        scratch.known.clear();
        let own = self.solid.root(&mut scratch.own, &self.own)?;
        scratch.known.try_reserve(1).map_err(|_| Error::OutOfMemory)?;
        scratch.known.push((Cell::ROOT, own));
        let universe = scratch.close()?;
        let images = Images::new(&maps, &Cube { frame, cell: Cell::ROOT }, 1);
        self.gather(scratch, universe, &images, images.grain)?;
        let [universe, ..] = self.verdicts(scratch, &images, 1, false)?;
        Ok(universe)
    }

    fn split(
        &self,
        scratch: &mut TransformScratch<S>,
        cube: &Cube<'_>,
        part: &TransformPart,
    ) -> Result<[Verdict<TransformPart>; 8], Error> {
        let Some(maps) = scratch.maps else { return Ok([const { Verdict::Undecided }; 8]) };
        let images = Images::new(&maps, cube, 2);
        self.gather(scratch, *part, &images, images.grain)?;
        self.verdicts(scratch, &images, 8, cube.cell.level + 1 == cube.frame.depth())
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
        let point = Point { map: &inward, at: centre };
        self.gather(scratch, *part, &point, 0.0)?;
        let Met { empty, full, undecided, part } =
            self.met(&scratch.at_hand, point.reaches_beyond(self.own.cells() as f64));
        let inside = match [empty, full, undecided, part].map(|met| met != 0) {
            [true, false, false, false] => Some(false),
            [false, true, false, false] => Some(true),
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
        match self.solid.exterior(&self.own) {
            // What is FULL around its own universe must be so around the frame's.
            Tag::Full if self.reaches_beyond(frame, true).is_ok_and(|beyond| !beyond) => Tag::Full,
            Tag::Empty if self.reaches_beyond(frame, false).is_ok_and(|beyond| !beyond) => Tag::Empty,
            _ => Tag::Partial,
        }
    }

    fn nesting(&self) -> u32 {
        self.solid.nesting()
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let [x, y, z] = self.own.origin();
        let frame = [x, y, z, self.own.edge(), self.own.depth() as f64];
        let solid = self.solid.fingerprint()?;
        let transform = Fingerprinter::new("transform").part(solid).numbers(&frame);
        Some(transform.numbers(self.placement.rows().as_flattened()).finish())
    }

    fn hand_over(
        &self,
        from: &TransformScratch<S>,
        part: &TransformPart,
        to: &mut TransformScratch<S>,
    ) -> Result<TransformPart, Error> {
        to.maps = from.maps;
        let list = from.known.get(from.range(*part)).unwrap_or(&[]);
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
