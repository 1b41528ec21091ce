//! Expressions of few half-spaces that occur more than once. The verdicts are those of truth tables.

use super::oracle::frames;
use super::points::{Found, Judge};
use leafless::solid::HalfSpace;
use leafless::{Affine, Cell, Classifier, Csg, Frame, Octree, Rule, Solid, Tag, Worker, build};
use leafless_testkit::csg::{Maker, Model};
use leafless_testkit::{Dense, Random, alone, lattice_frame, positions};

const RULES: [Rule; 4] = [Rule::Certified, Rule::Sampled, Rule::Inner, Rule::Outer];

fn built(csg: &Csg, frame: &Frame, rule: Rule) -> Octree {
    build(csg, frame, rule, &alone()).unwrap()
}

/// Asserts that an expression is decided as a whole, by its root and in all trees.
fn assert_decided(what: &str, csg: &Csg, tag: Tag) {
    for depth in 1..=4 {
        let frames = frames(depth);
        for frame in &frames[..2] {
            let mut worker = csg.on(frame, &alone()).unwrap().worker().unwrap();
            assert_eq!(worker.root().unwrap().tag(), tag, "{what}: the root on {frame:?}");
            for rule in RULES {
                assert_eq!(built(csg, frame, rule).view().root_tag(), tag, "{what}: {rule:?} on {frame:?}");
            }
        }
    }
}

/// Planes, balls, tori and boxes that cut the universes of the first two [`frames`] at every depth.
fn solids() -> Vec<(&'static str, Csg)> {
    let up = Affine::translation([0.25, 0.5, 0.125]).unwrap();
    let turned = Affine::new([[0.8, -0.6, 0.0, 0.3], [0.6, 0.8, 0.0, 0.2], [0.0, 0.0, 1.0, 0.1]]).unwrap();
    let cuboid = Csg::cuboid([0.1, -0.5, 0.25], [0.75, 0.6, 1.0]).unwrap();
    let cylinder = Csg::cylinder(0.6, 0.25, 0.8).unwrap();
    vec![
        ("plane", Csg::half_space([1.0, 2.0, -3.0], 0.25).unwrap()),
        ("plane of the lattice", Csg::half_space([0.0, 1.0, 0.0], -0.5).unwrap()),
        ("ball", Csg::ball([0.5; 3], 0.4).unwrap()),
        (
            "quadric",
            HalfSpace::quadric([1.0, -1.0, 0.5, 0.2, 0.0, -0.3, 0.0, 0.1, 0.0, -0.2]).unwrap().into(),
        ),
        ("torus", Csg::torus(0.6, 0.25).unwrap().placed(&up).unwrap()),
        ("spindle", Csg::torus(0.25, 0.6).unwrap()),
        ("box turned", cuboid.placed(&turned).unwrap()),
        ("box", cuboid),
        ("cylinder turned", cylinder.placed(&turned).unwrap()),
        ("cylinder", cylinder),
    ]
}

