//! `leafless contains`: does the solid contain these points?

use crate::failure::Failure;
use crate::rows::{Questions, serve};
use crate::sink::print;
use crate::source::input::Input;
use clap::Args;
use leafless::solid::Prepared;
use leafless::{AnySolid, Control, Membership, OctreeRef, contains};
use std::ffi::OsString;

/// Reads points from standard input, one a line: x, y and z in the solid's units, separated by blanks, tabs
/// or commas. Empty lines and lines that begin with # are skipped.
///
/// Prints one line for each point: `inside`, `outside` or `undecided`. `inside` and `outside` are proven if
/// the solid is certified. `undecided` are points in cells that the surface may pass through, points outside
/// the solid's bounds, and points with a coordinate such as `nan`. Answers are printed as soon as lines
/// arrive, so that another program can ask and wait.
#[derive(Args)]
pub struct Arguments {
    /// Solid (.lfl)
    file: OsString,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let input = Input::file(&arguments.file, "points")?;
    // Proven answers need an intact file.
    let (octree, _) = input.octree(true)?;
    let tree = octree.view();
    let solid = tree.cuts().map(|_| Prepared::new(AnySolid::new(octree.clone())));
    serve(&mut Batch { tree, solid, points: Vec::new(), answers: Vec::new(), text: Vec::new() })
}

/// Points that are answered together.
struct Batch<'t, 'a> {
    tree: &'t OctreeRef<'a>,
    /// The octree as a solid, if its cells keep surfaces.
    solid: Option<Prepared>,
    points: Vec<[f64; 3]>,
    answers: Vec<Membership>,
    text: Vec<u8>,
}

impl Questions<3> for Batch<'_, '_> {
    fn ask(&mut self, point: [f64; 3]) -> Result<(), String> {
        self.points.push(point);
        Ok(())
    }

    fn answer(&mut self) -> Result<(), Failure> {
        if self.points.is_empty() {
            return Ok(());
        }
        self.answers.resize(self.points.len(), Membership::Undecided);
        let answered = match &self.solid {
            // Exact signs decide points next to surfaces, too.
            Some(solid) => {
                contains(solid, self.tree.frame(), &self.points, &mut self.answers, &Control::default())
            }
            None => self.tree.contains_many(&self.points, &mut self.answers),
        };
        answered.map_err(|error| Failure::Failed(error.to_string()))?;
        self.text.clear();
        for answer in &self.answers {
            self.text.extend_from_slice(match answer {
                Membership::Outside => b"outside\n",
                Membership::Inside => b"inside\n",
                Membership::Undecided => b"undecided\n",
            });
        }
        self.points.clear();
        print(&self.text)
    }
}
