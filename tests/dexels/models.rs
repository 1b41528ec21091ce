//! Tri-dexel models: dexelisation against samples and analytic crossings, set algebra against point sets.

use leafless::dexel::{DexelEditor, DexelEnds, DexelFormat, DexelNormals};
use leafless::op::DexelOptions;
use leafless::solid::HalfSpace;
use leafless::{
    Affine, AnySolid, Control, Csg, Error, FillRule, Frame, MeshSolid, Octree, Rule, Solid, TriDexel,
    TriangleMesh, build, dexelize,
};
use leafless_testkit::fuzz::dexel_algebra;

fn options() -> DexelOptions {
    DexelOptions::default()
}

fn doubles() -> DexelOptions {
    DexelOptions { format: DexelFormat { ends: DexelEnds::Double, ..Default::default() }, ..options() }
}

fn all_marks(ends: DexelEnds) -> DexelOptions {
    let format = DexelFormat { ends, normals: DexelNormals::Bits32, surfaces: true, materials: true };
    DexelOptions { format, ..options() }
}

fn only(axis: usize) -> [bool; 3] {
    [0, 1, 2].map(|a| a == axis)
}

fn inside(tree: &Octree, cell: [u32; 3]) -> bool {
    let frame = tree.frame();
    let point = [0, 1, 2].map(|a| frame.origin()[a] + (f64::from(cell[a]) + 0.5) * frame.cell_size());
    tree.contains(point) == leafless::Membership::Inside
}

/// Checks that each direction, in both forms of ends, contains exactly the centres that are sampled inside.
fn check_samples<S: Solid>(solid: &S, frame: &Frame, name: &str) {
    let control = Control::default();
    let tree = build(solid, frame, Rule::Sampled, &control).unwrap();
    for axis in 0..3 {
        for base in [options(), doubles(), all_marks(DexelEnds::Fixed)] {
            let model =
                dexelize(solid, frame, &DexelOptions { directions: only(axis), ..base }, &control).unwrap();
            model.view().check().unwrap();
            let n = frame.cells();
            for z in 0..n {
                for y in 0..n {
                    for x in 0..n {
                        let (expected, found) =
                            (inside(&tree, [x, y, z]), model.view().contains_cell([x, y, z]));
                        assert_eq!(found, expected, "{name}: axis {axis}, cell {x} {y} {z}, {base:?}");
                    }
                }
            }
        }
    }
    let threads =
        [1, 2].map(|n| dexelize(solid, frame, &all_marks(DexelEnds::Double), &Control::threads(n)).unwrap());
    assert_eq!(threads[0], threads[1], "{name}: threads");
}

fn frame(depth: u8) -> Frame {
    Frame::new([-1.0; 3], 2.0, depth).unwrap()
}

fn box_mesh(min: [f64; 3], max: [f64; 3]) -> TriangleMesh {
    let corner = |k: usize| [0, 1, 2].map(|a| if k >> a & 1 == 0 { min[a] } else { max[a] });
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriangleMesh::new((0..8).map(corner).collect(), triangles).unwrap()
}

/// A rotation whose matrix entries are not short doubles.
fn turn() -> Affine {
    let (c, s) = (0.3f64.cos(), 0.3f64.sin());
    let (d, t) = (1.1f64.cos(), 1.1f64.sin());
    Affine::new([[c, -s, 0.0, 0.01], [s * d, c * d, -t, 0.02], [s * t, c * t, d, -0.03]]).unwrap()
}

/// An octahedron whose vertices and edges lie on rays of many lattices.
fn octahedron(radius: f64) -> TriangleMesh {
    let vertices = (0..6)
        .map(|k| {
            let mut point = [0.0; 3];
            point[k / 2] = if k % 2 == 0 { radius } else { -radius };
            point
        })
        .collect();
    let triangles = (0..8u32)
        .map(|k| {
            let [x, y, z] = [k & 1, 2 + (k >> 1 & 1), 4 + (k >> 2 & 1)];
            if k.count_ones() % 2 == 0 { [x, y, z] } else { [x, z, y] }
        })
        .collect();
    TriangleMesh::new(vertices, triangles).unwrap()
}

