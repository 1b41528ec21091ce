//! Kinds of sections: their owners and their elements.

use super::counts::ENCODING_DICTIONARY;
use super::form::Form;
use super::object::{CHANNEL, CUTS_MINOR, DEXELS, Object, SOLID};
use crate::dexel::{DexelEnds, DexelNormals};
use crate::octree::cuts::{Placement, StoredMoments};
use crate::octree::view::LevelCounts;
use crate::octree::word::Planes;

/// The flag of a section that a reader must know to read its object; part of the format.
pub(super) const SECTION_REQUIRED: u32 = 1;

/// The sections that this library knows. The numbers are part of the format. 16 to 31 are for values (17 is
/// reserved for values of PARTIAL cells by rank), except for 20 to 25. 48 to 55 are reserved for versions, 56
/// to 63 for the archive. Numbers from 2^31 on belong to applications.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub(super) enum Kind {
    /// The records of the file's objects.
    Objects = 1,
    /// Keys and values.
    Metadata = 2,
    /// The counts of each octree level.
    Levels = 3,
    /// Elements: pairs of words.
    Planes = 4,
    /// The first child of each element, relative to the base of its group of 1024 elements.
    Rel = 5,
    /// The first child of every 1024th element.
    Base = 6,
    /// Bricks, one after another.
    Bricks = 7,
    /// The dictionary index of each brick.
    Indices = 8,
    /// The dictionary: distinct bricks, segment by segment.
    Entries = 9,
    /// The first dictionary entry of each segment.
    Segments = 10,
    /// One byte for each cut.
    CutHeads = 11,
    /// The surfaces of each cut, one after another.
    CutIds = 12,
    /// The counts before every 32nd cut.
    CutBlocks = 13,
    /// The number of cuts before each element and brick, and before all splits.
    CutFirst = 14,
    /// Surfaces.
    Surfaces = 15,
    /// The values of a channel.
    Values = 16,
    /// The number of values before each element and brick of a channel, relative to the base of its group of
    /// 1024.
    ValueRel = 18,
    /// The number of values before every 1024th element or brick of a channel.
    ValueBase = 19,
    /// Doubles of the surfaces.
    SurfaceNumbers = 20,
    /// Maps that place surfaces.
    Placements = 21,
    /// The sources from which slabs were made.
    Origins = 22,
    /// Slabs that belong to one cell each.
    CellSlabs = 23,
    /// The sources of the cell slabs, and the number of slabs of each source.
    CellSlabGroups = 24,
    /// The moments of a solid with cuts.
    Moments = 25,
    /// The rays of each direction of a tri-dexel model.
    Windows = 32,
    /// The first interval of each ray along x, and the number of intervals.
    StartsX = 33,
    /// The beginnings and ends of the intervals along x.
    SpansX = 34,
    /// Normals at both ends of each interval along x.
    NormalsX = 35,
    /// Surfaces of both ends of each interval along x.
    SurfacesX = 36,
    /// Material of each interval along x.
    MaterialsX = 37,
    /// Starts along y. The next arrays are those along y, in the same order.
    StartsY = 38,
    SpansY = 39,
    NormalsY = 40,
    SurfacesY = 41,
    MaterialsY = 42,
    /// Starts along z. The next arrays are those along z, in the same order.
    StartsZ = 43,
    SpansZ = 44,
    NormalsZ = 45,
    SurfacesZ = 46,
    MaterialsZ = 47,
}

/// An array of one direction of a tri-dexel model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Column {
    Starts,
    Spans,
    Normals,
    Surfaces,
    Materials,
}

/// The arrays of each direction, in the order of their kinds.
const COLUMNS: [[Kind; 5]; 3] = [
    [Kind::StartsX, Kind::SpansX, Kind::NormalsX, Kind::SurfacesX, Kind::MaterialsX],
    [Kind::StartsY, Kind::SpansY, Kind::NormalsY, Kind::SurfacesY, Kind::MaterialsY],
    [Kind::StartsZ, Kind::SpansZ, Kind::NormalsZ, Kind::SurfacesZ, Kind::MaterialsZ],
];

/// Number of unused kinds right below the first kind of tri-dexel models.
const UNUSED: usize = 6;
const _: () = assert!((Kind::Moments as usize) < Kind::Windows as usize - UNUSED);

/// Length of arrays that are indexed by kind; see [`Kind::slot`].
pub(super) const KINDS: usize = 48 - UNUSED;

/// The number types of section elements; the numbers are part of the format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Element {
    /// Records whose layout depends on the kind, in units of eight bytes.
    Record = 0,
    U8 = 1,
    U16 = 2,
    U32 = 3,
    U64 = 4,
    F32 = 5,
    F64 = 6,
}

impl Element {
    const ALL: [Element; 7] =
        [Element::Record, Element::U8, Element::U16, Element::U32, Element::U64, Element::F32, Element::F64];

