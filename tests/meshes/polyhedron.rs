//! Solids of plane faces: known volumes, closedness in every case, and every refusal.

#![cfg(feature = "std")]

use leafless::error::{MeshError, PolyhedronError};
use leafless::mesh::{Polyhedron, PolyhedronArrays};
use leafless::{Error, FillRule};
use leafless_testkit::Random;

/// The arrays of a polyhedron, filled part by part.
#[derive(Debug, Clone, Default, PartialEq)]
struct Arrays {
    vertices: Vec<[f64; 3]>,
    corners: Vec<u32>,
    loops: Vec<u32>,
    faces: Vec<u32>,
    shells: Vec<u32>,
    solids: Vec<u32>,
}

/// The loops of a face, with the outer loop first.
type Face = Vec<Vec<u32>>;

impl Arrays {
    fn new() -> Arrays {
        let [loops, faces, shells, solids] = [(); 4].map(|()| vec![0]);
        Arrays { loops, faces, shells, solids, ..Default::default() }
    }

    /// One solid, made of shells with their own vertices.
    fn solid(shells: &[(Vec<[f64; 3]>, Vec<Face>)]) -> Arrays {
        let mut arrays = Arrays::new();
        shells.iter().for_each(|(vertices, faces)| arrays.shell(vertices, faces));
        arrays.end_solid();
        arrays
    }

    fn shell(&mut self, vertices: &[[f64; 3]], faces: &[Face]) {
        let first = self.vertices.len() as u32;
        self.vertices.extend(vertices);
        for face in faces {
            for corners in face {
                self.corners.extend(corners.iter().map(|corner| first + corner));
                self.loops.push(self.corners.len() as u32);
            }
            self.faces.push(self.loops.len() as u32 - 1);
        }
        self.shells.push(self.faces.len() as u32 - 1);
    }

    fn end_solid(&mut self) {
        self.solids.push(self.shells.len() as u32 - 1);
    }

    fn view(&self) -> PolyhedronArrays<'_> {
        PolyhedronArrays {
            vertices: &self.vertices,
            corners: &self.corners,
            loops: &self.loops,
            faces: &self.faces,
            shells: &self.shells,
            solids: &self.solids,
        }
    }

    /// Builds the polyhedron. Checks that it is closed and has the number of triangles that its loops
    /// require.
    #[track_caller]
    fn made(&self) -> Polyhedron {
        let polyhedron = Polyhedron::new(&self.view()).unwrap();
        let mesh = polyhedron.mesh();
        mesh.check_closed(FillRule::NonZero).unwrap();
        let faces = self.faces.len() - 1;
        let holes = self.loops.len() - 1 - faces;
        // A polygon of n corners and h holes has n + 2h - 2 triangles.
        assert_eq!(mesh.triangles().len(), self.corners.len() + 2 * holes - 2 * faces);
        assert_eq!(mesh.report().unwrap().degenerate, 0);
        polyhedron
    }

    #[track_caller]
    fn refused(&self) -> PolyhedronError {
        match Polyhedron::new(&self.view()) {
            Err(Error::Polyhedron(error)) => {
                assert!(!error.to_string().is_empty());
                error
            }
            other => panic!("{other:?}"),
        }
    }
}

fn turned(faces: &[Face]) -> Vec<Face> {
    let reversed = |corners: &Vec<u32>| corners.iter().rev().copied().collect();
    faces.iter().map(|face| face.iter().map(reversed).collect()).collect()
}

/// A prism over a counter-clockwise polygon with clockwise holes. `place` maps its coordinates to space
/// without a reflection.
fn prism(
    polygon: &[Vec<[f64; 2]>],
    [low, high]: [f64; 2],
    place: impl Fn([f64; 3]) -> [f64; 3],
) -> (Vec<[f64; 3]>, Vec<Face>) {
    let mut vertices = vec![];
    let (mut bottom, mut top, mut sides): (Face, Face, Vec<Face>) = Default::default();
    for points in polygon {
        let first = vertices.len() as u32;
        let count = points.len() as u32;
        for &[x, y] in points {
            vertices.extend([place([x, y, low]), place([x, y, high])]);
        }
        let at = |k: u32| first + 2 * (k % count);
        bottom.push((0..count).rev().map(at).collect());
        top.push((0..count).map(|k| at(k) + 1).collect());
        sides.extend((0..count).map(|k| vec![vec![at(k), at(k + 1), at(k + 1) + 1, at(k) + 1]]));
    }
    (vertices, [vec![bottom, top], sides].concat())
}

fn rectangle([x, y]: [f64; 2], [width, height]: [f64; 2]) -> Vec<[f64; 2]> {
    vec![[x, y], [x + width, y], [x + width, y + height], [x, y + height]]
}

