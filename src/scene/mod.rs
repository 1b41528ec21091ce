//! Scenes: the language of OpenSCAD's CSG dumps.

mod arguments;
mod check;
mod detect;
mod facets;
mod files;
mod grammar;
mod lower;
mod moves;
mod options;
mod report;

pub use detect::is_scene;
pub use facets::Facets;
pub use options::{SceneOptions, open_scene, read_scene};
pub use report::{SceneMesh, SceneReport};

use crate::lattice::Affine;
use crate::octree::Octree;
use crate::solid::{Csg, MeshSolid};
use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;

/// A solid described by a text: set operations of primitives, swept figures, meshes and octrees.
///
/// # The language
///
/// The language is that of the CSG dumps which OpenSCAD exports (`openscad -o part.csg part.scad`), plus some
/// calls of our own, and the calls of OpenSCAD's language that move objects. A number means exactly the
/// double to which it is read.
///
/// Circles, balls, cylinders and solids of revolution are exact, unless `$fn` is given and at most 12: then
/// they are the polygons, prisms and polyhedra that OpenSCAD draws, so that a hexagonal nut stays hexagonal.
/// [`SceneOptions`] can make all of them exact, or all of them polygons; [`report`](Scene::report) returns
/// how many there are of each. The corners of a polygon are those of OpenSCAD: a cosine and a sine, rounded
/// to doubles, times the radius. A `rotate_extrude` of a figure with curves is always exact.
///
/// | calls | meaning |
/// |---|---|
/// | `group` `union` `color` `render` | the union of the block |
/// | `intersection` `difference` | set operations |
/// | `multmatrix(m)` | the union of the block under a matrix of 4 × 4; the last row is `[0, 0, 0, 1]` |
/// | `translate(v)` `rotate(a, v)` `scale(v)` `mirror(v)` | the same, with the meaning of OpenSCAD's own language; quarter turns are exact |
/// | `cube(size, center)` `sphere(r)` `cylinder(h, r1, r2, center, r)` | solids, cones included |
/// | `polyhedron(points, faces)` | the inside of a mesh by [`FillRule::NonZero`](crate::FillRule::NonZero) |
/// | `square(size, center)` `circle(r)` `polygon(points, paths)` | figures of the plane |
/// | `linear_extrude(height, v, scale, center)` | the straight or tapered prism over figures |
/// | `rotate_extrude(angle, start)` | figures turned around the z axis |
/// | `halfspace([a, b, c, d])` | a x + b y + c z + d ≥ 0 |
/// | `quadric([a, …, j])` | as [`HalfSpace::quadric`](crate::solid::HalfSpace::quadric) |
/// | `power([A, a, n1], [B, b, n2], [C, c, n3], R)` | A (x − a)^n1 + B (y − b)^n2 + C (z − c)^n3 + R ≥ 0 |
/// | `torus(major, minor)` | around the z axis |
/// | `mesh(file, deviation)` `import(file, deviation)` | a mesh file of any known format, as [`open_mesh`](crate::exchange::open_mesh) reads it, [sewn](crate::TriangleMesh::sewn); the [true boundary](crate::TriangleMesh::with_deviation) lies within `deviation` of it |
/// | `octree(file)` | a file of this library |
///
/// The faces of a polyhedron may face inward or outward, but all must face the same side. If a face is
/// inverted or missing, the fill rule decides by the winding number, and the result differs from the intended
/// solid: near an inverted face, the inside becomes outside, and some of the outside becomes inside. The same
/// holds for mesh files. [`report`](Scene::report) counts such faces.
///
/// The sides of a `linear_extrude` whose scales along x and y differ are the ruled surfaces over the straight
/// edges, and `slices` has no effect. OpenSCAD approximates these surfaces the better the more slices there
/// are.
///
/// All calls on the top level are united. Calls marked by `%` or `*` are left out, as in OpenSCAD; `#` has no
/// effect. Empty groups are nothing. So are boxes, balls, cylinders and extrusions without extent or with a
/// negative one, and everything under a singular matrix. A difference of nothing, and an intersection with
/// nothing, are empty.
///
/// Not supported, and refused by name: `hull minkowski text projection offset resize surface roof fill`,
/// imports of files other than meshes, `linear_extrude` with `twist`, or with different scales for figures
/// with exact circles, `rotate_extrude` of exact ellipses, of figures on both sides of the axis (as far as
/// their bounds show), polygons with an outline that touches or crosses itself, matrices that are not affine,
/// the modifier `!`, and every call that dumps do not have. Several outlines of a polygon are combined by the
/// even-odd rule. Every error has a line and a column.
///
/// # Files from strangers
///
/// A text may contain anything. Nesting costs memory, not stack. All memory is linear in the text, except for
/// the files that it names, and for the polyhedra of [`Facets::Polygon`]: up to half a million half-spaces a
/// ball. The files are looked for in the given folder, and may be any file that the text names, also by
/// absolute paths or through `..`; without a folder no file is read.
#[derive(Clone)]
pub struct Scene {
    /// Each node comes after its parts; the last node is the whole. Empty if the scene is empty.
    nodes: Vec<Node>,
    report: Arc<SceneReport>,
}

impl Scene {
    /// Returns the findings of reading the scene.
    pub fn report(&self) -> &SceneReport {
        &self.report
    }
}

#[derive(Clone)]
enum Node {
    /// A solid for any frame.
    Solid(Csg),
    Mesh(MeshSolid),
    Octree(Box<Octree>),
    Union(Vec<usize>),
    Intersection(Vec<usize>),
    /// The first operand minus the others.
    Difference(Vec<usize>),
    Placed(usize, Affine),
}
