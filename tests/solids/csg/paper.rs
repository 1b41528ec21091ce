//! The published classification, as slow as published: all vertices, then all half-spaces.

use super::extremes::{Separable, corners};
use leafless::solid::{HalfSpace, Parts, Touch};
use leafless::{Cell, Classifier, Csg, Frame, Rule, Solid, Tag, Verdict, Worker, build};
use leafless_testkit::exact::Exact;
use leafless_testkit::{Dense, Random, alone, lattice_frame, positions};

/// A primitive in the library's form, and its half-spaces.
#[derive(Clone)]
struct Primitive {
    csg: Csg,
    half_spaces: Vec<Separable>,
}

/// Classifies a cell. A vertex on the surface is inside. If the vertices disagree, the cell is PARTIAL; if
/// they agree, the half-spaces decide.
fn classify(primitive: &Primitive, frame: &Frame, cell: Cell) -> Tag {
    let [x, y, z] = corners(frame, cell);
    let inside = |vertex: usize| {
        let p: [Exact; 3] = [x[vertex & 1].clone(), y[vertex >> 1 & 1].clone(), z[vertex >> 2].clone()];
        primitive.half_spaces.iter().all(|half_space| half_space.value(&p).sign() >= 0)
    };
    let signs = || primitive.half_spaces.iter().map(|half_space| half_space.signs(frame, cell));
    match (0..8).filter(|&vertex| inside(vertex)).count() {
        8 if signs().all(|[least, _]| least >= 0) => Tag::Full,
        0 if signs().any(|[_, most]| most <= 0) => Tag::Empty,
        _ => Tag::Partial,
    }
}

/// Compares all splits above the frame's depth. Returns the tags of the finest cells.
fn compare(primitive: &Primitive, frame: &Frame) -> Dense {
    let csg = primitive.csg.with_touch(Touch::Paper);
    let n = primitive.half_spaces.len() as u64;
    let mut out = Dense::uniform(frame.depth(), Tag::Empty);
    let classifier = csg.on(frame, &alone()).unwrap();
    let mut worker = classifier.worker().unwrap();
    let root = worker.root().unwrap();
    assert_eq!(root.tag(), classify(primitive, frame, Cell::ROOT));
    let mut stack = vec![(Cell::ROOT, root)];
    while let Some((cell, verdict)) = stack.pop() {
        match verdict {
            Verdict::Partial(part) if cell.level < frame.depth() => {
                // A worker for this split alone. Its evaluations are counted when it is dropped.
                let mut single = classifier.worker().unwrap();
                let own = single.hand_over(&worker, &part).unwrap();
                let before = csg.evaluations();
                let again = single.split(cell, &own).unwrap().map(|child| child.tag());
                drop(single);
                let evaluations = csg.evaluations() - before;
                let children = worker.split(cell, &part).unwrap();
                assert_eq!(again, children.each_ref().map(|child| child.tag()));
                // Each of the 27 points at most once, then each half-space for the children whose vertices
                // agree.
                assert!(
                    evaluations >= (n + 2).min(27) && evaluations <= 27 * n + 8 * n,
                    "{evaluations} of {n}"
                );
                for (k, child) in (0..).zip(children) {
                    let expected = classify(primitive, frame, cell.child(k));
                    assert_eq!(child.tag(), expected, "{:?} {:?}", cell.child(k), primitive.half_spaces);
                    stack.push((cell.child(k), child));
                }
            }
            verdict => {
                let edge = 1 << (frame.depth() - cell.level);
                for at in positions(frame.depth() - cell.level) {
                    out.set([0, 1, 2].map(|axis| cell.at[axis] * edge + at[axis]), verdict.tag());
                }
            }
        }
    }
    out
}

/// A random coordinate, a multiple of a quarter of a cell.
fn number(random: &mut Random, n: f64) -> f64 {
    (random.between(-0.2, 1.2) * n * 4.0).round() / 4.0
}

fn coordinate_plane(axis: usize, way: f64, at: f64) -> Separable {
    let mut c = [0.0; 7];
    (c[3 + axis], c[6]) = (way, -way * at);
    Separable::new(c)
}