fn hole(at: [f64; 2], size: [f64; 2]) -> Vec<[f64; 2]> {
    rectangle(at, size).into_iter().rev().collect()
}

fn upright(p: [f64; 3]) -> [f64; 3] {
    p
}

fn block(low: [f64; 3], size: [f64; 3]) -> (Vec<[f64; 3]>, Vec<Face>) {
    let [x, y, z] = low;
    prism(&[rectangle([x, y], [size[0], size[1]])], [z, z + size[2]], upright)
}

/// The same shell with reversed orientation: a void.
fn void((vertices, faces): (Vec<[f64; 3]>, Vec<Face>)) -> (Vec<[f64; 3]>, Vec<Face>) {
    (vertices, turned(&faces))
}

#[test]
fn a_block_with_a_hole_through_it() {
    let shape = [rectangle([0.0, 0.0], [4.0, 3.0]), hole([1.0, 1.0], [1.0, 1.0])];
    let arrays = Arrays::solid(&[prism(&shape, [0.0, 2.0], upright)]);
    assert_eq!((arrays.faces.len() - 1, arrays.loops.len() - 1), (10, 12));
    let polyhedron = arrays.made();
    let mesh = polyhedron.mesh();
    assert_eq!(mesh.volume(), 22.0);
    assert_eq!((polyhedron.deviation(), mesh.report().unwrap().bodies), (0.0, 1));
    // Vertices - edges + faces: genus 1.
    assert_eq!(2 * mesh.vertices().len(), mesh.triangles().len());
    assert_eq!(polyhedron.clone().into_mesh().triangles(), mesh.triangles());
}

#[test]
fn a_face_with_two_holes() {
    let shape = [
        rectangle([0.0, 0.0], [8.0, 4.0]),
        hole([1.0, 1.0], [2.0, 2.0]),
        vec![[5.0, 1.0], [6.0, 3.0], [7.0, 1.0]],
    ];
    let mesh = Arrays::solid(&[prism(&shape, [-1.0, 2.0], upright)]).made().into_mesh();
    assert_eq!(mesh.volume(), 3.0 * (32.0 - 4.0 - 2.0));
    // Genus 2: V - T/2 = 2 - 2 g.
    assert_eq!(mesh.vertices().len() as i64 - mesh.triangles().len() as i64 / 2, -2);
}

#[test]
fn blind_holes_and_bosses() {
    // A block with a square pocket in its top, and a boss on its bottom: two faces with one hole each.
    let (mut vertices, faces) = block([0.0; 3], [6.0, 6.0, 3.0]);
    let (pocket, pocket_faces) = void(block([1.0, 1.0, 2.0], [2.0, 2.0, 1.0]));
    let (boss, boss_faces) = block([3.0, 3.0, -4.0], [2.0, 2.0, 4.0]);
    let shifted = |faces: &[Face], by: u32| -> Vec<Face> {
        faces.iter().map(|face| face.iter().map(|l| l.iter().map(|v| v + by).collect()).collect()).collect()
    };
    vertices.extend(pocket.iter().chain(&boss));
    let (mut faces, pocket_faces, boss_faces) = (faces, shifted(&pocket_faces, 8), shifted(&boss_faces, 16));
    // The lids of pocket and boss become holes.
    faces[1].extend(turned(&[pocket_faces[1].clone()])[0].iter().map(|l| l.iter().rev().copied().collect()));
    faces[0].extend(turned(&[boss_faces[1].clone()])[0].iter().map(|l| l.iter().rev().copied().collect()));
    let keep = |faces: &[Face], lid: usize| {
        let kept = faces.iter().enumerate().filter(|&(k, _)| k != lid);
        kept.map(|(_, face)| face.clone()).collect::<Vec<_>>()
    };
    faces.extend(keep(&pocket_faces, 1));
    faces.extend(keep(&boss_faces, 1));
    let mesh = Arrays::solid(&[(vertices, faces)]).made().into_mesh();
    assert_eq!(mesh.volume(), 108.0 - 4.0 + 16.0);
    assert_eq!(mesh.report().unwrap().bodies, 1);
}

#[test]
fn nested_voids_and_several_solids() {
    let outer = block([0.0; 3], [10.0; 3]);
    let mut arrays = Arrays::solid(&[
        outer,
        void(block([1.0; 3], [3.0; 3])),
        // It touches the other one in an edge.
        void(block([4.0, 4.0, 1.0], [5.0, 5.0, 8.0])),
    ]);
    assert_eq!(arrays.made().mesh().volume(), 1000.0 - 27.0 - 200.0);
    // A solid within the void, with a void of its own.
    let (vertices, faces) = block([5.0, 5.0, 2.0], [3.0, 3.0, 6.0]);
    arrays.shell(&vertices, &faces);
    let (vertices, faces) = void(block([6.0, 6.0, 3.0], [1.0, 1.0, 4.0]));
    arrays.shell(&vertices, &faces);
    arrays.end_solid();
    // And one elsewhere that shares a face with the first.
    let (vertices, faces) = block([10.0, 0.0, 0.0], [1.0, 10.0, 10.0]);
    arrays.shell(&vertices, &faces);
    arrays.end_solid();
    let mesh = arrays.made().into_mesh();
    assert_eq!(mesh.volume(), 773.0 + 54.0 - 4.0 + 100.0);
}

