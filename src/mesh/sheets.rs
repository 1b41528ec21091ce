//! Sheets of a closed surface, and the side of each sheet on which the solid lies.
//!
//! A *sheet* is a set of triangles that are connected by edges of exactly two triangles with the same
//! orientation. Triangles that intersect others belong to no sheet. Therefore no other triangle meets such an
//! edge, or the interior of a triangle of a sheet. The winding number right in front of the triangles is the
//! same for the whole sheet, and right behind them it is one more. It is computed on a line through one of
//! the triangles, by counting the triangles above a point of the line, with signs for their orientations.

use super::intersections::{axis_of, corners};
use super::signs::{Point, cross_sign};
use super::topology::{DisjointSets, for_each_edge};
use super::tree::Tree;
use super::triangle_mesh::{FillRule, TriangleMesh};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::{Dyadic, cross, dot, sign};
use crate::memory;
use alloc::vec::Vec;
use core::array::from_fn as array;

/// The sheets of a mesh.
pub(super) struct Sheets {
    /// The sheet of each triangle. A triangle that intersects others is a sheet of its own.
    pub(super) of_triangles: Vec<u32>,
    pub(super) senses: Vec<Sense>,
}

/// The side of a sheet on which the solid lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sense {
    /// 1 if the solid lies behind and not in front, −1 if the other way round, 0 if on both sides or on
    /// neither.
    Known(i8),
    /// The sheet has no area, and so no sides.
    Flat,
    /// The triangle intersects others; or all triangles are slivers, so that no interior point can be found.
    Unknown,
}

/// Finds the sheets of a mesh that is closed under `rule`; `tree` is the tree of its triangles. `meets` says
/// for each triangle whether it intersects others.
///
/// O(t), and O(log t) a sheet if few triangles lie above each other.
pub(super) fn sheets(
    mesh: &TriangleMesh,
    tree: &Tree,
    rule: FillRule,
    meets: impl Fn(u32) -> bool,
) -> Result<Sheets, Error> {
    let triangles = mesh.triangles();
    let mut sets = DisjointSets::new(triangles.len())?;
    for_each_edge(triangles, mesh.vertices().len(), |edge| {
        if edge.count() == 2 && edge.excess() == 0 && !edge.triangles().any(&meets) {
            edge.triangles().for_each(|triangle| sets.unite(edge.first(), triangle));
        }
        Ok(())
    })?;
    let of_triangles = sets.numbers();
    let count = of_triangles.iter().max().map_or(0, |&last| last as usize + 1);
    let mut largest: Vec<Option<(f64, u32)>> = memory::filled(count, None)?;
    for (&sheet, triangle) in of_triangles.iter().zip(0..) {
        let size = size(&corners(mesh, triangle));
        let largest = &mut largest[sheet as usize];
        if largest.is_none_or(|(most, _)| size > most) && !mesh.is_flat(&triangles[triangle as usize]) {
            *largest = Some((size, triangle));
        }
    }
    let mut senses = memory::with_capacity(count)?;
    for &found in &largest {
        senses.push(match found {
            None => Sense::Flat,
            Some((_, triangle)) if meets(triangle) => Sense::Unknown,
            Some((_, triangle)) => in_front(mesh, tree, triangle, rule).map_or(Sense::Unknown, |front| {
                Sense::Known(rule.encloses(front + 1) as i8 - rule.encloses(front) as i8)
            }),
        });
    }
    Ok(Sheets { of_triangles, senses })
}

/// Returns about twice a triangle's area, in the axis-parallel projection in which it is largest.
fn size([a, b, c]: &[Point; 3]) -> f64 {
    let [u, v]: [Point; 2] = [b, c].each(|p| array(|axis| p[axis] - a[axis]));
    (0..3).fold(0.0, |size: f64, k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        size.max((u[i] * v[j] - u[j] * v[i]).abs())
    })
}

/// Returns the winding number right in front of a triangle; for [`FillRule::EvenOdd`] the parity, 0 or 1, of
/// the number of triangles between that point and infinity. `None` if the triangle is too small for an
/// interior point.
fn in_front(mesh: &TriangleMesh, tree: &Tree, triangle: u32, rule: FillRule) -> Option<i32> {
    let [a, b, c] = corners(mesh, triangle);
    let p: Point = array(|k| a[k] + ((b[k] - a[k]) + (c[k] - a[k])) / 3.0);
    in_front_at(mesh, tree, triangle, &p, rule)
}

