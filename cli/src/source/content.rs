//! Recognition of the kind of a file from its bytes.

use crate::failure::Failure;
use crate::source::input::Input;
use leafless::exchange::{MeshFormat, VolumeFormat};
use leafless::{file, scene};

/// The kinds of files that contain a shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Content {
    /// A solid (.lfl).
    Solid,
    /// A mesh of any format.
    Mesh,
    /// A scene (.csg).
    Scene,
    /// A volume (NRRD, MetaImage).
    Volume,
}

impl Content {
    /// Recognises the kind of a file: by its content if that is conclusive, then by the extension of its
    /// name. `told` is the kind that the user named. A file that is named as a solid is taken for nothing
    /// else: a damaged solid must not pass for some mesh.
    pub fn of(input: &Input, bytes: &[u8], told: Option<Content>) -> Result<Content, Failure> {
        let extension = input.path().and_then(|path| path.extension()?.to_str()).unwrap_or_default();
        if bytes.starts_with(&file::MAGIC) || extension == "lfl" {
            Ok(Content::Solid)
        } else if let Some(told) = told {
            Ok(told)
        } else if VolumeFormat::detect(bytes).is_some() {
            Ok(Content::Volume)
        } else if let Some(refusal) = stranger(bytes, extension) {
            Err(Failure::of(input, refusal))
        } else if MeshFormat::detect(bytes, None).is_some() {
            Ok(Content::Mesh)
        } else if scene::is_scene(bytes)
            || ["csg", "scad"].iter().any(|scene| extension.eq_ignore_ascii_case(scene))
        {
            Ok(Content::Scene)
        } else if MeshFormat::from_extension(extension).is_some() {
            Ok(Content::Mesh)
        } else if bytes.is_empty() {
            Err(Failure::of(input, "is empty"))
        } else {
            let kinds = "a solid (.lfl), nor a mesh (STL, OBJ, PLY, OFF, 3MF), nor a scene (.csg), \
                         nor a volume (NRRD, MetaImage)";
            Err(Failure::of(input, format_args!("neither the content nor the name is that of {kinds}")))
        }
    }
}

/// Explains why a file is not read, if it is of a kind that people often try.
fn stranger(bytes: &[u8], extension: &str) -> Option<String> {
    let is_one_of = |names: &[&str]| names.iter().any(|name| extension.eq_ignore_ascii_case(name));
    if bytes.starts_with(b"ISO-10303-21;") || is_one_of(&["step", "stp", "igs", "iges"]) {
        return Some(
            "is a CAD model (STEP or IGES), whose curved faces are not read: export a mesh of it as STL, OBJ or 3MF, with as \
             small a deviation as you need; or take it in by Open CASCADE, as examples/cpp/open_cascade.cpp does"
                .into(),
        );
    }
    // Bytes that are not text may be the triangles of an STL, but then the length or the name says so.
    let is_guess = MeshFormat::detect(bytes, Some("obj")) == Some(MeshFormat::Obj)
        && MeshFormat::detect(bytes, None) == Some(MeshFormat::Stl);
    if is_one_of(&["raw"])
        || is_guess && !extension.is_empty() && MeshFormat::from_extension(extension).is_none()
    {
        return Some(format!(
            "is no mesh, and has no known header ({} bytes): if it is a raw volume, give the number of \
             samples along x, y and z, and their type: --extents 512,512,300 --type u16",
            bytes.len()
        ));
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::OsStr;

    #[test]
    fn the_content_decides() {
        let of = |name: &str, bytes: &[u8]| Content::of(&Input::from(OsStr::new(name)), bytes, None).ok();
        for name in ["-", "a.csg", "a.stl", "a.txt", "a"] {
            assert_eq!(of(name, b"// v1\n#group() { cube(1); }"), Some(Content::Scene), "{name}");
            assert_eq!(of(name, b"\xEF\xBB\xBF // by hand\n%union () {}"), Some(Content::Scene), "{name}");
            assert_eq!(of(name, b"solid cube(1)\nfacet normal 0 0 1\n"), Some(Content::Mesh), "{name}");
            assert_eq!(of(name, b"# group()\nv 0 0 0\n"), Some(Content::Mesh), "{name}");
            assert_eq!(of(name, &file::MAGIC), Some(Content::Solid), "{name}");
        }
        for (name, expected) in [
            ("-", None),
            ("a.csg", Some(Content::Scene)),
            ("a.CSG", Some(Content::Scene)),
            ("a.scad", Some(Content::Scene)),
            ("a.lfl", Some(Content::Solid)),
            ("a.stl", Some(Content::Mesh)),
        ] {
            assert_eq!(of(name, b"nobody knows"), expected, "{name}");
            assert_eq!(of(name, b""), expected, "{name}");
        }
    }
}
