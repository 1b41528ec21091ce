//! Densities, and the masses that follow from volumes.

use leafless::Interval;
use leafless::exchange::LengthUnit;
use serde::{Deserialize, Serialize};

/// A density as the user writes it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Density {
    number: f64,
    /// Grams and micrometres of the unit, if there is one: the unit of mass, and the edge of the cube.
    unit: Option<(f64, f64)>,
}

/// Names of units of density, with their grams and the micrometres of the edge.
const UNITS: [(&str, f64, f64); 4] =
    [("g/cm3", 1.0, 1e4), ("kg/m3", 1e3, 1e6), ("kg/dm3", 1e3, 1e5), ("lb/in3", 453.59237, 25_400.0)];

/// Parses a density: a number, with or without a unit.
pub fn density(text: &str) -> Result<Density, String> {
    let known =
        UNITS.into_iter().find_map(|(name, grams, edge)| Some((text.strip_suffix(name)?, (grams, edge))));
    let (number, unit) = known.map_or((text, None), |(number, unit)| (number, Some(unit)));
    match number.trim().parse() {
        Ok(number @ 0.0..f64::INFINITY) if number > 0.0 => Ok(Density { number, unit }),
        _ => Err("expected a number above 0, alone or with one of the units g/cm3, kg/dm3, kg/m3 and lb/in3"
            .into()),
    }
}

impl Density {
    /// Returns a density without a unit: the mass of a cubic model unit.
    pub fn of_number(number: f64) -> Density {
        Density { number, unit: None }
    }

    /// Returns the mass of a cubic model unit, and the unit of that mass.
    pub fn of_cube(&self, unit: Option<LengthUnit>) -> Result<(f64, MassUnit), String> {
        let Some((grams, edge)) = self.unit else { return Ok((self.number, MassUnit::Unknown)) };
        let unit = unit.ok_or(
            "the unit of the model is unknown: give it, as in --unit mm, or give the mass of a cubic \
             unit as a plain number",
        )?;
        let part = f64::from(unit.micrometres()) / edge;
        Ok((self.number * grams * part * part * part, MassUnit::Gram))
    }
}

/// The unit of a mass.
#[derive(Debug, Serialize, Deserialize, Clone, Copy, PartialEq)]
pub enum MassUnit {
    #[serde(rename = "")]
    Unknown,
    #[serde(rename = "g")]
    Gram,
}

impl MassUnit {
    pub fn name(self) -> &'static str {
        match self {
            MassUnit::Unknown => "",
            MassUnit::Gram => "g",
        }
    }
}

/// Returns the product with a positive number, rounded outward.
pub fn times(interval: Interval, factor: f64) -> Interval {
    let [lower, upper] = [interval.lower * factor, interval.upper * factor];
    let end = |product: f64, rounded: f64| if product == 0.0 { 0.0 } else { rounded };
    Interval::new(end(lower, lower.next_down()), end(upper, upper.next_up())).unwrap_or(Interval::ALL)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn densities_know_their_units() {
        let mass = |text: &str, unit| density(text).unwrap().of_cube(unit);
        let near = |found: Result<(f64, MassUnit), String>, wanted: f64| {
            let (mass, unit) = found.unwrap();
            assert!((mass / wanted - 1.0).abs() < 1e-14 && unit == MassUnit::Gram, "{mass} {wanted}");
        };
        assert_eq!(mass("7.85", None), Ok((7.85, MassUnit::Unknown)));
        near(mass("7.85g/cm3", Some(LengthUnit::Millimetre)), 0.00785);
        near(mass("7850 kg/m3", Some(LengthUnit::Centimetre)), 7.85);
        near(mass("1lb/in3", Some(LengthUnit::Inch)), 453.59237);
        assert!(mass("1kg/dm3", None).unwrap_err().contains("--unit"));
        for text in ["", "0", "-1", "x", "1 g", "inf", "nan", "g/cm3"] {
            assert!(density(text).is_err(), "{text}");
        }
    }
}
