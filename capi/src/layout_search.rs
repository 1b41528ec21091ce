//! Layouts: searching placements for the remaining copies, and measuring the layout.

use super::boundary::{Failure, Sized32, filled, guard, output, sized};
use super::control::{controlled, leafless_options};
use super::frame::leafless_interval;
use super::measure::row_by_row;
use super::number::{Number, enumeration};
use super::placing::{change, leafless_layout, read};
use super::status::leafless_status;
use leafless::Interval;
use leafless::layout::{Direction, LayoutMeasures, Objective, SearchEnd, SearchOptions, SearchReport};

/// The objective of a search. The first aim is always to place as much as possible.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_objective {
    /// As many copies as possible.
    LEAFLESS_OBJECTIVE_COUNT = 0,
    /// As many copies as possible, as low as possible along z.
    LEAFLESS_OBJECTIVE_HEIGHT = 1,
    /// As much volume as possible.
    LEAFLESS_OBJECTIVE_DENSITY = 2,
    /// As many copies as possible, with their common centre of gravity near to `target_model`.
    LEAFLESS_OBJECTIVE_BALANCE = 3,
}
use leafless_objective::*;

enumeration!(leafless_objective => leafless_objective {
    LEAFLESS_OBJECTIVE_COUNT => LEAFLESS_OBJECTIVE_COUNT,
    LEAFLESS_OBJECTIVE_HEIGHT => LEAFLESS_OBJECTIVE_HEIGHT,
    LEAFLESS_OBJECTIVE_DENSITY => LEAFLESS_OBJECTIVE_DENSITY,
    LEAFLESS_OBJECTIVE_BALANCE => LEAFLESS_OBJECTIVE_BALANCE,
});

/// A direction along which all copies can be taken out.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_free_along {
    /// No direction is required.
    LEAFLESS_FREE_ALONG_NONE = 0,
    /// Along x, to greater coordinates.
    LEAFLESS_FREE_ALONG_X_UP = 1,
    /// Along x, to lesser coordinates.
    LEAFLESS_FREE_ALONG_X_DOWN = 2,
    /// Along y, to greater coordinates.
    LEAFLESS_FREE_ALONG_Y_UP = 3,
    /// Along y, to lesser coordinates.
    LEAFLESS_FREE_ALONG_Y_DOWN = 4,
    /// Along z, to greater coordinates.
    LEAFLESS_FREE_ALONG_Z_UP = 5,
    /// Along z, to lesser coordinates.
    LEAFLESS_FREE_ALONG_Z_DOWN = 6,
}

enumeration!(leafless_free_along => Option<Direction> {
    LEAFLESS_FREE_ALONG_NONE => None,
    LEAFLESS_FREE_ALONG_X_UP => Some(Direction { axis: 0, upward: true }),
    LEAFLESS_FREE_ALONG_X_DOWN => Some(Direction { axis: 0, upward: false }),
    LEAFLESS_FREE_ALONG_Y_UP => Some(Direction { axis: 1, upward: true }),
    LEAFLESS_FREE_ALONG_Y_DOWN => Some(Direction { axis: 1, upward: false }),
    LEAFLESS_FREE_ALONG_Z_UP => Some(Direction { axis: 2, upward: true }),
    LEAFLESS_FREE_ALONG_Z_DOWN => Some(Direction { axis: 2, upward: false }),
});

/// Options of a search.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_search_options {
    /// sizeof(leafless_search_options).
    pub struct_size: u32,
    /// A leafless_objective: the objective of the search.
    pub objective: Number<leafless_objective>,
    /// For LEAFLESS_OBJECTIVE_BALANCE: the target of the centre of gravity, in model units.
    pub target_model: [f64; 3],
    /// Seed of the random choices: the same seed gives the same layout, for any number of threads.
    pub seed: u64,
    /// Largest number of placements that are tested with the solids themselves; 0 means no limit.
    pub max_tests: u64,
    /// Number of rounds. Each round places everything anew in another order, and the best round is kept; 0
    /// means 4.
    pub rounds: u32,
    /// Cells along the longest side of the container, 4 to 512; 0 means as many as the items need.
    pub cells: u32,
    /// A leafless_free_along: the direction in which all copies can be taken out, one after another, the copy
    /// that was placed last first. No other copy and no obstacle blocks a straight move; the container may.
    pub free_along: Number<leafless_free_along>,
    /// Reserved; 0.
    pub reserved: u32,
}