/// Does the same in front of the point of a triangle that lies above or below another point, along the axis
/// that shows the triangle best. `None` if there is no such point within its edges.
pub(super) fn in_front_at(
    mesh: &TriangleMesh,
    tree: &Tree,
    triangle: u32,
    p: &Point,
    rule: FillRule,
) -> Option<i32> {
    let own = corners(mesh, triangle);
    let [a, b, c] = &own;
    let normal: Point = array(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i])
    });
    let best = (1..3).fold(0, |best, axis| if normal[axis].abs() > normal[best].abs() { axis } else { best });
    // The coordinate of `p` along the axis does not matter.
    let axis = if cross_sign([a, b], [a, c], best) != 0 { best } else { axis_of(&own) };
    let turn = turn(&own, p, axis);
    // A point on an edge would belong to two triangles.
    let is_inside =
        [[a, b], [b, c], [c, a]].into_iter().all(|[s, t]| cross_sign([s, t], [s, p], axis) == turn);
    if turn == 0 || !is_inside {
        return None;
    }
    let mut above = 0;
    tree.on_line(p, axis, &mut |other| {
        if other == triangle {
            return;
        }
        let other = corners(mesh, other);
        let step = self::turn(&other, p, axis);
        if step != 0 && is_above(&other, &own, p, axis) {
            above += if rule == FillRule::EvenOdd { 1 } else { step };
        }
    });
    Some(match rule {
        // Converts above and below into front and behind.
        FillRule::EvenOdd => (above + (turn < 0) as i32) % 2,
        FillRule::NonZero | FillRule::Positive if turn > 0 => above,
        FillRule::NonZero | FillRule::Positive => above - 1,
    })
}

/// Returns the orientation of a triangle as seen from above along `axis`, if the line through `p` passes
/// through the triangle: 1 for counter-clockwise, −1 for clockwise; 0 if the line misses it. The line is
/// shifted symbolically by (ε, ε²), so that it meets no edge.
fn turn([a, b, c]: &[Point; 3], p: &Point, axis: usize) -> i32 {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let side = |s: &Point, t: &Point| match cross_sign([s, t], [s, p], axis) {
        0 => match -sign(t[v] - s[v]) {
            0 => sign(t[u] - s[u]),
            moved => moved,
        },
        side => side,
    };
    let turn = side(a, b);
    if side(b, c) == turn && side(c, a) == turn { turn } else { 0 }
}

/// Returns whether the line through `p` along `axis` meets the plane of `upper` above the plane of `lower`.
/// The projections of both along the axis must have an area.
fn is_above(upper: &[Point; 3], lower: &[Point; 3], p: &Point, axis: usize) -> bool {
    let ends = |corners: &[Point; 3]| {
        let [x, y, z] = corners.each(|corner| corner[axis]);
        [x.min(y).min(z), x.max(y).max(z)]
    };
    let ([low, high], [from, to]) = (ends(upper), ends(lower));
    if low > to || high < from {
        return low > to;
    }
    // The height of the plane through a with the normal n is n · (a − p) divided by the component of n along
    // the axis, if p has height 0.
    let height = |[a, b, c]: &[Point; 3]| {
        let exact = |x: &Point| x.each(Dyadic::new);
        let (a, b, c, p) = (exact(a), exact(b), exact(c), exact(p));
        let minus = |x: &[Dyadic; 3], y: &[Dyadic; 3]| -> [Dyadic; 3] { array(|k| &x[k] - &y[k]) };
        let normal = cross(&minus(&b, &a), &minus(&c, &a));
        let mut way = minus(&a, &p);
        way[axis] = a[axis].clone();
        (dot([&normal[0], &normal[1], &normal[2]], [&way[0], &way[1], &way[2]]), normal[axis].clone())
    };
    let ((a, of_a), (b, of_b)) = (height(upper), height(lower));
    // a / of_a > b / of_b
    (&(&a * &of_b) - &(&b * &of_a)).sign() * of_a.sign() * of_b.sign() > 0
}
