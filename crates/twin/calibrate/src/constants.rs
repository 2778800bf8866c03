//! The constants of a material by the names that they have in files, for any model.

use serde_json::{Map, Value};
use twintac_softbody::Material;

/// Names of all constants: `terms[0].mu_kpa`, `bulk_modulus_kpa`, `prony[0].weight`.
pub(crate) fn names(material: &Material) -> Vec<String> {
    let mut names = Vec::new();
    for (name, value) in &table(material) {
        add_names(name.clone(), value, &mut names);
    }
    names
}

fn add_names(name: String, value: &Value, names: &mut Vec<String>) {
    match value {
        Value::Number(_) => names.push(name),
        Value::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                add_names(format!("{name}[{index}]"), item, names);
            }
        }
        Value::Object(fields) => {
            for (field, value) in fields {
                add_names(format!("{name}.{field}"), value, names);
            }
        }
        _ => (),
    }
}

/// The value of a constant; `None` if the material does not have it.
pub(crate) fn get(material: &Material, name: &str) -> Option<f64> {
    Value::Object(table(material)).pointer(&pointer(name))?.as_f64()
}

/// The material with other constants. Names that the material does not have, or that are not
/// numbers, are ignored.
pub(crate) fn with<'a>(material: &Material, constants: impl IntoIterator<Item = (&'a str, f64)>) -> Material {
    let mut table = Value::Object(table(material));
    for (name, value) in constants {
        if let Some(constant) = table.pointer_mut(&pointer(name)) {
            *constant = value.into();
        }
    }
    let part = |name: &str| table.get(name).cloned().unwrap_or_default();
    let (bulk, prony) = (part("bulk_modulus_kpa").as_f64(), part("prony"));
    if let Value::Object(fields) = &mut table {
        fields.remove("bulk_modulus_kpa");
        fields.remove("prony");
    }
    match (serde_json::from_value(table), bulk, serde_json::from_value(prony)) {
        (Ok(model), Some(bulk_modulus_kpa), Ok(prony)) => Material {
            model,
            bulk_modulus_kpa,
            prony,
        },
        _ => material.clone(),
    }
}

/// The material as in a file: the constants of the model beside the other fields.
fn table(material: &Material) -> Map<String, Value> {
    let mut table = Map::new();
    if let Ok(Value::Object(mut fields)) = serde_json::to_value(material) {
        if let Some(Value::Object(model)) = fields.remove("model") {
            table.extend(model);
        }
        table.extend(fields);
    }
    table
}

/// `/terms/0/mu_kpa` for `terms[0].mu_kpa`
fn pointer(name: &str) -> String {
    format!("/{}", name.replace("].", "/").replace('[', "/"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use twintac_softbody::Model;

    #[test]
    fn constants_are_found_and_changed_by_name() {
        let json = r#"{"model": {"model": "ogden", "terms": [{"mu_kpa": 9.0, "alpha": 1.3}, {"mu_kpa": 0.6, "alpha": 4.5}]},
            "bulk_modulus_kpa": 800.0, "prony": [{"weight": 0.1, "time_s": 2.0}]}"#;
        let material: Material = serde_json::from_str(json).unwrap();
        for (index, name) in names(&material).iter().enumerate() {
            let changed = with(&material, [(name.as_str(), 0.5 + index as f64)]);
            assert_eq!(get(&changed, name), Some(0.5 + index as f64), "{name}");
            let others = names(&material).into_iter().filter(|other| other != name);
            for other in others {
                assert_eq!(get(&changed, &other), get(&material, &other), "{name}, {other}");
            }
        }
        assert_eq!(names(&material).len(), 7);
        assert_eq!(get(&material, "terms[2].alpha"), None);
        assert_eq!(get(&material, "model"), None);
        let Model::Ogden(law) = with(&material, [("terms[1].alpha", -2.0)]).model else {
            panic!("another model");
        };
        assert!((law.terms[1].alpha + 2.0).abs() < f64::EPSILON);
    }
}
