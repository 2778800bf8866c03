//! The drivers against the emulated board, in virtual time: one fault after the other.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use embedded_hal::i2c::{ErrorKind, I2c, NoAcknowledgeSource};
use glam::DVec3;
use phystac::recovery::{free_bus, reset_switch};
use phystac::{Budget, Chip, Error, Frame, PhysTac, Settings, Transfer, Wired, Wiring};
use twintac_emulate::i2c::{BarometerSettings, Board, BoardSettings, Bus, PartSettings};
use twintac_emulate::robot::ArmSettings;
use twintac_emulate::{FaultKind, Hertz, LabClock, Moment, ScheduledFault, Workcell};
use twintac_rig::TcpPose;

const BAROMETER: u8 = 0x6D;
const SWITCH: u8 = 0x70;
const NACK: ErrorKind = ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address);

/// The ball, pressed in by `depth_mm`.
fn workcell(clock: &LabClock, depth_mm: f64) -> Workcell {
    let tool = TcpPose {
        position_mm: DVec3::new(200.0, 0.0, 100.0 - depth_mm),
        roll_pitch_yaw_rad: DVec3::new(std::f64::consts::PI, 0.0, 0.0),
    };
    Workcell::new(clock.clone(), Hertz::default(), tool, ArmSettings::default())
}

fn board(clock: &LabClock, settings: &BoardSettings, faults: &[ScheduledFault]) -> Board {
    Board::new(workcell(clock, 1.0), settings, faults).unwrap()
}

type Sensor = PhysTac<Bus, LabClock, Box<dyn Fn() -> u64>, 8>;

fn sensor(clock: &LabClock, board: &Board) -> Sensor {
    sensor_of(clock, board, Settings::default())
}

fn sensor_of(clock: &LabClock, board: &Board, settings: Settings<8>) -> Sensor {
    let now = clock.clone();
    PhysTac::new(
        board.bus(),
        clock.clone(),
        Box::new(move || now.now_us()),
        settings,
    )
}

/// A sensor whose bus has these faults.
fn faulty(faults: &[(FaultKind, Moment, Option<Moment>)]) -> (LabClock, Board, Sensor) {
    let faults: Vec<ScheduledFault> = faults
        .iter()
        .map(|(what, begins, lasts)| ScheduledFault {
            what: *what,
            begins: *begins,
            lasts: *lasts,
        })
        .collect();
    let clock = LabClock::virtual_time();
    let board = board(&clock, &BoardSettings::default(), &faults);
    let sensor = sensor(&clock, &board);
    (clock, board, sensor)
}

fn faults_of(frame: &Frame<8>) -> Vec<(usize, phystac::Fault)> {
    frame.faults().collect()
}

#[test]
fn frames_read_the_pressures_of_the_scene() {
    let clock = LabClock::virtual_time();
    let settings = BoardSettings {
        barometer: BarometerSettings {
            noise_pa: 0.0,
            ..BarometerSettings::default()
        },
        ..BoardSettings::default()
    };
    let board = board(&clock, &settings, &[]);
    let frame = sensor(&clock, &board).frame().unwrap();
    let truth_kpa = workcell(&clock, 1.0).now().sensed.taxel_pressures_kpa;
    assert!(
        truth_kpa[0] == 101.325 && truth_kpa[1] > 105.0,
        "some taxels are pressed: {truth_kpa:?}"
    );
    for (pressure_pa, truth_kpa) in frame.pressures_pa(&Transfer::per_pa(32)).iter().zip(truth_kpa) {
        assert!((f64::from(pressure_pa.unwrap()) - 1000.0 * truth_kpa).abs() < 0.02);
    }
    assert!(
        frame
            .taxels
            .iter()
            .all(|taxel| taxel.unwrap().temperature_c == 25.0)
    );
}

