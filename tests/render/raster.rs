//! Meshes, lines, slices and legends in pictures, against a ray caster over all triangles and against
//! formulas.

use leafless::attribute::FunctionAttribute;
use leafless::octree::{CellFilter, TaggedCell};
use leafless::render::{
    Camera, Clip, Layer, LegendSide, Lens, LinesLayer, MeshEdges, MeshLayer, Picture, Shot, SliceLayer,
    SlicePlane, draw_colour_bar, draw_names, render,
};
use leafless::{Bounds, Cell, Control, Csg, Error, Frame, Rule, Tag, TriangleMesh, build};
use leafless_testkit::Random;

type V = [f64; 3];

fn add(a: V, b: V, by: f64) -> V {
    [0, 1, 2].map(|k| a[k] + by * b[k])
}

fn dot(a: V, b: V) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

fn cross(a: V, b: V) -> V {
    [0, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

fn any_point(random: &mut Random, reach: f64) -> V {
    [0; 3].map(|_: i32| random.between(-reach, reach))
}

/// Returns the origin and direction of the line of sight through a place of the picture, by the camera's
/// definition.
fn line(camera: &Camera, [width, height]: [u32; 2], x: f64, y: f64) -> (V, V) {
    let (across, down) = (x - 0.5 * f64::from(width), y - 0.5 * f64::from(height));
    let shift =
        |from: V, pixel: f64| add(add(from, camera.right(), across * pixel), camera.up(), -down * pixel);
    match camera.lens() {
        Lens::Perspective(degrees) => {
            let pixel = 2.0 * (0.5 * degrees.to_radians()).tan() / f64::from(height);
            (camera.eye(), shift(camera.forward(), pixel))
        }
        Lens::Parallel(side) => (shift(camera.eye(), side / f64::from(height)), camera.forward()),
    }
}

/// Returns the time at which a line meets a triangle's plane, and the least barycentric coordinate there.
fn meet((from, along): (V, V), [a, b, c]: [V; 3]) -> Option<(f64, f64)> {
    let (u, v) = (add(b, a, -1.0), add(c, a, -1.0));
    let normal = cross(u, v);
    let rise = dot(normal, along);
    let t = dot(normal, add(a, from, -1.0)) / rise;
    let p = add(add(from, along, t), a, -1.0);
    let (s, r) =
        (dot(cross(p, v), normal) / dot(normal, normal), dot(cross(u, p), normal) / dot(normal, normal));
    t.is_finite().then_some((t, s.min(r).min(1.0 - s - r)))
}

fn shot(camera: Camera, size: [u32; 2]) -> Shot {
    Shot { samples: 1, background: [0; 4], ..Shot::new(camera, size) }
}

fn take(shot: &Shot, layers: &[&dyn Layer]) -> Picture {
    render(shot, layers, &Control::threads(1)).unwrap()
}

fn triangles(mesh: &TriangleMesh) -> Vec<[V; 3]> {
    mesh.triangles().iter().map(|t| t.map(|v| mesh.vertices()[v as usize])).collect()
}

/// Compares depths with those of all triangles. Returns the number of pixels that show a triangle, and the
/// number too near an edge.
fn check_depths(mesh: &TriangleMesh, shot: &Shot) -> [usize; 2] {
    let picture = take(shot, &[&MeshLayer::new(mesh)]);
    let triangles = triangles(mesh);
    let mut counts = [0; 2];
    for (i, (&depth, colour)) in picture.depths().iter().zip(picture.colours()).enumerate() {
        let (column, row) = (i as u32 % shot.size[0], i as u32 / shot.size[0]);
        let line = line(&shot.camera, shot.size, f64::from(column) + 0.5, f64::from(row) + 0.5);
        let met = triangles.iter().filter_map(|&triangle| meet(line, triangle)).filter(|met| met.0 > 0.0);
        let (mut nearest, mut doubtful) = (f64::INFINITY, f64::INFINITY);
        for (t, inside) in met {
            if inside > 1e-7 {
                nearest = nearest.min(t);
            } else if inside > -1e-7 {
                doubtful = doubtful.min(t);
            }
        }
        if doubtful <= nearest {
            counts[1] += usize::from(doubtful < f64::INFINITY);
            continue;
        }
        assert_eq!(depth < f32::INFINITY, nearest < f64::INFINITY, "{column} {row}: {depth} {nearest}");
        assert_eq!(colour[3], if nearest < f64::INFINITY { 255 } else { 0 });
        if nearest < f64::INFINITY {
            assert!((f64::from(depth) - nearest).abs() < 1e-5 * nearest, "{column} {row}: {depth} {nearest}");
            counts[0] += 1;
        }
    }
    counts
}

/// A ball of radius 0.8: an octahedron with faces cut into n × n triangles, projected onto the ball.
fn ball(n: i32) -> TriangleMesh {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for octant in 0..8 {
        let sign = |k: i32| if octant >> k & 1 == 0 { 1.0 } else { -1.0 };
        let mut corner = |i: i32, j: i32| {
            let p = [sign(0) * f64::from(i), sign(1) * f64::from(j), sign(2) * f64::from(n - i - j)];
            let scale = 0.8 / dot(p, p).sqrt();
            vertices.push(p.map(|x| x * scale));
            vertices.len() as u32 - 1
        };
        let is_turned = sign(0) * sign(1) * sign(2) < 0.0;
        let mut push = |[a, b, c]: [u32; 3]| triangles.push(if is_turned { [a, c, b] } else { [a, b, c] });
        for i in 0..n {
            for j in 0..n - i {
                push([corner(i, j), corner(i + 1, j), corner(i, j + 1)]);
                if i + j + 1 < n {
                    push([corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]);
                }
            }
        }
    }
    TriangleMesh::new(vertices, triangles).unwrap()
}

fn cameras(random: &mut Random, reach: f64) -> Vec<Camera> {
    let mut cameras = Vec::new();
    for lens in [Lens::Perspective(35.0), Lens::Perspective(110.0), Lens::Parallel(1.5)] {
        let (eye, at, up) = (any_point(random, reach), any_point(random, 0.3), any_point(random, 1.0));
        cameras.push(Camera::new(eye, at, up, lens).unwrap());
    }
    cameras
}

#[test]
fn depths_of_random_triangles() {
    let mut random = Random(3);
    let mut seen = [0; 2];
    for round in 0..24 {
        let count = [1, 4, 30, 200][round % 4];
        let size = [2.0, 1.0, 0.5, 0.05][round / 4 % 4];
        let vertices: Vec<V> = (0..count)
            .flat_map(|_| {
                let centre = any_point(&mut random, 1.0);
                [0; 3].map(|_: i32| add(centre, any_point(&mut random, size), 1.0))
            })
            .collect();
        let triangles = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let mesh = TriangleMesh::new(vertices, triangles).unwrap();
        // From outside, and from among them.
        for reach in [4.0, 0.7] {
            for camera in cameras(&mut random, reach) {
                let counts = check_depths(&mesh, &shot(camera, [71, 45]));
                seen = [seen[0] + counts[0], seen[1] + counts[1]];
            }
        }
    }
    assert!(seen[0] > 50_000 && seen[1] < 200, "{seen:?}");
}

/// Triangles that cover more tiles than are listed one by one.
#[test]
fn depths_of_large_triangles() {
    let mut random = Random(41);
    for _ in 0..4 {
        let vertices: Vec<V> = (0..9).map(|_| any_point(&mut random, 3.0)).collect();
        let mesh = TriangleMesh::new(vertices, vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]]).unwrap();
        for camera in cameras(&mut random, 2.0) {
            check_depths(&mesh, &shot(camera, [500, 410]));
        }
    }
}

