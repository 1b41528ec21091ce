//! Placing what is not placed yet.
//!
//! Items go first as boxes, where boxes alone tell: that takes no split. Then they go as cells, of which all
//! count that are not proven empty; the places of a layer at which a shape meets nothing that is taken are
//! found together. Each place that is taken is proven by the solids themselves. At last items settle, and
//! what goes into the room that comes of it is added.
//!
//! | question | file |
//! |---|---|
//! | in which order, and which place is preferred? | `plan` |
//! | where do boxes go? | `rooms`, in the free boxes of `boxes` |
//! | which cells has an item, in each orientation? | `voxels`, `forms`, rows of `bits` |
//! | which cells are taken before anything is placed? | `ground` |
//! | where does a shape go? | `space`, one item after another in `round` |
//! | can it move down yet? | `settle` |
//! | what comes after what, and which layout is the best? | `run`, `tally` |
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

/// What a search is after. First of all as much is placed as goes in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Objective {
    /// As many items as possible.
    Count,
    /// As many items as possible, as low as possible along z.
    Height,
    /// As much volume as possible.
    Density,
    /// As many items as possible, with the centre of gravity of all that are placed near to a point (model
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
    /// All items can be taken out along this direction, one after another, the last that was placed first:
    /// none of the others, and no obstacle, is in the way of a straight move. (The container may be.)
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
    /// Cells that were split for that. (Cells of items and of the container that were made to search by are
    /// not counted.)
    pub splits: u64,
    /// Why it ended.
    pub end: SearchEnd,
}

impl Layout {
    /// Places copies of items that are not placed yet, and leaves those where they are that are.
    ///
    /// Each is proven to lie in the container, to overlap with nothing, and to be as far from everything as
    /// it should be: by boxes, by the triangles of meshes, or by splits of the solids. What could not be
    /// proven is not placed. The layout that is kept is the best of all rounds by what the options are after.
    /// A cancel ends the search, and keeps what was best by then; so does a budget.
    ///
    /// Memory is that of the items' cells in all orientations, and of the container's cells: some megabytes
    /// for a hundred cells along the container, a hundred times as much for five hundred. `control.max_bytes`
    /// limits that of the items. A step takes O(r n² / 64) for n cells along the container, an item of r runs
    /// of cells, and each layer that is looked at, which are n a form and round and one more a step.
    ///
    /// # Errors
    /// [`Error::Argument`] if `rounds` is 0, `cells` is not 0 and not between 4 and 512, an axis is not 0, 1
    /// or 2, or a coordinate is not a number; [`Error::TooLarge`] and [`Error::Limit`] if the cells of items
    /// take more than `control.max_bytes`; what the solids refuse; [`Error::OutOfMemory`]. Then the layout is
    /// as it was.
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
