//! The tags of cells.

/// The two bits of a cell.
///
/// The bits are the certified bounds themselves: bit 0 (`lower`) means *surely solid*, bit 1 (`upper`) means
/// *possibly solid*. The contradictory pair marks a cell that is cut further.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Tag {
    /// Proven outside: the cell's interior and the solid's are disjoint.
    Empty = 0b00,
    /// Cut into eight children, which an octree node describes.
    Branch = 0b01,
    /// Not decided. Code that has the solid may split the cell further.
    Partial = 0b10,
    /// Proven inside: the whole cell belongs to the solid.
    Full = 0b11,
}

impl Tag {
    /// Returns the tag of the bits `lower` and `upper`.
    #[inline(always)]
    pub const fn from_bits(lower: bool, upper: bool) -> Tag {
        match (lower, upper) {
            (false, false) => Tag::Empty,
            (true, false) => Tag::Branch,
            (false, true) => Tag::Partial,
            (true, true) => Tag::Full,
        }
    }

    /// Returns the tag whose bits are the low two of `code`.
    #[inline(always)]
    pub const fn from_code(code: u8) -> Tag {
        Tag::from_bits(code & 1 != 0, code & 2 != 0)
    }

    /// Returns bit 0: surely solid.
    #[inline(always)]
    pub const fn lower(self) -> bool {
        self as u8 & 1 != 0
    }

    /// Returns bit 1: possibly solid.
    #[inline(always)]
    pub const fn upper(self) -> bool {
        self as u8 & 2 != 0
    }

    /// Returns the tag of the complement.
    #[inline(always)]
    pub const fn complement(self) -> Tag {
        Tag::from_bits(!self.upper(), !self.lower())
    }
}
