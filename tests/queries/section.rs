//! Areas of plane sections, against formulas, dense arrays cut cell by cell, and the outlines that planes cut
//! out of meshes.

use glam::{DMat3, DQuat, DVec3};
use leafless::query::{SECTION_SPLITS, SectionArea, SectionPlane, StopReason, section_area};
use leafless::{
    Affine, Callback, Control, Csg, Error, FillRule, Frame, Interval, MeshSolid, Proof, Rule, Solid, Tag,
    Tolerance, TriangleMesh, Verdict, build, exchange,
};
use leafless_testkit::csg::Maker;
use leafless_testkit::{Dense, DenseSolid, Random, Shape, alone, lattice_frame, model, positions, repeated};
use std::f64::consts::PI;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// A plane in the tests' own form.
#[derive(Debug, Clone, Copy)]
struct Plane {
    point: DVec3,
    normal: DVec3,
}

impl Plane {
    fn across(axis: usize, coordinate: f64) -> Plane {
        Plane { point: DVec3::AXES[axis] * coordinate, normal: DVec3::AXES[axis] }
    }

    fn library(&self) -> SectionPlane {
        SectionPlane::new(self.point.into(), self.normal.into()).unwrap()
    }

    /// Returns the area of the plane's part in the intersection of half-spaces (n · p ≤ o) near a point. A
    /// large square in the plane is clipped by one half-space after another.
    fn area_within(&self, near: DVec3, size: f64, halves: impl IntoIterator<Item = (DVec3, f64)>) -> f64 {
        let n = self.normal.normalize();
        let centre = near - n * n.dot(near - self.point);
        let (u, v) = n.any_orthonormal_pair();
        let corner = |a: f64, b: f64| centre + (u * a + v * b) * size;
        let mut polygon = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        for (normal, offset) in halves {
            let value = |p: DVec3| offset - normal.dot(p);
            let mut clipped = vec![];
            for (i, &to) in polygon.iter().enumerate() {
                let from = polygon[(i + polygon.len() - 1) % polygon.len()];
                let (a, b) = (value(from), value(to));
                if (a < 0.0) != (b < 0.0) {
                    clipped.push(from + (to - from) * (a / (a - b)));
                }
                if b >= 0.0 {
                    clipped.push(to);
                }
            }
            polygon = clipped;
        }
        let Some(&first) = polygon.first() else { return 0.0 };
        polygon.windows(2).map(|w| n.dot((w[0] - first).cross(w[1] - first))).sum::<f64>() / 2.0
    }

    fn area_in_box(&self, min: DVec3, max: DVec3) -> f64 {
        let halves =
            (0..3).flat_map(|axis| [(-DVec3::AXES[axis], -min[axis]), (DVec3::AXES[axis], max[axis])]);
        self.area_within(0.5 * (min + max), 2.0 * (max - min).max_element(), halves)
    }

    fn area_in_universe(&self, frame: &Frame) -> f64 {
        let min = DVec3::from(frame.origin());
        self.area_in_box(min, min + frame.edge())
    }

    /// Returns the area of the plane's part inside a closed mesh with outward triangles. Each triangle that
    /// the plane cuts contributes a piece of the outline.
    fn area_in_mesh(&self, mesh: &TriangleMesh) -> f64 {
        let n = self.normal.normalize();
        let mut sum = DVec3::ZERO;
        for triangle in mesh.triangles() {
            let corners = triangle.map(|v| DVec3::from(mesh.vertices()[v as usize]) - self.point);
            let values = corners.map(|p| n.dot(p));
            let (mut up, mut down) = (None, None);
            for i in 0..3 {
                let (a, b) = (values[i], values[(i + 1) % 3]);
                let (from, to) = (corners[i], corners[(i + 1) % 3]);
                // The same point from both sides of the edge.
                let crossing =
                    if a < b { from + (to - from) * (a / (a - b)) } else { to + (from - to) * (b / (b - a)) };
                match (a < 0.0, b < 0.0) {
                    (true, false) => up = Some(crossing),
                    (false, true) => down = Some(crossing),
                    _ => {}
                }
            }
            if let (Some(up), Some(down)) = (up, down) {
                sum += up.cross(down);
            }
        }
        (0.5 * n.dot(sum)).abs()
    }
}

fn vector(random: &mut Random) -> DVec3 {
    loop {
        let v = DVec3::from_array([0; 3].map(|_| random.between(-1.0, 1.0)));
        if (0.01..1.0).contains(&v.length_squared()) {
            return v;
        }
    }
}

fn turn(random: &mut Random) -> DMat3 {
    DMat3::from_quat(DQuat::from_scaled_axis(vector(random) * 3.0))
}

/// Checks a result against a truth that is a rounded double, up to a fraction of `scale`.
#[track_caller]
fn holds(found: &SectionArea, truth: f64, scale: f64, at: &str) {
    let slack = 1e-12 * scale;
    let area = found.area;
    assert!(area.lower <= truth + slack && truth - slack <= area.upper, "{at}: {truth} {found:?}");
    assert!(area.lower >= 0.0);
}

