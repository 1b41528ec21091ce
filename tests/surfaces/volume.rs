//! Surfaces of volumes: vertices where the field between samples crosses the threshold.

use leafless::solid::{Band, Samples, VoxelGrid};
use leafless::surface::{Resolve, marching_cubes_volume, marching_cubes_with_volume};
use leafless::{
    Control, Csg, Error, Frame, Octree, Rule, TriangleMesh, Volume, build, difference, marching_cubes,
};
use leafless_testkit::surfaces::{assert_balanced, euler_of_manifold};
use leafless_testkit::{Random, alone};
use std::f64::consts::PI;
use std::sync::atomic::AtomicBool;

/// Returns the radius minus the distance from a centre, at the centres of voxels.
fn distances(grid: &VoxelGrid, centre: [f64; 3], radius: f64) -> Vec<f32> {
    let [nx, ny, nz] = grid.extents();
    let places = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
    let apart = |p: [f64; 3]| (0..3).map(|k| (p[k] - centre[k]).powi(2)).sum::<f64>().sqrt();
    places.map(|at| (radius - apart(grid.centre(at))) as f32).collect()
}

fn volume<'a>(samples: &'a [f32], grid: &VoxelGrid) -> Volume<'a> {
    Volume::new(samples.into(), grid, Band::at_least(0.0).unwrap(), &alone()).unwrap()
}

/// Vertices from a ball's distances lie on the ball to second order, and area and volume converge to second
/// order.
#[test]
fn balls_of_second_order() {
    let (centre, radius) = ([0.53, 0.48, 0.51], 0.4f64);
    let wanted = [4.0 / 3.0 * PI * radius.powi(3), 4.0 * PI * radius * radius];
    for (shape, spacing) in [([1.0; 3], [1.0; 3]), ([1.0, 1.0, 0.5], [1.0, 1.0, 2.0])] {
        let mut before: Option<[f64; 2]> = None;
        for n in [16, 32, 64, 128] {
            let extents = shape.map(|share| (share * f64::from(n)) as u32);
            let spacing = spacing.map(|edge: f64| edge / f64::from(n));
            let grid = VoxelGrid::new(extents, [0.0; 3], spacing).unwrap();
            let samples = distances(&grid, centre, radius);
            let mesh = marching_cubes_volume(&volume(&samples, &grid), &alone()).unwrap();
            assert_eq!(euler_of_manifold(&mesh), 2);
            // The second derivative of the distance along a line is at most one over the distance.
            let longest = spacing.into_iter().fold(0.0, f64::max);
            let bound = longest * longest / (8.0 * (radius - longest)) + 1e-6;
            for vertex in mesh.vertices() {
                let apart: f64 = (0..3).map(|k| (vertex[k] - centre[k]).powi(2)).sum::<f64>().sqrt();
                assert!((apart - radius).abs() < bound, "{n} {vertex:?}: {:e}", apart - radius);
            }
            let found = [mesh.volume(), mesh.area()];
            let errors = [0, 1].map(|k| (found[k] - wanted[k]).abs() / wanted[k]);
            println!("{n}: volume {:.2e}, area {:.2e}", errors[0], errors[1]);
            if let Some(before) = before {
                for (now, before) in errors.into_iter().zip(before) {
                    assert!(now < before / 3.0, "{n}: {now:e} after {before:e}");
                }
            }
            before = Some(errors);
        }
    }
}

