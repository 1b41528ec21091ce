//! Simple marching cubes: balanced, with vertices at samples, and of the published sizes.

use leafless::surface::{Resolve, Snap, simple_marching_cubes, simple_marching_cubes_solid};
use leafless::{Control, Csg, Error, Frame, Rule, Tag, TriangleMesh, build, marching_cubes};
use leafless_testkit::surfaces::{assert_balanced, components, euler_of_manifold};
use leafless_testkit::{Dense, Random, alone, cases, lattice_frame, shapes};
use proptest::prelude::*;
use std::collections::HashMap;

const SNAPS: [Snap; 2] = [Snap::Fat, Snap::Thin];

type Facet = [[i64; 3]; 3];

/// Returns the triangles in half cells with their multiplicity. Opposite triangles cancel.
fn chain(facets: impl Iterator<Item = Facet>) -> HashMap<Facet, i64> {
    let mut chain = HashMap::new();
    for mut facet in facets {
        let least = (0..3).min_by_key(|&k| facet[k]).unwrap();
        facet.rotate_left(least);
        let turned = facet[1] > facet[2];
        if turned {
            facet.swap(1, 2);
        }
        *chain.entry(facet).or_insert(0) += if turned { -1 } else { 1 };
    }
    chain.retain(|_, count| *count != 0);
    chain
}

fn facets(mesh: &TriangleMesh) -> impl Iterator<Item = Facet> {
    mesh.triangles().iter().map(|t| t.map(|v| mesh.vertices()[v as usize].map(|x| (2.0 * x) as i64)))
}

/// Returns the same triangles by moving the vertices of marching cubes.
fn moved(mesh: &TriangleMesh, dense: &Dense, snap: Snap) -> impl Iterator<Item = Facet> {
    let n = 2i64 << dense.depth;
    let inside = |at: [i64; 3]| {
        at.iter().all(|&a| (0..n).contains(&a)) && dense.at(at.map(|a| (a / 2) as u32)) == Tag::Full
    };
    let facets: Vec<Facet> = facets(mesh)
        .map(|facet| {
            facet.map(|vertex| {
                // A vertex between two centres has one even coordinate.
                let axis = (0..3).find(|&axis| vertex[axis] % 2 == 0).unwrap();
                let ends = [-1, 1].map(|step| {
                    let mut end = vertex;
                    end[axis] += step;
                    end
                });
                ends.into_iter().find(|&end| inside(end) == (snap == Snap::Thin)).unwrap()
            })
        })
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect();
    facets.into_iter()
}

#[track_caller]
fn check(dense: &Dense) {
    let tree = dense.octree();
    let cubes = marching_cubes(tree.view(), None, &alone()).unwrap();
    for snap in SNAPS {
        let mesh = simple_marching_cubes(tree.view(), snap, None, &alone()).unwrap();
        assert_balanced(&mesh);
        assert_eq!(chain(facets(&mesh)), chain(moved(&cubes, dense, snap)), "{dense:?}");
        let expected = moved(&cubes, dense, snap).count();
        assert_eq!(mesh.triangles().len(), expected);
        for triangle in mesh.triangles() {
            let [p, q, r] = triangle.map(|v| mesh.vertices()[v as usize]);
            let (u, v) = ([0, 1, 2].map(|k| q[k] - p[k]), [0, 1, 2].map(|k| r[k] - p[k]));
            let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
            assert!(normal != [0.0; 3] && normal.iter().all(|n| [-1.0, 0.0, 1.0].contains(n)));
        }
        let threads = simple_marching_cubes(tree.view(), snap, None, &Control::threads(3)).unwrap();
        assert_eq!((mesh.vertices(), mesh.triangles()), (threads.vertices(), threads.triangles()));
    }
}

proptest! {
    #![proptest_config(cases(150))]

    #[test]
    fn three_valued_octrees(shape in shapes(1..=5)) {
        let dense = shape.dense();
        check(&dense.resolved(Tag::Empty));
        if !dense.is_binary() {
            let tree = dense.octree();
            prop_assert!(simple_marching_cubes(tree.view(), Snap::Fat, None, &alone()).is_err());
            let mesh = simple_marching_cubes(tree.view(), Snap::Fat, Some(Resolve::Outer), &alone()).unwrap();
            let expected = simple_marching_cubes(dense.resolved(Tag::Full).octree().view(), Snap::Fat, None, &alone()).unwrap();
            prop_assert_eq!(mesh.triangles(), expected.triangles());
        }
    }
}

