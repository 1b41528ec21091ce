//! Reports of meshes.

use crate::failure::{Failure, Of};
use crate::report::bounds::Volume;
use crate::source::input::Input;
use crate::source::mesh::{fill_name, format_name, frame_around, in_words, openness};
use crate::words::{count, counted, number, put_line, short, table};
use leafless::exchange::{LengthUnit, MeshFile};
use leafless::lattice::MAX_DEPTH;
use leafless::mesh::{DefectKind, IntersectingPair, MeshDefect, MeshReport};
use leafless::{Control, Error, FillRule, Interval, MeshSolid, TriangleMesh, measure};
use serde::Serialize;

/// The findings while a mesh was read.
#[derive(Serialize)]
pub struct Mesh {
    facets_read: u64,
    triangles: u64,
    vertices: u64,
    welded: u64,
    degenerate: u64,
    boundary_edges: u64,
    boundary_loops: u64,
    misoriented_edges: u64,
    non_manifold_edges: u64,
    duplicate: u64,
    opposite: u64,
    flat: u64,
    bodies: u64,
    open_bodies: u64,
    inside_out_bodies: u64,
    sewn: u64,
    displacement: f64,
    overlapping_bodies: u64,
    undecided_bodies: u64,
    polygons: u64,
    bent_polygons: u64,
    polygon_deviation: f64,
    pub defects: Vec<Defect>,
}

/// One of the worst defects.
#[derive(Serialize)]
pub struct Defect {
    kind: &'static str,
    count: u64,
    length: f64,
    min: [f64; 3],
    max: [f64; 3],
}

/// Most defects to list.
const DEFECTS: usize = 10;

impl Mesh {
    pub fn new(mesh: &TriangleMesh) -> Result<Mesh, Error> {
        let report = mesh.report()?;
        let MeshReport { boundary_edges, misoriented_edges, non_manifold_edges, .. } = report;
        let faults = [boundary_edges, misoriented_edges, non_manifold_edges, report.duplicate, report.flat];
        // The search for defects takes time.
        let is_faultless = faults == [0; 5] && report.opposite == 0;
        let defects = if is_faultless { Vec::new() } else { mesh.defects(DEFECTS)? };
        Ok(Mesh {
            facets_read: report.facets_read,
            triangles: report.triangles,
            vertices: report.vertices,
            welded: report.welded,
            degenerate: report.degenerate,
            boundary_edges,
            boundary_loops: report.boundary_loops,
            misoriented_edges,
            non_manifold_edges,
            duplicate: report.duplicate,
            opposite: report.opposite,
            flat: report.flat,
            bodies: report.bodies,
            open_bodies: report.open_bodies,
            inside_out_bodies: report.inside_out_bodies,
            sewn: report.sewn,
            displacement: report.displacement,
            overlapping_bodies: report.overlapping_bodies,
            undecided_bodies: report.undecided_bodies,
            polygons: report.polygons,
            bent_polygons: report.bent_polygons,
            polygon_deviation: report.polygon_deviation,
            defects: defects.iter().map(Defect::new).collect(),
        })
    }
}

impl Defect {
    fn new(defect: &MeshDefect) -> Defect {
        let kind = match defect.kind {
            DefectKind::Hole => "hole",
            DefectKind::Misoriented => "misoriented",
            DefectKind::NonManifold => "non-manifold",
            DefectKind::Duplicate => "duplicate",
            DefectKind::Flat => "flat",
        };
        let (min, max) = defect.bounds;
        Defect { kind, count: defect.count, length: defect.length, min, max }
    }

    /// Describes two triangles that intersect.
    pub fn intersecting(pair: &IntersectingPair) -> Defect {
        let (min, max) = pair.bounds;
        Defect { kind: "intersecting", count: 2, length: 0.0, min, max }
    }

    /// Returns a table of defects for people.
    pub fn table(defects: &[Defect]) -> String {
        let rows: Vec<_> = (defects.iter())
            .map(|defect| {
                let [from, to] = [defect.min, defect.max].map(|corner| corner.map(short).join(" "));
                [defect.kind.to_owned(), count(defect.count), short(defect.length), from, to]
            })
            .collect();
        table(&["defect", "count", "length", "from", "to"].map(str::to_owned), &rows)
    }
}

/// Returns the volume that a mesh encloses by a fill rule, to a ten-thousandth, or the bounds known after a
/// moment. `leafless measure` has more patience.
fn volume_by(rule: FillRule, mesh: &TriangleMesh) -> Result<Interval, Error> {
    const TOLERANCE: f64 = 1e-4;
    const SPLITS: u64 = 1 << 14;
    let frame = frame_around(mesh, MAX_DEPTH)?;
    let solid = MeshSolid::new(mesh.clone(), rule)?;
    let control = Control { max_splits: Some(SPLITS), ..Control::default() };
    Ok(measure(&solid, &frame, TOLERANCE, &control)?.volume)
}

/// Most pairs of intersecting triangles that `info` locates.
const PAIRS: usize = 5;