#[test]
fn a_frame_takes_as_long_as_its_clocks_and_its_conversions() {
    let (clock, board, mut sensor) = faulty(&[]);
    sensor.frame().unwrap();
    let begun_s = clock.now_s();
    for _ in 0..20 {
        sensor.frame().unwrap();
    }
    let budget = Budget::new(&Settings::<8>::default(), 400_000);
    let frame_s = (clock.now_s() - begun_s) / 20.0;
    let expected_s = f64::from(budget.frame_us()) * 1e-6;
    assert!(
        (frame_s - expected_s).abs() < 20e-6,
        "{frame_s} s, {expected_s} s"
    );
    let conversions_s: Vec<f64> = board.conversions_s();
    assert!(conversions_s.iter().all(|s| (5.2e-3..6.0e-3).contains(s)));
    assert!(
        conversions_s.windows(2).all(|pair| pair[0] != pair[1]),
        "parts differ"
    );
}

#[test]
fn the_same_seed_gives_the_same_frames_and_another_one_others() {
    let frames = |seed: u64| -> Vec<Frame<8>> {
        let clock = LabClock::virtual_time();
        let settings = BoardSettings {
            seed,
            ..BoardSettings::default()
        };
        let faults = [ScheduledFault {
            what: FaultKind::NoAcknowledge { channel: Some(4) },
            begins: Moment::Count(60),
            lasts: Some(Moment::TimeS(0.05)),
        }];
        let board = board(&clock, &settings, &faults);
        let mut sensor = sensor(&clock, &board);
        (0..20).map(|_| sensor.frame().unwrap()).collect()
    };
    let first = frames(1);
    assert_eq!(first, frames(1));
    assert_ne!(first, frames(2));
    assert!(first.iter().any(|frame| frame.faults().count() > 0));
}

#[test]
fn noise_is_as_loud_as_set_and_quieter_with_more_samples() {
    let deviation_pa = |samples: Option<u16>| {
        let wired = |channel| Wired {
            samples,
            ..Wired::on_channel(Chip::Cps135b, channel)
        };
        let settings = Settings {
            conversion_us: 10_000,
            ..Settings::new(Wiring::new(&[0, 1, 2, 3, 4, 5, 6, 7].map(wired)).unwrap())
        };
        let clock = LabClock::virtual_time();
        let board = board(&clock, &BoardSettings::default(), &[]);
        let mut sensor = sensor_of(&clock, &board, settings);
        let readings: Vec<f64> = (0..300)
            .map(|_| f64::from(sensor.frame().unwrap().pressures_pa(&Transfer::per_pa(32))[0].unwrap()))
            .collect();
        let mean = readings.iter().sum::<f64>() / 300.0;
        (readings.iter().map(|pa| (pa - mean).powi(2)).sum::<f64>() / 299.0).sqrt()
    };
    let (usual_pa, quiet_pa) = (deviation_pa(None), deviation_pa(Some(4096)));
    assert!((usual_pa - 15.0).abs() < 2.5, "{usual_pa}");
    assert!((quiet_pa - 7.5).abs() < 1.3, "{quiet_pa}");
}

#[test]
fn the_mask_counts_from_stop_on_and_the_last_byte_wins() {
    let clock = LabClock::virtual_time();
    let mut bus = board(&clock, &BoardSettings::default(), &[]).bus();
    let mut mask = [0xAA];
    bus.read(SWITCH, &mut mask).unwrap();
    assert_eq!(mask, [0], "after power-up");
    assert_eq!(bus.read(BAROMETER, &mut mask), Err(NACK));
    bus.write(SWITCH, &[0x01, 0x04]).unwrap();
    bus.write_read(SWITCH, &[0xFF], &mut mask).unwrap();
    assert_eq!(mask, [0x04], "before STOP it is the old one");
    bus.read(SWITCH, &mut mask).unwrap();
    assert_eq!(mask, [0xFF]);
    assert_eq!(bus.read(0x71, &mut mask), Err(NACK));
    let before_ns = clock.now_ns();
    bus.write(SWITCH, &[0]).unwrap();
    assert_eq!(clock.now_ns() - before_ns, 50_000, "20 clocks of 2.5 µs");
}

