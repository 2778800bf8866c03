//! From the emulated sensor to rows of text.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

mod common;

use std::io::{self, ErrorKind, Write};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use common::{checked, gone, phystac, reader, scale, sensor};
use embedded_hal::i2c::{self, I2c, Operation};
use glam::DVec3;
use phystac::{PhysTac, Settings, Transfer};
use twintac_emulate::i2c::{Board, BoardSettings};
use twintac_emulate::robot::ArmSettings;
use twintac_emulate::{Hertz, LabClock, ScheduledFault, Workcell};
use twintac_live::{Format, RowWriter, StopAfter, Taring, emulated_board, emulated_phystac, stream_rows};
use twintac_log::TaxelState;
use twintac_rig::TcpPose;
use twintac_source::{FrameReader, FrameSource, Known, SourceError, power_on};

/// A number of frames as text, read and written on one thread.
fn rows(format: Format, frames: usize, faults: &[ScheduledFault]) -> String {
    let (mut reader, about) = reader(faults);
    let mut out = Vec::new();
    let mut writer = RowWriter::new(&mut out, format, &about).unwrap();
    let (mut taring, mut tare) = (Taring::default(), None);
    for _ in 0..frames {
        let reading = reader.read().unwrap();
        tare = taring.push(&reading).or(tare);
        if let Some(tare) = &mut tare {
            writer.write(&reading, tare).unwrap();
        }
    }
    String::from_utf8(out).unwrap()
}

/// A column of a table in CSV.
fn column<'a>(csv: &'a str, name: &str) -> Vec<&'a str> {
    let mut lines = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let place = lines.next().unwrap().iter().position(|column| *column == name);
    lines.map(|line| line[place.unwrap()]).collect()
}

#[test]
fn what_is_pressed_rises_and_what_is_not_stays_and_it_repeats_bit_for_bit() {
    let csv = rows(Format::Csv, 400, &[]);
    assert_eq!(csv, rows(Format::Csv, 400, &[]));
    let header = csv.lines().next().unwrap();
    assert!(
        header.starts_with("seq,bench_s,provenance,t0_above_tare_kpa,"),
        "{header}"
    );
    assert!(
        header.ends_with(",t6_fault,t7_fault")
            && header.contains("t3_counts,")
            && header.contains("t3_temperature_c,")
    );
    assert!(column(&csv, "provenance").iter().all(|text| *text == "emulated"));
    assert!(column(&csv, "t3_fault").iter().all(|text| text.is_empty()));
    let sequence: Vec<usize> = column(&csv, "seq")
        .iter()
        .map(|text| text.parse().unwrap())
        .collect();
    assert!(
        sequence
            .iter()
            .enumerate()
            .all(|(index, number)| index + Taring::FRAMES - 1 == *number)
    );
    let times_s: Vec<f64> = column(&csv, "bench_s")
        .iter()
        .map(|text| text.parse().unwrap())
        .collect();
    assert!(times_s.is_sorted() && times_s[0] < 0.5);
    // The first press, from 1 s on, is on the right and moves up to t7, far from t0.
    let peak_kpa = |name: &str| {
        let values = column(&csv, name)
            .into_iter()
            .map(|text| text.parse::<f64>().unwrap());
        values.fold(0.0, f64::max)
    };
    assert!(peak_kpa("t7_above_tare_kpa") > 8.0);
    assert!(peak_kpa("t0_above_tare_kpa") < 0.1);
    let counts: i64 = column(&csv, "t0_counts")[0].parse().unwrap();
    assert!((counts - 8 * 101_325).abs() < 8 * 100, "{counts}");
}

#[test]
fn a_barometer_that_goes_is_named_and_the_others_stay() {
    let csv = rows(Format::Csv, 120, &[gone(2, 0.5)]);
    let faults = column(&csv, "t2_fault");
    assert_eq!((faults[0], *faults.last().unwrap()), ("", "missing"));
    assert_eq!(*column(&csv, "t2_above_tare_kpa").last().unwrap(), "");
    assert!(column(&csv, "t3_fault").iter().all(|text| text.is_empty()));

    let lines = rows(Format::JsonLines, 120, &[gone(2, 0.5)]);
    let last: serde_json::Value = serde_json::from_str(lines.lines().last().unwrap()).unwrap();
    assert_eq!(last["provenance"], "emulated");
    assert_eq!(last["taxels"][2]["fault"], "missing");
    assert!(last["taxels"][2]["above_tare_kpa"].is_null() && last["taxels"][2]["counts"].is_null());
    assert_eq!(last["taxels"][3]["name"], "t3");
    assert!(last["taxels"][3]["above_tare_kpa"].is_number());
}

