//! Moved extended octrees: their surfaces are moved exactly, and their cells are computed anew.

use super::oracle::frames;
use leafless::query::surface_area;
use leafless::solid::Transform;
use leafless::{
    Affine, AnySolid, Control, Csg, FillRule, Frame, Interval, Membership, MeshSolid, Octree, Solid,
    SurfaceOptions, TriangleMesh, build_extended, contains, difference, file, measure, union,
};
use leafless_testkit::csg::{Maker, Model};
use leafless_testkit::{Random, alone, repeated};

const EXACT: SurfaceOptions = SurfaceOptions { tolerance: None };

fn extended<S: Solid>(solid: &S, frame: &Frame) -> Octree {
    let tree = build_extended(solid, frame, &EXACT, &alone()).unwrap();
    tree.view().check().unwrap();
    tree
}

fn placed(tree: &Octree, placement: &Affine) -> AnySolid {
    AnySolid::new(tree.clone()).placed(placement).unwrap()
}

fn either(a: &Csg, b: &Csg) -> Csg {
    Csg::union_of([a.clone(), b.clone()]).unwrap()
}

/// A plate of 80 × 60 × 10 with twenty bores.
fn plate() -> Csg {
    let bores = (0..20).map(|k| {
        let to = [8.0 + 16.0 * f64::from(k % 5), 7.5 + 15.0 * f64::from(k / 5), 0.0];
        Csg::cylinder(2.5, -1.0, 11.0).unwrap().placed(&Affine::translation(to).unwrap()).unwrap()
    });
    let block = Csg::cuboid([0.0; 3], [80.0, 60.0, 10.0]).unwrap();
    block.difference(&Csg::union_of(bores).unwrap()).unwrap()
}

/// A block minus a hundred balls.
fn swarf() -> Csg {
    let balls = (0..100).map(|k| {
        let s = f64::from(k) / 99.0;
        let centre = [10.0 + 80.0 * s, 50.0 + 30.0 * (s * 9.0).sin(), 40.0 + 3.0 * (s * 5.0).cos()];
        Csg::ball(centre, 6.0).unwrap()
    });
    let block = Csg::cuboid([0.0; 3], [100.0, 100.0, 40.0]).unwrap();
    block.difference(&Csg::union_of(balls).unwrap()).unwrap()
}

/// A rotation about an axis through a point, by an angle in degrees; rounded, so that it is not quite a
/// rotation.
fn turn(axis: [f64; 3], degrees: f64, about: [f64; 3]) -> Affine {
    let length = axis.iter().map(|c| c * c).sum::<f64>().sqrt();
    let [x, y, z] = axis.map(|c| c / length);
    let (s, c) = degrees.to_radians().sin_cos();
    let t = 1.0 - c;
    let m = [
        [t * x * x + c, t * x * y - s * z, t * x * z + s * y],
        [t * x * y + s * z, t * y * y + c, t * y * z - s * x],
        [t * x * z - s * y, t * y * z + s * x, t * z * z + c],
    ];
    Affine::new([0, 1, 2].map(|i| {
        let moved = (0..3).map(|j| m[i][j] * about[j]).sum::<f64>();
        [m[i][0], m[i][1], m[i][2], about[i] - moved]
    }))
    .unwrap()
}

/// Returns the frame of a shape, its middle, and a frame with room for all rotations about the middle.
fn frames_of(csg: &Csg, depth: u8) -> (Frame, [f64; 3], Frame) {
    let bounds = csg.bounds().unwrap();
    let middle = [0, 1, 2].map(|axis| 0.5 * (bounds.min[axis] + bounds.max[axis]));
    let reach = (0..3).map(|axis| (bounds.max[axis] - middle[axis]).powi(2)).sum::<f64>().sqrt();
    let room = Frame::around(middle.map(|c| c - reach), middle.map(|c| c + reach), depth).unwrap();
    (Frame::around(bounds.min, bounds.max, depth).unwrap(), middle, room)
}

