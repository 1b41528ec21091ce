//! Writer of Wavefront OBJ.

use super::WriteOptions;
use super::attributes::Materials;
use super::lines::{Lines, Point};
use crate::error::Error;
use crate::exchange::stated::Line;
use crate::lattice::Each;
use crate::mesh::TriangleMesh;
use alloc::vec::Vec;

pub(super) fn write(mesh: &TriangleMesh, options: &WriteOptions) -> Result<Vec<u8>, Error> {
    let mut lines = Lines::default();
    if let Some(deviation) = options.deviation {
        lines.add(format_args!("{}", Line("# ", deviation)))?;
    }
    for &vertex in mesh.vertices() {
        lines.add(format_args!("v {}\n", Point(vertex)))?;
    }
    if options.normals {
        for normal in mesh.vertex_normals()? {
            lines.add(format_args!("vn {}\n", Point(normal.each(|x| x as f32))))?;
        }
    }
    let (materials, mut current) = (Materials::of(mesh)?, None);
    for (number, triangle) in mesh.triangles().iter().enumerate() {
        if let Some(materials) = &materials {
            let next = materials.get(number);
            match next {
                Some(material) if next != current => {
                    lines.add(format_args!("usemtl {}\n", materials.names[material]))?;
                }
                None if next != current => lines.add(format_args!("usemtl\n"))?,
                _ => {}
            }
            current = next;
        }
        let [a, b, c] = triangle.each(|v| u64::from(v) + 1);
        if options.normals {
            lines.add(format_args!("f {a}//{a} {b}//{b} {c}//{c}\n"))?;
        } else {
            lines.add(format_args!("f {a} {b} {c}\n"))?;
        }
    }
    Ok(lines.bytes())
}
