//! Sizes and speed of channels.
//!
//! ```text
//! cargo bench --bench channels
//! ```
//!
//! A ball of 512 cells per axis with channels of four kinds: their sizes, and the times to fill them, query
//! them and carry them through a Boolean.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use leafless::attribute::{
    Attribute, CarryRule, Channel, ChannelOperand, ConstantAttribute, Criterion as SplitBy, Detail,
    FillOptions, FunctionAttribute, ScalarType, ValueRange, ValueType, carry_channel, fill_channel,
};
use leafless::{Bounds, Control, Csg, Frame, Interval, Octree, Rule, build, union};
use std::hint::black_box;

fn ball(centre: f64) -> Octree {
    let frame = Frame::new([0.0; 3], 1.0, 9).expect("a frame");
    let ball = Csg::ball([centre, 0.5, 0.5], 0.37).expect("a ball");
    build(&ball, &frame, Rule::Certified, &Control::default()).expect("an octree")
}

/// Three bodies that meet at slanting planes.
fn body([x, y, z]: [f64; 3]) -> f64 {
    let side = x + 0.3 * y - 0.2 * z;
    if side < 0.45 {
        1.0
    } else if side < 0.62 {
        2.0
    } else {
        3.0
    }
}

fn one(value: f64) -> Option<[f64; 4]> {
    Some([value, 0.0, 0.0, 0.0])
}

fn between(low: [f64; 3], high: [f64; 3], of: impl Fn([f64; 3]) -> f64) -> ValueRange {
    ValueRange::Within([Interval::new(of(low), of(high)).unwrap(); 4])
}

/// The channels of the table, with their names.
fn channels(solid: &Octree, threads: usize) -> Vec<(&'static str, Channel)> {
    let frame = *solid.frame();
    let constant = ConstantAttribute::new(&[200.0, 100.0, 50.0, 255.0]).expect("a value");
    let bodies = FunctionAttribute::new(1, |p| one(body(p))).expect("an attribute");
    let bodies = bodies.with_range(|b: &Bounds| {
        let [low, high] = [[b.min[0], b.min[1], b.max[2]], [b.max[0], b.max[1], b.min[2]]];
        between(low, high, body)
    });
    let linear = |p: [f64; 3]| 20.0 + 80.0 * p[2];
    let gradient = FunctionAttribute::new(1, move |p| one(linear(p))).expect("an attribute");
    let gradient = gradient.with_range(move |b: &Bounds| between(b.min, b.max, linear));
    let noise = FunctionAttribute::new(1, |p| {
        let bits =
            p.iter().fold(1u64, |h, x| (h ^ x.to_bits()).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29));
        one((bits >> 56) as f64)
    })
    .expect("an attribute");
    let tolerant = Detail::new(f64::INFINITY, frame.cell_size(), 1.0, SplitBy::Range).expect("a detail");
    let fill = |attribute: &dyn Attribute, scalar, detail| {
        let value_type = ValueType::new(scalar, attribute.components() as u8).expect("a type");
        let options = FillOptions { value_type, frame, solid: Some(solid.view()), detail };
        fill_channel(attribute, &options, &Control::threads(threads)).expect("a channel")
    };
    vec![
        ("constant, 4 x u8", fill(&constant, ScalarType::U8, None)),
        ("three bodies, u8", fill(&bodies, ScalarType::U8, None)),
        ("gradient, f32, to 1 in 80", fill(&gradient, ScalarType::F32, Some(tolerant))),
        ("gradient, f32, each cell", fill(&gradient, ScalarType::F32, None)),
        ("noise, u8", fill(&noise, ScalarType::U8, None)),
    ]
}

fn sizes(c: &mut Criterion) {
    let solid = ball(0.5);
    let bytes = leafless::file::to_bytes(&solid).expect("a file").len();
    let (_, cells) = solid.statistics().volume_cells();
    println!("solid: {bytes} bytes, {cells} cells");
    let mut group = c.benchmark_group("channels");
    group.sample_size(10);
    for (name, channel) in channels(&solid, 0) {
        let with = solid.with_channel(channel.with_name("a")).expect("a channel");
        let file = leafless::file::to_bytes(&with).expect("a file").len() - bytes;
        println!(
            "{name}: {} values, {} bytes in memory, {file} in the file",
            channel.value_count(),
            channel.bytes()
        );
        let view = channel.view().expect("a view");
        let mut state = 1u64;
        let points: Vec<[f64; 3]> = (0..100_000)
            .map(|_| {
                [0; 3].map(|_| {
                    state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                    0.2 + 0.6 * ((state >> 11) as f64 / (1u64 << 53) as f64)
                })
            })
            .collect();
        group.throughput(Throughput::Elements(points.len() as u64));
        group.bench_function(format!("value at a point: {name}"), |b| {
            b.iter(|| points.iter().filter_map(|&p| view.value_at(p)).map(|v| v[0]).sum::<f64>())
        });
    }
    for threads in [1, 2] {
        group.bench_function(format!("fill all five, {threads} threads"), |b| {
            b.iter(|| black_box(channels(&solid, threads)))
        });
    }
    group.finish();
}

fn carry(c: &mut Criterion) {
    let (left, right) = (ball(0.42), ball(0.58));
    let control = Control::default();
    let both = union(left.view(), right.view(), &control).expect("a union");
    let mut group = c.benchmark_group("carry");
    group.sample_size(10);
    for kind in [0, 1, 4] {
        let (name, a) = channels(&left, 0).swap_remove(kind);
        let (_, b) = channels(&right, 0).swap_remove(kind);
        let operands = [
            ChannelOperand { solid: left.view(), channel: a.view().expect("a view") },
            ChannelOperand { solid: right.view(), channel: b.view().expect("a view") },
        ];
        group.bench_function(name, |bench| {
            bench.iter(|| carry_channel(both.view(), &operands, CarryRule::Left, &Control::threads(1)))
        });
    }
    group.bench_function("the union itself", |bench| {
        bench.iter(|| union(left.view(), right.view(), &Control::threads(1)))
    });
    group.finish();
}

criterion_group!(benches, sizes, carry);
criterion_main!(benches);
