//! Voxels as a translucent volume: cells are projected in the order in which they are seen.
//!
//! The records are sorted by code, so that the records of a cell are a range of them. A tile walks through these ranges from
//! the root on, octant by octant from front to back, and leaves out the cells that lie beside the tile. Each voxel that is left
//! is put behind what its samples have seen so far.

use super::clip::Clip;
use super::light::Light;
use super::stage::{Draw, Painter, Pass, Stage};
use super::tile::{Fragment, Tile};
use super::transfer::{Looks, Transfer, absorbed};
use crate::control::Job;
use crate::error::Error;
use crate::lattice::{Cell, MAX_DEPTH};
use crate::memory;
use crate::voxel::{VoxelKind, VoxelRecordsRef};
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::ops::Range;
use glam::DVec3;

/// How voxels of different sizes are put together.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Compositing {
    /// By the exact length of each line of sight's path through a voxel. Clip planes and opaque surfaces cut paths, and
    /// translucent surfaces divide them.
    #[default]
    Exact,
    /// As published (Zhu, Tang and Dong 2002): a voxel is a cell of one unit, repeated edge / unit times, wherever its
    /// projection covers a sample. The transfer function's opacity holds for one repetition, and its length does not count.
    /// A voxel whose centre is cut away is left out. A voxel lies behind a surface if the line of sight enters the voxel behind
    /// the surface; else all of the voxel lies before the surface.
    ///
    /// Let n repetitions of the colour C and the opacity α lie in front of the light D (a colour times its opacity) with the
    /// opacity β. The light of both is D (1 − α)^n + C (1 − (1 − α)^n), and their opacity is 1 − (1 − β)(1 − α)^n. The number n
    /// need not be whole.
    Published {
        /// The edge of a cell that is composited once, in model units: above 0.
        unit: f64,
    },
}

/// A layer that shows voxel records as a translucent volume. Inside and boundary voxels are seen; outside and refined ones
/// are not.
///
/// The weight of a voxel, 0 to 1, scales its optical depth, as if only that part of it were filled. Inside voxels weigh 1 and
/// boundary voxels ½ unless [`weights`](Self::weights) are given.
///
/// The voxels of one layer are seen in their right order from everywhere, also from among them. Of two volume layers, the one
/// that comes first in the picture is taken to be in front.
///
/// O(pairs of a voxel and a sample that it covers + pairs of a voxel and a tile that it meets · levels). Where less than 10⁻⁷
/// of the light comes through, nothing farther away is drawn. So each channel, as linear light from 0 to 1, is within 10⁻⁶ of
/// the truth.
///
/// ```
/// use leafless::{
///     Bounds, Camera, ColourMap, Control, Csg, Frame, Rule, Shot, Transfer, VolumeLayer, VoxelOptions, VoxelRecords,
///     build, render,
/// };
/// let (frame, control) = (Frame::new([-1.0; 3], 2.0, 5)?, Control::default());
/// let ball = build(&Csg::ball([0.0; 3], 0.9)?, &frame, Rule::Certified, &control)?;
/// let records = VoxelRecords::of(ball.view(), &VoxelOptions::new(), None, &control)?;
/// // Voxels without values are grey. Half a model unit absorbs 30 % of the light.
/// let transfer = Transfer::new(ColourMap::Viridis, [0.0, 1.0], 0.3, 0.5)?;
/// let layer = VolumeLayer::new(records.view(), transfer);
/// let camera = Camera::fitted(&Bounds::of(&frame).corners(), [30.0, 20.0], None, 1.0)?;
/// let picture = render(&Shot::new(camera, [64, 64]), &[&layer], &control)?;
/// assert_eq!(picture.colours()[0], [255; 4]);
/// assert!(picture.colours()[64 * 32 + 32][0] < 240);
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct VolumeLayer<'a> {
    records: VoxelRecordsRef<'a>,
    transfer: Transfer,
    weights: Option<&'a [f64]>,
    compositing: Compositing,
}

