//! Set operations of extended octrees against exact arithmetic.

use super::extended::{extended, is_given_up, plate, points, through_a_file};
use super::oracle::frames;
use leafless::op::{difference_of, intersection_of, union_of, xor_of};
use leafless::{
    Affine, Control, Csg, Error, FillRule, Frame, Membership, MeshSolid, Octree, Rule, Solid, SurfaceOptions,
    Tag, TriangleMesh, build, build_extended, complement, contains, difference, intersection, measure, union,
    xor,
};
use leafless_testkit::csg::{Maker, Model};
use leafless_testkit::{Random, alone, repeated};

/// A solid in two forms: a model and an octree.
#[derive(Clone)]
struct Pair {
    model: Model,
    tree: Octree,
}

impl Pair {
    fn view(&self) -> &leafless::OctreeRef<'_> {
        self.tree.view()
    }
}

/// Solids that interact: some are parts of others, or touch them.
fn pool(maker: &mut Maker<'_>, count: usize) -> Vec<Pair> {
    let frame = maker.frame;
    let mut pool: Vec<Pair> = Vec::new();
    while pool.len() < count {
        let model = match maker.below(4) {
            0 => maker.half_space(),
            1 | 2 => maker.primitive(),
            _ => maker.expression(2),
        };
        let Ok(csg) = model.csg(&frame) else { continue };
        // Some take part as certified octrees.
        let tree = if maker.below(6) == 0 {
            build(&csg, &frame, Rule::Certified, &alone()).unwrap()
        } else {
            match build_extended(&csg, &frame, &SurfaceOptions::default(), &alone()) {
                Ok(tree) => tree,
                Err(leafless::Error::Limit { .. }) => continue,
                Err(error) => panic!("{error}"),
            }
        };
        pool.push(Pair { model, tree });
    }
    pool
}

/// Applies a random operation to some solids of the pool.
fn operation(pool: &[Pair], random: &mut Random, threads: usize) -> Pair {
    let mut pick = |_| pool[random.below(pool.len() as u64) as usize].clone();
    let [a, b] = [0, 1].map(&mut pick);
    let many: Vec<Pair> = (0..5).map(&mut pick).collect();
    let many = &many[..1 + random.below(5) as usize];
    let views: Vec<_> = many.iter().map(|pair| *pair.view()).collect();
    let models = || many.iter().map(|pair| pair.model.clone()).collect::<Vec<_>>();
    let control = Control::threads(threads);
    let (model, tree) = match random.below(9) {
        0 => (Model::Union(vec![a.model.clone(), b.model.clone()]), union(a.view(), b.view(), &control)),
        1 => (
            Model::Intersection(vec![a.model.clone(), b.model.clone()]),
            intersection(a.view(), b.view(), &control),
        ),
        2 => (
            Model::Difference(Box::new([a.model.clone(), b.model.clone()])),
            difference(a.view(), b.view(), &control),
        ),
        3 => (Model::Xor(vec![a.model.clone(), b.model.clone()]), xor(a.view(), b.view(), &control)),
        4 => (Model::Complement(Box::new(a.model.clone())), complement(a.view(), &control)),
        5 => (Model::Union(models()), union_of(&views, &control)),
        6 => (Model::Intersection(models()), intersection_of(&views, &control)),
        7 => (Model::Xor(models()), xor_of(&views, &control)),
        _ => {
            let rest = Model::Union(models()[1..].to_vec());
            (Model::Difference(Box::new([models()[0].clone(), rest])), difference_of(&views, &control))
        }
    };
    Pair { model, tree: tree.unwrap() }
}

/// True if a tree has cells that were given up.
fn gave_up(tree: &Octree) -> bool {
    match tree.view().cuts() {
        Some(cuts) => cuts.given_up > 0,
        None => !tree.view().is_binary(),
    }
}