#[test]
fn a_solid_and_itself() {
    let identity = Affine::IDENTITY;
    let nothing_moved = Affine::translation([0.0; 3]).unwrap();
    for (name, a) in solids() {
        let not = a.complement();
        // Another node of the same half-spaces, as if from elsewhere.
        let again = Csg::union_of([a.clone()]).unwrap();
        let cases = [
            ("A minus A", a.difference(&a), Tag::Empty),
            ("A minus A again", a.difference(&again), Tag::Empty),
            ("A xor A", Csg::xor_of([a.clone(), a.clone()]), Tag::Empty),
            ("A xor not A", Csg::xor_of([a.clone(), not.clone()]), Tag::Full),
            ("A xor A xor all", Csg::xor_of([a.clone(), again, Csg::everything()]), Tag::Full),
            ("A union not A", Csg::union_of([a.clone(), not.clone()]), Tag::Full),
            ("A intersection not A", Csg::intersection_of([not, a.clone()]), Tag::Empty),
            ("A minus A placed by the identity", a.difference(&a.placed(&identity).unwrap()), Tag::Empty),
            ("A minus A moved by nothing", a.difference(&a.placed(&nothing_moved).unwrap()), Tag::Empty),
        ];
        for (what, csg, tag) in cases {
            assert_decided(&format!("{name}: {what}"), &csg.unwrap(), tag);
        }
        // An expression that equals A has the trees of A.
        let same = [
            Csg::union_of([a.clone(), a.clone()]).unwrap(),
            a.difference(&a.complement()).unwrap(),
            Csg::xor_of([a.clone(), a.clone(), a.clone()]).unwrap(),
            Csg::union_of([a.clone(), a.difference(&a).unwrap()]).unwrap(),
        ];
        for depth in 1..=4 {
            for frame in &frames(depth)[..2] {
                for rule in RULES {
                    let expected = Dense::of(built(&a, frame, rule).view());
                    for csg in &same {
                        let found = Dense::of(built(csg, frame, rule).view());
                        assert!(found == expected, "{name}: {rule:?} {frame:?}\n{found:?}\n{expected:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn boxes_that_share_a_face() {
    for depth in 1..=4u8 {
        let frame = lattice_frame(depth);
        let n = frame.cells() as f64;
        let [left, right, both] = [(0.0, 0.5 * n), (0.5 * n, n), (0.0, n)]
            .map(|(low, high)| Csg::cuboid([low, 0.0, 0.0], [high, n, 0.5 * n]).unwrap());
        let united = Csg::union_of([left.clone(), right.clone()]).unwrap();
        // The face lies on the lattice: the truth at every rule.
        for rule in RULES {
            let [united, both] = [&united, &both].map(|csg| Dense::of(built(csg, &frame, rule).view()));
            assert!(united == both, "{rule:?} {depth}");
        }
        let nothing = Csg::intersection_of([left, right]).unwrap();
        assert_eq!(
            Dense::of(built(&nothing, &frame, Rule::Certified).view()),
            Dense::uniform(depth, Tag::Empty)
        );
        // Off the lattice, by one half-space and its complement: no cell at the face is left open.
        let (low, high) = (0.25, n - 0.3);
        let whole = Csg::cuboid([low; 3], [high; 3]).unwrap();
        let faces = [
            Csg::half_space([1.0, 0.0, 0.0], -0.4 * n).unwrap(),
            Csg::half_space([0.3, -0.2, 1.0], -0.47 * n).unwrap(),
            Csg::ball([0.4 * n, 0.5 * n, 0.6 * n], 0.3 * n).unwrap(),
            Csg::from(HalfSpace::torus(0.3 * n, 0.2 * n).unwrap()),
        ];
        for face in faces {
            let side = |face: Csg| Csg::intersection_of([whole.clone(), face]).unwrap();
            let [a, b] = [side(face.clone()), side(face.complement())];
            let union = Csg::union_of([a.clone(), b.clone()]).unwrap();
            for rule in RULES {
                let [union, whole] = [&union, &whole].map(|csg| Dense::of(built(csg, &frame, rule).view()));
                assert!(union == whole, "{rule:?} {depth}\n{union:?}\n{whole:?}");
            }
            let common = Csg::intersection_of([a, b]).unwrap();
            let common = Dense::of(built(&common, &frame, Rule::Certified).view());
            assert!(common == Dense::uniform(depth, Tag::Empty), "{depth}");
        }
    }
}

/// An expression over numbered half-spaces.
#[derive(Debug)]
enum Tree {
    Leaf(usize),
    Not(Box<Tree>),
    Join(u64, Vec<Tree>),
}

impl Tree {
    fn random(random: &mut Random, half_spaces: usize, height: u32) -> Tree {
        match random.below(if height == 0 { 1 } else { 8 }) {
            0 => Tree::Leaf(random.below(half_spaces as u64) as usize),
            1 => Tree::Not(Box::new(Tree::random(random, half_spaces, height - 1))),
            code => {
                let count = 2 + random.below(2);
                let parts = (0..count).map(|_| Tree::random(random, half_spaces, height - 1)).collect();
                Tree::Join(code % 3, parts)
            }
        }
    }

    fn csg(&self, half_spaces: &[Csg]) -> Csg {
        match self {
            Tree::Leaf(i) => half_spaces[*i].clone(),
            Tree::Not(part) => part.csg(half_spaces).complement(),
            Tree::Join(join, parts) => {
                let parts = parts.iter().map(|part| part.csg(half_spaces));
                match join {
                    0 => Csg::union_of(parts),
                    1 => Csg::intersection_of(parts),
                    _ => Csg::xor_of(parts),
                }
                .unwrap()
            }
        }
    }

    fn model(&self, half_spaces: &[Model]) -> Model {
        match self {
            Tree::Leaf(i) => half_spaces[*i].clone(),
            Tree::Not(part) => Model::Complement(Box::new(part.model(half_spaces))),
            Tree::Join(join, parts) => {
                let parts = parts.iter().map(|part| part.model(half_spaces)).collect();
                match join {
                    0 => Model::Union(parts),
                    1 => Model::Intersection(parts),
                    _ => Model::Xor(parts),
                }
            }
        }
    }

    fn leaves(&self) -> usize {
        match self {
            Tree::Leaf(_) => 1,
            Tree::Not(part) => part.leaves(),
            Tree::Join(_, parts) => parts.iter().map(Tree::leaves).sum(),
        }
    }

    fn value(&self, inside: u32) -> bool {
        match self {
            Tree::Leaf(i) => inside >> i & 1 != 0,
            Tree::Not(part) => !part.value(inside),
            Tree::Join(0, parts) => parts.iter().any(|part| part.value(inside)),
            Tree::Join(1, parts) => parts.iter().all(|part| part.value(inside)),
            Tree::Join(_, parts) => parts.iter().fold(false, |odd, part| odd ^ part.value(inside)),
        }
    }

    /// Returns the value for all choices of the undecided half-spaces.
    fn tag(&self, tags: &[Tag]) -> Tag {
        let mut seen = [false; 2];
        for inside in 0..1u32 << tags.len() {
            let possible = (0..tags.len()).all(|i| match tags[i] {
                Tag::Full => inside >> i & 1 != 0,
                Tag::Empty => inside >> i & 1 == 0,
                _ => true,
            });
            if possible {
                seen[self.value(inside) as usize] = true;
            }
        }
        match seen {
            [true, false] => Tag::Empty,
            [false, true] => Tag::Full,
            _ => Tag::Partial,
        }
    }
}

/// A random primitive with a single half-space.
fn half_space(maker: &mut Maker<'_>) -> Model {
    loop {
        let model = match maker.below(4) {
            0 => maker.plane(),
            1 => maker.quadric(false),
            2 => maker.power(),
            _ => maker.primitive(),
        };
        let single = match &model {
            Model::Placed(part, _) => matches!(**part, Model::Torus(..)),
            Model::Plane(..) | Model::Quadric(..) | Model::Power(..) | Model::Ellipsoid(..) => true,
            _ => false,
        };
        if single {
            return model;
        }
    }
}

/// Compares verdicts of the universe, cell by cell as far as the splits go. They are at least as tight as all
/// independent choices of the undecided half-spaces allow, and never contradict exact arithmetic.
#[test]
fn random_expressions_of_few_half_spaces() {
    let (mut tighter, mut found, mut made) = (0, Found::default(), 0);
    for seed in 0..400 {
        let mut random = Random(seed ^ 0x7AB1E);
        let depth = 1 + random.below(4) as u8;
        let frame = frames(depth)[random.below(5) as usize];
        let aligned = random.below(2) == 0;
        let count = 1 + random.below(6) as usize;
        let mut maker = Maker { random: &mut random, frame, aligned, others: false };
        let models: Vec<Model> = (0..count).map(|_| half_space(&mut maker)).collect();
        let Ok(half_spaces) = models.iter().map(|model| model.csg(&frame)).collect::<Result<Vec<_>, _>>()
        else {
            continue;
        };
        let tree = Tree::random(&mut random, count, 3);
        // Longer expressions have no table until they are reduced.
        if tree.leaves() > 24 {
            continue;
        }
        made += 1;
        let (csg, model) = (tree.csg(&half_spaces), tree.model(&models));
        let octree = built(&csg, &frame, Rule::Certified);
        let dense = Dense::of(octree.view());
        let alone = half_spaces.iter().map(|part| Dense::of(built(part, &frame, Rule::Certified).view()));
        let alone: Vec<Dense> = alone.collect();
        // By Kleene's logic, for comparison.
        let kleene = kleene_of(&tree, &alone);
        for (i, at) in positions(depth).enumerate() {
            let tags: Vec<Tag> = alone.iter().map(|dense| dense.tags[i]).collect();
            let (expected, tag) = (tree.tag(&tags), dense.tags[i]);
            assert!(
                tag == expected || expected == Tag::Partial,
                "{at:?} {tag:?}, not {expected:?}\n{frame:?}\n{tree:#?}\n{models:#?}"
            );
            tighter += (tag != kleene.tags[i]) as u64;
            assert!(tag == kleene.tags[i] || kleene.tags[i] == Tag::Partial);
        }
        // The root decides expressions that no half-space affects.
        if tree.tag(&vec![Tag::Partial; count]) != Tag::Partial {
            let mut worker = csg.on(&frame, &leafless_testkit::alone()).unwrap().worker().unwrap();
            assert_ne!(worker.root().unwrap().tag(), Tag::Partial, "{tree:#?}");
            assert_eq!(dense.tag_of(Cell::ROOT), Some(dense.tags[0]));
        }
        let mut judge = Judge { model: &model, tree: &octree, bounds: csg.bounds(), found };
        judge.ask(40, &mut random);
        found = judge.found;
    }
    println!("{made} expressions, {tighter} cells tighter than Kleene: {found:?}");
    assert!(made > 250 && tighter > 1000, "{made} {tighter}");
    assert!(found.inside > 1000 && found.outside > 1000 && found.decided > 1000, "{found:?}");
}

fn kleene_of(tree: &Tree, alone: &[Dense]) -> Dense {
    match tree {
        Tree::Leaf(i) => alone[*i].clone(),
        Tree::Not(part) => kleene_of(part, alone).complement(),
        Tree::Join(join, parts) => {
            let op: fn(bool, bool) -> bool = [|a, b| a | b, |a, b| a & b, |a, b| a ^ b][*join as usize];
            parts.iter().map(|part| kleene_of(part, alone)).reduce(|a, b| a.combine(&b, op)).unwrap()
        }
    }
}
