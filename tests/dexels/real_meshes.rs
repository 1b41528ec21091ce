//! Tri-dexel models of real meshes: samples, surfaces there and back, edges, and the losses of one, two and
//! three directions.

use glam::DVec3;
use leafless::dexel::{DexelEnds, DexelFormat, DexelNormals};
use leafless::exchange::{MeshOptions, read_mesh};
use leafless::op::{DexelOptions, octree_from_dexels};
use leafless::surface::{dual_contouring_dexels, marching_cubes_dexels};
use leafless::{
    Control, Csg, FillRule, Frame, Membership, MeshSolid, Rule, TriDexel, TriangleMesh, build, dexelize,
    difference, intersection, union, xor,
};
use leafless_testkit::model;
use std::collections::HashMap;

fn read(name: &str) -> Option<TriangleMesh> {
    let bytes = std::fs::read(model(name)?).unwrap();
    Some(read_mesh(&bytes, &MeshOptions::default()).unwrap().mesh.sewn().unwrap())
}

fn marked() -> DexelOptions {
    let format = DexelFormat {
        ends: DexelEnds::Double,
        normals: DexelNormals::Bits32,
        surfaces: true,
        materials: false,
    };
    DexelOptions { format, ..DexelOptions::default() }
}

fn around(mesh: &TriangleMesh, depth: u8) -> Frame {
    let (min, max) = mesh.bounds();
    Frame::fitted(min, max, depth).unwrap()
}

const CLOSED: [&str; 7] = [
    "bunny-closed.stl",
    "featuretype.STL",
    "plate_holes.STL",
    "angle_block.STL",
    "fandisk.obj",
    "rocker-arm.obj",
    "spot.obj",
];

#[test]
fn all_directions_have_the_samples_of_closed_meshes() {
    let control = Control::default();
    for name in CLOSED {
        let Some(mesh) = read(name) else { return };
        mesh.check_closed(FillRule::NonZero).unwrap();
        let frame = around(&mesh, 7);
        let volume = mesh.volume();
        let solid = MeshSolid::new(mesh, FillRule::NonZero).unwrap();
        let tree = build(&solid, &frame, Rule::Sampled, &control).unwrap();
        for axis in 0..3 {
            // An odd number of crossings would give a runaway interval, and wrong samples along its ray.
            let directions = [0, 1, 2].map(|a| a == axis);
            let model = dexelize(&solid, &frame, &DexelOptions { directions, ..marked() }, &control).unwrap();
            model.view().check().unwrap();
            assert!(octree_from_dexels(model.view(), &control).unwrap() == tree, "{name} along {axis}");
            let found = model.view().statistics(axis).unwrap().volume;
            // (A plate of some cells is not measured by rays along it.)
            if name != "plate_holes.STL" {
                assert!((found / volume - 1.0).abs() < 0.03, "{name} along {axis}: {found} for {volume}");
            }
        }
        let both =
            [1, 2].map(|threads| dexelize(&solid, &frame, &marked(), &Control::threads(threads)).unwrap());
        assert!(both[0] == both[1], "{name}");
    }
}

/// Distances to a mesh. Only triangles in grid boxes near the point are examined.
struct Nearest {
    triangles: Vec<[DVec3; 3]>,
    size: f64,
    boxes: HashMap<[i64; 3], Vec<u32>>,
}

impl Nearest {
    fn new(mesh: &TriangleMesh, size: f64) -> Nearest {
        let mut nearest = Nearest { triangles: Vec::new(), size, boxes: HashMap::new() };
        for triangle in mesh.triangles() {
            let corners = triangle.map(|v| DVec3::from(mesh.vertices()[v as usize]));
            let number = nearest.triangles.len() as u32;
            nearest.triangles.push(corners);
            let low = corners[0].min(corners[1]).min(corners[2]);
            let high = corners[0].max(corners[1]).max(corners[2]);
            let [a, b] = [nearest.place(low), nearest.place(high)];
            for x in a[0]..=b[0] {
                for y in a[1]..=b[1] {
                    for z in a[2]..=b[2] {
                        nearest.boxes.entry([x, y, z]).or_default().push(number);
                    }
                }
            }
        }
        nearest
    }

    fn place(&self, point: DVec3) -> [i64; 3] {
        (point / self.size).floor().to_array().map(|c| c as i64)
    }

    /// Returns the distance if it is at most the size of a box, else infinity.
    fn distance(&self, point: DVec3) -> f64 {
        let at = self.place(point);
        let mut least = f64::INFINITY;
        for n in 0..27 {
            let place = [at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1];
            for &triangle in self.boxes.get(&place).into_iter().flatten() {
                least = least.min(to_triangle(point, self.triangles[triangle as usize]));
            }
        }
        if least <= self.size { least } else { f64::INFINITY }
    }
}

