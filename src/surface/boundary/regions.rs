//! Faces of a boundary: connected parts on one surface, plane ones as polygons.

use super::edges::NONE;
use super::mates::mates;
use super::patches::area;
use crate::error::{Error, MeshError};
use crate::lattice::Each;
use crate::lattice::axes;
use crate::memory;
use crate::mesh::polygon::{PolygonDefect, triangulate};
use crate::mesh::{DisjointSets, Extent, PLANE, PolyhedronArrays, TriangleMesh, flatness, outside, volume};
use crate::solid::PlacedHalfSpace;
use alloc::vec::Vec;
use core::ops::Range;

/// The faces of a boundary, in the form of a boundary representation.
///
/// A *region* is a part of the mesh on one surface that is connected through edges. On a plane it is one
/// face: an outer loop, which runs counter-clockwise as seen from outside the solid, and a loop in the other
/// direction around each hole. On a curved surface the triangles of the region are the faces. Two faces that
/// meet in an edge have the same vertices there, so each edge of a loop is used exactly once more, in the
/// opposite direction. Where two plane faces meet, only the ends of the edge are vertices.
///
/// A plane region also becomes triangles if its loops touch each other along edges (as they do where the
/// solid touches itself), or if its corners deviate from one plane by more than 10^-9 of the solid's extent.
///
/// The connected parts of the boundary are shells. A shell around a void belongs to the smallest solid that
/// contains it.
#[derive(Debug, Clone)]
pub struct BoundaryFaces {
    vertices: Vec<[f64; 3]>,
    corners: Vec<u32>,
    loops: Vec<u32>,
    faces: Vec<u32>,
    shells: Vec<u32>,
    solids: Vec<u32>,
    regions: Vec<BoundaryRegion>,
    of_triangles: Vec<u32>,
}

/// A connected part of the boundary on one surface.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundaryRegion {
    /// The surface, as a number in [`Boundary::surfaces`](super::Boundary::surfaces); `None` where the
    /// boundary is only known to a cell.
    pub surface: Option<u32>,
    /// The faces of the region.
    pub faces: Range<u32>,
    /// The number of triangles of the mesh in the region.
    pub triangles: u32,
    /// The area of these triangles, in squared model units.
    pub area: f64,
    /// Whether the surface's normal ([`SurfaceShape::normal`](crate::solid::SurfaceShape::normal)) points
    /// into the solid. It does in a bore, where it points away from the axis.
    pub is_turned: bool,
}

