//! Indexed triangle meshes: exact welding, and the test whether a mesh bounds a solid.
//!
//! Topology is by position. Vertices at the same place become one vertex, however the mesh is passed in, so
//! that every number of [`TriangleMesh::report`] is a statement about the surface and not about the layout of
//! a file. "The same place" means equal coordinates, where -0.0 equals 0.0. There is no tolerance, so nobody
//! has to choose one, and no chains of merges occur.
//!
//! A triangle whose corners are not three different vertices is dropped. A triangle without area but with
//! three different corners is kept, because its edges pair with those of its neighbours: without it the mesh
//! would be open.

use crate::lattice::Each;
use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::fmt;

use glam::DVec3;
use once_cell::race::OnceBox;

use super::attributes;
use super::attributes::MeshAttribute;
use super::boundary::Loops;
use super::positions::{NOWHERE, Places, is_proper, normalised};
use super::topology::Topology;
use super::tree::{Grid, Tree};

use crate::control::Control;
use crate::error::{Error, MeshError};
use crate::lattice::LARGEST;
use crate::lattice::exact::sqrt;
use crate::memory;

/// The rule that defines the points that a surface encloses.
///
/// The *winding number* of a surface at a point is the solid angle that the surface covers as seen from the
/// point, divided by 4π, and counted positive where its inner side is seen. For a closed surface it is an
/// integer. For a surface with holes, fins or inverted triangles it is a fraction, and the rules are a
/// convention: they round to the nearest integer, which closes a hole by the surface from which half of all
/// directions lead out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum FillRule {
    /// Points whose winding number is at least ½ in magnitude: the surface winds around them, in either sense
    /// and any number of times. Overlapping bodies are united, and an inverted body is a body.
    #[default]
    NonZero,
    /// Points from which a ray crosses the surface an odd number of times. The overlap of two bodies is
    /// outside; orientation does not matter. An even number of triangles must meet on every edge.
    EvenOdd,
    /// Points whose winding number is at least ½. An inverted body is a cavity: it is subtracted from the
    /// bodies that it overlaps.
    Positive,
}

impl FillRule {
    /// Returns whether points of this winding number are enclosed.
    #[inline(always)]
    pub(crate) fn encloses(self, winding: i32) -> bool {
        match self {
            FillRule::NonZero => winding != 0,
            FillRule::EvenOdd => winding % 2 != 0,
            FillRule::Positive => winding > 0,
        }
    }

    /// Returns the amount by which a fractional winding number exceeds the threshold of the rule.
    #[inline(always)]
    pub(crate) fn excess(self, winding: f64) -> f64 {
        match self {
            FillRule::Positive => winding - 0.5,
            FillRule::NonZero | FillRule::EvenOdd => winding.abs() - 0.5,
        }
    }

    /// Returns whether points with a winding number between two numbers are enclosed; `None` if the interval
    /// contains a threshold of the rule.
    pub(crate) fn encloses_all(self, low: f64, high: f64) -> Option<bool> {
        let (one, other) = (self.excess(low), self.excess(high));
        // If the interval contains zero, its ends are the farthest numbers from zero.
        let is_through = self != FillRule::Positive && low < 0.0 && high > 0.0;
        if one > 0.0 && other > 0.0 && !is_through {
            Some(true)
        } else if one < 0.0 && other < 0.0 {
            Some(false)
        } else {
            None
        }
    }
}

/// A surface of triangles with shared vertices.
///
/// Coordinates are finite and at most 2^256 in magnitude; coordinates below 2^-256 count as zero. No two
/// vertices are equal, and the corners of a triangle are three different vertices. Corners turn
/// counter-clockwise as seen from outside of the solid. The mesh need not be closed;
/// [`check_closed`](Self::check_closed) tests that.
///
/// A mesh takes 24 bytes per vertex, 12 bytes per triangle, and the memory of its
/// [attributes](Self::attributes). Operations that search single triangles (rays, points and distances of a
/// [`MeshSolid`](crate::MeshSolid), intersections, [`SurfaceAttribute`](crate::attribute::SurfaceAttribute))
/// share a tree of the triangles' boxes. The tree is built when it is first needed, and takes 36 bytes a
/// triangle.
#[derive(Clone)]
pub struct TriangleMesh {
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    /// Each attribute has as many triangles as the mesh.
    attributes: Vec<MeshAttribute>,
    pub(super) welded: u64,
    pub(super) degenerate: u64,
    pub(super) sewn: u64,
    /// Maximum error of a vertex along an axis, in model units: vertices were moved to close cracks, or
    /// rounded.
    displacement: f64,
    /// Maximum distance of the true boundary from the surface, in model units.
    deviation: f64,
    pub(super) faces: Faces,
    pub(super) topology: OnceBox<Topology>,
    pub(super) details: OnceBox<Details>,
    tree: OnceBox<Tree>,
    /// The order of triangles in the tree of the mesh from which this mesh was copied and moved.
    order: Option<Arc<Vec<u32>>>,
}

