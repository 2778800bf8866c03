//! Data that nobody measured, in the shape of data that somebody could.

use std::f64::consts::TAU;

use twintac_map::Rectangle;
use twintac_plot::Scene;
use twintac_plot::page::Fact;
use twintac_report::data::{
    Agreement, BenchFit, DepthError, FileError, Gain, Headline, Parameter, PlaceErrors, PressPeak,
    PressSeries, Reference, ReferenceKind, SensorSummary, SimulationQuality, Stage, TaxelError,
    TrainingCurve, Variant, WarpPath,
};
use twintac_report::{Provenance, ReportData};
use twintac_sensor::Sensor;

const PITCH_MM: f64 = 8.0;
const GEL_MM: Rectangle = Rectangle {
    min_mm: [-17.0, -9.0],
    max_mm: [17.0, 9.0],
};

fn taxels_mm() -> Vec<[f64; 2]> {
    (0..8)
        .map(|i| {
            [
                PITCH_MM * (f64::from(i % 4) - 1.5),
                PITCH_MM * (f64::from(i / 4) - 0.5),
            ]
        })
        .collect()
}

/// A repeatable number in [-1, 1] that looks random.
fn ripple(index: usize) -> f64 {
    let x = (index as f64 * 12.9898).sin() * 43_758.547;
    2.0 * (x - x.floor()) - 1.0
}

/// Pressure at each taxel under a press at a place, kPa.
fn response(place_mm: [f64; 2], depth_mm: f64) -> Vec<f64> {
    let reading = |taxel: &[f64; 2]| {
        let r2 = ((taxel[0] - place_mm[0]).powi(2) + (taxel[1] - place_mm[1]).powi(2)) / 20.0;
        60.0 * depth_mm.powf(1.6) * ((-r2).exp() * 1.12 - 0.1 * (-r2 / 4.0).exp())
    };
    taxels_mm().iter().map(reading).collect()
}

fn press(label: &str, place_mm: [f64; 2], error: f64) -> PressSeries {
    let time_s: Vec<f64> = (0..900).map(|frame| f64::from(frame) / 55.0).collect();
    let depth_mm: Vec<f64> = time_s
        .iter()
        .map(|t| (t - 2.0).min(12.0 - t).clamp(0.0, 2.2))
        .collect();
    let frame = |(i, depth): (usize, &f64)| -> Vec<f64> {
        let relaxed = 1.0 - 0.1 * (1.0 - (-(time_s[i] - 4.0).max(0.0) / 2.0).exp());
        response(place_mm, *depth)
            .iter()
            .enumerate()
            .map(|(k, p)| p * relaxed + 0.4 * ripple(8 * i + k))
            .collect()
    };
    let sensor_kpa: Vec<Vec<f64>> = depth_mm.iter().enumerate().map(frame).collect();
    let twin = |(i, depth): (usize, &f64)| -> Vec<f64> {
        let relaxed = 1.0 - 0.09 * (1.0 - (-(time_s[i] - 4.0).max(0.0) / 2.2).exp());
        response(place_mm, *depth)
            .iter()
            .map(|p| p * relaxed * (1.0 - error))
            .collect()
    };
    PressSeries {
        label: label.into(),
        name: format!("press at ({:.1}, {:.1}) mm", place_mm[0], place_mm[1]),
        nearest_in_contact_percent: 60.0 * error,
        taxels: (0..8).map(|i| format!("T{i}")).collect(),
        twin_kpa: depth_mm.iter().enumerate().map(twin).collect(),
        sensor_force_n: depth_mm
            .iter()
            .enumerate()
            .map(|(i, d)| 3.1 * d.powf(1.5) + 0.05 * ripple(i))
            .collect(),
        twin_force_n: depth_mm.iter().map(|d| 3.0 * d.powf(1.5)).collect(),
        time_s,
        sensor_kpa,
        depth_mm,
    }
}

fn peak(place_mm: [f64; 2]) -> PressPeak {
    let sensor_kpa = response(place_mm, 2.2);
    PressPeak {
        name: format!(
            "Sphere at ({:.1}, {:.1}) mm, 2.2 mm deep",
            place_mm[0], place_mm[1]
        ),
        gel_mm: GEL_MM,
        taxels_mm: taxels_mm(),
        twin_kpa: sensor_kpa
            .iter()
            .enumerate()
            .map(|(i, p)| p * (1.0 + 0.05 * ripple(i)) + 1.0)
            .collect(),
        sensor_kpa,
        indenter_mm: Some((place_mm, 3.0)),
    }
}

