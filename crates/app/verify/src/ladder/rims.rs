//! Shapes with rims on real-time meshes, against finer meshes.

use std::ops::ControlFlow;
use std::sync::Arc;

use anyhow::{Context, Result};
use glam::DVec3;
use twintac_protocol::{PressPath, Waypoint, Zero};
use twintac_sensor::Sensor;
use twintac_shape::Shape;
use twintac_simulate::{FollowedFrame, Gel, SimulateSettings};

use crate::rung::{Effort, Figure, Outcome, Plot, plots};

/// Location of the presses, mm: off the middle, where gel meets the shell's wall.
const PLACE_MM: [f64; 2] = [9.0, 3.0];
const DEEPEST_MM: f64 = 2.0;
/// Number of frames on the way down.
const N_FRAMES: usize = 20;
/// Depths at which forces and pressures are compared, mm.
const DEPTHS_MM: [f64; 3] = [0.5, 1.0, 2.0];
/// Nodes of a path's mesh without rims. The meshes with fine rims have about 7,000 and 90,000.
const PATH_NODES: [usize; 2] = [4_600, 80_000];
/// Edges of the finer mesh: over the gel's height, over the contact's radius, and over the radius
/// of a rim.
const FINER_EDGES: [f64; 3] = [12.0, 17.0, 3.0];

/// The shapes that are pressed.
fn shapes() -> [(&'static str, Shape); 5] {
    let (edge_radius_mm, height_mm) = (0.3, 10.0);
    let block = |x_mm, y_mm| Shape::Box {
        size_mm: [x_mm, y_mm, height_mm],
        edge_radius_mm,
    };
    [
        ("box", block(10.0, 8.0)),
        ("bar", block(3.0, 12.0)),
        (
            "punch",
            Shape::Cylinder {
                radius_mm: 5.0,
                height_mm,
                edge_radius_mm,
            },
        ),
        (
            "ring",
            Shape::Ring {
                outer_radius_mm: 5.0,
                inner_radius_mm: 3.0,
                height_mm,
                edge_radius_mm,
            },
        ),
        (
            "plate",
            Shape::Box {
                size_mm: [10.0, 8.0, 1.0],
                edge_radius_mm,
            },
        ),
    ]
}

/// The frames of a press on the real-time or the finer mesh, and the number of nodes.
fn press(sensor: &Arc<Sensor>, shape: &Shape, finer: bool) -> Result<(Vec<FollowedFrame>, usize)> {
    let fine = SimulateSettings::fine();
    let settings = if finer {
        SimulateSettings {
            edges_per_height: FINER_EDGES[0],
            edges_per_contact_radius: FINER_EDGES[1],
            edges_per_rounding: FINER_EDGES[2],
            max_path_nodes: PATH_NODES[1],
            ..fine
        }
    } else {
        SimulateSettings {
            max_path_nodes: PATH_NODES[0],
            ..fine
        }
    };
    let at = |time_s: f64, z_mm: f64| Waypoint {
        time_s,
        position_mm: DVec3::new(PLACE_MM[0], PLACE_MM[1], z_mm),
        turn_rad: DVec3::ZERO,
        force_n: None,
    };
    let path = PressPath {
        summary: String::new(),
        indenter: "body".into(),
        zero: Zero::Touch,
        rate_hz: Some(N_FRAMES as f64),
        poses: vec![at(0.0, 0.0), at(1.0, -DEEPEST_MM)],
        force_direction: DVec3::NEG_Z,
        force_travel_mm: None,
        points: Vec::new(),
    };
    let gel = Gel::new(Arc::clone(sensor), settings);
    let followed = gel.follow(shape, &path, &mut || ControlFlow::Continue(()))?;
    Ok((followed.frames, followed.n_nodes))
}

/// The frame at a depth.
fn frame_at(frames: &[FollowedFrame], depth_mm: f64) -> Option<&FollowedFrame> {
    frames
        .iter()
        .find(|frame| (frame.depth_mm - depth_mm).abs() < 1e-6)
}

pub(super) fn run(effort: Effort) -> Result<Outcome> {
    let sensor = Sensor::read("sensors/phystac.toml").context("run this where the folder `sensors` is")?;
    let sensor = Arc::new(sensor);
    let shapes = shapes();
    let shapes = &shapes[..effort.choose(1, shapes.len())];
    let (mut figures, mut series) = (Vec::new(), Vec::new());
    let mut n_nodes = [0; 2];
    for (color, (name, shape)) in shapes.iter().enumerate() {
        let (frames, n_coarse) = press(&sensor, shape, false)?;
        let (finer, n_fine) = press(&sensor, shape, true)?;
        n_nodes = [n_coarse, n_fine];
        for depth_mm in DEPTHS_MM {
            let found = frame_at(&frames, depth_mm).zip(frame_at(&finer, depth_mm));
            let force_percent = found.map(|(frame, finer)| 100.0 * (frame.force_n.z / finer.force_n.z - 1.0));
            let pressure_percent = found.map(|(frame, finer)| {
                let largest_kpa = finer.pressure_kpa.values().copied().fold(0.0, f64::max);
                let ports = frame.pressure_kpa.iter();
                let differences = ports.map(|(port, kpa)| (kpa - finer.pressure_kpa[port]).abs());
                100.0 * differences.fold(0.0, f64::max) / largest_kpa
            });
            let figure = |limit, what: &str, value: Option<f64>| {
                let name = format!("{name}, {depth_mm} mm: {what}");
                Figure::at_most(limit, name, value.unwrap_or(f64::NAN), "%")
            };
            figures.push(figure(3.0, "force", force_percent));
            figures.push(figure(
                5.0,
                "pressure at the ports, of the largest",
                pressure_percent,
            ));
        }
        let curve = |frames: &[FollowedFrame]| {
            let points = frames.iter().map(|frame| [frame.depth_mm, -frame.force_n.z]);
            points.collect()
        };
        series.push(plots::line(*name, color, curve(&frames)));
        series.push(plots::dashes(format!("{name}, finer"), color, curve(&finer)));
    }
    let scene = plots::lines(
        "Force of shapes with rims",
        ["depth, mm", "force, N"],
        false,
        series,
    );
    Ok(Outcome {
        done: format!(
            "Bodies with rims of 0.3 mm are pressed at ({}, {}) mm in {N_FRAMES} frames to {DEEPEST_MM} mm, \
             without friction: once on a mesh of {} nodes, as it is pressed in real time, and once on a \
             mesh of {} nodes. The finer mesh is not exact either. Contact and meshes have constants that were \
             chosen on these very presses, so that the figures say how well they fit, not how well other \
             shapes, places and depths are met.\n",
            PLACE_MM[0], PLACE_MM[1], n_nodes[0], n_nodes[1]
        ),
        figures,
        plots: vec![Plot {
            name: "force",
            caption: "Force over depth on both meshes.".into(),
            scene,
        }],
    })
}
