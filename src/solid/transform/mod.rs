//! Any solid under an affine map.

mod faces;
mod image;
mod polytope;
mod regions;
mod same;
mod slabs;
mod splits;
mod surfaces;

use super::{
    Ask, AskLayers, AskWhole, Batch, Classifier, Direct, Enclosure, Fingerprint, Fingerprinter,
    LayersQuestion, OCTANTS, OpenSurfaces, Parts, Question, Solid, Verdict, WholeQuestion, Worker,
    sample_one_by_one, split_one_by_one, surface_cell,
};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Affine, Bounds, Cell, Cube, Frame, Inverse, MAX_DEPTH};
use crate::memory;
use crate::octree::{Proof, Tag};
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::ops::Range;
use image::{Images, Maps, Point, Target};
use same::Turn;
use slabs::Source;
use splits::{AtOnce, Gathered, Splits};
use surfaces::Surfaces;

/// A solid, known on a frame of its own, under an affine placement.
///
/// A cell is FULL (or EMPTY) if its inverse image touches only FULL (or only EMPTY) cells of the solid's own
/// frame: cells of about its size, or larger cells that are decided. So a surface that is not parallel to the
/// lattice blurs by about a cell. A finer frame makes the blur as small as desired, down to the depth of the
/// solid's own frame. Rounding is outward.
///
/// Some maps take lattice planes to lattice planes: a permutation of the axes, with signs and powers of two
/// as scales, and an offset by whole cells. Then nothing is rounded and nothing blurs: with cells of the same
/// size, each finest cell of the result is one of the solid's.
///
/// Beyond the solid's own universe, [`exterior`](Classifier::exterior) decides: the result is undecided
/// there, unless the solid is proven to end inside. Centres ([`Rule::Sampled`](crate::Rule::Sampled)) are
/// decided where cells of the solid's own depth decide them, or, if the placement is an offset by whole
/// cells, by the solid. With [`nearest`](Self::nearest) every centre is decided.
///
/// The solid's enclosures of its surface ([`Enclosure`]) give enclosures of the result: one slab a cell, as
/// thin as the surface is flat there. Where nothing blurs, they are the solid's own enclosures, exactly.
///
/// The surfaces of a stored solid ([`build_extended`](crate::build_extended)) are moved exactly. Where all
/// the cells that a cell touches agree with one function of up to six surfaces, the result is known as its
/// source is, and splits below any depth. A tree that is built from the result keeps the same surfaces. Faces
/// in planes of the solid's own lattice, which cross no cell and which no cell keeps, are moved exactly too,
/// if they are few. Cells that the source gave up stay undecided.
///
/// ```
/// use leafless::{Affine, Control, Csg, Frame, Rule, build, solid::Transform};
/// let block = Csg::cuboid([-1.0, -0.5, -0.25], [1.0, 0.5, 0.25])?;
/// let own = Frame::new([-2.0; 3], 4.0, 8)?;
/// // Turned by the angle whose cosine is 0.8, and moved.
/// let placement =
///     Affine::new([[0.8, -0.6, 0.0, 3.0], [0.6, 0.8, 0.0, 2.0], [0.0, 0.0, 1.0, 2.0]])?;
/// let solid = Transform::new(block, &own, &placement);
/// let tree = build(&solid, &Frame::new([0.0; 3], 5.0, 7)?, Rule::Certified, &Control::default())?;
/// assert!(tree.statistics().volume().contains(1.0));
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Debug)]
pub struct Transform<S> {
    solid: Arc<S>,
    own: Option<Frame>,
    placement: Affine,
    nearest: bool,
}

/// A solid on its own frame, under an affine placement, on another frame.
#[derive(Debug, Clone)]
pub struct TransformClassifier<C> {
    inner: C,
    own: Frame,
    maps: Maps,
    frame: Frame,
    /// A box around the placed solid, if one is known.
    bounds: Option<Bounds>,
    placement: Affine,
    proof: Proof,
    /// The moved surfaces of a stored solid that keeps surfaces.
    surfaces: Option<Arc<Surfaces>>,
    /// Whether the cell that contains the inverse image of a centre decides the centre.
    nearest: bool,
}

/// A worker on a placed solid. It keeps a list of cells of the solid's own frame for each PARTIAL cell.
pub struct TransformWorker<W: Worker> {
    inner: W,
    own: Frame,
    maps: Maps,
    placement: Affine,
    frame: Frame,
    /// The state of the space around the solid's own universe.
    exterior: Tag,
    surfaces: Option<Arc<Surfaces>>,
    nearest: bool,
    known: Vec<Known<W::Part>>,
    /// For each list, its end among the cells, and the height of the solid's own memory when the list was
    /// made.
    lists: Vec<(usize, usize)>,
    /// The cells at hand during a split, each with the children that touch it.
    at_hand: Vec<(Known<W::Part>, u8)>,
}

