//! Octrees of every kind of solid, against checksums from the first run of the corpus.
//!
//! `corpus.txt` has a line for each solid, depth and rule: the checksum of all tags, and the numbers of FULL
//! and PARTIAL finest cells. A resolved octree must never change. A certified octree may only become tighter.
//! Then its first line stays in the file behind the new one, after `was`.

use leafless::octree::Cursor;
use leafless::solid::{HalfSpace, Transform};
use leafless::{
    Affine, AnySolid, Callback, Csg, FillRule, Frame, MeshSolid, Octree, Rule, Tag, TriangleMesh, Verdict,
    build,
};
use leafless_testkit::{Random, alone, model, repeated};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::Arc;

const RULES: [Rule; 4] = [Rule::Certified, Rule::Sampled, Rule::Inner, Rule::Outer];

/// Makes a solid of its own kind for a frame.
type Make = Box<dyn Fn(&Frame) -> AnySolid>;

struct Entry {
    name: String,
    frame: Box<dyn Fn(u8) -> Frame>,
    depths: Vec<u8>,
    make: Make,
}

/// The frame [-1, 1]³.
fn unit(depth: u8) -> Frame {
    Frame::new([-1.0; 3], 2.0, depth).unwrap()
}

/// A frame whose lattice planes are no doubles.
fn odd(depth: u8) -> Frame {
    Frame::new([-1.1, -1.3, -0.9], 2.3, depth).unwrap()
}

fn of_mesh(mesh: &Arc<TriangleMesh>, fill: FillRule) -> AnySolid {
    AnySolid::new(MeshSolid::new(mesh.clone(), fill).unwrap())
}

fn transformed(solid: AnySolid, own: &Frame, placement: &Affine) -> AnySolid {
    AnySolid::new(Transform::new(solid, own, placement))
}

