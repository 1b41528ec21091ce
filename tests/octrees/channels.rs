//! Channels against dense arrays of values.

use crate::values::{Value, Values, kinds, values, values_of};
use leafless::attribute::{
    Attribute, CarryRule, Channel, ChannelOperand, ConstantAttribute, Criterion, Detail, FillOptions,
    FunctionAttribute, MovedAttribute, ScalarType, ValueRange, ValueType, carry_channel, carry_channels,
    fill_channel,
};
use leafless::error::Damage;
use leafless::{
    Affine, Bounds, Control, Csg, Error, Frame, Interval, Metadata, Octree, Rule, Tag, build, difference,
    intersection, union, xor,
};
use leafless_testkit::{Dense, alone, cases, lattice_frame, noise, positions};
use proptest::prelude::*;

/// Returns the tag that a walk down a lattice of `depth` meets at a cell.
fn tag(dense: &Dense, depth: u8, at: [u32; 3]) -> Tag {
    if dense.depth <= depth {
        return dense.at(at.map(|a| a >> (depth - dense.depth)));
    }
    dense.tag_of(leafless::Cell { level: depth, at }).unwrap_or(Tag::Branch)
}

proptest! {
    #![proptest_config(cases(64))]

    #[test]
    fn a_channel_is_its_dense_array((kind, values) in values(1..=5)) {
        let channel = values.channel(5, kind, None, 1);
        prop_assert_eq!(Values::of(&channel), values.clone());
        prop_assert_eq!(&channel, &values.channel(5, kind, None, 3));
        // One value for each run of equal values: never more values than cells that have one.
        let valued = values.cells.iter().flatten().count() as u64;
        prop_assert!(channel.value_count() <= valued);
        prop_assert_eq!(channel.value_count() == 0, valued == 0);
    }

    #[test]
    fn inside_a_solid_a_channel_is_its_dense_array(
        (kind, values) in values(1..=4), depth in 1u8..=5, seed in any::<u8>(),
    ) {
        let shape = leafless_testkit::Shape { depth, tape: (0..60).map(|i| noise(seed, [i, 0, 0]) as u8).collect() };
        let dense = shape.dense();
        let solid = dense.octree();
        let channel = values.channel(depth, kind, Some(&solid), 1);
        prop_assert_eq!(&channel, &values.channel(depth, kind, Some(&solid), 2));
        for (found, at) in Values::of(&channel).cells.into_iter().zip(positions(values.depth)) {
            if tag(&dense, values.depth, at) != Tag::Empty {
                prop_assert_eq!(found, values.at(at));
            }
        }
        // Cells outside the solid add no unnecessary values.
        prop_assert!(channel.value_count() <= values.channel(depth, kind, None, 1).value_count());
    }

    #[test]
    fn booleans_carry_channels(
        (kind, a, b) in (kinds(), 1u8..=4, 1u8..=4)
            .prop_flat_map(|(kind, i, j)| (Just(kind), values_of(i, kind), values_of(j, kind))),
        (p, q) in leafless_testkit::pairs(1..=4),
        rule in prop::sample::select(vec![CarryRule::Left, CarryRule::Right, CarryRule::Max, CarryRule::Mean]),
        operation in 0..4,
    ) {
        let (left, right) = (p.octree(), q.octree());
        let (p_view, q_view, control) = (left.view(), right.view(), alone());
        let result = match operation {
            0 => union(p_view, q_view, &control),
            1 => intersection(p_view, q_view, &control),
            2 => difference(p_view, q_view, &control),
            _ => xor(p_view, q_view, &control),
        };
        let result = result.unwrap();
        let channels = [a.channel(p.depth, kind, None, 1), b.channel(p.depth, kind, None, 1)];
        let views = channels.each_ref().map(|channel| channel.view().unwrap());
        let operands = [
            ChannelOperand { solid: left.view(), channel: views[0] },
            ChannelOperand { solid: right.view(), channel: views[1] },
        ];
        let carried = carry_channel(result.view(), &operands, rule, &alone()).unwrap();
        carried.view().unwrap().check().unwrap();
        prop_assert_eq!(&carried, &carry_channel(result.view(), &operands, rule, &Control::threads(3)).unwrap());
        let depth = a.depth.max(b.depth).max(p.depth);
        prop_assert_eq!(carried.frame().depth(), depth);
        let (result, a, b) = (Dense::of(result.view()).refined(depth), a.refined(depth), b.refined(depth));
        let (p, q) = (p.refined(depth), q.refined(depth));
        for (found, at) in Values::of(&carried).cells.into_iter().zip(positions(depth)) {
            if result.at(at) == Tag::Empty {
                continue;
            }
            let of = |dense: &Dense, values: &Values| values.at(at).filter(|_| dense.at(at) != Tag::Empty);
            let (a, b) = (of(&p, &a), of(&q, &b));
            let both = |f: fn(f64, f64) -> f64| a.zip(b).map(|(a, b)| [0, 1, 2, 3].map(|k| f(a[k], b[k])));
            let expected = match rule {
                CarryRule::Left => a.or(b),
                CarryRule::Right => b.or(a),
                CarryRule::Max => both(f64::max).or(a).or(b),
                CarryRule::Mean => both(|a, b| 0.5 * (a + b)).or(a).or(b),
            };
            prop_assert_eq!(found, expected.map(|value| kind.nearest(value).unwrap()));
        }
    }

    #[test]
    fn values_are_set_in_regions(
        (kind, values) in values(1..=4), depth in 1u8..=4, tape in prop::collection::vec(any::<u8>(), 0..60),
        clear in any::<bool>(),
    ) {
        let region = leafless_testkit::Shape { depth, tape }.dense();
        let channel = values.channel(depth, kind, None, 1);
        let value = (!clear).then(|| [0, 1, 2, 3].map(|k| if k < kind.components() { 2.0 + k as f64 } else { 0.0 }));
        let edited = channel.view().unwrap().with_value_in(region.octree().view(), value, &alone()).unwrap();
        edited.view().unwrap().check().unwrap();
        let depth = depth.max(values.depth);
        let (region, values) = (region.refined(depth), values.refined(depth));
        let expected =
            Values::from_fn(depth, |at| if region.at(at) == Tag::Empty { values.at(at) } else { value });
        prop_assert_eq!(Values::of(&edited), expected);
    }

    #[test]
    fn symmetries_and_shifts_move_channels_exactly(
        (kind, values) in values(2..=4), axes in Just([0usize, 1, 2]).prop_shuffle(), flips in 0u8..8,
    ) {
        let n = f64::from(1u32 << values.depth);
        let channel = values.channel(values.depth, kind, None, 1);
        // From the moved cube back: axis i of the image is axis axes[i] of the point, reversed if flipped.
        let mut rows = [[0.0; 4]; 3];
        for i in 0..3 {
            let flipped = flips >> i & 1 != 0;
            rows[i][axes[i]] = if flipped { -1.0 } else { 1.0 };
            rows[i][3] = if flipped { n } else { 0.0 };
        }
        let back = Affine::new(rows).unwrap();
        let options = FillOptions { value_type: kind, frame: *channel.frame(), solid: None, detail: None };
        let moved = fill_channel(&MovedAttribute::new(channel.clone(), back), &options, &alone()).unwrap();
        let expected = Values::from_fn(values.depth, |at| {
            values.at([0, 1, 2].map(|i| {
                let a = at[axes[i]];
                if flips >> i & 1 != 0 { (1 << values.depth) - 1 - a } else { a }
            }))
        });
        prop_assert_eq!(Values::of(&moved), expected);
    }

    #[test]
    fn ranges_of_channels_are_true(
        (kind, values) in values(1..=4), low in prop::array::uniform3(-1.0..17.0f64),
        size in prop::array::uniform3(0.0..9.0f64), parts in prop::collection::vec(prop::array::uniform3(0.001..0.999f64), 40),
    ) {
        let channel = values.channel(4, kind, None, 1);
        let bounds = Bounds::new(low, [0, 1, 2].map(|k| low[k] + size[k])).unwrap();
        let range = channel.range(&bounds).unwrap();
        for part in parts {
            let point = [0, 1, 2].map(|k| low[k] + part[k] * size[k]);
            if (0..3).any(|k| !(bounds.min[k] < point[k] && point[k] < bounds.max[k])) {
                continue;
            }
            let value = channel.value(point).unwrap();
            match range {
                ValueRange::Unknown => {}
                ValueRange::Nowhere => prop_assert_eq!(value, None),
                ValueRange::Within(ranges) => {
                    let value = value.unwrap();
                    prop_assert!((0..kind.components()).all(|k| ranges[k].contains(value[k])), "{:?} {:?}", value, ranges);
                }
            }
        }
    }
}

