//! Bounding boxes by slabs, against formulas of the shapes' support functions and against the boxes of
//! octrees, which have no slabs.

use crate::measure_primitives::{placement, vector};
use glam::{DMat3, DVec3, EulerRot};
use leafless::query::{BOUNDING_BOX_SPLITS, Extent, StopReason};
use leafless::{
    Affine, Bounds, Callback, Control, Csg, Frame, Interval, Rule, Solid, Tag, Verdict, bounding_box, build,
};
use leafless_testkit::{Random, alone};

/// A solid and its support function: its reach along a direction.
struct Known {
    name: &'static str,
    solid: Csg,
    reach: Box<dyn Fn(DVec3) -> f64>,
}

fn farthest(points: Vec<DVec3>) -> Box<dyn Fn(DVec3) -> f64> {
    Box::new(move |d| points.iter().map(|p| p.dot(d)).fold(f64::NEG_INFINITY, f64::max))
}

fn corners(min: DVec3, max: DVec3) -> Vec<DVec3> {
    (0..8)
        .map(|k| DVec3::from_array([0, 1, 2].map(|i| if k >> i & 1 == 0 { min[i] } else { max[i] })))
        .collect()
}

fn disc(radius: f64, z: f64) -> impl Fn(DVec3) -> f64 {
    move |d| radius * d.truncate().length() + z * d.z
}

fn primitives() -> Vec<Known> {
    let (r, s, h) = (0.8, 0.3, 1.7);
    let (major, minor) = (1.1, 0.4);
    let polygon = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let [size, top] = [DVec3::new(1.5, 1.2, 0.7), DVec3::new(0.4, 1.2, 0.7)];
    let mut wedge = corners(DVec3::ZERO, size);
    wedge.retain(|p| p.y == 0.0);
    wedge.extend(corners(DVec3::ZERO, top).into_iter().filter(|p| p.y > 0.0));
    let plate = Csg::cuboid([0.0; 3], [8.0, 6.0, 1.0]).unwrap();
    let drills = (0..12).map(|k| {
        let drill = Csg::cylinder(0.4, -1.0, 2.0).unwrap();
        let at = [1.0 + 2.0 * f64::from(k % 4), 1.0 + 2.0 * f64::from(k / 4)];
        drill.placed(
            &Affine::new([[1.0, 0.0, 0.0, at[0]], [0.0, 1.0, 0.0, at[1]], [0.0, 0.0, 1.0, 0.0]]).unwrap(),
        )
    });
    let drills = Csg::union_of(drills.map(Result::unwrap)).unwrap();
    let known = |name, solid: Result<Csg, _>, reach| Known { name, solid: Result::unwrap(solid), reach };
    let centre = DVec3::new(0.5, 0.0, -1.0);
    let two_balls = Csg::union_of([Csg::ball([0.0; 3], r).unwrap(), Csg::ball(centre.into(), s).unwrap()]);
    vec![
        known(
            "cuboid",
            Csg::cuboid([0.0, -1.0, 0.25], [1.5, 1.0, 1.0]),
            farthest(corners(DVec3::new(0.0, -1.0, 0.25), DVec3::new(1.5, 1.0, 1.0))),
        ),
        known("ball", Csg::ball(centre.into(), r), Box::new(move |d| r * d.length() + centre.dot(d))),
        known(
            "ellipsoid",
            Csg::ellipsoid([0.0; 3], [r, s, 1.0]),
            Box::new(move |d| (d * DVec3::new(r, s, 1.0)).length()),
        ),
        known("cylinder", Csg::cylinder(r, 0.0, h), Box::new(move |d| disc(r, 0.0)(d).max(disc(r, h)(d)))),
        known("frustum", Csg::frustum(r, s, 0.0, h), Box::new(move |d| disc(r, 0.0)(d).max(disc(s, h)(d)))),
        known("torus", Csg::torus(major, minor), Box::new(move |d| disc(major, 0.0)(d) + minor * d.length())),
        known("wedge", Csg::wedge(size.into(), top.x), farthest(wedge)),
        known(
            "prism",
            Csg::prism(&polygon, 0.0, 0.5),
            farthest(polygon.iter().flat_map(|&[x, y]| [0.0, 0.5].map(|z| DVec3::new(x, y, z))).collect()),
        ),
        known(
            "octahedron",
            Csg::convex(
                &(0..8)
                    .map(|k| ([0, 1, 2].map(|i| 1.0 - f64::from(k >> i & 1) * 2.0), 1.0))
                    .collect::<Vec<_>>(),
            ),
            Box::new(|d| d.abs().max_element()),
        ),
        known(
            "plate with holes",
            plate.difference(&drills),
            farthest(corners(DVec3::ZERO, DVec3::new(8.0, 6.0, 1.0))),
        ),
        known(
            "two balls",
            two_balls,
            Box::new(move |d| (r * d.length()).max(s * d.length() + centre.dot(d))),
        ),
        known("cone", Csg::frustum(0.0, r, 0.0, h), Box::new(move |d| disc(r, h)(d).max(0.0))),
    ]
}

