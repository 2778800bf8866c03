//! The dashboard's picture, on a test terminal.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

mod common;

use common::{gone, reader};
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::Buffer;
use ratatui::style::Color;
use twintac_emulate::ScheduledFault;
use twintac_live::TouchRecording;
use twintac_live::dashboard::{DashboardState, RecordingStatus, draw};
use twintac_log::{Body, Event, LogReader};

/// The state after a number of frames.
fn state(frames: usize, faults: &[ScheduledFault]) -> DashboardState {
    let (mut reader, about) = reader(faults);
    let mut state = DashboardState::new(about).unwrap();
    for _ in 0..frames {
        state.push(reader.read().unwrap());
        state.refresh().unwrap();
    }
    state
}

fn picture(state: &DashboardState, columns: u16, lines: u16) -> (String, Buffer) {
    let mut terminal = Terminal::new(TestBackend::new(columns, lines)).unwrap();
    terminal.draw(|frame| draw(frame, state)).unwrap();
    (
        terminal.backend().to_string(),
        terminal.backend().buffer().clone(),
    )
}

#[test]
fn nothing_was_read_yet() {
    insta::assert_snapshot!(picture(&state(0, &[]), 100, 22).0);
}

#[test]
fn a_press_shows_in_map_and_traces() {
    let mut state = state(300, &[gone(2, 0.5)]);
    state.tally.missed = 3;
    state.recording = Some(RecordingStatus {
        file: "touch-0001.mcap".to_owned(),
        frames: 12,
    });
    let (text, _) = picture(&state, 100, 22);
    insta::assert_snapshot!(text);
}

#[test]
fn the_map_is_brightest_where_it_is_pressed() {
    let state = state(250, &[]); // the middle of the first press, on the right
    assert!(state.above_kpa()[3].unwrap() > 4.0, "{:?}", state.above_kpa());
    let (_, buffer) = picture(&state, 100, 22);
    let brightness = |position: (u16, u16)| match buffer[position].bg {
        Color::Rgb(red, green, _) => u32::from(red) + u32::from(green),
        _ => 0,
    };
    let map: Vec<(u16, u16)> = (1..49).flat_map(|x| (3..20).map(move |y| (x, y))).collect();
    let brightest = map
        .iter()
        .copied()
        .max_by_key(|position| brightness(*position))
        .unwrap();
    assert!((36..49).contains(&brightest.0), "{brightest:?}");
    assert!((8..16).contains(&brightest.1), "{brightest:?}");
}

#[test]
fn a_tare_makes_what_is_felt_now_nothing() {
    let (mut reader, about) = reader(&[]);
    let mut state = DashboardState::new(about).unwrap();
    for _ in 0..270 {
        state.push(reader.read().unwrap());
    }
    let pressed_kpa = state.above_kpa()[7].unwrap();
    state.tare();
    for _ in 0..32 {
        assert!(state.message.contains("taking a tare"));
        state.push(reader.read().unwrap());
    }
    assert!(state.above_kpa()[7].unwrap().abs() < 0.3 * pressed_kpa && state.message == "tare taken");
}

#[test]
fn any_size_of_terminal_is_drawn() {
    let state = state(100, &[gone(0, 0.0)]);
    for (columns, lines) in [(1, 1), (3, 2), (20, 4), (40, 60), (300, 10)] {
        picture(&state, columns, lines);
    }
}

#[test]
fn what_is_recorded_reads_back() {
    let folder = tempfile::tempdir().unwrap();
    let (mut reader, about) = reader(&[]);
    for number in 1..=2 {
        let mut recording = TouchRecording::begin(folder.path(), &about).unwrap();
        let readings: Vec<_> = (0..50).map(|_| reader.read().unwrap()).collect();
        for reading in &readings {
            recording.push(reading).unwrap();
        }
        assert_eq!((recording.frames(), recording.finish().unwrap()), (50, 50));
        let table = folder.path().join(format!("touch-000{number}.parquet"));
        assert!(table.is_file());
        let log = LogReader::open(&folder.path().join(format!("touch-000{number}.mcap"))).unwrap();
        let frames: Vec<_> = log
            .filter_map(|message| match message.unwrap().body {
                Body::Tactile(frame) => Some(frame),
                _ => None,
            })
            .collect();
        let expected: Vec<_> = readings.into_iter().map(|reading| reading.frame).collect();
        assert_eq!(frames, expected);
    }
}

#[test]
fn what_was_missed_is_marked() {
    let folder = tempfile::tempdir().unwrap();
    let (mut reader, about) = reader(&[]);
    let mut recording = TouchRecording::begin(folder.path(), &about).unwrap();
    let readings: Vec<_> = (0..10).map(|_| reader.read().unwrap()).collect();
    for reading in readings
        .iter()
        .filter(|reading| !(3..6).contains(&reading.sequence))
    {
        recording.push(reading).unwrap();
    }
    assert_eq!(recording.finish().unwrap(), 7);
    let log = LogReader::open(&folder.path().join("touch-0001.mcap")).unwrap();
    let gaps: Vec<_> = log
        .filter_map(|message| match message.unwrap().body {
            Body::Event(Event::Gap {
                from_ns, to_ns, lost, ..
            }) => Some((from_ns, to_ns, lost)),
            _ => None,
        })
        .collect();
    let ns = |frame: usize| (1e9 * readings[frame].bench_s).round() as u64;
    assert_eq!(gaps, [(ns(2), ns(6), Some(3))]);
}