impl BoundaryFaces {
    /// The faces as arrays, the input of [`Polyhedron`](crate::mesh::Polyhedron) and
    /// [`write_polygons`](crate::exchange::write_polygons). Without faces there is no solid, and both
    /// functions refuse the arrays.
    pub fn arrays(&self) -> PolyhedronArrays<'_> {
        PolyhedronArrays {
            vertices: &self.vertices,
            corners: &self.corners,
            loops: &self.loops,
            faces: &self.faces,
            shells: &self.shells,
            solids: &self.solids,
        }
    }

    /// The regions, in the order of their faces. Each face belongs to one region.
    pub fn regions(&self) -> &[BoundaryRegion] {
        &self.regions
    }

    /// The number of the region of each triangle of the mesh.
    pub fn of_triangles(&self) -> &[u32] {
        &self.of_triangles
    }

    /// Returns the number of the region to which a face belongs; `None` if there is no such face.
    pub fn region_of(&self, face: u32) -> Option<u32> {
        let number = self.regions.partition_point(|region| region.faces.end <= face);
        self.regions.get(number).map(|_| number as u32)
    }

    /// Finds the faces of a mesh whose triangles lie on surfaces.
    pub(super) fn find(
        mesh: &TriangleMesh,
        surfaces: &[PlacedHalfSpace],
        of_triangles: &[u32],
    ) -> Result<BoundaryFaces, Error> {
        let (triangles, vertices) = (mesh.triangles(), mesh.vertices());
        let mates = match mates(triangles)? {
            Some(mates) => mates,
            None => memory::filled(triangles.len(), [NONE; 3])?,
        };
        let (mut sets, mut shells) =
            (DisjointSets::new(triangles.len())?, DisjointSets::new(triangles.len())?);
        for (number, mates) in (0u32..).zip(&mates) {
            for &mate in mates.iter().filter(|&&mate| mate != NONE) {
                shells.unite(number, mate);
                if of_triangles[number as usize] == of_triangles[mate as usize] {
                    sets.unite(number, mate);
                }
            }
        }
        let (sets, shells) = (sets.numbers(), shells.numbers());
        let shells = Groups::new(&shells)?;
        let mut faces = BoundaryFaces {
            vertices: memory::copied(vertices)?,
            corners: Vec::new(),
            loops: memory::filled(1, 0)?,
            faces: memory::filled(1, 0)?,
            shells: memory::filled(1, 0)?,
            solids: memory::filled(1, 0)?,
            regions: Vec::new(),
            of_triangles: memory::filled(triangles.len(), 0)?,
        };
        let extent = Extent::of(vertices.iter().copied()).longest();
        let regions = Groups::new(&sets)?;
        let used = memory::filled(triangles.len(), [false; 3])?;
        let mut tracer = Tracer { triangles, mates: &mates, regions: &sets, used };
        for solid in solids(mesh, &shells)? {
            for shell in solid {
                // Regions are numbered by their first triangles, so the regions of a shell are in order.
                for &first in shells.of(shell) {
                    let own = regions.of(sets[first as usize]);
                    if own[0] == first {
                        let surface = of_triangles[first as usize];
                        faces.add_region(&mut tracer, own, surface, surfaces, extent)?;
                    }
                }
                memory::push(&mut faces.shells, faces.faces.len() as u32 - 1)?;
            }
            memory::push(&mut faces.solids, faces.shells.len() as u32 - 1)?;
        }
        Ok(faces)
    }

    fn add_region(
        &mut self,
        tracer: &mut Tracer<'_>,
        own: &[u32],
        surface: u32,
        surfaces: &[PlacedHalfSpace],
        extent: f64,
    ) -> Result<(), Error> {
        let placed = surfaces.get(surface as usize);
        let shape = placed.map(PlacedHalfSpace::shape).transpose()?;
        let first = self.faces.len() as u32 - 1;
        let polygon = match placed.is_some_and(PlacedHalfSpace::is_flat) {
            true => tracer.polygon(own, &self.vertices, PLANE * extent)?,
            false => None,
        };
        match polygon {
            Some((corners, ends)) => self.add_face(&corners, &ends)?,
            None => {
                for &triangle in own {
                    self.add_face(&tracer.triangles[triangle as usize], &[3])?;
                }
            }
        }
        let (mut area, mut outward) = (0.0, 0.0);
        for &triangle in own {
            self.of_triangles[triangle as usize] = self.regions.len() as u32;
            let [a, b, c] = tracer.triangles[triangle as usize].each(|v| self.vertices[v as usize]);
            let [p, q]: [[f64; 3]; 2] = [axes(|k| b[k] - a[k]), axes(|k| c[k] - a[k])];
            let across: [f64; 3] =
                axes(|k| p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3]);
            area += 0.5 * libm::sqrt(across.iter().map(|c| c * c).sum());
            let middle = axes(|k| (a[k] + b[k] + c[k]) / 3.0);
            if let Some(normal) = shape.and_then(|shape| shape.normal(middle)) {
                outward += (0..3).map(|k| across[k] * normal[k]).sum::<f64>();
            }
        }
        let region = BoundaryRegion {
            surface: Some(surface).filter(|&surface| surface != NONE),
            faces: first..self.faces.len() as u32 - 1,
            triangles: own.len() as u32,
            area,
            is_turned: outward < 0.0,
        };
        memory::push(&mut self.regions, region)
    }

    /// Adds a face of loops; `ends` holds the end of each loop in `corners`.
    fn add_face(&mut self, corners: &[u32], ends: &[usize]) -> Result<(), Error> {
        let before = self.corners.len();
        self.corners.try_reserve(corners.len())?;
        self.corners.extend_from_slice(corners);
        if u32::try_from(self.corners.len()).is_err() {
            return Err(MeshError::TooMany.into());
        }
        for end in ends {
            memory::push(&mut self.loops, (before + end) as u32)?;
        }
        memory::push(&mut self.faces, self.loops.len() as u32 - 1)
    }
}

/// Triangles by groups.
struct Groups {
    starts: Vec<usize>,
    triangles: Vec<u32>,
}

impl Groups {
    /// Groups triangles by the number of each triangle's group. Groups are numbered by their first triangles.
    fn new(numbers: &[u32]) -> Result<Groups, Error> {
        let mut triangles = memory::collected(0..numbers.len() as u32)?;
        triangles.sort_by_key(|&triangle| numbers[triangle as usize]);
        let mut starts = memory::filled(1, 0)?;
        for own in triangles.chunk_by(|&a, &b| numbers[a as usize] == numbers[b as usize]) {
            let end = starts[starts.len() - 1] + own.len();
            memory::push(&mut starts, end)?;
        }
        Ok(Groups { starts, triangles })
    }

    fn count(&self) -> u32 {
        self.starts.len() as u32 - 1
    }

    /// The triangles of a group, in ascending order.
    fn of(&self, group: u32) -> &[u32] {
        &self.triangles[self.starts[group as usize]..self.starts[group as usize + 1]]
    }
}

