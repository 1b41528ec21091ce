//! Solids of plane faces, as in boundary representations.
//!
//! The arrays are checked completely. The conditions are local, face by face and edge by edge, plus one:
//! voids must lie within their solids. Faces that cut through each other, and overlapping shells or solids,
//! are accepted, because a mesh has a meaning for them.

use crate::lattice::Each;
use alloc::vec::Vec;

use super::attributes::MeshAttribute;
use super::polygon::{PolygonDefect, flatness, triangulate};
use super::positions::normalised;
use super::shells::{Extent, outside, volume};
use super::triangle_mesh::{Faces, TriangleMesh};
use crate::error::{Error, MeshError, PolyhedronError};
use crate::lattice::valid;
use crate::memory;

/// Default tolerance: maximum distance of corners from the plane of their face, relative to the longest
/// extent.
pub(crate) const PLANE: f64 = 1e-9;

/// Solids of plane faces as plain arrays: a solid consists of shells, a shell of faces, a face of loops, and
/// a loop of corners.
///
/// Every level is one array of offsets into the level below: part k is `offsets[k]..offsets[k + 1]` of that
/// level. Each array begins with 0, rises, has one entry more than there are parts, and ends at the number of
/// parts of the level below. Outer loops turn counter-clockwise as seen from outside the material, holes
/// clockwise.
///
/// A block of eight vertices with a square hole from top to bottom, for instance, has ten faces, two of them
/// with two loops each; see [`Polyhedron`] for a smaller example.
#[derive(Debug, Clone, Copy, Default)]
pub struct PolyhedronArrays<'a> {
    /// Coordinates in model units, finite and at most 2^256 in magnitude.
    pub vertices: &'a [[f64; 3]],
    /// The corners of all loops, one loop after another, as indices into `vertices`.
    pub corners: &'a [u32],
    /// Offsets of the loops in `corners`. A loop has at least three corners; its last edge leads back to the
    /// first corner.
    pub loops: &'a [u32],
    /// Offsets of the faces in the loops. The first loop of a face is its outer boundary, the others are
    /// holes.
    pub faces: &'a [u32],
    /// Offsets of the shells in the faces.
    pub shells: &'a [u32],
    /// Offsets of the solids in the shells. The first shell of a solid is its outer boundary, the others are
    /// voids.
    pub solids: &'a [u32],
}

/// Solids of plane faces that passed all checks.
///
/// * Every edge of a loop occurs once more in its shell, in the opposite direction. Topology is by index: two
///   vertices at one place are two vertices, so shells, and parts of one shell, may touch.
/// * The corners of each face lie in a plane up to a tolerance, its loops do not cross, and its holes lie
///   within its outer loop.
/// * The first shell of each solid encloses a positive volume, its voids enclose negative volumes. The bounds
///   of each void lie within those of the first shell, and one of its vertices lies within the first shell.
///
/// The solids become a [`TriangleMesh`] of the same vertices, closed and consistently oriented. From then on
/// the mesh defines the surface: if a face is not exactly plane, its triangles are the surface. The
/// polyhedron [keeps](Self::parts) the face, shell and solid of each triangle, and faces can [bear
/// values](Self::attribute). Needs the feature `std`.
///
/// ```
/// use leafless::mesh::{Polyhedron, PolyhedronArrays};
///
/// // A pyramid with a square base.
/// let polyhedron = Polyhedron::new(&PolyhedronArrays {
///     vertices: &[[0., 0., 0.], [2., 0., 0.], [2., 2., 0.], [0., 2., 0.], [1., 1., 3.]],
///     corners: &[3, 2, 1, 0, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4],
///     loops: &[0, 4, 7, 10, 13, 16],
///     faces: &[0, 1, 2, 3, 4, 5],
///     shells: &[0, 5],
///     solids: &[0, 1],
/// })?;
/// assert_eq!(polyhedron.mesh().triangles().len(), 6);
/// assert!((polyhedron.mesh().volume() - 4.0).abs() < 1e-12);
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Polyhedron {
    pub(super) mesh: TriangleMesh,
    deviation: f64,
    /// The face of each triangle.
    pub(super) faces: Vec<u32>,
    /// Offsets of the shells in the faces, and of the solids in the shells.
    pub(super) shells: Vec<u32>,
    pub(super) solids: Vec<u32>,
}

