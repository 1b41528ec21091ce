//! Meshes from files of any format, and the options of reading them.

use crate::failure::{Failure, Of, complain};
use crate::options::{formats, tolerance};
use crate::progress::at_work;
use crate::source::content::Content;
use crate::source::input::Input;
use crate::source::placing::Placing;
use crate::source::volume::{Sampling, Voxels};
use crate::words::counted;
use clap::{Args, ValueEnum};
use leafless::error::MeshError;
use leafless::exchange::{LengthUnit, MeshFile, MeshFormat, MeshOptions, MeshWarning};
use leafless::mesh::MeshReport;
use leafless::{Error, FillRule, Frame, TriangleMesh, exchange};

/// The options of reading a mesh file.
#[derive(Clone, Default, Args)]
#[command(next_help_heading = "Meshes (STL, OBJ, PLY, OFF, 3MF)")]
pub struct Reading {
    /// Unit of the numbers in the mesh file: um, mm, cm, m, in or ft [default: that of a 3MF; unknown for
    /// other formats]
    #[arg(long, value_name = "UNIT", value_parser = unit, help_heading = "Units and placement")]
    unit: Option<LengthUnit>,
    /// Unit to convert the mesh to: um, mm, cm, m, in or ft
    #[arg(long = "to-unit", value_name = "UNIT", value_parser = unit, help_heading = "Units and placement")]
    to: Option<LengthUnit>,
    /// Format of the mesh file [default: by the content, and by the extension of the name]
    #[arg(long, value_parser = formats(["stl", "obj", "ply", "off", "3mf"]))]
    format: Option<MeshFormat>,
    /// Which points are inside a mesh [default: positive for 3MF, as that format demands; nonzero for all
    /// others]
    #[arg(long, value_enum)]
    fill: Option<FillName>,
    /// The true boundary lies within this distance of the mesh, such as the deflection of a tessellation.
    /// What is proven is then proven for the true solid, and points nearer to the triangles are undecided. In
    /// units of the mesh after --to-unit, before it is moved or scaled. The mesh must be closed
    #[arg(long, value_name = "D", value_parser = tolerance)]
    deviation: Option<f64>,
    #[command(flatten)]
    sampling: Sampling,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum FillName {
    /// Points with a winding number other than 0: overlapping bodies unite
    #[value(alias = "non-zero")]
    Nonzero,
    /// Points with a positive winding number: inverted bodies are subtracted
    Positive,
    /// Points with an odd winding number: overlaps are holes; needs a closed mesh
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

/// Returns the name of a fill rule, as the user writes it.
pub fn fill_name(fill: FillRule) -> &'static str {
    match fill {
        FillRule::NonZero => "nonzero",
        FillRule::Positive => "positive",
        FillRule::EvenOdd => "evenodd",
    }
}

pub fn unit(text: &str) -> Result<LengthUnit, String> {
    text.parse().map_err(|_| "expected um, mm, cm, m, in or ft".into())
}

impl Reading {
    /// Returns the kind of the file that the user named.
    pub fn told(&self) -> Option<Content> {
        match self.format {
            Some(_) => Some(Content::Mesh),
            None => self.sampling.is_raw().then_some(Content::Volume),
        }
    }

    /// Returns the options that apply to a file of this kind.
    pub fn about(&self, content: Content) -> Reading {
        match content {
            Content::Volume => Reading { sampling: self.sampling.clone(), ..Reading::default() },
            Content::Mesh => Reading { sampling: Sampling::default(), ..self.clone() },
            Content::Solid | Content::Scene => Reading::default(),
        }
    }

    /// Refuses the options for meshes and volumes if something else is read; `what` names it.
    pub fn refuse(&self, input: &Input, what: &str) -> Result<(), Failure> {
        self.sampling.refuse(input, what)?;
        self.refuse_for_meshes(input, what)
    }

    /// Reads the volume in these bytes of a file.
    pub fn volume(&self, input: &Input, bytes: &[u8]) -> Result<Voxels, Failure> {
        self.refuse_for_meshes(input, "a volume")?;
        self.sampling.read(input, bytes)
    }

    fn refuse_for_meshes(&self, input: &Input, what: &str) -> Result<(), Failure> {
        let given = [
            ("--format", self.format.is_some()),
            ("--unit", self.unit.is_some()),
            ("--to-unit", self.to.is_some()),
            ("--fill", self.fill.is_some()),
            ("--deviation", self.deviation.is_some()),
        ];
        match given.into_iter().find(|option| option.1) {
            Some((option, _)) => Err(Failure::Usage(format!("{option} is for meshes: {input} is {what}"))),
            None => Ok(()),
        }
    }

    /// Returns the fill rule for a mesh of this format.
    fn fill(&self, format: MeshFormat) -> FillRule {
        match (self.fill, format) {
            (Some(fill), _) => fill.into(),
            (None, MeshFormat::ThreeMf) => FillRule::Positive,
            (None, _) => FillRule::NonZero,
        }
    }

