//! The proofs that octrees claim for their cells. The bits are those of the table in `src/octree/proof.rs`,
//! whatever made the tree, and each claim is true of the source, point by point.

#![cfg(feature = "std")]

use leafless::op::{Zone, intersection_of, resolve, union_of, xor_of};
use leafless::solid::Transform;
use leafless::{
    Affine, AnySolid, Classifier, Control, Csg, Error, FillRule, Frame, LazyOctree, MeshSolid, Octree, Proof,
    Rule, Solid, Tag, TriangleMesh, build, compact, complement, difference, file, intersection, union, xor,
};
use leafless_testkit::Random;
use std::sync::Arc;

const CONTROL: Control<'static> =
    Control { threads: 1, max_nodes: None, max_bytes: None, max_splits: None, cancel: None, progress: None };

const RULES: [Rule; 4] = [Rule::Certified, Rule::Sampled, Rule::Inner, Rule::Outer];

/// Edge of the universe; a finest cell has the edge 1 at depth 4.
const EDGE: f64 = 16.0;

fn frame(depth: u8) -> Frame {
    Frame::new([0.0; 3], EDGE, depth).unwrap()
}

fn any_rule(random: &mut Random) -> Rule {
    // Mostly the rule that loses nothing. After many operations with other rules little would remain
    // proven.
    RULES[random.below(10).saturating_sub(6) as usize]
}

/// Returns a random multiple of a quarter.
fn quarter(random: &mut Random, low: u64, high: u64) -> f64 {
    (4 * low + random.below(4 * (high - low))) as f64 / 4.0
}

// ---- the source, exactly --------------------------------------------------------------------------------

/// The source of a tree. Numbers are multiples of small powers of two, so that all sums below are exact.
#[derive(Clone)]
enum Source {
    Ball([f64; 3], f64),
    Cuboid([f64; 3], [f64; 3]),
    Not(Arc<Source>),
    And(Vec<Source>),
    Or(Vec<Source>),
    Xor(Vec<Source>),
    /// A source, scaled and then translated.
    Placed(Arc<Source>, f64, [f64; 3]),
}

impl Source {
    fn negated(self) -> Source {
        Source::Not(Arc::new(self))
    }

    /// True if a point is inside; `None` on the surface of a primitive, where both answers are allowed.
    fn contains(&self, point: [f64; 3]) -> Option<bool> {
        let all =
            |parts: &[Source]| parts.iter().map(|part| part.contains(point)).collect::<Option<Vec<bool>>>();
        match self {
            Source::Ball(centre, radius) => {
                let square = (0..3).map(|axis| (point[axis] - centre[axis]).powi(2)).sum::<f64>();
                (square != radius * radius).then_some(square < radius * radius)
            }
            Source::Cuboid(min, max) => {
                let open = (0..3).all(|axis| min[axis] < point[axis] && point[axis] < max[axis]);
                let closed = (0..3).all(|axis| min[axis] <= point[axis] && point[axis] <= max[axis]);
                (open == closed).then_some(open)
            }
            Source::Not(source) => source.contains(point).map(|inside| !inside),
            Source::And(parts) => all(parts).map(|parts| parts.into_iter().all(|part| part)),
            Source::Or(parts) => all(parts).map(|parts| parts.into_iter().any(|part| part)),
            Source::Xor(parts) => {
                all(parts).map(|parts| parts.into_iter().fold(false, |odd, part| odd ^ part))
            }
            Source::Placed(source, scale, offset) => {
                source.contains([0, 1, 2].map(|axis| (point[axis] - offset[axis]) / scale))
            }
        }
    }