#[test]
fn depths_of_closed_meshes() {
    let mesh = ball(6);
    let (mut random, mut seen) = (Random(5), [0; 2]);
    for reach in [4.0, 0.4] {
        for camera in cameras(&mut random, reach) {
            let counts = check_depths(&mesh, &shot(camera, [60, 40]));
            seen = [seen[0] + counts[0], seen[1] + counts[1]];
        }
    }
    assert!(seen[0] > 5000 && seen[1] < 60, "{seen:?}");
}

/// Returns the number of surfaces of opacity 64 / 255 that a pixel shows.
fn layers([.., opacity]: [u8; 4]) -> u32 {
    let left = 1.0 - f64::from(opacity) / 255.0;
    (left.ln() / (1.0 - 64.0 / 255.0_f64).ln()).round() as u32
}

const GLASS: [u8; 4] = [80, 120, 200, 64];

/// A line of sight enters a convex body once and leaves it once, however small its triangles are and wherever
/// its vertices lie.
#[test]
fn closed_meshes_have_no_cracks() {
    // Triangles far smaller than a pixel.
    let fine = ball(150);
    fine.check_closed(leafless::FillRule::NonZero).unwrap();
    for lens in [Lens::Perspective(40.0), Lens::Parallel(2.0)] {
        let camera = Camera::new([0.3, -3.0, 1.0], [0.0; 3], [0.0, 0.0, 1.0], lens).unwrap();
        let shot = shot(camera, [64, 64]);
        let picture = take(&shot, &[&MeshLayer::new(&fine).colour(GLASS)]);
        let counts: Vec<u32> = picture.colours().iter().map(|&colour| layers(colour)).collect();
        assert!(counts.iter().filter(|&&count| count == 2).count() > 900);
        for (i, count) in counts.iter().enumerate() {
            let (x, y) = ((i % 64) as f64 - 31.5, (i / 64) as f64 - 31.5);
            assert!(
                [0, 2].contains(count) || x.hypot(y) > 20.0 && [0, 2, 4].contains(count),
                "{x} {y}: {count}"
            );
        }
    }
}

/// The surface of the box [0, n·step]³. Its sides are cut into n × n squares along alternating diagonals.
fn grid_box(n: u32, step: f64) -> TriangleMesh {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    let mut random = Random(9);
    for axis in 0..3 {
        for side in [0, n] {
            for i in 0..n {
                for j in 0..n {
                    let corner = |di: u32, dj: u32| {
                        let mut at = [side; 3];
                        (at[(axis + 1) % 3], at[(axis + 2) % 3]) = (i + di, j + dj);
                        at.map(|x| f64::from(x) * step)
                    };
                    let base = vertices.len() as u32;
                    vertices.extend([corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]);
                    let square =
                        if random.unit() < 0.5 { [[0, 1, 2], [0, 2, 3]] } else { [[1, 2, 3], [1, 3, 0]] };
                    let turned = |[a, b, c]: [u32; 3]| if side == 0 { [a, c, b] } else { [a, b, c] };
                    triangles.extend(square.map(|t| turned(t).map(|v| base + v)));
                }
            }
        }
    }
    TriangleMesh::new(vertices, triangles).unwrap()
}

/// Vertices and edges lie on the samples themselves, some exactly and some by rounding.
#[test]
fn edges_through_samples_are_counted_once() {
    for step in [0.125, 0.1, 1.0 / 3.0] {
        let mesh = grid_box(8, step);
        mesh.check_closed(leafless::FillRule::NonZero).unwrap();
        let side = 8.0 * step;
        for per_pixel in [1.0, 0.5, 0.25] {
            for axis in 0..3 {
                // The middle of the picture is the middle of a pixel: a sample lies on each vertex.
                let size = [33, 33];
                let mut eye = [0.5 * side; 3];
                eye[axis] = -2.0;
                let at = [0.5 * side; 3];
                let mut up = [0.0; 3];
                up[(axis + 1) % 3] = 1.0;
                let height = f64::from(size[1]) * step * per_pixel;
                let camera = Camera::new(eye, at, up, Lens::Parallel(height)).unwrap();
                let picture = take(&shot(camera, size), &[&MeshLayer::new(&mesh).colour(GLASS)]);
                let inside = (4.0 / per_pixel) as i32;
                for (i, &colour) in picture.colours().iter().enumerate() {
                    let (x, y) = (i as i32 % 33 - 16, i as i32 / 33 - 16);
                    let far = x.abs().max(y.abs());
                    // Samples on the outline belong to both sides or to neither.
                    let expected: &[u32] = match far.cmp(&inside) {
                        std::cmp::Ordering::Less => &[2],
                        std::cmp::Ordering::Equal => &[0, 2],
                        std::cmp::Ordering::Greater => &[0],
                    };
                    assert!(
                        expected.contains(&layers(colour)),
                        "{step} {per_pixel} {axis}: {x} {y} {colour:?}"
                    );
                }
            }
        }
        // From a corner along the diagonal, and near by in perspective: edges and vertices hide each other.
        for lens in [Lens::Parallel(2.0 * side), Lens::Perspective(40.0)] {
            let camera = Camera::new([3.0 * side; 3], [0.5 * side; 3], [0.0, 0.0, 1.0], lens).unwrap();
            let picture = take(&shot(camera, [65, 65]), &[&MeshLayer::new(&mesh).colour(GLASS)]);
            assert!(picture.colours().iter().all(|&colour| [0, 2].contains(&layers(colour))));
            assert!(picture.colours().iter().filter(|&&colour| layers(colour) == 2).count() > 600);
        }
    }
}

/// A sheet of glass looks the same all over, however it is cut into triangles.
#[test]
fn coplanar_triangles_show_no_seams() {
    let mut random = Random(17);
    let n = 40;
    // A fan around an inner point with a rim in one plane.
    let place = |u: f64, v: f64| [u, 0.3 * u + 0.2 * v, v];
    let mut vertices = vec![place(0.013, -0.02)];
    vertices.extend((0..n).map(|i| {
        let (sin, cos) = ((f64::from(i) + random.unit()) / f64::from(n) * std::f64::consts::TAU).sin_cos();
        place(cos, sin)
    }));
    let triangles = (0..n).map(|i| [0, 1 + i as u32, 1 + (i as u32 + 1) % n as u32]).collect();
    let mesh = TriangleMesh::new(vertices, triangles).unwrap();
    for lens in [Lens::Perspective(30.0), Lens::Parallel(1.2)] {
        let camera = Camera::new([0.1, -4.0, 0.2], [0.0; 3], [0.0, 0.0, 1.0], lens).unwrap();
        let picture =
            take(&Shot { samples: 16, ..shot(camera, [60, 60]) }, &[&MeshLayer::new(&mesh).colour(GLASS)]);
        let middle = picture.colours()[30 * 60 + 30];
        assert_eq!(middle[3], 64);
        for y in 20..40 {
            for x in 20..40 {
                assert_eq!(picture.colours()[y * 60 + x], middle);
            }
        }
    }
}

