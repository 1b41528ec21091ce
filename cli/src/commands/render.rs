//! `leafless render`: pictures.

use crate::failure::{Failure, Of};
use crate::making::clipped::Planes;
use crate::making::picture::{Looks, Subject, Values, View, colour, facing, legend_boxes, numbers, picture};
use crate::options::threads;
use crate::progress::watched;
use crate::show::{Protocol, Screen};
use crate::sink::{Output, json};
use crate::source::file::Taking;
use crate::source::input::Input;
use crate::source::solid::Shape;
use crate::source::values::find;
use crate::words::{count, seconds};
use clap::Args;
use leafless::lattice::MAX_DEPTH;
use leafless::render::{Camera, Clip, FIELD_OF_VIEW, LegendBox, Lens, Shot, write_png};
use leafless::{Bounds, Control};
use serde::Serialize;
use std::ffi::OsString;
use std::time::Instant;

/// Makes a picture (PNG) of a solid, a mesh, a scene, a volume or a tri-dexel model, or shows it on the
/// terminal.
///
/// A solid from a file is shown with the surface that its cells suggest; with --faces the cells themselves
/// are shown. A mesh, a scene, a volume, and a solid from a file whose cells keep surfaces are shown
/// directly, without an octree. A tri-dexel model that stores materials is shown by its cells, in the colours
/// of the channel `material`.
///
/// --clip and --clip-box cut parts away, and the camera fits what is left. Cut faces show the inside in
/// orange. So do those of a closed mesh, unless --edges all shows its triangles.
///
/// A slice is seen along its plane's normal. Beside it are its scale and the extents of the whole solid along
/// x, y and z.
#[derive(Args)]
pub struct Arguments {
    /// Solid or tri-dexel model (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD,
    /// MetaImage), or `-` for standard input
    #[arg(value_name = "FILE")]
    input: OsString,
    /// PNG file to write, or `-` for standard output; written completely or not at all
    #[arg(short, long, value_name = "OUT", required_unless_present = "show")]
    output: Option<OsString>,
    /// Show the picture on the terminal, smaller if it does not fit. Without a protocol: the best one that
    /// the terminal understands. With a protocol, standard output need not be a terminal: the picture is then
    /// not made smaller, or, as half blocks, made for 80x24 cells or COLUMNS x LINES
    #[arg(long, value_enum, value_name = "PROTOCOL", num_args = 0..=1, require_equals = true,
          default_missing_value = "auto", conflicts_with = "json")]
    show: Option<Protocol>,
    /// Width and height in pixels [default: 1024x768; only shown: what fits the terminal]
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u32; 2]>,
    #[command(flatten)]
    looks: Looks,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Direction to look from, in degrees: 0,0 is from the front (−y) with z upward; a positive azimuth is
    /// further right, a positive elevation further above [default: 30,25; for a slice, perpendicular to its
    /// plane]
    #[arg(long, value_name = "AZIMUTH,ELEVATION", value_parser = numbers::<2>, allow_hyphen_values = true,
          conflicts_with = "eye", help_heading = "Camera")]
    from: Option<[f64; 2]>,
    /// Parallel projection: parallel lines stay parallel
    #[arg(long, conflicts_with = "fov", help_heading = "Camera")]
    ortho: bool,
    /// Position of the eye, instead of --from
    #[arg(long, value_name = "X,Y,Z", value_parser = numbers::<3>, allow_hyphen_values = true, help_heading = "Camera")]
    eye: Option<[f64; 3]>,
    /// Point that the eye looks at [default: the middle]
    #[arg(long, value_name = "X,Y,Z", value_parser = numbers::<3>, allow_hyphen_values = true, requires = "eye", help_heading = "Camera")]
    at: Option<[f64; 3]>,
    /// Upward direction [default: 0,0,1; 0,1,0 if the view is along z]
    #[arg(long, value_name = "X,Y,Z", value_parser = numbers::<3>, allow_hyphen_values = true, requires = "eye", help_heading = "Camera")]
    up: Option<[f64; 3]>,
    /// Field of view from the lower to the upper edge, in degrees
    #[arg(long, value_name = "DEGREES", default_value_t = FIELD_OF_VIEW, help_heading = "Camera")]
    fov: f64,
    /// Cut away the points x, y, z with a x + b y + c z + d < 0. May be given several times
    #[arg(long, value_name = "A,B,C,D", value_parser = numbers::<4>, allow_hyphen_values = true, help_heading = "Slices and cuts")]
    clip: Vec<[f64; 4]>,
    /// Cut away everything outside this box
    #[arg(long, value_name = "X0,Y0,Z0,X1,Y1,Z1", value_parser = numbers::<6>, allow_hyphen_values = true, help_heading = "Slices and cuts")]
    clip_box: Option<[f64; 6]>,
    /// Channel of the solid whose values are shown [default: the only one, if there is one]
    #[arg(long, value_name = "NAME", help_heading = "Colours and values")]
    channel: Option<String>,
    /// Colour of the background, such as #ffffff, or `none`
    #[arg(long, value_name = "COLOUR", default_value = "#ffffff", value_parser = colour, help_heading = "Colours and values")]
    background: [u8; 4],
    /// Level to which cells are split for a slice, a volume or --faces, 1 to 20. Applies to a mesh, a scene,
    /// a volume, and a solid from a file whose cells keep surfaces
    #[arg(long, value_name = "N", default_value_t = DEPTH, value_parser = clap::value_parser!(u8).range(1..=MAX_DEPTH as i64))]
    depth: u8,
    /// Samples for each pixel: 1, 4, 9, 16, 25, 36, 49 or 64
    #[arg(id = "per_pixel", long = "samples", value_name = "N", default_value_t = 4)]
    samples: u32,
    /// Threads to use, 0 to 1024; 0: one for each processor. The picture does not depend on it
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    threads: usize,
    #[command(flatten)]
    taking: Taking,
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    let good = |sides: &[u32; 2]| sides.iter().all(|side| (1..=16384).contains(side));
    sides.filter(good).ok_or_else(|| "expected width and height, 1 to 16384 each, as in 800x600".into())
}

