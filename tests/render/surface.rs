//! Surfaces of octrees and solids in pictures, against formulas: visibility, depth, cut-open views and
//! colours of values.

use leafless::attribute::FunctionAttribute;
use leafless::render::{
    Camera, Clip, ClippedLayer, Finish, Layer, Lens, MeshLayer, OctreeLayer, Outline, Picture, Shot,
    SolidLayer, render,
};
use leafless::{
    Affine, Bounds, Control, Csg, Error, Frame, Rule, SurfaceOptions, TriangleMesh, build, build_extended,
};
use leafless_testkit::alone;

const SIZE: [u32; 2] = [120, 90];

fn frame(depth: u8) -> Frame {
    Frame::new([-1.0; 3], 2.0, depth).unwrap()
}

const CENTRE: [f64; 3] = [0.05, -0.1, 0.15];
const RADIUS: f64 = 0.7;

fn ball() -> Csg {
    Csg::ball(CENTRE, RADIUS).unwrap()
}

/// Cameras with both lenses, on several sides.
fn shots() -> Vec<Shot> {
    let mut shots = Vec::new();
    for (eye, up) in [
        ([2.0, -3.0, 1.0], [0.0, 0.0, 1.0]),
        ([-0.5, 0.4, 3.5], [0.0, 1.0, 0.2]),
        ([-4.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
    ] {
        for lens in [Lens::Perspective(35.0), Lens::Parallel(2.2)] {
            let camera = Camera::new(eye, [0.0; 3], up, lens).unwrap();
            shots.push(Shot { samples: 1, ..Shot::new(camera, SIZE) });
        }
    }
    shots
}

/// The line of sight through a pixel's centre: its origin, and its direction scaled to depth 1.
fn line(camera: &Camera, [x, y]: [u32; 2]) -> ([f64; 3], [f64; 3]) {
    let half = match camera.lens() {
        Lens::Perspective(degrees) => (0.5 * degrees.to_radians()).tan(),
        Lens::Parallel(height) => 0.5 * height,
    };
    let pixel = 2.0 * half / f64::from(SIZE[1]);
    let across = (f64::from(x) + 0.5 - 0.5 * f64::from(SIZE[0])) * pixel;
    let above = (0.5 * f64::from(SIZE[1]) - f64::from(y) - 0.5) * pixel;
    let side = [0, 1, 2].map(|axis| across * camera.right()[axis] + above * camera.up()[axis]);
    let plus = |a: [f64; 3]| [0, 1, 2].map(|axis| a[axis] + side[axis]);
    match camera.lens() {
        Lens::Perspective(_) => (camera.eye(), plus(camera.forward())),
        Lens::Parallel(_) => (plus(camera.eye()), camera.forward()),
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}

/// Returns the times at which a line meets a ball of a radius, and the line's distance from the centre.
fn meets([from, along]: [[f64; 3]; 2], radius: f64) -> (Option<[f64; 2]>, f64) {
    let to = [0, 1, 2].map(|axis| from[axis] - CENTRE[axis]);
    let (a, b, c) = (dot(along, along), dot(to, along), dot(to, to) - radius * radius);
    let near = (dot(to, to) - b * b / a).max(0.0).sqrt();
    let root = b * b - a * c;
    ((root >= 0.0).then(|| [(-b - root.sqrt()) / a, (-b + root.sqrt()) / a]), near)
}

fn pixels(picture: &Picture) -> impl Iterator<Item = ([u32; 2], [u8; 4], f64)> + '_ {
    let places = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]));
    places
        .zip(picture.colours())
        .zip(picture.depths())
        .map(|((at, &colour), &depth)| (at, colour, f64::from(depth)))
}

