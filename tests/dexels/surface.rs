//! Octrees, surfaces, solids and voxels made from tri-dexel models, against dense arrays and formulas.

use leafless::dexel::{Dexel, DexelEnd, DexelEnds, DexelFormat, DexelNormals};
use leafless::error::MeshError;
use leafless::op::{DexelOptions, octree_from_dexels};
use leafless::query::surface_area;
use leafless::surface::{DexelSolid, DexelSurfaceReport, dual_contouring_dexels, marching_cubes_dexels};
use leafless::voxel::{LongVoxel, VoxelKind, dexel_voxels};
use leafless::{
    AnySolid, Classifier, Control, Csg, Error, FillRule, Frame, Membership, MeshSolid, Proof, Rule, Solid,
    Tag, TriDexel, TriangleMesh, build, dexelize, measure,
};
use leafless_testkit::Random;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

/// The format of most tests.
const FORMAT: DexelFormat =
    DexelFormat { ends: DexelEnds::Double, normals: DexelNormals::Bits32, surfaces: false, materials: false };

const ALL: [bool; 3] = [true; 3];

/// The other two axes of each axis, ascending.
const OTHERS: [[usize; 2]; 3] = [[1, 2], [0, 2], [0, 1]];

fn plain_end(at: f64) -> DexelEnd {
    DexelEnd::new(at)
}

/// A model with intervals of random length on every ray, so that the directions contradict each other.
fn soup(frame: &Frame, format: DexelFormat, directions: [bool; 3], seed: u64) -> TriDexel {
    let mut random = Random(seed);
    let (low, cell) = (frame.origin(), frame.cell_size());
    let rays = |axis: usize, _: [u32; 2], list: &mut Vec<Dexel>| {
        let cells = f64::from(frame.cells());
        let mut ends: Vec<f64> = (0..2 * random.below(5))
            .map(|_| match random.below(4) {
                // On centres, on planes of the lattice, and anywhere.
                0 => random.below(frame.cells().into()) as f64 + 0.5,
                1 => random.below(u64::from(frame.cells()) + 1) as f64,
                _ => random.unit() * cells,
            })
            .collect();
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        ends.truncate(ends.len() / 2 * 2);
        list.extend(ends.chunks(2).map(|ends| {
            let mut end = |at: f64| {
                let normal = [0.0; 3].map(|_: f64| random.unit() - 0.5);
                DexelEnd { normal: Some(normal), ..plain_end(low[axis] + at * cell) }
            };
            Dexel { start: end(ends[0]), end: end(ends[1]), material: random.below(3) as u32 }
        }));
        Ok(())
    };
    TriDexel::from_rays(frame, format, directions, rays, &Control::default()).unwrap()
}

/// True if the rays along an axis contain the centre of a cell.
fn holds(model: &TriDexel, axis: usize, cell: [u32; 3]) -> bool {
    let frame = model.frame();
    let centre = frame.origin()[axis] + (f64::from(cell[axis]) + 0.5) * frame.cell_size();
    let ray = OTHERS[axis].map(|other| cell[other]);
    model.view().rays(axis).unwrap().dexels(ray).any(|d| d.start.at <= centre && centre < d.end.at)
}

fn cells(frame: &Frame) -> impl Iterator<Item = [u32; 3]> + use<> {
    let n = frame.cells();
    (0..n * n * n).map(move |i| [i % n, i / n % n, i / n / n])
}

const SOME_DIRECTIONS: [[bool; 3]; 7] = [
    [true, false, false],
    [false, true, false],
    [false, false, true],
    [true, true, false],
    [true, false, true],
    [false, true, true],
    [true, true, true],
];

#[test]
fn octrees_hold_the_centres() -> Result<(), Error> {
    for depth in [1, 2, 5, 6, 7] {
        // A frame that is exact in doubles.
        let frame = Frame::new([-1.0, 0.5, 2.0], 4.0, depth)?;
        for (seed, directions) in (1u64..).zip(SOME_DIRECTIONS) {
            let ends = if seed % 2 == 0 { DexelEnds::Double } else { DexelEnds::Fixed };
            let model = soup(&frame, DexelFormat { ends, ..FORMAT }, directions, seed + u64::from(depth));
            let tree = octree_from_dexels(model.view(), &Control::default())?;
            let deciding = directions.iter().rposition(|&has| has).unwrap();
            for cell in cells(&frame) {
                let expected = holds(&model, deciding, cell);
                assert_eq!(model.view().contains_cell(cell), expected, "{directions:?} {cell:?}");
                let centre = [0, 1, 2]
                    .map(|axis| frame.origin()[axis] + (f64::from(cell[axis]) + 0.5) * frame.cell_size());
                let stored = if expected { Membership::Inside } else { Membership::Outside };
                assert_eq!(tree.contains(centre), stored, "depth {depth} {directions:?} {cell:?}");
            }
            tree.view().check()?;
            assert_eq!(tree.proof(), Proof::new(false, false));
            assert_eq!(tree.view().exterior(), Tag::Empty);
            assert!(tree.view().is_binary());
            let again = octree_from_dexels(model.view(), &Control::threads(2))?;
            assert!(again == tree);
        }
    }
    Ok(())
}

