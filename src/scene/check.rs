//! Converts calls to shapes.

use crate::lattice::Each;
use alloc::boxed::Box;
use alloc::format;
use alloc::string::String;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::fmt::Display;
use std::path::Path;

use super::arguments::{Given, Item};
use super::facets::{Facets, Fineness, MOST_SIDES};
use super::grammar::{Call, Cursor, Tree, shown};
use super::{Node, Scene, SceneReport};
use crate::error::Error;
use crate::exchange::Polygons;
use crate::lattice::Affine;
use crate::memory;
use crate::mesh::FillRule;
use crate::solid::{Csg, Fan, Figure, HalfSpace, cos_degrees, sin_degrees, wedge};

/// Calls of CSG dumps that are not supported.
const REFUSED: [&str; 9] =
    ["hull", "minkowski", "text", "projection", "offset", "resize", "surface", "roof", "fill"];

/// The least number of sides that is refused.
const MANY: u32 = MOST_SIDES + 1;

/// The result of a call.
pub(super) enum Shape {
    /// Neither a solid nor a figure: a group without content.
    Nothing,
    Figure(Box<Figure>),
    /// A solid, by the index of its node.
    Solid(usize),
}

/// A call whose block is being read.
struct Open {
    call: usize,
    /// The first of the results in its block.
    first: usize,
}

/// A converter from a tree of calls to shapes.
pub(super) struct Checker<'a> {
    pub(super) tree: &'a Tree<'a>,
    pub(super) files: Files<'a>,
    facets: Facets,
    pub(super) report: SceneReport,
    /// The place of the latest mesh.
    pub(super) cursor: Cursor,
    nodes: Vec<Node>,
    /// The results of calls that are not yet part of a larger shape, with their places.
    results: Vec<(usize, Shape)>,
}

/// The files that a scene may name.
#[derive(Clone, Copy)]
pub(super) struct Files<'a> {
    /// The folder in which they are looked for.
    pub folder: Option<&'a Path>,
    /// Maximum number of bytes of a file.
    pub max_bytes: Option<u64>,
}

/// Returns the scene of a whole text.
pub(super) fn check(tree: &Tree<'_>, files: Files<'_>, facets: Facets) -> Result<Scene, Error> {
    let (report, cursor, nodes, results) =
        (SceneReport::default(), Cursor::default(), Vec::new(), Vec::new());
    let mut checker = Checker { tree, files, facets, report, cursor, nodes, results };
    let mut open: Vec<Open> = Vec::new();
    let mut next = 0;
    loop {
        while let Some(block) = open.pop_if(|block| tree.calls[block.call].end == next) {
            let call = &tree.calls[block.call];
            let shape = checker.shape(call, block.first)?;
            checker.results.truncate(block.first);
            memory::push(&mut checker.results, (call.at, shape))?;
        }
        let Some(call) = tree.calls.get(next) else { break };
        if call.is_ignored {
            next = call.end;
            continue;
        }
        memory::push(&mut open, Open { call: next, first: checker.results.len() })?;
        next += 1;
    }
    let place = checker.results.first().map_or(0, |result| result.0);
    let nodes = match checker.union(0)? {
        Shape::Figure(_) => return Err(tree.fault(place, "the scene is flat: figures must be extruded")),
        Shape::Solid(_) => checker.nodes,
        Shape::Nothing => Vec::new(),
    };
    Ok(Scene { nodes, report: Arc::new(checker.report) })
}

