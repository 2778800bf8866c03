//! Clients of a server: accepted and refused, many at a time, disconnected without notice, and
//! disconnected at the end.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use std::io::{Read, Write};
use std::net::TcpStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket, client};
use twintac_view::{Server, Session, View, ViewError};

/// Answers with the previous request and the present one.
struct Echo {
    before: Vec<u8>,
    open: Arc<AtomicUsize>,
}

impl Session for Echo {
    fn answer(&mut self, request: &[u8]) -> Vec<u8> {
        assert_ne!(request, b"fail", "as asked");
        let answer = [self.before.as_slice(), b"|", request].concat();
        self.before = request.to_vec();
        answer
    }
}

impl Drop for Echo {
    fn drop(&mut self) {
        self.open.fetch_sub(1, Ordering::Relaxed);
    }
}

struct Running {
    url: String,
    open: Arc<AtomicUsize>,
    is_stopped: Arc<AtomicBool>,
    thread: JoinHandle<Result<(), ViewError>>,
}

fn run() -> Running {
    let server = Server::bind("127.0.0.1:0".parse().unwrap()).unwrap();
    let (url, is_stopped) = (server.url(), Arc::new(AtomicBool::new(false)));
    let open = Arc::new(AtomicUsize::new(0));
    let (counted, ends) = (Arc::clone(&open), Arc::clone(&is_stopped));
    let thread = thread::spawn(move || {
        let view = View {
            page: b"<!doctype html>the page".to_vec(),
            session: Box::new(move || {
                counted.fetch_add(1, Ordering::Relaxed);
                Box::new(Echo {
                    before: Vec::new(),
                    open: Arc::clone(&counted),
                })
            }),
        };
        server.serve(&view, &ends)
    });
    Running {
        url,
        open,
        is_stopped,
        thread,
    }
}

impl Running {
    fn host(&self) -> &str {
        self.url["http://".len()..].split('/').next().unwrap()
    }

    fn token(&self) -> &str {
        self.url.rsplit('=').next().unwrap()
    }

    /// The answer to a head and the bytes after it.
    fn ask(&self, head: &str) -> String {
        let mut stream = TcpStream::connect(self.host()).unwrap();
        stream.write_all(head.as_bytes()).unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        answer
    }

    fn get(&self, path: &str, headers: &str) -> String {
        self.ask(&format!("GET {path} HTTP/1.1\r\n{headers}\r\n"))
    }

    fn connect(&self, token: &str, origin: Option<&str>) -> tungstenite::Result<WebSocket<TcpStream>> {
        let address = format!("ws://{}/engine?token={token}", self.host());
        let mut request = address.into_client_request().unwrap();
        if let Some(origin) = origin {
            request.headers_mut().insert("origin", origin.parse().unwrap());
        }
        let stream = TcpStream::connect(self.host()).unwrap();
        let connected = client(request, stream).map_err(|error| match error {
            tungstenite::HandshakeError::Failure(error) => error,
            tungstenite::HandshakeError::Interrupted(_) => unreachable!("the stream blocks"),
        });
        Ok(connected?.0)
    }

    fn has_open(&self, n: usize) {
        let started = Instant::now();
        while self.open.load(Ordering::Relaxed) != n {
            assert!(
                started.elapsed() < Duration::from_secs(10),
                "{n} sessions are expected"
            );
            thread::sleep(Duration::from_millis(5));
        }
    }

    fn stop(self) {
        self.is_stopped.store(true, Ordering::Relaxed);
        self.thread.join().unwrap().unwrap();
        assert_eq!(self.open.load(Ordering::Relaxed), 0, "every session ends");
    }
}

fn asked(socket: &mut WebSocket<TcpStream>, request: &[u8]) -> Vec<u8> {
    socket.send(Message::binary(request.to_vec())).unwrap();
    socket.read().unwrap().into_data().to_vec()
}

#[test]
fn the_page_is_for_those_who_have_its_address() {
    let running = run();
    let host = format!("Host: {}\r\n", running.host());
    let path = format!("/?token={}", running.token());
    let page = running.get(&path, &host);
    assert!(
        page.starts_with("HTTP/1.1 200 ") && page.ends_with("<!doctype html>the page"),
        "{page}"
    );
    assert!(
        page.contains("no-referrer") && page.contains("no-store"),
        "{page}"
    );
    for (path, headers, status) in [
        ("/", host.as_str(), "403"),
        ("/?token=", &host, "403"),
        ("/?token=0123456789abcdef0123456789abcdef", &host, "403"),
        (&path, "", "403"),
        (&path, "Host: evil.example\r\n", "403"),
        (&path, &format!("{host}Origin: http://evil.example\r\n"), "403"),
        (&path, &format!("{host}{host}"), "400"),
        (&path.replace('?', "other?"), &host, "404"),
        (&path.replace('?', "engine?"), &host, "426"),
        (&path.replace('?', "../../etc/passwd?"), &host, "404"),
    ] {
        let answer = running.get(path, headers);
        assert!(
            answer.starts_with(&format!("HTTP/1.1 {status} ")),
            "{path} {headers:?}: {answer}"
        );
        assert!(
            !answer.contains("the page") && !answer.contains(running.token()),
            "{answer}"
        );
    }
    let posted = running.ask(&format!("POST {path} HTTP/1.1\r\n{host}\r\n"));
    assert!(posted.starts_with("HTTP/1.1 405 "), "{posted}");
    assert!(running.ask("nonsense\r\n\r\n").starts_with("HTTP/1.1 400 "));
    running.stop();
}

