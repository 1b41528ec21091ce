//! What pictures show: solids, meshes and volumes, in each view.

use crate::failure::{Failure, Of};
use crate::making::dexel_surface;
use crate::options;
use crate::progress::watched;
use crate::source::input::Input;
use crate::source::solid::{Shape, Source, cells_of};
use clap::{Args, ValueEnum};
use leafless::attribute::{Attribute, Channel, Criterion, Detail};
use leafless::error::MeshError;
use leafless::lattice::Cube;
use leafless::octree::CellFilter;
use leafless::op::{DexelOptions, octree_from_dexels};
use leafless::render::{
    Clip, ClippedLayer, ColourMap, Compositing, Finish, Layer, LegendBox, LegendSide, MeshEdges, MeshLayer,
    OctreeLayer, Outline, Picture, Shot, SliceLayer, SlicePlane, SolidLayer, TAG_COLOURS, Transfer,
    VolumeLayer, draw_colour_bar, draw_names, render,
};
use leafless::surface::{Resolve, VertexPlacement, marching_cubes_dexels, marching_cubes_solid};
use leafless::voxel::{VoxelOptions, VoxelRecords};
use leafless::{
    Affine, AnySolid, Bounds, Control, Error, Frame, Octree, Rule, Tag, TriangleMesh, bounding_box, build,
    dexelize, marching_cubes,
};
use serde::Serialize;

/// What is shown, and in which colours.
#[derive(Args)]
pub struct Looks {
    /// What to show
    #[arg(long, value_enum, default_value_t = View::Surface)]
    pub view: View,
    /// Plane of the slice: the points x, y, z with a x + b y + c z + d = 0. Without it: the one through the middle that is
    /// seen best of those along the axes
    #[arg(long, value_name = "A,B,C,D", value_parser = numbers::<4>, allow_hyphen_values = true)]
    pub plane: Option<[f64; 4]>,
    /// Colours of values: viridis, cividis, inferno, magma, plasma or grey
    #[arg(long, value_name = "NAME", default_value = "viridis", value_parser = map)]
    map: ColourMap,
    /// Values at both ends of the colours. Without it: the least and the greatest
    #[arg(long, value_name = "A,B", value_parser = numbers::<2>, allow_hyphen_values = true)]
    range: Option<[f64; 2]>,
    /// Opacity of a volume as thick as the solid's longest side, 0 to 1
    #[arg(long, value_name = "ALPHA", default_value_t = 0.95, value_parser = share)]
    opacity: f64,
    /// Show voxels as published: of an edge of k finest voxels as k layers, wherever a line of sight crosses them
    #[arg(long)]
    published: bool,
    /// Draw edges: those at which faces meet at more than 30 degrees, or of a mesh those of all its triangles
    #[arg(long, value_enum, value_name = "WHICH", num_args = 0..=1, default_missing_value = "features")]
    edges: Option<Edges>,
    /// Leave out the legend
    #[arg(long)]
    pub no_legend: bool,
    /// Show the cells of a solid by their faces
    #[arg(long)]
    faces: bool,
    /// Colour of the surface, as in #b2bbc4
    #[arg(long, value_name = "COLOUR", value_parser = colour)]
    colour: Option<[u8; 4]>,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum View {
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
    /// Those of all triangles, fainter where these are seen small
    All,
}

impl Looks {
    /// Refuses options that say nothing in the view.
    pub fn check(&self) -> Result<(), Failure> {
        let (view, is_surface) = (self.view, self.view == View::Surface);
        for (is_misplaced, option, of) in [
            (self.plane.is_some() && view != View::Slice, "--plane", "slice"),
            (self.faces && !is_surface, "--faces", "surface"),
            (self.edges.is_some() && !is_surface, "--edges", "surface"),
        ] {
            if is_misplaced {
                return Err(Failure::Usage(format!("{option} is for --view {of}")));
            }
        }
        Ok(())
    }
}

pub fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let numbers = options::numbers(text).filter(|numbers: &[f64; N]| numbers.iter().all(|x| x.is_finite()));
    numbers.ok_or_else(|| format!("expected {N} numbers with commas between"))
}

pub fn colour(text: &str) -> Result<[u8; 4], String> {
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

fn share(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(share) if (0.0..=1.0).contains(&share) => Ok(share),
        _ => Err("expected a number from 0 to 1".into()),
    }
}

fn map(text: &str) -> Result<ColourMap, String> {
    ColourMap::from_name(text).map_err(|error| error.to_string())
}