#[test]
fn voids_may_touch_their_shell() {
    // The void's first vertices lie in the outer shell's faces and edges, its last ones inside.
    let pyramid = |apex: [f64; 3]| {
        let vertices = vec![[0.0, 4.0, 0.0], [8.0, 4.0, 0.0], [8.0, 4.0, 8.0], [0.0, 4.0, 8.0], apex];
        let faces = [vec![3, 2, 1, 0], vec![0, 1, 4], vec![1, 2, 4], vec![2, 3, 4], vec![3, 0, 4]];
        (vertices, faces.map(|face| vec![face]).to_vec())
    };
    let solid = |apex: [f64; 3]| {
        let (vertices, faces) = pyramid(apex);
        let volume = (apex[1] - 4.0) * 64.0 / 3.0;
        // Seen from above, where the apex may be, its base is counter-clockwise.
        let faces = if volume > 0.0 { turned(&faces) } else { faces };
        (Arrays::solid(&[block([0.0; 3], [8.0; 3]), (vertices, turned(&faces))]), volume.abs())
    };
    for apex in [[4.0, 7.0, 4.0], [4.0, 1.0, 4.0], [4.0, 8.0, 4.0], [0.0, 8.0, 0.0]] {
        let (arrays, volume) = solid(apex);
        let found = arrays.made().mesh().volume();
        assert!((found - (512.0 - volume)).abs() < 1e-9, "{apex:?} {found}");
    }
    for apex in [[4.0, 9.0, 4.0], [4.0, -1.0, 4.0]] {
        assert_eq!(solid(apex).0.refused(), PolyhedronError::VoidOutside { shell: 1 });
    }
}

#[test]
fn faces_that_are_not_convex() {
    // A five-pointed star, a comb, and a spiral of right angles.
    let star: Vec<[f64; 2]> = vec![
        [0.0, 10.0],
        [-2.0, 3.0],
        [-9.0, 3.0],
        [-4.0, -1.0],
        [-6.0, -8.0],
        [0.0, -4.0],
        [6.0, -8.0],
        [4.0, -1.0],
        [9.0, 3.0],
        [2.0, 3.0],
    ];
    let mut comb = vec![[0.0, -1.0], [40.0, -1.0]];
    for tooth in (0..10).rev() {
        let x = 4.0 * f64::from(tooth);
        comb.extend([[x + 3.0, 0.0], [x + 3.0, 9.0], [x + 1.0, 9.0], [x + 1.0, 0.0]]);
    }
    let spiral: Vec<[f64; 2]> = vec![
        [0.0, 0.0],
        [9.0, 0.0],
        [9.0, 9.0],
        [2.0, 9.0],
        [2.0, 4.0],
        [6.0, 4.0],
        [6.0, 6.0],
        [4.0, 6.0],
        [4.0, 7.0],
        [7.0, 7.0],
        [7.0, 2.0],
        [0.0, 2.0],
    ];
    for polygon in [star, comb, spiral] {
        let doubled = |p: &[[f64; 2]]| -> f64 {
            (0..p.len()).map(|k| (p[k], p[(k + 1) % p.len()])).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
        };
        let area = doubled(&polygon) / 2.0;
        assert!(area > 0.0);
        let places: [fn([f64; 3]) -> [f64; 3]; 4] =
            [upright, |[x, y, z]| [y, z, x], |[x, y, z]| [z, -y, x], |[x, y, z]| [x + z, y - 2.0 * z, z]];
        for place in places {
            let arrays = Arrays::solid(&[prism(std::slice::from_ref(&polygon), [0.0, 5.0], place)]);
            let volume = arrays.made().mesh().volume();
            assert!((volume - 5.0 * area).abs() < 1e-9, "{volume} {area}");
        }
    }
}

