//! Any bytes as an attribute, honest or not, at any place, and its uses: channels, summaries, regions, edits,
//! set operations that carry values, and voxel records. An honest attribute has one value in each unit cell,
//! so that a dense array decides. An attribute with false ranges may hide details, and nothing else.

use super::Bytes;
use leafless::attribute::{
    Attribute, CarryRule, Channel, ChannelOperand, ChannelRef, Criterion, Detail, FillOptions,
    MovedAttribute, ScalarType, ValueRange, ValueType, carry_channel, fill_channel,
};
use leafless::voxel::{VoxelOptions, VoxelRecords};
use leafless::{Affine, Bounds, Control, Csg, Error, Frame, Interval, Octree, Rule, Tag, build, union};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

impl Bytes<'_> {
    /// A number: mostly a small integer, sometimes one that few types can represent.
    fn number(&mut self) -> f64 {
        let odd = [
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            1e300,
            -1e300,
            1e39,
            4_294_967_295.5,
            65_535.5,
            255.5,
            -0.5,
            -0.0,
            0.1,
            f64::MIN_POSITIVE,
            5e-324,
        ];
        match self.byte() {
            code @ 0..200 => (code / 8) as f64,
            code @ 200..242 => (code - 200) as f64 / 4.0 - 2.0,
            code => odd[code - 242],
        }
    }

    /// A length, of any magnitude.
    fn length(&mut self) -> f64 {
        match self.byte() {
            code @ 0..128 => 0.25 * (1 + code % 32) as f64,
            code @ 128..224 => 2f64.powi(code as i32 - 176),
            code => [f64::INFINITY, 0.0, f64::NAN, -1.0, 1e300, 5e-324][code % 6],
        }
    }
}

const CONTROL: Control<'static> = Control {
    threads: 1,
    max_nodes: Some(1 << 15),
    max_bytes: Some(1 << 20),
    max_splits: None,
    cancel: None,
    progress: None,
};

type Value = Option<[f64; 4]>;

/// The way in which an attribute answers queries of ranges.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Range {
    Unknown,
    Honest,
    /// Returns one value of many.
    Narrow,
    /// Returns another value.
    Wrong([f64; 4]),
    /// Returns everything from −∞ to ∞.
    Everything,
    Nowhere,
    /// Alternates with the box.
    Fickle,
}

/// An attribute that has one value in each unit cell. The pattern of cells repeats itself.
struct Cells {
    components: usize,
    values: Vec<Value>,
    range: Range,
    /// Number of values queried.
    asked: AtomicU64,
}