    fn csg(&self) -> Csg {
        let all = |parts: &[Source]| parts.iter().map(Source::csg).collect::<Vec<_>>();
        match self {
            Source::Ball(centre, radius) => Csg::ball(*centre, *radius).unwrap(),
            Source::Cuboid(min, max) => Csg::cuboid(*min, *max).unwrap(),
            Source::Not(source) => source.csg().complement(),
            Source::And(parts) => Csg::intersection_of(all(parts)).unwrap(),
            Source::Or(parts) => Csg::union_of(all(parts)).unwrap(),
            Source::Xor(parts) => Csg::xor_of(all(parts)).unwrap(),
            Source::Placed(source, scale, offset) => {
                source.csg().placed(&placement(*scale, *offset)).unwrap()
            }
        }
    }

    fn primitive(random: &mut Random) -> Source {
        let mut corner = || [0; 3].map(|_| quarter(random, 0, 14));
        let low = corner();
        if random.below(2) == 0 {
            Source::Ball(low.map(|c| c + 1.0), quarter(random, 1, 7))
        } else {
            Source::Cuboid(low, low.map(|c| c + quarter(random, 1, 9)))
        }
    }

    /// A few primitives, combined.
    fn scene(random: &mut Random) -> Source {
        let parts: Vec<_> = (0..1 + random.below(3)).map(|_| Source::primitive(random)).collect();
        let joined = join(random, parts);
        if random.below(4) == 0 { joined.negated() } else { joined }
    }
}

fn join(random: &mut Random, parts: Vec<Source>) -> Source {
    match random.below(4) {
        0 => Source::And(parts),
        1 => Source::Xor(parts),
        _ => Source::Or(parts),
    }
}

fn placement(scale: f64, [x, y, z]: [f64; 3]) -> Affine {
    Affine::new([[scale, 0.0, 0.0, x], [0.0, scale, 0.0, y], [0.0, 0.0, scale, z]]).unwrap()
}

/// Points in a finest cell: the middle, and one point near each corner.
fn points(cell: [u32; 3], size: f64) -> impl Iterator<Item = [f64; 3]> {
    (0..9).map(move |k| {
        let within = |axis: u32| if k == 8 { 0.5 } else { [0.0625, 0.9375][k >> axis & 1] };
        [0, 1, 2].map(|axis| (cell[axis as usize] as f64 + within(axis)) * size)
    })
}

/// Counts the points of the cells that contradict `claim`; only every `stride`-th cell is examined.
fn lies(tree: &Octree, claim: Proof, source: &Source, stride: u64) -> usize {
    let (cells, size) = (tree.frame().cells(), tree.frame().cell_size());
    let mut count = 0;
    for n in (0..(cells as u64).pow(3)).step_by(stride as usize) {
        let cell =
            [n % cells as u64, n / cells as u64 % cells as u64, n / (cells as u64).pow(2)].map(|a| a as u32);
        let claimed = match tree.view().tag_at(cell) {
            Tag::Full if claim.full => true,
            Tag::Empty if claim.empty => false,
            _ => continue,
        };
        count += points(cell, size).filter(|&point| source.contains(point) == Some(!claimed)).count();
    }
    count
}

// ---- the table ------------------------------------------------------------------------------------------

/// The expected proof by the table. Displacements are exact up to the last places.
#[derive(Clone, Copy, Debug)]
struct Claim {
    full: bool,
    empty: bool,
    displacement: f64,
}

impl Claim {
    fn ruled(self, rule: Rule) -> Claim {
        let full = self.full && (rule == Rule::Certified || rule == Rule::Inner);
        let empty = self.empty && (rule == Rule::Certified || rule == Rule::Outer);
        Claim { full, empty, ..self }
    }

    fn not(self) -> Claim {
        Claim { full: self.empty, empty: self.full, ..self }
    }

    /// Returns the claim for unions and intersections.
    fn joined(claims: &[Claim]) -> Claim {
        Claim {
            full: claims.iter().all(|claim| claim.full),
            empty: claims.iter().all(|claim| claim.empty),
            displacement: claims.iter().map(|claim| claim.displacement).fold(0.0, f64::max),
        }
    }

