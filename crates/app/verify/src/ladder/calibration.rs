//! Known materials are recovered from noisy forces.

use std::fmt::Write as _;
use std::sync::Arc;

use anyhow::{Context, Result, ensure};
use glam::DQuat;
use rand::SeedableRng;
use rayon::prelude::*;
use twintac_calibrate::{Curve, Fit, FitSettings, FittedSignal, Parameter, Quantity, Signal, fit};
use twintac_depth_table::MonotoneCubic;
use twintac_material::{Material, Ogden, OgdenTerm, PronyTerm, Yeoh};
use twintac_plot::{Panel, Panels};
use twintac_random::{RandomStream, normal};
use twintac_sensor::Sensor;
use twintac_shape::Shape;
use twintac_simulate::{Gel, Keyframe, PressPlace, SimulateSettings};

use crate::rung::{Effort, Figure, Outcome, Plot, plots};

/// Largest accepted error, and largest accepted half width of a 95 % interval, %.
const LIMIT: f64 = 2.0;

/// Standard deviation of the noise of a force sample, relative to the largest force of its press.
const NOISE: f64 = 0.01;

/// Sample rate of the force, Hz.
const RATE_HZ: f64 = 1000.0;

/// Approximate number of simulated frames of a press in the fit, and number of frames of each leg
/// in the simulated measurement.
const FRAMES: usize = 120;
const LEG_FRAMES: u32 = 160;

/// Accepted penetration of nodes into an indenter, mm: its effect is far below the noise.
const PENETRATION_MM: f64 = 2e-4;

/// Seed of all noise.
const SEED: u64 = 1;

/// Number of windows in which residuals are averaged for the plot.
const WINDOWS: usize = 100;

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

