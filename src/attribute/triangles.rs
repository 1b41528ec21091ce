//! Samples any attribute on the triangles of a surface.

use super::Attribute;
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::sqrt;
use crate::memory;
use crate::mesh::{MeshAttribute, TriangleMesh};
use alloc::vec::Vec;
use hashbrown::HashMap;

/// The number of triangles that are sampled together.
const CHUNK: usize = 1024;

/// The points at which a triangle's value is searched, in order of preference: their distances behind the
/// centroid, as multiples of the depth.
const DEPTHS: [f64; 4] = [1.0, 0.25, 2.0, 0.0];

/// Samples `attribute` on the triangles of a surface, and stores the values under a name. The value of a
/// triangle is the value just inside it, `depth` (model units) behind its centroid. If there is none, it is
/// the value at a quarter of the depth, at twice the depth, or at the centroid itself. Otherwise the triangle
/// has no value. A triangle without area is sampled at its centroid.
///
/// So a surface that was made of a solid receives the values of the solid's channels, such as colours and
/// materials. Half the edge of the channel's cells is a good depth: a vertex lies anywhere in a cell, and
/// that depth leads to the solid behind it. Triangles with the same value share a row of the table.
///
/// O(t) queries. The result is the same for any number of threads.
///
/// # Errors
/// [`Error::Argument`] unless the depth is finite and not negative, and the attribute has 1 to 4 components;
/// the errors of the attribute; [`Error::Cancelled`] or [`Error::OutOfMemory`].
///
/// ```
/// use leafless::attribute::{ConstantAttribute, sample_triangles};
/// use leafless::{Control, TriangleMesh, mesh::MeshAttribute};
/// let vertices = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let mut mesh = TriangleMesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])?;
/// let red = ConstantAttribute::new(&[255.0, 0.0, 0.0])?;
/// mesh.add_attribute(sample_triangles(&mesh, &red, "colour", 0.01, &Control::default())?)?;
/// assert_eq!(mesh.attribute("colour").unwrap().value(3, 0), Some([255.0, 0.0, 0.0, 0.0]));
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn sample_triangles(
    mesh: &TriangleMesh,
    attribute: &dyn Attribute,
    name: &str,
    depth: f64,
    control: &Control<'_>,
) -> Result<MeshAttribute, Error> {
    if !(0.0..f64::INFINITY).contains(&depth) {
        return Err(Error::Argument { name: "depth", problem: "must be finite and not negative" });
    }
    let components = attribute.components();
    if !(1..=4).contains(&components) {
        return Err(Error::Argument { name: "attribute", problem: "must have 1 to 4 components" });
    }
    let job = Job::new(control);
    job.check()?;
    let triangles = mesh.triangles();
    let found = control.run(triangles.len() > CHUNK, |parallel| {
        job.each(parallel, triangles.chunks(CHUNK), |chunk| values_of(mesh, attribute, depth, chunk))
    })?;
    let (mut known, mut table) = (HashMap::new(), Vec::new());
    let mut rows = memory::with_capacity(triangles.len())?;
    for value in found.into_iter().flatten() {
        let Some(value) = value else {
            rows.push(MeshAttribute::NO_ROW);
            continue;
        };
        known.try_reserve(1)?;
        let next = (table.len() / components) as u32;
        let row = *known.entry(value.each(|number: f64| (number + 0.0).to_bits())).or_insert(next);
        if row == next {
            table.try_reserve(components)?;
            table.extend_from_slice(&value[..components]);
        }
        rows.push(row);
    }
    MeshAttribute::by_triangle(name, components, table, rows)
}

fn values_of(
    mesh: &TriangleMesh,
    attribute: &dyn Attribute,
    depth: f64,
    chunk: &[[u32; 3]],
) -> Result<Vec<Option<[f64; 4]>>, Error> {
    let mut values = memory::filled(chunk.len(), None)?;
    let mut open: Vec<u32> = memory::collected(0..chunk.len() as u32)?;
    let mut points = memory::with_capacity(chunk.len())?;
    let mut found = memory::filled(chunk.len(), None)?;
    for times in DEPTHS {
        points.clear();
        points.extend(open.iter().map(|&k| point_of(mesh, &chunk[k as usize], times * depth)));
        let found = &mut found[..open.len()];
        attribute.values(&points, found)?;
        for (&k, value) in open.iter().zip(found.iter()) {
            values[k as usize] = value.filter(|value| value.iter().all(|number| number.is_finite()));
        }
        open.retain(|&k| values[k as usize].is_none());
        if open.is_empty() || depth == 0.0 {
            break;
        }
    }
    Ok(values)
}

/// The point `depth` behind a triangle's centroid.
fn point_of(mesh: &TriangleMesh, triangle: &[u32; 3], depth: f64) -> [f64; 3] {
    let [a, b, c] = triangle.each(|vertex| mesh.vertices()[vertex as usize]);
    let third = |k: usize| a[k] / 3.0 + b[k] / 3.0 + c[k] / 3.0;
    // (Scaled, so that squares neither overflow nor underflow.)
    let unit = |v: [f64; 3]| {
        let most = v.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        let v = v.each(|c| c / most);
        let length = sqrt(v.iter().map(|c| c * c).sum());
        v.each(|c| c / length)
    };
    let (u, v) = (unit(axes(|k| b[k] - a[k])), unit(axes(|k| c[k] - a[k])));
    let normal = unit(axes(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        u[i] * v[j] - u[j] * v[i]
    }));
    // A triangle without area has a NaN normal.
    if normal.iter().all(|c| c.is_finite()) { axes(|k| third(k) - depth * normal[k]) } else { axes(third) }
}