/// A model of all points with f < 0, found by steps of an eighth of a cell and bisection.
fn implicit(frame: &Frame, directions: [bool; 3], f: &dyn Fn([f64; 3]) -> f64) -> TriDexel {
    let cell = frame.cell_size();
    let centre = |axis: usize, k: u32| frame.origin()[axis] + (f64::from(k) + 0.5) * cell;
    let rays = |axis: usize, ray: [u32; 2], list: &mut Vec<Dexel>| {
        let at = |x: f64| {
            let mut point = [x; 3];
            for (other, k) in OTHERS[axis].into_iter().zip(ray) {
                point[other] = centre(other, k);
            }
            point
        };
        let end = |mut low: f64, mut high: f64| {
            let below = f(at(low)) < 0.0;
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if (f(at(middle)) < 0.0) == below { low = middle } else { high = middle }
            }
            let point = at(0.5 * (low + high));
            let step = 1e-5 * cell;
            let normal = [0, 1, 2].map(|axis| {
                let (mut less, mut more) = (point, point);
                less[axis] -= step;
                more[axis] += step;
                f(more) - f(less)
            });
            DexelEnd { normal: Some(normal), ..plain_end(point[axis]) }
        };
        let steps = 8 * frame.cells();
        let position = |k: u32| frame.origin()[axis] + f64::from(k) * cell / 8.0;
        let mut open = (f(at(position(0))) < 0.0).then(|| plain_end(position(0)));
        for k in 0..steps {
            let [before, after] = [k, k + 1].map(|k| f(at(position(k))) < 0.0);
            if before != after {
                let here = end(position(k), position(k + 1));
                match open.take() {
                    Some(start) => list.push(Dexel { start, end: here, material: 0 }),
                    None => open = Some(here),
                }
            }
        }
        if let Some(start) = open {
            list.push(Dexel { start, end: plain_end(position(steps)), material: 0 });
        }
        Ok(())
    };
    TriDexel::from_rays(frame, FORMAT, directions, rays, &Control::default()).unwrap()
}

/// A model of half-open boxes that do not overlap, each given by two corners.
fn boxes(frame: &Frame, format: DexelFormat, directions: [bool; 3], boxes: &[[[f64; 3]; 2]]) -> TriDexel {
    let rays = |axis: usize, ray: [u32; 2], list: &mut Vec<Dexel>| {
        for (material, [low, high]) in (1u32..).zip(boxes) {
            let meets = OTHERS[axis].into_iter().zip(ray).all(|(other, k)| {
                let centre = frame.origin()[other] + (f64::from(k) + 0.5) * frame.cell_size();
                low[other] <= centre && centre < high[other]
            });
            if meets {
                let end = |side: usize| {
                    let mut normal = [0.0; 3];
                    normal[axis] = [-1.0, 1.0][side];
                    DexelEnd { normal: Some(normal), ..plain_end([low, high][side][axis]) }
                };
                list.push(Dexel { start: end(0), end: end(1), material });
            }
        }
        list.sort_by(|a, b| a.start.at.total_cmp(&b.start.at));
        Ok(())
    };
    TriDexel::from_rays(frame, format, directions, rays, &Control::default()).unwrap()
}

