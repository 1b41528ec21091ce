//! Simplified meshes, with a proven bound of their distance from the original meshes.
//!
//! (Guéziec, *Locally toleranced surface simplification*, 1999; Borouchaki and Frey, *Simplification of
//! surface mesh using Hausdorff envelope*, 2005.)
//!
//! From the bottom up, each file uses only files named before it: `links` (triangles around vertices),
//! `sharp` (edges of the shape), `patch` (the movement of the surface), `collapse` (the choice of vertices).

mod collapse;
mod links;
mod patch;
mod sharp;

use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::valid;
use crate::memory;
use crate::mesh::{AttributeDomain, TriangleMesh};
use crate::query::meshes_apart;
use alloc::vec::Vec;
use collapse::Collapse;
use links::{Links, NONE};
pub(super) use sharp::Regions;

/// A mesh with fewer triangles, and a report.
pub struct Simplified {
    mesh: TriangleMesh,
    report: SimplifiedReport,
}

/// A report on a simplification.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SimplifiedReport {
    /// A proven bound of the distance of each mesh from the other one (model units).
    pub deviation: f64,
    /// The number of triangles that were removed.
    pub removed: u64,
    /// The number of pairs of intersecting triangles, counted as by [`TriangleMesh::intersecting_pairs`].
    pub intersecting_pairs: u64,
}

impl Simplified {
    /// The mesh.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// Returns the mesh.
    pub fn into_mesh(self) -> TriangleMesh {
        self.mesh
    }

    /// The report on the simplification.
    pub fn report(&self) -> &SimplifiedReport {
        &self.report
    }
}

/// The greatest number of intersecting pairs that one round examines.
const PAIRS: usize = 1 << 16;

/// The factor of a limit where the surface moved too far, and the least part of the tolerance below which a
/// limit becomes 0.
const HOLD: f64 = 0.5;
const LEAST: f64 = 0.1;