fn no_lies(rounds: u64, height: usize, count: usize) {
    let (mut decided, mut undecided, mut cells, mut given_up, mut empty) = (0u64, 0u64, 0, 0, 0);
    for seed in 0..rounds {
        let mut random = Random(seed ^ 0xB001);
        let frame = frames(2 + random.below(6) as u8)[random.below(5) as usize];
        let aligned = random.below(2) == 0;
        let mut maker = Maker { random: &mut random, frame, aligned, others: false };
        let mut pool = pool(&mut maker, 4);
        for _ in 0..height {
            let own = operation(&pool, &mut random, 1 + (seed % 2) as usize * 2);
            own.view().check().unwrap();
            pool.push(own);
        }
        let Pair { model, tree } = pool.pop().unwrap();
        let tree = through_a_file(&tree);
        let cuts = tree.view().cuts().unwrap_or_default();
        (cells, given_up) = (cells + cuts.cells, given_up + cuts.given_up);
        empty += u64::from([Tag::Empty, Tag::Full].contains(&tree.view().root_tag()));
        let asked = points(&model, &frame, count, &mut random);
        let places: Vec<[f64; 3]> = asked.iter().map(|&(p, _)| p).collect();
        let mut answers = vec![Membership::Undecided; places.len()];
        contains(&tree, &frame, &places, &mut answers, &alone()).unwrap();
        let mut blunt = answers.clone();
        contains(&tree.without_cuts(), &frame, &places, &mut blunt, &alone()).unwrap();
        for ((&(p, sign), answer), blunt) in asked.iter().zip(answers).zip(blunt) {
            for answer in [answer, blunt] {
                match answer {
                    Membership::Inside => assert!(sign >= 0, "{p:?} is outside\n{frame:?}\n{model:#?}"),
                    Membership::Outside => assert!(sign <= 0, "{p:?} is inside\n{frame:?}\n{model:#?}"),
                    Membership::Undecided => {}
                }
            }
            if answer == Membership::Undecided {
                assert!(is_given_up(&tree, p), "{p:?}\n{frame:?}\n{model:#?}");
                undecided += 1;
            } else {
                decided += 1;
            }
        }
    }
    println!(
        "{decided} points decided, {undecided} not; {cells} cells, {given_up} given up, {empty} of {rounds} trees empty or full"
    );
    // (Operands without surfaces give up all cells along their boundary, where most points are.)
    assert!(decided > undecided && cells > rounds && 3 * empty < 2 * rounds);
}

#[test]
fn combined_trees_do_not_lie() {
    no_lies(150, 1, 60);
    no_lies(150, 3, 60);
    no_lies(150, 6, 60);
}

#[test]
#[ignore = "some minutes"]
fn a_million_points_of_combined_trees() {
    no_lies(3000, 1, 120);
    no_lies(3000, 3, 120);
    no_lies(3000, 6, 120);
}

/// Asserts that all stored data are equal.
fn assert_same(a: &Octree, b: &Octree, what: &str) {
    assert_eq!(a.view().cuts(), b.view().cuts(), "{what}");
    assert_eq!((a, Solid::fingerprint(a)), (b, Solid::fingerprint(b)), "{what}");
    assert_eq!(a.proof(), b.proof(), "{what}");
}

