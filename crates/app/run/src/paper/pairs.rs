//! The paper's data as one array that NumPy and pandas read, with a card that says what it is.

use digitac::{PairedPress, Split};

use super::experiments::Paper;
use crate::files::{read_json, sha256, write_file};
use crate::{Run, RunError};

/// Bytes of a value, from a press, its number and the number of its frame.
type Value = Box<dyn Fn(&PairedPress, usize, usize) -> Vec<u8>>;

/// A column: its name, NumPy's type of it, and its values.
struct Column {
    name: String,
    kind: &'static str,
    value: Value,
}

fn float(name: impl Into<String>, value: impl Fn(&PairedPress, usize) -> f64 + 'static) -> Column {
    Column {
        name: name.into(),
        kind: "<f4",
        value: Box::new(move |press, _, frame| (value(press, frame) as f32).to_le_bytes().to_vec()),
    }
}

impl Paper {
    /// Writes `frames.npy` and `CARD.md`: each frame of the bench beside what is simulated of it.
    pub(super) fn pairs(&self, data: &Run) -> Result<(), RunError> {
        let inputs = self
            .inputs()
            .stage(&data.stage("pairs"))?
            .stage(&data.stage("simulation"))?;
        self.run_stage("pairs", inputs, |folder| {
            let presses = data.pairs()?;
            let split: Split = read_json(&data.stage("simulation").join("split.json"))?;
            let part = |press: usize| {
                let judges = u8::from(split.test.contains(&press));
                let chooses = u8::from(split.validation.contains(&press));
                2 * judges + chooses
            };
            let parts: Vec<u8> = (0..presses.len()).map(part).collect();
            let taxels: Vec<String> = self.sensor.sensor.taxels.iter().map(|t| t.name.clone()).collect();
            let shapes = self.shape_names();
            let array = array(&presses, &columns(&taxels, shapes.clone(), parts));
            let n_frames = presses.iter().map(|press| press.features.n_frames()).sum();
            let card = card(n_frames, presses.len(), &shapes, &taxels, &sha256(&array));
            write_file(&folder.join("frames.npy"), &array)?;
            write_file(&folder.join("CARD.md"), card.as_bytes())
        })
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

/// The frames as a structured array in NumPy's format 1.0 (NumPy enhancement proposal 1).
fn array(presses: &[PairedPress], columns: &[Column]) -> Vec<u8> {
    let fields = columns
        .iter()
        .map(|column| format!("('{}', '{}')", column.name, column.kind));
    let fields = fields.collect::<Vec<_>>().join(", ");
    let n_frames: usize = presses.iter().map(|press| press.features.n_frames()).sum();
    let header = format!("{{'descr': [{fields}], 'fortran_order': False, 'shape': ({n_frames},), }}");
    let start = b"\x93NUMPY\x01\x00";
    let unpadded = start.len() + 2 + header.len() + 1;
    let padding = unpadded.next_multiple_of(64) - unpadded;
    let length = (header.len() + padding + 1) as u16;
    let mut bytes = [
        &start[..],
        &length.to_le_bytes(),
        header.as_bytes(),
        &vec![b' '; padding],
        b"\n",
    ]
    .concat();
    for (index, press) in presses.iter().enumerate() {
        for frame in 0..press.features.n_frames() {
            for column in columns {
                bytes.extend((column.value)(press, index, frame));
            }
        }
    }
    bytes
}

fn card(n_frames: usize, n_presses: usize, shapes: &[String], taxels: &[String], sha256: &str) -> String {
    let (shapes, taxels) = (shapes.join(", "), taxels.join(", "));
    format!(
        "# Paired frames of a PhysTac\n\n\
         {n_frames} frames of {n_presses} presses: what a bench read (`emulated`), beside what a finite-element gel shows at the same instant (`simulated`). Made by \
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
         | `part` | 0 trains, 1 chooses, 2 judges; whole presses |\n\
         | `shape` | number of the shape, from zero: {shapes} |\n\
         | `time_s` | time in the press, s |\n\
         | `x_mm`, `y_mm` | place of the press in the gel's plane, mm |\n\
         | `depth_mm` | depth below first touch, mm; negative above the gel |\n\
         | `force_n`, `simulated_force_n` | axial force on the shape, N: measured, and of the gel |\n\
         | `<taxel>_kpa` | reading above the unloaded baseline, kPa; NaN if it was not usable. Taxels: {taxels} |\n\
         | `<taxel>_port_kpa` | the gel's pressure at the taxel's port, kPa |\n\
         | `<taxel>_stress_kpa_per_mm` | the paper's feature: mean of von Mises stress over distance, over the taxel's cluster of surface nodes, kPa/mm (arXiv 2509.10063, equation 6) |\n\n\
         SHA-256 of `frames.npy`: `{sha256}`\n"
    )
}
