//! Scenes, as files of the program's users.

use crate::failure::{Failure, Of};
use crate::input::Input;
use leafless::Frame;
use leafless::file::MAGIC;
use leafless::scene;
use leafless::scene::Scene;
use std::path::Path;

/// Reads a scene, and says what its text was: the text's checksum and length. Files that it names are looked
/// for beside it, or in the current folder if it comes from standard input.
pub fn read_scene(input: &Input) -> Result<(Scene, String), Failure> {
    let text = input.read()?;
    if text.starts_with(&MAGIC) {
        return Err(Failure::of(input, "this is a solid already, not a scene"));
    }
    let folder = input.path().and_then(Path::parent).unwrap_or(Path::new(""));
    let scene = scene::read_scene(&text, Some(folder)).of(input)?;
    Ok((scene, format!("crc32:{:08x} bytes:{}", crc32fast::hash(&text), text.len())))
}

/// The universe that a scene is cut into cells on: the bounds given, or the cube around the scene.
pub fn frame_of(input: &Input, scene: &Scene, bounds: Option<&Frame>, depth: u8) -> Result<Frame, Failure> {
    if let Some(bounds) = bounds {
        return bounds.with_depth(depth).of(input);
    }
    let (min, max) = bounds_of(input, scene)?;
    Frame::around(min, max, depth).of(input)
}

/// Corners of a box around a scene.
pub fn bounds_of(input: &Input, scene: &Scene) -> Result<([f64; 3], [f64; 3]), Failure> {
    scene.bounds().of(input)?.ok_or_else(|| {
        Failure::of(input, "is empty, or reaches nobody knows how far: give --bounds X0,Y0,Z0,EDGE")
    })
}
