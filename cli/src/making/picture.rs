//! Pictures of solids, meshes and volumes, in each view.

use crate::failure::{Failure, Of, complain};
use crate::making::clipped::Planes;
use crate::making::{dexel_surface, octree_from_dexels};
use crate::options;
use crate::progress::watched;
use crate::source::input::Input;
use crate::source::mesh::openness;
use crate::source::solid::{Shape, Source, cells_of};
use crate::words::short;
use clap::{Args, ValueEnum};
use leafless::attribute::{Attribute, Channel, Criterion, Detail};
use leafless::error::MeshError;
use leafless::lattice::{Cube, MAX_DEPTH};
use leafless::octree::CellFilter;
use leafless::op::{DexelOptions, resolve};
use leafless::render::{
    Clip, ClippedLayer, ColourMap, Compositing, Finish, Layer, LegendBox, LegendSide, Lens, MeshEdges,
    MeshLayer, OctreeLayer, Outline, Picture, Shot, SliceLayer, SlicePlane, SolidLayer, TAG_COLOURS,
    Transfer, VolumeLayer, draw_colour_bar, draw_names, draw_scale_bar, render,
};
use leafless::surface::{Resolve, VertexPlacement, marching_cubes_dexels, marching_cubes_solid};
use leafless::voxel::{VoxelOptions, VoxelRecords};
use leafless::{
    Affine, AnySolid, Bounds, Control, Error, FillRule, Frame, Interval, Octree, Proof, Rule, Tag,
    TriangleMesh, bounding_box, build, dexelize, marching_cubes,
};
use serde::Serialize;

