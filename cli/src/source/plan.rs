//! Layout files: the items and their placements, as JSON.

use crate::failure::{Failure, Of};
use crate::source::density::{Density, MassUnit};
use crate::source::input::Input;
use crate::source::stock::{Clearances, Copies, Holder, MOST_COPIES, Stock, named};
use crate::words::count;
use leafless::layout::{Beside, Layout};
use leafless::{Affine, Interval};
use serde::{Deserialize, Serialize};
use std::ffi::OsStr;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// The value of the key `format`.
const FORMAT: &str = "leafless layout";
const VERSION: u64 = 1;

/// A layout as it is written.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    format: String,
    version: u64,
    pub container: Container,
    pub obstacles: Vec<String>,
    pub items: Vec<Listed>,
    pub clearance: f64,
    pub wall_clearance: f64,
    pub placed: Vec<Standing>,
    pub measures: Measures,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Container {
    Box([f64; 3]),
    File(String),
}

/// A file, and the number of its copies.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Listed {
    pub file: String,
    pub count: u32,
    /// Mass per cubic model unit.
    pub density: f64,
}

/// A copy in its place.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Standing {
    /// Index in the list of items.
    pub item: usize,
    pub name: String,
    /// The rows of [M | t].
    pub matrix: [[f64; 4]; 3],
    /// The nearest body other than the wall.
    pub nearest: Option<Near>,
}

#[derive(Serialize, Deserialize, Clone, Copy)]
#[serde(deny_unknown_fields)]
pub struct Near {
    pub other: Other,
    pub gap: Ends,
}

/// The other body of a pair, by its number.
#[derive(Serialize, Deserialize, Clone, Copy, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum Other {
    Wall,
    Obstacle(usize),
    Placed(usize),
}

impl From<Beside> for Other {
    fn from(beside: Beside) -> Other {
        match beside {
            Beside::Wall => Other::Wall,
            Beside::Obstacle(number) => Other::Obstacle(number),
            Beside::Placed(number) => Other::Placed(number),
        }
    }
}

/// An interval that contains the true number; null for an infinite end.
#[derive(Serialize, Deserialize, Clone, Copy)]
#[serde(deny_unknown_fields)]
pub struct Ends {
    lower: Option<f64>,
    upper: Option<f64>,
}

impl From<Interval> for Ends {
    fn from(interval: Interval) -> Ends {
        let finite = |x: f64| x.is_finite().then_some(x);
        Ends { lower: finite(interval.lower), upper: finite(interval.upper) }
    }
}

impl Ends {
    pub fn interval(self) -> Interval {
        let (lower, upper) = (self.lower.unwrap_or(f64::NEG_INFINITY), self.upper.unwrap_or(f64::INFINITY));
        Interval::new(lower, upper).unwrap_or(Interval::ALL)
    }
}

/// Measures of all placed copies together.
#[derive(Serialize, Deserialize, Clone, Copy)]
#[serde(deny_unknown_fields)]
pub struct Measures {
    pub volume: Ends,
    /// The placed part of the container's volume.
    pub filled_part: Ends,
    pub height: Ends,
    pub mass: Ends,
    /// `g`, or empty if densities have no unit.
    pub mass_unit: MassUnit,
    pub centroid: Option<[Ends; 3]>,
    pub smallest_gap: Option<Ends>,
}

impl Plan {
    /// Builds the layout for a file in a folder; `densities` are those of the items.
    pub fn new(
        stock: &Stock,
        densities: &[f64],
        clearances: Clearances,
        placed: Vec<Standing>,
        measures: Measures,
        folder: &Path,
    ) -> Result<Plan, Failure> {
        let name = |input: &Input| relative(input, folder);
        Ok(Plan {
            format: FORMAT.into(),
            version: VERSION,
            container: match &stock.holder {
                Holder::Box(sides) => Container::Box(*sides),
                Holder::File(input) => Container::File(name(input)?),
            },
            obstacles: stock.obstacles.iter().map(name).collect::<Result<_, _>>()?,
            items: (stock.items.iter().zip(densities))
                .map(|(Copies { input, count, .. }, &density)| {
                    Ok(Listed { file: name(input)?, count: *count, density })
                })
                .collect::<Result<_, Failure>>()?,
            clearance: clearances.between,
            wall_clearance: clearances.wall,
            placed,
            measures,
        })
    }

