//! A fitted material as a file that sensor descriptions can name.

use toml::{Table, Value};
use twintac_calibrate::Fit;

/// The file's text. `measured` names what the material was fitted to.
pub(super) fn material_file(fit: &Fit, measured: &str) -> Result<String, toml::ser::Error> {
    let of_material = || {
        fit.unknowns
            .iter()
            .filter(|unknown| unknown.parameter.is_of_material())
    };
    let mut table = Table::try_from(&fit.material.model)?;
    if of_material().any(|unknown| unknown.name == "bulk_modulus_kpa") {
        table.insert("bulk_modulus_kpa".into(), fit.material.bulk_modulus_kpa.into());
    } else {
        table.insert("poissons_ratio".into(), fit.poissons_ratio.into());
    }
    if !fit.material.prony.is_empty() {
        table.insert("prony".into(), Value::try_from(&fit.material.prony)?);
    }
    let found = of_material().map(|unknown| {
        let [low, high] = unknown.interval_95;
        if unknown.identified {
            format!("{} {low:.4} to {high:.4}", unknown.name)
        } else {
            format!("{} not determined by the data", unknown.name)
        }
    });
    let found: Vec<String> = found.collect();
    let source = if found.is_empty() {
        "as described: no constant was free".to_owned()
    } else {
        format!("fitted to {measured}; with 95 % confidence {}", found.join(", "))
    };
    let mut file = Value::Table(table);
    round(&mut file);
    if let Value::Table(table) = &mut file {
        table.insert("source".into(), source.into());
    }
    toml::to_string(&file)
}

/// Rounds all numbers to six significant digits.
fn round(value: &mut Value) {
    match value {
        Value::Float(number) => *number = format!("{number:.5e}").parse().unwrap_or(*number),
        Value::Array(items) => items.iter_mut().for_each(round),
        Value::Table(table) => table.iter_mut().for_each(|(_, value)| round(value)),
        _ => (),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
    use super::*;
    use twintac_calibrate::{FittedUnknown, Material, Parameter};

    fn fit(material: Material, free: &[&str]) -> Fit {
        let unknown = |name: &&str| FittedUnknown {
            name: (*name).into(),
            parameter: Parameter::named(name),
            start: 1.0,
            value: 2.0,
            interval_95: [1.9, 2.1],
            identified: true,
        };
        Fit {
            material,
            poissons_ratio: 0.4999,
            unknowns: free.iter().map(unknown).collect(),
            correlations: Vec::new(),
            condition: 1.0,
            noise_percent: 1.0,
            n_samples: 10,
            iterations: 3,
            converged: true,
            warnings: Vec::new(),
            signals: Vec::new(),
        }
    }

    #[test]
    fn what_is_written_is_read_back() {
        let json = r#"{"model": {"model": "ogden", "terms": [{"mu_kpa": 8.123456789, "alpha": 3.0}]},
            "bulk_modulus_kpa": 33333.33333, "prony": [{"weight": 0.25, "time_s": 0.6666666667}]}"#;
        let material: Material = serde_json::from_str(json).unwrap();
        let fit = fit(
            material,
            &["terms[0].mu_kpa", "bulk_modulus_kpa", "depth_offset_mm"],
        );
        let text = material_file(&fit, "3 real curves").unwrap();
        assert!(text.contains(
            "fitted to 3 real curves; with 95 % confidence terms[0].mu_kpa 1.9000 to 2.1000, bulk"
        ));
        assert!(!text.contains("depth_offset_mm"));

        let sensor = twintac_sensor::SensorFile::phystac().unwrap().text;
        let (before, after) = sensor.split_once("[gel.material]").unwrap();
        let (_, after) = after.split_once("\n[").unwrap();
        // Constants that this material does not have are not inferred.
        let before = before
            .replace("\"gel.material.shear_modulus_kpa\",", "")
            .replace("\"gel.material.poissons_ratio\",", "");
        let block = text.replace("[[", "[[gel.material.");
        let text = format!("{before}[gel.material]\n{block}\n[{after}");
        let sensor = twintac_sensor::SensorFile::parse(std::path::Path::new("phystac.toml"), &text)
            .unwrap()
            .sensor;
        let found = &sensor.gel.material;
        assert!((found.bulk_modulus_kpa / 33333.3 - 1.0).abs() < 1e-5);
        assert!((found.shear_modulus_kpa() / (0.5 * 8.123_456_789 * 3.0) - 1.0).abs() < 1e-5);
        assert!((found.prony[0].time_s - 2.0 / 3.0).abs() < 1e-5);
    }
}