/// A material that has to be recovered.
struct Case {
    name: &'static str,
    truth: Material,
    start: Material,
    /// Names and true values of the free constants.
    free: Vec<(&'static str, f64)>,
    presses: Vec<Press>,
}

/// A motion in legs of constant speed: duration of each leg, s, and depth at its end, mm.
struct Press {
    shape: Shape,
    legs: &'static [[f64; 2]],
}

const BALL: Shape = Shape::Sphere { radius_mm: 6.0 };

/// A ball that is wide compared with the block's height, so that the gel below it is confined.
const WIDE_BALL: Shape = Shape::Sphere { radius_mm: 40.0 };

pub(super) fn run(effort: Effort) -> Result<Outcome> {
    let mut cases = cases();
    cases.truncate(effort.choose(2, cases.len()));
    let mut done = format!(
        "A bonded block of gel, 30 × 20 × 8 mm, is pressed by balls as in a test setup. The force is \
         sampled {RATE_HZ} times a second, each sample with noise of {} % of the largest force of its press \
         (seed {SEED}). The fit starts from another material and simulates about {FRAMES} frames of a \
         press; the measurement is simulated with {LEG_FRAMES} frames for each of its legs. Half widths are \
         those of the 95 % intervals that the fit reports, which include the noise only. With so many \
         samples they are smaller than the effect of the different frames of fit and measurement on a \
         constant. Where the height of the surface is fitted, the meshes differ as well, because the fit \
         meshes for the reported depth. These effects cause errors of several half widths.\n\n| material | \
         unknown | true | start | found | 95 % interval |\n|---|---|---:|---:|---:|---|\n",
        100.0 * NOISE
    );
    let mut figures = Vec::new();
    let mut panels = Vec::new();
    let found = cases.par_iter().map(find).collect::<Result<Vec<_>>>()?;
    for (case, found) in cases.iter().zip(found) {
        for (unknown, (name, truth)) in found.unknowns.iter().zip(&case.free) {
            let [low, high] = unknown.interval_95;
            let _ = writeln!(
                done,
                "| {} | `{name}` | {truth:.5} | {:.5} | {:.5} | {low:.5} to {high:.5} |",
                case.name, unknown.start, unknown.value
            );
            let of = |what: &str| format!("{}, {name}: {what}", case.name);
            let error = 100.0 * (unknown.value / truth - 1.0);
            let half_width = 50.0 * (high - low) / truth.abs();
            figures.push(Figure::at_most(LIMIT, of("error"), error, "%"));
            figures.push(Figure::at_most(LIMIT, of("half width"), half_width, "%"));
            figures.push(Figure::told(of("error over half width"), error / half_width, ""));
        }
        let of = |what: &str| format!("{}: {what}", case.name);
        figures.push(Figure::told(of("samples"), found.n_samples as f64, ""));
        figures.push(Figure::told(of("residuals"), found.noise_percent, "%"));
        figures.push(Figure::told(of("condition"), found.condition, ""));
        panels.push(residuals(case.name, &found));
    }
    Ok(Outcome {
        done: done.trim_end().to_owned(),
        figures,
        plots: vec![Plot {
            name: "residuals",
            caption: "Each line shows means over hundredths of a press.".into(),
            scene: Panels {
                title: "Fitted minus measured force".into(),
                x_label: "fraction of the press (%)".into(),
                panels,
                panel_height_px: 80.0,
                logarithmic: false,
            }
            .scene(),
        }],
    })
}

/// Fitted minus measured force, % of the largest: means in [`WINDOWS`] parts of each press.
fn residuals(material: &str, found: &Fit) -> Panel {
    let line = |(index, signal): (usize, &FittedSignal)| {
        let largest = signal.measured.iter().copied().fold(0.0, f64::max);
        let size = signal.measured.len().div_ceil(WINDOWS);
        let pairs = signal.fitted.iter().zip(&signal.measured);
        let residuals: Vec<f64> = pairs.map(|(fitted, measured)| fitted - measured).collect();
        let mean = |window: &[f64]| 100.0 * window.iter().sum::<f64>() / (largest * window.len() as f64);
        let windows = residuals.chunks(size).enumerate();
        let points = windows.map(|(at, window)| [at as f64, mean(window)]).collect();
        plots::line(format!("press {}", index + 1), index, points)
    };
    Panel {
        y_label: "residual (% of force)".into(),
        name: material.to_owned(),
        series: found.signals.iter().enumerate().map(line).collect(),
        ..Panel::default()
    }
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
        model: Yeoh {
            c10_kpa,
            c20_kpa,
            c30_kpa: 0.0,
        }
        .into(),
        bulk_modulus_kpa: 30.0 * c10_kpa,
        prony: Vec::new(),
    };
    let ogden = |mu_kpa: f64, alpha: f64| Material {
        model: Ogden {
            terms: vec![OgdenTerm { mu_kpa, alpha }],
        }
        .into(),
        bulk_modulus_kpa: 300.0,
        prony: Vec::new(),
    };
    let ball = |legs| Press { shape: BALL, legs };
    let shear = ("shear_modulus_kpa", 20.0);
    vec![
        Case {
            name: "neo-Hookean, height",
            truth: neo_hookean(20.0, 0.47, &[]),
            start: neo_hookean(35.0, 0.47, &[]),
            free: vec![shear, ("depth_offset_mm", 0.2)],
            presses: vec![ball(&[[30.0, 4.0], [30.0, 0.0]])],
        },
        Case {
            name: "neo-Hookean, bulk",
            truth: neo_hookean(20.0, 0.45, &[]),
            start: neo_hookean(35.0, 0.40, &[]),
            free: vec![shear, ("bulk_modulus_kpa", 20.0 * 2.9 / 0.3)],
            presses: vec![
                ball(&[[15.0, 4.0], [15.0, 0.0]]),
                Press {
                    shape: WIDE_BALL,
                    legs: &[[15.0, 2.0], [15.0, 0.0]],
                },
            ],
        },
        Case {
            name: "Yeoh",
            truth: yeoh(10.0, 6.0),
            start: yeoh(16.0, 0.0),
            free: vec![("c10_kpa", 10.0), ("c20_kpa", 6.0)],
            presses: vec![ball(&[[10.0, 4.0], [10.0, 0.0]])],
        },
        Case {
            name: "Ogden",
            truth: ogden(9.0, 5.0),
            start: ogden(14.0, 3.0),
            free: vec![("terms[0].mu_kpa", 9.0), ("terms[0].alpha", 5.0)],
            presses: vec![ball(&[[10.0, 4.0], [10.0, 0.0]])],
        },
        Case {
            name: "one Prony term",
            truth: neo_hookean(20.0, 0.47, &[[0.3, 1.5]]),
            start: neo_hookean(30.0, 0.47, &[[0.1, 4.0]]),
            free: vec![shear, ("prony[0].weight", 0.3), ("prony[0].time_s", 1.5)],
            presses: vec![
                ball(&[[0.2, 3.0], [15.0, 3.0], [0.2, 0.0]]),
                ball(&[[10.0, 4.0], [10.0, 0.0]]),
            ],
        },
        Case {
            name: "two Prony terms",
            truth: neo_hookean(20.0, 0.47, &[[0.25, 0.4], [0.2, 5.0]]),
            start: neo_hookean(25.0, 0.47, &[[0.1, 0.2], [0.1, 10.0]]),
            free: vec![
                shear,
                ("prony[0].weight", 0.25),
                ("prony[0].time_s", 0.4),
                ("prony[1].weight", 0.2),
                ("prony[1].time_s", 5.0),
            ],
            presses: vec![
                ball(&[[0.1, 3.0], [40.0, 3.0], [0.1, 0.0]]),
                ball(&[[2.0, 4.0], [2.0, 0.0], [1.0, 0.0], [2.0, 4.0], [2.0, 0.0]]),
                ball(&[[20.0, 4.0], [20.0, 0.0]]),
            ],
        },
    ]
}