#[test]
fn balls_are_where_they_are() {
    let solid = ball();
    let fine = frame(8);
    let tree = build(&solid, &fine, Rule::Certified, &alone()).unwrap();
    let cell = fine.cell_size();
    let octree = OctreeLayer::new(tree.view(), Finish::default());
    let faces = OctreeLayer::new(tree.view(), Finish { faces: true, ..Finish::default() });
    // Cells of a sixteenth. The visible surface in them comes from slabs.
    let by_slabs = SolidLayer::new(&solid, &fine, Finish::default()).at_most(5);
    for shot in shots() {
        for (layer, early, late) in
            [(&octree as &dyn Layer, 4.0 * cell, 1e-6), (&faces, 4.0 * cell, 1e-6), (&by_slabs, 3e-3, 3e-3)]
        {
            let picture = render(&shot, &[layer], &alone()).unwrap();
            let mut seen = 0;
            for (at, colour, depth) in pixels(&picture) {
                let (from, along) = line(&shot.camera, at);
                let (times, near) = meets([from, along], RADIUS);
                // Near the silhouette, cells hide slightly more, and depths are arbitrary.
                if (near - RADIUS).abs() < 2.0 * cell + 2e-3 {
                    continue;
                }
                assert_eq!(
                    colour != [255; 4],
                    times.is_some(),
                    "{at:?} {early} {:?} {times:?} {near}",
                    shot.camera
                );
                assert_eq!(depth.is_finite(), times.is_some());
                if let Some([first, _]) = times {
                    let steep = RADIUS / (RADIUS * RADIUS - near * near).sqrt();
                    let along = dot(along, along).sqrt();
                    let off = (depth - first) * along;
                    assert!(-early * steep < off && off < late * steep, "{at:?} {off} {steep}");
                    seen += 1;
                }
            }
            assert!(seen > 1000);
        }
    }
}

#[test]
fn what_is_cut_open_is_flat() {
    let solid = ball();
    let tree = build(&solid, &frame(7), Rule::Certified, &alone()).unwrap();
    let finish = Finish { cut: [255, 0, 0, 255], ..Finish::default() };
    let cell = frame(7).cell_size();
    // The kept part lies on the side away from the eye.
    let camera = Camera::new([0.0, -4.0, 0.5], [0.0; 3], [0.0, 0.0, 1.0], Lens::Perspective(35.0)).unwrap();
    let clip = Clip::new().plane([0.0, 2.0, 0.0, 0.4]).unwrap();
    let shot = Shot { samples: 1, clip, ..Shot::new(camera, SIZE) };
    let layers: [&dyn Layer; 2] =
        [&OctreeLayer::new(tree.view(), finish), &SolidLayer::new(&solid, &frame(7), finish)];
    for layer in layers {
        let picture = render(&shot, &[layer], &alone()).unwrap();
        let mut cut = 0;
        for (at, colour, depth) in pixels(&picture) {
            let (from, along) = line(&camera, at);
            let t = (-0.2 - from[1]) / along[1];
            let point = [0, 1, 2].map(|axis| from[axis] + t * along[axis] - CENTRE[axis]);
            let off = dot(point, point).sqrt() - RADIUS;
            if off < -2.0 * cell {
                // Uniform brightness, and no green.
                assert!(
                    (depth - t).abs() < 1e-5 && colour[0] > 90 && colour[1] == 0,
                    "{at:?} {colour:?} {depth} {t}"
                );
                cut += 1;
            }
        }
        assert!(cut > 500);
    }
}

/// Lines of sight that begin at a wall and hardly leave it pass many cells.
#[test]
fn grazed_walls_are_passed_by() {
    let block = Csg::cuboid([-0.9, -0.5, -0.8], [0.9, 0.5, 0.8]).unwrap();
    let solid = block.difference(&Csg::cylinder(0.3, -1.0, 1.0).unwrap()).unwrap();
    let (rim, along) = ([-0.05f64.sqrt(), 0.2, 0.0], [-0.41, -0.57, 0.71]);
    let eye = [0, 1, 2].map(|axis| rim[axis] - 3.0 * along[axis]);
    let camera = Camera::new(eye, rim, [0.0, 1.0, 0.0], Lens::Perspective(2.0)).unwrap();
    let clip = Clip::new().plane([0.0, -1.0, 0.0, 0.2]).unwrap();
    let shot = Shot { samples: 1, clip, ..Shot::new(camera, SIZE) };
    let picture = render(&shot, &[&SolidLayer::new(&solid, &frame(7), Finish::default())], &alone()).unwrap();
    let (mut cut, mut far) = (0, 0);
    for (at, _, depth) in pixels(&picture) {
        let (from, along) = line(&camera, at);
        let begins = (0.2 - from[1]) / along[1];
        // The place where the line leaves the bore, whose axis is z.
        let (a, b) = (along[0].powi(2) + along[1].powi(2), from[0] * along[0] + from[1] * along[1]);
        let ends = (-b + (b * b - a * (from[0].powi(2) + from[1].powi(2) - 0.09)).sqrt()) / a;
        let height = (from[0] + begins * along[0]).hypot(0.2) - 0.3;
        if height > 2e-5 {
            assert!((depth - begins).abs() < 1e-5, "{at:?} {depth} {begins}");
            cut += 1;
        } else if height < -2e-5 {
            assert!((depth - ends).abs() < 1e-3, "{at:?} {depth} {ends}");
            far += usize::from(ends > begins + 0.05);
        }
    }
    assert!(cut > 1000 && far > 1000, "{cut} {far}");
}