/// What is shown.
pub enum Subject {
    /// With what it was made of, if that is known.
    Octree(Box<Octree>, Option<Box<AnySolid>>),
    Mesh(Box<TriangleMesh>),
    Solid(Box<AnySolid>, Frame),
}

impl Subject {
    /// What the view shows of a file; what has no cells of its own is split to `depth` where it needs them.
    pub fn of(
        shape: Shape,
        input: &Input,
        looks: &Looks,
        depth: u8,
        threads: usize,
    ) -> Result<Subject, Failure> {
        let of_cells = matches!(looks.view, View::Volume | View::Hybrid | View::Slice);
        match shape {
            Shape::Dexels(model) if of_cells || looks.faces => {
                let octree = watched("render", threads, |control| octree_from_dexels(model.view(), control));
                let octree = octree.of(input)?;
                Ok(Subject::Octree(Box::new(octree), None))
            }
            Shape::Dexels(model) => {
                Ok(Subject::Mesh(Box::new(dexel_surface::cubes(&model, input, threads)?.0)))
            }
            Shape::Source(Source::Octree(octree)) if octree.view().cuts().is_none() => {
                Ok(Subject::Octree(octree, None))
            }
            Shape::Source(Source::Mesh(mesh, ..)) if !of_cells && !looks.faces => {
                Ok(Subject::Mesh(Box::new(mesh)))
            }
            Shape::Source(source) => {
                let frame = source.frame(input, Some(depth))?;
                let solid = source.placed(input, &Affine::IDENTITY, &frame)?;
                if !of_cells && !looks.faces {
                    return Ok(Subject::Solid(Box::new(solid), frame));
                }
                let octree = watched("render", threads, |control| {
                    cells_of(&solid, solid.get::<Octree>(), &frame, control)
                });
                Ok(Subject::Octree(Box::new(octree.of(input)?), Some(Box::new(solid))))
            }
        }
    }

    /// The octree from a file whose channels may be shown.
    pub fn octree(&self) -> Option<&Octree> {
        match self {
            Subject::Octree(octree, _) => Some(octree),
            Subject::Solid(solid, _) => solid.get::<Octree>(),
            Subject::Mesh(_) => None,
        }
    }

    /// Points that whoever sees sees all of it: corners of coarse cells around it, those of the universe if it is empty.
    pub fn points(&self, control: &Control<'_>) -> Result<Vec<[f64; 3]>, Error> {
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
            Subject::Mesh(mesh) => {
                // A file may have vertices that no triangle uses.
                let mut is_used = vec![false; mesh.vertices().len()];
                mesh.triangles().iter().flatten().for_each(|&vertex| is_used[vertex as usize] = true);
                Ok(mesh.vertices().iter().zip(is_used).filter(|(_, used)| *used).map(|(at, _)| *at).collect())
            }
            Subject::Solid(solid, frame) => {
                Ok(coarse(&build(&**solid, &frame.with_depth(COARSE)?, Rule::Certified, control)?))
            }
        }
    }
}

/// Level of the cells that a camera is fitted to.
const COARSE: u8 = 6;

/// A channel, and what its values look like.
pub struct Values<'a> {
    channel: &'a Channel,
    transfer: Transfer,
}

impl<'a> Values<'a> {
    /// Those of a channel of an octree.
    pub fn new(
        looks: &Looks,
        octree: &Octree,
        channel: &'a Channel,
        control: &Control<'_>,
    ) -> Result<Values<'a>, Error> {
        Ok(Values { channel, transfer: transfer(looks, octree, Some(channel), control)? })
    }

    /// The colour of a value on a surface.
    fn colour(&self) -> impl Fn(Option<[f64; 4]>) -> [u8; 4] + use<'_, 'a> {
        let components = self.channel.value_type().components();
        move |value| self.transfer.opaque(value, components)
    }
}

/// A picture of it, with a legend.
pub fn picture(
    looks: &Looks,
    subject: &Subject,
    values: Option<&Values<'_>>,
    shot: &Shot,
    control: &Control<'_>,
) -> Result<Picture, Error> {
    let mut picture = match (subject, looks.view) {
        (Subject::Octree(octree, source), View::Volume) => {
            volume(looks, octree, source.as_deref(), values, shot, &[], control)
        }
        (Subject::Octree(octree, source), View::Hybrid) => {
            hybrid(looks, octree, source.as_deref(), values, shot, control)
        }
        (Subject::Octree(octree, _), View::Slice) => slice(looks, octree, values, shot, control),
        _ => surface(looks, subject, values, shot, control),
    }?;
    legend(looks, values, &mut picture)?;
    Ok(picture)
}

