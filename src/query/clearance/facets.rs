//! The distance of solids whose boundaries are known to consist of triangles.
//!
//! The boundaries are compared triangle by triangle, along the trees of both meshes. If they have no point in
//! common, each connected part of one boundary lies entirely inside or entirely outside of the other solid:
//! one point of the part decides.

use super::search::Goal;
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::lattice::{Affine, Interval, axes};
use crate::memory;
use crate::mesh::{Apart, Discs, Enough, Facets, MeshPair, NearTriangles};
use crate::octree::Tag;
use crate::query::StopReason;
use crate::solid::{AskWhole, Batch, BoundaryFacets, Classifier, Direct};
use alloc::vec::Vec;

/// The ratio of visited pairs of nodes to cell splits in the budget.
const STEPS: u64 = 64;

/// Triangles that lie in a closed solid and include its whole boundary. Triangles inside the solid do no
/// harm: if the solids are apart, these triangles are further away.
pub(super) struct Boundary {
    facets: BoundaryFacets,
    /// The maximal distance of the boundary's points from the triangles.
    radius: f64,
    /// A vertex of each connected part.
    parts: Vec<[f64; 3]>,
    discs: Option<Discs>,
}

impl Boundary {
    /// Returns the boundary of a solid in the universe, if the boundary consists of triangles. Complexity:
    /// O(t), and the solid's own preparation at the first such query.
    pub(super) fn of<C: Classifier>(solid: &C, control: &Control<'_>) -> Result<Option<Boundary>, Error> {
        if solid.exterior() != Tag::Empty {
            return Ok(None);
        }
        let facets = match solid.walls(control)? {
            None => solid.facets(control)?,
            walls => walls,
        };
        let Some(facets) = facets else { return Ok(None) };
        if !solid.is_direct(Direct::Points, control)? {
            return Ok(None);
        }
        let radius = facets.mesh.radius();
        let mut boundary = Boundary { facets, radius, parts: Vec::new(), discs: None };
        boundary.parts = boundary.seen(control)?.one_of_each_part()?;
        boundary.discs = Some(boundary.seen(control)?.make_discs()?);
        Ok(if boundary.parts.is_empty() { None } else { Some(boundary) })
    }

