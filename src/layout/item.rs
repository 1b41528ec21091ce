//! The items of a layout.

use super::orientation::{Orientations, is_motion};
use crate::error::Error;
use crate::lattice::{Affine, Bounds};
use crate::solid::{AnySolid, Solid, Transform};

/// A solid to place, once or several times.
#[derive(Clone)]
pub struct Item {
    pub(super) solid: AnySolid,
    pub(super) bounds: Bounds,
    pub(super) count: u32,
    pub(super) orientations: Orientations,
    pub(super) density: f64,
}

impl Item {
    /// Builds an item: one copy of a solid of density 1, which may be turned by the 24 rotations that map
    /// axes to axes.
    ///
    /// # Errors
    /// [`Error::Argument`] if the solid has no [bounds](Solid::bounds), or the bounds have no extent along an
    /// axis.
    pub fn new(solid: AnySolid) -> Result<Item, Error> {
        let bounds = bounds_of(&solid, "item")?;
        Ok(Item { solid, bounds, count: 1, orientations: Orientations::Turns, density: 1.0 })
    }

    /// Sets the number of copies.
    #[must_use]
    pub fn with_count(self, count: u32) -> Item {
        Item { count, ..self }
    }

    /// Sets the allowed orientations.
    ///
    /// # Errors
    /// [`Error::Argument`] if a map of a list is not a rotation (it mirrors, or stretches by more than
    /// 10^-9), or if there is no orientation, or more than [`Orientations::MOST`].
    pub fn with_orientations(self, orientations: Orientations) -> Result<Item, Error> {
        let count = match &orientations {
            Orientations::AsGiven | Orientations::Turns => 1,
            Orientations::Free(count) => *count as usize,
            Orientations::List(list) => list.len(),
        };
        if !(1..=Orientations::MOST as usize).contains(&count) {
            return Err(Error::Argument {
                name: "orientations",
                problem: "must be 1 at least and 4096 at the most",
            });
        }
        if let Orientations::List(list) = &orientations
            && !list.iter().all(is_motion)
        {
            return Err(NO_MOTION);
        }
        Ok(Item { orientations, ..self })
    }

    /// Sets the mass per volume, for the centre of gravity and the inertia of the whole layout.
    ///
    /// # Errors
    /// [`Error::Argument`] if the density is not a positive number.
    pub fn with_density(self, density: f64) -> Result<Item, Error> {
        if !(density > 0.0 && density < f64::INFINITY) {
            return Err(Error::Argument { name: "density", problem: "must be a positive number" });
        }
        Ok(Item { density, ..self })
    }

    /// Copies the item without the parts that need an allocation.
    pub(super) fn shallow(&self) -> Item {
        Item { solid: self.solid.clone(), orientations: Orientations::AsGiven, ..*self }
    }

    /// The solid.
    pub fn solid(&self) -> &AnySolid {
        &self.solid
    }

    /// The number of copies.
    pub fn count(&self) -> u32 {
        self.count
    }
}

/// The error for a map that is not a motion.
pub(super) const NO_MOTION: Error = Error::Argument {
    name: "placement",
    problem: "must turn and move, and neither mirror nor stretch by more than a billionth",
};

/// Returns the bounding box of a solid.
pub(super) fn bounds_of(solid: &AnySolid, name: &'static str) -> Result<Bounds, Error> {
    let of_home = || solid.home().as_ref().map(Bounds::of);
    let Some(bounds) = solid.bounds().or_else(of_home) else {
        return Err(Error::Argument {
            name,
            problem: "must have bounds: an unbounded solid cannot be laid out",
        });
    };
    if (0..3).any(|k| bounds.max[k] <= bounds.min[k]) {
        return Err(Error::Argument { name, problem: "must have an extent along every axis" });
    }
    Ok(bounds)
}

/// Returns a solid that can be queried on any frame. A stored octree can only be queried on its own frame.
pub(super) fn on_any_frame(solid: &AnySolid) -> AnySolid {
    match solid.home() {
        Some(_) => AnySolid::new(Transform::of(solid.clone(), &Affine::IDENTITY)),
        None => solid.clone(),
    }
}
