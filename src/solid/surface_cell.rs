//! Cells in which a solid is a known function of few surfaces. There the function alone answers all
//! questions.

use super::half_space::bounds::{Octants, centre};
use super::half_space::literals::Literals;
use super::half_space::{Placed, function};
use super::{LayersQuestion, OpenSurfaces, Question};
use crate::error::Error;
use crate::lattice::Cell;
use crate::lattice::Each;

/// The functions in the children of a cell. `all` are the surfaces of the list, on the universe.
pub(crate) fn split(all: &[Placed], cell: Cell, known: &OpenSurfaces) -> Result<[OpenSurfaces; 8], Error> {
    let at = Octants::of(cell);
    let mut tables = [known.table(); 8];
    for (i, index) in known.variables() {
        let sides = all[index as usize].sides(&at, 0xFF, &mut 0)?;
        for (k, table) in (0..).zip(&mut tables) {
            *table = table.known(i, sides, k);
        }
    }
    Ok(tables.each(|table| known.with_table(table).shortened()))
}

/// Answers a question about a cell by its function.
pub(crate) fn answer(
    all: &[Placed],
    cell: Cell,
    known: &OpenSurfaces,
    question: Question<'_>,
) -> Result<(), Error> {
    let (variables, table) = (known.variables(), known.table());
    match question {
        Question::Centre(inside) => {
            let side = |index| all[index as usize].contains(centre(cell));
            *inside = function::inside(variables, table, side)?;
        }
        Question::Enclosure(enclosure) => {
            let literals = Literals::of_table(variables, table);
            *enclosure = literals.and_then(|own| own.enclosure(all, cell));
        }
        Question::Moments(moments) => *moments = function::moments(variables, table, all, cell),
        Question::Area(area) => *area = function::area(variables, table, all, cell),
        Question::Chords(chords) => *chords.found = function::chords(variables, table, all, chords.beam)?,
        Question::Surfaces(to) | Question::Layers(LayersQuestion { known: to, .. }) => *to = Some(*known),
        Question::Crossing(..) | Question::Ray(_) | Question::Nearest(..) | Question::Box(..) => {}
    }
    Ok(())
}