/// A ball that provides only values and ranges.
fn host_ball(c: [f64; 3], radius: f64) -> HalfSpace {
    let square = |x: f64, low: f64, high: f64| {
        let far = (x - low).abs().max((high - x).abs());
        let near = if low <= x && x <= high { 0.0 } else { (x - low).abs().min((high - x).abs()) };
        [near * near, far * far]
    };
    HalfSpace::host(
        move |p| Ok(radius * radius - (0..3).map(|a| (p[a] - c[a]).powi(2)).sum::<f64>()),
        move |min, max| {
            let [near, far] = [0, 1].map(|k| (0..3).map(|a| square(c[a], min[a], max[a])[k]).sum::<f64>());
            Ok(leafless::Interval::new(radius * radius - far - 1e-14, radius * radius - near + 1e-14)
                .unwrap())
        },
        None,
    )
}

fn solid_of(mesh: TriangleMesh) -> MeshSolid {
    MeshSolid::new(mesh, FillRule::NonZero).unwrap()
}

#[test]
fn half_spaces_are_sampled_as_octrees_are() {
    let shapes: [(&str, Csg); 13] = [
        ("ball", Csg::ball([0.0; 3], 0.75).unwrap()),
        ("ball off centre", Csg::ball([0.11, -0.07, 0.031], 0.613).unwrap()),
        // Tangent to rays and touching centres: the radius is 11 eighths of sixteenths.
        ("ball through centres", Csg::ball([1.0 / 32.0; 3], 0.5).unwrap()),
        ("box on centres", Csg::cuboid([-0.53125; 3], [0.46875; 3]).unwrap()),
        ("box on planes", Csg::cuboid([-0.5; 3], [0.75, 0.5, 0.25]).unwrap()),
        ("torus", Csg::from(HalfSpace::torus(0.6, 0.25).unwrap())),
        ("thick torus", Csg::from(HalfSpace::torus(0.3, 0.5).unwrap())),
        (
            "power",
            Csg::from(HalfSpace::power([(-1.0, 0.0, 4), (-1.0, 0.1, 6), (-1.0, 0.0, 4)], 0.2).unwrap()),
        ),
        (
            "flat power",
            Csg::from(HalfSpace::power([(-1.0, 0.0, 64), (-1.0, 0.0, 64), (1.0, 0.03125, 64)], 0.0).unwrap()),
        ),
        (
            "cone",
            Csg::from(HalfSpace::quadric([-1.0, -1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]).unwrap()),
        ),
        (
            "saddle",
            Csg::from(HalfSpace::quadric([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]).unwrap()),
        ),
        ("plane through rays", Csg::from(HalfSpace::plane([1.0, -1.0, 0.0], 0.0).unwrap())),
        ("diagonal plane", Csg::from(HalfSpace::plane([1.0, -1.0, 1.0], 0.03125).unwrap())),
    ];
    for (name, shape) in &shapes {
        check_samples(shape, &frame(5), name);
        check_samples(shape, &frame(1), name);
        check_samples(&shape.complement(), &frame(4), name);
        let turned = shape.placed(&turn()).unwrap();
        check_samples(&turned, &frame(4), name);
    }
}

#[test]
fn expressions_are_sampled_as_octrees_are() {
    let ball = Csg::ball([0.0; 3], 0.75).unwrap();
    let bars = [0, 1, 2].map(|axis| {
        let (mut min, mut max) = ([-0.25; 3], [0.25; 3]);
        (min[axis], max[axis]) = (-1.0, 1.0);
        Csg::cuboid(min, max).unwrap()
    });
    let part = ball.difference(&Csg::union_of(bars.clone()).unwrap()).unwrap();
    check_samples(&part, &frame(5), "ball less bars");
    check_samples(&Csg::xor_of([ball.clone(), bars[0].clone()]).unwrap(), &frame(4), "xor");
    // More half-spaces, in groups, than a ray of a large cell evaluates.
    let many = (0..60).map(|i| {
        let at = |k: u32| f64::from(i * k % 17) / 10.0 - 0.8;
        Csg::ball([at(3), at(5), at(7)], 0.12).unwrap()
    });
    check_samples(&Csg::union_of(many).unwrap(), &frame(5), "many balls");
    // Other solids in an expression.
    let mesh = AnySolid::new(solid_of(octahedron(0.8)));
    check_samples(&Csg::solid(mesh.clone()).complement(), &frame(4), "complement of a mesh");
    let mixed = Csg::solid(mesh).difference(&ball).unwrap();
    check_samples(&mixed, &frame(4), "mesh less ball");
    check_samples(&Csg::from(host_ball([0.0; 3], 0.75)), &frame(4), "ball of the host's");
}

