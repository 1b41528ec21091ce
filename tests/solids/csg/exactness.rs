//! For planes and quadrics without mixed products, the verdicts are the best possible ones at every level.

use super::extremes::{Powers, Separable, Torus, Truth};
use leafless::solid::HalfSpace;
use leafless::{Affine, Cell, Classifier, Csg, Frame, Solid, Verdict, Worker};
use leafless_testkit::exact::Exact;
use leafless_testkit::{Random, alone};

/// Descends towards `target` (in finest cells) and away from it, and compares all verdicts on the way.
/// Returns the number of levels reached.
fn compare(solid: &Csg, truth: &Truth, frame: &Frame, target: [u32; 3], random: &mut Random) -> u8 {
    let mut worker = solid.on(frame, &alone()).unwrap().worker().unwrap();
    let mut verdict = worker.root().unwrap();
    assert_eq!(verdict.tag(), truth.tag(frame, Cell::ROOT), "universe {frame:?} {truth:?}");
    let mut cell = Cell::ROOT;
    // One descent in four leaves the target at some level.
    let leave = random.below(4 * frame.depth() as u64) as u8;
    while let (Verdict::Partial(part), true) = (verdict, cell.level < frame.depth()) {
        let children = worker.split(cell, &part).unwrap();
        for (k, child) in (0..).zip(&children) {
            assert_eq!(
                child.tag(),
                truth.tag(frame, cell.child(k)),
                "{:?} {frame:?} {truth:?}",
                cell.child(k)
            );
        }
        // A target on a lattice plane belongs to the cells on both sides. The first cut cell is chosen.
        let shift = frame.depth() - cell.level - 1;
        let near = |k: u8| {
            let child = cell.child(k);
            let close = (0..3).all(|axis| {
                let [low, high] = [child.at[axis] << shift, (child.at[axis] + 1) << shift];
                (low..=high).contains(&target[axis])
            });
            (cell.level < leave) == close
        };
        let partial = |k: &u8| matches!(children[*k as usize], Verdict::Partial(_));
        let first = random.below(8) as u8;
        let order = || (0..8).map(|k| k ^ first).filter(partial);
        let Some(next) = order().find(|&k| near(k)).or_else(|| order().next()) else { break };
        (cell, verdict) = (cell.child(next), children.into_iter().nth(next as usize).unwrap());
    }
    cell.level
}

/// Frames of all depths: with integer planes, with planes that are no doubles, far from the origin, enormous,
/// tiny.
fn frame(random: &mut Random) -> Frame {
    let depth = if random.below(2) == 0 { 20 } else { 1 + random.below(20) as u8 };
    let power = |e: i32| 2f64.powi(e);
    let (origin, edge) = match random.below(8) {
        0 | 1 => ([0.0; 3], (1u64 << depth) as f64),
        2 => ([-1.0; 3], 2.0),
        3 => ([0.1, -7.3, 1e5 / 3.0], 10.0 / 3.0),
        4 => ([1e9 + 0.1, -3.3e8, 0.7], 0.044),
        5 => ([power(200) / 3.0, -power(190), 0.0], power(195)),
        6 => ([power(-210), -power(-200) / 7.0, 0.0], power(-200)),
        _ => ([1e10, -1e10, 1e-10], 1e-9),
    };
    Frame::new(origin, edge, depth).unwrap()
}

/// A lattice vertex, mostly from a coarse lattice, so that cells of many levels touch it.
fn vertex(frame: &Frame, random: &mut Random) -> [u32; 3] {
    let level = random.below(frame.depth() as u64 + 1) as u32;
    [0; 3].map(|_| (random.below((1 << level) + 1) as u32) << (frame.depth() as u32 - level))
}

fn model(frame: &Frame, at: [u32; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| frame.plane(axis, at[axis]).lower)
}