/// The shells of each solid, the outer one first.
fn solids(mesh: &TriangleMesh, shells: &Groups) -> Result<Vec<Vec<u32>>, Error> {
    let (vertices, triangles) = (mesh.vertices(), mesh.triangles());
    let mut own: Vec<Vec<[u32; 3]>> = Vec::new();
    let mut sizes: Vec<(f64, Extent)> = Vec::new();
    for shell in 0..shells.count() {
        let list = memory::collected(shells.of(shell).iter().map(|&number| triangles[number as usize]))?;
        let extent = Extent::of(list.iter().flatten().map(|&v| vertices[v as usize]));
        memory::push(&mut sizes, (volume(vertices, &list, &extent), extent))?;
        memory::push(&mut own, list)?;
    }
    // The solid of each void: the smallest solid that contains it.
    let mut around: Vec<Option<u32>> = memory::filled(own.len(), None)?;
    let size = |shell: u32| sizes[shell as usize].0;
    let mut outer = memory::collected(0..own.len() as u32)?;
    outer.retain(|&shell| size(shell) >= 0.0);
    outer.sort_by(|&a, &b| size(a).total_cmp(&size(b)));
    let mut left = memory::collected(0..own.len())?;
    left.retain(|&shell| sizes[shell].0 < 0.0);
    for shell in outer {
        let mut inner = memory::copied(&left)?;
        inner.retain(|&void| sizes[shell as usize].1.hold(&sizes[void].1));
        let voids = inner.iter().map(|&void| (void, &own[void][..]));
        let not_held = outside(vertices, &own[shell as usize], voids)?;
        inner.retain(|void| not_held.binary_search(void).is_err());
        inner.iter().for_each(|&void| around[void] = Some(shell));
        left.retain(|&void| around[void].is_none());
    }
    let mut solids: Vec<Vec<u32>> = Vec::new();
    let mut places = memory::filled(own.len(), 0)?;
    for shell in (0..own.len()).filter(|&shell| around[shell].is_none()) {
        places[shell] = solids.len();
        memory::push(&mut solids, memory::filled(1, shell as u32)?)?;
    }
    for (void, outer) in (0..).zip(&around) {
        if let Some(outer) = outer {
            memory::push(&mut solids[places[*outer as usize]], void)?;
        }
    }
    Ok(solids)
}

/// Traces the sides between regions.
struct Tracer<'m> {
    triangles: &'m [[u32; 3]],
    mates: &'m [[u32; 3]],
    /// The region of each triangle.
    regions: &'m [u32],
    /// The sides that already belong to a loop.
    used: Vec<[bool; 3]>,
}

/// The corners of loops, and the end of each loop.
type Polygon = (Vec<u32>, Vec<usize>);

impl Tracer<'_> {
    /// The triangle of the same region across a side.
    fn beside(&self, triangle: u32, side: usize) -> Option<u32> {
        let mate = self.mates[triangle as usize][side];
        let is_same = mate != NONE && self.regions[mate as usize] == self.regions[triangle as usize];
        is_same.then_some(mate)
    }

    /// The side that follows on the region's boundary: the next boundary side around the vertex, found
    /// without leaving the region.
    fn next(&self, (mut triangle, mut side): (u32, usize)) -> (u32, usize) {
        side = (side + 1) % 3;
        while let Some(mate) = self.beside(triangle, side) {
            let vertex = self.triangles[triangle as usize][side];
            side = self.triangles[mate as usize].iter().position(|&v| v == vertex).unwrap_or(0);
            triangle = mate;
        }
        (triangle, side)
    }

    /// The loops of a region, the outer one first; `None` if they do not bound a polygon.
    fn polygon(
        &mut self,
        own: &[u32],
        vertices: &[[f64; 3]],
        tolerance: f64,
    ) -> Result<Option<Polygon>, Error> {
        let mut loops: Vec<Vec<u32>> = Vec::new();
        for start in own.iter().flat_map(|&triangle| [0, 1, 2].each(|side| (triangle, side))) {
            if self.beside(start.0, start.1).is_some() {
                continue;
            }
            let mut corners = Vec::new();
            let mut at = start;
            while !core::mem::replace(&mut self.used[at.0 as usize][at.1], true) {
                memory::push(&mut corners, self.triangles[at.0 as usize][at.1])?;
                at = self.next(at);
            }
            if !corners.is_empty() {
                memory::push(&mut loops, corners)?;
            }
        }
        // The outer loop has the orientation of the sum of all areas.
        let areas = memory::collected(loops.iter().map(|corners| area(corners, vertices)))?;
        let whole = areas.iter().fold([0.0; 3], |sum: [f64; 3], own| axes(|k| sum[k] + own[k]));
        let along = |loop_: usize| (0..3).map(|k| areas[loop_][k] * whole[k]).sum::<f64>();
        let Some(outer) = (0..loops.len()).max_by(|&a, &b| along(a).total_cmp(&along(b)).then(b.cmp(&a)))
        else {
            return Ok(None);
        };
        loops.swap(0, outer);
        let (mut corners, mut ends) = (Vec::new(), Vec::new());
        for own in &loops {
            corners.try_reserve(own.len())?;
            corners.extend_from_slice(own);
            memory::push(&mut ends, corners.len())?;
        }
        if corners.len() == 3 {
            return Ok(Some((corners, ends)));
        }
        let is_flat = flatness(vertices, &loops[0], &corners).is_some_and(|(apart, _)| apart <= tolerance);
        match triangulate(vertices, &corners, &ends, &mut Vec::new()) {
            Err(PolygonDefect::OutOfMemory) => Err(Error::OutOfMemory),
            Ok(()) if is_flat => Ok(Some((corners, ends))),
            _ => Ok(None),
        }
    }
}
