//! The client against the emulated force sensor on the loopback, and the sensor alone in virtual
//! time.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use std::time::Duration;

use glam::DVec3;
use twintac_emulate::force::{ForceSensor, ForceServer, ForceSettings, Outgoing};
use twintac_emulate::robot::ArmSettings;
use twintac_emulate::{EmulateError, FaultKind, Hertz, LabClock, Moment, ScheduledFault, Workcell};
use twintac_rig::netft::{
    BiasTolerance, Client, Command, Configuration, Record, Request, SequenceReport, SequenceTracker,
    decode_records,
};
use twintac_rig::{BenchClock, NetFtSource, RigError, TcpPose, WrenchSource};

/// A wait that is longer than any delay of a busy machine.
const LATEST: Duration = Duration::from_secs(60);

/// The ball, pressed in by 1 mm.
fn workcell(clock: &LabClock) -> Workcell {
    let tool = TcpPose {
        position_mm: DVec3::new(200.0, 0.0, 99.0),
        roll_pitch_yaw_rad: DVec3::new(std::f64::consts::PI, 0.0, 0.0),
    };
    Workcell::new(clock.clone(), Hertz::default(), tool, ArmSettings::default())
}

fn fault(what: FaultKind, begins: Moment, lasts: Option<Moment>) -> ScheduledFault {
    ScheduledFault { what, begins, lasts }
}

/// The content of the sensor's page. If a busy machine answers late, the page is requested again.
fn configuration(server: &ForceServer) -> Configuration {
    let host = server.page().to_string();
    (0..30)
        .find_map(|_| Client::read_configuration(&host).ok())
        .unwrap()
}

/// A sensor on the loopback, and a client that streams from it.
fn streaming(
    clock: &LabClock,
    faults: &[ScheduledFault],
    rate_hz: f64,
    buffered: bool,
) -> (ForceServer, Client) {
    let settings = ForceSettings {
        rate_hz,
        ..ForceSettings::default()
    };
    let server = ForceServer::start(workcell(clock), settings, faults).unwrap();
    let mut client = Client::connect(server.requests(), configuration(&server)).unwrap();
    client.set_patience(LATEST);
    std::thread::scope(|scope| {
        let started = scope.spawn(|| client.start(buffered).unwrap());
        while !started.is_finished() {
            // The first datagram is sent when its records are measured. In virtual time somebody
            // has to wait for that.
            std::thread::sleep(Duration::from_millis(100));
            if buffered {
                clock.wait_s(0.01);
            }
        }
    });
    (server, client)
}

/// The readings of 130 records. The client has taken the first one as the answer to its request.
/// The clock stands still until they are to be sent, and they all fit into the client's socket.
fn source(faults: &[ScheduledFault]) -> (ForceServer, NetFtSource) {
    let clock = LabClock::virtual_time();
    let (server, client) = streaming(&clock, faults, 250.0, false);
    clock.wait_s(129.0 / 250.0);
    (server, NetFtSource::new(client, BenchClock::start()))
}

#[test]
fn the_page_and_the_records_give_the_force_of_the_scene() {
    let clock = LabClock::virtual_time();
    let (_server, client) = streaming(&clock, &[], 1000.0, true);
    assert_eq!(client.configuration().rate_hz, Some(1000.0));
    clock.wait_s(0.32);
    let mut source = NetFtSource::new(client, BenchClock::start());
    let mut sum_n = DVec3::ZERO;
    let mut times_s = Vec::new();
    for _ in 0..300 {
        let sample = source.next_sample(LATEST).unwrap().unwrap();
        assert_eq!(sample.lost_before, 0);
        sum_n += sample.wrench.force_n;
        times_s.push(sample.stamp.source_s.unwrap());
    }
    let expected_n = DVec3::NEG_Z * Hertz::default().force_n(1.0);
    assert!((sum_n / 300.0).distance(expected_n) < 0.02, "{sum_n}");
    let rate_hz = 299.0 / (times_s[299] - times_s[0]);
    assert!((rate_hz - 1000.0).abs() < 1.0, "{rate_hz} Hz on its own clock");
}