fn scalar(scalar: ScalarType) -> ValueType {
    ValueType::new(scalar, 1).unwrap()
}

/// The published variance rule and the certified rule, at a spot that no corner samples.
#[test]
fn variance_misses_a_spot_that_a_range_does_not() {
    let frame = Frame::new([0.0; 3], 8.0, 6).unwrap();
    let inside = |p: [f64; 3]| (0..3).all(|k| (p[k] - 3.3).abs() < 0.4);
    let spot = |p: [f64; 3]| Some([if inside(p) { 1.0 } else { 0.0 }, 0.0, 0.0, 0.0]);
    let range = |bounds: &Bounds| {
        let meets = (0..3).all(|k| bounds.min[k] < 3.7 && bounds.max[k] > 2.9);
        let within = (0..3).all(|k| bounds.min[k] > 2.9 && bounds.max[k] < 3.7);
        let interval = Interval::new(f64::from(u8::from(within)), f64::from(u8::from(meets))).unwrap();
        ValueRange::Within([interval; 4])
    };
    let attribute = FunctionAttribute::new(1, spot).unwrap().with_range(range);
    let fill = |criterion, coarse| {
        let detail = Detail::new(coarse, 0.125, 0.1, criterion).unwrap();
        let options =
            FillOptions { value_type: scalar(ScalarType::U8), frame, solid: None, detail: Some(detail) };
        fill_channel(&attribute, &options, &alone()).unwrap()
    };
    let values =
        |channel: &Channel| Values::of(channel).cells.iter().flatten().filter(|v| v[0] == 1.0).count();
    let exact = positions(6).filter(|at| inside(at.map(|a| (f64::from(a) + 0.5) / 8.0))).count();
    assert!(exact > 0);
    assert_eq!(values(&fill(Criterion::Range, 8.0)), exact);
    assert_eq!(values(&fill(Criterion::Variance, 8.0)), 0);
    // Cells small enough for a corner to fall into the spot find it.
    assert_eq!(values(&fill(Criterion::Variance, 0.5)), exact);
}