fn limited(splits: u64) -> Control<'static> {
    Control { max_splits: Some(splits), ..alone() }
}

fn ask(
    solid: &impl Solid,
    frame: &Frame,
    plane: &Plane,
    tolerance: f64,
    control: &Control<'_>,
) -> SectionArea {
    section_area(solid, frame, &plane.library(), tolerance, control).unwrap()
}

#[test]
fn balls_have_the_sections_of_the_formula() {
    let mut random = Random(1);
    let (mut most, mut cut) = (0, 0);
    for round in 0..repeated(200, 600) {
        let depth = [20, 20, 9, 4, 1][round % 5];
        let origin = [0; 3].map(|_| random.between(-3.0, 1.0));
        let frame = Frame::new(origin, random.between(4.0, 9.0), depth).unwrap();
        let radius = random.between(0.05, 0.45) * frame.edge();
        let centre = DVec3::from_array(
            [0, 1, 2].map(|axis| origin[axis] + random.between(radius, frame.edge() - radius)),
        );
        let normal = if round % 4 == 0 { DVec3::AXES[round % 3] } else { vector(&mut random) };
        let distance = radius * random.between(-1.3, 1.3);
        let plane = Plane { point: centre + normal.normalize() * distance, normal };
        let truth = PI * (radius * radius - distance * distance).max(0.0);
        let ball = Csg::ball(centre.into(), radius).unwrap();
        let at = format!("round {round}, depth {depth}, {distance} of {radius}");
        for budget in [0, 1, 10, 100, 1000] {
            let found = ask(&ball, &frame, &plane, 0.0, &limited(budget));
            assert!(found.splits <= budget && !found.clipped && found.proof == Proof::CERTIFIED, "{at}");
            holds(&found, truth, radius * radius, &at);
        }
        let is_near = (distance.abs() / radius - 1.0).abs() < 0.05;
        if depth == 20 && !is_near {
            let found = ask(&ball, &frame, &plane, 1e-6, &alone());
            assert_eq!(found.stop_reason, StopReason::Tolerance, "{at} {found:?}");
            assert!(found.area.width() <= 1e-6 * found.area.upper, "{at} {found:?}");
            holds(&found, truth, radius * radius, &at);
            most = most.max(found.splits);
            cut += i32::from(truth > 0.0);
        }
    }
    println!("splits to 1e-6, at most: {most}; {cut} planes cut the ball");
    assert!(most < 20_000 && cut > repeated(40, 100), "{most} {cut}");
}

#[test]
fn widths_fall_with_the_square_of_the_splits() {
    let mut random = Random(2);
    let frame = Frame::new([-1.0, -1.1, -1.2], 2.5, 20).unwrap();
    for round in 0..repeated(8, 20) {
        let ball = Csg::ball([0.1, 0.2, 0.0], 0.8).unwrap();
        let tilted = Csg::torus(0.6, 0.25).unwrap().placed(&affine(turn(&mut random), DVec3::ZERO)).unwrap();
        let plane = Plane { point: vector(&mut random) * 0.4, normal: vector(&mut random) };
        for (name, solid) in [("ball", ball), ("torus", tilted)] {
            let width = |budget: u64| ask(&solid, &frame, &plane, 0.0, &limited(budget)).area.width();
            let (coarse, fine) = (width(300), width(30_000));
            // As far as rounding allows.
            let slope = (fine.max(1e-12) / coarse).ln() / 100f64.ln();
            println!("{name}: {coarse:e} {fine:e} {slope}");
            assert!(slope < -1.75, "round {round}, {name}: {coarse} {fine} {slope}");
        }
        // To six digits, then to about twelve.
        let splits = |tolerance: f64| {
            ask(&Csg::ball([0.1, 0.2, 0.0], 0.8).unwrap(), &frame, &plane, tolerance, &alone()).splits
        };
        let (few, many) = (splits(1e-4), splits(1e-8));
        assert!(few > 0 && many < 400 * few, "{few} {many}");
    }
}

fn affine(matrix: DMat3, offset: DVec3) -> Affine {
    let rows = matrix.transpose().to_cols_array_2d();
    Affine::new([0, 1, 2].map(|i| [rows[i][0], rows[i][1], rows[i][2], offset[i]])).unwrap()
}