// SAFETY: numbers.
unsafe impl Sized32 for leafless_search_options {}

impl leafless_search_options {
    fn known(&self) -> Result<SearchOptions, Failure> {
        let refuse = |name, problem| Err(Failure::Argument { name, problem });
        if self.reserved != 0 {
            return refuse("search.reserved", "must be 0");
        }
        let objective = match self.objective.known("search.objective")? {
            LEAFLESS_OBJECTIVE_COUNT => Objective::Count,
            LEAFLESS_OBJECTIVE_HEIGHT => Objective::Height,
            LEAFLESS_OBJECTIVE_DENSITY => Objective::Density,
            LEAFLESS_OBJECTIVE_BALANCE => Objective::Balance(self.target_model),
        };
        let is_balance = matches!(objective, Objective::Balance(_));
        if !self.target_model.iter().all(|c| if is_balance { c.is_finite() } else { *c == 0.0 }) {
            let problem = match is_balance {
                true => "must be three finite numbers",
                false => "is for LEAFLESS_OBJECTIVE_BALANCE only",
            };
            return refuse("search.target_model", problem);
        }
        let default = SearchOptions::default();
        Ok(SearchOptions {
            objective,
            seed: self.seed,
            rounds: if self.rounds == 0 { default.rounds } else { self.rounds },
            cells: self.cells,
            max_tests: (self.max_tests != 0).then_some(self.max_tests),
            free_along: self.free_along.known("search.free_along")?,
        })
    }
}

/// The reason why a search ended.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_search_end {
    /// Everything is placed, and the objective needs no more rounds.
    LEAFLESS_SEARCH_END_COMPLETE = 0,
    /// All rounds were made.
    LEAFLESS_SEARCH_END_ROUNDS = 1,
    /// `max_tests` of the search, or `max_splits` of the options, is spent.
    LEAFLESS_SEARCH_END_BUDGET = 2,
    /// The search was cancelled. The best layout found is placed.
    LEAFLESS_SEARCH_END_CANCELLED = 3,
}

impl From<SearchEnd> for leafless_search_end {
    fn from(end: SearchEnd) -> leafless_search_end {
        match end {
            SearchEnd::Complete => leafless_search_end::LEAFLESS_SEARCH_END_COMPLETE,
            SearchEnd::Rounds => leafless_search_end::LEAFLESS_SEARCH_END_ROUNDS,
            SearchEnd::Budget => leafless_search_end::LEAFLESS_SEARCH_END_BUDGET,
            SearchEnd::Cancelled => leafless_search_end::LEAFLESS_SEARCH_END_CANCELLED,
        }
    }
}

/// A report of a search.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_search_report {
    /// sizeof(leafless_search_report).
    pub struct_size: u32,
    /// The reason why the search ended.
    pub end: leafless_search_end,
    /// Copies that the search placed.
    pub placed: u64,
    /// Copies that are still to be placed.
    pub left: u64,
    /// Completed rounds, without the rounds that use only boxes.
    pub rounds: u64,
    /// Placements that were tested with the solids themselves.
    pub tests: u64,
    /// Cells that were split for these tests. (Cells of items and of the container that are used to find
    /// placements are not counted.)
    pub splits: u64,
}

output!(leafless_search_report);

impl From<SearchReport> for leafless_search_report {
    fn from(report: SearchReport) -> leafless_search_report {
        leafless_search_report {
            struct_size: size_of::<leafless_search_report>() as u32,
            end: report.end.into(),
            placed: report.placed,
            left: report.left,
            rounds: report.rounds,
            tests: report.tests,
            splits: report.splits,
        }
    }
}

