//! Volume, centroid and inertia of every primitive under random affine placements. The intervals contain the
//! formulas' values at every depth, after every number of splits, and for every tolerance.

use glam::{DMat3, DVec3};
use leafless::query::StopReason;
use leafless::{Affine, Bounds, Control, Csg, Error, Frame, Interval, MassProperties, Solid, measure};
use leafless_testkit::{Random, repeated};
use std::f64::consts::PI;

/// A solid with its volume, its centroid, and ∫ (p − c)(p − c)ᵀ about the centroid.
struct Known {
    name: &'static str,
    solid: Result<Csg, Error>,
    volume: f64,
    centroid: DVec3,
    spread: DMat3,
}

/// Returns p pᵀ.
fn outer(p: DVec3) -> DMat3 {
    DMat3::from_cols(p * p.x, p * p.y, p * p.z)
}

/// Returns the measures of a solid from its sections. `section` returns area, centre and second moments about
/// the centre at each height t of [0, `height`]. They must be polynomials in t of degree at most seven, which
/// five points integrate exactly.
fn stacked(
    name: &'static str,
    solid: Result<Csg, Error>,
    height: f64,
    section: impl Fn(f64) -> (f64, DVec3, DVec3),
) -> Known {
    let (a, b) =
        ((5.0 - 2.0 * (10f64 / 7.0).sqrt()).sqrt() / 3.0, (5.0 + 2.0 * (10f64 / 7.0).sqrt()).sqrt() / 3.0);
    let (u, v) = ((322.0 + 13.0 * 70f64.sqrt()) / 900.0, (322.0 - 13.0 * 70f64.sqrt()) / 900.0);
    let points = [(-b, v), (-a, u), (0.0, 128.0 / 225.0), (a, u), (b, v)];
    let (mut volume, mut first, mut second) = (0.0, DVec3::ZERO, DMat3::ZERO);
    for (x, weight) in points {
        let (area, centre, own) = section(0.5 * height * (1.0 + x));
        let weight = 0.5 * height * weight;
        volume += weight * area;
        first += weight * area * centre;
        second += weight * (area * outer(centre) + DMat3::from_diagonal(own));
    }
    let centroid = first / volume;
    Known { name, solid, volume, centroid, spread: second - volume * outer(centroid) }
}

/// Returns the measures of a solid symmetric about its centre, from the mean squares of the coordinates.
fn central(
    name: &'static str,
    solid: Result<Csg, Error>,
    volume: f64,
    centre: DVec3,
    squares: DVec3,
) -> Known {
    Known { name, solid, volume, centroid: centre, spread: DMat3::from_diagonal(volume * squares) }
}