fn given_up(tree: &Octree) -> u64 {
    tree.view().cuts().unwrap().given_up
}

fn volume(tree: &Octree, tolerance: f64) -> Interval {
    measure(tree, tree.frame(), tolerance, &alone()).unwrap().volume
}

#[test]
fn a_plate_that_is_turned_again_and_again() {
    let csg = plate();
    let (frame, middle, room) = frames_of(&csg, 20);
    let truth = 48_000.0 - 20.0 * 62.5 * core::f64::consts::PI;
    let (mut tree, mut moved) = (extended(&csg, &frame), csg);
    for turns in 1..=3 {
        let map = turn([1.0, 2.0, 3.0], 20.0, middle);
        moved = moved.placed(&map).unwrap();
        tree = extended(&placed(&tree, &map), &room);
        let direct = extended(&moved, &room);
        let (own, other) = (tree.statistics().nodes(), direct.statistics().nodes());
        println!("{turns} turns: {own} nodes, of the expression {other}; {:?}", tree.view().cuts());
        assert!(own <= 2 * other && given_up(&tree) == 0, "{own} {other}");
        let (own, other) = (volume(&tree, 1e-6), volume(&direct, 1e-6));
        assert!(own.contains(truth) && own.width() <= 1.5 * other.width(), "{own:?} {other:?}");
        let (a, b) = (file::to_bytes(&tree).unwrap().len(), file::to_bytes(&direct).unwrap().len());
        assert!(a <= 2 * b, "{a} {b}");
        // The image itself, whose cells are computed as far as needed.
        let image = measure(&placed(&tree, &map), &room, 1e-4, &alone()).unwrap().volume;
        assert!(image.contains(truth), "{image:?}");
    }
}

#[test]
fn few_cells_more_are_given_up_by_a_turn() {
    let csg = swarf();
    let (frame, middle, room) = frames_of(&csg, 11);
    let map = turn([1.0, 2.0, 3.0], 20.0, middle);
    let tree = extended(&placed(&extended(&csg, &frame), &map), &room);
    let direct = extended(&csg.placed(&map).unwrap(), &room);
    println!("given up {} and {}", given_up(&tree), given_up(&direct));
    assert!(given_up(&tree) <= 4 * given_up(&direct).max(1), "{} {}", given_up(&tree), given_up(&direct));
    assert!(tree.statistics().nodes() <= 2 * direct.statistics().nodes());
    let (own, other) = (volume(&tree, 1e-6), volume(&direct, 1e-6));
    assert!(own.common(other).is_some(), "{own:?} {other:?}");
    // The number of threads does not matter.
    let image = placed(&extended(&csg, &frame), &map);
    assert_eq!(build_extended(&image, &room, &EXACT, &Control::threads(3)).unwrap(), tree);
}

/// Checks that a solid's answers for points do not contradict the truth. Returns the number of decided
/// points.
fn compared<S: Solid>(name: &str, solid: &S, frame: &Frame, truth: &Csg, points: &[[f64; 3]]) -> usize {
    let mut answers = vec![Membership::Undecided; points.len()];
    contains(solid, frame, points, &mut answers, &alone()).unwrap();
    let mut expected = vec![Membership::Undecided; points.len()];
    contains(truth, frame, points, &mut expected, &alone()).unwrap();
    let mut known = 0;
    for ((point, own), other) in points.iter().zip(answers).zip(expected) {
        if own != Membership::Undecided && other != Membership::Undecided {
            assert_eq!(own, other, "{name}: {point:?}");
            known += 1;
        }
    }
    known
}

