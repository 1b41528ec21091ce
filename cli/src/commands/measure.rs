//! `leafless measure`: volume, centroid, inertia and bounds of a solid.

use crate::failure::{Failure, Of};
use crate::options::{bounds, seconds, threads, tolerance};
use crate::progress::{watched, within_time};
use crate::report::bounds::{Proven, Volume, stop_word};
use crate::report::scene::Curves;
use crate::sink;
use crate::source::corners::Corners;
use crate::source::density::{Density, density, times};
use crate::source::file::Taking;
use crate::source::input::Input;
use crate::source::moved::frame_of;
use crate::source::placing::image;
use crate::source::solid::{Source, evaluations};
use crate::words::{count, number, put_line};
use clap::Args;
use leafless::lattice::MAX_DEPTH;
use leafless::mesh::MeshMoments;
use leafless::query::{Extent, StopReason, SurfaceArea, surface_area};
use leafless::solid::Prepared;
use leafless::{
    Affine, Control, Error, FillRule, Frame, Interval, MassProperties, MeshSolid, Solid, Tolerance,
    TriangleMesh, bounding_box, measure,
};
use serde::Serialize;
use std::ffi::OsString;

/// Measures a solid of density 1, or of --density, without making an octree: the cells with the greatest
/// uncertainty are split first, until the volume is known well enough. All numbers are intervals that contain
/// the true values.
///
/// A solid from a file (.lfl) has no more information about its undecided cells, so its own bounds are
/// printed. A mesh or a scene is split as deep as necessary.
#[derive(Args)]
pub struct Arguments {
    /// Solid (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD, MetaImage), or `-` for
    /// standard input
    file: OsString,
    /// Mass of a cubic unit: tells the mass, and the inertia for this mass. A unit g/cm3, kg/dm3, kg/m3 or
    /// lb/in3 needs the unit of the model, from the file or from --unit: with --unit mm and 7.85g/cm3 the
    /// mass is in grams
    #[arg(long, value_name = "D", value_parser = density, allow_hyphen_values = true)]
    density: Option<Density>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Greatest width of the volume's interval, relative to its middle; 0 continues to the depth. Small
    /// values cost little if the surfaces are those of half-spaces [default: 0.01, or 0 with --splits]
    #[arg(long, value_name = "T", value_parser = tolerance, allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// Width of the volume's interval that suffices in any case, in cubic units [default: a billionth of the
    /// cube that is examined, or 0 with --tolerance or --splits]
    #[arg(long, value_name = "A", value_parser = tolerance, allow_hyphen_values = true)]
    absolute: Option<f64>,
    /// Finest level to split to, 1 to 20 [default: the depth of the solid, or 20 for a mesh or scene]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=MAX_DEPTH as i64))]
    depth: Option<u8>,
    /// Take the cells of a solid from a file (.lfl) as the solid itself, whatever the cells prove about their
    /// source
    #[arg(long)]
    cells: bool,
    /// Time limit in seconds: the command then ends with the bounds found so far. The result then depends on
    /// the machine
    #[arg(long, value_name = "S", value_parser = seconds, allow_hyphen_values = true)]
    seconds: Option<f64>,
    /// Most cells to split [default: 67108864, about a minute]
    #[arg(long, value_name = "N")]
    splits: Option<u64>,
    /// Threads to use, 0 to 1024; 0: one for each processor. The result does not depend on it
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    threads: usize,
    /// Lower corner and edge length of the cube to measure in, for a mesh or scene [default: the cube around
    /// it]
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = bounds, allow_hyphen_values = true)]
    bounds: Option<Frame>,
    #[command(flatten)]
    taking: Taking,
}

/// Accuracy of the sides of the bounding box, relative to the universe's edge, if it is cheap, …
const FINE_SIDES: f64 = 1e-9;
/// … that is, if it takes no more splits than this …
const FEW_SPLITS: u64 = 1 << 14;
/// … and otherwise this accuracy, …
const SIDES: f64 = 0.001;
/// … unless that takes more splits than this.
const MOST_SPLITS: u64 = 1 << 22;

