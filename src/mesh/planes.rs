//! The planes of a mesh's triangles.
//!
//! A CAD program writes a plane face as many triangles, whose corners are rounded. Here such triangles share
//! one plane, with enough width for the rounding.

use super::intersections::corners;
use super::triangle_mesh::TriangleMesh;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::memory;
use alloc::vec::Vec;
use hashbrown::HashMap;

/// A plane through triangles that face the same side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FacetPlane {
    /// The direction that the triangles face, of about unit length.
    pub(crate) normal: [f64; 3],
    /// The least and the greatest [`along`](Self::along) of the triangles' corners.
    pub(crate) low: f64,
    pub(crate) high: f64,
    /// About the area of the triangles.
    pub(crate) area: f64,
}

impl FacetPlane {
    /// Returns the coordinate of a point along the normal.
    #[inline]
    pub(crate) fn along(&self, [x, y, z]: [f64; 3]) -> f64 {
        let [a, b, c] = self.normal;
        (a * x + b * y) + c * z
    }

    /// Returns whether the triangles lie exactly in a plane of constant x, y or z. Triangles that face either
    /// side share such a plane; its normal is that axis.
    pub(crate) fn is_exact(&self) -> bool {
        self.low == self.high && self.normal.iter().filter(|c| **c == 0.0).count() == 2
    }

    fn with(&self, corners: [[f64; 3]; 3]) -> FacetPlane {
        let along = corners.each(|corner| self.along(corner));
        let area = self.area + 0.5 * sqrt(square(twice_area(corners)));
        let (low, high) =
            along.into_iter().fold((self.low, self.high), |(low, high), a| (low.min(a), high.max(a)));
        FacetPlane { low, high, area, ..*self }
    }

    fn width(&self) -> f64 {
        self.high - self.low
    }
}

/// The planes of a mesh.
#[derive(Debug, Default)]
pub(crate) struct FacetPlanes {
    /// The number of each triangle's plane.
    of: Vec<u32>,
    pub(crate) planes: Vec<FacetPlane>,
}

/// Maximum width of a plane, relative to the greatest coordinate: four times the error of positions in single
/// precision.
const WIDTH: f64 = 1.0 / (1u64 << 22) as f64;

/// Planes are compared if their normals and offsets lie in one cell of this grid.
const GRAIN: f64 = 1.0 / (1u64 << 16) as f64;

const NONE: u32 = u32::MAX;

impl FacetPlanes {
    /// Returns the bytes that the lists take.
    pub(crate) fn bytes(&self) -> usize {
        memory::bytes_of(&self.of) + memory::bytes_of(&self.planes)
    }

    /// Returns the number of a triangle's plane.
    #[inline]
    pub(crate) fn of(&self, triangle: u32) -> u32 {
        self.of[triangle as usize]
    }

    /// Finds the planes, starting from the largest triangles. Each plane grows over triangles with a common
    /// edge as long as it stays narrow, and is then joined to a plane in which it lies. Without
    /// `may_be_exact`, no plane is a plane of constant x, y or z.
    ///
    /// O(t log t).
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], and [`Error::Cancelled`] by `control`.
    pub(crate) fn new(
        mesh: &TriangleMesh,
        may_be_exact: bool,
        control: &Control<'_>,
    ) -> Result<FacetPlanes, Error> {
        let count = mesh.triangles().len();
        let reach = mesh.vertices().iter().flatten().fold(0.0, |most: f64, c| most.max(c.abs()));
        let mut areas = memory::with_capacity(count)?;
        areas.extend((0..count as u32).map(|triangle| twice_area(corners(mesh, triangle))));
        let mut order: Vec<u32> = memory::collected(0..count as u32)?;
        let size = |triangle: u32| square(areas[triangle as usize]);
        order.sort_unstable_by(|&a, &b| size(b).total_cmp(&size(a)).then(a.cmp(&b)));
        let growth = Growth { mesh, areas, around: Around::new(mesh)?, most: WIDTH * reach };
        let mut own = FacetPlanes { of: memory::filled(count, NONE)?, planes: Vec::new() };
        let mut known: HashMap<[i64; 4], u32> = HashMap::new();
        let mut members = Vec::new();
        for (done, &seed) in order.iter().enumerate() {
            if done % 4096 == 0 {
                control.check()?;
            }
            if own.of[seed as usize] != NONE {
                continue;
            }
            let next = own.planes.len() as u32;
            known.try_reserve(1)?;
            if let Some(plane) = growth.exact(seed).filter(|_| may_be_exact) {
                let axis = plane.normal.iter().position(|c| *c != 0.0).unwrap_or(0) as i64;
                let key = [i64::MIN, axis, (plane.low + 0.0).to_bits() as i64, 0];
                let number = *known.entry(key).or_insert(next);
                if number == next {
                    memory::push(&mut own.planes, FacetPlane { area: 0.0, ..plane })?;
                }
                own.planes[number as usize].area += plane.area;
                own.of[seed as usize] = number;
                continue;
            }
            let plane = growth.grown(seed, next, may_be_exact, &mut own.of, &mut members)?;
            let scale = 1.0 / (GRAIN * reach);
            let key = [
                plane.normal[0] / GRAIN,
                plane.normal[1] / GRAIN,
                plane.normal[2] / GRAIN,
                plane.low * scale,
            ]
            .each(|c| libm::round(c) as i64);
            let number = *known.entry(key).or_insert(next);
            if number != next {
                let before = own.planes[number as usize];
                let joined = members.iter().fold(before, |all, &t| all.with(corners(mesh, t)));
                if joined.width() <= growth.most {
                    own.planes[number as usize] = joined;
                    members.iter().for_each(|&t| own.of[t as usize] = number);
                    continue;
                }
            }
            memory::push(&mut own.planes, plane)?;
        }
        Ok(own)
    }
}

