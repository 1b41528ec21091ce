//! The first cells along rays for pictures, which need no bounds of the times.

use super::course::{Clear, Course};
use super::march::March;
use super::octree::{self, Question, cast_all, cast_one};
use super::way::Way;
use super::{Obstacle, Ray};
use crate::error::Error;
use crate::lattice::Cell;
use crate::octree::view::OctreeRef;

/// The first cell along a ray that is not EMPTY.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TouchedCell {
    /// The time of the entry, up to rounding.
    pub(crate) t: f64,
    pub(crate) cell: Cell,
    /// The outward normal of the face by which the ray enters the cell. Zero if the ray starts in the cell.
    pub(crate) normal: [f64; 3],
}

impl OctreeRef<'_> {
    /// Returns the first cell along a ray that is not EMPTY, the same as that of
    /// [`cast_ray`](Self::cast_ray).
    pub(crate) fn touch(&self, ray: &Ray) -> Option<TouchedCell> {
        cast_one(self, ray, FirstCell)
    }

    /// Finds the first cells along many rays, `touches[i]` for `rays[i]`, like
    /// [`cast_rays`](Self::cast_rays).
    pub(crate) fn touch_all(&self, rays: &[Ray], touches: &mut [Option<TouchedCell>]) -> Result<(), Error> {
        cast_all(self, rays, FirstCell, touches)
    }
}

#[derive(Clone, Copy)]
struct FirstCell;

impl Question for FirstCell {
    type Answer = TouchedCell;

    #[inline(always)]
    fn cast(self, way: &mut Way<'_, '_>, ray: &Ray, course: &Course, clear: Clear) -> Option<TouchedCell> {
        let Some(March { outer, .. }) = March::run(way, ray, course, clear, false) else {
            return exactly(way.tree, ray);
        };
        let ((cell, by), t) = outer?;
        let mut normal = [0.0; 3];
        if let Some((axis, _)) = by {
            normal[axis] = if ray.direction[axis][0] > 0.0 { -1.0 } else { 1.0 };
        }
        Some(TouchedCell { t, cell, normal })
    }
}

#[cold]
fn exactly(tree: &OctreeRef<'_>, ray: &Ray) -> Option<TouchedCell> {
    let hit = octree::exactly(Obstacle::Upper, &tree.without_cuts(), ray)?;
    Some(TouchedCell { t: hit.t.lower.max(0.0), cell: hit.cell, normal: hit.normal })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Control;
    use crate::lattice::Frame;
    use crate::op::{Rule, build};
    use crate::solid::Csg;
    use std::vec::Vec;

    #[test]
    fn touches_are_the_hits_of_single_rays() {
        let ball = Csg::ball([0.1, 0.0, -0.1], 0.75).unwrap();
        let bore = Csg::cylinder(0.2, -2.0, 2.0).unwrap();
        let solid = ball.difference(&bore).unwrap();
        let mut met = 0;
        for depth in [1, 2, 5, 8] {
            let frame = Frame::new([-1.0; 3], 2.0, depth).unwrap();
            let tree = build(&solid, &frame, Rule::Certified, &Control::threads(1)).unwrap();
            for (eye, at) in [([3.0, -4.0, 2.0], 0.0), ([0.0, 0.0, 5.0], 0.25), ([0.5, 0.25, 0.0], 0.0)] {
                // Rays side by side, through lattice planes and beside them.
                let rays: Vec<Ray> = (0..1000)
                    .map(|k| {
                        let [u, v] = [k % 32, k / 32].map(|i| f64::from(i) / 16.0 - 1.0 + at);
                        Ray::between(eye, [u, v, 0.125 * u]).unwrap().until(1e3).unwrap()
                    })
                    .collect();
                let mut touches = [None; 1000];
                tree.view().touch_all(&rays, &mut touches).unwrap();
                for (ray, touch) in rays.iter().zip(touches) {
                    let hit = tree.cast_ray(ray, Obstacle::Upper);
                    assert_eq!(touch, tree.view().touch(ray));
                    assert_eq!(touch.is_some(), hit.is_some());
                    if let (Some(touch), Some(hit)) = (touch, hit) {
                        assert_eq!((touch.cell, touch.normal), (hit.cell, hit.normal));
                        assert!((touch.t - hit.t.lower.max(0.0)).abs() <= 1e-12 * (1.0 + touch.t));
                        met += 1;
                    }
                }
            }
        }
        assert!(met > 3000);
        let tree =
            build(&solid, &Frame::new([-1.0; 3], 2.0, 3).unwrap(), Rule::Certified, &Control::threads(1));
        assert!(tree.unwrap().view().touch_all(&[], &mut [None]).is_err());
    }
}
