//! Tests of voxels and surfaces along lines of sight, against everything that a line meets, sorted by depth
//! and composited from behind.

use super::{Compositing, VolumeLayer};
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::{Cell, Frame};
use crate::render::camera::View;
use crate::render::light::Light;
use crate::render::stage::{Draw, Painter, Pass, Stage};
use crate::render::tile::Tile;
use crate::render::{Camera, Clip, ColourMap, Lens, Transfer};
use crate::voxel::{LinearCode, VoxelKind, VoxelRecords};
use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;
use glam::{DVec3, DVec4};

/// Surfaces across the view, each with its light, its depth, and the increase of the depth from column to
/// column.
struct Sheets(Vec<(Light, f64, f64)>);

impl Sheets {
    fn depths(&self, column: usize) -> impl Iterator<Item = (DVec4, f64)> {
        let depth = move |(light, depth, rise): &(Light, f64, f64)| {
            (light.0.as_dvec4(), depth + rise * column as f64)
        };
        self.0.iter().map(depth)
    }
}

impl Draw for Sheets {
    fn prepare<'a>(&'a self, _: &Stage<'a>) -> Result<Box<dyn Painter + 'a>, Error> {
        Ok(Box::new(Sheets(self.0.clone())))
    }
}

impl Painter for Sheets {
    fn paint(&self, tile: &mut Tile<'_>) -> Result<(), Error> {
        for sample in 0..tile.opaque.len() {
            for &(light, depth, rise) in &self.0 {
                tile.put(sample, depth + rise * (sample % tile.width()) as f64, light)?;
            }
        }
        Ok(())
    }
}

const BEHIND: [u8; 4] = [0, 100, 0, 255];

/// The light at each sample of a picture of one tile, one sample per pixel.
fn seen(view: &View, clip: &Clip, sheets: &Sheets, volumes: &[VolumeLayer<'_>]) -> Vec<DVec4> {
    let control = Control::threads(1);
    let job = &Job::new(&control);
    let stage = Stage { view, clip, job };
    let mut tile = Tile::new(view, [0; 2], [view.width, view.height], 1).unwrap();
    sheets.prepare(&stage).unwrap().paint(&mut tile).unwrap();
    tile.sort();
    for layer in volumes {
        let painter = layer.prepare(&stage).unwrap();
        assert_eq!(painter.pass(), Pass::Volumes);
        painter.paint(&mut tile).unwrap();
    }
    let mut lights = Vec::new();
    tile.resolve(Light::of(BEHIND), |light, _| lights.push(light.0.as_dvec4()));
    lights
}

fn over(front: DVec4, behind: DVec4) -> DVec4 {
    front + behind * (1.0 - front.w)
}

fn light_of(colour: [u8; 3], opacity: f64) -> DVec4 {
    Light::of([colour[0], colour[1], colour[2], 255]).0.as_dvec4() * opacity
}

/// Inside voxels with the values 0, 1, 2 …
fn records(frame: &Frame, cells: &[Cell]) -> VoxelRecords {
    let number = |cell: &Cell| LinearCode::new(*cell, frame.depth()).unwrap().number();
    VoxelRecords::from_arrays(
        frame,
        cells.iter().map(number).collect(),
        cells.iter().map(|cell| cell.level).collect(),
        vec![VoxelKind::Inside as u8; cells.len()],
        1,
        (0..cells.len()).map(|i| i as f64).collect(),
    )
    .unwrap()
}

#[test]
fn repetitions_are_so_many_layers() {
    let frame = Frame::new([0.0; 3], 1024.0, 10).unwrap();
    let lens = Lens::Parallel(0.5);
    let camera = Camera::new([-9.0, 0.4, 0.3], [0.0, 0.4, 0.3], [0.0, 0.0, 1.0], lens).unwrap();
    let (view, clip) = (&View::new(&camera, [1, 1]), &Clip::new());
    let alpha = 0.0078;
    // All values have one colour.
    let transfer = Transfer::new(ColourMap::Viridis, [1e6, 2e6], alpha, 1.0).unwrap();
    let one = light_of(ColourMap::Viridis.colour(0.0), alpha);
    let none = &Sheets(vec![]);
    let whole = records(&frame, &[Cell::ROOT]);
    let cells: Vec<Cell> = (0..1024).map(|i| Cell { level: 10, at: [i, 0, 0] }).collect();
    let mut expected = Light::of(BEHIND).0.as_dvec4();
    for k in 1..=1024u32 {
        expected = over(one, expected);
        let near = |layer: VolumeLayer<'_>| {
            let found = seen(view, clip, none, &[layer])[0];
            assert!((found - expected).abs().max_element() < 1e-6, "{k}: {found} {expected}");
        };
        let published = |unit: f64| Compositing::Published { unit };
        let whole = VolumeLayer::new(whole.view(), transfer);
        near(whole.compositing(published(1024.0 / f64::from(k))).unwrap());
        // A part of 1024 repetitions.
        near(whole.compositing(published(1.0)).unwrap().weights(&[f64::from(k) / 1024.0]).unwrap());
        near(whole.weights(&[f64::from(k) / 1024.0]).unwrap());
        if k % 32 == 0 || k < 8 {
            let bar = records(&frame, &cells[..k as usize]);
            near(VolumeLayer::new(bar.view(), transfer));
            near(VolumeLayer::new(bar.view(), transfer).compositing(published(1.0)).unwrap());
        }
        if k.is_power_of_two() {
            let level = 10 - k.trailing_zeros() as u8;
            let voxel = records(&frame, &[Cell { level, at: [0; 3] }]);
            near(VolumeLayer::new(voxel.view(), transfer));
            near(VolumeLayer::new(voxel.view(), transfer).compositing(published(1.0)).unwrap());
        }
    }
    for r in [0.25, 1.5, 77.7, 1000.1] {
        let (layer, through) = (VolumeLayer::new(whole.view(), transfer), libm::pow(1.0 - alpha, r));
        let layer = layer.compositing(Compositing::Published { unit: 1024.0 / r }).unwrap();
        let colour = light_of(ColourMap::Viridis.colour(0.0), 1.0 - through);
        let expected = over(colour, Light::of(BEHIND).0.as_dvec4());
        let found = seen(view, clip, none, &[layer])[0];
        assert!((found - expected).abs().max_element() < 1e-6, "{r}");
    }
}

