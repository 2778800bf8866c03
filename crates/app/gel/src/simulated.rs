//! Simulated presses without a run: along a protocol, or along a path.

use std::path::Path;
use std::sync::Arc;

use rayon::prelude::*;
use serde::Serialize;
use twintac_depth_table::DepthTable;
use twintac_mesh::vtk::{self, Field, Values};
use twintac_protocol::{PressPath, PressPlan};
use twintac_recording::Provenance;
use twintac_sensor::Sensor;
use twintac_simulate::{Fields, Followed, Gel, PressPlace, SimulateSettings};
use twintac_store::{write_file, write_json};
use twintac_work::{At, Progress, Work, WorkError, read_text};

/// One simulated press: `<press>.json`.
#[derive(Serialize)]
struct SimulatedPress<'a> {
    provenance: Provenance,
    plan: &'a PressPlan,
    settings: &'a SimulateSettings,
    table: &'a DepthTable,
}

/// Simulates presses, and writes the table over depth of each into `folder`. With `frames` it also
/// writes the deformed gel of every frame for ParaView, in `vtk/`.
///
/// # Errors
/// A press that the gel cannot carry out; a file that cannot be written.
pub fn simulate_presses(
    sensor: &Arc<Sensor>,
    settings: &SimulateSettings,
    plans: &[PressPlan],
    folder: &Path,
    frames: bool,
    progress: &dyn Progress,
) -> Result<(), WorkError> {
    let gel = Gel::new(Arc::clone(sensor), settings.clone());
    let work = Work::start(progress, "simulating", plans.len());
    plans
        .par_iter()
        .with_max_len(1)
        .try_for_each(|plan| -> Result<(), WorkError> {
            let name = plan.name.replace('#', "-");
            let vtk = frames.then(|| folder.join("vtk").join(&name));
            let table = simulate(&gel, plan, vtk.as_deref())?;
            let record = SimulatedPress {
                provenance: Provenance::Simulated,
                plan,
                settings,
                table: &table,
            };
            write_json(&folder.join(format!("{name}.json")), &record)?;
            work.step("");
            Ok(())
        })
}

/// A press as a table over depth. `vtk` is the beginning of its frames' file names.
fn simulate(gel: &Gel, plan: &PressPlan, vtk: Option<&Path>) -> Result<DepthTable, WorkError> {
    let place = PressPlace {
        enough_force_n: None,
        indenter: plan.indenter.clone(),
        shape: gel.shape(&plan.indenter)?.clone(),
        x_mm: plan.x_mm,
        y_mm: plan.y_mm,
        rotation: plan.rotation,
        depth_mm: plan.depth_mm,
    };
    let press = gel.mesh(&place)?;
    let (mut number, mut written) = (0, Ok(()));
    let table = press.depth_table(&place, &gel.depths(&place), &mut |fields| {
        if let (Some(vtk), true) = (vtk, written.is_ok()) {
            written = write_frame(Path::new(&format!("{}_{number:03}.vtu", vtk.display())), fields);
        }
        number += 1;
    });
    written?;
    Ok(table)
}

/// Writes the deformed gel.
fn write_frame(path: &Path, fields: &Fields<'_>) -> Result<(), WorkError> {
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
    Ok(write_file(path, vtk::write(&mesh, &fields, &[])?.as_bytes())?)
}

/// Force and pressures along a path.
#[derive(Clone, Debug, Serialize)]
pub struct SimulatedPath {
    /// Always [`Provenance::Simulated`].
    pub provenance: Provenance,
    /// The sensor's name.
    pub sensor: String,
    /// The path.
    pub path: PressPath,
    /// The response of the gel. If the path could not be followed to its end, [`Followed::failure`]
    /// says why.
    #[serde(flatten)]
    pub followed: Followed,
}

impl SimulatedPath {
    /// Moves an indenter along the path that a TOML file describes.
    ///
    /// # Errors
    /// A file that cannot be read or is wrong; an indenter that the sensor does not have; a point
    /// with the name of a taxel.
    pub fn follow(gel: &Gel, file: &Path, progress: &dyn Progress) -> Result<Self, WorkError> {
        let path = PressPath::parse(&file.display().to_string(), &read_text(file)?)?;
        let shape = gel.shape(&path.indenter)?;
        let work = Work::start(progress, "simulating", path.frames().len());
        let followed = gel
            .follow(shape, &path, &mut || work.advance())
            .at(|| file.display().to_string())?;
        work.go_on()?;
        Ok(Self {
            provenance: Provenance::Simulated,
            sensor: gel.sensor().name.clone(),
            path,
            followed,
        })
    }
}