/// Returns the bounding box, as accurately as it is cheap.
fn sides<S: Solid>(
    solid: &S,
    frame: &Frame,
    tolerance: f64,
    control: &Control<'_>,
) -> Result<Extent, leafless::Error> {
    let few = Control {
        max_splits: Some(control.max_splits.map_or(FEW_SPLITS, |most| most.min(FEW_SPLITS))),
        ..*control
    };
    let coarse = SIDES * frame.edge();
    let fine = bounding_box(solid, frame, tolerance.min(FINE_SIDES) * frame.edge(), &few)?;
    let is_coarse =
        |corners: [[Interval; 3]; 2]| corners.as_flattened().iter().any(|side| side.width() > coarse);
    if fine.stop_reason == StopReason::Budget && fine.corners.is_some_and(is_coarse) {
        let most = Control { max_splits: control.max_splits.or(Some(MOST_SPLITS)), ..*control };
        return bounding_box(solid, frame, coarse, &most);
    }
    Ok(fine)
}

/// Most splits for the area without --splits.
const AREA_SPLITS: u64 = 1 << 17;

/// Lower and upper bounds of the elements of a vector or a matrix.
#[derive(Serialize)]
struct Bounds<T> {
    lower: T,
    upper: T,
}

impl From<[Interval; 3]> for Bounds<[f64; 3]> {
    fn from(vector: [Interval; 3]) -> Bounds<[f64; 3]> {
        Bounds { lower: vector.map(|x| x.lower), upper: vector.map(|x| x.upper) }
    }
}

impl From<[[Interval; 3]; 3]> for Bounds<[[f64; 3]; 3]> {
    fn from(matrix: [[Interval; 3]; 3]) -> Bounds<[[f64; 3]; 3]> {
        let of = |end: fn(Interval) -> f64| matrix.map(|row| row.map(end));
        Bounds { lower: of(|x| x.lower), upper: of(|x| x.upper) }
    }
}

#[derive(Serialize)]
struct Report {
    input: String,
    volume: Volume,
    /// Null without a density.
    mass: Option<Volume>,
    /// Unit of the mass and the inertia: `g`, or empty if the density has no unit.
    mass_unit: &'static str,
    /// The proof of the solid; unproven cells count as undecided.
    proof: Proven,
    /// Null if nothing is proven to be inside.
    centroid: Option<Bounds<[f64; 3]>>,
    /// About the centroid.
    inertia: Bounds<[[f64; 3]; 3]>,
    inertia_about_origin: Bounds<[[f64; 3]; 3]>,
    /// Corners of the bounding box; null if the solid is proven to be empty.
    min: Option<Bounds<[f64; 3]>>,
    max: Option<Bounds<[f64; 3]>>,
    /// Area of the boundary; null if unknown.
    area: Option<Volume>,
    /// Greatest distance of the boundary from the mesh with this area, along an axis: the moves of vertices,
    /// and the stated deviation.
    area_displacement: f64,
    area_measured: &'static str,
    area_splits: u64,
    /// The reason why the computation ended.
    measured: &'static str,
    /// Splits other than those for the bounding box and the area.
    splits: u64,
    evaluations: u64,
    level: u8,
    depth: u8,
    origin: [f64; 3],
    edge: f64,
    clipped: bool,
    /// True if everything is known up to rounding, without splitting cells, as for a closed mesh whose
    /// triangles do not intersect; null for other inputs than meshes.
    exact: Option<bool>,
    /// The reason why not.
    inexact_reason: Option<String>,
    /// The way in which the curves of a scene were drawn; null for other inputs.
    curves: Option<Curves>,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let input = Input::from(&*arguments.file);
    let source = Source::before_moving(&input, &arguments.taking)?.taken(arguments.cells);
    let curves = match &source {
        Source::Scene(scene) => Some(Curves::from(scene.report())),
        _ => None,
    };
    let is_stored = source.own_frame().is_some();
    let density = arguments.density.map(|density| density.of_cube(source.unit())).transpose();
    let density = density.map_err(|problem| Failure::Usage(format!("--density: {problem}")))?;
    let (placement, frame) = place(arguments, &input, &source)?;
    let is_scene = matches!(source, Source::Scene(_));
    let own = match &source {
        Source::Mesh(mesh, fill, _) => {
            Some((Corners::new(&input, mesh, *fill)?, as_sewn(&input, mesh, *fill)?))
        }
        _ => None,
    };
    let solid = Prepared::new(source.placed(&input, &placement, &frame)?);
    let own = match solid.solid().sole_mesh().filter(|_| is_scene) {
        // By any fill rule it is the same solid, unless bodies are inside out.
        Some(mesh) => {
            let corners = Corners::new(&input, mesh, FillRule::Positive)?;
            let sewn = if corners.are_exact() { as_sewn(&input, mesh, FillRule::Positive)? } else { None };
            Some((corners, sewn))
        }
        None => own,
    };
    let (corners, sewn) = own.map_or((None, None), |(corners, sewn)| (Some(corners), sewn));
    let asked = arguments.tolerance.is_some() || arguments.splits.is_some();
    let relative = arguments.tolerance.unwrap_or(if arguments.splits.is_some() { 0.0 } else { 0.01 });
    // A flat or empty solid has no volume that the tolerance could refer to.
    let absolute = arguments.absolute.unwrap_or(if asked { 0.0 } else { 1e-9 * frame.edge().powi(3) });
    let tolerance = Tolerance { relative, absolute };
    let asking =
        Asking { solid: &solid, frame: &frame, tolerance, corners: corners.as_ref(), sewn: sewn.as_ref() };
    let found = watched("measure", arguments.threads, |control| {
        let control = Control { max_splits: arguments.splits, ..*control };
        let is_done = |found: &Found| found.mass.stop_reason != StopReason::Budget;
        within_time(arguments.seconds, &control, |control| asking.ask(control), is_done)
    });
    let mut found = found.of(&input)?;
    if let Some((mass, _)) = density {
        found.weigh(mass);
    }
    let unit = density.map_or("", |(_, unit)| unit.name());
    let text = if arguments.json {
        let report = report(&input, &frame, &found, unit);
        sink::json(&Report { curves, ..report })?
    } else {
        text(&found, &frame, curves.as_ref(), (is_stored, arguments.seconds.is_some()), unit)
    };
    sink::print(text.as_bytes())
}

