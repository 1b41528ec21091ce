//! The part of a mesh that a file keeps, and whether it is still a surface.

use crate::failure::{Failure, Of, complain};
use crate::progress::watched;
use crate::sink::Output;
use crate::source::mesh::format_name;
use crate::words::{count, counted, number};
use leafless::exchange::{MeshFormat, WriteOptions, WrittenForm, written_form};
use leafless::mesh::MeshReport;
use leafless::{Control, TriangleMesh};
use serde::Serialize;
use std::borrow::Cow;

/// The losses by rounding to the coordinates of a format.
#[derive(Serialize, Default)]
pub struct Losses {
    /// The greatest move of a vertex along an axis.
    pub rounding: f64,
    /// Number of triangles that were removed because rounding puts two of their corners at one place, with
    /// the surface left closed.
    #[serde(skip_serializing_if = "is_zero")]
    collapsed: u64,
    /// Number of triangles that became lines and were joined to their neighbours.
    #[serde(skip_serializing_if = "is_zero")]
    flipped: u64,
    /// Number of vertices that were moved to places next to their nearest ones, so that triangles have an
    /// area and do not intersect.
    #[serde(skip_serializing_if = "is_zero")]
    moved: u64,
    /// Number of vertices that coincide with others.
    merged: u64,
    /// Number of triangles with two coincident corners.
    degenerate: u64,
    /// Number of other triangles without area, whose corners are three different vertices on a line.
    flat: u64,
    /// True if rounding breaks the surface, so that the file is written only with --lossy.
    broken: bool,
}

fn is_zero(count: &u64) -> bool {
    *count == 0
}

impl Losses {
    fn take(&mut self, form: &WrittenForm<'_>) {
        (self.rounding, self.merged, self.degenerate) = (form.rounding, form.merged, form.degenerate);
    }

    /// True if triangles are lost; in an empty mesh all of them are.
    pub fn has_lost(&self) -> bool {
        self.degenerate + self.collapsed > 0
    }

    /// Returns the report for people; `None` if nothing is rounded.
    pub fn text(&self) -> Option<String> {
        if self.rounding == 0.0 {
            return None;
        }
        let mut text = format!("rounded to 32 bits, by up to {}", number(self.rounding));
        if self.collapsed + self.flipped + self.moved > 0 {
            let [collapsed, flipped] =
                [self.collapsed, self.flipped].map(|n| counted(n, "triangle", "triangles"));
            let moved = counted(self.moved, "vertex", "vertices");
            text += &format!("; {collapsed} collapsed, {flipped} turned and {moved} moved to mend that");
        }
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

/// Greatest move of vertices where rounding breaks a surface, relative to the longest extent.
const SHARE: f64 = 1e-3;

/// Options of writing a mesh.
#[derive(Clone, Copy)]
pub struct Writing {
    /// Whether a surface is written even if rounding breaks it.
    pub is_lossy: bool,
    /// Greatest move of vertices where rounding breaks it, in model units.
    pub tolerance: Option<f64>,
    pub threads: usize,
}

fn longest(mesh: &TriangleMesh) -> f64 {
    let (low, high) = mesh.bounds();
    (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max)
}

/// A mesh on its way into a file.
pub struct Kept<'a> {
    /// The mesh that is written.
    pub written: Cow<'a, TriangleMesh>,
    /// The mesh that a reader gets.
    pub read: Cow<'a, TriangleMesh>,
    /// Greatest distance of `read` from the given mesh.
    pub deviation: f64,
    pub losses: Losses,
}

/// Returns the mesh to write, the mesh that a reader gets from the file, and the losses. For an STL, places
/// that rounding breaks are repaired first. Warns of lost triangles.
///
/// Refuses a file from which a reader gets another kind of surface, unless --lossy is given: one that is
/// open, has edges with more than two triangles, has more or fewer components, or encloses nothing, while the
/// mesh does not.
pub fn kept<'a>(
    mesh: &'a TriangleMesh,
    format: MeshFormat,
    options: &WriteOptions,
    writing: Writing,
    output: &Output,
) -> Result<Kept<'a>, Failure> {
    let single = match format {
        MeshFormat::Stl => {
            let tolerance = writing.tolerance.unwrap_or_else(|| SHARE * longest(mesh));
            let mend = |control: &Control<'_>| mesh.in_single_precision(tolerance, control);
            Some(watched("rounding", writing.threads, mend).of(output)?)
        }
        _ => None,
    };
    let mut losses = Losses::default();
    let (written, read, deviation) = match single {
        Some(single) => {
            let form = written_form(&single.mesh, format, options).of(output)?;
            losses.take(&form);
            let read = Cow::Owned(form.mesh.into_owned());
            // (In an STL as text the decimal numbers are rounded, too, along each axis.)
            let added = single.deviation + 1.7321 * losses.rounding;
            losses.rounding += single.rounding;
            (losses.collapsed, losses.flipped, losses.moved) =
                (single.collapsed, single.flipped, single.moved);
            (Cow::Owned(single.mesh), read, added)
        }
        None => {
            let form = written_form(mesh, format, options).of(output)?;
            losses.take(&form);
            (Cow::Borrowed(mesh), form.mesh, 0.0)
        }
    };
    losses.flat = read.report().of(output)?.flat;
    let Losses { rounding, degenerate, .. } = losses;
    if rounding == 0.0 {
        return Ok(Kept { written, read, deviation, losses });
    }
    let problem = problem(mesh, &read).of(output)?;
    losses.broken = problem.is_some();
    let name = format_name(format).to_uppercase();
    let how = format!("rounding to the 32-bit coordinates of {name}, by up to {},", number(rounding));
    let gone = |before: usize, after: usize| count(before.saturating_sub(after) as u64);
    let (vertices, triangles) = (mesh.vertices().len(), mesh.triangles().len());
    let lost = format!(
        "{} of {} and {} of {}",
        gone(vertices, read.vertices().len()),
        counted(vertices as u64, "vertex", "vertices"),
        gone(triangles, read.triangles().len()),
        counted(triangles as u64, "triangle", "triangles"),
    );
    let others = "PLY, OBJ, OFF and 3MF keep doubles";
    match problem {
        Some(problem) if !writing.is_lossy => {
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
    Ok(Kept { written, read, deviation, losses })
}

/// Describes what is wrong with a surface after rounding but was not before.
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
