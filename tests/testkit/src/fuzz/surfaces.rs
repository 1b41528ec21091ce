//! Any bytes as a solid, and as options of its surface. Meshes are closed and manifold, and their proven
//! distance from the solid contradicts neither points of the mesh nor rays.

use super::Bytes;
use leafless::exchange::{MeshOptions, read_mesh};
use leafless::query::{DistanceTo, Obstacle, distances};
use leafless::solid::{Band, VoxelGrid};
use leafless::surface::{boundary, contour, surface_nets};
use leafless::{
    Affine, AnySolid, Callback, Control, Csg, Error, FillRule, Frame, MeshSolid, Ray, Rule, Solid,
    SurfaceOptions, TriangleMesh, Verdict, Volume, build, build_extended, cast_rays,
};
use std::collections::HashMap;

impl Bytes<'_> {
    /// Returns half of a small integer.
    fn size(&mut self) -> f64 {
        0.5 * (1 + self.below(8)) as f64
    }
}

/// A part of an expression, in integers, so that faces meet and touch.
fn figure(bytes: &mut Bytes<'_>) -> Csg {
    let kind = bytes.below(8);
    let at = [0; 3].map(|_: i32| bytes.around(4));
    let size = [0; 3].map(|_: i32| bytes.size());
    let solid = match kind {
        0 => Csg::ball(at, size[0]),
        1 | 2 => Csg::cuboid(at, [0, 1, 2].map(|k| at[k] + size[k])),
        3 => {
            let mut end = at;
            end[size[2] as usize % 3] += size[1];
            Csg::cylinder_between(at, end, size[0])
        }
        4 => Csg::frustum(size[0] - 0.5, size[1], 0.0, size[2])
            .and_then(|cone| cone.placed(&Affine::translation(at).expect("a good map"))),
        5 => Csg::ellipsoid(at, size),
        6 => Csg::torus(size[0] + size[1], size[0]),
        _ => {
            let normal = if at == [0.0; 3] { [0.0, 0.0, 1.0] } else { at };
            let half = Csg::half_space(normal, size[0] - 2.0 * size[1]).expect("a good plane");
            Csg::intersection_of([half, Csg::cuboid([-6.0; 3], [6.0; 3]).expect("a good box")])
        }
    };
    solid.expect("a good figure")
}

fn expression(bytes: &mut Bytes<'_>) -> Csg {
    let mut solid = figure(bytes);
    for _ in 0..bytes.below(4) {
        let operation = bytes.below(4);
        let other = figure(bytes);
        solid = match operation {
            0 | 1 => solid.difference(&other),
            2 => Csg::union_of([solid, other]),
            _ => Csg::intersection_of([solid, other]),
        }
        .expect("enough memory");
    }
    let ((s, c), (t, d)) = (0.47f64.sin_cos(), 1.7f64.sin_cos());
    let rows = match bytes.below(4) {
        0 | 1 => return solid,
        2 => [[c, -s * d, s * t, 0.1], [s, c * d, -c * t, 0.2], [0.0, t, d, -0.3]],
        _ => [[0.75, 0.25, 0.0, 0.0], [0.0, 1.0, -0.5, 0.0], [0.125, 0.0, 0.5, 1.0]],
    };
    solid.placed(&Affine::new(rows).expect("a good map")).expect("it can be moved")
}

