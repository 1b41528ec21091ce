//! Instructions of typical work on one thread, counted by callgrind and compared with the recorded counts.
//!
//! ```text
//! cargo bench --bench instructions               # prints each count beside the recorded one
//! cargo bench --bench instructions -- --record   # writes the counts to benches/instructions.txt
//! cargo bench --bench instructions -- measure    # only the workloads whose names contain "measure"
//! ```
//!
//! Counts are repeatable on any machine, whatever else it does, because callgrind simulates a processor. They
//! differ between compilers, and between processors that offer other instructions ([`leafless`] chooses some
//! loops at run time). A change of more than 3 % ends the program with a failure. It is either mended, or
//! recorded and explained in the changelog.
//!
//! Only the workload itself is counted, not the making of its operands: callgrind collects inside of
//! [`counted`].

use leafless::exchange::{self, MeshFormat, MeshOptions};
use leafless::mesh::FillRule;
use leafless::op::{DexelOptions, simplify_none};
use leafless::*;
use std::hint::black_box;

fn main() {}