/// The laws of sets: laws that hold byte for byte, and laws that hold where no cell was given up.
#[test]
fn laws_of_sets() {
    let (mut whole, mut cells, mut compared) = (0, 0, 0);
    for seed in 0..150 {
        let mut random = Random(seed ^ 0x1A35);
        let frame = frames(3 + random.below(5) as u8)[random.below(5) as usize];
        let mut maker = Maker { random: &mut random, frame, aligned: seed % 2 == 0, others: false };
        let mut pool = pool(&mut maker, 3);
        if seed % 3 == 0 {
            let own = operation(&pool, &mut random, 1);
            pool[0] = own;
        }
        let [a, b, c] = [0, 1, 2].map(|i| pool[i].view());
        let control = alone();
        let what = format!("{seed}: {:#?}\n{:#?}", pool[0].model, pool[1].model);
        let not = |a: &leafless::OctreeRef<'_>| complement(a, &control).unwrap();
        let [or, and, but, either] = [union, intersection, difference, xor].map(|op| {
            move |a: &leafless::OctreeRef<'_>, b: &leafless::OctreeRef<'_>| op(a, b, &alone()).unwrap()
        });
        cells += a.cuts().unwrap_or_default().cells;
        // Byte for byte.
        let same_bytes =
            |law: &str, own: &Octree, other: &Octree| assert_same(own, other, &format!("{law}, {what}"));
        same_bytes("A ∪ B is B ∪ A", &or(a, b), &or(b, a));
        same_bytes("A ∩ B is B ∩ A", &and(a, b), &and(b, a));
        same_bytes("A xor B is B xor A", &either(a, b), &either(b, a));
        same_bytes("A ∪ A is A", &or(a, a), &pool[0].tree);
        same_bytes("A ∩ A is A", &and(a, a), &pool[0].tree);
        same_bytes("¬¬A is A", &not(not(a).view()), &pool[0].tree);
        same_bytes(
            "the union of A, A and A is A",
            &union_of(&[*a, *a, *a], &control).unwrap(),
            &pool[0].tree,
        );
        same_bytes("the union of A is A", &union_of(&[*a], &control).unwrap(), &pool[0].tree);
        same_bytes("de Morgan", &not(or(not(a).view(), not(b).view()).view()), &and(a, b));
        same_bytes("A ∖ B is A ∩ ¬B", &and(a, not(b).view()), &but(a, b));
        for (n_ary, pairs) in [
            (union_of(&[*a, *b], &control), or(a, b)),
            (intersection_of(&[*a, *b], &control), and(a, b)),
            (difference_of(&[*a, *b], &control), but(a, b)),
            (xor_of(&[*a, *b], &control), either(a, b)),
        ] {
            same_bytes("two are a pair", &n_ary.unwrap(), &pairs);
        }
        for (order, other) in [([*a, *b, *c], [*c, *a, *b]), ([*a, *c, *b], [*b, *c, *a])] {
            for op in [union_of, intersection_of, xor_of] {
                same_bytes(
                    "the order does not count",
                    &op(&order, &control).unwrap(),
                    &op(&other, &control).unwrap(),
                );
            }
        }
        let everything = [Tag::Empty, Tag::Full].map(|tag| Octree::uniform(frame, tag, tag).unwrap());
        for (own, other) in [
            (or(a, everything[0].view()), &pool[0].tree),
            (and(a, everything[1].view()), &pool[0].tree),
            (and(a, everything[0].view()), &everything[0]),
            (or(everything[1].view(), a), &everything[1]),
        ] {
            same_bytes("nothing and everything", &own, other);
        }
        // As sets, where no cell was given up.
        if gave_up(&pool[0].tree) {
            continue;
        }
        whole += 1;
        for (own, tag) in [
            (but(a, a), Tag::Empty),
            (either(a, a), Tag::Empty),
            (and(a, not(a).view()), Tag::Empty),
            (or(a, not(a).view()), Tag::Full),
            (either(a, not(a).view()), Tag::Full),
        ] {
            assert_eq!(own.view().root_tag(), tag, "{what}");
            assert!(own.view().cuts().is_none());
        }
        // Absorption, distribution and association leave no point that lies in one and not in the other.
        let mut same = |law: &str, a: Octree, b: Octree| {
            if !gave_up(&a) && !gave_up(&b) {
                let odd = xor(a.view(), b.view(), &alone()).unwrap();
                // Some cells may have functions that differ for combinations of signs that do not occur
                // there. Smaller cells show this.
                let control = Control { max_splits: Some(4000), ..alone() };
                let volume = measure(&odd, &frame, 0.0, &control).map(|m| m.volume);
                let size = frame.edge().powi(3);
                if let Ok(volume) = volume
                    && !gave_up(&odd)
                {
                    compared += 1;
                    assert!(
                        volume.lower <= 1e-12 * size && volume.upper < 0.01 * size,
                        "{law}: {volume:?}\n{what}"
                    );
                }
            }
        };
        same("or absorbs", or(a, and(a, b).view()), pool[0].tree.clone());
        same("and absorbs", and(a, or(a, b).view()), pool[0].tree.clone());
        same("or associates", or(or(a, b).view(), c), or(a, or(b, c).view()));
        same("and associates", and(and(a, b).view(), c), and(a, and(b, c).view()));
        same("xor associates", either(either(a, b).view(), c), either(a, either(b, c).view()));
        same("and distributes", and(a, or(b, c).view()), or(and(a, b).view(), and(a, c).view()));
        same("union of three", union_of(&[*a, *b, *c], &control).unwrap(), or(or(a, b).view(), c));
        same(
            "difference of three",
            difference_of(&[*a, *b, *c], &control).unwrap(),
            but(but(a, b).view(), c),
        );
    }
    assert!(whole > 30 && cells > 500 && compared > 100, "{whole} {cells} {compared}");
}

