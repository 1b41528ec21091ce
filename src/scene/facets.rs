//! Approximation of circles by polygons.

/// The choice of circles, cylinders, balls and solids of revolution that are drawn as polygons, prisms and
/// polyhedra.
///
/// OpenSCAD draws all of them as such, with `$fn` sides, or else with a number that depends on `$fa` and
/// `$fs`. If `$fn` is small, the author means a prism: a hexagonal nut is a cylinder with `$fn = 6`. If `$fn`
/// is large, the author means a circle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Facets {
    /// Polygons if `$fn` is given and at most 12; all others are exact.
    #[default]
    Auto,
    /// No polygons: circles are round.
    Exact,
    /// Polygons always, with as many sides as in OpenSCAD. More than 1024 sides are refused.
    Polygon,
}

/// The largest `$fn` that means a polygon and not a circle.
const MOST_MEANT: u32 = 12;

/// Maximum number of sides of a polygon.
pub(super) const MOST_SIDES: u32 = 1024;

/// `$fn`, `$fa` and `$fs` of a call.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fineness {
    count: f64,
    angle: f64,
    size: f64,
}

impl Fineness {
    /// Makes the fineness; missing values have the defaults of OpenSCAD.
    pub fn new([count, angle, size]: [Option<f64>; 3]) -> Fineness {
        let positive = |given: Option<f64>, default| given.unwrap_or(default).max(0.01);
        Fineness { count: count.unwrap_or(0.0), angle: positive(angle, 12.0), size: positive(size, 2.0) }
    }

    /// Returns the number of sides with which OpenSCAD draws a circle.
    fn sides(&self, radius: f64) -> u32 {
        if radius < 1e-6 || !self.count.is_finite() {
            3
        } else if self.count > 0.0 {
            self.count.max(3.0) as u32
        } else {
            let by_size = radius * 2.0 * core::f64::consts::PI / self.size;
            (360.0 / self.angle).min(by_size).max(5.0).ceil() as u32
        }
    }

    /// Returns the number of sides with which to draw a circle; `None` if it is exact.
    pub fn drawn(&self, facets: Facets, radius: f64) -> Option<u32> {
        let sides = self.sides(radius);
        let is_meant = self.count != 0.0 && sides <= MOST_MEANT;
        match facets {
            Facets::Auto if is_meant => Some(sides),
            Facets::Polygon => Some(sides),
            Facets::Auto | Facets::Exact => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_are_those_of_openscad() {
        let sides = |given, radius| Fineness::new(given).sides(radius);
        assert_eq!(sides([Some(6.0), None, None], 10.0), 6);
        assert_eq!(sides([Some(6.9), Some(1.0), None], 10.0), 6);
        assert_eq!(sides([Some(1.0), None, None], 10.0), 3);
        assert_eq!(sides([Some(0.0), Some(12.0), Some(2.0)], 10.0), 30);
        assert_eq!(sides([None, None, None], 3.0), 10);
        assert_eq!(sides([None, None, None], 1.0), 5);
        assert_eq!(sides([Some(f64::NAN), None, None], 1.0), 3);
        assert_eq!(sides([Some(100.0), None, None], 1e-7), 3);
        assert_eq!(sides([None, Some(0.0), Some(0.0)], 1e9), 36_000);
    }

    #[test]
    fn only_small_numbers_mean_polygons() {
        let drawn = |count, facets| Fineness::new([count, None, None]).drawn(facets, 5.0);
        assert_eq!(drawn(Some(4.0), Facets::Auto), Some(4));
        assert_eq!(drawn(Some(12.0), Facets::Auto), Some(12));
        assert_eq!(drawn(Some(13.0), Facets::Auto), None);
        assert_eq!(drawn(Some(0.0), Facets::Auto), None);
        assert_eq!(drawn(None, Facets::Auto), None);
        assert_eq!(drawn(Some(4.0), Facets::Exact), None);
        assert_eq!(drawn(None, Facets::Polygon), Some(16));
    }
}
