//! Layouts: checks against closed forms and dense samples, and the placements of searches.

use leafless::layout::{
    Bay, Beside, Direction, Item, Layout, Objective, Orientations, SearchEnd, SearchOptions, Standing,
};
use leafless::query::GapVerdict;
use leafless::solid::{Motion, SplitCounter};
use leafless::{
    Affine, AnySolid, Control, Csg, Error, FillRule, Frame, Interval, Membership, MeshSolid, Rule, Solid,
    build, contains, surface,
};
use leafless_testkit::{Random, alone, repeated};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

fn cuboid(size: [f64; 3]) -> AnySolid {
    AnySolid::new(Csg::cuboid([0.0; 3], size).unwrap())
}

fn ball(radius: f64) -> AnySolid {
    AnySolid::new(Csg::ball([0.0; 3], radius).unwrap())
}

fn item(solid: AnySolid) -> Item {
    Item::new(solid).unwrap()
}

/// A box with items and no clearances.
fn bay(size: [f64; 3], items: Vec<Item>) -> Bay {
    bay_in(cuboid(size), items, [0.0; 2])
}

/// Any container with items, the clearance between them, and the clearance to the wall.
fn bay_in(container: AnySolid, items: Vec<Item>, [clearance, wall_clearance]: [f64; 2]) -> Bay {
    let mut bay = Bay::new(container).unwrap().with_clearances(clearance, wall_clearance).unwrap();
    for (number, item) in items.into_iter().enumerate() {
        assert_eq!(bay.add_item(item).unwrap(), number);
    }
    bay
}

fn layout(bay: &Bay) -> Layout {
    Layout::new(bay, &alone()).unwrap()
}

fn to(at: [f64; 3]) -> Affine {
    Affine::translation(at).unwrap()
}

