//! Any bytes as two solids with small integer coordinates that touch, or nearly do, and as queries about
//! them. No answer contradicts another one, points that surely lie in both solids, or a distance known in
//! integers.

use super::Bytes;
use leafless::query::{GapVerdict, Overlap, gap_at_least};
use leafless::{
    Affine, AnySolid, Control, Csg, Frame, Interval, SurfaceOptions, Tolerance, build_extended, clearance,
    interference, measure,
};

/// A primitive with exact numbers.
#[derive(Debug, Clone, Copy)]
enum Figure {
    Ball([f64; 3], f64),
    Box([f64; 3], [f64; 3]),
    /// A frustum: its axis, the middle of the lower end, the radii at both ends, the height.
    Frustum(usize, [f64; 3], [f64; 2], f64),
    Ellipsoid([f64; 3], [f64; 3]),
    /// The points of a cube with n · x ≤ c.
    Slope([f64; 3], f64),
}

/// Half the edge of the cube around all unbounded solids.
const AROUND: f64 = 14.0;

impl Figure {
    fn new(bytes: &mut Bytes<'_>) -> Figure {
        let kind = bytes.below(8);
        let at = [0; 3].map(|_: i32| bytes.around(5));
        let mut size = || 0.5 * (1 + bytes.below(8)) as f64;
        match kind {
            0 | 1 => Figure::Ball(at, size()),
            2 => Figure::Box(at, at.map(|c| c + size())),
            3 | 4 => {
                let (radius, height) = (size(), size());
                Figure::Frustum(bytes.below(3), at, [radius; 2], height)
            }
            5 => {
                let (bottom, top, height) = (size() - 0.5, size(), size());
                Figure::Frustum(bytes.below(3), at, [bottom, top], height)
            }
            6 => Figure::Ellipsoid(at, [size(), size(), size()]),
            _ => {
                let normal = if at == [0.0; 3] { [0.0, 0.0, 1.0] } else { at };
                Figure::Slope(normal, bytes.around(20))
            }
        }
    }

    fn csg(&self) -> Csg {
        let solid = match *self {
            Figure::Ball(centre, radius) => Csg::ball(centre, radius),
            Figure::Box(low, high) => Csg::cuboid(low, high),
            Figure::Ellipsoid(centre, radii) => Csg::ellipsoid(centre, radii),
            Figure::Frustum(axis, at, [bottom, top], height) => {
                // From z to the axis, in the order of the axes.
                let mut rows = [[0.0; 4]; 3];
                for (k, row) in rows.iter_mut().enumerate() {
                    row[(k + 2 - axis) % 3] = 1.0;
                    row[3] = at[k];
                }
                let upright = Csg::frustum(bottom, top, 0.0, height).expect("a good frustum");
                upright.placed(&Affine::new(rows).expect("a good map"))
            }
            Figure::Slope(normal, end) => {
                let half = Csg::half_space(normal.map(|c| -c), end).expect("a good plane");
                Csg::intersection_of([half, Csg::cuboid([-AROUND; 3], [AROUND; 3]).expect("a good box")])
            }
        };
        solid.expect("a good figure")
    }

    /// True if a point surely lies inside.
    fn holds(&self, at: [f64; 3]) -> bool {
        const LITTLE: f64 = 1e-6;
        let from = |centre: [f64; 3]| [0, 1, 2].map(|k| at[k] - centre[k]);
        let square = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>();
        match *self {
            Figure::Ball(centre, radius) => square(from(centre)).sqrt() < radius - LITTLE,
            Figure::Box(low, high) => (0..3).all(|k| low[k] + LITTLE < at[k] && at[k] < high[k] - LITTLE),
            Figure::Ellipsoid(centre, radii) => {
                let from = from(centre);
                square([0, 1, 2].map(|k| from[k] / radii[k])) < 1.0 - 16.0 * LITTLE
            }
            Figure::Frustum(axis, centre, [bottom, top], height) => {
                let from = from(centre);
                let along = from[axis];
                let across = (square(from) - along * along).max(0.0).sqrt();
                let radius = bottom + (top - bottom) * along / height;
                LITTLE < along && along < height - LITTLE && across < radius - 16.0 * LITTLE
            }
            Figure::Slope(normal, end) => {
                let value: f64 = (0..3).map(|k| normal[k] * at[k]).sum();
                value < end - 16.0 * LITTLE && at.iter().all(|c| c.abs() < AROUND - LITTLE)
            }
        }
    }