#[test]
fn regular_solids() {
    let phi = (1.0 + 5f64.sqrt()) / 2.0;
    // All faces: sets of vertices farthest in one direction, sorted around it.
    let hull = |vertices: &[[f64; 3]], normals: &[[f64; 3]]| -> Vec<Face> {
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let face = |&normal: &[f64; 3]| {
            let most = vertices.iter().map(|&v| dot(v, normal)).fold(f64::MIN, f64::max);
            let mut corners: Vec<u32> = (0..vertices.len() as u32)
                .filter(|&v| dot(vertices[v as usize], normal) > most - 1e-6)
                .collect();
            let u = vertices[corners[0] as usize];
            let u: [f64; 3] =
                std::array::from_fn(|k| u[k] - normal[k] * dot(u, normal) / dot(normal, normal));
            let v = cross(normal, u);
            let angle = |c: u32| dot(vertices[c as usize], v).atan2(dot(vertices[c as usize], u));
            corners.sort_by(|&a, &b| angle(a).total_cmp(&angle(b)));
            vec![corners]
        };
        normals.iter().map(face).collect()
    };
    let mut icosahedron = vec![];
    let mut dodecahedron = vec![];
    for s in [1.0, -1.0] {
        for t in [1.0, -1.0] {
            icosahedron.extend([[0.0, s, t * phi], [s, t * phi, 0.0], [t * phi, 0.0, s]]);
            let (p, q) = (s * phi, t / phi);
            dodecahedron.extend([[0.0, p, q], [p, q, 0.0], [q, 0.0, p]]);
            dodecahedron.extend([[s, t, 1.0], [s, t, -1.0]]);
        }
    }
    for edge in [1.0, 1e-3, 1e70, 0.7] {
        let scaled = |vertices: &[[f64; 3]], unit: f64| -> Vec<[f64; 3]> {
            vertices.iter().map(|v| v.map(|x| x * edge / unit)).collect()
        };
        let near = |found: f64, expected: f64| {
            let expected = expected * edge * edge * edge;
            assert!((found - expected).abs() < 1e-12 * expected, "{found} {expected}");
        };
        let faces = hull(&icosahedron, &dodecahedron);
        assert!(faces.len() == 20 && faces.iter().all(|face| face[0].len() == 3));
        let arrays = Arrays::solid(&[(scaled(&icosahedron, 2.0), faces)]);
        near(arrays.made().mesh().volume(), 5.0 / 12.0 * (3.0 + 5f64.sqrt()));
        let faces = hull(&dodecahedron, &icosahedron);
        assert!(faces.len() == 12 && faces.iter().all(|face| face[0].len() == 5));
        let arrays = Arrays::solid(&[(scaled(&dodecahedron, 2.0 / phi), faces)]);
        let polyhedron = arrays.made();
        near(polyhedron.mesh().volume(), (15.0 + 7.0 * 5f64.sqrt()) / 4.0);
        assert!(polyhedron.deviation() < 1e-15 * edge && polyhedron.deviation() > 0.0);
    }
}

fn whole(random: &mut Random, low: i32, high: i32) -> i32 {
    low + random.below((high - low + 1) as u64) as i32
}

/// A star-shaped polygon around a point, in integers: its corners are in angular order. They are at most
/// `large` away, and no part of the polygon is nearer than half of `small`.
fn star(random: &mut Random, [x, y]: [i32; 2], small: i32, large: i32) -> Vec<[f64; 2]> {
    let directions = [
        [2, 0],
        [2, 1],
        [2, 2],
        [1, 2],
        [0, 2],
        [-1, 2],
        [-2, 2],
        [-2, 1],
        [-2, 0],
        [-2, -1],
        [-2, -2],
        [-1, -2],
        [0, -2],
        [1, -2],
        [2, -2],
        [2, -1],
    ];
    let mut points = vec![];
    for (k, [u, v]) in directions.into_iter().enumerate() {
        if k % 2 == 0 || random.below(2) == 0 {
            let r = whole(random, small, large / 2);
            points.push([f64::from(x + u * r / 2), f64::from(y + v * r / 2)]);
        }
    }
    points
}

fn doubled_area(points: &[[f64; 2]]) -> f64 {
    let pairs = (0..points.len()).map(|k| (points[k], points[(k + 1) % points.len()]));
    pairs.map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
}

/// A prism over a random polygon with holes, moved by a random integer matrix; and six times its volume.
fn random_prism(random: &mut Random) -> ((Vec<[f64; 3]>, Vec<Face>), f64) {
    let mut polygon = vec![star(random, [0, 0], 100, 400)];
    for x in -1..=1 {
        for y in -1..=1 {
            if random.below(3) == 0 {
                let mut hole = star(random, [20 * x, 20 * y], 4, 14);
                hole.reverse();
                polygon.push(hole);
            }
        }
    }
    let area: f64 = polygon.iter().map(|points| doubled_area(points)).sum();
    let height = f64::from(whole(random, 1, 50));
    loop {
        let m: [[f64; 3]; 3] = [(); 3].map(|()| [(); 3].map(|()| f64::from(whole(random, -3, 3))));
        let determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
        if determinant > 0.0 {
            let place = |p: [f64; 3]| m.map(|row| row[0] * p[0] + row[1] * p[1] + row[2] * p[2]);
            return (prism(&polygon, [0.0, height], place), 3.0 * area * height * determinant);
        }
    }
}