/// Any number of threads makes the same tree.
#[test]
fn threads_do_not_show() {
    let frame = Frame::new([0.0; 3], 64.0, 12).unwrap();
    let mut random = Random(0x7EAD);
    let mut ball = || {
        let centre = [0; 3].map(|_| random.between(8.0, 56.0));
        extended(&Csg::ball(centre, random.between(2.0, 6.0)).unwrap(), &frame)
    };
    let balls: Vec<Octree> = (0..400).map(|_| ball()).collect();
    let views: Vec<_> = balls.iter().map(|ball| *ball.view()).collect();
    let of = |threads: usize| {
        let control = Control::threads(threads);
        let some = union_of(&views[..250], &control).unwrap();
        let others = xor_of(&views[200..], &control).unwrap();
        let both = difference(some.view(), others.view(), &control).unwrap();
        (some, others, both)
    };
    let one = of(1);
    // So many that threads pay off.
    assert!(one.2.view().cuts().unwrap().cells > 8192, "{:?}", one.2.view().cuts());
    for threads in [2, 3] {
        assert!(of(threads) == one);
    }
}

/// Cuts that are made and filled again leave nothing behind.
#[test]
fn memory_does_not_grow_with_history() {
    let frame = Frame::around([0.0; 3], [80.0, 60.0, 10.0], 20).unwrap();
    let fresh = extended(&plate(), &frame);
    let mut part = fresh.clone();
    let mut random = Random(0x4157);
    let blank = extended(&Csg::cuboid([0.0; 3], [80.0, 60.0, 10.0]).unwrap(), &frame);
    for round in 0..repeated(2_000, 10_000) {
        let to = Affine::translation([random.between(0.0, 80.0), random.between(0.0, 60.0), 0.0]).unwrap();
        let bore = Csg::cylinder(random.between(0.5, 4.0), -1.0, 11.0).unwrap().placed(&to).unwrap();
        let bore = extended(&bore, &frame);
        let before = part.clone();
        part = difference(part.view(), bore.view(), &alone()).unwrap();
        // The part removed by the bore comes back.
        let chip = intersection(before.view(), bore.view(), &alone()).unwrap();
        part = union(part.view(), chip.view(), &alone()).unwrap();
        assert_same(&part, &fresh, &format!("round {round}"));
    }
    // The same in one operation.
    let whole = union(part.view(), blank.view(), &alone()).unwrap();
    assert_same(&whole, &blank, "all bores are filled");
}

