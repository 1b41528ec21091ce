//! Values of solids on the triangles of their surfaces: channels, materials, colours.

use crate::failure::{Failure, Of};
use crate::progress::watched;
use crate::source::input::Input;
use crate::source::mesh::format_name;
use crate::source::solid::{Shape, Source};
use crate::source::values::find;
use leafless::attribute::{Attribute, Channel, SurfaceAttribute, dexel_materials, sample_triangles};
use leafless::exchange::MeshFormat;
use leafless::mesh::MeshAttribute;
use leafless::op::octree_from_dexels;
use leafless::{Error, TriangleMesh};

/// The values for the triangles of a surface.
pub struct Bearing {
    attribute: Box<dyn Attribute>,
    name: String,
    /// The distance behind a triangle at which its value is taken (model units).
    depth: f64,
    /// The names of materials by number.
    names: Vec<String>,
}

/// Material numbers beyond this one have no names.
const NAMES: usize = 1 << 16;

impl Bearing {
    /// Finds the values of a solid under a name.
    pub fn of(shape: &Shape, input: &Input, name: &str, threads: usize) -> Result<Bearing, Failure> {
        match shape {
            Shape::Source(Source::Octree(octree)) => {
                Ok(Bearing::of_channel(find(octree, input, Some(name))?.clone()))
            }
            Shape::Dexels(_) if name != "material" => {
                let problem = "is a tri-dexel model, which has no channel but \"material\"";
                Err(Failure::of(input, problem))
            }
            Shape::Dexels(model) => {
                let find = |control: &leafless::Control<'_>| {
                    let octree = octree_from_dexels(model.view(), control)?;
                    dexel_materials(model.view(), octree.view(), control)
                };
                let channel = watched("materials", threads, find).of(input)?;
                let problem = "stores no materials";
                Ok(Bearing::of_channel(channel.ok_or_else(|| Failure::of(input, problem))?))
            }
            Shape::Source(Source::Mesh(mesh, ..)) => {
                let Some(known) = mesh.attribute(name) else {
                    let all: Vec<&str> = mesh.attributes().iter().map(MeshAttribute::name).collect();
                    let problem = match all.is_empty() {
                        true => "has neither colours nor materials".to_owned(),
                        false => format!("has no values \"{name}\". It has {}", all.join(", ")),
                    };
                    return Err(Failure::of(input, problem));
                };
                let names = known.names().to_vec();
                let attribute = SurfaceAttribute::of_mesh(mesh.clone(), name).of(input)?;
                Ok(Bearing { attribute: Box::new(attribute), name: name.to_owned(), depth: 0.0, names })
            }
            Shape::Source(Source::Scene(_) | Source::Volume(_)) => {
                let problem = "has no channels: --channel is for solids, tri-dexel models and meshes";
                Err(Failure::of(input, problem))
            }
        }
    }

    fn of_channel(channel: Channel) -> Bearing {
        let value = |number: usize| channel.metadata().get(&format!("value {number}")).map(str::to_owned);
        let names = (0..NAMES).map_while(value).collect();
        let (name, depth) = (channel.name().to_owned(), 0.5 * channel.frame().cell_size());
        Bearing { attribute: Box::new(channel), name, depth, names }
    }

    /// Returns the name under which a format stores the values.
    pub fn called(&self, format: MeshFormat) -> Result<&str, Failure> {
        let is_colour = self.attribute.components() >= 3;
        Ok(match format {
            MeshFormat::Ply | MeshFormat::ThreeMf if is_colour => "colour",
            MeshFormat::Ply => &self.name,
            MeshFormat::Obj | MeshFormat::ThreeMf if self.attribute.components() == 1 => "material",
            _ => {
                let format = format_name(format).to_uppercase();
                return Err(Failure::Usage(format!(
                    "{format} has no place for the values of --channel {}: PLY has one for all, 3MF for colours and \
                     materials, OBJ for materials",
                    self.name
                )));
            }
        })
    }

    /// Returns the mesh with the values on its triangles.
    pub fn on(
        &self,
        mut mesh: TriangleMesh,
        format: MeshFormat,
        input: &Input,
        threads: usize,
    ) -> Result<TriangleMesh, Failure> {
        let name = self.called(format)?;
        let values = watched("values", threads, |control| {
            sample_triangles(&mesh, &*self.attribute, name, self.depth, control)
        });
        let values = values.of(input)?.named(self.names.clone());
        // (The values of an unchanged mesh have the name already.)
        let mut kept = mesh.take_attributes();
        kept.retain(|own| own.name() != name);
        let mut add = |attribute| -> Result<(), Error> { mesh.add_attribute(attribute) };
        kept.into_iter().try_for_each(&mut add).and_then(|()| add(values)).of(input)?;
        Ok(mesh)
    }
}