fn primitives() -> Vec<Known> {
    let (r, s, h) = (0.8, 0.3, 1.7);
    let radius = move |t: f64| r + (s - r) * t / h;
    let disc = move |r: f64, z: f64| {
        let area = PI * r * r;
        (area, DVec3::new(0.0, 0.0, z), DVec3::new(area * r * r / 4.0, area * r * r / 4.0, 0.0))
    };
    let size = [1.5, 1.2, 0.7];
    let rung = move |t: f64| {
        // At y = t a rectangle of width w and the height of the box.
        let (w, d) = (size[0] + (0.4 - size[0]) * t / size[1], size[2]);
        (w * d, DVec3::new(w / 2.0, t, d / 2.0), DVec3::new(w * d * w * w / 12.0, 0.0, w * d * d * d / 12.0))
    };
    // Two boxes that make an L: [0, 2] × [0, 1] and [0, 1] × [1, 2], as high as `low`.
    let polygon = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let low = 0.5;
    let boxes = [
        (DVec3::new(2.0, 1.0, low), DVec3::new(1.0, 0.5, low / 2.0)),
        (DVec3::new(1.0, 1.0, low), DVec3::new(0.5, 1.5, low / 2.0)),
    ];
    let volume: f64 = boxes.iter().map(|(size, _)| size.element_product()).sum();
    let centroid =
        boxes.iter().map(|&(size, centre)| size.element_product() * centre).sum::<DVec3>() / volume;
    let mut spread = DMat3::ZERO;
    for (size, centre) in boxes {
        spread +=
            size.element_product() * (outer(centre - centroid) + DMat3::from_diagonal(size * size / 12.0));
    }
    let prism = Known { name: "prism", solid: Csg::prism(&polygon, 0.0, low), volume, centroid, spread };
    let planes: Vec<([f64; 3], f64)> =
        (0..8).map(|k| ([0, 1, 2].map(|axis| if k >> axis & 1 == 0 { 1.0 } else { -1.0 }), 1.0)).collect();
    let (major, minor) = (1.1, 0.4);
    vec![
        central(
            "cuboid",
            Csg::cuboid([0.0, -1.0, 0.25], [1.5, 1.0, 1.0]),
            2.25,
            DVec3::new(0.75, 0.0, 0.625),
            DVec3::new(2.25, 4.0, 0.5625) / 12.0,
        ),
        central(
            "ball",
            Csg::ball([0.5, 0.0, -1.0], r),
            4.0 / 3.0 * PI * r * r * r,
            DVec3::new(0.5, 0.0, -1.0),
            DVec3::splat(r * r / 5.0),
        ),
        central(
            "ellipsoid",
            Csg::ellipsoid([0.0; 3], [r, s, 1.0]),
            4.0 / 3.0 * PI * r * s,
            DVec3::ZERO,
            DVec3::new(r * r, s * s, 1.0) / 5.0,
        ),
        central(
            "cylinder",
            Csg::cylinder(r, 0.0, h),
            PI * r * r * h,
            DVec3::new(0.0, 0.0, h / 2.0),
            DVec3::new(r * r / 4.0, r * r / 4.0, h * h / 12.0),
        ),
        stacked("frustum", Csg::frustum(r, s, 0.0, h), h, move |z| disc(radius(z), z)),
        stacked("cone", Csg::frustum(0.0, r, 0.0, h), h, move |z| disc(r * z / h, z)),
        central(
            "torus",
            Csg::torus(major, minor),
            2.0 * PI * PI * major * minor * minor,
            DVec3::ZERO,
            DVec3::new(
                major * major / 2.0 + 0.375 * minor * minor,
                major * major / 2.0 + 0.375 * minor * minor,
                minor * minor / 4.0,
            ),
        ),
        stacked("wedge", Csg::wedge(size, 0.4), size[1], rung),
        prism,
        central("octahedron", Csg::convex(&planes), 4.0 / 3.0, DVec3::ZERO, DVec3::splat(0.1)),
    ]
}

/// Returns a vector with components between −1 and 1.
pub fn vector(random: &mut Random) -> DVec3 {
    DVec3::from_array([0; 3].map(|_| random.between(-1.0, 1.0)))
}

/// Returns a random map that flattens nothing.
pub fn placement(random: &mut Random) -> (DMat3, DVec3) {
    loop {
        let [x, y, z, offset] = [0; 4].map(|_| vector(random));
        let (matrix, offset) = (DMat3::from_cols(x, y, z), 10.0 * offset);
        if matrix.determinant().abs() > 0.2 {
            return (matrix, offset);
        }
    }
}

fn holds(interval: Interval, value: f64, size: f64) -> bool {
    // The formulas are rounded.
    let slack = 1e-12 * size;
    interval.lower <= value + slack && value - slack <= interval.upper
}

/// A placed primitive with its measures.
struct Placed {
    solid: Csg,
    volume: f64,
    centroid: DVec3,
    about_centroid: DMat3,
    about_origin: DMat3,
}

impl Known {
    fn placed(&self, matrix: DMat3, offset: DVec3) -> Placed {
        let rows = matrix.transpose().to_cols_array_2d();
        let affine = Affine::new([0, 1, 2].map(|i| [rows[i][0], rows[i][1], rows[i][2], offset[i]])).unwrap();
        let scale = matrix.determinant().abs();
        let (volume, centroid) = (scale * self.volume, matrix * self.centroid + offset);
        let spread = scale * (matrix * self.spread * matrix.transpose());
        let inertia = |spread: DMat3| {
            DMat3::from_diagonal(DVec3::splat(spread.x_axis.x + spread.y_axis.y + spread.z_axis.z)) - spread
        };
        Placed {
            solid: self.solid.as_ref().unwrap().placed(&affine).unwrap(),
            volume,
            centroid,
            about_centroid: inertia(spread),
            about_origin: inertia(spread + volume * outer(centroid)),
        }
    }
}

