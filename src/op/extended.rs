//! From any solid to an octree whose PARTIAL cells keep the surfaces that cross them.

use super::build::build;
use super::rule::Rule;
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::{Bounds, Cell, Cube, Frame, Interval, axes, valid};
use crate::memory;
use crate::octree::cuts::{Cut, CutWriter, Head, Origin};
use crate::octree::view::{element_levels, starts_half_way};
use crate::octree::writer::Writer;
use crate::octree::{Octree, Planes, Tag};
use crate::parallel::{self, each_with};
use crate::solid::half_space::Placed;
use crate::solid::half_space::possible::possible;
use crate::solid::half_space::record::Pool;
use crate::solid::half_space::table::Table;
use crate::solid::{
    Ask, AskWhole, Batch, Classifier, Enclosure, Fingerprinter, HalfSpace, OCTANTS, OpenSurfaces, Parts,
    PlacedHalfSpace, Slab, SlabJoin, Solid, Verdict, Worker,
};
use crate::walk::{LEVELS, Part, each, split_each};
use alloc::sync::Arc;
use alloc::vec::Vec;

/// Which surfaces an extended octree keeps.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SurfaceOptions {
    /// Where nothing exact is known of a surface (a mesh, a host program's function), two parallel planes may stand for it that
    /// are at most this far apart (model units). `None`: only exact surfaces are kept.
    pub tolerance: Option<f64>,
}

impl SurfaceOptions {
    /// The frame to build on: around the bounds of a shape, with finest cells no longer than the tolerance. Without a tolerance it
    /// has the greatest depth, because cells with exact surfaces end at any size.
    ///
    /// # Errors
    /// As [`Frame::to_tolerance`].
    ///
    /// ```
    /// use leafless::{Bounds, SurfaceOptions};
    /// let bounds = Bounds::new([0.0; 3], [100.0, 60.0, 30.0]).unwrap();
    /// assert_eq!(SurfaceOptions::default().frame(&bounds)?.depth(), 20);
    /// assert_eq!(SurfaceOptions { tolerance: Some(0.05) }.frame(&bounds)?.depth(), 12);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn frame(&self, bounds: &Bounds) -> Result<Frame, Error> {
        Frame::to_tolerance(bounds.min, bounds.max, self.tolerance.unwrap_or(0.0), 0.0)
    }
}

/// Most surfaces that a cell keeps.
const MOST: usize = 3;

