//! The common interface of all kinds of samples.

use super::{Band, Samples};

/// A kind of sample.
pub(super) trait Value: Copy + PartialOrd + Send + Sync + 'static {
    /// The least and the greatest value.
    const LEAST: Self;
    const GREATEST: Self;

    /// Converts a double that is a value of this kind.
    fn of(x: f64) -> Self;

    /// Converts the value to a double.
    fn to_f64(self) -> f64;

    /// The least value that is not less than `x`, and the greatest that is not greater, as doubles.
    fn ceil(x: f64) -> f64;
    fn floor(x: f64) -> f64;

    /// The least value of a block in which one sample is NaN: no comparison with it is true.
    const NONE: Self;

    /// Returns whether the value is NaN.
    fn is_nan(self) -> bool;
}

macro_rules! whole {
    ($($kind:ty),*) => {$(
        impl Value for $kind {
            const LEAST: Self = <$kind>::MIN;
            const GREATEST: Self = <$kind>::MAX;
            const NONE: Self = 0;

            #[inline(always)]
            fn of(x: f64) -> Self {
                x as $kind
            }

            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }

            fn ceil(x: f64) -> f64 {
                libm::ceil(x)
            }

            fn floor(x: f64) -> f64 {
                libm::floor(x)
            }

            #[inline(always)]
            fn is_nan(self) -> bool {
                false
            }
        }
    )*};
}
whole!(u8, u16, i16);

impl Value for f32 {
    const LEAST: Self = f32::NEG_INFINITY;
    const GREATEST: Self = f32::INFINITY;
    const NONE: Self = f32::NAN;

    #[inline(always)]
    fn of(x: f64) -> Self {
        x as f32
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }

    fn ceil(x: f64) -> f64 {
        let near = x as f32;
        f64::from(if f64::from(near) < x { near.next_up() } else { near })
    }

    fn floor(x: f64) -> f64 {
        let near = x as f32;
        f64::from(if f64::from(near) > x { near.next_down() } else { near })
    }

    #[inline(always)]
    fn is_nan(self) -> bool {
        f32::is_nan(self)
    }
}

/// A band whose ends are values of the samples' kind. It contains the same samples as the band that it was
/// made from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Limits {
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Limits {
    pub(super) fn new(samples: &Samples<'_>, band: &Band) -> Limits {
        fn of<T: Value>(band: &Band) -> Limits {
            let low = T::ceil(band.low()).max(T::LEAST.to_f64());
            let high = T::floor(band.high()).min(T::GREATEST.to_f64());
            // A band between two neighbouring values contains none.
            if low <= high { Limits { low, high } } else { Limits { low: 1.0, high: 0.0 } }
        }
        match samples {
            Samples::Bits(_) | Samples::U8(_) => of::<u8>(band),
            Samples::U16(_) => of::<u16>(band),
            Samples::I16(_) => of::<i16>(band),
            Samples::F32(_) => of::<f32>(band),
        }
    }

    /// The ends as values.
    #[inline(always)]
    pub(super) fn of<T: Value>(&self) -> [T; 2] {
        [T::of(self.low), T::of(self.high)]
    }

    #[inline(always)]
    pub(super) fn contains(&self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// The inside bits of a word of bits.
    #[inline(always)]
    pub(super) fn word(&self, word: u64) -> u64 {
        match (self.contains(0.0), self.contains(1.0)) {
            (false, false) => 0,
            (false, true) => word,
            (true, false) => !word,
            (true, true) => !0,
        }
    }
}
