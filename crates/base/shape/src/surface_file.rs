//! A triangle surface that a description names.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::ShapeError;
use crate::shape_error::above_zero;

/// A closed triangle surface in an STL file, and the unit of its lengths, which STL files do not
/// state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SurfaceFile {
    /// Path of the STL file, relative to the file that names it.
    pub path: String,
    /// Unit of its lengths: `"mm"`, `"cm"`, `"m"` or `"inch"`; mm if neither this nor `scale` is
    /// given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<LengthUnit>,
    /// Length of 1 in the file, in mm; used instead of `unit`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
}

/// A unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum LengthUnit {
    /// Millimetre.
    #[serde(rename = "mm")]
    Millimetre,
    /// Centimetre.
    #[serde(rename = "cm")]
    Centimetre,
    /// Metre.
    #[serde(rename = "m")]
    Metre,
    /// Inch, 25.4 mm.
    #[serde(rename = "inch")]
    Inch,
}

impl LengthUnit {
    /// All units, with the names that they have in files.
    pub const NAMED: [(&str, Self); 4] = [
        ("mm", Self::Millimetre),
        ("cm", Self::Centimetre),
        ("m", Self::Metre),
        ("inch", Self::Inch),
    ];

    /// Length of the unit, mm.
    #[must_use]
    pub fn in_mm(self) -> f64 {
        match self {
            Self::Millimetre => 1.0,
            Self::Centimetre => 10.0,
            Self::Metre => 1000.0,
            Self::Inch => 25.4,
        }
    }
}

impl std::str::FromStr for LengthUnit {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::NAMED.iter().find(|(known, _)| *known == name);
        let expected = || {
            format!(
                "expected one of {}",
                Self::NAMED.map(|(known, _)| known).join(", ")
            )
        };
        found.map(|&(_, unit)| unit).ok_or_else(expected)
    }
}

impl SurfaceFile {
    /// A surface with lengths in mm.
    pub fn new(path: impl Into<String>) -> Self {
        Self {
            path: path.into(),
            unit: None,
            scale: None,
        }
    }

    /// Length of 1 in the file, mm.
    #[must_use]
    pub fn mm_per_unit(&self) -> f64 {
        let unit = self.unit.unwrap_or(LengthUnit::Millimetre);
        self.scale.unwrap_or(unit.in_mm())
    }

    /// The name of the surface in [`crate::Surfaces`]: its path, and its scale unless that is mm.
    #[must_use]
    pub fn name(&self) -> Cow<'_, str> {
        match self.mm_per_unit() {
            1.0 => Cow::Borrowed(&self.path),
            scale => Cow::Owned(format!("{} × {scale}", self.path)),
        }
    }

    /// Checks that such a surface is possible.
    ///
    /// # Errors
    /// An empty path, a scale that is not a number above 0, or a scale beside a unit.
    pub fn validate(&self) -> Result<(), ShapeError> {
        if self.path.is_empty() {
            return Err(ShapeError::new("path", "empty", "the path of an STL file"));
        }
        let Some(scale) = self.scale else {
            return Ok(());
        };
        if self.unit.is_some() {
            let found = format!("{scale}, although a unit is given");
            return Err(ShapeError::new("scale", found, "only one of the two"));
        }
        above_zero("scale", scale)
    }
}