    pub(super) fn from_number(number: u8) -> Option<Element> {
        Element::ALL.get(number as usize).copied()
    }

    pub(super) fn size(self) -> u64 {
        match self {
            Element::U8 => 1,
            Element::U16 => 2,
            Element::U32 | Element::F32 => 4,
            Element::Record | Element::U64 | Element::F64 => 8,
        }
    }
}

impl Kind {
    pub(super) const ALL: [Kind; 40] = [
        Kind::Objects,
        Kind::Metadata,
        Kind::Levels,
        Kind::Planes,
        Kind::Rel,
        Kind::Base,
        Kind::Bricks,
        Kind::Indices,
        Kind::Entries,
        Kind::Segments,
        Kind::CutHeads,
        Kind::CutIds,
        Kind::CutBlocks,
        Kind::CutFirst,
        Kind::Surfaces,
        Kind::Values,
        Kind::ValueRel,
        Kind::ValueBase,
        Kind::SurfaceNumbers,
        Kind::Placements,
        Kind::Origins,
        Kind::CellSlabs,
        Kind::CellSlabGroups,
        Kind::Moments,
        Kind::Windows,
        Kind::StartsX,
        Kind::SpansX,
        Kind::NormalsX,
        Kind::SurfacesX,
        Kind::MaterialsX,
        Kind::StartsY,
        Kind::SpansY,
        Kind::NormalsY,
        Kind::SurfacesY,
        Kind::MaterialsY,
        Kind::StartsZ,
        Kind::SpansZ,
        Kind::NormalsZ,
        Kind::SurfacesZ,
        Kind::MaterialsZ,
    ];

    /// Maximum number of sections of an object.
    pub(super) const MOST: usize = 21;

    /// Returns the index of the kind in an array of length [`KINDS`].
    pub(super) const fn slot(self) -> usize {
        let number = self as usize;
        if number < Kind::Windows as usize { number } else { number - UNUSED }
    }

    /// Returns the kind of an array of a direction.
    pub(super) const fn along(axis: usize, column: Column) -> Kind {
        COLUMNS[axis][column as usize]
    }

    /// Returns the direction and the array of this kind.
    fn column(self) -> Option<(usize, Column)> {
        use Column::*;
        let place = (self as usize).checked_sub(Kind::StartsX as usize)?;
        Some((place / 5, [Starts, Spans, Normals, Surfaces, Materials][place % 5]))
    }

    /// The kinds of an octree's cuts.
    pub(super) const CUTS: [Kind; 11] = [
        Kind::CutHeads,
        Kind::CutIds,
        Kind::CutBlocks,
        Kind::CutFirst,
        Kind::Surfaces,
        Kind::SurfaceNumbers,
        Kind::Placements,
        Kind::Origins,
        Kind::CellSlabs,
        Kind::CellSlabGroups,
        Kind::Moments,
    ];

    /// Returns the kind with this number, if such an object may have sections of it in a file of this minor
    /// version.
    pub(super) fn of(number: u32, object: &Object, minor: u16) -> Option<Kind> {
        let owned = |&kind: &Kind| match kind {
            Kind::Metadata => true,
            Kind::Objects => object.kind != CHANNEL,
            Kind::Values | Kind::ValueRel | Kind::ValueBase => object.kind == CHANNEL,
            kind if kind.is_of_cuts() => object.kind == SOLID && minor >= CUTS_MINOR,
            _ => (kind as u32 >= Kind::Windows as u32) == (object.kind == DEXELS),
        };
        Kind::from_number(number).filter(owned)
    }

    fn is_of_cuts(self) -> bool {
        Kind::CUTS.contains(&self)
    }

