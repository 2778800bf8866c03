//! The paper's data as one array for NumPy and pandas, with a data card.

use std::path::Path;

use digitac::PairedPress;
use serde::Serialize;
use twintac_run::{Run, Simulation, read_pairs};
use twintac_store::{Finished, Stage, write_file};
use twintac_work::{Progress, WorkError, sha256};

use crate::experiments::{PAPER_COMMAND, Paper};
use crate::structured_array::{Column, array, float};

/// The inputs of the array.
#[derive(Serialize)]
struct Frames<'a> {
    taxels: Vec<&'a String>,
    shapes: Vec<String>,
    pairs: Finished,
    simulation: Finished,
}

impl Stage for Frames<'_> {
    const NAME: &'static str = "pairs";
    const MADE_BY: &'static str = PAPER_COMMAND;
    type Follower = dyn Progress;
    type Error = WorkError;

    fn make(&self, folder: &Path, _: &dyn Progress) -> Result<(), WorkError> {
        let presses = read_pairs(&self.pairs)?;
        let split = Simulation::read(&self.simulation)?.split;
        let part = |press: usize| {
            let is_test = u8::from(split.test.contains(&press));
            let chooses = u8::from(split.validation.contains(&press));
            2 * is_test + chooses
        };
        let parts: Vec<u8> = (0..presses.len()).map(part).collect();
        let taxels: Vec<String> = self.taxels.iter().copied().cloned().collect();
        let array = array(&presses, &columns(&taxels, self.shapes.clone(), parts));
        let n_frames = presses.iter().map(|press| press.features.n_frames()).sum();
        let card = card(n_frames, presses.len(), &self.shapes, &taxels, &sha256(&array));
        write_file(&folder.join("frames.npy"), &array)?;
        Ok(write_file(&folder.join("CARD.md"), card.as_bytes())?)
    }
}

impl Paper {
    /// Writes `frames.npy` and `CARD.md`: each frame of the bench beside its simulation.
    pub(super) fn pairs(&self, data: &Run) -> Result<(), WorkError> {
        self.run_stage(&Frames {
            taxels: self
                .sensor
                .sensor
                .taxels
                .iter()
                .map(|taxel| &taxel.name)
                .collect(),
            shapes: self.shape_names(),
            pairs: data.pairs()?,
            simulation: data.simulation()?,
        })
        .map(drop)
    }
}

fn columns(taxels: &[String], shapes: Vec<String>, parts: Vec<u8>) -> Vec<Column> {
    let shape = move |press: &PairedPress| shapes.iter().position(|name| *name == press.indenter);
    let mut columns = vec![
        Column {
            name: "press".into(),
            kind: "<i4",
            value: Box::new(|_, press, _| (press as i32).to_le_bytes().to_vec()),
        },
        Column {
            name: "part".into(),
            kind: "|u1",
            value: Box::new(move |_, press, _| vec![parts[press]]),
        },
        Column {
            name: "shape".into(),
            kind: "|i1",
            value: Box::new(move |press, _, _| vec![shape(press).map_or(u8::MAX, |shape| shape as u8)]),
        },
        float("time_s", |press, frame| press.features.time_s[frame]),
        float("x_mm", |press, _| press.place_mm[0]),
        float("y_mm", |press, _| press.place_mm[1]),
        float("depth_mm", |press, frame| press.features.depth_mm[frame]),
        float("force_n", |press, frame| {
            press
                .measured_force_n
                .as_ref()
                .map_or(f64::NAN, |force_n| force_n[frame])
        }),
        float("simulated_force_n", |press, frame| press.features.force_n[frame]),
    ];
    for (k, taxel) in taxels.iter().enumerate() {
        columns.push(float(format!("{taxel}_kpa"), move |press, frame| {
            if press.valid[frame][k] {
                press.readings_kpa[frame][k]
            } else {
                f64::NAN
            }
        }));
    }
    for (k, taxel) in taxels.iter().enumerate() {
        columns.push(float(format!("{taxel}_port_kpa"), move |press, frame| {
            press.features.pressure_kpa[frame][k]
        }));
    }
    for (k, taxel) in taxels.iter().enumerate() {
        columns.push(float(
            format!("{taxel}_stress_kpa_per_mm"),
            move |press, frame| press.features.stress_kpa_per_mm[frame][k],
        ));
    }
    columns
}

