//! Lattices for surfaces whose vertices lie where edges of cells cross them.

use leafless::{Error, Frame};

/// A cube around a box, in whose lattice no face of a part lies as a rule: none at a round number, and none
/// in a plane of symmetry. In a plane of the lattice triangles have hardly any area, and are lost to
/// rounding.
pub fn cube(mut low: [f64; 3], high: [f64; 3], depth: u8) -> Result<Frame, Error> {
    let longest = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
    for (end, part) in low.iter_mut().zip([89.0, 97.0, 101.0]) {
        *end -= longest / part;
    }
    Frame::around(low, high, depth)
}