/// The data about a PARTIAL cell.
#[derive(Debug, Clone, Copy)]
pub struct TransformPart(What);

#[derive(Debug, Clone, Copy)]
enum What {
    /// The number of the list in scratch memory of the cells of the solid's own frame that the cell touches.
    List(usize),
    /// The function of the moved surfaces that the solid is in the cell.
    Function(OpenSurfaces),
}

/// The results before an error, and the error, if there was one.
type SoFar<T> = (T, Result<(), Error>);

/// A cell of the solid's own frame, with its verdict.
type Known<P> = (Cell, Verdict<P>);

/// The cells (bit k: cell k, of up to eight) in which each verdict was found.
#[derive(Default)]
struct Met {
    empty: u8,
    full: u8,
    undecided: u8,
    /// The cells that a further split may decide.
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
    /// The image under `placement` of a solid that is known on the frame `own`, down to the depth of that
    /// frame.
    pub fn new(solid: S, own: &Frame, placement: &Affine) -> Transform<S> {
        Transform { solid: Arc::new(solid), own: Some(*own), placement: *placement, nearest: false }
    }

    /// The image under `placement` of a solid that is known on a frame of its own ([`home`](Solid::home)), or
    /// on any frame. For a solid without a frame of its own, an own frame is chosen for each frame of the
    /// image. Where the cells are images of cells, it is the inverse image of the frame. Otherwise it is the
    /// least cube around the solid, with cells that are no larger.
    pub fn of(solid: S, placement: &Affine) -> Transform<S> {
        let own = solid.home();
        Transform { solid: Arc::new(solid), own, placement: *placement, nearest: false }
    }

    /// The same transform, with centres decided by the nearest centre of the solid's own frame. Under
    /// [`Rule::Sampled`](crate::Rule::Sampled), a finest cell is FULL if the own cell that contains the
    /// inverse image of its centre is FULL or has its own centre inside. So an octree that is made of samples
    /// is sampled again, on a lattice that is turned, coarser or finer. This is the customary way to move
    /// voxels: the nearest voxel, without interpolation. A surface is displaced by up to half a diagonal of
    /// the solid's own cells. Verdicts on cells do not change, and neither do the other rules.
    ///
    /// An inverse image on a face between cells belongs to the upper cell, as points on faces always do.
    /// [`Error::NotSampled`] is returned if the own cell that contains the inverse image does not know
    /// whether its own centre lies inside, like a PARTIAL cell of a stored octree.
    /// [`resolve`](crate::op::resolve) decides such cells beforehand.
    ///
    /// ```
    /// use leafless::{Affine, Control, Csg, Frame, Rule, build, solid::Transform};
    /// let (frame, control) = (Frame::new([0.0; 3], 16.0, 6)?, Control::default());
    /// let tree = build(&Csg::ball([8.0; 3], 4.0)?, &frame, Rule::Sampled, &control)?;
    /// let turned = Affine::new([[0.8, -0.6, 0.0, 3.0], [0.6, 0.8, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]])?;
    /// let moved = Transform::of(tree, &turned).nearest();
    /// // The centres of cells twice as large come from corners of the tree's own cells.
    /// let coarse = build(&moved, &Frame::new([0.0; 3], 16.0, 5)?, Rule::Sampled, &control)?;
    /// assert!((coarse.statistics().volume().lower / 268.1 - 1.0).abs() < 0.05);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    #[must_use]
    pub fn nearest(self) -> Transform<S> {
        Transform { nearest: true, ..self }
    }

    /// The solid that is moved.
    pub fn solid(&self) -> &S {
        &self.solid
    }

    /// Chooses an own frame for a solid that has none.
    fn own_frame(&self, frame: &Frame) -> Result<Frame, Error> {
        let inverse = self.placement.inverse_linear();
        if let Some(exact) = image::source_frame(&self.placement, &inverse, frame) {
            return Ok(exact);
        }
        // The inverse image of the universe, rounded generously.
        let [min, max] = image::source_box(&self.placement, &inverse, &Bounds::of(frame));
        let seen = Bounds::new(min, max);
        let cell = frame.cell_size() * image::shrinkage(&inverse);
        let around = |bounds: Bounds| -> Result<(Frame, bool), Error> {
            let own = Frame::around(bounds.min, bounds.max, MAX_DEPTH)?;
            let fits = |&depth: &u8| own.edge() / f64::from(1u32 << depth) <= cell;
            let depth = (1..=MAX_DEPTH).find(fits);
            Ok((own.with_depth(depth.unwrap_or(MAX_DEPTH))?, depth.is_some()))
        };
        // A frame around the whole solid, so that the solid ends inside. If that is too large, around its
        // visible part.
        let bounds = self.solid.bounds();
        if let Some(Ok((own, true))) = bounds.map(around) {
            return Ok(own);
        }
        let common = seen.and_then(|seen| seen.common(&bounds?)).or(seen).or(bounds);
        // (The intersection of both boxes may be flat.)
        let found = [common, seen].into_iter().flatten().find_map(|bounds| around(bounds).ok());
        let problem = "moves the universe so far that doubles cannot resolve it";
        found.map(|(own, _)| own).ok_or(Error::Argument { name: "placement", problem })
    }
}

