//! External forces sum to zero.

use std::sync::Arc;

use anyhow::{Context, Result};
use glam::{DQuat, DVec3};
use twintac_sensor::Sensor;
use twintac_shape::Pose;
use twintac_simulate::{Gel, PressPlace, SimulateSettings};

use super::random_press::ENOUGH_N;
use crate::rung::{Effort, Figure, Outcome, Plot, plots};

/// The presses: an indenter of the sensor, location in mm, tilt in radians.
const PRESSES: [(&str, [f64; 2], f64); 3] = [
    ("sphere-25", [0.0, 0.0], 0.0),
    ("cylinder", [4.0, 2.0], 0.1),
    ("cube", [-7.0, -3.0], 0.2),
];

/// Depth as a fraction of the gel's height, and number of steps.
const DEPTH: f64 = 0.7;
const STEPS: u32 = 16;

/// The result of a press.
struct Pressed {
    /// Largest sum of the external forces, divided by the indenter's force.
    unbalanced: f64,
    /// Force of the indenter and of the shell at the end, N.
    force_n: f64,
    shell_n: f64,
    /// Depth in mm and magnitude of the force in N, for each step.
    indenter: Vec<[f64; 2]>,
    shell: Vec<[f64; 2]>,
    /// Why the press ended early, if it did.
    ended: Option<String>,
}

pub(super) fn run(effort: Effort) -> Result<Outcome> {
    let sensor =
        Arc::new(Sensor::read("sensors/phystac.toml").context("run this where the folder `sensors` is")?);
    let mut settings = SimulateSettings {
        max_nodes: effort.choose(1500, 7300),
        ..SimulateSettings::fine()
    };
    settings.solver.tolerance = 1e-8;
    let gel = Gel::new(sensor, settings);
    let mut figures = Vec::new();
    let mut series = Vec::new();
    let mut most_n: f64 = 0.0;
    let mut ended = String::new();
    for (color, (name, at_mm, tilt_rad)) in PRESSES.into_iter().enumerate() {
        let pressed = press(&gel, name, at_mm, tilt_rad)?;
        most_n = pressed
            .shell
            .iter()
            .fold(most_n, |most, [_, shell_n]| most.max(*shell_n));
        ended.extend(pressed.ended);
        figures.push(Figure::at_most(
            1e-6,
            format!("{name}: unbalanced over the indenter's force"),
            pressed.unbalanced,
            "",
        ));
        figures.push(Figure::told(
            format!("{name}: force at the end"),
            pressed.force_n,
            "N",
        ));
        figures.push(Figure::told(
            format!("{name}: of the shell, sideways and down"),
            pressed.shell_n,
            "N",
        ));
        series.push(plots::line(name, color, pressed.indenter));
        series.push(plots::dashes(format!("{name}, shell"), color, pressed.shell));
    }
    figures.push(Figure::at_least(
        0.1,
        "largest force of the shell in any press",
        most_n,
        "N",
    ));
    let labels = ["depth, mm", "force, N"];
    Ok(Outcome {
        done: format!(
            "The gel of the sensor `phystac`, with its shell, is pressed in {STEPS} steps to {} % of its \
             height, or to {ENOUGH_N} N, with a tolerance of 1e-8. The forces of the indenter, the board \
             and the shell on their nodes are summed. The figure is the largest residual of this sum in all \
             steps, relative to the indenter's force.{ended}",
            100.0 * DEPTH
        ),
        figures,
        plots: vec![Plot {
            name: "forces",
            caption: "Magnitudes of the forces of the indenter, and, dashed, of the shell.".into(),
            scene: plots::lines("Forces from outside", labels, false, series),
        }],
    })
}

/// Presses in [`STEPS`] steps, until the force is large enough or a step fails.
fn press(gel: &Gel, name: &str, at_mm: [f64; 2], tilt_rad: f64) -> Result<Pressed> {
    let sensor = gel.sensor();
    let shape = sensor
        .indenter(name)
        .with_context(|| format!("the sensor lacks the indenter {name}"))?
        .shape
        .clone();
    let rotation = DQuat::from_rotation_y(tilt_rad);
    let depth_mm = DEPTH * gel.height_mm();
    let place = PressPlace {
        indenter: name.into(),
        shape: shape.clone(),
        x_mm: at_mm[0],
        y_mm: at_mm[1],
        rotation,
        depth_mm,
        enough_force_n: None,
    };
    let mesh = gel.mesh(&place)?;
    let above = Pose {
        position_mm: DVec3::new(at_mm[0], at_mm[1], 0.0),
        rotation,
    };
    let touch = gel.touch(&shape, &above)?;
    let field = shape.signed_distance_field(&sensor.surfaces)?;
    let mut state = mesh.body().rest();
    let mut pressed = Pressed {
        unbalanced: 0.0,
        force_n: 0.0,
        shell_n: 0.0,
        indenter: vec![[0.0; 2]],
        shell: vec![[0.0; 2]],
        ended: None,
    };
    for step in 1..=STEPS {
        let depth_mm = depth_mm * f64::from(step) / f64::from(STEPS);
        let pose = Pose {
            position_mm: touch.position_mm - DVec3::Z * depth_mm,
            ..touch
        };
        let frame = match mesh.body().advance(&mut state, field.as_ref(), &pose, 0.0) {
            Ok(frame) => frame,
            Err(error) => {
                pressed.ended = Some(format!(
                    " The press of the {name} ended at {depth_mm:.2} mm: {error}."
                ));
                break;
            }
        };
        let sum = frame.indenter_force_n + frame.board_reaction_n + frame.obstacle_reaction_n;
        pressed.force_n = frame.indenter_force_n.length();
        pressed.shell_n = frame.obstacle_reaction_n.length();
        pressed.unbalanced = pressed.unbalanced.max(sum.length() / pressed.force_n);
        pressed.indenter.push([depth_mm, pressed.force_n]);
        pressed.shell.push([depth_mm, pressed.shell_n]);
        if pressed.force_n >= ENOUGH_N {
            break;
        }
    }
    Ok(pressed)
}
