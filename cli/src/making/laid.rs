//! Layout files: 3MF packages and scenes.

use crate::failure::Failure;
use crate::making::surface::usual_surface;
use crate::source::input::Input;
use crate::source::plan::{folder_of, name_of, relative};
use crate::source::stock::{Copies, Holder, Kind, Solids, Stock};
use crate::words::{count, push_number};
use leafless::exchange::{LengthUnit, MeshFormat, WriteOptions, write_placed_meshes};
use leafless::layout::Placed;
use leafless::{Affine, TriangleMesh};
use std::path::Path;

/// Makes the surfaces of the parts in files.
pub fn surfaces<'i>(
    inputs: impl Iterator<Item = &'i Input>,
    threads: usize,
) -> Result<Vec<TriangleMesh>, Failure> {
    inputs.map(|input| usual_surface(input, threads)).collect()
}

/// Returns a 3MF: one object for each item, and one item of the build for each copy.
pub fn package(
    stock: &Stock,
    surfaces: &[TriangleMesh],
    placed: &[Placed],
    unit: Option<LengthUnit>,
) -> Result<Vec<u8>, leafless::Error> {
    let names: Vec<String> = stock.items.iter().map(|copies| name_of(&copies.input.to_string())).collect();
    let objects: Vec<(&str, &TriangleMesh)> = names.iter().map(String::as_str).zip(surfaces).collect();
    let items: Vec<(usize, Affine)> = placed.iter().map(|placed| (placed.item, placed.placement)).collect();
    let deviation = surfaces.iter().map(TriangleMesh::deviation).fold(0.0, f64::max);
    let deviation = Some(deviation).filter(|&deviation| deviation > 0.0);
    write_placed_meshes(&objects, &items, &WriteOptions { unit, deviation, ..WriteOptions::default() })
}

/// Longest text of a scene.
const LONGEST: usize = 1 << 28;

/// The texts that stand for each file in a scene.
pub struct Scenery {
    /// The container, which only programs show that display marked parts.
    holder: String,
    obstacles: Vec<String>,
    items: Vec<String>,
}

impl Scenery {
    /// Prepares a scene in a folder.
    pub fn new(stock: &Stock, solids: &Solids, folder: &Path) -> Result<Scenery, Failure> {
        let call = |input: &Input, kind: Kind| call(input, kind, folder);
        let holder = match (&stock.holder, solids.holder) {
            (Holder::Box(sides), _) => format!("cube({});", list(sides)),
            // (The container is not part of the result.)
            (Holder::File(_), None | Some(Kind::Volume)) => "group();".into(),
            (Holder::File(input), Some(kind)) => call(input, kind)?,
        };
        let obstacles = stock.obstacles.iter().zip(&solids.obstacles).map(|(input, kind)| call(input, *kind));
        let items = stock.items.iter().zip(&solids.items);
        Ok(Scenery {
            holder,
            obstacles: obstacles.collect::<Result<_, _>>()?,
            items: items.map(|(Copies { input, .. }, kind)| call(input, *kind)).collect::<Result<_, _>>()?,
        })
    }

    /// Returns the text of the scene.
    pub fn text(&self, placed: &[Placed]) -> Result<String, String> {
        let length = |placed: &Placed| self.items[placed.item].len();
        if placed.iter().map(length).sum::<usize>() > LONGEST {
            return Err(format!(
                "would have more than {} bytes, because each copy of a scene is written anew: make meshes of scenes first, by \
                 `leafless mesh`",
                count(LONGEST as u64)
            ));
        }
        let mut text = format!("%group() {{\n{}\n}}\n", self.holder);
        for obstacle in &self.obstacles {
            text += &format!("group() {{\n{obstacle}\n}}\n");
        }
        for placed in placed {
            let [x, y, z] = placed.placement.rows().map(|row| list(&row));
            let item = &self.items[placed.item];
            text += &format!("multmatrix([{x}, {y}, {z}, [0, 0, 0, 1]]) {{\n{item}\n}}\n");
        }
        Ok(text)
    }
}

/// Formats numbers in brackets.
fn list(numbers: &[f64]) -> String {
    let mut text = String::from("[");
    for (k, number) in numbers.iter().enumerate() {
        text += if k == 0 { "" } else { ", " };
        push_number(&mut text, *number);
    }
    text + "]"
}