fn curve(name: &str, floor: f64) -> TrainingCurve {
    let step: Vec<f64> = (1..=200).map(|i| f64::from(i) * 50.0).collect();
    let loss = |i: usize, s: &f64, end: f64| (end + 0.4 * (-s / 900.0).exp()) * (1.0 + 0.06 * ripple(i));
    TrainingCurve {
        name: name.into(),
        training_loss: step.iter().enumerate().map(|(i, s)| loss(i, s, floor)).collect(),
        validation_loss: step
            .iter()
            .enumerate()
            .map(|(i, s)| loss(i + 999, s, 1.4 * floor))
            .collect(),
        step,
    }
}

/// PhysTac, drawn from its description.
pub(crate) fn drawing() -> Scene {
    let text = include_str!("../../../../../sensors/phystac.toml");
    let sensor = Sensor::parse("phystac.toml", text, &|name| std::fs::read(name)).unwrap();
    twintac_drawing::drawing(&sensor)
}

fn common() -> ReportData {
    let reference = |name: &str, kind, nearest, all| Reference {
        name: name.into(),
        kind,
        nearest_in_contact_percent: nearest,
        all_percent: Some(all),
    };
    let mut data = ReportData {
        provenance: Provenance::Simulated,
        command: "cargo run -p twintac-report --release --example gallery".into(),
        versions: vec![Fact::new("twintac", "0.1.0"), Fact::new("data", "invented")],
        seed: Some(7),
        warnings: vec!["Every number on this page is invented, to show what a report looks like.".into()],
        settings: "[training]\nlearning_rate = 1e-3\nsteps = 10000\n".into(),
        ..ReportData::default()
    };
    data.headline = Some(Headline {
        presses: 12,
        nearest_in_contact_percent: 1.27,
        all_percent: 0.46,
        definition:
            "Mean absolute error over the largest reading of the recording. Nearest in contact: frames with \
                     depth above zero in which the largest reading exceeds 3 % of that maximum, at its taxel."
                .into(),
        references: vec![
            reference("zero", ReferenceKind::Baseline, 38.0, 11.4),
            reference("polynomial", ReferenceKind::Baseline, 3.4, 1.2),
            reference("repeatability", ReferenceKind::Floor, 0.8, 0.25),
        ],
    });
    data.sensor = Some(SensorSummary {
        name: "An eight-taxel sensor".into(),
        facts: vec![
            Fact::new("gel", "34 × 18 × 8.5 mm"),
            Fact::new("taxels", "8, pitch 8 mm"),
            Fact::new("shell gap", "1 mm"),
        ],
        drawing: Some(drawing()),
    });
    data.taxels = (0..8)
        .map(|i| TaxelError {
            name: format!("T{i}"),
            nearest_in_contact_percent: 1.3 + 0.5 * ripple(i),
            all_percent: 0.45 + 0.1 * ripple(i + 50),
            bias_percent: 0.3 * ripple(i + 90),
            note: if i == 5 {
                "touches early".into()
            } else {
                String::new()
            },
        })
        .collect();
    data
}