impl Checker<'_> {
    pub(super) fn fault(&self, call: &Call<'_>, problem: impl Display) -> Error {
        self.tree.fault(call.at, format!("`{}` {problem}", call.name))
    }

    /// Adds the place of a call to an error about a combination of arguments.
    fn at<T>(&self, call: &Call<'_>, result: Result<T, Error>) -> Result<T, Error> {
        result.map_err(|error| match error {
            Error::OutOfMemory => error,
            error => self.fault(call, format_args!("cannot be had: {error}")),
        })
    }

    pub(super) fn node(&mut self, node: Node) -> Result<Shape, Error> {
        memory::push(&mut self.nodes, node)?;
        Ok(Shape::Solid(self.nodes.len() - 1))
    }

    /// Returns the shape of a call whose block consists of the results from `first` on.
    fn shape(&mut self, call: &Call<'_>, first: usize) -> Result<Shape, Error> {
        if REFUSED.contains(&call.name) {
            return Err(self.fault(call, "is not supported"));
        }
        let shape = match call.name {
            "group" | "union" | "render" | "color" => {
                // No argument of these calls has an effect on a shape.
                self.union(first)
            }
            "intersection" => self.intersection(call, first),
            "difference" => self.difference(call, first),
            "multmatrix" => self.multmatrix(call, first),
            "translate" => self.translate(call, first),
            "rotate" => self.rotate(call, first),
            "scale" => self.scale(call, first),
            "mirror" => self.mirror(call, first),
            "linear_extrude" => self.linear_extrude(call, first),
            "rotate_extrude" => self.rotate_extrude(call, first),
            "square" => self.square(call),
            "circle" => self.circle(call),
            "polygon" => self.polygon(call),
            name => {
                let solid = match name {
                    "cube" => self.cube(call)?,
                    "sphere" => self.sphere(call)?,
                    "cylinder" => self.cylinder(call)?,
                    "polyhedron" => self.polyhedron(call)?,
                    "halfspace" => self.half_space(call)?,
                    "quadric" => self.quadric(call)?,
                    "power" => self.power(call)?,
                    "torus" => self.torus(call)?,
                    "mesh" => {
                        let given = Given::new(self.tree, call, ["file", "deviation"], &[])?;
                        self.mesh(call, given.required(0)?, given.optional(1))?
                    }
                    "import" => self.import(call)?,
                    "octree" => self.octree(call)?,
                    _ => {
                        let hint = "CSG dumps have none; of a model in the language of OpenSCAD, \
                                    `openscad -o model.csg model.scad` makes one";
                        return Err(self
                            .tree
                            .fault(call.at, format!("unknown call {}: {hint}", shown(name))));
                    }
                };
                self.node(solid)
            }
        }?;
        // Operations have consumed the results in their blocks.
        match self.results.get(first) {
            Some(&(place, _)) => Err(self.tree.fault(place, format!("`{}` has no block", call.name))),
            None => Ok(shape),
        }
    }
}

// ---- operations -------------------------------------------------------------------------------------------

/// The operands of an operation, which are all of one kind.
enum Operands {
    Nothing,
    Figures(Vec<Figure>),
    Solids(Vec<usize>),
}