/// Sections in faces and between planes of the lattice, to the last bit. The lattice and all areas are
/// doubles.
#[test]
fn boxes_on_the_lattice_have_exact_sections() {
    let mut random = Random(3);
    let mut in_a_face = 0;
    for round in 0..500 {
        let depth = [5, 6, 12, 20][round % 4];
        let frame = Frame::new([-8.0, 0.0, 16.0], 16.0, depth).unwrap();
        let corner = |random: &mut Random| [0; 3].map(|_| random.below(33) as f64 / 2.0);
        let (a, b) = (corner(&mut random), corner(&mut random));
        let origin = DVec3::from(frame.origin());
        let (min, max) = (
            origin + DVec3::from_array([0, 1, 2].map(|i| a[i].min(b[i]))),
            origin + DVec3::from_array([0, 1, 2].map(|i| a[i].max(b[i]))),
        );
        if (max - min).min_element() == 0.0 {
            continue;
        }
        let solid = Csg::cuboid(min.into(), max.into()).unwrap();
        let axis = round % 3;
        let at = match random.below(4) {
            0 => min[axis],
            1 => max[axis],
            2 => origin[axis] + random.below(33) as f64 / 2.0,
            _ => origin[axis] + random.between(0.0, 16.0),
        };
        in_a_face += i32::from(at == min[axis] || at == max[axis]);
        // The limit from above; from below in the upper face of the universe.
        let top = origin[axis] + 16.0;
        let is_cut = min[axis] <= at && at < max[axis] || at == top && max[axis] == top;
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let truth = if is_cut { (max[i] - min[i]) * (max[j] - min[j]) } else { 0.0 };
        let mut plane = Plane::across(axis, at);
        plane.point[i] = random.between(-9.0, 9.0);
        plane.normal *= random.between(-9.0, 9.0);
        let found = ask(&solid, &frame, &plane, 0.0, &alone());
        let label = format!("round {round}, axis {axis} at {at}, {min} {max}");
        assert_eq!(found.area, Interval::exactly(truth), "{label}");
        assert_eq!(found.stop_reason, StopReason::Tolerance, "{label}");
        if depth == 5 {
            let tree = build(&solid, &frame, Rule::Certified, &alone()).unwrap();
            assert_eq!(ask(&tree, &frame, &plane, 0.0, &alone()).area, found.area, "{label}");
        }
        let rest = ask(&solid.complement(), &frame, &plane, 0.0, &alone());
        assert_eq!(rest.area, Interval::exactly(256.0 - truth), "{label}");
        assert!(rest.clipped);
    }
    assert!(in_a_face > 100, "{in_a_face}");
}

/// Slabs of plane faces that meet, and slabs of their complements, against polygons clipped by all planes.
#[test]
fn polytopes_have_the_sections_of_their_planes() {
    let mut random = Random(4);
    let frame = Frame::new([-1.6; 3], 3.3, 20).unwrap();
    let (mut cut, mut most) = (0, 0);
    for round in 0..300 {
        let turned = turn(&mut random);
        let mut halves: Vec<(DVec3, f64)> = (0..6)
            .map(|side| {
                let normal = DVec3::AXES[side % 3] * if side < 3 { -1.0 } else { 1.0 };
                (turned * normal, random.between(0.2, 0.85))
            })
            .collect();
        for _ in 0..round % 4 {
            halves.push((vector(&mut random), random.between(0.05, 0.4)));
        }
        let solid =
            Csg::intersection_of(halves.iter().map(|(n, o)| Csg::half_space((-*n).into(), *o).unwrap()));
        let solid = solid.unwrap();
        let plane = Plane { point: vector(&mut random) * 0.6, normal: vector(&mut random) };
        let truth = plane.area_within(DVec3::ZERO, 4.0, halves.iter().copied());
        let at = format!("round {round}");
        let found = ask(&solid, &frame, &plane, 0.0, &limited(7));
        holds(&found, truth, 4.0, &at);
        let fine = Tolerance { relative: 0.0, absolute: 1e-9 };
        let found = section_area(&solid, &frame, &plane.library(), fine, &limited(20_000)).unwrap();
        holds(&found, truth, 4.0, &at);
        assert_eq!(found.stop_reason, StopReason::Tolerance, "{at} {found:?}");
        let rest =
            section_area(&solid.complement(), &frame, &plane.library(), fine, &limited(20_000)).unwrap();
        holds(&rest, plane.area_in_universe(&frame) - truth, 16.0, &at);
        assert_eq!(rest.stop_reason, StopReason::Tolerance, "{at} {rest:?}");
        most = most.max(found.splits);
        cut += i32::from(truth > 0.0);
    }
    println!("{cut} cut, at most {most} splits");
    assert!(cut > 200 && most < 2000, "{cut} {most}");
}

