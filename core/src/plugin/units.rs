//! Quantities and their units. In the program every number has the unit of its [`Quantity`]: SI units, or degrees if the
//! description of the key has them. Texts with a unit are converted when they are read.

/// The quantity of a number, which determines the unit of a plain number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// A pure number.
    Ratio,
    /// Length \[m\].
    Length,
    /// Angle \[°\].
    Degrees,
    /// Angle \[rad\].
    Radians,
    /// Force \[N\].
    Force,
    /// Stress \[Pa\].
    Stress,
    /// Stiffness of a joint \[Pa/m\].
    Stiffness,
    /// Density \[kg/m³\]; a specific weight (kN/m³) is divided by the study's gravity.
    Density,
    /// Acceleration \[m/s²\].
    Acceleration,
    /// Energy per area \[J/m²\].
    EnergyPerArea,
    /// Temperature \[K\].
    Temperature,
    /// Time \[s\].
    Time,
}

/// Compares texts while the program is compiled.
pub(super) const fn same(one: &str, other: &str) -> bool {
    let (one, other) = (one.as_bytes(), other.as_bytes());
    if one.len() != other.len() {
        return false;
    }
    let mut i = 0;
    while i < one.len() {
        if one[i] != other[i] {
            return false;
        }
        i += 1;
    }
    true
}

const POUND_FORCE: f64 = 4.448_221_615_260_5; // exact: 0.45359237 kg × 9.80665 m/s²
const FOOT: f64 = 0.3048; // exact
const INCH: f64 = 0.0254; // exact
/// Standard gravity \[m/s²\], used for specific weights only if a study has no gravity.
pub const STANDARD_GRAVITY: f64 = 9.80665;

const LENGTHS: &[(&str, f64)] = &[("m", 1.0), ("mm", 1e-3), ("cm", 1e-2), ("ft", FOOT), ("in", INCH)];
const FORCES: &[(&str, f64)] =
    &[("N", 1.0), ("kN", 1e3), ("MN", 1e6), ("lbf", POUND_FORCE), ("kip", 1e3 * POUND_FORCE)];
const STRESSES: &[(&str, f64)] = &[
    ("Pa", 1.0),
    ("kPa", 1e3),
    ("MPa", 1e6),
    ("GPa", 1e9),
    ("N/mm2", 1e6),
    ("kN/m2", 1e3),
    ("psi", POUND_FORCE / (INCH * INCH)),
    ("ksi", 1e3 * POUND_FORCE / (INCH * INCH)),
];
const STIFFNESSES: &[(&str, f64)] = &[("Pa/m", 1.0), ("kPa/m", 1e3), ("MPa/m", 1e6), ("GPa/m", 1e9), ("N/mm3", 1e9)];
const ENERGIES_PER_AREA: &[(&str, f64)] = &[("J/m2", 1.0), ("N/m", 1.0), ("kJ/m2", 1e3), ("N/mm", 1e3)];
const DENSITIES: &[(&str, f64)] = &[("kg/m3", 1.0), ("t/m3", 1e3), ("lb/ft3", 0.453_592_37 / (FOOT * FOOT * FOOT))];
const SPECIFIC_WEIGHTS: &[(&str, f64)] =
    &[("N/m3", 1.0), ("kN/m3", 1e3), ("lbf/ft3", POUND_FORCE / (FOOT * FOOT * FOOT))];
/// A year has 365.25 days.
const TIMES: &[(&str, f64)] = &[("s", 1.0), ("min", 60.0), ("h", 3600.0), ("d", 86_400.0), ("a", 31_557_600.0)];
/// Temperature of 0 °C \[K\].
const ZERO_CELSIUS: f64 = 273.15;
const ACCELERATIONS: &[(&str, f64)] = &[("m/s2", 1.0), ("g", STANDARD_GRAVITY), ("ft/s2", FOOT)];

