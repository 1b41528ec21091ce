//! Units of length, and factors between them.

use core::fmt;
use core::str::FromStr;

use crate::error::Error;
use crate::lattice::valid;

/// A unit of length. The ratio of any two units is exactly rational.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LengthUnit {
    /// 1/1000 of a millimetre.
    Micrometre,
    /// The millimetre.
    Millimetre,
    /// 10 millimetres.
    Centimetre,
    /// 1000 millimetres.
    Metre,
    /// 25.4 millimetres.
    Inch,
    /// 12 inches.
    Foot,
}

impl LengthUnit {
    /// All units.
    pub const ALL: [LengthUnit; 6] =
        [Self::Micrometre, Self::Millimetre, Self::Centimetre, Self::Metre, Self::Inch, Self::Foot];

    /// Returns the symbol: `um`, `mm`, `cm`, `m`, `in` or `ft`.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Micrometre => "um",
            Self::Millimetre => "mm",
            Self::Centimetre => "cm",
            Self::Metre => "m",
            Self::Inch => "in",
            Self::Foot => "ft",
        }
    }

    /// Returns the number of micrometres, which is whole for each unit.
    pub const fn micrometres(self) -> u32 {
        match self {
            Self::Micrometre => 1,
            Self::Millimetre => 1000,
            Self::Centimetre => 10_000,
            Self::Metre => 1_000_000,
            Self::Inch => 25_400,
            Self::Foot => 304_800,
        }
    }
}

impl fmt::Display for LengthUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.symbol())
    }
}

impl FromStr for LengthUnit {
    type Err = Error;

    /// Parses the symbol or a name (`µm`, `micron`, `millimetre`, `meters`, `inch`, `feet` …) in any letter
    /// case.
    fn from_str(text: &str) -> Result<Self, Error> {
        const NAMES: [(LengthUnit, &[&str]); 6] = [
            (
                LengthUnit::Micrometre,
                &[
                    "um",
                    "µm",
                    "μm",
                    "micron",
                    "microns",
                    "micrometre",
                    "micrometres",
                    "micrometer",
                    "micrometers",
                ],
            ),
            (LengthUnit::Millimetre, &["mm", "millimetre", "millimetres", "millimeter", "millimeters"]),
            (LengthUnit::Centimetre, &["cm", "centimetre", "centimetres", "centimeter", "centimeters"]),
            (LengthUnit::Metre, &["m", "metre", "metres", "meter", "meters"]),
            (LengthUnit::Inch, &["in", "inch", "inches"]),
            (LengthUnit::Foot, &["ft", "foot", "feet"]),
        ];
        (NAMES.iter())
            .find(|(_, names)| names.iter().any(|name| name.eq_ignore_ascii_case(text)))
            .map(|&(unit, _)| unit)
            .ok_or(Error::Argument { name: "unit", problem: "must be um, mm, cm, m, in or ft" })
    }
}

/// The factor of coordinates: `numerator / denominator`.
///
/// The denominator is a whole number. It is separate because the factors between units are ratios of small
/// whole numbers, which are seldom floating point numbers (127/5 from inches to millimetres). The product
/// with the numerator is exact for coordinates of up to 40 bits, so the quotient is the only rounding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Factor {
    numerator: f64,
    denominator: f64,
}

impl Factor {
    /// Returns the factor of a conversion between two units and of `scale`, which must be between 2^-256 and
    /// 2^256.
    pub fn new(conversion: Option<(LengthUnit, LengthUnit)>, scale: f64) -> Result<Self, Error> {
        valid::length("scale", scale)?;
        let (from, to) = conversion.map_or((1, 1), |(from, to)| (from.micrometres(), to.micrometres()));
        let divisor = common_divisor(from, to);
        Ok(Self { numerator: f64::from(from / divisor) * scale, denominator: f64::from(to / divisor) })
    }

    /// Returns whether every coordinate stays the same, bit by bit.
    pub fn is_one(&self) -> bool {
        self.numerator == self.denominator
    }