impl Placed {
    /// Asserts that the intervals contain the known values.
    fn check(&self, found: &MassProperties, context: &str) {
        let at = format!("{context}: {found:?}");
        assert!(!found.clipped && holds(found.volume, self.volume, self.volume), "{at}");
        let reach = self.centroid.abs().max_element() + 10.0;
        if let Some(found) = found.centroid {
            assert!((0..3).all(|i| holds(found[i], self.centroid[i], reach)), "{at}");
        }
        let size = self.volume * reach * reach;
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            assert!(holds(found.inertia_about_centroid[i][j], self.about_centroid.col(j)[i], size), "{at}");
            assert!(holds(found.inertia_about_origin[i][j], self.about_origin.col(j)[i], size), "{at}");
        }
    }
}

fn around(solid: &Csg, depth: u8) -> Frame {
    let Bounds { min, max } = solid.bounds().expect("a bounded solid");
    Frame::around(min, max, depth).unwrap()
}

#[test]
fn intervals_hold_the_formulas() {
    let mut random = Random(1);
    let control = Control::default();
    for known in primitives() {
        for round in 0..repeated(2, 4) {
            let (matrix, offset) =
                if round == 0 { (DMat3::IDENTITY, DVec3::ZERO) } else { placement(&mut random) };
            let placed = known.placed(matrix, offset);
            let name = format!("{}, placement {round}", known.name);
            let mut widths = Vec::new();
            for depth in 1..=6 {
                let found = measure(&placed.solid, &around(&placed.solid, depth), 0.0, &control).unwrap();
                placed.check(&found, &format!("{name}, depth {depth}"));
                widths.push(found.volume.width());
            }
            // Each level halves the unknown volume, approximately.
            let rounding = 1e-10 * placed.volume;
            assert!(widths[5] < (0.4 * widths[3]).max(rounding), "{name}: {widths:?}");
            // Pass by pass, until the uncertainty is mostly rounding.
            let frame = around(&placed.solid, 20);
            for most in (0..16).step_by(3).map(|log| 1 << log) {
                let control = Control { max_splits: Some(most), ..Control::default() };
                let found = measure(&placed.solid, &frame, 1e-9, &control).unwrap();
                placed.check(&found, &format!("{name}, {most} splits"));
                assert!(found.splits <= most, "{name}");
            }
            // Skewed placements make narrow ends and mixed terms.
            let tolerances = if round == 0 {
                [(1e-3, 200_000), (1e-4, 1_200_000)]
            } else {
                [(0.03, 60_000), (0.01, 200_000)]
            };
            for (tolerance, most) in tolerances {
                let found = measure(&placed.solid, &frame, tolerance, &control).unwrap();
                placed.check(&found, &format!("{name}, tolerance {tolerance}"));
                assert_eq!(found.stop_reason, StopReason::Tolerance, "{name}");
                assert!(found.volume.width() <= tolerance * found.volume.upper, "{name}");
                assert!(found.splits < most, "{name}, tolerance {tolerance}: {}", found.splits);
            }
        }
    }
}

#[test]
#[ignore = "minutes"]
fn primitives_to_a_hundred_thousandth() {
    let control = Control { max_splits: Some(1 << 27), ..Control::default() };
    for known in primitives() {
        let placed = known.placed(DMat3::IDENTITY, DVec3::ZERO);
        let found = measure(&placed.solid, &around(&placed.solid, 20), 1e-5, &control).unwrap();
        println!(
            "{}: {} splits, relative width {:e}",
            known.name,
            found.splits,
            found.volume.width() / placed.volume
        );
        placed.check(&found, known.name);
        assert_eq!(found.stop_reason, StopReason::Tolerance, "{}", known.name);
    }
}

