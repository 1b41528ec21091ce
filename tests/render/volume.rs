//! Volumes in pictures, against all voxels on each line of sight, sorted by entry, and against formulas.

use leafless::render::{
    Camera, Clip, ColourMap, Compositing, Lens, Picture, Shot, Transfer, VolumeLayer, render,
};
use leafless::voxel::{LinearCode, VoxelKind, VoxelRecords, VoxelRecordsRef};
use leafless::{Bounds, Control, Error, Frame};
use leafless_testkit::Random;
use std::sync::atomic::AtomicBool;

/// The cube [-1, 1]³ with at most 16 cells along an axis.
fn frame() -> Frame {
    Frame::new([-1.0; 3], 2.0, 4).unwrap()
}

/// Voxel records under construction.
#[derive(Default)]
struct List {
    codes: Vec<u64>,
    levels: Vec<u8>,
    kinds: Vec<u8>,
    values: Vec<f64>,
}

impl List {
    /// Divides a cell at random. `what` returns the kind and value of each part.
    fn divide(
        &mut self,
        cell: leafless::Cell,
        random: &mut Random,
        what: &mut impl FnMut(&mut Random) -> (Option<VoxelKind>, Vec<f64>),
    ) {
        let code = LinearCode::new(cell, 4).unwrap().number();
        let (kind, value) = what(random);
        let splits = cell.level == 0 || cell.level < 4 && random.below(3) == 0;
        if splits {
            if random.below(2) == 0 {
                self.push(code, cell.level, VoxelKind::Refined, &value);
            }
            for octant in 0..8 {
                self.divide(cell.child(octant), random, what);
            }
        } else if let Some(kind) = kind {
            self.push(code, cell.level, kind, &value);
        }
    }

    fn push(&mut self, code: u64, level: u8, kind: VoxelKind, value: &[f64]) {
        self.codes.push(code);
        self.levels.push(level);
        self.kinds.push(kind as u8);
        self.values.extend(value);
    }

    fn records(self, components: usize) -> VoxelRecords {
        VoxelRecords::from_arrays(&frame(), self.codes, self.levels, self.kinds, components, self.values)
            .unwrap()
    }
}

/// Voxels of all kinds and gaps. Some values are missing.
fn random_records(random: &mut Random, components: usize) -> VoxelRecords {
    let mut list = List::default();
    list.divide(leafless::Cell::ROOT, random, &mut |random| {
        let kind = [None, Some(VoxelKind::Outside), Some(VoxelKind::Boundary), Some(VoxelKind::Inside)];
        let known = random.below(8) > 0;
        let number = |_| if known { random.between(-20.0, 280.0) } else { f64::NAN };
        let value = (0..components).map(number).collect();
        (kind[random.below(4) as usize], value)
    });
    list.records(components)
}

/// One inside voxel, the universe, or a random division of it.
fn cube(random: Option<&mut Random>) -> VoxelRecords {
    let mut list = List::default();
    match random {
        Some(random) => {
            list.divide(leafless::Cell::ROOT, random, &mut |_| (Some(VoxelKind::Inside), vec![100.0]));
        }
        None => list.push(0, 0, VoxelKind::Inside, &[100.0]),
    }
    list.records(1)
}

type Vector = [f64; 3];

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns a line of sight: a point, and a direction of length 1 along the view.
fn line(camera: &Camera, [width, height]: [u32; 2], x: f64, y: f64) -> (Vector, Vector) {
    let (eye, right, up, forward) = (camera.eye(), camera.right(), camera.up(), camera.forward());
    let half = match camera.lens() {
        Lens::Parallel(height) => 0.5 * height,
        Lens::Perspective(degrees) => (0.5 * degrees).to_radians().tan(),
    };
    let (u, v) = (
        (x - 0.5 * f64::from(width)) * 2.0 * half / f64::from(height),
        (0.5 * f64::from(height) - y) * 2.0 * half / f64::from(height),
    );
    let across = [0, 1, 2].map(|i| u * right[i] + v * up[i]);
    match camera.lens() {
        Lens::Parallel(_) => ([0, 1, 2].map(|i| eye[i] + across[i]), forward),
        Lens::Perspective(_) => (eye, [0, 1, 2].map(|i| forward[i] + across[i])),
    }
}

