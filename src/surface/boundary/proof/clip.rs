//! Clipping polygons to boxes.

use crate::error::Error;
use crate::lattice::axes;
use crate::memory;
use alloc::vec::Vec;

/// Clips a polygon to a box. `kept` is a buffer.
///
/// A corner that is NaN stays: a polygon that is too large does not weaken the proof.
pub(super) fn clip(
    polygon: &mut Vec<[f64; 3]>,
    kept: &mut Vec<[f64; 3]>,
    low: [f64; 3],
    high: [f64; 3],
) -> Result<(), Error> {
    for axis in 0..3 {
        for (bound, sign) in [(low[axis], 1.0), (high[axis], -1.0)] {
            let away = |p: &[f64; 3]| sign * (p[axis] - bound);
            if polygon.iter().all(|p| away(p) >= 0.0) {
                continue;
            }
            kept.clear();
            for k in 0..polygon.len() {
                let (p, q) = (polygon[k], polygon[(k + 1) % polygon.len()]);
                let (a, b) = (away(&p), away(&q));
                if a >= 0.0 {
                    memory::push(kept, p)?;
                }
                if (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0) {
                    let share = a / (a - b);
                    let mut cut = axes(|k| p[k] + share * (q[k] - p[k]));
                    cut[axis] = bound;
                    memory::push(kept, cut)?;
                }
            }
            core::mem::swap(polygon, kept);
        }
    }
    Ok(())
}
