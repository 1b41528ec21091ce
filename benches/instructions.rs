//! Instructions of typical work on one thread, counted by callgrind and compared with the recorded counts.
//!
//! ```text
//! cargo bench --bench instructions               # prints each count beside the recorded one
//! cargo bench --bench instructions -- ray        # only workloads whose names contain "ray"
//! cargo bench --bench instructions -- --record   # writes the counts to benches/instructions.txt
//! ```
//!
//! Callgrind simulates a processor, so that a count is the same on a busy machine. Counts depend on the
//! compiler and on the instructions that the processor offers. A workload that needs 3 % more instructions
//! than recorded makes the program fail: the loss is mended, or recorded with its reason in the changelog.
//!
//! Callgrind collects inside of [`counted`] only. Operands are made before.

use leafless::op::DexelOptions;
use leafless::query::{DistanceTo, Obstacle, distances, interference_at};
use leafless::surface::{boundary, contour};
use leafless::{
    Affine, Control, Csg, FillRule, Frame, Membership, MeshSolid, Octree, Ray, Rule, Solid, SurfaceOptions,
    TriangleMesh, bounding_box, build, build_extended, cast_rays, clearance, contains, dexelize, difference,
    file, interference, marching_cubes, measure, union,
};
use std::collections::BTreeMap;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// A workload makes its operands and returns the work to count.
type Workload = fn() -> Box<dyn FnOnce()>;

const WORKLOADS: [(&str, Workload); 24] = [
    ("build: plate of half-spaces", || build_of(plate(), Rule::Certified)),
    ("build: mesh, certified", || build_of(torus(0.0), Rule::Certified)),
    ("build: mesh, sampled", || build_of(torus(0.0), Rule::Sampled)),
    ("build: plate with surfaces", || {
        let (plate, frame) = (plate(), fine());
        work(move || build_extended(&plate, &frame, &SurfaceOptions::default(), &one()))
    }),
    ("build: plate as tri-dexels", || {
        let plate = plate();
        work(move || dexelize(&plate, &frame(), &DexelOptions::default(), &one()))
    }),
    ("union of two octrees", || {
        let (a, b) = (stored(&torus(0.0)), stored(&torus(0.3)));
        work(move || union(a.view(), b.view(), &one()))
    }),
    ("twenty bores into an octree with surfaces", || {
        let bores: Vec<Octree> = (0..20).map(|k| extended(&bore(k))).collect();
        let block = extended(&block());
        work(move || {
            bores.iter().fold(block, |part, bore| difference(part.view(), bore.view(), &one()).unwrap())
        })
    }),
    ("points in an octree, one by one", || {
        let (tree, points) = (stored(&torus(0.0)), points(20_000));
        work(move || points.iter().filter(|&&point| tree.contains(point) == Membership::Inside).count())
    }),
    ("points in an octree, in a batch", || {
        let (tree, points) = (stored(&torus(0.0)), points(20_000));
        work(move || {
            let mut answers = vec![Membership::Undecided; points.len()];
            tree.contains_many(&points, &mut answers).unwrap();
            answers
        })
    }),
    ("points in a plate of half-spaces", || points_in(plate())),
    ("points in a mesh", || points_in(torus(0.0))),
    ("rays to an octree", || rays_to(stored(&torus(0.0)))),
    ("rays to a plate of half-spaces", || rays_to(plate())),
    ("rays to a mesh", || rays_to(torus(0.0))),
    ("distances from a plate of half-spaces", || {
        let (plate, points) = (plate(), points(100));
        work(move || distances(&plate, &fine(), &points, DistanceTo::Boundary, 1e-6, &one()))
    }),
    ("clearance of two meshes", || {
        let (a, b) = (torus(0.0), torus(2.9));
        work(move || clearance(&a, &b, &frame(), 1e-6, &one()))
    }),
    ("interference of half-spaces and a mesh", || {
        let (a, b) = (plate(), torus(0.0));
        work(move || interference(&a, &b, &frame(), 1e-2, &one()))
    }),
    ("interference of two octrees, a thousand poses", || {
        let (a, b) = (stored(&torus(0.0)), stored(&torus(0.0)));
        let moved = |k| Affine::new([[0.8, -0.6, 0.0, 1e-3 * k], [0.6, 0.8, 0.0, 2.0], [0.0, 0.0, 1.0, 0.5]]);
        let poses: Vec<Affine> = (0..1000).map(|k| moved(f64::from(k)).unwrap()).collect();
        work(move || interference_at(&a, &b, &frame(), &poses, &frame(), f64::INFINITY, &one()))
    }),
    ("measure: plate of half-spaces", || {
        let plate = plate();
        work(move || measure(&plate, &fine(), 1e-6, &one()))
    }),
    ("bounding box of a turned plate", || {
        let turn = Affine::new([[0.6, -0.8, 0.0, 0.0], [0.8, 0.6, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]).unwrap();
        let plate = plate().placed(&turn).unwrap();
        work(move || bounding_box(&plate, &fine(), 1e-9, &one()))
    }),
    ("mesh out: marching cubes of an octree", || {
        let tree = build(&torus(0.0), &frame(), Rule::Sampled, &one()).unwrap();
        work(move || marching_cubes(tree.view(), None, &one()))
    }),
    ("mesh out: boundary of a plate", || {
        let plate = plate();
        work(move || boundary(&plate, &fine(), 0.01, &one()))
    }),
    ("mesh out: contour of a plate", || {
        let plate = plate();
        work(move || contour(&plate, &frame().with_depth(6).unwrap(), 0.05, &one()))
    }),
    ("file: write, read and verify", || {
        let tree = stored(&torus(0.0));
        work(move || {
            let bytes = file::to_bytes(&tree).unwrap();
            file::verify(&bytes).unwrap();
            file::from_bytes(&bytes)
        })
    }),
];

/// The share of additional instructions that is still accepted.
const TOLERANCE: f64 = 0.03;

// ---- operands ------------------------------------------------------------------------------------------

fn one() -> Control<'static> {
    Control::threads(1)
}

