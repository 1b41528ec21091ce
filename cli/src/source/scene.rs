//! Scenes, as files of the program's users.

use crate::failure::{Failure, Of, complain};
use crate::memory;
use crate::sink;
use crate::source::content::Content;
use crate::source::input::Input;
use crate::source::mesh::openness;
use crate::words::{count, counted, number};
use clap::{Args, ValueEnum};
use leafless::Frame;
use leafless::scene::{Facets, Scene, SceneMesh, SceneOptions, SceneReport};
use serde::Serialize;
use std::fmt::Write;
use std::path::Path;

/// How a scene is to be taken.
#[derive(Clone, Args)]
pub struct Drawing {
    /// Which circles, cylinders, balls and solids of revolution of a scene are polygons, as OpenSCAD draws them.
    /// Without it: those with a $fn of 12 or less
    #[arg(long = "fn", value_enum, value_name = "CURVES")]
    facets: Option<FacetsName>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum FacetsName {
    /// None: circles are round
    Exact,
    /// All, with as many sides as $fn, $fa and $fs say
    Polygon,
}

impl Drawing {
    /// Refuses the option where something else is read: `what` it is.
    pub fn refuse(&self, input: &Input, what: &str) -> Result<(), Failure> {
        match self.facets {
            Some(_) => Err(Failure::Usage(format!("--fn is for scenes: {input} is {what}"))),
            None => Ok(()),
        }
    }

