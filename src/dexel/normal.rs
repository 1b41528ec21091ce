//! Unit vectors as two small integers: the octahedral code (Meyer et al. 2010, Cigolle et al. 2014).
//!
//! A vector is scaled so that the sum of its coordinates' magnitudes is M. Two coordinates are stored; where
//! the third is negative they are folded outward. The least number of a component, −M − 1, stands for "no
//! normal".

use crate::lattice::Each;

/// M for components of 16 bits; a code takes 32.
pub(crate) const FINE: i32 = 0x7FFF;

/// M for components of 8 bits; a code takes 16.
pub(crate) const COARSE: i32 = 0x7F;

/// The code of no normal, in 32 bits.
pub(crate) const NO_NORMAL: u32 = 0x8000_8000;

/// The code of no normal, in 16 bits.
pub(crate) const NO_NORMAL_16: u16 = 0x8080;

/// The code of a vector of any length; a vector without direction gives the code of no normal.
pub(crate) fn encoded(vector: [f64; 3]) -> u32 {
    let sum = vector.iter().map(|c| c.abs()).sum::<f64>();
    if !(sum > 0.0 && sum < f64::INFINITY) {
        return NO_NORMAL;
    }
    let scale = f64::from(FINE) / sum;
    let [x, y, z] = vector.each(|c| c * scale);
    let most = f64::from(FINE);
    let [a, b] = if z >= 0.0 {
        [x, y]
    } else {
        [(most - y.abs()).copysign(signed(x)), (most - x.abs()).copysign(signed(y))]
    };
    packed([a, b].each(|c| libm::rint(c) as i32))
}

/// Returns whether these 32 bits are a code, or the code of no normal.
pub(crate) fn is_code(code: u32) -> bool {
    code == NO_NORMAL || unpacked(code).iter().all(|&c| c >= -FINE)
}

/// Returns whether these 16 bits are a code, or the code of no normal.
pub(crate) fn is_code_16(code: u16) -> bool {
    code == NO_NORMAL_16 || code.to_le_bytes().iter().all(|&c| i32::from(c as i8) >= -COARSE)
}

/// The sign of a number, as 1 or −1; zero counts as positive.
fn signed(x: f64) -> f64 {
    if x < 0.0 { -1.0 } else { 1.0 }
}

fn packed([a, b]: [i32; 2]) -> u32 {
    u32::from(a as u16) | u32::from(b as u16) << 16
}

fn unpacked(code: u32) -> [i32; 2] {
    [code as u16 as i16, (code >> 16) as u16 as i16].each(i32::from)
}

/// The point of the octahedron: the sum of its coordinates' magnitudes is `most`.
fn point([a, b]: [i32; 2], most: i32) -> [i32; 3] {
    let z = most - a.abs() - b.abs();
    if z >= 0 {
        return [a, b, z];
    }
    let sign = |c: i32| if c < 0 { -1 } else { 1 };
    [(most - b.abs()) * sign(a), (most - a.abs()) * sign(b), z]
}

fn folded([x, y, z]: [i32; 3], most: i32) -> [i32; 2] {
    if z >= 0 {
        return [x, y];
    }
    let sign = |c: i32| if c < 0 { -1 } else { 1 };
    [(most - y.abs()) * sign(x), (most - x.abs()) * sign(y)]
}

/// The unit vector of a code, within 0.0001.
pub(crate) fn decoded(code: u32) -> Option<[f64; 3]> {
    if code == NO_NORMAL {
        return None;
    }
    let [x, y, z] = point(unpacked(code), FINE).each(f64::from);
    let length = crate::lattice::exact::sqrt(x * x + y * y + z * z);
    // (A code from a file may be invalid; the point then lies off the octahedron, but not at its centre.)
    (length > 0.0).then(|| [x / length, y / length, z / length])
}

/// The code of the opposite vector. Applied twice, it gives the same code again.
pub(crate) fn flipped(code: u32) -> u32 {
    if code == NO_NORMAL {
        return code;
    }
    packed(folded(point(unpacked(code), FINE).each(|c| -c), FINE))
}

