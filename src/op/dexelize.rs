//! Building a tri-dexel model from any solid.
//!
//! Rays are made in tiles. Each tile has a descent of its own through the cells that it crosses. A solid that
//! computes rays ([`Question::Chords`](crate::solid::Question::Chords)) answers for large cells at once:
//! meshes by scan conversion, expressions of half-spaces by roots. For other solids the finest cells are
//! sampled. Between two centres on different sides, finer cells and their slabs narrow down the crossing.

use super::rule::Rule;
use crate::control::{Control, Job, WHOLE};
use crate::dexel::{
    Beam, BeamEnd, DexelEnds, DexelFormat, DoubleSpan, FixedSpan, Form, ModelArrays, OTHERS, Piece, Scratch,
    TriDexel, Window, assembled, first_above,
};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::{Bounds, Cell, Frame, MAX_DEPTH};
use crate::memory;
use crate::parallel::each_with;
use crate::solid::{AnyClassifier, AnyWorker, Ask, Classifier, DynSolid, ErasedPart, Parts, Verdict, Worker};
use crate::walk::Edge;
use crate::walk::Trail;
use crate::walk::hull;
use crate::walk::split_one;
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::ops::Range;
use once_cell::race::OnceBox;

/// From this number of rays on, it pays to search first for the part of the box where the solid lies.
const MANY: u64 = 1 << 22;
/// The number of rows of rays in a tile.
const ROWS: u32 = 32;

/// The directions, interval format and rule of a tri-dexel model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DexelOptions {
    /// The axes along which rays run (x, y, z); at least one.
    pub directions: [bool; 3],
    /// The data that is stored for each interval.
    pub format: DexelFormat,
    /// [`Rule::Sampled`]: the intervals of the solid on each ray. [`Rule::Inner`]: the intervals of its FULL
    /// cells. [`Rule::Outer`]: the intervals of all cells that are not EMPTY.
    pub rule: Rule,
}

impl Default for DexelOptions {
    /// All three directions, fixed-point ends without attached data, sampled.
    fn default() -> DexelOptions {
        DexelOptions { directions: [true; 3], format: DexelFormat::default(), rule: Rule::Sampled }
    }
}

/// Builds a tri-dexel model of a solid on the lattice of a frame.
///
/// A ray runs through the centres of finest cells, shifted in thought by (ε, ε², ε³), so that it meets no
/// edge of the solid and grazes no face. The ray has an end where it crosses the surface. An end agrees with
/// the solid at the centres beside it, so the model has the samples of [`build`](crate::build) with
/// [`Rule::Sampled`]. Apart from that, the error of an end is at most 2^-31 of the universe's edge, or 2^-36
/// with [`DexelEnds::Double`]. Intervals shorter than this vanish.
///
/// This holds for closed meshes under any fill rule, for half-spaces (planes, quadrics, powers, tori), for
/// expressions of these, and for stored octrees. Around the holes of open meshes, too, every crossing of a
/// triangle that changes the side is an end. Where no triangle bounds the solid, there is an end between two
/// centres on different sides, where the winding number passes one half. Other solids (expressions with other
/// solids as operands, transforms, functions of a host, volumes) are evaluated by cells and samples. Ends
/// between centres on different sides are narrowed down by cells to a depth of 20. An end between a face of
/// the universe and the centre next to it is narrowed down in the same way, if the centre lies inside and the
/// point where the ray meets the face does not. Walls between two neighbouring centres on one side are not
/// seen. With a frame of depth 20 the ends of such solids lie in the planes between cells. The surfaces at
/// ends are the numbers of triangles and of half-spaces. Half-spaces are numbered in the order of the
/// written-out expression.
///
/// (The method is that of Gao, Zhang and Hou 2007 for polygons, with exact decisions at edges and vertices.)
///
/// O(rays + crossings), plus the descent to the cells where the solid computes rays. Each end of an open mesh
/// without a triangle takes some sums over the edges of all holes. The result is the same for any number of
/// threads.
///
/// # Errors
/// [`Error::Argument`] if no direction is requested, or for [`Rule::Certified`], because intervals cannot be
/// undecided; [`Error::NotSampled`] if the solid cannot decide points ([`Rule::Inner`] and [`Rule::Outer`]
/// need no points); [`Error::Limit`] for 2^32 rays or intervals in one direction; [`Error::TooLarge`] if the
/// rays alone take more than `control.max_bytes`; the errors of the solid ([`Error::FrameMismatch`] for
/// stored trees, [`Error::Damaged`] for unverified ones); and cancellation or an exceeded limit of `control`.
///
/// ```
/// use leafless::{Control, Csg, Frame, dexelize, op::DexelOptions};
/// let frame = Frame::new([-1.0; 3], 2.0, 7)?;
/// let ball = dexelize(&Csg::ball([0.0; 3], 0.75)?, &frame, &DexelOptions::default(), &Control::default())?;
/// let volume = ball.view().statistics(2).unwrap().volume;
/// assert!((volume - 4.0 / 3.0 * 3.14159265 * 0.75f64.powi(3)).abs() < 1e-3);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn dexelize(
    solid: &dyn DynSolid,
    frame: &Frame,
    options: &DexelOptions,
    control: &Control<'_>,
) -> Result<TriDexel, Error> {
    if options.rule == Rule::Certified {
        let problem = "must not be certified: an interval cannot be undecided; take sampled, inner or outer";
        return Err(Error::Argument { name: "rule", problem });
    }
    if options.directions == [false; 3] {
        return Err(Error::Argument { name: "directions", problem: "at least one is needed" });
    }
    let extent = extent(solid.bounds(), frame);
    match options.format.ends {
        DexelEnds::Fixed => model::<FixedSpan>(solid, frame, extent, options, control),
        DexelEnds::Double => model::<DoubleSpan>(solid, frame, extent, options, control),
    }
}