#[test]
fn values_give_their_colours() {
    let tree = build(&ball(), &frame(7), Rule::Certified, &alone()).unwrap();
    let cell = frame(7).cell_size();
    let side = FunctionAttribute::new(1, |p: [f64; 3]| {
        (p[2] != 9.0).then_some([f64::from(u8::from(p[0] > 0.0)), 0.0, 0.0, 0.0])
    });
    let side = side.unwrap();
    let colour = |value: Option<[f64; 4]>| match value {
        Some([0.0, ..]) => [0, 200, 0, 255],
        Some(_) => [0, 0, 200, 255],
        None => [200, 0, 0, 255],
    };
    let solid = ball();
    let octree = OctreeLayer::new(tree.view(), Finish::default()).values(&side, &colour);
    let by_slabs = SolidLayer::new(&solid, &frame(7), Finish::default()).values(&side, &colour);
    let both =
        shots().into_iter().flat_map(|shot| [(shot.clone(), &octree as &dyn Layer), (shot, &by_slabs)]);
    for (shot, layer) in both {
        let picture = render(&shot, &[layer], &alone()).unwrap();
        let mut seen = [0; 2];
        for (at, colour, depth) in pixels(&picture).filter(|pixel| pixel.2.is_finite()) {
            let (from, along) = line(&shot.camera, at);
            let x = from[0] + depth * along[0];
            if x.abs() > 2.0 * cell {
                let right = x > 0.0;
                assert!(
                    colour[0] == 0 && (colour[1] == 0) == right && (colour[2] == 0) != right,
                    "{at:?} {colour:?}"
                );
                seen[usize::from(right)] += 1;
            }
        }
        assert!(seen[0] + seen[1] > 1000);
    }
}

#[test]
fn layers_hide_each_other() {
    let tree = build(&ball(), &frame(6), Rule::Certified, &alone()).unwrap();
    // A sheet through the ball's middle, seen beside it, and where it lies before it.
    let sheet = TriangleMesh::new(
        vec![[-5.0, CENTRE[1], -5.0], [5.0, CENTRE[1], -5.0], [0.0, CENTRE[1], 8.0]],
        vec![[0, 1, 2]],
    )
    .unwrap();
    let camera = Camera::new([0.0, -4.0, 0.0], [0.0; 3], [0.0, 0.0, 1.0], Lens::Parallel(1.9)).unwrap();
    let shot = Shot { samples: 1, ..Shot::new(camera, SIZE) };
    let mesh = MeshLayer::new(&sheet).colour([255, 0, 0, 255]).inside([255, 0, 0, 255]);
    let octree = OctreeLayer::new(tree.view(), Finish { colour: [0, 255, 0, 255], ..Finish::default() });
    let behind = render(&shot, &[&mesh, &octree], &alone()).unwrap();
    assert_eq!(behind, render(&shot, &[&octree, &mesh], &alone()).unwrap());
    // A layer's own clip does not affect the other layer.
    let clipped = ClippedLayer::new(&octree, Clip::new().plane([0.0, 1.0, 0.0, 0.0]).unwrap());
    let front = render(&shot, &[&mesh, &clipped], &alone()).unwrap();
    let middle = (SIZE[1] / 2 * SIZE[0] + SIZE[0] / 2) as usize;
    let corner = 0;
    assert!(behind.colours()[middle][1] > 0 && behind.colours()[corner][0] > 0);
    assert!(front.colours()[middle][0] > 0 && front.colours()[middle][1] == 0);
}

