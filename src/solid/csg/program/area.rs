//! The area that half-spaces bound in a cell.

use super::Program;
use super::word::{Op, Word};
use super::worker::{CsgPart, Scratch};
use crate::cut;
use crate::lattice::{Cell, Interval};
use crate::solid::half_space::bounds::{centre, half_edge};

impl Scratch {
    /// Bounds of the area of the boundary in a cell; `None` if other solids than half-spaces are open there.
    pub(crate) fn area(&self, program: &Program, cell: Cell, part: CsgPart) -> Option<Interval> {
        if program.paper || part.len == 0 {
            return None;
        }
        let taylor = |index: u32| program.half_spaces[index as usize].taylor(centre(cell), half_edge(cell));
        // A union has the boundary of the complements' intersection.
        if let Some((literals, false, _)) = self.literals(program, part) {
            let mut surfaces = [None; 3];
            for (surface, (index, complement)) in surfaces.iter_mut().zip(literals.into_iter().flatten()) {
                let own = taylor(index)?;
                *surface = Some(if complement { own.complement() } else { own });
            }
            return Some(match &surfaces {
                [Some(surface), None, None] => cut::area_of_surface(surface),
                _ => cut::area_of_faces(&surfaces),
            });
        }
        let words = Scratch::list(program, &self.words, part);
        let upper = if part.is_table() {
            let half_spaces = Scratch::table_of(words).0.iter();
            let areas = half_spaces.map(|word| Some(cut::area_of_surface(&taylor(word.variable().1)?).upper));
            areas.sum::<Option<f64>>()?
        } else {
            most_area(program, words)?
        };
        Some(Interval::between(0.0, upper))
    }
}

/// More than the area that all half-spaces of an expression have in a cell.
fn most_area(program: &Program, words: &[Word]) -> Option<f64> {
    let mut sum = 0.0;
    for word in words {
        match word.op() {
            Op::HalfSpace { index, .. } => {
                sum += cut::most_area(program.half_spaces[index as usize].degree()?)
            }
            Op::Join { .. } => {}
            Op::Solid { .. } | Op::Unknown | Op::Group { .. } | Op::Primitive { .. } => return None,
        }
    }
    Some(sum)
}