    fn parity(claims: &[Claim]) -> Claim {
        let joined = Claim::joined(claims);
        let both = joined.full && joined.empty;
        Claim { full: both, empty: both, ..joined }
    }

    #[track_caller]
    fn check(&self, proof: Proof) {
        assert_eq!((proof.full, proof.empty), (self.full, self.empty));
        assert_eq!(proof.is_certified(), self.full && self.empty);
        let (found, least) = (proof.displacement(), self.displacement);
        assert!(found >= least && found <= least * (1.0 + 1e-12), "{found} is not {least}");
    }
}

/// A tree, its expected proof, and its source.
#[derive(Clone)]
struct Grown {
    tree: Octree,
    claim: Claim,
    source: Source,
}

impl Grown {
    #[track_caller]
    fn new(tree: Octree, claim: Claim, source: Source) -> Grown {
        claim.check(tree.proof());
        assert_eq!(tree.view().proof(), tree.proof());
        assert_eq!(lies(&tree, tree.proof(), &source, 17), 0, "a claim is false");
        Grown { tree, claim, source }
    }

    fn solid(&self) -> Csg {
        Csg::solid(AnySolid::new(self.tree.clone()))
    }
}

/// Builds `solid` by `rule`, or by the certified rule if the solid cannot be sampled at centres. Returns the
/// rule used, too.
fn built<S: Solid>(solid: &S, depth: u8, rule: Rule) -> (Octree, Rule) {
    match build(solid, &frame(depth), rule, &CONTROL) {
        Err(Error::NotSampled) if rule == Rule::Sampled => {
            (build(solid, &frame(depth), Rule::Certified, &CONTROL).unwrap(), Rule::Certified)
        }
        tree => (tree.unwrap(), rule),
    }
}

fn leaf(random: &mut Random) -> Grown {
    let source = Source::scene(random);
    let (tree, rule) = built(&source.csg(), 4, any_rule(random));
    let claim = Claim { full: true, empty: true, displacement: 0.0 }.ruled(rule);
    if random.below(3) > 0 {
        return Grown::new(tree, claim, source);
    }
    let displacement = quarter(random, 0, 3);
    let tree = tree.with_proof(tree.proof().with_displacement(displacement).unwrap());
    Grown::new(tree, Claim { displacement, ..claim }, source)
}

/// A random expression over stored trees and primitives, with its expected proof.
fn expression(random: &mut Random, level: u32) -> (Csg, Claim, Source) {
    if level == 0 {
        if random.below(4) == 0 {
            let source = Source::primitive(random);
            return (source.csg(), Claim { full: true, empty: true, displacement: 0.0 }, source);
        }
        let few = random.below(2) as u32;
        let grown = grow(random, few);
        return (grown.solid(), grown.claim, grown.source);
    }
    let parts: Vec<_> = (0..2 + random.below(2)).map(|_| expression(random, level - 1)).collect();
    let claims: Vec<_> = parts.iter().map(|part| part.1).collect();
    let sources: Vec<_> = parts.iter().map(|part| part.2.clone()).collect();
    let solids: Vec<_> = parts.iter().map(|part| part.0.clone()).collect();
    let (csg, claim, source) = match random.below(5) {
        0 => (Csg::union_of(solids).unwrap(), Claim::joined(&claims), Source::Or(sources)),
        1 => (Csg::intersection_of(solids).unwrap(), Claim::joined(&claims), Source::And(sources)),
        2 => {
            let claim = Claim::joined(&[claims[0], claims[1].not()]);
            let source = Source::And(vec![sources[0].clone(), sources[1].clone().negated()]);
            (solids[0].difference(&solids[1]).unwrap(), claim, source)
        }
        _ => (Csg::xor_of(solids).unwrap(), Claim::parity(&claims), Source::Xor(sources)),
    };
    if random.below(3) == 0 {
        (csg.complement(), claim.not(), source.negated())
    } else {
        (csg, claim, source)
    }
}

