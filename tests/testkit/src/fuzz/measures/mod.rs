//! Any bytes as solids of unit cells, made in all ways that make solids, and as queries about them under
//! changing budgets. Every answer must be true of the cells, counted in integers (`dense.rs`).

mod ask;
mod dense;

use super::Bytes;
use dense::{Dense, LOW, N};
use leafless::op::Zone;
use leafless::solid::{Adaptive, Band, SampleArray, Samples, SplitCounter, Transform, VoxelGrid};
use leafless::voxel::{VoxelOptions, VoxelRecords};
use leafless::{
    Affine, AnySolid, Callback, Control, Csg, Error, FillRule, Frame, LazyOctree, MeshSolid, Octree, Rule,
    Tag, TriangleMesh, Verdict, Volume, build, complement, difference, intersection, union, xor,
};
use std::sync::Arc;

impl Bytes<'_> {
    /// Returns a budget of splits: unlimited, one, two, three …, a few dozen, many.
    fn budget(&mut self) -> Option<u64> {
        match self.byte() {
            code @ 0..64 => Some(code as u64 % 8),
            code @ 64..128 => Some(code as u64 - 56),
            code @ 128..192 => Some(8 * (code as u64 - 120)),
            _ => Some(1 << 14),
        }
    }

    fn tolerance(&mut self) -> f64 {
        [0.0, 0.0, 0.25, 1.0, 10.0, 1e-9, 0.01, f64::INFINITY][self.below(8)]
    }
}

/// Limits work to one thread and a number of splits.
fn control(max_splits: Option<u64>) -> Control<'static> {
    Control { threads: 1, max_splits, ..Control::default() }
}

/// A solid, and its unit cells.
#[derive(Clone)]
pub struct Scene {
    solid: AnySolid,
    truth: Dense,
}

/// The most steps of a scene, and the most queries.
const MOST: usize = 12;

/// Runs the fuzz target.
pub fn measures(data: &[u8]) {
    let mut bytes = Bytes(data);
    let frame = frame(bytes.byte());
    let steps = bytes.below(MOST);
    let mut stack = Vec::new();
    for _ in 0..steps {
        step(&mut bytes, &frame, &mut stack);
    }
    let mut pop = |bytes: &mut Bytes<'_>| stack.pop().unwrap_or_else(|| cuboid(bytes));
    let (a, b) = (pop(&mut bytes), pop(&mut bytes));
    for _ in 0..MOST {
        if bytes.0.is_empty() {
            break;
        }
        ask::ask(&mut bytes, &frame, &a, &b);
    }
}

/// A universe with integer, half or quarter coordinates. Its cells are coarser or finer than the unit cells
/// or of the same size. Some universes cut the world off.
fn frame(code: usize) -> Frame {
    let (origin, edge, depth) = match code % 12 {
        0 | 1 => ([0.0; 3], 16.0, 4),
        2 => ([0.0; 3], 16.0, 3),
        3 => ([4.0; 3], 8.0, 3),
        4 => ([4.0, 3.0, 0.0], 8.0, 4),
        5 => ([-8.0; 3], 32.0, 5),
        6 => ([-8.0; 3], 32.0, 2),
        7 => ([0.5; 3], 8.0, 3),
        8 => ([-2.5, 0.0, 1.25], 16.0, 4),
        9 => ([7.0; 3], 2.0, 3),
        10 => ([-0.1; 3], 17.3, 4),
        _ => ([-8.0; 3], 32.0, 1),
    };
    Frame::new(origin, edge, depth).expect("a good frame")
}

/// Returns the corners of a frame.
fn universe(frame: &Frame) -> [[f64; 3]; 2] {
    [frame.origin(), frame.origin().map(|c| c + frame.edge())]
}

fn corners(bytes: &mut Bytes<'_>) -> ([i32; 3], [i32; 3]) {
    let min = [0; 3].map(|_: i32| bytes.below(15) as i32);
    (min, min.map(|low| (low + 1 + bytes.below(8) as i32).min(16)))
}

fn doubles(at: [i32; 3]) -> [f64; 3] {
    at.map(f64::from)
}

fn cuboid(bytes: &mut Bytes<'_>) -> Scene {
    let (min, max) = corners(bytes);
    let solid = Csg::cuboid(doubles(min), doubles(max)).expect("a good box");
    Scene { solid: AnySolid::new(solid), truth: Dense::cuboid(min, max) }
}