impl Checker<'_> {
    /// Returns the results from `first` on, without those that are nothing at all.
    fn operands(&mut self, first: usize) -> Result<Operands, Error> {
        let (mut figures, mut solids) = (Vec::new(), Vec::new());
        for (at, shape) in self.results.drain(first..) {
            match shape {
                Shape::Nothing => continue,
                Shape::Figure(figure) => memory::push(&mut figures, *figure)?,
                Shape::Solid(node) => memory::push(&mut solids, node)?,
            }
            if !figures.is_empty() && !solids.is_empty() {
                return Err(self.tree.fault(at, "figures of the plane and solids are mixed"));
            }
        }
        Ok(match (figures.is_empty(), solids.is_empty()) {
            (true, true) => Operands::Nothing,
            (false, _) => Operands::Figures(figures),
            (true, false) => Operands::Solids(solids),
        })
    }

    pub(super) fn union(&mut self, first: usize) -> Result<Shape, Error> {
        match self.operands(first)? {
            Operands::Nothing => Ok(Shape::Nothing),
            Operands::Figures(mut figures) if figures.len() == 1 => {
                Ok(figures.pop().map_or(Shape::Nothing, Shape::from))
            }
            Operands::Figures(figures) => Ok(Figure::union_of(figures)?.into()),
            Operands::Solids(solids) => match *solids {
                [solid] => Ok(Shape::Solid(solid)),
                _ => self.node(Node::Union(solids)),
            },
        }
    }

    /// Returns whether any of some operands is nothing: parts of an intersection, or the minuend of a
    /// difference.
    fn has_nothing(&self, mut parts: impl Iterator<Item = usize>) -> bool {
        parts.any(|part| matches!(self.results[part].1, Shape::Nothing))
    }

    fn intersection(&mut self, call: &Call<'_>, first: usize) -> Result<Shape, Error> {
        self.no_arguments(call)?;
        let is_empty = self.has_nothing(first..self.results.len());
        match self.operands(first)? {
            _ if is_empty => Ok(Shape::Nothing),
            Operands::Nothing => Ok(Shape::Nothing),
            Operands::Figures(figures) => Ok(Figure::intersection_of(figures)?.into()),
            Operands::Solids(solids) => self.node(Node::Intersection(solids)),
        }
    }

    fn difference(&mut self, call: &Call<'_>, first: usize) -> Result<Shape, Error> {
        self.no_arguments(call)?;
        let is_empty = self.has_nothing(first..self.results.len().min(first + 1));
        match self.operands(first)? {
            _ if is_empty => Ok(Shape::Nothing),
            Operands::Nothing => Ok(Shape::Nothing),
            Operands::Figures(mut figures) => {
                let others = figures.split_off(1);
                Ok(figures.first().map_or(Ok(Figure::nothing()), |figure| figure.difference(others))?.into())
            }
            Operands::Solids(solids) => self.node(Node::Difference(solids)),
        }
    }

    fn no_arguments(&self, call: &Call<'_>) -> Result<(), Error> {
        Given::new(self.tree, call, [], &[]).map(|_| ())
    }

    /// Returns the figure that a block consists of.
    fn figure(&mut self, call: &Call<'_>, first: usize) -> Result<Option<Figure>, Error> {
        match self.union(first)? {
            Shape::Nothing => Ok(None),
            Shape::Figure(figure) => Ok(Some(*figure)),
            Shape::Solid(_) => Err(self.fault(call, "takes figures of the plane, not solids")),
        }
    }

    fn linear_extrude(&mut self, call: &Call<'_>, first: usize) -> Result<Shape, Error> {
        let names = ["height", "v", "scale", "center", "twist", "slices"];
        let given = Given::new(self.tree, call, names, &["convexity", "segments"])?;
        let (has_height, direction) = (given.optional(0).is_some(), given.optional(1));
        let height = given.number_or(0, if direction.is_some() && !has_height { 1.0 } else { 100.0 })?;
        let direction = direction.map_or(Ok([0.0, 0.0, 1.0]), |item| item.numbers::<3>())?;
        let scale = match given.optional(2) {
            None => [1.0; 2],
            Some(item) if item.is_list() => item.numbers()?,
            Some(item) => [item.number()?; 2],
        };
        let is_centred = given.truth_or(3, false)?;
        if given.number_or(4, 0.0)? != 0.0 {
            return Err(self.fault(call, "is supported without `twist` only"));
        }
        let Some(figure) = self.figure(call, first)? else { return Ok(Shape::Nothing) };
        let [low, high] = heights(height, is_centred);
        // As in OpenSCAD, an extrusion downwards is empty, and negative scales are 0.
        let scale = scale.each(|scale| scale.max(0.0));
        if low >= high || direction[2] <= 0.0 {
            return self.node(Node::Solid(Csg::empty()));
        }
        let solid =
            if scale == [1.0; 2] { figure.prism(low, high) } else { figure.tapered(low, high, scale) };
        let mut solid = self.at(call, solid)?;
        self.report.ignored_slices += u64::from(scale[0] != scale[1] && given.number_or(5, 1.0)? > 1.0);
        if direction != [0.0, 0.0, 1.0] {
            let [x, y, z] = direction;
            let shear = Affine::new([[1.0, 0.0, x, 0.0], [0.0, 1.0, y, 0.0], [0.0, 0.0, z, 0.0]]);
            solid = solid.placed(&self.at(call, shear)?)?;
        }
        self.node(Node::Solid(solid))
    }

    fn rotate_extrude(&mut self, call: &Call<'_>, first: usize) -> Result<Shape, Error> {
        let given = Given::new(self.tree, call, ["angle", "start"], &["convexity"])?;
        let (angle, start) = (given.number_or(0, 360.0)?, given.number_or(1, 0.0)?);
        let Some(figure) = self.figure(call, first)? else { return Ok(Shape::Nothing) };
        let solid = match self.turned(call, &given, &figure, angle, start)? {
            Some(solid) => solid,
            None => {
                let solid = self.at(call, figure.revolved())?;
                if angle <= -360.0 || angle >= 360.0 {
                    solid
                } else if angle == 0.0 {
                    Csg::empty()
                } else {
                    // A figure on the other side of the axis starts half a turn later.
                    let from = if figure.is_mirrored() { start + 180.0 } else { start };
                    let wedge = wedge(from + angle.min(0.0), angle.abs());
                    Csg::intersection_of([solid, self.at(call, wedge)?])?
                }
            }
        };
        self.node(Node::Solid(solid))
    }

    /// Returns the result of `rotate_extrude` for a figure, if it is drawn as a polyhedron, and counts it in
    /// the report. Figures with curves are rotated exactly.
    fn turned(
        &mut self,
        call: &Call<'_>,
        given: &Given<'_, 2>,
        figure: &Figure,
        angle: f64,
        start: f64,
    ) -> Result<Option<Csg>, Error> {
        let fan = match self.sides(call, given, figure.reach())? {
            Some(_) if figure.has_curves()? => None,
            Some(sides) if angle <= -360.0 || angle >= 360.0 => {
                // A whole turn starts on the other side, unless a start is given.
                Fan::regular(if given.optional(1).is_some() { start } else { 180.0 }, sides)?
            }
            Some(sides) => {
                let share = f64::from(sides) * angle.abs() / 360.0;
                Fan::part(start, angle, share.max(1.0) as u32)?
            }
            None => None,
        };
        if angle != 0.0 {
            self.note(fan.is_some());
        }
        fan.map(|fan| self.at(call, figure.turned(fan))).transpose()
    }
}

