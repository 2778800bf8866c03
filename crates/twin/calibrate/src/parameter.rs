//! Parameters that a fit can vary.

use std::fmt;

use serde::{Serialize, Serializer};

/// A parameter that a fit can vary.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Parameter {
    /// A constant of the material, by the name that it has in files: `shear_modulus_kpa`,
    /// `terms[0].alpha`, `prony[0].time_s`. If neither the bulk modulus nor Poisson's ratio is
    /// free, the ratio keeps its described value.
    Constant(String),
    /// Poisson's ratio at small strain.
    PoissonsRatio,
    /// Coulomb's coefficient of friction between gel and indenters, the same for all curves.
    Friction,
    /// True depth of the indenter minus the recorded depth, mm; one for each curve.
    DepthOffset,
    /// Ratio of measured to true force; one for all curves.
    ForceScale,
    /// Measured minus true force at no load, N; one for each curve.
    ForceOffset,
    /// Ratio of a taxel's reading to the pressure at its port; one for each taxel, for all curves.
    /// It is always free where readings are fitted.
    Gain,
}

/// All parameters that are not constants of a material.
const KNOWN: [(&str, Parameter); 6] = [
    ("poissons_ratio", Parameter::PoissonsRatio),
    ("friction", Parameter::Friction),
    ("depth_offset_mm", Parameter::DepthOffset),
    ("force_scale", Parameter::ForceScale),
    ("force_offset_n", Parameter::ForceOffset),
    ("gain", Parameter::Gain),
];

impl Parameter {
    /// The parameter with a name. Any other name is taken for a constant of the material.
    #[must_use]
    pub fn named(name: &str) -> Self {
        let known = KNOWN.into_iter().find(|(known, _)| *known == name);
        known.map_or_else(|| Self::Constant(name.to_owned()), |(_, parameter)| parameter)
    }

    /// Whether the material depends on it.
    #[must_use]
    pub fn is_of_material(&self) -> bool {
        matches!(self, Self::Constant(_) | Self::PoissonsRatio)
    }

    /// Names of all parameters that are not constants of a material.
    pub(crate) fn names() -> impl Iterator<Item = &'static str> {
        KNOWN.into_iter().map(|(name, _)| name)
    }
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Self::Constant(name) = self {
            return f.write_str(name);
        }
        let known = KNOWN.iter().find(|(_, parameter)| parameter == self);
        f.write_str(known.map_or("", |(name, _)| name))
    }
}

impl Serialize for Parameter {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        for name in Parameter::names().chain(["c10_kpa", "prony[0].time_s"]) {
            assert_eq!(Parameter::named(name).to_string(), name);
        }
        assert!(Parameter::named("c10_kpa").is_of_material());
        assert!(!Parameter::named("gain").is_of_material());
    }
}