impl<'a> VolumeLayer<'a> {
    /// A layer of records whose values look as the transfer function says, with exact compositing.
    pub fn new(records: VoxelRecordsRef<'a>, transfer: Transfer) -> VolumeLayer<'a> {
        VolumeLayer { records, transfer, weights: None, compositing: Compositing::Exact }
    }

    /// The same layer with a weight, 0 to 1, for each record: the part of the voxel that is solid. O(records).
    ///
    /// # Errors
    /// [`Error::Argument`] if there are not as many weights as records, or if one is not in [0, 1].
    pub fn weights(self, weights: &'a [f64]) -> Result<VolumeLayer<'a>, Error> {
        let refused = |problem| Err(Error::Argument { name: "weights", problem });
        if weights.len() != self.records.len() {
            return refused("there must be one for each record");
        }
        if !weights.iter().all(|weight| (0.0..=1.0).contains(weight)) {
            return refused("must be 0 to 1");
        }
        Ok(VolumeLayer { weights: Some(weights), ..self })
    }

    /// The same layer with another way of compositing.
    ///
    /// # Errors
    /// [`Error::Argument`] if the unit is not above 0 and finite.
    pub fn compositing(self, compositing: Compositing) -> Result<VolumeLayer<'a>, Error> {
        if let Compositing::Published { unit } = compositing {
            let good = unit > 0.0 && unit.is_finite();
            if !good {
                return Err(Error::Argument { name: "unit", problem: "must be above 0 and finite" });
            }
        }
        Ok(VolumeLayer { compositing, ..self })
    }
}

impl Draw for VolumeLayer<'_> {
    fn prepare<'a>(&'a self, stage: &Stage<'a>) -> Result<Box<dyn Painter + 'a>, Error> {
        let frame = self.records.frame();
        let looks = Looks::new(&self.transfer)?;
        let edges = core::array::from_fn(|level| frame.edge() / (1u64 << level) as f64);
        let origin = DVec3::from(frame.origin());
        Ok(Box::new(Volume { layer: self, looks, origin, edges, clip: stage.clip, job: stage.job }))
    }
}

/// What is left of the light at which samples count as opaque.
const DARK: f64 = 1e-7;

/// A layer that is ready to draw. It reckons with coordinates from the frame's origin on, so that a plane between two voxels
/// is the same number for both.
struct Volume<'a> {
    layer: &'a VolumeLayer<'a>,
    looks: Looks,
    origin: DVec3,
    /// The edge of the cells of each level.
    edges: [f64; MAX_DEPTH as usize + 2],
    clip: &'a Clip,
    job: &'a Job<'a>,
}

impl Painter for Volume<'_> {
    fn pass(&self) -> Pass {
        Pass::Volumes
    }

    fn paint(&self, tile: &mut Tile<'_>) -> Result<(), Error> {
        match self.layer.compositing {
            Compositing::Exact => self.draw::<true>(tile, self.layer.transfer.length()),
            Compositing::Published { unit } => self.draw::<false>(tile, unit),
        }
    }
}

/// A line of sight: point + t · direction has the depth t.
struct SightThrough {
    from: DVec3,
    /// One over each component of the direction.
    inverse: DVec3,
    /// Model units to a unit of depth.
    stretch: f64,
    /// The depths between which there is something to see. Where nothing is seen any more the end is −∞.
    start: f64,
    end: f64,
    /// The next translucent surface among all of the tile, its depth (∞ if there is none), and how many have been passed.
    fragment: usize,
    next: f64,
    passed: u32,
    /// What has been seen, linear, and the share of the light that comes through it.
    light: DVec3,
    through: f64,
}

impl SightThrough {
    /// Puts something of a colour and an opacity behind what has been seen.
    #[inline(always)]
    fn meet(&mut self, colour: DVec3, opacity: f64) {
        self.light += colour * (self.through * opacity);
        self.through *= 1.0 - opacity;
    }

    /// Puts the next translucent surface behind what has been seen.
    fn pass(&mut self, fragments: &[Fragment]) {
        let (now, next) = (&fragments[self.fragment], fragments.get(self.fragment + 1));
        let light = now.light.0.as_dvec4();
        self.light += light.truncate() * self.through;
        self.through *= 1.0 - light.w;
        (self.fragment, self.passed) = (self.fragment + 1, self.passed + 1);
        self.next = next.filter(|next| next.sample == now.sample).map_or(f64::INFINITY, |next| next.depth);
    }
}

/// The points with normal · point + offset ≥ 0.
struct Side {
    normal: DVec3,
    offset: f64,
    /// How far a cube with the half edge 1 reaches along the normal.
    reach: f64,
}

impl Side {
    fn new(normal: DVec3, through: DVec3) -> Side {
        Side { normal, offset: -normal.dot(through), reach: reach(normal) }
    }

