//! How far meshes are from the boundary of one solid.

use super::search::Search;
use super::surface::{Seen, Surface};
use crate::control::Job;
use crate::error::Error;
use crate::memory;
use crate::mesh::TriangleMesh;
use crate::octree::Tag;
use crate::solid::Classifier;
use alloc::sync::Arc;
use alloc::vec::Vec;

/// The boundary of a solid that ends in the universe, as far as it is known: meshes are compared with it.
pub(crate) struct Reference(Option<Surface>);

/// How far a mesh and a boundary are from each other.
pub(crate) struct Comparison {
    /// No point of the mesh is further from the boundary than that, and none of the boundary from the mesh (model units). That is proven;
    /// infinite if nothing is known.
    pub(crate) most: f64,
    /// Points of either that are further from the other one than was allowed, or nearly so.
    pub(crate) beyond: Vec<[f64; 3]>,
}

/// The greatest distance is known to this part of what is allowed.
const SHARE: f64 = 1.0 / 16.0;

/// Pieces are cut that often at the most, for each triangle.
const CUTS: u64 = 4;

impl Reference {
    /// Where the boundary is not known exactly, up to `budget` cells are split until it is known to `tolerance` (model units).
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

    /// Compares all triangles of a mesh. `allowed` is the distance beyond which points are told (model units).
    pub(crate) fn compare(
        &self,
        mesh: &Arc<TriangleMesh>,
        allowed: f64,
        job: &Job<'_>,
    ) -> Result<Comparison, Error> {
        let mut found = Comparison { most: f64::INFINITY, beyond: Vec::new() };
        let Some(surface) = &self.0 else { return Ok(found) };
        let own = Surface::of_mesh(mesh)?;
        let seen = [own.seen(job.control())?, surface.seen(job.control())?];
        let budget = CUTS * (1024 + seen.iter().map(|seen| seen.count() as u64).sum::<u64>());
        let worth = seen.iter().any(Seen::is_large);
        found.most = 0.0;
        for k in 0..2 {
            let search = Search { from: &seen[k], to: &seen[1 - k], tolerance: SHARE * allowed, budget };
            let most = job.control().run(worth, |parallel| {
                let (way, ..) = search.run(parallel, job)?;
                if way.distance.upper > allowed && way.distance.upper < f64::INFINITY {
                    for point in search.points_beyond(allowed, parallel, job)? {
                        memory::push(&mut found.beyond, point)?;
                    }
                }
                Ok::<_, Error>(way.distance.upper)
            })?;
            found.most = found.most.max(most);
        }
        Ok(found)
    }
}
