//! Planes fitted to the surface in a window of cells.

use crate::lattice::Each;
use glam::{DMat3, DVec3, Vec3, Vec3A};

/// A plane through the surface around a block.
#[derive(Clone, Copy, Default, Debug, PartialEq)]
pub struct Plane {
    /// The outward unit normal, or zero if there is no surface.
    pub normal: Vec3,
    /// 1 if the surface is plane there, 0 if it is not.
    pub confidence: f32,
}

/// Parameters for fitting planes in windows of one size.
pub struct Fitting {
    /// The greatest occupancy of an octant.
    pub full: u8,
    /// The number of cells along the edge of an octant.
    pub edge: f64,
    /// The root mean square of the distances from the plane, in cells, up to which a surface counts as plane,
    /// and the one from which on it does not.
    pub plane: [f64; 2],
}

/// Octants along each axis of a window.
const COARSE: usize = 6;

/// The share of the outward steps that must lead to one side: below the first number a window has no plane,
/// and above the second one it has.
const AGREEMENT: [f64; 2] = [0.5, 0.8];

/// The high bits of bytes.
const HIGH: u64 = 0x8080_8080_8080_8080;

/// The octants of a layer of a window that have a next one along x, and along y.
const HAS_NEXT: [u64; 2] = [0o37_37_37_37_37_37, 0o77_77_77_77_77];

impl Fitting {
    /// Fits the plane around the block in the middle of a window, given the occupancy of the octants of its
    /// 3³ blocks.
    pub fn plane(&self, window: &[u64; 27]) -> Plane {
        // The high bit of each byte: at least half full.
        let bias = u64::from(0x80 - self.full / 2) * 0x0101_0101_0101_0101;
        let solid = window.map(|octants| octants.wrapping_add(bias) & HIGH);
        let (any, all) = solid.iter().fold((0, HIGH), |(any, all), solid| (any | solid, all & solid));
        if any == 0 || all == HIGH {
            return Plane::default();
        }
        // Bit x + 6 y of layer z.
        let mut layers = [0; COARSE];
        let mut shares = [0; COARSE * COARSE * COARSE];
        for (block, (octants, solid)) in window.iter().zip(solid).enumerate() {
            let (x, y, z) = (2 * (block % 3), 2 * (block / 3 % 3), 2 * (block / 9));
            let octants = octants.to_le_bytes();
            // Bit k is octant k.
            let solid = (solid >> 7).wrapping_mul(0x0102_0408_1020_4080) >> 56;
            for (row, pair) in octants.chunks_exact(2).enumerate() {
                let (y, z) = (y + (row & 1), z + (row >> 1));
                layers[z] |= (solid >> (2 * row) & 3) << (x + COARSE * y);
                let at = x + COARSE * (y + COARSE * z);
                shares[at..at + 2].copy_from_slice(pair);
            }
        }
        let half = f32::from(self.full / 2);
        let mut crossings = [Crossings::default(); 3];
        for z in 0..COARSE {
            let layer = layers[z];
            let next = if z + 1 < COARSE { layers[z + 1] } else { layer };
            let changes =
                [(layer ^ layer >> 1) & HAS_NEXT[0], (layer ^ layer >> COARSE) & HAS_NEXT[1], layer ^ next];
            for (axis, mut changes) in changes.into_iter().enumerate() {
                while changes != 0 {
                    let place = changes.trailing_zeros() as usize;
                    changes &= changes - 1;
                    let at = place + z * COARSE * COARSE;
                    let further = at + [1, COARSE, COARSE * COARSE][axis];
                    let (here, next) = (f32::from(shares[at]), f32::from(shares[further]));
                    let place = Vec3A::new((place % COARSE) as f32, (place / COARSE) as f32, z as f32);
                    crossings[axis].add(axis, place, here, next, half);
                }
            }
        }
        self.through(&crossings)
    }

    fn through(&self, crossings: &[Crossings; 3]) -> Plane {
        let count: f64 = crossings.iter().map(|found| f64::from(found.count)).sum();
        let out = DVec3::from(crossings.each(|found| f64::from(found.out))).normalize_or_zero();
        // Crossings of lines parallel to the surface are unreliable.
        let weights = (out * out).to_array();
        let total: f64 = (0..3).map(|axis| weights[axis] * f64::from(crossings[axis].count)).sum();
        let is_known = count >= 3.0 && total > 1e-9;
        if !is_known {
            return Plane::default();
        }
        let mean = |part: fn(&Crossings) -> Vec3A| {
            (0..3).map(|axis| part(&crossings[axis]).as_dvec3() * weights[axis]).sum::<DVec3>() / total
        };
        let middle = mean(|found| found.sum);
        let squares = mean(|found| found.squares) - middle * middle;
        let products = mean(|found| found.products)
            - DVec3::new(middle.y * middle.z, middle.z * middle.x, middle.x * middle.y);
        let spread = DMat3::from_cols(
            DVec3::new(squares.x, products.z, products.y),
            DVec3::new(products.z, squares.y, products.x),
            DVec3::new(products.y, products.x, squares.z),
        );
        // The direction in which the points spread least: eight inverse iterations, by squaring.
        let mut inverse = (spread + DMat3::from_diagonal(DVec3::splat(2.5e-4))).inverse();
        for _ in 0..3 {
            let scale = inverse.x_axis.x.abs().max(inverse.y_axis.y.abs()).max(inverse.z_axis.z.abs());
            inverse *= 1.0 / scale;
            inverse = inverse * inverse;
        }
        let normal = (inverse * out).normalize_or_zero();
        let off = self.edge * libm::sqrt(normal.dot(spread * normal).max(0.0));
        let is_sound = normal.is_finite() && normal != DVec3::ZERO;
        if !is_sound {
            return Plane::default();
        }
        let flat = ((self.plane[1] - off) / (self.plane[1] - self.plane[0])).clamp(0.0, 1.0);
        // A thin plate has both sides in the window. They cancel out, and only its rim would remain.
        let all = DVec3::from(crossings.each(|found| f64::from(found.all))).length();
        let agreement = DVec3::from(crossings.each(|found| f64::from(found.out))).length() / all;
        let confidence = flat * ((agreement - AGREEMENT[0]) / (AGREEMENT[1] - AGREEMENT[0])).clamp(0.0, 1.0);
        let normal = if normal.dot(out) < 0.0 { -normal } else { normal };
        Plane { normal: normal.as_vec3(), confidence: confidence as f32 }
    }
}

