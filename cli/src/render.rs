//! `leafless render`: what does it look like?

use crate::failure::{Failure, Of};
use crate::input::Input;
use crate::mesh::Reading;
use crate::output::{self, Output, count, json, seconds};
use crate::progress::watched;
use crate::scene::Drawing;
use crate::shape::Shape;
use crate::source::Source;
use crate::voxelize::threads;
use clap::Args;
use leafless::{
    Affine, AnySolid, Bounds, Camera, CellFilter, Clip, Control, Cube, FIELD_OF_VIEW, Finish, Frame, Layer,
    Lens, Octree, OctreeLayer, Picture, Rule, Shot, SolidLayer, Tag, build, exchange, octree_of_dexels,
    render,
};
use serde::Serialize;
use std::ffi::OsString;
use std::time::Instant;

/// Makes a picture (PNG) of a solid, a mesh, a scene, a volume or a tri-dexel model.
///
/// A solid from a file is shown as its cells make its surface likely to be; with --faces, as its cells are. A mesh, a scene or
/// a volume is shown itself, without an octree.
#[derive(Args)]
pub struct Arguments {
    /// Solid or tri-dexel model (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD, MetaImage), or `-` for
    /// standard input
    #[arg(value_name = "FILE")]
    input: OsString,
    /// File to write (PNG), or `-` for standard output; it is written whole or not at all
    #[arg(short, long, value_name = "OUT")]
    output: OsString,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = size)]
    size: [u32; 2],
    /// From where to look, in degrees: 0,0 is from the front (−y) with z upward, a positive azimuth from further right, a
    /// positive elevation from further above
    #[arg(long, value_name = "AZIMUTH,ELEVATION", default_value = "30,25", value_parser = numbers::<2>,
          allow_hyphen_values = true)]
    from: [f64; 2],
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
    #[arg(long, value_name = "N", default_value_t = 4)]
    samples: u32,
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

/// What is shown.
enum Subject {
    Octree(Box<Octree>),
    Solid(Box<AnySolid>, Frame),
}

impl Subject {
    fn of(shape: Shape, input: &Input) -> Result<Subject, Failure> {
        match shape {
            Shape::Dexels(model) => {
                let octree = octree_of_dexels(model.view(), &Control::default()).of(input)?;
                Ok(Subject::Octree(Box::new(octree)))
            }
            Shape::Source(Source::Octree(octree)) => Ok(Subject::Octree(octree)),
            Shape::Source(source) => {
                let frame = source.frame(input, Some(DEPTH))?;
                Ok(Subject::Solid(Box::new(source.placed(input, &Affine::IDENTITY, &frame)?), frame))
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
                points.extend(corners(min, max));
            }
            if points.is_empty() {
                let bounds = Bounds::of(&frame);
                points.extend(corners(bounds.min, bounds.max));
            }
            points
        };
        match self {
            Subject::Octree(octree) => Ok(coarse(octree)),
            Subject::Solid(solid, frame) => {
                Ok(coarse(&build(&**solid, &frame.with_depth(COARSE)?, Rule::Certified, control)?))
            }
        }
    }
}

fn corners(min: [f64; 3], max: [f64; 3]) -> impl Iterator<Item = [f64; 3]> {
    (0..8).map(move |k| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { min[axis] } else { max[axis] }))
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
    view: &'static str,
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
    let subject = Subject::of(shape, &input)?;
    let (shot, picture) = watched("render", arguments.threads, |control| {
        let shot = shot(arguments, &subject, control)?;
        let picture = picture(arguments, &subject, &shot, control)?;
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
        view: "surface",
        eye: shot.camera.eye(),
        forward: shot.camera.forward(),
        covered: picture.depths().iter().filter(|depth| depth.is_finite()).count(),
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

fn shot(arguments: &Arguments, subject: &Subject, control: &Control<'_>) -> Result<Shot, leafless::Error> {
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
    let field = (!arguments.ortho).then_some(arguments.fov);
    let camera = match arguments.eye {
        None => Camera::fitted(&points, arguments.from, field, f64::from(width) / f64::from(height))?,
        Some(eye) => {
            let middle = [0, 1, 2].map(|axis| {
                let at = points.iter().map(|point| point[axis]);
                0.5 * at.clone().fold(f64::INFINITY, f64::min) + 0.5 * at.fold(f64::NEG_INFINITY, f64::max)
            });
            let at = arguments.at.unwrap_or(middle);
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

fn picture(
    arguments: &Arguments,
    subject: &Subject,
    shot: &Shot,
    control: &Control<'_>,
) -> Result<Picture, leafless::Error> {
    let mut finish = Finish { faces: arguments.faces, ..Finish::default() };
    if let Some(colour) = arguments.colour {
        finish.colour = colour;
    }
    match subject {
        Subject::Octree(octree) => {
            let layer = OctreeLayer::new(octree.view(), finish);
            render(shot, &[&layer as &dyn Layer], control)
        }
        Subject::Solid(solid, frame) => {
            let layer = SolidLayer::new(&**solid, frame, finish);
            render(shot, &[&layer as &dyn Layer], control)
        }
    }
}
