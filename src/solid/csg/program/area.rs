//! The area of the boundary that half-spaces and other solids form in a cell.

use super::Program;
use super::word::Op;
use super::worker::{CsgPart, Scratch};
use crate::cut;
use crate::error::Error;
use crate::lattice::{Cell, Interval};
use crate::solid::Ask;
use crate::solid::half_space::function;

impl Scratch {
    /// Returns bounds of the area of the boundary in a cell; `None` if too little is known of an operand that
    /// is open there.
    pub(crate) fn area(
        &mut self,
        program: &Program,
        cell: Cell,
        part: CsgPart,
    ) -> Result<Option<Interval>, Error> {
        if program.paper || part.len == 0 {
            return Ok(None);
        }
        if part.is_table() || part.len == 1 {
            return Ok(self.area_of_half_spaces(program, cell, part));
        }
        let mut sum = 0.0;
        for i in 0..part.words() {
            let own = match Scratch::list(program, &self.words, part)[i].op() {
                Op::HalfSpace { index, .. } => match program.half_spaces[index as usize].degree() {
                    Some(degree) => cut::most_area(degree),
                    None => return Ok(None),
                },
                Op::Solid { index, .. } => {
                    let Some((solid, part)) = self.slot(program, index)? else { return Ok(None) };
                    let worker = &mut Scratch::other(&mut self.workers, program, solid)?.worker;
                    match worker.area(cell, &part)? {
                        Some(area) => area.upper,
                        None => return Ok(None),
                    }
                }
                Op::Join { .. } => 0.0,
                Op::Unknown | Op::Group { .. } | Op::Primitive { .. } => return Ok(None),
            };
            sum = (sum + own).next_up();
        }
        Ok(Some(Interval::between(0.0, sum)))
    }

    fn area_of_half_spaces(&self, program: &Program, cell: Cell, part: CsgPart) -> Option<Interval> {
        let half_spaces = &*program.half_spaces;
        if !part.is_table() {
            return self.literals(program, part)?.area(half_spaces, cell);
        }
        let (variables, table) = Scratch::table_of(Scratch::list(program, &self.words, part));
        function::area(variables.iter().map(|word| word.variable()), table, half_spaces, cell)
    }
}