/// Builds the *extended octree* of `solid`: a certified octree whose PARTIAL cells keep the surfaces that cross them, up to three,
/// and the function of their signs that the solid is.
///
/// A cell ends as soon as three surfaces are left in it, at any size. So the tree is small, and as exact as the solid: put on any
/// frame of its universe, it splits below its own cells, and answers measures, points, rays and distances as the solid would. What
/// is still crossed by more surfaces at the frame's depth is PARTIAL, and nothing is known of it.
///
/// A cell that had to be split may turn out to need no more than three surfaces: bounds over smaller cells are closer, and one of
/// the surfaces in doubt does not reach it after all. So eight cells that are done become one, from the finest up, by this rule: none
/// of them is given up, all their exact surfaces together are at most three, and one function of these has the value of each cell
/// for all combinations of signs that are possible in that cell. Combinations that are possible in none of the eight have the value
/// of the nearest that is. Cells with slabs stay apart, because each slab stands for a surface of its own.
///
/// A solid whose answers are dear, such as a function of a host program, is asked level by level about many cells at once.
///
/// The half-spaces of expressions are kept exactly, under any placements, and those of extended octrees within them. The result is
/// the same bit for bit for any number of threads. Time and memory are linear in the cells that are visited.
///
/// Whatever takes a [`Solid`] takes the surfaces into account. What reads the cells of an octree in place, set operations of stored
/// octrees among it, sees the cells alone, which are those of a certified octree.
///
/// The method is that of Brunet and Navazo, *Solid representation and operation using extended octrees*, ACM Transactions on
/// Graphics 9 (2), 1990, for curved surfaces and with exact signs.
///
/// # Errors
/// As [`build`](crate::build); [`Error::Argument`] if the tolerance is not a positive number; [`Error::Limit`] if an exact number
/// of a surface is the sum of more than seven doubles, or a surface lies under more than 64 placements.
///
/// ```
/// use leafless::{Control, Csg, Frame, build_extended, measure, SurfaceOptions};
/// let plate = Csg::cuboid([-4.0, -3.0, 0.0], [4.0, 3.0, 1.0])?;
/// let part = plate.difference(&Csg::cylinder(0.5, -1.0, 2.0)?)?;
/// let frame = Frame::around([-4.0, -3.0, 0.0], [4.0, 3.0, 1.0], 20)?;
/// let tree = build_extended(&part, &frame, &SurfaceOptions::default(), &Control::default())?;
/// assert!(tree.statistics().nodes() < 20);
/// let volume = measure(&tree, &frame, 1e-6, &Control::default())?.volume;
/// assert!(volume.contains(48.0 - std::f64::consts::PI / 4.0) && volume.width() < 1e-4);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn build_extended<S: Solid>(
    solid: &S,
    frame: &Frame,
    options: &SurfaceOptions,
    control: &Control<'_>,
) -> Result<Octree, Error> {
    if let Some(tolerance) = options.tolerance {
        valid::length("tolerance", tolerance)?;
    }
    let classifier = solid.on(frame, control)?;
    let job = Job::new(control);
    job.check()?;
    let mut pool = Pool::default();
    let mut names = Vec::new();
    for surface in classifier.surfaces(control)?.unwrap_or_default() {
        job.check()?;
        memory::push(&mut names, pool.number(&surface)?)?;
    }
    // By their bytes: A ∪ B numbers them as B ∪ A does.
    let (surfaces, places) = pool.sorted()?;
    names.iter_mut().flatten().for_each(|(id, _)| *id = places[*id as usize]);
    let mut placed = memory::with_capacity(surfaces.len())?;
    for surface in &surfaces {
        placed.push(surface.on(frame)?);
    }
    let levels = element_levels(frame.depth());
    // Shallow trees are made faster than threads, unless it is somebody else who takes the time.
    let likes_many = classifier.worker()?.likes_many();
    control.run(levels > 3 || likes_many, |parallel| {
        let exact = surfaces.len() as u32;
        let tolerance = options.tolerance;
        let builder =
            Extended { classifier: &classifier, frame: *frame, tolerance, names, placed, exact, parallel };
        let mut hand = Hand::new(&classifier, Writer::new(&job, frame.depth(), false), levels)?;
        let root = hand.worker.root()?;
        let (tag, cut) = match builder.known(Cell::ROOT, root, &mut hand)? {
            Known::Settled(tag) => (tag, Cut::None),
            Known::Ends(cut) => (Tag::Partial, cut),
            Known::Goes(part) => builder.element(0, Cell::ROOT, &part, &mut hand)?,
        };
        let Hand { writer, cuts, mut slabs, .. } = hand;
        let cuts = cuts.finish((tag == Tag::Partial).then_some(cut), |used| {
            let origin = if slabs.is_empty() { None } else { origin(solid, frame, options) };
            // Slabs are numbered as the table of surfaces is.
            for (number, &id) in (0..).zip(used) {
                if let (Some(slab), Some(origin)) = (id.checked_sub(exact), origin) {
                    slabs[slab as usize].half_space.identify(origin, number);
                }
            }
            PlacedHalfSpace::write(used.iter().map(|&id| match id.checked_sub(exact) {
                None => &surfaces[id as usize],
                Some(slab) => &slabs[slab as usize],
            }))
        })?;
        job.advance(WHOLE);
        Ok(writer.finish_with(frame, tag, classifier.exterior(), cuts)?.with_proof(classifier.proof()))
    })
}

/// The tree without cuts that says what a tree with cuts does, to `depth`: for whatever means cells. Cells are decided by the
/// surfaces that the tree keeps, and what is undecided at the depth is resolved by `rule`. Metadata and channels are those of `tree`.
/// Of a tree without cuts it is the same tree, cut at the depth.
///
/// # Errors
/// As [`build`](crate::build); [`Error::Argument`] if `depth` is not 1 to 20.
pub fn plain(tree: &Octree, depth: u8, rule: Rule, control: &Control<'_>) -> Result<Octree, Error> {
    let plain = build(tree, &tree.frame().with_depth(depth)?, rule, control)?;
    Ok(plain.with_metadata_from(tree).with_channels_from(tree))
}

