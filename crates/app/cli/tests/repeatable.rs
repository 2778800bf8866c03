//! The same seed gives the same bits, with any number of threads, and after any kill.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

/// A gel as coarse, presses as few and training as short as still works: the test is about
/// repeatability.
const SETTINGS: &str = "
[simulate]
edges_per_height = 2.0
edges_per_contact_radius = 1.0
depth_step_mm = 0.5
[bench]
n_places = 2
[train]
epochs = 3
";

const PROTOCOL: &str = r#"
summary = "A few presses with one ball"
indenters = ["sphere-25"]
places = { kind = "random", x_mm = [-9.0, 9.0], y_mm = [-4.0, 4.0], count = 10 }
depth_mm = [0.5, 1.0]
speed_mm_per_s = 4.0
hold_s = 0.2
clearance_mm = 0.3
"#;

/// The stages in order, each with a file whose presence shows that the stage is running.
const STAGES: [(&[&str], &str); 5] = [
    (&["record", "--at-once"], "recordings.partial/presses"),
    (&["align", "--run"], "simulation.partial/depth_tables"),
    (&["train", "--run"], "training.partial/stage.json"),
    (&["evaluate", "--run"], "evaluation.partial"),
    (&["report", "--run"], "report.html"),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
}

struct Bench {
    folder: tempfile::TempDir,
    threads: &'static str,
}

impl Bench {
    fn new(threads: &'static str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("settings.toml"), SETTINGS).unwrap();
        fs::write(folder.path().join("protocol.toml"), PROTOCOL).unwrap();
        let emulator = fs::read_to_string(root().join("emulators/default.toml")).unwrap();
        let coarse = emulator
            .replace("edges_per_height = 7.0", "edges_per_height = 2.5")
            .replace("edges_per_contact_radius = 6.0", "edges_per_contact_radius = 1.0");
        assert_ne!(coarse, emulator);
        fs::write(folder.path().join("emulator.toml"), coarse).unwrap();
        Self { folder, threads }
    }

    fn run(&self) -> PathBuf {
        self.folder.path().join("run")
    }

    fn command(&self, stage: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_twintac"));
        command.args(["--threads", self.threads]).args(stage);
        if stage[0] == "record" {
            for (name, path) in [
                ("--lab", self.folder.path().join("emulator.toml")),
                ("--sensor", root().join("sensors/phystac.toml")),
                ("--protocol", self.folder.path().join("protocol.toml")),
                ("--settings", self.folder.path().join("settings.toml")),
                ("--out", self.run()),
            ] {
                command.arg(name).arg(path);
            }
        } else {
            command.arg(self.run());
        }
        command.stdout(Stdio::null()).stderr(Stdio::piped());
        command
    }

    fn finish(&self, stage: &[&str]) {
        let output = self.command(stage).output().unwrap();
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
    }

    /// Kills the stage as soon as `sign` exists and has grown a little; returns false if the stage
    /// was done before.
    fn kill(&self, stage: &[&str], sign: &str) -> bool {
        let mut child = self.command(stage).spawn().unwrap();
        while !self.run().join(sign).exists() {
            if child.try_wait().unwrap().is_some() {
                return false;
            }
            sleep(Duration::from_millis(2));
        }
        sleep(Duration::from_millis(150));
        let is_running = child.try_wait().unwrap().is_none();
        child.kill().unwrap();
        child.wait().unwrap();
        is_running
    }

    fn metrics(&self) -> Vec<u8> {
        fs::read(self.run().join("metrics.json")).unwrap()
    }
}

#[test]
fn kills_and_threads_leave_no_trace() {
    let (undisturbed, killed) = (Bench::new("2"), Bench::new("1"));
    let mut n_killed = 0;
    for (stage, sign) in STAGES {
        undisturbed.finish(stage);
        n_killed += u32::from(killed.kill(stage, sign));
        killed.finish(stage);
    }
    assert!(n_killed >= 2, "only {n_killed} stages were killed at work");
    assert!(
        undisturbed.metrics() == killed.metrics(),
        "the metrics differ: a kill or the number of threads shows"
    );
}
