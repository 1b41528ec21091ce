//! Solids that contain meshes, against the same solids without meshes: their visibility, lighting and
//! cut-open views.

use leafless::render::{
    Camera, Clip, Finish, Layer, Lens, MeshLayer, Outline, Picture, Shot, SolidLayer, render,
};
use leafless::{Affine, AnySolid, Control, Csg, FillRule, Frame, MeshSolid, TriangleMesh};
use leafless_testkit::alone;

const SIZE: [u32; 2] = [160, 120];
const LOW: [f64; 3] = [-0.7, -0.55, -0.45];
const HIGH: [f64; 3] = [0.65, 0.6, 0.5];

fn frame() -> Frame {
    Frame::new([-1.0; 3], 2.0, 9).unwrap()
}

/// The triangles of a box, outward or with reversed orientation.
fn box_mesh([low, high]: [[f64; 3]; 2], is_turned: bool) -> TriangleMesh {
    let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { low[axis] } else { high[axis] });
    let mut triangles = Vec::new();
    for axis in 0..3 {
        let [u, v] = [1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3)];
        for (base, is_high) in [(0, false), (1 << axis, true)] {
            let [a, b, c, d] = [base, base + u, base + u + v, base + v];
            for [a, b, c] in [[a, b, c], [a, c, d]] {
                triangles.push(if is_high != is_turned { [a, b, c] } else { [a, c, b] });
            }
        }
    }
    TriangleMesh::new((0..8).map(corner).collect(), triangles).unwrap()
}

fn solid(mesh: TriangleMesh) -> MeshSolid {
    MeshSolid::new(mesh, FillRule::NonZero).unwrap()
}

/// Returns a mesh as a scene contains it.
fn csg(mesh: TriangleMesh) -> Csg {
    Csg::solid(AnySolid::new(solid(mesh)))
}

fn turned() -> Affine {
    Affine::new([[0.8, -0.6, 0.0, 0.05], [0.6, 0.8, 0.0, -0.02], [0.0, 0.0, 1.0, 0.03]]).unwrap()
}

fn shots(clip: &Clip) -> Vec<Shot> {
    let mut shots = Vec::new();
    for (eye, up) in [([2.0, -3.0, 1.2], [0.0, 0.0, 1.0]), ([-0.6, 0.5, 3.5], [0.0, 1.0, 0.2])] {
        for lens in [Lens::Perspective(35.0), Lens::Parallel(2.2)] {
            let camera = Camera::new(eye, [0.0; 3], up, lens).unwrap();
            shots.push(Shot { samples: 1, clip: clip.clone(), ..Shot::new(camera, SIZE) });
        }
    }
    shots
}

fn taken(shot: &Shot, layer: &dyn Layer) -> Picture {
    render(shot, &[layer], &alone()).unwrap()
}

fn finish() -> Finish {
    Finish { cut: [255, 0, 0, 255], ..Finish::default() }
}

/// Returns the number of pixels that differ, and the number of pixels that show something.
fn differing(a: &Picture, b: &Picture) -> [usize; 2] {
    let differs = |&i: &usize| {
        let ([a_at, b_at], [p, q]) = ([a.depths()[i], b.depths()[i]], [a.colours()[i], b.colours()[i]]);
        let is_deeper = a_at.is_finite() != b_at.is_finite() || (a_at - b_at).abs() > 1e-3;
        is_deeper || p.iter().zip(q).any(|(p, q)| p.abs_diff(q) > 3)
    };
    let seen = a.depths().iter().filter(|depth| depth.is_finite()).count();
    [(0..a.depths().len()).filter(differs).count(), seen]
}

/// Checks that two pictures agree but for edges. Slabs show edges only to a pixel, because the cells there
/// are as large.
fn assert_alike(a: &Picture, b: &Picture, what: &str) {
    let [differ, seen] = differing(a, b);
    assert!(seen > 300 && differ * 25 <= seen, "{what}: {differ} of {seen}");
}

