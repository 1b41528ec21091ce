//! The enclosures from a host program's functions, their use in measures, bounding boxes and adaptive
//! octrees, and invalid values.

use leafless::solid::{Adaptive, Ask, GradientRange, TangentBalls};
use leafless::{
    AnySolid, Bounds, Callback, Classifier, Control, Error, Frame, Interval, Membership, Octree, Rule, Solid,
    SurfaceOptions, Verdict, Worker, bounding_box, build, build_extended, contains, measure,
};
use std::f64::consts::PI;

/// A margin larger than the rounding errors of all functions here.
const MARGIN: f64 = 1e-13;

const CENTRE: [f64; 3] = [0.1, -0.05, 0.025];
const RADIUS: f64 = 0.75;

fn about(value: f64) -> Interval {
    Interval::new(value - MARGIN, value + MARGIN).unwrap()
}

/// Decides boxes by the middle value and the gradient's bounds of a function that is negative inside.
fn decide(range: &GradientRange, min: [f64; 3], max: [f64; 3]) -> Verdict<()> {
    let spread: f64 = (0..3)
        .map(|axis| {
            let slope = range.gradient[axis].lower.abs().max(range.gradient[axis].upper.abs());
            0.5 * slope * (max[axis] - min[axis])
        })
        .sum();
    if range.value.lower - spread - MARGIN >= 0.0 {
        Verdict::Empty
    } else if range.value.upper + spread + MARGIN <= 0.0 {
        Verdict::Full
    } else {
        Verdict::Partial(())
    }
}

fn middle(min: [f64; 3], max: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| 0.5 * (min[axis] + max[axis]))
}

/// A shape by a function and its gradient's range over boxes. `helps` says whether the shape provides the
/// gradient.
fn shape(
    range: impl Fn([f64; 3], [f64; 3], [f64; 3]) -> GradientRange + Send + Sync + Copy + 'static,
    helps: bool,
) -> AnySolid {
    let callback = Callback::new(move |min, max| Ok(decide(&range(min, max, middle(min, max)), min, max)));
    if !helps {
        return AnySolid::new(callback);
    }
    AnySolid::new(callback.with_gradient(move |min, max, middle| Ok(Some(range(min, max, middle)))))
}

/// The function |p − c|² − r².
fn ball(min: [f64; 3], max: [f64; 3], middle: [f64; 3]) -> GradientRange {
    let value = (0..3).map(|axis| (middle[axis] - CENTRE[axis]).powi(2)).sum::<f64>() - RADIUS * RADIUS;
    let gradient = [0, 1, 2].map(|axis| {
        Interval::new(2.0 * (min[axis] - CENTRE[axis]) - MARGIN, 2.0 * (max[axis] - CENTRE[axis]) + MARGIN)
            .unwrap()
    });
    GradientRange { value: about(value), gradient }
}

/// The function sin x cos y + sin y cos z + sin z cos x. Each product changes its derivative by at most the
/// edge of a box for each coordinate.
fn gyroid(min: [f64; 3], max: [f64; 3], [x, y, z]: [f64; 3]) -> GradientRange {
    let value = x.sin() * y.cos() + y.sin() * z.cos() + z.sin() * x.cos();
    let slopes = [
        x.cos() * y.cos() - z.sin() * x.sin(),
        y.cos() * z.cos() - x.sin() * y.sin(),
        z.cos() * x.cos() - y.sin() * z.sin(),
    ];
    let half = (0..3).map(|axis| 0.5 * (max[axis] - min[axis])).fold(0.0, f64::max);
    // For x: |sin x cos y| + |sin z cos x|, |cos x sin y|, |cos z sin x|, and so on.
    let spread = 4.0 * half * (1.0 + 1e-9) + MARGIN;
    let gradient = slopes.map(|slope| Interval::new(slope - spread, slope + spread).unwrap());
    GradientRange { value: about(value), gradient }
}

/// The ball by its nearest point. It promises a touching ball of this curvature outside.
fn touching(outer_curvature: f64) -> AnySolid {
    let callback = Callback::new(|min, max| Ok(decide(&ball(min, max, middle(min, max)), min, max)));
    AnySolid::new(callback.with_tangent(move |_, _, middle| {
        let off = [0, 1, 2].map(|axis| middle[axis] - CENTRE[axis]);
        let distance = off.iter().map(|c| c * c).sum::<f64>().sqrt();
        Ok((distance > 0.01).then(|| TangentBalls {
            point: [0, 1, 2].map(|axis| CENTRE[axis] + off[axis] * (RADIUS / distance)),
            normal: off,
            inner_curvature: 1.0 / RADIUS,
            outer_curvature,
            error: MARGIN,
        }))
    }))
}

