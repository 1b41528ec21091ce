//! `leafless render`: what does it look like?

use crate::channel;
use crate::dexel_surface;
use crate::failure::{Failure, Of};
use crate::input::Input;
use crate::mesh::Reading;
use crate::output::{self, Output, count, json, seconds};
use crate::progress::watched;
use crate::scene::Drawing;
use crate::shape::Shape;
use crate::source::Source;
use crate::voxelize::threads;
use clap::{Args, ValueEnum};
use leafless::{
    Affine, AnySolid, Attribute, Bounds, Camera, CellFilter, Channel, Clip, ClippedLayer, ColourMap,
    Compositing, Control, Criterion, Cube, Detail, FIELD_OF_VIEW, Finish, Frame, Layer, LegendSide, Lens,
    MAX_DEPTH, MeshEdges, MeshLayer, Octree, OctreeLayer, Picture, Resolve, Rule, Shot, SliceLayer,
    SlicePlane, SolidLayer, TAG_COLOURS, Tag, Transfer, TriangleMesh, VolumeLayer, VoxelOptions,
    VoxelRecords, bounding_box, build, draw_colour_bar, draw_names, exchange, marching_cubes,
    octree_of_dexels, render,
};
use serde::Serialize;
use std::ffi::OsString;
use std::time::Instant;

/// Makes a picture (PNG) of a solid, a mesh, a scene, a volume or a tri-dexel model.
///
/// A solid from a file is shown as its cells make its surface likely to be; with --faces, as its cells are. A mesh, a scene or
/// a volume is shown itself, without an octree.
#[derive(Args)]
// Of arrays without a header, `--samples` says the extents everywhere else.
#[command(mut_arg("extents", |extents| extents.long("array-samples")))]
pub struct Arguments {
    /// Solid or tri-dexel model (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD, MetaImage), or `-` for
    /// standard input
    #[arg(value_name = "FILE")]
    input: OsString,
    /// File to write (PNG), or `-` for standard output; it is written whole or not at all
    #[arg(short, long, value_name = "OUT")]
    output: OsString,
    /// What to show
    #[arg(long, value_enum, default_value_t = View::Surface)]
    view: View,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = size)]
    size: [u32; 2],
    /// From where to look, in degrees: 0,0 is from the front (−y) with z upward, a positive azimuth from further right, a
    /// positive elevation from further above
    /// [default: 30,25; of a slice its plane from in front]
    #[arg(long, value_name = "AZIMUTH,ELEVATION", value_parser = numbers::<2>, allow_hyphen_values = true,
          verbatim_doc_comment)]
    from: Option<[f64; 2]>,
    /// Where the eye is, instead of --from
    #[arg(long, value_name = "X,Y,Z", value_parser = numbers::<3>, allow_hyphen_values = true)]
    eye: Option<[f64; 3]>,
    /// What the eye looks at [default: the middle]
    #[arg(long, value_name = "X,Y,Z", value_parser = numbers::<3>, allow_hyphen_values = true, requires = "eye")]
    at: Option<[f64; 3]>,
    /// What is upward [default: 0,0,1, or where one looks along it 0,1,0]
    #[arg(long, value_name = "X,Y,Z", value_parser = numbers::<3>, allow_hyphen_values = true, requires = "eye")]
    up: Option<[f64; 3]>,
    /// Field of view from the lower to the upper edge, in degrees
    #[arg(long, value_name = "DEGREES", default_value_t = FIELD_OF_VIEW)]
    fov: f64,
    /// Parallel lines stay parallel
    #[arg(long, conflicts_with = "fov")]
    ortho: bool,
    /// Cut away the points x, y, z with a x + b y + c z + d < 0; may be given more than once
    #[arg(long, value_name = "A,B,C,D", value_parser = numbers::<4>, allow_hyphen_values = true)]
    clip: Vec<[f64; 4]>,
    /// Cut away what lies outside of this box
    #[arg(long, value_name = "X0,Y0,Z0,X1,Y1,Z1", value_parser = numbers::<6>, allow_hyphen_values = true)]
    clip_box: Option<[f64; 6]>,
    /// Samples of a pixel: 1, 4, 9, 16, 25, 36, 49 or 64
    #[arg(id = "per_pixel", long = "samples", value_name = "N", default_value_t = 4)]
    samples: u32,
    /// Plane of the slice: the points x, y, z with a x + b y + c z = d. Without it: the one through the middle that is
    /// seen best of those along the axes
    #[arg(long, value_name = "A,B,C,D", value_parser = numbers::<4>, allow_hyphen_values = true)]
    plane: Option<[f64; 4]>,
    /// Channel of the solid whose values are shown. Without it: the only one, if there is one
    #[arg(long, value_name = "NAME")]
    channel: Option<String>,
    /// Colours of values: viridis, cividis, inferno, magma, plasma or grey
    #[arg(long, value_name = "NAME", default_value = "viridis", value_parser = map)]
    map: ColourMap,
    /// Values at both ends of the colours. Without it: the least and the greatest
    #[arg(long, value_name = "A,B", value_parser = numbers::<2>, allow_hyphen_values = true)]
    range: Option<[f64; 2]>,
    /// Opacity of a volume as thick as the solid's longest side, 0 to 1
    #[arg(long, value_name = "ALPHA", default_value_t = 0.95)]
    opacity: f64,
    /// Show voxels as published: of an edge of k finest voxels as k layers, wherever a line of sight crosses them
    #[arg(long)]
    published: bool,
    /// Draw edges of a mesh: those at which its faces meet at more than 30 degrees, or all
    #[arg(long, value_enum, value_name = "WHICH", num_args = 0..=1, default_missing_value = "features")]
    edges: Option<Edges>,
    /// Level of the cells that a mesh, a scene or a volume is split to for a slice or a volume, 1 to 20
    #[arg(long, value_name = "N", default_value_t = DEPTH, value_parser = clap::value_parser!(u8).range(1..=MAX_DEPTH as i64))]
    depth: u8,
    /// Leave out the legend
    #[arg(long)]
    no_legend: bool,
    /// Show the cells of a solid by their faces
    #[arg(long)]
    faces: bool,
    /// Colour of the surface, as in #b2bbc4
    #[arg(long, value_name = "COLOUR", value_parser = colour)]
    colour: Option<[u8; 4]>,
    /// Colour of what is seen where nothing is, as in #ffffff, or `none`
    #[arg(long, value_name = "COLOUR", default_value = "#ffffff", value_parser = colour)]
    background: [u8; 4],
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    drawing: Drawing,
    /// Threads to use; 0: as many as there are processors. The picture is the same
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    threads: usize,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|number| number.trim().parse()).collect();
    let numbers = numbers.ok().filter(|numbers| numbers.iter().all(|x| x.is_finite()));
    numbers
        .and_then(|numbers| numbers.try_into().ok())
        .ok_or_else(|| format!("expected {N} numbers with commas between"))
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    let good = |sides: &[u32; 2]| sides.iter().all(|side| (1..=16384).contains(side));
    sides.filter(good).ok_or_else(|| "expected width and height, 1 to 16384 each, as in 800x600".into())
}

