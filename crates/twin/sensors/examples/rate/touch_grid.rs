//! MuJoCo's touch sensor, measured in the same run.

use std::error::Error;
use std::path::Path;
use std::process::Command;

use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::measure::{N_STEPS, N_WARM_UP, Spread};

/// Figures of MuJoCo's sensor.
#[derive(Serialize, Deserialize)]
pub(crate) struct TouchGrid {
    /// Version of MuJoCo.
    pub(crate) version: String,
    pub(crate) cells: usize,
    /// Fraction of the scenes in which a cell felt something.
    pub(crate) touched: f64,
    /// Mean number of cells that felt something, in the scenes with such a cell.
    pub(crate) cells_touched: f64,
    /// Steps of one scene, with its sensor, in a second.
    pub(crate) steps_per_s: Spread,
}

/// Output of the script.
#[derive(Deserialize)]
struct Printed {
    version: String,
    n_cells: usize,
    touched: f64,
    cells_touched: f64,
    seconds: Vec<f64>,
}

/// Measures as many scenes on as many threads, or says why it could not. A Python interpreter that
/// `TWINTAC_PYTHON` names must have the package.
pub(crate) fn measure(
    [n_scenes, n_threads]: [usize; 2],
) -> Result<Result<TouchGrid, String>, Box<dyn Error>> {
    let asked = std::env::var("TWINTAC_PYTHON");
    let python = asked.as_deref().unwrap_or("python3");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/rate/touch_grid.py");
    let settings =
        json!({ "n_scenes": n_scenes, "n_threads": n_threads, "n_steps": N_STEPS, "n_warm_up": N_WARM_UP });
    let output = Command::new(python)
        .arg(script)
        .arg(settings.to_string())
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output();
    let failure = match output {
        Ok(output) if output.status.success() => {
            let printed: Printed = serde_json::from_slice(&output.stdout)?;
            let rate = |seconds: &f64| n_scenes as f64 / seconds;
            return Ok(Ok(TouchGrid {
                version: printed.version,
                cells: printed.n_cells,
                touched: printed.touched,
                cells_touched: printed.cells_touched,
                steps_per_s: Spread::of(printed.seconds.iter().map(rate).collect()),
            }));
        }
        Ok(output) => String::from_utf8_lossy(&output.stderr)
            .lines()
            .last()
            .unwrap_or("no reason given")
            .to_owned(),
        Err(error) => error.to_string(),
    };
    match asked {
        Ok(python) => Err(format!("{python}, which TWINTAC_PYTHON names: {failure}").into()),
        Err(_) => Ok(Err(format!(
            "not measured: {failure}; TWINTAC_PYTHON can name a Python that has the package `mujoco`"
        ))),
    }
}