/// The documentation's example: a plate, and twenty bores one by one.
#[test]
fn twenty_bores_one_by_one() {
    let frame = Frame::around([0.0; 3], [80.0, 60.0, 10.0], 20).unwrap();
    let mut part = extended(&Csg::cuboid([0.0; 3], [80.0, 60.0, 10.0]).unwrap(), &frame);
    let tool = Csg::cylinder(2.5, -1.0, 11.0).unwrap();
    let mut bores = Vec::new();
    for k in 0..20 {
        let to = [8.0 + 16.0 * f64::from(k % 5), 7.5 + 15.0 * f64::from(k / 5), 0.0];
        let bore = extended(&tool.clone().placed(&Affine::translation(to).unwrap()).unwrap(), &frame);
        part = difference(part.view(), bore.view(), &alone()).unwrap();
        bores.push(bore);
    }
    let fresh = extended(&plate(), &frame);
    assert_same(&part, &fresh, "one by one");
    let blank = extended(&Csg::cuboid([0.0; 3], [80.0, 60.0, 10.0]).unwrap(), &frame);
    let views: Vec<_> = [&blank].into_iter().chain(&bores).map(|tree| *tree.view()).collect();
    assert_same(&difference_of(&views, &alone()).unwrap(), &fresh, "at once");
    let truth = 48_000.0 - 20.0 * core::f64::consts::PI * 6.25 * 10.0;
    let volume = measure(&part, &frame, 1e-6, &alone()).unwrap().volume;
    assert!(volume.contains(truth) && volume.width() < 1.01e-6 * truth);
}

/// Forty balls cut out of a block. One touches the block, and one cuts nothing.
fn cut_block() -> (Frame, Vec<Octree>) {
    let frame = Frame::new([-1.0; 3], 2.0, 9).unwrap();
    let block = extended(&Csg::cuboid([-0.75; 3], [0.75; 3]).unwrap(), &frame);
    let balls = (0..40).map(|k| {
        let turn = 0.5 * f64::from(k);
        let centre = [0.6 * turn.cos(), 0.6 * turn.sin(), 0.04 * f64::from(k) - 0.8];
        extended(&Csg::ball(centre, 0.27).unwrap(), &frame)
    });
    let others = [([0.0, 0.0, 1.0], 0.25), ([0.9, 0.9, 0.9], 0.05)];
    let others = others.map(|(centre, radius)| extended(&Csg::ball(centre, radius).unwrap(), &frame));
    (frame, [block].into_iter().chain(balls).chain(others).collect())
}

/// Limits and cancels end the work with an error, at any point. A tree made afterwards is the same as before.
#[test]
fn limits_and_cancels_are_errors() {
    use core::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};
    let (_, trees) = cut_block();
    let views: Vec<_> = trees.iter().map(|tree| *tree.view()).collect();
    let whole = difference_of(&views, &alone()).unwrap();
    let nodes = whole.statistics().nodes();
    assert!(nodes > 50, "{nodes}");
    for threads in [1, 2] {
        for max_nodes in [0, 1, nodes / 2, nodes - 1] {
            let control = Control { max_nodes: Some(max_nodes), ..Control::threads(threads) };
            let refused = difference_of(&views, &control);
            assert!(matches!(refused, Err(Error::Limit { what: "nodes", .. })), "{max_nodes}: {refused:?}");
        }
        let enough = Control { max_nodes: Some(nodes), ..Control::threads(threads) };
        assert_eq!(difference_of(&views, &enough).unwrap(), whole);
        for max_bytes in [0, 1000] {
            let control = Control { max_bytes: Some(max_bytes), ..Control::threads(threads) };
            assert!(matches!(difference_of(&views, &control), Err(Error::Limit { .. })));
        }
        let mut ended = 0;
        for after in 0..20 {
            let (cancel, left) = (AtomicBool::new(false), AtomicUsize::new(after));
            let progress = |_: f64| {
                let is_last = left.fetch_update(Relaxed, Relaxed, |left| left.checked_sub(1)).is_err();
                cancel.fetch_or(is_last, Relaxed);
            };
            let control =
                Control { cancel: Some(&cancel), progress: Some(&progress), ..Control::threads(threads) };
            match difference_of(&views, &control) {
                Ok(tree) => assert_eq!(tree, whole),
                Err(Error::Cancelled) => ended += 1,
                Err(error) => panic!("{error}"),
            }
        }
        assert!(ended > 3, "{ended}");
        assert_eq!(difference_of(&views, &Control::threads(threads)).unwrap(), whole);
    }
    // Surfaces that nearly coincide, so that bounds do not separate them, and that cross more than three at a
    // time along a whole curve, do not circumvent the limit.
    let frame = Frame::new([-1.0; 3], 2.0, 20).unwrap();
    let lens = |off: f64| {
        let [one, other] = [-0.3, 0.3].map(|x| {
            Csg::torus(0.5, 0.3).unwrap().placed(&Affine::translation([x + off, 0.0, 0.0]).unwrap()).unwrap()
        });
        extended(&Csg::intersection_of([one, other]).unwrap(), &frame)
    };
    let [a, b] = [lens(0.0), lens(1e-7)];
    let control = Control { max_bytes: Some(1 << 16), ..alone() };
    let refused = difference(a.view(), b.view(), &control);
    assert!(
        matches!(refused, Err(Error::Limit { what: "bytes", .. })),
        "{:?}",
        refused.map(|tree| tree.view().cuts())
    );
}

