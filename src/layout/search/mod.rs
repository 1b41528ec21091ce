//! Placing what is not placed yet.
//!
//! Items go first as boxes, where boxes alone tell: that takes no split. Then they go as cells, of which all count that are not proven
//! empty; the places of a layer at which a shape meets nothing that is taken are found together. Each place that is taken is proven by
//! the solids themselves.
//!
//! | question | file |
//! |---|---|
//! | in which order, and which place is preferred? | `plan` |
//! | where do boxes go? | `rooms`, in the free boxes of `boxes` |
//! | which cells has an item, in each orientation? | `voxels`, `forms`, rows of `bits` |
//! | where does a shape go? | `space`, one item after another in `round` |

mod bits;
mod boxes;
mod forms;
mod plan;
mod rooms;
mod round;
mod space;
mod voxels;

use super::proof::diagonal;
use super::{Layout, Placed};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::exact::sqrt;
use crate::lattice::{Affine, Bounds, axes};
use crate::memory;
use crate::query::GapVerdict;
use crate::solid::{AnySolid, Solid};
use alloc::vec::Vec;
use forms::{FINER, Forms};
use plan::{Plan, Step, Tally};
use rooms::Rooms;
use round::Ground;
use space::Space;
use voxels::{Voxels, outside};

/// What a search is after. First of all as much is placed as goes in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Objective {
    /// As many items as possible.
    Count,
    /// As many items as possible, as low as possible along z.
    Height,
    /// As much volume as possible.
    Density,
    /// As many items as possible, with the centre of gravity of all that are placed near to a point (model units).
    Balance([f64; 3]),
}

/// A direction along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Direction {
    /// The axis, 0 to 2.
    pub axis: u8,
    /// Whether it leads to greater coordinates.
    pub upward: bool,
}

impl Direction {
    /// The other way.
    fn back(self) -> (usize, bool) {
        (usize::from(self.axis), !self.upward)
    }
}

/// How a search proceeds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchOptions {
    /// What it is after.
    pub objective: Objective,
    /// What chance depends on: the same seed gives the same layout, for any number of threads.
    pub seed: u64,
    /// How often everything is placed anew, in other orders; the best layout stays. At least 1.
    pub rounds: u32,
    /// Cells along the longest side of the container; 0: as the items ask for.
    pub cells: u32,
    /// Places that are looked at by the solids themselves; `None`: no limit.
    pub max_tests: Option<u64>,
    /// All items can be taken out along this direction, one after another, the last that was placed first: none of the others, and no
    /// obstacle, is in the way of a straight move. (The container may be.)
    pub free_along: Option<Direction>,
}

impl Default for SearchOptions {
    fn default() -> SearchOptions {
        SearchOptions {
            objective: Objective::Count,
            seed: 0,
            rounds: 4,
            cells: 0,
            max_tests: None,
            free_along: None,
        }
    }
}

/// Why a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SearchEnd {
    /// Everything is placed, and nothing else is asked for.
    Complete,
    /// All rounds were made.
    Rounds,
    /// `max_tests` of the options, or `max_splits` of the control, is spent.
    Budget,
    /// The caller cancelled. What was best until then is placed.
    Cancelled,
}

/// What a search did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchReport {
    /// Copies that were placed.
    pub placed: u64,
    /// Copies that were not.
    pub left: u64,
    /// Rounds that were made, those by boxes not counted.
    pub rounds: u64,
    /// Places that were looked at by the solids themselves.
    pub tests: u64,
    /// Cells that were split for that. (Cells of items and of the container that were made to search by are not counted.)
    pub splits: u64,
    /// Why it ended.
    pub end: SearchEnd,
}

/// Rounds by boxes, times items.
const BOX_STEPS: usize = 1 << 14;
const BOX_ROUNDS: u64 = 1 << 10;

/// Cells along the mean side of an item, if nobody asks for a number, and along the container.
const ACROSS: f64 = 24.0;
const CELLS: [f64; 2] = [32.0, 256.0];

/// What may still be spent.
struct Budget<'b> {
    control: Control<'b>,
    tests: u64,
    max_tests: u64,
    splits: u64,
    max_splits: u64,
    is_cancelled: bool,
}