fn primitive(random: &mut Random, n: f64) -> Primitive {
    let length = |random: &mut Random| number(random, n).abs() + 0.25;
    match random.below(4) {
        0 => {
            let min = [0; 3].map(|_| number(random, n));
            let max = min.map(|c| c + length(random));
            let planes =
                (0..3).flat_map(|a| [coordinate_plane(a, 1.0, min[a]), coordinate_plane(a, -1.0, max[a])]);
            Primitive { csg: Csg::cuboid(min, max).unwrap(), half_spaces: planes.collect() }
        }
        1 => {
            let [x, y, z] = [0; 3].map(|_| number(random, n));
            let r = length(random);
            let constant = r * r - x * x - y * y - z * z;
            let ball = Separable::new([-1.0, -1.0, -1.0, 2.0 * x, 2.0 * y, 2.0 * z, constant]);
            Primitive { csg: Csg::ball([x, y, z], r).unwrap(), half_spaces: vec![ball] }
        }
        2 => {
            let (r, low) = (length(random), number(random, n));
            let high = low + length(random);
            // r z + s = 0 at one end of a cone, and the whole times the square of the height.
            let height = high - low;
            let (slope, offset) = (r, -r * low);
            let square = -height * height;
            let cone = [square, square, slope * slope, 0.0, 0.0, 2.0 * slope * offset, offset * offset];
            let half_spaces =
                vec![Separable::new(cone), coordinate_plane(2, 1.0, low), coordinate_plane(2, -1.0, high)];
            Primitive { csg: Csg::frustum(0.0, r, low, high).unwrap(), half_spaces }
        }
        _ => {
            let mut parts = Vec::new();
            let half_spaces = (0..1 + random.below(5)).map(|_| {
                let p = [0; 3].map(|_| number(random, n));
                let mut c = [0; 7].map(|_| random.below(5) as f64 - 2.0);
                if random.below(2) == 0 {
                    c[..3].fill(0.0);
                }
                c[3] += (c[..6] == [0.0; 6]) as u8 as f64;
                c[6] = -(0..3).map(|a| (c[a] * p[a] + c[3 + a]) * p[a]).sum::<f64>();
                let [a, b, d, e, f, g, h] = c;
                parts.push(HalfSpace::quadric([a, b, d, 0.0, 0.0, 0.0, e, f, g, h]).unwrap().into());
                Separable::new(c)
            });
            let half_spaces = half_spaces.collect();
            Primitive { csg: Csg::intersection_of(parts).unwrap(), half_spaces }
        }
    }
}

#[test]
fn primitives_are_classified_as_published() {
    for seed in 0..120 {
        let mut random = Random(seed);
        let frame = lattice_frame(1 + random.below(4) as u8);
        let primitive = primitive(&mut random, frame.cells() as f64);
        let dense = compare(&primitive, &frame);
        let paper = primitive.csg.with_touch(Touch::Paper);
        assert!(Dense::of(build(&paper, &frame, Rule::Certified, &alone()).unwrap().view()) == dense);
        let other = build(&paper.complement().with_touch(Touch::Paper), &frame, Rule::Certified, &alone());
        assert!(Dense::of(other.unwrap().view()) == dense.complement());
        // Cells with mere contact are PARTIAL as published, and EMPTY otherwise. Nothing else differs.
        let exact = Dense::of(build(&primitive.csg, &frame, Rule::Certified, &alone()).unwrap().view());
        let sharper = exact.tags.iter().zip(&dense.tags).all(|(&e, &p)| p == Tag::Partial || p == e);
        assert!(sharper, "{:?}", primitive.half_spaces);
    }
}

#[test]
fn expressions_of_published_primitives_are_set_operations() {
    type Operation = (fn(Csg, Csg) -> Csg, fn(bool, bool) -> bool);
    let operations: [Operation; 4] = [
        (|a, b| Csg::union_of([a, b]).unwrap(), |a, b| a | b),
        (|a, b| Csg::intersection_of([a, b]).unwrap(), |a, b| a & b),
        (|a, b| a.difference(&b).unwrap(), |a, b| a & !b),
        (|a, b| Csg::xor_of([a, b]).unwrap(), |a, b| a ^ b),
    ];
    for seed in 0..60 {
        let mut random = Random(seed ^ 0xFACE);
        let frame = lattice_frame(1 + random.below(4) as u8);
        let mut make = || primitive(&mut random, frame.cells() as f64);
        let [a, b, c] = [make(), make(), make()];
        let [da, db, dc] = [&a, &b, &c].map(|p| compare(p, &frame));
        for (join, op) in operations {
            for (outer, outer_op) in operations {
                // Two half-spaces alone would be a primitive together.
                let csg = outer(join(a.csg.clone(), b.csg.clone()), c.csg.clone());
                let single = [&a, &b].iter().all(|p| p.half_spaces.len() == 1);
                if single && op(true, true) && !op(true, false) {
                    continue;
                }
                let csg = csg.with_touch(Touch::Paper);
                let tree = build(&csg, &frame, Rule::Certified, &alone()).unwrap();
                assert!(Dense::of(tree.view()) == da.combine(&db, op).combine(&dc, outer_op), "{seed}");
            }
        }
    }
}
