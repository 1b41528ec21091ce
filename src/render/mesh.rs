//! Triangle meshes in pictures.

use super::bins::Bins;
use super::camera::View;
use super::clip::holds;
use super::coverage::Coverage;
use super::crease;
use super::light::Light;
use super::lines::check_width;
use super::mapped::mapped;
use super::stage::{Draw, Painter, Stage};
use super::stroke::Strokes;
use super::tile::Tile;
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use crate::mesh::TriangleMesh;
use alloc::boxed::Box;
use alloc::vec::Vec;
use glam::{DVec2, DVec3, Vec3};

/// The edges of a mesh that are drawn as lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum MeshEdges {
    /// No edges.
    #[default]
    None,
    /// The edges at which the mesh ends, or where triangles meet at more than the crease angle.
    Features,
    /// The edges of all triangles. The edges of triangles that are only a few pixels large are fainter, and
    /// those of smaller triangles are not drawn, so that a fine mesh does not turn black.
    All,
}

/// A layer that shows a triangle mesh: shaded faces that hide everything behind them.
///
/// A sample of the picture shows a triangle if its line of sight meets the triangle. This decision is exact:
/// on a closed mesh no sample is left out between two triangles, and none is counted twice. Faces that are
/// seen from behind, such as the inside of a mesh that is cut open, have a colour of their own.
///
/// Preparing: O(triangles + vertices + tiles), and about a hundred bytes per triangle. Drawing: O(samples
/// that the triangles cover).
#[derive(Debug, Clone, Copy)]
pub struct MeshLayer<'a> {
    mesh: &'a TriangleMesh,
    colour: [u8; 4],
    colours: Option<&'a [[u8; 4]]>,
    inside: Option<[u8; 4]>,
    crease: f64,
    edges: MeshEdges,
    edge_width: f64,
    edge_colour: [u8; 4],
}

/// The least height of a triangle, in pixels: up to the first number its edges are not drawn, and from the
/// second one on they are drawn fully. (In a right-angled triangle with two equal sides, these sides have
/// about 2 and 8 pixels.)
const FADE: [f64; 2] = [1.5, 5.5];

/// The colour that is mixed into back faces, unless they have a colour of their own: vermilion.
const INSIDE: [u8; 4] = [213, 94, 0, 255];

impl<'a> MeshLayer<'a> {
    /// Creates a layer of a mesh in light grey, smooth where its triangles meet at less than 30 degrees,
    /// without edges.
    pub fn new(mesh: &'a TriangleMesh) -> MeshLayer<'a> {
        MeshLayer {
            mesh,
            colour: [200, 204, 210, 255],
            colours: None,
            inside: None,
            crease: 30.0,
            edges: MeshEdges::None,
            edge_width: 1.0,
            edge_colour: [30, 30, 30, 255],
        }
    }

    /// Sets the colour: red, green, blue (sRGB) and opacity. Through a mesh that is not opaque, all faces
    /// behind are visible.
    #[must_use]
    pub fn colour(self, colour: [u8; 4]) -> MeshLayer<'a> {
        MeshLayer { colour, ..self }
    }

    /// Sets a colour for each triangle of the mesh.
    #[must_use]
    pub fn triangle_colours(self, colours: &'a [[u8; 4]]) -> MeshLayer<'a> {
        MeshLayer { colours: Some(colours), ..self }
    }

    /// Sets the colour of back faces. By default it is the face's own colour mixed with vermilion.
    #[must_use]
    pub fn inside(self, colour: [u8; 4]) -> MeshLayer<'a> {
        MeshLayer { inside: Some(colour), ..self }
    }

    /// Makes the mesh smooth where triangles meet at less than an angle in degrees, 0 to 180. With 0 every
    /// triangle is flat.
    #[must_use]
    pub fn crease(self, degrees: f64) -> MeshLayer<'a> {
        MeshLayer { crease: degrees, ..self }
    }

    /// Draws edges as lines of a width in pixels (above 0, at most 256) and a colour.
    #[must_use]
    pub fn edges(self, edges: MeshEdges, width: f64, colour: [u8; 4]) -> MeshLayer<'a> {
        MeshLayer { edges, edge_width: width, edge_colour: colour, ..self }
    }
}