impl Cells {
    fn read(bytes: &mut Bytes<'_>) -> Cells {
        let components = 1 + bytes.below(4);
        let count = 1 + bytes.below(12);
        let value = |bytes: &mut Bytes<'_>| -> Value {
            if bytes.below(8) == 0 {
                return None;
            }
            let mut value = [0.0; 4];
            value[..components].fill_with(|| bytes.number());
            Some(value)
        };
        let values = (0..count).map(|_| value(bytes)).collect();
        let range = match bytes.below(16) {
            0..8 => Range::Honest,
            8 | 9 => Range::Unknown,
            10 => Range::Narrow,
            11 => Range::Wrong([0; 4].map(|_: i32| bytes.number())),
            12 => Range::Everything,
            13 => Range::Nowhere,
            _ => Range::Fickle,
        };
        Cells { components, values, range, asked: AtomicU64::new(0) }
    }

    /// Returns the value in the unit cell of a point. Cells in blocks of two share a value.
    fn at(&self, point: [f64; 3]) -> Value {
        let at = point.map(|c| (c.clamp(-1e6, 1e6).floor() as i64).div_euclid(2));
        let place = (at[0] + 3 * at[1] + 7 * at[2]).rem_euclid(self.values.len() as i64);
        self.values[place as usize]
    }

    fn honest(&self, bounds: &Bounds) -> ValueRange {
        let mut known: Option<ValueRange> = None;
        let cells = |axis: usize| {
            let end = bounds.max[axis].ceil().max(bounds.min[axis].floor() + 1.0);
            bounds.min[axis].floor() as i64..end as i64
        };
        let far = |axis: usize| {
            let (min, max) = (bounds.min[axis], bounds.max[axis]);
            min.abs().max(max.abs()) >= 1e5 || max - min > 64.0
        };
        if (0..3).any(far) {
            return ValueRange::Unknown;
        }
        for z in cells(2) {
            for y in cells(1) {
                for x in cells(0) {
                    let value = self.at([x, y, z].map(|c| c as f64 + 0.5));
                    known = Some(match (known, ValueRange::exactly(value)) {
                        (None, fresh) => fresh,
                        (Some(ValueRange::Nowhere), ValueRange::Nowhere) => ValueRange::Nowhere,
                        (Some(ValueRange::Within(known)), ValueRange::Within(fresh)) => {
                            let joined = |k: usize| {
                                let (a, b) = (known[k], fresh[k]);
                                Interval::new(a.lower.min(b.lower), a.upper.max(b.upper))
                            };
                            let all = Interval::exactly(f64::NAN);
                            ValueRange::Within([0, 1, 2, 3].map(|k| joined(k).unwrap_or(all)))
                        }
                        _ => return ValueRange::Unknown,
                    });
                }
            }
        }
        known.unwrap_or(ValueRange::Unknown)
    }

    fn told(&self, range: Range, bounds: &Bounds) -> ValueRange {
        match range {
            Range::Unknown => ValueRange::Unknown,
            Range::Honest => self.honest(bounds),
            Range::Narrow => ValueRange::exactly(self.at(bounds.min)),
            Range::Wrong(value) => ValueRange::exactly(Some(value)),
            Range::Everything => ValueRange::exactly(Some([f64::NAN; 4])),
            Range::Nowhere => ValueRange::Nowhere,
            Range::Fickle => {
                let odd = bounds.min.iter().chain(&bounds.max).fold(0, |sum, c| sum ^ c.to_bits() >> 44);
                let wrong = Range::Wrong([odd as f64; 4]);
                self.told(
                    [Range::Unknown, Range::Narrow, wrong, Range::Everything, Range::Nowhere]
                        [odd as usize % 5],
                    bounds,
                )
            }
        }
    }
}

impl Attribute for Cells {
    fn components(&self) -> usize {
        self.components
    }

    fn values(&self, points: &[[f64; 3]], values: &mut [Value]) -> Result<(), Error> {
        self.asked.fetch_add(points.len() as u64, Relaxed);
        for (value, &point) in values.iter_mut().zip(points) {
            *value = self.at(point);
        }
        Ok(())
    }

    fn range(&self, bounds: &Bounds) -> Result<ValueRange, Error> {
        Ok(self.told(self.range, bounds))
    }
}

/// An attribute of the points' coordinates. Its ranges are boxes.
struct Places;

impl Attribute for Places {
    fn components(&self) -> usize {
        3
    }

    fn values(&self, points: &[[f64; 3]], values: &mut [Value]) -> Result<(), Error> {
        for (value, &[x, y, z]) in values.iter_mut().zip(points) {
            *value = Some([x, y, z, 0.0]);
        }
        Ok(())
    }

    fn range(&self, bounds: &Bounds) -> Result<ValueRange, Error> {
        let mut ranges = [Interval::exactly(0.0); 4];
        for axis in 0..3 {
            ranges[axis] = Interval::new(bounds.min[axis], bounds.max[axis]).expect("a box");
        }
        Ok(ValueRange::Within(ranges))
    }
}

/// Runs the fuzz target.
pub fn attributes(data: &[u8]) {
    let mut bytes = Bytes(data);
    let bytes = &mut bytes;
    let frame = match bytes.below(6) {
        0 | 1 => Frame::new([0.0; 3], 8.0, 3),
        2 => Frame::new([-4.0; 3], 8.0, 4),
        3 => Frame::new([1.0, 2.0, 3.0], 16.0, 3),
        4 => Frame::new([0.5; 3], 8.0, 2),
        _ => Frame::new([0.1, -0.7, 1e6], 6.5, 3),
    };
    let frame = frame.expect("a good frame");
    let cells = Cells::read(bytes);
    moved_ranges(bytes);
    let (back, exact) = map(bytes);
    let moved = MovedAttribute::new(&cells, back);
    let origin_is_exact = frame.origin()[2] != 1e6;
    let world = World {
        frame,
        attribute: &moved,
        cells: &cells,
        honest: matches!(cells.range, Range::Honest | Range::Unknown),
        exact: exact && origin_is_exact,
    };
    let solid = solid(bytes, &frame);
    let value_type = ValueType::new(
        [ScalarType::U8, ScalarType::U16, ScalarType::U32, ScalarType::F32, ScalarType::F32][bytes.below(5)],
        cells.components as u8,
    )
    .expect("one to four components");
    world.filled(bytes, value_type, &solid);
    world.recorded(bytes, &solid);
}