fn gel(material: &Material) -> Result<Gel> {
    let none = |path: &str| Err(std::io::Error::other(format!("{path} is not read here")));
    let mut settings = SimulateSettings {
        max_nodes: 1500,
        ..SimulateSettings::fine()
    };
    settings.solver.tolerance = 1e-6;
    // Steps of different lengths must not differ by their remaining penetration.
    settings.solver.penetration_mm = PENETRATION_MM;
    let sensor = Sensor::parse("block", BLOCK, &none)?;
    Ok(Gel::new(Arc::new(sensor), settings).with_material(material.clone()))
}

/// A simulated measurement on a bench that assumes the surface too low by `offset_mm`.
fn measure(gel: &Gel, press: &Press, offset_mm: f64, random: &mut RandomStream) -> Result<Curve> {
    let place = PressPlace {
        indenter: "ball".into(),
        shape: press.shape.clone(),
        x_mm: 1.0,
        y_mm: 0.5,
        rotation: DQuat::IDENTITY,
        depth_mm: press
            .legs
            .iter()
            .map(|[_, depth_mm]| *depth_mm)
            .fold(0.0, f64::max),
        enough_force_n: None,
    };
    // Frames are closer together at the start of a leg, where relaxation is fastest.
    let mut keyframes = vec![Keyframe {
        time_s: 0.0,
        depth_mm: 0.0,
    }];
    let mut ends = vec![0];
    for &[duration_s, depth_mm] in press.legs {
        let from = keyframes[keyframes.len() - 1];
        for frame in 1..=LEG_FRAMES {
            let part = f64::from(frame) / f64::from(LEG_FRAMES);
            let part = if depth_mm == from.depth_mm {
                part * part
            } else {
                part
            };
            keyframes.push(Keyframe {
                time_s: from.time_s + part * duration_s,
                depth_mm: from.depth_mm + part * (depth_mm - from.depth_mm),
            });
        }
        ends.push(keyframes.len() - 1);
    }
    let history = gel.press(&place, &keyframes)?;
    ensure!(history.failure.is_none(), "{:?}", history.failure);
    let force_n: Vec<f64> = history.frames.iter().map(|frame| frame.force_n).collect();
    let largest_n = force_n.iter().copied().fold(0.0, f64::max);
    let mut curve = Curve {
        name: "press".into(),
        shape: press.shape.clone(),
        friction: 0.0,
        x_mm: place.x_mm,
        y_mm: place.y_mm,
        rotation: place.rotation,
        time_s: Vec::new(),
        depth_mm: Vec::new(),
        signals: vec![Signal {
            quantity: Quantity::Force,
            values: Vec::new(),
        }],
    };
    for leg in ends.windows(2) {
        let leg = leg[0]..leg[1] + 1;
        let times_s: Vec<f64> = keyframes[leg.clone()].iter().map(|frame| frame.time_s).collect();
        let [from, to] = [leg.start, leg.end - 1].map(|frame| keyframes[frame]);
        let force =
            MonotoneCubic::new(times_s, force_n[leg].to_vec()).context("times of a leg do not increase")?;
        for sample in 1..=((to.time_s - from.time_s) * RATE_HZ).round() as u32 {
            let time_s = from.time_s + f64::from(sample) / RATE_HZ;
            let part = (time_s - from.time_s) / (to.time_s - from.time_s);
            curve.time_s.push(time_s);
            curve
                .depth_mm
                .push(from.depth_mm + part * (to.depth_mm - from.depth_mm) - offset_mm);
            curve.signals[0]
                .values
                .push(force.at(time_s) + NOISE * largest_n * normal(random, 1.0));
        }
    }
    Ok(curve)
}

fn find(case: &Case) -> Result<Fit> {
    let mut random = RandomStream::seed_from_u64(SEED);
    let offset_mm = case.free.iter().find(|(name, _)| *name == "depth_offset_mm");
    let offset_mm = offset_mm.map_or(0.0, |(_, truth)| *truth);
    let truth = gel(&case.truth)?;
    let curves = case
        .presses
        .iter()
        .map(|press| measure(&truth, press, offset_mm, &mut random))
        .collect::<Result<Vec<_>>>()?;
    let free: Vec<Parameter> = case.free.iter().map(|(name, _)| Parameter::named(name)).collect();
    let settings = FitSettings {
        most_frames: FRAMES,
        ..FitSettings::default()
    };
    let fit = fit(&gel(&case.start)?, &curves, &free, settings, &mut |_| ())?;
    ensure!(fit.converged, "{}: {:?}", case.name, fit.warnings);
    Ok(fit)
}