impl Draw for MeshLayer<'_> {
    /// # Errors
    /// [`Error::Argument`] unless the crease angle is 0 to 180, the width of lines is above 0 and at most
    /// 256, and there are as many colours as triangles.
    fn prepare<'a>(&'a self, stage: &Stage<'a>) -> Result<Box<dyn Painter + 'a>, Error> {
        let mesh = self.mesh;
        check_width(self.edge_width)?;
        if !(0.0..=180.0).contains(&self.crease) {
            return Err(Error::Argument { name: "crease", problem: "must be 0 to 180 degrees" });
        }
        if self.colours.is_some_and(|colours| colours.len() != mesh.triangles().len()) {
            return Err(Error::Argument { name: "colours", problem: "must be as many as triangles" });
        }
        let view = stage.view;
        let vertex = |v: usize| DVec3::from(mesh.vertices()[v]);
        let seen = mapped(stage.job, mesh.vertices().len(), |v| view.camera.seen(vertex(v)))?;
        let triangles = mesh.triangles();
        let bins = Bins::new([view.width, view.height], triangles.len(), stage.job, |i| {
            place(view, triangles[i].each(|v| seen[v as usize]))
        })?;
        let normals = crease::normals(mesh, stage.job)?;
        let smooth = match self.crease {
            0.0 => None,
            crease => Some(crease::corner_normals(mesh, &normals, crease, stage.job)?),
        };
        let edges = match self.edges {
            MeshEdges::None => Vec::new(),
            MeshEdges::Features => {
                let edges = crease::features(mesh, &normals, self.crease, stage.job)?;
                mapped(stage.job, edges.len(), |i| (edges[i], 1.0))?
            }
            MeshEdges::All => {
                let opacities = mapped(stage.job, triangles.len(), |i| {
                    edge_opacity(view, triangles[i].each(|v| seen[v as usize]))
                })?;
                // The edge between a large and a small triangle is visible.
                crease::edges(mesh, stage.job, |edge| {
                    let opacity = edge.triangles().map(|i| opacities[i as usize]).fold(0.0, f32::max);
                    (opacity > 0.0).then_some(([edge.low, edge.high], opacity))
                })?
            }
        };
        let lines = edges.into_iter().map(|(ends, opacity)| (ends.each(|v| vertex(v as usize)), opacity));
        let edges = Strokes::new(stage, lines, self.edge_width, Light::of(self.edge_colour))?;
        // The coordinates of the outermost samples: x and y of a line of sight with length 1 along the view.
        let reach = [view.width, view.height].each(|side| 0.5 * f64::from(side) * view.pixel_at(1.0));
        let lights = lights(self.colour, self.inside);
        Ok(Box::new(Ready { layer: self, stage: *stage, seen, bins, normals, smooth, edges, reach, lights }))
    }
}

/// The place of a triangle in the picture: the least x and y and the greatest ones, in pixels; these may be
/// infinite. `None` if the triangle lies behind the eye.
fn place(view: &View, corners: [DVec3; 3]) -> Option<[f64; 4]> {
    const NOWHERE: [f64; 4] = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    let is_before = |corner: &DVec3| corner.z > 0.0;
    if !corners.iter().any(is_before) {
        return None;
    }
    if corners.iter().all(is_before) || !view.is_perspective() {
        let [a, b, c] = corners.each(|corner| view.place(corner));
        if [a, b, c].iter().flatten().all(|x| x.is_finite()) {
            let least = |axis: usize| a[axis].min(b[axis]).min(c[axis]);
            let most = |axis: usize| a[axis].max(b[axis]).max(c[axis]);
            return Some([least(0), least(1), most(0), most(1)]);
        }
    }
    let mut hull = NOWHERE;
    let mut add = |[x, y]: [f64; 2]| {
        // NaN may be anywhere.
        let anywhere = |x: f64| if x.is_nan() { [f64::NEG_INFINITY, f64::INFINITY] } else { [x; 2] };
        let (x, y) = (anywhere(x), anywhere(y));
        hull = [hull[0].min(x[0]), hull[1].min(y[0]), hull[2].max(x[1]), hull[3].max(y[1])];
    };
    if !view.is_perspective() {
        corners.iter().for_each(|&corner| add(view.place(corner)));
        return Some(hull);
    }
    for (i, &corner) in corners.iter().enumerate() {
        if is_before(&corner) {
            add(view.place(corner));
        }
        let next = corners[(i + 1) % 3];
        if is_before(&corner) != is_before(&next) {
            // The edge leads to infinity, in the direction of its point in the plane of the eye. A nearly
            // zero component may have either sign.
            let (a, b) = (corner * next.z, next * corner.z);
            let to = (b - a) * if is_before(&corner) { 1.0 } else { -1.0 };
            let most = 1e-12 * (a.abs() + b.abs());
            let far = |to: f64, most: f64, up: f64| match () {
                () if to > most => up * f64::INFINITY,
                () if to < -most => -up * f64::INFINITY,
                () => f64::NAN,
            };
            add([far(to.x, most.x, 1.0), far(to.y, most.y, -1.0)]);
        }
    }
    Some(hull)
}

