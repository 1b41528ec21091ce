//! Rays of open meshes, against the winding number by its definition: a sum of solid angles over all
//! triangles.

use leafless::dexel::{DexelEnds, DexelFormat};
use leafless::op::{DexelOptions, octree_from_dexels};
use leafless::{Control, FillRule, Frame, MeshSolid, Rule, TriDexel, TriangleMesh, build, dexelize};
use leafless_testkit::Random;
use std::f64::consts::{PI, TAU};

fn only(axis: usize, ends: DexelEnds) -> DexelOptions {
    let format = DexelFormat { ends, surfaces: true, ..DexelFormat::default() };
    DexelOptions { directions: [0, 1, 2].map(|a| a == axis), format, ..DexelOptions::default() }
}

/// A bent tube or ball around (16.1, 15.8, 16.3), `at(s, t)` for s and t from 0 to 1. Triangles that
/// `is_hole` selects are missing.
fn patch(
    [m, n]: [u32; 2],
    at: impl Fn(f64, f64) -> [f64; 3],
    is_hole: impl Fn(u32, u32) -> bool,
) -> TriangleMesh {
    let vertices = (0..=m).flat_map(|i| (0..=n).map(move |j| (i, j)));
    let vertices =
        vertices.map(|(i, j)| at(f64::from(i) / f64::from(m), f64::from(j) / f64::from(n))).collect();
    let number = |i: u32, j: u32| i * (n + 1) + j;
    let mut triangles = Vec::new();
    for (i, j) in (0..m).flat_map(|i| (0..n).map(move |j| (i, j))).filter(|&(i, j)| !is_hole(i, j)) {
        let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    TriangleMesh::new(vertices, triangles).unwrap()
}

fn ball(holes: impl Fn(u32, u32) -> bool) -> TriangleMesh {
    let at = |s: f64, t: f64| {
        let (theta, phi) = (PI * (0.1 + 0.8 * s), TAU * t);
        let r = 11.0 + 0.7 * (3.0 * phi).sin();
        [16.1 + r * theta.sin() * phi.cos(), 15.8 + r * theta.sin() * phi.sin(), 16.3 + r * theta.cos()]
    };
    patch([16, 24], at, holes)
}

fn meshes() -> Vec<(&'static str, TriangleMesh)> {
    // The box has no lid. Its vertices lie on centres, so that rays run along the edges of any membrane over
    // the hole.
    let box_of = |low: f64, high: f64| {
        let vertices: Vec<_> =
            (0..8).map(|k| [0, 1, 2].map(|axis| if k >> axis & 1 != 0 { high } else { low })).collect();
        let faces = [[0, 2, 3, 1], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        TriangleMesh::new(vertices, triangles).unwrap()
    };
    let mut random = Random(5);
    let mut holes: Vec<(u32, u32)> = Vec::new();
    for _ in 0..12 {
        holes.push((random.below(16) as u32, random.below(24) as u32));
    }
    vec![
        ("ball without its poles", ball(|_, _| false)),
        ("ball with a window", ball(|i, j| (4..10).contains(&i) && (3..11).contains(&j))),
        ("ball with many holes", ball(|i, j| holes.contains(&(i, j)))),
        ("half a ball", ball(|_, j| j < 12)),
        ("box without a lid", box_of(4.0, 27.0)),
        ("box on centres without a lid", box_of(4.5, 27.5)),
    ]
}

/// The winding number, by its definition.
fn winding(mesh: &TriangleMesh, p: [f64; 3]) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let mut sum = 0.0;
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|v| [0, 1, 2].map(|axis| mesh.vertices()[v as usize][axis] - p[axis]));
        let [la, lb, lc] = [a, b, c].map(|v| dot(v, v).sqrt());
        let cross = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
        let real = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        sum += 2.0 * dot(a, cross).atan2(real);
    }
    sum / (4.0 * PI)
}

fn excess(fill: FillRule, winding: f64) -> f64 {
    if fill == FillRule::Positive { winding - 0.5 } else { winding.abs() - 0.5 }
}

