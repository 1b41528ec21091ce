//! The elements of a PLY, and the mesh made from them.

use alloc::vec::Vec;

use super::header::Element;
use super::indices::push_strips;
use super::palette::Palette;
use super::source::Source;
use super::steps::{Step, least, steps};
use crate::error::Error;
use crate::exchange::MeshWarning;
use crate::exchange::bytes::TOO_SHORT;
use crate::exchange::colours::{self, Colours};
use crate::exchange::declared::Declared;
use crate::exchange::polygons::Polygons;
use crate::memory;
use crate::mesh::{MeshAttribute, TriangleMesh};

/// Reads all elements, up to the end of the file.
pub(super) fn read_elements<S: Source>(
    (elements, declared): (&[Element], Vec<Declared<'_>>),
    mut source: S,
    warnings: &mut Vec<MeshWarning>,
) -> Result<TriangleMesh, Error> {
    let mut mesh = Polygons::default();
    let mut palette = Palette { declared, ..Palette::default() };
    let vertex = elements.iter().find(|element| element.name == b"vertex");
    let vertices = vertex.map_or(0, |element| element.count);
    if let Some(vertex) = vertex.filter(|_| vertices > u32::MAX.into()) {
        return Err(vertex.at.error("at most 2^32 - 1 vertices").into());
    }
    let mut indices = Vec::new();
    // The first line with too many values, and the number of such lines.
    let mut longer = (0, 0);
    for element in elements {
        let steps = steps(element, &mut palette.declared, warnings)?;
        let least = least(element);
        // At most the count, so there is no overflow.
        let present = (source.at_most(least.0, least.1) as u64).min(element.count) as usize;
        match element.name {
            b"vertex" => mesh.reserve(present, 0)?,
            b"face" => mesh.reserve(0, present)?,
            _ => {}
        }
        if steps.is_empty() {
            continue;
        }
        let has_colour = steps.iter().any(|step| matches!(step, Step::Channel { .. }));
        let mut colours = has_colour.then(Colours::default);
        if has_colour && element.name == b"face" {
            colours::fill(&mut palette.rows, mesh.triangle_count(), MeshAttribute::NO_ROW)?;
        }
        let mut more = None;
        let has_values = steps.iter().any(|step| matches!(step, Step::Value { .. }));
        let mut values = memory::filled(if has_values { palette.declared.len() } else { 0 }, [f64::NAN; 4])?;
        for _ in 0..element.count {
            let start = source;
            let mut vertex = [0.0; 3];
            let mut colour = [0.0, 0.0, 0.0, 255.0];
            let before = mesh.triangle_count();
            values.iter_mut().for_each(|value| *value = [f64::NAN; 4]);
            for step in &steps {
                match *step {
                    Step::Skip { values, bytes } => source.skip(values, bytes)?,
                    Step::SkipList { count, kind } => {
                        let before = source;
                        let count = source.count(count)?;
                        let bytes = count.checked_mul(kind.size() as u64);
                        source.skip(count, bytes.ok_or_else(|| before.error(TOO_SHORT))?)?;
                    }
                    Step::Coordinate { axis, kind } => vertex[axis] = source.coordinate(kind)?,
                    Step::Channel { channel, kind } => {
                        colour[channel] = source.value(kind)?.map_or(f64::NAN, |value| kind.channel(value));
                    }
                    Step::Value { attribute, component, kind } => {
                        values[attribute][component] = source.value(kind)?.unwrap_or(f64::NAN);
                    }
                    Step::Indices(list) => {
                        let before = source;
                        let count = source.count(list.count)?;
                        if count < 3 && !list.strips {
                            return Err(before.error("a face of at least three vertices").into());
                        }
                        indices.clear();
                        source.indices(&mut indices, count, &list, vertices)?;
                        if list.strips {
                            push_strips(&mut mesh, &indices).map_err(|why| {
                                why.unwrap_or(before.error("strips of at least three vertices").into())
                            })?;
                        } else {
                            mesh.push_face(&indices)?;
                        }
                    }
                }
            }
            if element.name == b"vertex" {
                mesh.push_vertex(vertex)?;
            }
            if let Some(colours) = &mut colours {
                if element.name == b"face" {
                    colours::fill(&mut palette.rows, mesh.triangle_count(), colours.len() as u32)?;
                }
                colours.push(colour)?;
            }
            for (attribute, value) in palette.declared.iter_mut().zip(&values) {
                attribute.push(before, mesh.triangle_count(), value)?;
            }
            let found = source.end_element(&start, more)?;
            if found > 0 && longer.1 == 0 {
                longer.0 = source.line();
            }
            longer.1 += u64::from(found > 0);
            more = Some(found);
        }
        match element.name {
            b"vertex" => palette.vertices = colours,
            _ => palette.faces = palette.faces.or(colours),
        }
    }
    source.end_file()?;
    if let (line, lines @ 1..) = longer {
        memory::push(warnings, MeshWarning::MoreValues { line, lines })?;
    }
    if let colours @ 1.. = palette.unreadable() {
        memory::push(warnings, MeshWarning::Colours { colours })?;
    }
    mesh.finish_with(|triangles| palette.attributes(triangles))
}
