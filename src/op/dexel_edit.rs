//! Solids that are joined to tri-dexel models in place.

use super::dexelize::{DexelOptions, dexelize};
use super::rule::Rule;
use crate::control::Control;
use crate::dexel::{DexelChange, DexelEditor, TriDexel, TriDexelRef};
use crate::error::Error;
use crate::solid::Solid;

/// The share of the work that dexelisation takes.
const SHARE: f64 = 0.9;

impl DexelEditor {
    /// Adds a solid. Only rays that cross the solid's bounding box are looked at, as far as the solid tells
    /// one. Its intervals are those of [`dexelize`] with [`Rule::Sampled`], and carry what the editor stores.
    ///
    /// # Errors
    /// As [`dexelize`], before anything changes, and as [`unite`](Self::unite).
    pub fn unite_solid<S: Solid>(&mut self, solid: &S, control: &Control<'_>) -> Result<DexelChange, Error> {
        self.with_dexels_of(solid, control, Self::unite)
    }

    /// Takes a solid away: one step of a tool. Only rays that cross the solid's bounding box are looked at,
    /// as far as the solid tells one. Its intervals are those of [`dexelize`] with [`Rule::Sampled`], and
    /// carry what the editor stores.
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, dexelize, dexel::DexelEditor, op::DexelOptions};
    /// let (frame, control) = (Frame::new([0.0; 3], 64.0, 6)?, Control::default());
    /// let block = dexelize(&Csg::cuboid([2.0; 3], [62.0; 3])?, &frame, &DexelOptions::default(), &control)?;
    /// let mut part = DexelEditor::new(block.view())?;
    /// for x in [10.0, 20.0, 30.0] {
    ///     let change = part.subtract_solid(&Csg::ball([x, 32.0, 62.0], 4.0)?, &control)?;
    ///     assert!(change.removed[2] > 0.0 && change.added[2] == 0.0);
    /// }
    /// assert!(!part.freeze(&control)?.view().contains_cell([20, 32, 60]));
    /// # Ok::<(), leafless::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`dexelize`], before anything changes, and as [`unite`](Self::unite).
    pub fn subtract_solid<S: Solid>(
        &mut self,
        solid: &S,
        control: &Control<'_>,
    ) -> Result<DexelChange, Error> {
        self.with_dexels_of(solid, control, Self::subtract)
    }

    /// Keeps only the points that lie in a solid, too. O(rays of the lattice). The solid's intervals are
    /// those of [`dexelize`] with [`Rule::Sampled`], and carry what the editor stores.
    ///
    /// # Errors
    /// As [`dexelize`], before anything changes, and as [`unite`](Self::unite).
    pub fn intersect_solid<S: Solid>(
        &mut self,
        solid: &S,
        control: &Control<'_>,
    ) -> Result<DexelChange, Error> {
        self.with_dexels_of(solid, control, Self::intersect)
    }

    /// Takes away what lies in both, and adds the rest of a solid. Its intervals are those of [`dexelize`]
    /// with [`Rule::Sampled`], and carry what the editor stores.
    ///
    /// # Errors
    /// As [`dexelize`], before anything changes, and as [`xor`](Self::xor).
    pub fn xor_solid<S: Solid>(&mut self, solid: &S, control: &Control<'_>) -> Result<DexelChange, Error> {
        self.with_dexels_of(solid, control, Self::xor)
    }

    /// Changes the editor by the tri-dexel model of a solid that fits it.
    fn with_dexels_of<S: Solid>(
        &mut self,
        solid: &S,
        control: &Control<'_>,
        change: fn(&mut Self, &TriDexelRef<'_>, &Control<'_>) -> Result<DexelChange, Error>,
    ) -> Result<DexelChange, Error> {
        let options =
            DexelOptions { directions: self.directions(), format: self.format(), rule: Rule::Sampled };
        let frame = *self.frame();
        let model: TriDexel =
            control.share([0.0, SHARE], |control| dexelize(solid, &frame, &options, control))?;
        control.share([SHARE, 1.0], |control| change(self, model.view(), control))
    }
}
