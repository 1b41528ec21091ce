//! Numbers of samples, and steps between neighbouring samples.

use crate::lattice::Each;

/// Bits of a coordinate.
const BITS: u32 = 21;
/// Added to coordinates, so that −1 becomes non-negative.
const BIAS: i32 = 1;

/// The number of a sample: z, y and x plus one, 21 bits each. The difference of two numbers depends only on
/// the difference of the samples.
pub(super) fn code(at: [i32; 3]) -> u64 {
    let [x, y, z] = at.each(|a| (a + BIAS) as u64);
    z << (2 * BITS) | y << BITS | x
}

/// The sample of a number.
pub(super) fn position(code: u64) -> [i32; 3] {
    [0, 1, 2].each(|axis| (code >> (axis * BITS) & ((1 << BITS) - 1)) as i32 - BIAS)
}

/// A step to a neighbouring sample, along an axis or a diagonal. The directions up to sign are 0 to 12.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Step {
    pub direction: u8,
    pub is_back: bool,
}

impl Step {
    /// The step by `by`, whose components are −1, 0 and 1 and not all 0.
    pub fn by(by: [i32; 3]) -> Step {
        let number = by[0] + 3 * by[1] + 9 * by[2];
        Step { direction: (number.unsigned_abs() - 1) as u8, is_back: number < 0 }
    }

    /// The amount by which a forward step changes the number of a sample.
    pub fn stride(direction: u8) -> u64 {
        let n = i32::from(direction) + 14;
        let by = [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1].each(i64::from);
        (by[0] + (by[1] << BITS) + (by[2] << (2 * BITS))) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_lead_to_neighbours() {
        for at in [[-1, -1, -1], [0, 5, 1 << 20], [7, -1, (1 << 20) - 1]] {
            assert_eq!(position(code(at)), at);
            let mut forwards = [0; 13];
            for n in (0..27).filter(|&n| n != 13) {
                let by = [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1];
                let (from, to) = (at.map(|a| a.max(0)), [0, 1, 2].map(|k| at[k].max(0) + by[k]));
                let step = Step::by(by);
                let stride = Step::stride(step.direction);
                assert!(stride as i64 > 0);
                let (low, high) = if step.is_back { (to, from) } else { (from, to) };
                assert_eq!(code(low).wrapping_add(stride), code(high));
                forwards[step.direction as usize] += 1;
            }
            assert_eq!(forwards, [2; 13]);
        }
    }
}
