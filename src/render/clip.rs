//! Clip planes that cut parts of the scene away.

use crate::error::Error;
use crate::lattice::Bounds;
use crate::lattice::axes;
use crate::lattice::valid::numbers;
use crate::memory;
use alloc::vec::Vec;
use glam::DVec3;

/// A set of clip planes. Only the part inside all of them is shown.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Clip {
    /// Unit normals that point to the kept side, and offsets: n · p + d ≥ 0.
    planes: Vec<(DVec3, f64)>,
}

/// The visible part of a line of sight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shown {
    /// The depths at which the part begins and ends.
    pub from: f64,
    pub to: f64,
    /// The outward normal of the plane through which the line enters; `None` if the part begins at the eye.
    pub entry: Option<DVec3>,
}

/// Returns whether something at a depth is shown between these depths. A face in a clip plane is shown,
/// independently of rounding.
#[inline]
pub(crate) fn holds([from, to]: [f64; 2], depth: f64) -> bool {
    const ROUNDING: f64 = 1e-9;
    depth * (1.0 + ROUNDING) >= from && depth * (1.0 - ROUNDING) <= to
}

impl Clip {
    /// Creates a clip that cuts nothing away.
    pub fn new() -> Clip {
        Clip::default()
    }

    /// Keeps only the points p with a x + b y + c z + d ≥ 0.
    ///
    /// # Errors
    /// [`Error::Argument`] if a number is not zero and not between 2^-256 and 2^256 in magnitude, or if a, b
    /// and c are zero; [`Error::OutOfMemory`].
    pub fn plane(mut self, [a, b, c, d]: [f64; 4]) -> Result<Clip, Error> {
        numbers("plane", &[a, b, c, d])?;
        let normal = DVec3::new(a, b, c);
        let length = normal.length();
        if length < f64::MIN_POSITIVE {
            return Err(Error::Argument { name: "plane", problem: "must have a normal" });
        }
        memory::push(&mut self.planes, (normal / length, d / length))?;
        Ok(self)
    }

    /// Keeps only the part inside a box.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn within(mut self, bounds: &Bounds) -> Result<Clip, Error> {
        for axis in 0..3 {
            let normal = DVec3::from(axes(|i| f64::from(u8::from(i == axis))));
            memory::push(&mut self.planes, (normal, -bounds.min[axis]))?;
            memory::push(&mut self.planes, (-normal, bounds.max[axis]))?;
        }
        Ok(self)
    }

    /// Returns whether nothing is cut away.
    pub fn is_empty(&self) -> bool {
        self.planes.is_empty()
    }

    /// The unit normals that point to the kept side, and the offsets.
    pub(crate) fn planes(&self) -> &[(DVec3, f64)] {
        &self.planes
    }

    /// Returns whether a point is shown.
    pub(crate) fn keeps(&self, point: DVec3) -> bool {
        self.planes.iter().all(|(normal, offset)| normal.dot(point) + offset >= 0.0)
    }

    /// The visible part of the points from + t · along with t ≥ 0; `None` if there is none.
    #[inline]
    pub(crate) fn shown(&self, from: DVec3, along: DVec3) -> Option<Shown> {
        let mut shown = Shown { from: 0.0, to: f64::INFINITY, entry: None };
        for &(normal, offset) in &self.planes {
            let (height, rise) = (normal.dot(from) + offset, normal.dot(along));
            if rise == 0.0 {
                if height < 0.0 {
                    return None;
                }
                continue;
            }
            let t = -height / rise;
            if rise < 0.0 {
                shown.to = shown.to.min(t);
            } else if t > shown.from {
                (shown.from, shown.entry) = (t, Some(-normal));
            }
        }
        (shown.from < shown.to).then_some(shown)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_cut_where_planes_are() {
        let bounds = Bounds::new([-1.0; 3], [1.0, 2.0, 3.0]).unwrap();
        let clip = Clip::new().within(&bounds).unwrap().plane([0.0, 0.0, -2.0, 4.0]).unwrap();
        let shown = clip.shown(DVec3::new(0.0, 0.0, -5.0), DVec3::Z).unwrap();
        assert_eq!((shown.from, shown.to, shown.entry), (4.0, 7.0, Some(DVec3::NEG_Z)));
        let inside = clip.shown(DVec3::ZERO, DVec3::X).unwrap();
        assert_eq!((inside.from, inside.to, inside.entry), (0.0, 1.0, None));
        assert!(clip.shown(DVec3::new(0.0, 0.0, 2.5), DVec3::X).is_none());
        assert!(clip.shown(DVec3::new(5.0, 0.0, 0.0), DVec3::X).is_none());
        assert!(Clip::new().shown(DVec3::ZERO, DVec3::X).unwrap().to == f64::INFINITY);
        assert!(clip.keeps(DVec3::new(0.5, 1.5, 1.9)) && !clip.keeps(DVec3::new(0.5, 1.5, 2.1)));
        assert!(
            Clip::new().plane([0.0, 0.0, 0.0, 1.0]).is_err() && Clip::new().plane([f64::NAN; 4]).is_err()
        );
    }
}