/// Measures of all copies together. All intervals contain the truth. Overlaps count twice.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_layout_measures {
    /// sizeof(leafless_layout_measures).
    pub struct_size: u32,
    /// The volume of all copies.
    pub volume_model: leafless_interval,
    /// That volume as a fraction of the container's volume.
    pub filled_part: leafless_interval,
    /// Height of the highest point above the lower end of the container's bounds along z, in model units; 0
    /// if nothing is placed.
    pub height_model: leafless_interval,
    /// The mass, from the densities of the items.
    pub mass: leafless_interval,
    /// The centre of gravity; intervals of all numbers unless `has_centroid`.
    pub centroid_model: [leafless_interval; 3],
    /// Tensor of inertia about the model's origin, row by row, as in leafless_measures, times the densities.
    pub inertia_origin_model: [leafless_interval; 9],
    /// The same about the centre of gravity; about the origin unless `has_centroid`.
    pub inertia_centroid_model: [leafless_interval; 9],
    /// Whether a copy is placed, and every placed item is proven not to be empty.
    pub has_centroid: bool,
}

output!(leafless_layout_measures);

impl From<LayoutMeasures> for leafless_layout_measures {
    fn from(measures: LayoutMeasures) -> leafless_layout_measures {
        leafless_layout_measures {
            struct_size: size_of::<leafless_layout_measures>() as u32,
            volume_model: measures.volume.into(),
            filled_part: measures.filled_part.into(),
            height_model: measures.height.into(),
            mass: measures.mass.into(),
            centroid_model: measures.centroid.unwrap_or([Interval::ALL; 3]).map(Into::into),
            inertia_origin_model: row_by_row(measures.inertia_about_origin),
            inertia_centroid_model: row_by_row(measures.inertia_about_centroid),
            has_centroid: measures.centroid.is_some(),
        }
    }
}

/// Places the copies that are still missing from the counts of the items. Copies that are placed already do
/// not move.
///
/// Each copy is proven to lie in the container, to overlap nothing, and to keep all clearances: by boxes, by
/// the triangles of meshes, or by splits of the solids. A copy without this proof is not placed. The best
/// layout of all rounds by the objective is kept. If the search is cancelled, or a limit is spent, it keeps
/// the best layout found; neither is an error.
///
/// Memory is that of the items' cells in all orientations, and of the container's cells: some megabytes. A
/// step takes O(r n² / 64) for each layer of cells that is examined, with n the cells along the container and
/// r the runs of cells of an item.
///
/// - Buffers: `search`, one struct or NULL; `options`, one struct or NULL; `report`, one struct.
/// - Result: the layout is changed; `*report`.
/// - Errors: LEAFLESS_E_ARGUMENT if `cells` is neither 0 nor between 4 and 512, if a field is not a member of
///   its enumeration, or if `target_model` is not finite, or is set though it is not used; LEAFLESS_E_FRAME
///   if a solid belongs to another frame; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_NO_MEMORY;
///   LEAFLESS_E_BUSY. After an error the layout is unchanged.
/// - Threads: any; runs on as many threads as `options` says; LEAFLESS_E_BUSY while another call uses the
///   layout.
/// - Untrusted input: any numbers; set `max_tests` and `max_splits` if the solids are untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layout_search(
    layout: *mut leafless_layout,
    search: *const leafless_search_options,
    options: *const leafless_options,
    report: *mut leafless_search_report,
) -> leafless_status {
    guard(|| unsafe {
        let mut layout = change(layout)?;
        let search = sized(search, "search")?.known()?;
        let report = filled(report, "report")?;
        report.write(controlled(options, |control| layout.search(&search, control))?.into())
    })
}

/// Measures all copies together. The container and each placed item are measured once, as by
/// leafless_solid_measure, and the copies are added. `relative` bounds the width of each volume's interval as
/// a fraction of the volume.
///
/// - Buffers: `options`, one struct or NULL; `measures`, one struct.
/// - Result: `*measures`.
/// - Errors: LEAFLESS_E_ARGUMENT if `relative` is negative or not a number; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_BUSY.
/// - Threads: any; runs on as many threads as `options` says; LEAFLESS_E_BUSY while another call changes the
///   layout.
/// - Untrusted input: any number; the default of `max_splits`, that of leafless_solid_measure, bounds the
///   work.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layout_measure(
    layout: *const leafless_layout,
    relative: f64,
    options: *const leafless_options,
    measures: *mut leafless_layout_measures,
) -> leafless_status {
    guard(|| unsafe {
        let layout = read(layout)?;
        let measures = filled(measures, "measures")?;
        measures.write(controlled(options, |control| layout.measures(relative, control))?.into())
    })
}
