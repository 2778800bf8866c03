//! The presses of a log as a recording.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

mod common;

use common::{NS_PER_S, begun, description, ended, event, log, pose, reader, taxel, wrench};
use glam::{DQuat, DVec3};
use twintac_log::{
    Body, Ending, Event, LogError, Message, ReadBack, ReadOptions, Stream, TactileFrame, TaxelState, presses,
    read_presses,
};
use twintac_recording::{Press, Recording};

const MS: u64 = 1_000_000;

fn read(messages: &[Message]) -> ReadBack {
    let bytes = log(&description(2), messages);
    presses(reader(&bytes), "bench.mcap", &ReadOptions::default()).unwrap()
}

/// A frame whose second taxel reads 1 kPa more than the first.
fn frame(time_ns: u64, pressure_pa: f64) -> Message {
    let mut taxels = vec![taxel(0); 2];
    for (taxel, more_pa) in taxels.iter_mut().zip([0.0, 1000.0]) {
        taxel.pressure_pa = Some(pressure_pa + more_pa);
        taxel.counts = Some((32.0 * (pressure_pa + more_pa)) as i32);
    }
    let body = Body::Tactile(TactileFrame {
        triggered_us: 0,
        taxels,
    });
    Message {
        bench_ns: time_ns,
        body,
    }
}

/// Height of the tip, mm, force, N, and pressure, Pa, over time. They are linear, so that
/// interpolation is exact.
fn ramp(time_ns: u64) -> (f64, f64, f64) {
    let time_s = time_ns as f64 / NS_PER_S as f64;
    (7.0 - time_s, 3.0 * time_s, 101_000.0 + 500.0 * time_s)
}

/// Four seconds: frames at 100 Hz, wrenches and poses at 50 Hz, never at the time of a frame; a
/// press from 2 to 3 s.
fn stream() -> Vec<Message> {
    let mut messages = Vec::new();
    for step in 0..400 {
        let time_ns = step * 10 * MS;
        messages.push(frame(time_ns, ramp(time_ns).2));
        if step % 2 == 0 {
            let (wrench_ns, pose_ns) = (time_ns + 3 * MS, time_ns + 7 * MS);
            messages.push(wrench(wrench_ns, ramp(wrench_ns).1));
            messages.push(pose(pose_ns, ramp(pose_ns).0));
        }
    }
    messages.push(event(2 * NS_PER_S, begun("p")));
    messages.push(event(3 * NS_PER_S, ended("p")));
    messages
}

fn only(back: &ReadBack) -> &Press {
    let [press] = &back.recording.presses[..] else {
        panic!("{:?}", back.remarks);
    };
    press
}

/// Times of the frames that have no valid reading, ms.
fn invalid_ms(press: &Press) -> Vec<u64> {
    let frames = press.time_s.iter().zip(&press.valid);
    frames
        .filter(|(_, valid)| !valid.contains(&true))
        .map(|(time_s, _)| (time_s * 1000.0).round() as u64)
        .collect()
}

#[test]
fn force_and_pose_are_interpolated_onto_the_frames() {
    let back = read(&stream());
    assert_eq!((back.ending, back.remarks.len()), (Ending::Whole, 0));
    assert_eq!(
        (back.recording.sensor.as_str(), back.recording.taxels.len()),
        ("phystac", 2)
    );
    let press = only(&back);
    assert_eq!((press.name.as_str(), press.indenter.as_str()), ("p", "sphere"));
    assert_eq!(press.time_s.len(), 101, "from begin to end, the two among them");
    // The mean of the second before: frames from 1.00 to 1.99 s.
    let baseline_pa = ramp(1495 * MS).2;
    for (frame, time_s) in press.time_s.iter().enumerate() {
        let time_ns = (time_s * 1e9).round() as u64;
        let (height_mm, force_n, pressure_pa) = ramp(time_ns);
        let pose = press.gel_from_indenter[frame];
        assert!(
            pose.position_mm.distance(DVec3::new(0.0, 0.0, height_mm)) < 1e-9,
            "{pose:?}"
        );
        assert!(pose.rotation.angle_between(DQuat::IDENTITY) < 1e-7);
        assert!((press.force_n.as_ref().unwrap()[frame] - force_n).abs() < 1e-9);
        for taxel in 0..2 {
            let above_kpa = (pressure_pa - baseline_pa) / 1000.0;
            assert!(
                (press.taxels_kpa[frame][taxel] - above_kpa).abs() < 1e-9,
                "both from their own"
            );
        }
        assert_eq!(
            press.taxels_raw[frame][1],
            f64::from((32.0 * (pressure_pa + 1000.0)) as i32)
        );
        assert_eq!(press.valid[frame], [true, true]);
    }
}

