//! The vertex that represents the surface in a cell: the point where the surface's planes meet.

use super::triangles::{Place, dot};
use crate::lattice::Each;
use crate::lattice::axes;
use crate::surface::qef::{Qef, eigen};

/// Eigenvalues below this part of the greatest one are ignored. Each plane counts once.
const LEAST: f64 = 0.01;

/// Two planes count as one if their normals, and their offsets in edges of the cell, differ by at most this.
const SAME: f64 = 1e-7;

/// The greatest number of distinct planes that are examined.
const MOST: usize = 48;

/// A fitted vertex.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fit {
    /// The place in unit coordinates.
    pub(super) at: [f64; 3],
    /// The number of directions in which the planes determine the vertex.
    pub(super) rank: usize,
}

/// A box in unit coordinates, given by its lower corner and its edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Space {
    pub(super) low: [f64; 3],
    pub(super) edge: f64,
}

impl Space {
    fn inward(&self, at: [f64; 3]) -> [f64; 3] {
        axes(|k| (at[k] - self.low[k]) / self.edge)
    }

    fn outward(&self, own: [f64; 3]) -> [f64; 3] {
        axes(|k| self.low[k] + own[k] * self.edge)
    }
}

/// Returns a vertex that is at most `allowed` from all planes, and at most `slack` edges outside its cell. If
/// there are several, the one with the highest rank is taken.
pub(super) fn fit(places: &[Place], space: &Space, allowed: f64, slack: f64) -> Option<Fit> {
    let mut planes = [([0.0; 3], 0.0); MOST];
    let mut count = 0;
    let mut sum = [0.0; 3];
    for place in places {
        let own = space.inward(place.at);
        sum = axes(|k| sum[k] + own[k]);
        let plane = (place.normal, dot(place.normal, own));
        let is_same = |known: &([f64; 3], f64)| {
            (known.1 - plane.1).abs() <= SAME && (0..3).all(|k| (known.0[k] - plane.0[k]).abs() <= SAME)
        };
        if place.normal != [0.0; 3] && !planes[..count].iter().any(is_same) {
            *planes.get_mut(count)? = plane;
            count += 1;
        }
    }
    let planes = &planes[..count];
    if planes.is_empty() {
        return None;
    }
    let mean = sum.each(|c| c / places.len() as f64);
    let mut matrix = [0.0; 6];
    let mut rest = [0.0; 3];
    for &(n, offset) in planes {
        let products = [n[0] * n[0], n[0] * n[1], n[0] * n[2], n[1] * n[1], n[1] * n[2], n[2] * n[2]];
        matrix.iter_mut().zip(products).for_each(|(sum, product)| *sum += product);
        let off = offset - dot(n, mean);
        rest = axes(|k| rest[k] + off * n[k]);
    }
    let (values, vectors) = eigen(matrix);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
    let greatest = values[order[0]];
    let full = order.iter().filter(|&&k| values[k] >= LEAST * greatest).count();
    let allowed = allowed / space.edge;
    for rank in (1..=full).rev() {
        let mut own = mean;
        for &k in &order[..rank] {
            let along = dot(vectors[k], rest) / values[k];
            own = axes(|axis| own[axis] + along * vectors[k][axis]);
        }
        let off = planes.iter().fold(0.0, |most: f64, (n, offset)| most.max((dot(*n, own) - offset).abs()));
        if off <= allowed && own.iter().all(|c| (-slack..=1.0 + slack).contains(c)) {
            return Some(Fit { at: space.outward(own), rank });
        }
    }
    None
}

/// The vertex in a cell that fits its planes best, however large the error.
pub(super) fn best(places: impl Iterator<Item = Place>, space: &Space) -> [f64; 3] {
    let mut qef = Qef::default();
    for place in places {
        let own = space.inward(place.at).each(|c| c.clamp(0.0, 1.0));
        qef.add(own, Some(place.normal).filter(|normal| *normal != [0.0; 3]));
    }
    space.outward(qef.solve().at)
}
