//! Building an octree from any solid whose PARTIAL cells keep the surfaces that cross them.

use super::element::{Family, Fate, Output, Source, element};
use super::function::{Done, Function, Known, MOST_KEPT};
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Bounds, Cell, Cube, Frame, Shard, valid};
use crate::memory;
use crate::octree::cuts::{CellSlab, Cut, Origin, StoredMoments};
use crate::octree::view::{element_levels, starts_half_way};
use crate::octree::writer::Writer;
use crate::octree::{Octree, Tag};
use crate::op::build::build;
use crate::op::rule::Rule;
use crate::parallel::{self, each_with};
use crate::solid::half_space::Placed;
use crate::solid::half_space::record::Pool;
use crate::solid::half_space::table::Table;
use crate::solid::{
    Ask, AskLayers, AskWhole, Batch, Classifier, DynSolid, Enclosure, Fingerprinter, HalfSpace,
    LayersQuestion, OCTANTS, OpenSurfaces, Parts, PlacedHalfSpace, Slab, SlabJoin, Verdict, Worker,
};
use crate::walk::{LEVELS, Part, each, split_each};
use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::cmp::Ordering;
use once_cell::race::OnceBox;

/// The kinds of surfaces that an extended octree keeps.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SurfaceOptions {
    /// The greatest distance (model units) of the two parallel planes of a *layer*. A layer may stand for a
    /// surface without an exact form (a mesh, a host program's function). `None`: only exact surfaces are
    /// kept.
    pub tolerance: Option<f64>,
}

