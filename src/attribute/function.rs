//! Functions of position and constants as attributes.

use super::{Attribute, ValueRange};
use crate::error::Error;
use crate::lattice::{Bounds, Interval};

/// An attribute with one value everywhere.
#[derive(Debug, Clone, Copy)]
pub struct ConstantAttribute {
    components: usize,
    value: [f64; 4],
}

impl ConstantAttribute {
    /// Makes the attribute that is `value` everywhere.
    ///
    /// # Errors
    /// [`Error::Argument`] unless there are 1 to 4 numbers.
    pub fn new(value: &[f64]) -> Result<ConstantAttribute, Error> {
        let components = checked(value.len())?;
        let mut padded = [0.0; 4];
        padded[..components].copy_from_slice(value);
        Ok(ConstantAttribute { components, value: padded })
    }
}

impl Attribute for ConstantAttribute {
    fn components(&self) -> usize {
        self.components
    }

    fn values(&self, _: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) -> Result<(), Error> {
        values.fill(Some(self.value));
        Ok(())
    }

    fn range(&self, _: &Bounds) -> Result<ValueRange, Error> {
        Ok(ValueRange::exactly(Some(self.value)))
    }
}

/// A function of position, with bounds of its range, if they are known.
///
/// ```
/// use leafless::{Interval, attribute::{Attribute, FunctionAttribute, ValueRange}};
/// // A temperature that rises along z.
/// let warm = FunctionAttribute::new(1, |[_, _, z]: [f64; 3]| Some([20.0 + 8.0 * z, 0.0, 0.0, 0.0]))?;
/// assert_eq!(warm.value([1.0, 2.0, 0.5])?, Some([24.0, 0.0, 0.0, 0.0]));
/// # Ok::<(), leafless::Error>(())
/// ```
pub struct FunctionAttribute<F, R = fn(&Bounds) -> ValueRange> {
    components: usize,
    function: F,
    range: R,
}

impl<F: Fn([f64; 3]) -> Option<[f64; 4]> + Sync> FunctionAttribute<F> {
    /// Makes the attribute whose value at a point is the result of `function`. Numbers beyond the first
    /// `components` do not count, and `None` means no value. The range is unknown, so that an algorithm that
    /// searches for details must search everywhere.
    ///
    /// # Errors
    /// [`Error::Argument`] unless `components` is 1 to 4.
    pub fn new(components: usize, function: F) -> Result<FunctionAttribute<F>, Error> {
        Ok(FunctionAttribute { components: checked(components)?, function, range: |_| ValueRange::Unknown })
    }

    /// Adds a function that bounds the values in a box. The bounds must be [true](Attribute::range).
    pub fn with_range<R: Fn(&Bounds) -> ValueRange + Sync>(self, range: R) -> FunctionAttribute<F, R> {
        FunctionAttribute { components: self.components, function: self.function, range }
    }
}

impl<F, R> Attribute for FunctionAttribute<F, R>
where
    F: Fn([f64; 3]) -> Option<[f64; 4]> + Sync,
    R: Fn(&Bounds) -> ValueRange + Sync,
{
    fn components(&self) -> usize {
        self.components
    }

    fn values(&self, points: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) -> Result<(), Error> {
        for (value, &point) in values.iter_mut().zip(points) {
            *value = (self.function)(point).map(|mut value| {
                value[self.components..].fill(0.0);
                value
            });
        }
        Ok(())
    }

    fn range(&self, bounds: &Bounds) -> Result<ValueRange, Error> {
        Ok(match (self.range)(bounds) {
            ValueRange::Within(mut ranges) => {
                ranges[self.components..].fill(Interval::exactly(0.0));
                ValueRange::Within(ranges)
            }
            range => range,
        })
    }
}

fn checked(components: usize) -> Result<usize, Error> {
    if (1..=4).contains(&components) {
        return Ok(components);
    }
    Err(Error::Argument { name: "components", problem: "must be 1 to 4" })
}