/// Returns the range in which a line is in a box, from t = 0 on.
fn inside(min: Vector, max: Vector, from: Vector, along: Vector) -> Option<[f64; 2]> {
    let mut span = [0.0, f64::INFINITY];
    for i in 0..3 {
        if along[i] == 0.0 {
            if from[i] < min[i] || from[i] >= max[i] {
                return None;
            }
            continue;
        }
        let (a, b) = ((min[i] - from[i]) / along[i], (max[i] - from[i]) / along[i]);
        span = [f64::max(span[0], a.min(b)), f64::min(span[1], a.max(b))];
    }
    (span[0] < span[1]).then_some(span)
}

fn linear(byte: u8) -> f64 {
    let x = f64::from(byte) / 255.0;
    if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

fn encoded(x: f64) -> f64 {
    255.0 * if x <= 0.0031308 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

/// The expected picture of a volume: for each pixel the unrounded colour in front of an opaque background.
struct Oracle<'a> {
    records: VoxelRecordsRef<'a>,
    transfer: Transfer,
    weights: Option<&'a [f64]>,
    compositing: Compositing,
    planes: Vec<[f64; 4]>,
}

impl Oracle<'_> {
    fn pixel(&self, from: Vector, along: Vector, background: [u8; 4]) -> [f64; 3] {
        let frame = self.records.frame();
        let mut met = Vec::new();
        for (index, record) in self.records.iter().enumerate() {
            let usual = match record.kind {
                VoxelKind::Inside => 1.0,
                VoxelKind::Boundary => 0.5,
                _ => continue,
            };
            let edge = frame.edge() / f64::from(1u32 << record.cell.level);
            let min = [0, 1, 2].map(|i| frame.origin()[i] + f64::from(record.cell.at[i]) * edge);
            let max = min.map(|x| x + edge);
            let Some([mut start, mut end]) = inside(min, max, from, along) else { continue };
            let weight = self.weights.map_or(usual, |weights| weights[index]);
            let count = self.records.components();
            let value = &self.records.values()[count * index..][..count];
            let alpha = self.transfer.opacity(value, self.transfer.length());
            let through = match self.compositing {
                Compositing::Exact => {
                    for plane in &self.planes {
                        let normal = [plane[0], plane[1], plane[2]];
                        let (height, rise) = (dot(normal, from) + plane[3], dot(normal, along));
                        if rise < 0.0 {
                            end = end.min(-height / rise);
                        } else {
                            start = start.max(-height / rise);
                        }
                    }
                    if start >= end {
                        continue;
                    }
                    let path = (end - start) * dot(along, along).sqrt();
                    (1.0 - alpha).powf(weight * path / self.transfer.length())
                }
                Compositing::Published { unit } => {
                    let centre = min.map(|x| x + 0.5 * edge);
                    let kept =
                        |plane: &[f64; 4]| dot([plane[0], plane[1], plane[2]], centre) + plane[3] >= 0.0;
                    if !self.planes.iter().all(kept) {
                        continue;
                    }
                    (1.0 - alpha).powf(weight * edge / unit)
                }
            };
            met.push((start, self.transfer.colour(value).map(linear), 1.0 - through));
        }
        met.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut colour = [background[0], background[1], background[2]].map(linear);
        for (_, own, opacity) in met {
            colour = [0, 1, 2].map(|i| own[i] * opacity + colour[i] * (1.0 - opacity));
        }
        colour.map(encoded)
    }

    /// Checks a picture; returns the number of pixels that show something.
    fn assert_shows(&self, shot: &Shot, picture: &Picture) -> usize {
        assert_eq!(shot.samples, 1);
        let mut covered = 0;
        for (i, colour) in (0u32..).zip(picture.colours()) {
            let (x, y) = (f64::from(i % shot.size[0]) + 0.5, f64::from(i / shot.size[0]) + 0.5);
            let (from, along) = line(&shot.camera, shot.size, x, y);
            let expected = self.pixel(from, along, shot.background);
            for k in 0..3 {
                // Half a step of rounding, and a margin for single precision.
                let off = (f64::from(colour[k]) - expected[k]).abs();
                assert!(off < 0.51, "{x} {y}: {colour:?} {expected:?} by {shot:?}, {:?}", self.compositing);
            }
            covered += usize::from(*colour != shot.background);
        }
        covered
    }
}