/// What tells the slabs of a build from all others; `None` if the solid cannot be told from others.
fn origin<S: Solid>(solid: &S, frame: &Frame, options: &SurfaceOptions) -> Option<Origin> {
    let all = Fingerprinter::new("slabs")
        .part(solid.fingerprint()?)
        .numbers(&frame.origin())
        .numbers(&[frame.edge()])
        .integers(&[frame.depth().into()])
        .numbers(options.tolerance.as_slice());
    Some(all.finish().halves())
}

struct Extended<'a, C> {
    classifier: &'a C,
    frame: Frame,
    tolerance: Option<f64>,
    /// For each surface of the solid's list its number among those that differ, and whether it stands there negated.
    names: Vec<Option<(u32, bool)>>,
    /// The exact surfaces that differ, on the universe, and how many they are. Numbers from there on are those of slabs.
    placed: Vec<Placed>,
    exact: u32,
    parallel: bool,
}

/// What one thread needs, and what it has made.
struct Hand<'j, C: Classifier> {
    worker: C::Worker,
    writer: Writer<'j>,
    cuts: CutWriter,
    slabs: Vec<PlacedHalfSpace>,
}

impl<'j, C: Classifier> Hand<'j, C> {
    fn new(classifier: &C, writer: Writer<'j>, levels: usize) -> Result<Hand<'j, C>, Error> {
        Ok(Hand { worker: classifier.worker()?, writer, cuts: CutWriter::new(levels)?, slabs: Vec::new() })
    }
}

/// What becomes of a cell.
#[derive(Clone)]
enum Known<P> {
    /// It is decided.
    Settled(Tag),
    /// It is PARTIAL, and is not split.
    Ends(Cut),
    /// It is split.
    Goes(P),
}

/// The children of a cell.
type Family<P> = [Known<P>; 8];

/// A cell that is done: its tag, and its cut if that is PARTIAL.
type Done = (Tag, Cut);

/// The cells of an octant of an element: one, or eight, of which some are still to be split.
enum Octant<P> {
    One(Done),
    Eight(Family<P>),
}

/// A cell that was asked about together with others: where its children are, or, of the last level, its part.
#[derive(Clone)]
enum Asked<P> {
    Children(usize),
    Part(P),
}

impl<C: Classifier> Extended<'_, C> {
    fn known(
        &self,
        cell: Cell,
        verdict: Verdict<Part<C>>,
        hand: &mut Hand<'_, C>,
    ) -> Result<Known<Part<C>>, Error> {
        let (known, wants_slabs) = self.by_surfaces(cell, verdict, &mut hand.worker)?;
        match known {
            Known::Goes(part) if wants_slabs => {
                let enclosure = hand.worker.enclosure(cell, &part)?;
                self.by_slabs(cell, part, enclosure, &mut hand.slabs)
            }
            known => Ok(known),
        }
    }

    /// What becomes of a cell by the exact surfaces that cross it, and whether slabs may still end it.
    fn by_surfaces(
        &self,
        cell: Cell,
        verdict: Verdict<Part<C>>,
        worker: &mut C::Worker,
    ) -> Result<(Known<Part<C>>, bool), Error> {
        let part = match verdict {
            Verdict::Empty => return Ok((Known::Settled(Tag::Empty), false)),
            Verdict::Full => return Ok((Known::Settled(Tag::Full), false)),
            Verdict::Undecided => return Ok((Known::Ends(Cut::None), false)),
            Verdict::Partial(part) => part,
        };
        let exact = worker.surfaces(cell, &part)?.and_then(|open| self.renamed(cell, &open));
        let wants_slabs = exact.is_none() && self.tolerance.is_some();
        let known = match exact {
            Some((_, 0, Table::EMPTY)) => Known::Settled(Tag::Empty),
            Some((_, 0, _)) => Known::Settled(Tag::Full),
            Some((ids, 1..=MOST, table)) => Known::Ends(Cut::Table { ids, table: table.0 as u8 }),
            _ if cell.level == self.frame.depth() && !wants_slabs => Known::Ends(Cut::None),
            _ => Known::Goes(part),
        };
        Ok((known, wants_slabs))
    }

