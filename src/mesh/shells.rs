//! Closed shells: the regions that they enclose, and their nesting.

use crate::lattice::Each;
use alloc::vec::Vec;

use robust::{Coord, Coord3D, orient2d, orient3d};

use crate::error::Error;
use crate::lattice::axes;
use crate::memory;

/// Maximum number of vertices of a shell that are tried to find one that does not lie on the surface.
const SAMPLES: usize = 16;

/// Returns the numbers, ascending, of the `shells` with a vertex outside of the closed `surface`. Only one
/// vertex of each shell is tested, the first one that does not lie on the surface.
///
/// The winding numbers of all tested vertices are computed together: each triangle finds the vertices beside
/// it in a sorted list, so that many voids cost little more than one.
pub(crate) fn outside<'a>(
    vertices: &[[f64; 3]],
    surface: &[[u32; 3]],
    shells: impl Iterator<Item = (usize, &'a [[u32; 3]])>,
) -> Result<Vec<usize>, Error> {
    struct Sample<'a> {
        place: [f64; 3],
        winding: i32,
        on_surface: bool,
        shell: usize,
        triangles: &'a [[u32; 3]],
    }
    let mut samples: Vec<Sample> = Vec::new();
    for (shell, triangles) in shells {
        memory::push(
            &mut samples,
            Sample { place: [0.0; 3], winding: 0, on_surface: false, shell, triangles },
        )?;
    }
    let mut outside = Vec::new();
    for attempt in 0..SAMPLES {
        samples.retain(|sample| attempt < sample.triangles.len());
        if samples.is_empty() {
            break;
        }
        for sample in &mut samples {
            // Triangles of a fan share their first corner.
            sample.place = vertices[sample.triangles[attempt][attempt % 3] as usize];
            (sample.winding, sample.on_surface) = (0, false);
        }
        samples.sort_unstable_by(|a, b| a.place[2].total_cmp(&b.place[2]).then(a.shell.cmp(&b.shell)));
        for triangle in surface {
            let corners = triangle.each(|v| vertices[v as usize]);
            let low = corners.iter().fold(f64::INFINITY, |low, p| low.min(p[2]));
            let high = corners.iter().fold(f64::NEG_INFINITY, |high, p| high.max(p[2]));
            let start = samples.partition_point(|sample| sample.place[2] < low);
            for sample in samples[start..].iter_mut().take_while(|sample| sample.place[2] <= high) {
                match crossing(corners, sample.place) {
                    Some(sense) => sample.winding += sense,
                    None => sample.on_surface = true,
                }
            }
        }
        for sample in samples.iter().filter(|sample| !sample.on_surface && sample.winding < 1) {
            memory::push(&mut outside, sample.shell)?;
        }
        samples.retain(|sample| sample.on_surface);
    }
    outside.sort_unstable();
    Ok(outside)
}

/// Returns the contribution of a triangle to the winding number at `p`, by the ray from `p` along the first
/// axis: 1 if the ray leaves through the triangle, -1 if it enters, 0 if it misses. `None` if `p` lies on the
/// triangle.
///
/// Rays through edges and corners count as slightly shifted along the other two axes, in the same way for all
/// triangles.
fn crossing(corners: [[f64; 3]; 3], p: [f64; 3]) -> Option<i32> {
    let flat = |p: [f64; 3]| Coord { x: p[1], y: p[2] };
    let mut around = 0;
    let mut touched = false;
    for k in 0..3 {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        let side = orient2d(flat(a), flat(b), flat(p));
        if side == 0.0 {
            // On the line through the edge. Off the plane, it does not matter whether it is between the
            // edge's ends.
            touched = true;
        }
        if a[2] <= p[2] && b[2] > p[2] && side > 0.0 {
            around += 1;
        } else if b[2] <= p[2] && a[2] > p[2] && side < 0.0 {
            around -= 1;
        }
    }
    if around == 0 && !touched {
        return Some(0);
    }
    let solid = |[x, y, z]: [f64; 3]| Coord3D { x, y, z };
    // Positive if p lies below the triangle, seen with its corners counter-clockwise.
    let below = orient3d(solid(corners[0]), solid(corners[1]), solid(corners[2]), solid(p));
    if below == 0.0 && holds(corners, p) {
        return None;
    }
    let ahead = if around > 0 { below > 0.0 } else { below < 0.0 };
    Some(if ahead { around } else { 0 })
}

/// Returns whether a point of a triangle's plane lies within the triangle's bounds. It may still lie beside
/// the triangle.
fn holds(corners: [[f64; 3]; 3], p: [f64; 3]) -> bool {
    Extent::of(corners.into_iter()).hold(&Extent { low: p, high: p })
}

/// Returns the volume that triangles enclose, computed from differences to the centre of their bounds.
pub(crate) fn volume(vertices: &[[f64; 3]], triangles: &[[u32; 3]], bounds: &Extent) -> f64 {
    let centre = axes(|axis| bounds.low[axis].midpoint(bounds.high[axis]));
    let six_fold: f64 = (triangles.iter())
        .map(|triangle| {
            let [a, b, c] = triangle.each(|v| {
                let p = vertices[v as usize];
                [p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]]
            });
            (0..3)
                .map(|axis| {
                    let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
                    a[axis] * (b[u] * c[v] - b[v] * c[u])
                })
                .sum::<f64>()
        })
        .sum();
    six_fold / 6.0
}

/// The bounding box of points: the least and the greatest coordinates.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Extent {
    low: [f64; 3],
    high: [f64; 3],
}

impl Extent {
    pub(crate) fn of(points: impl Iterator<Item = [f64; 3]>) -> Extent {
        let mut bounds = Extent { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };
        for p in points {
            for axis in 0..3 {
                bounds.low[axis] = bounds.low[axis].min(p[axis]);
                bounds.high[axis] = bounds.high[axis].max(p[axis]);
            }
        }
        bounds
    }

    /// Returns the longest of the three extents.
    pub(crate) fn longest(&self) -> f64 {
        (0..3).fold(0.0, |most: f64, axis| most.max(self.high[axis] - self.low[axis]))
    }

    pub(crate) fn hold(&self, other: &Extent) -> bool {
        (0..3).all(|axis| self.low[axis] <= other.low[axis] && other.high[axis] <= self.high[axis])
    }
}
