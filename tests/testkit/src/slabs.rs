//! Exact evaluation of enclosures at points.

use super::exact::Exact;
use leafless::solid::{Enclosure, Slab, SlabJoin};

/// Returns the sign of n · x − offset.
fn side(slab: &Slab, offset: f64, x: [f64; 3]) -> i32 {
    if offset.is_infinite() {
        return if offset > 0.0 { -1 } else { 1 };
    }
    let products = (0..3).map(|axis| Exact::from(slab.normal[axis]).times(&x[axis].into()));
    products.fold(Exact::from(-offset), |sum, product| sum.plus(&product)).sign()
}

pub fn known(enclosure: &Enclosure) -> impl Iterator<Item = &Slab> {
    enclosure.slabs.iter().filter(|slab| slab.normal != [0.0; 3])
}

/// Returns 1 if the enclosure puts the point inside, −1 if it puts the point outside, and 0 if it does not
/// decide.
pub fn told(enclosure: &Enclosure, x: [f64; 3]) -> i32 {
    let mut slabs =
        known(enclosure).map(|slab| (side(slab, slab.inner, x) < 0, side(slab, slab.outer, x) > 0));
    let (mut inside, mut outside) = match enclosure.join {
        SlabJoin::All => (true, false),
        SlabJoin::Any => (false, true),
    };
    for (within, beyond) in slabs.by_ref() {
        match enclosure.join {
            SlabJoin::All => (inside, outside) = (inside && within, outside || beyond),
            SlabJoin::Any => (inside, outside) = (inside || within, outside && beyond),
        }
    }
    assert!(!(inside && outside));
    inside as i32 - outside as i32
}

/// Returns the bits of all numbers of the enclosure.
pub fn bits(enclosure: &Enclosure) -> ([[u64; 5]; 3], SlabJoin, u64) {
    let slab = |s: &Slab| [s.normal[0], s.normal[1], s.normal[2], s.inner, s.outer].map(f64::to_bits);
    (enclosure.slabs.each_ref().map(slab), enclosure.join, enclosure.cone.to_bits())
}
