//! Values at points.

use super::view::ChannelRef;

impl ChannelRef<'_> {
    /// Returns the value at a point in model units; `None` where the channel has none, and outside its cube.
    /// A point on a face between cells belongs to the upper cell. O(depth), no allocation.
    ///
    /// A value has four places; those beyond the components are 0.
    pub fn value_at(&self, point: [f64; 3]) -> Option<[f64; 4]> {
        self.value_of_cell(self.frame().cell_of(point)?)
    }

    /// Returns the value of a finest cell of the channel's own frame. O(depth).
    pub fn value_of_cell(&self, at: [u32; 3]) -> Option<[f64; 4]> {
        if at.iter().any(|&a| a >= self.frame().cells()) {
            return None;
        }
        self.bits_at(at).map(|bits| self.value_type().decode(bits))
    }

    /// Computes the values at points, each as by [`value_at`](Self::value_at), up to the shorter length of
    /// both slices.
    pub fn values_at(&self, points: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) {
        for (value, &point) in values.iter_mut().zip(points) {
            *value = self.value_at(point);
        }
    }
}