#[test]
fn random_prisms() {
    let mut random = Random(3);
    let mut holes = 0;
    for _ in 0..400 {
        let (prism, six_fold) = random_prism(&mut random);
        let arrays = Arrays::solid(&[prism]);
        holes += arrays.loops.len() - arrays.faces.len();
        let polyhedron = arrays.made();
        let volume = polyhedron.mesh().volume();
        assert!((6.0 * volume - six_fold).abs() <= 1e-12 * six_fold, "{volume} {six_fold}");
        assert!(polyhedron.deviation() < 1e-12);
    }
    assert!(holes > 1000);
}

#[test]
fn many_voids() {
    let n = 12;
    let mut shells = vec![block([0.0; 3], [f64::from(4 * n); 3])];
    for x in 0..n {
        for y in 0..n {
            for z in 0..n {
                let at = [x, y, z].map(|k| f64::from(4 * k + 1));
                shells.push(void(block(at, [2.0; 3])));
            }
        }
    }
    let side = f64::from(4 * n);
    let expected = side * side * side - 8.0 * f64::from(n * n * n);
    assert_eq!(Arrays::solid(&shells).made().mesh().volume(), expected);
    // The last void is misplaced, though within the bounds: in a dent of the outer shell.
    let dented = prism(
        &[vec![[0.0, 0.0], [48.0, 0.0], [48.0, 48.0], [44.0, 48.0], [44.0, 44.0], [0.0, 44.0]]],
        [0.0, 48.0],
        upright,
    );
    shells[0] = dented;
    // The first of the shells in the dent: x < 11, y = 11, z = 0.
    assert_eq!(Arrays::solid(&shells).refused(), PolyhedronError::VoidOutside { shell: 1 + 11 * 12 });
}

#[test]
fn tolerance() {
    let (mut vertices, faces) = block([0.0; 3], [10.0, 10.0, 1.0]);
    // One corner of the top: its plane tilts, and the sides stay plane.
    vertices[1][2] += 4.4e-8;
    let arrays = Arrays::solid(&[(vertices.clone(), faces.clone())]);
    let PolyhedronError::NotPlane { face: 1, deviation, tolerance: 1e-8 } = arrays.refused() else {
        panic!("{:?}", arrays.refused())
    };
    assert!((deviation - 1.1e-8).abs() < 1e-10, "{deviation}");
    let error = Polyhedron::with_tolerance(&arrays.view(), 1e-8).unwrap_err();
    assert!(matches!(error, Error::Polyhedron(PolyhedronError::NotPlane { face: 1, .. })));
    let polyhedron = Polyhedron::with_tolerance(&arrays.view(), 1.2e-8).unwrap();
    assert_eq!(polyhedron.deviation(), deviation);
    polyhedron.mesh().check_closed(FillRule::NonZero).unwrap();
    // Half of it is within the tolerance, a fraction of the extent.
    vertices[1][2] = 1.0 + 1.9e-8;
    Arrays::solid(&[(vertices, faces)]).made();
    // No tolerance at all, for coordinates that allow it.
    let exact = Arrays::solid(&[block([0.0; 3], [10.0, 10.0, 1.0])]);
    Polyhedron::with_tolerance(&exact.view(), 0.0).unwrap();
    for bad in [-1e-300, f64::NAN, f64::NEG_INFINITY] {
        let error = Polyhedron::with_tolerance(&exact.view(), bad).unwrap_err();
        assert!(matches!(error, Error::Argument { name: "tolerance", .. }));
    }
}

/// A block with a hole through its bottom (face 0) and top (face 1).
fn drilled() -> Arrays {
    let shape = [rectangle([0.0, 0.0], [4.0, 4.0]), hole([1.0, 1.0], [2.0, 2.0])];
    Arrays::solid(&[prism(&shape, [0.0, 2.0], upright)])
}

#[test]
fn wrong_offsets() {
    type Pick = fn(&mut Arrays) -> &mut Vec<u32>;
    let levels: [(Pick, &str, &str); 4] = [
        (|a| &mut a.loops, "loops", "corners"),
        (|a| &mut a.faces, "faces", "loops"),
        (|a| &mut a.shells, "shells", "faces"),
        (|a| &mut a.solids, "solids", "shells"),
    ];
    for (pick, array, parts) in levels {
        let damaged = |damage: &dyn Fn(&mut Vec<u32>)| {
            let mut arrays = drilled();
            damage(pick(&mut arrays));
            arrays.refused()
        };
        let wrong = |index: usize| PolyhedronError::Offsets { array, parts, index: index as u64 };
        let count = pick(&mut drilled()).len() - 1;
        assert_eq!(damaged(&|a| a.clear()), wrong(0));
        assert_eq!(damaged(&|a| a[0] = 1), wrong(0));
        assert_eq!(damaged(&|a| *a.last_mut().unwrap() += 1), wrong(count));
        assert_eq!(damaged(&|a| a.push(u32::MAX)), wrong(count + 1));
        assert_eq!(damaged(&|a| a.push(*a.last().unwrap())), wrong(count + 1));
        if count > 1 {
            assert_eq!(damaged(&|a| a[1] = 0), wrong(1));
            assert_eq!(damaged(&|a| a[1] = u32::MAX), wrong(2));
        }
    }
    let mut arrays = drilled();
    arrays.corners.pop();
    assert!(matches!(arrays.refused(), PolyhedronError::Offsets { array: "loops", index: 12, .. }));
}

