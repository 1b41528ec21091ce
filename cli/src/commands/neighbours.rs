//! `leafless neighbours`: the cells beside given cells.

use crate::failure::Failure;
use crate::rows::{Questions, serve};
use crate::sink::{self, print};
use crate::source::input::Input;
use clap::{Args, ValueEnum};
use leafless::octree::{Cursor, Direction, TaggedCell};
use leafless::{Cell, OctreeRef, Tag};
use serde::Serialize;
use std::ffi::OsString;
use std::fmt::Write;

/// Reads cells from standard input, one a line: the level, and the cell's x, y and z among the cells of its
/// level, counted from 0. Empty lines and lines that begin with # are skipped.
///
/// Prints one line for each neighbour of a cell: the steps along x, y and z that lead to it, its tag (empty,
/// full, partial, or branch for a cell that is split), its level, and its x, y and z. The neighbour is as
/// large as the cell, or a larger cell that is not split. There is none outside the cube of the solid. An
/// empty line ends the answer.
#[derive(Args)]
pub struct Arguments {
    /// Solid (.lfl)
    file: OsString,
    /// Which neighbours to list
    #[arg(long, value_enum, default_value_t = Through::Faces)]
    through: Through,
    /// In place of a neighbour that is split, list all smaller cells in it that touch the cell
    #[arg(long)]
    smaller: bool,
    /// Print one line of JSON for each cell
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Through {
    /// The 6 that share a face
    Faces,
    /// The 18 that share an edge
    Edges,
    /// The 26 that share a vertex
    Vertices,
}

impl Through {
    fn directions(self) -> &'static [Direction] {
        match self {
            Through::Faces => &Direction::ALL[..6],
            Through::Edges => &Direction::ALL[..18],
            Through::Vertices => &Direction::ALL,
        }
    }
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let input = Input::file(&arguments.file, "cells")?;
    let (octree, _) = input.octree(true)?;
    let tree = octree.view();
    serve(&mut Batch { tree, cursor: Cursor::new(tree), arguments, text: String::new() })
}

/// The answers to the cells so far.
struct Batch<'t, 'a> {
    tree: &'t OctreeRef<'a>,
    cursor: Cursor<'a>,
    arguments: &'t Arguments,
    text: String,
}

#[derive(Serialize)]
struct Neighbour {
    steps: [i8; 3],
    tag: &'static str,
    level: u8,
    cell: [u32; 3],
}

impl Neighbour {
    fn new(direction: Direction, TaggedCell { cell, tag }: TaggedCell) -> Neighbour {
        let tag = match tag {
            Tag::Empty => "empty",
            Tag::Full => "full",
            Tag::Partial => "partial",
            Tag::Branch => "branch",
        };
        Neighbour { steps: direction.steps(), tag, level: cell.level, cell: cell.at }
    }
}

/// Returns the number as a whole number, if it is one.
fn whole(number: f64) -> Option<u32> {
    let whole = number as u32;
    (f64::from(whole) == number).then_some(whole)
}

impl Questions<4> for Batch<'_, '_> {
    fn ask(&mut self, numbers: [f64; 4]) -> Result<(), String> {
        let [Some(level), Some(x), Some(y), Some(z)] = numbers.map(whole) else {
            return Err("the level and the coordinates of a cell must be whole numbers, 0 or more".into());
        };
        let level = u8::try_from(level).unwrap_or(u8::MAX);
        let depth = self.tree.frame().depth();
        let found = self.cursor.seek(Cell { level, at: [x, y, z] });
        if !found.map_err(|error| format!("{error} (the depth is {depth})"))? {
            let leaf = self.cursor.cell();
            let [x, y, z] = leaf.at;
            return Err(format!(
                "there is no such cell: it lies in cell {x} {y} {z} of level {}",
                leaf.level
            ));
        }
        let mut neighbours = Vec::new();
        for &direction in self.arguments.through.directions() {
            let told = |found| Neighbour::new(direction, found);
            if self.arguments.smaller {
                neighbours.extend(self.cursor.neighbours(direction).map(told));
            } else {
                neighbours.extend(self.cursor.neighbour(direction).map(told));
            }
        }
        if self.arguments.json {
            self.text
                .push_str(&sink::json_line(&neighbours).map_err(|_| "cannot be written as JSON".to_owned())?);
            return Ok(());
        }
        for Neighbour { steps: [dx, dy, dz], tag, level, cell: [x, y, z] } in neighbours {
            // Writing to a string does not fail.
            let _ = writeln!(self.text, "{dx} {dy} {dz} {tag} {level} {x} {y} {z}");
        }
        self.text.push('\n');
        Ok(())
    }

    fn answer(&mut self) -> Result<(), Failure> {
        print(self.text.as_bytes())?;
        self.text.clear();
        Ok(())
    }
}