/// Returns the distance of a point from a triangle (Ericson 2005).
fn to_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let to_segment = |a: DVec3, b: DVec3| {
        let t = (p - a).dot(b - a) / (b - a).length_squared();
        if t.is_nan() { p.distance(a) } else { p.distance(a + (b - a) * t.clamp(0.0, 1.0)) }
    };
    let normal = (b - a).cross(c - a);
    let sides = [(a, b), (b, c), (c, a)].map(|(a, b)| (b - a).cross(p - a).dot(normal));
    if normal.length_squared() > 0.0 && sides.iter().all(|&side| side >= 0.0) {
        return ((p - a).dot(normal) / normal.length()).abs();
    }
    to_segment(a, b).min(to_segment(b, c)).min(to_segment(c, a))
}

/// Returns at most `most` points of a mesh: vertices and inner points of triangles.
fn points(mesh: &TriangleMesh, most: usize) -> Vec<(DVec3, DVec3)> {
    let mut random = leafless_testkit::Random(17);
    (0..most)
        .map(|_| {
            let triangle = mesh.triangles()[random.below(mesh.triangles().len() as u64) as usize];
            let [a, b, c] = triangle.map(|v| DVec3::from(mesh.vertices()[v as usize]));
            let (mut s, mut t) = (random.unit(), random.unit());
            if s + t > 1.0 {
                (s, t) = (1.0 - s, 1.0 - t);
            }
            (a + (b - a) * s + (c - a) * t, (b - a).cross(c - a).normalize_or_zero())
        })
        .collect()
}

#[test]
fn surfaces_lead_back_to_closed_meshes() {
    let control = Control::default();
    for name in CLOSED {
        let Some(mesh) = read(name) else { return };
        let frame = around(&mesh, 6);
        let cell = frame.cell_size();
        let diagonal = cell * 3f64.sqrt();
        let solid = MeshSolid::new(mesh.clone(), FillRule::NonZero).unwrap();
        let model = dexelize(&solid, &frame, &marked(), &control).unwrap();
        let source = Nearest::new(&mesh, 2.0 * cell);
        let fine = build(&solid, &frame.with_depth(9).unwrap(), Rule::Sampled, &control).unwrap();
        type Way = fn(
            &leafless::dexel::TriDexelRef<'_>,
            &Control<'_>,
        )
            -> Result<(TriangleMesh, leafless::surface::DexelSurfaceReport), leafless::Error>;
        let ways: [(&str, Way, f64); 2] = [
            ("marching cubes", marching_cubes_dexels, 0.5 * diagonal),
            ("dual contouring", dual_contouring_dexels, diagonal),
        ];
        for (way, extract, most) in ways {
            let (surface, report) = extract(model.view(), &control).unwrap();
            assert_eq!((report.without_rays, report.disagreeing), (0, 0), "{name}");
            leafless_testkit::surfaces::assert_balanced(&surface);
            assert!(surface.volume() > 0.0);
            let far = points(&surface, 4000).iter().map(|&(p, _)| source.distance(p)).fold(0.0, f64::max);
            assert!(far <= most, "{name}, {way}: {} cells from the source", far / cell);
            // Where walls and gaps are at least two cells wide, all of the source is near the surface. For
            // marching cubes this holds where balls of this size touch from both sides: marching cubes cuts
            // corners off by up to 1.15 cells.
            let back = Nearest::new(&surface, 2.0 * cell);
            let contains = |p: DVec3| fine.contains(p.to_array()) == Membership::Inside;
            let is_wide = |&(p, n): &(DVec3, DVec3)| {
                let along = |k: f64| contains(p - n * (k * cell)) && !contains(p + n * (k * cell));
                let ball = |i: i32| {
                    let to = DVec3::new(f64::from(i % 3 - 1), f64::from(i / 3 % 3 - 1), f64::from(i / 9 - 1));
                    let to = to.normalize_or_zero() * (0.9 * cell);
                    contains(p - n * cell + to) && !contains(p + n * cell + to)
                };
                [0.25, 0.5, 1.0, 1.5, 2.0].into_iter().all(along)
                    && (way != "marching cubes" || (0..27).all(ball))
            };
            let wide: Vec<_> = points(&mesh, 4000).into_iter().filter(is_wide).collect();
            let lost = wide.iter().map(|&(p, _)| back.distance(p)).fold(0.0, f64::max);
            println!(
                "{name}, {way}: {:.3} cells there, {:.3} cells back at {} points",
                far / cell,
                lost / cell,
                wide.len()
            );
            assert!(lost <= most, "{name}, {way}: the source is {} cells from the surface", lost / cell);
        }
    }
}