/// A tree made by up to `level` nested operations.
fn grow(random: &mut Random, level: u32) -> Grown {
    if level == 0 {
        return leaf(random);
    }
    let a = grow(random, level - 1);
    let tree = a.tree.view();
    match random.below(12) {
        0..4 => {
            let below = random.below(level.into()) as u32;
            let b = grow(random, below);
            let (claims, both) = ([a.claim, b.claim], vec![a.source, b.source.clone()]);
            let other = b.tree.view();
            match random.below(4) {
                0 => Grown::new(
                    union(tree, other, &CONTROL).unwrap(),
                    Claim::joined(&claims),
                    Source::Or(both),
                ),
                1 => {
                    let tree = intersection(tree, other, &CONTROL).unwrap();
                    Grown::new(tree, Claim::joined(&claims), Source::And(both))
                }
                2 => {
                    let source = Source::And(vec![both[0].clone(), b.source.negated()]);
                    let claim = Claim::joined(&[a.claim, b.claim.not()]);
                    Grown::new(difference(tree, other, &CONTROL).unwrap(), claim, source)
                }
                _ => {
                    Grown::new(xor(tree, other, &CONTROL).unwrap(), Claim::parity(&claims), Source::Xor(both))
                }
            }
        }
        4 => {
            let others: Vec<_> = (0..2).map(|_| grow(random, (level - 1).min(1))).collect();
            let all: Vec<_> = [&a].into_iter().chain(&others).collect();
            let trees: Vec<_> = all.iter().map(|grown| *grown.tree.view()).collect();
            let claims: Vec<_> = all.iter().map(|grown| grown.claim).collect();
            let sources = all.iter().map(|grown| grown.source.clone()).collect();
            match random.below(3) {
                0 => Grown::new(
                    union_of(&trees, &CONTROL).unwrap(),
                    Claim::joined(&claims),
                    Source::Or(sources),
                ),
                1 => {
                    let tree = intersection_of(&trees, &CONTROL).unwrap();
                    Grown::new(tree, Claim::joined(&claims), Source::And(sources))
                }
                _ => Grown::new(
                    xor_of(&trees, &CONTROL).unwrap(),
                    Claim::parity(&claims),
                    Source::Xor(sources),
                ),
            }
        }
        5 => Grown::new(complement(tree, &CONTROL).unwrap(), a.claim.not(), a.source.negated()),
        6 => {
            let rule =
                if tree.is_binary() { any_rule(random) } else { RULES[[0, 2, 3][random.below(3) as usize]] };
            Grown::new(resolve(tree, rule, &CONTROL).unwrap(), a.claim.ruled(rule), a.source)
        }
        7 => Grown::new(compact(tree).unwrap(), a.claim, a.source),
        8 => {
            // At another depth, or the same, and back.
            let (other, first) = built(&a.tree, 3 + random.below(3) as u8, any_rule(random));
            let other = Grown::new(other, a.claim.ruled(first), a.source);
            let (tree, second) = built(&other.tree, 4, any_rule(random));
            Grown::new(tree, other.claim.ruled(second), other.source)
        }
        9 => {
            let deep = 1 + random.below(2) as u32;
            let (csg, claim, source) = expression(random, deep);
            let csg = Csg::union_of([a.solid(), csg]).unwrap();
            let (tree, rule) = built(&csg, 4, any_rule(random));
            Grown::new(tree, Claim::joined(&[a.claim, claim]).ruled(rule), Source::Or(vec![a.source, source]))
        }
        10 => {
            let (scale, offset) = ([0.5, 1.0, 2.0][random.below(3) as usize], [1.0, 0.0, -2.5]);
            let source = Source::Placed(Arc::new(a.source.clone()), scale, offset);
            let map = placement(scale, offset);
            let claim = Claim { displacement: a.claim.displacement * scale, ..a.claim };
            let (placed, rule) = match random.below(3) {
                0 => built(&a.solid().placed(&map).unwrap(), 4, any_rule(random)),
                1 => built(&Transform::new(a.tree.clone(), a.tree.frame(), &map), 4, any_rule(random)),
                _ => built(
                    &AnySolid::new(Transform::of(AnySolid::new(a.tree.clone()), &map)),
                    4,
                    any_rule(random),
                ),
            };
            Grown::new(placed, claim.ruled(rule), source)
        }
        _ => {
            let mut lazy = LazyOctree::new(a.tree.clone(), tree.frame()).unwrap();
            let level = random.below(5) as u8;
            lazy.refine(&Zone::Point([3.1, 4.1, 5.9]), 4, &CONTROL).unwrap();
            lazy.refine(&Zone::Whole, level, &CONTROL).unwrap();
            let frozen = Grown::new(lazy.freeze(&CONTROL).unwrap(), a.claim, a.source);
            let mut again = LazyOctree::resume(&frozen.tree, a.tree.clone(), tree.frame(), &CONTROL).unwrap();
            again.refine(&Zone::Whole, 4, &CONTROL).unwrap();
            Grown::new(again.freeze(&CONTROL).unwrap(), a.claim, frozen.source)
        }
    }
}

