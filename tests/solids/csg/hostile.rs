//! Expressions that nobody would write by hand: enormous, deep, doubled over and over, with numbers at the
//! ends of their ranges. Each gives a result or a clear error, and soon.

use leafless::solid::HalfSpace;
use leafless::{
    Affine, AnySolid, Cell, Classifier, Csg, Error, Frame, Rule, Solid, Tag, Verdict, Worker, build,
};
use leafless_testkit::cubes::Plain;
use leafless_testkit::{alone, lattice_frame};
use std::time::{Duration, Instant};

/// Runs work within a time limit: far more than the work needs, and far less than work of a worse complexity
/// would need.
fn soon<T>(work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    let taken = start.elapsed();
    assert!(taken < Duration::from_secs(120), "{taken:?}");
    result
}

fn root(csg: &Csg, frame: &Frame) -> Result<Tag, Error> {
    Ok(csg.on(frame, &alone())?.worker()?.root()?.tag())
}

fn exterior(csg: &Csg, frame: &Frame) -> Result<Tag, Error> {
    Ok(csg.on(frame, &alone())?.exterior())
}

/// Descends from the universe through one cell of each level.
fn descend(csg: &Csg, frame: &Frame) -> u8 {
    let mut worker = csg.on(frame, &alone()).unwrap().worker().unwrap();
    let mut cell = Cell::ROOT;
    let mut verdict = worker.root().unwrap();
    while let (Verdict::Partial(part), true) = (&verdict, cell.level < frame.depth()) {
        let children = worker.split(cell, part).unwrap();
        let partial = (0..).zip(children).find(|(_, child)| child.tag() == Tag::Partial);
        let Some((k, child)) = partial else { break };
        (cell, verdict) = (cell.child(k), child);
    }
    cell.level
}

fn ball(at: f64) -> Csg {
    Csg::ball([at, 8.0, 8.0], 4.0).unwrap()
}

#[test]
fn operations_by_the_hundred_thousand_that_come_to_nothing() {
    let frame = lattice_frame(4);
    soon(|| {
        let parts = (0..300_000).map(|_| Csg::intersection_of([Csg::everything(), Csg::empty()]).unwrap());
        let csg = Csg::union_of(parts).unwrap();
        assert_eq!(root(&csg, &frame).unwrap(), Tag::Empty);
        assert_eq!(exterior(&csg, &frame).unwrap(), Tag::Empty);
        assert_eq!(root(&csg.complement(), &frame).unwrap(), Tag::Full);
    });
}

#[test]
fn a_hundred_thousand_balls() {
    let frame = lattice_frame(4);
    soon(|| {
        let n = 100_000;
        let balls = (0..n).map(|i| Csg::ball([16.0 * i as f64 / n as f64, 8.0, 8.0], 0.01).unwrap());
        let csg = Csg::union_of(balls).unwrap();
        assert_eq!(descend(&csg, &frame), 4);
    });
}

#[test]
#[ignore = "a gigabyte"]
fn a_million_balls() {
    let frame = lattice_frame(4);
    soon(|| {
        let n = 1_000_000;
        let balls = (0..n).map(|i| Csg::ball([16.0 * i as f64 / n as f64, 8.0, 8.0], 0.01).unwrap());
        let csg = Csg::union_of(balls).unwrap();
        assert_eq!(descend(&csg, &frame), 4);
    });
}