#[test]
fn registers_are_those_of_the_family() {
    let clock = LabClock::virtual_time();
    let mut bus = board(&clock, &BoardSettings::default(), &[]).bus();
    let mut byte = [0];
    bus.write(SWITCH, &[0x02]).unwrap();
    // A trigger sets the bit Sco, which clears itself. The sample is new until it is read.
    bus.write(BAROMETER, &[0x30, 0x0A]).unwrap();
    bus.write_read(BAROMETER, &[0x30], &mut byte).unwrap();
    assert_eq!(byte, [0x0A]);
    clock.wait_s(0.007);
    bus.write_read(BAROMETER, &[0x30], &mut byte).unwrap();
    assert_eq!(byte, [0x02]);
    let mut status_and_data = [0; 9];
    bus.write_read(BAROMETER, &[0x02], &mut status_and_data).unwrap();
    assert_eq!(status_and_data[0] & 1, 1);
    assert_eq!(
        u16::from_be_bytes([status_and_data[7], status_and_data[8]]),
        25 * 256
    );
    bus.write_read(BAROMETER, &[0x02], &mut byte).unwrap();
    assert_eq!(byte[0] & 1, 0);
    // Configuration registers can be written one after the other.
    bus.write(BAROMETER, &[0xA5, 0x11, 0x2D, 0x33]).unwrap();
    let mut configurations = [0; 3];
    bus.write_read(BAROMETER, &[0xA5], &mut configurations).unwrap();
    assert_eq!(configurations, [0x11, 0x2D, 0x33]);
    // Periodic conversions continue until they are stopped.
    bus.write(BAROMETER, &[0x30, 0x1B]).unwrap();
    for _ in 0..3 {
        clock.wait_s(0.075);
        bus.write_read(BAROMETER, &[0x02], &mut status_and_data).unwrap();
        assert_eq!(status_and_data[0] & 1, 1);
    }
    bus.write(BAROMETER, &[0x30, 0x00]).unwrap();
    clock.wait_s(0.2);
    bus.write_read(BAROMETER, &[0x02], &mut byte).unwrap();
    assert_eq!(byte[0] & 1, 0);
    // Burning the one-time memory makes the part useless.
    bus.write(BAROMETER, &[0x30, 0x0C]).unwrap();
    assert_eq!(bus.read(BAROMETER, &mut byte), Err(NACK));
}

#[test]
fn reads_with_several_channels_open_collide() {
    let clock = LabClock::virtual_time();
    let mut bus = board(&clock, &BoardSettings::default(), &[]).bus();
    bus.write(SWITCH, &[0xFF]).unwrap();
    bus.write(BAROMETER, &[0x30, 0x0A]).unwrap();
    clock.wait_s(0.01);
    let mut alone = [[0; 3]; 2];
    for (channel, data) in alone.iter_mut().enumerate() {
        bus.write(SWITCH, &[1 << channel]).unwrap();
        bus.write_read(BAROMETER, &[0x06], data).unwrap();
    }
    bus.write(SWITCH, &[0b11]).unwrap();
    let mut both = [0; 3];
    bus.write_read(BAROMETER, &[0x06], &mut both).unwrap();
    let [one, other] = alone;
    assert_eq!(both, std::array::from_fn(|index| one[index] & other[index]));
}

