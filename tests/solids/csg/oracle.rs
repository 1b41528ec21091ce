//! Constructive solid geometry against exact arithmetic without cells.

use super::points::{Found, Judge, centre};
use leafless::{Frame, Rule, Solid, Tag, build};
use leafless_testkit::csg::{Maker, Model};
use leafless_testkit::{Random, alone, fuzz, lattice_frame};

/// Frames whose planes are integers, exact doubles, or no doubles at all; far from the origin; and tiny.
pub(super) fn frames(depth: u8) -> [Frame; 5] {
    let frame = |origin, edge| Frame::new(origin, edge, depth).unwrap();
    [
        lattice_frame(depth),
        frame([-1.0; 3], 2.0),
        frame([0.1, -7.3, 1e5 / 3.0], 10.0 / 3.0),
        frame([1e9 + 0.1, -3.3e8, 0.7], 0.044),
        frame([-1e-20 / 3.0, 1e-20, 0.0], 3e-20),
    ]
}

/// Checks random points in `models` random models, each made by `make`.
fn no_lies(models: u64, points: u64, others: bool, make: impl Fn(&mut Maker<'_>) -> Model) {
    let mut found = Found::default();
    let mut made = 0;
    for seed in 0.. {
        let mut random = Random(seed);
        let depth = 1 + random.below(6) as u8;
        let frame = frames(depth)[random.below(5) as usize];
        let aligned = random.below(2) == 0;
        let mut maker = Maker { random: &mut random, frame, aligned, others };
        let model = make(&mut maker);
        // The library refuses arguments out of range.
        let Ok(csg) = model.csg(&frame) else { continue };
        let tree = build(&csg, &frame, Rule::Certified, &alone()).unwrap();
        let mut judge = Judge { model: &model, tree: &tree, bounds: csg.bounds(), found };
        judge.ask(points, &mut random);
        found = judge.found;
        made += 1;
        if made == models {
            assert!(seed < 2 * models, "most models are refused");
            break;
        }
    }
    println!("{models} models: {found:?}");
    let all = models * points;
    assert!(found.inside > all / 8 && found.outside > all / 8 && found.decided > all / 8, "{found:?}");
}

/// An expression with two placements, one after the other.
fn placed(maker: &mut Maker<'_>) -> Model {
    let part = maker.expression(1);
    let inner = Model::Placed(Box::new(part), maker.placement());
    Model::Placed(Box::new(inner), maker.placement())
}

#[test]
fn primitives_do_not_lie() {
    no_lies(400, 50, false, |maker| maker.primitive());
}

#[test]
fn expressions_do_not_lie() {
    no_lies(150, 60, false, |maker| maker.expression(3));
}

#[test]
fn placements_do_not_lie() {
    no_lies(200, 60, false, placed);
}

#[test]
fn expressions_with_other_solids_do_not_lie() {
    no_lies(150, 60, true, |maker| maker.expression(3));
}

#[test]
fn placements_of_other_solids_do_not_lie() {
    no_lies(100, 60, true, placed);
}

#[test]
#[ignore = "minutes"]
fn a_million_points_of_each_kind() {
    no_lies(10_000, 100, false, |maker| maker.primitive());
    no_lies(10_000, 100, false, |maker| maker.expression(4));
    no_lies(10_000, 100, false, placed);
    no_lies(10_000, 100, true, placed);
    no_lies(10_000, 100, true, |maker| maker.expression(4));
}

/// The sampled rule gives the exact decision at cell centres.
fn sampled(models: u64, make: impl Fn(&mut Maker<'_>) -> Model) {
    let mut boundary = 0;
    for seed in 0..models {
        let mut random = Random(seed ^ 0xABCD);
        let aligned = random.below(4) != 0;
        let frame = frames(1 + random.below(3) as u8)[random.below(if aligned { 2 } else { 5 }) as usize];
        let mut maker = Maker { random: &mut random, frame, aligned, others: false };
        let model = make(&mut maker);
        let Ok(csg) = model.csg(&frame) else { continue };
        let tree = build(&csg, &frame, Rule::Sampled, &alone()).unwrap();
        for at in leafless_testkit::positions(frame.depth()) {
            let probe = centre(&frame, at);
            boundary += (model.sign(&probe.at) == 0) as u64;
            let Some(inside) = model.sampled(&probe) else { continue };
            let expected = if inside { Tag::Full } else { Tag::Empty };
            assert_eq!(tree.view().tag_at(at), expected, "{at:?}\n{frame:?}\n{model:#?}");
        }
    }
    println!("{boundary} centres on the surface");
    assert!(boundary > models / 4);
}

#[test]
fn samples_are_exact() {
    sampled(150, |maker| maker.primitive());
    sampled(120, |maker| maker.expression(2));
}

/// Runs the fuzz target on inputs that are the same every time.
fn any_bytes(count: u64) {
    for seed in 0..count {
        let mut random = Random(seed);
        let length = 1 + random.below(120) as usize;
        // Mostly moderate numbers.
        let mut byte = || if random.below(20) == 0 { random.below(256) } else { 40 + random.below(100) };
        let data: Vec<u8> = (0..length).map(|_| byte() as u8).collect();
        // A failing test prints its input.
        let result = std::panic::catch_unwind(|| fuzz::csg(&data));
        assert!(result.is_ok(), "input {seed}: {data:?}");
    }
}

#[test]
fn what_the_fuzzer_found_interesting() {
    let corpus = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus/csg");
    let mut count = 0;
    for entry in std::fs::read_dir(&corpus).unwrap() {
        fuzz::csg(&std::fs::read(entry.unwrap().path()).unwrap());
        count += 1;
    }
    assert!(count > 100, "{count} inputs");
}

#[test]
fn any_bytes_are_expressions() {
    any_bytes(400);
}

#[test]
#[ignore = "minutes"]
fn more_bytes_are_expressions() {
    any_bytes(100_000);
}