/// The sizes in the documentation's table: a uniform part has one value, whatever the depth.
#[test]
fn simple_channels_are_small() {
    let frame = Frame::new([0.0; 3], 1.0, 10).unwrap();
    let fill = |attribute: &dyn Attribute, kind| {
        let options = FillOptions { value_type: kind, frame, solid: None, detail: None };
        fill_channel(attribute, &options, &Control::default()).unwrap()
    };
    let constant = fill(
        &ConstantAttribute::new(&[1.0, 2.0, 3.0, 255.0]).unwrap(),
        ValueType::new(ScalarType::U8, 4).unwrap(),
    );
    assert_eq!(
        (constant.bytes(), constant.value_count(), constant.view().unwrap().element_count()),
        (4, 1, 0)
    );
    // Along z the value changes at planes of the lattice: one row of cells each.
    let layers = FunctionAttribute::new(1, |p| Some([(p[2] * 4.0).floor(), 0.0, 0.0, 0.0])).unwrap();
    let layers = layers.with_range(|b: &Bounds| {
        let (lower, upper) = ((b.min[2] * 4.0).floor(), (b.max[2] * 4.0).next_down().floor());
        ValueRange::Within([Interval::new(lower, upper.max(lower)).unwrap(); 4])
    });
    let layers = fill(&layers, scalar(ScalarType::U16));
    assert_eq!(layers.view().unwrap().element_count(), 1);
    assert!(layers.bytes() < 100, "{}", layers.bytes());
}

