//! Laws of extended octrees that do not depend on their sources.

use super::oracle::frames;
use leafless::solid::{Ask, AskWhole, Parts, Question, Transform, WholeQuestion};
use leafless::{
    Affine, AnySolid, Callback, Cell, Classifier, Control, Csg, Error, FillRule, Frame, Membership,
    MeshSolid, Octree, Rule, Solid, SurfaceOptions, TriangleMesh, Verdict, Worker, build, build_extended,
    contains,
};
use leafless_testkit::csg::Maker;
use leafless_testkit::{Random, alone};

fn cuboid_mesh(min: [f64; 3], max: [f64; 3]) -> TriangleMesh {
    let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 != 0 { max[axis] } else { min[axis] });
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriangleMesh::new((0..8).map(corner).collect(), triangles).unwrap()
}

/// A pyramid over the square [−half, half]², with its tip at a height.
fn pyramid_mesh(half: f64, height: f64) -> TriangleMesh {
    let vertices = vec![
        [-half, -half, 0.0],
        [half, -half, 0.0],
        [half, half, 0.0],
        [-half, half, 0.0],
        [0.0, 0.0, height],
    ];
    TriangleMesh::new(vertices, vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 2, 1], [0, 3, 2]])
        .unwrap()
}

fn of_mesh(mesh: TriangleMesh) -> Csg {
    Csg::solid(AnySolid::new(MeshSolid::new(mesh, FillRule::NonZero).unwrap()))
}

/// Returns a lower bound of a point's depth in a box; outside, the negative of a lower bound of its distance.
fn depth(p: [f64; 3], [min, max]: [[f64; 3]; 2]) -> f64 {
    (0..3).map(|axis| (p[axis] - min[axis]).min(max[axis] - p[axis])).fold(f64::INFINITY, f64::min)
}

/// A rib, a groove and a tip thinner than the tolerance. Slabs on both sides of a cell overlap, and no point
/// is decided wrongly. All points further than twice the tolerance from the faces are decided.
#[test]
fn what_is_thinner_than_the_tolerance_does_not_vanish() {
    let block = [[0.0; 3], [1.0, 1.0, 0.5]];
    let thin = [[0.31, -0.2, -0.2], [0.314, 1.2, 0.8]];
    let base = || of_mesh(cuboid_mesh(block[0], block[1]));
    let other = || of_mesh(cuboid_mesh(thin[0], thin[1]));
    type Truth = fn(f64, f64) -> f64;
    let parts: [(&str, Csg, Truth); 3] = [
        ("rib", Csg::union_of([base(), other()]).unwrap(), f64::max),
        ("groove", base().difference(&other()).unwrap(), |own, other| own.min(-other)),
        ("blade", Csg::intersection_of([base(), other()]).unwrap(), f64::min),
    ];
    let frame = Frame::new([-0.517, -0.523, -0.531], 2.1, 8).unwrap();
    let mut random = Random(0x71B);
    for (name, part, truth) in parts {
        for tolerance in [0.1, 0.02] {
            let options = SurfaceOptions { tolerance: Some(tolerance) };
            let tree = build_extended(&part, &frame, &options, &alone()).unwrap();
            tree.view().check().unwrap();
            let points: Vec<[f64; 3]> = (0..20_000)
                .map(|k| {
                    let mut p = [0; 3].map(|_| random.between(-0.3, 1.3));
                    if k % 2 == 0 {
                        p[0] = 0.312 + random.between(-2.0, 2.0) * 0.004;
                    }
                    p
                })
                .collect();
            let mut answers = vec![Membership::Undecided; points.len()];
            contains(&tree, &frame, &points, &mut answers, &alone()).unwrap();
            let mut known = 0;
            for (&p, answer) in points.iter().zip(answers) {
                let depths = [depth(p, block), depth(p, thin)];
                let own = truth(depths[0], depths[1]);
                match answer {
                    Membership::Inside => assert!(own > -1e-9, "{name} {tolerance}: {p:?} {own}"),
                    Membership::Outside => assert!(own < 1e-9, "{name} {tolerance}: {p:?} {own}"),
                    Membership::Undecided => {
                        // The nearest of all faces.
                        let nearest = depths.map(f64::abs).into_iter().fold(f64::INFINITY, f64::min);
                        assert!(nearest <= 2.0 * tolerance, "{name} {tolerance}: {p:?} {nearest}");
                        continue;
                    }
                }
                known += 1;
            }
            assert!(known > 5_000, "{name} {tolerance}: {known}");
        }
    }
    // A tip whose sides come closer than any tolerance.
    let (half, height) = (0.2, 1.0);
    let tip = of_mesh(pyramid_mesh(half, height));
    for tolerance in [0.1, 0.02] {
        let options = SurfaceOptions { tolerance: Some(tolerance) };
        let tree = build_extended(&tip, &frame, &options, &alone()).unwrap();
        let points: Vec<[f64; 3]> = (0..20_000)
            .map(|_| {
                let z = 1.05 - random.unit() * random.unit();
                let radius = 3.0 * half * (1.02 - z).abs();
                [radius * (random.unit() - 0.5), radius * (random.unit() - 0.5), z]
            })
            .collect();
        let mut answers = vec![Membership::Undecided; points.len()];
        contains(&tree, &frame, &points, &mut answers, &alone()).unwrap();
        for (&[x, y, z], answer) in points.iter().zip(answers) {
            let slack = half * (1.0 - z / height) - x.abs().max(y.abs());
            let own = (slack / half.hypot(1.0)).min(z);
            match answer {
                Membership::Inside => assert!(own > -1e-9, "{x} {y} {z}: {own}"),
                Membership::Outside => assert!(own < 1e-9, "{x} {y} {z}: {own}"),
                Membership::Undecided => assert!(own.abs() <= 2.0 * tolerance, "{x} {y} {z}: {own}"),
            }
        }
    }
}

