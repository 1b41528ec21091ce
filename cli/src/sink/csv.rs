//! Voxel records as lines of text, a header first.

use crate::words::push_number;
use leafless::voxel::{VoxelRecordsRef, VoxelTriangles};
use std::fmt::Write as _;
use std::io::{self, Write};

/// Writes one line for each record. With `triangles` it ends with the numbers of the triangles that meet the
/// voxel.
pub fn write(
    view: &VoxelRecordsRef<'_>,
    triangles: Option<&VoxelTriangles>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let mut line = String::from("kind,level,code,x,y,z,edge");
    for component in 0..view.components() {
        let _ = write!(line, ",value{component}");
    }
    line.push_str(if triangles.is_some() { ",triangles\n" } else { "\n" });
    for (index, record) in view.iter().enumerate() {
        out.write_all(line.as_bytes())?;
        line.clear();
        let _ = write!(line, "{},{},", record.kind.name(), record.cell.level);
        if let Some(code) = view.code(index) {
            let _ = write!(line, "{code}");
        }
        for x in view.corner(index).unwrap_or_default().into_iter().chain(view.edge(index)) {
            line.push(',');
            push_number(&mut line, x);
        }
        for &x in &view.values()[index * view.components()..][..view.components()] {
            line.push(',');
            if x.is_nan() {
                line.push_str("nan");
            } else {
                push_number(&mut line, x);
            }
        }
        if let Some(found) = triangles {
            line.push(',');
            for (k, triangle) in found.of(index).iter().enumerate() {
                let _ = write!(line, "{}{triangle}", if k == 0 { "" } else { " " });
            }
        }
        line.push('\n');
    }
    out.write_all(line.as_bytes())
}