/// Cameras on all sides: parallel ones, distant ones, and one amid the voxels.
fn cameras(random: &mut Random) -> Vec<Camera> {
    let bounds = Bounds::new([-1.0; 3], [1.0; 3]).unwrap();
    let mut cameras = Vec::new();
    for field_of_view in [None, Some(30.0), Some(100.0)] {
        let from = [random.between(-180.0, 180.0), random.between(-89.0, 89.0)];
        cameras.push(Camera::fitted(&bounds.corners(), from, field_of_view, 1.5).unwrap());
    }
    let point = |random: &mut Random| [0; 3].map(|_| random.between(-0.9, 0.9));
    for lens in [Lens::Perspective(90.0), Lens::Perspective(25.0), Lens::Parallel(1.5)] {
        cameras.push(Camera::new(point(random), point(random), [0.1, 0.2, 1.0], lens).unwrap());
    }
    cameras
}

fn shot(camera: Camera) -> Shot {
    Shot { samples: 1, background: [30, 60, 200, 255], ..Shot::new(camera, [48, 36]) }
}

fn transfer() -> Transfer {
    Transfer::new(ColourMap::Plasma, [0.0, 255.0], 0.6, 0.4).unwrap()
}

#[test]
fn voxels_are_seen_in_their_order_from_everywhere() {
    let control = Control::default();
    let mut covered = 0;
    for seed in 0..30 {
        let random = &mut Random(seed);
        let components = (seed % 5) as usize;
        let records = random_records(random, components);
        let records = records.view();
        let weights: Vec<f64> = (0..records.len()).map(|_| random.unit()).collect();
        let weights = (seed % 3 == 0).then_some(&weights[..]);
        let transfer = match seed % 4 {
            0 => transfer().ramp([0.9, 0.1]).unwrap(),
            1 => transfer().ramp([0.0, 1.0]).unwrap(),
            _ => transfer(),
        };
        let compositing = match seed % 2 {
            0 => Compositing::Exact,
            _ => Compositing::Published { unit: 0.3 },
        };
        let mut layer = VolumeLayer::new(records, transfer).compositing(compositing).unwrap();
        if let Some(weights) = weights {
            layer = layer.weights(weights).unwrap();
        }
        for camera in cameras(random) {
            // No voxel has its centre on one of the planes.
            for planes in [vec![], vec![[0.3, -0.4, 0.5, 0.1037], [-1.0, 0.2, 0.1, 0.6061]]] {
                let mut shot = shot(camera);
                for &plane in &planes {
                    shot.clip = shot.clip.plane(plane).unwrap();
                }
                let picture = render(&shot, &[&layer], &control).unwrap();
                assert!(picture.depths().iter().all(|&depth| depth == f32::INFINITY));
                let oracle = Oracle { records, transfer, weights, compositing, planes };
                covered += oracle.assert_shows(&shot, &picture);
            }
        }
    }
    assert!(covered > 200_000, "{covered}");
}

#[test]
fn repetitions_are_so_many_layers() {
    let transfer = Transfer::new(ColourMap::Viridis, [0.0, 1.0], 0.01, 0.5).unwrap();
    let records = cube(None);
    let bounds = Bounds::new([-1.0; 3], [1.0; 3]).unwrap();
    let camera = Camera::fitted(&bounds.corners(), [20.0, 30.0], None, 1.0).unwrap();
    let alone = Control::threads(1);
    let (mut opacity, mut through) = (0.0, 1.0);
    for k in 1..=1024u32 {
        // A layer behind the existing ones.
        opacity += 0.01 * through;
        through *= 0.99;
        assert!((transfer.opacity(&[0.4], 0.5 * f64::from(k)) - opacity).abs() < 1e-12);
        if k.is_power_of_two() || k % 100 == 7 {
            let compositing = Compositing::Published { unit: 2.0 / f64::from(k) };
            let layer = VolumeLayer::new(records.view(), transfer).compositing(compositing).unwrap();
            let shot = Shot { background: [0; 4], ..Shot::new(camera, [9, 9]) };
            let picture = render(&shot, &[&layer], &alone).unwrap();
            let [.., alpha] = picture.colours()[40];
            assert!((f64::from(alpha) - 255.0 * opacity).abs() <= 0.501, "{k}: {alpha} {opacity}");
        }
    }
    for r in [0.0, 0.1, 0.5, 1.5, 3.7, 100.25, 1023.9] {
        let expected = 1.0 - 0.99f64.powf(r);
        assert!((transfer.opacity(&[0.4], 0.5 * r) - expected).abs() < 1e-12, "{r}");
    }
}

