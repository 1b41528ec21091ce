//! Materials of an OBJ, collected for an attribute of a mesh.

use super::colours::fill;
use super::{is_line_end, is_space};
use crate::error::Error;
use crate::memory;
use crate::mesh::MeshAttribute;
use alloc::string::String;
use alloc::vec::Vec;
use hashbrown::HashMap;

/// The materials of triangles.
pub(super) struct Materials<'a> {
    numbers: HashMap<&'a str, u32>,
    names: Vec<&'a str>,
    rows: Vec<u32>,
    /// The material of the next face.
    current: u32,
}

impl Default for Materials<'_> {
    fn default() -> Self {
        let current = MeshAttribute::NO_ROW;
        Materials { numbers: HashMap::new(), names: Vec::new(), rows: Vec::new(), current }
    }
}

impl<'a> Materials<'a> {
    /// Sets the material of the next faces from the text after the keyword: none if there is no name. A
    /// comment begins with a blank and `#`.
    pub fn choose(&mut self, rest: &'a [u8]) -> Result<(), Error> {
        let line = rest.split(|&byte| is_line_end(byte)).next().unwrap_or(&[]);
        let comment = line.windows(2).position(|pair| is_space(pair[0]) && pair[1] == b'#');
        let line = &line[..comment.unwrap_or(line.len())];
        // (A name that is not UTF-8 counts as no name.)
        let name = core::str::from_utf8(line).unwrap_or("").trim();
        if name.is_empty() {
            self.current = MeshAttribute::NO_ROW;
            return Ok(());
        }
        self.numbers.try_reserve(1)?;
        let next = self.names.len() as u32;
        self.current = *self.numbers.entry(name).or_insert(next);
        if self.current == next {
            memory::push(&mut self.names, name)?;
        }
        Ok(())
    }

    /// Assigns the current material to all triangles up to a number.
    #[inline]
    pub fn give(&mut self, triangles: usize) -> Result<(), Error> {
        if self.names.is_empty() {
            return Ok(());
        }
        fill(&mut self.rows, triangles, self.current)
    }

    /// Leaves the triangles up to a number, which precede the first material, without a material.
    #[inline]
    pub fn begin(&mut self, triangles: usize) -> Result<(), Error> {
        fill(&mut self.rows, triangles, MeshAttribute::NO_ROW)
    }

    /// Returns the attribute, if a triangle has a material.
    pub fn attributes(mut self, triangles: usize) -> Result<Vec<MeshAttribute>, Error> {
        let mut attributes = Vec::new();
        if self.rows.iter().any(|&row| row != MeshAttribute::NO_ROW) {
            self.begin(triangles)?;
            let mut names: Vec<String> = memory::with_capacity(self.names.len())?;
            for name in &self.names {
                names.push(memory::text(name)?);
            }
            memory::push(&mut attributes, MeshAttribute::labels("material", self.rows)?.named(names))?;
        }
        Ok(attributes)
    }
}