#[test]
fn unions_and_intersections_add_up() {
    let mut random = Random(7);
    let known = primitives();
    for round in 0..repeated(7, 20) {
        let mut pick = || {
            let (matrix, offset) = placement(&mut random);
            let k = random.index(known.len());
            // Near the origin, so that most pairs meet.
            known[k].placed(matrix, 0.05 * offset)
        };
        let (a, b) = (pick(), pick());
        let parts = [
            Csg::union_of([a.solid.clone(), b.solid.clone()]).unwrap(),
            Csg::intersection_of([a.solid.clone(), b.solid.clone()]).unwrap(),
            a.solid.difference(&b.solid).unwrap(),
        ];
        let frame = around(&parts[0], 20);
        for most in [20, 1000, 30_000] {
            let control = Control { max_splits: Some(most), ..Control::default() };
            let [all, both, rest] =
                parts.each_ref().map(|part| measure(part, &frame, 1e-7, &control).unwrap());
            let at = format!("round {round}, {most} splits\n{all:?}\n{both:?}\n{rest:?}");
            let sum = |a: Interval, b: Interval| Interval::new(a.lower + b.lower, a.upper + b.upper).unwrap();
            let volume = a.volume + b.volume;
            assert!(holds(sum(all.volume, both.volume), volume, volume), "{at}");
            assert!(holds(sum(rest.volume, both.volume), a.volume, volume), "{at}");
            let size = 100.0 * volume;
            for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                let [all, both, rest] = [&all, &both, &rest].map(|m| m.inertia_about_origin[i][j]);
                let [one, other] = [&a, &b].map(|placed| placed.about_origin.col(j)[i]);
                assert!(holds(sum(all, both), one + other, size), "{at}");
                assert!(holds(sum(rest, both), one, size), "{at}");
            }
            if most == 30_000 {
                assert!(all.volume.width() < 0.1 * all.volume.upper, "{at}");
            }
        }
    }
}

/// A rotated block with a pocket that is rotated in the block.
#[test]
fn turned_blocks_with_pockets() {
    let block = |min: [f64; 3], max: [f64; 3]| {
        let (min, max) = (DVec3::from(min), DVec3::from(max));
        let volume = (max - min).element_product();
        let squares = (max - min) * (max - min) / 12.0;
        let solid = Csg::cuboid(min.into(), max.into());
        central("block", solid, volume, 0.5 * (min + max), squares)
    };
    let turn = |rows: [[f64; 3]; 3]| DMat3::from_cols_array_2d(&rows).transpose();
    let plain = turn([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    let turned = turn([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]]);
    let flat = turn([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]]);
    let (outside, inside) = (block([0.0; 3], [8.0, 6.0, 2.0]), block([-2.0, -1.0, 0.5], [2.0, 1.0, 2.0]));
    // It ends above the block, so that no faces coincide.
    let cutter = block([-2.0, -1.0, 0.5], [2.0, 1.0, 3.0]);
    for (name, matrix, offset) in [
        ("as it is", plain, DVec3::ZERO),
        ("turned", turned, DVec3::ZERO),
        ("turned elsewhere", turned, DVec3::new(11.3, -7.7, 1.0 / 3.0)),
        ("turned twice", flat * turned, DVec3::new(0.1, 0.2, 0.3)),
        ("in a plane", flat, DVec3::ZERO),
    ] {
        // The pocket's middle in the block.
        let at = matrix * DVec3::new(4.0, 3.0, 0.0) + offset;
        let whole = outside.placed(matrix, offset);
        let [taken, cutter] = [&inside, &cutter].map(|known| known.placed(matrix * flat, at));
        let volume = whole.volume - taken.volume;
        let centroid = (whole.volume * whole.centroid - taken.volume * taken.centroid) / volume;
        let about_origin = whole.about_origin - taken.about_origin;
        let steiner = DMat3::from_diagonal(DVec3::splat(centroid.length_squared())) - outer(centroid);
        let about_centroid = about_origin - volume * steiner;
        let solid = whole.solid.difference(&cutter.solid).unwrap();
        let part = Placed { solid, volume, centroid, about_centroid, about_origin };
        let found = measure(&part.solid, &around(&part.solid, 20), 1e-9, &Control::default()).unwrap();
        println!("{name}: {} splits, relative width {:e}", found.splits, found.volume.width() / volume);
        part.check(&found, name);
        assert_eq!(found.stop_reason, StopReason::Tolerance, "{name}");
        assert!(found.volume.width() <= 1e-9 * volume, "{name}");
        assert!(found.splits < 10_000_000, "{name}: {}", found.splits);
    }
}