/// Everything that a line of sight meets, each thing at the depth where it begins, composited from behind.
fn expected(
    view: &View,
    sheets: &Sheets,
    cells: &[Cell],
    transfer: &Transfer,
    compositing: Compositing,
    [column, row]: [usize; 2],
    shown: [f64; 2],
) -> DVec4 {
    let (from, along) = view.line(column as f64 + 0.5, row as f64 + 0.5);
    let opaque = sheets.depths(column).filter(|(light, _)| light.w >= 1.0);
    let opaque = opaque.min_by(|a, b| a.1.total_cmp(&b.1));
    let end = opaque.map_or(f64::INFINITY, |(_, depth)| depth);
    let behind = opaque.map_or(Light::of(BEHIND).0.as_dvec4(), |(light, _)| light);
    // Depth, rank at one depth, light.
    let mut met: Vec<(f64, u8, DVec4)> = Vec::new();
    for (light, depth) in sheets.depths(column).filter(|(light, depth)| light.w < 1.0 && *depth < end) {
        met.push((depth, 0, light));
    }
    for (i, cell) in cells.iter().enumerate() {
        let edge = 8.0 / f64::from(1u32 << cell.level);
        let (mut start, mut stop) = (0.0, f64::INFINITY);
        for axis in 0..3 {
            let low = f64::from(cell.at[axis]) * edge;
            let (a, b) = ((low - from[axis]) / along[axis], (low + edge - from[axis]) / along[axis]);
            (start, stop) = (a.min(b).max(start), a.max(b).min(stop));
        }
        let colour = transfer.colour(&[i as f64]);
        match compositing {
            Compositing::Published { unit } => {
                if start < stop && start < end {
                    let opacity = transfer.opacity(&[i as f64], edge / unit * transfer.length());
                    met.push((start, 1, light_of(colour, opacity)));
                }
            }
            Compositing::Exact => {
                (start, stop) = (start.max(shown[0]), stop.min(end).min(shown[1]));
                let mut cuts = vec![start, stop];
                cuts.extend(
                    sheets.depths(column).map(|(_, depth)| depth).filter(|d| start < *d && *d < stop),
                );
                cuts.sort_by(f64::total_cmp);
                for pair in cuts.windows(2).filter(|_| start < stop) {
                    let opacity = transfer.opacity(&[i as f64], (pair[1] - pair[0]) * along.length());
                    met.push((pair[0], 1, light_of(colour, opacity)));
                }
            }
        }
    }
    met.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    met.iter().rev().fold(behind, |behind, &(_, _, light)| over(light, behind))
}