#[test]
fn deep_chains() {
    let frame = lattice_frame(4);
    let n = 100_000;
    let far = ball(100.0);
    let near = ball(8.0);
    let shift = |by: f64| Affine::translation([by, 0.0, 0.0]).unwrap();
    let identity = Affine::IDENTITY;
    type Step<'a> = &'a dyn Fn(usize, &Csg) -> Csg;
    let steps: [(Step<'_>, Tag); 8] = [
        (&|_, csg| csg.difference(&far).unwrap(), Tag::Partial),
        (&|_, csg| far.difference(csg).unwrap(), Tag::Empty),
        (&|_, csg| csg.complement(), Tag::Partial),
        (&|i, csg| csg.placed(&shift(if i % 2 == 0 { 0.25 } else { -0.25 })).unwrap(), Tag::Partial),
        (&|_, csg| csg.placed(&identity).unwrap(), Tag::Partial),
        (&|_, csg| Csg::xor_of([csg.clone(), Csg::everything()]).unwrap(), Tag::Partial),
        (
            &|i, csg| {
                let pair = [csg.clone(), if i % 2 == 0 { far.clone() } else { far.complement() }];
                if i % 2 == 0 { Csg::union_of(pair) } else { Csg::intersection_of(pair) }.unwrap()
            },
            Tag::Partial,
        ),
        (&|_, csg| Csg::solid(AnySolid::new(csg.clone())), Tag::Partial),
    ];
    for (i, (step, expected)) in steps.into_iter().enumerate() {
        soon(|| {
            let csg = (0..n).fold(near.clone(), |csg, i| step(i, &csg));
            assert_eq!(root(&csg, &frame).unwrap(), expected, "step {i}");
            exterior(&csg, &frame).unwrap();
            if expected == Tag::Partial {
                assert_eq!(descend(&csg, &frame), 4, "step {i}");
            }
        });
    }
}

#[test]
fn deep_placements_end_in_a_limit() {
    let frame = lattice_frame(4);
    let near = ball(8.0);
    let rows = |a: f64, b: f64, t: f64| [[a, -b, 0.0, t], [b, a, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    for placement in [rows(0.6, 0.8, 0.0), rows(0.1, 0.3, 1.0), rows(3.0, 1.0, 0.5), rows(1e-19, 1e19, 1.0)] {
        let placement = Affine::new(placement).unwrap();
        soon(|| {
            let csg = (0..100_000).fold(near.clone(), |csg, _| csg.placed(&placement).unwrap());
            assert!(matches!(root(&csg, &frame), Err(Error::Limit { .. })), "{placement:?}");
            assert!(matches!(exterior(&csg, &frame), Err(Error::Limit { .. })), "{placement:?}");
        });
    }
    // Numbers do not get longer, but larger and larger, or smaller.
    let frame = Frame::new([1.0; 3], 16.0, 4).unwrap();
    for scale in [2.0, 0.5, 2f64.powi(64), 2f64.powi(-64)] {
        let placement =
            Affine::new([[scale, 0.0, 0.0, 0.0], [0.0, scale, 0.0, 0.0], [0.0, 0.0, scale, 0.0]]).unwrap();
        for (deep, wide) in [(300, 300), (50_000, 2), (100_000, 100)] {
            soon(|| {
                let csg = (0..deep).fold(near.clone(), |csg, _| csg.placed(&placement).unwrap());
                let csg = Csg::union_of((0..wide).map(|_| csg.clone())).unwrap();
                match root(&csg, &frame) {
                    Err(Error::Limit { .. }) => {}
                    result => assert_eq!(result.unwrap(), Tag::Empty, "{scale} {deep} {wide}"),
                }
            });
        }
    }
}

#[test]
fn doubled_over_and_over() {
    let frame = lattice_frame(4);
    let solid = Csg::solid(AnySolid::new(Plain::cuboid([1.0; 3], [3.0; 3]).unwrap()));
    type Join = fn([Csg; 2]) -> Result<Csg, Error>;
    let joins: [Join; 3] =
        [|pair| Csg::union_of(pair), |pair| Csg::intersection_of(pair), |pair| Csg::xor_of(pair)];
    for start in [ball(8.0), solid, Csg::empty()] {
        for join in joins {
            for times in [23, 30, 64, 1000] {
                soon(|| {
                    let csg = (0..times).fold(start.clone(), |csg, _| join([csg.clone(), csg]).unwrap());
                    assert!(matches!(root(&csg, &frame), Err(Error::Limit { .. })));
                    assert!(matches!(root(&csg.complement(), &frame), Err(Error::Limit { .. })));
                    let tree = build(&csg, &frame, Rule::Certified, &alone());
                    assert!(matches!(tree, Err(Error::Limit { .. })));
                    assert!(matches!(exterior(&csg, &frame), Err(Error::Limit { .. })));
                    csg.bounds();
                });
            }
        }
    }
}

#[test]
fn what_is_refused() {
    let refused = |result: Result<Csg, Error>| assert!(matches!(result, Err(Error::Argument { .. })));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 5e-324, 1e-300, -1e-80, 1e300, f64::MIN_POSITIVE]
    {
        refused(Csg::half_space([1.0, bad, 0.0], 1.0));
        refused(Csg::half_space([1.0, 0.0, 0.0], bad));
        for i in 0..10 {
            let mut c = [1.0; 10];
            c[i] = bad;
            refused(HalfSpace::quadric(c).map(Csg::from));
        }
        refused(Csg::cuboid([bad, 0.0, 0.0], [1.0; 3]));
        refused(Csg::cuboid([0.0; 3], [1.0, bad, 1.0]));
        refused(Csg::ball([0.0, bad, 0.0], 1.0));
        refused(Csg::ball([0.0; 3], bad));
        refused(Csg::ellipsoid([0.0; 3], [1.0, 1.0, bad]));
        refused(Csg::cylinder(bad, 0.0, 1.0));
        refused(Csg::frustum(bad, 1.0, 0.0, 1.0));
        refused(Csg::frustum(0.0, bad, 0.0, 1.0));
        refused(Csg::cylinder(1.0, bad, 2.0));
        refused(Csg::cylinder(1.0, -2.0, bad));
        for i in 0..12 {
            let mut rows = *Affine::IDENTITY.rows();
            rows[i / 4][i % 4] = bad;
            assert!(Affine::new(rows).is_err());
        }
    }
    refused(Csg::half_space([0.0, -0.0, 0.0], 1.0));
    refused(HalfSpace::quadric([0.0, -0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]).map(Csg::from));
    refused(Csg::cuboid([1.0; 3], [1.0, 2.0, 2.0]));
    refused(Csg::ball([0.0; 3], -1.0));
    refused(Csg::frustum(0.0, 0.0, 0.0, 1.0));
    refused(Csg::frustum(-1.0, 1.0, 0.0, 1.0));
    refused(Csg::cylinder(1.0, 1.0, 1.0));
}

#[test]
fn numbers_at_the_ends_of_their_ranges() {
    let [least, most] = [2f64.powi(-256), 2f64.powi(256)];
    for (origin, edge) in
        [([0.0; 3], most), ([0.0; 3], least), ([most; 3], least), ([-most, least, 0.0], 1.0)]
    {
        for depth in [1, 20] {
            let frame = Frame::new(origin, edge, depth).unwrap();
            for c in [least, 1.0, most] {
                let solids = [
                    Csg::half_space([c, -least, most], -c).unwrap(),
                    HalfSpace::quadric([c, -most, least, 0.0, 0.0, 0.0, c, -c, least, -most]).unwrap().into(),
                    HalfSpace::quadric([c, -most, least, most, least, -c, c, -c, least, -most])
                        .unwrap()
                        .into(),
                    Csg::ball([c, most, -least], c).unwrap(),
                    Csg::ellipsoid([c, 0.0, -c], [least, c, most]).unwrap(),
                    Csg::frustum(least, c, -most, most).unwrap(),
                    Csg::cuboid([-c, -most, least], [least, most, c.max(1.0)]).unwrap(),
                ];
                for solid in &solids {
                    descend(solid, &frame);
                    exterior(solid, &frame).unwrap();
                    descend(&solid.complement(), &frame);
                }
                descend(&Csg::xor_of(solids).unwrap(), &frame);
            }
        }
    }
}

#[test]
fn no_operands() {
    let frame = lattice_frame(2);
    for (csg, tag) in [
        (Csg::empty(), Tag::Empty),
        (Csg::everything(), Tag::Full),
        (Csg::union_of([]).unwrap(), Tag::Empty),
        (Csg::intersection_of([]).unwrap(), Tag::Full),
        (Csg::xor_of([]).unwrap(), Tag::Empty),
        (Csg::xor_of([Csg::everything(), Csg::everything(), Csg::everything()]).unwrap(), Tag::Full),
        (Csg::everything().difference(&Csg::empty()).unwrap(), Tag::Full),
        (Csg::union_of([Csg::intersection_of([]).unwrap()]).unwrap(), Tag::Full),
    ] {
        assert_eq!(root(&csg, &frame).unwrap(), tag);
        assert_eq!(root(&csg.complement(), &frame).unwrap(), tag.complement());
        for (csg, tag) in [(csg.clone(), tag), (csg.complement(), tag.complement())] {
            let tree = build(&csg, &frame, Rule::Sampled, &alone()).unwrap();
            assert_eq!(tree.view().root_tag(), tag);
            assert_ne!(tree.view().exterior(), tag.complement());
        }
    }
}
