//! Smooth parts and edges of meshes.

use super::mapped::mapped;
use crate::control::Job;
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use crate::mesh::{Edge, TriangleMesh, for_each_edge};
use alloc::vec::Vec;
use glam::{DVec3, Vec3};

/// The greatest number of triangles at a vertex whose normals are averaged. It bounds the work, because each
/// triangle is compared with each.
const MOST_TRIANGLES: usize = 256;

/// The cosine of the angle up to which a bend counts as plane because of rounding: a fiftieth of a degree.
const PLANE: f64 = 1.0 - 1e-7;

/// A unit vector, or zero. The computation neither overflows nor underflows.
#[inline]
fn unit(v: DVec3) -> DVec3 {
    moderate_unit(v).unwrap_or_else(|| {
        let size = v.abs().max_element();
        if size > 0.0 { (v / size).normalize_or_zero() } else { DVec3::ZERO }
    })
}

/// A unit vector; `None` unless its square is far from the largest and the smallest numbers.
#[inline]
fn moderate_unit(v: DVec3) -> Option<DVec3> {
    let squared = v.length_squared();
    (1e-200..1e200).contains(&squared).then(|| v * (1.0 / libm::sqrt(squared)))
}

fn corners(mesh: &TriangleMesh, triangle: [u32; 3]) -> [DVec3; 3] {
    triangle.each(|v| DVec3::from(mesh.vertices()[v as usize]))
}

/// The outward unit normals of the triangles; zero for a triangle without area.
pub fn normals(mesh: &TriangleMesh, job: &Job<'_>) -> Result<Vec<DVec3>, Error> {
    mapped(job, mesh.triangles().len(), |i| {
        let [a, b, c] = corners(mesh, mesh.triangles()[i]);
        let (u, v) = (b - a, c - a);
        moderate_unit(u.cross(v)).unwrap_or_else(|| unit(unit(u).cross(unit(v))))
    })
}

/// The normals at the corners of each triangle: the mean over the triangles at the vertex whose normals
/// differ by less than `crease` (degrees), weighted by their angles there. A vertex of more than 256
/// triangles is not smooth. O(t + v) if few triangles meet in a vertex.
pub fn corner_normals(
    mesh: &TriangleMesh,
    normals: &[DVec3],
    crease: f64,
    job: &Job<'_>,
) -> Result<Vec<[Vec3; 3]>, Error> {
    let least = libm::cos(crease.to_radians());
    // Slot v + 1 first counts, then holds the place of the next triangle of vertex v, and finally the end of
    // its list.
    let mut ends: Vec<usize> = memory::filled(mesh.vertices().len() + 2, 0)?;
    for &v in mesh.triangles().iter().flatten() {
        ends[v as usize + 2] += 1;
    }
    let mut sum = 0;
    for end in &mut ends {
        sum += *end;
        *end = sum;
    }
    let angles: Vec<[f32; 3]> = mapped(job, mesh.triangles().len(), |i| {
        let [a, b, c] = corners(mesh, mesh.triangles()[i]);
        let [u, v, w] = [b - a, c - b, a - c].each(unit);
        [-w.dot(u), -u.dot(v), -v.dot(w)].each(|cosine| libm::acosf(cosine.clamp(-1.0, 1.0) as f32))
    })?;
    let mut around: Vec<(u32, f32)> = memory::filled(sum, (0, 0.0))?;
    for (i, (triangle, angles)) in (0..).zip(mesh.triangles().iter().zip(&angles)) {
        for (&vertex, &angle) in triangle.iter().zip(angles) {
            let place = &mut ends[vertex as usize + 1];
            around[*place] = (i, angle);
            *place += 1;
        }
    }
    drop(angles);
    mapped(job, mesh.triangles().len(), |i| {
        let own = normals[i];
        mesh.triangles()[i].each(|v| {
            let around = &around[ends[v as usize]..ends[v as usize + 1]];
            if around.len() > MOST_TRIANGLES {
                return own.as_vec3();
            }
            let mean: DVec3 = (around.iter())
                .map(|&(other, angle)| (normals[other as usize], f64::from(angle)))
                .filter(|(normal, _)| normal.dot(own) > least)
                .map(|(normal, angle)| normal * angle)
                .sum();
            if mean.length() > 1e-6 { mean.normalize().as_vec3() } else { own.as_vec3() }
        })
    })
}

/// The edges at which a mesh ends, branches, or bends by more than `crease` (degrees).
pub fn features(
    mesh: &TriangleMesh,
    normals: &[DVec3],
    crease: f64,
    job: &Job<'_>,
) -> Result<Vec<[u32; 2]>, Error> {
    let least = libm::cos(crease.to_radians()).min(PLANE);
    edges(mesh, job, |edge| {
        let mut two = edge.triangles();
        let is_feature = match (edge.count(), two.next(), two.next()) {
            (2, Some(a), Some(b)) => {
                let [a, b] = [a, b].each(|i| normals[i as usize]);
                // Two triangles that use the edge in the same direction face opposite ways.
                let cosine = if edge.excess() == 0 { a.dot(b) } else { -a.dot(b) };
                // A triangle without area has no normal, so a bend at its edges is not known.
                cosine < least && a != DVec3::ZERO && b != DVec3::ZERO
            }
            _ => true,
        };
        is_feature.then_some([edge.low, edge.high])
    })
}

/// Collects the results of `choose` for the edges of a mesh.
pub fn edges<T>(
    mesh: &TriangleMesh,
    job: &Job<'_>,
    mut choose: impl FnMut(&Edge<'_>) -> Option<T>,
) -> Result<Vec<T>, Error> {
    let mut found = Vec::new();
    let mut visited = 0_u64;
    for_each_edge(mesh.triangles(), mesh.vertices().len(), |edge| {
        visited += 1;
        if visited.is_multiple_of(1 << 14) {
            job.check()?;
        }
        choose(edge).map_or(Ok(()), |chosen| memory::push(&mut found, chosen))
    })?;
    Ok(found)
}
