//! The client against a sensor on the loopback of this computer.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener};
use std::sync::mpsc;
use std::thread::JoinHandle;

use glam::DVec3;

use super::*;
use crate::netft::{Status, encode_records};
use crate::{BenchClock, NetFtSource, WrenchSource};

fn configuration() -> Configuration {
    Configuration {
        counts_per_force: 1e6,
        counts_per_torque: 1e6,
        force_unit: "N".into(),
        torque_unit: "Nm".into(),
        product: None,
        rate_hz: None,
    }
}

/// How the sensor on the loopback treats requests and records.
#[derive(Clone, Copy)]
struct Habits {
    /// Number of requests to start and to bias that the sensor ignores before it carries one out.
    deaf: u32,
    /// Number of the record that is left out, of the one that is sent twice, and of the one after
    /// which the counting restarts.
    lost: Option<u32>,
    doubled: Option<u32>,
    last: Option<u32>,
    /// Most records that it sends. This many fit into the socket of a client that is delayed.
    most: u32,
    status: Status,
}

const WELL: Habits = Habits {
    deaf: 0,
    lost: None,
    doubled: None,
    last: None,
    most: u32::MAX,
    status: Status::HEALTHY,
};

/// Streams 2 N along z until it receives a stop request. A special datagram ends the sensor.
fn sensor(habits: Habits) -> (SocketAddr, impl FnOnce() -> Vec<Command>) {
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let address = socket.local_addr().unwrap();
    socket.set_read_timeout(Some(Duration::from_micros(500))).unwrap();
    let (done, is_done) = mpsc::channel::<()>();
    let server: JoinHandle<Vec<Command>> = std::thread::spawn(move || {
        let (mut heard, mut client, mut bias, mut sequence, mut ticks) = (Vec::new(), None, 0, 0, 70_000);
        while is_done.try_recv().is_err() {
            let mut bytes = [0; 64];
            if let Ok((size, from)) = socket.recv_from(&mut bytes) {
                let command = Request::decode(&bytes[..size]).unwrap().command;
                heard.push(command);
                let is_heard = heard.iter().filter(|other| **other == command).count() as u32 > habits.deaf;
                match command {
                    Command::StartBuffered | Command::StartRealTime if is_heard => {
                        client = Some(from);
                        sequence = 0;
                    }
                    Command::Bias if is_heard => bias = 2_000_000,
                    Command::Stop => client = None,
                    _ => {}
                }
            }
            let Some(client) = client.filter(|_| sequence < habits.most) else {
                continue;
            };
            let mut records = Vec::new();
            for _ in 0..5 {
                sequence += 1;
                ticks += 1;
                let record = Record {
                    rdt_sequence: sequence,
                    ft_sequence: ticks,
                    status: habits.status,
                    counts: [0, 0, 2_000_000 - bias, 0, 0, 1000],
                };
                let times = match Some(sequence) {
                    number if number == habits.lost => 0,
                    number if number == habits.doubled => 2,
                    _ => 1,
                };
                records.extend(vec![record; times]);
                if Some(sequence) == habits.last {
                    sequence = 0;
                }
            }
            let _ = socket.send_to(&encode_records(&records), client);
        }
        // Datagrams that were sent before the end are still read, however late this thread is.
        let mut bytes = [0; 64];
        while let Ok((size, _)) = socket.recv_from(&mut bytes) {
            heard.push(Request::decode(&bytes[..size]).unwrap().command);
        }
        heard
    });
    let stop = move || {
        done.send(()).unwrap();
        server.join().unwrap()
    };
    (address, stop)
}

/// A wait that is longer than any delay of a busy machine.
const LATEST: Duration = Duration::from_secs(60);

/// A client that waits as long as a busy machine may need.
fn connected(address: SocketAddr) -> Client {
    let mut client = Client::connect(address, configuration()).unwrap();
    client.set_patience(LATEST);
    client
}

const TOLERANCE: BiasTolerance = BiasTolerance {
    force_n: 0.01,
    torque_n_mm: 5.0,
};

#[test]
fn requests_that_get_lost_are_repeated_until_the_data_show_them() {
    let (address, stop) = sensor(Habits { deaf: 2, ..WELL });
    let mut client = connected(address);
    client.patience.start = Duration::from_millis(200);
    client.patience.most_tries = 300;
    client.start(true).unwrap();
    let mean = client.bias(&TOLERANCE).unwrap();
    assert!(mean.force_n.length() < 1e-12 && (mean.torque_n_mm.z - 1.0).abs() < 1e-9);
    client.stop().unwrap();
    // A thread that was delayed may have sent its last datagram after that.
    let is_silent = (0..1000).any(|_| client.receive(Duration::from_millis(20)).unwrap().is_empty());
    assert!(is_silent);
    let heard = stop();
    let count = |command| heard.iter().filter(|other| **other == command).count();
    assert!(count(Command::StartBuffered) >= 3 && count(Command::Bias) >= 3);
}