impl<S: Solid> Solid for Transform<S> {
    type Classifier = TransformClassifier<S::Classifier>;

    fn on(&self, frame: &Frame, control: &Control<'_>) -> Result<Self::Classifier, Error> {
        let own = match self.own {
            Some(own) => own,
            None => self.own_frame(frame)?,
        };
        let mut placed =
            TransformClassifier::new(self.solid.on(&own, control)?, &self.placement, frame, self.bounds());
        placed.nearest = self.nearest;
        if self.solid.home().is_some() {
            placed.keep_surfaces(control)?;
        }
        Ok(placed)
    }

    fn bounds(&self) -> Option<Bounds> {
        self.solid.bounds()?.placed(&self.placement)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let name = if self.nearest { "nearest transform" } else { "transform" };
        let transform = Fingerprinter::new(name).part(self.solid.fingerprint()?);
        let transform = match &self.own {
            Some(own) => {
                let [x, y, z] = own.origin();
                transform.numbers(&[x, y, z, own.edge(), own.depth() as f64])
            }
            None => transform.numbers(&[]),
        };
        Some(transform.numbers(self.placement.rows().as_flattened()).finish())
    }

    /// A transform that is the identity takes the new placement, so that the solid is moved only once.
    fn placed(&self, placement: &Affine) -> Result<Option<Self>, Error> {
        let moved = || Transform { placement: *placement, ..self.clone() };
        Ok(self.placement.is_identity().then(moved))
    }

    fn kept_bytes(&self) -> u64 {
        self.solid.kept_bytes()
    }
}

impl<S> Clone for Transform<S> {
    fn clone(&self) -> Self {
        Transform { solid: self.solid.clone(), ..*self }
    }
}

impl<C: Classifier> TransformClassifier<C> {
    /// Places the solid of a classifier: a pose changes a map, and nothing else. `bounds` is a box around the
    /// placed solid, if one is known. O(1).
    pub(crate) fn new(inner: C, placement: &Affine, frame: &Frame, bounds: Option<Bounds>) -> Self {
        let own = *inner.frame();
        let maps = Maps::new(placement, &placement.inverse_linear(), frame, &own);
        let proof = inner.proof();
        let proof = proof.moved(placement.stretched(proof.displacement()));
        let placement = *placement;
        let frame = *frame;
        TransformClassifier {
            inner,
            own,
            maps,
            frame,
            bounds,
            placement,
            proof,
            surfaces: None,
            nearest: false,
        }
    }

    /// Lets the moved surfaces of the solid decide cells, if the solid keeps any. O(surfaces).
    fn keep_surfaces(&mut self, control: &Control<'_>) -> Result<(), Error> {
        let surfaces = Surfaces::of(&self.inner, &self.placement, &self.frame, control)?;
        self.surfaces = surfaces.map(Arc::new);
        Ok(())
    }

    /// Lower corner and edge of a cell of the solid's own frame, in its finest cells.
    fn extent(&self, cell: Cell) -> ([f64; 3], f64) {
        extent(&self.own, cell)
    }

    /// Returns whether cells that are not EMPTY (not FULL, if `hollow`) may reach beyond the universe. Some
    /// cells that do are split to find out.
    fn reaches_beyond(&self, hollow: bool) -> Result<bool, Error> {
        const MOST: usize = 512;
        let outward = self.maps.outward;
        let cells = self.frame.cells() as f64;
        let mut worker = self.inner.worker()?;
        let mut open = Vec::new();
        open.try_reserve(8 * MOST)?;
        open.push((Cell::ROOT, worker.root()?));
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
            let children = worker.split(cell, &part)?;
            open.extend((0..8).map(|octant| cell.child(octant)).zip(children));
        }
        Ok(false)
    }
}

impl<C: Classifier> Classifier for TransformClassifier<C> {
    type Worker = TransformWorker<C::Worker>;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn worker(&self) -> Result<Self::Worker, Error> {
        Ok(TransformWorker {
            inner: self.inner.worker()?,
            own: self.own,
            maps: self.maps,
            placement: self.placement,
            frame: self.frame,
            exterior: self.inner.exterior(),
            surfaces: self.surfaces.clone(),
            nearest: self.nearest,
            known: Vec::new(),
            lists: Vec::new(),
            at_hand: Vec::new(),
        })
    }