#[test]
fn nothing_is_interpolated_across_gaps() {
    let gap = |stream, from_ms: u64, to_ms: u64| {
        let gap = Event::Gap {
            stream,
            cause: "told".to_owned(),
            from_ns: from_ms * MS,
            to_ns: to_ms * MS,
            lost: Some(3),
        };
        event(to_ms * MS, gap)
    };
    // Wrenches are at 2203, 2223, 2243 ms, poses at 2207, 2227, 2247 ms.
    for (stream, expected) in [
        (Some(Stream::Wrench), vec![2210, 2220]),
        (Some(Stream::Pose), vec![2210, 2220]),
        (Some(Stream::Tactile), vec![]),
        (None, vec![2210, 2220]),
    ] {
        let mut messages = stream_with(gap(stream, 2209, 2221));
        messages.sort_by_key(|message| message.bench_ns);
        let back = read(&messages);
        assert_eq!(invalid_ms(only(&back)), expected, "{stream:?}");
        let words = stream.map_or("all streams".to_owned(), |stream| stream.to_string());
        let remark = format!("gap in {words} from 2.209 to 2.221 s, 3 messages: told");
        assert_eq!(back.remarks, [remark]);
    }
    // A loss that the sensor itself reports.
    let mut lossy = stream();
    for message in &mut lossy {
        if let Body::Wrench(reading) = &mut message.body
            && message.bench_ns == 2243 * MS
        {
            reading.lost_before = 1;
        }
    }
    assert_eq!(invalid_ms(only(&read(&lossy))), [2230, 2240]);
    // A silence without explanation: no pose from 2207 to 2287 ms.
    let mut silent = stream();
    silent.retain(|message| {
        message.stream() != Stream::Pose || !(2210 * MS..2280 * MS).contains(&message.bench_ns)
    });
    let back = read(&silent);
    let expected: Vec<u64> = (221..=228).map(|step| 10 * step).collect();
    assert_eq!(invalid_ms(only(&back)), expected);
    // A reading that is NaN counts as missing.
    let mut broken = stream();
    for message in &mut broken {
        if let Body::Wrench(reading) = &mut message.body
            && message.bench_ns == 2243 * MS
        {
            reading.force_n.z = f64::NAN;
        }
    }
    assert_eq!(invalid_ms(only(&read(&broken))), [2230, 2240, 2250, 2260]);
}

fn stream_with(message: Message) -> Vec<Message> {
    let mut messages = stream();
    messages.push(message);
    messages
}

#[test]
fn the_last_tare_is_taken_off_the_force() {
    let tare = |force_n| Event::Tare {
        force_n: DVec3::new(5.0, 5.0, force_n),
        torque_n_mm: DVec3::ZERO,
    };
    let mut messages = stream_with(event(1500 * MS, tare(-100.0)));
    messages.push(event(1900 * MS, tare(-2.0)));
    let back = read(&messages);
    // The wrench's z is -3 N per second of time. The tare's -2 N of it is zero load.
    let force_n = only(&back).force_n.as_ref().unwrap()[50];
    assert!((force_n - (3.0 * 2.5 - 2.0)).abs() < 1e-9, "{force_n}");
}

#[test]
fn a_baseline_leaves_other_presses_out_and_faults_too() {
    // A press that ended 200 ms before the examined one and left a higher reading of the taxels.
    let mut messages = vec![event(1200 * MS, begun("a")), event(1790 * MS, ended("a"))];
    for message in stream() {
        let mut message = message;
        if let Body::Tactile(frame) = &mut message.body {
            let during = (1200 * MS..=1790 * MS).contains(&message.bench_ns);
            frame.taxels[0].pressure_pa = Some(if during { 200_000.0 } else { 101_000.0 });
            frame.taxels[1].state = match message.bench_ns < 2 * NS_PER_S {
                true => TaxelState::Frozen,
                false => TaxelState::Good,
            };
        }
        messages.push(message);
    }
    let back = read(&messages);
    let press = &back.recording.presses[1];
    assert!(
        press.taxels_kpa.iter().all(|readings| readings[0] == 0.0),
        "100 kPa are not its baseline"
    );
    assert!(press.valid.iter().all(|valid| *valid == [true, false]));
    assert!(
        press.taxels_raw.iter().all(|readings| readings[1] > 1e6),
        "what came is there all the same"
    );
    let expected =
        ["a", "p"].map(|name| format!("press `{name}`: taxel `S1` has no baseline and is invalid"));
    assert_eq!(back.remarks, expected);
}

