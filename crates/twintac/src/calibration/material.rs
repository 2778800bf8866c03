//! A fitted material as it stands in a sensor's description.

use std::fmt::Write as _;

use twintac_calibrate::Material;
use twintac_calibrate::{Fit, FittedUnknown};

/// The tables `[gel.material]` and `[[gel.material.prony]]`, ready to be pasted.
pub(crate) fn material_block(fit: &Fit) -> String {
    let mut text = String::from("[gel.material]\n");
    let constants = constants(&fit.material);
    let is_free = |name: &str| fit.unknowns.iter().any(|unknown| unknown.parameter == name);
    for (name, value) in constants {
        let _ = writeln!(text, "{name} = {value}");
    }
    if is_free("bulk_modulus_kpa") {
        let _ = writeln!(
            text,
            "bulk_modulus_kpa = {}",
            rounded(fit.material.bulk_modulus_kpa)
        );
    } else {
        let _ = writeln!(text, "poissons_ratio = {}", rounded(fit.poissons_ratio));
    }
    let found: Vec<String> = fit
        .unknowns
        .iter()
        .filter(|unknown| is_material(unknown))
        .map(|unknown| {
            let [low, high] = unknown.interval_95;
            if unknown.identified {
                format!("{} {:.4} to {:.4}", unknown.name, low, high)
            } else {
                format!("{} not told by the data", unknown.name)
            }
        })
        .collect();
    let n = fit.signals.len();
    let curves = if n == 1 { "curve" } else { "curves" };
    let _ = writeln!(
        text,
        "source = \"fitted to {n} {curves}; with 95 % confidence {}\"",
        found.join(", ")
    );
    for term in &fit.material.prony {
        let _ = write!(
            text,
            "\n[[gel.material.prony]]\nweight = {}\ntime_s = {}\n",
            rounded(term.weight),
            rounded(term.time_s)
        );
    }
    text
}

fn is_material(unknown: &FittedUnknown) -> bool {
    !["depth_offset_mm", "force_scale", "force_offset_n", "gain"].contains(&unknown.parameter.as_str())
}

fn constants(material: &Material) -> Vec<(&'static str, String)> {
    use twintac_calibrate::Isochoric::{MooneyRivlin, NeoHookean, Yeoh};
    let text = |value: f64| rounded(value);
    match material.isochoric {
        NeoHookean { shear_modulus_kpa } => vec![("shear_modulus_kpa", text(shear_modulus_kpa))],
        MooneyRivlin { c10_kpa, c01_kpa } => vec![
            ("model", "\"mooney-rivlin\"".into()),
            ("c10_kpa", text(c10_kpa)),
            ("c01_kpa", text(c01_kpa)),
        ],
        Yeoh {
            c10_kpa,
            c20_kpa,
            c30_kpa,
        } => vec![
            ("model", "\"yeoh\"".into()),
            ("c10_kpa", text(c10_kpa)),
            ("c20_kpa", text(c20_kpa)),
            ("c30_kpa", text(c30_kpa)),
        ],
    }
}

/// Six significant digits, as TOML writes a float.
fn rounded(value: f64) -> String {
    let short: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    format!("{short:?}")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
    use super::*;
    use twintac_calibrate::{Isochoric, PronyTerm};

    #[test]
    fn what_is_pasted_is_read_back() {
        let unknown = |name: &str, value: f64| FittedUnknown {
            name: name.into(),
            parameter: name.into(),
            start: 1.0,
            value,
            interval_95: [0.9 * value, 1.1 * value],
            identified: true,
        };
        let fit = Fit {
            material: Material {
                isochoric: Isochoric::Yeoh {
                    c10_kpa: 10.0,
                    c20_kpa: -1.234_567_89,
                    c30_kpa: 0.5,
                },
                bulk_modulus_kpa: 1e5 / 3.0,
                prony: vec![PronyTerm {
                    weight: 0.25,
                    time_s: 2.0 / 3.0,
                }],
            },
            poissons_ratio: 0.4999,
            unknowns: vec![unknown("c10_kpa", 10.0), unknown("bulk_modulus_kpa", 1e5 / 3.0)],
            correlations: Vec::new(),
            condition: 1.0,
            noise_percent: 1.0,
            n_samples: 10,
            iterations: 3,
            converged: true,
            warnings: Vec::new(),
            signals: Vec::new(),
            jacobian: Vec::new(),
        };
        let sensor = include_str!("../../../../sensors/phystac.toml");
        let (before, after) = sensor.split_once("[gel.material]").unwrap();
        let (_, after) = after.split_once("\n[").unwrap();
        // Constants that this material does not have are not inferred.
        let before = before
            .replace("\"gel.material.shear_modulus_kpa\",", "")
            .replace("\"gel.material.poissons_ratio\",", "");
        let text = format!("{before}{}\n[{after}", material_block(&fit));
        let sensor = crate::sensor_file::parse_sensor(std::path::Path::new("phystac.toml"), &text).unwrap();
        let found = &sensor.gel.material;
        assert!((found.bulk_modulus_kpa / (1e5 / 3.0) - 1.0).abs() < 1e-5);
        assert!((found.shear_modulus_kpa() - 20.0).abs() < 1e-9);
        assert!((found.prony[0].time_s - 2.0 / 3.0).abs() < 1e-5);
    }
}