fn square(y: f64, half: f64) -> TriangleMesh {
    let corner = |x: f64, z: f64| [x * half, y, z * half];
    let vertices = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    TriangleMesh::new(vertices, vec![[0, 1, 2], [0, 2, 3]]).unwrap()
}

fn front(height: f64) -> Camera {
    Camera::new([0.0, -5.0, 0.0], [0.0; 3], [0.0, 0.0, 1.0], Lens::Parallel(height)).unwrap()
}

fn linear(byte: u8) -> f64 {
    let x = f64::from(byte) / 255.0;
    if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

fn encoded(x: f64) -> f64 {
    255.0 * if x <= 0.0031308 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

#[test]
fn what_is_translucent_is_seen_in_order() {
    let sheets = [square(0.0, 1.0), square(1.0, 1.0), square(2.0, 1.0)];
    let colours = [[255, 0, 0, 100], [0, 255, 0, 150], [0, 0, 255, 255]];
    let alone = |mesh: &TriangleMesh, [r, g, b, _]: [u8; 4]| {
        take(&shot(front(1.0), [8, 8]), &[&MeshLayer::new(mesh).colour([r, g, b, 255])]).colours()[0]
    };
    let mut expected = [0.0; 3];
    for k in [2, 1, 0] {
        let lit = alone(&sheets[k], colours[k]);
        let opacity = f64::from(colours[k][3]) / 255.0;
        expected = [0, 1, 2].map(|c| linear(lit[c]) * opacity + expected[c] * (1.0 - opacity));
    }
    let layer = |k: usize| MeshLayer::new(&sheets[k]).colour(colours[k]);
    for order in [[0, 1, 2], [2, 1, 0], [1, 2, 0]] {
        let layers = order.map(layer);
        let picture = take(&shot(front(1.0), [8, 8]), &[&layers[0], &layers[1], &layers[2]]);
        let colour = picture.colours()[20];
        for c in 0..3 {
            assert!((f64::from(colour[c]) - encoded(expected[c])).abs() < 1.5, "{colour:?} {expected:?}");
        }
        assert_eq!((colour[3], picture.depths()[20]), (255, 7.0));
    }
}

#[test]
fn clip_planes_cut_meshes_and_show_their_inside() {
    let mesh = ball(10);
    let colours = |inside: bool| if inside { [255, 0, 0, 255] } else { [0, 255, 0, 255] };
    let layer = MeshLayer::new(&mesh).colour(colours(false)).inside(colours(true));
    let clip = Clip::new().plane([0.3, 1.0, 0.2, 0.1]).unwrap();
    let shot = Shot { clip, ..shot(front(2.0), [60, 60]) };
    let picture = take(&shot, &[&layer]);
    let kept = |[x, y, z]: V| 0.3 * x + y + 0.2 * z + 0.1;
    let triangles = triangles(&mesh);
    let mut counts = [0; 2];
    for (i, (&depth, colour)) in picture.depths().iter().zip(picture.colours()).enumerate() {
        let line = line(&shot.camera, shot.size, (i % 60) as f64 + 0.5, (i / 60) as f64 + 0.5);
        let met = triangles.iter().filter_map(|&triangle| Some((meet(line, triangle)?, triangle)));
        let mut met: Vec<_> =
            met.filter(|((t, inside), _)| *inside > -1e-7 && kept(add(line.0, line.1, *t)) >= 0.0).collect();
        met.sort_by(|a, b| a.0.0.total_cmp(&b.0.0));
        let Some(&((t, inside), [a, b, c])) = met.first() else {
            assert_eq!(colour[3], 0);
            continue;
        };
        if inside < 1e-7 {
            continue;
        }
        assert!((f64::from(depth) - t).abs() < 1e-5);
        let from_behind = dot(cross(add(b, a, -1.0), add(c, a, -1.0)), line.1) > 0.0;
        assert_eq!([colour[0] > 0, colour[1] > 0], [from_behind, !from_behind]);
        counts[usize::from(from_behind)] += 1;
    }
    assert!(counts[0] > 50 && counts[1] > 500, "{counts:?}");
}

/// A box cut at its own faces keeps them.
#[test]
fn faces_in_clip_planes_are_shown() {
    let mesh = grid_box(2, 0.3);
    let bounds = Bounds::new([0.0; 3], [0.6; 3]).unwrap();
    for from in [[0.0, 0.0], [30.0, 20.0], [210.0, -35.0]] {
        for lens in [None, Some(40.0)] {
            let camera = Camera::fitted(&bounds.corners(), from, lens, 1.0).unwrap();
            let whole = shot(camera, [50, 50]);
            let cut = Shot { clip: Clip::new().within(&bounds).unwrap(), ..whole.clone() };
            let [whole, cut] = [whole, cut].map(|shot| take(&shot, &[&MeshLayer::new(&mesh)]));
            let differ = whole.depths().iter().zip(cut.depths()).filter(|(a, b)| a != b).count();
            // Only a line of sight along an edge may miss the box entirely.
            assert!(differ <= 2, "{from:?} {lens:?}: {differ}");
        }
    }
}

#[test]
fn triangles_have_colours_of_their_own() {
    let mesh = square(0.0, 1.0);
    let colours = [[255, 0, 0, 255], [0, 0, 255, 255]];
    let layer = MeshLayer::new(&mesh).triangle_colours(&colours);
    let picture = take(&shot(front(2.0), [20, 20]), &[&layer]);
    // The first one lies on the lower right.
    assert!(picture.colours()[15 * 20 + 17][0] > 50 && picture.colours()[15 * 20 + 17][2] == 0);
    assert!(picture.colours()[4 * 20 + 2][2] > 50 && picture.colours()[4 * 20 + 2][0] == 0);
    let refused =
        render(&shot(front(2.0), [20, 20]), &[&layer.triangle_colours(&colours[..1])], &Control::default());
    assert!(matches!(refused, Err(Error::Argument { name: "colours", .. })));
}

/// With a crease angle above the dihedral angles, neighbours share one normal at their edge. Without a crease
/// angle each triangle is flat.
#[test]
fn creases_are_kept_and_the_rest_is_smooth() {
    let mesh = ball(6);
    let colours = |degrees: f64| {
        let layer = MeshLayer::new(&mesh).crease(degrees);
        let picture = take(&shot(front(1.0), [64, 64]), &[&layer]);
        picture.colours().iter().map(|colour| f64::from(colour[0])).collect::<Vec<_>>()
    };
    // Steps of the brightness from pixel to pixel.
    let steps = |colours: &[f64]| {
        let row = |y: usize| colours[64 * y..64 * (y + 1)].windows(2).map(|two| (two[1] - two[0]).abs());
        (0..64).flat_map(row).fold(0.0, f64::max)
    };
    let (flat, smooth) = (colours(0.0), colours(60.0));
    assert!(steps(&flat) > 2.0 * steps(&smooth), "{} {}", steps(&flat), steps(&smooth));
    // A box is flat with an angle below 90 degrees.
    let mesh = grid_box(3, 1.0);
    let camera =
        Camera::fitted(&Bounds::new([0.0; 3], [3.0; 3]).unwrap().corners(), [30.0, 30.0], None, 1.0).unwrap();
    let shades = |degrees: f64| {
        let picture = take(&shot(camera, [64, 64]), &[&MeshLayer::new(&mesh).crease(degrees)]);
        let mut shades = picture.colours().to_vec();
        shades.sort();
        shades.dedup();
        shades.len()
    };
    assert_eq!((shades(0.0), shades(30.0)), (4, 4));
    assert!(shades(100.0) > 20);
}

fn is_dark(colour: [u8; 4]) -> bool {
    colour[3] > 0 && colour[..3].iter().all(|&c| c < 60)
}

#[test]
fn edges_of_features_are_drawn() {
    let mesh = grid_box(4, 0.25);
    let dark = |edges: MeshEdges, crease: f64| {
        let layer = MeshLayer::new(&mesh).crease(crease).edges(edges, 1.0, [0, 0, 0, 255]);
        let camera = Camera::new([0.5, -5.0, 0.5], [0.5; 3], [0.0, 0.0, 1.0], Lens::Parallel(2.0)).unwrap();
        let picture = take(&shot(camera, [64, 64]), &[&layer]);
        picture.colours().iter().map(|&colour| is_dark(colour)).collect::<Vec<_>>()
    };
    let (none, features, all) =
        (dark(MeshEdges::None, 30.0), dark(MeshEdges::Features, 30.0), dark(MeshEdges::All, 30.0));
    assert_eq!(none.iter().filter(|&&dark| dark).count(), 0);
    // The outline of a square of 32 × 32 pixels, one pixel wide.
    for (i, &dark) in features.iter().enumerate() {
        let far = ((i % 64) as f64 - 31.5).abs().max(((i / 64) as f64 - 31.5).abs());
        assert!(!dark || (far - 16.0).abs() <= 0.51, "{i}");
    }
    assert!((120..=140).contains(&features.iter().filter(|&&dark| dark).count()));
    let inner = |dark: &[bool]| dark[20 * 64 + 17..20 * 64 + 47].iter().filter(|&&dark| dark).count();
    assert!(inner(&features) == 0 && inner(&all) >= 5);
    // Plane parts have no edges, even if nothing is smooth.
    assert_eq!(dark(MeshEdges::Features, 0.0), features);
    // The rim of an open mesh is one.
    let open = square(0.0, 0.5);
    let layer = MeshLayer::new(&open).edges(MeshEdges::Features, 1.0, [0, 0, 0, 255]);
    let picture = take(&shot(front(2.0), [64, 64]), &[&layer]);
    let column: Vec<usize> = (0..64).filter(|y| is_dark(picture.colours()[y * 64 + 30])).collect();
    assert!(
        column.len() == 2 && [15, 16].contains(&column[0]) && [47, 48].contains(&column[1]),
        "{column:?}"
    );
}

/// A square of right-angled triangles seen from the front, with legs of several pixels. Between the greatest
/// size without edges and the least size with full edges, the edges grow darker.
#[test]
fn edges_of_small_triangles_fade() {
    let picture = |pixels: f64, edges: MeshEdges| {
        let n = (120.0 / pixels) as u32;
        let at = |i: u32| 2.0 * f64::from(i) / f64::from(n) - 1.0;
        let vertices = (0..(n + 1) * (n + 1)).map(|v| [at(v % (n + 1)), 0.0, at(v / (n + 1))]);
        let triangles = (0..n * n).flat_map(|square| {
            let v = square / n * (n + 1) + square % n;
            [[v, v + 1, v + n + 2], [v, v + n + 2, v + n + 1]]
        });
        let mesh = TriangleMesh::new(vertices.collect(), triangles.collect()).unwrap();
        let layer = MeshLayer::new(&mesh).edges(edges, 1.0, [0, 0, 0, 255]);
        take(&Shot { samples: 16, ..shot(front(2.0), [120, 120]) }, &[&layer])
    };
    // The part of the light absorbed by the edges, in the middle of the picture.
    let darker = |pixels: f64| {
        let light = |edges| -> f64 {
            let picture = picture(pixels, edges);
            let is_middle = |i: &usize| (20..100).contains(&(i % 120)) && (20..100).contains(&(i / 120));
            (0..120 * 120).filter(is_middle).map(|i| linear(picture.colours()[i][0])).sum()
        };
        1.0 - light(MeshEdges::All) / light(MeshEdges::None)
    };
    for pixels in [0.5, 1.0, 2.0] {
        assert_eq!(picture(pixels, MeshEdges::All), picture(pixels, MeshEdges::None), "{pixels}");
    }
    // Edges one pixel wide along two sides and the third, where they are whole.
    let whole = |pixels: f64| 1.0 - (1.0 - 1.0 / pixels).powi(2) * (1.0 - 2f64.sqrt() / pixels);
    for pixels in [8.0, 12.0, 20.0, 40.0] {
        let (found, whole) = (darker(pixels), whole(pixels));
        assert!((found - whole).abs() < 0.06, "{pixels}: {found} {whole}");
    }
    // Between, their opacity grows with the height of the triangles.
    for pixels in [3.0, 4.0, 5.0, 6.0] {
        let opacity = (pixels / 2f64.sqrt() - 1.5) / 4.0;
        let (found, expected) = (darker(pixels), opacity * whole(pixels));
        assert!((found - expected).abs() < 0.06, "{pixels}: {found} {expected}");
    }
    // Where a large triangle ends at small triangles, its edge is visible.
    let mut mesh = vec![[0.0, 0.0, -0.9], [0.0, 0.0, 0.9], [-0.9, 0.0, 0.0]];
    let mut triangles = vec![[0, 1, 2]];
    for i in 0..90u32 {
        mesh.push([0.01, 0.0, -0.9 + 0.02 * f64::from(i)]);
        triangles.push([0, 1, 3 + i]);
    }
    let mesh = TriangleMesh::new(mesh, triangles).unwrap();
    let layer = MeshLayer::new(&mesh).edges(MeshEdges::All, 1.0, [0, 0, 0, 255]);
    let picture = take(&shot(front(2.0), [100, 100]), &[&layer]);
    assert!((10..90).all(|y| (48..52).any(|x| is_dark(picture.colours()[y * 100 + x]))));
}

/// A line covers its width in pixels, wherever it lies. The covered samples are those within half the width.
#[test]
fn lines_cover_what_they_should() {
    let mut random = Random(23);
    for round in 0..60 {
        let ends = [any_point(&mut random, 1.0), any_point(&mut random, 1.0)];
        let width = [1.0, 3.0, 10.5][round % 3];
        let lens = if round % 2 == 0 { Lens::Parallel(2.0) } else { Lens::Perspective(30.0) };
        let camera = Camera::new([0.0, -5.0, 0.3], [0.0; 3], [0.1, 0.0, 1.0], lens).unwrap();
        // Some large, with lines through many tiles.
        let scale = if round % 10 == 9 { 9.0 } else { 1.0 };
        let (columns, size) = (70 * scale as usize, [70.0 * scale, 50.0 * scale]);
        let shot = shot(camera, size.map(|side| side as u32));
        let lines = [ends];
        let picture = take(&shot, &[&LinesLayer::new(&lines).width(width)]);
        // Its ends in the picture, found by a search for the lines of sight through them.
        let seen = ends.map(|end| {
            let from = add(end, camera.eye(), -1.0);
            let [x, y, z] = [camera.right(), camera.up(), camera.forward()].map(|axis| dot(from, axis));
            let pixel = match lens {
                Lens::Parallel(height) => height / size[1],
                Lens::Perspective(degrees) => 2.0 * (0.5 * degrees.to_radians()).tan() / size[1] * z,
            };
            ([0.5 * size[0] + x / pixel, 0.5 * size[1] - y / pixel], z)
        });
        let [(a, near), (b, far)] = seen;
        let along = [b[0] - a[0], b[1] - a[1]];
        for (i, (&depth, colour)) in picture.depths().iter().zip(picture.colours()).enumerate() {
            let at = [(i % columns) as f64 + 0.5 - a[0], (i / columns) as f64 + 0.5 - a[1]];
            let square = along[0] * along[0] + along[1] * along[1];
            let part = ((at[0] * along[0] + at[1] * along[1]) / square).clamp(0.0, 1.0);
            let distance = (at[0] - along[0] * part).hypot(at[1] - along[1] * part);
            if (distance - 0.5 * width).abs() < 1e-5 {
                continue;
            }
            assert_eq!(colour[3] > 0, distance < 0.5 * width, "{round}: {i} {distance}");
            if colour[3] > 0 {
                let expected = match lens {
                    Lens::Parallel(_) => near + (far - near) * part,
                    Lens::Perspective(_) => 1.0 / ((1.0 - part) / near + part / far),
                };
                // Nearer than in reality, by the line's width and a pixel.
                let pixel = 2.0 / size[1] * if round % 2 == 0 { 1.0 } else { expected * 0.268 };
                let nearer = expected - f64::from(depth);
                assert!(nearer > 0.0 && nearer < 1.01 * (1.0 + width) * pixel, "{expected} {depth}");
            }
        }
    }
}

/// Crossing lines of one layer are no darker at the crossing.
#[test]
fn translucent_lines_are_drawn_once() {
    let lines = [[[-1.0, 0.0, -0.4], [1.0, 0.0, 0.5]], [[-0.9, 0.5, 0.5], [0.8, -0.2, -0.6]]];
    let picture =
        take(&shot(front(2.0), [64, 64]), &[&LinesLayer::new(&lines).width(5.0).colour([9, 9, 9, 100])]);
    assert!(picture.colours().iter().all(|colour| [0, 100].contains(&colour[3])));
    assert!(picture.colours().iter().filter(|colour| colour[3] == 100).count() > 400);
    assert!(picture.depths().iter().all(|&depth| depth == f32::INFINITY));
}

#[test]
fn lines_are_hidden_and_cut() {
    let sheet = square(0.0, 0.5);
    let across = |y: f64, z: f64| [[-1.0, y, z], [1.0, y, z]];
    let dark = |lines: &[[V; 2]], clip: Clip, y: usize, x: usize| {
        let shot = Shot { clip, ..shot(front(2.0), [64, 64]) };
        let layers: [&dyn Layer; 2] = [&LinesLayer::new(lines).width(3.0), &MeshLayer::new(&sheet)];
        let picture = take(&shot, &layers);
        assert_eq!(picture, take(&shot, &[layers[1], layers[0]]));
        is_dark(picture.colours()[y * 64 + x])
    };
    // Before, on, and behind the sheet; beside it all are seen.
    for (y, seen) in [(-1.0, true), (0.0, true), (1.0, false)] {
        assert_eq!(dark(&[across(y, 0.0)], Clip::new(), 32, 32), seen);
        assert!(dark(&[across(y, 0.0)], Clip::new(), 32, 4));
        assert!(!dark(&[across(y, 0.0)], Clip::new(), 40, 4));
    }
    let left = Clip::new().plane([-1.0, 0.0, 0.0, -0.5]).unwrap();
    assert!(dark(&[across(-1.0, 0.0)], left.clone(), 32, 4) && !dark(&[across(-1.0, 0.0)], left, 32, 24));
    // Through the eye's plane: parts behind the eye are not mirrored.
    let camera = Camera::new([0.0; 3], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], Lens::Perspective(60.0)).unwrap();
    let lines = [[[1.0, 4.0, 1.0], [0.9, -3.0, 1.0]]];
    let picture = take(&shot(camera, [64, 64]), &[&LinesLayer::new(&lines)]);
    for (i, &colour) in picture.colours().iter().enumerate() {
        assert!(!is_dark(colour) || i % 64 > 32 && i / 64 < 32);
    }
    assert!(picture.colours().iter().any(|&colour| is_dark(colour)));
}

/// Each part of an edge is drawn once, even if several cells share it.
#[test]
fn edges_of_cells_are_drawn_once() {
    let frame = Frame::new([-1.0; 3], 2.0, 3).unwrap();
    let one = LinesLayer::of_cells(&frame, [Cell::ROOT]).unwrap();
    assert_eq!(one.lines().len(), 12);
    assert!(one.lines().iter().flatten().flatten().all(|x| x.abs() == 1.0));
    // A cell in the corner of a larger one adds 9 of its edges; in its middle it would add all.
    let cells = [Cell { level: 1, at: [0; 3] }, Cell { level: 2, at: [0; 3] }, Cell { level: 2, at: [0; 3] }];
    assert_eq!(LinesLayer::of_cells(&frame, cells).unwrap().lines().len(), 21);
    // All cells of a level are 3 · 9 · 9 lines through the universe.
    let all = (0..512).map(|i: u32| Cell { level: 3, at: [i & 7, i >> 3 & 7, i >> 6] });
    let lines = LinesLayer::of_cells(&frame, all).unwrap();
    assert_eq!(lines.lines().len(), 3 * 81);
    let length = |[a, b]: &[V; 2]| add(*b, *a, -1.0).iter().sum::<f64>();
    assert!(lines.lines().iter().all(|line| length(line) == 2.0));
    let none = [Cell { level: 9, at: [0; 3] }, Cell { level: 2, at: [4, 0, 0] }];
    assert!(LinesLayer::of_cells(&frame, none).unwrap().lines().is_empty());
}

#[test]
fn pictures_are_the_same_for_any_number_of_threads() {
    let mesh = ball(25);
    let frame = Frame::new([-1.0; 3], 2.0, 3).unwrap();
    let cells = LinesLayer::of_cells(&frame, (0..8).map(|k| Cell::ROOT.child(k))).unwrap();
    let layer = MeshLayer::new(&mesh).colour([90, 160, 90, 128]).edges(MeshEdges::All, 1.5, [0, 0, 0, 90]);
    let camera = Camera::new([2.0, -3.0, 1.0], [0.0; 3], [0.0, 0.0, 1.0], Lens::Perspective(40.0)).unwrap();
    let shot =
        Shot { clip: Clip::new().plane([1.0, 0.2, 0.1, 0.4]).unwrap(), ..Shot::new(camera, [150, 100]) };
    let pictures =
        [1, 2, 7].map(|threads| render(&shot, &[&layer, &cells], &Control::threads(threads)).unwrap());
    assert!(pictures[0] == pictures[1] && pictures[0] == pictures[2]);
}

#[test]
fn degenerate_meshes_and_lines() {
    let far = 2.0_f64.powi(255);
    let small = 2.0_f64.powi(-255);
    let vertices = vec![
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.5, 1e-18, 1e-18],
        [far, far, -far],
        [-far, far, far],
        [small, 0.0, small],
        [0.0, -5.0, 0.0],
        [0.3, -5.0, 0.1],
        [-0.3, -5.0, 0.1],
    ];
    let count = vertices.len() as u32;
    let mut triangles = Vec::new();
    for a in 0..count {
        for b in 0..a {
            triangles.extend((0..b).map(|c| [a, b, c]));
        }
    }
    let mesh = TriangleMesh::new(vertices.clone(), triangles).unwrap();
    let empty = TriangleMesh::new(Vec::new(), Vec::new()).unwrap();
    let lines: Vec<[V; 2]> = vertices.iter().flat_map(|&a| vertices.iter().map(move |&b| [a, b])).collect();
    for lens in [Lens::Perspective(50.0), Lens::Parallel(3.0), Lens::Perspective(179.0), Lens::Parallel(1e-9)]
    {
        for eye in [[0.0, -5.0, 0.0], [far / 2.0, 1.0, 1.0]] {
            let camera = Camera::new(eye, [0.0; 3], [0.0, 0.1, 1.0], lens).unwrap();
            for clip in [Clip::new(), Clip::new().plane([0.0, 1.0, 0.0, 0.0]).unwrap()] {
                let shot = Shot { clip, ..shot(camera, [40, 40]) };
                for edges in [MeshEdges::Features, MeshEdges::All] {
                    let layer = MeshLayer::new(&mesh).edges(edges, 2.0, [0, 0, 0, 255]);
                    let none = MeshLayer::new(&empty).edges(edges, 2.0, [0, 0, 0, 255]);
                    let picture = take(&shot, &[&layer, &none, &LinesLayer::new(&lines)]);
                    assert!(picture.depths().iter().all(|depth| *depth >= 0.0));
                }
            }
        }
    }
    let refused =
        |layer: &dyn Layer| render(&shot(front(1.0), [4, 4]), &[layer], &Control::default()).is_err();
    assert!(
        refused(&LinesLayer::new(&lines).width(0.0)) && refused(&LinesLayer::new(&lines).width(f64::NAN))
    );
    assert!(refused(&LinesLayer::new(&[[[f64::NAN; 3], [0.0; 3]]])));
    assert!(refused(&MeshLayer::new(&mesh).crease(-1.0)) && refused(&MeshLayer::new(&mesh).crease(f64::NAN)));
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let control = Control { cancel: Some(&cancel), ..Control::default() };
    let cancelled = render(&shot(front(1.0), [4, 4]), &[&MeshLayer::new(&mesh)], &control);
    assert!(matches!(cancelled, Err(Error::Cancelled)));
}

