//! Transfer functions: colours and opacities of the values of voxels.

use super::light::Light;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::valid::{length as valid_length, numbers};
use crate::memory;
use alloc::vec::Vec;
use glam::DVec3;

/// A colour map: a colour for every number from 0 to 1. Equal steps of the number look like equal steps of
/// the colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ColourMap {
    /// From dark violet through green to yellow (van der Walt and Smith).
    #[default]
    Viridis,
    /// From dark blue to yellow; it looks the same to colour-blind readers (Nuñez, Anderton and Renslow).
    Cividis,
    /// From black through red to light yellow (van der Walt and Smith).
    Inferno,
    /// From black through purple to near white (van der Walt and Smith).
    Magma,
    /// From dark blue through red to yellow (van der Walt and Smith).
    Plasma,
    /// From black to white.
    Grey,
}

/// The number of colours of a map.
const STEPS: usize = 256;

impl ColourMap {
    /// All maps.
    pub const ALL: [ColourMap; 6] = [
        ColourMap::Viridis,
        ColourMap::Cividis,
        ColourMap::Inferno,
        ColourMap::Magma,
        ColourMap::Plasma,
        ColourMap::Grey,
    ];

    /// The map's name: `viridis`, `cividis`, `inferno`, `magma`, `plasma` or `grey`.
    pub fn name(self) -> &'static str {
        match self {
            ColourMap::Viridis => "viridis",
            ColourMap::Cividis => "cividis",
            ColourMap::Inferno => "inferno",
            ColourMap::Magma => "magma",
            ColourMap::Plasma => "plasma",
            ColourMap::Grey => "grey",
        }
    }

    /// Returns the map with this name.
    ///
    /// # Errors
    /// [`Error::Argument`] if no map has this name.
    pub fn from_name(name: &str) -> Result<ColourMap, Error> {
        let problem = "must be viridis, cividis, inferno, magma, plasma or grey";
        let found = ColourMap::ALL.into_iter().find(|map| map.name() == name);
        found.ok_or(Error::Argument { name: "map", problem })
    }

    /// Returns the colour of a number: red, green and blue in sRGB. Numbers below 0 have the first colour,
    /// numbers above 1 the last one; NaN has the first. A map has 256 colours, and the nearest one is taken.
    pub fn colour(self, number: f64) -> [u8; 3] {
        self.step(step_of(number))
    }

    fn step(self, step: usize) -> [u8; 3] {
        let gradient = match self {
            ColourMap::Viridis => colorous::VIRIDIS,
            ColourMap::Cividis => colorous::CIVIDIS,
            ColourMap::Inferno => colorous::INFERNO,
            ColourMap::Magma => colorous::MAGMA,
            ColourMap::Plasma => colorous::PLASMA,
            ColourMap::Grey => return [step as u8; 3],
        };
        let colour = gradient.eval_rational(step, STEPS);
        [colour.r, colour.g, colour.b]
    }
}

/// The nearest of the 256 steps from 0 to 1.
fn step_of(number: f64) -> usize {
    // A conversion takes NaN to 0.
    (number.clamp(0.0, 1.0) * (STEPS - 1) as f64 + 0.5) as usize
}

/// A transfer function: the colour and the opacity of a value.
///
/// A value of one number has the colour of a [`ColourMap`] over a range. A value of three or four numbers is
/// a colour itself: red, green and blue in sRGB, 0 to 255, and an opacity, 0 to 255, that scales the transfer
/// function's opacity. (For a value of two numbers only the first counts.) Numbers beyond the ends of their
/// range count as the end.
///
/// The opacity holds for a path of a given length. If such a path absorbs the share α of the light, a path of
/// length s transmits (1 − α)^(s / length). So a picture does not depend on how finely a solid is divided
/// into voxels.
///
/// ```
/// use leafless::render::{ColourMap, Transfer};
/// // Temperatures of 20 to 80 degrees. 3 mm of the material absorb half of the light.
/// let transfer = Transfer::new(ColourMap::Viridis, [20.0, 80.0], 0.5, 3.0)?;
/// assert_eq!(transfer.colour(&[100.0]), ColourMap::Viridis.colour(1.0));
/// assert!((transfer.opacity(&[50.0], 6.0) - 0.75).abs() < 1e-15);
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transfer {
    map: ColourMap,
    range: [f64; 2],
    alpha: [f64; 2],
    length: f64,
}

