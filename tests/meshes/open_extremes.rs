//! Open meshes at the limits of doubles: boundary edges that pass close by and end far away, sewn meshes
//! whose vertices moved in different directions, and workers that are used again.

use leafless::solid::Parts;
use leafless::{
    Classifier, Control, FillRule, Frame, MeshSolid, Rule, Solid, Tag, TriangleMesh, Worker, build,
};

type Point = [f64; 3];

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: Point) -> Point {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

/// The winding number by its definition.
fn winding(vertices: &[Point], triangles: &[[u32; 3]], point: Point) -> f64 {
    let angles = triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|vertex| unit(minus(vertices[vertex as usize], point)));
        dot(a, cross(b, c)).atan2(1.0 + dot(a, b) + dot(b, c) + dot(c, a)) / std::f64::consts::TAU
    });
    angles.sum()
}

/// Returns the number of FULL and EMPTY cells of depth 6 with a contradicting corner, and the number of
/// PARTIAL cells.
fn faults(vertices: &[Point], triangles: &[[u32; 3]]) -> (usize, usize) {
    let frame = Frame::new([0.0; 3], 64.0, 6).unwrap();
    let mesh = TriangleMesh::new(vertices.to_vec(), triangles.to_vec()).unwrap();
    let solid = MeshSolid::new(mesh, FillRule::NonZero).unwrap();
    let tree = build(&solid, &frame, Rule::Certified, &Control::default()).unwrap();
    let (mut wrong, mut partial) = (0, 0);
    for cell in 0..64 * 64 * 64u32 {
        let at = [cell % 64, cell / 64 % 64, cell / 4096];
        let tag = tree.view().tag_at(at);
        if tag == Tag::Partial {
            partial += 1;
            continue;
        }
        wrong += usize::from((0..8).any(|k| {
            let corner = [0, 1, 2].map(|axis| f64::from(at[axis] + (k >> axis & 1)));
            let excess = winding(vertices, triangles, corner).abs() - 0.5;
            if tag == Tag::Full { excess < -1e-6 } else { excess > 1e-6 }
        }));
    }
    (wrong, partial)
}

#[test]
fn edges_that_end_far_away() {
    for length in [1e3, 1e6, 1e8, 1e9, 1e10, 1e12] {
        let (l, m) = (length, 1.07 * length);
        let vertices = [
            [-l, 32.3 - 0.13 * l, 10.4 + 0.07 * l],
            [m, 32.3 + 0.13 * m, 10.4 - 0.07 * m],
            [0.1 * l, -3.0 * l, 0.3 * l],
        ];
        // Twice the same, so that the winding number is ½ in a plane through the edge.
        let (wrong, partial) = faults(&vertices, &[[0, 1, 2], [0, 1, 2]]);
        assert_eq!(wrong, 0, "{length}");
        // Beyond the edge, the uncertainty about its place grows with its length.
        assert!(length > 1e8 || partial < 25_000, "{length}: {partial}");
    }
}

