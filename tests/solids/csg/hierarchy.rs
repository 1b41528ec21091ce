//! Operations with many operands, grouped by place, against trees that are combined one by one.

use leafless::op::{intersection_of, union_of, xor_of};
use leafless::{Affine, Csg, Frame, Octree, Rule, Tag, build, complement, intersection, union, xor};
use leafless_testkit::{Dense, Random, alone};

const RULES: [Rule; 4] = [Rule::Certified, Rule::Inner, Rule::Outer, Rule::Sampled];

/// A way to combine the operands.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    Union,
    IntersectionOfComplements,
    Parity,
}

/// A random operand. The bounding box of a `plain` operand excludes no more than its half-spaces do; there
/// the hierarchy decides no more than single operands.
fn operand(random: &mut Random, frame: &Frame, special: u64, plain: bool) -> Csg {
    let edge = frame.edge();
    let length = |random: &mut Random, low: f64, high: f64| random.between(low, high) * edge;
    // From the frame's cells down to a tenth of them, or up to a third of the universe.
    let size = |random: &mut Random| match random.below(4) {
        0 => random.between(0.1, 1.0) * frame.cell_size(),
        1 => length(random, 0.1, 0.3),
        _ => length(random, 0.01, 0.12),
    };
    let place = |random: &mut Random| {
        let beyond = random.below(12) == 0;
        [0, 1, 2].map(|axis| {
            let at = if beyond { random.between(1.5, 3.0) } else { random.between(-0.1, 1.1) };
            frame.origin()[axis] + at * edge
        })
    };
    let ball = |random: &mut Random| {
        let centre = place(random);
        Csg::ball(centre, size(random)).unwrap()
    };
    let cuboid = |random: &mut Random| {
        let min = place(random);
        Csg::cuboid(min, min.map(|c| c + size(random))).unwrap()
    };
    let any = |random: &mut Random| if random.below(2) == 0 { ball(random) } else { cuboid(random) };
    match random.below(16) {
        0..8 => any(random),
        8 | 9 if plain => {
            // Mirrored, and longer.
            let k = if random.below(2) == 0 { -1.0 } else { 2.0 };
            let rows = [[0.0, 1.0, 0.0, 0.1 * edge], [k, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, -0.05 * edge]];
            any(random).placed(&Affine::new(rows).unwrap()).unwrap()
        }
        8 | 9 => {
            // Rotated about its place, approximately.
            let part = Csg::cuboid([-0.5; 3], [0.5, 0.4, 0.3]).unwrap();
            let (s, c) = random.between(0.0, 6.0).sin_cos();
            let k = size(random);
            let [x, y, z] = place(random);
            let rows = [[k * c, -k * s, 0.0, x], [k * s, k * c, 0.0, y], [0.0, 0.0, k, z]];
            part.placed(&Affine::new(rows).unwrap()).unwrap()
        }
        10 => {
            let offset = [0; 3].map(|_| length(random, -0.2, 0.2));
            any(random).placed(&Affine::translation(offset).unwrap()).unwrap()
        }
        11 => Csg::union_of([any(random), any(random), any(random)]).unwrap(),
        12 => any(random).difference(&any(random)).unwrap(),
        13 if !plain => Csg::intersection_of([any(random), any(random)]).unwrap(),
        13 | 14 => match random.below(3) {
            0 => Csg::empty(),
            1 => Csg::union_of((0..20).map(|_| any(random))).unwrap(),
            _ => Csg::xor_of([any(random), any(random)]).unwrap(),
        },
        // Operands that cover the universe, or all but a part of it.
        _ if special == 0 => Csg::ball(frame.origin().map(|c| c + 0.5 * edge), 2.0 * edge).unwrap(),
        _ if special == 1 => any(random).complement(),
        _ if special == 2 => Csg::half_space([0.3, 0.5, 1.0], -length(random, 0.0, 1.0)).unwrap(),
        _ => any(random),
    }
}

fn dense(tree: &Octree) -> Dense {
    Dense::of(tree.view())
}