/// A map from one lattice to another, or an arbitrary map; with a flag for an exact one.
fn map(bytes: &mut Bytes<'_>) -> (Affine, bool) {
    let code = bytes.byte();
    let axes = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]][code % 6];
    let mut rows = [[0.0; 4]; 3];
    let kind = bytes.below(8);
    let scale = if kind == 5 { 2.0 } else { 1.0 };
    for (axis, row) in rows.iter_mut().enumerate() {
        row[axes[axis]] = if (code / 6) >> axis & 1 != 0 { -scale } else { scale };
        row[3] = bytes.below(17) as f64 - 8.0;
    }
    if kind >= 6 {
        for entry in rows.iter_mut().flatten() {
            *entry += [0.0, 0.0, 0.1, 1e-9, 3.0, 1e12, -1e12, 0.5][bytes.below(8)];
        }
        return (Affine::new(rows).unwrap_or(Affine::IDENTITY), false);
    }
    (Affine::new(rows).expect("a good map"), true)
}

/// Checks that the range of a moved attribute contains its values in the box, also at the box's corners.
fn moved_ranges(bytes: &mut Bytes<'_>) {
    let mut rows = [[0.0; 4]; 3];
    for entry in rows.iter_mut().flatten() {
        *entry = match bytes.below(8) {
            0..3 => 0.0,
            3 => 1.0,
            4 => 1.0 + 2f64.powi(-40),
            5 => -2f64.powi(bytes.below(64) as i32),
            6 => 0.1,
            _ => 2f64.powi(bytes.below(64) as i32),
        };
    }
    let Ok(back) = Affine::new(rows) else { return };
    let attribute = MovedAttribute::new(Places, back);
    let min = [0; 3].map(|_: i32| [0.0, 1.0, -1.0, 0.1, 1048576.0, 1e9, -3.5, 7.0][bytes.below(8)]);
    let edge = [1.0, 0.25, 1e-3, 8.0][bytes.below(4)];
    let max = min.map(|c| c + edge);
    let bounds = Bounds::new(min, max).expect("a box");
    let range = attribute.range(&bounds).expect("places are known");
    for k in 0..27 {
        let at = [k % 3, k / 3 % 3, k / 9];
        let point = [0, 1, 2].map(|axis| match at[axis] {
            0 => min[axis],
            1 => max[axis],
            _ => 0.5 * (min[axis] + max[axis]),
        });
        let value = attribute.value(point).expect("places are known").expect("everywhere");
        match range {
            ValueRange::Within(ranges) => {
                assert!(
                    (0..3).all(|k| ranges[k].contains(value[k])),
                    "{value:?} at {point:?}, {ranges:?}, {back:?}"
                );
            }
            ValueRange::Unknown => {}
            ValueRange::Nowhere => panic!("places are everywhere"),
        }
    }
}

/// A certified box with integer or half-integer coordinates. Cells that it cuts are PARTIAL.
fn solid(bytes: &mut Bytes<'_>, frame: &Frame) -> Octree {
    let min = [0, 1, 2].map(|axis| frame.origin()[axis] + bytes.below(12) as f64 / 2.0);
    let max = min.map(|low| low + (1 + bytes.below(12)) as f64 / 2.0);
    let solid = Csg::cuboid(min, max).expect("a good box");
    build(&solid, frame, Rule::Certified, &Control::threads(1)).expect("it can be built")
}

fn tag(tree: &Octree, at: [u32; 3]) -> Tag {
    tree.view().tag_at(at)
}

fn all(frame: &Frame) -> impl Iterator<Item = [u32; 3]> + use<> {
    let n = frame.cells();
    (0..n).flat_map(move |z| (0..n).flat_map(move |y| (0..n).map(move |x| [x, y, z])))
}

fn bits(value: Value) -> Option<[u64; 4]> {
    value.map(|value| value.map(f64::to_bits))
}

struct World<'a> {
    frame: Frame,
    attribute: &'a MovedAttribute<&'a Cells>,
    cells: &'a Cells,
    /// True if the attribute's ranges are true.
    honest: bool,
    /// True if no coordinate is rounded on the way to the attribute's own place.
    exact: bool,
}

