//! Attributes in a PLY: comments in its header declare properties of faces as attributes.
//!
//! `comment leafless attribute N NAME` announces an attribute of N numbers. Its property is NAME, or NAME_0,
//! NAME_1 … if there are several. A property of the type `uint` is a label; the greatest `uint` means no
//! label. `comment leafless name NAME TEXT` adds the name of the next label.

use crate::error::Error;
use crate::exchange::colours::fill;
use crate::memory;
use crate::mesh::MeshAttribute;
use alloc::string::String;
use alloc::vec::Vec;

/// The beginning of a comment that announces an attribute.
pub(super) const ATTRIBUTE: &str = "leafless attribute ";
/// Maximum number of attributes; further ones are ignored.
const MOST: usize = 64;

/// The beginning of a comment that names a label.
pub(super) const LABEL: &str = "leafless name ";

/// An attribute that a header announces, with its values.
pub(super) struct Declared<'a> {
    pub name: &'a str,
    pub components: usize,
    names: Vec<&'a str>,
    is_found: bool,
    is_label: bool,
    values: Vec<f64>,
    rows: Vec<u32>,
}

/// Evaluates a comment of a header that concerns attributes. Other comments are ignored.
pub(super) fn declare<'a>(declared: &mut Vec<Declared<'a>>, comment: &'a [u8]) -> Result<(), Error> {
    let Ok(comment) = core::str::from_utf8(comment) else { return Ok(()) };
    let comment = comment.trim();
    if let Some((count, name)) = comment.strip_prefix(ATTRIBUTE).and_then(|rest| rest.split_once(' ')) {
        let is_new = declared.iter().all(|other| other.name != name) && !is_taken(name);
        let is_welcome = is_new && is_property(name) && declared.len() < MOST;
        if let (Ok(components @ 1..=4), true) = (count.parse(), is_welcome) {
            let attribute = Declared {
                name,
                components,
                names: Vec::new(),
                is_found: false,
                is_label: false,
                values: Vec::new(),
                rows: Vec::new(),
            };
            memory::push(declared, attribute)?;
        }
    } else if let Some((name, text)) = comment.strip_prefix(LABEL).and_then(|rest| rest.split_once(' '))
        && let Some(attribute) = declared.iter_mut().find(|other| other.name == name)
    {
        memory::push(&mut attribute.names, text.trim())?;
    }
    Ok(())
}

/// Returns whether this name is reserved for other properties of faces or other attributes.
pub(super) fn is_taken(name: &str) -> bool {
    let name = name.strip_prefix("diffuse_").unwrap_or(name);
    matches!(
        name,
        "colour" | "face_colour" | "red" | "green" | "blue" | "alpha" | "vertex_indices" | "vertex_index"
    )
}

/// Returns whether a property may have this name.
pub(super) fn is_property(name: &str) -> bool {
    !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_graphic())
}

/// Returns the attribute and the component that a property belongs to.
pub(super) fn place_of(declared: &[Declared<'_>], property: &[u8]) -> Option<(usize, usize)> {
    let property = core::str::from_utf8(property).ok()?;
    declared.iter().enumerate().find_map(|(place, attribute)| {
        let rest = property.strip_prefix(attribute.name)?;
        let component = match attribute.components {
            1 => rest.is_empty().then_some(0)?,
            count => rest.strip_prefix('_')?.parse().ok().filter(|&component| component < count)?,
        };
        Some((place, component))
    })
}

impl Declared<'_> {
    /// Records that one of its properties is present, with whole numbers or others.
    pub fn found(&mut self, is_whole: bool) {
        self.is_found = true;
        self.is_label = is_whole && self.components == 1;
    }

    /// Returns whether one of its properties is present.
    pub fn is_found(&self) -> bool {
        self.is_found
    }

    /// Assigns the values of a face to the triangles of that face, up to the given number of triangles.
    pub fn push(&mut self, before: usize, triangles: usize, values: &[f64; 4]) -> Result<(), Error> {
        if !self.is_found {
            return Ok(());
        }
        fill(&mut self.rows, before, MeshAttribute::NO_ROW)?;
        if self.is_label {
            // (NaN means no label.)
            let label = if values[0] >= 0.0 { values[0] as u32 } else { MeshAttribute::NO_ROW };
            return fill(&mut self.rows, triangles, label);
        }
        fill(&mut self.rows, triangles, (self.values.len() / self.components) as u32)?;
        self.values.try_reserve(self.components)?;
        self.values.extend(&values[..self.components]);
        Ok(())
    }

    pub fn finish(mut self, triangles: usize) -> Result<MeshAttribute, Error> {
        fill(&mut self.rows, triangles, MeshAttribute::NO_ROW)?;
        if !self.is_label {
            return MeshAttribute::by_triangle(self.name, self.components, self.values, self.rows);
        }
        let mut names: Vec<String> = memory::with_capacity(self.names.len())?;
        for name in &self.names {
            names.push(memory::text(name)?);
        }
        Ok(MeshAttribute::labels(self.name, self.rows)?.named(names))
    }
}