/// Details that only a report needs.
#[derive(Debug, Clone)]
pub(super) struct Details {
    pub boundary_loops: u64,
    pub flat: u64,
    pub open_bodies: u64,
    pub inside_out_bodies: u64,
    pub overlaps: Overlaps,
}

/// The overlaps of closed bodies whose boxes meet.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Overlaps {
    /// Number of bodies that are proven to overlap another one.
    pub overlapping: u64,
    /// Number of other bodies that may overlap another one.
    pub undecided: u64,
}

/// Statistics of the faces of more than three corners from which triangles were made.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Faces {
    pub polygons: u64,
    /// Number of faces whose corners do not lie in a plane.
    pub bent: u64,
    /// Maximum distance of a corner from its face's plane.
    pub deviation: f64,
}

#[cfg(feature = "std")]
impl Faces {
    /// Corners off the plane by more than this fraction of the face's extent are not in the plane. Smaller
    /// distances may be rounding errors.
    const PLANE: f64 = 1.0 / (1_u64 << 40) as f64;

    /// Adds a face with more than three corners that deviates from its plane by `deviation`.
    pub fn add(&mut self, deviation: f64, extent: f64) {
        self.polygons += 1;
        self.bent += u64::from(deviation > Self::PLANE * extent);
        self.deviation = self.deviation.max(deviation);
    }
}

impl TriangleMesh {
    /// Builds a mesh of indexed triangles.
    ///
    /// Equal vertices are welded and keep the order of first appearance, so that the indices of the result
    /// are those given unless there were equal vertices. Vertices that no triangle uses are kept.
    ///
    /// O(v + t).
    ///
    /// # Errors
    /// [`MeshError::TooMany`], [`MeshError::NotFinite`], [`MeshError::TooLarge`], [`MeshError::Index`] or
    /// [`Error::OutOfMemory`].
    pub fn new(vertices: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Result<Self, Error> {
        Self::with_attributes(vertices, triangles, Vec::new())
    }

    /// Builds a mesh of indexed triangles with attributes, which have values for the given triangles. Values
    /// of dropped triangles are dropped.
    ///
    /// O(v + t). Fails as [`new`](Self::new) does, and with [`Error::Argument`] unless each attribute has as
    /// many triangles and a name of its own.
    pub fn with_attributes(
        mut vertices: Vec<[f64; 3]>,
        mut triangles: Vec<[u32; 3]>,
        mut attributes: Vec<MeshAttribute>,
    ) -> Result<Self, Error> {
        attributes::check(&attributes, triangles.len())?;
        let given = vertices.len();
        if u32::try_from(given).is_err() || u32::try_from(triangles.len()).is_err() {
            return Err(MeshError::TooMany.into());
        }
        for (i, vertex) in vertices.iter_mut().enumerate() {
            *vertex = normalised(*vertex, i as u64)?;
        }
        for (t, triangle) in triangles.iter().enumerate() {
            if let Some(&vertex) = triangle.iter().find(|&&v| v as usize >= given) {
                let (triangle, vertices) = (t as u64, given as u64);
                return Err(MeshError::Index { triangle, vertex: vertex.into(), vertices }.into());
            }
        }
        let mut places = Places::with_capacity(given)?;
        let mut new_indices = memory::with_capacity(given)?;
        let mut kept = 0;
        let mut batch = [[0.0; 3]; Places::BATCH];
        for start in (0..given).step_by(Places::BATCH) {
            let batch = &mut batch[..(given - start).min(Places::BATCH)];
            batch.copy_from_slice(&vertices[start..start + batch.len()]);
            let lookup = places.look_up(batch, &vertices);
            for (k, &vertex) in batch.iter().enumerate() {
                let mut index = lookup.found[k];
                if index == NOWHERE {
                    index = places.find_or_insert(lookup.hashes[k], &vertex, kept as u32, &vertices)?;
                    if index == kept as u32 {
                        vertices[kept] = vertex;
                        kept += 1;
                    }
                }
                new_indices.push(index);
            }
        }
        vertices.truncate(kept);
        if kept < given {
            triangles.iter_mut().for_each(|t| *t = t.each(|v| new_indices[v as usize]));
        }
        let degenerate = drop_improper(&mut triangles, &mut attributes);
        let welded = (given - kept) as u64;
        Ok(Self { attributes, ..Self::from_welded(vertices, triangles, welded, degenerate) })
    }

    /// Returns the mesh of vertices that are all different and triangles of three different vertices each.
    pub(crate) fn from_welded(
        vertices: Vec<[f64; 3]>,
        triangles: Vec<[u32; 3]>,
        welded: u64,
        degenerate: u64,
    ) -> Self {
        Self {
            vertices,
            triangles,
            attributes: Vec::new(),
            welded,
            degenerate,
            sewn: 0,
            displacement: 0.0,
            deviation: 0.0,
            faces: Faces::default(),
            topology: OnceBox::new(),
            details: OnceBox::new(),
            tree: OnceBox::new(),
            order: None,
        }
    }

    /// Returns the vertices and triangles of the mesh.
    pub(crate) fn into_arrays(self) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
        (self.vertices, self.triangles)
    }