    /// What becomes of a cell of which no exact surfaces are known.
    fn by_slabs(
        &self,
        cell: Cell,
        part: Part<C>,
        enclosure: Option<Enclosure>,
        slabs: &mut Vec<PlacedHalfSpace>,
    ) -> Result<Known<Part<C>>, Error> {
        if let (Some(enclosure), Some(tolerance)) = (enclosure, self.tolerance)
            && let Some(cut) = self.slabs(cell, &enclosure, tolerance, slabs)?
        {
            return Ok(Known::Ends(cut));
        }
        Ok(if cell.level == self.frame.depth() { Known::Ends(Cut::None) } else { Known::Goes(part) })
    }

    /// The same function of the surfaces that differ: those on which it depends, in ascending order, how many they are, and the
    /// table. `None` if a surface has no exact numbers. (Of more than [`MOST`] surfaces only the count is right.)
    fn renamed(&self, cell: Cell, open: &OpenSurfaces) -> Option<([u32; MOST], usize, Table)> {
        // By the numbers of those that differ, each with its place in the function, and whether it is negated there.
        let mut named = [(u32::MAX, 0, false); OpenSurfaces::MOST];
        let count = open.indices().len();
        for (i, (name, &index)) in named.iter_mut().zip(open.indices()).enumerate() {
            let (id, negated) = self.names[index as usize]?;
            *name = (id, i, negated);
        }
        let named = &mut named[..count];
        named.sort_unstable();
        let (mut pooled, mut places, mut last) = ([0; OpenSurfaces::MOST], [0; OpenSurfaces::MOST], 0);
        for (k, &(id, ..)) in named.iter().enumerate() {
            last += usize::from(k > 0 && id != pooled[last]);
            (pooled[last], places[k]) = (id, last);
        }
        let pooled = &pooled[..count.min(last + 1)];
        let value = |signs: u64| {
            let own = named.iter().zip(places).fold(0, |all, (&(_, i, negated), place)| {
                all | ((signs >> place & 1) ^ u64::from(negated)) << i
            });
            open.table().0 >> own & 1
        };
        let table = Table((0..64).fold(0, |all, signs| all | value(signs) << signs));
        let mut table = table.simplified(possible(pooled.iter().map(|&id| &self.placed[id as usize]), cell));
        let mut used = [(u32::MAX, 0); OpenSurfaces::MOST];
        let mut count = 0;
        for (i, &id) in pooled.iter().enumerate().filter(|&(i, _)| table.depends_on(i)) {
            (used[count], count) = ((id, i), count + 1);
        }
        let mut ids = [0; MOST];
        if count <= MOST {
            ids.iter_mut().zip(&used[..count]).for_each(|(to, &(id, _))| *to = id);
            table = reordered(table, used[..count].iter().map(|&(_, i)| i));
        }
        Some((ids, count, table))
    }

    /// Planes with a width for the slabs of a cell; `None` if one is too thick, or says nothing.
    fn slabs(
        &self,
        cell: Cell,
        enclosure: &Enclosure,
        tolerance: f64,
        slabs: &mut Vec<PlacedHalfSpace>,
    ) -> Result<Option<Cut>, Error> {
        let cube = Cube { frame: &self.frame, cell };
        let half = 0.5 * self.frame.edge() / (1u64 << cell.level) as f64;
        let is_slab = |slab: &&Slab| slab.normal != [0.0; 3];
        let mut planes = [None; MOST];
        for (plane, slab) in planes.iter_mut().zip(enclosure.slabs.iter().filter(is_slab)) {
            let length = libm::sqrt(slab.normal.iter().map(|c| c * c).sum::<f64>());
            let width = (slab.outer - slab.inner) * half / length;
            // (What is no number is not less.)
            let is_thin = width <= tolerance && length.is_finite();
            if !is_thin {
                return Ok(None);
            }
            *plane = Some(thick_plane(&cube, half, slab));
        }
        let (mut ids, mut count) = ([0; MOST], 0);
        for (normal, inner, outer) in planes.into_iter().flatten() {
            let half_space = HalfSpace::slab(normal, inner, outer, None);
            ids[count] = u32::try_from(self.exact as usize + slabs.len()).map_err(|_| Error::OutOfMemory)?;
            memory::push(slabs, PlacedHalfSpace { half_space, placements: Arc::new([]) })?;
            count += 1;
        }
        let all = (0..count).map(|i| Table::of(i, false).0);
        let table = match enclosure.join {
            SlabJoin::All => all.fold(!0, |all, one| all & one),
            SlabJoin::Any => all.fold(0, |all, one| all | one),
        };
        Ok((count > 0).then_some(Cut::Table { ids, table: table as u8 }))
    }

