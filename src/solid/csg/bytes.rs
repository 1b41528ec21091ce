//! The memory that an expression keeps.

use super::{Csg, Kind, Node};
use crate::memory;
use crate::solid::Solid;
use alloc::sync::Arc;
use alloc::vec::Vec;
use hashbrown::HashSet;

/// The bytes of the reference counts of a shared value.
const COUNTS: usize = 2 * size_of::<usize>();

impl Csg {
    /// Returns about how many bytes the nodes, half-spaces and other solids take: each counted once, however
    /// often it occurs. Works without recursion. Without memory to remember an item, the item is left out.
    pub(super) fn bytes_of_expression(&self) -> u64 {
        let mut sum = 0;
        let mut seen: HashSet<usize> = HashSet::new();
        let mut tasks: Vec<&Arc<Node>> = Vec::new();
        let mut first = |address: usize| seen.try_reserve(1).is_ok() && seen.insert(address);
        if memory::push(&mut tasks, &self.root).is_err() {
            return 0;
        }
        while let Some(node) = tasks.pop() {
            if !first(Arc::as_ptr(node) as usize) {
                continue;
            }
            sum += (COUNTS + size_of::<Node>()) as u64;
            let parts = match &node.kind {
                Kind::HalfSpace(half_space) => {
                    if first(Arc::as_ptr(&half_space.0) as usize) {
                        sum += (COUNTS + half_space.bytes()) as u64;
                    }
                    &[][..]
                }
                Kind::Solid(solid) => {
                    if first(solid.address()) {
                        sum += solid.kept_bytes();
                    }
                    &[]
                }
                Kind::Join(_, parts) => {
                    sum += memory::bytes_of(parts) as u64;
                    parts
                }
                Kind::Complement(part) | Kind::Placed(part, _) => core::slice::from_ref(part),
            };
            if tasks.try_reserve(parts.len()).is_ok() {
                tasks.extend(parts);
            }
        }
        sum
    }
}
