//! Values at points: of a channel, a volume, or the colours, materials and bodies of a mesh.

use crate::failure::{Failure, Of};
use crate::source::content::Content;
use crate::source::input::Input;
use crate::source::volume::Sampling;
use leafless::attribute::{Attribute, Channel, Interpolation, ScalarType, SurfaceAttribute};
use leafless::exchange::{self, MeshOptions};
use leafless::mesh::MeshAttribute;
use leafless::{Metadata, Octree, TriangleMesh};

/// Values at points, with the suitable type and their metadata.
pub struct Values {
    pub attribute: Box<dyn Attribute>,
    pub kind: Option<ScalarType>,
    pub metadata: Metadata,
}

impl Values {
    /// Returns values without metadata.
    pub fn plain(attribute: Box<dyn Attribute>) -> Values {
        Values { attribute, kind: None, metadata: Metadata::new() }
    }

    /// Returns the numbers of the bodies of a mesh.
    pub fn of_bodies(input: &Input, octree: &Octree) -> Result<Values, Failure> {
        let mesh = mesh(input, &input.read()?, octree)?;
        let labels = mesh.bodies().and_then(|labels| MeshAttribute::labels("body", labels)).of(input)?;
        let attribute = SurfaceAttribute::new(mesh, labels).of(input)?;
        Ok(Values { kind: Some(ScalarType::U32), ..Values::plain(Box::new(attribute)) })
    }

    /// Returns the values in a file, for a channel of this name. The user may `pick` one of the attributes of
    /// a mesh.
    pub fn of_file(
        from: &Input,
        name: &str,
        pick: Option<&str>,
        sampling: &Sampling,
        interpolation: Interpolation,
        octree: &Octree,
    ) -> Result<Values, Failure> {
        if from.begins_as_solid() {
            let (other, _) = from.octree(true)?;
            let channel = find(&other, from, Some(name))?.clone();
            let (kind, metadata) = (channel.value_type().scalar(), channel.metadata().clone());
            return Ok(Values { attribute: Box::new(channel), kind: Some(kind), metadata });
        }
        let bytes = from.read()?;
        match Content::of(from, &bytes, sampling.is_raw().then_some(Content::Volume))? {
            Content::Volume => {
                let voxels = sampling.read_values(from, &bytes)?;
                Ok(Values::plain(voxels.attribute(interpolation).of(from)?))
            }
            Content::Mesh => {
                let mesh = mesh(from, &bytes, octree)?;
                let known: Vec<&str> = mesh.attributes().iter().map(MeshAttribute::name).collect();
                let name = match (pick, &known[..]) {
                    (_, []) => return Err(Failure::of(from, "has neither colours nor materials")),
                    (Some(pick), _) if known.contains(&pick) => pick.to_owned(),
                    (None, known) if known.contains(&name) => name.to_owned(),
                    (None, [only]) => (*only).to_owned(),
                    _ => {
                        let list = known.join(", ");
                        return Err(Failure::Usage(format!(
                            "choose one of {from}'s values with --pick: {list}"
                        )));
                    }
                };
                // Numbers of colours go from 0 to 255.
                let kind = if name.ends_with("colour") { ScalarType::U8 } else { ScalarType::F32 };
                let mut metadata = Metadata::new();
                metadata.insert("meaning", &*name);
                let picked = mesh.attributes().iter().find(|attribute| attribute.name() == name);
                for (number, name) in picked.map_or(&[][..], MeshAttribute::names).iter().enumerate() {
                    metadata.insert(format!("value {number}"), &**name);
                }
                let attribute = SurfaceAttribute::of_mesh(mesh, &name).of(from)?;
                Ok(Values { attribute: Box::new(attribute), kind: Some(kind), metadata })
            }
            _ => {
                let problem = "is no volume (NRRD, MetaImage, raw), no mesh with colours or materials, and no solid (.lfl)";
                Err(Failure::of(from, problem))
            }
        }
    }
}

/// Reads a mesh, converted to the unit of a solid if both units are known.
fn mesh(input: &Input, bytes: &[u8], octree: &Octree) -> Result<TriangleMesh, Failure> {
    let file = exchange::read_mesh(bytes, &MeshOptions::default()).of(input)?;
    let unit = octree.metadata().get("units").and_then(|unit| unit.parse().ok());
    let target = file.unit.and(unit).filter(|&unit| Some(unit) != file.unit);
    let mesh = match target {
        Some(_) => {
            exchange::read_mesh(bytes, &MeshOptions { target, ..MeshOptions::default() }).of(input)?.mesh
        }
        None => file.mesh,
    };
    mesh.sewn().of(input)
}

/// Returns the channel of a solid that the user names; without a name, the only one.
pub fn find<'o>(octree: &'o Octree, input: &Input, name: Option<&str>) -> Result<&'o Channel, Failure> {
    let known: Vec<&str> = octree.channels().iter().map(Channel::name).collect();
    let list = known.join(", ");
    match (name, octree.channels()) {
        (_, []) => Err(Failure::of(input, "has no channel; `leafless attribute` makes one")),
        (None, [only]) => Ok(only),
        (None, _) => {
            Err(Failure::Usage(format!("{input} has several channels: name one of them with --name: {list}")))
        }
        (Some(name), _) => octree
            .channel(name)
            .ok_or_else(|| Failure::of(input, format!("has no channel \"{name}\". It has {list}"))),
    }
}
