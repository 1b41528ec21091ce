//! The parts of a layout: a container, obstacles, and items in any number.

use crate::failure::{Failure, Of};
use crate::options::numbers;
use crate::source::density::{Density, MassUnit};
use crate::source::file::Taking;
use crate::source::input::Input;
use crate::source::solid::Source;
use crate::words::counted;
use leafless::exchange::LengthUnit;
use leafless::layout::{Bay, Item, Orientations};
use leafless::{Affine, AnySolid, Csg};
use std::ffi::{OsStr, OsString};
use std::fmt;
use std::path::Path;

/// Most copies of all items.
pub const MOST_COPIES: u32 = 10_000;

/// A container.
pub enum Holder {
    /// A box with its lower corner at the origin.
    Box([f64; 3]),
    /// A file of any kind.
    File(Input),
}

impl fmt::Display for Holder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Holder::Box([x, y, z]) => write!(f, "box:{x},{y},{z}"),
            Holder::File(input) => input.fmt(f),
        }
    }
}

impl Holder {
    /// Parses a name.
    pub fn of(name: &OsStr) -> Result<Holder, Failure> {
        let Some(sides) = name.to_str().and_then(|name| name.strip_prefix("box:")) else {
            return Ok(Holder::File(named(name)?));
        };
        let expected = || {
            let problem = "a box has three sides above 0, as box:x,y,z";
            Failure::Usage(format!("{}: {problem}", Path::new(name).display()))
        };
        let sides = numbers(sides).ok_or_else(&expected)?;
        Holder::of_sides(sides).ok_or_else(expected)
    }

    /// Returns a box with these sides, if they are valid.
    pub fn of_sides(sides: [f64; 3]) -> Option<Holder> {
        let is_side = |side: f64| side > 0.0 && side.is_finite();
        sides.into_iter().all(is_side).then_some(Holder::Box(sides))
    }

    /// Returns the file, unless the container is a box.
    pub fn file(&self) -> Option<&Input> {
        match self {
            Holder::Box(_) => None,
            Holder::File(input) => Some(input),
        }
    }
}

/// A file, and the number of its copies.
pub struct Copies {
    pub input: Input,
    pub count: u32,
    pub density: Density,
}

impl Copies {
    /// Parses a name: `part.stl*30` are thirty copies, unless a file has that name. The density is 1.
    pub fn of(name: &OsStr) -> Result<Copies, Failure> {
        let density = Density::of_number(1.0);
        let counted = || {
            let (file, digits) = name.to_str()?.rsplit_once('*')?;
            (!digits.is_empty() && digits.bytes().all(|digit| digit.is_ascii_digit()))
                .then_some((file, digits))
        };
        if let Some((file, digits)) = counted().filter(|_| !Path::new(name).exists()) {
            let count =
                digits.parse().ok().filter(|count| (1..=MOST_COPIES).contains(count)).ok_or_else(|| {
                    let most = crate::words::count(MOST_COPIES.into());
                    let problem = format!("the number of copies must be one from 1 to {most}");
                    Failure::Usage(format!("{}: {problem}", Path::new(name).display()))
                })?;
            return Ok(Copies { input: named(OsStr::new(file))?, count, density });
        }
        Ok(Copies { input: named(name)?, count: 1, density })
    }
}

/// Returns a file that a layout may name.
pub fn named(name: &OsStr) -> Result<Input, Failure> {
    match Input::from(name) {
        Input::Standard => {
            Err(Failure::Usage("standard input cannot be laid out, because a layout names files".into()))
        }
        input => Ok(input),
    }
}

/// The kind of the file that a solid comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    Octree,
    Mesh,
    Scene,
    Volume,
}

/// All parts of a layout, by name.
pub struct Stock {
    pub holder: Holder,
    pub obstacles: Vec<Input>,
    pub items: Vec<Copies>,
}

/// All parts of a layout, as solids.
pub struct Solids {
    pub bay: Bay,
    /// Kind of the container's file, unless the container is a box.
    pub holder: Option<Kind>,
    pub obstacles: Vec<Kind>,
    pub items: Vec<Kind>,
    /// The common unit of all files whose unit is known.
    pub unit: Option<LengthUnit>,
    /// The mass of a cubic model unit of each item, …
    pub densities: Vec<f64>,
    /// … and its unit, which is empty if densities are plain numbers.
    pub mass_unit: MassUnit,
}

/// The required distances.
#[derive(Clone, Copy)]
pub struct Clearances {
    pub between: f64,
    pub wall: f64,
}

impl Stock {
    /// Returns all files, each once.
    pub fn files(&self) -> impl Iterator<Item = &Input> {
        let items = self.items.iter().map(|copies| &copies.input);
        self.holder.file().into_iter().chain(&self.obstacles).chain(items)
    }

    /// Gives all items one density, or each item its own.
    pub fn weigh(&mut self, densities: &[Density]) -> Result<(), Failure> {
        match densities {
            [] => {}
            [density] => self.items.iter_mut().for_each(|copies| copies.density = *density),
            all if all.len() == self.items.len() => {
                self.items.iter_mut().zip(all).for_each(|(copies, density)| copies.density = *density);
            }
            all => {
                let (densities, items) = (all.len(), counted(self.items.len() as u64, "item", "items"));
                let problem = format!("expected one number, or one for each of {items}, not {densities}");
                return Err(Failure::Usage(format!("--density: {problem}")));
            }
        }
        Ok(())
    }