impl Transfer {
    /// The colour of voxels without a value: a neutral grey, in sRGB.
    pub const NEUTRAL: [u8; 3] = [160; 3];

    /// Creates a transfer function that maps the values from `range[0]` to `range[1]` to the colours of a
    /// map. The opacity `alpha`, 0 to 1, holds for a path of `length` model units, for all values.
    ///
    /// # Errors
    /// [`Error::Argument`] if a number is not zero and not between 2^-256 and 2^256 in magnitude, if the
    /// range is empty, if `alpha` is not in [0, 1], or if `length` is not above 0.
    pub fn new(map: ColourMap, range: [f64; 2], alpha: f64, length: f64) -> Result<Transfer, Error> {
        numbers("range", &range)?;
        if range[0] >= range[1] {
            return Err(Error::Argument { name: "range", problem: "the low end must be below the high end" });
        }
        valid_length("length", length)?;
        Transfer { map, range, alpha: [alpha; 2], length }.ramp([alpha; 2])
    }

    /// Sets an opacity that rises or falls linearly from `alpha[0]` at the low end of the range to `alpha[1]`
    /// at the high end. Voxels without a value, and values that are colours, have the opacity `alpha[1]`.
    ///
    /// # Errors
    /// [`Error::Argument`] if one of the two numbers is not in [0, 1].
    pub fn ramp(self, alpha: [f64; 2]) -> Result<Transfer, Error> {
        if !alpha.iter().all(|alpha| (0.0..=1.0).contains(alpha)) {
            return Err(Error::Argument { name: "alpha", problem: "must be 0 to 1" });
        }
        Ok(Transfer { alpha, ..self })
    }

    /// The colour map.
    pub fn map(&self) -> ColourMap {
        self.map
    }

    /// The values at both ends of the map.
    pub fn range(&self) -> [f64; 2] {
        self.range
    }

    /// The opacities at both ends of the range, 0 to 1.
    pub fn alpha(&self) -> [f64; 2] {
        self.alpha
    }

    /// The length of a path with these opacities, in model units.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Returns the colour of a value: red, green and blue in sRGB. An empty value, or one that contains NaN,
    /// counts as missing.
    pub fn colour(&self, value: &[f64]) -> [u8; 3] {
        match *value {
            [r, g, b] | [r, g, b, _] if is_known(value) => [r, g, b].each(|x| step_of(x / 255.0) as u8),
            [x] | [x, _] if is_known(value) => self.map.colour(self.place(x)),
            _ => Transfer::NEUTRAL,
        }
    }

    /// Returns the opaque colour of a surface with a value of `components` numbers:
    /// [`NEUTRAL`](Self::NEUTRAL) for a missing value.
    pub fn opaque(&self, value: Option<[f64; 4]>, components: usize) -> [u8; 4] {
        let value = value.as_ref().map_or(&[][..], |value| &value[..components.min(4)]);
        let [r, g, b] = self.colour(value);
        [r, g, b, 255]
    }

    /// Returns the opacity, 0 to 1, of a path of `path` model units through a value.
    pub fn opacity(&self, value: &[f64], path: f64) -> f64 {
        let path = path.max(0.0);
        if path == 0.0 { 0.0 } else { absorbed(depth_of(self.alpha_of(value)) * (path / self.length)) }
    }

    /// The opacity of a path of [`length`](Self::length) through a value.
    fn alpha_of(&self, value: &[f64]) -> f64 {
        let [low, high] = self.alpha;
        match *value {
            [_, _, _, opacity] if is_known(value) => high * (opacity / 255.0).clamp(0.0, 1.0),
            [x] | [x, _] if is_known(value) && low != high => {
                let place = self.place(x);
                (low * (1.0 - place) + high * place).clamp(0.0, 1.0)
            }
            _ => high,
        }
    }

