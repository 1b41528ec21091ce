//! What the cells of an octree prove.

use crate::error::Error;

/// What the cells of an octree prove of the solid that it was made from: whoever asks it as a solid is told
/// no more than that.
///
/// Booleans and transforms pass it on, and files keep it:
///
/// | made | FULL | EMPTY |
/// |---|---|---|
/// | certified | proven | proven |
/// | by [`Rule::Inner`](crate::Rule::Inner) | proven | |
/// | by [`Rule::Outer`](crate::Rule::Outer) | | proven |
/// | by [`Rule::Sampled`](crate::Rule::Sampled) | | |
/// | union, intersection | if of all operands | if of all operands |
/// | complement | if EMPTY was | if FULL was |
/// | A ∖ B = A ∩ ¬B | FULL of A and EMPTY of B | EMPTY of A and FULL of B |
/// | symmetric difference | if both of all operands | if both of all operands |
/// | of [voxel records](crate::voxel::VoxelSolid) | if their boundary voxels are not taken for FULL | nor for EMPTY |
/// | of a [tri-dexel model](crate::surface::DexelSolid) | | |
///
/// A mesh or a bitmap of an octree is a solid of its own, which says nothing of what the octree was made
/// from: what is built of it is proven of the region inside of the mesh, or of the union of the voxels. So
/// are the cells of a [channel's values](crate::attribute::ChannelRef::region).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proof {
    /// A FULL cell is proven to lie in the solid; so is a FULL exterior.
    pub full: bool,
    /// An EMPTY cell is proven to lie outside of it; so is an EMPTY exterior.
    pub empty: bool,
    displacement: f64,
}

impl Proof {
    /// FULL and EMPTY are proven, and nothing was moved.
    pub const CERTIFIED: Proof = Proof::new(true, true);

    /// What is proven, with nothing moved.
    pub const fn new(full: bool, empty: bool) -> Proof {
        Proof { full, empty, displacement: 0.0 }
    }

    /// How far the surfaces that the cells speak of were moved from those that were handed in, in model
    /// units: cracks that were sewn, vertices that were rounded, a stated deviation of a tessellation. Finite
    /// and not negative. Operations keep the greatest of their operands.
    pub fn displacement(self) -> f64 {
        self.displacement
    }

    /// The same with another displacement.
    ///
    /// # Errors
    /// [`Error::Argument`] unless the displacement is finite and not negative.
    pub fn with_displacement(self, displacement: f64) -> Result<Proof, Error> {
        if displacement.is_finite() && displacement >= 0.0 {
            // -0.0 is 0.0.
            return Ok(Proof { displacement: displacement + 0.0, ..self });
        }
        Err(Error::Argument { name: "displacement", problem: "must be finite and not negative" })
    }

    /// The same with another displacement, which is known to be good. (One that is too large to tell is as
    /// large as it can be.)
    pub(crate) fn moved(self, displacement: f64) -> Proof {
        Proof { displacement: displacement.min(f64::MAX), ..self }
    }

    /// Whether FULL and EMPTY are both proven.
    pub fn is_certified(self) -> bool {
        self.full && self.empty
    }

    /// Of the union and of the intersection.
    #[must_use]
    pub fn and(self, other: Proof) -> Proof {
        Proof {
            full: self.full && other.full,
            empty: self.empty && other.empty,
            displacement: self.displacement.max(other.displacement),
        }
    }

    /// Of the complement.
    #[must_use]
    pub fn complement(self) -> Proof {
        Proof { full: self.empty, empty: self.full, ..self }
    }

    /// Of the symmetric difference.
    #[must_use]
    pub fn xor(self, other: Proof) -> Proof {
        let both = self.and(other);
        both.and(both.complement())
    }

    /// FULL in bit 0, EMPTY in bit 1; part of the format.
    pub(crate) fn bits(self) -> u8 {
        self.full as u8 | (self.empty as u8) << 1
    }

    /// The proof of two such bits.
    pub(crate) fn from_bits(bits: u8) -> Proof {
        Proof::new(bits & 1 != 0, bits & 2 != 0)
    }
}
