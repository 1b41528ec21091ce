//! Meshes from files of any format: the options of reading them, and what is told of them.

use crate::failure::{Failure, Of, complain};
use crate::report::octree::{Defect, Mesh, Volume};
use crate::sink;
use crate::source::content::Content;
use crate::source::input::Input;
use crate::source::volume::{Sampling, Voxels};
use crate::words::{count, counted, measured, number};
use clap::{Args, ValueEnum};
use leafless::exchange::{LengthUnit, MeshFile, MeshFormat, MeshOptions, MeshWarning};
use leafless::{
    Control, Error, FillRule, Frame, Interval, MAX_DEPTH, MeshError, MeshReport, MeshSolid, TriangleMesh,
    exchange, measure,
};
use serde::Serialize;
use std::fmt::Write;

/// How a mesh file is to be taken.
#[derive(Clone, Args)]
pub struct Reading {
    /// Format of the mesh file. Without it the content tells, and the extension of the name
    #[arg(long, value_enum)]
    format: Option<FormatName>,
    /// Unit of the numbers in the mesh file: um, mm, cm, m, in or ft. Without it that of a 3MF is known, and
    /// those of other formats are not
    #[arg(long, value_name = "UNIT", value_parser = unit)]
    unit: Option<LengthUnit>,
    /// Unit to convert the mesh to
    #[arg(long, value_name = "UNIT", value_parser = unit)]
    to: Option<LengthUnit>,
    /// Factor to scale the mesh by besides. Without it: 1
    #[arg(long, value_name = "FACTOR", value_parser = scale, allow_hyphen_values = true)]
    scale: Option<f64>,
    /// Which points count as inside a mesh. Without it: positive for 3MF, as that format demands, and nonzero for
    /// all others
    #[arg(long, value_enum)]
    fill: Option<FillName>,
    #[command(flatten)]
    pub sampling: Sampling,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum FormatName {
    Stl,
    Obj,
    Ply,
    Off,
    #[value(name = "3mf")]
    ThreeMf,
}

impl From<FormatName> for MeshFormat {
    fn from(name: FormatName) -> MeshFormat {
        match name {
            FormatName::Stl => MeshFormat::Stl,
            FormatName::Obj => MeshFormat::Obj,
            FormatName::Ply => MeshFormat::Ply,
            FormatName::Off => MeshFormat::Off,
            FormatName::ThreeMf => MeshFormat::ThreeMf,
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum FillName {
    /// Those that the surface winds around, in either sense: overlapping bodies are joined
    #[value(alias = "non-zero")]
    Nonzero,
    /// Those that it winds around in the positive sense: bodies that are inside out take away from others
    Positive,
    /// Those that it winds around an odd number of times: overlaps are holes. Needs a closed mesh
    #[value(alias = "even-odd")]
    Evenodd,
}

impl From<FillName> for FillRule {
    fn from(name: FillName) -> FillRule {
        match name {
            FillName::Nonzero => FillRule::NonZero,
            FillName::Positive => FillRule::Positive,
            FillName::Evenodd => FillRule::EvenOdd,
        }
    }
}

/// The name of a fill rule, as the user writes it.
pub fn fill_name(fill: FillRule) -> &'static str {
    match fill {
        FillRule::NonZero => "nonzero",
        FillRule::Positive => "positive",
        FillRule::EvenOdd => "evenodd",
    }
}

fn unit(text: &str) -> Result<LengthUnit, String> {
    text.parse().map_err(|_| "expected um, mm, cm, m, in or ft".into())
}

fn scale(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(factor) if factor > 0.0 && f64::is_finite(factor) => Ok(factor),
        _ => Err("expected a positive number".into()),
    }
}

impl Reading {
    /// What the user calls the file.
    pub fn told(&self) -> Option<Content> {
        match self.format {
            Some(_) => Some(Content::Mesh),
            None => self.sampling.is_raw().then_some(Content::Volume),
        }
    }

    /// Refuses the options for meshes and volumes where something else is read: `what` it is.
    pub fn refuse(&self, input: &Input, what: &str) -> Result<(), Failure> {
        self.sampling.refuse(input, what)?;
        self.refuse_for_meshes(input, what)
    }

