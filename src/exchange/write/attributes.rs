//! Attributes of a mesh in the form that files need.

use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use crate::mesh::{AttributeDomain, MeshAttribute, TriangleMesh};
use alloc::string::String;
use alloc::vec::Vec;

/// The colour of elements without a colour: transparent black.
const NOTHING: [u8; 4] = [0; 4];

/// Returns a colour of three or four numbers from 0 to 255, rounded to whole numbers.
fn colour(attribute: &MeshAttribute, triangle: usize, corner: usize) -> Option<[u8; 4]> {
    let [r, g, b, a] = attribute.value(triangle, corner)?;
    let a = if attribute.components() == 3 { 255.0 } else { a };
    // (Numbers out of range are clamped.)
    Some([r, g, b, a].each(|channel| (channel + 0.5) as u8))
}

/// Returns an attribute if it is a colour.
fn colours<'a>(mesh: &'a TriangleMesh, name: &str) -> Option<&'a MeshAttribute> {
    mesh.attribute(name).filter(|attribute| attribute.components() >= 3)
}

/// Returns the colours of the three corners of triangles: `colour`, or else `face_colour`.
#[cfg(feature = "threemf")]
pub(super) fn of_corners<'a>(mesh: &'a TriangleMesh) -> Option<impl Fn(usize) -> Option<[[u8; 4]; 3]> + 'a> {
    let found = colours(mesh, "colour").or_else(|| colours(mesh, "face_colour"))?;
    Some(move |triangle| {
        let [a, b, c] = [0, 1, 2].each(|corner| colour(found, triangle, corner));
        Some([a?, b?, c?])
    })
}

/// The colours of a PLY.
pub(super) struct Palette {
    /// A colour for each vertex, if corners have colours: that of the first corner at the vertex.
    pub vertices: Option<Vec<[u8; 4]>>,
    /// A colour for each triangle.
    pub faces: Option<Vec<[u8; 4]>>,
}

impl Palette {
    pub fn of(mesh: &TriangleMesh) -> Result<Palette, Error> {
        let is_of_corners = |attribute: &&MeshAttribute| attribute.domain() == AttributeDomain::Corner;
        let corners = colours(mesh, "colour").filter(is_of_corners);
        let faces = match corners {
            Some(_) => colours(mesh, "face_colour"),
            None => colours(mesh, "colour").or_else(|| colours(mesh, "face_colour")),
        };
        let count = mesh.triangles().len();
        let mut vertices = None;
        if let Some(attribute) = corners {
            let mut found = memory::filled(mesh.vertices().len(), None)?;
            for (triangle, corners) in mesh.triangles().iter().enumerate() {
                for (corner, &vertex) in corners.iter().enumerate() {
                    let place = &mut found[vertex as usize];
                    *place = place.or_else(|| colour(attribute, triangle, corner));
                }
            }
            vertices = Some(memory::collected(found.into_iter().map(|colour| colour.unwrap_or(NOTHING)))?);
        }
        let of = |attribute: &MeshAttribute| {
            memory::collected((0..count).map(|triangle| colour(attribute, triangle, 0).unwrap_or(NOTHING)))
        };
        Ok(Palette { vertices, faces: faces.map(of).transpose()? })
    }
}

/// Returns a name without line ends, which is not empty.
pub(super) fn line_of(name: &str, number: usize) -> Result<String, Error> {
    let name = name.trim();
    if name.is_empty() {
        let mut text = String::new();
        text.try_reserve(32)?;
        let _ = core::fmt::Write::write_fmt(&mut text, format_args!("material_{number}"));
        return Ok(text);
    }
    let mut text = String::new();
    text.try_reserve_exact(name.len())?;
    let mut last = 'x';
    for c in name.chars() {
        let is_strange = c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}');
        // (A blank and `#` begin a comment.)
        let c = if is_strange {
            ' '
        } else if c == '#' && last.is_whitespace() {
            '_'
        } else {
            c
        };
        text.push(c);
        last = c;
    }
    Ok(text)
}

/// The materials of triangles, and their names.
pub(super) struct Materials<'a> {
    attribute: &'a MeshAttribute,
    pub names: Vec<String>,
}

impl<'a> Materials<'a> {
    /// Returns the materials of a mesh; `None` if it has none. The first `MOST` numbers have names.
    pub fn of(mesh: &'a TriangleMesh) -> Result<Option<Materials<'a>>, Error> {
        /// Number of materials that get their number as a name, if they have none.
        const MOST: usize = 1 << 16;
        let Some(attribute) = mesh.attribute("material").filter(|attribute| attribute.components() == 1)
        else {
            return Ok(None);
        };
        let given = attribute.names();
        let mut found = Materials { attribute, names: Vec::new() };
        let greatest =
            (0..attribute.len()).filter_map(|triangle| attribute.value(triangle, 0)).map(|value| value[0]);
        let greatest = greatest.fold(-1.0, f64::max);
        let count = given.len().max(if greatest < MOST as f64 { (greatest + 1.0) as usize } else { 0 });
        for number in 0..count {
            let name = line_of(given.get(number).map_or("", String::as_str), number)?;
            memory::push(&mut found.names, name)?;
        }
        Ok(Some(found))
    }

    /// Returns the material of a triangle.
    pub fn get(&self, triangle: usize) -> Option<usize> {
        let number = self.attribute.value(triangle, 0)?[0];
        let is_whole =
            number >= 0.0 && (number as usize) < self.names.len() && number as usize as f64 == number;
        is_whole.then_some(number as usize)
    }
}