    /// Writes the element of a PARTIAL cell; returns the cell's tag, and its cut if that is PARTIAL.
    fn element(&self, e: usize, cell: Cell, part: &Part<C>, hand: &mut Hand<'_, C>) -> Result<Done, Error> {
        if !hand.worker.likes_many() {
            return self.element_by(&Directly(self), e, cell, part, hand);
        }
        let mark = hand.worker.mark();
        // Parts are left over where elements begin.
        let levels = if e == 0 && starts_half_way(self.frame.depth()) { LEVELS - 1 } else { LEVELS };
        let last = (cell.level + levels).min(self.frame.depth());
        let told = Told { builder: self, families: self.asked(cell, part, last, hand)? };
        let done = self.element_by(&told, e, cell, &Asked::Children(0), hand);
        hand.worker.release(mark);
        done
    }

    /// What becomes of all cells below one, to a last level, asked level by level: the children of cells that are split.
    fn asked(
        &self,
        cell: Cell,
        part: &Part<C>,
        last: u8,
        hand: &mut Hand<'_, C>,
    ) -> Result<Vec<Family<Asked<Part<C>>>>, Error> {
        let control = hand.writer.job().control();
        let threads = if self.parallel { parallel::threads() } else { 1 };
        let mut families = Vec::new();
        let mut front = memory::collected([(cell, part.clone())].into_iter())?;
        while !front.is_empty() {
            let verdicts = split_each(self.classifier, &mut hand.worker, &front, threads, control)?;
            let mut all = memory::with_capacity(front.len())?;
            // Children of which slabs are asked, and where they are.
            let (mut cells, mut places) = (Vec::new(), Vec::new());
            for ((cell, _), verdicts) in front.iter().zip(verdicts) {
                let mut eight = OCTANTS.map(|_| Known::Settled(Tag::Empty));
                for ((k, verdict), known) in OCTANTS.into_iter().zip(verdicts).zip(&mut eight) {
                    let child = cell.child(k);
                    let wants_slabs;
                    (*known, wants_slabs) = self.by_surfaces(child, verdict, &mut hand.worker)?;
                    if let (Known::Goes(part), true) = (&*known, wants_slabs) {
                        memory::push(&mut cells, (child, part.clone()))?;
                        memory::push(&mut places, (all.len(), usize::from(k)))?;
                    }
                }
                all.push(eight);
            }
            let enclosures =
                each(self.classifier, &mut hand.worker, &cells, threads, |worker, cells, found| {
                    for (cell, part) in cells {
                        control.check()?;
                        memory::push(found, worker.enclosure(*cell, part)?)?;
                    }
                    Ok(())
                })?;
            for (((cell, part), (family, k)), enclosure) in cells.into_iter().zip(places).zip(enclosures) {
                all[family][k] = self.by_slabs(cell, part, enclosure, &mut hand.slabs)?;
            }
            let mut next = Vec::new();
            let first = families.len() + all.len();
            families.try_reserve(all.len())?;
            for ((cell, _), eight) in front.iter().zip(all) {
                let mut told = OCTANTS.map(|_| Known::Settled(Tag::Empty));
                for ((k, known), told) in OCTANTS.into_iter().zip(eight).zip(&mut told) {
                    *told = match known {
                        Known::Settled(tag) => Known::Settled(tag),
                        Known::Ends(cut) => Known::Ends(cut),
                        Known::Goes(part) if cell.level + 1 == last => Known::Goes(Asked::Part(part)),
                        Known::Goes(part) => {
                            memory::push(&mut next, (cell.child(k), part))?;
                            Known::Goes(Asked::Children(first + next.len() - 1))
                        }
                    };
                }
                families.push(told);
            }
            front = next;
        }
        Ok(families)
    }

