//! `twintac simulate`: a protocol or a path on the simulated gel, or the places of a run.

use std::path::Path;
use std::sync::Arc;

use anyhow::Result;
use rayon::prelude::*;
use serde::Serialize;
use twintac_depth_table::DepthTable;
use twintac_mesh::vtk::{self, Field, Values};
use twintac_protocol::PressPlan;
use twintac_recording::Provenance;
use twintac_simulate::{Fields, Gel, PressPlace, SimulateSettings};

use crate::arguments::Simulate;
use twintac_run::cache::{write_file, write_json};
use twintac_run::progress;
use twintac_run::run::Run;
use twintac_run::sensor_file::read_sensor;
use twintac_run::settings::RunSettings;
use twintac_run::stages::recordings::plan;

/// One simulated press: `<press>.json`.
#[derive(Serialize)]
struct SimulatedPress<'a> {
    provenance: Provenance,
    plan: &'a PressPlan,
    settings: &'a SimulateSettings,
    table: &'a DepthTable,
}

/// Simulates and writes one table over depth for each press.
pub(crate) fn run(arguments: &Simulate) -> Result<()> {
    if let Some(folder) = &arguments.run {
        let run = Run::open(folder)?;
        run.mesh()?;
        return run.simulate();
    }
    let Some(sensor) = &arguments.sensor else {
        anyhow::bail!("give --run, or --sensor with --protocol or --path");
    };
    let sensor = read_sensor(sensor)?.sensor;
    let settings = RunSettings::read(arguments.settings.as_deref())?.simulate;
    let gel = Gel::new(Arc::clone(&sensor), settings.clone());
    if let Some(path) = &arguments.path {
        return super::follow::run(&gel, path, arguments.json, arguments.profile);
    }
    let (Some(protocol), Some(out)) = (&arguments.protocol, &arguments.out) else {
        anyhow::bail!("give --protocol and --out, or --path");
    };
    let plans = plan(protocol, &sensor, arguments.seed)?;
    let bar = progress::bar("simulating", plans.len() as u64);
    plans
        .par_iter()
        .with_max_len(1)
        .try_for_each(|plan| -> Result<()> {
            let shape = twintac_run::sensor_file::indenter(&sensor, &plan.indenter)?.clone();
            let place = PressPlace {
                enough_force_n: None,
                indenter: plan.indenter.clone(),
                shape,
                x_mm: plan.x_mm,
                y_mm: plan.y_mm,
                rotation: plan.rotation,
                depth_mm: plan.depth_mm,
            };
            let name = plan.name.replace('#', "-");
            let press = gel.mesh(&place)?;
            let (mut number, mut written) = (0, Ok(()));
            let table = press.depth_table(&place, &gel.depths(&place), &mut |fields| {
                if arguments.vtk && written.is_ok() {
                    written = write_frame(&out.join("vtk").join(format!("{name}_{number:03}.vtu")), fields);
                }
                number += 1;
            });
            written?;
            let record = SimulatedPress {
                provenance: Provenance::Simulated,
                plan,
                settings: &settings,
                table: &table,
            };
            write_json(&out.join(format!("{name}.json")), &record)?;
            bar.inc(1);
            Ok(())
        })?;
    bar.finish_and_clear();
    Ok(())
}

/// The pressed gel, where it is now.
fn write_frame(path: &Path, fields: &Fields<'_>) -> Result<()> {
    let mut mesh = fields.mesh.clone();
    mesh.nodes_mm
        .iter_mut()
        .zip(fields.displacements_mm)
        .for_each(|(node, moved)| *node += *moved);
    let fields = [
        Field {
            name: "displacement_mm",
            values: Values::Vector(fields.displacements_mm),
        },
        Field {
            name: "pressure_kpa",
            values: Values::Scalar(&fields.pressure_kpa),
        },
        Field {
            name: "von_mises_kpa",
            values: Values::Scalar(&fields.von_mises_kpa),
        },
    ];
    write_file(path, vtk::write(&mesh, &fields, &[])?.as_bytes())
}
