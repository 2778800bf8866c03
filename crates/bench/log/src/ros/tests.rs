use glam::{DQuat, DVec3};

use super::header::NS_PER_S;
use super::*;
use crate::cdr::Encoder;
use crate::{PoseReading, TactileFrame, TaxelReading, TaxelState, WrenchReading};

/// The encoded messages of one message, channel by channel.
fn written(body: &Body) -> Vec<(usize, Vec<u8>)> {
    let mut messages = Vec::new();
    Topics::new(&["S0".to_owned()]).each(3 * NS_PER_S + 4, body, |channel, put| {
        let mut bytes = Vec::new();
        put(&mut Encoder::new(&mut bytes));
        messages.push((channel, bytes));
    });
    messages
}

#[test]
fn a_fluid_pressure_has_golden_bytes() {
    let taxel = TaxelReading {
        state: TaxelState::Good,
        read_us: 1,
        counts: Some(64),
        pressure_pa: Some(2.0),
        temperature_c: None,
    };
    let frame = TactileFrame {
        triggered_us: 0,
        taxels: vec![taxel],
    };
    let messages = written(&Body::Tactile(frame));
    let golden = [
        &[0, 1, 0, 0][..],
        &[3, 0, 0, 0, 4, 0, 0, 0], // stamp
        &[3, 0, 0, 0, b'S', b'0', 0],
        &[0],
        &2.0_f64.to_le_bytes(),
        &0.0_f64.to_le_bytes(),
    ];
    assert_eq!(messages.len(), 2, "no temperature: no message");
    assert_eq!(messages[1], (6, golden.concat()));
}

#[test]
fn a_standard_wrench_is_in_newton_metres() {
    let reading = WrenchReading {
        source_s: None,
        sequence: Some(u32::MAX),
        status: 3,
        lost_before: 1,
        force_n: DVec3::new(1.0, 2.0, 3.0),
        torque_n_mm: DVec3::new(4000.0, 5000.0, 6000.0),
    };
    let messages = written(&Body::Wrench(reading));
    let numbers: Vec<u8> = (1..=6_u8).flat_map(|n| f64::from(n).to_le_bytes()).collect();
    // Encapsulation, stamp, length and text of `wrench`, padding to 24.
    assert_eq!(messages[1].1[4 + 24..], numbers);
    assert_eq!(
        decode(Stream::Wrench, &messages[0].1),
        Some(Body::Wrench(reading))
    );
}

#[test]
fn samples_come_back_and_pieces_of_them_do_not() {
    let pose = PoseReading {
        source_s: Some(0.5),
        position_mm: DVec3::new(1.0, -2.0, 0.1),
        base_from_tool: DQuat::from_rotation_x(0.3),
    };
    let event = Event::Tare {
        force_n: DVec3::new(0.1, 0.2, 0.3),
        torque_n_mm: DVec3::ZERO,
    };
    let taxel = TaxelReading {
        state: TaxelState::Saturated,
        read_us: u64::MAX,
        counts: Some(-5),
        pressure_pa: None,
        temperature_c: Some(-1.5),
    };
    let missing = TaxelReading {
        state: TaxelState::Missing,
        counts: None,
        temperature_c: None,
        ..taxel
    };
    let frame = TactileFrame {
        triggered_us: 9,
        taxels: vec![taxel, missing],
    };
    for (stream, body) in [
        (Stream::Pose, Body::Pose(pose)),
        (Stream::Event, Body::Event(event)),
        (Stream::Tactile, Body::Tactile(frame)),
    ] {
        let bytes = &written(&body)[0].1;
        assert_eq!(decode(stream, bytes), Some(body));
        for end in 0..bytes.len() {
            assert_eq!(decode(stream, &bytes[..end]), None, "{stream}, {end} bytes");
        }
    }
}

#[test]
fn definitions_name_all_that_they_are_made_of() {
    for definition in DEFINITIONS {
        let known: Vec<&str> = definition
            .text
            .lines()
            .filter_map(|line| line.strip_prefix("MSG: "))
            .collect();
        let used = definition
            .text
            .lines()
            .filter(|line| !line.starts_with("MSG: ") && !line.starts_with('#'));
        for part in used
            .filter_map(|line| line.split_whitespace().next())
            .filter(|word| word.contains('/'))
        {
            let part = part.trim_end_matches("[]");
            assert!(known.contains(&part), "{}: {part}", definition.name);
        }
    }
}