    /// Whether some of a cube lies on this side.
    #[inline(always)]
    fn meets(&self, centre: DVec3, half: f64) -> bool {
        self.normal.dot(centre) + self.offset + self.reach * half >= 0.0
    }
}

fn reach(normal: DVec3) -> f64 {
    normal.abs().element_sum()
}

/// The camera in the layer's own coordinates.
struct Place {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
}

/// A cell and the records in it.
struct Part {
    cell: Cell,
    records: Range<usize>,
}

impl Volume<'_> {
    /// Draws a tile, by exact paths or as published. The optical depth of a voxel is that of its value for each `length`.
    fn draw<const EXACT: bool>(&self, tile: &mut Tile<'_>, length: f64) -> Result<(), Error> {
        let records = &self.layer.records;
        let (view, codes, depth) = (tile.view, records.codes(), records.frame().depth());
        let camera = &view.camera;
        let place = Place {
            eye: DVec3::from(camera.eye()) - self.origin,
            right: DVec3::from(camera.right()),
            up: DVec3::from(camera.up()),
            forward: DVec3::from(camera.forward()),
        };
        let mut sides = self.sides(tile, &place)?;
        if codes.is_empty() || !self.is_seen(&sides, Cell::ROOT) {
            return Ok(());
        }
        let mut sights = self.sights::<EXACT>(tile)?;
        let mut open = sights.iter().filter(|sight| sight.start < sight.end).count();
        let far = sights.iter().fold(f64::NEG_INFINITY, |far: f64, sight| far.max(sight.end));
        if far < f64::INFINITY {
            memory::push(&mut sides, Side::new(-place.forward, place.eye + place.forward * far))?;
        }

        // Of each level there are at most seven parts that wait.
        let mut parts = memory::with_capacity(8 * (MAX_DEPTH as usize + 2))?;
        parts.push(Part { cell: Cell::ROOT, records: 0..codes.len() });
        let mut count = 0u32;
        while let Some(Part { mut cell, records: mut range }) = parts.pop() {
            if open == 0 {
                break;
            }
            count = count.wrapping_add(1);
            if count.is_multiple_of(256) {
                self.job.check()?;
            }
            if range.len() == 1 {
                cell = records.cell_at(range.start);
            }
            if !self.is_seen(&sides, cell) {
                continue;
            }
            if records.levels()[range.start] <= cell.level {
                if records.kind_at(range.start) != VoxelKind::Refined {
                    open -= self.voxel::<EXACT>(tile, &place, &mut sights, range.start, cell, length);
                    continue;
                }
                range.start += 1;
                if range.is_empty() {
                    continue;
                }
            }
            if cell.level >= depth {
                continue;
            }
            let middle = |axis: usize| (2 * cell.at[axis] + 1) as f64 * self.edges[cell.level as usize + 1];
            let is_upper = |axis: usize| {
                if view.is_perspective() {
                    place.eye[axis] >= middle(axis)
                } else {
                    place.forward[axis] < 0.0
                }
            };
            let near = (0..3).fold(0, |bits, axis| bits | u8::from(is_upper(axis)) << axis);
            let ends = ends(&codes[range.clone()], 3 * (depth - cell.level - 1));
            // The last one is taken first.
            for octant in (0..8).rev().map(|k| k ^ near) {
                let records = range.start + ends[octant as usize]..range.start + ends[octant as usize + 1];
                if !records.is_empty() {
                    parts.push(Part { cell: cell.child(octant), records });
                }
            }
        }

        for (sample, sight) in sights.iter().enumerate() {
            tile.volume[sample] = Light(sight.light.extend(1.0 - sight.through).as_vec4());
            tile.passed[sample] += sight.passed;
        }
        Ok(())
    }

    /// What a cell must meet to be seen in a tile.
    fn sides(&self, tile: &Tile<'_>, place: &Place) -> Result<Vec<Side>, Error> {
        let clip = self.clip.planes();
        let mut sides = memory::with_capacity(6 + clip.len())?;
        // Half a sample beyond the outermost ones, so that rounding does not count.
        let [left, top] = tile.first.map(f64::from);
        let (from, first) = tile.view.line(left, top);
        let (_, last) = tile.view.line(left + f64::from(tile.size[0]), top + f64::from(tile.size[1]));
        let (end, _) = tile.view.line(left + f64::from(tile.size[0]), top + f64::from(tile.size[1]));
        let (from, end) = (from - self.origin, end - self.origin);
        let lean = |axis: DVec3, along: DVec3| axis - place.forward * along.dot(axis);
        sides.push(Side::new(lean(place.right, first), from));
        sides.push(Side::new(-lean(place.right, last), end));
        sides.push(Side::new(-lean(place.up, first), from));
        sides.push(Side::new(lean(place.up, last), end));
        sides.push(Side::new(place.forward, place.eye));
        for &(normal, offset) in clip {
            sides.push(Side { normal, offset: normal.dot(self.origin) + offset, reach: reach(normal) });
        }
        Ok(sides)
    }

    #[inline]
    fn is_seen(&self, sides: &[Side], cell: Cell) -> bool {
        let (centre, half) = self.cube(cell);
        sides.iter().all(|side| side.meets(centre, half))
    }

    /// The centre of a cell, and half of its edge.
    #[inline(always)]
    fn cube(&self, cell: Cell) -> (DVec3, f64) {
        let half = 0.5 * self.edges[cell.level as usize];
        (DVec3::from(cell.at.map(|a| (2 * a + 1) as f64 * half)), half)
    }

    /// The lines of sight of a tile, with what other layers have left.
    fn sights<const EXACT: bool>(&self, tile: &Tile<'_>) -> Result<Vec<SightThrough>, Error> {
        let mut sights = memory::with_capacity(tile.opaque.len())?;
        let mut first = 0;
        for sample in 0..tile.opaque.len() {
            let (from, along) = tile.line(sample % tile.width(), sample / tile.width());
            let (mut start, mut end) = (0.0, f64::INFINITY);
            if EXACT && !self.clip.is_empty() {
                let shown = self.clip.shown(from, along);
                (start, end) = shown.map_or((0.0, f64::NEG_INFINITY), |shown| (shown.from, shown.to));
            }
            let before = tile.volume[sample].0.as_dvec4();
            let through = 1.0 - before.w;
            end = if through < DARK { f64::NEG_INFINITY } else { end.min(tile.opaque[sample].depth) };
            // The tile's list is sorted by sample.
            let of_sample = |fragment: &&Fragment| fragment.sample as usize == sample;
            let count = tile.fragments[first..].iter().take_while(of_sample).count();
            let fragment = first + (tile.passed[sample] as usize).min(count);
            first += count;
            let next = if fragment < first { tile.fragments[fragment].depth } else { f64::INFINITY };
            sights.push(SightThrough {
                from: from - self.origin,
                inverse: DVec3::from(along.to_array().map(inverse)),
                stretch: along.length(),
                start,
                end,
                fragment,
                next,
                passed: 0,
                light: before.truncate(),
                through,
            });
        }
        Ok(sights)
    }

    /// Draws a voxel. Returns how many samples see nothing beyond it.
    fn voxel<const EXACT: bool>(
        &self,
        tile: &Tile<'_>,
        place: &Place,
        sights: &mut [SightThrough],
        index: usize,
        cell: Cell,
        length: f64,
    ) -> usize {
        let records = &self.layer.records;
        let usual = match records.kind_at(index) {
            VoxelKind::Inside => 1.0,
            VoxelKind::Boundary => 0.5,
            VoxelKind::Outside | VoxelKind::Refined => return 0,
        };
        let weight = self.layer.weights.map_or(usual, |weights| weights[index]);
        let (colour, depth) = self.looks.of(records.numbers_at(index));
        if weight == 0.0 || depth == 0.0 {
            return 0;
        }
        let (centre, half) = self.cube(cell);
        // The optical depth of a model unit, or of the voxel.
        let depth = depth * weight / length * if EXACT { 1.0 } else { 2.0 * half };
        if !EXACT && !self.clip.keeps(centre + self.origin) {
            return 0;
        }
        let opacity = if EXACT { 0.0 } else { absorbed(depth) };
        let edge = self.edges[cell.level as usize];
        let (low, high) = (
            DVec3::from(cell.at.map(|a| f64::from(a) * edge)),
            DVec3::from(cell.at.map(|a| f64::from(a + 1) * edge)),
        );
        let [columns, rows] = covered(tile, place, centre, half);
        let mut closed = 0;
        for row in rows {
            let first = row * tile.width();
            for sight in &mut sights[first + columns.start..first + columns.end] {
                let (a, b) = ((low - sight.from) * sight.inverse, (high - sight.from) * sight.inverse);
                let mut from = a.min(b).max_element().max(sight.start);
                let mut to = a.max(b).min_element();
                if EXACT {
                    to = to.min(sight.end);
                }
                if from >= to || from >= sight.end {
                    continue;
                }
                if EXACT {
                    while sight.next < to {
                        if sight.next > from {
                            sight.meet(colour, absorbed(depth * ((sight.next - from) * sight.stretch)));
                            from = sight.next;
                        }
                        sight.pass(&tile.fragments);
                    }
                    sight.meet(colour, absorbed(depth * ((to - from) * sight.stretch)));
                } else {
                    while sight.next <= from {
                        sight.pass(&tile.fragments);
                    }
                    sight.meet(colour, opacity);
                }
                if sight.through < DARK {
                    sight.end = f64::NEG_INFINITY;
                    closed += 1;
                }
            }
        }
        closed
    }
}

