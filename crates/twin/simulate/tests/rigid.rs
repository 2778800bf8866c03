//! Rigid parts in and around a gel: chips that are bonded to it, and a shell that stops both gel
//! and indenter.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests

use std::ops::ControlFlow::Continue;
use std::sync::Arc;

use glam::{DQuat, DVec3};
use twintac_protocol::PressPath;
use twintac_sensor::Sensor;
use twintac_shape::Pose;
use twintac_simulate::{Followed, Gel, PressPlace, SimulateSettings};
use twintac_softbody::{Blocker, SolveError};

/// A sensor with a block of this height, and with further TOML tables.
fn sensor(height_mm: f64, more: &str) -> Arc<Sensor> {
    let text = format!(
        r#"
name = "block"
summary = "a bonded block"
source = "a case of its own"
inferred = []
[gel.solid]
kind = "block"
size_mm = [20.0, 20.0, {height_mm:?}]
[gel.material]
youngs_modulus_kpa = 70.0
poissons_ratio = 0.49
source = "chosen"
[readout]
min_kpa = 0.0
max_kpa = 1500.0
resolution_kpa = 0.01
rate_hz = 55.0
[[taxels]]
name = "aside"
position_mm = [8.5, 8.5, 0.0]
port_radius_mm = 0.5
channel = 0
[[indenters]]
name = "ball"
shape = {{ kind = "sphere", radius_mm = 3.0 }}
[[indenters]]
name = "plate"
shape = {{ kind = "cylinder", radius_mm = 7.0, height_mm = 10.0, edge_radius_mm = 1.0 }}
[[indenters]]
name = "rough-ball"
shape = {{ kind = "sphere", radius_mm = 3.0 }}
friction = 0.5
{more}
"#
    );
    Arc::new(Sensor::parse("block", &text, &|_| Err(std::io::Error::other("no files"))).unwrap())
}

const CHIP: &str = r#"
[[inclusions]]
name = "chip"
min_mm = [-7.0, -7.0, 0.0]
max_mm = [7.0, 7.0, 3.0]
"#;

const SHELL: &str = "[shell]\ngap_mm = 0.2\nheight_mm = 8.0\n";

fn gel(sensor: Arc<Sensor>, tolerance: f64) -> Gel {
    let mut settings = SimulateSettings {
        max_nodes: 3000,
        ..SimulateSettings::fine()
    };
    settings.solver.tolerance = tolerance;
    Gel::new(sensor, settings)
}

fn place(gel: &Gel, indenter: &str, x_mm: f64, depth_mm: f64) -> PressPlace {
    let found = gel.sensor().indenter(indenter);
    PressPlace {
        indenter: indenter.into(),
        shape: found.unwrap().shape.clone(),
        x_mm,
        y_mm: 0.0,
        rotation: DQuat::IDENTITY,
        depth_mm,
        enough_force_n: None,
    }
}

fn follow(gel: &Gel, path: &str) -> Followed {
    let path = PressPath::parse("path", path).unwrap();
    gel.follow(&place(gel, &path.indenter, 0.0, 0.0).shape, &path, &mut || {
        Continue(())
    })
    .unwrap()
}

#[test]
fn above_a_wide_chip_the_gel_is_as_stiff_as_a_thinner_one() {
    let force_n = |sensor: Arc<Sensor>| {
        let gel = gel(sensor, 1e-4);
        let table = gel.depth_table(&place(&gel, "ball", 0.0, 1.0)).unwrap();
        assert_eq!(table.failure, None);
        table.frames.last().unwrap().force_n
    };
    let [chip, thin, thick] = [sensor(7.0, CHIP), sensor(4.0, ""), sensor(7.0, "")].map(force_n);
    println!("over a chip {chip:.4} N, 4 mm of gel {thin:.4} N, 7 mm of gel {thick:.4} N");
    assert!((chip / thin - 1.0).abs() < 0.02 && thin / thick > 1.15);
}