#[test]
fn sewn_vertices_move_each_in_its_own_direction() {
    // A sphere of separate triangles around the middle of the frame.
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let corner = |x: f64, y: f64, z: f64| unit([x, y, z]);
    let ring: Vec<Point> = (0..4)
        .map(|i| (if i & 1 == 0 { 1.0 } else { -1.0 }, if i & 2 == 0 { golden } else { -golden }))
        .flat_map(|(a, b)| [corner(a, b, 0.0), corner(0.0, a, b), corner(b, 0.0, a)])
        .collect();
    // The icosahedron's faces, outward: corners at the distance of an edge.
    let mut faces: Vec<[Point; 3]> = Vec::new();
    let edge = 4.0 / (1.0 + golden * golden);
    let close = |a: Point, b: Point| (dot(minus(a, b), minus(a, b)) - edge).abs() < 1e-9;
    for (i, &a) in ring.iter().enumerate() {
        for (j, &b) in ring.iter().enumerate().skip(i + 1) {
            for &c in ring.iter().skip(j + 1) {
                if close(a, b) && close(b, c) && close(c, a) {
                    faces.push(if dot(a, cross(b, c)) > 0.0 { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    assert_eq!(faces.len(), 20);
    for _ in 0..3 {
        let middle = |a: Point, b: Point| unit([a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
        let quarters = faces.iter().flat_map(|&[a, b, c]| {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        });
        faces = quarters.collect();
    }
    let (mut vertices, mut triangles) = (Vec::<Point>::new(), Vec::new());
    let mut add = |corners: [Point; 3]| {
        let first = vertices.len() as u32;
        vertices.extend(corners);
        triangles.push([first, first + 1, first + 2]);
    };
    let centre = [128.3, 128.2, 128.4];
    let mut handed_in = Vec::new();
    for face in faces {
        let on = face.map(|p| [0, 1, 2].map(|axis| centre[axis] + 100.0 * p[axis]));
        let middle = [0, 1, 2].map(|axis| (on[0][axis] + on[1][axis] + on[2][axis]) / 3.0);
        let shrunk = on.map(|p| [0, 1, 2].map(|axis| middle[axis] + 0.712 * (p[axis] - middle[axis])));
        // Hairs at the corners, outward from the triangles' middles. The corners are sewn onto these hairs.
        // The hairs are long enough to reach at least a tenth of a cell.
        for p in shrunk {
            let outward = unit(minus(p, centre));
            let end = [0, 1, 2].map(|axis| p[axis] + 3f64.sqrt() * 0.1 * f64::from(1 << 24) * outward[axis]);
            add([p, [p[0], p[1] + 1e-9, p[2]], end]);
        }
        handed_in.push(shrunk.map(|p| {
            let outward = minus(p, middle);
            let most = outward.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            [0, 1, 2].map(|axis| p[axis] - 0.098 * outward[axis] / most)
        }));
    }
    handed_in.into_iter().for_each(&mut add);

    let mesh = TriangleMesh::new(vertices.clone(), triangles.clone()).unwrap().sewn().unwrap();
    assert!(mesh.displacement() > 0.09);
    let (sewn_vertices, sewn_triangles) = (mesh.vertices().to_vec(), mesh.triangles().to_vec());
    let frame = Frame::new([120.0; 3], 16.0, 4).unwrap();
    let solid = MeshSolid::new(mesh, FillRule::NonZero).unwrap();
    let tree = build(&solid, &frame, Rule::Certified, &Control::default()).unwrap();
    let mut differ = 0;
    for cell in 0..16 * 16 * 16u32 {
        let at = [cell % 16, cell / 16 % 16, cell / 256];
        let point = at.map(|a| 120.5 + f64::from(a));
        let before = winding(&vertices, &triangles, point).abs();
        let after = winding(&sewn_vertices, &sewn_triangles, point).abs();
        differ += usize::from((before < 0.5) != (after < 0.5));
        for winding in [before, after] {
            match tree.view().tag_at(at) {
                Tag::Full => assert!(winding >= 0.5, "{at:?} {winding}"),
                Tag::Empty => assert!(winding < 0.5, "{at:?} {winding}"),
                _ => {}
            }
        }
    }
    assert!(differ > 100, "{differ}");
}

#[test]
fn a_worker_knows_nothing_of_other_solids() {
    let frame = Frame::new([0.0; 3], 1.0, 3).unwrap();
    let solid = |vertices, triangles| {
        let mesh = TriangleMesh::new(vertices, triangles).unwrap();
        MeshSolid::new(mesh, FillRule::NonZero).unwrap()
    };
    let far = solid(vec![[900.0; 3], [901.0, 900.0, 900.0], [900.0, 901.0, 900.0]], vec![[0, 1, 2]]);
    // The universe lies above a box without a lid, taken twice: at a winding number of about 0.9.
    let corners = (0..8).map(|i| {
        let [x, y] = [0, 1].map(|axis| if i >> axis & 1 != 0 { 50.0 } else { -50.0 });
        [x, y, if i & 4 != 0 { -5.0 } else { -100.0 }]
    });
    let box_faces = vec![
        [0, 2, 3],
        [0, 3, 1],
        [0, 1, 5],
        [0, 5, 4],
        [1, 3, 7],
        [1, 7, 5],
        [3, 2, 6],
        [3, 6, 7],
        [2, 0, 4],
        [2, 4, 6],
    ];
    let near = solid(corners.collect(), [box_faces.clone(), box_faces].concat());
    // Each worker is queried again while the other one's scratch memory is in use, and after its own is
    // released.
    let [near, far] = [near, far].map(|solid| solid.on(&frame, &Control::default()).unwrap());
    assert_eq!(near.worker().unwrap().root().unwrap().tag(), Tag::Full);
    let (mut near, mut far) = (near.worker().unwrap(), far.worker().unwrap());
    for _ in 0..2 {
        assert_eq!(far.root().unwrap().tag(), Tag::Empty);
        far.release(0);
        assert_eq!(near.root().unwrap().tag(), Tag::Full);
        near.release(0);
    }
}