type Method = fn(&TriDexel, &Control<'_>) -> Result<(TriangleMesh, DexelSurfaceReport), Error>;

fn cubes(model: &TriDexel, control: &Control<'_>) -> Result<(TriangleMesh, DexelSurfaceReport), Error> {
    marching_cubes_dexels(model.view(), control)
}

fn dual(model: &TriDexel, control: &Control<'_>) -> Result<(TriangleMesh, DexelSurfaceReport), Error> {
    dual_contouring_dexels(model.view(), control)
}

/// Extracts the surface by a method. Checks that the surface is balanced, is the same for any number of
/// threads, and reports the number of cut edges.
fn surface(method: Method, model: &TriDexel) -> (TriangleMesh, DexelSurfaceReport) {
    let (mesh, report) = method(model, &Control::threads(1)).unwrap();
    let (again, report_again) = method(model, &Control::threads(2)).unwrap();
    assert_eq!((mesh.vertices(), mesh.triangles()), (again.vertices(), again.triangles()));
    assert_eq!(report, report_again);
    let tree = octree_from_dexels(model.view(), &Control::default()).unwrap();
    let samples = leafless::marching_cubes(tree.view(), None, &Control::default()).unwrap();
    assert_eq!(report.crossings, samples.vertices().len() as u64);
    if !samples.triangles().is_empty() && !mesh.triangles().is_empty() {
        mesh.check_closed(FillRule::NonZero).unwrap();
    }
    let different: BTreeSet<_> = mesh.vertices().iter().map(|vertex| vertex.map(f64::to_bits)).collect();
    assert_eq!(different.len(), mesh.vertices().len());
    let used: BTreeSet<_> = mesh.triangles().iter().flatten().collect();
    assert_eq!(used.len(), mesh.vertices().len());
    (mesh, report)
}

/// Counts the edges where not exactly two triangles meet in opposite directions.
fn uneven_edges(mesh: &TriangleMesh) -> usize {
    let mut edges: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    for &[a, b, c] in mesh.triangles() {
        for edge in [[a, b], [b, c], [c, a]] {
            *edges.entry(edge).or_default() += 1;
        }
    }
    edges.iter().filter(|&(&[a, b], &count)| count != 1 || edges.get(&[b, a]) != Some(&1)).count()
}

/// Checks that each vertex lies at an end of an interval, on a line between centres.
fn check_on_crossings(model: &TriDexel, mesh: &TriangleMesh) {
    let frame = model.frame();
    let cell = frame.cell_size();
    let mut ends: BTreeSet<(usize, [u32; 2], u64)> = BTreeSet::new();
    for axis in 0..3 {
        let Some(rays) = model.view().rays(axis) else { continue };
        let [us, vs] = rays.window();
        for v in vs {
            for u in us.clone() {
                for dexel in rays.dexels([u, v]) {
                    for end in [dexel.start, dexel.end] {
                        ends.insert((axis, [u, v], end.at.to_bits()));
                    }
                }
            }
        }
    }
    for vertex in mesh.vertices() {
        let found = (0..3).any(|axis| {
            let cells = OTHERS[axis].map(|other| (vertex[other] - frame.origin()[other]) / cell - 0.5);
            let ray = cells.map(|c| c.round().max(0.0) as u32);
            ends.contains(&(axis, ray, vertex[axis].to_bits()))
                && (0..2).all(|i| cells[i] == f64::from(ray[i]))
        });
        assert!(found, "{vertex:?}");
    }
}

/// Checks that each vertex lies in a cube between eight centres, some inside and some outside.
fn check_in_cubes(model: &TriDexel, mesh: &TriangleMesh) {
    let frame = model.frame();
    let inside = |at: [i64; 3]| {
        at.iter().all(|&k| 0 <= k && k < i64::from(frame.cells()))
            && model.view().contains_cell(at.map(|k| k as u32))
    };
    for vertex in mesh.vertices() {
        let place = [0, 1, 2].map(|axis| (vertex[axis] - frame.origin()[axis]) / frame.cell_size() - 0.5);
        // On common faces of cubes, the tag may be that of any of the cubes.
        let choices = place.map(|c| [(c - 1e-9).floor() as i64, (c + 1e-9).floor() as i64]);
        let found = (0..8).any(|choice| {
            let cube = [0, 1, 2].map(|axis| choices[axis][choice >> axis & 1]);
            let corners = (0..8).filter(|&k| inside([0, 1, 2].map(|axis| cube[axis] + (k >> axis & 1))));
            (1..8).contains(&corners.count())
        });
        assert!(found, "{vertex:?}");
    }
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// A shape function, negative inside.
type Shape = fn([f64; 3]) -> f64;

fn ball([x, y, z]: [f64; 3]) -> f64 {
    length([x - 0.03, y + 0.01, z - 0.02]) - 0.8
}

fn torus([x, y, z]: [f64; 3]) -> f64 {
    length([length([x, y, 0.0]) - 0.55, z - 0.013, 0.0]) - 0.27
}

/// A sloping wall, slightly thicker than a cell.
fn wall([x, y, z]: [f64; 3]) -> f64 {
    let across = (0.6 * x + 0.64 * y + 0.48 * z - 0.05).abs() - 0.055;
    let ends = [x, y, z].iter().fold(0.0, |most: f64, c| most.max(c.abs())) - 0.7;
    across.max(ends)
}

#[test]
fn smooth_shapes_have_their_volume() {
    let frame = Frame::new([-1.0; 3], 2.0, 5).unwrap();
    let cell = frame.cell_size();
    // Shape, volume, area, least radius of curvature.
    let shapes: [(Shape, f64, f64, f64); 2] = [
        (ball, 4.0 / 3.0 * PI * 0.8f64.powi(3), 4.0 * PI * 0.64, 0.8),
        (torus, 2.0 * PI * PI * 0.55 * 0.27 * 0.27, 4.0 * PI * PI * 0.55 * 0.27, 0.27),
    ];
    for (shape, volume, area, radius) in shapes {
        // The height of an arc above a chord as long as a cell.
        let height = cell * cell / (8.0 * radius);
        let model = implicit(&frame, ALL, &shape);
        for method in [cubes as Method, dual] {
            let (mesh, report) = surface(method, &model);
            assert_eq!(uneven_edges(&mesh), 0);
            assert_eq!([report.several, report.without_rays, report.disagreeing], [0; 3]);
            assert_eq!([report.without_normals, report.means], [0; 2]);
            // (A surface is curved in two directions.)
            assert!((mesh.volume() - volume).abs() < 2.0 * area * height, "{} {volume}", mesh.volume());
            for vertex in mesh.vertices() {
                // (The diagonal of a cube is the root of three cells long.)
                assert!(shape(*vertex).abs() < 3.0 * height, "{vertex:?}");
            }
        }
        let (mesh, _) = surface(cubes, &model);
        check_on_crossings(&model, &mesh);
        check_in_cubes(&model, &surface(dual, &model).0);
    }
}

#[test]
fn thin_walls_are_closed() {
    let frame = Frame::new([-1.0; 3], 2.0, 5).unwrap();
    let model = implicit(&frame, ALL, &wall);
    for method in [cubes as Method, dual] {
        let (mesh, report) = surface(method, &model);
        assert_eq!(report.disagreeing + report.without_rays, 0);
        // (A sheet may be met twice between two centres.)
        assert!(mesh.volume() > 0.0);
        let expected = 0.11 * 2.0;
        assert!((mesh.volume() / expected - 1.0).abs() < 0.4, "{}", mesh.volume());
    }
    check_on_crossings(&model, &surface(cubes, &model).0);
    check_in_cubes(&model, &surface(dual, &model).0);
}

/// Faces at arbitrary places, at centres, in planes of cells, and at the universe's own faces.
#[test]
fn dual_contouring_keeps_edges_and_corners() {
    let frame = Frame::new([-1.0, 2.0, 0.0], 2.0, 4).unwrap();
    let cell = frame.cell_size();
    for (low, high) in [
        ([3.3, 4.21, 5.77], [9.9, 8.13, 12.34]),
        ([3.5, 4.5, 5.5], [9.5, 8.5, 12.5]),
        ([3.0, 4.0, 5.0], [9.0, 8.0, 12.0]),
        ([0.0, 0.0, 0.0], [16.0, 16.0, 16.0]),
        ([0.0, 2.5, 1.75], [16.0, 9.0, 2.75]),
        ([7.4, 7.4, 7.4], [8.6, 8.6, 8.6]),
    ] {
        let corner = |cells: [f64; 3]| [0, 1, 2].map(|axis| frame.origin()[axis] + cells[axis] * cell);
        let [low, high] = [corner(low), corner(high)];
        let model = boxes(&frame, FORMAT, ALL, &[[low, high]]);
        let (mesh, report) = surface(dual, &model);
        assert_eq!([report.disagreeing, report.without_normals, report.means, report.several], [0; 4]);
        let near = |a: f64, b: f64| (a - b).abs() < 1e-6 * cell;
        for k in 0..8usize {
            let corner = [0, 1, 2].map(|axis| [low, high][k >> axis & 1][axis]);
            let count =
                mesh.vertices().iter().filter(|v| (0..3).all(|axis| near(v[axis], corner[axis]))).count();
            assert_eq!(count, 1, "{corner:?}");
        }
        for vertex in mesh.vertices() {
            let inside = (0..3).all(|axis| {
                low[axis] - 1e-6 * cell <= vertex[axis] && vertex[axis] <= high[axis] + 1e-6 * cell
            });
            let on = (0..3).any(|axis| near(vertex[axis], low[axis]) || near(vertex[axis], high[axis]));
            assert!(inside && on, "{vertex:?}");
        }
        let volume: f64 = (0..3).map(|axis| high[axis] - low[axis]).product();
        assert!((mesh.volume() / volume - 1.0).abs() < 1e-6, "{} {volume}", mesh.volume());
        check_in_cubes(&model, &mesh);
        // Marching cubes cuts off edges by at most a cell.
        let (mesh, _) = surface(cubes, &model);
        check_on_crossings(&model, &mesh);
        let sizes = [0, 1, 2].map(|axis| high[axis] - low[axis]);
        let edges = 4.0 * sizes.iter().sum::<f64>();
        assert!(mesh.volume() <= volume * (1.0 + 1e-9));
        assert!(mesh.volume() > volume - 0.5 * cell * cell * edges, "{} {volume}", mesh.volume());
    }
}

/// Edges that do not run along axes are as exact as the stored normals.
#[test]
fn dual_contouring_keeps_turned_edges() {
    let frame = Frame::new([-1.0; 3], 2.0, 5).unwrap();
    let cell = frame.cell_size();
    // A rotation without a simple axis.
    let axes = [[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]].map(|v: [f64; 3]| v.map(|c| c / 3.0));
    let half = [0.61, 0.44, 0.37];
    let along = |p: [f64; 3], k: usize| (0..3).map(|axis| axes[k][axis] * p[axis]).sum::<f64>();
    let shape = |p: [f64; 3]| (0..3).map(|k| along(p, k).abs() - half[k]).fold(f64::MIN, f64::max);
    let model = implicit(&frame, ALL, &shape);
    let (mesh, report) = surface(dual, &model);
    // Where the solid's edge leaves a cube that sees both its faces, the vertex stays behind. All others lie
    // on it.
    let off: Vec<f64> =
        mesh.vertices().iter().map(|&v| shape(v).abs() / cell).filter(|&d| d > 2e-3).collect();
    assert!(off.len() as u64 <= report.clamped, "{} {report:?}", off.len());
    assert!(off.iter().all(|&distance| distance < 0.25), "{off:?}");
    // A corner is met if its cube sees all three faces.
    let face = |p: [f64; 3]| {
        (0..3).max_by(|&a, &b| f64::total_cmp(&(along(p, a).abs() - half[a]), &(along(p, b).abs() - half[b])))
    };
    let mut met = 0;
    for k in 0..8usize {
        let signs = [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { -half[axis] } else { half[axis] });
        let corner = [0, 1, 2].map(|axis| (0..3).map(|k| axes[k][axis] * signs[k]).sum::<f64>());
        let cube = corner.map(|c| (((c + 1.0) / cell - 0.5).floor() + 0.5) * cell - 1.0);
        let mut seen = BTreeSet::new();
        for edge in 0..12usize {
            let mut low = cube;
            for (i, other) in OTHERS[edge / 4].into_iter().enumerate() {
                low[other] += (edge >> i & 1) as f64 * cell;
            }
            let mut high = low;
            high[edge / 4] += cell;
            let below = shape(low) < 0.0;
            if below != (shape(high) < 0.0) {
                for _ in 0..60 {
                    let middle = [0, 1, 2].map(|axis| 0.5 * (low[axis] + high[axis]));
                    if (shape(middle) < 0.0) == below { low = middle } else { high = middle }
                }
                seen.insert(face(low));
            }
        }
        let nearest = mesh.vertices().iter().map(|v| length([0, 1, 2].map(|axis| v[axis] - corner[axis])));
        let nearest = nearest.fold(f64::MAX, f64::min);
        assert!(seen.len() < 3 || nearest < 2e-3 * cell, "{corner:?} {}", nearest / cell);
        met += u32::from(seen.len() == 3);
    }
    assert!(met > 0);
    // The volume cut off of edges elsewhere is far less than with marching cubes.
    let volume = 8.0 * half[0] * half[1] * half[2];
    let rough = volume - surface(cubes, &model).0.volume();
    assert!((mesh.volume() - volume).abs() < 0.125 * rough, "{} {volume} {rough}", mesh.volume());
    assert_eq!(uneven_edges(&mesh), 0);
}

#[test]
fn whatever_rays_say_surfaces_are_closed() {
    for depth in [1, 2, 3, 4, 5] {
        let frame = Frame::new([-1.0, 0.5, 2.0], 4.0, depth).unwrap();
        for (seed, directions) in (1u64..).zip(SOME_DIRECTIONS) {
            let ends = if seed % 2 == 0 { DexelEnds::Double } else { DexelEnds::Fixed };
            let model = soup(&frame, DexelFormat { ends, ..FORMAT }, directions, seed + u64::from(depth));
            let counts = [cubes as Method, dual].map(|method| {
                let (_, report) = surface(method, &model);
                assert!(report.disagreeing + report.without_rays <= report.crossings);
                let all = directions == ALL;
                assert_eq!(report.without_rays == 0, all || report.crossings == 0, "{directions:?}");
                [report.several, report.without_rays, report.disagreeing]
            });
            assert_eq!(counts[0], counts[1]);
            check_in_cubes(&model, &surface(dual, &model).0);
        }
    }
    // The empty set, and everything.
    let frame = Frame::new([0.0; 3], 4.0, 2).unwrap();
    let nothing = boxes(&frame, FORMAT, ALL, &[]);
    let none =
        TriDexel::from_rays(&frame, FORMAT, [false; 3], |_, _, _| Ok(()), &Control::default()).unwrap();
    for model in [nothing, none] {
        for method in [cubes as Method, dual] {
            let (mesh, report) = surface(method, &model);
            assert_eq!((mesh.triangles().len(), report), (0, DexelSurfaceReport::default()));
        }
    }
}

/// Random samples exercise all configurations and all pairs of neighbouring configurations.
#[test]
fn two_triangles_meet_on_every_edge() {
    let frame = Frame::new([0.0; 3], 16.0, 4).unwrap();
    let mut joints = 0;
    for seed in 0..20 {
        let mut random = Random(seed);
        let rays = |_: usize, _: [u32; 2], list: &mut Vec<Dexel>| {
            let mut last = -1.0;
            for k in 0..16 {
                let start = f64::from(k) + 0.6 * random.unit() - 0.3;
                let end = f64::from(k) + 1.0 + 0.6 * random.unit() - 0.3;
                if random.below(3) == 0 && start > last && start > 0.0 && end < 16.0 {
                    list.push(Dexel { start: plain_end(start), end: plain_end(end), material: 0 });
                    last = end;
                }
            }
            Ok(())
        };
        let model =
            TriDexel::from_rays(&frame, FORMAT, [false, false, true], rays, &Control::default()).unwrap();
        let (mesh, report) = surface(cubes, &model);
        assert_eq!(mesh.vertices().len() as u64, report.crossings);
        assert_eq!(uneven_edges(&mesh), 0);
        let (mesh, report) = surface(dual, &model);
        assert_eq!(report.without_normals, report.crossings);
        assert_eq!(uneven_edges(&mesh), 0);
        // All others keep sheets apart, two at a time.
        let more = mesh.vertices().len() as u64 - report.means;
        assert_eq!(more % 2, 0);
        joints += more;
    }
    assert!(joints > 0);
}

#[test]
fn of_several_crossings_the_nearest_to_the_inside_counts() {
    let frame = Frame::new([0.0; 3], 8.0, 3).unwrap();
    let rays = |_: usize, ray: [u32; 2], list: &mut Vec<Dexel>| {
        if ray == [4, 4] {
            // From the centre at 2.5 to the centre at 3.5, the ray enters at 2.7, leaves at 2.9 and enters at
            // 3.25. It leaves at 5.6, enters at 5.7 and leaves at 6.1.
            for (start, end) in [(2.7, 2.9), (3.25, 5.6), (5.7, 6.1)] {
                list.push(Dexel { start: plain_end(start), end: plain_end(end), material: 0 });
            }
        }
        Ok(())
    };
    let directions = [true, false, false];
    let format = DexelFormat { ends: DexelEnds::Double, ..DexelFormat::default() };
    let model = TriDexel::from_rays(&frame, format, directions, rays, &Control::default()).unwrap();
    let (mesh, report) = surface(cubes, &model);
    assert_eq!((report.several, report.disagreeing), (2, 0));
    let (low, high) = mesh.bounds();
    assert_eq!((low, high), ([3.25, 4.0, 4.0], [5.6, 5.0, 5.0]));
    // Three cells lie inside, each with four edges across.
    assert_eq!((report.crossings, report.without_rays), (14, 12));
}

#[test]
fn where_materials_touch_there_is_no_surface() {
    let frame = Frame::new([0.0; 3], 8.0, 3).unwrap();
    let format = DexelFormat { materials: true, ..FORMAT };
    let two = [[[1.25; 3], [4.0, 6.0, 6.0]], [[4.0, 1.25, 1.25], [6.0, 6.0, 6.0]]];
    let model = boxes(&frame, format, ALL, &two);
    let one = boxes(&frame, FORMAT, ALL, &[[[1.25; 3], [6.0; 3]]]);
    for method in [cubes as Method, dual] {
        let (two, report_two) = surface(method, &model);
        let (one, report_one) = surface(method, &one);
        assert_eq!((two.vertices(), two.triangles()), (one.vertices(), one.triangles()));
        assert_eq!(report_two, report_one);
    }
}

/// Models of solids contain the solids' samples, and their surfaces lie near the solids.
#[test]
fn surfaces_of_dexelised_solids() -> Result<(), Error> {
    let (frame, control) = (Frame::new([-1.0; 3], 2.0, 6)?, Control::default());
    let cell = frame.cell_size();
    let block = Csg::cuboid([-0.71, -0.52, -0.63], [0.74, 0.66, 0.59])?;
    let solids = [
        (block.clone(), true),
        (block.difference(&Csg::ball([0.74, 0.66, 0.59], 0.55)?)?, true),
        (Csg::ball([0.1, 0.05, 0.0], 0.8)?, false),
    ];
    for (solid, has_edges) in solids {
        let truth = measure(&solid, &frame, 1e-4, &control)?.volume;
        let area = surface_area(&solid, &frame, 0.1, &control)?.area.lower;
        for (normals, ends) in
            [(DexelNormals::Bits16, DexelEnds::Fixed), (DexelNormals::Bits32, DexelEnds::Double)]
        {
            let format = DexelFormat { ends, normals, ..DexelFormat::default() };
            let options = DexelOptions { format, ..DexelOptions::default() };
            let model = dexelize(&solid, &frame, &options, &control)?;
            let tree = octree_from_dexels(model.view(), &control)?;
            assert!(tree == build(&solid, &frame, Rule::Sampled, &control)?.with_proof(tree.proof()));
            let [rough, sharp] = [cubes as Method, dual].map(|method| {
                let (mesh, report) = surface(method, &model);
                assert_eq!([report.disagreeing, report.without_rays], [0; 2]);
                assert_eq!(report.means, 0);
                // A cell's second-order error everywhere. Edges are a small part of the surface.
                assert!((mesh.volume() - truth.lower).abs() < 0.5 * area * cell * cell / 0.55);
                mesh
            });
            check_in_cubes(&model, &sharp);
            if has_edges {
                let lost = [&rough, &sharp].map(|mesh| (mesh.volume() - truth.lower).abs());
                assert!(lost[1] < 0.25 * lost[0], "{lost:?}");
            }
        }
    }
    Ok(())
}

#[test]
fn models_are_solids() -> Result<(), Error> {
    let (frame, control) = (Frame::new([-1.0; 3], 2.0, 5)?, Control::default());
    let model = implicit(&frame, ALL, &ball);
    let solid = DexelSolid::new(model.view(), &control)?;
    let (mesh, report) = marching_cubes_dexels(model.view(), &control)?;
    assert_eq!((solid.mesh().vertices(), solid.report()), (mesh.vertices(), report));
    let surface = MeshSolid::new(mesh, FillRule::NonZero)?;
    let other = Frame::new([-1.5; 3], 3.0, 6)?;
    for rule in [Rule::Certified, Rule::Sampled, Rule::Outer] {
        let expected = build(&surface, &other, rule, &control)?;
        let tree = build(&solid, &other, rule, &control)?;
        assert!(tree.with_proof(expected.proof()) == expected);
        assert_eq!(tree.proof(), Proof::new(false, false));
        let tree = build(&AnySolid::new(solid.as_truth()), &other, rule, &control)?;
        assert!(tree == expected);
        assert_eq!(tree.proof(), expected.proof());
    }
    assert_eq!(solid.on(&other, &control)?.proof(), Proof::new(false, false));
    assert_eq!((solid.bounds(), solid.as_truth().bounds()), (None, surface.bounds()));
    let volume = 4.0 / 3.0 * PI * 0.512;
    let truth = measure(&solid.as_truth(), &other, 1e-9, &control)?;
    assert!(truth.exact && (truth.volume.lower / volume - 1.0).abs() < 0.01);
    // Rays prove nothing about the ball.
    let unproven = measure(&solid, &Frame::new([-1.5; 3], 3.0, 3)?, 1e-3, &control)?;
    assert!(unproven.volume.lower <= 0.0 && unproven.volume.upper >= 27.0, "{:?}", unproven.volume);
    let nothing = boxes(&frame, FORMAT, ALL, &[]);
    assert!(matches!(DexelSolid::new(nothing.view(), &control), Err(Error::Mesh(MeshError::Empty))));
    Ok(())
}

/// Colours of some of the materials.
const COLOURS: [[u8; 4]; 2] = [[10, 20, 30, 40], [250, 0, 0, 255]];

#[test]
fn voxels_lie_between_centres() -> Result<(), Error> {
    for depth in [1, 2, 5, 6, 7] {
        let frame = Frame::new([-1.0, 0.5, 2.0], 4.0, depth)?;
        for (seed, directions) in (1u64..).zip(SOME_DIRECTIONS) {
            if depth > 5 && seed % 3 != 0 {
                continue;
            }
            let format = DexelFormat { materials: seed % 2 == 0, ..FORMAT };
            let model = soup(&frame, format, directions, seed + u64::from(depth));
            let voxels = dexel_voxels(model.view(), &COLOURS, &Control::default())?;
            let n = frame.cells();
            let deciding = directions.iter().rposition(|&has| has).unwrap();
            // A dense array: the centres that lie inside, and their materials.
            let centre = |k: u32| frame.origin()[deciding] + (f64::from(k) + 0.5) * frame.cell_size();
            let rays = model.view().rays(deciding).unwrap();
            let made_of = |cell: [u32; 3]| {
                let at = centre(cell[deciding]);
                let mut dexels = rays.dexels(OTHERS[deciding].map(|other| cell[other]));
                dexels.find(|d| d.start.at <= at && at < d.end.at).map(|d| d.material)
            };
            let dense: Vec<Option<u32>> = cells(&frame).map(made_of).collect();
            let lookup = |at: [u32; 3]| {
                let within = at.iter().all(|&k| (1..=n).contains(&k));
                let [x, y, z] = at.map(|k| k.wrapping_sub(1));
                if within { dense[(x + n * (y + n * z)) as usize] } else { None }
            };
            let mut counts = [0u64; 3];
            let mut expected: Vec<LongVoxel> = Vec::new();
            for [z, x] in (0..=n).flat_map(|z| (0..=n).map(move |x| [z, x])) {
                let mut last = None;
                for y in 0..=n {
                    let corners: [Option<u32>; 8] = std::array::from_fn(|k| {
                        lookup([0, 1, 2].map(|axis| [x, y, z][axis] + (k as u32 >> axis & 1)))
                    });
                    let inside: Vec<u32> = corners.into_iter().flatten().collect();
                    let kind = match inside.len() {
                        0 => VoxelKind::Outside,
                        8 => VoxelKind::Inside,
                        _ => VoxelKind::Boundary,
                    };
                    counts[kind as usize] += 1;
                    let here = inside.first().map(|&material| (kind, material));
                    match here {
                        Some(_) if here == last => expected.last_mut().unwrap().length += 1,
                        Some((kind, material)) => {
                            let colour =
                                COLOURS.get(material as usize).copied().unwrap_or([128, 128, 128, 255]);
                            expected.push(LongVoxel { first: [x, y, z], length: 1, kind, material, colour })
                        }
                        None => {}
                    }
                    last = here;
                }
            }
            assert_eq!(voxels.list(), expected);
            let kinds = [VoxelKind::Outside, VoxelKind::Inside, VoxelKind::Boundary];
            assert_eq!(kinds.map(|kind| voxels.count(kind)), counts);
            if let Some(row) = voxels.list().first() {
                let (low, high) = row.bounds(&frame);
                for axis in 0..3 {
                    let first = f64::from(row.first[axis]) - 0.5;
                    let length = if axis == 1 { f64::from(row.length) } else { 1.0 };
                    let at = |cells: f64| frame.origin()[axis] + cells * frame.cell_size();
                    assert_eq!((low[axis], high[axis]), (at(first), at(first + length)));
                }
            }
        }
    }
    Ok(())
}

/// Measures the time for the largest usual lattice: `--ignored --nocapture`.
#[test]
#[ignore = "takes long"]
fn time_of_1024() -> Result<(), Error> {
    let frame = Frame::new([-1.0; 3], 2.0, 10)?;
    let ball = |axis: usize, ray: [u32; 2], list: &mut Vec<Dexel>| {
        let _ = axis;
        let centre = |i: u32| (f64::from(i) + 0.5) / 512.0 - 1.0;
        let rest = 0.81 - ray.iter().map(|&i| centre(i).powi(2)).sum::<f64>();
        if rest > 0.0 {
            let half = rest.sqrt();
            list.push(Dexel { start: plain_end(-half), end: plain_end(half), material: 0 });
        }
        Ok(())
    };
    for directions in [[true, false, false], [false, true, false], [false, false, true], ALL] {
        let model =
            TriDexel::from_rays(&frame, DexelFormat::default(), directions, ball, &Control::default())?;
        for threads in [1, 2] {
            let start = std::time::Instant::now();
            let tree = octree_from_dexels(model.view(), &Control::threads(threads))?;
            let octree = start.elapsed();
            let volume = tree.statistics().volume().lower;
            println!("{directions:?} {threads} threads: octree {octree:?}, volume {volume}");
            for (name, method) in [("marching cubes", cubes as Method), ("dual contouring", dual)] {
                let start = std::time::Instant::now();
                let (mesh, report) = method(&model, &Control::threads(threads))?;
                println!("  {name} {:?}, {} triangles, {report:?}", start.elapsed(), mesh.triangles().len());
            }
        }
    }
    Ok(())
}

/// A model of inside centres that the rays of all directions contain. `beyond` returns how far a ray's
/// intervals reach beyond their outermost centres.
fn around(
    frame: &Frame,
    inside: &BTreeSet<[u32; 3]>,
    mut beyond: impl FnMut([u32; 3], usize) -> [f64; 2],
) -> TriDexel {
    let rays = |axis: usize, ray: [u32; 2], list: &mut Vec<Dexel>| {
        let cell = |k: u32| {
            let mut cell = [k; 3];
            OTHERS[axis].into_iter().zip(ray).for_each(|(other, at)| cell[other] = at);
            cell
        };
        let mut k = 0;
        while k < frame.cells() {
            let first = k;
            while inside.contains(&cell(k)) {
                k += 1;
            }
            if first < k {
                let [before, behind] = beyond(cell(first), axis);
                let end = |cells: f64, side: f64| {
                    let mut normal = [0.0; 3];
                    normal[axis] = side;
                    DexelEnd { normal: Some(normal), ..DexelEnd::in_cells(frame, axis, cells).unwrap() }
                };
                let (low, high) = (f64::from(first) + 0.5, f64::from(k) - 0.5);
                let (start, end) = (end(low - before, -1.0), end((high + behind).max(high.next_up()), 1.0));
                list.push(Dexel { start, end, material: 0 });
            }
            k += 1;
        }
        Ok(())
    };
    TriDexel::from_rays(frame, FORMAT, ALL, rays, &Control::default()).unwrap()
}

fn both_surfaces(model: &TriDexel) -> [(TriangleMesh, DexelSurfaceReport); 2] {
    let control = Control::default();
    [marching_cubes_dexels(model.view(), &control), dual_contouring_dexels(model.view(), &control)]
        .map(Result::unwrap)
}

#[test]
fn a_body_of_one_centre_is_a_closed_mesh() {
    let frame = Frame::new([-1.3; 3], 2.9, 3).unwrap();
    for beyond in [[0.25, 0.25], [0.0, 0.25]] {
        let model = around(&frame, &[[3, 4, 5]].into(), |_, _| beyond);
        let size: f64 = (beyond[0] + beyond[1]) * frame.cell_size();
        for (mesh, report) in both_surfaces(&model) {
            let found = mesh.report().unwrap();
            assert!(found.is_closed() && !mesh.triangles().is_empty());
            assert_eq!((report.crossings, report.vanished, report.without_centres), (6, 0, 0));
            let extent = mesh.bounds();
            assert!((0..3).all(|axis| (extent.1[axis] - extent.0[axis] - size).abs() < 1e-9));
        }
        // The surface by dual contouring is the cuboid itself.
        let [_, (mesh, _)] = both_surfaces(&model);
        assert_eq!((mesh.vertices().len(), mesh.triangles().len()), (8, 12));
    }
}

#[test]
fn bodies_that_doubles_cannot_tell_from_their_centres_are_counted() {
    let mut random = Random(31);
    let (mut gone, mut there) = (0, 0);
    for round in 0..60 {
        // Near the origin, ends are distinguished to 2^-50; far from it, to a millionth of a cell.
        let origin = if round % 2 == 0 { 1e9 } else { 0.0 };
        let frame = Frame::new([origin; 3], 8.0, 3).unwrap();
        // One body in each octant, so that they do not touch.
        let mut bodies = Vec::new();
        for octant in 0..8u32 {
            let thin = random.below(4) != 0;
            let mut body: BTreeSet<[u32; 3]> = BTreeSet::new();
            let mut at = [0, 1, 2].map(|axis| 4 * (octant >> axis & 1) + 1);
            for _ in 0..=random.below(4) {
                body.insert(at);
                let axis = random.below(3) as usize;
                at[axis] = (at[axis] ^ 3) & !4 | at[axis] & 4;
            }
            bodies.push((body, thin));
        }
        let beyond = |thin: bool| {
            move |_: [u32; 3], axis: usize| {
                let tiny = [0.0, 1e-12];
                if thin { tiny } else { [0.25, 0.125 * (axis + 1) as f64] }
            }
        };
        let all: BTreeSet<[u32; 3]> = bodies.iter().flat_map(|(body, _)| body.iter().copied()).collect();
        let model = around(&frame, &all, |cell, axis| {
            let (_, thin) = bodies.iter().find(|(body, _)| body.contains(&cell)).unwrap();
            beyond(*thin)(cell, axis)
        });
        let together = both_surfaces(&model);
        for method in 0..2 {
            let mut expected = 0;
            for (body, thin) in &bodies {
                let alone = around(&frame, body, beyond(*thin));
                let (mesh, report) = &both_surfaces(&alone)[method];
                let vanished = mesh.triangles().is_empty();
                assert_eq!(report.vanished, u64::from(vanished), "{body:?}");
                expected += u64::from(vanished);
                if vanished { gone += 1 } else { there += 1 }
            }
            assert_eq!(together[method].1.vanished, expected);
            assert_eq!(together[method].1.without_centres, 0);
        }
    }
    assert!(gone > 100 && there > 100, "{gone} {there}");
}

#[test]
fn intervals_that_hold_no_centre_are_counted() {
    let frame = Frame::new([0.0; 3], 8.0, 3).unwrap();
    let control = Control::default();
    // A plate between centres. Rays of one direction meet it, and it contains no centre.
    let plate = Csg::cuboid([1.0, 1.0, 2.6], [7.0, 7.0, 3.4]).unwrap();
    let model = dexelize(&plate, &frame, &DexelOptions::default(), &control).unwrap();
    assert_eq!(model.view().without_centres(), 36);
    for (mesh, report) in both_surfaces(&model) {
        assert!(mesh.triangles().is_empty());
        assert_eq!((report.crossings, report.vanished, report.without_centres), (0, 0, 36));
    }
    // Two materials in one gap and beyond are one interval.
    let format = DexelFormat { materials: true, ..FORMAT };
    let rays = |_: usize, ray: [u32; 2], list: &mut Vec<Dexel>| {
        let end = plain_end;
        if ray == [4, 4] {
            list.push(Dexel { start: end(1.6), end: end(2.4), material: 1 });
            list.push(Dexel { start: end(2.4), end: end(2.6), material: 2 });
            list.push(Dexel { start: end(3.6), end: end(4.0), material: 1 });
            list.push(Dexel { start: end(4.0), end: end(4.4), material: 2 });
        }
        Ok(())
    };
    let model = TriDexel::from_rays(&frame, format, [false, true, false], rays, &control).unwrap();
    assert_eq!(model.view().without_centres(), 1);
}

/// At a depth where no cell-by-cell work is possible, the work on a few intervals depends only on their
/// number.
#[test]
fn at_the_greatest_depth_work_is_that_of_what_is_stored() {
    let start = std::time::Instant::now();
    let (depth, cells) = (20, 1u32 << 20);
    let frame = Frame::new([0.0; 3], f64::from(cells), depth).unwrap();
    let limited = Control { max_bytes: Some(1 << 30), ..Control::default() };
    let block = |low: [f64; 3], high: [f64; 3], directions: [bool; 3]| {
        let options = DexelOptions { directions, format: FORMAT, ..Default::default() };
        dexelize(&Csg::cuboid(low, high).unwrap(), &frame, &options, &limited).unwrap()
    };
    let small = block([700_000.25; 3], [700_003.25; 3], ALL);
    let tree = octree_from_dexels(small.view(), &limited).unwrap();
    assert_eq!(tree.statistics().volume().lower, 27.0);
    for (mesh, report) in both_surfaces(&small) {
        assert!(mesh.report().unwrap().is_closed() && report.crossings == 54 && report.several == 0);
    }
    let voxels = dexel_voxels(small.view(), &[], &limited).unwrap();
    let counts = [VoxelKind::Inside, VoxelKind::Boundary].map(|kind| voxels.count(kind));
    assert_eq!(counts, [8, 64 - 8]);
    assert_eq!(voxels.list().len(), 4 * 4 + 4 * 2);
    // A wire through the whole universe.
    for axis in 0..3 {
        let (mut low, mut high) = ([300_000.25; 3], [300_001.25; 3]);
        (low[axis], high[axis]) = (0.0, f64::from(cells));
        let wire = block(low, high, [0, 1, 2].map(|a| a == axis));
        assert_eq!(
            octree_from_dexels(wire.view(), &limited).unwrap().statistics().volume().lower,
            f64::from(cells)
        );
        // Another body far away, with too many rays between the two.
        if axis < 2 {
            let other = block([900_000.0; 3], [900_001.0; 3], [0, 1, 2].map(|a| a == axis));
            let joined = wire.view().union(other.view(), &Control::default());
            assert!(matches!(joined, Err(Error::Limit { .. })));
            assert!(matches!(wire.view().complement(&Control::default()), Err(Error::Limit { .. })));
        }
    }
    assert!(start.elapsed().as_secs() < 30, "{:?}", start.elapsed());
}
