//! Extended octrees: the surfaces that they keep, against exact arithmetic.

use super::oracle::frames;
use super::points::{Found, Judge};
use leafless::op::DexelOptions;
use leafless::{
    Affine, AnySolid, Cell, Classifier, Control, Csg, Error, FillRule, Frame, Membership, MeshSolid, Octree,
    Rule, Solid, SurfaceOptions, Tag, TriangleMesh, Verdict, Worker, build, build_extended, contains,
    dexelize, file, measure,
};
use leafless_testkit::csg::{Maker, Model};
use leafless_testkit::exact::Exact;
use leafless_testkit::{Random, alone};

pub(super) fn extended(csg: &Csg, frame: &Frame) -> Octree {
    let tree = build_extended(csg, frame, &SurfaceOptions::default(), &alone()).unwrap();
    tree.view().check().unwrap();
    through_a_file(&tree)
}

/// Writes a tree, reads it, and checks that writing it again gives the same bytes. Returns the tree read.
pub(super) fn through_a_file(tree: &Octree) -> Octree {
    let bytes = file::to_bytes(tree).unwrap();
    let read = file::from_bytes(&bytes).unwrap();
    assert_eq!(read, *tree);
    assert_eq!(read.view().cuts(), tree.view().cuts());
    assert_eq!(file::to_bytes(&read).unwrap(), bytes);
    read
}

/// Returns the side of a model on which a point of doubles lies.
pub(super) fn sign(model: &Model, p: [f64; 3]) -> i32 {
    let [x, y, z] = p.map(Exact::from);
    model.sign(&[x, y, z, Exact::from(1.0)])
}

/// Points anywhere, and points ever closer to the surface by bisection between two points on different sides;
/// with their sides.
pub(super) fn points(
    model: &Model,
    frame: &Frame,
    count: usize,
    random: &mut Random,
) -> Vec<([f64; 3], i32)> {
    let mut found = Vec::new();
    let mut last: [Option<[f64; 3]>; 2] = [None; 2];
    while found.len() < count {
        let p = frame.origin().map(|origin| origin + frame.edge() * random.unit());
        let own = sign(model, p);
        found.push((p, own));
        if own != 0 {
            last[(own > 0) as usize] = Some(p);
        }
        let [Some(mut outside), Some(mut inside)] = last else { continue };
        last = [None; 2];
        loop {
            let middle = [0, 1, 2].map(|axis| 0.5 * outside[axis] + 0.5 * inside[axis]);
            if middle == outside || middle == inside {
                break;
            }
            let own = sign(model, middle);
            found.push((middle, own));
            match own {
                1 => inside = middle,
                -1 => outside = middle,
                _ => break,
            }
        }
    }
    found
}

/// True if a point lies in a cell that was given up, or outside the universe.
pub(super) fn is_given_up(tree: &Octree, p: [f64; 3]) -> bool {
    let frame = tree.view().frame();
    let Some(at) = frame.cell_of(p) else { return true };
    let mut worker = tree.on(frame, &alone()).unwrap().worker().unwrap();
    let (mut verdict, mut cell) = (worker.root().unwrap(), Cell::ROOT);
    while let Verdict::Partial(part) = &verdict {
        if cell.level == frame.depth() {
            return false;
        }
        let octant = (0..3)
            .fold(0, |octant, axis| octant | (at[axis] >> (frame.depth() - 1 - cell.level) & 1) << axis);
        verdict = worker.split(cell, part).unwrap()[octant as usize];
        cell = cell.child(octant as u8);
    }
    matches!(verdict, Verdict::Undecided)
}