#[test]
fn a_bias_that_never_shows_is_an_error() {
    let (address, stop) = sensor(Habits { deaf: 99, ..WELL });
    let mut client = Client::connect(address, configuration()).unwrap();
    client
        .socket
        .send(
            &Request {
                command: Command::StartRealTime,
                samples: 0,
            }
            .encode(),
        )
        .unwrap();
    assert!(
        matches!(client.bias(&TOLERANCE), Err(RigError::Timeout { .. })),
        "it does not stream"
    );
    stop();
    let (address, stop) = sensor(WELL);
    let mut client = connected(address);
    client.start(false).unwrap();
    let strict = BiasTolerance {
        torque_n_mm: 0.5,
        ..TOLERANCE
    };
    let error = client.bias(&strict).unwrap_err().to_string();
    assert!(error.contains("after 10 requests for a bias it reads"), "{error}");
    stop();
}

#[test]
fn readings_keep_the_sensors_clock_and_mark_gaps() {
    let (address, stop) = sensor(Habits {
        lost: Some(43),
        doubled: Some(30),
        most: 100,
        ..WELL
    });
    let mut client = connected(address);
    client.start(true).unwrap();
    let clock = BenchClock::start();
    let mut source = NetFtSource::new(client, clock);
    let mut next = || source.next_sample(LATEST).unwrap().unwrap();
    let samples: Vec<_> = (0..60).map(|_| next()).collect();
    for pair in samples.windows(2) {
        let ticks = (pair[1].stamp.source_s.unwrap() - pair[0].stamp.source_s.unwrap()) * 7000.0;
        assert!((ticks - 1.0 - f64::from(pair[1].lost_before)).abs() < 1e-6);
        assert!(pair[1].stamp.bench_s >= pair[0].stamp.bench_s);
    }
    assert_eq!(samples.iter().map(|sample| sample.lost_before).sum::<u32>(), 1);
    assert_eq!(samples[0].wrench.force_n, DVec3::new(0.0, 0.0, 2.0));
    assert_eq!((source.report().lost, source.report().doubled), (1, 1));
    drop(source);
    assert_eq!(
        stop().last(),
        Some(&Command::Stop),
        "dropping it stops the sensor"
    );
}

#[test]
fn untrustworthy_records_are_errors() {
    let saturated = Status(0x8002_0000);
    let (address, stop) = sensor(Habits {
        status: saturated,
        ..WELL
    });
    let mut client = connected(address);
    let error = client.start(true).unwrap_err().to_string();
    assert_eq!(error, "force sensor: status 0x80020000 (saturation or A/D)");
    let mut source = NetFtSource::new(client, BenchClock::start());
    assert!(source.next_sample(LATEST).is_err());
    stop();
}

#[test]
fn a_stream_that_begins_anew_is_an_error() {
    let (address, stop) = sensor(Habits {
        last: Some(20),
        most: 100,
        ..WELL
    });
    let mut client = connected(address);
    client.start(true).unwrap();
    let mut source = NetFtSource::new(client, BenchClock::start());
    let error = (0..40).find_map(|_| source.next_sample(LATEST).err());
    assert!(error.unwrap().to_string().contains("its stream started again"));
    stop();
}

#[test]
fn silence_is_no_reading() {
    let silent = UdpSocket::bind("127.0.0.1:0").unwrap();
    let client = Client::connect(silent.local_addr().unwrap(), configuration()).unwrap();
    let mut source = NetFtSource::new(client, BenchClock::start());
    let asked = Instant::now();
    assert_eq!(source.next_sample(Duration::from_millis(30)).unwrap(), None);
    assert!(asked.elapsed() >= Duration::from_millis(30));
}

/// Answers one request for a page.
fn web_server(status: &'static str, body: String) -> (String, JoinHandle<String>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let host = listener.local_addr().unwrap().to_string();
    let server = std::thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        let mut request = Vec::new();
        while !request.ends_with(b"\r\n\r\n") {
            let mut bytes = [0; 256];
            let size = stream.read(&mut bytes).unwrap();
            assert!(size > 0);
            request.extend_from_slice(&bytes[..size]);
        }
        let size = body.len();
        let head = format!("HTTP/1.0 {status}\r\nContent-Type: text/xml\r\nContent-Length: {size}\r\n\r\n");
        let _ = stream.write_all((head + &body).as_bytes());
        String::from_utf8(request).unwrap()
    });
    (host, server)
}

#[test]
fn the_configuration_is_read_from_the_web_server() {
    let (host, server) = web_server("200 OK", configuration().to_xml());
    assert_eq!(page::fetch(&host, LATEST).unwrap(), configuration());
    assert!(
        server
            .join()
            .unwrap()
            .starts_with("GET /netftapi2.xml HTTP/1.1\r\n")
    );
    for (status, body, words) in [
        ("404 Not Found", String::new(), "404"),
        ("200 OK", "<netFTApi/>".to_owned(), "has no element `cfgcpf`"),
        ("200 OK", "x".repeat(100_000), "limit"),
    ] {
        let (host, server) = web_server(status, body);
        let error = page::fetch(&host, LATEST).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
        assert!(error.contains(&host), "{error}");
        server.join().unwrap();
    }
}