/// The opacity of the edges of a triangle, by its size in the picture: 0 to 1.
fn edge_opacity(view: &View, corners: [DVec3; 3]) -> f32 {
    if view.is_perspective() && corners.iter().any(|corner| corner.z <= 0.0) {
        return 1.0;
    }
    let [a, b, c] = corners.each(|corner| DVec2::from(view.place(corner)));
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    // (A triangle that is seen as a point has no height.)
    let height = if longest > 0.0 { (b - a).perp_dot(c - a).abs() / longest } else { 0.0 };
    let opacity = (height - FADE[0]) / (FADE[1] - FADE[0]);
    // NaN counts as large.
    if opacity.is_nan() { 1.0 } else { opacity.clamp(0.0, 1.0) as f32 }
}

/// A mesh that is ready to be drawn.
struct Ready<'a> {
    layer: &'a MeshLayer<'a>,
    stage: Stage<'a>,
    /// The vertices in the camera's own coordinates.
    seen: Vec<DVec3>,
    bins: Bins,
    normals: Vec<DVec3>,
    /// The normals at the corners of each triangle, unless all triangles are flat.
    smooth: Option<Vec<[Vec3; 3]>>,
    edges: Strokes,
    reach: [f64; 2],
    /// The colours of front and back faces, unless each triangle has a colour of its own.
    lights: [Light; 2],
}

/// The data of a tile's samples that all triangles need.
struct Samples {
    /// x and y of the lines of sight, with length 1 along the view.
    columns: Vec<f64>,
    rows: Vec<f64>,
    /// The depths between which each line of sight is shown; empty if nothing is cut away.
    shown: Vec<[f64; 2]>,
}

impl Samples {
    fn new(tile: &Tile<'_>, stage: &Stage<'_>) -> Result<Samples, Error> {
        let view = stage.view;
        let (pixel, [width, height]) = (view.pixel_at(1.0), [view.width, view.height].each(f64::from));
        let columns = (0..tile.width()).map(|column| (tile.place(column, 0)[0] - 0.5 * width) * pixel);
        let rows = (0..tile.height()).map(|row| (0.5 * height - tile.place(0, row)[1]) * pixel);
        let (columns, rows) = (memory::collected(columns)?, memory::collected(rows)?);
        let mut shown = Vec::new();
        if !stage.clip.is_empty() {
            shown = memory::with_capacity(columns.len() * rows.len())?;
            for row in 0..tile.height() {
                for column in 0..tile.width() {
                    let (from, along) = tile.line(column, row);
                    shown.push(stage.clip.shown(from, along).map_or(NOTHING, |shown| [shown.from, shown.to]));
                }
            }
        }
        Ok(Samples { columns, rows, shown })
    }

    /// Returns whether something at a depth is shown.
    #[inline(always)]
    fn shows(&self, sample: usize, depth: f64) -> bool {
        self.shown.get(sample).is_none_or(|&shown| holds(shown, depth))
    }
}

/// An empty range of depths.
const NOTHING: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

impl Painter for Ready<'_> {
    fn paint(&self, tile: &mut Tile<'_>) -> Result<(), Error> {
        let triangles = self.bins.of(tile)?;
        if !triangles.is_empty() {
            let samples = Samples::new(tile, &self.stage)?;
            for (n, &i) in triangles.iter().enumerate() {
                if n % 4096 == 0 {
                    self.stage.job.check()?;
                }
                self.draw(tile, &samples, i as usize)?;
            }
        }
        self.edges.paint(tile)
    }
}

