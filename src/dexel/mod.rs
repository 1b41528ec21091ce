//! Tri-directional dexel models: along lattice rays, the intervals that lie inside of a solid.
//!
//! The rays run through the centres of finest cells, along x, y and z. A ray holds sorted, disjoint
//! intervals, so that Booleans are merges of short lists, and a crossing of the surface is known as finely as
//! a fixed-point number can tell. (Van Hook 1986; in three directions Benouamer and Michelucci 1997, Gao,
//! Zhang and Hou 2007.)
//!
//! **Half-open intervals.** An interval holds its start and not its end. The centre of a cell lies inside if
//! an interval holds it; of three directions that of the highest axis. Whoever makes intervals moves an end
//! by at most one unit, so that it says of the centres beside it what the source does; then the three
//! directions agree on all centres, and go on agreeing through every Boolean.
//!
//! From the bottom up, each file uses only files named before it: `place` (positions on a ray), `normal`
//! (unit vectors in 16 or 32 bits), `line` (places in model units), `format` (what is stored), `item` (an
//! interval with all that it may carry), `columns` (arrays of intervals), `view` (borrowed arrays, on which
//! all reading is written), `centres` (which centres of cells lie inside), `occupied` (in which blocks any
//! does), `check` (whether arrays are sound), `arrays` (owned ones), `model` (the tri-dexel model),
//! `assemble` (models from rows of rays), `from_rays` (models from a host's intervals), `beam` (what a solid
//! is asked to fill), `merge` (two rays), `boolean` (models), `change` (what a change in place did), `editor`
//! (changes in place), `statistics`.

mod arrays;
mod assemble;
mod beam;
mod boolean;
mod centres;
mod change;
mod check;
mod columns;
mod editor;
mod format;
mod from_rays;
mod item;
mod line;
mod merge;
mod model;
mod normal;
mod occupied;
mod place;
mod statistics;
mod view;

pub(crate) use arrays::{Form, ModelArrays};
pub(crate) use assemble::{Piece, assembled};
pub use beam::{Beam, BeamEnd};
pub(crate) use beam::{Scratch, first_above};
pub(crate) use centres::{BLOCK, Passage};
pub use change::DexelChange;
pub(crate) use columns::{ColumnsRef, NormalsRef};
pub use editor::DexelEditor;
pub use format::{DexelEnds, DexelFormat, DexelNormals};
pub(crate) use item::Mark;
pub use model::TriDexel;
pub(crate) use normal::{decoded, encoded};
pub(crate) use occupied::Occupied;
pub(crate) use place::{DoubleSpan, FixedSpan, Place, Span, within};
pub use statistics::DexelStatistics;
pub use view::{Dexel, DexelEnd, DexelRays, TriDexelRef};
pub(crate) use view::{OTHERS, Rows, RowsRef, Window, with_rows};
