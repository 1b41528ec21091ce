//! The scene that both programs build.

use leafless::solid::HalfSpace;
use leafless::{Csg, Error};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// Centres (x, y) of the cylinders along z, whose radius is 0.1.
pub fn along_z() -> impl Iterator<Item = (f64, f64)> {
    (0..8).map(|i| 0.3 + i as f64 * FRAC_PI_4).map(|angle| (0.55 * angle.cos(), 0.55 * angle.sin()))
}

/// Centres (z, y) of the cylinders along x, whose radius is 0.08.
pub fn along_x() -> impl Iterator<Item = (f64, f64)> {
    (0..4).map(|i| 0.7 + i as f64 * FRAC_PI_2).map(|angle| (0.5 * angle.cos(), 0.5 * angle.sin()))
}

/// The ball of radius 0.9 around the origin, minus three bars of width 0.4 along the axes and twelve
/// cylinders.
pub fn solid() -> Result<Csg, Error> {
    let mut parts = vec![Csg::ball([0.0; 3], 0.9)?];
    for along in 0..3 {
        let mut sides = Vec::new();
        for across in (0..3).filter(|&axis| axis != along) {
            for sign in [-1.0, 1.0] {
                let mut normal = [0.0; 3];
                normal[across] = sign;
                sides.push(Csg::half_space(normal, 0.2)?);
            }
        }
        parts.push(Csg::intersection_of(sides)?.complement());
    }
    // Outside of a cylinder: (a − a₀)² + (y − y₀)² ≥ r².
    for (x, y) in along_z() {
        let outside = [(1.0, x, 2), (1.0, y, 2), (0.0, 0.0, 1)];
        parts.push(HalfSpace::power(outside, -0.01)?.into());
    }
    for (z, y) in along_x() {
        let outside = [(0.0, 0.0, 1), (1.0, y, 2), (1.0, z, 2)];
        parts.push(HalfSpace::power(outside, -0.0064)?.into());
    }
    Csg::intersection_of(parts)
}
