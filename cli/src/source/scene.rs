//! Scenes (.csg), and the option of reading them.

use crate::failure::{Failure, Of, Problem, complain};
use crate::memory;
use crate::source::input::Input;
use crate::source::mesh::openness;
use crate::words::counted;
use clap::{Args, ValueEnum};
use leafless::Frame;
use leafless::scene::{Facets, Scene, SceneOptions};
use std::path::Path;

/// The option of reading a scene.
#[derive(Clone, Default, Args)]
#[command(next_help_heading = "Scenes (.csg)")]
pub struct Drawing {
    /// Which circles, cylinders, balls and solids of revolution of a scene are polygons, as OpenSCAD draws
    /// them [default: those with a $fn of 12 or less]
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
    /// Refuses the option if something else is read; `what` names it.
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

/// Reads the scene with this text. Its files are looked up beside the scene, or in the current folder if it
/// comes from standard input. Warns of meshes in it that bound no solid.
pub fn scene_of(input: &Input, text: &[u8], drawing: &Drawing) -> Result<Scene, Failure> {
    let folder = input.path().and_then(Path::parent).unwrap_or(Path::new(""));
    let scene = drawing.options().read(text, Some(folder)).map_err(|error| {
        // OpenSCAD's models are programs; their result is a scene.
        let name =
            input.path().filter(|path| path.extension().is_some_and(|end| end.eq_ignore_ascii_case("scad")));
        let hint = name.map_or_else(String::new, |path| {
            let dump = path.with_extension("csg");
            format!(" (make a scene of it by `openscad -o {} {}`)", dump.display(), path.display())
        });
        Failure::of(input, format_args!("{}{hint}", error.text()))
    })?;
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
    Ok(scene)
}

/// Most meshes in a scene to warn of, each in a line.
const MOST_COMPLAINTS: usize = 10;

/// Returns the universe in which a scene is cut into cells: the given bounds, or the cube around the scene.
pub fn frame_of(input: &Input, scene: &Scene, bounds: Option<&Frame>, depth: u8) -> Result<Frame, Failure> {
    if let Some(bounds) = bounds {
        return bounds.with_depth(depth).of(input);
    }
    let (min, max) = bounds_of(input, scene)?;
    Frame::fitted(min, max, depth).of(input)
}

/// Returns the corners of a box around a scene.
pub fn bounds_of(input: &Input, scene: &Scene) -> Result<([f64; 3], [f64; 3]), Failure> {
    if scene.is_empty().of(input)? {
        // Any cube will do for an empty scene.
        return Ok(([0.0; 3], [1.0; 3]));
    }
    let unknown = "has no known extent: give --bounds X0,Y0,Z0,EDGE";
    scene.bounds().of(input)?.ok_or_else(|| Failure::of(input, unknown))
}