#[test]
fn meshes_are_sampled_as_octrees_are() {
    check_samples(&solid_of(octahedron(0.75)), &frame(5), "octahedron");
    check_samples(&solid_of(octahedron(0.71875)), &frame(4), "octahedron through centres");
    check_samples(&solid_of(box_mesh([-0.53125; 3], [0.46875; 3])), &frame(5), "box on centres");
    check_samples(&solid_of(box_mesh([-0.5; 3], [0.75, 0.5, 0.25])), &frame(4), "box on planes");
    check_samples(
        &solid_of(box_mesh([-3.0, -0.5, -0.3], [3.0, 0.5, 3.0])),
        &frame(4),
        "box beyond the universe",
    );
    check_samples(&solid_of(octahedron(0.8).placed(&turn()).unwrap()), &frame(5), "turned octahedron");
    check_samples(&solid_of(box_mesh([-1.0; 3], [1.0; 3])), &frame(3), "all of the universe");
    // A wall thinner than a cell, and one thinner than a unit.
    check_samples(&solid_of(box_mesh([-0.9, -0.9, 0.01], [0.9, 0.9, 0.02])), &frame(4), "thin wall");
    check_samples(&solid_of(box_mesh([-0.9, -0.9, 0.01], [0.9, 0.9, 0.01 + 1e-12])), &frame(4), "foil");
    // Nested, overlapping and inside-out shells.
    let shells = |parts: &[TriangleMesh]| {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for part in parts {
            let first = vertices.len() as u32;
            vertices.extend_from_slice(part.vertices());
            triangles.extend(part.triangles().iter().map(|t| t.map(|v| v + first)));
        }
        TriangleMesh::new(vertices, triangles).unwrap()
    };
    let overlapping =
        shells(&[box_mesh([-0.8; 3], [0.3; 3]), box_mesh([-0.3; 3], [0.8; 3]), octahedron(0.9)]);
    for fill in [FillRule::NonZero, FillRule::Positive, FillRule::EvenOdd] {
        check_samples(&MeshSolid::new(overlapping.clone(), fill).unwrap(), &frame(4), "overlapping shells");
    }
}

/// Faces of convex polygons, as in a boundary representation, are sampled like half-spaces.
#[test]
fn polygonal_faces_are_sampled_as_half_spaces_are() {
    // A hexagon with two edges that lie on rays along y.
    let hexagon: Vec<[f64; 2]> = (0..6)
        .map(|k| f64::from(k) * std::f64::consts::FRAC_PI_3)
        .map(|a| [0.71875 * a.cos(), 0.71875 * a.sin()])
        .collect();
    let vertices: Vec<[f64; 3]> =
        [-0.4375, 0.53].iter().flat_map(|&z| hexagon.iter().map(move |&[x, y]| [x, y, z])).collect();
    let mut corners: Vec<u32> = (0..6).rev().chain(6..12).collect();
    let mut loops = vec![0, 6, 12];
    for k in 0..6 {
        let next = (k + 1) % 6;
        corners.extend([k, next, next + 6, k + 6]);
        loops.push(corners.len() as u32);
    }
    let arrays = leafless::mesh::PolyhedronArrays {
        vertices: &vertices,
        corners: &corners,
        loops: &loops,
        faces: &(0..=8).collect::<Vec<u32>>(),
        shells: &[0, 8],
        solids: &[0, 1],
    };
    let solid = solid_of(leafless::mesh::Polyhedron::new(&arrays).unwrap().into_mesh());
    check_samples(&solid, &frame(5), "hexagonal prism");
    // The prism by half-spaces has the same crossings.
    let prism = Csg::prism(&hexagon, -0.4375, 0.53).unwrap();
    let [a, b] = [
        dexelize(&solid, &frame(5), &doubles(), &Control::default()).unwrap(),
        dexelize(&prism, &frame(5), &doubles(), &Control::default()).unwrap(),
    ];
    for axis in 0..3 {
        for at in (0..1024).map(|i| [i % 32, i / 32]) {
            let (faces, half_spaces) = (ray(&a, axis, at), ray(&b, axis, at));
            assert_eq!(faces.len(), half_spaces.len());
            for (x, y) in faces.iter().flatten().zip(half_spaces.iter().flatten()) {
                assert!((x - y).abs() < 2.0 / (1u64 << 36) as f64, "{x} {y}");
            }
        }
    }
}

