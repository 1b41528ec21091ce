//! Triangles of polygons: plane faces as a whole, curved faces cell by cell.

use super::cells::{Pieces, Polygon};
use super::edges::NONE;
use super::figures::{Figures, Shape};
use super::leaves::Refused;
use super::strips;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::memory;
use crate::mesh::polygon::triangulate;
use alloc::vec::Vec;
use hashbrown::HashMap;

/// Triangles with the surface of each.
#[derive(Default)]
pub(super) struct Patches {
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) surfaces: Vec<u32>,
}

/// A part of the boundary on one plane.
struct Region {
    surface: u32,
    /// The loops one after the other, and the end of each; the outer loop comes first.
    corners: Vec<u32>,
    ends: Vec<usize>,
}

impl Patches {
    /// Makes the triangles of curved polygons, and takes over the separate triangles. Cells whose triangles
    /// are further from the surface than the tolerance are added to `refused`.
    pub(super) fn of_curves(
        pieces: &Pieces,
        figures: &Figures,
        vertices: &[[f64; 3]],
        (tolerance, depth): (f64, u8),
        refused: &mut Refused,
    ) -> Result<Patches, Error> {
        let mut patches = Patches::default();
        for &(triangle, surface, _) in &pieces.triangles {
            patches.add(triangle, surface)?;
        }
        let mut triangles = Vec::new();
        for polygon in pieces.polygons.iter().filter(|polygon| figures.shape(polygon.surface) != Shape::Plane)
        {
            triangles.clear();
            let (surface, corners) = (polygon.surface, pieces.corners(polygon));
            let away = strips::triangulate(figures, surface, corners, vertices, &mut triangles)?;
            if away > tolerance && polygon.cell.level < depth {
                refused.add(polygon.cell)?;
            }
            for &triangle in &triangles {
                patches.add(triangle, surface)?;
            }
        }
        Ok(patches)
    }

    /// Adds the triangles of plane faces.
    pub(super) fn add_planes(
        &mut self,
        pieces: &Pieces,
        figures: &Figures,
        vertices: &[[f64; 3]],
    ) -> Result<(), Error> {
        let mut of_planes: Vec<&Polygon> = Vec::new();
        for polygon in pieces.polygons.iter().filter(|polygon| figures.shape(polygon.surface) == Shape::Plane)
        {
            memory::push(&mut of_planes, polygon)?;
        }
        of_planes.sort_by_key(|polygon| polygon.surface);
        let mut regions = Vec::new();
        for polygons in of_planes.chunk_by(|a, b| a.surface == b.surface) {
            merge(polygons[0].surface, polygons, pieces, vertices, &mut regions)?;
        }
        let straight = straight(&regions, self, vertices.len())?;
        for mut region in regions {
            region.drop_corners(&straight);
            let mut triangles = Vec::new();
            if triangulate(vertices, &region.corners, &region.ends, &mut triangles).is_err() {
                self.fan(&region)?;
                continue;
            }
            for triangle in triangles {
                self.add(triangle, region.surface)?;
            }
        }
        Ok(())
    }

    fn add(&mut self, triangle: [u32; 3], surface: u32) -> Result<(), Error> {
        memory::push(&mut self.triangles, triangle)?;
        memory::push(&mut self.surfaces, surface)
    }

    fn fan(&mut self, region: &Region) -> Result<(), Error> {
        let mut start = 0;
        for &end in &region.ends {
            let corners = &region.corners[start..end];
            for k in 1..corners.len().saturating_sub(1) {
                self.add([corners[0], corners[k], corners[k + 1]], region.surface)?;
            }
            start = end;
        }
        Ok(())
    }
}

/// The representative of a group: its least number.
fn root(groups: &mut [u32], mut k: u32) -> u32 {
    while groups[k as usize] != k {
        groups[k as usize] = groups[groups[k as usize] as usize];
        k = groups[k as usize];
    }
    k
}