/// A torus of 2·n² triangles.
fn torus(n: u32, major: f64, minor: f64) -> TriangleMesh {
    let angle = |i: u32| f64::from(i % n) / f64::from(n) * std::f64::consts::TAU;
    let vertices = (0..n * n).map(|i| {
        let ((sin_u, cos_u), (sin_v, cos_v)) = (libm_sincos(angle(i / n)), libm_sincos(angle(i % n)));
        let radius = major + minor * cos_v;
        [radius * cos_u, radius * sin_u, minor * sin_v]
    });
    let at = |i: u32, j: u32| (i % n) * n + j % n;
    let triangles = (0..n * n).flat_map(|k| {
        let (i, j) = (k / n, k % n);
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    TriangleMesh::new(vertices.collect(), triangles.collect()).unwrap()
}

/// Sine and cosine by their series, with the same bits on every platform.
fn libm_sincos(x: f64) -> (f64, f64) {
    let (mut sin, mut cos, mut term) = (0.0, 0.0, 1.0);
    for k in 0..40 {
        match k % 4 {
            0 => cos += term,
            1 => sin += term,
            2 => cos -= term,
            _ => sin -= term,
        }
        term *= x / f64::from(k + 1);
    }
    (sin, cos)
}

fn plate() -> Csg {
    let mut parts = vec![Csg::cuboid([-0.9, -0.7, -0.2], [0.9, 0.7, 0.15]).unwrap()];
    for i in 0..6 {
        for j in 0..3 {
            let at = [-0.75 + 0.3 * f64::from(i), -0.5 + 0.5 * f64::from(j), 0.0];
            let hole = Csg::cylinder(0.07 + 0.01 * f64::from(j), -1.0, 1.0).unwrap();
            parts.push(hole.placed(&Affine::translation(at).unwrap()).unwrap().complement());
        }
    }
    Csg::intersection_of(parts).unwrap()
}

fn turned() -> Affine {
    Affine::new([[0.36, 0.48, -0.8, 0.05], [-0.8, 0.6, 0.0, 0.01], [0.48, 0.64, 0.6, -0.03]]).unwrap()
}

fn balls(count: usize, radius: f64) -> Csg {
    let mut random = Random(77);
    let ball = |_| {
        let centre = [0; 3].map(|_| random.between(-0.95, 0.95));
        Csg::ball(centre, radius * random.between(0.5, 1.5)).unwrap()
    };
    Csg::union_of((0..count).map(ball).collect::<Vec<_>>()).unwrap()
}

/// A nested expression of unions. Every fifth operation is a difference.
fn nested(count: usize) -> Csg {
    let mut random = Random(5);
    let mut all = Csg::empty();
    for i in 0..count {
        let at = [0; 3].map(|_| random.between(-0.8, 0.8));
        let size = random.between(0.05, 0.3);
        let part = if i % 2 == 0 {
            Csg::cuboid(at, at.map(|c| c + size)).unwrap()
        } else {
            Csg::ball(at, size).unwrap()
        };
        all = if i % 5 == 4 { all.difference(&part).unwrap() } else { Csg::union_of([all, part]).unwrap() };
    }
    all
}

fn half_spaces() -> Vec<(&'static str, Csg)> {
    let quadric = |c| Csg::from(HalfSpace::quadric(c).unwrap());
    vec![
        ("plane", Csg::half_space([0.3, 0.5, 0.7], 0.01).unwrap()),
        ("ball", Csg::ball([0.1, 0.05, 0.02], 0.8).unwrap()),
        ("touching ball", Csg::ball([0.0; 3], 1.0).unwrap()),
        ("ellipsoid", Csg::ellipsoid([0.1, 0.0, -0.1], [0.8, 0.5, 0.3]).unwrap()),
        ("cylinder", quadric([-1.0, -1.1, 0.0, 0.0, 0.0, 0.0, 0.01, 0.02, 0.0, 0.3])),
        ("quadric", quadric([-1.0, -1.1, -0.9, 0.2, 0.1, -0.15, 0.01, 0.02, 0.03, 0.6])),
        ("torus", HalfSpace::torus(0.6, 0.3).unwrap().into()),
        ("power", HalfSpace::power([(-1.0, 0.1, 4), (-1.0, 0.0, 6), (-1.0, -0.05, 2)], 0.3).unwrap().into()),
    ]
}

/// The solid z ≤ 0.3 − x² as callbacks of a host program.
fn host(frame_knows: bool) -> AnySolid {
    let hill = |x: f64, z: f64| 0.3 - x * x - z;
    let callback = Callback::new(move |min: [f64; 3], max: [f64; 3]| {
        let far = min[0].abs().max(max[0].abs());
        let near = if min[0] <= 0.0 && max[0] >= 0.0 { 0.0 } else { min[0].abs().min(max[0].abs()) };
        Ok(if hill(far, max[2]) > 1e-12 {
            Verdict::Full
        } else if hill(near, min[2]) < -1e-12 {
            Verdict::Empty
        } else {
            Verdict::Partial(())
        })
    });
    let callback = callback.with_contains(move |[x, _, z]| Ok(hill(x, z) >= 0.0));
    AnySolid::new(if frame_knows { callback.with_exterior(Tag::Empty) } else { callback })
}

fn corpus() -> Vec<Entry> {
    let mut all = Vec::new();
    let mut add = |name: &str, depths: &[u8], frame: fn(u8) -> Frame, make: Make| {
        all.push(Entry {
            name: name.replace(' ', "-"),
            frame: Box::new(frame),
            depths: depths.to_vec(),
            make,
        });
    };
    let shallow: Vec<u8> = (1..=6).collect();
    let fixed = |solid: AnySolid| -> Make { Box::new(move |_| solid.clone()) };
    for (name, solid) in half_spaces() {
        add(name, &shallow, unit, fixed(AnySolid::new(solid.clone())));
        add(&format!("odd {name}"), &[1, 4, 5], odd, fixed(AnySolid::new(solid.clone())));
        add(&format!("turned {name}"), &[4, 5], odd, fixed(AnySolid::new(solid.placed(&turned()).unwrap())));
    }
    add("small ball", &shallow, odd, fixed(AnySolid::new(Csg::ball([0.2, 0.1, 0.3], 0.6).unwrap())));
    add(
        "small box",
        &shallow,
        odd,
        fixed(AnySolid::new(Csg::cuboid([-0.3, -0.4, -0.5], [0.3, 0.7, 0.2]).unwrap())),
    );
    add("plate", &[3, 6, 7], unit, fixed(AnySolid::new(plate())));
    add("turned plate", &[5, 6], odd, fixed(AnySolid::new(plate().placed(&turned()).unwrap())));
    add("balls", &[1, 2, 5, 6, 7], unit, fixed(AnySolid::new(balls(500, 0.05))));
    add("large balls", &[3, 6], odd, fixed(AnySolid::new(balls(60, 0.4))));
    add("no balls", &[4, 5], odd, fixed(AnySolid::new(balls(200, 0.1).complement())));
    add("nested", &[1, 2, 3, 6, 7], odd, fixed(AnySolid::new(nested(80))));
    let parity = Csg::xor_of([nested(10), plate(), Csg::ball([0.1, 0.2, 0.3], 0.5).unwrap()]).unwrap();
    add("parity", &[4, 5, 6], unit, fixed(AnySolid::new(parity)));
    add("host", &shallow, unit, fixed(host(false)));
    add("odd host", &[5, 6], odd, fixed(host(true)));

    let closed = Arc::new(torus(24, 0.6, 0.25));
    let mut open = torus(24, 0.6, 0.25).triangles().to_vec();
    open.drain(100..140);
    let open = Arc::new(TriangleMesh::new(closed.vertices().to_vec(), open).unwrap());
    for (name, mesh, fill, depths) in [
        ("torus mesh", &closed, FillRule::NonZero, &[1, 2, 3, 5, 6, 7, 8][..]),
        ("torus even-odd", &closed, FillRule::EvenOdd, &[4, 7]),
        ("open torus", &open, FillRule::NonZero, &[3, 4, 6]),
        ("open torus positive", &open, FillRule::Positive, &[5, 6]),
    ] {
        let mesh = mesh.clone();
        add(name, depths, unit, Box::new(move |_| of_mesh(&mesh, fill)));
    }
    // Other solids within expressions, transforms, stored octrees.
    let mesh = closed.clone();
    add(
        "mesh in csg",
        &[4, 6, 7],
        unit,
        Box::new(move |_| AnySolid::new(Csg::solid(of_mesh(&mesh, FillRule::NonZero)))),
    );
    let mesh = closed.clone();
    add(
        "mesh complement",
        &[6, 7],
        unit,
        Box::new(move |_| AnySolid::new(Csg::solid(of_mesh(&mesh, FillRule::NonZero)).complement())),
    );
    let mesh = closed.clone();
    add(
        "mesh less cylinder",
        &[5, 6, 7],
        unit,
        Box::new(move |_| {
            let mesh = Csg::solid(of_mesh(&mesh, FillRule::NonZero));
            AnySolid::new(mesh.difference(&Csg::cuboid([0.1; 3], [0.9; 3]).unwrap()).unwrap())
        }),
    );
    let mesh = closed.clone();
    add(
        "mesh transformed",
        &[4, 5, 6],
        unit,
        Box::new(move |frame| {
            let own = unit(frame.depth() + 1);
            transformed(of_mesh(&mesh, FillRule::NonZero), &own, &turned())
        }),
    );
    let mesh = closed.clone();
    add(
        "mesh shifted",
        &[5, 6],
        unit,
        Box::new(move |frame| {
            let by = Affine::translation([frame.cell_size() * 3.0, 0.0, -2.0 * frame.cell_size()]).unwrap();
            transformed(of_mesh(&mesh, FillRule::NonZero), frame, &by)
        }),
    );
    add(
        "plate transformed",
        &[4, 5, 6],
        odd,
        Box::new(move |frame| {
            let own = unit(frame.depth());
            transformed(AnySolid::new(plate()), &own, &turned())
        }),
    );
    let stored = |depth: u8| build(&nested(30), &unit(depth), Rule::Certified, &alone()).unwrap();
    add("stored", &[1, 2, 5, 6], unit, Box::new(move |frame| AnySolid::new(stored(frame.depth()))));
    add("stored coarser", &[3, 4], unit, Box::new(move |frame| AnySolid::new(stored(frame.depth() + 2))));
    add(
        "stored less balls",
        &[5, 6, 7],
        unit,
        Box::new(move |frame| {
            let stored = Csg::solid(AnySolid::new(stored(frame.depth())));
            AnySolid::new(stored.difference(&balls(5, 0.1)).unwrap())
        }),
    );
    add(
        "stored complement",
        &[5, 6],
        unit,
        Box::new(move |frame| AnySolid::new(Csg::solid(AnySolid::new(stored(frame.depth()))).complement())),
    );
    add(
        "stored transformed",
        &[5, 6],
        unit,
        Box::new(move |frame| {
            let own = unit(frame.depth());
            transformed(AnySolid::new(stored(frame.depth())), &own, &turned())
        }),
    );
    for (name, depths) in [
        ("featuretype.STL", &[7, 8][..]),
        ("bunny-closed.stl", &[7, 8]),
        ("multibody.stl", &[6, 7]),
        ("stanford-bunny.obj", &[6]),
    ] {
        let Some(path) = model(name) else { continue };
        let mesh = Arc::new(leafless::exchange::open_mesh(&path, &Default::default()).unwrap().mesh);
        let (min, max) = mesh.bounds();
        all.push(Entry {
            name: name.into(),
            frame: Box::new(move |depth| Frame::around(min, max, depth).unwrap()),
            depths: depths.to_vec(),
            make: Box::new(move |_| of_mesh(&mesh, FillRule::NonZero)),
        });
    }
    all
}

/// Returns the checksum of all tags, cell by cell in depth-first order (FNV-1a).
fn checksum(tree: &Octree) -> u64 {
    fn walk(cursor: &mut Cursor<'_>, sum: &mut u64) {
        let tag = cursor.tag();
        *sum = (*sum ^ tag as u64).wrapping_mul(0x0000_0100_0000_01B3);
        if tag == Tag::Branch {
            for octant in 0..8 {
                assert!(cursor.descend(octant));
                walk(cursor, sum);
                assert!(cursor.ascend());
            }
        }
    }
    let mut sum = 0xCBF2_9CE4_8422_2325;
    walk(&mut Cursor::new(tree.view()), &mut sum);
    sum
}

fn line(entry: &Entry, depth: u8, rule: Rule) -> (String, String) {
    let frame = (entry.frame)(depth);
    let solid = (entry.make)(&frame);
    let key = format!("{} {depth} {rule:?}", entry.name);
    let value = match build(&solid, &frame, rule, &alone()) {
        Ok(tree) => {
            let (full, possible) = tree.statistics().volume_cells();
            format!("{:016x} {full} {}", checksum(&tree), possible - full)
        }
        Err(error) => format!("{error:?}").replace(' ', "_"),
    };
    (key, value)
}

#[test]
fn nothing_is_built_into_anything_else() {
    let golden: BTreeMap<&str, &str> = include_str!("../corpus.txt")
        .lines()
        .filter(|line| !line.starts_with('#'))
        .filter_map(|line| line.split_once(": "))
        .collect();
    let (mut wrong, mut seen) = (String::new(), 0);
    for entry in corpus() {
        for &depth in entry.depths.iter().filter(|&&depth| depth <= repeated(6, u8::MAX)) {
            for rule in RULES {
                let (key, value) = line(&entry, depth, rule);
                let expected = golden.get(&*key).copied().unwrap_or("missing");
                seen += 1;
                if expected.split(" was ").next() != Some(&value) {
                    writeln!(wrong, "{key}: {value}\n    expected {expected}").unwrap();
                }
            }
        }
    }
    assert!(seen > 300);
    if let Some(path) = std::env::var_os("LEAFLESS_CORPUS") {
        std::fs::write(path, &wrong).unwrap();
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}
