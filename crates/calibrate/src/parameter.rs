//! What can be free in a fit.

use std::fmt;
use std::str::FromStr;

use crate::CalibrateError;

/// Something that a fit can leave open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Parameter {
    /// Shear modulus of a neo-Hookean gel, kPa.
    ShearModulus,
    /// `C10` of a Mooney–Rivlin or Yeoh gel, kPa.
    C10,
    /// `C01` of a Mooney–Rivlin gel, kPa.
    C01,
    /// `C20` of a Yeoh gel, kPa.
    C20,
    /// `C30` of a Yeoh gel, kPa.
    C30,
    /// Bulk modulus, kPa. If neither it nor Poisson's ratio is free, the ratio stays as described.
    BulkModulus,
    /// Poisson's ratio at small strain.
    PoissonsRatio,
    /// Weight of a Prony term, by index.
    PronyWeight(usize),
    /// Time of a Prony term, by index, s.
    PronyTime(usize),
    /// By how much the indenter is deeper than a curve says, mm; each curve has its own.
    DepthOffset,
    /// Measured over true force, the same for all curves.
    ForceScale,
    /// Measured less true force at no load, N; each curve has its own.
    ForceOffset,
    /// Reading over pressure at the port; each taxel has its own, the same for all curves. Always free where readings are fitted.
    Gain,
}

const KNOWN: [(&str, Parameter); 11] = [
    ("shear_modulus_kpa", Parameter::ShearModulus),
    ("c10_kpa", Parameter::C10),
    ("c01_kpa", Parameter::C01),
    ("c20_kpa", Parameter::C20),
    ("c30_kpa", Parameter::C30),
    ("bulk_modulus_kpa", Parameter::BulkModulus),
    ("poissons_ratio", Parameter::PoissonsRatio),
    ("depth_offset_mm", Parameter::DepthOffset),
    ("force_scale", Parameter::ForceScale),
    ("force_offset_n", Parameter::ForceOffset),
    ("gain", Parameter::Gain),
];

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::PronyWeight(term) => write!(f, "prony[{term}].weight"),
            Self::PronyTime(term) => write!(f, "prony[{term}].time_s"),
            _ => {
                let known = KNOWN.iter().find(|(_, parameter)| parameter == self);
                f.write_str(known.map_or("", |(name, _)| name))
            }
        }
    }
}

impl FromStr for Parameter {
    type Err = CalibrateError;

    fn from_str(name: &str) -> Result<Self, CalibrateError> {
        if let Some((_, parameter)) = KNOWN.iter().find(|(known, _)| *known == name) {
            return Ok(*parameter);
        }
        let of_term = |field: &str| -> Option<usize> {
            let term = name.strip_prefix("prony[")?.strip_suffix(field)?;
            term.strip_suffix("].")?.parse().ok()
        };
        if let Some(term) = of_term("weight") {
            return Ok(Self::PronyWeight(term));
        }
        if let Some(term) = of_term("time_s") {
            return Ok(Self::PronyTime(term));
        }
        let names: Vec<&str> = KNOWN.iter().map(|(name, _)| *name).collect();
        Err(CalibrateError::Parameter {
            name: name.to_owned(),
            known: format!("{}, prony[0].weight, prony[0].time_s", names.join(", ")),
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        let terms = [Parameter::PronyWeight(0), Parameter::PronyTime(12)];
        for parameter in KNOWN.iter().map(|(_, parameter)| *parameter).chain(terms) {
            assert_eq!(parameter.to_string().parse::<Parameter>().unwrap(), parameter);
        }
        for wrong in ["stiffness", "prony[x].weight", "prony[0]", "prony[0].", ""] {
            assert!(wrong.parse::<Parameter>().is_err(), "{wrong}");
        }
    }
}