/// Pushes a primitive, or a solid made from earlier ones.
fn step(bytes: &mut Bytes<'_>, frame: &Frame, stack: &mut Vec<Scene>) {
    let code = bytes.byte();
    let scene = match code % 24 {
        0..=3 => Some(cuboid(bytes)),
        4 => boxes_as_a_mesh(bytes),
        5 => {
            let (axis, at) = (bytes.below(3), bytes.below(17) as i32);
            let (mut normal, mut max) = ([0.0; 3], [LOW + N; 3]);
            (normal[axis], max[axis]) = (-1.0, at);
            // A half-space is unbounded, but the world's outermost cells equal the space around it.
            let solid = Csg::half_space(normal, f64::from(at)).expect("a good plane");
            let wide = Csg::cuboid([f64::from(LOW + 1); 3], [f64::from(LOW + N - 1); 3]).expect("a good box");
            let solid = Csg::intersection_of([solid, wide]).expect("enough memory");
            let max = max.map(|c| c.min(LOW + N - 1));
            Some(Scene { solid: AnySolid::new(solid), truth: Dense::cuboid([LOW + 1; 3], max) })
        }
        6..=13 => {
            let (second, first) =
                (stack.pop().unwrap_or_else(|| cuboid(bytes)), stack.pop().unwrap_or_else(|| cuboid(bytes)));
            Some(joined(code % 24 - 6, frame, &first, &second))
        }
        14 => stack.last().cloned(),
        15 => {
            let scene = stack.pop().unwrap_or_else(|| cuboid(bytes));
            let solid = AnySolid::new(Csg::solid(scene.solid).complement());
            Some(Scene { solid, truth: scene.truth.complement() })
        }
        16 | 17 => {
            let scene = stack.pop().unwrap_or_else(|| cuboid(bytes));
            Some(moved(bytes, frame, scene))
        }
        _ => {
            let scene = stack.pop().unwrap_or_else(|| cuboid(bytes));
            Some(made(code % 24 - 18, bytes, frame, scene))
        }
    };
    stack.extend(scene);
}

/// Two boxes in one mesh. They may overlap or share faces, and the second may be inside out.
fn boxes_as_a_mesh(bytes: &mut Bytes<'_>) -> Option<Scene> {
    let [first, second] = [corners(bytes), corners(bytes)];
    let code = bytes.byte();
    let turned = code & 1 != 0;
    let rule = [FillRule::NonZero, FillRule::EvenOdd, FillRule::Positive][code / 2 % 3];
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for (k, (min, max)) in [first, second].into_iter().enumerate() {
        let start = vertices.len() as u32;
        vertices.extend(
            (0..8).map(|k| doubles([0, 1, 2].map(|a| if k >> a & 1 == 0 { min[a] } else { max[a] }))),
        );
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        for [a, b, c, d] in quads.map(|quad| quad.map(|corner: u32| start + corner)) {
            let both = [[a, b, c], [a, c, d]];
            triangles.extend(both.map(|[a, b, c]| if turned && k == 1 { [a, c, b] } else { [a, b, c] }));
        }
    }
    let [a, b] = [first, second].map(|(min, max)| Dense::cuboid(min, max));
    let truth = a.joined(&b, |a, b| match rule {
        FillRule::EvenOdd => a != b,
        FillRule::NonZero if turned => a != b,
        FillRule::Positive if turned => a && !b,
        _ => a || b,
    });
    let mesh = TriangleMesh::new(vertices, triangles).expect("a good mesh");
    Some(Scene { solid: AnySolid::new(MeshSolid::new(mesh, rule).ok()?), truth })
}

/// A set operation on expressions or on stored octrees.
fn joined(code: usize, frame: &Frame, a: &Scene, b: &Scene) -> Scene {
    type Join = fn(bool, bool) -> bool;
    let joins: [Join; 4] = [|a, b| a || b, |a, b| a && b, |a, b| a && !b, |a, b| a != b];
    let truth = a.truth.joined(&b.truth, joins[code % 4]);
    let solid = if code < 4 {
        let [a, b] = [a, b].map(|scene| Csg::solid(scene.solid.clone()));
        let joined = match code {
            0 => Csg::union_of([a, b]),
            1 => Csg::intersection_of([a, b]),
            2 => a.difference(&b),
            _ => Csg::xor_of([a, b]),
        };
        AnySolid::new(joined.expect("enough memory"))
    } else {
        let control = control(None);
        let [a, b] = [a, b].map(|scene| {
            build(&scene.solid, frame, Rule::Certified, &control).expect("the solid can be built")
        });
        let operation = [union, intersection, difference, xor][code % 4];
        AnySolid::new(operation(a.view(), b.view(), &control).expect("enough memory"))
    };
    Scene { solid, truth }
}