fn universe(depth: u8) -> Frame {
    Frame::new([-1.0; 3], 2.0, depth).unwrap()
}

fn one_thread() -> Control<'static> {
    Control::threads(1)
}

/// Returns the relative volume width times the number of splits, for tolerances that fall by factors of 10.
/// The products are about constant if the width falls with 1/N.
fn products(solid: &AnySolid, frame: &Frame, truth: f64, tolerances: &[f64]) -> Vec<f64> {
    let product = |&tolerance: &f64| {
        let found = measure(solid, frame, tolerance, &one_thread()).unwrap();
        assert!(found.volume.contains(truth), "{found:?}");
        assert!(found.volume.width() <= tolerance * truth, "{found:?}");
        let width = found.volume.width() / truth;
        println!(
            "{tolerance:e}: {width:.2e} with {} splits: {:.1}",
            found.splits,
            width * found.splits as f64
        );
        width * found.splits as f64
    };
    tolerances.iter().map(product).collect()
}

#[test]
fn volumes_converge_with_the_number_of_splits() {
    let truth = 4.0 / 3.0 * PI * RADIUS.powi(3);
    // The result equals that of the slabs of half-spaces for the same ball, without their moments.
    const HALF_SPACE: f64 = 6.8;
    for (name, solid) in [
        ("gradient", shape(ball, true)),
        ("two balls", touching(1.0 / RADIUS)),
        ("half-space outside", touching(0.0)),
        ("exact curvature", touching(-1.0 / RADIUS)),
    ] {
        println!("{name}");
        let found = products(&solid, &universe(20), truth, &[1e-1, 1e-2, 1e-3]);
        assert!(found[2] < 3.0 * found[0] && found[2] < 6.0 * HALF_SPACE, "{name}: {found:?}");
    }
    // Without the gradient, the width falls with the square root of the splits.
    let alone = products(&shape(ball, false), &universe(20), truth, &[0.5, 0.1]);
    assert!(alone[1] > 3.0 * alone[0], "{alone:?}");
}

#[test]
fn half_of_a_cube_lies_within_a_gyroid() {
    // The function is odd.
    let frame = Frame::new([-3.0; 3], 6.0, 20).unwrap();
    let found = products(&shape(gyroid, true), &frame, 108.0, &[1e-1, 1e-2, 1e-3]);
    assert!(found[2] < 3.0 * found[0], "{found:?}");
}

#[test]
fn verdicts_do_not_depend_on_it() {
    let frame = universe(6);
    let tree = |solid: &AnySolid| -> Octree { build(solid, &frame, Rule::Certified, &one_thread()).unwrap() };
    assert_eq!(tree(&shape(ball, true)), tree(&shape(ball, false)));
    assert_eq!(tree(&touching(0.0)), tree(&shape(ball, false)));
    // The same measures by any number of threads.
    let by = |threads| measure(&touching(0.0), &universe(20), 1e-3, &Control::threads(threads)).unwrap();
    assert_eq!(by(1), by(3));
}

#[test]
fn bounding_boxes_and_adaptive_octrees_use_it() {
    for solid in [shape(ball, true), touching(1.0 / RADIUS)] {
        let found = bounding_box(&solid, &universe(20), 1e-6, &one_thread()).unwrap();
        assert!(found.splits < 20_000, "{found:?}");
        let [min, max] = found.corners.unwrap();
        for axis in 0..3 {
            let (low, high) = (CENTRE[axis] - RADIUS, CENTRE[axis] + RADIUS);
            assert!(min[axis].contains(low) && max[axis].contains(high), "{found:?}");
        }
        let frame = universe(8);
        let nodes = |solid: &dyn Fn() -> Octree| solid().statistics().nodes();
        let whole = nodes(&|| build(&solid, &frame, Rule::Certified, &one_thread()).unwrap());
        let adaptive = Adaptive::new(solid.clone(), 0.01).unwrap();
        let coarse = nodes(&|| build(&adaptive, &frame, Rule::Certified, &one_thread()).unwrap());
        assert!(coarse * 20 < whole, "{coarse} {whole}");
    }
}