const TAGS: [[u8; 4]; 3] = [[1, 200, 3, 255], [200, 5, 6, 255], [7, 8, 200, 255]];

fn colour_of(tag: Tag) -> [u8; 4] {
    match tag {
        Tag::Empty => TAGS[0],
        Tag::Full => TAGS[1],
        Tag::Partial | Tag::Branch => TAGS[2],
    }
}

/// A block with a bore. A ball is visible through the bore.
fn part() -> Csg {
    let block = Csg::cuboid([-0.7, -0.6, -0.5], [0.7, 0.6, 0.5]).unwrap();
    let bored = block.difference(&Csg::cylinder(0.35, -1.0, 1.0).unwrap()).unwrap();
    Csg::union_of([bored, Csg::ball([0.1, 0.2, 0.3], 0.3).unwrap()]).unwrap()
}

/// Planes with normals, offsets, and the axis of axis-perpendicular planes.
fn planes() -> Vec<(SlicePlane, V, f64, Option<usize>)> {
    let slanting = ([0.3, -0.8, 0.5], 0.05);
    let mut planes = vec![(SlicePlane::new(slanting.0, -slanting.1).unwrap(), slanting.0, slanting.1, None)];
    for axis in 0..3 {
        // In the middle of the universe, in other planes of the lattice, and in no plane of the lattice.
        for at in [0.0, -0.1875, 0.123] {
            let normal = [0, 1, 2].map(|k| f64::from(u8::from(k == axis)));
            planes.push((SlicePlane::across(axis, at).unwrap(), normal, at, Some(axis)));
        }
    }
    planes
}