/// Width and height of a picture that goes to a file.
const SIZE: [u32; 2] = [1024, 768];

/// Levels of cells of shapes without cells.
const DEPTH: u8 = 8;

/// The report on a picture.
#[derive(Serialize)]
struct Made {
    width: u32,
    height: u32,
    samples: u32,
    view: View,
    eye: [f64; 3],
    forward: [f64; 3],
    /// Number of pixels that differ from the background, including those of a legend.
    covered: usize,
    bytes: usize,
    seconds: f64,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let start = Instant::now();
    let input = Input::from(&*arguments.input);
    let output = arguments.output.as_deref().map(Output::from);
    if let Some(output) = &output {
        if arguments.show.is_some() && output.path().is_none() {
            let problem = "both -o - and --show use standard output: name a file, or leave one of them out";
            return Err(Failure::Usage(problem.into()));
        }
        check_name(output)?;
        output.check()?;
    }
    arguments.looks.check()?;
    // Before any work: the picture may depend on the terminal, which may be missing.
    let screen = arguments.show.map(Screen::of).transpose()?;
    let shown_size = screen.as_ref().filter(|_| output.is_none()).and_then(Screen::size);
    let size = arguments.size.or(shown_size).unwrap_or(SIZE);
    let shape = Shape::read(&input, &arguments.taking)?.0;
    let is_cut = !arguments.clip.is_empty() || arguments.clip_box.is_some();
    let subject = Subject::of(shape, &input, &arguments.looks, arguments.depth, is_cut, arguments.threads)?;
    subject.note_undecided(&input, &arguments.looks);
    let channel = match subject.octree() {
        Some(octree) if arguments.channel.is_some() || octree.channels().len() == 1 => {
            Some(find(octree, &input, arguments.channel.as_deref())?)
        }
        _ if arguments.channel.is_some() => {
            return Err(Failure::of(&input, "has no channels to show in this view"));
        }
        _ => None,
    };
    let looks = &arguments.looks;
    let (shot, picture) = watched("render", arguments.threads, |control| {
        let values = match (subject.octree(), channel) {
            (Some(octree), Some(channel)) => Some(Values::new(looks, octree, channel, control)?),
            _ => None,
        };
        let legends = legend_boxes(looks, &subject, values.as_ref(), size)?;
        let shot = shot(arguments, size, &subject, legends, control)?;
        let picture = picture(looks, &subject, values.as_ref(), &shot, control)?;
        Ok((shot, picture))
    })
    .of(&input)?;
    let bytes = write_png(&picture).of(&input)?;
    if let Some(output) = &output {
        output.write(&bytes)?;
    }
    if let Some(screen) = &screen {
        screen.show(&picture, &bytes)?;
    }
    let made = Made {
        width: picture.width(),
        height: picture.height(),
        samples: shot.samples,
        view: arguments.looks.view,
        eye: shot.camera.eye(),
        forward: shot.camera.forward(),
        covered: picture.colours().iter().filter(|&&colour| colour != shot.background).count(),
        bytes: bytes.len(),
        seconds: start.elapsed().as_secs_f64(),
    };
    // If the picture is shown, standard output carries it.
    let told = output.as_ref().filter(|_| screen.is_none()).unwrap_or(&Output::Standard);
    if arguments.json {
        return told.report(&json(&made)?);
    }
    let Made { width, height, covered, .. } = made;
    let share = 100.0 * covered as f64 / (f64::from(width) * f64::from(height));
    let what = format!("{width} x {height} pixels, {share:.0} % covered");
    let bytes = count(made.bytes as u64);
    let time = seconds(made.seconds);
    told.report(&match (&output, &screen) {
        (Some(output), None) => format!("{output}: {what}, {bytes} bytes; {time}\n"),
        (Some(output), Some(screen)) => {
            format!("{output}: {what}, {bytes} bytes, shown {}; {time}\n", screen.way())
        }
        (None, screen) => {
            let way = screen.as_ref().map_or("", Screen::way);
            format!("{input}: {what}, shown {way}; {time}\n")
        }
    })
}