#[test]
fn eyes_may_be_anywhere() {
    // From very far away, a time does not determine a place in the solid.
    let solid = ball();
    let tree = build(&solid, &frame(8), Rule::Certified, &alone()).unwrap();
    let layers: [&dyn Layer; 2] = [
        &SolidLayer::new(&solid, &frame(7), Finish::default()),
        &OctreeLayer::new(tree.view(), Finish::default()),
    ];
    for distance in [1e2, 1e6, 1e8] {
        let eye = [0.3 * distance, -0.8 * distance, 0.5 * distance];
        let camera =
            Camera::new(eye, CENTRE, [0.0, 0.0, 1.0], Lens::Perspective((2.0f64 / distance).to_degrees()))
                .unwrap();
        for clip in [Clip::new(), Clip::new().plane([0.0, 0.0, -1.0, 0.2]).unwrap()] {
            let pictures = layers.map(|layer| {
                let shot = Shot { samples: 1, clip: clip.clone(), ..Shot::new(camera, SIZE) };
                render(&shot, &[layer], &alone()).unwrap()
            });
            let [by_slabs, cells] = pictures
                .each_ref()
                .map(|picture| picture.depths().iter().filter(|depth| depth.is_finite()).count());
            let pixel = (0.09 + 0.64 + 0.25f64).sqrt() * 2.0 / f64::from(SIZE[1]);
            let disc = core::f64::consts::PI * (RADIUS / pixel).powi(2);
            if clip.is_empty() {
                assert!((by_slabs as f64 - disc).abs() < 0.02 * disc, "{distance}: {by_slabs} of {disc}");
            }
            assert!(
                by_slabs <= cells && cells - by_slabs < cells / 20 + 100,
                "{distance}: {by_slabs} {cells}"
            );
        }
    }
    // In a cavity, in planes of the lattice.
    let block = Csg::cuboid([-0.9; 3], [0.9; 3]).unwrap();
    let hollow = block.difference(&Csg::ball([0.0; 3], 0.5).unwrap()).unwrap();
    let tree = build(&hollow, &frame(7), Rule::Certified, &alone()).unwrap();
    let camera = Camera::new([0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], Lens::Perspective(80.0)).unwrap();
    let layers: [(&dyn Layer, f64); 2] = [
        (&SolidLayer::new(&hollow, &frame(7), Finish::default()), 1e-3),
        (&OctreeLayer::new(tree.view(), Finish::default()), 2.0 * frame(7).cell_size()),
    ];
    for (layer, tolerance) in layers {
        let picture = render(&Shot { samples: 1, ..Shot::new(camera, SIZE) }, &[layer], &alone()).unwrap();
        for (at, _, depth) in pixels(&picture) {
            let (_, along) = line(&camera, at);
            assert!((depth * dot(along, along).sqrt() - 0.5).abs() < tolerance, "{at:?} {depth}");
        }
    }
}

/// A wall of a single layer of cells has no gradient. A plate a few layers thick is lit by its faces, not by
/// its rim.
#[test]
fn thin_plates_are_lit_as_their_faces() {
    let camera = Camera::new([0.7, -1.5, 2.0], [0.0; 3], [0.0, 0.0, 1.0], Lens::Parallel(0.6)).unwrap();
    for (thickness, depth) in [(0.006, 6), (0.04, 7), (0.08, 7), (0.1, 6)] {
        let plate = Csg::cuboid([-0.9, -0.9, 0.005], [0.9, 0.9, 0.005 + thickness]).unwrap();
        let tree = build(&plate, &frame(depth), Rule::Certified, &alone()).unwrap();
        let shot = Shot { samples: 1, ..Shot::new(camera, SIZE) };
        let picture = render(&shot, &[&OctreeLayer::new(tree.view(), Finish::default())], &alone()).unwrap();
        let middle = picture.colours()[(SIZE[0] * SIZE[1] / 2 + SIZE[0] / 2) as usize];
        for (at, colour, depth) in pixels(&picture) {
            assert!(depth.is_finite());
            assert!(
                (0..3).all(|k| colour[k].abs_diff(middle[k]) <= 3),
                "{thickness} {at:?} {colour:?} {middle:?}"
            );
        }
        // Seen from above, it is bright.
        assert!(middle[0] > 120, "{thickness} {middle:?}");
    }
}

