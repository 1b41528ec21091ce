//! The proof of an octree: the statements that its cells prove.

use crate::error::Error;

/// The statements that the cells of an octree prove about its source solid. Queries of the octree as a solid
/// return no more than that.
///
/// Booleans and transforms derive it from their operands, and files store it:
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
/// A mesh or a bitmap of an octree is a separate solid, and proves nothing about the octree's source: an
/// octree built from it is proven with respect to the region inside the mesh, or to the union of the voxels.
/// The same holds for the cells of a [channel's values](crate::attribute::ChannelRef::region).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proof {
    /// A FULL cell is proven to lie in the solid; so is a FULL exterior.
    pub full: bool,
    /// An EMPTY cell is proven to lie outside of it; so is an EMPTY exterior.
    pub empty: bool,
    displacement: f64,
}

impl Proof {
    /// FULL and EMPTY are proven, without displacement.
    pub const CERTIFIED: Proof = Proof::new(true, true);

    /// Returns a proof without displacement.
    pub const fn new(full: bool, empty: bool) -> Proof {
        Proof { full, empty, displacement: 0.0 }
    }

    /// Returns the greatest distance by which the surfaces of the cells were moved from the given surfaces,
    /// in model units: closed cracks, rounded vertices, a stated deviation of a tessellation. Finite and not
    /// negative. Operations keep the greatest value of their operands.
    pub fn displacement(self) -> f64 {
        self.displacement
    }

    /// Returns the same proof with another displacement.
    ///
    /// # Errors
    ///
    /// [`Error::Argument`] unless the displacement is finite and not negative.
    pub fn with_displacement(self, displacement: f64) -> Result<Proof, Error> {
        if displacement.is_finite() && displacement >= 0.0 {
            // -0.0 is 0.0.
            return Ok(Proof { displacement: displacement + 0.0, ..self });
        }
        Err(Error::Argument { name: "displacement", problem: "must be finite and not negative" })
    }

    /// Returns the same proof with another displacement, which is known to be valid. (An infinite one becomes
    /// the greatest finite number.)
    pub(crate) fn moved(self, displacement: f64) -> Proof {
        Proof { displacement: displacement.min(f64::MAX), ..self }
    }

    /// True if FULL and EMPTY are both proven.
    pub fn is_certified(self) -> bool {
        self.full && self.empty
    }

    /// Returns the proof of a union or an intersection.
    #[must_use]
    pub fn and(self, other: Proof) -> Proof {
        Proof {
            full: self.full && other.full,
            empty: self.empty && other.empty,
            displacement: self.displacement.max(other.displacement),
        }
    }

    /// Returns the proof of the complement.
    #[must_use]
    pub fn complement(self) -> Proof {
        Proof { full: self.empty, empty: self.full, ..self }
    }

    /// Returns the proof of a symmetric difference.
    #[must_use]
    pub fn xor(self, other: Proof) -> Proof {
        let both = self.and(other);
        both.and(both.complement())
    }

    /// Returns FULL in bit 0 and EMPTY in bit 1; part of the format.
    pub(crate) fn bits(self) -> u8 {
        self.full as u8 | (self.empty as u8) << 1
    }

    /// Returns the proof of two such bits.
    pub(crate) fn from_bits(bits: u8) -> Proof {
        Proof::new(bits & 1 != 0, bits & 2 != 0)
    }
}