    /// The volume in these bytes of a file.
    pub fn volume(&self, input: &Input, bytes: &[u8]) -> Result<Voxels, Failure> {
        self.refuse_for_meshes(input, "a volume")?;
        self.sampling.read(input, bytes)
    }

    fn refuse_for_meshes(&self, input: &Input, what: &str) -> Result<(), Failure> {
        let given = [
            ("--format", self.format.is_some()),
            ("--unit", self.unit.is_some()),
            ("--to", self.to.is_some()),
            ("--scale", self.scale.is_some()),
            ("--fill", self.fill.is_some()),
        ];
        match given.into_iter().find(|option| option.1) {
            Some((option, _)) => Err(Failure::Usage(format!("{option} is for meshes: {input} is {what}"))),
            None => Ok(()),
        }
    }

    /// The rule by which points count as inside a mesh of this format.
    pub fn fill(&self, format: MeshFormat) -> FillRule {
        match (self.fill, format) {
            (Some(fill), _) => fill.into(),
            (None, MeshFormat::ThreeMf) => FillRule::Positive,
            (None, _) => FillRule::NonZero,
        }
    }

    /// The format of a file with these bytes, if it is known to be a mesh.
    fn format_of(&self, input: &Input, bytes: &[u8]) -> Option<MeshFormat> {
        let extension = input.path().and_then(|path| path.extension()?.to_str());
        self.format.map(MeshFormat::from).or_else(|| MeshFormat::detect(bytes, extension))
    }

    /// The mesh in a file with these bytes, hair cracks closed, and a fingerprint of the file.
    pub fn read(&self, input: &Input, bytes: Vec<u8>) -> Result<(MeshFile, String), Failure> {
        match Content::of(input, &bytes, self.told())? {
            Content::Solid => return Err(Failure::of(input, "is a solid already, not a mesh")),
            Content::Scene => return Err(Failure::of(input, "is a scene, not a mesh: use `leafless csg`")),
            Content::Volume => return Err(Failure::of(input, "is a volume, not a mesh")),
            Content::Mesh => {}
        }
        let source = format!("crc32:{:08x} bytes:{}", crc32fast::hash(&bytes), bytes.len());
        Ok((self.mesh(input, bytes)?, source))
    }