/// One over a component of a direction. A line along a plane between voxels belongs to the upper one: it counts as rising, so
/// slowly that it stays where it is.
fn inverse(component: f64) -> f64 {
    const LEAST: f64 = 1e-300;
    1.0 / if component.abs() < LEAST { LEAST } else { component }
}

/// The columns and rows of samples that may see a cube.
fn covered(tile: &Tile<'_>, place: &Place, centre: DVec3, half: f64) -> [Range<usize>; 2] {
    /// In pixels: far more than rounding, far less than a sample.
    const SLACK: f64 = 1e-3;
    let from = centre - place.eye;
    let at = DVec3::new(from.dot(place.right), from.dot(place.up), from.dot(place.forward));
    let size = half * DVec3::new(reach(place.right), reach(place.up), reach(place.forward));
    let (near, far) = (at.z - size.z, at.z + size.z);
    if tile.view.is_perspective() && near <= far * 1e-9 {
        return [0..tile.width(), 0..tile.height()];
    }
    let corner = |x: f64, y: f64, z: f64| tile.view.place(DVec3::new(x, y, z));
    let (left, right, bottom, top) = (at.x - size.x, at.x + size.x, at.y - size.y, at.y + size.y);
    let ([x0, y0], [x1, y1]) = (corner(left, top, near), corner(right, bottom, near));
    let ([u0, v0], [u1, v1]) = (corner(left, top, far), corner(right, bottom, far));
    [
        tile.between(0, x0.min(u0) - SLACK, x1.max(u1) + SLACK),
        tile.between(1, y0.min(v0) - SLACK, y1.max(v1) + SLACK),
    ]
}

