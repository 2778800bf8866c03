//! Datagrams of the force/torque sensor.

use twintac_emulate::force::{ForceSensor, ForceSettings};
use twintac_emulate::{Hertz, LabClock, Workcell};
use twintac_rig::netft::{
    Configuration, REQUEST_BYTES, Record, Request, SequenceTracker, decode_records, encode_records,
};

use crate::seeds::PAGE;

/// Checks a datagram from the sensor or to it.
pub(crate) fn datagrams(bytes: &[u8]) {
    if let Ok(request) = Request::decode(bytes) {
        assert_eq!(request.encode().as_slice(), bytes);
    }
    if let Ok(records) = decode_records(bytes) {
        let records: Vec<Record> = records.collect();
        assert_eq!(encode_records(&records), bytes);
        follow(&records);
    }
    ask(bytes);
}

fn follow(records: &[Record]) {
    let configuration = Configuration::parse("page", PAGE).unwrap();
    let mut tracker = SequenceTracker::default();
    for record in records {
        assert!(tracker.track(record).time_s.is_finite());
        let wrench = configuration.wrench(record.counts);
        assert!(wrench.force_n.is_finite() && wrench.torque_n_mm.is_finite());
        assert_eq!(configuration.counts(&wrench), record.counts, "counts come back");
        let _ = (record.status.health(), record.status.to_string());
    }
    let report = tracker.report();
    assert_eq!(report.received + report.doubled, records.len() as u64);
}

/// Sends requests to the emulated sensor, one every 2 ms.
fn ask(bytes: &[u8]) {
    let clock = LabClock::virtual_time();
    let robot = twintac_emulate::robot::RobotSettings::default();
    let workcell = Workcell::new(clock.clone(), Hertz::default(), robot.first_pose, robot.arm);
    let mut sensor = ForceSensor::new(workcell, ForceSettings::default(), &[]).unwrap();
    let mut is_streaming = false;
    for request in bytes.chunks(REQUEST_BYTES).take(16) {
        is_streaming |= sensor.hear(request);
        clock.wait_s(0.002);
        for outgoing in sensor.due() {
            assert!(is_streaming, "it speaks when it is asked");
            let records: Vec<Record> = decode_records(&outgoing.datagram).unwrap().collect();
            assert_eq!(encode_records(&records), outgoing.datagram);
        }
    }
}