    /// The mesh in these bytes of a file, hair cracks closed.
    pub fn mesh(&self, input: &Input, bytes: Vec<u8>) -> Result<MeshFile, Failure> {
        self.sampling.refuse(input, "a mesh")?;
        let (format, unit, target) = (self.format_of(input, &bytes), self.unit, self.to);
        let options = MeshOptions { format, unit, target, scale: self.scale.unwrap_or(1.0) };
        let mut file = exchange::read_mesh(&bytes, &options).of(input)?;
        for warning in &file.warnings {
            complain(&format!("{input}: warning: {warning}"));
        }
        // Sewing needs memory of its own.
        drop(bytes);
        file.mesh = file.mesh.sewn().of(input)?;
        Ok(file)
    }
}

/// Whether nothing of a mesh lies beyond its vertices: what an open mesh encloses may, and so may a surface
/// that was moved to close hair cracks.
pub fn ends_at_vertices(mesh: &TriangleMesh) -> Result<bool, Error> {
    let report = mesh.report()?;
    Ok(report.displacement == 0.0 && openness(&report).is_none())
}

/// The frame around a mesh. Only one that ends at its vertices can do without a margin.
pub fn frame_around(mesh: &TriangleMesh, depth: u8) -> Result<Frame, Error> {
    let (min, max) = mesh.bounds();
    if ends_at_vertices(mesh)? { Frame::fitted(min, max, depth) } else { Frame::around(min, max, depth) }
}

/// The name of a format, as the user writes it.
pub fn format_name(format: MeshFormat) -> &'static str {
    format.extension()
}

/// Where a mesh is open or its facing contradicts itself, in words; `None` for one that bounds a solid.
pub fn openness(report: &MeshReport) -> Option<String> {
    let (open, turned) = (report.boundary_edges, report.misoriented_edges);
    let facing = || format!("its facing changes across {}", counted(turned, "inner edge", "inner edges"));
    let opening = || {
        let loops = counted(report.boundary_loops, "loop", "loops");
        format!("it is open along {} in {loops}", counted(open, "edge", "edges"))
    };
    match (open, turned) {
        (0, 0) => None,
        (0, _) => Some(facing()),
        (_, 0) => Some(opening()),
        _ => Some(format!("{}, and {}", opening(), facing())),
    }
}

/// Refuses a mesh that is open where the fill rule needs a closed one.
pub fn check_closed(input: &Input, mesh: &TriangleMesh, fill: FillRule) -> Result<(), Failure> {
    if fill != FillRule::EvenOdd {
        return Ok(());
    }
    mesh.check_closed(fill).map_err(|error| {
        let hint = match error {
            Error::Mesh(MeshError::Open { .. }) => " (--fill nonzero and positive take open meshes)",
            _ => "",
        };
        Failure::of(input, format_args!("{error}{hint}"))
    })
}

/// What is read though it departs from its format, in words.
pub fn in_words(warnings: &[MeshWarning]) -> Vec<String> {
    warnings.iter().map(ToString::to_string).collect()
}

/// The volume that a mesh encloses by a fill rule, to a ten thousandth, or what is known of it after a moment.
fn volume_by(rule: FillRule, mesh: &TriangleMesh) -> Result<Interval, Error> {
    const TOLERANCE: f64 = 1e-4;
    const SPLITS: u64 = 1 << 18;
    let frame = frame_around(mesh, MAX_DEPTH)?;
    let solid = MeshSolid::new(mesh.clone(), rule)?;
    let control = Control { max_splits: Some(SPLITS), ..Control::default() };
    Ok(measure(&solid, &frame, TOLERANCE, &control)?.volume)
}

/// Pairs of triangles that intersect, of which `info` tells the place.
const PAIRS: usize = 5;

/// What `info` tells of a mesh.
#[derive(Serialize)]
pub struct Info {
    format: &'static str,
    unit: Option<&'static str>,
    bytes: u64,
    min: [f64; 3],
    max: [f64; 3],
    /// The sum of signed volumes, by the divergence theorem; absent (null) for a mesh that bounds no solid.
    volume: Option<f64>,
    /// What is enclosed by the rule; absent (null) unless bodies overlap, or may, and make it another volume.
    volume_by_rule: Option<Volume>,
    /// The rule: `nonzero`, `positive` or `evenodd`.
    rule: &'static str,
    closed: bool,
    /// Objects of a 3MF that are no solids.
    skipped: u64,
    /// Where the file departs from its format, though it could be read.
    warnings: Vec<String>,
    /// Pairs of triangles that intersect.
    intersecting_pairs: u64,
    /// Whether these are all: too many triangles close to each other end the search.
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
            warnings: in_words(&file.warnings),
            intersecting_pairs: pairs.count,
            all_intersecting_pairs: pairs.is_complete,
            mesh,
        })
    }

    /// The same for people.
    pub fn text(&self, mesh: &TriangleMesh, input: &Input) -> Result<String, Failure> {
        let report = mesh.report().of(input)?;
        let mut text = String::new();
        let mut line = |name: &str, value: String| {
            // Writing to a string does not fail.
            let _ = writeln!(text, "{name:<16}{value}");
        };
        line("format", self.format.to_uppercase());
        line("unit", self.unit.unwrap_or("unknown").into());
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            line(name, format!("{} to {}", number(self.min[axis]), number(self.max[axis])));
        }
        let state = match openness(&report) {
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
                line("", format!("{}, by the rule ({})", measured(by_rule.interval()), self.rule));
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
        Ok(text)
    }
}

/// Prints what is known of a mesh.
pub fn tell(input: &Input, file: &MeshFile, fill: FillRule, bytes: u64, json: bool) -> Result<(), Failure> {
    let info = Info::new(input, file, fill, bytes)?;
    let text = if json { sink::json(&info)? } else { info.text(&file.mesh, input)? };
    sink::print(text.as_bytes())
}