fn affine(matrix: DMat3, offset: DVec3) -> Affine {
    let rows = matrix.transpose().to_cols_array_2d();
    Affine::new([0, 1, 2].map(|i| [rows[i][0], rows[i][1], rows[i][2], offset[i]])).unwrap()
}

/// Returns the six intervals as reaches along the outward directions.
fn sides(extent: &Extent) -> [Interval; 6] {
    let [min, max] = extent.corners.unwrap_or_else(|| panic!("{extent:?}"));
    core::array::from_fn(|side| match side {
        0..3 => Interval::new(-min[side].upper, -min[side].lower).unwrap(),
        _ => max[side - 3],
    })
}

fn outward(side: usize) -> DVec3 {
    DVec3::AXES[side % 3] * if side < 3 { -1.0 } else { 1.0 }
}

fn frame_around(solid: &Csg, depth: u8) -> Frame {
    let Bounds { min, max } = solid.bounds().expect("a bounded solid");
    Frame::around(min, max, depth).unwrap()
}

#[test]
fn intervals_hold_the_formulas_at_every_budget() {
    let mut random = Random(1);
    let mut most = Vec::new();
    for Known { name, solid, reach } in primitives() {
        let mut splits = 0;
        for round in 0..12 {
            let (matrix, offset) =
                if round == 0 { (DMat3::IDENTITY, DVec3::ZERO) } else { placement(&mut random) };
            let placed = solid.placed(&affine(matrix, offset)).unwrap();
            let truth: [f64; 6] = core::array::from_fn(|side| {
                let d = outward(side);
                reach(matrix.transpose() * d) + offset.dot(d)
            });
            for depth in [1, 4, 20] {
                let frame = frame_around(&placed, depth);
                // Where a plane touches a curved side along a line or a circle, each level takes twice the
                // splits.
                let tolerance = if round == 0 { 1e-4 } else { 1e-9 } * frame.edge();
                // The formulas are rounded.
                let slack = 1e-13 * (frame.edge() + 20.0);
                for max_splits in [0, 1, 3, 10, 30, 100, 300, 1000, 10_000] {
                    let control = Control { max_splits: Some(max_splits), ..alone() };
                    let found = bounding_box(&placed, &frame, tolerance, &control).unwrap();
                    let at = format!("{name}, placement {round}, depth {depth}, {truth:?}: {found:?}");
                    assert!(found.splits <= max_splits && !found.clipped, "{at}");
                    for (side, truth) in sides(&found).into_iter().zip(truth) {
                        assert!(side.lower - slack <= truth && truth <= side.upper + slack, "{at}");
                    }
                    if (max_splits, depth) == (10_000, 20) {
                        // Where more than three planes meet, or where no gradient exists, a point is known up
                        // to some finest cells.
                        let is_tip = matches!(name, "cone" | "octahedron");
                        let width = tolerance.max(if is_tip { 64.0 * frame.cell_size() } else { 0.0 });
                        assert!(sides(&found).iter().all(|side| side.width() <= width + slack), "{at}");
                        assert!(is_tip || found.stop_reason == StopReason::Tolerance, "{at}");
                        assert!(found.occupied, "{at}");
                        splits = found.splits.max(splits);
                    }
                }
            }
        }
        most.push((name, splits));
    }
    println!("splits to 1e-9, at most: {most:?}");
    // Without slabs, a rotated cuboid took 10^18.
    let is_plane = |name| matches!(name, "cuboid" | "wedge" | "prism" | "octahedron" | "plate with holes");
    for (name, splits) in most.into_iter().filter(|(name, _)| is_plane(*name)) {
        assert!(splits <= 500, "{name}: {splits}");
    }
}

