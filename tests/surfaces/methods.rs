//! All surface methods on one list of solids: closed, outward, of the right volume, and consistent.

use leafless::solid::{Band, Samples, VoxelGrid};
use leafless::surface::{
    Resolve, Snap, coplanar_shrink, published_shrink, simple_marching_cubes, surface_nets,
};
use leafless::{
    Affine, Control, Csg, Error, FillRule, Frame, MeshSolid, Octree, OctreeRef, Rule, Solid, Volume, build,
    exchange, file, marching_cubes,
};
use leafless_testkit::surfaces::{assert_balanced, euler_of_manifold, outlines};
use leafless_testkit::{Aligned, Random, alone, lattice_frame, model};

/// Sets of four normals that add up to zero: the faces of a tetrahedron. All 13 directions occur.
const TETRAHEDRA: [[[f64; 3]; 4]; 10] = [
    [[1., 1., 1.], [-1., 0., 0.], [0., -1., 0.], [0., 0., -1.]],
    [[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]],
    [[1., 1., 0.], [-1., 0., 1.], [0., -1., 1.], [0., 0., -1.]],
    [[1., 0., 1.], [-1., 1., 0.], [0., -1., 0.], [0., 0., -1.]],
    [[1., -1., 1.], [-1., 0., 0.], [0., 1., 0.], [0., 0., -1.]],
    [[1., 1., -1.], [-1., 0., 0.], [0., -1., 0.], [0., 0., 1.]],
    [[1., -1., -1.], [-1., 0., 0.], [0., 1., 0.], [0., 0., 1.]],
    [[0., 1., -1.], [1., -1., 0.], [-1., 0., 0.], [0., 0., 1.]],
    [[0., 1., 1.], [1., -1., 0.], [-1., 0., 1.], [0., 0., -1.]],
    [[1., 0., -1.], [-1., 1., 0.], [0., -1., 0.], [0., 0., 1.]],
];

/// Solids within the first `size` of 2^depth cells along each axis.
fn solids(depth: u8, size: f64) -> Vec<(String, Octree)> {
    let frame = lattice_frame(depth);
    let sampled = |solid: &Csg| build(solid, &frame, Rule::Sampled, &alone()).unwrap();
    let centre = [0.5 * size, 0.49 * size, 0.47 * size];
    let block = |a: [f64; 3], b: [f64; 3]| Csg::cuboid(a.map(|x| x * size), b.map(|x| x * size)).unwrap();
    let mut list = Vec::new();
    for (i, normals) in TETRAHEDRA.iter().enumerate() {
        let faces = normals.map(|n| {
            let at: f64 = (0..3).map(|k| n[k] * centre[k].round()).sum();
            Csg::half_space(n.map(|x| -x), at + (0.13 * size).round()).unwrap()
        });
        let within = block([0.0; 3], [1.0; 3]);
        let parts = faces.into_iter().chain([within]);
        list.push((format!("tetrahedron {i}"), sampled(&Csg::intersection_of(parts).unwrap())));
    }
    // By 30 degrees around z, then by 20 around x.
    let ([s, c], [t, d]) = ([0.5, 0.75f64.sqrt()], [0.342_020_143, 0.939_692_621]);
    let [x, y, z] = centre;
    let turn = Affine::new([[c, -s, 0.0, x], [d * s, d * c, -t, y], [t * s, t * c, d, z]]).unwrap();
    let turned = |solid: Csg| sampled(&solid.placed(&turn).unwrap());
    let a = 0.25 * size;
    list.push(("block".into(), sampled(&block([0.1, 0.2, 0.3], [0.8, 0.7, 0.5]))));
    list.push(("turned block".into(), turned(Csg::cuboid([-a; 3], [a, 0.8 * a, 1.2 * a]).unwrap())));
    list.push(("torus".into(), turned(Csg::torus(1.1 * a, 0.5 * a).unwrap())));
    list.push(("ball".into(), sampled(&Csg::ball(centre, 1.5 * a).unwrap())));
    let bore = Csg::cylinder(0.4 * a, -2.0 * a, 2.0 * a).unwrap();
    let plate = Csg::cuboid([-a, -a, -0.4 * a], [a, a, 0.4 * a]).unwrap();
    list.push(("bored plate".into(), turned(plate.difference(&bore).unwrap())));
    list.push(("scan".into(), scan(&frame, size)));
    list
}

