//! Placing solids in a container, with proof.
//!
//! A [`Layout`] holds a container, obstacles, items, and the placed copies of items. [`Layout::check`]
//! reports whether a placed copy fits. [`Layout::search`] places copies that are not placed yet. The solids
//! themselves prove all results of both: cells are split where a proof needs it, and nowhere else (Dai, Zha &
//! Ni 1994).
//!
//! | topic | file |
//! |---|---|
//! | the container, obstacles and items | `bay`, `item` |
//! | the allowed orientations | `orientation` |
//! | proofs that two solids are apart, or that one lies within the container | `proof` |
//! | the space around the container | `wall` |
//! | relative placements | `relative` |
//! | conflicts and the nearest neighbour | `check` |
//! | the search for places | `search/` |
//! | weight, and the filled part of the container | `measures` |

mod bay;
mod check;
mod item;
mod measures;
mod orientation;
mod proof;
mod random;
mod relative;
mod search;
mod wall;

pub use bay::Bay;
pub use check::{Beside, Neighbour, Standing};
pub use item::Item;
pub use measures::LayoutMeasures;
pub use orientation::Orientations;
pub use search::{Direction, Objective, SearchEnd, SearchOptions, SearchReport};

use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Affine, Bounds};
use crate::memory;
use alloc::vec::Vec;
use item::NO_MOTION;
use orientation::is_motion;
use proof::{Container, Near, Piece};

/// A placed copy of an item.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placed {
    /// The index of the item in the bay.
    pub item: usize,
    /// The placement.
    pub placement: Affine,
}

/// A container with obstacles, items, and the placed copies of items.
///
/// Solids are prepared once. Copies of the same item share the prepared data.
///
/// ```
/// use leafless::{Affine, AnySolid, Control, Csg};
/// use leafless::layout::{Bay, Item, Layout};
/// use leafless::query::GapVerdict;
/// let control = Control::default();
/// let mut bay = Bay::new(AnySolid::new(Csg::cuboid([0.0; 3], [50.0, 30.0, 30.0])?))?.with_clearances(1.0, 0.5)?;
/// let ball = bay.add_item(Item::new(AnySolid::new(Csg::ball([0.0; 3], 10.0)?))?.with_count(2))?;
/// let mut layout = Layout::new(&bay, &control)?;
/// let first = layout.place(ball, &Affine::translation([11.0, 15.0, 15.0])?)?;
/// let second = layout.place(ball, &Affine::translation([31.5, 15.0, 15.0])?)?;
/// let found = layout.check(second, &control)?;
/// assert_eq!(found.verdict, GapVerdict::No);
/// assert!(found.conflicts[0].gap.contains(0.5));
/// layout.move_to(second, &Affine::translation([32.5, 15.0, 15.0])?)?;
/// assert_eq!(layout.check(second, &control)?.verdict, GapVerdict::Yes);
/// # Ok::<(), leafless::Error>(())
/// ```
pub struct Layout {
    container: Container,
    obstacles: Vec<Piece>,
    items: Vec<Item>,
    pieces: Vec<Piece>,
    clearance: f64,
    placed: Vec<Placed>,
    /// The bounding boxes of the placed copies.
    boxes: Vec<Bounds>,
}

impl Layout {
    /// Builds a layout without placed copies. The cost is that of putting each solid on frames once.
    ///
    /// # Errors
    /// The solids' own errors; [`Error::OutOfMemory`] and [`Error::Cancelled`].
    pub fn new(bay: &Bay, control: &Control<'_>) -> Result<Layout, Error> {
        let longest = bay.items.iter().map(|item| proof::diagonal(&item.bounds)).fold(0.0, f64::max);
        // Boxes separate solids that are further away than this.
        let reach = 1.25 * longest + 2.0 * bay.clearance.max(bay.wall_clearance);
        let obstacles = bay.obstacles.iter().map(|(solid, _)| solid);
        let solids = [&bay.container].into_iter().chain(obstacles);
        let near = &Near::new(reach, solids.chain(bay.items.iter().map(|item| &item.solid)));
        let container = Container::new(&bay.container, bay.wall_clearance, near, control)?;
        let mut obstacles = memory::with_capacity(bay.obstacles.len())?;
        for (solid, bounds) in &bay.obstacles {
            obstacles.push(Piece::new(solid, bounds, near, control)?);
        }
        let mut pieces = memory::with_capacity(bay.items.len())?;
        let mut items = memory::with_capacity(bay.items.len())?;
        for item in &bay.items {
            pieces.push(Piece::new(&item.solid, &item.bounds, near, control)?);
            items.push(Item { orientations: item.orientations.try_clone()?, ..item.shallow() });
        }
        let clearance = bay.clearance;
        Ok(Layout { container, obstacles, items, pieces, clearance, placed: Vec::new(), boxes: Vec::new() })
    }

    /// A bounding box of the container.
    pub fn bounds(&self) -> &Bounds {
        self.container.bounds()
    }

    /// The items.
    pub fn items(&self) -> &[Item] {
        &self.items
    }

    /// The placed copies, in the order of their placement.
    pub fn placed(&self) -> &[Placed] {
        &self.placed
    }

    /// Places a copy of an item and returns the copy's number. The method does not check the place, and
    /// ignores the counts of items.
    ///
    /// # Errors
    /// [`Error::Argument`] if there is no such item, or if the placement mirrors or stretches by more than
    /// 10^-9; [`Error::OutOfMemory`].
    pub fn place(&mut self, item: usize, placement: &Affine) -> Result<usize, Error> {
        if item >= self.items.len() {
            return Err(Error::Argument { name: "item", problem: "must be the number of one of the items" });
        }
        let around = self.around(item, placement)?;
        memory::push(&mut self.boxes, around)?;
        if let Err(error) = memory::push(&mut self.placed, Placed { item, placement: *placement }) {
            self.boxes.pop();
            return Err(error);
        }
        Ok(self.placed.len() - 1)
    }

    /// Moves a placed copy to another place. The method does not check the place.
    ///
    /// # Errors
    /// [`Error::Argument`] if there is no copy with this number; the other errors as for
    /// [`place`](Self::place).
    pub fn move_to(&mut self, number: usize, placement: &Affine) -> Result<(), Error> {
        let Some(own) = self.placed.get(number) else { return Err(NOT_PLACED) };
        self.boxes[number] = self.around(own.item, placement)?;
        self.placed[number].placement = *placement;
        Ok(())
    }

    /// Removes a placed copy. The numbers of all copies that were placed later decrease by one.
    ///
    /// # Errors
    /// [`Error::Argument`] if there is no copy with this number.
    pub fn remove(&mut self, number: usize) -> Result<Placed, Error> {
        if number >= self.placed.len() {
            return Err(NOT_PLACED);
        }
        self.boxes.remove(number);
        Ok(self.placed.remove(number))
    }

    /// Returns a bounding box of an item under a placement.
    fn around(&self, item: usize, placement: &Affine) -> Result<Bounds, Error> {
        if !is_motion(placement) {
            return Err(NO_MOTION);
        }
        self.items[item].bounds.placed(placement).ok_or(NO_MOTION)
    }
}

/// The error for a number that no placed copy has.
const NOT_PLACED: Error =
    Error::Argument { name: "number", problem: "must be the number of something that is placed" };
