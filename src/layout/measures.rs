//! The weight of a layout, and the filled part of the container.

use super::Layout;
use super::orientation::stretch;
use super::proof::{Near, Piece, diagonal};
use super::relative::Relative;
use super::wall::block_mesh;
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Affine, Bounds, Frame, Interval, MAX_DEPTH, axes};
use crate::memory;
use crate::query::{MassProperties, measure};
use crate::solid::{AnySolid, Csg, MeshSolid, Solid};

/// Measures of all placed copies together. All intervals contain the true values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayoutMeasures {
    /// The volume of all placed copies (cubic model units).
    pub volume: Interval,
    /// This volume divided by the container's volume.
    pub filled_part: Interval,
    /// The height of the highest point above the lower end of the container's bounds, along z (model units);
    /// 0 if nothing is placed.
    pub height: Interval,
    /// The mass, by the densities of the items.
    pub mass: Interval,
    /// The centre of gravity; `None` if nothing is placed, or an item may be empty.
    pub centroid: Option<[Interval; 3]>,
    /// The tensor of inertia about the origin of the model.
    pub inertia_about_origin: [[Interval; 3]; 3],
    /// The tensor of inertia about the centre of gravity; about the origin if there is none.
    pub inertia_about_centroid: [[Interval; 3]; 3],
}

const ZERO: Interval = Interval::exactly(0.0);

/// A placed body: its volume, its centroid, and ∫ (x − c)(x − c)ᵀ about the centroid c.
struct Body {
    density: Interval,
    volume: Interval,
    centroid: [Interval; 3],
    second: [[Interval; 3]; 3],
}

impl Layout {
    /// Returns the measures of all placed copies. Each item and the container are measured once by
    /// [`measure`], to a relative tolerance of their volumes. The volume of an overlap counts twice.
    ///
    /// # Errors
    /// As [`measure`].
    pub fn measures(&self, tolerance: f64, control: &Control<'_>) -> Result<LayoutMeasures, Error> {
        let job = Job::new(control);
        let own = &Control { progress: None, ..*control };
        let container = measured(self.container.solid(), self.container.bounds(), tolerance, own)?;
        let share = WHOLE / (self.items.len() + 1);
        let mut items = memory::with_capacity(self.items.len())?;
        for item in &self.items {
            let is_placed = self.placed.iter().any(|placed| placed.item == items.len());
            items.push(match is_placed {
                true => Some(measured(&item.solid, &item.bounds, tolerance, own)?),
                false => None,
            });
            job.advance(share);
        }
        let mut bodies = memory::with_capacity(self.placed.len())?;
        let mut is_known = !self.placed.is_empty();
        for placed in &self.placed {
            let Some(known) = &items[placed.item] else { continue };
            match Body::of(known, &placed.placement, self.items[placed.item].density) {
                Some(body) => bodies.push(body),
                None => is_known = false,
            }
        }
        let sum =
            |part: &dyn Fn(&Body) -> Interval| bodies.iter().fold(ZERO, |sum, body| sum.plus(part(body)));
        // (A possibly empty item has a volume all the same: it is not known to be zero.)
        let mut volume = ZERO;
        for placed in &self.placed {
            let Some(known) = &items[placed.item] else { continue };
            volume = volume.plus(known.volume.times(determinant(&placed.placement)));
        }
        let mass = sum(&|body| body.mass());
        let centroid: Option<[Interval; 3]> = (is_known && mass.lower > 0.0)
            .then(|| axes(|k| sum(&|body| body.mass().times(body.centroid[k])).over(mass)));
        let about = |point: [Interval; 3]| axes(|i| axes(|j| sum(&|body| body.inertia(&point, i, j))));
        let nothing_known = [[Interval::ALL; 3]; 3];
        let origin = if is_known || self.placed.is_empty() { about([ZERO; 3]) } else { nothing_known };
        let measures = LayoutMeasures {
            volume,
            filled_part: match container.volume.lower > 0.0 {
                true => volume.over(container.volume),
                false => Interval::between(0.0, f64::INFINITY),
            },
            height: self.height(own)?,
            mass: if is_known || self.placed.is_empty() {
                mass
            } else {
                Interval::between(mass.lower, f64::INFINITY)
            },
            centroid,
            inertia_about_origin: origin,
            inertia_about_centroid: centroid.map_or(origin, about),
        };
        job.advance(WHOLE - share * self.items.len());
        Ok(measures)
    }

    /// Returns the height of the highest point above the lower end of the container.
    fn height(&self, control: &Control<'_>) -> Result<Interval, Error> {
        /// The precision, as a part of the container's height.
        const PART: f64 = 1e-6;
        let container = self.container.bounds();
        let tolerance = PART * (container.max[2] - container.min[2]);
        let mut order = memory::collected(0..self.placed.len())?;
        order
            .sort_unstable_by(|&a, &b| self.boxes[b].max[2].total_cmp(&self.boxes[a].max[2]).then(a.cmp(&b)));
        let mut top: Option<Interval> = None;
        for number in order {
            let most = self.boxes[number].max[2];
            if let Some(found) = top
                && most <= found.lower + tolerance
            {
                // (The remaining copies reach no higher than this one.)
                top = Some(Interval::between(found.lower, found.upper.max(most)));
                break;
            }
            let own = self.top(number, tolerance, control)?;
            top = Some(match top {
                Some(top) => Interval::between(top.lower.max(own.lower), top.upper.max(own.upper)),
                None => own,
            });
        }
        let floor = Interval::exactly(container.min[2]);
        Ok(top.map_or(ZERO, |top| top.minus(floor)))
    }

