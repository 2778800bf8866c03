//! Shapes with rims on real-time meshes, against finer meshes.

use std::f64::consts::FRAC_PI_2;
use std::ops::ControlFlow;
use std::sync::Arc;

use anyhow::{Context, Result};
use glam::DVec3;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use twintac_protocol::{PressPath, Waypoint, Zero};
use twintac_sensor::Sensor;
use twintac_shape::Shape;
use twintac_simulate::{FollowedFrame, Gel, SimulateSettings};
use twintac_softbody::{Element, SolverSettings};

use crate::rung::{Effort, Figure, Outcome, Plot, plots};

/// Location of the named presses, mm: off the middle, where gel meets the shell's wall.
const PLACE_MM: [f64; 2] = [9.0, 3.0];
const DEEPEST_MM: f64 = 2.0;
/// Number of frames on the way down.
const N_FRAMES: usize = 20;
/// Depths at which forces and pressures are compared, mm.
const DEPTHS_MM: [f64; 3] = [0.5, 1.0, 2.0];
/// Number and seed of the drawn presses. No constant of the program was chosen on them.
const N_DRAWN: u64 = 10;
const SEED: u64 = 12;
/// Largest distance of a drawn press from the middle, as a fraction of the gel's half sides.
const REACH: f64 = 0.6;
/// Limits of force and pressure, %.
const LIMITS: [f64; 2] = [3.0, 5.0];
/// Nodes of a path's mesh without rims. With fine rims, it has about 7,000.
const PATH_NODES: usize = 4_600;

/// A mesh of the reference: edges over the gel's height, over the contact's radius and over the
/// radius of a rim, and the largest number of nodes without rims.
struct Finer([f64; 3], usize);

/// The meshes of the reference, from the finest to one with half as many nodes. On one mesh, forces
/// jump by a few percent where the gel's nodes pass a rim one after the other, which is not seen in
/// the mean.
const REFERENCE: [Finer; 3] = [
    Finer([10.0, 11.0, 2.5], 30_000),
    Finer([9.2, 10.0, 2.25], 22_000),
    Finer([8.5, 9.0, 2.0], 15_000),
];

/// A press: its name, shape, location and angle about the vertical.
struct RimPress {
    name: String,
    shape: Shape,
    place_mm: [f64; 2],
    yaw_rad: f64,
}

/// Five shapes at one place.
fn named() -> Vec<RimPress> {
    let (edge_radius_mm, height_mm) = (0.3, 10.0);
    let block = |size_mm| Shape::Box {
        size_mm,
        edge_radius_mm,
    };
    let punch = Shape::Cylinder {
        radius_mm: 5.0,
        height_mm,
        edge_radius_mm,
    };
    let ring = Shape::Ring {
        outer_radius_mm: 5.0,
        inner_radius_mm: 3.0,
        height_mm,
        edge_radius_mm,
    };
    let shapes = [
        ("box", block([10.0, 8.0, height_mm])),
        ("bar", block([3.0, 12.0, height_mm])),
        ("punch", punch),
        ("ring", ring),
        ("plate", block([10.0, 8.0, 1.0])),
    ];
    shapes
        .map(|(name, shape)| RimPress {
            name: name.to_owned(),
            shape,
            place_mm: PLACE_MM,
            yaw_rad: 0.0,
        })
        .into()
}

/// The drawn press of an index: the same kinds of shapes in other sizes, anywhere on the gel.
fn drawn(sensor: &Sensor, index: u64) -> RimPress {
    let mut random = ChaCha8Rng::seed_from_u64(SEED);
    random.set_stream(index);
    let mut between = |low: f64, high: f64| random.random_range(low..high);
    let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
    let place_mm = [REACH * between(low.x, high.x), REACH * between(low.y, high.y)];
    let (yaw_rad, edge_radius_mm, height_mm) = (between(0.0, FRAC_PI_2), between(0.25, 0.5), 10.0);
    let block = |size_mm| Shape::Box {
        size_mm,
        edge_radius_mm,
    };
    let shape = match index % 5 {
        0 => block([between(5.0, 11.0), between(5.0, 11.0), height_mm]),
        1 => block([between(2.0, 4.0), between(7.0, 13.0), height_mm]),
        2 => Shape::Cylinder {
            radius_mm: between(2.5, 5.5),
            height_mm,
            edge_radius_mm,
        },
        3 => {
            let outer_radius_mm = between(4.0, 6.0);
            Shape::Ring {
                outer_radius_mm,
                inner_radius_mm: outer_radius_mm - between(1.5, 2.5),
                height_mm,
                edge_radius_mm,
            }
        }
        _ => block([between(5.0, 11.0), between(5.0, 11.0), between(1.0, 1.5)]),
    };
    RimPress {
        name: format!("drawn press {index}"),
        shape,
        place_mm,
        yaw_rad,
    }
}