/// The task of a measurement.
struct Asking<'a> {
    solid: &'a Prepared,
    frame: &'a Frame,
    tolerance: Tolerance,
    /// The corners of the triangles of a mesh.
    corners: Option<&'a Corners>,
    /// The mesh without its displacement, if its hair cracks were closed, or if it is known within a
    /// deviation only.
    sewn: Option<&'a AsItIs>,
}

/// A mesh without the displacement of its boundary.
struct AsItIs {
    solid: MeshSolid,
    /// True if the displacement was stated, and not only vertices were moved.
    is_stated: bool,
}

/// The results.
struct Found {
    mass: MassProperties,
    /// The density by which the results were multiplied, if there is one.
    weight: Option<Interval>,
    extent: Extent,
    surface: SurfaceArea,
    /// Greatest distance of the boundary from the mesh with this area.
    area_displacement: f64,
    /// True if the displacement was stated, and not only vertices were moved.
    is_stated: bool,
    evaluations: u64,
    /// For a mesh, the reason why its moments were not known without splitting cells, if they were not.
    inexact: Option<Option<String>>,
}

impl Asking<'_> {
    fn ask(&self, control: &Control<'_>) -> Result<Found, Error> {
        let Asking { solid, frame, tolerance, corners, sewn } = *self;
        let mass = measure(solid, frame, tolerance, control)?;
        let evaluations = evaluations(solid.solid());
        let quiet = Control { progress: None, ..*control };
        // Usually, `measure` has found this out before.
        let inexact = match solid.solid().get::<MeshSolid>() {
            Some(mesh) => Some(inexact_reason(mesh, mass.clipped, &quiet)?),
            None => None,
        };
        let extent = match corners {
            Some(corners)
                if corners.are_exact() && (mass.exact || inexact == Some(None)) && !mass.clipped =>
            {
                Extent {
                    corners: Some(corners.exact()),
                    occupied: true,
                    proof: mass.proof,
                    clipped: false,
                    stop_reason: StopReason::Tolerance,
                    splits: 0,
                }
            }
            _ => sides(solid, frame, tolerance.relative, &quiet)?,
        };
        let within = |found| corners.map_or(found, |corners| corners.within(found));
        let extent = Extent { corners: extent.corners.map(within), ..extent };
        let most = Some(control.max_splits.unwrap_or(AREA_SPLITS));
        let few = Control { max_splits: most, ..quiet };
        let mut surface = surface_area(solid.solid(), frame, tolerance.relative, &few)?;
        let mut area_displacement = 0.0;
        // A surface that may lie beside the mesh may have any area; the area of the mesh is reported instead.
        let is_stated = sewn.is_some_and(|sewn| sewn.is_stated);
        if let Some(AsItIs { solid, .. }) = sewn.filter(|_| !is_known(&surface)) {
            surface = surface_area(solid, frame, tolerance.relative, &few)?;
            area_displacement = mass.proof.displacement();
        }
        Ok(Found { mass, weight: None, extent, surface, area_displacement, is_stated, evaluations, inexact })
    }
}

