//! Written boards under KiCad's own rule checks. Without `kicad-cli` 9 these tests print that they
//! are skipped.

#![allow(clippy::print_stderr)] // says what is skipped
#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

mod written;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use twintac_board::Board;
use written::grid_of;

fn has_kicad() -> bool {
    let version = Command::new("kicad-cli").arg("--version").output();
    let is_there = version.is_ok_and(|output| String::from_utf8_lossy(&output.stdout).starts_with("9."));
    if !is_there {
        eprintln!("skipped: there is no `kicad-cli` 9");
    }
    is_there
}

fn write(folder: &Path, files: &BTreeMap<String, String>) {
    for (name, text) in files {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
}

/// The kinds of findings of the electrical and design rule checks.
fn findings(files: &BTreeMap<String, String>) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), files);
    let mut found = Vec::new();
    for (check, file) in [("sch erc", "two.kicad_sch"), ("pcb drc", "two.kicad_pcb")] {
        let mut command = Command::new("kicad-cli");
        command
            .args(check.split(' '))
            .args(["--format", "json", "--severity-all", "-o", "report.json"]);
        if check == "pcb drc" {
            command.args(["--schematic-parity", "--all-track-errors"]);
        }
        let output = command.arg(file).current_dir(folder.path()).output().unwrap();
        assert!(output.status.success(), "{output:?}");
        let report = std::fs::read(folder.path().join("report.json")).unwrap();
        let report: serde_json::Value = serde_json::from_slice(&report).unwrap();
        let lists = ["violations", "unconnected_items", "schematic_parity"];
        let of_board = lists
            .iter()
            .flat_map(|list| report[list].as_array().cloned().unwrap_or_default());
        let sheets = report["sheets"].as_array().cloned().unwrap_or_default();
        let of_sheets = sheets
            .iter()
            .flat_map(|sheet| sheet["violations"].as_array().cloned().unwrap());
        found.extend(
            of_board
                .chain(of_sheets)
                .map(|finding| finding["type"].as_str().unwrap().to_owned()),
        );
    }
    found
}

#[test]
fn nothing_is_found_on_a_board_and_what_is_broken_is() {
    if !has_kicad() {
        return;
    }
    let board = Board::design("two", &grid_of(2, 1, 8.0, 6.0), "MS5837-30BA").unwrap();
    let files = board.files();
    assert_eq!(findings(&files), Vec::<String>::new());

    let change = |from: &str, to: &str| {
        let mut changed = files.clone();
        let text = &files["two.kicad_pcb"];
        assert!(text.contains(from), "{from}");
        changed.insert("two.kicad_pcb".into(), text.replacen(from, to, 1));
        findings(&changed)
    };
    let text = &files["two.kicad_pcb"];
    let net = text.lines().find(|line| line.contains("\"SDA_t0\"")).unwrap();
    let number = net.trim().split(' ').nth(1).unwrap();
    let of_net = text
        .lines()
        .filter(|line| line.contains("(segment ") && line.contains(&format!("(net {number})")));
    let length = |track: &&str| {
        let numbers: Vec<f64> = track
            .split([' ', ')'])
            .filter_map(|word| word.parse().ok())
            .collect();
        (numbers[0] - numbers[2]).hypot(numbers[1] - numbers[3])
    };
    let track = of_net
        .max_by(|one, two| length(one).total_cmp(&length(two)))
        .unwrap();
    assert!(
        length(&track) > 0.5,
        "short tracks may be within the width of others"
    );

    let missing = change(&format!("{track}\n"), "");
    assert!(missing.contains(&"unconnected_items".to_owned()), "{missing:?}");

    // A track at 0.05 mm from a pad of another net: pads are 1.3 mm wide and 1 mm from the chip's
    // centre.
    let beside = "  (segment (start 142.7 106.5) (end 142.7 103.5) (width 0.2) (layer \"F.Cu\") (net 0) (uuid \
        \"00000000-0000-8000-8000-000000000000\"))\n";
    let close = change(track, &format!("{beside}{track}"));
    assert!(close.contains(&"clearance".to_owned()), "{close:?}");
}
