//! Moments of a cube cut by one plane, in closed form.

use super::Half;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::{CubeMoments, PAIRS};

/// The greatest accepted term of the sum; larger terms would cancel. (The errors of moments are below 2^-45
/// of the largest term.)
const LARGEST_TERM: f64 = 24.0;

/// Returns the moments of { x in [-1, 1]³ : n · x ≤ offset }, where the magnitudes of n add up to 1. `None`
/// if their error would be too great, because the plane is nearly but not quite parallel to an axis.
///
/// In coordinates u in [0, 1]³ that grow along n, the set is a simplex at the origin, minus the simplices at
/// the corners that it reaches beyond, and so on: a sum over corners by inclusion and exclusion.
#[inline]
pub(super) fn below(half: &Half) -> Option<CubeMoments> {
    let m = half.normal.each(f64::abs);
    // n · x = Σ m (2u − 1): the plane is m · u = α.
    let alpha = 0.5 * (half.offset + (m[0] + m[1]) + m[2]);
    let upper = alpha > 0.5;
    let alpha = if upper { 1.0 - alpha } else { alpha };
    if alpha <= 0.0 {
        return Some(if upper { CubeMoments::FULL } else { CubeMoments::EMPTY });
    }
    // Specialised for each choice of axes on which the plane depends.
    let is_used = |axis: usize| ((m[axis] > 0.0) as usize) << axis;
    let (volume, first, second) = match is_used(0) | is_used(1) | is_used(2) {
        0b001 => sums::<0b001>(&m, alpha),
        0b010 => sums::<0b010>(&m, alpha),
        0b011 => sums::<0b011>(&m, alpha),
        0b100 => sums::<0b100>(&m, alpha),
        0b101 => sums::<0b101>(&m, alpha),
        0b110 => sums::<0b110>(&m, alpha),
        _ => sums::<0b111>(&m, alpha),
    }?;
    // x = ±(2u − 1), with the opposite sign for the upper half.
    let flip = half.normal.each(|c| if (c < 0.0) != upper { -1.0 } else { 1.0 });
    let mut moments = CubeMoments {
        volume: 8.0 * volume,
        first: axes(|i| 8.0 * flip[i] * (2.0 * first[i] - volume)),
        second: [0.0; 6],
    };
    for (k, (i, j)) in PAIRS.into_iter().enumerate() {
        let sum = 4.0 * second[k] - 2.0 * (first[i] + first[j]) + volume;
        moments.second[k] = 8.0 * flip[i] * flip[j] * sum;
    }
    Some(if upper { moments.complement() } else { moments })
}

/// Returns volume, first and second moments of { u in [0, 1]³ : m · u ≤ α }, where α ≤ ½. The m of the axes
/// in `USED` (a bit each) are positive, the others are 0.
#[inline(always)]
fn sums<const USED: usize>(m: &[f64; 3], alpha: f64) -> Option<(f64, [f64; 3], [f64; 6])> {
    let is_used = |axis: usize| USED >> axis & 1 != 0;
    let count = USED.count_ones();
    let power = |r: f64| match count {
        1 => r,
        2 => r * r,
        _ => r * r * r,
    };
    let inverse = axes(|axis| if is_used(axis) { 1.0 / m[axis] } else { 0.0 });
    let product = (0..3).filter(|&axis| is_used(axis)).fold(1.0, |product, axis| product * m[axis]);
    let unit = 1.0 / ([1.0, 1.0, 2.0, 6.0][count as usize] * product);
    let k = count as f64;
    let (per_first, per_second) = (1.0 / (k + 1.0), 1.0 / ((k + 1.0) * (k + 2.0)));
    // The largest of all terms is that of the largest simplex.
    let largest_edge = alpha * inverse[0].max(inverse[1]).max(inverse[2]);
    if power(alpha) * unit * (1.0 + 2.0 * per_second * largest_edge * largest_edge) > LARGEST_TERM {
        return None;
    }
    let (mut volume, mut first, mut second) = (0.0, [0.0; 3], [0.0; 6]);
    for corner in 0..8usize {
        if corner & !USED != 0 {
            continue;
        }
        let at = axes(|axis| (corner >> axis & 1) as f64);
        let rest = ((alpha - at[0] * m[0]) - at[1] * m[1]) - at[2] * m[2];
        if rest <= 0.0 {
            continue;
        }
        let v = power(rest) * if corner.count_ones() % 2 == 0 { unit } else { -unit };
        volume += v;
        // The edges of the simplex, and its centroid.
        let edge = inverse.each(|i| rest * i);
        for i in (0..3).filter(|&i| is_used(i)) {
            first[i] += v * (at[i] + per_first * edge[i]);
        }
        for (sum, (i, j)) in second.iter_mut().zip(PAIRS) {
            if is_used(i) && is_used(j) {
                let own = if i == j { 2.0 } else { 1.0 };
                let mixed = per_first * (at[i] * edge[j] + at[j] * edge[i]);
                *sum += v * (at[i] * at[j] + mixed + own * per_second * edge[i] * edge[j]);
            }
        }
    }
    // Along the other axes the set is uniform.
    for axis in (0..3).filter(|&axis| !is_used(axis)) {
        first[axis] = 0.5 * volume;
    }
    for (sum, (i, j)) in second.iter_mut().zip(PAIRS) {
        match (is_used(i), is_used(j)) {
            (false, false) => *sum = volume * if i == j { 1.0 / 3.0 } else { 0.25 },
            (false, true) => *sum = 0.5 * first[j],
            (true, false) => *sum = 0.5 * first[i],
            (true, true) => {}
        }
    }
    Some((volume, first, second))
}
