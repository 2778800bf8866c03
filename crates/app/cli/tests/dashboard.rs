//! The dashboard in a terminal, ended by a signal.

#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used)] // also in the helpers of tests

use std::process::{Command, Stdio};

/// The terminal output of a dashboard that a signal ends as soon as it is shown.
fn ended_by(signal: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let (log, program) = (folder.path().join("terminal"), env!("CARGO_BIN_EXE_twintac"));
    // The log begins with this line, which must not look like the output that is waited for.
    let line = format!(
        "'{program}' stream --lab --out '{}' & pid=$!; i=0; entered=$(printf '\\033[?1049h'); \
         while [ $i -lt 1200 ] && ! grep -qF \"$entered\" '{}'; do sleep 0.05; i=$((i+1)); done; \
         kill -s {signal} $pid; wait $pid; echo \"code $?\"",
        folder.path().display(),
        log.display()
    );
    let mut terminal = Command::new("script"); // part of util-linux: runs a command in a terminal of its own
    terminal
        .args(["-qefc", &line])
        .arg(&log)
        .stdin(Stdio::null())
        .stdout(Stdio::null());
    terminal.status().unwrap();
    String::from_utf8_lossy(&std::fs::read(&log).unwrap()).into_owned()
}

#[test]
fn a_signal_leaves_the_terminal_as_it_was() {
    for signal in ["TERM", "HUP", "INT"] {
        let shown = ended_by(signal);
        let (entered, left) = (shown.find("\u{1b}[?1049h"), shown.rfind("\u{1b}[?1049l"));
        assert!(entered.is_some() && left > entered, "{signal}: {shown:?}");
        assert!(shown.contains("code 0"), "{signal}: {shown:?}");
    }
}