/// Points anywhere, and pairs of adjacent doubles that the surface separates.
fn points_of(truth: &Csg, frame: &Frame, random: &mut Random) -> Vec<[f64; 3]> {
    let mut points: Vec<[f64; 3]> =
        (0..400).map(|_| frame.origin().map(|origin| origin + frame.edge() * random.unit())).collect();
    let mut pairs: Vec<_> = points.windows(2).map(|pair| (pair[0], pair[1])).collect();
    let mut answers = vec![Membership::Undecided; pairs.len()];
    let mut side = |points: &[[f64; 3]], count: usize| {
        answers.truncate(count);
        contains(truth, frame, points, &mut answers, &alone()).unwrap();
        answers.clone()
    };
    let first = side(&points[..pairs.len()], pairs.len());
    for _ in 0..48 {
        let middle = |(a, b): &([f64; 3], [f64; 3])| [0, 1, 2].map(|axis| 0.5 * (a[axis] + b[axis]));
        let middles: Vec<_> = pairs.iter().map(middle).collect();
        for (((pair, middle), own), first) in
            pairs.iter_mut().zip(&middles).zip(side(&middles, middles.len())).zip(&first)
        {
            *(if own == *first { &mut pair.0 } else { &mut pair.1 }) = *middle;
        }
    }
    points.extend(pairs.iter().flat_map(|(a, b)| [*a, *b]));
    points
}

/// A random affine map that leaves a universe about where it is.
fn any_map(random: &mut Random, frame: &Frame) -> Affine {
    loop {
        let mut rows = [[0.0; 4]; 3];
        for row in &mut rows {
            row[..3].iter_mut().for_each(|c| *c = random.between(-1.0, 1.0));
        }
        let middle = frame.origin().map(|c| c + 0.5 * frame.edge());
        for (axis, row) in rows.iter_mut().enumerate() {
            let moved = (0..3).map(|j| row[j] * middle[j]).sum::<f64>();
            row[3] = middle[axis] - moved + random.between(-0.2, 0.2) * frame.edge();
        }
        if let Ok(map) = Affine::new(rows) {
            return map;
        }
    }
}

#[test]
fn no_point_of_what_is_moved_is_told_wrong() {
    let (mut made, mut known) = (0, [0; 3]);
    let most = repeated(14, 40);
    for seed in 0.. {
        let mut random = Random(seed ^ 0x30DE);
        let frame = frames(6)[random.below(5) as usize];
        let mut maker = Maker { random: &mut random, frame, aligned: seed % 3 == 0, others: false };
        let model: Model =
            if seed % 2 == 0 { maker.expression(4) } else { maker.function(|maker| maker.half_space()) };
        let Ok(csg) = model.csg(&frame) else { continue };
        let Ok(tree) = build_extended(&csg, &frame, &EXACT, &alone()) else { continue };
        if tree.view().cuts().is_none() {
            continue;
        }
        let map = any_map(&mut random, &frame);
        let truth = csg.placed(&map).unwrap();
        let points = points_of(&truth, &frame, &mut random);
        let image = placed(&tree, &map);
        known[0] += compared("image", &image, &frame, &truth, &points);
        let moved = extended(&image, &frame);
        known[1] += compared("moved", &moved, &frame, &truth, &points);
        // Once more, from the tree. Parts that leave the universe in between are lost, and undecided.
        let back = map.inverse().unwrap();
        let returned = extended(&placed(&moved, &back), &frame);
        let truth = truth.placed(&back).unwrap();
        let points = points_of(&truth, &frame, &mut random);
        known[2] += compared("returned", &returned, &frame, &truth, &points);
        made += 1;
        if made == most {
            break;
        }
    }
    println!("{known:?} of {}", most * 1198);
    assert!(known.iter().all(|&known| known > repeated(1_750, 5_000)), "{known:?}");
}