impl Polyhedron {
    /// Checks the arrays and triangulates the faces. Corners may lie off the plane of their face by at most
    /// 10^-9 of the longest extent of all vertices that loops use.
    ///
    /// O(n log n) expected, with about 100 bytes a corner of scratch memory and 320 of the largest face.
    ///
    /// # Errors
    /// [`Error::Polyhedron`] with the first defect and its place, the arrays first, then edges, faces and
    /// shells, each in ascending order; [`MeshError::NotFinite`], [`MeshError::TooLarge`],
    /// [`MeshError::TooMany`]; [`MeshError::Empty`] if there is no solid; [`Error::OutOfMemory`].
    pub fn new(arrays: &PolyhedronArrays) -> Result<Polyhedron, Error> {
        Self::checked(arrays, None)
    }

    /// Checks the arrays as [`new`](Self::new) does, but with the given tolerance (model units), and
    /// triangulates the faces. The tolerance limits the deviation of each face from a plane: half the
    /// distance between the two planes parallel to the face that enclose its corners.
    ///
    /// # Errors
    /// As `new`; [`Error::Argument`] if `tolerance` is negative or not a number.
    pub fn with_tolerance(arrays: &PolyhedronArrays, tolerance: f64) -> Result<Polyhedron, Error> {
        valid::tolerance("tolerance", tolerance)?;
        Self::checked(arrays, Some(tolerance))
    }

    /// Returns the surface of all solids.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// Returns the surface of all solids.
    pub fn into_mesh(self) -> TriangleMesh {
        self.mesh
    }

    /// Returns the maximum distance of a corner from the plane of its face, in model units and up to
    /// rounding.
    pub fn deviation(&self) -> f64 {
        self.deviation
    }

    fn checked(arrays: &PolyhedronArrays, tolerance: Option<f64>) -> Result<Polyhedron, Error> {
        let parts = Parts::of(arrays)?;
        if parts.solids.count() == 0 {
            return Err(MeshError::Empty.into());
        }
        let mut vertices = memory::with_capacity(arrays.vertices.len())?;
        for (&vertex, index) in arrays.vertices.iter().zip(0..) {
            vertices.push(normalised(vertex, index)?);
        }
        parts.check_loops(&vertices)?;
        parts.check_edges()?;

        let tolerance = tolerance.unwrap_or_else(|| {
            PLANE * Extent::of(parts.corners.iter().map(|&v| vertices[v as usize])).longest()
        });
        let mut triangles = Vec::new();
        // A loop of n corners has n - 2 triangles, and each hole adds two more.
        triangles.try_reserve(parts.corners.len())?;
        let mut faces: Vec<u32> = memory::with_capacity(parts.corners.len())?;
        let mut ends = Vec::new();
        let mut found = Faces::default();
        // The end of each shell's triangles.
        let mut shells: Vec<usize> = memory::with_capacity(parts.shells.count())?;
        for shell in 0..parts.shells.count() {
            for face in parts.shells.range(shell) {
                let (apart, extent) = parts.flatness(face, &vertices)?;
                if parts.face(face).len() > 3 {
                    found.add(apart, extent);
                }
                if apart > tolerance {
                    let (face, deviation) = (face as u64, apart);
                    return Err(PolyhedronError::NotPlane { face, deviation, tolerance }.into());
                }
                parts.triangulate(face, &vertices, &mut ends, &mut triangles)?;
                faces.try_reserve(triangles.len() - faces.len())?;
                faces.resize(triangles.len(), face as u32);
            }
            shells.push(triangles.len());
        }
        parts.check_shells(&vertices, &triangles, &shells)?;
        // A dropped triangle takes its face number with it.
        let mut attributes = memory::with_capacity(1)?;
        attributes.push(MeshAttribute::labels("", faces)?);
        let mut mesh = TriangleMesh::with_attributes(vertices, triangles, attributes)?.made_from(found);
        let faces = mesh.take_attributes().pop().map(MeshAttribute::into_labels).unwrap_or_default();
        let (shells, solids) = (memory::copied(arrays.shells)?, memory::copied(arrays.solids)?);
        Ok(Polyhedron { mesh, deviation: found.deviation, faces, shells, solids })
    }
}

/// Offsets that were checked to rise from 0 to the size of the level below.
#[derive(Clone, Copy)]
struct Offsets<'a>(&'a [u32]);