/// Returns the point of a plane that a pixel shows.
fn point_of(shot: &Shot, i: usize, (normal, offset, axis): (V, f64, Option<usize>)) -> Option<V> {
    let (column, row) = (i as u32 % shot.size[0], i as u32 / shot.size[0]);
    let (from, along) = line(&shot.camera, shot.size, f64::from(column) + 0.5, f64::from(row) + 0.5);
    let t = (offset - dot(normal, from)) / dot(normal, along);
    let mut point = add(from, along, t);
    if let Some(axis) = axis {
        point[axis] = offset;
    }
    (t.is_finite() && t > 0.0).then_some(point)
}

#[test]
fn slices_show_the_tags_of_points() {
    let control = Control::default();
    let (part, frame) = (part(), Frame::new([-1.0; 3], 2.0, 5).unwrap());
    let tree = build(&part, &frame, Rule::Certified, &control).unwrap();
    let tree = tree.view();
    let mut random = Random(31);
    let mut counts = [0; 4];
    for (plane, normal, offset, axis) in planes() {
        for camera in cameras(&mut random, 2.0) {
            let shot = shot(camera, [53, 41]);
            let layer = SliceLayer::new(tree, plane).colours(TAGS).outlines(None);
            let picture = take(&shot, &[&layer]);
            let solid = SliceLayer::of_solid(&part, &frame, plane).colours(TAGS).outlines(None);
            assert_eq!(take(&shot, &[&solid]), picture);
            for (i, (&colour, &depth)) in picture.colours().iter().zip(picture.depths()).enumerate() {
                let Some(point) = point_of(&shot, i, (normal, offset, axis)) else {
                    assert_eq!(colour[3], 0);
                    continue;
                };
                // Rounding chooses between neighbours.
                let near = |k: usize| {
                    let cells = (point[k] + 1.0) / frame.cell_size();
                    axis != Some(k) && (cells - cells.round()).abs() < 1e-9
                };
                if (0..3).any(near) {
                    continue;
                }
                let at = frame.cell_of(point);
                let expected = at.map_or([0; 4], |at| colour_of(tree.tag_at(at)));
                assert_eq!(colour, expected, "{i} {point:?}");
                counts[at.map_or(3, |at| {
                    TAGS.iter().position(|&tag| tag == colour_of(tree.tag_at(at))).unwrap()
                })] += 1;
                let seen = dot(add(point, camera.eye(), -1.0), camera.forward());
                assert!(at.is_none() || (f64::from(depth) - seen).abs() < 1e-5 * seen);
            }
        }
    }
    assert!(counts.iter().all(|&count| count > 500), "{counts:?}");
}