#[test]
fn what_is_no_value_is_refused() {
    let frame = lattice_frame(2);
    let fill = |value: [f64; 4], kind: ValueType| {
        let attribute = FunctionAttribute::new(kind.components(), move |_| Some(value)).unwrap();
        let options = FillOptions { value_type: kind, frame, solid: None, detail: None };
        fill_channel(&attribute, &options, &alone()).map(|channel| Values::of(&channel).cells[0].unwrap())
    };
    for kind in ScalarType::ALL {
        for value in [f64::NAN, f64::INFINITY, 1e300, -1e300] {
            let refused = fill([value, 0.0, 0.0, 0.0], scalar(kind));
            assert!(matches!(refused, Err(Error::Argument { name: "value", .. })), "{kind:?} {value}");
        }
    }
    let integer = |value: f64, kind| fill([value, 0.0, 0.0, 0.0], scalar(kind)).map(|v| v[0]);
    assert_eq!(integer(2.5, ScalarType::U8).unwrap(), 2.0);
    assert_eq!(integer(254.7, ScalarType::U8).unwrap(), 255.0);
    assert_eq!(integer(-0.2, ScalarType::U16).unwrap(), 0.0);
    assert!(integer(255.6, ScalarType::U8).is_err() && integer(-0.6, ScalarType::U8).is_err());
    assert_eq!(integer(u32::MAX.into(), ScalarType::U32).unwrap(), f64::from(u32::MAX));
    assert!(integer(-0.0, ScalarType::F32).unwrap().is_sign_positive());
    assert!(ValueType::new(ScalarType::U8, 0).is_err() && ValueType::new(ScalarType::U8, 5).is_err());
    // Numbers beyond a value's components do not count.
    assert_eq!(fill([1.0, f64::NAN, 7.0, 9.0], scalar(ScalarType::F32)).unwrap(), [1.0, 0.0, 0.0, 0.0]);
    let components = ConstantAttribute::new(&[1.0, 2.0]).unwrap();
    let options = FillOptions { value_type: scalar(ScalarType::U8), frame, solid: None, detail: None };
    let refused = fill_channel(&components, &options, &alone());
    assert!(matches!(refused, Err(Error::Argument { name: "components", .. })));
    for wrong in
        [[1.0, 0.0, 0.1], [1.0, 2.0, 0.1], [f64::NAN, 0.1, 0.1], [1.0, 0.5, f64::NAN], [1.0, 0.5, -1.0]]
    {
        assert!(Detail::new(wrong[0], wrong[1], wrong[2], Criterion::Range).is_err(), "{wrong:?}");
    }
}

