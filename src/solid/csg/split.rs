//! A CSG expression as a solid.

use super::Csg;
use super::bounds::Octants;
use super::kleene::Kleene;
use super::program::Program;
use super::scratch::{Ask, Cells, CsgPart, CsgScratch};
use crate::error::Error;
use crate::lattice::{Cube, Frame};
use crate::octree::{Planes, Tag};
use crate::solid::{Fingerprint, Solid, Verdict};
use alloc::vec::Vec;

impl Solid for Csg {
    type Part = CsgPart;
    type Scratch = CsgScratch;

    fn root(&self, scratch: &mut CsgScratch, frame: &Frame) -> Result<Verdict<CsgPart>, Error> {
        let Cells { kleene, parts } = scratch.begin(Program::new(self, frame)?, frame)?;
        Ok(kleene.verdict(0, parts[0]))
    }

    fn split(
        &self,
        scratch: &mut CsgScratch,
        cube: &Cube<'_>,
        part: &CsgPart,
    ) -> Result<[Verdict<CsgPart>; 8], Error> {
        let cells = scratch.with_program(|scratch, program| {
            scratch.cells(program, *part, &Octants::of(cube.cell), Ask::Split(cube))
        })?;
        let Some(Cells { kleene, parts }) = cells else { return Ok([Verdict::Undecided; 8]) };
        Ok([0, 1, 2, 3, 4, 5, 6, 7].map(|k| kleene.verdict(k, parts[k as usize])))
    }

    fn split64(
        &self,
        scratch: &mut CsgScratch,
        cube: &Cube<'_>,
        part: &CsgPart,
        parts: &mut Vec<(u8, CsgPart)>,
    ) -> Result<Planes, Error> {
        parts.try_reserve(64).map_err(|_| Error::OutOfMemory)?;
        let planes = scratch.with_program(|scratch, program| {
            let octants = scratch.cells(program, *part, &Octants::of(cube.cell), Ask::Split(cube))?;
            let mut planes = Planes::uniform(Tag::Empty);
            for k in 0..8u8 {
                let (lower, upper) = (octants.kleene.lower >> k & 1 != 0, octants.kleene.upper >> k & 1 != 0);
                let part = octants.parts[k as usize];
                let mut cells =
                    Kleene { lower: if lower { 0xFF } else { 0 }, upper: if upper { 0xFF } else { 0 } };
                if upper && !lower && part.len > 0 {
                    let child = cube.child(k);
                    let split = scratch.cells(program, part, &Octants::of(child.cell), Ask::Split(&child))?;
                    cells = split.kleene;
                    let mut partial = cells.partial();
                    while partial != 0 {
                        let c = partial.trailing_zeros() as u8;
                        partial &= partial - 1;
                        if split.parts[c as usize].len > 0 {
                            parts.push((8 * k + c, split.parts[c as usize]));
                        }
                    }
                }
                planes.lower |= (cells.lower as u64) << (8 * k);
                planes.upper |= (cells.upper as u64) << (8 * k);
            }
            Ok(planes)
        })?;
        Ok(planes.unwrap_or(Planes::uniform(Tag::Partial)))
    }

    fn sample(
        &self,
        scratch: &mut CsgScratch,
        cube: &Cube<'_>,
        part: &CsgPart,
    ) -> Result<Option<bool>, Error> {
        let inside = scratch.with_program(|scratch, program| scratch.contains(program, *part, cube))?;
        Ok(inside.flatten())
    }

    fn sample64(
        &self,
        scratch: &mut CsgScratch,
        cube: &Cube<'_>,
        parts: &[(u8, CsgPart)],
    ) -> Result<Option<u64>, Error> {
        let inside = scratch.with_program(|scratch, program| scratch.contained(program, cube, parts))?;
        Ok(inside.flatten())
    }

    fn exterior(&self, frame: &Frame) -> Tag {
        self.root.exterior(frame).unwrap_or(Tag::Partial)
    }

    fn nesting(&self) -> u32 {
        self.root.nesting
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        self.fingerprint_of_expression()
    }

    fn hand_over(&self, from: &CsgScratch, part: &CsgPart, to: &mut CsgScratch) -> Result<CsgPart, Error> {
        to.copy(from, *part)
    }
}