    /// Returns the text of the file: one line for each copy.
    pub fn text(&self) -> Result<String, Failure> {
        fn json(value: &impl Serialize) -> Result<String, Failure> {
            serde_json::to_string(value).map_err(|error| Failure::of("JSON", error))
        }
        fn list<T: Serialize>(values: &[T]) -> Result<String, Failure> {
            let lines = values.iter().map(json).collect::<Result<Vec<_>, _>>()?;
            Ok(if lines.is_empty() { "[]".into() } else { format!("[\n    {}\n  ]", lines.join(",\n    ")) })
        }
        let fields = [
            ("format", json(&self.format)?),
            ("version", json(&self.version)?),
            ("container", json(&self.container)?),
            ("obstacles", list(&self.obstacles)?),
            ("items", list(&self.items)?),
            ("clearance", json(&self.clearance)?),
            ("wall_clearance", json(&self.wall_clearance)?),
            ("placed", list(&self.placed)?),
            ("measures", json(&self.measures)?),
        ];
        let mut text = String::from("{");
        for (k, (name, value)) in fields.iter().enumerate() {
            // (Writing to memory does not fail.)
            let _ = write!(text, "{}\n  \"{name}\": {value}", if k == 0 { "" } else { "," });
        }
        text += "\n}\n";
        Ok(text)
    }

    /// Reads a layout from a file of unknown origin.
    pub fn read(input: &Input) -> Result<Plan, Failure> {
        #[derive(Deserialize)]
        struct Head {
            format: String,
            version: u64,
        }
        let bytes = input.read()?;
        let bad = |error: serde_json::Error| Failure::of(input, format_args!("is no layout: {error}"));
        let Head { format, version } = serde_json::from_slice(&bytes).map_err(bad)?;
        if format != FORMAT {
            return Err(Failure::of(input, format_args!("is no layout: its format is not \"{FORMAT}\"")));
        }
        if version != VERSION {
            let problem = format!("has version {version} of the format, and version {VERSION} is read");
            return Err(Failure::of(input, problem));
        }
        let plan: Plan = serde_json::from_slice(&bytes).map_err(bad)?;
        plan.check().map_err(|problem| Failure::of(input, problem))?;
        Ok(plan)
    }

    /// Describes what is wrong with its numbers.
    fn check(&self) -> Result<(), String> {
        let most = u64::from(MOST_COPIES);
        if let Some(at) = self.items.iter().position(|item| !(1..=MOST_COPIES).contains(&item.count)) {
            return Err(format!("item {at}: the number of copies must be one from 1 to {}", count(most)));
        }
        if self.items.iter().map(|item| u64::from(item.count)).sum::<u64>() > most {
            return Err(format!("the items have more than {} copies", count(most)));
        }
        if let Some(at) = self.items.iter().position(|item| !(item.density > 0.0 && item.density.is_finite()))
        {
            return Err(format!("item {at}: the density must be a number above 0"));
        }
        for (what, clearance) in [("clearance", self.clearance), ("wall_clearance", self.wall_clearance)] {
            if !(clearance >= 0.0 && clearance.is_finite()) {
                return Err(format!("{what} must be a number not below 0"));
            }
        }
        let mut left: Vec<u32> = self.items.iter().map(|item| item.count).collect();
        for (at, Standing { item, name, .. }) in self.placed.iter().enumerate() {
            let Some(left) = left.get_mut(*item) else {
                return Err(format!("placed {at}: there is no item {item}"));
            };
            if *name != name_of(&self.items[*item].file) {
                return Err(format!("placed {at}: its name is not that of the file of item {item}"));
            }
            *left = left.checked_sub(1).ok_or_else(|| {
                let copies = count(self.items[*item].count.into());
                format!("placed {at}: of item {item} there are more copies than {copies}")
            })?;
        }
        Ok(())
    }