#[test]
fn many_operands_are_joined_as_trees_are() {
    let mut cells = [0; 2];
    for seed in 0..36 {
        let mut random = Random(seed ^ 0x61E2A);
        let depth = 1 + (seed % 6) as u8;
        let frame = match random.below(3) {
            0 => Frame::new([0.0; 3], (1u32 << depth) as f64, depth),
            1 => Frame::new([-1.0; 3], 2.0, depth),
            _ => Frame::new([0.1, -7.3, 1e3 / 3.0], 10.0 / 3.0, depth),
        }
        .unwrap();
        let count = 40 + random.below(if depth < 5 { 361 } else { 120 });
        let (special, plain) = (random.below(6), seed / 6 % 2 == 0);
        let operands: Vec<Csg> = (0..count).map(|_| operand(&mut random, &frame, special, plain)).collect();
        for way in [Way::Union, Way::IntersectionOfComplements, Way::Parity] {
            let csg = match way {
                Way::Union => Csg::union_of(operands.iter().cloned()),
                Way::IntersectionOfComplements => Csg::intersection_of(operands.iter().map(Csg::complement)),
                Way::Parity => Csg::xor_of(operands.iter().cloned()),
            }
            .unwrap();
            for rule in [Rule::Certified, Rule::Sampled] {
                let singles = operands.iter().map(|part| {
                    let tree = build(part, &frame, rule, &alone()).unwrap();
                    if way == Way::IntersectionOfComplements {
                        complement(tree.view(), &alone()).unwrap()
                    } else {
                        tree
                    }
                });
                let op = [union, intersection, xor][way as usize];
                let expected = singles.reduce(|a, b| op(a.view(), b.view(), &alone()).unwrap()).unwrap();
                let found = build(&csg, &frame, rule, &alone()).unwrap();
                let what = format!("{seed}: {count} operands, {way:?} {rule:?} {frame:?}");
                assert_exterior(&found, &expected, &what);
                let [found, expected] = [dense(&found), dense(&expected)];
                match rule {
                    Rule::Sampled => assert!(found == expected, "{what}"),
                    _ => {
                        assert!(no_looser(&found, &expected), "{what}");
                        assert!(!plain || found == expected, "{what}");
                        cells[0] += found.count(Tag::Partial);
                        cells[1] += expected.count(Tag::Partial);
                    }
                }
                // The resolved result: the operands' certified trees decide it.
                if rule == Rule::Certified {
                    for (rule, tag) in [(Rule::Inner, Tag::Empty), (Rule::Outer, Tag::Full)] {
                        let resolved = dense(&build(&csg, &frame, rule, &alone()).unwrap());
                        let expected = expected.resolved(tag);
                        // Where more is known, the rule decides less.
                        assert!(resolved == found.resolved(tag), "{what}, {rule:?}");
                        assert!(!plain || resolved == expected, "{what}, {rule:?}");
                    }
                }
            }
        }
    }
    println!("PARTIAL: {cells:?}");
    assert!(cells[1] > 10_000);
}

/// True if every decided cell of `expected` has the same decision in `found`.
fn no_looser(found: &Dense, expected: &Dense) -> bool {
    found
        .tags
        .iter()
        .zip(&expected.tags)
        .all(|(&found, &expected)| expected == Tag::Partial || found == expected)
}

/// Asserts that the exteriors do not contradict each other.
fn assert_exterior(found: &Octree, expected: &Octree, what: &str) {
    let pair = (found.view().exterior(), expected.view().exterior());
    let contradiction = matches!(pair, (Tag::Full, Tag::Empty) | (Tag::Empty, Tag::Full));
    assert!(!contradiction, "{what}: {pair:?}");
}

/// The combinations of resolved trees, in any order.
#[test]
fn many_operands_at_once_and_one_by_one() {
    let frame = Frame::new([-1.0; 3], 2.0, 5).unwrap();
    for seed in 0..6 {
        let mut random = Random(seed ^ 0x0DE5);
        let operands: Vec<Csg> = (0..60).map(|_| operand(&mut random, &frame, 9, true)).collect();
        for rule in RULES {
            let trees: Vec<Octree> =
                operands.iter().map(|part| build(part, &frame, rule, &alone()).unwrap()).collect();
            let views: Vec<_> = trees.iter().map(|tree| *tree.view()).collect();
            let pairs = [
                (Csg::union_of(operands.iter().cloned()), union_of(&views, &alone())),
                (
                    Csg::intersection_of(operands[..20].iter().cloned()),
                    intersection_of(&views[..20], &alone()),
                ),
                (Csg::xor_of(operands.iter().cloned()), xor_of(&views, &alone())),
            ];
            for (i, (csg, expected)) in pairs.into_iter().enumerate() {
                // For parity, the inside of all choices is not what the inner trees contain.
                if i == 2 && matches!(rule, Rule::Inner | Rule::Outer) {
                    continue;
                }
                let found = build(&csg.unwrap(), &frame, rule, &alone()).unwrap();
                let [found, expected] = [dense(&found), dense(&expected.unwrap())];
                assert!(found == expected, "{seed} {rule:?} {i}");
            }
        }
    }
}
