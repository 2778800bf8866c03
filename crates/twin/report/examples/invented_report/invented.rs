//! Invented results in the form of real ones.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

use digitac::{
    BenchEstimate, Epoch, Errors, Estimate, Evaluation, Features, Gains, Mean, PairedPress, PressEvaluation,
    Score, Variant, Warp,
};
use twintac_depth_table::{DepthTable, PressFrame, SolveQuality};
use twintac_recording::Provenance;
use twintac_report::{Making, StageTime, TrainedVariant, TwinReport};
use twintac_sensor::Sensor;
use twintac_shape::Pose;

/// The data that a [`TwinReport`] borrows.
pub(crate) struct Results {
    pub(crate) sensor: Sensor,
    pub(crate) provenance: Provenance,
    pub(crate) evaluation: Evaluation,
    pub(crate) left_out: BTreeSet<usize>,
    pub(crate) presses: Vec<PairedPress>,
    pub(crate) test: Vec<usize>,
    pub(crate) variants: Vec<(Variant, Score, Vec<Epoch>)>,
    pub(crate) bench: BenchEstimate,
    pub(crate) tables: Vec<DepthTable>,
    pub(crate) making: Making,
}

impl Results {
    pub(crate) fn report(&self) -> TwinReport<'_> {
        let trained = |(variant, score, history)| TrainedVariant {
            variant,
            is_chosen: variant == self.evaluation.variant,
            validation: score,
            test: score,
            history,
        };
        let variants = self.variants.iter();
        TwinReport {
            sensor: &self.sensor,
            provenance: self.provenance,
            evaluation: &self.evaluation,
            certainty: None,
            repeatability: None,
            left_out: &self.left_out,
            presses: &self.presses,
            test: &self.test,
            variants: variants
                .map(|(variant, score, history)| trained((*variant, score, history.as_slice())))
                .collect(),
            bench: &self.bench,
            tables: &self.tables,
            making: self.making.clone(),
        }
    }
}

/// A reproducible number in [-1, 1] that looks random.
fn ripple(index: usize) -> f64 {
    let x = (index as f64 * 12.9898).sin() * 43_758.547;
    2.0 * (x - x.floor()) - 1.0
}

fn phystac() -> Sensor {
    let text = include_str!("../../../../../sensors/phystac.toml");
    #[allow(clippy::unwrap_used)] // a description of this repository
    Sensor::parse("phystac.toml", text, &|name| std::fs::read(name)).unwrap()
}

/// Pressure at each taxel under a press at a place, kPa.
fn response(sensor: &Sensor, place_mm: [f64; 2], depth_mm: f64) -> Vec<f64> {
    let reading = |taxel: &twintac_sensor::Taxel| {
        let (dx, dy) = (
            taxel.position_mm.x - place_mm[0],
            taxel.position_mm.y - place_mm[1],
        );
        let r2 = (dx * dx + dy * dy) / 20.0;
        60.0 * depth_mm.powf(1.6) * ((-r2).exp() * 1.12 - 0.1 * (-r2 / 4.0).exp())
    };
    sensor.taxels.iter().map(reading).collect()
}

fn errors(percent: f64) -> Errors {
    let mean = |percent| Mean {
        percent: Some(percent),
        count: 900,
    };
    Errors {
        nearest_in_contact: mean(percent),
        all: mean(0.4 * percent),
        peak: mean(0.8 * percent),
    }
}

fn score(percent: f64, files: &[&str], n_taxels: usize) -> Score {
    let by_file = files.iter().enumerate();
    Score {
        definition: "Mean absolute error over the largest reading of the recording.".into(),
        overall: errors(percent),
        by_file: by_file
            .map(|(index, file)| ((*file).to_owned(), errors(percent + 0.1 * index as f64)))
            .collect(),
        by_taxel: (0..n_taxels)
            .map(|taxel| errors(percent * (1.0 + 0.4 * ripple(taxel))))
            .collect(),
        n_frames_not_simulated: 0,
        n_frames: 1000,
    }
}