    /// Returns the vertices, all different.
    pub fn vertices(&self) -> &[[f64; 3]] {
        &self.vertices
    }

    /// Returns the triangles as indices into [`vertices`](Self::vertices).
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Returns the bytes of memory that the mesh keeps: vertices, triangles, attributes, and, if they were
    /// computed, the data about its edges and the tree of its triangles. The spare capacity of the arrays is
    /// included.
    pub fn bytes(&self) -> u64 {
        let TriangleMesh { vertices, triangles, attributes, topology, details, tree, .. } = self;
        let arrays = memory::bytes_of(vertices) + memory::bytes_of(triangles) + memory::bytes_of(attributes);
        let known = topology.get().map_or(0, Topology::bytes)
            + details.get().map_or(0, size_of_val)
            + tree.get().map_or(0, Tree::bytes);
        (arrays + known) as u64 + attributes.iter().map(MeshAttribute::bytes).sum::<u64>()
    }

    /// Returns the attributes of the triangles, in the order in which they were added.
    pub fn attributes(&self) -> &[MeshAttribute] {
        &self.attributes
    }

    /// Returns the attribute with this name.
    pub fn attribute(&self, name: &str) -> Option<&MeshAttribute> {
        self.attributes.iter().find(|attribute| attribute.name() == name)
    }

    /// Adds an attribute for the triangles of the mesh.
    ///
    /// # Errors
    /// [`Error::Argument`] unless the attribute has as many triangles as the mesh, and a name that no other
    /// attribute of the mesh has; [`Error::OutOfMemory`]. On an error the mesh is unchanged.
    pub fn add_attribute(&mut self, attribute: MeshAttribute) -> Result<(), Error> {
        memory::push(&mut self.attributes, attribute)?;
        attributes::check(&self.attributes, self.triangles.len()).inspect_err(|_| {
            self.attributes.pop();
        })
    }

    /// Removes all attributes from the mesh and returns them.
    pub fn take_attributes(&mut self) -> Vec<MeshAttribute> {
        core::mem::take(&mut self.attributes)
    }