/// The slabs of a host's function in an extended tree, for any number of threads.
#[test]
fn extended_octrees_keep_its_slabs() {
    let (frame, options) = (universe(9), SurfaceOptions { tolerance: Some(0.01) });
    let tree = build_extended(&shape(ball, true), &frame, &options, &one_thread()).unwrap();
    assert_eq!(build_extended(&shape(ball, true), &frame, &options, &Control::threads(3)).unwrap(), tree);
    tree.view().check().unwrap();
    let cuts = tree.view().cuts().unwrap();
    assert!(cuts.given_up == 0 && cuts.cells == cuts.surfaces, "{cuts:?}");
    let volume = measure(&tree, &frame, 1e-9, &one_thread()).unwrap().volume;
    let truth = 4.0 / 3.0 * PI * RADIUS.powi(3);
    assert!(volume.contains(truth) && volume.width() < 0.02 * 4.0 * PI * RADIUS * RADIUS, "{volume:?}");
    let points: Vec<[f64; 3]> = (0..4000)
        .map(|k| {
            let (turn, rise) = (0.61803 * k as f64, (k as f64 + 0.5) / 2000.0 - 1.0);
            let (level, depth) = ((1.0 - rise * rise).sqrt(), (k % 41 - 20) as f64 * 0.001);
            let way = [level * turn.cos(), level * turn.sin(), rise];
            [0, 1, 2].map(|axis| CENTRE[axis] + (RADIUS - depth) * way[axis])
        })
        .collect();
    let mut answers = vec![Membership::Undecided; points.len()];
    contains(&tree, &frame, &points, &mut answers, &one_thread()).unwrap();
    for (k, answer) in answers.into_iter().enumerate() {
        let depth = (k as i64 % 41 - 20) as f64 * 0.001;
        match answer {
            Membership::Inside => assert!(depth > -1e-9, "{depth}"),
            Membership::Outside => assert!(depth < 1e-9, "{depth}"),
            // A slab is as thick as the tolerance.
            Membership::Undecided => assert!(depth.abs() < 0.01, "{depth}"),
        }
    }
}

fn asked(solid: &AnySolid) -> Result<u32, Error> {
    let mut worker = solid.on(&universe(4), &one_thread())?.worker()?;
    let Verdict::Partial(root) = worker.root()? else { panic!("decided") };
    let mut known = worker.enclosure(leafless::Cell::ROOT, &root)?.is_some() as u32;
    for (octant, verdict) in (0..8).zip(worker.split(leafless::Cell::ROOT, &root)?) {
        let Verdict::Partial(part) = verdict else { continue };
        let enclosure = worker.enclosure(leafless::Cell::ROOT.child(octant), &part)?;
        if let Some(enclosure) = enclosure {
            let slab = enclosure.slabs[0];
            assert!(slab.inner <= slab.outer && slab.normal.iter().all(|c| c.is_finite()), "{slab:?}");
            known += 1;
        }
    }
    Ok(known)
}

