//! The integer lattice and its place in model space.
//!
//! A [`Frame`] puts a cube (the *universe*) at a place in model space and divides it into 2^depth cells per
//! axis. A [`Cell`] is an octant of that cube at some level. A [`Cube`] is a cell with its frame, and
//! therefore has model coordinates. Inside the library everything is an integer. Frames are the only place
//! where model units and cells meet, and they meet exactly: no rounding error ever puts a point into the
//! wrong cell.
//!
//! Corners, children and bits are numbered the same way everywhere: bit 0 is x, bit 1 is y, bit 2 is z.
//!
//! ```text
//!            6-------7
//!      z    /|      /|       child or corner i of a cube:
//!      |   4-------5 |         x upper half  if i & 1
//!      |   | 2-----|-3         y upper half  if i & 2
//!      |y  |/      |/          z upper half  if i & 4
//!      |/__0-------1
//!        x
//! ```

mod affine;
mod array;
mod axes;
mod ball;
mod bounds;
mod cell;
mod composed;
mod cube;
mod cube_moments;
pub(crate) mod exact;
mod frame;
mod interval;
mod interval_text;
mod inverse;
mod moments;
pub(crate) mod morton;
mod ray;
mod shard;
pub(crate) mod valid;
mod window;

pub use affine::Affine;
pub(crate) use array::Each;
pub(crate) use axes::axes;
pub(crate) use ball::Ball;
pub use bounds::Bounds;
pub use cell::Cell;
pub(crate) use composed::Composed;
pub use cube::Cube;
pub use cube_moments::{CellMoments, CubeMoments};
pub(crate) use cube_moments::{PAIRS, PLACES};
pub use frame::Frame;
pub use interval::{Interval, IntervalEnds};
pub(crate) use inverse::Inverse;
pub use moments::VolumeMoments;
pub use ray::Ray;
pub use shard::Shard;
pub(crate) use valid::{LARGEST, SMALLEST};
pub(crate) use window::Window;

/// The deepest octree: 2^20 = 1 048 576 cells per axis.
pub const MAX_DEPTH: u8 = 20;