/// A volume like the tomography of a cast part: a body with two bores and a pore, blurred, with noise.
fn scan(frame: &Frame, size: f64) -> Octree {
    let n = size as u32;
    let mut random = Random(6);
    let mut samples = Vec::new();
    for i in 0..n * n * n {
        let [x, y, z] = [i % n, i / n % n, i / (n * n)].map(|a| (f64::from(a) + 0.5) / size - 0.5);
        // Distances in the whole universe, negative inside.
        let body = (x.abs() - 0.4).max(y.abs() - 0.3).max(z.abs() - 0.25);
        let bores = [-0.2, 0.2].map(|at| 0.1 - (x - at).hypot(y)).into_iter().fold(f64::MIN, f64::max);
        let pore = 0.07 - (x * x + (y - 0.2) * (y - 0.2) + z * z).sqrt();
        let depth = -body.max(bores).max(pore) * size;
        samples.push((128.0 + 60.0 * depth.clamp(-1.5, 1.5) + random.between(-45.0, 45.0)) as u8);
    }
    let grid = VoxelGrid::new([n; 3], [0.0; 3], [1.0; 3]).unwrap();
    let band = Band::at_least(128.0).unwrap();
    let volume = Volume::new(Samples::U8(samples.into()), &grid, band, &alone()).unwrap();
    build(&volume, frame, Rule::Sampled, &alone()).unwrap()
}

/// Returns the number of dual cells with samples of both kinds. The surroundings are outside.
fn mixed(tree: &OctreeRef<'_>) -> u64 {
    let n = tree.frame().cells();
    let words = n.div_ceil(64) as usize;
    let mut bits = vec![0u64; words * (n * n) as usize];
    tree.bitmap(tree.frame().depth(), [0; 3], [n; 3], &mut bits, None, &alone()).unwrap();
    let n = i64::from(n);
    let row = |y: i64, z: i64| -> Vec<bool> {
        let inside = |x: i64| bits[words * (z * n + y) as usize + x as usize / 64] >> (x % 64) & 1 == 1;
        let is_outside = !(0..n).contains(&y) || !(0..n).contains(&z);
        (-1..=n).map(|x| !is_outside && (0..n).contains(&x) && inside(x)).collect()
    };
    let mut count = 0;
    for z in -1..n {
        for y in -1..n {
            let rows = [row(y, z), row(y + 1, z), row(y, z + 1), row(y + 1, z + 1)];
            for x in 0..=n as usize {
                let inside =
                    rows.iter().map(|row| usize::from(row[x]) + usize::from(row[x + 1])).sum::<usize>();
                count += u64::from(!matches!(inside, 0 | 8));
            }
        }
    }
    count
}

#[track_caller]
fn check(name: &str, octree: &Octree) {
    let tree = octree.view();
    let cell = tree.frame().cell_size().powi(3);
    let (voxels, tolerance) = (octree.statistics().volume().lower, cell * mixed(tree) as f64);
    let cubes = marching_cubes(tree, None, &alone()).unwrap();
    euler_of_manifold(&cubes);
    assert!((cubes.volume() - voxels).abs() <= tolerance, "{name}");
    for snap in [Snap::Fat, Snap::Thin] {
        let all = simple_marching_cubes(tree, snap, None, &alone()).unwrap();
        let few = coplanar_shrink(tree, snap, None, &alone()).unwrap();
        assert_balanced(&all);
        assert_balanced(&few);
        // In every plane the differences cancel, so that area and volume are the same.
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * a.abs().max(cell);
        assert!(close(few.volume(), all.volume()) && close(few.area(), all.area()), "{name}");
        assert!((all.volume() - voxels).abs() <= tolerance && all.volume() > 0.0, "{name}");
        let reports = [&all, &few].map(|mesh| mesh.report().unwrap());
        if reports[0].is_manifold() {
            assert!(reports[1].is_manifold(), "{name}");
            assert_eq!(euler_of_manifold(&few), reports[0].euler_characteristic, "{name}");
            assert_eq!(reports[1].bodies, reports[0].bodies, "{name}");
        }
        let published = published_shrink(tree, snap, None, &alone()).unwrap();
        assert!(published.triangles().len() <= all.triangles().len(), "{name}");
        if tree.frame().cells() <= 64 && tree.frame().cell_size() == 1.0 {
            assert_eq!(outlines(&few), outlines(&all), "{name}");
        }
    }
}