impl Quantity {
    /// Returns the quantity with this SI unit; `"-"` is the unit of a pure number.
    ///
    /// # Panics
    /// No quantity has this unit.
    pub const fn of_unit(unit: &str) -> Self {
        if same(unit, "-") {
            return Quantity::Ratio;
        }
        let mut i = 0;
        while i < Quantity::ALL.len() {
            if !unit.is_empty() && same(Quantity::ALL[i].unit(), unit) {
                return Quantity::ALL[i];
            }
            i += 1;
        }
        panic!("no quantity has this unit; units of keys: - m deg rad N Pa Pa/m kg/m3 m/s2 J/m2 K s")
    }

    /// All quantities.
    pub const ALL: [Quantity; 12] = [
        Quantity::Ratio,
        Quantity::Length,
        Quantity::Degrees,
        Quantity::Radians,
        Quantity::Force,
        Quantity::Stress,
        Quantity::Stiffness,
        Quantity::Density,
        Quantity::Acceleration,
        Quantity::EnergyPerArea,
        Quantity::Temperature,
        Quantity::Time,
    ];

    /// Returns the unit of a plain number; empty for a ratio.
    pub const fn unit(self) -> &'static str {
        match self {
            Quantity::Ratio => "",
            Quantity::Length => "m",
            Quantity::Degrees => "deg",
            Quantity::Radians => "rad",
            Quantity::Force => "N",
            Quantity::Stress => "Pa",
            Quantity::Stiffness => "Pa/m",
            Quantity::Density => "kg/m3",
            Quantity::Acceleration => "m/s2",
            Quantity::EnergyPerArea => "J/m2",
            Quantity::Temperature => "K",
            Quantity::Time => "s",
        }
    }

    /// Returns the unit names, each with the factor that converts a number into the quantity's own unit. `gravity` \[m/s²\]
    /// converts a specific weight into a density.
    fn table(self, gravity: f64) -> Vec<(&'static str, f64)> {
        match self {
            Quantity::Ratio => vec![("%", 0.01)],
            Quantity::Length => LENGTHS.to_vec(),
            Quantity::Degrees => vec![("deg", 1.0), ("rad", 180.0 / std::f64::consts::PI), ("°", 1.0)],
            Quantity::Radians => {
                let degree = std::f64::consts::PI / 180.0;
                vec![("rad", 1.0), ("deg", degree), ("°", degree)]
            }
            Quantity::Force => FORCES.to_vec(),
            Quantity::Stress => STRESSES.to_vec(),
            Quantity::Stiffness => STIFFNESSES.to_vec(),
            Quantity::Density => {
                let weights = SPECIFIC_WEIGHTS.iter().map(|&(name, factor)| (name, factor / gravity));
                DENSITIES.iter().copied().chain(weights).collect()
            }
            Quantity::Acceleration => ACCELERATIONS.to_vec(),
            Quantity::EnergyPerArea => ENERGIES_PER_AREA.to_vec(),
            Quantity::Temperature => vec![("K", 1.0)],
            Quantity::Time => TIMES.to_vec(),
        }
    }

    /// Reads `"5 GPa"`. The unit may be omitted. Errors describe the mistake and list the valid units.
    pub fn parse(self, text: &str, gravity: f64) -> Result<f64, String> {
        let text = text.trim();
        let split = text
            .char_indices()
            .find(|&(i, c)| {
                let exponent = (c == 'e' || c == 'E')
                    && text[i + 1..].starts_with(|d: char| d.is_ascii_digit() || d == '-' || d == '+');
                !(c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | '_') || exponent)
            })
            .map_or(text.len(), |(i, _)| i);
        let (number, unit) = (text[..split].replace('_', ""), text[split..].trim());
        let number: f64 = number.parse().map_err(|_| format!("\"{text}\" does not start with a number"))?;
        if unit.is_empty() {
            return Ok(number);
        }
        let unit = unit.replace('²', "2").replace('³', "3").replace('^', "");
        if self == Quantity::Temperature && unit == "°C" {
            return Ok(number + ZERO_CELSIUS);
        }
        let table = self.table(gravity);
        match table.iter().find(|(name, _)| *name == unit) {
            // Division by an inverse power of ten is correctly rounded; multiplication by 1e-3 is not.
            Some(&(_, factor)) if factor < 1.0 && (1.0 / factor).fract() == 0.0 => Ok(number / (1.0 / factor)),
            Some(&(_, factor)) => Ok(number * factor),
            None if unit.starts_with(',') => {
                let point = text.replacen(',', ".", 1);
                Err(format!("\"{text}\" has a comma where a decimal point is meant: write \"{point}\""))
            }
            None if self == Quantity::Ratio && ["deg", "°", "rad"].contains(&unit.as_str()) => {
                let angle = if unit == "rad" { number } else { number.to_radians() };
                Err(format!(
                    "\"{text}\" is an angle, and a pure number is meant here; the tangent of the angle is {:.4} (a friction may \
                     also be given as friction_angle)",
                    angle.tan()
                ))
            }
            None => {
                let celsius = (self == Quantity::Temperature).then_some("°C");
                let names: Vec<_> = table.iter().map(|(name, _)| *name).chain(celsius).collect();
                Err(format!("unit \"{unit}\" does not fit; units here: {}", names.join(", ")))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_with_units_become_si() {
        let read = |q: Quantity, t: &str| q.parse(t, 9.81).unwrap();
        assert_eq!(read(Quantity::Stress, "5 GPa"), 5e9);
        assert_eq!(read(Quantity::Stress, "10N/mm2"), 1e7);
        assert_eq!(read(Quantity::Length, "600 mm"), 0.6);
        assert_eq!(read(Quantity::Length, "1e-1 m"), 0.1);
        assert_eq!(read(Quantity::Length, "2E3mm"), 2.0);
        assert_eq!(read(Quantity::Force, "3e+1 kN"), 30_000.0);
        assert_eq!(read(Quantity::Force, "-1_000"), -1000.0);
        assert!((read(Quantity::Density, "21.582 kN/m3") - 2200.0).abs() < 1e-9);
        assert!((read(Quantity::Stress, "1 psi") - 6_894.757_293_168).abs() < 1e-6);
        assert_eq!(read(Quantity::Degrees, "25°"), 25.0);
        assert_eq!(read(Quantity::Temperature, "20 °C"), 293.15);
        assert_eq!(read(Quantity::Temperature, "-10 °C"), 263.15);
        assert_eq!(read(Quantity::Time, "30 d"), 2_592_000.0);
        assert!((read(Quantity::Radians, "180 deg") - std::f64::consts::PI).abs() < 1e-15);
    }

    /// Every unit of every quantity with its value in the quantity's own unit, from its definition: the international yard and
    /// pound of 1959 (0.9144 m, 0.45359237 kg), standard gravity of 1901 (9.80665 m/s²), π. The value of a specific weight depends
    /// on the gravity of the study, 10 m/s² here.
    const UNITS: &[(Quantity, &[(&str, f64)])] = &[
        (Quantity::Ratio, &[("%", 0.01)]),
        (Quantity::Length, &[("m", 1.0), ("mm", 0.001), ("cm", 0.01), ("ft", 0.3048), ("in", 0.0254)]),
        (Quantity::Degrees, &[("deg", 1.0), ("rad", 57.295_779_513_082_32), ("°", 1.0)]),
        (Quantity::Radians, &[("rad", 1.0), ("deg", 0.017_453_292_519_943_295), ("°", 0.017_453_292_519_943_295)]),
        (
            Quantity::Force,
            &[("N", 1.0), ("kN", 1e3), ("MN", 1e6), ("lbf", 4.448_221_615_260_5), ("kip", 4_448.221_615_260_5)],
        ),
        (
            Quantity::Stress,
            &[
                ("Pa", 1.0),
                ("kPa", 1e3),
                ("MPa", 1e6),
                ("GPa", 1e9),
                ("N/mm2", 1e6),
                ("kN/m2", 1e3),
                ("psi", 6_894.757_293_168_361),
                ("ksi", 6_894_757.293_168_361),
            ],
        ),
        (Quantity::Stiffness, &[("Pa/m", 1.0), ("kPa/m", 1e3), ("MPa/m", 1e6), ("GPa/m", 1e9), ("N/mm3", 1e9)]),
        (
            Quantity::Density,
            &[
                ("kg/m3", 1.0),
                ("t/m3", 1e3),
                ("lb/ft3", 16.018_463_373_960_14),
                ("N/m3", 0.1),
                ("kN/m3", 100.0),
                ("lbf/ft3", 15.708_746_384_624_62),
            ],
        ),
        (Quantity::Acceleration, &[("m/s2", 1.0), ("g", 9.80665), ("ft/s2", 0.3048)]),
        (Quantity::EnergyPerArea, &[("J/m2", 1.0), ("N/m", 1.0), ("kJ/m2", 1e3), ("N/mm", 1e3)]),
        (Quantity::Temperature, &[("K", 1.0)]),
        (Quantity::Time, &[("s", 1.0), ("min", 60.0), ("h", 3600.0), ("d", 86_400.0), ("a", 31_557_600.0)]),
    ];

    #[test]
    fn every_unit_has_the_value_of_its_definition() {
        assert_eq!(UNITS.len(), Quantity::ALL.len());
        for (quantity, units) in UNITS {
            let names: Vec<_> = quantity.table(10.0).into_iter().map(|(name, _)| name).collect();
            assert_eq!(names, units.iter().map(|(name, _)| *name).collect::<Vec<_>>(), "{quantity:?}");
            for (name, value) in *units {
                for number in [1.0, -3.0, 0.7] {
                    let read = quantity.parse(&format!("{number} {name}"), 10.0).unwrap();
                    let expected = number * value;
                    let off = (read - expected).abs() / expected.abs();
                    assert!(off <= 2.0 * f64::EPSILON, "{number} {name}: {read}, not {expected}");
                }
            }
            let own = if quantity.unit().is_empty() { "-" } else { quantity.unit() };
            assert_eq!(Quantity::of_unit(own), *quantity);
            assert_eq!(quantity.parse("1.5", 10.0), Ok(1.5), "a plain number is in the quantity's own unit");
        }
    }

    #[test]
    #[should_panic = "no quantity has this unit"]
    fn a_unit_that_is_not_si_is_none_of_a_key() {
        Quantity::of_unit("MPa");
    }

    #[test]
    fn a_wrong_unit_is_named_with_those_that_fit() {
        let error = Quantity::Length.parse("3 kN", 9.81).unwrap_err();
        assert_eq!(error, "unit \"kN\" does not fit; units here: m, mm, cm, ft, in");
        assert!(Quantity::Force.parse("kN", 9.81).is_err());
        let said = |quantity: Quantity, text: &str| quantity.parse(text, 9.81).unwrap_err();
        assert!(said(Quantity::Length, "0,60 m").contains("write \"0.60 m\""));
        assert!(said(Quantity::Length, "0,60").contains("write \"0.60\""));
        assert!(said(Quantity::Ratio, "35 deg").contains("0.7002"));
        assert!(said(Quantity::Ratio, "35°").contains("friction_angle"));
        assert!(said(Quantity::Ratio, "0.6 rad").contains("0.6841"));
        assert_eq!(said(Quantity::Temperature, "20 F"), "unit \"F\" does not fit; units here: K, °C");
        assert_eq!(said(Quantity::Length, "3em"), "unit \"em\" does not fit; units here: m, mm, cm, ft, in");
    }
}
