//! Distances in single precision, rounded outward.

use crate::lattice::Frame;
use crate::lattice::exact::{product_down, product_up, sqrt};

/// The conversion of squares of distances in half cells to model units.
pub(super) struct Scale {
    half: f64,
}

impl Scale {
    pub(super) fn new(frame: &Frame) -> Scale {
        Scale { half: 0.5 * frame.cell_size() }
    }

    /// Returns the largest single not above the root; `None` is the square of ∞.
    #[inline(always)]
    pub(super) fn down(&self, square: Option<u64>) -> f32 {
        let Some(square) = square else { return f32::INFINITY };
        let distance = sqrt(square as f64) * self.half;
        let near = distance as f32;
        match self.beside(near, distance) {
            Some(true) => near,
            Some(false) => near.next_down(),
            None => self.exactly(square, false),
        }
    }

    /// Returns the smallest single not below the root.
    #[inline(always)]
    pub(super) fn up(&self, square: Option<u64>) -> f32 {
        let Some(square) = square else { return f32::INFINITY };
        let distance = sqrt(square as f64) * self.half;
        let near = distance as f32;
        match self.beside(near, distance) {
            Some(true) => near.next_up(),
            Some(false) => near,
            None => self.exactly(square, true),
        }
    }

    /// Returns whether `near` lies below the exact number approximated by `distance`; `None` if rounding
    /// errors decide.
    #[inline(always)]
    fn beside(&self, near: f32, distance: f64) -> Option<bool> {
        /// Twice the maximal error of a root and a product.
        const ERROR: f64 = 4.0 * f64::EPSILON;
        let near = f64::from(near);
        if near < distance * (1.0 - ERROR) {
            Some(true)
        } else if near > distance * (1.0 + ERROR) {
            Some(false)
        } else {
            None
        }
    }

    #[cold]
    fn exactly(&self, square: u64, up: bool) -> f32 {
        // Squares of distances are below 2^45, so that integer roots are exact.
        let root = sqrt(square as f64);
        let is_exact = root * root == square as f64;
        let (lower, upper) = if is_exact { (root, root) } else { (root.next_down(), root.next_up()) };
        if up {
            let bound = product_up(upper, self.half);
            let near = bound as f32;
            if f64::from(near) < bound { near.next_up() } else { near }
        } else {
            let bound = product_down(lower, self.half);
            let near = bound as f32;
            if f64::from(near) > bound { near.next_down() } else { near }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_of_the_root() {
        for (edge, depth) in [(1.0, 1), (0.7, 5), (1e30, 12), (1e60, 3), (1e-60, 20)] {
            let frame = Frame::new([0.0; 3], edge, depth).unwrap();
            let scale = Scale::new(&frame);
            for square in (0..5000).chain([(1 << 40) - 1, 1 << 40, (1 << 40) + 1]) {
                let (down, up) = (scale.down(Some(square)), scale.up(Some(square)));
                let truth = libm::sqrt(square as f64) * 0.5 * frame.cell_size();
                assert!(f64::from(down) <= truth * (1.0 + 1e-15) && f64::from(up) >= truth * (1.0 - 1e-15));
                assert!(up == down || up == down.next_up(), "{square} {down} {up}");
            }
        }
        let scale = Scale::new(&Frame::new([0.0; 3], 8.0, 2).unwrap());
        assert_eq!((scale.down(Some(25)), scale.up(Some(25))), (5.0, 5.0));
        assert_eq!((scale.down(None), scale.up(None)), (f32::INFINITY, f32::INFINITY));
    }
}
