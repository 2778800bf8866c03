//! Known materials, found again in noisy curves: how well a calibration does, and whether its confidence intervals mean what they say.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, Result, ensure};
use glam::DQuat;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;
use twintac_calibrate::{
    Curve, Fit, FitSettings, Isochoric, Material, Parameter, PronyTerm, Quantity, Signal, coverage_95, fit,
};
use twintac_report::plot::{Panel, Panels, Series};
use twintac_report::{Ink, svg};
use twintac_sensor::Sensor;
use twintac_shape::Shape;
use twintac_simulate::{Gel, Keyframe, PressPlace, SimulateSettings};

/// Noise of the force over its largest value.
const NOISE: f64 = 0.01;

/// Samples of a curve.
const SAMPLES: usize = 1000;

/// Depth of the presses, mm.
const DEPTH_MM: f64 = 4.0;

/// How long it takes to go down, and up again, s.
const DOWN_S: f64 = 2.0;

/// How long relaxing gels are held, s.
const HOLD_S: f64 = 16.0;

/// Repetitions of the noise for the coverage of the confidence intervals.
const REPETITIONS: u32 = 10_000;

/// Seed of all noise.
const SEED: u64 = 20;

const BLOCK: &str = r#"
name = "block"
summary = "a bonded block"
source = "a case of its own"

[gel.solid]
kind = "block"
size_mm = [30.0, 20.0, 8.0]

[gel.material]
shear_modulus_kpa = 20.0
poissons_ratio = 0.47
source = "chosen"

[readout]
min_kpa = 0.0
max_kpa = 1500.0
resolution_kpa = 0.01
rate_hz = 55.0

[[taxels]]
name = "middle"
position_mm = [0.0, 0.0, 0.0]
port_radius_mm = 1.0
channel = 0
"#;