#[test]
fn open_meshes_are_decided_by_winding_numbers() {
    let whole = octahedron(0.75);
    let open = TriangleMesh::new(whole.vertices().to_vec(), whole.triangles()[1..].to_vec()).unwrap();
    check_samples(&solid_of(open), &frame(4), "octahedron with a hole");
    let one = TriangleMesh::new(whole.vertices().to_vec(), whole.triangles()[..1].to_vec()).unwrap();
    check_samples(&solid_of(one), &frame(3), "one triangle");
}

#[test]
fn octrees_come_out_exactly() {
    let control = Control::default();
    let frame = frame(5);
    let certified = build(&Csg::ball([0.1; 3], 0.7).unwrap(), &frame, Rule::Certified, &control).unwrap();
    let sampled = build(&Csg::ball([0.1; 3], 0.7).unwrap(), &frame, Rule::Sampled, &control).unwrap();
    check_samples(&sampled, &frame, "sampled tree");
    assert!(matches!(dexelize(&certified, &frame, &options(), &control), Err(Error::NotSampled)));
    let refused =
        dexelize(&certified, &frame, &DexelOptions { rule: Rule::Certified, ..options() }, &control);
    assert!(matches!(refused, Err(Error::Argument { name: "rule", .. })));
    for (rule, of) in [(Rule::Inner, Rule::Inner), (Rule::Outer, Rule::Outer)] {
        let cells = leafless::op::resolve(certified.view(), of, &control).unwrap();
        let model = dexelize(&certified, &frame, &DexelOptions { rule, ..options() }, &control).unwrap();
        let of_cells = dexelize(&cells, &frame, &options(), &control).unwrap();
        assert_eq!(model, of_cells);
        // Ends lie in planes of the lattice, so that lengths are cells.
        let volume = cells.statistics().volume();
        for axis in 0..3 {
            assert_eq!(model.view().statistics(axis).unwrap().volume, volume.lower);
        }
    }
}

/// The intervals of a ray, in model units.
fn ray(model: &TriDexel, axis: usize, at: [u32; 2]) -> Vec<[f64; 2]> {
    model.view().rays(axis).unwrap().dexels(at).map(|dexel| [dexel.start.at, dexel.end.at]).collect()
}

#[test]
fn ends_lie_where_the_surface_is() {
    let (frame, control) = (frame(6), Control::default());
    let centre = |k: u32| -1.0 + (f64::from(k) + 0.5) / 32.0;
    let c = [0.013, -0.022, 0.017];
    let ball = Csg::ball(c, 0.75).unwrap();
    let others = [[1, 2], [0, 2], [0, 1]];
    for (options, unit) in [
        (all_marks(DexelEnds::Fixed), 2.0 / f64::from(1u32 << 31)),
        (all_marks(DexelEnds::Double), 2.0 / (1u64 << 36) as f64),
    ] {
        let model = dexelize(&ball, &frame, &options, &control).unwrap();
        for axis in 0..3 {
            let mut found = 0;
            for v in 0..64 {
                for u in 0..64 {
                    let [a, b] = others[axis];
                    let square = 0.75f64.powi(2) - (centre(u) - c[a]).powi(2) - (centre(v) - c[b]).powi(2);
                    let dexels: Vec<_> = model.view().rays(axis).unwrap().dexels([u, v]).collect();
                    if square < 0.0 {
                        assert!(dexels.is_empty());
                        continue;
                    }
                    found += 1;
                    assert_eq!(dexels.len(), 1);
                    for (end, sign) in [(dexels[0].start, -1.0), (dexels[0].end, 1.0)] {
                        let expected = c[axis] + sign * square.sqrt();
                        assert!((end.at - expected).abs() <= unit + 1e-15, "{} {expected}", end.at);
                        assert_eq!(end.surface, Some(0));
                        let mut normal = [0.0; 3];
                        (normal[a], normal[b], normal[axis]) =
                            ((centre(u) - c[a]) / 0.75, (centre(v) - c[b]) / 0.75, (end.at - c[axis]) / 0.75);
                        let off =
                            (0..3).map(|i| (normal[i] - end.normal.unwrap()[i]).abs()).fold(0.0, f64::max);
                        assert!(off < 1e-4, "{normal:?} {:?}", end.normal);
                    }
                }
            }
            assert!(found > 1000);
        }
    }
    // Solids without rays of their own, up to a cell of depth 20.
    let moved = Csg::from(host_ball(c, 0.75));
    let (model, expected) = (
        dexelize(&moved, &frame, &doubles(), &control).unwrap(),
        dexelize(&ball, &frame, &doubles(), &control).unwrap(),
    );
    for (u, v) in [(32, 32), (20, 40), (44, 25)] {
        for (found, expected) in ray(&model, 1, [u, v]).into_iter().zip(ray(&expected, 1, [u, v])) {
            assert!((found[0] - expected[0]).abs() < 4e-6 && (found[1] - expected[1]).abs() < 4e-6);
        }
    }
}