/// The data for growing planes.
struct Growth<'m> {
    mesh: &'m TriangleMesh,
    /// The normal of each triangle; its length is twice the area.
    areas: Vec<[f64; 3]>,
    around: Around,
    most: f64,
}

impl Growth<'_> {
    /// Returns the plane of constant x, y or z in which all corners of a triangle lie.
    fn exact(&self, triangle: u32) -> Option<FacetPlane> {
        let [a, b, c] = corners(self.mesh, triangle);
        let axis = (0..3).find(|&k| a[k] == b[k] && b[k] == c[k])?;
        let mut normal = [0.0; 3];
        normal[axis] = 1.0;
        let area = 0.5 * sqrt(square(twice_area([a, b, c])));
        Some(FacetPlane { normal, low: a[axis], high: a[axis], area })
    }

    /// Returns the plane of a triangle and of all triangles connected with it in that plane; `members`
    /// receives them.
    fn grown(
        &self,
        seed: u32,
        number: u32,
        leaves_exact: bool,
        of: &mut [u32],
        members: &mut Vec<u32>,
    ) -> Result<FacetPlane, Error> {
        members.clear();
        let empty = |normal| FacetPlane { normal, low: f64::INFINITY, high: f64::NEG_INFINITY, area: 0.0 };
        let mut plane = empty(unit(self.areas[seed as usize])).with(corners(self.mesh, seed));
        let mut sum = [0.0; 3];
        memory::push(members, seed)?;
        of[seed as usize] = number;
        let mut next = 0;
        while let Some(&triangle) = members.get(next) {
            next += 1;
            (0..3).for_each(|k| sum[k] += self.areas[triangle as usize][k]);
            let [a, b, c] = self.mesh.triangles()[triangle as usize];
            for edge in [[a, b], [b, c], [c, a]] {
                for other in self.around.edge(self.mesh, edge) {
                    if of[other as usize] != NONE || leaves_exact && self.exact(other).is_some() {
                        continue;
                    }
                    let wider = plane.with(corners(self.mesh, other));
                    if wider.width() <= self.most && self.faces(other, &plane.normal) {
                        plane = wider;
                        of[other as usize] = number;
                        memory::push(members, other)?;
                    }
                }
            }
        }
        // The mean normal is usually the better one.
        let mean = members.iter().fold(empty(unit(sum)), |all, &t| all.with(corners(self.mesh, t)));
        Ok(if mean.width() < plane.width() { mean } else { plane })
    }

    /// Returns whether a triangle faces the side of a normal, or has no area.
    fn faces(&self, triangle: u32, normal: &[f64; 3]) -> bool {
        let area = self.areas[triangle as usize];
        (area[0] * normal[0] + area[1] * normal[1]) + area[2] * normal[2] >= 0.0
    }
}

/// The triangles at each vertex.
struct Around {
    first: Vec<u32>,
    triangles: Vec<u32>,
}

impl Around {
    fn new(mesh: &TriangleMesh) -> Result<Around, Error> {
        let mut first = memory::filled(mesh.vertices().len() + 1, 0u32)?;
        for &vertex in mesh.triangles().as_flattened() {
            first[vertex as usize + 1] += 1;
        }
        for vertex in 1..first.len() {
            first[vertex] += first[vertex - 1];
        }
        let mut next = memory::copied(&first)?;
        let mut triangles = memory::filled(3 * mesh.triangles().len(), 0)?;
        for (triangle, corners) in (0..).zip(mesh.triangles()) {
            for &vertex in corners {
                triangles[next[vertex as usize] as usize] = triangle;
                next[vertex as usize] += 1;
            }
        }
        Ok(Around { first, triangles })
    }

    /// Returns the triangles that have both ends of an edge, from the list of the end that has fewer.
    fn edge<'a>(&'a self, mesh: &'a TriangleMesh, ends: [u32; 2]) -> impl Iterator<Item = u32> + use<'a> {
        let list = |vertex: u32| {
            let [first, end] = [vertex as usize, vertex as usize + 1].each(|v| self.first[v] as usize);
            &self.triangles[first..end]
        };
        let [(own, other), (others, own_end)] = [(list(ends[0]), ends[1]), (list(ends[1]), ends[0])];
        let (list, end) = if own.len() <= others.len() { (own, other) } else { (others, own_end) };
        list.iter().copied().filter(move |&t| mesh.triangles()[t as usize].contains(&end))
    }
}

fn square([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y) + z * z
}

/// Returns the normal of a triangle; its length is twice the area.
fn twice_area([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let [u, v] = [b, c].each(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

/// Returns a direction of about unit length; an axis if the vector has no direction.
fn unit(area: [f64; 3]) -> [f64; 3] {
    let most = area.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    if !(most > 0.0 && most.is_finite()) {
        return [0.0, 0.0, 1.0];
    }
    let scaled = area.each(|c| c / most);
    let length = sqrt(square(scaled));
    scaled.each(|c| c / length)
}