#[test]
fn wrong_corners_and_edges() {
    use PolyhedronError::*;
    let damaged = |damage: &dyn Fn(&mut Arrays)| {
        let mut arrays = drilled();
        damage(&mut arrays);
        arrays.refused()
    };
    let whole = drilled();
    assert_eq!(&whole.corners[..8], [6, 4, 2, 0, 14, 12, 10, 8]);
    assert_eq!(damaged(&|a| a.corners[5] = 16), Vertex { corner: 5, vertex: 16, vertices: 16 });
    assert_eq!(damaged(&|a| a.corners[1] = 6), NoLength { face: 0, from: 6, to: 6 });
    assert_eq!(damaged(&|a| a.vertices[12] = a.vertices[14]), NoLength { face: 0, from: 14, to: 12 });
    // The first loop is cut in two: of two corners each, and of three and one.
    assert_eq!(
        damaged(&|a| {
            a.loops.insert(1, 2);
            rise(&mut a.faces)
        }),
        FewCorners { index: 0, corners: 2 }
    );
    assert_eq!(
        damaged(&|a| {
            a.loops.insert(1, 3);
            rise(&mut a.faces)
        }),
        FewCorners { index: 1, corners: 1 }
    );
    // A face left out: its edges are open, the first of them in the order of the faces.
    assert_eq!(damaged(&|a| cut(a, 9)), Open { shell: 0, face: 0, from: 8, to: 14 });
    // One side is inverted.
    let side = damaged(&|a| a.corners[16..20].reverse());
    assert_eq!(side, Unoriented { shell: 0, face: 0, other: 2, from: 2, to: 0 });
    // A side twice.
    let twice = damaged(&|a| {
        let side: Vec<u32> = a.corners[16..20].to_vec();
        a.corners.extend(side);
        a.loops.push(a.corners.len() as u32);
        a.faces.push(a.loops.len() as u32 - 1);
        a.shells[1] += 1;
    });
    assert_eq!(twice, NonManifold { shell: 0, face: 0, from: 2, to: 0, uses: 3 });
    // Two halves that are closed only together are not closed.
    assert!(matches!(damaged(&|a| a.shells.insert(1, 5)), Offsets { array: "solids", .. }));
    let halves = damaged(&|a| {
        a.shells.insert(1, 5);
        a.solids = vec![0, 1, 2];
    });
    assert!(matches!(halves, Open { shell: 0, face: 0, .. }));
}

/// Adjusts the faces' offsets for one more loop in the first face.
fn rise(faces: &mut [u32]) {
    faces[1..].iter_mut().for_each(|face| *face += 1);
}

/// Removes the last face, which has one loop of four corners.
fn cut(arrays: &mut Arrays, face: usize) {
    assert_eq!(face, arrays.faces.len() - 2);
    arrays.corners.truncate(arrays.corners.len() - 4);
    arrays.loops.pop();
    arrays.faces.pop();
    *arrays.shells.last_mut().unwrap() -= 1;
}

