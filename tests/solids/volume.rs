//! Volumes as solids, against dense arrays and exact arithmetic.

use leafless::solid::{Ask, Band, SampleArray, Samples, VoxelGrid};
use leafless::{
    AnySolid, Bounds, Cell, Classifier, Control, Csg, Error, Frame, Membership, Rule, Solid, Tag, Verdict,
    Volume, Worker, build, complement, contains,
};
use leafless_testkit::exact::Exact;
use leafless_testkit::volumes::{KINDS, Sampled, extents, grid};
use leafless_testkit::{Random, alone};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Exact counts for each plane of half cells along an axis: the planes between voxels below or on it, and
/// those below it.
struct Oracle<'s> {
    sampled: &'s Sampled,
    band: Band,
    frame: Frame,
    planes: [Vec<[u32; 2]>; 3],
}

impl<'s> Oracle<'s> {
    fn new(sampled: &'s Sampled, band: Band, grid: &VoxelGrid, frame: &Frame) -> Oracle<'s> {
        let planes = [0, 1, 2].map(|axis| {
            let (corner, spacing) = (Exact::from(grid.corner()[axis]), Exact::from(grid.spacing()[axis]));
            let between: Vec<Exact> = (0..=grid.extents()[axis])
                .map(|j| corner.plus(&spacing.times(&Exact::from(f64::from(j)))))
                .collect();
            let place = |k: u32| {
                let plane = Exact::half_plane(frame, axis, k);
                let count = |least: i32| {
                    between.iter().filter(|other| plane.minus(other).sign() >= least).count() as u32
                };
                [count(0), count(1)]
            };
            (0..=2 * frame.cells()).map(place).collect()
        });
        Oracle { sampled, band, frame: *frame, planes }
    }

    /// Returns the best possible verdict.
    fn tag(&self, cell: Cell) -> Tag {
        let shift = 1 + self.frame.depth() - cell.level;
        // Voxel j lies between planes j and j + 1. The count here is one higher: 0 is below the grid, n + 1
        // above it.
        let range = |axis: usize| {
            let [from, to] =
                [cell.at[axis], cell.at[axis] + 1].map(|a| self.planes[axis][(a << shift) as usize]);
            from[0]..to[1] + 1
        };
        let [x, y, z] = [0, 1, 2].map(range);
        let mut seen = [false; 2];
        for z in z {
            for y in y.clone() {
                for x in x.clone() {
                    let voxel = [x, y, z].map(|a| a.wrapping_sub(1));
                    seen[usize::from(self.sampled.contains(&self.band, voxel))] = true;
                }
            }
        }
        match seen {
            [true, true] => Tag::Partial,
            [false, true] => Tag::Full,
            _ => Tag::Empty,
        }
    }

    /// True if a centre, shifted upward, is inside.
    fn sample(&self, at: [u32; 3]) -> bool {
        let voxel = [0, 1, 2].map(|axis| self.planes[axis][2 * at[axis] as usize + 1][0].wrapping_sub(1));
        self.sampled.contains(&self.band, voxel)
    }
}

/// Frames over a grid: its own frame, others on its lattice, and frames at arbitrary places.
fn frames(random: &mut Random, grid: &VoxelGrid) -> Vec<Frame> {
    let mut frames = Vec::new();
    if let Ok(own) = grid.frame() {
        let depth = own.depth();
        frames.push(own);
        frames.push(own.with_depth(depth.saturating_sub(1 + random.below(3) as u8).max(1)).unwrap());
        if depth < 6 {
            frames.push(own.with_depth(depth + 1).unwrap());
            // So far below the grid's corner that it begins with another voxel.
            let steps = random.below(9) as f64;
            let origin = own.origin().map(|c| c - steps * own.cell_size());
            frames.push(Frame::new(origin, 2.0 * own.edge(), depth + 1).unwrap());
        }
    }
    let Bounds { min, max } = grid.bounds();
    frames.push(Frame::around(min, max, 1 + random.below(6) as u8).unwrap());
    frames.push(Frame::aligned(min, max, 3 + random.below(3) as u8).unwrap());
    // One that cuts the grid.
    let origin = [0, 1, 2].map(|axis| random.between(min[axis] - 3.0, max[axis]));
    frames.push(Frame::new(origin, random.between(0.5, 40.0), 4).unwrap());
    frames
}

/// Checks all verdicts of the worker, at all levels, in both forms.
fn check_verdicts(volume: &Volume<'_>, oracle: &Oracle<'_>) {
    let classifier = volume.on(&oracle.frame, &alone()).unwrap();
    let mut worker = classifier.worker().unwrap();
    let root = worker.root().unwrap();
    assert_eq!(root.tag(), oracle.tag(Cell::ROOT), "{:?}", oracle.frame);
    let mut open = if let Verdict::Partial(()) = root { vec![Cell::ROOT] } else { Vec::new() };
    while let Some(cell) = open.pop() {
        if cell.level == oracle.frame.depth() {
            assert_eq!(worker.sample(cell, &()).unwrap(), Some(oracle.sample(cell.at)), "{cell:?}");
            continue;
        }
        for (octant, verdict) in (0..8).zip(worker.split(cell, &()).unwrap()) {
            let child = cell.child(octant);
            assert_eq!(verdict.tag(), oracle.tag(child), "{child:?} {:?}", oracle.frame);
            if let Verdict::Partial(()) = verdict {
                open.push(child);
            }
        }
        if cell.level + 2 <= oracle.frame.depth() {
            let mut parts = Vec::new();
            let planes = worker.split64(cell, &(), &mut parts).unwrap();
            let mut expected = Vec::new();
            for c in 0..64u8 {
                let grandchild = cell.child(c >> 3).child(c & 7);
                let tag = oracle.tag(grandchild);
                assert_eq!(planes.tag(c.into()), tag, "{grandchild:?} {:?}", oracle.frame);
                if tag == Tag::Partial {
                    expected.push((c, ()));
                }
            }
            assert_eq!(parts, expected);
        }
    }
}

fn check(random: &mut Random, sampled: &Sampled, cubes: bool) {
    let grid = grid(random, sampled.extents, cubes);
    let band = sampled.band(random);
    let volume = Volume::new(sampled.samples(), &grid, band, &Control::default()).unwrap();
    for frame in frames(random, &grid) {
        let oracle = Oracle::new(sampled, band, &grid, &frame);
        check_verdicts(&volume, &oracle);
        let [certified, binary] = [Rule::Certified, Rule::Sampled]
            .map(|rule| build(&volume, &frame, rule, &Control::default()).unwrap());
        for _ in 0..300 {
            let at = [0; 3].map(|_| random.below(frame.cells().into()) as u32);
            assert_eq!(
                certified.view().tag_at(at),
                oracle.tag(Cell { level: frame.depth(), at }),
                "{at:?} {frame:?}"
            );
            assert_eq!(binary.view().tag_at(at) == Tag::Full, oracle.sample(at), "{at:?} {frame:?}");
        }
        let ends = |axis: usize| {
            let planes = &oracle.planes[axis];
            planes[0][1] == 0 && planes[planes.len() - 1][0] == sampled.extents[axis] + 1
        };
        let within = (0..3).all(ends);
        assert_eq!(certified.view().exterior(), if within { Tag::Empty } else { Tag::Partial }, "{frame:?}");
    }
}

#[test]
fn every_kind_of_samples_on_all_frames() {
    let mut random = Random(16);
    for round in 0..24 {
        let extents = extents(&mut random, 40);
        let sampled = Sampled::random(&mut random, extents, round % KINDS);
        check(&mut random, &sampled, round % 3 != 0);
    }
}

#[test]
fn long_and_flat_volumes() {
    let mut random = Random(17);
    for (round, extents) in
        [[70, 5, 66], [130, 3, 1], [1, 1, 90], [2, 257, 3], [1, 1, 1]].into_iter().enumerate()
    {
        for kind in [0, 1 + round % 4] {
            let sampled = Sampled::random(&mut random, extents, kind);
            check(&mut random, &sampled, true);
        }
    }
}

/// The centre rule on the volume's own frame gives the bitmap, and no cell is open.
#[test]
fn own_frames_have_the_bitmap() {
    let mut random = Random(18);
    for round in 0..40 {
        let extents = extents(&mut random, 70);
        let sampled = Sampled::random(&mut random, extents, round % KINDS);
        let band = sampled.band(&mut random);
        // Corners that are not multiples of the spacing.
        let grid = VoxelGrid::with_first_sample(extents, [0.1, 0.7, -3.3], [0.3; 3]).unwrap();
        let volume = Volume::new(sampled.samples(), &grid, band, &Control::default()).unwrap();
        let frame = grid.frame().unwrap();
        assert!(frame.cells() < 2 * extents.into_iter().max().unwrap().max(2));
        let tree = build(&volume, &frame, Rule::Sampled, &Control::default()).unwrap();
        let certified = build(&volume, &frame, Rule::Certified, &Control::default()).unwrap();
        assert!(certified.view().is_binary() && certified.statistics() == tree.statistics());
        let words = frame.cells().div_ceil(64) as usize;
        let mut bits = vec![0; words * (frame.cells() as usize).pow(2)];
        tree.bitmap(frame.depth(), [0; 3], [frame.cells(); 3], &mut bits, None, &Control::default()).unwrap();
        let mut count = 0;
        for z in 0..frame.cells() {
            for y in 0..frame.cells() {
                for x in 0..frame.cells() {
                    let word = bits[(z * frame.cells() + y) as usize * words + x as usize / 64];
                    let found = word >> (x % 64) & 1 != 0;
                    assert_eq!(found, sampled.contains(&band, [x, y, z]), "{:?}", [x, y, z]);
                    count += u64::from(found);
                }
            }
        }
        assert_eq!(count, sampled.count(&band));
    }
}

#[test]
fn another_band_is_as_good_as_new() {
    let mut random = Random(19);
    for round in 0..30 {
        let extents = extents(&mut random, 30);
        let sampled = Sampled::random(&mut random, extents, round % KINDS);
        let grid = grid(&mut random, extents, true);
        let bands = [sampled.band(&mut random), sampled.band(&mut random)];
        let [first, second] =
            bands.map(|band| Volume::new(sampled.samples(), &grid, band, &alone()).unwrap());
        let changed = first.with_band(bands[1], &alone()).unwrap();
        let frame = grid.frame().unwrap();
        let [a, b] =
            [&second, &changed].map(|volume| build(volume, &frame, Rule::Sampled, &alone()).unwrap());
        assert!(leafless::xor(a.view(), b.view(), &alone()).unwrap().view().root_tag() == Tag::Empty);
        assert_eq!(second.fingerprint(), changed.fingerprint());
        assert_eq!(*changed.band(), bands[1]);
    }
}

#[test]
fn padding_costs_nothing() {
    let extents = [200, 300, 400];
    let grid = VoxelGrid::new(extents, [0.0; 3], [1.0; 3]).unwrap();
    let samples = vec![255u8; 200 * 300 * 400];
    let volume = Volume::new(samples[..].into(), &grid, Band::at_least(1.0).unwrap(), &alone()).unwrap();
    assert!(volume.bytes() < samples.len() / 25);
    let frame = grid.frame().unwrap();
    assert_eq!((frame.depth(), frame.edge()), (9, 512.0));
    let tree = build(&volume, &frame, Rule::Sampled, &alone()).unwrap();
    let block = Csg::cuboid([0.0; 3], [200.0, 300.0, 400.0]).unwrap();
    let block = build(&block, &frame, Rule::Certified, &alone()).unwrap();
    assert_eq!(tree.statistics(), block.statistics());
    assert_eq!(tree.view().brick_count(), 0);
    assert_eq!(tree.view().exterior(), Tag::Empty);
}

#[test]
fn the_complement_and_solids_made_of_volumes() {
    let mut random = Random(20);
    for kind in 0..KINDS {
        let sampled = Sampled::random(&mut random, [21, 18, 24], kind);
        let grid = VoxelGrid::new(sampled.extents, [-3.0; 3], [0.25; 3]).unwrap();
        let volume = Volume::new(sampled.samples(), &grid, sampled.band(&mut random), &alone()).unwrap();
        let frame = grid.frame().unwrap();
        let solid = Csg::solid(AnySolid::new(volume.clone()));
        let inverse = build(&solid.complement(), &frame, Rule::Sampled, &alone()).unwrap();
        let tree = build(&volume, &frame, Rule::Sampled, &alone()).unwrap();
        let expected = complement(tree.view(), &alone()).unwrap();
        assert_eq!(inverse.statistics(), expected.statistics());
        // Cut by a plane, on a frame that belongs to neither.
        let half = Csg::half_space([1.0, 2.0, 0.5], 0.75).unwrap();
        let cut = Csg::intersection_of([solid, half]).unwrap();
        let other = Frame::around([-3.0; 3], [3.25; 3], 5).unwrap();
        let cut = build(&cut, &other, Rule::Certified, &alone()).unwrap();
        let whole = build(&volume, &other, Rule::Certified, &alone()).unwrap();
        assert!(cut.statistics().volume().upper <= whole.statistics().volume().upper);
    }
}

#[test]
fn points() {
    let mut random = Random(21);
    for kind in 0..KINDS {
        let sampled = Sampled::random(&mut random, [9, 12, 7], kind);
        let grid = VoxelGrid::new(sampled.extents, [0.1, -0.2, 1e3], [0.1, 0.2, 0.3]).unwrap();
        let band = sampled.band(&mut random);
        let volume = Volume::new(sampled.samples(), &grid, band, &alone()).unwrap();
        let Bounds { min, max } = grid.bounds();
        let frame = Frame::around(min, max, 3).unwrap();
        let mut places = Vec::new();
        let mut points = Vec::new();
        for z in 0..7 {
            for y in 0..12 {
                for x in 0..9 {
                    places.push([x, y, z]);
                    points.push(grid.centre([x, y, z]));
                }
            }
        }
        let mut found = vec![Membership::Undecided; points.len()];
        contains(&volume, &frame, &points, &mut found, &alone()).unwrap();
        for (at, found) in places.into_iter().zip(found) {
            let expected = if sampled.contains(&band, at) { Membership::Inside } else { Membership::Outside };
            assert_eq!(found, expected);
            assert_eq!(volume.contains_voxel(at), found == Membership::Inside);
            let (value, expected) = (volume.sample(at).unwrap(), sampled.at(at).unwrap());
            assert!(value == expected || value.is_nan() && expected.is_nan());
        }
        assert_eq!(volume.sample([9, 0, 0]), None);
    }
}

/// A frame so far from the grid's corner that doubles cannot distinguish voxels.
#[test]
fn far_away() {
    for corner in [1e16, -3e17, 1e22] {
        let grid = VoxelGrid::new([300, 5, 5], [corner; 3], [1.0; 3]).unwrap();
        let samples: Vec<u8> = (0..300 * 25).map(|i| (i % 3) as u8).collect();
        let sampled =
            Sampled { extents: [300, 5, 5], kind: 1, values: samples.iter().map(|&v| v.into()).collect() };
        let band = Band::at_least(1.0).unwrap();
        let volume = Volume::new(samples.into(), &grid, band, &alone()).unwrap();
        for origin in [corner, corner.next_down(), corner.next_up(), 0.0] {
            let Ok(frame) = Frame::new([origin; 3], 0.7 * (corner.abs() * 1e-14).max(70.0), 6) else {
                continue;
            };
            check_verdicts(&volume, &Oracle::new(&sampled, band, &grid, &frame));
        }
    }
}

#[test]
fn interpolation_and_crossings() {
    let mut random = Random(22);
    let mut crossings = [0; KINDS];
    for kind in (0..KINDS).cycle().take(6 * KINDS) {
        let sampled = Sampled::random(&mut random, [8, 9, 10], kind);
        let grid = VoxelGrid::new(sampled.extents, [1.0, 2.0, 3.0], [0.5, 0.25, 1.0]).unwrap();
        let band = sampled.band(&mut random);
        let volume = Volume::new(sampled.samples(), &grid, band, &alone()).unwrap();
        let value = |at: [i32; 3]| sampled.at(at.map(|a| a as u32));
        for _ in 0..2000 {
            let at = sampled.extents.map(|extent| random.below(u64::from(extent) + 1) as i32 - 1);
            let axis = random.below(3) as usize;
            let mut next = at;
            next[axis] += 1;
            let inside = [at, next].map(|at| value(at).is_some_and(|value| band.contains(value)));
            let found = volume.crossing_between(at, axis);
            assert_eq!(found.is_some(), inside[0] != inside[1]);
            let Some(t) = found else { continue };
            crossings[kind] += 1;
            assert!((0.0..=1.0).contains(&t));
            let (Some(a), Some(b)) = (value(at), value(next)) else {
                assert_eq!(t, 0.5);
                continue;
            };
            if kind == 0 || !a.is_finite() || !b.is_finite() {
                assert_eq!(t, 0.5);
                continue;
            }
            // The field reaches the end of the band there.
            let between = a + t * (b - a);
            let end = if (between - band.low()).abs() < (between - band.high()).abs() {
                band.low()
            } else {
                band.high()
            };
            assert!((between - end).abs() <= 1e-12 * (a.abs() + b.abs()), "{a} {b} {t} {band:?}");
            let along =
                |axis: usize| grid.corner()[axis] + grid.spacing()[axis] * (f64::from(at[axis]) + 0.5);
            let mut point = [along(0), along(1), along(2)];
            point[axis] += t * grid.spacing()[axis];
            let interpolated = volume.value_at(point).unwrap();
            assert!(
                (interpolated - between).abs() <= 1e-12 * (a.abs() + b.abs()),
                "{interpolated} {between}"
            );
        }
        assert_eq!(volume.value_at([0.0; 3]), None);
        assert_eq!(volume.crossing_between([0; 3], 3), None);
        assert_eq!(volume.crossing_between([i32::MAX; 3], 0), None);
        // In the middle of eight samples.
        let eight: Vec<f64> = (0..8).map(|k| value([k & 1, k >> 1 & 1, k >> 2]).unwrap()).collect();
        let mean = eight.iter().sum::<f64>() / 8.0;
        let found = volume.value_at([1.5, 2.25, 4.0]).unwrap();
        assert!((found - mean).abs() < 1e-9 || !mean.is_finite() || !found.is_finite(), "{found} {mean}");
    }
    assert!(crossings.iter().all(|&count| count > 100), "{crossings:?}");
    let grid = VoxelGrid::new([1, 1, 1], [0.0; 3], [1.0; 3]).unwrap();
    let one = Volume::new(vec![7u8].into(), &grid, Band::at_least(7.0).unwrap(), &alone()).unwrap();
    assert_eq!(one.value_at([0.9, 0.0, 1.0]), Some(7.0));
    assert_eq!(one.value_range(), Some([7.0, 7.0]));
}

#[test]
fn fingerprints() {
    let grid = VoxelGrid::new([70, 2, 2], [0.0; 3], [1.0; 3]).unwrap();
    let band = Band::at_least(0.5).unwrap();
    let of = |samples: Samples<'static>, grid: &VoxelGrid, band: Band| {
        Volume::new(samples, grid, band, &alone()).unwrap().fingerprint().unwrap()
    };
    let bits = vec![5u64; 8];
    // Bits beyond a row do not count.
    let dirty: Vec<u64> = (0..8).map(|i| if i % 2 == 1 { 5 | 1 << 6 } else { 5 }).collect();
    assert_eq!(
        of(Samples::Bits(bits.clone().into()), &grid, band),
        of(Samples::Bits(dirty.into()), &grid, band)
    );
    let moved = VoxelGrid::new([70, 2, 2], [0.0, 0.0, 1.0], [1.0; 3]).unwrap();
    let all = [
        of(Samples::Bits(bits.clone().into()), &grid, band),
        of(Samples::Bits(bits.clone().into()), &moved, band),
        of(Samples::Bits(bits.into()), &grid, Band::at_most(0.5).unwrap()),
        of(vec![1u8; 280].into(), &grid, band),
        of(vec![1u16; 280].into(), &grid, band),
        of(vec![1i16; 280].into(), &grid, band),
        of(vec![1f32; 280].into(), &grid, band),
    ];
    for (i, a) in all.iter().enumerate() {
        assert!(all.iter().skip(i + 1).all(|b| a != b), "{i}");
    }
    // Bands that this kind of samples cannot distinguish.
    let [a, b] = [0.5, 1.0].map(|low| of(vec![1u8; 280].into(), &grid, Band::at_least(low).unwrap()));
    assert_eq!(a, b);
}