impl World<'_> {
    fn centre(&self, at: [u32; 3]) -> [f64; 3] {
        let parts = f64::from(2 * self.frame.cells());
        [0, 1, 2].map(|axis| {
            self.frame.origin()[axis] + self.frame.edge() * ((f64::from(at[axis]) * 2.0 + 1.0) / parts)
        })
    }

    /// Returns the value at the centre of a finest cell.
    fn truth(&self, at: [u32; 3]) -> Value {
        self.attribute.value(self.centre(at)).expect("it has values")
    }

    /// Returns the greatest allowed number of queried values: at the centre of each cell of each level, and
    /// at all corners.
    fn most(&self) -> u64 {
        16 << (3 * self.frame.depth())
    }

    fn filled(&self, bytes: &mut Bytes<'_>, value_type: ValueType, solid: &Octree) {
        let within = bytes.below(2) != 0;
        let options = FillOptions {
            value_type,
            frame: self.frame,
            solid: within.then_some(solid.view()),
            detail: None,
        };
        self.cells.asked.store(0, Relaxed);
        let found = fill_channel(self.attribute, &options, &CONTROL);
        assert!(self.cells.asked.load(Relaxed) <= self.most(), "{:?} times", self.cells.asked);
        // A value that cannot be stored is an error, if a query needed it.
        let needed = |at: [u32; 3]| !within || tag(solid, at) != Tag::Empty;
        let kept = |at: [u32; 3]| self.truth(at).map(|value| value_type.nearest(value)).transpose();
        if self.honest {
            let bad = all(&self.frame).filter(|&at| needed(at)).any(|at| kept(at).is_err());
            assert_eq!(bad, found.is_err(), "{:?}", found.as_ref().err());
        }
        let followed = self.detailed(bytes, value_type, &options);
        let Ok(channel) = found else { return };
        let view = channel.view().expect("a channel in memory");
        view.check().expect("what was filled is sound");
        if self.honest {
            for at in all(&self.frame).filter(|&at| needed(at)) {
                let truth = kept(at).expect("it could be kept");
                assert_eq!(bits(view.value_of_cell(at)), bits(truth), "{at:?}");
            }
        }
        if bytes.below(4) == 0 {
            let two = fill_channel(self.attribute, &options, &Control { threads: 2, ..CONTROL });
            same(view, two.expect("one thread could").view().expect("a channel in memory"));
        }
        summarised(bytes, view, solid);
        banded(bytes, view);
        edited(bytes, view, solid);
        if let Some(other) = followed {
            let (beside, other) =
                (self::solid(bytes, &self.frame), other.view().expect("a channel in memory"));
            self.carried(bytes, [(solid, view), (&beside, other)]);
        }
    }

    /// Checks a channel that follows the attribute only to a given detail.
    fn detailed(
        &self,
        bytes: &mut Bytes<'_>,
        value_type: ValueType,
        options: &FillOptions<'_>,
    ) -> Option<Channel> {
        let (coarse, fine, tolerance) = (bytes.length(), bytes.length(), bytes.length());
        let criterion = [Criterion::Range, Criterion::Variance][bytes.below(2)];
        let detail = Detail::new(coarse, fine, tolerance, criterion).ok()?;
        let options = FillOptions { detail: Some(detail), ..*options };
        self.cells.asked.store(0, Relaxed);
        let found = fill_channel(self.attribute, &options, &CONTROL);
        assert!(self.cells.asked.load(Relaxed) <= self.most(), "{:?} times", self.cells.asked);
        let channel = found.ok()?;
        let view = channel.view().expect("a channel in memory");
        view.check().expect("what was filled is sound");
        let follows = criterion == Criterion::Range && fine <= self.frame.cell_size();
        if self.honest && self.exact && follows {
            let solid = options.solid;
            for at in all(&self.frame) {
                if solid.is_some_and(|solid| solid.tag_at(at) == Tag::Empty) {
                    continue;
                }
                let (truth, found) = (self.truth(at), view.value_of_cell(at));
                let Some(Ok(truth)) = truth.map(|truth| value_type.nearest(truth)) else { continue };
                let found = found.expect("it has a value here");
                for k in 0..value_type.components() {
                    let apart = (truth[k] - found[k]).abs();
                    let rounding = match value_type.scalar() {
                        ScalarType::F32 => 1e-6 * truth[k].abs().max(found[k].abs()),
                        _ => 1.0,
                    };
                    assert!(apart <= tolerance + rounding, "{at:?}: {truth:?}, {found:?}, {detail:?}");
                }
            }
        }
        Some(channel)
    }

    /// Checks two operands with values, and their union with its values.
    fn carried(&self, bytes: &mut Bytes<'_>, operands: [(&Octree, &ChannelRef<'_>); 2]) {
        let rule = [CarryRule::Left, CarryRule::Right, CarryRule::Max, CarryRule::Mean][bytes.below(4)];
        let result = union(operands[0].0.view(), operands[1].0.view(), &CONTROL).expect("enough memory");
        let given = operands.map(|(solid, channel)| ChannelOperand { solid: solid.view(), channel });
        let carried = carry_channel(result.view(), &given, rule, &CONTROL).expect("good operands");
        let carried = carried.view().expect("a channel in memory");
        carried.check().expect("a result of good operands");
        let value_type = carried.value_type();
        for at in all(&self.frame).filter(|&at| tag(&result, at) != Tag::Empty) {
            let values = operands.map(|(solid, channel)| match tag(solid, at) {
                Tag::Empty => None,
                _ => channel.value_of_cell(at),
            });
            let truth = match (values, rule) {
                ([first, second], CarryRule::Left) => first.or(second),
                ([first, second], CarryRule::Right) => second.or(first),
                ([Some(a), Some(b)], CarryRule::Max) => Some([0, 1, 2, 3].map(|k| a[k].max(b[k]))),
                ([Some(a), Some(b)], CarryRule::Mean) => {
                    let mean = [0, 1, 2, 3].map(|k| (a[k] + b[k]) / 2.0);
                    Some(value_type.nearest(mean).expect("between two of the type"))
                }
                ([first, second], _) => first.or(second),
            };
            assert_eq!(bits(carried.value_of_cell(at)), bits(truth), "{rule:?} of {values:?}");
        }
    }

    /// Checks voxel records whose inside is split for the attribute.
    fn recorded(&self, bytes: &mut Bytes<'_>, solid: &Octree) {
        let code = bytes.byte();
        let mut options = VoxelOptions::new().outside(code & 1 != 0).refined(code & 2 != 0);
        let criterion = [Criterion::Range, Criterion::Variance][code / 4 % 2];
        if let Ok(detail) = Detail::new(bytes.length(), bytes.length(), bytes.length(), criterion)
            && code & 8 == 0
        {
            options = options.detail(detail);
        }
        // A detail may require more voxels than memory holds. Then there are no records.
        let control = Control { max_bytes: Some(1 << 18), ..CONTROL };
        let Ok(records) = VoxelRecords::of(solid.view(), &options, Some(self.attribute), &control) else {
            return;
        };
        let records = records.view();
        let mut last = None;
        for (index, record) in records.iter().enumerate() {
            let code = (records.codes()[index], record.cell.level);
            assert!(last < Some(code));
            last = Some(code);
            let half = 0.5 * records.edge(index).expect("one of the records");
            let centre = [0, 1, 2]
                .map(|axis| records.frame().origin()[axis] + f64::from(2 * record.cell.at[axis] + 1) * half);
            let value = self.attribute.value(centre).expect("it has values");
            // A record whose first number is NaN has no value.
            let has_numbers = value.is_none_or(|value| !value.iter().any(|c| c.is_nan()));
            if has_numbers {
                assert_eq!(bits(record.value), bits(value), "{record:?}");
            }
        }
        let again = VoxelRecords::from_arrays(
            records.frame(),
            records.codes().to_vec(),
            records.levels().to_vec(),
            records.kinds().to_vec(),
            records.components(),
            records.values().to_vec(),
        );
        again.expect("what was made is good");
    }
}

