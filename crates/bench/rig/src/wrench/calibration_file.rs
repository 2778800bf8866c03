//! ATI's calibration files (`.cal`): XML with a matrix in units that the user chose.

use roxmltree::{Document, Node};

use super::AnalogCalibration;
use super::calibration::usual_range_v;
use crate::RigError;
use crate::units::{newton_millimetres, newtons};

const AXES: [&str; 6] = ["Fx", "Fy", "Fz", "Tx", "Ty", "Tz"];

impl AnalogCalibration {
    /// Reads a calibration from the text of a `.cal` file: the elements
    /// `FTSensor/Calibration/UserAxis`. These axes already include the transform of the file's
    /// `BasicTransform`. The bias is zero: take it from voltages without load
    /// ([`AnalogCalibration::with_bias`]).
    ///
    /// # Errors
    /// Text that is no such file; a missing element, attribute or axis; numbers that cannot be
    /// read; unknown units.
    pub fn parse_cal(file: &str, text: &str) -> Result<Self, RigError> {
        let document =
            Document::parse(text).map_err(|found| RigError::file(file, format!("is not XML: {found}")))?;
        let root = document.root_element();
        if !root.has_tag_name("FTSensor") {
            let problem = format!("its root is `{}`, expected `FTSensor`", root.tag_name().name());
            return Err(RigError::file(file, problem));
        }
        let calibration = root
            .children()
            .find(|node| node.has_tag_name("Calibration"))
            .ok_or_else(|| RigError::file(file, "has no element `Calibration`"))?;
        let unit = |name: &str, known: fn(&str) -> Option<f64>| {
            let text = calibration
                .attribute(name)
                .ok_or_else(|| RigError::file(file, format!("`Calibration` has no attribute `{name}`")))?;
            known(text).ok_or_else(|| {
                RigError::file(file, format!("`{name}` is `{text}`, which is not a known unit"))
            })
        };
        let force_n = unit("ForceUnits", newtons)?;
        let torque_n_mm = unit("TorqueUnits", newton_millimetres)?;
        let mut matrix = [[0.0; 6]; 6];
        for (index, (row, name)) in matrix.iter_mut().zip(AXES).enumerate() {
            let scale = if index < 3 { force_n } else { torque_n_mm };
            *row = axis(&calibration, name)
                .map_err(|problem| RigError::file(file, problem))?
                .map(|number| number * scale);
        }
        Ok(Self {
            matrix,
            bias_v: [0.0; 6],
            range_v: usual_range_v(),
        })
    }
}

/// The numbers of an axis, in the file's units per volt.
fn axis(calibration: &Node<'_, '_>, name: &str) -> Result<[f64; 6], String> {
    let mut found = calibration
        .children()
        .filter(|node| node.has_tag_name("UserAxis") && node.attribute("Name") == Some(name));
    let (Some(node), None) = (found.next(), found.next()) else {
        return Err(format!("expected one `UserAxis` with the name `{name}`"));
    };
    let text = node.attribute("values").unwrap_or_default();
    let numbers: Vec<f64> = text
        .split_whitespace()
        .filter_map(|word| word.parse().ok())
        .filter(|number: &f64| number.is_finite())
        .collect();
    match <[f64; 6]>::try_from(numbers) {
        Ok(row) if text.split_whitespace().count() == 6 => Ok(row),
        _ => Err(format!(
            "`UserAxis` `{name}` has the values `{}`, expected six numbers",
            text.trim()
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Wrench;

    fn text() -> String {
        let axes: String = AXES
            .iter()
            .enumerate()
            .map(|(index, name)| {
                let values: Vec<String> = (0..6)
                    .map(|gauge| if gauge == index { "2.5" } else { " 0.0" }.to_owned())
                    .collect();
                format!(
                    "<UserAxis Name=\"{name}\" values=\" {} \" max=\"145\"/>\n",
                    values.join(" ")
                )
            })
            .collect();
        format!(
            "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<FTSensor Serial=\"FT1\" NumGages=\"6\">\n<Calibration \
             PartNumber=\"SI-145-5\" ForceUnits=\"N\" TorqueUnits=\"N-m\">\n<Axis Name=\"Fx\" values=\"9 9 9 9 9 9\"/>\n\
             <BasicTransform Dx=\"0\" Dy=\"0\" Dz=\"9.5\"/>\n{axes}</Calibration></FTSensor>"
        )
    }

    #[test]
    fn the_users_axes_are_read_in_newtons_and_newton_millimetres() {
        let calibration = AnalogCalibration::parse_cal("FT1.cal", &text()).unwrap();
        let wrench = calibration.wrench([1.0, 2.0, 3.0, 1.0, 2.0, 3.0]).unwrap();
        assert_eq!(wrench, Wrench::from_axes([2.5, 5.0, 7.5, 2500.0, 5000.0, 7500.0]));
    }

    #[test]
    fn what_is_missing_is_named() {
        for (from, to, words) in [
            (
                "Name=\"Tz\"",
                "Name=\"T\"",
                "expected one `UserAxis` with the name `Tz`",
            ),
            (
                "Name=\"Fy\"",
                "Name=\"Fx\"",
                "expected one `UserAxis` with the name `Fx`",
            ),
            (
                "2.5  0.0",
                "2.5",
                "`UserAxis` `Fx` has the values `2.5  0.0  0.0  0.0  0.0`, expected six numbers",
            ),
            ("2.5", "x", "`UserAxis` `Fx` has the values `x "),
            (
                "ForceUnits=\"N\" ",
                "",
                "`Calibration` has no attribute `ForceUnits`",
            ),
            (
                "\"N-m\"",
                "\"ell\"",
                "`TorqueUnits` is `ell`, which is not a known unit",
            ),
            ("FTSensor", "Sensor", "its root is `Sensor`, expected `FTSensor`"),
            ("Calibration", "Other", "has no element `Calibration`"),
            ("</FTSensor>", "", "is not XML"),
        ] {
            let changed = if from.starts_with(['F', 'C']) && !from.contains('=') {
                text().replace(from, to)
            } else {
                text().replacen(from, to, 1)
            };
            let error = AnalogCalibration::parse_cal("FT1.cal", &changed)
                .unwrap_err()
                .to_string();
            assert!(error.starts_with(&format!("FT1.cal: {words}")), "{error}");
        }
    }
}