#[test]
fn channels_lie_in_the_cube_of_their_solid() {
    let solid = build(
        &Csg::ball([1.0; 3], 0.9).unwrap(),
        &Frame::new([0.0; 3], 2.0, 4).unwrap(),
        Rule::Certified,
        &alone(),
    )
    .unwrap();
    let elsewhere =
        Values::from_fn(2, |_| Some([1.0, 0.0, 0.0, 0.0])).channel(3, scalar(ScalarType::U8), None, 1);
    assert!(matches!(solid.with_channel(elsewhere.clone()), Err(Error::FrameMismatch { .. })));
    let view = elsewhere.view().unwrap();
    assert!(matches!(view.with_value_in(solid.view(), None, &alone()), Err(Error::FrameMismatch { .. })));
    let here = elsewhere_in(&solid, 1.0);
    let named = solid.with_channel(here.with_name("b")).unwrap().with_channel(here.with_name("a")).unwrap();
    assert_eq!(named.channels().iter().map(Channel::name).collect::<Vec<_>>(), ["a", "b"]);
    let replaced = named.with_channel(elsewhere_in(&solid, 2.0).with_name("a")).unwrap();
    assert_eq!(replaced.channels().len(), 2);
    assert_eq!(replaced.channel("a").unwrap().view().unwrap().value_at([1.0; 3]).unwrap()[0], 2.0);
    assert!(replaced.without_channel("a").unwrap().channel("a").is_none());
    // Equality of octrees is about cells.
    assert_eq!(solid, replaced);
    let mut crowded = solid.clone();
    for k in 0..256 {
        crowded = crowded.with_channel(here.with_name(&k.to_string())).unwrap();
    }
    assert!(crowded.with_channel(here.with_name("0")).is_ok());
    assert!(matches!(crowded.with_channel(here), Err(Error::Argument { name: "channel", .. })));
}

fn elsewhere_in(solid: &Octree, value: f64) -> Channel {
    let options = FillOptions {
        value_type: scalar(ScalarType::F32),
        frame: *solid.frame(),
        solid: Some(solid.view()),
        detail: None,
    };
    fill_channel(&ConstantAttribute::new(&[value]).unwrap(), &options, &alone()).unwrap()
}

#[test]
fn all_channels_are_carried_by_name() {
    let frame = Frame::new([0.0; 3], 4.0, 5).unwrap();
    let part = |min: f64, names: &[(&str, f64)]| {
        let solid = build(
            &Csg::cuboid([min, 0.0, 0.0], [min + 2.0, 4.0, 4.0]).unwrap(),
            &frame,
            Rule::Certified,
            &alone(),
        )
        .unwrap();
        names.iter().fold(solid.clone(), |octree, (name, value)| {
            let mut facts = Metadata::new();
            facts.insert("name", *name);
            facts.insert("unit", format!("{value}"));
            octree.with_channel(elsewhere_in(&solid, *value).with_metadata(facts)).unwrap()
        })
    };
    let a = part(0.0, &[("heat", 3.0), ("own", 7.0)]);
    let b = part(1.0, &[("heat", 5.0), ("other", 8.0)]);
    let both = union(a.view(), b.view(), &alone()).unwrap();
    let rule = |name: &str| if name == "heat" { CarryRule::Mean } else { CarryRule::Left };
    let both = carry_channels(&both, &[&a, &b], rule, &alone()).unwrap();
    assert_eq!(both.channels().iter().map(Channel::name).collect::<Vec<_>>(), ["heat", "other", "own"]);
    let heat = both.channel("heat").unwrap();
    assert_eq!(heat.metadata().get("unit"), Some("3"));
    let at = |x: f64| heat.view().unwrap().value_at([x, 1.0, 1.0]).unwrap()[0];
    assert_eq!([at(0.5), at(1.5), at(2.5)], [3.0, 4.0, 5.0]);
    assert_eq!(both.channel("own"), a.channel("own"));
    assert!(carry_channel(both.view(), &[], CarryRule::Left, &alone()).is_err());
}

#[test]
fn filling_can_be_cancelled_and_limited() {
    let frame = lattice_frame(6);
    let grain = FunctionAttribute::new(1, |p| Some([(p[0] * 7.0 + p[1] * 3.0 + p[2]) % 11.0, 0.0, 0.0, 0.0]))
        .unwrap();
    let options = FillOptions { value_type: scalar(ScalarType::F32), frame, solid: None, detail: None };
    let flag = std::sync::atomic::AtomicBool::new(true);
    let cancelled = Control { cancel: Some(&flag), ..Control::threads(2) };
    assert!(matches!(fill_channel(&grain, &options, &cancelled), Err(Error::Cancelled)));
    let limited = Control { max_bytes: Some(10_000), ..Control::threads(1) };
    assert!(matches!(fill_channel(&grain, &options, &limited), Err(Error::Limit { what: "bytes", .. })));
    let told = std::sync::Mutex::new(Vec::new());
    let note = |done: f64| told.lock().unwrap().push(done);
    let whole =
        fill_channel(&grain, &options, &Control { progress: Some(&note), ..Control::threads(2) }).unwrap();
    let told = told.into_inner().unwrap();
    assert!(told.len() > 10 && told.iter().all(|&done| (0.0..=1.0).contains(&done)) && told.contains(&1.0));
    assert_eq!(whole, fill_channel(&grain, &options, &Control::threads(1)).unwrap());
}