/// The number of threads and the order of work change no bit.
#[test]
fn any_number_of_threads_makes_the_same_tree() {
    let (mut made, mut cells) = (0, 0);
    for seed in 0.. {
        let mut random = Random(seed ^ 0x7412EAD);
        let frame = frames(7)[random.below(5) as usize];
        let mut maker = Maker { random: &mut random, frame, aligned: false, others: false };
        let model =
            if seed % 2 == 0 { maker.expression(4) } else { maker.function(|maker| maker.half_space()) };
        let Ok(csg) = model.csg(&frame) else { continue };
        let of = |threads: usize| {
            build_extended(&csg, &frame, &SurfaceOptions::default(), &Control::threads(threads))
        };
        let Ok(one) = of(1) else { continue };
        for threads in [2, 5] {
            let other = of(threads).unwrap();
            assert_eq!((&one, Solid::fingerprint(&one)), (&other, Solid::fingerprint(&other)), "{model:#?}");
        }
        cells += one.view().cuts().unwrap_or_default().cells;
        made += 1;
        if made == 12 {
            break;
        }
    }
    assert!(cells > 20, "{cells}");
}

/// Limits and cancels end the work with an error, at any point. A tree built afterwards is the same as
/// before.
#[test]
fn limits_and_cancels_are_errors() {
    let part = {
        let balls = (0..12).map(|k| {
            let turn = 0.5 * f64::from(k);
            Csg::ball([0.6 * turn.cos(), 0.6 * turn.sin(), 0.1 * f64::from(k) - 0.5], 0.27).unwrap()
        });
        Csg::cuboid([-0.7; 3], [0.7; 3]).unwrap().difference(&Csg::union_of(balls).unwrap()).unwrap()
    };
    let frame = Frame::new([-1.0; 3], 2.0, 7).unwrap();
    let options = SurfaceOptions::default();
    let whole = build_extended(&part, &frame, &options, &alone()).unwrap();
    let nodes = whole.statistics().nodes();
    assert!(nodes > 8, "{nodes}");
    for threads in [1, 2] {
        for max_nodes in [0, 1, nodes / 2, nodes - 1] {
            let control = Control { max_nodes: Some(max_nodes), ..Control::threads(threads) };
            let refused = build_extended(&part, &frame, &options, &control);
            assert!(
                matches!(refused, Err(Error::Limit { what: "nodes", .. })),
                "{max_nodes} of {nodes}: {refused:?}"
            );
        }
        let enough = Control { max_nodes: Some(nodes), ..Control::threads(threads) };
        assert_eq!(build_extended(&part, &frame, &options, &enough).unwrap(), whole);
        for max_bytes in [0, 1000] {
            let control = Control { max_bytes: Some(max_bytes), ..Control::threads(threads) };
            assert!(matches!(build_extended(&part, &frame, &options, &control), Err(Error::Limit { .. })));
        }
        // Cancelled by the progress that is reported, or before.
        let cancel = core::sync::atomic::AtomicBool::new(false);
        let progress = |_: f64| cancel.store(true, core::sync::atomic::Ordering::Relaxed);
        let control =
            Control { cancel: Some(&cancel), progress: Some(&progress), ..Control::threads(threads) };
        let ended = build_extended(&part, &frame, &options, &control);
        assert!(ended.is_ok_and(|tree| tree == whole) || cancel.load(core::sync::atomic::Ordering::Relaxed));
        assert!(matches!(build_extended(&part, &frame, &options, &control), Err(Error::Cancelled)));
        assert_eq!(build_extended(&part, &frame, &options, &Control::threads(threads)).unwrap(), whole);
    }
}

