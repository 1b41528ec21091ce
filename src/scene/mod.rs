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

/// A solid that a text describes: set operations on primitives, swept figures, meshes and octrees.
///
/// # The language
///
/// That of the CSG dumps which OpenSCAD exports (`openscad -o part.csg part.scad`), with some calls of our
/// own, and those that move things from OpenSCAD's language. Numbers mean just the doubles that they are read
/// as.
///
/// Circles, balls, cylinders and solids of revolution are exact, unless `$fn` is given and not more than 12:
/// then they are the polygons, prisms and polyhedra that OpenSCAD draws, so that a hexagonal nut is one.
/// [`SceneOptions`] ask for all of them to be exact, or for all of them to be polygons;
/// [`report`](Scene::report) tells how many are. A polygon has its corners where OpenSCAD has them: a cosine
/// and a sine, rounded to doubles, times the radius. A `rotate_extrude` of a figure with curves is exact
/// always.
///
/// | calls | |
/// |---|---|
/// | `group` `union` `color` `render` | the union of what is in the block |
/// | `intersection` `difference` | set operations |
/// | `multmatrix(m)` | the union of the block under a matrix of 4 × 4; the last row is `[0, 0, 0, 1]` |
/// | `translate(v)` `rotate(a, v)` `scale(v)` `mirror(v)` | the same, as OpenSCAD's own language says it; quarter turns are exact |
/// | `cube(size, center)` `sphere(r)` `cylinder(h, r1, r2, center, r)` | solids, cones included |
/// | `polyhedron(points, faces)` | what a mesh encloses by [`FillRule::NonZero`](crate::FillRule::NonZero) |
/// | `square(size, center)` `circle(r)` `polygon(points, paths)` | figures of the plane |
/// | `linear_extrude(height, v, scale, center)` | the prism over figures, or the tapered one |
/// | `rotate_extrude(angle, start)` | figures turned around the z axis |
/// | `halfspace([a, b, c, d])` | a x + b y + c z + d ≥ 0 |
/// | `quadric([a, …, j])` | as [`HalfSpace::quadric`](crate::solid::HalfSpace::quadric) |
/// | `power([A, a, n1], [B, b, n2], [C, c, n3], R)` | A (x − a)^n1 + B (y − b)^n2 + C (z − c)^n3 + R ≥ 0 |
/// | `torus(major, minor)` | around the z axis |
/// | `mesh(file, deviation)` `import(file, deviation)` | a mesh file of any known format, as [`open_mesh`](crate::exchange::open_mesh) reads it, [sewn](crate::TriangleMesh::sewn); within `deviation` of it lies the [true boundary](crate::TriangleMesh::with_deviation) |
/// | `octree(file)` | a file of this library |
///
/// The faces of a polyhedron may face inward as well as outward, but all must face one side. Where one is
/// turned over or missing, the fill rule decides by the winding number, and what it encloses is not what was
/// meant: near a face that is turned over, the inside becomes outside, and some of the outside becomes
/// inside. The same holds for mesh files. [`report`](Scene::report) tells of such faces.
///
/// The sides of a `linear_extrude` whose scales along x and y differ are the ruled surfaces over the straight
/// edges, and `slices` has no effect: OpenSCAD comes the closer to them the more slices there are.
///
/// All calls on the top level are united. What is marked by `%` or `*` is left out, as OpenSCAD does; `#`
/// means nothing. Empty groups are nothing, and so are boxes, balls, cylinders and extrusions without extent
/// or with a negative one, and what is put under a singular matrix. A difference of nothing, and an
/// intersection with nothing, are empty.
///
/// Not supported, and refused by name: `hull minkowski text projection offset resize surface roof fill`,
/// imports of other files than meshes, `linear_extrude` with `twist`, or with different scales for figures
/// with exact circles, `rotate_extrude` of exact ellipses, of figures on both sides of the axis (as far as
/// their bounds tell), polygons of which an outline touches or crosses itself, matrices that are not affine,
/// the modifier `!`, and every call that dumps do not have. Several outlines of a polygon are combined by the
/// even-odd rule. Every error says line and column.
///
/// # Files from strangers
///
/// A text may hold anything: nesting costs memory, not stack, and all memory is linear in the text, but for
/// the files that it names, and for what [`Facets::Polygon`] makes of it: up to half a million half-spaces a
/// ball. The files are looked for in the folder given and are whatever file the text says, by absolute paths
/// or through `..` too; without a folder there are none.
#[derive(Clone)]
pub struct Scene {
    /// Each after those that it consists of; the last one is the whole. Empty, if there is nothing.
    nodes: Vec<Node>,
    report: Arc<SceneReport>,
}

impl Scene {
    /// What was found while the scene was read.
    pub fn report(&self) -> &SceneReport {
        &self.report
    }
}

#[derive(Clone)]
enum Node {
    /// Known on any frame.
    Solid(Csg),
    Mesh(MeshSolid),
    Octree(Box<Octree>),
    Union(Vec<usize>),
    Intersection(Vec<usize>),
    /// The first without the others.
    Difference(Vec<usize>),
    Placed(usize, Affine),
}
