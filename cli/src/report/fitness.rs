//! The verdict on a mesh: whether it is fit for printing and for making a solid.

use crate::failure::{Failure, Of};
use crate::source::input::Input;
use crate::source::mesh::openness;
use crate::words::{count, counted, number};
use leafless::{Control, TriangleMesh};
use serde::Serialize;

/// The verdict.
#[derive(Serialize)]
pub struct Fitness {
    input: String,
    pub fit: bool,
    /// The reasons against it.
    reasons: Vec<String>,
    /// Vertices that were moved to close hair cracks, and the greatest move. The file has these cracks.
    sewn: u64,
    displacement: f64,
}

impl Fitness {
    pub fn new(input: &Input, mesh: &TriangleMesh) -> Result<Fitness, Failure> {
        let report = mesh.report().of(input)?;
        let mut reasons: Vec<String> = openness(&report).into_iter().collect();
        let mut add = |number: u64, one: &str, many: &str| {
            if number > 0 {
                reasons.push(counted(number, one, many));
            }
        };
        add(report.opposite, "wall has no thickness", "walls have no thickness");
        add(report.duplicate, "triangle repeats another", "triangles repeat others");
        add(
            report.non_manifold_edges,
            "edge has more than two triangles, and no thickness",
            "edges have more than two triangles, and no thickness",
        );
        let pairs = mesh.intersecting_pairs(0, &Control::default()).of(input)?;
        let more = if pairs.is_complete { "" } else { " or more" };
        if pairs.count > 0 {
            reasons.push(format!("{}{more} pairs of triangles intersect", count(pairs.count)));
        } else if report.overlapping_bodies > 0 {
            let bodies = counted(report.overlapping_bodies, "body overlaps", "bodies overlap");
            reasons.push(format!("{bodies} another"));
        }
        if report.triangles == 0 {
            reasons.push("there is no triangle".into());
        } else if report.is_closed() && mesh.volume() <= 0.0 {
            reasons.push("it is inside out, or encloses nothing".into());
        }
        let fit = reasons.is_empty();
        Ok(Fitness {
            input: input.to_string(),
            fit,
            reasons,
            sewn: report.sewn,
            displacement: report.displacement,
        })
    }

    /// Returns the verdict in one line, without the name of the file.
    pub fn verdict(&self) -> String {
        if !self.fit {
            return format!("not fit: {}", self.reasons.join("; "));
        }
        let sewn = match self.sewn {
            0 => String::new(),
            sewn => format!(
                "; {} moved by {} or less to close hair cracks, as `leafless convert` writes it",
                counted(sewn, "vertex was", "vertices were"),
                number(self.displacement)
            ),
        };
        format!(
            "fit: closed, all facets face outward, no triangles intersect, and no wall without thickness was found{sewn}"
        )
    }

    /// Returns the verdict in one line, with the name of the file.
    pub fn text(&self) -> String {
        format!("{}: {}\n", self.input, self.verdict())
    }
}