impl<'a> Offsets<'a> {
    fn of(
        offsets: &'a [u32],
        whole: usize,
        [array, parts]: [&'static str; 2],
    ) -> Result<Offsets<'a>, PolyhedronError> {
        let wrong = |index: usize| Err(PolyhedronError::Offsets { array, parts, index: index as u64 });
        if offsets.first() != Some(&0) {
            return wrong(0);
        }
        if let Some(k) = offsets.windows(2).position(|pair| pair[0] >= pair[1]) {
            return wrong(k + 1);
        }
        if offsets.last().is_none_or(|&last| last as usize != whole) {
            return wrong(offsets.len() - 1);
        }
        Ok(Offsets(offsets))
    }

    fn count(self) -> usize {
        self.0.len() - 1
    }

    fn range(self, part: usize) -> core::ops::Range<usize> {
        self.0[part] as usize..self.0[part + 1] as usize
    }

    /// Returns the part that contains `item`.
    fn part_of(self, item: usize) -> usize {
        self.0.partition_point(|&offset| offset as usize <= item) - 1
    }
}

/// The arrays, once their offsets are right.
struct Parts<'a> {
    corners: &'a [u32],
    loops: Offsets<'a>,
    faces: Offsets<'a>,
    shells: Offsets<'a>,
    solids: Offsets<'a>,
}

