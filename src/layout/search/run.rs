//! The course of a search: by boxes, by cells, and again for the remaining items after settling.

use super::super::{Layout, Placed};
use super::budget::Budget;
use super::ground::Lattice;
use super::plan::{Plan, Step};
use super::rooms::Rooms;
use super::round::Round;
use super::settle::settle;
use super::tally::{Figure, Tally};
use super::{Objective, SearchEnd, SearchOptions, SearchReport};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Affine;
use crate::memory;
use alloc::vec::Vec;

/// Limits of the search by boxes: rounds times items, and rounds.
const BOX_STEPS: u64 = 1 << 14;
const BOX_ROUNDS: u64 = 1 << 10;

/// The number of times that all items settle and the remaining ones are tried again.
const SETTLINGS: u32 = 3;

/// The state of a search.
struct Search<'s, 'c> {
    layout: &'s mut Layout,
    options: &'s SearchOptions,
    control: Control<'c>,
    budget: Budget<'c>,
    /// The number of copies placed before the search.
    before: usize,
    left: Vec<u32>,
    wanted: u64,
    figures: Vec<Figure>,
    /// The copies placed in the best layout so far.
    best: Vec<Placed>,
    rounds: u64,
}

/// Places copies that are not placed yet; see [`Layout::search`].
pub(super) fn search(
    layout: &mut Layout,
    options: &SearchOptions,
    parallel: bool,
    control: &Control<'_>,
) -> Result<SearchReport, Error> {
    let mut search = Search::new(layout, options, control)?;
    let end = match search.run(parallel) {
        Ok(end) => end,
        Err(Error::Cancelled) => {
            // (An unfinished round may be better than those before.)
            search.keep()?;
            SearchEnd::Cancelled
        }
        Err(error) => return Err(error),
    };
    search.show_best()?;
    if let Some(progress) = control.progress {
        progress(1.0);
    }
    let Search { budget, best, wanted, rounds, .. } = search;
    let placed = best.len() as u64;
    Ok(SearchReport {
        placed,
        left: wanted - placed,
        rounds,
        tests: budget.tests,
        splits: budget.splits,
        end,
    })
}

impl<'s, 'c> Search<'s, 'c> {
    fn new(layout: &'s mut Layout, options: &'s SearchOptions, control: &Control<'c>) -> Result<Self, Error> {
        let mut left = memory::collected(layout.items.iter().map(|item| item.count))?;
        for placed in &layout.placed {
            left[placed.item] = left[placed.item].saturating_sub(1);
        }
        let figures = memory::collected(layout.items.iter().map(|item| Figure::of_box(&item.bounds)))?;
        let budget = Budget {
            control: Control { progress: None, ..*control },
            tests: 0,
            max_tests: options.max_tests.unwrap_or(u64::MAX),
            splits: 0,
            max_splits: control.max_splits.unwrap_or(u64::MAX),
        };
        let wanted = left.iter().map(|&count| u64::from(count)).sum();
        let before = layout.placed.len();
        Ok(Search {
            layout,
            options,
            control: *control,
            budget,
            before,
            left,
            wanted,
            figures,
            best: Vec::new(),
            rounds: 0,
        })
    }

    fn run(&mut self, parallel: bool) -> Result<SearchEnd, Error> {
        if self.wanted == 0 {
            return Ok(SearchEnd::Complete);
        }
        let mut maps = memory::with_capacity(self.layout.items.len())?;
        for item in &self.layout.items {
            maps.push(item.orientations.maps(self.options.seed)?);
        }
        self.by_boxes(&maps)?;
        match self.end() {
            Some(end) => Ok(end),
            None => self.by_cells(&maps, parallel),
        }
    }

    /// Returns why the search is over; `None` if it is not.
    fn end(&self) -> Option<SearchEnd> {
        if self.budget.is_spent() {
            return Some(SearchEnd::Budget);
        }
        let is_whole = self.best.len() as u64 == self.wanted;
        (is_whole && self.options.objective == Objective::Count).then_some(SearchEnd::Complete)
    }

    /// Removes all copies that the search has placed.
    fn clear(&mut self) {
        self.layout.placed.truncate(self.before);
        self.layout.boxes.truncate(self.before);
    }

    /// Stores the placed copies if they are the best layout so far, and removes them from the layout.
    fn keep(&mut self) -> Result<(), Error> {
        let objective = self.options.objective;
        let now = Tally::of(self.layout, self.before, &self.figures, objective);
        let new = memory::copied(&self.layout.placed[self.before..])?;
        self.show_best()?;
        if now.is_better_than(&Tally::of(self.layout, self.before, &self.figures, objective), objective) {
            self.best = new;
        }
        self.clear();
        Ok(())
    }