    /// Returns the least and the greatest coordinates of the vertices that triangles use; zeros if there are
    /// none.
    ///
    /// O(t), computed anew on each call.
    pub fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        if self.triangles.is_empty() {
            return ([0.0; 3], [0.0; 3]);
        }
        let mut low = DVec3::INFINITY;
        let mut high = DVec3::NEG_INFINITY;
        for corner in self.triangles.iter().flatten().map(|&v| self.position(v)) {
            low = low.min(corner);
            high = high.max(corner);
        }
        (low.to_array(), high.to_array())
    }

    /// Returns the enclosed volume, by the divergence theorem. A region around which the surface winds n
    /// times counts n times, so overlaps count twice and inverted bodies count negative. For open meshes the
    /// number has no meaning.
    ///
    /// O(t). The sum is taken relative to the centre of the bounds, so that a far-off origin costs no digits.
    pub fn volume(&self) -> f64 {
        let (low, high) = self.bounds();
        let centre = DVec3::from(low).midpoint(DVec3::from(high));
        let six_fold: f64 = (self.triangles.iter())
            .map(|t| {
                let [a, b, c] = t.each(|v| self.position(v) - centre);
                a.dot(b.cross(c))
            })
            .sum();
        // An empty sum is −0.
        six_fold / 6.0 + 0.0
    }

    /// Returns the sum of the triangles' areas (square model units), in doubles. O(t).
    pub fn area(&self) -> f64 {
        let twice = |t: &[u32; 3]| {
            let [a, b, c] = t.each(|v| self.position(v));
            (b - a).cross(c - a).length()
        };
        // An empty sum is −0.
        0.5 * self.triangles.iter().map(twice).sum::<f64>() + 0.0
    }

    /// Checks that the mesh bounds a solid under `rule`.
    ///
    /// For [`FillRule::EvenOdd`] an even number of triangles must meet on every edge. For the other rules
    /// half of them must also run in each direction; then every winding number is an integer.
    /// Self-intersections, overlaps, nested and inverted bodies are all allowed.
    ///
    /// The first call analyses the edges, in O(t + v) time and with 28 bytes per triangle and 9 per vertex of
    /// scratch memory; later calls are free.
    ///
    /// # Errors
    /// [`MeshError::Empty`], [`MeshError::Open`], [`MeshError::Unoriented`] (tested in this order) or
    /// [`Error::OutOfMemory`].
    pub fn check_closed(&self, rule: FillRule) -> Result<(), Error> {
        if self.triangles.is_empty() {
            return Err(MeshError::Empty.into());
        }
        let topology = self.topology()?;
        if topology.boundary_edges > 0 {
            return Err(MeshError::Open { edges: topology.boundary_edges }.into());
        }
        match rule {
            FillRule::NonZero | FillRule::Positive if topology.misoriented_edges > 0 => {
                Err(MeshError::Unoriented { edges: topology.misoriented_edges }.into())
            }
            FillRule::NonZero | FillRule::Positive | FillRule::EvenOdd => Ok(()),
        }
    }

    /// Returns the mesh with every vertex moved to the position that `f` returns. Vertices that coincide are
    /// welded, as in [`new`](Self::new). A reflection turns the mesh inside out. The report starts anew, and
    /// the new surface counts as exact: earlier displacements by closing cracks and a stated deviation are
    /// discarded.
    ///
    /// O(v + t). Fails as `new` does.
    pub fn transformed(&self, f: impl FnMut([f64; 3]) -> [f64; 3]) -> Result<Self, Error> {
        let vertices = memory::collected(self.vertices.iter().copied().map(f))?;
        let attributes = attributes::copies(&self.attributes)?;
        let moved = Self::with_attributes(vertices, memory::copied(&self.triangles)?, attributes)?;
        // (Vanished triangles would have to be removed from the order.)
        let order = self.known_order().filter(|_| moved.triangles.len() == self.triangles.len());
        Ok(Self { order, ..moved })
    }

    /// Returns the mesh with `f` applied to every coordinate. The report keeps its earlier counts.
    ///
    /// O(v + t), in place. Fails as [`new`](Self::new) does.
    pub(crate) fn scaled(self, f: impl Fn(f64) -> f64) -> Result<Self, Error> {
        let Self { mut vertices, triangles, attributes, welded, degenerate, mut faces, .. } = self;
        faces.deviation = f(faces.deviation);
        vertices.as_flattened_mut().iter_mut().for_each(|x| *x = f(*x));
        let mesh = Self::with_attributes(vertices, triangles, attributes)?;
        Ok(Self { welded: welded + mesh.welded, degenerate: degenerate + mesh.degenerate, faces, ..mesh })
    }

    /// Returns the mesh moved by `offset`: [`transformed`](Self::transformed) by a rounded sum.
    pub fn translated(&self, offset: [f64; 3]) -> Result<Self, Error> {
        let moved = self.transformed(|p| (DVec3::from(p) + DVec3::from(offset)).to_array())?;
        Ok(Self { displacement: self.displacement, deviation: self.deviation, ..moved })
    }

    /// Returns the mesh with a stated deviation: the true boundary lies within `deviation` (model units) of
    /// the mesh, as the boundary of a part does for a tessellation with that deflection. This replaces a
    /// deviation that was stated before.
    ///
    /// **Meaning.** The boundary of the true solid is the mesh's surface after a continuous motion that moves
    /// no point by more than `deviation` and reverses no part: around each point the true boundary winds as
    /// often as the mesh does around some point within `deviation` of it. A dent, a hole or a body that the
    /// mesh does not have at all is not covered, however small it is.
    ///
    /// **Consequences.** Every proof about a [`MeshSolid`](crate::MeshSolid) is a proof about the true solid:
    /// cells near to the triangles are undecided; intervals of volumes, moments, distances and clearances
    /// contain the true values; a ray meets the boundary in a reported interval; and a point that is too near
    /// to the mesh is undecided. The area of the true boundary is unknown, because a wavy boundary has a
    /// larger area. The deviation is carried through placements, Booleans and into octrees, whose
    /// [`Proof`](crate::Proof) contains the [`displacement`](Self::displacement). Results that are no proofs,
    /// such as a sampled octree, a tri-dexel model, a picture, [`bounds`](Self::bounds) and
    /// [`volume`](Self::volume), describe the mesh itself.
    ///
    /// A solid of a mesh with a deviation needs a closed mesh, because the inside of an open mesh is a
    /// convention.
    ///
    /// # Errors
    /// [`Error::Argument`] unless the deviation is finite, not negative, and at most 2^256.
    ///
    /// ```
    /// use leafless::{Control, FillRule, TriangleMesh, mesh::MeshMoments};
    /// // A cube that may be a hundredth larger or smaller all around.
    /// let corner = |k: u32| [k & 1, k >> 1 & 1, k >> 2].map(f64::from);
    /// let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    /// let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    /// let mesh = TriangleMesh::new((0..8).map(corner).collect(), triangles)?.with_deviation(0.01)?;
    /// let MeshMoments::Known(moments) = mesh.moments(FillRule::NonZero, &Control::default())? else { panic!() };
    /// assert!(moments.volume.contains(1.02f64.powi(3)) && moments.volume.contains(0.98f64.powi(3)));
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn with_deviation(self, deviation: f64) -> Result<Self, Error> {
        if (0.0..=LARGEST).contains(&deviation) {
            return Ok(Self { deviation: deviation + 0.0, ..self });
        }
        Err(Error::Argument { name: "deviation", problem: "must be finite, not negative, and at most 2^256" })
    }

    /// Returns the stated deviation, the maximum distance of the true boundary from the mesh, in model units:
    /// the value of [`with_deviation`](Self::with_deviation), multiplied by the maximum stretch of each later
    /// placement.
    pub fn deviation(&self) -> f64 {
        self.deviation
    }

    /// Returns the maximum deviation of the true boundary from the mesh along an axis, in model units. It
    /// covers moves of vertices to close hair cracks, rounding by placements, and the
    /// [`deviation`](Self::deviation).
    pub fn displacement(&self) -> f64 {
        if self.deviation == 0.0 {
            return self.displacement;
        }
        if self.displacement == 0.0 { self.deviation } else { (self.displacement + self.deviation).next_up() }
    }

    /// Returns the maximum error of a vertex along an axis, without a stated deviation.
    pub(super) fn vertex_displacement(&self) -> f64 {
        self.displacement
    }

    /// Returns the maximum distance of the true boundary from the mesh.
    pub(crate) fn radius(&self) -> f64 {
        let of_vertices =
            if self.displacement > 0.0 { (self.displacement * sqrt(3.0)).next_up().next_up() } else { 0.0 };
        match (of_vertices, self.deviation) {
            (radius, 0.0) | (0.0, radius) => radius,
            (one, other) => (one + other).next_up(),
        }
    }

    /// Reverses the orientation of all triangles.
    pub(super) fn turn_round(&mut self) {
        self.triangles.iter_mut().for_each(|[_, b, c]| core::mem::swap(b, c));
        self.attributes.iter_mut().for_each(MeshAttribute::turn_round);
        self.topology = OnceBox::new();
        self.details = OnceBox::new();
    }

    /// Returns the mesh with the statistics of the faces from which it was made.
    #[cfg(feature = "std")]
    pub(crate) fn made_from(self, faces: Faces) -> Self {
        Self { faces, ..self }
    }

    /// Returns the mesh with a maximum error of vertices along an axis and a maximum distance of the boundary
    /// from the surface.
    pub(super) fn displaced(self, displacement: f64, deviation: f64) -> Self {
        Self { displacement, deviation, ..self }
    }

    /// Returns a copy.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn try_clone(&self) -> Result<Self, Error> {
        let (vertices, triangles) = (memory::copied(&self.vertices)?, memory::copied(&self.triangles)?);
        let attributes = attributes::copies(&self.attributes)?;
        let (topology, details, tree, order) =
            (OnceBox::new(), OnceBox::new(), OnceBox::new(), self.known_order());
        Ok(Self { vertices, triangles, attributes, topology, details, tree, order, ..*self })
    }

    /// Returns the tree of the triangles, which is built by the first call and kept. The first call costs the
    /// same as [`Tree::new`], or as [`Tree::in_order`] for a moved copy of a mesh that has a tree; later
    /// calls are free.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], and [`Error::Cancelled`] by `control`.
    pub(crate) fn tree(&self, control: &Control<'_>) -> Result<&Tree, Error> {
        self.tree.get_or_try_init(|| {
            let grid = Grid::around(self.bounds());
            Ok(Box::new(match &self.order {
                Some(order) => Tree::in_order(grid, &self.vertices, &self.triangles, order)?,
                None => Tree::new(grid, &self.vertices, &self.triangles, control)?,
            }))
        })
    }

    /// Returns the tree of the triangles, if it was built.
    #[inline(always)]
    pub(crate) fn known_tree(&self) -> Option<&Tree> {
        self.tree.get()
    }

    /// Returns the order of triangles in the tree, if it was built.
    fn known_order(&self) -> Option<Arc<Vec<u32>>> {
        self.tree.get().map(Tree::order).or(self.order.as_ref()).cloned()
    }

    /// Returns the loops of the surface's boundary, in the direction of its triangles.
    pub(crate) fn loops(&self) -> Result<Loops, Error> {
        Loops::of(&self.topology()?.boundary)
    }

    /// Returns the vertices at open edges, ascending.
    pub(super) fn open_vertices(&self) -> Result<&[u32], Error> {
        Ok(&self.topology()?.open_vertices)
    }

    /// Returns the mesh with the first vertex of each pair in `moves` replaced by the second. A second vertex
    /// is never replaced itself.
    pub(super) fn moved(mut self, moves: &[(u32, u32)], displacement: f64) -> Result<Self, Error> {
        let mut targets = memory::with_capacity(self.vertices.len())?;
        targets.extend(0..self.vertices.len() as u32);
        moves.iter().for_each(|&(from, onto)| targets[from as usize] = onto);
        // Vertices that are kept move up to fill the gaps of replaced ones.
        let mut places = memory::filled(targets.len(), 0)?;
        let mut kept = 0;
        for vertex in 0..self.vertices.len() {
            if targets[vertex] == vertex as u32 {
                self.vertices[kept] = self.vertices[vertex];
                places[vertex] = kept as u32;
                kept += 1;
            }
        }
        self.vertices.truncate(kept);
        self.triangles.iter_mut().for_each(|t| *t = t.each(|v| places[targets[v as usize] as usize]));
        self.degenerate += drop_improper(&mut self.triangles, &mut self.attributes);
        self.sewn += moves.len() as u64;
        self.displacement = self.displacement.max(displacement);
        self.topology = OnceBox::new();
        self.details = OnceBox::new();
        (self.tree, self.order) = (OnceBox::new(), None);
        Ok(self)
    }

    pub(super) fn position(&self, vertex: u32) -> DVec3 {
        DVec3::from(self.vertices[vertex as usize])
    }

    pub(super) fn topology(&self) -> Result<&Topology, Error> {
        self.topology.get_or_try_init(|| Topology::of(&self.triangles, self.vertices.len()).map(Box::new))
    }
}