/// The range of cells on each axis whose centres may lie within bounds.
fn extent(bounds: Option<Bounds>, frame: &Frame) -> [Range<u32>; 3] {
    let all = 0..frame.cells();
    let Some(bounds) = bounds else { return [all.clone(), all.clone(), all] };
    axes(|axis| {
        // One cell more than needed, because of rounding.
        let cells = f64::from(frame.cells());
        let low = frame.scaled(axis, bounds.min[axis]) - 1.0;
        let high = frame.scaled(axis, bounds.max[axis]) + 2.0;
        // (NaN is no bound.)
        let low = if low > 0.0 { low.min(cells) as u32 } else { 0 };
        let high = if high < cells { high.max(0.0) as u32 } else { frame.cells() };
        low.min(high)..high
    })
}

/// The number of rays through the cells of an extent, in all requested directions.
fn rays(extent: &[Range<u32>; 3], options: &DexelOptions) -> u64 {
    let count = |axis: usize| Window::of(OTHERS[axis].each(|axis| extent[axis].clone())).count();
    (0..3).filter(|&axis| options.directions[axis]).map(count).sum()
}

fn model<S: Form>(
    solid: &dyn DynSolid,
    frame: &Frame,
    extent: [Range<u32>; 3],
    options: &DexelOptions,
    control: &Control<'_>,
) -> Result<TriDexel, Error> {
    let (frame, classifier) = (*frame, &solid.on(frame, control)?);
    let finest = OnceBox::new();
    let job = Job::new(control);
    job.check()?;
    let extent = if rays(&extent, options) > MANY {
        let known = hull(&mut classifier.worker()?, frame.depth(), control)?;
        axes(|axis| {
            let start = extent[axis].start.max(known[axis].start);
            start..extent[axis].end.min(known[axis].end).max(start)
        })
    } else {
        extent
    };
    // Each ray stores the number of its first interval.
    control.afford("the rays", rays(&extent, options).saturating_mul(size_of::<u32>() as u64))?;
    let window = |axis: usize| Window::of(OTHERS[axis].each(|axis| extent[axis].clone()));
    let worth = rays(&extent, options) > 1 << 14;
    control.run(worth, |parallel| {
        let axes = options.directions.iter().filter(|&&has| has).count();
        let mut rays = [const { None }; 3];
        for (i, axis) in (0..3).filter(|&axis| options.directions[axis]).enumerate() {
            let tiles = Tiles {
                solid,
                classifier,
                finest: &finest,
                frame,
                axis,
                window: window(axis),
                options,
                job: &job,
                parts: WHOLE * (i + 1) / axes - WHOLE * i / axes,
            };
            let pieces = tiles.pieces::<S>(parallel)?;
            let rows = assembled(tiles.window, &options.format, pieces)?;
            rays[axis] = Some(S::own(rows));
        }
        Ok(TriDexel::new(ModelArrays { frame, format: options.format, rays }))
    })
}

/// The rays of one direction, in tiles of several rows.
struct Tiles<'a, 's> {
    solid: &'a (dyn DynSolid + 's),
    classifier: &'a AnyClassifier<'s>,
    /// The solid on the finest lattice, created when it is first needed.
    finest: &'a OnceBox<AnyClassifier<'s>>,
    frame: Frame,
    axis: usize,
    window: Window,
    options: &'a DexelOptions,
    job: &'a Job<'a>,
    /// The progress units of all tiles together.
    parts: usize,
}

