//! The whole range of the sensor, from the pressure at the chips to the reading. Readings beyond
//! the range are flagged, and none wraps around.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

mod common;

use common::sensor;
use glam::DVec3;
use phystac::PhysTac;
use twintac_emulate::i2c::{Board, BoardSettings, Bus};
use twintac_emulate::robot::ArmSettings;
use twintac_emulate::{LabClock, Physics, Sensed, Workcell};
use twintac_live::emulated_board;
use twintac_log::TaxelState;
use twintac_rig::TcpPose;
use twintac_source::{BoxedClock, FrameReader, Known, TAXELS, driver_settings, power_on};

const AIR_KPA: f64 = 101.325;
/// Time of a step, s: five frames, so that no value counts as frozen.
const STEP_S: f64 = 0.05;
const STEP_KPA: f64 = 10.0;
/// Time in free air before the steps, s.
const FREE_S: f64 = 0.2;
const BEYOND_KPA: f64 = 2400.0;

/// Pressure steps from a vacuum to beyond all ranges. The channels differ within a step.
struct Stairs;

impl Stairs {
    fn pressure_kpa(channel: usize, time_s: f64) -> f64 {
        let steps = ((time_s - FREE_S) / STEP_S).floor();
        if steps < 0.0 {
            AIR_KPA
        } else {
            STEP_KPA * steps + channel as f64
        }
    }
}

impl Physics for Stairs {
    fn at(&mut self, _: &TcpPose, time_s: f64) -> Sensed {
        Sensed {
            taxel_pressures_kpa: std::array::from_fn(|channel| Self::pressure_kpa(channel, time_s)),
            ..Sensed::untouched(AIR_KPA, 25.0)
        }
    }
}

/// The reader of a board of noiseless parts with these pressures, after power-up.
fn reader(board: &BoardSettings) -> FrameReader<Bus, LabClock, BoxedClock, TAXELS> {
    let clock = LabClock::virtual_time();
    let nowhere = TcpPose {
        position_mm: DVec3::ZERO,
        roll_pitch_yaw_rad: DVec3::ZERO,
    };
    let workcell = Workcell::new(clock.clone(), Stairs, nowhere, ArmSettings::default());
    let mut board = board.clone();
    board.barometer.noise_pa = 0.0;
    let known = Known {
        counts_per_pa: Some(board.barometer.counts_per_pa as u16),
        ..Known::default()
    };
    let board = Board::new(workcell, &board, &[]).unwrap();
    let now = clock.clone();
    let now: BoxedClock = Box::new(move || now.now_us());
    let mut phystac = PhysTac::new(board.bus(), clock, now, driver_settings(&sensor()).unwrap());
    let checked = power_on(&mut phystac, &sensor(), &known).unwrap();
    FrameReader::new(phystac, &checked)
}

/// Applies all steps. Checks that every reading within the range is right to half a count, and that
/// every reading beyond it is flagged. Returns the number of each.
fn climb(board: &BoardSettings, range_kpa: [f64; 2]) -> [usize; 2] {
    let mut reader = reader(board);
    let (mut n_good, mut n_saturated) = (0, 0);
    loop {
        let reading = reader.read().unwrap();
        let step = |time_s: f64| ((time_s - FREE_S) / STEP_S).floor();
        let ends_s = reading
            .frame
            .taxels
            .iter()
            .map(|taxel| 1e-6 * taxel.read_us as f64);
        let end_s = ends_s.fold(reading.bench_s, f64::max);
        // Two milliseconds margin, because the workcell interpolates linearly between its own
        // steps.
        if reading.bench_s < FREE_S || step(reading.bench_s - 2e-3) != step(end_s + 2e-3) {
            continue;
        }
        if Stairs::pressure_kpa(0, reading.bench_s) > BEYOND_KPA {
            return [n_good, n_saturated];
        }
        for (channel, taxel) in reading.frame.taxels.iter().enumerate() {
            let truth_kpa = Stairs::pressure_kpa(channel, reading.bench_s);
            if (range_kpa[0]..=range_kpa[1]).contains(&truth_kpa) {
                let half_a_count_kpa = 0.5e-3 / board.barometer.counts_per_pa;
                let read_kpa = 1e-3 * taxel.pressure_pa.unwrap();
                assert!(
                    (read_kpa - truth_kpa).abs() <= half_a_count_kpa,
                    "{read_kpa} of {truth_kpa} kPa"
                );
                assert_eq!(taxel.state, TaxelState::Good);
                n_good += 1;
            } else {
                assert_eq!(
                    (taxel.state, taxel.pressure_pa),
                    (TaxelState::Saturated, None),
                    "{truth_kpa} kPa"
                );
                assert!(taxel.counts.is_some());
                n_saturated += 1;
            }
        }
    }
}

fn board(counts_per_pa: f64, is_signed: bool) -> BoardSettings {
    let mut board = emulated_board(&sensor());
    board.barometer.counts_per_pa = counts_per_pa;
    board.barometer.is_signed = is_signed;
    board
}

#[test]
fn parts_that_reach_the_described_range_read_all_of_it_and_flag_the_rest() {
    for board in [emulated_board(&sensor()), board(8.0, false), board(4.0, true)] {
        let [n_good, n_saturated] = climb(&board, [50.0, 1500.0]);
        assert!(n_good > 3000 && n_saturated > 1500, "{n_good}, {n_saturated}");
    }
}

#[test]
fn parts_of_a_smaller_range_flag_where_theirs_ends() {
    for (counts_per_pa, ends_kpa) in [(16.0, 524.28), (32.0, 262.14)] {
        let [n_good, n_saturated] = climb(&board(counts_per_pa, true), [50.0, ends_kpa]);
        assert!(n_good > 500 && n_saturated > 3000, "{n_good}, {n_saturated}");
    }
}