/// Checks random points of the universe in `models` random models, each made by `make`.
fn no_lies(models: u64, count: usize, make: impl Fn(&mut Maker<'_>) -> Model) {
    let (mut decided, mut undecided, mut made, mut kept, mut given_up) = (0u64, 0u64, 0, 0, 0);
    let (mut compared, mut ratios) = (0, 0.0);
    let mut found = Found::default();
    for seed in 0.. {
        let mut random = Random(seed ^ 0xE47E);
        let frame = frames(2 + random.below(5) as u8)[random.below(5) as usize];
        let aligned = random.below(2) == 0;
        let mut maker = Maker { random: &mut random, frame, aligned, others: false };
        let model = make(&mut maker);
        let Ok(csg) = model.csg(&frame) else { continue };
        let tree = match build_extended(&csg, &frame, &SurfaceOptions::default(), &alone()) {
            Ok(tree) => tree,
            // Numbers of placements within placements may become too long.
            Err(leafless::Error::Limit { .. }) => continue,
            Err(error) => panic!("{error}"),
        };
        tree.view().check().unwrap();
        let tree = through_a_file(&tree);
        let cuts = tree.view().cuts().unwrap_or_default();
        (kept, given_up) = (kept + cuts.cells, given_up + cuts.given_up);
        // The source's planes, and those of a tree made from the tree.
        let plain = build(&tree, &frame, Rule::Certified, &alone()).unwrap();
        let direct = build(&csg, &frame, Rule::Certified, &alone()).unwrap();
        for tree in [&tree, &plain] {
            let mut judge = Judge { model: &model, tree, bounds: csg.bounds(), found };
            judge.ask(count as u64 / 4, &mut random);
            found = judge.found;
        }
        // Cells are decided by the same surfaces. Groups of an expression may decide some cells by their
        // bounding boxes.
        let width = |tree: &Octree| tree.statistics().volume().width();
        if cuts.given_up == 0 && width(&direct) > 0.0 {
            (compared, ratios) = (compared + 1, ratios + width(&plain) / width(&direct));
        }
        // Points, by exact signs.
        let asked = points(&model, &frame, count, &mut random);
        let places: Vec<[f64; 3]> = asked.iter().map(|&(p, _)| p).collect();
        let mut answers = vec![Membership::Undecided; places.len()];
        contains(&tree, &frame, &places, &mut answers, &alone()).unwrap();
        let mut cells = vec![Membership::Undecided; places.len()];
        contains(&tree.without_cuts(), &frame, &places, &mut cells, &alone()).unwrap();
        for (&(p, sign), cell) in asked.iter().zip(cells) {
            let is_right = match cell {
                Membership::Inside => sign >= 0,
                Membership::Outside => sign <= 0,
                Membership::Undecided => true,
            };
            assert!(is_right, "{p:?} is {cell:?}\n{frame:?}\n{model:#?}");
        }
        for (&(p, sign), answer) in asked.iter().zip(answers) {
            match answer {
                Membership::Inside => assert!(sign >= 0, "{p:?} is outside\n{frame:?}\n{model:#?}"),
                Membership::Outside => assert!(sign <= 0, "{p:?} is inside\n{frame:?}\n{model:#?}"),
                Membership::Undecided => {
                    assert!(is_given_up(&tree, p), "{p:?}\n{frame:?}\n{model:#?}");
                    undecided += 1;
                    continue;
                }
            }
            decided += 1;
        }
        made += 1;
        if made == models {
            assert!(seed < 2 * models, "most models are refused");
            break;
        }
    }
    println!(
        "{models} models: {decided} points decided, {undecided} not; {kept} cells, {given_up} given up; plain trees {} times as wide; {found:?}",
        ratios / f64::from(compared)
    );
    assert!(undecided < decided / 4 && ratios < 1.01 * f64::from(compared));
}

#[test]
fn extended_primitives_do_not_lie() {
    no_lies(150, 60, |maker| maker.primitive());
}

#[test]
fn extended_expressions_do_not_lie() {
    no_lies(120, 60, |maker| maker.expression(3));
    no_lies(60, 60, |maker| {
        let part = maker.expression(2);
        Model::Placed(Box::new(part), maker.placement())
    });
}

#[test]
#[ignore = "some minutes"]
fn a_million_points_of_extended_trees() {
    no_lies(3000, 120, |maker| maker.primitive());
    no_lies(3000, 120, |maker| maker.expression(4));
    no_lies(3000, 120, |maker| {
        let inner = Model::Placed(Box::new(maker.expression(2)), maker.placement());
        Model::Placed(Box::new(inner), maker.placement())
    });
}

pub(super) fn plate() -> Csg {
    let bores = (0..20).map(|k| {
        let to = [8.0 + 16.0 * f64::from(k % 5), 7.5 + 15.0 * f64::from(k / 5), 0.0];
        Csg::cylinder(2.5, -1.0, 11.0).unwrap().placed(&Affine::translation(to).unwrap()).unwrap()
    });
    Csg::cuboid([0.0; 3], [80.0, 60.0, 10.0]).unwrap().difference(&Csg::union_of(bores).unwrap()).unwrap()
}

/// The design's example: a plate of 80 × 60 × 10 with twenty bores.
#[test]
fn a_plate_with_twenty_bores_is_small_and_sharp() {
    let turn = Affine::new([[0.36, 0.48, -0.8, 0.0], [-0.8, 0.6, 0.0, 0.0], [0.48, 0.64, 0.6, 0.0]]).unwrap();
    let truth = 48_000.0 - 20.0 * core::f64::consts::PI * 6.25 * 10.0;
    for (csg, nodes, bytes) in [(plate(), 57, 4000), (plate().placed(&turn).unwrap(), 130, 8000)] {
        let bounds = csg.bounds().unwrap();
        let frame = Frame::around(bounds.min, bounds.max, 20).unwrap();
        let tree = extended(&csg, &frame);
        let (cuts, planes) = (tree.view().cuts().unwrap(), tree.statistics());
        assert!(planes.nodes() <= nodes, "{}", planes.nodes());
        // Six planes and twenty cylinders. The cylinders' ends lie outside.
        assert_eq!((cuts.surfaces, cuts.given_up), (26, 0));
        assert!(cuts.bytes < bytes, "{cuts:?}");
        assert!(planes.volume().contains(truth));
        let [own, source] = [measure(&tree, &frame, 1e-4, &alone()), measure(&csg, &frame, 1e-4, &alone())]
            .map(Result::unwrap);
        assert!(own.volume.contains(truth) && own.volume.width() < 1.01e-4 * truth, "{:?}", own.volume);
        assert!(own.splits as f64 <= 1.1 * source.splits as f64, "{} {}", own.splits, source.splits);
    }
}

/// A tree is split on a finer frame by signs that are exact there. The plane's values are doubles on the
/// tree's lattice, and the plane misses a vertex of the finest lattice by 2^-64.
#[test]
fn signs_are_exact_below_the_depth_of_a_tree() {
    const BITS: u32 = 44;
    let deep = Frame::new([0.0; 3], 1.0, 20).unwrap();
    let mut random = Random(0xDEE9);
    for _ in 0..500 {
        let at = [0; 3].map(|_| 1 + 2 * random.below(1 << 19) as i128);
        // The remainder of n · at, modulo 2^20, is 1 or −1.
        let rest = 1 - 2 * random.below(2) as i128;
        let mut n = [0; 3].map(|_| (1 << (BITS - 1)) + random.below(1 << (BITS - 1)) as i128);
        let inverse = (0..5).fold(1i128, |inverse, _| (inverse * (2 - at[2] * inverse)).rem_euclid(1 << 20));
        let low = ((rest - n[0] * at[0] - n[1] * at[1]) * inverse).rem_euclid(1 << 20);
        n[2] = (n[2] >> 20 << 20) + low;
        let sum = (0..3).map(|axis| n[axis] * at[axis]).sum::<i128>();
        assert_eq!((sum - rest).rem_euclid(1 << 20), 0);
        let unit = 2.0f64.powi(-(BITS as i32));
        let plane = Csg::half_space(n.map(|n| n as f64 * unit), -((sum - rest) >> 20) as f64 * unit).unwrap();
        let place = at.map(|at| at as f64 / (1u64 << 20) as f64);
        let tree = extended(&plane, &deep.with_depth(2).unwrap());
        assert_eq!(verdicts_at(&plane, &deep, place), verdicts_at(&tree, &deep, place), "{n:?} {at:?}");
    }
}

/// Returns the verdicts of all cells around a place, from the universe down.
fn verdicts_at<S: Solid>(solid: &S, frame: &Frame, at: [f64; 3]) -> Vec<[Tag; 8]> {
    let mut worker = solid.on(frame, &alone()).unwrap().worker().unwrap();
    let (mut verdict, mut cell, mut found) = (worker.root().unwrap(), Cell::ROOT, Vec::new());
    while let (Verdict::Partial(part), true) = (verdict, cell.level < frame.depth()) {
        let children = worker.split(cell, &part).unwrap();
        found.push(children.each_ref().map(|verdict| verdict.tag()));
        // Towards the place, but to its lower side in the end.
        let half = |axis: usize| {
            let middle = (2 * cell.at[axis] + 1) as f64 / (2u64 << cell.level) as f64;
            u8::from(at[axis] > middle)
        };
        let octant = half(0) | half(1) << 1 | half(2) << 2;
        (verdict, cell) = (children[usize::from(octant)].clone(), cell.child(octant));
    }
    found
}

/// Rays through cell centres have the same intervals as rays of the source.
#[test]
fn rays_of_cut_cells_begin_and_end_where_those_of_the_source_do() {
    let (mut rays, mut intervals) = (0, 0);
    for seed in 0..60 {
        let mut random = Random(seed ^ 0xC403D5);
        let frame = frames(4 + random.below(3) as u8)[random.below(5) as usize];
        let aligned = random.below(2) == 0;
        let mut maker = Maker { random: &mut random, frame, aligned, others: false };
        let model = match seed % 3 {
            0 => maker.function(|maker| maker.half_space()),
            1 => maker.primitive(),
            _ => maker.expression(2),
        };
        let Ok(csg) = model.csg(&frame) else { continue };
        let shallow = frame.with_depth(2 + (seed % 2) as u8).unwrap();
        let Ok(tree) = build_extended(&csg, &shallow, &SurfaceOptions::default(), &alone()) else { continue };
        if tree.view().cuts().unwrap_or_default().given_up > 0 {
            continue;
        }
        let options = DexelOptions::default();
        let [own, source] = [
            dexelize(&tree, &frame, &options, &alone()).unwrap(),
            dexelize(&csg, &frame, &options, &alone()).unwrap(),
        ];
        for direction in 0..3 {
            for row in 0..frame.cells() {
                for column in 0..frame.cells() {
                    let [own, source] = [&own, &source].map(|model| {
                        model.view().rays(direction).unwrap().dexels([column, row]).collect::<Vec<_>>()
                    });
                    assert_eq!(own.len(), source.len(), "{seed} {direction} {column} {row}\n{model:#?}");
                    for (own, source) in own.iter().zip(&source) {
                        let off =
                            (own.start.at - source.start.at).abs().max((own.end.at - source.end.at).abs());
                        assert!(off <= 1e-6 * frame.edge(), "{seed}: {own:?} {source:?}\n{model:#?}");
                        intervals += 1;
                    }
                    rays += 1;
                }
            }
        }
    }
    println!("{intervals} intervals of {rays} rays");
    assert!(intervals > 1000);
}

/// Equal surfaces are one surface, however they are written.
#[test]
fn equal_surfaces_are_one() {
    let frame = Frame::new([-2.0; 3], 4.0, 10).unwrap();
    let ball = Csg::ball([0.1, 0.2, 0.3], 0.7).unwrap();
    let to = Affine::translation([0.1, 0.2, 0.3]).unwrap();
    let moved = Csg::ball([0.0; 3], 0.7).unwrap().placed(&to).unwrap();
    for (what, count) in [
        (ball.difference(&moved).unwrap(), 0),
        (Csg::union_of([ball.clone(), moved.complement()]).unwrap(), 0),
        (Csg::intersection_of([ball.clone(), moved.clone()]).unwrap(), 1),
        (Csg::union_of([ball.complement(), ball.clone()]).unwrap(), 0),
    ] {
        let tree = extended(&what, &frame);
        assert_eq!(tree.view().cuts().map_or(0, |cuts| cuts.surfaces), count);
        // A universe that one surface crosses is one cell.
        assert_eq!((tree.statistics().nodes(), tree.view().root_tag() == Tag::Partial), (0, count > 0));
    }
    // The same plane with other numbers, and from the other side.
    let plane = |scale: f64| Csg::half_space([0.3 * scale, -0.7 * scale, 0.2 * scale], 0.25 * scale).unwrap();
    let tree = extended(&Csg::intersection_of([plane(1.0), plane(-4.0)]).unwrap(), &frame);
    assert!(tree.statistics().nodes() == 0 && tree.view().root_tag() == Tag::Empty);
}

/// An extended tree in an expression passes its surfaces on. The expression's tree is as sharp as a tree
/// built in one step.
#[test]
fn trees_of_trees() {
    let frame = Frame::new([-1.0; 3], 2.0, 12).unwrap();
    let block = Csg::cuboid([-0.7, -0.6, -0.5], [0.7, 0.6, 0.5]).unwrap();
    let ball = Csg::ball([0.2, 0.1, 0.3], 0.55).unwrap();
    let at_once = extended(&block.difference(&ball).unwrap(), &frame);
    let stored = Csg::solid(leafless::AnySolid::new(extended(&block, &frame)));
    let after = extended(&stored.difference(&ball).unwrap(), &frame);
    // (Two faces of the block lie in planes of the lattice, where cells describe them completely.)
    let [once, later] = [&at_once, &after].map(|tree| tree.view().cuts().unwrap());
    assert_eq!((once.given_up, later.given_up, once.surfaces, later.surfaces), (0, 0, 5, 5));
    let [once, later] = [&at_once, &after].map(|tree| measure(tree, &frame, 1e-5, &alone()).unwrap().volume);
    assert!(once.lower <= later.upper && later.lower <= once.upper);
    assert!(later.width() < 1e-4);
    // And a copy of a tree is the tree.
    assert_eq!(extended(&Csg::solid(leafless::AnySolid::new(at_once.clone())), &frame), at_once);
    assert_eq!(
        build_extended(&at_once, &frame, &SurfaceOptions::default(), &Control::threads(2)).unwrap(),
        at_once
    );
}

/// A cube of edge 1 as a mesh, for which an extended tree keeps slabs, minus a ball, whose surface is exact.
#[test]
fn meshes_are_kept_to_a_tolerance() {
    let vertices = (0..8).map(|k| [0, 1, 2].map(|axis| f64::from(k >> axis & 1))).collect();
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = MeshSolid::new(TriangleMesh::new(vertices, triangles).unwrap(), FillRule::NonZero).unwrap();
    let ball = Csg::ball([1.0, 0.9, 0.8], 0.6).unwrap();
    let (cube, frame) = (Csg::solid(AnySolid::new(mesh)), Frame::new([-0.77; 3], 2.7, 9).unwrap());
    let part = cube.difference(&ball).unwrap();
    let truth = |p: [f64; 3]| {
        // A lower bound of a point's depth inside.
        let cube = p.iter().map(|&c| c.min(1.0 - c)).fold(f64::INFINITY, f64::min);
        let [x, y, z] = [p[0] - 1.0, p[1] - 0.9, p[2] - 0.8];
        cube.min((x * x + y * y + z * z).sqrt() - 0.6)
    };
    for tolerance in [0.03, 0.01] {
        let options = SurfaceOptions { tolerance: Some(tolerance) };
        let tree = build_extended(&part, &frame, &options, &Control::threads(1)).unwrap();
        assert_eq!(build_extended(&part, &frame, &options, &Control::threads(3)).unwrap(), tree);
        tree.view().check().unwrap();
        through_a_file(&tree);
        assert_eq!(leafless::op::compact(tree.view()).unwrap(), tree);
        let cuts = tree.view().cuts().unwrap();
        println!("{tolerance}: {} nodes, {cuts:?}", tree.statistics().nodes());
        let mut random = Random(5);
        let near = |c: f64, random: &mut Random| c + random.between(-4.0, 4.0) * tolerance;
        let points: Vec<[f64; 3]> = (0..20_000)
            .map(|_| {
                let mut p = [0; 3].map(|_| random.between(-0.1, 1.1));
                let axis = random.below(3) as usize;
                p[axis] = near(random.below(2) as f64, &mut random);
                p
            })
            .collect();
        let mut answers = vec![Membership::Undecided; points.len()];
        contains(&tree, &frame, &points, &mut answers, &alone()).unwrap();
        let (mut known, mut far) = (0, 0);
        for (&p, answer) in points.iter().zip(answers) {
            let depth = truth(p);
            match answer {
                Membership::Inside => assert!(depth > -1e-12, "{p:?}: {depth}"),
                Membership::Outside => assert!(depth < 1e-12, "{p:?}: {depth}"),
                Membership::Undecided => {
                    far += (depth.abs() > 2.0 * tolerance) as u32;
                    continue;
                }
            }
            known += 1;
        }
        // Regions given up at edges are thinner than a finest cell.
        assert!(known > 10_000 && far == 0, "{known} {far}");
        let volume = measure(&tree, &frame, 1e-2, &alone()).unwrap().volume;
        let source = measure(&part, &frame, 1e-2, &alone()).unwrap().volume;
        assert!(volume.lower <= source.upper && source.lower <= volume.upper, "{volume:?} {source:?}");
        assert!(volume.width() < 10.0 * tolerance, "{volume:?}");
    }
}

/// Refused calls: an invalid tolerance, cancelled work, too many bytes, a file.
#[test]
fn refusals() {
    let frame = Frame::new([-1.0; 3], 2.0, 12).unwrap();
    let ball = Csg::ball([0.1, 0.0, 0.0], 0.7).unwrap();
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let options = SurfaceOptions { tolerance: Some(tolerance) };
        let refused = build_extended(&ball, &frame, &options, &alone());
        assert!(matches!(refused, Err(Error::Argument { name: "tolerance", .. })), "{tolerance}");
    }
    let cancel = core::sync::atomic::AtomicBool::new(true);
    let cancelled = Control { cancel: Some(&cancel), ..alone() };
    assert!(matches!(
        build_extended(&ball, &frame, &SurfaceOptions::default(), &cancelled),
        Err(Error::Cancelled)
    ));
    let part = plate();
    let around = Frame::around([0.0; 3], [80.0, 60.0, 10.0], 20).unwrap();
    let small = Control { max_bytes: Some(500), ..alone() };
    assert!(matches!(
        build_extended(&part, &around, &SurfaceOptions::default(), &small),
        Err(Error::Limit { .. })
    ));
}
