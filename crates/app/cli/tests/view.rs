//! `twintac view`, from the printed address to a pressed gel, until a signal ends it.

#![cfg(unix)]
#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

struct Running {
    child: Child,
    url: String,
}

impl Running {
    fn start(page: &Path) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_twintac"))
            .args(["view", "--json", "--page"])
            .arg(page)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut line = String::new();
        let mut out = BufReader::new(child.stdout.take().unwrap());
        out.read_line(&mut line).unwrap();
        let printed: serde_json::Value = serde_json::from_str(&line).unwrap();
        let url = printed["url"].as_str().unwrap().to_owned();
        Self { child, url }
    }

    fn get(&self, path: &str) -> String {
        let host = self.url["http://".len()..].split('/').next().unwrap();
        let mut stream = TcpStream::connect(host).unwrap();
        write!(stream, "GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n").unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        answer
    }

    /// Whether it ends after a signal, with exit code 0.
    fn ends_after(mut self, signal: &str) -> bool {
        let id = self.child.id().to_string();
        assert!(
            Command::new("kill")
                .args([signal, &id])
                .status()
                .unwrap()
                .success()
        );
        let started = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                return status.success();
            }
            if started.elapsed() > Duration::from_secs(5) {
                self.child.kill().unwrap();
                return false;
            }
            std::thread::sleep(Duration::from_millis(10));
        }
    }
}

#[test]
fn the_page_is_served_until_a_signal() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("page.html");
    std::fs::write(&page, "<!doctype html><title>gel</title>").unwrap();
    for signal in ["-INT", "-TERM"] {
        let running = Running::start(&page);
        let path = running
            .url
            .split_once("/?")
            .map(|(_, query)| format!("/?{query}"))
            .unwrap();
        assert!(running.get(&path).ends_with("<title>gel</title>"));
        assert!(running.get("/").starts_with("HTTP/1.1 403 "));
        // A client that sends nothing does not prevent the end.
        let host = running.url["http://".len()..]
            .split('/')
            .next()
            .unwrap()
            .to_owned();
        let silent = TcpStream::connect(host).unwrap();
        std::thread::sleep(Duration::from_millis(200)); // by now the server has accepted it
        assert!(running.ends_after(signal), "{signal}");
        drop(silent);
    }
}

#[test]
fn what_cannot_be_served_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let binary = folder.path().join("page.wasm");
    std::fs::write(&binary, b"\0asm").unwrap();
    for (arguments, parts) in [
        (vec!["--page", "nosuch.html"], vec!["nosuch.html"]),
        (
            vec!["--page", binary.to_str().unwrap()],
            vec!["page.wasm", "cargo xtask web"],
        ),
        (vec!["--listen", "127.0.0.1"], vec!["--listen"]),
        (vec!["--listen", "robot.example:80"], vec!["--listen"]),
    ] {
        let output = Command::new(env!("CARGO_BIN_EXE_twintac"))
            .arg("view")
            .args(&arguments)
            .output()
            .unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
        assert!(
            output.stdout.is_empty() && parts.iter().all(|part| error.contains(part)),
            "{error}"
        );
    }
}
