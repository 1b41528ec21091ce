//! The demonstration part: a flanged bearing seat with bolt holes and ribs, and a tool to cut it with.
//!
//! Both are closed meshes in millimetres, with z along the axis and the mounting face at z = 0. The part is
//! the union of bodies that overlap (ribs reach into the hub and the flange), as an assembly from a CAD
//! program would be; winding numbers make one solid of them. Every sine and cosine comes from `libm`, so the
//! meshes are the same on all platforms.

use core::f64::consts::{PI, TAU};

use earcut::Earcut;
use leafless::TriangleMesh;

/// Chords of a circle around the axis.
const TURN: usize = 160;
/// Chords of a bolt hole.
const HOLE_TURN: usize = 48;
const FLANGE_RADIUS: f64 = 60.0;
const FLANGE_THICKNESS: f64 = 12.0;
const FLANGE_CHAMFER: f64 = 1.5;
const HUB_RADIUS: f64 = 24.0;
const HUB_HEIGHT: f64 = 60.0;
const HUB_CHAMFER: f64 = 2.0;
const FILLET_RADIUS: f64 = 6.0;
const FILLET_CHORDS: usize = 10;
const BORE_RADIUS: f64 = 14.0;
const BORE_CHAMFER: f64 = 1.5;
/// The wider end of the bore, on the side of the mounting face.
const SEAT_RADIUS: f64 = 20.0;
const SEAT_DEPTH: f64 = 5.0;
const SEAT_CHAMFER: f64 = 1.0;
const BOLTS: usize = 8;
const BOLT_CIRCLE_RADIUS: f64 = 48.0;
const BOLT_HOLE_RADIUS: f64 = 4.5;
const BOLT_HOLE_CHAMFER: f64 = 1.0;
const RIBS: usize = 6;
const RIB_THICKNESS: f64 = 5.0;
/// Outline of a rib, radius and height. Its first and last point lie inside the hub's wall, the first two
/// inside the flange, and the toe ends before the bolt holes begin.
const RIB: [[f64; 2]; 5] = [[20.0, 6.0], [40.0, 6.0], [40.0, 15.0], [27.0, 46.0], [20.0, 46.0]];
const CROSS_DRILL_RADIUS: f64 = 4.5;
const CROSS_DRILL_HEIGHT: f64 = 51.0;
const CROSS_DRILL_REACH: f64 = 30.0;
const KEYWAY_WIDTH: f64 = 5.0;
/// The keyway's floor, measured from the axis, and a start that lies within the bore.
const KEYWAY: [f64; 2] = [10.0, 17.3];
/// Length by which the keyway's tool stands out at both ends of the hub.
const KEYWAY_OVERRUN: f64 = 1.0;

/// The part: a flange with a hub, a stepped bore, eight bolt holes and six ribs; 120 mm wide, 60 mm high.
pub fn flange() -> TriangleMesh {
    let mut surface = Surface::default();
    let profile = profile();
    let circle = unit_circle(TURN);
    for (i, &from) in profile.iter().enumerate() {
        let to = profile[(i + 1) % profile.len()];
        // The bolt holes open in these two plane rings.
        let at = |z: f64| from[1] == z && to[1] == z && from[0].max(to[0]) > BOLT_CIRCLE_RADIUS;
        if at(0.0) {
            surface.drilled_ring(0.0, [to[0], from[0]], BOLT_HOLE_RADIUS, Facing::Down);
        } else if at(FLANGE_THICKNESS) {
            let radius = BOLT_HOLE_RADIUS + BOLT_HOLE_CHAMFER;
            surface.drilled_ring(FLANGE_THICKNESS, [from[0], to[0]], radius, Facing::Up);
        } else {
            surface.band([0.0; 2], &circle, from, to);
        }
    }
    // Walls of the bolt holes, downwards, since the material is outside of them.
    let hole = unit_circle(HOLE_TURN);
    let wall = [
        [BOLT_HOLE_RADIUS + BOLT_HOLE_CHAMFER, FLANGE_THICKNESS],
        [BOLT_HOLE_RADIUS, FLANGE_THICKNESS - BOLT_HOLE_CHAMFER],
        [BOLT_HOLE_RADIUS, 0.0],
    ];
    for centre in bolt_centres() {
        wall.windows(2).for_each(|w| surface.band(centre, &hole, w[0], w[1]));
    }
    for [cos, sin] in unit_circle(RIBS) {
        let half = RIB_THICKNESS / 2.0;
        surface.prism(&RIB, [-half, half], |r, z, w| [r * cos + w * sin, r * sin - w * cos, z]);
    }
    surface.into_mesh()
}

