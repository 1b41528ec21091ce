//! Lattices for surfaces whose vertices lie where edges of cells cross them.

use leafless::{Error, Frame};

/// Returns a cube around a box whose lattice usually contains no face of a part: no plane of the lattice lies
/// at a round number, or in a plane of symmetry. In a plane of the lattice, triangles would have hardly any
/// area, and be lost to rounding.
pub fn cube(mut low: [f64; 3], high: [f64; 3], depth: u8) -> Result<Frame, Error> {
    let longest = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
    for (end, part) in low.iter_mut().zip([89.0, 97.0, 101.0]) {
        *end -= longest / part;
    }
    Frame::around(low, high, depth)
}