fn colour(text: &str) -> Result<[u8; 4], String> {
    if text == "none" {
        return Ok([0; 4]);
    }
    let digits = text.strip_prefix('#').unwrap_or(text);
    let number = u32::from_str_radix(digits, 16).ok().filter(|_| digits.is_ascii());
    match (number, digits.len()) {
        (Some(number), 6) => Ok((number << 8 | 0xFF).to_be_bytes()),
        (Some(number), 8) => Ok(number.to_be_bytes()),
        _ => Err("expected a colour of six or eight hexadecimal digits, as in #b2bbc4".into()),
    }
}

fn map(text: &str) -> Result<ColourMap, String> {
    ColourMap::from_name(text).map_err(|error| error.to_string())
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
enum View {
    /// The shaded surface
    Surface,
    /// The inside, translucent
    Volume,
    /// Both: clip planes cut only the surface, which is translucent without any
    Hybrid,
    /// A plane through it, with its cells and what they are
    Slice,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Edges {
    /// Where faces meet at more than 30 degrees
    Features,
    /// Those of all triangles
    All,
}

/// What is shown.
enum Subject {
    /// With what it was made of, if that is known.
    Octree(Box<Octree>, Option<Box<AnySolid>>),
    Mesh(Box<TriangleMesh>),
    Solid(Box<AnySolid>, Frame),
}

impl Subject {
    fn of(shape: Shape, input: &Input, arguments: &Arguments) -> Result<Subject, Failure> {
        let of_cells = matches!(arguments.view, View::Volume | View::Hybrid | View::Slice);
        match shape {
            Shape::Dexels(model) if of_cells || arguments.faces => {
                let octree = octree_of_dexels(model.view(), &Control::default()).of(input)?;
                Ok(Subject::Octree(Box::new(octree), None))
            }
            Shape::Dexels(model) => {
                Ok(Subject::Mesh(Box::new(dexel_surface::cubes(&model, input, arguments.threads)?.0)))
            }
            Shape::Source(Source::Octree(octree)) => Ok(Subject::Octree(octree, None)),
            Shape::Source(Source::Mesh(mesh, ..)) if !of_cells && !arguments.faces => {
                Ok(Subject::Mesh(Box::new(mesh)))
            }
            Shape::Source(source) => {
                let frame = source.frame(input, Some(arguments.depth))?;
                let solid = source.placed(input, &Affine::IDENTITY, &frame)?;
                if !of_cells && !arguments.faces {
                    return Ok(Subject::Solid(Box::new(solid), frame));
                }
                let octree = watched("render", arguments.threads, |control| {
                    build(&solid, &frame, Rule::Certified, control)
                });
                Ok(Subject::Octree(Box::new(octree.of(input)?), Some(Box::new(solid))))
            }
        }
    }

    /// Points that whoever sees sees all of it: corners of coarse cells around it, those of the universe if it is empty.
    fn points(&self, control: &Control<'_>) -> Result<Vec<[f64; 3]>, leafless::Error> {
        let coarse = |octree: &Octree| {
            let frame = *octree.frame();
            let finest = COARSE.min(frame.depth());
            let leaves = octree.view().cells(CellFilter::tags(&[Tag::Full, Tag::Partial]).levels(0..=finest));
            let cut = octree.view().cells(CellFilter::tags(&[Tag::Branch]).levels(finest..=finest));
            let mut points = Vec::new();
            for found in leaves.chain(cut) {
                let (min, max) = Cube { frame: &frame, cell: found.cell }.bounds();
                points.extend(Bounds { min, max }.corners());
            }
            if points.is_empty() {
                points.extend(Bounds::of(&frame).corners());
            }
            points
        };
        match self {
            Subject::Octree(octree, _) => Ok(coarse(octree)),
            Subject::Mesh(mesh) => Ok(mesh.vertices().to_vec()),
            Subject::Solid(solid, frame) => {
                Ok(coarse(&build(&**solid, &frame.with_depth(COARSE)?, Rule::Certified, control)?))
            }
        }
    }
}

/// Level of the cells that a camera is fitted to.
const COARSE: u8 = 6;

/// Levels of cells of what has none of its own.
const DEPTH: u8 = 8;

/// What is told of a picture.
#[derive(Serialize)]
struct Made {
    width: u32,
    height: u32,
    samples: u32,
    view: View,
    eye: [f64; 3],
    forward: [f64; 3],
    /// Pixels where something is seen.
    covered: usize,
    bytes: usize,
    seconds: f64,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let start = Instant::now();
    let (input, output) = (Input::from(&*arguments.input), Output::from(&*arguments.output));
    output.check()?;
    let shape = Shape::read(&input, &arguments.reading, &arguments.drawing)?.0;
    let subject = Subject::of(shape, &input, arguments)?;
    let channel = match &subject {
        Subject::Octree(octree, _) if arguments.channel.is_some() || octree.channels().len() == 1 => {
            Some(channel::find(octree, &input, arguments.channel.as_deref())?)
        }
        _ if arguments.channel.is_some() => {
            return Err(Failure::of(&input, "has no channels to show in this view"));
        }
        _ => None,
    };
    let (shot, picture) = watched("render", arguments.threads, |control| {
        let shot = shot(arguments, &subject, channel, control)?;
        let picture = picture(arguments, &subject, channel, &shot, control)?;
        Ok((shot, picture))
    })
    .of(&input)?;
    let bytes = exchange::write_png(&picture).of(&output)?;
    match output.path() {
        Some(path) => output::write_file(path, &bytes)?,
        None => output::print(&bytes)?,
    }
    let made = Made {
        width: picture.width(),
        height: picture.height(),
        samples: shot.samples,
        view: arguments.view,
        eye: shot.camera.eye(),
        forward: shot.camera.forward(),
        covered: picture.colours().iter().filter(|&&colour| colour != shot.background).count(),
        bytes: bytes.len(),
        seconds: start.elapsed().as_secs_f64(),
    };
    if arguments.json {
        return output.report(&json(&made)?);
    }
    let Made { width, height, covered, .. } = made;
    let share = 100.0 * covered as f64 / (f64::from(width) * f64::from(height));
    let bytes = count(made.bytes as u64);
    let time = seconds(made.seconds);
    output.report(&format!(
        "{output}: {width} x {height} pixels, {share:.0} % covered, {bytes} bytes; {time}\n"
    ))
}

fn shot(
    arguments: &Arguments,
    subject: &Subject,
    channel: Option<&Channel>,
    control: &Control<'_>,
) -> Result<Shot, leafless::Error> {
    let [width, height] = arguments.size;
    let mut clip = Clip::new();
    for &plane in &arguments.clip {
        clip = clip.plane(plane)?;
    }
    let mut points = subject.points(&Control { progress: None, ..*control })?;
    if let Some([x0, y0, z0, x1, y1, z1]) = arguments.clip_box {
        let problem = "the lower corner must not be above the upper one";
        let kept = Bounds::new([x0, y0, z0], [x1, y1, z1])
            .ok_or(leafless::Error::Argument { name: "clip-box", problem })?;
        clip = clip.within(&kept)?;
        let clamped =
            |point: [f64; 3]| [0, 1, 2].map(|axis| point[axis].clamp(kept.min[axis], kept.max[axis]));
        points = points.into_iter().map(clamped).collect();
    }
    let is_slice = arguments.view == View::Slice && arguments.from.is_none();
    let field = (!arguments.ortho && !is_slice).then_some(arguments.fov);
    let camera = match arguments.eye {
        None => {
            let from = arguments.from.unwrap_or(match arguments.plane {
                Some([a, b, c, _]) if is_slice => {
                    [a.atan2(-b).to_degrees(), c.atan2(a.hypot(b)).to_degrees()]
                }
                None if is_slice => [0.0, 0.0],
                _ => [30.0, 25.0],
            });
            // A legend lies at the right side.
            let is_clear = arguments.no_legend || arguments.view != View::Slice && channel.is_none();
            let free = if is_clear { 1.0 } else { LEGEND_FREE };
            Camera::fitted(&points, from, field, free * f64::from(width) / f64::from(height))?
        }
        Some(eye) => {
            let at = arguments.at.unwrap_or(middle(&points));
            let along = [0, 1, 2].map(|axis| at[axis] - eye[axis]);
            let is_upright = along[0].hypot(along[1]) < 1e-6 * along[2].abs();
            let up = arguments.up.unwrap_or(if is_upright { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] });
            let distance = along.iter().map(|c| c * c).sum::<f64>().sqrt();
            // As high as what a perspective shows at the distance of what it looks at.
            let parallel = 2.0 * distance * (0.5 * FIELD_OF_VIEW.to_radians()).tan();
            Camera::new(eye, at, up, field.map_or(Lens::Parallel(parallel), Lens::Perspective))?
        }
    };
    let Arguments { samples, background, .. } = *arguments;
    Ok(Shot { camera, size: arguments.size, samples, clip, background })
}

/// The part of a picture's width that is left for what is shown beside a legend: it is as far from both sides.
const LEGEND_FREE: f64 = 0.72;

/// The middle of the box around points.
fn middle(points: &[[f64; 3]]) -> [f64; 3] {
    let (low, high) = extremes(points);
    [0, 1, 2].map(|axis| 0.5 * low[axis] + 0.5 * high[axis])
}

fn extremes(points: &[[f64; 3]]) -> ([f64; 3], [f64; 3]) {
    let end = |start: f64, choose: fn(f64, f64) -> f64| {
        [0, 1, 2].map(|axis| points.iter().map(|point| point[axis]).fold(start, choose))
    };
    (end(f64::INFINITY, f64::min), end(f64::NEG_INFINITY, f64::max))
}

fn picture(
    arguments: &Arguments,
    subject: &Subject,
    channel: Option<&Channel>,
    shot: &Shot,
    control: &Control<'_>,
) -> Result<Picture, leafless::Error> {
    match (subject, arguments.view) {
        (Subject::Octree(octree, source), View::Volume) => {
            volume(arguments, octree, source.as_deref(), channel, shot, &[], control)
        }
        (Subject::Octree(octree, source), View::Hybrid) => {
            hybrid(arguments, octree, source.as_deref(), channel, shot, control)
        }
        (Subject::Octree(octree, _), View::Slice) => slice(arguments, octree, channel, shot, control),
        _ => surface(arguments, subject, channel, shot, control),
    }
}

fn surface(
    arguments: &Arguments,
    subject: &Subject,
    channel: Option<&Channel>,
    shot: &Shot,
    control: &Control<'_>,
) -> Result<Picture, leafless::Error> {
    let plain = Finish::default();
    let finish = Finish { faces: arguments.faces, colour: arguments.colour.unwrap_or(plain.colour), ..plain };
    match subject {
        Subject::Octree(octree, _) => {
            let layer = OctreeLayer::new(octree.view(), finish);
            let Some(channel) = channel else { return render(shot, &[&layer], control) };
            let transfer = transfer(arguments, octree, Some(channel), control)?;
            let components = channel.value_type().components();
            let colour = |value: Option<[f64; 4]>| value_colour(&transfer, components, value);
            let mut picture = render(shot, &[&layer.values(channel, &colour)], control)?;
            bar(arguments, &mut picture, channel, &transfer)?;
            Ok(picture)
        }
        Subject::Solid(solid, frame) => render(shot, &[&SolidLayer::new(&**solid, frame, finish)], control),
        Subject::Mesh(mesh) => {
            let (edges, width) = match arguments.edges {
                None => (MeshEdges::None, 1.0),
                Some(Edges::Features) => (MeshEdges::Features, 1.5),
                Some(Edges::All) => (MeshEdges::All, 0.75),
            };
            let layer =
                MeshLayer::new(mesh).colour(finish.colour).inside(finish.cut).edges(edges, width, INK);
            render(shot, &[&layer], control)
        }
    }
}

/// The colour of lines.
const INK: [u8; 4] = [35, 40, 45, 255];

/// What values look like: for a solid without a channel, all the same.
fn transfer(
    arguments: &Arguments,
    octree: &Octree,
    channel: Option<&Channel>,
    control: &Control<'_>,
) -> Result<Transfer, leafless::Error> {
    let range = match (arguments.range, channel) {
        (Some(range), _) => range,
        (None, Some(channel)) => {
            let control = Control { progress: None, ..*control };
            let found = channel.view()?.summary(Some(octree.view()), None, &control)?;
            match found.map(|found| (found.least[0], found.greatest[0])) {
                Some((low, high)) if low < high => [low, high],
                Some((low, _)) => [low, low + 1.0],
                None => [0.0, 1.0],
            }
        }
        (None, None) => [0.0, 1.0],
    };
    let extent = bounding_box(octree.view(), octree.frame(), 0.0, &Control { progress: None, ..*control })?;
    let longest = extent.corners.map_or(octree.frame().edge(), |[min, max]| {
        (0..3).map(|axis| max[axis].upper - min[axis].lower).fold(0.0, f64::max)
    });
    Transfer::new(arguments.map, range, arguments.opacity, longest)
}

/// The voxels of an octree, with surfaces before and between them.
fn volume(
    arguments: &Arguments,
    octree: &Octree,
    source: Option<&AnySolid>,
    channel: Option<&Channel>,
    shot: &Shot,
    surfaces: &[&dyn Layer],
    control: &Control<'_>,
) -> Result<Picture, leafless::Error> {
    let transfer = transfer(arguments, octree, channel, control)?;
    let attribute = channel.map(|channel| channel as &dyn Attribute);
    let mut options = VoxelOptions::new();
    if let Some(channel) = channel {
        // Voxels as large as the channel's values allow.
        let fine = channel.frame().cell_size().min(octree.frame().cell_size());
        let [low, high] = transfer.range();
        let tolerance = (high - low) / 64.0;
        options = options.detail(Detail::new(octree.frame().edge(), fine, tolerance, Criterion::Range)?);
    }
    let quiet = Control { progress: None, ..*control };
    let records = VoxelRecords::of(octree.view(), &options, attribute, &quiet)?;
    let compositing = match arguments.published {
        true => Compositing::Published { unit: octree.frame().cell_size() },
        false => Compositing::Exact,
    };
    // Undecided cells weigh what of them is solid, where that can be known.
    let weights = source.map(|source| records.view().solid_parts(source, &quiet)).transpose()?;
    let mut layer = VolumeLayer::new(records.view(), transfer).compositing(compositing)?;
    if let Some(weights) = &weights {
        layer = layer.weights(weights)?;
    }
    let mut layers = surfaces.to_vec();
    layers.push(&layer);
    let mut picture = render(shot, &layers, control)?;
    if let Some(channel) = channel {
        bar(arguments, &mut picture, channel, &transfer)?;
    }
    Ok(picture)
}

/// The colour of a value on a surface.
fn value_colour(transfer: &Transfer, components: usize, value: Option<[f64; 4]>) -> [u8; 4] {
    let value = value.unwrap_or([f64::NAN; 4]);
    let [r, g, b] = transfer.colour(&value[..components]);
    [r, g, b, 255]
}

/// The legend of a channel of one number.
fn bar(
    arguments: &Arguments,
    picture: &mut Picture,
    channel: &Channel,
    transfer: &Transfer,
) -> Result<(), leafless::Error> {
    if !arguments.no_legend && channel.value_type().components() == 1 {
        let colour = |value: f64| {
            let [r, g, b] = transfer.colour(&[value]);
            [r, g, b, 255]
        };
        draw_colour_bar(picture, channel.name(), transfer.range(), &colour, LegendSide::Right)?;
    }
    Ok(())
}

fn hybrid(
    arguments: &Arguments,
    octree: &Octree,
    source: Option<&AnySolid>,
    channel: Option<&Channel>,
    shot: &Shot,
    control: &Control<'_>,
) -> Result<Picture, leafless::Error> {
    let quiet = Control { progress: None, ..*control };
    let mesh = marching_cubes(octree.view(), Some(Resolve::Outer), &quiet)?;
    let mut colour = arguments.colour.unwrap_or(Finish::default().colour);
    if shot.clip.is_empty() && arguments.colour.is_none() {
        colour[3] = 70;
    }
    let skin = MeshLayer::new(&mesh).colour(colour).inside(colour);
    // Clip planes cut the skin away, and show what is behind it.
    let cut = ClippedLayer::new(&skin, shot.clip.clone());
    let whole = Shot { clip: Clip::new(), ..shot.clone() };
    volume(arguments, octree, source, channel, &whole, &[&cut], control)
}

fn slice(
    arguments: &Arguments,
    octree: &Octree,
    channel: Option<&Channel>,
    shot: &Shot,
    control: &Control<'_>,
) -> Result<Picture, leafless::Error> {
    let plane = match arguments.plane {
        Some([a, b, c, d]) => SlicePlane::new([a, b, c], d)?,
        None => {
            let forward = shot.camera.forward();
            let axis = (0..3).max_by(|&i, &j| forward[i].abs().total_cmp(&forward[j].abs())).unwrap_or(2);
            let frame = octree.frame();
            // Half a cell beside the middle, which is a plane of the lattice.
            let middle = frame.origin()[axis] + 0.5 * frame.edge() + 0.5 * frame.cell_size();
            SlicePlane::across(axis, middle)?
        }
    };
    let layer = SliceLayer::new(octree.view(), plane);
    let Some(channel) = channel else {
        let mut picture = render(shot, &[&layer], control)?;
        if !arguments.no_legend {
            let names = [("EMPTY", TAG_COLOURS[0]), ("FULL", TAG_COLOURS[1]), ("PARTIAL", TAG_COLOURS[2])];
            draw_names(&mut picture, "", &names, LegendSide::Right);
        }
        return Ok(picture);
    };
    let transfer = transfer(arguments, octree, Some(channel), control)?;
    let components = channel.value_type().components();
    let colour = |value: Option<[f64; 4]>| value_colour(&transfer, components, value);
    let layer = layer.values(channel, &colour);
    let mut picture = render(shot, &[&layer], control)?;
    bar(arguments, &mut picture, channel, &transfer)?;
    Ok(picture)
}