    /// Returns the format of a file with these bytes, if it is known to be a mesh.
    fn format_of(&self, input: &Input, bytes: &[u8]) -> Option<MeshFormat> {
        let extension = input.path().and_then(|path| path.extension()?.to_str());
        self.format.or_else(|| MeshFormat::detect(bytes, extension))
    }

    /// Reads the mesh in these bytes of a file, closes hair cracks and moves it, and returns it with its fill
    /// rule. An open mesh is refused if the rule needs a closed one.
    pub fn mesh(
        &self,
        input: &Input,
        bytes: Vec<u8>,
        placing: &Placing,
    ) -> Result<(MeshFile, FillRule), Failure> {
        self.sampling.refuse(input, "a mesh")?;
        let (format, unit, target) = (self.format_of(input, &bytes), self.unit, self.to);
        // Unit and factor together are rounded once.
        let factor = placing.factor();
        let options = MeshOptions { format, unit, target, scale: factor.unwrap_or(1.0) };
        let mut file = at_work("read", || exchange::read_mesh(&bytes, &options)).of(input)?;
        for warning in &file.warnings {
            complain(&format!("{input}: warning: {warning}"));
        }
        // Closing cracks needs memory of its own.
        drop(bytes);
        file.mesh = at_work("read", || file.mesh.sewn()).of(input)?;
        if let Some(deviation) = self.deviation {
            // (The deviation is scaled as the mesh was.)
            let scaled = factor.map_or(deviation, |factor| (deviation * factor).next_up());
            file.mesh = file.mesh.with_deviation(if deviation > 0.0 { scaled } else { 0.0 }).of(input)?;
        }
        if factor.is_none() {
            file.mesh = placing.mesh(file.mesh).of(input)?;
        }
        let fill = self.fill(file.format);
        check_closed(input, &file.mesh, fill)?;
        Ok((file, fill))
    }
}

/// True if the solid does not extend beyond the vertices of the mesh. The solid of an open mesh may. So may a
/// surface that was moved to close hair cracks, or one that is known within a deviation only.
pub fn ends_at_vertices(mesh: &TriangleMesh) -> Result<bool, Error> {
    Ok(mesh.displacement() == 0.0 && openness(&mesh.report()?).is_none())
}

/// Returns the corners of a box around a mesh, and around the true solid if that is known within a deviation
/// only.
pub fn reach_of(mesh: &TriangleMesh) -> ([f64; 3], [f64; 3]) {
    let (min, max) = mesh.bounds();
    match mesh.deviation() {
        0.0 => (min, max),
        _ => {
            let beyond = mesh.displacement();
            (min.map(|low| (low - beyond).next_down()), max.map(|high| (high + beyond).next_up()))
        }
    }
}

/// Returns the frame around a mesh. A frame without a margin is enough only if the solid ends at the
/// vertices.
pub fn frame_around(mesh: &TriangleMesh, depth: u8) -> Result<Frame, Error> {
    let (min, max) = reach_of(mesh);
    if ends_at_vertices(mesh)? { Frame::fitted(min, max, depth) } else { Frame::around(min, max, depth) }
}

/// Returns the name of a format, as the user writes it.
pub fn format_name(format: MeshFormat) -> &'static str {
    format.extension()
}

/// Describes where a mesh is open or its orientation is inconsistent; `None` for a mesh that bounds a solid.
pub fn openness(report: &MeshReport) -> Option<String> {
    let (open, turned) = (report.boundary_edges, report.misoriented_edges);
    let facing =
        || format!("its orientation changes across {}", counted(turned, "inner edge", "inner edges"));
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

/// Warns of a mesh that bounds no solid, unless the fill rule has refused it.
pub fn warn_of_openness(input: &Input, report: &MeshReport, fill: FillRule) {
    if fill != FillRule::EvenOdd
        && let Some(how) = openness(report)
    {
        let whole = "the mesh does not bound a solid";
        complain(&format!("{input}: warning: {whole}: {how}; the winding number decides what is inside"));
    }
}

/// Refuses an open mesh if the fill rule, or a stated deviation, needs a closed one.
fn check_closed(input: &Input, mesh: &TriangleMesh, fill: FillRule) -> Result<(), Failure> {
    let is_stated = mesh.deviation() > 0.0;
    if fill != FillRule::EvenOdd && !is_stated {
        return Ok(());
    }
    mesh.check_closed(fill).map_err(|error| {
        let hint = match error {
            _ if is_stated => " (--deviation needs a mesh that bounds a solid)",
            Error::Mesh(MeshError::Open { .. }) => " (--fill nonzero and positive take open meshes)",
            _ => "",
        };
        Failure::of(input, format_args!("{error}{hint}"))
    })
}

/// Describes departures from a format that did not prevent reading.
pub fn in_words(warnings: &[MeshWarning]) -> Vec<String> {
    warnings.iter().map(ToString::to_string).collect()
}
