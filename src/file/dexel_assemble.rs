//! The file of a tri-dexel model: header, record and sections.

use super::compose::{Deliver, Section, bytes_of, compose};
use super::elements::Elements;
use super::form::Form;
use super::header::{DEXELS_MINOR, FLAG_DEXELS, HEADER_LENGTH, Header, MAGIC, MAJOR};
use super::kind::{Column, Kind};
use super::object::Object;
use crate::dexel::{ColumnsRef, NormalsRef, Rows, RowsRef, Span, TriDexel, TriDexelRef, with_rows};
use crate::error::Error;
use crate::lattice::axes;
use crate::memory;
use crate::octree::metadata::MetadataLimit;
use alloc::vec::Vec;
use bytemuck::Zeroable;

/// Lays out the file of `model` and tells `deliver` its length and how to write it.
pub(super) fn assemble(model: &TriDexel, deliver: Deliver<'_>) -> Result<(), Error> {
    let view = model.view();
    view.check()?;
    let metadata = bytes_of(model.metadata(), MetadataLimit::SOLID)?;
    let header = header(view);
    let objects = [Object::main(&header)];
    let mut windows: Vec<[u32; 4]> = memory::with_capacity(3)?;
    for rows in view.rays.iter().flatten() {
        let window = with_rows!(rows, rows => rows.window);
        let ([u, v], [width, height]) = (window.first, window.size);
        windows.push([u, v, width, height]);
    }
    let mut sections: Vec<Section<'_>> = memory::with_capacity(Kind::MOST)?;
    sections.push((0, Kind::Metadata, Elements::Bytes(&metadata)));
    sections.push((0, Kind::Windows, Elements::Windows(&windows)));
    for (axis, rows) in view.rays.iter().enumerate() {
        match rows {
            Some(Rows::Fixed(rows)) => sections.extend(columns(axis, rows, Elements::Pairs32)),
            Some(Rows::Double(rows)) => sections.extend(columns(axis, rows, Elements::Pairs64)),
            None => {}
        }
    }
    compose(header, &objects, &sections, deliver)
}

fn header(model: &TriDexelRef<'_>) -> Header {
    let [x, y, z] = axes(|axis| model.rays(axis).map_or(0, |rays| rays.interval_count()));
    Header {
        magic: MAGIC,
        major: MAJOR,
        minor: DEXELS_MINOR,
        header_length: HEADER_LENGTH as u32,
        flags_required: FLAG_DEXELS,
        origin: model.frame.origin().map(f64::to_bits),
        edge: model.frame.edge().to_bits(),
        depth: model.frame.depth(),
        form: Form { format: model.format, directions: model.directions() }.bits(),
        elements: x,
        bricks: y,
        dictionary_entries: z,
        ..Header::zeroed()
    }
}

/// The sections of a direction, whose spans are pairs of the numbers that `spans` takes.
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
    .map(|(column, elements)| (0, Kind::along(axis, column), elements))
}