fn same(a: &ChannelRef<'_>, b: &ChannelRef<'_>) {
    assert_eq!((a.value_count(), a.element_count()), (b.value_count(), b.element_count()));
    for at in all(a.frame()) {
        assert_eq!(bits(a.value_of_cell(at)), bits(b.value_of_cell(at)));
    }
}

/// Checks sums over finest cells. A box may contain a part of a cell.
fn summarised(bytes: &mut Bytes<'_>, view: &ChannelRef<'_>, solid: &Octree) {
    let frame = view.frame();
    let min = [0; 3].map(|_: i32| bytes.below(64) as f64 / 4.0 - 4.0);
    let max = min.map(|low| low + bytes.below(48) as f64 / 4.0);
    let bounds = (bytes.below(2) != 0).then(|| Bounds::new(min, max).expect("a box"));
    let solid = (bytes.below(2) != 0).then_some(solid);
    let found = view.summary(solid.map(Octree::view), bounds.as_ref(), &CONTROL).expect("good operands");
    let size = frame.cell_size();
    let mut volumes = [0.0; 2];
    let mut without = [0.0; 2];
    let mut integral = [0.0; 4];
    let mut least = [f64::INFINITY; 4];
    let mut most = 0.0f64;
    for at in all(frame) {
        let share = |axis: usize| {
            let low = frame.origin()[axis] + f64::from(at[axis]) * size;
            bounds.map_or(size, |bounds| {
                ((low + size).min(bounds.max[axis]) - low.max(bounds.min[axis])).max(0.0)
            })
        };
        let volume = share(0) * share(1) * share(2);
        let tag = solid.map_or(Tag::Full, |solid| tag(solid, at));
        if tag == Tag::Empty || volume <= 1e-9 {
            continue;
        }
        let sure = if tag == Tag::Full { volume } else { 0.0 };
        match view.value_of_cell(at) {
            Some(value) => {
                volumes = [volumes[0] + sure, volumes[1] + volume];
                for k in 0..view.value_type().components() {
                    integral[k] += sure * value[k];
                    most = most.max(value[k].abs());
                    least[k] = least[k].min(value[k]);
                }
            }
            None => without = [without[0] + sure, without[1] + volume],
        }
    }
    let slack = 1e-6 * frame.edge().powi(3);
    let Some(found) = found else { return assert!(volumes[1] <= slack) };
    let holds = |found: Interval, truth: f64, slack: f64| {
        found.lower <= truth + slack && truth - slack <= found.upper
    };
    for (found, truth) in [(found.volume, volumes), (found.volume_without, without)] {
        assert!(truth.iter().all(|&truth| holds(found, truth, slack)), "{found:?}, {truth:?}");
    }
    for k in 0..view.value_type().components() {
        assert!(holds(found.integral[k], integral[k], slack * (1.0 + most)), "{found:?}, {integral:?}");
        assert!(found.least[k] <= least[k] && found.least[k] <= found.greatest[k], "{found:?}, {least:?}");
        let mean = integral[k] / volumes[0];
        assert!(volumes[0] < slack || holds(found.mean[k], mean, 1e-6 * (1.0 + most)), "{found:?}, {mean}");
    }
}