impl Budget<'_> {
    fn is_spent(&self) -> bool {
        self.is_cancelled || self.tests >= self.max_tests || self.splits >= self.max_splits
    }

    /// Looks at a place; `None` if the caller cancelled.
    fn tested(
        &mut self,
        test: impl FnOnce(&Control<'_>) -> Result<super::Standing, Error>,
    ) -> Result<Option<super::Standing>, Error> {
        self.tests += 1;
        let left = self.max_splits - self.splits;
        let control = Control { max_splits: Some(left.min(super::proof::PAIR_SPLITS)), ..self.control };
        match test(&control) {
            Ok(standing) => {
                self.splits += standing.splits;
                Ok(Some(standing))
            }
            Err(Error::Cancelled) => {
                self.is_cancelled = true;
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }
}

impl Layout {
    /// Places copies of items that are not placed yet, and leaves those where they are that are.
    ///
    /// Each is proven to lie in the container, to overlap with nothing, and to be as far from everything as it should be: by boxes, by the
    /// triangles of meshes, or by splits of the solids. What could not be proven is not placed. The layout that is kept is the best of all
    /// rounds by what the options are after. A cancel ends the search, and keeps what was best by then; so does a budget.
    ///
    /// Memory is that of the items' cells in all orientations, and of the container's cells: some megabytes. A step takes O(r n² / 64)
    /// for n cells along the container, an item of r runs of cells, and each layer that is looked at, which are n a form and round and one
    /// more a step.
    ///
    /// # Errors
    /// [`Error::Argument`] if `rounds` is 0, `cells` is not 0 and not between 4 and 512, or an axis is not 0, 1 or 2; what the solids
    /// refuse; [`Error::OutOfMemory`]. Then the layout is as it was.
    pub fn search(&mut self, options: &SearchOptions, control: &Control<'_>) -> Result<SearchReport, Error> {
        let refuse = |name, problem| Err(Error::Argument { name, problem });
        if options.rounds == 0 {
            return refuse("rounds", "must be at least 1");
        }
        if options.cells != 0 && !(4..=512).contains(&options.cells) {
            return refuse("cells", "must be 0, or between 4 and 512");
        }
        if options.free_along.is_some_and(|way| way.axis > 2) {
            return refuse("axis", "must be 0, 1 or 2");
        }
        let before = self.placed.len();
        let found = control.run(true, |parallel| self.searched(options, parallel, control));
        if found.is_err() {
            self.placed.truncate(before);
            self.boxes.truncate(before);
        }
        found
    }

    fn searched(
        &mut self,
        options: &SearchOptions,
        parallel: bool,
        control: &Control<'_>,
    ) -> Result<SearchReport, Error> {
        let mut search = Search::new(self, options, control)?;
        let end = match search.run(options, parallel) {
            Ok(end) => end,
            Err(Error::Cancelled) => SearchEnd::Cancelled,
            Err(error) => return Err(error),
        };
        let end = if search.budget.is_cancelled { SearchEnd::Cancelled } else { end };
        let Search { best, before, rounds, budget, wanted, .. } = search;
        self.placed.truncate(before);
        self.boxes.truncate(before);
        for placed in &best.placed {
            self.place(placed.item, &placed.placement)?;
        }
        let placed = best.placed.len() as u64;
        if let Some(progress) = control.progress {
            progress(1.0);
        }
        Ok(SearchReport {
            placed,
            left: wanted - placed,
            rounds,
            tests: budget.tests,
            splits: budget.splits,
            end,
        })
    }
}

/// The best layout so far: what is placed beyond what was.
#[derive(Default)]
struct Best {
    placed: Vec<Placed>,
    tally: Option<Tally>,
}

/// A search under way.
struct Search<'s, 'c> {
    layout: &'s mut Layout,
    budget: Budget<'c>,
    control: Control<'c>,
    best: Best,
    /// How many were placed before.
    before: usize,
    left: Vec<u32>,
    sizes: Vec<f64>,
    wanted: u64,
    rounds: u64,
    objective: Objective,
}

impl<'s, 'c> Search<'s, 'c> {
    fn new(layout: &'s mut Layout, options: &SearchOptions, control: &Control<'c>) -> Result<Self, Error> {
        let mut left = memory::collected(layout.items.iter().map(|item| item.count))?;
        for placed in &layout.placed {
            left[placed.item] = left[placed.item].saturating_sub(1);
        }
        let sizes = memory::collected(layout.items.iter().map(|item| {
            let size: [f64; 3] = axes(|k| item.bounds.max[k] - item.bounds.min[k]);
            size.iter().product()
        }))?;
        let budget = Budget {
            control: Control { progress: None, ..*control },
            tests: 0,
            max_tests: options.max_tests.unwrap_or(u64::MAX),
            splits: 0,
            max_splits: control.max_splits.unwrap_or(u64::MAX),
            is_cancelled: false,
        };
        let wanted = left.iter().map(|&count| u64::from(count)).sum();
        let before = layout.placed.len();
        let objective = options.objective;
        Ok(Search {
            layout,
            budget,
            control: *control,
            best: Best::default(),
            before,
            left,
            sizes,
            wanted,
            rounds: 0,
            objective,
        })
    }

    fn run(&mut self, options: &SearchOptions, parallel: bool) -> Result<SearchEnd, Error> {
        if self.wanted == 0 {
            return Ok(SearchEnd::Complete);
        }
        let mut maps = memory::with_capacity(self.layout.items.len())?;
        for item in &self.layout.items {
            maps.push(item.orientations.maps(options.seed)?);
        }
        if !matches!(options.objective, Objective::Balance(_)) {
            self.by_boxes(options, &maps)?;
            let is_whole = self.best.placed.len() as u64 == self.wanted;
            if is_whole && options.objective == Objective::Count {
                return Ok(SearchEnd::Complete);
            }
        }
        if self.budget.is_spent() {
            return Ok(SearchEnd::Budget);
        }
        self.by_cells(options, &maps, parallel)
    }

    /// Takes away what was placed in the last round.
    fn clear(&mut self) {
        self.layout.placed.truncate(self.before);
        self.layout.boxes.truncate(self.before);
    }

    /// Keeps what is placed if it is the best so far.
    fn keep(&mut self, tally: Tally) -> Result<(), Error> {
        if self.best.tally.is_none_or(|best| is_better(&tally, &best, self.objective)) {
            self.best.placed = memory::copied(&self.layout.placed[self.before..])?;
            self.best.tally = Some(tally);
        }
        Ok(())
    }

    fn by_boxes(&mut self, options: &SearchOptions, maps: &[Vec<Affine>]) -> Result<(), Error> {
        let Some(rooms) = Rooms::new(self.layout, maps)? else { return Ok(()) };
        let mut best: Option<(Tally, Vec<Step>)> = None;
        let rounds = (BOX_STEPS as u64 / self.wanted).clamp(4, BOX_ROUNDS);
        for round in 0..rounds {
            let plan = Plan::new(&self.left, &self.sizes, round, options.seed)?;
            let steps = rooms.round(self.layout, &plan, &self.budget.control)?;
            let tally = rooms::tally(self.layout, &steps);
            let is_whole = steps.len() as u64 == self.wanted;
            if best.as_ref().is_none_or(|best| is_better(&tally, &best.0, self.objective)) {
                best = Some((tally, steps));
            }
            if is_whole && self.objective == Objective::Count {
                break;
            }
        }
        // Boxes that are apart prove it; what they do not prove is left out.
        let mut tally = Tally::default();
        for step in best.iter().flat_map(|best| &best.1) {
            if self.budget.is_spent() {
                break;
            }
            let layout = &*self.layout;
            let standing =
                self.budget.tested(|control| layout.stands(step.item, &step.placement, None, control))?;
            if standing.is_some_and(|standing| standing.verdict == GapVerdict::Yes) {
                let number = self.layout.place(step.item, &step.placement)?;
                tally.count += 1;
                tally.height = tally.height.max(self.layout.boxes[number].max[2]);
            }
        }
        tally.volume = self.volume()?;
        self.keep(tally)?;
        self.clear();
        Ok(())
    }

    /// The volume of the boxes of all that is placed by the search.
    fn volume(&self) -> Result<f64, Error> {
        let new = &self.layout.placed[self.before..];
        Ok(new.iter().map(|placed| self.sizes[placed.item]).sum())
    }

    fn by_cells(
        &mut self,
        options: &SearchOptions,
        maps: &[Vec<Affine>],
        parallel: bool,
    ) -> Result<SearchEnd, Error> {
        let own = self.budget.control;
        let (origin, cell, size) = self.lattice(options);
        let clearance = self.layout.clearance;
        let mut forms = memory::with_capacity(maps.len())?;
        for (item, maps) in self.layout.items.iter().zip(maps) {
            forms.push(Forms::of(item, maps, cell, clearance, &own)?);
        }
        let longest = forms.iter().flat_map(|forms| &forms.all).flat_map(|form| &form.shape.runs);
        let longest = longest.map(|run| run.length as usize).fold(1, usize::max);
        let mut space = Space::new(size, longest)?;
        self.fill(&mut space, origin, cell, options, &own)?;
        let volumes = memory::collected(forms.iter().map(|forms| forms.volume))?;
        let ground = Ground {
            forms: &forms,
            space: &space,
            origin,
            cell,
            objective: options.objective,
            free_along: options.free_along,
            parallel,
        };
        for round in 0..u64::from(options.rounds) {
            let plan = Plan::new(&self.left, &self.sizes, round, options.seed)?;
            let tally = ground.round(self.layout, &plan, &mut self.budget);
            let tally = match tally {
                Err(Error::Cancelled) => {
                    self.budget.is_cancelled = true;
                    Tally::of(self.layout, self.before, &volumes)
                }
                other => other?,
            };
            self.keep(Tally { volume: self.volume()?, ..tally })?;
            self.clear();
            self.rounds += 1;
            if self.budget.is_spent() {
                return Ok(SearchEnd::Budget);
            }
            if let Some(progress) = self.control.progress {
                progress((round + 1) as f64 / (f64::from(options.rounds) + 1.0));
            }
            let is_whole = self.best.placed.len() as u64 == self.wanted;
            if is_whole && options.objective == Objective::Count {
                return Ok(SearchEnd::Complete);
            }
        }
        Ok(SearchEnd::Rounds)
    }

    /// The cells by which is searched: the lower corner of the first, their edge, and their numbers along the axes.
    fn lattice(&self, options: &SearchOptions) -> ([f64; 3], f64, [usize; 3]) {
        let container = &self.layout.container;
        let (bounds, margin) =
            (container.bounds(), if container.is_box() { container.clearance() } else { 0.0 });
        let low = bounds.min.map(|low| low + margin);
        let length: [f64; 3] = axes(|k| (bounds.max[k] - margin - low[k]).max(0.0));
        let longest = length.into_iter().fold(f64::MIN_POSITIVE, f64::max);
        let cells = match options.cells {
            0 => {
                let items = self.layout.items.iter().zip(&self.left).filter(|(_, left)| **left > 0);
                let sides = items.map(|(item, _)| diagonal(&item.bounds) / sqrt(3.0));
                let least = sides.fold(longest, f64::min).max(f64::MIN_POSITIVE);
                (ACROSS * longest / least).clamp(CELLS[0], CELLS[1])
            }
            cells => f64::from(cells),
        };
        let cell = longest / libm::ceil(cells);
        (low, cell, length.map(|length| (length / cell * (1.0 + 1e-12)) as usize))
    }

    /// Takes the cells that are not free.
    fn fill(
        &self,
        space: &mut Space,
        origin: [f64; 3],
        cell: f64,
        options: &SearchOptions,
        control: &Control<'_>,
    ) -> Result<(), Error> {
        let layout = &*self.layout;
        let size = space.size();
        if !layout.container.is_box() {
            let margin = layout.container.clearance() / cell;
            let pad = libm::ceil(margin) as usize;
            let wall = outside(layout.container.solid(), (origin, cell, size), pad, control)?;
            let wall = if pad > 0 { wall.grown(margin, pad)? } else { wall };
            space.take(&wall, [-(2 * pad as isize); 3], None)?;
        }
        let shade = options.free_along.map(Direction::back);
        let fine = cell / FINER as f64;
        let clearance = layout.clearance / fine;
        let pad = (libm::ceil(clearance) as usize).next_multiple_of(FINER);
        let mut take = |solid: &AnySolid, bounds: &Bounds| {
            let Voxels { bits, origin: from } = Voxels::of(solid, bounds, fine, Some(origin), control)?;
            let first: [isize; 3] = axes(|k| libm::round((from[k] - origin[k]) / fine) as isize);
            let bits = if pad > 0 { bits.grown(clearance, pad)? } else { bits };
            let first = first.map(|first| first - pad as isize);
            let low = first.map(|first| first.div_euclid(FINER as isize));
            let beyond: [usize; 3] = axes(|k| (first[k] - low[k] * FINER as isize) as usize);
            let coarse = bits.coarser(FINER, beyond)?;
            space.take(&coarse, low, shade)
        };
        for obstacle in &layout.obstacles {
            take(obstacle.solid(), obstacle.bounds())?;
        }
        for (placed, block) in layout.placed.iter().zip(&layout.boxes) {
            let solid = layout.items[placed.item].solid.placed(&placed.placement)?;
            let bounds = solid.bounds().and_then(|own| own.common(block)).unwrap_or(*block);
            take(&solid, &bounds)?;
        }
        Ok(())
    }
}

impl Tally {
    fn of(layout: &Layout, before: usize, volumes: &[f64]) -> Tally {
        let new = &layout.placed[before..];
        Tally {
            count: new.len() as u64,
            volume: new.iter().map(|placed| volumes[placed.item]).sum(),
            height: layout.boxes.iter().map(|block| block.max[2]).fold(f64::NEG_INFINITY, f64::max),
            off: f64::INFINITY,
        }
    }
}

/// Whether one result is better than another one.
fn is_better(a: &Tally, b: &Tally, objective: Objective) -> bool {
    let rank = |tally: &Tally| match objective {
        Objective::Count => [tally.count as f64, tally.volume, -tally.height],
        Objective::Height => [tally.count as f64, -tally.height, tally.volume],
        Objective::Density => [tally.volume, -tally.height, tally.count as f64],
        Objective::Balance(_) => [tally.count as f64, -tally.off, tally.volume],
    };
    rank(a) > rank(b)
}