    /// Returns the scaled coordinate. The result is finite for coordinates up to 2^256 in magnitude.
    #[inline]
    pub fn apply(&self, x: f64) -> f64 {
        x * self.numerator / self.denominator
    }
}

/// Euclid's algorithm; `b` is not 0.
const fn common_divisor(a: u32, b: u32) -> u32 {
    if a.is_multiple_of(b) { b } else { common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::{LARGEST, SMALLEST};
    use LengthUnit::*;
    use alloc::string::ToString;

    #[test]
    fn names() {
        for unit in LengthUnit::ALL {
            assert_eq!(unit.symbol().parse::<LengthUnit>().unwrap(), unit);
            assert_eq!(unit.to_string(), unit.symbol());
        }
        for (name, unit) in [
            ("Inches", Inch),
            ("feet", Foot),
            ("µm", Micrometre),
            ("μm", Micrometre),
            ("micron", Micrometre),
            ("METER", Metre),
            ("centimetres", Centimetre),
            ("Millimeter", Millimetre),
        ] {
            assert_eq!(name.parse::<LengthUnit>().unwrap(), unit);
        }
        for name in ["", "yard", " mm", "m²", "inchs", "\""] {
            assert!(
                matches!(name.parse::<LengthUnit>(), Err(Error::Argument { name: "unit", .. })),
                "{name}"
            );
        }
    }

    #[test]
    fn factors_are_exact() {
        let convert = |x, from, to| Factor::new(Some((from, to)), 1.0).unwrap().apply(x);
        assert_eq!(convert(1.0, Inch, Millimetre), 25.4);
        // With 25.4 rounded first, 3 × 25.4 is another number.
        assert_eq!(convert(3.0, Inch, Millimetre), 76.2);
        assert_eq!(convert(76.2, Millimetre, Inch), 3.0);
        assert_eq!(convert(9.0, Millimetre, Metre), 0.009);
        assert_eq!(convert(0.1, Metre, Millimetre), 100.0);
        assert_eq!(convert(7.0, Foot, Inch), 84.0);
        assert_eq!(convert(1.0, Inch, Foot), 1.0 / 12.0);
        assert_eq!(convert(-0.5, Micrometre, Foot), -0.5 / 304_800.0);
        for from in LengthUnit::ALL {
            assert!(Factor::new(Some((from, from)), 1.0).unwrap().is_one());
            for to in LengthUnit::ALL {
                assert_eq!(Factor::new(Some((from, to)), 1.0).unwrap().is_one(), from == to);
                // Exact from micrometres, for all numbers of few bits.
                let exact = f64::from(from.micrometres()) * 1357.0 / f64::from(to.micrometres());
                assert_eq!(convert(1357.0, from, to), exact);
            }
        }
        assert_eq!(Factor::new(Some((Metre, Millimetre)), 2.0).unwrap().apply(0.25), 500.0);
        assert!(Factor::new(Some((Metre, Millimetre)), 0.001).unwrap().is_one());
    }

    #[test]
    fn scales() {
        for scale in [
            0.0,
            -0.0,
            -1.0,
            f64::NAN,
            f64::INFINITY,
            -f64::INFINITY,
            LARGEST.next_up(),
            SMALLEST.next_down(),
        ] {
            assert!(
                matches!(Factor::new(None, scale), Err(Error::Argument { name: "scale", .. })),
                "{scale}"
            );
        }
        assert!(Factor::new(None, 1.0).unwrap().is_one());
        assert!(!Factor::new(None, 1.0_f64.next_up()).unwrap().is_one());
        // Neither end overflows.
        let most = Factor::new(Some((Metre, Micrometre)), LARGEST).unwrap();
        assert!(most.apply(-LARGEST).is_finite());
        let least = Factor::new(Some((Micrometre, Metre)), SMALLEST).unwrap();
        assert!(least.apply(LARGEST) > 0.0);
    }
}