#[test]
fn a_bias_takes_the_load_away() {
    let (_server, mut client) = streaming(&LabClock::real(), &[], 250.0, false);
    let tolerance = BiasTolerance {
        force_n: 0.2,
        torque_n_mm: 5.0,
    };
    // Records from before the bias may wait in the socket of a client that was delayed.
    assert!((0..10).any(|_| client.bias(&tolerance).is_ok()));
    client.stop().unwrap();
    // A thread that was delayed may have sent its last datagram after that.
    let is_silent = (0..1000).any(|_| client.receive(Duration::from_millis(20)).unwrap().is_empty());
    assert!(is_silent);
}

#[test]
fn lost_doubled_late_and_reordered_datagrams_are_told_apart() {
    let during = |what| fault(what, Moment::Count(20), Some(Moment::Count(10)));
    let seen = |what| -> SequenceReport {
        let (_server, mut source) = source(&[during(what)]);
        for _ in 0..100 {
            source.next_sample(LATEST).unwrap().unwrap();
        }
        source.report()
    };
    let lost = seen(FaultKind::LostDatagrams);
    assert_eq!((lost.lost, lost.longest_gap, lost.late), (10, 10, 0), "{lost}");
    let doubled = seen(FaultKind::DoubledDatagrams);
    assert_eq!((doubled.doubled, doubled.lost), (10, 0), "{doubled}");
    let late = seen(FaultKind::LateDatagrams { by_s: 0.1 });
    assert_eq!((late.late, late.lost, late.longest_gap), (10, 0, 10), "{late}");
    let reordered = seen(FaultKind::ReorderedDatagrams);
    assert_eq!(
        (reordered.late, reordered.lost, reordered.longest_gap),
        (5, 0, 1),
        "{reordered}"
    );
}

#[test]
fn saturation_is_an_error_of_the_source() {
    let saturated = fault(FaultKind::SaturatedForce, Moment::Count(20), None);
    let (_server, mut source) = source(&[saturated]);
    let error = (0..100).find_map(|_| source.next_sample(LATEST).err()).unwrap();
    assert!(matches!(error, RigError::ForceSensorStatus { .. }), "{error}");
    assert!(error.to_string().contains("saturation"), "{error}");
}

#[test]
fn a_page_that_is_not_there_and_a_port_that_is_taken_are_named() {
    let clock = LabClock::real();
    let server = ForceServer::start(workcell(&clock), ForceSettings::default(), &[]).unwrap();
    let elsewhere = format!("{}/other", server.page());
    assert!(Client::read_configuration(&elsewhere).is_err());
    let settings = ForceSettings {
        ports: [server.requests().port(), 0],
        ..ForceSettings::default()
    };
    let taken = ForceServer::start(workcell(&clock), settings, &[]);
    assert!(matches!(
        taken,
        Err(EmulateError::System {
            what: "the force sensor's requests",
            ..
        })
    ));
    let settings = ForceSettings {
        rate_hz: 8000.0,
        ..ForceSettings::default()
    };
    let error = ForceServer::start(workcell(&clock), settings, &[]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "`force.rate_hz` is 8000, expected at most 7000"
    );
}

/// All datagrams that a sensor sends in a second of virtual time, if it is asked at a regular
/// interval.
fn second(
    settings: ForceSettings,
    faults: &[ScheduledFault],
    every_s: f64,
    requests: &[(Command, u32)],
) -> Vec<Outgoing> {
    let clock = LabClock::virtual_time();
    let mut sensor = ForceSensor::new(workcell(&clock), settings, faults).unwrap();
    for (command, samples) in requests {
        let (command, samples) = (*command, *samples);
        sensor.hear(&Request { command, samples }.encode());
    }
    let mut sent = sensor.due();
    while clock.now_s() < 0.9999 {
        clock.wait_s(every_s);
        sent.extend(sensor.due());
    }
    sent
}