/// Returns the greatest difference of two pictures.
fn difference(a: &Picture, b: &Picture) -> u8 {
    let pairs = a.bytes().iter().zip(b.bytes());
    pairs.map(|(a, b)| a.abs_diff(*b)).max().unwrap()
}

#[test]
fn a_cube_looks_as_one_however_it_is_divided() {
    let control = Control::default();
    let whole = cube(None);
    let whole = VolumeLayer::new(whole.view(), transfer());
    for seed in 0..20 {
        let random = &mut Random(seed);
        let parts = cube(Some(random));
        assert!(parts.view().len() > 8);
        let parts = VolumeLayer::new(parts.view(), transfer());
        for camera in cameras(random) {
            let shot = shot(camera);
            let [a, b] = [whole, parts].map(|layer| render(&shot, &[&layer], &control).unwrap());
            assert!(difference(&a, &b) <= 1, "{}", difference(&a, &b));
        }
        // From a corner of voxels.
        for (at, lens) in [([1.0, 0.0, 0.0], Lens::Perspective(120.0)), ([1.0; 3], Lens::Perspective(60.0))] {
            let camera = Camera::new([0.0; 3], at, [0.0, 0.0, 1.0], lens).unwrap();
            let shot = Shot { size: [21, 21], ..shot(camera) };
            let [a, b] = [whole, parts].map(|layer| render(&shot, &[&layer], &control).unwrap());
            assert!(difference(&a, &b) <= 1, "{}", difference(&a, &b));
        }
        // Lines along the planes between voxels.
        for axis in 0..6 {
            let mut forward = [0.0; 3];
            forward[axis / 2] = if axis % 2 == 0 { 1.0 } else { -1.0 };
            let up = if axis / 2 == 2 { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] };
            let eye = forward.map(|x| -2.0 * x);
            let camera = Camera::new(eye, [0.0; 3], up, Lens::Parallel(2.5)).unwrap();
            // Pixels of 1/8 whose middles lie on planes.
            let shot = Shot { size: [21, 20], samples: 1, ..shot(camera) };
            let [a, b] = [whole, parts].map(|layer| render(&shot, &[&layer], &control).unwrap());
            assert!(difference(&a, &b) <= 1, "{}", difference(&a, &b));
            assert_ne!(a.colours()[10 * 21 + 10], shot.background);
        }
    }
}

#[test]
fn a_picture_moves_with_its_voxels() {
    for seed in 0..4 {
        let random = &mut Random(seed);
        let records = random_records(random, 1);
        let near = records.view();
        for (scale, shift) in [(1.0, [1e6, -3e6, 2e6]), (1e-9, [0.0; 3]), (1e12, [7e12, 0.0, -1e9])] {
            let map = |p: [f64; 3]| [0, 1, 2].map(|i| scale * p[i] + shift[i]);
            let frame = Frame::new(map([-1.0; 3]), 2.0 * scale, 4).unwrap();
            let (codes, levels, kinds) = (near.codes(), near.levels(), near.kinds());
            let far = VoxelRecordsRef::new(&frame, codes, levels, kinds, 1, near.values()).unwrap();
            for camera in cameras(random) {
                let lens = match camera.lens() {
                    Lens::Parallel(height) => Lens::Parallel(scale * height),
                    lens => lens,
                };
                let at = [0, 1, 2].map(|i| camera.eye()[i] + camera.forward()[i]);
                let moved = Camera::new(map(camera.eye()), map(at), camera.up(), lens).unwrap();
                let other = Transfer::new(ColourMap::Plasma, [0.0, 255.0], 0.6, 0.4 * scale).unwrap();
                let picture = |records, camera, transfer| {
                    render(&shot(camera), &[&VolumeLayer::new(records, transfer)], &Control::default())
                        .unwrap()
                };
                let (a, b) = (picture(near, camera, transfer()), picture(far, moved, other));
                assert!(difference(&a, &b) <= 1, "{}", difference(&a, &b));
            }
        }
    }
}

#[test]
fn pictures_do_not_depend_on_threads() {
    let random = &mut Random(7);
    let records = random_records(random, 1);
    let layer = VolumeLayer::new(records.view(), transfer());
    for camera in cameras(random) {
        let shot = Shot { size: [130, 70], samples: 4, ..shot(camera) };
        let [one, three] = [1, 3].map(|n| render(&shot, &[&layer], &Control::threads(n)).unwrap());
        assert_eq!(one, three);
    }
}