#[test]
fn nonsense_says_nothing() {
    let open = || Callback::new(|_, _| Ok(Verdict::Partial(())));
    let good = ball([-1.0; 3], [1.0; 3], [0.0; 3]);
    assert!(asked(&AnySolid::new(open().with_gradient(move |_, _, _| Ok(Some(good))))).unwrap() > 0);
    let (infinity, nan) = (f64::INFINITY, f64::NAN);
    let everything = Interval::ALL;
    // Reversed bounds and NaN cannot even be expressed.
    assert_eq!([Interval::new(1.0, -1.0), Interval::new(nan, 1.0), Interval::new(1.0, nan)], [None; 3]);
    let nonsense = Interval::new(1.0, -1.0).unwrap_or(everything);
    for range in [nonsense, Interval::exactly(nan), Interval::exactly(infinity), everything] {
        let mut gradient = good.gradient;
        gradient[1] = range;
        for bad in [GradientRange { gradient, ..good }, GradientRange { value: range, ..good }] {
            let solid = AnySolid::new(open().with_gradient(move |_, _, _| Ok(Some(bad))));
            if range == Interval::exactly(infinity) && bad.gradient == good.gradient {
                continue;
            }
            assert_eq!(asked(&solid).unwrap(), 0, "{bad:?}");
        }
    }
    let zero = GradientRange { gradient: [Interval::exactly(0.0); 3], ..good };
    assert_eq!(asked(&AnySolid::new(open().with_gradient(move |_, _, _| Ok(Some(zero))))).unwrap(), 0);
    // One end of the value may be open.
    let outside = GradientRange { value: Interval::new(0.0, infinity).unwrap(), ..good };
    assert!(asked(&AnySolid::new(open().with_gradient(move |_, _, _| Ok(Some(outside))))).unwrap() > 0);

    let balls = TangentBalls {
        point: [0.5; 3],
        normal: [1.0, 2.0, 3.0],
        inner_curvature: 1.0,
        outer_curvature: 0.0,
        error: 0.0,
    };
    let told = |balls| asked(&AnySolid::new(open().with_tangent(move |_, _, _| Ok(Some(balls))))).unwrap();
    assert!(told(balls) > 0);
    assert!(told(TangentBalls { inner_curvature: infinity, ..balls }) > 0);
    let both = TangentBalls { inner_curvature: infinity, outer_curvature: infinity, ..balls };
    for bad in [
        both,
        TangentBalls { error: nan, ..balls },
        TangentBalls { error: -1.0, ..balls },
        TangentBalls { error: infinity, ..balls },
        TangentBalls { inner_curvature: nan, ..balls },
        TangentBalls { point: [0.0, nan, 0.0], ..balls },
        TangentBalls { point: [0.0, infinity, 0.0], ..balls },
        TangentBalls { normal: [0.0; 3], ..balls },
        TangentBalls { normal: [0.0, infinity, 0.0], ..balls },
        TangentBalls { normal: [0.0, nan, 0.0], ..balls },
    ] {
        assert_eq!(told(bad), 0, "{bad:?}");
    }
    // Extreme numbers are valid.
    for extreme in [1e-308, 1e-160, 1e160, 1e308] {
        told(TangentBalls { normal: [extreme, -extreme, 0.0], ..balls });
        told(TangentBalls { point: [extreme; 3], ..balls });
        told(TangentBalls { inner_curvature: extreme, outer_curvature: -extreme, error: extreme, ..balls });
        let value = Interval::new(-extreme, extreme).unwrap();
        let range = GradientRange { value, gradient: [Interval::new(extreme, 1.5 * extreme).unwrap(); 3] };
        asked(&AnySolid::new(open().with_gradient(move |_, _, _| Ok(Some(range))))).unwrap();
    }

    // An error ends the work.
    let failing = open()
        .with_gradient(|_, _, _| Err(Error::Callback { code: 7 }))
        .with_bounds(Bounds::new([-0.5; 3], [0.5; 3]).unwrap());
    let error = measure(&failing, &universe(4), 0.1, &one_thread()).unwrap_err();
    assert!(matches!(error, Error::Callback { code: 7 }), "{error:?}");
}

/// Where the gradient is unknown, the nearest point serves. The cone contains the normals.
#[test]
fn one_function_makes_up_for_the_other() {
    let solid = Callback::new(|min, max| Ok(decide(&ball(min, max, middle(min, max)), min, max)))
        .with_gradient(|min, max, middle| Ok((middle[0] > 0.0).then(|| ball(min, max, middle))))
        .with_tangent(|_, _, _| {
            Ok(Some(TangentBalls {
                point: [CENTRE[0] - RADIUS, CENTRE[1], CENTRE[2]],
                normal: [-1.0, 0.0, 0.0],
                inner_curvature: 1.0 / RADIUS,
                outer_curvature: 0.0,
                error: MARGIN,
            }))
        });
    let mut worker = solid.on(&universe(4), &one_thread()).unwrap().worker().unwrap();
    let mut asked = 0;
    for x in 0..16 {
        for y in 0..16 {
            let cell = leafless::Cell { level: 4, at: [x, y, 9] };
            // (Decided cells are not queried.)
            let (min, max) = leafless::lattice::Cube { frame: &universe(4), cell }.bounds();
            if !matches!(decide(&ball(min, max, middle(min, max)), min, max), Verdict::Partial(())) {
                continue;
            }
            asked += 1;
            let enclosure = worker.enclosure(cell, &()).unwrap().unwrap();
            let normal = enclosure.slabs[0].normal;
            assert_eq!(enclosure.cone.is_finite(), x >= 8, "{cell:?} {enclosure:?}");
            if x < 8 {
                assert_eq!(normal, [-1.0, 0.0, 0.0]);
                continue;
            }
            for corner in 0..8u32 {
                let offset = [0, 1, 2]
                    .map(|axis| (cell.at[axis] + (corner >> axis & 1)) as f64 / 8.0 - 1.0 - CENTRE[axis]);
                let dot: f64 = (0..3).map(|axis| offset[axis] * normal[axis]).sum();
                let lengths = [offset, normal].map(|v| v.iter().map(|c| c * c).sum::<f64>().sqrt());
                let angle = (dot / lengths[0] / lengths[1]).min(1.0).acos();
                assert!(angle <= enclosure.cone + 1e-7, "{cell:?} {enclosure:?}");
            }
        }
    }
    assert!(asked > 30);
}