fn press(sensor: &Sensor, name: &str, place_mm: [f64; 2], error: f64) -> PressEvaluation {
    let time_s: Vec<f64> = (0..900).map(|frame| f64::from(frame) / 55.0).collect();
    let depth = |time_s: &f64| (time_s - 2.0).min(12.0 - time_s).clamp(0.0, 2.2);
    let depth_mm: Vec<f64> = time_s.iter().map(depth).collect();
    let relaxed = |time_s: f64| 1.0 - 0.1 * (1.0 - (-(time_s - 4.0).max(0.0) / 2.0).exp());
    let frames = |factor: f64, noise_kpa: f64| -> Vec<Vec<f64>> {
        let frame = |(index, depth_mm): (usize, &f64)| -> Vec<f64> {
            let readings = response(sensor, place_mm, *depth_mm).into_iter().enumerate();
            let scale = factor * relaxed(time_s[index]);
            readings
                .map(|(taxel, kpa)| scale * kpa + noise_kpa * ripple(8 * index + taxel))
                .collect()
        };
        depth_mm.iter().enumerate().map(frame).collect()
    };
    PressEvaluation {
        name: name.into(),
        mounting: "sphere_a".into(),
        indenter: "sphere".into(),
        place_mm,
        measured_kpa: frames(1.0, 0.4),
        predicted_kpa: frames(1.0 - error, 0.0),
        valid: vec![vec![true; sensor.taxels.len()]; time_s.len()],
        largest_shift_s: 0.02,
        errors: errors(60.0 * error),
        time_s,
        depth_mm,
    }
}

fn paired(press: &PressEvaluation) -> PairedPress {
    let (n_frames, n_taxels) = (press.time_s.len(), press.measured_kpa[0].len());
    let force = |noise_n: f64| -> Vec<f64> {
        let depths = press.depth_mm.iter().enumerate();
        depths
            .map(|(frame, depth)| 3.0 * depth.powf(1.5) + noise_n * ripple(frame))
            .collect()
    };
    let shifted = |frame: usize| {
        let shift = 1.2 * (frame as f64 * TAU / n_frames as f64).sin();
        (frame as f64 + shift).clamp(0.0, n_frames as f64 - 1.0)
    };
    PairedPress {
        name: press.name.clone(),
        mounting: press.mounting.clone(),
        indenter: press.indenter.clone(),
        place_mm: press.place_mm,
        features: Features {
            time_s: press.time_s.clone(),
            depth_mm: press.depth_mm.clone(),
            force_n: force(0.0),
            pressure_kpa: press.predicted_kpa.clone(),
            stress_kpa_per_mm: vec![vec![0.0; n_taxels]; n_frames],
            simulated: vec![true; n_frames],
            since_previous_s: None,
            zero_frames: 0..0,
        },
        measured_force_n: Some(force(0.05)),
        readings_kpa: press.measured_kpa.clone(),
        valid: press.valid.clone(),
        warp: Warp {
            measured_index: (0..n_frames).map(shifted).collect(),
            cost: 0.0,
            largest_shift_s: 0.02,
        },
    }
}

fn table(failure: Option<&str>) -> DepthTable {
    let frame = |step: u32| PressFrame {
        depth_mm: 0.1 * f64::from(step),
        force_n: 0.2 * f64::from(step),
        port_pressure_kpa: vec![0.0; 8],
        port_slope_kpa_per_mm: vec![[0.0; 3]; 8],
        stress_feature_kpa_per_mm: vec![0.0; 8],
        quality: SolveQuality {
            iterations: 4,
            residual: 8.3e-7,
            penetration_mm: 0.0041,
            smallest_volume_ratio: 0.71,
            wall_time_s: 0.0,
        },
    };
    DepthTable {
        indenter: "sphere".into(),
        gel_from_indenter_at_touch: Pose::IDENTITY,
        n_nodes: 2100,
        frames: (0..23).map(frame).collect(),
        failure: failure.map(str::to_owned),
    }
}

