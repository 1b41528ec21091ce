//! Data on a mesh as an attribute of space: the value at the nearest point of the surface.

use crate::lattice::Each;
use alloc::sync::Arc;
use alloc::vec::Vec;

use super::{Attribute, ValueRange};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Bounds, Interval};
use crate::memory;
use crate::mesh::{MeshAttribute, NearVisitor, NearestPoint, TriangleMesh};

/// The attribute whose value at a point is the value of a mesh at the nearest point of its surface.
///
/// * With a value for each triangle, it is the value of the nearest triangle. If the triangles of a body
///   share a value, that is the value of the nearest body.
/// * With a value for each corner, it is interpolated linearly between the corners of the nearest triangle,
///   at the nearest point.
///
/// If several triangles are equally near, the first one counts. Distances are computed in doubles; for shared
/// vertices and edges they are equal. A point has no value if its nearest triangle has none, or if the point
/// is not finite. The mesh need not be closed.
///
/// [`range`](Attribute::range) is proven: it includes every triangle that can be nearest to a point of the
/// box.
///
/// ```
/// use leafless::{TriangleMesh, attribute::{Attribute, SurfaceAttribute}, mesh::MeshAttribute};
///
/// let vertices = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let mesh = TriangleMesh::new(vertices, vec![[0, 1, 2], [0, 2, 3]])?;
/// let heat = MeshAttribute::per_triangle("heat", 1, &[20.0, 35.0])?;
/// let heat = SurfaceAttribute::new(mesh, heat)?;
/// assert_eq!(heat.value([0.9, 0.1, 5.0])?, Some([20.0, 0.0, 0.0, 0.0]));
/// assert_eq!(heat.value([0.1, 0.9, -1.0])?, Some([35.0, 0.0, 0.0, 0.0]));
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Clone)]
pub struct SurfaceAttribute {
    mesh: Arc<TriangleMesh>,
    source: Source,
    /// The ranges of the values in each node of the tree.
    summaries: Arc<Vec<Summary>>,
}

/// The place of the values.
#[derive(Clone)]
enum Source {
    /// The attribute of the mesh with this index.
    OfMesh(usize),
    Given(Arc<MeshAttribute>),
}

impl SurfaceAttribute {
    /// Makes the attribute of the values of `attribute` on the triangles of a mesh, which is shared (an
    /// `Arc`) or moved.
    ///
    /// O(t log t), unless the mesh has a tree of its triangles already. The tree takes 36 bytes a triangle,
    /// and the ranges take up to 24.
    ///
    /// # Errors
    /// [`Error::Argument`] unless the attribute has as many triangles as the mesh; [`Error::OutOfMemory`].
    pub fn new(
        mesh: impl Into<Arc<TriangleMesh>>,
        attribute: MeshAttribute,
    ) -> Result<SurfaceAttribute, Error> {
        Self::on(mesh.into(), Source::Given(Arc::new(attribute)))
    }

    /// Makes the attribute of the values that [belong to the mesh](TriangleMesh::attributes) under this name.
    ///
    /// The cost is that of [`new`](Self::new).
    ///
    /// # Errors
    /// [`Error::Argument`] unless the mesh has an attribute of this name; [`Error::OutOfMemory`].
    pub fn of_mesh(mesh: impl Into<Arc<TriangleMesh>>, name: &str) -> Result<SurfaceAttribute, Error> {
        let mesh = mesh.into();
        let place = place(&mesh, name)?;
        Self::on(mesh, Source::OfMesh(place))
    }

    /// Makes another attribute of the same mesh, which shares the tree of its triangles. O(t).
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with(&self, attribute: MeshAttribute) -> Result<SurfaceAttribute, Error> {
        Self::on(self.mesh.clone(), Source::Given(Arc::new(attribute)))
    }

    /// Makes another attribute of the values that belong to the same mesh, which shares the tree of its
    /// triangles. O(t).
    ///
    /// # Errors
    /// As [`of_mesh`](Self::of_mesh).
    pub fn with_name(&self, name: &str) -> Result<SurfaceAttribute, Error> {
        let place = place(&self.mesh, name)?;
        Self::on(self.mesh.clone(), Source::OfMesh(place))
    }

    /// The mesh.
    pub fn mesh(&self) -> &Arc<TriangleMesh> {
        &self.mesh
    }

    /// The values on the mesh.
    pub fn attribute(&self) -> &MeshAttribute {
        self.source.attribute(&self.mesh)
    }

    fn on(mesh: Arc<TriangleMesh>, source: Source) -> Result<SurfaceAttribute, Error> {
        let attribute = source.attribute(&mesh);
        if attribute.len() != mesh.triangles().len() {
            let problem = "must have as many triangles as the mesh";
            return Err(Error::Argument { name: "attribute", problem });
        }
        let of = |triangle: u32| Summary::of(attribute, triangle);
        let tree = mesh.triangle_tree(&Control::threads(1))?;
        let summaries = tree.summaries(Summary::NOTHING, &of, &Summary::join)?;
        Ok(SurfaceAttribute { summaries: Arc::new(summaries), mesh, source })
    }
}