#[test]
fn triangles_tell_their_numbers_and_normals() {
    let (frame, control) = (frame(5), Control::default());
    let mesh = octahedron(0.8).placed(&turn()).unwrap();
    // Inside out, it is the same solid with the same outward normals.
    let turned = TriangleMesh::new(
        mesh.vertices().to_vec(),
        mesh.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect(),
    )
    .unwrap();
    for mesh in [mesh, turned] {
        let solid = solid_of(mesh.clone());
        let model = dexelize(&solid, &frame, &all_marks(DexelEnds::Double), &control).unwrap();
        let mut found = 0;
        for axis in 0..3 {
            let rays = model.view().rays(axis).unwrap();
            let [us, vs] = rays.window();
            for v in vs {
                for u in us.clone() {
                    for dexel in rays.dexels([u, v]) {
                        for (end, sign) in [(dexel.start, -1.0), (dexel.end, 1.0)] {
                            found += 1;
                            let [a, b, c] = mesh.triangles()[end.surface.unwrap() as usize]
                                .map(|v| glam::DVec3::from(mesh.vertices()[v as usize]));
                            let normal = (b - a).cross(c - a).normalize();
                            let outward = if normal.dot(a) > 0.0 { normal } else { -normal };
                            let told = glam::DVec3::from(end.normal.unwrap());
                            assert!((told - outward).length() < 2e-4, "{told} {outward}");
                            assert!(told[axis] * sign > -1e-4);
                            let [p, q] = [[1, 2], [0, 2], [0, 1]][axis];
                            let mut point = glam::DVec3::ZERO;
                            (point[p], point[q], point[axis]) = (
                                -1.0 + (f64::from(u) + 0.5) / 16.0,
                                -1.0 + (f64::from(v) + 0.5) / 16.0,
                                end.at,
                            );
                            assert!((point - a).dot(normal).abs() < 1e-10);
                        }
                    }
                }
            }
        }
        assert!(found > 500);
    }
}

/// A part with many intervals: balls and boxes of several materials at random places.
fn random_part(seed: u64, frame: &Frame, options: &DexelOptions) -> TriDexel {
    let mut random = leafless_testkit::Random(seed);
    let control = Control::default();
    let mut parts = Vec::new();
    for material in 1..5 {
        let shapes = (0..3).map(|_| {
            let c = [0; 3].map(|_| random.between(-0.9, 0.9));
            // Places on the lattice make ends that coincide.
            let c = if random.below(2) == 0 { c } else { c.map(|x| (x * 8.0).round() / 8.0) };
            let r = random.between(0.05, 0.5);
            if random.below(2) == 0 {
                Csg::ball(c, r).unwrap()
            } else {
                let r = (r * 8.0).ceil() / 8.0;
                Csg::cuboid(c.map(|x| x - r), c.map(|x| x + r)).unwrap()
            }
        });
        let shape = Csg::union_of(shapes).unwrap();
        let model = dexelize(&shape, frame, options, &control).unwrap();
        parts.push(if options.format.materials {
            model.view().with_material(material, &control).unwrap()
        } else {
            model
        });
    }
    let views: Vec<_> = parts.iter().map(|part| *part.view()).collect();
    TriDexel::union_of(&views, &control).unwrap()
}

/// Returns the material of a ray at a place, or `None` outside.
fn matter(model: &TriDexel, axis: usize, ray: [u32; 2], at: f64) -> Option<u32> {
    let mut dexels = model.view().rays(axis).unwrap().dexels(ray);
    dexels.find(|dexel| dexel.start.at <= at && at < dexel.end.at).map(|dexel| dexel.material)
}