/// A material to be found.
struct Case {
    name: &'static str,
    truth: Material,
    start: Material,
    /// Names of what is free, and true values.
    free: Vec<(&'static str, f64)>,
}

/// What came of a case.
#[derive(Serialize)]
struct Found {
    case: &'static str,
    unknowns: Vec<FoundUnknown>,
    condition: f64,
    iterations: u32,
    noise_percent: f64,
    warnings: Vec<String>,
    #[serde(skip)]
    fit: Fit,
}

#[derive(Serialize)]
struct FoundUnknown {
    name: &'static str,
    truth: f64,
    start: f64,
    found: f64,
    error_percent: f64,
    interval_95: [f64; 2],
    holds_truth: bool,
    /// Part of the repetitions of the noise in which the linearised model's interval holds the truth.
    coverage: f64,
}

/// Fits all cases; prints a table or JSON, and writes `calibration.json`, `calibration.md` and `calibration.svg` to a folder if one is given.
pub(crate) fn run(as_json: bool, out: Option<&Path>) -> Result<()> {
    let mut all = Vec::new();
    for case in cases() {
        all.push(find(&case)?);
    }
    let json = serde_json::to_string_pretty(&all)?;
    if let Some(folder) = out {
        std::fs::create_dir_all(folder).with_context(|| format!("creating {}", folder.display()))?;
        for (name, text) in [
            ("calibration.json", format!("{json}\n")),
            ("calibration.md", page(&all)?),
            ("calibration.svg", svg(&plot(&all))),
        ] {
            let path = folder.join(name);
            let temporary = folder.join(format!("{name}.tmp"));
            std::fs::write(&temporary, text).with_context(|| format!("writing {}", temporary.display()))?;
            std::fs::rename(&temporary, &path)
                .with_context(|| format!("renaming {}", temporary.display()))?;
        }
    }
    let mut stdout = std::io::stdout().lock();
    if as_json {
        writeln!(stdout, "{json}")?;
    } else {
        write!(stdout, "{}", table(&all)?)?;
    }
    Ok(())
}

fn cases() -> Vec<Case> {
    let neo_hookean = |shear_kpa: f64, ratio: f64, terms: &[[f64; 2]]| Material {
        prony: terms
            .iter()
            .map(|&[weight, time_s]| PronyTerm { weight, time_s })
            .collect(),
        ..Material::neo_hookean(2.0 * (1.0 + ratio) * shear_kpa, ratio)
    };
    let yeoh = |c10_kpa: f64, c20_kpa: f64| Material {
        isochoric: Isochoric::Yeoh {
            c10_kpa,
            c20_kpa,
            c30_kpa: 0.0,
        },
        bulk_modulus_kpa: 30.0 * c10_kpa,
        prony: Vec::new(),
    };
    let shear = ("shear_modulus_kpa", 20.0);
    vec![
        Case {
            name: "neo-Hookean, and where the surface is",
            truth: neo_hookean(20.0, 0.47, &[]),
            start: neo_hookean(35.0, 0.47, &[]),
            free: vec![shear, ("depth_offset_mm", 0.05)],
        },
        Case {
            name: "neo-Hookean, and its bulk modulus",
            truth: neo_hookean(20.0, 0.45, &[]),
            start: neo_hookean(35.0, 0.40, &[]),
            free: vec![shear, ("bulk_modulus_kpa", 20.0 * 2.9 / 0.3)],
        },
        Case {
            name: "Yeoh",
            truth: yeoh(10.0, 6.0),
            start: yeoh(16.0, 0.0),
            free: vec![("c10_kpa", 10.0), ("c20_kpa", 6.0)],
        },
        Case {
            name: "neo-Hookean with one Prony term",
            truth: neo_hookean(20.0, 0.47, &[[0.3, 1.5]]),
            start: neo_hookean(30.0, 0.47, &[[0.1, 4.0]]),
            free: vec![shear, ("prony[0].weight", 0.3), ("prony[0].time_s", 1.5)],
        },
        Case {
            name: "neo-Hookean with two Prony terms",
            truth: neo_hookean(20.0, 0.47, &[[0.25, 0.4], [0.2, 5.0]]),
            start: neo_hookean(25.0, 0.47, &[[0.1, 0.2], [0.1, 10.0]]),
            free: vec![
                shear,
                ("prony[0].weight", 0.25),
                ("prony[0].time_s", 0.4),
                ("prony[1].weight", 0.2),
                ("prony[1].time_s", 5.0),
            ],
        },
    ]
}

fn gel(material: &Material) -> Result<Gel> {
    let none = |path: &str| Err(std::io::Error::other(format!("{path} is not read here")));
    let mut settings = SimulateSettings {
        max_nodes: 2000,
        ..SimulateSettings::default()
    };
    settings.solver.tolerance = 1e-6;
    let sensor = Sensor::parse("block", BLOCK, &none)?;
    Ok(Gel::new(Arc::new(sensor), settings).with_material(material.clone()))
}

/// A curve as a bench would measure it.
fn measure(case: &Case, random: &mut ChaCha8Rng) -> Result<Curve> {
    let hold_s = if case.truth.prony.is_empty() { 0.0 } else { HOLD_S };
    let end_s = 2.0 * DOWN_S + hold_s;
    let time_s: Vec<f64> = (0..SAMPLES)
        .map(|sample| end_s * sample as f64 / (SAMPLES - 1) as f64)
        .collect();
    let true_mm = |time_s: f64| DEPTH_MM * (time_s / DOWN_S).min((end_s - time_s) / DOWN_S).clamp(0.0, 1.0);
    let shape = Shape::Sphere { radius_mm: 6.0 };
    let place = PressPlace {
        indenter: "ball".into(),
        shape: shape.clone(),
        x_mm: 1.0,
        y_mm: 0.5,
        rotation: DQuat::IDENTITY,
        depth_mm: DEPTH_MM,
        enough_force_n: None,
    };
    let keyframes: Vec<Keyframe> = time_s
        .iter()
        .map(|&time_s| Keyframe {
            time_s,
            depth_mm: true_mm(time_s),
        })
        .collect();
    let sweep = gel(&case.truth)?.press(&place, &keyframes)?;
    ensure!(sweep.failure.is_none(), "{}: {:?}", case.name, sweep.failure);
    let largest_n = sweep.frames.iter().map(|frame| frame.force_n).fold(0.0, f64::max);
    let offset_mm = case.free.iter().find(|(name, _)| *name == "depth_offset_mm");
    let offset_mm = offset_mm.map_or(0.0, |(_, truth)| *truth);
    Ok(Curve {
        name: case.name.into(),
        shape,
        x_mm: place.x_mm,
        y_mm: place.y_mm,
        rotation: place.rotation,
        depth_mm: time_s.iter().map(|&time_s| true_mm(time_s) - offset_mm).collect(),
        time_s,
        signals: vec![Signal {
            quantity: Quantity::Force,
            values: sweep
                .frames
                .iter()
                .map(|frame| frame.force_n + NOISE * largest_n * normal(random))
                .collect(),
        }],
    })
}

fn find(case: &Case) -> Result<Found> {
    let mut random = ChaCha8Rng::seed_from_u64(SEED);
    let curve = measure(case, &mut random)?;
    let free = case
        .free
        .iter()
        .map(|(name, _)| name.parse())
        .collect::<Result<Vec<Parameter>, _>>()?;
    let settings = FitSettings {
        most_frames: 80,
        ..FitSettings::default()
    };
    let fit = fit(&gel(&case.start)?, &[curve], &free, settings, &mut |_| ())?;
    ensure!(fit.converged, "{}: {:?}", case.name, fit.warnings);
    let coverage = coverage_95(&fit.jacobian, REPETITIONS, &mut || normal(&mut random))
        .with_context(|| format!("{}: the unknowns can't be told apart", case.name))?;
    let mut unknowns = Vec::new();
    for (unknown, coverage) in fit.unknowns.iter().zip(coverage) {
        let (name, truth) = *case
            .free
            .iter()
            .find(|(name, _)| *name == unknown.parameter)
            .with_context(|| format!("{}: `{}` was not free", case.name, unknown.parameter))?;
        let [low, high] = unknown.interval_95;
        unknowns.push(FoundUnknown {
            name,
            truth,
            start: unknown.start,
            found: unknown.value,
            error_percent: 100.0 * (unknown.value / truth - 1.0),
            interval_95: unknown.interval_95,
            holds_truth: low < truth && truth < high,
            coverage,
        });
    }
    Ok(Found {
        case: case.name,
        unknowns,
        condition: fit.condition,
        iterations: fit.iterations,
        noise_percent: fit.noise_percent,
        warnings: fit.warnings.clone(),
        fit,
    })
}

/// A number from the normal distribution (Box and Muller, 1958).
fn normal(random: &mut ChaCha8Rng) -> f64 {
    let (u, v): (f64, f64) = (random.random(), random.random());
    (-2.0 * (1.0 - u).ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

fn table(all: &[Found]) -> Result<String> {
    let mut text = String::new();
    writeln!(
        text,
        "| material | unknown | true | start | found | error | 95 % interval | holds truth | coverage |\n|---|---|---|---|---|---|---|---|---|"
    )?;
    for found in all {
        for unknown in &found.unknowns {
            let [low, high] = unknown.interval_95;
            writeln!(
                text,
                "| {} | `{}` | {:.4} | {:.4} | {:.4} | {:+.2} % | {low:.4} to {high:.4} | {} | {:.1} % |",
                found.case,
                unknown.name,
                unknown.truth,
                unknown.start,
                unknown.found,
                unknown.error_percent,
                if unknown.holds_truth { "yes" } else { "no" },
                100.0 * unknown.coverage
            )?;
        }
    }
    Ok(text)
}

fn page(all: &[Found]) -> Result<String> {
    let mut text = format!(
        "# Calibration: known materials found again

A block of gel, 30 × 20 × 8 mm, is pressed {DEPTH_MM} mm deep by a ball of 6 mm radius, down in {DOWN_S} s and up in as long; gels that relax are held
for {HOLD_S} s. The force, {SAMPLES} samples, is given noise of {} % of its largest value (seed {SEED}). `twintac calibrate` then starts from another
material. Derivatives are the solver's own, checked against differences of whole presses in `crates/softbody/tests/sensitivity.rs`.

`coverage` is how often the 95 % interval of the linearised model holds the truth in {REPETITIONS} repetitions of the noise.

{}",
        100.0 * NOISE,
        table(all)?
    );
    writeln!(
        text,
        "\n| material | steps | condition | residuals | warnings |\n|---|---|---|---|---|"
    )?;
    for found in all {
        writeln!(
            text,
            "| {} | {} | {:.1} | {:.2} % | {} |",
            found.case,
            found.iterations,
            found.condition,
            found.noise_percent,
            if found.warnings.is_empty() {
                "none".to_owned()
            } else {
                found.warnings.join("; ")
            }
        )?;
    }
    text.push_str("\n![Measured and fitted forces, and residuals](calibration.svg)\n");
    text.push_str(
        "\nMade by `cargo run --release -p twintac-verify -- calibration --out docs/verification`.\n",
    );
    Ok(text)
}

fn plot(all: &[Found]) -> twintac_report::Scene {
    let mut panels = Vec::new();
    for (index, found) in all.iter().enumerate() {
        let signal = &found.fit.signals[0];
        let points = |value: &dyn Fn(usize) -> f64| -> Vec<[f64; 2]> {
            (0..signal.time_s.len())
                .map(|row| [signal.time_s[row], value(row)])
                .collect()
        };
        let series = |name: &str, points: Vec<[f64; 2]>, ink: Ink, width_px: f64| Series {
            name: name.into(),
            points,
            ink,
            width_px,
            dashed: false,
        };
        let number = format!("case {}", index + 1);
        panels.push(Panel {
            name: number.clone(),
            y_label: "force (N)".into(),
            series: vec![
                series("measured", points(&|row| signal.measured[row]), Ink::Sensor, 3.0),
                series("fitted", points(&|row| signal.fitted[row]), Ink::Twin, 1.25),
            ],
            y_range: None,
        });
        panels.push(Panel {
            name: number,
            y_label: "residual (N)".into(),
            series: vec![series(
                "fitted less measured",
                points(&|row| signal.fitted[row] - signal.measured[row]),
                Ink::Series(0),
                1.0,
            )],
            y_range: None,
        });
    }
    Panels {
        title: "Known materials found again, in the table's order".into(),
        x_label: "time (s)".into(),
        panels,
        panel_height_px: 80.0,
        logarithmic: false,
    }
    .scene()
}