/// Applies a symmetry of the lattice and a translation, in one of the ways to move solids.
fn moved(bytes: &mut Bytes<'_>, frame: &Frame, scene: Scene) -> Scene {
    let (code, way) = (bytes.byte(), bytes.byte());
    let axes = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]][code % 6];
    let mirrored = [0, 1, 2].map(|axis| (code / 6) >> axis & 1 != 0);
    let by = [0; 3].map(|_: i32| if way & 128 != 0 { bytes.below(9) as i32 - 4 } else { 0 });
    let Some(truth) = scene.truth.moved(axes, mirrored, by) else { return scene };
    let mut rows = [[0.0; 4]; 3];
    for (axis, row) in rows.iter_mut().enumerate() {
        row[axes[axis]] = if mirrored[axis] { -1.0 } else { 1.0 };
        row[3] = f64::from(by[axis] + if mirrored[axis] { 2 * LOW + N } else { 0 });
    }
    let placement = Affine::new(rows).expect("a good map");
    let solid = match way % 4 {
        0 => scene.solid.placed(&placement).expect("it can be moved"),
        1 => AnySolid::new(Csg::solid(scene.solid).placed(&placement).expect("it can be moved")),
        2 => AnySolid::new(Transform::of(scene.solid, &placement)),
        // Parts outside its own frame are unknown.
        _ => AnySolid::new(Transform::new(scene.solid, frame, &placement)),
    };
    Scene { solid, truth }
}

/// Returns the same solid in another form.
fn made(code: usize, bytes: &mut Bytes<'_>, frame: &Frame, scene: Scene) -> Scene {
    let solid = match code {
        0 => {
            let rule = [Rule::Certified, Rule::Sampled, Rule::Inner, Rule::Outer][bytes.below(4)];
            stored(&scene, frame, rule).map(AnySolid::new)
        }
        1 => {
            let tolerance = [0.0, 0.1, 1.0, 100.0][bytes.below(4)];
            Some(AnySolid::new(Adaptive::new(scene.solid.clone(), tolerance).expect("a good tolerance")))
        }
        2 => Some(AnySolid::new(refined(bytes, frame, &scene))),
        3 => as_an_array(bytes, &scene.truth),
        4 => as_a_function(bytes, &scene.truth),
        _ => match bytes.below(4) {
            0 => Some(AnySolid::new(SplitCounter::new(scene.solid.clone()))),
            1 => as_records(frame, &scene),
            2 => {
                let tree =
                    build(&scene.solid, frame, Rule::Certified, &control(None)).expect("it can be built");
                let twice = |tree: &Octree| complement(tree.view(), &control(None)).expect("enough memory");
                Some(AnySolid::new(twice(&twice(&tree))))
            }
            _ => as_a_mesh(&scene.truth),
        },
    };
    Scene { solid: solid.unwrap_or(scene.solid), truth: scene.truth }
}

/// Builds a stored octree. Its volume is the one that its rule requires.
fn stored(scene: &Scene, frame: &Frame, rule: Rule) -> Option<Octree> {
    let tree = match build(&scene.solid, frame, rule, &control(None)) {
        Err(Error::NotSampled) => return None,
        tree => tree.expect("it can be built"),
    };
    tree.view().check().expect("what was built is sound");
    let volume = tree.statistics().volume();
    let truth = scene.truth.volume(universe(frame));
    let slack = 1e-12 * truth;
    assert!(!tree.proof().full || volume.lower <= truth + slack, "{rule:?}: {volume:?}, {truth}");
    assert!(!tree.proof().empty || truth - slack <= volume.upper, "{rule:?}: {volume:?}, {truth}");
    Some(tree)
}