/// Refuses a name with another extension than .png: pictures are PNG files.
fn check_name(output: &Output) -> Result<(), Failure> {
    match output.path().and_then(|path| path.extension()) {
        Some(extension) if !extension.eq_ignore_ascii_case("png") => {
            let problem = "a picture is written as PNG: choose a name that ends in .png";
            Err(Failure::Usage(format!("{output}: {problem}")))
        }
        _ => Ok(()),
    }
}

fn shot(
    arguments: &Arguments,
    size: [u32; 2],
    subject: &Subject,
    [legend, scale]: [Option<LegendBox>; 2],
    control: &Control<'_>,
) -> Result<Shot, leafless::Error> {
    let [width, height] = size;
    let mut clip = Clip::new();
    for &plane in &arguments.clip {
        clip = clip.plane(plane)?;
    }
    let looks = &arguments.looks;
    let mut kept = None;
    if let Some([x0, y0, z0, x1, y1, z1]) = arguments.clip_box {
        let problem = "the lower corner must not be above the upper one";
        let bounds = Bounds::new([x0, y0, z0], [x1, y1, z1])
            .ok_or(leafless::Error::Argument { name: "clip-box", problem })?;
        clip = clip.within(&bounds)?;
        kept = Some(bounds);
    }
    let planes = match looks.view {
        // The volume is not cut.
        View::Hybrid => Planes::default(),
        _ => Planes::new(&arguments.clip, kept.as_ref()),
    };
    let points = subject.points(&planes, &Control { progress: None, ..*control })?;
    let is_slice = looks.view == View::Slice && arguments.from.is_none() && arguments.eye.is_none();
    let field = (!arguments.ortho && !is_slice).then_some(arguments.fov);
    let camera = match arguments.eye {
        None => {
            let from = arguments.from.unwrap_or(match looks.plane {
                Some([a, b, c, _]) if is_slice => facing([a, b, c]),
                None if is_slice => [0.0, 0.0],
                _ => [30.0, 25.0],
            });
            // The margins on both sides are as wide as the legend.
            let free = |end: u32, side: u32| (2.0 * f64::from(end) / f64::from(side) - 1.0).max(LEAST_FREE);
            let across = legend.map_or(1.0, |[left, ..]| free(left, width));
            let upward = scale.filter(|_| is_slice).map_or(1.0, |[_, top, ..]| free(top, height));
            let aspect = across * f64::from(width) / (upward * f64::from(height));
            let camera = Camera::fitted(&points, from, field, aspect)?;
            match camera.lens() {
                Lens::Parallel(high) => {
                    let (eye, forward) = (camera.eye(), camera.forward());
                    let at = [0, 1, 2].map(|axis| eye[axis] + forward[axis] * high);
                    Camera::new(eye, at, camera.up(), Lens::Parallel(high / upward))?
                }
                Lens::Perspective(_) => camera,
            }
        }
        Some(eye) => {
            let at = arguments.at.unwrap_or(middle(&points));
            let along = [0, 1, 2].map(|axis| at[axis] - eye[axis]);
            let is_upright = along[0].hypot(along[1]) < 1e-6 * along[2].abs();
            let up = arguments.up.unwrap_or(if is_upright { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] });
            let distance = along.iter().map(|c| c * c).sum::<f64>().sqrt();
            // The height that a perspective shows at the distance of the point that the eye looks at.
            let parallel = 2.0 * distance * (0.5 * FIELD_OF_VIEW.to_radians()).tan();
            Camera::new(eye, at, up, field.map_or(Lens::Parallel(parallel), Lens::Perspective))?
        }
    };
    let Arguments { samples, background, .. } = *arguments;
    Ok(Shot { camera, size, samples, clip, background })
}

/// The least part of a picture's width or height that a legend leaves free.
const LEAST_FREE: f64 = 0.3;

/// Returns the middle of the box around points.
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