#[test]
fn a_frozen_barometer_keeps_its_counts_and_has_no_pressure() {
    let clock = LabClock::virtual_time();
    let tool = TcpPose {
        position_mm: DVec3::new(0.0, 0.0, 200.0),
        roll_pitch_yaw_rad: DVec3::ZERO,
    };
    let workcell = Workcell::new(clock.clone(), Hertz::default(), tool, ArmSettings::default());
    let mut board = BoardSettings::default();
    board.barometer.noise_pa = 0.0; // without noise a part reads the same again and again, which no working part does
    let board = Board::new(workcell, &board, &[]).unwrap();
    let now = clock.clone();
    let phystac = PhysTac::new(board.bus(), clock, move || now.now_us(), Settings::<8>::default());
    let mut reader = FrameReader::new(phystac, &checked(Transfer::per_pa(32)));
    let last = (0..20)
        .map(|_| reader.read().unwrap().frame.taxels[5])
        .last()
        .unwrap();
    assert_eq!((last.state, last.pressure_pa), (TaxelState::Frozen, None));
    assert!(last.counts.is_some());
}

#[test]
fn who_does_not_take_frames_misses_them_and_the_numbers_say_which() {
    let (reader, _) = reader(&[]);
    let mut source = FrameSource::start(reader, 4).unwrap();
    while source.tally().missed < 100 {
        std::thread::sleep(Duration::from_millis(1));
    }
    let mut numbers = Vec::new();
    while numbers.last().is_none_or(|number| *number < 100) {
        numbers.extend(
            source
                .next(Duration::from_secs(5))
                .unwrap()
                .map(|reading| reading.sequence),
        );
    }
    assert_eq!(numbers[..4], [0, 1, 2, 3]);
    assert!(numbers.is_sorted() && numbers[4] > 100, "{numbers:?}");
    let tally = source.tally();
    assert!(tally.read >= tally.missed + 4 && tally.failed == 0, "{tally:?}");
}

#[test]
fn a_stream_ends_at_its_limits() {
    let run = |limits: StopAfter| {
        let (reader, about) = reader(&[]);
        let mut source = FrameSource::start(reader, 100_000).unwrap();
        let mut out = Vec::new();
        let streamed = stream_rows(&mut source, &about, Format::Csv, limits, &mut out, None).unwrap();
        (streamed, String::from_utf8(out).unwrap())
    };
    for frames in [0, 5, 200] {
        let (streamed, csv) = run(StopAfter {
            frames: Some(frames),
            ..StopAfter::default()
        });
        assert_eq!((streamed.rows, csv.lines().count() as u64), (frames, frames + 1));
    }
    let (streamed, _) = run(StopAfter {
        seconds: Some(1.5),
        ..StopAfter::default()
    });
    assert!((1.45..1.5).contains(&streamed.seconds), "{streamed:?}");
}

/// A pipe whose reader closes it after a number of bytes, or a disk that is full.
struct Ending(usize, ErrorKind, Arc<Mutex<usize>>);

