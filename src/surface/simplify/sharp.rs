//! Sides of triangles that are edges of the shape, and stay in place.

use super::links::Links;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::memory;
use crate::mesh::MeshAttribute;

/// The cosine of the greatest angle between the normals of two triangles whose common side is not an edge: 30
/// degrees.
const SMOOTH: f64 = 0.866;

/// The regions whose borders are edges of the shape.
#[derive(Clone, Copy)]
pub(in crate::surface) enum Regions<'r> {
    /// The triangles of a region have the same number, whatever their normals.
    Numbered(&'r [u32]),
    /// Neighbouring triangles of a region have similar normals, and its triangles have the same attribute
    /// values.
    Alike(&'r [MeshAttribute]),
}

/// Marks the sides between triangles of different regions.
pub(super) fn mark(links: &mut Links, vertices: &[[f64; 3]], regions: Regions<'_>) -> Result<(), Error> {
    let mut sides = memory::with_capacity(3 * links.triangles.len())?;
    for (triangle, corners) in (0u32..).zip(&links.triangles) {
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            sides.push((a.min(b), a.max(b), 3 * triangle + k as u32));
        }
    }
    sides.sort_unstable();
    for both in sides.windows(2) {
        let [(a, b, one), (c, d, other)] = [both[0], both[1]];
        if (a, b) != (c, d) {
            continue;
        }
        let triangles = [one, other].each(|corner| corner as usize / 3);
        let [first, second] = triangles;
        let is_sharp = match regions {
            Regions::Numbered(numbers) => numbers[first] != numbers[second],
            Regions::Alike(values)
                if values.iter().any(|own| own.value(first, 0) != own.value(second, 0)) =>
            {
                true
            }
            Regions::Alike(_) => {
                let [m, n] = triangles.each(|triangle| normal(links.triangles[triangle], vertices));
                let cosine: f64 = (0..3).map(|k| m[k] * n[k]).sum();
                // (Triangles without area have no direction, and their sides are not edges.)
                cosine < SMOOTH && m != [0.0; 3] && n != [0.0; 3]
            }
        };
        if is_sharp {
            for corner in [one, other] {
                links.set_sharp(corner as usize / 3, corner as usize % 3, true);
            }
        }
    }
    Ok(())
}

/// The unit normal of a triangle.
fn normal(corners: [u32; 3], vertices: &[[f64; 3]]) -> [f64; 3] {
    let [a, b, c] = corners.each(|vertex| vertices[vertex as usize]);
    let (u, v): ([f64; 3], [f64; 3]) = (axes(|k| b[k] - a[k]), axes(|k| c[k] - a[k]));
    let normal: [f64; 3] = axes(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
    let length = normal.iter().map(|c| c * c).sum::<f64>().sqrt();
    if length > 0.0 { normal.each(|c| c / length) } else { [0.0; 3] }
}
