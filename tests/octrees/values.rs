//! Dense arrays of values, and channels made from them.

use leafless::attribute::{Channel, FillOptions, FunctionAttribute, ScalarType, ValueType, fill_channel};
use leafless::{Control, Octree, Tag};
use leafless_testkit::{lattice_frame, noise, positions, shapes_of};
use proptest::prelude::*;

pub type Value = Option<[f64; 4]>;

/// The value, or no value, of every finest cell, x fastest.
#[derive(Clone, PartialEq)]
pub struct Values {
    pub depth: u8,
    pub cells: Vec<Value>,
}

impl std::fmt::Debug for Values {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let one = |value: &Value| value.map_or(".".into(), |v| format!("{}", v[0]));
        write!(f, "depth {}: {}", self.depth, self.cells.iter().map(one).collect::<Vec<_>>().join(" "))
    }
}

impl Values {
    pub fn from_fn(depth: u8, value: impl Fn([u32; 3]) -> Value) -> Values {
        Values { depth, cells: positions(depth).map(value).collect() }
    }

    /// Returns the values of a channel's finest cells.
    pub fn of(channel: &Channel) -> Values {
        let view = channel.view().unwrap();
        Values::from_fn(view.frame().depth(), |at| view.value_of_cell(at))
    }

    pub fn at(&self, [x, y, z]: [u32; 3]) -> Value {
        self.cells[((((z << self.depth) | y) << self.depth) | x) as usize]
    }

    pub fn refined(&self, depth: u8) -> Values {
        Values::from_fn(depth, |at| self.at(at.map(|a| a >> (depth - self.depth))))
    }

    /// Fills a channel in the cube `[0, 2^cube]³` from a function of points.
    pub fn channel(&self, cube: u8, kind: ValueType, solid: Option<&Octree>, threads: usize) -> Channel {
        let frame = lattice_frame(cube).with_depth(self.depth).unwrap();
        let attribute =
            FunctionAttribute::new(kind.components(), |p| self.at(frame.cell_of(p).unwrap())).unwrap();
        let options = FillOptions { value_type: kind, frame, solid: solid.map(Octree::view), detail: None };
        let channel = fill_channel(&attribute, &options, &Control::threads(threads)).unwrap();
        channel.view().unwrap().check().unwrap();
        channel
    }
}

pub fn kinds() -> impl Strategy<Value = ValueType> {
    (prop::sample::select(ScalarType::ALL.to_vec()), 1u8..=4)
        .prop_map(|(scalar, components)| ValueType::new(scalar, components).unwrap())
}

/// Generates coarse regions of equal values, regions without values, and fine noise.
pub fn values_of(depth: u8, kind: ValueType) -> impl Strategy<Value = Values> {
    let value = move |n: u64| -> Value {
        let fraction = if kind.scalar() == ScalarType::F32 { 0.25 } else { 0.0 };
        let number = |k: usize| if k < kind.components() { (n + k as u64) as f64 + fraction } else { 0.0 };
        (n != 0).then(|| [0, 1, 2, 3].map(number))
    };
    (shapes_of(depth), any::<u8>(), 0..4u64).prop_map(move |(shape, seed, grain)| {
        let dense = shape.dense();
        Values::from_fn(depth, |at| {
            let coarse = noise(seed, at.map(|a| a >> (depth - depth.min(1)))) % 3;
            value(match dense.at(at) {
                Tag::Empty => coarse,
                Tag::Full => 1 + grain * (noise(seed, at) % 3),
                _ => 2,
            })
        })
    })
}

pub fn values(depths: std::ops::RangeInclusive<u8>) -> impl Strategy<Value = (ValueType, Values)> {
    (kinds(), depths).prop_flat_map(|(kind, depth)| values_of(depth, kind).prop_map(move |v| (kind, v)))
}