/// Returns the depth at which a pixel's line of sight meets the box; infinite if it misses the box.
fn depth_of_box(shot: &Shot, i: usize) -> f64 {
    let place = [i as u32 % SIZE[0], i as u32 / SIZE[0]].map(|pixel| f64::from(pixel) + 0.5);
    let (from, along) = shot.line_of_sight(place);
    let (mut enters, mut leaves) = (0.0f64, f64::INFINITY);
    for axis in 0..3 {
        let [a, b] = [LOW, HIGH].map(|planes| (planes[axis] - from[axis]) / along[axis]);
        (enters, leaves) = (enters.max(a.min(b)), leaves.min(a.max(b)));
    }
    if enters < leaves { enters } else { f64::INFINITY }
}

fn assert_shows_box(shot: &Shot, picture: &Picture) {
    let is_off = |(i, depth): &(usize, &f32)| {
        let expected = depth_of_box(shot, *i);
        expected.is_finite() != depth.is_finite() || (expected - f64::from(**depth)).abs() > 1e-5
    };
    assert_eq!(picture.depths().iter().enumerate().filter(is_off).count(), 0);
}

#[test]
fn a_mesh_looks_the_same_as_a_solid_in_an_expression_and_by_its_triangles() {
    for placement in [Affine::IDENTITY, turned()] {
        let by_rays = solid(box_mesh([LOW, HIGH], false)).placed(&placement).unwrap();
        let scene = csg(box_mesh([LOW, HIGH], false)).placed(&placement).unwrap();
        let block = Csg::cuboid(LOW, HIGH).unwrap().placed(&placement).unwrap();
        for (i, shot) in shots(&Clip::new()).iter().enumerate() {
            let layer = MeshLayer::new(by_rays.mesh()).colour(Finish::default().colour).crease(0.0);
            let drawn = taken(shot, &layer);
            let rays = taken(shot, &SolidLayer::new(&by_rays, &frame(), finish()));
            assert_eq!(differing(&drawn, &rays)[0], 0);
            if placement.is_identity() {
                assert_shows_box(shot, &drawn);
            }
            assert_alike(&drawn, &taken(shot, &SolidLayer::new(&block, &frame(), finish())), "block");
            let scene = SolidLayer::new(&scene, &frame(), finish());
            assert_eq!(differing(&drawn, &taken(shot, &scene))[0], 0, "{i}");
            assert_eq!(taken(shot, &scene), render(shot, &[&scene], &Control::threads(3)).unwrap());
        }
    }
}

/// An inside-out body is solid. Its triangles are seen from behind.
#[test]
fn what_is_inside_out_is_drawn_as_the_solid() {
    let block = Csg::cuboid(LOW, HIGH).unwrap();
    let scene = csg(box_mesh([LOW, HIGH], true));
    let taken_away = MeshSolid::new(box_mesh([LOW, HIGH], true), FillRule::Positive).unwrap();
    let nothing = Csg::solid(AnySolid::new(taken_away));
    for shot in shots(&Clip::new()) {
        let by_slabs = taken(&shot, &SolidLayer::new(&block, &frame(), finish()));
        let by_rays = taken(&shot, &SolidLayer::new(&scene, &frame(), finish()));
        assert_alike(&by_slabs, &by_rays, "inside out");
        assert_shows_box(&shot, &by_rays);
        let empty = taken(&shot, &SolidLayer::new(&nothing, &frame(), finish()));
        assert!(empty.depths().iter().all(|depth| *depth == f32::INFINITY));
        assert!(empty.with_depths(vec![1.0]).is_err());
    }
}