#[test]
fn what_is_claimed_is_what_the_table_says_and_true() {
    let mut random = Random(11);
    let mut seen = [0; 4];
    for round in 0..1500 {
        let grown = grow(&mut random, 1 + round % 4);
        assert_eq!(lies(&grown.tree, grown.tree.proof(), &grown.source, 1), 0, "round {round}");
        seen[grown.claim.full as usize + 2 * grown.claim.empty as usize] += 1;
    }
    assert!(seen.iter().all(|&count| count > 60), "{seen:?}");
}

/// The documentation's table, line by line.
#[test]
fn the_table_of_the_documentation() {
    let all = [Proof::new(false, false), Proof::new(true, false), Proof::new(false, true), Proof::CERTIFIED];
    for (a, rule) in all.iter().flat_map(|&a| RULES.map(|rule| (a, rule))) {
        let ruled = rule.proof(a);
        let certified = rule.proof(Proof::CERTIFIED);
        assert_eq!(ruled, a.and(certified));
        assert_eq!(
            (certified.full, certified.empty),
            [(true, true), (false, false), (true, false), (false, true)][rule as usize]
        );
    }
    for (a, b) in all.iter().flat_map(|&a| all.map(|b| (a, b))) {
        assert_eq!(a.and(b), Proof::new(a.full && b.full, a.empty && b.empty));
        assert_eq!(a.complement(), Proof::new(a.empty, a.full));
        let both = a.is_certified() && b.is_certified();
        assert_eq!(a.xor(b), Proof::new(both, both));
        // De Morgan.
        assert_eq!(a.and(b).complement(), a.complement().and(b.complement()));
        assert_eq!(a.xor(b), a.xor(b.complement()));
    }
}

/// The check above notices lies: a claim that is not proven is false somewhere.
#[test]
fn a_lie_is_seen() {
    let sources = [
        Source::Ball([7.25, 8.0, 6.5], 5.25),
        Source::Cuboid([1.25, 2.75, 3.5], [9.25, 12.0, 11.75]),
        Source::Xor(vec![Source::Ball([5.0; 3], 4.25), Source::Ball([9.0; 3], 4.25)]),
    ];
    for source in &sources {
        for rule in [Rule::Sampled, Rule::Inner, Rule::Outer] {
            let tree = build(&source.csg(), &frame(4), rule, &CONTROL).unwrap();
            assert_eq!(lies(&tree, tree.proof(), source, 1), 0);
            for lie in [Proof::new(true, false), Proof::new(false, true), Proof::CERTIFIED] {
                let lying = tree.with_proof(lie);
                let honest = tree.proof().and(lie) == lie;
                assert_eq!(lies(&lying, lying.proof(), source, 1) == 0, honest, "{rule:?} as {lie:?}");
                // Operations that carry a lie over lie, too; operations that carry none do not.
                let inverse = complement(lying.view(), &CONTROL).unwrap();
                let inverted = source.clone().negated();
                assert_eq!(lies(&inverse, inverse.proof(), &inverted, 1) == 0, honest);
                let (csg, _) = built(&Csg::solid(AnySolid::new(lying)).complement(), 4, Rule::Certified);
                assert_eq!(lies(&csg, csg.proof(), &inverted, 1) == 0, honest);
            }
        }
    }
}