#[test]
fn wrong_faces() {
    use PolyhedronError::*;
    let of = |polygon: &[Vec<[f64; 2]>]| Arrays::solid(&[prism(polygon, [0.0, 2.0], upright)]).refused();
    let outer = rectangle([0.0, 0.0], [8.0, 8.0]);
    // The bottom runs backwards. Its edges end where those of the polygon begin.
    let crossed = of(&[vec![[0.0, 0.0], [8.0, 0.0], [0.0, 8.0], [7.0, 9.0]]]);
    assert!(matches!(crossed, Crossing { face: 0, .. }), "{crossed:?}");
    let touching = of(&[vec![[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [4.0, 0.0], [0.0, 8.0]]]);
    assert_eq!(touching, Crossing { face: 0, from: 2, to: 0 });
    assert!(matches!(of(&[outer.clone(), hole([6.0, 2.0], [4.0, 4.0])]), Crossing { face: 0, .. }));
    assert_eq!(of(&[outer.clone(), hole([9.0, 2.0], [4.0, 4.0])]), Loops { face: 0 });
    assert_eq!(of(&[outer.clone(), rectangle([2.0, 2.0], [4.0, 4.0])]), Loops { face: 0 });
    assert_eq!(
        of(&[outer.clone(), hole([1.0, 1.0], [6.0, 6.0]), hole([3.0, 3.0], [2.0, 2.0])]),
        Loops { face: 0 }
    );
    assert_eq!(of(&[hole([2.0, 2.0], [4.0, 4.0]), outer.clone()]), Loops { face: 0 });
    assert_eq!(of(&[vec![[0.0, 0.0], [4.0, 4.0], [1.0, 1.0]]]), Flat { face: 0 });
    assert_eq!(of(&[vec![[0.0, 0.0], [4.0, 4.0], [8.0, 8.0], [1.0, 1.0]]]), Flat { face: 0 });
    // A solid that is as flat as a face.
    let vertices = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let sheet = Arrays::solid(&[(vertices, vec![vec![vec![0, 1, 2]], vec![vec![2, 1, 0]]])]);
    assert_eq!(sheet.refused(), InsideOut { shell: 0 });
}

#[test]
fn wrong_shells() {
    use PolyhedronError::*;
    let outer = || block([0.0; 3], [8.0; 3]);
    let inner = || block([2.0; 3], [4.0; 3]);
    assert_eq!(Arrays::solid(&[void(outer())]).refused(), InsideOut { shell: 0 });
    assert_eq!(Arrays::solid(&[outer(), inner()]).refused(), VoidOutward { shell: 1 });
    assert_eq!(Arrays::solid(&[inner(), void(outer())]).refused(), VoidOutside { shell: 1 });
    let beside = || void(block([9.0; 3], [4.0; 3]));
    assert_eq!(Arrays::solid(&[outer(), void(inner()), beside()]).refused(), VoidOutside { shell: 2 });
    // As a solid of its own.
    let mut arrays = Arrays::solid(&[outer()]);
    let (vertices, faces) = beside();
    arrays.shell(&vertices, &faces);
    arrays.end_solid();
    assert_eq!(arrays.refused(), InsideOut { shell: 1 });
    // Within the bounds, but in the hole.
    let shape = [rectangle([0.0, 0.0], [9.0, 9.0]), hole([1.0, 1.0], [7.0, 7.0])];
    let ring = prism(&shape, [0.0, 9.0], upright);
    let arrays = Arrays::solid(&[ring.clone(), void(block([3.0; 3], [2.0; 3]))]);
    assert_eq!(arrays.refused(), VoidOutside { shell: 1 });
    // The void lies only on the surface. Whether it is inside is not decided, and it is accepted.
    Arrays::solid(&[block([0.0; 3], [8.0; 3]), void(block([0.0; 3], [8.0; 3]))]).made();
}

#[test]
fn what_meshes_refuse() {
    let with = |x: f64| {
        let mut arrays = drilled();
        arrays.vertices[3][1] = x;
        Polyhedron::new(&arrays.view()).unwrap_err()
    };
    for x in [f64::NAN, f64::INFINITY] {
        assert!(matches!(with(x), Error::Mesh(MeshError::NotFinite { vertex: 3 })));
    }
    assert!(matches!(with(1e80), Error::Mesh(MeshError::TooLarge { vertex: 3 })));
    let nothing = Polyhedron::new(&Arrays::new().view()).unwrap_err();
    assert!(matches!(nothing, Error::Mesh(MeshError::Empty)));
    let missing = Polyhedron::new(&PolyhedronArrays::default()).unwrap_err();
    assert!(matches!(missing, Error::Polyhedron(PolyhedronError::Offsets { array: "loops", index: 0, .. })));
}

/// Randomly damaged arrays are either refused or sound.
#[test]
fn random_damage() {
    let mut random = Random(11);
    let (mut sound, mut refused) = (0, 0);
    for round in 0..20_000 {
        let mut arrays = match round % 3 {
            0 => drilled(),
            1 => Arrays::solid(&[block([0.0; 3], [9.0; 3]), void(block([2.0; 3], [3.0; 3]))]),
            _ => Arrays::solid(&[block([0.0; 3], [2.0, 3.0, 4.0])]),
        };
        for _ in 0..1 + random.below(2) {
            let array = match random.below(6) {
                0 => {
                    let vertex = random.index(arrays.vertices.len());
                    arrays.vertices[vertex][random.index(3)] = f64::from(whole(&mut random, -2, 10));
                    continue;
                }
                1 | 2 => &mut arrays.corners,
                3 => &mut arrays.loops,
                4 => &mut arrays.faces,
                _ => &mut arrays.shells,
            };
            let [i, j] = [0; 2].map(|_| random.index(array.len()));
            match random.below(5) {
                0 => array.swap(i, j),
                1 => array[i] = array[j],
                2 => array[i] = array[i].wrapping_add(random.below(3) as u32).wrapping_sub(1),
                3 => drop(array.remove(i)),
                _ => array.insert(i, array[j]),
            }
        }
        match Polyhedron::with_tolerance(&arrays.view(), if round % 2 == 0 { f64::INFINITY } else { 1e-9 }) {
            Ok(polyhedron) => {
                polyhedron.mesh().check_closed(FillRule::NonZero).unwrap();
                sound += 1;
            }
            Err(Error::Polyhedron(_) | Error::Mesh(MeshError::Empty)) => refused += 1,
            Err(other) => panic!("{other:?}"),
        }
    }
    assert!(sound > 300 && refused > 10_000, "{sound} {refused}");
}

/// A block with `holes` square through holes in rows.
fn plate(holes: usize) -> Arrays {
    let mut vertices = vec![];
    let square = |vertices: &mut Vec<[f64; 3]>, [x, y]: [f64; 2], edge: [f64; 2]| -> [Vec<u32>; 2] {
        [0.0, 1.0].map(|z| {
            let first = vertices.len() as u32;
            for [i, j] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
                vertices.push([x + i * edge[0], y + j * edge[1], z]);
            }
            (first..first + 4).collect()
        })
    };
    let side = 3.0 * holes as f64 + 1.0;
    let [low, high] = square(&mut vertices, [0.0, 0.0], [side, 4.0]);
    let (mut bottom, mut top): (Face, Face) = (vec![low.iter().rev().copied().collect()], vec![high.clone()]);
    let mut faces = vec![];
    let mut walls = |low: &[u32], high: &[u32], is_hole: bool| {
        for k in 0..4 {
            let l = (k + 1) % 4;
            let wall = vec![low[k], low[l], high[l], high[k]];
            faces.push(vec![if is_hole { wall.into_iter().rev().collect() } else { wall }]);
        }
    };
    walls(&low, &high, false);
    for hole in 0..holes {
        let [low, high] = square(&mut vertices, [3.0 * hole as f64 + 1.0, 1.0], [2.0, 2.0]);
        walls(&low, &high, true);
        bottom.push(low);
        top.push(high.into_iter().rev().collect());
    }
    faces.extend([bottom, top]);
    Arrays::solid(&[(vertices, faces)])
}