/// The universe of all workloads, in 256 cells to an axis.
fn frame() -> Frame {
    Frame::new([-4.0; 3], 8.0, 8).unwrap()
}

fn fine() -> Frame {
    frame().with_depth(20).unwrap()
}

fn block() -> Csg {
    Csg::cuboid([-2.9, -2.1, -0.4], [2.9, 2.1, 0.4]).unwrap()
}

fn bore(k: u32) -> Csg {
    let to = [-2.4 + 1.2 * f64::from(k % 5), -1.5 + f64::from(k / 5), 0.0];
    Csg::cylinder(0.21, -1.0, 1.0).unwrap().placed(&Affine::translation(to).unwrap()).unwrap()
}

/// A plate with twenty bores.
fn plate() -> Csg {
    block().difference(&Csg::union_of((0..20).map(bore)).unwrap()).unwrap()
}

/// A closed mesh of 9216 triangles, moved along x.
fn torus(x: f64) -> MeshSolid {
    const N: u32 = 96;
    const M: u32 = 48;
    let at = |i: u32, j: u32| {
        let (u, v) = ([i, N], [j, M]);
        let turn = |[k, n]: [u32; 2]| f64::from(k) / f64::from(n) * std::f64::consts::TAU;
        let ring = 1.0 + 0.37 * turn(v).cos();
        [x + ring * turn(u).cos(), ring * turn(u).sin() + 0.01, 0.37 * turn(v).sin()]
    };
    let vertices = (0..N).flat_map(|i| (0..M).map(move |j| at(i, j))).collect();
    let index = |i: u32, j: u32| (i % N) * M + j % M;
    let squares = (0..N).flat_map(|i| (0..M).map(move |j| (i, j)));
    let triangles = squares.flat_map(|(i, j)| {
        let [a, b, c, d] = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    let mesh = TriangleMesh::new(vertices, triangles.collect()).unwrap();
    MeshSolid::new(mesh, FillRule::NonZero).unwrap()
}

fn stored(solid: &MeshSolid) -> Octree {
    build(solid, &frame(), Rule::Certified, &one()).unwrap()
}

fn extended(solid: &Csg) -> Octree {
    build_extended(solid, &fine(), &SurfaceOptions::default(), &one()).unwrap()
}

/// Points in the middle of the universe, always the same.
fn points(count: usize) -> Vec<[f64; 3]> {
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        3.0 * ((state >> 11) as f64 / (1u64 << 52) as f64 - 1.0)
    };
    (0..count).map(|_| [next(), next(), 0.3 * next()]).collect()
}

// ---- work ----------------------------------------------------------------------------------------------

/// The work, whose result is not optimised away.
fn work<T>(work: impl FnOnce() -> T + 'static) -> Box<dyn FnOnce()> {
    Box::new(|| {
        black_box(work());
    })
}

fn build_of(solid: impl Solid + 'static, rule: Rule) -> Box<dyn FnOnce()> {
    work(move || build(&solid, &frame(), rule, &one()).unwrap())
}

fn points_in(solid: impl Solid + 'static) -> Box<dyn FnOnce()> {
    let points = points(1000);
    work(move || {
        let mut answers = vec![Membership::Undecided; points.len()];
        contains(&solid, &fine(), &points, &mut answers, &one()).unwrap();
        answers
    })
}

fn rays_to(solid: impl Solid + 'static) -> Box<dyn FnOnce()> {
    let ends = points(2000);
    let rays: Vec<Ray> = ends.chunks(2).map(|ends| Ray::between(ends[0], ends[1]).unwrap()).collect();
    work(move || cast_rays(&solid, &frame(), &rays, Obstacle::Full, &one()).unwrap())
}

/// Callgrind knows the function by its name, so that it must stay a function.
#[inline(never)]
fn counted(work: Box<dyn FnOnce()>) {
    work();
    black_box(());
}

// ---- counting ------------------------------------------------------------------------------------------

/// Runs one workload under callgrind. Returns the number of instructions.
fn count(number: usize, folder: &Path) -> u64 {
    let out = folder.join(number.to_string());
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--collect-atstart=no", "--toggle-collect=*instructions*counted*"])
        .arg(format!("--callgrind-out-file={}", out.display()))
        .arg(std::env::current_exe().expect("a program has a path"))
        .args(["--workload", &number.to_string()])
        .output()
        .unwrap_or_else(|error| panic!("valgrind cannot be run: {error}"));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = std::fs::read_to_string(&out).expect("callgrind's file");
    let summary =
        text.lines().find_map(|line| line.strip_prefix("totals: ").or(line.strip_prefix("summary: ")));
    summary.and_then(|count| count.trim().parse().ok()).expect("a count in callgrind's file")
}

fn record() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("instructions.txt")
}

