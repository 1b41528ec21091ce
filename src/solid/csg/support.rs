//! Bounding boxes of convex polyhedra.
//!
//! A linear programme is solved in floating point by the dual simplex method. The result is then proven: if a
//! direction e is −Σ λ n over some planes n · p + o ≥ 0 with exact λ ≥ 0, then e · p ≤ Σ λ o.

use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::{self, Dyadic, sqrt};
use crate::memory;
use alloc::vec::Vec;

type Plane = ([f64; 3], f64);
/// The lower and the upper corner of a box.
type Corners = ([f64; 3], [f64; 3]);

/// The most steps of the simplex method; some ten are usual.
const MOST_STEPS: usize = 1000;
/// Values below this count as zero, for unit normals and offsets up to one.
const NOTHING: f64 = 1e-10;
/// The offset of auxiliary planes that bound unbounded polyhedra.
const FAR: f64 = (1u64 << 20) as f64;

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    axes(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

/// Returns a box that surely contains the polyhedron of all points with n · p + o ≥ 0 for each plane (n, o),
/// if one is found. O(planes).
///
/// # Errors
/// [`Error::OutOfMemory`].
pub(super) fn box_around(planes: &[Plane]) -> Result<Option<Corners>, Error> {
    // Unit normals, and offsets up to one.
    let mut rows: Vec<Plane> = memory::with_capacity(planes.len() + 3)?;
    rows.extend(planes.iter().map(|&(normal, offset)| {
        let largest = normal.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        let normal = normal.each(|c| c / largest);
        let length = sqrt(dot(normal, normal));
        (normal.each(|c| c / length), offset / largest / length)
    }));
    let size = rows.iter().fold(0.0, |most: f64, row| most.max(row.1.abs()));
    if size > 0.0 {
        rows.iter_mut().for_each(|row| row.1 /= size);
    }
    let (mut min, mut max) = ([0.0; 3], [0.0; 3]);
    for axis in 0..3 {
        for (sign, end) in [(-1.0, &mut min[axis]), (1.0, &mut max[axis])] {
            let mut direction = [0.0; 3];
            direction[axis] = sign;
            rows.truncate(planes.len());
            rows.extend(axes(|k| {
                let mut outward = [0.0; 3];
                outward[k] = if k == axis { -sign } else { -1.0 };
                (outward, FAR)
            }));
            let Some(reach) = best_planes(&rows, direction).and_then(|best| reach(planes, best, direction))
            else {
                return Ok(None);
            };
            *end = sign * reach;
        }
    }
    Ok(Some((min, max)))
}

/// Returns three planes at whose common point `direction` · p seems to be greatest. The search starts from
/// the last three planes.
fn best_planes(rows: &[Plane], direction: [f64; 3]) -> Option<[usize; 3]> {
    let first = rows.len() - 3;
    let mut basis = [first, first + 1, first + 2];
    for _ in 0..MOST_STEPS {
        let normals = basis.each(|i| rows[i].0);
        // The dual basis: the vectors d for the coordinates d · p.
        let volume = dot(normals[0], cross(normals[1], normals[2]));
        let dual = axes(|i| cross(normals[(i + 1) % 3], normals[(i + 2) % 3]).each(|c| c / volume));
        let corner = axes(|axis| -(0..3).map(|i| dual[i][axis] * rows[basis[i]].1).sum::<f64>());
        let height = |row: &Plane| dot(row.0, corner) + row.1;
        let lowest = (0..rows.len()).min_by(|&a, &b| height(&rows[a]).total_cmp(&height(&rows[b])))?;
        let size = 1.0 + dot(corner.each(f64::abs), [1.0; 3]);
        if height(&rows[lowest]) >= -NOTHING * size {
            return Some(basis);
        }
        // The plane enters, and the plane leaves whose share, −dual · direction, is used up first.
        let ratio = |i: usize| {
            let change = dot(dual[i], rows[lowest].0);
            (change > NOTHING).then(|| -dot(dual[i], direction) / change)
        };
        let ratios = (0..3).filter_map(|i| Some((i, ratio(i)?)));
        let (leaving, _) = ratios.min_by(|a, b| a.1.total_cmp(&b.1))?;
        basis[leaving] = lowest;
    }
    None
}

/// Returns an upper bound of `direction` · p on the polyhedron, proven by three planes. Indices beyond the
/// given planes stand for planes that do not belong to the polyhedron.
fn reach(planes: &[Plane], basis: [usize; 3], direction: [f64; 3]) -> Option<f64> {
    let exactly = |v: [f64; 3]| v.each(Dyadic::new);
    let determinant = |[a, b, c]: [&[Dyadic; 3]; 3]| exact::dot(a.each_ref(), exact::cross(b, c).each_ref());
    let unit = |k: usize| axes(|axis| if axis == k { 1.0 } else { 0.0 });
    // The sign of a plane without a share does not matter.
    let normals =
        basis.each(|i| exactly(planes.get(i).map_or_else(|| unit(i - planes.len()), |plane| plane.0)));
    let direction = exactly(direction);
    let volume = determinant([&normals[0], &normals[1], &normals[2]]);
    if volume.is_zero() {
        return None;
    }
    let mut sum = Dyadic::zero();
    for i in 0..3 {
        let mut columns = normals.each_ref();
        columns[i] = &direction;
        let share = -&determinant(columns);
        match planes.get(basis[i]) {
            _ if share.is_zero() => {}
            Some(plane) if share.sign() == volume.sign() => sum = &sum + &(&share * &Dyadic::new(plane.1)),
            _ => return None,
        }
    }
    let (Some(above), Some(below)) = (sum.magnitude(), volume.magnitude()) else { return Some(0.0) };
    let quotient = sum.shifted(-above).rounded() / volume.shifted(-below).rounded();
    let exponent = i32::try_from(above - below).ok().filter(|e| e.abs() < 1000)?;
    // Both are rounded, and so is the quotient.
    let upper = quotient + 4.0 * f64::EPSILON * quotient.abs();
    Some(upper * f64::from_bits(((1023 + exponent) as u64) << 52))
}
