//! The search for places of items.
//!
//! Boxes come first: where boxes alone prove a place, no split is needed. Then items are placed as cells; all
//! cells that are not proven empty count. All places of a layer where a shape meets no taken cell are found
//! together. The solids themselves prove each place. Finally the items settle, and the search fills the space
//! that becomes free.
//!
//! | topic | file |
//! |---|---|
//! | order of the items, and preferred places | `plan` |
//! | places for boxes | `rooms`, in the free boxes of `boxes` |
//! | cells of an item in each orientation | `voxels`, `forms`, rows of `bits` |
//! | cells taken before anything is placed | `ground` |
//! | places for a shape | `space`, one item after another in `round` |
//! | moving items down | `settle` |
//! | sequence of the steps, and choice of the best layout | `run`, `tally` |
//! | remaining budget | `budget` |
//! | is anything left to spend? | `budget` |

mod bits;
mod boxes;
mod budget;
mod forms;
mod ground;
mod plan;
mod rooms;
mod round;
mod run;
mod settle;
mod space;
mod tally;
mod voxels;

use super::Layout;
use crate::control::Control;
use crate::error::Error;

/// The objective of a search. The first aim is always to place as much as possible.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Objective {
    /// As many items as possible.
    Count,
    /// As many items as possible, as low as possible along z.
    Height,
    /// As much volume as possible.
    Density,
    /// As many items as possible, with the centre of gravity of all placed copies near to a point (model
    /// units).
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
    /// The opposite direction.
    fn back(self) -> (usize, bool) {
        (usize::from(self.axis), !self.upward)
    }
}

/// The options of a search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchOptions {
    /// The objective.
    pub objective: Objective,
    /// The seed of the random choices: the same seed gives the same layout, for any number of threads.
    pub seed: u64,
    /// The number of rounds, at least 1. Each round places everything anew, in another order; the best layout
    /// is kept.
    pub rounds: u32,
    /// The number of cells along the longest side of the container; 0: chosen by the sizes of the items.
    pub cells: u32,
    /// The maximal number of places tested by the solids themselves; `None`: no limit.
    pub max_tests: Option<u64>,
    /// If set, all items can be taken out along this direction, one after another, the last placed first: no
    /// other item, and no obstacle, is in the way of a straight move. (The container may be.)
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

/// The reason why a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SearchEnd {
    /// Everything is placed, and the objective requires nothing else.
    Complete,
    /// All rounds were made.
    Rounds,
    /// `max_tests` of the options, or `max_splits` of the control, is spent.
    Budget,
    /// The caller cancelled. The best layout found until then is kept.
    Cancelled,
}

/// The report of a search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchReport {
    /// Number of copies placed.
    pub placed: u64,
    /// Number of copies not placed.
    pub left: u64,
    /// Number of rounds, without the rounds by boxes.
    pub rounds: u64,
    /// Number of places tested by the solids themselves.
    pub tests: u64,
    /// Number of cell splits for these tests. (The count excludes the cells of items and of the container
    /// that the search itself uses.)
    pub splits: u64,
    /// Why the search ended.
    pub end: SearchEnd,
}

impl Layout {
    /// Places copies of items that are not placed yet. Placed copies stay where they are.
    ///
    /// Each new copy is proven to lie in the container, to overlap with nothing, and to keep the required
    /// distance from everything: by boxes, by the triangles of meshes, or by splits of the solids. A copy
    /// without a proof is not placed. The result is the best layout of all rounds by the objective. A cancel
    /// ends the search and keeps the best layout found until then; so does a budget.
    ///
    /// Memory holds the items' cells in all orientations, and the container's cells: some megabytes for a
    /// hundred cells along the container, a hundred times as much for five hundred. `control.max_bytes`
    /// limits the memory for the items. A step takes O(r n² / 64) for n cells along the container, an item
    /// with r runs of cells, and each visited layer. There are n layers for each form and round, and one more
    /// for each step.
    ///
    /// # Errors
    /// [`Error::Argument`] if `rounds` is 0, `cells` is not 0 and not between 4 and 512, an axis is not 0, 1
    /// or 2, or a coordinate is not a number; [`Error::TooLarge`] and [`Error::Limit`] if the cells of items
    /// take more than `control.max_bytes`; the solids' own errors; [`Error::OutOfMemory`]. In each case the
    /// layout stays unchanged.
    pub fn search(&mut self, options: &SearchOptions, control: &Control<'_>) -> Result<SearchReport, Error> {
        let refuse = |name, problem| Err(Error::Argument { name, problem });
        if options.rounds == 0 {
            return refuse("rounds", "must be at least 1");
        }
        if options.cells != 0 && !(4..=512).contains(&options.cells) {
            return refuse("cells", "must be 0, or between 4 and 512");
        }
        if let Objective::Balance(target) = options.objective
            && !target.iter().all(|c| c.is_finite())
        {
            return refuse("objective", "must be a point of finite coordinates");
        }
        if options.free_along.is_some_and(|way| way.axis > 2) {
            return refuse("axis", "must be 0, 1 or 2");
        }
        let before = self.placed.len();
        let found = control.run(true, |parallel| run::search(self, options, parallel, control));
        if found.is_err() {
            self.placed.truncate(before);
            self.boxes.truncate(before);
        }
        found
    }
}
