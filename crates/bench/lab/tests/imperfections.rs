//! Each imperfection of an emulator configuration on a small gel: its effect, and what a robot
//! would record of it.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests

use std::sync::Arc;

use glam::DQuat;
use twintac_emulate::Physics;
use twintac_lab::{EmulatorConfiguration, Lab};
use twintac_protocol::{LoadPlan, PressPlan};
use twintac_recording::Press;
use twintac_rig::TcpPose;
use twintac_sensor::Sensor;
use twintac_shape::{Pose, Solid, SurfaceFile};

const HEIGHT_MM: f64 = 6.0;
const RADIUS_MM: f64 = 8.0;
const SMOOTHNESS_MM: f64 = 1e-9;

/// A block with a taxel in its middle and another one beside it, and a ball.
fn sensor() -> Arc<Sensor> {
    let text = format!(
        r#"
name = "block"
summary = "a bonded block"
source = "a case of its own"
inferred = []
[gel.solid]
kind = "block"
size_mm = [20.0, 20.0, {HEIGHT_MM:?}]
[gel.material]
youngs_modulus_kpa = 70.0
poissons_ratio = 0.49
source = "chosen"
[readout]
min_kpa = 0.0
max_kpa = 1500.0
resolution_kpa = 1e-9
rate_hz = 50.0
[[taxels]]
name = "middle"
position_mm = [0.0, 0.0, 0.0]
port_radius_mm = 1.0
channel = 0
[[taxels]]
name = "beside"
position_mm = [4.0, 1.0, 0.0]
port_radius_mm = 1.0
channel = 1
[[indenters]]
name = "ball"
shape = {{ kind = "sphere", radius_mm = {RADIUS_MM:?} }}
"#
    );
    Arc::new(Sensor::parse("block", &text, &|_| Err(std::io::Error::other("no files"))).unwrap())
}

/// A bench without imperfections, with an elastic gel.
fn perfect() -> EmulatorConfiguration {
    let text = "
summary = 'perfect, elastic'
seed = 1
[gel]
edges_per_height = 4.0
edges_per_contact_radius = 4.0
yeoh_kpa = [12.0, 0.0, 0.0]
bulk_modulus_kpa = 600.0
relaxation = []
depth_step_mm = 0.15
[readout]
gain_deviation = 0.0
offset_deviation_kpa = 0.0
position_deviation_mm = 0.0
noise_kpa = 0.0
drift_kpa_per_sqrt_s = 0.0
lag_s = 0.0
lag_per_taxel_s = 0.0
jitter_s = 0.0
[robot]
place_deviation_mm = 0.0
depth_offset_mm = 0.0
depth_deviation_mm = 0.0
force_noise_n = 0.0
force_lag_s = 0.0
";
    EmulatorConfiguration::parse("perfect", text).unwrap()
}

fn lab(change: impl Fn(&mut EmulatorConfiguration)) -> Lab {
    let mut emulator = perfect();
    change(&mut emulator);
    Lab::new(sensor(), emulator).unwrap()
}

fn plan(x_mm: f64, y_mm: f64) -> PressPlan {
    PressPlan {
        name: "ball#0".into(),
        indenter: "ball".into(),
        x_mm,
        y_mm,
        rotation: DQuat::IDENTITY,
        clearance_mm: 0.3,
        depth_mm: 1.5,
        speed_mm_per_s: 2.0,
        hold_s: 0.3,
    }
}

fn press(change: impl Fn(&mut EmulatorConfiguration), x_mm: f64, y_mm: f64) -> Press {
    lab(change).press(&plan(x_mm, y_mm)).unwrap()
}

/// The recorded height at which the plan has zero depth, mm.
fn touch_mm(press: &Press) -> f64 {
    press.gel_from_indenter[0].position_mm.z - 0.3
}

fn force_n(press: &Press) -> &[f64] {
    press.force_n.as_deref().unwrap()
}

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, f64::max)
}

/// The area that a value encloses over depth. For the force over a whole press this is the work
/// that was lost.
fn enclosed(press: &Press, values: &[f64]) -> f64 {
    let height_mm = |i: usize| press.gel_from_indenter[i].position_mm.z;
    (1..values.len())
        .map(|i| 0.5 * (values[i] + values[i - 1]) * (height_mm(i - 1) - height_mm(i)))
        .sum()
}