/// A rotation around z, then around x, followed by an offset.
fn turned([a, b]: [f64; 2], at: [f64; 3]) -> Affine {
    let (sa, ca, sb, cb) = (a.sin(), a.cos(), b.sin(), b.cos());
    let rows = [[ca, -sa, 0.0, at[0]], [cb * sa, cb * ca, -sb, at[1]], [sb * sa, sb * ca, cb, at[2]]];
    Affine::new(rows).unwrap()
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn length(a: [f64; 3]) -> f64 {
    a.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// Returns the distance of a point from a placed block.
fn from_block(point: [f64; 3], size: [f64; 3], placement: &Affine) -> f64 {
    let own = placement.inverse().unwrap().apply(point);
    length([0, 1, 2].map(|k| (own[k] - size[k]).max(-own[k]).max(0.0)))
}

fn splits(solid: &AnySolid) -> u64 {
    solid.get::<SplitCounter<AnySolid>>().unwrap().splits().iter().sum()
}

fn counted(solid: AnySolid) -> AnySolid {
    AnySolid::new(SplitCounter::new(solid))
}

/// Proves every placed item once more.
fn assert_proven(layout: &Layout) {
    let all = layout.check_all(&alone()).unwrap();
    for (number, standing) in all.iter().enumerate() {
        assert_eq!(standing.verdict, GapVerdict::Yes, "{number}: {standing:?}");
    }
}

/// Eight blocks that fill a box to 80 %. All splits of the container and of the items are counted, wherever
/// they are made.
#[test]
fn eight_blocks() {
    let sizes = [
        [50.0, 40.0, 30.0],
        [50.0, 40.0, 25.0],
        [40.0, 35.0, 30.0],
        [45.0, 30.0, 30.0],
        [30.0, 30.0, 30.0],
        [40.0, 20.0, 35.0],
        [25.0, 25.0, 40.0],
        [30.0, 20.0, 20.0],
    ];
    let volume: f64 = sizes.iter().map(|size| size.iter().product::<f64>()).sum();
    let container = counted(cuboid([80.0, 70.0, volume / (0.8 * 5600.0)]));
    let blocks: Vec<AnySolid> = sizes.iter().map(|&size| counted(cuboid(size))).collect();
    let items = blocks.iter().map(|block| item(block.clone())).collect();
    let bay = bay_in(container.clone(), items, [0.0; 2]);
    let mut layout = layout(&bay);
    let found = layout.search(&SearchOptions::default(), &alone()).unwrap();
    assert_eq!((found.placed, found.left, found.end), (8, 0, SearchEnd::Complete));
    let all = splits(&container) + blocks.iter().map(splits).sum::<u64>();
    assert!(all <= 52, "{all}");
    assert_proven(&layout);
    // In plain numbers: all corners are in the box, and no two blocks have common inner points.
    let boxes: Vec<[[f64; 3]; 2]> = layout
        .placed()
        .iter()
        .map(|placed| {
            let [p, q] = [[0.0; 3], sizes[placed.item]].map(|corner| placed.placement.apply(corner));
            [[0, 1, 2].map(|k| p[k].min(q[k])), [0, 1, 2].map(|k| p[k].max(q[k]))]
        })
        .collect();
    let bounds = container.bounds().unwrap();
    for (i, a) in boxes.iter().enumerate() {
        assert!((0..3).all(|k| bounds.min[k] <= a[0][k] && a[1][k] <= bounds.max[k]));
        for b in &boxes[..i] {
            assert!((0..3).any(|k| a[1][k] <= b[0][k] || b[1][k] <= a[0][k]));
        }
    }
    let filled = layout.measures(1e-6, &alone()).unwrap().filled_part;
    assert!(filled.contains(0.8) && filled.width() < 1e-5, "{filled:?}");
}

#[test]
fn arrangements_by_chance() {
    check_arrangements(repeated(100, 200));
}

/// `cargo test --release --test queries layout -- --ignored`
#[test]
#[ignore = "a minute"]
fn a_thousand_arrangements() {
    check_arrangements(1000);
}

/// Random arrangements of balls and blocks. No verdict contradicts the distance in closed form.
fn check_arrangements(count: usize) {
    let mut random = Random(40);
    let (size, radius, clearance) = ([2.0, 1.5, 1.0], 0.8, 0.25);
    let wide = [8.0, 7.0, 6.0];
    let items = vec![item(ball(radius)), item(cuboid(size))];
    let bay = bay_in(cuboid(wide), items, [clearance, 0.125]);
    let mut counts = [[0; 2]; 3];
    let mut layout = layout(&bay);
    for _ in 0..count {
        while !layout.placed().is_empty() {
            layout.remove(0).unwrap();
        }
        let at = |random: &mut Random| [0, 1, 2].map(|k| random.between(0.6, wide[k] - 0.6));
        let centres = [at(&mut random), at(&mut random)];
        let placement = turned([random.between(0.0, 6.0), random.between(0.0, 6.0)], at(&mut random));
        let turn = turned([random.between(0.0, 6.0), 0.0], centres[0]);
        layout.place(0, &turn).unwrap();
        layout.place(0, &to(centres[1])).unwrap();
        layout.place(1, &placement).unwrap();
        for number in 0..3 {
            let wall = match number {
                2 => (0..8)
                    .map(|k| [0, 1, 2].map(|i| if k >> i & 1 == 0 { 0.0 } else { size[i] }))
                    .map(|corner| {
                        let p = placement.apply(corner);
                        (0..3).map(|k| p[k].min(wide[k] - p[k])).fold(f64::INFINITY, f64::min)
                    })
                    .fold(f64::INFINITY, f64::min),
                _ => {
                    (0..3)
                        .map(|k| centres[number][k].min(wide[k] - centres[number][k]))
                        .fold(f64::INFINITY, f64::min)
                        - radius
                }
            };
            let between = |other: usize| match (number.min(other), number.max(other)) {
                (0, 1) => length(minus(centres[0], centres[1])) - 2.0 * radius,
                (ball, _) => from_block(centres[ball], size, &placement) - radius,
            };
            let found = layout.check(number, &alone()).unwrap();
            let mut truth = wall >= 0.125;
            for other in (0..3).filter(|&other| other != number) {
                truth &= between(other) >= clearance;
                let told = found.conflicts.iter().find(|near| near.other == Beside::Placed(other));
                match told {
                    None => assert!(between(other) > clearance - 1e-9),
                    Some(near) if near.verdict == GapVerdict::No => {
                        assert!(between(other) < clearance + 1e-9)
                    }
                    Some(_) => {}
                }
                if let Some(near) = told {
                    let distance = between(other).max(0.0);
                    assert!(
                        near.gap.lower <= distance + 1e-9 && distance <= near.gap.upper + 1e-9,
                        "{near:?} {distance}"
                    );
                }
            }
            let nearest = found.nearest.unwrap();
            let least =
                (0..3).filter(|&other| other != number).map(between).fold(f64::INFINITY, f64::min).max(0.0);
            assert!(
                nearest.gap.lower <= least + 1e-9 && least <= nearest.gap.upper + 1e-9,
                "{nearest:?} {least}"
            );
            match found.verdict {
                GapVerdict::Yes => assert!(truth),
                GapVerdict::No => assert!(!truth),
                GapVerdict::Undecided => {}
            }
            counts[found.verdict as usize][usize::from(truth)] += 1;
        }
    }
    let [[_, yes], [no, _], undecided] = counts;
    assert!(
        yes > count / 3 && no > count / 3 && undecided.iter().sum::<usize>() <= count / 200,
        "{counts:?}"
    );
}

/// Searches with solids of all kinds, against dense samples: no point lies in two solids or outside the
/// container.
#[test]
fn what_is_placed_is_apart() {
    let hook = Csg::cuboid([0.0; 3], [3.0, 1.0, 1.0]).unwrap();
    let hook = Csg::union_of([hook, Csg::cuboid([0.0; 3], [1.0, 1.0, 2.5]).unwrap()]).unwrap();
    let ring = Csg::torus(1.2, 0.4).unwrap();
    let mesh = {
        let frame = Frame::around([-2.0; 3], [2.0; 3], 12).unwrap();
        let made = surface::boundary(&ring, &frame, 0.01, &alone()).unwrap();
        AnySolid::new(MeshSolid::new(made.mesh().clone(), FillRule::default()).unwrap())
    };
    let stored = build(&hook, &Frame::new([-1.0; 3], 8.0, 6).unwrap(), Rule::Certified, &alone()).unwrap();
    let container = AnySolid::new(Csg::cylinder(5.0, 0.0, 9.0).unwrap());
    let items = vec![
        item(AnySolid::new(hook)).with_count(6),
        item(AnySolid::new(stored)).with_count(4),
        item(mesh).with_count(5),
        item(AnySolid::new(ring)).with_count(3).with_orientations(Orientations::Free(4)).unwrap(),
    ];
    let mut bay = bay_in(container.clone(), items, [0.1, 0.05]);
    let pillar = AnySolid::new(Csg::cuboid([-1.0, -1.0, 0.0], [1.0, 1.0, 4.0]).unwrap());
    bay.add_obstacle(pillar.clone()).unwrap();
    let mut layout = layout(&bay);
    let options = SearchOptions { cells: 48, rounds: 2, seed: 5, ..SearchOptions::default() };
    let found = layout.search(&options, &alone()).unwrap();
    assert!(found.placed >= 12, "{found:?}");
    assert_proven(&layout);
    let frame = Frame::new([-8.0; 3], 24.0, 12).unwrap();
    let mut random = Random(7);
    let points: Vec<[f64; 3]> = (0..20_000)
        .map(|_| [random.between(-5.5, 5.5), random.between(-5.5, 5.5), random.between(-0.5, 9.5)])
        .collect();
    let inside = |solid: &AnySolid| {
        let mut found = vec![Membership::Undecided; points.len()];
        contains(solid, &frame, &points, &mut found, &alone()).unwrap();
        found
    };
    let mut held = vec![0; points.len()];
    let mut hits = 0;
    let mut solids = vec![pillar];
    for placed in layout.placed() {
        let solid = layout.items()[placed.item].solid();
        // (A stored octree is queried through its placement.)
        solids.push(solid.placed(&placed.placement).unwrap());
    }
    let within = inside(&container);
    for (k, solid) in solids.iter().enumerate() {
        for (i, membership) in inside(solid).into_iter().enumerate() {
            if membership == Membership::Inside {
                held[i] += 1;
                hits += 1;
                assert!(k == 0 || within[i] != Membership::Outside);
            }
        }
    }
    assert!(held.iter().all(|&count| count <= 1) && hits > 1000, "{hits}");
}

/// Results are the same for any number of threads. Other seeds give other layouts.
#[test]
fn the_seed_decides() {
    let made = |seed: u64, threads: usize| {
        let part = AnySolid::new(Csg::cylinder(1.0, 0.0, 3.0).unwrap());
        let items = vec![
            item(part).with_count(9).with_orientations(Orientations::Free(3)).unwrap(),
            item(cuboid([2.0, 2.0, 0.5])).with_count(9),
        ];
        let mut layout = layout(&bay_in(cuboid([6.0; 3]), items, [0.1, 0.0]));
        let options = SearchOptions {
            seed,
            cells: 32,
            rounds: 2,
            objective: Objective::Density,
            ..SearchOptions::default()
        };
        layout.search(&options, &Control { threads, ..Control::default() }).unwrap();
        assert_proven(&layout);
        layout.placed().to_vec()
    };
    let first = made(1, 1);
    assert!(first.len() >= 10 && first == made(1, 3) && first == made(1, 2));
    assert_ne!(first, made(2, 1));
}

#[test]
fn what_was_best_survives_a_cancel() {
    let cancel = AtomicBool::new(false);
    let calls = AtomicUsize::new(0);
    let progress = |_: f64| {
        if calls.fetch_add(1, Ordering::Relaxed) == 1 {
            cancel.store(true, Ordering::Relaxed);
        }
    };
    let items = vec![item(ball(1.0)).with_count(200)];
    let mut layout = layout(&bay([9.0, 9.0, 9.0], items));
    let options = SearchOptions { cells: 40, rounds: 50, ..SearchOptions::default() };
    let control = Control { cancel: Some(&cancel), progress: Some(&progress), ..alone() };
    let found = layout.search(&options, &control).unwrap();
    assert!(found.end == SearchEnd::Cancelled && found.rounds < 50, "{found:?}");
    assert!(found.placed >= 60 && layout.placed().len() as u64 == found.placed, "{found:?}");
    assert_proven(&layout);
    // A search cancelled at once keeps the earlier placements.
    let before = layout.placed().to_vec();
    let found = layout.search(&options, &Control { cancel: Some(&cancel), ..alone() }).unwrap();
    assert_eq!((found.end, found.placed), (SearchEnd::Cancelled, 0));
    assert_eq!(layout.placed(), before);
}

#[test]
fn budgets_end_a_search() {
    let items = vec![item(ball(1.0)).with_count(30)];
    let mut layout = layout(&bay([9.0, 9.0, 9.0], items));
    let options = SearchOptions { cells: 40, max_tests: Some(7), ..SearchOptions::default() };
    let found = layout.search(&options, &alone()).unwrap();
    assert_eq!((found.end, found.tests), (SearchEnd::Budget, 7));
    assert!(found.placed <= 7);
    assert_proven(&layout);
    let found = layout.search(&SearchOptions { max_tests: None, ..options }, &alone()).unwrap();
    assert_eq!((found.end, layout.placed().len()), (SearchEnd::Complete, 30));
    // All items are placed, so that nothing remains to do.
    let found = layout.search(&options, &alone()).unwrap();
    assert_eq!((found.end, found.placed, found.tests), (SearchEnd::Complete, 0, 0));
}

/// The last placed item is taken out first. Its way out meets none of the earlier items.
#[test]
fn items_get_out_along_a_direction() {
    let hook = Csg::cuboid([0.0; 3], [3.0, 1.0, 1.0]).unwrap();
    let hook = Csg::union_of([
        hook,
        Csg::cuboid([0.0; 3], [1.0, 1.0, 3.0]).unwrap(),
        Csg::cuboid([0.0, 0.0, 2.5], [3.0, 1.0, 3.0]).unwrap(),
    ])
    .unwrap();
    for way in [Direction { axis: 2, upward: true }, Direction { axis: 0, upward: false }] {
        let items = vec![item(AnySolid::new(hook.clone())).with_count(20)];
        let mut layout = layout(&bay_in(cuboid([7.0; 3]), items, [0.05, 0.0]));
        let options = SearchOptions {
            objective: Objective::Density,
            free_along: Some(way),
            cells: 42,
            rounds: 2,
            ..SearchOptions::default()
        };
        let found = layout.search(&options, &alone()).unwrap();
        assert!(found.placed >= 6, "{found:?}");
        assert_proven(&layout);
        while let Some(last) = layout.placed().len().checked_sub(1) {
            let rows = *layout.placed()[last].placement.rows();
            for step in 0..=60 {
                let mut moved = rows;
                moved[usize::from(way.axis)][3] += if way.upward { 0.125 } else { -0.125 } * f64::from(step);
                layout.move_to(last, &Affine::new(moved).unwrap()).unwrap();
                let standing = layout.check(last, &alone()).unwrap();
                let others = standing.conflicts.iter().filter(|near| near.other != Beside::Wall);
                assert_eq!(others.count(), 0, "{last} {step}: {standing:?}");
            }
            layout.remove(last).unwrap();
        }
    }
}

#[test]
fn the_centre_of_gravity_goes_where_it_should() {
    let heavy = item(cuboid([2.0; 3])).with_count(3).with_density(5.0).unwrap();
    let light = item(ball(0.8)).with_count(12);
    for target in [[5.0, 5.0, 5.0], [4.0, 6.0, 3.0]] {
        let mut layout = layout(&bay([10.0; 3], vec![heavy.clone(), light.clone()]));
        let options =
            SearchOptions { objective: Objective::Balance(target), cells: 40, ..SearchOptions::default() };
        let found = layout.search(&options, &alone()).unwrap();
        assert_eq!(found.left, 0);
        assert_proven(&layout);
        let centre = layout.measures(1e-3, &alone()).unwrap().centroid.unwrap();
        let off: f64 = (0..3)
            .map(|k| (0.5 * (centre[k].lower + centre[k].upper) - target[k]).powi(2))
            .sum::<f64>()
            .sqrt();
        assert!(off < 0.1, "{off}");
    }
}

/// Placing as many items as possible has priority: two cubes just fit, and neither can stand in the middle.
#[test]
fn balance_leaves_nothing_out() {
    let mut layout = layout(&bay([20.0, 10.0, 10.0], vec![item(cuboid([10.0; 3])).with_count(2)]));
    let objective = Objective::Balance([10.0, 5.0, 5.0]);
    let found = layout.search(&SearchOptions { objective, ..SearchOptions::default() }, &alone()).unwrap();
    assert_eq!(found.left, 0);
    assert_proven(&layout);
}

/// Volume, mass, centroid and inertia of rotated blocks in closed form.
#[test]
fn what_a_layout_weighs() {
    let size = [2.0, 3.0, 4.0];
    let mut layout =
        layout(&bay([20.0; 3], vec![item(cuboid(size)).with_density(2.5).unwrap(), item(ball(1.0))]));
    let empty = layout.measures(1e-6, &alone()).unwrap();
    assert_eq!(
        (empty.volume, empty.height, empty.centroid),
        (Interval::exactly(0.0), Interval::exactly(0.0), None)
    );
    let placements = [turned([0.3, 1.1], [5.0, 6.0, 4.0]), turned([2.0, 0.4], [13.0, 11.0, 7.0])];
    placements.iter().for_each(|placement| {
        layout.place(0, placement).unwrap();
    });
    let found = layout.measures(1e-9, &alone()).unwrap();
    let near = |interval: Interval, truth: f64| {
        let slack = 1e-12 * truth.abs().max(1.0);
        assert!(interval.lower <= truth + slack && truth - slack <= interval.upper, "{interval:?} {truth}");
        assert!(interval.width() < 1e-5 * truth.abs().max(1.0), "{interval:?} {truth}");
    };
    near(found.volume, 48.0);
    near(found.mass, 120.0);
    near(found.filled_part, 48.0 / 8000.0);
    let centres = placements.map(|placement| placement.apply(size.map(|side| 0.5 * side)));
    let centre = [0, 1, 2].map(|k| 0.5 * (centres[0][k] + centres[1][k]));
    (0..3).for_each(|k| near(found.centroid.unwrap()[k], centre[k]));
    let tensor = |about: [f64; 3], i: usize, j: usize| -> f64 {
        let mut sum = 0.0;
        for (placement, centre) in placements.iter().zip(centres) {
            let rows = placement.rows();
            // ∫ x xᵀ of a block about its centre, rotated.
            let second = |i: usize, j: usize| {
                (0..3).map(|k| rows[i][k] * rows[j][k] * 60.0 * size[k] * size[k] / 12.0).sum::<f64>()
            };
            let off = minus(centre, about);
            let along = |i: usize, j: usize| second(i, j) + 60.0 * off[i] * off[j];
            sum += match i == j {
                true => along((i + 1) % 3, (i + 1) % 3) + along((i + 2) % 3, (i + 2) % 3),
                false => -along(i, j),
            };
        }
        sum
    };
    for i in 0..3 {
        for j in 0..3 {
            near(found.inertia_about_origin[i][j], tensor([0.0; 3], i, j));
            near(found.inertia_about_centroid[i][j], tensor(centre, i, j));
        }
    }
    let top = placements.iter().flat_map(|placement| {
        (0..8).map(|k| placement.apply([0, 1, 2].map(|i| if k >> i & 1 == 0 { 0.0 } else { size[i] }))[2])
    });
    near(found.height, top.fold(0.0, f64::max));
}

/// Containers that are not boxes, and obstacles.
#[test]
fn containers_of_all_kinds() {
    let hollow = Csg::ball([0.0; 3], 6.0).unwrap();
    let frame = Frame::new([-8.0; 3], 16.0, 6).unwrap();
    let stored = build(&hollow, &frame, Rule::Certified, &alone()).unwrap();
    let made = surface::boundary(&hollow, &frame.with_depth(12).unwrap(), 0.02, &alone()).unwrap();
    let mesh = MeshSolid::new(made.mesh().clone(), FillRule::default()).unwrap();
    for container in [AnySolid::new(hollow), AnySolid::new(stored), AnySolid::new(mesh)] {
        let is_stored = container.home().is_some();
        let items = vec![item(cuboid([2.0; 3])).with_count(30)];
        let mut layout = layout(&bay_in(container, items, [0.05, 0.1]));
        // In the middle the place is free; beside the wall it is not; outside even less.
        for (x, expected) in
            [(-1.0, GapVerdict::Yes), (3.9, GapVerdict::No), (5.0, GapVerdict::No), (40.0, GapVerdict::No)]
        {
            let number = layout.place(0, &to([x, -1.0, -1.0])).unwrap();
            let found = layout.check(number, &alone()).unwrap();
            // (An octree knows its boundary only to its cells.)
            let is_close = found.verdict == GapVerdict::Undecided && x == 3.9 && is_stored;
            assert!(found.verdict == expected || is_close, "{x}: {found:?}");
            layout.remove(number).unwrap();
        }
        let options = SearchOptions { cells: 48, rounds: 1, ..SearchOptions::default() };
        let found = layout.search(&options, &alone()).unwrap();
        assert!(found.placed >= 20, "{found:?}");
        assert_proven(&layout);
        for placed in layout.placed() {
            for k in 0..8 {
                let corner =
                    placed.placement.apply([0, 1, 2].map(|i| if k >> i & 1 == 0 { 0.0 } else { 2.0 }));
                assert!(length(corner) <= 5.91, "{}", length(corner));
            }
        }
    }
}

/// Faces in one plane: blocks that touch each other and the walls do not overlap. Near contacts of meshes are
/// reported.
#[test]
fn what_touches_is_apart() {
    let items = vec![item(cuboid([2.0; 3])).with_count(27)];
    let mut layout = layout(&bay([6.0; 3], items));
    let found = layout.search(&SearchOptions::default(), &alone()).unwrap();
    assert_eq!((found.placed, found.end), (27, SearchEnd::Complete));
    assert_proven(&layout);
    let standing: Standing = layout.check(13, &alone()).unwrap();
    assert!(standing.nearest.unwrap().gap.contains(0.0));
    // With a clearance between items and one to the wall that leave no room.
    let cubes = || vec![item(cuboid([10.0; 3])).with_count(8)];
    for (side, clearance, wall_clearance) in [(21.0, 1.0, 0.0), (23.0, 1.0, 1.0), (20.5, 0.0, 0.25)] {
        let mut layout = self::layout(&bay_in(cuboid([side; 3]), cubes(), [clearance, wall_clearance]));
        let found = layout.search(&SearchOptions::default(), &alone()).unwrap();
        assert_eq!((found.placed, found.splits), (8, 0), "{side}");
        assert_proven(&layout);
    }
    // A ball in a corner of three walls, and one a little further.
    let mut layout = self::layout(&bay([6.0; 3], vec![item(ball(1.0))]));
    for (at, expected) in
        [(1.0, GapVerdict::Yes), (1.0 - 1e-9, GapVerdict::No), (1.0 + 1e-9, GapVerdict::Yes)]
    {
        let number = layout.place(0, &to([at; 3])).unwrap();
        assert_eq!(layout.check(number, &alone()).unwrap().verdict, expected, "{at}");
        layout.remove(number).unwrap();
    }
}

/// All conflicts are counted, even if not all are returned.
#[test]
fn conflicts_are_counted() {
    let mut layout = layout(&bay([4.0; 3], vec![item(cuboid([1.0; 3]))]));
    for _ in 0..300 {
        layout.place(0, &to([1.5; 3])).unwrap();
    }
    let found = layout.check(0, &alone()).unwrap();
    assert_eq!((found.conflicts.len(), found.conflict_count), (256, 299));
    assert_eq!(found.conflicts[255].other, Beside::Placed(256));
    let last = layout.check(299, &alone()).unwrap();
    assert_eq!((last.conflicts[0].other, last.conflict_count), (Beside::Placed(0), 299));
}

/// Clearances and items of any size, and limits of memory, give a layout or a clear error.
#[test]
fn sizes_of_any_kind() {
    for clearance in [20.0, 1e6, Bay::FURTHEST] {
        let items = vec![item(ball(1.0)).with_count(3)];
        let mut layout = layout(&bay_in(cuboid([6.0; 3]), items, [clearance, 0.0]));
        let found = layout.search(&SearchOptions::default(), &alone()).unwrap();
        assert_eq!((found.placed, found.left), (1, 2), "{clearance}");
    }
    // Items that are far too long are left; the others are placed.
    let wedge = |length: f64| {
        let block = Csg::cuboid([0.0; 3], [length; 3]).unwrap();
        let half = Csg::half_space([1.0, 1.0, -1.0], 0.0).unwrap();
        item(AnySolid::new(Csg::intersection_of([block, half]).unwrap()))
    };
    for length in [40.0, 1e9] {
        let mut layout = layout(&bay([6.0; 3], vec![wedge(length), wedge(2.0).with_count(4)]));
        let options = SearchOptions { cells: 24, rounds: 1, ..SearchOptions::default() };
        let found = layout.search(&options, &alone()).unwrap();
        assert_eq!((found.placed, found.left), (4, 1), "{length}");
        assert_proven(&layout);
    }
    let mut layout = layout(&bay([6.0; 3], vec![wedge(5.0).with_count(3)]));
    let options = SearchOptions { cells: 64, ..SearchOptions::default() };
    for (most, is_enough) in [(1 << 10, false), (1 << 20, false), (1 << 30, true)] {
        let found = layout.search(&options, &Control { max_bytes: Some(most), ..alone() });
        match found {
            Ok(found) => assert!(is_enough && found.placed >= 1, "{most} {found:?}"),
            Err(Error::TooLarge { limit, .. } | Error::Limit { limit, .. }) => {
                assert!(!is_enough && limit <= most && layout.placed().is_empty(), "{most} {limit}");
            }
            Err(error) => panic!("{error}"),
        }
    }
}

#[test]
fn what_is_refused() {
    let refused = |found: Result<(), Error>| match found {
        Err(Error::Argument { name, .. }) => name,
        Err(error) => panic!("{error}"),
        Ok(()) => "nothing",
    };
    let mut good = bay([4.0; 3], vec![item(cuboid([1.0; 3]))]);
    for wrong in [-1.0, f64::NAN, f64::INFINITY] {
        let with = |between, wall| {
            refused(Bay::new(cuboid([4.0; 3])).unwrap().with_clearances(between, wall).map(|_| ()))
        };
        assert_eq!(with(wrong, 0.0), "clearance");
        assert_eq!(with(0.0, wrong), "wall clearance");
        assert_eq!(with(0.0, 1.0), "nothing");
    }
    let endless = AnySolid::new(Csg::half_space([1.0, 0.0, 0.0], 0.0).unwrap());
    assert_eq!(refused(Bay::new(endless.clone()).map(|_| ())), "container");
    assert_eq!(refused(good.add_obstacle(endless.clone()).map(|_| ())), "obstacle");
    assert_eq!(good.add_obstacle(cuboid([1.0; 3])).unwrap(), 0);
    assert!(Item::new(endless).is_err() && Item::new(AnySolid::new(Csg::empty())).is_err());
    let one = || item(cuboid([1.0; 3]));
    assert!(one().with_density(0.0).is_err() && one().with_density(f64::NAN).is_err());
    assert!(one().with_orientations(Orientations::List(vec![])).is_err());
    for (count, is_good) in
        [(0, false), (1, true), (Orientations::MOST, true), (Orientations::MOST + 1, false)]
    {
        assert_eq!(one().with_orientations(Orientations::Free(count)).is_ok(), is_good, "{count}");
    }
    let mirror = Affine::new([[-1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]).unwrap();
    let larger = Affine::new([[1.1, 0.0, 0.0, 0.0], [0.0, 1.1, 0.0, 0.0], [0.0, 0.0, 1.1, 0.0]]).unwrap();
    for map in [mirror, larger] {
        assert!(one().with_orientations(Orientations::List(vec![map])).is_err());
        let mut layout = layout(&good);
        assert!(layout.place(0, &map).is_err() && layout.placed().is_empty());
        let number = layout.place(0, &Affine::IDENTITY).unwrap();
        assert!(layout.move_to(number, &map).is_err() && layout.placed()[0].placement == Affine::IDENTITY);
    }
    let mut layout = layout(&good);
    assert!(layout.place(1, &Affine::IDENTITY).is_err() && layout.check(0, &alone()).is_err());
    assert!(layout.remove(0).is_err() && layout.move_to(0, &Affine::IDENTITY).is_err());
    let options = SearchOptions::default();
    for wrong in [
        SearchOptions { rounds: 0, ..options },
        SearchOptions { cells: 3, ..options },
        SearchOptions { cells: 513, ..options },
        SearchOptions { free_along: Some(Direction { axis: 3, upward: true }), ..options },
        SearchOptions { objective: Objective::Balance([f64::NAN, 0.0, 0.0]), ..options },
    ] {
        assert!(layout.search(&wrong, &alone()).is_err(), "{wrong:?}");
    }
    // Items that are too large, and an empty layout, are no errors.
    let none = layout_of(vec![]);
    assert_eq!(none, (0, 0, SearchEnd::Complete));
    assert_eq!(layout_of(vec![item(cuboid([5.0; 3]))]), (0, 1, SearchEnd::Rounds));
    assert_eq!(layout_of(vec![item(cuboid([1.0; 3])).with_count(0)]), (0, 0, SearchEnd::Complete));
    let exact = cuboid([4.0; 3]);
    assert_eq!(exact.motion(), Motion::Exact);
    assert_eq!(layout_of(vec![item(exact)]), (1, 0, SearchEnd::Complete));
}

fn layout_of(items: Vec<Item>) -> (u64, u64, SearchEnd) {
    let mut layout = layout(&bay([4.0; 3], items));
    let found = layout.search(&SearchOptions::default(), &alone()).unwrap();
    assert_proven(&layout);
    (found.placed, found.left, found.end)
}