/// The tool: a cross drill through the hub and a keyway along the bore, to be subtracted from [`flange`].
pub fn cutter() -> TriangleMesh {
    let mut surface = Surface::default();
    let drill: Vec<_> = (unit_circle(HOLE_TURN).iter())
        .map(|[cos, sin]| [CROSS_DRILL_RADIUS * cos, CROSS_DRILL_HEIGHT + CROSS_DRILL_RADIUS * sin])
        .collect();
    surface.prism(&drill, [-CROSS_DRILL_REACH, CROSS_DRILL_REACH], |y, z, x| [x, y, z]);
    let (half, [near, far]) = (KEYWAY_WIDTH / 2.0, KEYWAY);
    let key = [[-half, near], [half, near], [half, far], [-half, far]];
    surface.prism(&key, [-KEYWAY_OVERRUN, HUB_HEIGHT + KEYWAY_OVERRUN], |x, y, z| [x, y, z]);
    surface.into_mesh()
}

/// Half of the cross-section of flange and hub, radius and height, counter-clockwise.
fn profile() -> Vec<[f64; 2]> {
    let mut points = vec![
        [SEAT_RADIUS + SEAT_CHAMFER, 0.0],
        [FLANGE_RADIUS - FLANGE_CHAMFER, 0.0],
        [FLANGE_RADIUS, FLANGE_CHAMFER],
        [FLANGE_RADIUS, FLANGE_THICKNESS - FLANGE_CHAMFER],
        [FLANGE_RADIUS - FLANGE_CHAMFER, FLANGE_THICKNESS],
        [HUB_RADIUS + FILLET_RADIUS, FLANGE_THICKNESS],
    ];
    for i in 1..FILLET_CHORDS {
        let (sin, cos) = libm::sincos(PI / 2.0 * i as f64 / FILLET_CHORDS as f64);
        let (r, z) = (FILLET_RADIUS * (1.0 - sin), FILLET_RADIUS * (1.0 - cos));
        points.push([HUB_RADIUS + r, FLANGE_THICKNESS + z]);
    }
    points.extend([
        [HUB_RADIUS, FLANGE_THICKNESS + FILLET_RADIUS],
        [HUB_RADIUS, HUB_HEIGHT - HUB_CHAMFER],
        [HUB_RADIUS - HUB_CHAMFER, HUB_HEIGHT],
        [BORE_RADIUS + BORE_CHAMFER, HUB_HEIGHT],
        [BORE_RADIUS, HUB_HEIGHT - BORE_CHAMFER],
        [BORE_RADIUS, SEAT_DEPTH],
        [SEAT_RADIUS, SEAT_DEPTH],
        [SEAT_RADIUS, SEAT_CHAMFER],
    ]);
    points
}

/// Cosine and sine of `n` equal parts of a turn.
fn unit_circle(n: usize) -> Vec<[f64; 2]> {
    (0..n)
        .map(|i| {
            let (sin, cos) = libm::sincos(TAU * i as f64 / n as f64);
            [cos, sin]
        })
        .collect()
}

/// The bolt holes' axes, between the ribs.
fn bolt_centres() -> impl Iterator<Item = [f64; 2]> {
    (0..BOLTS).map(|i| {
        let (sin, cos) = libm::sincos(TAU * (i as f64 + 0.5) / BOLTS as f64);
        [BOLT_CIRCLE_RADIUS * cos, BOLT_CIRCLE_RADIUS * sin]
    })
}

/// The point of a circle in the direction `[cos, sin]`. Every face that uses the point computes it here, so
/// that all get the same bits and the surface closes.
fn on_circle(centre: [f64; 2], radius: f64, [cos, sin]: [f64; 2]) -> [f64; 2] {
    [centre[0] + radius * cos, centre[1] + radius * sin]
}

/// Which side of a horizontal face is outside.
#[derive(Clone, Copy, PartialEq)]
enum Facing {
    Up,
    Down,
}

/// Facets, each counter-clockwise seen from outside.
#[derive(Default)]
struct Surface {
    facets: Vec<[[f64; 3]; 3]>,
}

impl Surface {
    fn quadrilateral(&mut self, [a, b, c, d]: [[f64; 3]; 4]) {
        self.facets.extend([[a, b, c], [a, c, d]]);
    }

    /// The surface that the line between two points (radius, height) sweeps around a vertical axis. Outside
    /// is on the right of the line.
    fn band(&mut self, centre: [f64; 2], circle: &[[f64; 2]], from: [f64; 2], to: [f64; 2]) {
        let point = |i: usize, [r, z]: [f64; 2]| {
            let [x, y] = on_circle(centre, r, circle[i % circle.len()]);
            [x, y, z]
        };
        for i in 0..circle.len() {
            self.quadrilateral([point(i, from), point(i + 1, from), point(i + 1, to), point(i, to)]);
        }
    }