#[test]
fn the_gel_holds_on_to_a_chip_and_the_chip_stops_the_indenter() {
    let gel = gel(sensor(7.0, CHIP), 1e-8);
    let place = place(&gel, "ball", 6.0, 2.0);
    let mesh = gel.mesh(&place).unwrap();
    let (body, touch) = (
        mesh.body(),
        gel.touch(&place.shape, &Pose::from_position(DVec3::X * 6.0))
            .unwrap(),
    );
    let ball = place.shape.signed_distance_field(&gel.sensor().surfaces).unwrap();
    let at = |depth_mm: f64| Pose::from_position(touch.position_mm - DVec3::Z * depth_mm);
    let mut state = body.rest();
    for depth_mm in [0.7, 1.4, 2.0] {
        let frame = body
            .advance(&mut state, ball.as_ref(), &at(depth_mm), 0.0)
            .unwrap();
        let sum = frame.indenter_force_n + frame.board_reaction_n;
        assert!(sum.length() < 1e-6 * frame.indenter_force_n.length(), "{sum}");
    }
    let nodes = body.mesh().nodes_mm.iter().zip(state.displacements_mm());
    let on_chip = |at: &DVec3| at.truncate().abs().max_element() <= 7.0 + 1e-9 && at.z <= 3.0 + 1e-9;
    let bonded: Vec<_> = nodes.filter(|(at, _)| on_chip(at) && at.z > 0.0).collect();
    assert!(bonded.len() > 50);
    assert!(bonded.iter().all(|(_, moved)| **moved == DVec3::ZERO));
    let error = body
        .advance(&mut state, ball.as_ref(), &at(4.1), 0.0)
        .unwrap_err();
    println!("{error}");
    assert!(matches!(
        error,
        SolveError::Blocked {
            by: Blocker::Bonded,
            ..
        }
    ));
}

#[test]
fn an_indenter_over_the_shells_edge_is_blocked() {
    let gel = gel(sensor(8.0, SHELL), 1e-4);
    // The centre of the rim's circle of 0.5 mm is at x = 10.7 mm, z = 7.5 mm. The ball touches it
    // where its own centre is 3.5 mm from there.
    let x_mm = 8.5;
    let place = place(&gel, "ball", x_mm, 2.0);
    let table = gel.depth_table(&place).unwrap();
    let failure = table.failure.clone().unwrap();
    println!("{failure}");
    assert!(failure.contains("blocked") && failure.contains("an obstacle"));
    let stop_mm = 8.0 + 3.0 - (7.5 + (3.5_f64.powi(2) - (10.7 - x_mm).powi(2)).sqrt());
    let next_mm = gel.depths(&place)[table.frames.len()].depth_mm;
    println!(
        "stops at {stop_mm:.3} mm, between {:.3} and {next_mm:.3} mm",
        table.depth_mm()
    );
    assert!(table.depth_mm() < stop_mm + 0.05 && next_mm > stop_mm);
}

#[test]
fn a_gel_that_fills_its_shell_pushes_against_the_walls() {
    let gel = gel(sensor(8.0, SHELL), 1e-8);
    let place = place(&gel, "plate", 1.0, 2.4);
    let mesh = gel.mesh(&place).unwrap();
    let body = mesh.body();
    let plate = place.shape.signed_distance_field(&gel.sensor().surfaces).unwrap();
    let mut state = body.rest();
    let mut walls_n = 0.0;
    for depth_mm in [0.4, 0.8, 1.2, 1.6, 2.0, 2.4] {
        let pose = Pose::from_position(DVec3::new(1.0, 0.0, 8.0 - depth_mm));
        let frame = body.advance(&mut state, plate.as_ref(), &pose, 0.0).unwrap();
        let sum = frame.indenter_force_n + frame.board_reaction_n + frame.obstacle_reaction_n;
        println!(
            "{depth_mm} mm: {:.3} N down, walls {:.3}, sum {:.1e}, {} iterations",
            -frame.indenter_force_n.z,
            frame.obstacle_reaction_n,
            sum.length(),
            frame.iterations
        );
        assert!(sum.length() < 1e-6 * frame.indenter_force_n.length());
        assert!(frame.penetration_mm <= 0.005);
        walls_n = frame.obstacle_reaction_n.x.abs();
    }
    assert!(walls_n > 0.1, "{walls_n}");
}