#[test]
fn a_tilted_plate_takes_few_splits() {
    let turn = DMat3::from_euler(EulerRot::ZYX, 30f64.to_radians(), 20f64.to_radians(), 10f64.to_radians());
    let size = DVec3::new(80.0, 60.0, 10.0);
    let plate = Csg::cuboid([0.0; 3], size.into()).unwrap().placed(&affine(turn, DVec3::ZERO)).unwrap();
    let frame = frame_around(&plate, 20);
    let found = bounding_box(&plate, &frame, 1e-9 * size.max_element(), &Control::default()).unwrap();
    println!("{} splits", found.splits);
    assert!(found.stop_reason == StopReason::Tolerance && found.splits <= 100, "{found:?}");
    let truth = farthest(corners(DVec3::ZERO, size));
    for (k, side) in sides(&found).into_iter().enumerate() {
        let truth = truth(turn.transpose() * outward(k));
        assert!(side.lower - 1e-12 <= truth && truth <= side.upper + 1e-12, "{truth} {found:?}");
        assert!(side.width() <= 80e-9, "{found:?}");
    }
}

/// Random polytopes, thin ones among them. The corners are the intersection points of three planes that lie
/// within all planes.
#[test]
fn polytopes_against_their_corners() {
    let mut random = Random(7);
    let (mut empty, mut slivers) = (0, 0);
    for round in 0..300 {
        let mut planes: Vec<(DVec3, f64)> =
            (0..6).map(|side| (outward(side), 1.0 + random.between(-0.5, 0.5))).collect();
        for _ in 0..1 + round % 4 {
            planes.push((vector(&mut random), random.between(-0.3, 0.3)));
        }
        if round % 3 == 0 {
            // A sliver with two nearly parallel faces.
            let (normal, offset) = planes[6];
            planes.push((-normal + 1e-3 * vector(&mut random), random.between(0.0, 1e-2) - offset));
        }
        let mut points = Vec::new();
        for i in 0..planes.len() {
            for j in 0..i {
                for k in 0..j {
                    let rows = [planes[i], planes[j], planes[k]];
                    let matrix = DMat3::from_cols(rows[0].0, rows[1].0, rows[2].0).transpose();
                    let point = matrix.inverse() * DVec3::from_array(rows.map(|row| row.1));
                    if matrix.determinant() != 0.0 && planes.iter().all(|(n, o)| n.dot(point) <= o + 1e-9) {
                        points.push(point);
                    }
                }
            }
        }
        let solid =
            Csg::intersection_of(planes.iter().map(|(n, o)| Csg::half_space((-*n).into(), *o).unwrap()));
        let frame = Frame::new([-1.6; 3], 3.3, 20).unwrap();
        let found = bounding_box(&solid.unwrap(), &frame, 1e-7, &Control::default()).unwrap();
        if points.is_empty() || !found.occupied {
            empty += 1;
            assert!(found.corners.is_none(), "round {round}, {points:?}: {found:?}");
            continue;
        }
        // A sliver may be so thin that more than three planes meet in a finest cell. Then a corner may lie
        // along the sliver as far as faces at a thousandth of a radian allow.
        if found.stop_reason != StopReason::Tolerance {
            slivers += 1;
            assert!(found.stop_reason == StopReason::Exhausted && round % 3 == 0, "round {round}: {found:?}");
            assert!(sides(&found).iter().all(|side| side.width() < 4e3 * frame.cell_size()), "{found:?}");
        }
        assert!(found.splits < 3000, "round {round}: {found:?}");
        let truth = farthest(points);
        for (k, side) in sides(&found).into_iter().enumerate() {
            let truth = truth(outward(k));
            // The precision with which slivers determine the corners.
            assert!(
                side.lower - 1e-7 <= truth && truth <= side.upper + 1e-7,
                "round {round}, side {k}, {truth}: {found:?}"
            );
        }
    }
    println!("{empty} empty, {slivers} slivers");
    assert!((10..150).contains(&empty) && slivers < 10, "{empty} {slivers}");
}

