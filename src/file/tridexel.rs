//! Files of tri-dexel models. The public items are in [`dexels`](super::dexels).

use super::compose::Section;
use super::elements::Elements;
use super::field::illegal;
use super::form::Form;
use super::header::{DEXELS_MINOR, FLAG_DEXELS, Header, Model};
use super::kind::{Column, Kind};
use super::layout::Layout;
use super::stored::Stored;
use super::wire::elements;
use super::{read, write};
use crate::dexel::{
    ColumnsRef, DexelEnds, DexelFormat, DexelNormals, DoubleSpan, FixedSpan, NormalsRef, Rows, RowsRef, Span,
    TriDexel, TriDexelRef, Window, with_rows,
};
use crate::error::{Error, FormatError};
use crate::lattice::Each;
use crate::lattice::axes;
use crate::memory;
use crate::octree::Metadata;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::mem::offset_of;
#[cfg(feature = "std")]
use std::{io::Write, path::Path};

// The elements of sections have the layout of the structures in memory.
const _: () = {
    assert!(size_of::<FixedSpan>() == 8 && align_of::<FixedSpan>() == 4);
    assert!(offset_of!(FixedSpan, start) == 0 && offset_of!(FixedSpan, length) == 4);
    assert!(size_of::<DoubleSpan>() == 16 && align_of::<DoubleSpan>() == 8);
    assert!(offset_of!(DoubleSpan, start) == 0 && offset_of!(DoubleSpan, end) == 8);
};

impl Stored for TriDexel {
    const MODEL: Model = Model::Dexels;

    type View<'a> = TriDexelRef<'a>;
    /// The stored properties, and the window of each direction.
    type Shape = (Form, [Window; 3]);
    /// The windows of the directions that have rays.
    type Prepared = Vec<[u32; 4]>;

    fn shape(layout: &Layout, bytes: &[u8]) -> Result<(Form, [Window; 3]), Error> {
        let form = layout.head.form.unwrap_or_default();
        let mut windows = [Window::default(); 3];
        let axes = (0..3).filter(|&axis| form.directions[axis]);
        let records = elements::<[u32; 4]>(layout.sections.bytes(bytes, Kind::Windows)?);
        for (axis, [u, v, width, height]) in axes.zip(records) {
            let window = Window { first: [u, v], size: [width, height] };
            let cells = u64::from(layout.head.frame.cells());
            let fits = (0..2).all(|i| u64::from(window.first[i]) + u64::from(window.size[i]) <= cells);
            // An empty window has only one representation.
            if !fits || window.is_empty() && window != Window::default() {
                return Err(illegal("window", axis as u64).into());
            }
            windows[axis] = window;
        }
        for axis in 0..3 {
            let starts = Kind::along(axis, Column::Starts);
            let length = if form.directions[axis] { 4 * (windows[axis].count() + 1) } else { 0 };
            let range = layout.sections.range(starts);
            if range.end - range.start != length {
                return Err(FormatError::Section { name: starts.name() }.into());
            }
        }
        Ok((form, windows))
    }

    fn view<'a>(
        layout: &Layout,
        (form, windows): &(Form, [Window; 3]),
        bytes: &'a [u8],
    ) -> Result<TriDexelRef<'a>, FormatError> {
        let format = form.format;
        let mut rays = [None; 3];
        for axis in (0..3).filter(|&axis| form.directions[axis]) {
            rays[axis] = Some(match format.ends {
                DexelEnds::Fixed => Rows::Fixed(rows(layout, format, windows[axis], axis, bytes)?),
                DexelEnds::Double => Rows::Double(rows(layout, format, windows[axis], axis, bytes)?),
            });
        }
        Ok(TriDexelRef { frame: layout.head.frame, format, rays, checked: false })
    }

    fn checked(view: Self::View<'_>) -> Result<Self::View<'_>, Error> {
        view.check()?;
        Ok(TriDexelRef { checked: true, ..view })
    }

    fn attach<C: Send + Sync + 'static>(
        owner: Arc<C>,
        metadata: Metadata,
        view: impl for<'a> FnOnce(&'a C) -> Result<TriDexelRef<'a>, Error>,
    ) -> Result<TriDexel, Error> {
        TriDexel::attach(owner, metadata, view)
    }

    fn as_view(&self) -> TriDexelRef<'_> {
        *self.view()
    }

    fn metadata(&self) -> &Metadata {
        self.metadata()
    }

    fn prepare(&self) -> Result<Vec<[u32; 4]>, Error> {
        let mut windows = memory::with_capacity(3)?;
        for rows in self.view().rays.iter().flatten() {
            let window = with_rows!(rows, rows => rows.window);
            let ([u, v], [width, height]) = (window.first, window.size);
            windows.push([u, v, width, height]);
        }
        Ok(windows)
    }

    fn append_sections<'a>(&'a self, windows: &'a Vec<[u32; 4]>, sections: &mut Vec<Section<'a>>) -> Header {
        let model = self.view();
        sections.push((0, Kind::Windows, Elements::Fours32(windows)));
        for (axis, rows) in model.rays.iter().enumerate() {
            match rows {
                Some(Rows::Fixed(rows)) => sections.extend(columns(axis, rows, Elements::Pairs32)),
                Some(Rows::Double(rows)) => sections.extend(columns(axis, rows, Elements::Pairs64)),
                None => {}
            }
        }
        let [x, y, z] = axes(|axis| model.rays(axis).map_or(0, |rays| rays.interval_count()));
        Header {
            minor: DEXELS_MINOR,
            flags_required: FLAG_DEXELS,
            form: Form { format: model.format, directions: model.directions() }.bits(),
            elements: x,
            bricks: y,
            dictionary_entries: z,
            ..Header::of(&model.frame)
        }
    }
}