    /// May split some hundred cells to find out.
    fn exterior(&self) -> Tag {
        match self.inner.exterior() {
            Tag::Empty if self.bounds.is_some_and(|bounds| bounds.is_within(&self.frame)) => Tag::Empty,
            // If the space around the solid's own universe is FULL, it must also be FULL around the frame's
            // universe.
            Tag::Full if self.reaches_beyond(true).is_ok_and(|beyond| !beyond) => Tag::Full,
            Tag::Empty if self.reaches_beyond(false).is_ok_and(|beyond| !beyond) => Tag::Empty,
            _ => Tag::Partial,
        }
    }

    fn proof(&self) -> Proof {
        self.proof
    }

    fn kept_bytes(&self) -> u64 {
        self.inner.kept_bytes() + self.surfaces.as_ref().map_or(0, |surfaces| surfaces.bytes() as u64)
    }

    /// Surfaces and points are moved.
    fn answer_whole(&self, question: WholeQuestion<'_>, control: &Control<'_>) -> Result<(), Error> {
        match question {
            WholeQuestion::Surfaces(known) => {
                if let Some(surfaces) = &self.surfaces {
                    *known = Some(memory::collected(surfaces.moved.iter().cloned())?);
                } else if let Some(own) = self.inner.surfaces(control)? {
                    *known =
                        Some(memory::collected(own.iter().map(|surface| surface.placed(&self.placement)))?);
                }
                Ok(())
            }
            WholeQuestion::Layers(known) => {
                if let Some(surfaces) = &self.surfaces {
                    *known = Some(memory::collected(surfaces.moved.iter().cloned())?);
                } else if let Some(own) = self.inner.layers(control)? {
                    *known =
                        Some(memory::collected(own.iter().map(|surface| surface.placed(&self.placement)))?);
                }
                Ok(())
            }
            WholeQuestion::Direct(Direct::Points, _) => self.inner.answer_whole(question, control),
            _ => Ok(()),
        }
    }
}

/// Lower corner and edge of a cell of a frame, in its finest cells.
#[inline(always)]
fn extent(frame: &Frame, cell: Cell) -> ([f64; 3], f64) {
    let shift = frame.depth() - cell.level;
    (cell.at.each(|a| (a << shift) as f64), (1u32 << shift) as f64)
}

impl<W: Worker> TransformWorker<W> {
    /// The range of a part's list among the cells; empty for a part without a list.
    fn range(&self, part: TransformPart) -> Range<usize> {
        let What::List(list) = part.0 else { return 0..0 };
        let first = list.checked_sub(1).map_or(0, |before| self.lists[before].0);
        first..self.lists[list].0
    }

    /// Makes a list of the cells at hand that a child (as a bit) touches.
    fn keep(&mut self, child: u8) -> Result<TransformPart, Error> {
        self.known.try_reserve(self.at_hand.len())?;
        let touched = self.at_hand.iter().filter(|(_, children)| children & child != 0);
        self.known.extend(touched.map(|(known, _)| known.clone()));
        self.close()
    }

    fn close(&mut self) -> Result<TransformPart, Error> {
        memory::push(&mut self.lists, (self.known.len(), self.inner.mark()))?;
        Ok(TransformPart(What::List(self.lists.len() - 1)))
    }

    /// The verdict on a cell whose list is the last one. If the cell is a function of the moved surfaces,
    /// that function replaces the list.
    fn known_of(&mut self, cell: Cell, part: TransformPart) -> Result<Verdict<TransformPart>, Error> {
        // (A cell that is the image of a cell takes its answers from that cell.)
        let Some(surfaces) = self.surfaces.clone().filter(|_| self.source(cell, part).is_none()) else {
            return Ok(Verdict::Partial(part));
        };
        let range = self.range(part);
        let mut sources = memory::with_capacity(range.len() + 6)?;
        for (source, verdict) in &self.known[range.clone()] {
            let Some(known) = faces::known(&mut self.inner, *source, verdict)? else {
                return Ok(Verdict::Partial(part));
            };
            let (low, edge) = extent(&self.own, *source);
            sources.push(surfaces::Source { cell: Some(*source), low, high: low.each(|c| c + edge), known });
        }
        let mut target = surfaces::Target::new(&surfaces, &self.maps, &self.frame, cell);
        sources.extend(target.beyond(self.own.cells() as f64, self.exterior));
        let Some(known) = target.function(&sources)? else { return Ok(Verdict::Partial(part)) };
        // (The memory of the solid's own worker is still needed for the cells at hand.)
        self.known.truncate(range.start);
        self.lists.pop();
        Ok(verdict_of(known))
    }