/// Planes with a width are moved like other planes. A part thinner than the tolerance does not vanish.
#[test]
fn slabs_are_moved() {
    let mesh = |min: [f64; 3], max: [f64; 3]| {
        let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 != 0 { max[axis] } else { min[axis] });
        let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        let mesh = TriangleMesh::new((0..8).map(corner).collect(), triangles).unwrap();
        Csg::solid(AnySolid::new(MeshSolid::new(mesh, FillRule::NonZero).unwrap()))
    };
    let boxes = [([0.0; 3], [1.0, 1.0, 0.5]), ([0.31, -0.2, -0.2], [0.314, 1.2, 0.8])];
    let frame = Frame::new([-0.517, -0.523, -0.531], 2.1, 6).unwrap();
    let mut random = Random(0x51AB);
    let mut all = 0;
    for tolerance in [0.1, 0.02] {
        let [a, b] = boxes.map(|(min, max)| Csg::cuboid(min, max).unwrap());
        let [c, d] = boxes.map(|(min, max)| mesh(min, max));
        let options = SurfaceOptions { tolerance: Some(tolerance) };
        for (name, part, truth) in [
            ("rib", either(&c, &d), either(&a, &b)),
            ("groove", c.difference(&d).unwrap(), a.difference(&b).unwrap()),
        ] {
            let tree = build_extended(&part, &frame, &options, &alone()).unwrap();
            for _ in 0..2 {
                let map = turn([0; 3].map(|_| random.between(-1.0, 1.0)), 30.0, [0.5, 0.5, 0.2]);
                let truth = truth.placed(&map).unwrap();
                let moved = extended(&placed(&tree, &map), &frame);
                let points = points_of(&truth, &frame, &mut random);
                let known = compared(name, &moved, &frame, &truth, &points);
                println!("{name} {tolerance}: {known} of {}, {:?}", points.len(), moved.view().cuts());
                all += known;
            }
        }
    }
    assert!(all > 3_000, "{all}");
}

#[test]
fn moved_trees_are_measured_as_the_expression() {
    let part = {
        let block = Csg::cuboid([-0.53, -0.39, -0.27], [0.51, 0.38, 0.26]).unwrap();
        block.difference(&Csg::ball([0.4, 0.3, 0.2], 0.3).unwrap()).unwrap()
    };
    let frame = Frame::new([-1.0; 3], 2.0, 12).unwrap();
    let tree = extended(&part, &frame);
    let mut random = Random(77);
    for _ in 0..6 {
        let map = any_map(&mut random, &frame);
        let (image, truth) = (placed(&tree, &map), part.placed(&map).unwrap());
        let ask = |solid: &AnySolid| {
            // (However narrow the intervals become, they must overlap.)
            let some = Control { max_splits: Some(5_000), ..alone() };
            let found = measure(solid, &frame, 1e-3, &some).unwrap();
            let inertia = found.inertia_about_centroid;
            let area = surface_area(solid, &frame, 1e-2, &some).unwrap().area;
            let mut all = vec![found.volume, area, inertia[0][0], inertia[1][1], inertia[0][2]];
            all.extend(found.centroid.unwrap());
            all
        };
        let expected = ask(&AnySolid::new(truth));
        for solid in [image.clone(), AnySolid::new(extended(&image, &frame))] {
            for (own, other) in ask(&solid).iter().zip(&expected) {
                assert!(own.common(*other).is_some(), "{own:?} {other:?}");
            }
        }
    }
}

#[test]
fn set_operations_keep_what_was_moved() {
    let csg = plate();
    let (frame, middle, room) = frames_of(&csg, 16);
    let map = turn([2.0, 1.0, -1.0], 20.0, middle);
    let tree = extended(&placed(&extended(&csg, &frame), &map), &room);
    let ball = Csg::ball(middle, 14.0).unwrap();
    let other = extended(&ball, &room);
    let truth = csg.placed(&map).unwrap();
    let less = difference(tree.view(), other.view(), &alone()).unwrap();
    let more = union(tree.view(), other.view(), &alone()).unwrap();
    for (name, own, truth) in
        [("less", less, truth.difference(&ball).unwrap()), ("more", more, either(&truth, &ball))]
    {
        own.view().check().unwrap();
        let direct = extended(&truth, &room);
        println!("{name}: {:?}, directly {:?}", own.view().cuts(), direct.view().cuts());
        assert!(given_up(&own) <= 2 * given_up(&direct) + 4);
        let (own, other) = (volume(&own, 1e-6), volume(&direct, 1e-6));
        assert!(own.common(other).is_some() && own.width() < 2.0 * other.width(), "{own:?} {other:?}");
    }
}