/// A picture cuts off unbounded solids at the universe's faces.
#[test]
fn faces_of_the_universe_are_flat() {
    let tree = build(&ball().complement(), &frame(7), Rule::Certified, &alone()).unwrap();
    let camera = Camera::new([0.7, -2.0, 1.5], [0.0; 3], [0.0, 0.0, 1.0], Lens::Parallel(3.6)).unwrap();
    let shot = Shot { samples: 1, ..Shot::new(camera, SIZE) };
    let picture = render(&shot, &[&OctreeLayer::new(tree.view(), Finish::default())], &alone()).unwrap();
    let mut of_faces: [Vec<[u8; 4]>; 3] = Default::default();
    for (at, colour, depth) in pixels(&picture).filter(|pixel| pixel.2.is_finite()) {
        let (from, along) = line(&camera, at);
        let point = [0, 1, 2].map(|axis| from[axis] + depth * along[axis]);
        // Normals turn at an edge.
        let near = |axis: usize| point[axis].abs() > 1.0 - 12.0 * frame(7).cell_size();
        let faces: Vec<usize> = (0..3).filter(|&axis| near(axis)).collect();
        if let &[axis] = &faces[..] {
            of_faces[axis].push(colour);
        }
    }
    for colours in of_faces {
        let unlike =
            colours.iter().filter(|colour| (0..3).any(|k| colour[k].abs_diff(colours[0][k]) > 3)).count();
        assert!(colours.len() > 300 && unlike == 0, "{unlike} of {}", colours.len());
    }
}

/// Returns the pixel coordinates of a point.
fn place(camera: &Camera, point: [f64; 3]) -> [f64; 2] {
    let from = [0, 1, 2].map(|axis| point[axis] - camera.eye()[axis]);
    let [x, y, z] = [camera.right(), camera.up(), camera.forward()].map(|side| dot(from, side));
    let half = match camera.lens() {
        Lens::Perspective(degrees) => z * (0.5 * degrees.to_radians()).tan(),
        Lens::Parallel(height) => 0.5 * height,
    };
    let pixel = 2.0 * half / f64::from(SIZE[1]);
    [0.5 * f64::from(SIZE[0]) + x / pixel, 0.5 * f64::from(SIZE[1]) - y / pixel]
}

/// Returns a place's distance from a line through two others, and the position of its foot along the line, 0
/// to 1.
fn beside(place: [f64; 2], [a, b]: [[f64; 2]; 2]) -> (f64, f64) {
    let (to, from) = ([b[0] - a[0], b[1] - a[1]], [place[0] - a[0], place[1] - a[1]]);
    let along = (from[0] * to[0] + from[1] * to[1]) / (to[0] * to[0] + to[1] * to[1]);
    let foot = along.clamp(0.0, 1.0);
    ((from[0] - foot * to[0]).hypot(from[1] - foot * to[1]), along)
}

/// Returns the visible edges of a block: those with at least one visible face.
fn edges_seen(camera: &Camera, corners: [[f64; 3]; 2]) -> Vec<[[f64; 2]; 2]> {
    let faces = |axis: usize, upper: usize| {
        let sign = if upper == 1 { 1.0 } else { -1.0 };
        match camera.lens() {
            Lens::Perspective(_) => sign * (camera.eye()[axis] - corners[upper][axis]) > 1e-9,
            Lens::Parallel(_) => -sign * camera.forward()[axis] > 1e-9,
        }
    };
    let mut edges = Vec::new();
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            if faces(u, i) || faces(v, j) {
                edges.push([0, 1].map(|end| {
                    let mut point = [corners[end][axis]; 3];
                    (point[u], point[v]) = (corners[i][u], corners[j][v]);
                    place(camera, point)
                }));
            }
        }
    }
    edges
}