impl Source {
    fn attribute<'a>(&'a self, mesh: &'a TriangleMesh) -> &'a MeshAttribute {
        match self {
            Source::OfMesh(place) => &mesh.attributes()[*place],
            Source::Given(attribute) => attribute,
        }
    }
}

/// The index of an attribute among those of a mesh.
fn place(mesh: &TriangleMesh, name: &str) -> Result<usize, Error> {
    let place = mesh.attributes().iter().position(|attribute| attribute.name() == name);
    place.ok_or(Error::Argument { name: "name", problem: "must be the name of an attribute of the mesh" })
}

/// The range of the values of some triangles.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Summary {
    low: [f64; 4],
    high: [f64; 4],
    /// Whether some of them have no value.
    lacks: bool,
}

impl Summary {
    /// The summary of no triangles.
    const NOTHING: Summary = Summary { low: [f64::INFINITY; 4], high: [f64::NEG_INFINITY; 4], lacks: false };

    fn of(attribute: &MeshAttribute, triangle: u32) -> Summary {
        match attribute.corners(triangle as usize) {
            None => Summary { lacks: true, ..Summary::NOTHING },
            Some(corners) => corners.into_iter().fold(Summary::NOTHING, |sum, value| {
                sum.join(Summary { low: value, high: value, lacks: false })
            }),
        }
    }

    fn join(self, other: Summary) -> Summary {
        Summary {
            low: [0, 1, 2, 3].each(|k| self.low[k].min(other.low[k])),
            high: [0, 1, 2, 3].each(|k| self.high[k].max(other.high[k])),
            lacks: self.lacks || other.lacks,
        }
    }

    /// Returns whether some triangle has a value.
    fn has(&self) -> bool {
        self.low[0] <= self.high[0]
    }

    /// Returns whether some triangles have values and some have none; then further triangles change nothing.
    fn is_mixed(&self) -> bool {
        self.lacks && self.has()
    }

    fn range(&self) -> ValueRange {
        match (self.has(), self.lacks) {
            (true, false) => {
                // NaN values have no range.
                let ranges = [0, 1, 2, 3].each(|k| Interval::new(self.low[k], self.high[k]));
                match ranges {
                    [Some(a), Some(b), Some(c), Some(d)] => ValueRange::Within([a, b, c, d]),
                    _ => ValueRange::Unknown,
                }
            }
            (true, true) => ValueRange::Unknown,
            (false, _) => ValueRange::Nowhere,
        }
    }
}

/// Joins the summaries of triangles that may be nearest.
struct Joined<'a> {
    attribute: &'a MeshAttribute,
    summaries: &'a [Summary],
    sum: Summary,
}

impl NearVisitor for Joined<'_> {
    fn enter(&mut self, node: usize, all: bool) -> bool {
        let joined = self.sum.join(self.summaries[node]);
        if all {
            self.sum = joined;
        }
        !all && !self.sum.is_mixed() && joined != self.sum
    }

    fn wants(&self, triangle: u32) -> bool {
        self.sum.join(Summary::of(self.attribute, triangle)) != self.sum
    }

    fn visit(&mut self, triangle: u32) {
        self.sum = self.sum.join(Summary::of(self.attribute, triangle));
    }
}

impl Attribute for SurfaceAttribute {
    /// Counts the mesh, the tree over its triangles, and the values.
    fn kept_bytes(&self) -> u64 {
        let given = match &self.source {
            Source::OfMesh(_) => 0,
            Source::Given(attribute) => size_of_val(&**attribute) as u64 + attribute.bytes(),
        };
        self.mesh.bytes() + memory::bytes_of(&self.summaries) as u64 + given
    }

    fn components(&self) -> usize {
        self.attribute().components()
    }

    fn values(&self, points: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) -> Result<(), Error> {
        let (attribute, tree) = (self.attribute(), self.mesh.triangle_tree(&Control::threads(1))?);
        // Consecutive points often have the same nearest triangle.
        let mut last = None;
        for (value, point) in values.iter_mut().zip(points) {
            let nearest = tree.nearest(point, last);
            last = nearest.map(|nearest| nearest.triangle).or(last);
            *value = nearest.and_then(|nearest| interpolated(attribute, &nearest));
        }
        Ok(())
    }

    fn range(&self, bounds: &Bounds) -> Result<ValueRange, Error> {
        let (attribute, tree) = (self.attribute(), self.mesh.triangle_tree(&Control::threads(1))?);
        let mut joined = Joined { attribute, summaries: &self.summaries, sum: Summary::NOTHING };
        let is_known = tree.visit_near(bounds, &mut joined);
        Ok(if is_known { joined.sum.range() } else { ValueRange::Unknown })
    }
}

/// The value at a point of a triangle, between the values at the corners.
fn interpolated(attribute: &MeshAttribute, at: &NearestPoint) -> Option<[f64; 4]> {
    let [a, b, c] = attribute.corners(at.triangle as usize)?;
    let [u, v, w] = at.weights;
    Some([0, 1, 2, 3].each(|k| {
        let (low, high) = (a[k].min(b[k]).min(c[k]), a[k].max(b[k]).max(c[k]));
        (u * a[k] + v * b[k] + w * c[k]).clamp(low, high)
    }))
}
