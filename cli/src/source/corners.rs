//! Bounds of a solid from the vertices of its mesh.

use crate::failure::{Failure, Of};
use crate::source::input::Input;
use crate::source::mesh::openness;
use leafless::{FillRule, Interval, TriangleMesh};

/// The box around the triangles of a mesh.
pub struct Corners {
    min: [f64; 3],
    max: [f64; 3],
    /// Greatest distance of the surface from the mesh.
    displacement: f64,
    /// True if the solid does not extend beyond the box: an open mesh may enclose more.
    is_closed: bool,
    /// True if the solid reaches the box unless triangles intersect. Inverted bodies may be empty by the fill
    /// rule.
    is_reached: bool,
}

impl Corners {
    pub fn new(input: &Input, mesh: &TriangleMesh, fill: FillRule) -> Result<Corners, Failure> {
        let report = mesh.report().of(input)?;
        let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        // (Vertices that no triangle uses do not belong to the solid.)
        for &vertex in mesh.triangles().as_flattened() {
            let at = mesh.vertices()[vertex as usize];
            min = [0, 1, 2].map(|axis| min[axis].min(at[axis]));
            max = [0, 1, 2].map(|axis| max[axis].max(at[axis]));
        }
        let is_closed = openness(&report).is_none() && report.triangles > 0;
        let is_reached = fill != FillRule::Positive || report.inside_out_bodies == 0;
        Ok(Corners { min, max, displacement: mesh.displacement(), is_closed, is_reached })
    }

    /// True if the box is that of the solid, provided that the triangles do not intersect.
    pub fn are_exact(&self) -> bool {
        self.is_closed && self.is_reached
    }

    /// Returns the corners of the solid's bounding box, provided that the triangles do not intersect.
    pub fn exact(&self) -> [[Interval; 3]; 2] {
        [self.min, self.max].map(|corner| {
            corner.map(|at| match self.displacement {
                0.0 => Interval::exactly(at),
                moved => {
                    Interval::new((at - moved).next_down(), (at + moved).next_up()).unwrap_or(Interval::ALL)
                }
            })
        })
    }

    /// Returns the corners, restricted to the box of the mesh if the mesh is closed.
    pub fn within(&self, [min, max]: [[Interval; 3]; 2]) -> [[Interval; 3]; 2] {
        if !self.is_closed {
            return [min, max];
        }
        let [least, greatest] = self.exact();
        let at_least = |found: Interval, end: f64| Interval::new(found.lower.max(end), found.upper.max(end));
        let at_most = |found: Interval, end: f64| Interval::new(found.lower.min(end), found.upper.min(end));
        [
            [0, 1, 2].map(|axis| at_least(min[axis], least[axis].lower).unwrap_or(min[axis])),
            [0, 1, 2].map(|axis| at_most(max[axis], greatest[axis].upper).unwrap_or(max[axis])),
        ]
    }
}