/// Returns the rays of a direction in `bytes`.
fn rows<'a, S: Span>(
    layout: &Layout,
    format: DexelFormat,
    window: Window,
    axis: usize,
    bytes: &'a [u8],
) -> Result<RowsRef<'a, S>, FormatError> {
    let sections = &layout.sections;
    let kind = |column| Kind::along(axis, column);
    let normals = kind(Column::Normals);
    let (surfaces, materials) = (kind(Column::Surfaces), kind(Column::Materials));
    Ok(RowsRef {
        window,
        starts: sections.array(bytes, kind(Column::Starts))?,
        columns: ColumnsRef {
            spans: sections.array(bytes, kind(Column::Spans))?,
            surfaces: if format.surfaces { Some(sections.array(bytes, surfaces)?) } else { None },
            normals: match format.normals {
                DexelNormals::None => NormalsRef::None,
                DexelNormals::Bits16 => NormalsRef::Bits16(sections.array(bytes, normals)?),
                DexelNormals::Bits32 => NormalsRef::Bits32(sections.array(bytes, normals)?),
            },
            materials: if format.materials { Some(sections.array(bytes, materials)?) } else { None },
        },
    })
}

/// Returns the sections of a direction. `spans` converts its spans, which are pairs of numbers.
fn columns<'a, S: Span, N: bytemuck::Pod>(
    axis: usize,
    rows: &RowsRef<'a, S>,
    spans: fn(&'a [[N; 2]]) -> Elements<'a>,
) -> [Section<'a>; 5]
where
    [N; 2]: bytemuck::Pod,
{
    let ColumnsRef { spans: intervals, surfaces, normals, materials } = rows.columns;
    [
        (Column::Starts, Elements::U32(rows.starts)),
        (Column::Spans, spans(bytemuck::cast_slice(intervals))),
        (
            Column::Normals,
            match normals {
                NormalsRef::None => Elements::Bytes(&[]),
                NormalsRef::Bits16(codes) => Elements::Pairs16(codes),
                NormalsRef::Bits32(codes) => Elements::Pairs32(codes),
            },
        ),
        (Column::Surfaces, Elements::Pairs32(surfaces.unwrap_or_default())),
        (Column::Materials, Elements::U32(materials.unwrap_or_default())),
    ]
    .each(|(column, elements)| (0, Kind::along(axis, column), elements))
}

/// Returns the file of `model` as bytes.
///
/// The bytes depend only on the model and its metadata: equal models with equal metadata give equal bytes.
/// The model is [checked](TriDexelRef::check) first, so that every written file can be read. O(n).
///
/// # Errors
/// [`Error::DamagedRays`] if the model is mapped, not verified, and damaged; [`Error::Argument`] if the
/// metadata take more than 1 MiB; [`Error::OutOfMemory`].
pub fn to_bytes(model: &TriDexel) -> Result<Vec<u8>, Error> {
    write::to_bytes(model)
}

/// Writes the file of `model` to `out`, the same bytes as [`to_bytes`], in a few large pieces. `out` needs no
/// buffer around it, and the file is never in memory as a whole. `out` is flushed at the end.
///
/// # Errors
/// The errors of [`to_bytes`], before anything is written; [`Error::Io`] as `out` returns it.
#[cfg(feature = "std")]
pub fn write_to(model: &TriDexel, out: impl Write) -> Result<(), Error> {
    write::write_to(model, out)
}

/// Saves `model` in the file at `path`. At any moment, also after a crash or a power failure, either the old
/// file or the new file is there, and it is complete. Permissions, links, pipes and temporary files are
/// handled as by [`file::save`](super::save).
///
/// # Errors
/// The errors of [`to_bytes`], and [`Error::File`] with the path and the cause [`Error::Io`]. On an error the
/// old file is unchanged. The only exception is a failure of the very last step, synchronising the directory.
#[cfg(feature = "std")]
pub fn save(model: &TriDexel, path: impl AsRef<Path>) -> Result<(), Error> {
    write::save(model, path.as_ref())
}

/// Returns a view of the model in `bytes`, a whole file, without a copy and without an allocation.
///
/// Only header, section table, bounds and windows are checked: O(sections + objects). The
/// [module](super::dexels) describes the effects of damaged intervals. The bytes must begin at an address
/// that is a multiple of 8.
///
/// # Errors
/// [`Error::Format`]; this includes [`FormatError::OtherModel`](crate::error::FormatError::OtherModel) for
/// the file of an octree, and [`FormatError::Endianness`](crate::error::FormatError::Endianness) on
/// big-endian machines.
pub fn view(bytes: &[u8]) -> Result<TriDexelRef<'_>, Error> {
    read::view::<TriDexel>(bytes)
}