fn with_channels(depth: u8, channels: &[(&str, &Values, ValueType)]) -> Octree {
    let frame = lattice_frame(depth);
    let ball = Csg::ball([0.5 * frame.edge(); 3], 0.45 * frame.edge()).unwrap();
    let solid = build(&ball, &frame, Rule::Certified, &alone()).unwrap();
    channels.iter().fold(solid, |octree, (name, values, kind)| {
        octree.with_channel(values.channel(depth, *kind, None, 1).with_name(name)).unwrap()
    })
}

fn assert_same(a: &Octree, b: &Octree) {
    assert_eq!(a, b);
    assert_eq!(a.channels(), b.channels());
    for (a, b) in a.channels().iter().zip(b.channels()) {
        assert_eq!(a.metadata(), b.metadata());
        assert_eq!(Values::of(a), Values::of(b));
    }
}

proptest! {
    #![proptest_config(cases(32))]

    #[test]
    fn files_keep_channels(
        (kind, values) in values(1..=4), (other, more) in values(1..=3), depth in 3u8..=5, seed in any::<u32>(),
    ) {
        let octree = with_channels(depth, &[("heat", &values, kind), ("colour", &more, other)]);
        let bytes = leafless::file::to_bytes(&octree).unwrap();
        prop_assert_eq!(leafless::file::probe_bytes(&bytes).unwrap().version, (0, 2));
        leafless::file::verify(&bytes).unwrap();
        let back = leafless::file::from_bytes(&bytes).unwrap();
        assert_same(&octree, &back);
        prop_assert_eq!(&leafless::file::to_bytes(&back).unwrap(), &bytes);
        let statics: &'static [u64] = bytemuck_words(&bytes).leak();
        let in_place = leafless::file::from_static(&bytemuck_bytes(statics)[..bytes.len()]).unwrap();
        assert_same(&octree, &in_place);

        // One changed byte: the file is refused, or reading in place is safe, ends, and gives the same answer
        // for each point in every way.
        let mut bad = bytes.clone();
        let at = seed as usize % bad.len();
        bad[at] ^= 1 << (seed >> 24 & 7);
        prop_assert!(leafless::file::from_bytes(&bad).is_err() || bad == bytes);
        let words = bytemuck_words(&bad).leak();
        if let Ok(read) = leafless::file::from_static(&bytemuck_bytes(words)[..bytes.len()]) {
            for channel in read.channels() {
                let Ok(view) = channel.view() else { continue };
                let _ = Values::of(channel);
                let _ = channel.range(&Bounds::of(view.frame())).unwrap();
                let _ = carry_channel(
                    octree.view(),
                    &[ChannelOperand { solid: octree.view(), channel: view }; 2],
                    CarryRule::Mean,
                    &alone(),
                );
                let _ = view.with_value_in(octree.view(), None, &alone());
                let _ = view.check();
            }
            let _ = leafless::file::to_bytes(&read);
        }
    }
}

fn bytemuck_words(bytes: &[u8]) -> Vec<u64> {
    bytes
        .chunks(8)
        .map(|raw| {
            let mut word = [0; 8];
            word[..raw.len()].copy_from_slice(raw);
            u64::from_ne_bytes(word)
        })
        .collect()
}