    /// Returns the files that the layout names, for a layout in a folder.
    pub fn stock(&self, folder: &Path, input: &Input) -> Result<Stock, Failure> {
        let file = |name: &String| {
            let path = folder.join(name);
            // A device may be endless. (A missing file is reported when it is read.)
            if std::fs::metadata(&path).is_ok_and(|metadata| !metadata.is_file()) {
                return Err(Failure::of(path.display(), "is no regular file"));
            }
            named(path.as_os_str())
        };
        let holder = match &self.container {
            Container::Box(sides) => Holder::of_sides(*sides).ok_or_else(|| {
                Failure::of(input, "the container is a box, whose three sides must be above 0")
            })?,
            Container::File(name) => Holder::File(file(name)?),
        };
        let obstacles = self.obstacles.iter().map(file).collect::<Result<_, _>>()?;
        let copies = |&Listed { file: ref name, count, density }: &Listed| {
            Ok(Copies { input: file(name)?, count, density: Density::of_number(density) })
        };
        let items = self.items.iter().map(copies).collect::<Result<_, Failure>>()?;
        Ok(Stock { holder, obstacles, items })
    }

    pub fn clearances(&self) -> Clearances {
        Clearances { between: self.clearance, wall: self.wall_clearance }
    }

    /// Places the copies.
    pub fn place(&self, layout: &mut Layout, input: &Input) -> Result<(), Failure> {
        for (at, standing) in self.placed.iter().enumerate() {
            let map = Affine::new(standing.matrix);
            map.and_then(|map| layout.place(standing.item, &map)).of(format_args!("{input}: placed {at}"))?;
        }
        Ok(())
    }
}

/// Returns the last part of a path, for people.
pub fn name_of(file: &str) -> String {
    Path::new(file).file_name().map_or_else(|| file.to_owned(), |name| name.to_string_lossy().into_owned())
}

/// Returns the folder of a file that is read or written.
pub fn folder_of(path: Option<&Path>) -> &Path {
    path.and_then(Path::parent).unwrap_or(Path::new(""))
}

/// Returns the path of a file relative to a folder, with slashes, if there is one.
pub fn relative(input: &Input, folder: &Path) -> Result<String, Failure> {
    let path = input.path().unwrap_or(Path::new("-"));
    let whole = |path: &Path| -> std::io::Result<PathBuf> {
        std::path::absolute(if path.as_os_str().is_empty() { Path::new(".") } else { path })?.canonicalize()
    };
    // (The file itself may be a link, whose name stays.)
    let own = whole(folder_of(Some(path))).of(input)?;
    let folder = whole(folder).of(folder.display())?;
    let (from, to): (Vec<_>, Vec<_>) = (folder.components().collect(), own.components().collect());
    let same = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let text = |part: &OsStr| {
        part.to_str().map(str::to_owned).ok_or_else(|| Failure::of(input, "has a name that is not UTF-8"))
    };
    let name = text(path.file_name().ok_or_else(|| Failure::of(input, "is no file"))?)?;
    // There is no relative path to another drive.
    if same == 0 {
        return text(own.join(&name).as_os_str());
    }
    let mut parts = vec!["..".to_owned(); from.len() - same];
    for part in &to[same..] {
        parts.push(text(part.as_os_str())?);
    }
    parts.push(name);
    Ok(parts.join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_lead_from_one_folder_to_another() {
        let root = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(root.path().join("a/b")).unwrap();
        std::fs::create_dir_all(root.path().join("c")).unwrap();
        let seen = |file: &str, folder: &str| {
            let input = Input::Path(root.path().join(file));
            relative(&input, &root.path().join(folder)).ok()
        };
        for (file, folder, expected) in [
            ("x.stl", "", "x.stl"),
            ("a/x.stl", "", "a/x.stl"),
            ("a/x.stl", "a", "x.stl"),
            ("x.stl", "a/b", "../../x.stl"),
            ("a/b/x y.stl", "c", "../a/b/x y.stl"),
            ("a/../c/x.stl", "c", "x.stl"),
        ] {
            assert_eq!(seen(file, folder).as_deref(), Some(expected), "{file} {folder}");
        }
        assert_eq!(seen("none/x.stl", "c"), None);
    }
}