#[test]
fn set_operations_are_those_of_points() {
    let (frame, control) = (frame(4), Control::default());
    type Op = fn(Option<u32>, Option<u32>) -> Option<u32>;
    for (seed, options) in
        [(1, options()), (2, doubles()), (3, all_marks(DexelEnds::Fixed)), (4, all_marks(DexelEnds::Double))]
    {
        let (a, b) = (random_part(seed, &frame, &options), random_part(seed + 100, &frame, &options));
        let (x, y) = (a.view(), b.view());
        let results: [(TriDexel, Op); 5] = [
            (x.union(y, &control).unwrap(), |a, b| a.or(b)),
            (x.intersection(y, &control).unwrap(), |a, b| b.and(a)),
            (x.difference(y, &control).unwrap(), |a, b| if b.is_none() { a } else { None }),
            (x.xor(y, &control).unwrap(), |a, b| if a.is_some() == b.is_some() { None } else { a.or(b) }),
            (x.complement(&control).unwrap(), |a, _| if a.is_none() { Some(0) } else { None }),
        ];
        let mut asked = 0;
        for axis in 0..3 {
            for ray in (0..256).map(|i| [i % 16, i / 16]) {
                let mut places = vec![-1.0, 1.0];
                for model in [&a, &b] {
                    places.extend(
                        model.view().rays(axis).unwrap().dexels(ray).flat_map(|d| [d.start.at, d.end.at]),
                    );
                }
                places.sort_by(f64::total_cmp);
                for pair in places.windows(2).filter(|pair| pair[1] > pair[0]) {
                    let at = 0.5 * (pair[0] + pair[1]);
                    let known = [&a, &b].map(|model| matter(model, axis, ray, at));
                    for (k, (result, op)) in results.iter().enumerate() {
                        asked += 1;
                        assert_eq!(
                            matter(result, axis, ray, at),
                            op(known[0], known[1]),
                            "operation {k}, axis {axis}, ray {ray:?}, {at}"
                        );
                    }
                }
            }
        }
        assert!(asked > 10_000);
        for (result, _) in &results {
            result.view().check().unwrap();
        }
    }
}

#[test]
fn laws_of_sets_hold_exactly() {
    let (frame, control) = (frame(5), Control::default());
    for (seed, options) in [(5, options()), (6, doubles())] {
        let [a, b, c] = [0, 1, 2].map(|k| random_part(seed + 10 * k, &frame, &options));
        let not = |x: &TriDexel| x.view().complement(&control).unwrap();
        let or = |x: &TriDexel, y: &TriDexel| x.view().union(y.view(), &control).unwrap();
        let and = |x: &TriDexel, y: &TriDexel| x.view().intersection(y.view(), &control).unwrap();
        let less = |x: &TriDexel, y: &TriDexel| x.view().difference(y.view(), &control).unwrap();
        let xor = |x: &TriDexel, y: &TriDexel| x.view().xor(y.view(), &control).unwrap();
        assert_eq!(not(&or(&a, &b)), and(&not(&a), &not(&b)));
        assert_eq!(not(&and(&a, &b)), or(&not(&a), &not(&b)));
        assert_eq!(not(&not(&a)), a);
        assert_eq!(or(&a, &b), or(&b, &a));
        assert_eq!(or(&a, &or(&b, &c)), or(&or(&a, &b), &c));
        assert_eq!(and(&a, &or(&b, &c)), or(&and(&a, &b), &and(&a, &c)));
        assert_eq!(or(&a, &and(&a, &b)), a);
        assert_eq!(less(&a, &b), and(&a, &not(&b)));
        assert_eq!(xor(&a, &b), or(&less(&a, &b), &less(&b, &a)));
        assert_eq!(xor(&xor(&a, &b), &b), a);
        let part = and(&a, &b);
        assert_eq!(or(&less(&a, &part), &part), a);
        let nothing = less(&a, &a);
        assert_eq!(nothing.view().interval_count(), 0);
        assert_eq!(or(&nothing, &a), a);
        let views = [*a.view(), *b.view(), *c.view()];
        assert_eq!(TriDexel::union_of(&views, &control).unwrap(), or(&a, &or(&b, &c)));
        assert_eq!(TriDexel::intersection_of(&views, &control).unwrap(), and(&a, &and(&b, &c)));
        assert_eq!(TriDexel::xor_of(&views, &control).unwrap(), xor(&a, &xor(&b, &c)));
        for threads in [1, 2] {
            let control = Control::threads(threads);
            assert_eq!(a.view().union(b.view(), &control).unwrap(), or(&a, &b));
        }
        // A set operation on models equals the model of the set operation, up to the last unit.
        assert!(matches!(TriDexel::union_of(&[], &control), Err(Error::Argument { .. })));
    }
}