fn bytemuck_bytes(words: &'static [u64]) -> &'static [u8] {
    bytemuck::cast_slice(words)
}

#[test]
fn a_file_without_channels_is_of_the_first_version() {
    let octree = with_channels(4, &[]);
    let bytes = leafless::file::to_bytes(&octree).unwrap();
    assert_eq!(leafless::file::probe_bytes(&bytes).unwrap().version, (0, 1));
}

/// Changes a file and repairs its checksums.
fn sealed(mut bytes: Vec<u8>, change: impl FnOnce(&mut Vec<u8>)) -> Vec<u8> {
    change(&mut bytes);
    let field = |bytes: &[u8], at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
    let count = u32::from_le_bytes(bytes[96..100].try_into().unwrap()) as usize;
    for at in (0..count).map(|i| 128 + 48 * i) {
        let start = field(&bytes, at + 16);
        let crc = crc32fast::hash(&bytes[start..start + field(&bytes, at + 24)]);
        bytes[at + 40..at + 44].copy_from_slice(&crc.to_le_bytes());
    }
    let crc = crc32fast::hash(&bytes[128..128 + 48 * count]);
    bytes[100..104].copy_from_slice(&crc.to_le_bytes());
    let crc = crc32fast::hash(&bytes[..124]);
    bytes[124..128].copy_from_slice(&crc.to_le_bytes());
    bytes
}

/// Returns the offset of a section.
fn section(bytes: &[u8], owner: u32, kind: u32) -> usize {
    let sections = leafless::file::probe_bytes(bytes).unwrap().sections;
    let is_it = |section: &&leafless::file::Section| (section.owner, section.kind) == (owner, kind);
    sections.iter().find(is_it).unwrap().offset as usize
}

/// The solid's tree and the record of its channel are both damaged. Every way of verifying reports the same
/// damage first.
#[test]
fn all_ways_in_name_the_same_damage_first() {
    let values = Values::from_fn(2, |[x, ..]| Some([f64::from(x), 0.0, 0.0, 0.0]));
    let octree = with_channels(4, &[("heat", &values, scalar(ScalarType::U8))]);
    let bytes = leafless::file::to_bytes(&octree).unwrap();
    let (objects, rel) = (section(&bytes, 0, 1), section(&bytes, 0, 6));
    let both = sealed(bytes, |bytes| {
        bytes[objects + 128 + 14] = 3;
        bytes[rel] ^= 1;
    });
    let words = bytemuck_words(&both).leak();
    let verified = leafless::file::verify(&bytemuck_bytes(words)[..both.len()]).unwrap_err();
    let copied = leafless::file::from_bytes(&both).unwrap_err();
    assert_eq!(verified.to_string(), copied.to_string());
    assert!(verified.to_string().contains("exterior"), "{verified}");
}

/// Values with bits that the library never stores, and repeated values.
#[test]
fn wrong_values_are_refused_and_read_as_they_stand() {
    let values = Values::from_fn(1, |[x, ..]| Some([f64::from(x) + 0.5, 2.0, 0.0, 0.0]));
    let octree = with_channels(3, &[("v", &values, ValueType::new(ScalarType::F32, 2).unwrap())]);
    let bytes = leafless::file::to_bytes(&octree).unwrap();
    let start = section(&bytes, 1, 16);
    for (at, bits) in [
        (0, f32::NAN.to_bits()),
        (4, 0x7F80_0001),
        (8, f32::INFINITY.to_bits()),
        (12, f32::NEG_INFINITY.to_bits()),
        (4, (-0.0f32).to_bits()),
        (8, 0.5f32.to_bits()),
    ] {
        let bad = sealed(bytes.clone(), |bytes| {
            bytes[start + at..start + at + 4].copy_from_slice(&bits.to_le_bytes());
        });
        let refused = leafless::file::from_bytes(&bad);
        assert!(matches!(refused, Err(Error::Damaged(Damage::Value { .. }))), "{at} {bits:#x}");
        let words = bytemuck_words(&bad).leak();
        let read = leafless::file::from_static(&bytemuck_bytes(words)[..bad.len()]).unwrap();
        let _ = (Values::of(&read.channels()[0]), read.channels()[0].range(&Bounds::of(octree.frame())));
        assert!(leafless::file::to_bytes(&read).is_err());
    }
    for bits in [1u32, 0x8000_0001, f32::MAX.to_bits(), f32::MIN.to_bits()] {
        let other =
            sealed(bytes.clone(), |bytes| bytes[start..start + 4].copy_from_slice(&bits.to_le_bytes()));
        let back = leafless::file::from_bytes(&other).unwrap();
        assert!(leafless::file::to_bytes(&back).unwrap() == other, "{bits:#x}");
    }
}

/// A file with as many channel records as objects are allowed. The 257th is refused, whatever its content.
#[test]
fn thousands_of_records_of_channels_are_refused() {
    let crowd = include_bytes!("../../format_spec/vectors/invalid/channel-count.lfl");
    assert!(leafless::file::from_bytes(crowd).is_err());
    let octree = with_channels(2, &[]);
    let bytes = leafless::file::to_bytes(&octree).unwrap();
    // Records with nothing but a type, at the end of the file, where its objects are now.
    let (count, old) = (4096usize, section(&bytes, 0, 1));
    let mut many = bytes.clone();
    many.resize(bytes.len().next_multiple_of(64), 0);
    let start = many.len();
    many.extend_from_slice(&bytes[old..old + 128]);
    for _ in 1..count {
        let mut record = [0; 128];
        record[0] = 2;
        many.extend(record);
    }
    // The objects come first in a file: the other sections move behind them.
    let sections = u32::from_le_bytes(bytes[96..100].try_into().unwrap()) as usize;
    let mut moved = bytes[..128 + 48 * sections].to_vec();
    moved.resize(moved.len().next_multiple_of(64), 0);
    let put = |at: usize, part: &[u8], moved: &mut Vec<u8>| {
        moved.resize(moved.len().next_multiple_of(64), 0);
        let place = moved.len() as u64;
        moved.extend_from_slice(part);
        moved[at + 16..at + 24].copy_from_slice(&place.to_le_bytes());
    };
    put(128, &many[start..], &mut moved);
    moved[128 + 24..128 + 32].copy_from_slice(&(128 * count as u64).to_le_bytes());
    moved[128 + 32..128 + 40].copy_from_slice(&(count as u64).to_le_bytes());
    for at in (1..sections).map(|i| 128 + 48 * i) {
        let field = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
        let part = bytes[field(at + 16)..field(at + 16) + field(at + 24)].to_vec();
        put(at, &part, &mut moved);
    }
    let length = moved.len() as u64;
    moved[24..32].copy_from_slice(&length.to_le_bytes());
    let file = |minor: u8| sealed(moved.clone(), |bytes| bytes[10] = minor);
    // Version 0.1 does not know the type; version 0.2 refuses the first of the records.
    assert_eq!(leafless::file::from_bytes(&file(1)).unwrap(), octree);
    let refused = leafless::file::from_bytes(&file(2)).unwrap_err();
    assert!(refused.to_string().contains("channel"), "{refused}");
}

/// Channels that share all sections but their values, with each other and with the solid.
#[test]
fn channels_that_share_sections_are_read() {
    let bytes = include_bytes!("../../format_spec/vectors/valid/channels-shared.lfl");
    let octree = leafless::file::from_bytes(bytes).unwrap();
    let [first, second] = octree.channels() else { panic!("two channels") };
    let (first, second) = (Values::of(first), Values::of(second));
    let same = |a: &Value, b: &Value| a.map(|v| v[0] - 2.5) == b.map(|v| v[0]);
    assert!(first.cells.iter().zip(&second.cells).all(|(a, b)| same(a, b)));
    let own = leafless::file::to_bytes(&octree).unwrap();
    assert_same(&octree, &leafless::file::from_bytes(&own).unwrap());
}
