//! `leafless layout`: copies of parts in a container.

use crate::failure::{Failure, Of};
use crate::making::laid::{Scenery, package, surfaces};
use crate::making::laid_picture::picture;
use crate::options::{numbers, seconds, threads, tolerance};
use crate::progress::{until, watched};
use crate::report::layout::{Checked, Found, Item};
use crate::sink::{Output, print_told};
use crate::source::density::{Density, MassUnit, density};
use crate::source::input::Input;
use crate::source::mesh::unit;
use crate::source::placing::from_file;
use crate::source::plan::{Ends, Measures, Near, Plan, Standing, folder_of, name_of};
use crate::source::stock::{Clearances, Copies, Holder, Stock, named};
use clap::Args;
use leafless::exchange::LengthUnit;
use leafless::layout::{Direction, Layout, LayoutMeasures, Objective, Orientations, SearchOptions};
use leafless::{Affine, Control, Error, Interval};
use std::ffi::{OsStr, OsString};
use std::path::Path;
use std::time::Instant;

/// Places copies of parts in a container. Each copy that is placed is proven to lie in the container, to
/// overlap with no other copy and no obstacle, and to keep the required distances. A copy for which this
/// cannot be proven is not placed. The exit code is 0 if all copies are placed, and 1 if some are left over.
/// The layout is written in both cases.
///
/// The JSON tells which copy stands where, and --check proves it again. The 3MF has one object for each item,
/// and the item's copies in their places, ready to be printed. A mesh is stored as it is; for other items,
/// the surface is made as `leafless mesh` makes it, and approximates the solid. The scene (.csg) is for
/// `leafless render` and OpenSCAD; the container is marked by % in it. The picture (.png) shows the copies of
/// each item in one colour, obstacles in grey, and a box around the container.
///
/// Lengths are in model units. Unknown numbers are null in JSON. Copies and obstacles are numbered from 0, in
/// the order of the JSON.
#[derive(Args)]
#[command(
    override_usage = "leafless layout [OPTIONS] --output <OUTPUT> <CONTAINER> <ITEM[*COUNT]>...\n       \
                            leafless layout --check <LAYOUT> [--splits <N>] [--threads <N>] [--json]"
)]
pub struct Arguments {
    /// The container: a solid (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD,
    /// MetaImage), or `box:X,Y,Z`, a box with its lower corner at the origin
    #[arg(value_name = "CONTAINER", required_unless_present = "check", conflicts_with = "check")]
    container: Option<OsString>,
    /// The parts to place, of the same kinds: `part.stl`, or `part.stl*30` for thirty copies. All items
    /// together may have 10,000 copies
    #[arg(value_name = "ITEM[*COUNT]", required_unless_present = "check", conflicts_with = "check")]
    items: Vec<OsString>,
    /// File for the layout: the extension .json, .3mf, .csg or .png decides the format; `-` is standard
    /// output, for JSON. May be given several times
    #[arg(short, long, value_name = "OUTPUT", required_unless_present = "check", conflicts_with = "check")]
    output: Vec<OsString>,
    /// Check the layout in a file (.json): read all files in it again, and tell which copies are in conflict,
    /// and with what. The exit code is 0 if all copies are proven to stand as they should, and otherwise 1
    #[arg(long, value_name = "LAYOUT")]
    check: Option<OsString>,
    /// Least distance between two copies, and between a copy and an obstacle, in model units [default: 0]
    #[arg(long, value_name = "C", value_parser = tolerance, allow_hyphen_values = true, conflicts_with = "check")]
    clearance: Option<f64>,
    /// Least distance between a copy and the outside of the container, in model units [default: 0]
    #[arg(long, value_name = "W", value_parser = tolerance, allow_hyphen_values = true, conflicts_with = "check")]
    wall_clearance: Option<f64>,
    /// File of an obstacle that stands in the container already. May be given several times
    #[arg(long, value_name = "FILE", conflicts_with = "check")]
    obstacle: Vec<OsString>,
    /// How copies may be turned: `as-given`, not at all; `24`, by quarter turns; `free:N`, as given and by N
    /// arbitrary turns; or a file of matrices, one a line as --place of other commands takes it, of which
    /// only the rotation counts [default: 24]
    #[arg(long, value_name = "TURNS", conflicts_with = "check")]
    orientations: Option<OsString>,
    /// What to achieve: `count`, as many copies as possible; `height`, the same, as low as possible along z;
    /// `density`, as much volume as possible; `balance=X,Y,Z`, as many copies as possible with their centre
    /// of gravity near a point [default: count]
    #[arg(long, value_name = "AIM", value_parser = objective, conflicts_with = "check")]
    objective: Option<Objective>,
    /// All copies can be taken out along this direction, the last one first, without hitting another copy:
    /// +x, -x, +y, -y, +z or -z
    #[arg(long, value_name = "WAY", value_parser = direction, allow_hyphen_values = true, conflicts_with = "check")]
    free_along: Option<Direction>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Cells along the longest side of the container that the search uses, 4 to 512 [default: as many as the
    /// items need]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(4..=512), conflicts_with = "check", help_heading = "Accuracy")]
    cells: Option<u32>,
    /// How often everything is placed anew, 1 or more; the best layout is kept [default: 4]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), conflicts_with = "check", help_heading = "Limits")]
    rounds: Option<u32>,
    /// Time limit of the search in seconds: the command then ends with the best layout so far. The result
    /// then depends on the machine
    #[arg(long, value_name = "S", value_parser = seconds, allow_hyphen_values = true, conflicts_with = "check")]
    seconds: Option<f64>,
    /// Most places that are tried with the solids themselves
    #[arg(long, value_name = "N", conflicts_with = "check")]
    tests: Option<u64>,
    /// Most cells to split for proofs; with --check, for each pair
    #[arg(long, value_name = "N")]
    splits: Option<u64>,
    /// Seed of the random numbers: the same seed gives the same layout [default: 0]
    #[arg(long, value_name = "S", conflicts_with = "check", help_heading = "Limits")]
    seed: Option<u64>,
    /// Threads to use, 0 to 1024; 0: one for each processor. The result does not depend on it
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    threads: usize,
    /// Mass of a cubic unit: one number for all items, or one for each, separated by commas; or with a unit,
    /// g/cm3, kg/dm3, kg/m3 or lb/in3, if the unit of the model is known. Used for the mass, the centroid and
    /// the objective `balance` [default: 1]
    #[arg(long, value_name = "D[,D]...", value_parser = density, value_delimiter = ',', allow_hyphen_values = true, conflicts_with = "check")]
    density: Vec<Density>,
    /// Unit of the model, if no file tells it: um, mm, cm, m, in or ft. It is written into the 3MF
    #[arg(long, value_name = "UNIT", value_parser = unit, conflicts_with = "check")]
    unit: Option<LengthUnit>,
}

/// Accuracy of volumes, relative to them, …
const DIGITS: f64 = 1e-4;
/// … and the splits for each of them.
const SPLITS: u64 = 1 << 18;

fn objective(text: &str) -> Result<Objective, String> {
    let expected = "expected count, height, density, or balance=x,y,z";
    match (text, text.strip_prefix("balance=").map(numbers)) {
        ("count", _) => Ok(Objective::Count),
        ("height", _) => Ok(Objective::Height),
        ("density", _) => Ok(Objective::Density),
        (_, Some(Some(point))) if point.iter().all(|x: &f64| x.is_finite()) => Ok(Objective::Balance(point)),
        _ => Err(expected.into()),
    }
}

fn direction(text: &str) -> Result<Direction, String> {
    let (upward, name) = match text.strip_prefix('-') {
        Some(name) => (false, name),
        None => (true, text.strip_prefix('+').unwrap_or(text)),
    };
    let axis = ["x", "y", "z"].iter().position(|axis| *axis == name);
    let axis = axis.ok_or("expected +x, -x, +y, -y, +z or -z")?;
    Ok(Direction { axis: axis as u8, upward })
}

fn orientations(name: Option<&OsStr>) -> Result<Orientations, Failure> {
    let Some(name) = name else { return Ok(Orientations::Turns) };
    match name.to_str() {
        Some("as-given") => return Ok(Orientations::AsGiven),
        Some("24") => return Ok(Orientations::Turns),
        _ => {}
    }
    if let Some(number) = name.to_str().and_then(|name| name.strip_prefix("free:")) {
        const MOST: u32 = Orientations::MOST;
        let number = number.parse().ok().filter(|number| (1..=MOST).contains(number));
        let number = number.ok_or_else(|| {
            Failure::Usage(format!("--orientations free:N: expected a number from 1 to {MOST}"))
        })?;
        return Ok(Orientations::Free(number));
    }
    let path = Path::new(name);
    if !path.exists() {
        let problem = "is neither as-given, 24, free:N nor a file of matrices";
        return Err(Failure::Usage(format!("--orientations: {} {problem}", path.display())));
    }
    let turns = from_file(path, &Affine::IDENTITY)?;
    if turns.is_empty() {
        return Err(Failure::of(path.display(), "has no matrix in it"));
    }
    if turns.len() > Orientations::MOST as usize {
        let most = crate::words::count(Orientations::MOST.into());
        return Err(Failure::of(path.display(), format_args!("has more than {most} matrices in it")));
    }
    Ok(Orientations::List(turns))
}

/// The formats of layouts.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Format {
    Json,
    Package,
    Scene,
    Picture,
}

