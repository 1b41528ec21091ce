//! The input of a layout: a container, obstacles and items.

use super::item::{Item, bounds_of};
use crate::error::Error;
use crate::lattice::Bounds;
use crate::memory;
use crate::solid::AnySolid;
use alloc::vec::Vec;

/// A container with obstacles and items, from which [`Layout::new`](super::Layout::new) builds a layout.
pub struct Bay {
    pub(super) container: AnySolid,
    /// Each obstacle with its bounding box.
    pub(super) obstacles: Vec<(AnySolid, Bounds)>,
    pub(super) items: Vec<Item>,
    pub(super) clearance: f64,
    pub(super) wall_clearance: f64,
}

impl Bay {
    /// The greatest allowed clearance (model units).
    pub const FURTHEST: f64 = (1u128 << 64) as f64;

    /// Builds a bay without obstacles and items. Its clearances are 0.
    ///
    /// # Errors
    /// [`Error::Argument`] if the container has no [bounds](crate::solid::Solid::bounds), or the bounds have
    /// no extent along an axis.
    pub fn new(container: AnySolid) -> Result<Bay, Error> {
        bounds_of(&container, "container")?;
        Ok(Bay { container, obstacles: Vec::new(), items: Vec::new(), clearance: 0.0, wall_clearance: 0.0 })
    }

    /// Sets two least distances (model units, 0 to 2^64): `clearance` between two items or an item and an
    /// obstacle, and `wall_clearance` between an item and the outside of the container.
    ///
    /// # Errors
    /// [`Error::Argument`] if a distance is not in this range.
    pub fn with_clearances(self, clearance: f64, wall_clearance: f64) -> Result<Bay, Error> {
        for (name, distance) in [("clearance", clearance), ("wall clearance", wall_clearance)] {
            if !(0.0..=Bay::FURTHEST).contains(&distance) {
                return Err(Error::Argument { name, problem: "must be between 0 and 2^64" });
            }
        }
        Ok(Bay { clearance, wall_clearance, ..self })
    }

    /// Adds a fixed solid and returns its number. Obstacles are counted from 0.
    ///
    /// # Errors
    /// [`Error::Argument`] if the solid has no [bounds](crate::solid::Solid::bounds), or the bounds have no
    /// extent along an axis; [`Error::OutOfMemory`].
    pub fn add_obstacle(&mut self, solid: AnySolid) -> Result<usize, Error> {
        let bounds = bounds_of(&solid, "obstacle")?;
        memory::push(&mut self.obstacles, (solid, bounds))?;
        Ok(self.obstacles.len() - 1)
    }

    /// Adds an item to place and returns its number. Items are counted from 0.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn add_item(&mut self, item: Item) -> Result<usize, Error> {
        memory::push(&mut self.items, item)?;
        Ok(self.items.len() - 1)
    }
}
