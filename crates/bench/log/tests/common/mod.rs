//! An invented test setup: it always gives the same messages.

#![allow(clippy::unwrap_used, dead_code)] // helpers of several tests

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};
use twintac_log::{
    Body, CountTransfer, Description, Event, LogReader, LogWriter, Message, PoseReading, TactileFrame,
    TaxelReading, TaxelState, WrenchReading,
};
use twintac_recording::{Control, Provenance};
use twintac_shape::Pose;

pub(crate) const NS_PER_S: u64 = 1_000_000_000;

pub(crate) fn description(taxels: usize) -> Description {
    Description {
        sensor: "phystac".to_owned(),
        sensor_toml: "name = \"phystac\"\n# \"quoted\" µ\n".to_owned(),
        provenance: Provenance::Emulated,
        taxels: (0..taxels).map(|taxel| format!("S{taxel}")).collect(),
        transfer: Some(CountTransfer {
            pa_per_count: 1.0 / 32.0,
            offset_pa: 0.0,
            signed: true,
            is_confirmed: true,
        }),
        base_from_gel: Pose {
            position_mm: DVec3::new(300.0, 20.0, 50.0),
            rotation: DQuat::IDENTITY,
        },
        // The tool points down. The z axis of its indenter points up.
        tool_from_indenter: Pose {
            position_mm: DVec3::new(0.0, 0.0, 40.0),
            rotation: DQuat::from_rotation_x(std::f64::consts::PI),
        },
        force_axis: DVec3::NEG_Z,
        start_unix_ns: 1_700_000_000 * NS_PER_S + 5,
        versions: BTreeMap::from([("firmware".to_owned(), "1.2.3".to_owned())]),
    }
}

pub(crate) fn taxel(counts: i32) -> TaxelReading {
    TaxelReading {
        state: TaxelState::Good,
        read_us: 7,
        counts: Some(counts),
        pressure_pa: Some(f64::from(counts) / 32.0),
        temperature_c: Some(25.5),
    }
}

pub(crate) fn frame(time_ns: u64, taxels: usize) -> Message {
    let step = (time_ns / 1_000_000) as i32;
    let counts = |taxel: usize| 3_242_400 + step % 1000 + 10 * taxel as i32;
    let mut taxels: Vec<TaxelReading> = (0..taxels).map(|index| taxel(counts(index))).collect();
    if step % 7 == 0 {
        taxels[0].state = TaxelState::Saturated;
        taxels[0].pressure_pa = None;
    }
    Message {
        bench_ns: time_ns,
        body: Body::Tactile(TactileFrame {
            triggered_us: time_ns / 1000 + 77,
            taxels,
        }),
    }
}

pub(crate) fn wrench(time_ns: u64, force_n: f64) -> Message {
    Message {
        bench_ns: time_ns,
        body: Body::Wrench(WrenchReading {
            source_s: Some(time_ns as f64 * 1e-9 + 100.0),
            sequence: Some((time_ns / 1_000_000) as u32),
            status: 0,
            lost_before: 0,
            force_n: DVec3::new(0.1, 0.2, -force_n),
            torque_n_mm: DVec3::new(1.0, -2.0, 3.0),
        }),
    }
}

/// The tip at a height above the origin of the gel's frame.
pub(crate) fn pose(time_ns: u64, height_mm: f64) -> Message {
    Message {
        bench_ns: time_ns,
        body: Body::Pose(PoseReading {
            source_s: None,
            position_mm: DVec3::new(300.0, 20.0, 90.0 + height_mm),
            base_from_tool: DQuat::from_rotation_x(std::f64::consts::PI),
        }),
    }
}

pub(crate) fn event(time_ns: u64, event: Event) -> Message {
    Message {
        bench_ns: time_ns,
        body: Body::Event(event),
    }
}

pub(crate) fn begun(name: &str) -> Event {
    Event::PressBegun {
        name: name.to_owned(),
        indenter: "sphere".to_owned(),
        control: Control::Pose,
    }
}

pub(crate) fn ended(name: &str) -> Event {
    Event::PressEnded {
        name: name.to_owned(),
    }
}

/// Streams with their rates, Hz, in order of time.
pub(crate) fn bench(seconds: u64, taxels: usize, [tactile_hz, wrench_hz, pose_hz]: [u64; 3]) -> Vec<Message> {
    let times = |hz: u64, at: u64| (0..seconds * hz).map(move |step| step * NS_PER_S / hz + at);
    let mut messages: Vec<Message> = times(tactile_hz, 3)
        .map(|time_ns| frame(time_ns, taxels))
        .collect();
    messages.extend(times(wrench_hz, 1).map(|time_ns| wrench(time_ns, time_ns as f64 * 1e-9)));
    messages.extend(times(pose_hz, 2).map(|time_ns| pose(time_ns, 7.0 - time_ns as f64 * 1e-9)));
    for second in 0..seconds {
        let name = format!("p{second}");
        messages.push(event(second * NS_PER_S + NS_PER_S / 2, begun(&name)));
        messages.push(event(second * NS_PER_S + NS_PER_S * 9 / 10, ended(&name)));
    }
    messages.sort_by_key(|message| message.bench_ns);
    messages
}

/// A complete log in memory.
pub(crate) fn log(description: &Description, messages: &[Message]) -> Vec<u8> {
    let mut writer = LogWriter::new(Vec::new(), description).unwrap();
    for message in messages {
        writer.write(message).unwrap();
    }
    writer.finish().unwrap()
}

pub(crate) fn reader(bytes: &[u8]) -> LogReader<&[u8]> {
    LogReader::new(bytes, "test.mcap").unwrap()
}