#[test]
fn a_missing_barometer_and_a_missing_switch_are_named() {
    let absent = |channel| FaultKind::NoAcknowledge { channel };
    let (_, _, mut sensor) = faulty(&[(absent(Some(5)), Moment::Count(0), None)]);
    assert_eq!(
        faults_of(&sensor.frame().unwrap()),
        [(5, phystac::Fault::Missing)]
    );
    let begins = Moment::TimeS(0.1);
    let (clock, _, mut sensor) = faulty(&[(absent(None), begins, Some(Moment::TimeS(0.1)))]);
    while clock.now_s() < 0.09 {
        assert_eq!(sensor.frame().unwrap().faults().count(), 0);
    }
    clock.wait_s(0.02);
    assert_eq!(sensor.frame(), Err(Error::SwitchMissing));
    clock.wait_s(0.1);
    assert_eq!(sensor.frame().unwrap().faults().count(), 0);
}

#[test]
fn a_board_with_four_barometers_is_one_with_four_missing() {
    let clock = LabClock::virtual_time();
    let settings = BoardSettings {
        parts: [0, 1, 2, 3]
            .map(|channel| PartSettings::on_channel("CPS135B", channel))
            .into(),
        ..BoardSettings::default()
    };
    let board = board(&clock, &settings, &[]);
    let frame = sensor(&clock, &board).frame().unwrap();
    let missing: Vec<usize> = frame.faults().map(|(taxel, _)| taxel).collect();
    assert_eq!(missing, [4, 5, 6, 7]);
}

#[test]
fn a_brown_out_of_the_switch_is_noticed_and_over_with_the_next_frame() {
    for count in 0..80 {
        let (_, _, mut sensor) = faulty(&[(FaultKind::SwitchBrownOut, Moment::Count(count), None)]);
        let outcomes: Vec<_> = (0..3).map(|_| sensor.frame()).collect();
        let is_fine = |outcome: &Result<Frame<8>, _>| {
            matches!(outcome, Err(Error::SwitchReset { .. }))
                || outcome.as_ref().is_ok_and(|frame| frame.faults().count() == 0)
        };
        assert!(outcomes.iter().all(is_fine), "{count}: {outcomes:?}");
        assert!(outcomes[2].is_ok(), "{count}: {outcomes:?}");
    }
}

#[test]
fn a_conversion_that_never_ends_is_stuck_until_it_does() {
    let lasts = Some(Moment::TimeS(0.2));
    let what = FaultKind::EndlessConversion { channel: 6 };
    let (clock, _, mut sensor) = faulty(&[(what, Moment::TimeS(0.05), lasts)]);
    let mut stuck = 0;
    while clock.now_s() < 0.4 {
        let faults = faults_of(&sensor.frame().unwrap());
        if faults == [(6, phystac::Fault::Stuck)] {
            stuck += 1;
            assert!((0.05..0.3).contains(&clock.now_s()));
        } else {
            assert_eq!(faults, []);
        }
    }
    assert!(stuck >= 10, "{stuck}");
}

#[test]
fn a_stretched_clock_is_only_late() {
    let by_s = 0.002;
    let what = FaultKind::ClockStretch { by_s };
    let (clock, _, mut sensor) = faulty(&[(what, Moment::TimeS(0.1), None)]);
    let frame_s = |sensor: &mut Sensor| {
        let begun_s = clock.now_s();
        assert_eq!(sensor.frame().unwrap().faults().count(), 0);
        clock.now_s() - begun_s
    };
    frame_s(&mut sensor);
    let usual_s = frame_s(&mut sensor);
    clock.wait_s(0.1);
    let late_s = frame_s(&mut sensor);
    // Open all channels, trigger, and for each taxel open, query and read: 26 transactions, some of
    // them during the wait for the conversion.
    assert!(
        (late_s - usual_s - 26.0 * by_s).abs() < 2.0 * by_s,
        "{late_s} s, {usual_s} s"
    );
}