#[test]
fn samples_may_be_borrowed_or_shared() {
    let grid = VoxelGrid::new([4, 4, 4], [0.0; 3], [1.0; 3]).unwrap();
    let band = Band::at_least(1.0).unwrap();
    let values: Vec<u8> = (0..64).map(|i| (i % 5) as u8).collect();
    let borrowed = Volume::new(values[..].into(), &grid, band, &alone()).unwrap();
    let shared: Arc<dyn AsRef<[u8]> + Send + Sync> = Arc::new(values.clone());
    let array = SampleArray::Shared(shared.clone());
    let volume = Volume::new(Samples::U8(array), &grid, band, &alone()).unwrap();
    assert_eq!(borrowed.fingerprint(), volume.fingerprint());
    assert_eq!(borrowed.brick([0; 3]), volume.brick([0; 3]));
    assert_eq!(volume.brick([1, 0, 0]), 0);
    let Samples::U8(array) = volume.samples() else { panic!() };
    assert!(std::ptr::eq(array.values(), (*shared).as_ref()));
}

#[test]
fn what_is_refused() {
    let name = |result: Result<(), Error>| match result {
        Err(Error::Argument { name, .. }) => name,
        other => panic!("{other:?}"),
    };
    let new = |extents, corner, spacing| name(VoxelGrid::new(extents, corner, spacing).map(drop));
    assert_eq!(new([0, 1, 1], [0.0; 3], [1.0; 3]), "extents");
    assert_eq!(new([1, (1 << 20) + 1, 1], [0.0; 3], [1.0; 3]), "extents");
    for wrong in [f64::NAN, f64::INFINITY, 1e-300] {
        assert_eq!(new([1; 3], [0.0, wrong, 0.0], [1.0; 3]), "corner");
        assert_eq!(new([1; 3], [0.0; 3], [1.0, 1.0, wrong]), "spacing");
    }
    for wrong in [0.0, -1.0] {
        assert_eq!(new([1; 3], [0.0; 3], [1.0, 1.0, wrong]), "spacing");
    }
    assert_eq!(name(VoxelGrid::new([1; 3], [0.0; 3], [1.0, 2.0, 1.0]).unwrap().frame().map(drop)), "spacing");
    assert_eq!(name(Band::at_least(f64::NAN).map(drop)), "band");
    assert_eq!(name(Band::between(2.0, 1.0).map(drop)), "band");
    let grid = VoxelGrid::new([65, 2, 2], [0.0; 3], [1.0; 3]).unwrap();
    let band = Band::at_least(1.0).unwrap();
    let volume = |samples: Samples<'static>| name(Volume::new(samples, &grid, band, &alone()).map(drop));
    assert_eq!(volume(vec![0u8; 259].into()), "samples");
    assert_eq!(volume(vec![0f32; 261].into()), "samples");
    assert_eq!(volume(Samples::Bits(vec![0; 5].into())), "samples");
    let cancel = AtomicBool::new(true);
    let control = Control { cancel: Some(&cancel), ..Control::default() };
    let result = Volume::new(vec![0u8; 260].into(), &grid, band, &control);
    assert!(matches!(result, Err(Error::Cancelled)));
    // The largest grid has a frame.
    let large = VoxelGrid::new([1 << 20, 1, 1], [0.0; 3], [1.0; 3]).unwrap();
    assert_eq!(large.frame().unwrap().depth(), 20);
    let samples = vec![1u8; 1 << 20];
    let volume = Volume::new(samples[..].into(), &large, band, &alone()).unwrap();
    let tree = build(&volume, &large.frame().unwrap(), Rule::Certified, &alone()).unwrap();
    assert_eq!(tree.statistics().volume().lower, f64::from(1 << 20));
}