/// Returns the model in `bytes`, a whole file, copied and [verified](super::verify). The bytes may have any
/// alignment, and the machine any byte order.
///
/// # Errors
/// [`Error::Format`] or [`Error::DamagedRays`]; [`Error::OutOfMemory`].
pub fn from_bytes(bytes: &[u8]) -> Result<TriDexel, Error> {
    read::from_bytes(bytes)
}

/// Returns the model in `bytes`, a whole file that lives as long as the program (for example linked into it),
/// read in place as by [`view`].
///
/// # Errors
/// The errors of [`view`], and [`FormatError::Metadata`](crate::error::FormatError::Metadata).
pub fn from_static(bytes: &'static [u8]) -> Result<TriDexel, Error> {
    read::from_static(bytes)
}

/// Reads the model in the file at `path` into memory, and [verifies](super::verify) it. Later changes of the
/// file have no effect. A pipe or device may be read too.
///
/// # Errors
/// [`Error::File`] with the path and one of these causes: the errors of [`from_bytes`], and [`Error::Io`].
#[cfg(feature = "std")]
pub fn open(path: impl AsRef<Path>) -> Result<TriDexel, Error> {
    read::open(path.as_ref())
}

/// Maps the model in the file at `path` into memory: nothing is copied, and only the parts that queries touch
/// are ever read from disk. Only header, section table, bounds, windows and metadata are checked:
/// O(sections + objects), some microseconds for a file of any size. The [module](super::dexels) describes the
/// effects of damaged intervals.
///
/// # Errors
/// [`Error::File`] with the path and one of these causes: [`Error::Io`];
/// [`FormatError::NotRegular`](crate::error::FormatError::NotRegular) if there is no regular file at `path`;
/// the errors of [`view`]; and [`FormatError::Metadata`](crate::error::FormatError::Metadata).
///
/// # Safety
/// The conditions of [`file::map`](super::map()): while the mapping lives, nobody may write to the file or
/// make it shorter.
#[cfg(feature = "mmap")]
#[allow(unsafe_code)]
pub unsafe fn map(path: impl AsRef<Path>) -> Result<TriDexel, Error> {
    // SAFETY: the caller promises what `read::map` asks for.
    unsafe { read::map(path.as_ref(), false) }
}

/// Maps a file as [`map`] does, and verifies all of it in one scan: everything that
/// [`verify`](super::verify) checks.
///
/// # Errors
/// The errors of [`map`] and of [`verify`](super::verify).
///
/// # Safety
/// The conditions of [`map`]. A program that violates them may change the file after it was verified.
#[cfg(feature = "mmap")]
#[allow(unsafe_code)]
pub unsafe fn map_verified(path: impl AsRef<Path>) -> Result<TriDexel, Error> {
    // SAFETY: the caller promises what `read::map` asks for.
    unsafe { read::map(path.as_ref(), true) }
}