#[test]
fn a_higher_gel_is_softer_and_is_touched_where_the_robot_was_set_up() {
    let [described, higher] = [1.0, 1.2].map(|ratio| press(|r| r.gel.height_ratio = ratio, 0.0, 0.0));
    for press in [&described, &higher] {
        assert!(
            (touch_mm(press) - HEIGHT_MM).abs() < SMOOTHNESS_MM,
            "{}",
            touch_mm(press)
        );
    }
    let [stiff_n, soft_n] = [&described, &higher].map(|press| largest(force_n(press).iter().copied()));
    assert!(soft_n < 0.95 * stiff_n, "{soft_n} {stiff_n}");

    // It is as soft as a gel that is described with this height.
    let mut tall = (*sensor()).clone();
    tall.gel.solid = Solid::Block {
        size_mm: [20.0, 20.0, 1.2 * HEIGHT_MM],
        center_mm: [0.0; 2],
        edge_radius_mm: 0.0,
    };
    let tall = Lab::new(Arc::new(tall), perfect())
        .unwrap()
        .press(&plan(0.0, 0.0))
        .unwrap();
    assert!((touch_mm(&tall) - 1.2 * HEIGHT_MM).abs() < SMOOTHNESS_MM);
    assert_eq!(tall.taxels_kpa, higher.taxels_kpa);
}

#[test]
fn a_ball_touches_a_tilted_sensor_where_its_plane_is() {
    let tilt_rad = 0.05;
    let tilted = |r: &mut EmulatorConfiguration| r.mounting.tilt_rad = [0.0, tilt_rad];
    let level = press(|_| (), 0.0, 0.0);
    for x_mm in [-4.0, 0.0, 4.0] {
        let found_mm = touch_mm(&press(tilted, x_mm, 0.0));
        // The centre of the ball is one radius away from a plane through (0, 0, height) that
        // descends along x.
        let center_mm = (RADIUS_MM - x_mm * tilt_rad.sin()) / tilt_rad.cos();
        let expected_mm = HEIGHT_MM + center_mm - RADIUS_MM;
        assert!(
            (found_mm - expected_mm).abs() < 1e-6,
            "{x_mm}: {found_mm} {expected_mm}"
        );
    }
    let tilted = press(tilted, 0.0, 0.0);
    for (recorded, planned) in tilted.gel_from_indenter.iter().zip(&level.gel_from_indenter) {
        assert_eq!(recorded.rotation, planned.rotation, "the recording does not know");
        assert_eq!(recorded.position_mm.truncate(), planned.position_mm.truncate());
    }
    // A ball above the middle meets the same gel. Only its depth into the gel differs: it is
    // cos(tilt) of its way.
    let force_n = [&level, &tilted].map(|press| largest(force_n(press).iter().copied()));
    println!("level {:.4} N, tilted {:.4} N", force_n[0], force_n[1]);
    assert!((force_n[1] / force_n[0] - 1.0).abs() < 0.02);
    let beside_kpa = [&level, &tilted].map(|press| largest(press.taxels_kpa.iter().map(|taxels| taxels[1])));
    assert!(
        (beside_kpa[1] / beside_kpa[0] - 1.0).abs() > 0.02,
        "{beside_kpa:?}"
    );
}

#[test]
fn friction_takes_work_and_changes_pressures() {
    // A gel with little friction slips, and loses more work than a gel with much friction, which
    // sticks.
    let [smooth, rough] = [0.0, 0.1].map(|friction| {
        let press = press(
            |r| {
                r.gel.friction = friction;
                r.gel.depth_step_mm = 0.05;
            },
            0.0,
            0.0,
        );
        let deepest = press.gel_from_indenter.len() / 2;
        let work_n_mm = |until: usize| enclosed(&press, &force_n(&press)[..until]);
        let lost = work_n_mm(2 * deepest) / work_n_mm(deepest);
        (lost, largest(press.taxels_kpa.iter().map(|taxels| taxels[0])))
    });
    println!("lost and largest pressure: without friction {smooth:.4?}, with friction {rough:.4?}");
    // The apparent loss of an elastic gel is the interpolation error between the computed moments.
    assert!(smooth.0.abs() < 0.006 && rough.0 - smooth.0 > 0.01);
    assert!(rough.1 > 1.05 * smooth.1);
}