#[test]
fn random_bitmaps() {
    let mut random = Random(5);
    for round in 0..600 {
        let chance = [128, 30, 226, 80, 176, 8, 248][round % 7];
        let depth = 2 + (round % 2) as u8;
        let mut dense = Dense::uniform(depth, Tag::Empty);
        for tag in &mut dense.tags {
            *tag = if random.below(256) < chance { Tag::Full } else { Tag::Empty };
        }
        check(&dense);
    }
}

/// Suppose that no two inside cells meet in less than a face, nor two outside cells, and that nothing is one
/// cell thick. Then the mesh is a 2-manifold.
#[test]
fn manifold_where_cells_are() {
    let frame = lattice_frame(6);
    let centre = [32.0, 31.0, 33.0];
    let ball = Csg::ball(centre, 20.0).unwrap();
    let block = Csg::cuboid([10.0, 12.0, 20.0], [50.0, 40.0, 44.0]).unwrap();
    let frame_of = block.difference(&Csg::cuboid([20.0, 20.0, 0.0], [40.0, 32.0, 64.0]).unwrap()).unwrap();
    for (solid, euler) in [(ball, 2), (block, 2), (frame_of, 0)] {
        let tree = build(&solid, &frame, Rule::Sampled, &alone()).unwrap();
        for snap in SNAPS {
            let mesh = simple_marching_cubes(tree.view(), snap, None, &alone()).unwrap();
            assert_eq!((euler_of_manifold(&mesh), components(&mesh)), (euler, 1));
        }
    }
}

/// The tetrahedron of the published figures, in a volume of 100³: 16 471 vertices and 32 938 triangles. These
/// are the figures of x + y + z ≤ 89 between three planes of the lattice, with vertices at the outer ends:
/// (m + 2) (2 m + 3) of them for m = 89.
#[test]
fn the_published_tetrahedron() {
    let frame = lattice_frame(7);
    let corners = vec![[5.0; 3], [96.0, 5.0, 5.0], [5.0, 96.0, 5.0], [5.0, 5.0, 96.0]];
    let mesh = TriangleMesh::new(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap();
    let solid = leafless::MeshSolid::new(mesh, leafless::FillRule::NonZero).unwrap();
    let tree = build(&solid, &frame, Rule::Sampled, &alone()).unwrap();
    assert_eq!(tree.statistics().volume_cells(), (125_580, 125_580));
    let sizes = [(Snap::Fat, 16_471, 32_938), (Snap::Thin, 2 * 89 * 89 + 2, 4 * 89 * 89)];
    for (snap, vertices, triangles) in sizes {
        let mesh = simple_marching_cubes(tree.view(), snap, None, &alone()).unwrap();
        assert_eq!((mesh.vertices().len(), mesh.triangles().len()), (vertices, triangles), "{snap:?}");
        assert_eq!(euler_of_manifold(&mesh), 2);
        let report = mesh.report().unwrap();
        assert!(report.is_manifold() && report.euler_characteristic == 2);
    }
}

#[test]
fn corners_of_the_lattice() {
    let frame = Frame::new([0.0; 3], 8.0, 3).unwrap();
    let block = Csg::cuboid([2.0; 3], [5.0; 3]).unwrap();
    // By the shift of all samples, the corners at the lower faces lie inside, and those at the upper faces
    // outside.
    let mesh = simple_marching_cubes_solid(&block, &frame, Snap::Thin, &alone()).unwrap();
    assert_eq!((mesh.bounds(), mesh.volume()), (([2.0; 3], [4.0; 3]), 8.0));
    let mesh = simple_marching_cubes_solid(&block, &frame, Snap::Fat, &alone()).unwrap();
    assert_eq!(mesh.bounds(), ([1.0; 3], [5.0; 3]));
    assert_eq!(euler_of_manifold(&mesh), 2);
    assert!(matches!(
        simple_marching_cubes_solid(&block, &frame.with_depth(20).unwrap(), Snap::Fat, &alone()),
        Err(Error::Argument { name: "frame", .. })
    ));
}