/// Builds an octree that is refined on demand within budgets.
fn refined(bytes: &mut Bytes<'_>, frame: &Frame, scene: &Scene) -> Octree {
    let mut lazy = LazyOctree::new(scene.solid.clone(), frame).expect("it can be had");
    for _ in 0..bytes.below(3) {
        let zone = match bytes.below(3) {
            0 => Zone::Whole,
            1 => Zone::Point([bytes.below(33), bytes.below(33), bytes.below(33)].map(|c| c as f64 / 2.0)),
            _ => {
                let (min, max) = corners(bytes);
                Zone::Box { min: doubles(min), max: doubles(max) }
            }
        };
        let budget = bytes.budget();
        lazy.refine(&zone, frame.depth(), &control(budget)).expect("it can be refined");
    }
    let tree = lazy.freeze(&control(None)).expect("enough memory");
    tree.view().check().expect("what was frozen is sound");
    tree
}

/// Returns the unit cells as the voxels of a volume.
fn as_an_array(bytes: &mut Bytes<'_>, truth: &Dense) -> Option<AnySolid> {
    if truth.outside {
        return None;
    }
    let grid = VoxelGrid::new([N as u32; 3], [f64::from(LOW); 3], [1.0; 3]).expect("a good grid");
    let bits = truth.bits();
    let (samples, band) = match bytes.below(5) {
        0 => (bits.iter().map(|&bit| u8::from(bit)).collect::<Vec<_>>().into(), Band::at_least(1.0)),
        1 => (
            bits.iter().map(|&bit| if bit { -3i16 } else { 7 }).collect::<Vec<_>>().into(),
            Band::at_most(-3.0),
        ),
        2 => {
            let value = |bit: bool| if bit { 0.5f32 } else { f32::NAN };
            (bits.iter().map(|&bit| value(bit)).collect::<Vec<_>>().into(), Band::between(0.5, f64::INFINITY))
        }
        3 => {
            let value = |bit: bool| if bit { 9u16 } else { 65535 };
            (bits.iter().map(|&bit| value(bit)).collect::<Vec<_>>().into(), Band::between(9.0, 9.0))
        }
        _ => {
            let word = |row: &[bool]| row.iter().rev().fold(0, |word: u64, &bit| word << 1 | u64::from(bit));
            let words: Vec<u64> = bits.chunks(N as usize).map(word).collect();
            (Samples::Bits(SampleArray::from(words)), Band::at_least(1.0))
        }
    };
    let volume = Volume::new(samples, &grid, band.ok()?, &control(None)).expect("enough memory");
    Some(AnySolid::new(volume))
}

/// Returns the unit cells as a host program's function, which may be lazy.
fn as_a_function(bytes: &mut Bytes<'_>, truth: &Dense) -> Option<AnySolid> {
    let (truth, lazy) = (Arc::new(truth.clone()), bytes.below(2) != 0);
    let classified = truth.clone();
    let callback = Callback::new(move |min: [f64; 3], max: [f64; 3]| {
        Ok(match classified.in_box(min, max) {
            _ if lazy && max[0] - min[0] > 3.0 => Verdict::Partial(()),
            (false, _) => Verdict::Empty,
            (_, true) => Verdict::Full,
            _ => Verdict::Partial(()),
        })
    });
    Some(match bytes.below(2) {
        0 => AnySolid::new(callback),
        _ => AnySolid::new(callback.with_contains(move |point| Ok(truth.at(point).0))),
    })
}

/// Returns an octree by way of its voxel records, as a solid.
fn as_records(frame: &Frame, scene: &Scene) -> Option<AnySolid> {
    let tree = build(&scene.solid, frame, Rule::Certified, &control(None)).expect("it can be built");
    let records = VoxelRecords::of(tree.view(), &VoxelOptions::new(), None, &control(None)).ok()?;
    let octree = records.view().to_octree(Tag::Partial, &control(None)).expect("the records are good");
    Some(AnySolid::new(octree))
}

/// Returns the boundary as a mesh, with two triangles for each face. An edge may belong to four triangles.
fn as_a_mesh(truth: &Dense) -> Option<AnySolid> {
    if truth.outside {
        return None;
    }
    let (vertices, triangles) = truth.triangles();
    let mesh = TriangleMesh::new(vertices, triangles).ok()?;
    Some(AnySolid::new(MeshSolid::new(mesh, FillRule::NonZero).ok()?))
}