/// A report on presses over time.
pub(crate) fn moving() -> ReportData {
    let mut data = common();
    data.title = "Eight taxels under a sphere (invented data)".into();
    data.presses = vec![
        press("best", [-4.0, -4.0], 0.01),
        press("median", [3.0, 1.0], 0.03),
        press("worst", [8.0, 4.5], 0.12),
    ];
    data.peaks = vec![peak([-4.0, -4.0]), peak([3.0, 1.0]), peak([8.0, 4.5])];
    let measured_kpa: Vec<f64> = data
        .presses
        .iter()
        .flat_map(|p| p.sensor_kpa.iter().flatten().copied())
        .collect();
    let predicted_kpa = data
        .presses
        .iter()
        .flat_map(|p| p.twin_kpa.iter().flatten().copied())
        .collect();
    data.agreement = Some(Agreement {
        measured_kpa,
        predicted_kpa,
    });
    data.depths = (0..6u32)
        .map(|i| DepthError {
            from_mm: 0.4 * f64::from(i),
            to_mm: 0.4 * f64::from(i + 1),
            frames: 200,
            nearest_in_contact_percent: 0.5 + 0.3 * f64::from(i),
        })
        .collect();
    data.files = ["sphere_a", "sphere_b", "cube_a"]
        .iter()
        .enumerate()
        .map(|(i, name)| FileError {
            name: (*name).into(),
            role: ["training", "validation", "test"][i].into(),
            provenance: None,
            presses: 12 + i,
            frames: 9000 + 100 * i,
            largest_kpa: 210.0 + 3.0 * i as f64,
            nearest_in_contact_percent: 1.0 + 0.2 * i as f64,
            all_percent: 0.4 + 0.1 * i as f64,
        })
        .collect();
    data.variants = [
        ("physics, one gain a taxel", 1.9),
        ("physics and memory", 1.27),
        ("physics and MLP", 1.41),
    ]
    .iter()
    .map(|&(name, error)| Variant {
        name: name.into(),
        nearest_in_contact_percent: error,
        all_percent: 0.4 * error,
        validation_percent: 0.95 * error,
        chosen: error < 1.3,
    })
    .collect();
    data.training = vec![
        curve("physics and memory", 0.011),
        curve("physics and MLP", 0.014),
    ];
    let parameter = |name: &str, value, half, unit: &str| Parameter {
        name: name.into(),
        value,
        uncertainty: Some(half),
        unit: unit.into(),
    };
    data.bench = Some(BenchFit {
        parameters: vec![
            parameter("indenter radius", 2.85, 0.12, "mm"),
            parameter("contact offset", 0.041, 0.009, "mm"),
        ],
        gains: (0..8)
            .map(|i| Gain {
                taxel: format!("T{i}"),
                value: 0.9 + 0.35 * ripple(i + 7),
                uncertainty: Some(0.04 + 0.02 * ripple(i)),
            })
            .collect(),
        objective_by_radius: (0..30)
            .map(|i| 1.5 + 0.1 * f64::from(i))
            .map(|r| [r, 1.4 + 0.8 * (r - 2.85).powi(2)])
            .collect(),
    });
    data.warps = (0..3)
        .map(|i| WarpPath {
            name: format!("press {i}"),
            time_s: (0..300).map(|t| f64::from(t) * 0.05).collect(),
            shift_s: (0..300)
                .map(|t| 0.02 * (f64::from(t) * TAU / 300.0 + f64::from(i)).sin())
                .collect(),
        })
        .collect();
    data.simulation = Some(SimulationQuality {
        frames: 4210,
        worst_residual: 8.3e-7,
        largest_penetration_mm: 0.0041,
        smallest_volume_ratio: 0.71,
        failures: vec!["Press 17 of sphere_b: three frames did not converge at 3.4 mm.".into()],
    });
    data.stages = [
        ("mesh", 1.2),
        ("simulate", 412.0),
        ("align", 3.5),
        ("train", 96.0),
        ("evaluate", 0.8),
    ]
    .iter()
    .map(|&(name, wall_s)| Stage {
        name: name.into(),
        wall_s,
    })
    .collect();
    data
}

/// A report on presses that are one frame each.
pub(crate) fn resting() -> ReportData {
    let mut data = common();
    data.title = "A grid of resting presses (invented data)".into();
    let places_mm: Vec<[f64; 2]> = (0..69 * 37)
        .map(|i| [-17.0 + 0.5 * f64::from(i % 69), -9.0 + 0.5 * f64::from(i / 69)])
        .collect();
    let error = |(i, place): (usize, &[f64; 2])| {
        1.0 + (place[0] / 6.0).sin().powi(2) * 2.0 + 0.4 * ripple(i) + if i % 400 == 7 { 15.0 } else { 0.0 }
    };
    data.places = Some(PlaceErrors {
        nearest_percent: places_mm.iter().enumerate().map(error).collect(),
        all_percent: places_mm
            .iter()
            .enumerate()
            .map(|pair| 0.4 * error(pair))
            .collect(),
        places_mm,
        taxels_mm: taxels_mm(),
    });
    data.peaks = vec![peak([-6.0, 2.0]), peak([10.0, -3.0])];
    data
}
