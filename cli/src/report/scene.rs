//! Reports of scenes.

use crate::failure::{Failure, Of};
use crate::source::input::Input;
use crate::source::mesh::openness;
use crate::words::{count, counted, number, put_line};
use leafless::scene::{Scene, SceneMesh, SceneReport};
use serde::Serialize;

/// The numbers of curved calls of a scene, by how they are drawn.
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
    /// Returns the report for people; `None` without curved calls.
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

/// The report of `info` on a scene.
#[derive(Serialize)]
pub struct Info {
    format: &'static str,
    bytes: u64,
    /// Corners of a box around the scene; null if the scene is empty or its extent is unknown.
    min: Option<[f64; 3]>,
    max: Option<[f64; 3]>,
    empty: bool,
    curves: Curves,
    meshes: Vec<MeshInfo>,
}

/// The report of `info` on a mesh in a scene.
#[derive(Serialize)]
struct MeshInfo {
    line: u64,
    column: u64,
    /// The file as the scene names it; null for a polyhedron.
    file: Option<String>,
    triangles: u64,
    boundary_edges: u64,
    boundary_loops: u64,
    misoriented_edges: u64,
    inside_out_bodies: u64,
    /// Number of triangles that face the opposite side of most triangles of their body.
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

impl Info {
    /// Describes a scene whose text has `bytes` bytes.
    pub fn new(input: &Input, scene: &Scene, bytes: u64) -> Result<Info, Failure> {
        let bounds = scene.bounds().of(input)?;
        Ok(Info {
            format: "scene",
            bytes,
            min: bounds.map(|bounds| bounds.0),
            max: bounds.map(|bounds| bounds.1),
            empty: scene.is_empty().of(input)?,
            curves: scene.report().into(),
            meshes: scene.report().meshes.iter().map(Into::into).collect(),
        })
    }

    /// Returns the report for people.
    pub fn text(&self) -> String {
        let mut text = String::new();
        let mut line = |name: &str, value: String| put_line(&mut text, name, &value);
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