    /// If integers can decide, returns whether the interiors have no common point, and the distance if it is
    /// known. The second figure is moved along x.
    fn apart(&self, other: &Figure, shift: f64) -> Option<(bool, Option<f64>)> {
        match (*self, *other) {
            (Figure::Ball(a, r), Figure::Ball(b, s)) => {
                let d = (b[0] + shift - a[0]).powi(2) + (b[1] - a[1]).powi(2) + (b[2] - a[2]).powi(2);
                Some((d >= (r + s) * (r + s), Some((d.sqrt() - r - s).max(0.0))))
            }
            (Figure::Ball(a, r), Figure::Box(low, high)) => {
                let off = |k: usize| {
                    let by = if k == 0 { shift } else { 0.0 };
                    (low[k] + by - a[k]).max(a[k] - high[k] - by).max(0.0)
                };
                let square = (0..3).map(|k| off(k) * off(k)).sum::<f64>();
                Some((square >= r * r, Some((square.sqrt() - r).max(0.0))))
            }
            (Figure::Box(..), Figure::Ball(..)) => other.apart(self, -shift),
            (Figure::Box(a, b), Figure::Box(low, high)) => {
                let off = |k: usize| {
                    let by = if k == 0 { shift } else { 0.0 };
                    (low[k] + by - b[k]).max(a[k] - high[k] - by)
                };
                let least = [0, 1, 2].map(off);
                let distance = least.iter().map(|c| c.max(0.0).powi(2)).sum::<f64>().sqrt();
                Some((least.iter().any(|c| *c >= 0.0), Some(distance)))
            }
            _ => None,
        }
    }
}

/// A solid made from a figure. If `is_hole`, it is a block around the figure minus the figure.
struct Solid {
    figure: Figure,
    is_hole: bool,
}

impl Solid {
    fn new(bytes: &mut Bytes<'_>) -> Solid {
        Solid { figure: Figure::new(bytes), is_hole: bytes.below(4) == 3 }
    }

    fn csg(&self) -> Csg {
        let figure = self.figure.csg();
        if !self.is_hole {
            return figure;
        }
        let block = Csg::cuboid([-AROUND; 3], [AROUND; 3]).expect("a good box");
        block.difference(&figure).expect("enough memory")
    }

    fn holds(&self, at: [f64; 3]) -> bool {
        if !self.is_hole {
            return self.figure.holds(at);
        }
        // Points as near as this to the figure do not count as inside.
        let near = (0..8).any(|k| {
            self.figure.holds([0, 1, 2].map(|axis| at[axis] + if k >> axis & 1 == 0 { -1e-3 } else { 1e-3 }))
        });
        !near && !self.figure.holds(at) && self.is_clear(at)
    }

    /// True if a point is surely outside the figure. Only balls and boxes are decided.
    fn is_clear(&self, at: [f64; 3]) -> bool {
        match self.figure {
            Figure::Ball(centre, radius) => {
                let square: f64 = (0..3).map(|k| (at[k] - centre[k]).powi(2)).sum();
                square.sqrt() > radius + 1e-6 && at.iter().all(|c| c.abs() < AROUND - 1e-6)
            }
            Figure::Box(low, high) => {
                (0..3).any(|k| at[k] < low[k] - 1e-6 || at[k] > high[k] + 1e-6)
                    && at.iter().all(|c| c.abs() < AROUND - 1e-6)
            }
            // (For other figures, no point is known to be outside.)
            _ => false,
        }
    }
}

/// A map of both solids: the identity, a rounded rotation, a rotation along the axes, a shear, or another
/// scale.
fn common(code: usize) -> Affine {
    let ((s, c), (t, d)) = (0.47f64.sin_cos(), 1.7f64.sin_cos());
    let rows = match code % 6 {
        0 | 1 => return Affine::IDENTITY,
        2 | 3 => [[c, -s * d, s * t, 0.1], [s, c * d, -c * t, 0.2], [0.0, t, d, -0.3]],
        4 => [[0.0, -1.0, 0.0, 1.0], [1.0, 0.0, 0.0, 2.0], [0.0, 0.0, 1.0, 0.0]],
        _ => [[0.75, 0.25, 0.0, 0.0], [0.0, 1.0, -0.5, 0.0], [0.125, 0.0, 0.5, 1.0]],
    };
    Affine::new(rows).expect("a good map")
}

fn do_meet(a: Interval, b: Interval, slack: f64) -> bool {
    a.lower <= b.upper + slack && b.lower <= a.upper + slack
}

