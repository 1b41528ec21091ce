//! The memory that the extraction of a surface takes in addition to the mesh.

use crate::allocator::most_held;
use leafless::surface::{Snap, simple_marching_cubes, surface_nets};
use leafless::{Csg, Frame, Rule, TriangleMesh, build, marching_cubes};
use leafless_testkit::alone;
#[test]
fn a_fifth_of_the_mesh_at_the_most() {
    let frame = Frame::new([-1.0; 3], 2.0, 8).unwrap();
    let tree = build(&Csg::ball([0.01, 0.02, 0.03], 0.9).unwrap(), &frame, Rule::Sampled, &alone()).unwrap();
    let measured = |extract: &dyn Fn() -> TriangleMesh| {
        let (mesh, most) = most_held(extract);
        let bytes = 24 * mesh.vertices().len() + 12 * mesh.triangles().len();
        let part = most as f64 / bytes as f64;
        println!("{} triangles: {part:.3} of the mesh", mesh.triangles().len());
        part
    };
    assert!(measured(&|| marching_cubes(tree.view(), None, &alone()).unwrap()) < 1.2);
    assert!(measured(&|| surface_nets(tree.view(), None, &alone()).unwrap()) < 1.4);
    assert!(measured(&|| simple_marching_cubes(tree.view(), Snap::Fat, None, &alone()).unwrap()) < 1.5);
}