    fn options(&self) -> SceneOptions {
        let mut options = SceneOptions::with_facets(match self.facets {
            None => Facets::Auto,
            Some(FacetsName::Exact) => Facets::Exact,
            Some(FacetsName::Polygon) => Facets::Polygon,
        });
        options.max_bytes = Some(memory::longest_file());
        options
    }
}

/// Reads a scene, and says what its text was.
pub fn read_scene(input: &Input, drawing: &Drawing) -> Result<(Scene, String), Failure> {
    let text = input.read()?;
    match Content::of(input, &text, None)? {
        Content::Solid => Err(Failure::of(input, "is a solid already, not a scene")),
        Content::Mesh => Err(Failure::of(input, "is a mesh, not a scene: use `leafless voxelize`")),
        Content::Volume => Err(Failure::of(input, "is a volume, not a scene: use `leafless voxelize`")),
        Content::Scene => scene_of(input, &text, drawing),
    }
}

/// The scene with this text, and the text's checksum and length. Files that it names are looked for beside it,
/// or in the current folder if it comes from standard input. Complains of meshes in it that bound no solid.
pub fn scene_of(input: &Input, text: &[u8], drawing: &Drawing) -> Result<(Scene, String), Failure> {
    let folder = input.path().and_then(Path::parent).unwrap_or(Path::new(""));
    let scene = drawing.options().read(text, Some(folder)).of(input)?;
    let doubtful = scene.report().meshes.iter().filter_map(|mesh| Some((mesh, openness(&mesh.report)?)));
    for (at, (mesh, how)) in doubtful.enumerate() {
        let place = format!("{input}: line {}, column {}", mesh.line, mesh.column);
        if at == MOST_COMPLAINTS {
            complain(&format!("{place}: warning: this mesh, and maybe more, bounds no solid, either"));
            break;
        }
        let what =
            if mesh.file.is_empty() { "the polyhedron".into() } else { format!("the mesh {}", mesh.file) };
        let turned = match mesh.turned {
            0 => String::new(),
            turned => format!(", {} turned over", counted(turned, "triangle is", "triangles are")),
        };
        complain(&format!(
            "{place}: warning: {what} does not bound a solid: {how}{turned}; the winding number decides what is inside"
        ));
    }
    Ok((scene, format!("crc32:{:08x} bytes:{}", crc32fast::hash(text), text.len())))
}

/// Meshes in a scene that are complained of, each in a line.
const MOST_COMPLAINTS: usize = 10;

/// How the curved calls of a scene were drawn.
#[derive(Serialize)]
pub struct Curves {
    polygons: u64,
    exact: u64,
    ignored_slices: u64,
}

impl From<&SceneReport> for Curves {
    fn from(report: &SceneReport) -> Curves {
        let SceneReport { polygons, exact, ignored_slices, .. } = *report;
        Curves { polygons, exact, ignored_slices }
    }
}

impl Curves {
    /// The same for people; `None` if there are none.
    pub fn text(&self) -> Option<String> {
        let slices = match self.ignored_slices {
            0 => String::new(),
            calls => format!("; slices have no effect in {}", counted(calls, "call", "calls")),
        };
        (self.polygons + self.exact + self.ignored_slices > 0).then(|| {
            format!("{} drawn as polygons, {} exact{slices}", count(self.polygons), count(self.exact))
        })
    }
}

/// The universe that a scene is cut into cells on: the bounds given, or the cube around the scene.
pub fn frame_of(input: &Input, scene: &Scene, bounds: Option<&Frame>, depth: u8) -> Result<Frame, Failure> {
    if let Some(bounds) = bounds {
        return bounds.with_depth(depth).of(input);
    }
    let (min, max) = bounds_of(input, scene)?;
    Frame::fitted(min, max, depth).of(input)
}

/// Corners of a box around a scene.
pub fn bounds_of(input: &Input, scene: &Scene) -> Result<([f64; 3], [f64; 3]), Failure> {
    if scene.is_empty().of(input)? {
        // Any cube will do for nothing.
        return Ok(([0.0; 3], [1.0; 3]));
    }
    let unknown = "reaches nobody knows how far: give --bounds X0,Y0,Z0,EDGE";
    scene.bounds().of(input)?.ok_or_else(|| Failure::of(input, unknown))
}

/// What `info` tells of a scene.
#[derive(Serialize)]
struct Info {
    format: &'static str,
    bytes: u64,
    /// Corners of a box around the scene; absent (null) if it is empty or nobody knows how far it reaches.
    min: Option<[f64; 3]>,
    max: Option<[f64; 3]>,
    empty: bool,
    curves: Curves,
    meshes: Vec<MeshInfo>,
}

/// What `info` tells of a mesh in a scene.
#[derive(Serialize)]
struct MeshInfo {
    line: u64,
    column: u64,
    /// The file as the scene names it; absent (null) for a polyhedron.
    file: Option<String>,
    triangles: u64,
    boundary_edges: u64,
    boundary_loops: u64,
    misoriented_edges: u64,
    inside_out_bodies: u64,
    /// Triangles that face the other way than most of their body.
    turned: u64,
    closed: bool,
}

impl From<&SceneMesh> for MeshInfo {
    fn from(mesh: &SceneMesh) -> MeshInfo {
        MeshInfo {
            line: mesh.line,
            column: mesh.column,
            file: (!mesh.file.is_empty()).then(|| mesh.file.clone()),
            triangles: mesh.report.triangles,
            boundary_edges: mesh.report.boundary_edges,
            boundary_loops: mesh.report.boundary_loops,
            misoriented_edges: mesh.report.misoriented_edges,
            inside_out_bodies: mesh.report.inside_out_bodies,
            turned: mesh.turned,
            closed: openness(&mesh.report).is_none(),
        }
    }
}

/// Prints what is known of the scene with this text.
pub fn tell(input: &Input, bytes: &[u8], drawing: &Drawing, json: bool) -> Result<(), Failure> {
    let (scene, _) = scene_of(input, bytes, drawing)?;
    let bounds = scene.bounds().of(input)?;
    let info = Info {
        format: "scene",
        bytes: bytes.len() as u64,
        min: bounds.map(|bounds| bounds.0),
        max: bounds.map(|bounds| bounds.1),
        empty: scene.is_empty().of(input)?,
        curves: scene.report().into(),
        meshes: scene.report().meshes.iter().map(Into::into).collect(),
    };
    let text = if json { sink::json(&info)? } else { info.text() };
    sink::print(text.as_bytes())
}

impl Info {
    /// The same for people.
    fn text(&self) -> String {
        let mut text = String::new();
        let mut line = |name: &str, value: String| {
            // Writing to a string does not fail.
            let _ = writeln!(text, "{name:<16}{value}");
        };
        line("format", "scene (OpenSCAD CSG)".into());
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let range = match (self.min, self.max) {
                (Some(min), Some(max)) => format!("{} to {}", number(min[axis]), number(max[axis])),
                _ if self.empty => "nothing".into(),
                _ => "unknown".into(),
            };
            line(name, range);
        }
        if let Some(curves) = self.curves.text() {
            line("curves", curves);
        }
        for mesh in &self.meshes {
            let file = mesh.file.as_deref().unwrap_or("polyhedron").escape_debug().to_string();
            let state = if mesh.closed { "closed" } else { "bounds no solid" };
            let inside_out = if mesh.inside_out_bodies > 0 { ", inside out" } else { "" };
            let triangles = counted(mesh.triangles, "triangle", "triangles");
            line("mesh", format!("{file} in line {}: {triangles}, {state}{inside_out}", mesh.line));
        }
        line("bytes", count(self.bytes));
        text
    }
}
