//! Writer of Stanford PLY.

use super::WriteOptions;
use super::attributes::{Palette, line_of};
use super::lines::{Lines, Point};
use crate::error::Error;
use crate::exchange::stated::Line;
use crate::lattice::Each;
use crate::memory;
use crate::mesh::{AttributeDomain, MeshAttribute, TriangleMesh};
use alloc::vec::Vec;

const CHANNELS: [&str; 4] = ["red", "green", "blue", "alpha"];

/// The data of a mesh that a file contains.
struct Content<'a> {
    mesh: &'a TriangleMesh,
    normals: Vec<[f32; 3]>,
    palette: Palette,
    /// Attributes that become properties of faces.
    values: Vec<&'a MeshAttribute>,
}

pub(super) fn write(mesh: &TriangleMesh, options: &WriteOptions) -> Result<Vec<u8>, Error> {
    let normals = if options.normals {
        memory::collected(mesh.vertex_normals()?.iter().map(|normal| normal.each(|x| x as f32)))?
    } else {
        Vec::new()
    };
    let mut values = Vec::new();
    for attribute in mesh.attributes() {
        if attribute.domain() == AttributeDomain::Triangle && is_property(attribute.name()) {
            memory::push(&mut values, attribute)?;
        }
    }
    let content = Content { mesh, normals, palette: Palette::of(mesh)?, values };
    let mut lines = Lines::default();
    content.head(options, &mut lines)?;
    if options.text {
        content.text(&mut lines)?;
        return Ok(lines.bytes());
    }
    content.binary(lines.bytes())
}

#[cfg(feature = "std")]
fn is_property(name: &str) -> bool {
    use crate::exchange::declared;
    declared::is_property(name) && !declared::is_taken(name)
}

/// (Without the readers the properties would be of no use.)
#[cfg(not(feature = "std"))]
fn is_property(_: &str) -> bool {
    false
}

/// Returns the label of a triangle. The greatest label means none, as in the mesh.
fn label(attribute: &MeshAttribute, triangle: usize) -> u32 {
    attribute.value(triangle, 0).map_or(MeshAttribute::NO_ROW, |value| value[0] as u32)
}

/// Returns the numbers of a value; NaNs if there is none.
fn numbers(attribute: &MeshAttribute, triangle: usize) -> [f64; 4] {
    attribute.value(triangle, 0).unwrap_or([f64::NAN; 4])
}