/// The maker of a tree by hand states its proof. Equal cells are equal trees, whatever the proofs.
#[test]
fn what_is_said_of_a_tree() {
    let ball = Csg::ball([8.0; 3], 5.0).unwrap();
    let tree = build(&ball, &frame(4), Rule::Sampled, &CONTROL).unwrap();
    assert_eq!(tree.proof(), Proof::new(false, false));
    let said = tree.with_proof(Proof::new(true, false).with_displacement(0.5).unwrap());
    assert_eq!((said.proof().full, said.proof().empty, said.proof().displacement()), (true, false, 0.5));
    assert!(said == tree);
    assert_eq!(tree.proof().displacement(), 0.0, "the other is as it was");
    assert_eq!(Octree::uniform(frame(3), Tag::Full, Tag::Empty).unwrap().proof(), Proof::CERTIFIED);
    for refused in [-1.0, f64::NAN, f64::INFINITY, -f64::MIN_POSITIVE] {
        let result = Proof::CERTIFIED.with_displacement(refused);
        assert!(matches!(result, Err(Error::Argument { name: "displacement", .. })), "{refused}");
    }
    let zero = Proof::CERTIFIED.with_displacement(-0.0).unwrap();
    assert_eq!(zero.displacement().to_bits(), 0);

    // The classifier states the proof, in all wrappers.
    let on = |solid: &AnySolid| solid.on(&frame(4), &CONTROL).unwrap().proof();
    assert_eq!(on(&AnySolid::new(said.clone())), said.proof());
    assert_eq!(on(&AnySolid::new(ball)), Proof::CERTIFIED);
    assert_eq!(Solid::on(said.view(), &frame(3), &CONTROL).unwrap().proof(), said.proof());
}

#[test]
fn files_keep_it() {
    let tree = build(&Csg::cuboid([1.5; 3], [9.25; 3]).unwrap(), &frame(4), Rule::Outer, &CONTROL).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tree.lfl");
    for full in [false, true] {
        for empty in [false, true] {
            for displacement in [0.0, f64::from_bits(1), 0.1, f64::MAX] {
                let proof = Proof::new(full, empty).with_displacement(displacement).unwrap();
                let bytes = file::to_bytes(&tree.with_proof(proof)).unwrap();
                assert_eq!(file::from_bytes(&bytes).unwrap().proof(), proof);
                assert_eq!(file::probe_bytes(&bytes).unwrap().proof, proof);
                file::save(&tree.with_proof(proof), &path).unwrap();
                assert_eq!(
                    (file::open(&path).unwrap().proof(), file::probe(&path).unwrap().proof),
                    (proof, proof)
                );
                #[cfg(feature = "mmap")]
                {
                    // SAFETY: no other process uses the file.
                    #[allow(unsafe_code)]
                    let mapped = unsafe { [file::map(&path), file::map_verified(&path)] };
                    mapped.into_iter().for_each(|mapped| assert_eq!(mapped.unwrap().proof(), proof));
                }
            }
        }
    }
}

