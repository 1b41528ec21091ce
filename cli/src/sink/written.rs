//! What a mesh file keeps of a mesh, and whether that is still a surface.

use crate::failure::{Failure, Of, complain};
use crate::sink::Output;
use crate::source::mesh::format_name;
use crate::words::{count, counted, number};
use leafless::TriangleMesh;
use leafless::exchange::{MeshFormat, WriteOptions, WrittenForm, written_form};
use leafless::mesh::MeshReport;
use serde::Serialize;

/// What rounding to the coordinates of a format costs.
#[derive(Serialize)]
pub struct Losses {
    /// The farthest that a vertex is moved along an axis.
    pub rounding: f64,
    /// Vertices that are put where others are.
    merged: u64,
    /// Triangles of which two corners are put at one place.
    degenerate: u64,
    /// Other triangles without area, whose corners are three different vertices on a line.
    flat: u64,
    /// Whether the surface is broken by rounding, so that the file is written only with --lossy.
    broken: bool,
}

impl Losses {
    /// Whether triangles are lost; of an empty mesh these are all.
    pub fn has_lost(&self) -> bool {
        self.degenerate > 0
    }

    /// The same for people; `None` if nothing is rounded.
    pub fn text(&self) -> Option<String> {
        if self.rounding == 0.0 {
            return None;
        }
        let mut text = format!("rounded to 32 bits, by up to {}", number(self.rounding));
        if (self.merged, self.degenerate) != (0, 0) {
            let vertices = counted(self.merged, "vertex", "vertices");
            let triangles = counted(self.degenerate, "degenerate triangle", "degenerate triangles");
            text += &format!("; {vertices} and {triangles} lost");
        }
        if self.flat > 0 {
            text += &format!("; {} without area", counted(self.flat, "triangle", "triangles"));
        }
        Some(text)
    }
}

/// The mesh that is read back from the file, and what was lost. Warns of lost triangles.
///
/// Refuses a file of which a reader gets another kind of surface, unless it is wanted all the same: one that is open or
/// has edges at which more than two triangles meet, has more or fewer components, or encloses nothing, where the mesh is
/// not so.
pub fn kept<'a>(
    mesh: &'a TriangleMesh,
    format: MeshFormat,
    options: &WriteOptions,
    is_lossy: bool,
    output: &Output,
) -> Result<(WrittenForm<'a>, Losses), Failure> {
    let kept = written_form(mesh, format, options).of(output)?;
    let WrittenForm { rounding, merged, degenerate, .. } = kept;
    let flat = kept.mesh.report().of(output)?.flat;
    let mut losses = Losses { rounding, merged, degenerate, flat, broken: false };
    if rounding == 0.0 {
        return Ok((kept, losses));
    }
    let problem = problem(mesh, &kept.mesh).of(output)?;
    losses.broken = problem.is_some();
    let name = format_name(format).to_uppercase();
    let how = format!("rounding to the 32-bit coordinates of {name}, by up to {},", number(rounding));
    let lost = format!(
        "{} of {} and {} of {}",
        count(merged),
        counted(mesh.vertices().len() as u64, "vertex", "vertices"),
        count(degenerate),
        counted(mesh.triangles().len() as u64, "triangle", "triangles"),
    );
    let others = "PLY, OBJ, OFF and 3MF keep doubles";
    match problem {
        Some(problem) if !is_lossy => {
            let problem = format!("was not written: {how} loses {lost}, and {problem}");
            return Err(Failure::of(
                output,
                format_args!("{problem}; {others}, and --lossy writes it as it is"),
            ));
        }
        Some(problem) => {
            complain(&format!("{output}: warning: {how} loses {lost}, and {problem}; {others}"));
        }
        None if degenerate > 0 => {
            complain(&format!("{output}: warning: {how} loses {lost}; {others}"));
        }
        None => {}
    }
    Ok((kept, losses))
}

/// What is wrong with a surface after rounding that was not so before.
fn problem(before: &TriangleMesh, after: &TriangleMesh) -> Result<Option<String>, leafless::Error> {
    let reports: [MeshReport; 2] = [before.report()?, after.report()?];
    let [old, new] = &reports;
    let volumes = [before.volume(), after.volume()];
    Ok(if new.triangles == 0 && old.triangles > 0 {
        Some("nothing is left".into())
    } else if old.is_closed() && !new.is_closed() {
        let edges = new.boundary_edges + new.misoriented_edges;
        Some(format!("the surface is no longer closed at {}", counted(edges, "edge", "edges")))
    } else if old.is_closed() && volumes[0] != 0.0 && volumes[0].signum() * volumes[1] <= 0.0 {
        Some("the surface is flat: it encloses no volume any more".into())
    } else if old.is_manifold() && !new.is_manifold() {
        let edges = counted(new.non_manifold_edges, "edge", "edges");
        Some(format!("the surface touches itself: at {edges} more than two triangles meet"))
    } else if old.bodies != new.bodies {
        let components = counted(old.bodies, "component", "components");
        Some(format!(
            "of {components} {} left",
            match new.bodies {
                1 => "1 is".to_owned(),
                bodies => format!("{} are", count(bodies)),
            }
        ))
    } else {
        None
    })
}
