//! Reports about meshes.

use crate::lattice::Each;
use alloc::boxed::Box;
use alloc::vec::Vec;

use glam::{DVec3, Vec3Swizzles};

use super::boundary::EdgeLoops;
use super::overlap::overlaps;
use super::topology::{Bodies, Topology};
use super::triangle_mesh::{Details, TriangleMesh};
use crate::error::Error;
use crate::lattice::exact::sign_of_products;
use crate::memory;

/// The findings of building a mesh, and the connectivity of its triangles.
///
/// [`TriangleMesh::defects`] lists the places of the defects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshReport {
    /// Number of triangles passed in: `triangles` + `degenerate`.
    pub facets_read: u64,
    /// Number of triangles of the mesh.
    pub triangles: u64,
    /// Number of vertices of the mesh, all at different places. Some may be used by no triangle.
    pub vertices: u64,
    /// Number of vertices passed in that lay on an earlier one; for a triangle soup that was not sewn, 3
    /// `facets_read` - `vertices`.
    pub welded: u64,
    /// Number of triangles that were dropped because two of their corners lie at one place.
    pub degenerate: u64,
    /// Number of edges, each counted once.
    pub edges: u64,
    /// V − E + F, for the vertices that triangles use, the edges and the triangles. For a 2-manifold: 2 for
    /// each component minus 2 for each handle.
    pub euler_characteristic: i64,
    /// Number of edges used by an odd number of triangles. A mesh is closed if there is none.
    pub boundary_edges: u64,
    /// Number of loops of the boundary edges, without vertices that occur twice: holes of the surface and
    /// rims of sheets.
    pub boundary_loops: u64,
    /// Number of edges used by an even number of triangles, but not by equally many in each direction. A
    /// closed mesh is consistently oriented if there is none.
    pub misoriented_edges: u64,
    /// Number of edges used by more than two triangles, for instance where two bodies touch. They do no harm.
    pub non_manifold_edges: u64,
    /// Number of triangles that repeat an earlier one, in the same direction. They count as often as they
    /// occur.
    pub duplicate: u64,
    /// Number of pairs of triangles with the same corners in opposite directions: walls without thickness.
    /// The two cancel each other.
    pub opposite: u64,
    /// Number of triangles without area whose corners are three different vertices. They do no harm.
    pub flat: u64,
    /// Number of bodies: sets of triangles that are connected by edges. Bodies that touch only in single
    /// vertices count separately, and so do the outer and the inner surface of a hollow body.
    pub bodies: u64,
    /// Number of bodies with an edge whose triangles do not cancel each other: open or not consistently
    /// oriented.
    pub open_bodies: u64,
    /// Number of closed, consistently oriented bodies that enclose a negative volume: cavities, and inverted
    /// bodies.
    pub inside_out_bodies: u64,
    /// Number of vertices that [`sewn`](TriangleMesh::sewn) moved onto another one.
    pub sewn: u64,
    /// Maximum distance along an axis by which sewing moved a vertex or a placement rounded it, in model
    /// units. (A stated deviation is not included: [`TriangleMesh::displacement`] includes both.)
    pub displacement: f64,
    /// Number of closed bodies that are proven to overlap another one: their surfaces cross, or one lies
    /// within the other with the same sense and no cavity between them. There the surface winds around points
    /// more than once, and the sum of signed volumes, [`TriangleMesh::volume`], differs from the volume that
    /// a fill rule encloses. Without such bodies, undecided bodies, inverted bodies and bodies that cross
    /// themselves, the two are equal.
    pub overlapping_bodies: u64,
    /// Number of closed bodies that may overlap another one, without a proof: they touch in a way that is not
    /// decided, such as a peg that fits its hole exactly, or the limit of work was reached.
    pub undecided_bodies: u64,
    /// Number of faces of more than three corners from which the triangles were made: faces of OBJ, PLY and
    /// OFF files and of a [`Polyhedron`](crate::mesh::Polyhedron). 0 for other meshes.
    pub polygons: u64,
    /// Number of faces of more than three corners that are not flat: corners lie off the face's plane by more
    /// than 2^-40 of its extent. Such a face has no definite shape. The mesh is one of its triangulations,
    /// and every proof about the mesh is about that triangulation.
    pub bent_polygons: u64,
    /// Half the distance, in model units and up to rounding, between the two planes parallel to a face that
    /// enclose all its corners, for the face where it is greatest. Each triangulation of the face lies
    /// between the planes. (The plane's normal is the mean one, after Newell.)
    pub polygon_deviation: f64,
}

