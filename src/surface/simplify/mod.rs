//! Meshes with fewer triangles, and a proof of how far they are from those that they were made of.
//!
//! (Guéziec, *Locally toleranced surface simplification*, 1999; Borouchaki and Frey, *Simplification of
//! surface mesh using Hausdorff envelope*, 2005.)
//!
//! From the bottom up, each file uses only files named before it: `links` (triangles around vertices),
//! `sharp` (edges of the shape), `patch` (how far the surface moves), `collapse` (which vertices go).

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

/// A mesh with fewer triangles.
pub struct Simplified {
    mesh: TriangleMesh,
    report: SimplifiedReport,
}

/// How a mesh was simplified.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SimplifiedReport {
    /// No point of either mesh is further from the other one than that (model units): proven.
    pub deviation: f64,
    /// Triangles that were taken away.
    pub removed: u64,
    /// Pairs of triangles that intersect each other, as [`TriangleMesh::intersecting_pairs`] counts them.
    pub intersecting_pairs: u64,
}

impl Simplified {
    /// The triangles.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// The triangles.
    pub fn into_mesh(self) -> TriangleMesh {
        self.mesh
    }

    /// How it was found.
    pub fn report(&self) -> &SimplifiedReport {
        &self.report
    }
}

/// Intersecting pairs that are looked at in one round.
const PAIRS: usize = 1 << 16;

/// How much less the surface may move where it went too far, and the least part of the tolerance before it
/// stays where it is.
const HOLD: f64 = 0.5;
const LEAST: f64 = 0.1;

/// The same mesh with fewer triangles, no point of which is further than `tolerance` (model units) from the
/// mesh, and none of the mesh further from it.
///
/// Vertices are taken out, and none is moved: those first without which the surface moves least. Edges
/// between triangles whose normals differ by more than 30 degrees stay edges, and so do those between
/// triangles that bear different values: along an edge vertices go as far as the tolerance allows, and
/// corners stay. So a plane face becomes triangles between its corners, whatever it was made of, with the
/// rounding of the mesh for a tolerance.
///
/// The triangles hang together as before: a mesh that is closed and a manifold stays so, with as many bodies
/// and holes. Vertices on open edges, and those where more than two triangles meet in an edge, stay. No
/// triangles intersect each other that did not before. The result bears the values of triangles that are left
/// ([`AttributeDomain::Triangle`]), and none of corners. Its [deviation](TriangleMesh::deviation) is that of
/// the mesh with what is proven here.
///
/// The deviation is proven in both directions by the triangles of both meshes, and not by how vertices were
/// chosen. Where it is too large, less is taken out the next time.
///
/// O(n log n) for n triangles whose vertices have few: some 20 µs a triangle, and some 300 bytes. One thread
/// takes vertices out, and all prove. The result is the same for any number of them.
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
        // (How many rounds there will be is not known: the first one is taken for all.)
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

/// A mesh that is to have fewer triangles, as often as it takes until what is left will do.
pub(super) struct Reduction<'r> {
    mesh: &'r TriangleMesh,
    regions: Regions<'r>,
    /// How far the surface may move where a vertex goes (model units); those of 0 stay.
    limits: Vec<f64>,
    /// The least of these but 0.
    least: f64,
    /// Which vertex each one went to the last time, and what was left.
    went: Vec<u32>,
    left: Option<Links>,
}

impl<'r> Reduction<'r> {
    /// Sides between different regions are edges of the shape. The tolerance is in model units.
    pub(super) fn new(mesh: &'r TriangleMesh, regions: Regions<'r>, tolerance: f64) -> Result<Self, Error> {
        let limits = memory::filled(mesh.vertices().len(), tolerance)?;
        Ok(Reduction { mesh, regions, limits, least: LEAST * tolerance, went: Vec::new(), left: None })
    }

    /// Vertices that stay where they are.
    pub(super) fn keep(&mut self, is_kept: &[bool]) {
        for (limit, &is_kept) in self.limits.iter_mut().zip(is_kept) {
            *limit = if is_kept { 0.0 } else { *limit };
        }
    }

    /// The mesh with fewer triangles, which of them are left, and how many pairs of these intersect. Progress
    /// advances by `parts`.
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

    /// Lets the surface move less next to some triangles the next time; `false` if it did not move there.
    pub(super) fn hold(&mut self, triangles: impl Iterator<Item = u32>) -> Result<bool, Error> {
        let least = self.least;
        self.change(triangles, |limit| if limit > least { HOLD * limit } else { 0.0 })
    }

    /// Changes the limits of vertices that are gone and lay over some triangles, or else of all that went to
    /// their corners; `false` if there are none.
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

    /// The triangles that are left, and which they are.
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