#[test]
fn edges_are_drawn_where_faces_meet() {
    let corners = [[-0.63, -0.52, -0.41], [0.58, 0.47, 0.36]];
    let block = Csg::cuboid(corners[0], corners[1]).unwrap();
    let edges = Some(Outline { width: 2.0, colour: [255, 0, 0, 255], crease: 40.0 });
    let finish = Finish { edges, ..Finish::default() };
    let trees = [8, 7].map(|depth| build(&block, &frame(depth), Rule::Certified, &alone()).unwrap());
    // The greatest distance of ink from an edge, and the amount of ink required near it. Cells of a third of
    // a pixel, or of two pixels, shift it.
    let layers: [(&dyn Layer, f64, f64, f64); 3] = [
        (&SolidLayer::new(&block, &frame(7), finish), 1.2, 1.0, 0.7),
        (&OctreeLayer::new(trees[0].view(), finish), 1.6, 0.97, 0.4),
        (&OctreeLayer::new(trees[1].view(), finish), 2.2, 0.9, 0.2),
    ];
    for (layer, farthest, least, near) in layers {
        let (mut drawn, mut all) = (0, 0);
        for shot in shots() {
            let edges = edges_seen(&shot.camera, corners);
            let picture = render(&shot, &[layer], &alone()).unwrap();
            for (at, colour, depth) in pixels(&picture) {
                let ink = colour == [255, 0, 0, 255];
                let middle = at.map(|x| f64::from(x) + 0.5);
                let nearest =
                    edges.iter().map(|&edge| beside(middle, edge)).min_by(|a, b| a.0.total_cmp(&b.0));
                let (distance, along) = nearest.unwrap();
                assert!(!ink || distance <= farthest, "{at:?}: {distance}");
                if depth < f64::INFINITY && distance < near && (0.05..0.95).contains(&along) {
                    (drawn, all) = (drawn + i32::from(ink), all + 1);
                }
            }
        }
        assert!(all > 300 && f64::from(drawn) >= least * f64::from(all), "{near}: {drawn} of {all}");
    }
}

#[test]
fn round_surfaces_have_silhouettes_only() {
    let solid = ball();
    let tree = build(&solid, &frame(8), Rule::Certified, &alone()).unwrap();
    let edges = Some(Outline { width: 2.0, colour: [255, 0, 0, 255], crease: 30.0 });
    let finish = Finish { edges, ..Finish::default() };
    // The region surely drawn, in pixels from the rim. Cells of a third of a pixel reach beyond it.
    let layers: [(&dyn Layer, f64); 2] =
        [(&SolidLayer::new(&solid, &frame(7), finish), 0.6), (&OctreeLayer::new(tree.view(), finish), 0.1)];
    for shot in shots() {
        for (layer, surely) in layers {
            let picture = render(&shot, &[layer], &alone()).unwrap();
            let mut rim = 0;
            for (at, colour, depth) in pixels(&picture) {
                let (from, along) = line(&shot.camera, at);
                let (met, near) = meets([from, along], RADIUS);
                let Some([t, _]) = met else { continue };
                let pixel = match shot.camera.lens() {
                    Lens::Perspective(degrees) => 2.0 * t * (0.5 * degrees.to_radians()).tan(),
                    Lens::Parallel(height) => height,
                } / f64::from(SIZE[1]);
                let inward = (RADIUS - near) / pixel;
                let ink = colour == [255, 0, 0, 255];
                assert!(!ink || inward < 2.5, "{at:?}: {inward}");
                if inward < surely && depth < f64::INFINITY {
                    assert!(ink, "{at:?}: {inward}");
                    rim += 1;
                }
            }
            assert!(rim > 5, "{rim}");
        }
    }
    // Invalid outlines are refused.
    for (width, crease) in [(0.0, 30.0), (9.0, 30.0), (f64::NAN, 30.0), (1.0, -1.0), (1.0, f64::NAN)] {
        let edges = Some(Outline { width, crease, ..Outline::default() });
        let layer = OctreeLayer::new(tree.view(), Finish { edges, ..Finish::default() });
        let refused = render(&shots()[0], &[&layer], &alone());
        assert!(matches!(refused, Err(Error::Argument { .. })), "{width} {crease}");
    }
}

#[test]
fn pictures_do_not_depend_on_threads_or_tiles() {
    let (solid, frame) = (ball(), frame(7));
    let tree = build(&solid, &frame, Rule::Certified, &alone()).unwrap();
    let octree = OctreeLayer::new(tree.view(), Finish::default());
    let outlined =
        OctreeLayer::new(tree.view(), Finish { edges: Some(Outline::default()), ..Finish::default() });
    let by_slabs = SolidLayer::new(&solid, &frame, Finish::default());
    for shot in shots() {
        for layer in [&octree as &dyn Layer, &outlined, &by_slabs] {
            let one = render(&shot, &[layer], &alone()).unwrap();
            assert_eq!(one, render(&shot, &[layer], &Control::threads(3)).unwrap());
        }
    }
}

