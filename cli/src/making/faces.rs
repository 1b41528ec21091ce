//! Faces of boundaries, for files of polygons and for reports.

use leafless::Error;
use leafless::exchange::{MeshFormat, WriteOptions, write_grouped_polygons};
use leafless::solid::SurfaceShape;
use leafless::surface::{Boundary, BoundaryFaces, BoundaryRegion};
use serde::Serialize;

/// The faces of a boundary, and the shapes of their surfaces.
pub struct Faces {
    faces: BoundaryFaces,
    /// The shape of each region's surface.
    shapes: Vec<Option<SurfaceShape>>,
}

/// The report on a region: a connected part of the boundary on one surface.
#[derive(Serialize)]
pub struct Region {
    /// Number of its surface; absent where the boundary is known to a cell only.
    surface: Option<u32>,
    #[serde(flatten)]
    shape: Shape,
    /// True if the normal of the surface points into the solid, as that of a bore does.
    turned: bool,
    triangles: u32,
    /// Number of polygons with holes: one for a plane region, otherwise one for each triangle.
    faces: usize,
    loops: u32,
    area: f64,
}

/// The kind of a surface, and its numbers.
#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
enum Shape {
    Plane { normal: [f64; 3], offset: f64 },
    Ball { centre: [f64; 3], radius: f64 },
    Cylinder { point: [f64; 3], axis: [f64; 3], radius: f64 },
    Cone { apex: [f64; 3], axis: [f64; 3], half_angle: f64 },
    Torus { centre: [f64; 3], axis: [f64; 3], major: f64, minor: f64 },
    Quadric { coefficients: [f64; 10] },
    Other,
}

impl From<SurfaceShape> for Shape {
    fn from(shape: SurfaceShape) -> Shape {
        match shape {
            SurfaceShape::Plane { normal, offset } => Shape::Plane { normal, offset },
            SurfaceShape::Ball { centre, radius } => Shape::Ball { centre, radius },
            SurfaceShape::Cylinder { point, axis, radius } => Shape::Cylinder { point, axis, radius },
            SurfaceShape::Cone { apex, axis, half_angle } => Shape::Cone { apex, axis, half_angle },
            SurfaceShape::Torus { centre, axis, major, minor } => Shape::Torus { centre, axis, major, minor },
            SurfaceShape::Quadric { coefficients } => Shape::Quadric { coefficients },
            _ => Shape::Other,
        }
    }
}

impl Faces {
    pub fn of(boundary: &Boundary) -> Result<Faces, Error> {
        let faces = boundary.faces()?;
        let shape = |region: &BoundaryRegion| {
            let surface = region.surface.and_then(|surface| boundary.surfaces().get(surface as usize));
            surface.map(|surface| surface.shape()).transpose()
        };
        let shapes = faces.regions().iter().map(shape).collect::<Result<_, Error>>()?;
        Ok(Faces { faces, shapes })
    }

    /// Returns the reports on the regions.
    pub fn regions(&self) -> Vec<Region> {
        let arrays = self.faces.arrays();
        let regions = self.faces.regions().iter().zip(&self.shapes);
        let region = |(region, shape): (&BoundaryRegion, &Option<SurfaceShape>)| Region {
            surface: region.surface,
            shape: shape.map_or(Shape::Other, Shape::from),
            turned: region.is_turned,
            triangles: region.triangles,
            faces: region.faces.len(),
            loops: arrays.faces[region.faces.end as usize] - arrays.faces[region.faces.start as usize],
            area: region.area,
        };
        regions.map(region).collect()
    }

    /// Returns a file of polygons. In an OBJ each region is a group, and all regions on one surface form
    /// another group.
    pub fn file(&self, format: MeshFormat, options: &WriteOptions) -> Result<Vec<u8>, Error> {
        let regions = self.faces.regions().iter().zip(&self.shapes).enumerate();
        let name = |(number, (region, shape)): (usize, (&BoundaryRegion, &Option<SurfaceShape>))| match (
            region.surface,
            shape,
        ) {
            (Some(surface), Some(shape)) => format!("face_{number} {}_{surface}", shape.name()),
            _ => format!("face_{number}"),
        };
        let names: Vec<String> = regions.map(name).collect();
        let starts = self.faces.regions().iter().map(|region| region.faces.start);
        let groups: Vec<(u32, &str)> = starts.zip(names.iter().map(String::as_str)).collect();
        write_grouped_polygons(&self.faces.arrays(), &groups, format, options)
    }
}