    /// Reads all files. `unit` is the unit of the model, if the user states it.
    pub fn read(
        &self,
        orientations: &Orientations,
        clearances: Clearances,
        unit: Option<LengthUnit>,
    ) -> Result<Solids, Failure> {
        let total: u64 = self.items.iter().map(|copies| u64::from(copies.count)).sum();
        if total > MOST_COPIES.into() {
            let [total, most] = [total, MOST_COPIES.into()].map(crate::words::count);
            return Err(Failure::Failed(format!(
                "a layout has {most} copies at the most, and these are {total}"
            )));
        }
        let mut unit = unit.map(|unit| (unit, OsString::from("--unit")));
        let (container, holder) = match &self.holder {
            Holder::Box(sides) => (AnySolid::new(Csg::cuboid([0.0; 3], *sides).of(&self.holder)?), None),
            Holder::File(input) => {
                let (solid, kind) = solid(input, &mut unit)?;
                (solid, Some(kind))
            }
        };
        let bay = Bay::new(container).of(&self.holder)?;
        let mut bay = bay.with_clearances(clearances.between, clearances.wall).of(&self.holder)?;
        let mut obstacles = vec![];
        for input in &self.obstacles {
            let (solid, kind) = solid(input, &mut unit)?;
            bay.add_obstacle(solid).of(input)?;
            obstacles.push(kind);
        }
        let mut items = vec![];
        for Copies { input, count, .. } in &self.items {
            let (solid, kind) = solid(input, &mut unit)?;
            let item = Item::new(solid).and_then(|item| item.with_orientations(orientations.clone()));
            items.push((item.of(input)?.with_count(*count), kind));
        }
        // (The unit is known only now.)
        let unit = unit.map(|(unit, _)| unit);
        let mut solids = Solids {
            bay,
            holder,
            obstacles,
            items: vec![],
            unit,
            densities: vec![],
            mass_unit: MassUnit::Unknown,
        };
        for (number, ((item, kind), Copies { input, density, .. })) in
            items.into_iter().zip(&self.items).enumerate()
        {
            let refused = |problem| Failure::Usage(format!("--density: {problem}"));
            let (density, mass_unit) = density.of_cube(unit).map_err(refused)?;
            if number > 0 && mass_unit != solids.mass_unit {
                return Err(refused("expected a unit for all numbers, or for none".into()));
            }
            item.with_density(density).and_then(|item| solids.bay.add_item(item)).of(input)?;
            solids.items.push(kind);
            solids.densities.push(density);
            solids.mass_unit = mass_unit;
        }
        Ok(solids)
    }
}

/// Reads the solid in a file, and returns it with the kind of the file. Files with known units must have the
/// same unit.
fn solid(input: &Input, unit: &mut Option<(LengthUnit, OsString)>) -> Result<(AnySolid, Kind), Failure> {
    let source = Source::read(input, &Taking::default())?;
    let kind = match &source {
        Source::Octree(_) => Kind::Octree,
        Source::Mesh(..) => Kind::Mesh,
        Source::Scene(_) => Kind::Scene,
        Source::Volume(_) => Kind::Volume,
    };
    match (source.unit(), &unit) {
        (Some(own), Some((other, name))) if own != *other => {
            let (own, other, name) = (own.symbol(), other.symbol(), Path::new(name).display());
            let problem = format!("its unit is {own}, and that of {name} is {other}");
            let hint = "`leafless convert --to-unit` makes them one";
            return Err(Failure::of(input, format_args!("{problem}: {hint}")));
        }
        (Some(own), None) => {
            *unit = Some((own, input.path().unwrap_or(Path::new("-")).as_os_str().to_owned()));
        }
        _ => {}
    }
    let frame = source.frame(input, None)?;
    Ok((source.placed(input, &Affine::IDENTITY, &frame)?, kind))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_with_counts() {
        let of = |name: &str| {
            Copies::of(OsStr::new(name)).ok().map(|copies| (copies.input.to_string(), copies.count))
        };
        for (name, file, count) in [
            ("a.stl", "a.stl", 1),
            ("a.stl*30", "a.stl", 30),
            ("a*2*3", "a*2", 3),
            ("a.stl*", "a.stl*", 1),
            ("a.stl*x", "a.stl*x", 1),
            ("a.stl*+3", "a.stl*+3", 1),
            ("a.stl*10000", "a.stl", 10_000),
        ] {
            assert_eq!(of(name), Some((file.into(), count)), "{name}");
        }
        for name in ["a.stl*0", "a.stl*10001", "a.stl*99999999999999999999", "-", "-*3"] {
            assert_eq!(of(name), None, "{name}");
        }
    }

    #[test]
    fn boxes_have_sides() {
        assert!(matches!(Holder::of(OsStr::new("box:1,2.5, 3e1")), Ok(Holder::Box([1.0, 2.5, 30.0]))));
        assert!(matches!(Holder::of(OsStr::new("./box:1,2,3")), Ok(Holder::File(_))));
        for name in
            ["box:", "box:1,2", "box:1,2,0", "box:1,2,-3", "box:1,2,nan", "box:1,2,inf", "box:a,b,c", "-"]
        {
            assert!(Holder::of(OsStr::new(name)).is_err(), "{name}");
        }
    }
}
