//! `twintac adapt`: adapts a model to another sensor, or measures the error over the number of
//! presses.

use std::path::Path;

use anyhow::Result;
use twintac_model::{AdaptationPlan, AdaptedModel, adapt_model, sensor_of_model};
use twintac_run::{AdaptationCurve, CurvePlan, Run, adaptation_curve, read_recordings};
use twintac_sensor::SensorFile;

use super::files::{expand, import_aloud, rename};
use crate::Program;
use crate::arguments::Adapt;
use crate::output::{percent, print};

pub(crate) fn run(arguments: &Adapt, program: &Program) -> Result<()> {
    if let Some(run) = &arguments.run {
        return curve(arguments, run, program);
    }
    let sensor = arguments.sensor.as_deref().map(SensorFile::read).transpose()?;
    let named = sensor.as_ref().and_then(SensorFile::import);
    let import = arguments.import.clone().or(named);
    let files = expand(&arguments.recordings)?;
    let is_csv = |file: &Path| file.extension().is_some_and(|ending| ending == "csv");
    let mut recording = match import {
        Some(import) if files.iter().all(|file| is_csv(file)) => import_aloud(&import, &files)?,
        _ => read_recordings(&files)?,
    };
    let recorded = match &sensor {
        Some(sensor) => sensor.clone(),
        None => sensor_of_model(&arguments.model)?,
    };
    rename(&mut recording, arguments.recorded_as.as_deref(), &recorded)?;
    let plan = AdaptationPlan {
        model: &arguments.model,
        sensor: sensor.as_ref(),
        recording: &recording,
        presses: arguments.presses as usize,
        seed: arguments.seed,
        out: &arguments.out,
    };
    let found = adapt_model(&plan, &program.caller()?)?;
    if arguments.json {
        return print(&serde_json::to_string_pretty(&found)?);
    }
    print(&adapted(&found))
}

fn curve(arguments: &Adapt, run: &Path, program: &Program) -> Result<()> {
    let run = Run::open(run, program.caller()?)?;
    let plan = CurvePlan {
        presses: arguments.curve.iter().map(|count| *count as usize).collect(),
        seeds: arguments.seeds,
    };
    let found = adaptation_curve(&arguments.model, &run, &plan, &arguments.out)?;
    if arguments.json {
        return print(&serde_json::to_string_pretty(&found)?);
    }
    print(&table(&found))
}

fn adapted(found: &AdaptedModel) -> String {
    let adaptation = &found.adaptation;
    let mut lines = vec![format!(
        "`{}`, trained on {} data, adapted with {} presses ({} data): {}",
        found.variant,
        found.trained_on,
        found.adapted_with.len(),
        found.provenance,
        found.adapted_with.join(", ")
    )];
    for (file, height) in &adaptation.contact_offset_mm {
        lines.push(format!(
            "{file}: contact height {:+.3} mm ± {:.3}",
            height.value, height.uncertainty
        ));
    }
    if let Some(stiffness) = &adaptation.stiffness {
        lines.push(format!(
            "stiffness over the simulated one {:.3} ± {:.3}",
            stiffness.value, stiffness.uncertainty
        ));
    }
    let taxels = found.taxels.iter().zip(&adaptation.gain).zip(&found.learned_gain);
    for (taxel, ((name, gain), learned)) in taxels.enumerate() {
        let mut line = format!(
            "{name}: gain {:.4} ± {:.4} (before {learned:.4})",
            gain.value, gain.uncertainty
        );
        if let Some(law) = adaptation.stiffening_per_kpa.get(taxel) {
            line += &format!(
                ", static nonlinearity {:+.4} ± {:.4} per kPa",
                law.value, law.uncertainty
            );
        }
        for share in adaptation.memory.get(taxel).into_iter().flatten() {
            line += &format!(", relaxation {:.3} ± {:.3}", share.value, share.uncertainty);
        }
        lines.push(line);
    }
    let constants = adaptation.time_constants_s.iter();
    lines.extend(constants.map(|constant_s| {
        format!(
            "time constant {:.2} s ± {:.2}",
            constant_s.value, constant_s.uncertainty
        )
    }));
    if let (Some(twin), Some(learned)) = (&found.twin, &found.as_learned) {
        lines.push(format!(
            "nearest in contact {}, all {}, on {} presses that it was not adapted with; before adaptation {}",
            percent(twin.overall.nearest_in_contact_percent),
            percent(twin.overall.all_percent),
            found.evaluated_presses,
            percent(learned.nearest_in_contact_percent).trim_start()
        ));
        lines.push(found.definition.clone());
    }
    lines.push(format!("model   {}", found.model.display()));
    lines.join("\n")
}

fn table(found: &AdaptationCurve) -> String {
    let mut lines = vec![
        format!(
            "{} ({} data), {} held-out presses; nearest taxel, frames in contact",
            found.sensor, found.provenance, found.evaluated_presses
        ),
        format!(
            "before adaptation  {}",
            percent(found.as_learned.nearest_in_contact_percent)
        ),
    ];
    lines.extend(found.points.iter().map(|point| {
        let Some(error) = &point.nearest_in_contact else {
            return format!("{:3} presses        {}", point.presses, percent(None));
        };
        let over = point.over_trained_on_all;
        format!(
            "{:3} presses        {:6.2} ± {:4.2} %   {}",
            point.presses,
            error.mean_percent,
            error.deviation_percent,
            over.map_or_else(String::new, |over| format!("{over:.2} times"))
        )
    }));
    lines.push(format!(
        "trained on all {:3} {}",
        found.training_presses,
        percent(found.trained_on_all.nearest_in_contact_percent)
    ));
    lines.push(found.definition.clone());
    lines.join("\n")
}