/// The recorded counts by name. A line is a count and a name.
fn recorded() -> BTreeMap<String, u64> {
    let text = std::fs::read_to_string(record()).unwrap_or_default();
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines.filter_map(|line| line.trim().split_once(' ')).fold(BTreeMap::new(), |mut all, (count, name)| {
        all.insert(name.to_string(), count.parse().expect("a line has a count and a name"));
        all
    })
}

fn main() -> ExitCode {
    let mut arguments: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    if arguments.first().is_some_and(|word| word == "--workload") {
        let (_, make) = WORKLOADS[arguments[1].parse::<usize>().expect("a number of a workload")];
        counted(make());
        return ExitCode::SUCCESS;
    }
    let records = arguments.iter().any(|word| word == "--record");
    arguments.retain(|word| !word.starts_with("--"));
    let folder = tempfile::tempdir().expect("a folder for callgrind's files");
    let mut all = recorded();
    let mut worse = Vec::new();
    println!("{:>15}  {:>15}  {:>7}  workload", "instructions", "recorded", "change");
    for (number, (name, _)) in WORKLOADS.iter().enumerate() {
        if !arguments.is_empty() && !arguments.iter().any(|word| name.contains(word.as_str())) {
            continue;
        }
        let now = count(number, folder.path());
        let before = all.insert(name.to_string(), now);
        let change = before.map(|before| now as f64 / before as f64 - 1.0);
        let percent = change.map_or("new".into(), |change| format!("{:+.2} %", 100.0 * change));
        println!("{now:>15}  {:>15}  {percent:>7}  {name}", before.map_or(String::new(), |n| n.to_string()));
        if change.is_none_or(|change| change > TOLERANCE) {
            worse.push(*name);
        }
    }
    if records {
        let lines = all.iter().filter(|(name, _)| WORKLOADS.iter().any(|(own, _)| own == name));
        let head = "# Instructions on one thread, by `cargo bench --bench instructions -- --record`.\n";
        let text: String = lines.map(|(name, count)| format!("{count:>12} {name}\n")).collect();
        std::fs::write(record(), head.to_string() + &text).expect("the counts can be written");
        return ExitCode::SUCCESS;
    }
    if worse.is_empty() {
        return ExitCode::SUCCESS;
    }
    eprintln!("more than {} % above the record, or not recorded: {}", 100.0 * TOLERANCE, worse.join("; "));
    ExitCode::FAILURE
}