/// Returns the call of a file in a scene.
fn call(input: &Input, kind: Kind, folder: &Path) -> Result<String, Failure> {
    let name = || Ok::<_, Failure>(quoted(&relative(input, folder)?));
    match kind {
        Kind::Octree => Ok(format!("octree({});", name()?)),
        Kind::Mesh => {
            let extension = input.path().and_then(|path| path.extension()?.to_str()).unwrap_or_default();
            let is_known = MeshFormat::from_extension(extension).is_some();
            Ok(format!("{}({});", if is_known { "import" } else { "mesh" }, name()?))
        }
        Kind::Scene => {
            let own = folder_of(input.path());
            let text = String::from_utf8(input.read()?).map_err(|_| Failure::of(input, "is no text"))?;
            let moved = |name: &str| {
                let path = own.join(name);
                if Path::new(name).is_absolute() {
                    Ok(name.into())
                } else {
                    relative(&Input::Path(path), folder)
                }
            };
            with_files(text.trim_start_matches('\u{FEFF}').trim_end(), moved)
        }
        Kind::Volume => {
            let problem =
                "is a volume, which a scene cannot contain: make a mesh of it first, by `leafless mesh`";
            Err(Failure::of(input, problem))
        }
    }
}

/// Returns a text in quotation marks.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            '\n' => quoted += "\\n",
            '\r' => quoted += "\\r",
            '\t' => quoted += "\\t",
            c => quoted.push(c),
        }
    }
    quoted + "\""
}

/// Returns the content of a text in quotation marks.
fn unquoted(text: &str) -> String {
    let (mut plain, mut rest) = (String::new(), text.chars());
    while let Some(c) = rest.next() {
        plain.push(match c {
            '\\' => match rest.next() {
                Some('n') => '\n',
                Some('r') => '\r',
                Some('t') => '\t',
                other => other.unwrap_or('\\'),
            },
            c => c,
        });
    }
    plain
}

/// Returns the text of a valid scene with other names for its files.
fn with_files(text: &str, mut moved: impl FnMut(&str) -> Result<String, Failure>) -> Result<String, Failure> {
    let mut out = String::with_capacity(text.len());
    // The last word, the calls with open brackets, and the name of the argument in the innermost one.
    let (mut word, mut calls, mut argument) = (String::new(), Vec::new(), String::new());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let (token, after) = if rest.starts_with("//") {
            rest.split_at(rest.find('\n').unwrap_or(rest.len()))
        } else if let Some(comment) = rest.strip_prefix("/*") {
            rest.split_at(comment.find("*/").map_or(rest.len(), |at| at + 4))
        } else if c == '"' {
            let mut is_escaped = false;
            let end = rest[1..].find(|c| {
                let ends = c == '"' && !is_escaped;
                is_escaped = c == '\\' && !is_escaped;
                ends
            });
            rest.split_at(end.map_or(rest.len(), |at| at + 2))
        } else if c.is_ascii_alphanumeric() || c == '_' || c == '$' {
            let is_in_word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '$';
            rest.split_at(rest.find(|c| !is_in_word(c)).unwrap_or(rest.len()))
        } else {
            rest.split_at(c.len_utf8())
        };
        rest = after;
        let names_file =
            calls.last().is_some_and(|call: &String| ["import", "mesh", "octree"].contains(&&**call))
                && ["", "file"].contains(&&*argument);
        match c {
            '"' if names_file && token.len() >= 2 => {
                out += &quoted(&moved(&unquoted(&token[1..token.len() - 1]))?);
                continue;
            }
            '/' | '"' => {}
            '(' => {
                calls.push(std::mem::take(&mut word));
                argument.clear();
            }
            ')' => {
                calls.pop();
            }
            '=' => argument = std::mem::take(&mut word),
            ',' => argument.clear(),
            c if c.is_whitespace() => {}
            _ => word = token.to_owned(),
        }
        out += token;
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_in_a_scene_get_other_names() {
        let moved = |text: &str| with_files(text, |name| Ok(format!("<{name}>"))).unwrap();
        for (text, expected) in [
            ("import(\"a.stl\");", "import(\"<a.stl>\");"),
            (
                "import (file = \"a \\\"b\\\\.stl\", layer = \"x\");",
                "import (file = \"<a \\\"b\\\\.stl>\", layer = \"x\");",
            ),
            ("import(layer = \"x\", file = \"a.stl\");", "import(layer = \"x\", file = \"<a.stl>\");"),
            ("color(\"red\") { octree(\"a.lfl\"); }", "color(\"red\") { octree(\"<a.lfl>\"); }"),
            ("// import(\"a.stl\")\nmesh /* ( */ (\"b\");", "// import(\"a.stl\")\nmesh /* ( */ (\"<b>\");"),
            ("cube([1, 2, 3], center = true); // \"end", "cube([1, 2, 3], center = true); // \"end"),
        ] {
            assert_eq!(moved(text), expected);
        }
    }
}