impl From<Figure> for Shape {
    fn from(figure: Figure) -> Shape {
        Shape::Figure(Box::new(figure))
    }
}

// ---- figures and solids -----------------------------------------------------------------------------------

/// Returns the range from 0 to `height`, or, if centred, half of it on both sides of 0.
fn heights(height: f64, is_centred: bool) -> [f64; 2] {
    if is_centred { [-height / 2.0, height / 2.0] } else { [0.0, height] }
}

/// Returns the range of a box along each axis, from its size and whether it is centred.
fn sides<const N: usize>(given: &Given<'_, 2>) -> Result<[[f64; 2]; N], Error> {
    let size = match given.optional(0) {
        None => [1.0; N],
        Some(item) if item.is_list() => item.numbers()?,
        Some(item) => [item.number()?; N],
    };
    let is_centred = given.truth_or(1, false)?;
    Ok(size.map(|size| heights(size, is_centred)))
}

impl Checker<'_> {
    fn square(&self, call: &Call<'_>) -> Result<Shape, Error> {
        let [x, y] = sides(&Given::new(self.tree, call, ["size", "center"], &[])?)?;
        if x[0] >= x[1] || y[0] >= y[1] {
            return Ok(Figure::nothing().into());
        }
        Ok(self.at(call, Figure::rectangle([x[0], y[0]], [x[1], y[1]]))?.into())
    }

    /// Returns the number of sides with which a curved call with a circle of this radius is drawn; `None` if
    /// the circle is exact.
    fn sides<const N: usize>(
        &self,
        call: &Call<'_>,
        given: &Given<'_, N>,
        radius: f64,
    ) -> Result<Option<u32>, Error> {
        let sides = Fineness::new(given.fineness()).drawn(self.facets, radius);
        match sides {
            Some(MANY..) => Err(self.fault(call, format_args!("has more than {MOST_SIDES} sides"))),
            _ => Ok(sides),
        }
    }

    /// Returns the regular polygon in place of a curved call's circle, if it is drawn as one, and counts it
    /// in the report.
    fn fan<const N: usize>(
        &mut self,
        call: &Call<'_>,
        given: &Given<'_, N>,
        radius: f64,
    ) -> Result<Option<Fan>, Error> {
        let fan = match self.sides(call, given, radius)? {
            Some(sides) => Fan::regular(0.0, sides)?,
            None => None,
        };
        self.note(fan.is_some());
        Ok(fan)
    }

    fn note(&mut self, is_polygon: bool) {
        *(if is_polygon { &mut self.report.polygons } else { &mut self.report.exact }) += 1;
    }

    fn circle(&mut self, call: &Call<'_>) -> Result<Shape, Error> {
        let given = Given::new(self.tree, call, ["r"], &[])?;
        let radius = given.number_or(0, 1.0)?;
        if radius <= 0.0 {
            return Ok(Figure::nothing().into());
        }
        Ok(match self.fan(call, &given, radius)? {
            Some(fan) => Figure::regular(radius, &fan)?,
            None => Figure::disc(radius),
        }
        .into())
    }

    fn polygon(&self, call: &Call<'_>) -> Result<Shape, Error> {
        let given = Given::new(self.tree, call, ["points", "paths"], &["convexity"])?;
        let Some(item) = given.optional(0) else { return Ok(Figure::nothing().into()) };
        let points = item.points::<2>()?;
        let figure = |item: &Item<'_>, points: &[[f64; 2]]| {
            Figure::polygon(points).map_err(|error| match error {
                Error::Argument { problem, .. } => item.fault(problem),
                error => error,
            })
        };
        let Some(paths) = given.optional(1) else {
            // As in OpenSCAD, fewer than three points are nothing.
            return Ok((if points.len() < 3 { Figure::nothing() } else { figure(&item, &points)? }).into());
        };
        let mut outlines = Vec::new();
        for path in paths.items()? {
            let indices = path.indices(points.len())?;
            let outline = memory::collected(indices.iter().map(|&index| points[index as usize]))?;
            memory::push(&mut outlines, figure(&path, &outline)?)?;
        }
        // Outlines within outlines are holes, and outlines within holes are islands.
        Ok(Figure::xor_of(outlines)?.into())
    }

    fn cube(&self, call: &Call<'_>) -> Result<Node, Error> {
        let sides = sides::<3>(&Given::new(self.tree, call, ["size", "center"], &[])?)?;
        if sides.iter().any(|[low, high]| low >= high) {
            return Ok(Node::Solid(Csg::empty()));
        }
        let cuboid = Csg::cuboid(sides.each(|side| side[0]), sides.each(|side| side[1]));
        Ok(Node::Solid(self.at(call, cuboid)?))
    }

    fn sphere(&mut self, call: &Call<'_>) -> Result<Node, Error> {
        let given = Given::new(self.tree, call, ["r"], &[])?;
        let radius = given.number_or(0, 1.0)?;
        if radius <= 0.0 {
            return Ok(Node::Solid(Csg::empty()));
        }
        let ball = match self.fan(call, &given, radius)? {
            None => Csg::ball([0.0; 3], radius),
            Some(fan) => {
                // Rings of corners, none of which is a pole.
                let rings = fan.corners().len().div_ceil(2);
                let mut profile = memory::with_capacity(rings + 2)?;
                profile.extend((0..rings).map(|ring| {
                    let angle = 180.0 * (ring as f64 + 0.5) / rings as f64;
                    [radius * sin_degrees(angle), radius * cos_degrees(angle)]
                }));
                let ends = [profile.last(), profile.first()].each(|end| [0.0, end.map_or(0.0, |end| end[1])]);
                profile.extend(ends);
                self.at(call, Figure::polygon(&profile))?.turned(fan)
            }
        };
        Ok(Node::Solid(self.at(call, ball)?))
    }

    fn cylinder(&mut self, call: &Call<'_>) -> Result<Node, Error> {
        let given = Given::new(self.tree, call, ["h", "r1", "r2", "center", "r"], &[])?;
        let radius = given.number_or(4, 1.0)?;
        let (bottom, top) = (given.number_or(1, radius)?, given.number_or(2, radius)?);
        let [low, high] = heights(given.number_or(0, 1.0)?, given.truth_or(3, false)?);
        if low >= high || bottom < 0.0 || top < 0.0 || bottom + top == 0.0 {
            return Ok(Node::Solid(Csg::empty()));
        }
        let frustum = match self.fan(call, &given, bottom.max(top))? {
            None => Csg::frustum(bottom, top, low, high),
            Some(fan) => {
                let profile = [[0.0, low], [bottom, low], [top, high], [0.0, high]];
                self.at(call, Figure::polygon(&profile))?.turned(fan)
            }
        };
        Ok(Node::Solid(self.at(call, frustum)?))
    }

    fn polyhedron(&mut self, call: &Call<'_>) -> Result<Node, Error> {
        let given = Given::new(self.tree, call, ["points", "faces"], &["convexity"])?;
        let (Some(points), Some(faces)) = (given.optional(0), given.optional(1)) else {
            return Ok(Node::Solid(Csg::empty()));
        };
        let mut polygons = Polygons::default();
        polygons.vertices = points.points()?;
        for face in faces.items()? {
            polygons.push_face(&face.indices(polygons.vertices.len())?)?;
        }
        let mesh = self.at(call, polygons.finish())?;
        if mesh.triangles().is_empty() {
            return Ok(Node::Solid(Csg::empty()));
        }
        self.solid_mesh(call, String::new(), mesh, FillRule::NonZero)
    }

    fn half_space(&self, call: &Call<'_>) -> Result<Node, Error> {
        let [x, y, z, offset] = Given::new(self.tree, call, ["plane"], &[])?.required(0)?.numbers()?;
        Ok(Node::Solid(self.at(call, HalfSpace::plane([x, y, z], offset))?.into()))
    }

    fn quadric(&self, call: &Call<'_>) -> Result<Node, Error> {
        let numbers = Given::new(self.tree, call, ["coefficients"], &[])?.required(0)?.numbers()?;
        Ok(Node::Solid(self.at(call, HalfSpace::quadric(numbers))?.into()))
    }

    fn power(&self, call: &Call<'_>) -> Result<Node, Error> {
        let given = Given::new(self.tree, call, ["x", "y", "z", "constant"], &[])?;
        let mut terms = [(0.0, 0.0, 0); 3];
        for (axis, term) in terms.iter_mut().enumerate() {
            let [factor, centre, exponent] = given.required(axis)?.list()?;
            *term = (factor.number()?, centre.number()?, exponent.index()?);
        }
        let constant = given.required(3)?.number()?;
        Ok(Node::Solid(self.at(call, HalfSpace::power(terms, constant))?.into()))
    }

    fn torus(&self, call: &Call<'_>) -> Result<Node, Error> {
        let given = Given::new(self.tree, call, ["major", "minor"], &[])?;
        let (major, minor) = (given.required(0)?.number()?, given.required(1)?.number()?);
        Ok(Node::Solid(self.at(call, Csg::torus(major, minor))?))
    }
}