    fn element_by<'j, S: Source<'j, C>>(
        &self,
        source: &S,
        e: usize,
        cell: Cell,
        part: &S::Part,
        hand: &mut Hand<'j, C>,
    ) -> Result<Done, Error> {
        hand.writer.job().check()?;
        let mark = hand.worker.mark();
        // Octants with the cells that they are.
        let mut octants = memory::with_capacity(8)?;
        let octant = |cell: Cell, known: Known<S::Part>, hand: &mut Hand<'j, C>| {
            Ok::<_, Error>(match known {
                Known::Settled(tag) => Octant::One((tag, Cut::None)),
                Known::Ends(cut) => Octant::One((Tag::Partial, cut)),
                Known::Goes(part) => Octant::Eight(source.children(cell, &part, hand)?),
            })
        };
        if e == 0 && starts_half_way(self.frame.depth()) {
            octants.push((cell, octant(cell, Known::Goes(part.clone()), hand)?));
        } else {
            for (k, known) in OCTANTS.into_iter().zip(source.children(cell, part, hand)?) {
                let child = cell.child(k);
                octants.push((child, octant(child, known, hand)?));
            }
        }
        let mut open = Vec::new();
        for (octant, cells) in &octants {
            let Octant::Eight(cells) = cells else { continue };
            for (k, known) in OCTANTS.into_iter().zip(cells) {
                if let Known::Goes(part) = known {
                    memory::push(&mut open, (octant.child(k), part.clone()))?;
                }
            }
        }
        let mut done = source.elements(e + 1, &open, hand)?.into_iter();
        let mut cells = memory::with_capacity(8)?;
        for (at, octant) in octants {
            cells.push(match octant {
                Octant::One(one) => memory::collected([one].into_iter())?,
                Octant::Eight(eight) => {
                    let eight = memory::collected(eight.into_iter().map(|known| match known {
                        Known::Settled(tag) => (tag, Cut::None),
                        Known::Ends(cut) => (Tag::Partial, cut),
                        Known::Goes(_) => done.next().unwrap_or((Tag::Partial, Cut::None)),
                    }))?;
                    match self.joined(at, eight.iter()) {
                        Some(cut) => memory::collected([(Tag::Partial, cut)].into_iter())?,
                        None => merged(eight)?,
                    }
                }
            });
        }
        hand.worker.release(mark);
        if cells.len() == 8
            && cells.iter().all(|octant| octant.len() == 1)
            && let Some(cut) = self.joined(cell, cells.iter().flatten())
        {
            return Ok((Tag::Partial, cut));
        }
        put(e, &cells, hand)
    }

    /// The cut of a cell whose eight children are done, if one function of up to three exact surfaces has the value of each child
    /// for all combinations of signs that are possible there.
    fn joined<'d>(&self, cell: Cell, children: impl Iterator<Item = &'d Done> + Clone) -> Option<Cut> {
        let (mut ids, mut count) = ([0; MOST], 0);
        for child in children.clone() {
            let own = match child {
                (Tag::Partial, Cut::Table { ids, table }) => &ids[..Head(*table).surfaces()],
                (Tag::Empty | Tag::Full, _) => &[],
                _ => return None,
            };
            for &id in own {
                if !ids[..count].contains(&id) {
                    if id >= self.exact || count == MOST {
                        return None;
                    }
                    (ids[count], count) = (id, count + 1);
                }
            }
        }
        let ids = &mut ids[..count];
        ids.sort_unstable();
        let (mut holds, mut fails) = (0, 0);
        for (k, child) in OCTANTS.into_iter().zip(children) {
            let value = match child {
                (Tag::Partial, Cut::Table { ids: own, table }) => {
                    let places = own[..Head(*table).surfaces()]
                        .iter()
                        .map(|id| ids.iter().position(|known| known == id));
                    spread(*table, places)
                }
                (tag, _) => {
                    if *tag == Tag::Full {
                        !0
                    } else {
                        0
                    }
                }
            };
            let placed = ids.iter().map(|&id| &self.placed[id as usize]);
            let possible = possible(placed, cell.child(k)).0;
            (holds, fails) = (holds | value & possible, fails | !value & possible);
        }
        if holds & fails != 0 {
            return None;
        }
        let table = Table(holds).simplified(Table(holds | fails));
        let (mut own, mut order) = ([0; MOST], [0; MOST]);
        let mut count = 0;
        for (i, &id) in ids.iter().enumerate().filter(|&(i, _)| table.depends_on(i)) {
            (own[count], order[count], count) = (id, i, count + 1);
        }
        let table = reordered(table, order[..count].iter().copied());
        (count > 0).then_some(Cut::Table { ids: own, table: table.0 as u8 })
    }

    /// Elements of level `e`, one after the other as they are written.
    fn elements_in_parallel(
        &self,
        e: usize,
        open: &[(Cell, Part<C>)],
        hand: &mut Hand<'_, C>,
    ) -> Result<Vec<Done>, Error> {
        let (from, writer) = (&hand.worker, &hand.writer);
        let levels = element_levels(self.frame.depth());
        let written = each_with(
            true,
            open.iter(),
            || None,
            |own, (cell, part)| {
                let mut own_hand = match own.take() {
                    Some(worker) => Hand {
                        worker,
                        writer: writer.sibling(),
                        cuts: CutWriter::new(levels)?,
                        slabs: Vec::new(),
                    },
                    None => Hand::new(self.classifier, writer.sibling(), levels)?,
                };
                let mark = own_hand.worker.mark();
                let part = own_hand.worker.hand_over(from, part)?;
                let done = self.element(e, *cell, &part, &mut own_hand)?;
                own_hand.worker.release(mark);
                let Hand { worker, writer, cuts, slabs } = own_hand;
                *own = Some(worker);
                Ok((done, writer, cuts, slabs))
            },
        )?;
        let mut all = memory::with_capacity(open.len())?;
        for ((tag, mut cut), writer, cuts, slabs) in written {
            let before = hand.slabs.len() as u32;
            hand.writer.append(writer)?;
            hand.cuts.append(cuts, self.exact, before)?;
            cut.renumber(self.exact, before);
            hand.slabs.try_reserve(slabs.len())?;
            hand.slabs.extend(slabs);
            all.push((tag, cut));
        }
        Ok(all)
    }
}