/// The report of `info` on a mesh.
#[derive(Serialize)]
pub struct Info {
    format: &'static str,
    unit: Option<&'static str>,
    bytes: u64,
    min: [f64; 3],
    max: [f64; 3],
    /// The sum of signed volumes, by the divergence theorem; null for a mesh that bounds no solid.
    volume: Option<f64>,
    /// The volume enclosed by the rule; null unless bodies overlap or may overlap, and the volume differs.
    volume_by_rule: Option<Volume>,
    /// The rule: `nonzero`, `positive` or `evenodd`.
    rule: &'static str,
    closed: bool,
    /// Objects of a 3MF that are not solids.
    skipped: u64,
    /// Greatest distance of the true boundary from the mesh, as the file states it; null if it does not. The
    /// program does not rely on it.
    told_deviation: Option<f64>,
    /// The same distance as the user stated it; 0 if the user did not.
    deviation: f64,
    /// Departures of the file from its format that did not prevent reading it.
    warnings: Vec<String>,
    /// Number of pairs of triangles that intersect.
    intersecting_pairs: u64,
    /// True if these are all pairs: too many triangles close to each other end the search.
    all_intersecting_pairs: bool,
    mesh: Mesh,
}

impl Info {
    pub fn new(input: &Input, file: &MeshFile, fill: FillRule, bytes: u64) -> Result<Info, Failure> {
        let report = file.mesh.report().of(input)?;
        let closed = openness(&report).is_none() && report.triangles > 0;
        let (min, max) = file.mesh.bounds();
        let may_overlap = report.overlapping_bodies + report.undecided_bodies > 0;
        let by_rule = (closed && may_overlap).then(|| volume_by(fill, &file.mesh)).transpose().of(input)?;
        let pairs = file.mesh.intersecting_pairs(PAIRS, &Control::default()).of(input)?;
        let mut mesh = Mesh::new(&file.mesh).of(input)?;
        mesh.defects.extend(pairs.pairs.iter().map(Defect::intersecting));
        Ok(Info {
            format: format_name(file.format),
            unit: file.unit.map(LengthUnit::symbol),
            bytes,
            min,
            max,
            volume: closed.then(|| file.mesh.volume()),
            volume_by_rule: by_rule.map(Into::into),
            rule: fill_name(fill),
            closed,
            skipped: file.skipped,
            told_deviation: file.deviation,
            deviation: file.mesh.deviation(),
            warnings: in_words(&file.warnings),
            intersecting_pairs: pairs.count,
            all_intersecting_pairs: pairs.is_complete,
            mesh,
        })
    }

    /// Returns the report for people.
    pub fn text(&self, report: &MeshReport) -> String {
        let mut text = String::new();
        let mut line = |name: &str, value: String| put_line(&mut text, name, &value);
        line("format", self.format.to_uppercase());
        line("unit", self.unit.unwrap_or("unknown").into());
        if self.deviation > 0.0 {
            line(
                "deviation",
                format!("the true boundary lies within {} of the mesh", number(self.deviation)),
            );
        } else if let Some(told) = self.told_deviation {
            let told = number(told);
            line("deviation", format!("{told}, as the file says; --deviation {told} believes it"));
        }
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            line(name, format!("{} to {}", number(self.min[axis]), number(self.max[axis])));
        }
        let state = match openness(report) {
            _ if report.triangles == 0 => "no: there is no triangle".to_owned(),
            None => "yes".to_owned(),
            Some(how) => format!("no: {how}"),
        };
        line("closed", state);
        match (self.volume, &self.volume_by_rule) {
            (None, _) => line("volume", "-".into()),
            (Some(volume), None) => line("volume", number(volume)),
            (Some(volume), Some(by_rule)) => {
                line("volume", format!("{}, the sum of signed volumes", number(volume)));
                line("", format!("{}, by the rule ({})", by_rule.interval(), self.rule));
            }
        }
        for (name, value) in [
            ("triangles", report.triangles),
            ("vertices", report.vertices),
            ("bodies", report.bodies),
            ("open", report.open_bodies),
            ("inside out", report.inside_out_bodies),
            ("overlapping", report.overlapping_bodies),
            ("may overlap", report.undecided_bodies),
            ("boundary edges", report.boundary_edges),
            ("boundary loops", report.boundary_loops),
            ("misoriented", report.misoriented_edges),
            ("non-manifold", report.non_manifold_edges),
            ("duplicate", report.duplicate),
            ("opposite", report.opposite),
            ("flat", report.flat),
            ("degenerate", report.degenerate),
            ("welded", report.welded),
        ] {
            line(name, count(value));
        }
        match self.all_intersecting_pairs {
            true => line("intersecting", counted(self.intersecting_pairs, "pair", "pairs")),
            false => line("intersecting", format!("{} pairs or more", count(self.intersecting_pairs))),
        }
        if report.polygons > 0 {
            line("polygons", count(report.polygons));
        }
        if report.bent_polygons > 0 {
            let most = number(report.polygon_deviation);
            let bent = count(report.bent_polygons);
            line("not flat", format!("{bent} of them, with corners up to {most} beside the mean plane;"));
            line("", "what is measured is measured of one of their triangulations".into());
        }
        if report.sewn > 0 {
            line("sewn", format!("{}, moved by {} or less", count(report.sewn), number(report.displacement)));
        }
        if self.skipped > 0 {
            line("left out", counted(self.skipped, "object that is no solid", "objects that are no solids"));
        }
        line("bytes", count(self.bytes));
        if !self.mesh.defects.is_empty() {
            text.push('\n');
            text.push_str(&Defect::table(&self.mesh.defects));
        }
        text
    }
}