fn format(output: &Output) -> Result<Format, Failure> {
    let Some(path) = output.path() else { return Ok(Format::Json) };
    match path.extension().and_then(OsStr::to_str).map(str::to_ascii_lowercase).as_deref() {
        Some("json") => Ok(Format::Json),
        Some("3mf") => Ok(Format::Package),
        Some("csg") => Ok(Format::Scene),
        Some("png") => Ok(Format::Picture),
        _ => {
            let problem = "has none of the extensions .json, .3mf, .csg and .png, which decide the format";
            Err(Failure::Usage(format!("{output}: {problem}")))
        }
    }
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(name) = &arguments.check {
        return check(arguments, &Input::from(&**name));
    }
    let start = Instant::now();
    let outputs: Vec<Output> = arguments.output.iter().map(|name| Output::from(&**name)).collect();
    let formats = outputs.iter().map(format).collect::<Result<Vec<_>, _>>()?;
    let turns = orientations(arguments.orientations.as_deref())?;
    let mut stock = Stock {
        holder: Holder::of(arguments.container.as_deref().unwrap_or_default())?,
        obstacles: arguments.obstacle.iter().map(|name| named(name)).collect::<Result<_, _>>()?,
        items: arguments.items.iter().map(|name| Copies::of(name)).collect::<Result<_, _>>()?,
    };
    stock.weigh(&arguments.density)?;
    for output in &outputs {
        if output.path().is_some() {
            output.check()?;
        }
        for input in stock.files() {
            output.check_spares(input, "input")?;
        }
    }
    let clearances = Clearances {
        between: arguments.clearance.unwrap_or(0.0),
        wall: arguments.wall_clearance.unwrap_or(0.0),
    };
    let solids = stock.read(&turns, clearances, arguments.unit)?;
    // Scenes that cannot be written are reported before the search.
    let scenes = outputs.iter().zip(&formats).map(|(output, format)| match format {
        Format::Scene => Scenery::new(&stock, &solids, folder_of(output.path())).map(Some),
        _ => Ok(None),
    });
    let scenes = scenes.collect::<Result<Vec<_>, _>>()?;
    let is_shown = formats.contains(&Format::Picture);
    let items = stock.items.iter().filter(|_| is_shown || formats.contains(&Format::Package));
    let meshes = surfaces(items.map(|copies| &copies.input), arguments.threads)?;
    let obstacles = surfaces(stock.obstacles.iter().filter(|_| is_shown), arguments.threads)?;
    let options = SearchOptions {
        objective: arguments.objective.unwrap_or(Objective::Count),
        seed: arguments.seed.unwrap_or(0),
        rounds: arguments.rounds.unwrap_or(SearchOptions::default().rounds),
        cells: arguments.cells.unwrap_or(0),
        max_tests: arguments.tests,
        free_along: arguments.free_along,
    };
    let found = watched("layout", arguments.threads, |control| {
        let mut layout = Layout::new(&solids.bay, control)?;
        let search = until(arguments.seconds, |cancel| {
            let control = Control { max_splits: arguments.splits, cancel, ..*control };
            layout.search(&options, &control)
        })?;
        let (nearest, measures) = known(&layout, solids.mass_unit, control)?;
        Ok((layout, search, nearest, measures))
    });
    let (layout, search, nearest, measures) = found.of(&stock.holder)?;
    let placed = layout.placed();
    let of_item = |item: usize| placed.iter().filter(|placed| placed.item == item).count() as u64;
    let items = stock.items.iter().enumerate().map(|(item, Copies { input, count, .. })| {
        let (name, count, placed) = (name_of(&input.to_string()), u64::from(*count), of_item(item));
        Item { name, count, placed, left: count - placed }
    });
    let items: Vec<Item> = items.collect();
    for ((output, format), scene) in outputs.iter().zip(formats).zip(scenes) {
        match (format, scene) {
            (Format::Scene, Some(scene)) => output.write(scene.text(placed).of(output)?.as_bytes())?,
            (Format::Package, _) => {
                output.write(&package(&stock, &meshes, placed, solids.unit).of(output)?)?;
            }
            (Format::Picture, _) => {
                let bytes = picture(&layout, &meshes, &obstacles, &Control::threads(arguments.threads));
                output.write(&bytes.of(output)?)?;
            }
            _ => {
                let standings = placed.iter().zip(&nearest).map(|(placed, nearest)| Standing {
                    item: placed.item,
                    name: items[placed.item].name.clone(),
                    matrix: *placed.placement.rows(),
                    nearest: *nearest,
                });
                let folder = folder_of(output.path());
                let plan =
                    Plan::new(&stock, &solids.densities, clearances, standings.collect(), measures, folder)?;
                output.write(plan.text()?.as_bytes())?;
            }
        }
    }
    let names = outputs.iter().map(Output::to_string).collect();
    let seconds = start.elapsed().as_secs_f64();
    let report = Found::new(stock.holder.to_string(), items, measures, &search, names, seconds);
    // (If standard output carries a layout, the report goes to standard error.)
    let carrier = outputs.iter().find(|output| output.path().is_none()).or(outputs.first());
    match carrier {
        Some(output) => output.tell(arguments.json, &report, Found::text)?,
        None => print_told(arguments.json, &report, Found::text)?,
    }
    report.rest().map_or(Ok(()), |rest| Err(Failure::Failed(rest)))
}