impl MeshReport {
    /// Returns whether the mesh is closed and consistently oriented: every edge is used equally often in both
    /// directions. (True for an empty mesh.)
    pub fn is_closed(&self) -> bool {
        self.boundary_edges == 0 && self.misoriented_edges == 0
    }

    /// Returns whether exactly two triangles meet on every edge and use it in opposite directions.
    pub fn is_manifold(&self) -> bool {
        self.is_closed() && self.non_manifold_edges == 0
    }
}

impl TriangleMesh {
    /// Returns the findings of building the mesh, and the connectivity of its triangles.
    ///
    /// The first call analyses the edges. This takes O(t + v) time, O(n log n) for the n edges of the
    /// boundary, and 28 bytes per triangle and 9 per vertex of scratch memory. The call also searches for
    /// overlapping bodies where their boxes meet, with at most 2^24 steps plus 128 a triangle. Later calls
    /// are free.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn report(&self) -> Result<MeshReport, Error> {
        let details = self.details.get_or_try_init(|| self.find_details())?;
        let topology = self.topology()?;
        let triangles = self.triangles().len() as u64;
        Ok(MeshReport {
            facets_read: triangles + self.degenerate,
            triangles,
            vertices: self.vertices().len() as u64,
            welded: self.welded,
            degenerate: self.degenerate,
            edges: topology.edges,
            euler_characteristic: (topology.used_vertices + triangles) as i64 - topology.edges as i64,
            boundary_edges: topology.boundary_edges,
            boundary_loops: details.boundary_loops,
            misoriented_edges: topology.misoriented_edges,
            non_manifold_edges: topology.non_manifold_edges,
            duplicate: topology.duplicate,
            opposite: topology.opposite,
            flat: details.flat,
            bodies: topology.bodies,
            open_bodies: details.open_bodies,
            inside_out_bodies: details.inside_out_bodies,
            sewn: self.sewn,
            displacement: self.vertex_displacement(),
            overlapping_bodies: details.overlaps.overlapping,
            undecided_bodies: details.overlaps.undecided,
            polygons: self.faces.polygons,
            bent_polygons: self.faces.bent,
            polygon_deviation: self.faces.deviation,
        })
    }

    /// Returns the body of each triangle. A body is a set of triangles that are connected by edges. Bodies
    /// are numbered by their first triangles: body 0 has the first triangle, and body 1 has the first
    /// triangle that is not in body 0. There are [`MeshReport::bodies`] of them. Shells that touch only in
    /// single vertices, or lie within each other, are different bodies.
    ///
    /// O(t + v), with 28 bytes per triangle and 9 per vertex of scratch memory.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn bodies(&self) -> Result<Vec<u32>, Error> {
        Ok(Topology::with_bodies(self.triangles(), self.vertices().len())?.1.of_triangles)
    }

    fn find_details(&self) -> Result<Box<Details>, Error> {
        let (topology, bodies) = Topology::with_bodies(self.triangles(), self.vertices().len())?;
        let open = open_edges(&topology.boundary)?;
        let details =
            self.look_at_triangles(&topology, &bodies, EdgeLoops::of(&open, false)?.count() as u64)?;
        // If another thread has set it already, the value is the same.
        let _ = self.topology.set(Box::new(topology));
        Ok(Box::new(details))
    }

    /// Finds the properties that depend on the vertices' positions.
    fn look_at_triangles(
        &self,
        topology: &Topology,
        bodies: &Bodies,
        boundary_loops: u64,
    ) -> Result<Details, Error> {
        /// Six times the volume, from tetrahedra with a vertex of the body; NaN for an open body.
        struct Body {
            origin: u32,
            triangles: u32,
            volume: f64,
            /// The sum of the products' magnitudes.
            magnitude: f64,
        }
        impl Body {
            /// Returns the sign of the volume, if rounding cannot change it: 0 for walls without thickness,
            /// and if open.
            fn sense(&self) -> i32 {
                let error = f64::EPSILON * (f64::from(self.triangles) + 16.0) * self.magnitude;
                i32::from(self.volume > error) - i32::from(self.volume < -error)
            }
        }
        let mut flat = 0;
        let mut found: Vec<Body> = Vec::new();
        // There are at most as many bodies as triangles, which are in memory.
        found.try_reserve_exact(topology.bodies as usize)?;
        for (triangle, &body) in self.triangles().iter().zip(&bodies.of_triangles) {
            flat += u64::from(self.is_flat(triangle));
            // Numbers ascend in the order of first triangles.
            if body as usize == found.len() {
                found.push(Body { origin: triangle[0], triangles: 0, volume: 0.0, magnitude: 0.0 });
            }
            let body = &mut found[body as usize];
            let origin = self.position(body.origin);
            let [a, b, c] = triangle.each(|v| self.position(v) - origin);
            body.triangles += 1;
            body.volume += a.dot(b.cross(c));
            let [a, b, c] = [a, b, c].each(DVec3::abs);
            body.magnitude += a.dot(b.yzx() * c.zxy() + b.zxy() * c.yzx());
        }
        for &triangle in &bodies.torn {
            found[bodies.of_triangles[triangle as usize] as usize].volume = f64::NAN;
        }
        let count = |test: fn(&Body) -> bool| found.iter().filter(|body| test(body)).count() as u64;
        let (open_bodies, inside_out_bodies) =
            (count(|body| body.volume.is_nan()), count(|body| body.sense() < 0));
        let senses = memory::collected(found.iter().map(Body::sense))?;
        let overlaps = overlaps(self, &bodies.of_triangles, &senses, topology.opposite > 0)?;
        Ok(Details { boundary_loops, flat, open_bodies, inside_out_bodies, overlaps })
    }

    /// Returns whether the corners of a triangle lie exactly on a line.
    pub(super) fn is_flat(&self, triangle: &[u32; 3]) -> bool {
        are_on_a_line(triangle.each(|v| self.vertices()[v as usize]))
    }
}