/// Where the cells of a subtree come from.
trait Source<'j, C: Classifier> {
    type Part: Clone;

    /// What becomes of the children of a cell.
    fn children(
        &self,
        cell: Cell,
        part: &Self::Part,
        hand: &mut Hand<'j, C>,
    ) -> Result<Family<Self::Part>, Error>;

    /// Writes cells that elements of level `e` describe.
    fn elements(
        &self,
        e: usize,
        open: &[(Cell, Self::Part)],
        hand: &mut Hand<'j, C>,
    ) -> Result<Vec<Done>, Error>;
}

/// Each cell is split when it is come to.
struct Directly<'a, 'b, C>(&'a Extended<'b, C>);

impl<'j, C: Classifier> Source<'j, C> for Directly<'_, '_, C> {
    type Part = Part<C>;

    fn children(&self, cell: Cell, part: &Part<C>, hand: &mut Hand<'j, C>) -> Result<Family<Part<C>>, Error> {
        let verdicts = hand.worker.split(cell, part)?;
        let mut cells = OCTANTS.map(|_| Known::Settled(Tag::Empty));
        for ((k, verdict), known) in OCTANTS.into_iter().zip(verdicts).zip(&mut cells) {
            *known = self.0.known(cell.child(k), verdict, hand)?;
        }
        Ok(cells)
    }

    fn elements(
        &self,
        e: usize,
        open: &[(Cell, Part<C>)],
        hand: &mut Hand<'j, C>,
    ) -> Result<Vec<Done>, Error> {
        // Threads begin near the root.
        if self.0.parallel && e < 3 && open.len() > 1 {
            return self.0.elements_in_parallel(e, open, hand);
        }
        let mut done = memory::with_capacity(open.len())?;
        for (cell, part) in open {
            done.push(self.0.element(e, *cell, part, hand)?);
        }
        Ok(done)
    }
}

/// The children of cells that were asked about together.
struct Told<'a, 'b, C: Classifier> {
    builder: &'a Extended<'b, C>,
    families: Vec<Family<Asked<Part<C>>>>,
}

impl<'j, C: Classifier> Source<'j, C> for Told<'_, '_, C> {
    type Part = Asked<Part<C>>;

    fn children(
        &self,
        _: Cell,
        part: &Asked<Part<C>>,
        _: &mut Hand<'j, C>,
    ) -> Result<Family<Asked<Part<C>>>, Error> {
        let family = match part {
            Asked::Children(family) => self.families.get(*family),
            Asked::Part(_) => None,
        };
        Ok(family.cloned().unwrap_or_else(|| OCTANTS.map(|_| Known::Ends(Cut::None))))
    }