    /// The place of a value in the range: 0 to 1.
    fn place(&self, value: f64) -> f64 {
        let [low, high] = self.range;
        ((value - low) / (high - low)).clamp(0.0, 1.0)
    }
}

fn is_known(value: &[f64]) -> bool {
    !value.iter().any(|number| number.is_nan())
}

/// The optical depth of an opacity: minus the logarithm of the transmitted share; ∞ if the share is 0.
pub fn depth_of(opacity: f64) -> f64 {
    -libm::log1p(-opacity)
}

/// The opacity of an optical depth ≥ 0.
#[inline(always)]
pub fn absorbed(depth: f64) -> f64 {
    if depth < 0.125 {
        // Most paths are short. The series leaves out less than 1e-14 of the opacity.
        let series = [9.0, 8.0, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0];
        return depth * series.iter().fold(1.0, |sum, k| 1.0 - depth * (1.0 / k) * sum);
    }
    1.0 - libm::exp(-depth)
}

/// A transfer function prepared for the values of many voxels.
pub struct Looks {
    transfer: Transfer,
    /// The linear colours of the map, of the bytes in sRGB (each as one number thrice), and of missing
    /// values.
    map: Vec<DVec3>,
    bytes: Vec<f64>,
    neutral: DVec3,
    /// The opacity at the high end, and its optical depth.
    usual: (f64, f64),
}

impl Looks {
    pub fn new(transfer: &Transfer) -> Result<Looks, Error> {
        let light = |[r, g, b]: [u8; 3]| Light::of([r, g, b, 255]).0.truncate().as_dvec3();
        Ok(Looks {
            transfer: *transfer,
            map: memory::collected((0..STEPS).map(|step| light(transfer.map.step(step))))?,
            bytes: memory::collected((0..STEPS).map(|byte| light([byte as u8; 3]).x))?,
            neutral: light(Transfer::NEUTRAL),
            usual: (transfer.alpha[1], depth_of(transfer.alpha[1])),
        })
    }

    /// The linear colour of a value, and the optical depth of a path of the transfer function's length.
    #[inline]
    pub fn of(&self, value: &[f64]) -> (DVec3, f64) {
        let colour = match *value {
            [r, g, b] | [r, g, b, _] if is_known(value) => {
                DVec3::from([r, g, b].each(|x| self.bytes[step_of(x / 255.0)]))
            }
            [x] | [x, _] if is_known(value) => self.map[step_of(self.transfer.place(x))],
            _ => self.neutral,
        };
        let alpha = self.transfer.alpha_of(value);
        (colour, if alpha == self.usual.0 { self.usual.1 } else { depth_of(alpha) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absorbed_is_one_minus_an_exponential() {
        for i in 0..4000 {
            let depth = f64::from(i) * 0.001;
            let exact = -libm::expm1(-depth);
            assert!((absorbed(depth) - exact).abs() <= 1e-14 * exact + 1e-16, "{depth}");
        }
        assert_eq!((absorbed(0.0), absorbed(f64::INFINITY), depth_of(1.0)), (0.0, 1.0, f64::INFINITY));
    }

    #[test]
    fn looks_are_those_of_the_transfer_function() {
        let transfer = Transfer::new(ColourMap::Magma, [-1.0, 3.0], 0.3, 2.0).unwrap();
        for transfer in [transfer, transfer.ramp([0.0, 1.0]).unwrap()] {
            let looks = Looks::new(&transfer).unwrap();
            let values: [&[f64]; 8] = [
                &[],
                &[-7.0],
                &[0.3],
                &[f64::NAN],
                &[f64::INFINITY],
                &[1.0, 5.0],
                &[255.0, 30.2, -4.0],
                &[1.0, 2.0, 3.0, 40.0],
            ];
            for value in values {
                let [r, g, b] = transfer.colour(value);
                let (colour, depth) = looks.of(value);
                let light = Light::of([r, g, b, 255]).0.truncate().as_dvec3();
                assert!((colour - light).length() < 1e-7, "{value:?}");
                let opacity = transfer.opacity(value, 2.0);
                assert!((absorbed(depth) - opacity).abs() < 1e-12, "{value:?}");
            }
        }
    }
}