#[test]
fn operands_must_fit() {
    let control = Control::default();
    let ball = Csg::ball([0.0; 3], 0.5).unwrap();
    let model = |depth, options: &DexelOptions| dexelize(&ball, &frame(depth), options, &control).unwrap();
    let (a, b) = (model(4, &options()), model(5, &options()));
    let refused = a.view().union(b.view(), &control).unwrap_err();
    let text = refused.to_string();
    assert!(matches!(refused, Error::FrameMismatch { depths: [4, 5], .. }), "{text}");
    let one = model(4, &DexelOptions { directions: only(1), ..options() });
    assert!(matches!(a.view().union(one.view(), &control), Err(Error::Argument { name: "other", .. })));
    let none = DexelOptions { directions: [false; 3], ..options() };
    assert!(matches!(
        dexelize(&ball, &frame(4), &none, &control),
        Err(Error::Argument { name: "directions", .. })
    ));
    // Fixed-point ends and doubles combine to doubles. Attributes that one operand lacks are unknown.
    let (fine, marked) = (model(4, &doubles()), model(4, &all_marks(DexelEnds::Fixed)));
    let mixed = fine.view().difference(marked.view(), &control).unwrap();
    assert_eq!(mixed.view().format(), DexelFormat { ends: DexelEnds::Double, ..marked.view().format() });
    mixed.view().check().unwrap();
    let same = a.view().to_format(fine.view().format(), &control).unwrap();
    assert_eq!(same.view().to_format(a.view().format(), &control).unwrap(), a);
}

#[test]
fn a_subtraction_shows_the_other_side() {
    let (frame, control) = (frame(5), Control::default());
    let marks = all_marks(DexelEnds::Double);
    let block = dexelize(&Csg::cuboid([-0.7; 3], [0.7; 3]).unwrap(), &frame, &marks, &control).unwrap();
    let ball = dexelize(&Csg::ball([0.0; 3], 0.5).unwrap(), &frame, &marks, &control).unwrap();
    let part = block.view().difference(ball.view(), &control).unwrap();
    let dexels: Vec<_> = part.view().rays(2).unwrap().dexels([16, 16]).collect();
    assert_eq!(dexels.len(), 2);
    let z = |end: leafless::dexel::DexelEnd| end.normal.unwrap()[2];
    // The outward normal points up into the hole, although the ball's own normal there points down.
    assert!(z(dexels[0].start) < -0.99 && z(dexels[0].end) > 0.99);
    assert!(z(dexels[1].start) < -0.99 && z(dexels[1].end) > 0.99);
    assert_eq!((dexels[0].end.surface, dexels[1].start.surface), (Some(0), Some(0)));
    // Touching intervals of one material are merged. Intervals of two materials stay two, with a face
    // between.
    let half = |min: f64, max: f64, material| {
        let half = Csg::cuboid([-0.7, -0.7, min], [0.7, 0.7, max]).unwrap();
        dexelize(&half, &frame, &marks, &control).unwrap().view().with_material(material, &control).unwrap()
    };
    let same = half(-0.7, 0.1, 1).view().union(half(0.1, 0.7, 1).view(), &control).unwrap();
    assert_eq!(same.view().rays(2).unwrap().dexels([16, 16]).count(), 1);
    let two = half(-0.7, 0.1, 1).view().union(half(0.1, 0.7, 2).view(), &control).unwrap();
    let dexels: Vec<_> = two.view().rays(2).unwrap().dexels([16, 16]).collect();
    assert_eq!(dexels.iter().map(|d| d.material).collect::<Vec<_>>(), [1, 2]);
    assert!(z(dexels[0].end) > 0.99 && z(dexels[1].start) < -0.99);
    assert_eq!(
        two.view().with_material(7, &control).unwrap().view().rays(2).unwrap().dexels([16, 16]).count(),
        1
    );
}

/// Returns the box of finest cells that the intervals of the models run through.
fn box_of_differences(parts: &[TriDexel; 2]) -> Option<[[u32; 3]; 2]> {
    let mut found: Option<[[u32; 3]; 2]> = None;
    for model in parts {
        for rays in (0..3).filter_map(|axis| model.view().rays(axis)) {
            let axis = rays.axis();
            let others = [[1, 2], [0, 2], [0, 1]][axis];
            let [along_u, along_v] = rays.window();
            for (u, v) in along_v.flat_map(|v| along_u.clone().map(move |u| (u, v))) {
                for dexel in rays.dexels([u, v]) {
                    let mut cells = [[0; 3]; 2];
                    (cells[0][others[0]], cells[1][others[0]]) = (u, u + 1);
                    (cells[0][others[1]], cells[1][others[1]]) = (v, v + 1);
                    cells[0][axis] = dexel.start.cells.unwrap().floor() as u32;
                    cells[1][axis] = dexel.end.cells.unwrap().ceil() as u32;
                    let [first, end] = found.unwrap_or(cells);
                    found = Some([
                        [0, 1, 2].map(|i| first[i].min(cells[0][i])),
                        [0, 1, 2].map(|i| end[i].max(cells[1][i])),
                    ]);
                }
            }
        }
    }
    found
}

