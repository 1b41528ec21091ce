//! From any solid to an octree whose PARTIAL cells keep the surfaces that cross them.

use super::build::build;
use super::rule::Rule;
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::{Cell, Cube, Frame, Interval, axes, valid};
use crate::memory;
use crate::octree::cuts::{Cut, CutWriter, Origin};
use crate::octree::view::{element_levels, starts_half_way};
use crate::octree::writer::Writer;
use crate::octree::{Octree, Planes, Tag};
use crate::parallel::each_with;
use crate::solid::half_space::Placed;
use crate::solid::half_space::possible::possible;
use crate::solid::half_space::record::Pool;
use crate::solid::half_space::table::Table;
use crate::solid::{
    Ask, AskWhole, Classifier, Enclosure, Fingerprinter, HalfSpace, OCTANTS, OpenSurfaces, Parts,
    PlacedHalfSpace, Slab, SlabJoin, Solid, Verdict, Worker,
};
use alloc::sync::Arc;
use alloc::vec::Vec;

/// Which surfaces an extended octree keeps.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SurfaceOptions {
    /// Where nothing exact is known of a surface (a mesh, a host program's function), two parallel planes may stand for it that
    /// are at most this far apart (model units). `None`: only exact surfaces are kept.
    pub tolerance: Option<f64>,
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
    let mut placed = memory::with_capacity(pool.surfaces.len())?;
    for surface in &pool.surfaces {
        placed.push(surface.on(frame)?);
    }
    let levels = element_levels(frame.depth());
    control.run(levels > 3, |parallel| {
        let exact = pool.surfaces.len() as u32;
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
                None => &pool.surfaces[id as usize],
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

/// The parts of a classifier's cells.
type Part<C> = <<C as Classifier>::Worker as Parts>::Part;

/// What becomes of a cell.
enum Known<P> {
    /// It is decided.
    Settled(Tag),
    /// It is PARTIAL, and is not split.
    Ends(Cut),
    /// It is split.
    Goes(P),
}

/// A cell that is done: its tag, and its cut if that is PARTIAL.
type Done = (Tag, Cut);

/// The cells of an octant of an element: one, or eight, of which some are still to be split.
enum Octant<P> {
    One(Done),
    Eight([Known<P>; 8]),
}

impl<C: Classifier> Extended<'_, C> {
    fn known(
        &self,
        cell: Cell,
        verdict: Verdict<Part<C>>,
        hand: &mut Hand<'_, C>,
    ) -> Result<Known<Part<C>>, Error> {
        let part = match verdict {
            Verdict::Empty => return Ok(Known::Settled(Tag::Empty)),
            Verdict::Full => return Ok(Known::Settled(Tag::Full)),
            Verdict::Undecided => return Ok(Known::Ends(Cut::None)),
            Verdict::Partial(part) => part,
        };
        let exact = hand.worker.surfaces(cell, &part)?.and_then(|open| self.renamed(cell, &open));
        match (exact, self.tolerance) {
            (Some((_, 0, Table::EMPTY)), _) => return Ok(Known::Settled(Tag::Empty)),
            (Some((_, 0, _)), _) => return Ok(Known::Settled(Tag::Full)),
            (Some((ids, 1..=MOST, table)), _) => {
                return Ok(Known::Ends(Cut::Table { ids, table: table.0 as u8 }));
            }
            (None, Some(tolerance)) => {
                if let Some(enclosure) = hand.worker.enclosure(cell, &part)?
                    && let Some(cut) = self.slabs(cell, &enclosure, tolerance, &mut hand.slabs)?
                {
                    return Ok(Known::Ends(cut));
                }
            }
            _ => {}
        }
        Ok(if cell.level == self.frame.depth() { Known::Ends(Cut::None) } else { Known::Goes(part) })
    }

    /// The same function of the surfaces that differ: those on which it depends, in ascending order, how many they are, and the table;
    /// `None` if a surface has no exact
    /// numbers. (Of more than [`MOST`] only the number is right.)
    fn renamed(&self, cell: Cell, open: &OpenSurfaces) -> Option<([u32; MOST], usize, Table)> {
        let mut pooled = OpenSurfaces::constant(false);
        let mut table = open.table();
        // Numbers are given in their order, so that none is taken that is still to come.
        for (i, &index) in open.indices().iter().enumerate() {
            let (id, negated) = self.names[index as usize]?;
            table = table.renamed(i, pooled.number(id)?, negated);
        }
        let placed = pooled.indices().iter().map(|&id| &self.placed[id as usize]);
        table = table.simplified(possible(placed, cell));
        let mut used = [(u32::MAX, 0); OpenSurfaces::MOST];
        let mut count = 0;
        for (i, &id) in pooled.indices().iter().enumerate().filter(|&(i, _)| table.depends_on(i)) {
            (used[count], count) = ((id, i), count + 1);
        }
        used[..count].sort_unstable();
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
        hand.writer.job().check()?;
        let mark = hand.worker.mark();
        // Octants with the cells that they are.
        let mut octants = memory::with_capacity(8)?;
        if e == 0 && starts_half_way(self.frame.depth()) {
            octants.push((cell, self.octant(cell, Known::Goes(part.clone()), hand)?));
        } else {
            let verdicts = hand.worker.split(cell, part)?;
            for (k, verdict) in OCTANTS.into_iter().zip(verdicts) {
                let child = cell.child(k);
                let known = self.known(child, verdict, hand)?;
                octants.push((child, self.octant(child, known, hand)?));
            }
        }
        // What is still to be split, by threads near the root.
        let mut open = Vec::new();
        for (octant, cells) in &octants {
            let Octant::Eight(cells) = cells else { continue };
            for (k, known) in OCTANTS.into_iter().zip(cells) {
                if let Known::Goes(part) = known {
                    memory::push(&mut open, (octant.child(k), part.clone()))?;
                }
            }
        }
        let done = if self.parallel && e < 2 && open.len() > 1 {
            self.elements_in_parallel(e + 1, &open, hand)?
        } else {
            let mut done = memory::with_capacity(open.len())?;
            for (cell, part) in &open {
                done.push(self.element(e + 1, *cell, part, hand)?);
            }
            done
        };
        let mut done = done.into_iter();
        let mut cells = memory::with_capacity(8)?;
        for (_, octant) in octants {
            cells.push(match octant {
                Octant::One(one) => memory::collected([one].into_iter())?,
                Octant::Eight(eight) => {
                    merged(memory::collected(eight.into_iter().map(|known| match known {
                        Known::Settled(tag) => (tag, Cut::None),
                        Known::Ends(cut) => (Tag::Partial, cut),
                        Known::Goes(_) => done.next().unwrap_or((Tag::Partial, Cut::None)),
                    }))?)?
                }
            });
        }
        hand.worker.release(mark);
        put(e, &cells, hand)
    }

    fn octant(
        &self,
        cell: Cell,
        known: Known<Part<C>>,
        hand: &mut Hand<'_, C>,
    ) -> Result<Octant<Part<C>>, Error> {
        let part = match known {
            Known::Settled(tag) => return Ok(Octant::One((tag, Cut::None))),
            Known::Ends(cut) => return Ok(Octant::One((Tag::Partial, cut))),
            Known::Goes(part) => part,
        };
        let verdicts = hand.worker.split(cell, &part)?;
        let mut cells = OCTANTS.map(|_| Known::Settled(Tag::Empty));
        for ((k, verdict), known) in OCTANTS.into_iter().zip(verdicts).zip(&mut cells) {
            *known = self.known(cell.child(k), verdict, hand)?;
        }
        Ok(Octant::Eight(cells))
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