/// A part as in a tomograph: noise, a casting with bores and a pore, in Hounsfield units.
#[test]
fn a_scanned_part() {
    let extents = [96, 80, 64];
    let mut random = Random(23);
    let mut values = Vec::new();
    let mut solid = 0.0;
    for z in 0..64 {
        for y in 0..80 {
            for x in 0..96 {
                let [x, y, z] = [x, y, z].map(|c| f64::from(c) + 0.5);
                let block = 4.2f64.max(0.0) <= x
                    && x <= 91.8
                    && (6.1..=74.3).contains(&y)
                    && (5.0..=59.0).contains(&z);
                let bore = |cx: f64, cy: f64, r: f64| (x - cx).hypot(y - cy) < r;
                let pore = (x - 48.0).hypot(y - 20.0).hypot(z - 30.0) < 5.0;
                let inside = block && !bore(20.0, 40.0, 8.0) && !bore(70.0, 50.0, 13.0) && !pore;
                solid += f64::from(u8::from(inside));
                let value = if inside { 2800.0 } else { -1000.0 };
                values.push((value + random.between(-900.0, 900.0)) as i16);
            }
        }
    }
    let grid = VoxelGrid::with_first_sample(extents, [0.2, 0.2, 0.2], [0.4; 3]).unwrap();
    let volume =
        Volume::new(values.into(), &grid, Band::at_least(900.0).unwrap(), &Control::default()).unwrap();
    let tree = build(&volume, &grid.frame().unwrap(), Rule::Sampled, &Control::default()).unwrap();
    let found = tree.statistics().volume();
    let exact = solid * 0.4f64.powi(3);
    assert!(
        (found.lower - exact).abs() < 1e-9 * exact && (found.upper - exact).abs() < 1e-9 * exact,
        "{found:?}"
    );
    // Rotated about an axis that is no axis of the lattice, the solid still has certain bounds.
    let turned =
        leafless::Affine::new([[0.8, -0.6, 0.0, 3.0], [0.6, 0.8, 0.0, 2.0], [0.0, 0.0, 1.0, 2.0]]).unwrap();
    let moved = AnySolid::new(volume).placed(&turned).unwrap();
    let frame = Frame::new([-20.0; 3], 96.0, 8).unwrap();
    let moved = build(&moved, &frame, Rule::Certified, &Control::default()).unwrap().statistics().volume();
    assert!(moved.contains(exact) && moved.width() < 0.5 * exact, "{moved:?} {exact}");
}