    /// Returns the coordinate of a placed copy's highest point, from its distance to a lid on its bounding
    /// box.
    fn top(&self, number: usize, tolerance: f64, control: &Control<'_>) -> Result<Interval, Error> {
        const NOISE: f64 = 1.0 / (1u128 << 100) as f64 / (1u128 << 100) as f64;
        let (placed, around) = (&self.placed[number], &self.boxes[number]);
        let piece = &self.pieces[placed.item];
        let thick = around.max[2] - around.min[2];
        let mut lid = around.grown(thick);
        lid.min[2] = around.max[2];
        // (Smaller numbers are not valid coordinates. The lid is wide enough without them, and no lower.)
        let is_noise = |c: f64| c.abs() < NOISE;
        lid.min = axes(|k| match lid.min[k] {
            c if is_noise(c) => {
                if k == 2 {
                    NOISE
                } else {
                    0.0
                }
            }
            c => c,
        });
        lid.max = lid.max.each(|c| if is_noise(c) { 0.0 } else { c });
        let solid = match piece.solid().get::<MeshSolid>() {
            Some(_) => block_mesh(&lid)?,
            None => AnySolid::new(Csg::cuboid(lid.min, lid.max)?),
        };
        let near = Near::new(diagonal(around), [piece.solid()].into_iter());
        let lid = Piece::new(&solid, &lid, &near, control)?;
        let (gap, _) =
            lid.distance(piece, &Relative::of(&placed.placement), (tolerance, f64::INFINITY), control)?;
        Ok(Interval::exactly(lid.bounds().min[2]).minus(gap))
    }
}

fn measured(
    solid: &AnySolid,
    bounds: &Bounds,
    tolerance: f64,
    control: &Control<'_>,
) -> Result<MassProperties, Error> {
    let frame = match solid.home() {
        Some(home) => home,
        None => Frame::fitted(bounds.min, bounds.max, MAX_DEPTH)?,
    };
    measure(solid, &frame, tolerance, control)
}

/// Returns the factor by which the placement multiplies the volume.
fn determinant(placement: &Affine) -> Interval {
    // Its square is the determinant of MᵀM, whose eigenvalues are that near to 1.
    match stretch(placement) {
        0.0 => Interval::exactly(1.0),
        by => Interval::between(1.0 - 2.0 * by, 1.0 + 2.0 * by),
    }
}

impl Body {
    /// Returns the placed body; `None` if the solid may be empty.
    fn of(known: &MassProperties, placement: &Affine, density: f64) -> Option<Body> {
        let own = known.centroid?;
        let rows = placement.rows().each(|row| row.each(Interval::exactly));
        let half = Interval::exactly(0.5);
        let tensor = &known.inertia_about_centroid;
        let trace = tensor[0][0].plus(tensor[1][1]).plus(tensor[2][2]).times(half);
        // ∫ x xᵀ is half the trace minus the tensor.
        let second = |i: usize, j: usize| match i == j {
            true => {
                let (a, b) = (tensor[(i + 1) % 3][(i + 1) % 3], tensor[(i + 2) % 3][(i + 2) % 3]);
                let sharp = a.plus(b).minus(tensor[i][i]).times(half);
                let rough = trace.minus(tensor[i][i]);
                sharp.common(rough).unwrap_or(sharp)
            }
            false => tensor[i][j].negated(),
        };
        let determinant = determinant(placement);
        let centroid = axes(|i| (0..3).fold(rows[i][3], |sum, k| sum.plus(rows[i][k].times(own[k]))));
        let turned = axes(|i| {
            axes(|j| {
                let mut sum = ZERO;
                for k in 0..3 {
                    for l in 0..3 {
                        sum = sum.plus(rows[i][k].times(rows[j][l]).times(second(k, l)));
                    }
                }
                sum.times(determinant)
            })
        });
        Some(Body {
            density: Interval::exactly(density),
            volume: known.volume.times(determinant),
            centroid,
            second: turned,
        })
    }

    fn mass(&self) -> Interval {
        self.density.times(self.volume)
    }

    /// An element of the tensor of inertia about a point.
    fn inertia(&self, point: &[Interval; 3], i: usize, j: usize) -> Interval {
        let off: [Interval; 3] = axes(|k| self.centroid[k].minus(point[k]));
        let along = |k: usize, l: usize| {
            let steps = if k == l { off[k].square() } else { off[k].times(off[l]) };
            self.second[k][l].plus(steps.times(self.volume))
        };
        let element = match i == j {
            true => along((i + 1) % 3, (i + 1) % 3).plus(along((i + 2) % 3, (i + 2) % 3)),
            false => along(i, j).negated(),
        };
        element.times(self.density)
    }
}
