//! Descriptions with changed numbers.

use std::path::Path;

use toml::{Table, Value};
use twintac_sensor::SensorFile;
use twintac_work::WorkError;

use crate::Variable;

/// The gel's height. For a block it is the size along z.
const HEIGHT: &str = "gel.height_mm";
/// The limit of depth of a gel that is lower than the limit of the description, as a fraction of
/// its height.
const LOW: f64 = 0.5;
/// The smallest distance between two ports, seen from above. All ports move in proportion, and the
/// sides of a block move as far as the outermost ports.
const PITCH: &str = "taxels.pitch_mm";

const MATERIAL: &str = "gel.material.";

/// The description of the sensor with a new value for each variable.
pub(crate) fn described(
    sensor: &SensorFile,
    name: &str,
    variables: &[Variable],
    values: &[f64],
) -> Result<SensorFile, WorkError> {
    let mut table: Table = toml::from_str(&sensor.text)
        .map_err(|found| WorkError::Input(format!("the description of `{}`: {found}", sensor.sensor.name)))?;
    for (variable, value) in variables.iter().zip(values) {
        match variable.field.as_str() {
            HEIGHT => set_height(&mut table, *value)?,
            PITCH => set_pitch(&mut table, *value)?,
            field => set(&mut table, field, *value)?,
        }
    }
    if variables
        .iter()
        .any(|variable| variable.field.starts_with(MATERIAL))
    {
        // The stated source of the material's constants no longer applies.
        set_source(&mut table);
    }
    let path = sensor.path();
    let changed: Vec<String> = variables
        .iter()
        .zip(values)
        .map(|(variable, value)| format!("{} = {value}", variable.field))
        .collect();
    let summary = format!("{} (designed: {})", sensor.sensor.summary, changed.join(", "));
    table.insert("name".to_owned(), name.into());
    table.insert("summary".to_owned(), summary.into());
    let text = toml::to_string(&table)?;
    Ok(SensorFile::parse(
        &path
            .parent()
            .unwrap_or(Path::new(""))
            .join(name)
            .with_extension("toml"),
        &text,
    )?)
}

fn set_source(table: &mut Table) {
    let gel = table.get_mut("gel").and_then(Value::as_table_mut);
    if let Some(material) = gel
        .and_then(|gel| gel.get_mut("material"))
        .and_then(Value::as_table_mut)
    {
        material.insert(
            "source".to_owned(),
            "designed: no silicone with these constants was chosen yet".into(),
        );
    }
}

fn set_height(table: &mut Table, height_mm: f64) -> Result<(), WorkError> {
    let size = block(table).ok_or_else(|| {
        WorkError::Input(format!(
            "`{HEIGHT}` is the height of a block, but this gel is not a block: vary the numbers of its shape below `gel.solid`"
        ))
    })?;
    size[2] = height_mm.into();
    let limits = table.get_mut("limits").and_then(Value::as_table_mut);
    if let Some(limit) = limits.and_then(|limits| limits.get_mut("depth_mm"))
        && number(limit) >= height_mm
    {
        *limit = (LOW * height_mm).into();
    }
    Ok(())
}

fn set_pitch(table: &mut Table, pitch_mm: f64) -> Result<(), WorkError> {
    if table.contains_key("inclusions") {
        return Err(WorkError::Input(format!(
            "`{PITCH}` cannot be varied where housings stand in the gel (`inclusions`): each would have to move with its port"
        )));
    }
    let taxels: &mut Vec<Value> = table
        .get_mut("taxels")
        .and_then(Value::as_array_mut)
        .ok_or_else(|| WorkError::Input("the description has no `taxels`".to_owned()))?;
    let mut ports: Vec<&mut Vec<Value>> = taxels
        .iter_mut()
        .filter_map(|taxel| taxel.get_mut("position_mm")?.as_array_mut())
        .collect();
    let places: Vec<[f64; 2]> = ports
        .iter()
        .map(|port| [0, 1].map(|axis| number(&port[axis])))
        .collect();
    let pitch_before_mm = pitch(&places)
        .ok_or_else(|| WorkError::Input(format!("`{PITCH}` needs two ports at different positions")))?;
    let extents = [0, 1].map(|axis| {
        let along = || places.iter().map(|place| place[axis]);
        [
            along().fold(f64::INFINITY, f64::min),
            along().fold(f64::NEG_INFINITY, f64::max),
        ]
    });
    let scale = pitch_mm / pitch_before_mm;
    let mut grown_mm = [0.0; 2];
    for axis in 0..2 {
        let [low, high] = extents[axis];
        let centre = 0.5 * (low + high);
        grown_mm[axis] = (scale - 1.0) * (high - low);
        for (port, place) in ports.iter_mut().zip(&places) {
            port[axis] = to_a_nanometre(centre + scale * (place[axis] - centre)).into();
        }
    }
    if let Some(size) = block(table) {
        for axis in 0..2 {
            size[axis] = to_a_nanometre(number(&size[axis]) + grown_mm[axis]).into();
        }
    }
    Ok(())
}

/// A length in mm, rounded to a nanometre to remove rounding errors of sums.
fn to_a_nanometre(length_mm: f64) -> f64 {
    (length_mm * 1e6).round() / 1e6
}

/// The smallest distance between two ports, mm.
pub(crate) fn pitch(places: &[[f64; 2]]) -> Option<f64> {
    let pairs = places.iter().enumerate();
    pairs
        .flat_map(|(index, a)| {
            places[..index]
                .iter()
                .map(move |b| (a[0] - b[0]).hypot(a[1] - b[1]))
        })
        .filter(|distance| *distance > 0.0)
        .min_by(f64::total_cmp)
}

