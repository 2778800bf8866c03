//! A number of a description that is varied, with its bounds.

use std::str::FromStr;

/// A number of a description, and the bounds between which it is varied. As text:
/// `gel.height_mm=4..10`.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// The number's path in the description, with array indices from 0, such as
    /// `gel.material.shear_modulus_kpa` or `gel.solid.size_mm[2]`. The path of an array of tables
    /// without an index means all of its tables: `taxels.port_radius_mm`. Two paths are derived
    /// quantities and not numbers of a description: `gel.height_mm` and `taxels.pitch_mm`.
    pub field: String,
    /// Smallest and largest value, in the unit of the field.
    pub bounds: [f64; 2],
}

impl FromStr for Variable {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let form = || format!("`{text}` is not of the form FIELD=LOW..HIGH, such as gel.height_mm=4..10");
        let (field, bounds) = text.split_once('=').ok_or_else(form)?;
        let (low, high) = bounds.split_once("..").ok_or_else(form)?;
        let number = |text: &str| text.trim().parse::<f64>().map_err(|_| form());
        let bounds = [number(low)?, number(high)?];
        let field = field.trim();
        if field.is_empty() {
            return Err(form());
        }
        if !(bounds[0].is_finite() && bounds[1].is_finite() && bounds[0] < bounds[1]) {
            return Err(format!(
                "the bounds of `{text}` must be finite, the smaller first"
            ));
        }
        Ok(Self {
            field: field.to_owned(),
            bounds,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_two_numbers_the_smaller_first() {
        let height: Variable = "gel.height_mm=4..10".parse().unwrap();
        assert_eq!(
            (height.field.as_str(), height.bounds),
            ("gel.height_mm", [4.0, 10.0])
        );
        let offset: Variable = "gel.solid.center_mm[0] = -1.5..2.5".parse().unwrap();
        assert_eq!(offset.bounds, [-1.5, 2.5]);
        for wrong in [
            "",
            "gel.height_mm",
            "gel.height_mm=4",
            "=1..2",
            "a=2..1",
            "a=1..1",
            "a=1..nan",
            "a=1..inf",
            "a=1...2",
            "a=x..2",
        ] {
            assert!(wrong.parse::<Variable>().is_err(), "{wrong}");
        }
    }
}
