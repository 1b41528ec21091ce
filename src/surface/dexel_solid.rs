//! Tri-dexel models as solids.

use super::dexel::{DexelSurfaceReport, marching_cubes_dexels};
use crate::control::Control;
use crate::dexel::TriDexelRef;
use crate::error::Error;
use crate::lattice::{Affine, Bounds, Frame};
use crate::mesh::{FillRule, TriangleMesh};
use crate::octree::{Proof, Tag};
use crate::solid::{Classifier, Fingerprint, MeshSolid, Motion, Solid, WholeQuestion};
use alloc::sync::Arc;

/// A tri-dexel model as a solid: the region inside the surface that [`marching_cubes_dexels`] finds. Cheap to
/// clone.
///
/// The solid can be built on any frame, moved, queried, and used in expressions. Its verdicts are exact for
/// this surface. They prove nothing about the solid from which the model was made, because no ray sees what
/// lies between the rays. [`Classifier::proof`] returns this fact, and measures and other certified queries
/// then return only what is certain, which is little. [`as_truth`](DexelSolid::as_truth) treats the surface
/// itself as the solid.
///
/// ```
/// use leafless::{
///     Control, Frame, Rule, TriDexel, build, measure, dexel::{Dexel, DexelEnd, DexelFormat},
///     surface::DexelSolid,
/// };
/// let (frame, control) = (Frame::new([0.0; 3], 8.0, 3)?, Control::default());
/// let end = DexelEnd::new;
/// // A cube of edge 4, 2 from the origin on each axis.
/// let cube = |_: usize, ray: [u32; 2], list: &mut Vec<Dexel>| {
///     if ray.iter().all(|i| (2..6).contains(i)) {
///         list.push(Dexel { start: end(2.0), end: end(6.0), material: 0 });
///     }
///     Ok(())
/// };
/// let model = TriDexel::from_rays(&frame, DexelFormat::default(), [true; 3], cube, &control)?;
/// let solid = DexelSolid::new(model.view(), &control)?;
/// let tree = build(&solid, &Frame::new([1.0; 3], 8.0, 5)?, Rule::Certified, &control)?;
/// assert!(!tree.proof().full && !tree.proof().empty);
/// // Marching cubes cuts off edges and corners.
/// let volume = measure(&solid.as_truth(), &frame, 1e-9, &control)?.volume;
/// assert!(58.0 < volume.lower && volume.upper < 64.0);
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Clone)]
pub struct DexelSolid {
    surface: MeshSolid,
    report: DexelSurfaceReport,
    proof: Proof,
}

impl DexelSolid {
    /// Creates the solid of a model. The surface is extracted once, here; the model is not kept.
    ///
    /// # Errors
    /// As [`marching_cubes_dexels`], and [`MeshError::Empty`](crate::error::MeshError::Empty) if no cell
    /// centre lies inside.
    pub fn new(model: &TriDexelRef<'_>, control: &Control<'_>) -> Result<DexelSolid, Error> {
        let (mesh, report) = marching_cubes_dexels(model, control)?;
        let surface = MeshSolid::new(mesh, FillRule::NonZero)?;
        Ok(DexelSolid { surface, report, proof: Proof::new(false, false) })
    }

    /// Returns the same solid with its surface as the truth: its verdicts are proven for the region inside
    /// the surface.
    #[must_use]
    pub fn as_truth(&self) -> DexelSolid {
        DexelSolid { proof: Proof::CERTIFIED, ..self.clone() }
    }

    /// The surface as a mesh.
    pub fn mesh(&self) -> &Arc<TriangleMesh> {
        self.surface.mesh()
    }

    /// The report on how exactly the surface follows the rays of the model.
    pub fn report(&self) -> DexelSurfaceReport {
        self.report
    }
}

impl Solid for DexelSolid {
    type Classifier = DexelClassifier;

    fn on(&self, frame: &Frame, control: &Control<'_>) -> Result<DexelClassifier, Error> {
        Ok(DexelClassifier { surface: self.surface.on(frame, control)?, proof: self.proof })
    }

    /// The bounding box; known only if the surface is the truth.
    fn bounds(&self) -> Option<Bounds> {
        if self.proof.empty { self.surface.bounds() } else { None }
    }

    /// The fingerprint of the surface.
    fn fingerprint(&self) -> Option<Fingerprint> {
        self.surface.fingerprint()
    }

    fn placed(&self, placement: &Affine) -> Result<Option<DexelSolid>, Error> {
        Ok(Some(DexelSolid { surface: self.surface.placed(placement)?, ..self.clone() }))
    }

    fn motion(&self) -> Motion {
        self.surface.motion()
    }

    fn kept_bytes(&self) -> u64 {
        self.surface.kept_bytes()
    }
}

/// The surface on a frame.
#[derive(Clone)]
pub struct DexelClassifier {
    surface: <MeshSolid as Solid>::Classifier,
    proof: Proof,
}

impl Classifier for DexelClassifier {
    // The cells are those of the surface; only their proof differs.
    type Worker = <<MeshSolid as Solid>::Classifier as Classifier>::Worker;

    fn frame(&self) -> &Frame {
        self.surface.frame()
    }

    fn worker(&self) -> Result<Self::Worker, Error> {
        self.surface.worker()
    }

    fn exterior(&self) -> Tag {
        self.surface.exterior()
    }

    fn proof(&self) -> Proof {
        // The surface may have been moved, which rounds its vertices.
        self.proof.moved(self.surface.proof().displacement())
    }

    fn answer_whole(&self, question: WholeQuestion<'_>, control: &Control<'_>) -> Result<(), Error> {
        self.surface.answer_whole(question, control)
    }

    fn kept_bytes(&self) -> u64 {
        self.surface.kept_bytes()
    }
}