/// The data that a solid provides: a list of surfaces, and in open cells on random descents, surfaces, an
/// enclosure, moments and an area.
#[derive(Debug, Default, PartialEq)]
struct Told {
    list: bool,
    surfaces: bool,
    enclosure: bool,
    moments: bool,
    area: bool,
}

fn told<S: Solid>(solid: &S, frame: &Frame) -> Told {
    let classifier = solid.on(frame, &alone()).unwrap();
    let mut list = None;
    classifier.answer_whole(WholeQuestion::Surfaces(&mut list), &alone()).unwrap();
    assert_eq!(list.is_some(), classifier.surfaces(&alone()).unwrap().is_some());
    let mut told = Told { list: list.is_some(), ..Told::default() };
    let count = list.map_or(0, |list| list.len());
    let mut worker = classifier.worker().unwrap();
    let mut random = Random(9);
    for _ in 0..40 {
        let mark = worker.mark();
        let (mut verdict, mut cell) = (worker.root().unwrap(), Cell::ROOT);
        while let Verdict::Partial(part) = &verdict {
            if let Some(open) = worker.surfaces(cell, part).unwrap() {
                told.surfaces = true;
                assert!(open.indices().iter().all(|&index| (index as usize) < count));
            }
            told.enclosure |= worker.enclosure(cell, part).unwrap().is_some();
            told.moments |= worker.moments(cell, part).unwrap().is_some();
            told.area |= worker.area(cell, part).unwrap().is_some();
            let mut centre = None;
            if cell.level == frame.depth() {
                worker.answer(cell, part, Question::Centre(&mut centre)).unwrap();
                break;
            }
            let children = worker.split(cell, part).unwrap();
            let open: Vec<_> =
                (0..8u8).filter(|&k| matches!(children[k as usize], Verdict::Partial(_))).collect();
            let Some(&k) = open.get(random.below(open.len().max(1) as u64) as usize) else { break };
            (verdict, cell) = (children[usize::from(k)].clone(), cell.child(k));
        }
        worker.release(mark);
    }
    told
}