/// Runs the fuzz target.
pub fn contacts(data: &[u8]) {
    let mut bytes = Bytes(data);
    let map_code = bytes.byte();
    let map = common(map_code);
    let depth = [20, 20, 12, 8, 5, 3][bytes.below(6)];
    let frame = Frame::new([-32.0; 3], 64.0, depth).expect("a good frame");
    let shift = [0.0, 0.0, 2f64.powi(-20), -(2f64.powi(-20)), 2f64.powi(-30), -(2f64.powi(-30)), 0.25, -0.25]
        [bytes.below(8)];
    let control =
        Control { threads: 1, max_splits: Some([20, 100, 400][bytes.below(3)]), ..Control::default() };
    let ways = bytes.byte();
    let (first, second) = (Solid::new(&mut bytes), Solid::new(&mut bytes));
    let away = Affine::translation([shift, 0.0, 0.0]).expect("a good map");
    let a = first.csg().placed(&map).expect("it can be moved");
    let b = second.csg().placed(&away).and_then(|b| b.placed(&map)).expect("it can be moved");
    let both = Csg::intersection_of([a.clone(), b.clone()]).expect("enough memory");
    let asked = |solid: Csg, is_stored: bool| match is_stored {
        true => AnySolid::new(
            build_extended(&solid, &frame, &SurfaceOptions::default(), &control).expect("built"),
        ),
        false => AnySolid::new(solid),
    };
    let (a, b) = (asked(a, ways & 1 != 0), asked(b, ways & 2 != 0));
    let told = || format!("{:?} {} {:?} {}", first.figure, first.is_hole, second.figure, second.is_hole);

    let tolerance = [f64::INFINITY, 0.01][ways >> 2 & 1];
    let found = interference(&a, &b, &frame, tolerance, &control).expect("nothing is wrong with it");
    let turned = interference(&b, &a, &frame, f64::INFINITY, &control).expect("nothing is wrong with it");
    let verdicts = [found.verdict, turned.verdict];
    let is_disjoint = verdicts.contains(&Overlap::Disjoint);
    let is_overlapping = verdicts.contains(&Overlap::Overlapping);
    assert!(!(is_disjoint && is_overlapping), "{}: {found:?} {turned:?}", told());
    assert!(do_meet(found.volume, turned.volume, 0.0), "{}: {found:?} {turned:?}", told());
    let volume = measure(&both, &frame, Tolerance { relative: 0.0, absolute: 0.01 }, &control)
        .expect("nothing is wrong with it")
        .volume;
    assert!(do_meet(found.volume, volume, 1e-12), "{}: {found:?} {volume:?}", told());
    assert!(!is_disjoint || volume.lower <= 0.0, "{}: {found:?} {volume:?}", told());

    let known = clearance(&a, &b, &frame, 1e-6, &control).expect("nothing is wrong with it");
    let distance = known.distance;
    assert!(!is_overlapping || distance.lower <= 0.0, "{}: {found:?} {known:?}", told());
    assert!(!is_disjoint || known.depth <= 0.0, "{}: {found:?} {known:?}", told());
    let least = [0.25, 1.0, 2f64.powi(-20), 3.0][ways >> 3 & 3];
    let gap = gap_at_least(&a, &b, &frame, least, &control).expect("nothing is wrong with it");
    match gap.verdict {
        GapVerdict::Yes => {
            assert!(distance.upper >= least && !is_overlapping, "{}: {known:?} {gap:?}", told())
        }
        GapVerdict::No => assert!(distance.lower < least, "{}: {known:?} {gap:?}", told()),
        GapVerdict::Undecided => {}
    }
    assert!(do_meet(distance, gap.evidence.distance, 0.0), "{}: {known:?} {gap:?}", told());

    // Points of both, in a lattice unrelated to theirs.
    let (mut of_a, mut of_b) = (None, None);
    for k in 0..512u32 {
        let at = [k % 8, k / 8 % 8, k / 64].map(|k| 1.3 * f64::from(k) - 4.7);
        let beside = [at[0] - shift, at[1], at[2]];
        let (in_a, in_b) = (first.holds(at), second.holds(beside));
        assert!(!(in_a && in_b && is_disjoint), "{}: {found:?} {at:?}", told());
        let place = map.apply(at);
        if in_a {
            of_a = Some(place);
        }
        if in_b {
            of_b = Some(place);
        }
    }
    if let (Some(p), Some(q)) = (of_a, of_b) {
        let apart = (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt();
        assert!(distance.lower <= apart + 1e-9, "{}: {known:?} {p:?} {q:?}", told());
    }
    if let (false, false, Some((apart, least))) =
        (first.is_hole, second.is_hole, first.figure.apart(&second.figure, shift))
    {
        assert!(if apart { !is_overlapping } else { !is_disjoint }, "{}: {found:?}", told());
        // (Rotations along the axes keep distances to the last digit.)
        if let (Some(least), 0 | 1 | 4) = (least, map_code % 6) {
            let slack = 1e-12;
            let holds = distance.lower <= least + slack && least <= distance.upper + slack;
            assert!(holds, "{}: {known:?} {least}", told());
        }
    }
}
