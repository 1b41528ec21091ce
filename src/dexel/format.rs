//! The data that is stored for each interval.

/// The representation of the ends of intervals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DexelEnds {
    /// Start and length in units of 2^-31 edges of the universe, 8 bytes an interval. The error of an end is
    /// at most one unit.
    #[default]
    Fixed,
    /// Start and end as doubles, 16 bytes an interval.
    Double,
}

/// The representation of the unit normals at the ends of intervals: an octahedral code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, PartialOrd, Ord)]
pub enum DexelNormals {
    /// No normals are stored.
    #[default]
    None,
    /// 16 bits a normal, 4 bytes an interval; the error is below a degree.
    Bits16,
    /// 32 bits a normal, 8 bytes an interval; the error is below 0.005 degrees.
    Bits32,
}

/// The data that is stored for each interval: 8 to 36 bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct DexelFormat {
    /// The start and the end.
    pub ends: DexelEnds,
    /// The unit normals of the solid's surface at its ends.
    pub normals: DexelNormals,
    /// Whether the number of the source's surface at each end is stored, 8 bytes an interval.
    pub surfaces: bool,
    /// Whether the material is stored, 4 bytes an interval.
    pub materials: bool,
}

impl DexelFormat {
    /// The number of bytes of an interval.
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

    /// The least format that stores all data of both formats.
    #[must_use]
    pub fn join(self, other: DexelFormat) -> DexelFormat {
        DexelFormat {
            ends: if self.ends == other.ends { self.ends } else { DexelEnds::Double },
            normals: self.normals.max(other.normals),
            surfaces: self.surfaces || other.surfaces,
            materials: self.materials || other.materials,
        }
    }

    /// Returns whether intervals consist of their ends only.
    pub(crate) fn is_plain(&self) -> bool {
        self.normals == DexelNormals::None && !self.surfaces && !self.materials
    }
}
