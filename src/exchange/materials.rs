//! The materials of an OBJ, on the way to an attribute of a mesh.

use super::colours::fill;
use super::{is_line_end, is_space};
use crate::error::Error;
use crate::memory;
use crate::mesh::MeshAttribute;
use alloc::string::String;
use alloc::vec::Vec;
use hashbrown::HashMap;

/// Which material triangles have.
pub(super) struct Materials<'a> {
    numbers: HashMap<&'a str, u32>,
    names: Vec<&'a str>,
    rows: Vec<u32>,
    /// That of the next face.
    current: u32,
}

impl Default for Materials<'_> {
    fn default() -> Self {
        let current = MeshAttribute::NO_ROW;
        Materials { numbers: HashMap::new(), names: Vec::new(), rows: Vec::new(), current }
    }
}

impl<'a> Materials<'a> {
    /// Chooses the material of the next faces by what follows the keyword on its line: none if there is no
    /// name. A comment begins with a blank and `#`.
    pub fn choose(&mut self, rest: &'a [u8]) -> Result<(), Error> {
        let line = rest.split(|&byte| is_line_end(byte)).next().unwrap_or(&[]);
        let comment = line.windows(2).position(|pair| is_space(pair[0]) && pair[1] == b'#');
        let line = &line[..comment.unwrap_or(line.len())];
        // (What is no text has no name.)
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

    /// Gives it to all triangles up to a number of them.
    #[inline]
    pub fn give(&mut self, triangles: usize) -> Result<(), Error> {
        if self.names.is_empty() {
            return Ok(());
        }
        fill(&mut self.rows, triangles, self.current)
    }

    /// Leaves triangles up to a number of them, which came before the first material, without one.
    #[inline]
    pub fn begin(&mut self, triangles: usize) -> Result<(), Error> {
        fill(&mut self.rows, triangles, MeshAttribute::NO_ROW)
    }

    /// The attribute, if a triangle has a material.
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