#[test]
fn nothing_and_everything() {
    let control = alone();
    let bounds = Bounds::of(&frame(4));
    let camera = Camera::fitted(&bounds.corners(), [30.0, 30.0], Some(30.0), 1.0).unwrap();
    let shot = Shot { background: [10, 20, 30, 255], ..Shot::new(camera, [32, 32]) };
    for depth in [1, 4, 20] {
        let empty =
            build(&Csg::ball([9.0; 3], 1.0).unwrap(), &frame(depth), Rule::Certified, &control).unwrap();
        let picture = render(&shot, &[&OctreeLayer::new(empty.view(), Finish::default())], &control).unwrap();
        assert!(picture.colours().iter().all(|&colour| colour == [10, 20, 30, 255]));
        let full =
            build(&Csg::ball([0.0; 3], 9.0).unwrap(), &frame(depth), Rule::Certified, &control).unwrap();
        let picture = render(&shot, &[&OctreeLayer::new(full.view(), Finish::default())], &control).unwrap();
        assert!(picture.depths()[16 * 32 + 16].is_finite() && picture.depths()[0].is_infinite());
    }
    // From inside.
    let full = build(&Csg::ball([0.0; 3], 9.0).unwrap(), &frame(4), Rule::Certified, &control).unwrap();
    let inside = Camera::new([0.1; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], Lens::Perspective(60.0)).unwrap();
    let finish = Finish { cut: [255, 0, 0, 255], ..Finish::default() };
    let picture =
        render(&Shot::new(inside, [16, 16]), &[&OctreeLayer::new(full.view(), finish)], &control).unwrap();
    assert!(picture.colours().iter().all(|colour| colour[0] > 90 && colour[1] == 0));
}

#[test]
fn what_is_no_picture_is_refused() {
    let camera = shots()[0].camera;
    let refused = |shot: Shot| matches!(render(&shot, &[], &alone()), Err(Error::Argument { .. }));
    for size in [[0, 10], [10, 0], [16385, 1], [u32::MAX; 2]] {
        assert!(refused(Shot::new(camera, size)));
    }
    for samples in [0, 2, 3, 81, u32::MAX] {
        assert!(refused(Shot { samples, ..Shot::new(camera, [8, 8]) }));
    }
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let control = Control { cancel: Some(&cancel), ..alone() };
    assert!(matches!(render(&Shot::new(camera, [8, 8]), &[], &control), Err(Error::Cancelled)));
}

/// A plate with bores whose extended tree has large cells. It is shown as the plate, and with `faces` as its
/// cells.
#[test]
fn an_extended_tree_is_shown_as_its_source() {
    let bores = (0..6).map(|k| {
        let to = [8.0 + 16.0 * f64::from(k % 3), 7.5 + 15.0 * f64::from(k / 3), 0.0];
        Csg::cylinder(2.5, -1.0, 11.0).unwrap().placed(&Affine::translation(to).unwrap()).unwrap()
    });
    let plate = Csg::cuboid([0.0; 3], [48.0, 30.0, 10.0]).unwrap();
    let plate = plate.difference(&Csg::union_of(bores).unwrap()).unwrap();
    let frame = Frame::around([0.0; 3], [48.0, 30.0, 10.0], 20).unwrap();
    let tree = build_extended(&plate, &frame, &SurfaceOptions::default(), &alone()).unwrap();
    let lens = Lens::Perspective(30.0);
    let camera = Camera::new([70.0, -60.0, 60.0], [24.0, 15.0, 5.0], [0.0, 0.0, 1.0], lens).unwrap();
    let shot = Shot::new(camera, [200, 150]);
    let shown = |layer: &dyn Layer| render(&shot, &[layer], &alone()).unwrap();
    let edges = Finish { edges: Some(Outline::default()), ..Finish::default() };
    for finish in [Finish::default(), edges] {
        let own = shown(&OctreeLayer::new(tree.view(), finish));
        let source = shown(&SolidLayer::new(&plate, &frame, finish));
        let differ = |(a, b): &(&[u8; 4], &[u8; 4])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 2);
        let others = own.colours().iter().zip(source.colours()).filter(differ).count();
        assert!(others < 30, "{others}");
        // A part of it is visible, also through the bores.
        let covered = own.colours().iter().filter(|&&colour| colour != shot.background).count();
        assert!((5_000..20_000).contains(&covered), "{covered}");
    }
    // The tree's own cells are those of the tree without cuts.
    let faces = Finish { faces: true, ..Finish::default() };
    let blunt = tree.without_cuts();
    assert_eq!(
        shown(&OctreeLayer::new(tree.view(), faces)).colours(),
        shown(&OctreeLayer::new(blunt.view(), faces)).colours()
    );
}