#[test]
fn a_bubble_lowers_readings_by_its_law() {
    let [without, with] = [0.0, 2.0].map(|mm3| press(|r| r.readout.bubble_mm3 = mm3, 0.0, 0.0));
    let (atmosphere_kpa, shear_modulus_kpa) = (101.325, 24.0);
    for (gel, air) in without
        .taxels_kpa
        .iter()
        .flatten()
        .zip(with.taxels_kpa.iter().flatten())
    {
        let bubble_kpa = 1.5 * shear_modulus_kpa * 2.0;
        let expected_kpa = air + bubble_kpa * air / (atmosphere_kpa + air);
        assert!((gel - expected_kpa).abs() < 1e-6, "{gel} {air}");
    }
}

#[test]
fn the_wires_feel_what_is_recorded_at_once() {
    for friction in [0.0, 0.15] {
        let lab = lab(|r| {
            r.gel.friction = friction;
            r.gel.depth_step_mm = 0.03;
            r.mounting.tilt_rad = [0.03, -0.04];
            r.gel.height_ratio = 1.2;
            r.readout.bubble_mm3 = 1.0;
        });
        let plan = plan(2.0, -1.0);
        let at_once = lab.press(&plan).unwrap();
        let (mut gel, selector) = lab.live(&[lab.live_table(&plan).unwrap()], Pose::IDENTITY, Pose::IDENTITY);
        assert!(selector.select(&plan.name));
        let at_once_kpa: Vec<f64> = at_once.taxels_kpa.iter().map(|taxels| taxels[0]).collect();
        let felt = at_once.gel_from_indenter.iter().zip(&at_once.time_s);
        let (felt_n, felt_kpa): (Vec<f64>, Vec<f64>) = felt
            .map(|(pose, time_s)| {
                let felt = gel.at(&TcpPose::new(pose.position_mm, pose.rotation), *time_s);
                (-felt.wrench.force_n.z, felt.taxel_pressures_kpa[0] - 101.325)
            })
            .unzip();
        // The meshes differ: the mesh for the devices is made for a larger depth than planned.
        for (at_once, felt) in [(force_n(&at_once), &felt_n), (&at_once_kpa, &felt_kpa)] {
            let differences = at_once
                .iter()
                .zip(felt)
                .map(|(at_once, felt)| (at_once - felt).abs());
            let part = largest(differences) / largest(at_once.iter().copied());
            println!("friction {friction}: {part:.4}");
            assert!(part < 0.04, "{part}");
        }
        let loops = [&at_once_kpa, &felt_kpa].map(|kpa| enclosed(&at_once, kpa));
        println!("friction {friction}: loops {loops:.4?} kPa mm");
        if friction > 0.0 {
            assert!(
                loops[0] > 0.0 && (loops[1] / loops[0] - 1.0).abs() < 0.3,
                "{loops:?}"
            );
        }
    }
}

#[test]
fn a_weight_on_a_rough_gel_comes_off_on_another_way() {
    let load = LoadPlan {
        name: "weight-ball#0".into(),
        indenter: "ball".into(),
        x_mm: 0.0,
        y_mm: 0.0,
        force_n: 2.0,
        rest_s: 0.2,
        hold_s: 0.5,
    };
    let [smooth, rough] = [0.0, 0.15].map(|friction| lab(|r| r.gel.friction = friction).load(&load).unwrap());
    let most_kpa = |press: &Press| largest(press.taxels_kpa.iter().map(|taxels| taxels[0]));
    assert!(most_kpa(&smooth) > 1.0 && (most_kpa(&rough) / most_kpa(&smooth) - 1.0).abs() > 1e-3);
    for press in [&smooth, &rough] {
        assert!(
            press.taxels_kpa.last().unwrap()[0].abs() < 0.05 * most_kpa(press),
            "all is off again"
        );
    }
}

#[test]
fn a_gel_from_a_file_keeps_its_height() {
    let mut from_file = (*sensor()).clone();
    from_file.gel.solid = Solid::Stl(SurfaceFile::new("gel.stl"));
    let mut emulator = perfect();
    emulator.gel.height_ratio = 1.2;
    let Err(error) = Lab::new(Arc::new(from_file), emulator) else {
        panic!("a surface cannot be stretched");
    };
    assert!(error.to_string().contains("height_ratio"), "{error}");
}