/// Asserts that each edge has two triangles in opposite directions and, if `has_fans`, that the triangles
/// around each vertex form one fan.
fn check_closed(mesh: &TriangleMesh, has_fans: bool) {
    let mut next: HashMap<(u32, u32), u32> = HashMap::new();
    let mut fans: HashMap<u32, (u32, u32)> = HashMap::new();
    for &[a, b, c] in mesh.triangles() {
        for (from, to, third) in [(a, b, c), (b, c, a), (c, a, b)] {
            let is_new = from != to && next.insert((from, to), third).is_none();
            let ends = [from, to].map(|v| mesh.vertices()[v as usize]);
            assert!(is_new, "the edge {from} {to} once more: {ends:?}");
            fans.entry(from).or_insert((to, 0)).1 += 1;
        }
    }
    assert!(next.keys().all(|&(from, to)| next.contains_key(&(to, from))), "an edge is open");
    assert!(mesh.vertices().iter().flatten().all(|c| c.is_finite()));
    for (&vertex, &(start, count)) in fans.iter().filter(|_| has_fans) {
        let (mut at, mut met) = (next[&(vertex, start)], 1);
        while at != start {
            (at, met) = (next[&(vertex, at)], met + 1);
        }
        assert_eq!(met, count, "several fans at {vertex}");
    }
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns the distance of a point from a triangle, by the regions of its corners and sides (Ericson,
/// *Real-time collision detection*, 2005, 5.1.5).
fn away(point: [f64; 3], [a, b, c]: [[f64; 3]; 3]) -> f64 {
    let toward = |from: [f64; 3], to: [f64; 3]| {
        let side = minus(to, from);
        let square = dot(side, side);
        let t = if square > 0.0 { (dot(minus(point, from), side) / square).clamp(0.0, 1.0) } else { 0.0 };
        let off = minus(point, [0, 1, 2].map(|k| from[k] + t * side[k]));
        dot(off, off)
    };
    let least = toward(a, b).min(toward(b, c)).min(toward(c, a));
    let (ab, ac, ap) = (minus(b, a), minus(c, a), minus(point, a));
    let [aa, bb, cc, d, e] = [dot(ab, ab), dot(ab, ac), dot(ac, ac), dot(ap, ab), dot(ap, ac)];
    let whole = aa * cc - bb * bb;
    let (v, w) = ((cc * d - bb * e) / whole, (aa * e - bb * d) / whole);
    if whole > 0.0 && v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
        let off = minus(point, [0, 1, 2].map(|k| a[k] + v * ab[k] + w * ac[k]));
        return dot(off, off).min(least).sqrt();
    }
    least.sqrt()
}

/// A bound of all rounding errors in this file.
const LITTLE: f64 = 1e-7;

/// Compares the proven deviation with points of the mesh and with rays.
fn check_deviation(solid: &AnySolid, mesh: &TriangleMesh, deviation: f64, told: &str) {
    assert!(deviation >= 0.0, "{told}: {deviation}");
    if deviation == f64::INFINITY {
        return;
    }
    // A stored solid is known on its own lattice alone.
    let frame = solid.home().unwrap_or(Frame::new([-16.5; 3], 33.0, 16).expect("a good frame"));
    let control = Control { threads: 1, max_splits: Some(60), ..Control::default() };
    let places = mesh.vertices();
    let corners = |t: &[u32; 3]| t.map(|v| places[v as usize]);
    let step = mesh.triangles().len() / 6 + 1;
    let mut points: Vec<[f64; 3]> = Vec::new();
    for triangle in mesh.triangles().iter().step_by(step) {
        let [a, b, c] = corners(triangle);
        points.push([0, 1, 2].map(|k| (a[k] + b[k] + c[k]) / 3.0));
        points.push([0, 1, 2].map(|k| 0.5 * (a[k] + b[k])));
        points.push(a);
    }
    let found = distances(solid, &frame, &points, DistanceTo::Boundary, 0.0, &control).expect("asked well");
    for (point, found) in points.iter().zip(found) {
        let least = found.distance.lower.max(-found.distance.upper);
        assert!(least <= deviation * (1.0 + LITTLE) + LITTLE, "{told}: {point:?} {least} {deviation}");
    }
    let mut rays = Vec::new();
    for k in 0..12u32 {
        let (axis, at) = (k as usize % 3, f64::from(k / 3));
        let (mut origin, mut direction) = ([1.7 * at - 2.9, 2.3 - 1.3 * at, 0.37 * at], [0.11, -0.07, 0.05]);
        (origin[axis], direction[axis]) = if k % 2 == 0 { (-15.9, 1.0) } else { (15.9, -1.0) };
        rays.push((origin, direction));
    }
    let asked: Vec<Ray> = rays.iter().map(|&(from, way)| Ray::new(from, way).expect("a good ray")).collect();
    let hits = cast_rays(solid, &frame, &asked, Obstacle::Full, &control).expect("asked well");
    for (k, hit) in hits.iter().enumerate() {
        let Some(hit) = hit.filter(|hit| hit.t.upper.is_finite() && hit.t.lower > 0.0) else { continue };
        let (t, (origin, direction)) = (0.5 * (hit.t.lower + hit.t.upper), rays[k]);
        let point = [0, 1, 2].map(|axis| origin[axis] + t * direction[axis]);
        let doubt = 0.5 * hit.t.width() * dot(direction, direction).sqrt();
        let least = mesh.triangles().iter().map(|t| away(point, corners(t))).fold(f64::INFINITY, f64::min);
        let most = deviation * (1.0 + LITTLE) + doubt + LITTLE;
        assert!(least <= most, "{told}: ray {k} {point:?} {least} {deviation}");
    }
}

/// Runs the fuzz target `boundaries`.
pub fn boundaries(data: &[u8]) {
    let mut bytes = Bytes(data);
    let tolerance = [1.0, 0.25, 0.06][bytes.below(3)];
    let depth = [4, 6, 8, 10][bytes.below(4)];
    let is_stored = bytes.below(4) == 0;
    let solid = expression(&mut bytes);
    let frame = Frame::new([-16.0; 3], 32.0, depth).expect("a good frame");
    let control = Control { threads: 1, max_nodes: Some(2000), ..Control::default() };
    let solid = if is_stored {
        match build_extended(&solid, &frame, &SurfaceOptions::default(), &control) {
            Ok(octree) => AnySolid::new(octree),
            Err(Error::Limit { .. }) => return,
            Err(error) => panic!("{error}"),
        }
    } else {
        AnySolid::new(solid)
    };
    match boundary(&solid, &frame, tolerance, &control) {
        Ok(found) => {
            check_closed(found.mesh(), false);
            let told = format!("tolerance {tolerance} depth {depth} stored {is_stored}");
            check_deviation(&solid, found.mesh(), found.report().deviation, &told);
        }
        // An octree without a cell that keeps surfaces provides none.
        Err(Error::Limit { .. } | Error::Argument { name: "solid", .. }) => {}
        Err(error) => panic!("{error}"),
    }
}

/// A solid of a random kind, and whether it is honest and known to be certified.
fn any_solid(bytes: &mut Bytes<'_>) -> (AnySolid, bool) {
    match bytes.below(6) {
        0 => (AnySolid::new(expression(bytes)), true),
        // A mesh of a few triangles: closed, open, or with intersecting triangles.
        1 => (facets(bytes), true),
        2 => {
            let mesh = Csg::solid(facets(bytes));
            let solid = match bytes.below(3) {
                0 => mesh.difference(&expression(bytes)),
                1 => Csg::union_of([mesh, expression(bytes)]),
                _ => Csg::intersection_of([mesh, expression(bytes)]),
            };
            (AnySolid::new(solid.expect("enough memory")), true)
        }
        3 => {
            let n = 2 + bytes.below(4) as u32;
            let samples: Vec<f32> = (0..n.pow(3)).map(|_| bytes.byte() as f32 - 128.0).collect();
            let grid = VoxelGrid::new([n; 3], [-8.0; 3], [16.0 / f64::from(n); 3]).expect("a good grid");
            let band = Band::at_least(0.0).expect("a good band");
            let volume = Volume::new(samples.into(), &grid, band, &Control::threads(1));
            (AnySolid::new(volume.expect("good samples")), true)
        }
        4 => {
            let frame = Frame::new([-16.0; 3], 32.0, 4).expect("a good frame");
            let rule = [Rule::Certified, Rule::Sampled][bytes.below(2)];
            let octree = build(&expression(bytes), &frame, rule, &Control::threads(1)).expect("built");
            if octree.view().is_binary() {
                check_closed(&surface_nets(octree.view(), None, &Control::threads(1)).expect("made"), true);
            }
            (AnySolid::new(octree), rule == Rule::Certified)
        }
        // A host's functions that contradict each other.
        _ => {
            let seed = bytes.byte() as u64 | (bytes.byte() as u64) << 8;
            let hash = move |point: [f64; 3]| {
                let bits =
                    point.iter().fold(seed, |sum, c| (sum ^ c.to_bits()).wrapping_mul(0x9E37_79B9_7F4A_7C15));
                (bits ^ bits >> 29).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 56
            };
            let solid = Callback::new(move |min, max| {
                let die = hash(min) ^ hash(max);
                Ok(match die {
                    0..24 => Verdict::Full,
                    24..48 => Verdict::Empty,
                    _ => Verdict::Partial(()),
                })
            });
            let solid = solid.with_contains(move |point| Ok(hash(point) < 96));
            let distance = move |points: &[[f64; 3]], found: &mut [f64]| {
                for (point, found) in points.iter().zip(found) {
                    *found = match hash(*point) {
                        0..16 => f64::NAN,
                        16..20 => f64::INFINITY,
                        20..24 => f64::NEG_INFINITY,
                        die => (die as f64 - 128.0) / 256.0,
                    };
                }
                Ok(())
            };
            let solid = if seed & 1 == 0 { solid } else { solid.with_distance(distance) };
            (AnySolid::new(solid.with_exterior(leafless::Tag::Empty)), false)
        }
    }
}

/// A mesh on a small lattice; a ball if it has no triangle.
fn facets(bytes: &mut Bytes<'_>) -> AnySolid {
    let count = 4 + bytes.below(4) as u32;
    let mut text = String::from("OFF\n");
    let vertices: Vec<[f64; 3]> = (0..count).map(|_| [0; 3].map(|_: i32| bytes.around(6))).collect();
    let mut faces = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    for vertex in 4..count {
        // Move a vertex onto an existing face, or remove a face.
        let at = bytes.below(faces.len());
        let [a, b, c] = faces.swap_remove(at);
        if bytes.below(16) != 0 {
            faces.extend([[a, b, vertex], [b, c, vertex], [c, a, vertex]]);
        }
    }
    text += &format!("{count} {} 0\n", faces.len());
    vertices.iter().for_each(|[x, y, z]| text += &format!("{x} {y} {z}\n"));
    faces.iter().for_each(|[a, b, c]| text += &format!("3 {a} {b} {c}\n"));
    let mesh = read_mesh(text.as_bytes(), &MeshOptions::default()).expect("a good file").mesh;
    if mesh.triangles().is_empty() {
        return AnySolid::new(Csg::ball([0.0; 3], 1.0).expect("a good ball"));
    }
    AnySolid::new(MeshSolid::new(mesh, FillRule::NonZero).expect("a good mesh"))
}

/// Runs the fuzz target `contours`.
pub fn contours(data: &[u8]) {
    let mut bytes = Bytes(data);
    let tolerance = [4.0, 2.0, 1.0][bytes.below(3)];
    let depth = [3, 4, 5][bytes.below(3)];
    let (solid, is_honest) = any_solid(&mut bytes);
    let frame = Frame::new([-16.0; 3], 32.0, depth).expect("a good frame");
    let control = Control { threads: 1, max_nodes: Some(300), ..Control::default() };
    match contour(&solid, &frame, tolerance, &control) {
        Ok(found) => {
            check_closed(found.mesh(), true);
            if is_honest {
                let told = format!("tolerance {tolerance} depth {depth}");
                check_deviation(&solid, found.mesh(), found.report().deviation, &told);
            }
        }
        // A mesh with holes is unbounded, and a mesh without triangles has no inside.
        Err(Error::Limit { .. } | Error::Argument { name: "frame", .. }) => {}
        Err(error) => panic!("{error}"),
    }
}
