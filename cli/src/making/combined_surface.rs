//! Set operations whose result is a triangle mesh.

use crate::failure::{Failure, Of};
use crate::making::askew;
use crate::making::job::Job;
use crate::making::operand::{Common, reach};
use crate::making::operands::{Combining, Operation};
use crate::making::surface::{Made, Method, Wanted, of_solid, write};
use crate::options::name_of;
use crate::progress::watched;
use crate::sink::Output;
use crate::source::input::Input;
use crate::source::placing::Placing;
use crate::source::solid::{Shape, Source};
use leafless::exchange::MeshFormat;
use leafless::{Affine, AnySolid, Csg, Error};
use std::time::Instant;

/// Levels of cells without --depth.
const DEPTH: u8 = 8;

/// Combines meshes, scenes and volumes directly, and writes the surface, with vertices where edges of cells
/// cross it.
pub fn make(
    combining: &Combining,
    files: &[(Input, Placing)],
    output: &Output,
    format: MeshFormat,
) -> Result<(), Failure> {
    let start = Instant::now();
    let refusal =
        |problem: String| Err(Failure::Usage(format!("{output}: its name is that of a mesh, and {problem}")));
    if let Operation::Complement = combining.operation {
        return refusal("a complement is infinite".into());
    }
    if !combining.carry.is_empty() || combining.plain.is_some() {
        return refusal("--carry and --plain are for octrees".into());
    }
    let read = |(input, placing): &(Input, Placing)| Shape::among_others(input, combining.taking, placing);
    let shapes = files.iter().map(read).collect::<Result<Vec<_>, Failure>>()?;
    if let Some(((input, _), _)) = files.iter().zip(&shapes).find(|(_, shape)| shape.is_stored()) {
        return refusal(format!(
            "{input} is a solid, so the result is one (.lfl); `leafless mesh` makes a mesh of it"
        ));
    }
    let depth = combining.depth.unwrap_or(DEPTH);
    let has_voxels = matches!(&shapes[0], Shape::Source(Source::Volume(volume)) if volume.frame.is_some());
    let frame = match combining.bounds {
        None if !has_voxels => {
            let (low, high, _) = reach(files, &shapes)?;
            askew::cube(low, high, depth).of(&files[0].0)?
        }
        // The voxels have a size of their own.
        None => Common::new(files, &shapes, (None, combining.depth))?.frame,
        bounds => Common::new(files, &shapes, (bounds, Some(depth)))?.frame,
    };
    let sources = shapes.into_iter().filter_map(|shape| match shape {
        Shape::Source(source) => Some(source),
        Shape::Dexels(_) => None,
    });
    let sources: Vec<Source> = sources.collect();
    let units: Vec<_> = sources.iter().map(Source::unit).collect();
    let unit = units[0].filter(|_| units.iter().all(|unit| *unit == units[0]));
    let placed =
        files.iter().zip(sources).map(|((input, _), source)| source.placed(input, &Affine::IDENTITY, &frame));
    let solids = placed.collect::<Result<Vec<AnySolid>, Failure>>()?;
    let (name, first) = (combining.operation.name(), &files[0].0);
    let wanted = Wanted::default();
    let mesh = watched(name, combining.threads, |control| {
        let solid = AnySolid::new(combined(combining.operation, solids)?);
        of_solid(&solid, &frame, &wanted, Method::Mc, control)
    });
    let made = Made { mesh: mesh.of(first)?, unit, method: name_of(Method::Mc), followed: None, faces: None };
    let (input, output, threads) = (first.clone(), output.clone(), combining.threads);
    let job =
        Job { input, output, start, depth: Some(depth), bounds: combining.bounds, threads, json: false };
    write(&job, format, &wanted, made)
}

fn combined(operation: Operation, solids: Vec<AnySolid>) -> Result<Csg, Error> {
    let mut solids = solids.into_iter().map(Csg::solid);
    match operation {
        Operation::Union => Csg::union_of(solids),
        Operation::Intersection => Csg::intersection_of(solids),
        Operation::Xor => Csg::xor_of(solids),
        Operation::Difference | Operation::Complement => {
            let first = solids.next().unwrap_or_else(Csg::empty);
            first.difference(&Csg::union_of(solids)?)
        }
    }
}