/// Returns the unsplit cell around a finest one, by a search through all cells.
fn leaf(cells: &[TaggedCell], depth: u8, at: [u32; 3]) -> Cell {
    let around = |cell: Cell| (0..3).all(|k| at[k] >> (depth - cell.level) == cell.at[k]);
    cells.iter().map(|found| found.cell).find(|&cell| around(cell)).unwrap()
}

#[test]
fn outlines_are_a_pixel_wide() {
    let control = Control::default();
    let line = [250, 250, 250, 255];
    for depth in [3, 4] {
        let frame = Frame::new([-1.0; 3], 2.0, depth).unwrap();
        let tree = build(&part(), &frame, Rule::Certified, &control).unwrap();
        let cells: Vec<TaggedCell> = tree.view().cells(CellFilter::leaves()).collect();
        for (plane, normal, offset, axis) in planes().into_iter().filter(|plane| plane.3.is_some()) {
            let axis = axis.unwrap();
            let [mut eye, mut up] = [[0.013, 0.021, 0.017], [0.0; 3]];
            (eye[axis], up[(axis + 1) % 3]) = (-3.0, 1.0);
            let mut at = eye;
            at[axis] = 0.0;
            let camera = Camera::new(eye, at, up, Lens::Parallel(2.3)).unwrap();
            let shot = shot(camera, [120, 120]);
            let pixel = 2.3 / 120.0;
            let picture =
                take(&shot, &[&SliceLayer::new(tree.view(), plane).colours(TAGS).outlines(Some(line))]);
            let mut drawn = 0;
            for (i, &colour) in picture.colours().iter().enumerate() {
                let point = point_of(&shot, i, (normal, offset, Some(axis))).unwrap();
                let Some(at) = frame.cell_of(point) else { continue };
                let cell = leaf(&cells, depth, at);
                let side = 2.0 / f64::from(1 << cell.level);
                let away = |k: usize| {
                    let from = point[k] + 1.0 - f64::from(cell.at[k]) * side;
                    from.min(side - from) / pixel
                };
                let away = (0..3).filter(|&k| k != axis).map(away).fold(f64::INFINITY, f64::min);
                if (away - 0.5).abs() < 1e-6 {
                    continue;
                }
                assert!(side / pixel > 5.0);
                let expected = if away < 0.5 { line } else { colour_of(tree.view().tag_at(at)) };
                assert_eq!(colour, expected, "{depth} {i} {away}");
                drawn += usize::from(away < 0.5);
            }
            assert!(drawn > 1000);
        }
    }
}