fn card(n_frames: usize, n_presses: usize, shapes: &[String], taxels: &[String], sha256: &str) -> String {
    let (shapes, taxels) = (shapes.join(", "), taxels.join(", "));
    format!(
        "# Paired frames of a PhysTac\n\n\
         {n_frames} frames of {n_presses} presses: the readings of a test setup (`emulated`), beside the finite-element simulation of the gel at the same instant (`simulated`). Made by \
         `twintac reproduce --paper`.\n\n\
         ```python\n\
         import numpy as np\n\
         import pandas as pd\n\n\
         frames = np.load(\"frames.npy\")\n\
         readings = np.stack([frames[f\"t{{k}}_kpa\"] for k in range(8)], axis=1)\n\
         stress = np.stack([frames[f\"t{{k}}_stress_kpa_per_mm\"] for k in range(8)], axis=1)\n\
         test = frames[\"part\"] == 2\n\
         print(readings[~test].shape, stress[~test].shape)\n\
         print(pd.DataFrame(frames).groupby(\"shape\")[\"force_n\"].max())\n\
         ```\n\n\
         | column | meaning |\n|---|---|\n\
         | `press` | number of the press |\n\
         | `part` | 0 training, 1 validation, 2 test; whole presses |\n\
         | `shape` | number of the shape, from zero: {shapes} |\n\
         | `time_s` | time in the press, s |\n\
         | `x_mm`, `y_mm` | location of the press in the gel's plane, mm |\n\
         | `depth_mm` | depth below first touch, mm; negative above the gel |\n\
         | `force_n`, `simulated_force_n` | axial force on the shape, N: measured, and of the gel |\n\
         | `<taxel>_kpa` | reading above the unloaded baseline, kPa; NaN if it was not usable. Taxels: {taxels} |\n\
         | `<taxel>_port_kpa` | the gel's pressure at the taxel's port, kPa |\n\
         | `<taxel>_stress_kpa_per_mm` | the paper's feature: mean of von Mises stress over distance, over the taxel's cluster of surface nodes, kPa/mm (arXiv 2509.10063, equation 6) |\n\n\
         SHA-256 of `frames.npy`: `{sha256}`\n"
    )
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
    use digitac::{Features, Warp};
    use std::process::Command;

    use super::*;

    fn press(name: &str, n_frames: usize) -> PairedPress {
        let row = |from: f64| (0..8).map(|k| from + f64::from(k)).collect::<Vec<f64>>();
        let rows = |from: f64| {
            (0..n_frames)
                .map(|frame| row(from + 100.0 * frame as f64))
                .collect()
        };
        let numbers = |from: f64| {
            (0..n_frames)
                .map(|frame| from + frame as f64)
                .collect::<Vec<f64>>()
        };
        let mut valid = vec![vec![true; 8]; n_frames];
        valid[0][7] = false;
        PairedPress {
            name: name.into(),
            mounting: "lab".into(),
            indenter: "cube".into(),
            place_mm: [1.0, -2.0],
            features: Features {
                time_s: numbers(0.0),
                depth_mm: numbers(-1.0),
                force_n: numbers(3.0),
                pressure_kpa: rows(10.0),
                stress_kpa_per_mm: rows(20.0),
                simulated: vec![true; n_frames],
                since_previous_s: None,
                zero_frames: 0..1,
            },
            measured_force_n: Some(numbers(4.0)),
            readings_kpa: rows(0.0),
            valid,
            warp: Warp::identity(n_frames),
        }
    }

    /// The Python lines of the card read the array. `TWINTAC_PYTHON` names an interpreter with
    /// `numpy` and `pandas`.
    #[test]
    fn the_lines_of_the_card_read_the_array() {
        let asked = std::env::var("TWINTAC_PYTHON");
        let python = asked.clone().unwrap_or_else(|_| "python3".into());
        let import = Command::new(&python)
            .args(["-c", "import numpy, pandas"])
            .output();
        if !import.is_ok_and(|output| output.status.success()) {
            assert!(asked.is_err(), "{python} has no numpy or no pandas");
            eprintln!("skipped: no Python with numpy and pandas; TWINTAC_PYTHON can name one");
            return;
        }
        let shapes = ["sphere", "cube"].map(str::to_owned);
        let taxels: Vec<String> = (0..8).map(|k| format!("t{k}")).collect();
        let presses = [press("a", 3), press("b", 2)];
        let bytes = array(&presses, &columns(&taxels, shapes.to_vec(), vec![0, 2]));
        let card = card(5, 2, &shapes, &taxels, &sha256(&bytes));
        let lines = card.split("```").nth(1).unwrap().trim_start_matches("python");
        let checks = "
assert len(frames) == 5 and list(frames['press']) == [0, 0, 0, 1, 1]
assert list(frames['depth_mm']) == [-1, 0, 1, -1, 0] and set(frames['shape']) == {1}
assert readings[2, 5] == 205 and np.isnan(readings[0, 7]) and stress[1, 0] == 120
assert frames['t3_port_kpa'][4] == 113 and frames['force_n'][4] == 5 and test.sum() == 2
";
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("frames.npy"), &bytes).unwrap();
        std::fs::write(folder.path().join("card.py"), format!("{lines}{checks}")).unwrap();
        let run = Command::new(&python)
            .arg("card.py")
            .current_dir(&folder)
            .output()
            .unwrap();
        assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
        assert!(String::from_utf8_lossy(&run.stdout).starts_with("(3, 8) (3, 8)"));
    }
}