#[test]
fn dual_contouring_keeps_the_edges_of_a_part() {
    let control = Control::default();
    let Some(mesh) = read("fandisk.obj") else { return };
    let frame = around(&mesh, 7);
    let cell = frame.cell_size();
    let solid = MeshSolid::new(mesh.clone(), FillRule::NonZero).unwrap();
    let model = dexelize(&solid, &frame, &marked(), &control).unwrap();
    let (surface, _) = dual_contouring_dexels(model.view(), &control).unwrap();
    let nearest = Nearest::new(&surface, 2.0 * cell);
    // Edges between faces that meet at more than 30 degrees.
    let mut edges: HashMap<[u32; 2], Vec<DVec3>> = HashMap::new();
    for &[a, b, c] in mesh.triangles() {
        let [p, q, r] = [a, b, c].map(|v| DVec3::from(mesh.vertices()[v as usize]));
        for (from, to) in [(a, b), (b, c), (c, a)] {
            edges.entry([from.min(to), from.max(to)]).or_default().push((q - p).cross(r - p).normalize());
        }
    }
    let (mut off, mut beyond) = (Vec::new(), Vec::new());
    for ([a, b], normals) in &edges {
        if normals[0].dot(normals[1]) < 30f64.to_radians().cos() {
            let [a, b] = [*a, *b].map(|v| DVec3::from(mesh.vertices()[v as usize]));
            for k in 1..8 {
                let p = a.lerp(b, f64::from(k) / 8.0);
                // A cube between eight centres on one side has no vertex. The edge is cut off there as far as
                // the neighbours' vertices, since no vertex leaves its own cube.
                let has_vertex = |p: DVec3| {
                    let corner = ((p - DVec3::from(frame.origin())) / cell - 0.5).floor();
                    let inside = |k: i32| {
                        let to = DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2 & 1));
                        model.view().contains_cell((corner + to).to_array().map(|c| c as u32))
                    };
                    (0..8).filter(|&k| inside(k)).count() % 8 != 0
                };
                let along = (b - a).normalize() * cell;
                let whole = [-1.0, -0.5, 0.0, 0.5, 1.0].iter().all(|&t| has_vertex(p + along * t));
                let list = if whole { &mut off } else { &mut beyond };
                list.push(nearest.distance(p) / cell);
            }
        }
    }
    for list in [&mut off, &mut beyond] {
        list.sort_by(f64::total_cmp);
        let part = |k: usize| list[(list.len() - 1) * k / 1000];
        println!(
            "{} points: median {:.4}, 99 % {:.4}, 99.9 % {:.4}, most {:.4} cells",
            list.len(),
            part(500),
            part(990),
            part(999),
            part(1000)
        );
    }
    assert!(off.len() > 20 * beyond.len());
    assert!(off[off.len() * 999 / 1000] <= 0.1);
    assert!(off[off.len() - 1].max(beyond[beyond.len() - 1]) <= 0.15);
    // Marching cubes cuts them off.
    let (cut, _) = marching_cubes_dexels(model.view(), &control).unwrap();
    assert!(cut.volume() < surface.volume());
    assert!((surface.volume() / mesh.volume() - 1.0).abs() < 1e-4);
}

#[test]
fn set_operations_agree_with_those_of_octrees() {
    let (frame, control) = (Frame::new([-1.0; 3], 2.0, 7).unwrap(), Control::default());
    let a = Csg::ball([-0.2, 0.0, 0.1], 0.6).unwrap();
    let b = Csg::cuboid([-0.3, -0.45, -0.5], [0.7, 0.5, 0.55]).unwrap();
    let dexels = [&a, &b].map(|solid| dexelize(solid, &frame, &DexelOptions::default(), &control).unwrap());
    let certified = [&a, &b].map(|solid| build(solid, &frame, Rule::Certified, &control).unwrap());
    let sampled = [&a, &b].map(|solid| build(solid, &frame, Rule::Sampled, &control).unwrap());
    let [x, y] = [dexels[0].view(), dexels[1].view()];
    let ([p, q], [s, t]) = (
        [&certified[0], &certified[1]].map(|tree| tree.view()),
        [&sampled[0], &sampled[1]].map(|tree| tree.view()),
    );
    let results = [
        (x.union(y, &control), union(p, q, &control), union(s, t, &control)),
        (x.intersection(y, &control), intersection(p, q, &control), intersection(s, t, &control)),
        (x.difference(y, &control), difference(p, q, &control), difference(s, t, &control)),
        (x.xor(y, &control), xor(p, q, &control), xor(s, t, &control)),
    ];
    for (i, (dexels, certified, sampled)) in results.into_iter().enumerate() {
        let (dexels, certified, sampled) = (dexels.unwrap(), certified.unwrap(), sampled.unwrap());
        assert!(octree_from_dexels(dexels.view(), &control).unwrap() == sampled, "operation {i}");
        let volume = certified.statistics().volume();
        for axis in 0..3 {
            let found = dexels.view().statistics(axis).unwrap().volume;
            assert!(volume.contains(found), "operation {i} along {axis}: {found} is not in {volume:?}");
        }
    }
}