/// Bounding boxes of expressions whose cells provide unions, complements or only one side, against the boxes
/// of their octrees.
#[test]
fn expressions_beside_their_octrees() {
    let mut random = Random(3);
    let frame = Frame::new([-2.0; 3], 4.0, 8).unwrap();
    let deep = frame.with_depth(20).unwrap();
    for round in 0..40 {
        let mut shape = || {
            let (matrix, offset) = (
                DMat3::from_axis_angle(vector(&mut random).normalize(), random.between(-3.0, 3.0)),
                0.7 * vector(&mut random),
            );
            let solid = match random.below(4) {
                0 => Csg::cuboid([-0.5, -0.6, -0.7], [0.6, 0.4, 0.3]),
                1 => Csg::ball([0.0; 3], 0.6),
                2 => Csg::cylinder(0.4, -0.7, 0.6),
                _ => Csg::torus(0.6, 0.3),
            };
            solid.unwrap().placed(&affine(matrix, offset)).unwrap()
        };
        let [a, b, c, d] = [shape(), shape(), shape(), shape()];
        let solid = match round % 4 {
            0 => a.difference(&Csg::union_of([b, c, d]).unwrap()),
            1 => Csg::union_of([a, b]).unwrap().difference(&Csg::intersection_of([c, d]).unwrap()),
            2 => Csg::xor_of([a, b, c]),
            _ => Csg::intersection_of([Csg::union_of([a, b]).unwrap(), Csg::union_of([c, d]).unwrap()]),
        };
        let solid = solid.unwrap();
        let tree = build(&solid, &frame, Rule::Certified, &Control::default()).unwrap();
        let by_cells = bounding_box(&tree.view(), &frame, 0.0, &Control::default()).unwrap();
        let by_slabs = bounding_box(&solid, &deep, 1e-6, &Control::default()).unwrap();
        let at = format!("round {round}: {by_cells:?} {by_slabs:?}");
        assert!(by_cells.occupied && by_slabs.occupied, "{at}");
        assert_eq!(by_slabs.stop_reason, StopReason::Tolerance, "{at}");
        for (cells, slabs) in sides(&by_cells).into_iter().zip(sides(&by_slabs)) {
            assert!(cells.lower <= slabs.upper && slabs.lower <= cells.upper, "{at}");
        }
    }
}

#[test]
fn what_knows_no_slabs_goes_by_its_cells() {
    let frame = Frame::new([-1.0, -1.1, -1.2], 2.3, 9).unwrap();
    let (centre, radius) = ([0.05, 0.0, -0.1], 0.8f64);
    let ball = Callback::new(move |min, max| {
        let square =
            |of: fn(f64, f64, f64) -> f64| (0..3).map(|i| of(min[i], max[i], centre[i]).powi(2)).sum::<f64>();
        let near = square(|min, max, c| c - c.clamp(min, max));
        let far = square(|min, max, c| (c - min).abs().max((max - c).abs()));
        Ok(match (near > radius * radius, far <= radius * radius) {
            (true, _) => Verdict::Empty,
            (_, true) => Verdict::Full,
            _ => Verdict::Partial(()),
        })
    });
    let ball = ball.with_exterior(Tag::Empty);
    let found = bounding_box(&ball, &frame, 0.0, &Control::default()).unwrap();
    let coarse = bounding_box(&ball, &frame, 0.1, &Control::default()).unwrap();
    let exact = bounding_box(&Csg::ball(centre, radius).unwrap(), &frame, 1e-4, &Control::default()).unwrap();
    assert_eq!((found.stop_reason, coarse.stop_reason), (StopReason::Exhausted, StopReason::Tolerance));
    assert_eq!(exact.stop_reason, StopReason::Tolerance);
    assert!(
        coarse.splits < found.splits && 10 * exact.splits < found.splits,
        "{coarse:?} {found:?} {exact:?}"
    );
    for (k, (found, exact)) in sides(&found).into_iter().zip(sides(&exact)).enumerate() {
        let truth = radius + centre[k % 3] * if k < 3 { -1.0 } else { 1.0 };
        assert!(found.contains(truth) && found.width() < 3.0 * frame.cell_size(), "{found:?} {truth}");
        assert!(exact.contains(truth) && exact.width() < 1.01e-4, "{exact:?} {truth}");
    }
}