    /// Places the best layout so far, and nothing else.
    fn show_best(&mut self) -> Result<(), Error> {
        self.clear();
        for placed in &self.best {
            self.layout.place(placed.item, &placed.placement)?;
        }
        Ok(())
    }

    fn by_boxes(&mut self, maps: &[Vec<Affine>]) -> Result<(), Error> {
        let Some(rooms) = Rooms::new(self.layout, maps)? else { return Ok(()) };
        let objective = self.options.objective;
        let mut best: Option<(Tally, Vec<Step>)> = None;
        for round in 0..(BOX_STEPS / self.wanted).clamp(4, BOX_ROUNDS) {
            let plan = Plan::new(&self.left, &self.figures, round, self.options.seed)?;
            let steps = rooms.round(self.layout, &plan, &self.budget.control)?;
            for step in &steps {
                self.layout.place(step.item, &step.placement)?;
            }
            let tally = Tally::of(self.layout, self.before, &self.figures, objective);
            self.clear();
            let is_whole = steps.len() as u64 == self.wanted;
            if best.as_ref().is_none_or(|best| tally.is_better_than(&best.0, objective)) {
                best = Some((tally, steps));
            }
            if is_whole && objective == Objective::Count {
                break;
            }
        }
        let mut steps = best.map_or(Vec::new(), |best| best.1);
        if let Some(way) = self.options.free_along {
            // A copy further along the way gets out first, so that nothing remains in the way of the others.
            let end = |step: &Step| {
                let block = self.layout.items[step.item].bounds.placed(&step.placement);
                let axis = usize::from(way.axis);
                block.map_or(0.0, |block| if way.upward { block.min[axis] } else { -block.max[axis] })
            };
            steps.sort_unstable_by(|a, b| end(a).total_cmp(&end(b)).then(a.item.cmp(&b.item)));
        }
        // Separate boxes are a proof. A copy without a proof is omitted.
        for step in &steps {
            if self.budget.is_spent() {
                break;
            }
            let layout = &*self.layout;
            if self.budget.tested(|control| layout.stands(step.item, &step.placement, None, control))? {
                self.layout.place(step.item, &step.placement)?;
            }
        }
        self.keep()
    }

    fn by_cells(&mut self, maps: &[Vec<Affine>], parallel: bool) -> Result<SearchEnd, Error> {
        let (options, own) = (self.options, self.budget.control);
        let lattice = Lattice::of(self.layout, options, &self.left);
        let forms = lattice.forms(self.layout, maps, &own)?;
        for (figure, forms) in self.figures.iter_mut().zip(&forms) {
            *figure = forms.figure;
        }
        let space = lattice.space(self.layout, &forms, options.free_along, &own)?;
        let rounds = u64::from(options.rounds);
        let shares = (rounds + u64::from(SETTLINGS)) as f64;
        for round in 0..rounds {
            let plan = Plan::new(&self.left, &self.figures, round, options.seed)?;
            let ground = Round { lattice, forms: &forms, figures: &self.figures, options, parallel };
            ground.run(self.layout, space.try_clone()?, &plan, &mut self.budget)?;
            self.keep()?;
            self.rounds += 1;
            if let Some(end) = self.end() {
                return Ok(end);
            }
            if let Some(progress) = self.control.progress {
                progress((round + 1) as f64 / shares);
            }
        }
        // (A settled item may no longer get out along its way. Nor may items move if the centre of gravity
        // has a target.)
        if options.free_along.is_some() || matches!(options.objective, Objective::Balance(_)) {
            return Ok(SearchEnd::Rounds);
        }
        for k in 0..SETTLINGS {
            self.show_best()?;
            settle(self.layout, self.before, lattice.cell, &mut self.budget)?;
            let settled = self.layout.placed.len();
            let mut left = memory::copied(&self.left)?;
            for placed in &self.layout.placed[self.before..] {
                left[placed.item] -= 1;
            }
            if left.iter().any(|&left| left > 0) {
                let space = lattice.space(self.layout, &forms, None, &own)?;
                let plan = Plan::new(&left, &self.figures, k.into(), options.seed)?;
                let ground = Round { lattice, forms: &forms, figures: &self.figures, options, parallel };
                ground.run(self.layout, space, &plan, &mut self.budget)?;
            }
            let is_more = self.layout.placed.len() > settled;
            self.keep()?;
            if let Some(end) = self.end() {
                return Ok(end);
            }
            if !is_more {
                break;
            }
            if let Some(progress) = self.control.progress {
                progress((rounds + u64::from(k) + 1) as f64 / shares);
            }
        }
        Ok(SearchEnd::Rounds)
    }
}