    /// A plane ring around the axis, between two radii, with openings for the bolt holes.
    fn drilled_ring(&mut self, z: f64, [outer, inner]: [f64; 2], hole_radius: f64, facing: Facing) {
        let turn = unit_circle(TURN);
        let hole = unit_circle(HOLE_TURN);
        let mut points: Vec<_> = turn.iter().map(|&d| on_circle([0.0; 2], outer, d)).collect();
        let mut starts = vec![points.len() as u32];
        points.extend(turn.iter().map(|&d| on_circle([0.0; 2], inner, d)));
        for centre in bolt_centres() {
            starts.push(points.len() as u32);
            points.extend(hole.iter().map(|&d| on_circle(centre, hole_radius, d)));
        }
        for [a, b, c] in triangulated(&points, &starts) {
            let corners = if facing == Facing::Up { [a, b, c] } else { [a, c, b] };
            self.facets.push(corners.map(|[x, y]| [x, y, z]));
        }
    }

    /// A prism over a polygon that is counter-clockwise seen against the third axis, between two values on
    /// that axis. `place` moves it into space and must be a rotation with a translation.
    fn prism(&mut self, base: &[[f64; 2]], [low, high]: [f64; 2], place: impl Fn(f64, f64, f64) -> [f64; 3]) {
        for [a, b, c] in triangulated(base, &[]) {
            self.facets.push([a, b, c].map(|[s, t]| place(s, t, high)));
            self.facets.push([a, c, b].map(|[s, t]| place(s, t, low)));
        }
        for (i, &[s, t]) in base.iter().enumerate() {
            let [u, v] = base[(i + 1) % base.len()];
            self.quadrilateral([place(s, t, low), place(u, v, low), place(u, v, high), place(s, t, high)]);
        }
    }

    fn into_mesh(self) -> TriangleMesh {
        TriangleMesh::from_facets(&self.facets).expect("a fixed shape of finite coordinates")
    }
}