/// Where the legend of a picture of this size will lie; `None` if there is none.
pub fn legend_box(
    looks: &Looks,
    values: Option<&Values<'_>>,
    size: [u32; 2],
) -> Result<Option<LegendBox>, Error> {
    if looks.no_legend || values.is_none() && looks.view != View::Slice {
        return Ok(None);
    }
    let blank = vec![[255; 4]; size[0] as usize * size[1] as usize];
    legend(looks, values, &mut Picture::of_colours(size, blank)?)
}

/// Draws the legend on the right, and tells where it lies; `None` if there is none.
fn legend(
    looks: &Looks,
    values: Option<&Values<'_>>,
    picture: &mut Picture,
) -> Result<Option<LegendBox>, Error> {
    let (is_slice, side) = (looks.view == View::Slice, LegendSide::Right);
    match values {
        _ if looks.no_legend => Ok(None),
        // Of two numbers the first one has a colour; three are a colour themselves.
        Some(Values { channel, transfer }) if channel.value_type().components() <= 2 => {
            let colour = |value: f64| transfer.opaque(Some([value, 0.0, 0.0, 0.0]), 1);
            draw_colour_bar(picture, channel.name(), transfer.range(), &colour, side)
        }
        None if is_slice => {
            let names = [("EMPTY", TAG_COLOURS[0]), ("FULL", TAG_COLOURS[1]), ("PARTIAL", TAG_COLOURS[2])];
            Ok(draw_names(picture, "", &names, side))
        }
        _ => Ok(None),
    }
}