/// Returns whether three points lie exactly on a line.
pub(super) fn are_on_a_line(points: [[f64; 3]; 3]) -> bool {
    (0..3).all(|axis| is_straight(points.each(|p| [p[axis], p[(axis + 1) % 3]])))
}

/// Returns the edges of a boundary that an odd number of triangles use: those that occur an odd number of
/// times.
pub(super) fn open_edges(boundary: &[[u32; 2]]) -> Result<Vec<[u32; 2]>, Error> {
    let mut open = memory::with_capacity(boundary.len())?;
    open.extend(boundary.chunk_by(|a, b| a == b).filter(|same| same.len() % 2 == 1).map(|same| same[0]));
    Ok(open)
}

/// Returns whether three points of a plane lie on a line.
fn is_straight([a, b, c]: [[f64; 2]; 3]) -> bool {
    let (left, right) = ((a[0] - c[0]) * (b[1] - c[1]), (a[1] - c[1]) * (b[0] - c[0]));
    // Six roundings, each of at most 2^-53.
    if (left - right).abs() > 4e-16 * (left.abs() + right.abs()) {
        return false;
    }
    // Twice the area, without differences.
    let cross = |p: [f64; 2], q: [f64; 2]| [(p[0], q[1]), (-p[1], q[0])];
    sign_of_products([cross(a, b), cross(b, c), cross(c, a)].as_flattened()) == 0
}