#[test]
fn solids_in_sixty_cubed() {
    solids(6, 60.0).iter().for_each(|(name, tree)| check(name, tree));
}

#[test]
fn models_of_128() {
    models(7);
}

#[test]
#[ignore = "takes minutes"]
fn solids_in_one_and_two_hundred_cubed() {
    solids(7, 100.0).iter().for_each(|(name, tree)| check(name, tree));
    solids(8, 200.0).iter().for_each(|(name, tree)| check(name, tree));
}

#[test]
#[ignore = "takes minutes, and needs models"]
fn models_of_256_and_512() {
    models(8);
    models(9);
}

fn models(depth: u8) {
    for name in ["bunny-closed.stl", "featuretype.STL", "fandisk.obj", "angle_block.STL", "plate_holes.STL"] {
        let Some(path) = model(name) else { continue };
        let mesh = exchange::open_mesh(&path, &exchange::MeshOptions::default()).unwrap().mesh;
        let solid = MeshSolid::new(mesh, FillRule::NonZero).unwrap();
        let bounds = solid.bounds().unwrap();
        let frame = Frame::around(bounds.min, bounds.max, depth).unwrap();
        check(name, &build(&solid, &frame, Rule::Sampled, &Control::default()).unwrap());
    }
}

/// Undetected damage ends the work, or gives another consistent mesh.
#[test]
fn damaged_trees() {
    let frame = Frame::new([-1.0; 3], 2.0, 6).unwrap();
    let ball = Csg::ball([0.1, -0.05, 0.03], 0.77).unwrap();
    let good = file::to_bytes(&build(&ball, &frame, Rule::Certified, &alone()).unwrap()).unwrap();
    let mut random = Random(10);
    let mut seen = [0; 2];
    for round in 0..100 {
        let mut bytes = good.clone();
        for _ in 0..if round % 2 == 0 { 3 } else { good.len() / 20 } {
            let at = 1024 + random.below(good.len() as u64 - 1024) as usize;
            bytes[at] = random.bits() as u8;
        }
        let bytes = Aligned::new(&bytes);
        let Ok(tree) = file::view(bytes.bytes()) else { continue };
        for resolve in [Resolve::Inner, Resolve::Outer] {
            match coplanar_shrink(&tree, Snap::Fat, Some(resolve), &alone()) {
                Ok(mesh) => {
                    seen[0] += 1;
                    assert_balanced(&mesh);
                    published_shrink(&tree, Snap::Thin, Some(resolve), &alone()).unwrap();
                }
                Err(error) => {
                    seen[1] += 1;
                    assert!(matches!(error, Error::Damaged(_)), "{error}");
                }
            }
        }
    }
    assert!(seen[0] > 5 && seen[1] > 5, "{seen:?}");
}

/// The reported progress of each method rises, and ends with the whole.
#[test]
fn progress_ends_with_all() {
    let frame = lattice_frame(6);
    let ball = Csg::ball([31.0; 3], 25.0).unwrap();
    let tree = build(&ball, &frame, Rule::Sampled, &alone()).unwrap();
    let tree = tree.view();
    let seen = std::sync::Mutex::new(vec![]);
    let progress = |done: f64| seen.lock().unwrap().push(done);
    let control = Control { progress: Some(&progress), ..alone() };
    let methods: [&dyn Fn() -> Result<leafless::TriangleMesh, Error>; 5] = [
        &|| marching_cubes(tree, None, &control),
        &|| surface_nets(tree, None, &control),
        &|| simple_marching_cubes(tree, Snap::Fat, None, &control),
        &|| coplanar_shrink(tree, Snap::Fat, None, &control),
        &|| published_shrink(tree, Snap::Fat, None, &control),
    ];
    for (i, method) in methods.iter().enumerate() {
        seen.lock().unwrap().clear();
        method().unwrap();
        let seen = seen.lock().unwrap();
        assert!(
            seen.is_sorted() && seen.last().is_some_and(|&done| (0.999..=1.0).contains(&done)),
            "{i}: {seen:?}"
        );
    }
}
