//! In-place set operations of tri-dexel models and solids.

use super::dexelize::{DexelOptions, dexelize};
use super::rule::Rule;
use crate::control::Control;
use crate::dexel::{DexelChange, DexelEditor, TriDexel, TriDexelRef};
use crate::error::Error;
use crate::solid::DynSolid;

/// The share of the work that dexelising takes.
const SHARE: f64 = 0.9;

impl DexelEditor {
    /// Adds a solid. If the solid provides a bounding box, only the rays that cross the box are visited. The
    /// solid's intervals are those of [`dexelize`] with [`Rule::Sampled`], and carry the data that the editor
    /// stores.
    ///
    /// # Errors
    /// The errors of [`dexelize`], before anything changes, and of [`unite`](Self::unite).
    pub fn unite_solid(&mut self, solid: &dyn DynSolid, control: &Control<'_>) -> Result<DexelChange, Error> {
        self.with_dexels_of(solid, control, Self::unite)
    }

    /// Subtracts a solid: one step of a tool. If the solid provides a bounding box, only the rays that cross
    /// the box are visited. The solid's intervals are those of [`dexelize`] with [`Rule::Sampled`], and carry
    /// the data that the editor stores.
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
    /// The errors of [`dexelize`], before anything changes, and of [`unite`](Self::unite).
    pub fn subtract_solid(
        &mut self,
        solid: &dyn DynSolid,
        control: &Control<'_>,
    ) -> Result<DexelChange, Error> {
        self.with_dexels_of(solid, control, Self::subtract)
    }

    /// Keeps only the points that also lie in a solid. O(rays of the lattice). The solid's intervals are
    /// those of [`dexelize`] with [`Rule::Sampled`], and carry the data that the editor stores.
    ///
    /// # Errors
    /// The errors of [`dexelize`], before anything changes, and of [`unite`](Self::unite).
    pub fn intersect_solid(
        &mut self,
        solid: &dyn DynSolid,
        control: &Control<'_>,
    ) -> Result<DexelChange, Error> {
        self.with_dexels_of(solid, control, Self::intersect)
    }

    /// Keeps the points that lie in exactly one of the model and a solid. The solid's intervals are those of
    /// [`dexelize`] with [`Rule::Sampled`], and carry the data that the editor stores.
    ///
    /// # Errors
    /// The errors of [`dexelize`], before anything changes, and of [`xor`](Self::xor).
    pub fn xor_solid(&mut self, solid: &dyn DynSolid, control: &Control<'_>) -> Result<DexelChange, Error> {
        self.with_dexels_of(solid, control, Self::xor)
    }

    /// Changes the editor by the tri-dexel model of a solid, made with matching directions and format.
    fn with_dexels_of(
        &mut self,
        solid: &dyn DynSolid,
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