impl Found {
    /// Multiplies the volume and the inertia by the mass of a cubic unit.
    fn weigh(&mut self, mass: f64) {
        self.weight = Some(times(self.mass.volume, mass));
        for tensor in [&mut self.mass.inertia_about_centroid, &mut self.mass.inertia_about_origin] {
            *tensor = tensor.map(|row| row.map(|entry| times(entry, mass)));
        }
    }
}

/// Returns a mesh whose hair cracks were closed, or that has a deviation, as if its boundary were exact.
fn as_sewn(input: &Input, mesh: &TriangleMesh, fill: FillRule) -> Result<Option<AsItIs>, Failure> {
    if mesh.displacement() == 0.0 {
        return Ok(None);
    }
    let same = TriangleMesh::new(mesh.vertices().to_vec(), mesh.triangles().to_vec()).of(input)?;
    let solid = MeshSolid::new(same, fill).of(input)?;
    Ok(Some(AsItIs { solid, is_stated: mesh.deviation() > 0.0 }))
}

/// Returns the rest of the placement, and the frame to examine. A solid from a file is moved as a solid:
/// cells of any size then tell as much as its own ones.
fn place(arguments: &Arguments, input: &Input, source: &Source) -> Result<(Affine, Frame), Failure> {
    let (bounds, depth) = (arguments.bounds.as_ref(), arguments.depth);
    let (Source::Octree(octree), Some(map)) = (source, arguments.taking.placing.map()) else {
        return Ok((Affine::IDENTITY, source.frame_in(input, bounds, depth)?));
    };
    let frame = match bounds {
        Some(bounds) => *bounds,
        None => frame_of(octree, map).of(input)?,
    };
    let is_image = bounds.is_none() && image(octree.frame(), map).is_some();
    let depth = depth.unwrap_or(if is_image { frame.depth() } else { MAX_DEPTH });
    Ok((*map, frame.with_depth(depth).of(input)?))
}

/// Returns the reason why a mesh's moments were not known without splitting cells; `None` if they were.
fn inexact_reason(mesh: &MeshSolid, clipped: bool, control: &Control<'_>) -> Result<Option<String>, Error> {
    Ok(match mesh.moments(control)? {
        MeshMoments::Known(_) if clipped => Some("the mesh reaches beyond the bounds, or may".into()),
        MeshMoments::Known(_) => None,
        MeshMoments::Open => Some("the mesh does not bound a solid".into()),
        MeshMoments::Intersecting([a, b]) => Some(format!("triangles {a} and {b} intersect, for instance")),
        MeshMoments::Undecided => Some("it is not known whether triangles intersect".into()),
    })
}

fn report(input: &Input, frame: &Frame, found: &Found, mass_unit: &'static str) -> Report {
    let Found { mass, surface, extent, .. } = found;
    Report {
        input: input.to_string(),
        volume: mass.volume.into(),
        mass: found.weight.map(Into::into),
        mass_unit,
        proof: mass.proof.into(),
        centroid: mass.centroid.map(Into::into),
        inertia: mass.inertia_about_centroid.into(),
        inertia_about_origin: mass.inertia_about_origin.into(),
        min: extent.corners.map(|[min, _]| min.into()),
        max: extent.corners.map(|[_, max]| max.into()),
        area: is_known(surface).then(|| surface.area.into()),
        area_displacement: found.area_displacement,
        area_measured: stop_word(surface.stop_reason),
        area_splits: surface.splits,
        measured: stop_word(mass.stop_reason),
        splits: mass.splits,
        evaluations: found.evaluations,
        level: mass.level,
        depth: frame.depth(),
        origin: frame.origin(),
        edge: frame.edge(),
        clipped: mass.clipped,
        exact: found.inexact.as_ref().map(Option::is_none),
        inexact_reason: found.inexact.clone().flatten(),
        curves: None,
    }
}