/// Merges polygons on one plane into regions: common sides of two polygons are no boundary.
fn merge(
    surface: u32,
    polygons: &[&Polygon],
    pieces: &Pieces,
    vertices: &[[f64; 3]],
    regions: &mut Vec<Region>,
) -> Result<(), Error> {
    // The sides, each with its polygon.
    let mut sides: HashMap<(u32, u32), u32> = HashMap::new();
    let mut groups: Vec<u32> = memory::collected(0..polygons.len() as u32)?;
    for (number, polygon) in (0u32..).zip(polygons) {
        let corners = pieces.corners(polygon);
        for k in 0..corners.len() {
            let (from, to) = (corners[k], corners[(k + 1) % corners.len()]);
            match sides.remove(&(to, from)) {
                Some(other) => {
                    let (a, b) = (root(&mut groups, number), root(&mut groups, other));
                    groups[a.max(b) as usize] = a.min(b);
                }
                None => {
                    sides.try_reserve(1)?;
                    sides.insert((from, to), number);
                }
            }
        }
    }
    // The remaining sides, by groups.
    let mut left = memory::with_capacity(sides.len())?;
    left.extend(sides.iter().map(|(&(from, to), &number)| (root(&mut groups, number), from, to)));
    left.sort_unstable();
    for sides in left.chunk_by(|a, b| a.0 == b.0) {
        let mut used = memory::filled(sides.len(), false)?;
        let mut loops: Vec<Vec<u32>> = Vec::new();
        for start in 0..sides.len() {
            let mut corners = Vec::new();
            let mut at = start;
            while !used[at] {
                used[at] = true;
                let (_, from, to) = sides[at];
                memory::push(&mut corners, from)?;
                let first = sides.partition_point(|side| side.1 < to);
                let next = (first..sides.len()).take_while(|&k| sides[k].1 == to).find(|&k| !used[k]);
                at = next.unwrap_or(start);
            }
            if !corners.is_empty() {
                memory::push(&mut loops, corners)?;
            }
        }
        // The outer loop encloses the largest area.
        let size = |corners: &Vec<u32>| {
            let area = area(corners, vertices);
            area.iter().map(|c| c * c).sum::<f64>()
        };
        let outer =
            (0..loops.len()).fold(0, |best, k| if size(&loops[k]) > size(&loops[best]) { k } else { best });
        loops.swap(0, outer);
        let mut region = Region { surface, corners: Vec::new(), ends: Vec::new() };
        for corners in loops {
            region.corners.try_reserve(corners.len())?;
            region.corners.extend(corners);
            memory::push(&mut region.ends, region.corners.len())?;
        }
        memory::push(regions, region)?;
    }
    Ok(())
}

/// Twice the area of a loop, along its normal.
pub(super) fn area(corners: &[u32], vertices: &[[f64; 3]]) -> [f64; 3] {
    let origin = vertices[corners[0] as usize];
    let mut sum = [0.0; 3];
    for pair in corners.windows(2) {
        let [p, q] = [pair[0], pair[1]].each(|v| axes(|k| vertices[v as usize][k] - origin[k]));
        sum = axes(|k| sum[k] + p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3]);
    }
    sum
}

/// Returns for each vertex whether only two plane regions meet there. Their edge is straight there.
fn straight(regions: &[Region], patches: &Patches, vertices: usize) -> Result<Vec<bool>, Error> {
    // The number of times a vertex is a corner, up to three, and the region of the first time.
    let mut seen = memory::filled(vertices, (0u8, NONE))?;
    for (number, region) in (0u32..).zip(regions) {
        for &corner in &region.corners {
            let entry = &mut seen[corner as usize];
            *entry = match *entry {
                (0, _) => (1, number),
                (1, first) if first != number => (2, first),
                _ => (3, NONE),
            };
        }
    }
    // Vertices of other triangles stay.
    for &corner in patches.triangles.as_flattened() {
        seen[corner as usize].0 = 3;
    }
    memory::collected(seen.into_iter().map(|(count, _)| count == 2))
}

impl Region {
    fn drop_corners(&mut self, straight: &[bool]) {
        let mut start = 0;
        let mut corners = Vec::new();
        for end in &mut self.ends {
            corners.extend(self.corners[start..*end].iter().filter(|&&corner| !straight[corner as usize]));
            start = *end;
            *end = corners.len();
        }
        self.corners = corners;
    }
}