fn records(sent: &[Outgoing]) -> Vec<Record> {
    sent.iter()
        .flat_map(|outgoing| decode_records(&outgoing.datagram).unwrap().collect::<Vec<_>>())
        .collect()
}

#[test]
fn what_is_sent_does_not_depend_on_how_often_it_is_asked_for() {
    let faults = [
        fault(
            FaultKind::LostDatagrams,
            Moment::Count(100),
            Some(Moment::Count(3)),
        ),
        fault(
            FaultKind::SaturatedForce,
            Moment::TimeS(0.5),
            Some(Moment::TimeS(0.01)),
        ),
        fault(
            FaultKind::LateDatagrams { by_s: 0.02 },
            Moment::TimeS(0.7),
            Some(Moment::TimeS(0.01)),
        ),
    ];
    let start = [(Command::StartRealTime, 0)];
    let often = second(ForceSettings::default(), &faults, 0.001, &start);
    let all = |mut sent: Vec<Outgoing>| {
        sent.sort_by_key(|outgoing| outgoing.at_ns);
        sent
    };
    assert_eq!(
        all(often.clone()),
        all(second(ForceSettings::default(), &faults, 0.1, &start))
    );
    let records = records(&often);
    assert_eq!(records.len(), 1001 - 3);
    let saturated = records
        .iter()
        .filter(|record| record.status.0 == 0x8002_0000)
        .count();
    assert_eq!(saturated, 10);
    assert_eq!(records.last().unwrap().ft_sequence, 7000);
    let mut tracker = SequenceTracker::default();
    for record in &records {
        tracker.track(record);
    }
    assert_eq!((tracker.report().late, tracker.report().lost), (10, 3));
}

#[test]
fn at_the_fastest_rate_each_record_has_a_tick_of_its_own() {
    let settings = ForceSettings {
        rate_hz: 7000.0,
        ..ForceSettings::default()
    };
    let records = records(&second(settings, &[], 0.01, &[(Command::StartBuffered, 0)]));
    assert_eq!(records.len(), 7000);
    assert!(
        (0..)
            .zip(&records)
            .all(|(tick, record)| record.ft_sequence == tick)
    );
}

#[test]
fn requests_for_so_many_records_end_by_themselves() {
    let sent = second(
        ForceSettings::default(),
        &[],
        0.01,
        &[(Command::StartBuffered, 25)],
    );
    let sizes: Vec<usize> = sent.iter().map(|outgoing| outgoing.datagram.len() / 36).collect();
    assert_eq!(sizes, [10, 10, 5]);
    let stopped = second(
        ForceSettings::default(),
        &[],
        0.01,
        &[(Command::StartRealTime, 0), (Command::Stop, 0)],
    );
    assert_eq!(stopped, []);
}

#[test]
fn a_monitor_condition_stays_latched_until_it_is_reset() {
    let clock = LabClock::virtual_time();
    let settings = ForceSettings {
        monitor_n: Some(0.1), // the ball presses with 0.36 N
        noise_n: 0.0,
        ..ForceSettings::default()
    };
    let mut sensor = ForceSensor::new(workcell(&clock), settings, &[]).unwrap();
    let request = |command| Request { command, samples: 1 }.encode();
    let mut status = |commands: &[Command]| {
        for command in commands {
            sensor.hear(&request(*command));
        }
        records(&sensor.due())[0].status.0
    };
    assert_eq!(status(&[Command::StartRealTime]), 0x8001_0000);
    assert_eq!(
        status(&[Command::ResetLatch, Command::StartRealTime]),
        0x8001_0000,
        "it still presses"
    );
}

#[test]
fn a_load_beyond_the_range_saturates_and_is_held() {
    let settings = ForceSettings {
        range: [0.2; 6],
        noise_n: 0.0,
        noise_n_mm: 0.0,
        ..ForceSettings::default()
    };
    let sent = second(settings, &[], 0.01, &[(Command::StartRealTime, 3)]);
    for record in records(&sent) {
        assert_eq!((record.status.0, record.counts[2]), (0x8002_0000, -200_000));
    }
}