/// Checks the cells whose values lie in a band.
fn banded(bytes: &mut Bytes<'_>, view: &ChannelRef<'_>) {
    let [low, high] = [(); 2].map(|()| [0; 4].map(|_: i32| bytes.number()));
    let components = view.value_type().components();
    let good = low[..components].iter().chain(&high[..components]).all(|bound| !bound.is_nan());
    let found = view.region(low, high, &CONTROL);
    assert_eq!(good, found.is_ok());
    let Ok(region) = found else { return };
    for at in all(view.frame()) {
        let value = view.value_of_cell(at);
        let inside =
            value.is_some_and(|value| (0..components).all(|k| low[k] <= value[k] && value[k] <= high[k]));
        assert_eq!(tag(&region, at), if inside { Tag::Full } else { Tag::Empty }, "{at:?}: {value:?}");
    }
}

/// Checks an edit that inserts a value.
fn edited(bytes: &mut Bytes<'_>, view: &ChannelRef<'_>, solid: &Octree) {
    let value = (bytes.below(3) != 0).then(|| [0; 4].map(|_: i32| bytes.number()));
    let kept = value.map(|value| view.value_type().nearest(value)).transpose();
    let found = view.with_value_in(solid.view(), value, &CONTROL);
    assert_eq!(found.is_ok(), kept.is_ok());
    let (Ok(edited), Ok(kept)) = (found, kept) else { return };
    let edited = edited.view().expect("a channel in memory");
    edited.check().expect("a result of good operands");
    for at in all(view.frame()) {
        let truth = if tag(solid, at) == Tag::Empty { view.value_of_cell(at) } else { kept };
        assert_eq!(bits(edited.value_of_cell(at)), bits(truth), "{at:?}");
    }
}