    fn seen(&self, control: &Control<'_>) -> Result<Facets<'_>, Error> {
        let BoundaryFacets { mesh, chosen } = &self.facets;
        Ok(Facets { tree: mesh.triangle_tree(control)?, chosen, discs: self.discs.as_ref() })
    }

    /// A point of a triangle.
    fn point(&self, triangle: u32, weights: &[f64; 3]) -> [f64; 3] {
        let corners = self.corners(triangle);
        axes(|axis| (0..3).map(|k| weights[k] * corners[k][axis]).sum())
    }

    fn corners(&self, triangle: u32) -> [[f64; 3]; 3] {
        let mesh = &self.facets.mesh;
        mesh.triangles()[triangle as usize].each(|vertex| mesh.vertices()[vertex as usize])
    }
}

/// An upper bound of the length of a vector whose coordinates are at most `coordinate`.
fn length(coordinate: f64) -> f64 {
    if coordinate > 0.0 { (coordinate * sqrt(3.0)).next_up().next_up() } else { 0.0 }
}

/// The result of comparing the triangles of two boundaries.
pub(super) struct ByFacets {
    pub(super) distance: Interval,
    pub(super) points: Option<[[f64; 3]; 2]>,
    pub(super) normals: [Option<[f64; 3]>; 2],
    pub(super) stop_reason: StopReason,
    /// Whether neither is proven: that the solids are apart, or that they have a point in common.
    pub(super) is_open: bool,
}

/// Two solids with such boundaries. The second may be moved.
pub(super) struct Pair<'p, A, B> {
    pub(super) solids: (&'p A, &'p B),
    pub(super) boundaries: [&'p Boundary; 2],
    pub(super) placement: Option<&'p Affine>,
}

/// The position of one solid relative to another solid whose boundary it does not cross.
enum Reach {
    Apart,
    /// This point lies in both.
    Within([f64; 3]),
    Unknown,
}

/// Points to locate, and the maximal error of each.
struct Probes {
    points: Vec<[f64; 3]>,
    off: f64,
}

impl<A: Classifier, B: Classifier> Pair<'_, A, B> {
    /// Returns the distance, as far as `wanted` requires it. `budget`: see [`clearance`](super::clearance).
    pub(super) fn distance(&self, wanted: Goal, budget: u64, job: &Job<'_>) -> Result<ByFacets, Error> {
        let control = job.control();
        let [own, other] = self.boundaries;
        let off = self.off();
        let steps = budget.saturating_mul(STEPS);
        let enough = match wanted {
            Goal::Width { tolerance, below } => Enough {
                tolerance: (tolerance - 4.0 * off).max(0.0),
                lower: (below + off).next_up(),
                upper: 0.0,
                steps,
            },
            Goal::AtLeast(least) if off == 0.0 => {
                Enough { tolerance: 0.0, lower: least, upper: least, steps }
            }
            Goal::AtLeast(least) => {
                let lower = (least + off).next_up() + (least - (least - 2.0 * f64::EPSILON * least));
                Enough { tolerance: 0.0, lower, upper: (least - off).next_down(), steps }
            }
        };
        let pair = MeshPair::new(own.seen(control)?, other.seen(control)?, self.placement, off);
        let apart = pair.apart(&enough, job)?;
        let Apart { distance, nearest, is_sure_contact, is_spent } = apart;
        let mut known = if off == 0.0 || is_sure_contact {
            distance
        } else {
            let lower = (distance.lower - off).next_down().max(0.0);
            Interval::between(lower, (distance.upper + off).next_up().max(lower))
        };
        let mut points = nearest.as_ref().map(|near| self.points(near));
        let mut normals = [None; 2];
        let mut is_open = false;
        let is_near = matches!(wanted, Goal::AtLeast(least) if known.upper < least);
        if !is_sure_contact && !is_near {
            match self.reach(known.lower)? {
                Reach::Within(point) => {
                    known = Interval::exactly(0.0);
                    points = Some([point; 2]);
                }
                Reach::Unknown => {
                    is_open = true;
                    known = Interval::between(0.0, known.upper);
                }
                Reach::Apart => is_open = known.lower == 0.0 && known.upper <= 4.0 * off,
            }
        }
        if let Some(near) = &nearest
            && known.lower > 0.0
        {
            normals = self.normals(near);
        }
        let is_enough = match wanted {
            Goal::Width { tolerance, below } => known.width() <= tolerance || known.lower >= below,
            Goal::AtLeast(least) => known.lower >= least || known.upper < least,
        };
        let stop_reason = match (is_enough, is_spent) {
            (true, _) => StopReason::Tolerance,
            (false, true) => StopReason::Budget,
            (false, false) => StopReason::Exhausted,
        };
        Ok(ByFacets { distance: known, points, normals, stop_reason, is_open })
    }

    /// The maximal distance of both boundaries together from their triangles.
    fn off(&self) -> f64 {
        let [own, other] = self.boundaries;
        match (own.radius, self.stretched(other)) {
            (own, 0.0) => own,
            (0.0, other) => other,
            (own, other) => (own + other).next_up(),
        }
    }

    /// The maximal distance of the second boundary from its moved triangles.
    fn stretched(&self, other: &Boundary) -> f64 {
        self.placement.map_or(other.radius, |placement| placement.lengthened(other.radius))
    }

    fn points(&self, near: &NearTriangles) -> [[f64; 3]; 2] {
        let [p, q] = [0, 1].each(|k| self.boundaries[k].point(near.triangles[k], &near.weights[k]));
        [p, self.placement.map_or(q, |placement| placement.apply(q))]
    }

    /// Unit vectors that lead out of the solids at their nearest points: normal to the triangle if the point
    /// lies in its interior, towards the other point if it lies on an edge or a corner.
    fn normals(&self, near: &NearTriangles) -> [Option<[f64; 3]>; 2] {
        [0, 1].each(|k| {
            let outward = if k == 0 { near.way } else { near.way.each(|c| -c) };
            let is_inside = near.weights[k].iter().all(|&weight| weight > 1e-9);
            let across = if is_inside { self.across(k, near.triangles[k]) } else { None };
            let Some(across) = across else { return unit(outward) };
            Some(if dot(across, outward) < 0.0 { across.each(|c| -c) } else { across })
        })
    }

