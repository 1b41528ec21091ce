//! The greatest distance of the boundary from points of a slab in the cube.

use super::Slab;
use crate::lattice::Each;

/// The corners of the intersection of a slab with the cube, up to rounding.
pub(crate) fn corners(slab: &Slab) -> impl Iterator<Item = [f64; 3]> + Clone {
    let Slab { normal, inner, outer } = *slab;
    let of_cube = (0..8usize).map(|k| [0, 1, 2].each(|axis| end(k >> axis & 1)));
    let met = [inner, outer].into_iter().flat_map(move |level| {
        // The points where the edges of the cube meet a side.
        (0..12usize).filter_map(move |edge| {
            let axis = edge / 4;
            let mut p = [0.0; 3];
            (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (end(edge & 1), end(edge >> 1 & 1));
            p[axis] = (level - dot(normal, p)) / normal[axis];
            // (A comparison with NaN is false.)
            (p[axis].abs() <= 1.0).then_some(p)
        })
    });
    of_cube.filter(move |p| (inner..=outer).contains(&dot(normal, *p))).chain(met)
}

/// The greatest distance of a point of the slab in the cube from the boundary, up to rounding, if one side of
/// the slab lies in a solid and the other side does not. Infinite if the cube does not reach both sides.
///
/// The segment from a point to the nearest point of one side, or to that of the other, meets the boundary.
/// The distance from a side is a convex function, so that its maximum is at a corner.
pub(crate) fn stray(slab: &Slab) -> f64 {
    let [behind, before] = sides(slab);
    behind.max(before)
}

/// The greatest distances of the points of the slab in the cube from the cube's points behind the slab, and
/// from those in front of it, up to rounding. Infinite if there are no such points.
pub(crate) fn sides(slab: &Slab) -> [f64; 2] {
    let behind = |p| distance(p, slab.normal, slab.inner);
    let before = |p| distance(p, slab.normal.each(|c| -c), -slab.outer);
    corners(slab).fold([0.0, 0.0], |[a, b], p| [f64::max(a, behind(p)), f64::max(b, before(p))])
}

/// The distance of a point of the cube from the cube's points with n · x ≤ offset; infinite if there are
/// none.
fn distance(p: [f64; 3], normal: [f64; 3], offset: f64) -> f64 {
    if dot(normal, p) <= offset {
        return 0.0;
    }
    // The nearest point is p − λ n, moved into the cube. Axes along which it would leave the cube are fixed,
    // one after the other.
    let mut nearest = p;
    let mut is_free = normal.each(|c| c != 0.0);
    loop {
        let slope = (0..3).filter(|&k| is_free[k]).map(|k| normal[k] * normal[k]).sum::<f64>();
        if slope == 0.0 {
            return f64::INFINITY;
        }
        let along = |k: usize| normal[k] * if is_free[k] { p[k] } else { nearest[k] };
        let factor = (along(0) + along(1) + along(2) - offset) / slope;
        let mut is_outside = false;
        for k in 0..3 {
            if is_free[k] {
                let at = p[k] - factor * normal[k];
                nearest[k] = at.clamp(-1.0, 1.0);
                if at != nearest[k] {
                    (is_free[k], is_outside) = (false, true);
                }
            }
        }
        if !is_outside {
            let off = [0, 1, 2].each(|k| nearest[k] - p[k]);
            return libm::sqrt(dot(off, off));
        }
    }
}

fn end(bit: usize) -> f64 {
    if bit == 0 { -1.0 } else { 1.0 }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn length(a: [f64; 3]) -> f64 {
        dot(a, a).sqrt()
    }

    /// Compares with a dense lattice of points: the maximum over the slab of the minimum over a side.
    #[test]
    fn no_point_strays_further() {
        const STEPS: i32 = 40;
        let lattice = || {
            let line = || (-STEPS..=STEPS).step_by(4).map(|i| f64::from(i) / f64::from(STEPS));
            line().flat_map(move |x| line().flat_map(move |y| line().map(move |z| [x, y, z])))
        };
        for (normal, inner, outer) in [
            ([0.0, 0.0, 1.0], -0.3, 0.5),
            ([1.0, 1.0, 0.0], 1.4, 1.8),
            ([1.0, 0.1, 0.0], -0.2, 0.3),
            ([1.0, 0.02, -0.01], 0.8, 0.95),
            ([-1.0, 2.0, 3.0], 4.0, 5.5),
            ([-1.0, 1.0, -1.0], -2.6, -1.9),
            ([1e-3, 1.0, 1e-3], 0.7, 0.9),
        ] {
            let slab = Slab { normal, inner, outer };
            let own = stray(&slab);
            let inside = || lattice().filter(|p| (inner..=outer).contains(&dot(normal, *p)));
            let mut most = 0.0_f64;
            for p in inside() {
                for is_behind in [true, false] {
                    let beyond = |q: &[f64; 3]| {
                        if is_behind { dot(normal, *q) <= inner } else { dot(normal, *q) >= outer }
                    };
                    let off = |q: [f64; 3]| length([0, 1, 2].map(|k| p[k] - q[k]));
                    most = most.max(lattice().filter(beyond).map(off).fold(f64::INFINITY, f64::min));
                }
            }
            // (Points of the lattice are 0.1 apart, so that the nearest one is up to a diagonal of 0.1 too
            // far away.)
            assert!((own - 0.2..own + 0.18).contains(&most), "{slab:?} {own} {most}");
            assert!(own >= (outer - inner) / length(normal) - 1e-12);
        }
        let open = Slab { normal: [0.0, 1.0, 0.0], inner: -1.5, outer: 0.0 };
        assert_eq!(stray(&open), f64::INFINITY);
        assert_eq!(corners(&open).count(), 8);
    }
}