/// If cells are images of cells, the result equals the moved expression's result in every byte.
#[test]
fn maps_of_the_lattice_move_cells_one_to_one() {
    let part = {
        let block = Csg::cuboid([-0.53, -0.39, -0.27], [0.51, 0.38, 0.26]).unwrap();
        let bore = Csg::cylinder(0.11, -1.0, 1.0).unwrap();
        block.difference(&bore).unwrap().difference(&Csg::ball([0.4, 0.3, 0.2], 0.3).unwrap()).unwrap()
    };
    let frame = Frame::new([-1.0; 3], 2.0, 12).unwrap();
    let tree = extended(&part, &frame);
    for (name, rows) in [
        ("mirror", [[-1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]),
        ("quarter turn", [[0.0, -1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]),
        ("diagonal turn", [[0.0, 0.0, 1.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]]),
        ("step", [[1.0, 0.0, 0.0, 0.25], [0.0, 1.0, 0.0, -0.125], [0.0, 0.0, 1.0, 0.5]]),
    ] {
        let map = Affine::new(rows).unwrap();
        let moved = extended(&Transform::of(tree.clone(), &map), &frame);
        let direct = extended(&part.placed(&map).unwrap(), &frame);
        println!("{name}: {:?}, directly {:?}", moved.view().cuts(), direct.view().cuts());
        assert_eq!(given_up(&moved), 0, "{name}");
        if name != "step" {
            assert_eq!(file::to_bytes(&moved).unwrap(), file::to_bytes(&direct).unwrap(), "{name}");
        }
        // And back.
        let back = extended(&Transform::of(moved, &map.inverse().unwrap()), &frame);
        if name != "step" {
            assert_eq!(back, tree, "{name}");
        }
    }
}

/// Faces in planes of the lattice cross no cell, so that no cell keeps them. A map that rotates them finds
/// them.
#[test]
fn faces_in_planes_of_the_lattice_are_moved() {
    let aligned = Frame::new([0.0; 3], 128.0, 14).unwrap();
    let filled = Frame::new([0.0; 3], 64.0, 14).unwrap();
    let plate = Csg::cuboid([0.0; 3], [64.0, 64.0, 16.0]).unwrap();
    let bore = Csg::cylinder(7.3, -1.0, 80.0).unwrap();
    let bore = bore.placed(&Affine::translation([30.0, 34.0, 0.0]).unwrap()).unwrap();
    for (name, csg, frame) in [
        ("block", plate.clone(), aligned),
        ("block at the end", plate.clone(), filled),
        ("bored", plate.difference(&bore).unwrap(), aligned),
        ("bored at the end", plate.difference(&bore).unwrap(), filled),
    ] {
        let middle = [32.0, 32.0, 8.0];
        let room = Frame::around([-20.0; 3], [84.0; 3], 14).unwrap();
        let map = turn([1.0, 2.0, 3.0], 20.0, middle);
        let tree = extended(&csg, &frame);
        let moved = extended(&placed(&tree, &map), &room);
        let direct = extended(&csg.placed(&map).unwrap(), &room);
        let counts = moved.view().cuts();
        println!("{name}: {counts:?}, directly {:?}", direct.view().cuts());
        assert!(counts.is_some_and(|counts| counts.given_up == 0), "{name}");
        assert!(moved.statistics().nodes() <= 2 * direct.statistics().nodes() + 8, "{name}");
        let truth = csg.placed(&map).unwrap();
        let points = points_of(&truth, &room, &mut Random(3));
        let known = compared(name, &moved, &room, &truth, &points);
        assert_eq!(known, compared(name, &direct, &room, &truth, &points), "{name}");
    }
}