#[test]
fn samples_are_averaged() {
    let random = &mut Random(8);
    let records = random_records(random, 3);
    let layer = VolumeLayer::new(records.view(), transfer());
    for camera in cameras(random) {
        let fine = Shot { size: [96, 72], background: [0, 0, 0, 255], ..shot(camera) };
        let coarse = Shot { samples: 4, size: [48, 36], ..fine.clone() };
        let [fine, coarse] =
            [fine, coarse].map(|shot| render(&shot, &[&layer], &Control::default()).unwrap());
        for (i, colour) in coarse.colours().iter().enumerate() {
            let first = i / 48 * 2 * 96 + i % 48 * 2;
            for k in 0..3 {
                let four = [0, 1, 96, 97].map(|other| linear(fine.colours()[first + other][k]));
                let expected = encoded(four.iter().sum::<f64>() / 4.0);
                assert!((f64::from(colour[k]) - expected).abs() <= 1.01, "{colour:?} {expected}");
            }
        }
    }
}

#[test]
fn nothing_is_seen_where_nothing_is() {
    let random = &mut Random(9);
    let empty = VoxelRecords::from_arrays(&frame(), vec![], vec![], vec![], 0, vec![]).unwrap();
    let outside = {
        let mut list = List::default();
        list.push(0, 0, VoxelKind::Outside, &[]);
        list.records(0)
    };
    let filled = cube(None);
    let away = Clip::new().plane([1.0, 0.0, 0.0, -5.0]).unwrap();
    for camera in cameras(random) {
        let shot = shot(camera);
        let cut = Shot { clip: away.clone(), ..shot.clone() };
        let behind = Camera::new([3.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 0.0, 1.0], camera.lens()).unwrap();
        let behind = Shot { camera: behind, ..shot.clone() };
        let nil = Transfer::new(ColourMap::Grey, [0.0, 1.0], 0.0, 1.0).unwrap();
        for compositing in [Compositing::Exact, Compositing::Published { unit: 1.0 }] {
            for (records, shot, transfer) in [
                (&empty, &shot, transfer()),
                (&outside, &shot, transfer()),
                (&filled, &shot, nil),
                (&filled, &cut, transfer()),
                (&filled, &behind, transfer()),
            ] {
                let layer = VolumeLayer::new(records.view(), transfer).compositing(compositing).unwrap();
                let picture = render(shot, &[&layer], &Control::default()).unwrap();
                assert!(picture.colours().iter().all(|colour| *colour == shot.background));
            }
            let none = vec![0.0; filled.view().len()];
            let layer = VolumeLayer::new(filled.view(), transfer()).compositing(compositing).unwrap();
            let picture = render(&shot, &[&layer.weights(&none).unwrap()], &Control::default()).unwrap();
            assert!(picture.colours().iter().all(|colour| *colour == shot.background));
        }
    }
}

#[test]
fn what_absorbs_everything_hides_everything() {
    let parts = cube(Some(&mut Random(3)));
    let bounds = Bounds::new([-1.0; 3], [1.0; 3]).unwrap();
    for field_of_view in [None, Some(40.0)] {
        let camera = Camera::fitted(&bounds.corners(), [30.0, 40.0], field_of_view, 1.0).unwrap();
        let opaque = transfer().ramp([1.0; 2]).unwrap();
        for compositing in [Compositing::Exact, Compositing::Published { unit: 0.1 }] {
            let layer = VolumeLayer::new(parts.view(), opaque).compositing(compositing).unwrap();
            let shot = Shot { size: [32, 32], ..shot(camera) };
            let picture = render(&shot, &[&layer], &Control::default()).unwrap();
            let [r, g, b] = opaque.colour(&[100.0]);
            assert_eq!(picture.colours()[16 * 32 + 16], [r, g, b, 255]);
            let full = |colour: &&[u8; 4]| **colour == [r, g, b, 255] || **colour == shot.background;
            assert_eq!(picture.colours().iter().filter(full).count(), 1024);
        }
    }
}