/// `cargo test --release --test solids volume::times -- --ignored --nocapture`.
#[test]
#[ignore = "takes a minute, and prints times"]
fn times() {
    use std::time::Instant;
    for (depth, samples) in [(9, 1), (10, 1)] {
        let n = 1u32 << depth;
        let middle = f64::from(n) / 2.0;
        let mut bytes = vec![0u8; (n as usize).pow(3) / samples];
        for (i, byte) in bytes.iter_mut().enumerate() {
            let [x, y, z] = [i % n as usize, i / n as usize % n as usize, i / (n as usize).pow(2)]
                .map(|c| c as f64 + 0.5 - middle);
            // A ball with a wavy surface.
            let radius = 0.4 * f64::from(n) + 3.0 * (x * 0.05).sin() * (y * 0.07).cos();
            *byte = (128.0 + 4.0 * (radius - (x * x + y * y + z * z).sqrt())).clamp(0.0, 255.0) as u8;
        }
        let grid = VoxelGrid::new([n; 3], [0.0; 3], [1.0; 3]).unwrap();
        let frame = grid.frame().unwrap();
        for threads in [1, 2] {
            let control = Control::threads(threads);
            let best = |work: &mut dyn FnMut()| {
                (0..4)
                    .map(|_| {
                        let start = Instant::now();
                        work();
                        start.elapsed().as_secs_f64() * 1e3
                    })
                    .fold(f64::INFINITY, f64::min)
            };
            let band = Band::at_least(128.0).unwrap();
            let sum = best(&mut || {
                std::hint::black_box(bytes.iter().fold(0u8, |all, &b| all ^ b));
            });
            let prepare = best(&mut || drop(Volume::new(bytes[..].into(), &grid, band, &control).unwrap()));
            let volume = Volume::new(bytes[..].into(), &grid, band, &control).unwrap();
            let other =
                best(&mut || drop(volume.with_band(Band::at_least(130.0).unwrap(), &control).unwrap()));
            let make = best(&mut || drop(build(&volume, &frame, Rule::Sampled, &control).unwrap()));
            let tree = build(&volume, &frame, Rule::Sampled, &control).unwrap();
            let mut bits = vec![0; (n as usize).pow(3) / 64];
            let back = best(&mut || tree.bitmap(depth, [0; 3], [n; 3], &mut bits, None, &control).unwrap());
            let clear = best(&mut || bits.fill(std::hint::black_box(0)));
            tree.bitmap(depth, [0; 3], [n; 3], &mut bits, None, &control).unwrap();
            let bits_of = || Samples::Bits(bits[..].into());
            let half = Band::at_least(0.5).unwrap();
            let from_bits = best(&mut || drop(Volume::new(bits_of(), &grid, half, &control).unwrap()));
            let bitmap = Volume::new(bits_of(), &grid, half, &control).unwrap();
            let again = best(&mut || drop(build(&bitmap, &frame, Rule::Sampled, &control).unwrap()));
            println!(
                "{n}^3, {threads} threads, {} bricks: reading all bytes {sum:.1} ms, volume {prepare:.1}, another band {other:.1}, \
                 octree {make:.1}, to bits {back:.1} (clearing them {clear:.1}), volume of bits {from_bits:.1}, octree of bits \
                 {again:.1}; beside the samples {} bytes",
                tree.view().brick_count(),
                volume.bytes()
            );
        }
    }
}