/// The frames of a press on the real-time mesh or a mesh of the reference, and the number of nodes.
fn follow(
    sensor: &Arc<Sensor>,
    press: &RimPress,
    finer: Option<&Finer>,
) -> Result<(Vec<FollowedFrame>, usize)> {
    let fine = SimulateSettings::fine();
    let settings = match finer {
        Some(Finer([height, contact_radius, rounding], max_path_nodes)) => SimulateSettings {
            edges_per_height: *height,
            edges_per_contact_radius: *contact_radius,
            edges_per_rounding: *rounding,
            max_path_nodes: *max_path_nodes,
            solver: SolverSettings {
                element: Element::Blended,
                ..fine.solver
            },
            ..fine
        },
        None => SimulateSettings {
            max_path_nodes: PATH_NODES,
            ..fine
        },
    };
    let [x_mm, y_mm] = press.place_mm;
    let at = |time_s: f64, z_mm: f64| Waypoint {
        time_s,
        position_mm: DVec3::new(x_mm, y_mm, z_mm),
        turn_rad: DVec3::Z * press.yaw_rad,
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
    let followed = gel.follow(&press.shape, &path, &mut || ControlFlow::Continue(()))?;
    Ok((followed.frames, followed.n_nodes))
}

/// Force and pressures at the ports at a depth.
struct Reading {
    force_n: f64,
    pressure_kpa: Vec<f64>,
}

/// The readings at each depth; `None` if one was not reached.
fn readings(frames: &[FollowedFrame]) -> [Option<Reading>; 3] {
    DEPTHS_MM.map(|depth_mm| {
        let is_there = |frame: &&FollowedFrame| (frame.depth_mm - depth_mm).abs() < 1e-6;
        frames.iter().find(is_there).map(|frame| Reading {
            force_n: frame.force_n.z,
            pressure_kpa: frame.pressure_kpa.values().copied().collect(),
        })
    })
}

/// The mean of readings on several meshes at each depth.
fn mean(meshes: &[[Option<Reading>; 3]]) -> [Option<Reading>; 3] {
    std::array::from_fn(|depth| {
        let all: Option<Vec<&Reading>> = meshes.iter().map(|mesh| mesh[depth].as_ref()).collect();
        let all = all?;
        let mean = |value: &dyn Fn(&Reading) -> f64| {
            all.iter().map(|reading| value(reading)).sum::<f64>() / all.len() as f64
        };
        let n_ports = all.first()?.pressure_kpa.len();
        Some(Reading {
            force_n: mean(&|reading| reading.force_n),
            pressure_kpa: (0..n_ports)
                .map(|port| mean(&|reading| reading.pressure_kpa[port]))
                .collect(),
        })
    })
}

/// Differences in force, and in pressure at the ports relative to the largest, at each depth, %;
/// NaN where a depth was not reached.
fn differences(found: &[Option<Reading>; 3], reference: &[Option<Reading>; 3]) -> [[f64; 2]; 3] {
    std::array::from_fn(|depth| {
        let found = found[depth].as_ref().zip(reference[depth].as_ref());
        found.map_or([f64::NAN; 2], |(found, reference)| {
            let largest_kpa = reference.pressure_kpa.iter().copied().fold(0.0, f64::max);
            let ports = found.pressure_kpa.iter().zip(&reference.pressure_kpa);
            let differences = ports.map(|(found, reference)| (found - reference).abs());
            [
                100.0 * (found.force_n / reference.force_n - 1.0),
                100.0 * differences.fold(0.0, f64::max) / largest_kpa,
            ]
        })
    })
}

const QUANTITIES: [&str; 2] = ["force", "pressure at the ports, of the largest"];

/// The differences of several presses, for each depth and quantity, %.
struct Sizes(Vec<[[f64; 2]; 3]>);

impl Sizes {
    fn sorted(&self, depth: usize, quantity: usize) -> Vec<f64> {
        let mut sizes: Vec<f64> = self.0.iter().map(|press| press[depth][quantity].abs()).collect();
        sizes.sort_by(f64::total_cmp);
        sizes
    }

    /// The largest difference; NaN, where a depth was not reached, is larger than all numbers.
    fn worst(&self, depth: usize, quantity: usize) -> f64 {
        *self.sorted(depth, quantity).last().unwrap_or(&f64::NAN)
    }

    fn median(&self, depth: usize, quantity: usize) -> f64 {
        let sizes = self.sorted(depth, quantity);
        sizes[sizes.len() / 2]
    }
}

/// Calls `each` for each depth and quantity with their indices, a name and the limit.
fn for_each_figure(mut each: impl FnMut(usize, usize, String, f64)) {
    for (depth, depth_mm) in DEPTHS_MM.iter().enumerate() {
        for (quantity, (what, limit)) in QUANTITIES.iter().zip(LIMITS).enumerate() {
            each(depth, quantity, format!("{depth_mm} mm: {what}"), limit);
        }
    }
}

pub(super) fn run(effort: Effort) -> Result<Outcome> {
    let sensor = Sensor::read("sensors/phystac.toml").context("run this where the folder `sensors` is")?;
    let sensor = Arc::new(sensor);
    let named = named();
    let (mut figures, mut series) = (Vec::new(), Vec::new());
    let (mut n_nodes, mut of_meshes) = (Vec::new(), Sizes(Vec::new()));
    let mut compare = |press: &RimPress| -> Result<_> {
        let follow = |finer| follow(&sensor, press, finer).with_context(|| press.name.clone());
        let (frames, n_coarse) = follow(None)?;
        n_nodes = vec![n_coarse];
        let (mut meshes, mut finest) = (Vec::new(), None);
        for finer in &REFERENCE {
            let (frames, n_fine) = follow(Some(finer))?;
            n_nodes.push(n_fine);
            meshes.push(readings(&frames));
            finest = finest.or(Some(frames));
        }
        let reference = mean(&meshes);
        let of_mesh = meshes.iter().map(|mesh| differences(mesh, &reference));
        of_meshes.0.extend(of_mesh);
        Ok((
            differences(&readings(&frames), &reference),
            frames,
            finest.unwrap_or_default(),
        ))
    };
    for (color, press) in named[..effort.choose(1, named.len())].iter().enumerate() {
        let (differences, frames, finest) = compare(press)?;
        for_each_figure(|depth, quantity, name, limit| {
            let name = format!("{}, {name}", press.name);
            figures.push(Figure::at_most(limit, name, differences[depth][quantity], "%"));
        });
        let curve = |frames: &[FollowedFrame]| {
            let points = frames.iter().map(|frame| [frame.depth_mm, -frame.force_n.z]);
            points.collect()
        };
        series.push(plots::line(&press.name, color, curve(&frames)));
        let label = format!("{}, finest mesh", press.name);
        series.push(plots::dashes(label, color, curve(&finest)));
    }
    if effort == Effort::Full {
        let mut of_drawn = Sizes(Vec::new());
        for index in 0..N_DRAWN {
            of_drawn.0.push(compare(&drawn(&sensor, index))?.0);
        }
        for_each_figure(|depth, quantity, name, limit| {
            let figure = |which: &str| format!("{N_DRAWN} drawn presses, {name}, {which}");
            let median = of_drawn.median(depth, quantity);
            figures.push(Figure::told(figure("the median"), median, "%"));
            let worst = of_drawn.worst(depth, quantity);
            figures.push(Figure::at_most(limit, figure("the worst"), worst, "%"));
        });
    }
    for_each_figure(|depth, quantity, name, _| {
        for (which, size) in [
            ("the median", of_meshes.median(depth, quantity)),
            ("the worst", of_meshes.worst(depth, quantity)),
        ] {
            let name = format!("a mesh of the reference from their mean, {name}, {which}");
            figures.push(Figure::told(name, size, "%"));
        }
    });
    let scene = plots::lines(
        "Force of shapes with rims",
        ["depth, mm", "force, N"],
        false,
        series,
    );
    Ok(Outcome {
        done: format!(
            "Bodies with rims of 0.3 mm are pressed at ({}, {}) mm in {N_FRAMES} frames to {DEEPEST_MM} mm, \
             without friction: on a mesh of {} nodes, as it is pressed in real time, and on three meshes of {}, \
             {} and {} nodes. The reference is the mean of these three. How far each of them is from it shows \
             how large its own error may be. Contact and meshes have constants that were chosen on \
             these very presses. Another {N_DRAWN} presses are drawn (seed \
             {SEED}): the same kinds of shapes in other sizes, with rims of 0.25 to 0.5 mm, turned by any \
             angle, anywhere within {REACH} of the gel's half sides. No constant was chosen on them.\n",
            PLACE_MM[0], PLACE_MM[1], n_nodes[0], n_nodes[1], n_nodes[2], n_nodes[3]
        ),
        figures,
        plots: vec![Plot {
            name: "force",
            caption: "Force over depth on the real-time mesh and on the finest of the reference.".into(),
            scene,
        }],
    })
}