#[test]
fn colours_are_those_of_the_map() {
    for map in ColourMap::ALL {
        assert_eq!(ColourMap::from_name(map.name()).unwrap(), map);
        assert_eq!(map.colour(f64::NAN), map.colour(0.0));
        assert_eq!((map.colour(-3.0), map.colour(9.0)), (map.colour(0.0), map.colour(1.0)));
        // A map becomes brighter all the way.
        let brightness = |i: i32| {
            let [r, g, b] = map.colour(f64::from(i) / 255.0).map(linear);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        assert!((0..240).step_by(16).all(|i| brightness(i) < brightness(i + 15)), "{map:?}");
    }
    assert_eq!(ColourMap::default(), ColourMap::Viridis);
    // The values of matplotlib.
    assert_eq!(ColourMap::Viridis.colour(0.0), [0x44, 0x01, 0x54]);
    assert_eq!(ColourMap::Viridis.colour(1.0), [0xfd, 0xe7, 0x25]);
    assert_eq!(ColourMap::Grey.colour(0.5), [128; 3]);
    let transfer =
        Transfer::new(ColourMap::Inferno, [10.0, 20.0], 0.5, 2.0).unwrap().ramp([0.2, 0.6]).unwrap();
    assert_eq!((transfer.map(), transfer.range()), (ColourMap::Inferno, [10.0, 20.0]));
    assert_eq!((transfer.alpha(), transfer.length()), ([0.2, 0.6], 2.0));
    assert_eq!(transfer.colour(&[15.0]), ColourMap::Inferno.colour(0.5));
    assert_eq!(transfer.colour(&[10.0, 20.0]), ColourMap::Inferno.colour(0.0));
    assert_eq!(transfer.colour(&[1.0, 254.6, 300.0]), [1, 255, 255]);
    assert_eq!(transfer.colour(&[7.0, 8.0, -9.0, 3.0]), [7, 8, 0]);
    for nothing in [&[][..], &[f64::NAN], &[f64::NAN; 4], &[1.0, f64::NAN, 2.0]] {
        assert_eq!(transfer.colour(nothing), Transfer::NEUTRAL);
        assert!((transfer.opacity(nothing, 2.0) - 0.6).abs() < 1e-12);
    }
    for (value, alpha) in [(0.0, 0.2), (15.0, 0.4), (99.0, 0.6)] {
        assert!((transfer.opacity(&[value], 2.0) - alpha).abs() < 1e-12);
    }
    assert!((transfer.opacity(&[1.0, 1.0, 1.0, 51.0], 2.0) - 0.12).abs() < 1e-12);
    assert_eq!(transfer.opacity(&[15.0], 0.0), 0.0);
}

#[test]
fn what_is_no_volume_is_refused() {
    let new = |range, alpha, length| Transfer::new(ColourMap::Viridis, range, alpha, length);
    let good = new([0.0, 1.0], 0.5, 1.0).unwrap();
    for bad in [
        new([1.0, 1.0], 0.5, 1.0),
        new([2.0, 1.0], 0.5, 1.0),
        new([f64::NAN, 1.0], 0.5, 1.0),
        new([0.0, f64::INFINITY], 0.5, 1.0),
        new([0.0, 1.0], -0.1, 1.0),
        new([0.0, 1.0], 1.1, 1.0),
        new([0.0, 1.0], f64::NAN, 1.0),
        new([0.0, 1.0], 0.5, 0.0),
        new([0.0, 1.0], 0.5, -1.0),
        new([0.0, 1.0], 0.5, f64::NAN),
        new([0.0, 1.0], 0.5, f64::INFINITY),
        good.ramp([0.5, 1.5]),
        good.ramp([f64::NAN, 0.5]),
    ] {
        assert!(matches!(bad, Err(Error::Argument { .. })), "{bad:?}");
    }
    assert!(ColourMap::from_name("jet").is_err());
    let records = cube(None);
    let layer = VolumeLayer::new(records.view(), good);
    for unit in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(layer.compositing(Compositing::Published { unit }).is_err());
    }
    for weights in [&[][..], &[0.5, 0.5], &[1.5], &[-0.5], &[f64::NAN]] {
        assert!(layer.weights(weights).is_err());
    }
    assert!(layer.weights(&[1.0]).is_ok());
    let camera = cameras(&mut Random(1))[0];
    let (cancelled, control) = (AtomicBool::new(true), Control::threads(1));
    let control = Control { cancel: Some(&cancelled), ..control };
    assert!(matches!(render(&shot(camera), &[&layer], &control), Err(Error::Cancelled)));
}