/// Returns the volume of the unit ball between two planes.
fn ball_between([low, high]: [f64; 2]) -> f64 {
    let below = |x: f64| {
        let x = x.clamp(-1.0, 1.0);
        std::f64::consts::PI * (x - x * x * x / 3.0 + 2.0 / 3.0)
    };
    below(high) - below(low)
}

/// Returns the share of the unit ball outside the extent that the rays of some directions cross. (The caps do
/// not overlap.)
fn lost(model: &TriDexel) -> f64 {
    let ball = 4.0 / 3.0 * std::f64::consts::PI;
    let mut lost = 0.0;
    for axis in 0..3 {
        let mut reach = [f64::INFINITY, f64::NEG_INFINITY];
        for direction in 0..3 {
            if let Some(statistics) = model.view().statistics(direction) {
                let [low, high] = statistics.extent[axis];
                reach = [reach[0].min(low), reach[1].max(high)];
            }
        }
        lost += ball - ball_between(reach);
    }
    lost / ball
}

/// Figure 2 of Gao, Zhang and Hou (2007): a sphere in its bounding box.
#[test]
fn what_directions_lose_of_a_sphere() {
    let control = Control::default();
    let ball = Csg::ball([0.0; 3], 1.0).unwrap();
    let mut table = String::from("/// | rays to an axis | y | x, y | x, y, z |\n/// |---|---|---|---|\n");
    let mut before = [1.0; 3];
    for depth in 3..10 {
        let frame = Frame::new([-1.0; 3], 2.0, depth).unwrap();
        let sets = [[false, true, false], [true, true, false], [true; 3]];
        let format = DexelFormat { ends: DexelEnds::Double, ..DexelFormat::default() };
        let found = sets.map(|directions| {
            let options = DexelOptions { directions, format, ..DexelOptions::default() };
            lost(&dexelize(&ball, &frame, &options, &control).unwrap())
        });
        // Four caps, two caps, and none except the parts behind the rays nearest to the poles.
        let h = frame.cell_size();
        let cap = |height: f64| height * height * (3.0 - height) / 4.0;
        let pole = 1.0 - (1.0 - h * h / 2.0).sqrt();
        for (found, expected) in found.iter().zip([
            4.0 * cap(h / 2.0) + 2.0 * cap(pole),
            2.0 * cap(h / 2.0) + 4.0 * cap(pole),
            6.0 * cap(pole),
        ]) {
            assert!((found - expected).abs() < 1e-14 + 1e-3 * expected, "{found} {expected}");
        }
        assert!(found[0] > found[1] && found[1] > found[2]);
        let ratios = [0, 1, 2].map(|i| before[i] / found[i]);
        // With half the step, caps lose a quarter as much, and the parts behind the poles a sixteenth.
        assert!(depth == 3 || ratios[0] > 3.7 && ratios[1] > 3.7 && ratios[2] > 15.0, "{ratios:?}");
        before = found;
        let percent = found.map(|part| format!("{:.6} %", 100.0 * part));
        table += &format!("/// | {} | {} | {} | {} |\n", frame.cells(), percent[0], percent[1], percent[2]);
    }
    print!("{table}");
    let documentation = include_str!("../../src/dexel/model.rs");
    assert!(documentation.contains(&table), "the documentation of TriDexel has another table");
}

#[path = "../../examples/dexel_parts.rs"]
#[allow(dead_code)]
mod dexel_parts;

#[test]
fn parts_of_the_paper_have_their_volumes() {
    let control = Control::default();
    for part in dexel_parts::parts(7, &control).unwrap() {
        part.model.view().check().unwrap();
        let mesh = part.surface(&control).unwrap();
        leafless_testkit::surfaces::assert_balanced(&mesh);
        let off = mesh.volume() / part.volume - 1.0;
        println!("{}: {off:e}", part.name);
        assert!(off.abs() < 1e-3, "{}: {} for {}", part.name, mesh.volume(), part.volume);
        for (material, volume) in (1..).zip(&part.materials) {
            // Rays along z cross each ply from end to end. The error comes from the number of rays at the
            // rim.
            let found = part.volume_of(material, 2);
            assert!((found / volume - 1.0).abs() < 0.01, "material {material}: {found} for {volume}");
        }
        assert_eq!(part.volume_of(0, 2) == 0.0, !part.materials.is_empty());
    }
}