impl Write for Ending {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut written = self.2.lock().unwrap();
        *written += bytes.len();
        if *written > self.0 {
            Err(self.1.into())
        } else {
            Ok(bytes.len())
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_pipe_whose_reader_goes_ends_quietly_and_a_full_disk_does_not() {
    for format in [Format::Csv, Format::JsonLines] {
        let run = |kind| {
            let (reader, about) = reader(&[]);
            let mut source = FrameSource::start(reader, 100_000).unwrap();
            stream_rows(
                &mut source,
                &about,
                format,
                StopAfter::default(),
                Ending(20_000, kind, Arc::default()),
                None,
            )
        };
        let streamed = run(ErrorKind::BrokenPipe).unwrap();
        assert!(streamed.rows > 10, "{streamed:?}");
        assert!(matches!(
            run(ErrorKind::StorageFull),
            Err(twintac_live::LiveError::Write(_))
        ));
    }
}

#[test]
fn no_scale_is_guessed() {
    let check = |known| power_on(&mut phystac(&[]), &sensor(), &known);
    let said = check(Known::default()).unwrap_err().to_string();
    assert!(
        said.contains("the readings in free air suggest 8 counts per Pa"),
        "{said}"
    );
    assert!(
        said.contains("`--scale 8`") && said.contains("`counts_per_pa = 8` under [readout]"),
        "{said}"
    );
    let said = check(scale(32)).unwrap_err().to_string();
    assert!(
        said.contains(
            "with 32 counts per Pa 0 of 8 taxels read free air: the readings in free air suggest 8"
        ),
        "{said}"
    );
    let confirmed = check(scale(8)).unwrap();
    assert_eq!(confirmed.notes, Vec::<String>::new());
    // The description's range, 1500 kPa, needs 24 bits.
    assert_eq!(
        confirmed.transfer,
        Some(Transfer {
            signed: false,
            ..Transfer::per_pa(8)
        })
    );

    let mut described = sensor();
    described.readout.counts_per_pa = Some(8);
    assert!(power_on(&mut phystac(&[]), &described, &Known::default()).is_ok());

    let one_gone = power_on(&mut phystac(&[gone(4, 0.0)]), &sensor(), &scale(8)).unwrap();
    assert_eq!(one_gone.notes, ["taxel t4: the barometer does not acknowledge"]);
}

#[test]
fn other_chips_need_nobody_to_confirm_a_scale_and_a_sensor_without_wiring_is_refused_by_name() {
    let strip = twintac_sensor::Sensor::read("../../../sensors/strip4-gel-a.toml").unwrap();
    let mut phystac = emulated_phystac(&strip, LabClock::virtual_time(), &[]).unwrap();
    let checked = power_on(&mut phystac, &strip, &Known::default()).unwrap();
    assert_eq!(checked.transfer, None);
    let frame = FrameReader::new(phystac, &checked).read().unwrap().frame;
    assert_eq!(frame.taxels.len(), 4);
    assert!(
        frame
            .taxels
            .iter()
            .all(|taxel| (taxel.pressure_pa.unwrap() - 101_325.0).abs() < 300.0),
        "{frame:?}"
    );

    let mut phystac = emulated_phystac(&strip, LabClock::virtual_time(), &[]).unwrap();
    let error = power_on(&mut phystac, &strip, &scale(8)).unwrap_err();
    assert!(matches!(error, SourceError::NothingToScale), "{error}");

    let mut unwired = strip;
    unwired.readout.chip = None;
    unwired.taxels.iter_mut().for_each(|taxel| taxel.channel = None);
    let error = emulated_phystac(&unwired, LabClock::virtual_time(), &[])
        .err()
        .unwrap();
    assert!(
        error
            .to_string()
            .starts_with("sensor strip4-gel-a: its description does not say how"),
        "{error}"
    );
}

/// A bus on which nothing answers.
struct Dead;

impl i2c::ErrorType for Dead {
    type Error = i2c::ErrorKind;
}

impl I2c for Dead {
    fn transaction(&mut self, _: u8, _: &mut [Operation<'_>]) -> Result<(), i2c::ErrorKind> {
        Err(i2c::ErrorKind::NoAcknowledge(i2c::NoAcknowledgeSource::Address))
    }
}

#[test]
fn a_sensor_that_stays_away_is_given_up_with_its_reason() {
    let clock = LabClock::virtual_time();
    let phystac = PhysTac::new(Dead, clock, || 0, Settings::<8>::default());
    let mut source = FrameSource::start(FrameReader::new(phystac, &checked(Transfer::per_pa(8))), 4).unwrap();
    let error = loop {
        match source.next(Duration::from_millis(100)) {
            Ok(reading) => assert_eq!(reading, None),
            Err(error) => break error,
        }
    };
    assert!(
        error.to_string().contains("the switch does not acknowledge"),
        "{error}"
    );
    assert_eq!(source.tally().failed, 40);
}

#[test]
fn a_high_place_is_free_air_where_it_is_said_to_be_high() {
    struct High;
    impl twintac_emulate::Physics for High {
        fn at(&mut self, _: &TcpPose, _: f64) -> twintac_emulate::Sensed {
            twintac_emulate::Sensed::untouched(65.0, 10.0)
        }
    }
    let power_on_at = |altitude_m| {
        let clock = LabClock::virtual_time();
        let nowhere = TcpPose {
            position_mm: DVec3::ZERO,
            roll_pitch_yaw_rad: DVec3::ZERO,
        };
        let workcell = Workcell::new(clock.clone(), High, nowhere, ArmSettings::default());
        let board = Board::new(workcell, &emulated_board(&sensor()), &[]).unwrap();
        let mut phystac = PhysTac::new(board.bus(), clock, || 0, Settings::<8>::default());
        let known = Known {
            altitude_m,
            ..scale(8)
        };
        power_on(&mut phystac, &sensor(), &known)
    };
    assert!(matches!(
        power_on_at(None),
        Err(SourceError::ScaleContradicted { n_free: 0, .. })
    ));
    assert_eq!(power_on_at(Some(3640.0)).unwrap().notes, Vec::<String>::new());
}

#[test]
fn a_described_transfer_is_used_as_it_is() {
    let mut described = sensor();
    let span = twintac_sensor::ConfirmedTransfer {
        pa_per_count: 3_750_000.0 / 8_388_608.0,
        offset_pa: -1_000_000.0,
        signed: false,
    };
    described.readout.transfer = Some(span);
    let mut phystac = emulated_phystac(&described, LabClock::virtual_time(), &[]).unwrap();
    let checked = power_on(&mut phystac, &described, &Known::default()).unwrap();
    assert_eq!(
        checked
            .transfer
            .map(|transfer| (transfer.offset_pa, transfer.signed)),
        Some((-1e6, false))
    );
    let frame = FrameReader::new(phystac, &checked).read().unwrap().frame;
    let pressures_pa = frame.taxels.iter().map(|taxel| taxel.pressure_pa.unwrap());
    for pressure_pa in pressures_pa {
        assert!((pressure_pa - 101_325.0).abs() < 200.0, "{pressure_pa}");
    }
}
