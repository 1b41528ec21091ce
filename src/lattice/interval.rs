//! Intervals that contain the truth.

/// A closed interval `[lower, upper]` of doubles that contains a real quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Nothing below is possible.
    pub lower: f64,
    /// Nothing above is possible.
    pub upper: f64,
}

impl Interval {
    /// The interval of a number that is known exactly.
    pub const fn exactly(value: f64) -> Interval {
        Interval { lower: value, upper: value }
    }

    /// Whether `value` lies in the interval.
    pub fn contains(&self, value: f64) -> bool {
        self.lower <= value && value <= self.upper
    }

    /// `upper − lower`, rounded to nearest.
    pub fn width(&self) -> f64 {
        self.upper - self.lower
    }
}