fn results(sensor: Sensor, presses: Vec<PressEvaluation>) -> Results {
    let taxels: Vec<String> = sensor.taxels.iter().map(|taxel| taxel.name.clone()).collect();
    let (files, n_taxels) = (["sphere_a", "cube_a"], taxels.len());
    let twin = |percent| score(percent, &files, n_taxels);
    let history = |floor: f64| -> Vec<Epoch> {
        let loss = |epoch: usize, end: f64| {
            (end + 0.4 * (-(epoch as f64) / 18.0).exp()) * (1.0 + 0.06 * ripple(epoch))
        };
        let epochs = 0..200;
        epochs
            .map(|epoch| Epoch {
                learning_rate: 1e-3,
                loss: loss(epoch, floor),
                validation_loss: loss(epoch + 999, 1.4 * floor),
            })
            .collect()
    };
    let estimate = |value, uncertainty| Estimate { value, uncertainty };
    Results {
        provenance: Provenance::Simulated,
        left_out: BTreeSet::new(),
        test: (0..presses.len().min(6)).collect(),
        presses: presses.iter().map(paired).collect(),
        evaluation: Evaluation {
            variant: Variant::PressureMemory,
            taxels,
            twin: twin(1.27),
            warped: Errors::default(),
            zero: twin(38.0),
            polynomial: Some(twin(3.4)),
            kernel: Some(twin(2.1)),
            presses,
        },
        variants: vec![
            (Variant::Pressure, twin(1.9), history(0.019)),
            (Variant::PressureMemory, twin(1.27), history(0.011)),
            (Variant::PressureMemoryMlp, twin(1.41), history(0.014)),
        ],
        bench: BenchEstimate {
            tip_radius_mm: Some(estimate(2.85, 0.12)),
            contact_offset_mm: BTreeMap::from([("sphere_a".to_owned(), estimate(0.041, 0.009))]),
            ports: Vec::new(),
            smooth_factor: None,
            has_history: false,
            gains: Some(Gains {
                gain: (0..n_taxels)
                    .map(|taxel| 0.9 + 0.35 * ripple(taxel + 7))
                    .collect(),
                stiffening_per_kpa: vec![0.0; 8],
                memory: vec![Vec::new(); n_taxels],
                time_constants_s: Vec::new(),
            }),
            doubts: vec!["Every number on this page is invented, to show what a report looks like.".into()],
            contact_offset_elsewhere_mm: 0.041,
            stiffness: None,
            deviation_percent: 0.9,
        },
        tables: vec![
            table(None),
            table(Some("Press 17: no equilibrium was found at 3.4 mm.")),
        ],
        making: Making {
            command: "cargo run -p twintac-report --release --example invented_report".into(),
            source: "invented".into(),
            seed: 7,
            settings: "[training]\nlearning_rate = 1e-3\n".into(),
            stages: [("mesh", 1.2), ("simulation", 412.0), ("training", 96.0)]
                .map(|(name, wall_s)| StageTime {
                    name: name.into(),
                    wall_s,
                })
                .to_vec(),
        },
        sensor,
    }
}

/// Presses over time.
pub(crate) fn moving() -> Results {
    let sensor = phystac();
    let presses = vec![
        press(&sensor, "press at (-4.0, -4.0) mm", [-4.0, -4.0], 0.01),
        press(&sensor, "press at (3.0, 1.0) mm", [3.0, 1.0], 0.03),
        press(&sensor, "press at (8.0, 4.5) mm", [8.0, 4.5], 0.12),
    ];
    results(sensor, presses)
}

/// Presses that are one frame each.
pub(crate) fn resting() -> Results {
    let sensor = phystac();
    let place = |index: usize| [-17.0 + (index % 35) as f64, -9.0 + (index / 35) as f64];
    let presses = (0..35 * 19).map(|index| {
        let place_mm = place(index);
        let measured = response(&sensor, place_mm, 2.0);
        let error = 1.0 + 2.0 * (place_mm[0] / 6.0).sin().powi(2) + 0.4 * ripple(index);
        PressEvaluation {
            name: format!("press {index}"),
            mounting: "grid".into(),
            indenter: "sphere".into(),
            place_mm,
            time_s: vec![0.0],
            depth_mm: vec![2.0],
            predicted_kpa: vec![measured.iter().map(|kpa| 0.97 * kpa).collect()],
            valid: vec![vec![true; measured.len()]],
            measured_kpa: vec![measured],
            largest_shift_s: 0.0,
            errors: errors(error),
        }
    });
    let presses = presses.collect();
    results(sensor, presses)
}
