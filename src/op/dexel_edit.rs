//! Solids that are joined to tri-dexel models in place.

use super::dexelize::{DexelOptions, dexelize};
use super::rule::Rule;
use crate::control::Control;
use crate::dexel::{DexelEditor, TriDexel};
use crate::error::Error;
use crate::solid::Solid;

/// The share of the work that dexelisation takes.
const SHARE: f64 = 0.9;

impl DexelEditor {
    /// Adds a solid. Only rays that cross the solid's bounding box are looked at, as far as the solid tells one.
    /// Its intervals are those of [`dexelize`] with [`Rule::Sampled`], and carry what the editor stores.
    ///
    /// # Errors
    /// As [`dexelize`], before anything changes, and as [`unite`](Self::unite).
    pub fn unite_solid<S: Solid>(&mut self, solid: &S, control: &Control<'_>) -> Result<(), Error> {
        let model = control.share([0.0, SHARE], |control| self.dexels_of(solid, control))?;
        control.share([SHARE, 1.0], |control| self.unite(model.view(), control))
    }

    /// Takes a solid away: one step of a tool. Only rays that cross the solid's bounding box are looked at, as far as the
    /// solid tells one. Its intervals are those of [`dexelize`] with [`Rule::Sampled`], and carry what the editor stores.
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, dexelize, dexel::DexelEditor, op::DexelOptions};
    /// let (frame, control) = (Frame::new([0.0; 3], 64.0, 6)?, Control::default());
    /// let block = dexelize(&Csg::cuboid([2.0; 3], [62.0; 3])?, &frame, &DexelOptions::default(), &control)?;
    /// let mut part = DexelEditor::new(block.view())?;
    /// for x in [10.0, 20.0, 30.0] {
    ///     part.subtract_solid(&Csg::ball([x, 32.0, 62.0], 4.0)?, &control)?;
    /// }
    /// assert!(!part.freeze(&control)?.view().contains_cell([20, 32, 60]));
    /// # Ok::<(), leafless::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`dexelize`], before anything changes, and as [`unite`](Self::unite).
    pub fn subtract_solid<S: Solid>(&mut self, solid: &S, control: &Control<'_>) -> Result<(), Error> {
        let model = control.share([0.0, SHARE], |control| self.dexels_of(solid, control))?;
        control.share([SHARE, 1.0], |control| self.subtract(model.view(), control))
    }

    /// Keeps only the points that lie in a solid, too. O(rays of the lattice). The solid's intervals are those of [`dexelize`] with
    /// [`Rule::Sampled`], and carry what the editor stores.
    ///
    /// # Errors
    /// As [`dexelize`], before anything changes, and as [`unite`](Self::unite).
    pub fn intersect_solid<S: Solid>(&mut self, solid: &S, control: &Control<'_>) -> Result<(), Error> {
        let model = control.share([0.0, SHARE], |control| self.dexels_of(solid, control))?;
        control.share([SHARE, 1.0], |control| self.intersect(model.view(), control))
    }

    /// The tri-dexel model of a solid that fits the editor.
    fn dexels_of<S: Solid>(&self, solid: &S, control: &Control<'_>) -> Result<TriDexel, Error> {
        let options =
            DexelOptions { directions: self.directions(), format: self.format(), rule: Rule::Sampled };
        dexelize(solid, self.frame(), &options, control)
    }
}
