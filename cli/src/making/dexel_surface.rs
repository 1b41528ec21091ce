//! Surfaces of tri-dexel models.

use crate::failure::{Failure, Of};
use crate::progress::watched;
use crate::source::input::Input;
use crate::words::{count, counted};
use leafless::dexel::DexelNormals;
use leafless::surface::{DexelSurfaceReport, dual_contouring_dexels, marching_cubes_dexels};
use leafless::{TriDexel, TriangleMesh};
use serde::Serialize;

/// Statistics of a surface that follows the rays of a model.
#[derive(Serialize)]
pub struct Followed {
    /// Pairs of neighbouring cell centres between which a ray crosses the surface.
    crossings: u64,
    /// Pairs between which the ray crosses more than once.
    several: u64,
    /// Crossings that were put half-way, because no rays run along that direction.
    without_rays: u64,
    /// Crossings that were put half-way, because directions disagree.
    disagreeing: u64,
    /// Vertices that would fit better outside their cells; by dual contouring only.
    clamped: u64,
    /// Bodies that are missing because doubles cannot distinguish their surface from their centres.
    vanished: u64,
    /// Intervals that contain no centre of a cell and are missing.
    without_centres: u64,
}

impl From<DexelSurfaceReport> for Followed {
    fn from(report: DexelSurfaceReport) -> Followed {
        let DexelSurfaceReport { crossings, several, without_rays, disagreeing, clamped, .. } = report;
        let DexelSurfaceReport { vanished, without_centres, .. } = report;
        Followed { crossings, several, without_rays, disagreeing, clamped, vanished, without_centres }
    }
}

impl Followed {
    /// Returns the report for people.
    pub fn text(&self) -> String {
        let mut text = counted(self.crossings, "crossing", "crossings");
        for (number, what) in [
            (self.several, "are several in one place"),
            (self.without_rays, "have no rays and lie half-way"),
            (self.disagreeing, "are disputed between directions and lie half-way"),
        ] {
            if number > 0 {
                text += &format!(", {} {what}", count(number));
            }
        }
        if self.clamped > 0 {
            text += &format!("; {} kept in their cells", counted(self.clamped, "vertex", "vertices"));
        }
        if self.vanished > 0 {
            let bodies = counted(self.vanished, "body", "bodies");
            text += &format!("; {bodies} too thin to be shown");
        }
        if self.without_centres > 0 {
            let intervals = counted(self.without_centres, "interval", "intervals");
            text += &format!("; {intervals} between the centres of cells not seen");
        }
        text
    }
}

/// Returns the surface by marching cubes.
pub fn cubes(model: &TriDexel, input: &Input, threads: usize) -> Result<(TriangleMesh, Followed), Failure> {
    let made = watched("mesh", threads, |control| marching_cubes_dexels(model.view(), control));
    let (mesh, report) = made.of(input)?;
    Ok((mesh, report.into()))
}

/// Returns the surface by dual contouring; the model must have normals.
pub fn dual(model: &TriDexel, input: &Input, threads: usize) -> Result<(TriangleMesh, Followed), Failure> {
    if model.view().format().normals == DexelNormals::None {
        let problem = "stores no normals, which dual contouring needs: make it again from its source, by \
                       `leafless dexelize --normals 32`";
        return Err(Failure::of(input, problem));
    }
    let made = watched("mesh", threads, |control| dual_contouring_dexels(model.view(), control));
    let (mesh, report) = made.of(input)?;
    Ok((mesh, report.into()))
}