/// The size of the gel's block, if it is one.
fn block(table: &mut Table) -> Option<&mut Vec<Value>> {
    let solid = table.get_mut("gel")?.get_mut("solid")?;
    if solid.get("kind")?.as_str()? != "block" {
        return None;
    }
    solid.get_mut("size_mm")?.as_array_mut()
}

fn number(value: &Value) -> f64 {
    value
        .as_float()
        .or_else(|| value.as_integer().map(|number| number as f64))
        .unwrap_or(f64::NAN)
}

/// Sets a number that the description contains.
fn set(table: &mut Table, field: &str, value: f64) -> Result<(), WorkError> {
    let mut all = Vec::new();
    for (name, inner) in table.iter() {
        numbers(inner, name, &mut all);
    }
    let steps: Vec<&str> = field
        .split(['.', '['])
        .map(|step| step.trim_end_matches(']'))
        .collect();
    let n_set = steps
        .split_first()
        .and_then(|(first, rest)| Some(set_below(table.get_mut(*first)?, rest, value)))
        .unwrap_or(0);
    if n_set > 0 {
        return Ok(());
    }
    all.sort();
    all.dedup();
    all.extend([HEIGHT.to_owned(), PITCH.to_owned()]);
    Err(WorkError::Input(format!(
        "`{field}` is not a number of the description; it has {}",
        all.join(", ")
    )))
}

/// Sets all numbers at a path below `value`, and returns how many were set.
fn set_below(value: &mut Value, steps: &[&str], number: f64) -> usize {
    let Some((first, rest)) = steps.split_first() else {
        let is_number = value.is_float() || value.is_integer();
        if is_number {
            *value = number.into();
        }
        return usize::from(is_number);
    };
    match value {
        Value::Table(table) => table
            .get_mut(*first)
            .map_or(0, |inner| set_below(inner, rest, number)),
        Value::Array(values) => match first.parse::<usize>() {
            Ok(index) => values
                .get_mut(index)
                .map_or(0, |inner| set_below(inner, rest, number)),
            Err(_) => values
                .iter_mut()
                .map(|inner| set_below(inner, steps, number))
                .sum(),
        },
        _ => 0,
    }
}

/// The paths of all numbers. Arrays of tables appear without index.
fn numbers(value: &Value, path: &str, found: &mut Vec<String>) {
    match value {
        Value::Float(_) | Value::Integer(_) => found.push(path.to_owned()),
        Value::Table(table) => {
            for (name, inner) in table {
                numbers(inner, &format!("{path}.{name}"), found);
            }
        }
        Value::Array(values) => {
            for (index, inner) in values.iter().enumerate() {
                let path = if inner.is_table() {
                    path.to_owned()
                } else {
                    format!("{path}[{index}]")
                };
                numbers(inner, &path, found);
            }
        }
        _ => (),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn varied(fields: &[(&str, f64)]) -> Result<SensorFile, WorkError> {
        let phystac = SensorFile::phystac().unwrap();
        let variables: Vec<Variable> = fields
            .iter()
            .map(|(field, value)| Variable {
                field: (*field).to_owned(),
                bounds: [*value, value + 1.0],
            })
            .collect();
        let values: Vec<f64> = fields.iter().map(|(_, value)| *value).collect();
        described(&phystac, "phystac-design", &variables, &values)
    }

    #[test]
    fn the_pitch_moves_ports_and_sides() {
        let wider = varied(&[("taxels.pitch_mm", 9.0), ("gel.height_mm", 6.0)])
            .unwrap()
            .sensor;
        let (low, high) = wider.gel.solid.bounds_mm(&wider.surfaces);
        let size = high - low;
        assert!((size.x - 37.0).abs() < 1e-9 && (size.y - 19.0).abs() < 1e-9 && size.z == 6.0);
        let places: Vec<[f64; 2]> = wider
            .taxels
            .iter()
            .map(|t| [t.position_mm.x, t.position_mm.y])
            .collect();
        assert!((pitch(&places).unwrap() - 9.0).abs() < 1e-9);
        assert_eq!(places[0], [-13.5, -4.5]);
    }

    #[test]
    fn a_gel_that_is_lower_than_its_limit_of_depth_has_a_lower_limit() {
        for (height_mm, limit_mm) in [(4.0, 2.0), (5.0, 2.5), (6.0, 5.0)] {
            let lower = varied(&[("gel.height_mm", height_mm)]).unwrap().sensor;
            assert_eq!(lower.limits.unwrap().depth_mm, limit_mm);
        }
    }

    #[test]
    fn any_number_of_the_description_can_be_set() {
        let other = varied(&[
            ("gel.material.shear_modulus_kpa", 30.0),
            ("taxels.port_radius_mm", 0.5),
            ("gel.solid.size_mm[1]", 20.0),
            ("shell.gap_mm", 2.0),
        ])
        .unwrap()
        .sensor;
        assert!((other.gel.material.shear_modulus_kpa() - 30.0).abs() < 1e-9);
        assert!(other.gel.material.source.starts_with("designed"));
        assert!(other.taxels.iter().all(|taxel| taxel.port_radius_mm == 0.5));
        assert_eq!(other.shell.as_ref().unwrap().gap_mm, 2.0);
        assert_eq!(other.name, "phystac-design");
    }

    #[test]
    fn what_is_no_number_is_refused_with_what_there_is() {
        for field in [
            "gel.hight_mm",
            "name",
            "taxels",
            "gel.solid.size_mm",
            "gel.solid.size_mm[3]",
            "taxels[9].port_radius_mm",
            "",
        ] {
            let error = varied(&[(field, 1.0)]).unwrap_err().to_string();
            assert!(
                error.contains("gel.material.shear_modulus_kpa"),
                "{field}: {error}"
            );
        }
        assert!(varied(&[("gel.solid.size_mm[2]", -1.0)]).is_err());
    }
}