/// Returns the neighbour of each copy, and the measures of all copies.
fn known(
    layout: &Layout,
    mass_unit: MassUnit,
    control: &Control<'_>,
) -> Result<(Vec<Option<Near>>, Measures), Error> {
    let quiet = Control { progress: None, ..*control };
    let mut nearest = vec![];
    let mut smallest: Option<Interval> = None;
    for number in 0..layout.placed().len() {
        let near = layout.check(number, &quiet)?.nearest;
        if let Some(near) = &near {
            let gap = near.gap;
            let lesser = |least: Interval| {
                let (lower, upper) = (least.lower.min(gap.lower), least.upper.min(gap.upper));
                Interval::new(lower, upper).unwrap_or(least)
            };
            smallest = Some(smallest.map_or(gap, lesser));
        }
        nearest.push(near.map(|near| Near { other: near.other.into(), gap: near.gap.into() }));
    }
    let quiet = Control { max_splits: Some(SPLITS), ..quiet };
    let LayoutMeasures { volume, filled_part, height, mass, centroid, .. } =
        layout.measures(DIGITS, &quiet)?;
    let measures = Measures {
        volume: volume.into(),
        filled_part: filled_part.into(),
        height: height.into(),
        mass: mass.into(),
        mass_unit,
        centroid: centroid.map(|centre| centre.map(Ends::from)),
        smallest_gap: smallest.map(Ends::from),
    };
    Ok((nearest, measures))
}

/// Proves a layout again.
fn check(arguments: &Arguments, input: &Input) -> Result<(), Failure> {
    let plan = Plan::read(input)?;
    let stock = plan.stock(folder_of(input.path()), input)?;
    let solids = stock.read(&Orientations::AsGiven, plan.clearances(), None)?;
    let control = Control { threads: arguments.threads, ..Control::default() };
    let mut layout = Layout::new(&solids.bay, &control).of(input)?;
    plan.place(&mut layout, input)?;
    let standings = watched("layout", arguments.threads, |control| {
        layout.check_all(&Control { max_splits: arguments.splits, ..*control })
    });
    let report = Checked::new(input.to_string(), &plan, &standings.of(input)?);
    print_told(arguments.json, &report, Checked::text)?;
    report.problem().map_or(Ok(()), |problem| Err(Failure::of(input, problem)))
}