    /// Collects, from a list, the cells at hand that touch a target. Cells larger than the grain are replaced
    /// by their children. Where rounding makes a target so large that too many cells touch it, the cells stay
    /// larger.
    fn gather(&mut self, part: TransformPart, target: &impl Target, grain: f64) -> Result<(), Error> {
        let (range, own) = (self.range(part), self.own);
        // (Points need the smallest cells; so do cells that are the images of cells.)
        let all = self.surfaces.is_none() || grain == 0.0 || self.maps.inward.is_exact();
        let TransformWorker { known, at_hand, inner, .. } = self;
        let is_complete = gather(&own, &known[range], target, grain, &mut AtOnce(inner, all), at_hand)?;
        debug_assert!(is_complete);
        Ok(())
    }

    /// Collects cells for many targets; the cells to split are split together, round by round. An error comes
    /// with the results so far.
    fn gather_many<T: Target>(
        &mut self,
        targets: &[(TransformPart, T, f64)],
        control: &Control<'_>,
    ) -> Result<SoFar<Gathered<W::Part>>, Error> {
        let mut splits = Gathered::new();
        // The cells of a list are at most some levels too large, and each round splits the cells of one
        // level.
        loop {
            for (part, target, grain) in targets {
                let (range, own) = (self.range(*part), self.own);
                gather(&own, &self.known[range], target, *grain, &mut splits, &mut self.at_hand)?;
            }
            let wanted = splits.take_wanted();
            let mut answers = Vec::new();
            let done = match wanted.is_empty() {
                true => Ok(()),
                false => control.check().and_then(|()| self.inner.split_many(&wanted, control, &mut answers)),
            };
            // Without new answers another round would find nothing.
            let is_last = answers.is_empty() || done.is_err();
            splits.learn(&wanted, answers)?;
            if is_last {
                return Ok((splits, done));
            }
        }
    }

    /// Collects the cells at hand from splits that were requested before; `false` if some splits are missing.
    fn gather_known(
        &mut self,
        part: TransformPart,
        target: &impl Target,
        grain: f64,
        splits: &mut Gathered<W::Part>,
    ) -> Result<bool, Error> {
        let (range, own) = (self.range(part), self.own);
        gather(&own, &self.known[range], target, grain, splits, &mut self.at_hand)
    }

    /// The verdicts of the cells at hand on the eight children of a cell, or (`count` = 1) on the cell
    /// itself. Only finest cells may be sampled at their centres.
    fn verdicts(
        &mut self,
        images: &Images<'_>,
        cell: Cell,
        count: usize,
    ) -> Result<[Verdict<TransformPart>; 8], Error> {
        let finest = count == 8 && cell.level + 1 == self.frame.depth();
        let Met { empty, full, undecided, part } = self.met(images.reach_beyond(self.own.cells() as f64));
        let mut verdicts = [const { Verdict::Undecided }; 8];
        for (k, verdict) in OCTANTS.into_iter().zip(&mut verdicts).take(count) {
            let child = 1 << k;
            *verdict = match [empty, full, undecided, part].each(|met| met & child != 0) {
                [true, false, false, false] => Verdict::Empty,
                [false, true, false, false] => Verdict::Full,
                [false, false, _, false] if !finest => Verdict::Undecided,
                [_, _, undecided, _] => {
                    let (cell, part) = (if count == 8 { cell.child(k) } else { cell }, self.keep(child)?);
                    if undecided { Verdict::Partial(part) } else { self.known_of(cell, part)? }
                }
            };
        }
        Ok(verdicts)
    }

    /// The verdicts that were found; for images that reach `beyond` the solid's own universe, with the
    /// exterior.
    fn met(&self, beyond: u8) -> Met {
        let mut met = Met::default();
        if beyond != 0 {
            met.add(self.exterior, beyond);
        }
        for ((cell, verdict), touched) in &self.at_hand {
            match verdict {
                // (Surfaces are known below any depth.)
                Verdict::Partial(_) if cell.level < self.own.depth() || self.surfaces.is_some() => {
                    met.part |= touched;
                }
                verdict => met.add(verdict.tag(), *touched),
            }
        }
        met
    }
}

/// The verdict on a cell with a known function of surfaces.
fn verdict_of(known: OpenSurfaces) -> Verdict<TransformPart> {
    match known.settled() {
        Some(true) => Verdict::Full,
        Some(false) => Verdict::Empty,
        None => Verdict::Partial(TransformPart(What::Function(known))),
    }
}

/// No cell is split once so many are at hand. A grain leads to some hundred at the most, unless the rounding
/// errors of a map are larger than cells.
const MOST_AT_HAND: usize = 1024;