#[test]
fn flat_thin_and_empty_solids_end() {
    let turn = affine(DMat3::from_rotation_y(0.3) * DMat3::from_rotation_x(0.4), DVec3::new(0.1, 0.2, 0.3));
    let frame = Frame::new([-2.0; 3], 4.1, 20).unwrap();
    let control = Control::default();
    let block = Csg::cuboid([-1.0; 3], [1.0; 3]).unwrap();
    let layer = |thickness: f64| {
        let above = Csg::half_space([0.0, 0.0, 1.0], 0.0).unwrap();
        let below = Csg::half_space([0.0, 0.0, -1.0], thickness).unwrap();
        Csg::intersection_of([block.clone(), above, below]).unwrap().placed(&turn).unwrap()
    };
    let thin = layer(1e-5);
    let found = bounding_box(&thin, &frame, 1e-9, &control).unwrap();
    assert!(found.stop_reason == StopReason::Tolerance && found.splits < 5000, "{found:?}");
    let thin = sides(&found);
    for thickness in [0.0, -1e-5] {
        let found = bounding_box(&layer(thickness), &frame, 1e-9, &control).unwrap();
        println!("thickness {thickness}: {:?} after {} splits", found.stop_reason, found.splits);
        assert!(!found.occupied && found.splits <= BOUNDING_BOX_SPLITS, "{found:?}");
        if found.corners.is_some() {
            assert_ne!(found.stop_reason, StopReason::Tolerance);
            assert!(
                sides(&found).iter().zip(thin).all(|(side, thin)| side.upper <= thin.upper + 1e-3),
                "{found:?}"
            );
        }
    }
    // The result is empty.
    let nothing =
        block.difference(&Csg::cuboid([-1.5; 3], [1.5; 3]).unwrap()).unwrap().placed(&turn).unwrap();
    let found = bounding_box(&nothing, &frame, 1e-9, &control).unwrap();
    assert_eq!((found.corners, found.occupied, found.stop_reason), (None, false, StopReason::Tolerance));
    assert!(found.splits < 1000, "{found:?}");
}

/// Before an empty solid is proven empty, the bounds from two sides may contradict each other: the box would
/// end before it begins. This contradiction is a proof of emptiness, and no box is returned.
#[test]
fn a_box_that_ends_before_it_begins_is_none() {
    let frame = Frame::new([-1.0; 3], 2.0, 20).unwrap();
    let (mut none, mut open) = (0, 0);
    for gap in [0.02, 0.01, 0.005] {
        // A ball inside the complement of a slightly larger ball, and the same with rings.
        let ball = |radius: f64| Csg::ball([0.1, 0.0, -0.05], radius).unwrap();
        let ring = |minor: f64| Csg::torus(0.5, minor).unwrap();
        for solid in [ball(0.7).difference(&ball(0.7 + gap)), ring(0.2).difference(&ring(0.2 + gap))] {
            let solid = solid.unwrap();
            // Budgets from zero to more than needed.
            let budgets = (0..40).map(|k| (20.0 * 1.2f64.powi(k)) as u64);
            for splits in budgets {
                let control = Control { max_splits: Some(splits), ..alone() };
                let found = bounding_box(&solid, &frame, 1e-9, &control).unwrap();
                assert!(!found.occupied);
                match found.corners {
                    None => {
                        none += 1;
                        assert_eq!(found.stop_reason, StopReason::Tolerance);
                    }
                    Some([min, max]) => {
                        open += 1;
                        for axis in 0..3 {
                            assert!(min[axis].lower <= min[axis].upper, "{gap} {splits} {min:?}");
                            assert!(max[axis].lower <= max[axis].upper, "{gap} {splits} {max:?}");
                            assert!(min[axis].lower <= max[axis].upper, "{gap} {splits} {min:?} {max:?}");
                        }
                    }
                }
            }
        }
    }
    assert!(none > 20 && open > 20, "{none} {open}");
}