#[test]
fn bounded_penetration_hardly_changes_the_force() {
    let forces = [0.005, 0.0005].map(|penetration_mm| {
        let mut settings = SimulateSettings {
            max_nodes: 3000,
            ..SimulateSettings::fine()
        };
        settings.solver.penetration_mm = penetration_mm;
        let gel = Gel::new(sensor(8.0, SHELL), settings);
        let table = gel.depth_table(&place(&gel, "ball", 0.0, 2.0)).unwrap();
        table
            .frames
            .iter()
            .map(|frame| (frame.depth_mm, frame.force_n))
            .collect::<Vec<_>>()
    });
    for ((depth_mm, usual_n), (_, exact_n)) in forces[0].iter().zip(&forces[1]).skip(1) {
        let change = usual_n / exact_n - 1.0;
        println!("{depth_mm:.3} mm: {usual_n:.4} N, {:+.3} %", 100.0 * change);
        // The depth is at most 0.005 mm less, and the force rises with about the power 1.5 of
        // depth.
        assert!(change.abs() < 2.0 * 0.005 / depth_mm);
    }
}

#[test]
fn a_path_presses_with_a_force_and_tells_the_depth() {
    let gel = gel(sensor(8.0, ""), 1e-4);
    let path = r#"
summary = "2 N for a second"
indenter = "ball"
zero = "touch"
rate_hz = 4.0
poses = [
  { time_s = 0.0, position_mm = [0.0, 0.0, 0.5] },
  { time_s = 0.5, position_mm = [0.0, 0.0, 0.0], force_n = 0.5 },
  { time_s = 1.5, position_mm = [0.0, 0.0, 0.0], force_n = 0.5 },
  { time_s = 2.0, position_mm = [0.0, 0.0, 0.5] },
]
"#;
    let followed = follow(&gel, path);
    assert_eq!(followed.failure, None);
    let found: Vec<[f64; 2]> = followed
        .frames
        .iter()
        .map(|f| [-f.force_n.z, f.depth_mm])
        .collect();
    println!("{found:.4?}");
    let wanted_n = [0.0, 0.25, 0.5, 0.5, 0.5, 0.5, 0.5];
    for (found, wanted_n) in found.iter().zip(wanted_n) {
        assert!((found[0] - wanted_n).abs() <= 1e-3 * wanted_n);
    }
    let held_mm = found[2][1];
    // The indenter moves up at constant speed from where the force had brought it.
    assert!((found[7][1] - (0.5 * held_mm - 0.25)).abs() < 0.01 * held_mm);
    assert!(found[8][0] == 0.0 && (found[8][1] + 0.5).abs() < 1e-9);
    let driven = format!(
        "summary = ''\nindenter = 'ball'\nzero = 'touch'\nposes = [{{ time_s = 0.0, position_mm = [0.0, 0.0, {}] }}]",
        -held_mm
    );
    let driven_n = -follow(&gel, &driven).frames[0].force_n.z;
    assert!((driven_n / 0.5 - 1.0).abs() < 0.01, "{driven_n}");

    let rough = follow(&gel, &path.replace("\"ball\"", "\"rough-ball\""));
    let change = rough.frames[4].depth_mm / held_mm - 1.0;
    println!("friction changes the depth by {:+.2} %", 100.0 * change);
    assert!(change < -1e-4, "friction stiffens the press");

    let far = path
        .replace("force_n = 0.5", "force_n = 50.0")
        .replace("rate_hz", "force_travel_mm = 1.0\nrate_hz");
    let out_of_reach = follow(&gel, &far);
    let failure = out_of_reach.failure.unwrap();
    println!("{failure}");
    assert!(failure.contains("is not reached within 1 mm"));
}