    fn elements(
        &self,
        e: usize,
        open: &[(Cell, Asked<Part<C>>)],
        hand: &mut Hand<'j, C>,
    ) -> Result<Vec<Done>, Error> {
        let mut done = memory::with_capacity(open.len())?;
        for (cell, part) in open {
            done.push(match part {
                Asked::Children(_) => self.builder.element_by(self, e, *cell, part, hand)?,
                Asked::Part(part) => self.builder.element(e, *cell, part, hand)?,
            });
        }
        Ok(done)
    }
}

/// Stores the element of level `e` with these octants, unless all its cells agree.
fn put<C: Classifier>(e: usize, octants: &[Vec<Done>], hand: &mut Hand<'_, C>) -> Result<Done, Error> {
    let mut planes = Planes::uniform(Tag::Empty);
    for (k, octant) in octants.iter().enumerate() {
        for c in 0..8 {
            let (tag, _) = &octant[if octant.len() == 1 { 0 } else { c }];
            planes.set((8 * k + c) as u32, *tag);
        }
    }
    let tag = hand.writer.put(e, planes)?;
    let cuts =
        || octants.iter().flatten().filter(|(tag, _)| *tag == Tag::Partial).map(|(_, cut)| cut.clone());
    match tag {
        Tag::Branch => {
            hand.writer.job().spend(0, size_of::<Cut>() * cuts().count())?;
            hand.cuts.put(e, cuts())?;
            Ok((tag, Cut::None))
        }
        Tag::Partial => {
            let mut own = cuts();
            let children: [Cut; 8] = core::array::from_fn(|_| own.next().unwrap_or(Cut::None));
            let [first, ..] = &children;
            // (The root of an odd depth is its only octant.)
            Ok((tag, if octants.len() == 1 { first.clone() } else { Cut::of_children(children) }))
        }
        _ => Ok((tag, Cut::None)),
    }
}

/// Eight cells, or the one that they are.
fn merged(cells: Vec<Done>) -> Result<Vec<Done>, Error> {
    let [(first, _), ..] = &*cells else { return Ok(cells) };
    if *first == Tag::Branch || cells.iter().any(|(tag, _)| tag != first) {
        return Ok(cells);
    }
    let tag = *first;
    let mut own = cells.into_iter().map(|(_, cut)| cut);
    let cut = Cut::of_children(core::array::from_fn(|_| own.next().unwrap_or(Cut::None)));
    memory::collected([(tag, cut)].into_iter())
}

/// The table of up to three surfaces whose numbers were `order`.
fn reordered(table: Table, order: impl ExactSizeIterator<Item = usize> + Clone) -> Table {
    let value = |signs: u64| {
        let before = order.clone().enumerate().fold(0, |all, (to, from)| all | (signs >> to & 1) << from);
        table.0 >> before & 1
    };
    Table((0..64).fold(0, |all, signs| all | value(signs) << signs))
}

/// The table of up to three surfaces whose numbers become `places`.
fn spread(table: u8, places: impl Iterator<Item = Option<usize>> + Clone) -> u64 {
    let value = |signs: u64| {
        let own = places
            .clone()
            .enumerate()
            .fold(0, |all, (from, to)| all | to.map_or(0, |to| (signs >> to & 1) << from));
        u64::from(table) >> own & 1
    };
    (0..64).fold(0, |all, signs| all | value(signs) << signs)
}

/// The slab of a cell in model space, rounded outward: normal, inner and outer offset.
fn thick_plane(cube: &Cube<'_>, half: f64, slab: &Slab) -> ([f64; 3], f64, f64) {
    let Cube { frame, cell } = cube;
    // Centres of cells are exact in units of the universe.
    let unit = |axis: usize| (2 * u64::from(cell.at[axis]) + 1) as f64 / (2u64 << cell.level) as f64;
    let centre = axes(|axis| {
        Interval::exactly(frame.edge())
            .times(Interval::exactly(unit(axis)))
            .plus(Interval::exactly(frame.origin()[axis]))
    });
    let along = (0..3).fold(Interval::exactly(0.0), |sum, axis| {
        sum.plus(Interval::exactly(slab.normal[axis]).times(centre[axis]))
    });
    let offset = |own: f64| Interval::exactly(half).times(Interval::exactly(own)).plus(along);
    (slab.normal, offset(slab.inner).lower, offset(slab.outer).upper)
}