/// Returns the mesh with fewer triangles. No point of the result is further than `tolerance` (model units)
/// from the mesh, and no point of the mesh is further than that from the result.
///
/// Vertices are removed, and none is moved: first those whose removal moves the surface least. Edges between
/// triangles whose normals differ by more than 30 degrees stay edges, and so do edges between triangles with
/// different attribute values. Along an edge, vertices are removed as far as the tolerance allows; corners
/// stay. So a plane face becomes triangles between its corners, however it was divided, even if the tolerance
/// is only the rounding of the mesh.
///
/// The triangles stay connected as before: a closed mesh and a manifold stay so, with the same number of
/// bodies and holes. Vertices on open edges, and those where more than two triangles meet in an edge, stay.
/// No triangles intersect each other that did not intersect before. The result keeps the attribute values of
/// the remaining triangles ([`AttributeDomain::Triangle`]), and none of corners. Its
/// [deviation](TriangleMesh::deviation) is that of the mesh plus the bound proven here.
///
/// The deviation is proven in both directions from the triangles of both meshes, independently of the choice
/// of vertices. Where it is too large, the next round removes less.
///
/// O(n log n) for n triangles whose vertices have few triangles: about 20 µs and 300 bytes per triangle. One
/// thread removes vertices, and all threads prove. The result is the same for any number of threads.
///
/// (Guéziec, *Locally toleranced surface simplification*, 1999; Borouchaki and Frey, *Simplification of
/// surface mesh using Hausdorff envelope*, 2005.)
///
/// ```
/// use leafless::{Control, TriangleMesh, surface::simplify};
/// // A square pyramid, whose base has a vertex in the middle that is not needed.
/// let vertices = vec![[0., 0., 0.], [2., 0., 0.], [2., 2., 0.], [0., 2., 0.], [1., 1., 0.], [1., 1., 3.]];
/// let base = [[1, 0, 4], [2, 1, 4], [3, 2, 4], [0, 3, 4]];
/// let sides = [[0, 1, 5], [1, 2, 5], [2, 3, 5], [3, 0, 5]];
/// let mesh = TriangleMesh::new(vertices, [base, sides].concat())?;
/// let found = simplify(&mesh, 1e-9, &Control::default())?;
/// assert_eq!((found.mesh().triangles().len(), found.report().removed), (6, 2));
/// assert!(found.report().deviation <= 1e-9 && found.mesh().volume() == mesh.volume());
/// # Ok::<(), leafless::Error>(())
/// ```
///
/// # Errors
/// [`Error::Argument`] if `tolerance` is not between 2^-256 and 2^256; [`Error::OutOfMemory`], and
/// [`Error::Cancelled`].
pub fn simplify(mesh: &TriangleMesh, tolerance: f64, control: &Control<'_>) -> Result<Simplified, Error> {
    valid::length("tolerance", tolerance)?;
    let job = Job::new(control);
    job.check()?;
    let quiet = Control { progress: None, ..*control };
    let mut attributes = memory::with_capacity(mesh.attributes().len())?;
    for attribute in mesh.attributes().iter().filter(|own| own.domain() == AttributeDomain::Triangle) {
        attributes.push(attribute.try_clone()?);
    }
    let regions = Regions::Alike(&attributes);
    let mut reduction = Reduction::new(mesh, regions, tolerance)?;
    let mut is_first = true;
    let (mut simple, kept, deviation, intersecting_pairs) = loop {
        // (The number of rounds is not known in advance, so progress treats the first one as all.)
        let parts = if is_first { WHOLE / 2 } else { 0 };
        let (simple, kept, pairs) = reduction.run(&job, parts)?;
        let (most, beyond) = match is_first {
            true => control.share([0.5, 1.0], |control| meshes_apart(mesh, &simple, tolerance, control))?,
            false => meshes_apart(mesh, &simple, tolerance, &quiet)?,
        };
        is_first = false;
        if most <= tolerance || !reduction.hold(beyond.into_iter().map(|triangle| kept[triangle as usize]))? {
            break (simple, kept, most, pairs);
        }
    };
    for mut attribute in attributes {
        let mut next = 0;
        attribute.retain(|triangle| {
            let is_kept = kept.get(next) == Some(&(triangle as u32));
            next += usize::from(is_kept);
            is_kept
        });
        simple.add_attribute(attribute)?;
    }
    let stated = mesh.radius();
    if deviation.is_finite() {
        simple =
            simple.with_deviation(if stated > 0.0 { (stated + deviation).next_up() } else { deviation })?;
    }
    let removed = (mesh.triangles().len() - kept.len()) as u64;
    job.finish();
    Ok(Simplified { mesh: simple, report: SimplifiedReport { deviation, removed, intersecting_pairs } })
}

/// The repeated reduction of a mesh until the result is good enough.
pub(super) struct Reduction<'r> {
    mesh: &'r TriangleMesh,
    regions: Regions<'r>,
    /// The greatest movement of the surface at each vertex (model units). Vertices with 0 stay.
    limits: Vec<f64>,
    /// The least limit other than 0.
    least: f64,
    /// The vertex onto which each vertex was collapsed in the last round, and the remaining links.
    went: Vec<u32>,
    left: Option<Links>,
}

impl<'r> Reduction<'r> {
    /// Sides between different regions are edges of the shape. The tolerance is in model units.
    pub(super) fn new(mesh: &'r TriangleMesh, regions: Regions<'r>, tolerance: f64) -> Result<Self, Error> {
        let limits = memory::filled(mesh.vertices().len(), tolerance)?;
        Ok(Reduction { mesh, regions, limits, least: LEAST * tolerance, went: Vec::new(), left: None })
    }

    /// Fixes vertices.
    pub(super) fn keep(&mut self, is_kept: &[bool]) {
        for (limit, &is_kept) in self.limits.iter_mut().zip(is_kept) {
            *limit = if is_kept { 0.0 } else { *limit };
        }
    }