#[test]
fn a_socket_is_for_the_page_alone() {
    let running = run();
    let here = format!("http://{}", running.host());
    let mut socket = running.connect(running.token(), Some(&here)).unwrap();
    assert_eq!(asked(&mut socket, b"one"), b"|one");
    assert_eq!(asked(&mut socket, b"two"), b"one|two");
    for (token, origin) in [
        ("wrong", Some(here.as_str())),
        (running.token(), Some("http://evil.example")),
        (running.token(), Some("null")),
    ] {
        let refused = running.connect(token, origin).unwrap_err().to_string();
        assert!(refused.contains("403"), "{refused}");
    }
    assert_eq!(asked(&mut socket, b"three"), b"two|three", "the others go on");
    running.stop();
}

#[test]
fn clients_have_sessions_of_their_own_and_fail_alone() {
    let running = run();
    let mut sockets: Vec<_> = (0..10)
        .map(|_| running.connect(running.token(), None).unwrap())
        .collect();
    for round in 0_u8..50 {
        for (client, socket) in sockets.iter_mut().enumerate() {
            let answer = asked(socket, &[client as u8, round]);
            let before: &[u8] = if round == 0 {
                &[]
            } else {
                &[client as u8, round - 1]
            };
            assert_eq!(answer, [before, b"|", &[client as u8, round]].concat());
        }
    }
    running.has_open(10);
    // One fails, one disconnects without notice, one sends bytes that are no frame, one sends a
    // close frame.
    sockets[0].send(Message::binary(b"fail".to_vec())).unwrap();
    assert!(sockets[0].read().is_err());
    drop(sockets.remove(1));
    sockets[1].get_mut().write_all(&[0xff; 64]).unwrap();
    sockets[2].close(None).unwrap();
    while sockets[2].read().is_ok() {}
    running.has_open(6);
    assert_eq!(
        asked(&mut sockets[8], b"x"),
        [&[9, 49, b'|'], b"x".as_slice()].concat()
    );
    running.stop();
}

#[test]
fn clients_are_counted_and_a_place_that_was_left_is_free() {
    let running = run();
    let connect = || running.connect(running.token(), None);
    let mut sockets: Vec<_> = (0..32).map(|_| connect().unwrap()).collect();
    running.has_open(32);
    let refused = connect().unwrap_err().to_string();
    assert!(refused.contains("503"), "{refused}");
    for _ in 0..200 {
        drop(sockets.pop());
        running.has_open(31);
        let started = Instant::now();
        sockets.push(loop {
            match connect() {
                Ok(socket) => break socket,
                Err(_) => assert!(started.elapsed() < Duration::from_secs(10)),
            }
        });
        running.has_open(32);
    }
    running.stop();
}

#[test]
fn who_is_refused_reads_why_however_much_it_still_says() {
    let running = run();
    let host = format!("Host: {}\r\n", running.host());
    let path = format!("/?token={}", running.token());
    let length = "Content-Length: 300000\r\n";
    let body = "x".repeat(300_000);
    for _ in 0..20 {
        let posted = running.ask(&format!("POST {path} HTTP/1.1\r\n{host}{length}\r\n{body}"));
        assert!(posted.starts_with("HTTP/1.1 405 "), "{posted}");
    }
    // A full server answers before it reads a request.
    let sockets: Vec<_> = (0..32)
        .map(|_| running.connect(running.token(), None).unwrap())
        .collect();
    running.has_open(32);
    let mut late = TcpStream::connect(running.host()).unwrap();
    thread::sleep(Duration::from_millis(200));
    late.write_all(b"GET / HTTP/1.1\r\n").unwrap();
    thread::sleep(Duration::from_millis(200));
    late.write_all(b"\r\n").unwrap();
    let mut answer = String::new();
    late.read_to_string(&mut answer).unwrap();
    assert!(answer.starts_with("HTTP/1.1 503 "), "{answer}");
    drop(sockets);
    running.stop();
}

#[test]
fn clients_that_say_nothing_do_not_keep_it_from_ending() {
    let running = run();
    let silent: Vec<_> = (0..5)
        .map(|_| TcpStream::connect(running.host()).unwrap())
        .collect();
    let talking = running.connect(running.token(), None).unwrap();
    running.has_open(1);
    let started = Instant::now();
    running.stop();
    assert!(
        started.elapsed() < Duration::from_secs(5),
        "{:?}",
        started.elapsed()
    );
    drop((silent, talking));
}

#[test]
fn every_server_has_a_token_of_its_own() {
    let bind = || Server::bind("127.0.0.1:0".parse().unwrap()).unwrap();
    let (a, b) = (bind(), bind());
    let token = |server: &Server| server.url().rsplit('=').next().unwrap().to_owned();
    assert_ne!(token(&a), token(&b));
    assert_eq!(token(&a).len(), 32);
    let taken = Server::bind(
        a.url()["http://".len()..]
            .split('/')
            .next()
            .unwrap()
            .parse()
            .unwrap(),
    );
    assert!(taken.err().unwrap().to_string().contains("cannot be listened on"));
}