/// The view, and its colours.
#[derive(Args)]
pub struct Looks {
    /// What to show
    #[arg(long, value_enum, default_value_t = View::Surface)]
    pub view: View,
    /// Colour of the surface, such as #b2bbc4
    #[arg(long, value_name = "COLOUR", value_parser = colour, help_heading = "Colours and values")]
    colour: Option<[u8; 4]>,
    /// Draw edges: those at which faces meet at more than 30 degrees, or those of all triangles of a mesh
    #[arg(long, value_enum, value_name = "WHICH", num_args = 0..=1, default_missing_value = "features", help_heading = "Colours and values")]
    edges: Option<Edges>,
    /// Show the cells of a solid by their faces
    #[arg(long)]
    faces: bool,
    /// How the undecided cells of an octree are shown whose cells keep no surfaces
    #[arg(long, value_enum, default_value_t = Undecided::Shown)]
    undecided: Undecided,
    /// Leave out the legend, and the scale and the extents of a slice
    #[arg(long)]
    pub no_legend: bool,
    /// Plane of the slice: the points x, y, z with a x + b y + c z + d = 0, seen against its normal a,b,c:
    /// 0,0,1,d from above, 0,-1,0,d from the front, 1,0,0,d from the right. +z is upward; if the plane is
    /// horizontal, +x is to the right. The slice is never mirrored [default: the plane through the middle,
    /// across the axis that is nearest to the direction of view]
    #[arg(long, value_name = "A,B,C,D", value_parser = numbers::<4>, allow_hyphen_values = true, help_heading = "Slices and cuts")]
    pub plane: Option<[f64; 4]>,
    /// Show a slice without cells: only what is inside. Unless the input is an octree of cells, its surface
    /// is then drawn as a line, made of cells as small as a pixel
    #[arg(long, help_heading = "Slices and cuts")]
    no_cells: bool,
    /// Colours of values: viridis, cividis, inferno, magma, plasma or grey
    #[arg(long, value_name = "NAME", default_value = "viridis", value_parser = map, help_heading = "Colours and values")]
    map: ColourMap,
    /// Values at both ends of the colours [default: the least and the greatest]
    #[arg(long, value_name = "A,B", value_parser = numbers::<2>, allow_hyphen_values = true, help_heading = "Colours and values")]
    range: Option<[f64; 2]>,
    /// Opacity of a volume as thick as the solid's longest side, 0 to 1
    #[arg(long, value_name = "ALPHA", default_value_t = 0.95, value_parser = share, help_heading = "Colours and values")]
    opacity: f64,
    /// Show voxels as in the published method: a voxel with an edge of k finest voxels counts as k layers,
    /// wherever a line of sight crosses it
    #[arg(long, help_heading = "Colours and values")]
    published: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum View {
    /// The shaded surface
    Surface,
    /// The inside, translucent
    Volume,
    /// Both: clip planes cut only the surface; without any it is translucent
    Hybrid,
    /// A plane section, with its cells and their tags
    Slice,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum Undecided {
    /// Like FULL cells
    Shown,
    /// Translucent, around FULL cells
    Faint,
    /// Only FULL cells are shown
    Hidden,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum Edges {
    /// Where faces meet at more than 30 degrees
    Features,
    /// All edges of triangles, fainter where triangles are small
    All,
}

impl Looks {
    /// Refuses options that have no effect in the view.
    pub fn check(&self) -> Result<(), Failure> {
        let (view, is_surface) = (self.view, self.view == View::Surface);
        for (is_misplaced, option, of) in [
            (self.plane.is_some() && view != View::Slice, "--plane", "slice"),
            (self.faces && !is_surface, "--faces", "surface"),
            (self.edges.is_some() && !is_surface, "--edges", "surface"),
            (self.undecided != Undecided::Shown && !is_surface, "--undecided", "surface"),
            (self.no_cells && view != View::Slice, "--no-cells", "slice"),
        ] {
            if is_misplaced {
                return Err(Failure::Usage(format!("{option} is for --view {of}")));
            }
        }
        Ok(())
    }

    /// True if the view shows cells, so that a shape without cells is split.
    fn is_of_cells(&self) -> bool {
        match self.view {
            View::Surface => self.faces,
            View::Slice => !self.no_cells,
            View::Volume | View::Hybrid => true,
        }
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

/// The subject of a picture.
pub enum Subject {
    /// An octree, with its source if that is known.
    Octree(Box<Octree>, Option<Box<AnySolid>>),
    Mesh(Box<TriangleMesh>),
    Solid(Box<AnySolid>, Frame),
}

impl Subject {
    /// Returns the subject of a file. A shape without cells is split to `depth` if the view needs cells. A
    /// subject that is cut open is a solid, if it bounds one, so that its inside is seen.
    pub fn of(
        shape: Shape,
        input: &Input,
        looks: &Looks,
        depth: u8,
        is_cut: bool,
        threads: usize,
    ) -> Result<Subject, Failure> {
        let is_of_cells = looks.is_of_cells();
        let shape = match shape {
            // Materials belong to cells.
            Shape::Dexels(model)
                if is_of_cells || looks.view == View::Slice || model.view().format().materials =>
            {
                let octree =
                    watched("render", threads, |control| octree_from_dexels::octree(&model, false, control));
                return Ok(Subject::Octree(Box::new(octree.of(input)?), None));
            }
            Shape::Dexels(model) => {
                let mesh = dexel_surface::cubes(&model, input, threads)?.0;
                Shape::Source(Source::Mesh(mesh, FillRule::NonZero, None))
            }
            shape => shape,
        };
        // Only a mesh shows the edges of all triangles, and a mesh has no inside.
        let is_capped = match &shape {
            Shape::Source(Source::Mesh(mesh, ..)) if is_cut && looks.edges != Some(Edges::All) => {
                openness(&mesh.report().of(input)?).is_none()
            }
            _ => false,
        };
        match shape {
            Shape::Source(Source::Octree(octree)) if octree.view().cuts().is_none() => {
                Ok(Subject::Octree(octree, None))
            }
            Shape::Source(Source::Mesh(mesh, ..))
                if looks.view == View::Surface && !is_of_cells && !is_capped =>
            {
                Ok(Subject::Mesh(Box::new(mesh)))
            }
            Shape::Dexels(_) => Err(Failure::of(input, "is a tri-dexel model")),
            Shape::Source(source) => {
                let frame = source.frame(input, Some(depth))?;
                let solid = source.placed(input, &Affine::IDENTITY, &frame)?;
                if !is_of_cells {
                    return Ok(Subject::Solid(Box::new(solid), frame));
                }
                let octree = watched("render", threads, |control| {
                    cells_of(&solid, solid.get::<Octree>(), &frame, control)
                });
                Ok(Subject::Octree(Box::new(octree.of(input)?), Some(Box::new(solid))))
            }
        }
    }

    /// Returns the octree from a file whose channels may be shown.
    pub fn octree(&self) -> Option<&Octree> {
        match self {
            Subject::Octree(octree, _) => Some(octree),
            Subject::Solid(solid, _) => solid.get::<Octree>(),
            Subject::Mesh(_) => None,
        }
    }

    /// Prints a note if undecided cells hide FULL ones.
    pub fn note_undecided(&self, input: &Input, looks: &Looks) {
        let Subject::Octree(octree, None) = self else { return };
        let volume = octree.statistics().volume();
        if looks.view != View::Surface
            || looks.undecided != Undecided::Shown
            || volume.lower >= 0.5 * volume.upper
        {
            return;
        }
        complain(&match volume.lower {
            0.0 => format!("{input}: note: no cell is FULL; all that is shown is undecided"),
            _ => format!(
                "{input}: note: undecided cells hide those that are FULL: --undecided faint or hidden shows them"
            ),
        });
    }

    /// Returns the extents along x, y and z, as far as they are known.
    fn extents(&self, control: &Control<'_>) -> Result<Option<[[Interval; 2]; 3]>, Error> {
        let quiet = Control { progress: None, ..*control };
        let found = match self {
            // The proof of the cells does not matter here.
            Subject::Octree(octree, _) => {
                let cells = octree.with_proof(Proof::CERTIFIED);
                bounding_box(&cells, cells.frame(), 0.0, &quiet)?
            }
            Subject::Solid(solid, frame) => {
                let quiet = Control { max_splits: Some(1 << 16), ..quiet };
                bounding_box(&**solid, &frame.with_depth(MAX_DEPTH)?, 1e-5 * frame.edge(), &quiet)?
            }
            Subject::Mesh(mesh) => {
                let (min, max) = mesh.bounds();
                return Ok(Some([0, 1, 2].map(|axis| [min[axis], max[axis]].map(Interval::exactly))));
            }
        };
        Ok(found.corners.map(|[min, max]| [0, 1, 2].map(|axis| [min[axis], max[axis]])))
    }

    /// Returns points such that a view of all of them shows everything that clip planes leave: corners of
    /// coarse cells around the subject, or those of the universe if the subject is empty.
    pub fn points(&self, planes: &Planes, control: &Control<'_>) -> Result<Vec<[f64; 3]>, Error> {
        let coarse = |octree: &Octree| {
            let frame = *octree.frame();
            let finest = COARSE.min(frame.depth());
            let leaves = octree.view().cells(CellFilter::tags(&[Tag::Full, Tag::Partial]).levels(0..=finest));
            let cut = octree.view().cells(CellFilter::tags(&[Tag::Branch]).levels(finest..=finest));
            let mut points = Vec::new();
            for found in leaves.chain(cut) {
                let (min, max) = Cube { frame: &frame, cell: found.cell }.bounds();
                planes.of_box(&Bounds { min, max }, &mut points);
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
                let corners = |triangle: &[u32; 3]| triangle.map(|vertex| mesh.vertices()[vertex as usize]);
                let mut points = Vec::new();
                for triangle in mesh.triangles() {
                    planes.of_triangle(corners(triangle), &mut points);
                }
                // If everything is cut away, the size is that before cutting.
                if points.is_empty() {
                    points.extend(mesh.triangles().iter().flat_map(corners));
                }
                Ok(points)
            }
            Subject::Solid(solid, frame) => {
                Ok(coarse(&build(&**solid, &frame.with_depth(COARSE)?, Rule::Certified, control)?))
            }
        }
    }
}

/// Level of the cells that a camera is fitted to.
const COARSE: u8 = 6;

/// A channel, and the colours of its values.
pub struct Values<'a> {
    channel: &'a Channel,
    transfer: Transfer,
    /// The value, if there is only one.
    sole: Option<f64>,
}

impl<'a> Values<'a> {
    /// Returns the values of a channel of an octree.
    pub fn new(
        looks: &Looks,
        octree: &Octree,
        channel: &'a Channel,
        control: &Control<'_>,
    ) -> Result<Values<'a>, Error> {
        let quiet = Control { progress: None, ..*control };
        let found = channel.view()?.summary(Some(octree.view()), None, &quiet)?;
        let found = found.map(|found| [found.least[0], found.greatest[0]]);
        let sole = found.and_then(|[low, high]| (low == high && looks.range.is_none()).then_some(low));
        let wide =
            |[low, high]: [f64; 2]| if low < high { [low, high] } else { [low, low + low.abs().max(1.0)] };
        let range = looks.range.or(found.map(wide));
        Ok(Values { channel, transfer: transfer(looks, octree, range, control)?, sole })
    }

    /// Returns the colour of a value on a surface.
    fn colour(&self) -> impl Fn(Option<[f64; 4]>) -> [u8; 4] + use<'_, 'a> {
        let components = self.channel.value_type().components();
        move |value| self.transfer.opaque(value, components)
    }
}

/// Returns a picture of the subject, with a legend.
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
        (_, View::Slice) => slice(looks, subject, values, shot, control),
        _ => surface(looks, subject, values, shot, control),
    }?;
    legend(looks, subject, values, &mut picture)?;
    if let (false, true, Lens::Parallel(height)) =
        (looks.no_legend, is_along_normal(looks, shot), shot.camera.lens())
    {
        let note = subject
            .extents(control)?
            .map_or_else(String::new, |extents| extents.map(extent_text).join(" x "));
        draw_scale_bar(&mut picture, height / f64::from(shot.size[1]), &note)?;
    }
    Ok(picture)
}

/// True if a slice is seen along its normal, so that it has one scale.
fn is_along_normal(looks: &Looks, shot: &Shot) -> bool {
    let [x, y, z] = shot.camera.forward();
    let across = match looks.plane {
        Some([a, b, c, _]) => (a * x + b * y + c * z).abs() / a.hypot(b).hypot(c),
        None => x.abs().max(y.abs()).max(z.abs()),
    };
    looks.view == View::Slice && across >= 1.0 - 1e-9
}

/// Formats the distance between two planes.
fn extent_text([low, high]: [Interval; 2]) -> String {
    let ends = [(high.lower - low.upper).max(0.0), high.upper - low.lower];
    let length = Interval::new(ends[0], ends[1]).unwrap_or(Interval::ALL);
    let is_sure = length.upper - length.lower <= 1e-6 * length.upper;
    if is_sure { short(0.5 * length.lower + 0.5 * length.upper) } else { length.to_string() }
}

/// Returns the boxes of the legend of a picture of this size, and of the scale of a slice that is seen along
/// its normal; `None` if there is none.
pub fn legend_boxes(
    looks: &Looks,
    subject: &Subject,
    values: Option<&Values<'_>>,
    size: [u32; 2],
) -> Result<[Option<LegendBox>; 2], Error> {
    let is_slice = looks.view == View::Slice;
    if looks.no_legend || values.is_none() && !is_slice {
        return Ok([None; 2]);
    }
    let mut blank = Picture::of_colours(size, vec![[255; 4]; size[0] as usize * size[1] as usize])?;
    let scale = if is_slice { draw_scale_bar(&mut blank, 1.0, "x")? } else { None };
    Ok([legend(looks, subject, values, &mut blank)?, scale])
}

/// Draws the legend on the right, and returns its box; `None` if there is none.
fn legend(
    looks: &Looks,
    subject: &Subject,
    values: Option<&Values<'_>>,
    picture: &mut Picture,
) -> Result<Option<LegendBox>, Error> {
    let (is_slice, side) = (looks.view == View::Slice, LegendSide::Right);
    match values {
        _ if looks.no_legend => Ok(None),
        // The first of two numbers has a colour; three numbers are a colour themselves.
        Some(Values { channel, transfer, sole: Some(value) }) if channel.value_type().components() == 1 => {
            let colour = transfer.opaque(Some([*value, 0.0, 0.0, 0.0]), 1);
            Ok(draw_names(picture, channel.name(), &[(&short(*value), colour)], side))
        }
        Some(Values { channel, transfer, .. }) if channel.value_type().components() <= 2 => {
            let colour = |value: f64| transfer.opaque(Some([value, 0.0, 0.0, 0.0]), 1);
            draw_colour_bar(picture, channel.name(), transfer.range(), &colour, side)
        }
        None if is_slice => {
            let names = [("EMPTY", TAG_COLOURS[0]), ("FULL", TAG_COLOURS[1]), ("PARTIAL", TAG_COLOURS[2])];
            let shown = match subject {
                Subject::Octree(..) if looks.no_cells => &names[1..],
                Subject::Octree(..) => &names[..],
                // Only the inside has a colour.
                _ => &[],
            };
            Ok(draw_names(picture, "", shown, side))
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
        Subject::Octree(octree, _) if looks.undecided != Undecided::Shown => {
            let inner = resolve(octree.view(), Rule::Inner, &Control { progress: None, ..*control })?;
            let colour = values.map(Values::colour);
            let mut layer = OctreeLayer::new(inner.view(), finish);
            if let (Some(values), Some(colour)) = (values, &colour) {
                layer = layer.values(values.channel, colour);
            }
            let [red, green, blue, _] = TAG_COLOURS[2];
            let faint = Finish { colour: [red, green, blue, FAINT], edges: None, cut: [0; 4], ..finish };
            let around = OctreeLayer::new(octree.view(), faint);
            match looks.undecided {
                Undecided::Faint => render(shot, &[&layer, &around], control),
                _ => render(shot, &[&layer], control),
            }
        }
        _ if looks.undecided != Undecided::Shown => Err(Error::Argument {
            name: "undecided",
            problem: "cells are those of octrees that keep no surfaces",
        }),
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

/// Opacity of undecided cells around FULL ones.
const FAINT: u8 = 50;

/// Returns the colours of values in a range; without a channel, there is one colour.
fn transfer(
    looks: &Looks,
    octree: &Octree,
    range: Option<[f64; 2]>,
    control: &Control<'_>,
) -> Result<Transfer, Error> {
    let range = range.or(looks.range).unwrap_or([0.0, 1.0]);
    let extent = bounding_box(octree.view(), octree.frame(), 0.0, &Control { progress: None, ..*control })?;
    let longest = extent.corners.map_or(octree.frame().edge(), |[min, max]| {
        (0..3).map(|axis| max[axis].upper - min[axis].lower).fold(0.0, f64::max)
    });
    Transfer::new(looks.map, range, looks.opacity, longest)
}

/// Shows the voxels of an octree, with surfaces before and between them.
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
    // The weight of an undecided cell is its solid part, if that can be computed.
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
    // A translucent skin shows all of its sides.
    let has_mesh = source.is_some() || colour[3] < 255;
    let mesh = if has_mesh { Some(skin_mesh(octree, source, &quiet)?) } else { None };
    let triangles = mesh.as_ref().map(|mesh| MeshLayer::new(mesh).colour(colour).inside(colour));
    // The surface of an octree would show the steps of its lattice; a cut shows the inside.
    let cells = OctreeLayer::new(octree.view(), Finish { colour, cut: [0; 4], ..Finish::default() });
    let skin: &dyn Layer = triangles.as_ref().map_or(&cells, |triangles| triangles);
    // Clip planes cut the skin away, and uncover the voxels behind it.
    let cut = ClippedLayer::new(skin, shot.clip.clone());
    let whole = Shot { clip: Clip::new(), ..shot.clone() };
    volume(looks, octree, source, values, &whole, &[&cut], control)
}

/// Bytes for the triangles of a skin: about two million triangles, as many as a picture has pixels.
const SKIN: u64 = 128 << 20;

/// Returns the surface as triangles, with the finest cells that memory allows.
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
            // A tree is known on its own lattice only: rays through the cells' centres find its surfaces.
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

/// Returns the direction from which a slice is seen along its normal: azimuth and elevation in degrees.
pub fn facing([a, b, c]: [f64; 3]) -> [f64; 2] {
    let level = a.hypot(b);
    // A level plane is seen with +x to the right. (A negative zero would turn the view.)
    let azimuth = if level <= 1e-9 * c.abs() { 0.0 } else { a.atan2(-b).to_degrees() };
    [azimuth, c.atan2(level).to_degrees()]
}

/// Finest level of a slice without cells: its cells are as small as a pixel, but there are at most 2 to this
/// power along an axis.
const FINEST: u8 = 14;

fn slice(
    looks: &Looks,
    subject: &Subject,
    values: Option<&Values<'_>>,
    shot: &Shot,
    control: &Control<'_>,
) -> Result<Picture, Error> {
    let plane = match looks.plane {
        Some([a, b, c, d]) => SlicePlane::new([a, b, c], d)?,
        None => {
            let forward = shot.camera.forward();
            let axis = (0..3).max_by(|&i, &j| forward[i].abs().total_cmp(&forward[j].abs())).unwrap_or(2);
            let middle = match (subject.extents(control)?, subject) {
                (Some(extents), _) => 0.5 * extents[axis][0].lower + 0.5 * extents[axis][1].upper,
                (None, Subject::Octree(octree, _)) => middle_of(octree.frame(), axis),
                (None, Subject::Solid(_, frame)) => middle_of(frame, axis),
                (None, Subject::Mesh(_)) => 0.0,
            };
            SlicePlane::across(axis, middle)?
        }
    };
    let [empty, full, partial] = TAG_COLOURS;
    let (mut layer, mut colours) = match subject {
        Subject::Octree(octree, _) => (SliceLayer::new(octree.view(), plane), [empty, full, partial]),
        Subject::Solid(solid, frame) => {
            let pixel = match shot.camera.lens() {
                Lens::Parallel(height) => height / f64::from(shot.size[1]),
                Lens::Perspective(_) => 0.0,
            };
            let is_fine = |depth: &u8| frame.edge() / f64::from(1u32 << depth) <= pixel;
            let depth = (1..FINEST).find(is_fine).unwrap_or(FINEST);
            (SliceLayer::of_solid(&**solid, &frame.with_depth(depth)?, plane), [empty, full, INK])
        }
        Subject::Mesh(_) => return Err(Error::Argument { name: "view", problem: "of a mesh is no slice" }),
    };
    if looks.no_cells {
        colours[0] = [0; 4];
        colours[1] = looks.colour.unwrap_or(colours[1]);
        layer = layer.outlines(None).colours(colours);
    }
    let Some(values) = values else { return render(shot, &[&layer], control) };
    render(shot, &[&layer.values(values.channel, &values.colour())], control)
}

fn middle_of(frame: &Frame, axis: usize) -> f64 {
    frame.origin()[axis] + 0.5 * frame.edge()
}
