//! The set algebra of stored trees against cell-by-cell three-valued logic.

use leafless::op::{intersection_of, union_of, xor_of};
use leafless::{
    Control, Csg, Error, Frame, Octree, OctreeRef, Rule, Tag, build, compact, complement, difference,
    intersection, union, xor,
};
use leafless_testkit::{Dense, Random, alone, assert_is, cases, lattice_frame, pairs, shapes};
use proptest::prelude::*;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

type Operation = fn(&OctreeRef<'_>, &OctreeRef<'_>, &Control<'_>) -> Result<Octree, Error>;
type Bits = fn(bool, bool) -> bool;

const OPERATIONS: [(&str, Operation, Bits); 4] = [
    ("union", union, |a, b| a | b),
    ("intersection", intersection, |a, b| a & b),
    ("difference", difference, |a, b| a & !b),
    ("xor", xor, |a, b| a ^ b),
];

fn apply(op: Operation, a: &Octree, b: &Octree) -> Octree {
    op(a.view(), b.view(), &alone()).unwrap()
}

fn not(a: &Octree) -> Octree {
    complement(a.view(), &alone()).unwrap()
}

/// Asserts that `found` is `expected`, in its only canonical form.
fn assert_canonical(found: &Octree, expected: &Octree) {
    found.view().check().unwrap();
    assert_eq!(found, expected);
    let (found, expected) = (found.view(), expected.view());
    assert_eq!(found.element_count(), expected.element_count());
    assert_eq!(found.brick_count(), expected.brick_count());
    assert_eq!(found.is_binary(), expected.is_binary());
}

/// Checks every operation, with the operands in both orders, on raw, coded and mixed operands.
fn compare_all(da: &Dense, db: &Dense) {
    let (a, b) = (da.octree(), db.octree());
    assert_is(&a, da);
    let (coded_a, coded_b) = (compact(a.view()).unwrap(), compact(b.view()).unwrap());
    coded_a.view().check().unwrap();
    assert_eq!(coded_a, a);
    for (name, op, bits) in OPERATIONS {
        for ((da, a, coded_a), (db, b, coded_b)) in
            [((da, &a, &coded_a), (db, &b, &coded_b)), ((db, &b, &coded_b), (da, &a, &coded_a))]
        {
            let expected = da.combine(db, bits);
            let tree = expected.octree();
            let found = apply(op, a, b);
            assert_eq!(Dense::of(found.view()), expected, "{name}");
            assert_canonical(&found, &tree);
            for (a, b) in [(coded_a, coded_b), (a, coded_b), (coded_a, b)] {
                assert_canonical(&apply(op, a, b), &tree);
            }
        }
    }
    let expected = da.complement().octree_with(Tag::Full, &alone()).unwrap();
    assert_canonical(&not(&a), &expected);
    assert_canonical(&not(&coded_a), &expected);
    assert_is(&not(&a), &da.complement());
}

fn laws(a: &Octree, b: &Octree) {
    let (u, i, d, x): (Operation, Operation, Operation, Operation) = (union, intersection, difference, xor);
    // De Morgan, with the infinite outside too.
    assert_canonical(&not(&apply(u, a, b)), &apply(i, &not(a), &not(b)));
    assert_canonical(&not(&apply(i, a, b)), &apply(u, &not(a), &not(b)));
    // Kleene's logic keeps these for undecided cells as well.
    assert_canonical(&apply(u, a, &apply(i, a, b)), a);
    assert_canonical(&apply(i, a, &apply(u, a, b)), a);
    assert_canonical(&not(&not(a)), a);
    assert_canonical(&apply(u, a, a), a);
    assert_canonical(&apply(i, a, a), a);
    assert_canonical(&apply(u, a, b), &apply(u, b, a));
    assert_canonical(&apply(i, a, b), &apply(i, b, a));
    assert_canonical(&apply(x, a, b), &apply(x, b, a));
    assert_canonical(&apply(d, a, b), &apply(i, a, &not(b)));
    assert_canonical(&apply(x, a, b), &apply(u, &apply(d, a, b), &apply(d, b, a)));
    assert_canonical(&apply(x, &not(a), b), &not(&apply(x, a, b)));
}

fn binary_laws(a: &Octree, b: &Octree) {
    let (u, i, d, x): (Operation, Operation, Operation, Operation) = (union, intersection, difference, xor);
    let volume = |tree: &Octree| {
        let (lower, upper) = tree.statistics().volume_cells();
        assert_eq!(lower, upper);
        lower
    };
    assert_canonical(&apply(u, &apply(d, a, b), &apply(i, a, b)), a);
    assert_eq!(volume(a) + volume(b), volume(&apply(u, a, b)) + volume(&apply(i, a, b)));
    assert_eq!(volume(&apply(x, a, b)), volume(&apply(d, a, b)) + volume(&apply(d, b, a)));
    assert_eq!(volume(a) + volume(&not(a)), 8u64.pow(a.frame().depth() as u32));
    assert_eq!(apply(d, a, a).view().root_tag(), Tag::Empty);
    assert_eq!(apply(x, a, a).view().root_tag(), Tag::Empty);
    assert_eq!(apply(u, a, &not(a)).view().root_tag(), Tag::Full);
    assert_canonical(&apply(x, &apply(x, a, b), b), a);
}

proptest! {
    #![proptest_config(cases(250))]

    #[test]
    fn operations_are_kleene_logic_cell_by_cell((a, b) in pairs(1..=5)) {
        compare_all(&a, &b);
    }

    #[test]
    fn laws_hold_with_undecided_cells((a, b) in pairs(1..=5)) {
        laws(&a.octree(), &b.octree());
    }

    #[test]
    fn laws_of_binary_solids((a, b) in pairs(1..=5), tag in prop_oneof![Just(Tag::Empty), Just(Tag::Full)]) {
        let (a, b) = (a.resolved(tag).octree(), b.resolved(Tag::Full).octree());
        laws(&a, &b);
        binary_laws(&a, &b);
    }

    #[test]
    fn any_number_of_operands(
        shapes in (1..=4u8).prop_flat_map(|depth| proptest::collection::vec(leafless_testkit::shapes_of(depth), 1..7)),
        coded in any::<u8>(),
    ) {
        type Many = fn(&[OctreeRef<'_>], &Control<'_>) -> Result<Octree, Error>;
        let dense: Vec<Dense> = shapes.iter().map(|shape| shape.dense()).collect();
        let trees: Vec<Octree> = dense
            .iter()
            .enumerate()
            .map(|(i, dense)| match dense.octree() {
                tree if coded >> i & 1 != 0 => compact(tree.view()).unwrap(),
                tree => tree,
            })
            .collect();
        let views: Vec<OctreeRef<'_>> = trees.iter().map(|tree| *tree.view()).collect();
        let many: [(Many, Bits); 3] =
            [(union_of, |a, b| a | b), (intersection_of, |a, b| a & b), (xor_of, |a, b| a ^ b)];
        for (op, bits) in many {
            let expected = dense.iter().skip(1).fold(dense[0].clone(), |sum, next| sum.combine(next, bits));
            let found = op(&views, &alone()).unwrap();
            assert_canonical(&found, &expected.octree());
            let mut reversed = views.clone();
            reversed.reverse();
            assert_canonical(&op(&reversed, &alone()).unwrap(), &found);
        }
    }
}

proptest! {
    #![proptest_config(cases(5))]

    #[test]
    fn deeper_trees((a, b) in pairs(6..=7)) {
        compare_all(&a, &b);
        laws(&a.octree(), &b.octree());
    }
}

#[test]
fn every_pair_of_universes_that_are_all_one_tag() {
    for depth in 1..=4 {
        for ta in leafless_testkit::TAGS {
            for tb in leafless_testkit::TAGS {
                let (a, b) = (Dense::uniform(depth, ta), Dense::uniform(depth, tb));
                compare_all(&a, &b);
                laws(&a.octree(), &b.octree());
            }
            // One operand uniform, the other as mixed as can be.
            let mixed = Dense::from_fn(depth, |at| {
                leafless_testkit::TAGS[(leafless_testkit::noise(3, at) % 3) as usize]
            });
            compare_all(&Dense::uniform(depth, ta), &mixed);
        }
    }
}

#[test]
fn the_outside_follows_the_same_logic() {
    let dense = leafless_testkit::Shape { depth: 3, tape: vec![9, 6, 0, 1, 3, 5, 0, 9, 2] }.dense();
    for ta in leafless_testkit::TAGS {
        for tb in leafless_testkit::TAGS {
            let a = dense.octree_with(ta, &alone()).unwrap();
            let b = dense.complement().octree_with(tb, &alone()).unwrap();
            assert_eq!(a.view().exterior(), ta);
            for (name, op, bits) in OPERATIONS {
                assert_eq!(
                    apply(op, &a, &b).view().exterior(),
                    leafless_testkit::kleene(bits, ta, tb),
                    "{name}"
                );
            }
            assert_eq!(not(&a).view().exterior(), ta.complement());
        }
    }
}

#[test]
fn refusals() {
    let a = lattice_frame(4);
    let tree = |frame: Frame| Octree::uniform(frame, Tag::Full, Tag::Empty).unwrap();
    for other in [
        a.with_depth(5).unwrap(),
        Frame::new([0.0; 3], 16.5, 4).unwrap(),
        Frame::new([0.0, 0.0, 1.0], 16.0, 4).unwrap(),
    ] {
        for (_, op, _) in OPERATIONS {
            let refused = op(tree(a).view(), tree(other).view(), &alone());
            assert!(matches!(refused, Err(Error::FrameMismatch { .. })), "{refused:?}");
        }
        let (one, two) = (tree(a), tree(other));
        let refused = union_of(&[*one.view(), *one.view(), *two.view()], &alone());
        assert!(matches!(refused, Err(Error::FrameMismatch { .. })));
    }
    for many in [union_of, intersection_of, xor_of] {
        assert!(matches!(many(&[], &alone()), Err(Error::Argument { name: "trees", .. })));
    }
    for (tag, exterior) in [(Tag::Branch, Tag::Empty), (Tag::Empty, Tag::Branch)] {
        assert!(matches!(Octree::uniform(a, tag, exterior), Err(Error::Argument { .. })));
    }
}

/// Runs `work` with limits one below, at and above the need of its result. `brick` is the size of a brick in
/// the working form.
fn limit(threads: usize, brick: u64, work: &dyn Fn(&Control<'_>) -> Result<Octree, Error>) {
    let free = Control::threads(threads);
    let tree = work(&free).unwrap();
    let nodes = tree.statistics().nodes();
    let bytes = 16 * tree.view().element_count() + brick * tree.view().brick_count();
    type Set = fn(Control<'static>, u64) -> Control<'static>;
    let limits: [(&str, u64, Set); 2] = [
        ("nodes", nodes, |control, limit| Control { max_nodes: Some(limit), ..control }),
        ("bytes", bytes, |control, limit| Control { max_bytes: Some(limit), ..control }),
    ];
    for (what, least, set) in limits {
        for limit in [least, least + 1, u64::MAX] {
            assert_eq!(work(&set(free, limit)).unwrap(), tree);
        }
        for limit in [0, least / 2, least.saturating_sub(1)].into_iter().filter(|&limit| limit < least) {
            match work(&set(free, limit)) {
                Err(Error::Limit { what: found, limit: l }) => assert_eq!((found, l), (what, limit)),
                other => panic!("{least} {what}, limit {limit}: {other:?}"),
            }
        }
    }
}

#[test]
fn limits_are_exact() {
    for depth in 1..=7 {
        let frame = lattice_frame(depth);
        let size = frame.edge();
        let ball = |at: f64| Csg::ball([at * size; 3], 0.35 * size).unwrap();
        for rule in [Rule::Certified, Rule::Sampled] {
            for threads in [1, 3] {
                let brick = if rule.is_binary() { 8 } else { 16 };
                limit(threads, brick, &|control| build(&ball(0.4), &frame, rule, control));
                let a = build(&ball(0.4), &frame, rule, &alone()).unwrap();
                let b = build(&ball(0.6), &frame, rule, &alone()).unwrap();
                for (_, op, _) in OPERATIONS {
                    limit(threads, brick, &|control| op(a.view(), b.view(), control));
                }
                limit(threads, brick, &|control| complement(a.view(), control));
            }
        }
    }
}

#[test]
fn a_flag_that_is_already_set_stops_everything() {
    let flag = AtomicBool::new(true);
    let control = Control { cancel: Some(&flag), threads: 1, ..Control::default() };
    let tree = Dense::uniform(3, Tag::Full).octree();
    for (_, op, _) in OPERATIONS {
        assert!(matches!(op(tree.view(), tree.view(), &control), Err(Error::Cancelled)));
    }
    assert!(matches!(complement(tree.view(), &control), Err(Error::Cancelled)));
    assert!(matches!(union_of(&[*tree.view()], &control), Err(Error::Cancelled)));
    flag.store(false, Ordering::Relaxed);
    assert!(complement(tree.view(), &control).is_ok());
}

/// Number of entries of both operands from which the Booleans use threads. The test below must exceed it.
const WORTH_THREADS: u64 = 1 << 21;

/// Two large hollow balls, slightly shifted, so that they nearly coincide all around.
fn large_pair(rule: Rule) -> (Octree, Octree) {
    let frame = lattice_frame(11);
    let ball = |x: f64, radius: f64| {
        let ball = Csg::ball([x, 1024.25, 1023.5], radius).unwrap();
        build(&ball, &frame, rule, &Control::default()).unwrap()
    };
    let hollow = |x: f64| apply(difference, &ball(x, 1009.75), &ball(x, 621.5));
    let (a, b) = (hollow(1022.0), hollow(1025.5));
    let entries = |tree: &Octree| tree.view().element_count() + tree.view().brick_count();
    assert!(entries(&a) + entries(&b) > WORTH_THREADS, "{} {}", entries(&a), entries(&b));
    (a, b)
}

/// The sampled pair, built once.
fn sampled_pair() -> (Octree, Octree) {
    static PAIR: OnceLock<(Octree, Octree)> = OnceLock::new();
    PAIR.get_or_init(|| large_pair(Rule::Sampled)).clone()
}

fn threads_agree(rule: Rule) {
    let (a, b) = if rule.is_binary() { sampled_pair() } else { large_pair(rule) };
    let coded = compact(b.view()).unwrap();
    let same = |one: &Octree, many: &Octree| {
        many.view().check().unwrap();
        assert_eq!(one, many);
        assert_eq!(one.statistics(), many.statistics());
        assert_eq!(one.view().is_binary(), many.view().is_binary());
    };
    for (name, op, bits) in OPERATIONS {
        let one = op(a.view(), b.view(), &Control::threads(1)).unwrap();
        one.view().check().unwrap();
        for threads in [2, 16] {
            same(&one, &op(a.view(), b.view(), &Control::threads(threads)).unwrap());
        }
        same(&one, &op(a.view(), coded.view(), &Control::threads(2)).unwrap());
        // Too many cells for a dense array. The points lie in both operands, in one, and in none.
        let mut random = Random(7);
        for _ in 0..200_000 {
            let at = [0; 3].map(|_| random.below(2048) as u32);
            let expected = leafless_testkit::kleene(bits, a.view().tag_at(at), b.view().tag_at(at));
            assert_eq!(one.view().tag_at(at), expected, "{name} {at:?}");
        }
        node_count_is_limited_with_threads(&one, &|control| op(a.view(), b.view(), control));
    }
    let one = complement(a.view(), &Control::threads(1)).unwrap();
    same(&one, &complement(a.view(), &Control::threads(2)).unwrap());
    same(&complement(one.view(), &Control::threads(2)).unwrap(), &a);
    if rule.is_binary() {
        binary_laws(&a, &b);
    }
}

fn node_count_is_limited_with_threads(tree: &Octree, work: &dyn Fn(&Control<'_>) -> Result<Octree, Error>) {
    let nodes = tree.statistics().nodes();
    let limited = |limit| work(&Control { max_nodes: Some(limit), ..Control::threads(2) });
    assert_eq!(&limited(nodes).unwrap(), tree);
    assert!(matches!(limited(nodes - 1), Err(Error::Limit { what: "nodes", .. })));
}

#[test]
fn threads_do_not_change_sampled_results() {
    threads_agree(Rule::Sampled);
}

#[test]
fn threads_do_not_change_certified_results() {
    threads_agree(Rule::Certified);
}

#[test]
fn a_flag_set_meanwhile_stops_a_boolean() {
    let (a, b) = sampled_pair();
    for threads in [1, 2] {
        let stopped = (0..500).any(|attempt| {
            let (started, flag) = (AtomicBool::new(false), AtomicBool::new(false));
            std::thread::scope(|scope| {
                scope.spawn(|| {
                    while !started.load(Ordering::Acquire) {
                        std::hint::spin_loop();
                    }
                    std::thread::sleep(std::time::Duration::from_micros(20 * (attempt % 50)));
                    flag.store(true, Ordering::Relaxed);
                });
                let control = Control { cancel: Some(&flag), ..Control::threads(threads) };
                started.store(true, Ordering::Release);
                matches!(xor(a.view(), b.view(), &control), Err(Error::Cancelled))
            })
        });
        assert!(stopped, "{threads} threads");
    }
}

proptest! {
    #![proptest_config(cases(40))]

    #[test]
    fn compact_keeps_everything(shape in shapes(1..=5)) {
        let dense = shape.dense();
        let tree = dense.octree();
        let coded = compact(tree.view()).unwrap();
        assert_is(&coded, &dense);
        assert_canonical(&coded, &tree);
        assert_canonical(&compact(coded.view()).unwrap(), &tree);
    }
}

/// On trees large enough for a dictionary, dictionary-coded Booleans equal Booleans on raw bricks.
#[test]
fn dictionary_coded_operands_give_the_same() {
    let frame = Frame::new([0.0; 3], 1.0, 8).unwrap();
    let control = Control::threads(1);
    for rule in [Rule::Sampled, Rule::Certified] {
        let ball = |x: f64| build(&Csg::ball([x, 0.5, 0.5], 0.31).unwrap(), &frame, rule, &control).unwrap();
        let (a, b) = (ball(0.4), ball(0.6));
        let (coded_a, coded_b) = (compact(a.view()).unwrap(), compact(b.view()).unwrap());
        for tree in [&a, &b] {
            // `compact` encodes as a file is encoded.
            let probe = leafless::file::probe_bytes(&leafless::file::to_bytes(tree).unwrap()).unwrap();
            assert!(probe.sections.iter().any(|section| section.name == Some("brick indices")), "{rule:?}");
        }
        for op in [union, intersection, difference, xor] {
            let expected = op(a.view(), b.view(), &control).unwrap();
            expected.view().check().unwrap();
            assert_eq!(op(coded_a.view(), coded_b.view(), &control).unwrap(), expected);
            assert_eq!(op(coded_a.view(), b.view(), &control).unwrap(), expected);
            assert_eq!(op(a.view(), coded_b.view(), &control).unwrap(), expected);
        }
        assert_eq!(complement(coded_a.view(), &control).unwrap(), complement(a.view(), &control).unwrap());
    }
}