#[test]
fn nine_clocks_free_a_bus_that_the_switch_holds() {
    let what = FaultKind::StuckBus { channel: None };
    let (_, board, mut sensor) = faulty(&[(what, Moment::Count(40), None)]);
    let hung = (0..9).find_map(|_| sensor.frame().err()).unwrap();
    assert!(
        matches!(
            hung,
            Error::BusHung {
                source: ErrorKind::Bus,
                ..
            }
        ),
        "{hung}"
    );
    assert!(matches!(sensor.frame(), Err(Error::BusHung { .. })));
    let (mut scl, mut sda) = board.lines();
    sensor
        .recover(|_, delay| free_bus(&mut scl, &mut sda, delay))
        .unwrap();
    assert_eq!(sensor.frame().unwrap().faults().count(), 0);
}

#[test]
fn a_barometer_that_holds_the_bus_gets_its_clocks_while_its_channel_is_open() {
    let what = FaultKind::StuckBus { channel: Some(3) };
    let (_, board, mut sensor) = faulty(&[(what, Moment::Count(40), None)]);
    let hung = (0..9).find_map(|_| sensor.frame().err()).unwrap();
    assert!(matches!(hung, Error::BusHung { .. }), "{hung}");
    let (mut scl, mut sda) = board.lines();
    sensor
        .recover(|_, delay| free_bus(&mut scl, &mut sda, delay))
        .unwrap();
    assert_eq!(sensor.frame().unwrap().faults().count(), 0);
}

#[test]
fn a_shorted_channel_is_isolated_after_resets() {
    let what = FaultKind::Short { channel: 2 };
    let (_, board, mut sensor) = faulty(&[(what, Moment::TimeS(0.1), None)]);
    let mut resets = 0;
    let frame = loop {
        match sensor.frame() {
            Ok(frame) if frame.faults().count() > 0 => break frame,
            Ok(_) => continue,
            Err(error) => assert!(matches!(error, Error::BusHung { .. }), "{error}"),
        }
        resets += 1;
        assert!(resets < 10);
        let mut reset = board.reset_line();
        sensor
            .recover(|_, delay| reset_switch(&mut reset, delay))
            .unwrap();
    };
    assert_eq!(faults_of(&frame), [(2, phystac::Fault::Isolated)]);
    assert_eq!(resets, 3);
}

#[test]
fn a_barometer_that_loses_power_has_no_sample_of_that_frame() {
    let what = FaultKind::BarometerBrownOut { channel: 7 };
    let (_, _, mut sensor) = faulty(&[(what, Moment::Count(60), None)]);
    let mut faults = Vec::new();
    for _ in 0..6 {
        faults.extend(faults_of(&sensor.frame().unwrap()));
    }
    assert_eq!(faults, [(7, phystac::Fault::Stuck)], "once");
}

#[test]
fn a_pressure_beyond_the_range_saturates() {
    let clock = LabClock::virtual_time();
    let settings = BoardSettings {
        barometer: BarometerSettings {
            counts_per_pa: 82.0, // up to 102.3 kPa
            ..BarometerSettings::default()
        },
        ..BoardSettings::default()
    };
    let board = board(&clock, &settings, &[]);
    let frame = sensor(&clock, &board).frame().unwrap();
    let transfer = Transfer {
        pa_per_count: 1.0 / 82.0,
        offset_pa: 0.0,
        signed: true,
    };
    let pressures_pa = frame.pressures_pa(&transfer);
    assert_eq!(pressures_pa[1], Err(phystac::Fault::Saturated));
    assert!(pressures_pa[0].is_ok_and(|pa| (pa - 101_325.0).abs() < 100.0));
}

/// A transaction takes at least its time on the emulator's clock, and that time passes by itself.
#[test]
fn real_time_is_paced() {
    let clock = LabClock::real();
    let board = board(&clock, &BoardSettings::default(), &[]);
    let mut bus = board.bus();
    let outside = std::time::Instant::now();
    let begun_ns = clock.now_ns();
    for turn in 1..=20 {
        bus.write(0x70, &[0xFF]).unwrap();
        // 20 clocks at 400 kHz.
        assert!(clock.now_ns() - begun_ns >= turn * 50_000);
    }
    assert!(outside.elapsed().as_nanos() >= 20 * 50_000);
}