/// A face that leaves the plane at a slope of about 2^-k, along an exactly known line. The interval must
/// include the rounding.
#[test]
fn nearly_parallel_faces_are_told_apart() {
    let frame = Frame::new([-1.0; 3], 2.0, 20).unwrap();
    let mut random = Random(14);
    for round in 0..240 {
        let (k, end) = (round / 4, random.below(1 << 20) as f64 / (1 << 19) as f64 - 1.0);
        // The product with `end` is a double.
        let slope = 2f64.powi(-k) * (1.0 + random.below(1 << 30) as f64 / (1 << 30) as f64);
        // z ≤ along x + slope (y − end) in z = along x.
        let along = [0.0, 1.0, random.unit(), -random.unit()][(round % 4) as usize];
        let solid = Csg::half_space([along, slope, -1.0], -slope * end).unwrap();
        let plane = Plane { point: DVec3::ZERO, normal: DVec3::new(-along, 0.0, 1.0) };
        let truth = 2.0 * (1.0 + along * along).sqrt() * (1.0 - end);
        for budget in [0, 1, 300] {
            let found = ask(&solid, &frame, &plane, 0.0, &limited(budget));
            let at = format!("round {round}, k {k}, to {end}, {truth}: {found:?}");
            assert!(
                found.area.lower <= truth * (1.0 + 1e-15) && truth * (1.0 - 1e-15) <= found.area.upper,
                "{at}"
            );
            assert!(k > 25 || found.area.width() < 1e-4, "{at}");
        }
    }
}

/// Planes related to a lattice of unit cells: oblique planes, planes perpendicular to an axis, and planes
/// through edges and corners of cells.
fn lattice_plane(random: &mut Random, cells: f64) -> Plane {
    let point = DVec3::from_array([0; 3].map(|_| random.between(-0.1, 1.1) * cells));
    match random.below(4) {
        0 => Plane { point, normal: vector(random) },
        1 => Plane { point: point.round(), normal: DVec3::AXES[random.below(3) as usize] },
        2 => Plane { point, normal: -DVec3::AXES[random.below(3) as usize] },
        _ => {
            let mut normal = DVec3::ZERO;
            while normal.to_array().iter().filter(|c| **c != 0.0).count() < 2 {
                normal = DVec3::from_array([0; 3].map(|_| random.below(5) as f64 - 2.0));
            }
            Plane { point: point.round(), normal }
        }
    }
}

/// Returns the area of a plane in the FULL cells of a dense array, and in the FULL and PARTIAL cells, on the
/// lattice of unit cells.
fn dense_sums(dense: &Dense, plane: &Plane) -> [f64; 2] {
    let frame = lattice_frame(dense.depth);
    let axis = (0..3).find(|&axis| plane.normal == DVec3::AXES[axis] * plane.normal[axis]);
    let mut sums = [0.0; 2];
    for at in positions(dense.depth) {
        let tag = dense.at(at);
        let min = DVec3::from_array(at.map(f64::from));
        let area = match axis {
            _ if tag == Tag::Empty => 0.0,
            Some(axis) => f64::from(u8::from(frame.cell_at(axis, plane.point[axis]) == Some(at[axis]))),
            None => plane.area_in_box(min, min + 1.0),
        };
        sums[0] += if tag == Tag::Full { area } else { 0.0 };
        sums[1] += area;
    }
    sums
}

fn tape(random: &mut Random, depth: u8) -> Dense {
    let length = random.below(120);
    Shape { depth, tape: std::iter::once(9).chain((0..length).map(|_| random.bits() as u8)).collect() }
        .dense()
}

#[test]
fn octrees_have_the_sections_of_their_cells() {
    let mut random = Random(5);
    for round in 0..400 {
        let depth = 1 + (round % 4) as u8;
        let dense = tape(&mut random, depth);
        let tree = dense.octree();
        let frame = lattice_frame(depth);
        let cells = f64::from(frame.cells());
        let plane = lattice_plane(&mut random, cells);
        let [full, most] = dense_sums(&dense, &plane);
        let at = format!("round {round}, {plane:?}, {full} {most}");
        let found = ask(&tree, &frame, &plane, 0.0, &alone());
        let slack = 1e-11 * cells * cells;
        assert!(
            (found.area.lower - full).abs() <= slack && (found.area.upper - most).abs() <= slack,
            "{at} {found:?}"
        );
        assert_ne!(found.stop_reason, StopReason::Budget, "{at}");
        let found = ask(&tree, &frame, &plane, 0.0, &limited(random.below(20)));
        assert!(found.area.lower <= full + slack && most - slack <= found.area.upper, "{at} {found:?}");
        let rest = ask(&dense.complement().octree(), &frame, &plane, 0.0, &alone());
        let [full, most] = dense_sums(&dense.complement(), &plane);
        assert!(
            (rest.area.lower - full).abs() <= slack && (rest.area.upper - most).abs() <= slack,
            "{at} {rest:?}"
        );
    }
}

