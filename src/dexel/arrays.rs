//! The owned arrays of a model.

use super::columns::Columns;
use super::format::DexelFormat;
use super::place::{DoubleSpan, FixedSpan, Span};
use super::view::{Rows, RowsRef, TriDexelRef, Window};
use crate::lattice::Each;
use crate::lattice::Frame;
use alloc::vec::Vec;

/// The rays of one direction.
#[derive(Debug)]
pub(crate) struct RowArrays<S> {
    pub window: Window,
    pub starts: Vec<u32>,
    pub columns: Columns<S>,
}

impl<S: Span> RowArrays<S> {
    pub fn view(&self) -> RowsRef<'_, S> {
        RowsRef { window: self.window, starts: &self.starts, columns: self.columns.view() }
    }
}

/// The owned rays of one direction, in one of the two forms of ends.
#[derive(Debug)]
pub(crate) enum OwnedRows {
    Fixed(RowArrays<FixedSpan>),
    Double(RowArrays<DoubleSpan>),
}

/// The forms of ends, as types that convert to and from the enums.
pub(crate) trait Form: Span {
    fn own(rows: RowArrays<Self>) -> OwnedRows;

    fn rows<'a>(rows: &Rows<'a>) -> Option<RowsRef<'a, Self>>;
}

impl Form for FixedSpan {
    fn own(rows: RowArrays<FixedSpan>) -> OwnedRows {
        OwnedRows::Fixed(rows)
    }

    fn rows<'a>(rows: &Rows<'a>) -> Option<RowsRef<'a, FixedSpan>> {
        match rows {
            Rows::Fixed(rows) => Some(*rows),
            Rows::Double(_) => None,
        }
    }
}

impl Form for DoubleSpan {
    fn own(rows: RowArrays<DoubleSpan>) -> OwnedRows {
        OwnedRows::Double(rows)
    }

    fn rows<'a>(rows: &Rows<'a>) -> Option<RowsRef<'a, DoubleSpan>> {
        match rows {
            Rows::Double(rows) => Some(*rows),
            Rows::Fixed(_) => None,
        }
    }
}

/// The arrays of a whole model.
#[derive(Debug)]
pub(crate) struct ModelArrays {
    pub frame: Frame,
    pub format: DexelFormat,
    pub rays: [Option<OwnedRows>; 3],
}

impl ModelArrays {
    pub fn view(&self) -> TriDexelRef<'_> {
        let rays = self.rays.each_ref().each(|rows| {
            rows.as_ref().map(|rows| match rows {
                OwnedRows::Fixed(rows) => Rows::Fixed(rows.view()),
                OwnedRows::Double(rows) => Rows::Double(rows.view()),
            })
        });
        TriDexelRef { frame: self.frame, format: self.format, rays, checked: true }
    }
}
