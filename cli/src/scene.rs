//! Scenes, as files of the program's users.

use crate::content::Content;
use crate::failure::{Failure, Of};
use crate::input::Input;
use crate::output::{self, count, number};
use leafless::Frame;
use leafless::scene;
use leafless::scene::Scene;
use serde::Serialize;
use std::fmt::Write;
use std::path::Path;

/// Reads a scene, and says what its text was.
pub fn read_scene(input: &Input) -> Result<(Scene, String), Failure> {
    let text = input.read()?;
    match Content::of(input, &text, false)? {
        Content::Solid => Err(Failure::of(input, "is a solid already, not a scene")),
        Content::Mesh => Err(Failure::of(input, "is a mesh, not a scene: use `leafless voxelize`")),
        Content::Scene => scene_of(input, &text),
    }
}

/// The scene with this text, and the text's checksum and length. Files that it names are looked for beside it,
/// or in the current folder if it comes from standard input.
pub fn scene_of(input: &Input, text: &[u8]) -> Result<(Scene, String), Failure> {
    let folder = input.path().and_then(Path::parent).unwrap_or(Path::new(""));
    let scene = scene::read_scene(text, Some(folder)).of(input)?;
    Ok((scene, format!("crc32:{:08x} bytes:{}", crc32fast::hash(text), text.len())))
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
    scene.bounds().of(input)?.ok_or_else(|| {
        Failure::of(input, "is empty, or reaches nobody knows how far: give --bounds X0,Y0,Z0,EDGE")
    })
}

/// What `info` tells of a scene.
#[derive(Serialize)]
struct Info {
    format: &'static str,
    bytes: u64,
    /// Corners of a box around the scene; absent (null) if it is empty or nobody knows how far it reaches.
    min: Option<[f64; 3]>,
    max: Option<[f64; 3]>,
}

/// Prints what is known of the scene with this text.
pub fn tell(input: &Input, bytes: &[u8], json: bool) -> Result<(), Failure> {
    let (scene, _) = scene_of(input, bytes)?;
    let bounds = scene.bounds().of(input)?;
    let info = Info {
        format: "scene",
        bytes: bytes.len() as u64,
        min: bounds.map(|bounds| bounds.0),
        max: bounds.map(|bounds| bounds.1),
    };
    let text = if json { output::json(&info)? } else { info.text() };
    output::print(text.as_bytes())
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
                _ => "unknown".into(),
            };
            line(name, range);
        }
        line("bytes", count(self.bytes));
        text
    }
}