    /// Returns the mesh with fewer triangles, the numbers of the remaining triangles, and the number of
    /// intersecting pairs. Progress advances by `parts`.
    pub(super) fn run(
        &mut self,
        job: &Job<'_>,
        mut parts: usize,
    ) -> Result<(TriangleMesh, Vec<u32>, u64), Error> {
        let (mesh, vertices) = (self.mesh, self.mesh.vertices());
        let quiet = Control { progress: None, ..*job.control() };
        loop {
            let mut links = Links::new(vertices.len(), memory::copied(mesh.triangles())?)?;
            sharp::mark(&mut links, vertices, self.regions)?;
            let mut collapse = Collapse::new(links, vertices, &self.limits)?;
            collapse.run(job, parts / 2)?;
            let (simple, kept) = self.assemble(&collapse.links)?;
            (self.went, self.left) = (collapse.went, Some(collapse.links));
            let found = simple.intersecting_pairs(PAIRS, &quiet)?;
            job.advance(parts - parts / 2);
            parts = 0;
            let meet = found.pairs.iter().flat_map(|pair| pair.triangles).map(|own| kept[own as usize]);
            if !self.change(meet, |_| 0.0)? {
                return Ok((simple, kept, found.count));
            }
        }
    }

    /// Lets the surface move less next to some triangles in the next round; `false` if it did not move there.
    pub(super) fn hold(&mut self, triangles: impl Iterator<Item = u32>) -> Result<bool, Error> {
        let least = self.least;
        self.change(triangles, |limit| if limit > least { HOLD * limit } else { 0.0 })
    }

    /// Changes the limits of the removed vertices that lay over some triangles, or, if there are none, of all
    /// vertices that were collapsed onto the triangles' corners. `false` if there are none.
    fn change(
        &mut self,
        triangles: impl Iterator<Item = u32>,
        to: impl Fn(f64) -> f64,
    ) -> Result<bool, Error> {
        let Some(left) = &self.left else { return Ok(false) };
        let count = self.limits.len();
        let (mut is_chosen, mut is_corner) = (memory::filled(count, false)?, memory::filled(count, false)?);
        for triangle in triangles.map(|triangle| triangle as usize) {
            let mut is_any = false;
            for gone in left.gone(triangle).map(|gone| gone as usize).filter(|&gone| gone < count) {
                is_any |= self.limits[gone] > 0.0;
                is_chosen[gone] = true;
            }
            if !is_any {
                left.triangles[triangle].iter().for_each(|&vertex| is_corner[vertex as usize] = true);
            }
        }
        let mut is_changed = false;
        for vertex in 0..count {
            let mut last = vertex;
            while self.went[last] != NONE {
                last = self.went[last] as usize;
            }
            if (is_chosen[vertex] || is_corner[last]) && self.limits[vertex] > 0.0 {
                self.limits[vertex] = to(self.limits[vertex]);
                is_changed |= self.went[vertex] != NONE;
            }
        }
        Ok(is_changed)
    }

    /// The remaining triangles, and their numbers.
    fn assemble(&self, links: &Links) -> Result<(TriangleMesh, Vec<u32>), Error> {
        let mut numbers = memory::filled(self.limits.len(), NONE)?;
        let (mut vertices, mut triangles, mut kept) = (Vec::new(), Vec::new(), Vec::new());
        for (triangle, own) in (0..).zip(&links.triangles) {
            if own[0] == NONE {
                continue;
            }
            let mut corners = [0; 3];
            for (corner, &vertex) in corners.iter_mut().zip(own) {
                let number = &mut numbers[vertex as usize];
                if *number == NONE {
                    *number = vertices.len() as u32;
                    memory::push(&mut vertices, self.mesh.vertices()[vertex as usize])?;
                }
                *corner = *number;
            }
            memory::push(&mut triangles, corners)?;
            memory::push(&mut kept, triangle)?;
        }
        Ok((TriangleMesh::from_welded(vertices, triangles, 0, 0), kept))
    }
}