/// Where the records of each octant end, as the digit at `shift` of their codes says; the first is 0.
fn ends(codes: &[u64], shift: u8) -> [usize; 9] {
    let digit = |code: u64| (code >> shift & 7) as usize;
    let mut ends = [0; 9];
    if codes.len() <= 24 {
        for &code in codes {
            ends[digit(code) + 1] += 1;
        }
        for k in 1..9 {
            ends[k] += ends[k - 1];
        }
    } else {
        for k in 0..8 {
            let rest = &codes[ends[k]..];
            ends[k + 1] = ends[k] + rest.partition_point(|&code| digit(code) <= k);
        }
    }
    ends
}

#[cfg(test)]
mod tests {
    use super::super::camera::{Camera, Lens, View};
    use super::super::transfer::ColourMap;
    use super::*;
    use crate::control::Control;
    use crate::lattice::Frame;
    use crate::voxel::{LinearCode, VoxelRecords};
    use alloc::vec;
    use glam::DVec4;

    /// Surfaces across the view, each with its light, its depth, and how fast that rises from column to column.
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

    /// What is seen at each sample of a picture of one tile, one sample a pixel.
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

    /// All that a line of sight meets, each thing at the depth where it begins, put together from behind.
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

    /// Surfaces and voxels take turns along each line of sight, and surfaces lie within voxels.
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
            vec![
                (blue, 4.0, 0.9),
                (red, 24.0, -0.9),
                (white, 18.0, -0.1),
                (white, 60.0, 0.0),
                (red, 12.0, 0.0),
            ],
            vec![(red, 50.0, 0.0), (blue, 2.0, 0.0)],
            // Of two at one depth the first is seen.
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
}