/// Crossings of the surface by lines along one axis: their number, and the sums of their places and of the
/// products of these.
#[derive(Clone, Copy, Default)]
struct Crossings {
    count: f32,
    sum: Vec3A,
    squares: Vec3A,
    /// y z, z x, x y.
    products: Vec3A,
    /// The sum of the signed steps from inside to outside.
    out: f32,
    /// The sum of the steps without their signs.
    all: f32,
}

impl Crossings {
    /// Adds a crossing between an octant and the next one along an axis, given the occupancy of both; `half`
    /// is the occupancy of a half-full octant.
    #[inline(always)]
    fn add(&mut self, axis: usize, place: Vec3A, here: f32, next: f32, half: f32) {
        let mut at = place - 0.5 * (COARSE as f32 - 1.0);
        at[axis] += (here - half) / (here - next);
        self.count += 1.0;
        self.sum += at;
        self.squares += at * at;
        self.products += Vec3A::new(at.y * at.z, at.z * at.x, at.x * at.y);
        self.out += here - next;
        self.all += (here - next).abs();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FITTING: Fitting = Fitting { full: 128, edge: 4.0, plane: [0.25, 0.45] };

    /// A window in which the occupancy of octants is a function of their place in it, from 0 to 1.
    fn window(full: u8, share: impl Fn(DVec3) -> f64) -> [u64; 27] {
        core::array::from_fn(|block| {
            let octants: [u8; 8] = core::array::from_fn(|octant| {
                let place = [0, 1, 2]
                    .map(|axis| (2 * (block / [1, 3, 9][axis] % 3) + (octant >> axis & 1)) as f64 - 2.5);
                (f64::from(full) * share(DVec3::from(place)).clamp(0.0, 1.0) + 0.5) as u8
            });
            u64::from_le_bytes(octants)
        })
    }

    #[test]
    fn planes_are_found() {
        let mut worst = 0.0f64;
        for k in 0..200 {
            let turn = f64::from(k);
            let normal =
                DVec3::new(libm::sin(turn), libm::cos(1.3 * turn), libm::sin(2.1 * turn + 1.0)).normalize();
            let height = libm::sin(0.7 * turn);
            // The occupancy of an octant is the depth of its middle, over its width along the normal.
            let width = normal.abs().element_sum();
            let found = FITTING.plane(&window(128, |place| 0.5 - (normal.dot(place) - height) / width));
            let off = found.normal.as_dvec3().angle_between(normal).to_degrees();
            worst = worst.max(off);
            assert!(off < 1.5 && found.confidence == 1.0, "{normal} {height} {found:?}");
        }
        assert!(worst > 0.0);
    }

    #[test]
    fn what_has_no_plane_says_so() {
        for share in [0.0, 0.3, 0.7, 1.0] {
            assert_eq!(FITTING.plane(&window(128, |_| share)), Plane::default());
        }
        // A corner, and a thin wall.
        let corner = FITTING.plane(&window(128, |place| f64::from(u8::from(place.min_element() > 0.0))));
        let wall = FITTING.plane(&window(128, |place| f64::from(u8::from(place.x.abs() < 1.0))));
        assert!(corner.confidence == 0.0 && wall.confidence == 0.0, "{corner:?} {wall:?}");
        // The rim of a plate is plane, but most of the surface is above and below.
        let plate = |place: DVec3| f64::from(u8::from(place.x < 0.0 && place.z.abs() < 1.0));
        assert_eq!(FITTING.plane(&window(128, plate)).confidence, 0.0);
    }

    #[test]
    fn crossings_along_all_axes_count() {
        // A single solid octant has a crossing on each of its six faces; all have equal weights in the
        // middle.
        for at in 0..216 {
            let place = DVec3::new((at % 6) as f64, (at / 6 % 6) as f64, (at / 36) as f64) - 2.5;
            let found = FITTING.plane(&window(128, |other| f64::from(u8::from(other == place))));
            // The outward steps cancel out, unless the window cuts some of them off.
            let cut = place.abs().cmpeq(DVec3::splat(2.5));
            assert_eq!(found == Plane::default(), !cut.any(), "{place} {found:?}");
        }
    }
}