/// Returns whether a cell must be split.
#[inline(always)]
fn is_to_be_split<P>(
    own: &Frame,
    (cell, verdict): &Known<P>,
    grain: f64,
    splits: &mut impl Splits<P>,
) -> Result<bool, Error> {
    let Verdict::Partial(part) = verdict else { return Ok(false) };
    Ok(cell.level < own.depth() && extent(own, *cell).1 > grain && !splits.is_function(*cell, part)?)
}

/// Collects, from a list, the cells at hand that touch a target. Cells larger than the grain are replaced by
/// their children. Returns `false` if some of these are not known.
fn gather<P: Clone>(
    own: &Frame,
    list: &[Known<P>],
    target: &impl Target,
    grain: f64,
    splits: &mut impl Splits<P>,
    at_hand: &mut Vec<(Known<P>, u8)>,
) -> Result<bool, Error> {
    at_hand.clear();
    at_hand.try_reserve(list.len())?;
    let mut is_complete = true;
    for known in list {
        if at_hand.len() < MOST_AT_HAND && is_to_be_split(own, known, grain, splits)? {
            is_complete &= replace(own, known, splits, target, at_hand)?;
            continue;
        }
        let (corner, edge) = extent(own, known.0);
        let touched = target.touched(corner, edge);
        if touched != 0 {
            memory::push(at_hand, (known.clone(), touched))?;
        }
    }
    // Usually one step suffices. The first descent to a point may take more.
    let mut i = 0;
    while let Some((known, _)) = at_hand.get(i) {
        if at_hand.len() < MOST_AT_HAND && is_to_be_split(own, known, grain, splits)? {
            let (known, _) = at_hand.swap_remove(i);
            is_complete &= replace(own, &known, splits, target, at_hand)?;
        } else {
            i += 1;
        }
    }
    Ok(is_complete)
}

/// Puts those children of a PARTIAL cell at hand that touch a target; returns `false` if they are not known.
fn replace<P: Clone>(
    own: &Frame,
    (cell, verdict): &Known<P>,
    splits: &mut impl Splits<P>,
    target: &impl Target,
    at_hand: &mut Vec<(Known<P>, u8)>,
) -> Result<bool, Error> {
    let Verdict::Partial(part) = verdict else { return Ok(true) };
    let Some(children) = splits.children(*cell, part)? else { return Ok(false) };
    let (corner, edge) = extent(own, *cell);
    let touched = target.touched_by_children(corner, edge);
    at_hand.try_reserve(8)?;
    for (octant, (child, touched)) in (0..8).zip(children.into_iter().zip(touched)) {
        if touched != 0 {
            at_hand.push(((cell.child(octant), child), touched));
        }
    }
    Ok(true)
}

impl<W: Worker> Parts for TransformWorker<W> {
    type Part = TransformPart;

    fn mark(&self) -> usize {
        self.lists.len()
    }

    fn scratch_bytes(&self) -> usize {
        size_of_val(&*self.lists) + size_of_val(&*self.known) + self.inner.scratch_bytes()
    }

    fn release(&mut self, mark: usize) {
        self.lists.truncate(mark);
        let &(known, inner) = self.lists.last().unwrap_or(&(0, 0));
        self.known.truncate(known);
        self.inner.release(inner);
    }

    fn hand_over(&mut self, from: &Self, part: &TransformPart) -> Result<TransformPart, Error> {
        if let What::Function(_) = part.0 {
            return Ok(*part);
        }
        let list = &from.known[from.range(*part)];
        self.known.try_reserve(list.len())?;
        for (cell, verdict) in list {
            let verdict = match verdict {
                Verdict::Partial(part) => Verdict::Partial(self.inner.hand_over(&from.inner, part)?),
                decided => decided.clone(),
            };
            self.known.push((*cell, verdict));
        }
        self.close()
    }
}

impl<W: Worker> Batch for TransformWorker<W> {
    fn likes_many(&self) -> bool {
        self.inner.likes_many()
    }

    /// Cells of the solid's own frame that several cells touch are split once.
    fn split_many(
        &mut self,
        cells: &[(Cell, TransformPart)],
        control: &Control<'_>,
        verdicts: &mut Vec<[Verdict<TransformPart>; 8]>,
    ) -> Result<(), Error> {
        if !self.inner.likes_many() {
            return split_one_by_one(self, cells, control, verdicts);
        }
        verdicts.try_reserve(cells.len())?;
        let (maps, frame) = (self.maps, self.frame);
        let targets = memory::collected(cells.iter().map(|&(cell, part)| {
            let images = Images::new(&maps, &Cube { frame: &frame, cell }, 2);
            let grain = images.grain;
            (part, images, grain)
        }))?;
        let (mut splits, done) = self.gather_many(&targets, control)?;
        for ((cell, _), (part, images, grain)) in cells.iter().zip(&targets) {
            if !self.gather_known(*part, images, *grain, &mut splits)? {
                break;
            }
            verdicts.push(self.verdicts(images, *cell, 8)?);
        }
        done
    }