impl Content<'_> {
    fn head(&self, options: &WriteOptions, lines: &mut Lines) -> Result<(), Error> {
        let Content { mesh, palette, values, .. } = self;
        let encoding = if options.text { "ascii" } else { "binary_little_endian" };
        lines.add(format_args!("ply\nformat {encoding} 1.0\n"))?;
        if let Some(deviation) = options.deviation {
            lines.add(format_args!("{}", Line("comment ", deviation)))?;
        }
        for attribute in values {
            let name = attribute.name();
            lines.add(format_args!("comment leafless attribute {} {name}\n", attribute.components()))?;
            for (number, text) in attribute.names().iter().enumerate().filter(|_| attribute.is_label()) {
                lines.add(format_args!("comment leafless name {name} {}\n", line_of(text, number)?))?;
            }
        }
        let vertices = mesh.vertices().len();
        lines.add(format_args!(
            "element vertex {vertices}\nproperty double x\nproperty double y\nproperty double z\n"
        ))?;
        if options.normals {
            lines.add(format_args!("property float nx\nproperty float ny\nproperty float nz\n"))?;
        }
        let colour = |lines: &mut Lines| {
            CHANNELS.iter().try_for_each(|channel| lines.add(format_args!("property uchar {channel}\n")))
        };
        if palette.vertices.is_some() {
            colour(lines)?;
        }
        lines.add(format_args!(
            "element face {}\nproperty list uchar {} vertex_indices\n",
            mesh.triangles().len(),
            // Some programs read only the type `int`; only the largest meshes need another type.
            if vertices <= i32::MAX as usize { "int" } else { "uint" },
        ))?;
        if palette.faces.is_some() {
            colour(lines)?;
        }
        for attribute in values {
            let name = attribute.name();
            match (attribute.is_label(), attribute.components()) {
                (true, _) => lines.add(format_args!("property uint {name}\n"))?,
                (false, 1) => lines.add(format_args!("property double {name}\n"))?,
                (false, count) => (0..count)
                    .try_for_each(|number| lines.add(format_args!("property double {name}_{number}\n")))?,
            }
        }
        lines.add(format_args!("end_header\n"))
    }

    fn text(&self, lines: &mut Lines) -> Result<(), Error> {
        let Content { mesh, normals, palette, values } = self;
        let colour = |lines: &mut Lines, colours: &Option<Vec<[u8; 4]>>, place: usize| match colours {
            Some(colours) => {
                let [r, g, b, a] = colours[place];
                lines.add(format_args!(" {r} {g} {b} {a}"))
            }
            None => Ok(()),
        };
        for (place, &vertex) in mesh.vertices().iter().enumerate() {
            lines.add(format_args!("{}", Point(vertex)))?;
            if let Some(&normal) = normals.get(place) {
                lines.add(format_args!(" {}", Point(normal)))?;
            }
            colour(lines, &palette.vertices, place)?;
            lines.add(format_args!("\n"))?;
        }
        for (place, [a, b, c]) in mesh.triangles().iter().enumerate() {
            lines.add(format_args!("3 {a} {b} {c}"))?;
            colour(lines, &palette.faces, place)?;
            for attribute in values {
                if attribute.is_label() {
                    lines.add(format_args!(" {}", label(attribute, place)))?;
                    continue;
                }
                for number in &numbers(attribute, place)[..attribute.components()] {
                    lines.add(format_args!(" {}", super::lines::Number(*number)))?;
                }
            }
            lines.add(format_args!("\n"))?;
        }
        Ok(())
    }

    fn binary(&self, mut bytes: Vec<u8>) -> Result<Vec<u8>, Error> {
        let Content { mesh, normals, palette, values } = self;
        let of_colours = |colours: &Option<Vec<[u8; 4]>>| if colours.is_some() { 4 } else { 0 };
        let size = |attribute: &&MeshAttribute| {
            if attribute.is_label() { 4 } else { 8 * attribute.components() }
        };
        let of_vertex = 24 + if normals.is_empty() { 0 } else { 12 } + of_colours(&palette.vertices);
        let of_face = 13 + of_colours(&palette.faces) + values.iter().map(size).sum::<usize>();
        let of_vertices = mesh.vertices().len().checked_mul(of_vertex);
        let length = of_vertices.zip(mesh.triangles().len().checked_mul(of_face));
        let length = length.and_then(|(a, b)| a.checked_add(b)).ok_or(Error::OutOfMemory)?;
        bytes.try_reserve_exact(length)?;
        for (place, vertex) in mesh.vertices().iter().enumerate() {
            vertex.iter().for_each(|x| bytes.extend_from_slice(&x.to_le_bytes()));
            for x in normals.get(place).into_iter().flatten() {
                bytes.extend_from_slice(&x.to_le_bytes());
            }
            if let Some(colours) = &palette.vertices {
                bytes.extend_from_slice(&colours[place]);
            }
        }
        for (place, triangle) in mesh.triangles().iter().enumerate() {
            bytes.push(3);
            for v in triangle {
                bytes.extend_from_slice(&v.to_le_bytes());
            }
            if let Some(colours) = &palette.faces {
                bytes.extend_from_slice(&colours[place]);
            }
            for attribute in values {
                if attribute.is_label() {
                    bytes.extend_from_slice(&label(attribute, place).to_le_bytes());
                    continue;
                }
                for number in &numbers(attribute, place)[..attribute.components()] {
                    bytes.extend_from_slice(&number.to_le_bytes());
                }
            }
        }
        Ok(bytes)
    }
}