/// The same cells on frames whose planes are no doubles. An axis-perpendicular plane next to a lattice plane
/// belongs to the layer that point queries choose.
#[test]
fn planes_beside_lattice_planes_meet_one_layer() {
    let mut random = Random(6);
    for round in 0..300 {
        let depth = 1 + (round % 4) as u8;
        let dense = tape(&mut random, depth);
        let origin = [random.between(-9.0, 9.0), 0.1, 1e5 / 3.0];
        let frame = Frame::new(origin, random.between(0.1, 7.0), depth).unwrap();
        let tree =
            build(&DenseSolid { dense: &dense, exterior: Tag::Empty }, &frame, Rule::Certified, &alone());
        let tree = tree.unwrap();
        let axis = random.below(3) as usize;
        let plane = frame.plane(axis, random.below(u64::from(frame.cells()) + 1) as u32);
        for coordinate in [plane.lower.next_down(), plane.lower, plane.upper, plane.upper.next_up()] {
            let found = ask(&tree, &frame, &Plane::across(axis, coordinate), 0.0, &alone());
            let layer = frame.cell_at(axis, coordinate);
            let count = |is: fn(Tag) -> bool| {
                positions(depth).filter(|at| Some(at[axis]) == layer && is(dense.at(*at))).count() as f64
            };
            let cell = frame.cell_size() * frame.cell_size();
            let (full, most) = (count(|tag| tag == Tag::Full) * cell, count(|tag| tag != Tag::Empty) * cell);
            let area = found.area;
            let at = format!("round {round}, axis {axis} at {coordinate:e}, {full} {most} {found:?}");
            assert!(
                (area.lower - full).abs() <= 1e-15 * full && (area.upper - most).abs() <= 1e-15 * most,
                "{at}"
            );
            assert!(full > 0.0 || area.lower == 0.0, "{at}");
        }
    }
}

