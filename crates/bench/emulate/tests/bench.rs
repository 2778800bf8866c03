//! All emulated devices together, on one clock.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use std::time::Duration;

use phystac::{PhysTac, Transfer};
use twintac_emulate::{EmulateError, EmulatedBench, EmulatedBenchSettings, Hertz, LabClock};
use twintac_rig::netft;
use twintac_rig::xarm::Client;
use twintac_rig::{BenchClock, NetFtSource, WrenchSource};

/// A wait that is longer than any delay of a busy machine.
const LATEST: Duration = Duration::from_secs(60);

fn force_client(bench: &EmulatedBench) -> netft::Client {
    let configuration = bench.force.with_sensor(|sensor| sensor.configuration().clone());
    let mut client = netft::Client::connect(bench.force.requests(), configuration).unwrap();
    client.set_patience(LATEST);
    client
}

fn sensor(
    clock: &LabClock,
    bench: &EmulatedBench,
) -> PhysTac<impl embedded_hal::i2c::I2c, LabClock, impl phystac::Clock, 8> {
    let now = clock.clone();
    PhysTac::new(
        bench.board.bus(),
        clock.clone(),
        move || now.now_us(),
        phystac::Settings::default(),
    )
}

#[test]
fn a_press_shows_on_all_wires() {
    let clock = LabClock::virtual_time();
    let mut settings = EmulatedBenchSettings::default();
    settings.robot.first_pose.position_mm.z = 101.0;
    let bench = EmulatedBench::start(clock.clone(), Hertz::default(), &settings).unwrap();
    let mut sensor = sensor(&clock, &bench);
    let mut robot = Client::connect(bench.robot.commands()).unwrap();
    robot.set_answer_within(LATEST);
    robot.enable().unwrap();
    let mut pose = robot.begin_servo().unwrap();
    for _ in 0..60 {
        pose.position_mm.z -= 0.05;
        robot.servo(&pose).unwrap();
    }
    robot.state().unwrap(); // it has heard the poses
    clock.wait_s(0.5);
    let depth_mm = 100.0 - robot.pose().unwrap().position_mm.z;
    assert!((depth_mm - 2.0).abs() < 0.01, "{depth_mm}");

    let hertz = Hertz::default();
    let mut client = force_client(&bench);
    client.start(false).unwrap();
    clock.wait_s(0.21); // 210 records, which all fit into the client's socket
    let mut source = NetFtSource::new(client, BenchClock::start());
    let mean_n = (0..200)
        .map(|_| source.next_sample(LATEST).unwrap().unwrap().wrench.force_n.z)
        .sum::<f64>()
        / 200.0;
    assert!((mean_n + hertz.force_n(depth_mm)).abs() < 0.03, "{mean_n} N");

    let pressures_pa = sensor.frame().unwrap().pressures_pa(&Transfer::per_pa(32));
    for (pressure_pa, taxel_mm) in pressures_pa.iter().zip(&hertz.taxels_mm) {
        let distance_mm = (taxel_mm - pose.position_mm).truncate().length();
        let expected_kpa = hertz.air_kpa + hertz.pressure_kpa(depth_mm, distance_mm);
        let kpa = 1e-3 * f64::from(pressure_pa.unwrap());
        assert!((kpa - expected_kpa).abs() < 0.1, "{kpa} kPa, {expected_kpa} kPa");
    }
}

#[test]
fn in_virtual_time_the_wires_wait_for_whoever_moves_the_clock() {
    let clock = LabClock::virtual_time();
    let bench =
        EmulatedBench::start(clock.clone(), Hertz::default(), &EmulatedBenchSettings::default()).unwrap();
    let mut client = force_client(&bench);
    client.start(false).unwrap();
    let mut sensor = sensor(&clock, &bench);
    while clock.now_s() < 0.1 {
        sensor.frame().unwrap();
    }
    let expected = (clock.now_s() * 1000.0) as usize;
    let mut received = 0;
    while received < expected {
        let records = client.receive(LATEST).unwrap();
        assert!(!records.is_empty(), "{received} of {expected}");
        received += records.len();
    }
    assert_eq!(client.receive(Duration::from_millis(20)).unwrap(), []);
}

#[test]
fn settings_are_files_that_people_write() {
    let text = r#"
[board]
parts = [{ chip = "CPS135B", switch = 0x70, channel = 3 }, { chip = "BMP390", address = 0x77 }]
barometer = { counts_per_pa = 8.0, is_signed = false }

[robot]
ports = [0, 0, 0, 0]
arm = { lag_s = 0.05 }

[force]
rate_hz = 500.0

[[faults]]
what = { robot_error = { code = 31 } }
begins = { time_s = 12.5 }

[[faults]]
what = "lost_datagrams"
begins = { count = 1000 }
lasts = { count = 20 }
"#;
    let settings: EmulatedBenchSettings = toml::from_str(text).unwrap();
    assert_eq!(settings.faults.len(), 2);
    let again: EmulatedBenchSettings = toml::from_str(&toml::to_string(&settings).unwrap()).unwrap();
    assert_eq!(settings, again);
    assert!(toml::from_str::<EmulatedBenchSettings>("[board]\nbus = 1").is_err());

    let mut wrong = settings.clone();
    wrong.faults[1].lasts = Some(twintac_emulate::Moment::TimeS(-1.0));
    let error = EmulatedBench::start(LabClock::virtual_time(), Hertz::default(), &wrong).unwrap_err();
    assert!(matches!(error, EmulateError::Setting { .. }));
    assert_eq!(
        error.to_string(),
        "`faults[1].lasts` expected a time not below zero"
    );
}