    fn sample_many(
        &mut self,
        cells: &[(Cell, TransformPart)],
        control: &Control<'_>,
        inside: &mut Vec<Option<bool>>,
    ) -> Result<(), Error> {
        if !self.inner.likes_many() {
            return sample_one_by_one(self, cells, control, inside);
        }
        inside.try_reserve(cells.len())?;
        let (inward, mark) = (self.maps.inward, self.inner.mark());
        let targets =
            memory::collected(cells.iter().map(|&(cell, part)| (part, Point::centre(&inward, cell), 0.0)))?;
        let (mut splits, mut done) = self.gather_many(&targets, control)?;
        let (mut asked, mut places) = (Vec::new(), Vec::new());
        for (part, point, grain) in &targets {
            if !self.gather_known(*part, point, *grain, &mut splits)? {
                break;
            }
            let (answer, open) = self.at_point(point);
            if let Some(open) = open {
                memory::push(&mut asked, open)?;
                memory::push(&mut places, inside.len())?;
            }
            inside.push(answer);
        }
        if !asked.is_empty() {
            let mut found = Vec::new();
            if done.is_ok() {
                done = self.inner.sample_many(&asked, control, &mut found);
            }
            for (&place, answer) in places.iter().zip(&found) {
                inside[place] = *answer;
            }
            // Samples that the solid did not reach are not returned.
            inside.truncate(places.get(found.len()).map_or(inside.len(), |&place| place));
        }
        self.inner.release(mark);
        done
    }

    /// Points are moved where that rounds nothing.
    fn inside(&mut self, points: &[[f64; 3]], answers: &mut [Option<bool>]) -> Result<(), Error> {
        let back = Inverse::of(&self.placement);
        let (mut exact, mut places) = (Vec::new(), Vec::new());
        for (place, &point) in points.iter().enumerate() {
            // (The solid decides only points of its own universe.)
            if let Some(image) = back.exact_image(point).filter(|image| self.own.cell_of(*image).is_some()) {
                memory::push(&mut exact, image)?;
                memory::push(&mut places, place)?;
            }
        }
        let mut found = memory::filled(exact.len(), None)?;
        self.inner.inside(&exact, &mut found)?;
        places.into_iter().zip(found).for_each(|(place, found)| answers[place] = found);
        Ok(())
    }

    /// A part needs the path: the cells of the solid's own frame that a cell touches are found on the way to
    /// it.
    fn recall(&mut self, _: Cell) -> Option<TransformPart> {
        None
    }
}

impl<W: Worker> Worker for TransformWorker<W> {
    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<TransformPart>, Error> {
        let root = self.inner.root()?;
        memory::push(&mut self.known, (Cell::ROOT, root))?;
        let universe = self.close()?;
        let (maps, frame) = (self.maps, self.frame);
        let images = Images::new(&maps, &Cube { frame: &frame, cell: Cell::ROOT }, 1);
        self.gather(universe, &images, images.grain)?;
        let [universe, ..] = self.verdicts(&images, Cell::ROOT, 1)?;
        Ok(universe)
    }

    fn split(&mut self, cell: Cell, part: &TransformPart) -> Result<[Verdict<TransformPart>; 8], Error> {
        if let (What::Function(known), Some(surfaces)) = (part.0, &self.surfaces) {
            return Ok(surface_cell::split(&surfaces.after, cell, &known)?.each(verdict_of));
        }
        let (maps, frame) = (self.maps, self.frame);
        let images = Images::new(&maps, &Cube { frame: &frame, cell }, 2);
        self.gather(*part, &images, images.grain)?;
        self.verdicts(&images, cell, 8)
    }