impl SurfaceOptions {
    /// Returns the frame to build on: around the bounds of a shape, with finest cells no longer than the
    /// tolerance. Without a tolerance the frame has the greatest depth, because cells with exact surfaces end
    /// at any size.
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

/// Builds the *extended octree* of `solid`: a certified octree whose PARTIAL cells keep up to three surfaces
/// that cross them. The solid in such a cell is a function of the signs of these surfaces.
///
/// A cell ends as soon as three surfaces are left in it, at any size. So the tree is small, and as exact as
/// the solid. On any frame of its universe it splits below its own cells, and answers measures, points, rays
/// and distances as the solid would. A cell that more surfaces cross at the frame's depth is PARTIAL, and
/// nothing is known about it.
///
/// A split cell may turn out to need no more than three surfaces: bounds over smaller cells are closer, and a
/// doubtful surface may prove not to reach the cell. So eight finished cells are merged, from the finest up,
/// under three conditions. None of the cells is given up. All their exact surfaces together are at most
/// three. One function of these surfaces has the value of each cell for all combinations of signs that are
/// possible in that cell. A combination that is possible in none of the eight cells takes the value of the
/// nearest possible one. Cells with layers of their own are not merged, because each layer stands for another
/// piece of surface.
///
/// With a tolerance, the tree also keeps the facet planes of meshes. Facets that lie in one plane up to
/// rounding share one layer in all cells that the plane crosses; the layer is as wide as these facets need.
/// Where more planes meet, facets that face about the same direction share a layer of their cell, at most as
/// thick as the tolerance. The table of the layers' sides follows the fill rule, and is proven. A part that
/// is thinner than a layer is undecided within the layer. No undecided point is further than twice the
/// tolerance from the surface, unless its cell was given up.
///
/// A solid whose answers are expensive, such as a function of a host program, is evaluated level by level for
/// many cells at once.
///
/// The half-spaces of expressions are kept exactly, under any placements, and so are the half-spaces of
/// extended octrees within expressions. The result is the same bit for bit for any number of threads. Time
/// and memory are linear in the number of visited cells.
///
/// Every function that takes a [solid](crate::Solid) takes the surfaces into account, and so do in-place
/// queries of points, rays and boxes. Set operations of stored octrees keep the surfaces. Functions that work
/// on cells see only the cells, which are those of a certified octree. [`Octree`] has the table.
///
/// The method is that of Brunet and Navazo, *Solid representation and operation using extended octrees*, ACM
/// Transactions on Graphics 9 (2), 1990, for curved surfaces and with exact signs.
///
/// # Errors
/// The errors of the solid ([`Error::FrameMismatch`] for stored trees, [`Error::Damaged`] for unverified
/// ones); [`Error::Argument`] if the tolerance is not a positive number; [`Error::Limit`] if an exact number
/// of a surface is the sum of more than seven doubles, or a surface lies under more than 64 placements; and
/// cancellation or an exceeded limit of `control`.
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
pub fn build_extended(
    solid: &dyn DynSolid,
    frame: &Frame,
    options: &SurfaceOptions,
    control: &Control<'_>,
) -> Result<Octree, Error> {
    build_cells(solid, frame, options, None, control)
}

/// Builds the cells of a [`Shard`] of the octree that [`build_extended`] returns. All other cells are unknown
/// (PARTIAL). [`join`](crate::op::join) combines the top shard and the shards of all cells that the top
/// leaves open. The result is the octree that [`build_extended`] returns, byte for byte.
///
/// # Errors
/// As [`build_extended`]; [`Error::Argument`] if the frame does not contain the shard's cells.
pub fn build_extended_shard(
    solid: &dyn DynSolid,
    frame: &Frame,
    options: &SurfaceOptions,
    shard: Shard,
    control: &Control<'_>,
) -> Result<Octree, Error> {
    shard.check(frame.depth())?;
    build_cells(solid, frame, options, Some(shard), control)
}

fn build_cells(
    solid: &dyn DynSolid,
    frame: &Frame,
    options: &SurfaceOptions,
    shard: Option<Shard>,
    control: &Control<'_>,
) -> Result<Octree, Error> {
    if let Some(tolerance) = options.tolerance {
        valid::length("tolerance", tolerance)?;
    }
    let classifier = solid.on(frame, control)?;
    let job = Job::new(control);
    job.check()?;
    let layers = match options.tolerance {
        Some(tolerance) => classifier.layers(control)?.map(|list| (tolerance, list)),
        None => None,
    };
    let (layers, list) = match layers {
        Some((tolerance, list)) => (Some(tolerance), list),
        None => (None, classifier.surfaces(control)?.unwrap_or_default()),
    };
    let Listed { names, surfaces, shared } = Listed::new(list, &job)?;
    let mut placed = memory::with_capacity(surfaces.len())?;
    for surface in &surfaces {
        placed.push(surface.on(frame)?);
    }
    let mut places = memory::with_capacity(shared.len())?;
    places.resize_with(shared.len(), OnceBox::new);
    let levels = element_levels(frame.depth());
    // A shallow tree is built faster than threads are started, unless a host program does the work.
    let likes_many = classifier.worker()?.likes_many();
    control.run(levels > 3 || likes_many, |parallel| {
        let (exact, tolerance) = (surfaces.len(), options.tolerance);
        let builder = Extended {
            classifier: &classifier,
            frame: *frame,
            shard,
            last: shard.map_or(frame.depth(), |shard| shard.last(frame.depth())),
            tolerance,
            layers,
            names: &names,
            placed: &placed,
            shared: &shared,
            places: &places,
            parallel,
        };
        let mut hand = Hand::new(&classifier, Output::new(Writer::new(&job, frame.depth(), false), frame)?)?;
        let root = hand.worker.root()?;
        let (tag, cut) = match builder.fate(Cell::ROOT, root, &mut hand)? {
            Fate::Settled(tag) => (tag, Cut::None),
            Fate::Ends(cut) => (Tag::Partial, cut),
            Fate::Goes(part) => builder.element(0, Cell::ROOT, &part, &mut hand)?,
        };
        let Hand { out: Output { writer, cuts }, mut slabs, .. } = hand;
        // The slabs of the solid's list come first.
        let mut layers = shared.clone();
        layers.try_reserve(slabs.len())?;
        layers.append(&mut slabs);
        // Exact surfaces are already numbered in their order.
        let by_size = |a: u32, b: u32| {
            let size = |id: u32| Some(layers.get((id as usize).checked_sub(exact)?)?.size());
            size(a).cmp(&size(b)).then(a.cmp(&b))
        };
        let origin = if layers.is_empty() { None } else { origin(solid, frame, options) };
        let group = |id: u32| match (id as usize).checked_sub(exact) {
            None => surfaces[id as usize].cell_slab(frame).map(|(_, origin)| origin),
            Some(layer) => {
                let (_, own) = layers[layer].cell_slab(frame)?;
                Some(if layer < shared.len() { own } else { origin.unwrap_or_default() })
            }
        };
        let mut cuts = cuts.finish((tag == Tag::Partial).then_some(cut), by_size, group)?;
        if let Some((cuts, used)) = &mut cuts {
            // A slab has the same number in every shard of the tree: its place in the solid's list, or its
            // number in its cell.
            for &id in &*used {
                let Some(layer) = (id as usize).checked_sub(exact) else { continue };
                // (A slab without origin, which another build made for a cell, has no number here.)
                if layer >= shared.len() || origin.is_some() && layers[layer].cell_slab(frame).is_none() {
                    let half_space = &mut layers[layer].half_space;
                    let number =
                        if layer < shared.len() { Some(layer as u64) } else { half_space.slab_number() };
                    *half_space = half_space.identified(origin.zip(number));
                }
            }
            let surfaces = used.iter().map(|&id| match (id as usize).checked_sub(exact) {
                None => &surfaces[id as usize],
                Some(layer) => &layers[layer],
            });
            cuts.surfaces = PlacedHalfSpace::write(surfaces, frame)?;
            if classifier.exterior() == Tag::Empty {
                cuts.moments = classifier.moments(control)?.as_ref().map(StoredMoments::new);
            }
        }
        let cuts = cuts.map(|(cuts, _)| cuts);
        job.advance(WHOLE);
        Ok(writer.finish_with(frame, tag, classifier.exterior(), cuts)?.with_proof(classifier.proof()))
    })
}

/// Returns the tree without cuts that represents a tree with cuts to `depth`, for functions that work on
/// cells. The surfaces of the tree decide the cells; cells that are undecided at the depth are resolved by
/// `rule`. Metadata and channels are those of `tree`. For a tree without cuts the result is the same tree,
/// cut off at the depth.
///
/// # Errors
/// As [`build`](crate::build); [`Error::Argument`] if `depth` is not 1 to 20.
pub fn plain(tree: &Octree, depth: u8, rule: Rule, control: &Control<'_>) -> Result<Octree, Error> {
    let plain = build(tree, &tree.frame().with_depth(depth)?, rule, control)?;
    Ok(plain.with_metadata_from(tree).with_channels_from(tree))
}

/// The identity of the slabs of a build; `None` if the solid has no fingerprint.
fn origin(solid: &dyn DynSolid, frame: &Frame, options: &SurfaceOptions) -> Option<Origin> {
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
    /// The wanted cells; `None` for all cells.
    shard: Option<Shard>,
    /// The level below which cells are not split.
    last: u8,
    tolerance: Option<f64>,
    /// The tolerance, if the solid has a list of layers.
    layers: Option<f64>,
    /// For each surface of the solid's list, its number among the distinct surfaces, and whether the list
    /// holds it negated.
    names: &'a [Option<(u32, bool)>],
    /// The distinct exact surfaces, on the universe. The numbers after them are those of the solid's layers,
    /// followed by those of layers of single cells.
    placed: &'a [Placed],
    /// The solid's layers, and their placed forms, created when they are first needed.
    shared: &'a [PlacedHalfSpace],
    places: &'a [OnceBox<Placed>],
    parallel: bool,
}

/// The list of surfaces that a solid provides.
struct Listed {
    /// For each surface its number among the distinct surfaces, exact ones first, and whether the list holds
    /// it negated.
    names: Vec<Option<(u32, bool)>>,
    /// The distinct exact surfaces, in their order.
    surfaces: Vec<PlacedHalfSpace>,
    /// The layers.
    shared: Vec<PlacedHalfSpace>,
}

impl Listed {
    fn new(list: Vec<PlacedHalfSpace>, job: &Job<'_>) -> Result<Listed, Error> {
        let mut pool = Pool::default();
        let (mut names, mut shared) = (memory::with_capacity(list.len())?, Vec::new());
        for surface in list {
            job.check()?;
            names.push(match pool.number(&surface)? {
                None if surface.half_space.is_layer() => {
                    memory::push(&mut shared, surface)?;
                    Err(shared.len() as u32 - 1)
                }
                name => Ok(name),
            });
        }
        // Sorted by their bytes, so that A ∪ B and B ∪ A number them in the same way.
        let (surfaces, places) = pool.sorted()?;
        let exact = surfaces.len() as u32;
        let names = memory::collected(names.into_iter().map(|name| match name {
            Ok(name) => name.map(|(id, negated)| (places[id as usize], negated)),
            Err(layer) => Some((exact + layer, false)),
        }))?;
        Ok(Listed { names, surfaces, shared })
    }
}

/// The state of one thread, and its output.
struct Hand<'j, C: Classifier> {
    worker: C::Worker,
    out: Output<'j>,
    slabs: Vec<PlacedHalfSpace>,
}

