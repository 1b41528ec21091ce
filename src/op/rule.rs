//! Rules for resolving undecided cells when a tree is built.

use crate::error::Error;
use crate::octree::block::Cells;
use crate::octree::{Block, Planes, Proof};

/// A rule for resolving the PARTIAL cells of the finest level when a tree is built.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Rule {
    /// PARTIAL cells stay: the tree holds the certified bounds.
    #[default]
    Certified,
    /// The cell's centre decides. The tree is binary and lies between `Inner` and `Outer`.
    Sampled,
    /// PARTIAL cells become EMPTY: the tree is binary and contained in the solid.
    Inner,
    /// PARTIAL cells become FULL: the tree is binary and contains the solid.
    Outer,
}

impl Rule {
    /// Returns whether no cell is left undecided.
    pub fn is_binary(self) -> bool {
        self != Rule::Certified
    }

    /// The proof of the resolved cells, if `source` is the proof of the solid's verdicts.
    pub fn proof(self, source: Proof) -> Proof {
        let full = source.full && matches!(self, Rule::Certified | Rule::Inner);
        let empty = source.empty && matches!(self, Rule::Certified | Rule::Outer);
        Proof::new(full, empty).moved(source.displacement())
    }

    /// Resolves cells without samples.
    ///
    /// # Errors
    /// [`Error::NotSampled`] if the rule needs their centres.
    pub(super) fn resolved(self, planes: Planes) -> Result<Planes, Error> {
        match self {
            Rule::Certified => Ok(planes),
            Rule::Inner => Ok(Planes::binary(planes.lower)),
            Rule::Outer => Ok(Planes::binary(planes.upper)),
            Rule::Sampled if planes.partial() == 0 => Ok(planes),
            Rule::Sampled => Err(Error::NotSampled),
        }
    }

    /// Allocates a block with the planes that the rule needs.
    pub(super) fn block(self) -> Result<Block, Error> {
        Block::new(self != Rule::Sampled, self == Rule::Sampled)
    }

    /// The resolved cells of such a block.
    pub(super) fn cells(self, block: &Block) -> Cells<'_> {
        let planes = match self {
            Rule::Certified => block.planes(),
            Rule::Inner => block.planes().map(|(lower, _)| (lower, lower)),
            Rule::Outer => block.planes().map(|(_, upper)| (upper, upper)),
            Rule::Sampled => block.centres().map(|centres| (centres, centres)),
        };
        let (lower, upper) = planes.unwrap_or_else(|| unreachable!("a block has what its rule needs"));
        Cells { binary: self.is_binary(), lower, upper }
    }
}