/// Every function from trees with surfaces to trees keeps the surfaces, or reports that it does not.
#[test]
fn nothing_drops_surfaces_in_silence() {
    use leafless::attribute::{
        CarryRule, ConstantAttribute, FillOptions, ScalarType, ValueType, carry_channels, fill_channel,
    };
    use leafless::solid::Transform;
    use leafless::{AnySolid, Metadata, Proof, compact, file, op};
    let (frame, trees) = cut_block();
    let views: Vec<_> = trees.iter().map(|tree| *tree.view()).collect();
    let (part, control) = (difference_of(&views, &alone()).unwrap(), alone());
    let [nothing, everything] = [Tag::Empty, Tag::Full].map(|tag| Octree::uniform(frame, tag, tag).unwrap());
    // A large plain tree and a small tree that keeps surfaces: runs of the large one and cells of the small
    // one are copied.
    let far = Csg::ball([0.0, 0.0, -0.2], 0.7).unwrap();
    let plain = build(&far, &frame, Rule::Certified, &control).unwrap();
    let folder = std::env::temp_dir().join(format!("leafless-combined-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("part.lfl");
    file::save(&part, &path).unwrap();
    // SAFETY: nobody changes the file.
    let mapped = unsafe { file::map(&path) }.unwrap();
    let options = SurfaceOptions::default();
    let solid = |solid: &dyn Fn() -> Csg| build_extended(&solid(), &frame, &options, &control).unwrap();
    let with_channel = {
        let value_type = ValueType::new(ScalarType::U8, 1).unwrap();
        let options =
            FillOptions { value_type, frame: frame.with_depth(4).unwrap(), solid: None, detail: None };
        let channel = fill_channel(&ConstantAttribute::new(&[3.0]).unwrap(), &options, &control).unwrap();
        part.with_channel(channel.with_name("value")).unwrap()
    };
    let other = with_channel.with_metadata(Metadata::default());
    let same: Vec<(&str, Octree)> = vec![
        ("clone", part.clone()),
        ("proof", part.with_proof(Proof::new(false, false)).with_proof(part.proof())),
        ("metadata", part.with_metadata(Metadata::default())),
        ("channel", with_channel.clone()),
        ("without channels", with_channel.without_channels()),
        (
            "carried channels",
            carry_channels(&part, &[&with_channel, &other], |_| CarryRule::Left, &control).unwrap(),
        ),
        ("compact", compact(part.view()).unwrap()),
        ("file", through_a_file(&part)),
        ("mapped", mapped.clone()),
        ("union with itself, mapped", union(mapped.view(), part.view(), &control).unwrap()),
        ("union with nothing", union(part.view(), nothing.view(), &control).unwrap()),
        ("intersection with everything", intersection(everything.view(), part.view(), &control).unwrap()),
        ("complement", complement(complement(part.view(), &control).unwrap().view(), &control).unwrap()),
        ("difference from everything", {
            let rest = difference(everything.view(), part.view(), &control).unwrap();
            xor(rest.view(), everything.view(), &control).unwrap()
        }),
        ("union of one", union_of(&[*part.view()], &control).unwrap()),
        ("built of it", build_extended(&part, &frame, &options, &control).unwrap()),
        ("built of an expression", solid(&|| Csg::solid(AnySolid::new(part.clone())))),
        (
            "built of a complement",
            solid(&|| Csg::solid(AnySolid::new(part.clone())).complement().complement()),
        ),
        ("built of a transform", {
            let identity = Affine::translation([0.0; 3]).unwrap();
            let moved = Transform::new(part.clone(), &frame, &identity);
            build_extended(&moved, &frame, &options, &control).unwrap()
        }),
    ];
    let volume = |tree: &Octree| measure(tree, &frame, 1e-4, &control).unwrap().volume;
    let truth = volume(&part);
    for (name, tree) in &same {
        tree.view().check().unwrap();
        let cuts = tree.view().cuts().unwrap_or_default();
        assert_eq!(cuts.surfaces, part.view().cuts().unwrap().surfaces, "{name}");
        // (An equal tree gives the same answers.)
        if tree == &part && repeated(true, false) {
            continue;
        }
        let own = volume(tree);
        assert!(
            own.lower <= truth.upper && own.upper >= truth.lower && own.width() < 2e-4,
            "{name}: {own:?}"
        );
    }
    // Copied runs of one tree beside surfaces of another.
    let both = union(plain.view(), part.view(), &control).unwrap();
    let rest = difference(both.view(), plain.view(), &control).unwrap();
    assert!(both.view().cuts().unwrap().surfaces > 20 && rest.view().cuts().unwrap().surfaces > 20);
    both.view().check().unwrap();
    rest.view().check().unwrap();
    for rule in [Rule::Inner, Rule::Outer, Rule::Certified, Rule::Sampled] {
        assert!(matches!(op::resolve(part.view(), rule, &control), Err(Error::Argument { .. })));
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Slabs are equal only if they have the same origin. The sets within the widths of two slabs may differ.
#[test]
fn meshes_that_differ_within_a_slab() {
    let frame = Frame::new([-1.013, -1.017, -1.009], 2.0, 7).unwrap();
    let pyramid = |height: f64| {
        let vertices =
            vec![[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [-0.5, 0.5, 0.0], [0.0, 0.0, height]];
        let triangles = vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 2, 1], [0, 3, 2]];
        let mesh = TriangleMesh::new(vertices, triangles).unwrap();
        let options = SurfaceOptions { tolerance: Some(0.05) };
        build_extended(&MeshSolid::new(mesh, FillRule::NonZero).unwrap(), &frame, &options, &alone()).unwrap()
    };
    // (Layers are wider than the rounding of their corners by more than this.)
    let [a, same, b] = [pyramid(0.7), pyramid(0.7), pyramid(0.7 + 2e-14)];
    assert!(a.view().cuts().unwrap().surfaces >= 5);
    let rest = |a: &Octree, b: &Octree| difference(a.view(), b.view(), &alone()).unwrap();
    let none = rest(&a, &same);
    let given_up = |tree: &Octree| tree.view().cuts().map_or(0, |cuts| cuts.given_up);
    // With the same origin, all cells vanish except those that were given up.
    assert!(none.view().cuts().is_none_or(|cuts| cuts.cells == 0) && given_up(&none) <= given_up(&a));
    // Between the two tips, the set is unknown.
    let tip = [0.0, 0.0, 0.7 + 1e-14];
    for (a, b, truth) in [(&a, &b, Membership::Outside), (&b, &a, Membership::Inside)] {
        let rest = rest(a, b);
        rest.view().check().unwrap();
        assert!(rest.view().root_tag() != Tag::Empty && rest.view().cuts().unwrap().cells > 0);
        let mut answers = [Membership::Outside; 2];
        contains(&rest, &frame, &[tip, [0.1, 0.05, 0.56]], &mut answers, &alone()).unwrap();
        assert!(answers[0] == truth || answers[0] == Membership::Undecided, "{answers:?}");
        assert_eq!(answers[1], Membership::Undecided);
    }
    // Trees of one table share its slabs, even for solids without a fingerprint.
    let itself = union(a.view(), a.view(), &alone()).unwrap();
    assert_same(&itself, &a, "A ∪ A is A");
}
