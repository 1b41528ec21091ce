//! What is known of one cell.

/// The two bits of a cell.
///
/// They are the certified bounds themselves: bit 0 (`lower`) says *surely solid*, bit 1 (`upper`) says
/// *possibly solid*. The contradictory pair marks a cell that is cut further.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Tag {
    /// Proven outside: the cell's interior and the solid's are disjoint.
    Empty = 0b00,
    /// Cut into eight children, which an octree node describes.
    Branch = 0b01,
    /// Not decided. May be split further by whoever knows the solid.
    Partial = 0b10,
    /// Proven inside: the whole cell belongs to the solid.
    Full = 0b11,
}

impl Tag {
    /// The tag of the bits `lower` and `upper`.
    #[inline(always)]
    pub const fn from_bits(lower: bool, upper: bool) -> Tag {
        match (lower, upper) {
            (false, false) => Tag::Empty,
            (true, false) => Tag::Branch,
            (false, true) => Tag::Partial,
            (true, true) => Tag::Full,
        }
    }

    /// The tag whose bits are the low two of `code`.
    #[inline(always)]
    pub const fn from_code(code: u8) -> Tag {
        Tag::from_bits(code & 1 != 0, code & 2 != 0)
    }

    /// Bit 0: surely solid.
    #[inline(always)]
    pub const fn lower(self) -> bool {
        self as u8 & 1 != 0
    }

    /// Bit 1: possibly solid.
    #[inline(always)]
    pub const fn upper(self) -> bool {
        self as u8 & 2 != 0
    }

    /// The tag of the complement.
    #[inline(always)]
    pub const fn complement(self) -> Tag {
        Tag::from_bits(!self.upper(), !self.lower())
    }
}