#[test]
fn changes_in_place_are_set_operations() {
    let (frame, control) = (frame(5), Control::default());
    for (seed, options) in [(7, options()), (8, doubles()), (9, all_marks(DexelEnds::Fixed))] {
        let mut whole = random_part(seed, &frame, &options);
        let mut editor = DexelEditor::new(whole.view()).unwrap();
        let mut by_solids = DexelEditor::new(whole.view()).unwrap();
        assert_eq!(editor.directions(), options.directions);
        let mut random = leafless_testkit::Random(seed);
        let volumes = |model: &TriDexel| {
            [0, 1, 2].map(|axis| model.view().statistics(axis).map_or(0.0, |statistics| statistics.volume))
        };
        for step in 0..40 {
            let before = whole.clone();
            let c = [0; 3].map(|_| random.between(-1.0, 1.0));
            let radius = if step == 20 { 1.0 } else { random.between(0.03, 0.4) };
            let ball = Csg::ball(c, radius).unwrap();
            let tool = dexelize(&ball, &frame, &options, &control).unwrap();
            let (v, t) = (whole.view(), tool.view());
            let (changes, made) = match step % 5 {
                _ if step == 20 => {
                    let change = editor.intersect(t, &control).unwrap();
                    let other = by_solids.intersect_solid(&ball, &control).unwrap();
                    ([change, other], v.intersection(t, &control).unwrap())
                }
                0 | 3 => {
                    let change = editor.unite(t, &control).unwrap();
                    let other = by_solids.unite_solid(&ball, &control).unwrap();
                    ([change, other], v.union(t, &control).unwrap())
                }
                4 => {
                    let change = editor.xor(t, &control).unwrap();
                    let other = by_solids.xor_solid(&ball, &control).unwrap();
                    ([change, other], v.xor(t, &control).unwrap())
                }
                _ => {
                    let change = editor.subtract(t, &control).unwrap();
                    let other = by_solids.subtract_solid(&ball, &control).unwrap();
                    ([change, other], v.difference(t, &control).unwrap())
                }
            };
            whole = made;
            let [change, other] = changes;
            assert_eq!(change, other, "step {step}");
            // The reported change is the difference of the models before and after it.
            let difference = |a: &TriDexel, b: &TriDexel| a.view().difference(b.view(), &control).unwrap();
            let parts = [difference(&before, &whole), difference(&whole, &before)];
            for (told, part) in [change.removed, change.added].iter().zip(&parts) {
                for (told, found) in told.iter().zip(volumes(part)) {
                    assert!((told - found).abs() < 1e-9, "step {step}: {told} {found}");
                }
            }
            let differs = parts.iter().any(|part| part.view().interval_count() > 0);
            assert_eq!(change.cells.is_some(), differs, "step {step}");
            assert_eq!(change.rays > 0, differs, "step {step}");
            assert_eq!(change.cells, box_of_differences(&parts), "step {step}");
            let frozen = editor.freeze(&control).unwrap();
            frozen.view().check().unwrap();
            assert_eq!(frozen, whole, "step {step}");
            assert_eq!(by_solids.freeze(&control).unwrap(), whole, "step {step}");
        }
        assert!(whole.view().interval_count() > 100);
    }
}

#[test]
fn what_the_fuzzer_found_interesting() {
    dexel_algebra::seeds().iter().for_each(|seed| dexel_algebra::dexel_algebra(seed));
    let corpus = concat!(env!("CARGO_MANIFEST_DIR"), "/fuzz/corpus/dexels");
    for entry in std::fs::read_dir(corpus).into_iter().flatten() {
        dexel_algebra::dexel_algebra(&std::fs::read(entry.unwrap().path()).unwrap());
    }
    let mut random = leafless_testkit::Random(23);
    for _ in 0..300 {
        let mut data: Vec<u8> = (0..random.below(500)).map(|_| random.bits() as u8).collect();
        // The numbers of triangles equal those of rays.
        if let Some(form) = data.get_mut(1) {
            *form = *form & 127 | (random.below(2) as u8) << 7;
        }
        dexel_algebra::dexel_algebra(&data);
    }
}