/// The triangles of a polygon whose holes begin at the points `holes`, all counter-clockwise.
fn triangulated(points: &[[f64; 2]], holes: &[u32]) -> Vec<[[f64; 2]; 3]> {
    let mut indices: Vec<u32> = Vec::new();
    Earcut::new().earcut(points.iter().copied(), holes, &mut indices);
    let mut triangles: Vec<_> =
        indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]].map(|i| points[i as usize])).collect();
    // Earcut does not say which way its triangles turn, only that all turn the same way.
    let twice_area: f64 = (triangles.iter())
        .map(|[a, b, c]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
        .sum();
    if twice_area < 0.0 {
        triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;
    use leafless::FillRule;

    /// Returns the winding number of the surface around a point, from the solid angles of its triangles.
    fn winding_number(mesh: &TriangleMesh, p: [f64; 3]) -> i32 {
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let angle: f64 = (mesh.triangles().iter())
            .map(|t| {
                let [a, b, c] = t.map(|v| {
                    let q = mesh.vertices()[v as usize];
                    [q[0] - p[0], q[1] - p[1], q[2] - p[2]]
                });
                let [la, lb, lc] = [a, b, c].map(|v| dot(v, v).sqrt());
                let cross = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
                let denominator = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
                2.0 * dot(a, cross).atan2(denominator)
            })
            .sum();
        let turns = angle / (2.0 * TAU);
        assert!((turns - turns.round()).abs() < 1e-6, "{turns} at {p:?}");
        turns.round() as i32
    }

    fn cylinder(radius: f64, height: f64) -> f64 {
        PI * radius * radius * height
    }

    /// Returns the volume by Pappus's theorem: a cross-section's area times the path of its centroid.
    fn swept(area: f64, centroid_radius: f64) -> f64 {
        area * TAU * centroid_radius
    }

    #[track_caller]
    fn assert_within_one_percent(value: f64, estimate: f64) {
        assert!((value / estimate - 1.0).abs() < 0.01, "{value} is not about {estimate}");
    }

    #[test]
    fn the_flange_is_closed() {
        let mesh = flange();
        mesh.check_closed(FillRule::NonZero).unwrap();
        let report = mesh.report().unwrap();
        assert!((8_000..=14_000).contains(&report.triangles), "{report:?}");
        assert_eq!((report.degenerate, report.non_manifold_edges), (0, 0));
        assert_eq!(report.bodies, 1 + RIBS as u64);
        let (low, high) = mesh.bounds();
        for k in 0..2 {
            assert!((low[k] + 60.0).abs() < 1e-12 && (high[k] - 60.0).abs() < 1e-12, "{low:?} {high:?}");
        }
        assert_eq!((low[2], high[2]), (0.0, 60.0));
    }

    #[test]
    fn the_flange_has_the_expected_volume() {
        let plate = cylinder(60.0, 12.0) - cylinder(14.0, 12.0) - 2.0 * swept(1.5 * 1.5 / 2.0, 59.5);
        let seat = cylinder(20.0, 5.0) - cylinder(14.0, 5.0) + swept(0.5, 20.0 + 1.0 / 3.0);
        let hub =
            cylinder(24.0, 48.0) - cylinder(14.0, 48.0) - swept(2.0, 24.0 - 2.0 / 3.0) - swept(1.125, 14.5);
        let fillet = swept(36.0 * (1.0 - PI / 4.0), 24.0 + 6.0 * 0.2234);
        let countersink = PI / 3.0 * (5.5 * 5.5 + 5.5 * 4.5 + 4.5 * 4.5);
        let bolts = 8.0 * (cylinder(4.5, 11.0) + countersink);
        let outline: f64 = (0..RIB.len())
            .map(|i| (RIB[i], RIB[(i + 1) % RIB.len()]))
            .map(|(a, b)| (a[0] * b[1] - a[1] * b[0]) / 2.0)
            .sum();
        let ribs = 6.0 * 5.0 * outline;
        assert!(outline > 0.0);
        assert_within_one_percent(flange().volume(), plate - seat + hub + fillet - bolts + ribs);
    }

    #[test]
    fn the_holes_are_open() {
        let mesh = flange();
        for z in [-1.0, 0.5, 3.0, 6.0, 11.5, 13.0, 30.0, 59.0, 61.0] {
            // On the axis and near the bore's wall.
            assert_eq!(winding_number(&mesh, [0.1, 0.2, z]), 0);
            assert_eq!(winding_number(&mesh, [9.5, 9.5, z]), 0);
            for [x, y] in bolt_centres() {
                for [dx, dy] in [[0.0, 0.0], [4.4, 0.0], [-4.4, 0.0], [0.0, 4.4], [0.0, -4.4]] {
                    assert_eq!(winding_number(&mesh, [x + dx, y + dy, z]), 0, "bolt hole at {x} {y}, {z}");
                }
            }
        }
        assert_eq!(winding_number(&mesh, [17.0, 1.0, 3.0]), 0, "seat");
    }

    #[test]
    fn the_material_is_where_it_should_be() {
        let mesh = flange();
        for [cos, sin] in unit_circle(RIBS) {
            let at = |r: f64, z: f64| winding_number(&mesh, [r * cos - 0.3 * sin, r * sin + 0.3 * cos, z]);
            assert_eq!(at(19.0, 30.0), 1, "hub");
            assert_eq!(at(22.0, 30.0), 2, "rib within the hub");
            assert_eq!(at(26.0, 30.0), 1, "rib");
            assert_eq!(at(35.0, 9.0), 2, "rib within the flange");
            assert_eq!(at(39.0, 14.0), 1, "toe of the rib");
            assert_eq!(at(36.0, 30.0), 0, "above the rib");
            assert_eq!(at(55.0, 6.0), 1, "flange");
            assert_eq!(at(61.0, 6.0), 0, "beside the flange");
        }
    }

    #[test]
    fn the_cutter_is_closed() {
        let mesh = cutter();
        mesh.check_closed(FillRule::NonZero).unwrap();
        let report = mesh.report().unwrap();
        assert_eq!((report.bodies, report.degenerate, report.non_manifold_edges), (2, 0, 0));
        assert_within_one_percent(mesh.volume(), cylinder(4.5, 60.0) + 5.0 * 7.3 * 62.0);
        // Both tools meet material of the part, and pass completely through it.
        let part = flange();
        for p in [[20.0, 0.0, 51.0], [-20.0, 0.0, 51.0], [0.0, 16.0, 30.0], [1.0, 17.0, 8.0]] {
            assert_eq!((winding_number(&mesh, p), winding_number(&part, p)), (1, 1), "{p:?}");
        }
        for p in [[29.0, 0.0, 51.0], [-29.0, 0.0, 51.0], [0.0, 16.0, -0.5], [0.0, 16.0, 60.5]] {
            assert_eq!((winding_number(&mesh, p), winding_number(&part, p)), (1, 0), "{p:?}");
        }
    }
}