/// Converts a code of 32 bits to one of 16 bits.
pub(crate) fn coarse(code: u32) -> u16 {
    if code == NO_NORMAL {
        return NO_NORMAL_16;
    }
    // Rounded on the octahedron, so that opposite codes stay opposite.
    let [x, y, _] = point(unpacked(code), FINE);
    let upper = FINE - unpacked(code).each(i32::abs).iter().sum::<i32>() >= 0;
    let rounded = |c: i32| (c.abs() * COARSE + FINE / 2) / FINE * c.signum();
    let [mut x, y] = [rounded(x), rounded(y)];
    if x.abs() + y.abs() > COARSE {
        x -= x.signum();
    }
    let z = COARSE - x.abs() - y.abs();
    let [a, b] = folded([x, y, if upper { z } else { -z }], COARSE);
    u16::from(a as u8) | u16::from(b as u8) << 8
}

/// Converts a code of 16 bits to one of 32 bits.
pub(crate) fn fine(code: u16) -> u32 {
    if code == NO_NORMAL_16 {
        return NO_NORMAL;
    }
    let [x, y, z] = point([code as u8 as i8, (code >> 8) as u8 as i8].each(i32::from), COARSE);
    // 32767 is 258 · 127 + 1: adding the one to the greatest component keeps the sum of magnitudes.
    let mut fine = [x, y, z].each(|c| c * (FINE / COARSE));
    let greatest = (0..3).max_by_key(|&axis| (fine[axis].abs(), axis)).unwrap_or(0);
    let rest = FINE - fine.iter().map(|c| c.abs()).sum::<i32>();
    fine[greatest] += if fine[greatest] < 0 { -rest } else { rest };
    packed(folded(fine, FINE))
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec::Vec;

    #[test]
    fn codes_keep_directions() {
        let mut state = 7u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
        };
        let mut vectors: Vec<[f64; 3]> = (0..2000).map(|_| [random(), random(), random()]).collect();
        for axis in 0..3 {
            for sign in [1.0, -1.0] {
                let mut unit = [0.0; 3];
                unit[axis] = sign;
                vectors.push(unit);
                unit[(axis + 1) % 3] = 0.25;
                vectors.push(unit);
            }
        }
        for vector in vectors {
            let length = vector.iter().map(|c| c * c).sum::<f64>().sqrt();
            let off = |code: u32| {
                let unit = decoded(code).unwrap();
                (0..3).map(|axis| (unit[axis] - vector[axis] / length).powi(2)).sum::<f64>().sqrt()
            };
            let code = encoded(vector);
            assert!(off(code) < 1e-4, "{vector:?} {}", off(code));
            assert_eq!(flipped(flipped(code)), code, "{vector:?}");
            let (here, there) = (decoded(code).unwrap(), decoded(flipped(code)).unwrap());
            assert_eq!(here.map(|c| -c + 0.0), there.map(|c| c + 0.0));
            let short = coarse(code);
            assert!([code, flipped(code), fine(short)].into_iter().all(is_code) && is_code_16(short));
            assert!(off(fine(short)) < 0.02, "{vector:?} {}", off(fine(short)));
            assert_eq!(coarse(fine(short)), short, "{vector:?}");
        }
        assert_eq!(encoded([0.0; 3]), NO_NORMAL);
        assert_eq!(encoded([f64::NAN, 1.0, 0.0]), NO_NORMAL);
        assert_eq!(decoded(NO_NORMAL), None);
        assert_eq!(
            (coarse(NO_NORMAL), fine(NO_NORMAL_16), flipped(NO_NORMAL)),
            (NO_NORMAL_16, NO_NORMAL, NO_NORMAL)
        );
        assert!(is_code(NO_NORMAL) && is_code_16(NO_NORMAL_16));
        assert!(!is_code(0x8000_0001) && !is_code(0x0001_8000) && !is_code_16(0x8001) && !is_code_16(0x0180));
        // Axes are exact.
        assert_eq!(decoded(fine(coarse(encoded([0.0, 0.0, -2.0])))), Some([0.0, 0.0, -1.0]));
    }
}