#[test]
fn faults_are_invalid_for_as_long_as_they_last() {
    let mut messages = stream();
    for message in &mut messages {
        if let Body::Tactile(frame) = &mut message.body
            && message.bench_ns == 2500 * MS
        {
            frame.taxels[0].state = TaxelState::Missing;
            frame.taxels[0].counts = None;
            frame.taxels[0].pressure_pa = None;
            frame.taxels[1].state = TaxelState::Saturated;
            frame.taxels[1].pressure_pa = None;
        }
    }
    let back = read(&messages);
    let press = only(&back);
    assert_eq!(press.valid[50], [false, false]);
    assert!(press.taxels_raw[50][0].is_nan() && press.taxels_kpa[50][0].is_nan());
    assert!(press.taxels_raw[50][1] > 1e6, "a saturated taxel's counts stay");
    assert!(press.taxels_kpa[50][1].is_nan(), "but no pressure comes of them");
    assert_eq!(invalid_ms(press), [2500]);
    assert_eq!(
        back.remarks,
        ["press `p`: taxel `S0` has no reading in 1 of 101 frames"]
    );
}

#[test]
fn a_log_that_was_cut_has_its_press_as_far_as_it_goes() {
    let bytes = {
        let mut messages = stream();
        messages.retain(|message| message.bench_ns < 3 * NS_PER_S);
        messages.sort_by_key(|message| message.bench_ns);
        log(&description(2), &messages)
    };
    let back = presses(
        reader(&bytes[..bytes.len() * 8 / 10]),
        "bench.mcap",
        &ReadOptions::default(),
    )
    .unwrap();
    assert_eq!(back.ending, Ending::Cut);
    let press = only(&back);
    assert!(press.time_s.len() > 10);
    assert_eq!(
        back.remarks,
        [
            "press `p` has no end: it lasts to the end of the log",
            "the log is truncated: it has what was flushed before"
        ]
    );
}

#[test]
fn odd_events_are_remarked_upon() {
    let mut messages = stream();
    messages.push(event(NS_PER_S, ended("ghost")));
    messages.push(event(2500 * MS, begun("p")));
    messages.push(event(5 * NS_PER_S, begun("late")));
    messages.push(event(
        5 * NS_PER_S,
        Event::Stopped {
            cause: "stopped by the operator".to_owned(),
        },
    ));
    let back = read(&messages);
    let names: Vec<&str> = back
        .recording
        .presses
        .iter()
        .map(|press| press.name.as_str())
        .collect();
    assert_eq!(names, ["p", "p (2)"]);
    assert_eq!(
        back.remarks,
        [
            "press `ghost` ends without a beginning",
            "press `p` did not end before `p` began",
            "the test setup stopped at 5.000 s: stopped by the operator",
            "press `late` has no end: it lasts to the end of the log",
            "press `late` has no tactile frames and is left out",
        ]
    );
}

#[test]
fn without_wrenches_there_is_no_force_and_without_poses_no_press() {
    let mut messages = stream();
    messages.retain(|message| message.stream() != Stream::Wrench);
    let back = read(&messages);
    assert_eq!(only(&back).force_n, None);
    assert!(invalid_ms(only(&back)).is_empty());
    messages.retain(|message| message.stream() != Stream::Pose);
    let bytes = log(&description(2), &messages);
    let error = presses(reader(&bytes), "bench.mcap", &ReadOptions::default()).unwrap_err();
    assert!(matches!(error, LogError::NoPoses { .. }), "{error}");
}

#[test]
fn presses_go_on_to_parquet() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bench.mcap");
    std::fs::write(&path, log(&description(2), &stream())).unwrap();
    let back = read_presses(&path, &ReadOptions::default()).unwrap();
    assert_eq!(back.recording.presses[0].mounting, "bench.mcap");
    let parquet = folder.path().join("bench.parquet");
    back.recording.write_parquet(&parquet).unwrap();
    assert_eq!(Recording::read_parquet(&parquet).unwrap(), back.recording);
}