/// Checks every end and the middle of every interval against the winding number. Where no triangle makes an
/// end, the winding number passes one half there.
fn check_ends(name: &str, mesh: &TriangleMesh, fill: FillRule, model: &TriDexel, axis: usize) -> [usize; 2] {
    let frame = model.frame();
    let scale = frame.edge();
    let rays = model.view().rays(axis).unwrap();
    let [columns, rows] = rays.window();
    let (mut free, mut pierced) = (0, 0);
    for (row, column) in rows.flat_map(|row| columns.clone().map(move |column| (row, column))) {
        // Rays in the walls of this box have no winding number.
        if name.contains("on centres") && [column, row].iter().any(|k| [4, 27].contains(k)) {
            continue;
        }
        let [u, v] = [[1, 2], [0, 2], [0, 1]][axis];
        let centre = |axis: usize, k: u32| frame.origin()[axis] + frame.cell_size() * (f64::from(k) + 0.5);
        let point = |at: f64| {
            let mut point = [at; 3];
            (point[u], point[v]) = (centre(u, column), centre(v, row));
            point
        };
        for dexel in rays.dexels([column, row]) {
            let ends = [dexel.start, dexel.end];
            let cells = ends.map(|end| end.cells.unwrap());
            for (side, end) in ends.iter().enumerate() {
                if end.surface.is_some() {
                    pierced += 1;
                    continue;
                }
                // Ends in the universe's faces and in planes of the lattice may coincide with triangles.
                if cells[side] == cells[side].round() {
                    continue;
                }
                free += 1;
                // 2^-36 of the edge, plus the rounding of the sums divided by their change along the ray.
                let step = scale * 1e-6;
                let inward = if side == 0 { step } else { -step };
                let [here, there] =
                    [inward, -inward].map(|step| excess(fill, winding(mesh, point(end.at + step))));
                let is_pierced = here * there > 0.0;
                assert!(!is_pierced, "{name} {axis} {column} {row}: {end:?} {here} {there}");
                assert!(here > -1e-9 && there < 1e-9, "{name} {axis} {column} {row}: {end:?} {here} {there}");
                let most = (here - there).abs() / 2e-6;
                let exact = excess(fill, winding(mesh, point(end.at)));
                let fine = 2f64.powi(-36) * most + 1e-12;
                assert!(exact.abs() <= fine, "{name} {axis} {column} {row}: {end:?} is off: {exact} {fine}");
            }
            if cells[1] - cells[0] > 1e-3 {
                let middle = excess(fill, winding(mesh, point(0.5 * (dexel.start.at + dexel.end.at))));
                assert!(middle > -1e-9, "{name} {axis} {column} {row}: {dexel:?} {middle}");
            }
        }
    }
    [free, pierced]
}

#[test]
fn ends_of_open_meshes_lie_where_winding_numbers_pass_one_half() {
    let control = Control::default();
    for (name, mesh) in meshes() {
        for (fill, depth) in [(FillRule::NonZero, 5), (FillRule::Positive, 5), (FillRule::NonZero, 6)] {
            let frame = Frame::new([0.0; 3], 32.0, depth).unwrap();
            let solid = MeshSolid::new(mesh.clone(), fill).unwrap();
            let tree = build(&solid, &frame, Rule::Sampled, &control).unwrap();
            let mut all = [0; 2];
            for axis in 0..3 {
                for ends in [DexelEnds::Fixed, DexelEnds::Double] {
                    let model = dexelize(&solid, &frame, &only(axis, ends), &control).unwrap();
                    model.view().check().unwrap();
                    assert!(
                        octree_from_dexels(model.view(), &control).unwrap() == tree,
                        "{name} {axis} {fill:?}"
                    );
                    if ends == DexelEnds::Double {
                        let found = check_ends(name, &mesh, fill, &model, axis);
                        all = [0, 1].map(|i| all[i] + found[i]);
                    }
                }
            }
            let threads = [1, 2].map(|threads| {
                dexelize(&solid, &frame, &only(2, DexelEnds::Double), &Control::threads(threads)).unwrap()
            });
            assert!(threads[0] == threads[1], "{name}");
            assert!(all[0] > 20 && all[1] > 200, "{name} {fill:?}: {all:?}");
        }
    }
}
