//! Scenes: the language of OpenSCAD's CSG dumps.

mod arguments;
mod check;
mod detect;
mod grammar;
mod lower;

use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;
use std::path::Path;

use crate::error::Error;
use crate::lattice::Affine;
use crate::mesh::{FillRule, TriangleMesh};
use crate::octree::Octree;
use crate::solid::Csg;
pub use detect::is_scene;

/// A solid that a text describes: set operations on primitives, swept figures, meshes and octrees.
///
/// # The language
///
/// That of the CSG dumps which OpenSCAD exports (`openscad -o part.csg part.scad`), with some calls of our
/// own. Curved shapes are exact: `$fn`, `$fa` and `$fs` are ignored, a cylinder is round and not a prism.
/// Numbers mean just the doubles that they are read as, and nothing is rounded on the way to the solid.
///
/// | calls | |
/// |---|---|
/// | `group` `union` `color` `render` | the union of what is in the block |
/// | `intersection` `difference` | set operations |
/// | `multmatrix(m)` | the union of the block under a matrix of 4 × 4; the last row is `[0, 0, 0, 1]` |
/// | `cube(size, center)` `sphere(r)` `cylinder(h, r1, r2, center, r)` | solids, cones included |
/// | `polyhedron(points, faces)` | a closed mesh, whose faces may face either side |
/// | `square(size, center)` `circle(r)` `polygon(points, paths)` | figures of the plane |
/// | `linear_extrude(height, v, scale, center)` | the prism over figures, or the tapered one |
/// | `rotate_extrude(angle, start)` | figures turned around the z axis |
/// | `halfspace([a, b, c, d])` | a x + b y + c z + d ≥ 0 |
/// | `quadric([a, …, j])` | as [`HalfSpace::quadric`](crate::HalfSpace::quadric) |
/// | `power([A, a, n1], [B, b, n2], [C, c, n3], R)` | A (x − a)^n1 + B (y − b)^n2 + C (z − c)^n3 + R ≥ 0 |
/// | `torus(major, minor)` | around the z axis |
/// | `mesh(file)` `import(file)` | a mesh file of any known format, as [`open_mesh`](crate::exchange::open_mesh) reads it |
/// | `octree(file)` | a file of this library |
///
/// All calls on the top level are united. What is marked by `%` or `*` is left out, as OpenSCAD does; `#`
/// means nothing. Empty groups are nothing, and so are boxes, balls, cylinders and extrusions without extent
/// or with a negative one, and what is put under a singular matrix. A difference of nothing, and an
/// intersection with nothing, are empty.
///
/// Not supported, and refused by name: `hull minkowski text projection offset resize surface roof fill`,
/// imports of other files than meshes, `linear_extrude` with `twist`, or with different scales for figures
/// with circles, `rotate_extrude` of ellipses, of figures on both sides of the axis (as far as their bounds
/// tell), polygons of which an outline touches or crosses itself, matrices that are not affine, the modifier
/// `!`, and every call that dumps do not have. Several outlines of a polygon are combined by the even-odd
/// rule. Every error says line and column.
///
/// # Files from strangers
///
/// A text may hold anything: nesting costs memory, not stack, and all memory is linear in the text, but for
/// the files that it names. These are looked for in the folder given and are whatever file the text says, by
/// absolute paths or through `..` too; without a folder there are none.
#[derive(Clone)]
pub struct Scene {
    /// Each after those that it consists of; the last one is the whole. Empty, if there is nothing.
    nodes: Vec<Node>,
}

#[derive(Clone)]
enum Node {
    /// Known on any frame.
    Solid(Csg),
    Mesh(Arc<TriangleMesh>, FillRule),
    Octree(Box<Octree>),
    Union(Vec<usize>),
    Intersection(Vec<usize>),
    /// The first without the others.
    Difference(Vec<usize>),
    Placed(usize, Affine),
}

/// Reads a scene from its text, in UTF-8. Files that it names are looked for in `folder`; without one they
/// are refused.
///
/// O(text), but for polygons, which are O(n²) at worst, and the files.
///
/// # Errors
/// [`SceneError`](crate::SceneError) with line and column for whatever is wrong with the text or a file that
/// it names; [`Error::OutOfMemory`].
pub fn read_scene(text: impl AsRef<[u8]>, folder: Option<&Path>) -> Result<Scene, Error> {
    let bytes = text.as_ref();
    let text = core::str::from_utf8(bytes).map_err(|error| {
        let valid = core::str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default();
        grammar::fault(valid, valid.len(), "the text is not UTF-8")
    })?;
    check::check(&grammar::parse(text)?, folder)
}

/// Reads a scene from a file. Files that it names are looked for beside it.
///
/// # Errors
/// As [`read_scene`]; [`Error::Io`] if the file itself cannot be read.
pub fn open_scene(path: impl AsRef<Path>) -> Result<Scene, Error> {
    let path = path.as_ref();
    read_scene(std::fs::read(path)?, Some(path.parent().unwrap_or(Path::new(""))))
}
