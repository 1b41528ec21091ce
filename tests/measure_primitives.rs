//! Volume, centroid and inertia of every primitive under random affine placements: the intervals hold the
//! formulas' values at every depth.

use glam::{DMat3, DVec3};
use leafless::{Affine, Bounds, Control, Csg, Error, Frame, Interval, Solid, measure};
use std::f64::consts::PI;

/// A solid with its volume, its centroid, and ∫ (p − c)(p − c)ᵀ about that.
struct Known {
    name: &'static str,
    solid: Result<Csg, Error>,
    volume: f64,
    centroid: DVec3,
    spread: DMat3,
}

/// p pᵀ
fn outer(p: DVec3) -> DMat3 {
    DMat3::from_cols(p * p.x, p * p.y, p * p.z)
}

/// Of a solid whose section at each height t of [0, `height`] has this area, centre and second moments about
/// the centre; polynomials in t of degree seven at the most, which five points integrate exactly.
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

/// Of a solid that is symmetric to its centre, with the mean squares of the coordinates.
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

/// Entries between −1 and 1, pseudo-random.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// A map that does not squash.
    fn placement(&mut self) -> (DMat3, DVec3) {
        loop {
            let mut column = || DVec3::new(self.next(), self.next(), self.next());
            let (matrix, offset) = (DMat3::from_cols(column(), column(), column()), 10.0 * column());
            if matrix.determinant().abs() > 0.2 {
                return (matrix, offset);
            }
        }
    }
}

fn holds(interval: Interval, value: f64, size: f64) -> bool {
    // The formulas are rounded.
    let slack = 1e-12 * size;
    interval.lower <= value + slack && value - slack <= interval.upper
}

#[test]
fn intervals_hold_the_formulas() {
    let mut random = Random(1);
    let control = Control::default();
    for Known { name, solid, volume, centroid, spread } in primitives() {
        let solid = solid.unwrap();
        for round in 0..4 {
            let (matrix, offset) =
                if round == 0 { (DMat3::IDENTITY, DVec3::ZERO) } else { random.placement() };
            let rows = matrix.transpose().to_cols_array_2d();
            let affine =
                Affine::new([0, 1, 2].map(|i| [rows[i][0], rows[i][1], rows[i][2], offset[i]])).unwrap();
            let placed = solid.placed(&affine).unwrap();
            let scale = matrix.determinant().abs();
            let (volume, centroid) = (scale * volume, matrix * centroid + offset);
            let spread = scale * (matrix * spread * matrix.transpose());
            let inertia = |spread: DMat3| {
                DMat3::from_diagonal(DVec3::splat(spread.x_axis.x + spread.y_axis.y + spread.z_axis.z))
                    - spread
            };
            let (about_centroid, about_origin) =
                (inertia(spread), inertia(spread + volume * outer(centroid)));
            let Bounds { min, max } = placed.bounds().expect("a bounded primitive");
            let mut widths = Vec::new();
            for depth in 1..=6 {
                let found =
                    measure(&placed, &Frame::around(min, max, depth).unwrap(), 0.0, &control).unwrap();
                let at = format!("{name}, placement {round}, depth {depth}: {found:?}");
                assert!(!found.clipped && holds(found.volume, volume, volume), "{at}");
                widths.push(found.volume.width());
                let reach = centroid.abs().max_element() + 10.0;
                if let Some(found) = found.centroid {
                    assert!((0..3).all(|i| holds(found[i], centroid[i], reach)), "{at}");
                }
                let size = volume * reach * reach;
                for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                    let entry = |m: &DMat3| m.col(j)[i];
                    assert!(holds(found.inertia_about_centroid[i][j], entry(&about_centroid), size), "{at}");
                    assert!(holds(found.inertia_about_origin[i][j], entry(&about_origin), size), "{at}");
                }
            }
            // Each level halves what is not known, more or less.
            assert!(widths[5] < 0.4 * widths[3], "{name}, placement {round}: {widths:?}");
        }
    }
}