    fn answer(&mut self, cell: Cell, part: &TransformPart, question: Question<'_>) -> Result<(), Error> {
        if let (What::Function(known), Some(surfaces)) = (part.0, &self.surfaces) {
            return surface_cell::answer(&surfaces.after, cell, &known, question);
        }
        match question {
            Question::Centre(inside) => *inside = self.contains_centre(cell, *part)?,
            Question::Enclosure(known) => *known = self.slab(cell, *part)?,
            Question::Moments(known) => {
                if let Some((turn, source, own)) = self.source(cell, *part) {
                    *known = self.inner.moments(source, &own)?.map(|known| turn.moments(&known));
                }
            }
            // (The area is measured in half edges of cells, which the map scales as it does the surface.)
            Question::Area(known) => {
                if let Some((_, source, own)) = self.source(cell, *part) {
                    *known = self.inner.area(source, &own)?;
                }
            }
            Question::Crossing(segment, known) => {
                if let Some((turn, source, own)) = self.source(cell, *part)
                    && let Some(segment) = same::segment(&Inverse::of(&self.placement), segment)
                {
                    *known = self.inner.crossing(source, &own, &segment)?.map(|known| turn.crossing(&known));
                }
            }
            Question::Surfaces(known) => {
                if let Some((_, source, own)) = self.source(cell, *part) {
                    *known = self.inner.surfaces(source, &own)?;
                }
            }
            Question::Layers(LayersQuestion { tolerance, own: layers, known }) => {
                if let Some((_, source, own)) = self.source(cell, *part) {
                    let (first, tolerance) = (layers.len(), tolerance / self.placement.stretched(1.0));
                    *known = self.inner.layers(source, &own, tolerance, layers)?;
                    for layer in &mut layers[first..] {
                        *layer = layer.placed(&self.placement);
                    }
                }
            }
            Question::Chords(_) | Question::Ray(_) | Question::Nearest(..) | Question::Box(..) => {}
        }
        Ok(())
    }
}

impl<W: Worker> TransformWorker<W> {
    /// Returns whether the centre of a finest cell lies inside.
    fn contains_centre(&mut self, cell: Cell, part: TransformPart) -> Result<Option<bool>, Error> {
        let (inward, mark) = (self.maps.inward, self.inner.mark());
        let point = Point::centre(&inward, cell);
        self.gather(part, &point, 0.0)?;
        let (mut inside, open) = self.at_point(&point);
        if let Some((cell, part)) = open {
            inside = self.inner.sample(cell, &part)?;
        }
        self.inner.release(mark);
        Ok(inside)
    }

    /// The verdict of the cells at hand on the image of a centre; and, if that leaves the point open, the
    /// finest cell of the solid's own frame whose centre is the image.
    #[allow(clippy::type_complexity)]
    fn at_point(&self, point: &Point<'_>) -> (Option<bool>, Option<(Cell, W::Part)>) {
        let Met { empty, full, undecided, part } = self.met(point.reaches_beyond(self.own.cells() as f64));
        match [empty, full, undecided, part].each(|met| met != 0) {
            [true, false, false, false] => (Some(false), None),
            [false, true, false, false] => (Some(true), None),
            _ if self.nearest => self.at_nearest(point),
            _ => match self.at_hand.as_slice() {
                [((cell, Verdict::Partial(part)), _)] if point.map.keeps_centres() => {
                    (None, Some((*cell, part.clone())))
                }
                _ => (None, None),
            },
        }
    }

    /// The same for the one cell that contains the computed image of the centre.
    #[allow(clippy::type_complexity)]
    fn at_nearest(&self, point: &Point<'_>) -> (Option<bool>, Option<(Cell, W::Part)>) {
        let holds = |cell: Cell| {
            let (corner, edge) = extent(&self.own, cell);
            point.is_in(corner, edge)
        };
        let decided = |tag| match tag {
            Tag::Empty => Some(false),
            Tag::Full => Some(true),
            Tag::Partial | Tag::Branch => None,
        };
        match self.at_hand.iter().find(|((cell, _), _)| holds(*cell)) {
            Some(((cell, Verdict::Partial(part)), _)) => (None, Some((*cell, part.clone()))),
            Some(((_, verdict), _)) => (decided(verdict.tag()), None),
            None => (decided(self.exterior), None),
        }
    }

    /// The cell of the solid's own frame whose image the cell is, exactly, with its part.
    fn source(&self, cell: Cell, part: TransformPart) -> Option<(Turn, Cell, W::Part)> {
        let [(source, Verdict::Partial(own))] = &self.known[self.range(part)] else { return None };
        let turn = Turn::of(&self.maps, &self.frame, cell, &self.own, *source)?;
        Some((turn, *source, own.clone()))
    }

    /// The enclosure of a cell from the cells of the solid's own frame.
    fn slab(&mut self, cell: Cell, part: TransformPart) -> Result<Option<Enclosure>, Error> {
        let range = self.range(part);
        let mut sources = memory::with_capacity(range.len())?;
        for (source, verdict) in &self.known[range] {
            let enclosure = match verdict {
                Verdict::Partial(part) => self.inner.enclosure(*source, part)?,
                _ => None,
            };
            let (corner, edge) = extent(&self.own, *source);
            sources.push(Source { corner, edge, tag: verdict.tag(), enclosure });
        }
        let cube = Cube { frame: &self.frame, cell };
        Ok(slabs::enclosure(&self.maps, &cube, self.own.cells() as f64, self.exterior, &sources))
    }
}
