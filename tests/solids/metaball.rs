//! A solid defined outside the library: its cells in exact arithmetic, and its convergence.

use example::{Ball, Metaball, Step, plain_sum, three_balls};
use leafless::solid::Ask;
use leafless::{Cell, Classifier, Control, Frame, Interval, Rule, Solid, Verdict, Worker, build, measure};
use leafless_testkit::exact::Exact;
use leafless_testkit::slabs::told;
use leafless_testkit::{Random, Way};
use std::f64::consts::PI;

#[path = "../../examples/metaball.rs"]
mod example;

/// A frame in which all coordinates of planes, and of points between them, are doubles.
fn frame() -> Frame {
    Frame::new([-2.0; 3], 4.0, 20).unwrap()
}

/// Returns 1 if a point lies in the solid, 0 on its boundary: the sign of Σ rᵢ² / dᵢ² − 1, times all dᵢ².
fn sign(balls: &[Ball], p: [f64; 3]) -> i32 {
    let squares: Vec<Exact> = balls
        .iter()
        .map(|ball| {
            let along = [0, 1, 2].map(|axis| Exact::from(p[axis]).minus(&ball.centre[axis].into()));
            along.iter().fold(Exact::from(0.0), |sum, x| sum.plus(&x.times(x)))
        })
        .collect();
    let product = |left_out: usize| {
        let factors = squares.iter().enumerate().filter(|(i, _)| *i != left_out);
        factors.fold(Exact::from(1.0), |product, (_, square)| product.times(square))
    };
    let sum = balls.iter().enumerate().fold(Exact::from(0.0), |sum, (i, ball)| {
        let radius = Exact::from(ball.radius);
        sum.plus(&radius.times(&radius).times(&product(i)))
    });
    sum.minus(&product(usize::MAX)).sign()
}

fn point(cell: Cell, x: [f64; 3]) -> [f64; 3] {
    let half = 2.0 / f64::from(1u32 << cell.level);
    [0, 1, 2].map(|axis| -2.0 + half * (2.0 * f64::from(cell.at[axis]) + 1.0) + half * x[axis])
}

fn random_balls(random: &mut Random) -> Vec<([f64; 3], f64)> {
    let count = 1 + random.below(3);
    let balls = (0..count).map(|_| {
        let mut centre = [0; 3].map(|_| random.between(-1.0, 1.0));
        // Some centres are corners and centres of cells.
        if random.below(3) == 0 {
            centre = centre.map(|c| (c * 4.0).round() / 4.0);
        }
        let exponent = random.between(-12.0, 0.0);
        (centre, exponent.exp2())
    });
    balls.collect()
}

#[test]
fn what_it_says_of_cells_is_true() {
    let mut random = Random(1);
    let (mut slabs, mut inner, mut outer, mut decided) = (0, 0, 0, 0);
    for _ in 0..400 {
        let solid = Metaball::new(&random_balls(&mut random), Step::Slabs);
        let worker = solid.on(&frame(), &Control::default()).unwrap().worker().unwrap();
        let Some(mut way) = Way::new(worker) else { continue };
        loop {
            let known = way.worker.enclosure(way.cell, &way.part).unwrap();
            slabs += u32::from(known.is_some());
            for _ in 0..4 {
                let x = [0; 3].map(|_| random.below(17) as f64 / 8.0 - 1.0);
                // Slabs describe the open cell.
                let x = x.map(|x| x.clamp(-0.96875, 0.96875));
                let truth = sign(&solid.balls, point(way.cell, x));
                let said = known.map_or(0, |known| told(&known, x));
                assert!(said == 0 || truth == 0 || said == truth, "{solid:?} {:?} {x:?}", way.cell);
                inner += u32::from(said > 0);
                outer += u32::from(said < 0);
            }
            if way.cell.level == 20 {
                let inside = way.worker.sample(way.cell, &way.part).unwrap();
                let truth = sign(&solid.balls, point(way.cell, [0.0; 3]));
                // Within rounding of the boundary, doubles do not decide.
                let near = (plain_sum(&solid.balls, point(way.cell, [0.0; 3])) - 1.0).abs() < 1e-9;
                assert!(near || inside == Some(truth > 0), "{solid:?} {:?}", way.cell);
                break;
            }
            for (octant, verdict) in (0..8).zip(way.worker.split(way.cell, &way.part).unwrap()) {
                let x = [0; 3].map(|_| random.below(17) as f64 / 8.0 - 1.0);
                let truth = sign(&solid.balls, point(way.cell.child(octant), x));
                match verdict {
                    Verdict::Full => assert!(truth >= 0, "{solid:?} {:?} {octant}", way.cell),
                    Verdict::Empty => assert!(truth <= 0, "{solid:?} {:?} {octant}", way.cell),
                    _ => continue,
                }
                decided += 1;
            }
            if !way.descend(&mut random) {
                break;
            }
        }
    }
    // Silence is not enough to satisfy the law.
    assert!(
        slabs > 1000 && inner > 1000 && outer > 1000 && decided > 10_000,
        "{slabs} {inner} {outer} {decided}"
    );
}

#[test]
fn a_metaball_of_one_ball_is_the_ball() {
    for step in [Step::Cells, Step::Slabs] {
        let solid = Metaball::new(&[([0.1, -0.2, 0.3], 0.75)], step);
        let found = measure(&solid, &frame(), 3e-2, &Control::default()).unwrap();
        assert!(found.volume.contains(4.0 / 3.0 * PI * 0.75f64.powi(3)) && !found.clipped, "{found:?}");
    }
}

#[test]
fn slabs_make_it_converge_by_an_order() {
    let splits = |step, tolerance| {
        let found = measure(&three_balls(step), &frame(), tolerance, &Control::default()).unwrap();
        assert!(found.proof.is_certified() && !found.clipped);
        (found.volume, found.splits)
    };
    let (by_cells, many) = splits(Step::Cells, 1e-1);
    let (coarse, few) = splits(Step::Slabs, 1e-1);
    let (fine, more) = splits(Step::Slabs, 1e-3);
    for (a, b) in [(by_cells, coarse), (by_cells, fine), (coarse, fine)] {
        assert!(a.common(b).is_some(), "{a:?} {b:?}");
    }
    assert!(many > 20 * few, "{many} {few}");
    // A hundred times the precision takes a hundred times the splits, where cells alone would take ten
    // thousand times as many.
    assert!(more < 400 * few, "{more} {few}");
    let sampled =
        build(&three_balls(Step::Slabs), &frame().with_depth(7).unwrap(), Rule::Sampled, &Control::default());
    let volume: Interval = sampled.unwrap().statistics().volume();
    let middle = 0.5 * (fine.lower + fine.upper);
    assert!((volume.lower - middle).abs() < 1e-2 * middle, "{volume:?} {fine:?}");
}

#[test]
fn the_example_runs() {
    example::main().unwrap();
}