impl<'j, C: Classifier> Hand<'j, C> {
    fn new(classifier: &C, out: Output<'j>) -> Result<Hand<'j, C>, Error> {
        Ok(Hand { worker: classifier.worker()?, out, slabs: Vec::new() })
    }
}

impl<'j, C: Classifier> AsMut<Output<'j>> for Hand<'j, C> {
    fn as_mut(&mut self) -> &mut Output<'j> {
        &mut self.out
    }
}

/// A cell that was evaluated together with others: the index of its children's family, or, on the last level,
/// its part.
#[derive(Clone)]
enum Asked<P> {
    Children(usize),
    Part(P),
}

impl<C> Known for Extended<'_, C> {
    fn placed(&self, id: u32) -> Result<&Placed, Error> {
        let Some(layer) = (id as usize).checked_sub(self.placed.len()) else {
            return Ok(&self.placed[id as usize]);
        };
        self.places[layer].get_or_try_init(|| Ok(Box::new(self.shared[layer].on(&self.frame)?)))
    }

    fn order(&self, a: u32, b: u32) -> Ordering {
        a.cmp(&b)
    }

    fn joins(&self, id: u32) -> bool {
        (id as usize) < self.placed.len() + self.shared.len()
    }
}

impl<C: Classifier> Extended<'_, C> {
    fn fate(
        &self,
        cell: Cell,
        verdict: Verdict<Part<C>>,
        hand: &mut Hand<'_, C>,
    ) -> Result<Fate<Part<C>>, Error> {
        let Hand { worker, slabs, .. } = hand;
        let (fate, wants_slabs) = self.by_surfaces(cell, verdict, worker, slabs)?;
        match fate {
            Fate::Goes(part) if wants_slabs => {
                let enclosure = hand.worker.enclosure(cell, &part)?;
                self.by_slabs(cell, part, enclosure, &mut hand.slabs)
            }
            fate => Ok(fate),
        }
    }

    /// The number of the first layer that belongs to a single cell.
    fn own(&self) -> u32 {
        (self.placed.len() + self.shared.len()) as u32
    }

    /// Returns the fate of a cell by the surfaces that cross it, and whether its slabs may still end it.
    fn by_surfaces(
        &self,
        cell: Cell,
        verdict: Verdict<Part<C>>,
        worker: &mut C::Worker,
        slabs: &mut Vec<PlacedHalfSpace>,
    ) -> Result<(Fate<Part<C>>, bool), Error> {
        let part = match verdict {
            _ if self.shard.is_some_and(|shard| shard.is_without(cell)) => {
                return Ok((Fate::Ends(Cut::None), false));
            }
            Verdict::Empty => return Ok((Fate::Settled(Tag::Empty), false)),
            Verdict::Full => return Ok((Fate::Settled(Tag::Full), false)),
            Verdict::Undecided => return Ok((Fate::Ends(Cut::None), false)),
            Verdict::Partial(part) => part,
        };
        let before = slabs.len();
        let open = match self.layers {
            Some(tolerance) => worker.layers(cell, &part, tolerance, slabs)?,
            None => worker.surfaces(cell, &part)?,
        };
        let known = match open {
            Some(open) => self.renamed(cell, &open)?,
            None => None,
        };
        let wants_slabs = known.is_none() && self.tolerance.is_some();
        let done = known.and_then(|function| function.end());
        if done.is_none() {
            slabs.truncate(before);
        }
        self.quantise(cell, &mut slabs[before..]);
        let fate = match done {
            Some(done) => done.into(),
            None if cell.level == self.last && !wants_slabs => Fate::Ends(Cut::None),
            None => Fate::Goes(part),
        };
        Ok((fate, wants_slabs))
    }

    /// Stores a cell's own slabs as whole numbers, where whole numbers are about as close. (A cell may have
    /// more slabs than its function needs; a home distinguishes only three.)
    fn quantise(&self, cell: Cell, own: &mut [PlacedHalfSpace]) {
        let tolerance = self.tolerance.unwrap_or(0.0);
        for (index, slab) in (0u8..).zip(own) {
            let quantised = match usize::from(index) < MOST_KEPT {
                true => slab.quantised(&self.frame, cell, index, tolerance),
                false => None,
            };
            // (The origin is set when the tree is complete.)
            *slab = quantised.unwrap_or_else(|| {
                let number = CellSlab::number_in(cell, index);
                let half_space = slab.half_space.identified(Some(([0; 2], number)));
                PlacedHalfSpace { half_space, placements: slab.placements.clone() }
            });
        }
    }

    /// Returns the fate of a cell that has no exact surfaces.
    fn by_slabs(
        &self,
        cell: Cell,
        part: Part<C>,
        enclosure: Option<Enclosure>,
        slabs: &mut Vec<PlacedHalfSpace>,
    ) -> Result<Fate<Part<C>>, Error> {
        if let (Some(enclosure), Some(tolerance)) = (enclosure, self.tolerance)
            && let Some(cut) = self.slabs(cell, &enclosure, tolerance, slabs)?
        {
            return Ok(Fate::Ends(cut));
        }
        Ok(if cell.level == self.last { Fate::Ends(Cut::None) } else { Fate::Goes(part) })
    }

    /// Returns the same function of the distinct surfaces, simplified; `None` if a surface has no exact
    /// numbers.
    fn renamed(&self, cell: Cell, open: &OpenSurfaces) -> Result<Option<Function>, Error> {
        let (mut ids, mut table) = ([0; OpenSurfaces::MOST], open.table());
        let mut has_own = false;
        for (i, &index) in open.indices().iter().enumerate() {
            if let Some(own) = index.checked_sub(OpenSurfaces::OWN) {
                (ids[i], has_own) = (self.own() + own, true);
                continue;
            }
            let Some((id, negated)) = self.names[index as usize] else { return Ok(None) };
            if negated {
                table = table.negated(i);
            }
            ids[i] = id;
        }
        let function = Function::of_numbers(&ids[..open.indices().len()], table);
        if has_own { Ok(Some(function.canonical(self))) } else { function.simplified(cell, self).map(Some) }
    }

    /// Returns layers for the slabs of a cell; `None` if one is too thick, or bounds nothing.
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
        let mut planes = [const { None }; MOST_KEPT];
        let is_lone = enclosure.slabs.iter().filter(is_slab).count() == 1;
        // If the solid has layers, slabs have to meet the conditions for layers.
        let is_admitted = |slab: &Slab, width: f64| {
            self.layers.is_none()
                || width <= LayersQuestion::SHARE * tolerance
                || is_lone && LayersQuestion::admits(slab, tolerance / half)
        };
        for (plane, slab) in planes.iter_mut().zip(enclosure.slabs.iter().filter(is_slab)) {
            let length = libm::sqrt(slab.normal.iter().map(|c| c * c).sum::<f64>());
            let width = (slab.outer - slab.inner) * half / length;
            // (NaN is not less.)
            let is_thin = width <= tolerance && length.is_finite() && is_admitted(slab, width);
            if !is_thin {
                return Ok(None);
            }
            *plane = Some(HalfSpace::layer(&cube, slab));
        }
        let (mut ids, mut count, before) = ([0; MOST_KEPT], 0, slabs.len());
        for half_space in planes.into_iter().flatten() {
            ids[count] = u32::try_from(self.own() as usize + slabs.len()).map_err(|_| Error::OutOfMemory)?;
            memory::push(slabs, PlacedHalfSpace { half_space, placements: Arc::new([]) })?;
            count += 1;
        }
        self.quantise(cell, &mut slabs[before..]);
        let all = (0..count).map(|i| Table::of(i, false).0);
        let table = match enclosure.join {
            SlabJoin::All => all.fold(!0, |all, one| all & one),
            SlabJoin::Any => all.fold(0, |all, one| all | one),
        };
        Ok((count > 0).then_some(Cut::Table { ids, table: table as u8 }))
    }

    /// Writes the element of a PARTIAL cell; returns the cell's tag, and its cut if the tag is PARTIAL.
    fn element(&self, e: usize, cell: Cell, part: &Part<C>, hand: &mut Hand<'_, C>) -> Result<Done, Error> {
        let mark = hand.worker.mark();
        let done = if hand.worker.likes_many() {
            // Parts remain where the next elements begin.
            let levels = if e == 0 && starts_half_way(self.frame.depth()) { LEVELS - 1 } else { LEVELS };
            let last = (cell.level + levels).min(self.last);
            let told = Told { builder: self, families: self.asked(cell, part, last, hand)? };
            element(&told, e, cell, &Asked::Children(0), hand)
        } else {
            element(&Directly(self), e, cell, part, hand)
        };
        hand.worker.release(mark);
        done
    }

    /// Evaluates all cells below a cell level by level, down to a last level. Returns the fates of the
    /// children of each split cell.
    fn asked(
        &self,
        cell: Cell,
        part: &Part<C>,
        last: u8,
        hand: &mut Hand<'_, C>,
    ) -> Result<Vec<Family<Asked<Part<C>>>>, Error> {
        let control = hand.out.writer.job().control();
        let threads = if self.parallel { parallel::threads() } else { 1 };
        let mut families = Vec::new();
        let mut front = memory::collected([(cell, part.clone())].into_iter())?;
        while !front.is_empty() {
            let verdicts = split_each(self.classifier, &mut hand.worker, &front, threads, control)?;
            let mut all = memory::with_capacity(front.len())?;
            // Children that need slabs, and their places.
            let (mut cells, mut places) = (Vec::new(), Vec::new());
            for ((cell, _), verdicts) in front.iter().zip(verdicts) {
                let mut eight = OCTANTS.each(|_| Fate::Settled(Tag::Empty));
                for ((k, verdict), known) in OCTANTS.into_iter().zip(verdicts).zip(&mut eight) {
                    let child = cell.child(k);
                    let wants_slabs;
                    let Hand { worker, slabs, .. } = &mut *hand;
                    (*known, wants_slabs) = self.by_surfaces(child, verdict, worker, slabs)?;
                    if let (Fate::Goes(part), true) = (&*known, wants_slabs) {
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
                let mut told = OCTANTS.each(|_| Fate::Settled(Tag::Empty));
                for ((k, known), told) in OCTANTS.into_iter().zip(eight).zip(&mut told) {
                    *told = match known {
                        Fate::Settled(tag) => Fate::Settled(tag),
                        Fate::Ends(cut) => Fate::Ends(cut),
                        Fate::Goes(part) if cell.level + 1 == last => Fate::Goes(Asked::Part(part)),
                        Fate::Goes(part) => {
                            memory::push(&mut next, (cell.child(k), part))?;
                            Fate::Goes(Asked::Children(first + next.len() - 1))
                        }
                    };
                }
                families.push(told);
            }
            front = next;
        }
        Ok(families)
    }

    /// Writes elements of level `e` in parallel, and appends them in order.
    fn elements_in_parallel(
        &self,
        e: usize,
        open: &[(Cell, Part<C>)],
        hand: &mut Hand<'_, C>,
    ) -> Result<Vec<Done>, Error> {
        let (from, out) = (&hand.worker, &hand.out);
        let written = each_with(
            true,
            open.iter(),
            || None,
            |own, (cell, part)| {
                let out = out.sibling(&self.frame)?;
                let mut own_hand = match own.take() {
                    Some(worker) => Hand { worker, out, slabs: Vec::new() },
                    None => Hand::new(self.classifier, out)?,
                };
                let mark = own_hand.worker.mark();
                let part = own_hand.worker.hand_over(from, part)?;
                let done = self.element(e, *cell, &part, &mut own_hand)?;
                own_hand.worker.release(mark);
                let Hand { worker, out, slabs } = own_hand;
                *own = Some(worker);
                Ok((done, out, slabs))
            },
        )?;
        let mut all = memory::with_capacity(open.len())?;
        for ((tag, mut cut), out, slabs) in written {
            let before = hand.slabs.len() as u32;
            hand.out.writer.append(out.writer)?;
            hand.out.cuts.append(out.cuts, self.own(), before)?;
            cut.renumber(self.own(), before);
            hand.slabs.try_reserve(slabs.len())?;
            hand.slabs.extend(slabs);
            all.push((tag, cut));
        }
        Ok(all)
    }
}

/// A source that splits each cell when the walk reaches it.
struct Directly<'a, 'b, C>(&'a Extended<'b, C>);

impl<'j, C: Classifier> Source<'j> for Directly<'_, '_, C> {
    type Part = Part<C>;
    type Hand = Hand<'j, C>;

    fn frame(&self) -> &Frame {
        &self.0.frame
    }

    fn surfaces(&self) -> &impl Known {
        self.0
    }

    fn children(&self, cell: Cell, part: &Part<C>, hand: &mut Hand<'j, C>) -> Result<Family<Part<C>>, Error> {
        let verdicts = hand.worker.split(cell, part)?;
        let mut cells = OCTANTS.each(|_| Fate::Settled(Tag::Empty));
        for ((k, verdict), fate) in OCTANTS.into_iter().zip(verdicts).zip(&mut cells) {
            *fate = self.0.fate(cell.child(k), verdict, hand)?;
        }
        Ok(cells)
    }

    fn elements(
        &self,
        e: usize,
        open: Vec<(Cell, Part<C>)>,
        hand: &mut Hand<'j, C>,
    ) -> Result<Vec<Done>, Error> {
        // Threads start near the root.
        if self.0.parallel && e < 3 && open.len() > 1 {
            return self.0.elements_in_parallel(e, &open, hand);
        }
        let mut done = memory::with_capacity(open.len())?;
        for (cell, part) in &open {
            done.push(self.0.element(e, *cell, part, hand)?);
        }
        Ok(done)
    }
}

/// The children of cells that were evaluated together.
struct Told<'a, 'b, C: Classifier> {
    builder: &'a Extended<'b, C>,
    families: Vec<Family<Asked<Part<C>>>>,
}

impl<'j, C: Classifier> Source<'j> for Told<'_, '_, C> {
    type Part = Asked<Part<C>>;
    type Hand = Hand<'j, C>;

    fn frame(&self) -> &Frame {
        &self.builder.frame
    }

    fn surfaces(&self) -> &impl Known {
        self.builder
    }

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
        Ok(family.cloned().unwrap_or_else(|| OCTANTS.each(|_| Fate::Ends(Cut::None))))
    }

    fn elements(
        &self,
        e: usize,
        open: Vec<(Cell, Asked<Part<C>>)>,
        hand: &mut Hand<'j, C>,
    ) -> Result<Vec<Done>, Error> {
        let mut done = memory::with_capacity(open.len())?;
        for (cell, part) in open {
            done.push(match part {
                Asked::Children(_) => element(self, e, cell, &part, hand)?,
                Asked::Part(part) => self.builder.element(e, cell, &part, hand)?,
            });
        }
        Ok(done)
    }
}