    fn from_number(number: u32) -> Option<Kind> {
        Kind::ALL.into_iter().find(|&kind| kind as u32 == number)
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Kind::Objects => "objects",
            Kind::Metadata => "metadata",
            Kind::Levels => "level table",
            Kind::Planes => "planes",
            Kind::Rel => "rel",
            Kind::Base => "base",
            Kind::Bricks => "bricks",
            Kind::Indices => "brick indices",
            Kind::Entries => "dictionary entries",
            Kind::Segments => "dictionary segments",
            Kind::Values => "values",
            Kind::ValueRel => "value rel",
            Kind::ValueBase => "value base",
            Kind::CutHeads => "cut heads",
            Kind::CutIds => "cut ids",
            Kind::CutBlocks => "cut blocks",
            Kind::CutFirst => "cut first",
            Kind::Surfaces => "surfaces",
            Kind::SurfaceNumbers => "surface numbers",
            Kind::Placements => "placements",
            Kind::Origins => "origins",
            Kind::CellSlabs => "cell slabs",
            Kind::CellSlabGroups => "cell slab groups",
            Kind::Moments => "moments",
            Kind::Windows => "windows",
            Kind::StartsX => "starts along x",
            Kind::SpansX => "spans along x",
            Kind::NormalsX => "normals along x",
            Kind::SurfacesX => "surfaces along x",
            Kind::MaterialsX => "materials along x",
            Kind::StartsY => "starts along y",
            Kind::SpansY => "spans along y",
            Kind::NormalsY => "normals along y",
            Kind::SurfacesY => "surfaces along y",
            Kind::MaterialsY => "materials along y",
            Kind::StartsZ => "starts along z",
            Kind::SpansZ => "spans along z",
            Kind::NormalsZ => "normals along z",
            Kind::SurfacesZ => "surfaces along z",
            Kind::MaterialsZ => "materials along z",
        }
    }

    /// Returns the flags of a section. Metadata and cuts are optional for readers.
    pub(super) fn flags(self) -> u32 {
        if self == Kind::Metadata || self.is_of_cuts() { 0 } else { SECTION_REQUIRED }
    }

    /// Returns the type and the number of components of an element of an object's section.
    pub(super) fn element(self, object: &Object) -> (Element, u8) {
        match self {
            Kind::Objects => (Element::Record, (size_of::<Object>() / 8) as u8),
            Kind::Metadata => (Element::U8, 1),
            Kind::Levels => (Element::U64, (size_of::<LevelCounts>() / 8) as u8),
            Kind::Planes => (Element::U64, (size_of::<Planes>() / 8) as u8),
            Kind::Rel | Kind::Indices | Kind::ValueRel => (Element::U16, 1),
            Kind::Base | Kind::Segments | Kind::ValueBase => (Element::U64, 1),
            Kind::Bricks | Kind::Entries => (Element::U64, object.brick_planes),
            Kind::Values => {
                (Element::from_number(object.value_type).unwrap_or(Element::U8), object.components)
            }
            Kind::CutHeads | Kind::CutIds => (Element::U8, 1),
            Kind::CutBlocks => (Element::U32, 2),
            Kind::CutFirst => (Element::U32, 1),
            Kind::Surfaces | Kind::Windows => (Element::U32, 4),
            Kind::SurfaceNumbers => (Element::F64, 1),
            Kind::Placements => (Element::Record, (size_of::<Placement>() / 8) as u8),
            Kind::Origins | Kind::CellSlabs => (Element::U64, 2),
            Kind::CellSlabGroups => (Element::U64, 3),
            Kind::Moments => (Element::F64, (size_of::<StoredMoments>() / 8) as u8),
            _ => self.dexel_element(object),
        }
    }

    /// Does the same for an array of a direction.
    fn dexel_element(self, object: &Object) -> (Element, u8) {
        let format = Form::from_bits(object.form).unwrap_or_default().format;
        match self.column() {
            Some((_, Column::Spans)) if format.ends == DexelEnds::Double => (Element::F64, 2),
            Some((_, Column::Normals)) if format.normals == DexelNormals::Bits16 => (Element::U16, 2),
            Some((_, Column::Spans | Column::Normals | Column::Surfaces)) => (Element::U32, 2),
            _ => (Element::U32, 1),
        }
    }

    /// Returns the number of elements that an object's section must have; `None` if it is free.
    pub(super) fn demanded(self, object: &Object) -> Option<u64> {
        let coded = object.brick_encoding == ENCODING_DICTIONARY;
        // (Elements and bricks are known to lie in memory; otherwise the check of their sections fails.)
        let entries = object.elements.saturating_add(object.bricks);
        let if_coded = |count: u64| if coded { count } else { 0 };
        match self {
            Kind::Objects | Kind::Metadata => None,
            kind if kind.is_of_cuts() => None,
            Kind::Levels => Some(object.depth as u64 + 1),
            Kind::Planes | Kind::Rel => Some(object.elements),
            Kind::Base => Some(object.elements.div_ceil(1024)),
            Kind::Bricks => Some(if coded { 0 } else { object.bricks }),
            Kind::Indices => Some(if_coded(object.bricks)),
            Kind::Entries => Some(if_coded(object.dictionary_entries)),
            Kind::Segments => Some(if_coded(object.counts().segments())),
            Kind::Values => Some(object.values),
            Kind::ValueRel => Some(entries),
            Kind::ValueBase => Some(entries.div_ceil(1024)),
            _ => self.dexels_demanded(object),
        }
    }

    /// Does the same for a tri-dexel model. The number of starts follows from the windows.
    fn dexels_demanded(self, object: &Object) -> Option<u64> {
        let Form { format, directions } = Form::from_bits(object.form).unwrap_or_default();
        let Some((axis, column)) = self.column() else {
            return Some(directions.iter().map(|&has| u64::from(has)).sum());
        };
        let carried = match column {
            Column::Starts => return None,
            Column::Spans => true,
            Column::Normals => format.normals != DexelNormals::None,
            Column::Surfaces => format.surfaces,
            Column::Materials => format.materials,
        };
        Some(if carried { object.intervals()[axis] } else { 0 })
    }
}
