//! `leafless summary`: statistics of a channel in a solid.

use crate::failure::{Failure, Of};
use crate::options::numbers;
use crate::progress::watched;
use crate::report::bounds::Volume;
use crate::sink;
use crate::source::input::Input;
use crate::source::values::find;
use crate::words::number;
use clap::Args;
use leafless::attribute::{ChannelSummary, MaterialProperties, materials};
use leafless::{Bounds, Interval, Octree};
use serde::Serialize;
use std::ffi::OsString;
use std::fmt::Write;

/// Tells the least, the greatest and the mean value of a channel in a solid, and its integral: for a density,
/// the mass. With --materials it tells the volume, centroid and inertia of the part of the solid that has
/// each value.
///
/// Volumes, integrals and means are intervals that contain the true values, as far as the cells of the solid
/// and of the channel determine them: FULL cells bound them on one side, FULL and PARTIAL cells on the other.
#[derive(Args)]
pub struct Arguments {
    /// Solid with channels (.lfl)
    file: OsString,
    /// Name of the channel [default: the only one]
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    /// Report each value separately
    #[arg(long, conflicts_with = "bounds")]
    materials: bool,
    /// Density of the material with this value, or its lower and upper bound; the masses are added up. May be
    /// given several times
    #[arg(long, value_name = "VALUE=DENSITY|LOW..HIGH", value_parser = density, requires = "materials")]
    density: Vec<(f64, Interval)>,
    /// Only in this box: its lower and its upper corner
    #[arg(long = "box", value_name = "X0,Y0,Z0,X1,Y1,Z1", value_parser = cuboid, allow_hyphen_values = true)]
    bounds: Option<Bounds>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

fn cuboid(text: &str) -> Result<Bounds, String> {
    let bounds = numbers(text).and_then(|[a, b, c, x, y, z]| Bounds::new([a, b, c], [x, y, z]));
    bounds.ok_or_else(|| "expected six numbers with the lower corner first: x0,y0,z0,x1,y1,z1".into())
}

fn density(text: &str) -> Result<(f64, Interval), String> {
    let read = || {
        let (value, density) = text.split_once('=')?;
        let (lower, upper) = density.split_once("..").unwrap_or((density, density));
        let [value, lower, upper] = [value, lower, upper].map(|text| text.trim().parse::<f64>());
        let (value, lower, upper) = (value.ok()?, lower.ok()?, upper.ok()?);
        let density =
            Interval::new(lower, upper).filter(|density| lower >= 0.0 && density.upper.is_finite())?;
        Some((value, density))
    };
    read().ok_or_else(|| "expected a value, = and a density, or two with .. between them".into())
}

#[derive(Serialize)]
struct Numbers {
    least: f64,
    greatest: f64,
    mean: Volume,
    integral: Volume,
}

#[derive(Serialize)]
struct Whole {
    input: String,
    channel: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<String>,
    volume: Volume,
    volume_without: Volume,
    /// One element for each number of a value.
    values: Vec<Numbers>,
}

#[derive(Serialize)]
struct Material {
    value: Vec<f64>,
    volume: Volume,
    centroid: Option<[Volume; 3]>,
    inertia_about_centroid: [[Volume; 3]; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    mass: Option<Volume>,
}

#[derive(Serialize)]
struct Materials {
    input: String,
    channel: String,
    materials: Vec<Material>,
    #[serde(skip_serializing_if = "Option::is_none")]
    mass: Option<Volume>,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let input = Input::from(&*arguments.file);
    let (octree, _) = input.octree(true)?;
    let text = if arguments.materials {
        each(arguments, &input, &octree)?
    } else {
        all(arguments, &input, &octree)?
    };
    sink::print(text.as_bytes())
}

fn all(arguments: &Arguments, input: &Input, octree: &Octree) -> Result<String, Failure> {
    let channel = find(octree, input, arguments.name.as_deref())?;
    let found = watched("summary", 1, |control| {
        channel.view()?.summary(Some(octree.view()), arguments.bounds.as_ref(), control)
    });
    let Some(found) = found.of(input)? else {
        return Err(Failure::of(input, "the channel has no value in this region of the solid"));
    };
    let ChannelSummary { least, greatest, volume, integral, mean, volume_without } = found;
    let components = 0..channel.value_type().components();
    let unit = channel.metadata().get("unit");
    if arguments.json {
        let values = components.map(|k| Numbers {
            least: least[k],
            greatest: greatest[k],
            mean: mean[k].into(),
            integral: integral[k].into(),
        });
        return sink::json(&Whole {
            input: input.to_string(),
            channel: channel.name().into(),
            unit: unit.map(str::to_owned),
            volume: volume.into(),
            volume_without: volume_without.into(),
            values: values.collect(),
        });
    }
    let unit = unit.map_or_else(String::new, |unit| format!(" {}", unit.escape_debug()));
    let mut text = String::new();
    for k in components {
        let _ = writeln!(text, "least           {}{unit}", number(least[k]));
        let _ = writeln!(text, "greatest        {}{unit}", number(greatest[k]));
        let _ = writeln!(text, "mean            {}{unit}", mean[k]);
        let _ = writeln!(text, "integral        {}", integral[k]);
    }
    let _ = writeln!(text, "volume          {}", volume);
    if volume_without.upper > 0.0 {
        let _ = writeln!(text, "without value   {}", volume_without);
    }
    Ok(text)
}

fn each(arguments: &Arguments, input: &Input, octree: &Octree) -> Result<String, Failure> {
    let channel = find(octree, input, arguments.name.as_deref())?;
    let components = channel.value_type().components();
    let depth = octree.frame().depth().max(channel.frame().depth());
    let found = watched("materials", 0, |control| {
        materials(octree.view(), channel.view()?, &octree.frame().with_depth(depth)?, 0.0, control)
    });
    let found: Vec<Material> =
        found.of(input)?.iter().map(|found| material(found, components, &arguments.density)).collect();
    let mass = found.iter().map(|material| material.mass.as_ref().map(Volume::interval)).try_fold(
        Interval::exactly(0.0),
        |sum, mass| {
            let mass = mass?;
            let lower = (sum.lower + mass.lower).next_down().max(0.0);
            Interval::new(lower, (sum.upper + mass.upper).next_up())
        },
    );
    let mass = mass.filter(|_| !arguments.density.is_empty());
    if arguments.json {
        return sink::json(&Materials {
            input: input.to_string(),
            channel: channel.name().into(),
            materials: found,
            mass: mass.map(Volume::from),
        });
    }
    let mut text = String::new();
    for material in &found {
        let value: Vec<String> = material.value.iter().map(|&x| number(x)).collect();
        let _ = writeln!(text, "value           {}", value.join(" "));
        let _ = writeln!(text, "  volume        {}", material.volume.interval());
        if let Some(centroid) = &material.centroid {
            let place: Vec<String> = centroid.iter().map(|x| x.interval().to_string()).collect();
            let _ = writeln!(text, "  centroid      {}", place.join(", "));
        }
        if let Some(mass) = &material.mass {
            let _ = writeln!(text, "  mass          {}", mass.interval());
        }
    }
    if let Some(mass) = mass {
        let _ = writeln!(text, "mass            {}", mass);
    }
    Ok(text)
}

fn material(found: &MaterialProperties, components: usize, densities: &[(f64, Interval)]) -> Material {
    let properties = &found.properties;
    let density = densities.iter().rev().find(|(value, _)| *value == found.value[0]);
    let mass = density.and_then(|(_, density)| {
        let lower = (properties.volume.lower * density.lower).next_down().max(0.0);
        Interval::new(lower, (properties.volume.upper * density.upper).next_up())
    });
    Material {
        value: found.value[..components].to_vec(),
        volume: properties.volume.into(),
        centroid: properties.centroid.map(|centroid| centroid.map(Volume::from)),
        inertia_about_centroid: properties.inertia_about_centroid.map(|row| row.map(Volume::from)),
        mass: mass.map(Volume::from),
    }
}
