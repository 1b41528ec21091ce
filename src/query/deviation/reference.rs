//! The distance of meshes from the boundary of one solid.

use super::piece::{dot, minus};
use super::search::{Beyond, Search};
use super::surface::{Seen, Surface};
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::memory;
use crate::mesh::{TriangleMesh, TriangleTree};
use crate::octree::Tag;
use crate::solid::Classifier;
use alloc::sync::Arc;
use alloc::vec::Vec;

/// The boundary of a bounded solid, as far as it is known, for comparison with meshes.
pub(crate) struct Reference(Option<Surface>);

/// The precision of the greatest distance, as a part of the allowed distance.
const SHARE: f64 = 1.0 / 16.0;

/// The maximal number of extra cuts for each triangle, which make the greatest distance more exact than
/// required; and the number of triangles of both surfaces up to which these cuts are made.
const CUTS: u64 = 4;
const MANY: usize = 1 << 15;

/// A mesh to compare with a boundary. It may have been compared before.
pub(crate) struct Remade<'c> {
    pub(crate) mesh: &'c Arc<TriangleMesh>,
    /// The triangles to compare, also with the boundary near to them; all triangles if this is empty.
    pub(crate) is_new: &'c [bool],
    /// The maximal number of cuts of a triangle that are made to find its distance.
    pub(crate) cuts: u64,
}

/// The result of a comparison.
pub(crate) struct Comparison {
    /// A proven upper bound (model units) of the distance of the compared triangles from the boundary, and of
    /// the nearby boundary from the mesh; infinite if nothing is known.
    pub(crate) most: f64,
    /// Triangles of the mesh where one of these distances is proven to exceed the allowed distance, or nearly
    /// so.
    pub(crate) beyond: Vec<u32>,
}

impl Reference {
    /// Builds the reference. If the boundary is not known exactly, up to `budget` cells are split until it is
    /// known to `tolerance` (model units).
    pub(crate) fn new<C: Classifier>(
        solid: &C,
        tolerance: f64,
        budget: u64,
        job: &Job<'_>,
    ) -> Result<Reference, Error> {
        if solid.exterior() != Tag::Empty {
            return Ok(Reference(None));
        }
        super::surface(solid, tolerance, budget, job).map(|surface| Reference(Some(surface)))
    }

    /// Compares a mesh with the boundary, only as exactly as necessary to find where they are further apart
    /// than `allowed` (model units).
    pub(crate) fn beyond(
        &self,
        compared: &Remade<'_>,
        allowed: f64,
        control: &Control<'_>,
    ) -> Result<Comparison, Error> {
        let job = &Job::new(control);
        let mut found = Comparison { most: f64::INFINITY, beyond: Vec::new() };
        // (No distance from a boundary of unknown position is proven to be too large.)
        let Some(surface) = self.0.as_ref().filter(|surface| !surface.is_unknown()) else { return Ok(found) };
        found.most = 0.0;
        let new = compared.new_ones()?;
        let tree = new.as_ref().map(|new| new.triangle_tree(job.control())).transpose()?;
        self.each_way(compared.mesh, allowed, job, |k, search, parallel| {
            if search.to.is_unknown() {
                if !search.from.is_empty() {
                    found.most = f64::INFINITY;
                }
                return Ok(());
            }
            let is_wanted = |layer: usize, triangle: u32| match (&tree, k) {
                (None, _) => true,
                (Some(_), 0) => compared.is_new[triangle as usize],
                (Some(tree), _) => is_near(&surface.covers[layer].mesh, triangle, tree, allowed),
            };
            let (most, list) =
                search.beyond((1.0 - SHARE) * allowed, &is_wanted, compared.cuts, parallel, job)?;
            found.most = found.most.max(most);
            for Beyond { triangle, nearest, .. } in list.into_iter().filter(|own| own.is_proven) {
                if let Some(own) = if k == 0 { Some(triangle) } else { nearest } {
                    memory::push(&mut found.beyond, own)?;
                }
            }
            Ok(())
        })?;
        Ok(found)
    }

    /// Returns an upper bound (model units) of the distance of a mesh's points from the boundary, and of the
    /// boundary's points from the mesh: to a sixteenth of `allowed`, if that can be found quickly. Infinite
    /// if nothing is known, and if the number of triangles is too large.
    pub(crate) fn apart(
        &self,
        mesh: &Arc<TriangleMesh>,
        allowed: f64,
        control: &Control<'_>,
    ) -> Result<f64, Error> {
        let covers = self.0.iter().flat_map(|surface| &surface.covers);
        let count = mesh.triangles().len() + covers.map(|layer| layer.mesh.triangles().len()).sum::<usize>();
        if self.0.as_ref().is_none_or(Surface::is_unknown) || count > MANY {
            return Ok(f64::INFINITY);
        }
        let job = &Job::new(control);
        let mut most: f64 = 0.0;
        self.each_way(mesh, allowed, job, |_, search, parallel| {
            let (way, ..) = search.run(parallel, job)?;
            most = most.max(way.distance.upper);
            Ok(())
        })?;
        Ok(most)
    }

    /// Searches from the triangles of a mesh to the boundary (0), and back (1).
    fn each_way(
        &self,
        mesh: &Arc<TriangleMesh>,
        allowed: f64,
        job: &Job<'_>,
        mut look: impl FnMut(usize, &Search<'_>, bool) -> Result<(), Error> + Send,
    ) -> Result<(), Error> {
        let Some(surface) = &self.0 else { return Ok(()) };
        let own = Surface::of_mesh(mesh)?;
        let seen = [own.seen(job.control())?, surface.seen(job.control())?];
        let budget = CUTS * (1024 + seen.iter().map(|seen| seen.count() as u64).sum::<u64>());
        let worth = seen.iter().any(Seen::is_large);
        for k in 0..2 {
            let search = Search { from: &seen[k], to: &seen[1 - k], tolerance: SHARE * allowed, budget };
            job.control().run(worth, |parallel| look(k, &search, parallel))?;
        }
        Ok(())
    }
}

impl Remade<'_> {
    /// The triangles to compare, unless these are all.
    fn new_ones(&self) -> Result<Option<TriangleMesh>, Error> {
        if self.is_new.is_empty() {
            return Ok(None);
        }
        let count = self.is_new.iter().filter(|&&is_new| is_new).count();
        let mut triangles = memory::with_capacity(count)?;
        let all = self.mesh.triangles().iter().zip(self.is_new);
        triangles.extend(all.filter(|(_, is_new)| **is_new).map(|(own, _)| *own));
        let vertices = memory::copied(self.mesh.vertices())?;
        Ok(Some(TriangleMesh::from_welded(vertices, triangles, 0, 0)))
    }
}

/// Returns whether a triangle may be within `distance` of a triangle of a tree.
fn is_near(mesh: &TriangleMesh, triangle: u32, tree: &TriangleTree<'_>, distance: f64) -> bool {
    let [a, b, c] = mesh.triangles()[triangle as usize].each(|vertex| mesh.vertices()[vertex as usize]);
    let length = |p: [f64; 3]| dot(minus(p, a), minus(p, a));
    let side = sqrt(length(b).max(length(c)));
    tree.nearest_of(&a, |_| true).is_none_or(|(_, away)| away.lower <= side + 2.0 * distance)
}