fn run(count: u64, make: impl Fn(&Frame, [u32; 3], &mut Random) -> Option<(Csg, Truth)>) {
    let (mut levels, mut models) = (0, 0);
    for seed in 0..count {
        let mut random = Random(seed ^ 0x5EED);
        let frame = frame(&mut random);
        let target = vertex(&frame, &mut random);
        if let Some((solid, truth)) = make(&frame, target, &mut random) {
            levels += compare(&solid, &truth, &frame, target, &mut random) as u64;
            models += 1;
        }
    }
    println!("{models} models, {levels} levels");
    assert!(models > count / 4 && levels > models, "{models} models, {levels} levels");
}

fn half_space(c: [f64; 10]) -> Option<(Csg, Truth)> {
    let half_space = HalfSpace::quadric(c).ok()?;
    let truth = Separable::new([c[0], c[1], c[2], c[6], c[7], c[8], c[9]]);
    Some((half_space.into(), Truth::Separable(truth)))
}

fn planes(frame: &Frame, target: [u32; 3], random: &mut Random) -> Option<(Csg, Truth)> {
    let mut c = [0.0; 10];
    let scale = 2f64.powi(random.below(400) as i32 - 200);
    let wild = random.below(3) == 0;
    for axis in 0..3 {
        c[6 + axis] = match random.below(4) {
            0 => 0.0,
            1 => random.between(-1.0, 1.0),
            _ => random.below(9) as f64 - 4.0,
        } * if wild { 2f64.powi(random.below(500) as i32 - 250) } else { scale };
    }
    let p = model(frame, target);
    c[9] = -(0..3).map(|axis| c[6 + axis] * p[axis]).sum::<f64>();
    if random.below(3) == 0 {
        c[9] = if random.below(2) == 0 { c[9].next_up() } else { c[9].next_down() };
    }
    half_space(c)
}

/// Quadrics about a centre on the lattice that touch or nearly touch a vertex.
fn quadrics(frame: &Frame, target: [u32; 3], random: &mut Random) -> Option<(Csg, Truth)> {
    let p = model(frame, target);
    let centre = model(frame, vertex(frame, random));
    let mut c = [0.0; 10];
    for axis in 0..3 {
        c[axis] = match random.below(4) {
            0 => 0.0,
            1 => random.between(-1.0, 1.0),
            _ => random.below(5) as f64 - 2.0,
        };
        // Without a square term: a paraboloid's axis, or a cylinder's.
        c[6 + axis] = match c[axis] {
            0.0 => (random.below(3) as f64 - 1.0) * frame.edge(),
            square => -2.0 * square * centre[axis],
        };
    }
    if random.below(3) == 0 {
        let scale = 2f64.powi(random.below(100) as i32 - 50);
        let which = random.below(10) as usize;
        c[which] *= scale;
    }
    c[9] = -(0..3).map(|axis| (c[axis] * p[axis] + c[6 + axis]) * p[axis]).sum::<f64>();
    if random.below(3) == 0 {
        c[9] = if random.below(2) == 0 { c[9].next_up() } else { c[9].next_down() };
    }
    half_space(c)
}

/// Quadrics with any ten numbers of magnitudes between 2^-256 and 2^256.
fn anything(frame: &Frame, _: [u32; 3], random: &mut Random) -> Option<(Csg, Truth)> {
    let mut c = [0.0; 10];
    // Moderate numbers, so that some surfaces meet the universe: there, all terms have similar magnitudes.
    let size = frame.origin().iter().fold(frame.edge(), |size, c| size.max(c.abs()));
    for i in [0, 1, 2, 6, 7, 8, 9] {
        let degree = [2, 2, 2, 0, 0, 0, 1, 1, 1, 0][i];
        let spread = [1, 20, 200][random.below(3) as usize];
        let wild = 2f64.powi(random.below(2 * spread + 1) as i32 - spread as i32);
        if random.below(3) > 0 {
            c[i] = random.between(-1.0, 1.0) * wild / size.powi(degree);
        }
    }
    half_space(c)
}

