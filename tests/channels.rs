//! Channels against a dense array of values.

mod common;

use leafless::{
    Affine, Attribute, Bounds, CarryRule, Channel, ChannelOperand, Control, Criterion, Csg, Detail, Error,
    FillOptions, Frame, FunctionAttribute, Interval, MovedAttribute, Octree, Rule, ScalarType, Tag,
    ValueRange, ValueType, build, carry_channel, carry_channels, difference, fill_channel, intersection,
    union,
};
use proptest::prelude::*;

/// A value of every finest cell, x fastest.
#[derive(Debug, Clone)]
struct Dense {
    depth: u8,
    values: Vec<Option<[f64; 4]>>,
}

impl Dense {
    fn cells(&self) -> usize {
        1 << self.depth
    }

    fn at(&self, [x, y, z]: [u32; 3]) -> Option<[f64; 4]> {
        self.values[x as usize + self.cells() * (y as usize + self.cells() * z as usize)]
    }

    /// The same on a deeper lattice.
    fn deep(&self, depth: u8, at: [u32; 3]) -> Option<[f64; 4]> {
        self.at(at.map(|a| a >> (depth - self.depth)))
    }
}

fn places(depth: u8) -> impl Iterator<Item = [u32; 3]> {
    let n = 1u32 << depth;
    (0..n).flat_map(move |z| (0..n).flat_map(move |y| (0..n).map(move |x| [x, y, z])))
}

fn frame(depth: u8) -> Frame {
    // No corner but the first is a double.
    Frame::new([-0.3; 3], 1.1, depth).unwrap()
}

fn types() -> impl Strategy<Value = ValueType> {
    (prop::sample::select(ScalarType::ALL.to_vec()), 1u8..=4)
        .prop_map(|(scalar, components)| ValueType::new(scalar, components).unwrap())
}

/// Values in blobs, so that some cells merge, and some have none.
fn dense(depth: u8, kind: ValueType) -> impl Strategy<Value = Dense> {
    let blob = (prop::array::uniform3(0u32..1 << depth), 1u32..1 << depth, prop::option::of(0u8..4));
    prop::collection::vec(blob, 0..6).prop_map(move |blobs| {
        let value = |n: u8| [0, 1, 2, 3].map(|k| if k < kind.components() { f64::from(n + k as u8) } else { 0.0 });
        let of = |at: [u32; 3]| {
            let blob = blobs.iter().rev().find(|(centre, radius, _)| {
                (0..3).all(|axis| at[axis].abs_diff(centre[axis]) < *radius)
            });
            blob.and_then(|&(_, _, value)| value).map(value)
        };
        Dense { depth, values: places(depth).map(of).collect() }
    })
}

fn lattice_of(frame: &Frame, point: [f64; 3]) -> [u32; 3] {
    frame.cell_of(point).unwrap()
}

/// The channel of a dense array, found through points alone.
fn channel(dense: &Dense, kind: ValueType, solid: Option<&Octree>, threads: usize) -> Channel {
    let frame = frame(dense.depth);
    let attribute =
        FunctionAttribute::new(kind.components(), |p| dense.at(lattice_of(&frame, p))).unwrap();
    let solid = solid.map(Octree::view);
    let options = FillOptions { value_type: kind, frame, solid, detail: None };
    let channel = fill_channel(&attribute, &options, &Control::threads(threads)).unwrap();
    channel.view().unwrap().check().unwrap();
    channel
}

/// A random octree, PARTIAL cells included.
fn solid(depth: u8) -> impl Strategy<Value = Octree> {
    common::trees::octree(frame(depth))
}

fn tag(tree: &Octree, depth: u8, at: [u32; 3]) -> Tag {
    let own = tree.frame().depth();
    let of = |at: [u32; 3]| common::trees::tag_at(tree, at);
    if own <= depth {
        return of(at.map(|a| a >> (depth - own)));
    }
    let n = 1u32 << (own - depth);
    let mut tags = (0..n * n * n).map(|k| of([0, 1, 2].map(|i| at[i] * n + k / n.pow(i as u32) % n)));
    let first = tags.next().unwrap();
    if tags.all(|tag| tag == first) { first } else { Tag::Branch }
}