impl<'a> Parts<'a> {
    fn of(arrays: &PolyhedronArrays<'a>) -> Result<Parts<'a>, Error> {
        let many = |len: usize| u32::try_from(len).is_err();
        if many(arrays.vertices.len()) || many(arrays.corners.len()) {
            return Err(MeshError::TooMany.into());
        }
        let loops = Offsets::of(arrays.loops, arrays.corners.len(), ["loops", "corners"])?;
        let faces = Offsets::of(arrays.faces, loops.count(), ["faces", "loops"])?;
        let shells = Offsets::of(arrays.shells, faces.count(), ["shells", "faces"])?;
        let solids = Offsets::of(arrays.solids, shells.count(), ["solids", "shells"])?;
        Ok(Parts { corners: arrays.corners, loops, faces, shells, solids })
    }

    /// Returns the position of the next corner in a loop.
    fn next(&self, loop_: usize, corner: usize) -> usize {
        let range = self.loops.range(loop_);
        if corner + 1 < range.end { corner + 1 } else { range.start }
    }

    /// Checks that loops have at least three corners, that the corners exist, and that edges have a length.
    fn check_loops(&self, vertices: &[[f64; 3]]) -> Result<(), PolyhedronError> {
        let out_of_range = |&vertex: &u32| vertex as usize >= vertices.len();
        if let Some(corner) = self.corners.iter().position(out_of_range) {
            let vertex = self.corners[corner].into();
            return Err(PolyhedronError::Vertex {
                corner: corner as u64,
                vertex,
                vertices: vertices.len() as u64,
            });
        }
        for index in 0..self.loops.count() {
            let range = self.loops.range(index);
            if range.len() < 3 {
                return Err(PolyhedronError::FewCorners { index: index as u64, corners: range.len() as u64 });
            }
            for corner in range {
                let [from, to] = [corner, self.next(index, corner)].each(|c| self.corners[c]);
                if vertices[from as usize] == vertices[to as usize] {
                    let face = self.faces.part_of(index) as u64;
                    return Err(PolyhedronError::NoLength { face, from: from.into(), to: to.into() });
                }
            }
        }
        Ok(())
    }

    /// Checks that every edge occurs once in each direction in its shell.
    fn check_edges(&self) -> Result<(), Error> {
        /// A corner's edge, ordered so that the uses of one edge in a shell sort together.
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
        struct Edge {
            low: u32,
            high: u32,
            corner: u32,
            forward: bool,
        }
        let mut edges: Vec<Edge> = Vec::new();
        // The first corner whose edge is wrong, in the order of the arrays.
        for shell in 0..self.shells.count() {
            edges.clear();
            let faces = self.shells.range(shell);
            let loops = self.faces.range(faces.start).start..self.faces.range(faces.end - 1).end;
            let corners = self.loops.range(loops.start).start..self.loops.range(loops.end - 1).end;
            edges.try_reserve_exact(corners.len())?;
            for index in loops {
                for corner in self.loops.range(index) {
                    let [from, to] = [corner, self.next(index, corner)].each(|c| self.corners[c]);
                    let (low, high) = (from.min(to), from.max(to));
                    edges.push(Edge { low, high, corner: corner as u32, forward: from < to });
                }
            }
            edges.sort_unstable();
            let wrong = (edges.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high)))
                .filter(|uses| !matches!(uses, [a, b] if a.forward != b.forward))
                .min_by_key(|uses| uses[0].corner);
            let Some(uses) = wrong else { continue };
            let face = |edge: &Edge| self.faces.part_of(self.loops.part_of(edge.corner as usize)) as u64;
            let Edge { low, high, forward, .. } = uses[0];
            let (from, to) = if forward { (low, high) } else { (high, low) };
            let (shell, from, to) = (shell as u64, from.into(), to.into());
            return Err(match uses {
                [only] => PolyhedronError::Open { shell, face: face(only), from, to },
                [a, b] => PolyhedronError::Unoriented { shell, face: face(a), other: face(b), from, to },
                _ => {
                    let (face, uses) = (face(&uses[0]), uses.len() as u64);
                    PolyhedronError::NonManifold { shell, face, from, to, uses }
                }
            }
            .into());
        }
        Ok(())
    }

    /// Returns the corners of a face.
    fn face(&self, face: usize) -> &'a [u32] {
        let loops = self.faces.range(face);
        &self.corners[self.loops.range(loops.start).start..self.loops.range(loops.end - 1).end]
    }

    /// Returns half the distance between the two planes parallel to a face that enclose its corners, and the
    /// extent of the face.
    fn flatness(&self, face: usize, vertices: &[[f64; 3]]) -> Result<(f64, f64), PolyhedronError> {
        let corners = self.face(face);
        let flat = PolyhedronError::Flat { face: face as u64 };
        if corners.len() == 3 {
            return Ok((0.0, 0.0));
        }
        let outer = self.loops.range(self.faces.range(face).start);
        flatness(vertices, &self.corners[outer], corners).ok_or(flat)
    }

    fn triangulate(
        &self,
        face: usize,
        vertices: &[[f64; 3]],
        ends: &mut Vec<usize>,
        triangles: &mut Vec<[u32; 3]>,
    ) -> Result<(), Error> {
        let loops = self.faces.range(face);
        let start = self.loops.range(loops.start).start;
        ends.clear();
        ends.try_reserve(loops.len())?;
        ends.extend(loops.map(|index| self.loops.range(index).end - start));
        let edge_of = |corner: usize| {
            let corner = start + corner;
            let next = self.next(self.loops.part_of(corner), corner);
            let [from, to] = [corner, next].each(|c| u64::from(self.corners[c]));
            PolyhedronError::Crossing { face: face as u64, from, to }
        };
        triangulate(vertices, self.face(face), ends, triangles).map_err(|defect| match defect {
            PolygonDefect::OutOfMemory => Error::OutOfMemory,
            PolygonDefect::Flat | PolygonDefect::Input => PolyhedronError::Flat { face: face as u64 }.into(),
            PolygonDefect::Crossing(corner)
            | PolygonDefect::Touching(corner)
            | PolygonDefect::Folded([corner, _]) => edge_of(corner).into(),
            PolygonDefect::Nesting => PolyhedronError::Loops { face: face as u64 }.into(),
        })
    }

    /// Checks that the first shells of solids enclose a positive volume, and that the others enclose a
    /// negative volume within the first.
    fn check_shells(
        &self,
        vertices: &[[f64; 3]],
        triangles: &[[u32; 3]],
        ends: &[usize],
    ) -> Result<(), Error> {
        let of = |shell: usize| {
            let start = if shell == 0 { 0 } else { ends[shell - 1] };
            &triangles[start..ends[shell]]
        };
        for solid in 0..self.solids.count() {
            let mut shells = self.solids.range(solid);
            let Some(first) = shells.next() else { continue };
            let bounds = Extent::of(of(first).iter().flatten().map(|&v| vertices[v as usize]));
            if volume(vertices, of(first), &bounds) <= 0.0 {
                return Err(PolyhedronError::InsideOut { shell: first as u64 }.into());
            }
            for shell in shells.clone() {
                let inner = Extent::of(of(shell).iter().flatten().map(|&v| vertices[v as usize]));
                if volume(vertices, of(shell), &inner) >= 0.0 {
                    return Err(PolyhedronError::VoidOutward { shell: shell as u64 }.into());
                }
                if !bounds.hold(&inner) {
                    return Err(PolyhedronError::VoidOutside { shell: shell as u64 }.into());
                }
            }
            let outside = outside(vertices, of(first), shells.map(|shell| (shell, of(shell))))?;
            if let Some(&shell) = outside.first() {
                return Err(PolyhedronError::VoidOutside { shell: shell as u64 }.into());
            }
        }
        Ok(())
    }
}