/// Octrees of a volume: vertices as in the volume itself, and halfway where the octree was cut.
#[test]
fn octrees_with_their_volumes() {
    let grid = VoxelGrid::new([40, 37, 33], [-2.5, 1.0, 0.25], [0.125; 3]).unwrap();
    let (centre, radius) = ([0.0, 3.3, 2.3], 1.7f64);
    let samples = distances(&grid, centre, radius);
    let volume = volume(&samples, &grid);
    let frame = grid.frame().unwrap();
    let tree = build(&volume, &frame, Rule::Sampled, &alone()).unwrap();
    let own = marching_cubes_volume(&volume, &alone()).unwrap();
    let same = |a: &TriangleMesh, b: &TriangleMesh| {
        assert_eq!((a.vertices(), a.triangles()), (b.vertices(), b.triangles()));
    };
    same(&marching_cubes_with_volume(tree.view(), &volume, None, &alone()).unwrap(), &own);
    for threads in [2, 3] {
        same(&marching_cubes_volume(&volume, &Control::threads(threads)).unwrap(), &own);
    }
    // On another frame of the same lattice, which begins elsewhere.
    let wider = Frame::new([-2.5 - 16.0 * 0.125, 1.0 - 8.0 * 0.125, 0.25], 16.0, 7).unwrap();
    let shifted = build(&volume, &wider, Rule::Certified, &alone()).unwrap();
    let mesh = marching_cubes_with_volume(shifted.view(), &volume, None, &alone()).unwrap();
    assert_eq!(mesh.vertices().len(), own.vertices().len());
    assert!((mesh.volume() - own.volume()).abs() < 1e-9 && (mesh.area() - own.area()).abs() < 1e-9);
    // The same topology as with midpoints, and nearer to the ball.
    let half_way = marching_cubes(tree.view(), None, &alone()).unwrap();
    assert_eq!(half_way.triangles(), own.triangles());
    // Cut by a block whose faces lie halfway between samples.
    let block = Csg::cuboid([-9.0, -9.0, -9.0], [0.0, 9.0, 9.0]).unwrap();
    let block = build(&block, &frame, Rule::Sampled, &alone()).unwrap();
    let cut = difference(tree.view(), block.view(), &alone()).unwrap();
    let mesh = marching_cubes_with_volume(cut.view(), &volume, None, &alone()).unwrap();
    assert_eq!(euler_of_manifold(&mesh), 2);
    assert!((mesh.volume() / (2.0 / 3.0 * PI * radius.powi(3)) - 1.0).abs() < 0.01, "{}", mesh.volume());
    assert_eq!(mesh.bounds().0[0], 0.0);
    let on_ball = |v: &&[f64; 3]| {
        let square: f64 = (0..3).map(|k| (v[k] - centre[k]).powi(2)).sum();
        (square.sqrt() - radius).abs() < 3e-3
    };
    let flat = mesh.vertices().iter().filter(|v| v[0] == 0.0).count();
    let round = mesh.vertices().iter().filter(on_ball).count();
    assert!(flat > 400 && round > 800 && flat + round >= mesh.vertices().len(), "{flat} {round}");
    // The caller chooses how PARTIAL cells count.
    let certified: Octree =
        build(&Csg::ball(centre, radius).unwrap(), &frame, Rule::Certified, &alone()).unwrap();
    assert!(marching_cubes_with_volume(certified.view(), &volume, None, &alone()).is_err());
    let inner =
        marching_cubes_with_volume(certified.view(), &volume, Some(Resolve::Inner), &alone()).unwrap();
    assert_balanced(&inner);
    let source = leafless::AnySolid::new(Csg::ball(centre, radius).unwrap());
    let source = Some(Resolve::Source(&source));
    let of_source = marching_cubes_with_volume(certified.view(), &volume, source, &alone()).unwrap();
    assert!((of_source.volume() / own.volume() - 1.0).abs() < 1e-3);
}

/// Few different values, so that samples lie on the surface; all kinds of samples, up to the border.
#[test]
fn samples_on_the_surface() {
    let mut random = Random(5);
    for round in 0..200 {
        let extents = [0; 3].map(|_| 1 + random.below(7) as u32);
        let grid = VoxelGrid::new(extents, [-1.0, 0.5, 100.0], [0.5, 1.0, 0.25]).unwrap();
        let count = grid.count() as usize;
        let mut values: Vec<f32> = (0..count).map(|_| random.below(5) as f32).collect();
        if round % 5 == 0 {
            values.iter_mut().for_each(|value| match random.below(9) {
                0 => *value = f32::NAN,
                1 => *value = f32::INFINITY,
                2 => *value = f32::NEG_INFINITY,
                _ => {}
            });
        }
        let bytes: Vec<u8> = values.iter().map(|&value| value as u8).collect();
        let samples: [Samples<'_>; 2] = [values[..].into(), bytes[..].into()];
        for samples in samples {
            for band in [Band::at_least(2.0), Band::at_least(1.5), Band::between(1.0, 3.0)] {
                let volume = Volume::new(samples.clone(), &grid, band.unwrap(), &alone()).unwrap();
                let mesh = marching_cubes_volume(&volume, &alone()).unwrap();
                assert_balanced(&mesh);
                if mesh.triangles().is_empty() {
                    continue;
                }
                let bounds = grid.bounds();
                let (low, high) = mesh.bounds();
                assert!((0..3).all(|k| bounds.min[k] <= low[k] && high[k] <= bounds.max[k]));
            }
        }
    }
}

#[test]
fn what_is_refused() {
    let samples = [1.0f32; 8];
    let far = VoxelGrid::new([2; 3], [1e15, 0.0, 0.0], [0.25; 3]).unwrap();
    let found = marching_cubes_volume(&volume(&samples, &far), &alone());
    assert!(matches!(found, Err(Error::Argument { name: "grid", .. })));
    let grid = VoxelGrid::new([2; 3], [0.0; 3], [0.25; 3]).unwrap();
    let volume = volume(&samples, &grid);
    let flag = AtomicBool::new(true);
    let control = Control { cancel: Some(&flag), ..alone() };
    assert!(matches!(marching_cubes_volume(&volume, &control), Err(Error::Cancelled)));
    // Cells that are not voxels.
    for (origin, edge, depth) in [(0.0, 1.0, 1), (0.0, 1.0, 3), (0.1, 1.0, 2)] {
        let frame = Frame::new([origin; 3], edge, depth).unwrap();
        let tree = build(&volume, &frame, Rule::Sampled, &alone()).unwrap();
        let found = marching_cubes_with_volume(tree.view(), &volume, None, &alone());
        assert!(matches!(found, Err(Error::Argument { name: "volume", .. })), "{frame:?}");
    }
    // An empty inside.
    let none = volume.with_band(Band::at_least(2.0).unwrap(), &alone()).unwrap();
    assert!(marching_cubes_volume(&none, &alone()).unwrap().triangles().is_empty());
}
