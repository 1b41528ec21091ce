//! All that must be known of a file to read its tri-dexel model in place.

use super::field::illegal;
use super::form::Form;
use super::header::Head;
use super::kind::{Column, Kind};
use super::layout::cast;
use super::object;
use super::section::{Sections, read_table};
use super::wire::elements;
use crate::dexel::{
    ColumnsRef, DexelEnds, DexelNormals, DoubleSpan, FixedSpan, NormalsRef, Rows, RowsRef, Span, TriDexelRef,
    Window,
};
use crate::error::{Error, FormatError};
use core::mem::offset_of;

// The elements of sections are the structures in memory.
const _: () = {
    assert!(size_of::<FixedSpan>() == 8 && align_of::<FixedSpan>() == 4);
    assert!(offset_of!(FixedSpan, start) == 0 && offset_of!(FixedSpan, length) == 4);
    assert!(size_of::<DoubleSpan>() == 16 && align_of::<DoubleSpan>() == 8);
    assert!(offset_of!(DoubleSpan, start) == 0 && offset_of!(DoubleSpan, end) == 8);
};

/// All that must be known of a file to read its tri-dexel model in place.
#[derive(Debug, Clone)]
pub(super) struct DexelLayout {
    pub head: Head,
    pub sections: Sections,
    form: Form,
    windows: [Window; 3],
}

impl DexelLayout {
    /// Checks header, section table, bounds, the records of objects, and the windows. O(sections + objects); `bytes` are
    /// the whole file, of any alignment.
    pub fn read(bytes: &[u8]) -> Result<DexelLayout, Error> {
        let head = Head::read(bytes)?;
        head.demand_model(true)?;
        let form = head.form.unwrap_or_default();
        let (expected, found) = (head.header.file_length, bytes.len() as u64);
        if expected != found {
            return Err(FormatError::Length { expected, found }.into());
        }
        let sections = read_table(&head, head.table(bytes)?)?;
        object::check(&head.header, sections.bytes(bytes, Kind::Objects)?)?;
        let mut windows = [Window::default(); 3];
        let axes = (0..3).filter(|&axis| form.directions[axis]);
        let records = elements::<[u32; 4]>(sections.bytes(bytes, Kind::Windows)?);
        for (axis, [u, v, width, height]) in axes.zip(records) {
            let window = Window { first: [u, v], size: [width, height] };
            let cells = u64::from(head.frame.cells());
            let fits = (0..2).all(|i| u64::from(window.first[i]) + u64::from(window.size[i]) <= cells);
            // Of nothing there is one window.
            if !fits || window.is_empty() && window != Window::default() {
                return Err(illegal("window", axis as u64).into());
            }
            windows[axis] = window;
        }
        for axis in 0..3 {
            let starts = Kind::along(axis, Column::Starts);
            let length = if form.directions[axis] { 4 * (windows[axis].count() + 1) } else { 0 };
            let range = sections.range(starts);
            if range.end - range.start != length {
                return Err(FormatError::Section { name: starts.name() }.into());
            }
        }
        Ok(DexelLayout { head, sections, form, windows })
    }

    /// The model in `bytes`, whose numbers have this machine's order. Its arrays are `checked` already, or they are not.
    pub fn view<'a>(&self, bytes: &'a [u8], checked: bool) -> Result<TriDexelRef<'a>, FormatError> {
        let mut rays = [None; 3];
        for axis in (0..3).filter(|&axis| self.form.directions[axis]) {
            rays[axis] = Some(match self.form.format.ends {
                DexelEnds::Fixed => Rows::Fixed(self.rows(axis, bytes)?),
                DexelEnds::Double => Rows::Double(self.rows(axis, bytes)?),
            });
        }
        Ok(TriDexelRef { frame: self.head.frame, format: self.form.format, rays, checked })
    }

    fn rows<'a, S: Span>(&self, axis: usize, bytes: &'a [u8]) -> Result<RowsRef<'a, S>, FormatError> {
        let format = self.form.format;
        let section = |column| self.sections.bytes(bytes, Kind::along(axis, column));
        Ok(RowsRef {
            window: self.windows[axis],
            starts: cast(section(Column::Starts)?)?,
            columns: ColumnsRef {
                spans: cast(section(Column::Spans)?)?,
                surfaces: if format.surfaces { Some(cast(section(Column::Surfaces)?)?) } else { None },
                normals: match format.normals {
                    DexelNormals::None => NormalsRef::None,
                    DexelNormals::Bits16 => NormalsRef::Bits16(cast(section(Column::Normals)?)?),
                    DexelNormals::Bits32 => NormalsRef::Bits32(cast(section(Column::Normals)?)?),
                },
                materials: if format.materials { Some(cast(section(Column::Materials)?)?) } else { None },
            },
        })
    }
}
