//! The search: each design is described, pressed and evaluated.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

use rayon::prelude::*;
use twintac_plot::png;
use twintac_sensor::SensorFile;
use twintac_simulate::{Gel, SimulateSettings};
use twintac_store::{Keyed, Owner, Store, write_file, write_json};
use twintac_work::{Caller, Work, WorkError};

use crate::described::described;
use crate::plot::plot;
use crate::press::{Outcome, Pressed};
use crate::{Design, Designs, Measure, Plan, Variable, Wishes};

/// Most designs of a search.
const MOST_DESIGNS: usize = 100_000;

/// Presses the gels of all designs, and writes into the folder `designs.csv`, `designs.json`,
/// `designs.png`, and, if a design meets all needs, `best.toml`, the description of the best one.
/// Results are kept in the folder, so a search that was killed continues.
///
/// # Errors
/// Variables that the description does not have, or one that occurs twice; a plan without designs,
/// or with more than 100,000; no design that can be evaluated; a folder in which another program
/// works.
pub fn search(
    sensor: &SensorFile,
    variables: &[Variable],
    plan: Plan,
    measure: &Measure,
    wishes: &Wishes,
    folder: &Path,
    caller: &Caller,
) -> Result<Designs, WorkError> {
    measure.check()?;
    check(variables, plan)?;
    if sensor.sensor.taxels.is_empty() {
        return Err(WorkError::Input(format!(
            "the sensor `{}` has no taxels",
            sensor.sensor.name
        )));
    }
    let name = |number: usize| format!("{}-design-{number}", sensor.sensor.name);
    let all = plan.values(variables);
    // All descriptions are made first, so that a wrong number is reported before minutes of work.
    let mut described: Vec<Result<SensorFile, WorkError>> = (1..)
        .zip(&all)
        .map(|(number, values)| described(sensor, &name(number), variables, values))
        .collect();
    if described.iter().all(Result::is_err)
        && let Err(first) = described.swap_remove(0)
    {
        return Err(first);
    }
    let _owner = Owner::of(folder)?;
    let store = Store::new(&folder.join("designs"), &caller.program);
    let work = Work::start(&*caller.progress, "pressing", all.len());
    let outcomes: Vec<Outcome> = described
        .par_iter()
        .with_max_len(1)
        .map(|described| {
            work.go_on()?;
            let outcome = match described {
                Ok(file) => evaluate(file, measure, &store, caller)?,
                Err(why) => Outcome::Refused(why.to_string()),
            };
            work.step("");
            Ok(outcome)
        })
        .collect::<Result<_, WorkError>>()?;
    drop(work);
    let designs = Designs {
        sensor: sensor.sensor.name.clone(),
        provenance: "simulated",
        measure: measure.clone(),
        noise_kpa: measure.noise_kpa(&sensor.sensor),
        fields: variables.iter().map(|variable| variable.field.clone()).collect(),
        designs: (1..)
            .zip(all)
            .zip(outcomes)
            .map(|((number, values), outcome)| Design {
                number,
                values,
                outcome,
            })
            .collect(),
    };
    if let (None, Some(why)) = (
        designs.evaluated().next(),
        designs.designs.iter().find_map(Design::refused),
    ) {
        return Err(WorkError::Input(format!(
            "none of the {} designs can be evaluated; the first: {why}",
            designs.designs.len()
        )));
    }
    write_file(&folder.join("designs.csv"), &designs.csv(wishes)?)?;
    write_json(&folder.join("designs.json"), &designs)?;
    write_file(
        &folder.join("designs.png"),
        &png(&plot(&designs, wishes).scene(), 2.0)?,
    )?;
    if let Some(Ok(best)) = designs.best(wishes).and_then(|number| described.get(number - 1)) {
        write_best(best, folder)?;
    }
    Ok(designs)
}

/// The figures of a described sensor, kept under all their inputs.
fn evaluate(
    file: &SensorFile,
    measure: &Measure,
    store: &Store,
    caller: &Caller,
) -> Result<Outcome, WorkError> {
    let settings = SimulateSettings {
        max_nodes: measure.max_nodes,
        ..SimulateSettings::default()
    };
    let kept = store.get(&Pressed {
        name: &file.sensor.name,
        gel: Keyed::new(Gel::new(Arc::clone(&file.sensor), settings))?,
        measure,
    })?;
    if let Some(why) = &kept.made_again {
        caller.progress.note(why);
    }
    Ok(kept.value)
}

/// Writes the description of the best design, with the surfaces that it names.
fn write_best(best: &SensorFile, folder: &Path) -> Result<(), WorkError> {
    let path = folder.join("best.toml");
    let best = best.kept_as(&path)?;
    for (name, bytes) in best.surfaces() {
        write_file(&folder.join(name), bytes)?;
    }
    write_file(&path, best.text.as_bytes())?;
    Ok(())
}

fn check(variables: &[Variable], plan: Plan) -> Result<(), WorkError> {
    if variables.is_empty() {
        return Err(WorkError::Input(
            "nothing is varied: give --vary FIELD=LOW..HIGH".to_owned(),
        ));
    }
    let fields: BTreeSet<&str> = variables.iter().map(|variable| variable.field.as_str()).collect();
    if fields.len() < variables.len() {
        return Err(WorkError::Input(
            "a field is varied twice: name each once".to_owned(),
        ));
    }
    match plan.n_designs(variables.len()) {
        Some(1..=MOST_DESIGNS) => Ok(()),
        found => Err(WorkError::Input(format!(
            "{} designs are asked for: there can be 1 to {MOST_DESIGNS}",
            found.map_or("too many".to_owned(), |n_designs| n_designs.to_string())
        ))),
    }
}