/// A cube of facets whose upper face is lifted.
fn cracked(by: f64) -> TriangleMesh {
    let corner = |i: usize| [i & 1, i >> 1 & 1, i >> 2].map(|bit| 3.0 + 8.0 * bit as f64);
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let mut facets = vec![];
    for (f, [a, b, c, d]) in faces.into_iter().enumerate() {
        for triangle in [[a, b, c], [a, c, d]] {
            let lift = if f == 1 { by } else { 0.0 };
            facets.push(triangle.map(|i| {
                let [x, y, z] = corner(i);
                [x, y, z + lift]
            }));
        }
    }
    TriangleMesh::from_facets(facets).unwrap()
}

#[test]
fn displacements() {
    // The displacement of a mesh with sewn cracks.
    let mesh = cracked(1e-9).sewn().unwrap();
    let moved = mesh.displacement();
    assert!(moved > 0.0 && moved < 1e-8, "{moved}");
    let solid = MeshSolid::new(Arc::new(mesh), FillRule::NonZero).unwrap();
    for rule in RULES {
        let tree = build(&solid, &frame(4), rule, &CONTROL).unwrap();
        assert_eq!(tree.proof(), rule.proof(Proof::CERTIFIED).with_displacement(moved).unwrap());
    }
    let sewn = build(&solid, &frame(4), Rule::Certified, &CONTROL).unwrap();
    let exact = build(&Csg::ball([8.0; 3], 5.0).unwrap(), &frame(4), Rule::Certified, &CONTROL).unwrap();
    assert_eq!(exact.proof(), Proof::CERTIFIED);
    let far = exact.with_proof(Proof::CERTIFIED.with_displacement(0.25).unwrap());

    // The greatest displacement of the operands.
    for (a, b, greatest) in
        [(&sewn, &exact, moved), (&sewn, &far, 0.25), (&far, &exact, 0.25), (&exact, &exact, 0.0)]
    {
        let (a, b) = (a.view(), b.view());
        for operation in [union, intersection, difference, xor] {
            for tree in [operation(a, b, &CONTROL).unwrap(), operation(b, a, &CONTROL).unwrap()] {
                assert_eq!(tree.proof(), Proof::CERTIFIED.with_displacement(greatest).unwrap());
            }
        }
    }
    let part = Csg::solid(AnySolid::new(solid));
    let ball = Csg::ball([8.0; 3], 4.5).unwrap();
    for csg in [
        Csg::union_of([part.clone(), ball.clone()]).unwrap(),
        Csg::xor_of([ball.clone(), part.clone()]).unwrap(),
        ball.difference(&part).unwrap(),
        part.complement(),
    ] {
        assert_eq!(build(&csg, &frame(4), Rule::Certified, &CONTROL).unwrap().proof().displacement(), moved);
    }

    // Placements scale it, and never make it smaller than it is.
    for scale in [0.125, 1.0, 3.0] {
        for placed in [
            build(
                &Transform::of(far.clone(), &placement(scale, [0.5; 3])),
                &frame(4),
                Rule::Certified,
                &CONTROL,
            ),
            build(
                &Csg::solid(AnySolid::new(far.clone())).placed(&placement(scale, [0.5; 3])).unwrap(),
                &frame(4),
                Rule::Certified,
                &CONTROL,
            ),
        ] {
            let found = placed.unwrap().proof().displacement();
            assert!((0.25 * scale..=0.25 * scale * (1.0 + 1e-12)).contains(&found), "{found}");
        }
    }
    // For a shear, the bound exceeds the lengths of the columns.
    let shear = Affine::new([[1.0, 1.0, 1.0, 0.0], [0.0, 1.0, 1.0, 0.0], [0.0, 0.0, 1.0, 0.0]]).unwrap();
    let placed = build(&Transform::of(far, &shear), &frame(4), Rule::Certified, &CONTROL).unwrap();
    // The greatest singular value of the map is about 2.247.
    assert!((0.25 * 2.24..=0.25 * 3.01).contains(&placed.proof().displacement()));
}