fn surface(
    looks: &Looks,
    subject: &Subject,
    values: Option<&Values<'_>>,
    shot: &Shot,
    control: &Control<'_>,
) -> Result<Picture, Error> {
    let plain = Finish::default();
    let edges = match (looks.edges, subject) {
        (Some(Edges::All), Subject::Octree(..) | Subject::Solid(..)) => {
            return Err(Error::Argument { name: "edges", problem: "of all triangles are for meshes" });
        }
        (edges, _) => edges.map(|_| Outline { colour: INK, ..Outline::default() }),
    };
    let finish = Finish { faces: looks.faces, colour: looks.colour.unwrap_or(plain.colour), edges, ..plain };
    match subject {
        Subject::Octree(octree, _) => {
            let layer = OctreeLayer::new(octree.view(), finish);
            let Some(values) = values else { return render(shot, &[&layer], control) };
            render(shot, &[&layer.values(values.channel, &values.colour())], control)
        }
        Subject::Solid(solid, frame) => {
            let layer = SolidLayer::new(&**solid, frame, finish);
            let Some(values) = values else { return render(shot, &[&layer], control) };
            render(shot, &[&layer.values(values.channel, &values.colour())], control)
        }
        Subject::Mesh(mesh) => {
            let (edges, width) = match looks.edges {
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
    looks: &Looks,
    octree: &Octree,
    channel: Option<&Channel>,
    control: &Control<'_>,
) -> Result<Transfer, Error> {
    let range = match (looks.range, channel) {
        (Some(range), _) => range,
        (None, Some(channel)) => {
            let control = Control { progress: None, ..*control };
            let found = channel.view()?.summary(Some(octree.view()), None, &control)?;
            match found.map(|found| (found.least[0], found.greatest[0])) {
                Some((low, high)) if low < high => [low, high],
                Some((low, _)) => [low, low + low.abs().max(1.0)],
                None => [0.0, 1.0],
            }
        }
        (None, None) => [0.0, 1.0],
    };
    let extent = bounding_box(octree.view(), octree.frame(), 0.0, &Control { progress: None, ..*control })?;
    let longest = extent.corners.map_or(octree.frame().edge(), |[min, max]| {
        (0..3).map(|axis| max[axis].upper - min[axis].lower).fold(0.0, f64::max)
    });
    Transfer::new(looks.map, range, looks.opacity, longest)
}

/// The voxels of an octree, with surfaces before and between them.
fn volume(
    looks: &Looks,
    octree: &Octree,
    source: Option<&AnySolid>,
    values: Option<&Values<'_>>,
    shot: &Shot,
    surfaces: &[&dyn Layer],
    control: &Control<'_>,
) -> Result<Picture, Error> {
    let channel = values.map(|values| values.channel);
    let transfer =
        values.map_or_else(|| transfer(looks, octree, None, control), |values| Ok(values.transfer))?;
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
    let compositing = match looks.published {
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
    render(shot, &layers, control)
}

fn hybrid(
    looks: &Looks,
    octree: &Octree,
    source: Option<&AnySolid>,
    values: Option<&Values<'_>>,
    shot: &Shot,
    control: &Control<'_>,
) -> Result<Picture, Error> {
    let quiet = Control { progress: None, ..*control };
    let mut colour = looks.colour.unwrap_or(Finish::default().colour);
    if shot.clip.is_empty() && looks.colour.is_none() {
        colour[3] = 70;
    }
    // Through a translucent skin all of its sides are seen.
    let has_mesh = source.is_some() || colour[3] < 255;
    let mesh = if has_mesh { Some(skin_mesh(octree, source, &quiet)?) } else { None };
    let triangles = mesh.as_ref().map(|mesh| MeshLayer::new(mesh).colour(colour).inside(colour));
    // Of an octree the steps of its lattice would be seen; what is cut open shows the inside.
    let cells = OctreeLayer::new(octree.view(), Finish { colour, cut: [0; 4], ..Finish::default() });
    let skin: &dyn Layer = triangles.as_ref().map_or(&cells, |triangles| triangles);
    // Clip planes cut the skin away, and show what is behind it.
    let cut = ClippedLayer::new(skin, shot.clip.clone());
    let whole = Shot { clip: Clip::new(), ..shot.clone() };
    volume(looks, octree, source, values, &whole, &[&cut], control)
}

/// Bytes that the triangles of a skin may take: some two million, as many as a picture has pixels.
const SKIN: u64 = 128 << 20;

/// The surface as triangles, with the finest cells that memory allows.
fn skin_mesh(
    octree: &Octree,
    source: Option<&AnySolid>,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    let limit = control.max_bytes.map_or(SKIN, |limit| limit.min(SKIN));
    let limited = Control { max_bytes: Some(limit), ..*control };
    let mut depth = octree.frame().depth();
    loop {
        let frame = octree.frame().with_depth(depth)?;
        let mesh = match source {
            // A tree is known on its own lattice alone: rays through the cells' centres find its surfaces.
            Some(source) if source.get::<Octree>().is_some() => {
                dexelize(source, &frame, &DexelOptions::default(), &limited)
                    .and_then(|model| Ok(marching_cubes_dexels(model.view(), &limited)?.0))
            }
            Some(source) => marching_cubes_solid(source, &frame, VertexPlacement::Crossing, &limited),
            None if depth == octree.frame().depth() => {
                marching_cubes(octree.view(), Some(Resolve::Outer), &limited)
            }
            None => build(octree.view(), &frame, Rule::Outer, control)
                .and_then(|coarse| marching_cubes(coarse.view(), None, &limited)),
        };
        match mesh {
            Err(Error::TooLarge { .. } | Error::Limit { .. } | Error::Mesh(MeshError::TooMany))
                if depth > 1 =>
            {
                depth -= 1;
            }
            mesh => return mesh,
        }
    }
}

fn slice(
    looks: &Looks,
    octree: &Octree,
    values: Option<&Values<'_>>,
    shot: &Shot,
    control: &Control<'_>,
) -> Result<Picture, Error> {
    let plane = match looks.plane {
        Some([a, b, c, d]) => SlicePlane::new([a, b, c], d)?,
        None => {
            let forward = shot.camera.forward();
            let axis = (0..3).max_by(|&i, &j| forward[i].abs().total_cmp(&forward[j].abs())).unwrap_or(2);
            let quiet = Control { progress: None, ..*control };
            let extent = bounding_box(octree.view(), octree.frame(), 0.0, &quiet)?;
            let universe = Bounds::of(octree.frame());
            let middle =
                extent.corners.map_or(0.5 * universe.min[axis] + 0.5 * universe.max[axis], |[min, max]| {
                    0.5 * min[axis].lower + 0.5 * max[axis].upper
                });
            SlicePlane::across(axis, middle)?
        }
    };
    let layer = SliceLayer::new(octree.view(), plane);
    let Some(values) = values else { return render(shot, &[&layer], control) };
    render(shot, &[&layer.values(values.channel, &values.colour())], control)
}