#[test]
fn outlines_of_small_cells_fade() {
    let control = Control::default();
    let frame = Frame::new([-1.0; 3], 2.0, 6).unwrap();
    let tree = build(&part(), &frame, Rule::Certified, &control).unwrap();
    let cells: Vec<TaggedCell> = tree.view().cells(CellFilter::leaves()).collect();
    let plane = SlicePlane::across(1, 0.1).unwrap();
    let camera =
        Camera::new([0.013, -3.0, 0.02], [0.013, 0.0, 0.02], [0.0, 0.0, 1.0], Lens::Parallel(2.3)).unwrap();
    let shot = shot(camera, [60, 60]);
    let (line, pixel) = ([255, 255, 255, 255], 2.3 / 60.0);
    let slice = || SliceLayer::new(tree.view(), plane).colours(TAGS);
    let with = take(&shot, &[&slice().outlines(Some(line))]);
    let without = take(&shot, &[&slice().outlines(None)]);
    let mut counts = [0; 3];
    for (i, (&a, &b)) in with.colours().iter().zip(without.colours()).enumerate() {
        let point = point_of(&shot, i, ([0.0, 1.0, 0.0], 0.1, Some(1))).unwrap();
        let Some(at) = frame.cell_of(point) else { continue };
        let side = 2.0 / f64::from(1 << leaf(&cells, 6, at).level) / pixel;
        match side {
            ..2.0 => assert_eq!(a, b),
            2.0..5.0 => assert!(a != line),
            _ => assert!(a == b || a == line),
        }
        counts[if side < 2.0 { 0 } else { 1 + usize::from(side > 5.0) }] += usize::from(side < 2.0 || a != b);
    }
    assert!(counts.iter().all(|&count| count > 50), "{counts:?}");
}

#[test]
fn slices_show_values() {
    let control = Control::default();
    let frame = Frame::new([-1.0; 3], 2.0, 5).unwrap();
    let tree = build(&part(), &frame, Rule::Certified, &control).unwrap();
    let value = |p: V| (p[0] > 0.0).then_some([p[0], p[2], 0.0, 0.0]);
    let attribute = FunctionAttribute::new(2, value).unwrap();
    let colour = |value: Option<[f64; 4]>| match value {
        Some([x, z, ..]) => [(x * 200.0) as u8, ((z + 1.0) * 100.0) as u8, 77, 255],
        None => [9, 9, 9, 255],
    };
    let camera =
        Camera::new([0.013, -3.0, 0.02], [0.013, 0.0, 0.02], [0.0, 0.0, 1.0], Lens::Parallel(2.3)).unwrap();
    let shot = shot(camera, [61, 47]);
    let plane = SlicePlane::across(1, 0.1).unwrap();
    let layer = SliceLayer::new(tree.view(), plane).colours(TAGS).outlines(None).values(&attribute, &colour);
    let picture = take(&shot, &[&layer]);
    for (i, &found) in picture.colours().iter().enumerate() {
        let point = point_of(&shot, i, ([0.0, 1.0, 0.0], 0.1, Some(1))).unwrap();
        let expected = match frame.cell_of(point).map(|at| tree.view().tag_at(at)) {
            None => [0; 4],
            Some(Tag::Empty) => TAGS[0],
            Some(_) => colour(value(point)),
        };
        for c in 0..4 {
            // A rounded coordinate may change a byte by one.
            assert!(found[c].abs_diff(expected[c]) <= 1, "{point:?}: {found:?} {expected:?}");
        }
    }
}

/// The usual section: a mesh is cut at the slice's plane. The slice covers the opening without a gap.
#[test]
fn slices_lie_in_clip_planes() {
    let control = Control::default();
    let frame = Frame::new([-1.0; 3], 2.0, 5).unwrap();
    let tree = build(&Csg::ball([0.0; 3], 0.8).unwrap(), &frame, Rule::Certified, &control).unwrap();
    let (mesh, full) = (ball(20), [[1, 200, 3, 255]; 3]);
    for normal in [[0.0, 1.0, 0.0], [0.3, 0.9, -0.2]] {
        let clip = Clip::new().plane([normal[0], normal[1], normal[2], 0.1]).unwrap();
        let plane = SlicePlane::new(normal, 0.1).unwrap();
        for lens in [Lens::Parallel(2.0), Lens::Perspective(35.0)] {
            let camera = Camera::new([0.3, -3.0, 0.4], [0.0; 3], [0.0, 0.0, 1.0], lens).unwrap();
            let shot = Shot { clip: clip.clone(), ..shot(camera, [50, 50]) };
            let slice = SliceLayer::new(tree.view(), plane).colours(full).outlines(None);
            let alone = take(&shot, &[&slice]);
            let both = take(&shot, &[&MeshLayer::new(&mesh).colour([255, 0, 0, 255]), &slice]);
            let mut seen = 0;
            for i in 0..2500 {
                if let Some(point) = point_of(&shot, i, (normal, -0.1, None))
                    && frame.cell_of(point).is_some()
                {
                    assert_eq!(alone.colours()[i], full[0]);
                    assert_eq!(both.colours()[i], full[0]);
                    seen += 1;
                }
            }
            assert!(seen > 500);
        }
    }
}