/// A rotated, closed mesh of a torus.
fn torus(random: &mut Random) -> TriangleMesh {
    let (around, across) = (5 + random.below(20) as usize, 3 + random.below(9) as usize);
    let (turned, minor) = (turn(random), random.between(0.1, 0.4));
    let at = |i: usize, j: usize| {
        let [u, v] =
            [(i % around, around), (j % across, across)].map(|(k, n)| k as f64 / n as f64 * 2.0 * PI);
        let r = 0.6 + minor * v.cos();
        (turned * DVec3::new(r * u.cos(), r * u.sin(), minor * v.sin())).to_array()
    };
    let facets = (0..around * across).flat_map(|k| {
        let (i, j) = (k / across, k % across);
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    TriangleMesh::from_facets(facets.collect::<Vec<_>>()).unwrap()
}

fn assert_mesh(mesh: &TriangleMesh, frame: &Frame, plane: &Plane, tolerance: f64, at: &str) {
    let truth = plane.area_in_mesh(mesh);
    let solid = MeshSolid::new(mesh.try_clone().unwrap(), FillRule::NonZero).unwrap();
    let size = frame.edge() * frame.edge();
    for budget in [0, 3, 50] {
        holds(&ask(&solid, frame, plane, 0.0, &limited(budget)), truth, size, at);
    }
    let fine = Tolerance { relative: 0.0, absolute: tolerance * size };
    let found = section_area(&solid, frame, &plane.library(), fine, &limited(200_000)).unwrap();
    holds(&found, truth, size, at);
    assert_eq!(found.stop_reason, StopReason::Tolerance, "{at} {found:?}");
    let coarse = frame.with_depth(5).unwrap();
    let tree = build(&solid, &coarse, Rule::Certified, &alone()).unwrap();
    let by_cells = ask(&tree, &coarse, plane, 0.0, &alone());
    holds(&by_cells, truth, size, at);
    assert!(by_cells.area.width() < 0.35 * size, "{at} {by_cells:?}");
}

#[test]
fn meshes_and_their_octrees_have_the_areas_of_outlines() {
    let mut random = Random(7);
    let frame = Frame::new([-1.1, -1.05, -1.15], 2.2, 20).unwrap();
    for round in 0..40 {
        let mesh = torus(&mut random);
        let plane = Plane { point: vector(&mut random) * 0.6, normal: vector(&mut random) };
        assert_mesh(&mesh, &frame, &plane, 1e-6, &format!("round {round}"));
    }
}

#[test]
fn a_part_has_the_areas_of_its_outlines() {
    let Some(path) = model("featuretype.STL") else { return };
    let mesh = exchange::read_stl(&std::fs::read(path).unwrap()).unwrap();
    let (min, max) = mesh.bounds();
    let frame = Frame::fitted(min, max, 20).unwrap();
    let (low, high) = (DVec3::from(min), DVec3::from(max));
    let mut random = Random(8);
    for round in 0..10 {
        let share = DVec3::from_array([0; 3].map(|_| random.between(0.2, 0.8)));
        let plane = Plane { point: low + (high - low) * share, normal: vector(&mut random) };
        assert_mesh(&mesh, &frame, &plane, 1e-5, &format!("round {round}"));
    }
}

/// Expressions of all kinds. An expression and its complement share the plane, and their octrees agree.
#[test]
fn expressions_and_their_complements_share_the_plane() {
    let mut random = Random(9);
    let frame = Frame::new([-1.0, -1.1, -1.2], 2.1, 20).unwrap();
    let coarse = frame.with_depth(4).unwrap();
    let (mut round, mut tight) = (0, 0);
    while round < 300 {
        let aligned = round % 5 == 0;
        let mut maker = Maker { random: &mut random, frame: coarse, aligned, others: false };
        let count = 1 + maker.below(4);
        let made = maker.joined(count);
        let Ok(solid) = made.csg(&coarse) else { continue };
        round += 1;
        let point = DVec3::from_array(
            [0, 1, 2].map(|i| frame.origin()[i] + random.between(0.05, 0.95) * frame.edge()),
        );
        let normal = if round % 4 == 0 { DVec3::AXES[round % 3] } else { vector(&mut random) };
        let plane = Plane { point, normal };
        let whole = plane.area_in_universe(&frame);
        let slack = 1e-12 * frame.edge() * frame.edge();
        let complement = solid.complement();
        let mut last: Option<[Interval; 2]> = None;
        for budget in [0, 5, 60, 1500] {
            let [a, b] = [&solid, &complement].map(|solid| ask(solid, &frame, &plane, 0.0, &limited(budget)));
            let at = format!("round {round}, {budget}, {plane:?}, {whole}: {a:?} {b:?}");
            assert!(
                a.area.lower + b.area.lower <= whole + slack && whole - slack <= a.area.upper + b.area.upper,
                "{at}"
            );
            for (old, new) in last.iter().flatten().zip([a.area, b.area]) {
                assert!(new.lower <= old.upper + slack && old.lower - slack <= new.upper, "{at}");
            }
            tight += i32::from(budget == 1500 && a.area.width() < 1e-3 * whole);
            last = Some([a.area, b.area]);
        }
        if round % 4 == 0 {
            let tree = build(&solid, &coarse, Rule::Certified, &alone()).unwrap();
            let cells = ask(&tree, &coarse, &plane, 0.0, &alone()).area;
            let [fine, _] = last.unwrap();
            assert!(
                cells.lower <= fine.upper + slack && fine.lower - slack <= cells.upper,
                "round {round} {cells:?} {fine:?}"
            );
        }
    }
    println!("{tight} of {round} to a thousandth");
    assert!(tight > 150, "{tight}");
}

#[test]
fn what_is_not_proven_is_not_claimed() {
    let frame = Frame::new([-1.0; 3], 2.0, 5).unwrap();
    let mut random = Random(10);
    for round in 0..200 {
        let plane = Plane { point: vector(&mut random) * 0.5, normal: vector(&mut random) };
        let whole = plane.area_in_universe(&frame);
        let ball = Csg::ball([0.0; 3], 0.8).unwrap();
        let of =
            |rule: Rule| ask(&build(&ball, &frame, rule, &alone()).unwrap(), &frame, &plane, 0.0, &alone());
        let [sampled, inner, outer, certified] =
            [Rule::Sampled, Rule::Inner, Rule::Outer, Rule::Certified].map(of);
        let is_whole = |found: f64| (found - whole).abs() < 1e-11 * whole;
        assert!(sampled.area.lower == 0.0 && is_whole(sampled.area.upper), "round {round} {sampled:?}");
        assert_eq!((sampled.splits, sampled.stop_reason), (0, StopReason::Exhausted));
        assert!(
            (inner.area.lower - certified.area.lower).abs() < 1e-11 && is_whole(inner.area.upper),
            "{inner:?}"
        );
        assert!(
            outer.area.lower == 0.0 && (outer.area.upper - certified.area.upper).abs() < 1e-11,
            "{outer:?}"
        );
        assert_eq!([sampled.proof.full, inner.proof.full, outer.proof.full], [false, true, false]);
    }
}

#[test]
fn planes_outside_of_the_universe_have_no_area() {
    let mut random = Random(11);
    for round in 0..300 {
        let frame = Frame::new([-1.0, 2.0, 0.3], 2.0, [1, 7, 20][round % 3]).unwrap();
        let solid = Csg::ball([0.0, 3.0, 1.3], 0.9).unwrap().complement();
        let centre = DVec3::new(0.0, 3.0, 1.3);
        let normal = if round % 4 == 0 { DVec3::AXES[round % 3] } else { vector(&mut random) };
        // Beyond the farthest corner, slightly or far.
        let reach = normal.abs().element_sum() / normal.length();
        let far = [1.0 + 1e-12, 1.5, 1e9, 1e60][(round / 4) % 4];
        let plane = Plane { point: centre + normal.normalize() * reach * far, normal };
        let found = ask(&solid, &frame, &plane, 0.0, &alone());
        assert_eq!((found.area, found.splits), (Interval::exactly(0.0), 0), "round {round} {plane:?}");
        assert_eq!((found.stop_reason, found.clipped), (StopReason::Tolerance, true));
    }
}

#[test]
fn budgets_tolerances_and_depths() {
    let deep = Frame::new([-1.0; 3], 2.0, 20).unwrap();
    let ball = Csg::ball([0.1, 0.0, 0.0], 0.75).unwrap();
    let plane = Plane { point: DVec3::new(0.2, 0.1, 0.0), normal: DVec3::new(0.3, 1.0, 0.2) };
    let whole = plane.area_in_universe(&deep);
    let none = ask(&ball, &deep, &plane, 0.0, &limited(0));
    assert_eq!((none.splits, none.stop_reason), (0, StopReason::Budget));
    assert!(none.area.lower >= 0.0 && none.area.upper <= whole * (1.0 + 1e-12));
    let one = ask(&ball, &deep, &plane, 0.0, &limited(1));
    assert_eq!((one.splits, one.stop_reason), (1, StopReason::Budget));
    // Either tolerance ends it; an infinite one at once.
    let of = |relative: f64, absolute: f64| {
        section_area(&ball, &deep, &plane.library(), Tolerance { relative, absolute }, &alone()).unwrap()
    };
    assert!(of(0.0, 1e-3).area.width() <= 1e-3 && of(1e-3, 0.0).area.width() <= 1e-3 * 2.0);
    assert_eq!(of(0.0, 1e-3).stop_reason, StopReason::Tolerance);
    assert_eq!((of(f64::INFINITY, 0.0).splits, of(0.0, f64::INFINITY).splits), (0, 0));
    // At depth 1, only the eight cells are known.
    let shallow = deep.with_depth(1).unwrap();
    let found = ask(&ball, &shallow, &plane, 0.0, &alone());
    assert_eq!((found.splits, found.stop_reason), (1, StopReason::Exhausted));
    // With the tolerance at the last bit that rounding leaves, the search ends, one way or the other.
    let found = ask(&ball, &deep, &plane, 0.0, &limited(SECTION_SPLITS / 8));
    assert!(found.splits <= SECTION_SPLITS / 8 && found.area.width() < 1e-8, "{found:?}");
    // The same for any number of threads, any length of the normal, and either direction.
    let many = ask(&ball, &deep, &plane, 1e-5, &Control::threads(4));
    assert_eq!(many, ask(&ball, &deep, &plane, 1e-5, &alone()));
    for factor in [-1.0, 2f64.powi(200), -(2f64.powi(-200))] {
        let other = Plane { normal: plane.normal * factor, ..plane };
        assert_eq!(many, ask(&ball, &deep, &other, 1e-5, &alone()));
    }
}

#[test]
fn a_face_in_an_oblique_plane_stays_in_doubt() {
    let frame = Frame::new([-1.0; 3], 2.0, 20).unwrap();
    let half = Csg::half_space([1.0, 2.0, 3.0], -0.25).unwrap();
    let plane = Plane { point: DVec3::new(0.25, 0.0, 0.0), normal: DVec3::new(-1.0, -2.0, -3.0) };
    let found = ask(&half, &frame, &plane, 0.0, &limited(2000));
    assert!(
        found.area.lower < 1e-9 && found.area.upper > plane.area_in_universe(&frame) * (1.0 - 1e-9),
        "{found:?}"
    );
    assert!(found.clipped && found.stop_reason == StopReason::Budget);
    // Also in a plane across an axis that is no plane of the lattice.
    let half = Csg::half_space([0.0, 1.0, 0.0], -0.3).unwrap();
    let found = ask(&half, &frame, &Plane::across(1, 0.3), 0.0, &limited(2000));
    assert!(found.area.lower == 0.0 && found.area.upper == 4.0, "{found:?}");
}

#[test]
fn a_shape_of_a_host_goes_by_its_cells() {
    let (centre, radius) = ([0.05, 0.0, -0.1], 0.8f64);
    let frame = Frame::new([-1.0, -1.1, -1.2], 2.3, 9).unwrap();
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
    let plane = Plane { point: DVec3::from(centre), normal: DVec3::new(1.0, 0.4, -0.3) };
    let truth = PI * radius * radius;
    let mut last = f64::INFINITY;
    for budget in [10, 100, 1000, 10_000] {
        let found = ask(&ball, &frame, &plane, 0.0, &limited(budget));
        holds(&found, truth, 1.0, "host");
        assert!(found.area.width() < 0.5 * last, "{found:?} {last}");
        last = found.area.width();
    }
    assert!(last < 0.02 * truth, "{last}");
}

#[test]
fn huge_and_tiny_coordinates() {
    let mut random = Random(12);
    for round in 0..repeated(30, 200) {
        // All of it times a power of two.
        let exponent = random.below(400) as i32 - 200;
        let scale = 2f64.powi(exponent);
        let shift = DVec3::splat([0.0, 1e6, -1e12][round % 3]);
        let frame =
            Frame::new(((shift + DVec3::new(-1.0, -1.5, -0.75)) * scale).into(), 2.5 * scale, 20).unwrap();
        let centre = DVec3::from_array([0; 3].map(|_| (random.between(-0.1, 0.1) * 1024.0).round() / 1024.0));
        let ball = Csg::ball(((shift + centre) * scale).into(), 0.5 * scale).unwrap();
        // Through the centre, where the area depends on the plane to second order only.
        let plane = Plane { point: (shift + centre) * scale, normal: vector(&mut random) };
        let found = ask(&ball, &frame, &plane, 1e-6, &alone());
        let (truth, at) = (0.25 * PI * scale * scale, format!("round {round}, {scale:e}"));
        assert_eq!(found.stop_reason, StopReason::Tolerance, "{at} {found:?}");
        holds(&found, truth, truth, &at);
        // By a point far away in the same plane: x + y = 0.
        let frame = Frame::new([-scale; 3], 2.0 * scale, 20).unwrap();
        let ball = Csg::ball([0.25 * scale, 0.0, 0.0], 0.5 * scale).unwrap();
        let far = 2f64.powi((exponent + random.below(200) as i32).min(250));
        let normal = DVec3::new(scale, scale, 0.0);
        let near = Plane { point: DVec3::ZERO, normal };
        let away = Plane { point: DVec3::new(far, -far, 0.0), normal };
        let (a, b) = (ask(&ball, &frame, &near, 1e-6, &alone()), ask(&ball, &frame, &away, 1e-6, &alone()));
        assert_eq!(a, b, "{at} {far:e}");
        holds(&a, PI * (0.25 - 0.03125) * scale * scale, truth, &at);
    }
}

#[test]
fn what_is_refused_and_cancelled() {
    let good = [0.0, 1.0, -2.0];
    for bad in [f64::NAN, f64::INFINITY, 1e300, 1e-300, f64::NEG_INFINITY] {
        for axis in 0..3 {
            let mut numbers = good;
            numbers[axis] = bad;
            let refused = SectionPlane::new(numbers, good);
            assert!(matches!(refused, Err(Error::Argument { name: "point", .. })));
            let refused = SectionPlane::new(good, numbers);
            assert!(matches!(refused, Err(Error::Argument { name: "normal", .. })));
        }
    }
    for none in [[0.0; 3], [-0.0; 3]] {
        assert!(matches!(SectionPlane::new(good, none), Err(Error::Argument { name: "normal", .. })));
    }
    let frame = Frame::new([-1.0; 3], 2.0, 20).unwrap();
    let ball = Csg::ball([0.1, 0.0, 0.0], 0.75).unwrap();
    let plane = SectionPlane::new([0.1; 3], [1.0, 2.0, 3.0]).unwrap();
    for (relative, absolute) in [(-1.0, 0.0), (f64::NAN, 0.0), (0.0, -1.0), (0.0, f64::NAN)] {
        let refused = section_area(&ball, &frame, &plane, Tolerance { relative, absolute }, &alone());
        assert!(matches!(refused, Err(Error::Argument { name: "tolerance", .. })));
    }
    // A stored octree belongs to its frame.
    let elsewhere = Frame::new([-1.0; 3], 2.5, 4).unwrap();
    let tree = build(&ball, &elsewhere, Rule::Certified, &alone()).unwrap();
    assert!(matches!(section_area(&tree, &frame, &plane, 0.0, &alone()), Err(Error::FrameMismatch { .. })));
    let cancel = AtomicBool::new(true);
    let cancelled = Control { cancel: Some(&cancel), ..alone() };
    assert!(matches!(section_area(&ball, &frame, &plane, 0.1, &cancelled), Err(Error::Cancelled)));
    // Half-way.
    cancel.store(false, Relaxed);
    let stop = |fraction: f64| cancel.store(fraction > 0.3, Relaxed);
    let control = Control { progress: Some(&stop), max_splits: Some(5000), ..cancelled };
    assert!(matches!(section_area(&ball, &frame, &plane, 0.0, &control), Err(Error::Cancelled)));
    let seen = std::sync::Mutex::new(Vec::new());
    let progress = |fraction: f64| seen.lock().unwrap().push(fraction);
    let control = Control { progress: Some(&progress), max_splits: Some(5000), ..alone() };
    section_area(&ball, &frame, &plane, 0.0, &control).unwrap();
    let seen = seen.into_inner().unwrap();
    assert!(seen.len() > 100 && seen.is_sorted() && seen.last() == Some(&1.0), "{seen:?}");
}

#[test]
fn memory_ends_it_as_a_budget_does() {
    let mut random = Random(13);
    let mesh = torus(&mut random);
    let frame = Frame::new([-1.1; 3], 2.2, 20).unwrap();
    let plane = Plane { point: DVec3::ZERO, normal: vector(&mut random) };
    let truth = plane.area_in_mesh(&mesh);
    let solid = MeshSolid::new(mesh, FillRule::NonZero).unwrap();
    let mut widths = Vec::new();
    for bytes in [0, 10_000, 100_000] {
        let control = Control { max_bytes: Some(bytes), max_splits: Some(20_000), ..alone() };
        let found = ask(&solid, &frame, &plane, 0.0, &control);
        holds(&found, truth, 1.0, "memory");
        widths.push(found.area.width());
    }
    assert!(widths[0] > widths[2], "{widths:?}");
}
