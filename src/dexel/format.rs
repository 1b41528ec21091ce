//! What of intervals is stored.

/// How the ends of intervals are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DexelEnds {
    /// Start and length in units of 2^-31 edges of the universe, 8 bytes an interval. An end is off by at
    /// most one unit.
    #[default]
    Fixed,
    /// Start and end as doubles, 16 bytes an interval.
    Double,
}

/// How unit normals at the ends of intervals are stored: in an octahedral code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, PartialOrd, Ord)]
pub enum DexelNormals {
    /// Not at all.
    #[default]
    None,
    /// In 16 bits, 4 bytes an interval, within a degree.
    Bits16,
    /// In 32 bits, 8 bytes an interval, within 0.005 degrees.
    Bits32,
}

/// What of each interval is stored. The least is 8 bytes an interval, the most 36.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct DexelFormat {
    /// Where it starts and ends.
    pub ends: DexelEnds,
    /// The unit normals of the solid's surface at its ends.
    pub normals: DexelNormals,
    /// On which of the source's surfaces its ends lie, 8 bytes an interval.
    pub surfaces: bool,
    /// What it is made of, 4 bytes an interval.
    pub materials: bool,
}

impl DexelFormat {
    /// Bytes that an interval takes.
    pub const fn bytes_per_interval(&self) -> usize {
        let ends = match self.ends {
            DexelEnds::Fixed => 8,
            DexelEnds::Double => 16,
        };
        let normals = match self.normals {
            DexelNormals::None => 0,
            DexelNormals::Bits16 => 4,
            DexelNormals::Bits32 => 8,
        };
        ends + normals + if self.surfaces { 8 } else { 0 } + if self.materials { 4 } else { 0 }
    }

    /// The least format that holds what both do.
    #[must_use]
    pub fn join(self, other: DexelFormat) -> DexelFormat {
        DexelFormat {
            ends: if self.ends == other.ends { self.ends } else { DexelEnds::Double },
            normals: self.normals.max(other.normals),
            surfaces: self.surfaces || other.surfaces,
            materials: self.materials || other.materials,
        }
    }

    /// Whether intervals have nothing but their ends.
    pub(crate) fn is_plain(&self) -> bool {
        self.normals == DexelNormals::None && !self.surfaces && !self.materials
    }
}