#[test]
fn slices_are_the_same_for_any_number_of_threads() {
    let frame = Frame::new([-1.0; 3], 2.0, 6).unwrap();
    let part = part();
    let layer = SliceLayer::of_solid(&part, &frame, SlicePlane::new([0.3, -0.8, 0.5], -0.05).unwrap());
    let camera = Camera::new([2.0, -3.0, 1.0], [0.0; 3], [0.0, 0.0, 1.0], Lens::Perspective(40.0)).unwrap();
    let pictures = [1, 2, 5].map(|threads| {
        render(&Shot::new(camera, [150, 100]), &[&layer], &Control::threads(threads)).unwrap()
    });
    assert!(pictures[0] == pictures[1] && pictures[0] == pictures[2]);
    // A universe of one tag, planes that meet nothing, and invalid planes.
    let empty =
        build(&Csg::ball([9.0; 3], 0.1).unwrap(), &frame, Rule::Certified, &Control::default()).unwrap();
    let layer = |plane| SliceLayer::new(empty.view(), plane).colours(TAGS).outlines(None);
    let seen = |plane: SlicePlane| {
        let picture = take(&shot(front(1.0), [20, 20]), &[&layer(plane)]);
        picture.colours().iter().filter(|&&colour| colour == TAGS[0]).count()
    };
    assert_eq!(seen(SlicePlane::across(1, 0.3).unwrap()), 400);
    for (axis, at) in [(0, 0.0), (1, 1.5), (1, -7.0), (2, 0.0)] {
        assert_eq!(seen(SlicePlane::across(axis, at).unwrap()), 0, "{axis} {at}");
    }
    assert!(SlicePlane::across(3, 0.0).is_err() && SlicePlane::new([0.0; 3], 1.0).is_err());
    assert!(
        SlicePlane::new([f64::NAN, 1.0, 0.0], 1.0).is_err() && SlicePlane::across(0, f64::INFINITY).is_err()
    );
}

/// An empty picture of one colour.
fn blank(size: [u32; 2], background: [u8; 4]) -> Picture {
    take(&Shot { background, ..shot(front(1.0), size) }, &[])
}

/// Returns whether two pictures differ only in a box, and the number of pixels that differ.
fn changes(before: &Picture, after: &Picture, [left, top, width, height]: [u32; 4]) -> usize {
    assert!(width > 0 && height > 0 && left + width <= before.width() && top + height <= before.height());
    let mut count = 0;
    for (i, (a, b)) in before.colours().iter().zip(after.colours()).enumerate() {
        let (x, y) = (i as u32 % before.width(), i as u32 / before.width());
        let is_inside = (left..left + width).contains(&x) && (top..top + height).contains(&y);
        assert!(a == b || is_inside, "{x} {y}");
        count += usize::from(a != b);
    }
    assert_eq!(before.depths(), after.depths());
    count
}

#[test]
fn legends_change_only_their_box() {
    let ramp = |x: f64| [(x * 255.0) as u8, 40, 200, 255];
    let names = [("EMPTY", TAGS[0]), ("FULL", TAGS[1]), ("PARTIAL with a rather long name", TAGS[2])];
    let sizes = [[160, 120], [161, 700], [320, 240], [900, 130], [640, 480], [1024, 1024], [2400, 2000]];
    let long = "a title that is by far too long for any legend, and goes on and on";
    for size in sizes {
        for background in [[255; 4], [0, 0, 0, 255], [0; 4]] {
            for side in [LegendSide::Right, LegendSide::Bottom] {
                let before = blank(size, background);
                let within = |[_, _, width, height]: [u32; 4]| match side {
                    LegendSide::Right => 3 * width <= size[0],
                    LegendSide::Bottom => 3 * height <= size[1],
                };
                let dark = |picture: &Picture, [left, top, width, height]: [u32; 4]| {
                    let rows = (top..top + height).flat_map(|y| (left..left + width).map(move |x| (x, y)));
                    let colour = |(x, y): (u32, u32)| picture.colours()[(y * size[0] + x) as usize];
                    rows.filter(|&at| colour(at) == [20, 20, 20, 255]).count()
                };
                for title in ["", "temperature in \u{b0}C", long] {
                    let mut after = before.clone();
                    let covered =
                        draw_colour_bar(&mut after, title, [0.0, 1.0], &ramp, side).unwrap().unwrap();
                    assert!(within(covered), "{size:?} {covered:?}");
                    let area = (covered[2] * covered[3]) as usize;
                    let least = if background == [255; 4] { area / 40 } else { area };
                    let changed = changes(&before, &after, covered);
                    assert!(changed >= least, "{size:?} {side:?} {background:?}: {changed} {least}");
                    assert!(dark(&after, covered) > 100, "{size:?} {side:?}");
                    let mut after = before.clone();
                    let covered = draw_names(&mut after, title, &names, side).unwrap();
                    assert!(within(covered), "{size:?} {covered:?}");
                    changes(&before, &after, covered);
                    assert!(
                        TAGS.iter().all(|tag| after.colours().contains(tag)),
                        "{size:?} {side:?} {title}"
                    );
                    assert!(dark(&after, covered) > 100);
                }
            }
        }
    }
}

/// The colours of the range lie along the bar, with the greatest value at the top or on the right.
#[test]
fn colour_bars_show_their_range() {
    let colour = |x: f64| [100, (x - 300.0) as u8, 7, 255];
    for side in [LegendSide::Right, LegendSide::Bottom] {
        let mut picture = blank([400, 300], [255; 4]);
        draw_colour_bar(&mut picture, "K", [300.0, 500.0], &colour, side).unwrap();
        let is_bar = |colour: &[u8; 4]| colour[0] == 100 && colour[2] == 7;
        let at = |x: usize, y: usize| picture.colours()[y * 400 + x];
        let line = |k: usize| -> Vec<u8> {
            let colours: Vec<[u8; 4]> = match side {
                LegendSide::Right => (0..300).rev().map(|y| at(k, y)).collect(),
                LegendSide::Bottom => (0..400).map(|x| at(x, k)).collect(),
            };
            colours.iter().filter(|colour| is_bar(colour)).map(|colour| colour[1]).collect()
        };
        let values = (0..300).map(line).find(|values| values.len() > 50);
        let values = values.unwrap_or_else(|| (300..400).map(line).find(|values| values.len() > 50).unwrap());
        assert!(values.is_sorted() && values[0] < 4 && *values.last().unwrap() > 195, "{side:?} {values:?}");
    }
}

#[test]
fn legends_that_are_none() {
    let ramp = |_: f64| [1, 2, 3, 255];
    for size in [[159, 500], [500, 119], [1, 1]] {
        let before = blank(size, [0; 4]);
        let mut after = before.clone();
        assert!(draw_colour_bar(&mut after, "t", [0.0, 1.0], &ramp, LegendSide::Right).unwrap().is_none());
        assert!(draw_names(&mut after, "t", &[("a", TAGS[0])], LegendSide::Bottom).is_none());
        assert!(before == after);
    }
    let mut picture = blank([200, 200], [0; 4]);
    assert!(draw_names(&mut picture, "", &[], LegendSide::Right).is_none());
    for range in [[1.0, 0.0], [f64::NAN, 1.0], [0.0, f64::INFINITY], [-f64::MAX, f64::MAX]] {
        assert!(draw_colour_bar(&mut picture, "", range, &ramp, LegendSide::Right).is_err());
    }
    for range in [[0.0, 0.0], [1.0, 1.0 + 1e-15], [0.0, 1e-310], [0.0, 1e305], [-1e17, -1e17 + 64.0]] {
        let title = "\n\r\t\0\u{1F600}";
        assert!(draw_colour_bar(&mut picture, title, range, &ramp, LegendSide::Bottom).is_ok());
    }
    let many: Vec<(&str, [u8; 4])> = (0..500).map(|_| ("name", TAGS[0])).collect();
    for side in [LegendSide::Right, LegendSide::Bottom] {
        assert!(draw_names(&mut picture, "all", &many, side).is_some());
    }
}