/// The state of one thread.
struct Hand<'s> {
    worker: AnyWorker<'s>,
    beam: Beam,
    scratch: Scratch,
    /// The sampled finest cells: the number of the ray and the place of the cell on it.
    sampled: Vec<(u32, u32)>,
    /// On the finest lattice; created when it is first needed.
    trail: Option<Trail<AnyWorker<'s>>>,
}

impl<'s> Tiles<'_, 's> {
    fn pieces<S: Form>(&self, parallel: bool) -> Result<Vec<Piece<S>>, Error> {
        let rows = self.window.range(1);
        // Tiles begin at the same rows as blocks of cells.
        let first = rows.start / ROWS;
        let count = rows.end.div_ceil(ROWS).saturating_sub(first);
        let each_tile = self.parts.checked_div(count as usize).unwrap_or(0);
        self.job.advance(self.parts - each_tile * count as usize);
        let tile = |i: u32| {
            let range = rows.start.max((first + i) * ROWS)..rows.end.min((first + i + 1) * ROWS);
            Window::of([self.window.range(0), range])
        };
        if parallel && count > 1 {
            return each_with(
                true,
                (0..count as usize).map(|i| tile(i as u32)),
                || None,
                |own, tile| {
                    let hand = match own {
                        Some(hand) => hand,
                        none => none.insert(self.hand()?),
                    };
                    let mut piece = Piece::new(&self.options.format, tile.count() as usize)?;
                    self.tile(hand, tile, &mut piece)?;
                    self.job.advance(each_tile);
                    Ok(piece)
                },
            );
        }
        let mut pieces = memory::with_capacity(1)?;
        let mut hand = self.hand()?;
        let mut piece = Piece::new(&self.options.format, self.window.count() as usize)?;
        for i in 0..count {
            self.tile(&mut hand, tile(i), &mut piece)?;
            self.job.advance(each_tile);
        }
        pieces.push(piece);
        Ok(pieces)
    }

    fn hand(&self) -> Result<Hand<'s>, Error> {
        let format = &self.options.format;
        let marked = format.surfaces || format.normals != Default::default();
        Ok(Hand {
            worker: self.classifier.worker()?,
            beam: Beam::new(self.axis, self.frame.depth(), self.window, marked),
            scratch: Scratch::default(),
            sampled: Vec::new(),
            trail: None,
        })
    }

    fn tile<S: Form>(&self, hand: &mut Hand<'s>, window: Window, piece: &mut Piece<S>) -> Result<(), Error> {
        self.job.check()?;
        hand.beam.restart(window);
        hand.sampled.clear();
        let root = hand.worker.root()?;
        self.cell(hand, Cell::ROOT, root)?;
        hand.beam.join(&mut hand.scratch)?;
        if !hand.sampled.is_empty() {
            self.refine(hand)?;
        }
        let before = piece.columns.spans.len();
        hand.beam.append(piece)?;
        let intervals = piece.columns.spans.len() - before;
        let bytes =
            size_of::<u32>() * window.count() as usize + intervals * self.options.format.bytes_per_interval();
        self.job.spend(0, bytes)
    }

    /// The part of a cell that lies in the tile: rays, and the cell's span along them.
    fn shadow(&self, window: &Window, cell: Cell) -> (Window, Range<u32>) {
        let shift = self.frame.depth() - cell.level;
        let range = |axis: usize| cell.at[axis] << shift..(cell.at[axis] + 1) << shift;
        (Window::of(OTHERS[self.axis].each(range)).intersection(window), range(self.axis))
    }

    /// Adds the intervals in a cell. The recursion is as deep as the frame, at most 20 levels.
    fn cell(&self, hand: &mut Hand<'s>, cell: Cell, verdict: Verdict<ErasedPart>) -> Result<(), Error> {
        if matches!(verdict, Verdict::Empty) {
            return Ok(());
        }
        let (rays, span) = self.shadow(&hand.beam.window(), cell);
        if rays.is_empty() {
            return Ok(());
        }
        match verdict {
            Verdict::Empty => Ok(()),
            Verdict::Full => fill(&mut hand.beam, rays, span),
            Verdict::Undecided => match self.options.rule {
                Rule::Inner => Ok(()),
                Rule::Outer => fill(&mut hand.beam, rays, span),
                Rule::Sampled | Rule::Certified => Err(Error::NotSampled),
            },
            Verdict::Partial(part) => {
                if self.options.rule == Rule::Sampled {
                    hand.beam.enter(rays, span.clone());
                    if hand.worker.chords(cell, &part, &mut hand.beam)? {
                        return Ok(());
                    }
                }
                if cell.level == self.frame.depth() {
                    return self.finest(hand, cell, &part, rays, span);
                }
                self.job.check()?;
                let mark = hand.worker.mark();
                let verdicts = split_one(&mut hand.worker, cell, &part, self.job.control())?;
                for (octant, verdict) in (0..8).zip(verdicts) {
                    self.cell(hand, cell.child(octant), verdict)?;
                }
                hand.worker.release(mark);
                Ok(())
            }
        }
    }

    /// Adds the intervals of an undecided finest cell.
    fn finest(
        &self,
        hand: &mut Hand<'s>,
        cell: Cell,
        part: &ErasedPart,
        rays: Window,
        span: Range<u32>,
    ) -> Result<(), Error> {
        match self.options.rule {
            Rule::Inner => Ok(()),
            Rule::Outer => fill(&mut hand.beam, rays, span),
            Rule::Sampled | Rule::Certified => {
                let inside = hand.worker.sample(cell, part)?.ok_or(Error::NotSampled)?;
                if let Some(ray) = hand.beam.window().index(rays.first) {
                    memory::push(&mut hand.sampled, (ray as u32, span.start))?;
                }
                if inside { fill(&mut hand.beam, rays, span) } else { Ok(()) }
            }
        }
    }

    /// Moves the ends at sampled cells from the planes between cells, and from the universe's faces, to the
    /// surface.
    fn refine(&self, hand: &mut Hand<'s>) -> Result<(), Error> {
        let depth = self.frame.depth();
        if depth >= MAX_DEPTH {
            return Ok(());
        }
        hand.sampled.sort_unstable();
        let frame = self.frame.with_depth(depth + 1)?;
        let (window, cells) = (hand.beam.window(), self.frame.cells());
        let [u, v] = OTHERS[self.axis];
        for i in 0..hand.beam.chords().len() {
            let chord = hand.beam.chords()[i];
            for (side, end) in chord.ends.into_iter().enumerate() {
                self.job.check()?;
                let plane = end as u32;
                let is_open = |k: u32| hand.sampled.binary_search(&(chord.ray, k)).is_ok();
                if end != f64::from(plane) || !(plane > 0 && is_open(plane - 1) || is_open(plane)) {
                    continue;
                }
                let [column, row] = window.ray(chord.ray as usize);
                let mut lower = [0; 3];
                (lower[u], lower[v]) = (2 * column as i32 + 1, 2 * row as i32 + 1);
                // Search from centre to centre; at a face, from the face to the first centre.
                let first = (2 * plane as i32 - 1).max(0);
                let last = (2 * plane as i32 + 1).min(2 * cells as i32);
                lower[self.axis] = first;
                let edge =
                    Edge { axis: self.axis, lower, steps: (last - first) as u32, starts_inside: side == 1 };
                let trail = match &mut hand.trail {
                    Some(trail) => trail,
                    none => none.insert(self.trail()?),
                };
                // (An interval may begin at the lower face and end at the upper one.)
                let is_face = plane == 0 || plane == cells;
                if is_face && edge.face(&frame, plane > 0, trail, self.job.control())? != Some(false) {
                    continue;
                }
                let t = edge.crossing(&frame, trail, self.job.control())?;
                let at = 0.5 * (f64::from(first) + f64::from(last - first) * t);
                let moved = BeamEnd::new(at, plane, cells);
                debug_assert_eq!(first_above(moved.at), i64::from(plane));
                hand.beam.set_end(i, side, moved);
            }
        }
        Ok(())
    }

    fn trail(&self) -> Result<Trail<AnyWorker<'s>>, Error> {
        // (This code runs on one of several threads.)
        let control = Control { threads: 1, progress: None, ..*self.job.control() };
        let find = || self.solid.on(&self.frame.with_depth(MAX_DEPTH)?, &control).map(Box::new);
        Trail::new(self.finest.get_or_try_init(find)?.worker()?)
    }
}

/// Adds spans that cover the whole cell.
fn fill(beam: &mut Beam, rays: Window, span: Range<u32>) -> Result<(), Error> {
    let [start, end] = [span.start, span.end].each(BeamEnd::between);
    for v in rays.range(1) {
        for u in rays.range(0) {
            beam.push([u, v], start, end)?;
        }
    }
    Ok(())
}