/// Surfaces and voxels alternate along each line of sight, and surfaces lie within voxels.
#[test]
fn surfaces_and_voxels_interleave() {
    let frame = Frame::new([0.0; 3], 8.0, 3).unwrap();
    let mut cells = Vec::new();
    for octant in [0, 1, 2, 4, 7] {
        cells.push(Cell::ROOT.child(octant));
    }
    cells.splice(2..3, (1..8).map(|octant| Cell::ROOT.child(2).child(octant)));
    let list = records(&frame, &cells);
    let transfer = Transfer::new(ColourMap::Viridis, [0.0, 12.0], 0.3, 1.0).unwrap();
    let light = |rgba: [u8; 4]| Light::of(rgba);
    let (red, blue, white) = (light([255, 0, 0, 90]), light([0, 0, 255, 150]), light([255; 4]));
    let all = [
        vec![],
        vec![(red, 9.0, 0.31)],
        vec![(white, 14.0, -0.3)],
        vec![(white, 9.0, 0.2), (red, 8.0, 0.1), (blue, 14.0, -0.4), (red, 3.0, 0.0)],
        vec![(blue, 4.0, 0.9), (red, 24.0, -0.9), (white, 18.0, -0.1), (white, 60.0, 0.0), (red, 12.0, 0.0)],
        vec![(red, 50.0, 0.0), (blue, 2.0, 0.0)],
        // At equal depth the first surface is visible.
        vec![(blue, 11.0, 0.0), (red, 11.0, 0.0)],
    ];
    let up = [0.0, 0.0, 1.0];
    let cameras = [
        Camera::new([-4.0, -6.0, 9.0], [4.1, 3.9, 4.0], up, Lens::Perspective(45.0)),
        Camera::new([14.0, 9.0, -2.0], [4.1, 3.9, 4.0], up, Lens::Parallel(11.0)),
        // Among the voxels.
        Camera::new([3.3, 2.2, 5.1], [7.0, 5.0, 3.0], up, Lens::Perspective(100.0)),
    ];
    let plane = [0.3, -0.2, 0.5, -1.5];
    let cut = Clip::new().plane(plane).unwrap();
    let mut hits = 0;
    for camera in cameras.map(Result::unwrap) {
        let view = &View::new(&camera, [19, 17]);
        for sheets in all.iter().map(|list| Sheets(list.clone())) {
            let check = |clip: &Clip, layers: &[VolumeLayer<'_>], cells: &[Cell], transfer: &Transfer| {
                let found = seen(view, clip, &sheets, layers);
                let mut hits = 0;
                for (i, found) in found.iter().enumerate() {
                    let at = [i % 19, i / 19];
                    let (from, along) = view.line(at[0] as f64 + 0.5, at[1] as f64 + 0.5);
                    let normal = DVec3::new(plane[0], plane[1], plane[2]);
                    let (height, rise) = (normal.dot(from) + plane[3], normal.dot(along));
                    let shown = match clip.is_empty() {
                        true => [0.0, f64::INFINITY],
                        false if rise > 0.0 => [-height / rise, f64::INFINITY],
                        false => [0.0, -height / rise],
                    };
                    let way = layers[0].compositing;
                    let expected = expected(view, &sheets, cells, transfer, way, at, shown);
                    let off = (*found - expected).abs().max_element();
                    assert!(off < 1e-6, "{at:?}: {found} {expected} {off}");
                    hits += u32::from(expected != Light::of(BEHIND).0.as_dvec4());
                }
                hits
            };
            let exact = VolumeLayer::new(list.view(), transfer);
            let published = exact.compositing(Compositing::Published { unit: 1.7 }).unwrap();
            hits += check(&Clip::new(), &[exact], &cells, &transfer);
            hits += check(&Clip::new(), &[published], &cells, &transfer);
            hits += check(&cut, &[exact], &cells, &transfer);
            let opaque = transfer.ramp([1.0; 2]).unwrap();
            let exact = VolumeLayer::new(list.view(), opaque);
            hits += check(&Clip::new(), &[exact], &cells, &opaque);
        }
    }
    assert!(hits > 10_000, "{hits}");
}

/// Two layers, of which the first is in front, with surfaces before, between and behind.
#[test]
fn layers_of_volumes_follow_each_other() {
    let frame = Frame::new([0.0; 3], 8.0, 3).unwrap();
    let cells = [Cell::ROOT.child(0), Cell::ROOT.child(1)];
    let transfer = Transfer::new(ColourMap::Grey, [-1.0, 1.0], 0.3, 1.0).unwrap();
    let both = records(&frame, &cells);
    let [front, back] = [0, 1].map(|i| {
        let number = LinearCode::new(cells[i], 3).unwrap().number();
        let arrays = (vec![number], vec![1], vec![VoxelKind::Inside as u8], vec![i as f64]);
        VoxelRecords::from_arrays(&frame, arrays.0, arrays.1, arrays.2, 1, arrays.3).unwrap()
    });
    let camera = Camera::new([-5.0, 2.3, 2.2], [0.0, 2.1, 2.0], [0.0, 0.0, 1.0], Lens::Perspective(30.0));
    let view = &View::new(&camera.unwrap(), [9, 9]);
    let light = Light::of([255, 0, 0, 90]);
    let depths = [3.0, 6.0, 7.5, 9.0, 10.5, 12.0, 20.0];
    let sheets = &Sheets(depths.map(|depth| (light, depth, 0.0)).to_vec());
    let layers = [front.view(), back.view()].map(|records| VolumeLayer::new(records, transfer));
    let found = seen(view, &Clip::new(), sheets, &layers);
    let one = seen(view, &Clip::new(), sheets, &[VolumeLayer::new(both.view(), transfer)]);
    for (i, (found, one)) in found.iter().zip(one).enumerate() {
        let at = [i % 9, i / 9];
        let expected =
            expected(view, sheets, &cells, &transfer, Compositing::Exact, at, [0.0, f64::INFINITY]);
        assert!(
            (*found - expected).abs().max_element() < 1e-6 && (one - expected).abs().max_element() < 1e-6
        );
    }
}