#[test]
fn expressions_with_meshes_look_as_those_with_blocks() {
    let bore = Csg::cylinder(0.3, -2.0, 2.0).unwrap();
    let ball = Csg::ball([0.3, -0.3, 0.2], 0.6).unwrap();
    let other = [[-0.9, -0.2, -0.2], [0.9, 0.2, 0.8]];
    let expressions = |block: Csg, bar: Csg| {
        [
            block.difference(&bore).unwrap(),
            Csg::union_of([block.clone(), ball.clone()]).unwrap(),
            Csg::intersection_of([block.clone(), ball.clone()]).unwrap(),
            ball.difference(&block).unwrap(),
            Csg::union_of([block.clone(), bar.clone()]).unwrap(),
            block.difference(&bar).unwrap(),
        ]
    };
    let meshes = expressions(csg(box_mesh([LOW, HIGH], false)), csg(box_mesh(other, false)));
    let blocks = expressions(Csg::cuboid(LOW, HIGH).unwrap(), Csg::cuboid(other[0], other[1]).unwrap());
    // Whole and cut open.
    for clip in [Clip::new(), Clip::new().plane([0.3, 2.0, 0.1, 0.2]).unwrap()] {
        for (i, (mesh, block)) in meshes.iter().zip(&blocks).enumerate() {
            for placement in [Affine::IDENTITY, turned()] {
                let [mesh, block] = [mesh, block].map(|solid| solid.placed(&placement).unwrap());
                for shot in shots(&clip) {
                    let by_slabs = taken(&shot, &SolidLayer::new(&block, &frame(), finish()));
                    let layer = SolidLayer::new(&mesh, &frame(), finish());
                    let picture = taken(&shot, &layer);
                    assert_alike(&by_slabs, &picture, &format!("{i}, cut: {}", !clip.is_empty()));
                    assert_eq!(picture, render(&shot, &[&layer], &Control::threads(3)).unwrap());
                }
            }
        }
    }
}

#[test]
fn meshes_that_are_cut_open_are_solid() {
    let clip = Clip::new().plane([0.0, 2.0, 0.0, 0.4]).unwrap();
    let camera = Camera::new([0.0, -4.0, 0.5], [0.0; 3], [0.0, 0.0, 1.0], Lens::Perspective(35.0)).unwrap();
    let shot = Shot { samples: 1, clip, ..Shot::new(camera, SIZE) };
    let scene = csg(box_mesh([LOW, HIGH], false));
    let bored = scene.difference(&Csg::cylinder(0.2, -2.0, 2.0).unwrap()).unwrap();
    for (solid, bore) in [(&scene, 0.0), (&bored, 0.2)] {
        let picture = taken(&shot, &SolidLayer::new(solid, &frame(), finish()));
        let mut cut = 0;
        for (i, (colour, depth)) in picture.colours().iter().zip(picture.depths()).enumerate() {
            let place = [i as u32 % SIZE[0], i as u32 / SIZE[0]].map(|pixel| f64::from(pixel) + 0.5);
            let (from, along) = shot.line_of_sight(place);
            let t = (-0.2 - from[1]) / along[1];
            let [x, z] = [0, 2].map(|axis| from[axis] + t * along[axis]);
            // (The bore ends in the plane, but for where it touches it.)
            let is_in = |low: f64, x: f64, high: f64| low + 0.01 < x && x < high - 0.01;
            if is_in(LOW[0], x, HIGH[0]) && is_in(LOW[2], z, HIGH[2]) && x.abs() > 0.3 * bore {
                assert!((f64::from(*depth) - t).abs() < 1e-5 && colour[0] > 90 && colour[1] == 0, "{x} {z}");
                cut += 1;
            }
        }
        assert!(cut > 1000);
    }
}

/// Rays draw edges and translucent surfaces.
#[test]
fn edges_of_meshes_are_those_of_blocks() {
    let (block, scene) = (Csg::cuboid(LOW, HIGH).unwrap(), csg(box_mesh([LOW, HIGH], false)));
    for finish in [
        Finish { edges: Some(Outline::default()), ..finish() },
        Finish { colour: [200, 100, 50, 128], ..finish() },
    ] {
        for shot in shots(&Clip::new()) {
            let [a, b] =
                [&scene, &block].map(|solid| taken(&shot, &SolidLayer::new(solid, &frame(), finish)));
            let [differ, _] = differing(&a, &b);
            assert!(differ < 200, "{differ}");
        }
    }
}