fn is_known(surface: &SurfaceArea) -> bool {
    surface.area.upper < f64::INFINITY
}

/// Returns the report for people.
fn text(
    found: &Found,
    frame: &Frame,
    curves: Option<&Curves>,
    (is_stored, is_timed): (bool, bool),
    unit: &str,
) -> String {
    let Found { mass, surface, extent, inexact, .. } = found;
    let mut text = String::new();
    let mut line = |name: &str, value: String| put_line(&mut text, name, &value);
    line("volume", mass.volume.to_string());
    if let Some(weight) = found.weight {
        line("mass", format!("{} {unit}", weight).trim_end().to_owned());
    }
    let area = match is_known(surface) {
        true if found.area_displacement > 0.0 && found.is_stated => format!(
            "{}, of the mesh: the true boundary lies beside it by {} or less, and may have any area",
            surface.area,
            number(found.area_displacement)
        ),
        true if found.area_displacement > 0.0 => format!(
            "{}, of the mesh with hair cracks closed: vertices were moved by {} or less",
            surface.area,
            number(found.area_displacement)
        ),
        true => surface.area.to_string(),
        false if is_stored => "not known: a file does not tell what its surface is like between cells".into(),
        false => match inexact {
            Some(Some(reason)) => format!("not known: {reason}"),
            _ => "not known".into(),
        },
    };
    line("area", area);
    if let Some(doubt) = Proven::from(mass.proof).doubt() {
        line("proven", doubt);
    }
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        if let Some(centroid) = mass.centroid {
            line(&format!("centroid {name}"), centroid[axis].to_string());
        }
    }
    for (name, tensor) in
        [("inertia", &mass.inertia_about_centroid), ("about origin", &mass.inertia_about_origin)]
    {
        for (i, j, axes) in
            [(0, 0, "xx"), (1, 1, "yy"), (2, 2, "zz"), (0, 1, "xy"), (0, 2, "xz"), (1, 2, "yz")]
        {
            line(&format!("{name} {axes}"), tensor[i][j].to_string());
        }
    }
    if let Some([min, max]) = extent.corners {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            // A solid that continues beyond the cube may extend any further.
            let (start, end) = (frame.origin()[axis], frame.origin()[axis] + frame.edge());
            let wall = |is_wall: bool| {
                if is_wall && mass.clipped { ", where the cube ends that is looked at" } else { "" }
            };
            line(&format!("least {name}"), min[axis].to_string() + wall(min[axis].lower <= start));
            line(&format!("greatest {name}"), max[axis].to_string() + wall(max[axis].upper >= end));
        }
    }
    if let Some(curves) = curves.and_then(Curves::text) {
        line("curves", curves);
    }
    match inexact {
        _ if found.is_stated && mass.exact => line(
            "exact",
            "yes, but for the deviation: it is that of all solids that end so near to the mesh".into(),
        ),
        Some(None) => {
            line("exact", "yes, but for rounding: the mesh is closed, and no triangles intersect".into())
        }
        Some(Some(reason)) => line("exact", format!("no: {reason}")),
        None if mass.exact => {
            line("exact", "yes, but for rounding: the file keeps what its mesh knew of itself".into())
        }
        None => {}
    }
    let ended = match (mass.stop_reason, is_stored) {
        (StopReason::Tolerance, _) => "",
        _ if mass.exact => "",
        (StopReason::Budget, _) if is_timed => ", when the time was over",
        (StopReason::Budget, _) => ", which were all that may be split",
        (StopReason::Exhausted, true) => ", and the file knows no more",
        (StopReason::Exhausted, false) => ", and there is nothing left to split at this depth",
    };
    line("splits", format!("{}, to level {}{ended}", count(mass.splits), mass.level));
    if mass.clipped {
        line("clipped", "this is the part inside of the bounds; the solid may go on outside".into());
    }
    text
}