/// Named ellipsoids, whose coefficients are no doubles.
fn ellipsoids(frame: &Frame, target: [u32; 3], random: &mut Random) -> Option<(Csg, Truth)> {
    let p = model(frame, target);
    let middle = vertex(frame, random);
    let centre = model(frame, middle);
    let axis = random.below(3) as usize;
    let distance = (p[axis] - centre[axis]).abs();
    let mut radii = [distance, distance * random.between(0.3, 3.0), frame.edge() * random.between(0.1, 0.7)];
    if random.below(2) == 0 {
        radii = [distance; 3];
    }
    radii.rotate_right(axis);
    let solid = Csg::ellipsoid(centre, radii).ok()?;
    let squares = radii.map(|r| Exact::from(r).times(&Exact::from(r)));
    let mut truth = Separable::new([0.0; 7]);
    truth.constant = squares[0].times(&squares[1]).times(&squares[2]);
    for axis in 0..3 {
        let (weight, at) =
            (squares[(axis + 1) % 3].times(&squares[(axis + 2) % 3]), Exact::from(centre[axis]));
        truth.square[axis] = Exact::from(0.0).minus(&weight);
        truth.linear[axis] = weight.times(&at).times(&Exact::from(2.0));
        truth.constant = truth.constant.minus(&weight.times(&at).times(&at));
    }
    Some((solid, Truth::Separable(truth)))
}

/// Powers about a centre on the lattice, through or nearly through a vertex.
fn powers(frame: &Frame, target: [u32; 3], random: &mut Random) -> Option<(Csg, Truth)> {
    let p = model(frame, target);
    let centre = model(frame, vertex(frame, random));
    let largest = [4, 10, 64][random.below(3) as usize];
    // The powers have magnitude one in the universe.
    let size = 2f64.powi(frame.edge().log2().ceil() as i32);
    let terms = [0, 1, 2].map(|axis| {
        let exponent = 1 + random.below(largest) as u32;
        let coefficient = match random.below(3) {
            0 => random.between(-1.0, 1.0),
            1 => 0.0,
            _ => random.below(5) as f64 - 2.0,
        };
        (coefficient / size.powi(exponent as i32), centre[axis], exponent)
    });
    let along = |axis: usize| terms[axis].0 * (p[axis] - centre[axis]).powi(terms[axis].2 as i32);
    let mut constant = -(along(0) + along(1) + along(2));
    if random.below(3) == 0 {
        constant = if random.below(2) == 0 { constant.next_up() } else { constant.next_down() };
    }
    let half_space = HalfSpace::power(terms, constant).ok()?;
    Some((half_space.into(), Truth::Powers(Powers { terms, constant })))
}

/// Tori about a centre on the lattice that touch a vertex or an edge.
fn tori(frame: &Frame, target: [u32; 3], random: &mut Random) -> Option<(Csg, Truth)> {
    let p = model(frame, target);
    let centre = model(frame, vertex(frame, random));
    let cell = frame.cell_size();
    let distance = (p[0] - centre[0]).abs();
    let height = (p[2] - centre[2]).abs();
    let [mut major, mut minor] = [0; 2].map(|_| random.between(0.05, 0.6) * frame.edge());
    match random.below(4) {
        0 => major = (distance - minor).abs(),
        1 => (major, minor) = (distance, height),
        2 => (major, minor) = ((major / cell).ceil() * cell, (minor / cell).ceil() * cell),
        _ => minor = major,
    }
    let torus = HalfSpace::torus(major, minor).ok()?;
    let placed = Csg::from(torus).placed(&Affine::translation(centre).ok()?).ok()?;
    Some((placed, Truth::Torus(Torus { centre, major, minor })))
}

#[test]
fn powers_are_exact() {
    run(800, powers);
}

#[test]
fn tori_are_exact() {
    run(800, tori);
}

#[test]
fn planes_are_exact() {
    run(1500, planes);
}

#[test]
fn quadrics_are_exact() {
    run(1000, quadrics);
    run(1000, anything);
}

#[test]
fn ellipsoids_are_exact() {
    run(500, ellipsoids);
}

#[test]
#[ignore = "minutes"]
fn many_half_spaces_are_exact() {
    run(100_000, planes);
    run(100_000, quadrics);
    run(100_000, anything);
    run(50_000, ellipsoids);
    run(50_000, powers);
    run(50_000, tori);
}