    /// A unit normal of a triangle.
    fn across(&self, k: usize, triangle: u32) -> Option<[f64; 3]> {
        let [a, b, c] = self.boundaries[k].corners(triangle);
        let edge = |p: [f64; 3]| -> [f64; 3] {
            let edge: [f64; 3] = axes(|axis| p[axis] - a[axis]);
            match self.placement.filter(|_| k == 1) {
                Some(placement) => placement.rows().each(|[x, y, z, _]| dot([x, y, z], edge)),
                None => edge,
            }
        };
        let ([u, v], next) = ([edge(b), edge(c)], |axis: usize| ((axis + 1) % 3, (axis + 2) % 3));
        unit(axes(|axis| {
            let (i, j) = next(axis);
            u[i] * v[j] - u[j] * v[i]
        }))
    }

    /// Returns whether a part of one boundary lies in the other solid. The boundaries are at least `gap`
    /// apart.
    fn reach(&self, gap: f64) -> Result<Reach, Error> {
        let (a, b) = self.solids;
        let Some([of_own, of_other]) = self.probes()? else { return Ok(Reach::Unknown) };
        let own = self.reach_into(b, 1, &of_own, gap)?;
        if !matches!(own, Reach::Apart) {
            return Ok(match own {
                Reach::Within(point) => {
                    Reach::Within(self.placement.map_or(point, |placement| placement.apply(point)))
                }
                other => other,
            });
        }
        self.reach_into(a, 0, &of_other, gap)
    }

    /// Returns a point of each part of the first boundary, in the coordinates of the second solid before it
    /// is moved, and a point of each part of the second boundary in those of the first.
    fn probes(&self) -> Result<Option<[Probes; 2]>, Error> {
        let [own, other] = self.boundaries;
        let Some(placement) = self.placement else {
            return Ok(Some([
                Probes { points: memory::copied(&own.parts)?, off: own.radius },
                Probes { points: memory::copied(&other.parts)?, off: other.radius },
            ]));
        };
        let Ok(back) = placement.inverse() else { return Ok(None) };
        let moved = |map: &Affine, boundary: &Boundary| -> Result<Probes, Error> {
            let mut most: f64 = 0.0;
            let points = memory::collected(boundary.parts.iter().map(|&p| {
                for [x, y, z, t] in map.rows() {
                    most = most.max((x * p[0]).abs() + (y * p[1]).abs() + (z * p[2]).abs() + t.abs());
                }
                map.apply(p)
            }))?;
            // The error of an inverse is less than 2^-50 of its entries, and that of a point's image as much.
            let rounding = length(most * (8.0 * f64::EPSILON));
            let radius = map.lengthened(boundary.radius);
            Ok(Probes { points, off: (rounding + radius) * (1.0 + 1e-9) })
        };
        Ok(Some([moved(&back, own)?, moved(placement, other)?]))
    }

    /// Returns whether one of the points lies in a solid.
    fn reach_into<C: Classifier>(
        &self,
        solid: &C,
        k: usize,
        probes: &Probes,
        gap: f64,
    ) -> Result<Reach, Error> {
        let boundary = self.boundaries[k];
        let mut answers = memory::filled(probes.points.len(), None)?;
        solid.worker()?.inside(&probes.points, &mut answers)?;
        let off = match self.placement.filter(|_| k == 1) {
            Some(placement) => placement.lengthened(probes.off),
            None => probes.off,
        };
        // The exact point and the computed point lie on the same side of a boundary that is further away than
        // their distance.
        let is_sure = |point: &[f64; 3]| {
            if off == 0.0 || off < gap {
                return true;
            }
            let Some(tree) = boundary.facets.mesh.known_triangle_tree() else { return false };
            let chosen = &boundary.facets.chosen;
            let near = tree.nearest_of(point, |t| chosen.is_empty() || chosen[t as usize]);
            near.is_some_and(|(_, distance)| distance.lower > (probes.off + boundary.radius) * (1.0 + 1e-9))
        };
        let mut is_known = true;
        for (point, answer) in probes.points.iter().zip(answers) {
            match answer {
                Some(true) if is_sure(point) => return Ok(Reach::Within(*point)),
                Some(false) if is_sure(point) => {}
                _ => is_known = false,
            }
        }
        Ok(if is_known { Reach::Apart } else { Reach::Unknown })
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns the vector of length 1 in the same direction.
fn unit(way: [f64; 3]) -> Option<[f64; 3]> {
    let most = way.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    let way = way.each(|c| c / most);
    let length = sqrt(dot(way, way));
    (length > 0.0 && length < f64::INFINITY).then(|| way.each(|c| c / length))
}