impl Ready<'_> {
    fn draw(&self, tile: &mut Tile<'_>, samples: &Samples, i: usize) -> Result<(), Error> {
        let mesh = self.layer.mesh;
        let view = self.stage.view;
        let corners = mesh.triangles()[i].each(|v| self.seen[v as usize]);
        let Some([left, top, right, bottom]) = place(view, corners) else { return Ok(()) };
        // Rounding moves nothing by this much.
        const MARGIN: f64 = 1e-3;
        let columns = tile.between(0, left - MARGIN, right + MARGIN);
        let rows = tile.between(1, top - MARGIN, bottom + MARGIN);
        if columns.is_empty() || rows.is_empty() {
            return Ok(());
        }
        let flat = |corner: DVec3| if view.is_perspective() { corner } else { corner.with_z(1.0) };
        let Some(coverage) = Coverage::new(corners.each(flat), self.reach) else { return Ok(()) };
        let depths = corners.each(|corner| corner.z);
        let mut shade = None;
        let first = [samples.columns[0], view.pixel_at(1.0) / f64::from(tile.grid)];
        for row in rows {
            let y = samples.rows[row];
            for column in coverage.columns(y, first, columns.clone()) {
                let Some(weights) = coverage.weights(samples.columns[column], y) else { continue };
                let depth = weights[0] * depths[0] + weights[1] * depths[1] + weights[2] * depths[2];
                let sample = row * tile.width() + column;
                let is_seen = depth > 0.0 && depth < tile.opaque[sample].depth;
                if is_seen && samples.shows(sample, depth) {
                    let shade = shade.get_or_insert_with(|| Shade::new(self, i, coverage.facing > 0));
                    let light = shade.light(self, tile, [column, row], weights);
                    tile.put(sample, depth, light)?;
                }
            }
        }
        Ok(())
    }

    fn brightness(&self, normal: DVec3) -> f32 {
        // The triangle faces the eye, even if the rounded normal of an edge-on triangle says otherwise.
        self.stage.view.lamps.brightness(normal, -normal)
    }
}

/// The colours of front and back faces.
fn lights(colour: [u8; 4], inside: Option<[u8; 4]>) -> [Light; 2] {
    let own = Light::of(colour);
    let mixed = || own * 0.5 + Light::of(INSIDE) * (0.5 * own.0.w);
    [own, inside.map_or_else(mixed, Light::of)]
}

/// The light that comes from a triangle.
enum Shade<'a> {
    /// The same light from all of it.
    Flat(Light),
    /// The colour, the normals at the corners, and the sign with which they face the eye.
    Smooth(Light, &'a [Vec3; 3], f64),
}

impl<'a> Shade<'a> {
    fn new(mesh: &'a Ready<'_>, i: usize, is_front: bool) -> Shade<'a> {
        let layer = mesh.layer;
        let lights = match layer.colours {
            Some(colours) => lights(colours[i], layer.inside),
            None => mesh.lights,
        };
        let colour = lights[usize::from(!is_front)];
        let facing = if is_front { 1.0 } else { -1.0 };
        if let Some(smooth) = &mesh.smooth {
            let [a, b, c] = &smooth[i];
            if a != b || b != c {
                return Shade::Smooth(colour, &smooth[i], facing);
            }
        }
        let normal = match mesh.normals[i] {
            // A triangle without area is only visible by rounding.
            DVec3::ZERO => -DVec3::from(mesh.stage.view.camera.forward()),
            normal => normal * facing,
        };
        Shade::Flat(colour.lit(mesh.brightness(normal)))
    }

    #[inline]
    fn light(
        &self,
        mesh: &Ready<'_>,
        tile: &Tile<'_>,
        [column, row]: [usize; 2],
        weights: [f64; 3],
    ) -> Light {
        match self {
            Shade::Flat(light) => *light,
            Shade::Smooth(colour, corners, facing) => {
                let mean = |sum: DVec3, (normal, weight): (&Vec3, f64)| sum + normal.as_dvec3() * weight;
                let normal = corners.iter().zip(weights).fold(DVec3::ZERO, mean) * *facing;
                let (_, along) = tile.line(column, row);
                // A mean normal near the outline may face away from the eye, although the surface does not.
                let away = normal.dot(along).max(0.0) / along.length_squared();
                colour.lit(mesh.brightness(normal - along * away))
            }
        }
    }
}