/// The questions about cells that each kind of solid answers.
#[test]
fn every_kind_of_solid_answers_its_questions() {
    let frame = Frame::new([-1.0; 3], 2.0, 7).unwrap();
    let ball = Csg::ball([0.1, 0.05, 0.0], 0.61).unwrap();
    let block = Csg::cuboid([-0.71, -0.52, -0.43], [0.54, 0.65, 0.76]).unwrap();
    let turn = Affine::new([[0.6, -0.8, 0.0, 0.01], [0.8, 0.6, 0.0, 0.02], [0.0, 0.0, 1.0, 0.03]]).unwrap();
    let swapped = Affine::new([[0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]).unwrap();
    let tree = |csg: &Csg| build_extended(csg, &frame, &SurfaceOptions::default(), &alone()).unwrap();
    let mesh = || MeshSolid::new(cuboid_mesh([-0.51; 3], [0.52; 3]), FillRule::NonZero).unwrap();
    let exact = Told { list: true, surfaces: true, enclosure: true, moments: true, area: true };
    // Half-spaces, and solids that pass their answers on.
    let union = Csg::union_of([ball.clone(), block.clone()]).unwrap();
    let of_trees = Csg::solid(AnySolid::new(tree(&ball))).difference(&block).unwrap();
    let solids: [(&str, AnySolid); 10] = [
        ("ball", AnySolid::new(ball.clone())),
        ("block", AnySolid::new(block.clone())),
        ("union", AnySolid::new(union.clone())),
        ("complement", AnySolid::new(union.complement())),
        ("symmetric difference", AnySolid::new(Csg::xor_of([ball.clone(), block.clone()]).unwrap())),
        ("placed", AnySolid::new(union.placed(&turn).unwrap())),
        ("erased twice", AnySolid::new(AnySolid::new(ball.clone()))),
        ("stored", AnySolid::new(tree(&union))),
        ("of a stored one", AnySolid::new(of_trees.clone())),
        ("stored, of a stored one", AnySolid::new(tree(&of_trees))),
    ];
    for (name, solid) in solids {
        let mut found = told(&solid, &frame);
        // (Planes provide only slabs.)
        if name == "block" {
            found.moments = true;
        }
        assert_eq!(found, exact, "{name}");
    }
    let swap = Transform::new(tree(&union), &frame, &swapped);
    assert!(told(&swap, &frame).surfaces, "moved from lattice to lattice");
    // Enclosures, and no surfaces.
    let found = told(&mesh(), &frame);
    assert!(!found.list && !found.surfaces && found.enclosure, "{found:?}");
    let mixed = Csg::solid(AnySolid::new(mesh())).difference(&ball).unwrap();
    let found = told(&mixed, &frame);
    assert!(found.list && found.surfaces && found.enclosure, "{found:?}");
    // Slabs in a tree: surfaces and enclosures, but no area, because they have no normals.
    let options = SurfaceOptions { tolerance: Some(0.05) };
    let turned = mesh().placed(&turn).unwrap();
    let slabs = build_extended(&turned, &frame, &options, &alone()).unwrap();
    let found = told(&slabs, &frame);
    assert_eq!(found, Told { moments: false, area: false, ..exact }, "{found:?}");
    // No answers at all.
    let plain: Octree = build(&ball, &frame, Rule::Certified, &alone()).unwrap();
    assert_eq!(told(&plain, &frame), Told::default());
    let callback = Callback::new(|min: [f64; 3], max: [f64; 3]| {
        Ok(match (min[0] >= 0.31, max[0] <= 0.31) {
            (true, _) => Verdict::Empty,
            (_, true) => Verdict::Full,
            _ => Verdict::Partial(()),
        })
    });
    assert_eq!(told(&callback, &frame), Told::default());
    // A tree of such a solid keeps no surfaces, and is the plain tree.
    let kept = build_extended(&callback, &frame, &SurfaceOptions::default(), &alone()).unwrap();
    assert_eq!(kept.view().cuts().unwrap_or_default().surfaces, 0);
    assert_eq!(kept.without_cuts(), build(&callback, &frame, Rule::Certified, &alone()).unwrap());
}

/// No eight stored siblings have the same function of the same surfaces: they would be one cell.
#[test]
fn no_eight_siblings_have_the_same_cut() {
    let (mut splits, mut cuts) = (0, 0);
    for seed in 0..40 {
        let mut random = Random(seed ^ 0x51B11);
        let frame = frames(5)[random.below(5) as usize];
        let mut maker = Maker { random: &mut random, frame, aligned: seed % 3 == 0, others: false };
        let model = maker.expression(4);
        let Ok(csg) = model.csg(&frame) else { continue };
        let Ok(tree) = build_extended(&csg, &frame, &SurfaceOptions::default(), &alone()) else { continue };
        let classifier = tree.on(&frame, &alone()).unwrap();
        classifier.surfaces(&alone()).unwrap();
        let mut worker = classifier.worker().unwrap();
        let Verdict::Partial(part) = worker.root().unwrap() else { continue };
        let mut open = vec![(Cell::ROOT, part)];
        while let Some((cell, part)) = open.pop() {
            if Ask::surfaces(&mut worker, cell, &part).unwrap().is_some() {
                cuts += 1;
                continue;
            }
            splits += 1;
            let mut told = Vec::new();
            for (k, verdict) in (0..8).zip(worker.split(cell, &part).unwrap()) {
                if let Verdict::Partial(part) = verdict {
                    told.push(Ask::surfaces(&mut worker, cell.child(k), &part).unwrap());
                    open.push((cell.child(k), part));
                }
            }
            let same = told.len() == 8 && told[0].is_some() && told.iter().all(|own| *own == told[0]);
            assert!(!same, "{cell:?} {told:?}\n{model:#?}");
        }
    }
    assert!(splits > 100 && cuts > 100, "{splits} {cuts}");
}

/// The order of operands, repeated operands and double complements change nothing.
#[test]
fn equal_expressions_make_equal_trees() {
    let (mut made, mut cuts) = (0, 0);
    for seed in 0..60 {
        let mut random = Random(seed ^ 0xC0 ^ (seed << 9));
        let frame = frames(4)[random.below(5) as usize];
        let mut maker = Maker { random: &mut random, frame, aligned: seed % 3 == 0, others: false };
        let [a, b, c] = [1, 2, 2].map(|count| maker.joined(count).csg(&frame));
        let (Ok(a), Ok(b), Ok(c)) = (a, b, c) else { continue };
        type Join = fn([Csg; 3]) -> Result<Csg, Error>;
        let joins: [Join; 3] =
            [|parts| Csg::union_of(parts), |parts| Csg::intersection_of(parts), |parts| Csg::xor_of(parts)];
        for join in joins {
            let tree = |csg: Csg| build_extended(&csg, &frame, &SurfaceOptions::default(), &alone());
            let all = || join([a.clone(), b.clone(), c.clone()]).unwrap();
            let Ok(own) = tree(all()) else { continue };
            let others = [
                join([c.clone(), a.clone(), b.clone()]).unwrap(),
                join([b.clone(), a.clone(), c.clone()]).unwrap(),
                all().complement().complement(),
                Csg::union_of([all(), all()]).unwrap(),
            ];
            for (i, other) in others.into_iter().enumerate() {
                assert_eq!(tree(other).unwrap(), own, "{seed} {i}");
            }
            made += 1;
            cuts += own.view().cuts().unwrap_or_default().cells;
        }
    }
    assert!(made > 60 && cuts > 100, "{made} {cuts}");
}