/// A solid written as polygons is read back as the same solid.
#[test]
fn polygons_are_written() {
    use leafless::exchange::{MeshFormat, MeshOptions, WriteOptions, read_mesh, write_polygons};
    let options = WriteOptions { deviation: Some(0.125), ..WriteOptions::default() };
    for holes in [0, 1, 2, 5, 40] {
        let arrays = plate(holes);
        let own = arrays.made();
        let volume = (3.0 * holes as f64 + 1.0) * 4.0 - 4.0 * holes as f64;
        for format in [MeshFormat::Obj, MeshFormat::Off] {
            let bytes = write_polygons(&arrays.view(), format, &options).unwrap();
            let file = read_mesh(&bytes, &MeshOptions::default()).unwrap();
            assert_eq!((file.format, file.deviation), (format, Some(0.125)));
            file.mesh.check_closed(FillRule::NonZero).unwrap();
            assert_eq!(file.mesh.vertices(), own.mesh().vertices());
            assert_eq!((file.mesh.volume(), own.mesh().volume()), (volume, volume));
            assert_eq!(file.mesh.triangles().len(), own.mesh().triangles().len());
            let report = file.mesh.report().unwrap();
            assert!(report.is_manifold() && report.bent_polygons == 0);
            // The sides, and a few polygons at the bottom and the top.
            let text = String::from_utf8(bytes).unwrap();
            let polygons = match format {
                MeshFormat::Obj => text.lines().filter(|line| line.starts_with('f')).count(),
                _ => text.lines().nth(2).unwrap().split(' ').nth(1).unwrap().parse().unwrap(),
            };
            let cut = polygons - 4 * (holes + 1);
            assert!((2..=2 + 4 * holes).contains(&cut), "{cut} of {holes}");
            if holes == 1 {
                assert!(cut <= 6);
            }
        }
    }
    for format in [MeshFormat::Stl, MeshFormat::Ply, MeshFormat::ThreeMf] {
        let error = write_polygons(&plate(1).view(), format, &options).unwrap_err();
        assert!(matches!(error, Error::Argument { name: "format", .. }), "{error}");
    }
    let mut wrong = plate(1);
    wrong.corners[0] = 99;
    let error = write_polygons(&wrong.view(), MeshFormat::Obj, &options).unwrap_err();
    assert!(matches!(error, Error::Polyhedron(_)), "{error}");
}