/// Drops triangles whose corners are not three different vertices, with their attribute values. Returns their
/// number.
fn drop_improper(triangles: &mut Vec<[u32; 3]>, attributes: &mut [MeshAttribute]) -> u64 {
    let before = triangles.len();
    for attribute in attributes {
        attribute.retain(|triangle| triangles.get(triangle).is_some_and(is_proper));
    }
    triangles.retain(is_proper);
    (before - triangles.len()) as u64
}

impl fmt::Debug for TriangleMesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TriangleMesh")
            .field("vertices", &self.vertices.len())
            .field("triangles", &self.triangles.len())
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::report::MeshReport;
    use alloc::vec;

    /// A tetrahedron of volume 1/6, counter-clockwise as seen from outside.
    const CORNERS: [[f64; 3]; 4] = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
    const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    fn tetrahedron() -> TriangleMesh {
        TriangleMesh::new(CORNERS.to_vec(), FACES.to_vec()).unwrap()
    }

    fn facets(mesh: &TriangleMesh) -> Vec<[[f64; 3]; 3]> {
        mesh.triangles().iter().map(|t| t.map(|v| mesh.vertices()[v as usize])).collect()
    }

    #[track_caller]
    fn mesh_error<T: fmt::Debug>(result: Result<T, Error>) -> MeshError {
        match result {
            Err(Error::Mesh(error)) => error,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn indexed_triangles() {
        let mesh = tetrahedron();
        assert_eq!((mesh.vertices(), mesh.triangles()), (&CORNERS[..], &FACES[..]));
        assert_eq!(mesh.bounds(), ([0.0; 3], [1.0; 3]));
        assert!((mesh.volume() - 1.0 / 6.0).abs() < 1e-15);
        let expected = MeshReport {
            facets_read: 4,
            triangles: 4,
            vertices: 4,
            welded: 0,
            degenerate: 0,
            edges: 6,
            euler_characteristic: 2,
            boundary_edges: 0,
            misoriented_edges: 0,
            boundary_loops: 0,
            non_manifold_edges: 0,
            duplicate: 0,
            opposite: 0,
            flat: 0,
            bodies: 1,
            open_bodies: 0,
            inside_out_bodies: 0,
            sewn: 0,
            displacement: 0.0,
            overlapping_bodies: 0,
            undecided_bodies: 0,
            polygons: 0,
            bent_polygons: 0,
            polygon_deviation: 0.0,
        };
        assert_eq!(mesh.report().unwrap(), expected);
        assert_eq!(mesh.clone().report().unwrap(), expected);
        assert!(expected.is_closed() && expected.is_manifold());
        assert!((mesh.area() - (1.5 + 0.75f64.sqrt())).abs() < 1e-15);
        assert_eq!(alloc::format!("{mesh:?}"), "TriangleMesh { vertices: 4, triangles: 4, .. }");
    }

    #[test]
    fn equal_vertices_are_welded() {
        // Vertex 4 is vertex 0 with other signs of zero, vertex 5 is vertex 1; vertex 6 is unused.
        let mut vertices = CORNERS.to_vec();
        vertices.extend([[-0.0, 0.0, -0.0], [1.0, -0.0, 0.0], [9.0, 9.0, 9.0]]);
        let mesh = TriangleMesh::new(vertices, vec![[4, 2, 5], [0, 1, 3], [1, 2, 3], [2, 4, 3]]).unwrap();
        assert_eq!(mesh.triangles(), FACES);
        assert_eq!(mesh.vertices().len(), 5);
        assert_eq!(mesh.bounds(), ([0.0; 3], [1.0; 3]));
        assert_eq!(mesh.report().unwrap().welded, 2);
        mesh.check_closed(FillRule::NonZero).unwrap();
        assert!(mesh.vertices()[0].iter().all(|x| x.is_sign_positive()));
        // The next floating-point number is another place.
        let vertices = vec![[0.1 + 0.2, 0., 0.], [0.3, 0., 0.], [0., 1., 0.]];
        assert_eq!(TriangleMesh::new(vertices, vec![[0, 1, 2]]).unwrap().vertices().len(), 3);
    }

    #[test]
    fn triangle_soups() {
        let mesh = tetrahedron();
        let soup = TriangleMesh::from_facets(facets(&mesh)).unwrap();
        // In the order of first appearance.
        assert_eq!(soup.vertices(), [CORNERS[0], CORNERS[2], CORNERS[1], CORNERS[3]]);
        assert_eq!(soup.triangles(), [[0, 1, 2], [0, 2, 3], [2, 1, 3], [1, 0, 3]]);
        assert_eq!((soup.report().unwrap().welded, soup.report().unwrap().bodies), (8, 1));
        soup.check_closed(FillRule::NonZero).unwrap();
        // By reference, and from an iterator of unknown length.
        let owned = facets(&mesh);
        let by_reference = TriangleMesh::from_facets(owned.iter()).unwrap();
        assert_eq!(by_reference.triangles(), soup.triangles());
        let unknown = facets(&mesh).into_iter().filter(|_| true);
        assert_eq!(TriangleMesh::from_facets(unknown).unwrap().triangles(), soup.triangles());
    }

    #[test]
    fn many_vertices_agree_with_new() {
        let facet = |i: i32| {
            let p = |j: i32| [f64::from((i * 7 + j * 13) % 50), f64::from((i + j) % 40), f64::from(j) - 1.0];
            [p(0), p(1), p(2)]
        };
        let soup: Vec<_> = (0..20_000).map(facet).collect();
        let corners: Vec<_> = soup.iter().flatten().copied().collect();
        let triangles = (0..20_000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let a = TriangleMesh::from_facets(&soup).unwrap();
        let b = TriangleMesh::new(corners, triangles).unwrap();
        assert_eq!(a.vertices(), b.vertices());
        assert_eq!(a.triangles(), b.triangles());
        assert_eq!(a.report().unwrap(), b.report().unwrap());
        assert_eq!(facets(&a), soup);
    }

    #[test]
    fn degenerate_facets() {
        let mut soup = facets(&tetrahedron());
        soup.insert(1, [CORNERS[0], CORNERS[1], CORNERS[0]]);
        soup.insert(3, [[5.0; 3]; 3]);
        let mesh = TriangleMesh::from_facets(&soup).unwrap();
        let report = mesh.report().unwrap();
        assert_eq!((report.facets_read, report.triangles, report.degenerate), (6, 4, 2));
        assert_eq!((report.vertices, report.welded), (5, 13));
        assert_eq!(mesh.bounds(), ([0.0; 3], [1.0; 3]));
        mesh.check_closed(FillRule::NonZero).unwrap();

        // A vertex on an edge: the collinear triangle closes the surface.
        let middle = [0.5, 0.0, 0.0];
        let mut soup = facets(&tetrahedron());
        soup[0] = [CORNERS[0], CORNERS[2], middle];
        soup.push([middle, CORNERS[2], CORNERS[1]]);
        let open = TriangleMesh::from_facets(&soup).unwrap();
        assert_eq!(mesh_error(open.check_closed(FillRule::NonZero)), MeshError::Open { edges: 3 });
        soup.push([CORNERS[0], middle, CORNERS[1]]);
        let closed = TriangleMesh::from_facets(&soup).unwrap();
        assert_eq!(closed.report().unwrap().degenerate, 0);
        closed.check_closed(FillRule::NonZero).unwrap();
        assert!((closed.volume() - 1.0 / 6.0).abs() < 1e-15);
    }

    #[test]
    fn what_closed_means() {
        let check = |triangles: &[[u32; 3]], rule| {
            TriangleMesh::new(CORNERS.to_vec(), triangles.to_vec()).unwrap().check_closed(rule)
        };
        let rules = [FillRule::NonZero, FillRule::EvenOdd];
        assert_eq!(FillRule::default(), FillRule::NonZero);
        for rule in rules {
            check(&FACES, rule).unwrap();
            assert_eq!(mesh_error(check(&[], rule)), MeshError::Empty);
            assert_eq!(mesh_error(check(&[[0, 0, 1]], rule)), MeshError::Empty);
            assert_eq!(mesh_error(check(&FACES[1..], rule)), MeshError::Open { edges: 3 });
            // A mesh that is inverted as a whole is consistent.
            check(&FACES.map(|[a, b, c]| [a, c, b]), rule).unwrap();
            // Two sheets of one triangle enclose nothing, but are closed.
            check(&[[0, 1, 2], [0, 2, 1]], rule).unwrap();
        }
        let one_turned = [[0, 1, 2], FACES[1], FACES[2], FACES[3]];
        let error = mesh_error(check(&one_turned, FillRule::NonZero));
        assert_eq!(error, MeshError::Unoriented { edges: 3 });
        check(&one_turned, FillRule::EvenOdd).unwrap();
        // Both defects: the hole is reported first.
        let error = mesh_error(check(&[[0, 1, 2], FACES[1], FACES[2]], FillRule::NonZero));
        assert!(matches!(error, MeshError::Open { .. }));
    }

    #[test]
    fn volumes_of_several_bodies() {
        let a = tetrahedron();
        let far = a.translated([1e9, -2e9, 3e9]).unwrap();
        assert!((far.volume() - 1.0 / 6.0).abs() < 1e-15);
        assert_eq!(far.bounds(), ([1e9, -2e9, 3e9], [1e9 + 1.0, 1.0 - 2e9, 3e9 + 1.0]));
        let turned = a.transformed(|[x, y, z]| [3.0 - x, y, z]).unwrap();
        assert!((turned.volume() + 1.0 / 6.0).abs() < 1e-15);
        let both = TriangleMesh::from_facets([facets(&a), facets(&turned)].concat()).unwrap();
        assert_eq!(both.report().unwrap().bodies, 2);
        assert!(both.volume().abs() < 1e-15);
        both.check_closed(FillRule::NonZero).unwrap();
        assert_eq!(TriangleMesh::new(vec![], vec![]).unwrap().volume(), 0.0);
        assert_eq!(TriangleMesh::new(vec![], vec![]).unwrap().bounds(), ([0.0; 3], [0.0; 3]));
    }

    #[test]
    fn moved_meshes_are_checked_anew() {
        let mesh = tetrahedron();
        let flat = mesh.transformed(|[x, y, _]| [x, y, 0.0]).unwrap();
        assert_eq!((flat.vertices().len(), flat.triangles().len()), (3, 2));
        assert_eq!(flat.report().unwrap().degenerate, 2);
        flat.check_closed(FillRule::NonZero).unwrap();
        let error = mesh_error(mesh.transformed(|[x, y, z]| [x, y / 0.0, z]));
        assert_eq!(error, MeshError::NotFinite { vertex: 0 });
        let error = mesh_error(mesh.translated([0.0, f64::INFINITY, 0.0]));
        assert_eq!(error, MeshError::NotFinite { vertex: 0 });
        let error = mesh_error(mesh.transformed(|p| p.map(|x| x * 1e80)));
        assert_eq!(error, MeshError::TooLarge { vertex: 1 });
    }

    #[test]
    fn refused_input() {
        let with = |x: f64| {
            let mut vertices = CORNERS.to_vec();
            vertices[2][1] = x;
            let mesh = TriangleMesh::new(vertices, FACES.to_vec());
            let soup = TriangleMesh::from_facets([CORNERS_OF_FACE, [[0.0, x, 0.0]; 3]]);
            (mesh, soup)
        };
        const CORNERS_OF_FACE: [[f64; 3]; 3] = [CORNERS[0], CORNERS[1], CORNERS[2]];
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let (mesh, soup) = with(x);
            assert_eq!(mesh_error(mesh), MeshError::NotFinite { vertex: 2 });
            assert_eq!(mesh_error(soup), MeshError::NotFinite { vertex: 3 });
        }
        // 2^256.
        assert_eq!(LARGEST, [65536.0; 16].iter().product::<f64>());
        for x in [LARGEST.next_up(), -f64::MAX] {
            let (mesh, soup) = with(x);
            assert_eq!(mesh_error(mesh), MeshError::TooLarge { vertex: 2 });
            assert_eq!(mesh_error(soup), MeshError::TooLarge { vertex: 3 });
        }
        let (mesh, soup) = with(-LARGEST);
        assert!(mesh.unwrap().volume().is_finite());
        soup.unwrap();

        for bad in [4, u32::MAX] {
            let error = mesh_error(TriangleMesh::new(CORNERS.to_vec(), vec![FACES[0], [0, bad, 1]]));
            assert_eq!(error, MeshError::Index { triangle: 1, vertex: bad.into(), vertices: 4 });
        }
        let error = mesh_error(TriangleMesh::new(vec![], vec![[0, 0, 0]]));
        assert_eq!(error, MeshError::Index { triangle: 0, vertex: 0, vertices: 0 });
    }

    #[test]
    fn claimed_lengths_are_not_believed() {
        /// An iterator that claims to be endless, and ends.
        struct Liar(u32);
        impl Iterator for Liar {
            type Item = [[f64; 3]; 3];
            fn next(&mut self) -> Option<Self::Item> {
                self.0 = self.0.checked_sub(1)?;
                Some([CORNERS[0], CORNERS[1], CORNERS[2]])
            }
            fn size_hint(&self) -> (usize, Option<usize>) {
                (usize::MAX, None)
            }
        }
        assert!(matches!(TriangleMesh::from_facets(Liar(3)), Err(Error::OutOfMemory)));
    }
}
